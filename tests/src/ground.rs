//! Two trains on the same ground, one after the other: a *new* train that reads codes and telegrams, and a *conventional* one
//! that reads codes alone. Six sections, a train ahead in the seventh; each section's transmitter sends a code and frames of
//! 530 ms at a phase of its own. A driver follows the kernel's permitted speed. All in integers: the same in every run.

use atc_protocol::machine::Machine as _;
use atc_protocol::machine::permitted::{Config, LineKind, Output, Permitting, Step};
use atc_protocol::telegrams::{MainTelegram, SubTelegram};
use atc_protocol::{Kmh, Metres};
use serde_json::json;

use crate::session;

/// Which train.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Train {
    /// It reads codes and telegrams.
    New,
    /// It reads codes alone, and is told that the line is an analog one.
    Conventional,
}

/// A section of the ground.
#[derive(Clone, Copy, Debug)]
pub struct Section {
    /// Its number.
    pub number: u32,
    /// The speed of its analog code.
    pub code: Kmh,
    /// Its gradient, and that of the way to the stopping point.
    pub gradient_permille: i32,
    /// Its limit, as a rank, that only the sub telegram tells.
    pub limit_rank: u32,
    /// When its first main and sub frame end, in ms from the start.
    phase_ms: [u32; 2],
}

/// The length of every section.
pub const LENGTH_MM: i64 = 250_000;

/// Where a train must stop: the exit of the fifth section. The sixth is the overlap.
pub const STOP_MM: i64 = 5 * LENGTH_MM;

/// A logic cycle.
pub const CYCLE_MS: u32 = 250;

const FRAME_MS: u32 = 530;

const fn section(number: u32, code: i32, gradient_permille: i32, limit_rank: u32, phase_ms: [u32; 2]) -> Section {
    Section { number, code: Kmh(code), gradient_permille, limit_rank, phase_ms }
}

/// The sections, in the direction of travel.
pub const SECTIONS: [Section; 6] = [
    section(101, 750, 0, 7, [100, 380]),
    section(102, 750, 0, 7, [420, 130]),
    // A temporary restriction of 45 km/h that the code does not know.
    section(103, 650, 0, 3, [310, 60]),
    section(104, 550, -25, 7, [50, 330]),
    section(105, 250, -10, 7, [200, 30]),
    section(106, 0, 0, 7, [0, 0]),
];

/// One cycle of a drive.
#[derive(Clone, Debug)]
pub struct Moment {
    /// Where the train's front is at the end of the cycle, from the entry of the first section.
    pub at_mm: i64,
    /// Its speed there, in mm/s.
    pub speed_mm_s: i64,
    /// What was read.
    pub step: Step,
    /// What the kernel put out.
    pub output: Output,
}

/// The parameters of both trains.
pub fn config() -> Config {
    Config { cycle_ms: CYCLE_MS, ..Config::default() }
}

/// The number of frames of a transmitter that end at `ms` or before; those that end in a cycle have numbers of their own.
fn frames(phase_ms: u32, ms: u32) -> u32 {
    if ms < phase_ms { 0 } else { (ms - phase_ms) / FRAME_MS + 1 }
}

/// The counter of the frame that was completed in the cycle up to `ms`, if the train heard it from its beginning.
fn completed(phase_ms: u32, ms: u32, entered_ms: u32) -> Option<u32> {
    let number = frames(phase_ms, ms);
    let end = phase_ms + number.checked_sub(1)? * FRAME_MS;
    (ms < end + CYCLE_MS && end >= entered_ms + FRAME_MS).then_some(number % 256)
}

/// Drives until the train has stood for two seconds.
///
/// # Panics
/// If the kernel refuses a step, or the train never stands.
pub fn drive(train: Train) -> Vec<Moment> {
    let mut machine = Permitting::open(&config()).expect("the parameters are valid");
    let (mut at, mut speed, mut entered, mut stood) = (0_i64, 0_i64, [0_u32; 6], 0);
    let mut permitted = 0_i64;
    let mut moments: Vec<Moment> = Vec::new();
    for cycle in 1..2000_u32 {
        let ms = cycle * CYCLE_MS;
        let before = (at, speed);
        speed = drive_at(speed, permitted);
        at += (before.1 + speed) * i64::from(CYCLE_MS) / 2000;
        let place = usize::try_from(at / LENGTH_MM).expect("not behind the start").min(5);
        if place > 0 && entered[place] == 0 {
            entered[place] = ms;
        }
        let section = SECTIONS[place];
        let exit = (i64::try_from(place).expect("0 to 5") + 1) * LENGTH_MM;
        let digital = train == Train::New;
        let heard = |phase: u32| completed(phase, ms, entered[place]).filter(|_| digital && place < 5);
        let main = heard(section.phase_ms[0]).map(|counter| MainTelegram {
            section: section.number,
            counter,
            beyond_exit_m: u32::try_from((STOP_MM - exit) / 1000).ok().filter(|beyond| *beyond > 0),
            speed_rank: 7,
        });
        let sub = heard(section.phase_ms[1]).map(|counter| SubTelegram {
            section: section.number,
            counter,
            length_m: 250,
            gradient_permille: section.gradient_permille,
            curve_rank: 7,
            restriction_rank: section.limit_rank,
        });
        let line = if digital { LineKind::Digital } else { LineKind::Analog };
        let step = Step {
            line: (cycle == 1).then_some(line),
            analog_km_h: Some(section.code),
            main,
            sub,
            to_exit_m: (digital && place < 5).then_some(Metres(exit - at)),
            moved_m: Metres(at - before.0),
            speed_km_h: Some(Kmh(i32::try_from(speed * 36 / 1000).expect("a speed"))),
        };
        let output = machine.step(&step).expect("the kernel takes the step");
        permitted = output.speed_km_h.map_or(0, |permitted| i64::from(permitted.0) * 1000 / 36);
        moments.push(Moment { at_mm: at, speed_mm_s: speed, step, output });
        stood = if speed == 0 && at > 0 { stood + 1 } else { 0 };
        if stood == 8 {
            return moments;
        }
    }
    panic!("the train never stands");
}

/// The speed a cycle later: a driver who keeps a little under what is permitted; both brake and motor do 0.85 m/s².
fn drive_at(speed: i64, permitted: i64) -> i64 {
    let change = 850 * i64::from(CYCLE_MS) / 1000;
    // 2 km/h, and less when that is no speed any more.
    let aim = (permitted - 560).max(permitted / 3);
    if speed > aim { (speed - change).max(aim.min(speed)).max(0) } else { (speed + change).min(aim) }
}

/// A drive as request lines: the start, and the steps.
///
/// # Panics
/// Never: all of it is plain data.
pub fn case(train: Train) -> (String, String) {
    let steps = drive(train).into_iter().map(|moment| serde_json::to_string(&moment.step).expect("plain data"));
    session::case("permitted-speed", &json!({"cycle_ms": CYCLE_MS}), steps)
}

/// The same from the start to the stop.
pub fn lines(train: Train) -> String {
    session::whole(&case(train))
}
