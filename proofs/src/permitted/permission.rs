//! What is permitted in a state: PER-1, PER-3, PER-5, PER-6.

use super::{any_code, any_distance, any_fixed, any_kind, any_line, any_speed, any_state, any_target};
use crate::any_flag;
use crate::pattern::{any_brake, any_gradient};
use atc_kernel::distance::{Metres, Millimetres};
use atc_kernel::pattern::{Deceleration, pattern};
use atc_kernel::permitted::{
    Basis, Fixed, Limits, LineKind, Permission, Permitted, Settings, State, Target, Telegrams,
};
use atc_kernel::speed::KmhTenths;
use atc_kernel::telegram::Gradient;

harness! {
    /// The lower of code and telegrams is permitted, and each case of PER-1, PER-3 and PER-6 is as it says. Never more than the
    /// code where one is heard.
    t_per_1(e)
    theorem "T-PER-1";
    requirements ["PER-1", "PER-3", "PER-6"];
    assumptions [];
    bound "";
    cases 1;
    unwind 33 = 1 + crate::aspect::LONGEST;
    claims {
        Lower: "code and fresh telegram: the lower of the two",
        Pattern: "digital line, fresh telegram, no code: the speed by the telegram",
        Analog: "analog line without a fresh telegram: the code",
        RunningDown: "digital line, code, telegrams missing for no longer than the life: the code, or the last pattern if there is one and it is lower",
        Stopped: "the same, missing for longer: a speed of 0",
        Nothing: "no code, and the line is analog or no telegram is fresh: no permission",
        NotAboveCode: "never more than the code, if there is one, nor than a fresh telegram",
    }
    covers {
        Both: "the lower of both is the telegram's",
        Last: "a last pattern is running down below the code",
        Stopped: "stopped",
    }
    {
        let line = any_kind(e, "line (odd: digital)");
        let code = any_code(e);
        let speed = any_speed(e, "speed by the telegrams (0.1 km/h)");
        let last = any_flag(e, "a last pattern (odd: yes)");
        let telegrams = match e.word("telegrams (0 fresh, 1 missing, else lost)", 0..=2) {
            0 => Telegrams::Fresh(speed),
            1 => Telegrams::Missing(last.then_some(speed)),
            _ => Telegrams::Lost,
        };
        let permission = Permission::new(line, telegrams, code);
        let fresh = telegrams == Telegrams::Fresh(speed);
        let lower = |code: KmhTenths| if speed < code { speed } else { code };
        let is = |speed, basis| permission == Permission { speed, basis };
        let digital = line == LineKind::Digital;
        let right = |applies: bool, right: bool| !applies || right;
        e.claim(Claim::Lower as u32, right(fresh && code.is_some(), is(code.map(lower), Basis::Both)));
        e.claim(Claim::Pattern as u32, right(digital && fresh && code.is_none(), is(Some(speed), Basis::Pattern)));
        e.claim(Claim::Analog as u32, right(!digital && !fresh && code.is_some(), is(code, Basis::Analog)));
        let missing = digital && code.is_some() && matches!(telegrams, Telegrams::Missing(_));
        let running = if last { code.map(lower) } else { code };
        e.claim(Claim::RunningDown as u32, right(missing, is(running, Basis::RunningDown)));
        let lost = digital && code.is_some() && telegrams == Telegrams::Lost;
        e.claim(Claim::Stopped as u32, right(lost, is(Some(KmhTenths(0)), Basis::Nothing)));
        let nothing = code.is_none() && (!digital || !fresh);
        e.claim(Claim::Nothing as u32, right(nothing, is(None, Basis::Nothing)));
        let below = code.is_none_or(|code| permission.speed <= Some(code)) && (!fresh || permission.speed <= Some(speed));
        e.claim(Claim::NotAboveCode as u32, below);
        e.cover(Cover::Both as u32, fresh && code.is_some() && permission.speed < code);
        e.cover(Cover::Last as u32, missing && permission.speed < code);
        e.cover(Cover::Stopped as u32, lost);
    }
}

harness! {
    /// Without the sub telegram of the target's section the worst gradient and the lowest limit count, with it its own. The
    /// limits of a target count while it is fresh, and as a last pattern while telegrams are missing for no longer than the life.
    t_per_5(e)
    theorem "T-PER-5";
    requirements ["PER-5", "PER-6"];
    assumptions ["four-speeds", "sub-data-worst"];
    bound "tables of 4 speeds";
    cases 3;
    unwind 33 = 1 + crate::aspect::LONGEST;
    apart [0 1 2];
    claims {
        Worst: "no fixed data of the section: the worst gradient and the lowest limit",
        Known: "fixed data of the section: its own gradient and limit",
        Limits: "what limits the train is that gradient, the distance less the margin, the ground's speed and that limit",
        Kind: "a target not older than the freshness is fresh; otherwise telegrams are missing, and lost once they are missing for longer than the life",
        None: "without a target they are missing, or lost",
    }
    covers {
        Assumed: "the worst is assumed, and the target is fresh",
        Second: "the fixed data of the section are not the newest",
    }
    {
        let Some(line) = any_line(e) else { return };
        let target = any_target(e);
        let mut state = State { target: Some(target), ..any_state(e, &line) };
        // Case by case, so that what is selected is a constant choice: none, the newest, or the other.
        match e.choose("fixed data of the target's section", 3) {
            0 => e.assume(state.fixed.iter().flatten().all(|fixed| fixed.section != target.section)),
            1 => state.fixed[0] = Some(Fixed { section: target.section, ..any_fixed(e) }),
            _ => state.fixed[1] = Some(Fixed { section: target.section, ..any_fixed(e) }),
        }
        e.assume(state.is_valid(&line.permitted));
        let (gradient, limit) = state.of_section(&line.permitted, target.section);
        let mut known = [false; 2];
        for (slot, fixed) in state.fixed.iter().enumerate() {
            if let Some(fixed) = fixed {
                known[slot] = fixed.section == target.section;
                let own = gradient == fixed.gradient && limit == fixed.limit;
                e.claim(Claim::Known as u32, !known[slot] || own);
            }
        }
        let assumed = gradient == line.settings.worst && Some(limit) == line.speed(line.settings.lowest);
        e.claim(Claim::Worst as u32, known != [false; 2] || assumed);
        e.cover(Cover::Second as u32, known == [false, true]);

        let limits = state.limits(&line.permitted, &target);
        let expected = Limits {
            deceleration: line.settings.brake.on(gradient),
            distance: Millimetres(target.to_stop.0.saturating_sub(u32::from(line.settings.margin.0) * 1000)),
            ground: target.limit,
            section: limit,
        };
        e.claim(Claim::Limits as u32, limits == expected);
        let fresh = target.age.0 <= line.settings.fresh.0;
        let short = state.missing.0 <= line.settings.life.0;
        let expected = match (fresh, short) {
            (true, _) => Telegrams::Fresh(limits),
            (false, true) => Telegrams::Missing(Some(limits)),
            (false, false) => Telegrams::Lost,
        };
        e.claim(Claim::Kind as u32, state.telegrams(&line.permitted) == expected);
        let without = if short { Telegrams::Missing(None) } else { Telegrams::Lost };
        e.claim(Claim::None as u32, State { target: None, ..state }.telegrams(&line.permitted) == without);
        e.cover(Cover::Assumed as u32, known == [false; 2] && fresh);
    }
}

harness! {
    /// What is permitted in a state is what T-PER-1 makes of its line, of the code, and of the speed by its telegrams: the least of the
    /// pattern, the ground's speed and the limit. The pattern is that of four distances.
    t_per_5_permission(e)
    theorem "T-PER-5";
    requirements ["PER-1", "PER-5", "PER-6"];
    assumptions ["four-speeds", "printed-sizes"];
    bound "tables of 4 speeds, distances of 0, 1, 100 and 3000 m";
    cases 4;
    unwind 33 = 1 + crate::aspect::LONGEST;
    apart [0 1 2 3];
    claims {
        Whole: "the permission is that of the line, of what there is of telegrams with the speed by them, and of the code",
        Below: "never above the speed by the telegrams, where they are fresh or a last pattern runs down on a digital line",
    }
    covers {
        Fresh: "the pattern of a fresh target is permitted, or is 0 or over the speeds that are likely",
        Last: "the last pattern is permitted, or is 0 or over the speeds that are likely",
    }
    {
        let metres: u16 = match e.choose("distance (0: 0, 1: 1, 2: 100, 3: 3000 m)", 4) {
            0 => 0,
            1 => 1,
            2 => 100,
            _ => 3000,
        };
        let Some(line) = any_line(e) else { return };
        let Some(brake) = Deceleration::brake(1000) else { return };
        // Which gradient counts is `t_per_5`'s.
        let gradient = Gradient(-10);
        let permitted = Permitted::new(Settings { brake, worst: gradient, margin: Metres(10), ..line.settings });
        let Ok(permitted) = permitted else { return e.assume(false) };
        let state = any_state(e, &line);
        // Less than a metre more than the distance and the margin.
        let to_stop = Millimetres((u32::from(metres) + 10) * 1000 + 999);
        let target = state.target.map(|target| Target { to_stop, ..target });
        let fixed = state.fixed.map(|fixed| fixed.map(|fixed| Fixed { gradient, ..fixed }));
        let state = State { target, fixed, ..state };
        let code = any_code(e);
        let permission = state.permission(&permitted, code);

        let curve = pattern(brake.on(gradient), Metres(metres));
        let least = |one: KmhTenths, other: KmhTenths| if one < other { one } else { other };
        let mut speed = None;
        if let Some(target) = target {
            let mut limit = line.speed(line.settings.lowest);
            for fixed in fixed.into_iter().flatten() {
                if fixed.section == target.section {
                    limit = Some(fixed.limit);
                }
            }
            speed = limit.map(|limit| least(curve, least(target.limit, limit)));
        }
        let fresh = target.is_some_and(|target| target.age.0 <= line.settings.fresh.0);
        let telegrams = match speed {
            Some(speed) if fresh => Telegrams::Fresh(speed),
            last if state.missing.0 <= line.settings.life.0 => Telegrams::Missing(last),
            _ => Telegrams::Lost,
        };
        e.claim(Claim::Whole as u32, permission == Permission::new(state.line, telegrams, code));
        let counts = fresh || state.line == LineKind::Digital && state.missing.0 <= line.settings.life.0;
        e.claim(Claim::Below as u32, speed.is_none() || !counts || permission.speed <= speed);
        let extreme = metres == 0 || metres == 3000;
        let by_pattern = extreme || speed == Some(curve);
        e.cover(Cover::Fresh as u32, fresh && by_pattern && permission.speed == speed);
        e.cover(Cover::Last as u32, !fresh && speed.is_some() && by_pattern && permission.speed == speed);
    }
}

harness! {
    /// The speed by the telegrams is the least of the pattern, the ground's speed and the section's limit.
    t_per_5_speed(e)
    theorem "T-PER-5";
    requirements ["PER-5"];
    assumptions [];
    bound "";
    cases 1;
    unwind 33 = 1 + crate::aspect::LONGEST;
    solver kissat;
    claims {
        Least: "not above any of the three, the pattern being over the whole metres of the distance, and one of them",
    }
    covers {
        Pattern: "the pattern is below the other two",
        Ground: "the ground's speed is",
        Section: "the section's limit is",
    }
    {
        let Some(brake) = any_brake(e) else { return };
        let deceleration = brake.on(any_gradient(e, "gradient (‰, two's complement)"));
        let distance = any_distance(e, "distance (1024 mm, mm)");
        let (ground, section) = (any_speed(e, "ground's speed (0.1 km/h)"), any_speed(e, "section's limit (0.1 km/h)"));
        // That metres are rounded down is T-PER-4's, what the pattern is T-PAT-1's.
        let curve = pattern(deceleration, distance.whole_metres());
        let speed = Limits { deceleration, distance, ground, section }.speed();
        let least = speed <= curve && speed <= ground && speed <= section;
        e.claim(Claim::Least as u32, least && (speed == curve || speed == ground || speed == section));
        e.cover(Cover::Pattern as u32, curve < ground && curve < section);
        e.cover(Cover::Ground as u32, ground < curve && ground < section);
        e.cover(Cover::Section as u32, section < curve && section < ground);
    }
}
