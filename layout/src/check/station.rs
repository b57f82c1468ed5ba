//! Rules of the station as a whole: times, detectors, segments, circuits that foul each other.

use std::collections::BTreeSet;
use std::ops::Range;

use atc_kernel::time::Ticks;

use super::routes::protection;
use crate::derive::way::of_segment;
use crate::form::{EndKind, Station};
use crate::graph::{Kind, Passed};
use crate::model::{Model, Route, Segment};
use crate::problem::Problem;
use crate::rule::Rule;

/// The rules that no single route breaks.
pub fn check(station: &Station, model: &Model, problems: &mut Vec<Problem>) {
    let times = &station.times;
    let values = &model.values;
    let clear = values.ms(Ticks(values.clear.into()));
    let least = times.shunt_loss_ms.value.saturating_mul(2);
    if clear < least {
        let what = format!(
            "a circuit counts as clear after {clear} ms, but a shunt may be lost for {} ms, at a joint in one circuit after the other",
            times.shunt_loss_ms
        );
        let right = format!("clear_ms must be at least {least}");
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
    standing(model, problems);
    lengths(station, model, problems);
    detectors(station, model, problems);
    segments(station, model, problems);
    fouling(station, model, problems);
    twice(model, problems);
    signals(model, problems);
}

/// What is held beyond the end of a route is given up when its train stands. So early it cannot stand.
fn standing(model: &Model, problems: &mut Vec<Problem>) {
    let (values, least) = (&model.values, model.longest_standstill_ms());
    let given = values.ms(values.standstill);
    let slowest = model.routes.iter().find(|route| model.least_standstill_ms(route) == Some(least));
    if let (Some(route), true) = (slowest, given < least) {
        let last = route.last().and_then(|last| model.circuits.get(last));
        let (name, length) = last.map_or(("", 0), |last| (last.name.as_str(), last.length.0));
        let kmh = values.speeds_kmh[usize::from(route.speed.0)];
        let what = format!(
            "a train counts as standing {given} ms after it has come into the last circuit of its route; in {name} of {length} m, the last of route {}, \
             one that comes at {kmh} km/h stands after {least} ms at the soonest",
            route.name
        );
        let right = format!("standstill_ms must be at least {least}, and longer for slower trains, or be left out");
        problems.push(Problem::new(Rule::StandstillTooShort, &values.standstill_ms.span, what, right));
    }
}

/// A train that runs through a whole circuit while it is lost, or between two cycles, is never reported there: routes wait for it, and it
/// may be in no circuit at all.
fn lengths(station: &Station, model: &Model, problems: &mut Vec<Problem>) {
    let (values, loss) = (&model.values, &station.times.shunt_loss_ms);
    let unseen = loss.value.max(values.cycle_ms);
    let shortest = station.shortest_train_m.as_ref().map_or(0, |length| u64::from(length.value));
    for (number, circuit) in model.circuits.iter().enumerate() {
        let over = |route: &&Route| route.is_sound() && route.path.iter().any(|place| place.circuit == number);
        let routes = model.routes.iter().filter(over).map(|route| route.speed);
        let lines = model.segments.iter().filter(|segment| segment.circuits.contains(&number));
        let fastest = routes.chain(lines.map(|segment| segment.speed)).max();
        let kmh = fastest.map_or(0, |code| values.speeds_kmh[usize::from(code.0)]);
        // In m: km/h times ms is 3600 of them.
        let run = u64::from(kmh) * u64::from(unseen) / 3600;
        let (length, given) = (u64::from(circuit.length.0), circuit.length.0 > 0);
        if given && length + shortest <= run {
            let what = format!(
                "{} is {length} m long, and at {kmh} km/h a train runs {run} m in the {unseen} ms for which it may not be reported",
                circuit.name
            );
            let right = format!(
                "a circuit and the shortest train must be longer together: give shortest_train_m (at least {}), or a shorter time",
                run + 1 - length
            );
            problems.push(Problem::new(Rule::CircuitTooShort, &circuit.span, what, right));
        }
    }
}

/// A train may come in wherever the line goes on unseen. Only on a segment does the kernel ask whose trains may be under way before it sends
/// one, or confirms a block.
pub fn lines(station: &Station, model: &Model, problems: &mut Vec<Problem>) {
    for (number, joint) in model.graph.joints.iter().enumerate() {
        let last = model.graph.circuits_at(number).next();
        let ends_here = |segment: &Segment| last.is_some() && ends_at(model, segment, number);
        // What a leg of a point leads off to is held against the flank protection of the routes over the other one, unless a
        // route leads out over it.
        let passed = |point: usize| {
            let over =
                |route: &Route| route.path.iter().flat_map(|place| &place.passed).any(|passed| passed.point == point);
            model.routes.iter().any(over)
        };
        let is_flank = |track: &usize| {
            let track = &model.graph.tracks[*track];
            // A point in a segment breaks a rule of its own.
            let in_segment = model.segments.iter().any(|segment| segment.circuits.contains(&track.circuit));
            matches!(track.kind, Kind::Point(point) if in_segment || passed(point) && track.joints.first() != Some(&number))
        };
        let led_to = model.routes.iter().any(|route| route.is_sound() && route.exit == number);
        let off = !led_to && joint.tracks.iter().any(is_flank);
        if joint.end != Some(EndKind::Line) || off || model.segments.iter().any(ends_here) {
            continue;
        }
        let given = station.ends.iter().find(|end| end.joint.value == joint.name);
        let span = given.map_or(&joint.span, |end| &end.joint.span);
        let circuit = last.map_or("", |last| model.circuits.get(last).map_or("", |circuit| circuit.name.as_str()));
        let what = format!(
            "the line goes on at {}, and {circuit} there is not the outermost circuit of a segment: a train may come in while a block is confirmed \
             or another train is sent",
            joint.name
        );
        let right = "list the circuits from the station to there in a [[segment]], or declare the end as a buffer";
        problems.push(Problem::new(Rule::LineWithoutSegment, span, what, right));
    }
    // It follows from most of what is wrong with a segment.
    if problems.is_empty() {
        beyond_segments(station, model, problems);
    }
}

/// Beyond a segment is the neighbour's: what lies there is neither held nor asked for when a train is sent, and a point there
/// may be driven.
fn beyond_segments(station: &Station, model: &Model, problems: &mut Vec<Problem>) {
    for (given, segment) in station.segments.iter().zip(&model.segments) {
        let is_line = |joint: usize| model.graph.joints[joint].end == Some(EndKind::Line);
        let Some(last) = segment.circuits.last() else { continue };
        if (0..model.graph.joints.len()).any(|joint| is_line(joint) && ends_at(model, segment, joint)) {
            continue;
        }
        let (span, last) =
            (given.circuits.last().map_or(&segment.span, |named| &named.span), &model.circuits[*last].name);
        let what =
            format!("segment {}: {last} is its outermost circuit, and the line does not end there", segment.name);
        let right = "name the circuits as far as the end of kind \"line\"; a point out there is a station of its own";
        problems.push(Problem::new(Rule::SegmentOrder, span, what, right));
    }
}

/// Whether the track of a segment that comes from the station ends at this joint: not another one that crosses it in its
/// outermost circuit.
fn ends_at(model: &Model, segment: &Segment, joint: usize) -> bool {
    let Some((last, inner)) = segment.circuits.split_last() else { return false };
    let comes_from = inner.last().copied().or(segment.throat);
    model.graph.joints[joint].tracks.iter().map(|track| &model.graph.tracks[*track]).any(|track| {
        let other = track.joints.iter().find(|other| **other != joint);
        let before = other.and_then(|other| model.graph.across(*other, *last));
        track.kind == Kind::Plain
            && track.circuit == *last
            && before.is_some()
            && (comes_from.is_none() || before == comes_from)
    })
}

/// Two routes of one signal and one path are one route with two names, or the way of one of them is not the one that was meant.
fn twice(model: &Model, problems: &mut Vec<Problem>) {
    let way = |route: &Route| -> (usize, Vec<usize>, Vec<Passed>) {
        let passed = route.path.iter().flat_map(|place| place.passed.iter().copied());
        (route.start, route.circuits().collect(), passed.collect())
    };
    for (number, route) in model.routes.iter().enumerate().filter(|(_, route)| route.is_sound()) {
        let same = |other: &&Route| other.is_sound() && way(other) == way(route) && other.overlap == route.overlap;
        if let Some(other) = model.routes[..number].iter().find(same) {
            let what = format!("routes {} and {} lead from one signal over one path", other.name, route.name);
            problems.push(Problem::new(Rule::RouteTwice, &route.span, what, "leave one out, or mend its path"));
        }
    }
}

/// Two places under one name: whoever commands or reads the one may mean the other.
fn signals(model: &Model, problems: &mut Vec<Problem>) {
    for (number, route) in model.routes.iter().enumerate().filter(|(_, route)| route.is_sound()) {
        let elsewhere = |other: &&Route| {
            other.is_sound() && other.signal == route.signal && (other.start, other.entry) != (route.start, route.entry)
        };
        if let Some(other) = model.routes[..number].iter().find(elsewhere) {
            let place = |route: &Route| {
                let (entry, joint) = (&model.circuits[route.entry].name, &model.graph.joints[route.start].name);
                format!("at joint {joint}, the end of {entry} (route {})", route.name)
            };
            let what = format!("signal {} stands {} and {}", route.signal, place(other), place(route));
            problems.push(Problem::new(Rule::NameTwice, &route.span, what, "give one of them another signal = \"…\""));
        }
    }
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
    let name = |circuit: usize| model.circuits[circuit].name.clone();
    for (given, segment) in station.segments.iter().zip(&model.segments) {
        let span = |place: usize| given.circuits.get(place).map_or(&segment.span, |named| &named.span);
        let order: Vec<usize> = segment.throat.into_iter().chain(segment.circuits.iter().copied()).collect();
        let skipped = usize::from(segment.throat.is_some());
        let apart = order.windows(2).position(|pair| model.graph.between(pair[0], pair[1]).is_empty());
        if let Some(place) = apart {
            let (one, other) = (name(order[place]), name(order[place + 1]));
            let what = format!("segment {}: {other} does not adjoin {one}", segment.name);
            let right = "name the circuits outward from the station";
            problems.push(Problem::new(Rule::SegmentOrder, span((place + 1).saturating_sub(skipped)), what, right));
            continue;
        }
        // A train must be able to run through all of them: over a crossing the tracks lead elsewhere.
        let spans: Vec<Range<usize>> = given.circuits.iter().map(|named| named.span.clone()).collect();
        let right = "name the circuits along one track";
        match of_segment(model, segment, &spans) {
            Ok(ways) if ways.is_empty() => {}
            Err(problem) => {
                let what = format!("segment {}: {}", segment.name, problem.what);
                problems.push(Problem::new(Rule::SegmentOrder, &problem.span, what, right));
            }
            Ok(ways) if ways.iter().all(|way| model.graph.joints[way.exit()].end == Some(EndKind::Buffer)) => {
                let what = format!("segment {}: its tracks lead to a buffer stop", segment.name);
                problems.push(Problem::new(Rule::SegmentOrder, &segment.span, what, right));
            }
            Ok(_) => {
                let who = format!("segment {}", segment.name);
                for flank in &segment.flanks {
                    protection(model, flank, &who, &segment.span, &|_, _| false, problems);
                }
            }
        }
    }
}

/// A route over one of two circuits that foul each other proves the other clear, and keeps other routes from it. That keeps trains apart only where no
/// train comes into either of them without a route.
fn fouling(station: &Station, model: &Model, problems: &mut Vec<Problem>) {
    let mut tell = |found: Option<(String, &'static str)>, (one, other): (usize, usize), span: &Range<usize>| {
        if let Some((why, right)) = found {
            let [one, other] = [one, other].map(|circuit| &model.circuits[circuit].name);
            let what = format!("{one} and {other} foul each other, and {why}");
            problems.push(Problem::new(Rule::FoulingNotHeld, span, what, right));
        }
    };
    for (given, pair) in station.fouling.iter().zip(&model.fouling) {
        tell(unkept(model, *pair).or_else(|| unsaid(model, *pair)), *pair, &given.between[0].span);
    }
    for (given, point) in station.points.iter().zip(&model.points) {
        let Some(own) = point.circuit else { continue };
        let named = given.fouled_in.first().or_else(|| given.detectors.as_ref().and_then(|named| named.first()));
        let span = named.map_or(&point.span, |named| &named.span);
        for beside in point.detectors.iter().filter(|circuit| **circuit != own) {
            tell(unkept(model, (own, *beside)), (own, *beside), span);
        }
    }
}

/// Why two circuits that foul each other cannot be kept apart, and what would be right.
fn unkept(model: &Model, (one, other): (usize, usize)) -> Option<(String, &'static str)> {
    let name = |circuit: usize| &model.circuits[circuit].name;
    let on_line = |circuit: &usize| model.segments.iter().any(|segment| segment.circuits.contains(circuit));
    let held = |circuit: &usize| model.routes.iter().any(|route| route.circuits().any(|over| over == *circuit));
    let pair = [one, other];
    let loose = match (pair.iter().find(|it| on_line(it)), pair.iter().find(|it| !held(it))) {
        (Some(line), _) => Some(format!("{} is plain line", name(*line))),
        (None, Some(loose)) => Some(format!("no route runs over {}", name(*loose))),
        (None, None) => None,
    };
    if let Some(why) = loose {
        let right = "move the joint beyond the fouling point, or let routes run over both";
        return Some((format!("{why}: trains come there without a route, and nothing keeps them apart"), right));
    }
    let found = model.routes.iter().filter(|route| route.is_sound()).find_map(|route| {
        let why = uncovered(model, route, (one, other)).or_else(|| uncovered(model, route, (other, one)))?;
        Some(format!("route {}: {why}", route.name))
    });
    found.map(|why| (why, "move the joint beyond the fouling point, or make circuits one"))
}

/// Why the plan has nothing of it that the one is beside the other.
fn unsaid(model: &Model, (one, other): (usize, usize)) -> Option<(String, &'static str)> {
    let said = model.routes.iter().any(|route| {
        let overlap = route.overlap.iter().map(|over| (*over, &route.overlap_beside));
        let mut places = route.path.iter().map(|place| (place.circuit, &place.beside)).chain(overlap);
        places.any(|(over, beside)| over == one && beside.contains(&other) || over == other && beside.contains(&one))
    });
    let why = "every route over the one holds the other: nothing keeps a block on the one from a train in the other";
    (!said).then(|| (why.to_owned(), "make them one circuit"))
}

/// Why a train of the route, or on its way to the signal, may come into `one` while somebody is in `other`, or waits there for itself. Where it has
/// both before it, it must be in one of them all the time: then its occupation speaks for it.
fn uncovered(model: &Model, route: &Route, (one, other): (usize, usize)) -> Option<String> {
    let name = |circuit: usize| &model.circuits[circuit].name;
    let order: Vec<usize> =
        [route.entry].into_iter().chain(route.circuits()).chain(route.overlap.iter().copied()).collect();
    let at = |circuit: usize| order.iter().position(|held| *held == circuit);
    let apart = at(one).zip(at(other)).filter(|(first, second)| first.abs_diff(*second) > 1);
    if let Some((first, second)) = apart {
        let between = name(order[first.min(second) + 1]);
        return Some(format!("its train has both before it, and is in neither while it is in {between}"));
    }
    if model.values.cab_signalled || !route.approach.contains(&one) || route.approach.contains(&other) {
        return None;
    }
    let entry = one == route.entry;
    if at(other).is_some() {
        let stuck = format!("a train that reaches back to {} keeps itself from its own way", name(one));
        return (!entry).then_some(stuck);
    }
    // From farther behind a driver comes over it by the signal ahead. At the far end of the approach he has stood in it before.
    let behind = route.approach.iter().filter(|circuit| !model.graph.between(one, **circuit).is_empty()).count();
    let passed = behind > usize::from(!entry);
    passed.then(|| format!("a train that comes up to its signal over {} is let past {}", name(one), name(other)))
}
