//! What may fail, and what staff may do besides what the dispatcher asks for.

use super::devices::{CIRCUITS, Times};
use super::ground::PLACES;
use super::{State, Whole};

/// A kind of fault.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Kind {
    /// A circuit is reported occupied, by every station that sees it.
    FalseOccupancy,
    /// A train is not reported.
    LostShunt,
    /// A point is not detected.
    UndetectedPoint,
    /// A point that moves stands still for a while.
    LatePoint,
    /// A transmitter repeats what it sent in the first cycle.
    StuckTransmitter,
    /// A train hears nothing.
    Interruption,
    /// A train hears the highest code.
    MisreadCode,
    /// No message of a station arrives.
    LostMessage,
    /// The message that a station sends in the first cycle arrives again and again.
    OldMessage,
    /// The device of a station starts again.
    StationStarts,
    /// The device of a train starts again.
    TrainStarts,
}

impl Kind {
    /// All of them.
    pub const ALL: [Self; 11] = [
        Self::FalseOccupancy,
        Self::LostShunt,
        Self::UndetectedPoint,
        Self::LatePoint,
        Self::StuckTransmitter,
        Self::Interruption,
        Self::MisreadCode,
        Self::LostMessage,
        Self::OldMessage,
        Self::StationStarts,
        Self::TrainStarts,
    ];

    /// Its name.
    pub const fn name(self) -> &'static str {
        match self {
            Self::FalseOccupancy => "false-occupancy",
            Self::LostShunt => "lost-shunt",
            Self::UndetectedPoint => "undetected-point",
            Self::LatePoint => "late-point",
            Self::StuckTransmitter => "stuck-transmitter",
            Self::Interruption => "interruption",
            Self::MisreadCode => "misread-code",
            Self::LostMessage => "lost-message",
            Self::OldMessage => "old-message",
            Self::StationStarts => "station-starts",
            Self::TrainStarts => "train-starts",
        }
    }

    /// For how many cycles it lasts at most.
    fn longest(self, times: Times) -> u8 {
        match self {
            Self::MisreadCode | Self::StationStarts | Self::TrainStarts => 1,
            Self::LostShunt => times.loss,
            Self::FalseOccupancy | Self::UndetectedPoint | Self::LostMessage => 3,
            Self::LatePoint | Self::StuckTransmitter | Self::Interruption | Self::OldMessage => 16,
        }
    }

    /// How many places there are for it.
    fn places(self, trains: usize) -> usize {
        match self {
            // A platform of either track is a place.
            Self::FalseOccupancy => usize::from(PLACES) + 2,
            Self::LostShunt | Self::Interruption | Self::MisreadCode | Self::TrainStarts => trains,
            Self::StuckTransmitter => 2 * CIRCUITS.len(),
            Self::UndetectedPoint | Self::LatePoint | Self::LostMessage | Self::OldMessage => 2,
            Self::StationStarts => 2 * FROM.len(),
        }
    }
}

/// A fault at work.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Fault {
    /// Its kind.
    pub kind: Kind,
    /// Where.
    pub at: u8,
    /// For how many cycles it has been there before this one.
    pub age: u8,
}

/// From which numbers a station that starts again may send its telegrams, counted from those that it sent last: its counters begin at 0, and
/// how far they had come is of no run. The same number once more, the next ones up to the last that a train takes for news, the first
/// that it does not, one that is long past, and the one before.
pub const FROM: [u8; 6] = [0, 1, 4, 5, 128, u8::MAX];

/// Requests by number: to set and to withdraw each of four routes, to drive the point either way, to turn the line either way.
pub mod request {
    use atc_kernel::interlocking::{PointId, Position, Request, RouteId, SegmentId, Travel};

    /// To set route 0; the others follow.
    pub const SET: u8 = 0;
    /// To withdraw route 0; the others follow.
    pub const WITHDRAW: u8 = 4;
    /// To drive the point to the first platform, and next to the second one.
    pub const DRIVE: u8 = 8;
    /// To turn the line toward the station.
    pub const TOWARD: u8 = 10;
    /// To turn it away.
    pub const AWAY: u8 = 11;
    /// Nothing of the station: the dispatcher changes his mind, and sends trains the other way from now on.
    pub const MIND: u8 = 12;
    /// All of them.
    pub const ALL: [u8; 13] = [0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, MIND];

    /// The request of this number.
    pub fn of(number: u8) -> Option<Request> {
        Some(match number {
            SET..WITHDRAW => Request::Set(RouteId::new(number - SET)?),
            WITHDRAW..DRIVE => Request::Withdraw(RouteId::new(number - WITHDRAW)?),
            DRIVE => Request::Drive(PointId::ZERO, Position::Normal),
            9 => Request::Drive(PointId::ZERO, Position::Reverse),
            TOWARD => Request::Turn(SegmentId::ZERO, Travel::Toward),
            AWAY => Request::Turn(SegmentId::ZERO, Travel::Away),
            _ => return None,
        })
    }
}

/// What happens in a cycle besides what the trains and the dispatcher do.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Event {
    /// The faults at work.
    pub faults: [Option<Fault>; 2],
    /// What staff ask for, by the station's number and that of the request.
    pub asked: Option<(u8, u8)>,
}

impl Event {
    /// The station that starts again, and from where it sends its telegrams: see [`FROM`].
    pub fn starts(&self, station: usize) -> Option<u8> {
        (0..FROM.len()).find(|place| self.has(Kind::StationStarts, 2 * place + station)).map(|place| FROM[place])
    }

    /// Whether a fault of this kind repeats here what was in the cycle in which it began.
    pub fn repeats(&self, kind: Kind, at: usize) -> bool {
        self.faults.iter().flatten().any(|fault| fault.kind == kind && usize::from(fault.at) == at && fault.age > 0)
    }

    /// Whether a fault of this kind is at work here.
    pub fn has(&self, kind: Kind, at: usize) -> bool {
        self.faults.iter().flatten().any(|fault| fault.kind == kind && usize::from(fault.at) == at)
    }
}

impl<const T: usize> Whole<T> {
    /// What may be at work of one fault in the next cycle: nothing, what is there already, or, where nothing is, a new one. A cycle lies
    /// between two: what is assumed of each is not assumed of both in a row.
    pub fn faults(&self, state: &State<T>, slot: usize) -> Vec<Option<Fault>> {
        let mut faults = vec![None];
        if let Some(fault) = state.faults[slot] {
            let next = Fault { age: fault.age + 1, ..fault };
            faults.extend((next.age < fault.kind.longest(self.times)).then_some(Some(next)));
        } else if state.left > 0 && slot < usize::from(self.room.together) {
            for kind in self.room.kinds {
                let there =
                    |at: &u8| !state.faults.iter().flatten().any(|other| (other.kind, other.at) == (*kind, *at));
                let places = (0..).take(kind.places(T)).filter(there);
                faults.extend(places.map(|at| Some(Fault { kind: *kind, at, age: 0 })));
            }
        }
        faults
    }

    /// What staff may ask for in the next cycle.
    pub fn asks(&self, state: &State<T>) -> Vec<Option<(u8, u8)>> {
        let mut asked = vec![None];
        if state.asks > 0 {
            let requests = |station| self.room.requests.iter().map(move |request| Some((station, *request)));
            asked.extend(self.room.asked.iter().copied().flat_map(requests));
        }
        asked
    }
}
