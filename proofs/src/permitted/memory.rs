//! What is remembered, and for how long: PER-2, PER-5 to PER-9.

use super::{any_cycle, any_heard, any_kind, any_line, any_parts, any_state, knows_main};
use crate::{any_flag, any_u32};
use atc_kernel::Machine;
use atc_kernel::distance::Millimetres;
use atc_kernel::permitted::{
    Basis, Fixed, Heard, LineKind, Permission, Permitted, PermittedError, Settings, State, Target, Telegrams, step,
};
use atc_kernel::speed::KmhTenths;
use atc_kernel::telegram::Stream;
use atc_kernel::time::Ticks;

harness! {
    /// The kind of line is what the train was told last, and digital before that.
    t_per_2(e)
    theorem "T-PER-2";
    requirements ["PER-2"];
    assumptions ["four-speeds"];
    bound "tables of 4 speeds";
    cases 1;
    unwind 33 = 1 + crate::aspect::LONGEST;
    claims {
        Told: "after a cycle the line is the one that was told in it, or the one before",
        Start: "the initial line is digital",
    }
    covers {
        Changed: "the line changes",
        Kept: "nothing is told",
    }
    {
        let Some(cycle) = any_cycle(e) else { return };
        let line = match cycle.heard.line {
            Some(line) => line,
            None => cycle.before.line,
        };
        e.claim(Claim::Told as u32, cycle.after.line == line);
        e.claim(Claim::Start as u32, cycle.line.permitted.initial().line == LineKind::Digital);
        e.cover(Cover::Changed as u32, cycle.after.line != cycle.before.line);
        e.cover(Cover::Kept as u32, cycle.heard.line.is_none());
    }
}

harness! {
    /// Fixed data come from sub telegrams that were used, and from nothing else; they grow older with every cycle and are
    /// forgotten after their life. The last two sections are kept.
    t_per_5_evidence(e)
    theorem "T-PER-5";
    requirements ["PER-5", "PER-8", "PER-12"];
    assumptions ["four-speeds"];
    bound "tables of 4 speeds";
    cases 1;
    unwind 33 = 1 + crate::aspect::LONGEST;
    claims {
        Learned: "after a sub telegram that is used the newest data are its own, with the lower of its two limits, and as old as the telegram before it",
        Older: "all other data are the ones of before, one cycle older and not past their life",
        Forgotten: "data past their life are gone; younger ones are kept, unless two other sections are newer",
        Valid: "the fixed data stay valid: young, and of two sections",
    }
    covers {
        Replaced: "newer data of the same section",
        Second: "data of a second section",
        Expired: "data expire",
    }
    {
        let Some(cycle) = any_cycle(e) else { return };
        let life = cycle.line.settings.fixed_life.0;
        let older = |fixed: Option<Fixed>| {
            fixed.filter(|fixed| fixed.age.0 < life).map(|fixed| Fixed { age: Ticks(fixed.age.0 + 1), ..fixed })
        };
        let [newest, other] = cycle.before.fixed.map(older);
        let (mut learned, mut replaced) = (true, false);
        let expected = match cycle.used_sub {
            None => [newest, other],
            Some(sub) => {
                let limit = match (cycle.line.speed(sub.curve), cycle.line.speed(sub.restriction)) {
                    (Some(curve), Some(restriction)) if curve < restriction => curve,
                    (_, Some(restriction)) => restriction,
                    _ => KmhTenths(0),
                };
                let age = Ticks(cycle.before.sub_stream.age.0 + 1);
                let own = Fixed { section: sub.section, gradient: sub.gradient, limit, age };
                learned = cycle.after.fixed[0] == Some(own);
                replaced = newest.is_some_and(|newest| newest.section == sub.section);
                [Some(own), if replaced { other } else { newest }]
            }
        };
        e.claim(Claim::Learned as u32, learned);
        e.claim(Claim::Older as u32, cycle.after.fixed[1].is_none() || cycle.after.fixed[1] == expected[1]);
        e.claim(Claim::Forgotten as u32, cycle.used_sub.is_some() || cycle.after.fixed == [newest, other]);
        let [newest_after, other_after] = cycle.after.fixed;
        let young = |fixed: Option<Fixed>| fixed.is_none_or(|fixed| fixed.age.0 <= life);
        let apart = match (newest_after, other_after) {
            (Some(newest), Some(other)) => newest.section != other.section,
            _ => true,
        };
        e.claim(Claim::Valid as u32, young(newest_after) && young(other_after) && apart && cycle.after.fixed[1] == expected[1]);
        e.cover(Cover::Replaced as u32, cycle.used_sub.is_some() && replaced);
        e.cover(Cover::Second as u32, cycle.used_sub.is_some() && other_after.is_some() && !replaced);
        e.cover(Cover::Expired as u32, cycle.before.fixed[0].is_some() && newest.is_none());
    }
}

harness! {
    /// A digital line permits no speed above 0 once the last main telegram that was used is older than the life, whatever the train
    /// was told, and however often. The ghost is the age of that telegram since it can have been sent, without an end.
    t_per_6(e)
    theorem "T-PER-6";
    requirements ["PER-6", "PER-11"];
    assumptions ["four-speeds"];
    bound "tables of 4 speeds";
    cases 1;
    unwind 33 = 1 + crate::aspect::LONGEST;
    claims {
        Counted: "a target is as old as the ghost, and without one the ghost is over the life",
        Ended: "once the ghost is over the life telegrams are lost: on a digital line no speed above 0 is permitted (T-PER-1)",
        Start: "before any telegram was used they are lost",
    }
    covers {
        RanDown: "a pattern has run down",
        Began: "a digital line is told after an analog one, without a target",
        Again: "the line that the train is on is told again",
        Used: "a main telegram is used after a long time",
    }
    {
        let Some(cycle) = any_cycle(e) else { return };
        let life = cycle.line.settings.life.0;
        let ghost = any_u32(e, "age of the last telegram that was used (cycles)", 0..=7);
        let counted = |state: &State, ghost: u32| match state.target {
            Some(target) => u32::from(target.age.0) == ghost,
            None => ghost > u32::from(life),
        };
        e.assume(counted(&cycle.before, ghost));
        let now = if cycle.used_main.is_some() { u32::from(cycle.before.main_stream.age.0) + 1 } else { ghost.saturating_add(1) };
        e.claim(Claim::Counted as u32, counted(&cycle.after, now));
        let lost = |state: &State| matches!(state.telegrams(&cycle.line.permitted), Telegrams::Lost);
        e.claim(Claim::Ended as u32, now <= u32::from(life) || lost(&cycle.after));
        e.claim(Claim::Start as u32, lost(&cycle.line.permitted.initial()));
        let digital = cycle.after.line == LineKind::Digital;
        e.cover(Cover::RanDown as u32, digital && cycle.before.target.is_some() && cycle.after.target.is_none());
        let analog = cycle.before.line == LineKind::Analog;
        e.cover(Cover::Began as u32, analog && digital && cycle.after.target.is_none());
        e.cover(Cover::Again as u32, cycle.heard.line == Some(cycle.before.line));
        e.cover(Cover::Used as u32, cycle.used_main.is_some() && ghost > u32::from(life));
    }
}

harness! {
    /// What a train is told of the line is no evidence. Two trains hear the same; one was told anything at any time, the other never
    /// anything but a digital line. They remember the same but for the kind of line, and after a cycle they do again. So a train that
    /// was told of a digital line last permits exactly what the other one does.
    t_per_6_announced(e)
    theorem "T-PER-6";
    requirements ["PER-11"];
    assumptions ["four-speeds"];
    bound "tables of 4 speeds";
    cases 1;
    unwind 33 = 1 + crate::aspect::LONGEST;
    solver kissat;
    claims {
        Same: "after the cycle both remember the same but for the kind of line",
        Digital: "where the first one was told of a digital line last, they are in the same state",
    }
    covers {
        Told: "the first one is told of another kind of line than before",
        Analog: "the first one is told of an analog line",
    }
    {
        let Some(line) = any_line(e) else { return };
        let told = any_state(e, &line);
        let untold = State { line: LineKind::Digital, ..told };
        let Some(heard) = any_heard(e) else { return };
        let news = any_kind(e, "line that is told to the other (odd: digital)");
        let after = told.listen(&line.permitted, heard);
        let digital = any_flag(e, "the other is told of a digital line (odd: yes)").then_some(LineKind::Digital);
        let other = untold.listen(&line.permitted, Heard { line: digital, ..heard });
        e.claim(Claim::Same as u32, State { line: news, ..after } == State { line: news, ..other });
        e.claim(Claim::Digital as u32, after.line == LineKind::Analog || after == other);
        e.cover(Cover::Told as u32, heard.line.is_some() && heard.line != Some(told.line));
        e.cover(Cover::Analog as u32, heard.line == Some(LineKind::Analog));
    }
}

harness! {
    /// A telegram with a rank that the line does not have changes nothing: the cycle is as if it had not come.
    t_per_7(e)
    theorem "T-PER-7";
    requirements ["PER-7"];
    assumptions ["four-speeds"];
    bound "tables of 4 speeds";
    cases 1;
    unwind 33 = 1 + crate::aspect::LONGEST;
    solver kissat;
    claims {
        Main: "a main telegram with an unknown rank is as none",
        Sub: "a sub telegram with an unknown rank is as none",
    }
    covers {
        Main: "a main telegram with an unknown rank",
        Curve: "a sub telegram whose curve has an unknown rank",
        Restriction: "a sub telegram whose restriction alone has an unknown rank",
    }
    {
        let Some(line) = any_line(e) else { return };
        let before = any_state(e, &line);
        let Some(heard) = any_heard(e) else { return };
        let after = before.listen(&line.permitted, heard);
        let without_main = before.listen(&line.permitted, Heard { main: None, ..heard });
        let without_sub = before.listen(&line.permitted, Heard { sub: None, ..heard });
        let unknown_main = heard.main.is_some_and(|main| main.speed.rank() >= 4);
        let (curve, restriction) = heard.sub.map_or((0, 0), |sub| (sub.curve.rank(), sub.restriction.rank()));
        e.claim(Claim::Main as u32, !unknown_main || after == without_main);
        e.claim(Claim::Sub as u32, (curve < 4 && restriction < 4) || after == without_sub);
        e.cover(Cover::Main as u32, unknown_main);
        e.cover(Cover::Curve as u32, curve >= 4);
        e.cover(Cover::Restriction as u32, curve < 4 && restriction >= 4);
    }
}

harness! {
    /// A target comes from a main telegram that was used, and from nothing else; it grows older with every cycle and is
    /// forgotten after its life. Every valid state leads to a valid one.
    t_per_8(e)
    theorem "T-PER-8";
    requirements ["PER-8", "PER-12", "PER-15", "GEN-1"];
    assumptions ["four-speeds"];
    bound "tables of 4 speeds";
    cases 1;
    unwind 33 = 1 + crate::aspect::LONGEST;
    claims {
        Used: "after a main telegram that is used the target is its own: its section, distance beyond the exit and speed, and as old as the telegram before it",
        Older: "otherwise a target is the one of before, one cycle older",
        Forgotten: "and there is none if it was as old as its life",
        Behind: "the target of the section behind is the target of before where one of another section takes its place, and otherwise the one of before; one cycle older, as far as the train moved, and gone after its life",
        Streams: "the counters of either stream are what T-TEL-6 makes of them and of the cycle's telegram, if its ranks are known: used, refused, or none",
        Valid: "a valid state leads to a valid one",
    }
    covers {
        Used: "a main telegram is used",
        Refused: "a known main telegram is not used",
        Forgotten: "a target is forgotten",
        Border: "a target takes the place of one of another section",
    }
    {
        let Some(cycle) = any_cycle(e) else { return };
        let (before, after) = (cycle.before.target, cycle.after.target);
        let own = |main: atc_kernel::telegram::Main| {
            after.is_some_and(|after| {
                let same = after.section == main.section && after.beyond == main.route.beyond_exit();
                same && Some(after.limit) == cycle.line.speed(main.speed) && after.age.0 == cycle.before.main_stream.age.0 + 1
            })
        };
        e.claim(Claim::Used as u32, cycle.used_main.is_none_or(own));
        let old = before.is_some_and(|before| before.age.0 >= cycle.line.settings.life.0);
        let older = match (before, after) {
            (Some(before), Some(after)) => after.age.0 == before.age.0 + 1 && after.section == before.section,
            (None, Some(_)) => false,
            (_, None) => before.is_none() || old,
        };
        e.claim(Claim::Older as u32, cycle.used_main.is_some() || older);
        e.claim(Claim::Forgotten as u32, cycle.used_main.is_some() || !old || after.is_none());
        let later = |target: Option<Target>| {
            target.filter(|target| target.age.0 < cycle.line.settings.life.0).map(|target| {
                let to_stop = Millimetres(target.to_stop.0.saturating_sub(cycle.heard.moved.0));
                Target { age: Ticks(target.age.0 + 1), to_stop, ..target }
            })
        };
        let (own, behind) = (later(before), later(cycle.before.behind));
        let border = match (own, cycle.used_main) {
            (Some(own), Some(main)) => own.section != main.section,
            _ => false,
        };
        e.claim(Claim::Behind as u32, cycle.after.behind == if border { own } else { behind });
        e.cover(Cover::Border as u32, border);
        e.claim(Claim::Streams as u32, [cycle.after.main_stream, cycle.after.sub_stream] == cycle.streams);
        e.claim(Claim::Valid as u32, cycle.after.is_valid(&cycle.line.permitted));
        e.cover(Cover::Used as u32, cycle.used_main.is_some());
        let known = cycle.heard.main.is_some_and(knows_main);
        e.cover(Cover::Refused as u32, known && cycle.used_main.is_none());
        e.cover(Cover::Forgotten as u32, old && after.is_none());
    }
}

harness! {
    /// The constructor accepts exactly what PER-9 allows, and keeps it.
    per_9(e)
    theorem "T-PER-9";
    requirements ["PER-9"];
    assumptions ["four-speeds"];
    bound "tables of 4 speeds";
    cases 1;
    unwind 33 = 1 + crate::aspect::LONGEST;
    claims {
        Exact: "accepted if and only if the lowest limit is in the table, 1 ≤ freshness ≤ life ≤ 60 000 1 ≤ life of sub telegrams ≤ 60 000, and the memory is over neither; kept as asked",
        Told: "the error names a rule that is broken",
    }
    covers {
        Accepted: "parameters are accepted",
        Refused: "parameters are refused",
    }
    {
        let Some(line) = any_line(e) else { return };
        let lowest = crate::telegram::any_rank(e, "lowest limit (rank)");
        let Some(lowest) = lowest else { return };
        let [fresh, life, fixed_life] = [0..=3, 0..=3, 0..=3].map(|likely| Ticks(e.word("freshness, life, life of sub telegrams (cycles)", likely)));
        let asked = Settings { lowest, fresh, life, fixed_life, ..line.settings };
        let result = Permitted::new(asked);
        let (fresh, life, fixed_life) = (fresh.0, life.0, fixed_life.0);
        let memory = line.settings.sequence.memory().0;
        let right = lowest.rank() < 4 && 1 <= fresh && fresh <= life && life <= 60_000 && (1..=60_000).contains(&fixed_life) && memory <= life && memory <= fixed_life;
        e.claim(Claim::Exact as u32, result.is_ok() == right && result.as_ref().map_or(true, |kept| *kept.settings() == asked));
        let told = match result {
            Ok(_) => true,
            Err(PermittedError::UnknownLimit) => lowest.rank() >= 4,
            Err(PermittedError::NoFreshness) => fresh == 0,
            Err(PermittedError::LifeShorterThanFreshness) => life < fresh,
            Err(PermittedError::TooLong) => life > 60_000 || fixed_life > 60_000,
            Err(PermittedError::NoFixedLife) => fixed_life == 0,
            Err(PermittedError::MemoryLongerThanLife) => memory > life || memory > fixed_life,
        };
        e.claim(Claim::Told as u32, told);
        e.cover(Cover::Accepted as u32, right);
        e.cover(Cover::Refused as u32, !right);
    }
}

harness! {
    /// As a machine it is its step; it begins with nothing known, which is valid and permits no speed above 0, and its safe
    /// output is no permission, which is the lowest.
    per_machine(e)
    theorem "T-PER-8";
    requirements ["GEN-1", "PER-2"];
    assumptions ["four-speeds"];
    bound "tables of 4 speeds";
    cases 1;
    unwind 33 = 1 + crate::aspect::LONGEST;
    solver kissat;
    claims {
        Step: "the state after a cycle is what was heard made of the one before",
        Permission: "the permission rests on the state after, and the code of the cycle: its basis is that of the telegrams there, and there is a speed where there is one by them",
        Start: "the initial state knows nothing, is valid, and permits no speed above 0, with a code and without",
        Safe: "the safe output is no permission, and not above any other",
    }
    covers {
        Permits: "the machine permits a speed above 0",
    }
    {
        let Some(cycle) = any_cycle(e) else { return };
        let permitted = cycle.line.permitted;
        let (after, permission) = permitted.step(cycle.before, cycle.heard);
        e.claim(Claim::Step as u32, after == cycle.after);
        // What the limits and the speed are is T-PER-5's; here, that the permission is made of the state after.
        let telegrams = match cycle.after.telegrams(&permitted) {
            Telegrams::Fresh(_) => Telegrams::Fresh(KmhTenths(0)),
            Telegrams::Missing(_) => Telegrams::Missing(KmhTenths(0)),
            Telegrams::Lost => Telegrams::Lost,
        };
        let same = Permission::new(cycle.after.line, telegrams, cycle.heard.analog);
        let basis = permission.basis == same.basis && permission.speed.is_some() == same.speed.is_some();
        e.claim(Claim::Permission as u32, basis);
        let start = permitted.initial();
        let unheard = start.main_stream == Stream::EMPTY && start.sub_stream == Stream::EMPTY;
        let knows = start.target.is_some() || start.behind.is_some() || start.fixed != [None; 2] || start.fix.is_some() || !unheard;
        let silent = start.permission(&permitted, cycle.heard.analog).speed <= Some(KmhTenths(0));
        e.claim(Claim::Start as u32, start.is_valid(&permitted) && !knows && silent);
        let safe = Permitted::SAFE == Permission { speed: None, basis: Basis::Nothing };
        e.claim(Claim::Safe as u32, safe && Permitted::SAFE.speed <= permission.speed);
        e.cover(Cover::Permits as u32, permission.speed > Some(KmhTenths(0)));
    }
}

harness! {
    /// A cycle ends from any state, valid or not, and never permits more than the code.
    per_total(e)
    theorem "T-PER-8";
    requirements ["GEN-2"];
    assumptions ["four-speeds"];
    bound "tables of 4 speeds";
    cases 1;
    unwind 33 = 1 + crate::aspect::LONGEST;
    claims {
        Ends: "the cycle ends, and permits no more than the code, if there is one",
    }
    covers {
        Invalid: "the state is none that occurs",
    }
    {
        let Some(line) = any_line(e) else { return };
        let state = any_parts(e);
        let Some(heard) = any_heard(e) else { return };
        let (_, permission) = step(&line.permitted, state, heard);
        e.claim(Claim::Ends as u32, heard.analog.is_none_or(|code| permission.speed <= Some(code)));
        e.cover(Cover::Invalid as u32, !state.is_valid(&line.permitted));
    }
}
