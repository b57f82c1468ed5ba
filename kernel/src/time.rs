//! Time, counted in logic cycles.
//!
//! The kernel has no clock. A [`Cycle`] turns the milliseconds of a configuration into [`Ticks`], and there is no
//! conversion that rounds to nearest: the caller says which direction is the safe one.

#[cfg(creusot)]
use creusot_std::prelude::{View, ensures, requires};

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

/// `dividend / divisor`, rounded up. The divisor is 1 or more.
#[cfg_attr(kani, kani::requires(divisor > 0))]
#[cfg_attr(kani, kani::ensures(|q| u64::from(*q) * u64::from(divisor) >= u64::from(dividend)))]
#[cfg_attr(kani, kani::ensures(|q| *q == 0 || (u64::from(*q) - 1) * u64::from(divisor) < u64::from(dividend)))]
#[cfg_attr(creusot, requires(divisor@ > 0))]
#[cfg_attr(creusot, ensures(result@ * divisor@ >= dividend@))]
#[cfg_attr(creusot, ensures((result@ - 1) * divisor@ < dividend@))]
pub const fn divide_up(dividend: u32, divisor: u32) -> u32 {
    let whole = dividend / divisor;
    if dividend % divisor == 0 { whole } else { whole + 1 }
}

/// `dividend / divisor`, rounded down. The divisor is 1 or more.
#[cfg_attr(kani, kani::requires(divisor > 0))]
#[cfg_attr(kani, kani::ensures(|q| u64::from(*q) * u64::from(divisor) <= u64::from(dividend)))]
#[cfg_attr(kani, kani::ensures(|q| (u64::from(*q) + 1) * u64::from(divisor) > u64::from(dividend)))]
#[cfg_attr(creusot, requires(divisor@ > 0))]
#[cfg_attr(creusot, ensures(result@ * divisor@ <= dividend@))]
#[cfg_attr(creusot, ensures((result@ + 1) * divisor@ > dividend@))]
pub const fn divide_down(dividend: u32, divisor: u32) -> u32 {
    dividend / divisor
}

#[cfg_attr(kani, kani::ensures(|t| t.is_some() == (ticks <= 60_000)))]
fn narrow(ticks: u32) -> Option<Ticks> {
    match u16::try_from(ticks) {
        Ok(ticks) if ticks <= MAX_TICKS => Some(Ticks(ticks)),
        _ => None,
    }
}
