//! The objects of a PlanPro file as this reading has them.

use std::collections::BTreeMap;

use roxmltree::{Document, Node};

/// A part of an edge: its identity, and metres from its node A.
pub(super) type Part = (String, f64, f64);

/// An edge of the topology.
pub(super) struct Kante {
    /// The nodes at its ends.
    pub(super) nodes: [String; 2],
    /// What is joined at its ends.
    pub(super) joined: [String; 2],
    /// Its length, in metres.
    pub(super) length: f64,
}

/// The file.
pub(super) struct Plan<'a> {
    objects: Vec<Node<'a, 'a>>,
    by_identity: BTreeMap<String, Node<'a, 'a>>,
    /// How many objects of a kind have a name, and how many identities a begin.
    counts: BTreeMap<(&'a str, String), usize>,
    /// The edges by identity.
    pub(super) edges: BTreeMap<String, Kante>,
    /// The blades at each node, by place: a node's identity.
    pub(super) blades: BTreeMap<String, Node<'a, 'a>>,
}

impl<'a> Plan<'a> {
    /// Reads a document: the planned state, or the one that there is if none is planned.
    pub(super) fn of(document: &'a Document<'a>) -> Self {
        let in_state = |state: &str| -> Vec<Node<'a, 'a>> {
            let inside = |node: &Node<'a, 'a>| {
                let container = node.parent().filter(|parent| parent.has_tag_name("Container"));
                let is_read = node.is_element() && !node.has_tag_name("Stellelement");
                is_read && container.and_then(|at| at.parent()).is_some_and(|at| at.has_tag_name(state))
            };
            document.descendants().filter(inside).collect()
        };
        let planned = in_state("LST_Zustand_Ziel");
        let objects = if planned.is_empty() { in_state("LST_Zustand") } else { planned };
        let mut counts = BTreeMap::new();
        for node in &objects {
            *counts.entry((node.tag_name().name(), spoken(*node).to_owned())).or_default() += 1;
            *counts.entry(("", begin(*node))).or_default() += 1;
        }
        let by_identity = objects.iter().filter_map(|node| Some((identity(*node)?, *node))).collect();
        let mut plan = Self { objects, by_identity, counts, edges: BTreeMap::new(), blades: BTreeMap::new() };
        let mut edges = BTreeMap::new();
        for node in plan.kind("TOP_Kante") {
            let all = (
                identity(node),
                text(node, "ID_TOP_Knoten_A"),
                text(node, "ID_TOP_Knoten_B"),
                metres(node, "TOP_Kante_Allg/TOP_Laenge"),
            );
            if let (Some(id), Some(a), Some(b), Some(length)) = all {
                let joined = ["TOP_Kante_Allg/TOP_Anschluss_A", "TOP_Kante_Allg/TOP_Anschluss_B"];
                let joined = joined.map(|path| text(node, path).unwrap_or_default().to_owned());
                edges.insert(id, Kante { nodes: [a, b].map(str::to_lowercase), joined, length });
            }
        }
        plan.edges = edges;
        let mut blades = BTreeMap::new();
        for node in plan
            .kind("W_Kr_Gsp_Komponente")
            .filter(|node| node.children().any(|child| child.has_tag_name("Zungenpaar")))
        {
            for place in node.children().filter(|child| child.has_tag_name("Punkt_Objekt_TOP_Kante")) {
                let edge = text(place, "ID_TOP_Kante").map(str::to_lowercase);
                let edge = edge.and_then(|id| plan.edges.get(&id));
                if let Some((edge, at)) = edge.zip(metres(place, "Abstand")) {
                    let ends = [(0.0, &edge.nodes[0]), (edge.length, &edge.nodes[1])];
                    let near =
                        ends.into_iter().filter(|(end, node)| (at - end).abs() <= 0.5 && plan.joined_at(node) == 3);
                    blades.extend(near.map(|(_, at)| (at.clone(), node)));
                }
            }
        }
        plan.blades = blades;
        plan
    }

    /// Every object.
    pub(super) fn all(&self) -> impl Iterator<Item = Node<'a, 'a>> + '_ {
        self.objects.iter().copied()
    }

    /// The objects of a kind.
    pub(super) fn kind(&self, name: &'a str) -> impl Iterator<Item = Node<'a, 'a>> + '_ {
        self.objects.iter().copied().filter(move |node| node.has_tag_name(name))
    }

    /// What must be moved off the track: what is neither a pair of blades nor a crossing that stays as it is.
    pub(super) fn movable(&self) -> impl Iterator<Item = Node<'a, 'a>> + '_ {
        self.kind("W_Kr_Gsp_Komponente").filter(|node| {
            let has = |name: &str| node.children().find(|child| child.has_tag_name(name));
            let stays = |one| metres(one, "Elektrischer_Antrieb_Anzahl").is_none_or(|count| count == 0.0);
            has("Zungenpaar").is_none() && !has("Kreuzung").is_some_and(stays)
        })
    }

    /// The object with this identity.
    pub(super) fn object(&self, identity: &str) -> Option<Node<'a, 'a>> {
        self.by_identity.get(identity).copied()
    }

    /// The object that an attribute refers to.
    pub(super) fn at(&self, node: Node<'a, 'a>, path: &str) -> Option<Node<'a, 'a>> {
        self.by_identity.get(&text(node, path)?.to_lowercase()).copied()
    }

    /// What the layout calls an object: the first of its names, if no other of its kind has that, or the begin of its identity.
    pub(super) fn call(&self, node: Node<'a, 'a>) -> String {
        let alone = |kind: &'a str, word: &str| self.counts.get(&(kind, word.to_owned())) == Some(&1);
        let name = spoken(node);
        if !name.is_empty() && alone(node.tag_name().name(), name) {
            return name.to_owned();
        }
        let id = text(node, "Identitaet").unwrap_or("unnamed");
        if alone("", &begin(node)) { id.chars().take(8).collect() } else { id.to_owned() }
    }

    /// How many edges meet at a node.
    pub(super) fn joined_at(&self, node: &str) -> usize {
        self.edges.values().flat_map(|edge| &edge.nodes).filter(|at| *at == node).count()
    }

    /// The sections of track vacancy detection: what their circuits are called, and what they cover.
    pub(super) fn sections(&self) -> Vec<(String, Vec<Part>)> {
        let tracks = self.kind("FMA_Anlage").filter_map(|node| self.at(node, "ID_Gleis_Abschnitt"));
        tracks.map(|track| (self.call(track), parts(track))).collect()
    }
}

/// What an object covers.
pub(super) fn parts(node: Node<'_, '_>) -> Vec<Part> {
    let parts = node.children().filter(|child| child.has_tag_name("Bereich_Objekt_Teilbereich"));
    let read = parts.filter_map(|part| {
        let (one, other) = (metres(part, "Begrenzung_A")?, metres(part, "Begrenzung_B")?);
        Some((text(part, "ID_TOP_Kante")?.to_lowercase(), one.min(other), one.max(other)))
    });
    read.collect()
}

/// Whether an object stands on one of these parts.
pub(super) fn is_on(node: Node<'_, '_>, parts: &[Part]) -> bool {
    let mut places = node.children().filter(|child| child.has_tag_name("Punkt_Objekt_TOP_Kante"));
    places.any(|place| {
        let there = text(place, "ID_TOP_Kante").map(str::to_lowercase).zip(metres(place, "Abstand"));
        there.is_some_and(|(edge, at)| {
            parts.iter().any(|(on, from, to)| *on == edge && (from - 0.5..=to + 0.5).contains(&at))
        })
    })
}

/// The begin of an identity, in small letters.
fn begin(node: Node<'_, '_>) -> String {
    text(node, "Identitaet").unwrap_or_default().chars().take(8).collect::<String>().to_lowercase()
}

/// The identity of an object, in small letters.
pub(super) fn identity(node: Node<'_, '_>) -> Option<String> {
    text(node, "Identitaet").map(str::to_lowercase)
}

/// What an object is called by people.
fn spoken<'a>(node: Node<'a, '_>) -> &'a str {
    const PATHS: [&str; 5] = [
        "Bezeichnung/Bezeichnung_Tabelle",
        "Bezeichnung/Bezeichnung_Lageplan_Lang",
        "Bezeichnung/Bezeichnung_Lageplan_Kurz",
        "Knotenname",
        "TOP_Kante_Allg/Kantenname",
    ];
    PATHS.into_iter().find_map(|path| text(node, path)).unwrap_or_default()
}

/// The value at the end of a path of names.
pub(super) fn text<'a>(node: Node<'a, '_>, path: &str) -> Option<&'a str> {
    let mut at = node;
    for name in path.split('/').filter(|name| !name.is_empty()).chain(["Wert"]) {
        at = at.children().find(|child| child.has_tag_name(name))?;
    }
    let value = at.text()?.trim();
    (!value.is_empty()).then_some(value)
}

/// A figure there.
pub(super) fn metres(node: Node<'_, '_>, path: &str) -> Option<f64> {
    let figure: f64 = text(node, path)?.replace(',', ".").parse().ok()?;
    figure.is_finite().then_some(figure)
}
