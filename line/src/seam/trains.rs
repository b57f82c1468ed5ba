//! Times, brakes, lengths and gradients: what the ground counts on, against what trains are and do.

use atc_kernel::telegram::Gradient;
use atc_layout::lives::TrainLives;

use super::judged::{Judged, NO_SIGNAL, NO_STATION, NO_TRAIN, count, finding, judged};
use super::sound::Sound;
use crate::blocks::Detection;
use crate::check::{DataCheck, Finding};
use crate::kmh::Kmh;
use crate::line::Line;
use crate::rule::Rule;
use crate::signal::Signal;

pub(super) fn checks(line: &Line) -> Vec<DataCheck> {
    let stations = line.sound();
    let scope = || count(line.stations().len(), "station");
    let routes: usize = stations.iter().map(|one| one.model.routes.len()).sum();
    let circuits: usize = stations.iter().map(|one| one.model.circuits.len()).sum();
    let segments: usize = stations.iter().map(|one| one.model.segments.len()).sum();
    // Of each station: its findings, if what it is held against is there.
    let each = |one: &dyn Fn(Sound<'_>) -> Vec<Finding>| -> Judged {
        if line.stations().is_empty() { Err(NO_STATION) } else { Ok(stations.iter().flat_map(|it| one(*it)).collect()) }
    };
    let with_signal = |one: &dyn Fn(Sound<'_>, &Signal) -> Vec<Finding>| {
        let signal = line.signal().ok_or(NO_SIGNAL)?;
        each(&|station| one(station, signal))
    };
    let with_loss = |one: &dyn Fn(Sound<'_>, u32) -> Vec<Finding>| {
        let train = line.train().ok_or(NO_TRAIN)?;
        each(&|station| one(station, train.shunt_loss_ms))
    };
    vec![
        judged(Rule::TrainBrake, "the brake of the pattern", own_brake(line)),
        judged(Rule::TrainLength, scope(), length(line, &stations)),
        judged(
            Rule::TelegramLives,
            scope(),
            line.lives().ok_or(NO_SIGNAL).and_then(|trains| each(&|one| lives(line, one, trains))),
        ),
        judged(
            Rule::ReleasePromised,
            count(routes, "route"),
            with_signal(&|station, signal| releases(line, station, signal)),
        ),
        judged(
            Rule::TurnPromised,
            count(segments, "segment"),
            with_signal(&|station, signal| turn(line, station, signal)),
        ),
        judged(Rule::Brake, scope(), each(&|station| brake(line, station))),
        judged(Rule::FromTelegrams, scope(), with_signal(&|station, signal| from_telegrams(line, station, signal))),
        judged(Rule::HeardBeyond, scope(), with_signal(&|station, signal| heard_beyond(line, station, signal))),
        judged(Rule::ShuntLoss, scope(), with_loss(&|station, loss| shunt_loss(line, station, loss))),
        judged(Rule::LossWithinClear, scope(), with_loss(&|station, loss| clear(line, station, loss))),
        judged(
            Rule::Gradient,
            count(circuits, "circuit"),
            with_signal(&|station, signal| gradient(line, station, signal)),
        ),
        judged(Rule::SpeedPlausible, scope(), each(&|station| plausible(line, station))),
    ]
}

fn own_brake(line: &Line) -> Judged {
    let (signal, train) = (line.signal().ok_or(NO_SIGNAL)?, line.train().ok_or(NO_TRAIN)?);
    let (pattern, true_brake) = (signal.permitted().settings().brake.mm_s2(), train.brake.mm_s2());
    if pattern <= true_brake {
        return Ok(Vec::new());
    }
    let what = format!("the pattern brakes with {pattern} mm/s², and a train may have only {true_brake}");
    let (at, against) = (line.places().at("signal.brake_mm_s2"), line.places().at("train.brake_mm_s2"));
    Ok(vec![finding(at, against, what, format!("brake_mm_s2 of [signal] must be at most {true_brake}"))])
}

/// The longest train: `[train]` says how long it is; without it the blocks say what they count on.
fn length(line: &Line, stations: &[Sound<'_>]) -> Judged {
    let blocks = line.detection().map(Detection::longest_train);
    let (longest, path) = match (line.train(), blocks) {
        (Some(train), _) => (train.longest, "train.longest_m"),
        (None, _) if line.stations().is_empty() => return Err(NO_STATION),
        (None, Some(longest)) => (longest, "detection.longest_train_m"),
        (None, None) => return Err("nothing says how long trains are"),
    };
    let against = || line.places().at(path);
    let right = format!("longest_train_m must be at least {}", longest.0);
    let mut findings = Vec::new();
    if let Some(counted) = blocks.filter(|counted| *counted < longest) {
        let what = format!("the blocks count on trains of at most {} m, and one is {} m long", counted.0, longest.0);
        findings.push(finding(line.places().at("detection.longest_train_m"), against(), what, right.clone()));
    }
    for one in stations {
        let given = one.station.description().station.longest_train_m.as_ref();
        if given.is_some_and(|given| given.value >= longest.0) {
            continue;
        }
        let said = given.map_or_else(
            || "does not say how long trains are".to_owned(),
            |given| format!("counts on trains of at most {given} m"),
        );
        let at = one.station.at(&given.map_or(0..0, |given| given.span.clone()));
        findings.push(finding(
            at,
            against(),
            format!("{} {said}, and one is {} m long", one.name(), longest.0),
            right.clone(),
        ));
    }
    Ok(findings)
}

fn lives(line: &Line, one: Sound<'_>, trains: TrainLives) -> Vec<Finding> {
    let problem = atc_layout::lives::age(one.station.description(), trains);
    let against = if trains.is_of_codes() { "times.mask_ms" } else { "signal.life_ms" };
    let told = problem.map(|problem| {
        let what = format!("{}: {}", one.name(), problem.what);
        finding(one.station.at(&problem.span), line.places().at(against), what, problem.right)
    });
    let cycle = one.model.values.cycle_ms;
    let slow = line.signal().filter(|signal| !trains.is_of_codes() && u64::from(cycle) > signal.period()).map(|signal| {
        let period = signal.period();
        let what = format!(
            "{}: the ground has new telegrams every {cycle} ms, and trains count on one every {period} ms, in the time of two frames",
            one.name()
        );
        let at = one.station.at(&one.station.description().station.times.cycle_ms.span);
        finding(at, line.places().at("signal.frame_ms"), what, format!("cycle_ms must be at most {period}"))
    });
    told.into_iter().chain(slow).collect()
}

fn releases(line: &Line, one: Sound<'_>, signal: &Signal) -> Vec<Finding> {
    let promised = signal.release_ms();
    let given = &one.station.description().station;
    let routes = one.model.routes.iter().zip(&given.routes);
    let mut findings: Vec<Finding> = Vec::new();
    for (route, form) in routes.filter(|(route, _)| u64::from(one.model.values.ms(route.release)) < promised) {
        let span = form.release_ms.as_ref().map_or(&given.times.release_ms.span, |time| &time.span);
        let at = one.station.at(span);
        // What many routes take from one place is told once.
        if findings.iter().any(|told| told.at == at) {
            continue;
        }
        let what = format!(
            "route {} of {} is released after {} ms, and the line promises its trains {promised} ms",
            route.name,
            one.name(),
            one.model.values.ms(route.release)
        );
        let right = format!("release_ms of the route must be {promised} or more, or that of [signal] less");
        findings.push(finding(at, line.places().at("signal.release_ms"), what, right));
    }
    findings
}

fn turn(line: &Line, one: Sound<'_>, signal: &Signal) -> Vec<Finding> {
    let (values, promised) = (&one.model.values, signal.release_ms());
    let turn = values.ms(values.turn);
    if one.model.segments.is_empty() || u64::from(turn) >= promised {
        return Vec::new();
    }
    let what =
        format!("{} turns its lines after {turn} ms, and the line promises its trains {promised} ms", one.name());
    let right = format!("turn_ms must be {promised} or more, or release_ms of [signal] less");
    vec![finding(one.station.at(&values.turn_ms.span), line.places().at("signal.release_ms"), what, right)]
}

fn brake(line: &Line, one: Sound<'_>) -> Vec<Finding> {
    let pattern = line.signal().map(|signal| (signal.permitted().settings().brake.mm_s2(), "signal.brake_mm_s2"));
    let true_brake = line.train().map(|train| (train.brake.mm_s2(), "train.brake_mm_s2"));
    let counted = &one.station.description().station.braking.deceleration_mm_s2;
    let Some((brakes, path)) = pattern.or(true_brake).filter(|(brakes, _)| *brakes < counted.value) else {
        return Vec::new();
    };
    let what = format!("{} counts on a brake of {counted} mm/s², and trains brake with {brakes}", one.name());
    let right = format!("deceleration_mm_s2 must be at most {brakes}");
    vec![finding(one.station.at(&counted.span), line.places().at(path), what, right)]
}

/// A train that comes from telegrams has the room to stop with the brake of its pattern. If that is stronger than the brake which the distances of the
/// codes hold, it may be so fast that it goes on at a low code too long.
fn from_telegrams(line: &Line, one: Sound<'_>, signal: &Signal) -> Vec<Finding> {
    let (pattern, station) = (signal.permitted().settings().brake.mm_s2(), one.station.description());
    let values = &one.model.values;
    let Some(short) = station.short_code(values, pattern) else { return Vec::new() };
    let braking = &station.station.braking;
    let at = braking.strongest_mm_s2.as_ref().unwrap_or(&braking.deceleration_mm_s2);
    let what = format!(
        "the distance of the code of {short} km/h of {} holds for a brake of {at} mm/s² and weaker, and trains may come from telegrams by a pattern of \
         {pattern}",
        one.name()
    );
    let right = format!("strongest_mm_s2 of [braking] must be at least {pattern}");
    vec![finding(one.station.at(&at.span), line.places().at("signal.brake_mm_s2"), what, right)]
}

/// Codes are on the carriers of the telegrams, and are heard as far beyond a joint.
fn heard_beyond(line: &Line, one: Sound<'_>, signal: &Signal) -> Vec<Finding> {
    let counted = &one.station.description().station.braking.heard_beyond_m;
    let heard = signal.heard_beyond().0;
    if heard <= counted.value {
        return Vec::new();
    }
    let what =
        format!("{} counts on codes that are heard {counted} m beyond their circuits, and it is {heard} m", one.name());
    let right =
        format!("heard_beyond_m of [braking] must be at least {heard}, and the metres from antenna to nose more");
    vec![finding(one.station.at(&counted.span), line.places().at("signal.heard_beyond_exit_m"), what, right)]
}

fn shunt_loss(line: &Line, one: Sound<'_>, loss: u32) -> Vec<Finding> {
    let counted = &one.station.description().station.times.shunt_loss_ms;
    if loss <= counted.value {
        return Vec::new();
    }
    let what = format!(
        "{} counts on a loss of shunt of at most {counted} ms, and a train may be lost for {loss} ms",
        one.name()
    );
    let right = format!("shunt_loss_ms must be at least {loss}");
    vec![finding(one.station.at(&counted.span), line.places().at("train.shunt_loss_ms"), what, right)]
}

fn clear(line: &Line, one: Sound<'_>, loss: u32) -> Vec<Finding> {
    let values = &one.model.values;
    let clear = u32::from(values.clear) * values.cycle_ms;
    let least = loss.saturating_add(2 * values.cycle_ms).max(loss.saturating_mul(2));
    if clear >= least {
        return Vec::new();
    }
    let what =
        format!("in {} a circuit counts as clear after {clear} ms, and a train may be lost for {loss} ms", one.name());
    let right = format!("clear_ms must be at least {least}: twice that, and two cycles of {} ms more", values.cycle_ms);
    let at = one.station.at(&one.station.description().station.times.clear_ms.span);
    vec![finding(at, line.places().at("train.shunt_loss_ms"), what, right)]
}

fn gradient(line: &Line, one: Sound<'_>, signal: &Signal) -> Vec<Finding> {
    let Gradient(worst) = signal.permitted().settings().worst;
    let circuits = one.station.description().station.circuits.iter();
    let steep = circuits.filter_map(|circuit| Some((circuit, circuit.gradient.as_ref()?)));
    steep
        .filter(|(_, gradient)| -i16::from(gradient.value).abs() < i16::from(worst))
        .map(|(circuit, gradient)| {
            let what = format!(
                "circuit {} of {} may fall by {} ‰, and trains assume {worst} ‰",
                circuit.name,
                one.name(),
                i16::from(gradient.value).abs()
            );
            let right = format!("worst_gradient_permille must be at most {}", -i16::from(gradient.value).abs());
            finding(line.places().at("signal.worst_gradient_permille"), one.station.at(&gradient.span), what, right)
        })
        .collect()
}

fn plausible(line: &Line, one: Sound<'_>) -> Vec<Finding> {
    let maximum = line.supervision().maximum();
    let speeds = &one.station.description().station.braking.speeds_kmh;
    let fast = speeds.value.iter().filter(|speed| u32::from(**speed) * 10 > u32::from(maximum.0)).max();
    let told = fast.map(|fast| {
        let what = format!(
            "{} lets trains run at {fast} km/h, and above {} km/h they take a speed to be implausible",
            one.name(),
            Kmh::from(maximum)
        );
        let right = format!("maximum_km_h must be more than {fast}");
        finding(line.places().at("supervision.maximum_km_h"), one.station.at(&speeds.span), what, right)
    });
    told.into_iter().collect()
}
