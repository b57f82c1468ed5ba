//! From sections to circuits (T-WAY-1, T-WAY-2), and what the constructor asks of the joint.

use super::{LONGEST, plan};
use crate::Engine;
use crate::block::{any_detection, any_parts, suppose_count, suppose_no_phantom};
use crate::engine::{any_byte, any_flag};
use atc_kernel::block::{Block, Border, Direction, Hold, Line, LineError, LineState, State as Kept, Status};
use atc_kernel::distance::Metres;
use atc_kernel::interlocking::{
    CircuitId, CircuitSet, Element, Layout, Positions, Route, Segment, SegmentId, SegmentSet, Travel,
};
use atc_kernel::time::Ticks;
use atc_kernel::wayside::{Counted, Join, WaysideError};

/// The circuits of the track in the direction of travel.
const TRACK: usize = 7;
/// The circuits of the segment.
const PLACES: usize = 4;

type Station = Layout<1, PLACES, 0, 1>;

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

/// Those whose hold reaches over the entry: to the end of the segment, and behind the throat.
const HOLDS: [Shape; 2] = [CASES[1], CASES[5]];

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
    1 << number(travel, place)
}

/// Any lengths of the track's circuits.
fn any_lengths<E: Engine + ?Sized>(e: &mut E) -> [u16; TRACK] {
    core::array::from_fn(|_| e.word("length of a circuit (m)", 5..=9))
}

/// The station: a route over throat and one circuit more, in the direction of travel, with these lengths.
fn station(travel: Travel, lengths: [u16; TRACK]) -> Option<Station> {
    let mut made = plan::<1, PLACES, 1>();
    made.turn = Ticks(2);
    let place = |number| Element { circuits: CircuitSet::nth(number), positions: Positions::NONE };
    let mut path = [Element::default(); PLACES];
    let one = SegmentSet::nth(0);
    let (entry, from, to) = match travel {
        Travel::Toward => {
            (path[0], path[1]) = (place(4), place(5));
            (CircuitSet::nth(0), one, SegmentSet::EMPTY)
        }
        Travel::Away => {
            (path[0], path[1]) = (place(5), place(4));
            (CircuitSet::nth(6), SegmentSet::EMPTY, one)
        }
    };
    let timed = Ticks(1);
    made.routes =
        [Route { entry, path, length: 2, from, to, drive: timed, release: timed, stay: timed, ..Route::NONE }];
    let circuits = core::array::from_fn(CircuitSet::nth);
    made.segments = [Segment { circuits, length: 4, throat: CircuitSet::nth(4), ..Segment::NONE }];
    for (length, its) in made.lengths.iter_mut().zip(lengths) {
        *length = Metres(its);
    }
    Layout::with_what_proofs_need(made).ok()
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

    fn join(&self) -> Join<2> {
        let mut circuits = [[None; 16]; 2];
        for (block, row) in circuits.iter_mut().enumerate() {
            for (section, circuit) in row.iter_mut().enumerate().take(2) {
                if section < self.sizes[block] {
                    let number = number(self.travel, self.place(block, section));
                    *circuit = CircuitId::new(number.to_le_bytes()[0]);
                }
            }
        }
        Join {
            blocks: self.blocks,
            direction: self.direction,
            train: Metres(self.train),
            segment: SegmentId::ZERO,
            travel: self.travel,
            circuits,
        }
    }

    /// The joint, as the constructor makes it (`way_join`): a line that is accepted, and holds that are long enough at the entry. `lengths` are those of
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

/// Any circuit for a section; mostly the one that is right.
fn any_circuit<E: Engine + ?Sized>(e: &mut E, right: Option<CircuitId>) -> Option<CircuitId> {
    let other = CircuitId::new(any_byte(e, "another circuit (8 and more: none)", 0..=8)).filter(|it| it.number() < 8);
    if e.word("another circuit for the section (1 mod 8: yes)", 0..=7) & 7 == 1 { other } else { right }
}

/// The lengths of the places before the entry, the nearest first, and how many there are; `entry` is a place from the throat outwards.
fn metres_before(station: &Station, travel: Travel, entry: u8, has_route: bool) -> ([u32; 3], usize) {
    let length_of = |rank: u8| station.plan().lengths[if rank == 0 { 4 } else { usize::from(rank) - 1 }].0;
    let mut track = [0_u32; 3];
    let mut known = 0;
    for back in 1..=3_u8 {
        let place = match travel {
            Travel::Toward => Some(entry + back).filter(|place| *place <= 4).map(length_of),
            Travel::Away if back <= entry => Some(length_of(entry - back)),
            // The route out, if there is one: circuit 5, then its entry 6.
            Travel::Away => match (has_route, back - entry) {
                (true, 1) => Some(station.plan().lengths[5].0),
                (true, 2) => Some(station.plan().lengths[6].0),
                _ => None,
            },
        };
        if let (Some(place), true) = (place, known + 1 == usize::from(back)) {
            track[known] = u32::from(place);
            known += 1;
        }
    }
    (track, known)
}

/// Whether somewhere the k places behind a front are shorter than the train, and whether that is so on the line itself.
fn is_short(line: &Case, (lengths, count): ([u32; 4], usize), (before, known): ([u32; 3], usize)) -> (bool, bool) {
    let hold = usize::from(line.hold);
    let up = line.direction == Direction::Up;
    let (mut short, mut short_on_line) = (false, false);
    for front in 0..=4 {
        if front <= count && hold <= front + known {
            let mut behind = 0;
            for back in 1..=3 {
                if back <= hold {
                    behind += match front.checked_sub(back) {
                        Some(place) if up => lengths[place],
                        Some(place) => lengths[count - 1 - place],
                        None => before[back - front - 1],
                    };
                }
            }
            short |= behind < u32::from(line.train);
            short_on_line |= hold <= front && behind < u32::from(line.train);
        }
    }
    (short, short_on_line)
}

/// What a joint is like.
struct Seen {
    /// Two sections are on one circuit.
    twice: bool,
    /// Every section has a circuit of the segment or its throat, and no other place has one.
    there: bool,
}

/// What the constructor says of a joint, and what it should say.
struct Outcome {
    made: Result<Counted<2>, WaysideError>,
    /// Every rule is kept.
    legal: bool,
    /// The error names a rule that is broken.
    told: bool,
    seen: Seen,
}

/// Joins a line to a station. `given` are the circuits on the places of its blocks, `turned` whether its direction of travel is the other one.
fn joined(line: &Case, station: &Station, given: [[Option<CircuitId>; 2]; 2], turned: bool) -> Outcome {
    let mut join = line.join();
    for (row, circuits) in join.circuits.iter_mut().zip(given) {
        for (place, circuit) in row.iter_mut().zip(circuits) {
            *place = circuit;
        }
    }
    if turned {
        join.travel = if line.travel == Travel::Toward { Travel::Away } else { Travel::Toward };
    }
    let made = Counted::new(station, &join);
    // Every section has a circuit, and no other place has.
    let (mut complete, mut there, mut order, mut twice) = (true, true, true, false);
    // Outwards from the throat: circuit 4 is place 0, circuits 0 to 3 are places 1 to 4.
    let rank = |circuit: CircuitId| match circuit.number() {
        4 => Some(0_u8),
        number if number < 4 => Some(number + 1),
        _ => None,
    };
    let outwards = (join.travel == Travel::Away) == (join.direction == Direction::Up);
    let mut before: Option<u8> = None;
    let mut first: Option<u8> = None;
    let mut lengths = [0_u32; 4];
    let mut count = 0;
    for (block, row) in given.iter().enumerate() {
        for (section, circuit) in row.iter().enumerate() {
            let needed = section < line.sizes[block];
            complete &= circuit.is_some() == needed;
            let Some(circuit) = *circuit else { continue };
            let Some(place) = rank(circuit) else {
                there = false;
                continue;
            };
            let follows = before.is_none_or(|before| if outwards { place == before + 1 } else { place + 1 == before });
            twice |= before == Some(place);
            order &= follows;
            before = Some(place);
            first = first.or(before);
            lengths[count] = u32::from(station.plan().lengths[usize::from(circuit.number())].0);
            count += 1;
        }
    }
    let sound = complete && there && order;
    let up = join.direction == Direction::Up;
    let (entry, exit) = if up { (first, before) } else { (before, first) };
    let (entry, exit) = (entry.unwrap_or(0), exit.unwrap_or(0));
    // What is beyond the exit by the layout: circuits outwards, or the throat and what is behind it.
    let ends = join.travel == Travel::Away && exit == 4;
    // Travelling towards the station from the throat, nothing is known beyond: the route begins before it.
    let ends = ends || join.travel == Travel::Toward && exit == 0;
    let travel = join.travel;
    let before = metres_before(station, travel, entry, !turned);
    let (short, short_on_line) = is_short(line, (lengths, count), before);
    let mut no_length = false;
    for (place, length) in lengths.iter().enumerate() {
        no_length |= place < count && *length == 0;
    }
    let legal = !turned && sound && !ends && !short && !no_length;
    let told = match made {
        Ok(_) => true,
        Err(WaysideError::RouteAgainstTheLine(0)) => turned,
        Err(WaysideError::SectionWithoutCircuit(_) | WaysideError::CircuitWithoutSection(_)) => !complete,
        Err(WaysideError::SectionElsewhere(_)) => !there,
        Err(WaysideError::SectionsOutOfOrder(_)) => !order,
        Err(WaysideError::Line(LineError::NoLength(_))) => no_length,
        Err(WaysideError::NothingBeyondTheExit) => ends,
        Err(WaysideError::Line(LineError::HoldTooShort(_))) => short_on_line,
        Err(WaysideError::HoldTooShortAtTheEntry) => short,
        Err(_) => false,
    };
    Outcome { made, legal, told, seen: Seen { twice, there: complete && there } }
}

harness! {
    /// A counted line is accepted if and only if each of its sections, and nothing else, has a circuit; these are of the segment or its throat and follow each
    /// other as the sections do; a circuit is beyond the exit; and no route leads against it. The error names a rule that is broken. All circuits are
    /// of one length, and no train is longer than nothing: that is for `way_join_hold`.
    way_join(e)
    theorem "T-WAY-8";
    requirements ["WAY-11", "WAY-12", "WAY-13", "WAY-15"];
    assumptions [];
    bound BOUND;
    cases CASES.len();
    unwind 65 = 1 + LONGEST;
    apart [0 1 2 3 4 5];
    claims {
        Exact: "accepted if and only if every rule is kept",
        Told: "the error names a rule that is broken",
    }
    covers {
        Accepted: "a line is accepted",
        Reversed: "a line in the reversed order",
        Twice: "two sections on one circuit",
        Against: "a route against the line",
        Beyond: "a line that ends where the device sees nothing",
    }
    {
        let Some(mut line) = any_line(e, &CASES) else { return };
        line.train = 0;
        let Some(station) = station(line.travel, [2; TRACK]) else { return e.claim(Claim::Exact as u32, false) };
        let its = line.join().circuits;
        let mut given = [[None; 2]; 2];
        for (block, row) in given.iter_mut().enumerate() {
            for (section, circuit) in row.iter_mut().enumerate() {
                *circuit = any_circuit(e, its[block][section]);
            }
        }
        let turned = any_flag(e, "the direction of travel is the other (odd: yes)");
        let Outcome { made, legal, told, seen: Seen { twice, there } } = joined(&line, &station, given, turned);
        e.claim(Claim::Exact as u32, made.is_ok() == legal);
        e.claim(Claim::Told as u32, told);
        e.cover(Cover::Accepted as u32, made.is_ok());
        e.cover(Cover::Reversed as u32, matches!(made, Err(WaysideError::SectionsOutOfOrder(_))) && !twice && there);
        e.cover(Cover::Twice as u32, matches!(made, Err(WaysideError::SectionsOutOfOrder(_))) && twice);
        e.cover(Cover::Against as u32, matches!(made, Err(WaysideError::RouteAgainstTheLine(_))));
        e.cover(Cover::Beyond as u32, matches!(made, Err(WaysideError::NothingBeyondTheExit)));
    }
}

harness! {
    /// A counted line on the right circuits is accepted if and only if every circuit on it has a length, and wherever a front is, the held places behind it, of
    /// sections and of circuits before the entry, are together no shorter than the longest train. The error names a rule that is broken.
    way_join_hold(e)
    theorem "T-WAY-8";
    requirements ["WAY-14"];
    assumptions [];
    bound BOUND;
    cases HOLDS.len();
    unwind 65 = 1 + LONGEST;
    apart [0 1];
    claims {
        Exact: "accepted if and only if every rule is kept",
        Told: "the error names a rule that is broken",
    }
    covers {
        Accepted: "a line is accepted",
        Short: "a hold that is too short at the entry only",
        Line: "a hold that is too short on the line",
    }
    {
        let Some(line) = any_line(e, &HOLDS) else { return };
        let lengths = core::array::from_fn(|_| e.word("length of a circuit (m)", 1..=4));
        let station = station(line.travel, lengths);
        e.assume(station.is_some());
        let Some(station) = station else { return };
        let its = line.join().circuits;
        let given = [[its[0][0], its[0][1]], [its[1][0], its[1][1]]];
        let Outcome { made, legal, told, .. } = joined(&line, &station, given, false);
        e.claim(Claim::Exact as u32, made.is_ok() == legal);
        e.claim(Claim::Told as u32, told);
        e.cover(Cover::Accepted as u32, made.is_ok());
        e.cover(Cover::Short as u32, matches!(made, Err(WaysideError::HoldTooShortAtTheEntry)));
        e.cover(Cover::Line as u32, matches!(made, Err(WaysideError::Line(LineError::HoldTooShort(_)))));
    }
}
