//! The counted line is never turned (T-WAY-7).

use super::{CIRCUITS, LONGEST, device, quiet, with_lengths};
use crate::interlocking::{any_input, any_plan, any_state};
use atc_kernel::Machine;
use atc_kernel::block::{Block, Direction, Hold, Status};
use atc_kernel::distance::Metres;
use atc_kernel::interlocking::{Commands, Input as Told, Layout, MAX_CIRCUITS, Phase, Refusal, Request, SegmentId, Travel};
use atc_kernel::time::Ticks;
use atc_kernel::wayside::{Join, State};

/// The places of a path and of a segment.
const PATH: usize = 2;

harness! {
    /// The segment of a counted line has the direction of the line, or none, whatever is requested, reported or permitted; a request to turn it is
    /// refused for its direction and changes nothing of the segments; and no route needs the other direction.
    t_way_7(e)
    theorem "T-WAY-7";
    requirements ["WAY-10", "WAY-15", "GEN-1", "GEN-2"];
    assumptions [];
    bound "1 route of up to 2 circuits, 1 segment of up to 2, 16 circuits";
    cases 2;
    unwind 65 = 1 + LONGEST;
    apart [0 1];
    claims {
        Kept: "after the cycle the segment has no direction against the line",
        Refused: "a request to turn it against the line is not told to the interlocking, and is refused for its direction",
        Told: "every other request is told as it is, and answered as the interlocking answers",
        Route: "no route of the layout needs the segment against the line",
        Valid: "what is remembered of the line and of the neighbour stays valid, and the table's number is that of the cycle",
        Start: "the initial state is valid: the line unverified, nothing permitted, nothing held",
    }
    covers {
        Turns: "a request to turn the line",
        Given: "the segment is given the direction of the line",
        Set: "a route is requested",
    }
    {
        let travel = if e.choose("direction of travel of the line (0 toward, 1 away)", 2) == 0 { Travel::Toward } else { Travel::Away };
        let plan = with_lengths(any_plan::<E, 1, PATH, 0, 1>(e));
        let layout = Layout::with_what_proofs_need(plan).ok();
        e.assume(layout.is_some());
        let Some(layout) = layout else { return };
        let Ok(block) = Block::new(1, 1, Hold::NONE, Ticks(1)) else { return };
        let mut circuits = [[None; 16]];
        circuits[0][0] = layout.plan().segments[0].circuits[0].first();
        let join = Join {
            blocks: [block],
            direction: Direction::Up,
            train: Metres(0),
            segment: SegmentId::ZERO,
            travel,
            circuits,
        };
        let Some(device) = device(e, &layout, Some(join), (Ticks(1), CIRCUITS)) else { return };
        let interlocking = any_state(e);
        let mut state: State<1, 1, 1> = device.initial();
        state.device.interlocking = interlocking;
        state.device.cycle = interlocking.epoch;
        let valid = state.is_valid(&device);
        e.assume(valid);
        if !valid {
            return;
        }
        let told: Told = any_input(e);
        let mut input = quiet();
        (input.occupied, input.detected) = (told.occupied, told.detected);
        (input.request, input.orders) = (told.request, told.orders);
        let (read, reading) = device.read(state, input);
        // Any consent, whatever its age: the neighbour may say what it likes.
        let heard = Told { consent: told.consent, ..reading.input };
        let (after, interlocking) = layout.interlock(read.device.interlocking, heard);
        let (toward, away) = (after.directions.toward.bits() & 1 == 1, after.directions.away.bits() & 1 == 1);
        let against = match travel {
            Travel::Toward => away,
            Travel::Away => toward,
        };
        e.claim(Claim::Kept as u32, !against);
        let turns = match input.request {
            Some(Request::Turn(segment, to)) => segment.number() == 0 && to != travel,
            _ => false,
        };
        let answer = interlocking.answer;
        let (_, output) = device.send(read, &reading, &Commands { interlocking, telegrams: [None; MAX_CIRCUITS] });
        let refused = reading.input.request.is_none() && output.answer == Some(Err(Refusal::Direction));
        e.claim(Claim::Refused as u32, !turns || refused);
        e.claim(Claim::Told as u32, turns || reading.input.request == input.request && output.answer == answer);
        let route = &layout.plan().routes[0];
        let needs = if travel == Travel::Toward { route.to } else { route.from };
        e.claim(Claim::Route as u32, !route.exists() || needs.bits() & 1 == 0);
        let Some(counted) = device.counted() else { return };
        let numbered = after.epoch.0 == state.device.cycle.0.wrapping_add(1);
        e.claim(Claim::Valid as u32, read.line.is_valid(counted.line()) && read.consents[0].is_valid(Ticks(1)) && numbered);
        let start: State<1, 1, 1> = device.initial();
        let unverified = start.line.blocks[0].parts().status == Status::Unverified;
        let nothing = !start.consents[0].counts(Ticks(1)) && start.device.interlocking.routes[0].phase == Phase::Idle;
        e.claim(Claim::Start as u32, start.is_valid(&device) && unverified && nothing && start.sent.is_empty());
        e.cover(Cover::Turns as u32, turns);
        e.cover(Cover::Given as u32, toward || away);
        e.cover(Cover::Set as u32, matches!(input.request, Some(Request::Set(_))) && route.exists());
    }
}
