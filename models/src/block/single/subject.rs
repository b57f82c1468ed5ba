//! One block as a model that is searched: where it starts, what may happen in a cycle, and what comes of it.

use super::{Beyond, Cycle, Kernel, Purpose, SLOTS, Single, State, Trains};
use crate::block::device::Counting;
use crate::block::fault::Faults;
use crate::block::{cut_sets, modes};
use crate::outcome::{CutSet, FailureMode, Trace};
use crate::subject::{Claim, Limits, Subject};
use crate::twin::Twin;
use atc_kernel::block::{Input, SectionSet, TrainCount};

impl<D: Counting> Subject for Single<D> {
    type State = State;
    type Action = Cycle;

    fn initial(&self) -> Vec<State> {
        let trains =
            Trains { heads: [0; SLOTS], since: self.apart, left: false, on_border: 0, dead: 0, rear: 0, used: false };
        let start =
            State { trains, faults: Faults::NONE, kernel: Kernel::INITIAL, agree: false, lost: false, hazard: false };
        self.faults.iter().map(|faults| State { faults: *faults, ..start }).collect()
    }

    fn actions(&self, state: &State, cycles: &mut Vec<Cycle>) {
        // What follows a hazard is of no interest.
        if state.hazard {
            return;
        }
        let power: &[bool] = if self.beyond == Beyond::PowerLoss { &[false, true] } else { &[false] };
        for moved in self.moves(&state.trains) {
            let resets = state.faults.resets(self.inside(&moved.trains), self.trains, 0);
            for check_in in state.faults.check_in(moved.check_in, 0) {
                for check_out in state.faults.check_out(moved.check_out, 0) {
                    for present in state.faults.present(moved.heard) {
                        for reset in &resets {
                            let input = Input {
                                check_in,
                                check_out,
                                present: present.and(SectionSet::first(self.sections)),
                                reset: reset.map(TrainCount),
                                ahead_hold: moved.ahead_hold,
                                ahead_entered: true,
                            };
                            let cycle =
                                |power_loss: &bool| Cycle { trains: moved.trains, input, power_loss: *power_loss };
                            cycles.extend(power.iter().map(cycle));
                        }
                    }
                }
            }
        }
    }

    fn next(&self, state: &State, cycle: &Cycle) -> Option<State> {
        let kernel = if cycle.power_loss { Kernel::INITIAL } else { state.kernel };
        let (kernel, output) = self.device.step(self.block(), kernel, cycle.input);
        Some(State {
            trains: cycle.trains,
            faults: state.faults,
            kernel,
            agree: output.agree,
            lost: state.lost || state.agree && !output.agree,
            hazard: self.endangered(&cycle.trains, output),
        })
    }

    fn claims(&self) -> Vec<Claim<Self>> {
        self.purpose_claims()
    }

    fn parameters(&self) -> String {
        self.describe()
    }

    fn trace(&self, path: &[(State, Option<Cycle>)]) -> Trace {
        self.run_of(path)
    }

    fn twin(&self) -> Option<Twin> {
        self.promela()
    }

    fn cut_sets(&self, limits: Limits) -> Option<Vec<CutSet>> {
        match self.purpose {
            Purpose::CutSets(_) => cut_sets::enumerate(self, limits),
            _ => Some(Vec::new()),
        }
    }

    fn failure_modes(&self, limits: Limits) -> Option<Vec<FailureMode>> {
        match self.purpose {
            Purpose::CutSets(_) => modes::failure_modes(self, limits),
            _ => Some(Vec::new()),
        }
    }
}
