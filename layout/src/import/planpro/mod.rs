//! PlanPro, the form in which German interlockings are planned (1.8 and later): topology, track vacancy detection, train routes.

mod borders;
mod circuits;
mod file;
mod points;
mod routes;
mod tracks;

use std::collections::BTreeSet;

use super::complete::{complete, steepest};
use super::report::{Imported, Report};
use super::xml;
use crate::description::Description;
use crate::form::Station;
use crate::problem::{Errors, Problem, Source};
use crate::rule::Rule;
use file::{File, figure};

/// The root element.
pub const ROOT: &str = "PlanPro_Schnittstelle";

/// Reads a PlanPro file.
pub fn import(source: &Source) -> Result<Imported, Errors> {
    let document = xml::parse(source)?;
    let root = document.root_element();
    if root.tag_name().name() != ROOT {
        return Err(xml::other_root(source, root, ROOT, "a PlanPro file is expected"));
    }
    let mut report = Report::default();
    let version = root.tag_name().namespace().and_then(|name| name.rsplit('/').next()).unwrap_or_default();
    let known = ["1.8.", "1.9.", "1.10."].iter().any(|begin| version.starts_with(begin));
    if known {
        report.taken.push(format!("PlanPro {version}"));
    } else {
        report.defaulted.push(format!("the version {version:?} is read as PlanPro 1.10"));
    }
    let file = File::of(&document).map_err(|problems| Errors::new(source, problems))?;
    let mut station = Station { name: title(&file, root), ..Station::default() };
    let mut problems = Vec::new();
    let tracks = tracks::read(&file, &station, &mut report, &mut problems);
    if tracks.edges.is_empty() && problems.is_empty() {
        problems.push(Problem::new(Rule::Form, &file::start(root), "the file has no TOP_Kante", "give the topology"));
    }
    if !problems.is_empty() {
        return Err(Errors::new(source, problems));
    }
    let placed = circuits::write(&file, tracks, &mut station, &mut report);
    // One that cannot be read may be any.
    let read = |node: roxmltree::Node<'_, '_>, path: &[&str]| {
        file::value(node, path).map(|_| figure(node, path).unwrap_or(f64::INFINITY))
    };
    let slopes = file.all("Hoehenpunkt").filter_map(|node| read(node, &["Hoehenpunkt_Allg", "Neigung"]));
    let overlaps = file.all("Fstr_DWeg").filter_map(|node| read(node, &["Fstr_DWeg_Allg", "Massgebende_Neigung"]));
    steepest(slopes.chain(overlaps), &mut station, &mut report)
        .map_err(|problem| Errors::new(source, vec![problem]))?;
    routes::write(&file, &placed, &mut station, &mut report);
    for name in ["times", "braking", "speed", "longest_train_m"] {
        report.defaulted.push(format!("[{name}]: the defaults of the layout form; the file says nothing of them"));
    }
    let (legs, stretches) = placed.tracks.limits.count();
    report.taken.push(format!("speeds of {legs} legs of points and {stretches} stretches of track"));
    unused(&file, &mut report);
    super::read_again(&source.text, &mut station, &mut report);
    complete(&mut station, "PlanPro", &mut report);
    super::line_speeds(&placed.tracks.limits, &placed.divided, &mut station, &mut report);
    super::read_again(&source.text, &mut station, &mut report);
    report.taken.push(format!("{} routes that a second reading of the file finds the same", station.routes.len()));
    Ok(Imported { description: Description { station, source: source.clone() }, report })
}

/// What the file is about: the operating point, or what the plan is called.
fn title(file: &File<'_>, root: roxmltree::Node<'_, '_>) -> String {
    let place = file.all("Oertlichkeit").find_map(|node| file::value(node, &["Bezeichnung", "Oertlichkeit_Langname"]));
    let plan = root
        .descendants()
        .filter(|node| node.has_tag_name("Planung_P_Allg"))
        .find_map(|node| file::value(node, &["Bezeichnung_Planung_Projekt"]));
    place.or(plan).unwrap_or("PlanPro").to_owned()
}

/// Objects that the import looks at.
const USED: [&str; 23] = [
    "FMA_Anlage",
    "FMA_Komponente",
    "Fla_Freimelde_Zuordnung",
    "Fla_Schutz",
    "Fstr_DWeg",
    "Fstr_DWeg_W_Kr",
    "Fstr_Fahrweg",
    "Fstr_Zug_Rangier",
    "Geschwindigkeitsprofil",
    "Gleis_Abschluss",
    "Gleis_Abschnitt",
    "Hoehenpunkt",
    "Markanter_Punkt",
    "Oertlichkeit",
    "Signal",
    "Strecke",
    "Strecke_Punkt",
    "Stellelement",
    "TOP_Kante",
    "TOP_Knoten",
    "W_Kr_Anlage",
    "W_Kr_Gsp_Element",
    "W_Kr_Gsp_Komponente",
];

/// Reports the objects that the import does not look at, each kind once with its count.
fn unused(file: &File<'_>, report: &mut Report) {
    let kinds: BTreeSet<&str> = file.objects().map(|node| node.tag_name().name()).collect();
    for kind in kinds.into_iter().filter(|kind| !USED.contains(kind)) {
        let count = file.objects().filter(|node| node.tag_name().name() == kind).count();
        report.skipped.push(format!("{kind}: {count} objects"));
    }
}
