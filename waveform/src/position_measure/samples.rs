//! Levels measured from samples: the meter in noise, and a train whose levels come through the moving track.

use super::drive::{ANY_WEATHER, CYCLE, SECTION, SEED, calibration, drive, kernel, line};
use super::results::{MeterPoint, Odometry, Run};
use crate::channel::{Noise, Stage};
use crate::position_meter::LevelMeter;
use crate::position_run::reading;
use crate::rail::{Decibels, Hertz, Metres, MovingTrack, Track};
use crate::units::{Level, Seed};
use atc_kernel::position::Millibels;

const SAMPLE_RATE: Hertz = Hertz(8000.0);
/// A window of the level meter: one cycle.
const WINDOW: u32 = 800;

/// Samples of two tones of amplitude 1 at the transmitter.
fn tones(from: u32) -> impl Iterator<Item = f32> {
    (from..).map(move |n| {
        let turn = |frequency: f64| std::f64::consts::TAU * frequency * f64::from(n) / SAMPLE_RATE.0;
        #[allow(clippy::cast_possible_truncation, reason = "the samples' type")]
        {
            (turn(1000.0).sin() + turn(3000.0).sin()) as f32
        }
    })
}

fn level_meter() -> LevelMeter {
    LevelMeter::new([Hertz(1000.0), Hertz(3000.0)], SAMPLE_RATE, WINDOW).expect("a usual meter")
}

/// White noise under a tone of amplitude 1 that has lost `lost` on its way.
fn noise(lost: Decibels, signal_to_noise: Decibels) -> Noise {
    let effective = Decibels(-lost.0 - signal_to_noise.0).amplitude() / std::f64::consts::SQRT_2;
    Noise::new(Level(effective), Seed(SEED))
}

/// The samples of one window of tones, over the track and with its noise.
fn arrive(block: &mut [f32], window: u32, track: impl FnOnce(&mut [f32]), noise: &mut Noise) {
    block.iter_mut().zip(tones(window * WINDOW % 8000)).for_each(|(sample, tone)| *sample = tone);
    track(block);
    noise.apply(block);
}

/// Levels of both tones through 200 m of ballast of 10 Ω·km; the weaker one, at 3 kHz, has the stated ratio to the noise.
pub(super) fn meter(signal_to_noise_db: f64, windows: u32) -> MeterPoint {
    let distance = Metres(200.0);
    let mut track = Track::new(&line(10.0), distance, SAMPLE_RATE).expect("a usual track");
    let lost = line(10.0).attenuation(Hertz(3000.0), distance);
    let mut noise = noise(lost, Decibels(signal_to_noise_db));
    let (mut meter, mut block) = (level_meter(), [0.0_f32; WINDOW as usize]);
    let (mut squares, mut greatest) = (0.0, 0.0_f64);
    // The first window still fills the filter.
    for window in 0..=windows {
        arrive(&mut block, window, |block| track.process(block), &mut noise);
        meter.push(&block, |levels| {
            let error = levels[1].0 + lost.0;
            if window > 0 {
                squares += error * error;
                greatest = greatest.max(error.abs());
            }
        });
    }
    MeterPoint {
        signal_to_noise_db,
        windows,
        deviation_db: (squares / f64::from(windows)).sqrt(),
        expected_db: LevelMeter::expected_error(Decibels(signal_to_noise_db), WINDOW).0,
        greatest_db: greatest,
    }
}

/// Arrangement (a) with levels measured from samples: the transmitter's tones, the moving track, noise 35 dB under the weaker
/// tone at the section's far end, the meter. An interval belongs to the middle of its window, less the filter's latency.
pub(super) fn from_samples(ohm_km: f64) -> Run {
    let calibration = calibration('a', ANY_WEATHER);
    let mut track = MovingTrack::new(&line(ohm_km), Metres(SECTION + 10.0), SAMPLE_RATE).expect("a usual track");
    let farthest = line(ohm_km).attenuation(Hertz(3000.0), Metres(SECTION));
    let mut noise = noise(farthest, Decibels(35.0));
    let (mut meter, mut block) = (level_meter(), [0.0_f32; WINDOW as usize]);
    let mut window = 0_u32;
    let mut read = |truth: f64| {
        let (from, to) = (Metres(truth + CYCLE / 2.0), Metres(truth - CYCLE / 2.0));
        let mut levels = [None; 2];
        // Once more at the start, to fill the filter.
        for _ in 0..if window == 0 { 2 } else { 1 } {
            arrive(&mut block, window, |block| track.process(block, from, to), &mut noise);
            window += 1;
            meter.push(&block, |measured| {
                levels = measured.map(|level| Some(reading(Decibels(level.0 + 60.0), Decibels(0.0), Millibels(1))));
            });
        }
        levels
    };
    drive(&kernel(&calibration), Odometry::With, &mut read).into_run('a', ohm_km, Odometry::With)
}
