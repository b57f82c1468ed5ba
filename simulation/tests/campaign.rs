//! Faults: none that the line must stand leads to harm; and the campaign sees harm where there is some.

use atc_simulation::campaign::{Campaign, run};
use atc_simulation::driver::Drivers;
use atc_simulation::event::What;
use atc_simulation::fault::{Extent, Fault, Kind};
use atc_simulation::generate::Shape;
use atc_simulation::line::Line;
use atc_simulation::onboard::{Operate, Signal};
use atc_simulation::world::{Setting, World};

/// Four tracks a station, so that trains follow each other on the line.
fn line() -> Line {
    Line::generate("Four tracks", &Shape { tracks: vec![4; 3], blocks: vec![4; 2] }).expect("a line")
}

fn campaign(runs: u64, kinds: &[Kind], extent: Extent) -> Campaign {
    let (kinds, signal) = (kinds.to_vec(), Signal::Codes);
    Campaign { runs, kinds, extent, faults: 1, trains: 8, seconds: 400, seed: 1, signal, drivers: Drivers::Careful }
}

#[test]
fn no_single_fault_leads_to_harm() {
    let outcomes = run(&line(), &campaign(55, &Kind::ALL, Extent::Tolerated), &|_| ()).expect("a campaign");
    assert_eq!(outcomes.len(), Kind::ALL.len());
    for (kind, outcome) in outcomes {
        assert_eq!((outcome.runs, outcome.unsafe_runs), (5, 0), "{kind:?}: {:?}", outcome.first);
        assert!(outcome.arrivals >= 10, "{kind:?}: the trains do not get on");
    }
}

/// The same where trains run on telegrams: the ground is the kernel's whole device, with frames for both directions in turn.
#[test]
fn no_single_fault_leads_to_harm_on_telegrams() {
    for signal in [Signal::Telegrams, Signal::Both] {
        let campaign = Campaign { signal, ..campaign(22, &Kind::ALL, Extent::Tolerated) };
        for (kind, outcome) in run(&line(), &campaign, &|_| ()).expect("a campaign") {
            assert_eq!((outcome.runs, outcome.unsafe_runs), (2, 0), "{signal:?}, {kind:?}: {:?}", outcome.first);
            assert!(outcome.arrivals >= 2, "{signal:?}, {kind:?}: {} arrivals", outcome.arrivals);
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
            assert_eq!((outcome.runs, outcome.unsafe_runs), (2, 0), "{signal:?}, {kind:?}: {:?}", outcome.first);
            assert!(outcome.arrivals >= 2, "{signal:?}, {kind:?}: {} arrivals", outcome.arrivals);
        }
    }
}

/// And where the brake does not act, that is seen: too fast over the points of a station.
#[test]
fn heedless_drivers_without_a_brake_are_seen() {
    let mut line = line();
    (line.dynamics.service, line.dynamics.emergency) = (0.0, 0.0);
    let (operate, drivers, faults) = (Operate::Shortened, Drivers::Heedless, Vec::new());
    let setting = Setting { operate, trains: 2, seed: 1, faults, compared: false, signal: Signal::Telegrams, drivers };
    let mut world = World::new(&line, setting).expect("a world");
    world.run(600_000);
    let last = world.events.last().expect("an event");
    assert!(matches!(last.what, What::Overspeed { kmh, .. } if kmh > 60.0), "{last:?}");
}

/// Also on telegrams: a train that is lost for far longer than is tolerated, and the old rule of the test below.
#[test]
fn harm_is_seen_on_telegrams() {
    let lost = Campaign { faults: 4, signal: Signal::Telegrams, ..campaign(32, &[Kind::ShuntLoss], Extent::Beyond) };
    let outcome =
        |line: &Line, campaign: &Campaign| run(line, campaign, &|_| ()).expect("a campaign")[&Kind::ShuntLoss].clone();
    assert!(outcome(&line(), &lost).unsafe_runs > 0, "the campaign saw nothing");
    let flickers = Campaign { faults: 150, seconds: 600, extent: Extent::Tolerated, runs: 8, ..lost };
    assert_eq!(outcome(&line(), &flickers).unsafe_runs, 0);
    let old = Line { clears_at_once: true, ..line() };
    assert!(outcome(&old, &flickers).unsafe_runs > 0, "the campaign saw nothing");
}

/// A condition that is broken: a code that is misread for far longer than the operate time, a train that is lost for far
/// longer than is tolerated.
#[test]
fn a_broken_condition_leads_to_harm_and_is_seen() {
    for kind in [Kind::MisreadCode, Kind::ShuntLoss] {
        let campaign = Campaign { faults: 4, ..campaign(16, &[kind], Extent::Beyond) };
        let outcomes = run(&line(), &campaign, &|_| ()).expect("a campaign");
        assert!(outcomes[&kind].unsafe_runs > 0, "{kind:?}: the campaign saw nothing");
        let (_, event) = outcomes[&kind].first.as_ref().expect("an unsafe run");
        assert!(event.what.is_unsafe(), "{event:?}");
    }
}

/// An old rule: without the time for which a circuit must be reported clear, a loss of shunt that is tolerated leads to harm.
#[test]
fn an_old_rule_leads_to_harm_and_is_seen() {
    let flickers = |clears_at_once| {
        let line = Line { clears_at_once, ..line() };
        let campaign = Campaign { faults: 150, seconds: 600, ..campaign(8, &[Kind::ShuntLoss], Extent::Tolerated) };
        run(&line, &campaign, &|_| ()).expect("a campaign")[&Kind::ShuntLoss].clone()
    };
    assert_eq!(flickers(false).unsafe_runs, 0, "{:?}", flickers(false).first);
    assert!(flickers(true).unsafe_runs > 0, "the campaign saw nothing");
}

/// The truth is not the devices': whatever they say, trains that share ground collide, and points under trains derail them.
#[test]
fn the_truth_is_judged_apart_from_the_devices() {
    let line = Line::generate("Two", &Shape::loops(2, 3)).expect("a line");
    let setting = Setting {
        operate: Operate::Shortened,
        trains: 2,
        seed: 1,
        faults: Vec::new(),
        compared: false,
        signal: Signal::Codes,
        drivers: Drivers::Careful,
    };
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
