//! A driver who is on his way through a route when the device starts (T-ILK-10): nothing is done ahead of him, whatever time he takes.
//!
//! The accident: a driver has passed a signal at proceed. The device is started again, and forgets him. He goes slowly, or stands for a while, and
//! goes on by the signal that he has passed. Ahead of him a block is confirmed and staff step onto the track; a point is driven; a route over his is
//! set for another train; or the line that he is on his way out to is given to the neighbour.
//!
//! The train is that of [`super::forgotten`].

use super::any::fouls;
use super::forgotten::{
    BOUND, BUILT_IN, FIRST, Ground, ROUTES, Scene, any_scene, aside, begins, free, holding, holds, needed, quiet, under,
};
use super::scene::LENGTH;
use atc_kernel::interlocking::{CircuitSet, Plan, Refusal, Request, RouteState};

/// The most places where what is beside them is looked at.
const SHORT: u8 = 2;

pub const BESIDE: &str = match LENGTH {
    3 => "2 routes of up to 2 circuits, 32 circuits, 1 point, 1 segment of up to 3 circuits",
    _ => BOUND,
};

/// Whether one of `circuits` is granted by a route that does not begin in the train's path.
fn granted(scene: &Scene, circuits: CircuitSet) -> bool {
    let (_, _, contents) = scene.output.table.parts();
    let mut granted = false;
    for (other, grant) in scene.plan.routes.iter().zip(&contents.grants) {
        granted |= grant.circuits.meets(circuits) && !begins(other, &scene.ground, FIRST);
    }
    granted
}

harness! {
    /// A ghost train is on its way through a route whose signal it passed before the start, slowly or standing for a while, and no driver in it looks
    /// at telegrams. As long as it may go on, nothing is done ahead of it or under it; and that is so again after the cycle.
    t_ilk_train_unswept(e)
    theorem "T-ILK-10";
    requirements ["ILK-27", "ILK-28", "ILK-29", "ILK-30", "ILK-31", "ILK-32"];
    assumptions [
        "loss-of-shunt-within-clear", "start-outlasts-running", "overlap-covers-sliding", "path-complete", "train-whole", "no-setting-back",
    ];
    built_in BUILT_IN;
    bound BOUND;
    cases 1;
    unwind 65 = 1 + crate::interlocking::LONGEST;
    claims {
        Holds: "the invariant: what the train still needs is unswept, and the time counts no more than has passed since it was wholly in the last circuit",
        Set: "a route over what it still needs is set only if it begins where the train is or comes to, in its direction",
        Declared: "and none that is declared to conflict with its route and shares nothing with it",
        Apart: "no route holds, and no telegram grants, what it still needs, but such a route",
        Points: "no point is driven that it still needs, nor one with a detector there",
        Staff: "no block is confirmed on what it still needs, or where it is",
        Line: "while it is on its way out the line is given to nobody who comes in, and no block is confirmed there",
    }
    covers {
        Goes: "a route is refused because of the train, which is before the last place",
        Own: "a route is set for the train ahead of it",
        Stops: "the train is wholly in the last circuit, and its overlap is swept",
        Slides: "it has slid into the overlap, and is not reported there",
        Point: "a point ahead of it is asked for, and not driven",
        Starts: "the start is over in this cycle, with the train in the path",
        Out: "the line is asked for from outside while the train is in the path of a route out",
    }
    {
        let Some(scene) = any_scene(e, |plan, device, train, left| {
            quiet(&Ground::of(plan), device, left) && free(plan, device, train)
        }) else { return };
        let Scene { plan, ground, train, before, after, input, output, .. } = &scene;
        let (train, left, occupied) = (*train, scene.left.1, input.occupied);
        let (route, segment) = (plan.routes[0], plan.segments[0]);
        let path = ground.path();
        let starting = before.started.0 < ground.start;
        e.claim(Claim::Holds as u32, holds(train, ground, after) && train.is_one(ground));
        let needs = needed(train, ground);
        let ahead = needs.circuits;
        let (mut set, mut declared, mut own) = (true, true, false);
        for (number, other) in plan.routes.iter().enumerate() {
            let reserved = scene.is_reserved(number);
            let its = holding(other, RouteState::RESERVED).circuits;
            set &= !reserved || !its.meets(ahead) || begins(other, ground, scene.from());
            own |= reserved && its.meets(ahead);
            let shares = its.bits() & (path | route.overlap.circuits.bits()) != 0 || begins(other, ground, FIRST);
            let conflicts = other.conflicts.bits() & 1 == 1 && !shares;
            declared &= !reserved || !conflicts || !train.goes(ground);
        }
        e.claim(Claim::Set as u32, set);
        e.claim(Claim::Declared as u32, declared);
        e.claim(Claim::Apart as u32, free(plan, after, train) && !granted(&scene, ahead));
        let driven = output.drives.points();
        let over = plan.points[0].detectors.meets(ahead);
        let moves = driven.meets(needs.positions.points()) || over && driven.bits() & 1 == 1;
        e.claim(Claim::Points as u32, !moves);
        e.claim(Claim::Staff as u32, !output.confirmed.meets(ahead.or(under(train, ground))));
        let goes_out = ground.goes_out(left);
        let taken = output.permits.bits() & 1 == 1 || output.confirmed.meets(ground.line);
        e.claim(Claim::Line as u32, quiet(ground, after, left) && !(goes_out && taken));

        let refused = output.answer == Some(Err(Refusal::Unswept));
        e.cover(Cover::Goes as u32, !starting && matches!(input.request, Some(Request::Set(_))) && refused && train.tail < ground.last);
        e.cover(Cover::Own as u32, own);
        let whole = train.tail == ground.last && train.front == ground.last && !route.overlap.circuits.is_empty();
        let swept = before.unswept.circuits.contains(route.overlap.circuits) && !after.unswept.circuits.meets(route.overlap.circuits);
        e.cover(Cover::Stops as u32, whole && swept && !starting);
        e.cover(Cover::Slides as u32, !starting && !ground.out && train.front == ground.over && train.late > 0);
        let asked = matches!(input.request, Some(Request::Drive(..)));
        e.cover(Cover::Point as u32, !starting && asked && refused);
        e.cover(Cover::Starts as u32, starting && after.started.0 == ground.start && train.front > FIRST);
        let turns = matches!(input.request, Some(Request::Turn(_, atc_kernel::interlocking::Travel::Toward)));
        let clear = !occupied.meets(ground.line.or(segment.throat));
        e.cover(Cover::Out as u32, !starting && turns && clear && goes_out && train.tail >= FIRST);
    }
}

harness! {
    /// The same train, and what would strike its side: nothing is done beside what it still needs, as long as it may go on, and nothing of it is beside what
    /// is done.
    t_ilk_12_unswept(e)
    theorem "T-ILK-12";
    requirements ["ILK-38"];
    assumptions [
        "loss-of-shunt-within-clear", "start-outlasts-running", "overlap-covers-sliding", "path-complete", "train-whole", "no-setting-back",
    ];
    built_in BUILT_IN;
    bound BESIDE;
    cases 1;
    unwind 65 = 1 + crate::interlocking::LONGEST;
    claims {
        Set: "a route that the train's way fouls, or that fouls it, is set only if it begins where the train is or comes to, in its direction",
        Apart: "no route holds, and no telegram grants, a circuit beside what the train still needs, and none has that beside its own, but such a route",
        Staff: "no block is confirmed beside what it still needs",
    }
    covers {
        Refused: "a route is refused because of the train, which shares no circuit with it",
        Own: "a route is set for the train ahead of it, beside which it stands",
    }
    {
        let short = |plan: &Plan<ROUTES, LENGTH, 1, 1>| plan.routes[0].length <= SHORT && plan.routes[1].length <= SHORT;
        let Some(scene) = any_scene(e, |plan, device, train, _| short(plan) && aside(plan, device, train)) else { return };
        let Scene { plan, ground, train, before, after, output, .. } = &scene;
        let needs = needed(*train, ground);
        let (mut set, mut own, mut near) = (true, false, false);
        for (number, other) in plan.routes.iter().enumerate() {
            let its = holding(other, RouteState::RESERVED);
            let strikes = fouls(&its, &needs);
            set &= !scene.is_reserved(number) || !strikes || begins(other, ground, scene.from());
            own |= scene.is_reserved(number) && strikes;
            let asked = matches!(scene.input.request, Some(Request::Set(asked)) if usize::from(asked.number()) == number);
            near |= asked && strikes && !its.circuits.meets(needs.circuits);
        }
        e.claim(Claim::Set as u32, set);
        e.claim(Claim::Apart as u32, aside(plan, after, *train) && !granted(&scene, needs.beside));
        e.claim(Claim::Staff as u32, !output.confirmed.meets(needs.beside));
        let refused = output.answer == Some(Err(Refusal::Unswept)) && before.started.0 >= ground.start;
        e.cover(Cover::Refused as u32, refused && near && scene.earlier.tail < ground.last);
        e.cover(Cover::Own as u32, own);
    }
}
