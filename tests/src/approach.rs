//! A train that approaches a transmitter, for the chart and the benchmarks of the train's position: the level difference grows with
//! the distance by 4.0 dB/km when the ballast is dry and by 9.0 dB/km when it is wet. All in integers: the same in every run.

use atc_protocol::machine::position::{Config, Step, TableConfig};
use atc_protocol::{Decibels, Metres};
use serde_json::json;

use crate::session;

/// A knot every 102.4 m.
const SPACING_MM: i64 = 102_400;

/// The least and the most by which the difference grows, in hundredths of a decibel for a kilometre.
const DRY: i64 = 400;
const WET: i64 = 900;

/// What it is on the day of the drive: the weather changes on the way.
fn weather(cycle: i64) -> i64 {
    (DRY + 8 * cycle).min(WET)
}

/// The table of that line; levels to 0.2 dB, noise under −45 dB.
pub fn config() -> Config {
    let knot = |place: i64| place * SPACING_MM;
    // Outwards, to whole hundredths.
    let lowest_db = (0..17).map(|place| Decibels(knot(place) * DRY / 1_000_000)).collect();
    let highest_db = (0..17).map(|place| Decibels((knot(place) * WET + 999_999) / 1_000_000)).collect();
    Config {
        table: TableConfig { spacing_m: Metres(SPACING_MM), lowest_db, highest_db },
        tolerance_db: Decibels(20),
        floor_db: Decibels(-4500),
        correction_db: [Decibels(0); 2],
    }
}

/// The drive from 1400 m on, a cycle a second: the levels with errors up to the tolerance, the odometer to 2 %, and an interruption.
pub fn steps() -> Vec<Step> {
    let mut random = 0x9E37_79B9_7F4A_7C15_u64;
    let mut error = || {
        random ^= random << 13;
        random ^= random >> 7;
        random ^= random << 17;
        i64::try_from(random % 41).unwrap_or(0) - 20
    };
    let (mut truth, mut steps) = (1_400_000_i64, Vec::new());
    for cycle in 0..100 {
        let moved = if cycle < 62 { 18_000 } else { (18_000 - 700 * (cycle - 62)).max(0) };
        truth -= moved;
        // The first signal loses 6 dB/km.
        let difference = truth * weather(cycle) / 1_000_000;
        let first = -3000 - truth * 6 / 10_000;
        let heard = !(25..32).contains(&cycle);
        // Each is off by 0.19 dB at most; what the difference lost by rounding is less than the hundredth that is left.
        let level = |level: i64, error: i64| heard.then_some(Decibels(level + error * 19 / 20));
        steps.push(Step {
            first_db: level(first, error()),
            second_db: level(first - difference, error()),
            moved_m: [Metres(moved - moved / 50), Metres(moved + moved / 50)],
            truth_m: Some(Metres(truth)),
        });
    }
    steps
}

/// The case, as request lines.
///
/// # Panics
/// Never: all of it is plain data.
pub fn lines() -> String {
    let steps = steps().into_iter().map(|step| serde_json::to_string(&step).expect("plain data"));
    session::whole(&session::case("train-position", &json!(config()), steps))
}
