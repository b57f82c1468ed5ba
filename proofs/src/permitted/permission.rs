//! What is permitted in a state: PER-1, PER-3, PER-5, PER-6, PER-13 to PER-15.

use super::{any_code, any_distance, any_fixed, any_kind, any_line, any_speed, any_state, any_target};
use crate::pattern::{any_brake, any_gradient};
use crate::{Engine, any_flag};
use atc_kernel::distance::{Metres, Millimetres};
use atc_kernel::pattern::{Deceleration, pattern};
use atc_kernel::permitted::{
    Basis, Fixed, Guidance, Limits, LineKind, Permission, Permitted, Settings, State, Target, Telegrams,
};
use atc_kernel::speed::KmhTenths;
use atc_kernel::telegram::Gradient;

harness! {
    /// The lower of code and telegrams is permitted, and each case of PER-1, PER-3, PER-6, PER-13 and PER-14 is as it says. Never more
    /// than the code where one is heard.
    t_per_1(e)
    theorem "T-PER-1";
    requirements ["PER-1", "PER-3", "PER-6", "PER-13", "PER-14"];
    assumptions [];
    bound "";
    cases 1;
    unwind 33 = 1 + crate::aspect::LONGEST;
    claims {
        Lower: "code and fresh telegram: the lower of the two",
        Pattern: "digital line, fresh telegram, no code: the speed by the telegram",
        Analog: "analog line without a fresh telegram: the code",
        RunningDown: "digital line, code, telegrams missing for no longer than the life: the lower of the code and the last pattern",
        Stopped: "the same, missing for longer: a speed of 0",
        Nothing: "no code on a digital line, and no telegram is fresh: no permission",
        NoCode: "no code on an analog line: no permission, whatever there is of telegrams",
        NotAboveCode: "never more than the code, if there is one, nor than a fresh telegram",
    }
    covers {
        Both: "the lower of both is the telegram's",
        Last: "a last pattern is running down below the code",
        Stopped: "stopped",
        Unheard: "an analog line, a fresh telegram and no code",
    }
    {
        let line = any_kind(e, "line (odd: digital)");
        let code = any_code(e);
        let speed = any_speed(e, "speed by the telegrams (0.1 km/h)");
        let telegrams = match e.word("telegrams (0 fresh, 1 missing, else lost)", 0..=2) {
            0 => Telegrams::Fresh(speed),
            1 => Telegrams::Missing(speed),
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
        e.claim(Claim::RunningDown as u32, right(missing, is(code.map(lower), Basis::RunningDown)));
        let lost = digital && code.is_some() && telegrams == Telegrams::Lost;
        e.claim(Claim::Stopped as u32, right(lost, is(Some(KmhTenths(0)), Basis::Nothing)));
        let nothing = right(digital && !fresh && code.is_none(), is(None, Basis::Nothing));
        e.claim(Claim::Nothing as u32, nothing);
        e.claim(Claim::NoCode as u32, right(!digital && code.is_none(), is(None, Basis::Nothing)));
        e.cover(Cover::Unheard as u32, !digital && fresh && code.is_none());
        let below = code.is_none_or(|code| permission.speed <= Some(code)) && (!fresh || permission.speed <= Some(speed));
        e.claim(Claim::NotAboveCode as u32, below);
        e.cover(Cover::Both as u32, fresh && code.is_some() && permission.speed < code);
        e.cover(Cover::Last as u32, missing && permission.speed < code);
        e.cover(Cover::Stopped as u32, lost);
    }
}

/// The gradient and the limit that are known of the target's section.
fn known(fixed: &[Option<Fixed>; 2], target: &Target) -> Option<(Gradient, KmhTenths)> {
    let mut known = None;
    for fixed in fixed.iter().flatten() {
        if fixed.section == target.section {
            known = Some((fixed.gradient, fixed.limit));
        }
    }
    known
}

/// How far away the point of the section behind is, in metres.
const BEHIND_M: u16 = 300;

/// One of four distances, case by case, so that its pattern is constant.
fn any_metres<E: Engine + ?Sized>(e: &mut E) -> u16 {
    match e.choose("distance (0: 0, 1: 1, 2: 100, 3: 3000 m)", 4) {
        0 => 0,
        1 => 1,
        2 => 100,
        _ => 3000,
    }
}

harness! {
    /// Without the sub telegram of the target's section the worst gradient and the lowest limit count, with it its own. The
    /// limits of a target count while it is fresh, and after that as a last pattern until it is forgotten.
    t_per_5(e)
    theorem "T-PER-5";
    requirements ["PER-5", "PER-6"];
    assumptions ["four-speeds"];
    bound "tables of 4 speeds";
    cases 3;
    unwind 33 = 1 + crate::aspect::LONGEST;
    apart [0 1 2];
    claims {
        Worst: "no fixed data of the section: the worst gradient and the lowest limit",
        Known: "fixed data of the section: its own gradient and limit",
        Limits: "what limits the train is that gradient, the distance less the margin, the ground's speed and that limit",
        Kind: "a target not older than the freshness is fresh; an older one is missing",
        None: "without a target telegrams are lost",
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
        let here = state.of_section(target.section);
        let mut known = [false; 2];
        for (slot, fixed) in state.fixed.iter().enumerate() {
            if let Some(fixed) = fixed {
                known[slot] = fixed.section == target.section;
                let own = here.is_some_and(|(gradient, limit)| gradient == fixed.gradient && limit == fixed.limit);
                e.claim(Claim::Known as u32, !known[slot] || own);
            }
        }
        let limits = state.limits(&line.permitted, &target);
        let assumed = here.is_none() && Some(limits.section) == line.speed(line.settings.lowest);
        e.claim(Claim::Worst as u32, known != [false; 2] || assumed);
        e.cover(Cover::Second as u32, known == [false, true]);

        let (gradient, section) = here.unwrap_or((line.settings.worst, limits.section));
        let expected = Limits {
            deceleration: line.settings.brake.on(gradient),
            distance: Millimetres(target.to_stop.0.saturating_sub(u32::from(line.settings.margin.0) * 1000)),
            ground: target.limit,
            section,
        };
        e.claim(Claim::Limits as u32, limits == expected);
        let fresh = target.age.0 <= line.settings.fresh.0;
        // Which limits go with it is `t_per_5_permission`'s.
        let kind = match state.telegrams(&line.permitted) {
            Telegrams::Fresh(_) => fresh,
            Telegrams::Missing(_) => !fresh,
            Telegrams::Lost => false,
        };
        e.claim(Claim::Kind as u32, kind);
        let without = State { target: None, ..state }.telegrams(&line.permitted);
        e.claim(Claim::None as u32, matches!(without, Telegrams::Lost));
        e.cover(Cover::Assumed as u32, known == [false; 2] && fresh);
    }
}

harness! {
    /// The limits by the target of the section behind go with those of the target if and only if nothing is known of its section.
    t_per_5_behind(e)
    theorem "T-PER-5";
    requirements ["PER-15"];
    assumptions ["four-speeds"];
    bound "tables of 4 speeds";
    cases 1;
    unwind 33 = 1 + crate::aspect::LONGEST;
    solver kissat;
    claims {
        Own: "the target's own limits are those of t_per_5",
        Known: "with fixed data of the target's section nothing else counts",
        Behind: "without them, and with a target behind, the limits by that count as well: its point, its ground's speed, and the gradient and the limit of its own section",
    }
    covers {
        Border: "the section behind counts",
        Known: "it does not, though there is one",
    }
    {
        let Some(line) = any_line(e) else { return };
        let target = any_target(e);
        let state = State { target: Some(target), ..any_state(e, &line) };
        let Guidance { own, behind } = state.guidance(&line.permitted, &target);
        e.claim(Claim::Own as u32, own == state.limits(&line.permitted, &target));
        let mut known = false;
        for fixed in state.fixed.iter().flatten() {
            known |= fixed.section == target.section;
        }
        e.claim(Claim::Known as u32, !known || behind.is_none());
        let right = behind == state.behind.map(|target| state.limits(&line.permitted, &target));
        e.claim(Claim::Behind as u32, known || right);
        e.cover(Cover::Border as u32, behind.is_some());
        e.cover(Cover::Known as u32, known && state.behind.is_some());
    }
}

harness! {
    /// Where nothing is known of the section ahead the speed at a border is at most the lowest limit, or what the target of the section behind
    /// permits; and always at most the ground's speed and the pattern to the point of the section ahead. The ghost is the true limit under
    /// the train: that it is not under the limit of the section behind while its target lives is assumed (`limits-reach-over-the-border`).
    t_per_5_border(e)
    theorem "T-PER-5";
    requirements ["PER-15"];
    assumptions ["limits-reach-over-the-border", "sub-data-worst", "printed-sizes"];
    bound "distances of 0, 1, 100 and 3000 m, of 300 m behind a border, one deceleration";
    cases 4;
    unwind 33 = 1 + crate::aspect::LONGEST;
    apart [0 1 2 3];
    claims {
        Own: "never above the target's own pattern, nor above its ground's speed",
        Behind: "above the lowest limit only if a target of the section behind lives, and then not above the speed by it: its pattern, its ground's speed and its section's limit",
        Truth: "never above the true limit, if that is not under the lowest one that is assumed, nor under that of the section behind while its target lives",
        Least: "never below what is permitted without the section behind, so that nothing flaps",
    }
    covers {
        Carried: "the section behind permits more than the lowest limit, and that is permitted",
        Pattern: "the pattern to the point of the section ahead is below that, or the point is 3000 m away and it cannot be",
        Alone: "no section behind",
    }
    {
        let metres = any_metres(e);
        let Some(brake) = Deceleration::brake(1000) else { return };
        let any_limits = |e: &mut E, metres: u16| Limits {
            // What the brake does on a gradient is T-PAT-2's.
            deceleration: brake.on(Gradient(-10)),
            distance: Metres(metres).millimetres(),
            ground: any_speed(e, "ground's speed (0.1 km/h)"),
            section: any_speed(e, "section's limit (0.1 km/h)"),
        };
        let (own, behind) = (any_limits(e, metres), any_limits(e, BEHIND_M));
        let behind = any_flag(e, "a target of the section behind (odd: yes)").then_some(behind);
        let speed = Guidance { own, behind }.speed();
        // That the speed by limits is the least of three is `t_per_5_speed`'s.
        let alone = own.speed();
        let without_limit = Limits { section: KmhTenths(u16::MAX), ..own }.speed();
        let carried = behind.map_or(KmhTenths(0), Limits::speed);
        e.claim(Claim::Own as u32, speed <= without_limit && speed <= own.ground);
        e.claim(Claim::Behind as u32, speed <= own.section || (behind.is_some() && speed <= carried));
        let truth = any_speed(e, "true limit under the train (0.1 km/h)");
        e.suppose("sub-data-worst", truth >= own.section);
        e.suppose("limits-reach-over-the-border", behind.is_none_or(|behind| truth >= behind.section));
        e.claim(Claim::Truth as u32, speed <= truth);
        e.claim(Claim::Least as u32, alone <= speed);
        e.cover(Cover::Carried as u32, speed > own.section && speed == carried);
        e.cover(Cover::Pattern as u32, metres >= 3000 || behind.is_some() && speed < carried && speed < own.ground);
        e.cover(Cover::Alone as u32, behind.is_none());
    }
}

harness! {
    /// What is permitted in a state is what T-PER-1 makes of its line, of the code, and of the speed by its telegrams: the least of the
    /// pattern, the ground's speed and the limit; at a border the limit is the speed by the target of the section behind, if that is
    /// higher. The pattern is that of four distances, behind the border of 300 m.
    t_per_5_permission(e)
    theorem "T-PER-5";
    requirements ["PER-1", "PER-5", "PER-6", "PER-15"];
    assumptions ["four-speeds", "printed-sizes"];
    bound "tables of 4 speeds, distances of 0, 1, 100 and 3000 m, of 300 m behind a border, one deceleration, one margin";
    cases 4;
    unwind 33 = 1 + crate::aspect::LONGEST;
    apart [0 1 2 3];
    claims {
        Whole: "the permission is that of the line, of what there is of telegrams with the speed by them, and of the code",
        Below: "never above the speed by the telegrams, where they are fresh or a last pattern runs down on a digital line",
        Lost: "on a digital line without a target no speed above 0",
    }
    covers {
        Fresh: "the pattern of a fresh target is permitted, or is 0 or over the speeds that are likely",
        Last: "the last pattern is permitted, or is 0 or over the speeds that are likely",
    }
    {
        let metres = any_metres(e);
        let Some(line) = any_line(e) else { return };
        let Some(brake) = Deceleration::brake(1000) else { return };
        // Which gradient counts is `t_per_5`'s.
        let gradient = Gradient(-10);
        let permitted = Permitted::new(Settings { brake, worst: gradient, margin: Metres(10), ..line.settings });
        let Ok(permitted) = permitted else { return e.assume(false) };
        let state = any_state(e, &line);
        // Less than a metre more than the distance and the margin.
        let to_stop = |metres: u16| Millimetres((u32::from(metres) + 10) * 1000 + 999);
        let target = state.target.map(|target| Target { to_stop: to_stop(metres), ..target });
        let behind = state.behind.map(|target| Target { to_stop: to_stop(BEHIND_M), ..target });
        let fixed = state.fixed.map(|fixed| fixed.map(|fixed| Fixed { gradient, ..fixed }));
        let state = State { target, behind, fixed, ..state };
        let code = any_code(e);
        let permission = state.permission(&permitted, code);

        let curve = pattern(brake.on(gradient), Metres(metres));
        let least = |one: KmhTenths, other: KmhTenths| if one < other { one } else { other };
        let limit = |target: &Target| known(&fixed, target).map(|(_, limit)| limit);
        let mut speed = None;
        if let (Some(target), Some(lowest)) = (target, line.speed(line.settings.lowest)) {
            let mut section = limit(&target).unwrap_or(lowest);
            if let (None, Some(behind)) = (limit(&target), behind) {
                let curve = pattern(brake.on(gradient), Metres(BEHIND_M));
                let by_it = least(curve, least(behind.limit, limit(&behind).unwrap_or(lowest)));
                if by_it > section {
                    section = by_it;
                }
            }
            speed = Some(least(curve, least(target.limit, section)));
        }
        let fresh = target.is_some_and(|target| target.age.0 <= line.settings.fresh.0);
        let telegrams = match speed {
            Some(speed) if fresh => Telegrams::Fresh(speed),
            Some(last) => Telegrams::Missing(last),
            None => Telegrams::Lost,
        };
        e.claim(Claim::Whole as u32, permission == Permission::new(state.line, telegrams, code));
        let digital = state.line == LineKind::Digital;
        let counts = fresh || digital;
        e.claim(Claim::Below as u32, speed.is_none() || !counts || permission.speed <= speed);
        let lost = digital && target.is_none();
        e.claim(Claim::Lost as u32, !lost || permission.speed <= Some(KmhTenths(0)));
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
    assumptions ["printed-sizes"];
    bound "distances up to 67 km";
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
        let distance = Millimetres(any_distance(e, "distance (65 536 mm, mm)").0 & 0x3FF_FFFF);
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
