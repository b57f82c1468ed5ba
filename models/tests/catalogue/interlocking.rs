//! The interlocking: what the models show, wrong layouts, traces that are runs of the kernel, and the ground truth.

use crate::common::outcome;
use crate::meeting::{meeting, turn};
use crate::outcomes;
use atc_kernel::Machine;
use atc_kernel::interlocking::{
    CircuitId, CircuitSet, Input, Layout, Positions, Request, RouteId, Rule, State, Travel, movement,
};
use atc_models::interlocking::counted_between::{Failure, cut_sets};
use atc_models::interlocking::device::{Device, Real};
use atc_models::interlocking::environment::{Environment, Obey, Start};
use atc_models::interlocking::ground::{Ahead, Blade, Heading};
use atc_models::interlocking::stations::{
    Overlaps, PLACES, POINTS, ROUTES, SEGMENTS, circuits, counted_line, crossing, halt, junction, passing,
    passing_loop, rest, siding, terminus,
};
use atc_models::interlocking::yard::{self, Yard};
use atc_models::interlocking::{Purpose, Sight};
use atc_models::{Expectation, Subject, Verdict};
use atc_protocol::machine::Machine as _;
use atc_protocol::machine::interlocking::{Config, Interlocked};
use std::collections::{BTreeSet, HashSet};

#[test]
fn a_sight_that_is_not_reached_turns_red() {
    let station = passing_loop(Overlaps::None);
    let idle = Environment { requests: Vec::new(), ..meeting() };
    let sights = [
        Sight::Arrived,
        Sight::Meet,
        Sight::Failed,
        Sight::Releasing,
        Sight::RunsPast,
        Sight::BehindTheFirst,
        Sight::OverlapGivenUp,
        Sight::Turned,
        Sight::Slides,
        Sight::Unheard,
        Sight::BlockedUnderTrain,
        Sight::ConfirmedAhead,
        Sight::Restricted,
        Sight::Telegram,
        Sight::NoDirection,
    ];
    for sight in sights.map(|sight| [sight]) {
        let purpose = Purpose::Safe(Box::leak(Box::new(sight)));
        let outcome = outcome(Yard::new(Real, station.clone(), idle.clone(), purpose));
        assert!(outcome.complete && !outcome.ok(), "{sight:?}");
        assert_eq!(outcome.properties.last().map(|p| p.verdict), Some(Verdict::NotFound), "{sight:?}");
    }
    let filled = outcome(Yard::new(Real, station, meeting(), Purpose::Safe(&[Sight::Filled])));
    assert_eq!(filled.properties.last().map(|p| p.verdict), Some(Verdict::NotFound));
}

/// A circuit that counts as clear one cycle later than a train may be lost is enough for safety. For progress it takes two: a train that is
/// lost just where it goes from one circuit to the next is not seen in both together, has not entered in order, and is told nothing more.
#[test]
fn a_train_that_is_lost_between_two_circuits_is_safe_and_may_be_stranded() {
    let train = Start { at: rest::L, heading: Heading::Up, segment: Some(0) };
    let lost = Environment {
        obey: Obey::Telegrams,
        residual: 0,
        unheard: 1,
        unheard_in: 1 << rest::THROAT | 1 << rest::FIRST,
        before: vec![turn(0, Travel::Toward)],
        requests: vec![Request::Set(RouteId::ZERO)],
        ..Environment::usual(vec![train])
    };
    let failed = |clear| {
        let station = siding().with(|plan| plan.clear = clear);
        let outcome = outcome(Yard::new(Real, station, lost.clone(), Purpose::Finishes(&[Sight::Arrived])));
        outcome.properties.iter().filter(|p| !p.ok()).map(|p| p.name.clone()).collect::<Vec<_>>()
    };
    assert_eq!(failed(2), ["all-can-arrive"]);
    assert!(failed(3).is_empty());
}

#[test]
fn every_assumption_is_lifted_by_a_model_that_shows_what_happens() {
    let expected: BTreeSet<_> = [
        "loss-of-shunt-within-clear",
        "approach-covers-braking",
        "release-covers-residual-running",
        "overlap-covers-sliding",
        "flank-complete",
        "fouling-declared",
        "path-complete",
        "points-detect-truly",
        "points-leave-while-driven",
        "trains-obey-signals",
        "neighbour-turns-alike",
        "turn-outlasts-telegrams",
        "line-end-asks",
        "views-of-a-line-meet",
        "start-outlasts-running",
        "verified-reset",
        "called-on-runs-on-sight",
    ]
    .into();
    let mut excluding = BTreeSet::new();
    for outcome in outcomes(&["interlocking", "whole-line"]) {
        for property in outcome.properties.iter().filter(|p| p.expectation == Expectation::HazardFound) {
            let last = property.trace.as_ref().and_then(|trace| trace.steps.last()).expect("a trace");
            assert_eq!(last.words["hazard"], true, "{}", outcome.model);
            excluding.extend(property.excluded_by.iter().map(String::as_str).filter(|id| !id.starts_with("ILK-")));
        }
    }
    assert_eq!(excluding, expected);
}

/// Of the 13 kinds of fault on a counted line between two stations, these pairs let trains meet, and no other.
#[test]
fn the_pairs_of_faults_on_a_counted_line_between_two_stations() {
    let name = "interlocking-counted-between-pairs";
    let outcome = outcomes(&[name]).find(|outcome| outcome.model == name).expect("in the catalogue");
    let cuts = outcome.cut_sets.iter().map(|cut| (cut.faults.join(" and "), cut.excluded_by.join(" ")));
    let expected = [
        ("check-in-lost and missed-detection", "check-in-fail-safe"),
        ("missed-detection and phantom-detection", "independent-detectors"),
        ("missed-detection and spurious-check-out", "check-out-not-spurious"),
        ("missed-detection and wrong-reset", "verified-reset"),
    ];
    assert_eq!(cuts.collect::<Vec<_>>(), expected.map(|(faults, by)| (faults.to_owned(), by.to_owned())));
    for cut in &outcome.cut_sets {
        assert!(outcome.assumptions_lifted.contains(&cut.excluded_by[0]), "{:?}", cut.faults);
        assert_eq!(cut.trace.steps.last().map(|step| &step.words["hazard"]), Some(&true.into()), "{:?}", cut.faults);
    }
    let (kinds, all) = (Failure::all().len(), cut_sets::candidates().len());
    assert_eq!((kinds, all), (13, 13 + 13 * 14 / 2));
}

#[test]
fn a_trace_is_what_the_model_saw() {
    let mut steps = 0;
    for outcome in outcomes(&["interlocking", "whole-line"]) {
        for trace in outcome.properties.iter().filter_map(|property| property.trace.as_ref()) {
            for step in trace.steps.iter().filter(|step| step.words.contains_key("proceed_by_the_model")) {
                assert_eq!(step.output["proceed"], step.words["proceed_by_the_model"], "{}", outcome.model);
                steps += 1;
            }
        }
    }
    assert!(steps > 400, "{steps} steps");
}

/// Which wrong layouts the kernel's own rules refuse; the others can be told only from the tracks.
#[test]
fn wrong_layouts_are_wrong() {
    let first = |plan| Layout::new(plan).err().map(|broken| broken.rule);
    let mut plan = *passing_loop(Overlaps::Throat).layout.plan();
    plan.routes.iter_mut().for_each(|route| route.approach = circuits(0));
    assert_eq!(first(plan), Some(Rule::EntryNotInApproach));
    assert!(Layout::with_what_proofs_need(plan).is_ok());
    let mut plan = *crossing().layout.plan();
    plan.routes[0].conflicts = atc_kernel::interlocking::RouteSet::EMPTY;
    assert_eq!(first(plan), Some(Rule::ConflictOneWay));
    let mut plan = *junction().layout.plan();
    plan.routes[0].path[0].positions = Positions::NONE;
    assert_eq!(first(plan), Some(Rule::PointNotPositioned));
}

/// Every reachable state, by a search of its own: no fingerprints, no early end.
fn reachable<D: Device>(model: &Yard<D>) -> HashSet<yard::State> {
    let mut pending = model.initial();
    let mut seen: HashSet<_> = pending.iter().copied().collect();
    let mut actions = Vec::new();
    while let Some(state) = pending.pop() {
        model.actions(&state, &mut actions);
        for action in actions.drain(..) {
            pending.extend(model.next(&state, &action).filter(|next| seen.insert(*next)));
        }
    }
    seen
}

#[test]
fn a_plain_search_counts_the_same_states() {
    let counted =
        outcomes(&["interlocking"]).find(|o| o.model == "interlocking-loop").expect("in the catalogue").unique_states;
    let model = Yard::new(Real, passing_loop(Overlaps::Throat), meeting(), Purpose::Safe(&[]));
    assert_eq!(reachable(&model).len(), counted);
}

/// What is left out of a model's state changes nothing, and the telegrams of all circuits are those that the model reads.
#[test]
fn the_kept_state_is_the_kernels() {
    let station = passing_loop(Overlaps::Throat);
    let model = Yard::new(Real, station.clone(), meeting(), Purpose::Safe(&[]));
    let mut telegrams = 0;
    for state in reachable(&model).iter().step_by(3) {
        let kernel = state.kept.kernel(&station.layout);
        assert_eq!(yard::Kept::of(&kernel), state.kept);
        assert!(kernel.is_valid(&station.layout));
        let mut cycles = Vec::new();
        model.actions(state, &mut cycles);
        for cycle in cycles.iter().step_by(7) {
            let (next, output) = station.layout.cycle(kernel, cycle.input);
            let later = State { epoch: atc_kernel::interlocking::Epoch(40_000), ..kernel };
            assert_eq!(yard::Kept::of(&station.layout.cycle(later, cycle.input).0), yard::Kept::of(&next));
            let contents = output.table.read(next.epoch).expect("the table of this cycle");
            for (circuit, telegram) in (0..6).zip(station.layout.telegrams(&output.table, next.epoch)) {
                let circuit = CircuitId::new(circuit).expect("a circuit");
                assert_eq!(telegram, Some(movement(&station.layout, &contents, circuit)));
                telegrams += usize::from(telegram.is_some_and(|telegram| telegram.is_open()));
            }
        }
    }
    assert!(telegrams > 1000, "{telegrams}");
}

#[test]
fn the_ground_is_as_drawn() {
    let ground = passing_loop(Overlaps::Throat).ground;
    let (normal, reverse) = ([Blade::Normal; 2], [Blade::Reverse; 2]);
    let ahead = |from, heading, blades: [Blade; 2]| ground.ahead(from, heading, blades);
    assert_eq!(ahead(passing::WEST, Heading::Up, normal), Ahead::Circuit(passing::ONE));
    assert_eq!(ahead(passing::WEST, Heading::Up, reverse), Ahead::Circuit(passing::TWO));
    assert_eq!(ahead(passing::ONE, Heading::Up, normal), Ahead::Circuit(passing::EAST));
    assert_eq!(ahead(passing::ONE, Heading::Up, reverse), Ahead::Trailing(passing::EAST));
    assert_eq!(ahead(passing::E, Heading::Up, normal), Ahead::Nothing);
    assert!(matches!(ahead(passing::EAST, Heading::Down, [Blade::ToReverse; 2]), Ahead::Between(_)));
    let diamond = crossing().ground;
    assert!(diamond.touch(1 << 1, 1 << 4) && diamond.touch(1 << 4, 1 << 1) && !diamond.touch(1 << 1, 1 << 3));
    assert_eq!(terminus().ground.ahead(2, Heading::Up, normal), Ahead::Nothing);
    assert_eq!(station_sizes(), [6, 6, 6, 4, 4]);
}

fn station_sizes() -> [usize; 5] {
    [passing_loop(Overlaps::None), junction(), crossing(), terminus(), siding()]
        .map(|station| station.ground.circuits.len())
}

#[test]
fn a_model_starts_from_the_kernels_initial_state() {
    let model = Yard::new(Real, passing_loop(Overlaps::Throat), meeting(), Purpose::Safe(&[]));
    let [state] = model.initial()[..] else { panic!("one initial state") };
    let layout = &model.station.layout;
    let quiet = Input {
        occupied: CircuitSet::EMPTY,
        detected: Positions::NONE,
        request: None,
        orders: atc_kernel::interlocking::Orders {
            unblock: CircuitSet::ALL,
            lift: CircuitSet::ALL,
            ..Default::default()
        },
        consent: atc_kernel::interlocking::SegmentSet::EMPTY,
    };
    let (after, _) = layout.cycle(layout.initial(), quiet);
    assert_eq!(yard::Kept::of(&after), state.kept);
}

#[test]
fn the_plan_in_a_trace_is_that_of_the_station() {
    let loops = [Overlaps::Throat, Overlaps::None].map(passing_loop);
    let others = [junction(), crossing(), terminus(), siding(), counted_line(), halt()];
    for station in loops.into_iter().chain(others) {
        let plan = *station.layout.plan();
        let trace = Yard::new(Real, station, meeting(), Purpose::Safe(&[])).trace(&[]);
        let config: Config = serde_json::from_str(&trace.config.to_string()).expect("a configuration");
        let machine: Interlocked<ROUTES, PLACES, POINTS, SEGMENTS> =
            Interlocked::open(&config).expect("it keeps the rules");
        assert_eq!(machine.layout().plan(), &plan, "{}", trace.config["plan"]["station"]);
    }
}
