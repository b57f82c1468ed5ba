//! A track in pieces, with its reflections: what [`super::Line`] leaves out.
//!
//! Each piece is a four-terminal network; their product, the transmitter's impedance at one end and the short circuit of
//! the train's first axle at the other give the current under the receiver exactly.

use super::{Decibels, Hertz, Line, Metres};
use realfft::num_complex::Complex64;

/// A piece of track with uniform ballast.
#[derive(Clone, Copy, Debug)]
pub struct Piece {
    /// The track.
    pub line: Line,
    /// Its length.
    pub length: Metres,
}

/// What the current under the receiver of a train at the far end of `pieces` loses against the current that the
/// transmitter, of impedance `source` in Ω, drives into a short circuit at its own terminals.
pub fn loss(pieces: &[Piece], frequency: Hertz, source: Complex64) -> Decibels {
    // With the far end shorted, V = B·I and the near current is D·I.
    let (mut b, mut d) = (Complex64::ZERO, Complex64::ONE);
    for piece in pieces.iter().rev() {
        let angle = piece.line.propagation(frequency) * (piece.length.0 / 1000.0);
        let impedance = piece.line.impedance(frequency);
        let (cosh, sinh) = (angle.cosh(), angle.sinh());
        (b, d) = (cosh * b + impedance * sinh * d, sinh / impedance * b + cosh * d);
    }
    Decibels(20.0 * ((b + source * d) / source).norm().log10())
}

/// The sum of the pieces' attenuations: the travelling wave, without reflections.
pub fn travelling(pieces: &[Piece], frequency: Hertz) -> Decibels {
    Decibels(pieces.iter().map(|piece| piece.line.attenuation(frequency, piece.length).0).sum())
}

#[cfg(test)]
mod tests {
    use super::super::{OhmKilometres, Rails};
    use super::*;

    fn piece(ballast: f64, length: f64) -> Piece {
        Piece {
            line: Line::new(Rails::default(), OhmKilometres(ballast)).expect("a usual track"),
            length: Metres(length),
        }
    }

    #[test]
    fn a_matched_uniform_line_has_no_reflections() {
        let one = [piece(10.0, 300.0)];
        let frequency = Hertz(1000.0);
        let matched = one[0].line.impedance(frequency);
        let (exact, wave) = (loss(&one, frequency, matched).0, travelling(&one, frequency).0);
        assert!((exact - wave).abs() < 1e-9, "{exact} {wave}");
        let parts = [piece(10.0, 120.0), piece(10.0, 180.0)];
        assert!((loss(&parts, frequency, matched).0 - wave).abs() < 1e-9);
    }

    #[test]
    fn a_source_without_a_match_and_a_change_of_ballast_reflect() {
        let parts = [piece(50.0, 150.0), piece(2.0, 150.0)];
        let frequency = Hertz(3000.0);
        let matched = parts[0].line.impedance(frequency);
        assert!((loss(&parts, frequency, matched).0 - travelling(&parts, frequency).0).abs() > 0.1);
        assert!((loss(&parts[..1], frequency, matched * 3.0).0 - travelling(&parts[..1], frequency).0).abs() > 0.1);
    }
}
