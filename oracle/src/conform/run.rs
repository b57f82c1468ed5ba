//! A run: machine by machine, walk after walk, until time is up or a difference is found and made short.

use std::collections::BTreeSet;
use std::time::{Duration, Instant};

use serde_json::Value;

use super::alike::{Alike, alike};
use super::case::{Case, Expected};
use super::fields::Level;
use super::play::{At, Finding, Found, Judge, play};
use super::profile::Profile;
use super::reached::{Asking, Reached};
use super::shrink::{Trace, shrink};
use super::side::{Answers as _, Broken, Side};
use super::vector::Vector;
use super::walk::{self, Sizes};
use atc_protocol::machine::KINDS;

/// What is asked for.
#[derive(Clone, Debug)]
pub struct Options {
    /// The command of the other side, for `sh -c`.
    pub command: String,
    /// The machines; all, if there are none.
    pub machines: Vec<String>,
    /// The seed of the walks.
    pub seed: u64,
    /// How long the run may take, over all machines, without the shrinking.
    pub time: Duration,
    /// The most cases a machine has; for runs that are the same on every computer.
    pub cases: Option<u64>,
    /// The one configuration of every case.
    pub config: Option<Value>,
    /// How long the other side has for each reply.
    pub patience: Duration,
    /// How long the shrinking of one difference may take.
    pub shrink: Duration,
    /// How much of a reply is compared.
    pub level: Level,
    /// What is known.
    pub profile: Profile,
    /// The vectors that are run in place of walks.
    pub vectors: Vec<Vector>,
}

/// What became of one machine.
#[derive(Clone, Debug)]
pub struct Machine {
    /// Its name.
    pub name: String,
    /// The verdict.
    pub verdict: Verdict,
    /// How many cases were compared.
    pub cases: u64,
    /// How many steps were compared.
    pub steps: u64,
    /// How long it took, shrinking included.
    pub took: Duration,
    /// The places of the known differences that showed.
    pub known: BTreeSet<usize>,
    /// What its walks reach on a configuration of the user's own, if it agrees.
    pub reached: Option<Reached>,
}

/// A verdict.
#[derive(Clone, Debug)]
pub enum Verdict {
    /// Everything that was compared is the same.
    Agrees,
    /// Something differs, or there was no reply.
    Differs(Box<Trace>, Vec<Alike>),
    /// It was not compared; why.
    NotCompared(String),
    /// Known differences did not show: their places in the profile.
    Gone(Vec<usize>),
}

/// A whole run.
#[derive(Clone, Debug)]
pub struct Run {
    /// What was asked for.
    pub options: Options,
    /// The machines.
    pub machines: Vec<Machine>,
    /// The last that the other side said on standard error.
    pub said: String,
    /// When it began, in seconds since 1970.
    pub began: u64,
}

impl Run {
    /// Whether everything that was compared is the same, and anything was.
    pub fn agrees(&self) -> bool {
        let bad = |machine: &Machine| matches!(machine.verdict, Verdict::Differs(..) | Verdict::Gone(_));
        let agreed = |machine: &Machine| matches!(machine.verdict, Verdict::Agrees);
        self.machines.iter().any(agreed) && !self.machines.iter().any(bad)
    }
}

/// Compares. `progress` hears of every machine as it is done.
pub fn run(options: Options, mut progress: impl FnMut(&Machine)) -> Run {
    let began = std::time::SystemTime::now().duration_since(std::time::UNIX_EPOCH);
    let began = began.map_or(0, |since| since.as_secs());
    let mut side = Side::new(options.command.clone(), options.patience);
    let names: Vec<String> = if options.machines.is_empty() {
        KINDS.iter().map(|kind| kind.name.to_owned()).collect()
    } else {
        options.machines.clone()
    };
    let mut machines: Vec<Machine> = Vec::new();
    for (number, name) in names.iter().enumerate() {
        // What the machines before did not need, the ones after have.
        let spent: Duration = machines.iter().map(|machine| machine.took).sum();
        let left = options.time.saturating_sub(spent).max(options.time / 50);
        let share = left / u32::try_from(names.len() - number).unwrap_or(1);
        let machine = one(name, &options, share, &mut side);
        progress(&machine);
        let lost = matches!(&machine.verdict, Verdict::Differs(trace, _)
            if matches!(trace.found.finding, Finding::Broken(Broken::NotStarted(_))));
        machines.push(machine);
        if lost {
            // It will not start for the others either.
            let why = "the other side does not start".to_owned();
            machines.extend(names[number + 1..].iter().map(|name| not_compared(name, why.clone())));
            break;
        }
    }
    side.end();
    Run { options, machines, said: side.said(), began }
}

fn not_compared(name: &str, why: String) -> Machine {
    let (cases, steps) = (0, 0);
    let verdict = Verdict::NotCompared(why);
    let took = Duration::ZERO;
    Machine { name: name.to_owned(), verdict, cases, steps, took, known: BTreeSet::new(), reached: None }
}

/// The cases that the running process has played, for a difference that needs them; the newest last.
const REMEMBERED: usize = 12;

/// After so many cases the process is started anew, so that what went before a difference stays short.
const RENEWED: u64 = 400;

/// A machine whose first starts are all rejected is taken for one that is not built.
const REFUSALS: u32 = 3;

fn one(name: &str, options: &Options, share: Duration, side: &mut Side) -> Machine {
    if let Some(reason) = options.profile.skips(name) {
        return not_compared(name, format!("the profile leaves it out: {reason}"));
    }
    let since = Instant::now();
    let judge = Judge { level: options.level, profile: &options.profile };
    let mut before: Vec<Case> = Vec::new();
    let (mut cases, mut steps, mut known) = (0_u64, 0_u64, BTreeSet::new());
    let (mut rejected, mut refusals, mut taken) = (None, 0_u32, false);
    let mut first: Option<(Case, Found)> = None;
    let done = |verdict, cases, steps, known: BTreeSet<usize>| Machine {
        name: name.to_owned(),
        verdict,
        cases,
        steps,
        took: since.elapsed(),
        known,
        reached: None,
    };
    let mut asking = Asking::new(options.config.is_some(), options.cases.is_some(), options.level);
    side.end();
    let mut number = 0;
    loop {
        let (most, over) = match options.cases {
            Some(most) => (number >= most, false),
            None => (false, since.elapsed() >= share),
        };
        let all = !options.vectors.is_empty();
        let Some(expected) = (if all { vector(options, name, number) } else { walked(options, name, number) }) else {
            break;
        };
        if most || over && !all && number > 0 {
            break;
        }
        number += 1;
        if number % RENEWED == 0 {
            side.end();
        }
        if !side.is_running() {
            before.clear();
        }
        match play(&expected, side, judge) {
            Ok(agreed) => {
                known.extend(agreed.known);
                taken |= !expected.is_rejected();
            }
            Err(found) => {
                let refused = found.at == At::Start && !expected.is_rejected() && starts_rejected(&found);
                // Whoever rejects every start of a machine has not built it; the first of them is kept.
                if refused && !taken && options.machines.is_empty() {
                    rejected.get_or_insert((expected.case, *found));
                    refusals += 1;
                    if refusals >= REFUSALS {
                        break;
                    }
                    continue;
                }
                first = Some((expected.case, *found));
                break;
            }
        }
        asking.play(&expected, since.elapsed());
        cases += 1;
        steps += expected.case.steps.len() as u64;
        if before.len() == REMEMBERED {
            before.remove(0);
        }
        before.push(expected.case);
    }
    if let (None, Some(refused)) = (&first, rejected) {
        if !taken {
            let why = "the other side rejects every start of it".to_owned();
            return done(Verdict::NotCompared(why), 0, 0, known);
        }
        first = Some(refused);
    }
    if let Some((case, found)) = first {
        let trace = shortest(&before, case, found, options, side, judge, name);
        return match trace {
            Some(trace) => {
                let last = trace.cases.last();
                let guesses = last.map(|last| alike(last, &trace.found.replies, options.level)).unwrap_or_default();
                done(Verdict::Differs(Box::new(trace), guesses), cases, steps, known)
            }
            None => done(Verdict::NotCompared("the case cannot be played again".to_owned()), cases, steps, known),
        };
    }
    if steps == 0 {
        let why = if number == 0 {
            "there is no walk and no example for it"
        } else {
            "time was up before a step was compared"
        };
        return done(Verdict::NotCompared(why.to_owned()), cases, 0, known);
    }
    let gone = |(place, entry): (usize, &super::profile::Known)| {
        (entry.machine == name && !known.contains(&place)).then_some(place)
    };
    let gone: Vec<_> = options.profile.known.iter().enumerate().filter_map(gone).collect();
    let verdict = if gone.is_empty() { Verdict::Agrees } else { Verdict::Gone(gone) };
    Machine { reached: asking.reached, ..done(verdict, cases, steps, known) }
}

fn starts_rejected(found: &Found) -> bool {
    matches!(&found.finding, Finding::Differs(differences)
        if differences.iter().any(|difference| difference.field == "start"))
}

fn walked(options: &Options, name: &str, number: u64) -> Option<Expected> {
    walk::case(name, options.seed, number, Sizes::Mixed, options.config.as_ref())
}

fn vector(options: &Options, name: &str, number: u64) -> Option<Expected> {
    let mut of_machine = options.vectors.iter().filter(|vector| vector.machine == name);
    of_machine.nth(usize::try_from(number).ok()?).map(Vector::expected)
}

/// A trace that is this short needs no other attempt.
const SHORT: usize = 8;

/// A case that is this long, or longer, is left for a walk on a small configuration that shows the same difference, if there is one.
const LONG: usize = 100;

/// How many other walks are shrunk in search of a shorter trace.
const ATTEMPTS: usize = 3;

/// How many other walks are played in search of the same difference.
const SEARCHED: u64 = 400;

/// Shrinks the trace. Where it is or stays long, looks for the same difference in walks on small configurations, and takes the shortest.
fn shortest(
    before: &[Case],
    case: Case,
    found: Found,
    options: &Options,
    side: &mut Side,
    judge: Judge<'_>,
    name: &str,
) -> Option<Trace> {
    let since = Instant::now();
    let kind = found.kind();
    let slow = matches!(found.finding, Finding::Broken(Broken::Hung(_)));
    let searching = options.config.is_none() && !slow && options.vectors.is_empty();
    let left = || options.shrink.saturating_sub(since.elapsed());
    let mut places = (0..SEARCHED).map(|number| number + (1 << 40));
    let mut other = |side: &mut Side, until: Duration| -> Option<(Case, Found)> {
        places.by_ref().take_while(|_| since.elapsed() < until).find_map(|place| {
            let expected = walk::case(name, options.seed, place, Sizes::Small, None)?;
            let found = play(&expected, side, judge).err().filter(|found| found.kind() == kind)?;
            Some((expected.case, *found))
        })
    };
    if searching
        && found.replies.len() >= LONG
        && let Some((case, found)) = other(side, options.shrink / 3)
        && let Some(trace) = shrink(&[], case, found, side, judge, left())
        && trace.again
    {
        return Some(trace);
    }
    let mut best = shrink(before, case, found, side, judge, left())?;
    let mut attempts = 0;
    while searching && best.again && best.steps() > SHORT && attempts < ATTEMPTS {
        let Some((case, found)) = other(side, options.shrink) else { break };
        attempts += 1;
        if let Some(trace) = shrink(&[], case, found, side, judge, left())
            && trace.again
            && trace.steps() < best.steps()
        {
            best = trace;
        }
    }
    Some(best)
}
