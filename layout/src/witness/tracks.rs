//! The tracks as a vehicle meets them: stretches without a choice, and what comes after each.

use std::collections::BTreeMap;

use crate::form::{EndKind, Position, Station};

/// A stretch of track that a vehicle runs over without a choice: a plain track, or a point from toe to leg.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Piece {
    /// Its circuit, by its place in the file.
    pub circuit: usize,
    /// The joints at its ends: left and right, or toe and leg.
    pub ends: [usize; 2],
    /// The point that it leads over, and the position that a vehicle needs.
    pub over: Option<(usize, Position)>,
    /// The two stretches of a point are one track: no vehicle runs from one onto the other.
    pub track: usize,
}

/// A vehicle on a stretch that leaves it over this end of it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Vehicle {
    /// The stretch.
    pub piece: usize,
    /// The end, 0 or 1.
    pub toward: usize,
}

/// Where points stand, as far as that is known.
pub type Stand = BTreeMap<usize, Position>;

/// The tracks of a file.
#[derive(Clone, Debug, Default)]
pub struct Tracks {
    /// The stretches.
    pub pieces: Vec<Piece>,
    /// The stretches that reach each joint.
    at: Vec<Vec<usize>>,
    /// The names of the joints.
    pub joints: Vec<String>,
    /// The joints where the line goes on unseen.
    lines: Vec<usize>,
}

impl Tracks {
    /// The tracks of a file that breaks no rule.
    pub fn of(station: &Station) -> Self {
        let mut tracks = Self::default();
        let mut track = 0;
        let place = |name: &str| station.circuits.iter().position(|circuit| circuit.name.value == name);
        for (circuit, given) in station.circuits.iter().enumerate() {
            let own = given.left.iter().zip(&given.right);
            for (left, right) in own.chain(given.crossings.iter().map(|crossing| (&crossing.left, &crossing.right))) {
                let ends = [tracks.joint(left), tracks.joint(right)];
                tracks.pieces.push(Piece { circuit, ends, over: None, track });
                track += 1;
            }
        }
        for (point, given) in station.points.iter().enumerate() {
            let Some(circuit) = place(&given.circuit) else { continue };
            for (leg, position) in [(&given.normal, Position::Normal), (&given.reverse, Position::Reverse)] {
                let ends = [tracks.joint(&given.toe), tracks.joint(leg)];
                tracks.pieces.push(Piece { circuit, ends, over: Some((point, position)), track });
            }
            track += 1;
        }
        tracks.at = vec![Vec::new(); tracks.joints.len()];
        for (number, piece) in tracks.pieces.iter().enumerate() {
            for joint in piece.ends {
                tracks.at[joint].push(number);
            }
        }
        let is_line =
            |name: &String| station.ends.iter().any(|end| end.kind == EndKind::Line && end.joint.value == *name);
        tracks.lines = (0..tracks.joints.len()).filter(|joint| is_line(&tracks.joints[*joint])).collect();
        tracks
    }

    fn joint(&mut self, name: &str) -> usize {
        self.joints.iter().position(|known| known == name).unwrap_or_else(|| {
            self.joints.push(name.to_owned());
            self.joints.len() - 1
        })
    }

    /// Whether the line goes on unseen at a joint.
    pub fn is_line(&self, joint: usize) -> bool {
        self.lines.contains(&joint)
    }

    /// The stretch of a vehicle.
    pub fn piece(&self, vehicle: Vehicle) -> Piece {
        self.pieces[vehicle.piece]
    }

    /// The joint to which it runs.
    pub fn ahead(&self, vehicle: Vehicle) -> usize {
        self.piece(vehicle).ends[vehicle.toward]
    }

    /// The joint from which it comes.
    pub fn behind(&self, vehicle: Vehicle) -> usize {
        self.piece(vehicle).ends[1 - vehicle.toward]
    }

    /// Every vehicle that runs onto a stretch of this circuit, or off it, over this joint.
    pub fn at_joint(&self, circuit: usize, joint: usize, off: bool) -> impl Iterator<Item = Vehicle> + '_ {
        self.at[joint].iter().filter(move |piece| self.pieces[**piece].circuit == circuit).map(move |piece| {
            let there = usize::from(self.pieces[*piece].ends[0] != joint);
            Vehicle { piece: *piece, toward: if off { there } else { 1 - there } }
        })
    }

    /// Where a vehicle may be next, with whatever position the points have.
    pub fn onward(&self, vehicle: Vehicle) -> impl Iterator<Item = Vehicle> + '_ {
        let (joint, track) = (self.ahead(vehicle), self.piece(vehicle).track);
        self.at[joint].iter().filter(move |next| self.pieces[**next].track != track).map(move |next| {
            let from = usize::from(self.pieces[*next].ends[0] != joint);
            Vehicle { piece: *next, toward: 1 - from }
        })
    }

    /// Where it may have been before: the same, seen from the other side.
    pub fn before(&self, vehicle: Vehicle) -> impl Iterator<Item = Vehicle> + '_ {
        let turned = Vehicle { toward: 1 - vehicle.toward, ..vehicle };
        self.onward(turned).map(|before| Vehicle { toward: 1 - before.toward, ..before })
    }

    /// Whether a point that stands so sends a vehicle that comes over its toe elsewhere.
    pub fn diverts(&self, vehicle: Vehicle, stand: &Stand) -> bool {
        let facing = vehicle.toward == 1;
        let other = |(point, position)| stand.get(&point).is_some_and(|stands| *stands != position);
        facing && self.piece(vehicle).over.is_some_and(other)
    }
}
