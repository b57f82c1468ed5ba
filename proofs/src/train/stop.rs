//! The stopping point, with a train: T-TRN-1.

use super::{Device, RANKS, any_moved, any_received, any_steady_state, codes, used_main};
use crate::permitted::{Line, any_line, any_parts, knows_main};
use crate::telegram::any_main;
use crate::{Engine, any_flag, any_u32};
use atc_kernel::aspect::{Acceptance, AspectId, AspectSet, AspectTable, Times};
use atc_kernel::distance::{Metres, Millimetres};
use atc_kernel::pattern::Deceleration;
use atc_kernel::permitted::{Basis, Fixed, Permitted, Settings, Target};
use atc_kernel::position::Measured;
use atc_kernel::speed::KmhTenths;
use atc_kernel::supervision::{Brake, Supervision};
use atc_kernel::telegram::{Gradient, Sequence, Sub};
use atc_kernel::time::Ticks;
use atc_kernel::train::{Parts, Received, State, Train};

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

/// A line of which only the lives matter, and a device for it in which a code plays no part: what a distance is made of.
fn any_distances<E: Engine + ?Sized>(e: &mut E) -> Option<(Device, State<RANKS>)> {
    let speeds = [0, 150, 450, 900].map(KmhTenths);
    let settings = Settings {
        speeds: AspectTable::new(&speeds).ok()?,
        lowest: AspectId::new(1)?,
        brake: Deceleration::brake(1000)?,
        worst: Gradient(-10),
        margin: Metres(10),
        fresh: Ticks(1),
        life: Ticks(e.word("life (cycles)", 4..=8)),
        fixed_life: Ticks(8),
        sequence: Sequence::new(3, 1, Ticks(4)).ok()?,
    };
    let permitted = Permitted::new(settings);
    e.assume(permitted.is_ok());
    let line = Line { permitted: permitted.ok()?, settings, speeds };
    let times = Times::from_ticks(Ticks(3), Ticks(4), Ticks(4), Ticks(7), Ticks(1)).ok()?;
    let (supervision, acceptance) = (Supervision::default(), Acceptance { times });
    let codes = codes([speeds[RANKS - 1]])?;
    let train = Train::new(Parts { codes, acceptance, permitted: line.permitted, supervision, position: None }).ok()?;
    let state = any_parts(e);
    let none = State::<RANKS>::INITIAL;
    let unheard = none.permitted;
    let permitted = atc_kernel::permitted::State {
        behind: unheard.behind,
        fixed: unheard.fixed,
        sub_stream: unheard.sub_stream,
        ..state
    };
    e.assume(permitted.is_valid(&line.permitted));
    Some((Device { train, line }, State { permitted, ..none }))
}

harness! {
    /// A ghost train has a true distance to its stopping point, which the main telegram that is in use named, and which the ground keeps. What the
    /// device knows of it is no longer than that, or 0. So it is after any cycle. Codes, sub telegrams and the target behind play no part in it, as
    /// T-PER-4 says of all of them.
    t_trn_1_distance(e)
    theorem "T-TRN-1";
    requirements ["TRN-9"];
    assumptions [
        "four-speeds", "odometer-bound", "one-section-at-a-time", "fix-of-the-section-heard",
        "margin-covers-the-crossing", "stop-point-life",
    ];
    built_in &[
        ("odometer-bound", "the true movement is the most that the odometer allows, less anything"),
        ("one-section-at-a-time", "the true distance before the cycle is to the same point, if section and distance beyond the exit are the same"),
        ("fix-of-the-section-heard", "a fix that is used is no longer than the true distance to the exit that the telegram means"),
        ("stop-point-life", "the point stays where it is while the target is kept"),
    ];
    bound "one line and any life of its telegrams, no code, no sub telegram, no target of the section behind";
    cases 3;
    unwind 33 = 1 + crate::aspect::LONGEST;
    solver kissat;
    apart [0 1 2];
    claims {
        Distance: "the distance that is kept to the stopping point is at most the true one, or 0",
    }
    covers {
        Fixed: "the distance comes from a fix, or there is none that is used",
        Again: "the longer distance to the same point is kept, or there is no telegram",
        Older: "a target stays, and is not at 0, or a fix is used",
    }
    {
        let case = e.choose("main telegram (0: none, 1: without a fix of its section, 2: with one)", 3);
        let Some((device, mut before)) = any_distances(e) else { return };
        let Some(main) = any_main(e) else { return };
        e.assume(knows_main(main));
        let Some(moved) = any_moved(e) else { return };
        let received = Received {
            detected: AspectSet::EMPTY,
            main: if case == 0 { None } else { Some(main) },
            sub: None,
            measured: Measured { first: None, second: None, moved },
            speed: None,
            line: None,
        };
        // The truth after the cycle, 2 147 km ahead or behind.
        let now = i64::from(i32::from_le_bytes(any_u32(e, "true distance to the stopping point (mm)", 0..=60_000).to_le_bytes()));
        let moved = i64::from(received.measured.moved.most()) - i64::from(any_u32(e, "moved less than the most by (mm)", 0..=3000));
        let used = used_main(&device, &before, &received);
        let target = before.permitted.target;
        let beyond = used.map_or(Metres(0), |main| main.route.beyond_exit());
        let again = used.is_some_and(|main| target.is_some_and(|target| target.section == main.section && target.beyond == beyond));
        let between = used.is_some_and(|main| before.permitted.main_stream.last.is_some_and(|last| last.section == main.section));
        let fixed = between && before.permitted.fix.is_some();
        e.assume(fixed == (case == 2));
        // Of the telegram of this cycle: the true distance to the exit of its section.
        let beyond_mm = u32::from(beyond.0) * 1000;
        let told = now - i64::from(beyond_mm);
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
        let above = known.is_some_and(|known| known.to_stop.0 > 0);
        e.cover(Cover::Fixed as u32, case < 2 || fixed && !again && known.is_some_and(|known| beyond_mm < known.to_stop.0));
        e.cover(Cover::Again as u32, case == 0 || again && known.is_some_and(|known| beyond_mm < known.to_stop.0));
        e.cover(Cover::Older as u32, case == 2 || used.is_none() && above);
    }
}

harness! {
    /// A ghost train has a true distance to its stopping point, and what the device keeps of it is no longer (`t_trn_1_distance`). Where the brake is not
    /// commanded after a cycle, and the permission rests on telegrams, the train, at the speed that it measures, still stops within that distance less
    /// the margin: v² ≤ 2·b·d. Within the margin the brake is commanded, also at a stand: a train that creeps does not come to its point.
    t_trn_1(e)
    theorem "T-TRN-1";
    requirements ["TRN-7", "TRN-13"];
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
        Stops: "the brake released, and a permission by telegrams: 125·v² ≤ 324·b·d, with the true distance less the margin",
        Held: "the brake released, and a permission by telegrams: the train is not within the margin",
        Nowhere: "without a target no permission above 0 rests on telegrams",
    }
    covers {
        Runs: "the train runs on a fresh telegram, or stands so near that it is held",
        Last: "it runs on the last pattern, with a code, or stands so near that it is held",
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
        e.claim(Claim::Held as u32, !runs || left > 0);
        let stopped = cab.permission.speed.is_none_or(|speed| speed.0 == 0);
        e.claim(Claim::Nowhere as u32, known.is_some() || !telegrams || stopped);
        let held = case < 2 && sound && telegrams && speed == 0 && cab.brake == Brake::Service;
        let last = cab.permission.basis == Basis::RunningDown;
        e.cover(Cover::Runs as u32, !last && (held || runs && speed > 0));
        e.cover(Cover::Last as u32, last && (held || runs && speed > 0));
        e.cover(Cover::Braked as u32, telegrams && cab.brake == Brake::Service && speed > 0);
    }
}
