//! Walks of `wayside` on its own halts: a train from one end of the line through the station to the other, with detections that are late or
//! missed and false occupancy; messages that echo a stamp about as old as the life, or of another start; requests of every kind; restarts;
//! frames that are taken or not. On another station: [`device`].

use serde_json::{Value, json};

use super::device;
use super::halts::{large, small, wrong};
use super::neighbours::Neighbours;
use super::source::{Source, Walk, cycles};
use crate::conform::random::Random;

pub(super) const SOURCE: Source = Source { machine: "wayside", small, large, wrong, begin, most: (70, 200), own: 4000 };

/// The circuits of the station and of the line behind it, in the direction of travel.
const STATION: [&str; 4] = ["A", "B", "E1", "E2"];

/// Its lines.
const LINES: [&str; 2] = ["West", "East"];

/// Whether a configuration is of one of these halts, by what its walks name.
fn is_halt(config: &Value) -> bool {
    let plan = &config["layout"]["plan"];
    let names = |list: &str| plan[list].as_array().into_iter().flatten().filter_map(|one| one["name"].as_str());
    names("segments").eq(LINES)
        && names("points").eq(["P"])
        && names("routes").next() == Some("in-out")
        && names("routes").skip(1).all(|name| name == "other")
        && STATION.iter().all(|name| names("circuits").any(|other| other == *name))
}

/// A block of the counted line.
struct Block {
    /// The places of its sections on the track, from the low end.
    places: Vec<usize>,
}

/// A train.
struct Train {
    /// The place of its head on the track: beyond the last one only its tail is there.
    head: usize,
    /// The cycles until it moves.
    left: i64,
    /// The place of its tail behind its head, and the cycles until that is clear.
    tail: Option<(usize, i64)>,
}

impl Train {
    fn is_at(&self, place: usize) -> bool {
        self.head == place || self.tail.is_some_and(|(tail, _)| tail == place)
    }
}

struct Ground {
    /// The circuits of the station in the direction of travel.
    track: Vec<String>,
    blocks: Vec<Block>,
    /// Whether detections and checks are whatever they may be, of no train.
    noise: bool,
    /// How many routes there are: `in-out`, and perhaps `other`.
    routes: usize,
    /// Whether the low end of the blocks is their entry.
    up: bool,
    session: i64,
    /// The trains, the first one first.
    trains: Vec<Train>,
    /// The most trains at a time.
    most: usize,
    /// The places that a head has entered in this cycle, and those that a tail has left.
    entered: Vec<usize>,
    cleared: Vec<usize>,
    neighbours: Neighbours,
    begun: bool,
    /// How often something goes wrong: once in so many times; 0 for never.
    wrong: u64,
}

fn begin(config: &Value, started: &Value, random: &mut Random) -> Box<dyn Walk> {
    if !is_halt(config) {
        return device::begin(config, started, random);
    }
    let lines = config["layout"]["plan"]["segments"].as_array().into_iter().flatten();
    let west = lines.filter(|line| line["name"] == "West").filter_map(|line| line["circuits"].as_array()).flatten();
    let mut track: Vec<String> = west.filter_map(Value::as_str).map(ToOwned::to_owned).collect();
    track.reverse();
    track.extend(STATION.map(ToOwned::to_owned));
    let blocks = config["counted"]["blocks"].as_array().into_iter().flatten().map(|block| {
        let circuits = block["circuits"].as_array().into_iter().flatten();
        let place = |circuit: &Value| track.iter().position(|name| *circuit == **name);
        Block { places: circuits.filter_map(place).collect() }
    });
    let life = cycles(started, "life");
    let blocks = blocks.collect();
    Box::new(Ground {
        track,
        blocks,
        noise: random.one_in(3),
        routes: config["layout"]["plan"]["routes"].as_array().map_or(1, Vec::len),
        up: config["counted"]["direction"] != "down",
        session: config["session"].as_i64().unwrap_or(0),
        trains: Vec::new(),
        most: [1, 1, 2, 3][random.below(4)],
        entered: Vec::new(),
        cleared: Vec::new(),
        neighbours: Neighbours::new(LINES.map(ToOwned::to_owned).to_vec(), life, 1, random),
        begun: random.one_in(10),
        wrong: random.one_of(&[0, 20, 8]).unsigned_abs(),
    })
}

impl Ground {
    fn goes_wrong(&self, random: &mut Random) -> bool {
        self.wrong > 0 && random.one_in(self.wrong)
    }

    fn move_trains(&mut self, random: &mut Random) {
        self.entered.clear();
        self.cleared.clear();
        for number in 0..self.trains.len() {
            let ahead = self.trains[number].head + 1;
            let is_free = self.trains.iter().all(|train| !train.is_at(ahead));
            let train = &mut self.trains[number];
            if let Some((place, left)) = train.tail {
                train.tail = (left > 0).then_some((place, left - 1));
                if left == 0 {
                    self.cleared.push(place);
                }
            }
            train.left -= 1;
            if train.left < 0 && train.tail.is_none() && is_free && train.head < self.track.len() {
                let (tail, dwell) = (random.one_of(&[0, 0, 1, 3]), random.between(0, 3));
                *train = Train { head: ahead, left: dwell, tail: Some((train.head, tail)) };
                self.entered.push(ahead);
            }
        }
        let beyond = self.track.len();
        self.trains.retain(|train| train.head < beyond || train.tail.is_some());
        if self.trains.len() < self.most && random.one_in(6) {
            let head = if random.one_in(4) { random.below(self.track.len()) } else { 0 };
            if self.trains.iter().all(|train| !train.is_at(head)) {
                self.trains.push(Train { head, left: random.between(0, 3), tail: None });
                self.entered.push(head);
            }
        }
    }

    /// Checks and detections of no train.
    fn noise(&self, random: &mut Random) -> Vec<Value> {
        let detection = |block: &Block, random: &mut Random| {
            let present: Vec<_> = (0..block.places.len()).filter(|_| random.one_in(3)).collect();
            let reset = if random.one_in(8) { present.len().into() } else { Value::Null };
            let [low, high] = [random.one_in(3), random.one_in(3)];
            json!({"low_check": low, "high_check": high, "present": present, "reset": reset})
        };
        self.blocks.iter().map(|block| detection(block, random)).collect()
    }

    fn detections(&self, random: &mut Random) -> Vec<Value> {
        if self.noise {
            return self.noise(random);
        }
        let detection = |block: &Block, random: &mut Random| {
            let is_head = |at: &usize| self.trains.iter().any(|train| train.head == block.places[*at]);
            let mut present: Vec<_> = (0..block.places.len()).filter(is_head).collect();
            if self.goes_wrong(random) {
                // Missed, or heard where nothing is.
                present = if present.is_empty() { vec![0] } else { Vec::new() };
            }
            let (low, high) = (block.places.first().copied(), block.places.last().copied());
            let (entry, exit) = if self.up { (low, high) } else { (high, low) };
            let check_in = entry.is_some_and(|entry| self.entered.contains(&entry));
            let check_out = exit.is_some_and(|exit| self.cleared.contains(&exit));
            let (low, high) = if self.up { (check_in, check_out) } else { (check_out, check_in) };
            let flip = |check: bool, random: &mut Random| check != self.goes_wrong(random);
            let reset = if random.one_in(14) {
                let heard = i64::try_from(present.len()).unwrap_or(0);
                random.one_of(&[heard, heard, heard, heard + 1, 0, 255]).into()
            } else {
                Value::Null
            };
            json!({"low_check": flip(low, random), "high_check": flip(high, random), "present": present, "reset": reset})
        };
        self.blocks.iter().map(|block| detection(block, random)).collect()
    }

    fn occupied(&self, random: &mut Random) -> Vec<&str> {
        let counted: Vec<_> = self.blocks.iter().flat_map(|block| block.places.iter().copied()).collect();
        let at = |place: usize| self.trains.iter().any(|train| train.is_at(place));
        let places = (0..self.track.len()).filter(|place| {
            let its = !counted.contains(place) && at(*place);
            its != (self.wrong > 0 && random.one_in(4 * self.wrong))
        });
        places.map(|place| self.track[place].as_str()).collect()
    }

    fn request(&self, random: &mut Random) -> Value {
        match random.below(12) {
            0..=3 => json!({"set": "in-out"}),
            4 if self.routes > 1 => json!({"set": "other"}),
            5 if self.routes > 1 && random.one_in(2) => json!({"withdraw": "other"}),
            4 | 5 => json!({"withdraw": "in-out"}),
            6 => json!({"drive": "P", "to": if random.one_in(2) { "normal" } else { "reverse" }}),
            7 | 8 => json!({"turn": "West", "to": if random.one_in(4) { "away" } else { "toward" }}),
            _ => json!({"turn": "East", "to": if random.one_in(4) { "toward" } else { "away" }}),
        }
    }

    fn orders(&mut self, random: &mut Random) -> Option<Value> {
        if !self.begun {
            self.begun = true;
            return Some(json!({"unblock": self.track, "lift": self.track}));
        }
        let one = self.track[random.below(self.track.len())].as_str();
        match random.below(40) {
            0 => Some(json!({"block": [one]})),
            1 | 2 => Some(json!({"unblock": self.track})),
            3 => Some(json!({"restrict": {one: random.one_of(&[0, 24, 25, 26, 45, 75, 65_535])}})),
            4 => Some(json!({"lift": self.track})),
            _ => None,
        }
    }
}

impl Walk for Ground {
    fn next(&mut self, random: &mut Random, last: Option<&Value>) -> Value {
        self.neighbours.hear(last);
        self.move_trains(random);
        let detected = if self.goes_wrong(random) { json!({}) } else { json!({"P": "normal"}) };
        let mut step = json!({
            "occupied": self.occupied(random), "detected": detected, "blocks": self.detections(random),
            "messages": self.neighbours.say(self.session, random),
        });
        if random.one_in(3) {
            step["request"] = self.request(random);
        }
        if let Some(orders) = self.orders(random) {
            step["orders"] = orders;
        }
        if random.one_in(4) {
            let some = |random: &mut Random| -> Vec<&str> {
                self.track.iter().map(String::as_str).filter(|_| random.one_in(2)).collect()
            };
            step["framed"] = json!({"main": some(random), "sub": some(random)});
        }
        if random.one_in(48) {
            self.session = (self.session + 1) % 65536;
            self.begun = random.one_in(10);
            step["restart"] = self.session.into();
        }
        if random.one_in(3) {
            step["all_telegrams"] = true.into();
        }
        step
    }
}
