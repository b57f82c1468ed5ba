//! Division digit by digit: a part of a whole, rounded down.

#[cfg(creusot)]
use creusot_std::prelude::{View, ensures, invariant, requires};

/// `over / rise` of `whole`, rounded down: the greatest p with p · `rise` ≤ `over` · `whole`.
///
/// `over` ≤ `rise`, 1 ≤ `rise` < 2¹⁷ and `whole` ≤ 2048.
#[cfg_attr(creusot, requires(over@ <= rise@ && 1 <= rise@ && rise@ < 131_072 && whole@ <= 2048))]
#[cfg_attr(creusot, ensures(result@ * rise@ <= over@ * whole@))]
#[cfg_attr(creusot, ensures(over@ * whole@ < (result@ + 1) * rise@))]
pub const fn part(over: u32, rise: u32, whole: u32) -> u32 {
    let dividend = over * whole;
    let mut found = Quotient { quotient: 0, product: 0 };
    // The quotient is in quotient .. quotient + width. The width halves twelve times.
    let mut width = 4096_u32;
    #[cfg_attr(creusot, invariant(width@ >= 1 && found.quotient@ + width@ <= 4096))]
    #[cfg_attr(creusot, invariant(found.product@ == found.quotient@ * rise@ && found.product@ <= dividend@))]
    #[cfg_attr(creusot, invariant(dividend@ < (found.quotient@ + width@) * rise@))]
    while width > 1 {
        let half = width / 2;
        found = found.digit(half, rise, dividend);
        width -= half;
    }
    found.quotient
}

/// What a division has found so far.
// A derived PartialEq needs a model, which Creusot does not have of it.
#[cfg_attr(not(creusot), derive(Clone, Copy, Debug, PartialEq, Eq))]
pub struct Quotient {
    /// The quotient, rounded down to the digits that are found.
    pub quotient: u32,
    /// The quotient times the divisor.
    pub product: u32,
}

impl Quotient {
    /// Finds one binary digit, worth `half`, of `dividend / rise`. The product with `half` added to the quotient fits 32 bits.
    #[cfg_attr(creusot, requires(self.quotient@ + half@ <= 4096 && half@ <= 2048 && rise@ < 131_072))]
    #[cfg_attr(creusot, requires(self.product@ == self.quotient@ * rise@))]
    #[cfg_attr(creusot, ensures(if self.product@ + half@ * rise@ <= dividend@ {
        result.quotient@ == self.quotient@ + half@ && result.product@ == self.product@ + half@ * rise@
    } else {
        result == self
    }))]
    #[must_use]
    pub const fn digit(self, half: u32, rise: u32, dividend: u32) -> Self {
        let product = self.product + half * rise;
        if product <= dividend { Self { quotient: self.quotient + half, product } } else { self }
    }
}
