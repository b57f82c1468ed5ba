//! Speed supervision: SUP-1 to SUP-3.

use crate::{Engine, Harness, any_u32};
use atc_kernel::Machine;
use atc_kernel::speed::{KmhTenths, RawKmhTenths};
use atc_kernel::supervision::{Brake, Speeds, Supervision, SupervisionError, step};

/// The harnesses of this module.
#[cfg(not(chosen))]
pub const ALL: &[Harness] = &[sup_1::HARNESS, sup_2::HARNESS, sup_3::HARNESS, sup_machine::HARNESS];

struct Cycle {
    maximum: i64,
    margin: i64,
    previous: Brake,
    measured: Option<i32>,
    permitted: Option<i32>,
    brake: Brake,
    /// The command from the same speeds when the previous command was a release.
    unbraked: Brake,
}

pub(crate) fn any_speed<E: Engine + ?Sized>(e: &mut E, what: &'static str) -> Option<i32> {
    let value = any_u32(e, what, 0..=30).cast_signed_compat();
    if e.word("that speed is missing (3 mod 4)", 0..=3) & 3 == 3 { None } else { Some(value) }
}

/// `u32::cast_signed`, which is newer than the compilers this is built with.
trait CastSigned {
    fn cast_signed_compat(self) -> i32;
}

impl CastSigned for u32 {
    fn cast_signed_compat(self) -> i32 {
        i32::from_ne_bytes(self.to_ne_bytes())
    }
}

fn any_cycle<E: Engine + ?Sized>(e: &mut E) -> Option<Cycle> {
    let maximum = e.word("highest plausible speed (0.1 km/h)", 1..=30);
    let margin = e.word("release margin (0.1 km/h)", 0..=5);
    let Ok(parameters) = Supervision::new(KmhTenths(maximum), KmhTenths(margin)) else {
        e.assume(false);
        return None;
    };
    let previous = match e.word("previous brake (0 release, 1 service, else emergency)", 0..=2) {
        0 => Brake::Release,
        1 => Brake::Service,
        _ => Brake::Emergency,
    };
    let measured = any_speed(e, "measured speed (0.1 km/h, two's complement)");
    let permitted = any_speed(e, "permitted speed (0.1 km/h, two's complement)");
    let speeds = Speeds { measured: measured.map(RawKmhTenths), permitted: permitted.map(RawKmhTenths) };
    Some(Cycle {
        maximum: i64::from(maximum),
        margin: i64::from(margin),
        previous,
        measured,
        permitted,
        brake: step(parameters, previous, speeds),
        unbraked: step(parameters, Brake::Release, speeds),
    })
}

/// The measured and the permitted speed, if both are plausible.
fn plausible(cycle: &Cycle) -> Option<(i64, i64)> {
    match (cycle.measured.map(i64::from), cycle.permitted.map(i64::from)) {
        (Some(measured), Some(permitted)) if measured >= 0 && measured <= cycle.maximum && permitted >= 0 => {
            Some((measured, permitted))
        }
        _ => None,
    }
}

harness! {
    /// The brake is on when the speed is above the permitted one and released when it is not; a release margin only
    /// delays a release; without a margin the previous command does not matter.
    sup_1(e)
    theorem "SUP-1";
    requirements ["SUP-1"];
    assumptions [];
    bound "";
    cases 1;
    unwind 2 = 1 + 1;
    claims {
        Above: "above the permitted speed the brake is on",
        NotAbove: "not above it, and with no brake on before, it is released",
        MarginDelays: "a brake that was on stays on at least as long as without a margin, and at most until the margin is reached or the train stands",
        Function: "without a margin the command is a function of the two speeds",
        Held: "a brake that was on, service or emergency, stays on until the margin is reached or the train stands",
    }
    covers {
        Delayed: "a release that the margin delays",
        Released: "a brake that was on is released",
        Equal: "the speed is exactly the permitted one",
    }
    {
        let Some(cycle) = any_cycle(e) else { return };
        let Some((measured, permitted)) = plausible(&cycle) else { return e.assume(false) };
        let (above, braked) = (measured > permitted, cycle.previous != Brake::Release);
        e.claim(Claim::Above as u32, !above || cycle.brake != Brake::Release);
        e.claim(Claim::NotAbove as u32, above || braked || cycle.brake == Brake::Release);
        let reached = measured == 0 || measured <= permitted - cycle.margin;
        e.claim(
            Claim::MarginDelays as u32,
            cycle.brake >= cycle.unbraked && (above || !reached || cycle.brake == Brake::Release),
        );
        e.claim(Claim::Function as u32, cycle.margin > 0 || cycle.brake == cycle.unbraked);
        e.claim(Claim::Held as u32, !braked || reached || cycle.brake != Brake::Release);
        e.cover(Cover::Delayed as u32, cycle.brake > cycle.unbraked);
        e.cover(Cover::Released as u32, braked && cycle.brake == Brake::Release);
        e.cover(Cover::Equal as u32, measured == permitted);
    }
}

harness! {
    /// An implausible speed or permission is an emergency brake, and a plausible pair never is.
    sup_2(e)
    theorem "SUP-2";
    requirements ["SUP-2"];
    assumptions [];
    bound "";
    cases 1;
    unwind 2 = 1 + 1;
    claims {
        Emergency: "a missing, negative or too high speed, or a missing or negative permission, commands the emergency brake, and nothing else does",
    }
    covers {
        Missing: "a speed is missing",
        Negative: "a speed is negative",
        TooHigh: "a speed is one above the maximum",
        NoPermission: "a permission is negative",
    }
    {
        let Some(cycle) = any_cycle(e) else { return };
        e.claim(Claim::Emergency as u32, (cycle.brake == Brake::Emergency) == plausible(&cycle).is_none());
        e.cover(Cover::Missing as u32, cycle.measured.is_none());
        e.cover(Cover::Negative as u32, cycle.measured.is_some_and(|speed| speed < 0));
        e.cover(Cover::TooHigh as u32, cycle.measured.is_some_and(|speed| i64::from(speed) == cycle.maximum + 1));
        e.cover(Cover::NoPermission as u32, cycle.permitted.is_some_and(|speed| speed < 0));
    }
}

harness! {
    /// The constructor of the supervision parameters accepts exactly what SUP-3 allows.
    sup_3(e)
    theorem "SUP-3";
    requirements ["SUP-3"];
    assumptions [];
    bound "";
    cases 1;
    unwind 2 = 1 + 1;
    claims {
        Exact: "accepted if and only if the maximum is above 0 and the margin not above it; kept as asked; the error names the broken rule",
    }
    covers {
        Accepted: "some parameters are accepted",
        Refused: "some parameters are refused",
    }
    {
        let (maximum, margin) = (e.word("highest plausible speed (0.1 km/h)", 0..=30), e.word("release margin (0.1 km/h)", 0..=30));
        let exact = match Supervision::new(KmhTenths(maximum), KmhTenths(margin)) {
            Ok(kept) => maximum > 0 && margin <= maximum && kept.maximum().0 == maximum && kept.margin().0 == margin,
            Err(SupervisionError::NoMaximum) => maximum == 0,
            Err(SupervisionError::MarginAboveMaximum) => margin > maximum,
        };
        e.claim(Claim::Exact as u32, exact);
        e.cover(Cover::Accepted as u32, maximum > 0 && margin <= maximum);
        e.cover(Cover::Refused as u32, maximum == 0 || margin > maximum);
    }
}

harness! {
    /// As a machine the supervision is its step: it remembers the command that it gives, it starts with the emergency
    /// brake, which is its safe output too, and more braking is the higher command.
    sup_machine(e)
    theorem "SUP-1";
    requirements ["SUP-1", "GEN-1"];
    assumptions [];
    bound "";
    cases 1;
    unwind 2 = 1 + 1;
    claims {
        Step: "the machine commands, and remembers, what the step says",
        Start: "the initial state and the safe output are the emergency brake",
        Order: "release is below service, and service below emergency",
    }
    covers {
        Braking: "the machine brakes",
    }
    {
        let (maximum, margin) = (e.word("highest plausible speed (0.1 km/h)", 1..=30), e.word("release margin (0.1 km/h)", 0..=5));
        let Ok(machine) = Supervision::new(KmhTenths(maximum), KmhTenths(margin)) else { return e.assume(false) };
        let previous = match e.word("previous brake (0 release, 1 service, else emergency)", 0..=2) {
            0 => Brake::Release,
            1 => Brake::Service,
            _ => Brake::Emergency,
        };
        let measured = any_speed(e, "measured speed (0.1 km/h, two's complement)").map(RawKmhTenths);
        let permitted = any_speed(e, "permitted speed (0.1 km/h, two's complement)").map(RawKmhTenths);
        let speeds = Speeds { measured, permitted };
        let expected = step(machine, previous, speeds);
        let (next, brake) = machine.step(previous, speeds);
        e.claim(Claim::Step as u32, brake == expected && next == expected);
        e.claim(Claim::Start as u32, machine.initial() == Brake::Emergency && Supervision::SAFE == Brake::Emergency);
        e.claim(Claim::Order as u32, Brake::Release < Brake::Service && Brake::Service < Brake::Emergency);
        e.cover(Cover::Braking as u32, brake == Brake::Service);
    }
}
