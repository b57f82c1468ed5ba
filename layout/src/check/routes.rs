//! Rules of one route: times, flank protection, positions.

use std::ops::Range;

use atc_kernel::time::Ticks;

use crate::derive::positions::{opposite, word};
use crate::form::{self, Position};
use crate::graph::Kind;
use crate::model::{Flank, Guard, Model, Route};
use crate::problem::Problem;
use crate::rule::Rule;

/// The rules of the route's own points.
pub fn check(given: &form::Route, model: &Model, route: &Route, problems: &mut Vec<Problem>) {
    strokes(given, model, route, problems);
    flanks(model, route, problems);
    contradictions(model, route, problems);
}

fn strokes(given: &form::Route, model: &Model, route: &Route, problems: &mut Vec<Problem>) {
    let slowest = route.positions().map(|(point, _)| &model.points[point]).max_by_key(|point| point.throw_ms);
    let Some(slowest) = slowest else { return };
    let (name, throw) = (&slowest.name, slowest.throw_ms);
    let drive = model.values.ms(route.drive);
    let settle = model.values.ms(Ticks(model.values.settle.into()));
    let needed = throw.saturating_add(settle);
    if drive < needed {
        let span = given.drive_ms.as_ref().map_or(&route.span, |time| &time.span);
        let what = format!(
            "route {} gives its points {drive} ms, but point {name} takes {throw} ms and settles for {settle} ms",
            route.name
        );
        problems.push(Problem::new(Rule::DriveUnderThrow, span, what, format!("drive_ms must be at least {needed}")));
    }
    let release = model.values.ms(route.release);
    if release <= throw {
        let span = given.release_ms.as_ref().map_or(&route.span, |time| &time.span);
        let what = format!(
            "route {} is released {release} ms after it was withdrawn, while point {name} may run for {throw} ms",
            route.name
        );
        problems.push(Problem::new(
            Rule::ReleaseUnderThrow,
            span,
            what,
            format!("release_ms must be more than {throw}"),
        ));
    }
}

fn flanks(model: &Model, route: &Route, problems: &mut Vec<Problem>) {
    let held = |point: usize, position: Position| {
        route.path.iter().any(|place| place.positions.get(&point) == Some(&position))
    };
    for flank in &route.flanks {
        protection(model, flank, &format!("route {}", route.name), &route.span, &held, problems);
    }
}

/// The protection at one end of a track beside a path or a segment, which holds these positions.
pub fn protection(
    model: &Model,
    flank: &Flank,
    who: &str,
    span: &Range<usize>,
    held: &dyn Fn(usize, Position) -> bool,
    problems: &mut Vec<Problem>,
) {
    let of = flank.of(model);
    let end = flank.word(model);
    let track = &model.graph.tracks[flank.track];
    let (passes, what) = match track.kind {
        Kind::Point(point) => (format!("runs past {of}, and"), format!("point {}", model.points[point].name)),
        Kind::Plain => {
            let joint = &model.graph.joints[track.joints[flank.end]].name;
            let circuit = &model.circuits[track.circuit].name;
            (format!("crosses {of}, and at {joint}"), format!("that track of circuit {circuit}"))
        }
    };
    for guard in &flank.guards {
        let (found, hint) = match guard {
            Guard::Own | Guard::Buffer | Guard::Declared(_) => continue,
            Guard::Point(other, position) => {
                if held(*other, *position) {
                    continue;
                }
                let (other, away) = (&model.points[*other].name, word(*position));
                (format!("point {other} is not held {away}"), format!("hold it {away}, or"))
            }
            Guard::Signal(signal) => {
                (format!("only signal {signal} at stop keeps vehicles off it"), "if that is enough,".to_owned())
            }
            Guard::Line => ("nothing keeps vehicles off it".to_owned(), "mend the tracks, or".to_owned()),
            Guard::Standing(circuit) => {
                let circuit = &model.circuits[*circuit].name;
                (format!("a vehicle may stand in {circuit} that faces no signal there"), "if none can,".to_owned())
            }
        };
        let right = format!("{hint} give {what} {end}_unprotected = \"the reason\"");
        problems.push(Problem::new(Rule::NoFlank, span, format!("{who} {passes} {found}"), right));
    }
}

fn contradictions(model: &Model, route: &Route, problems: &mut Vec<Problem>) {
    let places = route.path.iter().flat_map(|place| place.passed.iter().map(|passed| (passed, &place.span)));
    for (passed, span) in places {
        let against =
            route.path.iter().any(|place| place.positions.get(&passed.point) == Some(&opposite(passed.position)));
        if against {
            let point = &model.points[passed.point].name;
            let needed = word(passed.position);
            let what = format!(
                "route {} runs over point {point} {needed} and is given it {}",
                route.name,
                word(opposite(passed.position))
            );
            let right = format!("give it {needed} everywhere in the route");
            problems.push(Problem::new(Rule::PositionContradicts, span, what, right));
        }
    }
}
