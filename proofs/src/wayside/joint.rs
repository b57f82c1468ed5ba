//! What the constructor asks of the joint of a counted line, and what it makes of it (T-WAY-1, T-WAY-8).
//!
//! The circuits' numbers stand for any: the kernel compares them and does nothing else. The track is as the layout has it, from far outside to
//! inside the station: the circuits of the segment, its throat, and what is behind the throat.

#![allow(clippy::needless_range_loop, reason = "a place is a number in several arrays")]

use super::plans::LONGEST;
use crate::Engine;
use crate::engine::any_flag;
use atc_kernel::block::{Block, Direction, Hold, LineError};
use atc_kernel::distance::Metres;
use atc_kernel::interlocking::{CircuitId, CircuitSet, SegmentId, Travel};
use atc_kernel::time::Ticks;
use atc_kernel::wayside::{Chain, Counted, Join, Place, Way, WaysideError};

/// The circuits of the segment.
const PLACES: usize = 4;
/// The places that a layout may know: the segment, its throat, and two behind it.
const TRACK: usize = PLACES + 3;
/// The most sections of a line here.
const MOST: usize = 3;

/// The direction of travel, whether the line's low end is its entry, the sections of the first and of the second block from the low end, and the hold.
type Shape = (Travel, Direction, [usize; 2], u8);

const CASES: [Shape; 4] = [
    (Travel::Toward, Direction::Up, [1, 2], 2),
    (Travel::Toward, Direction::Down, [2, 1], 1),
    (Travel::Away, Direction::Up, [2, 1], 3),
    (Travel::Away, Direction::Down, [1, 1], 2),
];

pub const BOUND: &str =
    "1 segment of up to 4 circuits, its throat and 2 places behind it, 1 way in, 2 blocks of 1 or 2 sections";

/// The track in the direction of travel.
struct Track {
    /// The circuit at each place; none where the layout has none.
    circuits: [Option<u8>; TRACK],
    lengths: [u16; TRACK],
}

/// A line of two blocks that somebody wants to join to the track.
struct Line {
    travel: Travel,
    direction: Direction,
    sizes: [usize; 2],
    hold: u8,
    train: u16,
    /// The circuit given for the first two places of each block, from the low end.
    given: [[Option<CircuitId>; 2]; 2],
    blocks: [Block; 2],
}

impl Line {
    fn count(&self) -> usize {
        self.sizes[0] + self.sizes[1]
    }

    /// The block and the section of the section that is passed as number `passed`.
    fn spot(&self, passed: usize) -> (usize, usize) {
        let from_low = if self.direction == Direction::Up { passed } else { self.count() - 1 - passed };
        if from_low < self.sizes[0] { (0, from_low) } else { (1, from_low - self.sizes[0]) }
    }

    fn join(&self) -> Join<2, MOST> {
        let mut circuits = [[None; MOST]; 2];
        for block in 0..2 {
            for section in 0..2 {
                circuits[block][section] = self.given[block][section];
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
}

fn any_line<E: Engine + ?Sized>(e: &mut E) -> Option<Line> {
    let case = e.choose("line", CASES.len());
    let mut chosen = CASES[0];
    for (place, each) in CASES.iter().enumerate() {
        if place == case {
            chosen = *each;
        }
    }
    let (travel, direction, sizes, hold) = chosen;
    let holds = Hold::new(hold)?;
    let block = |sections: usize| Block::new(sections.to_le_bytes()[0], 1, holds, Ticks(2)).ok();
    let blocks = [block(sizes[0])?, block(sizes[1])?];
    // Natively the circuits are likely to follow each other, from one that is drawn.
    let first = e.word("first circuit, for natively drawn ones (number)", 0..=4) & 7;
    let rising = e.word("they rise, natively", 0..=1) & 1 == 1;
    let mut given = [[None; 2]; 2];
    let mut from_low = 0;
    for block in 0..2 {
        for section in 0..2 {
            let likely = match (section < sizes[block], rising) {
                (false, _) => 6..=7,
                (true, true) => first + from_low..=first + from_low,
                (true, false) => (first + 8 - from_low) & 7..=(first + 8 - from_low) & 7,
            };
            let its = e.word("circuit of a section (0 to 6: number, else none)", likely);
            if its < 7 {
                given[block][section] = CircuitId::new(its.to_le_bytes()[0]);
            }
            if section < sizes[block] {
                from_low += 1;
            }
        }
    }
    let train = e.word("longest train (m)", 0..=8);
    Some(Line { travel, direction, sizes, hold, train, given, blocks })
}

/// Any track: circuits 0 to 3 are the segment's, the one next to the station first, 4 is the throat, 5 and 6 are behind it.
fn any_track<E: Engine + ?Sized>(e: &mut E, travel: Travel) -> (Track, Chain<1, PLACES, MOST>) {
    let outer = usize::from(e.word("circuits of the segment", 1..=4));
    e.assume((1..=PLACES).contains(&outer));
    let throat = any_flag(e, "there is a throat (odd: yes)");
    let behind = e.word("places behind the throat that are known", 0..=2);
    let (mut circuits, mut lengths) = ([None; TRACK], [0; TRACK]);
    for number in 0..TRACK {
        let there = match number {
            0..PLACES => number < outer,
            PLACES => throat,
            _ => throat && usize::from(behind) > number - 1 - PLACES,
        };
        // In the direction of travel.
        let place = match (travel, number) {
            (Travel::Toward, 0..PLACES) => PLACES - 1 - number,
            (Travel::Toward, _) => number,
            (Travel::Away, 0..PLACES) => TRACK - PLACES + number,
            (Travel::Away, _) => TRACK - 1 - number,
        };
        circuits[place] = if there { Some(number.to_le_bytes()[0]) } else { None };
        lengths[place] = e.word("length of a circuit (m)", 1..=5);
    }
    let place = |number: usize| {
        let mut its = Place::NONE;
        for place in 0..TRACK {
            if circuits[place] == Some(number.to_le_bytes()[0]) {
                its = Place { circuits: CircuitSet::nth(number), length: Metres(lengths[place]) };
            }
        }
        its
    };
    let mut chain = Chain {
        throat: place(PLACES),
        circuits: [place(0), place(1), place(2), place(3)],
        behind: [Place::NONE; MOST],
        ways: [Way::NONE],
    };
    if travel == Travel::Away {
        (chain.behind[0], chain.behind[1]) = (place(PLACES + 1), place(PLACES + 2));
    } else {
        // The way in begins behind the throat.
        chain.ways[0] = Way { entry: chain.throat.circuits, first: place(PLACES + 1).circuits };
    }
    (Track { circuits, lengths }, chain)
}

/// Where on the track the line is, if all its sections follow each other there: the place of its entry section.
fn entry(line: &Line, track: &Track) -> Option<usize> {
    let mut entry = None;
    for place in 0..TRACK {
        let mut fits = true;
        for passed in 0..MOST {
            if passed < line.count() {
                let (block, section) = line.spot(passed);
                let on_line = match line.travel {
                    Travel::Toward => place + passed <= PLACES,
                    Travel::Away => place + passed >= TRACK - 1 - PLACES && place + passed < TRACK,
                };
                let its = line.given[block][section].map(CircuitId::number);
                fits &= on_line && its.is_some() && its == track.circuits[if on_line { place + passed } else { 0 }];
            }
        }
        if fits {
            entry = Some(place);
        }
    }
    entry
}

/// Whether behind a front that has just passed some of the sections the held places are shorter than the train: anywhere, and on the line alone.
fn is_short(line: &Line, track: &Track, entry: usize) -> (bool, bool) {
    let (mut short, mut short_on_line) = (false, false);
    for passed in 0..=MOST {
        if passed <= line.count() {
            let (mut held, mut known) = (0_u32, true);
            for back in 1..=MOST {
                if back <= usize::from(line.hold) {
                    known &= back <= entry + passed && track.circuits[(entry + passed).saturating_sub(back)].is_some();
                    held += if known { u32::from(track.lengths[entry + passed - back]) } else { 0 };
                }
            }
            let its = known && held < u32::from(line.train);
            short |= its;
            short_on_line |= its && passed >= usize::from(line.hold);
        }
    }
    (short, short_on_line)
}

harness! {
    /// A counted line is accepted if and only if its sections, all of them and nothing else, are on circuits of the segment or its throat that follow each other as
    /// they do, each with a length; a circuit is beyond its exit; and wherever a front is, the held places behind it, as far as the layout
    /// knows them, are no shorter than the longest train. The error names a rule that is broken.
    way_join(e)
    theorem "T-WAY-8";
    requirements ["WAY-11", "WAY-12", "WAY-13", "WAY-14"];
    assumptions [];
    bound BOUND;
    cases CASES.len();
    unwind 65 = 1 + LONGEST;
    apart [0 1 2 3];
    claims {
        Exact: "accepted if and only if every rule is kept",
        Told: "the error names a rule that is broken",
    }
    covers {
        Accepted: "a line is accepted whose train is longer than a section",
        Order: "a line with its sections out of order",
        Beyond: "a line that ends where the device sees nothing",
        Short: "a hold that is too short at the entry only",
        Line: "a hold that is too short on the line",
        Missing: "a section without a circuit",
        More: "a circuit without a section",
    }
    {
        let Some(line) = any_line(e) else { return };
        let (track, chain) = any_track(e, line.travel);
        let made = Counted::on(&chain, &line.join());
        let (mut complete, mut there, mut no_length) = (true, true, false);
        for (block, row) in line.given.iter().enumerate() {
            for (section, given) in row.iter().enumerate() {
                complete &= given.is_some() == (section < line.sizes[block]);
                let mut known = false;
                for place in 0..TRACK {
                    let its = given.is_some() && track.circuits[place] == given.map(CircuitId::number);
                    let on_line = if line.travel == Travel::Toward { place <= PLACES } else { place + 1 + PLACES >= TRACK };
                    known |= its && on_line;
                    no_length |= its && on_line && track.lengths[place] == 0;
                }
                there &= known || given.is_none();
            }
        }
        let entry = entry(&line, &track);
        let exit = entry.unwrap_or(0) + line.count();
        let (mut ends, mut short, mut short_on_line) = (false, false, false);
        for place in 0..TRACK {
            ends |= place == exit && track.circuits[place].is_none();
            if Some(place) == entry {
                (short, short_on_line) = is_short(&line, &track, place);
            }
        }
        ends |= exit >= TRACK;
        let legal = complete && !no_length && entry.is_some() && !ends && !short;
        e.claim(Claim::Exact as u32, made.is_ok() == legal);
        let told = match made {
            Ok(_) => true,
            Err(WaysideError::SectionWithoutCircuit(_) | WaysideError::CircuitWithoutSection(_)) => !complete,
            Err(WaysideError::SectionElsewhere(_)) => !there,
            Err(WaysideError::SectionsOutOfOrder(_)) => entry.is_none(),
            Err(WaysideError::Line(LineError::NoLength(_))) => no_length,
            Err(WaysideError::NothingBeyondTheExit) => ends,
            Err(WaysideError::Line(LineError::HoldTooShort(_))) => short_on_line,
            Err(WaysideError::HoldTooShortAtTheEntry) => short,
            Err(_) => false,
        };
        e.claim(Claim::Told as u32, told);
        e.cover(Cover::Accepted as u32, made.is_ok() && line.train > 5);
        e.cover(Cover::Order as u32, matches!(made, Err(WaysideError::SectionsOutOfOrder(_))));
        e.cover(Cover::Beyond as u32, matches!(made, Err(WaysideError::NothingBeyondTheExit)));
        e.cover(Cover::Short as u32, matches!(made, Err(WaysideError::HoldTooShortAtTheEntry)));
        e.cover(Cover::Line as u32, matches!(made, Err(WaysideError::Line(LineError::HoldTooShort(_)))));
        e.cover(Cover::Missing as u32, matches!(made, Err(WaysideError::SectionWithoutCircuit(_))));
        e.cover(Cover::More as u32, matches!(made, Err(WaysideError::CircuitWithoutSection(_))));
    }
}

/// The metres of the circuit at `place` of the track, as a sum's part.
fn metres(track: &Track, place: usize) -> u32 {
    u32::from(track.lengths[place])
}

harness! {
    /// Whatever circuits are given for the sections: if the joint is accepted, each metre of the line is on the section that reports the circuit which the layout has
    /// there; behind a ghost train's front every metre under it is on the front's section, on one of the k behind it, or on a circuit
    /// that is held before the entry, as far as the layout goes; and the circuit beyond the exit is looked at. So the scene of
    /// `t_way_1` and `t_way_2` supposes nothing of an accepted joint.
    t_way_1_joint(e)
    theorem "T-WAY-1";
    requirements ["WAY-1", "WAY-11", "WAY-12", "WAY-13", "WAY-14"];
    assumptions ["parameters-are-the-lines", "hold-covers-train", "train-whole"];
    built_in &[
        ("parameters-are-the-lines", "the ground of a section is that of the circuit that is given for it"),
        ("hold-covers-train", "the ghost is no longer than the longest train of the plan"),
        ("train-whole", "the ghost ends its length behind its front"),
    ];
    bound BOUND;
    cases CASES.len();
    unwind 65 = 1 + LONGEST;
    apart [0 1 2 3];
    claims {
        Circuit: "the section with the metre, by the line, is on the circuit with the metre, by the layout",
        Held: "a metre of the line under the train is on the front's section or one of the k behind it",
        Before: "a metre before the entry under the train is on a circuit of the places that are held, or beyond where the layout ends",
        Beyond: "the circuit that begins where the line ends is one of those beyond the exit",
        Others: "nothing is on a section that the line does not have",
    }
    covers {
        Third: "the metre is on the third section",
        Whole: "the train reaches over a whole section",
        Across: "the train reaches over the entry, two places beyond it",
        Out: "the train reaches out of what the layout knows",
    }
    {
        let Some(line) = any_line(e) else { return };
        let (track, chain) = any_track(e, line.travel);
        let made = Counted::on(&chain, &line.join()).ok();
        e.assume(made.is_some());
        let Some(made) = made else { return };
        // By the layout: where the circuit of the entry section begins.
        let (block, section) = line.spot(0);
        let first = line.given[block][section].map(CircuitId::number);
        let mut begins = TRACK;
        for place in 0..TRACK {
            if first.is_some() && track.circuits[place] == first {
                begins = place;
            }
        }
        // The ghost's front, in metres from there, and a metre under the train, so far behind the front.
        let front = u32::from(e.word("front beyond the entry (m)", 0..=12));
        let behind = u32::from(e.word("a metre under the train, from its front (m)", 0..=7));
        e.assume(behind == 0 || behind < u32::from(line.train));
        // By the line: the sections' grounds follow each other from the entry.
        let (mut front_on, mut on, mut end) = (None, None, 0_u32);
        for passed in 0..MOST {
            if passed < line.count() {
                let (block, section) = line.spot(passed);
                let its = line.given[block][section].map(CircuitId::number);
                let mut length = 0;
                for place in 0..TRACK {
                    length = if its.is_some() && track.circuits[place] == its { metres(&track, place) } else { length };
                }
                let there = |metre: u32| metre >= end && metre < end + length;
                front_on = if there(front) { Some(passed) } else { front_on };
                on = if front >= behind && there(front - behind) { Some(passed) } else { on };
                end += length;
            }
        }
        e.assume(front_on.is_some());
        let front_on = front_on.unwrap_or(0);
        // By the layout: the place with the metre.
        let (mut place_of, mut ahead) = (None, 0_u32);
        for place in 0..TRACK {
            if place >= begins {
                let its = metres(&track, place);
                let metre = front.wrapping_sub(behind);
                place_of = if front >= behind && metre >= ahead && metre < ahead + its { Some(place) } else { place_of };
                ahead += its;
            }
        }
        let (mut back_of, mut passed_metres, mut known) = (None, 0_u32, true);
        for place in (0..TRACK).rev() {
            if place < begins && known {
                known = track.circuits[place].is_some();
                let its = metres(&track, place);
                let metre = behind.wrapping_sub(front);
                if known && behind > front && metre > passed_metres && metre <= passed_metres + its {
                    (back_of, place_of) = (Some(begins - 1 - place), Some(place));
                }
                passed_metres += its;
            }
        }
        let mut circuit = None;
        for place in 0..TRACK {
            circuit = if place_of == Some(place) { track.circuits[place] } else { circuit };
        }
        let bits = |circuit: Option<u8>| circuit.map_or(0, |number| 1_u64 << (number & 7));
        let (mut reports, mut others) = (0, 0);
        for passed in 0..MOST {
            let (block, section) = if passed < line.count() { line.spot(passed) } else { (0, 0) };
            if on == Some(passed) {
                reports = made.sections()[block][section].bits();
            }
        }
        for block in 0..2 {
            for section in 0..MOST {
                others |= if section < line.sizes[block] { 0 } else { made.sections()[block][section].bits() };
            }
        }
        e.claim(Claim::Circuit as u32, on.is_none() || circuit.is_some() && reports == bits(circuit));
        let hold = usize::from(line.hold);
        e.claim(Claim::Held as u32, front < behind || on.is_some_and(|on| on <= front_on && front_on - on <= hold));
        let mut held = false;
        for back in 0..MOST {
            let its = back_of == Some(back) && front_on + back < hold;
            held |= its && circuit.is_some() && made.before()[back].bits() == bits(circuit);
        }
        e.claim(Claim::Before as u32, front >= behind || held || back_of.is_none());
        let mut next = None;
        for place in 0..TRACK {
            next = if place == begins + line.count() { track.circuits[place] } else { next };
        }
        e.claim(Claim::Beyond as u32, next.is_some() && made.beyond().bits() & bits(next) != 0);
        e.claim(Claim::Others as u32, others == 0);
        e.cover(Cover::Third as u32, on == Some(2));
        e.cover(Cover::Whole as u32, front >= behind && on.is_some_and(|on| on + 1 < front_on));
        e.cover(Cover::Across as u32, back_of == Some(1));
        e.cover(Cover::Out as u32, front < behind && back_of.is_none());
    }
}
