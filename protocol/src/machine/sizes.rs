//! A machine on a layout of either size: a station that is too large for the one is opened as the other.

use super::contract::Machine;
pub use atc_layout::with_room;

/// The routes of a large station.
pub const ROUTES: usize = 256;
/// The places of a path in a large station.
pub const PLACES: usize = 32;
/// The points of a large station.
pub const POINTS: usize = 128;
/// The segments of a large station.
pub const SEGMENTS: usize = 32;

/// A configuration with a layout.
pub trait Stationed {
    /// Whether a small station has no room for it.
    fn is_large(&self) -> bool;
}

/// A machine of a station of either size.
#[derive(Clone, Debug)]
pub enum Sizes<A, B> {
    /// Up to 64 circuits, 64 routes of up to 16 circuits, 32 points and 8 segments.
    Small(Box<A>),
    /// Up to 256 circuits, 256 routes of up to 32 circuits, 128 points and 32 segments.
    Large(Box<B>),
}

impl<A, B> Machine for Sizes<A, B>
where
    A: Machine<Config: Stationed + Sync>,
    B: Machine<Config = A::Config, Step = A::Step, Output = A::Output> + Send,
{
    const NAME: &'static str = A::NAME;
    const STEP: &'static str = A::STEP;
    const CONFIG: &'static str = A::CONFIG;

    type Config = A::Config;
    type Step = A::Step;
    type Output = A::Output;

    fn open(config: &Self::Config) -> Result<Self, String> {
        if !config.is_large() {
            return A::open(config).map(|machine| Self::Small(Box::new(machine)));
        }
        with_room(|| B::open(config).map(|machine| Self::Large(Box::new(machine))))?
    }

    fn step(&mut self, step: &Self::Step) -> Result<Self::Output, String> {
        match self {
            Self::Small(machine) => machine.step(step),
            Self::Large(machine) => machine.step(step),
        }
    }

    fn cycles(&self) -> Vec<(&'static str, u16)> {
        match self {
            Self::Small(machine) => machine.cycles(),
            Self::Large(machine) => machine.cycles(),
        }
    }
}
