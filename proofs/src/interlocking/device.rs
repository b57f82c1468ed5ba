//! The step of the device: tracking, then the interlocking, then the ATC (T-ATC-3).

use crate::engine::any_u32;
use crate::interlocking::{LONGEST, any_input};
use atc_kernel::Machine;
use atc_kernel::interlocking::{
    CircuitSet, Combined, Directions, Epoch, Heading, Input, Layout, Memory, PerCircuit, Plan, Point, Segment,
    SegmentSet, State, Track, Works,
};
use atc_kernel::time::Ticks;

/// A layout of one segment and one point, without routes.
fn layout() -> Option<Layout<1, 1, 1, 1>> {
    let mut segment = Segment { outward: Heading::Left, ..Segment::NONE };
    segment.length = 1;
    segment.circuits[0] = CircuitSet::from_bits(1);
    let point = Point { detectors: CircuitSet::from_bits(2) };
    let plan = Plan { clear: 2, turn: Ticks(2), start: Ticks(1), points: [point], segments: [segment], ..Plan::EMPTY };
    Layout::with_what_proofs_need(plan).ok()
}

harness! {
    /// A step of the device is its three parts in a row: the tracking of the reported circuits; the interlocking, with the circuits that count as occupied and
    /// with detection, request, orders and consent as they came; the ATC, which reads the table by a count of its own. Nothing is left out, and nothing is
    /// wired to something else.
    t_atc_3_step(e)
    theorem "T-ATC-3";
    requirements ["ATC-15", "TRK-1", "ILK-16", "ILK-26"];
    assumptions [];
    bound "a layout without routes";
    cases 1;
    unwind 66 = 2 + LONGEST;
    claims {
        Interlocking: "state and output are those of the interlocking with what the tracking makes of the reports, and with all else as it came",
        Count: "the ATC's count goes on by one, whatever the table says",
        Stale: "where the table has another number, no train is told to go",
    }
    covers {
        Consent: "the segment outward may not be used, as the neighbour does not permit it",
        Asked: "a request is carried out",
        Ordered: "a circuit is unblocked",
        Differ: "the table has another number than the ATC's count",
    }
    {
        let Some(layout) = layout() else { return e.assume(false) };
        let track = Track::from_parts(PerCircuit::from_fn(|_| e.word("reported clear for (cycles)", 0..=1).to_le_bytes()[0]));
        let away = SegmentSet::from_bits(crate::engine::any_byte(e, "away (bits)", 0..=1));
        let before = State {
            track,
            started: Ticks(1),
            directions: Directions { away, ..Directions::INITIAL },
            works: Works { blocked: CircuitSet::from_bits(u64::from(e.word("blocked (bits)", 0..=3))), ..Works::INITIAL },
            epoch: Epoch(any_u32(e, "epoch", 0..=1)),
            ..State::INITIAL
        };
        let count = Epoch(any_u32(e, "the ATC's count", 0..=1));
        let input = any_input(e);
        let (memory, commands) = Combined(&layout).step(Memory { interlocking: before, cycle: count }, input);
        let (tracked, occupied) = track.step(2, input.occupied);
        let Input { detected, request, orders, consent, .. } = input;
        let parts = Input { occupied, detected, request, orders, consent };
        let (after, output) = layout.interlock(State { track: tracked, ..before }, parts);
        e.claim(Claim::Interlocking as u32, memory.interlocking == after && commands.interlocking == output);
        e.claim(Claim::Count as u32, memory.cycle.0 == count.0.wrapping_add(1));
        let same = after.epoch.0 == memory.cycle.0;
        let mut goes = false;
        for movement in commands.telegrams.iter().flatten() {
            goes |= movement.speed.0 > 0 || movement.hold.bits() != 0;
        }
        e.claim(Claim::Stale as u32, same || !goes);
        let (_, _, contents) = commands.interlocking.table.parts();
        e.cover(Cover::Consent as u32, after.directions.away.bits() & 1 == 1 && contents.away.is_empty());
        e.cover(Cover::Asked as u32, matches!(commands.interlocking.answer, Some(Ok(()))));
        e.cover(Cover::Ordered as u32, before.works.blocked.bits() & !after.works.blocked.bits() != 0);
        e.cover(Cover::Differ as u32, !same);
    }
}
