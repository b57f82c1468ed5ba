//! The whole line as a model that is searched: what may fail in a cycle, and what is claimed.

use super::faults::Event;
use super::ground::{Harm, MIDDLE};
use super::{Purpose, State, Whole};
use crate::outcome::Trace;
use crate::subject::{Claim, Subject};
use atc_kernel::heading::Heading;

impl<const T: usize> Subject for Whole<T> {
    type State = State<T>;
    type Action = Event;

    fn initial(&self) -> Vec<State<T>> {
        vec![self.begin()]
    }

    fn actions(&self, state: &State<T>, actions: &mut Vec<Event>) {
        if state.harm == Harm::None {
            let (first, second, asked) = (self.faults(state, 0), self.faults(state, 1), self.asks(state));
            for one in &first {
                for other in &second {
                    actions.extend(asked.iter().map(|asked| Event { faults: [*one, *other], asked: *asked }));
                }
            }
        }
    }

    fn next(&self, state: &State<T>, event: &Event) -> Option<State<T>> {
        Some(self.cycle(state, *event).after)
    }

    fn claims(&self) -> Vec<Claim<Self>> {
        let mut claims = vec![
            Claim::<Self>::always("valid", "the state of every device keeps its invariant", |m, s| {
                let stations = (0..2).all(|station| s.stations[station].is_valid(m.ground(station)));
                stations && s.trains.iter().all(|train| train.device.is_valid(&m.on_board))
            }),
            Claim::<Self>::sometimes("goes", "a train runs to the east over the middle of the line", |_, s| {
                s.trains.iter().any(|train| train.body.place() == MIDDLE && train.body.heading == Heading::Right)
            }),
        ];
        match self.purpose {
            Purpose::Safe => claims.extend([
                Claim::<Self>::always("no-collision", "never are two trains in one place", |_, s| {
                    s.harm != Harm::Collision
                }),
                Claim::<Self>::always("no-derailment", "no train meets a point that moves or lies wrong", |_, s| {
                    s.harm != Harm::Derailment
                }),
                Claim::<Self>::always("stops", "no train passes a signal at stop, nor the end of its track", |_, s| {
                    !matches!(s.harm, Harm::Signal | Harm::EndOfTrack)
                }),
                Claim::<Self>::sometimes("comes-back", "a train runs to the west", |_, s| {
                    s.trains.iter().any(|train| train.body.heading == Heading::Left && train.body.speed > 0)
                }),
            ]),
            Purpose::Hazard(excluded_by) => {
                claims.push(Claim::<Self>::hazard(
                    "derails",
                    "a train meets a point that moves or lies wrong",
                    excluded_by,
                    |_, s| s.harm == Harm::Derailment,
                ));
            }
        }
        if T == 2 && self.purpose == Purpose::Safe {
            claims.push(Claim::<Self>::sometimes(
                "follows",
                "both trains are on the line, one behind the other",
                |_, s| s.trains.iter().all(|train| (2..5).contains(&train.body.place())),
            ));
        }
        if self.room.faults > 0 {
            claims.push(Claim::<Self>::sometimes(
                "goes-on",
                "after all its faults, a train runs on the line",
                |_, s| {
                    s.left == 0 && s.faults == [None; 2] && s.trains.iter().any(|train| train.body.place() == MIDDLE)
                },
            ));
        }
        claims
    }

    fn parameters(&self) -> String {
        let times = self.times;
        format!(
            "two stations of two platforms, three circuits of line between them, {T} trains of 20 m that gain speed whenever they may; circuits of \
             100 m, cycles of 1 s; telegrams live for {} cycles, consent for {}, residual running {}, loss of shunt {}, clear {}, turn {}, release \
             {}, start {}",
            times.life, times.consent, times.residual, times.loss, times.clear, times.turn, times.release, times.start
        )
    }

    fn trace(&self, path: &[(State<T>, Option<Event>)]) -> Trace {
        self.run(path)
    }
}
