//! Which end of each track is its left one.

use std::collections::VecDeque;

use crate::graph::{Graph, Kind};

/// Marks the tracks that lie the other way round than the file names their ends: a plain piece with its right end on the left, a point
/// with its toe on the right.
pub fn flipped(graph: &Graph) -> Vec<bool> {
    let mut flipped: Vec<Option<bool>> = vec![None; graph.tracks.len()];
    // Plain pieces first: they say which end is the left one.
    let mut order: Vec<usize> = (0..graph.tracks.len()).collect();
    order.sort_by_key(|track| graph.tracks[*track].kind != Kind::Plain);
    for first in order {
        if flipped[first].is_some() {
            continue;
        }
        flipped[first] = Some(false);
        let mut open = VecDeque::from([first]);
        while let Some(track) = open.pop_front() {
            let turned = flipped[track] == Some(true);
            for joint in &graph.tracks[track].joints {
                for next in graph.joints[*joint].tracks.iter().copied().filter(|next| *next != track) {
                    if flipped[next].is_none() {
                        // What is the right end here is the left end there.
                        let here_left = is_left(graph, track, *joint, turned);
                        flipped[next] = Some(is_left(graph, next, *joint, false) == here_left);
                        open.push_back(next);
                    }
                }
            }
        }
    }
    flipped.into_iter().map(|turned| turned == Some(true)).collect()
}

/// Whether `joint` is at the left of `track`, which lies as named or `turned`.
pub fn is_left(graph: &Graph, track: usize, joint: usize, turned: bool) -> bool {
    let first = graph.tracks[track].joints.first() == Some(&joint);
    first != turned
}
