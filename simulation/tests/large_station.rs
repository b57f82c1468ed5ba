//! Large stations on a line.

use std::path::Path;
use std::sync::Arc;

use atc_kernel::interlocking::Large;
use atc_layout::with_room;
use atc_simulation::defect::Defect;
use atc_simulation::driver::Drivers;
use atc_simulation::event::What;
use atc_simulation::fault::{Extent, Fault, Kind};
use atc_simulation::generate::Shape;
use atc_simulation::ground::{Held, Station};
use atc_simulation::line::Line;
use atc_simulation::onboard::Signal;
use atc_simulation::world::{Setting, World};

fn example() -> Line {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/large-station.toml");
    Line::read(&file).expect("a line")
}

fn arrivals(world: &World<'_>) -> usize {
    world.events.iter().filter(|event| matches!(event.what, What::Arrived { .. })).count()
}

/// By codes with what a line must tolerate, and by telegrams: nothing is unsafe, and trains arrive.
#[test]
fn trains_run_through_a_large_station() {
    let line = example();
    assert_eq!(line.stations[1].sound.names.routes.len(), 96);
    let fault = |kind, seed| Fault::drawn(kind, Extent::Tolerated, &line, (60_000.0, 700_000.0), seed);
    let faults: Vec<_> =
        [(Kind::FalseOccupancy, 1), (Kind::ShuntLoss, 2), (Kind::LostTelegram, 3), (Kind::LatePoint, 4)].into();
    let mut faults: Vec<_> = faults.into_iter().map(|(kind, seed)| fault(kind, seed)).collect();
    faults.sort_by(|one, other| one.from_ms.total_cmp(&other.from_ms));
    for (signal, faults, seconds, least) in [(Signal::Codes, faults, 900, 6), (Signal::Telegrams, Vec::new(), 500, 2)] {
        let setting = Setting { trains: 30, signal, faults, ..Setting::default() };
        let mut world = World::new(&line, setting).expect("a world");
        world.run(seconds * 1000);
        assert!(!world.is_unsafe, "{:?}", world.events.last());
        assert!(arrivals(&world) >= least, "{} arrivals", arrivals(&world));
        // In one of the last tracks, whose numbers are not in the first word of a set.
        let far = |event: &&atc_simulation::event::Event| {
            matches!(&event.what, What::Set { station, route } if *station == line.stations[1].name
                && line.stations[1].sound.names.routes.iter().position(|name| name == route) >= Some(64))
        };
        assert!(world.events.iter().any(|event| far(&event)), "no route beyond the first 64 was set");
    }
}

/// What is wrong in a large station's device does harm as it does in a small one's.
#[test]
fn a_wrong_large_station_does_harm() {
    let line = example();
    let setting =
        Setting { trains: 30, defects: vec![Defect::CodesTooHigh], drivers: Drivers::Heedless, ..Setting::default() };
    let mut world = World::new(&line, setting).expect("a world");
    world.run(900_000);
    assert!(world.is_unsafe, "codes from which no train can stop, and nothing happened");
}

/// The devices of small stations as large ones: every event is the same.
#[test]
fn a_large_device_runs_a_line_as_a_small_one() {
    let line = Line::generate("Three", &Shape::single(vec![3, 4, 3], vec![4, 3])).expect("a line");
    let faults: Vec<_> = [1, 2]
        .map(|seed| Fault::drawn(Kind::FalseOccupancy, Extent::Tolerated, &line, (60_000.0, 400_000.0), seed))
        .into();
    let run = |large: bool| {
        let setting = Setting { trains: 7, faults: faults.clone(), ..Setting::default() };
        let mut world = World::new(&line, setting).expect("a world");
        for (station, place) in world.stations.iter_mut().zip(&line.stations).filter(|_| large) {
            let made = || {
                let compiled = place.description.compile_to::<256, 32, 128, 32, Large>().expect("it keeps every rule");
                Held::new(Arc::from(compiled.layout()), compiled.names.circuits.len())
            };
            let device = with_room(made).expect("there is room");
            let (circuits, segments) = (place.sound.names.circuits.len(), place.sound.model.segments.len());
            *station = Station::new(Box::new(device), circuits, segments);
        }
        world.run(900_000);
        (arrivals(&world), world.events)
    };
    let (small, large) = (run(false), run(true));
    assert_eq!(small, large);
    assert!(small.0 >= 6, "{} arrivals", small.0);
}

/// Of every number of tracks: each is one track, from either side, and a train stands on it alone.
#[test]
fn every_number_of_tracks() {
    for tracks in [12, 13, 25, 37] {
        let line = Line::generate("Tracks", &Shape::single(vec![2, tracks, 2], vec![3, 3])).expect("a line");
        assert_eq!(line.stations[1].platforms.len(), tracks);
        let world = World::new(&line, Setting { trains: line.room() - 1, ..Setting::default() }).expect("a world");
        assert!(world.on_circuit.iter().all(|trains| *trains <= 1), "{tracks} tracks: two trains in one circuit");
    }
}
