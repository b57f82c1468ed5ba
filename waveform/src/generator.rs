//! The signal, sample by sample: MSK, amplitude-modulated by the code, both carriers added (SIG-1).

use std::f64::consts::TAU;
use std::iter::Empty;

use crate::config::{Carrier, Codes, TransmitterConfig};
use crate::units::Hertz;

/// One carrier: an MSK modulator behind an amplitude modulator.
struct Branch<B> {
    bits: B,
    bit: Option<bool>,
    amplitude: f64,
    depth: f64,
    /// Cycles of the carrier, of one bit, and of the code that have gone by; each from 0 to 1.
    carrier: f64,
    bit_part: f64,
    code: f64,
    carrier_step: f64,
    bit_step: f64,
    code_step: Option<f64>,
}

impl<B: Iterator<Item = bool>> Branch<B> {
    fn new(config: &TransmitterConfig, carrier: Carrier, codes: Codes, mut bits: B) -> Self {
        let rate = config.sample_rate().0;
        Self {
            bit: bits.next(),
            bits,
            amplitude: config.level(carrier).0,
            depth: config.params().depth,
            carrier: 0.0,
            bit_part: 0.0,
            code: 0.0,
            carrier_step: config.carrier(carrier).0 / rate,
            bit_step: config.bit_rate().0 / rate,
            code_step: codes.of(carrier).map(|code| code.0 / rate),
        }
    }

    /// The deviation of the carrier for the bit in progress, in cycles for each bit time.
    fn deviation(&self) -> f64 {
        match self.bit {
            Some(true) => 0.25,
            Some(false) => -0.25,
            None => 0.0,
        }
    }

    fn next(&mut self) -> f64 {
        let envelope = match self.code_step {
            Some(step) => {
                let envelope = 1.0 + self.depth * (TAU * self.code).cos();
                self.code = (self.code + step).fract();
                envelope
            }
            None => 1.0,
        };
        let sample = self.amplitude * envelope * (TAU * self.carrier).cos();

        self.carrier += self.carrier_step;
        let end = self.bit_part + self.bit_step;
        // A bit may end between two samples; each bit turns the phase for its own part of the step.
        if end >= 1.0 {
            self.carrier += self.deviation() * (1.0 - self.bit_part);
            self.bit = self.bits.next();
            self.bit_part = end - 1.0;
            self.carrier += self.deviation() * self.bit_part;
        } else {
            self.carrier += self.deviation() * self.bit_step;
            self.bit_part = end;
        }
        self.carrier = self.carrier.rem_euclid(1.0);
        sample
    }
}

/// A generator of the signal. The bits of each carrier come from an iterator; a carrier whose iterator has ended is not
/// keyed any more and stays at its centre frequency.
pub struct Generator<M, S> {
    main: Branch<M>,
    sub: Branch<S>,
    rate: f64,
}

/// The generator of an analog-only line: neither carrier is keyed.
pub type AnalogGenerator = Generator<Empty<bool>, Empty<bool>>;

impl AnalogGenerator {
    /// A generator whose carriers carry codes and no bits.
    pub fn analog(config: &TransmitterConfig, codes: Codes) -> Self {
        Self::new(config, codes, std::iter::empty(), std::iter::empty())
    }
}

impl<M: Iterator<Item = bool>, S: Iterator<Item = bool>> Generator<M, S> {
    /// A generator that starts at phase 0 with the first bits of both carriers.
    pub fn new(config: &TransmitterConfig, codes: Codes, main: M, sub: S) -> Self {
        Self {
            main: Branch::new(config, Carrier::Main, codes, main),
            sub: Branch::new(config, Carrier::Sub, codes, sub),
            rate: config.sample_rate().0,
        }
    }

    /// Moves both carriers, and the phases of their codes, on by a part of a cycle, so that a signal begins at any phase.
    pub fn advance_phase(&mut self, carrier: f64, code: f64) {
        self.main.carrier = (self.main.carrier + carrier).rem_euclid(1.0);
        self.sub.carrier = (self.sub.carrier + carrier).rem_euclid(1.0);
        self.main.code = (self.main.code + code).rem_euclid(1.0);
        self.sub.code = (self.sub.code + code).rem_euclid(1.0);
    }

    /// Moves both carriers off their centres, as an oscillator with an error does.
    pub fn offset_carriers(&mut self, offset: Hertz) {
        self.main.carrier_step += offset.0 / self.rate;
        self.sub.carrier_step += offset.0 / self.rate;
    }

    /// Changes the codes from the next sample on, without a jump of the carriers.
    pub fn set_codes(&mut self, codes: Codes) {
        self.main.code_step = codes.of(Carrier::Main).map(|code| code.0 / self.rate);
        self.sub.code_step = codes.of(Carrier::Sub).map(|code| code.0 / self.rate);
    }

    /// Where the bits of the main carrier come from.
    pub fn main_bits(&mut self) -> &mut M {
        &mut self.main.bits
    }

    /// Where the bits of the sub carrier come from.
    pub fn sub_bits(&mut self) -> &mut S {
        &mut self.sub.bits
    }

    /// The next samples, as parts of full scale. Allocates nothing.
    pub fn fill(&mut self, block: &mut [f32]) {
        for sample in block {
            *sample = self.next_sample();
        }
    }

    /// The next sample.
    #[allow(clippy::cast_possible_truncation)] // The signal is made in f64 and handed out in f32.
    pub fn next_sample(&mut self) -> f32 {
        (self.main.next() + self.sub.next()) as f32
    }
}
