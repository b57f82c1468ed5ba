//! Two trains and one line (T-ILK-9): one that the neighbour has sent, and one that was let out, are never on their way to it together.
//!
//! The accidents: two trains meet on plain line; a train of either side runs into a circuit of the line whose block was confirmed.
//! The train that goes out is that of T-ILK-10 ([`super::train`]). What comes in is seen when it is reported on the line, and not before.

use super::any::any_circuits;
use super::scene::{BOUND, BUILT_IN, Beside, FIRST, LENGTH, ROUTES, Scene, Train, UNDER_KANI, any_scene};
use crate::Engine;
use crate::engine::any_flag;
use atc_kernel::interlocking::{CircuitSet, Directions, Plan, SegmentSet, State};
use atc_kernel::time::Ticks;

const SEGMENTS: usize = 1;

/// How the two trains are, by construction.
const LINE_BUILT_IN: &[(&str, &str)] = &[
    BUILT_IN[0],
    BUILT_IN[1],
    BUILT_IN[2],
    BUILT_IN[3],
    BUILT_IN[4],
    (
        "turn-outlasts-telegrams",
        "what the neighbour sends by a permission is reported no later than in the cycle after the turn time since this station last gave it",
    ),
    ("neighbour-turns-alike", "the neighbour sends only while it may count on this station's permission"),
    (
        "views-of-a-line-meet",
        "a train that has left this station's view of the line is looked at no more: the neighbour sees it",
    ),
];

/// The trains of the neighbour, as far as they may be on their way in.
#[derive(Clone, Copy, Debug)]
struct Inbound {
    /// For how many cycles more one may come on to the line that is not seen yet.
    coming: u16,
    /// Whether one is on the line or in the throat, and seen there.
    on: bool,
}

impl Inbound {
    fn any<E: Engine + ?Sized>(e: &mut E) -> Self {
        Self { coming: e.word("one may come in for (cycles)", 0..=1), on: any_flag(e, "one has come in (odd: yes)") }
    }

    /// One cycle, before the device reads: what comes may be on the line now, and what is there may have left it.
    fn moves<E: Engine + ?Sized>(self, e: &mut E) -> Self {
        let comes = any_flag(e, "one comes on to the line (odd: yes)") && self.coming > 0;
        let leaves = any_flag(e, "none is on the line any more (odd: yes)");
        Self { coming: self.coming.saturating_sub(1), on: comes || self.on && !leaves }
    }

    const fn is_there(self) -> bool {
        self.coming > 0 || self.on
    }
}

/// The circuits of the line.
fn line(scene: &Scene<ROUTES, 0, SEGMENTS>) -> CircuitSet {
    let segment = scene.plan.segments[0];
    let mut line = 0;
    for (place, circuit) in (0..).zip(segment.circuits) {
        line |= if place < segment.length { circuit.bits() } else { 0 };
    }
    CircuitSet::from_bits(line)
}

/// Whether the train is on its way out to the line, or on it.
fn goes_out(scene: &Scene<ROUTES, 0, SEGMENTS>, train: &Train, left: bool) -> bool {
    scene.route.to.bits() & 1 == 1 && train.counts() && !left
}

/// The invariant: what the device remembers of the line while trains are on their way. A device that has just started satisfies it.
fn holds(scene: &Scene<ROUTES, 0, SEGMENTS>, device: &State<ROUTES, SEGMENTS>, inbound: Inbound, out: bool) -> bool {
    let directions = &device.directions;
    let (away, toward) = (directions.away.bits() & 1 == 1, directions.toward.bits() & 1 == 1);
    let quiet = !device.works.confirmed.meets(line(scene));
    let waited = u32::from(inbound.coming) + u32::from(directions.withdrawn[0].0);
    let mut holds = inbound.coming == 0 || waited <= u32::from(scene.plan.turn.0) + 1;
    holds &= !inbound.is_there() || !away && !out && quiet;
    holds & (!out || !toward && directions.came.bits() & 1 == 0 && quiet)
}

/// What a valid state promises of directions, blocks and held routes.
fn is_valid(scene: &Scene<ROUTES, 0, SEGMENTS>, device: &State<ROUTES, SEGMENTS>) -> bool {
    let directions = &device.directions;
    let works = device.works.is_valid() && directions.is_valid(scene.plan.turn);
    let mut need = false;
    for (route, state) in scene.plan.routes.iter().zip(&device.routes) {
        need |= state.is_held() && route.to.bits() & 1 == 1;
    }
    works && (!need || directions.away.bits() & 1 == 1)
}

/// Any directions of the line, and any circuits of it that are confirmed.
fn any_line<E: Engine + ?Sized>(e: &mut E, plan: &mut Plan<ROUTES, LENGTH, 0, SEGMENTS>) -> Beside<SEGMENTS> {
    // Rules of engineering, kept from the start: a route out ends before the line.
    if plan.routes[0].to.bits() & 1 == 1 {
        plan.segments[0].throat = plan.routes[0].last();
    }
    let (toward, away) = match e.word("direction (0 none, 1 towards the station, else away)", 0..=2) {
        0 => (0, 0),
        1 => (1, 0),
        _ => (0, 1),
    };
    let came = u8::from(any_flag(e, "it was last towards the station (odd: yes)"));
    let time = e.word("permission withdrawn for (cycles)", 0..=2);
    let withdrawn = match (toward, away) {
        (1, _) => Ticks(0),
        (_, 1) => plan.turn,
        _ => Ticks(time),
    };
    let directions = Directions {
        toward: SegmentSet::from_bits(toward),
        away: SegmentSet::from_bits(away),
        came: SegmentSet::from_bits(toward | came & !away),
        withdrawn: [withdrawn],
    };
    Beside { directions, confirmed: any_circuits(e, "confirmed (bits)", 0..=0), ..Beside::NOTHING }
}

harness! {
    /// A train that the neighbour has sent, or may send by a permission that it still counts on, and one that was let out or may still go out
    /// are never on their way to one line together; and no circuit of the line is confirmed to staff while either is.
    t_ilk_train_line(e)
    theorem "T-ILK-9";
    requirements ["ILK-16", "ILK-17", "ILK-18", "ILK-19", "ILK-20", "ILK-25", "ILK-26"];
    assumptions [
        "loss-of-shunt-within-clear", "approach-covers-braking", "release-covers-residual-running", "overlap-covers-sliding", "trains-obey-signals",
        "all-cab-signalled", "path-complete", "train-whole", "no-setting-back", "start-outlasts-running",
        "turn-outlasts-telegrams", "neighbour-turns-alike", "views-of-a-line-meet",
    ];
    built_in LINE_BUILT_IN;
    bound BOUND;
    cases 1;
    unwind 65 = 1 + crate::interlocking::LONGEST;
    under_kani UNDER_KANI;
    claims {
        Meet: "no train may be on its way out while one is on its way in",
        Sent: "while one is on its way in, no signal to the line shows proceed, and no telegram grants it",
        Permits: "while one is on its way out, the neighbour is not permitted to send",
        Worker: "while either is, no circuit of the line is confirmed",
        Holds: "the invariant",
        Start: "which a device that starts at this moment satisfies, too",
    }
    covers {
        Out: "a train is on the line, and its route is released",
        In: "a train has come in that may be seen for the first time",
        Last: "the line is turned outward in the first cycle in which no train can come in",
        Worker: "a circuit of the line becomes confirmed after a train has come in and left",
    }
    {
        let Some(scene) = any_scene::<E, ROUTES, 0, SEGMENTS>(e, any_line) else { return };
        let (device, end) = &scene.devices;
        let (ground, segment) = (&scene.ground, scene.plan.segments[0]);
        let out = scene.route.to.bits() & 1 == 1;
        // A rule of engineering: a route out ends before the line.
        e.assume(segment.length > 0 && (!out || segment.throat.contains(scene.route.last())));
        let left = any_flag(e, "the train has left the line (odd: yes)");
        let earlier = Inbound::any(e);
        let before = goes_out(&scene, &scene.earlier, left);
        e.assume((!left || scene.earlier.tail >= ground.over) && is_valid(&scene, device));
        e.assume(holds(&scene, device, earlier, before));
        let inbound = earlier.moves(e);
        let leaves = any_flag(e, "the train leaves the line (odd: yes)");
        let left = left || leaves && scene.train.tail >= ground.over;
        let occupied = scene.input.occupied;
        let (line, throat) = (line(&scene), segment.throat);
        // Beyond its route the train is reported on the line.
        let beyond = out && !left && scene.train.seen().0 >= ground.over;
        e.suppose("loss-of-shunt-within-clear", !beyond || occupied.meets(line));
        e.suppose("loss-of-shunt-within-clear", !inbound.on || occupied.meets(line.or(throat)));
        let permitted = scene.output.permits.bits() & 1 == 1;
        // The life of the permission ends after its last cycle, and from then on a train that was sent may run on, unseen at the last.
        let last = scene.plan.turn.0.saturating_add(1);
        let later = Inbound { coming: if permitted { last } else { inbound.coming }, ..inbound };
        let after = goes_out(&scene, &scene.informed, left);
        let contents = scene.output.table.parts().2;
        e.claim(Claim::Meet as u32, !(later.is_there() && after));
        let mut sent = contents.away.bits() & 1 == 1;
        for (number, route) in scene.plan.routes.iter().enumerate() {
            sent |= route.to.bits() & 1 == 1 && scene.output.proceed.bits() >> number & 1 == 1;
        }
        e.claim(Claim::Sent as u32, !later.is_there() || !sent);
        e.claim(Claim::Permits as u32, !after || !permitted);
        let reached = scene.output.confirmed.meets(line);
        e.claim(Claim::Worker as u32, !(later.is_there() || after) || !reached);
        e.claim(Claim::Holds as u32, holds(&scene, end, later, after) && is_valid(&scene, end));
        e.claim(Claim::Start as u32, holds(&scene, &State::INITIAL, later, after));
        e.cover(Cover::Out as u32, after && scene.informed.front >= FIRST && !scene.after.is_held());
        e.cover(Cover::In as u32, later.on && !earlier.on && later.coming == 0);
        let turned = end.directions.away.bits() & !device.directions.away.bits() & 1 == 1;
        e.cover(Cover::Last as u32, turned && scene.plan.turn.0 > 1 && !left);
        e.cover(Cover::Worker as u32, reached && !device.works.confirmed.meets(line) && earlier.on);
    }
}
