//! The ground truth of a model: which circuit follows which over which point, where signals stand, and what two tracks foul each other.
//!
//! Nothing of it comes from the layout that the kernel reads, so that a layout may be wrong about it. Circuits are numbered as in the layout;
//! sets of them are masks, a bit each.

use super::sizes::{POINTS, Small};
use atc_kernel::interlocking::{self as kernel, Position};
use serde::Serialize;

/// The way that a train goes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Heading {
    /// From left to right in the drawings.
    Up,
    /// From right to left.
    Down,
}

impl Heading {
    /// The other way.
    #[must_use]
    pub const fn turned(self) -> Self {
        match self {
            Self::Up => Self::Down,
            Self::Down => Self::Up,
        }
    }

    /// The direction of travel in the words of a layout.
    #[must_use]
    pub const fn of_layout(self) -> kernel::Heading {
        match self {
            Self::Up => kernel::Heading::Right,
            Self::Down => kernel::Heading::Left,
        }
    }
}

/// From one circuit into the next.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Edge {
    /// The circuit that is left, for a train in direction `heading`.
    pub from: u8,
    /// The circuit that is entered.
    pub to: u8,
    /// The way of the train.
    pub heading: Heading,
    /// The points that it runs over, and the position in which each leads there.
    pub over: [Option<(usize, Position)>; 2],
}

/// A signal.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Signal {
    /// The circuit at whose end it stands.
    pub at: u8,
    /// The way of the trains that it is for.
    pub heading: Heading,
    /// The circuits from which a train is too near to stop when it falls to stop.
    pub counted_on: u8,
    /// The routes that begin at it.
    pub routes: u8,
    /// By how many circuits a train may slide past it that was to stop there.
    pub slide: u8,
}

/// The tracks of a station.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Ground {
    /// The names of the circuits.
    pub circuits: &'static [&'static str],
    /// How they adjoin.
    pub edges: Vec<Edge>,
    /// The signals.
    pub signals: Vec<Signal>,
    /// The circuit in which each point lies.
    pub points_in: [u8; POINTS],
    /// Pairs of circuits in which two trains touch.
    pub fouls: Vec<(u8, u8)>,
    /// The circuits of plain line: without signals, trains keep to the telegrams there.
    pub line: u8,
    /// Where trains end: they are gone from there.
    pub ends: Vec<(u8, Heading)>,
    /// The circuits in which trains turn round.
    pub turning: u8,
    /// The circuits without a signal of their own where a train that has turned round waits for the one ahead: a mask.
    pub waits: u8,
    /// The circuits where points and sand catch a train that slides: what becomes of that train there is no accident, unless it meets another.
    pub catching: u8,
}

/// Where a point's blades are.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize)]
pub enum Blade {
    /// At rest in normal position.
    #[serde(rename = "normal")]
    Normal,
    /// At rest in reverse position.
    #[serde(rename = "reverse")]
    Reverse,
    /// Between, on the way to normal.
    #[serde(rename = "to normal")]
    ToNormal,
    /// Between, on the way to reverse.
    #[serde(rename = "to reverse")]
    ToReverse,
}

impl Blade {
    /// The position of a blade at rest.
    pub const fn rests(self) -> Option<Position> {
        match self {
            Self::Normal => Some(Position::Normal),
            Self::Reverse => Some(Position::Reverse),
            Self::ToNormal | Self::ToReverse => None,
        }
    }

    /// The position where it is, or to which it moves.
    pub const fn heads_for(self) -> Position {
        match self {
            Self::Normal | Self::ToNormal => Position::Normal,
            Self::Reverse | Self::ToReverse => Position::Reverse,
        }
    }
}

/// What comes next for a train.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ahead {
    /// The track ends.
    Nothing,
    /// This circuit.
    Circuit(u8),
    /// This circuit, but a facing point is between its positions.
    Between(u8),
    /// This circuit, over a trailing point that lies for another way: the train breaks it open.
    Trailing(u8),
}

impl Ground {
    /// What follows the circuit `from`.
    pub fn ahead(&self, from: u8, heading: Heading, blades: [Blade; POINTS]) -> Ahead {
        let mut ahead = Ahead::Nothing;
        for edge in self.edges.iter().filter(|edge| edge.from == from && edge.heading == heading) {
            let mut wrong =
                edge.over.iter().flatten().filter(|(point, lies)| blades[*point].rests() != Some(*lies)).peekable();
            if wrong.peek().is_none() {
                return Ahead::Circuit(edge.to);
            }
            let facing = wrong.any(|(point, _)| self.is_facing(*point, from, heading));
            if !facing {
                ahead = Ahead::Trailing(edge.to);
            } else if ahead == Ahead::Nothing {
                ahead = Ahead::Between(edge.to);
            }
        }
        ahead
    }

    /// Whether a train comes to the point from its toe: two edges lead over it from one circuit.
    fn is_facing(&self, point: usize, from: u8, heading: Heading) -> bool {
        let over = |edge: &&Edge| edge.over.iter().flatten().any(|(number, _)| *number == point);
        self.edges.iter().filter(|edge| edge.from == from && edge.heading == heading).filter(over).count() > 1
    }

    /// The signal at the end of a circuit.
    pub fn signal(&self, at: u8, heading: Heading) -> Option<&Signal> {
        Some(&self.signals[self.number_of_signal(at, heading)?])
    }

    /// Its place among the signals.
    pub fn number_of_signal(&self, at: u8, heading: Heading) -> Option<usize> {
        self.signals.iter().position(|signal| signal.at == at && signal.heading == heading)
    }

    /// Whether a train in any circuit of one mask and one of the other meet.
    pub fn touch(&self, one: u8, other: u8) -> bool {
        let has = |set: u8, circuit: u8| set >> circuit & 1 == 1;
        let fouls = |(a, b): &(u8, u8)| has(one, *a) && has(other, *b) || has(one, *b) && has(other, *a);
        one & other != 0 || self.fouls.iter().any(fouls)
    }
}

/// A station: its tracks, and the layout that the kernel is given.
#[derive(Clone, Debug)]
pub struct Station {
    /// Its name.
    pub name: &'static str,
    /// Its tracks.
    pub ground: Ground,
    /// What the kernel knows of them.
    pub layout: Small,
}
