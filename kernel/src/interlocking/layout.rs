//! The layout of a station: what the plan says, and the same once it is checked.

use super::code::{MAX_CODES, SpeedCode};
use super::limits::SpeedLimits;
use super::set::{CircuitSet, PerCircuit, PointSet, Positions, RouteSet, SegmentSet};
use super::size::{Large, Size, Small};
use crate::distance::Metres;
use crate::heading::Heading;
use crate::time::Ticks;

/// The most track circuits of a small station.
pub const MAX_CIRCUITS: usize = 64;

/// The most points of a small station.
pub const MAX_POINTS: usize = 32;

/// One place of a route's path, or its overlap: what is held there.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Element<Z: Size = Small> {
    /// The track circuit. An overlap may have several circuits, or none.
    pub circuits: CircuitSet<Z>,
    /// The points that must stand so, flank points included.
    pub positions: Positions<Z>,
    /// The circuits beside it, which are not run over: a vehicle there would foul it. They are proved clear, and kept from other routes.
    pub beside: CircuitSet<Z>,
}

impl<Z: Size> Element<Z> {
    /// Nothing.
    pub const NONE: Self = Self { circuits: CircuitSet::EMPTY, positions: Positions::NONE, beside: CircuitSet::EMPTY };

    /// What this and `other` hold together.
    #[inline]
    #[must_use]
    pub fn or(self, other: Self) -> Self {
        Self {
            circuits: self.circuits.or(other.circuits),
            positions: self.positions.or(other.positions),
            beside: self.beside.or(other.beside),
        }
    }

    /// This, or nothing.
    #[inline]
    #[must_use]
    pub fn only_if(self, condition: bool) -> Self {
        Self {
            circuits: self.circuits.only_if(condition),
            positions: self.positions.only_if(condition),
            beside: self.beside.only_if(condition),
        }
    }

    /// Whether a train in this place and one in `other` foul each other, without running over a common circuit.
    #[inline]
    pub fn fouls(&self, other: &Self) -> bool {
        self.beside.meets(other.circuits) || other.beside.meets(self.circuits)
    }
}

/// A route: from the signal at the exit of `entry` over `path` to the end of its last circuit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Route<const P: usize, Z: Size = Small> {
    /// The direction of travel.
    pub heading: Heading,
    /// The circuit in rear of the route's signal, where its train waits.
    pub entry: CircuitSet<Z>,
    /// The circuits on which a train may be that counts on the signal: `entry` among them.
    pub approach: CircuitSet<Z>,
    /// The path in order of travel; what is beyond `length` is not looked at.
    pub path: [Element<Z>; P],
    /// How many places the path has, 1 to `P`; 0 means that there is no route of this number.
    pub length: u8,
    /// What is kept free beyond the end, in case the train does not stop in time. Of a calling-on route it is the berth: the occupied track
    /// behind the end, into which its train goes on.
    pub overlap: Element<Z>,
    /// The circuits that adjoin the end of the route: the train is there once it has left the path.
    pub beyond: CircuitSet<Z>,
    /// The routes that go on where this one ends; their path may run over this route's overlap.
    pub continuing: RouteSet<Z>,
    /// Routes that must not be held together with this one, whatever their circuits and points.
    pub conflicts: RouteSet<Z>,
    /// The segment that the route's train comes from, or none.
    pub from: SegmentSet<Z>,
    /// The segment that the route's train goes out to, or none.
    pub to: SegmentSet<Z>,
    /// How long the points may take to arrive.
    pub drive: Ticks,
    /// How long a withdrawn route stays locked where a train may be coming.
    pub release: Ticks,
    /// How long a train must have stood on the last circuit before the overlap is given up.
    pub stay: Ticks,
    /// The highest speed code on the route.
    pub speed: SpeedCode,
    /// The highest speed code on its overlap, for a train that has slid there and goes back.
    pub overlap_speed: SpeedCode,
    /// Whether every train that uses the route acts on telegrams alone, and not on what a driver sees of the signal.
    pub cab_signalled: bool,
    /// Whether it is a calling-on route: its train waits at the signal, and goes on sight into a berth where another one stands.
    pub calling_on: bool,
}

impl<const P: usize, Z: Size> Route<P, Z> {
    /// No route: what fills the places of a layout that are not used.
    pub const NONE: Self = Self {
        heading: Heading::Right,
        entry: CircuitSet::EMPTY,
        approach: CircuitSet::EMPTY,
        path: [Element::NONE; P],
        length: 0,
        overlap: Element::NONE,
        beyond: CircuitSet::EMPTY,
        continuing: RouteSet::EMPTY,
        conflicts: RouteSet::EMPTY,
        from: SegmentSet::EMPTY,
        to: SegmentSet::EMPTY,
        drive: Ticks(0),
        release: Ticks(0),
        stay: Ticks(0),
        speed: SpeedCode::STOP,
        overlap_speed: SpeedCode::STOP,
        cab_signalled: false,
        calling_on: false,
    };

    /// Whether there is such a route.
    pub const fn exists(&self) -> bool {
        self.length > 0
    }

    /// What the places from `first` on hold, without the overlap.
    #[inline]
    pub fn held_from(&self, first: u8) -> Element<Z> {
        let mut held = Element::NONE;
        for (place, element) in (0_u8..).zip(Z::used(&self.path, self.length)) {
            if place >= first && place < self.length {
                held = held.or(*element);
            }
        }
        held
    }

    /// The circuit at `place` of the path; none where there is no such place.
    #[inline]
    pub fn circuit_at(&self, place: u8) -> CircuitSet<Z> {
        let mut circuit = CircuitSet::EMPTY;
        for (number, element) in (0_u8..).zip(Z::used(&self.path, self.length)) {
            if number == place && number < self.length {
                circuit = element.circuits;
            }
        }
        circuit
    }

    /// The last circuit of the path.
    #[inline]
    pub fn last(&self) -> CircuitSet<Z> {
        self.circuit_at(self.length.wrapping_sub(1))
    }

    /// Whether a train may be on the approach behind the entry.
    #[inline]
    pub fn is_approached(&self, occupied: CircuitSet<Z>) -> bool {
        self.approach.without(self.entry).meets(occupied)
    }

    /// Whether a train may be on the approach behind the entry, and run over one of `circuits` to the signal.
    #[inline]
    pub fn is_approached_over(&self, circuits: CircuitSet<Z>, occupied: CircuitSet<Z>) -> bool {
        self.approach.meets(circuits) && self.is_approached(occupied)
    }
}

/// A point.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Point<Z: Size = Small> {
    /// The circuits whose occupation says that a train may stand on the point or foul it.
    pub detectors: CircuitSet<Z>,
}

/// A stretch of plain line to a neighbouring station, as far as this device sees it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Segment<const P: usize, Z: Size = Small> {
    /// Its circuits, the one next to the station first; what is beyond `length` is not looked at.
    pub circuits: [CircuitSet<Z>; P],
    /// How many circuits it has, 1 to `P`; 0 means that there is no segment of this number.
    pub length: u8,
    /// The last circuit of every route that goes out to the segment; none if no route does.
    pub throat: CircuitSet<Z>,
    /// The direction of travel away from the station.
    pub outward: Heading,
    /// How many of its circuits, the outermost ones, the neighbour's device sees too.
    pub shared: u8,
}

impl<const P: usize, Z: Size> Segment<P, Z> {
    /// No segment: what fills the places of a layout that are not used.
    pub const NONE: Self = Self {
        circuits: [CircuitSet::EMPTY; P],
        length: 0,
        throat: CircuitSet::EMPTY,
        outward: Heading::Right,
        shared: 0,
    };

    /// All its circuits.
    #[inline]
    pub fn all(&self) -> CircuitSet<Z> {
        let mut all = CircuitSet::EMPTY;
        for (place, circuit) in (0_u8..).zip(Z::used(&self.circuits, self.length)) {
            if place < self.length {
                all = all.or(*circuit);
            }
        }
        all
    }

    /// The circuits that the neighbour's device sees too.
    #[inline]
    pub fn shared_circuits(&self) -> CircuitSet<Z> {
        let own = self.length.saturating_sub(self.shared);
        let mut shared = CircuitSet::EMPTY;
        for (place, circuit) in (0_u8..).zip(Z::used(&self.circuits, self.length)) {
            shared = shared.or(circuit.only_if(place >= own && place < self.length));
        }
        shared
    }

    /// The occupied circuits of the segment, and its throat, that follow a circuit of `train` without a gap, on either side.
    #[inline]
    pub fn joined_to(&self, train: CircuitSet<Z>, occupied: CircuitSet<Z>) -> CircuitSet<Z> {
        let mut joined = train;
        let mut before = self.throat;
        for (place, circuit) in (0_u8..).zip(Z::used(&self.circuits, self.length)) {
            let follows = place < self.length && before.meets(joined);
            joined = joined.or(circuit.and(occupied).only_if(follows));
            before = *circuit;
        }
        let reach = Z::used(&self.circuits, self.length).len();
        for back in 1..=reach {
            let place = reach - back;
            let outer = self.circuits[place].only_if(place < usize::from(self.length));
            let inner = if place == 0 { self.throat } else { self.circuits[place - 1] };
            joined = joined.or(inner.and(occupied).only_if(outer.meets(joined)));
        }
        joined
    }
}

/// A layout as a plan gives it: up to `R` routes of up to `P` circuits each, `N` points, `S` segments. Not checked.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Plan<const R: usize, const P: usize, const N: usize, const S: usize, Z: Size = Small> {
    /// The routes.
    pub routes: [Route<P, Z>; R],
    /// The points.
    pub points: [Point<Z>; N],
    /// The segments of plain line.
    pub segments: [Segment<P, Z>; S],
    /// The length of each circuit.
    pub lengths: PerCircuit<Metres, Z>,
    /// The line speed of each circuit.
    pub line: SpeedLimits<Z>,
    /// How far a train runs from the speed of each code when a lower one goes out: while its telegram ages, and braking. The longest length where
    /// there is no such code.
    pub braking: [Metres; MAX_CODES],
    /// How many cycles in a row a circuit must be reported clear before it counts as clear, 1 to 255.
    pub clear: u8,
    /// For how long the neighbour's permission must have been withdrawn before a segment turns: longer than telegrams live.
    pub turn: Ticks,
    /// For how long after a start nothing moves, is confirmed or turned: as long as a train may count on what was before.
    pub start: Ticks,
    /// For how many cycles in a row a point must be detected, undriven, before it counts as detected: as long as a stroke may take to show.
    pub settle: u8,
    /// For how many cycles in a row an occupied circuit may at most not be reported: less than `clear`.
    pub loss: u8,
    /// For how long a train may run on after its authority was taken away.
    pub residual: Ticks,
    /// For how long a train may still slide once it is wholly in the last circuit of a route.
    pub standstill: Ticks,
}

impl<const R: usize, const P: usize, const N: usize, const S: usize, Z: Size> Plan<R, P, N, S, Z> {
    /// A plan with nothing in it, to be filled.
    pub const EMPTY: Self = Self {
        routes: [Route::NONE; R],
        points: [Point { detectors: CircuitSet::EMPTY }; N],
        segments: [Segment::NONE; S],
        lengths: PerCircuit::NONE,
        line: SpeedLimits::NONE,
        braking: [Metres(u16::MAX); MAX_CODES],
        clear: 0,
        turn: Ticks(0),
        start: Ticks(0),
        settle: 0,
        loss: 0,
        residual: Ticks(0),
        standstill: Ticks(0),
    };
}

/// A layout that has been checked. The only way to one is [`Layout::new`], or, for proofs and for the models of bad layouts,
/// [`Layout::with_what_proofs_need`].
///
/// What a station of its size has no room for does not compile:
///
/// ```compile_fail,E0080
/// use atc_kernel::interlocking::{Layout, Plan};
///
/// let too_many = Layout::<65, 1, 1, 1>::new(Plan::EMPTY); // 65 routes in a small station
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Layout<const R: usize, const P: usize, const N: usize, const S: usize, Z: Size = Small> {
    plan: Plan<R, P, N, S, Z>,
}

/// A small station: up to 64 circuits, 64 routes of up to 16 circuits, 32 points and 8 segments of plain line.
pub type Station = Layout<64, 16, 32, 8>;

/// A large station: up to 256 circuits, 256 routes of up to 32 circuits, 128 points and 32 segments
/// of plain line.
pub type LargeStation = Layout<256, 32, 128, 32, Large>;

impl<const R: usize, const P: usize, const N: usize, const S: usize, Z: Size> Layout<R, P, N, S, Z> {
    /// A layout that keeps every rule.
    ///
    /// # Errors
    /// The first rule that is broken, and where; [`Plan::check`] tells all of them.
    pub fn new(plan: Plan<R, P, N, S, Z>) -> Result<Self, super::Broken> {
        // The very function that the proofs use: what they assume of a layout holds of every one that is made here.
        let layout = Self::with_what_proofs_need(plan)?;
        let mut first = None;
        layout.plan.check_engineering(&mut |broken| first = first.or(Some(broken)));
        first.map_or(Ok(layout), Err)
    }

    /// A layout that keeps the rules that the theorems rest on, and perhaps not those of engineering: the theorems hold for it, but
    /// trains are not safe on it. For proofs, and to show what a bad layout leads to.
    ///
    /// # Errors
    /// The first rule that is broken, and where.
    pub fn with_what_proofs_need(plan: Plan<R, P, N, S, Z>) -> Result<Self, super::Broken> {
        const {
            let room = R <= RouteSet::<Z>::MOST && N <= PointSet::<Z>::MOST && S <= SegmentSet::<Z>::MOST;
            assert!(room && P < 255, "a station of this size has no room for so much");
        }
        let mut first = None;
        plan.check_needed(&mut |broken| first = first.or(Some(broken)));
        match first {
            Some(broken) => Err(broken),
            None => Ok(Self { plan }),
        }
    }

    /// The plan.
    pub const fn plan(&self) -> &Plan<R, P, N, S, Z> {
        &self.plan
    }
}
