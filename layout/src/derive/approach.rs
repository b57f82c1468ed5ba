//! The approach of a signal: back over neighbours until a braking train is covered, and all of the track before the signal.

use std::collections::{BTreeMap, BTreeSet};

use atc_kernel::interlocking::Heading;

use crate::form::EndKind;
use crate::graph::Kind;
use crate::model::{Circuits, Model, Route};

/// What was found on the way back from a signal.
pub struct Back {
    /// The circuits on which a train may be that counts on the signal.
    pub circuits: Circuits,
    /// The least distance covered where the way back leaves what may be used: the line ends unseen, or a circuit is not in `within`.
    pub short: Option<(u32, Shortfall)>,
}

/// Why the way back ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shortfall {
    /// The line goes on unseen from this joint.
    Line(usize),
    /// This circuit is not in the approach.
    Circuit(usize),
}

/// Goes back from the signal of `route` until `needed` metres are covered, and as far as the track before the signal reaches. Stops without more at
/// buffer stops and at the circuits that the route holds; uses no circuit that is not in `within`, if that is given.
pub fn back(model: &Model, route: &Route, needed: u32, within: Option<&Circuits>) -> Back {
    let graph = &model.graph;
    let ahead = route.held();
    let mut found = Back { circuits: BTreeSet::new(), short: None };
    // The least distance from the signal at which a way back enters a circuit by a joint, on the track before the signal or farther back.
    let mut nearest: BTreeMap<(usize, usize, bool), u32> = BTreeMap::new();
    let begins = begins_at_signal(model, route);
    let mut open = vec![(route.start, route.entry, 0_u32, begins)];
    while let Some((joint, circuit, distance, on_track)) = open.pop() {
        if nearest.get(&(joint, circuit, on_track)).is_some_and(|known| *known <= distance) {
            continue;
        }
        nearest.insert((joint, circuit, on_track), distance);
        found.circuits.insert(circuit);
        let covered = distance.saturating_add(u32::from(model.circuits[circuit].length.0));
        let mut falls_short = |why| {
            if found.short.is_none_or(|(least, _)| covered < least) {
                found.short = Some((covered, why));
            }
        };
        for way in graph.ways(circuit, joint) {
            let Some(next) = graph.across(way.exit, circuit) else {
                if graph.joints[way.exit].end == Some(EndKind::Line) && covered < needed {
                    falls_short(Shortfall::Line(way.exit));
                }
                continue;
            };
            let on_track = on_track && goes_on(model, route, way.exit, next);
            if ahead.contains(&next) || covered >= needed && !on_track {
                continue;
            }
            if within.is_none_or(|within| within.contains(&next)) {
                open.push((way.exit, next, covered, on_track));
            } else {
                falls_short(Shortfall::Circuit(next));
            }
        }
    }
    found
}

/// Whether trains may change ends in the entry and go by what the driver sees of the signal: not on plain line, and not where telegrams alone count.
fn begins_at_signal(model: &Model, route: &Route) -> bool {
    !model.values.cab_signalled && !on_line(model, route.entry)
}

/// Whether the track before the signal goes on over `joint` into the circuit `next`: no other signal for the same direction of travel stands there, and
/// no point and no crossing lies in it. Who changes ends farther back does not see this signal first, or stands behind what its routes do not lock.
fn goes_on(model: &Model, route: &Route, joint: usize, next: usize) -> bool {
    signals_at(model, route.heading, joint, next).next().is_none() && !on_line(model, next) && is_plain(model, next)
}

/// The routes from the signal at `joint` for trains that leave `circuit` there in this direction of travel.
pub(super) fn signals_at(
    model: &Model,
    heading: Heading,
    joint: usize,
    circuit: usize,
) -> impl Iterator<Item = usize> + '_ {
    let here = move |route: &Route| {
        route.is_sound() && route.heading == heading && (route.start, route.entry) == (joint, circuit)
    };
    (0..model.routes.len()).filter(move |number| here(&model.routes[*number]))
}

/// Whether a circuit is of plain line.
pub(super) fn on_line(model: &Model, circuit: usize) -> bool {
    model.segments.iter().any(|segment| segment.circuits.contains(&circuit))
}

/// Whether one track runs through a circuit, without a point.
pub(super) fn is_plain(model: &Model, circuit: usize) -> bool {
    let mut within = model.graph.tracks.iter().filter(|track| track.circuit == circuit);
    within.next().is_some_and(|track| track.kind == Kind::Plain) && within.next().is_none()
}
