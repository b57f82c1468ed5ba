//! What the walks of a run reach on a configuration of the user's own: which of its limits they decide, and which routes are used.
//!
//! That both sides agree says nothing of a limit that no walk reaches. So each limit is put one off, a cycle longer or shorter, and the kernel
//! plays the same walks again: one that gives every reply as before was not reached.

use std::collections::BTreeSet;
use std::time::{Duration, Instant};

use serde_json::Value;

use super::alike::{self, limits_of_a_file};
use super::case::{Expected, Kernel, is_rejected};
use super::fields::Level;
use super::walk;

/// Asks what the cases of a run reach, as they are played.
#[derive(Clone, Debug)]
pub struct Asking {
    /// Whether that is asked at all.
    asks: bool,
    /// Whether every case is looked at, however long that takes; if not, half of the time goes into it at most.
    all: bool,
    /// How much of a reply is compared in the run: what is not compared decides nothing.
    level: Level,
    spent: Duration,
    /// What was found; none if nothing was asked.
    pub reached: Option<Reached>,
}

impl Asking {
    /// Nothing was played yet.
    pub const fn new(asks: bool, all: bool, level: Level) -> Self {
        Self { asks, all, level, spent: Duration::ZERO, reached: None }
    }

    /// A case was played, in a run that takes so long by now.
    pub fn play(&mut self, expected: &Expected, taken: Duration) {
        if self.asks && (self.all || 2 * self.spent <= taken) {
            let began = Instant::now();
            self.reached.get_or_insert_with(|| Reached::of(expected)).play(expected, self.level);
            self.spent += began.elapsed();
        }
    }
}

/// What walks on one configuration have reached so far.
#[derive(Clone, Debug, Default)]
pub struct Reached {
    /// The limits that are not decided yet: a configuration with one of them off, and words for it.
    open: Vec<(Value, String)>,
    /// The routes that were in use.
    used: BTreeSet<String>,
    /// How many routes there are; none of a machine without routes.
    routes: Option<usize>,
}

impl Reached {
    /// Nothing, on the configuration of this case.
    pub fn of(expected: &Expected) -> Self {
        let machine = expected.case.machine.as_str();
        // The started reply has every default.
        let started: Value = serde_json::from_str(&expected.start).unwrap_or_default();
        let limits = limits_of_a_file(machine, &started["started"]["config"]);
        let open = limits.into_iter().map(|(config, says, requirement)| (config, format!("{says} ({requirement})")));
        Self { open: open.collect(), used: BTreeSet::new(), routes: walk::routes(machine, &expected.case.config) }
    }

    /// A case was played.
    pub fn play(&mut self, expected: &Expected, level: Level) {
        self.open.retain(|(config, _)| same(config, expected, level) == Some(true));
        if self.routes.is_some() {
            for output in expected.outputs.iter().filter(|output| output.contains("in-use")) {
                let output: Value = serde_json::from_str(output).unwrap_or_default();
                let phases = output["output"]["routes"].as_object().into_iter().flatten();
                self.used.extend(phases.filter(|(_, phase)| *phase == "in-use").map(|(name, _)| name.clone()));
            }
        }
    }

    /// The limits that no case has decided.
    pub fn undecided(&self) -> Vec<String> {
        self.open.iter().map(|(_, says)| says.clone()).collect()
    }

    /// How many routes were in use, and of how many; none of a machine without routes.
    pub fn routes(&self) -> Option<[usize; 2]> {
        self.routes.map(|routes| [self.used.len(), routes])
    }
}

/// Whether the kernel's replies to a case are the same with another configuration; none if it does not take that: then it is no other limit.
fn same(config: &Value, expected: &Expected, level: Level) -> Option<bool> {
    let mut case = expected.case.clone();
    case.config = config.clone();
    let mut kernel = Kernel::new();
    let start = kernel.start(&case).ok()?;
    if is_rejected(&start) {
        return None;
    }
    let mut replies = expected.case.steps.iter().zip(&expected.outputs);
    let machine = case.machine.as_str();
    Some(replies.all(|(step, output)| kernel.step(step).is_ok_and(|other| alike::same(machine, level, output, &other))))
}
