//! The counter: a stream of fresh telegrams, or a transmitter that repeats itself.

use super::{Counter, Main, SectionId, Sub};
use crate::Machine;
use crate::time::{MAX_TICKS, Ticks};

/// The parameters, checked: window 1 to 127, run 1 to 15, memory 1 to [`MAX_TICKS`] cycles.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Sequence {
    window: u8,
    run: u8,
    memory: Ticks,
}

/// Which rule the parameters break. Source: `spec/telegram.md`, TEL-7.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SequenceError {
    /// No advance of the counter is allowed.
    NoWindow,
    /// The counter may advance by more than half its range: ahead and behind could not be told apart.
    WindowTooWide,
    /// No telegram would be needed for evidence.
    NoRun,
    /// More than 15 telegrams in a row would be needed.
    RunTooLong,
    /// The stream would be forgotten at once.
    NoMemory,
    /// The memory is over [`MAX_TICKS`] cycles.
    MemoryTooLong,
}

/// What a telegram says of its place in its stream.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Header {
    /// The section that the telegram is for.
    pub section: SectionId,
    /// Its number.
    pub counter: Counter,
}

impl Main {
    /// The telegram's place in its stream.
    pub const fn header(&self) -> Header {
        Header { section: self.section, counter: self.counter }
    }
}

impl Sub {
    /// The telegram's place in its stream.
    pub const fn header(&self) -> Header {
        Header { section: self.section, counter: self.counter }
    }
}

/// What becomes of the cycle's telegram.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Judgement {
    /// No telegram came.
    Nothing,
    /// One came and is not used.
    Refused,
    /// One came and is used.
    Accepted,
}

/// What is remembered of a stream.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Stream {
    /// The last telegram heard, used or not; `None` if there is none, or it is forgotten.
    pub last: Option<Header>,
    /// How many telegrams in a row are in order, up to the last one: the first of the stream is one, and one out of order none; at most
    /// the run and one.
    pub in_order: u8,
    /// Cycles since the last telegram.
    pub age: Ticks,
}

impl Stream {
    /// Nothing heard.
    pub const EMPTY: Self = Self { last: None, in_order: 0, age: Ticks(0) };

    /// Cycles from the last telegram to the next cycle. A telegram that advances the counter there was sent no earlier.
    pub const fn silence(&self) -> Ticks {
        Ticks(self.age.0.saturating_add(1))
    }

    /// Whether `sequence` can be in this state.
    pub const fn is_valid(&self, sequence: &Sequence) -> bool {
        match self.last {
            None => self.in_order == 0 && self.age.0 == 0,
            Some(_) => self.in_order <= sequence.run + 1 && self.age.0 < sequence.memory.0,
        }
    }
}

impl Sequence {
    /// A telegram is used if the counter advanced by 1 to `window` (at most 127) for `run` telegrams (1 to 15) of one
    /// section in a row; a stream of which nothing is heard for `memory` cycles (1 or more) is forgotten.
    ///
    /// # Errors
    /// The first rule that is broken, in the order of [`SequenceError`].
    pub const fn new(window: u8, run: u8, memory: Ticks) -> Result<Self, SequenceError> {
        //= spec/telegram.md#tel-7-the-constructor
        //# The constructor MUST reject a window of 0 or over 127, a run of 0 or over 15, and a memory of 0 or over 60 000 cycles.
        if window == 0 {
            Err(SequenceError::NoWindow)
        } else if window > 127 {
            Err(SequenceError::WindowTooWide)
        } else if run == 0 {
            Err(SequenceError::NoRun)
        } else if run > 15 {
            Err(SequenceError::RunTooLong)
        } else if memory.0 == 0 {
            Err(SequenceError::NoMemory)
        } else if memory.0 > MAX_TICKS {
            Err(SequenceError::MemoryTooLong)
        } else {
            Ok(Self { window, run, memory })
        }
    }

    /// The most by which the counter may advance from one telegram to the next, 1 to 127.
    pub const fn window(&self) -> u8 {
        self.window
    }

    /// How many advances in a row are the evidence, 1 to 15.
    pub const fn run(&self) -> u8 {
        self.run
    }

    /// After how many cycles of silence a stream is forgotten.
    pub const fn memory(&self) -> Ticks {
        self.memory
    }
}

impl Machine for Sequence {
    type State = Stream;
    type Input = Option<Header>;
    type Output = Judgement;

    const SAFE: Judgement = Judgement::Nothing;

    fn initial(&self) -> Stream {
        Stream::EMPTY
    }

    fn step(&self, stream: Stream, heard: Option<Header>) -> (Stream, Judgement) {
        let age = stream.silence();
        //= spec/telegram.md#tel-6-the-counter
        //# A telegram MUST be used only if it and the telegrams before it, as many as the run, each had a counter 1 to the window ahead of the one before, all of them of one section and each less than the memory after the one before.
        let stream = if age.0 >= self.memory.0 { Stream::EMPTY } else { Stream { age, ..stream } };
        let Some(header) = heard else {
            let kept = if stream.last.is_some() { stream } else { Stream::EMPTY };
            return (kept, Judgement::Nothing);
        };
        let more = if stream.in_order < self.run { stream.in_order + 1 } else { self.run + 1 };
        let in_order = match stream.last {
            Some(last) if last.section.0 == header.section.0 => {
                let ahead = header.counter.0.wrapping_sub(last.counter.0);
                let advanced = ahead >= 1 && ahead <= self.window;
                //= spec/telegram.md#tel-8-after-a-telegram-out-of-order
                //# A telegram that does not advance the counter as it should, of the section of the one before and less than the memory after it, MUST NOT count as the first one of a run.
                if advanced { more } else { 0 }
            }
            _ => 1,
        };
        let judgement = if in_order > self.run { Judgement::Accepted } else { Judgement::Refused };
        (Stream { last: Some(header), in_order, age: Ticks(0) }, judgement)
    }
}
