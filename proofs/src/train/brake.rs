//! From the code to the brake, and no step skipped: T-TRN-2 and T-TRN-5.

use super::{BOUND, RANKS, STEADY, any_cycle, any_device_state, any_received, any_steady_cycle};
use crate::permitted::any_line;
use atc_kernel::aspect::AspectSet;
use atc_kernel::permitted::Basis;
use atc_kernel::speed::KmhTenths;
use atc_kernel::supervision::Brake;
use atc_kernel::train::{Received, State};

/// The speed of the one aspect of these bits; `None` without one.
fn speed_of(bits: u16, speeds: [KmhTenths; RANKS]) -> Option<KmhTenths> {
    let mut found = None;
    for (rank, speed) in speeds.into_iter().enumerate() {
        if bits == 1 << rank {
            found = Some(speed);
        }
    }
    found
}

harness! {
    /// The cab shows the speed of the aspect that acceptance displays, which is the lowest satisfied one, and no rise above the last. Where a
    /// code counts the permission is not above what is displayed, and a train whose brake is released does not measure more.
    t_trn_2(e)
    theorem "T-TRN-2";
    requirements ["TRN-2"];
    assumptions ["four-for-sixteen", "four-speeds"];
    bound BOUND;
    cases 1;
    unwind 33 = 1 + crate::aspect::LONGEST;
    solver kissat;
    claims {
        Shown: "the display is the speed, in the line's table, of the lowest satisfied aspect, if that is not above the one that was displayed last; else none",
        Below: "with a display no more is permitted than it says",
        Counts: "a permission whose basis has a code has a display",
        Measured: "with a display, a train whose brake is released measures no more than it says",
    }
    covers {
        Code: "the permission is what is displayed",
        Lower: "the permission is below what is displayed, and the brake is released",
        Unaccepted: "an aspect is detected, and nothing is displayed",
    }
    {
        let Some(line) = any_line(e) else { return };
        let Some(cycle) = any_cycle(e, line, None) else { return };
        let parts = cycle.after.acceptance.parts();
        let satisfied = parts.accepted & !parts.dropped & 15;
        let lowest = satisfied & satisfied.wrapping_neg();
        let displayed = if lowest <= parts.last { lowest } else { 0 };
        e.claim(Claim::Shown as u32, cycle.cab.display == speed_of(displayed, line.speeds));
        let (cab, display) = (cycle.cab, cycle.cab.display);
        e.claim(Claim::Below as u32, display.is_none() || cab.permission.speed <= display);
        let counts = matches!(cab.permission.basis, Basis::Analog | Basis::Both | Basis::RunningDown);
        e.claim(Claim::Counts as u32, !counts || display.is_some());
        let released = cab.brake == Brake::Release;
        let below = display.is_none_or(|display| cycle.received.speed.is_some_and(|speed| speed.0 <= i32::from(display.0)));
        e.claim(Claim::Measured as u32, !released || below);
        e.cover(Cover::Code as u32, counts && cab.permission.speed == display);
        e.cover(Cover::Lower as u32, counts && released && cab.permission.speed < display);
        let heard = cycle.received.detected.bits() & 15 != 0;
        e.cover(Cover::Unaccepted as u32, heard && display.is_none());
    }
}

harness! {
    /// A code that is detected and not displayed changes nothing but what acceptance remembers. Two trains differ in what is detected; where they
    /// display the same, they remember the same of all else, show and permit the same, and brake alike.
    t_trn_2_only(e)
    theorem "T-TRN-2";
    requirements ["TRN-2"];
    assumptions ["four-for-sixteen", "four-speeds"];
    bound "4 aspects, tables of 4 speeds, no telegrams in memory and none received";
    cases 1;
    unwind 33 = 1 + crate::aspect::LONGEST;
    solver kissat;
    claims {
        Rest: "telegrams, distances, the interval and the kind of line are remembered alike, whatever is displayed",
        Cab: "where the displays are the same, so are permission, position and brake",
    }
    covers {
        Heard: "one of them detects an aspect, the other none, and they display the same",
        Differ: "they display different speeds",
    }
    {
        let Some(line) = any_line(e) else { return };
        let Some((device, mut before)) = any_device_state(e, line, None) else { return };
        let Some(mut received) = any_received(e) else { return };
        let none = State::<RANKS>::INITIAL.permitted;
        before.permitted = atc_kernel::permitted::State { line: before.permitted.line, ..none };
        (received.main, received.sub) = (None, None);
        let detected = AspectSet::from_bits(e.word("detected by the other (bits)", 0..=15));
        let (one, shown) = device.train.act(before, received);
        let (other, also) = device.train.act(before, Received { detected, ..received });
        e.claim(Claim::Rest as u32, one.permitted == other.permitted && one.position == other.position);
        let alike = shown == also && one.brake == other.brake;
        e.claim(Claim::Cab as u32, shown.display != also.display || alike);
        let heard = received.detected != AspectSet::EMPTY && detected == AspectSet::EMPTY;
        e.cover(Cover::Heard as u32, heard && shown.display == also.display);
        e.cover(Cover::Differ as u32, shown.display != also.display);
    }
}

harness! {
    /// No permission is an emergency brake, not a service brake. Otherwise a train that measures a plausible speed is braked by the service brake
    /// if it is above the permission, and the brake is released only if it is not. A train that may not run is held, also at a stand.
    t_trn_5(e)
    theorem "T-TRN-5";
    requirements ["TRN-7", "TRN-13"];
    assumptions ["four-speeds", "printed-sizes"];
    bound STEADY;
    cases 1;
    unwind 33 = 1 + crate::aspect::LONGEST;
    solver kissat;
    claims {
        Emergency: "without a permission the emergency brake is commanded, at any speed",
        Implausible: "without a plausible speed the emergency brake is commanded, whatever is permitted",
        Service: "above the permission, at a plausible speed, the service brake is commanded",
        Released: "a brake that is released has a plausible speed, not above the permission",
        Held: "a brake that is released has a permission above 0",
        Nothing: "without a code and without a fresh telegram nothing is permitted",
        Kept: "the command is what is remembered",
    }
    covers {
        Nothing: "nothing is permitted",
        Zero: "a speed of 0 is permitted, and the train runs",
        Released: "the brake is released, and the train runs",
        Stands: "the brake is released, and the train stands",
        Held: "a speed of 0 is permitted, and the train stands",
    }
    {
        let Some(line) = any_line(e) else { return };
        let Some(cycle) = any_steady_cycle(e, line, None) else { return };
        let (cab, measured) = (cycle.cab, cycle.received.speed.map(|speed| speed.0));
        let maximum = i32::from(cycle.device.train.parts().supervision.maximum().0);
        let plausible = measured.is_some_and(|speed| 0 <= speed && speed <= maximum);
        let above = |speed: KmhTenths| measured.is_some_and(|measured| measured > i32::from(speed.0));
        e.claim(Claim::Emergency as u32, cab.permission.speed.is_some() || cab.brake == Brake::Emergency);
        e.claim(Claim::Implausible as u32, plausible || cab.brake == Brake::Emergency);
        let service = cab.permission.speed.is_some_and(|speed| plausible && above(speed));
        e.claim(Claim::Service as u32, !service || cab.brake == Brake::Service);
        let not_above = cab.permission.speed.is_some_and(|speed| plausible && !above(speed));
        e.claim(Claim::Released as u32, cab.brake != Brake::Release || not_above);
        let runs = cab.permission.speed.is_some_and(|speed| speed.0 > 0);
        e.claim(Claim::Held as u32, cab.brake != Brake::Release || runs);
        let fresh = cycle.after.permitted.target.is_some_and(|target| target.age.0 <= line.settings.fresh.0);
        let heard = cab.display.is_some() || fresh;
        e.claim(Claim::Nothing as u32, heard || cab.permission.speed.is_none());
        e.claim(Claim::Kept as u32, cycle.after.brake == cab.brake);
        e.cover(Cover::Nothing as u32, cab.permission.speed.is_none());
        let (zero, stands) = (cab.permission.speed == Some(KmhTenths(0)), measured == Some(0));
        e.cover(Cover::Zero as u32, zero && cab.brake == Brake::Service && !stands);
        e.cover(Cover::Released as u32, cab.brake == Brake::Release && measured > Some(0));
        e.cover(Cover::Stands as u32, cab.brake == Brake::Release && stands);
        e.cover(Cover::Held as u32, zero && cab.brake == Brake::Service && stands);
    }
}
