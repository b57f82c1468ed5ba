//! Walks of `wayside` on any station: the trains, points, requests and orders of a walk of `interlocking`; what detectors and checks of a
//! counted line say of these trains; neighbours; restarts; frames that are taken or not.

use std::collections::BTreeSet;

use serde_json::{Value, json};

use super::ground::{Ground, ground};
use super::neighbours::Neighbours;
use super::source::{Walk, cycles};
use crate::conform::random::Random;

/// A block of the counted line.
struct Block {
    /// The circuits of its sections, from the low end.
    circuits: Vec<usize>,
}

struct Device {
    station: Ground,
    blocks: Vec<Block>,
    /// The names of their circuits.
    counted: BTreeSet<String>,
    /// Whether the low end of the blocks is their entry.
    up: bool,
    /// The circuits that heads were in, and trains at all, in the cycle before.
    before: [BTreeSet<usize>; 2],
    neighbours: Neighbours,
    session: i64,
    /// Whether it begins anew now and then. On a layout nothing moves for hundreds of cycles after that.
    restarts: bool,
}

pub(super) fn begin(config: &Value, started: &Value, random: &mut Random) -> Box<dyn Walk> {
    let mut station = ground(&config["layout"], random);
    let list = config["counted"]["blocks"].as_array().into_iter().flatten();
    let named: Vec<Vec<&str>> = list
        .map(|block| block["circuits"].as_array().into_iter().flatten().filter_map(Value::as_str).collect())
        .collect();
    let number = |name: &&str| station.circuits().iter().position(|other| other == name);
    let blocks: Vec<_> =
        named.iter().map(|names| Block { circuits: names.iter().filter_map(number).collect() }).collect();
    let up = config["counted"]["direction"] != "down";
    // Trains are counted in at the line's entry, if they come from there.
    let mut inside: Vec<_> = blocks.iter().flat_map(|block| &block.circuits).copied().collect();
    if config["counted"]["travel"] == "toward" && !inside.is_empty() {
        inside.remove(if up { 0 } else { inside.len() - 1 });
    }
    station.close(inside);
    let (lines, pace) = (station.lines(), station.pace());
    Box::new(Device {
        blocks,
        counted: named.concat().into_iter().map(ToOwned::to_owned).collect(),
        up,
        before: Default::default(),
        neighbours: Neighbours::new(lines, cycles(started, "life"), pace, random),
        session: config["session"].as_i64().unwrap_or(0),
        restarts: random.one_in(4),
        station,
    })
}

impl Device {
    /// What each block hears of the trains.
    fn detections(&mut self, random: &mut Random) -> Vec<Value> {
        let [heads, taken] = self.station.whereabouts();
        let [heads_before, taken_before] = std::mem::replace(&mut self.before, [heads.clone(), taken.clone()]);
        let mut detections = Vec::new();
        for block in &self.blocks {
            let mut present: Vec<_> =
                (0..block.circuits.len()).filter(|at| heads.contains(&block.circuits[*at])).collect();
            if self.station.goes_wrong(random) {
                // Missed, or heard where nothing is.
                present = if present.is_empty() { vec![0] } else { Vec::new() };
            }
            let (low, high) = (block.circuits.first(), block.circuits.last());
            let (entry, exit) = if self.up { (low, high) } else { (high, low) };
            let check_in = entry.is_some_and(|at| heads.contains(at) && !heads_before.contains(at));
            let check_out = exit.is_some_and(|at| taken_before.contains(at) && !taken.contains(at));
            let (low, high) = if self.up { (check_in, check_out) } else { (check_out, check_in) };
            let [low, high] = [low, high].map(|check| check != self.station.goes_wrong(random));
            let reset = if random.one_in(14) {
                let heard = i64::try_from(present.len()).unwrap_or(0);
                random.one_of(&[heard, heard, heard, heard + 1, 0, 255]).into()
            } else {
                Value::Null
            };
            detections.push(json!({"low_check": low, "high_check": high, "present": present, "reset": reset}));
        }
        detections
    }
}

impl Walk for Device {
    fn next(&mut self, random: &mut Random, last: Option<&Value>) -> Value {
        self.neighbours.hear(last);
        let mut step = self.station.next(random, last);
        let detections = self.detections(random);
        if let Some(step) = step.as_object_mut() {
            step.remove("consent");
        }
        if let Some(occupied) = step["occupied"].as_array_mut() {
            // A counted circuit has no track circuit; what it reports is of no train.
            occupied.retain(|name| {
                let counted = name.as_str().is_some_and(|name| self.counted.contains(name));
                !counted || self.station.goes_wrong(random)
            });
        }
        step["blocks"] = detections.into();
        step["messages"] = self.neighbours.say(self.session, random);
        if random.one_in(4) {
            let some = |random: &mut Random| -> Vec<&str> {
                self.station.circuits().iter().map(String::as_str).filter(|_| random.one_in(2)).collect()
            };
            step["framed"] = json!({"main": some(random), "sub": some(random)});
        }
        if self.restarts && random.one_in(48 * self.station.pace()) {
            self.session = (self.session + 1) % 65536;
            self.station.restart(random);
            step["restart"] = self.session.into();
        }
        step
    }
}
