//! The odometer: T-POS-3.

use super::{signed, straight};
use crate::any_u32;
use atc_kernel::distance::Millimetres;
use atc_kernel::position::{Interval, Measured, Millibels, Moved, step};

harness! {
    /// A train that was in the last interval, has moved by what the odometer says, and is where the levels say, is in the
    /// interval after; also if it has passed the transmitter, and is now anywhere before the next one.
    t_pos_3(e)
    theorem "T-POS-3";
    requirements ["POS-4"];
    assumptions ["printed-sizes", "odometer-bound", "levels-of-one-section", "levels-within-tolerance", "calibration-covers-the-weather"];
    bound "one table, distances up to 2 147 km";
    cases 1;
    unwind 35 = 1 + 2 * crate::position::KNOTS;
    claims {
        Inside: "the interval after contains the train",
        Within: "the interval after is not wider than what the levels alone say",
        Odometer: "where the train cannot have reached the transmitter it is not wider than the last interval with the movement",
        Alone: "without an interval before, and where the train can have reached the transmitter, the levels alone count",
    }
    covers {
        Narrowed: "the odometer narrows the interval",
        Passed: "the train has passed the transmitter",
        Contradicted: "the levels and the odometer have nothing in common",
    }
    {
        let Some(position) = straight(e) else { return };
        let level = Some(Millibels(signed(e.word("first level (mB)", 0..=255))));
        let heard = |moved| Measured { first: level, second: Some(Millibels(0)), moved };
        let near = any_u32(e, "nearest before (mm)", 0..=9000) & 0x7FFF_FFFF;
        let wide = any_u32(e, "width before (mm)", 0..=9000) & 0x7FFF_FFFF;
        let far = near + wide;
        let [least, most] = ["least movement (mm)", "most movement (mm)"].map(|what| signed(e.word(what, 0..=9000)));
        let (Some(before), Some(moved)) = (Interval::new(Millimetres(near), Millimetres(far)), Moved::new(least, most)) else {
            return e.assume(false);
        };
        let alone = step(&position, None, heard(moved));
        let found = step(&position, Some(before), heard(moved));
        // The truth: before, the movement, and after. Past the transmitter the distance is that to the next one.
        let was = near + (any_u32(e, "train before, beyond the nearest (mm)", 0..=9000) & 0x7FFF_FFFF);
        let by = signed(e.word("true movement (mm)", 0..=9000));
        e.assume(was <= far);
        e.suppose("odometer-bound", least <= by && by <= most);
        let ahead = i64::from(was) - i64::from(by);
        let next = any_u32(e, "distance to the next transmitter (mm)", 0..=20_000);
        let now = if ahead > 0 { ahead } else { i64::from(next) };
        let inside = |interval: Option<Interval>| {
            interval.is_none_or(|found| i64::from(found.nearest().0) <= now && now <= i64::from(found.farthest().0))
        };
        let sound = inside(alone);
        e.cover(Cover::Contradicted as u32, alone.is_some() && found.is_none());
        e.claim(Claim::Within as u32, found.is_none_or(|found| {
            alone.is_some_and(|alone| alone.nearest() <= found.nearest() && found.farthest() <= alone.farthest())
        }));
        let reached = i64::from(near) <= i64::from(most);
        e.claim(Claim::Odometer as u32, reached || found.is_none_or(|found| {
            i64::from(found.nearest().0) >= i64::from(near) - i64::from(most) && i64::from(found.farthest().0) <= i64::from(far) - i64::from(least)
        }));
        e.claim(Claim::Alone as u32, !reached || found == alone);
        // What T-POS-1 makes of levels, before the transmitter and behind it.
        e.suppose("levels-of-one-section", sound);
        e.suppose("levels-within-tolerance", sound);
        e.suppose("calibration-covers-the-weather", sound);
        e.claim(Claim::Inside as u32, inside(found));
        e.cover(Cover::Narrowed as u32, found.is_some() && found != alone);
        e.cover(Cover::Passed as u32, ahead <= 0 && found.is_some());
    }
}
