//! One route: how it follows its train and is released (T-ILK-5, 6, 7), and how it is reserved (T-ILK-2).
//!
//! A route's own step looks at nothing but the route and the circuits that count as occupied (`t_ilk_1_local`), so one route stands
//! for all 64.

use super::any::{PLACES, any_circuits, any_route_state, any_routes_layout, bit, held, kept};
use crate::Engine;
use crate::engine::any_flag;
use atc_kernel::interlocking::{CircuitSet, Phase, Rear, Route, RouteState};

pub const BOUND: &str = match PLACES {
    16 => "1 route, 32 circuits, 16 points",
    8 => "1 route of up to 8 circuits, 32 circuits, 16 points",
    _ => "1 route of another number of circuits than the 16 of the machine",
};

/// The places of a path where Kani has no answer for all of them in its time.
const FEWER: usize = if cfg!(kani) && PLACES > 8 { 8 } else { PLACES };

/// A route that the constructor accepts, a valid state of it, and the circuits that count as occupied.
struct Scene<const P: usize> {
    route: Route<P>,
    before: RouteState,
    occupied: CircuitSet,
}

fn any_scene<E: Engine + ?Sized, const P: usize>(e: &mut E) -> Option<Scene<P>> {
    let [route] = any_routes_layout::<E, 1, P>(e)?.plan().routes;
    let before = any_route_state(e);
    let valid = before.is_valid(&route);
    e.assume(valid);
    let occupied = any_circuits(e, "occupied (bits)", 0..=15);
    valid.then_some(Scene { route, before, occupied })
}

impl<const P: usize> Scene<P> {
    /// Whether the circuit at `place` of the path is occupied; not where there is no such place.
    fn is_occupied(&self, place: u8) -> bool {
        let mut occupied = false;
        for (number, element) in (0_u8..).zip(&self.route.path) {
            occupied |=
                number == place && place < self.route.length && element.circuits.bits() & self.occupied.bits() != 0;
        }
        occupied
    }

    /// Whether some circuit that is held of the path is occupied.
    fn path_occupied(&self, state: RouteState) -> bool {
        held(&self.route, state).circuits.bits() & self.occupied.bits() != 0
    }

    fn overlap_occupied(&self, state: RouteState) -> bool {
        kept(&self.route, state).circuits.bits() & self.occupied.bits() != 0
    }

    fn entry_occupied(&self) -> bool {
        self.route.entry.bits() & self.occupied.bits() != 0
    }

    /// Whether the approach but the entry is occupied.
    fn is_awaited(&self) -> bool {
        self.route.approach.bits() & !self.route.entry.bits() & self.occupied.bits() != 0
    }

    /// Whether a release time that runs is over.
    fn is_over(&self) -> bool {
        let runs = self.before.phase == Phase::InUse || self.before.phase == Phase::Releasing;
        runs && self.before.time.0 >= self.route.release.0.wrapping_sub(1)
    }

    /// Whether the rear is swept by the end of the cycle: it was, nobody can be there, or the time is over.
    fn is_swept(&self) -> bool {
        let ended = self.before.phase != Phase::Set || self.path_occupied(self.before);
        let clear = !self.entry_occupied() && (self.before.rear == Rear::Entry || !self.is_awaited());
        ended && (self.before.rear == Rear::Swept || clear || self.is_over())
    }
}

harness! {
    /// A train is followed in the order of the path, and what it has not left behind stays locked.
    t_ilk_5(e)
    theorem "T-ILK-5";
    requirements ["ILK-9", "ILK-10", "ILK-11", "ILK-22"];
    assumptions [];
    bound BOUND;
    cases 1;
    unwind 65 = 1 + crate::interlocking::LONGEST;
    under_kani "1 route of up to 8 circuits, 32 circuits, 16 points";
    claims {
        Entered: "the head goes on by at most one place, and only to an occupied one with the one before it (or the entry, but on a calling-on route nothing) occupied",
        Released: "the tail goes on by at most one place: one that was entered, is clear, and behind one that was entered or, at the end, a circuit beyond that is occupied; and only once the rear is swept",
        Unproved: "a route that was never set follows no train",
        Idle: "a route becomes idle only when its whole path and its overlap are released, or its release time is over and all that it held is clear, but the berth of a calling-on route that nobody has entered",
        Only: "nothing is held after the cycle that was not held before it",
        Valid: "the state stays valid",
    }
    covers {
        On: "a train enters a place that is not the first",
        Behind: "a place is released behind a train",
        Away: "the last place is released, and the route becomes idle",
        Expired: "a release time is over, and the route becomes idle",
    }
    {
        let Some(scene) = any_scene::<E, FEWER>(e) else { return };
        let (route, before) = (&scene.route, scene.before);
        let after = before.follow(route, scene.occupied);
        let idle = after.phase == Phase::Idle;
        let was_held = before.phase != Phase::Idle;
        let previous = if before.head == 0 {
            route.calling_on || route.entry.bits() & scene.occupied.bits() != 0
        } else {
            scene.is_occupied(before.head - 1)
        };
        let entered = after.head == before.head + 1 && scene.is_occupied(before.head) && previous;
        e.claim(Claim::Entered as u32, idle || after.head == before.head || entered);
        let head = if before.head < route.length && scene.is_occupied(before.head) && previous { before.head + 1 } else { before.head };
        let gone_on = if before.tail + 1 == route.length {
            route.beyond.bits() & scene.occupied.bits() != 0
        } else {
            head >= before.tail + 2
        };
        let released = was_held && before.tail < head && !scene.is_occupied(before.tail) && gone_on && scene.is_swept();
        e.claim(Claim::Released as u32, idle || after.tail == before.tail || after.tail == before.tail + 1 && released);
        let still = after.head == 0 && after.tail == 0 && after.overlap;
        e.claim(Claim::Unproved as u32, before.proved || idle || still);
        let over = before.phase == Phase::Releasing && u32::from(before.time.0) + 1 >= u32::from(route.release.0);
        let unused = route.calling_on && (head == 0 || !before.proved);
        let all_clear = !scene.path_occupied(before) && (!scene.overlap_occupied(before) || unused);
        // The last place may be released in this very cycle, and the overlap with it.
        let last = before.tail + 1 >= route.length && released || before.tail == route.length;
        let kept_clear = route.overlap.circuits.bits() & scene.occupied.bits() == 0;
        let left = last && (!before.overlap || kept_clear);
        let remaining_clear = over && (all_clear || released && !scene.overlap_occupied(before));
        e.claim(Claim::Idle as u32, !(was_held && idle) || left || remaining_clear);
        let circuit = bit(e.word("a circuit that stands for all (number)", 0..=15));
        let point = bit(e.word("a point that stands for all (number)", 0..=1));
        let more = |one: u64, other: u64, it: u64| other & it != 0 && one & it == 0;
        let (paths, overlaps) = ((held(route, before), held(route, after)), (kept(route, before), kept(route, after)));
        let points = |one: u32, other: u32| more(u64::from(one), u64::from(other), point);
        let only = !more(paths.0.circuits.bits(), paths.1.circuits.bits(), circuit)
            && !more(overlaps.0.circuits.bits(), overlaps.1.circuits.bits(), circuit)
            && !points(paths.0.positions.normal.bits(), paths.1.positions.normal.bits())
            && !points(paths.0.positions.reverse.bits(), paths.1.positions.reverse.bits())
            && !points(overlaps.0.positions.normal.bits(), overlaps.1.positions.normal.bits())
            && !points(overlaps.0.positions.reverse.bits(), overlaps.1.positions.reverse.bits());
        e.claim(Claim::Only as u32, only);
        e.claim(Claim::Valid as u32, after.is_valid(route));
        e.cover(Cover::On as u32, !idle && before.head > 0 && after.head > before.head);
        e.cover(Cover::Behind as u32, !idle && after.tail > before.tail);
        e.cover(Cover::Away as u32, was_held && idle && !over);
        e.cover(Cover::Expired as u32, was_held && idle && over && all_clear);
    }
}

harness! {
    /// What a train stands on, or what it has not left, is never released by the train's own movement; and a train on the path ends the
    /// proceed aspect.
    t_ilk_5_occupied(e)
    theorem "T-ILK-5";
    requirements ["ILK-10", "ILK-6"];
    assumptions [];
    bound BOUND;
    cases 1;
    unwind 65 = 1 + crate::interlocking::LONGEST;
    claims {
        Occupied: "a circuit of the held path that is occupied stays held",
        Ended: "a route with an occupied circuit on its path is not set after the cycle",
        Again: "a route that was not set does not become set by following a train",
    }
    covers {
        Stays: "an occupied circuit stays held while another is released",
        Ends: "a proceed aspect ends",
    }
    {
        let Some(scene) = any_scene::<E, PLACES>(e) else { return };
        let (route, before) = (&scene.route, scene.before);
        let after = before.follow(route, scene.occupied);
        let circuit = bit(e.word("a circuit that stands for all (number)", 0..=15));
        let stood = held(route, before).circuits.bits() & scene.occupied.bits() & circuit != 0;
        e.claim(Claim::Occupied as u32, !stood || held(route, after).circuits.bits() & circuit != 0);
        e.claim(Claim::Ended as u32, !scene.path_occupied(before) || after.phase != Phase::Set);
        e.claim(Claim::Again as u32, before.phase == Phase::Set || after.phase != Phase::Set);
        e.cover(Cover::Stays as u32, stood && after.tail > before.tail);
        e.cover(Cover::Ends as u32, before.phase == Phase::Set && after.phase == Phase::InUse);
    }
}

harness! {
    /// An overlap is held until the train has stood for the stay time, has gone, or the route is released; the time a withdrawn route stays
    /// locked is counted cycle by cycle.
    t_ilk_7(e)
    theorem "T-ILK-7";
    requirements ["ILK-14", "ILK-13"];
    assumptions [];
    bound BOUND;
    cases 1;
    unwind 65 = 1 + crate::interlocking::LONGEST;
    under_kani "1 route of up to 8 circuits, 32 circuits, 16 points";
    claims {
        Overlap: "an overlap is given up only when it is clear, and the path is released, or the last place, entered in order, has been occupied for the stay time since every earlier one was released; or when the release time is over",
        Stood: "the time of standing goes on by one up to the stay time while the train stands on the last place, with every earlier one released and the rear swept, and starts again when that clears",
        Locked: "a withdrawn route stays withdrawn and locked, its time going on by one, until the release time is over or its train has left it",
        Used: "the time of a route in use goes on by one up to the release time, from the cycle in which it came into use",
    }
    covers {
        Given: "an overlap is given up while the train stands",
        Again: "the time of standing starts again",
        Longer: "a withdrawn route with a train in it stays withdrawn when its release time is over",
    }
    {
        let Some(scene) = any_scene::<E, FEWER>(e) else { return };
        let (route, before) = (&scene.route, scene.before);
        let after = before.follow(route, scene.occupied);
        let idle = after.phase == Phase::Idle;
        let follows = before.proved && before.phase != Phase::Idle;
        let last_occupied = scene.is_occupied(route.length.wrapping_sub(1));
        let previous = if before.head == 0 {
            route.calling_on || route.entry.bits() & scene.occupied.bits() != 0
        } else {
            scene.is_occupied(before.head - 1)
        };
        let arrived = before.head == route.length || before.head + 1 == route.length && last_occupied && previous;
        let begun = after.tail > 0 || before.stood.0 > 0 || !scene.entry_occupied();
        let alone = after.tail == route.length.wrapping_sub(1) && scene.is_swept() && begun && !route.calling_on;
        let stands = follows && before.overlap && arrived && alone && last_occupied;
        let given = before.overlap && !after.overlap && !idle;
        let long = stands && before.stood.0 >= route.stay.0.wrapping_sub(1);
        let kept_clear = route.overlap.circuits.bits() & scene.occupied.bits() == 0;
        let gone = follows && after.tail == route.length && kept_clear;
        e.claim(Claim::Overlap as u32, !given || kept_clear && (long || gone));
        let longer = if before.stood.0 < route.stay.0 { before.stood.0 + 1 } else { before.stood.0 };
        let counts = if after.overlap && stands { longer } else { 0 };
        e.claim(Claim::Stood as u32, idle || after.stood.0 == counts);
        let withdrawn = before.phase == Phase::Releasing;
        let over = withdrawn && scene.is_over();
        let later = if before.time.0 < route.release.0 { before.time.0 + 1 } else { before.time.0 };
        let goes_on = after.phase == Phase::Releasing && after.time.0 == later;
        let left = before.proved && before.tail + 1 >= route.length && before.head >= before.tail;
        e.claim(Claim::Locked as u32, !withdrawn || goes_on || idle && (over || left));
        let used = if before.phase == Phase::Set { 0 } else { later };
        e.claim(Claim::Used as u32, after.phase != Phase::InUse || after.time.0 == used);
        e.cover(Cover::Given as u32, given && long);
        e.cover(Cover::Again as u32, before.stood.0 > 0 && !idle && after.overlap && after.stood.0 == 0);
        e.cover(Cover::Longer as u32, over && after.phase == Phase::Releasing);
    }
}

harness! {
    /// Approach locking: a route is withdrawn at once only where nobody can be coming, and otherwise stays locked for the release time.
    t_ilk_6(e)
    theorem "T-ILK-6";
    requirements ["ILK-12"];
    assumptions [];
    bound BOUND;
    cases 1;
    unwind 65 = 1 + crate::interlocking::LONGEST;
    claims {
        Once: "a withdrawn route is released at once only if its path is clear and it was provisional or failed, or set with a clear approach",
        Otherwise: "otherwise the release time starts anew and everything stays held",
        Valid: "the state stays valid",
    }
    covers {
        Set: "a set route with a clear approach is released",
        Near: "a set route with a train on its approach stays locked",
        Again: "a route that is withdrawn already is withdrawn again",
    }
    {
        let Some(scene) = any_scene::<E, PLACES>(e) else { return };
        let (route, before) = (&scene.route, scene.before);
        e.assume(before.phase != Phase::Idle);
        let after = before.withdraw(route, scene.occupied);
        let near = route.approach.bits() & scene.occupied.bits() != 0;
        let path_clear = !scene.path_occupied(before);
        let early = before.phase == Phase::Provisional || before.phase == Phase::Failed;
        let once = path_clear && (early || before.phase == Phase::Set && !near);
        e.claim(Claim::Once as u32, (after.phase == Phase::Idle) == once);
        let same = after.tail == before.tail && after.head == before.head && after.overlap == before.overlap && after.proved == before.proved && after.rear == before.rear;
        e.claim(Claim::Otherwise as u32, once || after.phase == Phase::Releasing && after.time.0 == 0 && same);
        e.claim(Claim::Valid as u32, after.is_valid(route));
        e.cover(Cover::Set as u32, before.phase == Phase::Set && once);
        e.cover(Cover::Near as u32, before.phase == Phase::Set && near && path_clear);
        e.cover(Cover::Again as u32, before.phase == Phase::Releasing && before.time.0 > 0);
    }
}

harness! {
    /// Reservation: only after detection; a point that does not arrive makes the route fail; and a route with all in place advances.
    t_ilk_2(e)
    theorem "T-ILK-2";
    requirements ["ILK-5", "ILK-21"];
    assumptions [];
    bound BOUND;
    cases 1;
    unwind 65 = 1 + crate::interlocking::LONGEST;
    claims {
        Set: "a provisional route becomes set in the cycle in which all is ready, and in no other",
        Failed: "a provisional route that is not ready when the drive time is over has failed, and not before",
        Others: "a route in any other phase stays as it is",
        Rear: "the rear of a route that becomes set is the approach, or the entry where all trains are cab-signalled and none waits on the approach while the entry is clear",
        Valid: "the state stays valid",
    }
    covers {
        Set: "a route becomes set",
        Failed: "a route fails",
        Waits: "a route waits for its points",
    }
    {
        let Some(scene) = any_scene::<E, PLACES>(e) else { return };
        let (route, before) = (&scene.route, scene.before);
        let ready = any_flag(e, "all is ready (odd: yes)");
        let after = before.reserve(route, scene.occupied, ready);
        let provisional = before.phase == Phase::Provisional;
        let late = u32::from(before.time.0) + 1 >= u32::from(route.drive.0);
        e.claim(Claim::Set as u32, !provisional || (after.phase == Phase::Set) == ready);
        e.claim(Claim::Failed as u32, !provisional || (after.phase == Phase::Failed) == (!ready && late));
        let same = after.phase == before.phase && after.time == before.time && after.proved == before.proved;
        let held = after.tail == before.tail && after.head == before.head && after.overlap == before.overlap;
        e.claim(Claim::Others as u32, held && (provisional || same));
        let waits = !route.cab_signalled || scene.is_awaited() && !scene.entry_occupied();
        let rear = if waits { Rear::Approach } else { Rear::Entry };
        e.claim(Claim::Rear as u32, !(provisional && ready) || after.rear == rear);
        e.claim(Claim::Valid as u32, after.is_valid(route));
        e.cover(Cover::Set as u32, provisional && after.phase == Phase::Set);
        e.cover(Cover::Failed as u32, provisional && after.phase == Phase::Failed);
        e.cover(Cover::Waits as u32, provisional && after.phase == Phase::Provisional);
    }
}
