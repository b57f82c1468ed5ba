//! A counted line between two stations as a model that is searched: where it starts, what may happen in a cycle, and what is claimed.

use super::known::Key;
use super::{
    Around, COMING, CountedBetween, Cycle, Faults, Often, Purpose, RECEIVER, SENDER, State, TRAINS, Train, cut_sets,
    wrong,
};
use crate::block::fault::{self, Kind};
use crate::outcome::{CutSet, Trace};
use crate::subject::{Claim, Limits, Subject};

impl<const B: usize> Subject for CountedBetween<B> {
    type State = State;
    type Action = Cycle;

    fn initial(&self) -> Vec<State> {
        let devices = [SENDER, RECEIVER].map(|station| {
            let end = &self.ends[station];
            let begin = end.initial();
            let made = end.prelude().into_iter().fold(begin, |device, read| end.step(device, read, self.wiring).device);
            self.known().number(made)
        });
        let trains = [Train::coming(self.none()); TRAINS];
        let state =
            State { trains, devices, sent: 1, faults: Faults::NONE, begun: Faults::NONE, restarted: false, wrong: 0 };
        let with = |faults: &Faults| {
            let mut state: State = state;
            state.faults = *faults;
            state
        };
        self.faults.iter().map(with).collect()
    }

    fn actions(&self, state: &State, cycles: &mut Vec<Cycle>) {
        if state.wrong & wrong::MET != 0 {
            return;
        }
        let faults = state.faults;
        let wrong_reset = std::array::from_fn(|block| faults.counting.has(Kind::WrongReset, block));
        let consents = [self.consents(state), [true, false]];
        let starts = [faults.has(Around::SenderStarts), faults.has(Around::ReceiverStarts)];
        // The circuit beyond the exit is one: where everything fails once, both devices read the same of it.
        let beyond = 1 << self.beyond();
        let alike = self.often == Often::Once && faults.has(Around::ReceiverThroat);
        let may_be = [0, beyond].into_iter().take(1 + usize::from(alike));
        for (trains, falsely) in self.ways(state).into_iter().flat_map(|way| may_be.clone().map(move |set| (way, set)))
        {
            let heard = Self::reported(&trains);
            if falsely & heard != 0 {
                continue;
            }
            let reported = heard | falsely;
            let passing = self.passing(state, &trains);
            for common in self.commons(state, passing) {
                let (failed, hidden) = self.failing(&trains, passing, &common);
                let failed = failed.and(Faults::around(Around::ReceiverThroat, falsely != 0));
                let [one, other] = [SENDER, RECEIVER].map(|station| {
                    self.outcomes(Key {
                        station,
                        device: state.devices[station],
                        common,
                        reported: reported & self.own(station),
                        falsely: self.falsely(station, faults),
                        consents: consents[station],
                        newest: state.sent & 1 == 1,
                        may_start: starts[station],
                        wrong_reset,
                        together: self.resets_together,
                    })
                });
                let pairs = one.iter().flat_map(|one| other.iter().map(move |other| [*one, *other]));
                cycles.extend(pairs.map(|outcomes| Cycle { trains, failed, hidden, outcomes }));
            }
        }
    }

    fn next(&self, state: &State, cycle: &Cycle) -> Option<State> {
        let living = u8::MAX >> (7 - self.lives.permission);
        let mut trains = cycle.trains;
        let wrong = self.wrong(state, &trains, &cycle.outcomes);
        for train in &mut trains {
            if train.front == COMING || train.front >= self.beyond() {
                train.since = self.none();
            } else {
                let since = (train.since + 1).min(self.none());
                train.since = if self.grants(train.front, &cycle.outcomes) { 0 } else { since };
            }
        }
        // The one that has ended is the last to come again.
        if trains[0].front == COMING && state.trains[0].front != COMING {
            trains[..usize::from(self.trains)].rotate_left(1);
            trains[usize::from(self.trains) - 1] = Train::coming(self.none());
        }
        let [sender, receiver] = cycle.outcomes;
        let (faults, begun) = self.left(state, cycle);
        Some(State {
            trains,
            devices: [sender.device, receiver.device],
            sent: (state.sent << 1 | u8::from(receiver.permits)) & living,
            faults,
            begun,
            restarted: state.restarted || self.purpose == Purpose::Safe && (sender.started || receiver.started),
            wrong,
        })
    }

    fn claims(&self) -> Vec<Claim<Self>> {
        let mut claims = vec![
            Claim::<Self>::always("valid", "both devices' states keep their invariant", |m, s| {
                [SENDER, RECEIVER].iter().all(|end| m.ends[*end].is_valid(&m.device(s.devices[*end])))
            }),
            Claim::<Self>::sometimes("two-on-the-line", "two trains are on the line", |m, s| {
                s.trains.iter().filter(|train| m.line() & train.on() != 0).count() > 1
            }),
        ];
        let met = |_: &_, s: &State| s.wrong & wrong::MET != 0;
        match self.purpose {
            Purpose::Hazard(excluded_by) | Purpose::Pairs(excluded_by) => {
                claims.push(Claim::<Self>::hazard("met", "two trains are in one place", excluded_by, met));
                return claims;
            }
            Purpose::Safe => {}
        }
        claims.extend([
            Claim::<Self>::always("never-met", "never are two trains in one place", |_, s| s.wrong & wrong::MET == 0),
            Claim::<Self>::always(
                "sections-occupied",
                "every section with any part of a train counts as occupied at both devices",
                |_, s| s.wrong & wrong::UNREPORTED == 0,
            ),
            Claim::<Self>::always(
                "proceed-over-clear",
                "no signal shows proceed over a place with a train, and no train is granted a place with another one",
                |_, s| s.wrong & wrong::PROCEED == 0,
            ),
            Claim::<Self>::always(
                "sent-by-permission",
                "the sender lets a train go only while a permission of the receiver lives",
                |_, s| s.wrong & wrong::NO_CONSENT == 0,
            ),
            Claim::<Self>::always(
                "permits-what-is-counted",
                "the receiver permits only if its count was verified since its start",
                |_, s| s.wrong & wrong::UNVERIFIED == 0,
            ),
            Claim::<Self>::sometimes("arrives", "a train is wholly in the receiver's platform", |m, s| {
                s.trains.iter().any(|train| train.rear == m.end())
            }),
            Claim::<Self>::sometimes("joint-held", "a tail is in the last section, its head in the throat", |m, s| {
                s.trains.iter().any(|train| train.front == m.beyond() && train.rear + 1 == m.beyond())
            }),
        ]);
        if self.faults.iter().any(|faults| faults.counting != fault::Faults::NONE) {
            claims.push(Claim::<Self>::sometimes(
                "arrives-after-a-fault",
                "a train has arrived, and the line behind it is all reported occupied by disagreement",
                |m, s| m.arrived_in_disagreement(s),
            ));
        }
        if self.faults.iter().any(|f| f.has(Around::SenderStarts) || f.has(Around::ReceiverStarts)) {
            claims.push(Claim::<Self>::sometimes(
                "sent-after-a-start",
                "a train is sent by a route that was set after a device started again",
                |m, s| m.sent_again(s),
            ));
        }
        claims
    }

    fn parameters(&self) -> String {
        let plan = self.ends[SENDER].layout.plan();
        format!(
            "two stations, between them a counted line of {B} block{} of {} sections, up to {} trains; turn time {} cycles, start {}, clear {}; \
             permissions live for {} cycles, a signal is passed up to {} after it fell; {} sets of faults",
            if B == 1 { "" } else { "s" },
            self.sections,
            self.trains,
            plan.turn.0,
            plan.start.0,
            plan.clear,
            self.lives.permission,
            self.lives.residual,
            self.faults.len(),
        )
    }

    fn trace(&self, path: &[(State, Option<Cycle>)]) -> Trace {
        self.run(path)
    }

    fn cut_sets(&self, limits: Limits) -> Option<Vec<CutSet>> {
        match self.purpose {
            Purpose::Pairs(_) => cut_sets::enumerate(self, limits),
            Purpose::Safe | Purpose::Hazard(_) => Some(Vec::new()),
        }
    }
}
