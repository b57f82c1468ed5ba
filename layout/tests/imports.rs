//! Imports of files that are wrong, strange or mutilated: an error or a report, never a panic.

mod support;

use atc_layout::At;
use atc_layout::Rule;
use atc_layout::form::Position;
use atc_layout::import::{Imported, Report, osrd, railml};
use proptest::prelude::*;
use support::railml::{Version, railml as written};
use support::{East, station};

fn small() -> String {
    written(&station(3, East::OneBay), Version::V31)
}

fn imported(text: &str) -> Imported {
    railml("station.railml", text).unwrap_or_else(|errors| panic!("{errors}"))
}

fn refused(text: &str, says: &str) {
    let errors = railml("station.railml", text).unwrap_err();
    assert!(errors.breaks(Rule::Form) && errors.to_string().contains(says), "{says:?} is not in: {errors}");
}

#[test]
fn what_is_no_railml_3_is_refused_with_its_place() {
    refused("", "this is no XML");
    refused(&small().replace("</infrastructure>", ""), "this is no XML");
    refused("<railML xmlns=\"https://www.railml.org/schemas/2013\" version=\"2.2\"/>", "railML 3.1 or later");
    refused("<osm/>", "the root element is osm");
    refused("<railML xmlns=\"https://www.railml.org/schemas/3.1\" version=\"3.1\"/>", "no netElements");
    let errors = railml("station.railml", "<railML>\n<a></b></railML>").unwrap_err();
    assert!(errors.to_string().starts_with("station.railml:2:"), "{errors}");
}

#[test]
fn what_is_not_known_is_skipped_and_reported() {
    let text =
        small().replace("<bufferStops>", "<balises><balise id=\"b1\"/><balise id=\"b2\"/></balises><bufferStops>");
    let report = imported(&text).report;
    assert!(report.skipped.iter().any(|line| line == "balises with 2 elements"), "{report}");
}

#[test]
fn what_is_missing_is_defaulted_and_reported() {
    let without = |what: &str| imported(&small().replace(what, ""));
    let release = without(" approachReleaseDelay=\"PT60S\"").report;
    assert!(release.defaulted.iter().any(|line| line.contains("no approachReleaseDelay")), "{release}");
    let normal =
        imported(&small().replace(" preferredPosition=\"left\"", "").replace(" continueCourse=\"left\"", "")).report;
    assert!(normal.defaulted.iter().any(|line| line.starts_with("normal position of sw0")), "{normal}");
    let lengths = imported(&small().replace(" length=\"", " long=\"")).report;
    assert!(lengths.defaulted.iter().any(|line| line.contains("100 m: ne0")), "{lengths}");
    let flank = imported(&small()).report;
    assert!(flank.defaulted.iter().any(|line| line.contains("no point protects")), "{flank}");
    let no_routes = imported(&small().replace("<route ", "<other ").replace("</route>", "</other>")).report;
    assert!(no_routes.lacking.iter().any(|line| line.starts_with("routes: the file has none")), "{no_routes}");
    let no_signal = imported(&small().replacen("<refersTo ref=\"ilsig", "<refersTo ref=\"gone", 1)).report;
    assert!(no_signal.lacking.iter().any(|line| line.contains("does not exist; it is left out")), "{no_signal}");
}

#[test]
fn sections_are_enough_without_exits_and_exits_without_sections() {
    let text = small();
    let all = imported(&text).description.station.routes.len();
    let start = |line: &&str| !line.contains("<hasTvdSection") || line.contains("<overlap");
    let without_sections: String = text.lines().filter(start).flat_map(|line| [line, "\n"]).collect();
    assert_eq!(imported(&without_sections).description.station.routes.len(), all);
    // An exit and the end of its route stand in two lines.
    let without_exits: String =
        text.lines().filter(|line| !line.contains("<routeExit")).flat_map(|line| [line, "\n"]).collect();
    let found = imported(&without_exits);
    assert_eq!(found.description.station.routes.len(), all, "{}", found.report);
}

#[test]
fn a_flank_point_of_a_route_relation_is_held() {
    let text = small()
        .replacen("<routeExit", "<additionalRelation ref=\"rr\"/><routeExit", 1)
        .replace("<conflictingRoutes>", "<routeRelations><routeRelation id=\"rr\"><requiredSwitchPosition><relatedSwitchAndPosition inPosition=\"right\"><refersToSwitch ref=\"swil2\"/></relatedSwitchAndPosition></requiredSwitchPosition></routeRelation></routeRelations><conflictingRoutes>");
    let model = imported(&text).description.model().unwrap();
    let held = model.routes[0].path[0].positions.get(&2);
    assert_eq!(held, Some(&Position::Reverse));
}

const CHAINAGE: &str = include_str!("files/chainage.railml.xml");

#[test]
fn places_may_be_given_by_chainage_alone_up_or_down_the_net_element() {
    let found = imported(CHAINAGE);
    let lengths: Vec<(String, u16)> =
        found.description.station.circuits.iter().map(|at| (at.name.value.clone(), at.length_m.value)).collect();
    let wanted = [("0T", 500), ("1T", 400), ("W", 140), ("M", 240), ("L", 250), ("E", 120), ("2T", 500), ("3T", 600)];
    assert_eq!(lengths, wanted.map(|(name, length)| (name.to_owned(), length)));
    assert!(found.report.lacking.is_empty(), "{}", found.report);
    let model = found.description.compile().unwrap_or_else(|errors| panic!("{errors}"));
    assert_eq!(model.names.routes, ["A-B1", "A-B2", "B1-end"]);
}

#[test]
fn a_place_in_another_system_or_beyond_its_track_is_not_guessed_in_silence() {
    let elsewhere = imported(&CHAINAGE.replacen(
        "positioningSystemRef=\"km\" measure=\"11900\"",
        "positioningSystemRef=\"other\" measure=\"11900\"",
        1,
    ));
    assert!(
        elsewhere.report.lacking.iter().any(|line| line == "a place on a net element of: d7"),
        "{}",
        elsewhere.report
    );
    let beyond = imported(&CHAINAGE.replacen("measure=\"11040\"", "measure=\"11400\"", 1)).report;
    let told = "places beyond their net element are taken to be at its end: d2 at 400 m of 300 m";
    assert!(beyond.defaulted.iter().any(|line| line == told), "{beyond}");
}

#[test]
fn an_overlap_is_that_of_the_exit_and_runs_over_its_sections_or_to_its_limit() {
    let found = imported(CHAINAGE);
    let overlaps: Vec<_> = found.description.station.routes.iter().map(|route| &route.overlap).collect();
    let way = |overlap: &[atc_layout::At<atc_layout::form::Element>]| -> Vec<(String, Vec<Position>)> {
        let through = |at: &atc_layout::form::Element| at.points.values().map(|given| given.value).collect();
        overlap.iter().map(|at| (at.circuit.clone(), through(at))).collect()
    };
    assert_eq!(way(overlaps[0]), [("E".to_owned(), vec![Position::Normal])], "to its limit, with its switch");
    assert_eq!(way(overlaps[1]), [("E".to_owned(), vec![Position::Reverse])], "that of the destination point");
    // The file has 40 s. A train that comes over reverse points at the lowest speed, as nothing says how fast, stands later.
    assert_eq!(found.description.station.routes[0].stay_ms.as_ref().map(|at| at.value), Some(65_000));
    let other = "overlap ov3 for route A-B2, which has the overlap ov2";
    assert!(found.report.skipped.iter().any(|line| line == other), "{}", found.report);
    // A position that no way has: the overlap is left out, and the report says so.
    let opposed = imported(&CHAINAGE.replace(
        "<requiresSwitchInPosition><relatedSwitchAndPosition inPosition=\"right\">",
        "<requiresSwitchInPosition><relatedSwitchAndPosition inPosition=\"left\">",
    ));
    assert!(
        opposed.report.lacking.iter().any(|line| line.starts_with("overlap ov1 for route A-B1: no way leads")),
        "{}",
        opposed.report
    );
}

/// The chainage file with a change, and its report.
fn changed(from: &str, to: &str) -> Imported {
    assert!(CHAINAGE.contains(from), "{from}");
    imported(&CHAINAGE.replacen(from, to, 1))
}

fn reports(lines: &[String], start: &str) -> bool {
    lines.iter().any(|line| line.starts_with(start))
}

#[test]
fn a_net_element_may_have_more_coordinates_and_more_systems() {
    let between = "<intrinsicCoordinate id=\"west1\"";
    let bent = changed(
        between,
        "<intrinsicCoordinate id=\"w\" intrinsicCoord=\"0.9\"><linearCoordinate positioningSystemRef=\"km\" measure=\"10500\"/></intrinsicCoordinate><intrinsicCoordinate id=\"west1\"",
    );
    let lengths = |found: &Imported| -> Vec<u16> {
        found.description.station.circuits.iter().take(2).map(|at| at.length_m.value).collect()
    };
    assert_eq!(lengths(&bent), [900, 80], "piece by piece");
    let both = changed(
        "<linearCoordinate positioningSystemRef=\"km\" measure=\"10000\"/>",
        "<linearCoordinate positioningSystemRef=\"km\" measure=\"10000\"/><linearCoordinate positioningSystemRef=\"other\" measure=\"500\"/>",
    );
    assert_eq!(lengths(&both), [500, 400]);
    let no_length = imported(&CHAINAGE.replacen(" id=\"west\" length=\"1000\"", " id=\"west\"", 1).replacen(
        "measure=\"11000\"/></intrinsicCoordinate>",
        "measure=\"11000\"/><linearCoordinate positioningSystemRef=\"other\" measure=\"9500\"/></intrinsicCoordinate>",
        1,
    ));
    assert_eq!(lengths(&no_length), [500, 400], "systems are not mixed");
    let turns = changed(
        between,
        "<intrinsicCoordinate id=\"w\" intrinsicCoord=\"0.9\"><linearCoordinate positioningSystemRef=\"km\" measure=\"11500\"/></intrinsicCoordinate><intrinsicCoordinate id=\"west1\"",
    );
    assert!(reports(&turns.report.lacking, "a place on a net element of: d0, d1, isA"), "{}", turns.report);
}

#[test]
fn what_an_overlap_names_and_is_not_there_is_reported_and_not_passed_over() {
    let ov2 = "<hasTvdSection ref=\"sE\"/></overlap>";
    let ghost = changed(ov2, "<hasTvdSection ref=\"sE\"/><hasTvdSection ref=\"ghost\"/></overlap>").report;
    assert!(
        reports(&ghost.lacking, "overlap ov2 for route A-B2: its section has no place (ghost, which does not exist)"),
        "{ghost}"
    );
    let switch =
        changed("inPosition=\"left\"><refersToSwitch ref=\"p2\"/>", "inPosition=\"left\"><refersToSwitch ref=\"p9\"/>");
    let why = "overlap ov2 for route A-B2: the switch p9 does not exist (relatedSwitchAndPosition";
    assert!(reports(&switch.report.lacking, why), "{}", switch.report);
    let word =
        changed("inPosition=\"left\"><refersToSwitch ref=\"p2\"/>", "inPosition=\"off\"><refersToSwitch ref=\"p2\"/>")
            .report;
    assert!(
        reports(&word.lacking, "overlap ov2 for route A-B2: the position \"off\" is neither left nor right"),
        "{word}"
    );
    let both = changed(
        "</relatedSwitchAndPosition></requiresSwitchInPosition><hasTvdSection ref=\"sE\"/>",
        "</relatedSwitchAndPosition><relatedSwitchAndPosition inPosition=\"right\"><refersToSwitch ref=\"p2\"/></relatedSwitchAndPosition></requiresSwitchInPosition><hasTvdSection ref=\"sE\"/>",
    );
    assert!(
        reports(&both.report.lacking, "overlap ov2 for route A-B2: it asks for both positions of a switch"),
        "{}",
        both.report
    );
    // Nothing says which leg: the limit does.
    let free = imported(&CHAINAGE.replace("<requiresSwitchInPosition><relatedSwitchAndPosition inPosition=\"left\"><refersToSwitch ref=\"p2\"/></relatedSwitchAndPosition></requiresSwitchInPosition><hasTvdSection ref=\"sE\"/>", "<hasTvdSection ref=\"sE\"/><isLimitedBy ref=\"d6\"/>"));
    assert_eq!(free.description.station.routes[1].overlap.len(), 1, "{}", free.report);
    // One that is for routes that are not there is for no other.
    let elsewhere = changed(
        "<activeForApproachRoute ref=\"rA-B2\"/>",
        "<activeForApproachRoute ref=\"gone\"/><relatedToTrackAsset ref=\"ilB1\"/>",
    );
    assert!(
        reports(&elsewhere.report.lacking, "overlap ov3: it names no route that was taken"),
        "{}",
        elsewhere.report
    );
}

#[test]
fn a_route_that_is_not_what_its_parts_say_is_left_out() {
    let ghost =
        changed("<hasTvdSection ref=\"sM\"/>", "<hasTvdSection ref=\"sM\"/><hasTvdSection ref=\"ghost\"/>").report;
    assert!(left_out(&ghost, "rA-B1", "its section has no place (ghost, which does not exist)"), "{ghost}");
    // No position of its switch: its exit tells the leg.
    let leg = "<facingSwitchInPosition inPosition=\"right\"><refersToSwitch ref=\"p1\"/></facingSwitchInPosition><hasTvdSection ref=\"sW\"/><hasTvdSection ref=\"sL\"/>";
    let by_exit = imported(
        &CHAINAGE
            .replace(leg, "<hasTvdSection ref=\"sW\"/>")
            .replace("<refersTo ref=\"to2\"/>", "<refersTo ref=\"d3\"/>"),
    );
    let first = &by_exit.description.station.routes[1].path[0].points["1"];
    assert_eq!(first.value, Position::Reverse, "{}", by_exit.report);
    let contrary =
        imported(&CHAINAGE.replace("<routeExit><refersTo ref=\"to2\"/>", "<routeExit><refersTo ref=\"to1\"/>")).report;
    assert!(left_out(&contrary, "rA-B2", "no way leads from its signal to its exit"), "{contrary}");
    let open = imported(
        &CHAINAGE
            .replace(leg, "<hasTvdSection ref=\"sW\"/>")
            .replace("<routeExit><refersTo ref=\"to2\"/></routeExit>", ""),
    );
    assert!(left_out(&open.report, "rA-B2", "the file leaves more than one way"), "{}", open.report);
}

#[test]
fn a_route_that_is_not_for_trains_is_left_out() {
    let with = |kind: &str| format!("<handlesRouteType ref=\"{kind}\"/><routeEntry");
    let count = |imported: &Imported| imported.description.station.routes.len();
    let all = count(&imported(CHAINAGE));
    let told = |imported: &Imported, why: &str| imported.report.lacking.iter().any(|line| line.contains(why));
    for kind in ["rt_shunting", "Rangierstrasse", "callOn", "main_shunting"] {
        let one = imported(&CHAINAGE.replacen("<routeEntry", &with(kind), 1));
        assert_eq!(count(&one), all - 1, "{kind}: {}", one.report);
        assert!(told(&one, "which is none of trains"), "{kind}: {}", one.report);
    }
    let main = imported(&CHAINAGE.replacen("<routeEntry", &with("rt_main"), 1));
    assert_eq!(count(&main), all, "{}", main.report);
    for kind in ["domain", "remainder", "maintenance", "trainingMode", "non-main", "no train"] {
        let one = imported(&CHAINAGE.replacen("<routeEntry", &with(kind), 1));
        assert_eq!(count(&one), all - 1, "{kind}: {}", one.report);
    }
    for kind in ["mainRoute", "Zugstraße", "r.train-7"] {
        let one = imported(&CHAINAGE.replacen("<routeEntry", &with(kind), 1));
        assert_eq!(count(&one), all, "{kind}: {}", one.report);
    }
    // One of its kinds is enough.
    let both = imported(&CHAINAGE.replacen(
        "<routeEntry",
        &(with("rt_main") + &with("rt_shunting")).replacen("<routeEntry", "", 1),
        1,
    ));
    assert_eq!(count(&both), all, "{}", both.report);
    let unknown = imported(&CHAINAGE.replacen("<routeEntry", &with("rt_3"), 1));
    assert_eq!(count(&unknown), all - 1);
    assert!(told(&unknown, "the file does not say that this is one of trains"), "{}", unknown.report);
    let alike = imported(&CHAINAGE.replace("<routeEntry", &with("rt_3")));
    assert_eq!(count(&alike), all, "{}", alike.report);
    assert!(reports(&alike.report.defaulted, "all routes are of the type rt_3"), "{}", alike.report);
}

/// Whether the route with this id was left out for this reason.
fn left_out(report: &Report, route: &str, why: &str) -> bool {
    let start = format!("route {route}, line ");
    report.lacking.iter().any(|line| line.starts_with(&start) && line.contains(why) && line.ends_with("it is left out"))
}

#[test]
fn times_are_read_in_every_form_or_reported() {
    let whole = changed("approachReleaseDelay=\"PT45S\"", "approachReleaseDelay=\"P0Y0M0DT0H2M0.5S\"");
    assert_eq!(whole.description.station.routes[0].release_ms.as_ref().map(|at| at.value), Some(120_500));
    let hour = changed("approachReleaseDelay=\"PT45S\"", "approachReleaseDelay=\"PT1H\"");
    assert_eq!(hour.description.station.routes[0].release_ms.as_ref().map(|at| at.value), Some(3_600_000));
    let day = changed("approachReleaseDelay=\"PT45S\"", "approachReleaseDelay=\"P1D\"").report;
    assert!(left_out(&day, "rA-B1", "its release time of 86400000 ms is more than 60 000 cycles"), "{day}");
    for wrong in ["P1M", "PT", "P", "45S", "PT-4S", "PT4X", "PT4S4S", "P4"] {
        let report = changed("approachReleaseDelay=\"PT45S\"", &format!("approachReleaseDelay=\"{wrong}\"")).report;
        let told = format!("the approachReleaseDelay {wrong:?} is no time that can be read");
        assert!(left_out(&report, "rA-B1", &told), "{wrong}: {report}");
    }
    let throw = changed("maxThrowTime=\"PT6S\"", "maxThrowTime=\"6\"").report;
    assert!(reports(&throw.lacking, "switch sw1: its throw time \"6\" is no time that can be read"), "{throw}");
}

/// A station of our own in the form of OSRD: a line with a loop, cut by four detectors.
const OSRD: &str = r#"{
  "track_sections": [{"id": "a", "length": 900.0}, {"id": "b", "length": 400.0}, {"id": "c", "length": 400.0}, {"id": "d", "length": 900.0}],
  "switches": [
    {"id": "p", "switch_type": "point_switch", "group_change_delay": 6.0, "ports": {"A": {"endpoint": "END", "track": "a"}, "B1": {"endpoint": "BEGIN", "track": "b"}, "B2": {"endpoint": "BEGIN", "track": "c"}}},
    {"id": "q", "switch_type": "point_switch", "ports": {"A": {"endpoint": "BEGIN", "track": "d"}, "B1": {"endpoint": "END", "track": "b"}, "B2": {"endpoint": "END", "track": "c"}}}],
  "detectors": [
    {"id": "da", "track": "a", "position": 850.0}, {"id": "db1", "track": "b", "position": 30.0}, {"id": "db2", "track": "b", "position": 370.0},
    {"id": "dc1", "track": "c", "position": 30.0}, {"id": "dc2", "track": "c", "position": 370.0}, {"id": "dd", "track": "d", "position": 50.0}],
  "buffer_stops": [{"id": "ba", "track": "a", "position": 0.0}, {"id": "bd", "track": "d", "position": 900.0}],
  "routes": [
    {"id": "in b", "entry_point": {"type": "Detector", "id": "da"}, "entry_point_direction": "START_TO_STOP", "exit_point": {"type": "Detector", "id": "db2"}, "release_detectors": ["db1"], "switches_directions": {"p": "A_B1"}},
    {"id": "in c", "entry_point": {"type": "Detector", "id": "da"}, "entry_point_direction": "START_TO_STOP", "exit_point": {"type": "Detector", "id": "dc2"}, "switches_directions": {"p": "A_B2"}},
    {"id": "out c", "entry_point": {"type": "Detector", "id": "dc2"}, "entry_point_direction": "START_TO_STOP", "exit_point": {"type": "BufferStop", "id": "bd"}, "switches_directions": {}},
    {"id": "there", "entry_point": {"type": "BufferStop", "id": "ba"}, "entry_point_direction": "START_TO_STOP", "exit_point": {"type": "Detector", "id": "da"}, "switches_directions": {}}]
}"#;

#[test]
fn an_osrd_infrastructure_becomes_a_layout() {
    let imported = osrd("loop.json", OSRD).unwrap_or_else(|errors| panic!("{errors}"));
    let compiled = imported.description.compile().unwrap_or_else(|errors| panic!("{errors}"));
    assert_eq!(compiled.names.routes, ["in b", "in c", "out c"]);
    assert_eq!(compiled.names.circuits.len(), 6);
    let shortest = compiled.model.circuits.iter().map(|circuit| circuit.length.0).min();
    assert_eq!(shortest, Some(80), "50 m to the blades and 30 m behind them");
    assert_eq!(compiled.model.points[0].throw_ms, 6000);
    assert!(
        imported.report.lacking.iter().any(|line| line.contains("one circuit at a buffer stop")),
        "{}",
        imported.report
    );
    assert!(osrd("x.json", "{").unwrap_err().to_string().starts_with("x.json:1:"));
    assert!(
        osrd("x.json", &OSRD.replace("\"track\": \"d\"", "\"track\": \"e\"")).unwrap_err().breaks(Rule::NoSuchName)
    );
}

/// The thirteenth attack: beyond a buffer stop the track went on to the end of its section.
#[test]
fn the_tracks_of_an_osrd_infrastructure_end_at_a_buffer_stop() {
    let at = |place: &str| OSRD.replacen("\"track\": \"d\", \"position\": 900.0", place, 1);
    let inside =
        osrd("loop.json", &at("\"track\": \"d\", \"position\": 500.0")).unwrap_or_else(|errors| panic!("{errors}"));
    let told = "the tracks end at the buffer stop bd at 500 m of 900 m of d";
    assert!(inside.report.defaulted.iter().any(|line| line == told), "{}", inside.report);
    let last = |imported: &Imported| {
        let compiled = imported.description.compile().unwrap_or_else(|errors| panic!("{errors}"));
        compiled.model.circuits.iter().find(|circuit| circuit.name == "bd+dd").map(|circuit| circuit.length.0)
    };
    assert_eq!(last(&inside), Some(450));
    for place in ["\"track\": \"b\", \"position\": 200.0", "\"track\": \"d\", \"position\": 2000.0"] {
        let errors = osrd("loop.json", &at(place)).expect_err("the tracks do not end there");
        assert!(errors.to_string().contains("the tracks do not end there"), "{errors}");
    }
    let long = OSRD.replace("\"length\": 400.0", "\"length\": 400000.0");
    assert!(
        osrd("loop.json", &long).expect_err("it is too long").to_string().contains("track section b is 400000 m long")
    );
}

/// The third attack: both were passed over, and the report said that the file says nothing of them.
#[test]
fn limits_and_gradients_of_an_osrd_infrastructure_hold_everywhere() {
    let limits = "\"speed_sections\": [{\"speed_limit\": 16.666666666666668}, {\"speed_limit_by_tag\": {\"freight\": 15.2}}, {}], \"switches\"";
    let text = OSRD.replacen("\"switches\"", limits, 1);
    let imported = osrd("loop.json", &text).unwrap_or_else(|errors| panic!("{errors}"));
    let compiled = imported.description.compile().unwrap_or_else(|errors| panic!("{errors}"));
    // 54.7 km/h: the highest code that is not over it; over reverse points the lowest one.
    let kmh: std::collections::BTreeSet<u16> = compiled
        .model
        .routes
        .iter()
        .map(|route| compiled.model.values.speeds_kmh[usize::from(route.speed.0)])
        .collect();
    assert_eq!(kmh, [15, 45].into());
    assert!(!imported.report.to_string().contains("[speed]: the defaults"), "{}", imported.report);
    let slopes = "\"length\": 400.0, \"slopes\": [{\"gradient\": 3.0}, {\"gradient\": -10.5}]";
    let text = OSRD.replacen("\"length\": 400.0", slopes, 1);
    let imported = osrd("loop.json", &text).unwrap_or_else(|errors| panic!("{errors}"));
    assert!(imported.description.station.circuits.iter().all(|circuit| circuit.gradient == Some(At::derived(11))));
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 192, failure_persistence: None, ..ProptestConfig::default() })]

    /// Attributes go, ids change places, numbers become others, elements vanish: no panic, whatever comes of it.
    #[test]
    fn a_mutilated_railml_file_is_no_panic(changes in prop::collection::vec((0_usize..6, any::<prop::sample::Index>(), any::<prop::sample::Index>()), 1..8)) {
        let mut text = small();
        for (kind, at, other) in changes {
            let lines: Vec<String> = text.lines().map(str::to_owned).collect();
            let (one, two) = (at.index(lines.len()), other.index(lines.len()));
            let mut lines = lines;
            match kind {
                0 => { lines.remove(one); }
                1 => lines.swap(one, two),
                2 => { let line = lines[two].clone(); lines.insert(one, line); }
                3 => lines[one] = lines[one].replace("\"0", "\"1"),
                4 => lines[one] = lines[one].replacen("ref=\"", "ref=\"x", 1),
                _ => lines[one] = lines[one].replacen('"', "\"-", 1).replace("PT", "P").replace("length=\"", "length=\"1e9"),
            }
            text = lines.join("\n");
        }
        if let Ok(imported) = railml("station.railml", &text) {
            let model = imported.description.model();
            let _ = imported.description.compile();
            if let Ok(model) = model {
                let _ = atc_layout::draw::svg(&imported.description.station, &model);
                let _ = atc_layout::table::csv(&model);
            }
        }
    }

    /// The same for a file in TOML, by bytes.
    #[test]
    fn a_mutilated_layout_is_no_panic(cuts in prop::collection::vec((any::<prop::sample::Index>(), "[a-z0-9\"=\\[\\]]{0,3}"), 1..6)) {
        let mut text = include_str!("../../layouts/terminus.toml").to_owned();
        for (at, put) in cuts {
            let mut at = at.index(text.len());
            while !text.is_char_boundary(at) { at -= 1; }
            let end = text[at..].chars().next().map_or(at, |letter| at + letter.len_utf8());
            text.replace_range(at..end, &put);
        }
        if let Err(errors) = atc_layout::Description::from_toml("x", &text).and_then(|description| description.compile()) {
            prop_assert!(!errors.problems.is_empty());
        }
    }
}
