//! The rules of a layout: for each one a plan that breaks it and nothing else, with the place that is reported; and the plan that
//! all of them start from, which breaks none.

use atc_kernel::distance::Metres;
use atc_kernel::interlocking::{
    Broken, CircuitSet, Heading, Layout, Place, Plan, Point, PointSet, Position, Positions, RouteSet, Rule, SegmentSet,
    SpeedCode,
};
use atc_kernel::time::Ticks;
use atc_tests::sketch::{Line, Sketch, Way};

type Small = Plan<4, 3, 2, 2>;

/// ```text
///   W                                  E
///   0 ─│ 1 ──<── 2 ──>── 4 │─ 5      point 0 in circuit 1, point 1 in circuit 4
///              \─ 3 ─/               routes: 0 into 2, 1 out of 2 to E, 2 into 3, 3 out of 3 to E
/// ```
fn station() -> Small {
    let position = |point, reverse: bool| (point, if reverse { Position::Reverse } else { Position::Normal });
    let into = |track: usize| Way {
        entry: 0,
        approach: vec![0],
        path: vec![(1, vec![position(0, track == 3)]), (track, vec![])],
        overlap: (vec![4], vec![position(1, track == 3)]),
        beyond: vec![4],
        continuing: vec![track - 2 + usize::from(track == 2) + usize::from(track == 3) * 2],
        from: Some(0),
        drive: 5,
        release: 5,
        stay: 5,
        speed: 2,
        ..Way::default()
    };
    let out = |track: usize| Way {
        entry: track,
        approach: vec![track],
        path: vec![(4, vec![position(1, track == 3)])],
        beyond: vec![5],
        to: Some(1),
        drive: 5,
        release: 5,
        stay: 5,
        speed: 2,
        ..Way::default()
    };
    let sketch = Sketch {
        lengths: vec![100; 6],
        points: vec![vec![1], vec![4]],
        routes: vec![into(2), out(2), into(3), out(3)],
        segments: vec![
            Line { circuits: vec![0], throat: None, leftward: true },
            Line { circuits: vec![5], throat: Some(4), leftward: false },
        ],
        braking: vec![0, 50, 150],
        clear: 2,
        turn: 3,
        ..Sketch::default()
    };
    sketch.plan()
}

/// What is broken after the change.
fn broken(change: impl Fn(&mut Small)) -> Vec<Broken> {
    let mut plan = station();
    change(&mut plan);
    let mut all = Vec::new();
    plan.check(&mut |broken| all.push(broken));
    let first = all.first().copied();
    assert_eq!(Layout::new(plan).err(), first, "the constructor reports the first of them");
    all
}

/// The change breaks this rule at these places, and nothing else anywhere.
fn breaks(rule: Rule, places: &[Place], change: impl Fn(&mut Small)) {
    let expected: Vec<_> = places.iter().map(|place| Broken { rule, place: *place }).collect();
    assert_eq!(broken(change), expected);
}

fn circuit(number: usize) -> CircuitSet {
    CircuitSet::nth(number)
}

#[test]
fn a_right_plan_breaks_nothing() {
    assert_eq!(broken(|_| ()), []);
    assert!(Layout::with_what_proofs_need(station()).is_ok());
    // Nothing at all is a station too, as soon as it has its times.
    assert!(Layout::new(Plan::<4, 3, 2, 2> { clear: 1, turn: Ticks(1), ..Plan::EMPTY }).is_ok());
}

#[test]
fn times_of_no_cycle() {
    breaks(Rule::NoTime, &[Place::Plan], |plan| plan.clear = 0);
    breaks(Rule::NoTime, &[Place::Plan], |plan| plan.turn = Ticks(0));
    breaks(Rule::NoTime, &[Place::Route(1)], |plan| plan.routes[1].drive = Ticks(0));
    breaks(Rule::NoTime, &[Place::Route(2)], |plan| plan.routes[2].release = Ticks(0));
    breaks(Rule::NoTime, &[Place::Route(0)], |plan| plan.routes[0].stay = Ticks(0));
}

#[test]
fn times_that_do_not_cover_a_train() {
    let released = station().routes[1].release;
    breaks(Rule::ReleaseShort, &[Place::Route(1)], |plan| {
        plan.residual = released;
        plan.routes.iter_mut().for_each(|route| route.release = Ticks(released.0 + 1));
        plan.routes[1].release = Ticks(released.0 - 1);
    });
    breaks(Rule::StayShort, &[Place::Route(2)], |plan| {
        plan.standstill = Ticks(3);
        plan.routes.iter_mut().for_each(|route| route.stay = Ticks(4));
        plan.routes[2].stay = Ticks(3);
    });
    breaks(Rule::ClearShort, &[Place::Plan], |plan| {
        plan.loss = plan.clear;
        plan.routes.iter_mut().for_each(|route| route.stay = Ticks(1 + u16::from(plan.clear)));
        plan.routes.iter_mut().for_each(|route| route.release = Ticks(u16::from(plan.clear)));
    });
    // Two cycles more than the loss, but less than the losses of two circuits in turn.
    breaks(Rule::ClearShort, &[Place::Plan], |plan| {
        (plan.loss, plan.clear) = (6, 8);
        plan.routes.iter_mut().for_each(|route| (route.stay, route.release) = (Ticks(60), Ticks(60)));
    });
}

#[test]
fn paths_that_are_too_long() {
    // There is no room for a fourth place, so nothing else can be wrong with it.
    let all = broken(|plan| plan.segments[1].length = 4);
    assert_eq!(all.first(), Some(&Broken { rule: Rule::PathTooLong, place: Place::Segment(1) }));
    let all = broken(|plan| plan.routes[3].length = 4);
    assert_eq!(all.first(), Some(&Broken { rule: Rule::PathTooLong, place: Place::Route(3) }));
}

#[test]
fn points_of_a_route() {
    let reverse = |point: usize| Positions { normal: PointSet::EMPTY, reverse: PointSet::nth(point) };
    // In two places of the path, and between path and overlap.
    breaks(Rule::PointBothWays, &[Place::Route(0)], |plan| plan.routes[0].path[1].positions = reverse(0));
    breaks(Rule::PointBothWays, &[Place::Route(0)], |plan| {
        plan.routes[0].overlap.positions = plan.routes[0].overlap.positions.or(reverse(0));
    });
    breaks(Rule::PointNotPositioned, &[Place::Path(1, 0)], |plan| plan.routes[1].path[0].positions = Positions::NONE);
    breaks(Rule::PointNotPositioned, &[Place::Overlap(2)], |plan| plan.routes[2].overlap.positions = Positions::NONE);
    breaks(Rule::PointNotPositioned, &[Place::Path(2, 1)], |plan| {
        plan.points[0] = Point { detectors: circuit(1).or(circuit(3)) };
    });
}

#[test]
fn routes_that_belong_together() {
    breaks(Rule::ConflictOneWay, &[Place::Routes(0, 3)], |plan| plan.routes[0].conflicts = RouteSet::nth(3));
    let opposed = [Place::Routes(0, 2), Place::Routes(2, 0)];
    breaks(Rule::OpposingStarts, &opposed, |plan| {
        plan.routes[2].heading = Heading::Left;
        (plan.routes[2].from, plan.routes[2].continuing) = (SegmentSet::EMPTY, RouteSet::EMPTY);
    });
    breaks(Rule::TurnsBack, &[Place::Route(0), Place::Route(2)], |plan| plan.segments[0].outward = Heading::Right);
    breaks(Rule::ContinuesElsewhere, &[Place::Routes(0, 3)], |plan| {
        plan.routes[0].continuing = plan.routes[0].continuing.or(RouteSet::nth(3));
    });
    breaks(Rule::ConflictsWithItself, &[Place::Route(1)], |plan| plan.routes[1].conflicts = RouteSet::nth(1));
}

#[test]
fn segments() {
    breaks(Rule::ThroatsDiffer, &[Place::Route(1), Place::Route(3)], |plan| plan.segments[1].throat = circuit(2));
    // In an overlap and nowhere else: the shared circuit has a length already.
    breaks(Rule::SegmentShared, &[Place::Segment(0)], |plan| {
        plan.routes[1].overlap.circuits = circuit(0);
    });
    let both = [Place::Segment(0), Place::Segment(1)];
    breaks(Rule::SegmentShared, &both, |plan| {
        plan.segments[0].circuits[1] = circuit(5);
        plan.segments[0].length = 2;
    });
    breaks(Rule::PointInSegment, &[Place::Point(1)], |plan| {
        plan.points[1].detectors = plan.points[1].detectors.or(plan.segments[1].circuits[0]);
    });
    breaks(Rule::CircuitTwice, &[Place::Segment(1)], |plan| {
        plan.segments[1].circuits[1] = circuit(5);
        plan.segments[1].length = 2;
    });
    breaks(Rule::NotOneCircuit, &[Place::Segment(1)], |plan| plan.segments[1].length = 2);
    // A route cannot come in from either side.
    let both = broken(|plan| plan.routes[0].from = SegmentSet::nth(0).or(SegmentSet::nth(1)));
    assert_eq!(both, [Rule::ManySegments, Rule::TurnsBack].map(|rule| Broken { rule, place: Place::Route(0) }));
    breaks(Rule::NotThere, &[Place::Route(0), Place::Route(2)], |plan| plan.segments[0].length = 0);
}

#[test]
fn circuits_of_a_path() {
    breaks(Rule::NotOneCircuit, &[Place::Path(0, 1)], |plan| {
        plan.routes[0].path[1].circuits = circuit(2).or(circuit(7));
        plan.routes[0].continuing = RouteSet::EMPTY;
        plan.lengths[7] = Metres(1);
    });
    breaks(Rule::NotOneCircuit, &[Place::Path(0, 2)], |plan| {
        plan.routes[0].length = 3;
        plan.routes[0].continuing = RouteSet::EMPTY;
    });
    breaks(Rule::CircuitTwice, &[Place::Path(0, 2)], |plan| {
        plan.routes[0].path[2].circuits = circuit(2);
        plan.routes[0].length = 3;
    });
    breaks(Rule::NoLength, &[Place::Circuit(3)], |plan| plan.lengths[3] = Metres(0));
    breaks(Rule::NoLength, &[Place::Circuit(5)], |plan| plan.lengths[5] = Metres(0));
}

#[test]
fn what_lies_around_a_path() {
    breaks(Rule::OverlapUnderOwnPath, &[Place::Route(0)], |plan| {
        plan.routes[0].overlap.circuits = circuit(4).or(circuit(2));
    });
    breaks(Rule::EntryNotInApproach, &[Place::Route(0)], |plan| plan.routes[0].approach = circuit(9));
    breaks(Rule::EntryNotInApproach, &[Place::Route(0)], |plan| {
        plan.routes[0].entry = circuit(0).or(circuit(9));
        plan.routes[0].approach = circuit(0).or(circuit(9));
    });
    breaks(Rule::ApproachInPath, &[Place::Route(0)], |plan| plan.routes[0].approach = circuit(0).or(circuit(2)));
    breaks(Rule::ApproachInPath, &[Place::Route(0)], |plan| plan.routes[0].approach = circuit(0).or(circuit(4)));
    breaks(Rule::NothingBeyond, &[Place::Route(3)], |plan| plan.routes[3].beyond = CircuitSet::EMPTY);
    breaks(Rule::NothingBeyond, &[Place::Route(3)], |plan| plan.routes[3].beyond = circuit(5).or(circuit(4)));
}

#[test]
fn what_is_named_exists() {
    // The last route is taken away; the conflict and the continuation that name it break the rule, each on its own.
    let without_last = |plan: &mut Small| {
        plan.routes[3] = atc_kernel::interlocking::Route::NONE;
        plan.routes[2].continuing = RouteSet::EMPTY;
    };
    breaks(Rule::NotThere, &[Place::Route(0)], |plan| {
        without_last(plan);
        // From both sides, or the conflict would go one way.
        plan.routes[0].conflicts = RouteSet::nth(3);
        plan.routes[3].conflicts = RouteSet::nth(0);
    });
    breaks(Rule::NotThere, &[Place::Route(2)], |plan| {
        without_last(plan);
        plan.routes[2].continuing = RouteSet::nth(3);
        plan.routes[3].entry = circuit(3);
    });
    let flank = Positions { normal: PointSet::nth(2), reverse: PointSet::EMPTY };
    breaks(Rule::NotThere, &[Place::Route(1)], |plan| {
        plan.routes[1].path[0].positions = plan.routes[1].path[0].positions.or(flank);
    });
    breaks(Rule::NoDetector, &[Place::Route(0), Place::Route(2)], |plan| plan.points[0].detectors = CircuitSet::EMPTY);
}

#[test]
fn speed_codes() {
    breaks(Rule::CodeOutOfTable, &[Place::Route(0)], |plan| plan.routes[0].speed = SpeedCode(0));
    breaks(Rule::CodeOutOfTable, &[Place::Route(0)], |plan| plan.routes[0].speed = SpeedCode(3));
    breaks(Rule::BrakingFalls, &[Place::Plan], |plan| plan.braking[2] = Metres(50));
    breaks(Rule::BrakingFalls, &[Place::Plan], |plan| plan.braking[4] = Metres(300));
}

/// The rules that no theorem needs are those that [`Layout::with_what_proofs_need`] lets pass.
#[test]
fn only_what_engineering_asks_for_can_be_left_out() {
    let engineering = |change: fn(&mut Small)| {
        let mut plan = station();
        change(&mut plan);
        assert!(Layout::new(plan).is_err() && Layout::with_what_proofs_need(plan).is_ok());
    };
    engineering(|plan| plan.lengths[3] = Metres(0));
    engineering(|plan| plan.routes[3].beyond = CircuitSet::EMPTY);
    engineering(|plan| plan.routes[0].speed = SpeedCode(7));
    engineering(|plan| plan.routes[0].approach = circuit(9));
    let mut plan = station();
    plan.routes[1].path[0].positions = Positions::NONE;
    let found = Broken { rule: Rule::PointNotPositioned, place: Place::Path(1, 0) };
    assert_eq!(Layout::with_what_proofs_need(plan), Err(found));
}
