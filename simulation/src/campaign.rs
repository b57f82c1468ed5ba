//! A fault campaign: what is wrong in each run, at a random time; and whether anything unsafe came of it.

use std::collections::BTreeMap;
use std::fmt;
use std::num::NonZero;

use rand::{Rng, SeedableRng};
use rand_pcg::Pcg64Mcg;
use serde::{Serialize, Serializer};

use crate::defect::Defect;
use crate::driver::Drivers;
use crate::event::Event;
use crate::fault::{Extent, Fault, Kind};
use crate::line::Line;
use crate::onboard::Signal;
use crate::world::{Setting, World};

/// What is wrong in a run: parts that are, all the time, and faults of the line, at about the same time.
#[derive(Clone, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub struct Cause {
    /// The parts.
    pub defects: Vec<Defect>,
    /// The kinds of faults.
    pub kinds: Vec<Kind>,
}

impl Cause {
    /// Every pair of faults that a line can have, two of one kind among them; every defect alone, with each fault, and with each other.
    pub fn pairs(line: &Line) -> Vec<Self> {
        let kinds = Kind::of(line);
        let mut causes = Vec::new();
        for (number, one) in kinds.iter().copied().enumerate() {
            causes.extend(kinds[number..].iter().map(|other| Self { kinds: vec![one, *other], ..Self::default() }));
        }
        for (number, one) in Defect::ALL.into_iter().enumerate() {
            let alone = Self { defects: vec![one], ..Self::default() };
            causes.extend(kinds.iter().map(|kind| Self { kinds: vec![*kind], ..alone.clone() }));
            causes.extend(
                Defect::ALL[number + 1..].iter().map(|other| Self { defects: vec![one, *other], ..Self::default() }),
            );
            causes.push(alone);
        }
        causes
    }
}

impl From<Kind> for Cause {
    fn from(kind: Kind) -> Self {
        Self { kinds: vec![kind], ..Self::default() }
    }
}

impl fmt::Display for Cause {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        let names = self.defects.iter().map(|defect| defect.name()).chain(self.kinds.iter().map(|kind| kind.name()));
        out.write_str(&names.collect::<Vec<_>>().join(" + "))
    }
}

impl Serialize for Cause {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}

/// What a campaign is made of.
#[derive(Clone, Debug)]
pub struct Campaign {
    /// How many runs.
    pub runs: u64,
    /// What is wrong; each run has one of them, in turn.
    pub causes: Vec<Cause>,
    /// Whether the faults are such as the line must stand.
    pub extent: Extent,
    /// How many faults of its first kind a run has.
    pub faults: usize,
    /// How many trains there are.
    pub trains: usize,
    /// How long a run is, in s.
    pub seconds: u32,
    /// The seed of the first run; the next has the next.
    pub seed: u64,
    /// What trains run on.
    pub signal: Signal,
    /// What drivers do with the cab signal.
    pub drivers: Drivers,
}

/// What became of the runs in which one thing was wrong.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Outcome {
    /// How many there were.
    pub runs: u64,
    /// In how many of them something unsafe happened.
    pub unsafe_runs: u64,
    /// How often trains came to a station.
    pub arrivals: u64,
    /// The first unsafe run: its seed, and what happened.
    pub first: Option<(u64, Event)>,
}

/// What became of a campaign.
pub type Outcomes = BTreeMap<Cause, Outcome>;

/// The faults of one run of a campaign. Those of the second kind begin while one of the first is there, or little before or after.
pub fn faults<'a>(line: &Line, campaign: &'a Campaign, run: u64) -> (&'a Cause, Vec<Fault>) {
    const APART_MS: f64 = 3_000.0;
    let causes = u64::try_from(campaign.causes.len()).unwrap_or(1).max(1);
    let cause = &campaign.causes[usize::try_from(run % causes).unwrap_or(0)];
    let mut random = Pcg64Mcg::seed_from_u64(campaign.seed + run);
    // Nothing moves for about a minute after the start.
    let window = (60_000.0, f64::from(campaign.seconds) * 1000.0 - 1.0);
    let mut faults: Vec<Fault> = Vec::new();
    for kind in &cause.kinds {
        if faults.is_empty() {
            let draw = |_| Fault::draw(*kind, campaign.extent, line, window, &mut random);
            faults = (0..campaign.faults).map(draw).collect();
            continue;
        }
        for number in 0..campaign.faults {
            let first = faults[number];
            let near = (first.from_ms - APART_MS, first.from_ms + first.lasts_ms.min(60_000.0) + APART_MS);
            let fault = Fault::draw(*kind, campaign.extent, line, near, &mut random);
            // Mostly of the same train, or at the same place.
            let which = if random.random_range(0..4) > 0 { first.which } else { fault.which };
            faults.push(Fault { which, ..fault });
        }
    }
    (cause, faults)
}

/// What one run of a campaign is made of.
pub fn setting<'a>(line: &Line, campaign: &'a Campaign, run: u64) -> (&'a Cause, Setting) {
    let (cause, faults) = faults(line, campaign, run);
    let Campaign { trains, signal, drivers, .. } = *campaign;
    let (seed, defects) = (campaign.seed + run, cause.defects.clone());
    (cause, Setting { trains, seed, faults, signal, drivers, defects, ..Setting::default() })
}

/// What is kept of a run.
struct Run {
    cause: Cause,
    seed: u64,
    arrivals: u64,
    harm: Option<Event>,
}

/// Runs a campaign, on all cores; `watch` hears of each run that is over.
///
/// # Errors
/// What is wrong with the campaign: no causes, or more trains than there is room for.
pub fn run(line: &Line, campaign: &Campaign, watch: &(dyn Fn(u64) + Sync)) -> Result<Outcomes, String> {
    if campaign.causes.is_empty() || campaign.seconds <= 60 {
        return Err("a campaign needs something that is wrong, and more than 60 s".to_owned());
    }
    let one = |run: u64| -> Result<Run, String> {
        let (cause, setting) = setting(line, campaign, run);
        let seed = setting.seed;
        let mut world = World::new(line, setting)?;
        world.run(u64::from(campaign.seconds) * 1000);
        watch(run);
        let arrived = |event: &&Event| matches!(event.what, crate::event::What::Arrived { .. });
        let arrivals = world.events.iter().filter(arrived).count() as u64;
        let harm = world.events.into_iter().find(|event| event.what.is_unsafe());
        Ok(Run { cause: cause.clone(), seed, arrivals, harm })
    };
    let workers = std::thread::available_parallelism().map_or(1, NonZero::get);
    let parts: Vec<Result<Vec<_>, String>> = std::thread::scope(|scope| {
        let runs = |first: usize| (0..campaign.runs).skip(first).step_by(workers);
        let started: Vec<_> = (0..workers).map(|worker| scope.spawn(move || runs(worker).map(one).collect())).collect();
        started.into_iter().map(|part| part.join().unwrap_or_else(|_| Err("a run broke off".to_owned()))).collect()
    });
    let mut ended = Vec::new();
    for part in parts {
        ended.extend(part?);
    }
    ended.sort_by_key(|run| run.seed);
    let mut outcomes = Outcomes::new();
    for Run { cause, seed, arrivals, harm } in ended {
        let outcome = outcomes.entry(cause).or_default();
        outcome.runs += 1;
        outcome.arrivals += arrivals;
        if let Some(event) = harm {
            outcome.unsafe_runs += 1;
            outcome.first = outcome.first.take().or(Some((seed, event)));
        }
    }
    Ok(outcomes)
}
