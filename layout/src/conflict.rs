//! Why two routes cannot be held together.

use crate::model::{Model, Route};

/// A reason for which two routes exclude each other.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Reason {
    /// Their paths share a circuit.
    Circuit,
    /// They need a point in opposite positions.
    Point,
    /// The overlap of one has a circuit of the other's path or overlap, and the other does not continue it.
    Overlap,
    /// A circuit beside the path or overlap of one is the other's, or fouls it.
    Beside,
    /// The berth of one has the last circuit of the other, until the other's train stands there and its overlap is given up.
    Berth,
    /// They start from one circuit in opposite directions.
    Start,
    /// The file declares it.
    Declared,
    /// They need opposite directions of a segment.
    Direction,
}

impl Reason {
    /// A word for it.
    pub const fn word(self) -> &'static str {
        match self {
            Self::Circuit => "circuit",
            Self::Point => "point",
            Self::Overlap => "overlap",
            Self::Beside => "beside",
            Self::Berth => "berth",
            Self::Start => "start",
            Self::Declared => "declared",
            Self::Direction => "direction",
        }
    }

    /// A letter for it.
    pub const fn letter(self) -> char {
        match self {
            Self::Circuit => 'c',
            Self::Point => 'p',
            Self::Overlap => 'o',
            Self::Beside => 'f',
            Self::Berth => 'e',
            Self::Start => 'b',
            Self::Declared => 'd',
            Self::Direction => 's',
        }
    }
}

/// Every reason for which the routes number `one` and `other` exclude each other while both are held whole; none for a route and
/// itself.
pub fn reasons(model: &Model, one: usize, other: usize) -> Vec<Reason> {
    let (a, b) = (&model.routes[one], &model.routes[other]);
    if one == other {
        return Vec::new();
    }
    let meets = |a: &Route, b: &Route| a.circuits().any(|circuit| b.circuits().any(|same| same == circuit));
    let touches = |overlap: &Route, path: &Route, last: bool| {
        path.circuits().any(|circuit| overlap.overlap.contains(&circuit) && (path.last() == Some(circuit)) == last)
    };
    let ends = |overlap: &Route, path: &Route| overlap.calling_on && touches(overlap, path, true);
    let under = |overlap: &Route, number: usize, path: &Route| {
        let touched = touches(overlap, path, false) || touches(overlap, path, true) && !overlap.calling_on;
        touched && !overlap.continuing.contains(&number)
    };
    let beside = |a: &Route, number: usize, b: &Route| {
        let beside = a.beside();
        let goes_on = a.continuing.contains(&number);
        b.circuits().any(|over| beside.contains(&over)) && !goes_on
            || b.overlap.iter().any(|over| beside.contains(over))
    };
    let overlaps = a.overlap.iter().any(|circuit| b.overlap.contains(circuit));
    let opposed =
        a.positions().any(|(point, position)| b.positions().any(|(same, needed)| same == point && needed != position));
    let starts = a.opposes_the_start_of(b);
    let opposite = |a: &Route, b: &Route| a.from.is_some() && a.from == b.to;
    let all = [
        (meets(a, b), Reason::Circuit),
        (opposed, Reason::Point),
        (overlaps || under(a, other, b) || under(b, one, a), Reason::Overlap),
        (beside(a, other, b) || beside(b, one, a), Reason::Beside),
        (ends(a, b) || ends(b, a), Reason::Berth),
        (starts, Reason::Start),
        (!starts && (a.conflicts.contains(&other) || b.conflicts.contains(&one)), Reason::Declared),
        (opposite(a, b) || opposite(b, a), Reason::Direction),
    ];
    all.into_iter().filter_map(|(holds, reason)| holds.then_some(reason)).collect()
}
