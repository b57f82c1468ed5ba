//! Two blocks of two sections and the border between them: trains whose head, tail and count cross it.
//!
//! Three things happen when a head crosses the border: the check-out behind hears it, the check-in ahead hears it, and the
//! detector ahead hears it instead of the one behind, from when on it is in the section ahead. In which order, with any number
//! of cycles between, is the [`Layout`] of loops and detectors.

use super::fault::Faults;
use super::lines::Lining;
use super::single::SLOTS;
use atc_kernel::block::{Block, Direction, Hold, Line, LineInput, LineOutput, LineState, Metres, SectionSet};
use atc_kernel::time::Ticks;

mod subject;
mod trace;

/// The sections of either block.
pub const SECTIONS: u8 = 2;

/// All sections.
const ALL: u8 = 2 * SECTIONS;

const CHECKED_OUT: u8 = 1;
const CHECKED_IN: u8 = 2;
const DETECTED: u8 = 4;
const CROSSED: u8 = CHECKED_OUT | CHECKED_IN | DETECTED;

/// How loops and detectors lie at the border.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Layout {
    /// Overlapping: first the check-in ahead, then the detector ahead takes over from the one behind, then the check-out.
    Overlapping,
    /// First the check-out; later the check-in ahead, and in the same cycle the detector ahead takes over.
    CheckOutFirst,
    /// First the check-out, from when on no detector hears the head; later the check-in and the detector ahead.
    CheckOutFirstUnheard,
    /// First the check-in ahead, later the check-out, and only then the detector ahead takes over.
    DetectedLate,
    /// First the detector ahead takes over, later the check-in ahead, then the check-out.
    DetectedEarly,
    /// First the check-in ahead, then both detectors hear the head, then the one ahead alone, then the check-out.
    HeardTwice,
}

impl Layout {
    /// Whether a head may have passed just these.
    const fn allows(self, passed: u8) -> bool {
        match self {
            Self::Overlapping | Self::HeardTwice => matches!(passed, 0 | CHECKED_IN | 6 | CROSSED),
            Self::CheckOutFirst | Self::CheckOutFirstUnheard => matches!(passed, 0 | CHECKED_OUT | CROSSED),
            Self::DetectedLate => matches!(passed, 0 | CHECKED_IN | 3 | CROSSED),
            Self::DetectedEarly => matches!(passed, 0 | DETECTED | 6 | CROSSED),
        }
    }
}

/// What a model is there to show.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Showing {
    /// No section that a train holds is reported free.
    Safe,
    /// One is, and each of these excludes it.
    Hazard(&'static [&'static str]),
}

/// The model.
#[derive(Clone, Debug)]
pub struct Pair<L> {
    /// The machine.
    pub device: L,
    /// The most trains on the line, 1 to 3; a block takes two.
    pub trains: u8,
    /// The sections that a tail may be behind its head, and that the machine holds.
    pub hold: u8,
    /// The longest that a passing train keeps a check-in on, and the fewest cycles between two trains over one, in cycles.
    pub pass: u8,
    /// How loops and detectors lie at the border.
    pub layout: Layout,
    /// Whether the check-out behind is at the border: past it a tail is in the last `hold` sections behind the border. If not,
    /// it may be one section further back, where a head in the last section may have it.
    pub check_out_at_border: bool,
    /// Whether staff may reset while a head is crossing the border.
    pub reset_while_crossing: bool,
    /// The sets of faulty components that a run may have.
    pub faults: Vec<Faults>,
    /// What the model is there to show.
    pub showing: Showing,
}

/// Where the trains are.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Trains {
    /// The heads, the foremost first: 0 not there, then the section from 1, 5 and more beyond the exit.
    heads: [u8; SLOTS],
    /// What the train at the border has passed; 0: none is crossing.
    crossing: u8,
    /// Cycles since the last train over either check-in, at most `pass`.
    since: [u8; 2],
    /// A train was over the check-out in the last cycle.
    left: [bool; 2],
}

/// Trains, faults, the machine, and what was seen of it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct State {
    trains: Trains,
    faults: Faults,
    line: LineState<2>,
    agree: [bool; 2],
    hazard: bool,
}

/// One logic cycle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Cycle {
    trains: Trains,
    input: LineInput<2>,
}

/// What checks and detectors in order make of a cycle.
struct Moved {
    trains: Trains,
    check_in: [bool; 2],
    check_out: [bool; 2],
    heard: u16,
    ahead_hold: u8,
}

impl<L: Lining> Pair<L> {
    /// The kernel's line.
    ///
    /// # Panics
    /// If the kernel rejects it; a test builds every model of the catalogue.
    pub fn line(&self) -> Line<2> {
        let hold = Hold::new(self.hold).expect("a hold of a model");
        let block = Block::new(SECTIONS, SECTIONS, hold, Ticks(u16::from(self.pass))).expect("a block of a model");
        let train = Metres(100 * u16::from(self.hold));
        Line::new([block; 2], &[Metres(100); ALL as usize], train, Direction::Up).expect("a line of a model")
    }

    /// The section, from 1, of a head at `head` that has passed `crossing` at the border.
    fn section(head: u8, crossing: u8) -> u8 {
        if head == SECTIONS && crossing & DETECTED != 0 { SECTIONS + 1 } else { head }
    }

    /// The heads by section, that of the crossing train where its detection says.
    fn sections(trains: Trains) -> [u8; SLOTS] {
        let crosser = trains.heads.iter().position(|head| *head == SECTIONS);
        let mut sections = trains.heads;
        if let Some(train) = crosser {
            sections[train] = Self::section(SECTIONS, trains.crossing);
        }
        sections
    }

    /// How many heads are in block `block`.
    fn inside(trains: Trains, block: u8) -> u8 {
        let first = block * SECTIONS + 1;
        let inside = Self::sections(trains).iter().filter(|head| (first..first + SECTIONS).contains(*head)).count();
        u8::try_from(inside).unwrap_or(u8::MAX)
    }

    fn moves(&self, trains: Trains) -> Vec<Moved> {
        let mut ways = Vec::new();
        for moving in 0..1_u8 << self.trains {
            let crosser = trains.heads.iter().position(|head| *head == SECTIONS);
            let crosses = crosser.is_some_and(|train| moving >> train & 1 == 1);
            // A train that crosses passes one, two or all of the three that it has not passed yet.
            let passed = if crosses { CROSSED & !trains.crossing } else { 0 };
            for passed in (0..=passed).filter(|some| some & !passed == 0 && (*some > 0) == crosses) {
                ways.extend(self.advanced(trains, moving, passed));
            }
        }
        ways
    }

    fn advanced(&self, trains: Trains, moving: u8, passed: u8) -> Option<Moved> {
        let crossing = trains.crossing | passed;
        let check_in_ahead = passed & CHECKED_IN != 0;
        let check_out_behind = passed & CHECKED_OUT != 0;
        if !self.layout.allows(crossing)
            || check_in_ahead && trains.since[1] < self.pass
            || check_out_behind && trains.left[0]
        {
            return None;
        }
        let mut heads = trains.heads;
        let (mut entered, mut left, mut crosser) = (false, false, None);
        for (train, head) in heads.iter_mut().enumerate().filter(|(train, _)| moving >> train & 1 == 1) {
            match *head {
                0 if entered || trains.since[0] < self.pass => return None,
                0 => entered = true,
                // Of several in the last section the foremost crosses; the others wait until it has.
                SECTIONS if crosser.replace(train).is_some() => return None,
                SECTIONS if crossing != CROSSED => continue,
                ALL if left || trains.left[1] => return None,
                ALL => left = true,
                _ => {}
            }
            *head += 1;
        }
        let foremost = trains.heads.iter().position(|head| *head == SECTIONS);
        if !heads.is_sorted_by(|a, b| a >= b) || crosser.is_some() && crosser != foremost {
            return None;
        }
        let (check_in, check_out) = ([entered, check_in_ahead], [check_out_behind, left]);
        let since = [0, 1].map(|place| if check_in[place] { 1 } else { (trains.since[place] + 1).min(self.pass) });
        let crossing = if crossing == CROSSED { 0 } else { crossing };
        let mut trains = Trains { heads, crossing, since, left: check_out };
        let heard = self.heard(trains);
        let ahead = heads.iter().filter(|head| **head > ALL).min();
        let ahead_hold = ahead.map_or(0, |head| (self.hold + ALL + 1).saturating_sub(*head));
        while trains.heads[0] > ALL + self.hold {
            trains.heads.rotate_left(1);
            trains.heads[SLOTS - 1] = 0;
        }
        Some(Moved { trains, check_in, check_out, heard, ahead_hold })
    }

    /// The sections in which a head is heard.
    fn heard(&self, trains: Trains) -> u16 {
        let mut first = trains.crossing;
        let heard = trains.heads.iter().fold(0, |heard, head| {
            let here = 1_u16 << *head >> 1;
            let crossing = if *head == SECTIONS { std::mem::take(&mut first) } else { 0 };
            heard
                | match (crossing, self.layout) {
                    (CHECKED_OUT, Layout::CheckOutFirstUnheard) => 0,
                    (CHECKED_IN, Layout::HeardTwice) => here | here << 1,
                    (some, _) if some & DETECTED != 0 => here << 1,
                    _ => here,
                }
        });
        heard & ((1 << ALL) - 1)
    }

    fn endangered(&self, trains: Trains, output: &LineOutput<2>) -> bool {
        let occupied = output.blocks[0].occupied.and(SectionSet::first(SECTIONS)).bits()
            | output.blocks[1].occupied.and(SectionSet::first(SECTIONS)).bits() << SECTIONS;
        let sections = Self::sections(trains);
        let between = trains.crossing & CHECKED_OUT != 0 && trains.crossing & DETECTED == 0;
        let between = trains.heads.iter().position(|head| between && *head == SECTIONS);
        sections.iter().enumerate().filter(|(_, head)| **head > 0).any(|(train, head)| {
            let head = head - 1;
            // Past a check-out at the border the nose is at the end of its section, and so is the tail.
            let at_end = self.check_out_at_border && between == Some(train);
            let tail = self.hold - u8::from(at_end);
            let mut held = head.saturating_sub(tail)..=head.min(ALL - 1);
            held.any(|section| occupied >> section & 1 == 0)
                || output.before_hold.sections() < tail.saturating_sub(head)
        })
    }
}
