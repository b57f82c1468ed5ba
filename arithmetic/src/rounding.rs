//! Division that says which way it rounds.

#[cfg(creusot)]
use creusot_std::prelude::{View, ensures, requires};

/// `dividend / divisor`, rounded up. The divisor is 1 or more.
#[cfg_attr(kani, kani::requires(divisor > 0))]
#[cfg_attr(kani, kani::ensures(|q| u64::from(*q) * u64::from(divisor) >= u64::from(dividend)))]
#[cfg_attr(kani, kani::ensures(|q| *q == 0 || (u64::from(*q) - 1) * u64::from(divisor) < u64::from(dividend)))]
#[cfg_attr(creusot, requires(divisor@ > 0))]
#[cfg_attr(creusot, ensures(result@ * divisor@ >= dividend@))]
#[cfg_attr(creusot, ensures((result@ - 1) * divisor@ < dividend@))]
#[inline]
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
#[inline]
pub const fn divide_down(dividend: u32, divisor: u32) -> u32 {
    dividend / divisor
}
