//! A train on the parts of a path, in the order in which it meets them.

use roxmltree::Node;

use super::plan::{Part, Plan, metres, parts, text};
use crate::form::Position;

/// How far from a signal its path and the border of its sections may lie, in metres.
pub(super) const OFFSET: f64 = 20.0;

/// What is lost in the digits of figures at nodes, in metres.
const LOST: f64 = 0.5;

/// A stretch of an edge as a train runs over it.
struct Leg {
    edge: String,
    toward_b: bool,
    /// Metres from node A where it comes in, and where it leaves.
    ends: [f64; 2],
    /// Metres from the signal to where it comes in; less than 0 in rear of it.
    run: f64,
}

/// The run of a train from a signal to an exit, with some metres in rear of the one and beyond the other.
pub(super) struct Run {
    legs: Vec<Leg>,
    /// Metres from the signal to the exit.
    pub(super) length: f64,
}

/// Where an object stands, if it is one place with one direction: edge, metres from node A, toward node B.
fn standing(node: Node<'_, '_>) -> Option<(String, f64, bool)> {
    let mut places = node.children().filter(|child| child.has_tag_name("Punkt_Objekt_TOP_Kante"));
    let (place, None) = (places.next()?, places.next()) else { return None };
    let toward_b = match text(place, "Wirkrichtung")? {
        "in" => true,
        "gegen" => false,
        _ => return None,
    };
    Some((text(place, "ID_TOP_Kante")?.to_lowercase(), metres(place, "Abstand")?, toward_b))
}

impl Run {
    /// The run over a path, from its start to its end.
    pub(super) fn of<'a>(plan: &Plan<'a>, course: Node<'a, 'a>) -> Result<Self, String> {
        let place = |name: &str| plan.at(course, name).and_then(standing);
        let (edge, at, toward_b) = place("ID_Start").ok_or("the file gives its signal no one place and direction")?;
        let exit = place("ID_Ziel").ok_or("the file gives its exit no one place and direction")?;
        let mut left = parts(course);
        let begins = |part: &Part| {
            let border = if toward_b { part.1 } else { part.2 };
            let reaches = if toward_b { part.2 > at } else { part.1 < at };
            part.0 == edge && (border - at).abs() <= OFFSET && reaches
        };
        let first = left.iter().position(begins).ok_or("in the file its path does not begin at its signal")?;
        let part = left.swap_remove(first);
        let mut run = Self { legs: Vec::new(), length: 0.0 };
        run.push(&part.0, toward_b, [at, if toward_b { part.2 } else { part.1 }], 0.0);
        while !left.is_empty() {
            let (node, joined, done) = run.leaves(plan).ok_or("in the file its path stops before its end")?;
            let mut next: Vec<(usize, bool)> = Vec::new();
            for (number, part) in left.iter().enumerate() {
                let Some(edge) = plan.edges.get(&part.0) else { continue };
                for (is_b, end) in [(false, 0), (true, 1)] {
                    let comes = if is_b { part.2 >= edge.length - LOST } else { part.1 <= LOST };
                    if edge.nodes[end] == node && comes && leads(&joined, &edge.joined[end], plan.joined_at(&node)) {
                        next.push((number, is_b));
                    }
                }
            }
            let [(number, is_b)] = next[..] else {
                return Err("in the file the parts of its path are not one way".to_owned());
            };
            let part = left.swap_remove(number);
            let ends = if is_b { [part.2, part.1] } else { [part.1, part.2] };
            run.push(&part.0, !is_b, ends, done);
        }
        let last = run.legs.last().ok_or("the file gives its path no parts")?;
        let fits = last.edge == exit.0 && last.toward_b == exit.2 && (last.ends[1] - exit.1).abs() <= OFFSET;
        if !fits {
            return Err("in the file its path does not end at its exit".to_owned());
        }
        run.length = last.run + (exit.1 - last.ends[0]) * if last.toward_b { 1.0 } else { -1.0 };
        run.extend(plan, (edge, at, toward_b), exit.1);
        Ok(run)
    }

    fn push(&mut self, edge: &str, toward_b: bool, ends: [f64; 2], run: f64) {
        self.legs.push(Leg { edge: edge.to_owned(), toward_b, ends, run });
    }

    /// The node to which the last leg leads, how it is joined there, and metres from the signal.
    fn leaves(&self, plan: &Plan<'_>) -> Option<(String, String, f64)> {
        let leg = self.legs.last()?;
        let edge = plan.edges.get(&leg.edge)?;
        let end = if leg.toward_b { edge.length } else { 0.0 };
        let is_there = (leg.ends[1] - end).abs() <= LOST;
        let place = usize::from(leg.toward_b);
        is_there.then(|| {
            (edge.nodes[place].clone(), edge.joined[place].clone(), leg.run + (leg.ends[1] - leg.ends[0]).abs())
        })
    }

    /// Goes on beyond the exit, and back from the signal, as far as a border may be looked for: over nodes that do not fork.
    fn extend(&mut self, plan: &Plan<'_>, (edge, at, toward_b): (String, f64, bool), exit: f64) {
        let beyond = |id: &str, toward_b: bool, from: f64, far: f64| -> Vec<(String, bool, [f64; 2], f64)> {
            let mut found = Vec::new();
            let (mut id, mut toward_b, mut from, mut run) = (id.to_owned(), toward_b, from, 0.0);
            // No more edges than there are: those of no length may form a ring.
            for _ in 0..plan.edges.len() {
                let Some(edge) = plan.edges.get(&id) else { break };
                let end = if toward_b { edge.length } else { 0.0 };
                let to = if toward_b { (from + far - run).min(end) } else { (from - far + run).max(end) };
                found.push((id.clone(), toward_b, [from, to], run));
                run += (to - from).abs();
                let node = edge.nodes[usize::from(toward_b)].clone();
                if run >= far - 0.001 || plan.joined_at(&node) != 2 {
                    break;
                }
                let next =
                    plan.edges.iter().flat_map(|(other, edge)| [(other, edge, false), (other, edge, true)]).find(
                        |(other, edge, is_b)| {
                            edge.nodes[usize::from(*is_b)] == node && (**other != id || *is_b != toward_b)
                        },
                    );
                let Some((other, edge, is_b)) = next else { break };
                (from, toward_b) = (if is_b { edge.length } else { 0.0 }, !is_b);
                id.clone_from(other);
            }
            found
        };
        if let Some(last) = self.legs.last_mut() {
            last.ends[1] = exit;
            let (id, toward_b) = (last.edge.clone(), last.toward_b);
            for (edge, toward_b, ends, run) in beyond(&id, toward_b, exit, 2.0 * OFFSET) {
                self.push(&edge, toward_b, ends, self.length + run);
            }
        }
        for (edge, back, ends, run) in beyond(&edge, !toward_b, at, 2.0 * OFFSET) {
            let to = run + (ends[1] - ends[0]).abs();
            self.push(&edge, !back, [ends[1], ends[0]], -to);
        }
        self.legs.sort_by(|one, other| one.run.total_cmp(&other.run));
    }

    /// Where the train is in each section: from and to, in metres from the signal.
    pub(super) fn inside(&self, sections: &[(String, Vec<Part>)]) -> Vec<(String, f64, f64)> {
        let mut found: Vec<(String, f64, f64)> = Vec::new();
        for (name, parts) in sections {
            for (from, to) in self.within(parts) {
                // On over a node, or a border between two parts of one section.
                match found.iter_mut().find(|(other, _, end)| other == name && (from - *end).abs() <= LOST) {
                    Some((_, _, end)) => *end = to,
                    None => found.push((name.clone(), from, to)),
                }
            }
        }
        found
    }

    /// The stretches of the run that lie on these parts, in order.
    fn within(&self, parts: &[Part]) -> Vec<(f64, f64)> {
        let mut found = Vec::new();
        for leg in &self.legs {
            for (edge, low, high) in parts {
                let [from, to] = leg.ends;
                let (low, high) = (low.max(from.min(to)), high.min(from.max(to)));
                if *edge == leg.edge && high - low > 0.001 {
                    let begin = leg.run + if leg.toward_b { low - from } else { from - high };
                    found.push((begin, begin + high - low));
                }
            }
        }
        found.sort_by(|one, other| one.0.total_cmp(&other.0));
        found
    }

    /// Whether parts lie on the run between two places of it.
    pub(super) fn touches(&self, parts: &[Part], begin: f64, end: f64) -> bool {
        self.within(parts).iter().any(|(from, to)| to.min(end) - from.max(begin) > 0.01)
    }

    /// Whether an object stands on the run between two places of it.
    pub(super) fn meets(&self, node: Node<'_, '_>, begin: f64, end: f64) -> bool {
        let places = node.children().filter(|child| child.has_tag_name("Punkt_Objekt_TOP_Kante"));
        let mut parts = places.filter_map(|place| {
            let at = metres(place, "Abstand")?;
            Some((text(place, "ID_TOP_Kante")?.to_lowercase(), at - LOST, at + LOST))
        });
        parts.any(|part| self.touches(&[part], begin, end))
    }

    /// The signals that stand on the run, for either direction, with metres from its own.
    pub(super) fn signals(&self, plan: &Plan<'_>) -> Vec<(String, f64)> {
        let mut found = Vec::new();
        for node in plan.kind("Signal") {
            let Some((edge, at, _)) = standing(node) else { continue };
            for leg in self.legs.iter().filter(|leg| leg.edge == edge) {
                let [from, to] = leg.ends;
                if (from.min(to)..=from.max(to)).contains(&at) {
                    found.push((plan.call(node), leg.run + (at - from).abs()));
                }
            }
        }
        found
    }

    /// The forks that the train runs over: the blades there if the file has any, whether by the left leg, and metres from the signal.
    pub(super) fn legs<'a>(&self, plan: &Plan<'a>) -> Vec<(Option<Node<'a, 'a>>, bool, f64)> {
        self.nodes(plan).into_iter().map(|(node, is_left, at)| (plan.blades.get(&node).copied(), is_left, at)).collect()
    }

    /// The points that the train runs over, by name, with the position in which it needs them and metres from the signal.
    pub(super) fn forks(&self, plan: &Plan<'_>) -> Vec<(String, Position, f64)> {
        let all = self.nodes(plan).into_iter().map(|(node, is_left, at)| {
            let (name, blades, element) = named(plan, &node);
            (name, position(blades, element, is_left), at)
        });
        all.collect()
    }

    /// The nodes of three edges that the train runs over, by the left leg or the right one.
    pub(super) fn nodes(&self, plan: &Plan<'_>) -> Vec<(String, bool, f64)> {
        let mut found = Vec::new();
        for pair in self.legs.windows(2) {
            let (Some(one), Some(other)) = (plan.edges.get(&pair[0].edge), plan.edges.get(&pair[1].edge)) else {
                continue;
            };
            let (out, into) = (usize::from(pair[0].toward_b), usize::from(!pair[1].toward_b));
            let node = &one.nodes[out];
            if plan.joined_at(node) != 3 || other.nodes[into] != *node || pair[0].edge == pair[1].edge {
                continue;
            }
            let leg = if one.joined[out] == "Spitze" { &other.joined[into] } else { &one.joined[out] };
            found.push((node.clone(), leg == "Links", pair[1].run));
        }
        found
    }
}

/// What the point at a node is called, its blades and its element.
pub(super) fn named<'a>(plan: &Plan<'a>, node: &str) -> (String, Option<Node<'a, 'a>>, Option<Node<'a, 'a>>) {
    let blades = plan.blades.get(node).copied();
    let element = blades.and_then(|blades| plan.at(blades, "ID_W_Kr_Gsp_Element"));
    let name = element.or_else(|| plan.object(node)).map_or_else(|| node.to_owned(), |one| plan.call(one));
    (name, blades, element)
}

/// The position of a point for a leg: normal is the main track's, or the preferred one, or the left.
pub(super) fn position(blades: Option<Node<'_, '_>>, element: Option<Node<'_, '_>>, is_left: bool) -> Position {
    let main = blades.and_then(|blades| text(blades, "Zungenpaar/Stammgleis"));
    let preferred = element.and_then(|element| text(element, "Weiche_Element/Weiche_Vorzugslage"));
    let main_is_left = main.or(preferred).is_none_or(|side| !side.eq_ignore_ascii_case("rechts"));
    if main_is_left == is_left { Position::Normal } else { Position::Reverse }
}

/// Whether a train can run from one edge to another at a node: from the toe of a fork to a leg, from a leg to the toe, or on where two edges
/// meet.
fn leads(from: &str, to: &str, joined: usize) -> bool {
    let is_leg = |word: &str| word == "Links" || word == "Rechts";
    match joined {
        2 => true,
        3 => from == "Spitze" && is_leg(to) || is_leg(from) && to == "Spitze",
        _ => false,
    }
}

/// Whole millimetres, to have places in order.
pub(super) fn millimetres(metres: f64) -> i64 {
    #[expect(clippy::cast_possible_truncation, reason = "a run is far shorter than the range of the type")]
    let whole = (metres * 1000.0).round() as i64;
    whole
}

/// And back.
pub(super) fn metres_of(millimetres: i64) -> f64 {
    #[expect(clippy::cast_precision_loss, reason = "a run is far shorter than the range of the type")]
    let metres = millimetres as f64;
    metres / 1000.0
}
