//! Distances, their end and their section: T-TRN-6.

use super::{STEADY, any_received, any_steady_cycle, any_steady_state};
use crate::any_u32;
use crate::permitted::any_line;
use crate::position::straight_within;
use atc_kernel::distance::Millimetres;
use atc_kernel::position::{Interval, Measured, Millibels, step};
use atc_kernel::train::Received;

/// Of the levels in these harnesses: what they say of a place is T-POS-1's, here it is handed on.
const TOLERANCE: Millibels = Millibels(4);

/// The same with levels that are at most 127 mB apart: any interval of whole decimetres in 12.7 m.
fn near(received: Received) -> Received {
    let first = received.measured.first.map(|level| Millibels(level.0 & 127));
    let second = received.measured.second.map(|_| Millibels(0));
    Received { measured: Measured { first, second, ..received.measured }, ..received }
}

harness! {
    /// The distance to the exit is the nearest end of this cycle's interval, and of no other one; the interval of the cycle before plays a part
    /// only while the main telegrams are of one section.
    t_trn_6(e)
    theorem "T-TRN-6";
    requirements ["TRN-4", "TRN-5"];
    assumptions ["four-speeds", "printed-sizes"];
    bound "tables of 4 speeds, one accepted aspect or none, one table, levels up to 127 mB apart";
    cases 2;
    unwind 35 = 1 + 2 * atc_kernel::position::KNOTS;
    solver kissat;
    apart [0 1];
    claims {
        Nearest: "a fix of this cycle is the nearest end of the interval, and there is none without an interval",
        Forgotten: "with a main telegram of another section than the last one, or with no last one, the interval is what the levels alone say",
        Carried: "otherwise it is what the position machine makes of the one before",
        Kept: "the interval that is shown is what is remembered",
    }
    covers {
        New: "a fix of this cycle, before the far end of the interval, or a border",
        Border: "an interval is forgotten at a border, and the levels say another one, or there is no border",
        Narrowed: "there is an interval after one of before, or a border",
    }
    {
        let at_border = e.choose("main telegram (0: of another section than the last one, 1: of its section, or none)", 2) == 0;
        let Some(line) = any_line(e) else { return };
        let Some(position) = straight_within(TOLERANCE) else { return };
        let Some((device, before, detected)) = any_steady_state(e, line, Some(position)) else { return };
        let Some(received) = any_received(e) else { return };
        let received = Received { detected, ..near(received) };
        let last = before.permitted.main_stream.last;
        let border = received.main.is_some_and(|main| last.is_none_or(|last| last.section != main.section));
        e.assume(border == at_border);
        let (after, cab) = device.train.act(before, received);
        let fresh = before.permitted.fix.is_none() && received.main.is_none();
        let nearest = cab.position.map(Interval::nearest);
        e.claim(Claim::Nearest as u32, !fresh || after.permitted.fix == nearest);
        let expected = step(&position, if at_border { None } else { before.position }, received.measured);
        e.claim(Claim::Forgotten as u32, !border || cab.position == expected);
        e.claim(Claim::Carried as u32, border || cab.position == expected);
        e.claim(Claim::Kept as u32, after.position == cab.position);
        let wide = cab.position.is_some_and(|interval| interval.nearest() < interval.farthest());
        e.cover(Cover::New as u32, at_border || fresh && wide && after.permitted.fix.is_some());
        let both = before.position.is_some() && cab.position.is_some();
        e.cover(Cover::Border as u32, !at_border || both && cab.position != before.position);
        e.cover(Cover::Narrowed as u32, at_border || both);
    }
}

harness! {
    /// A ghost train is where the levels say (T-POS-1), was in the interval before, and moved by what the odometer says. Then it is in the interval after the
    /// cycle, also if it passed the transmitter or heard a telegram of another section, and the fix is no longer than its true distance to the exit of the section
    /// in which the fix was measured: what T-PER-4 and T-TRN-1 take a fix for.
    t_trn_6_inside(e)
    theorem "T-TRN-6";
    requirements ["TRN-4", "TRN-5"];
    assumptions [
        "four-speeds", "printed-sizes", "odometer-bound", "levels-of-one-section", "levels-within-tolerance",
        "calibration-covers-the-weather", "transmitter-at-exit",
    ];
    built_in &[("transmitter-at-exit", "the distance to the transmitter is the one to the exit")];
    bound "tables of 4 speeds, one accepted aspect or none, one table, levels up to 127 mB apart, distances up to 2 147 km";
    cases 1;
    unwind 35 = 1 + 2 * atc_kernel::position::KNOTS;
    solver kissat;
    claims {
        Inside: "the train is in the interval after the cycle",
        Fix: "the fix is not longer than the true distance to the exit of its section, or 0",
    }
    covers {
        New: "a new fix, above 0",
        Older: "a fix of before, above 0",
        Passed: "the train passed the transmitter, and there is an interval",
    }
    {
        let Some(line) = any_line(e) else { return };
        let Some(position) = straight_within(TOLERANCE) else { return };
        let Some((device, before, detected)) = any_steady_state(e, line, Some(position)) else { return };
        let Some(received) = any_received(e) else { return };
        let received = Received { detected, ..near(received) };
        // The truth: before, the movement, and after. Past the transmitter the distance is that to the next one.
        let near = before.position.map_or(0, |interval| i64::from(interval.nearest().0));
        let was = near + i64::from(any_u32(e, "train before, beyond the nearest (mm)", 0..=9000));
        let moved = received.measured.moved;
        let by = i64::from(crate::position::signed(e.word("true movement (mm)", 300..=300)));
        e.assume(before.position.is_none_or(|interval| was <= i64::from(interval.farthest().0)));
        e.suppose("odometer-bound", i64::from(moved.least()) <= by && by <= i64::from(moved.most()));
        let ahead = was - by;
        let now = if ahead > 0 { ahead } else { i64::from(any_u32(e, "distance to the next transmitter (mm)", 0..=20_000)) };
        let inside = |interval: Option<Interval>| {
            interval.is_none_or(|found| i64::from(found.nearest().0) <= now && now <= i64::from(found.farthest().0))
        };
        // What T-POS-1 makes of levels, before the transmitter and behind it.
        let sound = inside(step(&position, None, received.measured));
        e.suppose("levels-of-one-section", sound);
        e.suppose("levels-within-tolerance", sound);
        e.suppose("calibration-covers-the-weather", sound);
        // The exit of the section in which the fix of before was measured; behind the train if negative.
        let sound = |fix: Millimetres, truth: i64| fix.0 == 0 || i64::from(fix.0) <= truth;
        let exit = before.permitted.fix.map_or(0, |fix| i64::from(fix.0)) + i64::from(any_u32(e, "exit of the fix, beyond it (mm)", 0..=5000));

        let (after, cab) = device.train.act(before, received);
        e.claim(Claim::Inside as u32, inside(cab.position));
        let truth = if before.permitted.fix.is_some() { exit - by } else { now };
        // A fix of 0 says nothing, so the exit may also be behind the train.
        let older = before.permitted.fix.is_some_and(|fix| fix.0 > 0);
        e.claim(Claim::Fix as u32, after.permitted.fix.is_none_or(|fix| sound(fix, truth)));
        let some = after.permitted.fix.is_some_and(|fix| fix.0 > 0);
        e.cover(Cover::New as u32, before.permitted.fix.is_none() && some);
        e.cover(Cover::Older as u32, older && some);
        e.cover(Cover::Passed as u32, ahead <= 0 && cab.position.is_some());
    }
}

harness! {
    /// What is taken off every distance in a cycle is the most that the odometer allows, 0 if that is backwards: a target that stays is nearer by exactly that,
    /// and a fix that stays, too. So it is never a negative number taken for a positive one.
    t_trn_6_moved(e)
    theorem "T-TRN-6";
    requirements ["TRN-9"];
    assumptions ["four-speeds", "printed-sizes"];
    bound STEADY;
    cases 1;
    unwind 33 = 1 + crate::aspect::LONGEST;
    solver kissat;
    claims {
        Target: "a target without a new telegram is nearer by the movement, or at 0",
        Fix: "so is a fix",
        Bound: "a target is never farther than it was, without a telegram that is used",
    }
    covers {
        Forward: "the train moves forward",
        Backward: "the train can only have moved backward",
    }
    {
        let Some(line) = any_line(e) else { return };
        let Some(cycle) = any_steady_cycle(e, line, None) else { return };
        let (before, after) = (cycle.before.permitted, cycle.after.permitted);
        let most = i64::from(cycle.received.measured.moved.most());
        let forward = if most > 0 { most } else { 0 };
        let nearer = |known: Millimetres| {
            let left = i64::from(known.0) - forward;
            if left > 0 { left } else { 0 }
        };
        let target = match (before.target, after.target) {
            (Some(before), Some(after)) if cycle.used_main.is_none() => i64::from(after.to_stop.0) == nearer(before.to_stop),
            _ => true,
        };
        e.claim(Claim::Target as u32, target);
        let fix = match (before.fix, after.fix) {
            (Some(before), Some(after)) => i64::from(after.0) == nearer(before),
            _ => true,
        };
        e.claim(Claim::Fix as u32, fix);
        let farther = match (before.target, after.target) {
            (Some(before), Some(after)) => before.to_stop < after.to_stop,
            (None, Some(_)) => true,
            _ => false,
        };
        e.claim(Claim::Bound as u32, cycle.used_main.is_some() || !farther);
        let kept = after.target.is_some() && cycle.used_main.is_none();
        e.cover(Cover::Forward as u32, kept && forward > 0);
        e.cover(Cover::Backward as u32, kept && most < 0);
    }
}
