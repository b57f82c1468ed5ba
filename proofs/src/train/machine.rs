//! The machine as a whole: T-TRN-7.

use super::facing::any_way;
use super::{RANKS, any_cycle, any_device_state, any_received, carriers};
use crate::aspect::any_machine_state;
use crate::permitted::any_line;
use crate::position::straight;
use atc_kernel::Machine;
use atc_kernel::code::{CodeTable, MAX_CODES};
use atc_kernel::permitted::{Basis, Permission};
use atc_kernel::speed::KmhTenths;
use atc_kernel::supervision::{Brake, Supervision};
use atc_kernel::train::{Antennas, Cab, Carrier, Parts, State, Train, TrainError};

harness! {
    /// A valid state leads to a valid one, and every cycle ends.
    trn_valid(e)
    theorem "T-TRN-7";
    requirements ["GEN-1"];
    assumptions ["four-for-sixteen", "four-speeds", "printed-sizes"];
    bound "4 aspects, tables of 4 speeds, one table";
    cases 2;
    unwind 35 = 1 + 2 * atc_kernel::position::KNOTS;
    solver kissat;
    apart [0 1];
    claims {
        Valid: "a valid state leads to a valid one",
        None: "a train that measures no position shows none",
    }
    covers {
        Display: "something is displayed",
        Target: "a main telegram is used",
    }
    {
        let measures = e.choose("position (0: none, 1: measured)", 2) == 1;
        let Some(line) = any_line(e) else { return };
        let position = if measures { straight(e) } else { None };
        let Some(cycle) = any_cycle(e, line, position) else { return };
        e.claim(Claim::Valid as u32, cycle.after.is_valid(&cycle.device.train));
        e.claim(Claim::None as u32, measures || cycle.cab.position.is_none());
        e.cover(Cover::Display as u32, cycle.cab.display.is_some());
        e.cover(Cover::Target as u32, cycle.used_main.is_some());
    }
}

harness! {
    /// As a machine the device is its two halves, one after the other, on what it knew before; on nothing, if the train faces another way than before, or if its
    /// direction was lost or found. It starts with nothing known, under the emergency brake, which is valid; its safe output
    /// shows and permits nothing, knows no place, and is the emergency brake.
    trn_machine(e)
    theorem "T-TRN-7";
    requirements ["GEN-1", "TRN-12"];
    assumptions ["four-for-sixteen", "four-speeds"];
    bound "4 aspects, tables of 4 speeds, before the step no main telegram was used";
    cases 1;
    unwind 33 = 1 + crate::aspect::LONGEST;
    solver kissat;
    claims {
        Step: "a step with antennas that receive nothing is what was received, acted on; by a device just started if the direction of travel is another one than before",
        Start: "the initial state is valid, knows nothing and brakes; in its first cycle, whatever is received, nothing is permitted by telegrams",
        Safe: "the safe output is the emergency brake, no display, no permission and no position",
    }
    covers {
        Runs: "the brake is released",
        Turned: "a train that displayed a speed changes ends",
        Lost: "the direction is lost",
    }
    {
        let Some(line) = any_line(e) else { return };
        let Some((device, mut before)) = any_device_state(e, line, None) else { return };
        let Some(received) = any_received(e) else { return };
        (before.permitted.target, before.permitted.behind) = (None, None);
        let silent = Carrier { code: None, frame: None };
        let antennas = Antennas {
            main: silent,
            sub: silent,
            first: received.measured.first,
            second: received.measured.second,
            moved: Some(received.measured.moved),
            speed: received.speed,
            line: received.line,
            facing: any_way(e, "facing now (0: not known, 1: left, else right)"),
        };
        before.facing = any_way(e, "facing before (0: not known, 1: left, else right)");
        let changed = before.facing != antennas.facing;
        let known = if changed { State { facing: antennas.facing, ..State::INITIAL } } else { before };
        let stepped = device.train.step(before, antennas);
        let acted = device.train.act(known, device.train.receive(antennas));
        e.claim(Claim::Step as u32, stepped == acted);
        let start = device.train.initial();
        let (_, cab) = device.train.act(start, received);
        let unknown = start.permitted.target.is_none() && start.permitted.fix.is_none() && start.position.is_none();
        let quiet = start.acceptance.parts().accepted == 0 && start.acceptance.parts().last == 0;
        let by_telegrams = matches!(cab.permission.basis, Basis::Both | Basis::Pattern | Basis::RunningDown);
        let begins = start == State::INITIAL && start.is_valid(&device.train) && start.brake == Brake::Emergency;
        e.claim(Claim::Start as u32, begins && unknown && quiet && !by_telegrams);
        let nothing = Permission { speed: None, basis: Basis::Nothing };
        let safe = Cab { display: None, permission: nothing, position: None, brake: Brake::Emergency };
        e.claim(Claim::Safe as u32, <Train<RANKS> as Machine>::SAFE == safe);
        e.cover(Cover::Runs as u32, stepped.1.brake == Brake::Release);
        let displayed = before.acceptance.parts().last != 0;
        e.cover(Cover::Turned as u32, changed && displayed && antennas.facing.is_some());
        e.cover(Cover::Lost as u32, changed && antennas.facing.is_none());
    }
}

harness! {
    /// The constructor accepts exactly what TRN-8 allows, and keeps it; the error names a rule that is broken.
    trn_8(e)
    theorem "T-TRN-7";
    requirements ["TRN-8"];
    assumptions ["four-for-sixteen", "four-speeds"];
    bound "4 aspects, tables of 4 speeds";
    cases 2;
    unwind 65 = 1 + MAX_CODES * MAX_CODES;
    apart [0 1];
    claims {
        Exact: "accepted if and only if the acceptance has as many ranks as the table has speeds, the highest speed is plausible, and every speed that a pair names is in the table",
        Kept: "what is accepted is kept: times, supervision, lives, no position",
        Told: "the error names a rule that is broken",
    }
    covers {
        Accepted: "parts are accepted, or the acceptance has too few ranks",
        Implausible: "a highest speed is above the highest plausible one, or the acceptance has too few ranks",
        Unknown: "a pair names a speed that is not in the table, or the acceptance has too few ranks",
    }
    {
        let few = e.choose("ranks of the acceptance (0: 4, 1: 3)", 2) == 1;
        let Some(line) = any_line(e) else { return };
        let supervision = Supervision::new(KmhTenths(e.word("highest plausible speed (0.1 km/h)", 900..=1500)), KmhTenths(0));
        e.assume(supervision.is_ok());
        let Ok(supervision) = supervision else { return };
        // Two pairs: one on the diagonal, one beside it.
        let mut named = [[None; MAX_CODES]; MAX_CODES];
        let places = [(1, 1), (3, 2)];
        let mut known = true;
        for (place, (main, sub)) in places.into_iter().enumerate() {
            let speed = KmhTenths(e.word("speed of a pair less that of a rank (0.1 km/h)", 0..=1).wrapping_add(line.speeds[place + 1].0));
            named[main][sub] = Some(speed);
            let mut found = false;
            for of_rank in line.speeds {
                found |= of_rank == speed;
            }
            known &= found;
        }
        let Some([main, sub]) = carriers() else { return };
        let Ok(codes) = CodeTable::new(main, sub, named) else { return e.assume(false) };
        let permitted = line.permitted;
        let plausible = line.speeds[RANKS - 1] <= supervision.maximum();
        if few {
            let Some((acceptance, _)) = any_machine_state::<3, E>(e) else { return };
            let made = Train::new(Parts { codes, acceptance, permitted, supervision, position: None });
            e.claim(Claim::Exact as u32, made.is_err());
            e.claim(Claim::Kept as u32, made.as_ref().map_or(true, |train| train.parts().acceptance == acceptance));
            e.claim(Claim::Told as u32, matches!(made, Err(TrainError::TooManyRanks)));
        } else {
            let Some((acceptance, _)) = any_machine_state::<RANKS, E>(e) else { return };
            let made = Train::new(Parts { codes, acceptance, permitted, supervision, position: None });
            e.claim(Claim::Exact as u32, made.is_ok() == (plausible && known));
            // Part by part: a copy of them all is a longer loop than the prover unwinds.
            let kept = |train: &Train<RANKS>| {
                let parts = train.parts();
                let same = parts.acceptance == acceptance && parts.supervision == supervision && parts.position.is_none();
                let [one, other] = [parts.permitted.settings(), permitted.settings()];
                same && one.lowest == other.lowest && one.life == other.life && one.fresh == other.fresh
            };
            e.claim(Claim::Kept as u32, made.as_ref().map_or(true, kept));
            let told = match made {
                Ok(_) => true,
                Err(TrainError::TooManyRanks) => false,
                Err(TrainError::ImplausibleSpeed(speed)) => !plausible && speed == line.speeds[RANKS - 1],
                Err(TrainError::UnknownSpeed(main, sub)) => {
                    !known && (main.place() == 1 && sub.place() == 1 || main.place() == 3 && sub.place() == 2)
                }
            };
            e.claim(Claim::Told as u32, told);
        }
        e.cover(Cover::Accepted as u32, few || plausible && known);
        e.cover(Cover::Implausible as u32, few || !plausible);
        e.cover(Cover::Unknown as u32, few || plausible && !known);
    }
}
