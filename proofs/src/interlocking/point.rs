//! Points (T-ILK-4): one point stands for all.

use super::any::{any_cycle, held, kept};
use crate::engine::any_byte;
use atc_kernel::interlocking::{PerPoint, Phase, Position, Request};

const ROUTES: usize = 2;
/// Smaller for a wrong kernel: what a small layout rejects, a large one does.
const PATH: usize = if cfg!(small) { 2 } else { 4 };
const POINTS: usize = if cfg!(small) { 2 } else { 16 };

pub const BOUND: &str = "2 routes of up to 4 circuits, 32 circuits, 16 points of which 4 may have stood, no segment";

harness! {
    /// A point is driven only while a provisional route or an accepted command wants it elsewhere than it is detected; never under a train, never where
    /// a route past provisional holds the point or a circuit of its detector, and never both ways.
    t_ilk_4(e)
    theorem "T-ILK-4";
    requirements ["ILK-3", "ILK-8"];
    assumptions [];
    bound BOUND;
    cases 1;
    unwind 65 = 1 + crate::interlocking::LONGEST;
    claims {
        OneWay: "a point is driven at most one way",
        Train: "no circuit of the detector of a driven point is occupied",
        Held: "no circuit of the detector of a driven point is held by a route past provisional",
        Locked: "no route past provisional holds a driven point",
        Wanted: "a driven point is wanted there by a provisional route, or by a command that is accepted",
        Elsewhere: "a driven point is not detected where it is driven to",
        Alone: "a command is accepted only if no route holds the point or a circuit of its detector, and no such circuit is occupied or blocked",
    }
    covers {
        Route: "a point is driven for a route while another route is past provisional",
        Command: "a point is driven by command",
        Refused: "a command is refused because of a route",
        Under: "a wanted point is not driven because of a train",
        Fails: "a route fails while its point is driven",
    }
    {
        let Some((layout, before, input)) = any_cycle::<E, ROUTES, PATH, POINTS, 0>(e) else { return };
        let (after, output) = layout.interlock(before, input);
        let number = e.word("a point that stands for all (number)", 0..=1) & 1;
        let mut detectors = 0;
        for place in 0..POINTS {
            detectors = if place == usize::from(number) { layout.plan().points[place].detectors.bits() } else { detectors };
        }
        let has = |bits: u32| bits >> number & 1 == 1;
        let (to_normal, to_reverse) = (has(output.drives.normal.bits()), has(output.drives.reverse.bits()));
        let driven = to_normal || to_reverse;
        e.claim(Claim::OneWay as u32, !(to_normal && to_reverse));
        let occupied = input.occupied.bits() & detectors != 0;
        e.claim(Claim::Train as u32, !driven || !occupied);
        let (mut asked, mut want_normal, mut want_reverse) = (false, false, false);
        if let Some(Request::Drive(point, position)) = input.request {
            asked = u16::from(point.number()) == number;
            want_normal = asked && position == Position::Normal;
            want_reverse = asked && position == Position::Reverse;
        }
        let accepted = asked && output.answer == Some(Ok(()));
        (want_normal, want_reverse) = (want_normal && accepted, want_reverse && accepted);
        let (mut detector_held, mut locked, mut held_at_all, mut past, mut fails, mut wanted) = (false, false, false, false, false, false);
        for number in 0..ROUTES {
            let (route, state) = (&layout.plan().routes[number], after.routes[number]);
            let (path, overlap) = (held(route, state), kept(route, state));
            let circuits = (path.circuits.bits() | overlap.circuits.bits()) & detectors != 0;
            let normal = has(path.positions.normal.bits() | overlap.positions.normal.bits());
            let reverse = has(path.positions.reverse.bits() | overlap.positions.reverse.bits());
            // A route that fails in this cycle was provisional while the points were driven, be it since this very cycle.
            let reserved_now = output.answer == Some(Ok(())) && matches!(input.request, Some(Request::Set(route)) if usize::from(route.number()) == number);
            let was_provisional = before.routes[number].phase == Phase::Provisional || reserved_now;
            let failed_now = state.phase == Phase::Failed && was_provisional;
            let provisional = state.phase == Phase::Provisional || failed_now;
            let is_past = state.phase != Phase::Idle && !provisional;
            past |= is_past;
            fails |= failed_now && (normal && to_normal || reverse && to_reverse);
            detector_held |= is_past && circuits;
            locked |= is_past && (normal || reverse);
            held_at_all |= state.phase != Phase::Idle && (circuits || normal || reverse);
            wanted |= provisional && (normal || reverse);
            want_normal |= provisional && normal;
            want_reverse |= provisional && reverse;
        }
        e.claim(Claim::Held as u32, !driven || !detector_held);
        e.claim(Claim::Locked as u32, !driven || !locked);
        e.claim(Claim::Wanted as u32, (!to_normal || want_normal) && (!to_reverse || want_reverse));
        let (normal, reverse) = (has(input.detected.normal.bits()), has(input.detected.reverse.bits()));
        e.claim(Claim::Elsewhere as u32, (!to_normal || !normal || reverse) && (!to_reverse || !reverse || normal));
        let blocked = after.works.blocked.bits() & detectors != 0;
        e.claim(Claim::Alone as u32, !accepted || !(held_at_all || occupied || blocked));
        e.cover(Cover::Route as u32, driven && !accepted && past);
        e.cover(Cover::Command as u32, driven && accepted);
        e.cover(Cover::Refused as u32, asked && !accepted && held_at_all && !occupied && !blocked);
        e.cover(Cover::Under as u32, wanted && occupied && !driven);
        e.cover(Cover::Fails as u32, fails);
    }
}

harness! {
    /// A point that was driven, by a route or by hand, counts as detected only once it has stood detected in one position for the settling time:
    /// no signal shows proceed over it before. The time since is a ghost.
    t_ilk_4_settled(e)
    theorem "T-ILK-4";
    requirements ["ILK-23"];
    assumptions [];
    bound "1 route of up to 2 circuits, 32 circuits, 2 points, no segment";
    cases 1;
    unwind 65 = 1 + crate::interlocking::LONGEST;
    claims {
        Stood: "proceed is shown only over points that have stood in position, undriven, for the settling time",
        Kept: "the machine counts no more cycles than have passed",
    }
    covers {
        Proceed: "proceed is shown over a point, with a settling time",
        Waits: "a point in position does not count yet",
    }
    {
        let Some((layout, before, input)) = any_cycle::<E, 1, 2, 2, 0>(e) else { return };
        let number = e.word("a point that stands for all (number)", 0..=1) & 1;
        let has = |bits: u32| bits >> number & 1 == 1;
        // For how many cycles it has been detected where it was last, and not been driven: a ghost.
        let stood = any_byte(e, "the point has stood for (cycles)", 0..=1);
        let count = |stood: PerPoint<u8>| if number == 0 { stood[0] } else { stood[1] };
        let (counted, last) = before.points.parts();
        e.assume(count(counted) <= stood);
        let (after, output) = layout.interlock(before, input);
        let driven = has(output.drives.normal.bits() | output.drives.reverse.bits());
        let both = has(input.detected.normal.bits() & input.detected.reverse.bits());
        let normal = has(input.detected.normal.bits()) && !both;
        let reverse = has(input.detected.reverse.bits()) && !both;
        let same = normal && has(last.normal.bits()) || reverse && has(last.reverse.bits());
        let stood = if same && !driven { stood.saturating_add(1) } else { 0 };
        e.claim(Claim::Kept as u32, count(after.points.parts().0) <= stood);
        let (route, state) = (&layout.plan().routes[0], after.routes[0]);
        let (path, overlap) = (held(route, state), kept(route, state));
        let needs = has(path.positions.points().bits() | overlap.positions.points().bits());
        let proceed = output.proceed.bits() & 1 == 1;
        let settled = (normal || reverse) && !driven && stood >= layout.plan().settle;
        e.claim(Claim::Stood as u32, !(proceed && needs) || settled);
        e.cover(Cover::Proceed as u32, proceed && needs && layout.plan().settle > 1);
        e.cover(Cover::Waits as u32, normal && !driven && !settled);
    }
}
