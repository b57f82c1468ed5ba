//! The junction, the crossing and the terminus, with every condition kept.

use super::shared::{BRANCH, IN_AND_OUT, MAIN, OVER, ROUTES, SOUND, UNDER, dispatch, turn, turns, yard};
use crate::catalogue::about::about;
use crate::check::Entry;
use crate::interlocking::Purpose;
use crate::interlocking::Sight;
use crate::interlocking::environment::Environment;
use crate::interlocking::environment::{Drives, Obey};
use crate::interlocking::stations::{crossing, junction, rest, siding, terminus};
use crate::interlocking::yard::RESTRICTED;
use atc_kernel::distance::Metres;
use atc_kernel::interlocking::Travel;

/// Trains from both ways into the junction.
pub(super) fn joining() -> Environment {
    Environment {
        before: vec![turn(0, Travel::Away)],
        requests: dispatch(&[0, 1]),
        ..Environment::usual(vec![MAIN, BRANCH])
    }
}

/// Trains over both tracks of the crossing.
pub(super) fn crossing_trains() -> Environment {
    Environment {
        before: vec![turn(0, Travel::Away), turn(1, Travel::Away)],
        requests: dispatch(&[0, 1]),
        ..Environment::usual(vec![OVER, UNDER])
    }
}

/// A train into the siding that is lost there.
fn siding_train() -> Environment {
    Environment {
        obey: Obey::Telegrams,
        residual: 0,
        unheard: 1,
        unheard_in: 1 << rest::THROAT | 1 << rest::FIRST | 1 << rest::SECOND,
        before: vec![turn(0, Travel::Toward)],
        requests: dispatch(&[0]),
        ..Environment::usual(vec![IN_AND_OUT])
    }
}

pub(super) fn entries() -> Vec<Entry> {
    let reversing = |trains: usize| Environment {
        requests: [dispatch(&[0, 1, 2, 3]), turns(&[0])].concat(),
        ..Environment::usual(vec![IN_AND_OUT; trains])
    };
    let words = "routes are set and withdrawn in any cycle; points leave and arrive late or never; trains move and stand in any cycle";
    vec![
        yard(
            about(
                "interlocking-junction",
                "Three trains from two ways join one line: no collision, no derailment, and from every state all can still arrive.",
                words,
                ROUTES,
                SOUND,
            ),
            junction(),
            Environment { drives: Drives::Late, trains: vec![MAIN, BRANCH, MAIN], ..joining() },
            Purpose::Finishes(&[Sight::Arrived, Sight::Failed, Sight::Releasing, Sight::RunsPast]),
        ),
        yard(
            about(
                "interlocking-junction-sliding",
                "A train slides past the branch's signal: the point in the flank of the main route leads it into the sand.",
                &format!("{words}; a train on the branch slides by two circuits in the cycle after it has come"),
                &["ILK-1", "ILK-6", "ILK-7", "ILK-8"],
                SOUND,
            ),
            junction(),
            Environment { drives: Drives::Late, slides_for: 1, ..joining() },
            Purpose::Safe(&[Sight::Slides]),
        ),
        yard(
            about(
                "interlocking-crossing",
                "Two lines cross on the level without a circuit in common: the declared conflict keeps the trains apart.",
                "routes are set and withdrawn in any cycle; trains move and stand in any cycle",
                &["ILK-1"],
                SOUND,
            ),
            crossing(),
            crossing_trains(),
            Purpose::Finishes(&[Sight::Arrived, Sight::Releasing]),
        ),
        yard(
            about(
                "interlocking-terminus",
                "Two trains come in from one line, turn round and go out again, while the line is turned: no collision, no derailment, \
                 and from every state both can still arrive.",
                "routes are set and withdrawn and the line turned in any cycle; trains move, stand and turn round in any cycle",
                ROUTES,
                SOUND,
            ),
            terminus(),
            reversing(2),
            Purpose::Finishes(&[Sight::Arrived, Sight::Turned, Sight::BehindTheFirst, Sight::Releasing]),
        ),
        yard(
            about(
                "interlocking-terminus-telegrams",
                "The same with trains that keep to their telegrams; one route in is slow, also for a train that goes out again with its tail there.",
                "routes are set and withdrawn and the line turned in any cycle; trains move, stand and turn round in any cycle",
                ROUTES,
                SOUND,
            ),
            terminus().with(|plan| {
                plan.routes[0].speed = RESTRICTED;
                plan.braking[2] = Metres(100);
            }),
            Environment { obey: Obey::Telegrams, residual: 1, ..reversing(2) },
            Purpose::Finishes(&[Sight::Arrived, Sight::Turned, Sight::Telegram]),
        ),
        yard(
            about(
                "interlocking-siding-flicker",
                "A train that keeps to its telegrams runs over three circuits of one route and is lost where it goes from one to the next, for up to two \
                 cycles less than a circuit needs to count as clear: both are still seen together, the route goes on granting what is ahead, and the \
                 train can always arrive.",
                "the route is set and withdrawn in any cycle; the circuits of the route are not reported with a train, for one cycle in a row",
                &["ATC-1", "TRK-1"],
                SOUND,
            ),
            siding().with(|plan| plan.clear = 3),
            siding_train(),
            Purpose::Finishes(&[Sight::Arrived, Sight::Unheard, Sight::Telegram]),
        ),
        yard(
            about(
                "interlocking-terminus-three",
                "Three trains and two platforms: there is no accident; but two that fill the platforms against a third on the line leave \
                 nobody a way out. No interlocking prevents that: dispatching does.",
                "routes are set and withdrawn and the line turned in any cycle; trains move, stand and turn round in any cycle",
                ROUTES,
                SOUND,
            ),
            terminus(),
            Environment { residual: 1, ..reversing(3) },
            Purpose::Safe(&[Sight::Arrived, Sight::Filled]),
        ),
    ]
}
