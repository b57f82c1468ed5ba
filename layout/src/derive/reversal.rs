//! Where trains change ends: the signals that a driver comes to first on the way back from the end of a route.

use std::collections::{BTreeMap, BTreeSet};

use atc_kernel::distance::Metres;

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
///
/// A train may be so long that it stands past the signal that is nearest to the end of its route. So only one ends the search that is as far away as the
/// longest train is long; where that is not known, none does.
pub fn signals_behind_points(model: &Model, route: &Route) -> BTreeSet<Behind> {
    let mut found = BTreeSet::new();
    let berth = route.overlap.last().copied().filter(|_| route.calling_on);
    let (last, end) = berth.map_or((route.last(), route.exit), |berth| (Some(berth), route.berth_end));
    let Some(last) = last.filter(|last| !model.values.cab_signalled && !goes_out(model, route, (end, *last))) else {
        return found;
    };
    let heading = route.heading.opposite();
    let first = Some(last).filter(|last| !is_plain(model, *last));
    let longest = model.values.longest_train.map_or(u32::MAX, |Metres(metres)| metres.into());
    // The least distance from the end of the route at which a way back enters a circuit by a joint, over this point or none.
    let mut nearest: BTreeMap<(usize, usize, Option<usize>), u32> = BTreeMap::new();
    let mut open = vec![(end, last, first, 0_u32)];
    while let Some((joint, circuit, passed, distance)) = open.pop() {
        if nearest.get(&(joint, circuit, passed)).is_some_and(|known| *known <= distance) {
            continue;
        }
        nearest.insert((joint, circuit, passed), distance);
        let covered = distance.saturating_add(u32::from(model.circuits[circuit].length.0));
        for way in model.graph.ways(circuit, joint) {
            let mut signals = signals_at(model, heading, way.exit, circuit).peekable();
            let ends = signals.peek().is_some() && covered >= longest;
            found.extend(signals.filter_map(|route| passed.map(|circuit| Behind { route, circuit })));
            let next = model.graph.across(way.exit, circuit).filter(|next| !ends && !on_line(model, *next));
            if let Some(next) = next {
                let passed = passed.or_else(|| Some(next).filter(|next| !is_plain(model, *next)));
                open.push((way.exit, next, passed, covered));
            }
        }
    }
    found
}

/// Whether trains go on where the route ends, at this joint of its last circuit, out to the line. A line without a segment counts: it is refused anyway.
fn goes_out(model: &Model, route: &Route, end: (usize, usize)) -> bool {
    let mut seen = BTreeSet::new();
    let mut open = vec![end];
    while let Some((joint, circuit)) = open.pop() {
        if model.graph.joints[joint].end == Some(EndKind::Line) {
            return true;
        }
        let next = model.graph.across(joint, circuit).filter(|next| !on_line(model, *next));
        if let Some(next) = next.filter(|_| seen.insert((joint, circuit))) {
            open.extend(model.graph.ways(next, joint).into_iter().map(|way| (way.exit, next)));
        }
    }
    route.to.is_some()
}
