//! Rules of the station as a whole: times, detectors, segments, circuits that foul each other.

use std::collections::BTreeSet;

use atc_kernel::time::Ticks;

use crate::form::Station;
use crate::model::{Model, Route};
use crate::problem::Problem;
use crate::rule::Rule;

/// The rules that no single route breaks.
pub fn check(station: &Station, model: &Model, problems: &mut Vec<Problem>) {
    let times = &station.times;
    let values = &model.values;
    let clear = values.ms(Ticks(values.clear.into()));
    if clear <= times.shunt_loss_ms.value {
        let what = format!(
            "a circuit counts as clear after {clear} ms, but a shunt may be lost for {} ms",
            times.shunt_loss_ms
        );
        let right = format!("clear_ms must be more than {}", times.shunt_loss_ms);
        problems.push(Problem::new(Rule::ClearUnderShunt, &times.clear_ms.span, what, right));
    }
    let (turn, least) = (values.ms(values.turn), values.least_turn_ms);
    if turn <= times.telegram_age_ms.value {
        let what =
            format!("plain line turns after {turn} ms, but trains act on telegrams of {} ms", times.telegram_age_ms);
        let right = format!("turn_ms must be more than {}", times.telegram_age_ms);
        problems.push(Problem::new(Rule::TurnUnderTelegram, &values.turn_ms.span, what, right));
    } else if turn < least {
        let what = format!(
            "plain line turns and blocks on it are confirmed after {turn} ms, but a train that was sent may run in for {least} ms: a telegram \
             lives for {} ms, the train runs on for {} ms, and may be lost for {} ms",
            times.telegram_age_ms, values.residual_ms, times.shunt_loss_ms
        );
        let right = format!("turn_ms must be at least {least}, or be left out");
        problems.push(Problem::new(Rule::TurnUnderRun, &values.turn_ms.span, what, right));
    }
    let longest = model.longest_authority();
    if model.values.start < longest && times.start_protected.is_none() {
        let (start, longest) = (values.ms(values.start), values.ms(longest));
        let what =
            format!("after a start nothing moves for {start} ms, but a train may count on a route for {longest} ms");
        let right = format!("start_ms must be at least {longest}, or start_protected say why every train stands");
        problems.push(Problem::new(Rule::StartTooShort, &model.values.start_ms.span, what, right));
    }
    let (residual, least) = (&model.values.residual_ms, model.values.least_residual_ms);
    if residual.value < least {
        let what = format!(
            "a train runs on for {residual} ms after its authority is taken, but a telegram lives and a brake takes {least} ms"
        );
        let right = format!("residual_ms must be at least {least}");
        problems.push(Problem::new(Rule::ResidualTooShort, &residual.span, what, right));
    }
    detectors(station, model, problems);
    segments(station, model, problems);
    fouling(station, model, problems);
}

fn detectors(station: &Station, model: &Model, problems: &mut Vec<Problem>) {
    for (given, point) in station.points.iter().zip(&model.points) {
        let needed: BTreeSet<usize> = point.fouled_in.iter().copied().chain(point.circuit).collect();
        for missing in needed.difference(&point.detectors) {
            let name = &model.circuits[*missing].name;
            let what =
                format!("point {} is not detected by {name}, where a train stands on it or fouls it", point.name);
            let span =
                given.detectors.as_ref().and_then(|named| named.first()).map_or(&point.span, |first| &first.span);
            problems.push(Problem::new(Rule::DetectorsIncomplete, span, what, format!("add {name} to its detectors")));
        }
    }
}

fn segments(station: &Station, model: &Model, problems: &mut Vec<Problem>) {
    for (given, segment) in station.segments.iter().zip(&model.segments) {
        let order: Vec<usize> = segment.throat.into_iter().chain(segment.circuits.iter().copied()).collect();
        for (place, pair) in order.windows(2).enumerate() {
            if !model.graph.between(pair[0], pair[1]).is_empty() {
                continue;
            }
            let (one, other) = (&model.circuits[pair[0]].name, &model.circuits[pair[1]].name);
            let what = format!("segment {}: {other} does not adjoin {one}", segment.name);
            let skipped = usize::from(segment.throat.is_some());
            let span =
                given.circuits.get((place + 1).saturating_sub(skipped)).map_or(&segment.span, |named| &named.span);
            problems.push(Problem::new(Rule::SegmentOrder, span, what, "name the circuits outward from the station"));
        }
    }
}

fn fouling(station: &Station, model: &Model, problems: &mut Vec<Problem>) {
    for (given, (one, other)) in station.fouling.iter().zip(&model.fouling) {
        let on = |circuit: usize| model.routes.iter().enumerate().filter(move |(_, route)| holds(route, circuit));
        for (number, route) in on(*one) {
            for (number_of_other, against) in on(*other) {
                if number == number_of_other || exclude(model, (number, route), (number_of_other, against)) {
                    continue;
                }
                let (here, there) = (&model.circuits[*one].name, &model.circuits[*other].name);
                let what = format!(
                    "routes {} over {here} and {} over {there} can be set together, and the circuits foul each other",
                    route.name, against.name
                );
                let span =
                    if station.routes[number].conflicts.is_empty() { &given.between[0].span } else { &route.span };
                let right =
                    format!("add conflicts = [{:?}] to {}, and the same the other way", against.name, route.name);
                problems.push(Problem::new(Rule::FoulingUndeclared, span, what, right));
            }
        }
    }
}

fn holds(route: &Route, circuit: usize) -> bool {
    route.circuits().any(|held| held == circuit) || route.overlap.contains(&circuit)
}

/// Whether the kernel never holds the two routes together from their first circuit to their overlap.
fn exclude(model: &Model, (one, a): (usize, &Route), (other, b): (usize, &Route)) -> bool {
    let declared = model.routes[one].conflicts.contains(&other);
    let circuit =
        a.circuits().any(|circuit| holds(b, circuit)) || b.circuits().any(|circuit| a.overlap.contains(&circuit));
    let overlaps = a.overlap.iter().any(|circuit| b.overlap.contains(circuit));
    let point =
        a.positions().any(|(point, position)| b.positions().any(|(same, in_it)| same == point && in_it != position));
    let through = a.continuing.contains(&other) || b.continuing.contains(&one);
    declared || point || (circuit || overlaps) && !through
}
