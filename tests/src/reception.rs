//! A train under way, for the benchmarks: what it hears and measures, the same in every run.

use atc_kernel::Machine as _;
use atc_kernel::permitted::{self, Heard, Permission, Permitted};
use atc_kernel::position::{self, Interval, Measured, Position};
use atc_kernel::telegram::{Deframer, FRAME_BITS, Reception, Telegram, encode};

use crate::{approach, ground};

/// The parameters of the permitted speed.
///
/// # Panics
/// Never: they are valid.
pub fn permitted() -> Permitted {
    ground::config().permitted().expect("the parameters are valid")
}

/// What a new train hears on the ground of [`ground`].
///
/// # Panics
/// Never: the steps are sound.
pub fn heard() -> Vec<Heard> {
    let steps = ground::drive(ground::Train::New).into_iter();
    steps.map(|moment| moment.step.heard().expect("a sound step")).collect()
}

/// The parameters of the position.
///
/// # Panics
/// Never: they are valid.
pub fn position() -> Position {
    approach::config().position().expect("a sound table")
}

/// What the train of [`approach`] measures.
///
/// # Panics
/// Never: the steps are sound.
pub fn measured() -> Vec<Measured> {
    approach::steps().iter().map(|step| step.measured().expect("a sound step")).collect()
}

/// The bits of the frames that the new train hears, one behind the other.
pub fn bits() -> Vec<Reception> {
    let telegrams =
        heard().into_iter().flat_map(|heard| [heard.main.map(Telegram::Main), heard.sub.map(Telegram::Sub)]);
    let frames = telegrams.flatten().map(|telegram| encode(telegram).bits());
    let bit = |on: bool| if on { Reception::One } else { Reception::Zero };
    frames.flat_map(|frame| (0..FRAME_BITS).rev().map(move |place| bit(frame >> place & 1 == 1))).collect()
}

/// Runs `count` cycles of the permitted speed.
pub fn run_permitted(count: u64) -> Permission {
    let (parameters, inputs) = (permitted(), heard());
    let (mut state, mut last) = (permitted::State::INITIAL, Permitted::SAFE);
    for input in inputs.iter().cycle().take(usize::try_from(count).unwrap_or(usize::MAX)) {
        (state, last) = permitted::step(&parameters, state, *input);
    }
    last
}

/// Runs `count` cycles of the position.
pub fn run_position(count: u64) -> Option<Interval> {
    let (parameters, inputs) = (position(), measured());
    let mut last = None;
    for input in inputs.iter().cycle().take(usize::try_from(count).unwrap_or(usize::MAX)) {
        last = position::step(&parameters, last, *input);
    }
    last
}

/// Runs `count` bit times of the deframer; how many telegrams it found.
pub fn run_deframer(count: u64) -> u64 {
    let (mut window, mut found) = (Deframer.initial(), 0);
    for bit in bits().iter().cycle().take(usize::try_from(count).unwrap_or(usize::MAX)) {
        let (next, telegram) = Deframer.step(window, *bit);
        window = next;
        found += u64::from(telegram.is_some());
    }
    found
}

/// The permitted speed's input as lines of the protocol: the start, and one period of steps.
pub fn lines() -> (String, String) {
    ground::case(ground::Train::New)
}
