//! How long it takes until a code or a telegram is heard, and how often noise is taken for a code.

use atc_kernel::aspect::AspectId;
use atc_kernel::code::CodeTable;
use atc_kernel::distance::Metres;
use atc_kernel::speed::KmhTenths;
use atc_kernel::telegram::{Counter, Gradient, Length, Main, Route, SectionId, Sub};
use rand::{Rng, SeedableRng};
use rand_pcg::Pcg64Mcg;
use serde::Serialize;

use crate::channel::{Interruption, Interruptions, Noise, Stage};
use crate::config::{Codes, TransmitterConfig};
use crate::receiver::{CodeConfidence, Conventional, Heard, MAIN_CODES, OnBoard, SUB_CODES};
use crate::transmitter::Transmitter;
use crate::units::{Decibels, Hertz, Level, Seconds, Seed};

/// Noise before the signal begins, and how long the receiver may take, in seconds.
const BEFORE: f64 = 0.6;
const LONGEST: f64 = 4.0;

/// How much is measured.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DetectionRun {
    /// Beginnings of a signal for each ratio; the codes take turns.
    pub trials: u32,
    /// Seed of phases and noise.
    pub seed: Seed,
}

/// The distribution of a time, in seconds after the start of the signal.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Times {
    /// Part of the trials in which it came at all within 4 s.
    pub heard: f64,
    /// Half of the trials were at most as long; nothing if fewer than that heard anything.
    pub median: Option<f64>,
    /// 95 % of the trials were at most as long.
    pub percentile_95: Option<f64>,
    /// The longest of those that heard something.
    pub longest: Option<f64>,
}

/// One signal-to-noise ratio.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct DetectionPoint {
    /// Power of both carriers over the power of the noise from zero to half the sample rate.
    pub snr_db: f64,
    /// The same noise, as energy of a bit over noise density of one carrier, both being equally strong.
    pub eb_n0_db: f64,
    /// Trials.
    pub trials: u32,
    /// Until the first report of the right speed from the codes.
    pub code: Times,
    /// Until the first right main telegram.
    pub main_telegram: Times,
    /// Reports of a wrong speed, over all trials; a trial ends when speed and telegram were heard.
    pub wrong_speeds: u32,
    /// Telegrams with other contents than were sent (the counter apart), over all trials.
    pub wrong_telegrams: u32,
}

/// The telegrams that measurements send.
pub(super) fn telegrams() -> Option<(Main, Sub)> {
    let section = SectionId(1234);
    let counter = Counter(0);
    let speed = AspectId::new(5)?;
    let main = Main { section, counter, route: Route::OpenFor(Metres(850)), speed };
    let length = Length::new(Metres(240))?;
    Some((main, Sub { section, counter, length, gradient: Gradient(-12), curve: speed, restriction: speed }))
}

/// Measures detection times at one ratio. The signal begins at an arbitrary moment, in the middle of a telegram, at an
/// arbitrary phase.
///
/// The distribution counts a trial that heard nothing as infinitely long. What is sent are [`MAIN_CODES`] and [`SUB_CODES`] in
/// turn: `table` must know them.
pub fn detection(config: &TransmitterConfig, table: &CodeTable, run: &DetectionRun, ratio: Decibels) -> DetectionPoint {
    let mut random = Pcg64Mcg::seed_from_u64(run.seed.0);
    let mut point = DetectionPoint {
        snr_db: ratio.0,
        eb_n0_db: ratio.0 + 10.0 * (config.sample_rate().0 / 4.0 / config.bit_rate().0).log10(),
        trials: run.trials,
        code: times(Vec::new(), 1),
        main_telegram: times(Vec::new(), 1),
        wrong_speeds: 0,
        wrong_telegrams: 0,
    };
    let Some((main, sub)) = telegrams() else { return point };
    let rate = config.sample_rate();
    let length = Seconds(BEFORE + LONGEST + 1.0).samples(rate);
    let (mut codes_heard, mut telegrams_heard) = (Vec::new(), Vec::new());
    for trial in 0..run.trials {
        let place = trial as usize % MAIN_CODES.len();
        let hertz = |millihertz: u32| Some(Hertz(f64::from(millihertz) / 1000.0));
        let codes = Codes::new(hertz(MAIN_CODES[place].0), hertz(SUB_CODES[place].0)).unwrap_or(Codes::NONE);
        let expected = table.heard(Some(MAIN_CODES[place]), Some(SUB_CODES[place]));
        let mut transmitter = Transmitter::new(config, codes, main, sub);
        transmitter.generator().advance_phase(random.random(), random.random());
        // Up to one second later, so that it is somewhere in a telegram, a bit, and a hop of the detector.
        let start = BEFORE + random.random::<f64>();
        let silence = Interruption { start: Seconds(0.0), length: Seconds(start) };
        let mut silence = Interruptions::new(rate, &[silence]);
        let mut noise = Noise::signal_to_noise(config, codes, ratio, Seed(random.random()));
        let mut receiver = OnBoard::new(config, *table);
        let (mut code, mut telegram) = (None, None);
        let mut block = [0.0; 1000];
        let mut done = 0;
        while done < length && (code.is_none() || telegram.is_none()) {
            transmitter.fill(&mut block);
            silence.apply(&mut block);
            noise.apply(&mut block);
            receiver.process(&block, |event| {
                let after = event.at.time(rate).0 - start;
                match event.heard {
                    Heard::Speed(Some(speed)) if Some(speed) != expected => point.wrong_speeds += 1,
                    Heard::Speed(Some(_)) if after > 0.0 => code = code.or(Some(after)),
                    Heard::Main(heard) if (Main { counter: main.counter, ..heard }) == main => {
                        telegram = telegram.or(Some(after));
                    }
                    Heard::Main(_) => point.wrong_telegrams += 1,
                    Heard::Sub(heard) if (Sub { counter: sub.counter, ..heard }) != sub => point.wrong_telegrams += 1,
                    _ => (),
                }
            });
            done += block.len() as u64;
        }
        codes_heard.extend(code.filter(|&time| time <= LONGEST));
        telegrams_heard.extend(telegram.filter(|&time| time <= LONGEST));
    }
    point.code = times(codes_heard, run.trials);
    point.main_telegram = times(telegrams_heard, run.trials);
    point
}

#[allow(clippy::cast_precision_loss, clippy::cast_possible_truncation, clippy::cast_sign_loss)]
fn times(mut heard: Vec<f64>, trials: u32) -> Times {
    heard.sort_by(f64::total_cmp);
    let trials = f64::from(trials.max(1));
    let at = |part: f64| heard.get((part * trials).ceil() as usize - 1).copied();
    Times {
        heard: heard.len() as f64 / trials,
        median: at(0.5),
        percentile_95: at(0.95),
        longest: heard.last().copied(),
    }
}

/// What was taken for a code in noise alone.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct FalseCodes {
    /// Windows analysed, of both carriers together.
    pub windows: u64,
    /// Length of a window in seconds.
    pub window_s: f64,
    /// From the start of one window to the start of the next, in seconds: the windows overlap by the rest.
    pub hop_s: f64,
    /// As many windows would not overlap in this time.
    pub disjoint_windows: u64,
    /// Windows in which some frequency was reported.
    pub reports: u64,
    /// Windows in which it was near enough to a code of the table.
    pub codes: u64,
    /// Hops in which both carriers together named a speed.
    pub speeds: u64,
    /// The rate of `codes` for each window, or, if there was none, what it is below with a confidence of 95 % (three over the
    /// number of disjoint windows).
    pub code_rate: f64,
}

/// Listens to white noise until so many windows have been analysed.
#[allow(clippy::cast_precision_loss)]
pub fn false_codes(config: &TransmitterConfig, table: &CodeTable, windows: u64, seed: Seed) -> FalseCodes {
    let confidence = CodeConfidence::default();
    let mut noise = Noise::new(Level(0.1), seed);
    let mut receiver = Conventional::new(config, *table, confidence);
    let mut result = FalseCodes {
        windows: 0,
        window_s: confidence.window,
        hop_s: confidence.hop,
        disjoint_windows: 0,
        reports: 0,
        codes: 0,
        speeds: 0,
        code_rate: 0.0,
    };
    let mut block = vec![0.0; 4096];
    while result.windows < windows {
        block.fill(0.0);
        noise.apply(&mut block);
        receiver.process(&block, |event| {
            result.windows += 2;
            result.reports += u64::from(event.main.is_some()) + u64::from(event.sub.is_some());
            let main = event.main.and_then(|code| table.main().identify(code));
            let sub = event.sub.and_then(|code| table.sub().identify(code));
            result.codes += u64::from(main.is_some()) + u64::from(sub.is_some());
            result.speeds += u64::from(event.speed.is_some_and(|speed: KmhTenths| speed.0 > 0));
        });
    }
    result.disjoint_windows = Seconds(result.windows as f64 * confidence.hop).samples(Hertz(1.0 / confidence.window));
    result.code_rate = if result.codes > 0 {
        result.codes as f64 / result.windows as f64
    } else {
        3.0 / result.disjoint_windows as f64
    };
    result
}

/// The codes of the standard signal.
pub(super) const STANDARD_CODES: (Hertz, Hertz) = (Hertz(15.0), Hertz(16.5));

/// A signal with telegrams and codes, for throughput and pictures.
pub(super) fn standard_transmitter(config: &TransmitterConfig) -> Option<Transmitter> {
    let (main, sub) = telegrams()?;
    let codes = Codes::new(Some(STANDARD_CODES.0), Some(STANDARD_CODES.1)).ok()?;
    Some(Transmitter::new(config, codes, main, sub))
}
