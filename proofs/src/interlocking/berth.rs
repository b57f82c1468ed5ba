//! Two trains and one berth (T-ILK-11): one that is called on, and one that was there before.
//!
//! The accidents: the called train goes on sight into a berth, and meets there one that comes in, one that has not stopped yet, or one that starts
//! against it; or, when the first has gone, one that was let in from the other end. And it is told to run faster than it can see.
//! The train is that of T-ILK-10 ([`super::train`]), once as the one that was there, and once as the one that is called.

use super::ahead::needed;
use super::any::{any_circuits, bit, kept};
use super::scene::{BUILT_IN, Beside, ENTRY, FIRST, LENGTH, Scene, Train, any_scene};
use crate::Engine;
use crate::engine::any_flag;
use atc_kernel::interlocking::{CircuitSet, MAX_CODES, Phase, Plan, Refusal, Request, Route};

const ROUTES: usize = 2;

pub const BOUND: &str = match LENGTH {
    3 => "2 routes of up to 3 circuits, 32 circuits",
    _ => "2 routes of up to 2 circuits, 32 circuits",
};

/// A scene where the route of number `called` is a calling-on route.
fn any_call<E: Engine + ?Sized>(e: &mut E, called: usize) -> Option<Scene<ROUTES, 0, 0>> {
    any_scene::<E, ROUTES, 0, 0>(e, |e, plan: &mut Plan<ROUTES, LENGTH, 0, 0>| {
        // A rule of the constructor: such a route ends at the berth. Who draws values would break it with nearly all of them.
        let goes_on = any_flag(e, "it goes on (odd: yes)");
        let route = &mut plan.routes[called];
        route.calling_on = true;
        route.overlap.circuits = route.overlap.circuits.or(any_circuits(e, "berth (bits)", 0x4000..=0x4000));
        route.continuing = route.continuing.only_if(goes_on);
        route.to = route.to.only_if(goes_on);
        Beside::NOTHING
    })
}

/// Whether `route` starts in the berth of `called`, against its direction of travel.
fn starts_against(route: &Route<LENGTH>, called: &Route<LENGTH>) -> bool {
    route.length > 0 && route.heading != called.heading && route.entry.meets(called.overlap.circuits)
}

/// Whether a train stands wholly in the last circuit of its route, or goes on beyond its end by another.
fn stands(scene: &Scene<ROUTES, 0, 0>, train: &Train) -> bool {
    let whole = train.front == scene.ground.last && train.moving == 0;
    train.tail == scene.ground.last && (whole || train.front > scene.ground.last && !train.slid)
}

harness! {
    /// While a calling-on route is held, whoever came or comes into its berth by another route stands there, or goes on out of it at its end; and
    /// while its path is, nobody starts in the berth against its train.
    t_ilk_train_stands(e)
    theorem "T-ILK-11";
    requirements ["ILK-2", "ILK-34", "ATC-17"];
    assumptions [
        "loss-of-shunt-within-clear", "approach-covers-braking", "release-covers-residual-running", "overlap-covers-sliding", "trains-obey-signals",
        "all-cab-signalled", "path-complete", "train-whole", "no-setting-back", "start-outlasts-running",
    ];
    built_in BUILT_IN;
    bound BOUND;
    cases 1;
    unwind 65 = 1 + crate::interlocking::LONGEST;
    claims {
        Stands: "a train that may still come into the berth, or has, stands wholly in the last circuit of its route, or goes on out of it",
        Against: "a train that starts in the berth against the called one may not, unless that has left the path",
        Slow: "no circuit of the berth has a limit above the speed of the calling-on route",
    }
    covers {
        Shared: "a calling-on route shows proceed while a train stands in the berth",
        Leaves: "it is held while that train goes on out of the berth",
        Starts: "a train starts against the called one, that has left the path and is in the berth",
    }
    {
        let Some(scene) = any_call(e, 1) else { return };
        let (_, end) = &scene.devices;
        let (called, state) = (&scene.plan.routes[1], end.routes[1]);
        let (held, berth) = (state.is_held(), called.overlap.circuits);
        let train = &scene.informed;
        let comes = train.counts() && needed(&scene, train).circuits.meets(berth);
        e.claim(Claim::Stands as u32, !held || !comes || stands(&scene, train));
        let starts = starts_against(&scene.route, called) && train.counts() && train.tail <= ENTRY;
        let on_its_way = held && state.tail < called.length;
        e.claim(Claim::Against as u32, !on_its_way || !starts);
        let limits = scene.output.table.parts().2.standing.limits;
        let kept = kept(called, state).circuits;
        let circuit = CircuitSet::from_bits(bit(e.word("a circuit that stands for all (number)", 0..=15)));
        let in_table = usize::from(called.speed.0) < MAX_CODES;
        e.claim(Claim::Slow as u32, !kept.meets(circuit) || !in_table || limits.over(circuit).0 <= called.speed.0);
        let proceeds = scene.output.proceed.bits() & 2 != 0;
        e.cover(Cover::Shared as u32, proceeds && comes && train.front == scene.ground.last);
        e.cover(Cover::Leaves as u32, held && comes && train.front > scene.ground.last && train.tail == scene.ground.last);
        let in_berth = held && !on_its_way && scene.input.occupied.meets(kept);
        e.cover(Cover::Starts as u32, in_berth && starts && train.front == FIRST);
    }
}

harness! {
    /// While a train is called on, is on its way, or is in the berth, no other route lets a train in over what it needs or into the berth, and none
    /// is held that may.
    t_ilk_train_called(e)
    theorem "T-ILK-11";
    requirements ["ILK-7", "ILK-34", "ILK-35", "ATC-1"];
    assumptions [
        "loss-of-shunt-within-clear", "approach-covers-braking", "release-covers-residual-running", "overlap-covers-sliding", "trains-obey-signals",
        "all-cab-signalled", "path-complete", "train-whole", "no-setting-back", "start-outlasts-running",
    ];
    built_in BUILT_IN;
    bound BOUND;
    cases 1;
    unwind 65 = 1 + crate::interlocking::LONGEST;
    claims {
        In: "no other route whose path meets what the called train needs, its berth included, shows proceed or grants a circuit of it",
        Slides: "none whose overlap meets the berth does",
        Against: "none that starts in the berth against it lets anybody out there, before the called train has left the path",
    }
    covers {
        Berth: "the called train is wholly in the berth, and its route holds that alone",
        Gone: "the berth is clear, the called train is still in the path, and another route into the berth is refused",
        Withdrawn: "the route is withdrawn, and the called train enters",
    }
    {
        let Some(scene) = any_call(e, 0) else { return };
        let ground = &scene.ground;
        let (train, other) = (&scene.informed, &scene.plan.routes[1]);
        let ahead = needed(&scene, train).circuits;
        let berth = if train.counts() && (train.front <= ground.last || train.slid) { ground.berth() } else { CircuitSet::EMPTY };
        let proceeds = scene.output.proceed.bits() & 2 != 0;
        let grant = scene.output.table.parts().2.grants[1];
        let granted = grant.circuits;
        let enters = other.held_from(0).circuits.meets(ahead) && proceeds || granted.meets(ahead);
        e.claim(Claim::In as u32, !enters);
        let lets_in = proceeds || !granted.is_empty();
        e.claim(Claim::Slides as u32, !lets_in || !kept(other, scene.devices.1.routes[1]).circuits.meets(berth));
        let against = starts_against(other, &scene.route) && train.counts() && train.tail <= ground.last;
        let lets_out = proceeds || !granted.is_empty() && grant.train.meets(ground.berth());
        e.claim(Claim::Against as u32, !(against && lets_out));
        let whole = train.slid && train.tail == ground.over && train.front == ground.over;
        e.cover(Cover::Berth as u32, whole && scene.after.is_held() && scene.after.tail == scene.route.length);
        let occupied = scene.input.occupied.meets(ground.berth());
        let asked = matches!(scene.input.request, Some(Request::Set(asked)) if asked.number() == 1);
        let refused = asked && scene.output.answer == Some(Err(Refusal::PathHeld));
        let into = other.held_from(0).circuits.meets(ground.berth());
        e.cover(Cover::Gone as u32, !occupied && refused && into && train.front == ground.last && train.front > FIRST);
        let withdrawn = scene.before.phase == Phase::Releasing;
        e.cover(Cover::Withdrawn as u32, withdrawn && train.front == FIRST && scene.earlier.front == ENTRY);
    }
}
