//! Questions to `braking-pattern`: distances and gradients at their limits and anywhere between.

use serde_json::{Value, json};

use super::source::{Source, Walk};
use crate::conform::random::Random;

pub(super) const SOURCE: Source =
    Source { machine: "braking-pattern", small, large, wrong, begin, most: (40, 100), own: 100 };

fn small() -> Vec<Value> {
    [1, 2, 37, 338, 339, 800, 1300, 4094, 4095].map(|brake| json!({"brake_mm_s2": brake})).to_vec()
}

fn large() -> Vec<Value> {
    vec![json!({})]
}

fn wrong() -> Vec<Value> {
    vec![json!({"brake_mm_s2": 0}), json!({"brake_mm_s2": 4096})]
}

struct Questions;

fn begin(_: &Value, _: &Value, _: &mut Random) -> Box<dyn Walk> {
    Box::new(Questions)
}

impl Walk for Questions {
    fn next(&mut self, random: &mut Random, _: Option<&Value>) -> Value {
        let short = random.between(0, 40);
        let distance =
            [0, 1, 2, 65_534, 65_535, short, random.between(0, 2000), random.between(0, 65_535)][random.below(8)];
        let gradient = [0, -1, 1, -35, 35, -128, 127, random.between(-128, 127)][random.below(8)];
        if random.one_in(8) {
            return json!({"distance_m": distance});
        }
        json!({"distance_m": distance, "gradient_permille": gradient})
    }
}
