//! How far the stopping point is: PER-4.

use super::{any_cycle, knows_main};
use crate::{Engine, any_flag, any_u32};
use atc_kernel::distance::{Metres, Millimetres};

/// An arbitrary true distance in millimetres, negative behind the train, of which `bound` is a sound bound; up to 2 147 km where that says nothing.
fn any_truth<E: Engine + ?Sized>(e: &mut E, what: &'static str, bound: Option<Millimetres>) -> i64 {
    let more = any_u32(e, what, 0..=5000);
    match bound {
        Some(Millimetres(bound)) if bound > 0 => i64::from(bound) + i64::from(more),
        _ => i64::from(i32::from_le_bytes(more.to_le_bytes())),
    }
}

/// Whether `bound` is no farther than what is `truth` away, or 0.
fn sound(bound: Millimetres, truth: i64) -> bool {
    bound.0 == 0 || i64::from(bound.0) <= truth
}

harness! {
    /// The stopping point is never nearer than the kernel thinks. Ghosts are the true distances: to the stopping point of the
    /// target, and to the exit of the section in which the fix was measured.
    t_per_4(e)
    theorem "T-PER-4";
    requirements ["PER-4", "PER-10"];
    assumptions [
        "four-speeds", "odometer-bound", "fix-sound", "one-section-at-a-time", "fix-of-the-section-heard", "margin-covers-the-crossing",
    ];
    bound "tables of 4 speeds";
    cases 1;
    unwind 33 = 1 + crate::aspect::LONGEST;
    solver kissat;
    claims {
        Stop: "the distance to the stopping point is at most the true one, or 0",
        Fix: "the fix is at most the true distance to the exit of its section, or 0",
        Kept: "a target without a new telegram is nearer by the movement, and to the same point",
    }
    covers {
        Measured: "a target whose distance comes from a fix",
        Longer: "a target that keeps the longer distance",
        Moved: "a target of another section",
    }
    {
        let Some(cycle) = any_cycle(e) else { return };
        let (before, after, heard) = (cycle.before, cycle.after, cycle.heard);
        // Before the cycle, in the truth: the target's point, and the exit of the section of the fix.
        let stop = any_truth(e, "true distance to the stop (mm more)", before.target.map(|target| target.to_stop));
        let exit = any_truth(e, "true distance to the exit of the fix (mm more)", before.fix);
        // In the cycle the train moves forward by no more than the odometer says, or back.
        let forward = i64::from(any_u32(e, "true movement (mm)", 0..=1000));
        let moved = forward - i64::from(any_u32(e, "true movement back (mm)", 0..=0));
        e.suppose("odometer-bound", moved <= i64::from(heard.moved.0));
        let (stop, exit) = (stop - moved, exit - moved);
        // After it: the exit of the section that is heard now, and of the section of the main telegram.
        let too_long = i64::from(any_u32(e, "measured too long by (mm)", 0..=0));
        let here = any_truth(e, "true distance to this exit (mm more)", heard.to_exit) - too_long;
        e.suppose("fix-sound", heard.to_exit.is_none_or(|measured| sound(measured, here)));
        let told = i64::from(any_u32(e, "true distance to the telegram's exit (mm more than before it)", 0..=5000)) - moved;
        let other = i64::from(any_u32(e, "it is another point's by (mm)", 0..=0));
        let ahead = any_flag(e, "the fix was to the exit of the section ahead (odd: yes)");
        let (mut now, mut again) = (stop, false);
        if let Some(main) = cycle.used_main {
            let beyond = main.route.beyond_exit();
            let further = i64::from(beyond.0) * 1000;
            // The same section and the same distance beyond its exit are the same point.
            again = before.target.is_some_and(|target| target.section == main.section && target.beyond == beyond);
            // Two telegrams of one section in a row: in between the train was in that section, and so was the fix measured.
            let between = before.main_stream.last.is_some_and(|last| last.section == main.section);
            let fixed = between && before.fix.is_some();
            // Likely, so that drawn values meet what is supposed.
            let told = match (again, fixed) {
                (true, _) => stop - further + other,
                (false, true) => exit + other,
                (false, false) => told,
            };
            e.suppose("one-section-at-a-time", !again || told + further == stop);
            e.suppose("fix-of-the-section-heard", !fixed || !ahead);
            e.suppose("one-section-at-a-time", !fixed || ahead || told == exit);
            // A telegram of a section is heard in it; since then the train moved for a part of this cycle.
            e.suppose("margin-covers-the-crossing", told >= 0 || told + moved >= 0);
            now = told + further;
        }
        e.claim(Claim::Stop as u32, after.target.is_none_or(|target| sound(target.to_stop, now)));
        let exit = if before.fix.is_some() { exit } else { here };
        e.claim(Claim::Fix as u32, after.fix.is_none_or(|fix| sound(fix, exit)));
        let kept = match (before.target, after.target, cycle.used_main) {
            (Some(before), Some(after), None) => {
                let same = after.section == before.section && after.beyond == before.beyond && after.limit == before.limit;
                same && after.to_stop.0 == before.to_stop.0.saturating_sub(heard.moved.0)
            }
            (None, Some(_), None) => false,
            _ => true,
        };
        e.claim(Claim::Kept as u32, kept);
        let used = cycle.used_main.is_some();
        e.cover(Cover::Measured as u32, used && before.fix.is_some_and(|fix| fix.0 > heard.moved.0));
        let longer = after.target.is_some_and(|target| target.to_stop.0 > u32::from(target.beyond.0) * 1000);
        e.cover(Cover::Longer as u32, again && before.fix.is_none() && longer);
        e.cover(Cover::Moved as u32, used && before.target.is_some() && !again);
    }
}

harness! {
    /// A fix is the first distance to the exit that was measured after a main telegram, less the movement since; every known
    /// main telegram, used or not, ends it. What a target's distance is made of, exactly.
    t_per_4_fix(e)
    theorem "T-PER-4";
    requirements ["PER-4", "PER-10"];
    assumptions ["four-speeds"];
    bound "tables of 4 speeds";
    cases 1;
    unwind 33 = 1 + crate::aspect::LONGEST;
    solver kissat;
    claims {
        Ended: "after a main telegram with known ranks there is no fix",
        First: "without one, a fix stays the same, less the movement; without a fix, the measured distance becomes it",
        Used: "a target's distance is at most the one of before, or the fix of before and the distance beyond the exit; never what was measured in its own cycle",
        Exact: "that distance is the fix of before, 0 if there is none, and the distance beyond the exit, 4294 km at most, less the movement; or the one of before to the same point, less the movement, if that is longer",
    }
    covers {
        Kept: "a fix is kept although another distance is measured",
        New: "a new fix",
        Ended: "a telegram that is not used ends a fix",
    }
    {
        let Some(cycle) = any_cycle(e) else { return };
        let (before, after, heard) = (cycle.before, cycle.after, cycle.heard);
        let known = heard.main.filter(|main| knows_main(*main));
        e.claim(Claim::Ended as u32, known.is_none() || after.fix.is_none());
        let older = before.fix.map(|fix| Millimetres(fix.0.saturating_sub(heard.moved.0)));
        let first = if older.is_some() { older } else { heard.to_exit };
        e.claim(Claim::First as u32, known.is_some() || after.fix == first);
        let used = match (after.target, cycle.used_main) {
            (Some(after), Some(_)) => {
                let older = i64::from(before.fix.map_or(0, |fix| fix.0)) + i64::from(after.beyond.0) * 1000;
                let kept = before.target.map_or(0, |target| i64::from(target.to_stop.0));
                i64::from(after.to_stop.0) <= if older > kept { older } else { kept }
            }
            _ => true,
        };
        e.claim(Claim::Used as u32, used);
        let exact = match (after.target, cycle.used_main) {
            (Some(after), Some(main)) => {
                let beyond = main.route.beyond_exit();
                let less = |length: i64| if length > i64::from(heard.moved.0) { length - i64::from(heard.moved.0) } else { 0 };
                let sum = i64::from(before.fix.map_or(0, |fix| fix.0)) + i64::from(beyond.0) * 1000;
                let measured = less(if sum < 1 << 32 { sum } else { i64::from(u32::MAX) });
                let again = before.target.filter(|target| {
                    let old = target.age.0 >= cycle.line.settings.life.0;
                    !old && target.section == main.section && target.beyond == beyond
                });
                let kept = less(again.map_or(0, |target| i64::from(target.to_stop.0)));
                i64::from(after.to_stop.0) == if measured > kept { measured } else { kept }
            }
            (None, Some(_)) => false,
            _ => true,
        };
        e.claim(Claim::Exact as u32, exact);
        e.cover(Cover::Kept as u32, known.is_none() && before.fix.is_some() && heard.to_exit.is_some());
        e.cover(Cover::New as u32, known.is_none() && before.fix.is_none() && heard.to_exit.is_some());
        e.cover(Cover::Ended as u32, known.is_some() && cycle.used_main.is_none() && before.fix.is_some());
    }
}

harness! {
    /// Lengths are rounded down to whole metres, added and taken off without a wrap.
    t_per_4_metres(e)
    theorem "T-PER-4";
    requirements ["PER-4"];
    assumptions [];
    bound "";
    cases 1;
    unwind 33 = 1 + crate::aspect::LONGEST;
    claims {
        Down: "the whole metres of a length are the most that are in it, up to 65 535",
        Up: "a length in metres is a thousand times as many millimetres",
        Sum: "a sum is exact, or the longest length; a difference is exact, or 0",
    }
    covers {
        Most: "more than 65 535 m",
        Some: "a length with a part of a metre",
    }
    {
        let length = any_u32(e, "length (mm)", 0..=65535);
        let metres = u32::from(Millimetres(length).whole_metres().0);
        let down = metres * 1000 <= length && (length < metres * 1000 + 1000 || metres == 65_535);
        e.claim(Claim::Down as u32, down);
        let asked = e.word("length (m)", 0..=65535);
        e.claim(Claim::Up as u32, Metres(asked).millimetres() == Millimetres(u32::from(asked) * 1000));
        let other = any_u32(e, "other length (mm)", 0..=65535);
        let (sum, least) = (u64::from(length) + u64::from(other), i64::from(length) - i64::from(other));
        let and = u64::from(Millimetres(length).and(Millimetres(other)).0);
        let less = i64::from(Millimetres(length).less(Millimetres(other)).0);
        let exact = and == if sum < 1 << 32 { sum } else { u64::from(u32::MAX) } && less == if least > 0 { least } else { 0 };
        e.claim(Claim::Sum as u32, exact);
        e.cover(Cover::Most as u32, metres == 65_535 && length > 65_536_000);
        e.cover(Cover::Some as u32, length > metres * 1000 && metres < 65_535);
    }
}
