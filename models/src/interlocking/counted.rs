//! A station whose line is counted: block counting in front of the interlocking.
//!
//! The line has two sections in one block, with the kernel's own machine; from the throat on the station has circuits. In every cycle the block
//! reads its checks and detectors, with the faults of the run, and the interlocking reads the block's report in the place of circuits. So one
//! detector that misses a head makes the whole line falsely occupied, in front of a train, behind it, and while a route is set from there.
//!
//! Between the two is the joint at the exit of the line. The block knows nothing of a head that is in the throat, and its tail is still in the last
//! section: what the station tells the block is [`Joint`].

use super::device::Real;
use super::sizes::circuits;
use super::state::{Cycle as YardCycle, Harm, State as YardState};
use super::stations::counted;
use super::train::{Place, Train};
use super::yard::{Yard, mask};
use crate::block::device::Counts;
use crate::block::fault::Faults;
use crate::outcome::Trace;
use crate::subject::{Claim, Subject};
use atc_kernel::block::{Block, Detection, Hold, Input, SectionSet, State as Kernel, Status, TrainCount, step};
use atc_kernel::interlocking::{self as kernel, CircuitSet};
use atc_kernel::time::Ticks;
use serde_json::json;

/// Sections of the line: its circuits have the same numbers.
const SECTIONS: u8 = 2;
/// The circuits of the line.
const LINE: u8 = (1 << SECTIONS) - 1;

/// What the station tells the last block of the line about the trains that leave it. They are let go at once.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Joint {
    /// The last section is held while the throat is reported. Before that, and where it is lost for a moment, the section is reported free with a tail in
    /// it, and counts as occupied all the same: like any circuit it has a time to clear.
    Asks,
    /// Nothing: a line that ends in the open.
    Silent,
}

/// The model.
#[derive(Clone, Debug)]
pub struct Counted {
    /// The station, its trains and its interlocking.
    pub yard: Yard<Real>,
    /// The joint at the exit of the line.
    pub joint: Joint,
    /// The sets of faulty components that a run may have.
    pub faults: Vec<Faults>,
    /// The assumptions of which each alone excludes the accident; empty where there is none.
    pub excluded_by: &'static [&'static str],
}

/// The station, and the block.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct State {
    /// The station.
    pub yard: YardState,
    /// What may fail.
    pub faults: Faults,
    /// The block.
    pub block: Kernel,
    /// The count is in force and agrees with the detectors.
    pub agree: bool,
    /// The block has disagreed while a route was set over the joint: a ghost.
    pub lost: bool,
}

/// One logic cycle of both.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cycle {
    /// The station, with the block's report in what it reads.
    pub yard: YardCycle,
    /// What the block reads.
    pub block: Input,
}

/// The front's circuit, if it is there.
const fn front(train: &Train) -> u8 {
    match train.place {
        Place::Here { front, .. } => front,
        Place::Coming | Place::Gone => u8::MAX,
    }
}

impl Counted {
    /// The block.
    fn block(&self) -> Block {
        let trains = u8::try_from(self.yard.environment.trains.len()).unwrap_or(SECTIONS).min(SECTIONS);
        let hold = Hold::new(1).expect("a hold");
        Block::new(SECTIONS, trains, hold, Ticks(2)).expect("a block")
    }

    /// The block after staff have verified that it is empty.
    fn verified(&self) -> Kernel {
        let quiet = Input {
            check_in: false,
            check_out: false,
            present: SectionSet::EMPTY,
            reset: None,
            ahead_hold: Hold::NONE,
            ahead_entered: false,
        };
        let begun = step(self.block(), Kernel::INITIAL, quiet).0;
        step(self.block(), begun, Input { reset: Some(TrainCount(0)), ..quiet }).0
    }

    /// What the block may read when the trains have moved as in this cycle.
    fn inputs(&self, state: &State, cycle: &YardCycle) -> Vec<Input> {
        let pairs = || state.yard.trains.iter().zip(&cycle.trains);
        let enters = pairs().any(|(before, after)| before.place == Place::Coming && front(after) == counted::FAR);
        let leaves = pairs().any(|(before, after)| front(before) == counted::NEAR && front(after) == counted::THROAT);
        let heads = cycle.trains.iter().map(front).filter(|front| *front < SECTIONS);
        let inside = u8::try_from(heads.clone().count()).unwrap_or(u8::MAX);
        let heard = SectionSet::from_bits(heads.fold(0, |all, front| all | 1 << front));
        let reported = cycle.input.occupied.meets(CircuitSet::nth(counted::THROAT.into()));
        let asks = self.joint == Joint::Asks && reported;
        let ahead_hold = if asks { self.block().hold() } else { Hold::NONE };
        // Staff reset what does not agree.
        let resets = if state.agree { vec![None] } else { state.faults.resets(inside, SECTIONS, 0) };
        let mut inputs = Vec::new();
        for check_in in state.faults.check_in(enters, 0) {
            for check_out in state.faults.check_out(leaves, 0) {
                for present in state.faults.present(heard) {
                    inputs.extend(resets.iter().map(|reset| {
                        let reset = reset.map(TrainCount);
                        Input { check_in, check_out, present, reset, ahead_hold, ahead_entered: true }
                    }));
                }
            }
        }
        inputs
    }

    /// Whether a route over the joint is reserved.
    fn is_set(state: &YardState) -> bool {
        state.kept.routes.iter().any(kernel::RouteState::is_held)
    }
}

impl Subject for Counted {
    type State = State;
    type Action = Cycle;

    fn initial(&self) -> Vec<State> {
        let block = self.verified();
        let with = |yard: YardState| {
            self.faults.iter().map(move |faults| State { yard, faults: *faults, block, agree: true, lost: false })
        };
        self.yard.initial().into_iter().flat_map(with).collect()
    }

    fn actions(&self, state: &State, cycles: &mut Vec<Cycle>) {
        let mut all = Vec::new();
        self.yard.actions(&state.yard, &mut all);
        for cycle in all {
            for block in self.inputs(state, &cycle) {
                let (_, report) = step(self.block(), state.block, block);
                let counted = report.occupied.bits().to_le_bytes()[0] & LINE;
                let occupied = circuits(mask(cycle.input.occupied) & !LINE | counted);
                let input = kernel::Input { occupied, ..cycle.input };
                cycles.push(Cycle { yard: YardCycle { input, ..cycle }, block });
            }
        }
    }

    fn next(&self, state: &State, cycle: &Cycle) -> Option<State> {
        let (block, report) = step(self.block(), state.block, cycle.block);
        let yard = self.yard.next(&state.yard, &cycle.yard)?;
        let lost = state.lost || !report.agree && Self::is_set(&yard);
        Some(State { yard, faults: state.faults, block, agree: report.agree, lost })
    }

    fn claims(&self) -> Vec<Claim<Self>> {
        let mut claims = vec![
            Claim::<Self>::always("valid", "the interlocking's state keeps its invariant", |m, s| {
                let layout = &m.yard.station.layout;
                s.yard.kept.kernel(layout).is_valid(layout)
            }),
            Claim::<Self>::sometimes("joint-held", "a tail is in the last section, its head in the throat", |_, s| {
                let over = Place::Here { front: counted::THROAT, rear: counted::NEAR };
                s.yard.trains.iter().any(|train| train.place == over)
            }),
            Claim::<Self>::sometimes("two-on-the-line", "two trains are on the line", |_, s| {
                s.yard.trains.iter().filter(|train| front(train) < SECTIONS).count() > 1
            }),
        ];
        if !self.excluded_by.is_empty() {
            let collision = |_: &_, s: &State| s.yard.harm == Harm::Collision;
            claims.push(Claim::<Self>::hazard(
                "collision",
                "two trains are in one circuit",
                self.excluded_by,
                collision,
            ));
            return claims;
        }
        claims.extend([
            Claim::<Self>::always("no-collision", "no two trains are in one circuit", |_, s| {
                s.yard.harm != Harm::Collision
            }),
            Claim::<Self>::always(
                "no-derailment",
                "no train runs over a point that does not lead there, and no point moves under a train",
                |_, s| s.yard.harm != Harm::Derailment,
            ),
            Claim::<Self>::always(
                "no-wrong-output",
                "no signal and no telegram lets a train run over what is taken, granted to another, not asked for, or too fast",
                |_, s| matches!(s.yard.harm, Harm::None | Harm::Collision | Harm::Derailment),
            ),
            Claim::<Self>::always("line-occupied", "every section with any part of a train counts as occupied", |m, s| {
                let under = s.yard.trains.iter().fold(0, |all, train| all | train.occupies());
                let clear = m.yard.station.layout.plan().clear;
                let counts = |section: u8| s.yard.kept.clear_for[usize::from(section)] < clear;
                (0..SECTIONS).all(|section| under >> section & 1 == 0 || counts(section))
            }),
            Claim::<Self>::sometimes("arrived", "every train arrives", |m, s| m.yard.all_arrived(&s.yard)),
        ]);
        if self.faults == [Faults::NONE] {
            return claims;
        }
        claims.extend([
            Claim::<Self>::sometimes(
                "arrived-after-a-fault",
                "every train arrives although the block disagreed while a route was set from the line",
                |m, s| s.lost && m.yard.all_arrived(&s.yard),
            ),
            Claim::<Self>::sometimes(
                "counts-again",
                "the block agrees again after that, with a train in it",
                |_, s| s.lost && s.agree && s.yard.trains.iter().any(|train| front(train) < SECTIONS),
            ),
            Claim::<Self>::sometimes(
                "fault",
                "a fault of the block is latched while a train is in the throat",
                |_, s| {
                    let fault = matches!(s.block.parts().status, Status::Fault(_));
                    fault && s.yard.trains.iter().any(|train| front(train) == counted::THROAT)
                },
            ),
        ]);
        claims
    }

    fn parameters(&self) -> String {
        let joint = match self.joint {
            Joint::Asks => "whose last section is held while the throat is reported",
            Joint::Silent => "of which nothing is held when the front has left it",
        };
        let all = self.faults.len();
        format!("{}; a counted line of {SECTIONS} sections {joint}; {all} sets of faults", self.yard.describe())
    }

    /// The run of the interlocking. The further words of a step: those of a station, and what the block read and how it fares.
    fn trace(&self, path: &[(State, Option<Cycle>)]) -> Trace {
        let yard: Vec<_> = path.iter().map(|(state, cycle)| (state.yard, cycle.map(|cycle| cycle.yard))).collect();
        let mut trace = self.yard.run_of(&yard);
        let begins = self.yard.prelude().len();
        for (place, step) in trace.steps.iter_mut().skip(begins).enumerate() {
            let (Some(cycle), Some((after, _))) = (path[place].1, path.get(place + 1)) else { continue };
            let Input { check_in, check_out, present, reset, .. } = cycle.block;
            let read = Detection { low_check: check_in, high_check: check_out, present, reset };
            let block = Counts::of(read, after.block, after.agree);
            step.words.insert("block".to_owned(), json!(block));
            step.words.insert("faults".to_owned(), json!(after.faults.words()));
        }
        trace
    }
}
