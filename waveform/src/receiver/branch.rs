//! One carrier and the kernel's deframer behind it.

use atc_kernel::Machine;
use atc_kernel::telegram::{Deframer, Main, Reception, Sub, Telegram, Window};

use super::carrier::{CarrierEvent, CarrierReceiver, Keying, Squelch};
use super::code::{CodeConfidence, CodeReading};
use crate::config::{Carrier, TransmitterConfig};

/// What is heard on one carrier.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum OnCarrier {
    /// One bit time is over.
    Bit(Reception),
    /// A telegram on the main carrier, complete with this bit.
    Main(Main),
    /// A telegram on the sub carrier, complete with this bit.
    Sub(Sub),
    /// One window of the code has been analysed.
    Code(CodeReading),
}

/// The receiver of one carrier, with the bits that it heard last.
pub(super) struct Branch {
    carrier: Carrier,
    receiver: CarrierReceiver,
    window: Window,
}

impl Branch {
    pub(super) fn new(
        config: &TransmitterConfig,
        carrier: Carrier,
        keying: Keying,
        confidence: CodeConfidence,
        squelch: Squelch,
    ) -> Self {
        let receiver = CarrierReceiver::new(config, carrier, keying, confidence, squelch);
        Self { carrier, receiver, window: Deframer.initial() }
    }

    /// The mean amplitude of the carrier over the last 0.2 s.
    pub(super) fn level(&self) -> f64 {
        self.receiver.level()
    }

    /// Takes one sample and hands what is found to `events`: a bit, then the telegram that it completes, then the code.
    pub(super) fn push(&mut self, sample: f32, mut events: impl FnMut(OnCarrier)) {
        let (carrier, window) = (self.carrier, &mut self.window);
        self.receiver.push(sample, |event| match event {
            CarrierEvent::Bit(bit) => {
                events(OnCarrier::Bit(bit));
                let (next, telegram) = Deframer.step(*window, bit);
                *window = next;
                // What is heard on the other kind's carrier is no telegram of this line.
                match (carrier, telegram) {
                    (Carrier::Main, Some(Telegram::Main(main))) => events(OnCarrier::Main(main)),
                    (Carrier::Sub, Some(Telegram::Sub(sub))) => events(OnCarrier::Sub(sub)),
                    _ => (),
                }
            }
            CarrierEvent::Code(reading) => events(OnCarrier::Code(reading)),
        });
    }
}
