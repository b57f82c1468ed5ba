//! The receiver of a train without digital equipment: band-pass, envelope, code frequency.

use atc_kernel::code::{CodeTable, Millihertz};
use atc_kernel::speed::KmhTenths;

use super::carrier::{CarrierEvent, CarrierReceiver, Keying, Squelch};
use super::code::CodeConfidence;
use super::keeper::Keeper;
use crate::config::{Carrier, TransmitterConfig};
use crate::units::SampleIndex;

/// What both codes say at one moment.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CodeEvent {
    /// How many samples had come in by then.
    pub at: SampleIndex,
    /// The code frequency of the main carrier, as it is measured.
    pub main: Option<Millihertz>,
    /// The code frequency of the sub carrier, as it is measured.
    pub sub: Option<Millihertz>,
    /// The speed that the pair names in the table; a code that was not in use is taken only in the inner three quarters
    /// of its band.
    pub speed: Option<KmhTenths>,
}

/// The conventional receiver: the codes of both carriers and the speed that they name.
pub struct Conventional {
    main: CarrierReceiver,
    sub: CarrierReceiver,
    table: CodeTable,
    at: u64,
    heard_main: Option<Millihertz>,
    /// Of the main and of the sub carrier.
    keepers: [Keeper; 2],
}

impl Conventional {
    /// A receiver of this signal with this table.
    pub fn new(config: &TransmitterConfig, table: CodeTable, confidence: CodeConfidence) -> Self {
        let receiver = |carrier| CarrierReceiver::new(config, carrier, Keying::Ignored, confidence, Squelch::default());
        let keepers = [Keeper::default(); 2];
        Self { main: receiver(Carrier::Main), sub: receiver(Carrier::Sub), table, at: 0, heard_main: None, keepers }
    }

    /// Takes the next samples; one event for each hop of the code detectors.
    pub fn process(&mut self, block: &[f32], mut events: impl FnMut(CodeEvent)) {
        for &sample in block {
            self.at += 1;
            let heard_main = &mut self.heard_main;
            self.main.push(sample, |event| {
                if let CarrierEvent::Code(reading) = event {
                    *heard_main = reading.millihertz.map(Millihertz);
                }
            });
            let (at, main, table) = (SampleIndex(self.at), self.heard_main, &self.table);
            let [main_keeper, sub_keeper] = &mut self.keepers;
            // Both carriers are analysed in step, the main one first.
            self.sub.push(sample, |event| {
                if let CarrierEvent::Code(reading) = event {
                    let sub = reading.millihertz.map(Millihertz);
                    let speed = table.heard(main_keeper.hear(table.main(), main), sub_keeper.hear(table.sub(), sub));
                    events(CodeEvent { at, main, sub, speed });
                }
            });
        }
    }
}
