//! Files that others' stations taught us: each was once imported as a layout that breaks no rule and sends trains into each other.

use std::collections::BTreeSet;

use atc_layout::form::Position;
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
    assert_eq!(guards, [&Guard::Standing(circuit("AR")), &Guard::Standing(circuit("BL"))]);
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

#[test]
fn nothing_imported_is_a_broken_rule() {
    let none = HEAD_ON.replace("<routeEntry", "<routeStart").replace("</routeEntry>", "</routeStart>");
    let imported = imported(&none);
    assert_eq!(imported.description.station.routes.len(), 0);
    let errors = imported.description.compile().expect_err("there is no route");
    assert!(errors.to_string().contains("the layout has no route: nothing can be set"), "{errors}");
}
