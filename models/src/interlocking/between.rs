//! Two stations, each with the kernel's device, the line between them, and a train at either end that goes to and fro.
//!
//! In every cycle each station is commanded anything or nothing: to turn the line, to set or to withdraw its route in or out. Each reads a
//! permission of the other that still lives, or none. Trains go by signals, and pass one for some cycles after it fell. Circuits may be
//! reported occupied without a train, trains may be lost for a while, and a device may start again: all of it in any cycle, at both ends.
//!
//! A train is where it is on the ground, never where a device has it.

mod conditions;
mod known;

pub use conditions::{Faults, Lives, Times};
pub use known::{Number, Outcome};

use super::neighbours::View;
use super::sizes::{Small, circuits};
use super::stations::{self, IN, OUT, stop};
use super::trace::{Run, direction_word};
use super::yard::Kept;
use crate::outcome::Trace;
use crate::subject::{Claim, Subject};
use atc_kernel::Machine;
use atc_kernel::interlocking::{
    self as kernel, CircuitSet, Input, Orders, Positions, Request, RouteId, SegmentId, SegmentSet, Travel,
};
use atc_kernel::time::Ticks;
use known::Known;
use serde_json::json;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// A train. Its places count from the platform where it begins: 0 the platform, 1 the throat there, then the line, then the throat of the
/// other station, where it ends. It begins again at once.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Train {
    /// The place of its front.
    pub front: u8,
    /// The place of its rear: the same, or the one before.
    pub rear: u8,
    /// Cycles since the signal in front of it showed proceed; one more than the residual running if it did not.
    pub since_proceed: u8,
    /// For how many cycles in a row it has not been reported.
    pub unheard: u8,
}

/// Two devices, what is on its way between them, and two trains.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct State {
    /// The devices.
    pub devices: [Number; 2],
    /// For each the permissions that it has sent, the newest first: a bit for each cycle.
    pub sent: [u8; 2],
    /// The train that begins at each station.
    pub trains: [Train; 2],
    /// The trains have met: in one place, or against each other on the line.
    pub met: bool,
}

/// One cycle: the trains after their moves, and what each device makes of it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Cycle {
    /// The trains.
    pub trains: [Train; 2],
    /// The devices.
    pub outcomes: [Outcome; 2],
}

/// What a model is there to show.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Purpose {
    /// Never do trains meet.
    Safe,
    /// They do, and each of these assumptions excludes it.
    Hazard(&'static [&'static str]),
}

/// The model.
#[derive(Clone, Debug)]
pub struct Between {
    /// The layout of both stations, which are alike.
    pub layout: Small,
    /// What each sees of the line.
    pub view: View,
    /// For how long permissions and signals count.
    pub lives: Lives,
    /// What may happen.
    pub faults: Faults,
    /// What the model is there to show.
    pub purpose: Purpose,
    known: Arc<Mutex<Known>>,
}

/// The line, to each station.
fn line() -> SegmentSet {
    SegmentSet::nth(0)
}

impl Between {
    /// A model of two halts with these times.
    ///
    /// # Panics
    /// If their layout breaks a rule that the theorems rest on; a test builds every model.
    pub fn new(times: Times, view: View, lives: Lives, faults: Faults, purpose: Purpose) -> Self {
        let station = stations::halt().forced(|plan| {
            (plan.turn, plan.start, plan.clear) = (times.turn, times.start, times.clear);
            (plan.residual, plan.loss) = (Ticks(u16::from(lives.residual)), faults.unheard);
            for route in plan.routes.iter_mut().filter(|route| route.exists()) {
                route.release = Ticks(u16::from(lives.residual + faults.unheard));
                route.stay = Ticks(u16::from(faults.unheard) + 1);
            }
        });
        Self { layout: station.layout, view, lives, faults, purpose, known: Arc::default() }
    }

    /// How many places of the line there are.
    fn places(&self) -> u8 {
        self.view.seen().1
    }

    /// The place where a train ends: the throat of the other station.
    fn end(&self) -> u8 {
        self.places() + 2
    }

    /// The signals of a train: where it stands in front of them, and the station and the route of each.
    fn signal(&self, sender: usize, front: u8) -> Option<(usize, u8)> {
        match front {
            0 => Some((sender, OUT)),
            front if front + 1 == self.end() => Some((1 - sender, IN)),
            _ => None,
        }
    }

    /// Where a train may be a cycle later.
    fn moves(&self, train: Train) -> Vec<Train> {
        let mut ways = vec![train];
        let none = self.lives.residual + 1;
        if train.front != train.rear {
            ways.push(Train { rear: train.front, ..train });
        } else if train.front == self.end() {
            ways.push(Train { front: 0, rear: 0, since_proceed: none, unheard: 0 });
        } else if self.signal(0, train.front).is_none() || train.since_proceed <= self.lives.residual {
            ways.push(Train { front: train.front + 1, since_proceed: none, ..train });
        }
        ways
    }

    /// The places of a train on the ground, counted from the first station: a mask.
    fn on(&self, sender: usize, train: Train) -> u8 {
        let at = |place: u8| 1 << if sender == 0 { place } else { self.end() + 1 - place };
        at(train.front) | at(train.rear)
    }

    /// The circuits of a station with a train that is on these places of the ground: a mask.
    fn seen(&self, station: usize, on: u8) -> u8 {
        let (places, last) = (self.view.seen().0[station], self.end() + 1);
        let (platform, throat) = if station == 0 { (0, 1) } else { (last, last - 1) };
        let bit = |there: bool, circuit: u8| u8::from(there) << circuit;
        bit(on & (places << 2) != 0, stop::L)
            | bit(on >> throat & 1 == 1, stop::THROAT)
            | bit(on >> platform & 1 == 1, stop::PLATFORM)
    }

    /// The trains have met: in one place, or both on the line.
    fn have_met(&self, trains: [Train; 2]) -> bool {
        let [first, second] = [0, 1].map(|sender| self.on(sender, trains[sender]));
        let line = ((1 << self.places()) - 1) << 2;
        first & second != 0 || first & line != 0 && second & line != 0
    }

    /// What is commanded: requests that would change nothing are left out.
    fn commands(kept: &Kept) -> Vec<Option<Request>> {
        let it = SegmentId::ZERO;
        let mut commands = vec![None];
        for (number, route) in [IN, OUT].into_iter().filter_map(|number| Some((number, RouteId::new(number)?))) {
            let state = kept.routes[usize::from(number)];
            if !state.is_held() || state.may_resume() {
                commands.push(Some(Request::Set(route)));
            }
            if state.is_held() {
                commands.push(Some(Request::Withdraw(route)));
            }
        }
        for (travel, set) in [(Travel::Toward, kept.directions.toward), (Travel::Away, kept.directions.away)] {
            if !set.meets(line()) {
                commands.push(Some(Request::Turn(it, travel)));
            }
        }
        commands
    }

    fn known(&self) -> MutexGuard<'_, Known> {
        self.known.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// The state of a device, by its number.
    fn device(&self, number: Number) -> Kept {
        self.known().devices[number]
    }

    /// All that a device can make of a cycle, with what is really occupied.
    fn outcomes(&self, device: Number, occupied: u8, living: bool) -> Arc<[Outcome]> {
        let mut known = self.known();
        if let Some(found) = known.outcomes.get(&(device, occupied, living)) {
            return Arc::clone(found);
        }
        let kept = known.devices[device];
        let mut all: Vec<Outcome> = Vec::new();
        let mut add = |state: kernel::State<_, _>, input: Input, started: bool| {
            let (next, output) = self.layout.cycle(state, input);
            let device = known.number(Kept::of(&next));
            let (proceed, permits) = (output.proceed.bits().to_le_bytes()[0], !output.permits.is_empty());
            let same = |one: &Outcome| (one.device, one.proceed, one.permits) == (device, proceed, permits);
            if !all.iter().any(same) {
                known.inputs.push(input);
                all.push(Outcome { device, proceed, permits, started, read: known.inputs.len() - 1 });
            }
        };
        let state = kept.kernel(&self.layout);
        let falsely = (0..=self.faults.falsely).filter(|set| set & !self.faults.falsely == 0 && set & occupied == 0);
        for occupied in falsely.map(|set| circuits(set | occupied)) {
            for consent in [SegmentSet::EMPTY, line()].into_iter().take(1 + usize::from(living)) {
                for request in Self::commands(&kept) {
                    let (detected, orders) = (Positions::NONE, Orders::default());
                    add(state, Input { occupied, detected, request, orders, consent }, false);
                }
            }
            if self.faults.restarts {
                add(self.layout.initial(), Self::first(occupied), true);
            }
        }
        let all: Arc<[Outcome]> = all.into();
        known.outcomes.insert((device, occupied, living), Arc::clone(&all));
        all
    }

    /// What a device reads in the cycle in which it starts: everything is unblocked.
    fn first(occupied: CircuitSet) -> Input {
        let orders = Orders { unblock: CircuitSet::ALL, ..Orders::default() };
        Input { occupied, detected: Positions::NONE, request: None, orders, consent: SegmentSet::EMPTY }
    }

    /// What both devices read before the model begins: each with its train in the platform.
    fn prelude(&self) -> Vec<Input> {
        let plan = self.layout.plan();
        let cycles = usize::from(plan.start.0.max(plan.turn.0)) + usize::from(plan.clear) + 1;
        let first = Self::first(circuits(1 << stop::PLATFORM));
        let quiet = Input { orders: Orders::default(), ..first };
        std::iter::once(first).chain(std::iter::repeat_n(quiet, cycles)).collect()
    }

    /// Whether the front of a train is on the line.
    fn runs(&self, train: Train) -> bool {
        train.front >= 2 && train.front < self.end()
    }
}

impl Subject for Between {
    type State = State;
    type Action = Cycle;

    fn initial(&self) -> Vec<State> {
        let state =
            self.prelude().into_iter().fold(self.layout.initial(), |state, input| self.layout.cycle(state, input).0);
        let train = Train { front: 0, rear: 0, since_proceed: self.lives.residual + 1, unheard: 0 };
        let device = self.known().number(Kept::of(&state));
        vec![State { devices: [device; 2], sent: [0; 2], trains: [train; 2], met: false }]
    }

    fn actions(&self, state: &State, cycles: &mut Vec<Cycle>) {
        if state.met {
            return;
        }
        let ways = state.trains.map(|train| {
            let ways = self.moves(train).into_iter();
            let heard = ways.flat_map(|train| {
                let lost = Train { unheard: train.unheard + 1, ..train };
                [Train { unheard: 0, ..train }, lost].into_iter().filter(|train| train.unheard <= self.faults.unheard)
            });
            heard.collect::<Vec<_>>()
        });
        for first in &ways[0] {
            for second in &ways[1] {
                let trains = [*first, *second];
                let reported = (0..2).filter(|sender| trains[*sender].unheard == 0);
                let on = reported.fold(0, |all, sender| all | self.on(sender, trains[sender]));
                let [one, other] = [0, 1].map(|station| {
                    let living = state.sent[1 - station] != 0;
                    self.outcomes(state.devices[station], self.seen(station, on), living)
                });
                let pairs = one.iter().flat_map(|one| other.iter().map(move |other| [*one, *other]));
                cycles.extend(pairs.map(|outcomes| Cycle { trains, outcomes }));
            }
        }
    }

    fn next(&self, state: &State, cycle: &Cycle) -> Option<State> {
        let living = u8::MAX >> (7 - self.lives.permission);
        let mut after = State { trains: cycle.trains, met: self.have_met(cycle.trains), ..*state };
        for (station, outcome) in cycle.outcomes.iter().enumerate() {
            after.devices[station] = outcome.device;
            after.sent[station] = (state.sent[station] << 1 | u8::from(outcome.permits)) & living;
        }
        for (sender, train) in after.trains.iter_mut().enumerate() {
            let shows = |(station, route): (usize, u8)| cycle.outcomes[station].proceed >> route & 1 == 1;
            let signal = self.signal(sender, train.front).filter(|_| train.front == train.rear);
            let since = (train.since_proceed + 1).min(self.lives.residual + 1);
            train.since_proceed = if signal.is_some_and(shows) { 0 } else { since };
        }
        Some(after)
    }

    fn claims(&self) -> Vec<Claim<Self>> {
        let mut claims = vec![
            Claim::<Self>::always("valid", "both devices' states keep their invariant", |m, s| {
                s.devices.iter().all(|device| m.device(*device).kernel(&m.layout).is_valid(&m.layout))
            }),
            Claim::<Self>::sometimes("first-goes", "the train of the first station is on the line", |m, s| {
                m.runs(s.trains[0])
            }),
        ];
        match self.purpose {
            Purpose::Safe => claims.extend([
                Claim::<Self>::always(
                    "never-met",
                    "never are two trains in one place, nor against each other on the line",
                    |_, s| !s.met,
                ),
                Claim::<Self>::sometimes("second-goes", "the train of the second station is on the line", |m, s| {
                    m.runs(s.trains[1])
                }),
            ]),
            Purpose::Hazard(excluded_by) => claims.push(Claim::<Self>::hazard(
                "met",
                "two trains are in one place, or against each other on the line",
                excluded_by,
                |_, s| s.met,
            )),
        }
        claims
    }

    fn parameters(&self) -> String {
        let plan = self.layout.plan();
        format!(
            "two stations, one line, {}, a train from either end; turn time {} cycles, start {}, clear {}; permissions live for {} cycles, a signal is \
             passed up to {} after it fell{}",
            self.view.words(),
            plan.turn.0,
            plan.start.0,
            plan.clear,
            self.lives.permission,
            self.lives.residual,
            if self.faults.unheard > 0 {
                format!(", trains are lost for {}", self.faults.unheard)
            } else {
                String::new()
            }
        )
    }

    /// The run of the first station's kernel since its last start. The further words of a step: where the trains are, and what the other one does.
    fn trace(&self, path: &[(State, Option<Cycle>)]) -> Trace {
        let names = stations::halt().ground.circuits;
        let mut run = Run::begin("halt", names, &self.layout);
        let started = path.iter().rposition(|(_, cycle)| cycle.is_some_and(|cycle| cycle.outcomes[0].started));
        if started.is_none() {
            for input in self.prelude() {
                run.step(&input, json!({"hazard": false}));
            }
        }
        for (place, (_, cycle)) in path.iter().enumerate().skip(started.unwrap_or(0)) {
            let (Some(cycle), Some((after, _))) = (cycle, path.get(place + 1)) else { break };
            let train =
                |train: Train| json!({"front": train.front, "rear": train.rear, "reported": train.unheard == 0});
            let words = json!({
                "trains": cycle.trains.map(train),
                "direction": direction_word(&self.device(after.devices[0]).directions),
                "neighbour_direction": direction_word(&self.device(after.devices[1]).directions),
                "neighbour_starts": cycle.outcomes[1].started,
                "neighbour_proceed": cycle.outcomes[1].proceed,
                "hazard": after.met,
            });
            let read = self.known().inputs[cycle.outcomes[0].read];
            run.step(&read, words);
        }
        run.trace()
    }
}
