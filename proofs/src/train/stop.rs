//! The stopping point, with a train: T-TRN-1.

use super::{STEADY, any_received, any_steady_state, used_main};
use crate::permitted::{Line, any_line};
use crate::{Engine, any_flag, any_u32};
use atc_kernel::distance::{Metres, Millimetres};
use atc_kernel::pattern::Deceleration;
use atc_kernel::permitted::{Basis, Fixed, Permitted, Settings, Target};
use atc_kernel::supervision::Brake;
use atc_kernel::telegram::{Gradient, Sub};
use atc_kernel::train::Received;

/// The margin of this harness, in millimetres.
const MARGIN_MM: i64 = 10_000;

/// A distance that is no longer than the true one, or 0; any of them.
fn any_sound<E: Engine + ?Sized>(e: &mut E, truth: i64) -> Millimetres {
    let bound = truth - i64::from(any_u32(e, "known distance, shorter than the true one by (mm)", 0..=5000));
    Millimetres(u32::try_from(if bound < 0 { 0 } else { bound }).unwrap_or(u32::MAX))
}

/// Whether `bound` is no longer than the true distance, or 0.
fn sound(bound: Millimetres, truth: i64) -> bool {
    bound.0 == 0 || i64::from(bound.0) <= truth
}

harness! {
    /// A ghost train has a true distance to its stopping point, which the main telegram that is in use named, and which the ground keeps. What the
    /// device knows of it is no longer than that, or 0. So it is after any cycle.
    t_trn_1_distance(e)
    theorem "T-TRN-1";
    requirements ["TRN-9"];
    assumptions [
        "four-speeds", "printed-sizes", "odometer-bound", "one-section-at-a-time", "fix-of-the-section-heard",
        "margin-covers-the-crossing", "stop-point-life",
    ];
    built_in &[
        ("odometer-bound", "the true movement is the most that the odometer allows, less anything"),
        ("one-section-at-a-time", "the true distance before the cycle is to the same point, if section and distance beyond the exit are the same"),
        ("fix-of-the-section-heard", "a fix that is used is no longer than the true distance to the exit that the telegram means"),
        ("stop-point-life", "the point stays where it is while the target is kept"),
    ];
    bound STEADY;
    cases 1;
    unwind 33 = 1 + crate::aspect::LONGEST;
    solver kissat;
    claims {
        Distance: "the distance that is kept to the stopping point is at most the true one, or 0",
    }
    covers {
        Fixed: "the distance comes from a fix",
        Again: "the longer distance to the same point is kept",
        Older: "a target stays, and is not at 0",
    }
    {
        let Some(line) = any_line(e) else { return };
        let Some((device, mut before, detected)) = any_steady_state(e, line, None) else { return };
        let Some(received) = any_received(e) else { return };
        let received = Received { detected, ..received };
        // The truth after the cycle, 2 147 km ahead or behind.
        let now = i64::from(i32::from_le_bytes(any_u32(e, "true distance to the stopping point (mm)", 0..=60_000).to_le_bytes()));
        let moved = i64::from(received.measured.moved.most()) - i64::from(any_u32(e, "moved less than the most by (mm)", 0..=3000));
        let used = used_main(&device, &before, &received);
        let target = before.permitted.target;
        let beyond = used.map_or(Metres(0), |main| main.route.beyond_exit());
        let again = used.is_some_and(|main| target.is_some_and(|target| target.section == main.section && target.beyond == beyond));
        let between = used.is_some_and(|main| before.permitted.main_stream.last.is_some_and(|last| last.section == main.section));
        let fixed = between && before.permitted.fix.is_some();
        // Of the telegram of this cycle: the true distance to the exit of its section.
        let told = now - i64::from(beyond.0) * 1000;
        e.suppose("margin-covers-the-crossing", used.is_none() || told >= 0 || told + moved >= 0);
        if used.is_none() || again {
            let known = any_sound(e, now + moved);
            before.permitted.target = target.map(|target| Target { to_stop: known, ..target });
        }
        if fixed {
            before.permitted.fix = Some(any_sound(e, told + moved));
        }
        let (after, _) = device.train.act(before, received);
        let known = after.permitted.target;
        e.claim(Claim::Distance as u32, known.is_none_or(|known| sound(known.to_stop, now)));
        let beyond_mm = u32::from(beyond.0) * 1000;
        let above = known.is_some_and(|known| known.to_stop.0 > 0);
        e.cover(Cover::Fixed as u32, fixed && !again && known.is_some_and(|known| beyond_mm < known.to_stop.0));
        e.cover(Cover::Again as u32, again && !fixed && known.is_some_and(|known| beyond_mm < known.to_stop.0));
        e.cover(Cover::Older as u32, used.is_none() && above);
    }
}

harness! {
    /// A ghost train has a true distance to its stopping point, and what the device keeps of it is no longer (`t_trn_1_distance`). Where the brake is not
    /// commanded after a cycle, and the permission rests on telegrams, the train, at the speed that it measures, still stops within that distance less
    /// the margin: v² ≤ 2·b·d.
    t_trn_1(e)
    theorem "T-TRN-1";
    requirements ["TRN-7"];
    assumptions ["four-speeds", "printed-sizes", "gravity", "sub-data-worst", "speed-not-under"];
    built_in &[
        ("gravity", "the train slows down by 901 mm/s²: 1000 less 10 thousandths of gravity"),
        ("sub-data-worst", "every gradient that is told, and the worst, is that of the ground"),
        ("speed-not-under", "the train is no faster than it measures"),
    ];
    bound "tables of 4 speeds, one accepted aspect or none, distances of 0, 1, 100 and 3000 m and less than a metre more, or under the margin, one deceleration, one margin";
    cases 5;
    unwind 33 = 1 + crate::aspect::LONGEST;
    solver kissat;
    apart [0 1 2 3 4];
    claims {
        Stops: "the brake released, and a permission by telegrams: 125·v² ≤ 324·b·d, with the true distance less the margin, and v = 0 within the margin",
        Nowhere: "without a target no permission above 0 rests on telegrams",
    }
    covers {
        Runs: "the train runs on a fresh telegram, or is so near that it must stand",
        Last: "it runs on the last pattern, with a code, or is so near that it must stand",
        Braked: "the brake is commanded, for the train is too fast",
    }
    {
        // What is left after the margin, case by case, so that what the train may run at is constant.
        let case = e.choose("distance less the margin (0: none, 1: 0, 2: 1, 3: 100, 4: 3000 m)", 5);
        let metres: i64 = match case {
            0 | 1 => 0,
            2 => 1,
            3 => 100,
            _ => 3000,
        };
        let part = e.word("and more (mm)", 0..=999);
        e.assume(part < 1000);
        let part = i64::from(part & 1023);
        // The truth after the cycle.
        let now = if case == 0 {
            MARGIN_MM - 1 - i64::from(any_u32(e, "under the margin by (mm)", 0..=9000))
        } else {
            MARGIN_MM + metres * 1000 + part
        };

        let Some(line) = any_line(e) else { return };
        let Some(brake) = Deceleration::brake(1000) else { return };
        let gradient = Gradient(-10);
        let settings = Settings { brake, worst: gradient, margin: Metres(10), ..line.settings };
        let Ok(permitted) = Permitted::new(settings) else { return e.assume(false) };
        let line = Line { permitted, settings, ..line };
        let Some((device, mut before, detected)) = any_steady_state(e, line, None) else { return };
        let Some(mut received) = any_received(e) else { return };
        received.detected = detected;
        before.permitted.fixed = before.permitted.fixed.map(|fixed| fixed.map(|fixed| Fixed { gradient, ..fixed }));
        received.sub = received.sub.map(|sub| Sub { gradient, ..sub });
        // Any bound of the true distance, as far as nothing else makes it: likely, so that drawn values meet the case.
        if let Some(target) = before.permitted.target {
            let likely = any_sound(e, now + i64::from(received.measured.moved.most()));
            if any_flag(e, "as far as the train is (odd: yes)") {
                before.permitted.target = Some(Target { to_stop: likely, ..target });
            }
        }

        let (after, cab) = device.train.act(before, received);
        let known = after.permitted.target;
        let sound = known.is_none_or(|known| sound(known.to_stop, now));
        let telegrams = matches!(cab.permission.basis, Basis::Both | Basis::Pattern | Basis::RunningDown);
        let runs = sound && cab.brake == Brake::Release && telegrams;
        // No speed, or a negative one, is never released (SUP-2).
        let speed = received.speed.map_or(0, |speed| u16::try_from(speed.0).unwrap_or(u16::MAX));
        let (speed, left) = (u64::from(speed), u64::try_from(now - MARGIN_MM).unwrap_or(0));
        e.claim(Claim::Stops as u32, !runs || 125_000 * speed * speed <= 324 * 901 * left);
        let stopped = cab.permission.speed.is_none_or(|speed| speed.0 == 0);
        e.claim(Claim::Nowhere as u32, known.is_some() || !telegrams || stopped);
        let near = case < 2;
        let last = cab.permission.basis == Basis::RunningDown;
        e.cover(Cover::Runs as u32, runs && !last && (speed > 0 || near));
        e.cover(Cover::Last as u32, runs && last && (speed > 0 || near));
        e.cover(Cover::Braked as u32, telegrams && cab.brake == Brake::Service && speed > 0);
    }
}
