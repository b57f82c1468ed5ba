//! Lines: what is read, what is refused, and that a run is the same every time.

use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};

use atc_kernel::permitted::Basis;
use atc_simulation::event::What;
use atc_simulation::fault::{Extent, Fault, Kind};
use atc_simulation::generate::Shape;
use atc_simulation::line::Line;
use atc_simulation::onboard::Signal;
use atc_simulation::record::Record;
use atc_simulation::world::{Setting, World};
use atc_simulation::{charts, diagram};

fn setting(trains: usize, seed: u64, faults: Vec<Fault>) -> Setting {
    Setting { trains, seed, faults, ..Setting::default() }
}

fn example(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("examples").join(name)
}

fn ended(line: &Line, setting: Setting, seconds: u64) -> World<'_> {
    let mut world = World::new(line, setting).expect("a world");
    world.run(seconds * 1000);
    world
}

#[test]
fn a_run_is_the_same_every_time_and_another_seed_is_another_run() {
    let line = Line::read(&example("three-stations.toml")).expect("a line");
    let fault = |seed| vec![Fault::drawn(Kind::FalseOccupancy, Extent::Tolerated, &line, (60_000.0, 400_000.0), seed)];
    let events = |seed| ended(&line, setting(4, seed, fault(seed)), 500).events;
    assert_eq!(events(1), events(1));
    assert_ne!(events(1), events(2));
}

/// Nothing is unsafe, every train comes somewhere, and all of them again and again.
#[test]
fn trains_go_to_and_fro_for_two_hours() {
    let line = Line::read(&example("three-stations.toml")).expect("a line");
    let world = ended(&line, setting(4, 1, Vec::new()), 7_200);
    assert!(!world.is_unsafe, "{:?}", world.events.last());
    for number in 0..4 {
        let arrived = |event: &&atc_simulation::event::Event| {
            matches!(event.what, What::Arrived { train, .. } if train == number) && event.at_ms > 3_600_000
        };
        assert!(world.events.iter().filter(arrived).count() >= 5, "train {number} does not get on");
    }
}

/// Trains on telegrams know where they are, and are permitted to run by their pattern.
#[test]
fn trains_run_on_telegrams_alone() {
    let line = Line::read(&example("three-stations.toml")).expect("a line");
    let setting = Setting { signal: Signal::Telegrams, ..setting(4, 1, Vec::new()) };
    let mut world = World::new(&line, setting).expect("a world");
    let (mut by_pattern, mut placed) = (0, 0);
    while world.now_ms < 1_800_000 && !world.is_unsafe {
        world.tick();
        let cab = world.trains[0].cab;
        assert_ne!(cab.permission.basis, Basis::Analog);
        by_pattern += u32::from(cab.permission.basis == Basis::Pattern && world.trains[0].body.speed > 1.0);
        placed += u32::from(cab.position.is_some());
    }
    assert!(!world.is_unsafe, "{:?}", world.events.last());
    assert!(by_pattern > 20_000 && placed > 100_000, "{by_pattern} {placed}");
    let arrived = world.events.iter().filter(|event| matches!(event.what, What::Arrived { .. })).count();
    assert!(arrived >= 12, "{arrived} arrivals");
}

#[test]
fn the_large_line_has_64_circuits_and_20_trains() {
    let line = Line::read(&example("four-stations.toml")).expect("a line");
    assert_eq!((line.track.circuits.len(), line.stations.len(), line.number_of_trains), (64, 4, Some(20)));
    let world = ended(&line, setting(20, 1, Vec::new()), 900);
    assert!(!world.is_unsafe, "{:?}", world.events.last());
    assert!(world.events.iter().filter(|event| matches!(event.what, What::Arrived { .. })).count() >= 10);
}

/// The same stations as files of their own, named one by one.
#[test]
fn stations_may_be_files_of_their_own() {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("stations");
    fs::create_dir_all(&folder).expect("a folder");
    let mut text = "name = \"Files\"\n".to_owned();
    for (number, (_, layout)) in Shape::loops(3, 4).stations().into_iter().enumerate() {
        fs::write(folder.join(format!("{number}.toml")), layout).expect("a file");
        writeln!(text, "[[station]]\nlayout = \"{number}.toml\"").expect("a string");
    }
    fs::write(folder.join("line.toml"), text).expect("a file");
    let (line, made) =
        (Line::read(&folder.join("line.toml")).expect("a line"), Line::generate("Files", &Shape::loops(3, 4)));
    let events = |line: &Line| ended(line, setting(3, 1, Vec::new()), 300).events;
    assert_eq!(events(&line), events(&made.expect("a line")));
}

/// Behind a track lies one more plain circuit, over which trains from one side come: two trains would begin on one track.
#[test]
fn a_circuit_of_two_tracks_is_refused() {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("two-tracks");
    fs::create_dir_all(&folder).expect("a folder");
    let mut text = "name = \"Files\"\n".to_owned();
    for (number, (_, layout)) in Shape::loops(3, 4).stations().into_iter().enumerate() {
        let more =
            "[[circuit]]\nname = \"1X\"\nlength_m = 200\nleft = \"x1\"\nright = \"E1\"\n[[circuit]]\nname = \"1A\"";
        let with = layout
            .replace("left = \"m1\"\nright = \"E1\"", "left = \"m1\"\nright = \"x1\"")
            .replace("[[circuit]]\nname = \"1A\"", more)
            .replace("path = [\"ET\", \"1B\", \"1A\"]", "path = [\"ET\", \"1X\", \"1B\", \"1A\"]")
            .replace("entry = \"1B\"\npath = [\"ET\"]", "entry = \"1B\"\npath = [\"1X\", \"ET\"]");
        assert_ne!(with, layout);
        fs::write(folder.join(format!("{number}.toml")), if number == 1 { with } else { layout }).expect("a file");
        writeln!(text, "[[station]]\nlayout = \"{number}.toml\"").expect("a string");
    }
    fs::write(folder.join("line.toml"), text).expect("a file");
    let error = Line::read(&folder.join("line.toml")).expect_err("a track of two lengths");
    assert!(error.contains("Station 2 1A is of two tracks"), "{error}");
}

#[test]
fn what_is_wrong_with_a_line_is_said() {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("wrong");
    fs::create_dir_all(&folder).expect("a folder");
    let (_, station) = Shape::loops(2, 3).stations().remove(0);
    fs::write(folder.join("station.toml"), station).expect("a file");
    let made = "name = \"x\"\n[generated]\ntracks = [2, 2]\nblocks = [3]\n";
    for (text, says) in [
        ("name = \"x\"\n".to_owned(), "a line has two stations or more"),
        ("nam = \"x\"\n".to_owned(), "unknown field `nam`"),
        ("name = ".to_owned(), "line.toml"),
        (made.replace("[3]", "[3, 4]"), "give one number for each line between two"),
        (made.replace("[3]", "[2]"), "a line of 2 blocks: 3 to 12 are possible"),
        (made.replace("[2, 2]", "[2, 65]"), "a station of 65 tracks: 2 to 64 are possible"),
        (made.replace("[2, 2]", "[2]").replace("[3]", "[]"), "1 stations: a line has 2 to 12"),
        (format!("{made}[trains]\nservice = 0.5\n"), "brake with 0.8 m/s²; [trains] has 160 m and 0.5 m/s²"),
        (format!("{made}[trains]\nlength_m = 201\n"), "trains of at most 200 m"),
        (format!("{made}[trains]\nacceleration = -1\n"), "must be above 0"),
        (
            format!("{made}[trains]\nacceleration = 1e20\n"),
            "acceleration is 100000000000000000000; it must be above 0 and at most 3",
        ),
        (format!("{made}[trains]\nemergency = 0.8\n"), "emergency is 0.8, below service, 0.9"),
        (format!("{made}[trains]\nbrake_delay_ms = 60000\n"), "brake_delay_ms is 60000; it must be at most 2000"),
        (format!("{made}[trains]\nspeed = 1\n"), "unknown field `speed`"),
        (made.replace("[generated]", "train_cycle_ms = 30\n[generated]"), "it must divide the 100 ms"),
        (made.replace("[generated]", "train_cycle_ms = 0\n[generated]"), "it must divide the 100 ms"),
        (format!("{made}[[station]]\nlayout = \"station.toml\"\n"), "give [[station]] or [generated], not both"),
        ("name = \"x\"\n[[station]]\nlayout = \"no.toml\"\n".to_owned(), "no.toml"),
        (
            "name = \"x\"\n[[station]]\nlayout = \"station.toml\"\n[[station]]\nlayout = \"station.toml\"\n".to_owned(),
            "station.toml",
        ),
    ] {
        let path = folder.join("line.toml");
        fs::write(&path, &text).expect("a file");
        let error = Line::read(&path).expect_err(&text);
        assert!(error.contains(says), "{says:?} is not in {error:?}");
    }
    assert!(Line::read(&folder.join("none.toml")).expect_err("no file").contains("none.toml: cannot be read"));
    let line = Line::generate("x", &Shape::loops(2, 3)).expect("a line");
    for trains in [0, 4, 1_000] {
        let error = World::new(&line, setting(trains, 1, Vec::new())).err().expect("too many, or none");
        assert!(error.contains("1 to 3 are possible"), "{error}");
    }
}

#[test]
fn pictures_show_what_happened() {
    let line = Line::read(&example("three-stations.toml")).expect("a line");
    let mut world = World::new(&line, setting(4, 1, Vec::new())).expect("a world");
    let record = Record::of(&mut world, 600_000, 1_000);
    assert_eq!((record.at_s.len(), record.trains.len()), (601, 601));
    // A train is where its circuits are reported, and a signal at proceed is seen.
    assert!(record.occupied.len() > 20 && record.proceed.len() > 3);
    let svg = diagram::draw(&line, &record, "A & B");
    assert!(svg.contains("A &amp; B") && svg.matches("<polyline").count() == 4 && svg.contains("time in min"));
    let profile = charts::profile(&record, 0, "Train 0").expect("a picture");
    assert!(profile.contains("speed (km/h)") && profile.contains("permitted"));
}
