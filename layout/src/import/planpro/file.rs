//! A PlanPro file: its objects by identity, and what stands in them.

use std::collections::BTreeMap;
use std::ops::Range;

use roxmltree::{Document, Node};

use crate::at::At;
use crate::problem::Problem;
use crate::rule::Rule;

/// The state of a station that a file describes: the planned one, or the one that there is.
pub struct File<'a> {
    objects: Vec<Node<'a, 'a>>,
    by_id: BTreeMap<String, Node<'a, 'a>>,
    /// How many objects of a kind are called the same.
    called: BTreeMap<(&'a str, &'a str), usize>,
    /// How many identities begin with the same figures.
    begins: BTreeMap<String, usize>,
}

/// A place on an edge of the topology.
#[derive(Clone, Debug)]
pub struct Place {
    /// The identity of the edge.
    pub edge: String,
    /// Metres from its node A.
    pub at: f64,
    /// Whether what stands there is for trains that run toward node B, if it says so.
    pub toward_end: Option<bool>,
}

/// A stretch of an edge of the topology.
#[derive(Clone, Debug)]
pub struct Stretch {
    /// The identity of the edge.
    pub edge: String,
    /// Metres from its node A, the lower first.
    pub from: f64,
    /// The higher one.
    pub to: f64,
}

/// What is read of an object and stands in it once.
const SINGLE: [&str; 36] = [
    "Abstand",
    "Aufloesung_Verzoegerung",
    "Begrenzung_A",
    "Begrenzung_B",
    "DWeg_V",
    "DWeg_Vorzug",
    "Durchfahrt",
    "Element_Verschluss",
    "Fahrt_Ueber",
    "Fla_Raum_Freimeldung",
    "Fla_Schutz_Anforderer",
    "Fla_Schutz_W_Gsp",
    "Fla_Schutz_Weitergabe",
    "Fla_W_Lage",
    "Fstr_V",
    "Fstr_V_Hg",
    "Fstr_Zug",
    "Fstr_Zug_Art",
    "Fstr_Zug_DWeg",
    "Geschwindigkeit",
    "Geschwindigkeit_L",
    "Geschwindigkeit_R",
    "ID_Element",
    "ID_Fla_W_Gsp_Element",
    "ID_Fla_Weitergabe_L",
    "ID_Fla_Weitergabe_R",
    "ID_Fstr_DWeg",
    "ID_Fstr_Fahrweg",
    "ID_Start",
    "ID_TOP_Kante",
    "ID_W_Kr_Gsp_Element",
    "ID_Ziel",
    "Laenge_Soll",
    "Stammgleis",
    "TOP_Laenge",
    "Wirkrichtung",
];

/// Figures of an identity that tell objects apart in most files.
const SHORT: usize = 8;

impl<'a> File<'a> {
    /// Indexes the objects of a document.
    ///
    /// # Errors
    /// It has no state, or two objects with one identity.
    pub fn of(document: &'a Document<'a>) -> Result<Self, Vec<Problem>> {
        let root = document.root_element();
        let states = |name: &'static str| root.descendants().filter(move |node| node.has_tag_name(name));
        let mut containers: Vec<Node<'a, 'a>> =
            states("LST_Zustand_Ziel").filter_map(|state| child(state, "Container")).collect();
        if containers.is_empty() {
            containers = states("LST_Zustand").filter_map(|state| child(state, "Container")).collect();
        }
        if containers.is_empty() {
            let what = "the file has neither an LST_Zustand_Ziel nor an LST_Zustand with a Container";
            return Err(vec![Problem::new(Rule::Form, &start(root), what, "give the state that is meant")]);
        }
        let objects: Vec<Node<'a, 'a>> =
            containers.iter().flat_map(|container| container.children().filter(Node::is_element)).collect();
        let mut file = Self { objects, by_id: BTreeMap::new(), called: BTreeMap::new(), begins: BTreeMap::new() };
        let mut problems = Vec::new();
        // Of a value that a comment divides only a part would be read.
        let is_divided = |node: &Node<'a, 'a>| node.has_tag_name("Wert") && node.children().count() > 1;
        for node in file.objects.iter().flat_map(Node::descendants).filter(is_divided) {
            let what = "a value is in several parts";
            problems.push(Problem::new(Rule::Form, &start(node), what, "let nothing but the value stand in its Wert"));
        }
        // Of two values for one attribute only the first would be read.
        for node in file.objects.iter().flat_map(Node::descendants).filter(Node::is_element) {
            let name = node.tag_name().name();
            let again = node.prev_siblings().skip(1).find(|other| other.has_tag_name(name));
            if again.is_some()
                && SINGLE.contains(&name)
                && node.parent().is_none_or(|parent| !parent.has_tag_name("Container"))
            {
                let what = format!("there are two {name} where one may be");
                problems.push(Problem::new(Rule::NameTwice, &start(node), what, "leave the one that holds"));
            }
        }
        for node in &file.objects {
            let Some(id) = value(*node, &["Identitaet"]) else { continue };
            *file.begins.entry(id.chars().take(SHORT).collect::<String>().to_lowercase()).or_default() += 1;
            *file.called.entry((node.tag_name().name(), word(*node))).or_default() += 1;
            // Nothing of an actuator is read, and some tools give it the identity of what it moves.
            if node.has_tag_name("Stellelement") {
                continue;
            }
            if let Some(first) = file.by_id.insert(id.to_lowercase(), *node) {
                let what = format!("two objects have the identity {id}: {} and {}", at(first), at(*node));
                problems.push(Problem::new(Rule::NameTwice, &start(*node), what, "give each its own"));
            }
        }
        if problems.is_empty() { Ok(file) } else { Err(problems) }
    }

    /// Every object, in the order of the file.
    pub fn objects(&self) -> impl Iterator<Item = Node<'a, 'a>> + '_ {
        self.objects.iter().copied()
    }

    /// The objects of this kind, in the order of the file.
    pub fn all(&self, kind: &'static str) -> impl Iterator<Item = Node<'a, 'a>> + '_ {
        self.objects().filter(move |node| node.tag_name().name() == kind)
    }

    /// The object with this identity.
    pub fn id(&self, id: &str) -> Option<Node<'a, 'a>> {
        self.by_id.get(&id.to_lowercase()).copied()
    }

    /// The object that the child of this name refers to.
    pub fn referred(&self, node: Node<'a, 'a>, name: &str) -> Option<Node<'a, 'a>> {
        value(node, &[name]).and_then(|id| self.id(id))
    }

    /// What people call an object: the name in its tables; the first figures of its identity where it has none or another of its kind has the
    /// same.
    pub fn name(&self, node: Node<'a, 'a>) -> At<String> {
        let called = word(node);
        let alone = !called.is_empty() && self.called.get(&(node.tag_name().name(), called)) == Some(&1);
        let name = if alone { called.to_owned() } else { self.short(node) };
        At::new(name, start(node))
    }

    /// The first figures of an identity, all of them where another has the same.
    fn short(&self, node: Node<'a, 'a>) -> String {
        let id = value(node, &["Identitaet"]).unwrap_or("unnamed");
        let begin: String = id.chars().take(SHORT).collect();
        if self.begins.get(&begin.to_lowercase()) == Some(&1) { begin } else { id.to_owned() }
    }
}

/// What an object is called in tables, or on plans; nothing if it has no name.
fn word<'a>(node: Node<'a, '_>) -> &'a str {
    const NAMES: [&[&str]; 5] = [
        &["Bezeichnung", "Bezeichnung_Tabelle"],
        &["Bezeichnung", "Bezeichnung_Lageplan_Lang"],
        &["Bezeichnung", "Bezeichnung_Lageplan_Kurz"],
        &["Knotenname"],
        &["TOP_Kante_Allg", "Kantenname"],
    ];
    NAMES.iter().find_map(|path| value(node, path)).unwrap_or_default()
}

/// An object and where it stands, for people: `Signal 60A, line 120`.
pub fn at(node: Node<'_, '_>) -> String {
    let line = node.document().text_pos_at(node.range().start).row;
    let called = Some(word(node)).filter(|word| !word.is_empty()).or_else(|| value(node, &["Identitaet"]));
    format!("{} {}, line {line}", node.tag_name().name(), called.unwrap_or("without an identity"))
}

/// The start of an element: it may be long.
pub fn start(node: Node<'_, '_>) -> Range<usize> {
    node.range().start..node.range().end.min(node.range().start + 1)
}

/// The first child of this name.
pub fn child<'a, 'b>(node: Node<'a, 'b>, name: &str) -> Option<Node<'a, 'b>> {
    node.children().find(|child| child.tag_name().name() == name)
}

/// The children of this name.
pub fn children<'a, 'b>(node: Node<'a, 'b>, name: &'static str) -> impl Iterator<Item = Node<'a, 'b>> + use<'a, 'b> {
    node.children().filter(move |child| child.tag_name().name() == name)
}

/// What the attribute at the end of this path has as its value; nothing if it is empty.
pub fn value<'a>(node: Node<'a, '_>, path: &[&str]) -> Option<&'a str> {
    let end = path.iter().try_fold(node, |node, name| child(node, name))?;
    child(end, "Wert")?.text().map(str::trim).filter(|text| !text.is_empty())
}

/// The values of all children of this name.
pub fn values<'a>(node: Node<'a, '_>, name: &'static str) -> impl Iterator<Item = &'a str> {
    children(node, name).filter_map(|child| value(child, &[]))
}

/// Whether something is said to be so: what cannot be read may be.
pub fn is_set(node: Node<'_, '_>, path: &[&str]) -> bool {
    value(node, path).is_some_and(|text| !["false", "0"].contains(&text))
}

/// A figure in metres, seconds, thousandths or km/h: one that is finite.
pub fn figure(node: Node<'_, '_>, path: &[&str]) -> Option<f64> {
    value(node, path)?.replace(',', ".").parse::<f64>().ok().filter(|figure| figure.is_finite())
}

/// Where an object stands: one place for each edge that it names.
pub fn places(node: Node<'_, '_>) -> Vec<Place> {
    let places = children(node, "Punkt_Objekt_TOP_Kante").filter_map(|place| {
        let toward_end = match value(place, &["Wirkrichtung"]) {
            Some("in") => Some(true),
            Some("gegen") => Some(false),
            _ => None,
        };
        let (edge, at) = (value(place, &["ID_TOP_Kante"])?.to_lowercase(), figure(place, &["Abstand"])?);
        Some(Place { edge, at, toward_end })
    });
    places.collect()
}

/// The stretches that an object covers.
///
/// # Errors
/// One of them cannot be read.
pub fn stretches(node: Node<'_, '_>) -> Result<Vec<Stretch>, String> {
    let read = children(node, "Bereich_Objekt_Teilbereich").map(|part| {
        let ends = figure(part, &["Begrenzung_A"]).zip(figure(part, &["Begrenzung_B"]));
        let (Some(edge), Some((one, other))) = (value(part, &["ID_TOP_Kante"]), ends) else {
            return Err(format!("a part of the {} cannot be read", at(node)));
        };
        Ok(Stretch { edge: edge.to_lowercase(), from: one.min(other), to: one.max(other) })
    });
    read.collect()
}
