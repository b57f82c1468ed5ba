//! One block at the end of the line: trains, detectors, checks, staff, and the kernel's machine or a wrong one.
//!
//! In one cycle any of the trains advance by one section, none overtakes another, at most one enters and one leaves;
//! several may be in the same section. A train's head is in one section and its tail up to `tail` sections behind: all of
//! these count as *held by the train*, which is the worst that its length allows. Trains enter `apart` cycles apart at
//! least, and do not leave in two cycles running, or the check-out would stay on between them.

use super::device::Counting;
use super::fault::Faults;
use atc_kernel::block::{Block, Hold, Input, Output, SectionSet, State as Kernel};
use atc_kernel::time::Ticks;

mod claims;
mod subject;
mod trace;
mod twin;

/// The most trains of a model.
pub const SLOTS: usize = 3;

/// What may happen beyond single trains that run through.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Beyond {
    /// Nothing.
    Nothing,
    /// One train's transmitter is dead from now on: no check and no detector hears it.
    DeadTransmitter,
    /// One train leaves its rear part in a section, where nothing hears it.
    SplitTrain,
    /// Trains reverse out over the entry.
    ReversingOverEntry,
    /// Trains reverse in over the exit.
    ReversingOverExit,
    /// The machine loses its memory at any time.
    PowerLoss,
    /// A head may stop on a border, where no detector hears it.
    SilentBorders,
    /// A head may stop on a border, where both detectors hear it.
    LoudBorders,
}

/// What a model is there to show.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Purpose {
    /// No section that a train holds is reported free.
    Safe,
    /// One is, and each of these assumptions or requirements excludes it.
    Hazard(&'static [&'static str]),
    /// One is, and the minimal cut sets and the failure modes are listed.
    CutSets(&'static [&'static str]),
}

/// The model: one block, the device `D` in it, and its environment.
#[derive(Clone, Debug)]
pub struct Single<D> {
    /// The machine.
    pub device: D,
    /// Sections of the block, 1 to 5.
    pub sections: u8,
    /// The most trains, 1 to 3: of the environment and of the block.
    pub trains: u8,
    /// The sections that a tail may be behind its head.
    pub tail: u8,
    /// The sections that the machine holds.
    pub hold: u8,
    /// The longest that a passing train keeps the check-in on, in cycles.
    pub pass: u8,
    /// The fewest cycles from one entry to the next, 1 or more.
    pub apart: u8,
    /// Whether several heads may be in one section.
    pub share: bool,
    /// The sets of faulty components that a run may have.
    pub faults: Vec<Faults>,
    /// What else may happen.
    pub beyond: Beyond,
    /// What the model is there to show.
    pub purpose: Purpose,
}

/// Where the trains are.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Trains {
    /// The heads, the foremost first: 0 not there, 1 in the section at the entry, `sections` + 1 beyond the exit.
    pub heads: [u8; SLOTS],
    /// Cycles since the last entry, at most `apart`.
    pub since: u8,
    /// A train was over the check-out in the last cycle.
    pub left: bool,
    /// The trains that stand on the border behind the section of their head: a bit each.
    pub on_border: u8,
    /// The train with a dead transmitter; from 1, 0 for none.
    pub dead: u8,
    /// The section of a rear part that was left behind; from 1, 0 for none.
    pub rear: u8,
    /// What happens only once has happened.
    pub used: bool,
}

/// Trains, faults, the machine, and what was seen of it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct State {
    /// Where the trains are.
    pub trains: Trains,
    /// What may fail.
    pub faults: Faults,
    /// The machine.
    pub kernel: Kernel,
    /// It reported agreement.
    pub agree: bool,
    /// Agreement was lost at some time after it had been reached: a ghost.
    pub lost: bool,
    /// A section that a train holds was reported free, or not asked of the block behind.
    pub hazard: bool,
}

/// One logic cycle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Cycle {
    /// Where the trains are after it.
    pub trains: Trains,
    /// What the machine reads.
    pub input: Input,
    /// The machine lost its memory before it.
    pub power_loss: bool,
}

/// What the trains do in a cycle, and what checks and detectors in order make of it.
struct Moved {
    trains: Trains,
    check_in: bool,
    check_out: bool,
    heard: SectionSet,
    ahead_hold: Hold,
}

impl<D: Counting> Single<D> {
    /// One block in which trains reach one section behind their heads, with a hold for it, and up to `budget` components of which each is
    /// free to fail.
    pub fn usual(device: D, sections: u8, trains: u8, budget: u8) -> Self {
        Self {
            device,
            sections,
            trains,
            tail: 1,
            hold: 1,
            pass: 2,
            apart: 2,
            share: true,
            faults: Faults::up_to(budget, sections, 1),
            beyond: Beyond::Nothing,
            purpose: Purpose::Safe,
        }
    }

    /// The kernel's parameters.
    ///
    /// # Panics
    /// If the kernel rejects them; a test builds every model of the catalogue.
    pub fn block(&self) -> Block {
        let hold = Hold::new(self.hold).expect("a hold of a model");
        Block::new(self.sections, self.trains, hold, Ticks(u16::from(self.pass))).expect("a block of a model")
    }

    /// How many heads are in the block.
    pub fn inside(&self, trains: &Trains) -> u8 {
        let inside = trains.heads.iter().filter(|head| (1..=self.sections).contains(*head)).count();
        u8::try_from(inside).unwrap_or(u8::MAX)
    }

    /// Whether the count is in force, right, and agrees with the detectors.
    pub fn available(&self, state: &State) -> bool {
        state.agree && state.kernel.parts().count == self.inside(&state.trains)
    }

    /// Every way in which the trains may move in one cycle.
    fn moves(&self, trains: &Trains) -> Vec<Moved> {
        let mut ways = Vec::new();
        for moving in 0..1_u8 << self.trains {
            if moving & trains.on_border != 0 {
                continue;
            }
            let Some((heads, entered, left)) = self.advanced(trains, moving) else { continue };
            // Those that stand on a border may go on standing there, those that move may stop on one.
            let may_stand = match self.beyond {
                Beyond::SilentBorders | Beyond::LoudBorders => trains.on_border | moving,
                _ => 0,
            };
            for on_border in (0..=may_stand).filter(|some| some & !may_stand == 0) {
                ways.push(self.heard(&Trains { heads, on_border, ..*trains }, entered, left));
            }
        }
        self.reversed(trains, &mut ways);
        if !trains.used {
            self.once(trains, &mut ways);
        }
        ways
    }

    /// The heads after the trains `moving` have advanced, which one entered, and which one left; `None` if they may not.
    fn advanced(&self, trains: &Trains, moving: u8) -> Option<([u8; SLOTS], Option<usize>, Option<usize>)> {
        let mut heads = trains.heads;
        let (mut entered, mut left) = (None, None);
        for (train, head) in heads.iter_mut().enumerate().filter(|(train, _)| moving >> train & 1 == 1) {
            if *head == 0 && (trains.since < self.apart || entered.replace(train).is_some()) {
                return None;
            }
            if *head == self.sections && (trains.left || left.replace(train).is_some()) {
                return None;
            }
            *head += 1;
        }
        let may_meet = |pair: &[u8]| self.share || pair[1] == 0 || pair[0] > self.sections;
        let follows = |pair: &[u8]| pair[1] < pair[0] || pair[1] == pair[0] && may_meet(pair);
        heads.windows(2).all(follows).then_some((heads, entered, left))
    }

    /// What is heard of trains at `trains`, of which these have just `entered` and `left`.
    fn heard(&self, trains: &Trains, entered: Option<usize>, left: Option<usize>) -> Moved {
        let (mut check_in, mut check_out, mut heard) = (false, false, 0_u16);
        let (mut at_entry, mut at_exit) = (entered.is_some(), left.is_some());
        for (train, head) in trains.heads.iter().enumerate() {
            let on_border = trains.on_border >> train & 1 == 1;
            let (in_check, out_check) = (
                entered == Some(train) || on_border && *head == 1,
                left == Some(train) || on_border && *head == self.sections + 1,
            );
            at_entry |= in_check;
            at_exit |= out_check;
            if usize::from(trains.dead) == train + 1 {
                continue;
            }
            check_in |= in_check;
            check_out |= out_check;
            let here = 1 << *head >> 1;
            heard |= match (on_border, self.beyond) {
                (false, _) => here,
                (true, Beyond::LoudBorders) => here | here >> 1,
                (true, _) => 0,
            };
        }
        let heard = SectionSet::from_bits(heard).and(SectionSet::first(self.sections));
        let since = if at_entry { 1 } else { (trains.since + 1).min(self.apart) };
        let ahead = trains.heads.iter().filter(|head| **head > self.sections).min();
        let held = ahead.map_or(0, |head| (self.hold + self.sections + 1).saturating_sub(*head));
        let ahead_hold = Hold::new(held).unwrap_or(Hold::MOST);
        let mut trains = Trains { since, left: at_exit, ..*trains };
        while trains.heads[0] > self.sections + self.tail {
            trains.heads.rotate_left(1);
            trains.heads[SLOTS - 1] = 0;
            trains.on_border >>= 1;
            trains.dead = trains.dead.saturating_sub(1);
        }
        Moved { trains, check_in, check_out, heard, ahead_hold }
    }

    /// The rearmost train goes back over the entry, or the rearmost beyond the exit comes back over it.
    fn reversed(&self, trains: &Trains, ways: &mut Vec<Moved>) {
        let (over, entry) = match self.beyond {
            Beyond::ReversingOverEntry => (1, true),
            Beyond::ReversingOverExit => (self.sections + 1, false),
            _ => return,
        };
        let Some(train) = trains.heads.iter().rposition(|head| *head == over) else { return };
        let mut back = *trains;
        back.heads[train] -= 1;
        // Nobody is behind it, or it would have to push.
        if (entry && trains.since >= self.apart || !entry && !trains.left) && back.heads.is_sorted_by(|a, b| a >= b) {
            ways.push(self.heard(&back, entry.then_some(train), (!entry).then_some(train)));
        }
    }

    /// What happens only once, while no train moves.
    fn once(&self, trains: &Trains, ways: &mut Vec<Moved>) {
        let used = Trains { used: true, ..*trains };
        match self.beyond {
            Beyond::DeadTransmitter => {
                for dead in 1..=self.trains {
                    // A train that is not there yet, but the next one, may be dead before it enters.
                    let next = usize::from(dead) < 2 || trains.heads[usize::from(dead) - 2] > 0;
                    if next {
                        ways.push(self.heard(&Trains { dead, ..used }, None, None));
                    }
                }
            }
            Beyond::SplitTrain => {
                for head in trains.heads.into_iter().filter(|head| *head > 0) {
                    for rear in head.saturating_sub(self.tail).max(1)..=head.min(self.sections) {
                        ways.push(self.heard(&Trains { rear, ..used }, None, None));
                    }
                }
            }
            _ => {}
        }
    }

    /// Whether a section that a train holds is reported free, or not asked of the block behind.
    fn endangered(&self, trains: &Trains, output: Output) -> bool {
        let free = |section: u8| section < self.sections && !output.occupied.contains(section);
        let exposed = |head: u8| {
            let head = head - 1;
            (head.saturating_sub(self.tail)..=head).any(free)
                || output.behind_hold.sections() < self.tail.saturating_sub(head)
        };
        trains.heads.iter().any(|head| *head > 0 && exposed(*head)) || trains.rear > 0 && free(trains.rear - 1)
    }
}
