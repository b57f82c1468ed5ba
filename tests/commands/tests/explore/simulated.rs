//! The film of a simulated line: its last frame is the world as it is, and its accidents are those of the run.

use atc_film::Class;
use atc_kernel::supervision::Brake;
use atc_simulation::campaign::{self, Campaign, Cause};
use atc_simulation::defect::Defect;
use atc_simulation::driver::Drivers;
use atc_simulation::fault::{Extent, Kind};
use atc_simulation::film;
use atc_simulation::generate::Shape;
use atc_simulation::line::Line;
use atc_simulation::onboard::Signal;
use atc_simulation::world::{Setting, World};

fn setting(trains: usize, faults: Vec<atc_simulation::fault::Fault>, seed: u64) -> Setting {
    Setting { trains, seed, faults, ..Setting::default() }
}

#[allow(clippy::cast_precision_loss, reason = "distances on a line")]
#[test]
fn the_last_frame_is_the_world() {
    let line = Line::generate("Three", &Shape::single(vec![2; 3], vec![4; 2])).expect("a line");
    for end_ms in [90_000, 200_000, 333_000] {
        let mut world = World::new(&line, setting(4, Vec::new(), 1)).expect("a world");
        let film = film::of(&mut world, end_ms, 1_000).expect("a film");
        assert_eq!(u64::from(film.frames), end_ms / 1_000 + 1);
        let last = film.frames - 1;
        assert_eq!(film.time(last), world.now_ms);
        for (number, train) in world.trains.iter().enumerate() {
            let name = number.to_string();
            let value = |what: &str| film.number_at(("train", &name, what), last).expect("a number") as f64;
            assert!((value("front_m") / 10.0 - train.body.along_m(&line.track)).abs() < 0.1);
            assert!((value("tail_m") / 10.0 - train.body.tail_along_m(&line.track)).abs() < 0.1);
            assert!((value("speed") / 36.0 - train.body.speed).abs() < 0.1);
            let brake = match train.cab.brake {
                Brake::Release => "released",
                Brake::Service => "service",
                Brake::Emergency => "emergency",
            };
            assert_eq!(film.word_at(("train", &name, "brake"), last), brake);
            let on = film.word_at(("train", &name, "on"), last);
            let pieces: Vec<usize> =
                on.split(' ').map(|one| one.trim_end_matches(['+', '-', 'r']).parse().expect("a piece")).collect();
            let legs: Vec<usize> = train.body.legs.iter().map(|leg| leg.piece).collect();
            assert_eq!(pieces, legs);
            // Each piece is drawn on some plan.
            assert!(pieces.iter().all(|piece| {
                film.plans.iter().any(|plan| plan.pieces.contains(&u32::try_from(*piece).expect("a piece")))
            }));
        }
        for (circuit, reported) in line.track.circuits.iter().zip(&world.reported) {
            let said = film.word_at(("circuit", &circuit.name, "reported"), last);
            assert_eq!(said == "occupied", *reported, "{}", circuit.name);
        }
        let events = world.events.len();
        assert_eq!(film.events.len(), events);
        // Each plan's names are those of channels or of what never changes from nothing.
        for plan in &film.plans {
            for local in plan.names.keys().filter(|name| name.starts_with("circuit ")) {
                let name = local.trim_start_matches("circuit ");
                assert!(plan.svg.contains(&format!("data-circuit=\"{name}\"")), "{local}");
            }
        }
    }
}

/// An old rule (a circuit is clear as soon as it is reported clear) leads to an accident: its film ends with it.
#[test]
fn an_accident_is_the_end_of_its_film() {
    let line = Line::generate("Four", &Shape::single(vec![4; 3], vec![4; 2])).expect("a line");
    let campaign = Campaign {
        runs: 8,
        causes: vec![Cause { defects: vec![Defect::ClearsAtOnce], kinds: vec![Kind::ShuntLoss] }],
        extent: Extent::Tolerated,
        faults: 150,
        trains: 8,
        seconds: 600,
        seed: 1,
        signal: Signal::Codes,
        drivers: Drivers::Careful,
    };
    let accident = (0..campaign.runs).find_map(|run| {
        let (_, setting) = campaign::setting(&line, &campaign, run);
        let mut world = World::new(&line, setting).expect("a world");
        let film = film::of(&mut world, 600_000, 1_000).expect("a film");
        world.is_unsafe.then(|| (film, world.now_ms, world.events.last().cloned().expect("an event")))
    });
    let (film, now_ms, event) = accident.expect("an accident");
    assert!(event.what.is_unsafe());
    let harm: Vec<_> = film.events.iter().filter(|event| event.class == Class::Harm).collect();
    assert!(!harm.is_empty() && harm.iter().all(|event| event.at == film.frames - 1), "{harm:?}");
    assert_eq!(film.time(film.frames - 1), now_ms);
    assert_eq!(film.clock.last, Some(now_ms).filter(|now| !now.is_multiple_of(1_000)));
}
