//! One route: its phases, what it holds, and how it follows its train.

use super::layout::{Element, Route};
use super::set::{CircuitSet, Positions};
use super::size::Size;
use crate::time::Ticks;

/// The phase of a route. Anything but idle holds circuits and points.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Phase {
    /// Nothing is held.
    Idle,
    /// Reserved provisionally: its points are being driven.
    Provisional,
    /// A point did not arrive in time; nothing is driven any more.
    Failed,
    /// Reserved: its points are locked and its signal may show proceed.
    Set,
    /// A train has entered the path, or something has occupied it.
    InUse,
    /// Withdrawn: nobody may enter, and everything stays locked until the release time has passed.
    Releasing,
}

/// How far the rear of a route has been swept: where a train may still be that has, or had, the authority to enter it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Rear {
    /// On the approach, or at the entry.
    Approach,
    /// At the entry.
    Entry,
    /// Nowhere: whoever may enter has entered.
    Swept,
}

/// What is remembered of one route. The held part of its path is always a suffix: the places from `tail` on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct RouteState {
    /// The phase.
    pub phase: Phase,
    /// How many places of the path have been released.
    pub tail: u8,
    /// How many places of the path have been entered, in order.
    pub head: u8,
    /// Whether the overlap is held.
    pub overlap: bool,
    /// How long the phase has lasted: of provisional, and of in use and releasing up to the release time; otherwise 0. A withdrawal that is
    /// repeated starts it anew.
    pub time: Ticks,
    /// Where a train may still be that may enter.
    pub rear: Rear,
    /// Whether the route has been set since it was reserved: only then a train may use it.
    pub proved: bool,
    /// For how long the train has stood on the last circuit, as far as that matters for the overlap.
    pub stood: Ticks,
}

impl RouteState {
    /// Nothing is held.
    pub const IDLE: Self = Self {
        phase: Phase::Idle,
        tail: 0,
        head: 0,
        overlap: false,
        time: Ticks(0),
        rear: Rear::Entry,
        proved: false,
        stood: Ticks(0),
    };

    /// Reserved provisionally, in this cycle.
    pub const RESERVED: Self = Self { phase: Phase::Provisional, overlap: true, ..Self::IDLE };

    /// Whether the route holds anything.
    pub const fn is_held(&self) -> bool {
        !matches!(self.phase, Phase::Idle)
    }

    /// Whether a cycle looks at what the route holds and grants: at a large station only if it is held. Of an idle route that is nothing, and it stays idle.
    #[inline]
    pub const fn is_asked<Z: Size>(&self) -> bool {
        //= spec/interlocking.md#lay-5-idle-routes
        //# In a cycle what is held, kept, granted and driven MUST be asked of every route that is held.
        !Z::RESTS || self.is_held()
    }

    /// Whether the route's points are locked: it is held, and not only provisionally.
    pub const fn locks(&self) -> bool {
        !matches!(self.phase, Phase::Idle | Phase::Provisional)
    }

    /// What the route holds of its path: nothing if it is idle.
    #[inline]
    pub fn path<const P: usize, Z: Size>(&self, route: &Route<P, Z>) -> Element<Z> {
        if self.is_held() { route.held_from(self.tail) } else { Element::NONE }
    }

    /// What the route holds beyond its path.
    #[inline]
    pub fn overlap<const P: usize, Z: Size>(&self, route: &Route<P, Z>) -> Element<Z> {
        route.overlap.only_if(self.overlap)
    }

    /// The circuits that the route holds, overlap included.
    #[inline]
    pub fn circuits<const P: usize, Z: Size>(&self, route: &Route<P, Z>) -> CircuitSet<Z> {
        self.path(route).circuits.or(self.overlap(route).circuits)
    }

    /// The circuits beside what the route holds, overlap included.
    #[inline]
    pub fn beside<const P: usize, Z: Size>(&self, route: &Route<P, Z>) -> CircuitSet<Z> {
        self.path(route).beside.or(self.overlap(route).beside)
    }

    /// Whether the route has been left but for its last circuit, and its overlap was given up: whoever came by it stands there, or goes on by
    /// another route.
    #[inline]
    pub fn stands<const P: usize, Z: Size>(&self, route: &Route<P, Z>) -> bool {
        self.is_held() && !self.overlap && route.length.checked_sub(1) == Some(self.tail)
    }

    /// The points that the route holds, flank and overlap included.
    #[inline]
    pub fn positions<const P: usize, Z: Size>(&self, route: &Route<P, Z>) -> Positions<Z> {
        self.path(route).positions.or(self.overlap(route).positions)
    }

    /// Whether this is a state of `route` that the machine can be in.
    pub fn is_valid<const P: usize, Z: Size>(&self, route: &Route<P, Z>) -> bool {
        let untouched = self.tail == 0 && self.head == 0 && self.overlap && self.stood.0 == 0;
        let unproved = untouched && !self.proved && self.rear == Rear::Entry;
        let ordered = self.tail <= self.head && self.head <= route.length && (self.tail < route.length || self.overlap);
        let swept = self.rear == Rear::Swept;
        let berth = self.overlap || !route.calling_on;
        // Nothing is released before the rear is swept, and it is when the release time has passed.
        let followed = ordered && berth && self.proved && (swept || self.tail == 0 && self.time < route.release);
        let seen = self.rear == Rear::Approach || self.rear == Rear::Entry && route.cab_signalled;
        let timed = match self.phase {
            Phase::Idle => *self == Self::IDLE,
            Phase::Provisional => unproved && self.time < route.drive,
            Phase::Failed => unproved && self.time.0 == 0,
            Phase::Set => untouched && self.proved && seen && self.time.0 == 0,
            Phase::InUse => followed && self.time <= route.release,
            Phase::Releasing => (unproved || followed) && self.time <= route.release,
        };
        let arrived = swept && self.head == route.length && route.length.checked_sub(1) == Some(self.tail);
        let counted = self.overlap && arrived && self.stood <= route.stay && !route.calling_on;
        let standing = self.stood.0 == 0 || counted;
        timed && standing && (route.exists() || self.phase == Phase::Idle)
    }

    /// One cycle of following the train: `occupied` are the circuits that count as occupied.
    #[inline]
    #[must_use]
    pub fn follow<const P: usize, Z: Size>(mut self, route: &Route<P, Z>, occupied: CircuitSet<Z>) -> Self {
        if !matches!(self.phase, Phase::Set | Phase::InUse | Phase::Releasing) {
            return self;
        }
        //= spec/interlocking.md#ilk-6-end-of-proceed
        //# Occupation of any circuit of a set route's path MUST end its proceed aspect for good.
        if self.phase == Phase::Set && self.path(route).circuits.meets(occupied) {
            self.phase = Phase::InUse;
        } else if self.phase != Phase::Set {
            let more = Ticks(self.time.0.saturating_add(1));
            self.time = if more < route.release { more } else { route.release };
        }
        if self.proved {
            self.sweep(route, occupied);
            self.enter(route, occupied);
            self.leave(route, occupied);
            self.stand(route, occupied);
        }
        //= spec/interlocking.md#ilk-13-release-time
        //# A withdrawn route MUST grant nothing until it is requested anew, and be released as soon as all that it still holds, but for a berth that nobody may be in, is clear once its release time has passed.
        //= spec/interlocking.md#ilk-35-berth
        //# The berth of a calling-on route MUST be held until it is clear and the train has left the path, or the route was withdrawn and no place of it has been entered.
        let over = self.phase == Phase::Releasing && self.time >= route.release;
        let unused = route.calling_on && self.head == 0;
        let all = if unused { self.path(route).circuits } else { self.circuits(route) };
        let expired = over && !all.meets(occupied);
        //= spec/interlocking.md#ilk-11-idle
        //# A route MUST become idle when the last place of its path is released and its overlap is not held.
        let left = self.is_held() && self.tail >= route.length && !self.overlap;
        if expired || left { Self::IDLE } else { self }
    }

    /// Where a train may be that may enter while the route is set, if it was at `self.rear` before.
    #[inline]
    fn counted_on<const P: usize, Z: Size>(&self, route: &Route<P, Z>, occupied: CircuitSet<Z>) -> Rear {
        //= spec/interlocking.md#ilk-21-rear
        //# While a route is set, its rear MUST be the approach, but the entry where every train is cab-signalled and the approach but the entry, since it was last clear, has not been occupied while the entry was clear.
        let granted = self.rear == Rear::Approach || !route.entry.meets(occupied);
        if route.cab_signalled && !(route.is_approached(occupied) && granted) { Rear::Entry } else { Rear::Approach }
    }

    /// The rear of the route is swept behind its last train.
    #[inline]
    fn sweep<const P: usize, Z: Size>(&mut self, route: &Route<P, Z>, occupied: CircuitSet<Z>) {
        if self.phase == Phase::Set {
            self.rear = self.counted_on(route, occupied);
            return;
        }
        //= spec/interlocking.md#ilk-22-swept
        //# The rear of a route that is not set any more MUST go from the approach to the entry only while the approach but the entry is clear, and be swept only while the entry is clear, or when the release time has passed since the route came into use or was withdrawn.
        if self.rear == Rear::Approach && !route.is_approached(occupied) {
            self.rear = Rear::Entry;
        }
        let clear = self.rear == Rear::Entry && !route.entry.meets(occupied);
        if clear || self.time >= route.release {
            self.rear = Rear::Swept;
        }
    }

    /// The train's head goes on by one place.
    #[inline]
    fn enter<const P: usize, Z: Size>(&mut self, route: &Route<P, Z>, occupied: CircuitSet<Z>) {
        //= spec/interlocking.md#ilk-9-entering
        //# A place of a path MUST count as entered only in the order of the path, while it is occupied and the one before it (before the first, the entry circuit, but on a calling-on route nothing) is occupied too.
        let before = if self.head == 0 { route.entry } else { route.circuit_at(self.head - 1) };
        // Whether a train may be in the berth is remembered: then it must have been entered, even out of order.
        let follows = before.meets(occupied) || self.head == 0 && route.calling_on;
        if self.head < route.length && route.circuit_at(self.head).meets(occupied) && follows {
            self.head += 1;
        }
    }

    /// The train's tail has left a place.
    #[inline]
    fn leave<const P: usize, Z: Size>(&mut self, route: &Route<P, Z>, occupied: CircuitSet<Z>) {
        //= spec/interlocking.md#ilk-10-release
        //# A place of a path MUST be released behind a train only when the rear of the route is swept, all places before it are released, it was entered, it is clear, and the next place was entered or, after the last one, a circuit beyond is occupied.
        let is_last = self.tail + 1 >= route.length;
        let gone_on = if is_last { route.beyond.meets(occupied) } else { self.tail + 1 < self.head };
        let entered = self.tail < self.head && self.rear == Rear::Swept;
        if entered && gone_on && !route.circuit_at(self.tail).meets(occupied) {
            self.tail += 1;
        }
    }

    /// The train stands at the end of the route, or has left it and the overlap.
    #[inline]
    fn stand<const P: usize, Z: Size>(&mut self, route: &Route<P, Z>, occupied: CircuitSet<Z>) {
        //= spec/interlocking.md#ilk-14-overlap
        //# An overlap that is no berth MUST be held until it is clear and the train has left the path, or the rear is swept, every place before the last is released, and the last, entered in order, has been occupied since without a break for the stay time.
        // In a berth two trains may stand: none of them says when the other does.
        let alone = self.rear == Rear::Swept && self.tail + 1 == route.length && !route.calling_on;
        // Before the only place of a path is the entry: the train has come in once that is clear.
        let begun = self.tail > 0 || self.stood.0 > 0 || !route.entry.meets(occupied);
        let arrived = alone && begun && self.head == route.length && route.last().meets(occupied);
        let more = Ticks(self.stood.0.saturating_add(1));
        let longer = if more < route.stay { more } else { route.stay };
        self.stood = if self.overlap && arrived { longer } else { Ticks(0) };
        let gone = self.tail >= route.length || self.stood >= route.stay;
        if gone && !route.overlap.circuits.meets(occupied) {
            self.overlap = false;
            self.stood = Ticks(0);
        }
    }

    /// The route is withdrawn by command. It must be held.
    #[inline]
    #[must_use]
    pub fn withdraw<const P: usize, Z: Size>(self, route: &Route<P, Z>, occupied: CircuitSet<Z>) -> Self {
        //= spec/interlocking.md#ilk-12-withdrawal
        //# A withdrawn route MUST be released at once only if nothing is on its path and, once it has been set, on its approach, and no train has used it; otherwise its release time MUST start anew.
        let path_clear = !self.path(route).circuits.meets(occupied);
        let at_once = match self.phase {
            Phase::Provisional | Phase::Failed => path_clear,
            Phase::Set => path_clear && !route.approach.meets(occupied),
            Phase::Idle | Phase::InUse | Phase::Releasing => false,
        };
        if at_once { Self::IDLE } else { Self { phase: Phase::Releasing, time: Ticks(0), ..self } }
    }

    /// The circuits that a train may still run over on its way to the signal, that counts on it: the approach, while one may be there.
    #[inline]
    pub fn before_signal<const P: usize, Z: Size>(
        &self,
        route: &Route<P, Z>,
        occupied: CircuitSet<Z>,
    ) -> CircuitSet<Z> {
        route.approach.only_if(self.proved && self.rear == Rear::Approach && route.is_approached(occupied))
    }

    /// Whether it was withdrawn after a train had entered it.
    #[inline]
    pub fn may_resume(&self) -> bool {
        self.phase == Phase::Releasing && self.head > 0
    }

    /// The route is requested: anew where it was withdrawn with a train in it.
    #[inline]
    #[must_use]
    pub fn requested(self) -> Self {
        if self.is_held() { Self { phase: Phase::InUse, ..self } } else { Self::RESERVED }
    }

    /// The reservation after the points have been looked at: `ready` if all is detected, clear and unblocked.
    #[inline]
    #[must_use]
    pub fn reserve<const P: usize, Z: Size>(self, route: &Route<P, Z>, occupied: CircuitSet<Z>, ready: bool) -> Self {
        if self.phase != Phase::Provisional {
            return self;
        }
        //= spec/interlocking.md#ilk-5-reservation
        //# A provisional route MUST become set only when its points are detected in position and its path and overlap are clear (a berth need not be) and unblocked, and no circuit of its approach is blocked while one of it behind the entry is occupied, and failed when that has not come about within the drive time.
        let time = Ticks(self.time.0.saturating_add(1));
        if ready {
            Self { phase: Phase::Set, proved: true, time: Ticks(0), rear: self.counted_on(route, occupied), ..self }
        } else if time >= route.drive {
            Self { phase: Phase::Failed, time: Ticks(0), ..self }
        } else {
            Self { time, ..self }
        }
    }
}

/// Whether two routes foul each other by what they hold, path and overlap, without a common circuit. The path of one that goes on at the end of the other
/// does not: the train beside it is its own.
#[inline]
pub(super) fn foul<Z: Size>(
    (path, overlap, goes_on): (Element<Z>, Element<Z>, bool),
    (other, beyond, follows): (Element<Z>, Element<Z>, bool),
) -> bool {
    let mine = overlap.circuits.or(path.circuits.only_if(!goes_on));
    let theirs = beyond.circuits.or(other.circuits.only_if(!follows));
    path.beside.or(overlap.beside).meets(theirs) || other.beside.or(beyond.beside).meets(mine)
}
