//! Where things are on net elements, in metres: lengths, shares, chainages.

use std::collections::BTreeMap;

use roxmltree::Node;

use super::xml::{Xml, child, children, number};

/// Linear coordinates of a net element: positioning system, share of its length, measure; from its begin to its end.
pub type Measures<'a> = Vec<(&'a str, f64, f64)>;

/// Where on the tracks something is.
pub struct Places<'a> {
    /// The edge of each net element.
    pub edges: BTreeMap<&'a str, usize>,
    /// The length of each edge, in metres.
    pub lengths: Vec<f64>,
    /// The linear coordinates of each net element.
    pub measures: BTreeMap<&'a str, Measures<'a>>,
}

impl Places<'_> {
    /// The edge of a net element, and its length in metres.
    pub fn edge(&self, element: &str) -> Option<(usize, f64)> {
        let edge = *self.edges.get(element)?;
        Some((edge, *self.lengths.get(edge)?))
    }

    /// Every edge and its length in metres.
    pub fn edges(&self) -> impl Iterator<Item = (usize, f64)> + '_ {
        self.lengths.iter().copied().enumerate()
    }

    /// Metres from the begin of the net element that `at` names, by a linear coordinate: less than 0 or more than its length beyond it.
    pub fn by_chainage(&self, at: Node<'_, '_>, linear: Node<'_, '_>, length: f64) -> Option<f64> {
        let measures = self.measures.get(at.attribute("netElementRef")?)?;
        share_by(linear, measures).map(|share| share * length)
    }
}

/// The length of a net element by its own words, in metres.
pub fn length(element: Node<'_, '_>) -> Option<f64> {
    if let Some(length) = number(element, "length").filter(|length| *length > 0.0) {
        return Some(length);
    }
    if let Some(length) = chainage(element) {
        return Some(length).filter(|length| *length > 0.0);
    }
    let coordinates = element.descendants().filter(|node| node.tag_name().name() == "intrinsicCoordinate");
    let geometric = coordinates.filter_map(|node| child(node, "geometricCoordinate"));
    let corners: Vec<(f64, f64)> = geometric.filter_map(|at| number(at, "x").zip(number(at, "y"))).collect();
    let run: f64 = corners.windows(2).map(|pair| (pair[1].0 - pair[0].0).hypot(pair[1].1 - pair[0].1)).sum();
    (run > 0.0).then_some(run)
}

/// The length of a net element by its linear coordinates.
pub fn chainage(element: Node<'_, '_>) -> Option<f64> {
    let given = measures(element);
    let (system, ..) = given.first()?;
    let mut same = given.iter().filter(|(name, ..)| name == system).map(|(_, _, measure)| *measure);
    let (first, last) = (same.next()?, same.next_back()?);
    Some((last - first).abs())
}

/// Whether two words for one place or length, in metres, contradict each other: by more than a tenth of the net element, or than 20 m.
pub fn apart(one: f64, other: f64, length: f64) -> bool {
    (one - other).abs() > (length / 10.0).clamp(1.0, 20.0)
}

/// Lengths that tracks give for the one net element that they lie on.
pub fn track_lengths<'a>(xml: &Xml<'a>) -> BTreeMap<&'a str, f64> {
    let mut lengths = BTreeMap::new();
    for track in xml.all("track") {
        let on: Vec<&str> = track
            .descendants()
            .filter(|node| node.tag_name().name() == "associatedNetElement")
            .filter_map(|node| node.attribute("netElementRef"))
            .collect();
        let length = children(track, "length").find_map(|length| number(length, "value"));
        if let ([only], Some(length)) = (on.as_slice(), length.filter(|length| *length > 0.0)) {
            lengths.insert(*only, length);
        }
    }
    lengths
}

/// The linear coordinates of a net element.
pub fn measures<'a>(element: Node<'a, 'a>) -> Measures<'a> {
    let coordinates = element.descendants().filter(|node| node.tag_name().name() == "intrinsicCoordinate");
    let given = coordinates.flat_map(|node| children(node, "linearCoordinate").map(move |linear| (node, linear)));
    let mut given: Measures<'a> = given
        .filter_map(|(node, linear)| {
            let system = linear.attribute("positioningSystemRef").unwrap_or_default();
            Some((system, number(node, "intrinsicCoord")?, number(linear, "measure")?))
        })
        .collect();
    given.sort_by(|one, other| one.1.total_cmp(&other.1));
    given
}

/// Where on its net element a place with a linear coordinate is: between those two of the element's own coordinates in that system that it
/// lies between, or beyond the first or last. Nowhere where the chainage turns round on the element.
pub fn share_of(location: Node<'_, '_>, measures: &Measures<'_>) -> Option<f64> {
    share_by(child(location, "linearCoordinate")?, measures)
}

/// The same for a linear coordinate.
fn share_by(linear: Node<'_, '_>, measures: &Measures<'_>) -> Option<f64> {
    let system = linear.attribute("positioningSystemRef").unwrap_or_default();
    let measure = number(linear, "measure")?;
    let mut same: Vec<(f64, f64)> = measures.iter().filter(|at| at.0 == system).map(|at| (at.1, at.2)).collect();
    if matches!(same[..], [.., (_, begin), (_, end)] if begin > end) {
        // Downwards: looked at from the other side.
        same.reverse();
    }
    if same.windows(2).any(|pair| pair[0].1 >= pair[1].1) {
        return None;
    }
    let above = same.iter().position(|(_, at)| *at >= measure).unwrap_or(same.len());
    let above = above.clamp(1, same.len().checked_sub(1)?.max(1));
    let ((from, begin), (to, end)) = (*same.get(above - 1)?, *same.get(above)?);
    let share = from + (measure - begin) / (end - begin) * (to - from);
    share.is_finite().then_some(share)
}
