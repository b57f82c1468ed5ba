//! The counted line is never turned (T-WAY-7).

use super::plans::{LONGEST, with_lengths};
use crate::any_flag;
use crate::interlocking::{any_input, any_plan, any_state};
use atc_kernel::Machine;
use atc_kernel::block::{Block, Direction, Hold, LineOutput, Output};
use atc_kernel::distance::Metres;
use atc_kernel::interlocking::{CircuitSet, Input, Layout, Refusal, Request, SegmentId, Travel};
use atc_kernel::time::Ticks;
use atc_kernel::wayside::{Counted, Join};

/// The places of a path and of a segment.
const PATH: usize = 2;

harness! {
    /// The segment of a counted line has the direction of the line, or none, whatever is requested, reported or permitted; a request to turn it is
    /// refused for its direction and not told to the interlocking, also one to turn it towards the station while a block disagrees; no route needs the other direction; and no train of another line is on it.
    t_way_7(e)
    theorem "T-WAY-7";
    requirements ["WAY-10", "WAY-15", "WAY-25", "WAY-26"];
    assumptions [];
    bound "1 route of up to 2 circuits, 1 segment of up to 2, 16 circuits";
    cases 2;
    unwind 65 = 1 + LONGEST;
    apart [0 1];
    claims {
        Kept: "after the cycle the segment has no direction against the line",
        Refused: "a request to turn it against the line is refused for its direction, and so is one to turn it towards the station while a block disagrees",
        Told: "every other request is told as it is",
        Route: "no route of the layout needs the segment against the line",
        Alone: "the front of a train on a route is on no section of the line if the route does not need the segment, also when it slides into the overlap",
    }
    covers {
        Turns: "a request to turn the line",
        Disagrees: "a request to give the line its direction is refused because a block disagrees",
        Given: "the segment is given the direction of the line",
        Set: "a route is requested",
        Throat: "the throat is a section, and a route leads over it",
        Beside: "a train is on a route that does not need the segment",
    }
    {
        let travel = if e.choose("direction of travel of the line (0 toward, 1 away)", 2) == 0 { Travel::Toward } else { Travel::Away };
        let plan = with_lengths(any_plan::<E, 1, PATH, 0, 1>(e));
        let layout = Layout::with_what_proofs_need(plan).ok();
        e.assume(layout.is_some());
        let Some(layout) = layout else { return };
        let Ok(block) = Block::new(1, 1, Hold::NONE, Ticks(1)) else { return };
        let mut circuits = [[None; 16]];
        let segment = &layout.plan().segments[0];
        let throat = any_flag(e, "the section is in the throat (odd)");
        circuits[0][0] = if throat { segment.throat } else { segment.circuits[0] }.first();
        let join = Join { blocks: [block], direction: Direction::Up, train: Metres(0), segment: SegmentId::ZERO, travel, circuits };
        let counted = Counted::new(&layout, &join).ok();
        e.assume(counted.is_some());
        let Some(counted) = counted else { return };
        let state = any_state(e);
        let directions = (state.directions.toward, state.directions.away);
        let valid = state.is_valid(&layout) && counted.is_kept(directions.0, directions.1);
        e.assume(valid);
        if !valid {
            return;
        }
        let input: Input = any_input(e);
        let agrees = any_flag(e, "the block agrees (odd)");
        let report = LineOutput { blocks: [Output { agree: agrees, ..Block::SAFE }], before_hold: Hold::NONE };
        let admitted = counted.admit(input.request, &report);
        let (after, _) = layout.interlock(state, Input { request: admitted.unwrap_or(None), ..input });
        let against = |toward: u8, away: u8| (if travel == Travel::Toward { away } else { toward }) & 1 == 1;
        let before = against(directions.0.bits(), directions.1.bits());
        let kept = !before && !against(after.directions.toward.bits(), after.directions.away.bits());
        e.claim(Claim::Kept as u32, kept && counted.is_kept(after.directions.toward, after.directions.away));
        let turns = match input.request {
            Some(Request::Turn(segment, to)) => segment.number() == 0 && (to != travel || to == Travel::Toward && !agrees),
            _ => false,
        };
        e.claim(Claim::Refused as u32, !turns || admitted == Err(Refusal::Direction));
        e.claim(Claim::Told as u32, turns || admitted == Ok(input.request));
        let route = &layout.plan().routes[0];
        let needs = if travel == Travel::Toward { route.to } else { route.from };
        e.claim(Claim::Route as u32, !route.exists() || needs.bits() & 1 == 0);
        // A ghost: the front of a train on the route.
        let front = CircuitSet::nth(usize::from(e.word("circuit of a train's front (number)", 0..=4) & 15));
        let goes = route.exists() && (route.path.iter().zip(0..route.length).any(|(place, _)| place.circuits.meets(front)) || route.overlap.circuits.meets(front));
        let along = if travel == Travel::Toward { route.from } else { route.to };
        let needed = along.bits() & 1 == 1;
        let section = counted.sections()[0][0];
        e.claim(Claim::Alone as u32, !goes || needed || !section.meets(front));
        e.cover(Cover::Throat as u32, throat && goes && needed && section.meets(front));
        e.cover(Cover::Beside as u32, goes && !needed);
        e.cover(Cover::Turns as u32, turns && agrees);
        e.cover(Cover::Disagrees as u32, turns && travel == Travel::Toward && input.request == Some(Request::Turn(SegmentId::ZERO, travel)));
        let given = after.directions.toward.bits() | after.directions.away.bits();
        e.cover(Cover::Given as u32, given & 1 == 1 && (directions.0.bits() | directions.1.bits()) & 1 == 0);
        e.cover(Cover::Set as u32, matches!(input.request, Some(Request::Set(_))) && route.exists());
    }
}
