//! Faults that come by chance, each on its own, at a mean rate: how likely they join to harm in a run, by [`crate::splitting`].

use rand::{Rng, SeedableRng};
use rand_pcg::Pcg64Mcg;

use crate::fault::{Extent, Fault, Kind};
use crate::line::Line;
use crate::splitting::Process;
use crate::world::{Setting, World};

/// What comes by chance.
#[derive(Clone, Debug, PartialEq)]
pub struct Chance {
    /// The kinds of faults, each of them so often.
    pub kinds: Vec<Kind>,
    /// How many of each kind there are in an hour of the line, on the average.
    pub per_hour: f64,
    /// From when on, in ms: nothing moves for about a minute after the start.
    pub from_ms: u64,
    /// The end of a run, in ms.
    pub end_ms: u64,
}

/// The levels of a run: a train that is not reported for half of the time after which its circuit counts as clear, for a tenth
/// more each, and for all of it; another train that is told to go where it is; the accident.
pub const LEVELS: [f64; 8] = [0.3, 0.36, 0.42, 0.48, 0.54, 0.6, 0.8, 1.0];

/// A line at work under such chance.
#[derive(Clone)]
pub struct Run<'a> {
    /// The line.
    pub world: World<'a>,
    chance: &'a Chance,
    random: Pcg64Mcg,
    /// When the next fault begins.
    next_ms: f64,
}

impl<'a> Run<'a> {
    /// The line up to the time from which there is chance.
    ///
    /// # Errors
    /// As [`World::new`].
    pub fn new(line: &'a Line, setting: Setting, chance: &'a Chance) -> Result<Self, String> {
        let random = Pcg64Mcg::seed_from_u64(setting.seed);
        let mut world = World::new(line, setting)?;
        world.run(chance.from_ms);
        let now_ms = world.now();
        let mut run = Self { world, chance, random, next_ms: 0.0 };
        run.draw(now_ms);
        Ok(run)
    }

    /// When the next one comes after `now_ms`: no fault remembers the one before.
    fn draw(&mut self, now_ms: f64) {
        let kinds = f64::from(u32::try_from(self.chance.kinds.len()).unwrap_or(u32::MAX));
        let mean_ms = 3_600_000.0 / (self.chance.per_hour * kinds);
        let share: f64 = self.random.random();
        self.next_ms = now_ms - mean_ms * (1.0 - share).ln();
    }
}

impl Process for Run<'_> {
    fn step(&mut self) -> bool {
        let end = self.world.now() + f64::from(self.world.line.train_cycle_ms);
        while self.next_ms < end {
            let (from_ms, line) = (self.next_ms, self.world.line);
            let kind = self.chance.kinds[self.random.random_range(0..self.chance.kinds.len())];
            let fault = Fault::draw(kind, Extent::Tolerated, line, (from_ms, end), &mut self.random);
            self.world.fail(fault);
            self.draw(from_ms);
        }
        self.world.tick();
        self.world.now_ms < self.chance.end_ms && !self.world.is_unsafe
    }

    fn level(&self) -> f64 {
        self.world.nearness()
    }

    fn reseed(&mut self, seed: u64) {
        self.random = Pcg64Mcg::seed_from_u64(seed);
        self.draw(self.world.now());
    }
}
