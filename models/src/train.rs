//! The train: the device under test, the conventional one and the machine as claimed, on the same detections.

use crate::claimed::{self, Claimed};
use atc_kernel::Machine;
use atc_kernel::aspect::{Acceptance, AspectSet, Display, State, Times};
use std::fmt::Debug;
use std::hash::Hash;

/// A machine that may stand in the place of the kernel's. What it tells beyond its display is for cover points only;
/// no safety property looks into a device.
pub trait Device:
    Machine<Input = AspectSet, Output = Display, State: Debug + Hash + Send + Sync> + Clone + Debug + Send + Sync + 'static
{
    /// The device with these times.
    fn with(times: Times) -> Self;
    /// The times.
    fn times(&self) -> Times;
    /// Whether the state keeps the machine's invariant.
    fn is_valid(&self, state: &Self::State) -> bool;
    /// The aspects that are satisfied.
    fn satisfied(&self, state: &Self::State) -> AspectSet;
    /// The aspects that lost their mask.
    fn dropped(&self, state: &Self::State) -> AspectSet;
    /// The aspects that are gone and keep a credit.
    fn credited(&self, state: &Self::State) -> AspectSet;
}

impl<const N: usize> Device for Acceptance<N> {
    fn with(times: Times) -> Self {
        Self { times }
    }
    fn times(&self) -> Times {
        self.times
    }
    fn is_valid(&self, state: &State<N>) -> bool {
        state.is_valid(self.times)
    }
    fn satisfied(&self, state: &State<N>) -> AspectSet {
        state.satisfied()
    }
    fn dropped(&self, state: &State<N>) -> AspectSet {
        AspectSet::from_bits(state.parts().dropped)
    }
    fn credited(&self, state: &State<N>) -> AspectSet {
        AspectSet::from_bits(state.parts().credited)
    }
}

impl<const N: usize> Device for Claimed<N> {
    fn with(times: Times) -> Self {
        Self { times }
    }
    fn times(&self) -> Times {
        self.times
    }
    fn is_valid(&self, _: &claimed::State<N>) -> bool {
        true
    }
    fn satisfied(&self, state: &claimed::State<N>) -> AspectSet {
        state.satisfied()
    }
    fn dropped(&self, state: &claimed::State<N>) -> AspectSet {
        state.dropped()
    }
    fn credited(&self, state: &claimed::State<N>) -> AspectSet {
        state.credited()
    }
}

/// One display for each device.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Displays {
    /// The device under test: the kernel's, but for tests of the models.
    pub normative: Display,
    /// The same times without the shortened operate time.
    pub conventional: Display,
    /// The machine as claimed.
    pub as_claimed: Display,
}

impl Displays {
    /// Whether the device shows nothing higher than the conventional one, where that shows something.
    pub fn not_above_conventional(&self) -> bool {
        self.conventional == Display::NOTHING || self.normative <= self.conventional
    }

    /// Whether the device shows nothing higher than the machine as claimed, where that shows something.
    pub fn not_above_as_claimed(&self) -> bool {
        self.as_claimed == Display::NOTHING || self.normative <= self.as_claimed
    }
}

/// The three devices and what they show. `S` is the state of the one under test.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Train<S, const N: usize> {
    /// The device under test.
    pub normative: S,
    /// The conventional device.
    pub conventional: State<N>,
    /// The machine as claimed.
    pub as_claimed: claimed::State<N>,
    /// What they show now.
    pub shown: Displays,
    /// What each showed last before this cycle, if it ever did: a ghost.
    pub before: Displays,
}

impl<S: Copy + Eq, const N: usize> Train<S, N> {
    /// Three devices in their initial states.
    pub fn initial<D: Device<State = S>>(device: &D) -> Self {
        Self {
            normative: device.initial(),
            conventional: State::INITIAL,
            as_claimed: claimed::State::INITIAL,
            shown: Displays::default(),
            before: Displays::default(),
        }
    }

    /// One cycle of all three.
    #[must_use]
    pub fn step<D: Device<State = S>>(self, device: &D, detected: AspectSet) -> Self {
        let times = device.times();
        let (normative, shown) = device.step(self.normative, detected);
        let (conventional, by_conventional) =
            atc_kernel::aspect::step(times.conventional(), self.conventional, detected);
        let (as_claimed, by_claimed) = claimed::step(times, self.as_claimed, detected);
        let keep = |shown: Display, before: Display| if shown == Display::NOTHING { before } else { shown };
        Self {
            normative,
            conventional,
            as_claimed,
            shown: Displays { normative: shown, conventional: by_conventional, as_claimed: by_claimed },
            before: Displays {
                normative: keep(self.shown.normative, self.before.normative),
                conventional: keep(self.shown.conventional, self.before.conventional),
                as_claimed: keep(self.shown.as_claimed, self.before.as_claimed),
            },
        }
    }
}

/// Consecutive cycles heard up to now, by rank, at most T1: a ghost of its own, not the device's.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Runs<const N: usize>([u16; N]);

impl<const N: usize> Runs<N> {
    /// Nothing heard.
    pub const NONE: Self = Self([0; N]);

    /// The runs one cycle later.
    #[must_use]
    pub fn step(mut self, times: Times, detected: AspectSet) -> Self {
        for (rank, run) in self.0.iter_mut().enumerate() {
            *run = if detected.bits() >> rank & 1 == 1 { (*run + 1).min(times.operate().0) } else { 0 };
        }
        self
    }

    /// The run of rank `rank`; 0 beyond `N`.
    pub fn of(&self, rank: usize) -> u16 {
        self.0.get(rank).copied().unwrap_or(0)
    }

    /// The run of the aspect that `display` shows; 0 for none.
    pub fn of_display(&self, display: Display) -> u16 {
        display.aspect().map_or(0, |aspect| self.of(usize::from(aspect.rank())))
    }

    /// The longest run of an aspect at or above `display`.
    pub fn at_or_above(&self, display: Display) -> u16 {
        self.0
            .iter()
            .enumerate()
            .filter(|(rank, _)| 1 << rank >= display.bits())
            .map(|(_, run)| *run)
            .max()
            .unwrap_or(0)
    }

    /// Whether nothing at all is heard.
    pub fn silence(&self) -> bool {
        self.0.iter().all(|run| *run == 0)
    }
}
