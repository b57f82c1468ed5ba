//! The whole line: two stations with the kernel's whole device each, and trains with the kernel's whole device, on whole metres.
//!
//! Nothing is left out between rail and brake: what is detected goes into [`atc_kernel::wayside`], the frames and codes that it puts out go
//! into [`atc_kernel::train`], and what that commands brakes the train. There is one kind of driver: he gains speed in every cycle in which
//! his brake is released. A dispatcher sends the trains to and fro, for ever.
//!
//! What a run can come to is finite because states that differ by nothing but when they are reached are one ([`shift`]).

mod cycle;
pub mod devices;
mod dispatcher;
pub mod faults;
pub mod ground;
pub mod shift;
pub mod station;
mod subject;
mod trace;

use atc_kernel::Machine as _;
use atc_kernel::heading::Heading;
use atc_kernel::train::State as Device;
use atc_kernel::wayside::{Message, Transmission};
use devices::{Ground, GroundState, OnBoard, Times};
use faults::{Fault, Kind};
use ground::{Blade, Body, Harm};
use station::{Read, Station};

/// For how many cycles a train may pass a signal after it fell: what a telegram lives, and braking.
const RUNS_ON: u8 = 14;

/// Longer than that.
const TOO_LONG: u8 = RUNS_ON + 1;

/// A train with its device.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Train {
    /// As a body.
    pub body: Body,
    /// What its device remembers.
    pub device: Device<3>,
    /// Cycles since the signal in front of it showed proceed; one more than the residual running if it did not.
    pub since: u8,
}

impl Train {
    /// A train at a stand whose device has just started.
    const fn at_a_stand(body: Body) -> Self {
        Self { body, device: Device::INITIAL, since: TOO_LONG }
    }
}

/// What is repeated while a fault lasts.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Held {
    /// Nothing.
    Nothing,
    /// What a transmitter sends.
    Air(Option<Transmission>),
    /// What a station has said.
    Said(Option<Message>),
}

/// The line at one moment.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct State<const T: usize> {
    /// The devices of both stations, from the west.
    pub stations: [GroundState; 2],
    /// What each has said last.
    pub said: [Option<Message>; 2],
    /// The point of each station.
    pub blades: [Blade; 2],
    /// The trains.
    pub trains: [Train; T],
    /// The way that the dispatcher sends trains.
    pub bound: Heading,
    /// The train that has left a platform last.
    pub last: u8,
    /// For trains of which direction of travel the frames of the next cycle are: each in its turn.
    pub turn: Heading,
    /// The faults that were at work in the last cycle.
    pub faults: [Option<Fault>; 2],
    /// What each repeats.
    pub held: [Held; 2],
    /// How many faults may still begin.
    pub left: u8,
    /// How often staff may still ask for something.
    pub asks: u8,
    /// What has gone wrong.
    pub harm: Harm,
}

/// What a model is there to show.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Purpose {
    /// Nothing goes wrong.
    Safe,
    /// Something does, and each of these assumptions excludes it.
    Hazard(&'static [&'static str]),
}

/// What may happen in a run, besides what the trains and the dispatcher do.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Room {
    /// What may fail.
    pub kinds: &'static [Kind],
    /// How many faults begin.
    pub faults: u8,
    /// How many of them may be there at once: up to 2.
    pub together: u8,
    /// What staff may ask for, by number.
    pub requests: &'static [u8],
    /// The stations that they ask.
    pub asked: &'static [u8],
    /// How often they ask.
    pub asks: u8,
}

impl Room {
    /// What may fail, in words.
    pub fn words(&self) -> String {
        self.kinds.iter().map(|kind| kind.name()).collect::<Vec<_>>().join(", ")
    }
}

/// The model, of two or three trains.
#[derive(Clone, Debug)]
pub struct Whole<const T: usize> {
    stations: [Station; 2],
    on_board: OnBoard,
    /// Its times.
    pub times: Times,
    /// What may happen.
    pub room: Room,
    /// What it is there to show.
    pub purpose: Purpose,
}

/// What the trains and the stations make of a cycle.
pub struct Made<const T: usize> {
    /// The state after it.
    pub after: State<T>,
    /// The devices of the stations before it.
    pub begun: [GroundState; 2],
    /// What the stations read.
    pub read: [Read; 2],
}

impl<const T: usize> Whole<T> {
    /// A model with these times, faults and purpose.
    ///
    /// # Panics
    /// If a device breaks a rule; a test builds every model.
    pub fn new(times: Times, room: Room, purpose: Purpose) -> Self {
        let stations = [0, 1].map(|station| Station::new(devices::ground(station, times)));
        Self { stations, on_board: devices::on_board(times), times, room, purpose }
    }

    /// The device of a station.
    pub const fn ground(&self, station: usize) -> &Ground {
        self.stations[station].device()
    }

    /// Before the first cycle: every device starts, a train stands at each station, and the third one at the western.
    pub fn begin(&self) -> State<T> {
        let train = |station, track| Train::at_a_stand(Body::standing(station, track));
        State {
            stations: [0, 1].map(|station| self.ground(station).initial()),
            said: [None; 2],
            blades: [Blade { to: 0, moves: 0 }; 2],
            trains: std::array::from_fn(|number| [train(0, 0), train(1, 1), train(0, 1)][number]),
            bound: Heading::Right,
            last: u8::MAX,
            turn: Heading::Left,
            faults: [None; 2],
            held: [Held::Nothing; 2],
            left: self.room.faults,
            asks: self.room.asks,
            harm: Harm::None,
        }
    }
}
