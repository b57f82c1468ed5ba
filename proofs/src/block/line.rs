//! Lines: borders (T-BLK-3), tails across them (T-BLK-4), and what a line makes of its blocks (T-BLK-5).

use super::{all, any_byte, any_flag, any_hold, any_parts, any_reset, has, ones, suppose_count, suppose_no_phantom};
use crate::Engine;
use atc_kernel::Machine;
use atc_kernel::block::{
    Beyond, Block, Border, Detection, Direction, Hold, Input, Line, LineInput, LineOutput, LineState, Metres, Output,
    Parts, SectionSet, State, Status, step,
};
use atc_kernel::time::Ticks;

/// Sections of the block behind and of the block ahead, case by case.
const SIZES: [(u8, u8); 5] = [(3, 2), (1, 3), (8, 8), (16, 2), (2, 16)];
const BOUND: &str = "blocks of 3 and 2, 1 and 3, 8 and 8, 16 and 2, 2 and 16 sections";

/// The sections of the longest line among them.
const LENGTHS: usize = 18;

/// One cycle of a line of two blocks from an arbitrary valid state. `behind` and `ahead` are in the direction of travel.
struct Cycle {
    line: Line<2>,
    blocks: [Block; 2],
    direction: Direction,
    before: [Parts; 2],
    border: u8,
    detections: [Detection; 2],
    beyond: Beyond,
    after: [Parts; 2],
    next: LineState<2>,
    output: LineOutput<2>,
}

const BEHIND: usize = 0;
const AHEAD: usize = 1;

impl Cycle {
    /// What the block at `place` reports, with its sections numbered from the low end.
    fn report(&self, place: usize) -> Output {
        self.output.blocks[if self.direction == Direction::Up { place } else { 1 - place }]
    }

    /// A set of sections of the block at `place`, seen from the other end where the line is travelled downwards.
    fn oriented(&self, place: usize, set: SectionSet) -> SectionSet {
        if self.direction == Direction::Up { set } else { set.reversed(self.blocks[place].sections()) }
    }

    /// What the block at `place` would report alone.
    fn alone(&self, place: usize, ahead_hold: Hold, ahead_entered: bool) -> Output {
        let state = State::from_parts(self.before[place]);
        let (_, report) = step(self.blocks[place], state, self.input(place, ahead_hold, ahead_entered));
        Output { occupied: self.oriented(place, report.occupied), ..report }
    }

    /// What the block at `place` detects, seen from the entry end.
    fn input(&self, place: usize, ahead_hold: Hold, ahead_entered: bool) -> Input {
        let detection = self.detections[place];
        let (check_in, check_out) = match self.direction {
            Direction::Up => (detection.low_check, detection.high_check),
            Direction::Down => (detection.high_check, detection.low_check),
        };
        let present = self.oriented(place, detection.present);
        Input { check_in, check_out, present, reset: detection.reset, ahead_hold, ahead_entered }
    }

    /// Whether the check-in of the block ahead rises.
    fn edge_ahead(&self) -> bool {
        self.input(AHEAD, Hold::NONE, false).check_in && self.before[AHEAD].check_in_for == 0
    }

    fn counted(&self, place: usize) -> bool {
        self.before[place].status == Status::Counting
    }

    fn counts(&self, place: usize) -> bool {
        self.after[place].status == Status::Counting
    }

    fn reset(&self) -> bool {
        self.detections[BEHIND].reset.is_some() || self.detections[AHEAD].reset.is_some()
    }
}

/// The sections of a block of `sections` sections, numbered from the other end, found the slow way.
fn mirrored(bits: u16, sections: u8) -> u16 {
    let mut other = 0;
    for section in 0..16 {
        if section < sections && has(bits, section) {
            other |= 1 << ((sections - 1 - section) & 15);
        }
    }
    other
}

/// Whether two reports are the same, field by field.
fn same(one: Output, other: Output) -> bool {
    one.occupied == other.occupied
        && one.behind_hold == other.behind_hold
        && one.agree == other.agree
        && one.count == other.count
        && one.status == other.status
        && one.counted_in == other.counted_in
        && one.counted_out == other.counted_out
}

pub(crate) fn any_detection<E: Engine + ?Sized>(e: &mut E, block: Block) -> Detection {
    Detection {
        low_check: any_flag(e, "check at the low end (odd: on)"),
        high_check: any_flag(e, "check at the high end (odd: on)"),
        present: SectionSet::from_bits(e.word("detections from the low end (bits)", 0..=block.all().bits())),
        reset: any_reset(e),
    }
}

fn any_cycle<E: Engine + ?Sized>(e: &mut E) -> Option<Cycle> {
    let case = e.choose("sizes of the two blocks", SIZES.len());
    let mut sizes = SIZES[0];
    for (place, pair) in SIZES.into_iter().enumerate() {
        if place == case {
            sizes = pair;
        }
    }
    let hold = any_hold(e, "tail hold (sections)", 4)?;
    let mut any_block = |sections: u8| {
        let max_trains = any_byte(e, "highest number of trains", 1..=u16::from(sections));
        let pass = Ticks(e.word("pass time (cycles)", 1..=3));
        let block = Block::new(sections, max_trains, hold, pass).ok();
        e.assume(block.is_some());
        block
    };
    let blocks = [any_block(sizes.0)?, any_block(sizes.1)?];
    let direction = if any_flag(e, "direction (odd: down)") { Direction::Down } else { Direction::Up };
    let from_low = |pair: [Block; 2]| if direction == Direction::Up { pair } else { [pair[1], pair[0]] };
    let lengths = [Metres(1); LENGTHS];
    let sections = usize::from(sizes.0 + sizes.1);
    // No train is longer than nothing: the geometry is proven apart.
    let Ok(line) = Line::new(from_low(blocks), &lengths[..sections], Metres(0), direction) else {
        e.assume(false);
        return None;
    };
    let before = [any_parts(e, blocks[BEHIND]), any_parts(e, blocks[AHEAD])];
    let border = any_byte(e, "border (trains)", 0..=16);
    let state = LineState { blocks: before.map(State::from_parts), borders: [Border(0), Border(border)] };
    e.assume(state.is_valid(&line));
    let detections = [any_detection(e, blocks[BEHIND]), any_detection(e, blocks[AHEAD])];
    let beyond = Beyond {
        hold: any_hold(e, "asked from beyond the exit (sections)", 3)?,
        entered: any_flag(e, "beyond the exit the train is taken over (odd: yes)"),
    };
    let geographic = if direction == Direction::Up { detections } else { [detections[1], detections[0]] };
    let (next, output) = line.step(state, LineInput { blocks: geographic, beyond });
    let after = [next.blocks[BEHIND].parts(), next.blocks[AHEAD].parts()];
    Some(Cycle { line, blocks, direction, before, border, detections, beyond, after, next, output })
}

harness! {
    /// Borders: a train is let go only for a rising check-in ahead that let no other go, so that between two blocks that count
    /// no train is lost.
    t_blk_3_border(e)
    theorem "T-BLK-3";
    requirements ["BLK-6", "BLK-10"];
    assumptions [];
    bound BOUND;
    cases SIZES.len();
    unwind 20 = 2 + LENGTHS;
    apart [0 1 2 3 4];
    claims {
        LetGo: "the block behind lets a train go only for a check-in ahead that has risen and let no other go",
        Conserved: "while both count, the two counts less the trains in both move by exactly the trains that come in at the line's entry and go out at its exit",
        Account: "the account moves by exactly the edges ahead and the trains let go; a reset on either side or a block behind that does not count ends it",
        Valid: "the line's state stays valid",
    }
    covers {
        Early: "the edge of the block ahead comes before the check-out",
        Late: "the check-out waits for the edge of the block ahead",
        NotCounted: "a block that does not count takes over a train whose check-in rises",
        Full: "an edge is lost because 16 are remembered",
        Down: "travel downwards",
    }
    {
        let Some(cycle) = any_cycle(e) else { return };
        let (behind, ahead) = (cycle.report(BEHIND), cycle.report(AHEAD));
        let let_go = u32::from(behind.counted_out);
        let border = u32::from(cycle.border);
        let edge = u32::from(cycle.edge_ahead());
        let edges = border + edge;
        e.claim(Claim::LetGo as u32, !behind.counted_out || edges > 0);
        let after = u32::from(cycle.next.borders[1].0);
        let trains = |parts: &[Parts; 2], border: u32| i32::from(parts[0].count) + i32::from(parts[1].count) - i32::from(border.to_le_bytes()[0]);
        let moved = i32::from(behind.counted_in) - i32::from(ahead.counted_out);
        // An edge that is forgotten (16 are remembered) keeps a train in both counts.
        let (was, is) = (trains(&cycle.before, border) + moved, trains(&cycle.after, after));
        let counted = cycle.counts(BEHIND) && cycle.counts(AHEAD) && cycle.counted(BEHIND) && cycle.counted(AHEAD);
        let undisturbed = counted && !cycle.reset();
        e.claim(Claim::Conserved as u32, !undisturbed || was == is || edges > 16 && was < is);
        let account = if cycle.counts(BEHIND) && !cycle.reset() { edges.min(16).saturating_sub(let_go) } else { 0 };
        e.claim(Claim::Account as u32, after == account);
        e.claim(Claim::Valid as u32, cycle.next.is_valid(&cycle.line));
        e.cover(Cover::Early as u32, undisturbed && let_go == 1 && border > 0 && edge == 0);
        e.cover(Cover::Late as u32, undisturbed && let_go == 1 && cycle.before[BEHIND].pending > 0 && border == 0);
        e.cover(Cover::NotCounted as u32, let_go == 1 && !cycle.counts(AHEAD));
        e.cover(Cover::Full as u32, undisturbed && border == 16 && edge == 1 && let_go == 0);
        e.cover(Cover::Down as u32, cycle.direction == Direction::Down && ahead.counted_in);
    }
}

harness! {
    /// A line is its blocks: each reports what it would alone, with what the next one asks and takes over in the same cycle, in
    /// either direction.
    t_blk_5_line(e)
    theorem "T-BLK-5";
    requirements ["BLK-5", "BLK-10", "BLK-11"];
    assumptions [];
    bound BOUND;
    cases SIZES.len();
    unwind 20 = 2 + LENGTHS;
    apart [0 1 2 3 4];
    claims {
        Ahead: "the block ahead reports what it would alone, with what is asked from beyond the exit",
        Behind: "the block behind reports what it would alone, with what the block ahead asks, and takes over if its check-in rises or has risen",
        Before: "the line asks before its entry for what its first block asks",
    }
    covers {
        Down: "travel downwards, with a hold across the border",
        Up: "travel upwards, with a hold across the border",
    }
    {
        let Some(cycle) = any_cycle(e) else { return };
        let (behind, ahead) = (cycle.report(BEHIND), cycle.report(AHEAD));
        let beyond = cycle.beyond;
        e.claim(Claim::Ahead as u32, same(ahead, cycle.alone(AHEAD, beyond.hold, beyond.entered)));
        let entered = cycle.border > 0 || cycle.edge_ahead();
        e.claim(Claim::Behind as u32, same(behind, cycle.alone(BEHIND, ahead.behind_hold, entered)));
        e.claim(Claim::Before as u32, cycle.output.before_hold == behind.behind_hold);
        let held = behind.agree && ahead.behind_hold.sections() > 0;
        e.cover(Cover::Down as u32, held && cycle.direction == Direction::Down);
        e.cover(Cover::Up as u32, held && cycle.direction == Direction::Up);
    }
}

harness! {
    /// Seen from the other end, section i of a block of n is section n - 1 - i.
    blk_11(e)
    theorem "T-BLK-5";
    requirements ["BLK-11"];
    assumptions [];
    bound "";
    cases 1;
    unwind 20 = 2 + LENGTHS;
    claims {
        Mirror: "a section is in the set if and only if its mirror image is in the reversed one, and nothing else is",
    }
    covers {
        Full: "a block of 16 sections",
        Short: "a block of fewer sections, with a detection that it does not have",
    }
    {
        let bits = e.word("sections (bits)", 0..=u16::MAX);
        let sections = any_byte(e, "sections", 1..=16);
        e.assume((1..=16).contains(&sections));
        e.claim(Claim::Mirror as u32, SectionSet::from_bits(bits).reversed(sections).bits() == mirrored(bits, sections));
        e.cover(Cover::Full as u32, sections == 16 && bits != 0);
        e.cover(Cover::Short as u32, sections < 16 && bits >> sections != 0);
    }
}

harness! {
    /// Tail cover across a border: behind a head in the block ahead, with a count there that is not under its trains and no
    /// phantom detection, the sections up to k behind are occupied in the block behind, or asked for before the line's entry.
    t_blk_4_line(e)
    theorem "T-BLK-4";
    requirements ["BLK-5"];
    assumptions [
        "no-phantom", "heard-by-one", "loops-overlap", "entries-apart", "check-in-fail-safe", "live-transmitter", "check-out-not-spurious",
        "verified-reset", "no-reversing-over-exit",
    ];
    bound BOUND;
    cases SIZES.len();
    unwind 20 = 2 + LENGTHS;
    apart [0 1 2 3 4];
    claims {
        Behind: "a section of the block behind that is at most k behind a head in the block ahead is occupied",
        Before: "a section before the line's entry that is at most k behind a head in the block ahead is asked for",
        Unknown: "while the block ahead does not agree, its k last sections' worth behind its own entry is occupied",
    }
    covers {
        Crosses: "a tail in the block behind, both blocks in agreement",
        Through: "a tail through the whole block behind",
        Down: "travel downwards, a tail across the border",
    }
    {
        let Some(cycle) = any_cycle(e) else { return };
        let (behind, ahead) = (cycle.report(BEHIND), cycle.report(AHEAD));
        let heads = e.word("sections ahead with a head (bits)", 0..=7) & all(cycle.blocks[AHEAD].sections());
        let detected = cycle.oriented(AHEAD, cycle.detections[AHEAD].present).bits();
        suppose_no_phantom(e, detected & all(cycle.blocks[AHEAD].sections()), heads);
        suppose_count(e, !cycle.counts(AHEAD) || u32::from(ahead.count.0) >= ones(heads));
        let head = any_byte(e, "a head's section ahead", 0..=2);
        let distance = any_byte(e, "sections behind", 1..=4);
        let hold = cycle.blocks[AHEAD].hold().sections();
        e.assume(has(heads, head) && distance > head && distance <= hold);
        // Counted from the border: the last section of the block behind is 1 over it.
        let (over, sections) = (distance.saturating_sub(head), cycle.blocks[BEHIND].sections());
        let reported = cycle.oriented(BEHIND, behind.occupied).bits();
        let occupied = over <= sections && has(reported, sections.wrapping_sub(over));
        e.claim(Claim::Behind as u32, over > sections || occupied);
        e.claim(Claim::Before as u32, over <= sections || cycle.output.before_hold.sections() >= over - sections);
        let unknown = !ahead.agree && distance <= sections;
        e.claim(Claim::Unknown as u32, !unknown || has(reported, sections.wrapping_sub(distance)));
        let agreed = behind.agree && ahead.agree;
        e.cover(Cover::Crosses as u32, agreed && over <= sections);
        e.cover(Cover::Through as u32, agreed && over > sections);
        e.cover(Cover::Down as u32, agreed && cycle.direction == Direction::Down);
    }
}

harness! {
    /// A line of three blocks is its blocks: every border has its own account, and asks and takes over in the same cycle. It
    /// starts valid, with nothing on account, and steps from any state.
    t_blk_5_three(e)
    theorem "T-BLK-5";
    requirements ["BLK-5", "BLK-10", "BLK-11", "GEN-1", "GEN-2"];
    assumptions [];
    bound "blocks of 2, 1 and 2 sections";
    cases 1;
    unwind 20 = 2 + LENGTHS;
    claims {
        Report: "each block reports what it would alone, with what the next one asks and takes over, and its state is that of its step",
        Account: "each border's account moves by its own edges, trains let go and resets",
        Start: "the initial state is valid, every block unverified and nothing on account; the safe output reports all and asks for the longest hold",
        First: "the border at the entry remembers nothing",
    }
    covers {
        Corrupt: "a step from a state that is not valid",
        Both: "two borders take over in one cycle",
    }
    {
        let Some(hold) = any_hold(e, "tail hold (sections)", 4) else { return };
        let made = [2u8, 1, 2].map(|sections| {
            let max_trains = any_byte(e, "highest number of trains", 1..=u16::from(sections));
            Block::new(sections, max_trains, hold, Ticks(e.word("pass time (cycles)", 1..=3)))
        });
        let [Ok(first), Ok(second), Ok(third)] = made else { return e.assume(false) };
        let blocks = [first, second, third];
        let down = any_flag(e, "direction (odd: down)");
        let low = if down { [third, second, first] } else { blocks };
        let direction = if down { Direction::Down } else { Direction::Up };
        let Ok(line) = Line::new(low, &[Metres(1); 5], Metres(0), direction) else { return e.assume(false) };
        let start = line.initial();
        let mut starts = start.is_valid(&line);
        for place in 0..3 {
            starts &= start.blocks[place].parts().status == Status::Unverified && start.borders[place] == Border(0);
        }
        let safe = <Line<3> as Machine>::SAFE;
        for report in safe.blocks {
            starts &= report.occupied.bits() == u16::MAX && report.behind_hold.sections() == 16 && !report.agree;
        }
        e.claim(Claim::Start as u32, starts && safe.before_hold.sections() == 16);
        let before = [any_parts(e, first), any_parts(e, second), any_parts(e, third)];
        let borders = [any_byte(e, "border (trains)", 0..=2), any_byte(e, "border (trains)", 0..=2), any_byte(e, "border (trains)", 0..=2)];
        let detections = [any_detection(e, first), any_detection(e, second), any_detection(e, third)];
        let Some(asked) = any_hold(e, "asked from beyond the exit (sections)", 3) else { return };
        let beyond = Beyond { hold: asked, entered: any_flag(e, "beyond the exit the train is taken over (odd: yes)") };
        let state = LineState { blocks: before.map(State::from_parts), borders: borders.map(Border) };
        let read = if down { [detections[2], detections[1], detections[0]] } else { detections };
        let (next, output) = line.step(state, LineInput { blocks: read, beyond });
        let (mut reports, mut account) = (true, true);
        let (mut asked, mut entered, mut edges, mut reset, mut taken) = (beyond.hold, beyond.entered, 0_u32, false, 0);
        for place in [2, 1, 0] {
            let (block, detection) = (blocks[place], detections[place]);
            let (check_in, check_out) = if down { (detection.high_check, detection.low_check) } else { (detection.low_check, detection.high_check) };
            let seen = |set: SectionSet| if down { set.reversed(block.sections()) } else { set };
            let input = Input { check_in, check_out, present: seen(detection.present), reset: detection.reset, ahead_hold: asked, ahead_entered: entered };
            let (after, alone) = step(block, state.blocks[place], input);
            let report = output.blocks[if down { 2 - place } else { place }];
            reports &= same(report, Output { occupied: seen(alone.occupied), ..alone }) && next.blocks[place] == after;
            if place < 2 {
                let keeps = alone.status == Status::Counting && !reset && detection.reset.is_none();
                let expected = if keeps { edges.saturating_sub(u32::from(alone.counted_out)) } else { 0 };
                account &= u32::from(next.borders[place + 1].0) == expected;
                taken += u32::from(alone.counted_out);
            }
            let was = u32::from(borders[place]);
            let rises = check_in && before[place].check_in_for == 0;
            edges = if rises && was < 16 { was + 1 } else { was };
            (asked, entered, reset) = (alone.behind_hold, was > 0 || rises, detection.reset.is_some());
        }
        e.claim(Claim::Report as u32, reports && output.before_hold == asked);
        e.claim(Claim::Account as u32, account);
        e.claim(Claim::First as u32, next.borders[0] == Border(0));
        e.cover(Cover::Corrupt as u32, !state.is_valid(&line));
        e.cover(Cover::Both as u32, taken == 2);
    }
}
