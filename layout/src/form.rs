//! The form of a layout file: what may stand in it, with units, ranges and defaults.
//!
//! Tracks are described by *joints*: each end of a circuit, and each leg of a point, names the joint that it reaches. A joint that is
//! named twice connects the two; one that is named once is an end of the tracks and needs an `[[end]]`.

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::de::value::MapAccessDeserializer;
use serde::de::{MapAccess, Visitor};
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use crate::at::At;
use crate::values::{Braking, Overlaps, Speeds, Times};

/// The layout of a station.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Station {
    /// The station's name.
    pub name: String,
    /// The length of the longest train, in metres: at least 1.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub longest_train_m: Option<At<u16>>,
    /// The length of the shortest train, in metres [default: 0]. Where the shunt may be lost for long, short circuits need it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub shortest_train_m: Option<At<u16>>,
    /// Whether every train acts on telegrams alone: no driver acts on what he sees of an optical signal.
    #[serde(default, skip_serializing_if = "is_false")]
    pub cab_signalled: bool,
    /// Times for the whole station.
    #[serde(default)]
    pub times: Times,
    /// The brake, and the speeds of the codes.
    #[serde(default)]
    pub braking: Braking,
    /// Speeds where a route names none.
    #[serde(default)]
    pub speed: Speeds,
    /// What is asked of overlaps.
    #[serde(default)]
    pub overlaps: Overlaps,
    /// The track circuits.
    #[serde(default, rename = "circuit")]
    pub circuits: Vec<Circuit>,
    /// The points.
    #[serde(default, rename = "point", skip_serializing_if = "Vec::is_empty")]
    pub points: Vec<Point>,
    /// Where tracks end.
    #[serde(default, rename = "end", skip_serializing_if = "Vec::is_empty")]
    pub ends: Vec<End>,
    /// Stretches of plain line to the neighbouring stations.
    #[serde(default, rename = "segment", skip_serializing_if = "Vec::is_empty")]
    pub segments: Vec<Segment>,
    /// Circuits between which there is no room for two trains, beyond those that share a point.
    #[serde(default, rename = "fouling", skip_serializing_if = "Vec::is_empty")]
    pub fouling: Vec<Fouling>,
    /// Platforms, for the drawing.
    #[serde(default, rename = "platform", skip_serializing_if = "Vec::is_empty")]
    pub platforms: Vec<Platform>,
    /// The routes.
    #[serde(default, rename = "route")]
    pub routes: Vec<Route>,
}

#[allow(clippy::trivially_copy_pass_by_ref, reason = "serde gives a reference")]
const fn is_false(value: &bool) -> bool {
    !*value
}

/// A track circuit. One with points in it has no `left` and `right` of its own: its points name the joints.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Circuit {
    /// Its name.
    pub name: At<String>,
    /// The length of the shortest way through it, in metres.
    pub length_m: At<u16>,
    /// The steepest gradient in it, in thousandths, whichever way it falls.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub gradient: Option<At<i8>>,
    /// The joint at its left end.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub left: Option<At<String>>,
    /// The joint at its right end.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub right: Option<At<String>>,
    /// Why it is safe that nothing keeps vehicles off this track at its left end, while a route crosses it or a line is beside it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub left_unprotected: Option<At<String>>,
    /// The same at its right end.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub right_unprotected: Option<At<String>>,
    /// Further tracks through the same circuit, which cross the first on the level.
    #[serde(default, rename = "crossing", skip_serializing_if = "Vec::is_empty")]
    pub crossings: Vec<Crossing>,
}

/// A track through a circuit that is no point.
#[derive(Clone, Copy, Debug)]
pub struct Plain<'a> {
    /// The joints at its left and right end.
    pub joints: [&'a At<String>; 2],
    /// Why nothing need keep vehicles off at these ends.
    pub unprotected: [Option<&'a At<String>>; 2],
}

impl Circuit {
    /// Its tracks but for its points: its own, if both ends of it are named, and those that cross it.
    pub fn tracks(&self) -> impl Iterator<Item = Plain<'_>> {
        let own = self.left.as_ref().zip(self.right.as_ref()).map(|(left, right)| Plain {
            joints: [left, right],
            unprotected: [self.left_unprotected.as_ref(), self.right_unprotected.as_ref()],
        });
        own.into_iter().chain(self.crossings.iter().map(|crossing| Plain {
            joints: [&crossing.left, &crossing.right],
            unprotected: [crossing.left_unprotected.as_ref(), crossing.right_unprotected.as_ref()],
        }))
    }

    /// The reasons at the left and right end of one of [`Circuit::tracks`], to be given; none if it has not so many.
    pub(crate) fn unprotected_mut(&mut self, track: usize) -> Option<[&mut Option<At<String>>; 2]> {
        let own = usize::from(self.left.is_some() && self.right.is_some());
        match track.checked_sub(own) {
            None => Some([&mut self.left_unprotected, &mut self.right_unprotected]),
            Some(crossing) => {
                let crossing = self.crossings.get_mut(crossing)?;
                Some([&mut crossing.left_unprotected, &mut crossing.right_unprotected])
            }
        }
    }
}

/// A track that crosses another one of the same circuit.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Crossing {
    /// The joint at its left end.
    pub left: At<String>,
    /// The joint at its right end.
    pub right: At<String>,
    /// Why it is safe that nothing keeps vehicles off it at its left end, while a route runs over another track of the circuit.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub left_unprotected: Option<At<String>>,
    /// The same at its right end.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub right_unprotected: Option<At<String>>,
}

/// A point. A double slip is two points of one circuit that have the joint at their toes in common.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Point {
    /// Its name.
    pub name: At<String>,
    /// The circuit that it lies in.
    pub circuit: At<String>,
    /// The joint that its toe reaches. Inside a circuit, a joint is a name that two points of the circuit share.
    pub toe: At<String>,
    /// The joint that its normal leg reaches.
    pub normal: At<String>,
    /// The joint that its reverse leg reaches.
    pub reverse: At<String>,
    /// The circuits whose occupation says that a train may stand on the point or foul it [default: `circuit` and `fouled_in`].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub detectors: Option<Vec<At<String>>>,
    /// Other circuits in which a train fouls the point.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub fouled_in: Vec<At<String>>,
    /// The longest time of its stroke, in ms [default: that of `[times]`].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub throw_ms: Option<At<u32>>,
    /// Why it is safe that nothing keeps vehicles off its toe while a route runs through its circuit on a track that is not joined to it there.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub toe_unprotected: Option<At<String>>,
    /// Why it is safe that nothing keeps trains off the normal leg while a route runs over the reverse one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub normal_unprotected: Option<At<String>>,
    /// Why it is safe that nothing keeps trains off the reverse leg while a route runs over the normal one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub reverse_unprotected: Option<At<String>>,
}

/// An end of the tracks.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct End {
    /// The joint.
    pub joint: At<String>,
    /// What is there.
    pub kind: EndKind,
}

/// What is at an end of the tracks.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum EndKind {
    /// A buffer stop: no train comes from there.
    Buffer,
    /// The line goes on where this device does not see it.
    Line,
}

/// A stretch of plain line.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Segment {
    /// Its name.
    pub name: At<String>,
    /// Its circuits, the one next to the station first.
    pub circuits: Vec<At<String>>,
    /// The last circuit of every route that goes out to it [default: what those routes have in common].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub throat: Option<At<String>>,
    /// The name of the line, which the neighbour's file gives it too.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub line: Option<At<String>>,
    /// Its outermost circuits, in the same order, that the neighbour's device sees too, under the same names.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub shared: Vec<At<String>>,
    /// The highest speed on it, in km/h: at most that of the line [default: that].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub speed_kmh: Option<At<u16>>,
}

/// Two circuits between which there is no room for two trains: a route over one of them proves the other clear.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Fouling {
    /// The two circuits.
    pub between: [At<String>; 2],
}

/// A platform.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Platform {
    /// Its name.
    pub name: String,
    /// The circuits along it.
    pub circuits: Vec<At<String>>,
}

/// A route: from the signal at the joint of `entry` and `path` to the end of the last circuit.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Route {
    /// Its name.
    pub name: At<String>,
    /// The signal at its start [default: the route's name].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub signal: Option<String>,
    /// The circuit in rear of the signal, where the train waits.
    pub entry: At<String>,
    /// The circuits of the path in order of travel, with the points that they need.
    pub path: Vec<At<Element>>,
    /// What is kept free beyond the end, in order of travel.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub overlap: Vec<At<Element>>,
    /// A calling-on route: the occupied track behind the end, in order of travel, into which its train goes on sight. Such a route has no overlap.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub berth: Vec<At<Element>>,
    /// Circuits that are proved clear and not run over, as long as any of the path is held. What a pair in `[[fouling]]` says need not be said here: it
    /// is released place by place.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub proved_clear: Vec<At<String>>,
    /// Why the overlap may be shorter than the least one, or missing.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub short_overlap: Option<At<String>>,
    /// Why no train changes ends where the route ends; asked only where a point or a crossing lies between there and the first signal on the way back.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub no_reversal: Option<At<String>>,
    /// The circuits on which a train may be that counts on the signal [default: back to where a braking train is covered, and all of the track before
    /// the signal, as far as the next point, buffer stop, other signal, or plain line].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub approach: Option<Vec<At<String>>>,
    /// The highest speed at which a train comes up to the signal, in km/h [default: that of the line].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub approach_kmh: Option<At<u16>>,
    /// The circuits that adjoin the end [default: the neighbours there].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub beyond: Option<Vec<At<String>>>,
    /// The routes that go on where this one ends [default: those whose signal stands there].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub continuing: Option<Vec<At<String>>>,
    /// Routes that must not be held together with this one although they share neither a circuit nor a point.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub conflicts: Vec<At<String>>,
    /// The segment that the train comes from [default: that of `entry`].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub from: Option<At<String>>,
    /// The segment that the train goes out to [default: that of the circuit beyond the end].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub to: Option<At<String>>,
    /// The highest speed on the route, in km/h [default: that of `[speed]`]; of a calling-on route at most `calling_on_kmh`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub speed_kmh: Option<At<u16>>,
    /// How long the points may take to arrive, in ms [default: that of `[times]`].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub drive_ms: Option<At<u32>>,
    /// How long the route stays locked after it was withdrawn with a train coming, in ms [default: that of `[times]`].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub release_ms: Option<At<u32>>,
    /// How long the train stands before the overlap is given up, in ms [default: that of `[times]`].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stay_ms: Option<At<u32>>,
}

/// A position of a point.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Position {
    /// Its normal position.
    Normal,
    /// The other one.
    Reverse,
}

/// A place of a path: the name of a circuit, or a circuit with the positions of points that it needs.
#[derive(Clone, Debug, Default, PartialEq, JsonSchema)]
#[schemars(with = "ElementForm")]
pub struct Element {
    /// The circuit.
    pub circuit: String,
    /// Positions, where the tracks do not say them: the way through the circuit leaves several, or for flank protection.
    pub points: BTreeMap<String, At<Position>>,
}

#[derive(JsonSchema)]
#[serde(untagged)]
#[allow(dead_code, reason = "the schema alone is made of it")]
enum ElementForm {
    Circuit(String),
    WithPoints(WithPoints),
}

#[derive(Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct WithPoints {
    circuit: String,
    #[serde(default)]
    points: BTreeMap<String, At<Position>>,
}

impl<'de> Deserialize<'de> for Element {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Forms;
        impl<'de> Visitor<'de> for Forms {
            type Value = Element;

            fn expecting(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                f.write_str("the name of a circuit, or { circuit = \"…\", points = { … = \"normal\" } }")
            }

            fn visit_str<E>(self, circuit: &str) -> Result<Element, E> {
                Ok(Element { circuit: circuit.to_owned(), points: BTreeMap::new() })
            }

            fn visit_map<M: MapAccess<'de>>(self, map: M) -> Result<Element, M::Error> {
                let WithPoints { circuit, points } = WithPoints::deserialize(MapAccessDeserializer::new(map))?;
                Ok(Element { circuit, points })
            }
        }
        deserializer.deserialize_any(Forms)
    }
}

impl Serialize for Element {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        if self.points.is_empty() {
            return serializer.serialize_str(&self.circuit);
        }
        WithPoints { circuit: self.circuit.clone(), points: self.points.clone() }.serialize(serializer)
    }
}
