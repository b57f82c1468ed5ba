//! A train that a device finds when it starts (T-ILK-10): it runs on what it was told before, and the device remembers nothing of that.
//!
//! The accident: a device is started again while a train runs on a signal that showed proceed a moment ago. The route is forgotten. A point in its way is
//! driven, the line is turned against it, staff are sent onto the track or another train is let in, before it has come in or stands. Or it stands, and the
//! same is done where it is.

use super::any::{any_circuits, any_cycle, bit};
use atc_kernel::interlocking::{Phase, Refusal, Request, Travel};

harness! {
    /// A ghost train may still run, anywhere and seen by nobody, or stands where it is reported: a device that has started lets it.
    t_ilk_train_start(e)
    theorem "T-ILK-10";
    requirements ["ILK-24", "ILK-25"];
    assumptions ["start-outlasts-running", "loss-of-shunt-within-clear"];
    bound "1 route of up to 2 circuits, 32 circuits, 1 point, 1 segment of up to 2 circuits";
    cases 1;
    unwind 65 = 1 + crate::interlocking::LONGEST;
    claims {
        Over: "when the time after a start is over the train stands",
        Still: "while it may still run no route is held, no signal shows proceed, nobody is granted a circuit, no point is driven, no block is confirmed, and no segment is turned or permitted",
        LetIn: "where it stands no signal lets another one in, and nobody is granted its circuits",
        Under: "no point is driven under it",
        Staff: "no block is confirmed where it stands, or will stand",
        Against: "plain line where it stands, or will stand, is given to nobody; where no route leads out to it, so that the neighbour has sent the train, to no train that goes out",
    }
    covers {
        Runs: "it may still run, and a route is refused because of the start",
        Stands: "it stands in the path of a route that is refused because of it, after the time is over",
        Line: "it stands on plain line that is to be turned, after the time is over",
        Arrives: "it stands on plain line that no route leads out to, and the line is turned towards the station for it",
        Last: "the last cycle in which it may run",
    }
    {
        let Some((layout, before, input)) = any_cycle::<E, 1, 2, 1, 1>(e) else { return };
        let plan = layout.plan();
        let start = plan.start.0;
        let run = e.word("it may run for (cycles)", 0..=1);
        let under = any_circuits(e, "circuits in which it stands, or will (bits)", 1..=8);
        // What is so in every cycle, from the first one of a start on (T-ILK-1, `t_ilk_1_start`): the time, and what is claimed again behind the cycle.
        let in_time = |run: u16, started: u16| run == 0 || u32::from(run) + u32::from(started) <= u32::from(start);
        e.suppose("start-outlasts-running", in_time(run, before.started.0));
        let runs = run > 0;
        e.suppose("loss-of-shunt-within-clear", runs || input.occupied.contains(under));
        let segment = plan.segments[0];
        let mut line = 0;
        for place in 0..2 {
            line |= if place < usize::from(segment.length) { segment.circuits[place].bits() } else { 0 };
        }
        let on_line = line & under.bits() != 0;
        let its = |set: atc_kernel::interlocking::SegmentSet| u64::from(set.bits()) & bit(0) != 0;
        let directions = before.directions;
        let given = its(directions.toward) || its(directions.away) || its(directions.came);
        // Where no route leads out to the line the train is one that the neighbour has sent.
        let sent = plan.routes[0].length == 0 || plan.routes[0].to.bits() & 1 == 0;
        let given = if sent { its(directions.away) } else { given };
        let invariant = before.works.confirmed.bits() & under.bits() == 0 && !(on_line && given);
        e.assume(invariant);

        let (after, output) = layout.interlock(before, input);
        let left = run.saturating_sub(1);
        e.claim(Claim::Over as u32, in_time(left, after.started.0) && (after.started.0 < start || left == 0));
        let (_, _, contents) = output.table.parts();
        let granted = contents.grants[0].circuits.bits();
        let drives = output.drives.normal.bits() | output.drives.reverse.bits();
        let held = after.routes[0].phase != Phase::Idle;
        let confirmed = output.confirmed.bits() | after.works.confirmed.bits();
        let turned = after.directions.toward.bits() | after.directions.away.bits() | output.permits.bits();
        let still = !held && output.proceed.bits() == 0 && granted == 0 && drives == 0 && confirmed == 0 && turned == 0;
        e.claim(Claim::Still as u32, !runs || still);
        let route = plan.routes[0];
        let mut path = 0;
        for place in 0..2 {
            path |= if place < usize::from(route.length) { route.path[place].circuits.bits() } else { 0 };
        }
        let in_path = path & under.bits() != 0;
        let shown = output.proceed.bits() & 1 == 1;
        e.claim(Claim::LetIn as u32, runs || !(in_path && shown) && granted & under.bits() == 0);
        let over_point = plan.points[0].detectors.bits() & under.bits() != 0;
        e.claim(Claim::Under as u32, runs || !(over_point && drives & 1 == 1));
        e.claim(Claim::Staff as u32, confirmed & under.bits() == 0);
        let to = after.directions;
        let given = its(to.toward) || its(to.away) || its(to.came) || its(output.permits);
        let given = if sent { its(to.away) || contents.away.bits() & 1 == 1 } else { given };
        e.claim(Claim::Against as u32, !(on_line && given));

        let refused = |why| matches!(input.request, Some(Request::Set(_))) && output.answer == Some(Err(why));
        e.cover(Cover::Runs as u32, runs && refused(Refusal::Starting));
        let over = start > 0 && before.started.0 >= start;
        e.cover(Cover::Stands as u32, over && !runs && in_path && refused(Refusal::Occupied));
        let turns = matches!(input.request, Some(Request::Turn(_, Travel::Toward)));
        e.cover(Cover::Line as u32, over && !runs && on_line && turns && output.answer.is_some());
        e.cover(Cover::Arrives as u32, on_line && sent && !runs && its(to.toward) && !its(directions.toward));
        e.cover(Cover::Last as u32, run == 1 && after.started.0 == start);
    }
}
