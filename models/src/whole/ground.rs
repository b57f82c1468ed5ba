//! The ground as it really is: a line of seven places between two stations, trains on whole metres, blades. Nothing of the kernel's.
//!
//! ```text
//! west 1 ═╗                                              ╔═ east 1
//!          throat ── line ── middle ── line ── throat
//! west 2 ═╝                                              ╚═ east 2
//! place 0    1         2        3        4        5        6
//! ```
//!
//! Places are counted from the west, 100 m each. Both stations see the middle.

use atc_kernel::heading::Heading;

/// The length of each place, in m.
pub const PLACE_M: i16 = 100;
/// How many places there are.
pub const PLACES: u8 = 7;
/// The place that both stations see.
pub const MIDDLE: u8 = 3;
/// The length of every train, in m.
pub const TRAIN_M: i16 = 20;
/// By how much a train gains speed in a cycle of 1 s without brake, and loses with any, in m/s.
pub const GAIN: u8 = 2;
/// The highest speed of a train, in m/s.
pub const FASTEST: u8 = 10;

/// The platform of each station, from the west.
pub const PLATFORM: [u8; 2] = [0, 6];
/// The throat of each station.
pub const THROAT: [u8; 2] = [1, 5];

/// A train as a body.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Body {
    /// The way it faces: right is east.
    pub heading: Heading,
    /// Where its front is, in m from the west end.
    pub front: i16,
    /// Its speed in m/s, even.
    pub speed: u8,
    /// The platform that is its own at each station, 0 or 1: where it stands, or will come to.
    pub tracks: [u8; 2],
}

/// A point as it lies.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Blade {
    /// The platform to which it leads, 0 or 1, or will lead.
    pub to: u8,
    /// For how many cycles more it moves.
    pub moves: u8,
}

/// What went wrong on the ground.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Harm {
    /// Nothing.
    None,
    /// Two trains are in one place.
    Collision,
    /// A train is over a point that moves, or has come from the platform to which it does not lead.
    Derailment,
    /// A train has run over the end of a platform.
    EndOfTrack,
    /// A train has passed a signal that had shown stop for longer than any train may run on.
    Signal,
}

impl Body {
    /// A train that stands in a platform of a station and faces the line.
    pub const fn standing(station: usize, track: u8) -> Self {
        let middle = PLACE_M / 2 + PLATFORM[station] as i16 * PLACE_M;
        let (heading, front) =
            if station == 0 { (Heading::Right, middle + TRAIN_M / 2) } else { (Heading::Left, middle - TRAIN_M / 2) };
        Self { heading, front, speed: 0, tracks: [track; 2] }
    }

    /// Its ends, from the west, in m.
    pub const fn ends(&self) -> (i16, i16) {
        match self.heading {
            Heading::Right => (self.front - TRAIN_M, self.front),
            Heading::Left => (self.front, self.front + TRAIN_M),
        }
    }

    /// The places that it is on: a mask.
    pub fn on(&self) -> u8 {
        let (low, high) = self.ends();
        let on = |place: &u8| low < (i16::from(*place) + 1) * PLACE_M && high > i16::from(*place) * PLACE_M;
        (0..PLACES).filter(on).fold(0, |all, place| all | 1 << place)
    }

    /// The place of its front. A front at a joint is still in front of it.
    pub fn place(&self) -> u8 {
        let metres = if self.heading == Heading::Right { self.front - 1 } else { self.front };
        u8::try_from(metres.div_euclid(PLACE_M).clamp(0, i16::from(PLACES) - 1)).unwrap_or(0)
    }

    /// From its front to the exit of its place, in m.
    pub fn to_exit(&self) -> i16 {
        let low = i16::from(self.place()) * PLACE_M;
        if self.heading == Heading::Right { low + PLACE_M - self.front } else { self.front - low }
    }

    /// The station that it comes from, and the one that it goes to.
    pub const fn stations(&self) -> (usize, usize) {
        if matches!(self.heading, Heading::Right) { (0, 1) } else { (1, 0) }
    }

    /// Whether all of it is in the platform of a station.
    pub fn is_in(&self, station: usize) -> bool {
        self.on() == 1 << PLATFORM[station]
    }

    /// A cycle later, braked or not: at the end of it, and how far it ran.
    #[must_use]
    pub fn rolled(mut self, brake: bool) -> (Self, i16) {
        let before = self.speed;
        self.speed = if brake { before.saturating_sub(GAIN) } else { (before + GAIN).min(FASTEST) };
        let ran = i16::from(before + self.speed) / 2;
        self.front += if self.heading == Heading::Right { ran } else { -ran };
        (self, ran)
    }

    /// The driver goes to the other end.
    #[must_use]
    pub const fn turned(mut self) -> Self {
        let (low, high) = self.ends();
        (self.heading, self.front) = match self.heading {
            Heading::Right => (Heading::Left, low),
            Heading::Left => (Heading::Right, high),
        };
        self
    }

    /// Whether its front went over this joint since `before`.
    pub const fn crossed(&self, before: &Self, joint: i16) -> bool {
        match self.heading {
            Heading::Right => before.front <= joint && self.front > joint,
            Heading::Left => before.front >= joint && self.front < joint,
        }
    }

    /// Whether two trains are in one place. Those at the two platforms of a station are not.
    pub fn meets(&self, other: &Self) -> bool {
        let (one, two) = (self.ends(), other.ends());
        let (low, high) = (one.0.max(two.0), one.1.min(two.1));
        let beside = |station: usize| {
            let within = i16::from(PLATFORM[station]) * PLACE_M;
            low >= within && high <= within + PLACE_M && self.tracks[station] != other.tracks[station]
        };
        low < high && !beside(0) && !beside(1)
    }
}

/// Where the legs of a station's point meet, and where it faces the line, in m.
pub const fn point(station: usize) -> (i16, i16) {
    if station == 0 { (PLACE_M, 2 * PLACE_M) } else { (6 * PLACE_M, 5 * PLACE_M) }
}

impl Blade {
    /// A train has gone from `before` to `after`, and may have met the point of a station: the train as it went on, and whether it derailed.
    pub fn met(&self, station: usize, before: &Body, mut after: Body) -> (Body, bool) {
        let (legs, toe) = point(station);
        let mut derailed = false;
        if after.crossed(before, toe) && after.stations().1 == station {
            after.tracks[station] = self.to;
        }
        if after.crossed(before, legs) && after.stations().0 == station {
            derailed |= after.tracks[station] != self.to;
        }
        derailed |= self.moves > 0 && (before.on() | after.on()) >> THROAT[station] & 1 == 1;
        (after, derailed)
    }
}
