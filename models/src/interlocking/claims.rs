//! What is claimed of a station with trains, and its parameters in words.

use super::device::Device;
use super::environment::{Detection, Drives, Obey};
use super::ground::Heading;
use super::purpose::{Purpose, Sight};
use super::train::{Place, Train};
use super::yard::{Harm, State, Yard, mask};
use crate::subject::{Checked, Claim};
use atc_kernel::interlocking::Phase;

impl<D: Device> Yard<D> {
    pub(super) fn purpose_claims(&self) -> Vec<Claim<Self>> {
        let mut claims = vec![Claim::<Self>::always("valid", "the device's state keeps its invariant", |m, s| {
            s.kept.kernel(&m.station.layout).is_valid(&m.station.layout)
        })];
        match self.purpose {
            Purpose::Accident(harm, excluded_by) => {
                let (name, text, condition): (_, _, fn(&Checked<Self>, &State) -> bool) = match harm {
                    Harm::Derailment => (
                        "derailment",
                        "a train runs over a point that does not lead there, or that moves under it",
                        |_, s| s.harm == Harm::Derailment,
                    ),
                    Harm::Staff => {
                        ("staff-hit", "a train is in a circuit whose block was confirmed", |_, s| s.harm == Harm::Staff)
                    }
                    _ => ("collision", "two trains are in one circuit, or touch", |_, s| s.harm == Harm::Collision),
                };
                claims.push(Claim::<Self>::hazard(name, text, excluded_by, condition));
            }
            Purpose::Safe(sights) | Purpose::Finishes(sights) => {
                claims.extend(self.safe());
                if matches!(self.purpose, Purpose::Finishes(_)) {
                    claims.push(Claim::<Self>::always(
                        "all-can-arrive",
                        "from every state all trains can still arrive",
                        |m, s| m.can_finish(s),
                    ));
                }
                claims.extend(sights.iter().map(|sight| Self::sight(*sight)));
            }
        }
        claims
    }

    fn safe(&self) -> Vec<Claim<Self>> {
        let mut claims = vec![
            Claim::<Self>::always(
                "no-collision",
                "no two trains are in one circuit, or touch, but one that is called on and one that stands there or goes on ahead of it",
                |_, s| s.harm != Harm::Collision,
            ),
            Claim::<Self>::always(
                "no-derailment",
                "no train runs over a point that does not lead there, and no point moves under a train",
                |_, s| s.harm != Harm::Derailment,
            ),
            Claim::<Self>::always(
                "proceed-over-clear",
                "a signal shows proceed only if its way is free and its points lie right",
                |_, s| s.harm != Harm::Proceed,
            ),
            Claim::<Self>::always(
                "authority-over-free",
                "a telegram's stop circuit is reached over circuits that are free, that no other train is granted, and over points that lie \
                 right",
                |_, s| s.harm != Harm::Authority,
            ),
            Claim::<Self>::always(
                "authority-asked-for",
                "a telegram leads only over routes that were requested and not withdrawn since, and the lines that they lead to",
                |_, s| s.harm != Harm::Unasked,
            ),
            Claim::<Self>::always(
                "limit-under-train",
                "no telegram has a speed code above that of a route under any part of its train",
                |_, s| s.harm != Harm::Limit,
            ),
        ];
        if self.environment.obey == Obey::Telegrams {
            claims.push(Claim::<Self>::always(
                "no-overrun",
                "a train that keeps to its telegrams passes no signal that had not shown proceed to it",
                |_, s| s.harm != Harm::Overrun,
            ));
        }
        if self.environment.blocks != 0 || self.environment.staff_beyond.is_some() {
            claims.push(Claim::<Self>::always(
                "no-staff-hit",
                "no train is in a circuit whose block was confirmed, and no point moves there",
                |_, s| s.harm != Harm::Staff,
            ));
        }
        if self.environment.restricts != 0 {
            claims.push(Claim::<Self>::always(
                "restricted",
                "no telegram has a speed code above a restriction of a circuit that it covers, or that is under its train",
                |_, s| s.harm != Harm::Speed,
            ));
        }
        claims
    }

    fn sight(sight: Sight) -> Claim<Self> {
        let (name, text, condition): (_, _, fn(&Checked<Self>, &State) -> bool) = match sight {
            Sight::Arrived => ("arrived", "every train arrives", |m, s| m.all_arrived(s)),
            Sight::Meet => ("meet", "two trains of opposite ways stand at their signals in the station", |m, s| {
                let ground = &m.station.ground;
                let stands = |heading| {
                    let there = |front: u8| ground.line >> front & 1 == 0 && ground.signal(front, heading).is_some();
                    s.trains.iter().any(|train| train.heading == heading && train.front().is_some_and(there))
                };
                stands(Heading::Up) && stands(Heading::Down)
            }),
            Sight::Failed => ("failed", "a point does not arrive in its time, and a route fails", |_, s| {
                s.kept.routes.iter().any(|route| route.phase == Phase::Failed)
            }),
            Sight::Releasing => {
                ("releasing", "the release time of a withdrawn route runs with a train before it", |m, s| {
                    let all = s.trains.iter().fold(0, |all, train| all | train.occupies());
                    let mut routes = s.kept.routes.iter().zip(&m.station.layout.plan().routes);
                    routes.any(|(state, route)| {
                        state.phase == Phase::Releasing
                            && state.time.0 > 0
                            && state.head == 0
                            && mask(route.approach) & all != 0
                    })
                })
            }
            Sight::RunsPast => ("runs-past", "a train runs past a signal that has fallen", |_, s| {
                s.kept.routes.iter().any(|route| route.phase == Phase::Releasing && route.time.0 > 0 && route.head > 0)
            }),
            Sight::BehindTheFirst => (
                "behind-the-first",
                "a circuit that was released behind a train is held by another route while the first is in use",
                |m, s| m.behind_the_first(s),
            ),
            Sight::OverlapGivenUp => {
                ("overlap-given-up", "an overlap is given up while the train stands before it", |m, s| {
                    let mut routes = s.kept.routes.iter().zip(&m.station.layout.plan().routes);
                    routes.any(|(state, route)| {
                        state.phase == Phase::InUse
                            && state.tail < route.length
                            && !state.overlap
                            && !route.overlap.circuits.is_empty()
                    })
                })
            }
            Sight::Turned => ("turned", "a segment is turned away after a train has come in from it", |m, s| {
                let away = |segment: u8| s.kept.directions.away.bits() >> segment & 1 == 1;
                let mut starts = m.environment.trains.iter().zip(&s.trains);
                starts.any(|(start, train)| start.segment.is_some_and(away) && train.place != Place::Coming)
            }),
            Sight::Slides => {
                ("slides", "a train slides past its signal", |_, s| s.trains.iter().any(|t| t.sliding.is_some()))
            }
            Sight::Unheard => ("unheard", "a circuit with a train is not reported", |_, s| {
                s.trains.iter().any(|train| train.unheard != [0; 2])
            }),
            Sight::BlockedUnderTrain => ("blocked-under-train", "a circuit is blocked under a train", |_, s| {
                s.trains.iter().any(|train| train.occupies() & s.kept.blocked != 0)
            }),
            Sight::ConfirmedAhead => {
                ("confirmed-ahead", "a block is confirmed while a train is in the station", |m, s| {
                    let inside = |train: &Train| train.occupies() & !m.station.ground.line != 0;
                    s.kept.confirmed & m.environment.blocks != 0 && s.trains.iter().any(inside)
                })
            }
            Sight::Restricted => {
                ("restricted-telegram", "a train has a telegram over a circuit that is restricted", |_, s| {
                    s.trains.iter().any(|train| train.granted & s.kept.restricted != 0)
                })
            }
            Sight::Telegram => ("telegram", "a train has a telegram over two circuits or more", |_, s| {
                s.trains.iter().any(|train| train.granted.count_ones() > 1)
            }),
            Sight::Filled => {
                ("filled", "not every train can arrive any more, whatever is requested", |m, s| !m.can_finish(s))
            }
            Sight::NoDirection => ("no-direction", "a train is on plain line that has no direction", |m, s| {
                let none = |segment: u8| {
                    let directions = &s.kept.directions;
                    directions.toward.or(directions.away).bits() >> segment & 1 == 0
                };
                let mut starts = m.environment.trains.iter().zip(&s.trains);
                starts.any(|(start, train)| start.segment.is_some_and(none) && train.occupies() >> start.at & 1 == 1)
            }),
            Sight::Shared => ("shared", "a train that was called on is in a circuit with another one", |_, s| {
                s.trains
                    .iter()
                    .any(|train| s.trains.iter().any(|other| train != other && train.called && train.is_behind(other)))
            }),
        };
        Claim::<Self>::sometimes(name, text, condition)
    }

    /// Whether a circuit that a route has released behind its train is held by another route, while the first one is in use.
    fn behind_the_first(&self, state: &State) -> bool {
        let plan = self.station.layout.plan();
        let all = || state.kept.routes.iter().zip(&plan.routes).enumerate();
        all().any(|(number, (first, route))| {
            let released = mask(route.held_from(0).circuits) & !mask(route.held_from(first.tail).circuits);
            let taken = |(other, (second, its)): (usize, (&atc_kernel::interlocking::RouteState, &_))| {
                other != number && second.is_held() && mask(second.path(its).circuits) & released != 0
            };
            first.phase == Phase::InUse && first.tail > 0 && first.tail < route.length && all().any(taken)
        })
    }

    pub(super) fn describe(&self) -> String {
        let plan = self.station.layout.plan();
        let environment = &self.environment;
        let first = plan.routes.iter().find(|route| route.exists());
        let times = first.map_or((0, 0, 0), |route| (route.drive.0, route.release.0, route.stay.0));
        let drives = match environment.drives {
            Drives::Prompt => "points leave and arrive one cycle after the other",
            Drives::Late => "points leave and arrive in any cycle or never while driven",
            Drives::AfterTheDrive => "points leave in any cycle while driven, or one cycle after the drive has ended",
        };
        let detection = match environment.detection {
            Detection::True => "detected where they are at rest",
            Detection::MayFail => "detected where they are at rest, or not",
            Detection::Early => "detected before they arrive",
        };
        let obey = match environment.obey {
            Obey::Signals => "signals, and telegrams on plain line",
            Obey::Telegrams => "telegrams",
            Obey::Nothing => "nothing",
        };
        format!(
            "{}: {} circuits, {} routes, {} trains of one to two circuits that obey {obey}; drive time {}, release time {}, stay time {}, clear after \
             {}, turn time {} cycles; a signal that falls is passed for {} cycles; {drives}, {detection}",
            self.station.name,
            self.station.ground.circuits.len(),
            plan.routes.iter().filter(|route| route.exists()).count(),
            environment.trains.len(),
            times.0,
            times.1,
            times.2,
            plan.clear,
            plan.turn.0,
            environment.residual,
        )
    }
}
