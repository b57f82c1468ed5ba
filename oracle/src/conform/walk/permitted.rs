//! Walks of `permitted-speed`: two streams of telegrams with gaps at the limits of every life, counters at the limits of the window,
//! sections that follow each other, distances around the stopping point, and a line that is announced.

use serde_json::{Value, json};

use super::source::{Source, Walk, around, cycles, parts, tenths};
use crate::conform::random::Random;

pub(super) const SOURCE: Source =
    Source { machine: "permitted-speed", small, large, wrong, begin, most: (60, 2500), own: 2500 };

/// Freshness, life, life of a sub telegram and memory in cycles of 10 ms; window and run.
fn config([fresh, life, fixed, memory]: [u32; 4], window: u32, run: u32, more: &Value) -> Value {
    let mut config = json!({
        "cycle_ms": 10, "speeds_km_h": [0, 15, 25, 45], "lowest_limit_km_h": 15, "margin_m": 0,
        "fresh_ms": 10 * fresh, "life_ms": 10 * life, "fixed_life_ms": 10 * fixed, "memory_ms": 10 * memory,
        "window": window, "run": run,
    });
    for (name, value) in more.as_object().into_iter().flatten() {
        config[name] = value.clone();
    }
    config
}

fn small() -> Vec<Value> {
    let none = json!({});
    vec![
        config([2, 3, 4, 2], 1, 1, &none),
        config([3, 5, 6, 2], 3, 1, &none),
        config([4, 4, 4, 4], 2, 2, &none),
        config([2, 6, 3, 3], 127, 1, &json!({"margin_m": 10, "brake_mm_s2": 1300})),
        config([3, 8, 12, 3], 2, 3, &json!({"worst_gradient_permille": -128, "brake_mm_s2": 4095})),
        config([6, 6, 9, 1], 3, 1, &json!({"speeds_km_h": [45], "lowest_limit_km_h": 45, "brake_mm_s2": 1})),
        // Rounded down: as 2, 3, 4 and 2 cycles.
        config([2, 3, 4, 2], 2, 1, &json!({"fresh_ms": 29, "life_ms": 39, "fixed_life_ms": 49, "memory_ms": 29})),
    ]
}

fn large() -> Vec<Value> {
    vec![json!({}), json!({"cycle_ms": 100}), json!({"cycle_ms": 100, "run": 2, "window": 1, "margin_m": 25})]
}

fn wrong() -> Vec<Value> {
    [
        json!({"cycle_ms": 0}),
        json!({"lowest_limit_km_h": 30}),
        json!({"fresh_ms": 9}),
        json!({"fresh_ms": 5010}),
        json!({"fixed_life_ms": 9}),
        json!({"memory_ms": 9}),
        json!({"memory_ms": 5010}),
        json!({"window": 0}),
        json!({"window": 128}),
        json!({"run": 0}),
        json!({"run": 16}),
        json!({"brake_mm_s2": 0}),
        json!({"brake_mm_s2": 4096}),
        json!({"speeds_km_h": []}),
        json!({"speeds_km_h": [25, 25]}),
        json!({"cycle_ms": 1, "life_ms": 60_001}),
        json!({"cycle_ms": 1, "fixed_life_ms": 60_001}),
        json!({"fixed_life_ms": 1990}),
    ]
    .to_vec()
}

/// One of the two streams.
struct Stream {
    counter: i64,
    /// Cycles until its next telegram.
    left: i64,
}

struct Ride {
    speeds: Vec<Value>,
    gaps: Vec<i64>,
    window: i64,
    section: i64,
    behind: i64,
    main: Stream,
    sub: Stream,
    analog: Value,
    announced: bool,
    /// How often a telegram comes in another order or at another time than it should: once in so many.
    disorder: u64,
    /// The farthest that a route goes beyond the exit, in metres: near enough for the pattern to be what permits.
    far: i64,
}

fn begin(_: &Value, started: &Value, random: &mut Random) -> Box<dyn Walk> {
    let [fresh, life, fixed, memory] = ["fresh", "life", "fixed_life", "memory"].map(|name| cycles(started, name));
    let gaps = around(&[memory, memory, fresh, life, fixed, 1, 1, fresh / 2, memory / 2], 0);
    let config = &started["config"];
    Box::new(Ride {
        speeds: config["speeds_km_h"].as_array().cloned().unwrap_or_default(),
        gaps,
        window: config["window"].as_i64().unwrap_or(1),
        section: 7,
        behind: 6,
        main: Stream { counter: random.between(0, 255), left: 0 },
        sub: Stream { counter: random.between(0, 255), left: random.between(0, 2) },
        analog: Value::Null,
        announced: false,
        disorder: random.one_of(&[2, 6, 30]).unsigned_abs(),
        far: random.one_of(&[20, 60, 900]),
    })
}

impl Stream {
    /// Whether a telegram is there in this cycle, and its counter.
    fn next(&mut self, gaps: &[i64], window: i64, disorder: u64, random: &mut Random) -> Option<i64> {
        self.left -= 1;
        if self.left >= 0 {
            return None;
        }
        self.left = if random.one_in(disorder) { random.one_of(gaps) } else { random.between(0, 1) };
        let ahead = if random.one_in(disorder) { random.one_of(&[window, window + 1, 0, -1, 128]) } else { 1 };
        self.counter = (self.counter + ahead).rem_euclid(256);
        Some(self.counter)
    }
}

impl Walk for Ride {
    fn next(&mut self, random: &mut Random, last: Option<&Value>) -> Value {
        if random.one_in(15) {
            self.behind = self.section;
            self.section = if random.one_in(4) { 7 } else { self.section + 1 };
        }
        if random.one_in(16) {
            let fast = tenths(random.between(0, 1200));
            self.analog = match random.below(5) {
                0 | 1 => Value::Null,
                2 => fast,
                _ => random.pick(&self.speeds).cloned().unwrap_or_default(),
            };
        }
        let stopping = last.and_then(|last| last["state"]["to_stop_m"].as_f64());
        #[expect(clippy::cast_possible_truncation, reason = "what is remembered of a walk is below 2^53 mm")]
        let stopping = stopping.map_or(0, |metres| (metres * 1000.0).round() as i64);
        let moved = match random.below(12) {
            0 => (stopping + random.between(-1, 1)).clamp(0, 4_294_967_295),
            1 => random.between(0, 60_000),
            2..=5 => 0,
            _ => random.between(0, 1500),
        };
        let mut step = json!({"analog_km_h": self.analog, "moved_m": parts(moved, 1000)});
        if !self.announced && random.one_in(3) || random.one_in(25) {
            self.announced = true;
            step["line"] = if random.one_in(2) { "analog".into() } else { "digital".into() };
        }
        let known = i64::try_from(self.speeds.len()).unwrap_or(1);
        let rank = |random: &mut Random| match random.below(16) {
            0 => known.min(15),
            1 => 15,
            _ => random.between(0, known - 1),
        };
        if let Some(counter) = self.main.next(&self.gaps, self.window, self.disorder, random) {
            let section = if random.one_in(20) { self.behind } else { self.section };
            let far = random.between(0, self.far);
            let beyond = match random.below(6) {
                0 => Value::Null,
                1 => 0.into(),
                2 => 65_535.into(),
                _ => far.into(),
            };
            step["main"] =
                json!({"section": section, "counter": counter, "beyond_exit_m": beyond, "speed_rank": rank(random)});
        }
        if let Some(counter) = self.sub.next(&self.gaps, self.window, self.disorder, random) {
            let section = if random.one_in(10) { self.behind } else { self.section };
            let (curve, restriction) = (rank(random), rank(random));
            step["sub"] = json!({
                "section": section, "counter": counter, "length_m": random.one_of(&[1, 250, 65_535]),
                "gradient_permille": random.one_of(&[-128, -35, -12, 0, 12, 127]),
                "curve_rank": curve, "restriction_rank": restriction,
            });
        }
        if random.one_in(5) {
            let anywhere = random.between(0, 700 * self.far);
            step["to_exit_m"] = parts(random.one_of(&[0, 1, anywhere, 4_294_967_295]), 1000);
        }
        step
    }
}
