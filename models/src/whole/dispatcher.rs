//! The dispatcher: it sends the trains to and fro, each in its turn, and never more than there are platforms for.

use super::devices::outward;
use super::faults::request;
use super::ground::{Body, PLATFORM, THROAT};
use super::{State, TOO_LONG, Train};
use atc_kernel::heading::Heading;
use atc_kernel::interlocking::{Phase, SegmentSet};

impl<const T: usize> State<T> {
    /// How many trains are on their way.
    fn coming(&self) -> usize {
        let comes = |train: &&Train| train.body.heading == self.bound && !train.body.is_in(train.body.stations().0);
        self.trains.iter().filter(comes).count()
    }

    /// The train that is sent next: one for which there is a platform.
    fn next(&self) -> Option<&Train> {
        let to = usize::from(self.bound == Heading::Right);
        let there = self.trains.iter().filter(|train| train.body.is_in(to)).count();
        let goes = |train: &&Train| train.body.heading == self.bound && train.body.is_in(1 - to);
        let (before, after) = self.trains.split_at(usize::from(self.last.wrapping_add(1)).min(T));
        after.iter().chain(before).find(goes).filter(|_| there + self.coming() < 2)
    }

    /// Trains that have arrived change ends, and the line is given to the other direction when none is left to go this way.
    pub(super) fn dispatch(&mut self, before: &Self) {
        for (number, (train, then)) in (0..).zip(self.trains.iter().zip(&before.trains)) {
            let from = train.body.stations().0;
            if then.body.is_in(from) && !train.body.is_in(from) {
                self.last = number;
            }
        }
        for train in &mut self.trains {
            if train.body.speed == 0 && train.body.is_in(train.body.stations().1) {
                (train.body, train.since) = (train.body.turned(), TOO_LONG);
            }
        }
        if self.next().is_none() && self.coming() == 0 {
            self.bound = self.bound.opposite();
        }
    }

    /// What a station is asked for, by number: first the direction of the line, then a route for the next train.
    pub(super) fn wanted(&self, station: usize) -> Option<u8> {
        let device = &self.stations[station].device.interlocking;
        let away = outward(station) == self.bound;
        let has = if away { device.directions.away } else { device.directions.toward };
        if !has.meets(SegmentSet::nth(0)) {
            return Some(if away { request::AWAY } else { request::TOWARD });
        }
        let free = |track: &u8| {
            let on = |body: &Body| body.on() >> PLATFORM[station] & 1 == 1 && body.tracks[station] == *track;
            !self.trains.iter().any(|train| on(&train.body))
        };
        let route = match self.next() {
            Some(next) if away => 2 + next.body.tracks[station],
            None if away || self.coming() == 0 => return None,
            _ => (0..2).find(free)?,
        };
        let known = device.routes[usize::from(route)];
        let here = |train: &Train| train.body.on() >> THROAT[station] & 1 == 1;
        let entered = self.trains.iter().any(here);
        match known.phase {
            // It was entered by nobody: by a circuit that was falsely occupied.
            Phase::InUse if known.head > 0 && !entered => Some(request::WITHDRAW + route),
            Phase::Failed => Some(request::WITHDRAW + route),
            _ if !known.is_held() || known.may_resume() && entered => Some(request::SET + route),
            _ => None,
        }
    }
}
