//! Time, counted in logic cycles.
//!
//! The kernel has no clock. A [`Cycle`] turns the milliseconds of a configuration into [`Ticks`], and there is no
//! conversion that rounds to nearest: the caller says which direction is the safe one.

use atc_arithmetic::{divide_down, divide_up};

/// The longest time that any parameter may have: 60 000 logic cycles (ten minutes at 10 ms).
pub const MAX_TICKS: u16 = 60_000;

/// A duration in milliseconds, as a configuration gives it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Millis(pub u32);

/// A duration in logic cycles, 0 to [`MAX_TICKS`] wherever it is a parameter.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Ticks(pub u16);

/// The length of one logic cycle: 1 ms or more.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Cycle(u32);

impl Cycle {
    /// A cycle of `length`; `None` for a cycle of no length.
    pub const fn new(length: Millis) -> Option<Self> {
        if length.0 == 0 { None } else { Some(Self(length.0)) }
    }

    /// The cycle's length.
    pub const fn length(self) -> Millis {
        Millis(self.0)
    }

    /// The fewest whole cycles that last at least `time`: for a time whose lapse *permits* something.
    /// `None` beyond [`MAX_TICKS`].
    pub fn at_least(self, time: Millis) -> Option<Ticks> {
        //= spec/aspect.md#time-1-rounding
        //# A time whose lapse permits something (T1, T5) MUST be rounded up to whole logic cycles, and a time during which a permission persists (T2, T3, T4) MUST be rounded down.
        narrow(divide_up(time.0, self.0))
    }

    /// The most whole cycles that last at most `time`: for a time during which a permission persists, and for a
    /// time-out that restricts. `None` beyond [`MAX_TICKS`].
    pub fn at_most(self, time: Millis) -> Option<Ticks> {
        narrow(divide_down(time.0, self.0))
    }
}

#[cfg_attr(kani, kani::ensures(|t| t.is_some() == (ticks <= 60_000)))]
fn narrow(ticks: u32) -> Option<Ticks> {
    match u16::try_from(ticks) {
        Ok(ticks) if ticks <= MAX_TICKS => Some(Ticks(ticks)),
        _ => None,
    }
}
