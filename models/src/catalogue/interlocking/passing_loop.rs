//! The passing loop, with every condition kept.

use super::shared::{
    DOWN, PASSING, POINTS, ROUTES, SOUND, UP, dispatch, drives, following, meeting, sets, stay, turns, yard,
};
use crate::catalogue::about::about;
use crate::check::Entry;
use crate::interlocking::Purpose;
use crate::interlocking::Sight;
use crate::interlocking::environment::Environment;
use crate::interlocking::environment::{Detection, Drives, Obey, Start};
use crate::interlocking::ground::Heading;
use crate::interlocking::stations::{Overlaps, loop_route, passing, passing_loop};
use atc_kernel::distance::Metres;
use atc_kernel::time::Ticks;

pub(super) fn entries() -> Vec<Entry> {
    let mut entries = opposing();
    entries.extend(points_and_followers());
    entries.extend(lost_and_sliding());
    entries.extend(staff_and_line());
    entries.extend(false_occupancy_and_start());
    entries
}

fn opposing() -> Vec<Entry> {
    let station = || passing_loop(Overlaps::Throat);
    let words = "routes are set and withdrawn and segments turned in any cycle; trains move and stand in any cycle";
    let model = |name, statement: &str, more: &str, environment, purpose| {
        yard(about(name, statement, &format!("{words}{more}"), ROUTES, SOUND), station(), environment, purpose)
    };
    vec![
        model(
            "interlocking-loop",
            "Two trains meet in a passing loop and pass each other: no collision, no derailment, and from every state both can \
             still arrive.",
            "",
            meeting(),
            Purpose::Finishes(&[
                Sight::Arrived,
                Sight::Meet,
                Sight::Turned,
                Sight::BehindTheFirst,
                Sight::OverlapGivenUp,
                Sight::Releasing,
                Sight::RunsPast,
            ]),
        ),
        model(
            "interlocking-loop-late-points",
            "The same with points that take any time or stick: a route whose point does not arrive fails, and when it moves again both \
             trains can still arrive.",
            "; points leave and arrive late or never",
            Environment { drives: Drives::Late, ..meeting() },
            Purpose::Finishes(&[Sight::Arrived, Sight::Failed, Sight::Releasing, Sight::RunsPast]),
        ),
        model(
            "interlocking-loop-any-platform",
            "Two trains meet in a passing loop where each may use either platform, all eight routes being set and withdrawn.",
            "",
            Environment { requests: [dispatch(&[0, 1, 2, 3, 4, 5, 6, 7]), turns(&[0, 1])].concat(), ..meeting() },
            Purpose::Safe(&[Sight::Arrived, Sight::Meet, Sight::Turned, Sight::BehindTheFirst]),
        ),
        model(
            "interlocking-loop-telegrams",
            "Two trains that keep to their telegrams meet in a passing loop: no telegram leads past a signal at stop, and both arrive.",
            "; a telegram that is withdrawn is still used for the residual running",
            Environment { obey: Obey::Telegrams, residual: 1, ..meeting() },
            Purpose::Finishes(&[Sight::Arrived, Sight::Meet, Sight::Telegram]),
        ),
        model(
            "interlocking-loop-three",
            "Two trains from the west and one from the east: whatever is requested there is no accident; but two that fill both platforms \
             against a third leave nobody a way out. No interlocking prevents that: dispatching does.",
            "; no route is withdrawn",
            Environment {
                requests: [sets(&[0, 1, 2, 3, 4, 5, 6, 7]), turns(&[0, 1])].concat(),
                ..Environment::usual(vec![UP, UP, DOWN])
            },
            Purpose::Safe(&[Sight::Arrived, Sight::Filled]),
        ),
    ]
}

/// Points that fail, and trains that follow each other.
fn points_and_followers() -> Vec<Entry> {
    let station = passing_loop(Overlaps::Throat);
    let commands = [dispatch(&PASSING[..1]), sets(&PASSING[1..]), turns(&[0, 1]), drives(0)].concat();
    vec![
        yard(
            about(
                "interlocking-loop-points",
                "Points that take any time or stick, lose their detection, and are driven by individual commands in the middle of trains: \
                 none moves under a train, and none is run over that does not lie right.",
                "the same; points leave and arrive late or never, and one at a time is not detected; individual point commands in any cycle",
                POINTS,
                SOUND,
            ),
            station.clone(),
            Environment {
                drives: Drives::Late,
                detection: Detection::MayFail,
                residual: 1,
                requests: commands,
                ..meeting()
            },
            Purpose::Safe(&[Sight::Arrived, Sight::Failed, Sight::Meet]),
        ),
        yard(
            about(
                "interlocking-loop-following",
                "Two trains follow each other through a passing loop: the second is let in behind the first as soon as it has left \
                 the throat, and both can always arrive.",
                "routes over both platforms are set and withdrawn in any cycle",
                ROUTES,
                SOUND,
            ),
            station.clone(),
            following(2),
            Purpose::Finishes(&[Sight::Arrived, Sight::BehindTheFirst, Sight::RunsPast]),
        ),
    ]
}

/// Trains that are lost, and trains that slide.
fn lost_and_sliding() -> Vec<Entry> {
    let station = passing_loop(Overlaps::Throat);
    let filtered = |cycles| station.with(|plan| plan.clear = cycles);
    let sliding = station.sliding(&[passing::ONE, passing::TWO], Heading::Up, 1);
    let sliding = sliding.sliding(&[passing::ONE, passing::TWO], Heading::Down, 1).with(stay(2));
    vec![
        yard(
            about(
                "interlocking-loop-flicker",
                "Two trains meet while their circuits are not reported for up to a cycle less than a circuit needs to count as clear.",
                "the same; any circuit with a train is not reported, for one cycle in a row",
                &["TRK-1", "ILK-1", "ILK-9", "ILK-10"],
                SOUND,
            ),
            filtered(2),
            Environment {
                unheard: 1,
                residual: 1,
                requests: [dispatch(&PASSING[..1]), sets(&PASSING[1..]), turns(&[0, 1])].concat(),
                ..meeting()
            },
            Purpose::Safe(&[Sight::Arrived, Sight::Meet, Sight::Unheard, Sight::BehindTheFirst]),
        ),
        yard(
            about(
                "interlocking-loop-following-flicker",
                "Two trains follow each other while their circuits are not reported for up to two cycles less than a circuit needs to count as clear: \
                 the device never loses them, and from every state both can still arrive.",
                "routes over both platforms are set and withdrawn in any cycle; any circuit with a train is not reported, for one cycle in a row",
                &["TRK-1", "ILK-1", "ILK-9", "ILK-10"],
                SOUND,
            ),
            filtered(3),
            Environment { unheard: 1, residual: 0, ..following(2) },
            Purpose::Finishes(&[Sight::Arrived, Sight::Unheard, Sight::BehindTheFirst]),
        ),
        yard(
            about(
                "interlocking-loop-sliding",
                "Trains slide past the signals at the platforms' ends when they arrive: the overlap beyond is kept for them until they stand.",
                "the same; a train slides by one circuit in the cycle after it has arrived",
                &["ILK-1", "ILK-14"],
                SOUND,
            ),
            sliding.clone(),
            Environment { slides_for: 1, ..meeting() },
            Purpose::Safe(&[Sight::Slides, Sight::OverlapGivenUp, Sight::Meet]),
        ),
        yard(
            about(
                "interlocking-loop-following-sliding",
                "The same with two trains that follow each other: the next way out over the overlap's point waits until the train stands.",
                "routes over both platforms are set and withdrawn in any cycle; a train slides by one circuit in the cycle after it has arrived",
                &["ILK-1", "ILK-14"],
                SOUND,
            ),
            sliding,
            Environment { slides_for: 1, ..following(2) },
            Purpose::Safe(&[Sight::Slides, Sight::OverlapGivenUp]),
        ),
    ]
}

/// Blocks, restrictions, and the permission of the line.
fn staff_and_line() -> Vec<Entry> {
    let station = passing_loop(Overlaps::Throat);
    let works = |blocks: u8, restricts| Environment { blocks, restricts, ..meeting() };
    vec![
        yard(
            about(
                "interlocking-loop-blocks",
                "The eastern throat and the first platform are blocked and unblocked in any cycle, also under trains: nobody runs into a \
                 circuit whose block was confirmed.",
                "the same; two circuits are blocked and unblocked in any cycle",
                &["ILK-6", "ILK-7", "ILK-16"],
                SOUND,
            ),
            station.clone(),
            works(1 << passing::EAST | 1 << passing::ONE, 0),
            Purpose::Finishes(&[Sight::Arrived, Sight::BlockedUnderTrain, Sight::ConfirmedAhead]),
        ),
        yard(
            about(
                "interlocking-loop-late-permission",
                "The neighbour sends a train on a permission that has just been withdrawn: it is let in all the same, and from every state both \
                 can still arrive.",
                "the same; a train may come one cycle after the permission has ended",
                &["ILK-17", "ILK-18"],
                SOUND,
            ),
            station.with(|plan| plan.turn = Ticks(2)),
            Environment { permission_lives: 1, ..meeting() },
            Purpose::Finishes(&[Sight::Arrived, Sight::NoDirection]),
        ),
        yard(
            about(
                "interlocking-loop-line-blocked-own",
                "Plain line is blocked in front of a train that goes out and still runs on its telegram: the block is confirmed only when nothing can \
                 come any more; and where the neighbour ends its consent instead, nobody is sent out any more to its staff.",
                "the same; the circuit E is blocked and unblocked in any cycle; the neighbour consents in any cycle or not, and its staff step onto the \
                 line when it has not for as long as a train still runs, and the line is clear",
                &["ILK-6", "ILK-7", "ILK-16"],
                SOUND,
            ),
            station.clone(),
            Environment { blocks: 1 << passing::E, staff_beyond: Some(2), ..following(1) },
            Purpose::Safe(&[Sight::Arrived, Sight::BlockedUnderTrain, Sight::ConfirmedAhead]),
        ),
        yard(
            about(
                "interlocking-loop-line-blocked",
                "Plain line is blocked while trains come from it and go out to it: the block is confirmed only when neither the neighbour nor this \
                 station can send.",
                "the same; the circuit E is blocked and unblocked in any cycle",
                &["ILK-6", "ILK-7", "ILK-16"],
                SOUND,
            ),
            station.clone(),
            works(1 << passing::E, 0),
            Purpose::Safe(&[Sight::Arrived, Sight::BlockedUnderTrain, Sight::ConfirmedAhead]),
        ),
        yard(
            about(
                "interlocking-loop-restricted",
                "The western throat and the second platform are restricted in any cycle, also under trains: the restriction is in the telegrams of the \
                 same cycle, also while only the tail is there.",
                "the same; two circuits are restricted and restrictions lifted in any cycle; trains keep to the telegrams",
                &["ILK-15", "ATC-4"],
                SOUND,
            ),
            station.with(|plan| plan.braking[2] = Metres(100)),
            Environment { obey: Obey::Telegrams, residual: 1, ..works(0, 1 << passing::WEST | 1 << passing::TWO) },
            Purpose::Safe(&[Sight::Arrived, Sight::Restricted]),
        ),
    ]
}

/// Circuits that are reported without a train, points that leave late, and trains that a device finds when it starts.
fn false_occupancy_and_start() -> Vec<Entry> {
    let station = passing_loop(Overlaps::Throat);
    let all = 1 << passing::WEST | 1 << passing::ONE | 1 << passing::EAST | 1 << passing::E;
    let one = [loop_route::UP_IN_ONE, loop_route::UP_OUT_ONE];
    vec![
        yard(
            about(
                "interlocking-loop-falsely-occupied",
                "Circuits are reported without a train, any of them together: no place is released in front of the train that may still come, and no \
                 point moves under it.",
                "routes over one platform are set, and a point driven by individual commands, in any cycle; four circuits are reported without a train in \
                 any cycle, each or together",
                &["ILK-9", "ILK-10", "ILK-21", "ILK-22"],
                SOUND,
            ),
            station.clone(),
            Environment { falsely: all, requests: [sets(&one), drives(1)].concat(), ..following(1) },
            Purpose::Safe(&[Sight::Arrived]),
        ),
        yard(
            about(
                "interlocking-loop-settling",
                "Points leave one cycle after their drive has ended: where they count as detected only after two cycles at rest, none is run over that \
                 moves.",
                "routes are set and withdrawn and a point is driven by individual commands in any cycle; points leave one cycle after the drive has ended",
                &["ILK-23"],
                SOUND,
            ),
            station.with(|plan| plan.settle = 2),
            Environment {
                drives: Drives::AfterTheDrive,
                requests: [following(1).requests, drives(0)].concat(),
                ..following(1)
            },
            Purpose::Safe(&[Sight::Arrived]),
        ),
        yard(
            about(
                "interlocking-loop-settling-blocked",
                "The western throat is blocked in any cycle, also just after its point was driven: the block is confirmed only when the point can no \
                 longer leave, and nothing drives it after that.",
                "the same; the throat is blocked and unblocked in any cycle",
                &["ILK-16", "ILK-23"],
                SOUND,
            ),
            station.with(|plan| plan.settle = 2),
            Environment {
                drives: Drives::AfterTheDrive,
                requests: [following(1).requests, drives(0)].concat(),
                blocks: 1 << passing::WEST,
                ..following(1)
            },
            Purpose::Safe(&[Sight::Arrived, Sight::ConfirmedAhead]),
        ),
        yard(
            about(
                "interlocking-loop-start",
                "A device starts with a train before a signal that showed proceed: nothing moves until the train has passed it or stands.",
                "routes are set and withdrawn, segments turned and a point driven by individual commands in any cycle; the train passes the signal for as \
                 long as the residual running",
                &["ILK-24", "ILK-25"],
                SOUND,
            ),
            station.with(|plan| plan.start = Ticks(3)),
            Environment {
                found: true,
                requests: [dispatch(&PASSING), turns(&[0, 1]), drives(0)].concat(),
                ..Environment::usual(vec![UP])
            },
            Purpose::Safe(&[Sight::Arrived]),
        ),
        yard(
            about(
                "interlocking-loop-restart",
                "A device starts with a driver in his route, who goes on by the signal that he has passed and takes any time: nothing ahead of him is \
                 confirmed to staff, driven or given to another.",
                "the train is in the throat when the device starts; routes are set and withdrawn, segments turned, a point driven, the platform ahead \
                 blocked, and the throat and that platform falsely occupied in any cycle",
                &["ILK-27", "ILK-28", "ILK-29", "ILK-30", "ILK-31"],
                SOUND,
            ),
            station.with(|plan| plan.start = Ticks(1)),
            Environment {
                found: true,
                requests: [dispatch(&PASSING), turns(&[0, 1]), drives(1)].concat(),
                blocks: 1 << passing::ONE,
                falsely: 1 << passing::WEST | 1 << passing::ONE,
                ..Environment::usual(vec![Start { at: passing::WEST, ..UP }])
            },
            Purpose::Safe(&[Sight::Arrived]),
        ),
    ]
}
