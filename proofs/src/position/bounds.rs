//! The division of a span, alone: the rounding of T-POS-1.

use crate::any_u32;
use atc_arithmetic::{Quotient, part};

harness! {
    /// The part of a span that belongs to a part of its rise is rounded down, and by less than a decimetre. It is found in twelve
    /// rounds, one for each binary digit, each worth half of what the one before is worth. Before the first one the quotient and
    /// the product are 0; a round adds to both or to neither, the digit's worth and the digit's worth times the rise, and it
    /// halves what the product can be below the dividend. So after the last one the product is the quotient times the rise, not
    /// above the dividend, and below it by less than the rise.
    pos_part(e)
    theorem "T-POS-1";
    requirements ["POS-3"];
    assumptions [];
    bound "";
    cases 12;
    unwind 35 = 1 + 2 * crate::position::KNOTS;
    claims {
        Together: "a round adds the digit's worth to the quotient and that times the rise to the product, or nothing to either",
        Down: "the product is not above the dividend",
        Next: "with the digit's worth times the rise added it is above the dividend, if before the round it was so with twice that",
        First: "before the first round 4096 times the rise is above the dividend, for every whole of a span",
    }
    covers {
        Exact: "the product is the dividend",
        Taken: "the digit is 1",
        Left: "the digit is 0",
    }
    {
        let digit = e.choose("digit (as a power of two)", 12) & 15;
        let half = 1_u32 << digit;
        let rise = any_u32(e, "rise (mB)", 1..=20);
        e.assume((1..1 << 17).contains(&rise));
        let rise = rise & 0x1_FFFF;
        let (quotient, product) = (any_u32(e, "quotient", 0..=4), any_u32(e, "product", 0..=40));
        let dividend = any_u32(e, "dividend", 0..=90);
        let worth = rise << digit;
        // What is still open before the round is under twice the digit's worth. No quotient is above 4096, no product above 4096 · 2¹⁷.
        let open = quotient <= 4096 && dividend <= 1 << 28 && product <= dividend && dividend - product < worth + worth;
        e.assume(open);
        // An engine that goes on after a broken assumption must not overflow.
        if !open {
            return;
        }
        let found = Quotient { quotient, product }.digit(half, rise, dividend);
        let taken = found.quotient == quotient + half && found.product == product + worth;
        e.claim(Claim::Together as u32, taken || found == Quotient { quotient, product });
        e.claim(Claim::Down as u32, found.product <= dividend);
        e.claim(Claim::Next as u32, dividend < found.product + worth);
        let over = any_u32(e, "part of the rise (mB)", 0..=20);
        e.assume(over <= rise);
        let over = over & 0x1_FFFF;
        e.claim(Claim::First as u32, over << digit < rise << 12);
        e.cover(Cover::Exact as u32, found.product == dividend);
        e.cover(Cover::Taken as u32, taken);
        e.cover(Cover::Left as u32, !taken);
    }
}

harness! {
    /// The part of a span that belongs to a part of its rise is the quotient after the twelve rounds.
    pos_part_rounds(e)
    theorem "T-POS-1";
    requirements ["POS-3"];
    assumptions ["printed-sizes"];
    bound "wholes of 1 to 64 decimetres";
    cases 7;
    unwind 35 = 1 + 2 * crate::position::KNOTS;
    apart [0 1 2 3 4 5 6];
    claims {
        Rounds: "the part is the quotient after twelve rounds",
    }
    covers {
        Rounded: "the part is not the whole",
        Whole: "the part is the whole",
    }
    {
        let exponent = e.choose("whole (as a power of two)", 7) & 15;
        let (rise, over) = (any_u32(e, "rise (mB)", 1..=20), any_u32(e, "part of the rise (mB)", 0..=20));
        let sized = over <= rise && (1..1 << 17).contains(&rise);
        e.assume(sized);
        if !sized {
            return;
        }
        let found = part(over, rise, 1 << exponent);
        let mut rounds = Quotient { quotient: 0, product: 0 };
        for place in (0..12).rev() {
            rounds = rounds.digit(1 << place, rise, over << exponent);
        }
        e.claim(Claim::Rounds as u32, found == rounds.quotient);
        e.cover(Cover::Rounded as u32, found < 1 << exponent);
        e.cover(Cover::Whole as u32, found == 1 << exponent);
    }
}
