//! Rules of a route's ends: approach, overlap, what lies beyond.

use atc_kernel::distance::Metres;

use crate::derive::{Shortfall, back, signals_behind_points};
use crate::form;
use crate::form::EndKind;
use crate::graph::Kind;
use crate::model::{Model, Route};
use crate::problem::Problem;
use crate::rule::Rule;

/// The rules of the route's approach, overlap and end.
pub fn check(given: &form::Route, model: &Model, route: &Route, problems: &mut Vec<Problem>) {
    entry(given, model, route, problems);
    segments(given, model, route, problems);
    approach(given, model, route, problems);
    overlap(given, model, route, problems);
    beyond(given, model, route, problems);
    reversal(given, model, route, problems);
}

fn entry(given: &form::Route, model: &Model, route: &Route, problems: &mut Vec<Problem>) {
    let within = || model.graph.tracks.iter().filter(|track| track.circuit == route.entry);
    let point = within().find_map(|track| match track.kind {
        Kind::Point(point) => Some(&model.points[point].name),
        Kind::Plain => None,
    });
    let (name, entry) = (&route.name, &given.entry);
    let what = if let Some(point) = point {
        format!("route {name}: point {point} lies in the entry {entry}: a train there may stand on the other leg")
    } else if within().count() > 1 {
        format!("route {name}: tracks cross in the entry {entry}: a train there may stand on the other one")
    } else {
        return;
    };
    let right = "begin the route in a circuit of plain track, and end those that it continues there";
    problems.push(Problem::new(Rule::EntryNotPlain, &entry.span, what, right));
}

/// What the file names as segments, held against the tracks.
fn segments(given: &form::Route, model: &Model, route: &Route, problems: &mut Vec<Problem>) {
    let ahead = route.last().and_then(|last| model.graph.across(route.exit, last));
    let checks = [
        (&given.from, route.from, Some(route.entry), "comes from", "is entered from", "from"),
        (&given.to, route.to, ahead, "goes out to", "ends before", "to"),
    ];
    for (named, segment, circuit, leads, tracks, field) in checks {
        let (Some(named), Some(segment)) = (named, segment) else { continue };
        let first = model.segments[segment].circuits.first();
        if circuit.is_some() && first == circuit.as_ref() {
            continue;
        }
        let name = |circuit: usize| model.circuits[circuit].name.as_str();
        let there = circuit.map_or("the end of the tracks", name);
        let begins = first.map_or("nowhere", |first| name(*first));
        let what = format!(
            "route {} {leads} segment {named}, which begins with {begins}, but by its tracks and positions {tracks} {there}",
            route.name
        );
        let right = model.segments.iter().find(|other| circuit.is_some() && other.circuits.first() == circuit.as_ref());
        let right = right.map_or_else(
            || format!("leave out `{field}`: no segment begins there"),
            |right| format!("leave out `{field}`, or name {}", right.name),
        );
        problems.push(Problem::new(Rule::SegmentElsewhere, &named.span, what, right));
    }
}

fn approach(given: &form::Route, model: &Model, route: &Route, problems: &mut Vec<Problem>) {
    let named = given.approach.as_ref().and_then(|named| named.first());
    let span = named.map_or(&route.span, |named| &named.span);
    let found = back(model, route, route.approach_m, Some(&route.approach));
    if let Some((covered, Shortfall::Circuit(circuit))) =
        found.short.filter(|(covered, _)| *covered >= route.approach_m)
    {
        let circuit = &model.circuits[circuit].name;
        let what = format!(
            "route {}: the approach reaches {covered} m back from the signal, and {circuit} is not in it, on the same track: a driver who changes ends there goes by this signal",
            route.name
        );
        let right = format!(
            "add {circuit}, and so on as far as the next point, buffer stop or signal of that direction, or leave out `approach`"
        );
        problems.push(Problem::new(Rule::ApproachTooShort, span, what, right));
    } else if let Some((covered, why)) = found.short {
        let why = match why {
            Shortfall::Line(joint) => {
                format!("the line is not described beyond joint {}", model.graph.joints[joint].name)
            }
            Shortfall::Circuit(circuit) => format!("{} is not in it", model.circuits[circuit].name),
        };
        let what = format!("route {}: the approach reaches {covered} m back from the signal, where {why}", route.name);
        let Metres(beyond) = model.values.heard_beyond;
        let heard = if beyond == 0 {
            String::new()
        } else {
            format!(", {beyond} m beyond its circuit to which a code is heard")
        };
        let right = format!(
            "{} m are needed: the braking distance{heard}, and what a train runs in {} ms and in the {} ms in which it may not be reported",
            route.approach_m,
            model.values.telegram_age_ms,
            u32::from(model.values.loss) * model.values.cycle_ms
        );
        problems.push(Problem::new(Rule::ApproachTooShort, span, what, right));
    }
    let ahead = route.held();
    let everything = back(model, route, u32::MAX, Some(&route.approach));
    for apart in route.approach.difference(&everything.circuits).filter(|apart| !ahead.contains(apart)) {
        let what = format!(
            "route {}: {} is in the approach, but does not lead to the signal through it",
            route.name, model.circuits[*apart].name
        );
        problems.push(Problem::new(Rule::ApproachApart, span, what, "leave it out, or add what lies between"));
    }
}

fn overlap(given: &form::Route, model: &Model, route: &Route, problems: &mut Vec<Problem>) {
    if route.calling_on {
        let signal =
            |other: &Route| other.is_sound() && other.start == route.berth_end && other.heading == route.heading;
        let buffer = model.graph.joints[route.berth_end].end == Some(EndKind::Buffer);
        if !buffer && !model.routes.iter().any(signal) {
            let rule = Rule::Plan(atc_kernel::interlocking::Rule::CallingOnBerth);
            let joint = &model.graph.joints[route.berth_end].name;
            let what = format!(
                "the berth of route {} ends at joint {joint}, where no signal for its trains stands",
                route.name
            );
            let span = given.berth.first().map_or(&route.span, |first| &first.span);
            problems.push(Problem::new(
                rule,
                span,
                what,
                "name all circuits from the end of the path to the next signal",
            ));
        }
        return;
    }
    if let Some(reason) = &given.short_overlap {
        if reason.trim().is_empty() {
            let what = format!("route {} lacks the reason for its short overlap", route.name);
            problems.push(Problem::new(Rule::OverlapTooShort, &reason.span, what, "say why it is long enough"));
        }
        return;
    }
    let length: u32 = route.overlap.iter().map(|circuit| u32::from(model.circuits[*circuit].length.0)).sum();
    let least = model.values.least_overlap.0;
    // Nothing is to be run into behind a buffer stop, and the direction of a segment is held against what is on plain line.
    let nothing_ahead = model.graph.joints[route.exit].end == Some(EndKind::Buffer) || route.to.is_some();
    if length < u32::from(least) && !nothing_ahead {
        let what = format!("route {} has an overlap of {length} m, and the least one is {least} m", route.name);
        let right = "name circuits beyond the end as overlap, or give short_overlap = \"the reason\"";
        let span = given.overlap.first().map_or(&route.span, |first| &first.span);
        problems.push(Problem::new(Rule::OverlapTooShort, span, what, right));
    }
}

fn beyond(given: &form::Route, model: &Model, route: &Route, problems: &mut Vec<Problem>) {
    let (Some(last), Some(named)) = (route.last(), &given.beyond) else { return };
    for circuit in &route.beyond {
        if *circuit != last && model.graph.between(last, *circuit).is_empty() {
            let (name, last) = (&model.circuits[*circuit].name, &model.circuits[last].name);
            let span = named.iter().find(|named| named.value == *name).map_or(&route.span, |named| &named.span);
            let what = format!("route {}: {name} does not adjoin the last circuit {last}", route.name);
            problems.push(Problem::new(Rule::BeyondApart, span, what, format!("name neighbours of {last}")));
        }
    }
}

fn reversal(given: &form::Route, model: &Model, route: &Route, problems: &mut Vec<Problem>) {
    if let Some(reason) = &given.no_reversal {
        if reason.trim().is_empty() {
            let what = format!("route {} lacks the reason why no train changes ends where it ends", route.name);
            problems.push(Problem::new(Rule::PointBeforeSignal, &reason.span, what, "say what keeps drivers from it"));
        }
        return;
    }
    let last = given.path.last().map_or(&route.span, |last| &last.span);
    for behind in signals_behind_points(model, route) {
        let what = format!(
            "route {}: a train that changes ends where it ends comes first to the signal of route {}, and on the way runs over the point or crossing in {}, which no route from there locks",
            route.name, model.routes[behind.route].name, model.circuits[behind.circuit].name
        );
        let right = "let a route back begin before it, or give no_reversal = \"why no train changes ends there\"";
        problems.push(Problem::new(Rule::PointBeforeSignal, last, what, right));
    }
}
