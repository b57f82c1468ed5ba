//! Trains that foul each other in two circuits: the one in rear of a joint that is too near to a point, and the one with the point.

use super::shared::{DOWN, PASSING, SOUND, UP, dispatch, sets, turns, without, yard};
use crate::catalogue::about::{Conditions, about};
use crate::check::Entry;
use crate::interlocking::environment::Environment;
use crate::interlocking::stations::{passing, short_joint};
use crate::interlocking::yard::Harm;
use crate::interlocking::{Purpose, Sight};
use atc_kernel::interlocking::CircuitSet;

const NOT_SAID: Conditions = (&without(5), &["fouling-declared"]);

const WORDS: &str =
    "all eight routes are set and withdrawn and the segments turned in any cycle; trains move and stand in any cycle";

const REQUIREMENTS: &[&str] = &["ILK-1", "ILK-7", "ILK-36", "ILK-37"];

fn meeting() -> Environment {
    Environment {
        requests: [dispatch(&[0, 1, 2, 3, 4, 5, 6, 7]), turns(&[0, 1])].concat(),
        ..Environment::usual(vec![UP, DOWN])
    }
}

pub(super) fn entries() -> Vec<Entry> {
    vec![
        yard(
            about(
                "interlocking-beside",
                "A train that stands in the second platform fouls the western throat: no other train is let in there, and none into the platform while one \
                 is in the throat.",
                WORDS,
                REQUIREMENTS,
                SOUND,
            ),
            short_joint(),
            meeting(),
            Purpose::Safe(&[Sight::Arrived, Sight::Meet, Sight::Turned, Sight::RunsPast]),
        ),
        yard(
            about(
                "interlocking-beside-falsely",
                "The same with one way for each train, while the platform is falsely occupied in any cycle.",
                "routes are set and withdrawn and segments turned in any cycle; trains move and stand in any cycle; the second platform may be reported \
                 without a train in any cycle",
                REQUIREMENTS,
                SOUND,
            ),
            short_joint(),
            Environment {
                requests: [dispatch(&PASSING), turns(&[0, 1])].concat(),
                falsely: 1 << passing::TWO,
                ..meeting()
            },
            Purpose::Safe(&[Sight::Arrived, Sight::Meet]),
        ),
        yard(
            about(
                "interlocking-beside-left-out",
                "The layout does not say that the two foul each other: a train is let in past the one that stands.",
                "routes are set and segments turned in any cycle; trains move and stand in any cycle",
                REQUIREMENTS,
                NOT_SAID,
            ),
            short_joint().with(|plan| {
                for place in plan.routes.iter_mut().flat_map(|route| &mut route.path) {
                    place.beside = CircuitSet::EMPTY;
                }
            }),
            Environment { requests: [sets(&PASSING), turns(&[0, 1])].concat(), ..meeting() },
            Purpose::Accident(Harm::Collision, &["fouling-declared"]),
        ),
    ]
}
