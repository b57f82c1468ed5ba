//! What may happen in a model of the interlocking.

use super::ground::{Blade, Heading};
use super::sizes::POINTS;
use atc_kernel::interlocking::Request;

/// The most trains of a model.
pub const TRAINS: usize = 3;

/// What trains obey.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Obey {
    /// The signals; on plain line, where there are none, the telegrams. A fault of the interlocking is not hidden by the telegrams.
    Signals,
    /// The telegrams.
    Telegrams,
    /// Nothing: they pass signals at stop.
    Nothing,
}

/// How points move.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Drives {
    /// They leave in the cycle after the command and arrive in the next one.
    Prompt,
    /// They leave and arrive in any cycle, or never, as long as they are driven; once they have left they may also arrive without.
    Late,
    /// The same, and they may leave one cycle after the drive has ended.
    AfterTheDrive,
}

/// What is detected of points.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Detection {
    /// The position where they are at rest.
    True,
    /// The same, or nothing, for one point in any cycle.
    MayFail,
    /// A point that has left is reported where it shall arrive.
    Early,
}

/// A train of the timetable.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Start {
    /// The circuit where it appears.
    pub at: u8,
    /// Which way it goes.
    pub heading: Heading,
    /// The segment whose direction must permit it; none where nobody asks.
    pub segment: Option<u8>,
}

/// What may happen.
#[derive(Clone, Debug)]
pub struct Environment {
    /// The trains, 1 to 3; those from one circuit come in this order.
    pub trains: Vec<Start>,
    /// What they obey.
    pub obey: Obey,
    /// For how many cycles a train that counted on a signal at proceed may still pass it after it fell to stop; likewise for telegrams.
    pub residual: u8,
    /// For how many cycles after it has arrived a train may still slide past the signal, where the ground lets it.
    pub slides_for: u8,
    /// How points move.
    pub drives: Drives,
    /// What is detected of them.
    pub detection: Detection,
    /// Where they lie at the start.
    pub blades: [Blade; POINTS],
    /// For how many cycles in a row an occupied circuit may not be reported.
    pub unheard: u8,
    /// The circuits where that may be: a mask.
    pub unheard_in: u8,
    /// For how many cycles after a permission has ended the neighbour may still send a train on it.
    pub permission_lives: u8,
    /// What is requested before the model begins, one a cycle.
    pub before: Vec<Request>,
    /// What may be requested in any cycle, one at a time.
    pub requests: Vec<Request>,
    /// The circuits that may be blocked and unblocked in any cycle: a mask.
    pub blocks: u8,
    /// The circuits that may be restricted, and restrictions lifted, in any cycle: a mask.
    pub restricts: u8,
    /// The circuits that may be reported without a train, any of them at once, in any cycle: a mask.
    pub falsely: u8,
    /// Whether the neighbours may end their consent in any cycle: for how many cycles their staff wait after that, and until the line is clear,
    /// before they step onto it. None: they consent wherever this station does not permit.
    pub staff_beyond: Option<u8>,
    /// Whether who is called on runs on sight, and heeds no signal that is for the train ahead of it.
    pub on_sight: bool,
    /// Whether a train that has come to a stand in a circuit draws up to its signal at any time, and does not look who comes towards it.
    pub draws_up: bool,
    /// Whether the device has just started and finds the trains there, on their way on a signal that showed proceed before.
    pub found: bool,
}

impl Environment {
    /// Trains that obey the signals, prompt points, nothing lost, nothing requested.
    pub fn usual(trains: Vec<Start>) -> Self {
        Self {
            trains,
            obey: Obey::Signals,
            residual: 2,
            slides_for: 0,
            drives: Drives::Prompt,
            detection: Detection::True,
            blades: [Blade::Normal; POINTS],
            unheard: 0,
            unheard_in: u8::MAX,
            permission_lives: 0,
            before: Vec::new(),
            requests: Vec::new(),
            blocks: 0,
            restricts: 0,
            falsely: 0,
            staff_beyond: None,
            on_sight: true,
            draws_up: false,
            found: false,
        }
    }
}
