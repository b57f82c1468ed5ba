//! What kinds of routes a file has: a layout has those for trains alone.

use std::collections::BTreeSet;

use roxmltree::Node;

use super::reader::Reader;
use crate::import::railml::xml::{Xml, references};

/// What the name or the id of a type of train routes has in it: the names are each infrastructure manager's own.
const TRAIN: [&str; 4] = ["main", "train", "zug", "principal"];

/// And of other types.
const OTHER: [&str; 9] = ["shunt", "rangier", "call", "auxil", "hilf", "emerg", "subst", "ersatz", "manoeuv"];

impl<'a> Reader<'a, '_> {
    /// That a route is one for trains.
    pub(super) fn for_trains(&self, node: Node<'a, 'a>) -> Result<(), String> {
        let own: Vec<&str> = references(node, "handlesRouteType").collect();
        let is_other = |id: &&str| has(self.xml, id, &OTHER);
        if own.is_empty() || own.iter().any(|id| !is_other(id) && has(self.xml, id, &TRAIN)) {
            return Ok(());
        }
        if own.iter().all(is_other) {
            return Err(format!("it is of the type {}, which is none of trains", own.join(" and ")));
        }
        match only_type(self.xml) {
            Some(_) => Ok(()),
            None => Err(format!(
                "it is of the type {}; the file does not say that this is one of trains",
                own.join(" and ")
            )),
        }
    }
}

/// The type of all routes of a file, if they are of one.
pub(super) fn only_type<'a>(xml: &Xml<'a>) -> Option<&'a str> {
    let types = |node: Node<'a, 'a>| -> Vec<&'a str> { references(node, "handlesRouteType").collect() };
    let all: BTreeSet<Vec<&str>> = xml.all("route").map(types).collect();
    match all.first().map(Vec::as_slice) {
        Some([only]) if all.len() == 1 => Some(only),
        _ => None,
    }
}

/// Whether the file says of the type that all of its routes are of that it is one of trains.
pub(super) fn is_told(xml: &Xml<'_>, id: &str) -> bool {
    has(xml, id, &TRAIN)
}

/// Whether a type's id or name has one of these words in it.
fn has(xml: &Xml<'_>, id: &str, words: &[&str]) -> bool {
    let name = xml.id(id).map(|node| xml.name(node).value).unwrap_or_default();
    let told = format!("{id} {name}").to_lowercase();
    words.iter().any(|word| told.contains(word))
}
