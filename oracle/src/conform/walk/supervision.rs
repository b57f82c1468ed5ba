//! Walks of `speed-supervision`: a measured speed around the permitted one, the margin and the maximum.

use serde_json::{Value, json};

use super::source::{Source, Walk, tenths};
use crate::conform::random::Random;

pub(super) const SOURCE: Source =
    Source { machine: "speed-supervision", small, large, wrong, begin, most: (40, 200), own: 200 };

fn config(maximum: i64, margin: i64) -> Value {
    json!({"maximum_km_h": tenths(maximum), "release_margin_km_h": tenths(margin)})
}

fn small() -> Vec<Value> {
    vec![config(4000, 0), config(4000, 50), config(1000, 1), config(10, 10), config(1, 0)]
}

fn large() -> Vec<Value> {
    vec![json!({}), config(65_535, 65_535), config(2700, 20)]
}

fn wrong() -> Vec<Value> {
    vec![config(0, 0), config(1000, 1001), config(65_536, 0), config(-10, 0), config(1000, -1)]
}

struct Speeds {
    maximum: i64,
    margin: i64,
    permitted: i64,
}

fn begin(config: &Value, started: &Value, random: &mut Random) -> Box<dyn Walk> {
    // The started reply has every default.
    let of = |name: &str| {
        let value = started["config"].get(name).or_else(|| config.get(name));
        let tenths = value.and_then(Value::as_f64).unwrap_or(0.0) * 10.0;
        #[expect(clippy::cast_possible_truncation, reason = "a speed of a configuration is small")]
        let rounded = tenths.round() as i64;
        rounded
    };
    let (maximum, margin) = (of("maximum_km_h"), of("release_margin_km_h"));
    Box::new(Speeds { maximum, margin, permitted: random.between(0, maximum) })
}

impl Walk for Speeds {
    fn next(&mut self, random: &mut Random, _: Option<&Value>) -> Value {
        let Self { maximum, margin, .. } = *self;
        if random.one_in(6) {
            self.permitted = random.one_of(&[0, margin, maximum, maximum + 1, 450, maximum / 2]);
        }
        let permitted = self.permitted;
        let about = [permitted, permitted - margin, maximum, 0, permitted / 2][random.below(5)];
        let speed = match random.below(24) {
            0 => Value::Null,
            1 => tenths(-1),
            2 => tenths(2_000_000_000),
            3 => tenths(-2_000_000_000),
            _ => tenths(about + random.between(-1, 1)),
        };
        let permitted = match random.below(24) {
            0 => Value::Null,
            1 => tenths(-1),
            _ => tenths(permitted),
        };
        let mut step = json!({"speed_km_h": speed, "permitted_km_h": permitted});
        if random.one_in(6) {
            step["previous"] = ["release", "service", "emergency"][random.below(3)].into();
        }
        step
    }
}
