//! Walks: steps drawn so that every timer and counter of a machine is driven to its limits, one below and one above.
//!
//! A walk is a function of seed, machine and place: the same on every computer. It may look at what the kernel said last, for points
//! that follow their drives and trains that follow their telegrams; it never looks at the other side.

mod aspect;
mod block;
mod device;
mod ground;
mod halts;
mod interlocking;
mod mutate;
mod neighbours;
mod pattern;
mod permitted;
mod plan;
mod position;
mod rows;
mod source;
mod station;
mod supervision;
mod telegram;
mod train;
mod varied;
mod wayside;
mod wrong_plans;

use std::sync::OnceLock;

use serde_json::Value;

use super::case::{Case, Expected, Kernel, is_rejected};
use super::random::Random;

pub use mutate::examples;
pub use source::{Source, Walk};

/// Every machine that has walks of its own.
pub const SOURCES: &[Source] = &[
    aspect::SOURCE,
    supervision::SOURCE,
    block::SOURCE,
    telegram::SOURCE,
    pattern::SOURCE,
    permitted::SOURCE,
    position::SOURCE,
    interlocking::SOURCE,
    train::SOURCE,
    wayside::SOURCE,
];

/// The configurations of a source, made once: a layout takes its time.
struct Configs {
    small: Vec<Value>,
    large: Vec<Value>,
    wrong: Vec<Value>,
}

static CONFIGS: [OnceLock<Configs>; SOURCES.len()] = [const { OnceLock::new() }; SOURCES.len()];

impl Source {
    fn configs(&self) -> Option<&'static Configs> {
        let place = SOURCES.iter().position(|source| source.machine == self.machine)?;
        let made = || Configs { small: (self.small)(), large: (self.large)(), wrong: (self.wrong)() };
        CONFIGS.get(place).map(|configs| configs.get_or_init(made))
    }
}

/// The walks of that machine. One without walks of its own has its committed examples, changed here and there.
pub fn source(machine: &str) -> Option<&'static Source> {
    SOURCES.iter().find(|source| source.machine == machine)
}

/// Which configurations a case may have.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sizes {
    /// Those with times of a few cycles only.
    Small,
    /// One walk in eight on a configuration as lines have them, and one in sixteen an example.
    Mixed,
    /// One short walk in sixty-four on a configuration as lines have them.
    Few,
}

/// How many walks come before the configurations to be rejected.
const WALKS_FIRST: u64 = 4;

/// The case of that number of a machine, with the kernel's replies; none if the machine has neither walks nor examples.
///
/// First come some walks, so that a machine that is not built shows at once; then the configurations to be rejected; then more walks.
/// With `config` every case has that configuration.
pub fn case(machine: &str, seed: u64, number: u64, sizes: Sizes, config: Option<&Value>) -> Option<Expected> {
    let mut random = Random::of(seed, machine, number);
    let Some(source) = source(machine) else { return mutate::case(machine, number, config, &mut random) };
    if let Some(config) = config {
        return Some(source.walk(config.clone(), source.own, true, &mut random));
    }
    let made = source.configs()?;
    let wrong = number.checked_sub(WALKS_FIRST).and_then(|number| usize::try_from(number).ok());
    if let Some(config) = wrong.and_then(|number| made.wrong.get(number)) {
        let case = Case { machine: machine.to_owned(), config: config.clone(), steps: Vec::new() };
        return case.expected().ok();
    }
    // The committed examples come once the small walks have had their chance to find a short trace.
    if sizes == Sizes::Mixed && number % 16 == 15 {
        let example = mutate::case(machine, number / 16, None, &mut random);
        if example.is_some() {
            return example;
        }
    }
    let (configs, most) = match sizes {
        Sizes::Mixed if number % 8 == 7 => (&made.large, source.most.1),
        Sizes::Few if number % 64 == 7 => (&made.large, source.most.1 / 4),
        _ => (&made.small, source.most.0),
    };
    let config = random.pick(configs).cloned().unwrap_or_default();
    Some(source.walk(config, most, false, &mut random))
}

/// How many routes the station of a configuration has; none of a machine without a station.
pub fn routes(machine: &str, config: &Value) -> Option<usize> {
    let layout = match machine {
        "interlocking" => config,
        "wayside" => &config["layout"],
        _ => return None,
    };
    Some(station::Station::of(layout).routes.len())
}

/// The longest walk on a configuration of the user's own, in steps.
const LONGEST: usize = 30_000;

/// How many times its longest time such a walk may last.
const LASTS: u64 = 4;

impl Source {
    /// How many configurations are there to be rejected.
    pub fn wrong_count(&self) -> usize {
        self.configs().map_or(0, |configs| configs.wrong.len())
    }

    /// A walk of at most so many steps; on a configuration of the user's `own` more, where its times are longer.
    fn walk(&self, config: Value, mut most: usize, own: bool, random: &mut Random) -> Expected {
        let mut case = Case { machine: self.machine.to_owned(), config, steps: Vec::new() };
        let mut kernel = Kernel::new();
        let start = kernel.start(&case).unwrap_or_else(|reply| reply);
        let (mut outputs, mut left_out) = (Vec::new(), 0);
        if !is_rejected(&start) && !start.starts_with(r#"{"malformed""#) {
            let started: Value = serde_json::from_str(&start).unwrap_or_default();
            let times = started["started"]["cycles"].as_object().into_iter().flatten();
            let longest = times.filter_map(|(_, cycles)| cycles.as_u64()).max().unwrap_or(0);
            if own {
                most = most.max(usize::try_from(LASTS * longest).unwrap_or(LONGEST).min(LONGEST));
            }
            let mut walk = (self.begin)(&case.config, &started["started"], random);
            let mut last: Option<Value> = None;
            for _ in 0..=random.below(most) {
                let step = walk.next(random, last.as_ref().map(|reply| &reply["output"]));
                match kernel.step(&step) {
                    Ok(output) => {
                        last = serde_json::from_str(&output).ok();
                        case.steps.push(step);
                        outputs.push(output);
                    }
                    Err(_) => left_out += 1,
                }
            }
        }
        Expected { case, start, outputs, left_out }
    }
}
