//! The interval by the levels: T-POS-1.
//!
//! What is proven of it comes in four parts. The levels: `t_pos_1_levels`. The spans: `t_pos_1` and `t_pos_1_exact`. Where a straight
//! line reaches a level in its span: `t_pos_1_span`, by the division `part`. The division: `pos_part`, `pos_part_rounds`.

use super::{any_curves, signed, table};
use crate::{any_flag, any_u32};
use atc_arithmetic::part;
use atc_kernel::distance::Millimetres;
use atc_kernel::position::{
    Correction, Interval, Measured, Millibels, Moved, Position, SPANS, Spacing, Span, Spans, Table, step,
};

harness! {
    /// Wherever the train is, whatever the true difference between the lines there: if the spans for some differences with the true
    /// one among them are told, the train's span is one of those from the nearest to the farthest, and if it is one of these two,
    /// the line rises there and reaches the level that is looked for.
    t_pos_1(e)
    theorem "T-POS-1";
    requirements ["POS-1"];
    assumptions ["calibration-covers-the-weather", "levels-within-tolerance"];
    bound "";
    cases SPANS;
    unwind 35 = 1 + 2 * crate::position::KNOTS;
    claims {
        Inside: "the train's span is one of those from the nearest to the farthest",
        Nearest: "if the train is in the nearest span, that is the highest curve in its span; it rises, and reaches the least difference at its end at the latest",
        Farthest: "if the train is in the farthest span, that is the lowest curve in its span; it rises, and is not above the greatest difference at its start",
    }
    covers {
        Found: "the spans are told, and not the same",
        Same: "the spans are told, and the same",
    }
    {
        let span = e.choose("span of the train", SPANS);
        let curves = any_curves(e, 0xFFFF);
        let Some(table) = Spacing::new(4).and_then(|spacing| table(e, curves, spacing)) else { return };
        let low = [curves.lowest[span], curves.lowest[span + 1]].map(i32::from);
        let high = [curves.highest[span], curves.highest[span + 1]].map(i32::from);
        // Between straight lines the difference is above one of the lowest ends, or equal, and below one of the highest, or equal.
        let truly = i32::from(signed(e.word("true difference (mB)", 0..=160)));
        let between = (low[0] <= truly || low[1] <= truly) && (truly <= high[0] || truly <= high[1]);
        e.suppose("calibration-covers-the-weather", between);
        let [least, most] = ["least difference (mB)", "greatest difference (mB)"].map(|what| signed(e.word(what, 0..=170)).into());
        // What `t_pos_1_levels` makes of levels.
        e.suppose("levels-within-tolerance", least <= truly && truly <= most);
        let told = table.spans(least, most);
        e.claim(Claim::Inside as u32, told.is_none_or(|told| told.nearest.number <= span && span <= told.farthest.number));
        e.claim(Claim::Nearest as u32, told.is_none_or(|told| {
            told.nearest.number != span || told.nearest.ends == high && high[0] < high[1] && high[1] >= least
        }));
        e.claim(Claim::Farthest as u32, told.is_none_or(|told| {
            told.farthest.number != span || told.farthest.ends == low && low[0] < low[1] && low[0] <= most
        }));
        e.cover(Cover::Found as u32, told.is_some_and(|told| told.nearest.number < told.farthest.number));
        e.cover(Cover::Same as u32, told.is_some_and(|told| told.nearest.number == told.farthest.number));
    }
}

harness! {
    /// The bounds that are looked for are the measured difference, less and more by twice the tolerance, and by the correction's
    /// limits: so they contain the true difference, with each level off by at most the tolerance. Levels that are missing or weak
    /// say nothing.
    t_pos_1_levels(e)
    theorem "T-POS-1";
    requirements ["POS-1", "POS-2"];
    assumptions ["levels-within-tolerance", "calibration-covers-the-weather"];
    bound "";
    cases 1;
    unwind 35 = 1 + 2 * crate::position::KNOTS;
    claims {
        Least: "the least is the first level less the second, less twice the tolerance, and the least correction more",
        Most: "the greatest is the first level less the second, twice the tolerance and the greatest correction more",
        Nothing: "there are bounds if and only if both levels are there and neither is under the floor",
        Inside: "the true difference, corrected, is between them",
    }
    covers {
        Off: "there is a tolerance, and bounds on either side",
        Weak: "one level is under the floor",
    }
    {
        let table = Spacing::new(4).and_then(|spacing| {
            let rising = core::array::from_fn(|knot| Millibels(i16::from(knot.to_le_bytes()[0])));
            Table::new(spacing, rising, rising).ok()
        });
        let [tolerance, floor, least, most] = [0..=3, 0..=5, 0..=1, 1..=2].map(|likely| signed(e.word("tolerance, floor, correction (mB)", likely)));
        let position = table.zip(Correction::new(Millibels(least), Millibels(most)))
            .and_then(|(table, correction)| Position::new(table, Millibels(tolerance), Millibels(floor), correction));
        e.assume(position.is_some());
        let Some(position) = position else { return };
        let [first, second] = [4..=40, 4..=40].map(|likely| signed(e.word("measured level (mB)", likely)));
        let heard = [any_flag(e, "first heard (odd: yes)"), any_flag(e, "second heard (odd: yes)")];
        let bounds = position.differences(heard[0].then_some(Millibels(first)), heard[1].then_some(Millibels(second)));
        let strong = heard == [true, true] && first >= floor && second >= floor;
        e.claim(Claim::Nothing as u32, bounds.is_some() == strong);
        let difference = i32::from(first) - i32::from(second);
        let (from, to) = (i32::from(least) - 2 * i32::from(tolerance), 2 * i32::from(tolerance) + i32::from(most));
        e.claim(Claim::Least as u32, bounds.is_none_or(|(least, _)| least == difference + from));
        e.claim(Claim::Most as u32, bounds.is_none_or(|(_, most)| most == difference + to));
        // The truth: the two levels, and what the correction stands for.
        let mut off = |what| i32::from(signed(e.word(what, 0..=1)));
        let (first_off, second_off) = (off("first level measured too high by (mB)"), off("second level measured too high by (mB)"));
        let within = |off: i32| -i32::from(tolerance) <= off && off <= i32::from(tolerance);
        let correction = i32::from(signed(e.word("true correction (mB)", 1..=1)));
        e.suppose("levels-within-tolerance", within(first_off) && within(second_off));
        e.suppose("calibration-covers-the-weather", i32::from(least) <= correction && correction <= i32::from(most));
        let truly = difference - first_off + second_off + correction;
        e.claim(Claim::Inside as u32, bounds.is_none_or(|(least, most)| least <= truly && truly <= most));
        e.cover(Cover::Off as u32, bounds.is_some() && tolerance > 0 && from < 0 && to > 0);
        e.cover(Cover::Weak as u32, heard == [true, true] && first < floor && second >= floor);
    }
}

harness! {
    /// Where both curves rise everywhere, the nearest span is the first one at whose end the highest curve reaches the least
    /// difference, and the farthest is the last one at whose start the lowest curve is not above the greatest: no span more. The
    /// position is unknown only beyond the far end, and below all of the table.
    t_pos_1_exact(e)
    theorem "T-POS-1";
    requirements ["POS-1"];
    assumptions ["printed-sizes"];
    bound "differences in the table of 0 to 0.31 dB";
    cases SPANS;
    unwind 35 = 1 + 2 * crate::position::KNOTS;
    claims {
        Nearest: "a span is the nearest one if and only if it is the first of which the highest curve reaches the least difference",
        Farthest: "a span is the farthest one if and only if it is the last of which the lowest curve is not above the greatest difference",
        Known: "the spans are told if and only if the greatest difference is under the lowest curve's far end, and not under its beginning",
    }
    covers {
        First: "the span is the nearest one",
        Last: "the span is the farthest one",
        Unknown: "the spans are not told",
    }
    {
        let span = e.choose("span looked at", SPANS);
        let curves = any_curves(e, 0x1F);
        let Some(table) = Spacing::new(4).and_then(|spacing| table(e, curves, spacing)) else { return };
        let mut rises = true;
        for knot in 0..SPANS {
            rises &= curves.lowest[knot] < curves.lowest[knot + 1] && curves.highest[knot] < curves.highest[knot + 1];
        }
        let [least, most] = ["least difference (mB)", "greatest difference (mB)"].map(|what| i32::from(signed(e.word(what, 0..=170))));
        e.assume(rises && least <= most);
        let told = table.spans(least, most);
        let known = most < i32::from(curves.lowest[SPANS]) && most >= i32::from(curves.lowest[0]);
        let first = i32::from(curves.highest[span + 1]) >= least && (span == 0 || i32::from(curves.highest[span]) < least);
        let last = i32::from(curves.lowest[span]) <= most && i32::from(curves.lowest[span + 1]) > most;
        e.claim(Claim::Nearest as u32, told.is_none_or(|told| (told.nearest.number == span) == first));
        e.claim(Claim::Farthest as u32, told.is_none_or(|told| (told.farthest.number == span) == last));
        e.claim(Claim::Known as u32, told.is_some() == known);
        e.cover(Cover::First as u32, told.is_some() && first);
        e.cover(Cover::Last as u32, told.is_some() && last);
        e.cover(Cover::Unknown as u32, told.is_none());
    }
}

harness! {
    /// In the nearest span a line that rises from h reaches the level `least` from (`least` − h) / rise of the span on; in the
    /// farthest one a line that rises to l is not above `most` until (l − `most`) / rise before the end. The interval of the two
    /// spans ends there, rounded outwards: by `part` of the whole from the start, and by `part` of it back from the end.
    t_pos_1_span(e)
    theorem "T-POS-1";
    requirements ["POS-3"];
    assumptions ["printed-sizes"];
    bound "spacing 1.6 and 3.2 m, differences in a span of 0 to 0.63 dB";
    cases 2;
    unwind 35 = 1 + 2 * crate::position::KNOTS;
    claims {
        Nearest: "the nearest distance is that of the nearest span's start and the part; the start itself if the line is not below the level there",
        Farthest: "the farthest distance is that of the farthest span's end less the part; the end itself if the line is not above the level there",
        Order: "there is no interval only if the nearest distance is beyond the farthest",
    }
    covers {
        Within: "both ends are inside of their spans",
        Outer: "both ends are at knots",
        Backward: "the ends are the wrong way round",
    }
    {
        let exponent = e.choose("spacing (as a power of two, dm, 4 less)", 2) & 7;
        let Some(spacing) = Spacing::new(exponent.to_le_bytes()[0] + 4) else { return };
        let decimetres = 16_u32 << exponent;
        let mut span = |what| Span {
            number: usize::from(e.word(what, 0..=1) & 15),
            ends: [0..=8, 8..=24].map(|likely| i32::from(e.word("difference at its knots (mB)", likely) & 0x3F)),
        };
        let (nearest, farthest) = (span("number of the nearest span"), span("number of the farthest span"));
        // A difference of two words, two tolerances and a correction.
        let mut level = |what, likely| i32::from(signed(e.word(what, 0..=likely))) - i32::from(e.word("less", 0..=1)) + 2 * i32::from(signed(e.word("and", 0..=1)));
        let (least, most) = (level("least difference (mB)", 20), level("greatest difference (mB)", 20));
        let ([near, near_end], [far, far_end]) = (nearest.ends, farthest.ends);
        e.assume(near < near_end && near_end >= least && far < far_end && far <= most);
        // An engine that goes on after a broken assumption must not divide by nothing.
        if !(near < near_end && near_end >= least && far < far_end && far <= most) {
            return;
        }
        let from = if near < least { part(near.abs_diff(least), near.abs_diff(near_end), decimetres) } else { 0 };
        let back = if far_end > most { part(far_end.abs_diff(most), far.abs_diff(far_end), decimetres) } else { 0 };
        let knot = |span: Span| u32::try_from(span.number).unwrap_or(0) << (exponent + 4);
        let (from, to) = (100 * (knot(nearest) + from), 100 * (knot(farthest) + decimetres - back));
        let found = Spans { nearest, farthest }.interval(least, most, spacing);
        e.claim(Claim::Nearest as u32, found.is_none_or(|found| found.nearest() == Millimetres(from)));
        e.claim(Claim::Farthest as u32, found.is_none_or(|found| found.farthest() == Millimetres(to)));
        e.claim(Claim::Order as u32, found.is_some() == (from <= to));
        e.cover(Cover::Within as u32, found.is_some() && near < least && far_end > most);
        e.cover(Cover::Outer as u32, found.is_some() && near >= least && far_end <= most);
        e.cover(Cover::Backward as u32, found.is_none());
    }
}

harness! {
    /// The parts put together, for one table: from the levels to the interval of a step. The curves are straight, 1 mB for a decimetre,
    /// the highest 8 mB above the lowest, so a difference of n mB is that of distances from n − 8 to n decimetres.
    t_pos_1_step(e)
    theorem "T-POS-1";
    requirements ["POS-1", "POS-2", "POS-7"];
    assumptions ["printed-sizes"];
    bound "one table";
    cases 1;
    unwind 35 = 1 + 2 * crate::position::KNOTS;
    claims {
        Exact: "without an interval before, it is from where the highest curve reaches the least difference to where the lowest one leaves the greatest; unknown only if the greatest is beyond the far end, or below the near one",
        Nothing: "with a level missing or under the floor the position is unknown, whatever it was before",
    }
    covers {
        Within: "an interval whose ends are both inside of the table",
        Weak: "a level is under the floor, and there was an interval before",
    }
    {
        let (lowest, highest) = (
            core::array::from_fn(|knot| Millibels(i16::from(knot.to_le_bytes()[0]) * 32)),
            core::array::from_fn(|knot| Millibels(i16::from(knot.to_le_bytes()[0]) * 32 + 8)),
        );
        let table = Spacing::new(5).and_then(|spacing| Table::new(spacing, lowest, highest).ok());
        let [tolerance, floor, least, most] = [0..=3, 0..=5, 0..=1, 1..=2].map(|likely| signed(e.word("tolerance, floor, correction (mB)", likely)));
        let position = table.zip(Correction::new(Millibels(least), Millibels(most)))
            .and_then(|(table, correction)| Position::new(table, Millibels(tolerance), Millibels(floor), correction));
        e.assume(position.is_some());
        let Some(position) = position else { return };
        let [first, second] = [100..=400, 4..=40].map(|likely| signed(e.word("measured level (mB)", likely)));
        let heard = [any_flag(e, "first heard (odd: yes)"), any_flag(e, "second heard (odd: yes)")];
        let moved = Moved::new(signed(e.word("least movement (mm)", 0..=100)), signed(e.word("most movement (mm)", 100..=200)));
        e.assume(moved.is_some());
        let Some(moved) = moved else { return };
        let measured = Measured {
            first: heard[0].then_some(Millibels(first)),
            second: heard[1].then_some(Millibels(second)),
            moved,
        };
        let before = Interval::new(Millimetres(any_u32(e, "nearest before (mm)", 0..=900)), Millimetres(any_u32(e, "farthest before (mm)", 900..=9000)));
        let (alone, found) = (step(&position, None, measured), step(&position, before, measured));
        let strong = heard == [true, true] && first >= floor && second >= floor;
        e.claim(Claim::Nothing as u32, strong || alone.is_none() && found.is_none());
        let [tolerance, least, most] = [tolerance, least, most].map(i32::from);
        let difference = i32::from(first) - i32::from(second);
        let (from, to) = (difference - 2 * tolerance + least, difference + 2 * tolerance + most);
        let expected = if strong && (0..512).contains(&to) {
            let near = if from > 8 { from - 8 } else { 0 };
            Interval::new(Millimetres(100 * near.unsigned_abs()), Millimetres(100 * to.unsigned_abs()))
        } else {
            None
        };
        e.claim(Claim::Exact as u32, alone == expected);
        e.cover(Cover::Within as u32, alone.is_some_and(|alone| alone.nearest().0 > 0 && alone.farthest().0 < 51_100));
        e.cover(Cover::Weak as u32, heard == [true, true] && !strong && before.is_some());
    }
}
