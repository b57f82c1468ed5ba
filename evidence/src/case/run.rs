//! How the run went, as data: what of the manifest it looked at, and where its time went. A comparison of cases leaves
//! it out.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// What of the manifest was to be looked at, and where the time went.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Run {
    /// The part of the railway that the run was about; nothing: all of it.
    pub part: Option<String>,
    /// The shard that the run was, such as `2/4`; nothing: the run was not shared.
    pub shard: Option<String>,
    /// The run goes on: this is a page of what has come in so far.
    pub running: bool,
    /// The shards that the case was joined from.
    pub joined: Vec<String>,
    /// The end of the earlier run of this very commit from which results stand (seconds since 1970); nothing: all ran now.
    pub kept_since: Option<u64>,
    /// Where the time went.
    pub phases: Vec<Phase>,
}

/// One phase of a run.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Phase {
    /// Its name.
    pub name: String,
    /// How many items it had.
    pub items: usize,
    /// Seconds by the clock.
    pub wall_seconds: f64,
    /// Seconds of processors, those of all programs that it started and that ended included.
    pub cpu_seconds: f64,
    /// The items that took longest: name and seconds.
    pub slowest: Vec<(String, f64)>,
}

impl Run {
    /// Why this is not a whole run; nothing if it is one.
    pub fn partial(&self) -> Option<String> {
        let what = match (&self.part, &self.shard) {
            (Some(part), _) => Some(format!("Only a part of the railway, {part}, was run.")),
            (_, Some(shard)) => Some(format!("This is shard {shard} of a run, and no case by itself.")),
            _ => None,
        };
        let running = self.running.then(|| "The run has not ended.".to_owned());
        let words: Vec<_> = running.into_iter().chain(what).collect();
        (!words.is_empty()).then(|| words.join(" "))
    }
}
