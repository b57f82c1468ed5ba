//! The track of a counted line is the layout's (T-WAY-1): what the checks of the joint look at, and nothing else of the layout.

#![allow(clippy::needless_range_loop, reason = "a place is a number in several arrays")]

use super::plans::LONGEST;
use crate::interlocking::{any_circuits, any_plan};
use atc_kernel::distance::Metres;
use atc_kernel::interlocking::{CircuitSet, Layout, Plan, Route, SegmentId};
use atc_kernel::wayside::{Chain, Place};

/// The places of a path and of a segment.
const PATH: usize = 2;
const ROUTES: usize = 2;
const SEGMENTS: usize = 2;
/// The places behind the throat that are looked at: an entry may be the last of them.
const BEHIND: usize = PATH;

pub const BOUND: &str =
    "2 routes of up to 2 circuits, 2 segments of up to 2, 32 circuits, each with a length of its own";

/// How long a circuit is: each of the 32 has another length, and they neither rise nor fall with the numbers.
fn metres(number: usize) -> Metres {
    Metres(u16::from(number.to_le_bytes()[0] & 31) * 37 % 61 + 1)
}

/// What a train that goes out over the route is on, in its order: the entry, then the path. Bits of circuits.
fn way(route: &Route<PATH>) -> [u64; PATH + 1] {
    let mut way = [route.entry.bits(); PATH + 1];
    for place in 0..PATH {
        way[place + 1] = if place < usize::from(route.length) { route.path[place].circuits.bits() } else { 0 };
    }
    way
}

/// The circuits that trains on their way out to the segment pass so many places before the last circuit of their route, found route by route.
fn passed(plan: &Plan<ROUTES, PATH, 0, SEGMENTS>, segment: usize, back: usize) -> u64 {
    let mut passed = 0;
    for route in &plan.routes {
        let way = way(route);
        for front in 0..=PATH {
            // Its last circuit is at place `length` of its way.
            let its = front + back == usize::from(route.length) && route.length != 0;
            passed |= if its && route.to.bits() >> segment & 1 == 1 { way[front] } else { 0 };
        }
    }
    passed
}

/// Whether the place has these circuits, and the length of the shortest: of one of them, and of none a longer one than the circuit that stands for all has.
fn is(place: Place, circuits: u64, number: usize) -> bool {
    let mut of_one = circuits == 0 && place.length == Metres(0);
    for each in 0..32 {
        of_one |= circuits >> each & 1 == 1 && place.length == metres(each);
    }
    place.circuits.bits() == circuits && of_one && (circuits >> number & 1 == 0 || place.length <= metres(number))
}

harness! {
    /// The track on which a joint is checked is that of the layout. A ghost train goes out to the line over any route: each circuit that it passes is at the place
    /// of the track that is as many circuits behind the throat, and the place is not longer than the circuit. So where places that are held are together as long as the
    /// train by the track, they are by the layout. Its way goes on over the segment's circuits, in their order; and the ways in begin where the layout has them.
    t_way_1_track(e)
    theorem "T-WAY-1";
    requirements ["WAY-24"];
    assumptions [];
    bound BOUND;
    cases 2;
    unwind 65 = 1 + LONGEST;
    apart [0 1];
    claims {
        Passed: "a circuit that the ghost passes on its way out is at its place behind the throat, which is no longer than it",
        Behind: "a place behind the throat has the circuits that trains pass there on their ways out, and no others, and the length of the shortest",
        Line: "the throat, and each place of the line, have the circuits of the segment, no others, and the length of the shortest",
        Ways: "each way in has the entry and the first circuit of its route, and there is none without a route",
        There: "there is a track if and only if there is the segment",
    }
    covers {
        Entry: "the ghost is at the entry of a route of two circuits",
        Join: "two tracks join behind the throat, and the other is shorter",
        Short: "a line that ends before the last place",
        Other: "a route that leads to the other segment",
    }
    {
        let number = e.choose("segment", SEGMENTS);
        let one = usize::from(e.word("a circuit that stands for all (number)", 0..=8) & 31);
        let mut plan = any_plan::<E, ROUTES, PATH, 0, SEGMENTS>(e);
        for route in &mut plan.routes {
            route.entry = any_circuits(e, "entry (bits)", 1..=1);
        }
        for (place, length) in plan.lengths.iter_mut().enumerate() {
            *length = metres(place);
        }
        let layout = Layout::with_what_proofs_need(plan).ok();
        e.assume(layout.is_some());
        let Some(layout) = layout else { return };
        let plan = layout.plan();
        let segment = if number == 0 { SegmentId::ZERO } else { SegmentId::new(1).unwrap_or(SegmentId::ZERO) };
        let made = Chain::<ROUTES, PATH, BEHIND>::of(&layout, segment);
        let line = if number == 0 { &plan.segments[0] } else { &plan.segments[1] };
        e.claim(Claim::There as u32, made.is_some() == (line.length != 0));
        let Some(track) = made else { return };

        // The ghost: on its way out over a route, at a place of it; the last one is the throat.
        let ghost = usize::from(e.word("the ghost's route", 0..=1) & 1);
        let at = usize::from(e.word("the place of its way that it passes", 0..=1) & 1);
        let (mut under, mut place, mut goes, mut longest) = (0, Place::NONE, false, false);
        for (name, route) in plan.routes.iter().enumerate() {
            let length = usize::from(route.length);
            let mine = ghost == name && route.to.bits() >> number & 1 == 1 && at < length;
            goes |= mine;
            longest |= mine && length == PATH;
            for (front, circuits) in way(route).into_iter().enumerate() {
                under |= if mine && at == front { circuits } else { 0 };
                for back in 1..=BEHIND {
                    place = if mine && at == front && front + back == length { track.behind[back - 1] } else { place };
                }
            }
        }
        let on_it = under >> one & 1 == 1;
        let held = !on_it || place.circuits.bits() >> one & 1 == 1 && place.length <= metres(one);
        e.claim(Claim::Passed as u32, !goes || held);

        let (mut behind, mut join) = (true, false);
        for back in 1..=BEHIND {
            let circuits = passed(plan, number, back);
            behind &= is(track.behind[back - 1], circuits, one);
            join |= circuits & circuits.wrapping_sub(1) != 0 && circuits >> one & 1 == 1 && track.behind[back - 1].length < metres(one);
        }
        e.claim(Claim::Behind as u32, behind);
        let mut on_line = is(track.throat, line.throat.bits(), one);
        for back in 0..PATH {
            let circuits = if back < usize::from(line.length) { line.circuits[back].bits() } else { 0 };
            on_line &= is(track.circuits[back], circuits, one);
        }
        e.claim(Claim::Line as u32, on_line);
        let mut ways = true;
        for number in 0..ROUTES {
            let (route, its) = (&plan.routes[number], track.ways[number]);
            let first = if route.length == 0 { (CircuitSet::EMPTY, CircuitSet::EMPTY) } else { (route.entry, route.path[0].circuits) };
            ways &= (its.entry, its.first) == first;
        }
        e.claim(Claim::Ways as u32, ways);
        e.cover(Cover::Entry as u32, at == 0 && longest);
        e.cover(Cover::Join as u32, join);
        e.cover(Cover::Short as u32, usize::from(line.length) < PATH);
        e.cover(Cover::Other as u32, plan.routes.iter().any(|route| route.length != 0 && route.to.bits() == 2 >> number));
    }
}
