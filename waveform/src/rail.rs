//! The track as a transmission line: two rails, the ballast between them, and a signal that travels along.
//!
//! A [`Line`] has, for each kilometre, a series resistance that rises with the square root of the frequency (skin effect),
//! a series inductance, and between the rails the leakage of the ballast and a capacitance. From these follows the
//! propagation constant γ = √((R + jωL)(G + jωC)); its real part is the attenuation.
//!
//! What the model is, and what it is not:
//!
//! * The signal is the **travelling wave** of a transmitter that is matched to the line: the current at distance x is
//!   e^(−γx) of the current at the transmitter. A matched line that ends in a short circuit, which the first axle of a
//!   train is, carries exactly that current into the short circuit (cosh γx + sinh γx = e^γx), so the train's own shunt
//!   adds nothing.
//! * A transmitter of one fixed impedance, and ballast that changes abruptly, reflect. That is not in [`Line`]; [`chain`] computes
//!   it. Within 400 m a fixed impedance that fits some ballast between the limits keeps the level difference between those of the
//!   limits (tested), in fact much closer together; farther away, or fitting no such ballast, it needs tolerance.
//! * There is one loop, with constant gauge; tuned loops, insulated joints and compensating capacitors are not modelled.
//!
//! The level difference of two frequencies as a measure of the distance is the idea of JP4045174B2 (paragraphs 0008 to 0010).

use realfft::num_complex::Complex64;
use serde::{Deserialize, Serialize};
use std::f64::consts::{LN_10, TAU};
use std::fmt;

pub mod chain;
mod track;

pub use crate::units::{Decibels, Hertz};
pub use track::{MovingTrack, Track, TrackError};

/// A distance along the track in metres.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd, Serialize, Deserialize)]
#[serde(transparent)]
pub struct Metres(pub f64);

/// The insulation of the ballast in Ω·km: 2 is wet, 50 is dry.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd, Serialize, Deserialize)]
#[serde(transparent)]
pub struct OhmKilometres(pub f64);

/// Decibels in a neper.
pub(crate) const DECIBELS_PER_NEPER: f64 = 20.0 / LN_10;

/// The rails: what does not change with the weather. All values are for the loop of both rails.
///
/// The defaults describe rails of 60 kg/m at standard gauge. They are computed, not measured: a rail of steel with 0.22 µΩ·m,
/// a relative permeability of about 110, 0.685 m of circumference and 77 cm² has 0.057 Ω/km (both rails) for direct current and
/// 0.9 Ω/km at 1 kHz in its skin; two of them 1.5 m apart have 1.2 mH/km between them and 0.06 to 0.14 mH/km within the skin at
/// 1 to 6 kHz, together about 1.28 mH/km; their capacitance in air is 9 nF/km, about 20 nF/km over sleepers. The change of the
/// inner inductance over the band, 5 %, is left out. A railway measures its own values: they are configuration.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Rails {
    /// Resistance for direct current, Ω/km.
    pub direct_current_ohm_per_km: f64,
    /// Resistance at 1 kHz, Ω/km; it rises with the square root of the frequency.
    pub one_kilohertz_ohm_per_km: f64,
    /// Inductance, mH/km.
    pub millihenry_per_km: f64,
    /// Capacitance between the rails, nF/km.
    pub nanofarad_per_km: f64,
}

impl Default for Rails {
    fn default() -> Self {
        Self {
            direct_current_ohm_per_km: 0.057,
            one_kilohertz_ohm_per_km: 0.9,
            millihenry_per_km: 1.28,
            nanofarad_per_km: 20.0,
        }
    }
}

impl Rails {
    /// The same rails, if a track can have such values.
    ///
    /// # Errors
    /// The first value that is not a number or not in its range.
    pub fn checked(self) -> Result<Self, RailError> {
        let within = |name, value: f64, least, most| {
            if (least..=most).contains(&value) { Ok(()) } else { Err(RailError { name, value, least, most }) }
        };
        within("direct_current_ohm_per_km", self.direct_current_ohm_per_km, 0.0, 10.0)?;
        within("one_kilohertz_ohm_per_km", self.one_kilohertz_ohm_per_km, 0.0, 100.0)?;
        within("millihenry_per_km", self.millihenry_per_km, 0.1, 10.0)?;
        within("nanofarad_per_km", self.nanofarad_per_km, 0.0, 100_000.0)?;
        Ok(self)
    }

    /// Series impedance at `frequency`, Ω/km.
    pub fn series(&self, frequency: Hertz) -> Complex64 {
        let skin = self.one_kilohertz_ohm_per_km.powi(2) * frequency.0 / 1000.0;
        let resistance = self.direct_current_ohm_per_km.powi(2).hypot(skin).sqrt();
        Complex64::new(resistance, TAU * frequency.0 * self.millihenry_per_km * 1e-3)
    }
}

/// A value that no track has.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RailError {
    /// The value's name.
    pub name: &'static str,
    /// The value.
    pub value: f64,
    /// The least that is accepted.
    pub least: f64,
    /// The most that is accepted.
    pub most: f64,
}

impl fmt::Display for RailError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} is {}; a track has {} to {}", self.name, self.value, self.least, self.most)
    }
}

impl std::error::Error for RailError {}

/// The least and the most insulation that a [`Line`] accepts, Ω·km.
pub const LEAKAGE_RANGE: (f64, f64) = (0.1, 10_000.0);

/// A track with uniform ballast.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Line {
    rails: Rails,
    ballast: OhmKilometres,
}

impl Line {
    /// `rails` on ballast of this insulation.
    ///
    /// # Errors
    /// A value outside what a track can have ([`LEAKAGE_RANGE`] for the ballast).
    pub fn new(rails: Rails, ballast: OhmKilometres) -> Result<Self, RailError> {
        let (least, most) = LEAKAGE_RANGE;
        if !(least..=most).contains(&ballast.0) {
            return Err(RailError { name: "the ballast's insulation in Ω·km", value: ballast.0, least, most });
        }
        Ok(Self { rails: rails.checked()?, ballast })
    }

    /// Admittance between the rails at `frequency`, S/km.
    pub fn shunt(&self, frequency: Hertz) -> Complex64 {
        Complex64::new(1.0 / self.ballast.0, TAU * frequency.0 * self.rails.nanofarad_per_km * 1e-9)
    }

    /// The propagation constant γ at `frequency`, for a kilometre: nepers and radians.
    pub fn propagation(&self, frequency: Hertz) -> Complex64 {
        (self.rails.series(frequency) * self.shunt(frequency)).sqrt()
    }

    /// The characteristic impedance at `frequency`, Ω.
    pub fn impedance(&self, frequency: Hertz) -> Complex64 {
        (self.rails.series(frequency) / self.shunt(frequency)).sqrt()
    }

    /// What a signal of `frequency` loses over `distance`.
    ///
    /// ```
    /// use atc_waveform::rail::{Hertz, Line, Metres, OhmKilometres, Rails};
    ///
    /// let wet = Line::new(Rails::default(), OhmKilometres(2.0)).expect("a usual track");
    /// let kilometre = Metres(1000.0);
    /// let difference = wet.attenuation(Hertz(3000.0), kilometre).0 - wet.attenuation(Hertz(1000.0), kilometre).0;
    /// assert!((8.95..9.05).contains(&difference));
    /// ```
    pub fn attenuation(&self, frequency: Hertz, distance: Metres) -> Decibels {
        Decibels(self.propagation(frequency).re * distance.0 / 1000.0 * DECIBELS_PER_NEPER)
    }

    /// The current at `distance` as a part of that at the transmitter: amplitude and phase.
    pub fn response(&self, frequency: Hertz, distance: Metres) -> Complex64 {
        (-self.propagation(frequency) * (distance.0 / 1000.0)).exp()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn per_kilometre(ballast: f64, frequency: f64) -> f64 {
        let line = Line::new(Rails::default(), OhmKilometres(ballast)).expect("a usual track");
        line.attenuation(Hertz(frequency), Metres(1000.0)).0
    }

    #[test]
    fn the_slope_between_one_and_three_kilohertz_is_that_of_line_theory() {
        for (ballast, slope) in [(2.0, 9.0), (10.0, 4.0), (50.0, 1.8)] {
            let computed = per_kilometre(ballast, 3000.0) - per_kilometre(ballast, 1000.0);
            assert!((computed - slope).abs() < 0.05, "{ballast} Ω·km: {computed} dB/km, expected {slope}");
        }
    }

    #[test]
    fn the_band_loses_three_to_twenty_two_decibels_a_kilometre() {
        let (least, most) = (per_kilometre(50.0, 1000.0), per_kilometre(2.0, 3000.0));
        assert!((2.5..3.5).contains(&least), "dry, 1 kHz: {least}");
        assert!((21.5..22.5).contains(&most), "wet, 3 kHz: {most}");
    }

    #[test]
    fn a_closed_form_agrees() {
        // |γ|² = |Z||Y| and Re γ² = Re(ZY) give α without a complex root.
        let line = Line::new(Rails::default(), OhmKilometres(7.0)).expect("a usual track");
        let (z, y) = (Rails::default().series(Hertz(1234.0)), line.shunt(Hertz(1234.0)));
        let product = z * y;
        let alpha = f64::midpoint(z.norm() * y.norm(), product.re).sqrt();
        assert!((alpha - line.propagation(Hertz(1234.0)).re).abs() < 1e-12);
    }

    #[test]
    fn skin_effect_doubles_the_resistance_at_four_times_the_frequency() {
        let rails = Rails::default();
        let ratio = rails.series(Hertz(4000.0)).re / rails.series(Hertz(1000.0)).re;
        assert!((ratio - 2.0).abs() < 1e-4, "{ratio}");
        assert!((rails.series(Hertz(0.0)).re - 0.057).abs() < 1e-12);
    }

    #[test]
    fn what_no_track_has_is_refused_by_name() {
        let error = Line::new(Rails::default(), OhmKilometres(f64::NAN)).expect_err("no number");
        assert!(error.to_string().contains("insulation"), "{error}");
        let rails = Rails { millihenry_per_km: -1.0, ..Rails::default() };
        let error = Line::new(rails, OhmKilometres(2.0)).expect_err("negative");
        assert_eq!(error.to_string(), "millihenry_per_km is -1; a track has 0.1 to 10");
    }
}
