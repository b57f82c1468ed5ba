//! A ride as a model that is searched: where it starts, what may happen in a cycle, and what comes of it.

use super::{Cycle, Ghosts, Ground, Ride, Shown, State, Train, lossy};
use crate::outcome::Trace;
use crate::permitted::device::Device;
use crate::permitted::layout::{CELL_M, POINTS};
use crate::permitted::trace;
use crate::subject::{Claim, Subject};
use atc_kernel::Machine;
use atc_kernel::distance::Millimetres;
use atc_kernel::permitted::{Basis, Heard, LineKind};

impl<D: Device> Subject for Ride<D> {
    type State = State;
    type Action = Cycle;

    fn initial(&self) -> Vec<State> {
        let last = u8::try_from(self.layout.points.len() - 1).unwrap_or(0);
        let digital = self.kind_at(0) == LineKind::Digital;
        let mut point_age = [self.environment.keeps + 1; POINTS];
        point_age[usize::from(last)] = 0;
        vec![State {
            train: Train { place: 0, moved: 0, told: None, interval: None },
            ground: Ground { point: last, point_age, restricted: false, free_age: 0, sent: [last; POINTS], repeats: 0 },
            kept: self.rebased(self.permitted.initial(), false),
            shown: Shown { speed: None, basis: Basis::Nothing, code: false },
            ghosts: Ghosts {
                silent: self.most_silent(),
                in_a_row: 0,
                informed: digital,
                starved: false,
                crossed: 0,
                current: false,
            },
        }]
    }

    fn actions(&self, state: &State, cycles: &mut Vec<Cycle>) {
        for moved in self.movements(state) {
            let place = state.train.place + moved;
            // The end of the model.
            if place >= self.layout.end() {
                continue;
            }
            let kind = self.kind_at(place);
            let lines = self.told(&state.train, kind);
            let audible = self.audible(&state.train, place);
            for (ground, counted) in self.grounds(state) {
                let sent = |section: &usize| self.telegrams(*section, &state.ground, &ground, counted);
                let late = audible.iter().filter_map(|section| self.late(*section, state, &ground));
                let mains = lossy(self.environment.main, audible.iter().map(|section| sent(section).0).chain(late));
                let subs = lossy(self.environment.sub, audible.iter().map(|section| sent(section).1));
                for main in &mains {
                    for sub in &subs {
                        for analog in self.analog(place) {
                            for (to_exit, interval) in self.fixes(&state.train, place) {
                                for reported in self.odometer(moved) {
                                    let by = Millimetres(u32::from(reported) * u32::from(CELL_M) * 1000);
                                    for line in &lines {
                                        let heard =
                                            Heard { line: *line, analog, main: *main, sub: *sub, to_exit, moved: by };
                                        let cycle = Cycle { ground, counted, moved, interval, heard };
                                        if !cycles.contains(&cycle) {
                                            cycles.push(cycle);
                                        }
                                    }
                                }
                            }
                        }
                    }
                }
            }
        }
    }

    fn next(&self, state: &State, cycle: &Cycle) -> Option<State> {
        let (kernel, permission) = self.device.step(&self.permitted, state.kept.0, cycle.heard);
        let place = state.train.place + cycle.moved;
        let shown = Shown {
            speed: permission.speed.map(|speed| speed.0),
            basis: permission.basis,
            code: cycle.heard.analog.is_some(),
        };
        let train =
            Train { place, moved: cycle.moved, told: cycle.heard.line.or(state.train.told), interval: cycle.interval };
        Some(State {
            train,
            ground: cycle.ground,
            kept: self.rebased(kernel, cycle.counted),
            shown,
            ghosts: self.seen(state, cycle, &train, shown),
        })
    }

    fn claims(&self) -> Vec<Claim<Self>> {
        self.purpose_claims()
    }

    fn parameters(&self) -> String {
        self.describe()
    }

    fn trace(&self, path: &[(State, Option<Cycle>)]) -> Trace {
        trace::run_of(self, path)
    }
}
