//! What the tests of the signal share: contents, codes, and a receiver's log.
#![allow(dead_code)] // Every test file uses its own part.

use atc_kernel::aspect::AspectId;
use atc_kernel::code::CodeTable;
use atc_kernel::distance::Metres;
use atc_kernel::speed::KmhTenths;
use atc_kernel::telegram::{Counter, Gradient, Length, Main, Route, SectionId, Sub};
use atc_waveform::config::{Codes, TransmitterConfig};
use atc_waveform::receiver::{Event, Heard, MAIN_CODES, OnBoard, SUB_CODES, example_code_table};
use atc_waveform::units::{Hertz, Seconds};

/// The section of all telegrams that tests call their own.
pub const OWN: SectionId = SectionId(321);

pub fn rank(rank: u8) -> AspectId {
    AspectId::new(rank).expect("under 16")
}

pub fn main_telegram(section: SectionId) -> Main {
    Main { section, counter: Counter(250), route: Route::OpenFor(Metres(1234)), speed: rank(5) }
}

pub fn sub_telegram(section: SectionId) -> Sub {
    Sub {
        section,
        counter: Counter(3),
        length: Length::new(Metres(240)).expect("not 0"),
        gradient: Gradient(-25),
        curve: rank(7),
        restriction: rank(4),
    }
}

pub fn table() -> CodeTable {
    example_code_table().expect("the example is right")
}

pub fn hertz(millihertz: u32) -> Hertz {
    Hertz(f64::from(millihertz) / 1000.0)
}

/// The n-th main and the n-th sub code.
pub fn codes(main: usize, sub: usize) -> Codes {
    Codes::new(Some(hertz(MAIN_CODES[main].0)), Some(hertz(SUB_CODES[sub].0))).expect("in range")
}

pub fn samples(config: &TransmitterConfig, seconds: f64) -> Vec<f32> {
    vec![0.0; usize::try_from(Seconds(seconds).samples(config.sample_rate())).expect("short")]
}

/// Everything that a receiver of codes and telegrams heard, with times in seconds.
#[derive(Debug, Default, PartialEq)]
pub struct Log {
    pub events: Vec<Event>,
    pub main: Vec<(f64, Main)>,
    pub sub: Vec<(f64, Sub)>,
    pub speeds: Vec<(f64, Option<KmhTenths>)>,
}

impl Log {
    /// Lets a new receiver hear the whole signal.
    pub fn of(config: &TransmitterConfig, signal: &[f32]) -> Self {
        let mut receiver = OnBoard::new(config, table());
        let mut log = Self::default();
        receiver.process(signal, |event| log.note(config, event));
        log
    }

    pub fn note(&mut self, config: &TransmitterConfig, event: Event) {
        let time = event.at.time(config.sample_rate()).0;
        self.events.push(event);
        match event.heard {
            Heard::Main(main) => self.main.push((time, main)),
            Heard::Sub(sub) => self.sub.push((time, sub)),
            Heard::Speed(speed) => self.speeds.push((time, speed)),
            Heard::Bit(..) | Heard::Code(..) => (),
        }
    }

    /// Whether every telegram says what was sent, each counter one above the last one or, after a loss, a few more.
    pub fn says_only(&self, main: Main, sub: Sub) -> bool {
        self.main.iter().all(|&(_, heard)| Main { counter: main.counter, ..heard } == main)
            && self.sub.iter().all(|&(_, heard)| Sub { counter: sub.counter, ..heard } == sub)
    }
}
