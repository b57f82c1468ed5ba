//! The second reading of a railML file: it agrees with what is imported, and finds what is falsified.

mod support;

use std::fs;

use atc_layout::form::{Element, Position, Route, Station};
use atc_layout::import::{Imported, railml};
use atc_layout::second::{Difference, differences};
use atc_layout::{At, Description};
use support::railml::{Version, railml as written};
use support::{East, station};

const FILES: [(&str, &str); 5] = [
    ("chainage", include_str!("files/chainage.railml.xml")),
    ("head-on", include_str!("files/head-on.railml")),
    ("short2", include_str!("files/short2.railml")),
    ("dupbuf", include_str!("files/dupbuf.railml")),
    ("slip", include_str!("files/slip.railml")),
];

fn imported(text: &str) -> Imported {
    railml("station.railml", text).unwrap_or_else(|errors| panic!("{errors}"))
}

fn read_twice(text: &str) -> Vec<Difference> {
    let found = imported(text);
    let model = found.description.tracks().unwrap_or_else(|errors| panic!("{errors}"));
    assert!(!model.routes.is_empty(), "{}", found.report);
    differences(text, &model).expect("it is XML")
}

#[test]
fn both_readings_of_our_own_files_agree() {
    for (name, text) in FILES {
        assert_eq!(read_twice(text), [], "{name}");
    }
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../layouts");
    for entry in fs::read_dir(folder).expect(folder) {
        let path = entry.expect("an entry").path();
        if path.extension().is_some_and(|ending| ending == "xml") {
            let text = fs::read_to_string(&path).expect("a file");
            assert_eq!(read_twice(&text), [], "{}", path.display());
        }
    }
}

/// A file in which everything is given that a layout can have wrong.
fn rich() -> String {
    let mut made = station(4, East::OneBay);
    made.routes[2].conflicts = vec![At::derived("2-E".to_owned())];
    let other = made.routes.iter().position(|route| route.name.value == "2-E").expect("it is there");
    let name = made.routes[2].name.clone();
    made.routes[other].conflicts = vec![name];
    let text = written(&made, Version::V31);
    let edit = |text: String, from: &str, to: &str| {
        assert!(text.contains(from), "{from}");
        text.replacen(from, to, 1)
    };
    let text = edit(
        text,
        "<leftBranch netRelationRef=\"nr0n\"/>",
        "<leftBranch netRelationRef=\"nr0n\" branchingSpeed=\"50\"/>",
    );
    let text = edit(
        text,
        "<rightBranch netRelationRef=\"nr0r\"/>",
        "<rightBranch netRelationRef=\"nr0r\" joiningSpeed=\"30\"/>",
    );
    let text = edit(
        text,
        "<bufferStops>",
        "<speeds><speedSection id=\"slow\" maxSpeed=\"70\"><linearLocation id=\"sl\"><associatedNetElement netElementRef=\"ne3\"/></linearLocation></speedSection></speeds><bufferStops>",
    );
    let text = edit(
        text,
        "<tvdSection id=\"tvd2\"",
        "<tvdSection residualRouteCancellationDelay=\"PT80S\" partialRouteReleaseDelay=\"PT3S\" id=\"tvd2\"",
    );
    let text = edit(text, "<refersTo ref=\"sw0\"/>", "<refersTo ref=\"sw0\"/><hasFoulingTrainDetectors ref=\"tvd6\"/>");
    let text = edit(text, "<routeEntry id=\"rt0e\">", "<additionalRelation ref=\"rr\"/><routeEntry id=\"rt0e\">");
    edit(
        text,
        "<conflictingRoutes>",
        "<routeRelations><routeRelation id=\"rr\"><requiredSwitchPosition><relatedSwitchAndPosition inPosition=\"right\"><refersToSwitch ref=\"swil2\"/></relatedSwitchAndPosition></requiredSwitchPosition></routeRelation></routeRelations><conflictingRoutes>",
    )
}

fn found(text: &str, station: &Station) -> Vec<Difference> {
    let description = Description { station: station.clone(), ..Description::default() };
    // Rules that a falsified layout breaks are another matter: the numbers are what is looked at.
    let model = description.tracks().unwrap_or_else(|errors| panic!("{errors}"));
    differences(text, &model).expect("it is XML")
}

fn route<'a>(station: &'a mut Station, name: &str) -> &'a mut Route {
    station.routes.iter_mut().find(|route| route.name.value == name).unwrap_or_else(|| panic!("{name}"))
}

fn place(circuit: &str) -> At<Element> {
    At::derived(Element { circuit: circuit.to_owned(), ..Element::default() })
}

type Falsification = (&'static str, fn(&mut Station));

/// What may go wrong between a file and a layout, each alone.
const FALSIFICATIONS: &[Falsification] = &[
    ("the first section is dropped", |station| drop(route(station, "W-2").path.remove(0))),
    ("the last section is dropped", |station| drop(route(station, "W-2").path.pop())),
    ("a section in the middle is dropped", |station| drop(route(station, "W-2").path.remove(1))),
    ("a section is added at the end", |station| route(station, "2-W").path.push(place("W1"))),
    ("the route begins a section early", |station| {
        let route = route(station, "W-1");
        route.path.insert(0, place("W1"));
        route.entry = At::derived("W2".to_owned());
    }),
    ("two sections change places", |station| route(station, "W-3").path.swap(0, 1)),
    ("the entry is another circuit", |station| route(station, "W-1").entry = At::derived("W2".to_owned())),
    ("the path is another route's", |station| {
        let path = route(station, "W-2").path.clone();
        route(station, "W-1").path = path;
    }),
    ("two routes change names", |station| {
        let (one, other) = (route(station, "W-1").name.clone(), route(station, "W-2").name.clone());
        route(station, "W-1").name = At::derived("between".to_owned());
        route(station, "W-2").name = one;
        route(station, "between").name = other;
    }),
    ("the route is not in the file", |station| route(station, "W-1").name = At::derived("W-9".to_owned())),
    ("the signal is another one", |station| route(station, "W-1").signal = Some("1E".to_owned())),
    ("the path is run the other way", |station| {
        let route = route(station, "W-1");
        route.path = vec![place("LW1"), place("W1")];
        route.entry = At::derived("1T".to_owned());
    }),
    ("a position is the other one", |station| {
        let element = &mut route(station, "W-2").path[0].value;
        element.points.insert("PW1".to_owned(), At::derived(Position::Reverse));
    }),
    ("a flank position of the file is not held", |station| {
        route(station, "W-1").path[0].value.points.retain(|name, _| name != "PW3");
    }),
    ("a flank position of the file is held the other way", |station| {
        route(station, "W-1").path[0].value.points.insert("PW3".to_owned(), At::derived(Position::Normal));
    }),
    ("two circuits change names", |station| swap_circuits(station, "1T", "2T")),
    ("two circuits of the line change names", |station| swap_circuits(station, "W1", "W2")),
    ("two points change names", |station| {
        let (one, other) = (station.points[0].name.clone(), station.points[1].name.clone());
        station.points[0].name = other;
        station.points[1].name = one;
    }),
    ("the legs of a point change places", |station| {
        let point = &mut station.points[0];
        std::mem::swap(&mut point.normal, &mut point.reverse);
    }),
    ("a circuit is longer", |station| station.circuits[2].length_m.value += 10),
    ("a circuit of the line is longer", |station| station.circuits[0].length_m.value += 10),
    ("a point moves faster", |station| station.points[0].throw_ms = Some(At::derived(3000))),
    ("a circuit in which a train fouls a point is dropped", |station| station.points[0].fouled_in.clear()),
    ("a route is released earlier", |station| route(station, "1-E").release_ms = Some(At::derived(20_000))),
    ("a route is released before its sections say", |station| {
        route(station, "W-1").release_ms = Some(At::derived(60_000));
    }),
    ("a circuit counts as clear earlier", |station| station.times.clear_ms = At::derived(2_000)),
    ("an overlap is dropped", |station| route(station, "W-1").overlap.clear()),
    ("an overlap is another one", |station| route(station, "W-1").overlap = vec![place("W2")]),
    ("an overlap is given up earlier", |station| route(station, "W-1").stay_ms = Some(At::derived(20_000))),
    ("a conflict is dropped", |station| {
        route(station, "W-2").conflicts.clear();
        route(station, "2-E").conflicts.clear();
    }),
    ("a branch is run over faster", |station| route(station, "W-1").speed_kmh = Some(At::derived(45))),
    ("a straight branch is run over faster", |station| route(station, "W-2").speed_kmh = Some(At::derived(75))),
    ("a speed is left to the station, which has a higher one", |station| {
        station.speed.reverse_kmh = Some(At::derived(90));
        route(station, "1-W").speed_kmh = None;
    }),
];

fn swap_circuits(station: &mut Station, one: &str, other: &str) {
    let turned = |name: &mut String| {
        if name == one {
            other.clone_into(name);
        } else if name == other {
            one.clone_into(name);
        }
    };
    // The names of the circuits alone: all else names what it named.
    let place = |station: &Station, name: &str| station.circuits.iter().position(|circuit| circuit.name.value == name);
    let (at, to) = (place(station, one).expect("there"), place(station, other).expect("there"));
    turned(&mut station.circuits[at].name.value);
    turned(&mut station.circuits[to].name.value);
}

#[test]
fn every_falsification_is_found() {
    let text = rich();
    let imported = imported(&text);
    let good = &imported.description.station;
    assert_eq!(found(&text, good), [], "{}", imported.report);
    assert_eq!(good.routes.len(), station(4, East::OneBay).routes.len(), "{}", imported.report);
    let mut missed = Vec::new();
    for (name, falsify) in FALSIFICATIONS {
        let mut wrong = good.clone();
        falsify(&mut wrong);
        assert_ne!(&wrong, good, "{name}");
        let differing = found(&text, &wrong);
        if differing.is_empty() {
            missed.push(*name);
        } else {
            println!("{name}: {}", differing[0]);
        }
    }
    assert!(missed.is_empty(), "not found: {missed:?}");
}
