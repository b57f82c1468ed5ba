//! A train that runs towards a transmitter: what its receivers hear and what its odometer says.
//!
//! This is the ground truth against which the kernel's intervals are judged. It knows the line theory of [`crate::rail`], and
//! neither the tables of [`crate::calibration`] nor how they are made.

use crate::calibration::{Arrangement, Calibration, Plan};
use crate::rail::{Decibels, Line, Metres, OhmKilometres};
use atc_kernel::position::{Correction, Millibels, Moved, Position};

/// Track with ballast of its own every few metres.
#[derive(Clone, Debug)]
pub struct Ballast {
    pieces: Vec<OhmKilometres>,
    piece: Metres,
}

impl Ballast {
    /// The same ballast everywhere.
    pub fn uniform(leakage: OhmKilometres) -> Self {
        Self { pieces: vec![leakage], piece: Metres(1.0) }
    }

    /// Pieces of equal length, counted against the direction of travel from the transmitter that is farthest ahead; the last
    /// one goes on for ever. `None` without a piece, or for a length that is not over 0.
    pub fn varying(pieces: Vec<OhmKilometres>, piece: Metres) -> Option<Self> {
        (!pieces.is_empty() && piece.0 > 0.0).then_some(Self { pieces, piece })
    }

    /// The stretches of one ballast between two places.
    fn between(&self, from: f64, to: f64) -> impl Iterator<Item = (OhmKilometres, f64)> + '_ {
        let last = self.pieces.len() - 1;
        self.pieces.iter().zip(0_u32..).map(move |(&leakage, index)| {
            let start = f64::from(index) * self.piece.0;
            let end = if index as usize == last { f64::INFINITY } else { start + self.piece.0 };
            (leakage, (to.min(end) - from.max(start)).max(0.0))
        })
    }
}

/// One section of track, its transmitters and its ballast on one day.
#[derive(Clone, Debug)]
pub struct Site {
    /// Frequencies, transmitters and rails. The weather limits and the table's spacing in it play no part here.
    pub plan: Plan,
    /// The ballast.
    pub ballast: Ballast,
    /// Level of the second signal at its transmitter.
    pub transmitted: Decibels,
}

impl Site {
    /// The levels of both signals under the receivers of a train of length `train`, at `distance` from the transmitter ahead
    /// (the nearer one); `None` where the train's tail has not passed the transmitter behind.
    ///
    /// # Panics
    /// For rails or ballast that [`Line::new`] refuses.
    pub fn levels(&self, distance: Metres, train: Metres) -> [Option<Decibels>; 2] {
        let x = distance.0;
        let (first, second) = match self.plan.arrangement {
            Arrangement::OneTransmitter => ((0.0, x), (0.0, x)),
            Arrangement::TwoAhead { apart_m } => ((apart_m.0, apart_m.0 + x), (0.0, apart_m.0 + x)),
            Arrangement::AheadAndBehind { apart_m, .. } => ((x + train.0, apart_m.0), (0.0, x)),
        };
        let level = |frequency, (from, to): (f64, f64), sent: f64| {
            let lost = |(leakage, length): (OhmKilometres, f64)| {
                let line = Line::new(self.plan.rails, leakage).expect("a ballast that a track can have");
                line.attenuation(frequency, Metres(length)).0
            };
            (from <= to).then(|| Decibels(sent - self.ballast.between(from, to).map(lost).sum::<f64>()))
        };
        [
            level(self.plan.first_hz, first, self.transmitted.0 + self.plan.transmitted_db.0),
            level(self.plan.second_hz, second, self.transmitted.0),
        ]
    }
}

/// What a receiver makes of a level: the nearest whole 0.01 dB to the level plus `error` that is still within `tolerance`.
///
/// # Panics
/// For a level or an error that is not a number, and, where no whole 0.01 dB is near enough, for a tolerance under 1.
pub fn reading(level: Decibels, error: Decibels, tolerance: Millibels) -> Millibels {
    let (level, off) = (level.0 * 100.0, f64::from(tolerance.0));
    let read = (level + error.0 * 100.0).round().clamp((level - off).ceil(), (level + off).floor());
    #[allow(clippy::cast_possible_truncation, reason = "levels are within ±300 dB")]
    Millibels(read as i16)
}

/// An odometer that counts `scale` metres for each metre, and is known to be right to the part `bound`.
#[derive(Clone, Copy, Debug)]
pub struct Odometer {
    /// Metres counted for each metre, between 1 − bound and 1 + bound.
    pub scale: f64,
    /// The bound, 0 to less than 1.
    pub bound: f64,
}

impl Odometer {
    /// What is known of a movement of `towards` metres; `None` beyond 32 m.
    pub fn moved(&self, towards: Metres) -> Option<Moved> {
        let counted = towards.0 * self.scale * 1000.0;
        let ends = [counted / (1.0 - self.bound), counted / (1.0 + self.bound)];
        let (least, most) = (ends[0].min(ends[1]).floor(), ends[0].max(ends[1]).ceil());
        #[allow(clippy::cast_possible_truncation, reason = "checked on the same line")]
        (least >= -32_000.0 && most <= 32_000.0).then(|| Moved::new(least as i16, most as i16)).flatten()
    }
}

/// The kernel's device for `calibration`.
///
/// `None` for a tolerance under 0.
pub fn device(
    calibration: &Calibration,
    tolerance: Millibels,
    floor: Millibels,
    correction: Correction,
) -> Option<Position> {
    Position::new(*calibration.table(), tolerance, floor, correction)
}
