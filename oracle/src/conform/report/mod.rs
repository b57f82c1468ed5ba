//! What a run says: as text, as JSON, as JUnit, as one HTML page, and as a badge.

mod badge;
mod html;
mod junit;
mod text;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::alike::Alike;
use super::case::{Expected, step_line};
use super::fields::{Difference, Level};
use super::play::{At, Finding};
use super::reached::Reached;
use super::run::{Machine, Run, Verdict};
use super::shrink::Trace;
use crate::chart::{self, View};
use crate::trace::Replies;

pub use badge::badge;
pub use html::{Past, page};
pub(crate) use html::{class, fields_table, frame, instant};
pub use junit::junit;
pub(crate) use junit::{Entry, write_junit};
pub(crate) use text::fields_text;
pub use text::text;

/// The version of the form of the JSON report.
pub const FORM: u32 = 1;

/// A run, as the JSON report has it.
#[derive(Clone, Debug, Serialize, JsonSchema)]
#[schemars(rename = "ConformanceReport")]
pub struct Report {
    /// The version of the form.
    pub form: u32,
    /// The version of the oracle that compared.
    pub oracle: &'static str,
    /// The name of the implementation, if the profile has one.
    pub implementation: Option<String>,
    /// The command of the other side.
    pub command: String,
    /// The seed of the walks.
    pub seed: u64,
    /// How much of a reply was compared.
    pub level: Level,
    /// Whether vectors were run in place of walks.
    pub vectors: bool,
    /// When the run began, in seconds since 1970.
    pub began: u64,
    /// Whether everything that was compared is the same, and anything was.
    pub agrees: bool,
    /// The machines.
    pub machines: Vec<OfMachine>,
    /// The last that the other side said on standard error.
    pub stderr: String,
}

/// The verdict on a machine, as one word.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Word {
    /// Everything that was compared is the same.
    Agrees,
    /// A reply differs.
    Differs,
    /// There was no reply to compare.
    Broken,
    /// A known difference did not show.
    KnownDifferenceGone,
    /// It was not compared.
    NotCompared,
}

impl Word {
    /// The word.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Agrees => "agrees",
            Self::Differs => "differs",
            Self::Broken => "broken",
            Self::KnownDifferenceGone => "known difference is gone",
            Self::NotCompared => "not compared",
        }
    }
}

/// What became of a machine.
#[derive(Clone, Debug, Serialize, JsonSchema)]
#[schemars(rename = "ConformanceOfMachine")]
pub struct OfMachine {
    /// The machine.
    pub machine: String,
    /// The verdict.
    pub verdict: Word,
    /// Why it was not compared; which known difference is gone.
    pub note: Option<String>,
    /// How many cases were the same.
    pub cases: u64,
    /// How many steps were the same.
    pub steps: u64,
    /// How long it took, in seconds.
    pub seconds: f64,
    /// The known differences that showed: field and reason.
    pub known: Vec<String>,
    /// The limits that no walk has decided, a cycle or one off: of a configuration of the user's own, where both sides agree.
    pub undecided: Vec<String>,
    /// How many routes were in use in these walks, and of how many.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub routes_used: Option<[usize; 2]>,
    /// The first difference.
    pub difference: Option<First>,
}

/// The first difference of a machine, made short.
#[derive(Clone, Debug, Serialize, JsonSchema)]
#[schemars(rename = "ConformanceDifference")]
pub struct First {
    /// Where: "start", "step" or "stop".
    pub at: &'static str,
    /// Which step of the trace's last case, from 1; none at a start or a stop.
    pub step: Option<usize>,
    /// All fields that differ, the dangerous ones first.
    pub fields: Vec<Difference>,
    /// What the other side did in place of a reply: the kind, and a sentence.
    pub broken: Option<(&'static str, String)>,
    /// The requirements that speak of the first field, those of a guess that fits first.
    pub requirements: Vec<&'static str>,
    /// Changes of the configuration with which the kernel gives the same replies: "interruption_ms one cycle shorter (ACC-8)".
    pub as_if: Vec<String>,
    /// Whether it shows again in a new process.
    pub again: bool,
    /// Whether no step can be left out; false if the time for shrinking ran out first.
    pub minimal: bool,
    /// How many candidates were played to make it short.
    pub tries: u64,
    /// How many steps the trace has.
    pub steps: usize,
    /// The request lines, for either side.
    pub trace: Vec<String>,
}

/// The report of a run.
pub fn report(run: &Run) -> Report {
    Report {
        form: FORM,
        oracle: env!("CARGO_PKG_VERSION"),
        implementation: run.options.profile.implementation.clone(),
        command: run.options.command.clone(),
        seed: run.options.seed,
        level: run.options.level,
        vectors: !run.options.vectors.is_empty(),
        began: run.began,
        agrees: run.agrees(),
        machines: run.machines.iter().map(|machine| of_machine(run, machine)).collect(),
        stderr: run.said.clone(),
    }
}

/// The JSON Schema of the report.
pub fn schema() -> String {
    format!("{:#}\n", schemars::schema_for!(Report).to_value())
}

fn of_machine(run: &Run, machine: &Machine) -> OfMachine {
    let entry = |place: &usize| {
        let known = run.options.profile.known.get(*place);
        known.map(|known| format!("{}: {}", known.field, known.reason)).unwrap_or_default()
    };
    let (verdict, note) = match &machine.verdict {
        Verdict::Agrees => (Word::Agrees, None),
        Verdict::NotCompared(why) => (Word::NotCompared, Some(why.clone())),
        Verdict::Gone(gone) => {
            let gone: Vec<_> = gone.iter().map(entry).collect();
            (
                Word::KnownDifferenceGone,
                Some(format!("it did not show, take it out of the profile: {}", gone.join("; "))),
            )
        }
        Verdict::Differs(trace, _) if matches!(trace.found.finding, Finding::Broken(_)) => (Word::Broken, None),
        Verdict::Differs(..) => (Word::Differs, None),
    };
    OfMachine {
        machine: machine.name.clone(),
        verdict,
        note,
        cases: machine.cases,
        steps: machine.steps,
        seconds: machine.took.as_secs_f64(),
        known: machine.known.iter().map(entry).collect(),
        undecided: machine.reached.as_ref().map(Reached::undecided).unwrap_or_default(),
        routes_used: machine.reached.as_ref().and_then(Reached::routes),
        difference: match &machine.verdict {
            Verdict::Differs(trace, guesses) => Some(first(trace, guesses)),
            _ => None,
        },
    }
}

fn first(trace: &Trace, guesses: &[Alike]) -> First {
    let (at, step) = match trace.found.at {
        At::Start => ("start", None),
        At::Step(step) => ("step", Some(step + 1)),
        At::Stop => ("stop", None),
    };
    let (fields, broken) = match &trace.found.finding {
        Finding::Differs(differences) => (differences.clone(), None),
        Finding::Broken(broken) => (Vec::new(), Some((broken.name(), broken.to_string()))),
    };
    First {
        at,
        step,
        fields,
        broken,
        requirements: likeliest_first(trace.found.requirements(), guesses),
        as_if: guesses.iter().map(|guess| format!("{} ({})", guess.says, guess.requirement)).collect(),
        again: trace.again,
        minimal: trace.minimal,
        tries: trace.tries,
        steps: trace.steps(),
        trace: trace.lines(),
    }
}

fn likeliest_first(requirements: &[&'static str], guesses: &[Alike]) -> Vec<&'static str> {
    let mut all: Vec<_> = guesses.iter().map(|guess| guess.requirement).collect();
    all.dedup();
    for requirement in requirements {
        if !all.contains(requirement) {
            all.push(requirement);
        }
    }
    all
}

/// The last case of a trace as `oracle chart` reads it: with the kernel's replies, and with those of the other side. The last step stands
/// there once more, without a reply: an output is drawn from the end of its cycle on, and the last one would not be seen.
pub fn sessions(trace: &Trace) -> Option<(String, String)> {
    let last = trace.cases.last()?;
    let theirs = Expected { outputs: trace.found.replies.clone(), ..last.clone() };
    let text = |expected: &Expected| {
        let mut lines = expected.session();
        if let Some(step) = expected.case.steps.last() {
            lines.insert(lines.len() - 1, step_line(step));
        }
        lines.join("\n") + "\n"
    };
    Some((text(last), text(&theirs)))
}

/// The timing charts of both sides; none where there is nothing to draw.
pub fn charts(trace: &Trace) -> (Option<String>, Option<String>) {
    let Some((ours, theirs)) = sessions(trace) else { return (None, None) };
    let draw = |session: &str, title: &str| {
        let trace = crate::trace::Trace::parse(session).ok()?;
        let view = View { title: Some(title.to_owned()), ..View::default() };
        chart::svg(&trace, Replies::AsRecorded, &view).ok()
    };
    let ours = draw(&ours, "the kernel");
    let theirs = if trace.found.replies.is_empty() { None } else { draw(&theirs, "the other side") };
    (ours, theirs)
}
