//! Signals and grants of one route (T-ILK-3, T-ATC-1).

use super::any::{any_circuits, any_positions, any_route_state, any_routes_layout, any_segments, held, kept};
use crate::Engine;
use atc_kernel::interlocking::{CircuitSet, Grant, Phase, Route, RouteState, View, grant, ready, shows_proceed};

/// The places of a path: half of the machine's, since what is granted is a second path to go through.
const PLACES: usize = if super::PLACES > 8 { 8 } else { super::PLACES };

pub const BOUND: &str = match PLACES {
    8 => "1 route of up to 8 circuits, 32 circuits, 16 points",
    _ => "1 route of another number of circuits than the 16 of the machine",
};

/// The places of a path where Kani has no answer for all of them in its time.
const FEWER: usize = if cfg!(kani) && PLACES > 4 { 4 } else { PLACES };

/// A route in a valid state, and what its signal looks at.
struct Scene<const P: usize> {
    route: Route<P>,
    state: RouteState,
    view: View,
}

fn any_scene<E: Engine + ?Sized, const P: usize>(e: &mut E) -> Option<Scene<P>> {
    let [route] = any_routes_layout::<E, 1, P>(e)?.plan().routes;
    let state = any_route_state(e);
    let valid = state.is_valid(&route);
    e.assume(valid);
    let view = View {
        occupied: any_circuits(e, "occupied (bits)", 0..=15),
        blocked: any_circuits(e, "blocked (bits)", 0..=0),
        closed: any_segments(e, "segments with a blocked circuit (bits)"),
        firm: any_positions(e),
    };
    valid.then_some(Scene { route, state, view })
}

harness! {
    /// A signal shows proceed exactly while its route is set, all that it holds, and what is beside that, is clear, but for a berth, and unblocked, and every point that it needs, in
    /// path, flank and overlap, is detected in position and not being driven.
    t_ilk_3(e)
    theorem "T-ILK-3";
    requirements ["ILK-7", "ILK-37"];
    assumptions [];
    bound BOUND;
    cases 1;
    unwind 65 = 1 + crate::interlocking::LONGEST;
    claims {
        Set: "proceed is shown only for a set route: no train has entered it",
        Clear: "no circuit of path or overlap, or beside them, is occupied, but one of a berth, or blocked, no segment that the route leads to is blocked, and no circuit of the approach with a train behind the entry",
        Points: "every point of path, flank and overlap is detected in the position that it is needed in, and undriven",
        Shown: "and if all this is so, proceed is shown",
    }
    covers {
        Proceed: "proceed is shown over several circuits with a point",
        Suspended: "a set route shows stop because of a point",
    }
    {
        let Some(Scene { route, state, view }) = any_scene::<E, PLACES>(e) else { return };
        let proceed = shows_proceed(&route, state, view);
        let mine = (held(&route, state), kept(&route, state));
        let circuits = mine.0.circuits.bits() | mine.1.circuits.bits();
        let beside = mine.0.beside.bits() | mine.1.beside.bits();
        let normal = mine.0.positions.normal.bits() | mine.1.positions.normal.bits();
        let reverse = mine.0.positions.reverse.bits() | mine.1.positions.reverse.bits();
        let set = state.phase == Phase::Set && state.head == 0 && state.tail == 0 && state.proved;
        let clear = if route.calling_on { mine.0.circuits.bits() } else { circuits } | beside;
        let unblocked = (circuits | beside) & view.blocked.bits() == 0 && route.to.bits() & view.closed.bits() == 0;
        let behind = route.approach.bits() & !route.entry.bits() & view.occupied.bits() != 0;
        let cut_off = behind && route.approach.bits() & view.blocked.bits() != 0;
        let clear = clear & view.occupied.bits() == 0 && unblocked && !cut_off;
        let points = normal & !view.firm.normal.bits() == 0 && reverse & !view.firm.reverse.bits() == 0;
        e.claim(Claim::Set as u32, !proceed || set);
        e.claim(Claim::Clear as u32, !proceed || clear);
        e.claim(Claim::Points as u32, !proceed || points);
        e.claim(Claim::Shown as u32, proceed || !(state.phase == Phase::Set && clear && points));
        e.cover(Cover::Proceed as u32, proceed && route.length > 2 && normal | reverse != 0);
        e.cover(Cover::Suspended as u32, state.phase == Phase::Set && clear && !points);
    }
}

harness! {
    /// More occupancy never makes a route show proceed: with more circuits occupied in a cycle, a route that was held before it shows
    /// proceed after it only if it would have with fewer.
    t_ilk_3_monotone(e)
    theorem "T-ILK-3";
    requirements ["ILK-6", "ILK-7"];
    assumptions [];
    bound BOUND;
    cases 1;
    unwind 65 = 1 + crate::interlocking::LONGEST;
    solver kissat;
    under_kani "1 route of up to 4 circuits, 32 circuits, 16 points";
    claims {
        Safer: "proceed with more circuits occupied is proceed with fewer",
    }
    covers {
        Proceed: "proceed is shown with more circuits occupied",
        Lost: "proceed is shown with fewer, and not with more",
    }
    {
        let Some(Scene { route, state, view }) = any_scene::<E, FEWER>(e) else { return };
        e.assume(state.phase != Phase::Idle);
        let more = any_circuits(e, "occupied besides (bits)", 0..=15);
        let shown = |occupied: CircuitSet| {
            let view = View { occupied, ..view };
            let state = state.follow(&route, occupied);
            let all_there = ready(&route, state, view);
            shows_proceed(&route, state.reserve(&route, occupied, all_there), view)
        };
        let fewer = shown(view.occupied);
        let all = shown(CircuitSet::from_bits(view.occupied.bits() | more.bits()));
        e.claim(Claim::Safer as u32, fewer || !all);
        e.cover(Cover::Proceed as u32, all && more.bits() != 0);
        e.cover(Cover::Lost as u32, fewer && !all);
    }
}

/// What is found of the path, place by place, for a train at `front`: one more than the place of the last occupied circuit.
struct Found {
    front: u8,
    sound: bool,
    circuit: u64,
}

fn found<const P: usize>(scene: &Scene<P>) -> Found {
    let mut found = Found { front: 0, sound: false, circuit: 0 };
    for (place, element) in (0_u8..).zip(&scene.route.path) {
        let here = place >= scene.state.tail && place < scene.route.length;
        if here && element.circuits.bits() & scene.view.occupied.bits() != 0 {
            let normal = element.positions.normal.bits() & !scene.view.firm.normal.bits();
            let reverse = element.positions.reverse.bits() & !scene.view.firm.reverse.bits();
            let beside = element.beside.bits() & (scene.view.occupied.bits() | scene.view.blocked.bits());
            let sound = normal | reverse == 0 && beside == 0;
            found = Found { front: place + 1, sound, circuit: element.circuits.bits() };
        }
    }
    found
}

harness! {
    /// A route grants only circuits that it holds, to one train: the one at its entry while proceed is shown, and then the one that has entered
    /// in order, from the last circuit that is occupied.
    t_atc_1(e)
    theorem "T-ATC-1";
    requirements ["ATC-1", "ATC-10", "ATC-13", "ILK-37"];
    assumptions [];
    bound BOUND;
    cases 1;
    unwind 65 = 1 + crate::interlocking::LONGEST;
    claims {
        Own: "every circuit that is granted is in the held path",
        Free: "it is neither occupied nor blocked",
        Entry: "before entry the grant is for the entry circuit, and proceed is shown",
        Front: "after entry it is for the last occupied circuit of the path, which was entered in order, whose own points are in position, and with nothing beside it occupied or blocked",
        Nobody: "in any other phase nothing is granted",
        Last: "the last circuit is one that is granted; without any it is the train's, or there is no grant",
        Heading: "a grant is for the route's direction of travel",
        Out: "a grant of no circuit is for the train on the last circuit of a route out, which has entered it in order, whose points there are in position, and with nothing beside it occupied or blocked",
    }
    covers {
        Entry: "a train at the entry is granted a path",
        Under: "a train in the path is granted what is ahead",
        Never: "nothing is granted to a train that is in the path out of order",
        Out: "a train on the last circuit of a route out may go on to the line",
    }
    {
        let Some(scene) = any_scene::<E, PLACES>(e) else { return };
        let Scene { route, state, view } = &scene;
        let given = grant(route, *state, *view);
        let circuits = given.circuits.bits();
        let nothing = circuits == 0;
        e.claim(Claim::Own as u32, circuits & !held(route, *state).circuits.bits() == 0);
        e.claim(Claim::Free as u32, circuits & (view.occupied.bits() | view.blocked.bits()) == 0);
        let at_entry = state.phase == Phase::Set && given.train == route.entry && shows_proceed(route, *state, *view);
        e.claim(Claim::Entry as u32, nothing || state.phase != Phase::Set || at_entry);
        let train = found(&scene);
        let in_order = train.front > 0 && train.front <= state.head && train.sound;
        let at_front = given.train.bits() == train.circuit && in_order;
        e.claim(Claim::Front as u32, nothing || state.phase != Phase::InUse || at_front);
        e.claim(Claim::Nobody as u32, nothing || state.phase == Phase::Set || state.phase == Phase::InUse);
        let its = if nothing { given.train.bits() } else { circuits };
        e.claim(Claim::Last as u32, given.last.bits() & !its == 0 && (given.last.bits() == 0) == (given == Grant::NONE));
        e.claim(Claim::Heading as u32, given == Grant::NONE || given.heading == route.heading);
        let at_end = train.front == route.length && !route.to.is_empty() && state.phase == Phase::InUse;
        let out = nothing && given != Grant::NONE;
        e.claim(Claim::Out as u32, !out || at_end && at_front && given.complete && given.last == given.train);
        e.cover(Cover::Out as u32, out && route.length > 1);
        e.cover(Cover::Entry as u32, !nothing && state.phase == Phase::Set && route.length > 2);
        e.cover(Cover::Under as u32, !nothing && state.phase == Phase::InUse);
        e.cover(Cover::Never as u32, nothing && state.phase == Phase::InUse && train.front > state.head && state.head > 0);
    }
}

harness! {
    /// What is granted is one stretch: from the place ahead of the train on, each place sound, up to the last one, and complete exactly if that
    /// is the end of the path.
    t_atc_1_sound(e)
    theorem "T-ATC-1";
    requirements ["ATC-1", "ILK-37"];
    assumptions [];
    bound BOUND;
    cases 1;
    unwind 65 = 1 + crate::interlocking::LONGEST;
    claims {
        Sound: "the points of every place that is granted are in position, and nothing beside it is occupied or blocked",
        Stretch: "a place is granted only if every place between it and the train is",
        Beyond: "no place behind the train is granted",
        End: "a grant is complete exactly if its last circuit is the last of the path",
        Speed: "it carries the route's speed code, or that of stop if there is none",
    }
    covers {
        Short: "a grant ends before the end of the path",
        Whole: "a grant reaches the end of the path",
    }
    {
        let Some(scene) = any_scene::<E, PLACES>(e) else { return };
        let Scene { route, state, view } = &scene;
        let given = grant(route, *state, *view);
        let circuits = given.circuits.bits();
        let front = if state.phase == Phase::Set { 0 } else { found(&scene).front };
        let one = e.word("a place that stands for all (number)", 1..=3).to_le_bytes()[0];
        let mut sound = true;
        let mut mine = 0;
        let mut between = 0;
        let mut last = 0;
        for (place, element) in (0_u8..).zip(&route.path) {
            if place < route.length {
                last = element.circuits.bits();
                if place == one {
                    mine = element.circuits.bits();
                    let normal = element.positions.normal.bits() & !view.firm.normal.bits();
                    let reverse = element.positions.reverse.bits() & !view.firm.reverse.bits();
                    let beside = element.beside.bits() & (view.occupied.bits() | view.blocked.bits());
                    sound = normal | reverse == 0 && beside == 0;
                } else if place >= front && place < one {
                    between |= element.circuits.bits();
                }
            }
        }
        let granted = mine & circuits != 0;
        e.claim(Claim::Sound as u32, !granted || sound);
        e.claim(Claim::Stretch as u32, !granted || between & !circuits == 0);
        e.claim(Claim::Beyond as u32, !granted || one >= front);
        e.claim(Claim::End as u32, circuits == 0 || given.complete == (given.last.bits() == last));
        e.claim(Claim::Speed as u32, given == Grant::NONE && given.speed.0 == 0 || given.speed == route.speed);
        e.cover(Cover::Short as u32, granted && !given.complete);
        e.cover(Cover::Whole as u32, granted && given.complete);
    }
}

harness! {
    /// A circuit of a held overlap is granted to a train only by the route that continues there, and before that train has entered it, to a
    /// train on the last circuit before the overlap: the one that the overlap is for.
    t_atc_1_overlap(e)
    theorem "T-ATC-1";
    requirements ["LAY-1"];
    assumptions ["held-routes-compatible"];
    bound "2 routes of up to 4 circuits, 32 circuits";
    cases 1;
    unwind 65 = 1 + crate::interlocking::LONGEST;
    claims {
        Last: "a grant over a circuit of another route's held overlap, before entry, is for a train on that route's last circuit",
    }
    covers {
        Over: "a circuit of a held overlap is granted",
    }
    {
        let Some(layout) = any_routes_layout::<E, 2, 4>(e) else { return };
        let routes = &layout.plan().routes;
        let states = [any_route_state(e), any_route_state(e)];
        let valid = states[0].is_valid(&routes[0]) && states[1].is_valid(&routes[1]);
        e.assume(valid);
        let view = View {
            occupied: any_circuits(e, "occupied (bits)", 0..=0),
            blocked: any_circuits(e, "blocked (bits)", 0..=0),
            closed: any_segments(e, "segments with a blocked circuit (bits)"),
            firm: any_positions(e),
        };
        let under = kept(&routes[0], states[0]).circuits.bits();
        let path = held(&routes[1], states[1]).circuits.bits();
        // What T-ILK-1 says of any two routes that are held.
        e.suppose("held-routes-compatible", under & path == 0 || routes[0].continuing.bits() & 2 != 0);
        let given = grant(&routes[1], states[1], view);
        let over = valid && given.circuits.bits() & under != 0 && states[1].phase == Phase::Set;
        let mut last = 0;
        for (place, element) in (1_u8..).zip(&routes[0].path) {
            if place == routes[0].length {
                last = element.circuits.bits();
            }
        }
        e.claim(Claim::Last as u32, !over || given.train.bits() == last);
        e.cover(Cover::Over as u32, over);
    }
}
