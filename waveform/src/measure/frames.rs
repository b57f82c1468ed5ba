//! How many telegrams and codes come through at a ratio, and how late.

use atc_kernel::code::CodeTable;
use atc_kernel::telegram::{FRAME_BITS, Main, Sub};
use rand::{Rng, SeedableRng};
use rand_pcg::Pcg64Mcg;
use serde::Serialize;

use super::detection::telegrams;
use crate::channel::{Noise, Stage};
use crate::config::{Carrier, Codes, TransmitterConfig};
use crate::receiver::{CodeConfidence, Conventional, Heard, OnBoard};
use crate::transmitter::Transmitter;
use crate::units::{Decibels, Hertz, Seconds, Seed};

/// Frames at the beginning that are not counted: the clock is being found.
const WARM_UP: u32 = 2;
/// Samples handled at once.
const BLOCK: usize = 1000;

/// What is sent and measured.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FrameRun {
    /// The codes of both carriers, if they have any.
    pub codes: Codes,
    /// Error of the carriers of the transmitter against the receiver.
    pub offset: Hertz,
    /// How many frames are counted on each carrier.
    pub frames: u32,
    /// Seed of phases and noise.
    pub seed: Seed,
}

/// How many frames came through. Both carriers are counted together.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct FramePoint {
    /// Energy of a bit (its modulation included) over noise density, of the main carrier.
    pub eb_n0_db: f64,
    /// Error of the carriers in hertz.
    pub offset_hz: f64,
    /// Frames sent and counted.
    pub sent: u32,
    /// Those of them that were heard as they were sent.
    pub heard: u32,
    /// Telegrams that were never sent.
    pub wrong: u32,
}

impl FramePoint {
    /// The part of the frames that were lost.
    pub fn lost(&self) -> f64 {
        1.0 - f64::from(self.heard) / f64::from(self.sent.max(1))
    }
}

/// Counts frames at one ratio, clock recovery and all. The first two frames of each carrier are not counted.
pub fn frames(config: &TransmitterConfig, table: &CodeTable, run: &FrameRun, ratio: Decibels) -> FramePoint {
    let mut point = FramePoint { eb_n0_db: ratio.0, offset_hz: run.offset.0, sent: 2 * run.frames, heard: 0, wrong: 0 };
    let Some((main, sub)) = telegrams() else { return point };
    let mut random = Pcg64Mcg::seed_from_u64(run.seed.0);
    let mut transmitter = Transmitter::new(config, run.codes, main, sub);
    transmitter.generator().advance_phase(random.random(), random.random());
    transmitter.generator().offset_carriers(run.offset);
    let mut noise = Noise::eb_n0(config, Carrier::Main, run.codes, ratio, Seed(random.random()));
    let mut receiver = OnBoard::new(config, *table);
    let frame = f64::from(FRAME_BITS) / config.bit_rate().0;
    let rate = config.sample_rate();
    // The last frame is heard a little after its end, and before the end of the next one.
    let length = Seconds(frame * (f64::from(run.frames + WARM_UP) + 0.5)).samples(rate);
    let counted = |after: Seconds| after.0 > frame * (f64::from(WARM_UP) + 0.5);
    let mut block = [0.0; BLOCK];
    let mut done = 0;
    while done < length {
        let part = usize::try_from(length - done).unwrap_or(BLOCK).min(BLOCK);
        let block = &mut block[..part];
        transmitter.fill(block);
        noise.apply(block);
        receiver.process(block, |event| {
            let right = match event.heard {
                Heard::Main(heard) => (Main { counter: main.counter, ..heard }) == main,
                Heard::Sub(heard) => (Sub { counter: sub.counter, ..heard }) == sub,
                _ => return,
            };
            point.wrong += u32::from(!right);
            point.heard += u32::from(right && counted(event.at.time(rate)));
        });
        done += part as u64;
    }
    point
}

/// The part of reports of a conventional receiver that name the codes' speed, while the signal lasts (`seconds`, less
/// the first one). The ratio is that of the main carrier. Nothing if the table names no speed for the codes.
pub fn codes_heard(
    config: &TransmitterConfig,
    table: &CodeTable,
    codes: Codes,
    ratio: Decibels,
    seconds: Seconds,
    seed: Seed,
) -> Option<f64> {
    let (main, sub) = telegrams()?;
    let millihertz = |carrier| codes.of(carrier).map(table_frequency);
    let expected = table.heard(millihertz(Carrier::Main), millihertz(Carrier::Sub))?;
    let mut transmitter = Transmitter::new(config, codes, main, sub);
    let mut noise = Noise::eb_n0(config, Carrier::Main, codes, ratio, seed);
    let mut receiver = Conventional::new(config, *table, CodeConfidence::default());
    let length = seconds.samples(config.sample_rate());
    let (mut reports, mut right) = (0_u32, 0_u32);
    let mut block = [0.0; BLOCK];
    let mut done = 0;
    while done < length {
        transmitter.fill(&mut block);
        noise.apply(&mut block);
        receiver.process(&block, |event| {
            if event.at.time(config.sample_rate()).0 > 1.0 {
                reports += 1;
                right += u32::from(event.speed == Some(expected));
            }
        });
        done += BLOCK as u64;
    }
    Some(f64::from(right) / f64::from(reports.max(1)))
}

/// A code in whole millihertz.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a checked code, up to 50 Hz")]
fn table_frequency(code: Hertz) -> atc_kernel::code::Millihertz {
    atc_kernel::code::Millihertz((code.0 * 1000.0).round() as u32)
}

/// From the last bit of a telegram at the receiver's input to its report: the longest of ten telegrams on each carrier,
/// without noise. Nothing if no telegram is heard.
pub fn latency(config: &TransmitterConfig, table: &CodeTable) -> Option<Seconds> {
    let (main, sub) = telegrams()?;
    let mut transmitter = Transmitter::new(config, Codes::NONE, main, sub);
    let mut receiver = OnBoard::new(config, *table);
    let frame = f64::from(FRAME_BITS) / config.bit_rate().0;
    let rate = config.sample_rate();
    let mut longest: Option<f64> = None;
    let mut block = [0.0; BLOCK];
    let mut done = 0;
    while done < Seconds(frame * 11.0).samples(rate) {
        transmitter.fill(&mut block);
        receiver.process(&block, |event| {
            let counter = match event.heard {
                Heard::Main(heard) => heard.counter.0.wrapping_sub(main.counter.0),
                Heard::Sub(heard) => heard.counter.0.wrapping_sub(sub.counter.0),
                _ => return,
            };
            let late = event.at.time(rate).0 - frame * (f64::from(counter) + 1.0);
            longest = Some(longest.map_or(late, |longest| longest.max(late)));
        });
        done += BLOCK as u64;
    }
    longest.map(Seconds)
}
