//! A finished plan against the tracks of its file: the right one agrees, and each of these wrong ones does not.

use atc_kernel::distance::Metres;
use atc_kernel::interlocking::{
    CircuitSet, Heading, PointSet, Positions, RouteSet, SegmentSet, SpeedCode, SpeedLimits,
};
use atc_kernel::time::Ticks;
use atc_layout::witness::{Plan, differences};
use atc_layout::{Compiled, Description};

const LOOP: &str = include_str!("../../layouts/passing-loop.toml");
const JUNCTION: &str = include_str!("../../layouts/junction.toml");
const TERMINUS: &str = include_str!("../../layouts/terminus.toml");
const STATION: &str = include_str!("../../layouts/station-30.toml");

/// Two tracks and a crossover. Trains come in from the east on track B, and no signal stands there.
const CROSSOVER: &str = include_str!("files/crossover.toml");

/// A passing loop where a train that stands in 2T is in the way of one in P1T.
const SHORT_JOINT: &str = include_str!("files/short-joint.toml");

/// A single line that a track crosses on the level.
const DIAMOND: &str = include_str!("files/diamond.toml");
const LONG_TRACK: &str = include_str!("files/long-track.toml");

type Size = Plan<64, 16, 32, 8>;

/// A wrong derivation: its name, the file, what it does to the plan, and what is told.
type Wrong = (&'static str, &'static str, fn(&mut Size, &Numbers), &'static str);

/// The places of names.
struct Numbers(Compiled);

impl Numbers {
    fn of(text: &str) -> (Description, Self) {
        let description = Description::from_toml("station.toml", text).unwrap_or_else(|errors| panic!("{errors}"));
        let compiled = description.compile().unwrap_or_else(|errors| panic!("{errors}"));
        (description, Self(compiled))
    }

    fn at(names: &[String], name: &str) -> usize {
        names.iter().position(|other| other == name).unwrap_or_else(|| panic!("no {name}"))
    }

    fn circuit(&self, name: &str) -> CircuitSet {
        CircuitSet::nth(Self::at(&self.0.names.circuits, name))
    }

    fn route(&self, name: &str) -> usize {
        Self::at(&self.0.names.routes, name)
    }

    fn point(&self, name: &str) -> PointSet {
        PointSet::nth(Self::at(&self.0.names.points, name))
    }
}

fn turned(positions: Positions) -> Positions {
    Positions { normal: positions.reverse, reverse: positions.normal }
}

const WRONG: &[Wrong] = &[
    (
        "a point that is run over is not held",
        LOOP,
        |plan, it| plan.routes[it.route("W-1")].path[0].positions = Positions::NONE,
        "no train runs over its path",
    ),
    (
        "a point stands the other way",
        LOOP,
        |plan, it| {
            let path = &mut plan.routes[it.route("W-2")].path[0];
            path.positions = turned(path.positions);
        },
        "no train runs over its path",
    ),
    (
        "two places of a path change places",
        LOOP,
        |plan, it| plan.routes[it.route("W-1")].path.swap(0, 1),
        "no train runs over its path",
    ),
    (
        "a path is one circuit short",
        LOOP,
        |plan, it| plan.routes[it.route("W-1")].length -= 1,
        "its train comes to 1T, which is not beyond its end",
    ),
    (
        "the entry is another one",
        LOOP,
        |plan, it| plan.routes[it.route("W-1")].entry = it.circuit("W2"),
        "no train runs over its path",
    ),
    (
        "the other direction of travel",
        LOOP,
        |plan, it| plan.routes[it.route("W-1")].heading = Heading::Left,
        "to the other side than Left",
    ),
    (
        "nothing beyond the end",
        LOOP,
        |plan, it| plan.routes[it.route("W-1")].beyond = CircuitSet::EMPTY,
        "which is not beyond its end",
    ),
    (
        "an overlap elsewhere",
        LOOP,
        |plan, it| plan.routes[it.route("W-1")].overlap.circuits = it.circuit("W2"),
        "does not run over its overlap",
    ),
    (
        "a point of an overlap stands the other way",
        LOOP,
        |plan, it| {
            let overlap = &mut plan.routes[it.route("W-1")].overlap;
            overlap.positions = turned(overlap.positions);
        },
        "does not run over its overlap",
    ),
    (
        "it comes from nowhere",
        LOOP,
        |plan, it| plan.routes[it.route("W-1")].from = SegmentSet::EMPTY,
        "that it comes from segment West is said",
    ),
    (
        "it goes out to the other side",
        LOOP,
        |plan, it| plan.routes[it.route("1-E")].to = SegmentSet::nth(0),
        "that it goes out to segment",
    ),
    (
        "it goes out to nowhere",
        LOOP,
        |plan, it| plan.routes[it.route("1-E")].to = SegmentSet::EMPTY,
        "that it goes out to segment East is said",
    ),
    (
        "it goes on by a route elsewhere",
        LOOP,
        |plan, it| {
            let other = RouteSet::nth(it.route("2-W"));
            plan.routes[it.route("W-1")].continuing = other;
        },
        "route 2-W goes on elsewhere than it ends",
    ),
    (
        "a flank point is not held",
        CROSSOVER,
        |plan, it| {
            let place = &mut plan.routes[it.route("W-A")].path[0];
            place.positions.normal = place.positions.normal.without(it.point("P2"));
        },
        "a vehicle that comes in at h runs onto its path at x, and nothing keeps it off",
    ),
    (
        "a flank point stands the other way",
        CROSSOVER,
        |plan, it| {
            let place = &mut plan.routes[it.route("W-A")].path[0];
            place.positions.normal = place.positions.normal.without(it.point("P2"));
            place.positions.reverse = place.positions.reverse.or(it.point("P2"));
        },
        "a vehicle that comes in at h runs onto its path at x, and nothing keeps it off",
    ),
    (
        "a declared conflict is not kept",
        CROSSOVER,
        |plan, it| plan.routes[it.route("B-E")].conflicts = RouteSet::EMPTY,
        "the file excludes it and route B-E, and the plan does not",
    ),
    (
        "one of two circuits that foul each other is not held",
        SHORT_JOINT,
        |plan, it| plan.routes[it.route("W-2")].length = 1,
        "foul each other, and it holds P1T without proving 2T clear",
    ),
    (
        "what fouls a place is not proved clear",
        SHORT_JOINT,
        |plan, it| plan.routes[it.route("W-1")].path[0].beside = CircuitSet::EMPTY,
        "P1T and 2T foul each other, and it holds P1T without proving 2T clear",
    ),
    (
        "what a route names is proved clear for a part of its path",
        SHORT_JOINT,
        |plan, it| plan.routes[it.route("W-2")].path[1].beside = CircuitSet::EMPTY,
        "the file has 1T proved clear, and the plan has not",
    ),
    (
        "no signal at the end of a track",
        LOOP,
        |plan, it| {
            // The routes out of track 2 begin elsewhere: what stands there faces no signal.
            for name in ["2-W", "2-E"] {
                plan.routes[it.route(name)].entry = it.circuit("W2");
            }
        },
        "no train runs over its path",
    ),
    (
        "a point has no detector",
        LOOP,
        |plan, _| plan.points[0].detectors = CircuitSet::EMPTY,
        "stands on it or fouls it, and is not detected there",
    ),
    (
        "a point is held by no place",
        TERMINUS,
        |plan, _| {
            for route in &mut plan.routes {
                for place in &mut route.path {
                    let first = PointSet::nth(0);
                    place.positions = Positions {
                        normal: place.positions.normal.without(first),
                        reverse: place.positions.reverse.without(first),
                    };
                }
            }
        },
        "may move under its train",
    ),
    (
        "two circuits of a segment change places",
        LOOP,
        |plan, _| plan.segments[0].circuits.swap(0, 1),
        "the file has other circuits than",
    ),
    (
        "a segment to the other side",
        LOOP,
        |plan, _| plan.segments[0].outward = plan.segments[0].outward.opposite(),
        "no train runs out of it",
    ),
    (
        "the throat of a segment is elsewhere",
        LOOP,
        |plan, it| plan.segments[0].throat = it.circuit("2T"),
        "no train runs out of it",
    ),
    ("a segment is shared", LOOP, |plan, _| plan.segments[0].shared = 1, "1 circuits are shared, and the file has 0"),
    (
        "an approach is the entry alone",
        LOOP,
        |plan, it| {
            let route = &mut plan.routes[it.route("W-1")];
            route.approach = route.entry;
        },
        "from the signal, and not in its approach",
    ),
    (
        "an approach is as long as a train brakes, and not as its track",
        LONG_TRACK,
        |plan, it| {
            let route = &mut plan.routes[it.route("1-W")];
            route.approach = route.entry;
        },
        "route 1-W: a driver who changes ends in 1B goes by its signal, and it is not in its approach",
    ),
    (
        "a circuit has another length",
        JUNCTION,
        |plan, _| plan.lengths[1] = Metres(plan.lengths[1].0 + 1),
        "m long, and the plan has",
    ),
    (
        "a distance is too short",
        JUNCTION,
        |plan, _| plan.braking[3] = Metres(plan.braking[3].0 - 30),
        "m, and the plan has",
    ),
    (
        "a route is faster over reverse points",
        LOOP,
        |plan, it| plan.routes[it.route("W-2")].speed = SpeedCode(6),
        "its trains run at 75 km/h, and the file allows 45",
    ),
    (
        "a trap point beside a crossing is not held",
        DIAMOND,
        |plan, it| plan.routes[it.route("W-A")].path[0].positions = Positions::NONE,
        "what is parked in T runs onto its path at k2, and faces no signal",
    ),
    ("a line has no limit", LOOP, |plan, _| plan.line = SpeedLimits::NONE, "90 km/h is its limit, and the file has 75"),
    ("a circuit counts as clear at once", LOOP, |plan, _| plan.clear = 1, "clear_ms of the plan is 100 ms"),
    ("a loss is shorter", LOOP, |plan, _| plan.loss = 1, "shunt_loss_ms of the plan is 100 ms"),
    ("points settle at once", LOOP, |plan, _| plan.settle = 0, "settle_ms of the plan is 0 ms"),
    (
        "a route is released at once",
        LOOP,
        |plan, it| plan.routes[it.route("W-1")].release = Ticks(1),
        "release_ms of the plan lets more happen",
    ),
    (
        "points may take for ever",
        LOOP,
        |plan, it| plan.routes[it.route("W-1")].drive = Ticks(u16::MAX),
        "drive_ms of the plan lets more happen",
    ),
    (
        "every train is cab-signalled",
        LOOP,
        |plan, it| plan.routes[it.route("W-1")].cab_signalled = true,
        "cab_signalled of the plan lets more happen",
    ),
];

#[test]
fn every_wrong_plan_is_found() {
    let mut missed = Vec::new();
    for (name, text, falsify, says) in WRONG {
        let (description, numbers) = Numbers::of(text);
        let mut plan = *numbers.0.plan;
        falsify(&mut plan, &numbers);
        assert_ne!(plan, *numbers.0.plan, "{name}");
        let told: Vec<String> =
            differences(&description.station, &plan).iter().map(|problem| problem.what.clone()).collect();
        if !told.iter().any(|what| what.contains(says)) {
            missed.push(format!("{name}: {told:?}"));
        }
    }
    assert!(missed.is_empty(), "not found:\n{}", missed.join("\n"));
}

/// Compiling asks: a layout whose plan differs is refused. Here the right ones are not.
#[test]
fn right_plans_agree() {
    for text in [LOOP, JUNCTION, TERMINUS, STATION, CROSSOVER, SHORT_JOINT, DIAMOND, LONG_TRACK] {
        let (description, numbers) = Numbers::of(text);
        assert_eq!(differences(&description.station, &numbers.0.plan), []);
    }
}

/// A reason is the file's: where it gives none, what may stand there and faces no signal is told.
#[test]
fn what_is_parked_is_found() {
    let (_, numbers) = Numbers::of(DIAMOND);
    for (line, says) in [
        (
            "left_unprotected = \"the derail at k1 is locked by hand\"\n",
            &["W-A: what is parked in S runs onto its path at k1", "A-W: what is parked in S"][..],
        ),
        // Where a signal stands, it faces one.
        ("right_unprotected = \"trains in A2 obey signal A-W\"\n", &[]),
    ] {
        let text = DIAMOND.replace(line, "");
        assert_ne!(text, DIAMOND);
        let station = Description::from_toml("station.toml", &text).unwrap_or_else(|errors| panic!("{errors}")).station;
        let told: Vec<String> =
            differences(&station, &numbers.0.plan).iter().map(|problem| problem.what.clone()).collect();
        assert_eq!(told.len(), says.len(), "{told:?}");
        assert!(told.iter().zip(says).all(|(told, says)| told.contains(says)), "{told:?}");
    }
}
