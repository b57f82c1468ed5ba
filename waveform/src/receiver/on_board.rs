//! The receiver of a train with digital equipment: codes, bits and telegrams of both carriers.

use atc_kernel::Machine;
use atc_kernel::code::{CodeTable, Millihertz};
use atc_kernel::speed::KmhTenths;
use atc_kernel::telegram::{Deframer, Main, Reception, Sub, Telegram, Window};

use super::carrier::{CarrierEvent, CarrierReceiver, Keying, Squelch};
use super::code::{CodeConfidence, CodeReading};
use crate::config::{Carrier, TransmitterConfig};
use crate::units::SampleIndex;

/// What was heard, and when.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Event {
    /// How many samples had come in by then.
    pub at: SampleIndex,
    /// What it is.
    pub heard: Heard,
}

/// What the receiver hears.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Heard {
    /// One bit time of a carrier.
    Bit(Carrier, Reception),
    /// A telegram on the main carrier, complete with this bit.
    Main(Main),
    /// A telegram on the sub carrier, complete with this bit.
    Sub(Sub),
    /// The code of a carrier, once a hop.
    Code(Carrier, CodeReading),
    /// The speed that both codes name, after those of the same hop.
    Speed(Option<KmhTenths>),
}

/// One carrier and the kernel's deframer behind it.
struct Branch {
    carrier: Carrier,
    receiver: CarrierReceiver,
    window: Window,
    code: Option<Millihertz>,
}

impl Branch {
    fn new(config: &TransmitterConfig, carrier: Carrier, confidence: CodeConfidence, squelch: Squelch) -> Self {
        Self {
            carrier,
            receiver: CarrierReceiver::new(config, carrier, Keying::Heard, confidence, squelch),
            window: Deframer.initial(),
            code: None,
        }
    }

    /// Takes one sample; whether a code was analysed with it.
    fn push(&mut self, sample: f32, mut events: impl FnMut(Heard)) -> Analysed {
        let mut analysed = Analysed::Nothing;
        let (carrier, window, code) = (self.carrier, &mut self.window, &mut self.code);
        self.receiver.push(sample, |event| match event {
            CarrierEvent::Bit(bit) => {
                events(Heard::Bit(carrier, bit));
                let (next, telegram) = Deframer.step(*window, bit);
                *window = next;
                // What is heard on the other kind's carrier is no telegram of this line.
                match (carrier, telegram) {
                    (Carrier::Main, Some(Telegram::Main(main))) => events(Heard::Main(main)),
                    (Carrier::Sub, Some(Telegram::Sub(sub))) => events(Heard::Sub(sub)),
                    _ => (),
                }
            }
            CarrierEvent::Code(reading) => {
                *code = reading.millihertz.map(Millihertz);
                events(Heard::Code(carrier, reading));
                analysed = Analysed::Code;
            }
        });
        analysed
    }
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Analysed {
    Code,
    Nothing,
}

/// The whole chain of a train: samples in, events out.
pub struct OnBoard {
    main: Branch,
    sub: Branch,
    table: CodeTable,
    at: u64,
}

impl OnBoard {
    /// A receiver of this signal with this code table and the default thresholds.
    pub fn new(config: &TransmitterConfig, table: CodeTable) -> Self {
        Self::with_thresholds(config, table, CodeConfidence::default(), Squelch::default())
    }

    /// A receiver with other thresholds.
    pub fn with_thresholds(
        config: &TransmitterConfig,
        table: CodeTable,
        confidence: CodeConfidence,
        squelch: Squelch,
    ) -> Self {
        let branch = |carrier| Branch::new(config, carrier, confidence, squelch);
        Self { main: branch(Carrier::Main), sub: branch(Carrier::Sub), table, at: 0 }
    }

    /// The mean amplitude of a carrier over the last 0.2 s, as a part of full scale.
    pub fn level(&self, carrier: Carrier) -> f64 {
        match carrier {
            Carrier::Main => self.main.receiver.level(),
            Carrier::Sub => self.sub.receiver.level(),
        }
    }

    /// Takes the next samples and hands every event to `events`, in the order of time. Allocates nothing.
    pub fn process(&mut self, block: &[f32], mut events: impl FnMut(Event)) {
        for &sample in block {
            self.at += 1;
            let at = SampleIndex(self.at);
            self.main.push(sample, |heard| events(Event { at, heard }));
            let analysed = self.sub.push(sample, |heard| events(Event { at, heard }));
            // Both carriers are analysed in step, the main one first.
            if analysed == Analysed::Code {
                let speed = self.table.heard(self.main.code, self.sub.code);
                events(Event { at, heard: Heard::Speed(speed) });
            }
        }
    }
}
