//! The ground: tracks, points, signals and lines as they lie, read from a layout file. Nothing of the kernel's plan is used.
//!
//! Lengths are in mm, speeds in mm/s, times in cycles. Each segment of plain line goes on over its border into a stretch that
//! only the neighbouring station sees; that stretch is a circuit of its own here, numbered after those of the station.

use atc_kernel::interlocking::Size;
use atc_layout::form::{EndKind, Position};
use atc_layout::graph::Kind;
use atc_layout::model::Model;
use atc_layout::{Compiled, Description};

use super::train::Leg;

/// A set of circuits, those of the neighbours included: bit `i` is circuit `i`.
pub type Mask = u128;

/// The length of the neighbour's stretch beyond a border.
pub const OUTSIDE_MM: i64 = 600_000;

/// How far the neighbour's signal stands from the border.
pub const NEIGHBOUR_SIGNAL_MM: i64 = 60_000;

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
    pub length: i64,
}

/// A route as a driver sees it: a signal, a way, a limit.
#[derive(Clone, Debug)]
pub struct Route {
    /// Its name.
    pub name: String,
    /// The joint of its signal.
    pub start: usize,
    /// The joint at its end.
    pub exit: usize,
    /// The circuit in rear of the signal.
    pub entry: usize,
    /// The circuits of the path, in order.
    pub path: Vec<usize>,
    /// The same as a set.
    pub mask: Mask,
    /// The circuits of the approach.
    pub approach: Mask,
    /// The points that it runs over; `true` is reverse.
    pub points: Vec<(usize, bool)>,
    /// Its limit.
    pub limit: i64,
    /// The segments that it comes from and goes to.
    pub lines: [Option<usize>; 2],
    /// Whether trains may change ends where it ends, and go by the first signal back: not on a line, and not where the file gives a reason.
    pub reverses: bool,
    /// The time after which it is released when it was withdrawn.
    pub release: i64,
}

impl Route {
    /// The circuit in rear of the signal, as a set.
    pub const fn entry_mask(&self) -> Mask {
        bit(self.entry)
    }
}

/// A line to a neighbour.
#[derive(Clone, Debug)]
pub struct Line {
    /// Its name.
    pub name: String,
    /// Its circuits.
    pub mask: Mask,
    /// The circuit at the border.
    pub outermost: usize,
    /// The stretch beyond.
    pub outside: usize,
    /// The piece of that stretch.
    pub piece: usize,
    /// Its outer joint.
    pub far: usize,
    /// The joint at the border.
    pub border: usize,
    /// Whether routes lead in and out.
    pub ways: [bool; 2],
}

/// A station and its lines.
#[derive(Clone, Debug)]
pub struct Ground {
    /// The station's name.
    pub name: String,
    /// The names of the circuits, the neighbours' included.
    pub circuits: Vec<String>,
    /// The length of each circuit.
    pub lengths: Vec<i64>,
    /// How many of them the station sees.
    pub seen: usize,
    /// The pieces.
    pub pieces: Vec<Piece>,
    /// The pieces at each joint.
    pub joints: Vec<Vec<usize>>,
    /// The pairs of circuits in which two trains strike each other.
    pub fouls: Vec<(usize, usize)>,
    /// The names of the points.
    pub points: Vec<String>,
    /// The time of each point's stroke.
    pub throw: Vec<i64>,
    /// The routes.
    pub routes: Vec<Route>,
    /// The lines.
    pub lines: Vec<Line>,
    /// The length of a cycle, in ms.
    pub cycle_ms: i64,
    /// The cycles for which a circuit must be reported clear.
    pub clear: i64,
    /// The longest loss of shunt that the file allows for.
    pub loss: i64,
    /// The life of telegrams.
    pub life: i64,
    /// The time that passes before a line turns.
    pub turn: i64,
    /// The time after a start in which the device moves nothing.
    pub start: i64,
    /// The deceleration that every train has, in mm/s².
    pub brake: i64,
    /// The speed of each code.
    pub codes: Vec<i64>,
    /// The limit over each point in reverse: that of the station, or of a route whose own speed is higher.
    pub reverse: Vec<i64>,
    /// The highest speed at which a train runs, so that every approach covers it.
    pub fastest: i64,
    /// The length of the longest train.
    pub longest: i64,
}

/// The set of one circuit.
pub const fn bit(circuit: usize) -> Mask {
    1 << circuit
}

/// The circuits of a set.
pub fn members(mask: Mask) -> impl Iterator<Item = usize> {
    (0..128).filter(move |circuit| mask & bit(*circuit) != 0)
}

fn mask(circuits: impl IntoIterator<Item = usize>) -> Mask {
    circuits.into_iter().fold(0, |all, circuit| all | bit(circuit))
}

/// km/h in mm/s, rounded down.
pub const fn mm_s(kmh: i64) -> i64 {
    kmh * 10_000 / 36
}

/// The least brake that is not under this one, and takes whole mm/s in a cycle: the trains here have no parts of one.
const fn whole(brake: i64, cycle_ms: i64) -> i64 {
    let change = (brake * cycle_ms + 999) / 1000;
    (change * 1000 + cycle_ms - 1) / cycle_ms
}

/// Every two circuits of which the file says so.
fn fouls(model: &Model) -> Vec<(usize, usize)> {
    let of = |point: &atc_layout::model::Point| -> Vec<(usize, usize)> {
        point.circuit.iter().flat_map(|own| point.fouled_in.iter().map(|other| (*own, *other))).collect()
    };
    model.fouling.iter().copied().chain(model.points.iter().flat_map(of)).collect()
}

impl Ground {
    /// Whether two trains strike each other's side, one in circuits of either set.
    pub fn strike(&self, one: Mask, other: Mask) -> bool {
        let both = |a: usize, b: usize| one & bit(a) != 0 && other & bit(b) != 0;
        self.fouls.iter().any(|(a, b)| both(*a, *b) || both(*b, *a))
    }

    /// The ground that a layout describes. Times of the file are rounded so that the trains have the worst that it allows.
    pub fn of(description: &Description, model: &Model) -> Self {
        let station = &description.station;
        let cycle_ms = i64::from(model.values.cycle_ms);
        let cycles = |ms: u32| i64::from(ms) / cycle_ms;
        let mut ground = Self {
            name: station.name.clone(),
            circuits: model.circuits.iter().map(|circuit| circuit.name.clone()).collect(),
            lengths: model.circuits.iter().map(|circuit| i64::from(circuit.length.0) * 1000).collect(),
            seen: model.circuits.len(),
            pieces: Vec::new(),
            joints: model.graph.joints.iter().map(|joint| joint.tracks.clone()).collect(),
            fouls: fouls(model),
            points: model.points.iter().map(|point| point.name.clone()).collect(),
            throw: model.points.iter().map(|point| cycles(point.throw_ms).max(1)).collect(),
            routes: Vec::new(),
            lines: Vec::new(),
            cycle_ms,
            clear: i64::from(model.values.clear),
            loss: cycles(station.times.shunt_loss_ms.value).min(i64::from(model.values.clear) - 2).max(0),
            life: cycles(model.values.telegram_age_ms),
            turn: i64::from(model.values.turn.0),
            start: i64::from(model.values.start.0),
            brake: whole(i64::from(station.braking.deceleration_mm_s2.value), cycle_ms),
            codes: model.values.speeds_kmh.iter().map(|kmh| mm_s(i64::from(*kmh))).collect(),
            reverse: Vec::new(),
            fastest: 0,
            longest: model.values.longest_train.map_or(200_000, |length| i64::from(length.0) * 1000),
        };
        let highest = ground.codes.iter().copied().max().unwrap_or(0);
        let kmh = |given: &Option<atc_layout::At<u16>>| given.as_ref().map(|kmh| mm_s(i64::from(kmh.value)));
        let line = kmh(&station.speed.line_kmh).unwrap_or(highest);
        let reverse = kmh(&station.speed.reverse_kmh).unwrap_or(highest);
        ground.lay(model);
        ground.draw_routes(model);
        let over = |route: &&Route, point| route.points.contains(&(point, true));
        let fastest = |point| ground.routes.iter().filter(|route| over(route, point)).map(|route| route.limit).max();
        ground.reverse = (0..model.points.len()).map(|point| fastest(point).unwrap_or(0).max(reverse)).collect();
        ground.draw_lines(model);
        ground.fastest = line.min(ground.covered());
        ground
    }

    /// The ground of a compiled layout.
    pub fn of_compiled<const R: usize, const P: usize, const N: usize, const S: usize, Z: Size>(
        description: &Description,
        compiled: &Compiled<R, P, N, S, Z>,
    ) -> Self {
        Self::of(description, &compiled.model)
    }

    fn lay(&mut self, model: &Model) {
        for track in &model.graph.tracks {
            let point = match track.kind {
                Kind::Plain => None,
                Kind::Point(point) => Some(point),
            };
            // A way through a circuit of several points runs over at least two pieces of it.
            let points = model.graph.tracks.iter().filter(|other| other.circuit == track.circuit);
            let in_a_row = if points.filter(|other| other.kind != Kind::Plain).count() > 1 { 2 } else { 1 };
            let length = self.lengths[track.circuit] / in_a_row;
            self.pieces.push(Piece { circuit: track.circuit, joints: track.joints.clone(), point, length });
        }
    }

    fn draw_routes(&mut self, model: &Model) {
        for route in &model.routes {
            let path: Vec<usize> = route.circuits().collect();
            let passed = route.path.iter().flat_map(|place| &place.passed);
            self.routes.push(Route {
                name: route.name.clone(),
                start: route.start,
                exit: route.exit,
                entry: route.entry,
                mask: mask(path.iter().copied()),
                path,
                approach: mask(route.approach.iter().copied()),
                points: passed.map(|passed| (passed.point, passed.position == Position::Reverse)).collect(),
                limit: self.codes[usize::from(route.speed.0)],
                lines: [route.from, route.to],
                reverses: route.to.is_none() && route.no_reversal.is_none(),
                release: i64::from(route.release.0),
            });
        }
    }

    fn draw_lines(&mut self, model: &Model) {
        for (number, segment) in model.segments.iter().enumerate() {
            let outermost = segment.circuits[segment.circuits.len() - 1];
            let at_end = |joint: &usize| model.graph.joints[*joint].end == Some(EndKind::Line);
            let Some(border) = model.graph.borders(outermost).into_iter().find(at_end) else { continue };
            let (outside, piece, far) = (self.circuits.len(), self.pieces.len(), self.joints.len());
            self.circuits.push(format!("beyond {}", segment.name));
            self.lengths.push(OUTSIDE_MM);
            self.pieces.push(Piece { circuit: outside, joints: vec![far, border], point: None, length: OUTSIDE_MM });
            self.joints.push(vec![piece]);
            self.joints[border].push(piece);
            self.lines.push(Line {
                name: segment.name.clone(),
                mask: mask(segment.circuits.iter().copied()),
                outermost,
                outside,
                piece,
                far,
                border,
                ways: [0, 1].map(|way| self.routes.iter().any(|route| route.lines[way] == Some(number))),
            });
        }
    }

    /// The highest speed at which every approach covers braking, a telegram's life, and what is run unreported
    /// (`approach-covers-braking`).
    fn covered(&self) -> i64 {
        let mut fastest = i64::MAX;
        for route in &self.routes {
            let metres = self.back(route.start, route.entry, route.approach, 0);
            let lasts = (self.life + self.loss + 2) * self.cycle_ms;
            let fits = |v: &i64| v * v / (2 * self.brake) + v * lasts / 1000 <= metres;
            fastest = fastest.min((0..=60_000).step_by(50).take_while(fits).last().unwrap_or(0));
        }
        fastest
    }

    /// The least distance back from `joint` into `circuit` at which a train is outside `approach`.
    fn back(&self, joint: usize, circuit: usize, approach: Mask, so_far: i64) -> i64 {
        if approach & bit(circuit) == 0 || so_far > 4_000_000 {
            return so_far;
        }
        let mut least = i64::MAX / 2;
        for piece in self.joints[joint].iter().copied().filter(|piece| self.pieces[*piece].circuit == circuit) {
            for exit in self.exits(piece, joint) {
                let behind = self.joints[exit].iter().copied().find(|other| *other != piece);
                let covered = so_far + self.pieces[piece].length;
                let next = behind.map(|piece| self.pieces[piece].circuit);
                if let Some(next) = next.filter(|next| *next < self.seen) {
                    least = least.min(self.back(exit, next, approach, covered));
                }
            }
        }
        least
    }

    /// The joints where a train may leave a piece that it entered at `joint`, whatever the position of its point.
    fn exits(&self, piece: usize, joint: usize) -> Vec<usize> {
        match (self.pieces[piece].point, self.pieces[piece].joints.as_slice()) {
            (Some(_), [toe, normal, reverse]) if *toe == joint => vec![*normal, *reverse],
            (Some(_), [toe, ..]) => vec![*toe],
            (_, joints) => joints.iter().copied().filter(|other| *other != joint).collect(),
        }
    }

    /// The piece on the other side of a joint.
    pub fn across(&self, joint: usize, piece: usize) -> Option<usize> {
        self.joints[joint].iter().copied().find(|other| *other != piece)
    }

    /// Where a train leaves a piece entered at `joint`, with the point there reverse or not; and whether the point must then be reverse.
    pub fn leave(&self, piece: usize, joint: usize, reverse: bool) -> (usize, Option<(usize, bool)>) {
        let it = &self.pieces[piece];
        match (it.point, it.joints.as_slice()) {
            (Some(point), [toe, normal, other]) => {
                if joint == *toe {
                    (if reverse { *other } else { *normal }, Some((point, reverse)))
                } else {
                    (*toe, Some((point, joint == *other)))
                }
            }
            (_, [left, right]) => (if *left == joint { *right } else { *left }, None),
            _ => (joint, None),
        }
    }

    /// Whether a train with its front on this leg faces right, by the plain tracks ahead of it or, where there are none, behind it.
    pub fn faces_right(&self, leg: &Leg) -> bool {
        let plain = |piece: usize| piece < self.pieces.len() && self.pieces[piece].point.is_none();
        let at = |piece: usize, joint: usize, side: usize| self.pieces[piece].joints.get(side) == Some(&joint);
        if plain(leg.piece) {
            return at(leg.piece, leg.exit, 1);
        }
        let (mut piece, mut joint) = (leg.piece, leg.exit);
        while let Some(next) = self.across(joint, piece) {
            if plain(next) {
                return at(next, joint, 0);
            }
            (piece, joint) = (next, self.leave(next, joint, false).0);
        }
        let (mut piece, mut joint) = (leg.piece, leg.enter);
        while let Some(before) = self.across(joint, piece) {
            if plain(before) {
                return at(before, joint, 1);
            }
            (piece, joint) = (before, self.leave(before, joint, false).0);
        }
        true
    }

    /// The names of a set.
    pub fn named(&self, mask: Mask) -> String {
        if mask == 0 {
            return "nothing".to_owned();
        }
        if mask.count_ones() > 4 && usize::try_from(mask.count_ones()).is_ok_and(|count| count >= self.seen) {
            return "every circuit".to_owned();
        }
        members(mask).map(|circuit| self.circuits[circuit].as_str()).collect::<Vec<_>>().join(", ")
    }
}
