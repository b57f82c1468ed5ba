//! The train's position from the level difference of two frequencies (JP4045174B2).
//!
//! The rail attenuates two signals by different amounts, so the difference of their levels grows with the distance from the
//! transmitter, and what attenuates both alike cancels. How much it grows depends on the weather. A [`Table`] therefore has
//! two curves, the least and the greatest difference at each distance, and the answer is an interval that contains the
//! train's true distance, or nothing.
//!
//! Requirements: `spec/position.md`, POS-1 to POS-7. Read in this order: [`Position`] (parameters) and [`Table`],
//! [`Measured`] and [`Interval`], [`step`].

mod table;

pub use table::{KNOTS, Millibels, SPANS, Spacing, Span, Spans, Table, TableError};

use crate::Machine;
use crate::distance::Millimetres;

/// The parameters: a calibrated table and what is known of the measurement.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Position {
    table: Table,
    tolerance: Millibels,
    floor: Millibels,
    correction: Correction,
}

/// What is added to the measured difference before the table is asked: anything from `least` to `most`.
///
/// Where one of the receivers is at the rear of the train, it is the attenuation over the train's length, between dry and
/// wet; where both are at the front it is 0.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Correction {
    least: Millibels,
    most: Millibels,
}

impl Correction {
    /// Nothing is added.
    pub const NONE: Self = Self { least: Millibels(0), most: Millibels(0) };

    /// From `least` to `most`; `None` if they are the wrong way round.
    pub const fn new(least: Millibels, most: Millibels) -> Option<Self> {
        if least.0 > most.0 { None } else { Some(Self { least, most }) }
    }

    /// The least that is added.
    pub const fn least(self) -> Millibels {
        self.least
    }

    /// The most that is added.
    pub const fn most(self) -> Millibels {
        self.most
    }
}

/// How far the train moved towards the transmitter since the last cycle: from `least` to `most` millimetres, negative if it
/// moved away. At most 32 767 mm in one cycle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Moved {
    least: i16,
    most: i16,
}

impl Moved {
    /// Not at all.
    pub const STANDING: Self = Self { least: 0, most: 0 };

    /// Anything that can be said: up to 32.7 m either way. What an odometer says that says nothing.
    pub const ANY: Self = Self { least: i16::MIN, most: i16::MAX };

    /// From `least` to `most` millimetres; `None` if they are the wrong way round.
    pub const fn new(least: i16, most: i16) -> Option<Self> {
        if least > most { None } else { Some(Self { least, most }) }
    }

    /// The least, in millimetres.
    pub const fn least(self) -> i16 {
        self.least
    }

    /// The most, in millimetres.
    pub const fn most(self) -> i16 {
        self.most
    }
}

/// What is measured in one cycle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Measured {
    /// The level of the signal that the rail attenuates less; `None`: it is not heard.
    pub first: Option<Millibels>,
    /// The level of the signal that the rail attenuates more; `None`: it is not heard.
    pub second: Option<Millibels>,
    /// What the odometer says.
    pub moved: Moved,
}

/// Where the front of the train is: distances to the transmitter ahead, `nearest` at most `farthest`.
///
/// An interval that contains another one is the safer of the two, and no interval at all is the safest.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Interval {
    nearest: Millimetres,
    farthest: Millimetres,
}

impl Interval {
    /// From `nearest` to `farthest`; `None` if they are the wrong way round.
    pub const fn new(nearest: Millimetres, farthest: Millimetres) -> Option<Self> {
        if nearest.0 > farthest.0 { None } else { Some(Self { nearest, farthest }) }
    }

    /// The least distance to the transmitter.
    pub const fn nearest(self) -> Millimetres {
        self.nearest
    }

    /// The greatest distance to the transmitter.
    pub const fn farthest(self) -> Millimetres {
        self.farthest
    }

    /// What is in both; `None` if nothing is.
    const fn common(self, other: Self) -> Option<Self> {
        let nearest = if self.nearest.0 > other.nearest.0 { self.nearest } else { other.nearest };
        let farthest = if self.farthest.0 < other.farthest.0 { self.farthest } else { other.farthest };
        Self::new(nearest, farthest)
    }

    /// Where the train is after a movement; `None` if it cannot be on this side of the transmitter any more.
    const fn moved(self, moved: Moved) -> Option<Self> {
        let farthest = shifted(self.farthest, moved.least);
        if moved.least as i64 > self.farthest.0 as i64 {
            return None;
        }
        Self::new(shifted(self.nearest, moved.most), farthest)
    }
}

/// The distance after a movement towards the transmitter; 0 at the least.
const fn shifted(distance: Millimetres, towards: i16) -> Millimetres {
    let by = towards.unsigned_abs() as u32;
    if towards >= 0 { Millimetres(distance.0.saturating_sub(by)) } else { Millimetres(distance.0.saturating_add(by)) }
}

impl Position {
    /// A device with this table. Each level is measured to `tolerance` (0 or more); a level under `floor` is noise.
    /// `None` for a negative tolerance.
    pub const fn new(table: Table, tolerance: Millibels, floor: Millibels, correction: Correction) -> Option<Self> {
        if tolerance.0 < 0 { None } else { Some(Self { table, tolerance, floor, correction }) }
    }

    /// The table.
    pub const fn table(&self) -> &Table {
        &self.table
    }

    /// By how much each level may be off.
    pub const fn tolerance(&self) -> Millibels {
        self.tolerance
    }

    /// The lowest level that is no noise.
    pub const fn floor(&self) -> Millibels {
        self.floor
    }

    /// What is added to the measured difference.
    pub const fn correction(&self) -> Correction {
        self.correction
    }

    /// The least and the greatest that the true difference can be, in hundredths of a decibel, with these levels; `None` if they
    /// say nothing.
    pub fn differences(&self, first: Option<Millibels>, second: Option<Millibels>) -> Option<(i32, i32)> {
        //= spec/position.md#pos-2-unknown
        //# The position MUST be unknown if a level is missing or under the noise floor.
        let (Some(first), Some(second)) = (first, second) else { return None };
        if first.0 < self.floor.0 || second.0 < self.floor.0 {
            return None;
        }
        //= spec/position.md#pos-1-the-interval
        //# The interval MUST contain every distance at which some attenuation between the curves gives the measured levels, each off by at most the tolerance.
        let difference = i32::from(first.0) - i32::from(second.0);
        let off = 2 * i32::from(self.tolerance.0);
        let least = difference - off + i32::from(self.correction.least.0);
        let most = difference + off + i32::from(self.correction.most.0);
        Some((least, most))
    }

    /// The interval by the levels alone.
    fn measured(&self, first: Option<Millibels>, second: Option<Millibels>) -> Option<Interval> {
        let (least, most) = self.differences(first, second)?;
        self.table.distances(least, most)
    }
}

/// One cycle: the interval, if there is one, is also what is remembered.
pub fn step(position: &Position, before: Option<Interval>, measured: Measured) -> Option<Interval> {
    let now = position.measured(measured.first, measured.second)?;
    let Some(before) = before else { return Some(now) };
    //= spec/position.md#pos-4-the-odometer
    //# While the train cannot have reached the transmitter since the last interval, the interval MUST be what the levels, the last interval and the odometer have in common, and unknown if that is nothing; otherwise the levels alone count.
    match before.moved(measured.moved) {
        Some(expected) if expected.nearest.0 > 0 => now.common(expected),
        _ => Some(now),
    }
}

impl Machine for Position {
    type State = Option<Interval>;
    type Input = Measured;
    type Output = Option<Interval>;

    const SAFE: Option<Interval> = None;

    fn initial(&self) -> Option<Interval> {
        None
    }

    fn step(&self, before: Option<Interval>, measured: Measured) -> (Option<Interval>, Option<Interval>) {
        let now = step(self, before, measured);
        (now, now)
    }
}
