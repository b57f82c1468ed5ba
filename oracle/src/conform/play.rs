//! Lock step: a case on the other side, reply by reply against the kernel's.

use std::collections::BTreeSet;

use serde_json::Value;

use super::case::{Expected, STOP, is_rejected, step_line};
use super::fields::{Difference, Level, compare, compare_cycles, start_difference};
use super::profile::Profile;
use super::side::{Answers, Broken};

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
    side: &'a mut dyn Answers,
    judge: Judge<'a>,
    machine: &'a str,
    replies: Vec<String>,
    agreed: Agreed,
}

/// Plays a case. After a finding the process of the other side is ended: what state it is in is not known.
///
/// # Errors
/// The first finding.
pub fn play(expected: &Expected, side: &mut dyn Answers, judge: Judge<'_>) -> Result<Agreed, Box<Found>> {
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
        self.judge.stop(&reply).map_err(|finding| (At::Stop, finding))
    }

    /// Whether the case is open on both sides.
    fn start(&mut self, expected: &Expected) -> Result<bool, Finding> {
        let reply = self.ask(&expected.case.start_line())?;
        let opened = self.judge.start(self.machine, &expected.start, &reply, &mut self.agreed)?;
        // Known: there is nothing to go on with; what one side has open is closed.
        if opened == Opened::Theirs {
            self.ask(STOP)?;
        }
        Ok(opened == Opened::Both)
    }

    fn step(&mut self, step: &Value, output: &str) -> Result<(), Finding> {
        let reply = self.ask(&step_line(step))?;
        let judged = self.judge.output(self.machine, output, &reply, &mut self.agreed);
        if !matches!(judged, Err(Finding::Broken(_))) {
            self.replies.push(reply);
        }
        judged
    }

    fn ask(&mut self, line: &str) -> Result<String, Finding> {
        self.side.ask(line).map_err(Finding::Broken)
    }
}

/// Where a case is open after the replies to its start.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Opened {
    /// On both sides.
    Both,
    /// On none: both reject the start.
    None,
    /// In the kernel only, as it is known.
    Ours,
    /// On the other side only, as it is known.
    Theirs,
}

impl Judge<'_> {
    /// Holds a reply to a start against the kernel's, a line each.
    ///
    /// # Errors
    /// What differs and is not known, or that it is no reply to a start.
    pub fn start(self, machine: &str, expected: &str, reply: &str, agreed: &mut Agreed) -> Result<Opened, Finding> {
        let ours = if is_rejected(expected) { "rejected" } else { "started" };
        let body = json(reply)?;
        let theirs = if body.get("rejected").is_some() { "rejected" } else { "started" };
        if theirs == "started" {
            kind_of(reply, "started")?;
        }
        if ours != theirs {
            if theirs == "rejected" {
                agreed.rejected = Some(body["rejected"]["reason"].as_str().unwrap_or_default().to_owned());
            }
            self.differ(machine, vec![start_difference(machine, ours, theirs)], agreed)?;
            return Ok(if theirs == "started" { Opened::Theirs } else { Opened::Ours });
        }
        if ours == "rejected" {
            return Ok(Opened::None);
        }
        let started: Value = serde_json::from_str(expected).unwrap_or_default();
        let (started, theirs) = (&started["started"], &body["started"]);
        for (field, right) in [("protocol", started["protocol"].clone()), ("machine", machine.into())] {
            if theirs.get(field) != Some(&right) {
                return Err(Finding::Broken(Broken::WrongReply("started", shorten(reply))));
            }
        }
        self.differ(machine, compare_cycles(machine, started, theirs), agreed)?;
        Ok(Opened::Both)
    }

    /// Holds a reply to a step against the kernel's output, a line each.
    ///
    /// # Errors
    /// What differs and is not known, or that it is no output.
    pub fn output(self, machine: &str, expected: &str, reply: &str, agreed: &mut Agreed) -> Result<(), Finding> {
        if reply == expected {
            return Ok(());
        }
        let theirs = kind_of(reply, "output")?;
        let ours: Value = serde_json::from_str(expected).unwrap_or_default();
        self.differ(machine, compare(machine, self.level, &ours["output"], &theirs["output"]), agreed)
    }

    /// Looks whether a reply is one to a stop.
    ///
    /// # Errors
    /// That it is none.
    pub fn stop(self, reply: &str) -> Result<(), Finding> {
        kind_of(reply, "stopped").map(drop)
    }

    fn differ(self, machine: &str, mut differences: Vec<Difference>, agreed: &mut Agreed) -> Result<(), Finding> {
        self.profile.without_ignored(machine, &mut differences);
        agreed.known.extend(self.profile.take_known(machine, &mut differences));
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
pub(crate) fn shorten(reply: &str) -> String {
    const MOST: usize = 160;
    if reply.chars().count() <= MOST {
        return reply.to_owned();
    }
    format!("{}…", reply.chars().take(MOST).collect::<String>())
}
