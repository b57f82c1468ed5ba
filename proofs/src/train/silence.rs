//! Silence, and the oldest evidence: T-TRN-3.

use super::{BOUND, RANKS, any_cycle, any_device};
use crate::any_u32;
use crate::permitted::any_line;
use atc_kernel::Machine;
use atc_kernel::supervision::Brake;
use atc_kernel::train::State;

harness! {
    /// Once for as many cycles as the oldest evidence no code was detected and no main telegram was used, the emergency brake is commanded, whatever
    /// else is received, announced or measured, and however fast the train is. The ghost counts those cycles, without an end.
    t_trn_3(e)
    theorem "T-TRN-3";
    requirements ["TRN-10"];
    assumptions ["four-for-sixteen", "four-speeds"];
    bound BOUND;
    cases 1;
    unwind 33 = 1 + crate::aspect::LONGEST;
    solver kissat;
    claims {
        Counted: "an accepted aspect is lost for at least as long as the ghost counts, and a target, also that of the section behind, is older than that",
        Braked: "once the ghost has counted the oldest evidence the emergency brake is commanded, and nothing is displayed or permitted",
        Sooner: "so it is already when it has counted T2 + T3 and the freshness",
        Oldest: "no target is older than the oldest evidence, and no accepted aspect is lost for as long",
        Start: "so it is in the initial state, whatever the ghost has counted",
    }
    covers {
        Ends: "in the cycle in which it has counted so far a target or an aspect is forgotten",
        Code: "one cycle less, and a code still permits",
        Telegram: "one cycle less, and a target is still kept",
        Announced: "after all that a line is announced",
    }
    {
        let Some(line) = any_line(e) else { return };
        let Some(cycle) = any_cycle(e, line, None) else { return };
        let oldest = u32::from(cycle.device.train.oldest().0);
        let silent = any_u32(e, "cycles without a code and a main telegram that is used", 0..=8);
        let counted = |state: &State<RANKS>, silent: u32| {
            let parts = state.acceptance.parts();
            let mut lost = true;
            for rank in 0..RANKS {
                lost &= parts.accepted >> rank & 1 == 0 || u32::from(parts.age[rank]) >= silent;
            }
            let old = |age: u16| u32::from(age) > silent;
            let telegrams = state.permitted.target.is_none_or(|target| old(target.age.0));
            lost && telegrams && state.permitted.behind.is_none_or(|behind| old(behind.age.0))
        };
        e.assume(counted(&cycle.before, silent));
        let heard = cycle.received.detected.bits() & 15 != 0 || cycle.used_main.is_some();
        let now = if heard { 0 } else { silent.saturating_add(1) };
        e.claim(Claim::Counted as u32, counted(&cycle.after, now));
        let cab = cycle.cab;
        let stopped = cab.brake == Brake::Emergency && cab.permission.speed.is_none() && cab.display.is_none();
        e.claim(Claim::Braked as u32, now < oldest || stopped);
        let settings = line.settings;
        let expiry = u32::from(cycle.device.train.parts().acceptance.times.expiry().0);
        let sooner = now >= expiry && now >= u32::from(settings.fresh.0);
        e.claim(Claim::Sooner as u32, !sooner || stopped);
        let parts = cycle.after.acceptance.parts();
        let mut young = cycle.after.permitted.target.is_none_or(|target| u32::from(target.age.0) <= oldest);
        for rank in 0..RANKS {
            young &= parts.accepted >> rank & 1 == 0 || u32::from(parts.age[rank]) < oldest;
        }
        e.claim(Claim::Oldest as u32, young);
        e.claim(Claim::Start as u32, counted(&cycle.device.train.initial(), u32::MAX));
        let forgotten = cycle.before.permitted.target.is_some() && cycle.after.permitted.target.is_none()
            || cycle.before.acceptance.parts().accepted != 0 && cycle.after.acceptance.parts().accepted == 0;
        e.cover(Cover::Ends as u32, now == oldest && forgotten);
        e.cover(Cover::Code as u32, now.saturating_add(1) == oldest && cab.display.is_some());
        e.cover(Cover::Telegram as u32, now.saturating_add(1) == oldest && cab.display.is_none() && cycle.after.permitted.target.is_some());
        e.cover(Cover::Announced as u32, now > oldest && cycle.received.line.is_some());
    }
}

harness! {
    /// The oldest evidence is the greater of T2 + T3 and the life of a main telegram: neither can be acted on longer, and one of them so long.
    trn_10(e)
    theorem "T-TRN-3";
    requirements ["TRN-10"];
    assumptions ["four-for-sixteen", "four-speeds"];
    bound BOUND;
    cases 1;
    unwind 33 = 1 + crate::aspect::LONGEST;
    claims {
        Greater: "it is not less than either, and it is one of them",
    }
    covers {
        Code: "it is T2 + T3",
        Life: "it is the life of a main telegram",
    }
    {
        let Some(line) = any_line(e) else { return };
        let Some((machine, _)) = crate::aspect::any_machine_state::<RANKS, E>(e) else { return };
        let Some(device) = any_device(e, line, machine, None) else { return };
        let (code, life) = (machine.times.expiry(), line.settings.life);
        let oldest = device.train.oldest();
        e.claim(Claim::Greater as u32, code <= oldest && life <= oldest && (oldest == code || oldest == life));
        e.cover(Cover::Code as u32, oldest == code && life < code);
        e.cover(Cover::Life as u32, oldest == life && code < life);
    }
}
