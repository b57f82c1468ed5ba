//! Block counting in front of the interlocking.

use super::shared::{ALL, ROUTES, dispatch, sets, turn};
use crate::block::fault::Faults;
use crate::catalogue::about::{Conditions, about, joined};
use crate::check::Entry;
use crate::interlocking::Purpose;
use crate::interlocking::counted::{Counted, Joint};
use crate::interlocking::device::Real;
use crate::interlocking::environment::{Environment, Start};
use crate::interlocking::ground::Heading;
use crate::interlocking::stations::{counted, counted_line};
use crate::interlocking::yard::{Harm, Yard};
use atc_kernel::interlocking::Travel;

/// What counting assumes besides, and last what this is about.
const COUNTING: [&str; 7] = [
    "live-transmitter",
    "train-whole",
    "no-reversing-over-exit",
    "hold-covers-train",
    "heard-by-one",
    "entries-apart",
    "line-end-asks",
];

const BOTH: [&str; ALL.len() + COUNTING.len()] = joined(ALL, COUNTING);

const SOUND: Conditions = (&BOTH, &[]);
const NOT_ASKED: Conditions = (BOTH.split_last().expect("some").1, &["line-end-asks"]);

/// Two trains that come in over the line.
fn trains() -> Environment {
    let start = Start { at: counted::FAR, heading: Heading::Up, segment: Some(0) };
    Environment {
        residual: 1,
        unheard: 1,
        unheard_in: 1 << counted::THROAT,
        before: vec![turn(0, Travel::Toward)],
        requests: sets(&[0, 1]),
        ..Environment::usual(vec![start; 2])
    }
}

fn model(
    (name, statement, words): (&'static str, &str, &str),
    conditions: Conditions,
    environment: Environment,
    joint: Joint,
    faults: Vec<Faults>,
) -> Entry {
    let (_, excluded_by) = conditions;
    let purpose =
        if excluded_by.is_empty() { Purpose::Safe(&[]) } else { Purpose::Accident(Harm::Collision, excluded_by) };
    let yard = Yard::new(Real, counted_line().with(|plan| plan.clear = 2), environment, purpose);
    Entry::new(about(name, statement, words, ROUTES, conditions), Counted { yard, joint, faults, excluded_by })
}

pub(super) fn entries() -> Vec<Entry> {
    let faults = "routes are set in any cycle; trains move and stand in any cycle; the throat may not be reported under a train for one cycle in a row; \
                  a component of the block may fail in any cycle, and staff reset what does not agree";
    let quiet = "routes are set in any cycle; trains move and stand in any cycle; the throat may not be reported under a train for one cycle in a row";
    let flicker = "routes are set and withdrawn in any cycle; trains move and stand in any cycle; the throat may not be reported under a train for one cycle \
                   in a row, and reported without one";
    vec![
        model(
            (
                "interlocking-counted",
                "Trains follow each other over a counted line into a station, and any one component of the counting fails: no collision, no \
                 derailment, no wrong output, and every section with any part of a train counts as occupied.",
                faults,
            ),
            SOUND,
            trains(),
            Joint::Asks,
            Faults::up_to(1, 2, 1),
        ),
        model(
            (
                "interlocking-counted-flicker",
                "The same without a fault of the counting, where the throat is falsely occupied at any time, and routes are withdrawn.",
                flicker,
            ),
            SOUND,
            Environment { falsely: 1 << counted::THROAT, requests: dispatch(&[0, 1]), ..trains() },
            Joint::Asks,
            vec![Faults::NONE],
        ),
        model(
            (
                "interlocking-counted-not-asked",
                "The station does not ask the line to hold its last section: a train stands with its front in the throat and its tail there, and the next one runs \
                 into it.",
                quiet,
            ),
            NOT_ASKED,
            trains(),
            Joint::Silent,
            vec![Faults::NONE],
        ),
    ]
}
