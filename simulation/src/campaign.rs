//! A fault campaign: one fault in each run, at a random time; and whether anything unsafe came of it.

use std::collections::BTreeMap;

use rand::SeedableRng;
use rand_pcg::Pcg64Mcg;
use serde::Serialize;

use crate::driver::Drivers;
use crate::event::Event;
use crate::fault::{Extent, Fault, Kind};
use crate::line::Line;
use crate::onboard::{Operate, Signal};
use crate::world::{Setting, World};

/// What a campaign is made of.
#[derive(Clone, Debug)]
pub struct Campaign {
    /// How many runs.
    pub runs: u64,
    /// The kinds of faults; each run has one of them, in turn.
    pub kinds: Vec<Kind>,
    /// Whether the faults are such as the line must stand.
    pub extent: Extent,
    /// How many faults of its kind a run has.
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

/// What became of the runs with one kind of fault.
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
pub type Outcomes = BTreeMap<Kind, Outcome>;

/// The faults of one run of a campaign.
pub fn faults(line: &Line, campaign: &Campaign, run: u64) -> (Kind, Vec<Fault>) {
    let kinds = u64::try_from(campaign.kinds.len()).unwrap_or(1).max(1);
    let kind = campaign.kinds[usize::try_from(run % kinds).unwrap_or(0)];
    let mut random = Pcg64Mcg::seed_from_u64(campaign.seed + run);
    // Nothing moves for about a minute after the start.
    let window = (60_000.0, f64::from(campaign.seconds) * 1000.0 - 1.0);
    let draw = |_| Fault::draw(kind, campaign.extent, line, window, &mut random);
    (kind, (0..campaign.faults).map(draw).collect())
}

/// Runs a campaign, on both cores; `watch` hears of each run that is over.
///
/// # Errors
/// What is wrong with the campaign: no kinds, or more trains than there is room for.
pub fn run(line: &Line, campaign: &Campaign, watch: &(dyn Fn(u64) + Sync)) -> Result<Outcomes, String> {
    if campaign.kinds.is_empty() || campaign.seconds <= 60 {
        return Err("a campaign needs a kind of fault, and more than 60 s".to_owned());
    }
    let one = |run: u64| -> Result<(Kind, u64, Vec<Event>), String> {
        let (kind, faults) = faults(line, campaign, run);
        let seed = campaign.seed + run;
        let setting = Setting {
            operate: Operate::Shortened,
            trains: campaign.trains,
            seed,
            faults,
            compared: false,
            signal: campaign.signal,
            drivers: campaign.drivers,
        };
        let mut world = World::new(line, setting)?;
        world.run(u64::from(campaign.seconds) * 1000);
        watch(run);
        Ok((kind, seed, world.events))
    };
    let workers = 2;
    let halves: Vec<Result<Vec<_>, String>> = std::thread::scope(|scope| {
        let started: Vec<_> = (0..workers)
            .map(|worker| scope.spawn(move || (worker..campaign.runs).step_by(2).map(one).collect()))
            .collect();
        started.into_iter().map(|half| half.join().unwrap_or_else(|_| Err("a run broke off".to_owned()))).collect()
    });
    let mut ended = Vec::new();
    for half in halves {
        ended.extend(half?);
    }
    ended.sort_by_key(|(_, seed, _)| *seed);
    let mut outcomes = Outcomes::new();
    for (kind, seed, events) in ended {
        let outcome = outcomes.entry(kind).or_default();
        outcome.runs += 1;
        let arrived = |event: &&Event| matches!(event.what, crate::event::What::Arrived { .. });
        outcome.arrivals += events.iter().filter(arrived).count() as u64;
        if let Some(event) = events.iter().find(|event| event.what.is_unsafe()) {
            outcome.unsafe_runs += 1;
            outcome.first = outcome.first.take().or_else(|| Some((seed, event.clone())));
        }
    }
    Ok(outcomes)
}
