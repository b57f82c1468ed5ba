//! `interlocking`: [`atc_kernel::interlocking`] behind the protocol, on a layout of names.

mod because;
mod config;
mod forms;
mod opened;
mod part;
mod plan;
mod words;

use std::collections::{BTreeMap, BTreeSet};

use atc_kernel::interlocking::{
    self as kernel, CircuitSet, Combined, Large, Layout, Memory, PointId, PointSet, Positions, RouteId, SegmentId,
    SegmentSet, Size, Small, SpeedCode,
};
use atc_layout::Names;

use opened::Opened;
use plan::PlanConfig;

pub use config::Config;
pub use forms::{Accepted, Answer, ByName, Orders, Output, Refused, Request, Step, Telegram};
pub use opened::{Found, Said};
pub use words::{Heading, Phase, Reason, Side, Travel};

use super::contract::Machine;
use crate::decimal::shorten;
use crate::machine::sizes;

/// The state of the kernel's machine, with room for every station.
pub type State = kernel::State<64, 8>;

/// The machine with its state, on a layout of one size.
#[derive(Clone, Debug)]
pub struct Interlocked<
    const R: usize = 64,
    const P: usize = 16,
    const N: usize = 32,
    const S: usize = 8,
    Z: Size = Small,
> {
    layout: Box<Layout<R, P, N, S, Z>>,
    names: Names,
    speeds_kmh: [u16; kernel::MAX_CODES],
    cycle_ms: u32,
    said: Option<Said>,
    memory: Box<Memory<R, S, Z>>,
}

/// The interlocking of a station of either size.
pub type Sizes = sizes::Sizes<
    Interlocked,
    Interlocked<{ sizes::ROUTES }, { sizes::PLACES }, { sizes::POINTS }, { sizes::SEGMENTS }, Large>,
>;

/// Where the name stands in the list.
fn place(names: &[String], name: &str, field: &str, kind: &str) -> Result<u8, String> {
    const MOST: usize = 12;
    let found = names.iter().position(|other| other == name).and_then(|place| u8::try_from(place).ok());
    found.ok_or_else(|| {
        let listed = names.iter().take(MOST).map(String::as_str).collect::<Vec<_>>().join(", ");
        let more = if names.len() > MOST { ", …" } else { "" };
        let there = if names.is_empty() { "none".to_owned() } else { format!("{listed}{more}") };
        format!("{field} names {kind} {:?}; the {kind}s of this layout are {there}", shorten(name))
    })
}

/// The name of a number; empty if it has none.
fn name(names: &[String], number: u8) -> String {
    names.get(usize::from(number)).cloned().unwrap_or_default()
}

/// The places of a list of names, each at most once.
fn places(names: &[String], list: &[String], field: &str, kind: &str) -> Result<Vec<u8>, String> {
    let mut found = Vec::with_capacity(list.len());
    for name in list {
        let place = place(names, name, field, kind)?;
        if found.contains(&place) {
            return Err(format!("{field} names {kind} {:?} a second time; each {kind} is named once", shorten(name)));
        }
        found.push(place);
    }
    Ok(found)
}

/// The set of those that a list names, each at most once.
fn set<T>(
    names: &[String],
    list: &[String],
    field: &str,
    kind: &str,
    empty: T,
    or: impl Fn(T, usize) -> T,
) -> Result<T, String> {
    Ok(places(names, list, field, kind)?.into_iter().map(usize::from).fold(empty, or))
}

/// The names of those numbers that are in the set, in the order of the numbers.
fn named<C: FromIterator<String>>(names: &[String], is_in: impl Fn(usize) -> bool) -> C {
    names.iter().enumerate().filter(|(number, _)| is_in(*number)).map(|(_, name)| name.clone()).collect()
}

impl<const R: usize, const P: usize, const N: usize, const S: usize, Z: Size> Interlocked<R, P, N, S, Z> {
    /// The machine in its initial state, on a layout whose numbers have these names. The speeds are those of the codes,
    /// in km/h: 0, and then rising; 0 where there is no such code.
    pub fn new(
        layout: Box<Layout<R, P, N, S, Z>>,
        names: Names,
        speeds_kmh: [u16; kernel::MAX_CODES],
        cycle_ms: u32,
    ) -> Self {
        Self { layout, names, speeds_kmh, cycle_ms, said: None, memory: Box::new(Memory::INITIAL) }
    }

    /// The layout as a configuration in the kernel's own terms, whose rules of engineering are not checked.
    pub fn plan_config(&self) -> Config {
        Config::Plan(Box::new(PlanConfig::of(self)))
    }

    /// The layout.
    pub fn layout(&self) -> &Layout<R, P, N, S, Z> {
        &self.layout
    }

    /// The names of its numbers.
    pub fn names(&self) -> &Names {
        &self.names
    }

    /// The kernel's state.
    pub fn state(&self) -> &kernel::State<R, S, Z> {
        &self.memory.interlocking
    }

    /// The length of a logic cycle in ms.
    pub fn cycle_ms(&self) -> u32 {
        self.cycle_ms
    }

    /// What the layout file says of trains and tracks; none of a plan, which does not say.
    pub fn said(&self) -> Option<&Said> {
        self.said.as_ref()
    }

    fn circuits(&self, list: &[String], field: &str) -> Result<CircuitSet<Z>, String> {
        let or = |all: CircuitSet<Z>, number| all.or(CircuitSet::nth(number));
        set(&self.names.circuits, list, field, "circuit", CircuitSet::EMPTY, or)
    }

    /// The names of circuits.
    pub(in crate::machine) fn circuits_of<C: FromIterator<String>>(&self, set: CircuitSet<Z>) -> C {
        named(&self.names.circuits, |number| set.meets(CircuitSet::nth(number)))
    }

    fn points_of(&self, set: PointSet<Z>) -> BTreeSet<String> {
        named(&self.names.points, |number| set.meets(PointSet::nth(number)))
    }

    fn segments_of<C: FromIterator<String>>(&self, set: SegmentSet<Z>) -> C {
        named(&self.names.segments, |number| set.meets(SegmentSet::nth(number)))
    }

    /// A step in the kernel's form.
    ///
    /// # Errors
    /// If it names what the layout does not have, or one thing twice, or restricts to different speeds.
    pub fn input(&self, step: &Step) -> Result<kernel::Input<Z>, String> {
        let mut detected = Positions::NONE;
        for (name, side) in &step.detected.0 {
            let point = PointId::new(place(&self.names.points, name, "detected", "point")?);
            if let (Some(point), Some(Side(position))) = (point, side) {
                detected = detected.or(Positions::of(point, *position));
            }
        }
        let or = |all: SegmentSet<Z>, number| all.or(SegmentSet::nth(number));
        let consent = set(&self.names.segments, &step.consent, "consent", "segment", SegmentSet::EMPTY, or)?;
        Ok(kernel::Input {
            occupied: self.circuits(&step.occupied, "occupied")?,
            detected,
            request: step.request.as_ref().map(|request| self.request(request)).transpose()?,
            orders: self.orders(&step.orders)?,
            consent,
        })
    }

    /// The kernel's input as a step; [`Interlocked::input`] reads it again, but for a speed that restricts no circuit.
    pub fn step_of(&self, input: &kernel::Input<Z>) -> Step {
        let kernel::Orders { block, unblock, restrict, speed, lift } = input.orders;
        let restricted: Vec<_> = self.circuits_of(restrict);
        Step {
            occupied: self.circuits_of(input.occupied),
            detected: ByName(self.sides(input.detected).into_iter().map(|(name, side)| (name, Some(side))).collect()),
            request: input.request.map(|request| self.request_of(request)),
            orders: Orders {
                block: self.circuits_of(block),
                unblock: self.circuits_of(unblock),
                restrict: ByName(restricted.into_iter().map(|name| (name, self.speed(speed))).collect()),
                lift: self.circuits_of(lift),
            },
            consent: self.segments_of(input.consent),
            all_telegrams: false,
        }
    }

    /// The kernel's request by its names.
    pub fn request_of(&self, request: kernel::Request) -> Request {
        use kernel::Request::{Drive, Set, Turn, Withdraw};
        let Names { routes, points, segments, .. } = &self.names;
        match request {
            Set(route) => Request::Set { set: name(routes, route.number()) },
            Withdraw(route) => Request::Withdraw { withdraw: name(routes, route.number()) },
            Drive(point, to) => Request::Drive { drive: name(points, point.number()), to: Side(to) },
            Turn(segment, to) => Request::Turn { turn: name(segments, segment.number()), to: Travel(to) },
        }
    }

    fn request(&self, request: &Request) -> Result<kernel::Request, String> {
        let route = |name: &str, field: &str| {
            let number = place(&self.names.routes, name, field, "route")?;
            RouteId::new(number).ok_or_else(|| format!("route {number} has no place"))
        };
        Ok(match request {
            Request::Set { set } => kernel::Request::Set(route(set, "set")?),
            Request::Withdraw { withdraw } => kernel::Request::Withdraw(route(withdraw, "withdraw")?),
            Request::Drive { drive, to } => {
                let number = place(&self.names.points, drive, "drive", "point")?;
                kernel::Request::Drive(
                    PointId::new(number).ok_or_else(|| format!("point {number} has no place"))?,
                    to.0,
                )
            }
            Request::Turn { turn, to } => {
                let number = place(&self.names.segments, turn, "turn", "segment")?;
                kernel::Request::Turn(
                    SegmentId::new(number).ok_or_else(|| format!("segment {number} has no place"))?,
                    to.0,
                )
            }
        })
    }

    fn orders(&self, orders: &Orders) -> Result<kernel::Orders<Z>, String> {
        let restricted: Vec<String> = orders.restrict.0.keys().cloned().collect();
        let mut speeds = orders.restrict.0.values();
        let first = speeds.next().copied().unwrap_or(0);
        if let Some(other) = speeds.find(|speed| **speed != first) {
            return Err(format!(
                "restrict has {first} and {other} km/h; the circuits of one cycle are restricted to one speed"
            ));
        }
        Ok(kernel::Orders {
            block: self.circuits(&orders.block, "block")?,
            unblock: self.circuits(&orders.unblock, "unblock")?,
            restrict: self.circuits(&restricted, "restrict")?,
            speed: self.code(first),
            lift: self.circuits(&orders.lift, "lift")?,
        })
    }

    /// The highest code whose speed is not above this one.
    fn code(&self, speed_kmh: u16) -> SpeedCode {
        let speeds = self.speeds_kmh.iter().skip(1);
        let slower = speeds.take_while(|speed| **speed > 0 && **speed <= speed_kmh).count();
        SpeedCode(u8::try_from(slower).unwrap_or(0))
    }

    /// The speed of a code; of one that the layout does not have, that of the next lower one.
    pub fn speed(&self, code: SpeedCode) -> u16 {
        self.speeds_kmh.iter().take(usize::from(code.0) + 1).copied().max().unwrap_or(0)
    }

    /// What the kernel put out in the cycle after which its memory is the one here.
    pub fn output(&self, input: kernel::Input<Z>, commands: &kernel::Commands<R, Z>, all_telegrams: bool) -> Output {
        let (output, movements) = (&commands.interlocking, &commands.telegrams);
        let silent = named(&self.names.circuits, |number| movements[number].is_none());
        let telegrams = self.names.circuits.iter().zip(movements).filter_map(|(circuit, movement)| {
            let movement = movement.filter(|movement| movement.is_open() || all_telegrams)?;
            let (stop, speed_km_h) = (name(&self.names.circuits, movement.stop.number()), self.speed(movement.speed));
            let heading = movement.heading.map(Heading);
            Some((circuit.clone(), Telegram { stop, speed_km_h, open: movement.is_open(), heading }))
        });
        Output {
            silent,
            routes: self.phases(),
            proceed: self.routes_of(output.proceed),
            drives: self.sides(output.drives),
            telegrams: telegrams.collect::<BTreeMap<_, _>>(),
            permits: self.segments_of(output.permits),
            confirmed: self.circuits_of(output.confirmed),
            answer: self.answer(input, self.counted(), output.answer),
        }
    }
}

impl<const R: usize, const P: usize, const N: usize, const S: usize, Z: Size> Machine for Interlocked<R, P, N, S, Z> {
    const NAME: &'static str = "interlocking";
    const STEP: &'static str = r#"{"occupied":["1T"],"detected":{"P1":"normal"},"request":{"set":"W-1"},"orders":{"unblock":["1T"]},"consent":["West"]}"#;
    const CONFIG: &'static str = r#"a layout as layouts/*.toml have it, as an object: {"name":"…","circuit":[…],"point":[…],"segment":[…],"route":[…]}; or {"plan":{…}}, the kernel's own terms, for the traces of models: the rules of engineering are checked only if it says "rules":true"#;

    type Config = Config;
    type Step = Step;
    type Output = Output;

    fn open(config: &Config) -> Result<Self, String> {
        let Opened { layout, names, speeds_kmh, cycle_ms, said } = config.opened()?;
        Ok(Self { said, ..Self::new(layout, names, speeds_kmh, cycle_ms) })
    }

    fn step(&mut self, step: &Step) -> Result<Output, String> {
        let input = self.input(step)?;
        let (memory, commands) = atc_kernel::Machine::step(&Combined(&self.layout), *self.memory, input);
        *self.memory = memory;
        Ok(self.output(input, &commands, step.all_telegrams))
    }

    fn cycles(&self) -> Vec<(&'static str, u16)> {
        let plan = self.layout.plan();
        vec![("clear", plan.clear.into()), ("turn", plan.turn.0)]
    }
}
