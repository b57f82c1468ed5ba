//! Lock step: a case on the other side, reply by reply against the kernel's.

use std::collections::BTreeSet;

use serde_json::Value;

use super::case::{Expected, STOP, step_line};
use super::fields::{Difference, Level, compare, compare_cycles, start_difference};
use super::profile::Profile;
use super::side::{Broken, Side};

/// How replies are compared.
#[derive(Clone, Copy)]
pub struct Judge<'a> {
    /// How much of a reply.
    pub level: Level,
    /// What is known and what is left out.
    pub profile: &'a Profile,
}

/// Where in a case something was found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum At {
    /// In the reply to the start.
    Start,
    /// In the reply to the step of this number, from 0.
    Step(usize),
    /// In the reply to the stop.
    Stop,
}

/// What was found.
#[derive(Clone, Debug, PartialEq)]
pub enum Finding {
    /// The fields that differ, the dangerous ones first.
    Differs(Vec<Difference>),
    /// There is no reply to compare.
    Broken(Broken),
}

/// The first thing that is wrong in a case.
#[derive(Clone, Debug)]
pub struct Found {
    /// Where.
    pub at: At,
    /// What.
    pub finding: Finding,
    /// The replies of the other side to the steps before and at the finding, for the chart.
    pub replies: Vec<String>,
}

/// What stays the same while a trace is made shorter.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Kind {
    at: u8,
    what: String,
    dangerous: bool,
}

/// A case that was played to its end without a finding.
#[derive(Clone, Debug, Default)]
pub struct Agreed {
    /// The places of the known differences that showed.
    pub known: BTreeSet<usize>,
    /// What the other side says when it rejects a start that the kernel takes: the machine may not be there.
    pub rejected: Option<String>,
}

impl Found {
    /// What must stay the same while the trace is made shorter: the place, the first field, and whether it is dangerous.
    pub fn kind(&self) -> Kind {
        let at = match self.at {
            At::Start => 0,
            At::Step(_) => 1,
            At::Stop => 2,
        };
        let (what, dangerous) = match &self.finding {
            Finding::Differs(differences) => {
                let first = differences.first();
                (first.map(Difference::base).unwrap_or_default().to_owned(), first.is_some_and(|first| first.dangerous))
            }
            Finding::Broken(broken) => (broken.name().to_owned(), false),
        };
        Kind { at, what, dangerous }
    }

    /// The requirements that speak of the first field.
    pub fn requirements(&self) -> &[&'static str] {
        match &self.finding {
            Finding::Differs(differences) => differences.first().map_or(&[], |first| &first.requirements),
            Finding::Broken(_) => &[],
        }
    }
}

struct Player<'a> {
    side: &'a mut Side,
    judge: Judge<'a>,
    machine: &'a str,
    replies: Vec<String>,
    agreed: Agreed,
}

/// Plays a case. After a finding the process of the other side is ended: what state it is in is not known.
///
/// # Errors
/// The first finding.
pub fn play(expected: &Expected, side: &mut Side, judge: Judge<'_>) -> Result<Agreed, Box<Found>> {
    let machine = expected.case.machine.as_str();
    let mut player = Player { side, judge, machine, replies: Vec::new(), agreed: Agreed::default() };
    let played = player.play(expected);
    match played {
        Ok(()) => Ok(player.agreed),
        Err((at, finding)) => {
            player.side.end();
            Err(Box::new(Found { at, finding, replies: player.replies }))
        }
    }
}

impl Player<'_> {
    fn play(&mut self, expected: &Expected) -> Result<(), (At, Finding)> {
        let open = self.start(expected).map_err(|finding| (At::Start, finding))?;
        if !open {
            return Ok(());
        }
        for (number, (step, output)) in expected.case.steps.iter().zip(&expected.outputs).enumerate() {
            self.step(step, output).map_err(|finding| (At::Step(number), finding))?;
        }
        let reply = self.ask(STOP).map_err(|finding| (At::Stop, finding))?;
        kind_of(&reply, "stopped").map(drop).map_err(|finding| (At::Stop, finding))
    }

    /// Whether the case is open on both sides.
    fn start(&mut self, expected: &Expected) -> Result<bool, Finding> {
        let reply = self.ask(&expected.case.start_line())?;
        let ours = if expected.is_rejected() { "rejected" } else { "started" };
        let body = json(&reply)?;
        let theirs = if body.get("rejected").is_some() { "rejected" } else { "started" };
        if theirs == "started" {
            kind_of(&reply, "started")?;
        }
        if ours != theirs {
            if theirs == "rejected" {
                self.agreed.rejected = Some(body["rejected"]["reason"].as_str().unwrap_or_default().to_owned());
            }
            self.differ(vec![start_difference(self.machine, ours, theirs)])?;
            // Known: there is nothing to go on with; what one side has open is closed.
            if theirs == "started" {
                self.ask(STOP)?;
            }
            return Ok(false);
        }
        if ours == "rejected" {
            return Ok(false);
        }
        let started: Value = serde_json::from_str(&expected.start).unwrap_or_default();
        let (started, theirs) = (&started["started"], &body["started"]);
        for (field, right) in [("protocol", started["protocol"].clone()), ("machine", self.machine.into())] {
            if theirs.get(field) != Some(&right) {
                return Err(Finding::Broken(Broken::WrongReply("started", shorten(&reply))));
            }
        }
        self.differ(compare_cycles(self.machine, started, theirs))?;
        Ok(true)
    }

    fn step(&mut self, step: &Value, output: &str) -> Result<(), Finding> {
        let reply = self.ask(&step_line(step))?;
        if reply == output {
            self.replies.push(reply);
            return Ok(());
        }
        let theirs = kind_of(&reply, "output")?;
        self.replies.push(reply);
        let ours: Value = serde_json::from_str(output).unwrap_or_default();
        self.differ(compare(self.machine, self.judge.level, &ours["output"], &theirs["output"]))
    }

    fn ask(&mut self, line: &str) -> Result<String, Finding> {
        self.side.ask(line).map_err(Finding::Broken)
    }

    fn differ(&mut self, mut differences: Vec<Difference>) -> Result<(), Finding> {
        self.judge.profile.without_ignored(self.machine, &mut differences);
        self.agreed.known.extend(self.judge.profile.take_known(self.machine, &mut differences));
        if differences.is_empty() { Ok(()) } else { Err(Finding::Differs(differences)) }
    }
}

/// A reply as JSON, if it is of this kind.
fn kind_of(reply: &str, due: &'static str) -> Result<Value, Finding> {
    let body = json(reply)?;
    match body.get(due) {
        Some(Value::Object(_)) => Ok(body),
        _ => Err(Finding::Broken(Broken::WrongReply(due, shorten(reply)))),
    }
}

fn json(reply: &str) -> Result<Value, Finding> {
    match serde_json::from_str::<Value>(reply) {
        Ok(body @ Value::Object(_)) => Ok(body),
        _ => Err(Finding::Broken(Broken::Garbage(shorten(reply)))),
    }
}

/// The beginning of a reply, for a message.
fn shorten(reply: &str) -> String {
    const MOST: usize = 160;
    if reply.chars().count() <= MOST {
        return reply.to_owned();
    }
    format!("{}…", reply.chars().take(MOST).collect::<String>())
}
