//! What is claimed of a station with trains, and its parameters in words.

use super::device::Device;
use super::environment::{Detection, Drives, Obey, TRAINS};
use super::ground::{Ahead, Blade, Ground, Heading};
use super::stations::{POINTS, ROUTES};
use super::train::{Place, Train};
use super::yard::{Harm, RESTRICTED, State, Yard, mask};
use crate::subject::{Checked, Claim};
use atc_kernel::interlocking::{Epoch, Movement, Output, Phase, SegmentSet, SpeedCode, movement};

/// What a model is there to show.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Purpose {
    /// There is no accident and no wrong output; and these are seen.
    Safe(&'static [Sight]),
    /// The same, and from every state all trains can still arrive.
    Finishes(&'static [Sight]),
    /// There is this accident, and each of these assumptions or requirements excludes it.
    Accident(Harm, &'static [&'static str]),
}

/// What must be seen, so that a model is not empty.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sight {
    /// Every train arrives.
    Arrived,
    /// Two trains of opposite ways stand at their signals in the station.
    Meet,
    /// A route fails: a point does not arrive in its time.
    Failed,
    /// The release time of a withdrawn route runs while a train is on its approach.
    Releasing,
    /// A train runs past a signal that has fallen, into a route that is being released.
    RunsPast,
    /// A part of a route is released behind its train and held by the next route.
    BehindTheFirst,
    /// An overlap is given up while the train stands before it.
    OverlapGivenUp,
    /// A segment is turned away after a train has come in from it.
    Turned,
    /// A train slides past its signal.
    Slides,
    /// A circuit with a train is not reported.
    Unheard,
    /// A circuit is blocked under a train.
    BlockedUnderTrain,
    /// A block is confirmed while a train is in the station.
    ConfirmedAhead,
    /// A restriction lowers the speed code of a telegram.
    Restricted,
    /// A train has a telegram over two circuits or more.
    Telegram,
    /// Not every train can arrive any more, whatever is requested.
    Filled,
    /// A train is on plain line that has no direction.
    NoDirection,
}

impl<D: Device> Yard<D> {
    /// The telegrams that the trains hear, at their fronts.
    pub(super) fn telegrams(
        &self,
        trains: &[Train; TRAINS],
        output: &Output<ROUTES>,
        epoch: Epoch,
    ) -> [Option<Movement>; TRAINS] {
        let contents = output.table.read(epoch);
        trains.map(|train| {
            let front = atc_kernel::interlocking::CircuitId::new(train.front()?)?;
            contents.map_or(Some(Movement::stop_in(front)), |contents| {
                Some(movement(&self.station.layout, &contents, front))
            })
        })
    }

    /// What is wrong with an output, apart from accidents.
    pub(super) fn wrong_output(
        &self,
        after: &State,
        output: &Output<ROUTES>,
        telegrams: &[Option<Movement>; TRAINS],
    ) -> Harm {
        if matches!(self.purpose, Purpose::Accident(harm, _) if harm != Harm::Staff) {
            return Harm::None;
        }
        let all = after.trains.iter().fold(0, |all, train| all | train.occupies());
        if (mask(output.confirmed) | self.staff_beyond(after)) & all != 0 {
            return Harm::Staff;
        }
        let ground = &self.station.ground;
        let mut points = ground.points_in.iter().zip(&after.blades);
        if points.any(|(lies, blade)| mask(output.confirmed) >> lies & 1 == 1 && blade.rests().is_none()) {
            return Harm::Staff;
        }
        let shows = |routes: u8| routes & after.shown.proceed != 0;
        if ground
            .signals
            .iter()
            .any(|signal| shows(signal.routes) && !self.clear_from(signal.at, signal.heading, after))
        {
            return Harm::Proceed;
        }
        let mut granted = 0;
        for (train, telegram) in after.trains.iter().zip(telegrams) {
            let (Some(front), Some(telegram)) = (train.front(), telegram) else { continue };
            if !telegram.is_open() {
                continue;
            }
            let hold = mask(telegram.hold);
            let stop = telegram.stop.number();
            // The direction of travel that it says is the one in which the train finds these circuits.
            let reaches = |heading: Heading| {
                telegram.heading == Some(heading.of_layout()) && self.reaches((front, stop), hold, heading, after)
            };
            if granted & hold != 0 || !reaches(Heading::Up) && !reaches(Heading::Down) {
                return Harm::Authority;
            }
            granted |= hold;
            let under = train.occupies();
            if (hold | under) & after.kept.restricted != 0 && telegram.speed > RESTRICTED {
                return Harm::Speed;
            }
            if telegram.speed > self.limit_under(under, after) {
                return Harm::Limit;
            }
            if hold & !self.asked_for(front, after) != 0 {
                return Harm::Unasked;
            }
        }
        Harm::None
    }

    /// The line circuits with the neighbours' staff: a mask.
    pub(super) fn staff_beyond(&self, state: &State) -> u8 {
        let Some(wait) = self.environment.staff_beyond else { return 0 };
        let segments = self.station.layout.plan().segments.iter().zip(state.shown.since_consent);
        segments.filter(|(_, since)| *since > wait).fold(0, |all, (segment, _)| all | mask(segment.all()))
    }

    /// The lowest speed of the routes that hold one of these circuits.
    fn limit_under(&self, under: u8, state: &State) -> SpeedCode {
        let routes = self.station.layout.plan().routes.iter().zip(&state.kept.routes);
        let there = routes.filter(|(route, held)| mask(held.path(route).circuits) & under != 0);
        there.map(|(route, _)| route.speed).min().unwrap_or(SpeedCode::MOST)
    }

    /// Where a train with its front in this circuit may be sent: over the routes that are asked for and the lines that they lead to; on plain
    /// line, over that too.
    fn asked_for(&self, front: u8, state: &State) -> u8 {
        let (plan, line) = (self.station.layout.plan(), self.station.ground.line);
        let mut all = if line >> front & 1 == 1 { line } else { 0 };
        let asked = |(number, _): &(usize, &_)| state.shown.asked >> number & 1 == 1;
        for (_, route) in plan.routes.iter().enumerate().filter(asked) {
            all |= mask(route.held_from(0).circuits);
            for (number, segment) in plan.segments.iter().enumerate() {
                all |= mask(segment.all().only_if(route.to.meets(SegmentSet::nth(number))));
            }
        }
        all
    }

    /// Whether the way from a signal to the next one, or to plain line, is free and its points lie right.
    fn clear_from(&self, at: u8, heading: Heading, state: &State) -> bool {
        let ground = &self.station.ground;
        let mut here = at;
        loop {
            match ground.ahead(here, heading, state.blades) {
                Ahead::Circuit(next) if ground.line >> next & 1 == 1 => return here != at,
                Ahead::Circuit(next) => here = next,
                Ahead::Nothing => return here != at,
                Ahead::Between(_) | Ahead::Trailing(_) => return false,
            }
            if taken(state, here, ground) || between(here, state, ground.points_in) {
                return false;
            }
            if ground.signal(here, heading).is_some() {
                return true;
            }
        }
    }

    /// Whether a train gets from one circuit to another over the tracks as they lie, over free circuits of `hold` alone.
    fn reaches(&self, (from, to): (u8, u8), hold: u8, heading: Heading, state: &State) -> bool {
        let ground = &self.station.ground;
        let (mut here, mut seen) = (from, 0_u8);
        while here != to {
            let Ahead::Circuit(next) = ground.ahead(here, heading, state.blades) else { return false };
            if taken(state, next, ground)
                || hold >> next & 1 == 0
                || seen >> next & 1 == 1
                || between(next, state, ground.points_in)
            {
                return false;
            }
            seen |= 1 << next;
            here = next;
        }
        seen == hold
    }

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
            Claim::<Self>::always("no-collision", "no two trains are in one circuit, or touch", |_, s| {
                s.harm != Harm::Collision
            }),
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

/// Whether a train is in the circuit, or touches it. A front that has just come into a circuit and was never reported there does not count:
/// nothing can know of it.
fn taken(state: &State, circuit: u8, ground: &Ground) -> bool {
    let there = |train: &Train| match train.place {
        Place::Here { front, rear } if front != rear && train.unheard[0] > 0 => 1 << rear,
        _ => train.occupies(),
    };
    state.trains.iter().any(|train| ground.touch(there(train), 1 << circuit))
}

/// Whether a point in the circuit is between its positions.
fn between(circuit: u8, state: &State, points_in: [u8; POINTS]) -> bool {
    let moving = |(blade, lies): (&Blade, &u8)| *lies == circuit && blade.rests().is_none();
    state.blades.iter().zip(&points_in).any(moving)
}
