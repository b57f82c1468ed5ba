//! The samples in `layouts/` break no rule; those in railML and PlanPro are made from those in TOML, and import to the same plan.

mod support;

use atc_kernel::interlocking::{CircuitSet, Large, PointSet, Small};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use atc_layout::import::{only, railml, read_any};
use atc_layout::model::{Model, Route};
use atc_layout::{Description, Extent, Rule, draw, read};
use support::central::central;
use support::planpro;
use support::railml::{Version, railml as written};
use support::{East, seventy_seven, station};

fn folder(path: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..").join(path)
}

/// Compares a file with what it should say. `ATC_WRITE=1` writes it instead.
fn pinned(path: &str, text: &str) {
    let path = folder(path);
    if std::env::var_os("ATC_WRITE").is_some() {
        std::fs::write(&path, text).unwrap();
    }
    let found = std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    assert!(
        found == text,
        "{} is not what the test makes: run it with ATC_WRITE=1 and look at the difference",
        path.display()
    );
}

fn description(station: atc_layout::form::Station) -> Description {
    Description { station, ..Description::default() }
}

fn thirty() -> Description {
    let mut made = station(8, East::OneBay);
    "Station with 30 routes".clone_into(&mut made.name);
    description(made)
}

const SAMPLES: [(&str, Version); 4] = [
    ("passing-loop", Version::V31),
    ("junction", Version::V32),
    ("terminus", Version::V31),
    ("station-30", Version::V32),
];

#[test]
fn the_station_with_thirty_routes_is_made_by_rule() {
    let head = "# A single line, eight tracks, thirty routes. Made by layout/tests/samples.rs.\n\n";
    pinned("layouts/station-30.toml", &format!("{head}{}", thirty().to_toml()));
}

#[test]
fn the_station_with_a_hundred_routes_is_made_by_rule() {
    let mut made = station(25, East::AllThrough);
    "Station with 100 routes".clone_into(&mut made.name);
    let head = "# A single line, 25 tracks, a hundred routes: a large station. Made by layout/tests/samples.rs.\n\n";
    pinned("layouts/station-100.toml", &format!("{head}{}", description(made).to_toml()));
}

#[test]
fn the_junction_station_is_made_by_rule() {
    let head = "# A junction station: two double and two single lines, scissors, double slips, ladders, a bay, and calling-on routes. Made by\n\
        # layout/tests/samples.rs.\n\n";
    pinned("layouts/central.toml", &format!("{head}{}", description(central()).to_toml()));
}

#[test]
fn a_large_station_is_imported_whole() {
    let native = read(folder("layouts/station-100.toml")).unwrap();
    let imported = railml("station-100", &written(&native.station, Version::V32)).unwrap();
    let sound = imported.description.check().unwrap_or_else(|errors| panic!("{errors}"));
    assert_eq!(sound.names.routes.len(), 100);
    let plan = native.compile_to::<128, 32, 64, 8, Large>().unwrap().plan;
    assert_eq!(plan.routes.iter().filter(|route| route.exists()).count(), 100);
}

/// Over scissors and double slips too. The file has no calling-on routes: those of railML are not read.
#[test]
fn a_junction_station_is_imported_whole() {
    let mut native = central();
    assert_eq!(native.routes.len(), 102);
    native.routes.retain(|route| route.berth.is_empty());
    for version in [Version::V31, Version::V32] {
        let imported = railml("central", &written(&native, version)).unwrap();
        let sound = imported.description.check().unwrap_or_else(|errors| panic!("{errors}"));
        let left_out: Vec<&String> = imported.report.lacking.iter().collect();
        assert_eq!(sound.names.routes.len(), 68, "{left_out:?}");
    }
}

#[test]
fn every_sample_breaks_no_rule() {
    let mut seen = 0;
    for entry in std::fs::read_dir(folder("layouts")).unwrap() {
        let path = entry.unwrap().path();
        let imported = read_any(&path).unwrap_or_else(|errors| panic!("{errors}"));
        let sound = imported.description.check().unwrap_or_else(|errors| panic!("{errors}"));
        assert!(!sound.names.routes.is_empty(), "{}", path.display());
        if !Extent::of(&imported.description.station).is_large() {
            let compiled = imported.description.compile().unwrap_or_else(|errors| panic!("{errors}"));
            compiled.layout();
            let routes = compiled.plan.routes.iter().filter(|route| route.exists()).count();
            assert_eq!(routes, compiled.names.routes.len());
        }
        seen += 1;
    }
    assert_eq!(
        seen, 12,
        "four samples in two forms and one in a third, one with calling-on routes, and two large ones"
    );
}

#[test]
fn samples_in_railml_are_made_from_those_in_toml() {
    for (name, version) in SAMPLES {
        let native = read(folder(&format!("layouts/{name}.toml"))).unwrap();
        pinned(&format!("layouts/{name}.railml.xml"), &written(&native.station, version));
    }
}

#[test]
fn the_sample_in_planpro_is_made_from_that_in_toml_and_imports_to_the_same_routes() {
    let native = read(folder("layouts/passing-loop.toml")).unwrap();
    let text = planpro::written(&native.station, &planpro::Tool::PLAIN);
    pinned("layouts/passing-loop.ppxml", &text);
    let imported = atc_layout::import::planpro("passing-loop", &text).unwrap_or_else(|errors| panic!("{errors}"));
    assert_eq!(imported.description.station.name, native.station.name);
    let (native, imported) = (native.model().unwrap(), imported.description.model().unwrap_or_else(|e| panic!("{e}")));
    let courses = |model: &Model, name: &dyn Fn(&Route) -> String| -> BTreeMap<String, [Vec<String>; 2]> {
        let named = |number: usize| model.circuits[number].name.clone();
        let places = |route: &Route| {
            let path = [route.entry].into_iter().chain(route.circuits()).map(named).collect();
            (name(route), [path, route.overlap.iter().copied().map(named).collect()])
        };
        model.routes.iter().map(places).collect()
    };
    let by_signals = courses(&native, &|route| planpro::name_of(&native, route));
    assert_eq!(by_signals, courses(&imported, &|route| route.name.clone()));
    assert_eq!(by_signals.len(), native.routes.len());
}

/// The same circuits, points, paths and overlaps by name, whatever their order.
#[test]
fn a_sample_in_railml_imports_to_the_same_routes() {
    for (name, version) in SAMPLES {
        let native = read(folder(&format!("layouts/{name}.toml"))).unwrap();
        let text = written(&native.station, version);
        let imported = railml(name, &text).unwrap_or_else(|errors| panic!("{errors}"));
        let guessed = imported.report.defaulted.iter().find(|line| line.starts_with("tvdSection"));
        assert_eq!(guessed, None, "every section of {name} has the borders of a part of the tracks");
        let (native, imported) =
            (native.model().unwrap(), imported.description.model().unwrap_or_else(|e| panic!("{e}")));
        assert_eq!(native.routes.len(), imported.routes.len(), "{name}");
        for (one, other) in native.routes.iter().zip(&imported.routes) {
            let say = |model: &atc_layout::model::Model, route: &atc_layout::model::Route| {
                let circuits = |all: Vec<usize>| {
                    all.iter().map(|circuit| model.circuits[*circuit].name.clone()).collect::<Vec<_>>()
                };
                let passed: Vec<_> = route
                    .path
                    .iter()
                    .flat_map(|place| &place.passed)
                    .map(|passed| (model.points[passed.point].name.clone(), passed.position))
                    .collect();
                (
                    route.name.clone(),
                    route.signal.clone(),
                    circuits(vec![route.entry]),
                    circuits(route.circuits().collect()),
                    circuits(route.overlap.clone()),
                    passed,
                    route.release,
                )
            };
            assert_eq!(say(&native, one), say(&imported, other), "{name}");
            // Trains come faster in the file, and its timers are kept.
            assert!(
                one.overlap.is_empty() || other.stay >= one.stay,
                "{name}, route {}: {:?} and {:?}",
                one.name,
                one.stay,
                other.stay
            );
        }
        let lengths = |model: &atc_layout::model::Model| {
            model
                .circuits
                .iter()
                .map(|circuit| (circuit.name.clone(), circuit.length))
                .collect::<std::collections::BTreeMap<_, _>>()
        };
        assert_eq!(lengths(&native), lengths(&imported), "{name}");
    }
}

#[test]
fn a_layout_survives_being_written() {
    for (name, _) in SAMPLES {
        let native = read(folder(&format!("layouts/{name}.toml"))).unwrap();
        let again = Description::from_toml(name, &native.to_toml()).unwrap_or_else(|errors| panic!("{errors}"));
        assert_eq!(native.station, again.station);
        let plan = |it: &Description| it.compile_to::<128, 32, 64, 8, Large>().unwrap().plan;
        assert!(plan(&native) == plan(&again), "{name}");
    }
}

#[test]
fn a_plan_of_a_large_station_is_that_of_a_small_one() {
    let small = thirty().compile().unwrap().plan;
    let large = thirty().compile_to::<64, 16, 32, 8, Large>().unwrap().plan;
    assert_eq!((&small.braking, small.clear, small.turn), (&large.braking, large.clear, large.turn));
    assert!(small.lengths.iter().eq(large.lengths.iter().take(64)));
    let circuits = |set: CircuitSet, wide: CircuitSet<Large>| assert_eq!([set.bits(), 0, 0, 0], wide.words());
    let points = |set: PointSet, wide: PointSet<Large>| assert_eq!([set.bits(), 0, 0, 0], wide.words());
    for (one, other) in small.routes.iter().zip(&large.routes) {
        assert_eq!((one.length, one.heading, one.speed), (other.length, other.heading, other.speed));
        circuits(one.entry, other.entry);
        circuits(one.approach, other.approach);
        circuits(one.beyond, other.beyond);
        assert_eq!([one.conflicts.bits(), 0, 0, 0], other.conflicts.words());
        assert_eq!([one.continuing.bits(), 0, 0, 0], other.continuing.words());
        assert_eq!([one.to.bits(), 0, 0, 0], other.to.words());
        for (element, wide) in one.path.iter().zip(&other.path).chain([(&one.overlap, &other.overlap)]) {
            circuits(element.circuits, wide.circuits);
            points(element.positions.normal, wide.positions.normal);
            points(element.positions.reverse, wide.positions.reverse);
        }
    }
}

#[test]
fn a_station_of_the_greatest_size_fits() {
    let made = description(station(16, East::AllThrough));
    let compiled = made.compile().unwrap_or_else(|errors| panic!("{errors}"));
    assert_eq!(compiled.names.routes.len(), 64);
}

#[test]
fn seventy_seven_routes_are_a_large_station_or_cut() {
    let text = written(&seventy_seven(), Version::V31);
    let imported = railml("77", &text).unwrap();
    assert_eq!(imported.description.model().unwrap_or_else(|errors| panic!("{errors}")).routes.len(), 77);
    let errors = imported.description.compile().unwrap_err();
    assert!(errors.breaks(Rule::TooMany), "{errors}");
    let sound = imported.description.check().unwrap_or_else(|errors| panic!("as a large station: {errors}"));
    assert_eq!(sound.names.routes.len(), 77);
    assert!(errors.to_string().contains("77 routes, and there is room for 64"), "{errors}");
    let wanted: Vec<String> = ["W-1", "1-W", "E-1", "1-E"].map(str::to_owned).to_vec();
    let part = only(&imported.description, &wanted).unwrap();
    let compiled = part.compile().unwrap_or_else(|errors| panic!("{errors}"));
    assert_eq!(compiled.names.routes, wanted);
    assert!(only(&imported.description, &["nowhere".to_owned()]).unwrap_err().to_string().contains("no route nowhere"));
}

#[test]
fn a_small_layout_is_the_same_file() {
    let native = read(folder("layouts/passing-loop.toml")).unwrap();
    let small = native.compile_to::<8, 8, 4, 2, Small>().unwrap_or_else(|errors| panic!("{errors}"));
    let full = native.compile().unwrap();
    assert_eq!(small.plan.lengths, full.plan.lengths);
    assert_eq!(
        small.plan.routes.map(|route| (route.entry, route.approach, route.conflicts, route.beyond)).as_slice(),
        &full.plan.routes.map(|route| (route.entry, route.approach, route.conflicts, route.beyond))[..8]
    );
    assert!(native.compile_to::<7, 8, 4, 2, Small>().unwrap_err().breaks(Rule::TooMany));
}

#[test]
fn the_schema_is_current() {
    pinned("layout/layout.schema.json", &atc_layout::schema());
}

/// What the reader takes the schema takes, and what has an unknown key neither does.
#[test]
fn samples_keep_to_the_schema() {
    let schema = jsonschema::validator_for(&serde_json::from_str(&atc_layout::schema()).unwrap()).unwrap();
    let junction = std::fs::read_to_string(folder("layouts/junction.toml")).unwrap();
    let with_points =
        junction.replace("path = [\"P1T\"]", "path = [{ circuit = \"P1T\", points = { P1 = \"normal\" } }]");
    let railml_as_toml = read_any(folder("layouts/terminus.railml.xml")).unwrap().description.to_toml();
    for text in [&junction, &with_points, &thirty().to_toml(), &railml_as_toml] {
        assert!(Description::from_toml("x", text).is_ok());
        let value: serde_json::Value = toml::from_str(text).unwrap();
        let wrong: Vec<String> = schema.iter_errors(&value).map(|error| error.to_string()).collect();
        assert!(wrong.is_empty(), "{wrong:?}");
    }
    for (from, to) in [("points = {", "point = {"), ("length_m", "length"), ("\"normal\" } }", "\"left\" } }")] {
        let text = with_points.replacen(from, to, 1);
        assert!(Description::from_toml("x", &text).is_err(), "{to}");
        assert!(!schema.is_valid(&toml::from_str(&text).unwrap()), "{to}");
    }
}

#[test]
fn the_track_plan_of_the_docs_is_current() {
    let native = read(folder("layouts/station-30.toml")).unwrap();
    pinned("docs/track-plan.svg", &draw::svg(&native.station, &native.model().unwrap()));
}
