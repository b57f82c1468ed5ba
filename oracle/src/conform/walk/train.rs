//! Walks of `train`: the telegrams of `permitted-speed` in their carriers, code frequencies at the ends of their bands for times at the limits
//! of acceptance, levels, an odometer that is wide or silent, a measured speed around what was permitted last, and telegrams of
//! both directions of travel for a train that faces one of them, changes ends, or does not know.

use serde_json::{Value, json};

use super::permitted;
use super::source::{Source, Walk, around, cycles, parts, tenths};
use crate::conform::random::Random;

pub(super) const SOURCE: Source = Source { machine: "train", small, large, wrong, begin, most: (60, 400), own: 400 };

/// Pairs of codes in mHz, with the speed that they name in km/h.
const PAIRS: [(i64, i64, i64); 3] = [(10_000, 12_000, 15), (15_000, 16_500, 25), (22_000, 21_000, 45)];

/// The code table, with this tolerance in mHz.
fn codes(pairs: &[(i64, i64, i64)], tolerance: i64) -> Value {
    let pair = |(main, sub, speed): &(i64, i64, i64)| json!({"main_hz": parts(*main, 1000), "sub_hz": parts(*sub, 1000), "speed_km_h": speed});
    json!({"tolerance_hz": parts(tolerance, 1000), "pairs": pairs.iter().map(pair).collect::<Vec<_>>()})
}

/// T1 to T5 in cycles of 10 ms.
fn acceptance([operate, recovery, mask, interruption, shortened]: [i64; 5]) -> Value {
    json!({
        "operate_ms": 10 * operate, "recovery_ms": 10 * recovery, "mask_ms": 10 * mask,
        "interruption_ms": 10 * interruption, "shortened_operate_ms": 10 * shortened,
    })
}

fn config(permitted: &Value, times: [i64; 5], codes: &Value) -> Value {
    json!({"permitted": permitted, "acceptance": acceptance(times), "codes": codes, "supervision": {"release_margin_km_h": 0.5}})
}

/// The position of a section of 204.8 m, whose two curves rise by 1 dB and 2 dB a knot.
fn position() -> Value {
    let curve = |slope: i64| (0..17).map(|knot| parts(knot * slope, 100)).collect::<Vec<_>>();
    json!({
        "table": {"spacing_m": 12.8, "lowest_db": curve(100), "highest_db": curve(200)},
        "tolerance_db": 0.1, "floor_db": -60,
    })
}

fn small() -> Vec<Value> {
    let permitted = (permitted::SOURCE.small)();
    let table = codes(&PAIRS, 700);
    // A pair beside the diagonal; a code of which only one carrier has two.
    let mixed = codes(&[(10_000, 12_000, 15), (15_000, 12_000, 25), (22_000, 21_000, 45)], 700);
    let mut all = vec![
        config(&permitted[0], [2, 2, 2, 3, 1], &table),
        config(&permitted[1], [3, 2, 2, 5, 2], &table),
        config(&permitted[2], [2, 1, 1, 2, 1], &mixed),
        config(&permitted[3], [3, 2, 3, 3, 1], &table),
    ];
    let mut measured = all[0].clone();
    measured["position"] = position();
    let mut two = measured.clone();
    all.push(measured);
    two["channels"] = 2.into();
    all.push(two);
    let mut two = all[0].clone();
    two["channels"] = 2.into();
    all.push(two);
    all
}

fn large() -> Vec<Value> {
    vec![json!({}), json!({"permitted": {"cycle_ms": 100}, "position": position()})]
}

fn wrong() -> Vec<Value> {
    let change = |name: &str, value: Value| {
        let mut config = small().swap_remove(0);
        config[name] = value;
        config
    };
    let table = |pairs: &[(i64, i64, i64)], tolerance: i64| change("codes", codes(pairs, tolerance));
    let of_main = |main: i64| vec![(main, 12_000, 15)];
    let nine: Vec<_> = (1..10).map(|number| (10_000 * number, 10_000 * number, 15)).collect();
    vec![
        // Bands that meet: 10 and 15 Hz, then 12 and 16.5.
        table(&PAIRS, 2500),
        table(&[(10_000, 12_000, 15), (20_000, 16_500, 25)], 2250),
        table(&PAIRS, 3000),
        // A band from 0, and one beyond the highest number.
        table(&of_main(10_000), 10_000),
        table(&[(20_000, 12_000, 15)], 12_000),
        table(&of_main(4_294_967_290), 100),
        table(&[], 700),
        table(&nine, 700),
        table(&[PAIRS[0], PAIRS[0]], 700),
        // A speed that the line has not, on the diagonal and beside it.
        table(&[(10_000, 12_000, 17)], 700),
        table(&[(10_000, 12_000, 15), (10_000, 16_500, 17), (15_000, 16_500, 25)], 700),
        // A highest speed that the train would be stopped at.
        change("supervision", json!({"maximum_km_h": 44.9})),
        change("acceptance", acceptance([2, 2, 2, 3, 2])),
        change("acceptance", acceptance([0, 2, 2, 3, 1])),
        change("permitted", json!({"cycle_ms": 0})),
        change("position", json!({"table": position()["table"], "tolerance_db": -0.1, "floor_db": -60})),
    ]
}

/// A carrier: what its code is, and for how long.
struct Code {
    nominal: Vec<i64>,
    now: Value,
    left: i64,
}

struct Ride {
    telegrams: Box<dyn Walk>,
    carriers: [Code; 2],
    tolerance: i64,
    /// For how many cycles a code stays.
    stays: Vec<i64>,
    /// The difference of the levels, in hundredths of a decibel.
    difference: i64,
    measures: bool,
    /// Whether it has two channels.
    two: bool,
    /// How the train faces: left, right, or it is not known.
    facing: &'static str,
}

fn begin(config: &Value, started: &Value, random: &mut Random) -> Box<dyn Walk> {
    let known = &started["config"];
    let millihertz = |value: &Value| {
        #[expect(clippy::cast_possible_truncation, reason = "a code frequency is below 2^32 mHz")]
        let rounded = (value.as_f64().unwrap_or(0.0) * 1000.0).round() as i64;
        rounded
    };
    let pairs = known["codes"]["pairs"].as_array().cloned().unwrap_or_default();
    let code = |name: &str| Code {
        nominal: pairs.iter().map(|pair| millihertz(&pair[name])).collect(),
        now: Value::Null,
        left: 0,
    };
    let [operate, expiry, recovery, shortened, interruption] =
        ["operate", "expiry", "recovery", "shortened_operate", "interruption"].map(|name| cycles(started, name));
    let telegrams = json!({"cycles": started["cycles"], "config": known["permitted"]});
    Box::new(Ride {
        telegrams: (permitted::SOURCE.begin)(config, &telegrams, random),
        carriers: [code("main_hz"), code("sub_hz")],
        tolerance: millihertz(&known["codes"]["tolerance_hz"]),
        stays: around(&[operate, expiry, recovery, shortened, interruption, 1], 1),
        difference: random.between(0, 2400),
        measures: config.get("position").is_some(),
        two: config["channels"] == 2,
        facing: "left",
    })
}

impl Ride {
    /// The code frequencies of a cycle. Mostly both are of one pair.
    fn codes(&mut self, random: &mut Random) -> [Value; 2] {
        let place = random.below(self.carriers[0].nominal.len());
        let together = random.one_in(2);
        for number in 0..2 {
            let carrier = &mut self.carriers[number];
            carrier.left -= 1;
            if carrier.left >= 0 {
                continue;
            }
            carrier.left = random.one_of(&self.stays);
            let place = if random.one_in(8) { random.below(carrier.nominal.len()) } else { place };
            let nominal = carrier.nominal.get(place).copied().unwrap_or(0);
            let off = random.one_of(&[0, 0, self.tolerance, -self.tolerance, self.tolerance + 1, -self.tolerance - 1]);
            carrier.now = if random.one_in(5) { Value::Null } else { parts((nominal + off).max(0), 1000) };
            if together {
                // The other carrier changes with it.
                self.carriers[1 - number].left = 0;
            }
        }
        [self.carriers[0].now.clone(), self.carriers[1].now.clone()]
    }
}

/// The number of a section for trains to the left, or to the right.
fn numbered(section: &Value, left: bool) -> Value {
    section.as_i64().map_or(Value::Null, |section| (section % 32_768 * 2 + i64::from(left)).into())
}

impl Walk for Ride {
    fn next(&mut self, random: &mut Random, last: Option<&Value>) -> Value {
        let heard = self.telegrams.next(random, None);
        let [main, sub] = self.codes(random);
        let mut step = json!({"main": {"code_hz": main}, "sub": {"code_hz": sub}});
        if random.one_in(40) {
            self.facing = ["left", "right", "unknown"][random.below(3)];
        }
        if self.facing != "unknown" {
            step["facing"] = self.facing.into();
        }
        for (kind, other) in [("main", "sub"), ("sub", "main")] {
            if let Some(mut telegram) = heard.get(kind).cloned() {
                let ahead = (self.facing != "right") != random.one_in(15);
                telegram["section"] = numbered(&telegram["section"], ahead);
                // On the other carrier it is no telegram.
                let carrier = if random.one_in(15) { other } else { kind };
                step[carrier]["telegram"] = json!({kind: telegram});
            }
        }
        if let Some(line) = heard.get("line") {
            step["line"] = line.clone();
        }
        let by = random.one_of(&[0, 0, 140, 150, 1500, -150]);
        if !random.one_in(10) {
            let wide = random.one_of(&[0, 0, 10, 300]);
            step["moved_m"] = json!([parts(by - wide, 1000), parts(by + wide, 1000)]);
        }
        if self.measures && !random.one_in(6) {
            self.difference = (self.difference - by / 10 + random.between(-12, 12)).clamp(-50, 3300);
            step["first_db"] = parts(self.difference, 100);
            step["second_db"] = if random.one_in(12) { parts(-6001, 100) } else { 0.into() };
        }
        if self.two && random.one_in(12) {
            step["lost"] = [json!(["a"]), json!(["b"]), json!(["a", "b"]), json!(["b", "a"])][random.below(4)].clone();
        }
        let permitted = last.and_then(|last| last["permitted_km_h"].as_f64()).unwrap_or(0.0) * 10.0;
        #[expect(clippy::cast_possible_truncation, reason = "a permitted speed is small")]
        let permitted = permitted.round() as i64;
        if !random.one_in(20) {
            let speed = permitted + random.one_of(&[0, -1, 1, -5, -6, -100]);
            step["speed_km_h"] = tenths(speed.max(0));
        }
        step
    }
}
