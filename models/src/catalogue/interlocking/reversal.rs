//! A train that turns round behind the circuit with its signal, and staff between the two.

use super::shared::{ALL, SOUND, dispatch, turn, turns, without, yard};
use crate::catalogue::about::{Conditions, about};
use crate::check::Entry;
use crate::interlocking::environment::{Environment, Start};
use crate::interlocking::ground::Heading;
use crate::interlocking::stations::{IN, OUT, circuits, long_track, reversal};
use crate::interlocking::yard::Harm;
use crate::interlocking::{Purpose, Sight};
use atc_kernel::interlocking::Travel;

const SHORT: [&str; ALL.len() - 1] = without(1);
const TOO_SHORT: Conditions = (&SHORT, &["approach-covers-braking"]);

const WORDS: &str = "routes are set and withdrawn, the line is turned, and the circuit with the signal is blocked and unblocked, in any cycle; trains \
                     move, stand and turn round in any cycle; who has turned round waits for the signal ahead";

const REQUIREMENTS: &[&str] = &["ILK-1", "ILK-5", "ILK-7", "ILK-15", "ILK-16"];

fn with_staff() -> Environment {
    let arrival = Start { at: reversal::L, heading: Heading::Up, segment: Some(0) };
    Environment {
        before: vec![turn(0, Travel::Toward)],
        requests: [dispatch(&[IN, OUT]), turns(&[0])].concat(),
        blocks: 1 << reversal::NEAR,
        ..Environment::usual(vec![arrival; 2])
    }
}

pub(super) fn entries() -> Vec<Entry> {
    let falsely = 1 << reversal::NEAR | 1 << reversal::FAR | 1 << reversal::THROAT;
    vec![
        yard(
            about(
                "interlocking-reversal",
                "A train turns round behind the circuit with its signal, where staff may have a block: none is confirmed in front of it, whether the \
                 signal shows proceed before or after.",
                WORDS,
                REQUIREMENTS,
                SOUND,
            ),
            long_track(),
            with_staff(),
            Purpose::Safe(&[Sight::Arrived, Sight::BlockedUnderTrain, Sight::ConfirmedAhead, Sight::RunsPast]),
        ),
        yard(
            about(
                "interlocking-reversal-falsely",
                "The same while the circuits of the station are falsely occupied in any cycle.",
                &format!("{WORDS}; the circuits of the station may be reported without a train in any cycle"),
                REQUIREMENTS,
                SOUND,
            ),
            long_track(),
            Environment { falsely, ..with_staff() },
            Purpose::Safe(&[Sight::Arrived, Sight::BlockedUnderTrain, Sight::ConfirmedAhead]),
        ),
        yard(
            about(
                "interlocking-reversal-short-approach",
                "The approach is as long as a train brakes, and a train turns round farther behind its signal: it runs over staff to it.",
                WORDS,
                REQUIREMENTS,
                TOO_SHORT,
            ),
            long_track().with(|plan| plan.routes[usize::from(OUT)].approach = circuits(1 << reversal::NEAR)),
            with_staff(),
            Purpose::Accident(Harm::Staff, &["approach-covers-braking"]),
        ),
    ]
}
