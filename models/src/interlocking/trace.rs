//! A path through a station as a run of the kernel's machine, in the words of the oracle's protocol.

use super::device::Device;
use super::train::{Place, Train};
use super::yard::{Cycle, Harm, State, Yard};
use crate::outcome::{self, Trace};
use atc_kernel::Machine;
use atc_kernel::interlocking::{
    self as kernel, Combined, Directions, Input, Layout, Memory, Plan, RouteSet, SegmentSet,
};
use atc_layout::Names;
use atc_protocol::machine::interlocking::{Interlocked, Request, Travel};
use atc_protocol::names::Named;
use serde_json::{Value, json};

/// The length of a cycle in milliseconds.
const CYCLE_MS: u32 = 1000;

/// The speeds in km/h that stand for the codes: the models know codes only.
const SPEEDS_KMH: [u16; 8] = [0, 20, 40, 60, 80, 100, 120, 140];

impl<D: Device> Yard<D> {
    /// The run of the kernel: first what happens before the model begins, then the path. The further words of a step: where trains and
    /// points really are, and what has gone wrong.
    pub(super) fn run_of(&self, path: &[(State, Option<Cycle>)]) -> Trace {
        let mut run = Run::begin(self.station.name, self.station.ground.circuits, &self.station.layout);
        for input in self.prelude() {
            run.step(&input, json!({"trains": [], "hazard": false}));
        }
        for (place, (_, cycle)) in path.iter().enumerate() {
            let Some(cycle) = cycle else { break };
            let harm = path.get(place + 1).map_or(Harm::None, |(after, _)| after.harm);
            let shown = path.get(place + 1).map_or(0, |(after, _)| after.shown.proceed);
            let words = json!({
                "trains": cycle.trains.iter().map(|train| self.train(train)).collect::<Vec<_>>(),
                "points_at": cycle.blades,
                "proceed_by_the_model": run.routes(RouteSet::from_bits(shown.into())),
                "harm": harm,
                "hazard": harm != Harm::None,
            });
            run.step(&cycle.input, words);
        }
        run.trace()
    }

    fn train(&self, train: &Train) -> Value {
        let name = |circuit: u8| self.station.ground.circuits[usize::from(circuit)];
        match train.place {
            Place::Coming => json!("coming"),
            Place::Gone => json!("gone"),
            Place::Here { front, rear } => {
                json!({"front": name(front), "rear": name(rear), "heading": train.heading})
            }
        }
    }
}

/// A run of the kernel on a layout, and the names for it.
pub(crate) struct Run<'a, const R: usize, const P: usize, const N: usize, const S: usize> {
    layout: &'a Layout<R, P, N, S>,
    memory: Memory<R, S>,
    named: Interlocked<R, P, N, S>,
    cycles: Vec<outcome::Cycle<Interlocked<R, P, N, S>, Value>>,
}

impl<'a, const R: usize, const P: usize, const N: usize, const S: usize> Run<'a, R, P, N, S> {
    /// From the initial state.
    pub(crate) fn begin(station: &str, circuits: &[&str], layout: &'a Layout<R, P, N, S>) -> Self {
        let names = names(station, circuits, layout.plan());
        let named = Interlocked::new(Box::new(*layout), names, SPEEDS_KMH, CYCLE_MS);
        Self { layout, memory: Memory::INITIAL, named, cycles: Vec::new() }
    }

    /// One more cycle, and what else the model knows of it: an object.
    pub(crate) fn step(&mut self, input: &Input, words: Value) {
        let (memory, commands) = Combined(self.layout).step(self.memory, *input);
        self.memory = memory;
        self.named.remember(&memory);
        self.cycles.push((self.named.step_of(input), self.named.output(*input, &commands, false), words));
    }

    /// The names of routes.
    pub(crate) fn routes(&self, set: RouteSet) -> Vec<String> {
        self.named.routes_of(set)
    }

    /// A request by its names.
    pub(super) fn request(&self, request: kernel::Request) -> Request {
        self.named.request_of(request)
    }

    /// The whole run.
    pub(crate) fn trace(self) -> Trace {
        Trace::of::<Interlocked<R, P, N, S>, _>(&self.named.plan_config(), &self.cycles)
    }
}

/// The names of what there is: those of the circuits; R, P, S and the number for routes, points and segments.
fn names<const R: usize, const P: usize, const N: usize, const S: usize>(
    station: &str,
    circuits: &[&str],
    plan: &Plan<R, P, N, S>,
) -> Names {
    let numbered = |letter: char, all: usize| (0..all).map(|number| format!("{letter}{number}")).collect::<Vec<_>>();
    let routes = numbered('R', plan.routes.iter().filter(|route| route.exists()).count());
    Names {
        station: station.to_owned(),
        circuits: circuits.iter().map(|name| (*name).to_owned()).collect(),
        points: numbered('P', N),
        signals: routes.clone(),
        routes,
        segments: numbered('S', plan.segments.iter().filter(|segment| segment.length > 0).count()),
    }
}

/// The direction of the first segment.
pub(super) fn direction_word<const S: usize>(directions: &Directions<S>) -> &'static str {
    let it = SegmentSet::nth(0);
    if directions.away.meets(it) {
        Travel(kernel::Travel::Away).name()
    } else if directions.toward.meets(it) {
        Travel(kernel::Travel::Toward).name()
    } else {
        "none"
    }
}
