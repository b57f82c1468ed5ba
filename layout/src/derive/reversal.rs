//! Where trains change ends: the signals that a driver comes to first on the way back from the end of a route.

use std::collections::BTreeSet;

use super::approach::{is_plain, on_line, signals_at};
use crate::form::EndKind;
use crate::model::{Model, Route};

/// A signal that a train comes to which changes ends where a route ends, with a point or a crossing in between: no route from the signal locks it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Behind {
    /// A route from that signal.
    pub route: usize,
    /// The first circuit on the way to it in which a point or a crossing lies.
    pub circuit: usize,
}

/// The signals that trains come to first which change ends where `route` ends, as far as points or crossings lie on the way. None for a route onto plain
/// line, and none where telegrams alone count: without a route no telegram lets a train go.
pub fn signals_behind_points(model: &Model, route: &Route) -> BTreeSet<Behind> {
    let mut found = BTreeSet::new();
    let berth = route.overlap.last().copied().filter(|_| route.calling_on);
    let (last, end) = berth.map_or((route.last(), route.exit), |berth| (Some(berth), route.berth_end));
    let Some(last) = last.filter(|last| !model.values.cab_signalled && !goes_out(model, route, (end, *last))) else {
        return found;
    };
    let heading = route.heading.opposite();
    let first = Some(last).filter(|last| !is_plain(model, *last));
    let mut seen = BTreeSet::new();
    let mut open = vec![(end, last, first)];
    while let Some((joint, circuit, passed)) = open.pop() {
        if !seen.insert((joint, circuit, passed)) {
            continue;
        }
        for way in model.graph.ways(circuit, joint) {
            let mut signals = signals_at(model, heading, way.exit, circuit).peekable();
            if signals.peek().is_some() {
                found.extend(signals.filter_map(|route| passed.map(|circuit| Behind { route, circuit })));
            } else if let Some(next) = model.graph.across(way.exit, circuit).filter(|next| !on_line(model, *next)) {
                let passed = passed.or_else(|| Some(next).filter(|next| !is_plain(model, *next)));
                open.push((way.exit, next, passed));
            }
        }
    }
    found
}

/// Whether trains go on where the route ends, at this joint of its last circuit, out to the line.
fn goes_out(model: &Model, route: &Route, end: (usize, usize)) -> bool {
    let mut seen = BTreeSet::new();
    let mut open = vec![end];
    while let Some((joint, circuit)) = open.pop() {
        if model.graph.joints[joint].end == Some(EndKind::Line) {
            return true;
        }
        let stops = signals_at(model, route.heading, joint, circuit).next().is_some();
        if let Some(next) = model.graph.across(joint, circuit).filter(|_| !stops && seen.insert((joint, circuit))) {
            open.extend(model.graph.ways(next, joint).into_iter().map(|way| (way.exit, next)));
        }
    }
    route.to.is_some()
}
