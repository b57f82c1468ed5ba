//! Faults: none that the line must stand leads to harm; and the campaign sees harm where there is some.

use atc_simulation::campaign::{Campaign, Cause, Outcome, run};
use atc_simulation::cut_sets;
use atc_simulation::defect::Defect;
use atc_simulation::driver::Drivers;
use atc_simulation::event::What;
use atc_simulation::fault::{Extent, Fault, Kind};
use atc_simulation::generate::Shape;
use atc_simulation::line::Line;
use atc_simulation::onboard::Signal;
use atc_simulation::train::Train;
use atc_simulation::world::{Setting, World};

/// Four tracks a station, so that trains follow each other on the line.
fn line() -> Line {
    Line::generate("Four tracks", &Shape::single(vec![4; 3], vec![4; 2])).expect("a line")
}

fn campaign(runs: u64, kinds: &[Kind], extent: Extent) -> Campaign {
    let (causes, signal) = (kinds.iter().copied().map(Cause::from).collect(), Signal::Codes);
    Campaign { runs, causes, extent, faults: 1, trains: 8, seconds: 400, seed: 1, signal, drivers: Drivers::Careful }
}

/// What became of a campaign with one cause.
fn one(line: &Line, campaign: &Campaign) -> Outcome {
    run(line, campaign, &|_| ()).expect("a campaign").into_values().next().expect("a cause")
}

/// A loss of shunt, under a ground that believes the first clear report.
fn old_rule() -> Cause {
    Cause { defects: vec![Defect::ClearsAtOnce], kinds: vec![Kind::ShuntLoss] }
}

#[test]
fn no_single_fault_leads_to_harm() {
    let outcomes = run(&line(), &campaign(55, &Kind::ALL, Extent::Tolerated), &|_| ()).expect("a campaign");
    assert_eq!(outcomes.len(), Kind::ALL.len());
    for (kind, outcome) in outcomes {
        assert_eq!((outcome.runs, outcome.unsafe_runs), (5, 0), "{kind}: {:?}", outcome.first);
        assert!(outcome.arrivals >= 10, "{kind}: the trains do not get on");
    }
}

/// The same where trains run on telegrams: the ground is the kernel's whole device, with frames for both directions in turn.
#[test]
fn no_single_fault_leads_to_harm_on_telegrams() {
    for signal in [Signal::Telegrams, Signal::Both] {
        let campaign = Campaign { signal, ..campaign(22, &Kind::ALL, Extent::Tolerated) };
        for (kind, outcome) in run(&line(), &campaign, &|_| ()).expect("a campaign") {
            assert_eq!((outcome.runs, outcome.unsafe_runs), (2, 0), "{signal:?}, {kind}: {:?}", outcome.first);
            assert!(outcome.arrivals >= 2, "{signal:?}, {kind}: {} arrivals", outcome.arrivals);
        }
    }
}

/// Drivers who motor whatever the cab says: the device on board holds the train, under every single fault.
#[test]
fn heedless_drivers_are_held() {
    for signal in [Signal::Codes, Signal::Telegrams, Signal::Both] {
        let drivers = Drivers::Heedless;
        let campaign = Campaign { signal, drivers, ..campaign(22, &Kind::ALL, Extent::Tolerated) };
        for (kind, outcome) in run(&line(), &campaign, &|_| ()).expect("a campaign") {
            assert_eq!((outcome.runs, outcome.unsafe_runs), (2, 0), "{signal:?}, {kind}: {:?}", outcome.first);
            assert!(outcome.arrivals >= 2, "{signal:?}, {kind}: {} arrivals", outcome.arrivals);
        }
    }
}

/// The ground's codes and the pattern on board are two barriers: with one of them wrong drivers who obey nothing come to no harm, with both they do.
/// So a wrong pattern is seen.
#[test]
fn codes_and_pattern_stand_for_each_other() {
    let (codes, pattern) = (Defect::CodesTooHigh, Defect::PatternTooHigh);
    let cause = |defects: &[Defect]| Cause { defects: defects.to_vec(), kinds: vec![Kind::Interruption] };
    let unsafe_runs = |signal, defects: &[Defect]| {
        let (drivers, causes) = (Drivers::Heedless, vec![cause(defects)]);
        let campaign = Campaign { signal, drivers, causes, trains: 4, ..campaign(3, &[], Extent::Tolerated) };
        let outcome = one(&Line::generate("Three", &Shape::loops(3, 4)).expect("a line"), &campaign);
        assert!(outcome.unsafe_runs > 0 || outcome.arrivals > 6, "{signal:?}, {defects:?}: nobody runs");
        outcome.unsafe_runs
    };
    for signal in [Signal::Telegrams, Signal::Both] {
        assert_eq!((unsafe_runs(signal, &[codes]), unsafe_runs(signal, &[pattern])), (0, 0), "{signal:?}");
        assert_eq!(unsafe_runs(signal, &[codes, pattern]), 3, "{signal:?}");
    }
    // On codes alone there is no pattern.
    assert_eq!((unsafe_runs(Signal::Codes, &[pattern]), unsafe_runs(Signal::Codes, &[codes])), (0, 3));
}

/// A driver who motors does not move a train that may not run: it is held at a stand (TRN-13). Two runs in which trains that wait on the line under
/// a stop code, released at a stand, crept into the next circuit.
#[test]
fn a_train_that_may_not_run_does_not_creep() {
    let line = Line::generate("Three", &Shape::loops(3, 4)).expect("a line");
    let mut waits_ms = 0;
    for (seed, with) in [(542, Kind::FalseOccupancy), (55, Kind::LostTelegram)] {
        let causes = vec![Cause { kinds: vec![with, Kind::RestartStation], ..Cause::default() }];
        let drivers = Drivers::Heedless;
        let crept = Campaign {
            causes,
            drivers,
            faults: 20,
            trains: 4,
            seconds: 600,
            seed,
            ..campaign(1, &[], Extent::Tolerated)
        };
        let mut world = World::new(&line, atc_simulation::campaign::setting(&line, &crept, 0).1).expect("a world");
        while world.now_ms < 600_000 && !world.is_unsafe {
            world.tick();
            // Blocks of the line are called L1-2.
            let circuit =
                |train: &Train| &line.track.circuits[line.track.pieces[train.body.front().piece].circuit].name;
            let on_the_line = |train: &&Train| circuit(train).contains('L');
            let waits =
                |train: &Train| train.body.speed <= 0.0 && train.cab.permission.speed.is_some_and(|it| it.0 == 0);
            waits_ms += if world.trains.iter().filter(on_the_line).any(waits) { 10 } else { 0 };
        }
        assert!(!world.is_unsafe, "{:?}", world.events.last());
    }
    assert!(waits_ms > 60_000, "{waits_ms} ms");
}

/// And where the brake does not act, that is seen: too fast over the points of a station.
#[test]
fn heedless_drivers_without_a_brake_are_seen() {
    let mut line = line();
    (line.dynamics.service, line.dynamics.emergency) = (0.0, 0.0);
    let (drivers, signal) = (Drivers::Heedless, Signal::Telegrams);
    let setting = Setting { trains: 2, signal, drivers, ..Setting::default() };
    let mut world = World::new(&line, setting).expect("a world");
    world.run(600_000);
    let last = world.events.last().expect("an event");
    assert!(matches!(last.what, What::Overspeed { kmh, .. } if kmh > 60.0), "{last:?}");
}

/// Also on telegrams: a train that is lost for far longer than is tolerated, and the old rule of the test below.
#[test]
fn harm_is_seen_on_telegrams() {
    let lost = Campaign { faults: 4, signal: Signal::Telegrams, ..campaign(32, &[Kind::ShuntLoss], Extent::Beyond) };
    let outcome = |campaign: &Campaign| one(&line(), campaign);
    assert!(outcome(&lost).unsafe_runs > 0, "the campaign saw nothing");
    let flickers = Campaign { faults: 150, seconds: 600, extent: Extent::Tolerated, runs: 8, ..lost };
    assert_eq!(outcome(&flickers).unsafe_runs, 0);
    let old = Campaign { causes: vec![old_rule()], ..flickers };
    assert!(outcome(&old).unsafe_runs > 0, "the campaign saw nothing");
}

/// A condition that is broken: a code that is misread for far longer than the operate time, a train that is lost for far
/// longer than is tolerated.
#[test]
fn a_broken_condition_leads_to_harm_and_is_seen() {
    for kind in [Kind::MisreadCode, Kind::ShuntLoss] {
        let campaign = Campaign { faults: 4, ..campaign(16, &[kind], Extent::Beyond) };
        let outcome = one(&line(), &campaign);
        assert!(outcome.unsafe_runs > 0, "{kind:?}: the campaign saw nothing");
        let (_, event) = outcome.first.as_ref().expect("an unsafe run");
        assert!(event.what.is_unsafe(), "{event:?}");
    }
}

/// An old rule: without the time for which a circuit must be reported clear, a loss of shunt that is tolerated leads to harm.
#[test]
fn an_old_rule_leads_to_harm_and_is_seen() {
    let flickers = |cause: Cause| {
        let campaign = campaign(8, &[], Extent::Tolerated);
        one(&line(), &Campaign { faults: 150, seconds: 600, causes: vec![cause], ..campaign })
    };
    let now = flickers(Kind::ShuntLoss.into());
    assert_eq!(now.unsafe_runs, 0, "{:?}", now.first);
    assert!(flickers(old_rule()).unsafe_runs > 0, "the campaign saw nothing");
}

/// The truth is not the devices': whatever they say, trains that share ground collide, and points under trains derail them.
#[test]
fn the_truth_is_judged_apart_from_the_devices() {
    let line = Line::generate("Two", &Shape::loops(2, 3)).expect("a line");
    let setting = Setting { trains: 2, ..Setting::default() };
    let world = || World::new(&line, setting.clone()).expect("a world");

    // A train is put where another one stands.
    let mut collided = world();
    collided.trains[1].body = collided.trains[0].body.clone();
    for leg in &collided.trains[0].body.legs {
        collided.on_piece[leg.piece] += 1;
        collided.on_circuit[line.track.pieces[leg.piece].circuit] += 1;
    }
    collided.run(100);
    assert!(matches!(collided.events.last().expect("an event").what, What::Collision { .. }));

    // A train that runs on without any authority overruns its stop point, and the point behind it if that does not lie for it.
    let mut overran = world();
    overran.trains[0].body.speed = 30.0;
    let too_fast = |world: &mut World| {
        world.run(60_000);
        let last = world.events.last().expect("an event");
        assert!(matches!(last.what, What::Overspeed { train: 0, kmh, .. } if kmh > 100.0), "{last:?}");
        world.is_unsafe = false;
        world.run(60_000);
    };
    too_fast(&mut overran);
    let last = overran.events.last().expect("an event");
    assert!(matches!(last.what, What::Overrun { train: 0, .. }), "{last:?}");

    // It comes over the trailing point of its track in the wrong position.
    let mut derailed = world();
    for point in &mut derailed.points {
        point.reverse = true;
    }
    derailed.trains[0].body.speed = 30.0;
    derailed.trains[0].told_ms.fill(60_000);
    too_fast(&mut derailed);
    let last = derailed.events.last().expect("an event");
    assert!(matches!(last.what, What::Derailment { train: 0, .. }), "{last:?}");
}

#[test]
fn a_fault_lasts_as_long_as_it_says() {
    let fault = Fault { kind: Kind::Interruption, from_ms: 1_003.5, lasts_ms: 20.0, which: 0, much: 0 };
    let cycles: Vec<u32> = (99..106).filter(|cycle| fault.meets(f64::from(*cycle) * 10.0, 10.0)).collect();
    assert_eq!(cycles, [100, 101, 102], "what begins between two cycles is in one more of them");
}

/// Every cut set comes to harm, and neither of its two alone does.
#[test]
fn cut_sets_lead_to_harm_and_nothing_less_does() {
    for set in cut_sets::all() {
        let (row, page) = set.show().expect("a line");
        assert!(row.harm.is_some() && row.alone == [None, None], "{row:?}");
        assert!(page.html.contains(&row.name), "{}", row.name);
    }
}
