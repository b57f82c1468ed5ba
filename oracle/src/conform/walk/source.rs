//! Where the walks of a machine come from, and the numbers that they share.

use serde_json::Value;

use crate::conform::random::Random;

/// The steps of one case, one after the other.
pub trait Walk {
    /// The next step. `last` is the body of the kernel's last output; none at the first step.
    fn next(&mut self, random: &mut Random, last: Option<&Value>) -> Value;
}

/// Where the walks of a machine come from.
#[derive(Clone, Copy)]
pub struct Source {
    /// The machine.
    pub machine: &'static str,
    /// Configurations with times of a few cycles: differences come early, and traces are short.
    pub(super) small: fn() -> Vec<Value>,
    /// Configurations as lines have them.
    pub(super) large: fn() -> Vec<Value>,
    /// Configurations that break a rule, each by one step over a limit.
    pub(super) wrong: fn() -> Vec<Value>,
    /// Begins a walk for a configuration and the body of the started reply.
    pub(super) begin: fn(&Value, &Value, &mut Random) -> Box<dyn Walk>,
    /// The most steps of a walk on a small and on a large configuration.
    pub(super) most: (usize, usize),
    /// The most steps on a configuration that the user has.
    pub(super) own: usize,
}

/// A number of tenths, as a JSON number of wholes.
pub(super) fn tenths(tenths: i64) -> Value {
    parts(tenths, 10)
}

/// A number of parts, of which so many make one, as a JSON number.
#[expect(clippy::cast_precision_loss, reason = "the numbers of a walk are small")]
pub(super) fn parts(parts: i64, of_one: i64) -> Value {
    if parts % of_one == 0 { (parts / of_one).into() } else { (parts as f64 / of_one as f64).into() }
}

/// The number below a name of the cycles in a started reply; 1 if there is none.
pub(super) fn cycles(started: &Value, name: &str) -> i64 {
    started["cycles"][name].as_i64().unwrap_or(1).max(1)
}

/// Each of these numbers, one less and one more, none below the least.
pub(super) fn around(numbers: &[i64], least: i64) -> Vec<i64> {
    let mut around: Vec<i64> = numbers.iter().flat_map(|number| [number - 1, *number, number + 1]).collect();
    around.retain(|number| *number >= least);
    around
}
