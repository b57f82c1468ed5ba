//! What a start leaves unswept: the ways of trains that passed a signal before.

use atc_tests::sketch::{Sketch, Way};

use super::{Set, meets};

/// What one route keeps in a cycle.
#[derive(Clone, Debug, Default, PartialEq, Eq, Hash)]
struct Keep {
    circuits: Set,
    points: Set,
    runs: bool,
}

/// What is unswept, and what keeps it.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Unswept {
    pub circuits: Set,
    /// In this cycle, of each route; until the start is over nothing.
    keeps: Vec<Keep>,
    /// The routes that ran in the cycle before.
    ran: Set,
    /// For how many cycles no route has ended to run.
    still: u16,
    /// In this cycle, what was so in the cycle before.
    before: (Set, Set, u16),
}

impl Unswept {
    pub fn new(sketch: &Sketch) -> Self {
        let circuits: Set = (0..sketch.lengths.len()).collect();
        let ran: Set = (0..sketch.routes.len()).collect();
        let keeps = vec![Keep::default(); sketch.routes.len()];
        Self { before: Default::default(), circuits, keeps, ran, still: 0 }
    }

    /// The cycle is over: what was found in it is not remembered.
    pub fn forget(&mut self) {
        self.keeps.fill(Keep::default());
        self.before = Default::default();
    }

    /// One cycle after the start.
    pub fn sweep(&mut self, sketch: &Sketch, occupied: &Set) {
        self.before = (self.circuits.clone(), self.ran.clone(), self.still);
        self.keeps = (0..sketch.routes.len()).map(|number| self.keep(sketch, number, occupied)).collect();
        let running: Set = (0..self.keeps.len()).filter(|number| self.keeps[*number].runs).collect();
        self.circuits = self.keeps.iter().flat_map(|keep| keep.circuits.iter().copied()).collect();
        let longest = sketch.routes.iter().map(|way| way.stay).max().unwrap_or(0);
        let ended = !self.ran.is_subset(&running) || self.circuits.is_empty();
        self.still = if ended { 0 } else { (self.still + 1).min(longest) };
        self.ran = running;
    }

    fn keep(&self, sketch: &Sketch, number: usize, occupied: &Set) -> Keep {
        let way: &Way = &sketch.routes[number];
        let swept = |circuit: &usize| !self.before.0.contains(circuit);
        if way.cab || way.path.is_empty() || way.overlap.0.iter().any(swept) {
            return Keep::default();
        }
        let from = way.path.iter().rposition(|place| swept(&place.0)).map_or(0, |place| place + 1);
        let first = (from..way.path.len()).find(|place| occupied.contains(&way.path[*place].0));
        let alone = way.path.len() == 1 && occupied.contains(&way.entry);
        let runs = first.is_some_and(|first| first + 1 < way.path.len() || alone || way.calling_on);
        let stops = self.before.1.contains(&number) || self.before.2 < way.stay;
        let called = way.calling_on && meets(&way.overlap.0, occupied);
        if !(runs || called || stops && (first.is_some() || meets(&way.overlap.0, occupied))) {
            return Keep::default();
        }
        let ahead = &way.path[first.unwrap_or(way.path.len())..];
        let needs = ahead.iter().flat_map(|place| &place.1).chain(&way.overlap.1);
        let circuits = ahead.iter().map(|place| place.0).chain(way.overlap.0.iter().copied()).collect();
        Keep { circuits, points: needs.map(|need| need.0).collect(), runs }
    }

    /// Whether a kept place or overlap needs the point.
    pub fn needs(&self, point: usize) -> bool {
        self.keeps.iter().any(|keep| keep.points.contains(&point))
    }

    /// Whether a route out to the segment runs.
    pub fn goes_out_to(&self, sketch: &Sketch, segment: usize) -> bool {
        self.keeps.iter().zip(&sketch.routes).any(|(keep, way)| keep.runs && way.to == Some(segment))
    }

    /// Whether something kept is in the way of a route, or is declared to be.
    pub fn is_in_the_way(&self, sketch: &Sketch, asked: usize, occupied: &Set) -> bool {
        let mine = &sketch.routes[asked];
        let needed: Set = mine.circuits().into_iter().chain(mine.overlap.0.iter().copied()).collect();
        self.keeps.iter().zip(&sketch.routes).enumerate().any(|(number, (keep, other))| {
            let path = other.circuits();
            let begins = path.iter().position(|circuit| *circuit == mine.entry);
            let begins = begins.filter(|_| mine.leftward == other.leftward);
            // The places that are the way on: from `on.0` up to `on.1`, that one not.
            let on = begins.filter(|_| !mine.calling_on).map_or((0, 0), |at| {
                let along = path[at + 1..].iter().take_while(|circuit| needed.contains(circuit)).count();
                (at + 1, at + 1 + along)
            });
            let own = |place: usize| on.0 <= place && place < on.1;
            let kept = |circuit: &usize| needed.contains(circuit) && keep.circuits.contains(circuit);
            let in_path = path.iter().enumerate().any(|(place, circuit)| kept(circuit) && !own(place));
            let waits =
                begins.is_some() && !mine.calling_on && on.1 == path.len() && !meets(&other.overlap.0, occupied);
            let in_overlap = other.overlap.0.iter().any(kept) && !waits;
            let shares = begins.is_some() || meets(&path, &needed) || meets(&other.overlap.0, &needed);
            let declared = mine.conflicts.contains(&number) && !keep.circuits.is_empty();
            in_path || in_overlap || declared && !shares
        })
    }
}
