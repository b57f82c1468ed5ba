//! The on-board device as one machine, from what the antennas give to the brake.
//!
//! The parts are machines of their own: code and acceptance ([`crate::aspect`]), telegrams and permitted speed
//! ([`crate::permitted`]), position and supervision. Here they are put together once, so that nobody has to do it again: no
//! code is used that was not accepted, no rank without its table, no distance in another section than its own.
//!
//! Requirements: `spec/train.md`, TRN-1 to TRN-13. Read in this order: [`Parts`] and [`Train`] (parameters), [`Antennas`],
//! [`Cab`], [`State`] with its `is_valid`, and the step: [`State::facing`], [`Train::receive`], then [`Train::act`].

mod parameters;

pub use parameters::{Parts, Train, TrainError};

use crate::Machine;
use crate::aspect::{self, AspectSet, Display};
use crate::code::Millihertz;
use crate::distance::Millimetres;
use crate::heading::Heading;
use crate::permitted::{self, Heard, LineKind, Permission, Permitted};
use crate::position::{self, Interval, Measured, Millibels, Moved};
use crate::speed::{KmhTenths, RawKmhTenths};
use crate::supervision::{self, Brake, Speeds};
use crate::telegram::{Frame, Main, SectionId, Sub, Telegram, decode};

/// What is received on one carrier in one cycle.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Carrier {
    /// The code frequency, measured throughout the cycle; `None`: there is none.
    pub code: Option<Millihertz>,
    /// The frame whose last bit came in this cycle.
    pub frame: Option<Frame>,
}

/// What the antennas, the odometer, the speed generator and the balises give in one cycle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Antennas {
    /// The main carrier.
    pub main: Carrier,
    /// The sub carrier.
    pub sub: Carrier,
    /// The level of the signal that the rail attenuates less; `None`: it is not heard.
    pub first: Option<Millibels>,
    /// The level of the signal that the rail attenuates more; `None`: it is not heard.
    pub second: Option<Millibels>,
    /// How far the train moved since the last cycle; `None`: the odometer says nothing.
    pub moved: Option<Moved>,
    /// The measured speed; missing, negative or above the maximum is implausible.
    pub speed: Option<RawKmhTenths>,
    /// The kind of line that begins here, if the train is told of one in this cycle.
    pub line: Option<LineKind>,
    /// The direction of travel in which the train faces, by the cab that is taken and by how the train stands on the line;
    /// `None`: it is not known.
    pub facing: Option<Heading>,
}

/// What was received, in the terms of the line: [`Antennas`] as [`Train::receive`] reads them. Nothing of it is accepted yet.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Received {
    /// The aspect whose code was detected: one or none.
    pub detected: AspectSet,
    /// The telegram of the main carrier, with a rank that the line has.
    pub main: Option<Main>,
    /// The telegram of the sub carrier, with ranks that the line has.
    pub sub: Option<Sub>,
    /// The two levels and the movement.
    pub measured: Measured,
    /// The measured speed.
    pub speed: Option<RawKmhTenths>,
    /// The kind of line that begins here.
    pub line: Option<LineKind>,
}

/// What the device shows and commands in one cycle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Cab {
    /// The speed of the displayed aspect; `None`: nothing is displayed.
    pub display: Option<KmhTenths>,
    /// The permitted speed, and what it rests on.
    pub permission: Permission,
    /// Where the front is: the distance to the exit of the section whose signal is heard; `None`: unknown.
    pub position: Option<Interval>,
    /// The brake command.
    pub brake: Brake,
}

impl Cab {
    /// Nothing displayed, nothing permitted, nothing known, and the emergency brake.
    pub const STOP: Self = Self { display: None, permission: Permitted::SAFE, position: None, brake: Brake::Emergency };
}

/// What the device remembers: the states of its parts.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct State<const N: usize> {
    /// Of aspect acceptance.
    pub acceptance: aspect::State<N>,
    /// Of the permitted speed.
    pub permitted: permitted::State,
    /// Of the position: the interval of the last cycle.
    pub position: Option<Interval>,
    /// Of the supervision: the last brake command.
    pub brake: Brake,
    /// The direction of travel that all this is of.
    pub facing: Option<Heading>,
}

impl<const N: usize> State<N> {
    /// Nothing heard and nothing known, under the emergency brake.
    pub const INITIAL: Self = Self {
        acceptance: aspect::State::INITIAL,
        permitted: permitted::State::INITIAL,
        position: None,
        brake: Brake::Emergency,
        facing: None,
    };

    /// What is remembered by a train that now faces so: nothing, if it faced otherwise.
    #[must_use]
    pub fn facing(self, facing: Option<Heading>) -> Self {
        //= spec/train.md#trn-12-changing-ends
        //# A device that learns of another direction of travel than before, or that its direction is no longer known, MUST begin anew.
        if self.facing == facing { self } else { Self { facing, ..Self::INITIAL } }
    }

    /// Whether `train` can be in this state: each part is in a valid one, and a train that measures no position has none.
    pub fn is_valid(&self, train: &Train<N>) -> bool {
        self.acceptance.is_valid(train.parts().acceptance.times)
            && self.permitted.is_valid(&train.parts().permitted)
            && (train.parts().position.is_some() || self.position.is_none())
    }

    /// The section of the last main telegram with a known rank; `None` if there is none, or it is forgotten.
    pub fn section(&self) -> Option<SectionId> {
        self.permitted.main_stream.last.map(|last| last.section)
    }
}

/// One cycle.
pub fn step<const N: usize>(train: &Train<N>, state: State<N>, antennas: Antennas) -> (State<N>, Cab) {
    train.act(state.facing(antennas.facing), train.receive(antennas))
}

impl<const N: usize> Train<N> {
    /// Reads what the antennas give: codes become an aspect, frames telegrams of their carrier.
    pub fn receive(&self, antennas: Antennas) -> Received {
        Received {
            detected: self.detect(antennas.main.code, antennas.sub.code),
            main: self.main(antennas.main.frame).filter(|main| is_for(main.section, antennas.facing)),
            sub: self.sub(antennas.sub.frame).filter(|sub| is_for(sub.section, antennas.facing)),
            measured: Measured {
                first: antennas.first,
                second: antennas.second,
                //= spec/train.md#trn-6-the-movement
                //# Without an odometer the train MUST be taken to have moved as far as can be said, either way.
                moved: antennas.moved.unwrap_or(Moved::ANY),
            },
            speed: antennas.speed,
            line: antennas.line,
        }
    }

    /// One cycle from what was received: acceptance, position, permitted speed, brake.
    pub fn act(&self, state: State<N>, received: Received) -> (State<N>, Cab) {
        let parts = self.parts();
        let (acceptance, displayed) = parts.acceptance.step(state.acceptance, received.detected);
        let display = self.speed(displayed);
        let position = self.locate(state, received.main, received.measured);
        let heard = Heard {
            line: received.line,
            //= spec/train.md#trn-2-the-accepted-code
            //# The analog code MUST be the speed of the displayed aspect in the line's table, and none if nothing is displayed.
            analog: display,
            main: received.main,
            sub: received.sub,
            //= spec/train.md#trn-4-the-nearest-end
            //# The distance to the exit MUST be the nearest end of the position's interval, and none if the position is unknown.
            to_exit: position.map(Interval::nearest),
            moved: forward(received.measured.moved),
        };
        let (permitted, permission) = parts.permitted.step(state.permitted, heard);
        let speeds = Speeds {
            measured: received.speed,
            //= spec/train.md#trn-7-the-brake
            //# The measured speed MUST be supervised against the permission of the same cycle, and no permission MUST command the emergency brake.
            permitted: permission.speed.map(|speed| RawKmhTenths(i32::from(speed.0))),
        };
        let supervised = supervision::step(parts.supervision, state.brake, speeds);
        //= spec/train.md#trn-13-a-train-that-is-to-stand
        //# While no speed above 0 is permitted, the brake MUST be commanded, also at a stand.
        let brake = if permission.speed == Some(KmhTenths(0)) { supervised.max(Brake::Service) } else { supervised };
        (
            State { acceptance, permitted, position, brake, facing: state.facing },
            Cab { display, permission, position, brake },
        )
    }

    /// The aspect whose code the two frequencies are, as a set of one; empty if they are of none.
    fn detect(&self, main: Option<Millihertz>, sub: Option<Millihertz>) -> AspectSet {
        //= spec/train.md#trn-1-the-detected-aspect
        //# The aspect whose speed the two code frequencies name MUST count as detected, and no other.
        let aspect = self.parts().codes.heard(main, sub).and_then(|speed| self.speeds().aspect(speed));
        aspect.map_or(AspectSet::EMPTY, |aspect| AspectSet::EMPTY.with(aspect))
    }

    /// The telegram of the main carrier.
    fn main(&self, frame: Option<Frame>) -> Option<Main> {
        //= spec/train.md#trn-3-the-carrier
        //# A frame MUST be treated as not received unless it is a main telegram on the main carrier or a sub telegram on the sub carrier, with ranks that are in the line's table.
        match frame.map(decode) {
            Some(Ok(Telegram::Main(main))) if self.speeds().speed(main.speed).is_some() => Some(main),
            _ => None,
        }
    }

    /// The telegram of the sub carrier.
    fn sub(&self, frame: Option<Frame>) -> Option<Sub> {
        let known = |rank| self.speeds().speed(rank).is_some();
        match frame.map(decode) {
            Some(Ok(Telegram::Sub(sub))) if known(sub.curve) && known(sub.restriction) => Some(sub),
            _ => None,
        }
    }

    /// The speed of the displayed aspect; `None` if nothing is displayed, or memory has an aspect that the line has not.
    fn speed(&self, displayed: Display) -> Option<KmhTenths> {
        displayed.aspect().and_then(|aspect| self.speeds().speed(aspect))
    }

    /// The position, of the section whose signal is heard in this cycle.
    fn locate(&self, state: State<N>, main: Option<Main>, measured: Measured) -> Option<Interval> {
        let device = self.parts().position.as_ref()?;
        //= spec/train.md#trn-5-the-section-of-a-distance
        //# The interval of the cycle before MUST be forgotten in a cycle with a main telegram of another section than the last one, or with no last one.
        let other = main.is_some_and(|main| state.section().is_none_or(|last| last.0 != main.section.0));
        position::step(device, if other { None } else { state.position }, measured)
    }
}

/// Whether a telegram of this section is for a train that faces so.
fn is_for(section: SectionId, facing: Option<Heading>) -> bool {
    //= spec/train.md#trn-11-the-direction-of-travel
    //# A telegram of a section whose number is for the other direction of travel MUST be treated as not received, and so MUST any telegram while the direction is not known.
    facing == Some(section.heading())
}

/// How far the train can have moved towards the exit.
fn forward(moved: Moved) -> Millimetres {
    //= spec/train.md#trn-9-forward
    //# The movement to take off a distance MUST be the most that the odometer allows, and 0 if that is backwards.
    let most = moved.most();
    if most > 0 { Millimetres(u32::from(most.unsigned_abs())) } else { Millimetres(0) }
}

impl<const N: usize> Machine for Train<N> {
    type State = State<N>;
    type Input = Antennas;
    type Output = Cab;

    const SAFE: Cab = Cab::STOP;

    fn initial(&self) -> State<N> {
        State::INITIAL
    }

    fn step(&self, state: State<N>, antennas: Antennas) -> (State<N>, Cab) {
        step(self, state, antennas)
    }
}
