//! Bit error rate against Eb/N0.

use std::collections::VecDeque;

use rand::{Rng, SeedableRng};
use rand_pcg::Pcg64Mcg;
use serde::Serialize;

use super::theory::{coherent, differentially_decoded, differentially_decoded_under_code, ratio_for};
use crate::channel::{Noise, Stage};
use crate::config::{Carrier, Codes, TransmitterConfig};
use crate::generator::Generator;
use crate::receiver::{Front, MskDemodulator};
use crate::units::{Decibels, Hertz, Seed};

/// Samples handled at once.
const BLOCK: u16 = 4096;
/// Bits at the beginning that are not counted: the clock is being found.
const WARM_UP: u64 = 400;

/// How much is measured.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BitErrorRun {
    /// The codes of both carriers, if they have any.
    pub codes: Codes,
    /// Error of the carriers of the transmitter against the receiver.
    pub offset: Hertz,
    /// A point ends with so many errors, but not before `least_bits` …
    pub errors: u64,
    /// … have been counted.
    pub least_bits: u64,
    /// A point ends at the latest with so many bits.
    pub most_bits: u64,
    /// Seed of bits and noise.
    pub seed: Seed,
}

/// One point of the curve. Both carriers are counted together.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct BitErrorPoint {
    /// Energy of a bit (its modulation included) over noise density.
    pub eb_n0_db: f64,
    /// Bits compared.
    pub bits: u64,
    /// Bits that were wrong, missing or too many.
    pub errors: u64,
    /// Their ratio.
    pub rate: f64,
    /// Q(√(2 Eb/N0)): coherent MSK without differential decoding and without codes.
    pub coherent: f64,
    /// What theory gives for this receiver's kind: coherent, differentially decoded, averaged over the code's envelope.
    pub theory: f64,
    /// How many decibels more than theory this receiver needs for the same rate; nothing with fewer than 50 errors.
    pub loss_db: Option<f64>,
}

/// One carrier of the receiver, with the bits that were sent.
struct Counted {
    front: Front,
    demodulator: MskDemodulator,
    sent: VecDeque<bool>,
    /// Number of the first bit in `sent`; bits before it have been counted.
    next: u64,
    samples_per_bit: f64,
    bits: u64,
    errors: u64,
}

impl Counted {
    fn new(config: &TransmitterConfig, carrier: Carrier) -> Self {
        let front = Front::new(config, carrier);
        let demodulator = MskDemodulator::new(front.rate() / config.bit_rate().0);
        let samples_per_bit = config.sample_rate().0 / config.bit_rate().0;
        Self { front, demodulator, sent: VecDeque::new(), next: 0, samples_per_bit, bits: 0, errors: 0 }
    }

    #[allow(clippy::cast_precision_loss, clippy::cast_possible_truncation, clippy::cast_sign_loss)]
    fn push(&mut self, sample: f32) {
        let Some(bit) = self.front.push(sample).and_then(|envelope| self.demodulator.push(envelope)) else { return };
        let end = (bit.end + 1.0) * self.front.decimation() as f64 - 1.0 - self.front.delay();
        let number = (end / self.samples_per_bit).round() - 1.0;
        if number < 0.0 {
            return;
        }
        let number = number as u64;
        if number < self.next {
            // The clock slipped back: one bit too many.
            self.count(1, 1);
            return;
        }
        while self.next < number {
            // The clock slipped ahead: one bit is missing.
            self.sent.pop_front();
            self.count(1, 1);
            self.next += 1;
        }
        let wrong = self.sent.pop_front() != Some(bit.value);
        self.count(1, u64::from(wrong));
        self.next += 1;
    }

    fn count(&mut self, bits: u64, errors: u64) {
        if self.next >= WARM_UP {
            self.bits += bits;
            self.errors += errors;
        }
    }
}

/// Counts bit errors at one ratio; both carriers are sent and received, real clock recovery included.
pub fn bit_errors(config: &TransmitterConfig, run: &BitErrorRun, ratio: Decibels) -> BitErrorPoint {
    let source = |stream: u64| {
        let mut random = Pcg64Mcg::seed_from_u64(run.seed.0 ^ stream << 32);
        std::iter::repeat_with(move || random.random::<bool>())
    };
    let mut generator = Generator::new(config, run.codes, source(1), source(2));
    generator.offset_carriers(run.offset);
    let mut sent = (source(1), source(2));
    let mut noise = Noise::eb_n0(config, Carrier::Main, run.codes, ratio, Seed(run.seed.0 ^ 3 << 32));
    let mut main = Counted::new(config, Carrier::Main);
    let mut sub = Counted::new(config, Carrier::Sub);
    let mut block = vec![0.0; usize::from(BLOCK)];
    // The bits that were sent are kept two blocks ahead of the receiver.
    let bits_in_block = f64::from(BLOCK) / main.samples_per_bit;
    let mut ahead = 0.0;
    loop {
        generator.fill(&mut block);
        noise.apply(&mut block);
        while ahead < 2.0 * bits_in_block {
            main.sent.extend(sent.0.next());
            sub.sent.extend(sent.1.next());
            ahead += 1.0;
        }
        ahead -= bits_in_block;
        for &sample in &block {
            main.push(sample);
            sub.push(sample);
        }
        let (bits, errors) = (main.bits + sub.bits, main.errors + sub.errors);
        if (bits >= run.least_bits && errors >= run.errors) || bits >= run.most_bits {
            return point(config, run, ratio, bits, errors);
        }
    }
}

#[allow(clippy::cast_precision_loss)]
fn point(config: &TransmitterConfig, run: &BitErrorRun, ratio: Decibels, bits: u64, errors: u64) -> BitErrorPoint {
    let of = |carrier, ratio| match run.codes.of(carrier) {
        None => differentially_decoded(ratio),
        Some(code) => differentially_decoded_under_code(ratio, config.params().depth, code, config.bit_rate()),
    };
    let curve = |ratio| f64::midpoint(of(Carrier::Main, ratio), of(Carrier::Sub, ratio));
    let rate = errors as f64 / bits as f64;
    BitErrorPoint {
        eb_n0_db: ratio.0,
        bits,
        errors,
        rate,
        coherent: coherent(ratio),
        theory: curve(ratio),
        loss_db: (errors >= 50).then(|| ratio.0 - ratio_for(curve, rate).0),
    }
}
