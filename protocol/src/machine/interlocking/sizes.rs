//! The machine on a layout of either size: a station that is too large for the one is opened as the other.

use atc_kernel::interlocking::Large;

use super::{Config, Interlocked, Output, Step};
use crate::machine::contract::Machine;

/// The stack on which a large station is opened: its layout has half a megabyte, and is moved some times.
const STACK: usize = 64 << 20;

/// The interlocking of a station of either size.
#[derive(Clone, Debug)]
pub enum Sizes {
    /// Up to 64 circuits, 64 routes of up to 16 circuits, 32 points and 8 segments.
    Small(Box<Interlocked>),
    /// Up to 256 circuits, 256 routes of up to 32 circuits, 128 points and 32 segments.
    Large(Box<Interlocked<256, 32, 128, 32, Large>>),
}

impl Machine for Sizes {
    const NAME: &'static str = <Interlocked>::NAME;
    const STEP: &'static str = <Interlocked>::STEP;
    const CONFIG: &'static str = <Interlocked>::CONFIG;

    type Config = Config;
    type Step = Step;
    type Output = Output;

    fn open(config: &Config) -> Result<Self, String> {
        if !config.is_large() {
            return Interlocked::open(config).map(|machine| Self::Small(Box::new(machine)));
        }
        std::thread::scope(|scope| {
            let opens = || Interlocked::open(config).map(|machine| Self::Large(Box::new(machine)));
            let thread = std::thread::Builder::new().stack_size(STACK).spawn_scoped(scope, opens);
            let thread = thread.map_err(|error| format!("a large station needs a thread of its own: {error}"))?;
            thread.join().unwrap_or_else(|_| Err("a large station cannot be opened here".to_owned()))
        })
    }

    fn step(&mut self, step: &Step) -> Result<Output, String> {
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
