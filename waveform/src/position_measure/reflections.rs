//! What the travelling wave leaves out, as a change of the level difference.

use super::drive::{SECTION, line};
use super::results::Reflection;
use crate::rail::chain::{Piece, loss, travelling};
use crate::rail::{Hertz, Metres};

/// Sources that are not matched, and ballast that changes on the way, over distances of up to the section's length.
pub(super) fn reflections() -> Vec<Reflection> {
    let piece = |ohm_km, length| Piece { line: line(ohm_km), length: Metres(length) };
    let greatest = |matched_to: f64, pieces: &dyn Fn(f64) -> Vec<Piece>| {
        let change = |x: f64| {
            let extra = |frequency| {
                let source = line(matched_to).impedance(frequency);
                loss(&pieces(x), frequency, source).0 - travelling(&pieces(x), frequency).0
            };
            (extra(Hertz(3000.0)) - extra(Hertz(1000.0))).abs()
        };
        (0..=200).map(|n| change(f64::from(n) * SECTION / 200.0)).fold(0.0, f64::max)
    };
    let reflection = |line, greatest_db| Reflection { line, greatest_db };
    vec![
        reflection("uniform, matched", greatest(10.0, &|x| vec![piece(10.0, x)])),
        reflection("uniform 2 Ω·km, source matched to 10 Ω·km", greatest(10.0, &|x| vec![piece(2.0, x)])),
        reflection("uniform 50 Ω·km, source matched to 10 Ω·km", greatest(10.0, &|x| vec![piece(50.0, x)])),
        reflection(
            "half 5, half 20 Ω·km, source matched to 10 Ω·km",
            greatest(10.0, &|x| vec![piece(5.0, x / 2.0), piece(20.0, x / 2.0)]),
        ),
        reflection(
            "half 2, half 50 Ω·km, source matched to 10 Ω·km",
            greatest(10.0, &|x| vec![piece(2.0, x / 2.0), piece(50.0, x / 2.0)]),
        ),
    ]
}
