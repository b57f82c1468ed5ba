//! Which code a carrier has: a new one is taken only well inside its band, and kept as long as it is in the band.
//!
//! A frequency at the edge of a band, in noise, would be a code in one hop and none in the next. Of the two ways to
//! hold a code in use for longer, one takes frequencies outside the band (CODE-1): a wrong transmitter would keep a
//! speed that its frequency does not name. So the band stays as it is, and a code that is not in use is taken only in
//! the inner three quarters of it. What that costs is that a transmitter near the edge is not heard: the safe side.

use atc_kernel::code::{Code, CodeFrequencies, Millihertz};

/// The part of the tolerance within which a new code must be. The quarter that is left, 0.25 Hz of the usual 1 Hz, is
/// what a measured frequency is off by at most: after a step of the level (`CodeConfidence::least_steadiness`), and at
/// 10 dB over the noise (`tests/signal.rs`).
const INNER: (u32, u32) = (3, 4);

/// The code in use on one carrier.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Keeper {
    kept: Option<Code>,
}

impl Keeper {
    /// What is heard of this measurement: itself, or nothing.
    pub(super) fn hear(&mut self, codes: &CodeFrequencies, measured: Option<Millihertz>) -> Option<Millihertz> {
        let code = measured.and_then(|measured| codes.identify(measured));
        if code != self.kept {
            let inner = code.zip(measured).is_some_and(|(code, measured)| {
                let nominal = codes.nominal().get(usize::from(code.place()));
                let within = u64::from(codes.tolerance().0) * u64::from(INNER.0) / u64::from(INNER.1);
                nominal.is_some_and(|nominal| u64::from(measured.0.abs_diff(nominal.0)) <= within)
            });
            self.kept = code.filter(|_| inner);
        }
        measured.filter(|_| self.kept.is_some())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::receiver::example_code_table;

    /// What is heard of each measurement in turn, in millihertz; the main codes are 10, 15, 22 Hz …, each ±1 Hz.
    fn heard(measured: &[u32]) -> Vec<bool> {
        let table = example_code_table().expect("the example is right");
        let mut keeper = Keeper::default();
        let hear = |one: &u32| keeper.hear(table.main(), (*one > 0).then_some(Millihertz(*one))).is_some();
        measured.iter().map(hear).collect()
    }

    #[test]
    fn a_new_code_is_taken_well_inside_its_band_only() {
        assert_eq!(heard(&[22_800, 22_750, 22_800, 23_000, 23_001, 23_000]), [false, true, true, true, false, false]);
        assert_eq!(heard(&[21_200, 21_250, 21_000, 20_999, 21_000]), [false, true, true, false, false]);
    }

    /// Nothing is kept over a gap, from one code to the other, or outside the band.
    #[test]
    fn nothing_is_kept_for_another() {
        assert_eq!(heard(&[22_000, 0, 22_900, 22_000]), [true, false, false, true]);
        assert_eq!(heard(&[22_000, 15_900, 15_000, 22_900]), [true, false, true, false]);
    }
}
