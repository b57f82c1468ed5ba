//! Files that others' stations taught us: each was once imported as a layout that breaks no rule and sends trains into each other.

use std::collections::BTreeSet;

use atc_layout::form::{EndKind, Position};
use atc_layout::import::{Imported, railml};
use atc_layout::model::{Guard, Model, Route};
use atc_layout::{Description, Rule};

const HEAD_ON: &str = include_str!("files/head-on.railml");
const SHORT: &str = include_str!("files/short2.railml");
const DUPLICATE: &str = include_str!("files/dupbuf.railml");
const SCISSORS: &str = include_str!("files/scissors.toml");
const SLIP: &str = include_str!("files/slip.railml");
const CROSSING: &str = include_str!("files/crossing.railml");

fn imported(text: &str) -> Imported {
    railml("station.railml", text).unwrap_or_else(|errors| panic!("{errors}"))
}

fn model(imported: &Imported) -> Model {
    imported.description.model().unwrap_or_else(|errors| panic!("{errors}\n{}", imported.report))
}

fn route<'a>(model: &'a Model, name: &str) -> &'a Route {
    model.routes.iter().find(|route| route.name == name).unwrap_or_else(|| panic!("route {name} was imported"))
}

/// The circuits of a route, the one in rear of its signal first.
fn circuits(model: &Model, name: &str) -> Vec<String> {
    let route = route(model, name);
    let all = [route.entry].into_iter().chain(route.circuits());
    all.map(|circuit| model.circuits[circuit].name.clone()).collect()
}

/// A change to a file that must be there to be made.
fn changed(text: &str, from: &str, to: &str) -> String {
    assert!(text.contains(from), "{from}");
    text.replacen(from, to, 1)
}

fn left_out(text: &str, route: &str, why: &str) {
    let report = imported(text).report;
    let start = format!("route {route}, line ");
    let told = report.lacking.iter().any(|line| line.starts_with(&start) && line.contains(why));
    assert!(told, "{route}: {why:?} is not among the reasons:\n{report}");
}

#[test]
fn a_route_ends_at_the_first_joint_beyond_its_exit_signal_in_its_direction() {
    for text in [HEAD_ON, SHORT] {
        let model = model(&imported(text));
        assert_eq!(model.routes.len(), 8);
        assert_eq!(circuits(&model, "W-1"), ["W1", "P1T", "1Ta", "1Tb"]);
        assert_eq!(circuits(&model, "E-1"), ["E1", "P2T", "1Tb", "1Ta"]);
        let shared: BTreeSet<usize> = route(&model, "W-1").circuits().collect();
        assert!(route(&model, "E-1").circuits().any(|circuit| shared.contains(&circuit)), "they exclude each other");
        // The train waits in the circuit in rear of the signal, and its route begins ahead of it.
        assert_eq!(circuits(&model, "1-E"), ["1Tb", "P2T"]);
        assert_eq!(circuits(&model, "1-W"), ["1Ta", "P1T"]);
    }
}

#[test]
fn a_listed_section_is_never_dropped_but_the_one_in_rear_of_the_entry() {
    let listed = "<hasTvdSection ref=\"tvd3\"/>\n            <hasTvdSection ref=\"tvd9\"/>\n            <routeEntry id=\"rt0e\">";
    // The exit is reached over 1Ta and 1Tb, and the file leaves 1Tb out.
    let text = changed(HEAD_ON, listed, "<hasTvdSection ref=\"tvd3\"/>\n            <routeEntry id=\"rt0e\">");
    left_out(&text, "rt0", "it runs over sections that it does not list: tvdSection tvd9, line ");
    // A section elsewhere.
    let text =
        changed(HEAD_ON, "<hasTvdSection ref=\"tvd9\"/>", "<hasTvdSection ref=\"tvd9\"/><hasTvdSection ref=\"tvd4\"/>");
    left_out(&text, "rt0", "do not lie between its signal and its exit: tvdSection tvd4, line ");
    let text = changed(HEAD_ON, "<hasTvdSection ref=\"tvd9\"/>", "<hasTvdSection ref=\"ghost\"/>");
    left_out(&text, "rt0", "its section has no place (ghost, which does not exist)");
}

#[test]
fn what_is_not_understood_leaves_the_route_out_and_nothing_else() {
    let cases = [
        (
            "inPosition=\"left\"><refersToSwitch ref=\"swil0\"",
            "inPosition=\"down\"><refersToSwitch ref=\"swil0\"",
            "neither left nor right",
        ),
        (
            "inPosition=\"left\"><refersToSwitch ref=\"swil0\"",
            "inPosition=\"left\"><refersToSwitch ref=\"none\"",
            "the switch none does not exist",
        ),
        (
            "inPosition=\"left\"><refersToSwitch ref=\"swil0\"",
            "inPosition=\"left\"><refersToSwitch ref=\"sig1at2\"",
            "is not one that was taken",
        ),
        ("approachReleaseDelay=\"PT60S\"", "approachReleaseDelay=\"soon\"", "\"soon\" is no time that can be read"),
        (
            "<routeExit id=\"rt0x\"><refersTo ref=\"ilsig3at4\"/>",
            "<routeExit id=\"rt0x\"><refersTo ref=\"none\"/>",
            "its exit none does not exist",
        ),
    ];
    for (from, to, why) in cases {
        let text = changed(HEAD_ON, from, to);
        left_out(&text, "rt0", why);
        assert_eq!(model(&imported(&text)).routes.len(), 7, "{why}");
    }
}

#[test]
fn a_signal_for_the_other_direction_does_not_begin_the_route() {
    // W stands at the joint between W1 and P1T, for trains that run toward P1.
    let text = changed(
        HEAD_ON,
        "<spotLocation id=\"sig1at2l\" netElementRef=\"ne0\" intrinsicCoord=\"0.047619048\" applicationDirection=\"reverse\"/>",
        "<spotLocation id=\"sig1at2l\" netElementRef=\"ne0\" intrinsicCoord=\"0.047619048\" applicationDirection=\"normal\"/>",
    );
    let report = imported(&text).report;
    assert!(report.lacking.iter().filter(|line| line.starts_with("route rt")).count() >= 2, "{report}");
}

#[test]
fn elements_are_told_apart_by_their_ids() {
    let imported = imported(DUPLICATE);
    let model = model(&imported);
    assert_eq!(model.routes.len(), 6, "{}", imported.report);
    // Two signals of one name: neither is called by it.
    let text = changed(HEAD_ON, "<name name=\"1E\"", "<name name=\"1W\"");
    let signals: BTreeSet<String> =
        self::model(&self::imported(&text)).routes.into_iter().map(|route| route.signal).collect();
    assert!(signals.contains("sig3at3") && signals.contains("sig3at4") && !signals.contains("1W"), "{signals:?}");
}

#[test]
fn a_speed_of_the_file_is_never_raised() {
    let slow = changed(
        HEAD_ON,
        "<leftBranch netRelationRef=\"nr0n\"/>",
        "<leftBranch netRelationRef=\"nr0n\" branchingSpeed=\"40\" joiningSpeed=\"60\"/>",
    );
    let kmh = |text: &str, name: &str| {
        let model = model(&imported(text));
        model.values.speeds_kmh[usize::from(route(&model, name).speed.0)]
    };
    assert_eq!((kmh(HEAD_ON, "W-1"), kmh(&slow, "W-1"), kmh(&slow, "1-W"), kmh(&slow, "W-2")), (90, 25, 25, 15));
    let stretch = "<speeds><speedSection id=\"v1\" maxSpeed=\"60\"><linearLocation id=\"v1l\"><associatedNetElement netElementRef=\"ne1\" intrinsicCoordBegin=\"0.6\" intrinsicCoordEnd=\"0.9\"/></linearLocation></speedSection></speeds><bufferStops>";
    let with = changed(HEAD_ON, "<bufferStops>", stretch);
    // It lies in 1Tb alone, which a train from 1W does not run over.
    assert_eq!((kmh(&with, "W-1"), kmh(&with, "E-1"), kmh(&with, "1-W"), kmh(&with, "W-2")), (55, 55, 90, 15));
    let crawl = changed(
        HEAD_ON,
        "<leftBranch netRelationRef=\"nr0n\"/>",
        "<leftBranch netRelationRef=\"nr0n\" branchingSpeed=\"10\"/>",
    );
    left_out(&crawl, "rt0", "its limit of 10 km/h is below the lowest code");
}

#[test]
fn times_of_sections_are_kept() {
    let text = changed(
        HEAD_ON,
        "<tvdSection id=\"tvd2\"",
        "<tvdSection residualRouteCancellationDelay=\"PT90S\" partialRouteReleaseDelay=\"PT4S\" id=\"tvd2\"",
    );
    let model = model(&imported(&text));
    let release = |name: &str| model.values.ms(route(&model, name).release);
    assert_eq!((release("W-1"), release("1-E")), (90_000, 60_000));
    assert_eq!(u32::from(model.values.clear) * model.values.cycle_ms, 4000);
}

#[test]
fn over_a_scissors_crossover_no_point_is_a_guard_that_leads_under_the_train() {
    let description = Description::from_toml("scissors.toml", SCISSORS).unwrap_or_else(|errors| panic!("{errors}"));
    // What may stand in the dead ends faces no signal: a layout must say why that is enough.
    let errors = description.model().expect_err("no reason is given");
    assert!(errors.problems.iter().all(|problem| problem.rule == Rule::NoFlank), "{errors}");
    let model = description.tracks().unwrap_or_else(|errors| panic!("{errors}"));
    let route = &model.routes[0];
    let held = |name: &str| {
        let point = model.points.iter().position(|point| point.name == name).expect("it is there");
        route.positions().find(|(one, _)| *one == point).map(|(_, position)| position)
    };
    assert_eq!(["1a", "1b"].map(held), [Some(Position::Reverse); 2]);
    assert_eq!(["2a", "2b"].map(held), [Some(Position::Normal); 2], "as the table of such a station has them");
    let guards: Vec<&Guard> = route.flanks.iter().flat_map(|flank| &flank.guards).collect();
    let circuit = |name: &str| model.circuits.iter().position(|circuit| circuit.name == name).expect("it is there");
    let point = |name: &str| model.points.iter().position(|point| point.name == name).expect("it is there");
    // The other track of the crossing is left by the two points of the other crossover.
    let crossed = ["2b", "2a"].map(|name| Guard::Point(point(name), Position::Normal));
    let [after, before] = ["AR", "BL"].map(|name| Guard::Standing(circuit(name)));
    assert_eq!(guards, [&after, &crossed[0], &crossed[1], &before]);
}

#[test]
fn a_slip_is_run_over_as_its_machines_stand() {
    let model = model(&imported(SLIP));
    let over = |name: &str| -> Vec<(String, Position)> {
        let passed = route(&model, name).path.iter().flat_map(|place| &place.passed);
        passed.map(|passed| (model.points[passed.point].name.clone(), passed.position)).collect()
    };
    let crossed: Vec<Vec<(String, Position)>> = ["A-C", "A-D", "B-C", "B-D"].map(over).into();
    assert_eq!(crossed.iter().collect::<BTreeSet<_>>().len(), 4, "four ways");
    assert!(crossed.iter().all(|way| way.len() == 2), "{crossed:?}");
    for (name, last) in [("A-C", "C"), ("A-D", "D"), ("B-C", "C"), ("B-D", "D")] {
        assert_eq!(circuits(&model, name), [&name[..1], "X", last]);
    }
}

#[test]
fn a_machine_of_a_slip_that_cannot_be_told_apart_leaves_its_routes_out() {
    let none = changed(SLIP, "<branchLeft ref=\"c\"/>", "");
    left_out(&none, "ac", "of a slip names no branchLeft and branchRight");
    let other = changed(SLIP, "<branchLeft ref=\"c\"/>", "<branchLeft ref=\"a\"/>");
    left_out(&other, "ac", "are not those of its slip");
}

#[test]
fn a_single_slip_has_no_fourth_way() {
    let single = changed(SLIP, "<turningBranch netRelationRef=\"nbd\"/>", "");
    let single = single.replace("doubleSwitchCrossing", "singleSwitchCrossing");
    left_out(&single, "bd", "it runs over a single slip where that has no way");
    assert_eq!(model(&imported(&single)).routes.len(), 3);
}

#[test]
fn where_the_file_leaves_several_ways_none_is_taken() {
    // Without positions and sections, from A to a detector that both C and D lead to.
    let text = changed(
        SLIP,
        "<facingSwitchInPosition inPosition=\"left\"><refersToSwitch ref=\"m2\"/></facingSwitchInPosition><hasTvdSection ref=\"tX\"/><hasTvdSection ref=\"tC\"/>",
        "",
    );
    // The exit says where it goes: the way is the only one.
    assert_eq!(circuits(&model(&imported(&text)), "A-C"), ["A", "X", "C"]);
    let text = changed(&text, "<routeExit><refersTo ref=\"dC\"/></routeExit>", "<hasTvdSection ref=\"tX\"/>");
    left_out(&text, "ac", "more than one way");
}

/// The third attack: a crossing that is no switch was passed over in silence, and both routes over it showed proceed.
#[test]
fn tracks_that_cross_are_one_circuit_or_the_file_is_refused() {
    for (id, section) in [("ra", "tXA"), ("rc", "tXC")] {
        left_out(CROSSING, id, &format!("its section has no place (tvdSection {section}"));
    }
    // Where one section has all four borders the routes exclude each other.
    let both = "<hasDemarcatingTraindetector ref=\"dA\"/><hasDemarcatingTraindetector ref=\"dA2\"/>";
    let four = format!("{both}<hasDemarcatingTraindetector ref=\"dC\"/><hasDemarcatingTraindetector ref=\"dC2\"/>");
    let text = changed(CROSSING, both, &four).replace("<hasTvdSection ref=\"tXC\"/>", "<hasTvdSection ref=\"tXA\"/>");
    let model = model(&imported(&text));
    assert_eq!(circuits(&model, "A-out"), ["A", "XA"]);
    assert_eq!(circuits(&model, "C-out"), ["C", "XA"]);
    let unsaid = changed(CROSSING, "<straightBranch netRelationRef=\"nc\"/>", "");
    let errors = railml("station.railml", &unsaid).expect_err("which tracks cross is not known");
    assert!(errors.to_string().contains("does not name the two net relations of the tracks that cross"), "{errors}");
}

/// The file without its crossing, and with this in its place.
fn with_in_place_of_the_crossing(text: &str) -> String {
    let (before, rest) = CROSSING.split_once("<crossings>").expect("there is a crossing");
    let (_, after) = rest.split_once("</crossings>").expect("it ends");
    format!("{before}{text}{after}")
}

/// The third attack: a limit that could not be read, or whose place was not known, was none.
#[test]
fn a_limit_is_never_raised() {
    let speed = |limit: &str, place: &str| {
        with_in_place_of_the_crossing(&format!(
            "<speeds><speedSection id=\"sp\" maxSpeed=\"{limit}\">{place}</speedSection></speeds>"
        ))
    };
    let on = "<linearLocation><associatedNetElement netElementRef=\"a\"/></linearLocation>";
    for limit in ["25 km/h", "25,0", "0", ""] {
        left_out(&speed(limit, on), "ra", "its limit of 0 km/h is below the lowest code");
    }
    for place in [on, "<spotLocation netElementRef=\"a\" pos=\"960\"/>", &on.replace("\"a\"", "\"macro\"")] {
        let model = model(&imported(&speed("25", place)));
        assert_eq!(model.values.speeds_kmh[usize::from(route(&model, "A-out").speed.0)], 25, "{place}");
    }
}

/// The third attack: what a relation asks for besides points was passed over.
#[test]
fn a_route_that_asks_for_what_no_layout_holds_is_left_out() {
    let relation = "</routes><routeRelations><routeRelation id=\"rel\"><requiredDerailerPosition/></routeRelation></routeRelations>";
    let text = changed(&with_in_place_of_the_crossing(""), "</routes>", relation);
    let text =
        changed(&text, "<assetName name=\"A-out\"/>", "<assetName name=\"A-out\"/><additionalRelation ref=\"rel\"/>");
    left_out(&text, "ra", "asks for a requiredDerailerPosition, which no layout holds");
    assert_eq!(model(&imported(&text)).routes.len(), 1);
}

/// The third attack: distances were those of level track.
#[test]
fn the_steepest_gradient_of_a_file_holds_everywhere() {
    let curve = |gradient: &str| {
        with_in_place_of_the_crossing(&format!(
            "<geometryCurves><gradientCurve id=\"g\" gradient=\"{gradient}\"/></geometryCurves>"
        ))
    };
    let level = model(&imported(&with_in_place_of_the_crossing("")));
    let steep = model(&imported(&curve("-24.5")));
    assert!(steep.values.braking[7] > level.values.braking[7], "{:?}", steep.values.braking);
    for unread in ["steep", "-500"] {
        assert!(railml("station.railml", &curve(unread)).unwrap_err().to_string().contains("‰ are possible"));
    }
}

/// The file with one thing in a route, a machine, or wherever else it stands before this.
fn with(before: &str, what: &str) -> String {
    changed(HEAD_ON, before, &format!("{what}{before}"))
}

/// The thirteenth attack: a limit outside its net element, or of no length, was taken and held nowhere.
#[test]
fn a_limit_that_cannot_be_placed_holds_everywhere() {
    let limit = |place: &str| {
        let on = format!("<linearLocation><associatedNetElement netElementRef=\"ne1\" {place}</linearLocation>");
        with("<bufferStops>", &format!("<speeds><speedSection id=\"v\" maxSpeed=\"25\">{on}</speedSection></speeds>"))
    };
    let kmh = |text: &str, name: &str| {
        let model = model(&imported(text));
        model.values.speeds_kmh[usize::from(route(&model, name).speed.0)]
    };
    // Between the two joints of 1Tb alone.
    assert_eq!(kmh(&limit("posBegin=\"260\" posEnd=\"400\"/>"), "1-W"), 90);
    for place in [
        "posBegin=\"1600\" posEnd=\"1900\"/>",
        "posBegin=\"300\" posEnd=\"1900\"/>",
        "posBegin=\"600\"/>",
        "intrinsicCoordBegin=\"60\" intrinsicCoordEnd=\"80\"/>",
        "intrinsicCoordBegin=\"0\" intrinsicCoordEnd=\"0\"/>",
        "intrinsicCoordBegin=\"1\" intrinsicCoordEnd=\"1\"/>",
        "intrinsicCoordBegin=\"1\"/>",
        "posBegin=\"-300\" posEnd=\"-100\"/>",
        "posBegin=\"260\" posEnd=\"400 m\"/>",
        "posBegin=\"260\" intrinsicCoordBegin=\"0.9\" posEnd=\"400\"/>",
        "><linearCoordinateBegin measure=\"2.1\"/><linearCoordinateEnd measure=\"2.3\"/></associatedNetElement>",
    ] {
        let text = limit(place);
        assert_eq!((kmh(&text, "1-W"), kmh(&text, "1-E")), (25, 25), "{place}");
        let report = imported(&text).report;
        let told = |line: &String| {
            line.starts_with("a place for the speedSection v, line ") && line.ends_with("25 km/h hold everywhere")
        };
        assert!(report.lacking.iter().any(told), "{place}: {report}");
    }
}

/// The same: detectors that foul a switch were passed over.
#[test]
fn a_switch_is_fouled_where_the_file_says_or_not_run_over() {
    let fouled = |by: &str| {
        changed(
            HEAD_ON,
            "preferredPosition=\"left\"><refersTo ref=\"sw0\"/>",
            &format!("preferredPosition=\"left\"><refersTo ref=\"sw0\"/>{by}"),
        )
    };
    let circuits = |text: &str| -> Vec<String> {
        let points = &imported(text).description.station.points;
        points[0].fouled_in.iter().map(|name| name.value.clone()).collect()
    };
    assert_eq!(circuits(&fouled("<hasFoulingTrainDetectors ref=\"tde3\"/>")), ["1Ta"]);
    assert_eq!(circuits(&fouled("<hasFoulingTrainDetectors ref=\"tvd4\"/>")), ["2T"]);
    let what = [
        ("<hasFoulingTrainDetectors ref=\"none\"/>", "no circuit is at the none, which does not exist"),
        ("<hasFoulingTrainDetectors/>", "refers to nothing"),
        ("<relatedMovableElement ref=\"swil1\"/>", "has relatedMovableElement, which no layout holds"),
        ("<hasPositionRestriction/>", "has hasPositionRestriction, which no layout holds"),
    ];
    for (by, why) in what {
        let text = fouled(by);
        for route in ["rt0", "rt1", "rt6", "rt7"] {
            left_out(&text, route, why);
        }
        assert_eq!(imported(&text).description.station.routes.len(), 4, "{by}");
    }
    let locked = HEAD_ON.replacen("<switchIL id=\"swil0\"", "<switchIL isKeyLocked=\"true\" id=\"swil0\"", 1);
    left_out(&locked, "rt0", "has isKeyLocked, which no layout holds");
    assert_eq!(imported(&locked.replace("\"true\"", "\"false\"")).description.station.routes.len(), 8);
}

/// The same: what must not stand right was held right.
#[test]
fn a_negated_position_leaves_the_route_out() {
    let relation = |not: &str| {
        let asked = format!(
            "<requiredSwitchPosition><relatedSwitchAndPosition inPosition=\"right\"{not}><refersToSwitch ref=\"swil1\"/></relatedSwitchAndPosition></requiredSwitchPosition>"
        );
        let relation = format!("<routeRelations><routeRelation id=\"rr\">{asked}</routeRelation></routeRelations>");
        let text = with("<conflictingRoutes>", &relation);
        changed(&text, "<routeEntry id=\"rt0e\">", "<additionalRelation ref=\"rr\"/><routeEntry id=\"rt0e\">")
    };
    assert_eq!(imported(&relation(" isNegated=\"false\"")).description.station.routes.len(), 8);
    left_out(
        &relation(" isNegated=\"true\""),
        "rt0",
        "a position of it is negated (relatedSwitchAndPosition without an id, line ",
    );
    let own = changed(HEAD_ON, "id=\"rt0p0\" ", "id=\"rt0p0\" isNegated=\"1\" ");
    left_out(&own, "rt0", "a position of it is negated (facingSwitchInPosition rt0p0, line ");
}

/// The same: beyond a buffer stop inside its net element there was a hundred metres of track.
#[test]
fn the_tracks_end_at_a_buffer_stop() {
    const TERMINUS: &str = include_str!("../../layouts/terminus.railml.xml");
    let length = |text: &str| {
        let model = model(&imported(text));
        model.circuits.iter().find(|circuit| circuit.name == "1T").map(|circuit| circuit.length.0)
    };
    let from = "netElementRef=\"ne8\" intrinsicCoord=\"1\"";
    let inside = changed(TERMINUS, from, "netElementRef=\"ne8\" pos=\"150\"");
    assert_eq!((length(TERMINUS), length(&inside)), (Some(220), Some(120)));
    let report = imported(&inside).report;
    let told = |line: &String| {
        line.starts_with("the tracks end at the bufferStop bs7, line ") && line.ends_with("at 150 m of 250 m of ne8")
    };
    assert!(report.defaulted.iter().any(told), "{report}");
    // Measured from the other end: the begin of the net element is cut off.
    let turned = inside.replace("netElementRef=\"ne8\" pos=\"150\"", "netElementRef=\"ne8\" pos=\"100\"").replace(
        "netElementRef=\"ne8\" intrinsicCoord=\"0.120000000\"",
        "netElementRef=\"ne8\" intrinsicCoord=\"0.88\"",
    );
    let turned = turned
        .lines()
        .map(|line| {
            let of = |side: &str| line.contains(&format!("element{side} ref=\"ne8\""));
            let line = if of("A") { line.replace("OnA=\"0\"", "OnA=\"1\"") } else { line.to_owned() };
            if of("B") { line.replace("OnB=\"0\"", "OnB=\"1\"") } else { line }
        })
        .collect::<Vec<_>>()
        .join("\n");
    assert_eq!(
        imported(&turned)
            .description
            .station
            .circuits
            .iter()
            .find(|one| one.name.value == "1T")
            .map(|one| one.length_m.value),
        Some(120)
    );
    // With a joint and a signal on either side it is no end; nothing runs over it.
    let stop = "<bufferStop id=\"bs1\"><spotLocation netElementRef=\"ne1\" pos=\"100\"/></bufferStop></bufferStops>";
    let text = changed(HEAD_ON, "</bufferStops>", stop);
    for route in ["rt0", "rt2", "rt6"] {
        left_out(&text, route, "the bufferStop bs1, line 23 at 100 m of 460 m of ne1 stands in its way");
    }
    assert_eq!(model(&imported(&text)).routes.len(), 5);
    // On the net element of the line: between the joint and the points, and where the line goes on.
    for place in [20, 400] {
        let stop = format!(
            "<bufferStop id=\"bs1\"><spotLocation netElementRef=\"ne0\" pos=\"{place}\"/></bufferStop></bufferStops>"
        );
        let imported = imported(&changed(HEAD_ON, "</bufferStops>", &stop));
        let ends = &imported.description.station.ends;
        assert!(ends.iter().all(|end| end.kind == EndKind::Line), "{ends:?}");
        assert_eq!(imported.description.station.segments.len(), 2, "{}", imported.report);
        let told = |line: &String| line.starts_with("an end of the tracks at the bufferStop bs1, line 23 at ");
        assert!(imported.report.lacking.iter().any(told), "{}", imported.report);
    }
}

/// The same: railML 3.2 has another name for it.
#[test]
fn the_release_time_of_railml_3_2_is_kept() {
    for (before, name) in [("<route id=\"rt0\" ", "W-1"), ("<tvdSection id=\"tvd2\" ", "W-1")] {
        let text = changed(HEAD_ON, before, &format!("{before}residualRouteReleaseDelay=\"PT180S\" "));
        let model = model(&imported(&text));
        assert_eq!(model.values.ms(route(&model, name).release), 180_000, "{before}");
    }
}

/// The same: what the import does not read was not told.
#[test]
fn what_is_not_read_is_told_and_may_leave_the_route_out() {
    let told = |text: &str, what: &str| {
        let report = imported(text).report;
        assert!(report.skipped.iter().any(|line| line.starts_with(what)), "{what} is not told:\n{report}");
    };
    for (element, what) in [
        (
            "switchPositionInDepartureTrack",
            "<switchPositionInDepartureTrack inPosition=\"left\"><refersToSwitch ref=\"swil1\"/></switchPositionInDepartureTrack>",
        ),
        ("derailerInPosition", "<derailerInPosition/>"),
    ] {
        let text = with("<routeEntry id=\"rt0e\">", what);
        left_out(&text, "rt0", &format!("it has the element {element}, which no layout holds"));
        told(&text, &format!("the element {element} of route, which 1 have; the first is route rt0, line "));
        assert_eq!(model(&imported(&text)).routes.len(), 7);
    }
    let late = changed(HEAD_ON, "<route id=\"rt0\" ", "<route proceedAspectDelay=\"PT40S\" id=\"rt0\" ");
    left_out(&late, "rt0", "it has the attribute proceedAspectDelay");
    let all = HEAD_ON
        .replace("<tvdSection ", "<tvdSection isBerthingTrack=\"true\" ")
        .replace("<route ", "<route processingDelay=\"PT5S\" ");
    told(&all, "the attribute isBerthingTrack of tvdSection, which 7 have; the first is tvdSection tvd1, line ");
    told(&all, "the attribute processingDelay of route, which 8 have");
    assert_eq!(model(&imported(&all)).routes.len(), 8);
    assert!(!imported(HEAD_ON).report.skipped.iter().any(|line| line.contains("the first is")));
}

/// The same: circuits of 60 km, and two words for one length or place.
#[test]
fn a_length_in_another_unit_or_said_twice_is_refused_or_told() {
    let millimetres = changed(HEAD_ON, "id=\"ne1\" length=\"460\"", "id=\"ne1\" length=\"460000\"");
    let errors = railml("station.railml", &millimetres).expect_err("it is longer than any circuit");
    assert!(errors.to_string().contains("the netElement ne1, line 8 is 460000 m long"), "{errors}");
    let told = |text: &str, start: &str| {
        let report = imported(text).report;
        assert!(report.defaulted.iter().any(|line| line.starts_with(start)), "{start} is not told:\n{report}");
    };
    let centimetres = changed(HEAD_ON, "id=\"ne1\" length=\"460\"", "id=\"ne1\" length=\"46000\"");
    told(&centimetres, "circuit 1Ta: it is 20000 m long");
    let marks = |from: u32, to: u32| {
        let mark = |share: u32, at: u32| {
            format!(
                "<intrinsicCoordinate intrinsicCoord=\"{share}\"><linearCoordinate measure=\"{at}\"/></intrinsicCoordinate>"
            )
        };
        let both =
            format!("<associatedPositioningSystem>{}{}</associatedPositioningSystem>", mark(0, from), mark(1, to));
        changed(HEAD_ON, "id=\"ne1\" length=\"460\"/>", &format!("id=\"ne1\" length=\"460\">{both}</netElement>"))
    };
    told(&marks(1000, 1400), "length of the netElement ne1, line 8: 460 m; by its chainage it would be 400 m");
    assert!(!imported(&marks(1000, 1455)).report.to_string().contains("by its chainage"));
    let twice = changed(
        HEAD_ON,
        "netElementRef=\"ne1\" intrinsicCoord=\"0.5\"",
        "netElementRef=\"ne1\" intrinsicCoord=\"0.5\" pos=\"300\"",
    );
    let report = imported(&twice).report;
    assert!(report.lacking.iter().any(|line| line == "a place on a net element of: tde9"), "{report}");
    left_out(&twice, "rt0", "its section has no place");
}

/// The same: what is usual is not the longest.
#[test]
fn a_typical_throw_time_is_told_as_assumed() {
    let text = changed(HEAD_ON, "id=\"swil0\" maxThrowTime", "id=\"swil0\" typicalThrowTime");
    let report = imported(&text).report;
    let told = "longest throw time of switch sw0: the typicalThrowTime of the switchIL swil0, line ";
    assert!(report.defaulted.iter().any(|line| line.starts_with(told)), "{report}");
}

#[test]
fn nothing_imported_is_a_broken_rule() {
    let none = HEAD_ON.replace("<routeEntry", "<routeStart").replace("</routeEntry>", "</routeStart>");
    let imported = imported(&none);
    assert_eq!(imported.description.station.routes.len(), 0);
    let errors = imported.description.compile().expect_err("there is no route");
    assert!(errors.to_string().contains("the layout has no route: nothing can be set"), "{errors}");
}
