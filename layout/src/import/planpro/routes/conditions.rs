//! What the file may ask of a route that no layout holds: then the route is left out.

use std::collections::BTreeMap;

use roxmltree::Node;

use super::Reader;
use crate::import::planpro::file::{File, at, child, value};

/// Kinds of train routes that are taken: regular and alternative ones. A part of one goes on in another interlocking.
const KINDS: [&str; 2] = ["ZR", "ZU"];

/// What may stand in a route and what belongs to it; anything else may be a condition.
const OF_OBJECT: &str = "Identitaet Basis_Objekt_Allg ID_Bearbeitungsvermerk ID_Oertlichkeit_Ausgabe Objektreferenzen";

const OF_ROUTE: &str = "Fstr_Zug_Rangier_Allg ID_Fstr_Ausschluss_Besonders ID_Fstr_Fahrweg Fstr_Zug";
const OF_TRAIN: &str = "Automatische_Einstellung Fstr_Vsigabstand_Verkuerzt Fstr_Zug_Art Fstr_Zug_DWeg";
const OF_ALL: &str = "F_Bedienung Fstr_Bedienstring Fstr_Reihenfolge Fstr_V";
pub(super) const OF_OVERLAP: &str =
    "Bezeichnung Fstr_DWeg_Allg Fstr_DWeg_Spezifisch ID_FMA_Anlage_Freimeldung ID_Fstr_Fahrweg ID_PZB_Gefahrpunkt";
pub(super) const OF_SPECIAL: &str =
    "Aufloesung_Verzoegerung DWeg_Reihenfolge DWeg_V DWeg_V_Aufwertung_Verzicht ID_FMA_Anlage_Zielgleis";
const OF_SIGNAL: &str =
    "Besetzte_Ausfahrt DA_Manuell Durchfahrt ID_RaZiel_Erlaubnisabhaengig Rangierstrasse_Restaufloesung";
const OF_COURSE: &str = "Bereich_Objekt_Teilbereich Fstr_V_Hg ID_Start ID_Ziel Start_Signal_Charakter";
/// Objects that refer to a route without being a condition of it.
const HARMLESS: [&str; 11] = [
    "Anhang",
    "Bearbeitungsvermerk",
    "Fstr_Aneinander_Zuordnung",
    "Fstr_DWeg",
    "Fstr_DWeg_W_Kr",
    "Fstr_Fahrweg",
    "Fstr_Nichthaltfall",
    "Fstr_Rangier_Fla_Zuordnung",
    "Fstr_Signalisierung",
    "Fstr_Umfahrpunkt",
    "Fstr_Zug_Rangier",
];

/// What refers to each object, but for what is harmless.
pub(super) fn referring<'a>(file: &File<'a>) -> BTreeMap<String, Vec<Node<'a, 'a>>> {
    let mut found: BTreeMap<String, Vec<Node<'a, 'a>>> = BTreeMap::new();
    let is_harmless = |kind: &str| HARMLESS.contains(&kind) || kind.starts_with("ZL") || kind.starts_with("Bedien_");
    for object in file.objects().filter(|node| !is_harmless(node.tag_name().name())) {
        for reference in object.descendants().filter(|node| node.tag_name().name().starts_with("ID_")) {
            if let Some(id) = value(reference, &[]) {
                found.entry(id.to_lowercase()).or_default().push(object);
            }
        }
    }
    found
}

/// That an object has no more than what is known of its kind.
pub fn known(node: Node<'_, '_>, known: &str) -> Result<(), String> {
    let all = || known.split(' ').chain(OF_OBJECT.split(' '));
    let mut names = node.children().filter(Node::is_element).map(|child| child.tag_name().name());
    match names.find(|name| !all().any(|one| one == *name)) {
        Some(name) => Err(format!("it has {name}, which no layout holds")),
        None => Ok(()),
    }
}

/// That a signal may be passed by a train whatever other trains do.
pub(super) fn passing(signal: Node<'_, '_>) -> Result<(), String> {
    if child(signal, "Signal_Fstr_Aus_Inselgleis").is_some() {
        return Err(format!("the {} excludes other trains, which no layout holds", at(signal)));
    }
    let Some(more) = child(signal, "Signal_Fstr") else { return Ok(()) };
    known(more, OF_SIGNAL).map_err(|why| format!("the {}: {why}", at(signal)))?;
    match value(more, &["Durchfahrt"]).filter(|through| *through != "erlaubt") {
        Some(through) => Err(format!("running through at the {} is {through}, which no layout holds", at(signal))),
        None => Ok(()),
    }
}

impl<'a> Reader<'a, '_> {
    /// That the file asks nothing of a route that no layout holds.
    pub(super) fn conditions(&self, node: Node<'a, 'a>, course: Node<'a, 'a>) -> Result<(), String> {
        let train = child(node, "Fstr_Zug");
        known(course, OF_COURSE)?;
        if node != course {
            known(node, OF_ROUTE)?;
        }
        train.map_or(Ok(()), |train| known(train, OF_TRAIN))?;
        child(node, "Fstr_Zug_Rangier_Allg").map_or(Ok(()), |all| known(all, OF_ALL))?;
        let kind = train.and_then(|train| value(train, &["Fstr_Zug_Art"]));
        if let Some(kind) = kind.filter(|kind| !KINDS.contains(kind)) {
            return Err(format!("it is of the kind {kind}; only {} are taken", KINDS.join(", ")));
        }
        self.unreferred(node)?;
        self.unreferred(course)
    }

    /// That no other object is about this one that may ask for something.
    pub(super) fn unreferred(&self, node: Node<'a, 'a>) -> Result<(), String> {
        let id = value(node, &["Identitaet"]).unwrap_or_default().to_lowercase();
        match self.referring.get(&id).and_then(|all| all.first()) {
            Some(other) => Err(format!("the {} is about it, and may be a condition that no layout holds", at(*other))),
            None => Ok(()),
        }
    }
}
