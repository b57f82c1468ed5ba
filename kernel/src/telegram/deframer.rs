//! The deframer: finds frames in a stream of bits.

use super::Telegram;
use super::frame::{FRAME_BITS, Frame, decode};
use crate::Machine;

/// The deframer of one carrier. It has no parameters.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Deframer;

/// What the receiver says of one bit time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Reception {
    /// It decided for a 0.
    Zero,
    /// It decided for a 1.
    One,
    /// It hears nothing that it could decide on.
    Nothing,
}

/// What the deframer remembers: the last [`FRAME_BITS`] bits, the newest the lowest; ones where nothing was received.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Window(u128);

impl Window {
    /// Before the first bit, and after a gap. A frame begins with a 0, so none is found before all its bits have come.
    pub const EMPTY: Self = Self((1 << FRAME_BITS) - 1);

    /// The window with these bits: the lowest [`FRAME_BITS`] of `bits`. For proofs, tests and replays.
    pub const fn from_bits(bits: u128) -> Self {
        Self(bits & Self::EMPTY.0)
    }

    /// The window as memory has it, valid or not: for proofs of what happens when memory is corrupted.
    pub const fn from_memory(bits: u128) -> Self {
        Self(bits)
    }

    /// The bits, the newest the lowest.
    pub const fn bits(self) -> u128 {
        self.0
    }

    /// Whether this is a window that the deframer can be in: nothing above its bits.
    pub const fn is_valid(self) -> bool {
        self.0 <= Self::EMPTY.0
    }
}

impl Machine for Deframer {
    type State = Window;
    type Input = Reception;
    type Output = Option<Telegram>;

    const SAFE: Option<Telegram> = None;

    fn initial(&self) -> Window {
        Window::EMPTY
    }

    /// One bit time: the telegram whose last bit this one is, if there is one.
    fn step(&self, window: Window, reception: Reception) -> (Window, Option<Telegram>) {
        let bit = match reception {
            Reception::Zero => 0,
            Reception::One => 1,
            //= spec/telegram.md#tel-5-finding-frames
            //# A telegram MUST be reported with the last bit of its frame, and a bit time in which nothing is received MUST forget all bits before it.
            Reception::Nothing => return (Window::EMPTY, None),
        };
        let window = Window::from_bits(window.0 << 1 | bit);
        (window, decode(Frame::from_bits(window.0)).ok())
    }
}
