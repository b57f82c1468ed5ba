//! A path through a station as a run of the kernel's machine, in the words of the oracle's protocol.

use super::device::Device;
use super::ground::{Blade, Heading};
use super::train::{Place, Train};
use super::yard::{Cycle, Harm, State, Yard};
use crate::outcome::{Step, Trace};
use atc_kernel::Machine;
use atc_kernel::interlocking::{
    self as kernel, CircuitSet, Directions, Element, Input, Layout, MAX_CODES, Output, Phase, PointSet, Position,
    Positions, Refusal, Request, RouteSet, Segment, SegmentSet, SpeedCode, State as Kernel, Travel,
};
use serde_json::{Value, json};
use std::collections::{BTreeMap, BTreeSet};

/// The length of a cycle in milliseconds.
const CYCLE_MS: u32 = 1000;

impl<D: Device> Yard<D> {
    /// The run of the kernel: first what happens before the model begins, then the path. The further words of a step: where trains and
    /// points really are, and what has gone wrong.
    pub(super) fn run_of(&self, path: &[(State, Option<Cycle>)]) -> Trace {
        let mut run = Run::begin(self.station.name, self.station.ground.circuits, &self.station.layout);
        for input in self.prelude() {
            let words = BTreeMap::from([("trains".to_owned(), json!([])), ("hazard".to_owned(), json!(false))]);
            run.step(&input, words);
        }
        for (place, (_, cycle)) in path.iter().enumerate() {
            let Some(cycle) = cycle else { break };
            let harm = path.get(place + 1).map_or(Harm::None, |(after, _)| after.harm);
            let shown = path.get(place + 1).map_or(0, |(after, _)| after.shown.proceed);
            let words = BTreeMap::from([
                ("trains".to_owned(), cycle.trains.iter().map(|train| self.train(train)).collect()),
                ("points_at".to_owned(), cycle.blades.iter().map(|blade| json!(blade_word(*blade))).collect()),
                ("proceed_by_the_model".to_owned(), json!(names(RouteSet::from_bits(u64::from(shown))))),
                ("harm".to_owned(), json!(harm_word(harm))),
                ("hazard".to_owned(), json!(harm != Harm::None)),
            ]);
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
                let heading = if train.heading == Heading::Up { "up" } else { "down" };
                json!({"front": name(front), "rear": name(rear), "heading": heading})
            }
        }
    }
}

/// A run of the kernel on a layout, in the words of the oracle's protocol.
pub(crate) struct Run<'a, const R: usize, const P: usize, const N: usize, const S: usize> {
    station: &'a str,
    circuits: &'a [&'a str],
    layout: &'a Layout<R, P, N, S>,
    state: Kernel<R, S>,
    steps: Vec<Step>,
}

impl<'a, const R: usize, const P: usize, const N: usize, const S: usize> Run<'a, R, P, N, S> {
    /// From the initial state.
    pub(crate) fn begin(station: &'a str, circuits: &'a [&'a str], layout: &'a Layout<R, P, N, S>) -> Self {
        Self { station, circuits, layout, state: layout.initial(), steps: Vec::new() }
    }

    /// One more cycle.
    pub(crate) fn step(&mut self, input: &Input, words: BTreeMap<String, Value>) {
        let (next, output) = self.layout.cycle(self.state, *input);
        self.state = next;
        self.steps.push(Step { input: self.input(input), output: self.output(&output), words });
    }

    /// The whole run.
    pub(crate) fn trace(self) -> Trace {
        Trace { machine: "interlocking".to_owned(), config: self.config(), steps: self.steps, loop_start: None }
    }

    fn circuits(&self, set: CircuitSet) -> Vec<&'a str> {
        let there = |(number, _): &(usize, _)| set.meets(CircuitSet::nth(*number));
        self.circuits.iter().enumerate().filter(there).map(|(_, name)| *name).collect()
    }

    fn segments(&self, set: SegmentSet) -> Vec<String> {
        let there =
            |(number, segment): &(usize, &Segment<P>)| segment.length > 0 && set.meets(SegmentSet::nth(*number));
        self.layout.plan().segments.iter().enumerate().filter(there).map(|(number, _)| segment_name(number)).collect()
    }

    fn input(&self, input: &Input) -> Value {
        let orders = &input.orders;
        let restrict: BTreeMap<_, _> =
            self.circuits(orders.restrict).into_iter().map(|name| (name, speed_km_h(orders.speed))).collect();
        json!({
            "occupied": self.circuits(input.occupied),
            "detected": positions(input.detected),
            "request": input.request.map(request),
            "orders": {
                "block": self.circuits(orders.block),
                "unblock": self.circuits(orders.unblock),
                "restrict": restrict,
                "lift": self.circuits(orders.lift),
            },
            "consent": self.segments(input.consent),
        })
    }

    fn output(&self, output: &Output<R>) -> Value {
        let held = (0..).zip(&self.state.routes).filter(|(_, route)| route.is_held());
        let phases: BTreeMap<_, _> = held.map(|(number, route)| (route_name(number), phase(route.phase))).collect();
        let telegrams = self.layout.telegrams(&output.table, self.state.epoch);
        let told = self.circuits.iter().zip(&telegrams).filter_map(|(name, telegram)| {
            let telegram = telegram.filter(kernel::Movement::is_open)?;
            let stop = self.circuits[usize::from(telegram.stop.number())];
            let heading = telegram.heading.map(heading_word);
            Some((
                *name,
                json!({"stop": stop, "speed_km_h": speed_km_h(telegram.speed), "open": true, "heading": heading}),
            ))
        });
        let mut output = json!({
            "routes": phases,
            "proceed": names(output.proceed),
            "drives": positions(output.drives),
            "telegrams": told.collect::<BTreeMap<_, _>>(),
            "permits": self.segments(output.permits),
            "confirmed": self.circuits(output.confirmed),
            "answer": output.answer.map(|answer| match answer {
                Ok(()) => json!("accepted"),
                Err(refusal) => json!({"refused": refused(refusal)}),
            }),
        });
        // Where the neighbour speaks; left out where there is no such circuit.
        let silent = self.circuits.iter().zip(&telegrams).filter(|(_, telegram)| telegram.is_none());
        let silent: BTreeSet<_> = silent.map(|(name, _)| *name).collect();
        if !silent.is_empty() {
            output["silent"] = json!(silent);
        }
        output
    }

    /// The plan in the oracle's words.
    fn config(&self) -> Value {
        let plan = self.layout.plan();
        let element = |element: &Element| json!({"circuits": self.circuits(element.circuits), "points": positions(element.positions)});
        let routes: Vec<_> = (0..)
            .zip(&plan.routes)
            .filter(|(_, route)| route.exists())
            .map(|(number, route): (u8, _)| {
                json!({
                    "name": route_name(number),
                    "entry": self.circuits(route.entry),
                    "approach": self.circuits(route.approach),
                    "path": route.path[..usize::from(route.length)].iter().map(element).collect::<Vec<_>>(),
                    "overlap": element(&route.overlap),
                    "beyond": self.circuits(route.beyond),
                    "continuing": names(route.continuing),
                    "conflicts": names(route.conflicts),
                    "from": self.segments(route.from),
                    "to": self.segments(route.to),
                    "drive_cycles": route.drive.0,
                    "release_cycles": route.release.0,
                    "stay_cycles": route.stay.0,
                    "speed_code": route.speed.0,
                    "overlap_speed_code": route.overlap_speed.0,
                    "cab_signalled": route.cab_signalled,
                    "heading": heading_word(route.heading),
                })
            })
            .collect();
        let segments: Vec<_> = (0..)
            .zip(&plan.segments)
            .filter(|(_, segment)| segment.length > 0)
            .map(|(number, segment): (usize, _)| {
                let circuits = &segment.circuits[..usize::from(segment.length)];
                json!({
                    "name": segment_name(number),
                    "circuits": circuits.iter().flat_map(|circuit| self.circuits(*circuit)).collect::<Vec<_>>(),
                    "throat": self.circuits(segment.throat),
                    "outward": heading_word(segment.outward),
                    "shared": segment.shared,
                })
            })
            .collect();
        let points = plan.points.iter().enumerate();
        let points = points
            .map(|(number, point)| json!({"name": point_name(number), "detectors": self.circuits(point.detectors)}));
        let circuits = self.circuits.iter().zip(&plan.lengths);
        let circuits = circuits.map(|(name, length)| json!({"name": name, "length_m": length.0}));
        json!({"plan": {
            "station": self.station,
            "cycle_ms": CYCLE_MS,
            "clear_cycles": plan.clear,
            "turn_cycles": plan.turn.0,
            "start_cycles": plan.start.0,
            "settle_cycles": plan.settle,
            "loss_cycles": plan.loss,
            "residual_cycles": plan.residual.0,
            "standstill_cycles": plan.standstill.0,
            "speeds_km_h": (0..).take(MAX_CODES).map(|code| speed_km_h(SpeedCode(code))).collect::<Vec<_>>(),
            "braking_m": plan.braking.iter().map(|braking| braking.0).collect::<Vec<_>>(),
            "circuits": circuits.collect::<Vec<_>>(),
            "points": points.collect::<Vec<_>>(),
            "segments": segments,
            "routes": routes,
        }})
    }
}

/// The speed that stands for a code: the models know codes only.
const fn speed_km_h(code: SpeedCode) -> u16 {
    code.0 as u16 * 20
}

/// The direction of the first segment.
pub(super) fn direction_word<const S: usize>(directions: &Directions<S>) -> &'static str {
    let it = SegmentSet::nth(0);
    if directions.away.meets(it) {
        "away"
    } else if directions.toward.meets(it) {
        "toward"
    } else {
        "none"
    }
}

fn point_name(number: usize) -> String {
    format!("P{number}")
}

fn segment_name(number: usize) -> String {
    format!("S{number}")
}

/// The name of a route: R and its number.
fn route_name(number: u8) -> String {
    format!("R{number}")
}

pub(crate) fn names(set: RouteSet) -> Vec<String> {
    (0..8).filter(|number| set.meets(RouteSet::nth(usize::from(*number)))).map(route_name).collect()
}

fn positions(positions: Positions) -> Value {
    let name = |point: usize| {
        let it = PointSet::nth(point);
        let word =
            if positions.normal.meets(it) { Some("normal") } else { positions.reverse.meets(it).then_some("reverse") };
        word.map(|word| (point_name(point), json!(word)))
    };
    Value::Object((0..32).filter_map(name).collect())
}

fn request(request: Request) -> Value {
    match request {
        Request::Set(route) => json!({"set": route_name(route.number())}),
        Request::Withdraw(route) => json!({"withdraw": route_name(route.number())}),
        Request::Drive(point, position) => {
            let to = if position == Position::Normal { "normal" } else { "reverse" };
            json!({"drive": format!("P{}", point.number()), "to": to})
        }
        Request::Turn(segment, travel) => {
            let to = if travel == Travel::Toward { "toward" } else { "away" };
            json!({"turn": format!("S{}", segment.number()), "to": to})
        }
    }
}

const fn heading_word(heading: kernel::Heading) -> &'static str {
    match heading {
        kernel::Heading::Left => "left",
        kernel::Heading::Right => "right",
    }
}

const fn phase(phase: Phase) -> &'static str {
    match phase {
        Phase::Idle => "idle",
        Phase::Provisional => "provisional",
        Phase::Failed => "failed",
        Phase::Set => "set",
        Phase::InUse => "in-use",
        Phase::Releasing => "releasing",
    }
}

const fn refused(refusal: Refusal) -> &'static str {
    match refusal {
        Refusal::Unknown => "unknown",
        Refusal::Starting => "starting",
        Refusal::AlreadyHeld => "already-held",
        Refusal::NotHeld => "not-held",
        Refusal::Conflict => "conflict",
        Refusal::PathHeld => "path-held",
        Refusal::OverlapHeld => "overlap-held",
        Refusal::PointLocked => "point-locked",
        Refusal::Occupied => "occupied",
        Refusal::Unswept => "unswept",
        Refusal::Blocked => "blocked",
        Refusal::PointUnderTrain => "point-under-train",
        Refusal::Direction => "direction",
        Refusal::Waiting => "waiting",
    }
}

const fn blade_word(blade: Blade) -> &'static str {
    match blade {
        Blade::Normal => "normal",
        Blade::Reverse => "reverse",
        Blade::ToNormal => "to normal",
        Blade::ToReverse => "to reverse",
    }
}

const fn harm_word(harm: Harm) -> &'static str {
    match harm {
        Harm::None => "none",
        Harm::Collision => "collision",
        Harm::Derailment => "derailment",
        Harm::Overrun => "overrun",
        Harm::Proceed => "proceed",
        Harm::Authority => "authority",
        Harm::Staff => "staff",
        Harm::Speed => "speed",
        Harm::Limit => "limit",
        Harm::Unasked => "unasked",
    }
}
