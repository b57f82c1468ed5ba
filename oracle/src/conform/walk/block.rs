//! Walks of `block-count`: trains through the block, with detections that are missed or come from nothing, checks that are lost, come
//! twice or stay on, resets with right and wrong numbers, and a block ahead that takes its time.

use serde_json::{Value, json};

use super::source::{Source, Walk, around, cycles};
use crate::conform::random::Random;

pub(super) const SOURCE: Source =
    Source { machine: "block-count", small, large, wrong, begin, most: (80, 1200), own: 1200 };

fn config(sections: u32, most: u32, hold: u32, cycle: u32, pass: u32) -> Value {
    json!({"sections": sections, "max_trains": most, "tail_hold_sections": hold, "cycle_ms": cycle, "pass_ms": pass})
}

fn small() -> Vec<Value> {
    vec![
        config(1, 1, 0, 10, 20),
        config(2, 1, 1, 10, 10),
        config(2, 2, 2, 10, 30),
        config(3, 2, 1, 10, 29),
        config(3, 3, 0, 10, 20),
        config(3, 3, 4, 10, 20),
        config(16, 16, 16, 10, 20),
    ]
}

fn large() -> Vec<Value> {
    vec![
        json!({"sections": 3, "max_trains": 3, "tail_hold_sections": 1}),
        config(16, 4, 2, 100, 10_000),
        config(8, 8, 3, 250, 10_000),
    ]
}

fn wrong() -> Vec<Value> {
    vec![
        config(0, 1, 0, 10, 10_000),
        config(17, 1, 0, 10, 10_000),
        config(3, 0, 0, 10, 10_000),
        config(3, 4, 0, 10, 10_000),
        config(3, 3, 17, 10, 10_000),
        config(3, 3, 0, 0, 10_000),
        config(3, 3, 0, 10, 9),
        config(3, 3, 0, 1, 60_001),
    ]
}

/// A check that is on for so many cycles more.
#[derive(Default)]
struct Check {
    left: i64,
}

impl Check {
    fn is_on(&mut self) -> bool {
        let on = self.left > 0;
        self.left -= 1;
        on
    }
}

struct Trains {
    sections: i64,
    most: i64,
    stay: i64,
    /// The section of each head and the cycles until it moves on; the one that is farthest first.
    heads: Vec<(i64, i64)>,
    check_in: Check,
    check_out: Check,
    passes: Vec<i64>,
    /// Cycles until the block ahead has the train that has checked out.
    entering: Vec<i64>,
    /// How often something goes wrong: once in so many times; 0 for never.
    wrong: u64,
    /// The longest that the block ahead asks to hold.
    hold: i64,
}

fn begin(config: &Value, started: &Value, random: &mut Random) -> Box<dyn Walk> {
    let of = |name: &str| config[name].as_i64().unwrap_or(1);
    let pass = cycles(started, "pass");
    Box::new(Trains {
        sections: of("sections"),
        most: of("max_trains"),
        stay: random.one_of(&[1, 2, 3, 6]),
        heads: Vec::new(),
        check_in: Check::default(),
        check_out: Check::default(),
        passes: around(&[pass, 1, 1, 2], 1),
        entering: Vec::new(),
        wrong: random.one_of(&[0, 30, 10, 4]).unsigned_abs(),
        hold: random.one_of(&[0, 0, 1, 4, 16]),
    })
}

impl Trains {
    fn goes_wrong(&self, random: &mut Random) -> bool {
        self.wrong > 0 && random.one_in(self.wrong)
    }

    /// Moves the trains on and sets the checks.
    fn move_on(&mut self, random: &mut Random) {
        for place in 0..self.heads.len() {
            let free = place == 0 || self.heads[place - 1].0 > self.heads[place].0 + 1;
            let head = &mut self.heads[place];
            head.1 -= 1;
            if head.1 < 0 && (free || random.one_in(8)) {
                *head = (head.0 + 1, random.between(0, self.stay));
            }
        }
        if self.heads.first().is_some_and(|head| head.0 >= self.sections) {
            self.heads.remove(0);
            if !self.goes_wrong(random) {
                self.check_out.left = random.between(1, 3);
            }
            self.entering.push(random.one_of(&[0, 0, 1, 2, 5]));
        }
        let room = i64::try_from(self.heads.len()).unwrap_or(i64::MAX) < self.most || self.goes_wrong(random);
        let entry_free = self.heads.last().is_none_or(|head| head.0 > 0);
        if self.check_in.left < 0 && room && entry_free && random.one_in(4) {
            self.heads.push((0, random.between(0, self.stay)));
            if !self.goes_wrong(random) {
                self.check_in.left = random.one_of(&self.passes);
            }
        }
        // Out of nothing.
        if self.goes_wrong(random) {
            self.check_in.left = self.check_in.left.max(random.between(0, 2));
        }
        if self.goes_wrong(random) {
            self.check_out.left = self.check_out.left.max(random.between(0, 2));
        }
    }

    fn present(&self, random: &mut Random) -> Vec<i64> {
        let mut present: Vec<i64> = Vec::new();
        for head in &self.heads {
            if !present.contains(&head.0) && head.0 < self.sections && !self.goes_wrong(random) {
                present.push(head.0);
            }
        }
        if self.goes_wrong(random) {
            let phantom = random.between(0, self.sections - 1);
            if !present.contains(&phantom) {
                present.push(phantom);
            }
        }
        present.sort_unstable();
        present
    }
}

impl Walk for Trains {
    fn next(&mut self, random: &mut Random, last: Option<&Value>) -> Value {
        self.move_on(random);
        let present = self.present(random);
        let counting = last.is_some_and(|last| last["counting"] == true);
        let heard = i64::try_from(present.len()).unwrap_or(0);
        let reset = if random.one_in(if counting { 40 } else { 3 }) {
            let trains = i64::try_from(self.heads.len()).unwrap_or(0);
            random.one_of(&[heard, heard, heard, heard, trains, heard + 1, 0, self.most + 1, 255]).into()
        } else {
            Value::Null
        };
        self.entering.iter_mut().for_each(|left| *left -= 1);
        let mut entered = false;
        if self.entering.first().is_some_and(|left| *left < 0) {
            self.entering.remove(0);
            entered = true;
        }
        let mut step = json!({
            "check_in": self.check_in.is_on(),
            "check_out": self.check_out.is_on(),
            "present": present,
            "reset": reset,
            "ahead_entered": entered || self.wrong == 0 || self.goes_wrong(random),
        });
        if self.hold > 0 {
            step["ahead_hold_sections"] = random.between(0, self.hold).into();
        }
        step
    }
}
