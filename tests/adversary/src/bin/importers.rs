//! Imports railML and PlanPro files of many kinds, and tells each route that comes of them in one line: what `layout/mutants.toml` must not change.
//!
//! A route of a wrong importer that the right one does not print is a wrong route. One that it lacks is a route that was left out: what it
//! holds and excludes need not be there then. Positions may be held that the right importer does not: flank protection looks farther
//! where a signal is left out. A circuit may be shorter: trains stop earlier then.

#[path = "../../../../layout/tests/support/mod.rs"]
mod support;

use std::process::ExitCode;

use atc_layout::At;
use atc_layout::import::{Imported, planpro, railml};
use atc_layout::model::{Model, Route};
use support::planpro::{Tool, id};
use support::railml::{Dialect, Version, written};
use support::random::{Shape, station};

/// Files that are there.
const FILES: [(&str, &str); 9] = [
    ("passing-loop", include_str!("../../../../layouts/passing-loop.railml.xml")),
    ("junction", include_str!("../../../../layouts/junction.railml.xml")),
    ("terminus", include_str!("../../../../layouts/terminus.railml.xml")),
    ("station-30", include_str!("../../../../layouts/station-30.railml.xml")),
    ("chainage", include_str!("../../../../layout/tests/files/chainage.railml.xml")),
    ("head-on", include_str!("../../../../layout/tests/files/head-on.railml")),
    ("short2", include_str!("../../../../layout/tests/files/short2.railml")),
    ("dupbuf", include_str!("../../../../layout/tests/files/dupbuf.railml")),
    ("slip", include_str!("../../../../layout/tests/files/slip.railml")),
];

/// A file with changes: its name, the file, and what stands for what.
type Changed = (&'static str, &'static str, &'static [(&'static str, &'static str)]);

/// Changes that give a file what it has not.
const CHANGED: [Changed; 17] = [
    // Files that are wrong: the right importer leaves a route out.
    (
        "a section too many",
        "head-on",
        &[("<hasTvdSection ref=\"tvd9\"/>", "<hasTvdSection ref=\"tvd9\"/><hasTvdSection ref=\"tvd4\"/>")],
    ),
    ("a section too few", "head-on", &[("<hasTvdSection ref=\"tvd9\"/>", "")]),
    ("against a position", "head-on", &[("inPosition=\"left\"", "inPosition=\"right\"")]),
    ("a signal turned", "head-on", &[("applicationDirection=\"reverse\"", "applicationDirection=\"normal\"")]),
    (
        "not right",
        "head-on",
        &[
            ("<routeEntry id=\"rt0e\">", "<additionalRelation ref=\"rr\"/><routeEntry id=\"rt0e\">"),
            (
                "<conflictingRoutes>",
                "<routeRelations><routeRelation id=\"rr\"><requiredSwitchPosition inPosition=\"right\" isNegated=\"true\"><refersToSwitch ref=\"swil1\"/></requiredSwitchPosition></routeRelation></routeRelations><conflictingRoutes>",
            ),
        ],
    ),
    (
        "a buffer stop on the way",
        "head-on",
        &[(
            "</bufferStops>",
            "<bufferStop id=\"bs1\"><spotLocation netElementRef=\"ne1\" pos=\"100\"/></bufferStop></bufferStops>",
        )],
    ),
    (
        "another switch",
        "head-on",
        &[("<refersTo ref=\"sw0\"/>", "<refersTo ref=\"sw0\"/><relatedMovableElement ref=\"swil1\"/>")],
    ),
    (
        "shunting",
        "head-on",
        &[("<routeEntry id=\"rt0e\">", "<handlesRouteType ref=\"rt_shunting\"/><routeEntry id=\"rt0e\">")],
    ),
    ("late", "head-on", &[("<route id=\"rt0\"", "<route proceedAspectDelay=\"PT40S\" id=\"rt0\"")]),
    // And some that are right.
    (
        "a limit beyond its element",
        "head-on",
        &[(
            "<bufferStops>",
            "<speeds><speedSection id=\"v1\" maxSpeed=\"30\"><linearLocation><associatedNetElement netElementRef=\"ne1\" posBegin=\"260\" posEnd=\"1900\"/></linearLocation></speedSection></speeds><bufferStops>",
        )],
    ),
    (
        "a limit at a place",
        "head-on",
        &[(
            "<bufferStops>",
            "<speeds><speedSection id=\"v1\" maxSpeed=\"30\"><linearLocation><associatedNetElement netElementRef=\"ne1\" intrinsicCoordBegin=\"1\"/></linearLocation></speedSection></speeds><bufferStops>",
        )],
    ),
    (
        "fouled",
        "head-on",
        &[("<refersTo ref=\"sw0\"/>", "<refersTo ref=\"sw0\"/><hasFoulingTrainDetectors ref=\"tde3\"/>")],
    ),
    (
        "railML 3.2's release time",
        "head-on",
        &[("<tvdSection id=\"tvd2\"", "<tvdSection residualRouteReleaseDelay=\"PT90S\" id=\"tvd2\"")],
    ),
    (
        "a short stub",
        "terminus",
        &[("netElementRef=\"ne8\" intrinsicCoord=\"1\"", "netElementRef=\"ne8\" intrinsicCoord=\"0.6\"")],
    ),
    ("single-slip", "slip", &[("<turningBranch netRelationRef=\"nbd\"/>", "")]),
    (
        "limits",
        "head-on",
        &[
            ("<leftBranch netRelationRef=\"nr0n\"/>", "<leftBranch netRelationRef=\"nr0n\" branchingSpeed=\"60\"/>"),
            (
                "<rightBranch netRelationRef=\"nr0r\"/>",
                "<rightBranch netRelationRef=\"nr0r\" branchingSpeed=\"40\" joiningSpeed=\"60\"/>",
            ),
            ("<rightBranch netRelationRef=\"nr1r\"/>", "<rightBranch netRelationRef=\"nr1r\" branchingSpeed=\"60\"/>"),
            (
                "<bufferStops>",
                "<speeds><speedSection id=\"v1\" maxSpeed=\"30\"><linearLocation id=\"v1l\"><associatedNetElement netElementRef=\"ne1\" intrinsicCoordBegin=\"0.1\" intrinsicCoordEnd=\"0.4\"/></linearLocation></speedSection></speeds><bufferStops>",
            ),
            (
                "<tvdSection id=\"tvd2\"",
                "<tvdSection residualRouteCancellationDelay=\"PT90S\" partialRouteReleaseDelay=\"PT4S\" id=\"tvd2\"",
            ),
            ("<routeEntry id=\"rt0e\">", "<additionalRelation ref=\"rr\"/><routeEntry id=\"rt0e\">"),
            (
                "<conflictingRoutes>",
                "<routeRelations><routeRelation id=\"rr\"><requiredSwitchPosition inPosition=\"left\"><refersToSwitch ref=\"swil1\"/></requiredSwitchPosition></routeRelation></routeRelations><conflictingRoutes><conflictingRoute id=\"c\"><refersToRoute ref=\"rt4\"/><conflictsWithRoute ref=\"rt6\"/></conflictingRoute>",
            ),
        ],
    ),
    ("long-overlap", "chainage", &[("timerValue=\"PT40S\"", "timerValue=\"PT100S\"")]),
];

/// The ways of tools: turned net elements, offsets of signals, metres, exits at signals.
const DIALECTS: [Dialect; 4] = [
    Dialect { turned: 2, offset: -30.0, to_signals: true, ..Dialect::PLAIN },
    Dialect { metres: true, offset: 5.0, wrapped: true, ..Dialect::PLAIN },
    Dialect { turned: 1, metres: true, rear: true, backwards: true, ..Dialect::PLAIN },
    Dialect { turned: 3, nameless: true, to_signals: true, ..Dialect::PLAIN },
];

/// Arguments: the forms that are imported, `railml` or `planpro`; all without any.
fn main() -> ExitCode {
    let forms: Vec<String> = std::env::args().skip(1).collect();
    let wanted = |form: &str| forms.is_empty() || forms.iter().any(|one| one == form);
    if wanted("planpro") {
        of_planpro();
    }
    if wanted("railml") { of_railml() } else { ExitCode::SUCCESS }
}

fn of_railml() -> ExitCode {
    for (name, text) in FILES {
        tell(name, text);
    }
    for (name, of, changes) in CHANGED {
        let Some((_, text)) = FILES.iter().find(|(name, _)| *name == of) else { return ExitCode::from(2) };
        let mut text = (*text).to_owned();
        for (from, to) in changes {
            if !text.contains(from) {
                eprintln!("{name}: {from} is not in {of}");
                return ExitCode::from(2);
            }
            text = text.replacen(from, to, 1);
        }
        tell(name, &text);
    }
    for (number, dialect) in DIALECTS.iter().enumerate() {
        for (tracks, bay, splits) in [(2, false, vec![2, 1]), (3, true, vec![1, 3]), (6, false, vec![3, 2, 1])] {
            let shape = Shape { tracks, bay, lengths: vec![75, 220, 410, 130], splits };
            let mut made = station(&shape);
            // Longer than any that is derived: that follows from the slowest route, which may be left out.
            made.times.stay_ms = Some(At::derived(200_000));
            tell(&format!("dialect {number} of {tracks} tracks"), &written(&made, Version::V31, dialect));
        }
    }
    ExitCode::SUCCESS
}

/// The ways of PlanPro's tools: turned edges, main tracks on the right, signals in rear of their border, parts in the other order.
const TOOLS: [Tool; 3] = [
    Tool::PLAIN,
    Tool { turned: 2, mirrored: 2, offset: 5.0, ..Tool::PLAIN },
    Tool { turned: 1, mirrored: 1, offset: 12.0, backwards: true, nameless: true, planned: false },
];

/// Stations as PlanPro, as they are and with what asks for more.
fn of_planpro() {
    let shape = |tracks, bay| Shape { tracks, bay, lengths: vec![75, 220, 410, 130], splits: vec![2, 1] };
    for (number, tool) in TOOLS.iter().enumerate() {
        for (tracks, bay) in [(3, true), (5, false)] {
            let mut made = station(&shape(tracks, bay));
            made.times.stay_ms = Some(At::derived(150_000));
            tell_of(
                &format!("tool {number} of {tracks} tracks"),
                planpro("", &support::planpro::written(&made, tool)).ok(),
            );
        }
    }
    if let Ok(diamond) =
        atc_layout::Description::from_toml("diamond", include_str!("../../../../layout/tests/files/diamond.toml"))
    {
        tell_of("planpro diamond", planpro("", &support::planpro::written(&diamond.station, &Tool::PLAIN)).ok());
    }
    let mut made = station(&shape(3, true));
    made.times.stay_ms = Some(At::derived(150_000));
    let plain = support::planpro::written(&made, &Tool::PLAIN);
    let end = "</Container></LST_Zustand_Ziel>";
    for (name, objects, words) in asking() {
        let more = plain.replacen(end, &format!("{objects}{end}"), 1);
        let text = words.iter().fold(more, |text, (old, new)| text.replacen(old, new, 1));
        tell_of(&format!("planpro {name}"), planpro("", &text).ok());
    }
}

/// A change of a station: its name, objects that are added, and words that stand for others.
type Asking = (&'static str, String, Vec<(String, String)>);

/// Stations that ask for more.
fn asking() -> Vec<Asking> {
    let value = |name: &str, text: &str| format!("<{name}><Wert>{text}</Wert></{name}>");
    let number = |last: &str| value("Identitaet", &format!("00000000-0000-4000-8000-0000000000{last}"));
    let guard = |id_of: &str, side: &str| {
        format!(
            "<Fla_Schutz_W_Gsp>{}{}</Fla_Schutz_W_Gsp>",
            value("Fla_W_Lage", side),
            value("ID_Fla_W_Gsp_Element", id_of)
        )
    };
    let place = |edge: usize, at: &str| {
        format!(
            "<Punkt_Objekt_TOP_Kante>{}{}</Punkt_Objekt_TOP_Kante>",
            value("Abstand", at),
            value("ID_TOP_Kante", &id("edge", edge))
        )
    };
    let part = |edge: usize, to: &str| {
        format!(
            "<Bereich_Objekt_Teilbereich>{}{}{}</Bereich_Objekt_Teilbereich>",
            value("Begrenzung_A", "0.000"),
            value("Begrenzung_B", to),
            value("ID_TOP_Kante", &id("edge", edge))
        )
    };
    let flank = [
        "<Fla_Schutz>".to_owned(),
        number("0A"),
        format!(
            "<Fla_Schutz_Anforderer>{}{}</Fla_Schutz_Anforderer>{}</Fla_Schutz>",
            value("Fahrt_Ueber", "rechts"),
            value("ID_Anforderer_Element", &id("point", 0)),
            guard(&id("point", 1), "rechts")
        ),
        format!(
            "<Fla_Freimelde_Zuordnung>{}{}{}{}</Fla_Freimelde_Zuordnung>",
            number("0B"),
            value("Fla_Raum_Freimeldung", "true"),
            value("ID_Fla_Schutz", "00000000-0000-4000-8000-00000000000A"),
            value("ID_FMA_Anlage", &id("section", 3))
        ),
    ];
    let derailers = (0..4).map(|edge| {
        format!(
            "<W_Kr_Gsp_Komponente>{}{}<Entgleisungsschuh/></W_Kr_Gsp_Komponente>",
            number(&format!("1{edge}")),
            place(edge, "100.000")
        )
    });
    let profile = format!(
        "<Geschwindigkeitsprofil>{}{}<Geschwindigkeitsprofil_Allg>{}</Geschwindigkeitsprofil_Allg></Geschwindigkeitsprofil>",
        number("20"),
        (0..4).map(|edge| part(edge, "5.000")).collect::<String>(),
        value("Geschwindigkeit", "15")
    );
    let main = "<Zungenpaar><Stammgleis><Wert>links</Wert></Stammgleis></Zungenpaar>".to_owned();
    let blades = format!(
        "<Zungenpaar>{}{}{}</Zungenpaar>",
        value("Geschwindigkeit_L", "60"),
        value("Geschwindigkeit_R", "25"),
        value("Stammgleis", "links")
    );
    let lock = |path: usize| {
        format!(
            "<Fstr_Abhaengigkeit>{}{}</Fstr_Abhaengigkeit>",
            number("30"),
            value("ID_Fstr_Fahrweg", &id("path", path))
        )
    };
    let excluded = (
        format!("<ID_Fstr_Fahrweg><Wert>{}<", id("path", 1)),
        value("ID_Fstr_Ausschluss_Besonders", &id("route", 9)) + &format!("<ID_Fstr_Fahrweg><Wert>{}<", id("path", 1)),
    );
    let fouling = format!(
        "<Weiche_Element><GZ_Freimeldung_R>{}</GZ_Freimeldung_R></Weiche_Element>",
        value("ID_Element", &id("track", 5))
    );
    let belongs = |point: usize| format!("<ID_W_Kr_Gsp_Element><Wert>{}<", id("point", point));
    let path = |number: usize| format!("<Fstr_Fahrweg>{}", value("Identitaet", &id("path", number)));
    let slower = (path(4), path(4) + &value("Fstr_V_Hg", "45"));
    vec![
        ("flank", flank.concat(), vec![]),
        ("derailers", derailers.collect(), vec![]),
        ("limits", profile, vec![]),
        ("blades", String::new(), vec![(main.clone(), blades), slower]),
        ("curved", String::new(), vec![(main, "<Zungenpaar/>".to_owned())]),
        ("a key lock", lock(0), vec![]),
        ("excluded", String::new(), vec![excluded]),
        ("one lever", String::new(), vec![(belongs(1), belongs(0))]),
        ("fouled", String::new(), vec![("<Weiche_Element/>".to_owned(), fouling)]),
        ("by hand", String::new(), vec![("elektrisch_ferngestellt".to_owned(), "elektrisch_ortsgestellt".to_owned())]),
        ("auxiliary", String::new(), vec![(">ZR<".to_owned(), ">ZH<".to_owned())]),
        (
            "a level crossing",
            String::new(),
            vec![("<Fstr_Zug>".to_owned(), "<Fstr_Zug><ID_BUE_Einschaltung/>".to_owned())],
        ),
        ("undetected", String::new(), vec![(format!("<Wert>{}<", id("track", 6)), "<Wert>none<".to_owned())]),
    ]
}

fn tell(name: &str, text: &str) {
    tell_of(name, railml(name, text).ok());
}

fn tell_of(name: &str, imported: Option<Imported>) {
    let Some(imported) = imported else { return };
    let Ok(model) = imported.description.tracks() else { return };
    let differing = imported.report.lacking.iter().filter(|line| line.contains("second reading")).count();
    println!("second\t{name}\t{differing} differences");
    for route in &model.routes {
        println!("route\t{name}\t{}\t{}", route.name, line(&model, route));
        for circuit in route.circuits().chain([route.entry]).chain(route.overlap.iter().copied()) {
            let circuit = &model.circuits[circuit];
            println!("length\t{name}\t{}\t{}", circuit.name, circuit.length.0);
        }
        for (point, position) in route.positions() {
            println!("holds\t{name}\t{}\t{} {position:?}", route.name, model.points[point].name);
        }
        for other in &route.conflicts {
            println!("excludes\t{name}\t{}\t{}", route.name, model.routes[*other].name);
        }
    }
}

/// What the file says of a route.
fn line(model: &Model, route: &Route) -> String {
    let circuit = |number: usize| model.circuits[number].name.clone();
    let joint = |number: usize| model.graph.joints[number].name.as_str();
    let path: Vec<String> = route.circuits().map(circuit).collect();
    let passed = route.path.iter().flat_map(|place| &place.passed);
    let over = passed.map(|passed| {
        let point = &model.points[passed.point];
        format!("{} {:?} within {} ms", point.name, passed.position, point.throw_ms)
    });
    let overlap: Vec<String> = route.overlap.iter().map(|number| circuit(*number)).collect();
    // Where nothing is held beyond the end, nothing is given up.
    let stay = if overlap.is_empty() { 0 } else { route.stay.0 };
    format!(
        "at {} from {} by {} over {} to {}, {}; overlap {}; {} km/h; release {}, stay {}",
        route.signal,
        circuit(route.entry),
        joint(route.start),
        path.join(", "),
        joint(route.exit),
        over.collect::<Vec<_>>().join(", "),
        overlap.join(", "),
        model.values.speeds_kmh[usize::from(route.speed.0)],
        route.release.0,
        stay,
    )
}
