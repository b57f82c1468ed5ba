//! Where tracks go: rows for lines that run straight on, columns from left to right.

use super::orient::{flipped, is_left};
use crate::graph::{Graph, Kind};
use crate::model::Model;

/// The distance between two rows.
pub const ROW: i32 = 58;
/// The width of a point.
const POINT: i32 = 64;
/// How much wider a leg gets for each row that it crosses.
const SLANT: i32 = 38;

/// The drawing's geometry.
pub struct Placed {
    /// Which tracks lie the other way round.
    pub flipped: Vec<bool>,
    /// The line that each track is part of.
    pub line_of: Vec<usize>,
    /// The row of each line, from the top.
    pub rows: Vec<usize>,
    /// Where each joint is.
    pub joints: Vec<(i32, i32)>,
}

impl Placed {
    /// The height of a track's line.
    pub fn y(&self, track: usize) -> i32 {
        height(self.rows[self.line_of[track]])
    }
}

fn height(row: usize) -> i32 {
    i32::try_from(row).unwrap_or(0) * ROW
}

/// Places the tracks of a layout. If it `may_turn`, its first circuit comes to lie left of its last one.
pub fn place(model: &Model, may_turn: bool) -> Placed {
    let graph = &model.graph;
    let mut flipped = flipped(graph);
    let line_of = lines(graph);
    let count = line_of.iter().max().map_or(0, |last| last + 1);
    let mut rows = vec![0; count];
    let mut columns = columns(model, &flipped, &rows, &line_of);
    // The first circuit of the file is left of the last one.
    let first = graph.tracks.iter().min_by_key(|track| track.circuit).map(|track| columns[track.joints[0]]);
    let last = graph.tracks.iter().max_by_key(|track| track.circuit).map(|track| columns[track.joints[0]]);
    if may_turn && first > last {
        for turned in &mut flipped {
            *turned = !*turned;
        }
        columns = self::columns(model, &flipped, &rows, &line_of);
    }
    // The rows say how far legs reach, and that says where they cross lines: the best of some rounds is drawn.
    let mut best: Option<(i64, Vec<usize>, Vec<i32>)> = None;
    for _ in 0..4 {
        rows = self::rows(graph, &line_of, count, &columns);
        columns = self::columns(model, &flipped, &rows, &line_of);
        let (legs, reach) = legs_and_reach(graph, &line_of, count, &columns);
        let last = rows.iter().max().map_or(0, |last| last + 1);
        let order: Vec<Vec<usize>> =
            (0..last).map(|row| (0..count).filter(|line| rows[*line] == row).collect()).collect();
        let cost = cost(&order, &legs, &reach);
        if best.as_ref().is_none_or(|(least, ..)| cost < *least) {
            best = Some((cost, rows.clone(), columns.clone()));
        }
    }
    if let Some((_, best_rows, best_columns)) = best {
        (rows, columns) = (best_rows, best_columns);
    }
    let joints = (0..graph.joints.len()).map(|joint| {
        let straight = graph.joints[joint].tracks.iter().find(|track| !by_reverse(graph, **track, joint));
        let tracks = &graph.joints[joint].tracks;
        let middle = || {
            let heights: Vec<i32> = tracks.iter().map(|track| height(rows[line_of[*track]])).collect();
            heights.iter().sum::<i32>() / i32::try_from(heights.len().max(1)).unwrap_or(1)
        };
        let y = straight.map_or_else(middle, |track| height(rows[line_of[*track]]));
        (columns[joint], y)
    });
    let joints = joints.collect();
    Placed { flipped, line_of, rows, joints }
}

/// Whether the track reaches the joint by a reverse leg.
pub fn by_reverse(graph: &Graph, track: usize, joint: usize) -> bool {
    let track = &graph.tracks[track];
    track.kind != Kind::Plain && track.joints.get(2) == Some(&joint)
}

/// Gathers tracks into lines that run straight on: over plain pieces, and from toe to normal leg.
fn lines(graph: &Graph) -> Vec<usize> {
    let mut line_of = vec![usize::MAX; graph.tracks.len()];
    let mut count = 0;
    for first in 0..graph.tracks.len() {
        if line_of[first] != usize::MAX {
            continue;
        }
        let mut open = vec![first];
        while let Some(track) = open.pop() {
            if line_of[track] != usize::MAX {
                continue;
            }
            line_of[track] = count;
            for joint in graph.tracks[track].joints.iter().take(2) {
                let next = graph.joints[*joint]
                    .tracks
                    .iter()
                    .copied()
                    .filter(|next| *next != track && !by_reverse(graph, *next, *joint));
                open.extend(next);
            }
        }
        count += 1;
    }
    line_of
}

/// The place of each joint from left to right: as far left as the widths of the tracks allow.
fn columns(model: &Model, flipped: &[bool], rows: &[usize], line_of: &[usize]) -> Vec<i32> {
    let graph = &model.graph;
    let mut spans: Vec<(usize, usize, i32)> = Vec::new();
    for (number, track) in graph.tracks.iter().enumerate() {
        let at_left = |joint: usize| is_left(graph, number, joint, flipped[number]);
        let first = track.joints[0];
        for (leg, other) in track.joints.iter().enumerate().skip(1) {
            let width = if track.kind == Kind::Plain {
                let name = model.circuits[track.circuit].name.chars().count();
                i32::try_from(name).unwrap_or(0).clamp(7, 30) * 8 + 54
            } else if leg == 2 {
                let far = graph.joints[*other].tracks.iter().find(|far| **far != number);
                let apart = far.map_or(0, |far| rows[line_of[number]].abs_diff(rows[line_of[*far]]));
                let both = far.is_some_and(|far| by_reverse(graph, *far, *other));
                let slant = i32::try_from(apart).unwrap_or(0) * SLANT;
                POINT.max(if both { slant / 2 } else { slant })
            } else {
                POINT
            };
            spans.push(if at_left(first) { (first, *other, width) } else { (*other, first, width) });
        }
    }
    let mut columns = vec![0; graph.joints.len()];
    // As many rounds as there are joints suffice without a ring; with one the drawing ends somewhere.
    for _ in 0..graph.joints.len() {
        let mut moved = false;
        for (left, right, width) in &spans {
            if columns[*right] < columns[*left] + width {
                columns[*right] = columns[*left] + width;
                moved = true;
            }
        }
        if !moved {
            break;
        }
    }
    // What begins somewhere inside need not begin at the left margin.
    for _ in 0..graph.joints.len() {
        let mut moved = false;
        for (joint, at) in columns.clone().into_iter().enumerate() {
            let from_left = spans.iter().filter(|(_, right, _)| *right == joint).count();
            let room =
                spans.iter().filter(|(left, ..)| *left == joint).map(|(_, right, width)| columns[*right] - width).min();
            if let Some(room) = room.filter(|room| from_left == 0 && *room > at) {
                columns[joint] = room;
                moved = true;
            }
        }
        if !moved {
            break;
        }
    }
    columns
}

/// A reverse leg, or two that meet: from a place on one line to a place on another.
struct Leg {
    lines: [usize; 2],
    at: [i32; 2],
}

/// The legs between lines, and how far each line reaches.
fn legs_and_reach(graph: &Graph, line_of: &[usize], count: usize, columns: &[i32]) -> (Vec<Leg>, Vec<(i32, i32)>) {
    let mut reach: Vec<(i32, i32)> = vec![(i32::MAX, i32::MIN); count];
    for (number, track) in graph.tracks.iter().enumerate() {
        for joint in track.joints.iter().take(2) {
            let line = &mut reach[line_of[number]];
            *line = (line.0.min(columns[*joint]), line.1.max(columns[*joint]));
        }
    }
    let mut legs = Vec::new();
    for (number, track) in graph.tracks.iter().enumerate() {
        let Some(joint) = track.joints.get(2) else { continue };
        let far = graph.joints[*joint].tracks.iter().find(|far| **far != number);
        legs.extend(far.map(|far| {
            let end = if by_reverse(graph, *far, *joint) { graph.tracks[*far].joints[0] } else { *joint };
            Leg { lines: [line_of[number], line_of[*far]], at: [columns[track.joints[0]], columns[end]] }
        }));
    }
    (legs, reach)
}

/// Rows for lines: the longest first, then what joins it, each where the fewest lines are crossed.
fn rows(graph: &Graph, line_of: &[usize], count: usize, columns: &[i32]) -> Vec<usize> {
    let (legs, reach) = legs_and_reach(graph, line_of, count, columns);
    let mut order: Vec<Vec<usize>> = Vec::new();
    let mut open: Vec<usize> = (0..count).collect();
    while !open.is_empty() {
        let placed: Vec<usize> = order.iter().flatten().copied().collect();
        let joined = |line: usize| {
            legs.iter().any(|leg| leg.lines.contains(&line) && leg.lines.iter().any(|other| placed.contains(other)))
        };
        let next = open.iter().position(|line| joined(*line)).unwrap_or_else(|| {
            let longest =
                (0..open.len()).max_by_key(|place| (reach[open[*place]].1 - reach[open[*place]].0, usize::MAX - place));
            longest.unwrap_or(0)
        });
        let line = open.remove(next);
        let mut best: Option<(i64, Vec<Vec<usize>>)> = None;
        for tried in tries(&order, line, &reach) {
            let cost = cost(&tried, &legs, &reach);
            if best.as_ref().is_none_or(|(least, _)| cost < *least) {
                best = Some((cost, tried));
            }
        }
        if let Some((_, better)) = best {
            order = better;
        }
    }
    // From one start alone the moves may end where only two at once would help.
    let downward: Vec<Vec<usize>> = (0..count).map(|line| vec![line]).collect();
    let upward: Vec<Vec<usize>> = downward.iter().rev().cloned().collect();
    let starts = [order, downward, upward].map(|start| improve(start, &legs, &reach));
    let best = starts.into_iter().min_by_key(|order| cost(order, &legs, &reach));
    let order = best.unwrap_or_default();
    let row = |line: usize| order.iter().position(|row| row.contains(&line)).unwrap_or(0);
    (0..count).map(row).collect()
}

/// Moves one line after the other to a better row, until none gets better.
fn improve(mut order: Vec<Vec<usize>>, legs: &[Leg], reach: &[(i32, i32)]) -> Vec<Vec<usize>> {
    let mut least = cost(&order, legs, reach);
    for _ in 0..5 {
        let before = least;
        for line in 0..reach.len() {
            let mut without = order.clone();
            for row in &mut without {
                row.retain(|other| *other != line);
            }
            without.retain(|row| !row.is_empty());
            for tried in tries(&without, line, reach) {
                let cost = cost(&tried, legs, reach);
                if cost < least {
                    (least, order) = (cost, tried);
                }
            }
        }
        if least == before {
            break;
        }
    }
    order
}

/// Every order with `line` in a row of its own, or in a row that has room for it.
fn tries(order: &[Vec<usize>], line: usize, reach: &[(i32, i32)]) -> Vec<Vec<Vec<usize>>> {
    let mut tries = Vec::new();
    for row in (0..=order.len()).rev() {
        let mut inserted = order.to_vec();
        inserted.insert(row, vec![line]);
        tries.push(inserted);
        let free = |other: &usize| reach[line].0 > reach[*other].1 + 60 || reach[line].1 + 60 < reach[*other].0;
        if order.get(row).is_some_and(|row| row.iter().all(free)) {
            let mut shared = order.to_vec();
            shared[row].push(line);
            tries.push(shared);
        }
    }
    tries
}

/// Whether two legs cross, in rows and columns.
fn cross(one: [(i64, i64); 2], other: [(i64, i64); 2]) -> bool {
    let side =
        |a: (i64, i64), b: (i64, i64), c: (i64, i64)| ((b.0 - a.0) * (c.1 - a.1) - (b.1 - a.1) * (c.0 - a.0)).signum();
    side(one[0], one[1], other[0]) * side(one[0], one[1], other[1]) < 0
        && side(other[0], other[1], one[0]) * side(other[0], other[1], one[1]) < 0
}

/// How bad an order of rows is: lines that legs cross, then how far legs reach, then how many rows there are.
fn cost(order: &[Vec<usize>], legs: &[Leg], reach: &[(i32, i32)]) -> i64 {
    let mut row_of = vec![None; reach.len()];
    for (row, lines) in order.iter().enumerate() {
        for line in lines {
            row_of[*line] = Some(row);
        }
    }
    let row = |line: usize| row_of[line];
    let mut cost = 0;
    let ends: Vec<[(i64, i64); 2]> = legs
        .iter()
        .filter_map(|leg| {
            let (one, other) = (row(leg.lines[0])?, row(leg.lines[1])?);
            let place = |x: i32, row: usize| (i64::from(x), i64::try_from(row).unwrap_or(0));
            Some([place(leg.at[0], one), place(leg.at[1], other)])
        })
        .collect();
    for (number, one) in ends.iter().enumerate() {
        cost += ends[..number].iter().filter(|other| cross(*one, **other)).map(|_| 500).sum::<i64>();
    }
    for leg in legs {
        let (Some(one), Some(other)) = (row(leg.lines[0]), row(leg.lines[1])) else { continue };
        let (top, bottom) = (one.min(other), one.max(other));
        let [from, to] = if one <= other { leg.at } else { [leg.at[1], leg.at[0]] };
        let mut crossed = 0;
        for (row, lines) in order.iter().enumerate().take(bottom).skip(top + 1) {
            let share =
                |whole: i32| whole * i32::try_from(row - top).unwrap_or(0) / i32::try_from(bottom - top).unwrap_or(1);
            let at = from + share(to - from);
            crossed += lines.iter().filter(|line| reach[**line].0 - 12 <= at && at <= reach[**line].1 + 12).count();
        }
        cost += i64::try_from(crossed * 1000 + (bottom - top) * 10).unwrap_or(i64::MAX / 4);
    }
    // Where nothing else decides, lines stand in the order of the file.
    let flat: Vec<usize> = order.iter().flatten().copied().collect();
    let inverted = flat
        .iter()
        .enumerate()
        .map(|(place, line)| flat[..place].iter().filter(|above| *above > line).count())
        .sum::<usize>();
    cost + i64::try_from(order.len() * 3 + inverted.min(6)).unwrap_or(0)
}
