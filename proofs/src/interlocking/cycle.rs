//! The whole cycle (T-ILK-1): that it is made of the parts that the other theorems are about, and that a refusal leaves no trace.

use super::any::{any_cycle, any_input, any_layout, any_state, bit, held, kept};
use crate::Engine;
use crate::engine::any_u32;
use atc_kernel::Machine;
use atc_kernel::interlocking::{
    CircuitSet, Epoch, Input, Layout, Needs, Phase, Plan, PointSet, Positions, Refusal, Request, Route, RouteState,
    SegmentSet, Sight, State, Travel, View, grant, ready, refuse_route, shows_proceed,
};

/// The places of a path for locality; 2 unless the environment variable `ATC_LOCAL` says otherwise.
const LOCAL: usize = match option_env!("ATC_LOCAL") {
    Some(number) => crate::harness::decimal(number),
    None => 2,
};

/// Positions as detection delivers them: a point in both positions is in neither.
fn plausible(detected: Positions) -> Positions {
    let both = detected.normal.bits() & detected.reverse.bits();
    Positions {
        normal: PointSet::from_bits(detected.normal.bits() & !both),
        reverse: PointSet::from_bits(detected.reverse.bits() & !both),
    }
}

/// What the conflict check sees, found from the layout and the inputs.
fn sight<const R: usize, const P: usize, const N: usize, const S: usize>(
    layout: &Layout<R, P, N, S>,
    before: &State<R, S>,
    input: Input,
) -> Sight {
    let plan = layout.plan();
    let blocked = before.works.blocked.bits() & !input.orders.unblock.bits() | input.orders.block.bits();
    let mut under = 0;
    for number in 0..N {
        under |= u32::from(plan.points[number].detectors.bits() & input.occupied.bits() != 0) << number;
    }
    let mut closed = 0;
    for number in 0..S {
        let segment = &plan.segments[number];
        for place in 0..P {
            let there = place < usize::from(segment.length) && segment.circuits[place].bits() & blocked != 0;
            closed |= u8::from(there) << number;
        }
    }
    Sight {
        occupied: input.occupied,
        blocked: CircuitSet::from_bits(blocked),
        closed: SegmentSet::from_bits(closed),
        detected: plausible(input.detected),
        under: PointSet::from_bits(under),
        directions: (
            before.directions.toward,
            SegmentSet::from_bits(before.directions.away.bits() & input.consent.bits()),
        ),
        from_before: before.unswept,
        ways: before.unswept.sweep(layout, input.occupied).1,
    }
}

/// The positions that count as detected, point by point: not driven, and detected there for the settling time, this cycle included.
fn firm<const R: usize, const P: usize, const N: usize, const S: usize>(
    plan: &Plan<R, P, N, S>,
    before: &State<R, S>,
    (detected, drives): (Positions, Positions),
) -> Positions {
    let (stood, last) = before.points.parts();
    let driven = drives.normal.bits() | drives.reverse.bits();
    let (mut normal, mut reverse) = (0, 0);
    for number in 0..N {
        let is_in = |set: PointSet| set.bits() >> number & 1 == 1;
        let stands = |set: PointSet, before: PointSet| {
            let stood = if is_in(before) { u16::from(stood[number]) + 1 } else { 0 };
            is_in(set) && driven >> number & 1 == 0 && stood >= u16::from(plan.settle)
        };
        normal |= u32::from(stands(detected.normal, last.normal)) << number;
        reverse |= u32::from(stands(detected.reverse, last.reverse)) << number;
    }
    Positions { normal: PointSet::from_bits(normal), reverse: PointSet::from_bits(reverse) }
}

/// What a cycle makes of one route, against the parts that the other theorems are about.
#[allow(clippy::struct_excessive_bools, reason = "one for each claim and cover point")]
struct Parts {
    untouched: bool,
    withdrawn: bool,
    reserved: bool,
    once: bool,
    aspect: bool,
    grant: bool,
    epoch: bool,
    accepted: bool,
    refused: bool,
}

/// One route follows its train. A function of its own, so that the loop around it is short.
#[inline(never)]
fn follow<const P: usize>(state: RouteState, route: &Route<P>, occupied: CircuitSet) -> RouteState {
    state.follow(route, occupied)
}

/// Whether what the route still holds of its path is blocked, or the line that it leads to.
fn is_blocked<const P: usize>(route: &Route<P>, state: RouteState, sight: Sight) -> bool {
    let berth = if route.calling_on { kept(route, state).circuits.bits() } else { 0 };
    let ahead = held(route, state).circuits.bits() | berth;
    ahead & sight.blocked.bits() != 0 || route.to.bits() & sight.closed.bits() != 0
}

/// One cycle of any layout in any valid state, as route `it` sees it. None if nothing is assumed to be so.
fn parts<E: Engine + ?Sized, const R: usize, const P: usize, const N: usize, const S: usize>(
    e: &mut E,
    cases: usize,
) -> Option<Parts> {
    let layout: Layout<R, P, N, S> = any_layout(e)?;
    let before: State<R, S> = any_state(e);
    let plan = layout.plan();
    let mut valid = true;
    for number in 0..R {
        valid &= before.routes[number].is_valid(&plan.routes[number]);
    }
    e.assume(valid);
    if !valid {
        return None;
    }
    let input = any_input(e);
    let it = if cases == 1 { 0 } else { e.choose("the route that is looked at", cases) };
    let (after, output) = layout.interlock(before, input);
    let sight = sight(&layout, &before, input);
    let firm = firm(plan, &before, (sight.detected, output.drives));
    // Into a segment that is closed, or where the neighbour does not permit it, nobody is sent.
    let unsent = SegmentSet::from_bits(sight.closed.bits() | !input.consent.bits());
    let view = View { occupied: sight.occupied, blocked: sight.blocked, closed: unsent, firm };
    let mut followed = before.routes;
    for (state, route) in followed.iter_mut().zip(&plan.routes) {
        *state = follow(*state, route, sight.occupied);
    }
    let (route, mine, now) = (&plan.routes[it], followed[it], after.routes[it]);
    let end = |state: RouteState| state.reserve(route, sight.occupied, ready(route, state, view));
    let is_it = |number: u8| usize::from(number) == it;
    // After a start nothing is set.
    let starting = before.started < plan.start;
    let asked = !starting && matches!(input.request, Some(Request::Set(asked)) if is_it(asked.number()));
    let withdrawn =
        matches!(input.request, Some(Request::Withdraw(asked)) if is_it(asked.number())) && mine.phase != Phase::Idle;
    let untouched = now == end(mine);
    // A route that was withdrawn with a train in it is in use again; any other is reserved.
    let again = mine.phase == Phase::Releasing && mine.head > 0;
    let free =
        if again { !is_blocked(route, mine, sight) } else { refuse_route(&layout, &followed, it, sight).is_none() };
    let done = output.answer == Some(Ok(()));
    let resumed = RouteState { phase: Phase::InUse, ..mine };
    let requested = if again { now == resumed } else { now == end(RouteState::RESERVED) };
    let reserved = if free { done && requested } else { !done && untouched };
    let others = (0..R).any(|number| number != it && followed[number].phase != Phase::Idle);
    let (epoch, _, contents) = output.table.parts();
    Some(Parts {
        untouched: asked || withdrawn || untouched,
        withdrawn: !withdrawn || now == end(mine.withdraw(route, sight.occupied)),
        reserved: !asked || reserved,
        once: !asked || mine.phase == Phase::Idle || again || !done,
        aspect: (output.proceed.bits() >> it & 1 == 1) == shows_proceed(route, now, view),
        grant: contents.grants[it] == grant(route, now, view),
        epoch: after.epoch.0 == before.epoch.0.wrapping_add(1) && epoch == after.epoch,
        accepted: asked && free && (others || R == 1),
        refused: asked && !free,
    })
}

/// Says of the parts what two harnesses claim of them, each of its own.
macro_rules! tell {
    ($e:ident, $parts:ident) => {
        $e.claim(Claim::Untouched as u32, $parts.untouched);
        $e.claim(Claim::Withdrawn as u32, $parts.withdrawn);
        $e.claim(Claim::Reserved as u32, $parts.reserved);
        $e.claim(Claim::Once as u32, $parts.once);
        $e.claim(Claim::Aspect as u32, $parts.aspect);
        $e.claim(Claim::Grant as u32, $parts.grant);
        $e.claim(Claim::Epoch as u32, $parts.epoch);
        $e.cover(Cover::Accepted as u32, $parts.accepted);
        $e.cover(Cover::Refused as u32, $parts.refused);
    };
}

harness! {
    /// Locality: in one cycle of the whole device, each route takes the steps that its own theorems are about, with the same circuits
    /// and points in sight, and nothing else changes it. What is asked for touches one route; what is refused touches none.
    t_ilk_1_local(e)
    theorem "T-ILK-1";
    requirements ["ILK-1", "ILK-4"];
    assumptions [];
    bound "2 routes of up to 2 circuits, 32 circuits, 2 points";
    cases 2;
    unwind 65 = 1 + crate::interlocking::LONGEST;
    apart [0 1];
    claims {
        Untouched: "a route that is not asked for follows its train and is reserved if it is ready, no more",
        Withdrawn: "a route that is withdrawn follows its train first, and is withdrawn if it is held then",
        Reserved: "a route that is asked for is reserved, or in use again if it was withdrawn with a train in it, if the conflict check, after all have followed their trains, finds nothing; and otherwise as untouched",
        Once: "a held route is not reserved again, but one that was withdrawn with a train in it",
        Aspect: "its signal shows what the route and the same circuits and points say",
        Grant: "and so does its grant",
        Epoch: "the cycle has the next number, and so has its table",
    }
    covers {
        Accepted: "a route is reserved while another is held",
        Refused: "a route is refused",
    }
    {
        let Some(parts) = parts::<E, 2, LOCAL, 2, 0>(e, 2) else { return };
        tell!(e, parts);
    }
}

harness! {
    /// The same with plain line, for one route.
    t_ilk_1_line(e)
    theorem "T-ILK-1";
    requirements ["ILK-1", "ILK-4"];
    assumptions [];
    bound "1 route of up to 2 circuits, 32 circuits, 1 point, 1 segment of up to 2 circuits";
    cases 1;
    unwind 65 = 1 + crate::interlocking::LONGEST;
    claims {
        Untouched: "a route that is not asked for follows its train and is reserved if it is ready, no more",
        Withdrawn: "a route that is withdrawn follows its train first, and is withdrawn if it is held then",
        Reserved: "a route that is asked for is reserved, or in use again if it was withdrawn with a train in it, if the conflict check finds nothing; and otherwise as untouched",
        Once: "a held route is not reserved again, but one that was withdrawn with a train in it",
        Aspect: "its signal shows what the route, the same circuits and points, and the segments with a blocked circuit say",
        Grant: "and so does its grant",
        Epoch: "the cycle has the next number, and so has its table",
    }
    covers {
        Accepted: "a route is reserved",
        Refused: "a route is refused",
    }
    {
        let Some(parts) = parts::<E, 1, 2, 1, 1>(e, 1) else { return };
        tell!(e, parts);
    }
}

harness! {
    /// Induction: a cycle (after the tracking) that begins in a valid state ends in one, whatever the inputs. So what the theorems assume of
    /// a state holds in every cycle.
    t_ilk_1_valid(e)
    theorem "T-ILK-1";
    requirements ["ILK-16", "ILK-17"];
    assumptions [];
    bound "1 route of up to 2 circuits, 32 circuits, 1 point, 1 segment of up to 2 circuits";
    cases 1;
    unwind 65 = 1 + crate::interlocking::LONGEST;
    claims {
        Routes: "every route is in a state that it can be in",
        Directions: "no segment has two directions, each has the one that a held route needs, and time is counted where permission is withdrawn",
        Works: "only blocked circuits are confirmed, and none that a route holds",
        Valid: "and so the state is valid as a whole",
    }
    covers {
        Reserved: "a route is reserved",
        Released: "a held route becomes idle",
        Turned: "a segment is turned",
        Confirmed: "a circuit is confirmed",
    }
    {
        let Some((layout, before, input)) = any_cycle::<E, 1, 2, 1, 1>(e) else { return };
        let (after, output) = layout.interlock(before, input);
        let plan = layout.plan();
        let mut routes = true;
        let mut held = 0;
        for (route, state) in plan.routes.iter().zip(&after.routes) {
            routes &= state.is_valid(route);
            held |= state.circuits(route).bits();
        }
        e.claim(Claim::Routes as u32, routes);
        let needs = Needs::of(&layout, &after.routes);
        let (toward, away) = (after.directions.toward.bits(), after.directions.away.bits());
        let needed = needs.toward.bits() & !toward == 0 && needs.away.bits() & !away == 0;
        e.claim(Claim::Directions as u32, after.directions.is_valid(plan.turn) && needed);
        e.claim(Claim::Works as u32, after.works.is_valid() && held & after.works.confirmed.bits() == 0);
        e.claim(Claim::Valid as u32, after.is_valid(&layout));
        let set = matches!(input.request, Some(Request::Set(_))) && output.answer == Some(Ok(()));
        let idle = |state: &State<1, 1>| state.routes[0].phase == Phase::Idle;
        e.cover(Cover::Reserved as u32, set);
        e.cover(Cover::Released as u32, !idle(&before) && idle(&after));
        e.cover(Cover::Turned as u32, toward != before.directions.toward.bits() || away != before.directions.away.bits());
        e.cover(Cover::Confirmed as u32, output.confirmed.bits() & !before.works.confirmed.bits() != 0);
    }
}

harness! {
    /// What is refused leaves no trace: the cycle is the one without a request, but for the permission to the neighbour that a request to
    /// turn a segment away ends.
    t_ilk_1_refused(e)
    theorem "T-ILK-1";
    requirements ["ILK-4"];
    assumptions [];
    bound "1 route of up to 2 circuits, 32 circuits, 1 point, 1 segment of up to 2 circuits";
    cases 1;
    unwind 65 = 1 + crate::interlocking::LONGEST;
    claims {
        State: "routes, points, blocks and restrictions are those without the request, and so is every direction away from the station; and the confirmed blocks, unless a permission is lost",
        Toward: "a direction towards the station is lost only by a request to turn that segment away, and none is won",
        Outputs: "signals, drives and grants are those without the request",
        Permits: "the neighbour is permitted no more than without the request",
    }
    covers {
        Set: "a route is refused",
        Point: "an individual point command is refused",
        Waits: "a segment is to be turned away, and loses its permission",
    }
    {
        let Some((layout, before, input)) = any_cycle::<E, 1, 2, 1, 1>(e) else { return };
        let (after, output) = layout.interlock(before, input);
        let refused = matches!(output.answer, Some(Err(_)));
        e.assume(refused);
        let (without, silent) = layout.interlock(before, Input { request: None, ..input });
        let (works, directions) = (after.works, after.directions);
        let lost = without.directions.toward.bits() & !directions.toward.bits();
        let won = directions.toward.bits() & !without.directions.toward.bits();
        // A turn time of one cycle is over at once: then the withdrawal confirms what is blocked there.
        let confirmed = works.confirmed == without.works.confirmed && output.confirmed == silent.confirmed;
        let same = after.routes[0] == without.routes[0]
            && works.blocked == without.works.blocked
            && works.restrictions == without.works.restrictions
            && after.points == without.points
            && directions.away == without.directions.away;
        e.claim(Claim::State as u32, same && (confirmed || lost != 0));
        let turned = match input.request {
            Some(Request::Turn(segment, Travel::Away)) => bit(u16::from(segment.number())),
            _ => 0,
        };
        e.claim(Claim::Toward as u32, won == 0 && u64::from(lost) & !turned == 0);
        let (_, _, contents) = output.table.parts();
        let (_, _, other) = silent.table.parts();
        let shown = output.proceed == silent.proceed && output.drives == silent.drives;
        e.claim(Claim::Outputs as u32, shown && contents.grants[0] == other.grants[0]);
        e.claim(Claim::Permits as u32, output.permits.bits() & !silent.permits.bits() == 0);
        e.cover(Cover::Set as u32, matches!(input.request, Some(Request::Set(_))));
        e.cover(Cover::Point as u32, matches!(input.request, Some(Request::Drive(..))));
        e.cover(Cover::Waits as u32, lost != 0);
    }
}

harness! {
    /// The device starts in the most restrictive state, and has a safe output.
    t_ilk_1_start(e)
    theorem "T-ILK-1";
    requirements ["ILK-15"];
    assumptions [];
    bound "1 route of 1 circuit, 1 segment of 1 circuit";
    cases 1;
    unwind 65 = 1 + crate::interlocking::LONGEST;
    claims {
        Valid: "the initial state is valid, whatever the layout",
        Nothing: "no route is held and no segment has a direction, and every permission may still be in the air",
        Blocked: "every circuit is blocked, none is confirmed, and every one is restricted to stop",
        Safe: "the safe output shows and drives nothing, permits nothing, confirms nothing, and its table is readable in no cycle",
    }
    covers {
        Any: "a layout with a route",
    }
    {
        let Some(layout) = any_layout::<E, 1, 1, 0, 1>(e) else { return };
        let epoch = Epoch(any_u32(e, "a cycle (number)", 0..=3));
        let initial = layout.initial();
        e.claim(Claim::Valid as u32, initial.is_valid(&layout));
        let directions = initial.directions;
        let none = directions.toward.bits() | directions.away.bits() == 0;
        e.claim(Claim::Nothing as u32, initial.routes[0].phase == Phase::Idle && none && directions.withdrawn[0].0 == 0);
        let works = initial.works;
        let blocked = works.blocked.bits() == u64::MAX && works.confirmed.bits() == 0;
        e.claim(Claim::Blocked as u32, blocked && works.restrictions.parts()[0].bits() == u64::MAX);
        let safe = <Layout<1, 1, 0, 1> as Machine>::SAFE;
        let dark = safe.proceed.bits() == 0 && safe.drives.normal.bits() | safe.drives.reverse.bits() == 0;
        let silent = safe.permits.bits() == 0 && safe.confirmed.bits() == 0 && safe.answer.is_none();
        e.claim(Claim::Safe as u32, dark && silent && safe.table.read(epoch).is_none());
        e.cover(Cover::Any as u32, layout.plan().routes[0].length == 1);
    }
}

harness! {
    /// After a start nothing moves, is confirmed or turned, and nobody is let in, until the layout's time has passed: whatever is unblocked and
    /// asked for.
    t_ilk_1_starting(e)
    theorem "T-ILK-1";
    requirements ["ILK-24"];
    assumptions [];
    bound "1 route of up to 2 circuits, 32 circuits, 1 point, 1 segment of up to 2 circuits";
    cases 1;
    unwind 65 = 1 + crate::interlocking::LONGEST;
    claims {
        Still: "no point is driven, no signal shows proceed and no route is held",
        Line: "no segment has a direction, and none is permitted to the neighbour",
        Works: "no block is confirmed",
        Counts: "the time goes on by one cycle",
    }
    covers {
        Set: "a route is refused because of the start",
        Over: "the time passes",
    }
    {
        let Some((layout, before, input)) = any_cycle::<E, 1, 2, 1, 1>(e) else { return };
        let start = layout.plan().start.0;
        let starting = before.started.0 < start;
        let (after, output) = layout.interlock(before, input);
        let driven = output.drives.normal.bits() | output.drives.reverse.bits() != 0;
        let held = after.routes[0].phase != Phase::Idle;
        e.claim(Claim::Still as u32, !starting || !driven && output.proceed.bits() == 0 && !held);
        let line = after.directions.toward.bits() | after.directions.away.bits() | output.permits.bits();
        e.claim(Claim::Line as u32, !starting || line == 0);
        e.claim(Claim::Works as u32, !starting || output.confirmed.bits() == 0 && after.works.confirmed.bits() == 0);
        e.claim(Claim::Counts as u32, after.started.0 == if starting { before.started.0 + 1 } else { before.started.0 });
        let set = matches!(input.request, Some(Request::Set(_)));
        e.cover(Cover::Set as u32, set && starting && matches!(output.answer, Some(Err(Refusal::Starting))));
        e.cover(Cover::Over as u32, starting && after.started.0 == start);
    }
}
