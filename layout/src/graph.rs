//! The tracks as a graph: joints, and the tracks and points between them.

use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;

use crate::form::{EndKind, Position, Station};
use crate::names::Names;
use crate::problem::Problem;
use crate::rule::Rule;

/// A joint: where two tracks meet, or where one ends.
#[derive(Clone, Debug)]
pub struct Joint {
    /// Its name in the file.
    pub name: String,
    /// Where it was named first.
    pub span: Range<usize>,
    /// The tracks that reach it: one or two.
    pub tracks: Vec<usize>,
    /// What is there if it is an end.
    pub end: Option<EndKind>,
}

/// What kind of track it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// A piece with a left and a right end.
    Plain,
    /// A point, by number: toe, normal leg, reverse leg.
    Point(usize),
}

/// A piece of track inside one circuit.
#[derive(Clone, Debug)]
pub struct Track {
    /// The circuit that it is part of.
    pub circuit: usize,
    /// A plain piece or a point.
    pub kind: Kind,
    /// The joints it reaches: left and right, or toe, normal leg and reverse leg.
    pub joints: Vec<usize>,
    /// Why nothing need keep vehicles off at each of these ends, as the file says it.
    pub unprotected: Vec<Option<String>>,
}

/// The most points in one circuit.
pub const POINTS_IN_A_CIRCUIT: usize = 12;

/// The most ways through one circuit: each point has two legs.
const WAYS: usize = 1 << POINTS_IN_A_CIRCUIT;

/// The tracks of a station.
#[derive(Clone, Debug, Default)]
pub struct Graph {
    /// The joints.
    pub joints: Vec<Joint>,
    /// The pieces between them.
    pub tracks: Vec<Track>,
}

/// A point that a way runs over.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Passed {
    /// The point.
    pub point: usize,
    /// The position that the way needs.
    pub position: Position,
    /// The joint of the leg that the way does not use.
    pub other_leg: usize,
}

/// A way through one circuit.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Way {
    /// The joint where it leaves the circuit.
    pub exit: usize,
    /// The points it runs over, in order.
    pub passed: Vec<Passed>,
    /// The tracks it runs over, in order, points among them.
    pub tracks: Vec<usize>,
}

/// The reason that the file gives at an end of a track.
fn reason(problems: &mut Vec<Problem>, about: &str, given: Option<&crate::At<String>>) -> Option<String> {
    let given = given?;
    if given.trim().is_empty() {
        let what = format!("{about} lacks the reason why an end of it needs no protection");
        problems.push(Problem::new(Rule::NoFlank, &given.span, what, "say what keeps vehicles off"));
    }
    Some(given.value.clone())
}

impl Graph {
    /// The tracks of `station`, as far as they are sound, and what is wrong with them.
    pub fn of(station: &Station, names: &Names, problems: &mut Vec<Problem>) -> Self {
        let mut graph = Self::default();
        let mut numbers = BTreeMap::new();
        let mut incomplete = false;
        let mut joint = |graph: &mut Self, name: &crate::At<String>| {
            *numbers.entry(name.value.clone()).or_insert_with(|| {
                let (name, span) = (name.value.clone(), name.span.clone());
                graph.joints.push(Joint { name, span, tracks: Vec::new(), end: None });
                graph.joints.len() - 1
            })
        };
        for (circuit, given) in station.circuits.iter().enumerate() {
            for plain in given.tracks() {
                let joints = plain.joints.map(|name| joint(&mut graph, name)).to_vec();
                let about = format!("the track from {} to {}", plain.joints[0], plain.joints[1]);
                let unprotected = plain.unprotected.map(|given| reason(problems, &about, given)).to_vec();
                graph.tracks.push(Track { circuit, kind: Kind::Plain, joints, unprotected });
            }
            match (&given.left, &given.right) {
                (Some(_), Some(_)) => {}
                (None, None) => {
                    if !station.points.iter().any(|point| point.circuit.value == given.name.value) {
                        let what = format!("circuit {} has no track in it", given.name);
                        let right = "name its joints as left and right, or put a point in it";
                        problems.push(Problem::new(Rule::Joint, &given.name.span, what, right));
                    }
                }
                (Some(one), None) | (None, Some(one)) => {
                    incomplete = true;
                    let what = format!("circuit {} has only one end", given.name);
                    problems.push(Problem::new(Rule::Joint, &one.span, what, "name both joints, left and right"));
                }
            }
        }
        for (number, point) in station.points.iter().enumerate() {
            let Some(circuit) = names.circuit(&point.circuit, problems) else { continue };
            let joints = [&point.toe, &point.normal, &point.reverse].map(|name| joint(&mut graph, name)).to_vec();
            let ends = [&point.toe_unprotected, &point.normal_unprotected, &point.reverse_unprotected];
            let about = format!("point {}", point.name);
            let unprotected = ends.map(|given| reason(problems, &about, given.as_ref())).to_vec();
            graph.tracks.push(Track { circuit, kind: Kind::Point(number), joints, unprotected });
        }
        for (number, track) in graph.tracks.iter().enumerate() {
            for joint in &track.joints {
                graph.joints[*joint].tracks.push(number);
            }
        }
        for end in &station.ends {
            match numbers.get(&end.joint.value) {
                Some(joint) if graph.joints[*joint].end.is_some() => problems.push(Problem::new(
                    Rule::NameTwice,
                    &end.joint.span,
                    format!("joint {} is given two ends", end.joint),
                    "say once whether the line goes on there",
                )),
                Some(joint) => graph.joints[*joint].end = Some(end.kind),
                None => problems.push(Problem::new(
                    Rule::NoSuchName,
                    &end.joint.span,
                    format!("no circuit or point reaches the end {}", end.joint),
                    "name a joint of a circuit or a point",
                )),
            }
        }
        let before = problems.len();
        graph.check(problems);
        if incomplete {
            // The joints of the track that is not there would be called open.
            let kept: Vec<Problem> =
                problems.drain(before..).filter(|problem| problem.rule != Rule::OpenJoint).collect();
            problems.extend(kept);
        }
        graph
    }

    /// The track of a point.
    pub fn of_point(&self, point: usize) -> Option<usize> {
        self.tracks.iter().position(|track| track.kind == Kind::Point(point))
    }

    fn check(&mut self, problems: &mut Vec<Problem>) {
        for joint in &mut self.joints {
            let name = &joint.name;
            let (what, right) = match (joint.tracks.len(), joint.end) {
                (1, Some(_)) | (2, None) if joint.tracks.first() != joint.tracks.get(1) => continue,
                (1, None) => {
                    let what = format!("only one track reaches joint {name}");
                    let right = "name it at the track it leads to, or declare it in [[end]] as buffer or line";
                    problems.push(Problem::new(Rule::OpenJoint, &joint.span, what, right));
                    continue;
                }
                (2, Some(_)) => (format!("joint {name} is an end, and two tracks reach it"), "leave out the [[end]]"),
                (2, None) => (format!("both ends of one track reach joint {name}"), "give the ends different joints"),
                (count, _) => (
                    format!("{count} tracks reach joint {name}"),
                    "a joint connects two; give the others names of their own",
                ),
            };
            problems.push(Problem::new(Rule::Joint, &joint.span, what, right));
            // What follows may count on two.
            joint.tracks.truncate(2);
        }
    }

    /// The circuits that reach a joint.
    pub fn circuits_at(&self, joint: usize) -> impl Iterator<Item = usize> + '_ {
        self.joints[joint].tracks.iter().map(|track| self.tracks[*track].circuit)
    }

    /// The circuit on the other side of a joint from `circuit`; none at an end.
    pub fn across(&self, joint: usize, circuit: usize) -> Option<usize> {
        self.circuits_at(joint).find(|other| *other != circuit)
    }

    /// The joints between two circuits.
    pub fn between(&self, one: usize, other: usize) -> Vec<usize> {
        let reached = |joint: &usize| {
            let at: BTreeSet<_> = self.circuits_at(*joint).collect();
            one != other && at.contains(&one) && at.contains(&other)
        };
        (0..self.joints.len()).filter(reached).collect()
    }

    /// The joints where a circuit ends: towards others, and ends of the tracks.
    pub fn borders(&self, circuit: usize) -> Vec<usize> {
        let border = |joint: &usize| {
            let mut at = self.circuits_at(*joint);
            let first = at.next();
            match at.next() {
                Some(second) => first != Some(second) && (first == Some(circuit) || second == circuit),
                None => first == Some(circuit),
            }
        };
        (0..self.joints.len()).filter(border).collect()
    }

    /// Every way that leads from `joint` into `circuit` and out of it: of a circuit that has no more points than one may have.
    pub fn ways(&self, circuit: usize, joint: usize) -> Vec<Way> {
        let mut found = Vec::new();
        let enters = |track: &usize| self.tracks[*track].circuit == circuit;
        for track in self.joints[joint].tracks.iter().copied().filter(enters) {
            // From an inner joint a train would come out of either track; ways start at borders only.
            self.follow(joint, track, &mut Vec::new(), &mut Vec::new(), &mut found);
        }
        found
    }

    fn follow(&self, from: usize, track: usize, seen: &mut Vec<usize>, passed: &mut Vec<Passed>, found: &mut Vec<Way>) {
        if seen.contains(&track) || found.len() >= WAYS {
            return;
        }
        seen.push(track);
        for (exit, over) in self.moves(track, from) {
            passed.extend(over);
            let circuit = self.tracks[track].circuit;
            let next = self.joints[exit].tracks.iter().copied().find(|next| *next != track);
            match next.filter(|next| self.tracks[*next].circuit == circuit) {
                Some(next) => self.follow(exit, next, seen, passed, found),
                None => found.push(Way { exit, passed: passed.clone(), tracks: seen.clone() }),
            }
            if over.is_some() {
                passed.pop();
            }
        }
        seen.pop();
    }

    /// Where a train can leave a track that it entered at `from`, and the point that it runs over.
    pub fn moves(&self, track: usize, from: usize) -> Vec<(usize, Option<Passed>)> {
        let track = &self.tracks[track];
        match (track.kind, track.joints.as_slice()) {
            (Kind::Plain, [left, right]) => vec![(if *left == from { *right } else { *left }, None)],
            (Kind::Point(point), [toe, normal, reverse]) => {
                let over_normal = Passed { point, position: Position::Normal, other_leg: *reverse };
                let over_reverse = Passed { point, position: Position::Reverse, other_leg: *normal };
                if from == *toe {
                    vec![(*normal, Some(over_normal)), (*reverse, Some(over_reverse))]
                } else if from == *normal {
                    vec![(*toe, Some(over_normal))]
                } else {
                    vec![(*toe, Some(over_reverse))]
                }
            }
            _ => Vec::new(),
        }
    }
}
