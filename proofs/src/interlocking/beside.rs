//! Trains that foul each other without a common circuit (T-ILK-12): nothing stands, and nobody is sent, beside a train.
//!
//! The accident: the joint at a point is too near to it. A train stands in its track, clear of the circuit with the point, and its tail is in the way of
//! the other leg. A route over that leg is set, all of its own circuits being clear, and the second train strikes the first one's side.
//!
//! Who is beside the train is a second one that the kernel sees nothing of but an occupied circuit, or a route that is held for it.

use super::ahead::needed;
use super::any::{any_cycle, held, kept};
use super::pair::{TwoRoutes, any_two};
use super::scene::{BUILT_IN, Beside, FIRST, UNDER_KANI, any_scene};
use atc_kernel::interlocking::{CircuitSet, Element, Phase, Route, RouteState};

/// The places of a path in the harness of two routes of which one is asked for.
const FEWER: usize = if cfg!(any(small, kani)) { 2 } else { 3 };

pub const PAIR: &str = match FEWER {
    3 => "2 routes of up to 3 circuits, 32 circuits, 16 points",
    _ => "2 routes of up to 2 circuits, 32 circuits, 16 points",
};

/// That of the train, and another one, also of a wrong kernel; Kani has that of the train alone.
const ROUTES: usize = if cfg!(kani) { 1 } else { 2 };

pub const TRAIN: &str =
    if cfg!(small) { "2 routes of up to 2 circuits, 32 circuits" } else { "2 routes of up to 3 circuits, 32 circuits" };

/// What a route holds: of its path, and beyond it.
type Held = (Element, Element);

fn all<const P: usize>(route: &Route<P>, state: RouteState) -> Held {
    (held(route, state), kept(route, state))
}

/// Whether a circuit that stands for all is beside what `one` holds, and held by `other`, whose path may be there if it goes on at the end of the first.
fn strikes(one: Held, other: Held, goes_on: bool, circuit: u64) -> bool {
    let beside = one.0.beside.bits() | one.1.beside.bits();
    let path = if goes_on { 0 } else { other.0.circuits.bits() };
    beside & (path | other.1.circuits.bits()) & circuit != 0
}

harness! {
    /// A route is reserved only if nothing that another one holds is beside what it will hold, nor it beside what the other holds, but as a path that goes
    /// on; and if what is beside it is clear and unblocked.
    t_ilk_12(e)
    theorem "T-ILK-12";
    requirements ["ILK-1", "ILK-36", "ILK-37"];
    assumptions [];
    bound PAIR;
    cases 2;
    unwind 65 = 1 + crate::interlocking::LONGEST;
    apart [0 1];
    claims {
        Beside: "no circuit that another route holds is beside the route, but one of the path of a route that goes on at its end",
        Runs: "no circuit of the route is beside what another route holds, but one of its path where it goes on at the end of that route",
        Clear: "no circuit beside the route's path or overlap is occupied or blocked, whether it is a calling-on route or not",
    }
    covers {
        Both: "a route is reserved while another is held, each with something beside it",
        GoesOn: "a route is reserved over what is beside the one at whose end it goes on",
    }
    {
        let Some(TwoRoutes { layout, asked, other, state, sight, reserved, circuit }) = any_two::<E, FEWER, 0>(e) else { return };
        let routes = &layout.plan().routes;
        let (mine, its) = (all(&routes[asked], RouteState::RESERVED), all(&routes[other], state));
        let goes_on = |route: usize, behind: usize| routes[behind].continuing.bits() >> route & 1 == 1;
        e.claim(Claim::Beside as u32, !reserved || !strikes(mine, its, goes_on(other, asked), circuit));
        e.claim(Claim::Runs as u32, !reserved || !strikes(its, mine, goes_on(asked, other), circuit));
        let beside = (mine.0.beside.bits() | mine.1.beside.bits()) & circuit;
        e.claim(Claim::Clear as u32, !reserved || beside & (sight.occupied.bits() | sight.blocked.bits()) == 0);
        let there = its.0.beside.bits() & circuit != 0;
        e.cover(Cover::Both as u32, reserved && state.phase != Phase::Idle && beside != 0 && there);
        e.cover(Cover::GoesOn as u32, reserved && there && mine.0.circuits.bits() & circuit != 0);
    }
}

harness! {
    /// While a train may enter a route or is in it, no other route holds a circuit beside what the train still needs, and none runs beside it; and a train
    /// is let in only while everything beside its way is clear. Whatever is falsely occupied, requested or withdrawn.
    t_ilk_12_train(e)
    theorem "T-ILK-12";
    requirements ["ILK-5", "ILK-7", "ILK-10", "ILK-14", "ILK-36", "ILK-37"];
    assumptions [
        "loss-of-shunt-within-clear", "approach-covers-braking", "release-covers-residual-running", "overlap-covers-sliding", "trains-obey-signals",
        "all-cab-signalled", "path-complete", "train-whole", "no-setting-back", "start-outlasts-running",
    ];
    built_in BUILT_IN;
    bound TRAIN;
    cases 1;
    unwind 65 = 1 + crate::interlocking::LONGEST;
    under_kani UNDER_KANI;
    claims {
        Sent: "nobody is granted or shown proceed over a circuit beside a place that the train still needs, or beside the overlap into which it may slide, but by a route that goes on at the end of its own",
        Beside: "no other route holds such a circuit, but one of a path that goes on so",
        Runs: "nothing that the train still needs is beside what another route holds, but for a path that goes on at the end of that route",
        Let: "whoever gets the authority to enter has nothing occupied beside the path and the overlap",
    }
    covers {
        Let: "a train is let in with something beside its path, while another route is held",
        Behind: "another route holds a circuit beside a place that is released behind the train",
        Falsely: "a circuit beside the path is occupied while the train is in it",
    }
    {
        let Some(scene) = any_scene::<E, ROUTES, 0, 0>(e, |_, _| Beside::NOTHING) else { return };
        let (_, end) = &scene.devices;
        let route = &scene.route;
        let train = &scene.informed;
        let needs = needed(&scene, train);
        let (_, _, contents) = scene.output.table.parts();
        let (mut sent, mut beside, mut runs, mut others) = (true, true, true, CircuitSet::EMPTY);
        for number in 1..ROUTES {
            let other = &scene.plan.routes[number];
            let (its, goes_on) = (all(other, end.routes[number]), route.continuing.bits() >> number & 1 == 1);
            let circuits = |path: bool| CircuitSet::from_bits(its.1.circuits.bits() | if path { its.0.circuits.bits() } else { 0 });
            beside &= !needs.beside.meets(circuits(!goes_on));
            let follows = other.continuing.bits() & 1 == 1;
            let own = strikes(its, (Element { circuits: needs.circuits, ..Element::NONE }, Element::NONE), follows, u64::MAX);
            runs &= !own;
            let shows = scene.output.proceed.bits() >> number & 1 == 1;
            let granted = contents.grants[number].circuits.or(its.0.circuits.only_if(shows));
            sent &= goes_on || !needs.beside.meets(granted);
            others = others.or(circuits(true));
        }
        let let_in = train.authority && !scene.train.authority;
        let (path, overlap) = all(route, scene.after);
        let occupied = scene.input.occupied;
        let clear = !path.beside.or(overlap.beside).meets(occupied);
        e.claim(Claim::Sent as u32, sent);
        e.claim(Claim::Beside as u32, beside);
        e.claim(Claim::Runs as u32, runs);
        e.claim(Claim::Let as u32, !let_in || clear);
        e.cover(Cover::Let as u32, let_in && !path.beside.is_empty() && (ROUTES == 1 || !others.is_empty()));
        let released = scene.after.tail > 0 && route.path[0].beside.meets(others);
        e.cover(Cover::Behind as u32, (released || ROUTES == 1) && train.front <= scene.ground.last && train.counts());
        e.cover(Cover::Falsely as u32, needs.beside.meets(occupied) && train.front >= FIRST);
    }
}

harness! {
    /// No block is confirmed where a train stands in the way of those who work, though no route is held for it: after a start, say. It may set off.
    t_ilk_12_block(e)
    theorem "T-ILK-12";
    requirements ["ILK-39"];
    assumptions [];
    bound PAIR;
    cases 1;
    unwind 65 = 1 + crate::interlocking::LONGEST;
    claims {
        Stands: "a block that is confirmed in this cycle has nothing occupied beside it, where a route says so of the block's circuit or of the other one",
    }
    covers {
        Confirmed: "a block is confirmed that a route has beside its path, while another circuit of a path is occupied",
    }
    {
        let Some((layout, before, input)) = any_cycle::<E, 2, FEWER, 0, 0>(e) else { return };
        let (after, output) = layout.interlock(before, input);
        let new = output.confirmed.bits() & !before.works.confirmed.bits();
        let occupied = input.occupied.bits();
        let (mut stands, mut beside) = (false, false);
        for route in &layout.plan().routes {
            for place in 0..=FEWER {
                let element = if place < FEWER { route.path[place] } else { route.overlap };
                let there = route.exists() && (place < usize::from(route.length) || place == FEWER);
                let (own, other) = (element.circuits.bits(), element.beside.bits());
                stands |= there && (own & new != 0 && other & occupied != 0 || other & new != 0 && own & occupied != 0);
                beside |= there && other & new != 0;
            }
        }
        e.claim(Claim::Stands as u32, !stands && after.works.confirmed == output.confirmed);
        e.cover(Cover::Confirmed as u32, beside && layout.plan().routes[0].path[0].circuits.bits() & occupied != 0);
    }
}
