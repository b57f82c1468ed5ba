//! A train that a device finds on its way when it starts, and one cycle of both: the scene of the harnesses about drivers from before the start.
//!
//! The train is a ghost: the kernel sees nothing of it but the circuits in which it is reported, and any other may be reported at any time.

use super::any::{any_input, any_plan, any_state, both, fouls, held, kept};
use super::scene::{LENGTH, order};
use crate::Engine;
use crate::engine::{any_byte, any_flag};
use atc_kernel::interlocking::{
    CircuitSet, Element, Input, Layout, Output, Phase, Plan, Request, Route, RouteState, State,
};
use atc_kernel::time::Ticks;

/// That of the train, and another one.
pub(super) const ROUTES: usize = 2;

/// As many places as the train's route of the other theorems has, and the bound says so.
pub const BOUND: &str = match LENGTH {
    3 => "2 routes of up to 3 circuits, 32 circuits, 1 point, 1 segment of up to 3 circuits",
    _ => "2 routes of up to 2 circuits, 32 circuits, 1 point, 1 segment of up to 2 circuits",
};

pub(super) const BUILT_IN: &[(&str, &str)] = &[
    (
        "path-complete",
        "its front goes from place to place of the path, and out to the line where the route leads there",
    ),
    ("train-whole", "it is one train from front to tail, and reported in every circuit between"),
    ("no-setting-back", "neither its front nor its tail ever goes back"),
];

/// Where an end of the train is: at the entry or before it; the places of the path are `FIRST`, `FIRST` + 1, and so on.
const BEFORE: u8 = 0;
pub(super) const FIRST: u8 = 1;

/// The train, which has passed the signal of its route before the start.
#[derive(Clone, Copy, Debug)]
pub(super) struct Train {
    pub(super) front: u8,
    pub(super) tail: u8,
    /// For how many cycles more the circuit of its front may not be reported.
    pub(super) late: u8,
    /// For how many cycles more it may slide out of the last circuit.
    pub(super) moving: u16,
}

/// The route, and what lies beyond it.
pub(super) struct Ground {
    pub(super) route: Route<LENGTH>,
    /// The last place, and where the train is that has left the path.
    pub(super) last: u8,
    pub(super) over: u8,
    /// Where it comes to a stand: in the last place, or behind it in the berth.
    pub(super) end: u8,
    pub(super) line: CircuitSet,
    /// Whether the route leads out to the line.
    pub(super) out: bool,
    pub(super) loss: u8,
    pub(super) standstill: u16,
    pub(super) start: u16,
}

impl Train {
    fn any<E: Engine + ?Sized>(e: &mut E) -> Self {
        Self {
            front: any_byte(e, "the train's front (1 first place, 2 second ...)", 1..=3),
            tail: any_byte(e, "the train's tail (0 at the entry or before it)", 0..=2),
            late: any_byte(e, "its front is unreported for (cycles)", 0..=0),
            moving: e.word("it slides for (cycles)", 0..=1),
        }
    }

    /// Whether this is a train that there can be. Beyond the path it is in the overlap, or on the line.
    pub(super) fn is_one(self, ground: &Ground) -> bool {
        let beyond = ground.out || !ground.route.overlap.circuits.is_empty();
        let ordered = self.tail <= self.front && FIRST <= self.front && self.front <= ground.over;
        ordered
            && (self.front < ground.over || beyond)
            && self.late <= ground.loss
            && self.moving <= ground.standstill
            && (self.tail >= ground.end || self.moving == 0)
    }

    /// The first and the last position where it is reported.
    const fn seen(self) -> (u8, u8) {
        if self.late == 0 {
            return (self.tail, self.front);
        }
        let behind = self.front.wrapping_sub(1);
        (if self.tail < behind { self.tail } else { behind }, behind)
    }

    fn is_reported(self, ground: &Ground, occupied: CircuitSet) -> bool {
        let (first, last) = self.seen();
        let there = |position: u8| first <= position && position <= last;
        let beyond = if ground.out { ground.line } else { ground.route.overlap.circuits };
        let mut reported = !there(BEFORE) || occupied.contains(ground.route.entry);
        reported &= !there(ground.over) || occupied.meets(beyond);
        for (position, element) in (FIRST..).zip(&ground.route.path) {
            reported &= !there(position) || position > ground.last || occupied.contains(element.circuits);
        }
        reported
    }

    /// What it does in a cycle, before the device reads.
    fn moves<E: Engine + ?Sized>(mut self, e: &mut E, ground: &Ground) -> Self {
        let (on, up) = (any_flag(e, "its front goes on (odd: yes)"), any_flag(e, "its tail goes on (odd: yes)"));
        let late = any_byte(e, "its front is unreported for (cycles, after the move)", 0..=0);
        e.suppose("loss-of-shunt-within-clear", late <= ground.loss);
        let slides = (self.tail < ground.last || ground.route.calling_on || self.moving > 0)
            && !ground.route.overlap.circuits.is_empty();
        e.suppose("overlap-covers-sliding", !on || self.front != ground.last || ground.out || slides);
        e.suppose("loss-of-shunt-within-clear", !on || self.late == 0);
        let whole = self.tail >= ground.end;
        if on && self.front < ground.over {
            self.front += 1;
            self.late = late;
        } else {
            // It may be reported earlier.
            self.late = if self.late > 0 && late < self.late { late } else { self.late.saturating_sub(1) };
        }
        self.moving = self.moving.saturating_sub(1);
        if up && self.tail < self.front {
            self.tail += 1;
        }
        if !whole && self.tail >= ground.end {
            self.moving = ground.standstill;
        }
        self
    }

    /// Whether it may still come to a place of its path, or slide beyond it, or has and is not reported there yet.
    pub(super) const fn goes(self, ground: &Ground) -> bool {
        let unseen = self.late > 0 && (!ground.out || self.front < ground.over);
        // In a berth it goes on whenever it likes.
        self.tail < ground.last || ground.route.calling_on || unseen || self.moving > 0 && !ground.out
    }
}

impl Ground {
    pub(super) fn of(plan: &Plan<ROUTES, LENGTH, 1, 1>) -> Self {
        let (route, segment) = (plan.routes[0], plan.segments[0]);
        let mut line = 0;
        for (place, circuit) in (0..).zip(&segment.circuits) {
            line |= if place < segment.length { circuit.bits() } else { 0 };
        }
        Self {
            route,
            last: route.length,
            over: route.length.wrapping_add(1),
            end: route.length.wrapping_add(u8::from(route.calling_on)),
            line: CircuitSet::from_bits(line),
            out: route.to.bits() & 1 == 1,
            loss: plan.loss,
            standstill: plan.standstill.0,
            start: plan.start.0,
        }
    }

    /// The circuits of the path: a mask.
    pub(super) fn path(&self) -> u64 {
        let mut path = 0;
        for (place, element) in (0..).zip(&self.route.path) {
            path |= if place < self.route.length { element.circuits.bits() } else { 0 };
        }
        path
    }

    /// Whether the train is on its way out to the line, or on it.
    pub(super) const fn goes_out(&self, left: bool) -> bool {
        self.out && !left
    }
}

/// What the train still needs, and what is beside that: from its tail on, the overlap with it.
pub(super) fn needed(train: Train, ground: &Ground) -> Element {
    let mut needed = Element::NONE;
    for (position, element) in (FIRST..).zip(&ground.route.path) {
        if train.goes(ground) && train.tail <= position && position <= ground.last {
            needed = both(needed, *element);
        }
    }
    if train.goes(ground) { both(needed, ground.route.overlap) } else { needed }
}

/// The invariant of the train and what the device has not swept.
pub(super) fn holds<const S: usize>(train: Train, ground: &Ground, device: &State<ROUTES, S>) -> bool {
    let unswept = device.unswept;
    let starting = device.started.0 < ground.start;
    let (late, moving) = (u32::from(train.late), u32::from(train.moving));
    let unseen = train.front == FIRST && train.late > 0;
    // Who has just passed the signal is reported before the start is over.
    let mut holds = !unseen || starting && late + u32::from(device.started.0) <= u32::from(ground.start);
    let (first, _) = train.seen();
    if train.goes(ground) {
        holds &= unswept.circuits.contains(needed(train, ground).circuits);
        for (position, element) in (FIRST..).zip(&ground.route.path) {
            let there = first <= position && position <= ground.last;
            holds &= !there || unswept.circuits.contains(element.circuits);
        }
    }
    let runs = unswept.running.bits() & 1 == 1;
    let (still, standstill) = (u32::from(unswept.still.0), u32::from(ground.standstill));
    holds &= first >= ground.end || runs;
    let timed = !ground.route.calling_on;
    holds &= !timed || runs || ground.out || moving == 0 || still + moving <= standstill;
    holds & (!timed || runs || ground.out || train.late == 0 || still + late <= standstill + u32::from(ground.loss))
}

/// Whether a route begins at a place of the train's path, and leads the same way: it is for this train.
pub(super) fn begins(route: &Route<LENGTH>, ground: &Ground, from: u8) -> bool {
    let mut begins = false;
    for (position, element) in (FIRST..).zip(&ground.route.path) {
        begins |= from <= position && position <= ground.last && element.circuits == route.entry;
    }
    begins && route.heading == ground.route.heading
}

/// Any layout and any valid state of it. What is drawn is made valid where who draws values would break it with nearly all of them.
fn any_device<E: Engine + ?Sized>(e: &mut E) -> Option<(Layout<ROUTES, LENGTH, 1, 1>, State<ROUTES, 1>)> {
    let mut plan = any_plan(e);
    order(&mut plan);
    let layout = Layout::with_what_proofs_need(plan).ok();
    e.assume(layout.is_some());
    let layout = layout?;
    let plan = layout.plan();
    let mut device: State<ROUTES, 1> = any_state(e);
    device.works.confirmed = device.works.confirmed.and(device.works.blocked);
    let directions = &mut device.directions;
    directions.away = directions.away.without(directions.toward);
    directions.came = directions.came.or(directions.toward).without(directions.away);
    let time = directions.withdrawn[0];
    let shorter = if time < plan.turn { time } else { plan.turn };
    let (toward, away) = (directions.toward.bits() & 1 == 1, directions.away.bits() & 1 == 1);
    directions.withdrawn[0] = if toward {
        Ticks(0)
    } else if away {
        plan.turn
    } else {
        shorter
    };
    for number in 0..ROUTES {
        let valid = device.routes[number].is_valid(&plan.routes[number]);
        device.routes[number] = if valid { device.routes[number] } else { RouteState::IDLE };
        let beside = number == 0 || device.compatible(&layout, number, 0);
        device.routes[number] = if beside { device.routes[number] } else { RouteState::IDLE };
    }
    let valid = device.is_valid(&layout);
    e.assume(valid);
    valid.then_some((layout, device))
}

/// One cycle of a device and a train from before the start.
pub(super) struct Scene {
    pub(super) plan: Plan<ROUTES, LENGTH, 1, 1>,
    pub(super) ground: Ground,
    pub(super) earlier: Train,
    /// The train after its move, and whether it had left the line before and after that.
    pub(super) train: Train,
    pub(super) left: (bool, bool),
    pub(super) before: State<ROUTES, 1>,
    pub(super) after: State<ROUTES, 1>,
    pub(super) input: Input,
    pub(super) output: Output<ROUTES>,
}

/// Any cycle before which the train and the device hold the invariant, and `beside` what a harness supposes besides.
pub(super) fn any_scene<E: Engine + ?Sized>(
    e: &mut E,
    besides: impl Fn(&Plan<ROUTES, LENGTH, 1, 1>, &State<ROUTES, 1>, Train, bool) -> bool,
) -> Option<Scene> {
    let (layout, mut before) = any_device(e)?;
    let input = any_input(e);
    let plan = *layout.plan();
    let (route, segment) = (plan.routes[0], plan.segments[0]);
    let ground = Ground::of(&plan);
    let path = ground.path();
    // Rules of engineering: LAY-2.
    let apart =
        (path & route.overlap.circuits.bits() | (path | route.overlap.circuits.bits()) & route.entry.bits()) == 0;
    let engineered = route.exists()
        && !route.cab_signalled
        && route.entry.is_one()
        && apart
        && (!ground.out || segment.length > 0 && segment.throat == route.last() && route.overlap.circuits.is_empty());
    e.assume(engineered);
    let earlier = Train::any(e);
    e.assume(earlier.is_one(&ground));
    if !engineered || !earlier.is_one(&ground) {
        return None;
    }
    // Where nothing else is drawn, what the train needs is unswept.
    let whole = before.unswept.circuits == CircuitSet::ALL;
    let own = needed(earlier, &ground).circuits;
    before.unswept.circuits = if whole { CircuitSet::ALL } else { before.unswept.circuits.or(own) };
    let gone = any_flag(e, "the train has left the line (odd: yes)") && ground.out && earlier.tail >= ground.over;
    let invariant = holds(earlier, &ground, &before) && besides(&plan, &before, earlier, gone);
    e.assume(invariant);
    let train = earlier.moves(e, &ground);
    let left = gone || any_flag(e, "the train leaves the line (odd: yes)") && ground.out && train.tail >= ground.over;
    let occupied = input.occupied;
    e.suppose("loss-of-shunt-within-clear", left || train.is_reported(&ground, occupied));
    // Nobody passes a signal by what he saw before the start when that is over, nor is unreported since.
    let unseen = train.front == FIRST && train.late > 0;
    let ends = u32::from(train.late) + u32::from(before.started.0) < u32::from(ground.start);
    e.suppose("start-outlasts-running", !unseen || ends);
    let (after, output) = layout.interlock(before, input);
    Some(Scene { plan, ground, earlier, train, left: (gone, left), before, after, input, output })
}

impl Scene {
    /// The routes that are reserved in this cycle, by number.
    pub(super) fn is_reserved(&self, number: usize) -> bool {
        let asked = matches!(self.input.request, Some(Request::Set(asked)) if usize::from(asked.number()) == number);
        asked && self.output.answer == Some(Ok(())) && self.before.routes[number].phase == Phase::Idle
    }

    /// From where on a route may begin for the train. Its front may just have left the circuit where it begins, and not be reported.
    pub(super) const fn from(&self) -> u8 {
        if self.train.late > 0 { self.train.front.wrapping_sub(1) } else { self.train.front }
    }
}

/// What a route holds of circuits, and what is beside these.
pub(super) fn holding(route: &Route<LENGTH>, state: RouteState) -> Element {
    both(held(route, state), kept(route, state))
}

/// Where the train is in its path.
pub(super) fn under(train: Train, ground: &Ground) -> CircuitSet {
    let mut under = 0;
    for (position, element) in (FIRST..).zip(&ground.route.path) {
        let there = train.tail <= position && position <= train.front && position <= ground.last;
        under |= if there { element.circuits.bits() } else { 0 };
    }
    CircuitSet::from_bits(under)
}

/// Whether the line is given to nobody who comes in, and no block is confirmed there, while the train is on its way out.
pub(super) fn quiet(ground: &Ground, device: &State<ROUTES, 1>, left: bool) -> bool {
    let directions = device.directions;
    let given = (directions.toward.bits() | directions.came.bits()) & 1 == 1;
    !ground.goes_out(left) || !given && !device.works.confirmed.meets(ground.line)
}

/// Whether no block is confirmed on what the train needs, or under it, and no route holds it but one that begins in its path.
pub(super) fn free(plan: &Plan<ROUTES, LENGTH, 1, 1>, device: &State<ROUTES, 1>, train: Train) -> bool {
    let ground = Ground::of(plan);
    let ahead = needed(train, &ground).circuits;
    let mut free = !device.works.confirmed.meets(ahead.or(under(train, &ground)));
    for (other, state) in plan.routes.iter().zip(&device.routes) {
        free &= !holding(other, *state).circuits.meets(ahead) || begins(other, &ground, FIRST);
    }
    free
}

/// The same of what is beside that.
pub(super) fn aside(plan: &Plan<ROUTES, LENGTH, 1, 1>, device: &State<ROUTES, 1>, train: Train) -> bool {
    let ground = Ground::of(plan);
    let ahead = needed(train, &ground);
    let mut aside = !device.works.confirmed.meets(ahead.beside);
    for (other, state) in plan.routes.iter().zip(&device.routes) {
        aside &= !fouls(&ahead, &holding(other, *state)) || begins(other, &ground, FIRST);
    }
    aside
}
