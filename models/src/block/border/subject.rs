//! Two blocks and their border as a model that is searched: where it starts, what may happen in a cycle, and what is claimed.

use super::{ALL, CHECKED_OUT, Cycle, Layout, Pair, SECTIONS, Showing, State, Trains, trace};
use crate::block::fault::Faults;
use crate::block::lines::Lining;
use crate::block::single::SLOTS;
use crate::outcome::Trace;
use crate::subject::{Claim, Subject};
use atc_kernel::block::{Beyond, Detection, Hold, LineInput, LineState, SectionSet, Status, TrainCount};

impl<L: Lining> Subject for Pair<L> {
    type State = State;
    type Action = Cycle;

    fn initial(&self) -> Vec<State> {
        let trains = Trains { heads: [0; SLOTS], crossing: 0, since: [self.pass; 2], left: [false; 2] };
        let start = State { trains, faults: Faults::NONE, line: LineState::INITIAL, agree: [false; 2], hazard: false };
        self.faults.iter().map(|faults| State { faults: *faults, ..start }).collect()
    }

    fn actions(&self, state: &State, cycles: &mut Vec<Cycle>) {
        if state.hazard {
            return;
        }
        let faults = state.faults;
        for moved in self.moves(state.trains) {
            let still = moved.trains.crossing == 0 || self.reset_while_crossing;
            let block = |number: u8, present: SectionSet| {
                let place = usize::from(number);
                let resets = faults.resets(Self::inside(moved.trains, number), SECTIONS, place);
                let mut ways = Vec::new();
                for low_check in faults.check_in(moved.check_in[place], place) {
                    for high_check in faults.check_out(moved.check_out[place], place) {
                        for reset in resets.iter().filter(|reset| still || reset.is_none()) {
                            let present = SectionSet::from_bits(present.bits() >> (SECTIONS * number));
                            let present = present.and(SectionSet::first(SECTIONS));
                            ways.push(Detection { low_check, high_check, present, reset: reset.map(TrainCount) });
                        }
                    }
                }
                ways
            };
            let hold = Hold::new(moved.ahead_hold).unwrap_or(Hold::MOST);
            for present in faults.present(SectionSet::from_bits(moved.heard)) {
                for behind in block(0, present) {
                    for ahead in block(1, present) {
                        let input = LineInput { blocks: [behind, ahead], beyond: Beyond { hold, entered: true } };
                        cycles.push(Cycle { trains: moved.trains, input });
                    }
                }
            }
        }
    }

    fn next(&self, state: &State, cycle: &Cycle) -> Option<State> {
        let (line, output) = self.device.step(&self.line(), state.line, cycle.input);
        Some(State {
            trains: cycle.trains,
            faults: state.faults,
            line,
            agree: output.blocks.map(|block| block.agree),
            hazard: self.endangered(cycle.trains, &output),
        })
    }

    fn claims(&self) -> Vec<Claim<Self>> {
        let mut claims = vec![Claim::<Self>::always("valid", "the machine's state keeps its invariant", |m, s| {
            m.device.is_valid(&m.line(), &s.line)
        })];
        match self.showing {
            Showing::Safe => claims.push(Claim::<Self>::always(
                "train-reported",
                "every section with a head or a tail is reported occupied, also while the head is between the two checks",
                |_, s| !s.hazard,
            )),
            Showing::Hazard(excluded_by) => claims.push(Claim::<Self>::hazard(
                "train-unreported",
                "a section that a train holds is reported free",
                excluded_by,
                |_, s| s.hazard,
            )),
        }
        if self.faults == [Faults::NONE] && self.showing == Showing::Safe {
            claims.push(Claim::<Self>::always(
                "in-a-count",
                "while both blocks count, every train is in a count",
                |_, s| {
                    let parts = s.line.blocks.map(|block| block.parts());
                    let inside = s.trains.heads.iter().filter(|head| (1..=ALL).contains(*head)).count();
                    parts.iter().any(|block| block.status != Status::Counting)
                        || usize::from(parts[0].count + parts[1].count) >= inside
                },
            ));
        }
        if let Showing::Hazard(_) = self.showing {
            return claims;
        }
        claims.push(Claim::<Self>::sometimes("agreement", "both blocks agree, with a train in each", |_, s| {
            s.agree == [true; 2] && (0..2).all(|block| Self::inside(s.trains, block) > 0)
        }));
        match self.layout {
            Layout::CheckOutFirst | Layout::CheckOutFirstUnheard => claims.push(Claim::<Self>::sometimes(
                "waits",
                "a train between the two checks stays in the count behind",
                |_, s| s.trains.crossing == CHECKED_OUT && s.line.blocks[0].parts().pending == 1,
            )),
            _ => claims.push(Claim::<Self>::sometimes(
                "remembered",
                "a train is checked in ahead before it is checked out, and the border remembers it",
                |_, s| s.trains.crossing & CHECKED_OUT == 0 && s.trains.crossing != 0 && s.line.borders[1].0 == 1,
            )),
        }
        claims
    }

    fn parameters(&self) -> String {
        format!(
            "two blocks of {SECTIONS} sections, up to {} trains, tails up to {} sections behind the head, pass time {} cycles \
             and as many between two trains over a check-in",
            self.trains, self.hold, self.pass,
        )
    }

    fn trace(&self, path: &[(State, Option<Cycle>)]) -> Trace {
        trace::of(self, path)
    }
}
