//! Stations written as PlanPro in the ways of different tools: what is imported is what was written. With one falsification in the file, a route
//! is left out, or it is what it was before.
//!
//! `STATIONS=10000 cargo test -p atc-layout --test planpro --release` takes more of them.

#[path = "support/shapes.rs"]
mod shapes;
mod support;

use std::collections::BTreeMap;

use atc_layout::form::{Position, Station};
use atc_layout::import::{Imported, planpro};
use atc_layout::model::{Model, Route};
use proptest::prelude::*;
use proptest::sample::Index;
use proptest::test_runner::TestCaseError;
use shapes::{runner, shapes};
use support::model;
use support::planpro::{Tool, id, name_of, written};
use support::random::{Shape, station};

fn tools() -> impl Strategy<Value = Tool> {
    let offset = prop_oneof![Just(0.0), 0.1..0.9_f64, 2.0..19.0_f64];
    (0_usize..4, 0_usize..3, offset, prop::array::uniform3(any::<bool>())).prop_map(
        |(turned, mirrored, offset, [backwards, nameless, planned])| Tool {
            turned,
            mirrored,
            offset,
            backwards,
            nameless,
            planned,
        },
    )
}

/// What a train on a route runs over, and what is held beyond it: by name.
#[derive(Debug, PartialEq)]
struct Course {
    signal: String,
    entry: String,
    circuits: Vec<String>,
    points: BTreeMap<String, Position>,
    overlap: Vec<String>,
}

impl Course {
    /// Whether it is the same, or holds more beyond its end.
    fn keeps(&self, other: &Self) -> bool {
        let points = other.points.iter().all(|(name, position)| self.points.get(name) == Some(position));
        let same = (&self.signal, &self.entry, &self.circuits) == (&other.signal, &other.entry, &other.circuits);
        same && points && self.overlap.starts_with(&other.overlap)
    }
}

fn course(model: &Model, route: &Route) -> Course {
    let name = |number: usize| model.circuits[number].name.clone();
    let passed = route.path.iter().flat_map(|place| &place.passed).chain(&route.overlap_passed);
    Course {
        signal: route.signal.clone(),
        entry: name(route.entry),
        circuits: route.circuits().map(name).collect(),
        points: passed.map(|passed| (model.points[passed.point].name.clone(), passed.position)).collect(),
        overlap: route.overlap.iter().copied().map(name).collect(),
    }
}

fn expected(model: &Model) -> BTreeMap<String, Course> {
    model.routes.iter().map(|route| (name_of(model, route), course(model, route))).collect()
}

fn found(imported: &Imported) -> Result<BTreeMap<String, Course>, TestCaseError> {
    let model = imported
        .description
        .tracks()
        .map_err(|errors| TestCaseError::fail(format!("{errors}\n{}", imported.report)))?;
    Ok(model.routes.iter().map(|route| (route.name.clone(), course(&model, route))).collect())
}

fn import(text: &str) -> Result<Imported, TestCaseError> {
    planpro("station.ppxml", text).map_err(|errors| TestCaseError::fail(errors.to_string()))
}

#[test]
fn a_station_is_imported_as_each_tool_writes_it() {
    let result = runner(24).run(&(shapes(12), tools()), |(shape, tool)| {
        let station = station(&shape);
        let imported = import(&written(&station, &tool))?;
        prop_assert_eq!(expected(&model(&station)), found(&imported)?, "{}", imported.report);
        let second = imported.report.lacking.iter().find(|line| line.contains("second reading"));
        prop_assert_eq!(second, None);
        Ok(())
    });
    result.unwrap_or_else(|error| panic!("{error}"));
}

/// One wrong thing in the file.
#[derive(Clone, Copy, Debug)]
enum Falsified {
    /// A part of a path is left out.
    Missing,
    /// A part of a path lies on another edge.
    Edge,
    /// A part of a path begins or ends elsewhere.
    Border,
    /// A path begins at another signal.
    Start,
    /// A path ends at another signal.
    Exit,
    /// A signal is for the other direction.
    Side,
    /// A signal stands elsewhere.
    Place,
    /// A section covers less.
    Section,
    /// A section covers a part of another one.
    Shared,
    /// The border of two sections stands elsewhere.
    Joint,
    /// Two edges are joined to the wrong legs of a point.
    Legs,
}

const FALSIFIED: [Falsified; 11] = [
    Falsified::Missing,
    Falsified::Edge,
    Falsified::Border,
    Falsified::Start,
    Falsified::Exit,
    Falsified::Side,
    Falsified::Place,
    Falsified::Section,
    Falsified::Shared,
    Falsified::Joint,
    Falsified::Legs,
];

/// The parts of a text between two words, with their places.
fn between<'a>(text: &'a str, begin: &str, end: &str) -> Vec<(usize, &'a str)> {
    let starts = text.match_indices(begin).map(|(at, _)| at);
    starts.filter_map(|at| Some((at, &text[at..at + text[at..].find(end)? + end.len()]))).collect()
}

/// The text with one thing falsified; nothing if it has none.
fn falsify(text: &str, what: Falsified, index: [Index; 3], metres: f64) -> Option<String> {
    let pick = |all: Vec<(usize, &str)>, index: Index| -> Option<(usize, String)> {
        (!all.is_empty()).then(|| all[index.index(all.len())]).map(|(at, part)| (at, part.to_owned()))
    };
    let object = |kind: &str| {
        let wanted = pick(between(text, &format!("<{kind}><Identitaet>"), &format!("</{kind}>")), index[0])?;
        Some(wanted)
    };
    let part = |of: &str| pick(between(of, "<Bereich_Objekt_Teilbereich>", "</Bereich_Objekt_Teilbereich>"), index[1]);
    let put = |(at, old): (usize, String), new: &str| Some(format!("{}{new}{}", &text[..at], &text[at + old.len()..]));
    let field = |of: &str, name: &str| {
        let all = between(of, &format!("<{name}><Wert>"), "</Wert>");
        Some(all.first()?.1.rsplit('>').nth(1)?.split('<').next()?.to_owned())
    };
    let moved = |of: &str, name: &str| {
        let old = field(of, name)?;
        let new = (old.parse::<f64>().ok()? + metres).max(0.0);
        Some(of.replacen(&format!("<{name}><Wert>{old}<"), &format!("<{name}><Wert>{new:.3}<"), 1))
    };
    let exchanged = |of: &str, name: &str, kind: &str| {
        let other = pick(between(text, &format!("<{kind}><Identitaet>"), "</Identitaet>"), index[2])?.1;
        let (old, new) = (field(of, name)?, field(&other, "Identitaet")?);
        Some(of.replacen(&format!("<{name}><Wert>{old}<"), &format!("<{name}><Wert>{new}<"), 1))
    };
    match what {
        Falsified::Missing | Falsified::Section => {
            let kind = if matches!(what, Falsified::Missing) { "Fstr_Fahrweg" } else { "Gleis_Abschnitt" };
            let whole = object(kind)?;
            let left = whole.1.replacen(&part(&whole.1)?.1, "", 1);
            put(whole, &left)
        }
        Falsified::Edge | Falsified::Shared => {
            let kind = if matches!(what, Falsified::Edge) { "Fstr_Fahrweg" } else { "Gleis_Abschnitt" };
            let whole = object(kind)?;
            let old = part(&whole.1)?.1;
            let new = exchanged(&old, "ID_TOP_Kante", "TOP_Kante")?;
            let new = whole.1.replacen(&old, &new, 1);
            put(whole, &new)
        }
        Falsified::Border => {
            let whole = object("Fstr_Fahrweg")?;
            let old = part(&whole.1)?.1;
            let name = if index[2].index(2) == 0 { "Begrenzung_A" } else { "Begrenzung_B" };
            let new = whole.1.replacen(&old, &moved(&old, name)?, 1);
            put(whole, &new)
        }
        Falsified::Start | Falsified::Exit => {
            let whole = object("Fstr_Fahrweg")?;
            let name = if matches!(what, Falsified::Start) { "ID_Start" } else { "ID_Ziel" };
            let new = exchanged(&whole.1, name, "Signal")?;
            put(whole, &new)
        }
        Falsified::Side => {
            let whole = object("Signal")?;
            let turned = if whole.1.contains(">in<") {
                whole.1.replacen(">in<", ">gegen<", 1)
            } else {
                whole.1.replacen(">gegen<", ">in<", 1)
            };
            put(whole, &turned)
        }
        Falsified::Place | Falsified::Joint => {
            let whole = object(if matches!(what, Falsified::Place) { "Signal" } else { "FMA_Komponente" })?;
            let new = moved(&whole.1, "Abstand")?;
            put(whole, &new)
        }
        Falsified::Legs => {
            let whole = object("TOP_Kante")?;
            let new = whole.1.replace(">Links<", ">Spitze<").replace(">Rechts<", ">Links<");
            put(whole, &new)
        }
    }
}

#[test]
fn a_falsified_file_loses_routes_and_changes_none() {
    let counts = std::cell::Cell::new((0_usize, 0_usize));
    let kinds = prop::sample::select(FALSIFIED.to_vec());
    let cases = (shapes(12), tools(), kinds, prop::array::uniform3(any::<Index>()), -60.0..60.0_f64);
    let result = runner(24).run(&cases, |(shape, tool, what, index, metres)| {
        let station = station(&shape);
        let Some(text) = falsify(&written(&station, &tool), what, index, metres) else { return Ok(()) };
        let imported = import(&text)?;
        let wanted = expected(&model(&station));
        let found = found(&imported)?;
        let (left_out, kept) = counts.get();
        counts.set(if found.len() < wanted.len() { (left_out + 1, kept) } else { (left_out, kept + 1) });
        for (name, course) in found {
            let same = wanted.get(&name).is_some_and(|wanted| course.keeps(wanted));
            prop_assert!(
                same,
                "{:?} of {}: {:?}, not {:?}: {}",
                what,
                name,
                course,
                wanted.get(&name),
                imported.report
            );
        }
        Ok(())
    });
    result.unwrap_or_else(|error| panic!("{error}"));
    let (left_out, kept) = counts.get();
    println!("{left_out} falsified files lost routes; in {kept} cases the layout is what it was");
    assert!(left_out > kept, "falsifications are seen");
}

/// A station of three tracks, the last of which ends in the east.
fn small() -> Station {
    station(&Shape { tracks: 3, bay: true, lengths: vec![75, 220, 410, 130], splits: vec![2, 1] })
}

/// The small station as PlanPro, with more objects at the end and some words exchanged.
fn with(objects: &str, words: &[(&str, &str)]) -> Imported {
    let mut text = written(&small(), &Tool::PLAIN).replacen(
        "</Container></LST_Zustand_Ziel>",
        &format!("{objects}</Container></LST_Zustand_Ziel>"),
        1,
    );
    for (old, new) in words {
        assert!(text.contains(old), "{old}");
        text = text.replacen(old, new, 1);
    }
    planpro("station.ppxml", &text).unwrap_or_else(|errors| panic!("{errors}"))
}

fn names(imported: &Imported) -> Vec<&str> {
    imported.description.station.routes.iter().map(|route| route.name.value.as_str()).collect()
}

fn value(name: &str, text: &str) -> String {
    format!("<{name}><Wert>{text}</Wert></{name}>")
}

fn object(kind: &str, inner: &str) -> String {
    format!("<{kind}>{}{inner}</{kind}>", value("Identitaet", "00000000-0000-4000-8000-000000000000"))
}

/// The numbers of a route, and of a point, of the small station.
fn number_of(name: &str) -> usize {
    let model = model(&small());
    let route = model.routes.iter().position(|route| name_of(&model, route) == name);
    route.or_else(|| model.points.iter().position(|point| point.name == name)).unwrap_or_else(|| panic!("{name}"))
}

/// The place at which the signal of a route stands: its edge and metres.
fn place_of_signal(name: &str) -> String {
    let text = written(&small(), &Tool::PLAIN);
    let signal = between(&text, "<Signal><Identitaet>", "</Signal>")
        .into_iter()
        .find(|(_, signal)| signal.contains(&value("Bezeichnung_Tabelle", name)))
        .expect("the signal is there")
        .1
        .to_owned();
    between(&signal, "<Punkt_Objekt_TOP_Kante>", "</Punkt_Objekt_TOP_Kante>")[0].1.to_owned()
}

/// What was found by somebody who had not written the import: each was once taken in silence.
fn conditions() -> Vec<Case<'static>> {
    let asks =
        |by: &str| format!("<Fla_Schutz_Anforderer>{}</Fla_Schutz_Anforderer>", value("ID_Anforderer_Element", by));
    let elsewhere = format!(
        "<Punkt_Objekt_TOP_Kante>{}{}</Punkt_Objekt_TOP_Kante><Entgleisungsschuh/>",
        value("Abstand", "1.000"),
        value("ID_TOP_Kante", "none")
    );
    let again = format!(
        "<Fstr_Zug>{}</Fstr_Zug>{}",
        value("Fstr_Zug_Art", "ZR"),
        value("ID_Fstr_Fahrweg", &id("path", number_of("1W/to 2")))
    );
    let overlap = number_of("W/1E");
    let form = "<W_Kr_Anlage_Allg><W_Kr_Art><Wert>EKW</Wert></W_Kr_Art></W_Kr_Anlage_Allg>";
    vec![
        ("a part of a route", String::new(), &[("<Wert>ZR<", "<Wert>ZT<")], "it is of the kind ZT"),
        ("flank for nobody", object("Fla_Schutz", &asks("none")), &[], "it may be about any route"),
        (
            "proved clear for nothing",
            object("Fla_Freimelde_Zuordnung", &value("ID_Fla_Schutz", "none")),
            &[],
            "it may be about any route",
        ),
        ("a level crossing on the way", object("BUE_Kante", &place_of_signal("1E")), &[], "is of a level crossing"),
        (
            "a signal that excludes others",
            String::new(),
            &[("<Signal_Real>", "<Signal_Fstr_Aus_Inselgleis/><Signal_Real>")],
            "excludes other trains",
        ),
        (
            "no running through",
            String::new(),
            &[(
                "<Signal_Real>",
                "<Signal_Fstr><Durchfahrt><Wert>verboten</Wert></Durchfahrt></Signal_Fstr><Signal_Real>",
            )],
            "is verboten, which no layout holds",
        ),
        (
            "an exclusion of nothing",
            String::new(),
            &[(
                "<Fstr_Zug>",
                "<ID_Fstr_Ausschluss_Besonders><Wert>none</Wert></ID_Fstr_Ausschluss_Besonders><Fstr_Zug>",
            )],
            "it excludes none, which is not in the file",
        ),
        (
            "a key lock on an overlap",
            object("Fstr_Abhaengigkeit", &value("ID_Fstr_Fahrweg", &id("overlap path", overlap))),
            &[],
            "may be a condition that no layout holds",
        ),
        ("more of an overlap", String::new(), &[("<Fstr_DWeg_Allg>", "<ID_New/><Fstr_DWeg_Allg>")], "it has ID_New"),
        (
            "a longer overlap",
            String::new(),
            &[("<Laenge_Soll><Wert>50<", "<Laenge_Soll><Wert>5000<")],
            "5000 m are asked for",
        ),
        (
            "an unreadable time",
            String::new(),
            &[("<Aufloesung_Verzoegerung><Wert>", "<Aufloesung_Verzoegerung><Wert>about ")],
            "is no number",
        ),
        (
            "a slip",
            object("W_Kr_Anlage", form),
            &[(
                "<Weiche_Element/>",
                "<ID_W_Kr_Anlage><Wert>00000000-0000-4000-8000-000000000000</Wert></ID_W_Kr_Anlage><Weiche_Element/>",
            )],
            "is part of a EKW",
        ),
        ("a derailer somewhere", object("W_Kr_Gsp_Komponente", &elsewhere), &[], "has no place on the tracks"),
        (
            "a point that has lost its place",
            String::new(),
            &[("<W_Kr_Gsp_Komponente>", "<Nothing>"), ("</W_Kr_Gsp_Komponente>", "</Nothing>")],
            "has no W_Kr_Gsp_Komponente",
        ),
        ("two routes over one path", object("Fstr_Zug_Rangier", &again), &[], "the same path and the same overlap"),
        (
            "a lock on a point",
            object("Schloss", &value("ID_W_Element", &id("point", 0))),
            &[],
            "and no layout holds that",
        ),
    ]
}

/// A change of the small station: what it is, objects that are added, words that are exchanged, and the reason that is told.
type Case<'a> = (&'a str, String, &'a [(&'a str, &'a str)], &'a str);

#[test]
fn what_no_layout_holds_leaves_its_routes_out() {
    let all = names(&with("", &[])).len();
    let path = id("path", number_of("W/1E"));
    let platform = model(&small()).circuits.iter().position(|circuit| circuit.name == "1T").expect("it is there");
    let section = format!("<ID_Gleis_Abschnitt><Wert>{}<", id("track", platform));
    let undetected = [(section.as_str(), "<ID_Gleis_Abschnitt><Wert>none<")];
    let mut cases: Vec<Case> = vec![
        (
            "a derailer",
            object("W_Kr_Gsp_Komponente", &format!("{}<Entgleisungsschuh/>", place_of_signal("1E"))),
            &[],
            "must be off the track",
        ),
        (
            "a movable bridge",
            object(
                "W_Kr_Gsp_Komponente",
                &format!("{}{}", place_of_signal("1E"), value("Besonderes_Fahrwegelement", "sonstige")),
            ),
            &[],
            "must be off the track",
        ),
        (
            "a key lock",
            object("Fstr_Abhaengigkeit", &value("ID_Fstr_Fahrweg", &path)),
            &[],
            "may be a condition that no layout holds",
        ),
        (
            "a level crossing",
            String::new(),
            &[("<Fstr_Zug>", "<Fstr_Zug><ID_BUE_Einschaltung/>")],
            "it has ID_BUE_Einschaltung",
        ),
        ("an auxiliary route", String::new(), &[("<Wert>ZR<", "<Wert>ZH<")], "it is of the kind ZH"),
        (
            "a point that is set by hand",
            String::new(),
            &[("elektrisch_ferngestellt", "elektrisch_ortsgestellt")],
            "is set elektrisch_ortsgestellt",
        ),
        (
            "a point that is kept",
            String::new(),
            &[(
                "<Weiche_Element/>",
                "<Weiche_Element><Weiche_Betriebsart><Wert>links</Wert></Weiche_Betriebsart></Weiche_Element>",
            )],
            "is kept links",
        ),
        (
            "an unreadable speed",
            String::new(),
            &[("<ID_Start>", "<Fstr_V_Hg><Wert>fast</Wert></Fstr_V_Hg><ID_Start>")],
            "its speed \"fast\" is no number of km/h above 0",
        ),
        (
            "a section that is not detected",
            String::new(),
            &undetected,
            "no section of track vacancy detection lies there",
        ),
    ];
    cases.extend(conditions());
    for (what, objects, words, why) in cases {
        let imported = with(&objects, words);
        let count = names(&imported).len();
        assert!(count < all, "{what}: {}", imported.report);
        assert!(imported.report.lacking.iter().any(|line| line.contains(why)), "{what}: {}", imported.report);
    }
}

#[test]
fn two_pairs_of_blades_on_one_lever_are_no_points() {
    let (one, other) = (id("point", 0), id("point", 1));
    let belongs = format!("<ID_W_Kr_Gsp_Element><Wert>{other}<");
    let imported = with("", &[(&belongs, &format!("<ID_W_Kr_Gsp_Element><Wert>{one}<"))]);
    assert!(imported.report.lacking.iter().any(|line| line.contains("has two pairs of blades")), "{}", imported.report);
    imported.description.tracks().unwrap_or_else(|errors| panic!("{errors}"));
    let points = |name: &str| !names(&imported).contains(&name);
    assert!(points("W/1E"), "{}", imported.report);
}

#[test]
fn the_lowest_of_all_limits_holds() {
    let speed = |imported: &Imported| {
        let routes = &imported.description.station.routes;
        routes
            .iter()
            .find(|route| route.name.value == "W/1E")
            .and_then(|route| route.speed_kmh.as_ref().map(|kmh| kmh.value))
    };
    let path = id("path", number_of("W/1E"));
    let whole = written(&small(), &Tool::PLAIN);
    let own = between(&whole, "<Fstr_Fahrweg>", "</Fstr_Fahrweg>")
        .into_iter()
        .find(|(_, one)| one.contains(&path))
        .unwrap()
        .1;
    let parts = between(own, "<Bereich_Objekt_Teilbereich>", "</Bereich_Objekt_Teilbereich>");
    let part: String = parts.into_iter().map(|(_, part)| part).collect();
    let profile = |kmh: &str| {
        object(
            "Geschwindigkeitsprofil",
            &format!(
                "{part}<Geschwindigkeitsprofil_Allg>{}</Geschwindigkeitsprofil_Allg>",
                value("Geschwindigkeit", kmh)
            ),
        )
    };
    assert_eq!(speed(&with("", &[])), None);
    assert_eq!(speed(&with(&profile("40"), &[])), Some(40));
    let number = number_of("W/1E");
    let zug = format!("<Identitaet><Wert>{}</Wert></Identitaet>", id("route", number));
    let text = written(&small(), &Tool::PLAIN);
    let begin = text.find(&zug).expect("the route is there");
    let slower = format!(
        "{}{}",
        &text[..begin],
        text[begin..].replacen("<Fstr_Reihenfolge>", "<Fstr_V><Wert>30</Wert></Fstr_V><Fstr_Reihenfolge>", 1)
    );
    assert_eq!(speed(&planpro("station.ppxml", &slower).unwrap()), Some(30));
    // A limit in another place says nothing of a reverse leg that has none.
    let short = between(own, "<Bereich_Objekt_Teilbereich>", "</Bereich_Objekt_Teilbereich>")[0].1;
    let edge = between(short, "<ID_TOP_Kante>", "</ID_TOP_Kante>")[0].1;
    let metre = format!(
        "<Bereich_Objekt_Teilbereich>{}{}{edge}</Bereich_Objekt_Teilbereich>",
        value("Begrenzung_A", "700.000"),
        value("Begrenzung_B", "701.000")
    );
    let far = object(
        "Geschwindigkeitsprofil",
        &format!(
            "{metre}<Geschwindigkeitsprofil_Allg>{}</Geschwindigkeitsprofil_Allg>",
            value("Geschwindigkeit", "60")
        ),
    );
    assert!(speed(&with(&far, &[])).is_none_or(|kmh| kmh == 15), "{:?}", speed(&with(&far, &[])));
    // Over a leg without a speed whose point names no main track, the lowest.
    let main = "<Zungenpaar><Stammgleis><Wert>links</Wert></Stammgleis></Zungenpaar>";
    assert_eq!(speed(&with("", &[(main, "<Zungenpaar/>")])), Some(15));
    let given = "<Zungenpaar><Geschwindigkeit_L><Wert>60</Wert></Geschwindigkeit_L><Geschwindigkeit_R><Wert>60</Wert></Geschwindigkeit_R></Zungenpaar>";
    assert_eq!(speed(&with("", &[(main, given)])), Some(60));
    let imported = with(&profile("no"), &[]);
    assert!(imported.report.lacking.iter().any(|line| line.contains("a speed of the Geschwindigkeitsprofil")));
    assert!(!names(&imported).contains(&"W/1E"));
}

#[test]
fn flank_protection_is_held_and_proved_clear() {
    let (asks, guards) = (id("point", number_of("PW1")), id("point", number_of("PW2")));
    let protection = |lage: &str| {
        format!(
            "<Fla_Schutz>{}<Fla_Schutz_Anforderer>{}{}</Fla_Schutz_Anforderer><Fla_Schutz_Weitergabe>{}</Fla_Schutz_Weitergabe></Fla_Schutz><Fla_Schutz>{}<Fla_Schutz_W_Gsp>{}{}</Fla_Schutz_W_Gsp></Fla_Schutz>{}",
            value("Identitaet", "00000000-0000-4000-8000-00000000000A"),
            value("Fahrt_Ueber", "rechts"),
            value("ID_Anforderer_Element", &asks),
            value("ID_Fla_Weitergabe_L", "00000000-0000-4000-8000-00000000000B"),
            value("Identitaet", "00000000-0000-4000-8000-00000000000B"),
            value("Fla_W_Lage", lage),
            value("ID_Fla_W_Gsp_Element", &guards),
            object(
                "Fla_Freimelde_Zuordnung",
                &[
                    value("Fla_Raum_Freimeldung", "true"),
                    value("ID_Fla_Schutz", "00000000-0000-4000-8000-00000000000B"),
                    value(
                        "ID_FMA_Anlage",
                        &id(
                            "section",
                            model(&small()).circuits.iter().position(|circuit| circuit.name == "LW2").unwrap_or(0)
                        )
                    ),
                ]
                .concat(),
            )
        )
    };
    let imported = with(&protection("rechts"), &[]);
    let model = imported.description.tracks().unwrap();
    let point = |name: &str| model.points.iter().position(|point| point.name == name).unwrap();
    let clear = model.circuits.iter().position(|circuit| circuit.name == "LW2").unwrap();
    let mut held = 0;
    for route in &model.routes {
        let over = || route.path.iter().flat_map(|place| &place.passed);
        let asks = over().any(|passed| (passed.point, passed.position) == (point("PW1"), Position::Reverse));
        if asks {
            assert!(over().all(|passed| passed.point != point("PW2")));
            assert!(route.positions().any(|held| held == (point("PW2"), Position::Reverse)), "{}", imported.report);
            assert!(route.beside().contains(&clear), "{}", imported.report);
            held += 1;
        }
    }
    assert!(held >= 2, "{}", imported.report);
    // What is no point of the layout cannot be held.
    let unknown = with(&protection("rechts").replace(&guards, "00000000-0000-4000-8000-00000000000C"), &[]);
    assert!(names(&unknown).len() < model.routes.len(), "{}", unknown.report);
    assert!(
        unknown.report.lacking.iter().any(|line| line.contains("what is no point of the layout")),
        "{}",
        unknown.report
    );
}

#[test]
fn a_point_that_is_locked_with_an_overlap_is_held() {
    let overlap = number_of("W/1E");
    let locked = |element: &str| {
        object(
            "Fstr_DWeg_W_Kr",
            &[
                value("Element_Verschluss", "true"),
                value("ID_Fstr_DWeg", &id("overlap", overlap)),
                value("ID_W_Kr_Gsp_Element", element),
            ]
            .concat(),
        )
    };
    let imported = with(&locked(&id("point", number_of("PW2"))), &[]);
    let read = imported.description.tracks().unwrap();
    let point = read.points.iter().position(|point| point.name == "PW2").unwrap();
    let route = read.routes.iter().find(|route| route.name == "W/1E").unwrap();
    assert_eq!(route.overlap_positions.get(&point), Some(&Position::Normal), "{}", imported.report);
    let told = |line: &String| line.contains("W/1E: point PW2 is held with its overlap");
    assert!(imported.report.defaulted.iter().any(told), "{}", imported.report);
    assert!(!names(&with(&locked("none"), &[])).contains(&"W/1E"));
}

#[test]
fn what_fouls_a_point_is_proved_clear_with_it() {
    let platform = model(&small()).circuits.iter().position(|circuit| circuit.name == "2T0").unwrap();
    let fouling = |by: &str| {
        format!(
            "<Weiche_Element><GZ_Freimeldung_R>{}{}</GZ_Freimeldung_R></Weiche_Element>",
            value("Element_Lage", "Abschnitt"),
            value("ID_Element", by)
        )
    };
    let imported = with("", &[("<Weiche_Element/>", &fouling(&id("track", platform)))]);
    let read = imported.description.tracks().unwrap();
    let there = read.circuits.iter().position(|circuit| circuit.name == "2T0").unwrap();
    let point = read.points.iter().find(|point| point.name == "PW1").unwrap();
    assert!(point.fouled_in.contains(&there), "{}", imported.report);
    let route = read.routes.iter().find(|route| route.name == "W/1E").unwrap();
    assert!(route.beside().contains(&there), "{}", imported.report);
    let unknown = with("", &[("<Weiche_Element/>", &fouling("none"))]);
    assert!(!names(&unknown).contains(&"W/1E"));
    assert!(
        unknown.report.lacking.iter().any(|line| line.contains("names what is no circuit or point")),
        "{}",
        unknown.report
    );
}

#[test]
fn a_file_tells_its_form_and_an_archive_is_refused() {
    let folder = std::env::temp_dir().join(format!("planpro-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let text = written(&small(), &Tool::PLAIN);
    for name in ["content.xml", "station.ppxml"] {
        std::fs::write(folder.join(name), &text).unwrap();
        let imported = atc_layout::import::read_any(folder.join(name)).unwrap_or_else(|errors| panic!("{errors}"));
        assert_eq!(names(&imported), names(&with("", &[])));
    }
    std::fs::write(folder.join("station.planpro"), b"PK\x03\x04").unwrap();
    let told = atc_layout::import::read_any(folder.join("station.planpro")).unwrap_err().to_string();
    assert!(told.contains("zip archive") && told.contains("unpack it"), "{told}");
    std::fs::remove_dir_all(&folder).unwrap();
    let told = |text: &str| planpro("station.ppxml", text).unwrap_err().to_string();
    let again = text.replacen("<Fstr_Zug_Art>", "<Fstr_Zug_Art><Wert>ZH</Wert></Fstr_Zug_Art><Fstr_Zug_Art>", 1);
    assert!(told(&again).contains("there are two Fstr_Zug_Art where one may be"));
    let divided = text.replacen("<Wert>elektrisch_", "<Wert><!-- by whom -->elektrisch_", 1);
    assert!(told(&divided).contains("a value is in several parts"));
    assert!(told("<railML/>").contains("not PlanPro_Schnittstelle"));
    assert!(told("<PlanPro_Schnittstelle/>").contains("neither an LST_Zustand_Ziel"));
    assert!(told("<PlanPro_Schnittstelle>").contains("no XML"));
    let twice = text.replace(&id("joint", 1), &id("joint", 2));
    assert!(told(&twice).contains("two objects have the identity"), "{twice}");
}

#[test]
fn tracks_that_cross_are_one_circuit() {
    let read = atc_layout::import::read_any(concat!(env!("CARGO_MANIFEST_DIR"), "/tests/files/diamond.toml")).unwrap();
    let station = read.description.station;
    let text = written(&station, &Tool::PLAIN);
    assert!(text.contains("<Kreuzung>"));
    let imported = planpro("diamond.ppxml", &text).unwrap();
    assert_eq!(found(&imported).unwrap(), expected(&model(&station)), "{}", imported.report);
    // Without the crossing its circuit is in two parts, and what runs over it is left out.
    let apart: String = text.split_inclusive('\n').filter(|line| !line.contains("<Kreuzung>")).collect();
    let imported = planpro("diamond.ppxml", &apart).unwrap();
    assert!(imported.report.lacking.iter().any(|line| line.contains("in 2 parts")), "{}", imported.report);
    assert!(found(&imported).unwrap().is_empty(), "{}", imported.report);
}

#[test]
fn no_file_makes_the_import_stop() {
    let words =
        prop::sample::select(vec!["", "-1", "0.000", "1e9", "NaN", "99999.999", "in", "Spitze", "<x/>", "none"]);
    let edits = prop::collection::vec((any::<Index>(), words), 1..8);
    let text = written(&small(), &Tool::PLAIN);
    let values: Vec<(usize, usize)> = text
        .match_indices("<Wert>")
        .map(|(at, word)| at + word.len())
        .filter_map(|from| Some((from, from + text[from..].find("</Wert>")?)))
        .collect();
    let cases = (edits, any::<Option<(Index, Index)>>());
    let result = runner(24).run(&cases, |(edits, exchange)| {
        let mut places: Vec<((usize, usize), String)> =
            edits.into_iter().map(|(index, word)| (values[index.index(values.len())], word.to_owned())).collect();
        if let Some((one, other)) = exchange {
            let (from, to) = values[other.index(values.len())];
            places.push((values[one.index(values.len())], text[from..to].to_owned()));
        }
        places.sort();
        places.dedup_by_key(|(place, _)| *place);
        let mut edited = text.clone();
        for ((from, to), word) in places.into_iter().rev() {
            edited.replace_range(from..to, &word);
        }
        if let Ok(imported) = planpro("station.ppxml", &edited) {
            let _ = imported.description.tracks();
            let _ = imported.description.check();
        }
        Ok(())
    });
    result.unwrap_or_else(|error| panic!("{error}"));
}
