//! Maintenance (T-ILK-8): blocks, restrictions, and which blocks staff may rely on.

use super::any::{any_circuits, any_input, any_layout, any_state, bit, held, kept};
use crate::engine::any_byte;
use atc_kernel::interlocking::{CircuitSet, Layout, SpeedCode, SpeedLimits, State, Works};

/// Smaller for a wrong kernel: what a small layout rejects, a large one does.
const ROUTES: usize = if cfg!(small) { 1 } else { 2 };
const PATH: usize = if cfg!(small) { 2 } else { 4 };

pub const BOUND: &str = "2 routes of up to 4 circuits, 32 circuits, 1 point, 1 segment of up to 4 circuits";

harness! {
    /// A circuit is blocked or restricted by command only, and always by command; a lower restriction is kept. No point in a blocked circuit is driven. A block is confirmed only
    /// where no route holds the circuit or needs a point in it and that is not occupied, and on plain line only while segment and throat are clear, no route out is held, and before this cycle the
    /// neighbour has not been permitted to send for the turn time; what makes it protection lasts.
    t_ilk_8(e)
    theorem "T-ILK-8";
    requirements ["ILK-15", "ILK-16"];
    assumptions [];
    bound BOUND;
    cases 1;
    unwind 65 = 1 + crate::interlocking::LONGEST;
    claims {
        Blocked: "a circuit is blocked exactly if that is commanded, or it was and the opposite is not commanded",
        Restricted: "it changes by command only: one to lift takes it away, one to restrict gives its code or a lower one that nobody lifts",
        Told: "the shared table has these blocks, and no limit above the restriction, whatever routes do",
        Confirmed: "only a blocked circuit that no route holds is confirmed, and no point in a blocked one is driven",
        Clear: "it becomes confirmed only while it is not occupied, and the point in it has settled and is needed by no held route",
        Quiet: "on plain line it becomes confirmed only while segment and throat are clear, no route out is held, and before this cycle the neighbour has not been permitted to send for the turn time",
        Stays: "a confirmed circuit stays confirmed until its block is lifted",
        Lasts: "while it stays confirmed, the neighbour is not permitted to send and no route out is held",
    }
    covers {
        Becomes: "a circuit of a held route's segment becomes confirmed",
        Held: "a blocked circuit is not confirmed because a route holds it",
        Moving: "a blocked circuit of plain line is not confirmed because the neighbour was permitted to send",
        Both: "a circuit is to be blocked and unblocked",
        Lifts: "a restriction is lifted",
        Lower: "a command to restrict finds a lower restriction, and that one stays",
        Needed: "a blocked circuit that no route holds is not confirmed because a route needs the point in it",
        Moves: "a blocked circuit is not confirmed because the point in it has not settled",
    }
    {
        let Some(layout) = any_layout::<E, ROUTES, PATH, 1, 1>(e) else { return };
        let layout: Layout<ROUTES, PATH, 1, 1> = layout;
        let state: State<ROUTES, 1> = any_state(e);
        let it = bit(e.word("a circuit that stands for all (number)", 0..=15));
        let has = |bits: u64| bits & it != 0;
        let restriction = SpeedCode(any_byte(e, "its restriction (code)", 0..=7) & 7);
        let elsewhere = SpeedCode(any_byte(e, "restriction elsewhere (code)", 0..=7) & 7);
        let alone = CircuitSet::from_bits(it);
        let restrictions =
            SpeedLimits::NONE.and_at_most(restriction, alone).and_at_most(elsewhere, CircuitSet::ALL.without(alone));
        let blocked = any_circuits(e, "blocked (bits)", 0..=u16::MAX);
        // A valid state confirms nothing else.
        let confirmed = any_circuits(e, "confirmed, if blocked (bits)", 0..=u16::MAX).and(blocked);
        let before = State { works: Works { restrictions, blocked, confirmed }, ..state };
        let segment = layout.plan().segments[0];
        let mut line = 0;
        for place in 0..PATH {
            line |= if place < usize::from(segment.length) { segment.circuits[place].bits() } else { 0 };
        }
        let on_line = has(line);
        let turn = layout.plan().turn;
        let out = |state: &State<ROUTES, 1>| {
            let mut out = false;
            for number in 0..ROUTES {
                let idle = held(&layout.plan().routes[number], state.routes[number]).circuits.bits() == 0
                    && kept(&layout.plan().routes[number], state.routes[number]).circuits.bits() == 0;
                out |= layout.plan().routes[number].to.bits() & 1 == 1 && !idle;
            }
            out
        };
        let protects = |state: &State<ROUTES, 1>| state.directions.toward.bits() & 1 == 0 && state.directions.withdrawn[0] == turn && !out(state);
        let was_confirmed = has(before.works.confirmed.bits());
        let valid = before.is_valid(&layout) && (!was_confirmed || !on_line || protects(&before));
        e.assume(valid);
        if !valid {
            return;
        }
        let input = any_input(e);
        let (after, output) = layout.interlock(before, input);
        let orders = input.orders;
        let (block, unblock) = (has(orders.block.bits()), has(orders.unblock.bits()));
        let expected = block || has(before.works.blocked.bits()) && !unblock;
        let is_blocked = has(after.works.blocked.bits());
        e.claim(Claim::Blocked as u32, is_blocked == expected);
        let (restrict, lift) = (has(orders.restrict.bits()), has(orders.lift.bits()));
        let commanded = if orders.speed.0 < 7 { orders.speed.0 } else { 7 };
        let left = if lift { 7 } else { restriction.0 };
        let wanted = if restrict && commanded < left { commanded } else { left };
        let (_, _, contents) = output.table.parts();
        // The lowest code that the circuit is limited to.
        let lowest = |limits: SpeedLimits| {
            let mut lowest = 7;
            for (code, limited) in (0..8).zip(limits.parts()) {
                lowest = if has(limited.bits()) && code < lowest { code } else { lowest };
            }
            lowest
        };
        let found = lowest(after.works.restrictions);
        e.claim(Claim::Restricted as u32, found == wanted);
        let mut told = true;
        for (here, there) in after.works.restrictions.parts().iter().zip(contents.standing.limits.parts()) {
            told &= !has(here.bits()) || has(there.bits());
        }
        e.claim(Claim::Told as u32, has(contents.blocked.bits()) == expected && told);
        let mut in_route = false;
        for number in 0..ROUTES {
            let route = &layout.plan().routes[number];
            in_route |= has(held(route, after.routes[number]).circuits.bits() | kept(route, after.routes[number]).circuits.bits());
        }
        let confirmed = has(after.works.confirmed.bits()) || has(output.confirmed.bits());
        let occupied = input.occupied.bits();
        let becomes = confirmed && !was_confirmed;
        let in_it = layout.plan().points[0].detectors.bits() & it != 0;
        let mut needed = 0;
        for number in 0..ROUTES {
            let route = &layout.plan().routes[number];
            let of_route = [held(route, after.routes[number]).positions, kept(route, after.routes[number]).positions];
            for positions in of_route {
                needed |= (positions.normal.bits() | positions.reverse.bits()) & 1;
            }
        }
        let needed = in_it && needed == 1;
        let driven = in_it && (output.drives.normal.bits() | output.drives.reverse.bits()) & 1 == 1;
        // Detected, undriven, and so for the layout's number of cycles.
        let detected = (input.detected.normal.bits() | input.detected.reverse.bits()) & 1 == 1;
        let settled = !in_it || detected && !driven && after.points.parts().0[0] >= layout.plan().settle;
        e.claim(Claim::Clear as u32, !becomes || !has(occupied) && !needed && settled);
        e.claim(Claim::Confirmed as u32, (!confirmed || is_blocked && !in_route) && (!is_blocked || !driven));
        let clear = occupied & (line | segment.throat.bits()) == 0;
        let quiet = clear && protects(&after) && before.directions.withdrawn[0] == turn;
        e.claim(Claim::Quiet as u32, !becomes || !on_line || quiet);
        let stays = has(after.works.confirmed.bits()) && has(output.confirmed.bits());
        e.claim(Claim::Stays as u32, !was_confirmed || !is_blocked || stays);
        e.claim(Claim::Lasts as u32, !confirmed || !on_line || protects(&after) && output.permits.bits() & 1 == 0);
        e.cover(Cover::Becomes as u32, becomes && on_line);
        e.cover(Cover::Held as u32, is_blocked && !confirmed && in_route && !has(occupied));
        e.cover(Cover::Moving as u32, is_blocked && !confirmed && on_line && clear && !out(&after));
        e.cover(Cover::Both as u32, block && unblock);
        let quiet_place = !on_line && !has(occupied) && !in_route;
        e.cover(Cover::Needed as u32, is_blocked && !confirmed && quiet_place && needed && settled && !has(after.unswept.circuits.bits()));
        e.cover(Cover::Moves as u32, is_blocked && !confirmed && quiet_place && !needed && !settled && !has(after.unswept.circuits.bits()));
        e.cover(Cover::Lifts as u32, lift && !restrict && restriction.0 < 7);
        e.cover(Cover::Lower as u32, restrict && !lift && restriction.0 < commanded && found == restriction.0);
    }
}
