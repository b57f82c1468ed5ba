//! A station with trains as a model that is searched: where it starts, what may happen in a cycle, and what comes of it.

use super::{Cycle, Harm, Kept, Shown, State, Yard, mask};
use crate::interlocking::device::Device;
use crate::interlocking::environment::{Drives, Obey, TRAINS};
use crate::interlocking::ground::Heading;
use crate::interlocking::sizes::{SEGMENTS, SIGNALS, circuits};
use crate::interlocking::train::{Place, Train};
use crate::outcome::Trace;
use crate::subject::{Claim, Subject};
use atc_kernel::interlocking::{self as kernel, Input, Positions};

impl<D: Device> Subject for Yard<D> {
    type State = State;
    type Action = Cycle;

    fn initial(&self) -> Vec<State> {
        let layout = &self.station.layout;
        let mut state = kernel::State::INITIAL;
        if !self.environment.found {
            // A device that has been running for long.
            state.unswept = kernel::Unswept::SWEPT;
        }
        let mut permits = 0;
        for input in self.prelude() {
            let (next, output) = self.device.step(layout, state, input);
            state = next;
            permits = output.permits.bits();
        }
        let mut trains = [Train { place: Place::Gone, ..Train::coming(Heading::Up, 0) }; TRAINS];
        for (train, start) in trains.iter_mut().zip(&self.environment.trains) {
            *train = Train::coming(start.heading, self.environment.residual);
            if self.environment.found {
                let place = Place::Here { front: start.at, rear: start.at };
                *train = Train { place, since_proceed: 0, ..*train };
            }
        }
        let mut shown = Shown {
            proceed: 0,
            drives: Positions::NONE,
            drives_before: Positions::NONE,
            permits,
            since_permit: [self.environment.permission_lives + 1; SEGMENTS],
            fallen: [0; SIGNALS],
            asked: 0,
            since_consent: [0; SEGMENTS],
        };
        if self.environment.obey == Obey::Telegrams {
            shown.fallen[..self.station.ground.signals.len()].fill(self.environment.residual + 1);
        }
        self.since(&mut shown);
        vec![State { trains, blades: self.environment.blades, kept: Kept::of(&state), shown, harm: Harm::None }]
    }

    fn actions(&self, state: &State, cycles: &mut Vec<Cycle>) {
        // What follows an accident is of no interest.
        if state.harm != Harm::None {
            return;
        }
        let commands = self.commands(state);
        let blades = self.blades(state);
        let (falsely, consents) = (self.falsely(), self.consents(state));
        for (trains, fate) in self.trains(state) {
            for (reported, trains) in self.heard(&state.trains, &trains) {
                for blades in &blades {
                    for detected in self.detections(*blades) {
                        for (request, orders) in &commands {
                            for also in falsely.iter().filter(|also| **also & reported == 0) {
                                cycles.extend(consents.iter().map(|consent| {
                                    let (occupied, consent) = (circuits(reported | also), *consent);
                                    let input =
                                        Input { occupied, detected, request: *request, orders: *orders, consent };
                                    Cycle { trains, fate, blades: *blades, input }
                                }));
                            }
                        }
                    }
                }
            }
        }
    }

    fn next(&self, state: &State, cycle: &Cycle) -> Option<State> {
        let layout = &self.station.layout;
        let (kernel, output) = self.device.step(layout, state.kept.kernel(layout), cycle.input);
        let telegrams = self.telegrams(&cycle.trains, &output, kernel.epoch);
        let proceed = output.proceed.bits().to_le_bytes()[0];
        let mut trains = cycle.trains;
        for (train, telegram) in trains.iter_mut().zip(&telegrams) {
            let behind =
                self.environment.on_sight && cycle.trains.iter().any(|other| train.is_behind(other) && other != train);
            let proceed = if behind { 0 } else { proceed };
            // A telegram for the other direction of travel is one to stop.
            let meant = telegram.filter(|telegram| telegram.heading == Some(train.heading.of_layout()));
            let granted = meant.map_or(0, |telegram| mask(telegram.hold));
            *train = train.informed(&self.station.ground, &self.environment, (proceed, self.calls()), granted);
        }
        let late = self.environment.drives == Drives::AfterTheDrive;
        let drives_before = if late { state.shown.drives } else { Positions::NONE };
        let permits = output.permits.bits();
        let kept = Kept::of(&kernel);
        let asked = Self::asked(state.shown.asked, cycle.input.request, &output, &kept);
        let mut shown = Shown { proceed, drives: output.drives, drives_before, permits, asked, ..state.shown };
        self.since(&mut shown);
        self.since_consent(&mut shown, cycle);
        let mut after = State { trains, blades: cycle.blades, kept, shown, harm: Harm::None };
        after.harm = self.harm(cycle, &after, &output, &telegrams);
        Some(after)
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
}
