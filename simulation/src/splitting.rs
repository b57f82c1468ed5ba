//! Importance splitting: how likely something rare is, from runs that are each begun where an earlier one came near it.
//!
//! A run climbs levels. Of so many runs some reach the first level before they end; as many new ones begin where those
//! stood, and so on. The product of the shares estimates the probability without bias, whatever the levels are; they
//! only decide how much it scatters. (Fixed effort; Garvels 2000, Villén-Altamirano 1991.)

use rand::{Rng, SeedableRng};
use rand_pcg::Pcg64Mcg;
use serde::Serialize;

/// A run that can be copied and gone on with under other chance.
pub trait Process: Clone {
    /// One step; `false` at the end of the run.
    fn step(&mut self) -> bool;
    /// How near it has come: it is at a level that is no higher than this, and at the rare event from 1 on.
    fn level(&self) -> f64;
    /// From now on chance is that of this seed.
    fn reseed(&mut self, seed: u64);
}

/// How often one level was reached.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Stage {
    /// The level.
    pub level: f64,
    /// The runs that began below it.
    pub runs: u32,
    /// Those that came to it.
    pub reached: u32,
}

/// What one splitting found.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Found {
    /// Level by level, up to the first that no run came to.
    pub stages: Vec<Stage>,
    /// The estimate.
    pub probability: f64,
}

/// An estimate with its scatter, of several splittings.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Estimate {
    /// The splittings.
    pub found: Vec<Found>,
    /// The mean.
    pub probability: f64,
    /// The standard error of the mean.
    pub error: f64,
}

/// One splitting: `effort` runs for each of the `levels`, which rise up to 1.
pub fn split<P: Process>(start: &P, levels: &[f64], effort: u32, seed: u64) -> Found {
    let mut random = Pcg64Mcg::seed_from_u64(seed);
    let mut found = Found { stages: Vec::new(), probability: 1.0 };
    let mut entrances: Vec<P> = vec![start.clone()];
    for level in levels {
        let mut next = Vec::new();
        for _ in 0..effort {
            let mut run = entrances[random.random_range(0..entrances.len())].clone();
            run.reseed(random.random());
            while run.level() < *level && run.step() {}
            if run.level() >= *level {
                next.push(run);
            }
        }
        let reached = u32::try_from(next.len()).unwrap_or(u32::MAX);
        found.stages.push(Stage { level: *level, runs: effort, reached });
        found.probability *= f64::from(reached) / f64::from(effort);
        if next.is_empty() {
            break;
        }
        entrances = next;
    }
    found
}

/// The mean of `times` splittings, on both cores.
pub fn estimate<P: Process + Sync>(start: &P, levels: &[f64], (effort, times): (u32, u32), seed: u64) -> Estimate {
    let one = |number: u32| split(start, levels, effort, seed + u64::from(number));
    let found: Vec<Found> = std::thread::scope(|scope| {
        let half = |from: u32| (from..times).step_by(2).map(one).collect::<Vec<_>>();
        let other = scope.spawn(move || half(1));
        let mut all = half(0);
        all.extend(other.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic)));
        all
    });
    let count = f64::from(u32::try_from(found.len()).unwrap_or(1).max(1));
    let probability = found.iter().map(|one| one.probability).sum::<f64>() / count;
    let scatter = found.iter().map(|one| (one.probability - probability).powi(2)).sum::<f64>() / (count - 1.0).max(1.0);
    Estimate { found, probability, error: (scatter / count).sqrt() }
}
