//! Walks of `train-position`: a train that nears a transmitter, with levels at the edges of what the table and the tolerance allow.

use serde_json::{Value, json};

use super::source::{Source, Walk, parts};
use crate::conform::random::Random;

pub(super) const SOURCE: Source =
    Source { machine: "train-position", small, large, wrong, begin, most: (30, 120), own: 120 };

/// Spacing in decimetres, the curves, tolerance, floor and correction in hundredths of a decibel.
fn config(spacing: i64, lowest: &[i64], highest: &[i64], tolerance: i64, floor: i64, correction: [i64; 2]) -> Value {
    let curve = |levels: &[i64]| levels.iter().map(|level| parts(*level, 100)).collect::<Vec<_>>();
    json!({
        "table": {"spacing_m": parts(spacing, 10), "lowest_db": curve(lowest), "highest_db": curve(highest)},
        "tolerance_db": parts(tolerance, 100), "floor_db": parts(floor, 100),
        "correction_db": correction.map(|level| parts(level, 100)),
    })
}

fn line(slope: i64, from: i64) -> Vec<i64> {
    (0..17).map(|knot| from + knot * slope).collect()
}

fn small() -> Vec<Value> {
    let (low, high) = (line(50, 0), line(100, 0));
    // A fall in the middle of one curve; a flat end; the same curve twice.
    let mut falls = high.clone();
    falls[8] = falls[7] - 30;
    let low_falls: Vec<i64> = low.iter().map(|level| level - 100).collect();
    let mut flat = low.clone();
    flat[16] = flat[15];
    vec![
        config(256, &low, &high, 10, -6000, [0, 0]),
        config(16, &low, &high, 0, -6000, [0, 0]),
        config(2048, &line(7, -33), &line(13, -20), 1, -4000, [0, 0]),
        config(512, &low, &high, 25, -6000, [-120, 80]),
        config(256, &low_falls, &falls, 10, -6000, [0, 0]),
        config(128, &flat, &high, 10, -6000, [0, 0]),
        config(1024, &high, &high, 0, -6000, [30, 30]),
    ]
}

fn large() -> Vec<Value> {
    vec![config(256, &line(40, 5), &line(90, 10), 30, -7000, [0, 0])]
}

fn wrong() -> Vec<Value> {
    let (low, high) = (line(50, 0), line(100, 0));
    let mut crossed = low.clone();
    crossed[4] = high[4] + 1;
    let mut crossed_last = low.clone();
    crossed_last[16] = high[16] + 1;
    vec![
        config(255, &low, &high, 10, -6000, [0, 0]),
        config(8, &low, &high, 10, -6000, [0, 0]),
        config(4096, &line(7, -33), &line(13, -20), 1, -4000, [0, 0]),
        config(256, &crossed, &high, 10, -6000, [0, 0]),
        config(256, &line(0, 0), &high, 10, -6000, [0, 0]),
        config(256, &line(3, -900), &line(0, 0), 10, -6000, [0, 0]),
        config(256, &crossed_last, &high, 10, -6000, [0, 0]),
        config(256, &low[..16], &high, 10, -6000, [0, 0]),
        config(256, &low, &high, -1, -6000, [0, 0]),
        config(256, &low, &high, 10, -6000, [1, 0]),
        config(256, &low, &high, 10, -32_769, [0, 0]),
    ]
}

struct Approach {
    /// The distance between knots in mm.
    spacing: i64,
    lowest: Vec<i64>,
    highest: Vec<i64>,
    tolerance: i64,
    floor: i64,
    correction: [i64; 2],
    /// The true distance in mm.
    truth: i64,
}

#[expect(clippy::cast_possible_truncation, reason = "the numbers of a configuration are small")]
fn number(value: &Value, of_one: f64) -> i64 {
    (value.as_f64().unwrap_or(0.0) * of_one).round() as i64
}

fn begin(config: &Value, _: &Value, random: &mut Random) -> Box<dyn Walk> {
    let curve = |name: &str| -> Vec<i64> {
        config["table"][name].as_array().into_iter().flatten().map(|level| number(level, 100.0)).collect()
    };
    let spacing = number(&config["table"]["spacing_m"], 1000.0).max(1);
    Box::new(Approach {
        spacing,
        lowest: curve("lowest_db"),
        highest: curve("highest_db"),
        tolerance: number(&config["tolerance_db"], 100.0),
        floor: number(&config["floor_db"], 100.0),
        correction: [number(&config["correction_db"][0], 100.0), number(&config["correction_db"][1], 100.0)],
        truth: random.between(0, 16 * spacing),
    })
}

impl Approach {
    /// A curve at the true distance.
    fn at(&self, curve: &[i64]) -> i64 {
        let knot = usize::try_from(self.truth / self.spacing).unwrap_or(0).min(15);
        let (Some(from), Some(to)) = (curve.get(knot), curve.get(knot + 1)) else { return 0 };
        from + (to - from) * (self.truth % self.spacing) / self.spacing
    }
}

impl Walk for Approach {
    fn next(&mut self, random: &mut Random, last: Option<&Value>) -> Value {
        let nearest = last.and_then(|last| last["interval_m"].get(0).map(|near| number(near, 1000.0)));
        let mut advance = random.one_of(&[0, 1, 1500, 1500, 20_000, -1500]);
        if random.one_in(12) {
            // On to another place, as after a transmitter.
            self.truth = random.between(0, 16 * self.spacing);
        }
        if let (Some(near), true) = (nearest, random.one_in(8)) {
            // As far as the nearest end of the interval, a millimetre less or more: the transmitter may have been reached.
            advance = near + random.between(-1, 1);
        }
        let advance = advance.clamp(-32_768, 32_767);
        self.truth = (self.truth - advance).clamp(0, 16 * self.spacing);
        let slack = random.one_of(&[0, 0, 1, 100]);
        let moved = [(advance - slack).max(-32_768), (advance + slack).min(32_767)];
        let (low, high) = (self.at(&self.lowest), self.at(&self.highest));
        let edge = random.between(-1, 1) + random.one_of(&[0, 2 * self.tolerance, -2 * self.tolerance]);
        let anywhere = random.between(-2000, 4000);
        let difference = match random.below(16) {
            0 => anywhere,
            // The ends of the table.
            1 => random.pick(&self.highest).copied().unwrap_or(0) + edge,
            2 => random.pick(&self.lowest).copied().unwrap_or(0) + edge,
            3..=5 => low + edge,
            6..=8 => high + edge,
            _ => random.between(low, high),
        } - random.one_of(&self.correction);
        let first = match random.below(10) {
            0 => self.floor + random.between(-1, 1),
            1 => self.floor + difference + random.between(-1, 1),
            _ => -2000 + random.between(-500, 500),
        };
        let heard = |level: i64, random: &mut Random| {
            if random.one_in(25) { Value::Null } else { parts(level.clamp(-32_768, 32_767), 100) }
        };
        json!({
            "first_db": heard(first, random),
            "second_db": heard(first - difference, random),
            "moved_m": moved.map(|millimetres| parts(millimetres, 1000)),
        })
    }
}
