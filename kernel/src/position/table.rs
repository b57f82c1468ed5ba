//! The attenuation table: least and greatest level difference at equally spaced distances.

use super::Interval;
use crate::distance::Millimetres;
use atc_arithmetic::part;

/// The distances at which a table has values.
pub const KNOTS: usize = 17;

/// The spans between them.
pub const SPANS: usize = KNOTS - 1;

/// A level or a difference of levels in hundredths of a decibel.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Millibels(pub i16);

/// The distance from one knot to the next: 2^k decimetres, 4 ≤ k ≤ 11 (1.6 m to 204.8 m).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Spacing(u8);

impl Spacing {
    /// 2^`exponent` decimetres; `None` unless 4 ≤ `exponent` ≤ 11.
    pub const fn new(exponent: u8) -> Option<Self> {
        if exponent >= 4 && exponent <= 11 { Some(Self(exponent)) } else { None }
    }

    /// The exponent, 4 to 11.
    pub const fn exponent(self) -> u8 {
        self.0
    }

    /// The spacing in decimetres, 16 to 2048.
    pub const fn decimetres(self) -> u32 {
        1 << self.0
    }
}

/// The level difference, first less second, over the distance to the transmitter: between `lowest` and `highest` at each
/// knot, and between the straight lines through them elsewhere.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Table {
    spacing: Spacing,
    lowest: [Millibels; KNOTS],
    highest: [Millibels; KNOTS],
}

/// Which rule a table breaks. Source: `spec/position.md`, POS-5.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TableError {
    /// The lowest difference at this knot (from 0) is above the highest.
    Crossed(usize),
    /// In no span do both curves rise: no distance could be found.
    NowhereRising,
}

impl Table {
    /// Checks and keeps the curves. They may fall in places; there no distance is found.
    ///
    /// # Errors
    /// The first rule that is broken, in the order of [`TableError`].
    pub const fn new(
        spacing: Spacing,
        lowest: [Millibels; KNOTS],
        highest: [Millibels; KNOTS],
    ) -> Result<Self, TableError> {
        //= spec/position.md#pos-5-the-table
        //# A table with a lowest difference above the highest at a knot, or without a span in which both curves rise, MUST be rejected.
        let mut knot = 0;
        while knot < KNOTS {
            if lowest[knot].0 > highest[knot].0 {
                return Err(TableError::Crossed(knot));
            }
            knot += 1;
        }
        let table = Self { spacing, lowest, highest };
        let mut span = 0;
        let mut rises = false;
        while span < SPANS {
            rises |= table.rises(span);
            span += 1;
        }
        if rises { Ok(table) } else { Err(TableError::NowhereRising) }
    }

    /// The distance between knots.
    pub const fn spacing(&self) -> Spacing {
        self.spacing
    }

    /// The lowest difference at each knot.
    pub const fn lowest(&self) -> &[Millibels; KNOTS] {
        &self.lowest
    }

    /// The highest difference at each knot.
    pub const fn highest(&self) -> &[Millibels; KNOTS] {
        &self.highest
    }

    /// Whether both curves rise in the span after knot `span`, which is under [`SPANS`].
    const fn rises(&self, span: usize) -> bool {
        self.lowest[span].0 < self.lowest[span + 1].0 && self.highest[span].0 < self.highest[span + 1].0
    }

    /// The outermost spans in which the difference can be from `least` to `most`; `None` if there is none, or if they do not tell
    /// where the train is.
    pub fn spans(&self, least: i32, most: i32) -> Option<Spans> {
        let mut nearest = None;
        let mut farthest = None;
        let mut doubtful = false;
        for number in 0..SPANS {
            let low = Span { number, ends: [i32::from(self.lowest[number].0), i32::from(self.lowest[number + 1].0)] };
            let high =
                Span { number, ends: [i32::from(self.highest[number].0), i32::from(self.highest[number + 1].0)] };
            let possible =
                (high.ends[0] >= least || high.ends[1] >= least) && (low.ends[0] <= most || low.ends[1] <= most);
            //= spec/position.md#pos-6-curves-that-fall
            //# The position MUST be unknown if the curves do not both rise over every span in which the train can be.
            doubtful |= possible && !self.rises(number);
            nearest = if possible && nearest.is_none() { Some(high) } else { nearest };
            farthest = if possible { Some(low) } else { farthest };
        }
        //= spec/position.md#pos-7-the-ends-of-the-table
        //# The position MUST be unknown if the difference is above what the table has at its far end, or below what it has anywhere.
        let beyond = i32::from(self.lowest[SPANS].0) <= most;
        match (nearest, farthest) {
            (Some(nearest), Some(farthest)) if !doubtful && !beyond => Some(Spans { nearest, farthest }),
            _ => None,
        }
    }

    /// The distances at which the difference can be from `least` to `most`, if they can be told.
    pub(super) fn distances(&self, least: i32, most: i32) -> Option<Interval> {
        self.spans(least, most).and_then(|spans| spans.interval(least, most, self.spacing))
    }
}

/// A straight piece of one curve.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Span {
    /// The number of the knot at which it begins, 0 to 15.
    pub number: usize,
    /// The difference at its knots in hundredths of a decibel, the one nearer to the transmitter first; they fit 16 bits.
    pub ends: [i32; 2],
}

/// The outermost spans in which a train can be; they may be the same.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Spans {
    /// The one nearest to the transmitter, of the curve of the highest differences.
    pub nearest: Span,
    /// The one farthest from it, of the curve of the lowest differences.
    pub farthest: Span,
}

impl Spans {
    /// From where the nearest span reaches `least` to where the farthest one exceeds `most`; `None` if that is the wrong way round.
    pub fn interval(self, least: i32, most: i32, spacing: Spacing) -> Option<Interval> {
        Interval::new(
            place(self.nearest.number, down(self.nearest.ends, least, spacing), spacing),
            place(self.farthest.number, up(self.farthest.ends, most, spacing), spacing),
        )
    }
}

/// The distance of `decimetres` after knot `number`.
fn place(number: usize, decimetres: u32, spacing: Spacing) -> Millimetres {
    let knot = (0..number).fold(0, |distance, _| distance + spacing.decimetres());
    Millimetres((knot + decimetres) * 100)
}

/// How far into a span the straight line through `ends` reaches `level`, rounded down; 0 if it is not below it at the start.
fn down(ends: [i32; 2], level: i32, spacing: Spacing) -> u32 {
    if ends[0] >= level || ends[1] < level || ends[1] <= ends[0] {
        return 0;
    }
    part(ends[0].abs_diff(level), ends[0].abs_diff(ends[1]), spacing.decimetres())
}

/// How far into a span the straight line through `ends` is still not above `level`, rounded up; the whole span if it is not
/// above it at the end.
fn up(ends: [i32; 2], level: i32, spacing: Spacing) -> u32 {
    if ends[1] <= level || ends[0] > level || ends[1] <= ends[0] {
        return spacing.decimetres();
    }
    //= spec/position.md#pos-3-rounding
    //# Every end of an interval MUST be rounded outwards.
    // Rounded down from the far end is rounded up from the near one.
    spacing.decimetres() - part(ends[1].abs_diff(level), ends[0].abs_diff(ends[1]), spacing.decimetres())
}
