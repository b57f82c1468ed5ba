//! What a walk must know of a station: which circuits, points, routes and segments there are, and how they hang together.

use std::cell::RefCell;

use atc_kernel::interlocking::{CircuitSet, PointSet, RouteSet, SegmentSet, Size};
use serde_json::Value;

use atc_protocol::machine::Machine as _;
use atc_protocol::machine::interlocking::{Config, Interlocked, Sizes};

/// A station as numbers and names.
#[derive(Clone, Debug, Default)]
pub(super) struct Station {
    pub(super) circuits: Vec<String>,
    pub(super) points: Vec<String>,
    pub(super) routes: Vec<Route>,
    pub(super) segments: Vec<Segment>,
}

#[derive(Clone, Debug)]
pub(super) struct Route {
    pub(super) name: String,
    /// The circuit in rear of its signal.
    pub(super) entry: Vec<usize>,
    /// The circuits of its path, in the order of travel.
    pub(super) path: Vec<usize>,
    /// The circuits of its overlap.
    pub(super) overlap: Vec<usize>,
    /// The segment that it leads to.
    pub(super) to: Option<usize>,
    /// Whether it is a calling-on route, whose overlap is the berth.
    pub(super) calling_on: bool,
}

#[derive(Clone, Debug)]
pub(super) struct Segment {
    pub(super) name: String,
    /// Its circuits, the one next to the station first.
    pub(super) circuits: Vec<usize>,
}

thread_local! {
    /// The last station and its configuration: a large layout takes a second or two to open, and a run may have it in every case.
    static LAST: RefCell<(Value, Station)> = RefCell::default();
}

impl Station {
    /// The station of a configuration, of either size; an empty one if the kernel does not take it.
    pub(super) fn of(config: &Value) -> Self {
        let kept = LAST.with_borrow(|(of, station)| (of == config).then(|| station.clone()));
        kept.unwrap_or_else(|| {
            let station = Self::opened(config);
            LAST.set((config.clone(), station.clone()));
            station
        })
    }

    fn opened(config: &Value) -> Self {
        let config = serde_json::from_value::<Config>(config.clone());
        match config.ok().and_then(|config| Sizes::open(&config).ok()) {
            Some(Sizes::Small(machine)) => Self::of_machine(&machine),
            Some(Sizes::Large(machine)) => Self::of_machine(&machine),
            None => Self::default(),
        }
    }

    fn of_machine<const R: usize, const P: usize, const N: usize, const S: usize, Z: Size>(
        machine: &Interlocked<R, P, N, S, Z>,
    ) -> Self {
        let (plan, names) = (machine.layout().plan(), machine.names());
        let routes = names.routes.iter().zip(&plan.routes).map(|(name, route)| Route {
            name: name.clone(),
            entry: circuits(route.entry),
            path: (0..route.length).flat_map(|place| circuits(route.circuit_at(place))).collect(),
            overlap: circuits(route.overlap.circuits),
            to: (0..names.segments.len()).find(|number| route.to.meets(SegmentSet::nth(*number))),
            calling_on: route.calling_on,
        });
        let segments = names.segments.iter().zip(&plan.segments).map(|(name, segment)| Segment {
            name: name.clone(),
            circuits: segment.circuits.iter().take(segment.length.into()).flat_map(|set| circuits(*set)).collect(),
        });
        Self {
            circuits: names.circuits.clone(),
            points: names.points.clone(),
            routes: routes.collect(),
            segments: segments.collect(),
        }
    }
}

/// The numbers in a set of circuits.
pub(super) fn circuits<Z: Size>(set: CircuitSet<Z>) -> Vec<usize> {
    (0..CircuitSet::<Z>::MOST).filter(|number| set.meets(CircuitSet::nth(*number))).collect()
}

/// The numbers in a set of points.
pub(super) fn points(set: PointSet) -> Vec<usize> {
    (0..32).filter(|number| set.meets(PointSet::nth(*number))).collect()
}

/// The numbers in a set of routes.
pub(super) fn routes(set: RouteSet) -> Vec<usize> {
    (0..64).filter(|number| set.meets(RouteSet::nth(*number))).collect()
}
