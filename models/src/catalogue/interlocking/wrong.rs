//! What happens where a condition is not kept: each of these models finds the accident.

use super::others::{crossing_trains, joining};
use super::shared::{
    DOWN, PASSING, POINTS, ROUTES, UP, dispatch, drives, following, meeting, sets, stay, turn, without, yard,
};
use crate::catalogue::about::{Conditions, about};
use crate::check::Entry;
use crate::interlocking::Purpose;
use crate::interlocking::environment::Environment;
use crate::interlocking::environment::{Detection, Drives, Obey};
use crate::interlocking::ground::{Heading, Station};
use crate::interlocking::stations::{Overlaps, circuits, crossing, junction, loop_route, passing, passing_loop};
use crate::interlocking::yard::Harm;
use atc_kernel::interlocking::{Element, Positions, RouteSet, Travel};
use atc_kernel::time::Ticks;

const NO_SHUNT: Conditions = (&without(0), &["loss-of-shunt-within-clear"]);
const NO_APPROACH: Conditions = (&without(1), &["approach-covers-braking"]);
const NO_RELEASE: Conditions = (&without(2), &["release-covers-residual-running"]);
const NO_OVERLAP: Conditions = (&without(3), &["overlap-covers-sliding"]);
const NO_FLANK: Conditions = (&without(4), &["flank-complete"]);
const NO_FOULING: Conditions = (&without(5), &["fouling-declared"]);
const NO_PATH: Conditions = (&without(6), &["path-complete"]);
const NO_DETECTION: Conditions = (&without(7), &["points-detect-truly"]);
const LATE: Conditions = (&without(8), &["points-leave-while-driven"]);
const DISOBEYED: Conditions = (&without(9), &["trains-obey-signals"]);

const COLLISION: fn(&'static [&'static str]) -> Purpose = |by| Purpose::Accident(Harm::Collision, by);
const DERAILMENT: fn(&'static [&'static str]) -> Purpose = |by| Purpose::Accident(Harm::Derailment, by);

pub(super) fn entries() -> Vec<Entry> {
    let mut entries = layouts();
    entries.extend(over_and_beside());
    entries.extend(outside());
    entries
}

/// The passing loop where trains slide by one circuit past the signals at the platforms' ends.
fn sliding(overlaps: Overlaps, cycles: u16) -> Station {
    let ends = [passing::ONE, passing::TWO];
    passing_loop(overlaps).sliding(&ends, Heading::Up, 1).sliding(&ends, Heading::Down, 1).with(stay(cycles))
}

/// Layouts and times that are wrong about braking and sliding.
fn layouts() -> Vec<Entry> {
    let words = "routes are set and withdrawn and segments turned in any cycle; trains move and stand in any cycle";
    let station = passing_loop(Overlaps::Throat);
    let no_approach = station.forced(|plan| {
        plan.routes.iter_mut().for_each(|route| route.approach = circuits(0));
    });
    // An overlap would keep what follows from the point until the train has stood.
    let without_overlaps = passing_loop(Overlaps::None);
    let short_release = station.with(|plan| plan.routes.iter_mut().for_each(|route| route.release = Ticks(1)));
    vec![
        yard(
            about(
                "interlocking-no-approach",
                "Routes without an approach are released at once under a train that counts on their signal: a point moves under it.",
                words,
                &["ILK-12", "ILK-13"],
                NO_APPROACH,
            ),
            no_approach,
            meeting(),
            DERAILMENT(&["approach-covers-braking", "ILK-12"]),
        ),
        yard(
            about(
                "interlocking-short-approach-telegrams",
                "A train that keeps to its telegrams counts on a route further ahead than its signal's circuit: an approach of that circuit alone is too \
                 short for it, and a point moves under it.",
                "the same; a telegram that is withdrawn is still used for two circuits",
                &["ILK-12", "ILK-13", "ATC-1"],
                NO_APPROACH,
            ),
            without_overlaps.clone(),
            Environment { obey: Obey::Telegrams, ..following(2) },
            DERAILMENT(&["approach-covers-braking"]),
        ),
        yard(
            about(
                "interlocking-short-approach-late-report",
                "The same where the train is not reported in the first cycle in which it is on the approach: an approach that covers the braking distance \
                 and the age of a telegram, and not that cycle, is too short; the route is released at once, and a point moves under the train.",
                "one route out is withdrawn and its point driven by individual commands in any cycle; any circuit with a train is not reported, for one \
                 cycle in a row",
                &["ILK-12", "ILK-13", "TRK-1", "ATC-1"],
                NO_APPROACH,
            ),
            without_overlaps.with(|plan| plan.clear = 2),
            Environment {
                obey: Obey::Telegrams,
                unheard: 1,
                residual: 1,
                requests: [sets(&[loop_route::UP_IN_ONE]), dispatch(&[loop_route::UP_OUT_ONE]), drives(1)].concat(),
                ..following(1)
            },
            DERAILMENT(&["approach-covers-braking"]),
        ),
        yard(
            about(
                "interlocking-short-release",
                "A release time shorter than the residual running: the route is released before the train has come, and a point moves under it.",
                words,
                &["ILK-12", "ILK-13"],
                NO_RELEASE,
            ),
            short_release,
            meeting(),
            DERAILMENT(&["release-covers-residual-running"]),
        ),
        yard(
            about(
                "interlocking-no-overlap",
                "Without overlaps two trains that slide past their signals meet in the throat.",
                "the same; a train slides by one circuit in the cycle after it has arrived",
                &["ILK-14"],
                NO_OVERLAP,
            ),
            sliding(Overlaps::None, 2),
            Environment { slides_for: 1, ..meeting() },
            COLLISION(&["overlap-covers-sliding"]),
        ),
        yard(
            about(
                "interlocking-short-stay",
                "An overlap that is given up while the train may still slide: the point in it moves under the train.",
                "the same; a train slides by one circuit within four cycles after it has arrived; the stay time is one cycle",
                &["ILK-14"],
                NO_OVERLAP,
            ),
            sliding(Overlaps::Throat, 1),
            Environment { slides_for: 4, ..following(2) },
            DERAILMENT(&["overlap-covers-sliding"]),
        ),
    ]
}

/// Layouts that leave out what lies over or beside a path.
fn over_and_beside() -> Vec<Entry> {
    let no_flank = junction().forced(|plan| plan.routes[0].path[0].positions.reverse = Positions::NONE.reverse);
    let undeclared = crossing().forced(|plan| {
        plan.routes.iter_mut().for_each(|route| route.conflicts = RouteSet::EMPTY);
    });
    let left_out = passing_loop(Overlaps::Throat).forced(|plan| {
        for number in [loop_route::UP_IN_ONE, loop_route::UP_IN_TWO] {
            let route = &mut plan.routes[usize::from(number)];
            route.length = 1;
            route.continuing = RouteSet::EMPTY;
            route.overlap = Element::default();
        }
    });
    let words = "routes are set and withdrawn in any cycle; trains move and stand in any cycle";
    vec![
        yard(
            about(
                "interlocking-no-flank",
                "The main route does not ask for the point in its flank: a train that slides past the branch's signal runs into the side of another.",
                "the same; a train on the branch slides by two circuits in the cycle after it has come",
                &["ILK-1", "ILK-6", "ILK-7"],
                NO_FLANK,
            ),
            no_flank,
            Environment { slides_for: 1, ..joining() },
            COLLISION(&["flank-complete"]),
        ),
        yard(
            about(
                "interlocking-undeclared",
                "Two routes that foul each other without a circuit or a point in common, and whose conflict is not declared, are held together.",
                words,
                &["ILK-1"],
                NO_FOULING,
            ),
            undeclared,
            crossing_trains(),
            COLLISION(&["fouling-declared"]),
        ),
        yard(
            about(
                "interlocking-path-left-out",
                "Routes into a platform whose path ends before it: the second train is let in where the first one stands.",
                words,
                &["ILK-1", "ILK-6", "ILK-7"],
                NO_PATH,
            ),
            left_out,
            Environment { requests: dispatch(&[loop_route::UP_IN_ONE]), ..following(2) },
            COLLISION(&["path-complete"]),
        ),
    ]
}

/// Circuits, points and trains that do not behave.
fn outside() -> Vec<Entry> {
    let station = passing_loop(Overlaps::Throat);
    let flickering = |clear, unheard| {
        let filtered = passing_loop(Overlaps::Throat).with(|plan| plan.clear = clear);
        let one = [loop_route::UP_IN_ONE, loop_route::UP_OUT_ONE];
        (filtered, Environment { unheard, residual: 1, requests: sets(&one), ..following(2) })
    };
    let flicker = |name, statement, (station, environment)| {
        let words = "routes over one platform are set in any cycle; any circuit with a train is not reported, for that long in a row";
        let about = about(name, statement, words, &["TRK-1"], NO_SHUNT);
        yard(about, station, environment, COLLISION(&["loss-of-shunt-within-clear"]))
    };
    let one_way = Environment {
        before: vec![turn(0, Travel::Toward), turn(1, Travel::Toward)],
        requests: dispatch(&PASSING),
        ..Environment::usual(vec![UP, DOWN])
    };
    vec![
        flicker(
            "interlocking-flicker-long",
            "A train that is not reported for as long as its circuit needs to count as clear: the next one is let in to it.",
            flickering(2, 2),
        ),
        flicker(
            "interlocking-no-filter",
            "A device that believes the first clear report: a train that is not reported for one cycle is run into.",
            flickering(1, 1),
        ),
        yard(
            about(
                "interlocking-false-detection",
                "A point that is reported where it shall arrive before it is there: a train runs over it while it moves.",
                "routes are set and withdrawn in any cycle; points leave and arrive late or never, and are reported too early",
                POINTS,
                NO_DETECTION,
            ),
            station.clone(),
            Environment { drives: Drives::Late, detection: Detection::Early, ..meeting() },
            DERAILMENT(&["points-detect-truly"]),
        ),
        yard(
            about(
                "interlocking-late-drive",
                "A point that leaves after its drive has ended: a route that found it in position, and shows proceed, has it moved under its train.",
                "routes are set and withdrawn and a point is driven by individual commands in any cycle; points leave one cycle after the drive has ended",
                POINTS,
                LATE,
            ),
            station.clone(),
            Environment {
                drives: Drives::AfterTheDrive,
                requests: [following(1).requests, drives(0)].concat(),
                ..following(1)
            },
            DERAILMENT(&["points-leave-while-driven"]),
        ),
        yard(
            about(
                "interlocking-signals-ignored",
                "Trains that pass signals at stop meet in the station.",
                "routes are set and withdrawn in any cycle; trains obey nothing",
                ROUTES,
                DISOBEYED,
            ),
            station,
            Environment { obey: Obey::Nothing, ..one_way },
            COLLISION(&["trains-obey-signals"]),
        ),
    ]
}
