//! One route and one train, for one cycle of the whole device: the scene of the harnesses with a ghost train.
//!
//! The train is a ghost. The kernel sees nothing of it but the circuits in which it is reported; every other circuit may be reported
//! occupied at any time, for any duration, and any other train is nothing else than that. So one ghost stands for any number of trains.
//!
//! What [`holds`] says of ghost and route is the invariant: it is assumed before one cycle of the whole device, and claimed after it.

use super::any::{any_input, any_plan, any_route_state};
use crate::Engine;
use crate::engine::{any_byte, any_flag};
use atc_kernel::interlocking::{
    CircuitSet, Directions, Epoch, Input, Layout, Output, Phase, Plan, Rear, Route, RouteSet, RouteState, Settling,
    SpeedLimits, State, Track, Works,
};
use atc_kernel::time::Ticks;

/// The places of the path: what one train does to a route repeats from place to place.
pub const LENGTH: usize = if cfg!(small) { 2 } else { 3 };

/// That of the train, and another one; that of the train alone for a wrong kernel, and for Kani, where all had an answer in time so.
pub const ROUTES: usize = if cfg!(any(small, kani)) { 1 } else { 2 };

pub const ALONE: &str = match LENGTH {
    3 => "1 route of up to 3 circuits, 32 circuits",
    _ => "1 route of up to 2 circuits, 32 circuits",
};

pub const UNDER_KANI: &str = ALONE;

pub const BOUND: &str = match ROUTES {
    2 => "2 routes of up to 3 circuits, 32 circuits",
    _ => ALONE,
};

/// How the train of a scene is, by construction.
pub const BUILT_IN: &[(&str, &str)] = &[
    ("release-covers-residual-running", "without authority the train runs on for no longer than the residual running"),
    ("path-complete", "its front goes from the approach to the entry, and from there from place to place of the path"),
    ("train-whole", "it is one train from front to tail, and reported in every circuit between"),
    ("no-setting-back", "neither its front nor its tail ever goes back"),
    ("start-outlasts-running", "the device has been running for longer than its time after a start"),
];

/// Where an end of the train is: outside is 0; the places of the path are `FIRST`, `FIRST` + 1, and so on.
/// On the approach, but not at the entry.
pub const APPROACH: u8 = 1;
pub const ENTRY: u8 = 2;
pub const FIRST: u8 = 3;

/// The train, and what it does not know of itself.
#[derive(Clone, Copy, Debug)]
pub struct Train {
    /// Where its front is.
    pub front: u8,
    /// Where its tail is.
    pub tail: u8,
    /// Whether it may pass the route's signal.
    pub authority: bool,
    /// For how many cycles more it passes it without.
    pub run: u16,
    /// For how many cycles more the circuit of its front may not be reported.
    pub(super) late: u8,
    /// For how many cycles more it may slide out of the last circuit.
    pub moving: u16,
    /// Whether it slid into the overlap, or went on into the berth.
    pub slid: bool,
}

/// The route, as far as the ghost's world goes by it, and the times that the layout promises.
pub struct Ground {
    pub last: u8,
    /// Where a train is that has left the path.
    pub over: u8,
    pub(super) approach: CircuitSet,
    pub(super) entry: CircuitSet,
    pub(super) path: [CircuitSet; LENGTH],
    pub(super) overlap: CircuitSet,
    pub(super) cab: bool,
    /// Whether it goes on into a berth: its overlap.
    pub(super) calling_on: bool,
    pub(super) loss: u8,
    pub(super) residual: u16,
    pub(super) standstill: u16,
    pub(super) release: u16,
}

impl Ground {
    fn of<const R: usize, const N: usize, const S: usize>(plan: &Plan<R, LENGTH, N, S>, route: &Route<LENGTH>) -> Self {
        Self {
            last: FIRST.wrapping_add(route.length).wrapping_sub(1),
            over: FIRST.wrapping_add(route.length),
            approach: CircuitSet::from_bits(route.approach.bits() & !route.entry.bits()),
            entry: route.entry,
            path: core::array::from_fn(|place| route.path[place].circuits),
            overlap: route.overlap.circuits,
            cab: route.cab_signalled,
            calling_on: route.calling_on,
            loss: plan.loss,
            residual: plan.residual.0,
            standstill: plan.standstill.0,
            release: route.release.0,
        }
    }
}

impl Ground {
    /// The berth of a calling-on route, or the overlap.
    pub const fn berth(&self) -> CircuitSet {
        self.overlap
    }

    /// The circuit at a position in the path; none elsewhere.
    pub fn at(&self, position: u8) -> CircuitSet {
        let mut circuit = CircuitSet::EMPTY;
        for (here, there) in (FIRST..).zip(&self.path) {
            circuit = circuit.or(there.only_if(here == position && position <= self.last));
        }
        circuit
    }
}

impl Train {
    /// Any train.
    fn any<E: Engine + ?Sized>(e: &mut E) -> Self {
        Self {
            front: any_byte(e, "the train's front (0 outside, 1 approach, 2 entry, 3 first place ...)", 0..=6),
            tail: any_byte(e, "the train's tail", 0..=3),
            authority: any_flag(e, "it has authority (odd: yes)"),
            run: e.word("it runs on for (cycles)", 0..=1),
            late: any_byte(e, "its front is unreported for (cycles)", 0..=0),
            moving: e.word("it slides for (cycles)", 0..=1),
            slid: any_flag(e, "it slid into the overlap (odd: yes)"),
        }
    }

    /// Whether it may still pass the signal.
    pub const fn is_live(&self) -> bool {
        self.authority || self.run > 0
    }

    /// Whether the route is there for it: it may pass the signal, or has.
    pub const fn counts(&self) -> bool {
        self.is_live() || self.front >= FIRST
    }

    /// The first and the last position where it is reported. Where its front is not reported, the one behind still is, though the tail
    /// may just have left it: a circuit does not count as clear as soon as that.
    pub const fn seen(&self) -> (u8, u8) {
        if self.late == 0 {
            return (self.tail, self.front);
        }
        let behind = self.front.wrapping_sub(1);
        (if self.tail < behind { self.tail } else { behind }, behind)
    }

    /// Whether this is a train that there can be.
    pub(super) fn is_one(&self, ground: &Ground) -> bool {
        let ordered = self.tail <= self.front && self.front <= ground.over + 1 && (self.late == 0 || self.front > 0);
        let sliding = !self.slid || self.front >= ground.over && self.tail <= ground.over && !ground.overlap.is_empty();
        let inside = !self.is_live() || self.front <= ENTRY;
        ordered
            && sliding
            && inside
            && self.late <= ground.loss
            && self.run <= ground.residual
            && self.moving <= ground.standstill
    }

    /// Whether it is reported where it must be.
    fn is_reported(&self, ground: &Ground, occupied: CircuitSet) -> bool {
        let (first, last) = self.seen();
        let there = |position: u8| first <= position && position <= last;
        let mut reported = !there(ENTRY) || occupied.contains(ground.entry);
        reported &= !there(APPROACH) || ground.approach.is_empty() || occupied.meets(ground.approach);
        reported &= !there(ground.over) || !self.slid || occupied.meets(ground.overlap);
        for (position, circuit) in (FIRST..).zip(&ground.path) {
            reported &= !there(position) || position >= ground.over || occupied.contains(*circuit);
        }
        reported
    }

    /// What it does in a cycle, before the device reads.
    fn moves<E: Engine + ?Sized>(mut self, e: &mut E, ground: &Ground) -> Self {
        let (on, up) = (any_flag(e, "its front goes on (odd: yes)"), any_flag(e, "its tail goes on (odd: yes)"));
        let onward = any_flag(e, "it has authority beyond the route (odd: yes)");
        let late = any_byte(e, "its front is unreported for (cycles, after the move)", 0..=0);
        e.suppose("loss-of-shunt-within-clear", late <= ground.loss);
        let slides = (self.tail < ground.last || self.moving > 0 || ground.calling_on) && !ground.overlap.is_empty();
        e.suppose("trains-obey-signals", !on || self.front != ENTRY || self.is_live());
        e.suppose("overlap-covers-sliding", !on || self.front != ground.last || onward || slides);
        e.suppose("loss-of-shunt-within-clear", !on || self.late == 0);
        let whole = self.tail == ground.last && self.front == ground.last;
        if on && self.front <= ground.over {
            self.slid |= self.front == ground.last && (!onward || ground.calling_on);
            self.front += 1;
            self.late = late;
            self.moving = 0;
            if self.front >= FIRST {
                self.authority = false;
                self.run = 0;
            }
        } else {
            // It may be reported earlier, and stand earlier.
            self.late = if self.late > 0 && late < self.late { late } else { self.late.saturating_sub(1) };
            self.moving = self.moving.saturating_sub(1);
        }
        if up && self.tail < self.front {
            self.tail += 1;
            self.slid &= self.tail <= ground.over;
        }
        if !whole && self.tail == ground.last && self.front == ground.last {
            self.moving = ground.standstill;
        }
        self
    }

    /// What it learns at the end of the cycle: `lets_in` if the route's signal or telegram lets in who heeds it.
    fn informed<E: Engine + ?Sized>(mut self, e: &mut E, ground: &Ground, lets_in: bool, occupied: CircuitSet) -> Self {
        let heeds = any_flag(e, "it heeds the signal (odd: yes)");
        // In the path the signal at its beginning says nothing to it any more.
        let authority = lets_in && heeds && self.front <= ENTRY;
        let near = self.front == ENTRY || self.front == APPROACH && !ground.approach.is_empty();
        e.suppose("approach-covers-braking", !authority || near && self.late == 0);
        let by_signal = authority && self.front == APPROACH && occupied.meets(ground.entry);
        e.suppose("all-cab-signalled", !by_signal || !ground.cab);
        self.run = if authority {
            0
        } else if self.authority {
            ground.residual
        } else {
            self.run.saturating_sub(1)
        };
        self.authority = authority;
        self
    }
}

/// The invariant: what is so of the train and the route at the end of every cycle.
pub(super) fn holds(train: &Train, ground: &Ground, state: &RouteState) -> bool {
    if !train.counts() {
        return true;
    }
    let (first, last) = train.seen();
    let gone = first >= ground.over;
    let followed = state.proved && matches!(state.phase, Phase::InUse | Phase::Releasing);
    let time = u32::from(state.time.0);
    let (residual, loss) = (u32::from(ground.residual), u32::from(ground.loss));
    let (run, late) = (u32::from(train.run), u32::from(train.late));
    // Who has authority is reported somewhere on the approach.
    let near = train.front >= APPROACH && last >= APPROACH && (last > APPROACH || !ground.approach.is_empty());
    let mut holds = !train.is_live() || near;
    holds &= followed || gone || state.phase == Phase::Set && last <= ENTRY;
    holds &= !followed || state.tail == 0 || first >= FIRST && state.tail <= first - FIRST;
    let rear = match state.rear {
        Rear::Approach => true,
        Rear::Entry => last >= ENTRY,
        Rear::Swept => last >= FIRST,
    };
    holds &= rear || !followed && state.phase != Phase::Set;
    if followed {
        let running = !train.authority && (train.run == 0 || run + time <= residual);
        holds &= !train.is_live() || running;
        holds &= train.front != FIRST || late == 0 || late + time <= residual + loss;
        let ahead = train.front > ground.last || train.moving == 0 && !ground.calling_on;
        let stands = first == ground.last && !train.slid && ahead;
        holds &= state.overlap || gone || stands;
        // Whether anybody may be in the berth is remembered.
        holds &= !ground.calling_on || last < FIRST || gone && !train.slid || state.head > 0;
        let stood = u32::from(state.stood.0);
        let standstill = u32::from(ground.standstill);
        let whole = train.tail == ground.last && train.front == ground.last;
        holds &= stood == 0 || first >= ground.last;
        holds &= !whole || train.moving == 0 || u32::from(train.moving) + stood <= standstill + 1;
        let unreported = train.slid && train.front == ground.over && late > 0;
        holds &= !unreported || stood + late <= standstill + 1 + loss;
    }
    holds && (!train.slid || followed && state.overlap)
}

/// The code of every temporary restriction, and of the line where it is slow.
pub(super) const SLOW: u8 = 5;

/// What a scene has beside the route and its train: no points that have stood, and no block that staff rely on, unless a harness says so.
#[derive(Clone, Copy, Debug)]
pub struct Beside<const S: usize> {
    pub points: Settling,
    pub confirmed: CircuitSet,
    pub directions: Directions<S>,
}

impl<const S: usize> Beside<S> {
    pub const NOTHING: Self =
        Self { points: Settling::INITIAL, confirmed: CircuitSet::EMPTY, directions: Directions::INITIAL };
}

/// Any state of a device whose circuits count as occupied as the input says.
fn any_device<E: Engine + ?Sized, const R: usize, const S: usize>(e: &mut E, beside: Beside<S>) -> State<R, S> {
    let restricted = super::any::any_circuits(e, "restricted (bits)", 0..=0);
    State {
        track: Track::INITIAL,
        started: Ticks(u16::MAX),
        unswept: super::any::any_unswept(e),
        points: beside.points,
        routes: core::array::from_fn(|_| any_route_state(e)),
        directions: beside.directions,
        works: Works {
            blocked: super::any::any_circuits(e, "blocked (bits)", 0..=0),
            confirmed: beside.confirmed,
            restrictions: SpeedLimits::from_parts(core::array::from_fn(|code| {
                restricted.only_if(code == usize::from(SLOW))
            })),
        },
        epoch: Epoch(0),
    }
}

/// One cycle of a device and one train, whose route is the first.
pub struct Scene<const R: usize, const N: usize, const S: usize> {
    pub ground: Ground,
    pub plan: Plan<R, LENGTH, N, S>,
    pub route: Route<LENGTH>,
    pub before: RouteState,
    pub after: RouteState,
    /// The train at the beginning.
    pub earlier: Train,
    /// The train after its move, with what it knew before it.
    pub train: Train,
    /// The train at the end of the cycle.
    pub informed: Train,
    /// The circuits where the line is slow, or that have been restricted for a cycle or more.
    pub(super) slow: CircuitSet,
    /// The device at the beginning, and at the end.
    pub devices: (State<R, S>, State<R, S>),
    pub input: Input,
    pub output: Output<R>,
}

/// Rules that who draws values would break with nearly all of them: conflicts go both ways, and a route continues another one or not.
pub fn order<const R: usize, const N: usize, const S: usize>(plan: &mut Plan<R, LENGTH, N, S>) {
    let drawn = plan.routes;
    for (number, route) in (0..).zip(&mut plan.routes) {
        let it = RouteSet::nth(number);
        for (other, beside) in (0..).zip(&drawn) {
            let there = RouteSet::nth(other);
            let declared = if other < number { beside.conflicts.meets(it) } else { route.conflicts.meets(there) };
            route.conflicts = route.conflicts.without(there).or(there.only_if(declared));
            let continues = route.continuing.meets(there) && beside.entry == drawn[number].last();
            route.continuing = route.continuing.without(there).or(there.only_if(continues));
        }
    }
}

/// Any cycle of a device and one train, of which the invariant holds; with what `beside` draws for the plan, and makes of it, and with any
/// other route in a state that may be beside that of the train.
pub fn any_scene<E: Engine + ?Sized, const R: usize, const N: usize, const S: usize>(
    e: &mut E,
    beside: impl FnOnce(&mut E, &mut Plan<R, LENGTH, N, S>) -> Beside<S>,
) -> Option<Scene<R, N, S>> {
    let mut plan: Plan<R, LENGTH, N, S> = any_plan(e);
    // A rule of engineering, kept from the start: who draws values would break it with nearly all of them.
    let own = plan.routes.first_mut()?;
    own.approach = own.approach.or(own.entry);
    let slow = super::any::any_circuits(e, "slow line (bits)", 0..=0);
    plan.line = SpeedLimits::from_parts(core::array::from_fn(|code| slow.only_if(code == usize::from(SLOW))));
    order(&mut plan);
    let beside = beside(e, &mut plan);
    let layout = Layout::with_what_proofs_need(plan).ok();
    e.assume(layout.is_some());
    let layout = layout?;
    let plan = *layout.plan();
    let route = *plan.routes.first()?;
    let ground = Ground::of(&plan, &route);
    // Rules of the constructor that are engineering's: LAY-2.
    let path = route.held_from(0).circuits;
    let apart = !route.approach.meets(path.or(ground.overlap)) && !path.meets(ground.overlap);
    let engineered = route.exists() && ground.entry.is_one() && apart;
    e.assume(engineered);
    let mut device: State<R, S> = any_device(e, beside);
    // What is in no state, or in none that may be beside that of the train's route, is idle.
    for number in 1..R {
        let valid = device.routes[number].is_valid(&plan.routes[number]) && device.compatible(&layout, number, 0);
        device.routes[number] = if valid { device.routes[number] } else { RouteState::IDLE };
    }
    let before = *device.routes.first()?;
    let train = Train::any(e);
    let valid = before.is_valid(&route) && train.is_one(&ground) && holds(&train, &ground, &before);
    e.assume(valid);
    if !engineered || !valid {
        return None;
    }
    let earlier = train;
    let train = train.moves(e, &ground);
    let input: Input = any_input(e);
    let orders = input.orders;
    let restricted = device.works.restrictions.parts()[usize::from(SLOW)].without(orders.restrict.or(orders.lift));
    let slow = restricted.or(plan.line.parts()[usize::from(SLOW)]);
    e.suppose("loss-of-shunt-within-clear", train.is_reported(&ground, input.occupied));
    let (end, output) = layout.interlock(device, input);
    let (_, _, contents) = output.table.parts();
    let grant = contents.grants.first()?;
    let granted = grant.train.meets(ground.entry) && !grant.circuits.is_empty();
    let lets_in = output.proceed.bits() & 1 == 1 || granted;
    let informed = train.informed(e, &ground, lets_in, input.occupied);
    let (devices, after) = ((device, end), *end.routes.first()?);
    Some(Scene { ground, plan, route, before, after, earlier, train, informed, slow, devices, input, output })
}
