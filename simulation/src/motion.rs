//! A train as a body: front and tail on metres, a speed, a brake. Nothing of any device.

use std::collections::VecDeque;

use serde::{Deserialize, Serialize};

use crate::track::Track;

/// How trains move.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Dynamics {
    /// The length of every train, in m: above 0, at most 1,000.
    pub length_m: f64,
    /// Traction, in m/s²: above 0, at most 3.
    pub acceleration: f64,
    /// The service brake, in m/s²: above 0, at most 5.
    pub service: f64,
    /// The emergency brake, in m/s²: not below the service brake, at most 5.
    pub emergency: f64,
    /// From a brake command to its effect, in ms: at most 2,000. Traction ends at once.
    pub brake_delay_ms: u32,
    /// How long a train stands at a station at least, in s.
    pub dwell_s: u32,
}

impl Default for Dynamics {
    fn default() -> Self {
        Self { length_m: 160.0, acceleration: 0.7, service: 0.9, emergency: 1.2, brake_delay_ms: 500, dwell_s: 30 }
    }
}

/// A piece that a train is on, and where it came in and goes out.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Leg {
    /// The piece.
    pub piece: usize,
    /// The joint where it came in.
    pub enter: usize,
    /// The joint where it goes out.
    pub exit: usize,
}

/// What happens when the front comes to a joint.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Crossed {
    /// It is on this piece now.
    Onto(usize),
    /// It ran over a point that did not stand for it.
    Derailed(usize),
    /// There is no track any more.
    EndOfTrack,
}

/// A train.
#[derive(Clone, Debug)]
pub struct Body {
    /// The pieces under it, from the tail to the front.
    pub legs: VecDeque<Leg>,
    /// How far the front is into the last of them.
    pub front_m: f64,
    /// How far the tail is into the first of them.
    pub tail_m: f64,
    /// Its speed, in m/s.
    pub speed: f64,
}

/// The positions of points as a train finds them: reverse or not; `None` while it moves.
pub type Lie = Option<bool>;

impl Body {
    /// A train at a stand on these pieces, its front so far into the last of them.
    pub fn standing(track: &Track, legs: &[Leg], front_m: f64, length_m: f64) -> Self {
        let behind: f64 = legs.iter().rev().skip(1).map(|leg| track.pieces[leg.piece].length_m).sum();
        let mut body =
            Self { legs: legs.iter().copied().collect(), front_m, tail_m: behind + front_m - length_m, speed: 0.0 };
        body.leave(track, &mut |_| ());
        body
    }

    /// The leg of the front.
    pub fn front(&self) -> Leg {
        self.legs[self.legs.len() - 1]
    }

    /// From the front to the end of its piece.
    pub fn to_joint_m(&self, track: &Track) -> f64 {
        track.pieces[self.front().piece].length_m - self.front_m
    }

    /// Where the front is along the line.
    pub fn along_m(&self, track: &Track) -> f64 {
        let leg = self.front();
        place(track, leg, self.front_m)
    }

    /// Where the tail is along the line.
    pub fn tail_along_m(&self, track: &Track) -> f64 {
        place(track, self.legs[0], self.tail_m)
    }

    /// Moves the train on; `crossed` hears of each joint that the front comes over, `left` of each piece behind the tail.
    pub fn advance(
        &mut self,
        track: &Track,
        metres: f64,
        lie: &dyn Fn(usize) -> Lie,
        crossed: &mut dyn FnMut(Crossed),
        left: &mut dyn FnMut(usize),
    ) {
        self.front_m += metres;
        self.tail_m += metres;
        while self.front_m > track.pieces[self.front().piece].length_m {
            let leg = self.front();
            let Some(next) = track.across(leg.exit, leg.piece) else {
                crossed(Crossed::EndOfTrack);
                self.front_m = track.pieces[leg.piece].length_m;
                break;
            };
            let stands = track.pieces[next].point.map_or(Some(false), lie);
            let (exit, needs) = track.leave(next, leg.exit, stands.unwrap_or(false));
            self.front_m -= track.pieces[leg.piece].length_m;
            self.legs.push_back(Leg { piece: next, enter: leg.exit, exit });
            crossed(match needs {
                Some((point, reverse)) if stands != Some(reverse) => Crossed::Derailed(point),
                _ => Crossed::Onto(next),
            });
        }
        self.leave(track, left);
    }

    fn leave(&mut self, track: &Track, left: &mut dyn FnMut(usize)) {
        while self.legs.len() > 1 && self.tail_m >= track.pieces[self.legs[0].piece].length_m {
            let gone = self.legs[0].piece;
            self.tail_m -= track.pieces[gone].length_m;
            self.legs.pop_front();
            left(gone);
        }
    }

    /// The other end becomes the front.
    pub fn turn(&mut self, track: &Track) {
        let length = |piece: usize| track.pieces[piece].length_m;
        let (front, tail) = (length(self.front().piece) - self.front_m, length(self.legs[0].piece) - self.tail_m);
        self.legs =
            self.legs.iter().rev().map(|leg| Leg { piece: leg.piece, enter: leg.exit, exit: leg.enter }).collect();
        (self.front_m, self.tail_m) = (tail, front);
    }

    /// The stretch of a piece that the train is on, measured from the piece's first joint.
    pub fn on(&self, track: &Track, piece: usize) -> Option<(f64, f64)> {
        let place = self.legs.iter().position(|leg| leg.piece == piece)?;
        let length = track.pieces[piece].length_m;
        let from = if place == 0 { self.tail_m } else { 0.0 };
        let to = if place + 1 == self.legs.len() { self.front_m } else { length };
        let first = self.legs[place].enter == track.pieces[piece].joints[0];
        Some(if first { (from, to) } else { (length - to, length - from) })
    }
}

fn place(track: &Track, leg: Leg, metres: f64) -> f64 {
    let (from, to) = (track.along_m[leg.enter], track.along_m[leg.exit]);
    from + (to - from) * (metres / track.pieces[leg.piece].length_m).clamp(0.0, 1.0)
}
