//! What the file asks of a route that no layout holds: then the route is no route of a layout.

use std::collections::BTreeSet;

use roxmltree::Node;

use super::Meant;
use super::plan::{Plan, identity, parts, text};
use super::run::Run;

/// Objects that name a route or its path and ask nothing of it.
const NO_CONDITION: &str = " Anhang Bearbeitungsvermerk Fstr_Aneinander_Zuordnung Fstr_DWeg Fstr_DWeg_W_Kr Fstr_Fahrweg Fstr_Nichthaltfall \
    Fstr_Rangier_Fla_Zuordnung Fstr_Signalisierung Fstr_Umfahrpunkt Fstr_Zug_Rangier ";

/// What this reading knows in a route, its path and its overlap; anything else may be a condition.
const KNOWN: [(&str, &str); 6] = [
    (
        "overlap",
        " Bezeichnung Fstr_DWeg_Allg Fstr_DWeg_Spezifisch ID_FMA_Anlage_Freimeldung ID_Fstr_Fahrweg ID_PZB_Gefahrpunkt ",
    ),
    (
        "overlap/Fstr_DWeg_Spezifisch",
        " Aufloesung_Verzoegerung DWeg_Reihenfolge DWeg_V DWeg_V_Aufwertung_Verzicht ID_FMA_Anlage_Zielgleis ",
    ),
    ("", " Fstr_Zug_Rangier_Allg ID_Fstr_Ausschluss_Besonders ID_Fstr_Fahrweg Fstr_Zug "),
    ("Fstr_Zug", " Automatische_Einstellung Fstr_Vsigabstand_Verkuerzt Fstr_Zug_Art Fstr_Zug_DWeg "),
    ("Fstr_Zug_Rangier_Allg", " F_Bedienung Fstr_Bedienstring Fstr_Reihenfolge Fstr_V "),
    ("path", " Bereich_Objekt_Teilbereich Fstr_V_Hg ID_Start ID_Ziel Start_Signal_Charakter "),
];

/// What every object may have.
const OF_ALL: &str = " Identitaet Basis_Objekt_Allg ID_Bearbeitungsvermerk ID_Oertlichkeit_Ausgabe Objektreferenzen ";

/// The first thing that is asked and cannot be held.
pub(super) fn more<'a>(plan: &Plan<'a>, meant: &Meant<'a>, run: &Run, (begin, end): (f64, f64)) -> Option<String> {
    for (of, known) in KNOWN {
        let node = match of {
            "path" => Some(meant.course),
            "overlap" => meant.overlap,
            "overlap/Fstr_DWeg_Spezifisch" => {
                meant.overlap.and_then(|node| node.children().find(|child| child.has_tag_name("Fstr_DWeg_Spezifisch")))
            }
            _ if meant.node == meant.course => None,
            "" => Some(meant.node),
            _ => meant.node.children().find(|child| child.has_tag_name(of)),
        };
        let inside = node.into_iter().flat_map(|node| node.children().filter(Node::is_element));
        let is_new = |name: &&str| !known.contains(&format!(" {name} ")) && !OF_ALL.contains(&format!(" {name} "));
        if let Some(name) = inside.map(|child| child.tag_name().name()).find(is_new) {
            return Some(format!("the file has {name} of it, which may be a condition"));
        }
    }
    let kind = text(meant.node, "Fstr_Zug/Fstr_Zug_Art").filter(|kind| !["ZR", "ZU"].contains(kind));
    if let Some(kind) = kind {
        return Some(format!("in the file it is of the kind {kind}"));
    }
    let overlap = meant.overlap.and_then(|node| plan.at(node, "ID_Fstr_Fahrweg"));
    let all = [Some(meant.node), Some(meant.course), meant.overlap, overlap];
    let own: BTreeSet<String> = all.into_iter().flatten().filter_map(identity).collect();
    for object in plan.all() {
        let kind = object.tag_name().name();
        if NO_CONDITION.contains(&format!(" {kind} ")) || kind.starts_with("ZL") || kind.starts_with("Bedien_") {
            continue;
        }
        let mut names = object.descendants().filter(|node| node.tag_name().name().starts_with("ID_"));
        if names.any(|node| text(node, "").is_some_and(|id| own.contains(&id.to_lowercase()))) {
            return Some(format!("the file has a {kind} about it, which may be a condition"));
        }
    }
    for signal in ["ID_Start", "ID_Ziel"].into_iter().filter_map(|name| plan.at(meant.course, name)) {
        let excludes = signal.children().any(|child| child.has_tag_name("Signal_Fstr_Aus_Inselgleis"));
        let through = text(signal, "Signal_Fstr/Durchfahrt").is_some_and(|through| through != "erlaubt");
        if excludes || through {
            return Some(format!("in the file {} may not be passed beside other trains", plan.call(signal)));
        }
    }
    for node in plan.all().filter(|node| node.tag_name().name().starts_with("BUE_")) {
        if run.meets(node, begin, end) || run.touches(&parts(node), begin, end) {
            return Some("in the file a level crossing lies on its way".to_owned());
        }
    }
    if plan.movable().any(|part| run.meets(part, begin, end)) {
        return Some("in the file something stands on its way that must be moved off".to_owned());
    }
    let points = run.legs(plan).into_iter().filter(|(.., at)| (begin..end).contains(at));
    points.filter_map(|(blades, ..)| blades).find_map(|blades| unset(plan, blades))
}

/// Why a point cannot be set from here, or not alone.
pub(super) fn unset<'a>(plan: &Plan<'a>, blades: Node<'a, 'a>) -> Option<String> {
    let Some(element) = plan.at(blades, "ID_W_Kr_Gsp_Element") else {
        return Some("in the file a point of it belongs to no element".to_owned());
    };
    let name = plan.call(element);
    let drive = text(element, "W_Kr_Gsp_Element_Allg/W_Kr_Gsp_Stellart");
    if let Some(drive) = drive.filter(|drive| !["elektrisch_ferngestellt", "mechanisch_ferngestellt"].contains(drive)) {
        return Some(format!("in the file {name} is {drive}"));
    }
    let form = plan.at(element, "ID_W_Kr_Anlage").and_then(|all| text(all, "W_Kr_Anlage_Allg/W_Kr_Art"));
    let plain = " EW ABW IBW ABW/IBW IBW/ABW Klothoidenweiche Korbbogenweiche ";
    let is_plain = form.is_none_or(|form| form == "Sym. ABW" || plain.contains(&format!(" {form} ")));
    if !is_plain || text(blades, "Zungenpaar/Kreuzungsgleis").is_some() {
        return Some(format!("in the file {name} is part of a slip or of a point with three legs"));
    }
    let fixed = text(element, "Weiche_Element/Weiche_Betriebsart").is_some_and(|how| how != "Betrieb");
    let chained = element.children().any(|child| child.has_tag_name("ID_Weichenlaufkette"));
    let others = plan.blades.values().filter(|other| plan.at(**other, "ID_W_Kr_Gsp_Element") == Some(element)).count();
    (fixed || chained || others > 1).then(|| format!("in the file {name} is kept, or moves with others"))
}
