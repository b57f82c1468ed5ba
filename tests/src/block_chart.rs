//! Charts of block counting in ASCII, in the manner of the patent's Figure 8.
//!
//! ```text
//! reset     0.........
//! in        ..##......
//! out       ........#.
//! hears 0   ..###.....
//! hears 1   .....###..
//! count     0011111100
//! status    cccccccccc
//! reports 0 ..ddd.....
//! reports 1 .....ddd..
//! ```
//!
//! A column is one logic cycle: what is read in it, and what is put out by it. `#` is on or heard, `.` is off, silent, none, or
//! free. Sections are numbered from the entry end. The rows:
//!
//! * `reset`: the verified number, a digit. `asks`: how many sections the block ahead asks to hold. `ahead`: `#` while the block
//!   ahead takes trains over; without the row it always does. These, `in` and `out` may be left out.
//! * `status`: `u` unverified, `c` the count is in force; `z`, `m`, `s` a fault: check-out at zero, check-in at the maximum,
//!   check-in stays on.
//! * `reports`: `d` occupied because a train is detected there, `h` held for a tail, `a` occupied because all are.
//! * `behind`: how many sections the block behind is asked to hold; without the row 0.

use std::fmt::{self, Write as _};
use std::path::Path;

use atc_kernel::block::{Block, Hold, Input, SectionSet, State, Status, TrainCount, step};
use atc_protocol::machine::block::{Config, Fault, Output};
use serde_json::{Value, json};

use crate::device::{Refused, converse, device};

/// A parsed chart.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct BlockChart {
    /// What is read, by cycle.
    inputs: Vec<Input>,
    /// What must be put out, by cycle, as a column of the rows count, status, reports 0…, behind.
    columns: Vec<String>,
}

/// What is wrong with a chart, or with what a device does with it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct BlockChartError(pub String);

impl fmt::Display for BlockChartError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

fn error<T>(text: impl Into<String>) -> Result<T, BlockChartError> {
    Err(BlockChartError(text.into()))
}

/// The rows of a chart by name, all of one length.
struct Rows<'a>(Vec<(String, &'a str)>);

impl<'a> Rows<'a> {
    fn read(text: &'a str, sections: u8) -> Result<Self, BlockChartError> {
        let mut rows: Vec<(String, &str)> = Vec::new();
        for line in text.lines().map(str::trim).filter(|line| !line.is_empty()) {
            let Some((name, row)) = line.rsplit_once(' ') else { return error(format!("{line:?} is not a row")) };
            let name = name.split_whitespace().collect::<Vec<_>>().join(" ");
            let known = ["reset", "in", "out", "asks", "ahead", "count", "status", "behind"].contains(&name.as_str())
                || (0..sections)
                    .any(|section| [format!("hears {section}"), format!("reports {section}")].contains(&name));
            if !known || rows.iter().any(|(other, _)| *other == name) {
                return error(format!("a row cannot be called {name:?} here, or not twice"));
            }
            if rows.first().is_some_and(|(_, first)| first.len() != row.len()) {
                return error(format!("the row {name:?} has another length than the first"));
            }
            rows.push((name, row));
        }
        Ok(Self(rows))
    }

    fn sign(&self, name: &str, at: usize, default: char) -> char {
        let row = self.0.iter().find(|(known, _)| known == name);
        row.and_then(|(_, row)| row.chars().nth(at)).unwrap_or(default)
    }

    fn on(&self, name: &str, at: usize, default: char) -> Result<bool, BlockChartError> {
        match self.sign(name, at, default) {
            '#' => Ok(true),
            '.' => Ok(false),
            sign => error(format!("{sign:?} in the row {name:?} is neither on (#) nor off (.)")),
        }
    }

    fn number(&self, name: &str, at: usize) -> Result<Option<u8>, BlockChartError> {
        match self.sign(name, at, '.') {
            '.' => Ok(None),
            sign => match sign.to_digit(10).and_then(|digit| u8::try_from(digit).ok()) {
                Some(number) => Ok(Some(number)),
                None => error(format!("{sign:?} in the row {name:?} is not a digit")),
            },
        }
    }
}

impl BlockChart {
    /// Reads a chart of a block of so many sections.
    ///
    /// # Errors
    /// A row that the block does not have, or has twice; a sign that is not one of its row; rows of different lengths; no row
    /// `count`, `status` or `reports` of some section, so that something would go unseen.
    pub fn parse(text: &str, sections: u8) -> Result<Self, BlockChartError> {
        let rows = Rows::read(text, sections)?;
        let reports: Vec<_> = (0..sections).map(|section| format!("reports {section}")).collect();
        for needed in ["count", "status"].into_iter().chain(reports.iter().map(String::as_str)) {
            if !rows.0.iter().any(|(name, _)| name == needed) {
                return error(format!("there is no row {needed:?}"));
            }
        }
        let (mut inputs, mut columns) = (Vec::new(), Vec::new());
        for at in 0..rows.0[0].1.len() {
            let mut present = 0;
            for section in 0..sections {
                present |= u16::from(rows.on(&format!("hears {section}"), at, '.')?) << section;
            }
            inputs.push(Input {
                check_in: rows.on("in", at, '.')?,
                check_out: rows.on("out", at, '.')?,
                present: SectionSet::from_bits(present),
                reset: rows.number("reset", at)?.map(TrainCount),
                ahead_hold: rows.number("asks", at)?.and_then(Hold::new).unwrap_or_default(),
                ahead_entered: rows.on("ahead", at, '#')?,
            });
            let mut column = String::new();
            for (name, signs) in [("count", "0123456789"), ("status", "uczms")] {
                let sign = rows.sign(name, at, '.');
                if !signs.contains(sign) {
                    return error(format!("{sign:?} is not a sign of the row {name:?}"));
                }
                column.push(sign);
            }
            for name in &reports {
                let sign = rows.sign(name, at, '.');
                if !".dha".contains(sign) {
                    return error(format!("{sign:?} is not a sign of the row {name:?}"));
                }
                column.push(sign);
            }
            write!(column, "{}", rows.number("behind", at)?.unwrap_or(0))
                .map_err(|_| BlockChartError(String::new()))?;
            columns.push(column);
        }
        Ok(Self { inputs, columns })
    }

    /// Runs the chart on the kernel.
    ///
    /// # Errors
    /// The first cycle in which the kernel puts out something else.
    ///
    /// # Panics
    /// If the kernel reaches a state that is not valid.
    pub fn check_kernel(&self, block: Block) -> Result<(), BlockChartError> {
        let mut state = State::INITIAL;
        let outputs = self.inputs.iter().map(|input| {
            let (next, output) = step(block, state, *input);
            assert!(next.is_valid(block), "the kernel reached an invalid state: {next:?}");
            state = next;
            let status = output.status == Status::Counting;
            assert!(output.agree <= status, "agreement of a count that is not in force");
            output.into()
        });
        self.compare("kernel", &outputs.collect::<Vec<_>>())
    }

    /// Runs the chart on a process that speaks protocol 1.
    ///
    /// # Errors
    /// If the process cannot be run or answers otherwise than with outputs; or the first cycle with another output.
    pub fn check_process(&self, program: &Path, config: &Config) -> Result<(), BlockChartError> {
        let outputs = process(program, config, &self.inputs).map_err(|refused| BlockChartError(refused.0))?;
        self.compare("process", &outputs)
    }

    fn compare(&self, device: &str, outputs: &[Output]) -> Result<(), BlockChartError> {
        for (at, ((input, column), output)) in self.inputs.iter().zip(&self.columns).zip(outputs).enumerate() {
            let said = said(*input, *output, column.len() - 3);
            if said != *column {
                return error(format!(
                    "{device}: column {at} (count, status, reports, behind) is {said}, the chart has {column}"
                ));
            }
        }
        if outputs.len() == self.columns.len() { Ok(()) } else { error(format!("{device}: too few outputs")) }
    }
}

/// Checks a chart against the kernel and against the device under test.
///
/// # Panics
/// If one of them puts out something else, or the chart or the configuration cannot be read.
pub fn check(config: &Config, chart: &str) {
    let compare = || {
        let sections = u8::try_from(config.sections).map_err(|error| BlockChartError(error.to_string()))?;
        let parsed = BlockChart::parse(chart, sections)?;
        parsed.check_kernel(config.block().map_err(|refusal| BlockChartError(refusal.what))?)?;
        parsed.check_process(&device(), config)
    };
    if let Err(error) = compare() {
        panic!("{error}\n{chart}");
    }
}

/// An output as a column of a chart.
fn said(input: Input, output: Output, sections: usize) -> String {
    let status = match (output.fault, output.counting) {
        (None, Some(false)) => 'u',
        (None, _) => 'c',
        (Some(Fault::CheckOutAtZero), _) => 'z',
        (Some(Fault::CheckInAtMaximum), _) => 'm',
        (Some(Fault::CheckInStaysOn), _) => 's',
    };
    let reports = (0..16).take(sections).map(|section| match () {
        () if !output.occupied.0.contains(section) => '.',
        () if !output.agree => 'a',
        () if input.present.contains(section) => 'd',
        () => 'h',
    });
    format!("{}{status}{}{}", output.count, reports.collect::<String>(), output.behind_hold_sections)
}

/// A kernel input as the body of a step.
pub fn step_of(input: Input) -> Value {
    let present: Vec<_> = (0..16_u8).filter(|section| input.present.contains(*section)).collect();
    json!({
        "check_in": input.check_in,
        "check_out": input.check_out,
        "present": present,
        "reset": input.reset.map(|verified| verified.0),
        "ahead_hold_sections": input.ahead_hold.sections(),
        "ahead_entered": input.ahead_entered,
    })
}

/// The lines of a case: its start and its steps.
pub fn lines(config: &Config, inputs: &[Input]) -> Vec<String> {
    let start = json!({"start": {"protocol": 1, "machine": "block-count", "config": config}});
    let steps = inputs.iter().map(|input| json!({ "step": step_of(*input) }));
    std::iter::once(start).chain(steps).map(|line| format!("{line}\n")).collect()
}

/// What a process that speaks protocol 1 puts out.
///
/// # Errors
/// If the process cannot be run, or answers a request other than with its started or output reply.
pub fn process(program: &Path, config: &Config, inputs: &[Input]) -> Result<Vec<Output>, Refused> {
    let lines = lines(config, inputs);
    let replies = converse(program, lines.concat().into_bytes()).map_err(|error| Refused(error.to_string()))?;
    match replies.first() {
        Some(reply) if reply.starts_with("{\"started\"") => {}
        other => return Err(Refused(format!("the start was answered by {other:?}"))),
    }
    let outputs = replies[1..].iter().map(|reply| {
        let output = serde_json::from_str::<Value>(reply).ok().and_then(|reply| reply.get("output").cloned());
        let output = output.and_then(|output| serde_json::from_value(output).ok());
        output.ok_or_else(|| Refused(format!("a step was answered by {reply}")))
    });
    let outputs: Vec<_> = outputs.collect::<Result<_, _>>()?;
    if outputs.len() == inputs.len() { Ok(outputs) } else { Err(Refused("steps were not answered".to_owned())) }
}
