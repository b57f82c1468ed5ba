//! A railML file as this reading has it: net elements in metres, what leads on from their ends, and what stands on them.

use std::collections::{BTreeMap, BTreeSet};

use roxmltree::{Document, Node};

/// An end of a net element: its id, and whether it is the one where its coordinates end.
pub type End<'a> = (&'a str, bool);

/// A place on a net element.
#[derive(Clone, Copy, Debug)]
pub struct Spot<'a> {
    /// The net element.
    pub element: &'a str,
    /// Metres from its begin.
    pub at: f64,
    /// Whether what stands there is for trains that run toward its end, if it says so.
    pub toward_end: Option<bool>,
}

/// A branch of a switch: the switch, and which of its branches.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Branch<'a> {
    /// The id of the switch.
    pub switch: &'a str,
    /// `leftBranch`, `rightBranch`, `straightBranch` or `turningBranch`.
    pub side: &'a str,
    /// The net relation.
    pub relation: &'a str,
}

/// Detectors that divide the tracks, at one place.
#[derive(Clone, Debug, Default)]
pub struct Divider<'a> {
    /// Metres from the begin of the net element.
    pub at: f64,
    /// Their ids.
    pub ids: Vec<&'a str>,
}

/// The file.
pub struct File<'a> {
    ids: BTreeMap<&'a str, Node<'a, 'a>>,
    all: Vec<Node<'a, 'a>>,
    names: BTreeMap<(&'a str, &'a str), usize>,
    /// Lengths of net elements.
    pub lengths: BTreeMap<&'a str, f64>,
    /// Where a train can go on from an end, and by which relation.
    pub onward: BTreeMap<End<'a>, Vec<(End<'a>, &'a str)>>,
    /// Branches by relation.
    pub branches: BTreeMap<&'a str, Branch<'a>>,
    /// What divides each net element, in order.
    pub dividers: BTreeMap<&'a str, Vec<Divider<'a>>>,
    /// The borders of tvdSections.
    pub sections: BTreeMap<&'a str, BTreeSet<&'a str>>,
    /// Buffer stops on each net element, in metres from its begin, with their ids.
    pub stops: BTreeMap<&'a str, Vec<(f64, &'a str)>>,
    /// Sections of speed.
    pub limits: Vec<Limit<'a>>,
}

/// A limit of speed on a stretch of track.
#[derive(Clone, Copy, Debug)]
pub struct Limit<'a> {
    /// Its section of speed.
    pub id: &'a str,
    /// In km/h; 0 if that cannot be read.
    pub kmh: f64,
    /// Net element and metres from its begin, low and high; none if it may be anywhere.
    pub on: Option<(&'a str, f64, f64)>,
}

const SIDES: [&str; 4] = ["leftBranch", "rightBranch", "straightBranch", "turningBranch"];

impl<'a> File<'a> {
    /// Reads the document.
    pub fn of(document: &'a Document<'a>) -> Self {
        let all: Vec<Node<'a, 'a>> = document.root().descendants().filter(Node::is_element).collect();
        let ids = all.iter().filter_map(|node| Some((node.attribute("id")?, *node))).collect();
        let mut names: BTreeMap<(&str, &str), usize> = BTreeMap::new();
        for node in &all {
            *names.entry((kind(*node), spoken(*node))).or_default() += 1;
        }
        let mut file = Self {
            ids,
            all,
            names,
            lengths: BTreeMap::new(),
            onward: BTreeMap::new(),
            branches: BTreeMap::new(),
            dividers: BTreeMap::new(),
            sections: BTreeMap::new(),
            stops: BTreeMap::new(),
            limits: Vec::new(),
        };
        file.read_tracks();
        file.read_sections();
        for node in document.root().descendants().filter(|node| node.tag_name().name() == "bufferStop") {
            if let (Some(id), Some(spot)) = (node.attribute("id"), file.spot(node)) {
                file.stops.entry(spot.element).or_default().push((spot.at, id));
            }
        }
        file.limits = file.every("speedSection").flat_map(|section| file.limits_of(section)).collect();
        file
    }

    /// The elements of this name.
    pub fn every(&self, name: &'a str) -> impl Iterator<Item = Node<'a, 'a>> + '_ {
        self.all.iter().copied().filter(move |node| node.tag_name().name() == name)
    }

    /// The element with this id.
    pub fn by_id(&self, id: &str) -> Option<Node<'a, 'a>> {
        self.ids.get(id).copied()
    }

    /// The element of the infrastructure that an id stands for.
    pub fn meant(&self, id: &str) -> Option<Node<'a, 'a>> {
        let mut node = self.by_id(id)?;
        // A destination, a signal of the interlocking, a signal: no chain is longer.
        for _ in 0..4 {
            match refers(node, "refersTo").and_then(|next| self.by_id(next)) {
                Some(next) => node = next,
                None => break,
            }
        }
        Some(node)
    }

    /// Whether a name of the layout means this element: its name, or its id where others have that name too.
    pub fn means(&self, name: &str, id: &str) -> bool {
        let Some(node) = self.by_id(id) else { return name == id };
        let alone = self.names.get(&(kind(node), spoken(node))) == Some(&1);
        name == id || alone && name == spoken(node)
    }

    /// What an element is called.
    pub fn call(&self, id: &'a str) -> &'a str {
        let Some(node) = self.by_id(id) else { return id };
        if self.names.get(&(kind(node), spoken(node))) == Some(&1) { spoken(node) } else { id }
    }

    /// Where an element stands.
    pub fn spot(&self, node: Node<'a, 'a>) -> Option<Spot<'a>> {
        let at = node.children().find(|child| child.tag_name().name() == "spotLocation")?;
        let element = at.attribute("netElementRef")?;
        let length = *self.lengths.get(element)?;
        let (by_share, by_metres) = (figure(at, "intrinsicCoord").map(|share| share * length), figure(at, "pos"));
        if by_share.zip(by_metres).is_some_and(|(one, other)| contradict(one, other, length)) {
            return None;
        }
        let metres = by_share.or(by_metres).or_else(|| self.by_chainage(element, at.children().find(is_linear)?))?;
        let toward_end = at.attribute("applicationDirection").and_then(|word| match word {
            "normal" => Some(true),
            "reverse" => Some(false),
            _ => None,
        });
        Some(Spot { element, at: metres.clamp(0.0, length), toward_end })
    }

    /// Where a section of speed holds: one limit for each net element that it names, and one for anywhere if it names none that is known.
    fn limits_of(&self, section: Node<'a, 'a>) -> Vec<Limit<'a>> {
        let id = section.attribute("id").unwrap_or_default();
        let kmh = figure(section, "maxSpeed").filter(|kmh| *kmh >= 1.0).unwrap_or(0.0);
        let elements = section.descendants().filter(|at| at.tag_name().name() == "associatedNetElement");
        let on: Vec<_> = elements.map(|at| self.covered(at)).collect();
        let on = if on.is_empty() { vec![None] } else { on };
        on.into_iter().map(|on| Limit { id, kmh, on }).collect()
    }

    /// The part of a net element that a limit covers; nothing where its ends are not two places on it.
    fn covered(&self, at: Node<'a, 'a>) -> Option<(&'a str, f64, f64)> {
        let element = at.attribute("netElementRef")?;
        let length = *self.lengths.get(element)?;
        let mut ends = [0.0, length];
        for (end, word) in ends.iter_mut().zip(["Begin", "End"]) {
            let said = |name: &str| -> Option<Option<f64>> {
                let name = format!("{name}{word}");
                at.attribute(name.as_str()).map(|_| figure(at, &name))
            };
            let share = said("intrinsicCoord").map(|share| share.map(|share| share * length));
            let coordinate = format!("linearCoordinate{word}");
            let linear = at.children().find(|child| child.tag_name().name() == coordinate);
            let found = match (share, said("pos")) {
                (Some(share), Some(metres)) => {
                    let (share, metres) = (share?, metres?);
                    (!contradict(share, metres, length)).then_some(share)?
                }
                (Some(only), None) | (None, Some(only)) => only?,
                (None, None) => match linear {
                    Some(linear) => self.by_chainage(element, linear)?,
                    None => continue,
                },
            };
            if found < -1.0 || found > length + 1.0 {
                return None;
            }
            *end = found.clamp(0.0, length);
        }
        let [one, other] = ends;
        ((one - other).abs() >= length.min(1.0)).then_some((element, one.min(other), one.max(other)))
    }

    /// The first buffer stop ahead of a train that runs over a net element from `at`, and how far ahead of it; `least` or farther.
    pub fn stop_ahead(&self, element: &str, at: f64, toward_end: bool, least: f64) -> Option<f64> {
        let ahead = |place: f64| if toward_end { place - at } else { at - place };
        let stops = self.stops.get(element).into_iter().flatten().map(|(place, _)| ahead(*place));
        stops.filter(|distance| *distance >= least).min_by(f64::total_cmp)
    }

    /// Metres from the begin of a net element, for a chainage.
    fn by_chainage(&self, element: &str, linear: Node<'a, 'a>) -> Option<f64> {
        let (length, wanted) = (*self.lengths.get(element)?, figure(linear, "measure")?);
        let marks = marks(self.by_id(element)?, linear.attribute("positioningSystemRef").unwrap_or_default());
        let pair = |pair: &[(f64, f64)]| -> Option<f64> {
            let [(from, begin), (to, end)] = pair else { return None };
            let part = (wanted - begin) / (end - begin);
            (part.is_finite()).then_some((from + part * (to - from)) * length)
        };
        let inside = |pair: &&[(f64, f64)]| {
            let (low, high) = (pair[0].1.min(pair[1].1), pair[0].1.max(pair[1].1));
            low <= wanted && wanted <= high
        };
        let found = marks.windows(2).find(inside).and_then(pair);
        found.or_else(|| pair(marks.get(..2)?))
    }

    /// The sections that have this border.
    pub fn beside(&self, divider: &Divider<'a>) -> BTreeSet<&'a str> {
        let borders = |borders: &BTreeSet<&'a str>| divider.ids.iter().any(|id| borders.contains(id));
        self.sections.iter().filter(|(_, all)| borders(all)).map(|(id, _)| *id).collect()
    }

    fn read_tracks(&mut self) {
        let levels: Vec<Node<'a, 'a>> =
            self.every("level").filter(|level| level.attribute("descriptionLevel") == Some("Micro")).collect();
        let micro: BTreeSet<&str> = levels.iter().flat_map(|level| every_ref(*level, "networkResource")).collect();
        let aggregated =
            |node: &Node<'a, 'a>| node.children().any(|child| child.tag_name().name().starts_with("elementCollection"));
        let mut lengths = BTreeMap::new();
        for node in self.every("netElement").filter(|node| !aggregated(node)) {
            let Some(id) = node.attribute("id").filter(|id| micro.is_empty() || micro.contains(id)) else { continue };
            lengths.entry(id).or_insert_with(|| self.length(node, id));
        }
        self.lengths = lengths;
        let end = |node: Node<'a, 'a>, element: &str, position: &str| -> Option<End<'a>> {
            let id = refers(node, element).filter(|id| self.lengths.contains_key(id))?;
            match node.attribute(position)? {
                "0" => Some((id, false)),
                "1" => Some((id, true)),
                _ => None,
            }
        };
        let mut onward: BTreeMap<End<'a>, Vec<(End<'a>, &'a str)>> = BTreeMap::new();
        for node in self.every("netRelation") {
            let ends = end(node, "elementA", "positionOnA").zip(end(node, "elementB", "positionOnB"));
            let (Some(id), Some((one, other))) = (node.attribute("id"), ends) else { continue };
            let way = node.attribute("navigability").unwrap_or("Both");
            if ["Both", "AB"].contains(&way) {
                onward.entry(one).or_default().push((other, id));
            }
            if ["Both", "BA"].contains(&way) {
                onward.entry(other).or_default().push((one, id));
            }
        }
        self.onward = onward;
        let mut branches = BTreeMap::new();
        for node in self.every("switchIS") {
            for branch in node.children().filter(|child| SIDES.contains(&child.tag_name().name())) {
                if let (Some(switch), Some(relation)) = (node.attribute("id"), branch.attribute("netRelationRef")) {
                    branches.insert(relation, Branch { switch, side: branch.tag_name().name(), relation });
                }
            }
        }
        self.branches = branches;
    }

    fn length(&self, node: Node<'a, 'a>, id: &str) -> f64 {
        let positive = |metres: &f64| *metres > 0.0;
        let system = node.descendants().find(is_linear).and_then(|at| at.attribute("positioningSystemRef"));
        let marks = marks(node, system.unwrap_or_default());
        let by_marks = marks.first().zip(marks.last()).map(|(first, last)| (last.1 - first.1).abs());
        let corners: Vec<(f64, f64)> = node
            .descendants()
            .filter(|at| at.tag_name().name() == "geometricCoordinate")
            .filter_map(|at| figure(at, "x").zip(figure(at, "y")))
            .collect();
        let drawn: f64 = corners.windows(2).map(|two| (two[1].0 - two[0].0).hypot(two[1].1 - two[0].1)).sum();
        let by_track = self.every("track").find_map(|track| {
            let on: Vec<&str> = track.descendants().filter_map(|at| at.attribute("netElementRef")).collect();
            let length = track.children().find(|child| child.tag_name().name() == "length")?;
            (on == [id]).then(|| figure(length, "value")).flatten()
        });
        let by_attribute = figure(node, "length").filter(positive);
        let found = by_attribute.or(by_marks.filter(positive)).or((drawn > 0.0).then_some(drawn));
        // The import says so, too, and takes the same.
        found.or(by_track.filter(positive)).unwrap_or(100.0)
    }

    fn read_sections(&mut self) {
        let mut sections = BTreeMap::new();
        for node in self.every("tvdSection") {
            let borders =
                every_ref(node, "hasDemarcatingTraindetector").chain(every_ref(node, "hasDemarcatingBufferstop"));
            if let Some(id) = node.attribute("id") {
                sections.insert(id, borders.collect::<BTreeSet<_>>());
            }
        }
        let named: BTreeSet<&str> = sections.values().flatten().copied().collect();
        let detectors: Vec<Node<'a, 'a>> = self.every("trainDetectionElement").collect();
        let is_real = |node: &Node<'a, 'a>| !node.attribute("type").is_some_and(|kind| kind.starts_with("virtual"));
        let is_named = |node: &Node<'a, 'a>| node.attribute("id").is_some_and(|id| named.contains(id));
        let any_named = detectors.iter().any(is_named);
        let mut dividers: BTreeMap<&str, Vec<Divider<'a>>> = BTreeMap::new();
        for node in detectors.iter().filter(|node| if any_named { is_named(node) } else { is_real(node) }) {
            let (Some(id), Some(spot)) = (node.attribute("id"), self.spot(*node)) else { continue };
            let there = dividers.entry(spot.element).or_default();
            match there.iter_mut().find(|other| (other.at - spot.at).abs() < 0.01) {
                Some(same) => same.ids.push(id),
                None => there.push(Divider { at: spot.at, ids: vec![id] }),
            }
        }
        for there in dividers.values_mut() {
            there.sort_by(|one, other| one.at.total_cmp(&other.at));
        }
        self.sections = sections;
        self.dividers = dividers;
    }

    /// The ids of buffer stops at a place on a net element.
    pub fn stops_at(&self, (element, at): (&str, f64)) -> Vec<&'a str> {
        let stops = self.stops.get(element).into_iter().flatten();
        stops.filter(|(place, _)| (place - at).abs() < 0.01).map(|(_, id)| *id).collect()
    }
}

/// What shares one set of names in a layout.
fn kind<'a>(node: Node<'a, 'a>) -> &'a str {
    match node.tag_name().name() {
        "trainDetectionElement" | "bufferStop" => "joint",
        other => other,
    }
}

fn spoken<'a>(node: Node<'a, 'a>) -> &'a str {
    let said = node.children().find_map(|child| match child.tag_name().name() {
        "name" | "assetName" | "objectName" => child.attribute("name"),
        "designator" => child.attribute("entry"),
        _ => None,
    });
    said.filter(|said| !said.trim().is_empty()).or(node.attribute("id")).unwrap_or("unnamed")
}

fn is_linear(node: &Node<'_, '_>) -> bool {
    node.tag_name().name() == "linearCoordinate"
}

/// Marks of a net element in one system of chainage: share of its length, and measure.
fn marks(node: Node<'_, '_>, system: &str) -> Vec<(f64, f64)> {
    let mut found = Vec::new();
    for at in node.descendants().filter(|at| at.tag_name().name() == "intrinsicCoordinate") {
        let same = |linear: &Node<'_, '_>| linear.attribute("positioningSystemRef").unwrap_or_default() == system;
        let linear = at.children().filter(is_linear).find(same);
        found.extend(figure(at, "intrinsicCoord").zip(linear.and_then(|linear| figure(linear, "measure"))));
    }
    found.sort_by(|one, other| one.0.total_cmp(&other.0));
    found
}

/// The id that a child refers to.
pub fn refers<'a>(node: Node<'a, 'a>, name: &str) -> Option<&'a str> {
    every_ref(node, name).next()
}

/// The ids that children of this name refer to.
pub fn every_ref<'a>(node: Node<'a, 'a>, name: &str) -> impl Iterator<Item = &'a str> {
    node.children().filter(move |child| child.tag_name().name() == name).filter_map(|child| child.attribute("ref"))
}

/// Whether two places of one thing, in metres, cannot both be right.
fn contradict(one: f64, other: f64, length: f64) -> bool {
    (one - other).abs() > (0.1 * length).clamp(1.0, 20.0)
}

/// A finite number.
pub fn figure(node: Node<'_, '_>, name: &str) -> Option<f64> {
    node.attribute(name).and_then(|text| text.trim().parse::<f64>().ok()).filter(|number| number.is_finite())
}

/// Milliseconds of an ISO 8601 duration without years and months; rounded down, as a layout must not have less.
pub fn milliseconds(text: &str) -> Option<f64> {
    let mut total = 0.0;
    let (mut number, mut in_time) = (String::new(), false);
    for letter in text.trim().strip_prefix('P')?.chars() {
        let unit = match (letter, in_time) {
            ('T', false) => {
                in_time = true;
                continue;
            }
            ('0'..='9' | '.', _) => {
                number.push(letter);
                continue;
            }
            ('Y' | 'M', false) => 0.0,
            ('D', false) => 86_400_000.0,
            ('H', true) => 3_600_000.0,
            ('M', true) => 60_000.0,
            ('S', true) => 1000.0,
            _ => return None,
        };
        let value: f64 = number.parse().ok()?;
        if unit == 0.0 && value != 0.0 {
            return None;
        }
        total += value * unit;
        number.clear();
    }
    number.is_empty().then_some(total)
}
