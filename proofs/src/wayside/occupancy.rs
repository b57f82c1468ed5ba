//! From sections to circuits (T-WAY-1, T-WAY-2), and what the constructor asks of the joint.

use super::plans::LONGEST;
use crate::Engine;
use crate::block::{any_detection, any_parts, suppose_count, suppose_no_phantom};
use crate::engine::any_byte;
use atc_kernel::block::{Block, Border, Direction, Hold, Line, LineState, State as Kept, Status};
use atc_kernel::distance::Metres;
use atc_kernel::interlocking::{CircuitSet, SegmentId, Travel};
use atc_kernel::time::Ticks;
use atc_kernel::wayside::Counted;

/// The circuits of the track in the direction of travel.
const TRACK: usize = 7;
/// The circuits of the segment.
const PLACES: usize = 4;

type Shape = (Travel, Direction, usize, [usize; 2], u8);

/// The direction of travel, whether the line's low end is its entry, the circuit of the track on which the first section is, the sections of
/// the first and of the second block from the low end, and the hold.
const CASES: [Shape; 6] = [
    (Travel::Toward, Direction::Up, 1, [1, 2], 1),
    (Travel::Toward, Direction::Down, 1, [2, 1], 2),
    (Travel::Toward, Direction::Down, 2, [1, 1], 2),
    (Travel::Away, Direction::Up, 3, [2, 1], 2),
    (Travel::Away, Direction::Down, 3, [1, 2], 1),
    (Travel::Away, Direction::Up, 2, [1, 1], 3),
];

pub const BOUND: &str = "1 route of 2 circuits, 1 segment of 4 circuits and its throat, 2 blocks of 1 or 2 sections";

/// The numbers of the circuits: 0 to 3 are the segment's, the one next to the station first, 4 is the throat, 5 and 6 are behind it.
fn number(travel: Travel, place: usize) -> usize {
    match travel {
        // 3 2 1 0 4 5 6
        Travel::Toward if place < PLACES => PLACES - 1 - place,
        Travel::Toward => place,
        // 6 5 4 0 1 2 3
        Travel::Away if place < TRACK - PLACES => TRACK - 1 - place,
        Travel::Away => place - (TRACK - PLACES),
    }
}

/// The circuit at a place of the track, as a set's bits.
fn at(travel: Travel, place: usize) -> u64 {
    1_u64.checked_shl(u32::from(number(travel, place).to_le_bytes()[0])).unwrap_or(0)
}

/// Any lengths of the track's circuits.
fn any_lengths<E: Engine + ?Sized>(e: &mut E) -> [u16; TRACK] {
    core::array::from_fn(|_| e.word("length of a circuit (m)", 5..=9))
}

/// A counted line on the circuits of a case.
struct Case {
    travel: Travel,
    direction: Direction,
    /// The place of the track where the entry section is.
    entry: usize,
    /// The sections of each block from the low end.
    sizes: [usize; 2],
    blocks: [Block; 2],
    hold: u8,
    train: u16,
}

impl Case {
    fn sections(&self) -> usize {
        self.sizes[0] + self.sizes[1]
    }

    /// The place of the track where a section of a block is, both numbered from the low end.
    fn place(&self, block: usize, section: usize) -> usize {
        let from_low = if block == 0 { section } else { self.sizes[0] + section };
        match self.direction {
            Direction::Up => self.entry + from_low,
            Direction::Down => self.entry + self.sections() - 1 - from_low,
        }
    }

    /// The joint, as the constructor makes it (`way_join`, `t_way_1_joint`): a line that is accepted, and holds that are long enough at the entry. `lengths` are those of
    /// the track's circuits.
    fn counted<E: Engine + ?Sized>(&self, e: &mut E, lengths: &[u16; TRACK]) -> Option<Counted<2>> {
        let mut sections = [[CircuitSet::EMPTY; 16]; 2];
        let mut from_low = [Metres(0); 4];
        for block in 0..2 {
            for section in 0..2 {
                if section < self.sizes[block] {
                    let place = self.place(block, section);
                    sections[block][section] = CircuitSet::from_bits(at(self.travel, place));
                    from_low[if block == 0 { section } else { self.sizes[0] + section }] = Metres(lengths[place]);
                }
            }
        }
        let line = Line::new(self.blocks, &from_low[..self.sections()], Metres(self.train), self.direction).ok();
        // Behind a front that has just passed `passed` sections.
        let mut long_enough = true;
        for passed in 0..=self.sections() {
            let (mut held, mut known) = (0_u32, true);
            for back in 1..=3 {
                if back <= usize::from(self.hold) {
                    known &= back <= self.entry + passed;
                    held += if known { u32::from(lengths[self.entry + passed - back]) } else { 0 };
                }
            }
            long_enough &= !known || held >= u32::from(self.train);
        }
        e.assume(line.is_some() && long_enough);
        let mut before = [CircuitSet::EMPTY; 16];
        for (back, circuits) in before.iter_mut().enumerate().take(TRACK) {
            if back < self.entry {
                *circuits = CircuitSet::from_bits(at(self.travel, self.entry - 1 - back));
            }
        }
        let beyond = CircuitSet::from_bits(at(self.travel, self.entry + self.sections()));
        Some(Counted::from_parts(line?, (SegmentId::ZERO, self.travel), sections, (before, beyond)))
    }

    /// The number from the low end of the block at a place of the line's state, which is in the direction of travel.
    fn block_at(&self, place: usize) -> usize {
        if self.direction == Direction::Up { place } else { 1 - place }
    }
}

fn any_line<E: Engine + ?Sized>(e: &mut E, cases: &[Shape]) -> Option<Case> {
    let case = e.choose("line", cases.len());
    let mut chosen = CASES[0];
    for (place, each) in cases.iter().enumerate() {
        if place == case {
            chosen = *each;
        }
    }
    let (travel, direction, entry, sizes, hold) = chosen;
    let hold = Hold::new(hold)?;
    let mut any_block = |sections: usize| {
        let max_trains = any_byte(e, "highest number of trains", 1..=2);
        let block = Block::new(sections.to_le_bytes()[0], max_trains, hold, Ticks(2)).ok();
        e.assume(block.is_some());
        block
    };
    let blocks = [any_block(sizes[0])?, any_block(sizes[1])?];
    let train = e.word("longest train (m)", 0..=8);
    Some(Case { travel, direction, entry, sizes, blocks, hold: hold.sections(), train })
}

/// Any valid state, as far as counting looks at it.
fn any_state<E: Engine + ?Sized>(e: &mut E, line: &Case, counted: &Counted<2>) -> Option<LineState<2>> {
    let blocks = [line.blocks[line.block_at(0)], line.blocks[line.block_at(1)]];
    let parts = [any_parts(e, blocks[0]), any_parts(e, blocks[1])];
    let border = any_byte(e, "border (trains)", 0..=2);
    let state = LineState { blocks: parts.map(Kept::from_parts), borders: [Border(0), Border(border)] };
    let valid = state.is_valid(counted.line());
    e.assume(valid);
    if valid { Some(state) } else { None }
}

/// Any set of the track's circuits.
fn any_occupied<E: Engine + ?Sized>(e: &mut E, what: &'static str) -> CircuitSet {
    CircuitSet::from_bits(u64::from(any_byte(e, what, 0..=127) & 127))
}

harness! {
    /// A ghost train on metres, its head on a section or beyond the exit: every circuit of the line under any part of it is told to the interlocking
    /// as occupied, and before the entry every one that the layout knows; whatever detections are missed, and whatever those circuits report.
    t_way_1(e)
    theorem "T-WAY-1";
    requirements ["WAY-1", "WAY-2"];
    assumptions [
        "no-phantom", "heard-by-one", "loops-overlap", "entries-apart", "check-in-fail-safe", "live-transmitter", "check-out-not-spurious",
        "verified-reset", "no-reversing-over-exit", "hold-covers-train", "loss-of-shunt-within-clear", "nose-antenna", "train-whole",
    ];
    built_in &[
        ("nose-antenna", "the head that a detector hears is the front of the ghost"),
        ("train-whole", "the ghost ends its length behind its front"),
    ];
    bound BOUND;
    cases CASES.len();
    unwind 65 = 1 + LONGEST;
    apart [0 1 2 3 4 5];
    claims {
        Head: "the circuit of a section with the front is occupied",
        Tail: "with the front on a section, so is every other circuit under the train, of a section or before the entry",
        Exit: "with the front beyond the exit, so is every circuit of a section under the train",
    }
    covers {
        Missed: "the head is missed",
        Across: "the front is on the line, the tail before the entry",
        Whole: "the train reaches over a whole section",
        Left: "the front is beyond the exit, the tail on the line",
        Agreed: "that with the line in agreement",
    }
    {
        let Some(line) = any_line(e, &CASES) else { return };
        let lengths = any_lengths(e);
        let Some(counted) = line.counted(e, &lengths) else { return };
        let Some(state) = any_state(e, &line, &counted) else { return };
        // The ghost: its front is in circuit `head` of the track, `into` metres beyond its beginning.
        let head = usize::from(e.word("the front's circuit", 3..=6));
        e.assume(head < TRACK && head >= line.entry);
        let (into, length) = (e.word("front into its circuit (m)", 0..=1), e.word("length of the train (m)", line.train..=line.train));
        e.suppose("hold-covers-train", length <= line.train);
        let likely = u16::from(head.saturating_sub(1).to_le_bytes()[0]);
        let under = usize::from(e.word("a circuit under the train", likely..=likely));
        // Metres from the end of that circuit to the front.
        let mut between = u32::from(into);
        let mut own = 0;
        for (place, length) in lengths.iter().enumerate() {
            let its = u32::from(*length);
            between += if place > under && place < head { its } else { 0 };
            own = if place == head { its } else { own };
        }
        e.assume(u32::from(into) < own);
        e.assume(under < head && between < u32::from(length));
        let on_line = head < line.entry + line.sections();
        let occupied = any_occupied(e, "reported (bits)");
        // Beyond the exit every circuit under the train reports it.
        let exit = line.entry + line.sections();
        let mut reports = true;
        for place in 0..TRACK {
            let its_part = place >= exit && place <= head && place >= under;
            reports &= !its_part || occupied.bits() & at(line.travel, place) != 0;
        }
        e.suppose("loss-of-shunt-within-clear", reports);
        let blocks = [any_detection(e, line.blocks[0]), any_detection(e, line.blocks[1])];
        let mut heads = [0_u16; 2];
        for (block, its) in heads.iter_mut().enumerate() {
            *its = e.word("other heads in a block (bits)", 0..=3) & 3;
            for section in 0..2 {
                let there = section < line.sizes[block];
                *its &= if there { 3 } else { !(1 << section) };
                *its |= if there && line.place(block, section) == head { 1 << section } else { 0 };
            }
        }
        let (_, report, told) = counted.count(state, blocks, occupied);
        let mut missed = false;
        for block in 0..2 {
            let all = if line.sizes[block] == 1 { 1 } else { 3 };
            let present = blocks[block].present.bits() & all;
            missed |= present != heads[block];
            suppose_no_phantom(e, present, heads[block]);
            let counts = report.blocks[block].status == Status::Counting;
            let number = (heads[block] & 1) + (heads[block] >> 1);
            suppose_count(e, !counts || u16::from(report.blocks[block].count.0) >= number);
        }
        let told = told.bits();
        e.claim(Claim::Head as u32, !on_line || told & at(line.travel, head) != 0);
        e.claim(Claim::Tail as u32, !on_line || told & at(line.travel, under) != 0);
        let tail_on_line = under >= line.entry && under < exit;
        e.claim(Claim::Exit as u32, on_line || !tail_on_line || told & at(line.travel, under) != 0);
        let agreed = report.blocks[0].agree && report.blocks[1].agree;
        e.cover(Cover::Missed as u32, on_line && missed);
        e.cover(Cover::Across as u32, on_line && under < line.entry && agreed);
        e.cover(Cover::Whole as u32, on_line && under + 1 < head && agreed);
        e.cover(Cover::Left as u32, !on_line && tail_on_line);
        e.cover(Cover::Agreed as u32, !on_line && tail_on_line && agreed && line.hold > 0);
    }
}

harness! {
    /// What a circuit reports is never masked, more reports never make fewer occupied circuits, and what is told besides is exactly what the counted line
    /// says of its sections and asks for before its entry.
    t_way_2(e)
    theorem "T-WAY-2";
    requirements ["WAY-1", "WAY-2"];
    assumptions [];
    bound BOUND;
    cases CASES.len();
    unwind 65 = 1 + LONGEST;
    apart [0 1 2 3 4 5];
    claims {
        Unmasked: "what is reported is told",
        Monotone: "with more reported, no circuit is told that is not told with more",
        Exact: "a circuit is told that is not reported if and only if its section is, or it is before the entry and asked for",
        Valid: "the line's state stays valid",
    }
    covers {
        More: "more reports make a section held",
        Before: "a circuit before the entry is told that reports nothing",
    }
    {
        let Some(line) = any_line(e, &CASES) else { return };
        let lengths = any_lengths(e);
        let Some(counted) = line.counted(e, &lengths) else { return };
        let Some(state) = any_state(e, &line, &counted) else { return };
        let blocks = [any_detection(e, line.blocks[0]), any_detection(e, line.blocks[1])];
        let occupied = any_occupied(e, "reported (bits)");
        let (after, report, told) = counted.count(state, blocks, occupied);
        let told = told.bits();
        let more = occupied.or(any_occupied(e, "reported besides (bits)"));
        let (_, _, other) = counted.count(state, blocks, more);
        let other = other.bits();
        e.claim(Claim::Unmasked as u32, occupied.bits() & !told == 0);
        e.claim(Claim::Monotone as u32, told & !other == 0);
        let mut expected = occupied.bits();
        for block in 0..2 {
            for section in 0..2_u8 {
                let its = usize::from(section);
                if its < line.sizes[block] && report.blocks[block].occupied.bits() >> section & 1 == 1 {
                    expected |= at(line.travel, line.place(block, its));
                }
            }
        }
        for back in 0..line.entry {
            if usize::from(report.before_hold.sections()) > back {
                expected |= at(line.travel, line.entry - 1 - back);
            }
        }
        e.claim(Claim::Exact as u32, told == expected);
        e.claim(Claim::Valid as u32, after.is_valid(counted.line()));
        e.cover(Cover::More as u32, other & !(told | more.bits()) != 0);
        let first = if line.entry > 0 { at(line.travel, line.entry - 1) } else { 0 };
        e.cover(Cover::Before as u32, told & first & !occupied.bits() != 0);
    }
}
