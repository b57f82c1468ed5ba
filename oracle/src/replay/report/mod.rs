//! What a replay says: as text, as JSON, as JUnit and as one HTML page.

mod html;
mod junit;
mod merge;
mod text;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::conform::fields::{Difference, Level};
use crate::conform::profile::Profile;
use crate::conform::report::Word;

pub use html::page;
pub use junit::junit;
pub use merge::merge;
pub use text::text;

/// The version of the form of the JSON report.
pub const FORM: u32 = 1;

/// A replay, as the JSON report has it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[schemars(rename = "ReplayReport")]
pub struct Report {
    /// The version of the form.
    pub form: u32,
    /// The version of the oracle that compared.
    pub oracle: String,
    /// How much of a reply was compared.
    pub level: Level,
    /// What is known and what is left out.
    pub profile: Profile,
    /// The logs.
    pub input: Input,
    /// Which part of the sessions was drawn: "1/1" for all of them.
    pub sample: String,
    /// The seed of the sample.
    pub seed: u64,
    /// Which part of the logs this is; none for all of them.
    pub shard: Option<Shard>,
    /// The most differences that are told.
    pub most_differences: u64,
    /// When the run began, in seconds since 1970.
    pub began: u64,
    /// How long it took, in seconds; of several shards, all of it together.
    pub seconds: f64,
    /// Whether everything was read, all that was compared is the same, and anything was compared.
    pub agrees: bool,
    /// How many bytes were read.
    pub bytes: u64,
    /// How many sessions the sample leaves out.
    pub left_out: u64,
    /// How many sessions end with their file and without a stop: a recorder that was switched off, or a file that is cut between two lines.
    pub without_stop: u64,
    /// The machines that there are sessions of.
    pub machines: Vec<OfMachine>,
    /// The first difference of each session that differs, the first sessions first.
    pub differences: Vec<Differing>,
    /// How many places there are from which on something was not read.
    pub unread_in_all: u64,
    /// These places, the first ones first, up to 1000.
    pub unread: Vec<Unread>,
}

/// The logs of a replay.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[schemars(rename = "ReplayInput")]
pub struct Input {
    /// How many files.
    pub files: u64,
    /// How many bytes they have.
    pub bytes: u64,
    /// The SHA-256 of their names and lengths.
    pub identity: String,
}

/// A part of the logs.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[schemars(rename = "ReplayShard")]
pub struct Shard {
    /// Which part, from 1.
    pub index: u64,
    /// Of how many.
    pub of: u64,
}

/// What became of the sessions of a machine.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[schemars(rename = "ReplayOfMachine")]
pub struct OfMachine {
    /// The machine.
    pub machine: String,
    /// The verdict.
    pub verdict: Word,
    /// Why it was not compared; which known difference is gone.
    pub note: Option<String>,
    /// How many sessions were compared.
    pub sessions: u64,
    /// How many of them are the same in every step.
    pub agree: u64,
    /// How many differ.
    pub differ: u64,
    /// How many are the same as far as they could be read, which is not to their end.
    pub unfinished: u64,
    /// How many the profile leaves out.
    pub skipped: u64,
    /// How many steps are the same.
    pub steps: u64,
    /// How many steps differ.
    pub steps_that_differ: u64,
    /// The known differences that showed: their places in the profile, from 0.
    pub known: Vec<u64>,
}

/// A session that differs, with its first difference.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[schemars(rename = "ReplayDifference")]
pub struct Differing {
    /// The file.
    pub file: String,
    /// The byte that the session begins at, from 0.
    pub offset: u64,
    /// The line of its start, from 1.
    pub session_line: u64,
    /// The line of the request.
    pub request_line: u64,
    /// The line of the reply that differs.
    pub line: u64,
    /// The machine.
    pub machine: String,
    /// Where: "start", "step" or "stop".
    pub at: String,
    /// Which step of the session, from 1; none at a start or a stop.
    pub step: Option<u64>,
    /// How many steps of the session differ.
    pub steps_that_differ: u64,
    /// The requirements that speak of the first field, those of a guess that fits first.
    pub requirements: Vec<String>,
    /// All fields that differ, the dangerous ones first.
    pub fields: Vec<Difference>,
    /// What stands there in place of a reply that can be compared.
    pub broken: Option<String>,
    /// The line of the first step that did not have its reply before the next step came: a reply may be lost there.
    pub late_from_line: Option<u64>,
    /// Changes of the configuration with which the kernel gives the same replies. For the first ten differences, if they come early.
    pub as_if: Vec<String>,
    /// The lines of the session up to the difference, under the same conditions.
    pub session: Vec<String>,
}

/// A place from which on a log was not read.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[schemars(rename = "ReplayUnread")]
pub struct Unread {
    /// The file, or the shard that is missing.
    pub file: String,
    /// The line, from 1; 0 for all of it.
    pub line: u64,
    /// Why, and what would be right.
    pub reason: String,
    /// The line that the reason is about, where that is another one.
    pub about_line: Option<u64>,
    /// How many lines behind it were passed over, up to the next start or the end of the file.
    pub lines_passed_over: u64,
}

impl Unread {
    /// Something that was not read at all.
    pub fn whole(file: String, reason: impl Into<String>) -> Self {
        Self { file, line: 0, reason: reason.into(), about_line: None, lines_passed_over: 0 }
    }
}

impl Differing {
    /// Takes out what only the first differences of a report have.
    fn unexplained(&mut self) {
        self.as_if = Vec::new();
        self.session = Vec::new();
        let ids = self.fields.first().map(|field| field.requirements.iter().map(|&id| id.to_owned()).collect());
        self.requirements = ids.unwrap_or_default();
    }
}

impl Report {
    /// How many sessions were compared.
    pub fn sessions(&self) -> u64 {
        self.machines.iter().map(|machine| machine.sessions).sum()
    }

    /// How many steps were compared.
    pub fn steps(&self) -> u64 {
        self.machines.iter().map(|machine| machine.steps + machine.steps_that_differ).sum()
    }

    /// Whether every session of the logs was to be compared.
    fn is_whole(&self) -> bool {
        self.shard.is_none() && self.sample == WHOLE
    }

    /// Gives the verdicts, from the counts.
    pub(super) fn judge(&mut self) {
        let whole = self.is_whole();
        for machine in &mut self.machines {
            let gone = (0_u64..).zip(&self.profile.known);
            let gone = gone.filter(|(place, known)| known.machine == machine.machine && !machine.known.contains(place));
            let gone: Vec<_> = gone.map(|(_, known)| format!("{}: {}", known.field, known.reason)).collect();
            (machine.verdict, machine.note) = if machine.differ > 0 {
                (Word::Differs, None)
            } else if let Some(reason) = self.profile.skips(&machine.machine) {
                (Word::NotCompared, Some(format!("the profile leaves it out: {reason}")))
            } else if machine.agree == 0 && machine.steps == 0 {
                (Word::NotCompared, Some("no session of it could be read".to_owned()))
            } else if whole && !gone.is_empty() {
                // A sample, or one shard, does not see everything.
                let gone = gone.join("; ");
                (Word::KnownDifferenceGone, Some(format!("it did not show, take it out of the profile: {gone}")))
            } else {
                (Word::Agrees, None)
            };
        }
        let word = |word| self.machines.iter().any(|machine| machine.verdict == word);
        let bad = word(Word::Differs) || word(Word::KnownDifferenceGone);
        self.agrees = self.unread_in_all == 0 && !bad && word(Word::Agrees);
    }

    /// The exit code: 0 if everything agrees, 1 if something differs or nothing was compared, 2 if something was not read.
    pub fn code(&self) -> u8 {
        let bad = |machine: &OfMachine| matches!(machine.verdict, Word::Differs | Word::KnownDifferenceGone);
        // A shard may be without a session of its own.
        let empty_shard = self.shard.is_some() && !self.machines.iter().any(bad);
        match (self.unread_in_all, self.agrees) {
            (0, true) => 0,
            (0, false) => u8::from(!empty_shard),
            _ => 2,
        }
    }

    /// What the known differences of a machine are that showed.
    fn known<'a>(&'a self, machine: &'a OfMachine) -> impl Iterator<Item = String> + 'a {
        let known = machine.known.iter().filter_map(|place| self.profile.known.get(usize::try_from(*place).ok()?));
        known.map(|known| format!("{}: {}", known.field, known.reason))
    }
}

/// The sample that is everything.
pub(super) const WHOLE: &str = "1/1";

/// The JSON Schema of the report.
pub fn schema() -> String {
    format!("{:#}\n", schemars::schema_for!(Report).to_value())
}
