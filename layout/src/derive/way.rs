//! The way of a path through the tracks: joints, points and their positions.

use std::ops::Range;

use crate::form::Position;
use crate::graph::{Graph, Passed, Way};
use crate::model::{Model, Positions, Segment};
use crate::problem::Problem;
use crate::rule::Rule;

/// A circuit of a path as the file gives it.
pub struct Step {
    /// The circuit.
    pub circuit: usize,
    /// The positions that the file gives.
    pub positions: Positions,
    /// Where the file names it.
    pub span: Range<usize>,
}

/// A way through all circuits of a path.
#[derive(Clone)]
pub struct Through {
    /// The joint where it starts.
    pub start: usize,
    /// The ways through the circuits, in order.
    pub ways: Vec<Way>,
}

impl Through {
    /// The joint where it ends.
    pub fn exit(&self) -> usize {
        self.ways.last().map_or(self.start, |way| way.exit)
    }

    fn reversed(&self) -> usize {
        let over: Vec<&Passed> = self.ways.iter().flat_map(|way| &way.passed).collect();
        over.iter().filter(|passed| passed.position == Position::Reverse).count()
    }
}

/// The most ways that are followed at a time.
const WAYS: usize = 4096;

/// Every way from one of the joints `starts` through all steps, in the positions that the file gives.
///
/// # Errors
/// The first step that no way reaches, or that too many reach.
pub fn through(
    graph: &Graph,
    names: &dyn Fn(usize) -> String,
    starts: &[usize],
    steps: &[Step],
) -> Result<Vec<Through>, Problem> {
    let mut found: Vec<Through> = starts.iter().map(|start| Through { start: *start, ways: Vec::new() }).collect();
    for (number, step) in steps.iter().enumerate() {
        let next = steps.get(number + 1).map(|step| step.circuit);
        let mut further = Vec::new();
        let mut against = None;
        for so_far in &found {
            for way in graph.ways(step.circuit, so_far.exit()) {
                if next.is_some_and(|next| graph.across(way.exit, step.circuit) != Some(next)) {
                    continue;
                }
                let opposed = way
                    .passed
                    .iter()
                    .find(|passed| step.positions.get(&passed.point).is_some_and(|given| *given != passed.position));
                if let Some(passed) = opposed {
                    against = Some(*passed);
                    continue;
                }
                if further.len() == WAYS {
                    let what = format!("more than {WAYS} ways lead as far as {}", names(step.circuit));
                    return Err(Problem::new(Rule::TooMany, &step.span, what, "give the positions of the points"));
                }
                let mut ways = so_far.ways.clone();
                ways.push(way);
                further.push(Through { start: so_far.start, ways });
            }
        }
        if further.is_empty() {
            return Err(broken(graph, names, step, next, against));
        }
        found = further;
    }
    found.sort_by_key(Through::reversed);
    Ok(found)
}

/// Every way along a segment, outward from the station; `spans` says where the file names its circuits.
///
/// # Errors
/// The first circuit that no way reaches.
pub fn of_segment(model: &Model, segment: &Segment, spans: &[Range<usize>]) -> Result<Vec<Through>, Problem> {
    let Some(first) = segment.circuits.first() else { return Ok(Vec::new()) };
    let starts = match segment.throat {
        Some(throat) => model.graph.between(throat, *first),
        None => model.graph.borders(*first),
    };
    let step = |(place, circuit): (usize, &usize)| Step {
        circuit: *circuit,
        positions: Positions::new(),
        span: spans.get(place).unwrap_or(&segment.span).clone(),
    };
    let steps: Vec<Step> = segment.circuits.iter().enumerate().map(step).collect();
    through(&model.graph, &|circuit| model.circuits[circuit].name.clone(), &starts, &steps)
}

fn broken(
    graph: &Graph,
    names: &dyn Fn(usize) -> String,
    step: &Step,
    next: Option<usize>,
    against: Option<Passed>,
) -> Problem {
    let here = names(step.circuit);
    if let Some(passed) = against {
        let what = format!("the path runs over a point of {here} in the position opposite to the one given");
        let (given, needed) = match passed.position {
            Position::Normal => ("reverse", "normal"),
            Position::Reverse => ("normal", "reverse"),
        };
        let right = format!("{needed} is the way to the next circuit, not {given}");
        return Problem::new(Rule::PositionContradicts, &step.span, what, right);
    }
    match next {
        Some(next) if graph.between(step.circuit, next).is_empty() => {
            let neighbours: Vec<String> = graph
                .borders(step.circuit)
                .into_iter()
                .filter_map(|joint| graph.across(joint, step.circuit))
                .map(names)
                .collect();
            let what = format!("the path goes from {here} to {}, which does not adjoin it", names(next));
            Problem::new(Rule::NoWay, &step.span, what, format!("{here} adjoins {}", neighbours.join(", ")))
        }
        Some(next) => {
            let what = format!("a train cannot run through {here} to {} without turning back", names(next));
            Problem::new(
                Rule::NoWay,
                &step.span,
                what,
                "give the circuits in the order in which a train runs over them",
            )
        }
        None => {
            let what = format!("a train cannot run through {here} on this path");
            Problem::new(
                Rule::NoWay,
                &step.span,
                what,
                "give the circuits in the order in which a train runs over them",
            )
        }
    }
}
