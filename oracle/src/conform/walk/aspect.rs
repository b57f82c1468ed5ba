//! Walks of `aspect-acceptance`: each aspect comes and goes for times at the limits of T1 to T5, with glitches of one cycle.

use serde_json::{Value, json};

use super::source::{Source, Walk, around, cycles};
use crate::conform::random::Random;

pub(super) const SOURCE: Source =
    Source { machine: "aspect-acceptance", small, large, wrong, begin, most: (60, 1500), own: 1500 };

/// T1 to T5 in ms.
fn config(cycle: u32, aspects: &[u32], [operate, recovery, mask, interruption, shortened]: [u32; 5]) -> Value {
    json!({
        "cycle_ms": cycle, "aspects_km_h": aspects, "operate_ms": operate, "recovery_ms": recovery, "mask_ms": mask,
        "interruption_ms": interruption, "shortened_operate_ms": shortened,
    })
}

fn small() -> Vec<Value> {
    vec![
        config(10, &[25, 45], [20, 10, 10, 20, 10]),
        config(10, &[25, 45], [20, 20, 20, 30, 10]),
        config(10, &[0, 25, 90], [30, 20, 30, 30, 10]),
        config(10, &[25, 45, 65], [30, 20, 20, 50, 20]),
        config(10, &[45], [30, 30, 20, 20, 20]),
        // No mask; no shortened operate but of an interruption of no length.
        config(10, &[25, 45], [20, 30, 0, 20, 10]),
        config(10, &[25, 45], [30, 20, 20, 0, 10]),
        // A limit beyond expiry acts as one cycle before it.
        config(10, &[25, 45], [20, 20, 10, 90, 10]),
        // Nothing here is a whole number of cycles: T1 and T5 round up, T2, T3 and T4 down.
        config(7, &[25, 45, 90], [15, 15, 22, 27, 8]),
        config(100, &[15, 25, 45, 55], [300, 400, 400, 800, 100]),
        // Every rank that there is.
        config(10, &RANKS, [20, 20, 20, 30, 10]),
        // The longest times.
        config(1, &[25, 45], [60_000, 30_000, 30_000, 60_000, 1]),
    ]
}

const RANKS: [u32; 16] = [0, 15, 25, 35, 45, 55, 65, 75, 90, 100, 110, 120, 130, 160, 200, 250];

fn large() -> Vec<Value> {
    let urban = RANKS;
    vec![
        json!({"aspects_km_h": [25, 45, 65, 90]}),
        config(10, &urban, [300, 400, 400, 800, 100]),
        config(33, &urban[..8], [300, 400, 400, 1000, 100]),
    ]
}

fn wrong() -> Vec<Value> {
    vec![
        config(0, &[25], [300, 400, 400, 800, 100]),
        config(10, &[25], [0, 400, 400, 800, 100]),
        config(10, &[25], [300, 9, 400, 800, 100]),
        config(10, &[25], [300, 400, 400, 800, 0]),
        // Both are 10 cycles after rounding.
        config(10, &[25], [100, 400, 400, 800, 91]),
        config(1, &[25], [60_001, 400, 400, 800, 100]),
        config(1, &[25], [300, 30_000, 30_001, 800, 100]),
        config(1, &[25], [300, 400, 400, 60_001, 100]),
        config(10, &[], [300, 400, 400, 800, 100]),
        config(10, &[25, 25], [300, 400, 400, 800, 100]),
        config(10, &[0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16], [300, 400, 400, 800, 100]),
    ]
}

struct Lane {
    speed: Value,
    on: bool,
    left: i64,
}

struct Aspects {
    lanes: Vec<Lane>,
    heard: Vec<i64>,
    silent: Vec<i64>,
    /// One aspect at a time, as when the code of a section changes.
    alone: bool,
    glitch: u64,
}

fn begin(config: &Value, started: &Value, random: &mut Random) -> Box<dyn Walk> {
    let [operate, recovery, expiry, interruption, shortened] =
        ["operate", "recovery", "recovery_and_mask", "interruption", "shortened_operate"]
            .map(|name| cycles(started, name));
    let heard = around(&[operate, shortened, operate + shortened, recovery, 1], 1);
    let silent =
        around(&[recovery, expiry, interruption, expiry - shortened, expiry - operate, expiry + shortened, 1], 1);
    let mut speeds = config["aspects_km_h"].as_array().cloned().unwrap_or_default();
    let used = 1 + random.below(speeds.len().min(4));
    while speeds.len() > used {
        speeds.remove(random.below(speeds.len()));
    }
    let lanes = speeds.into_iter().map(|speed| Lane { speed, on: random.one_in(2), left: random.one_of(&heard) });
    let lanes = lanes.collect();
    let alone = random.one_in(4);
    Box::new(Aspects { lanes, heard, silent, alone, glitch: random.one_of(&[0, 12, 40]).unsigned_abs() })
}

impl Walk for Aspects {
    fn next(&mut self, random: &mut Random, _: Option<&Value>) -> Value {
        for lane in &mut self.lanes {
            if lane.left <= 0 {
                lane.on = !lane.on;
                lane.left = random.one_of(if lane.on { &self.heard } else { &self.silent });
            }
            lane.left -= 1;
        }
        let glitch = self.glitch > 0 && random.one_in(self.glitch);
        let flipped = glitch.then(|| random.below(self.lanes.len()));
        let heard = self.lanes.iter().enumerate().filter(|(place, lane)| lane.on != (flipped == Some(*place)));
        let heard: Vec<_> = heard.map(|(_, lane)| lane.speed.clone()).collect();
        let kept = if self.alone { heard.len().min(1) } else { heard.len() };
        json!({"detected_km_h": &heard[..kept]})
    }
}
