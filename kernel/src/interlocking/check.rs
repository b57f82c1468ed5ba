//! The rules of a layout: those that the theorems need, and those that engineering asks for besides.

use super::layout::{Element, Plan, Route};
use super::set::{CircuitSet, PointSet, Positions, RouteSet, SegmentSet, short};
use super::size::Size;
use crate::distance::Metres;

/// A rule that a plan breaks, and where. Routes, places of a path, points and segments are numbered from 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Broken {
    /// The rule.
    pub rule: Rule,
    /// Where it is broken.
    pub place: Place,
}

/// A place of a plan.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// The plan as a whole.
    Plan,
    /// A route.
    Route(u8),
    /// A place of a route's path.
    Path(u8, u8),
    /// A route's overlap.
    Overlap(u8),
    /// Two routes.
    Routes(u8, u8),
    /// A point.
    Point(u8),
    /// A segment.
    Segment(u8),
    /// Two segments.
    Segments(u8, u8),
    /// A track circuit.
    Circuit(u8),
}

/// What a layout must keep. Source: `spec/interlocking.md`, LAY-1 (the theorems need it) and LAY-2 (engineering asks for it).
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Rule {
    /// Needed: a path has at most as many places as there is room for.
    PathTooLong,
    /// Needed: every time is one cycle or more.
    NoTime,
    /// Engineering: a circuit counts as clear only after more cycles than a train may be lost for, and as many as in two circuits in turn.
    ClearShort,
    /// Needed: the release time covers the residual running and the longest loss.
    ReleaseShort,
    /// Needed: the stay time covers the standstill time, the longest loss and one cycle more.
    StayShort,
    /// Needed: a route does not need a point both ways, over its path, flank and overlap together.
    PointBothWays,
    /// Needed: a point whose detector is among the circuits of a place, or of an overlap, is positioned there.
    PointNotPositioned,
    /// Needed: declared conflicts go both ways.
    ConflictOneWay,
    /// Needed: routes that start from one circuit in opposite directions of travel conflict.
    OpposingStarts,
    /// Needed: a route that continues another one enters at the other's last circuit.
    ContinuesElsewhere,
    /// Needed: a calling-on route has a berth, ends there, and leads to no line.
    CallingOnEnds,
    /// Needed: a route that starts in a berth leaves it at once, and against the called train over the last circuit of its path.
    CallingOnAgainst,
    /// Engineering: a berth adjoins the end of the path, reaches to the end of every route into it, and is no throat; drivers see the aspect.
    CallingOnBerth,
    /// Engineering: a route goes on in the direction of travel of the route that it continues, and of its segments.
    TurnsBack,
    /// Engineering: all routes out to a segment end at the segment's throat.
    ThroatsDiffer,
    /// Needed: a segment shares no circuit with a path, an overlap, what is beside them, a throat or another segment.
    SegmentShared,
    /// Engineering: no circuit of a segment is a detector of a point: nothing holds the point for a train on the line.
    PointInSegment,
    /// Needed: each place of a path, and of a segment, is exactly one circuit.
    NotOneCircuit,
    /// Needed: no circuit comes twice in a path.
    CircuitTwice,
    /// Needed: braking distances rise with the code; codes without one come last.
    BrakingFalls,
    /// Engineering: an overlap has no circuit of its own path.
    OverlapUnderOwnPath,
    /// Engineering: the entry is exactly one circuit, and among the approach.
    EntryNotInApproach,
    /// Engineering: the approach has no circuit of the path or the overlap.
    ApproachInPath,
    /// Engineering: there is a circuit beyond the end, and it is not the last one.
    NothingBeyond,
    /// Engineering: a route does not conflict with itself.
    ConflictsWithItself,
    /// Engineering: what is named exists: routes, points, segments.
    NotThere,
    /// Engineering: a point that a route needs has a detector.
    NoDetector,
    /// Engineering: a circuit of a path or a segment has a length.
    NoLength,
    /// Engineering: a route's code is in the table.
    CodeOutOfTable,
    /// Engineering: a route comes from at most one segment and goes to at most one.
    ManySegments,
}

/// Reports `rule` at `place` unless it is kept.
#[inline]
fn require(report: &mut impl FnMut(Broken), kept: bool, rule: Rule, place: Place) {
    if !kept {
        report(Broken { rule, place });
    }
}

impl<const R: usize, const P: usize, const N: usize, const S: usize, Z: Size> Plan<R, P, N, S, Z> {
    /// Every rule that is broken, with its place.
    pub fn check(&self, report: &mut impl FnMut(Broken)) {
        self.check_needed(report);
        self.check_engineering(report);
    }

    /// The rules that theorems rest on.
    #[inline]
    pub fn check_needed(&self, report: &mut impl FnMut(Broken)) {
        //= spec/interlocking.md#lay-1-what-the-theorems-need
        //# The constructor MUST reject a layout in which a rule that a theorem rests on is broken.
        require(report, self.clear > 0 && self.turn.0 > 0, Rule::NoTime, Place::Plan);
        let mut before = Metres(0);
        for distance in &self.braking[1..] {
            let rises = *distance > before || *distance == Metres(u16::MAX);
            require(report, rises, Rule::BrakingFalls, Place::Plan);
            before = *distance;
        }
        for (number, route) in self.routes.iter().enumerate() {
            let number = short(number);
            self.check_route(number, route, report);
        }
        for (number, segment) in (0_u8..).zip(&self.segments) {
            require(report, usize::from(segment.length) <= P, Rule::PathTooLong, Place::Segment(number));
            let mut others = self.all_paths();
            for (other, segment) in (0_u8..).zip(&self.segments) {
                others = others.or(segment.throat).or(segment.all().only_if(other != number));
            }
            require(report, !segment.all().meets(others), Rule::SegmentShared, Place::Segment(number));
            let mut before = CircuitSet::EMPTY;
            for (place, circuit) in (0_u8..).zip(&segment.circuits) {
                if place < segment.length {
                    require(report, circuit.is_one(), Rule::NotOneCircuit, Place::Segment(number));
                    require(report, !before.meets(*circuit), Rule::CircuitTwice, Place::Segment(number));
                    before = before.or(*circuit);
                }
            }
        }
    }

    /// The rules of one route that theorems rest on.
    #[inline]
    fn check_route(&self, number: u8, route: &Route<P, Z>, report: &mut impl FnMut(Broken)) {
        let place = Place::Route(number);
        require(report, usize::from(route.length) <= P, Rule::PathTooLong, place);
        if !route.exists() {
            return;
        }
        let timed = route.drive.0 > 0 && route.release.0 > 0 && route.stay.0 > 0;
        require(report, timed, Rule::NoTime, place);
        let loss = u32::from(self.loss);
        let run_out = u32::from(route.release.0) >= u32::from(self.residual.0) + loss;
        require(report, run_out, Rule::ReleaseShort, place);
        let standing = route.stay.0 == 0 || u32::from(route.stay.0) > u32::from(self.standstill.0) + loss;
        require(report, standing, Rule::StayShort, place);
        let needed = route.held_from(0).positions.or(route.overlap.positions);
        require(report, !needed.opposes(needed), Rule::PointBothWays, place);
        let mut before = CircuitSet::EMPTY;
        for (number_in_path, element) in (0_u8..).zip(&route.path) {
            if number_in_path < route.length {
                let place = Place::Path(number, number_in_path);
                require(report, self.positioned(element), Rule::PointNotPositioned, place);
                require(report, element.circuits.is_one(), Rule::NotOneCircuit, place);
                require(report, !before.meets(element.circuits), Rule::CircuitTwice, place);
                before = before.or(element.circuits);
            }
        }
        require(report, self.positioned(&route.overlap), Rule::PointNotPositioned, Place::Overlap(number));
        let berth = route.overlap.circuits.only_if(route.calling_on);
        let ends = !berth.is_empty() && route.continuing.is_empty() && route.to.is_empty();
        require(report, !route.calling_on || ends, Rule::CallingOnEnds, place);
        let myself = RouteSet::nth(usize::from(number));
        let last = route.last();
        for (number_of_other, other) in self.routes.iter().enumerate() {
            let number_of_other = short(number_of_other);
            let pair = Place::Routes(number, number_of_other);
            let it = RouteSet::nth(usize::from(number_of_other));
            let both = !route.conflicts.meets(it) || other.conflicts.meets(myself);
            require(report, both, Rule::ConflictOneWay, pair);
            let together = !route.entry.meets(other.entry) || route.conflicts.meets(it) || !other.exists();
            require(report, together || route.heading == other.heading, Rule::OpposingStarts, pair);
            let starts = other.exists() && other.entry.meets(berth);
            let path = other.held_from(0).circuits;
            let leaves = !path.meets(berth) && (route.heading == other.heading || path.meets(last));
            require(report, !starts || leaves, Rule::CallingOnAgainst, pair);
            let goes_on = !route.continuing.meets(it) || other.entry == last;
            require(report, goes_on, Rule::ContinuesElsewhere, pair);
        }
    }

    /// Whether every point with a detector among the circuits of `element` is positioned by it.
    #[inline]
    fn positioned(&self, element: &Element<Z>) -> bool {
        let mut all = true;
        for (number, point) in self.points.iter().enumerate() {
            let meets = point.detectors.meets(element.circuits);
            all &= !meets || element.positions.points().contains(PointSet::nth(number));
        }
        all
    }

    /// The circuits of all paths and overlaps, and beside them.
    #[inline]
    fn all_paths(&self) -> CircuitSet<Z> {
        let mut all = Element::NONE;
        for route in &self.routes {
            all = all.or(route.held_from(0)).or(route.overlap.only_if(route.exists()));
        }
        all.circuits.or(all.beside)
    }

    /// The rules that no theorem of the machine rests on, but that safe running does.
    pub fn check_engineering(&self, report: &mut impl FnMut(Broken)) {
        //= spec/interlocking.md#lay-2-what-engineering-asks-for
        //# The constructor MUST reject a layout in which a rule of engineering is broken that its data can show.
        // At a joint a train may be lost in the circuit that it leaves, and then in the one that it enters.
        let (clear, loss) = (u16::from(self.clear), u16::from(self.loss));
        require(report, clear == 0 || clear > loss && clear >= 2 * loss, Rule::ClearShort, Place::Plan);
        let mut there = (RouteSet::EMPTY, SegmentSet::EMPTY);
        for (number, route) in self.routes.iter().enumerate() {
            there.0 = there.0.or(RouteSet::nth(number).only_if(route.exists()));
        }
        for (number, segment) in self.segments.iter().enumerate() {
            there.1 = there.1.or(SegmentSet::nth(number).only_if(segment.length > 0));
        }
        let mut used = CircuitSet::EMPTY;
        for (number, route) in self.routes.iter().enumerate() {
            let number = short(number);
            if route.exists() {
                self.check_engineering_of(number, route, there, report);
                used = used.or(route.held_from(0).circuits);
            }
        }
        let mut line = CircuitSet::EMPTY;
        for segment in &self.segments {
            line = line.or(segment.all());
        }
        used = used.or(line);
        for (number, point) in (0_u8..).zip(&self.points) {
            require(report, !point.detectors.meets(line), Rule::PointInSegment, Place::Point(number));
        }
        for (number, length) in self.lengths.iter().enumerate() {
            let number = short(number);
            let unused = !used.meets(CircuitSet::nth(usize::from(number)));
            require(report, unused || *length > Metres(0), Rule::NoLength, Place::Circuit(number));
        }
    }

    fn check_engineering_of(
        &self,
        number: u8,
        route: &Route<P, Z>,
        there: (RouteSet<Z>, SegmentSet<Z>),
        report: &mut impl FnMut(Broken),
    ) {
        let place = Place::Route(number);
        let path = route.held_from(0);
        let entered = route.entry.is_one() && route.approach.contains(route.entry);
        require(report, entered, Rule::EntryNotInApproach, place);
        let ahead = path.circuits.or(route.overlap.circuits);
        require(report, !route.approach.meets(ahead), Rule::ApproachInPath, place);
        require(report, !route.overlap.circuits.meets(path.circuits), Rule::OverlapUnderOwnPath, place);
        let beyond = !route.beyond.is_empty() && !route.beyond.meets(route.last());
        require(report, beyond, Rule::NothingBeyond, place);
        require(report, !route.calling_on || self.is_berth(route), Rule::CallingOnBerth, place);
        let myself = RouteSet::nth(usize::from(number));
        require(report, !route.conflicts.meets(myself), Rule::ConflictsWithItself, place);
        let named = route.conflicts.or(route.continuing);
        let segments = route.from.or(route.to);
        require(report, there.0.contains(named) && there.1.contains(segments), Rule::NotThere, place);
        let single = |set: SegmentSet<Z>| set.is_empty() || set.is_one();
        require(report, single(route.from) && single(route.to), Rule::ManySegments, place);
        self.check_points_of(path.positions.or(route.overlap.positions), place, report);
        for (number_of_segment, segment) in self.segments.iter().enumerate() {
            let it = SegmentSet::nth(number_of_segment);
            let ends = !route.to.meets(it) || segment.throat == route.last();
            require(report, ends, Rule::ThroatsDiffer, place);
            let outward = !route.to.meets(it) || route.heading == segment.outward;
            let inward = !route.from.meets(it) || route.heading == segment.outward.opposite();
            require(report, outward && inward, Rule::TurnsBack, place);
        }
        for (number_of_other, other) in self.routes.iter().enumerate() {
            let number_of_other = short(number_of_other);
            let follows = route.continuing.meets(RouteSet::nth(usize::from(number_of_other)));
            let goes_on = !follows || route.heading == other.heading;
            require(report, goes_on, Rule::TurnsBack, Place::Routes(number, number_of_other));
        }
        let mut in_table = false;
        for (code, distance) in (0_u8..).zip(&self.braking) {
            in_table |= code > 0 && code == route.speed.0 && *distance < Metres(u16::MAX);
        }
        require(report, in_table, Rule::CodeOutOfTable, place);
    }

    /// Whether the overlap of a calling-on route can be a berth: all of the track from the end of the path to the next signal.
    fn is_berth(&self, route: &Route<P, Z>) -> bool {
        let berth = route.overlap.circuits;
        let mut whole = berth.contains(route.beyond) && !route.cab_signalled;
        for segment in &self.segments {
            whole &= !segment.throat.meets(berth);
        }
        for other in &self.routes {
            let mut ahead = CircuitSet::EMPTY;
            let mut behind = false;
            for (place, element) in (0_u8..).zip(&other.path) {
                if place < other.length {
                    ahead = ahead.or(element.circuits.only_if(behind));
                    behind |= element.circuits == route.last();
                }
            }
            // Where a route runs on from the end of the path into the berth, the berth goes on as far as it does.
            let into = other.heading == route.heading && ahead.meets(berth);
            whole &= !into || berth.contains(ahead);
        }
        whole
    }

    fn check_points_of(&self, positions: Positions<Z>, place: Place, report: &mut impl FnMut(Broken)) {
        let mut detected = PointSet::EMPTY;
        let mut there = PointSet::EMPTY;
        for (number, point) in self.points.iter().enumerate() {
            there = there.or(PointSet::nth(number));
            detected = detected.or(PointSet::nth(number).only_if(!point.detectors.is_empty()));
        }
        require(report, there.contains(positions.points()), Rule::NotThere, place);
        let undetected = positions.points().and(there).without(detected);
        require(report, undetected.is_empty(), Rule::NoDetector, place);
    }
}
