//! Rules of one route: times, flank protection, positions.

use atc_kernel::time::Ticks;

use crate::derive::positions::{opposite, word};
use crate::form;
use crate::model::{Guard, Model, Route};
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
    for flank in &route.flanks {
        let point = &model.points[flank.point].name;
        for guard in &flank.guards {
            let (found, hint) = match guard {
                Guard::Own | Guard::Buffer | Guard::Declared(_) => continue,
                Guard::Point(other, position) => {
                    let held = route.path.iter().any(|place| place.positions.get(other) == Some(position));
                    if held {
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
            let leg = word(flank.leg);
            let what = format!("route {} runs past the {leg} leg of point {point}, and {found}", route.name);
            let right = format!("{hint} give point {point} {leg}_unprotected = \"the reason\"");
            problems.push(Problem::new(Rule::NoFlank, &route.span, what, right));
        }
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
