//! The ground as it lies: the tracks of all stations, joined where two stations see the same line. Metres, nothing of the
//! kernel's plans.

use atc_kernel::interlocking::Heading;
use atc_layout::graph::Kind;
use atc_layout::model::Model;

/// A piece of track.
#[derive(Clone, Debug)]
pub struct Piece {
    /// The circuit that it is part of.
    pub circuit: usize,
    /// The joints it reaches: two, or toe, normal leg and reverse leg.
    pub joints: Vec<usize>,
    /// The point that it is.
    pub point: Option<usize>,
    /// Its length.
    pub length_m: f64,
    /// Whether two trains may both be on it, one behind the other: it is all of its circuit.
    pub plain: bool,
}

/// A circuit.
#[derive(Clone, Debug)]
pub struct Circuit {
    /// Its name: with that of its station where the line does not share it.
    pub name: String,
    /// Its length, along the shortest way.
    pub length_m: f64,
}

/// A point.
#[derive(Clone, Debug)]
pub struct Point {
    /// Its name, with that of its station.
    pub name: String,
    /// The longest time of its stroke.
    pub throw_ms: u32,
}

/// Where the circuits, points and pieces of one station are on the ground.
#[derive(Clone, Debug, Default)]
pub struct Site {
    /// The circuit of each number.
    pub circuits: Vec<usize>,
    /// The point of each number.
    pub points: Vec<usize>,
    /// The piece of each track of its graph.
    pub pieces: Vec<usize>,
    /// For each piece of the ground and each of its joints, the direction of travel of a train that leaves it there, as the
    /// station calls it; `None` for pieces of others.
    pub headings: Vec<Option<Vec<Heading>>>,
}

/// All tracks of the line.
#[derive(Clone, Debug, Default)]
pub struct Track {
    /// The pieces.
    pub pieces: Vec<Piece>,
    /// The pieces that reach each joint: one or two.
    pub joints: Vec<Vec<usize>>,
    /// Where each joint is along the line, from the west.
    pub along_m: Vec<f64>,
    /// The circuits.
    pub circuits: Vec<Circuit>,
    /// The points.
    pub points: Vec<Point>,
    /// One for each station.
    pub sites: Vec<Site>,
}

/// The segments by which a station and the next one to the east are joined: a line, of which there may be several between two stations.
#[derive(Clone, Copy, Debug)]
pub struct Pair {
    /// The western station.
    pub west: usize,
    /// The segment of the western station, and of the eastern one.
    pub segments: [usize; 2],
}

/// A line between station `west` and the next: the segments of both, and the circuits from west to east.
#[derive(Clone, Debug)]
pub struct Link {
    /// The western station.
    pub west: usize,
    /// The segment of the western station, and of the eastern one.
    pub segments: [usize; 2],
    /// The circuits on the ground, from west to east.
    pub circuits: Vec<usize>,
}

/// The joints along a segment, from the station outward: one more than it has circuits.
fn along(model: &Model, segment: usize) -> Result<Vec<usize>, String> {
    let segment = &model.segments[segment];
    let name = |circuit: &usize| &model.circuits[*circuit].name;
    let ends = |circuit: &usize| {
        let tracks: Vec<_> = model.graph.tracks.iter().filter(|track| track.circuit == *circuit).collect();
        match tracks.as_slice() {
            [track] if track.kind == Kind::Plain => Ok([track.joints[0], track.joints[1]]),
            _ => Err(format!("circuit {} of segment {} is more than one plain track", name(circuit), segment.name)),
        }
    };
    let mut ends_of = segment.circuits.iter().map(ends).collect::<Result<Vec<_>, _>>()?;
    let [.., last] = ends_of.as_mut_slice() else { return Err(format!("segment {} has no circuit", segment.name)) };
    let mut outer = last.iter().copied().find(|joint| model.graph.joints[*joint].end.is_some());
    let mut joints: Vec<usize> = outer.into_iter().collect();
    for ends in ends_of.iter().rev() {
        outer = outer.and_then(|joint| match ends {
            [left, right] if *left == joint => Some(*right),
            [left, right] if *right == joint => Some(*left),
            _ => None,
        });
        joints.extend(outer);
    }
    if outer.is_none() {
        return Err(format!("the circuits of segment {} do not follow each other", segment.name));
    }
    joints.reverse();
    Ok(joints)
}

/// The tracks of stations in their order from west to east, and the lines between them: those of each pair of segments, in the order of `pairs`.
///
/// # Errors
/// What cannot be joined, in a sentence.
pub fn join(models: &[(&str, &Model)], pairs: &[Pair]) -> Result<(Track, Vec<Link>), String> {
    let mut track = Track::default();
    let bases: Vec<usize> = models
        .iter()
        .scan(0, |sum, (_, model)| {
            let base = *sum;
            *sum += model.graph.joints.len();
            Some(base)
        })
        .collect();
    let count: usize = models.iter().map(|(_, model)| model.graph.joints.len()).sum();
    let mut same: Vec<usize> = (0..count).collect();
    // For each station the circuits that are those of the station before.
    let mut known: Vec<Vec<Option<usize>>> = models.iter().map(|(_, model)| vec![None; model.circuits.len()]).collect();
    let mut shared = Vec::new();
    for Pair { west, segments: [segment, segment_there] } in pairs.iter().copied() {
        let (model, there) = (models[west].1, models[west + 1].1);
        let (joints, joints_there) = (along(model, segment)?, along(there, segment_there)?);
        let (here, its) = (&model.segments[segment], &there.segments[segment_there]);
        for place in 0..=here.shared {
            let (joint, other) =
                (joints[here.circuits.len() - here.shared + place], joints_there[its.circuits.len() - place]);
            same[bases[west + 1] + other] = bases[west] + joint;
        }
        shared.push(here.shared);
    }
    // A joint of a line is of one line, so that one step leads to the joint that stands for it.
    let mut numbers: Vec<Option<usize>> = vec![None; count];
    let mut number = |joint: usize, track: &mut Track| {
        let joint = same[joint];
        *numbers[joint].get_or_insert_with(|| {
            track.joints.push(Vec::new());
            track.joints.len() - 1
        })
    };
    let mut links = Vec::new();
    for (station, (name, model)) in models.iter().enumerate() {
        let from_the_west = |(pair, _): &(&Pair, &usize)| pair.west + 1 == station;
        let joined: Vec<_> = pairs.iter().zip(&shared).filter(from_the_west).collect();
        for (Pair { west, segments: [segment, segment_there] }, shared) in joined.iter().copied() {
            let (before, its) = (&models[*west].1.segments[*segment], &model.segments[*segment_there]);
            for place in 0..*shared {
                let circuit = before.circuits[before.circuits.len() - shared + place];
                let own = its.circuits[its.circuits.len() - 1 - place];
                known[station][own] = Some(track.sites[*west].circuits[circuit]);
            }
        }
        let mut site = Site::default();
        for (own, (circuit, known)) in model.circuits.iter().zip(&known[station]).enumerate() {
            let on_line =
                model.segments.iter().any(|segment| segment.line.is_some() && segment.circuits.contains(&own));
            site.circuits.push(known.unwrap_or_else(|| {
                let name = if on_line { circuit.name.clone() } else { format!("{name} {}", circuit.name) };
                track.circuits.push(Circuit { name, length_m: f64::from(circuit.length.0) });
                track.circuits.len() - 1
            }));
        }
        for point in &model.points {
            site.points.push(track.points.len());
            track.points.push(Point { name: format!("{name} {}", point.name), throw_ms: point.throw_ms });
        }
        lay(&mut track, &mut site, (model, &known[station]), |joint, track| number(bases[station] + joint, track));
        for (Pair { west, segments: [segment, segment_there] }, shared) in joined.iter().copied() {
            let (before, its) = (&models[*west].1.segments[*segment], &model.segments[*segment_there]);
            let mut circuits: Vec<usize> =
                before.circuits.iter().map(|circuit| track.sites[*west].circuits[*circuit]).collect();
            let own = its.circuits.len() - shared;
            circuits.extend(its.circuits[..own].iter().rev().map(|circuit| site.circuits[*circuit]));
            links.push(Link { west: *west, segments: [*segment, *segment_there], circuits });
        }
        track.sites.push(site);
    }
    for site in 0..track.sites.len() {
        let headings = track.headings(site);
        track.sites[site].headings = headings;
    }
    track.measure();
    Ok((track, links))
}

/// Lays the pieces of a station; those of circuits that the station before has laid are there already.
fn lay(
    track: &mut Track,
    site: &mut Site,
    (model, known): (&Model, &[Option<usize>]),
    mut number: impl FnMut(usize, &mut Track) -> usize,
) {
    for piece in &model.graph.tracks {
        let circuit = site.circuits[piece.circuit];
        let joints: Vec<usize> = piece.joints.iter().map(|joint| number(*joint, track)).collect();
        let laid = track.pieces.iter().position(|other| other.circuit == circuit && other.joints == joints);
        let at = laid.filter(|_| known[piece.circuit].is_some()).unwrap_or_else(|| {
            let point = match piece.kind {
                Kind::Plain => None,
                Kind::Point(point) => Some(site.points[point]),
            };
            let plain = model.graph.tracks.iter().filter(|other| other.circuit == piece.circuit).count() == 1;
            let length_m = track.circuits[circuit].length_m;
            track.pieces.push(Piece {
                circuit,
                joints: joints.clone(),
                point,
                length_m,
                plain: plain && point.is_none(),
            });
            for joint in &joints {
                track.joints[*joint].push(track.pieces.len() - 1);
            }
            track.pieces.len() - 1
        });
        site.pieces.push(at);
        site.headings.resize(track.pieces.len().max(site.headings.len()), None);
        // Marked as this station's; which way is which follows when all is laid.
        site.headings[at] = Some(Vec::new());
    }
}

impl Track {
    /// The piece on the other side of a joint.
    pub fn across(&self, joint: usize, piece: usize) -> Option<usize> {
        self.joints[joint].iter().copied().find(|other| *other != piece)
    }

    /// Where a train leaves a piece entered at `joint` if the point there stands reverse or not, and whether it must stand so.
    pub fn leave(&self, piece: usize, joint: usize, reverse: bool) -> (usize, Option<(usize, bool)>) {
        let it = &self.pieces[piece];
        match (it.point, it.joints.as_slice()) {
            (Some(point), [toe, normal, other]) if joint == *toe => {
                (if reverse { *other } else { *normal }, Some((point, reverse)))
            }
            (Some(point), [toe, _, other]) => (*toe, Some((point, joint == *other))),
            (_, [left, right]) => (if *left == joint { *right } else { *left }, None),
            _ => (joint, None),
        }
    }

    /// The direction of travel of a train that leaves `piece` at `joint`, as the station calls it.
    pub fn heading(&self, site: usize, piece: usize, joint: usize) -> Option<Heading> {
        let place = self.pieces[piece].joints.iter().position(|other| *other == joint)?;
        self.sites[site].headings.get(piece)?.as_ref()?.get(place).copied()
    }

    fn headings(&self, site: usize) -> Vec<Option<Vec<Heading>>> {
        let its = |piece: usize| self.sites[site].headings.get(piece).is_some_and(Option::is_some);
        let side = |place: usize| if place == 1 { Heading::Right } else { Heading::Left };
        let of = |piece: usize| -> Vec<Heading> {
            let leaves = |joint: &usize| {
                let (mut piece, mut joint) = (piece, *joint);
                // A chain of points is no longer than there are pieces.
                for _ in 0..self.pieces.len() {
                    if self.pieces[piece].point.is_none() {
                        break;
                    }
                    let Some(next) = self.across(joint, piece) else { break };
                    (joint, piece) = match self.pieces[next].point {
                        None => return side(usize::from(self.pieces[next].joints[0] == joint)),
                        Some(_) => (self.leave(next, joint, false).0, next),
                    };
                }
                side(self.pieces[piece].joints.iter().position(|other| *other == joint).unwrap_or(0))
            };
            self.pieces[piece].joints.iter().map(leaves).collect()
        };
        (0..self.pieces.len()).map(|piece| its(piece).then(|| of(piece))).collect()
    }

    /// Finds where the joints are along the line, from the first joint of the first piece.
    fn measure(&mut self) {
        let mut along: Vec<Option<f64>> = vec![None; self.joints.len()];
        let mut open: Vec<(usize, f64)> = vec![(0, 0.0)];
        while !open.is_empty() {
            let mut next = Vec::new();
            for (joint, at) in open {
                if along[joint].is_some() {
                    continue;
                }
                along[joint] = Some(at);
                for piece in &self.joints[joint] {
                    let it = &self.pieces[*piece];
                    for (place, other) in it.joints.iter().enumerate() {
                        // Legs of one point are no way from one to the other.
                        let toe = it.point.is_none() || place == 0 || it.joints[0] == joint;
                        if *other != joint && toe {
                            let right = self.rightward(*piece, *other);
                            let length_m = if self.is_inner(it) { 0.0 } else { it.length_m };
                            next.push((*other, if right { at + length_m } else { at - length_m }));
                        }
                    }
                }
            }
            open = next;
        }
        let least = along.iter().flatten().copied().fold(f64::INFINITY, f64::min);
        self.along_m = along.into_iter().map(|at| at.map_or(0.0, |at| at - least)).collect();
    }

    /// Whether a piece lies behind another one of its circuit: a chain of points is drawn as long as its shortest way.
    fn is_inner(&self, piece: &Piece) -> bool {
        let toe = &self.joints[piece.joints[0]];
        piece.point.is_some() && toe.iter().all(|other| self.pieces[*other].circuit == piece.circuit)
    }

    fn rightward(&self, piece: usize, joint: usize) -> bool {
        (0..self.sites.len()).find_map(|site| self.heading(site, piece, joint)) == Some(Heading::Right)
    }
}
