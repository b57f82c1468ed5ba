//! A train that is called on into a berth where another one stands.

use super::shared::{ALL, dispatch, turn, turns, yard};
use crate::catalogue::about::{Conditions, about, joined};
use crate::check::Entry;
use crate::interlocking::environment::{Environment, Start};
use crate::interlocking::ground::Heading;
use crate::interlocking::stations::{berth, berth_route, called};
use crate::interlocking::yard::Harm;
use crate::interlocking::{Purpose, Sight};
use atc_kernel::interlocking::{Request, Travel};

/// With drivers who run on sight.
const ON_SIGHT: [&str; ALL.len() + 1] = joined(ALL, ["called-on-runs-on-sight"]);
const SEEN: Conditions = (&ON_SIGHT, &[]);
const UNSEEN: Conditions = (&ALL, &["called-on-runs-on-sight"]);

const WORDS: &str = "routes are set and withdrawn in any cycle; trains move and stand in any cycle; who is called on runs on sight, and heeds no \
                     signal that is for the train ahead of it";

const SLIDING: &str = "a train that is not called on slides by one circuit in the cycle after it has arrived";

const REQUIREMENTS: &[&str] = &["ILK-2", "ILK-33", "ILK-34", "ILK-35", "ATC-17"];

/// Two trains from the west.
const WEST: Start = Start { at: called::W, heading: Heading::Up, segment: Some(0) };
/// One from the east.
const EAST: Start = Start { at: called::E, heading: Heading::Down, segment: Some(1) };

fn following() -> Environment {
    use berth_route::{CALL, UP_IN, UP_OUT};
    Environment {
        before: vec![turn(0, Travel::Toward), turn(1, Travel::Away)],
        requests: dispatch(&[UP_IN, CALL, UP_OUT]),
        ..Environment::usual(vec![WEST, WEST])
    }
}

fn inward() -> Vec<Request> {
    dispatch(&[berth_route::UP_IN, berth_route::CALL, berth_route::DOWN_IN])
}

fn facing() -> Environment {
    use berth_route::{DOWN_OUT, UP_OUT};
    Environment {
        slides_for: 1,
        before: vec![turn(0, Travel::Toward), turn(1, Travel::Toward)],
        requests: [inward(), dispatch(&[UP_OUT, DOWN_OUT]), turns(&[0, 1])].concat(),
        ..Environment { trains: vec![WEST, EAST], ..following() }
    }
}

pub(super) fn entries() -> Vec<Entry> {
    vec![
        yard(
            about(
                "interlocking-called-on",
                "A train is called on to another one that stands in the berth, and both go on: whoever else comes to the berth, or has not stopped \
                 there, is kept off; and from every state both can still arrive.",
                WORDS,
                REQUIREMENTS,
                SEEN,
            ),
            berth(),
            following(),
            Purpose::Finishes(&[Sight::Arrived, Sight::Shared, Sight::OverlapGivenUp, Sight::Releasing]),
        ),
        yard(
            about(
                "interlocking-called-on-facing",
                "A train is called on to one that has come from the other side, or that comes from there: it finds it at a stand.",
                &format!("{WORDS}; {SLIDING}; the lines are turned in any cycle"),
                REQUIREMENTS,
                SEEN,
            ),
            berth(),
            facing(),
            Purpose::Safe(&[Sight::Shared, Sight::Slides, Sight::OverlapGivenUp]),
        ),
        yard(
            about(
                "interlocking-called-on-falsely",
                "The same while berth and throat are falsely occupied in any cycle: nobody is let in who must not be.",
                &format!(
                    "{WORDS}; {SLIDING}; the berth and the western throat may be reported without a train in any cycle"
                ),
                REQUIREMENTS,
                SEEN,
            ),
            berth(),
            Environment { falsely: 1 << called::BERTH | 1 << called::WEST, requests: inward(), ..facing() },
            Purpose::Safe(&[Sight::Shared, Sight::Slides]),
        ),
        yard(
            about(
                "interlocking-called-on-blindly",
                "Who is called on and does not run on sight runs into the train that stands there.",
                WORDS,
                REQUIREMENTS,
                UNSEEN,
            ),
            berth(),
            Environment { on_sight: false, ..following() },
            Purpose::Accident(Harm::Collision, &["called-on-runs-on-sight"]),
        ),
        yard(
            about(
                "interlocking-called-on-drawing-up",
                "Who stands in the berth short of the signal, draws up to it and does not look, runs into the train that is called on there.",
                &format!("{WORDS}; {SLIDING}; who has come to a stand draws up at any time"),
                REQUIREMENTS,
                UNSEEN,
            ),
            berth(),
            Environment { draws_up: true, ..facing() },
            Purpose::Accident(Harm::Collision, &["called-on-runs-on-sight"]),
        ),
    ]
}
