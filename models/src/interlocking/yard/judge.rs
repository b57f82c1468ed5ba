//! The judge: whether what the trains do is an accident, and whether an output of the machine is one that may lead to one.

use super::{Cycle, Harm, RESTRICTED, State, Yard, mask};
use crate::interlocking::device::Device;
use crate::interlocking::environment::TRAINS;
use crate::interlocking::ground::{Ahead, Blade, Ground, Heading};
use crate::interlocking::purpose::Purpose;
use crate::interlocking::sizes::{POINTS, ROUTES};
use crate::interlocking::train::{Fate, Place, Train};
use atc_kernel::interlocking::{Epoch, Movement, Output, SegmentSet, SpeedCode, movement};

impl<D: Device> Yard<D> {
    /// What has gone wrong in a cycle.
    pub(super) fn harm(
        &self,
        cycle: &Cycle,
        after: &State,
        output: &Output<ROUTES>,
        granted: &[Option<Movement>; TRAINS],
    ) -> Harm {
        let ground = &self.station.ground;
        let mut trains = cycle.trains.iter();
        while let Some(train) = trains.next() {
            let on_sight = |other: &Train| {
                let (sees, seen) = (train.sees(other, &self.environment), other.sees(train, &self.environment));
                self.environment.on_sight && (sees || seen)
            };
            if trains.clone().any(|other| ground.touch(train.occupies(), other.occupies()) && !on_sight(other)) {
                return Harm::Collision;
            }
        }
        // What slides into the sand over a moving point is caught all the same.
        let caught = |train: &&Train| train.sliding.is_none() || train.occupies() & ground.catching == 0;
        let all = cycle.trains.iter().filter(caught).fold(0, |all, train| all | train.occupies());
        let under = |point: usize| all >> ground.points_in[point] & 1 == 1;
        let between = |point: &usize| cycle.blades[*point].rests().is_none();
        if cycle.fate == Fate::Derailed || (0..POINTS).filter(between).any(under) {
            Harm::Derailment
        } else if cycle.fate == Fate::Overrun {
            Harm::Overrun
        } else {
            self.wrong_output(after, output, granted)
        }
    }

    /// The telegrams that the trains hear, at their fronts.
    pub(in crate::interlocking) fn telegrams(
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
    pub(in crate::interlocking) fn wrong_output(
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
        let calls = self.calls();
        if ground.signals.iter().any(|signal| {
            let clear = |berths: u8| self.clear_from(signal.at, signal.heading, berths, after);
            shows(signal.routes & !calls) && !clear(0) || shows(signal.routes & calls) && !clear(self.berths())
        }) {
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
            // Who was called on obeys no telegram that is for the train ahead of it.
            let ahead =
                self.environment.on_sight && after.trains.iter().any(|other| train.is_behind(other) && other != train);
            if granted & hold != 0 && !ahead || !reaches(Heading::Up) && !reaches(Heading::Down) {
                return Harm::Authority;
            }
            granted |= if ahead { 0 } else { hold };
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
    pub(in crate::interlocking) fn staff_beyond(&self, state: &State) -> u8 {
        let Some(wait) = self.environment.staff_beyond else { return 0 };
        let segments = self.station.layout.plan().segments.iter().zip(state.shown.since_consent);
        segments.filter(|(_, since)| *since > wait).fold(0, |all, (segment, _)| all | mask(segment.all()))
    }

    /// The lowest speed of the routes that hold one of these circuits.
    fn limit_under(&self, under: u8, state: &State) -> SpeedCode {
        let routes = self.station.layout.plan().routes.iter().zip(&state.kept.routes);
        let there = routes.filter(|(route, held)| {
            let berth = held.overlap(route).circuits.only_if(route.calling_on);
            mask(held.path(route).circuits.or(berth)) & under != 0
        });
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

    /// The berths of the calling-on routes: a mask.
    fn berths(&self) -> u8 {
        let routes = self.station.layout.plan().routes.iter().filter(|route| route.calling_on);
        routes.fold(0, |all, route| all | mask(route.overlap.circuits))
    }

    /// Whether the way from a signal to the next one, to plain line or to one of the `berths`, is free and its points lie right.
    fn clear_from(&self, at: u8, heading: Heading, berths: u8, state: &State) -> bool {
        let ground = &self.station.ground;
        let mut here = at;
        loop {
            match ground.ahead(here, heading, state.blades) {
                Ahead::Circuit(next) if (ground.line | berths) >> next & 1 == 1 => return here != at,
                Ahead::Circuit(next) => here = next,
                Ahead::Nothing => return here != at,
                Ahead::Between(_) | Ahead::Trailing(_) => return false,
            }
            if taken(state, (here, at), ground) || between(here, state, ground.points_in) {
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
            if taken(state, (next, from), ground)
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
}

/// Whether a train is in the circuit, or touches it and is not the one in `own`. A front that has just come into a circuit and was never reported there does not count:
/// nothing can know of it.
fn taken(state: &State, (circuit, own): (u8, u8), ground: &Ground) -> bool {
    let there = |train: &Train| match train.place {
        Place::Here { front, rear } if front != rear && train.unheard[0] > 0 => 1 << rear,
        _ => train.occupies(),
    };
    state
        .trains
        .iter()
        .map(there)
        .any(|there| there >> circuit & 1 == 1 || there >> own & 1 == 0 && ground.touch(there, 1 << circuit))
}

/// Whether a point in the circuit is between its positions.
fn between(circuit: u8, state: &State, points_in: [u8; POINTS]) -> bool {
    let moving = |(blade, lies): (&Blade, &u8)| *lies == circuit && blade.rests().is_none();
    state.blades.iter().zip(&points_in).any(moving)
}
