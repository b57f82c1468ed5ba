//! All measurements in one run.

use atc_kernel::code::CodeTable;
use serde::Serialize;

use super::{
    BitErrorPoint, BitErrorRun, DetectionPoint, DetectionRun, FalseCodes, Picture, Throughput, bit_errors, detection,
    false_codes, picture, throughput,
};
use crate::config::{Carrier, Codes, TransmitterConfig};
use crate::units::{Decibels, Hertz, Seconds, Seed};

/// How much is measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Extent {
    /// Some seconds: a tenth of the bits, and fewer beginnings and windows.
    Quick,
    /// A few minutes; up to a million bits for each point and over a million windows of noise.
    Full,
}

/// One curve of bit errors.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct BitErrorCurve {
    /// What was sent.
    pub name: String,
    /// Code frequencies on the main and the sub carrier, in hertz, if there were any.
    pub codes_hz: Option<(f64, f64)>,
    /// Error of the transmitter's carriers in hertz.
    pub offset_hz: f64,
    /// The points, by rising ratio.
    pub points: Vec<BitErrorPoint>,
    /// The largest loss against theory, in decibels, among the points that have one.
    pub worst_loss_db: Option<f64>,
}

/// The result of a run. Without `throughput` it depends on nothing but the seed.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Bench {
    /// How much was measured.
    pub extent: Extent,
    /// The seed.
    pub seed: Seed,
    /// What kind of receiver the bit errors are of.
    pub receiver: &'static str,
    /// Bit error curves.
    pub bit_errors: Vec<BitErrorCurve>,
    /// Detection times.
    pub detection: Vec<DetectionPoint>,
    /// Codes heard in noise.
    pub false_codes: FalseCodes,
    /// Speed of the receivers on this machine.
    pub throughput: Throughput,
    /// Spectrum and envelope of the standard signal; long, so it is serialised on its own.
    #[serde(skip)]
    pub picture: Option<Picture>,
}

/// Measures everything.
///
/// # Panics
/// Never: the codes are this module's own.
pub fn bench(config: &TransmitterConfig, table: &CodeTable, extent: Extent, seed: Seed) -> Bench {
    let (errors, least_bits, most_bits) = match extent {
        Extent::Quick => (100, 10_000, 100_000),
        Extent::Full => (1000, 100_000, 1_000_000),
    };
    let curve = |name: &str, codes: Codes, offset| {
        let run = BitErrorRun { codes, offset: Hertz(offset), errors, least_bits, most_bits, seed };
        let ratios: &[u32] = if codes == Codes::NONE {
            &[0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10]
        } else {
            // Errors come where the envelope is low: the curve falls slowly.
            &[0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 12, 14, 16, 18]
        };
        let points: Vec<_> = ratios.iter().map(|&db| bit_errors(config, &run, Decibels(f64::from(db)))).collect();
        BitErrorCurve {
            name: name.into(),
            codes_hz: codes.of(Carrier::Main).zip(codes.of(Carrier::Sub)).map(|(main, sub)| (main.0, sub.0)),
            offset_hz: offset,
            worst_loss_db: points.iter().filter_map(|point| point.loss_db).reduce(f64::max),
            points,
        }
    };
    let codes = |main, sub| Codes::new(Some(Hertz(main)), Some(Hertz(sub))).expect("codes in range");
    let bit_errors = vec![
        curve("no code", Codes::NONE, 0.0),
        curve("no code, carriers 1 Hz off", Codes::NONE, 1.0),
        curve("codes 10 and 12 Hz", codes(10.0, 12.0), 0.0),
        curve("codes 41.5 and 38.5 Hz", codes(41.5, 38.5), 0.0),
    ];
    let (trials, windows, length) = match extent {
        Extent::Quick => (24, 100_000, 30.0),
        Extent::Full => (600, 4_000_000, 300.0),
    };
    let ratios = (-8..=20).step_by(2).map(|db| Decibels(f64::from(db)));
    Bench {
        extent,
        seed,
        receiver: "coherent detection of MSK, differential decoding",
        bit_errors,
        detection: ratios.map(|db| detection(config, table, &DetectionRun { trials, seed }, db)).collect(),
        false_codes: false_codes(config, table, windows, seed),
        throughput: throughput(config, table, Seconds(length)),
        picture: picture(config),
    }
}
