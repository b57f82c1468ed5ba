//! When the position is unknown (T-POS-4), and what the constructors accept (T-POS-5).

use super::{any_curves, signed, straight, table};
use crate::any_u32;
use atc_kernel::Machine;
use atc_kernel::distance::Millimetres;
use atc_kernel::position::{
    Correction, Interval, KNOTS, Measured, Millibels, Moved, Position, SPANS, Spacing, Table, TableError, step,
};

harness! {
    /// No spans are told, and so the position is unknown, if the difference can be beyond the far end of the table, if it is below
    /// all of it, and if a curve does not rise in a span in which the train can be. (Levels that are missing or weak:
    /// `t_pos_1_levels`.)
    t_pos_4(e)
    theorem "T-POS-4";
    requirements ["POS-6", "POS-7"];
    assumptions ["printed-sizes"];
    bound "differences in the table of 0 to 0.31 dB";
    cases SPANS;
    unwind 35 = 1 + 2 * crate::position::KNOTS;
    claims {
        Beyond: "a difference that the lowest curve does not exceed at the far end: unknown",
        Below: "a difference under the highest curve at every knot: unknown",
        Falling: "a span in which a curve does not rise, and in which a difference between the curves is possible: unknown",
    }
    covers {
        End: "the difference is beyond the far end",
        Doubt: "a possible span does not rise",
        Known: "spans are told",
    }
    {
        let span = e.choose("span looked at", SPANS);
        let curves = any_curves(e, 0x1F);
        let Some(table) = Spacing::new(4).and_then(|spacing| table(e, curves, spacing)) else { return };
        let [least, most] = ["least difference (mB)", "greatest difference (mB)"].map(|what| i32::from(signed(e.word(what, 0..=170))));
        let told = table.spans(least, most);
        let beyond = i32::from(curves.lowest[SPANS]) <= most;
        e.claim(Claim::Beyond as u32, !beyond || told.is_none());
        let mut below = true;
        for highest in curves.highest {
            below &= i32::from(highest) < least;
        }
        e.claim(Claim::Below as u32, !below || told.is_none());
        let [low, low_end, high, high_end] =
            [curves.lowest[span], curves.lowest[span + 1], curves.highest[span], curves.highest[span + 1]].map(i32::from);
        // Somewhere in the span the highest curve reaches the least, and the lowest one is not above the most.
        let possible = (high >= least || high_end >= least) && (low <= most || low_end <= most);
        let rises = low < low_end && high < high_end;
        e.claim(Claim::Falling as u32, !possible || rises || told.is_none());
        e.cover(Cover::End as u32, beyond);
        e.cover(Cover::Doubt as u32, !beyond && possible && !rises);
        e.cover(Cover::Known as u32, told.is_some());
    }
}

harness! {
    /// As a machine the device starts with no position, its safe output is no position, a step answers what it remembers, and
    /// both are the step.
    pos_machine(e)
    theorem "T-POS-4";
    requirements ["POS-2"];
    assumptions [];
    bound "one table";
    cases 1;
    unwind 35 = 1 + 2 * crate::position::KNOTS;
    claims {
        Initial: "the initial state and the safe output are no position",
        Step: "the machine's step is the step, and it remembers what it answers",
    }
    covers {
        Known: "an interval is found",
        Unknown: "none is found",
    }
    {
        let Some(position) = straight(e) else { return };
        let before = Interval::new(Millimetres(any_u32(e, "nearest before (mm)", 0..=900)), Millimetres(any_u32(e, "farthest before (mm)", 900..=9000)));
        let moved = Moved::new(signed(e.word("least movement (mm)", 0..=100)), signed(e.word("most movement (mm)", 100..=200)));
        let Some(moved) = moved else { return e.assume(false) };
        let first = Some(Millibels(signed(e.word("first level (mB)", 0..=200))));
        let measured = Measured { first, second: Some(Millibels(0)), moved };
        let answer = step(&position, before, measured);
        e.claim(Claim::Initial as u32, position.initial().is_none() && Position::SAFE.is_none());
        e.claim(Claim::Step as u32, Machine::step(&position, before, measured) == (answer, answer));
        e.cover(Cover::Known as u32, answer.is_some());
        e.cover(Cover::Unknown as u32, answer.is_none());
    }
}

harness! {
    /// The constructors accept exactly what POS-5 allows and keep it; a table's error names the rule, and the first knot at which
    /// it is broken.
    t_pos_5(e)
    theorem "T-POS-5";
    requirements ["POS-5"];
    assumptions [];
    bound "";
    cases 1;
    unwind 35 = 1 + 2 * crate::position::KNOTS;
    claims {
        Table: "a table is accepted if and only if no lowest difference is above the highest and both curves rise in some span; the error names the rule and the first knot",
        Kept: "the table is kept as given",
        Spacing: "a spacing is accepted if and only if it is 2^4 to 2^11 decimetres",
        Ordered: "a movement, a correction and an interval are accepted if and only if their ends are in order, and kept",
        Tolerance: "a device is accepted if and only if its tolerance is not negative, and kept",
    }
    covers {
        Accepted: "a table is accepted",
        Crossed: "a table with crossed curves is refused",
        Flat: "a table that nowhere rises is refused",
    }
    {
        let exponent = e.word("spacing (as a power of two, dm)", 3..=12).to_le_bytes()[0];
        let spacing = Spacing::new(exponent);
        e.claim(Claim::Spacing as u32, spacing.is_some() == (4..=11).contains(&exponent)
            && spacing.is_none_or(|spacing| spacing.exponent() == exponent && spacing.decimetres() == 1 << (exponent & 15)));
        let [one, other] = ["least, and tolerance", "most, and floor"].map(|what| signed(e.word(what, 0..=100)));
        let (near, far) = (Millimetres(any_u32(e, "nearest (mm)", 0..=100)), Millimetres(any_u32(e, "farthest (mm)", 0..=100)));
        let (moved, correction, interval) =
            (Moved::new(one, other), Correction::new(Millibels(one), Millibels(other)), Interval::new(near, far));
        let in_order = one <= other;
        e.claim(Claim::Ordered as u32, moved.is_some() == in_order && correction.is_some() == in_order
            && interval.is_some() == (near.0 <= far.0)
            && moved.is_none_or(|moved| moved.least() == one && moved.most() == other)
            && correction.is_none_or(|given| given.least().0 == one && given.most().0 == other)
            && interval.is_none_or(|given| given.nearest() == near && given.farthest() == far)
            && Moved::new(0, 0) == Some(Moved::STANDING) && Correction::new(Millibels(0), Millibels(0)) == Some(Correction::NONE));
        // A third of the tables that testers draw is flat.
        let flat = e.word("every knot like the first (1 mod 4: yes)", 0..=3) & 3 == 1;
        let mut curves = any_curves(e, 0xFFFF);
        for knot in 1..KNOTS {
            curves.lowest[knot] = if flat { curves.lowest[0] } else { curves.lowest[knot] };
            curves.highest[knot] = if flat { curves.highest[0] } else { curves.highest[knot] };
        }
        let Some(spacing) = Spacing::new((exponent & 7) + 4) else { return e.assume(false) };
        let made = Table::new(spacing, curves.lowest.map(Millibels), curves.highest.map(Millibels));
        let (mut crossed, mut rises) = (KNOTS, false);
        for knot in (0..KNOTS).rev() {
            crossed = if curves.lowest[knot] > curves.highest[knot] { knot } else { crossed };
        }
        for knot in 1..KNOTS {
            rises |= curves.lowest[knot - 1] < curves.lowest[knot] && curves.highest[knot - 1] < curves.highest[knot];
        }
        let right = match made {
            Ok(_) => crossed == KNOTS && rises,
            Err(TableError::Crossed(knot)) => crossed < KNOTS && knot == crossed,
            Err(TableError::NowhereRising) => crossed == KNOTS && !rises,
        };
        e.claim(Claim::Table as u32, right);
        let kept = made.is_err() || made.is_ok_and(|table| {
            let mut same = table.spacing() == spacing;
            for knot in 0..KNOTS {
                same &= table.lowest()[knot].0 == curves.lowest[knot] && table.highest()[knot].0 == curves.highest[knot];
            }
            same
        });
        e.claim(Claim::Kept as u32, kept);
        let device = made.ok().and_then(|table| Position::new(table, Millibels(one), Millibels(other), Correction::NONE));
        e.claim(Claim::Tolerance as u32, device.is_some() == (made.is_ok() && one >= 0)
            && device.is_none_or(|device| device.tolerance().0 == one && device.floor().0 == other));
        e.cover(Cover::Accepted as u32, made.is_ok());
        e.cover(Cover::Crossed as u32, crossed < KNOTS);
        e.cover(Cover::Flat as u32, crossed == KNOTS && !rises);
    }
}
