//! Everything that is heard on one carrier.

use atc_kernel::telegram::Reception;

use super::code::{CodeConfidence, CodeDetector, CodeReading};
use super::front::Front;
use super::level::LevelMeter;
use super::msk::MskDemodulator;
use crate::config::{Carrier, TransmitterConfig};

/// The mean of a level is taken over two periods of the lowest code.
const LEVEL_SECONDS: f64 = 0.2;

/// Whether a receiver listens to the keying.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Keying {
    /// It demodulates the bits.
    Heard,
    /// It hears the codes only.
    Ignored,
}

/// When a bit time counts as one in which nothing could be heard.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Squelch {
    /// Least amplitude of the carrier over the last 0.2 s, as a part of full scale.
    pub least_level: f64,
    /// Least lock (see [`DecidedBit::lock`](super::DecidedBit)) from 0 to 1.
    pub least_lock: f64,
}

impl Default for Squelch {
    fn default() -> Self {
        Self { least_level: 0.001, least_lock: 0.25 }
    }
}

impl Squelch {
    /// Every bit is passed on, whatever it is worth; for measurements.
    pub const OPEN: Self = Self { least_level: 0.0, least_lock: 0.0 };
}

/// What one carrier says.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum CarrierEvent {
    /// One bit time is over.
    Bit(Reception),
    /// One window of the code has been analysed.
    Code(CodeReading),
}

/// Front, code detector and demodulator of one carrier.
pub struct CarrierReceiver {
    front: Front,
    code: CodeDetector,
    level: LevelMeter,
    keyed: Option<MskDemodulator>,
    squelch: Squelch,
}

impl CarrierReceiver {
    /// The receiver of one carrier of a signal.
    pub fn new(
        config: &TransmitterConfig,
        carrier: Carrier,
        keying: Keying,
        confidence: CodeConfidence,
        squelch: Squelch,
    ) -> Self {
        let front = Front::new(config, carrier);
        let keyed = match keying {
            Keying::Heard => Some(MskDemodulator::new(front.rate() / config.bit_rate().0)),
            Keying::Ignored => None,
        };
        Self {
            code: CodeDetector::new(front.rate(), confidence),
            level: LevelMeter::new(front.rate(), LEVEL_SECONDS),
            front,
            keyed,
            squelch,
        }
    }

    /// The mean amplitude of the carrier over the last 0.2 s.
    pub fn level(&self) -> f64 {
        self.level.level()
    }

    /// Takes one sample and hands what is found to `events`, at most one of each kind.
    pub fn push(&mut self, sample: f32, mut events: impl FnMut(CarrierEvent)) {
        let Some(envelope) = self.front.push(sample) else { return };
        let magnitude = envelope.norm();
        self.level.push(magnitude);
        if let Some(bit) = self.keyed.as_mut().and_then(|keyed| keyed.push(envelope)) {
            let heard = bit.lock >= self.squelch.least_lock && self.level.level() >= self.squelch.least_level;
            events(CarrierEvent::Bit(match (heard, bit.value) {
                (false, _) => Reception::Nothing,
                (true, false) => Reception::Zero,
                (true, true) => Reception::One,
            }));
        }
        if let Some(reading) = self.code.push(magnitude) {
            events(CarrierEvent::Code(reading));
        }
    }
}
