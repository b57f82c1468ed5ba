//! A station with trains: what happens in a cycle, and what the kernel makes of it.
//!
//! In one cycle points and trains move, each as the last cycle's drives, signals and telegrams let it; then the kernel reads what is
//! occupied and detected, and one request or one order of staff, or nothing.

use super::device::Device;
use super::environment::{Detection, Drives, Environment, Obey, TRAINS};
use super::ground::{Blade, Station};
use super::purpose::Purpose;
use super::sizes::{CIRCUITS, POINTS, ROUTES, circuits};
use super::train::{Fate, Place, Train};
use ahash::AHashSet;
use atc_kernel::interlocking::{
    self as kernel, CircuitSet, Input, Orders, Output, PointSet, Position, Positions, Request, SegmentSet, Travel,
};
use std::sync::{Arc, OnceLock};

pub(super) use super::state::mask;
pub use super::state::{Cycle, Harm, Kept, RESTRICTED, Shown, State};

mod judge;
mod subject;

/// The model: a station, the device `D` in it, and its environment.
#[derive(Clone, Debug)]
pub struct Yard<D> {
    /// The machine.
    pub device: D,
    /// The station.
    pub station: Station,
    /// What may happen.
    pub environment: Environment,
    /// What the model is there to show.
    pub purpose: Purpose,
    pub(super) doomed: Doomed,
}

/// The states from which not every train can arrive, once somebody has asked; `None` if there are too many to know.
#[derive(Clone, Debug, Default)]
pub(super) struct Doomed(pub(super) Arc<OnceLock<Option<AHashSet<State>>>>);

impl<D: Device> Yard<D> {
    /// A model.
    pub fn new(device: D, station: Station, environment: Environment, purpose: Purpose) -> Self {
        Self { device, station, environment, purpose, doomed: Doomed::default() }
    }

    /// What the machine reads before the model begins: circuits are unblocked and restrictions lifted until everything counts as clear, then
    /// the requests of the environment, one a cycle.
    ///
    /// A device that finds trains when it starts is unblocked at once.
    pub(super) fn prelude(&self) -> Vec<Input> {
        let plan = self.station.layout.plan();
        let all = CircuitSet::ALL;
        let orders = Orders { unblock: all, lift: all, ..Orders::default() };
        let quiet = Input {
            occupied: CircuitSet::EMPTY,
            detected: detected(self.environment.blades),
            request: None,
            orders: Orders::default(),
            consent: SegmentSet::ALL,
        };
        if self.environment.found {
            let there = self.environment.trains.iter().fold(0, |all, train| all | 1 << train.at);
            return vec![Input { occupied: circuits(there), orders, ..quiet }];
        }
        let cycles = u16::from(plan.clear).max(plan.turn.0);
        let requests = self.environment.before.iter().map(|request| Input { request: Some(*request), ..quiet });
        std::iter::repeat_n(Input { orders, ..quiet }, usize::from(cycles)).chain(requests).collect()
    }

    /// The calling-on routes: a mask.
    fn calls(&self) -> u8 {
        let routes = (0..).zip(&self.station.layout.plan().routes);
        routes.filter(|(_, route)| route.calling_on).fold(0, |all, (number, _)| all | 1 << number)
    }

    /// What points may do in a cycle.
    fn blades(&self, state: &State) -> Vec<[Blade; POINTS]> {
        let mut ways = vec![state.blades];
        for point in 0..POINTS {
            let it = PointSet::nth(point);
            let driven = |drives: Positions| {
                let wanted = |set: PointSet, position| set.meets(it).then_some(position);
                wanted(drives.normal, Position::Normal).or(wanted(drives.reverse, Position::Reverse))
            };
            let (now, before) = (driven(state.shown.drives), driven(state.shown.drives_before));
            let next = blade_after(state.blades[point], now, before, self.environment.drives);
            ways = ways
                .iter()
                .flat_map(|way| {
                    next.iter().map(move |blade| {
                        let mut way = *way;
                        way[point] = *blade;
                        way
                    })
                })
                .collect();
        }
        ways
    }

    /// What trains may do in a cycle.
    fn trains(&self, state: &State) -> Vec<([Train; TRAINS], Fate)> {
        let ground = &self.station.ground;
        let mut ways = vec![(state.trains, Fate::Sound)];
        for (number, train) in state.trains.iter().enumerate() {
            let mut next = train.moves(ground, &self.environment, state.blades, state.shown.fallen);
            if let Some(there) = self.appears(state, number) {
                next.push((there, Fate::Sound));
            }
            ways = ways
                .iter()
                .flat_map(|(way, fate)| {
                    next.iter().map(move |(train, its)| {
                        let mut way = *way;
                        way[number] = *train;
                        (way, if *its == Fate::Sound { *fate } else { *its })
                    })
                })
                .collect();
        }
        ways
    }

    /// The train that comes into the model, if its way in is free and it is permitted.
    fn appears(&self, state: &State, number: usize) -> Option<Train> {
        let start = self.environment.trains.get(number)?;
        let train = state.trains[number];
        if train.place != Place::Coming {
            return None;
        }
        let permitted = start
            .segment
            .is_none_or(|segment| state.shown.since_permit[usize::from(segment)] <= self.environment.permission_lives);
        let first = self.environment.trains[..number]
            .iter()
            .zip(&state.trains)
            .all(|(earlier, train)| earlier.at != start.at || train.place != Place::Coming);
        let free = state.trains.iter().all(|other| other.occupies() >> start.at & 1 == 0);
        let place = Place::Here { front: start.at, rear: start.at };
        (permitted && first && free).then_some(Train { place, ..train })
    }

    /// What circuits may be reported, and the trains with the cycles for which theirs were not.
    /// A train that has just come is reported: it has been heard on the line before.
    fn heard(&self, before: &[Train; TRAINS], trains: &[Train; TRAINS]) -> Vec<(u8, [Train; TRAINS])> {
        let longest = self.environment.unheard;
        let mut ways = vec![(0, *trains)];
        for (number, train) in trains.iter().enumerate() {
            let Place::Here { front, rear } = train.place else { continue };
            let mut next = Vec::new();
            let most = if before[number].place == Place::Coming { 1 } else { 4_u8 };
            for silent in 0..most {
                let count = |end: usize| if silent >> end & 1 == 1 { train.unheard[end] + 1 } else { 0 };
                let unheard = if front == rear { [count(0); 2] } else { [count(0), count(1)] };
                let elsewhere = (0..).zip([front, rear]).any(|(end, circuit): (u8, u8)| {
                    silent >> end & 1 == 1 && self.environment.unheard_in >> circuit & 1 == 0
                });
                let one_circuit = front != rear || silent >> 1 == silent & 1;
                if unheard.iter().any(|count| *count > longest) || elsewhere || !one_circuit {
                    continue;
                }
                let end = |end: u8, circuit: u8| if silent >> end & 1 == 1 { 0 } else { 1_u8 << circuit };
                next.push((end(0, front) | end(1, rear), unheard));
            }
            ways = ways
                .iter()
                .flat_map(|(reported, way)| {
                    next.iter().map(move |(more, unheard)| {
                        let mut way = *way;
                        way[number].unheard = *unheard;
                        (reported | more, way)
                    })
                })
                .collect();
        }
        ways
    }

    /// What circuits may be reported without a train.
    fn falsely(&self) -> Vec<u8> {
        (0..=self.environment.falsely).filter(|set| set & !self.environment.falsely == 0).collect()
    }

    /// Where the neighbours may consent.
    fn consents(&self, state: &State) -> Vec<SegmentSet> {
        let all = SegmentSet::from_bits(!state.shown.permits);
        if self.environment.staff_beyond.is_some() { vec![all, SegmentSet::EMPTY] } else { vec![all] }
    }

    /// What may be detected of the points.
    fn detections(&self, blades: [Blade; POINTS]) -> Vec<Positions> {
        let all = detected(blades);
        match self.environment.detection {
            Detection::True => vec![all],
            Detection::MayFail => {
                let without = |point: usize| all.without(PointSet::nth(point));
                std::iter::once(all).chain((0..POINTS).map(without).filter(|some| *some != all)).collect()
            }
            Detection::Early => {
                let rest = blades.map(|blade| match blade.heads_for() {
                    Position::Normal => Blade::Normal,
                    Position::Reverse => Blade::Reverse,
                });
                vec![detected(rest)]
            }
        }
    }

    /// What may be requested and ordered: requests that would change nothing are left out.
    fn commands(&self, state: &State) -> Vec<(Option<Request>, Orders)> {
        let mut commands = vec![(None, Orders::default())];
        for request in &self.environment.requests {
            let of = |route: kernel::RouteId| state.kept.routes[usize::from(route.number())];
            let sensible = match *request {
                Request::Set(route) => !of(route).is_held() || of(route).may_resume(),
                Request::Withdraw(route) => of(route).is_held(),
                Request::Drive(point, position) => state.blades[usize::from(point.number())].rests() != Some(position),
                Request::Turn(segment, travel) => match travel {
                    Travel::Toward => !state.kept.directions.toward.has(segment),
                    Travel::Away => !state.kept.directions.away.has(segment),
                },
            };
            if sensible {
                commands.push((Some(*request), Orders::default()));
            }
        }
        let quiet = Orders::default();
        for circuit in 0..CIRCUITS {
            let it = CircuitSet::nth(circuit);
            let has = |set: u8| set >> circuit & 1 == 1;
            if has(self.environment.blocks) {
                let order = Orders { block: it, ..quiet };
                commands.push((None, if has(state.kept.blocked) { Orders { unblock: it, ..quiet } } else { order }));
            }
            if has(self.environment.restricts) {
                let order = Orders { restrict: it, speed: RESTRICTED, ..quiet };
                commands.push((None, if has(state.kept.restricted) { Orders { lift: it, ..quiet } } else { order }));
            }
        }
        commands
    }

    /// Counts for how long permissions and proceed aspects have ended.
    fn since(&self, shown: &mut Shown) {
        for (segment, since) in shown.since_permit.iter_mut().enumerate() {
            let permitted = shown.permits >> segment & 1 == 1;
            *since = if permitted { 0 } else { (*since + 1).min(self.environment.permission_lives + 1) };
        }
        if self.environment.obey == Obey::Telegrams {
            for (signal, fallen) in self.station.ground.signals.iter().zip(&mut shown.fallen) {
                let shows = signal.routes & shown.proceed != 0;
                *fallen = if shows { 0 } else { (*fallen + 1).min(self.environment.residual + 1) };
            }
        }
    }

    /// The routes that are asked for after a cycle.
    fn asked(before: u8, request: Option<Request>, output: &Output<ROUTES>, after: &Kept) -> u8 {
        let held =
            (0..).zip(&after.routes).filter(|(_, route)| route.is_held()).fold(0, |all, (number, _)| all | 1 << number);
        let asked = match request.filter(|_| output.answer == Some(Ok(()))) {
            Some(Request::Set(route)) => before | 1 << route.number(),
            Some(Request::Withdraw(route)) => before & !(1 << route.number()),
            _ => before,
        };
        asked & held
    }

    /// Counts for how long the neighbours' consent has ended where they may not send themselves. Their staff step onto a line that is clear.
    fn since_consent(&self, shown: &mut Shown, cycle: &Cycle) {
        let Some(wait) = self.environment.staff_beyond else { return };
        let running = cycle.input.consent.or(SegmentSet::from_bits(shown.permits));
        let all = cycle.trains.iter().fold(0, |all, train| all | train.occupies());
        let segments = self.station.layout.plan().segments.iter();
        for ((number, segment), since) in segments.enumerate().zip(&mut shown.since_consent) {
            let clear = mask(segment.all()) & all == 0;
            *since = match *since {
                _ if running.meets(SegmentSet::nth(number)) => 0,
                since if since < wait || since == wait && clear => since + 1,
                since => since,
            };
        }
    }
}

/// What a point may do in a cycle, driven to `now`, and to `before` in the cycle before.
fn blade_after(blade: Blade, now: Option<Position>, before: Option<Position>, drives: Drives) -> Vec<Blade> {
    let toward = |position| match position {
        Position::Normal => Blade::ToNormal,
        Position::Reverse => Blade::ToReverse,
    };
    let at = |position| match position {
        Position::Normal => Blade::Normal,
        Position::Reverse => Blade::Reverse,
    };
    let target = now.or(if drives == Drives::AfterTheDrive { before } else { None });
    match (blade.rests(), target) {
        (Some(position), Some(wanted)) if wanted != position => match drives {
            Drives::Prompt => vec![toward(wanted)],
            Drives::Late | Drives::AfterTheDrive => vec![blade, toward(wanted)],
        },
        (Some(_), _) => vec![blade],
        (None, wanted) => {
            let arrived = at(blade.heads_for());
            match wanted {
                Some(wanted) if wanted != blade.heads_for() => vec![blade, toward(wanted)],
                _ if drives == Drives::Prompt => vec![arrived],
                _ => vec![blade, arrived],
            }
        }
    }
}

/// What is detected of points.
pub(super) fn detected(blades: [Blade; POINTS]) -> Positions {
    let mut all = Positions::NONE;
    for (point, blade) in blades.iter().enumerate() {
        match blade {
            Blade::Normal => all.normal = all.normal.or(PointSet::nth(point)),
            Blade::Reverse => all.reverse = all.reverse.or(PointSet::nth(point)),
            Blade::ToNormal | Blade::ToReverse => {}
        }
    }
    all
}
