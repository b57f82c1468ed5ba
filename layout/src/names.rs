//! Names and the numbers that stand for them.

use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;

use crate::at::At;
use crate::form::Station;
use crate::problem::Problem;
use crate::rule::Rule;

/// The things of a station by name; their numbers are the order of the file.
#[derive(Clone, Debug, Default)]
pub struct Names {
    circuits: BTreeMap<String, usize>,
    points: BTreeMap<String, usize>,
    segments: BTreeMap<String, usize>,
    routes: BTreeMap<String, usize>,
}

impl Names {
    /// The names of `station`; a name that comes twice is a problem.
    pub fn of(station: &Station, problems: &mut Vec<Problem>) -> Self {
        if station.name.trim().is_empty() {
            problems.push(Problem::new(Rule::Range, &(0..0), "the station has an empty name", "give it one"));
        }
        Self {
            circuits: number("circuit", station.circuits.iter().map(|circuit| &circuit.name), problems),
            points: number("point", station.points.iter().map(|point| &point.name), problems),
            segments: number("segment", station.segments.iter().map(|segment| &segment.name), problems),
            routes: number("route", station.routes.iter().map(|route| &route.name), problems),
        }
    }

    /// The number of a circuit.
    pub fn circuit(&self, name: &At<String>, problems: &mut Vec<Problem>) -> Option<usize> {
        find("circuit", &self.circuits, name, &name.span, problems)
    }

    /// The circuits of a list of names.
    pub fn circuits(&self, given: &[At<String>], problems: &mut Vec<Problem>) -> BTreeSet<usize> {
        given.iter().filter_map(|name| self.circuit(name, problems)).collect()
    }

    /// The number of a circuit whose name stands inside something at `span`.
    pub fn circuit_at(&self, name: &str, span: &Range<usize>, problems: &mut Vec<Problem>) -> Option<usize> {
        find("circuit", &self.circuits, name, span, problems)
    }

    /// The number of a point.
    pub fn point_at(&self, name: &str, span: &Range<usize>, problems: &mut Vec<Problem>) -> Option<usize> {
        find("point", &self.points, name, span, problems)
    }

    /// The number of a segment.
    pub fn segment(&self, name: &At<String>, problems: &mut Vec<Problem>) -> Option<usize> {
        find("segment", &self.segments, name, &name.span, problems)
    }

    /// The number of a route.
    pub fn route(&self, name: &At<String>, problems: &mut Vec<Problem>) -> Option<usize> {
        find("route", &self.routes, name, &name.span, problems)
    }
}

fn number<'a>(
    kind: &str,
    names: impl Iterator<Item = &'a At<String>>,
    problems: &mut Vec<Problem>,
) -> BTreeMap<String, usize> {
    let mut numbers = BTreeMap::new();
    for (number, name) in names.enumerate() {
        if name.trim().is_empty() {
            problems.push(Problem::new(Rule::Range, &name.span, format!("a {kind} has an empty name"), "give it one"));
        }
        if numbers.insert(name.value.clone(), number).is_some() {
            let what = format!("there are two {kind}s called {name}");
            problems.push(Problem::new(Rule::NameTwice, &name.span, what, "give one of them another name"));
        }
    }
    numbers
}

fn find(
    kind: &str,
    numbers: &BTreeMap<String, usize>,
    name: &str,
    span: &Range<usize>,
    problems: &mut Vec<Problem>,
) -> Option<usize> {
    let number = numbers.get(name).copied();
    if number.is_none() {
        let right = match nearest(name, numbers.keys()) {
            Some(near) => format!("is {near} meant?"),
            None if numbers.is_empty() => format!("the file has no {kind}s"),
            None => format!("the {kind}s are {}", some(numbers.keys())),
        };
        problems.push(Problem::new(Rule::NoSuchName, span, format!("there is no {kind} {name}"), right));
    }
    number
}

fn some<'a>(names: impl Iterator<Item = &'a String>) -> String {
    let names: Vec<&str> = names.map(String::as_str).collect();
    let shown = names.iter().take(8).copied().collect::<Vec<_>>().join(", ");
    if names.len() > 8 { format!("{shown}, …") } else { shown }
}

/// The name that differs least, if it differs by at most two letters and less than half of them.
fn nearest<'a>(name: &str, names: impl Iterator<Item = &'a String>) -> Option<&'a String> {
    let best = names.map(|other| (distance(name, other), other)).min()?;
    (best.0 <= 2 && best.0 * 2 <= name.chars().count()).then_some(best.1)
}

/// How many letters must be put in, left out or changed.
fn distance(one: &str, other: &str) -> usize {
    let other: Vec<char> = other.chars().take(64).collect();
    let mut row: Vec<usize> = (0..=other.len()).collect();
    for (number, letter) in one.chars().take(64).enumerate() {
        let mut diagonal = row[0];
        row[0] = number + 1;
        for (place, against) in other.iter().enumerate() {
            let changed = diagonal + usize::from(letter != *against);
            diagonal = row[place + 1];
            row[place + 1] = changed.min(diagonal + 1).min(row[place] + 1);
        }
    }
    row[other.len()]
}
