//! The receiver of a train with digital equipment: codes, bits and telegrams of both carriers.

use atc_kernel::code::{CodeTable, Millihertz};
use atc_kernel::speed::KmhTenths;
use atc_kernel::telegram::{Main, Reception, Sub};

use super::branch::{Branch, OnCarrier};
use super::carrier::{Keying, Squelch};
use super::code::{CodeConfidence, CodeReading};
use super::keeper::Keeper;
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
    /// The speed that both codes name, after those of the same hop; a code that was not in use is taken only in the
    /// inner three quarters of its band.
    Speed(Option<KmhTenths>),
}

/// The whole chain of a train: samples in, events out.
pub struct OnBoard {
    main: Branch,
    sub: Branch,
    table: CodeTable,
    at: u64,
    main_code: Option<Millihertz>,
    /// Of the main and of the sub carrier.
    keepers: [Keeper; 2],
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
        let branch = |carrier| Branch::new(config, carrier, Keying::Heard, confidence, squelch);
        let keepers = [Keeper::default(); 2];
        Self { main: branch(Carrier::Main), sub: branch(Carrier::Sub), table, at: 0, main_code: None, keepers }
    }

    /// The mean amplitude of a carrier over the last 0.2 s, as a part of full scale.
    pub fn level(&self, carrier: Carrier) -> f64 {
        match carrier {
            Carrier::Main => self.main.level(),
            Carrier::Sub => self.sub.level(),
        }
    }

    /// Takes the next samples and hands every event to `events`, in the order of time. Allocates nothing.
    pub fn process(&mut self, block: &[f32], mut events: impl FnMut(Event)) {
        for &sample in block {
            self.at += 1;
            let at = SampleIndex(self.at);
            let main_code = &mut self.main_code;
            self.main.push(sample, |on| {
                if let OnCarrier::Code(reading) = on {
                    *main_code = reading.millihertz.map(Millihertz);
                }
                events(Event { at, heard: Heard::on(Carrier::Main, on) });
            });
            // Both carriers are analysed in step, the main one first.
            let (main_code, table) = (self.main_code, &self.table);
            let [main_keeper, sub_keeper] = &mut self.keepers;
            self.sub.push(sample, |on| {
                events(Event { at, heard: Heard::on(Carrier::Sub, on) });
                if let OnCarrier::Code(reading) = on {
                    let sub_code = reading.millihertz.map(Millihertz);
                    let main = main_keeper.hear(table.main(), main_code);
                    let speed = table.heard(main, sub_keeper.hear(table.sub(), sub_code));
                    events(Event { at, heard: Heard::Speed(speed) });
                }
            });
        }
    }
}

impl Heard {
    fn on(carrier: Carrier, heard: OnCarrier) -> Self {
        match heard {
            OnCarrier::Bit(bit) => Self::Bit(carrier, bit),
            OnCarrier::Main(main) => Self::Main(main),
            OnCarrier::Sub(sub) => Self::Sub(sub),
            OnCarrier::Code(reading) => Self::Code(carrier, reading),
        }
    }
}
