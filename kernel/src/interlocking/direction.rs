//! The direction of plain line: who may send trains into a segment, this station or the neighbour.

use super::layout::Layout;
use super::route::RouteState;
use super::set::{CircuitSet, SegmentSet};
use super::size::{Size, Small};
use crate::time::Ticks;

/// The direction of travel in a segment.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Travel {
    /// Towards this station: the neighbour sends.
    Toward,
    /// Away from this station: this station sends.
    Away,
}

/// What is remembered of the segments. A segment that is in neither set has no direction: nobody sends.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Directions<const S: usize, Z: Size = Small> {
    /// The segments where this station permits the neighbour to send.
    pub toward: SegmentSet<Z>,
    /// The segments where this station sends.
    pub away: SegmentSet<Z>,
    /// The segments whose last direction was towards this station: a train that is in them was sent by the neighbour.
    pub came: SegmentSet<Z>,
    /// For how many cycles this station has not permitted the neighbour to send, up to the layout's turn time.
    pub withdrawn: [Ticks; S],
}

impl<const S: usize, Z: Size> Directions<S, Z> {
    /// No segment has a direction, and nobody knows what the neighbour was told.
    pub const INITIAL: Self =
        Self { toward: SegmentSet::EMPTY, away: SegmentSet::EMPTY, came: SegmentSet::EMPTY, withdrawn: [Ticks(0); S] };

    /// Whether no segment has two directions, and time has been counted exactly where permission is withdrawn.
    pub fn is_valid(&self, turn: Ticks) -> bool {
        let mut valid = !self.came.meets(self.away) && self.came.contains(self.toward);
        for (number, time) in self.withdrawn.iter().enumerate() {
            let segment = SegmentSet::nth(number);
            valid &= *time <= turn;
            valid &= !self.toward.meets(segment) || time.0 == 0;
            valid &= !self.away.meets(segment) || *time == turn;
        }
        valid
    }
}

/// The directions that held routes need.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Needs<Z: Size = Small> {
    /// Trains come in.
    pub toward: SegmentSet<Z>,
    /// Trains go out.
    pub away: SegmentSet<Z>,
}

impl<Z: Size> Needs<Z> {
    /// What the routes need in these states.
    #[inline]
    pub fn of<const R: usize, const P: usize, const N: usize, const S: usize>(
        layout: &Layout<R, P, N, S, Z>,
        routes: &[RouteState; R],
    ) -> Self {
        //= spec/interlocking.md#ilk-17-need
        //# A route from a segment MUST need its direction until the first place of its path is released, and a route to a segment until it is idle.
        let mut needs = Self::default();
        for (route, state) in layout.plan().routes.iter().zip(routes) {
            needs.toward = needs.toward.or(route.from.only_if(state.is_held() && state.tail == 0));
            needs.away = needs.away.or(route.to.only_if(state.is_held()));
        }
        needs
    }

    /// These, and those of routes out to `segments`.
    #[inline]
    #[must_use]
    pub(super) fn and_out_to(self, segments: SegmentSet<Z>) -> Self {
        Self { away: self.away.or(segments), ..self }
    }
}

/// The answer to a command to turn a segment.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Turned {
    /// It has the direction.
    Done,
    /// The permission has been withdrawn, and telegrams that say otherwise may still live; or the neighbour permits nothing yet.
    Waiting,
    /// A train is in it or before it, or a route needs the other direction.
    InTheWay,
    /// There is no such segment.
    Unknown,
    /// A circuit of it is blocked.
    Blocked,
}

/// One cycle of all segments: time passes, and at most one command is carried out. `consent` are the segments where the neighbour
/// permits this station to send.
#[inline]
pub(super) fn turn<const R: usize, const P: usize, const N: usize, const S: usize, Z: Size>(
    layout: &Layout<R, P, N, S, Z>,
    mut directions: Directions<S, Z>,
    command: Option<(SegmentSet<Z>, Travel)>,
    (occupied, closed, needs, consent): (CircuitSet<Z>, SegmentSet<Z>, Needs<Z>, SegmentSet<Z>),
) -> (Directions<S, Z>, Option<Turned>) {
    let mut answer = None;
    let (mut entered, mut left) = (SegmentSet::EMPTY, directions.away);
    for route in &layout.plan().routes {
        entered = entered.or(route.from.only_if(route.exists()));
        left = left.or(route.to.only_if(route.exists()));
    }
    for (number, segment) in layout.plan().segments.iter().enumerate() {
        let it = SegmentSet::nth(number);
        let asked = match command {
            Some((segments, travel)) if segments.meets(it) => Some(travel),
            _ => None,
        };
        //= spec/interlocking.md#ilk-18-turning
        //# The direction of a segment MUST change only by command, while no route needs the direction that it has, and be taken from the trains that have it only while the segment and its throat are clear.
        let free = !segment.all().or(segment.throat).meets(occupied);
        let time = directions.withdrawn[number];
        match asked {
            Some(_) if segment.length == 0 => answer = Some(Turned::Unknown),
            //= spec/interlocking.md#ilk-20-blocked-line
            //# A segment with a blocked circuit MUST NOT be given a direction.
            Some(Travel::Toward) if closed.meets(it) => answer = Some(Turned::Blocked),
            //= spec/interlocking.md#ilk-25-occupied-line
            //# A segment that is occupied, or whose throat is, MUST be given the direction towards the station only if that was its last, or if it has none and no route leads to it, and no segment into the station that no route leads from.
            Some(Travel::Toward)
                if entered.meets(it)
                    && !needs.away.meets(it)
                    && (free || directions.came.meets(it) || !left.meets(it)) =>
            {
                directions.away = directions.away.without(it);
                directions.toward = directions.toward.or(it);
                directions.came = directions.came.or(it);
                answer = Some(Turned::Done);
            }
            Some(Travel::Away) if directions.away.meets(it) => answer = Some(Turned::Done),
            Some(Travel::Away) if free && !needs.toward.meets(it) => {
                //= spec/interlocking.md#ilk-19-consent
                //# A segment MUST be turned away from the station only with the neighbour's permission, after this station's own has been withdrawn for the turn time.
                directions.toward = directions.toward.without(it);
                let turns = time >= layout.plan().turn && consent.meets(it) && !closed.meets(it);
                directions.away = directions.away.or(it.only_if(turns));
                directions.came = directions.came.without(it.only_if(turns));
                answer = Some(if turns { Turned::Done } else { Turned::Waiting });
            }
            Some(_) => answer = Some(Turned::InTheWay),
            None => {}
        }
        let permits = directions.toward.meets(it);
        let more = if time < layout.plan().turn { Ticks(time.0.saturating_add(1)) } else { layout.plan().turn };
        directions.withdrawn[number] = if permits { Ticks(0) } else { more };
    }
    (directions, answer)
}

/// The segments with a blocked circuit.
#[inline]
pub(super) fn closed<const R: usize, const P: usize, const N: usize, const S: usize, Z: Size>(
    layout: &Layout<R, P, N, S, Z>,
    blocked: CircuitSet<Z>,
) -> SegmentSet<Z> {
    let mut closed = SegmentSet::EMPTY;
    for (number, segment) in layout.plan().segments.iter().enumerate() {
        closed = closed.or(SegmentSet::nth(number).only_if(segment.all().meets(blocked)));
    }
    closed
}

/// The circuits of segments where a train may be on its way: before this cycle the neighbour was permitted to send, or was less than the turn
/// time ago (`waited`); a route out is held; or a train is in the segment or its throat. What is blocked gets no permission in this cycle.
#[inline]
pub(super) fn open_line<const R: usize, const P: usize, const N: usize, const S: usize, Z: Size>(
    layout: &Layout<R, P, N, S, Z>,
    waited: &[Ticks; S],
    (occupied, needs): (CircuitSet<Z>, Needs<Z>),
) -> CircuitSet<Z> {
    let mut open = CircuitSet::EMPTY;
    for (number, segment) in layout.plan().segments.iter().enumerate() {
        let it = SegmentSet::nth(number);
        // Not this cycle's count: one that is sent at the end of a permission is reported a cycle after the times of the condition.
        let sent = waited[number] < layout.plan().turn;
        let moving = segment.all().or(segment.throat).meets(occupied);
        open = open.or(segment.all().only_if(sent || needs.away.meets(it) || moving));
    }
    open
}
