//! One route and one train (T-ILK-10): nothing is released in front of the train, or under it, whatever else is reported occupied.

use super::any::{held, kept};
use super::scene::{
    ALONE, BOUND, BUILT_IN, Beside, ENTRY, FIRST, LENGTH, ROUTES, SLOW, Scene, UNDER_KANI, any_scene, holds,
};
use crate::engine::any_byte;
use atc_kernel::interlocking::{CircuitSet, Phase, Rear, Request, Route, RouteState};

/// Whether the place is held by the route.
fn holds_place(route: &Route<LENGTH>, state: RouteState, place: u8) -> bool {
    let mut there = CircuitSet::EMPTY;
    for (number, element) in (0_u8..).zip(&route.path) {
        if number == place && number < route.length {
            there = element.circuits;
        }
    }
    held(route, state).circuits.bits() & there.bits() != 0
}

harness! {
    /// No place of a route's path is released in front of a train that has authority over it or still runs without, nor under a train:
    /// whatever else is reported occupied, and though the train is lost for less time than a circuit needs to count as clear.
    t_ilk_train_release(e)
    theorem "T-ILK-10";
    requirements ["ILK-10", "ILK-12", "ILK-13", "ILK-21", "ILK-22"];
    assumptions [
        "loss-of-shunt-within-clear", "approach-covers-braking", "release-covers-residual-running", "overlap-covers-sliding", "trains-obey-signals",
        "all-cab-signalled", "path-complete", "train-whole", "no-setting-back", "start-outlasts-running",
    ];
    built_in BUILT_IN;
    bound BOUND;
    cases 1;
    unwind 65 = 1 + crate::interlocking::LONGEST;
    under_kani UNDER_KANI;
    claims {
        Behind: "a place that the route held and holds no more is behind the train's tail, if the train has entered or may still enter",
        Nothing: "a route that is withdrawn lets nobody in, before it is requested anew",
    }
    covers {
        Behind: "a place is released behind the train, and it is not the last one",
        Running: "a train runs on into a route that was withdrawn",
        Timed: "the rear is swept by the release time while the entry is occupied",
    }
    {
        let Some(scene) = any_scene::<E, ROUTES, 0, 0>(e, |_, _| Beside::NOTHING) else { return };
        let Scene { ground, route, before, after, train, informed, .. } = &scene;
        let place = any_byte(e, "a place that stands for all (number)", 0..=2);
        let released = holds_place(route, *before, place) && !holds_place(route, *after, place);
        let behind = train.tail >= FIRST && train.tail - FIRST > place;
        // It has made its move in this cycle: what counts is whether it may go on in the next.
        e.claim(Claim::Behind as u32, !released || !informed.counts() || behind);
        let withdrawn = before.phase == Phase::Releasing;
        let asked = matches!(scene.input.request, Some(Request::Set(asked)) if asked.number() == 0);
        let anew = asked && scene.output.answer == Some(Ok(()));
        let lets_in = scene.output.proceed.bits() & 1 == 1 || !scene.output.table.parts().2.grants[0].circuits.is_empty();
        e.claim(Claim::Nothing as u32, !withdrawn || anew || !lets_in);
        e.cover(Cover::Behind as u32, released && behind && train.front <= ground.last);
        e.cover(Cover::Running as u32, withdrawn && train.front == FIRST && train.tail == ENTRY);
        let swept = before.rear == Rear::Entry && after.rear == Rear::Swept && after.time.0 == ground.release;
        e.cover(Cover::Timed as u32, swept && train.counts() && train.tail == ENTRY);
    }
}

harness! {
    /// An overlap is given up only when the train has slid out of it, stands in the last circuit, or goes on with authority beyond.
    t_ilk_train_overlap(e)
    theorem "T-ILK-10";
    requirements ["ILK-14"];
    assumptions [
        "loss-of-shunt-within-clear", "approach-covers-braking", "release-covers-residual-running", "overlap-covers-sliding", "trains-obey-signals",
        "all-cab-signalled", "path-complete", "train-whole", "no-setting-back", "start-outlasts-running",
    ];
    built_in BUILT_IN;
    bound BOUND;
    cases 1;
    unwind 65 = 1 + crate::interlocking::LONGEST;
    under_kani UNDER_KANI;
    claims {
        Stands: "an overlap that was held and is not any more has no train that may slide into it, or slid into it and has not left it",
    }
    covers {
        Stands: "an overlap is given up in front of a train that stands",
        Slid: "a train slides into an overlap that is held",
    }
    {
        let Some(scene) = any_scene::<E, ROUTES, 0, 0>(e, |_, _| Beside::NOTHING) else { return };
        let Scene { ground, route, before, after, train, informed, .. } = &scene;
        let had = before.phase != Phase::Idle && before.overlap;
        let given = had && !(after.phase != Phase::Idle && after.overlap);
        let whole = train.tail == ground.last && train.front == ground.last && train.moving == 0;
        let stands = whole && !ground.calling_on;
        let goes_on = train.front >= ground.over && !train.slid;
        e.claim(Claim::Stands as u32, !given || !informed.counts() || stands || goes_on);
        e.cover(Cover::Stands as u32, given && stands && !kept(route, *before).circuits.is_empty());
        e.cover(Cover::Slid as u32, !given && train.slid);
    }
}

harness! {
    /// Induction: what the theorems about a route and its train assume of them holds at the end of every cycle again.
    t_ilk_train(e)
    theorem "T-ILK-10";
    requirements ["ILK-10", "ILK-12", "ILK-13", "ILK-14", "ILK-21", "ILK-22", "ILK-35"];
    assumptions [
        "loss-of-shunt-within-clear", "approach-covers-braking", "release-covers-residual-running", "overlap-covers-sliding", "trains-obey-signals",
        "all-cab-signalled", "path-complete", "train-whole", "no-setting-back", "start-outlasts-running",
    ];
    built_in BUILT_IN;
    bound BOUND;
    cases 1;
    unwind 65 = 1 + crate::interlocking::LONGEST;
    under_kani UNDER_KANI;
    claims {
        Holds: "the invariant of the train and the route",
        Valid: "and the train is one that there can be",
    }
    covers {
        Entered: "a train enters a route in use",
        Late: "its front is not reported in the first place",
        Let: "a train is let in that was not",
    }
    {
        let Some(scene) = any_scene::<E, ROUTES, 0, 0>(e, |_, _| Beside::NOTHING) else { return };
        let Scene { ground, after, informed, train, .. } = &scene;
        e.claim(Claim::Holds as u32, holds(informed, ground, after));
        e.claim(Claim::Valid as u32, informed.is_one(ground));
        e.cover(Cover::Entered as u32, after.phase == Phase::InUse && train.front == FIRST);
        e.cover(Cover::Late as u32, train.front == FIRST && train.late > 0);
        e.cover(Cover::Let as u32, informed.authority && !train.authority);
    }
}

harness! {
    /// Every two circuits on which the train stands next to each other, of entry, path and overlap of its route, are told to the ATC as those of one
    /// train; and the limit of each circuit under it is none above that of the route over its path, that of the overlap over that, or of a
    /// restriction.
    t_ilk_train_body(e)
    theorem "T-ATC-2";
    requirements ["ATC-8", "ATC-9"];
    assumptions [
        "loss-of-shunt-within-clear", "approach-covers-braking", "release-covers-residual-running", "overlap-covers-sliding", "trains-obey-signals",
        "all-cab-signalled", "path-complete", "train-whole", "no-setting-back", "start-outlasts-running",
    ];
    built_in BUILT_IN;
    bound ALONE;
    cases 1;
    unwind 65 = 1 + crate::interlocking::LONGEST;
    claims {
        Joined: "two neighbouring circuits in which the train is reported, the first of them the entry or in the path, and the second in the path, are of one body",
        Route: "the limit of a circuit of the path is not above the speed of the route, whether it holds the circuit or not",
        Restriction: "nor is that of a circuit in which the train is reported above a restriction or the speed of the line, there or at the entry",
        Overlap: "the limit of a circuit of the overlap, and not of the path, is not above the speed of the overlap, whether it is held or not",
        Slid: "so are the last circuit and the occupied ones of the overlap, where the train has slid into it and has not left the last",
        Known: "an occupied circuit of the path counts as one that no route holds exactly if the route does not hold it; and none in which the train is reported does",
    }
    covers {
        Entry: "the train stands at the entry and in the path",
        Path: "it stands in two circuits of the path, and a place is released behind it",
        Restricted: "its tail stands in a restricted circuit",
        Slid: "the train has slid into the overlap and stands in the last circuit, too",
    }
    {
        let Some(scene) = any_scene::<E, 1, 0, 0>(e, |_, _| Beside::NOTHING) else { return };
        let Scene { ground, route, informed, after, slow, output, .. } = &scene;
        let (first, last) = informed.seen();
        let (_, _, contents) = output.table.parts();
        let standing = contents.standing;
        let under = |position: u8| first <= position && position <= last && informed.counts();
        let (mut joined, mut by_route, mut by_restriction, mut known) = (true, true, true, true);
        let mut before = (ENTRY, ground.entry);
        by_restriction &= !under(ENTRY) || !slow.meets(ground.entry) || standing.limits.over(ground.entry).0 <= SLOW;
        for (position, circuit) in (FIRST..).zip(&ground.path) {
            let in_path = position <= ground.last;
            let here = in_path && under(position);
            let both = here && under(before.0);
            joined &= !both || standing.bodies[0].contains(before.1.or(*circuit));
            let limit = standing.limits.over(*circuit).0;
            by_route &= !in_path || limit <= route.speed.0;
            by_restriction &= !here || !slow.meets(*circuit) || limit <= SLOW;
            let loose = contents.occupied.meets(*circuit) && !holds_place(route, *after, position - FIRST);
            known &= !in_path || standing.loose.meets(*circuit) == loose && !(here && loose);
            before = (position, *circuit);
        }
        let over = ground.overlap.without(route.held_from(0).circuits);
        let by_overlap = over.is_empty() || standing.limits.over(over).0 <= route.overlap_speed.0;
        e.claim(Claim::Overlap as u32, by_overlap);
        let slid = informed.slid && under(ground.last) && under(ground.over);
        let beyond = contents.occupied.and(ground.overlap);
        e.claim(Claim::Slid as u32, !slid || standing.bodies[0].contains(ground.at(ground.last).or(beyond)));
        e.cover(Cover::Slid as u32, slid && !beyond.is_empty());
        e.claim(Claim::Joined as u32, joined);
        e.claim(Claim::Route as u32, by_route);
        e.claim(Claim::Restriction as u32, by_restriction);
        e.claim(Claim::Known as u32, known);
        e.cover(Cover::Entry as u32, under(ENTRY) && under(FIRST));
        e.cover(Cover::Path as u32, under(FIRST + 1) && last > FIRST + 1 && scene.after.tail > 0);
        e.cover(Cover::Restricted as u32, under(FIRST) && last > FIRST && slow.meets(ground.path[0]));
    }
}
