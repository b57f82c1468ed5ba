//! The nodes of the topology: where edges go on, and the points where they fork.

use std::collections::{BTreeMap, BTreeSet};

use roxmltree::Node;

use super::file::{File, at, child, places, value};
use super::routes::known;
use super::tracks::{AT_NODE, Fork, Tracks};
use crate::at::At;
use crate::form::{Position, Station};
use crate::import::limits::{kmh, lowest};
use crate::import::network::{EdgeEnd, Switch};
use crate::import::report::Report;

/// What may stand in the element of a point; anything else may be a condition.
const OF_ELEMENT: &str = "Bezeichnung ID_Regelzeichnung ID_Stellelement ID_W_Kr_Anlage ID_Weichenlaufkette W_Kr_Gsp_Element_Allg Weiche_Element";
const OF_POINT: &str =
    "Auffahrortung GZ_Freimeldung_L GZ_Freimeldung_R ID_Grenzzeichen ID_Signal Weiche_Betriebsart Weiche_Vorzugslage";

/// Forms of points that are points: one pair of blades each.
const PLAIN: [&str; 8] = ["EW", "ABW", "IBW", "ABW/IBW", "IBW/ABW", "Sym. ABW", "Klothoidenweiche", "Korbbogenweiche"];

/// What is to be confirmed of points, by name.
#[derive(Default)]
struct Remarks {
    /// Points of which the file does not say how they are set.
    unnamed: Vec<String>,
    /// Points of which it says neither which leg is straight nor how fast they are run over.
    curved: Vec<String>,
}

impl<'a> Tracks<'a> {
    /// Joins edges at their nodes.
    pub fn read_nodes(&mut self, file: &File<'a>, station: &Station, report: &mut Report) {
        let blades = self.blades(file, report);
        let nodes: BTreeSet<String> = self.edges.values().flat_map(|top| top.nodes.iter().cloned()).collect();
        let mut remarks = Remarks::default();
        for node in nodes {
            let ends = self.at_node(&node);
            let forks = |end: &(&str, bool, &str)| ["Spitze", "Links", "Rechts", "Ende"].contains(&end.2);
            let joined = match ends.as_slice() {
                [_] => true,
                [one, other] if !forks(one) && !forks(other) => {
                    let pair = self.end(one.0, one.1).zip(self.end(other.0, other.1));
                    self.network.links.extend(pair);
                    true
                }
                [_, _, _] => self.fork(file, &node, blades.get(&node).copied(), station, &mut remarks),
                _ => false,
            };
            if !joined {
                let words: Vec<&str> = self.at_node(&node).into_iter().map(|(.., port)| port).collect();
                let told = file.id(&node).map_or_else(|| format!("node {node}"), at);
                report
                    .lacking
                    .push(format!("{told}: edges joined as {} make no track; they end there", words.join(", ")));
            }
        }
        if !remarks.unnamed.is_empty() {
            let names = remarks.unnamed.join(", ");
            report.defaulted.push(format!("points without a W_Kr_Gsp_Element are taken to be set from here: {names}"));
        }
        if !remarks.curved.is_empty() {
            let names = remarks.curved.join(", ");
            let what = "the lowest speed over points whose straight leg and speeds the file does not give";
            report.defaulted.push(format!("{what}: {names}"));
        }
    }

    /// A point at a node of three edges. Whether they are a toe and two legs.
    fn fork(
        &mut self,
        file: &File<'a>,
        node: &str,
        blades: Option<Node<'a, 'a>>,
        station: &Station,
        remarks: &mut Remarks,
    ) -> bool {
        let ends = self.at_node(node);
        let end = |port: &str| -> Option<EdgeEnd> {
            let (id, is_b, _) = ends.iter().find(|(.., at)| *at == port)?;
            self.end(id, *is_b)
        };
        let (Some(toe), Some(left), Some(right)) = (end("Spitze"), end("Links"), end("Rechts")) else { return false };
        let element = blades.and_then(|blades| file.referred(blades, "ID_W_Kr_Gsp_Element"));
        let name = element.or_else(|| file.id(node)).map_or_else(|| At::derived(node.to_owned()), |one| file.name(one));
        // Two points on one lever are no points of a layout, but they need names.
        let same = self.network.switches.iter().filter(|other| other.name.value == name.value).count();
        let name = if same > 0 { At::derived(format!("{name} #{}", same + 1)) } else { name };
        let main = blades.and_then(|blades| value(blades, &["Zungenpaar", "Stammgleis"]));
        let preferred = element.and_then(|element| value(element, &["Weiche_Element", "Weiche_Vorzugslage"]));
        let left_is_normal = !main.or(preferred).is_some_and(|side| side.eq_ignore_ascii_case("rechts"));
        let ports = if left_is_normal { [toe, left, right] } else { [toe, right, left] };
        let point = self.network.switches.len();
        let slowest = lowest(station);
        let mut is_curved = false;
        for (is_left, speed) in [(true, "Geschwindigkeit_L"), (false, "Geschwindigkeit_R")] {
            let position = if is_left == left_is_normal { Position::Normal } else { Position::Reverse };
            match blades.and_then(|blades| value(blades, &["Zungenpaar", speed])) {
                Some(text) => self.limits.leg(point, position, kmh(text).unwrap_or(0)),
                // Which leg diverges is not known: either may.
                None if main.is_none() => {
                    self.limits.leg(point, position, slowest);
                    is_curved = true;
                }
                None => {}
            }
        }
        if is_curved {
            remarks.curved.push(name.value.clone());
        }
        match (blades, element) {
            (Some(blades), Some(element)) => self.settable(file, point, blades, element),
            (Some(blades), None) => {
                self.barred.insert(point, format!("the {} belongs to no W_Kr_Gsp_Element", at(blades)));
            }
            // Where the file has elements, one without is none of them, or one that has lost its place.
            (None, _) if file.all("W_Kr_Gsp_Element").next().is_some() => {
                self.barred.insert(point, format!("point {name} has no W_Kr_Gsp_Komponente"));
            }
            (None, _) => remarks.unnamed.push(name.value.clone()),
        }
        self.network.switches.push(Switch { name, ports, throw_ms: None });
        self.forks.insert(node.to_owned(), Fork { point, left_is_normal });
        true
    }

    /// Bars a point that is not set from here, or not alone.
    fn settable(&mut self, file: &File<'a>, point: usize, blades: Node<'a, 'a>, element: Node<'a, 'a>) {
        let id = value(element, &["Identitaet"]).unwrap_or_default().to_lowercase();
        let points = self.elements.entry(id).or_default();
        points.push(point);
        if points.len() > 1 {
            let why = format!("the {} has two pairs of blades, and no layout has two points on one lever", at(element));
            self.barred.extend(points.iter().map(|point| (*point, why.clone())));
        }
        let kind = child(element, "Weiche_Element");
        let more = known(element, OF_ELEMENT).and_then(|()| kind.map_or(Ok(()), |kind| known(kind, OF_POINT)));
        if let Err(why) = more {
            self.barred.insert(point, format!("the {}: {why}", at(element)));
        }
        let form =
            file.referred(element, "ID_W_Kr_Anlage").and_then(|all| value(all, &["W_Kr_Anlage_Allg", "W_Kr_Art"]));
        let crossing = child(blades, "Zungenpaar").and_then(|pair| child(pair, "Kreuzungsgleis"));
        if let Some(form) = form.filter(|form| !PLAIN.contains(form)).or(crossing.map(|_| "slip")) {
            self.barred.insert(point, format!("the {} is part of a {form}, which is not read", at(blades)));
        }
        // Keys and zones that are set locally may ask for the point.
        let of_element = value(element, &["Identitaet"]).unwrap_or_default();
        let asks = |node: &Node<'a, 'a>| {
            let kind = node.tag_name().name();
            let mut all = node.descendants().filter(|node| node.tag_name().name().starts_with("ID_"));
            (kind.starts_with("Schl") || kind.starts_with("NB_"))
                && all.any(|node| value(node, &[]).is_some_and(|id| id.eq_ignore_ascii_case(of_element)))
        };
        if let Some(other) = file.objects().find(asks) {
            self.barred
                .insert(point, format!("the {} is about the {}, and no layout holds that", at(other), at(element)));
        }
        if let Some(why) = unset(element) {
            self.barred.insert(point, format!("the {} {why}", at(blades)));
        }
    }

    /// The pair of blades at each node; what else moves is in the way.
    fn blades(&mut self, file: &File<'a>, report: &mut Report) -> BTreeMap<String, Node<'a, 'a>> {
        let mut blades = BTreeMap::new();
        for node in file.all("W_Kr_Gsp_Komponente").filter(|node| child(*node, "Kreuzung").is_none()) {
            let here = places(node);
            if child(node, "Zungenpaar").is_none() {
                self.obstruct(node, here, "must be off the track, which no layout asks for");
                continue;
            }
            let mut nodes = BTreeSet::new();
            for place in &here {
                let Some(top) = self.edges.get(&place.edge) else { continue };
                let ends = [(0.0, &top.nodes[0]), (top.length, &top.nodes[1])];
                let near = ends.into_iter().filter(|(end, _)| (place.at - end).abs() <= AT_NODE);
                nodes.extend(near.map(|(_, node)| node.clone()).filter(|node| self.at_node(node).len() == 3));
            }
            match nodes.pop_first() {
                Some(one) if nodes.is_empty() && !blades.contains_key(&one) => drop(blades.insert(one, node)),
                _ => {
                    let why = "is at no node of three edges that is its own";
                    report.lacking.push(format!("the {} {why}; no route is taken over it", at(node)));
                    self.obstruct(node, here, why);
                }
            }
        }
        blades
    }
}

/// Why the element of a point cannot be set from here.
fn unset(element: Node<'_, '_>) -> Option<String> {
    let drive = value(element, &["W_Kr_Gsp_Element_Allg", "W_Kr_Gsp_Stellart"]);
    if let Some(drive) = drive.filter(|drive| !drive.ends_with("_ferngestellt")) {
        return Some(format!("is set {drive}, and not from here"));
    }
    let fixed = value(element, &["Weiche_Element", "Weiche_Betriebsart"]).filter(|fixed| *fixed != "Betrieb");
    if let Some(fixed) = fixed {
        return Some(format!("is kept {fixed}"));
    }
    child(element, "ID_Weichenlaufkette").map(|_| "runs in a chain with other points".to_owned())
}
