//! Telegrams of the train control signal: frames, their check, and the counter (JP4845985B2).
//!
//! The ground sends two streams of telegrams, one on each carrier: *main* telegrams say what changes (how far the line is
//! free, the speed), *sub* telegrams what does not (the section's length, gradient and limits). A telegram is sent as a
//! [`Frame`] of [`FRAME_BITS`] bits. What is not exactly the frame of a telegram is no telegram: nothing is corrected and
//! nothing is guessed.
//!
//! Requirements: `spec/telegram.md`, TEL-1 to TEL-7. Read in this order: [`Telegram`] and its two kinds, [`Frame`]
//! ([`encode`], [`decode`]), [`Deframer`], which finds frames in a stream of bits, [`Sequence`], which tells a stream of
//! fresh telegrams from a repeated one.

mod deframer;
mod frame;
mod sequence;

pub use deframer::{Deframer, Reception, Window};
pub use frame::{FRAME_BITS, Frame, FrameError, check, check_byte, decode, encode};
pub use sequence::{Header, Judgement, Sequence, SequenceError, Stream};

use crate::aspect::AspectId;
use crate::distance::Metres;
use crate::heading::Heading;

/// The number of a track section for one direction of travel, unique on the line: 0 to 65 535.
///
/// An odd number is for trains that travel towards the left, an even one for those towards the right. So what a telegram
/// is for is in its frame, under its check.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct SectionId(pub u16);

impl SectionId {
    /// The direction of travel of the trains that the number is for.
    pub const fn heading(self) -> Heading {
        if self.0 & 1 == 1 { Heading::Left } else { Heading::Right }
    }
}

/// The running number of a telegram of its stream, modulo 256.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Counter(pub u8);

/// A gradient in thousandths, positive where the train climbs: −128 to 127 ‰.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Gradient(pub i8);

/// The variable data of a section: how far the line is free, and how fast.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Main {
    /// The section that the telegram is for.
    pub section: SectionId,
    /// The telegram's number in its stream.
    pub counter: Counter,
    /// Whether and how far the train may go beyond the section.
    pub route: Route,
    /// The speed that the ground permits, as a rank in the table of the line's speeds.
    pub speed: AspectId,
}

/// Whether the route beyond the section's exit is open, and where it ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Route {
    /// The train must stop before the exit of the section.
    Closed,
    /// The train must stop before the point that is so far beyond the exit of the section.
    OpenFor(Metres),
}

impl Route {
    /// The distance from the section's exit to the point before which the train must stop; 0 if the route is closed.
    pub const fn beyond_exit(self) -> Metres {
        match self {
            Self::Closed => Metres(0),
            Self::OpenFor(distance) => distance,
        }
    }
}

/// The fixed data of a section.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Sub {
    /// The section that the telegram is for.
    pub section: SectionId,
    /// The telegram's number in its stream.
    pub counter: Counter,
    /// The section's length.
    pub length: Length,
    /// The least favourable gradient from any place of the section to the points where its main telegrams may stop a train.
    pub gradient: Gradient,
    /// The limit by curves and points, as a rank in the table of the line's speeds.
    pub curve: AspectId,
    /// The limit by a temporary restriction, as a rank in the table of the line's speeds; the highest rank if there is none.
    pub restriction: AspectId,
}

/// The length of a section: 1 to 65 535 m.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Length(Metres);

impl Length {
    /// A length of `metres`; `None` for 0.
    pub const fn new(metres: Metres) -> Option<Self> {
        if metres.0 == 0 { None } else { Some(Self(metres)) }
    }

    /// The length in metres, 1 or more.
    pub const fn metres(self) -> Metres {
        self.0
    }
}

/// A telegram of either kind.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Telegram {
    /// Variable data.
    Main(Main),
    /// Fixed data.
    Sub(Sub),
}
