//! What kinds of routes a file has: a layout has those for trains alone.

use std::collections::BTreeSet;

use roxmltree::Node;

use super::reader::Reader;
use crate::import::railml::xml::{Xml, children};

/// Words of which the name or the id of a type of train routes has one: the names are each infrastructure manager's own.
const TRAIN: [&str; 5] = ["main", "train", "trains", "principal", "zugstrasse"];

/// What the name or the id of other types has in it.
const OTHER: [&str; 11] =
    ["shunt", "rangier", "call", "auxil", "hilf", "emerg", "subst", "ersatz", "manoeuv", "manœuv", "sperr"];

impl<'a> Reader<'a, '_> {
    /// That a route is one for trains.
    pub(super) fn for_trains(&self, node: Node<'a, 'a>) -> Result<(), String> {
        let own = types(node);
        let is_other = |id: &&str| {
            let told = told(self.xml, id).to_lowercase();
            OTHER.iter().any(|word| told.contains(word))
        };
        if own.is_empty() || own.iter().any(|id| !is_other(id) && is_told(self.xml, id)) {
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
    let all: BTreeSet<Vec<&str>> = xml.all("route").map(types).collect();
    match all.first().map(Vec::as_slice) {
        Some([only]) if all.len() == 1 => Some(only),
        _ => None,
    }
}

/// Whether the name or the id of a type says that it is one of trains: by a whole word, as in `rt_main` or `mainRoute`.
pub(super) fn is_told(xml: &Xml<'_>, id: &str) -> bool {
    let mut words = vec![String::new()];
    let mut before = ' ';
    for letter in told(xml, id).replace('ß', "ss").chars() {
        if !letter.is_alphabetic() || letter.is_uppercase() && before.is_lowercase() {
            words.push(String::new());
        }
        if let Some(word) = words.last_mut().filter(|_| letter.is_alphabetic()) {
            word.extend(letter.to_lowercase());
        }
        before = letter;
    }
    let has = |one: &[&str]| words.iter().any(|word| one.contains(&word.as_str()));
    has(&TRAIN) && !has(&["no", "non", "not", "nicht"])
}

/// The types of a route; nothing for one that is not said.
fn types<'a>(node: Node<'a, 'a>) -> Vec<&'a str> {
    children(node, "handlesRouteType").map(|child| child.attribute("ref").unwrap_or_default()).collect()
}

/// What a type is called: its name, or its id where it has none.
fn told(xml: &Xml<'_>, id: &str) -> String {
    xml.id(id).map_or_else(|| id.to_owned(), |node| xml.name(node).value)
}
