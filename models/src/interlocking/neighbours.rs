//! Two stations that turn the line between them, each with the kernel's device, and the telegrams between them.
//!
//! In every cycle each station sends whether it permits the other to send trains; a telegram arrives in any later cycle until its life is
//! over, or never, and in any order. Each station commands either direction, or nothing. While a station has the direction away, it sends a
//! train; the line is then occupied for both until the train has left it.

use super::sizes::circuits;
use super::trace::{Run, direction_word};
use crate::outcome::Trace;
use crate::subject::{Claim, Subject};
use atc_kernel::Machine;
use atc_kernel::distance::Metres;
use atc_kernel::interlocking::{
    CircuitSet, Directions, Element, Heading, Input, Layout, Orders, PerCircuit, Plan, Positions, Request, Route,
    Segment, SegmentId, SegmentSet, SpeedCode, State as Kernel, Track, Travel,
};
use atc_kernel::time::Ticks;
use serde_json::json;

/// The longest life of a telegram in a model.
pub const LONGEST_LIFE: u8 = 4;

type Small = Layout<2, 1, 0, 1>;

/// What a neighbour does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Neighbour {
    /// It keeps the same protocol: it is the kernel's device.
    Alike,
    /// It permits the other one to send whatever its own direction is.
    PermitsAlways,
}

/// What each station sees of the line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum View {
    /// Both see all of it.
    Whole,
    /// Each sees the part next to it, and both the middle.
    Overlapping,
    /// Each sees the half next to it, up to one joint.
    Adjoining,
    /// Each sees the part next to it, and nobody the middle.
    Apart,
}

impl View {
    /// The places of the line that each station sees, a bit each; and how many places there are.
    pub(super) const fn seen(self) -> ([u8; 2], u8) {
        match self {
            Self::Whole => ([0b1, 0b1], 1),
            Self::Overlapping => ([0b011, 0b110], 3),
            Self::Adjoining => ([0b01, 0b10], 2),
            Self::Apart => ([0b001, 0b100], 3),
        }
    }

    /// It in words, of the line.
    pub(super) const fn words(self) -> &'static str {
        match self {
            Self::Whole => "which both see",
            Self::Overlapping => "of which each sees the part next to it and both the middle",
            Self::Adjoining => "of which each sees the half next to it",
            Self::Apart => "of which each sees the part next to it and nobody the middle",
        }
    }
}

/// A train on the line.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Train {
    /// The station that sent it: 0 or 1.
    pub sender: u8,
    /// The places of the line that it stands on, from the first station's end: one, or two that follow each other.
    pub on: u8,
}

impl Train {
    /// Where it may be a cycle later: there, on the next place too, wholly on the next; or gone.
    fn moves(self, places: u8) -> Vec<Option<Self>> {
        let all = (1_u8 << places) - 1;
        let ahead = |on: u8| if self.sender == 0 { on << 1 } else { on >> 1 };
        let next = if self.on.is_power_of_two() { self.on | ahead(self.on) & all } else { self.on & ahead(self.on) };
        let leaves = self.on.is_power_of_two() && ahead(self.on) & all == 0;
        let mut moves = vec![Some(self)];
        if leaves {
            moves.push(None);
        } else {
            moves.push(Some(Self { on: next, ..self }));
        }
        moves
    }
}

/// What a model is there to show.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Purpose {
    /// Never do both stations send.
    Safe,
    /// Both do, and each of these assumptions excludes it.
    Hazard(&'static [&'static str]),
}

/// The model.
#[derive(Clone, Debug)]
pub struct Pair {
    /// The turn time of both stations, in cycles.
    pub turn: u16,
    /// For how many cycles after it was sent a telegram may still be read, up to [`LONGEST_LIFE`]; 0: only in the cycle after.
    pub life: u8,
    /// What the second station does.
    pub neighbour: Neighbour,
    /// What each sees of the line.
    pub view: View,
    /// Whether the first station has just started with a train on the line.
    pub found: bool,
    /// What the model is there to show.
    pub purpose: Purpose,
}

/// Two stations, what is on its way between them, and the line.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct State {
    /// The directions of both stations.
    pub directions: [Directions<1>; 2],
    /// For each station the permissions that it has sent, the newest first: a bit for each cycle.
    pub sent: [u8; 2],
    /// The train on the line.
    pub train: Option<Train>,
    /// Both stations send, or one sends while a train is on the line that the other has sent.
    pub against: bool,
}

/// One cycle: what each station is commanded, and which permission it reads.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Cycle {
    /// The command at each station.
    pub commands: [Option<Travel>; 2],
    /// Whether each station reads the other's permission.
    pub consent: [bool; 2],
    /// The train on the line after it.
    pub train: Option<Train>,
}

impl Pair {
    fn layout(&self) -> Small {
        let mut plan = Plan::EMPTY;
        let over = Route {
            path: [Element { circuits: circuits(1 << 1), ..Element::NONE }],
            length: 1,
            drive: Ticks(1),
            release: Ticks(1),
            stay: Ticks(1),
            speed: SpeedCode(1),
            overlap_speed: SpeedCode(1),
            ..Route::NONE
        };
        // The way in, and the way out: both stations send trains.
        plan.routes = [
            Route {
                heading: Heading::Left,
                entry: circuits(1),
                approach: circuits(1),
                beyond: circuits(1 << 2),
                from: SegmentSet::nth(0),
                ..over
            },
            Route {
                heading: Heading::Right,
                entry: circuits(1 << 2),
                approach: circuits(1 << 2),
                beyond: circuits(1),
                to: SegmentSet::nth(0),
                ..over
            },
        ];
        let throat = circuits(1 << 1);
        plan.segments =
            [Segment { circuits: [circuits(1)], length: 1, throat, outward: Heading::Right, ..Segment::NONE }];
        plan.lengths[..3].fill(Metres(100));
        plan.braking[..2].copy_from_slice(&[Metres(0), Metres(100)]);
        plan.clear = 1;
        plan.turn = Ticks(self.turn);
        Layout::new(plan).expect("a layout that keeps every rule")
    }

    fn input(&self, cycle: Cycle, station: usize) -> Input {
        let turn = |travel| Request::Turn(SegmentId::ZERO, travel);
        Input {
            occupied: circuits(u8::from(cycle.train.is_some_and(|train| train.on & self.view.seen().0[station] != 0))),
            detected: Positions::NONE,
            request: cycle.commands[station].map(turn),
            orders: Orders::default(),
            consent: SegmentSet::nth(0).only_if(cycle.consent[station]),
        }
    }

    fn kernel(layout: &Small, directions: Directions<1>) -> Kernel<2, 1> {
        let mut state = layout.initial();
        state.track = Track::from_parts(PerCircuit::all(1));
        state.works.blocked = CircuitSet::EMPTY;
        state.directions = directions;
        state
    }

    /// The cycle before the model begins, in which everything is unblocked, with a train on the line or none.
    fn unblocking(&self, train: Option<Train>) -> Input {
        let orders = Orders { unblock: CircuitSet::ALL, ..Orders::default() };
        let quiet = Cycle { commands: [None; 2], consent: [false; 2], train };
        Input { orders, ..self.input(quiet, 0) }
    }

    /// The state after it.
    fn begin(&self, layout: &Small) -> Kernel<2, 1> {
        layout.cycle(layout.initial(), self.unblocking(None)).0
    }

    /// Whether a station has the direction away from it.
    fn sends(directions: Directions<1>) -> bool {
        !directions.away.is_empty()
    }
}

impl Subject for Pair {
    type State = State;
    type Action = Cycle;

    fn initial(&self) -> Vec<State> {
        let started = self.begin(&self.layout()).directions;
        let none = State { directions: [started; 2], sent: [0; 2], train: None, against: false };
        if !self.found {
            return vec![none];
        }
        let it = SegmentSet::nth(0);
        let toward = Directions { toward: it, came: it, withdrawn: [Ticks(0)], ..started };
        let away = Directions { away: it, withdrawn: [Ticks(self.turn)], ..started };
        let living = u8::MAX >> (7 - self.life);
        // The other station as it was, and the permissions that are on their way: to whoever sent the train, and from that one no more.
        let others =
            [(0, toward, [0, living]), (0, started, [0, living]), (1, away, [living, 0]), (1, started, [living, 0])];
        let places = self.view.seen().1;
        let on = (1..1_u8 << places).filter(|on| on.is_power_of_two() || (on / (on & on.wrapping_neg())) == 0b11);
        let states = others.map(|(sender, other, sent)| (sender, State { directions: [started, other], sent, ..none }));
        on.flat_map(|on| states.map(|(sender, state)| State { train: Some(Train { sender, on }), ..state })).collect()
    }

    fn actions(&self, state: &State, cycles: &mut Vec<Cycle>) {
        if state.against {
            return;
        }
        let commands = [None, Some(Travel::Toward), Some(Travel::Away)];
        let read =
            |sender: usize| -> &'static [bool] { if state.sent[sender] == 0 { &[false] } else { &[false, true] } };
        let places = self.view.seen().1;
        let trains = if let Some(train) = state.train {
            train.moves(places)
        } else {
            let sent = |sender: u8| Some(Train { sender, on: if sender == 0 { 1 } else { 1 << (places - 1) } });
            let senders = (0..2).filter(|sender| Self::sends(state.directions[usize::from(*sender)]));
            [None].into_iter().chain(senders.map(sent)).collect()
        };
        for first in commands {
            for second in commands {
                for by_first in read(1) {
                    for by_second in read(0) {
                        cycles.extend(trains.iter().map(|train| Cycle {
                            commands: [first, second],
                            consent: [*by_first, *by_second],
                            train: *train,
                        }));
                    }
                }
            }
        }
    }

    fn next(&self, state: &State, cycle: &Cycle) -> Option<State> {
        let layout = self.layout();
        let mut after = State { train: cycle.train, ..*state };
        let living = u8::MAX >> (7 - self.life);
        for station in 0..2 {
            let before = Self::kernel(&layout, state.directions[station]);
            let (next, output) = layout.cycle(before, self.input(*cycle, station));
            after.directions[station] = next.directions;
            let always = station == 1 && self.neighbour == Neighbour::PermitsAlways;
            let permits = always || !output.permits.is_empty();
            after.sent[station] = (state.sent[station] << 1 | u8::from(permits)) & living;
        }
        let met = after.train.is_some_and(|train| Self::sends(after.directions[usize::from(1 - train.sender)]));
        after.against = met || after.directions.into_iter().all(Self::sends);
        Some(after)
    }

    fn claims(&self) -> Vec<Claim<Self>> {
        let mut claims = vec![
            Claim::<Self>::always("valid", "both devices' states keep their invariant", |m, s| {
                s.directions.iter().all(|directions| directions.is_valid(Ticks(m.turn)))
            }),
            Claim::<Self>::sometimes("first-sends", "the first station sends", |_, s| Self::sends(s.directions[0])),
            Claim::<Self>::sometimes("train", "a train is on the line", |_, s| s.train.is_some()),
        ];
        match self.purpose {
            Purpose::Safe => {
                claims.push(Claim::<Self>::always(
                    "never-both-away",
                    "never do both stations send into the line, nor one while a train of the other is on it",
                    |_, s| !s.against,
                ));
                claims.push(Claim::<Self>::sometimes("second-sends", "the second station sends", |_, s| {
                    Self::sends(s.directions[1])
                }));
            }
            Purpose::Hazard(excluded_by) => claims.push(Claim::<Self>::hazard(
                "both-away",
                "both stations send into the line, or one while a train of the other is on it",
                excluded_by,
                |_, s| s.against,
            )),
        }
        claims
    }

    fn parameters(&self) -> String {
        format!(
            "two stations, one line, {}; turn time {} cycles, telegrams live for {} cycles",
            self.view.words(),
            self.turn,
            self.life
        )
    }

    /// The run of the first station's kernel, the cycle included in which it is unblocked. The further words of a step: what the second one does.
    fn trace(&self, path: &[(State, Option<Cycle>)]) -> Trace {
        let layout = self.layout();
        let mut run = Run::begin("line", &["line", "way in", "beyond"], &layout);
        run.step(&self.unblocking(path.first().and_then(|(state, _)| state.train)), json!({"hazard": false}));
        for (place, (_, cycle)) in path.iter().enumerate() {
            let (Some(cycle), Some((after, _))) = (cycle, path.get(place + 1)) else { break };
            let turn = |travel| run.request(Request::Turn(SegmentId::ZERO, travel));
            let words = json!({
                "direction": direction_word(&after.directions[0]),
                "neighbour_command": cycle.commands[1].map(turn),
                "neighbour_consent": cycle.consent[1],
                "neighbour_direction": direction_word(&after.directions[1]),
                "hazard": after.against,
            });
            run.step(&self.input(*cycle, 0), words);
        }
        run.trace()
    }
}
