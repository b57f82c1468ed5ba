//! A path through a station as a run of the kernel's machine, in the words of the oracle's protocol.

use super::device::Device;
use super::ground::{Blade, Heading};
use super::stations::{POINTS, ROUTES, SEGMENTS};
use super::train::{Place, Train};
use super::yard::{Cycle, Harm, State, Yard};
use crate::outcome::{Step, Trace};
use atc_kernel::Machine;
use atc_kernel::interlocking::{
    CircuitSet, Input, Output, Phase, PointSet, Position, Positions, Refusal, Request, RouteSet, SegmentSet,
    State as Kernel, Travel,
};
use serde_json::{Map, Value, json};
use std::collections::BTreeMap;

/// The length of a cycle in milliseconds.
const CYCLE_MS: u32 = 1000;

impl<D: Device> Yard<D> {
    /// The run of the kernel: first what happens before the model begins, then the path. The further words of a step: where trains and
    /// points really are, and what has gone wrong.
    pub(super) fn run_of(&self, path: &[(State, Option<Cycle>)]) -> Trace {
        let mut state = self.station.layout.initial();
        let mut steps = Vec::new();
        for input in self.prelude() {
            let words = BTreeMap::from([("trains".to_owned(), json!([])), ("hazard".to_owned(), json!(false))]);
            steps.push(self.step(&mut state, input, words));
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
            steps.push(self.step(&mut state, cycle.input, words));
        }
        Trace { machine: "interlocking".to_owned(), config: self.config(), steps, loop_start: None }
    }

    fn step(&self, state: &mut Kernel<ROUTES, SEGMENTS>, input: Input, words: BTreeMap<String, Value>) -> Step {
        let (next, output) = self.station.layout.cycle(*state, input);
        *state = next;
        Step { input: self.input(&input), output: self.output(state, &output), words }
    }

    fn circuits(&self, set: CircuitSet) -> Value {
        if set == CircuitSet::ALL {
            return json!(self.station.ground.circuits);
        }
        let there = |(number, _): &(usize, _)| set.meets(CircuitSet::nth(*number));
        self.station.ground.circuits.iter().enumerate().filter(there).map(|(_, name)| json!(name)).collect()
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

    fn input(&self, input: &Input) -> Value {
        let orders = &input.orders;
        let restricted = |set| match self.circuits(set) {
            Value::Array(names) => names
                .into_iter()
                .map(|name| (name.as_str().unwrap_or_default().to_owned(), json!(orders.speed.0)))
                .collect(),
            _ => Map::new(),
        };
        json!({
            "occupied": self.circuits(input.occupied),
            "detected": positions(input.detected),
            "request": input.request.map(request),
            "orders": {
                "block": self.circuits(orders.block),
                "unblock": self.circuits(orders.unblock),
                "restrict": restricted(orders.restrict),
                "lift": self.circuits(orders.lift),
            },
            "consent": segments(input.consent),
        })
    }

    fn output(&self, state: &Kernel<ROUTES, SEGMENTS>, output: &Output<ROUTES>) -> Value {
        let exists = self.station.layout.plan().routes.iter().map(atc_kernel::interlocking::Route::exists);
        let phases: Map<_, _> = (0..)
            .zip(&state.routes)
            .zip(exists)
            .filter(|(_, exists)| *exists)
            .map(|((number, route), _): ((u8, _), _)| (route_name(number), json!(phase(route.phase))))
            .collect();
        let telegrams: Map<_, _> = self
            .station
            .layout
            .telegrams(&output.table, state.epoch)
            .iter()
            .zip(self.station.ground.circuits)
            .filter(|(telegram, _)| telegram.open)
            .map(|(telegram, name)| {
                let stop = self.station.ground.circuits[usize::from(telegram.stop.number())];
                ((*name).to_owned(), json!({"stop": stop, "speed": telegram.speed.0, "open": telegram.open}))
            })
            .collect();
        json!({
            "routes": phases,
            "proceed": names(output.proceed),
            "drives": positions(output.drives),
            "telegrams": telegrams,
            "permits": segments(output.permits),
            "confirmed": self.circuits(output.confirmed),
            "answer": output.answer.map(|answer| match answer {
                Ok(()) => json!("accepted"),
                Err(refusal) => json!({"refused": refused(refusal)}),
            }),
        })
    }

    /// The layout, as far as the kernel reads it.
    fn config(&self) -> Value {
        let plan = self.station.layout.plan();
        let routes: Map<_, _> = (0..)
            .zip(&plan.routes)
            .filter(|(_, route)| route.exists())
            .map(|(number, route): (u8, _)| {
                let path: Vec<_> = route.path[..usize::from(route.length)]
                    .iter()
                    .map(|element| json!({"circuit": self.circuits(element.circuits), "points": positions(element.positions)}))
                    .collect();
                let value = json!({
                    "entry": self.circuits(route.entry),
                    "approach": self.circuits(route.approach),
                    "path": path,
                    "overlap": {"circuits": self.circuits(route.overlap.circuits), "points": positions(route.overlap.positions)},
                    "beyond": self.circuits(route.beyond),
                    "continuing": names(route.continuing),
                    "conflicts": names(route.conflicts),
                    "from": segments(route.from),
                    "to": segments(route.to),
                    "drive_cycles": route.drive.0,
                    "release_cycles": route.release.0,
                    "stay_cycles": route.stay.0,
                });
                (route_name(number), value)
            })
            .collect();
        json!({
            "cycle_ms": CYCLE_MS,
            "station": self.station.name,
            "circuits": self.station.ground.circuits,
            "detectors": plan.points.iter().map(|point| self.circuits(point.detectors)).collect::<Vec<_>>(),
            "clear_cycles": plan.clear,
            "turn_cycles": plan.turn.0,
            "routes": routes,
        })
    }
}

/// The name of a route: R and its number.
fn route_name(number: u8) -> String {
    format!("R{number}")
}

fn names(set: RouteSet) -> Vec<String> {
    (0..8).filter(|number| set.meets(RouteSet::nth(usize::from(*number)))).map(route_name).collect()
}

fn positions(positions: Positions) -> Value {
    let name = |point: usize| {
        let it = PointSet::nth(point);
        let word =
            if positions.normal.meets(it) { Some("normal") } else { positions.reverse.meets(it).then_some("reverse") };
        word.map(|word| (format!("P{point}"), json!(word)))
    };
    Value::Object((0..POINTS).filter_map(name).collect())
}

fn segments(set: SegmentSet) -> Vec<String> {
    let there = |number: &usize| set.meets(SegmentSet::nth(*number));
    (0..SEGMENTS).filter(there).map(|number| format!("S{number}")).collect()
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
        Refusal::AlreadyHeld => "already-held",
        Refusal::NotHeld => "not-held",
        Refusal::Conflict => "conflict",
        Refusal::PathHeld => "path-held",
        Refusal::OverlapHeld => "overlap-held",
        Refusal::PointLocked => "point-locked",
        Refusal::Occupied => "occupied",
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
    }
}
