//! The direction of plain line (T-ILK-9).

use super::any::{any_input, any_layout, any_state};
use atc_kernel::interlocking::{Layout, Phase, Request, State, Travel};

/// Smaller for a wrong kernel: what a small layout rejects, a large one does.
const ROUTES: usize = if cfg!(small) { 1 } else { 2 };
const PATH: usize = if cfg!(small) { 2 } else { 4 };
const SEGMENTS: usize = 2;

pub const BOUND: &str = "2 routes of up to 4 circuits, 32 circuits, 1 point, 2 segments of up to 4 circuits";

/// Whether a held route needs the direction of segment `it` towards the station, and whether one needs the other.
fn needs(layout: &Layout<ROUTES, PATH, 1, SEGMENTS>, state: &State<ROUTES, SEGMENTS>, it: usize) -> (bool, bool) {
    let (mut toward, mut away) = (false, false);
    for number in 0..ROUTES {
        let (route, state) = (&layout.plan().routes[number], state.routes[number]);
        let held = state.phase != Phase::Idle;
        toward |= held && state.tail == 0 && route.from.bits() >> it & 1 == 1;
        away |= held && route.to.bits() >> it & 1 == 1;
    }
    (toward, away)
}

harness! {
    /// A segment never has both directions. It turns by command only, never under a train and never against a held route, and away from the
    /// station only with the neighbour's permission, once this station's has been withdrawn for the turn time.
    t_ilk_9(e)
    theorem "T-ILK-9";
    requirements ["ILK-17", "ILK-18", "ILK-19", "ILK-20", "ILK-25", "ILK-26"];
    assumptions [];
    bound BOUND;
    cases 2;
    unwind 65 = 1 + crate::interlocking::LONGEST;
    apart [0 1];
    claims {
        One: "a segment has at most one direction, and the one away only while the neighbour permits it",
        Needed: "a held route from the segment has the direction towards the station until its first place is released, one to the segment has the other",
        Command: "a direction is given only by the command for it, and taken only by the command for the other",
        Clear: "a direction is taken only while segment and throat are clear, and no held route needs it",
        Consent: "trains are sent out only after the neighbour has permitted it and has not been permitted itself for the turn time, and no signal shows proceed to the segment without its permission",
        Blocked: "a segment with a blocked circuit is given no direction",
        Permits: "the neighbour is permitted to send only towards the station and while no circuit of the segment is blocked, and the time since is counted up to the turn time",
        Given: "an occupied segment is given the direction towards the station only if the neighbour has sent since it had another, or it has none and no route leads to it, and none that no route leads from",
    }
    covers {
        Toward: "a segment is turned towards the station",
        Away: "a segment is turned away from the station",
        Waits: "a permission is withdrawn, and the segment waits",
        Needs: "a held route keeps a segment from turning",
        Train: "a train keeps a segment from turning",
        Sent: "a train that the neighbour has sent comes in over a blocked circuit: the direction stays, the permission does not",
    }
    {
        let Some(layout) = any_layout::<E, ROUTES, PATH, 1, SEGMENTS>(e) else { return };
        let it = e.choose("the segment that is looked at", SEGMENTS);
        let mut before: State<ROUTES, SEGMENTS> = any_state(e);
        // For how many cycles the neighbour has not been permitted, as far as anybody can count.
        let not_permitted = e.word("not permitted for (cycles)", 0..=3);
        let since = u32::from(not_permitted);
        let turn = layout.plan().turn.0;
        let limit = u32::from(turn);
        before.directions.withdrawn[it].0 = if since < limit { not_permitted } else { turn };
        let valid = before.is_valid(&layout);
        e.assume(valid);
        if !valid {
            return;
        }
        let input = any_input(e);
        let (after, output) = layout.interlock(before, input);
        let (was_toward, was_away) = (before.directions.toward.bits() >> it & 1 == 1, before.directions.away.bits() >> it & 1 == 1);
        let (toward, away) = (after.directions.toward.bits() >> it & 1 == 1, after.directions.away.bits() >> it & 1 == 1);
        let (_, _, contents) = output.table.parts();
        let sends = away && input.consent.bits() >> it & 1 == 1;
        let told = (contents.toward.bits() >> it & 1 == 1) == toward && (contents.away.bits() >> it & 1 == 1) == sends;
        e.claim(Claim::One as u32, !(toward && away) && told);
        let (need_toward, need_away) = needs(&layout, &after, it);
        e.claim(Claim::Needed as u32, (!need_toward || toward) && (!need_away || away));
        let (mut ask_toward, mut ask_away) = (false, false);
        if let Some(Request::Turn(segment, travel)) = input.request {
            ask_toward = usize::from(segment.number()) == it && travel == Travel::Toward;
            ask_away = usize::from(segment.number()) == it && travel == Travel::Away;
        }
        let (to_toward, from_toward) = (toward && !was_toward, was_toward && !toward);
        let (to_away, from_away) = (away && !was_away, was_away && !away);
        e.claim(Claim::Command as u32, (!(to_toward || from_away) || ask_toward) && (!(to_away || from_toward) || ask_away));
        let segment = layout.plan().segments[it];
        let mut line = 0;
        for place in 0..PATH {
            line |= if place < usize::from(segment.length) { segment.circuits[place].bits() } else { 0 };
        }
        let clear = input.occupied.bits() & (line | segment.throat.bits()) == 0;
        let taken = from_toward || from_away;
        e.claim(Claim::Clear as u32, !taken || clear && !(from_toward && need_toward) && !(from_away && need_away));
        let (mut entered, mut left) = (false, false);
        let mut out = false;
        for number in 0..ROUTES {
            let route = &layout.plan().routes[number];
            entered |= route.length > 0 && route.from.bits() >> it & 1 == 1;
            left |= route.length > 0 && route.to.bits() >> it & 1 == 1;
            out |= route.to.bits() >> it & 1 == 1 && output.proceed.bits() >> number & 1 == 1;
        }
        // A ghost: the neighbour has sent since the segment was last seen clear, or turned away; and where this station sends nobody, who else.
        let was_sent = before.directions.came.bits() >> it & 1 == 1;
        e.claim(Claim::Given as u32, !to_toward || entered && (clear || was_sent || !left && !was_away));
        let consent = input.consent.bits() >> it & 1 == 1;
        e.claim(Claim::Consent as u32, (!to_away || consent && since >= limit) && (!out || consent));
        let closed = after.works.blocked.bits() & line != 0;
        e.claim(Claim::Blocked as u32, !(to_toward || to_away) || !closed);
        let permitted = output.permits.bits() >> it & 1 == 1;
        let permits = !permitted || toward && !closed;
        let now = if toward { 0 } else { since + 1 };
        let counted = u32::from(after.directions.withdrawn[it].0) == if now < limit { now } else { limit };
        e.claim(Claim::Permits as u32, permits && counted);
        e.cover(Cover::Toward as u32, to_toward && was_away);
        e.cover(Cover::Away as u32, to_away);
        e.cover(Cover::Waits as u32, from_toward && !away);
        e.cover(Cover::Needs as u32, ask_away && was_toward && clear && toward);
        e.cover(Cover::Train as u32, ask_toward && was_away && !clear && away && !need_away);
        e.cover(Cover::Sent as u32, toward && closed && !clear && !permitted);
    }
}
