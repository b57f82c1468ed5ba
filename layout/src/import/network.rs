//! Tracks as other forms describe them: edges with a length, switches between their ends, and cuts where circuits meet.

use std::collections::{BTreeMap, BTreeSet};

use crate::at::At;
use crate::form::{Circuit, Crossing, End, EndKind, Point, Station};

/// An end of an edge.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Side {
    /// Where its positions begin.
    Begin,
    /// Where they end.
    End,
}

/// An end of an edge, by number.
pub type EdgeEnd = (usize, Side);

/// A track without branches.
#[derive(Clone, Debug)]
pub struct Edge {
    /// Its name in the file.
    pub name: String,
    /// Where it begins, in metres: 0, or where a buffer stop stands on it.
    pub begin: f64,
    /// Where it ends, in metres: its length, or where a buffer stop stands on it.
    pub length: f64,
}

/// A switch.
#[derive(Clone, Debug)]
pub struct Switch {
    /// Its name.
    pub name: At<String>,
    /// Toe, normal leg, reverse leg.
    pub ports: [EdgeEnd; 3],
    /// The longest time of its stroke in ms, if the file gives it.
    pub throw_ms: Option<u32>,
}

/// A centimetre is lost in the digits of coordinates.
pub const NEAR: f64 = 0.01;

/// The longest edge, in metres: the longest circuit of a layout.
pub const LONGEST: f64 = 65_534.0;

/// A place where circuits meet.
#[derive(Clone, Debug)]
pub struct Cut {
    /// Its name.
    pub name: String,
    /// The edge.
    pub edge: usize,
    /// Metres from its begin.
    pub at: f64,
}

/// The tracks.
#[derive(Clone, Debug, Default)]
pub struct Network {
    /// The edges.
    pub edges: Vec<Edge>,
    /// Ends that are joined.
    pub links: Vec<(EdgeEnd, EdgeEnd)>,
    /// Pairs of links that cross each other.
    pub crossings: Vec<[usize; 2]>,
    /// The switches.
    pub switches: Vec<Switch>,
    /// The cuts.
    pub cuts: Vec<Cut>,
    /// The names of buffer stops, and the ends they stand at.
    pub buffers: Vec<(String, EdgeEnd)>,
}

/// A part of an edge between two cuts.
struct Piece {
    edge: usize,
    from: f64,
    to: f64,
    /// The cuts at its ends; none at an end of the edge.
    cuts: [Option<usize>; 2],
}

/// What a circuit is made of.
#[derive(Default)]
pub struct Area {
    /// The joints at its borders: cuts and ends of the tracks.
    pub borders: BTreeSet<String>,
    /// Those of them that are cuts.
    pub cuts: BTreeSet<String>,
    /// Those of them that are buffer stops.
    pub stops: BTreeSet<String>,
}

/// A network divided into circuits.
pub struct Divided {
    pieces: Vec<Piece>,
    /// The circuits.
    pub areas: Vec<Area>,
    area_of: Vec<usize>,
    at_end: BTreeMap<EdgeEnd, EdgeEnd>,
    ports: BTreeMap<EdgeEnd, (usize, usize)>,
    ends: BTreeMap<EdgeEnd, (String, EndKind)>,
}

impl Network {
    /// The edge of this name.
    pub fn named(&self, name: &str) -> Option<usize> {
        self.edges.iter().position(|edge| edge.name == name)
    }

    /// The edges of the normal and the reverse leg of a switch.
    pub fn legs(&self, switch: usize) -> Option<[usize; 2]> {
        let [_, (normal, _), (reverse, _)] = self.switches.get(switch)?.ports;
        Some([normal, reverse])
    }

    /// Has an edge end at a buffer stop: at its end that leads nowhere, with nothing of `others` beyond the stop. Which end that is, if
    /// there is one; the nearer one of two.
    pub fn stop(&mut self, edge: usize, at: f64, others: &[(usize, f64)]) -> Option<Side> {
        let leads_on = |end: EdgeEnd| {
            let linked = self.links.iter().any(|(one, other)| *one == end || *other == end);
            linked || self.switches.iter().any(|switch| switch.ports.contains(&end))
        };
        let is_last = |side: Side| {
            let within = |place: f64| if side == Side::Begin { place >= at - NEAR } else { place <= at + NEAR };
            others.iter().all(|(on, place)| *on != edge || within(*place))
        };
        let nearer_begins = at * 2.0 < self.edges[edge].length;
        let sides = if nearer_begins { [Side::Begin, Side::End] } else { [Side::End, Side::Begin] };
        let side = sides.into_iter().find(|side| !leads_on((edge, *side)) && is_last(*side))?;
        let given = &mut self.edges[edge];
        match side {
            Side::Begin => given.begin = given.begin.max(at),
            Side::End => given.length = given.length.min(at),
        }
        Some(side)
    }

    /// Divides the tracks at the cuts.
    pub fn divide(&self) -> Divided {
        let mut pieces = Vec::new();
        for (edge, given) in self.edges.iter().enumerate() {
            let mut cuts: Vec<usize> = (0..self.cuts.len()).filter(|cut| self.cuts[*cut].edge == edge).collect();
            cuts.sort_by(|a, b| self.cuts[*a].at.total_cmp(&self.cuts[*b].at));
            let mut from = (given.begin, None);
            for cut in cuts {
                pieces.push(Piece { edge, from: from.0, to: self.cuts[cut].at, cuts: [from.1, Some(cut)] });
                from = (self.cuts[cut].at, Some(cut));
            }
            pieces.push(Piece { edge, from: from.0, to: given.length, cuts: [from.1, None] });
        }
        let mut at_end = BTreeMap::new();
        for (one, other) in &self.links {
            at_end.insert(*one, *other);
            at_end.insert(*other, *one);
        }
        let mut ports = BTreeMap::new();
        for (number, switch) in self.switches.iter().enumerate() {
            for (port, end) in switch.ports.iter().enumerate() {
                ports.insert(*end, (number, port));
            }
        }
        let buffers: BTreeMap<EdgeEnd, &String> = self.buffers.iter().map(|(name, end)| (*end, name)).collect();
        let mut ends = BTreeMap::new();
        for (edge, given) in self.edges.iter().enumerate() {
            for (side, word) in [(Side::Begin, "begin"), (Side::End, "end")] {
                let end = (edge, side);
                if at_end.contains_key(&end) || ports.contains_key(&end) {
                    continue;
                }
                let made = match buffers.get(&end) {
                    Some(name) => ((*name).clone(), EndKind::Buffer),
                    None => (format!("{} {word}", given.name), EndKind::Line),
                };
                ends.insert(end, made);
            }
        }
        let mut divided = Divided { pieces, areas: Vec::new(), area_of: Vec::new(), at_end, ports, ends };
        divided.unite(self);
        divided
    }
}

impl Divided {
    fn piece_at(&self, (edge, side): EdgeEnd) -> Option<usize> {
        let place = usize::from(side == Side::End);
        self.pieces.iter().position(|piece| piece.edge == edge && piece.cuts[place].is_none())
    }

    /// Puts pieces into one area that no cut divides.
    fn unite(&mut self, network: &Network) {
        let mut root: Vec<usize> = (0..self.pieces.len()).collect();
        let crossed = network.crossings.iter().map(|pair| pair.map(|link| network.links[link].0).to_vec());
        let joined = network.links.iter().map(|(one, other)| vec![*one, *other]);
        let switched = network.switches.iter().map(|switch| switch.ports.to_vec());
        for ends in joined.chain(switched).chain(crossed) {
            let pieces: Vec<usize> = ends.iter().filter_map(|end| self.piece_at(*end)).collect();
            for pair in pieces.windows(2) {
                let (one, other) = (find(&mut root, pair[0]), find(&mut root, pair[1]));
                root[one.max(other)] = one.min(other);
            }
        }
        let mut numbers = BTreeMap::new();
        for piece in 0..self.pieces.len() {
            let top = find(&mut root, piece);
            let number = *numbers.entry(top).or_insert(self.areas.len());
            if number == self.areas.len() {
                self.areas.push(Area::default());
            }
            self.area_of.push(number);
        }
        for (number, area) in self.area_of.iter().enumerate() {
            for side in [Side::Begin, Side::End] {
                if let Some(name) = border(&self.pieces[number], side, network, &self.ends) {
                    match self.ends.values().find(|(end, _)| *end == name).map(|(_, kind)| kind) {
                        Some(EndKind::Line) => {}
                        Some(EndKind::Buffer) => drop(self.areas[*area].stops.insert(name.clone())),
                        None => drop(self.areas[*area].cuts.insert(name.clone())),
                    }
                    self.areas[*area].borders.insert(name);
                }
            }
        }
    }

    /// Gives the areas other numbers: `order` lists the old ones.
    pub fn reorder(&mut self, order: &[usize]) {
        let areas = std::mem::take(&mut self.areas);
        let mut areas: Vec<Option<Area>> = areas.into_iter().map(Some).collect();
        self.areas = order.iter().filter_map(|old| areas[*old].take()).collect();
        for area in &mut self.area_of {
            *area = order.iter().position(|old| old == area).unwrap_or(0);
        }
    }

    /// The area on each side of a cut: towards the begin and towards the end of its edge.
    pub fn beside(&self, cut: usize) -> [Option<usize>; 2] {
        let at = |place: usize| {
            self.pieces.iter().position(|piece| piece.cuts[place] == Some(cut)).map(|piece| self.area_of[piece])
        };
        [at(1), at(0)]
    }

    /// Names of the areas by their borders; a second one between the same borders gets a number.
    pub fn names(&self) -> Vec<At<String>> {
        let mut used: BTreeMap<String, usize> = BTreeMap::new();
        let made = self.areas.iter().enumerate().map(|(number, area)| {
            let name = area.borders.iter().cloned().collect::<Vec<_>>().join("+");
            let name = if name.is_empty() { format!("area {number}") } else { name };
            let count = used.entry(name.clone()).and_modify(|count| *count += 1).or_insert(1);
            At::derived(if *count > 1 { format!("{name} #{count}") } else { name })
        });
        made.collect()
    }

    /// The pieces of an area: edge, and metres from its begin.
    pub fn pieces_of(&self, area: usize) -> impl Iterator<Item = (usize, f64, f64)> + '_ {
        let pieces = self.pieces.iter().zip(&self.area_of).filter(move |(_, of)| **of == area);
        pieces.map(|(piece, _)| (piece.edge, piece.from, piece.to))
    }

    /// The areas that a stretch of an edge runs through, in metres from its begin.
    pub fn along(&self, edge: usize, from: f64, to: f64) -> BTreeSet<usize> {
        let pieces = self.pieces.iter().zip(&self.area_of).filter(|(piece, _)| piece.edge == edge);
        let run_through = pieces.filter(|(piece, _)| piece.from < to && from < piece.to || piece.from >= piece.to);
        run_through.map(|(_, area)| *area).collect()
    }

    /// The end that this one is joined to without a switch between them.
    pub fn linked(&self, end: EdgeEnd) -> Option<EdgeEnd> {
        self.at_end.get(&end).copied()
    }

    /// The name of an end of the tracks, and the area there.
    pub fn end_at(&self, end: EdgeEnd) -> Option<(&str, usize)> {
        let (name, _) = self.ends.get(&end)?;
        Some((name, *self.area_of.get(self.piece_at(end)?)?))
    }

    /// Writes circuits, points and ends into a layout; `names` are those of the areas.
    pub fn write(&self, network: &Network, names: &[At<String>], station: &mut Station) {
        let mut circuits: Vec<Circuit> =
            names.iter().map(|name| Circuit { name: name.clone(), ..Circuit::default() }).collect();
        let mut legs: BTreeMap<(usize, usize), String> = BTreeMap::new();
        let mut done = BTreeSet::new();
        let mut inner = 0;
        let taken: BTreeSet<&str> = network.cuts.iter().map(|cut| cut.name.as_str()).collect();
        let mut chains: Vec<Vec<(Stop, Stop, f64)>> = self.areas.iter().map(|_| Vec::new()).collect();
        for piece in 0..self.pieces.len() {
            if !done.insert(piece) {
                continue;
            }
            let mut length = self.pieces[piece].to - self.pieces[piece].from;
            let left = self.run(piece, Side::Begin, network, &mut done, &mut length);
            let right = self.run(piece, Side::End, network, &mut done, &mut length);
            chains[self.area_of[piece]].push((left, right, length));
        }
        for (area, chains) in chains.iter().enumerate() {
            for (left, right, _) in chains {
                match (left, right) {
                    (Stop::Border(left), Stop::Border(right)) => {
                        let (left, right) = (At::derived(left.clone()), At::derived(right.clone()));
                        let circuit = &mut circuits[area];
                        if circuit.left.is_none() {
                            (circuit.left, circuit.right) = (Some(left), Some(right));
                        } else {
                            circuit.crossings.push(Crossing { left, right, ..Crossing::default() });
                        }
                    }
                    (Stop::Port(switch, port), Stop::Border(name)) | (Stop::Border(name), Stop::Port(switch, port)) => {
                        legs.insert((*switch, *port), name.clone());
                    }
                    (Stop::Port(one, port), Stop::Port(other, port_of_other)) => {
                        let name = loop {
                            inner += 1;
                            let name = format!("inner {inner}");
                            if !taken.contains(name.as_str()) {
                                break name;
                            }
                        };
                        legs.insert((*one, *port), name.clone());
                        legs.insert((*other, *port_of_other), name);
                    }
                }
            }
            circuits[area].length_m = At::derived(shortest(chains));
        }
        station.circuits = circuits;
        for (number, switch) in network.switches.iter().enumerate() {
            let circuit = self.piece_at(switch.ports[0]).map_or(0, |piece| self.area_of[piece]);
            let leg = |port: usize| {
                At::derived(legs.get(&(number, port)).cloned().unwrap_or_else(|| format!("{} {port}", switch.name)))
            };
            station.points.push(Point {
                name: switch.name.clone(),
                circuit: At::derived(names[circuit].value.clone()),
                toe: leg(0),
                normal: leg(1),
                reverse: leg(2),
                throw_ms: switch.throw_ms.map(At::derived),
                ..Point::default()
            });
        }
        for (name, kind) in self.ends.values() {
            station.ends.push(End { joint: At::derived(name.clone()), kind: *kind });
        }
    }

    /// Runs on from `piece` over links until a border or a switch.
    fn run(&self, piece: usize, side: Side, network: &Network, done: &mut BTreeSet<usize>, length: &mut f64) -> Stop {
        let (mut piece, mut side) = (piece, side);
        loop {
            if let Some(name) = border(&self.pieces[piece], side, network, &self.ends) {
                return Stop::Border(name);
            }
            let end = (self.pieces[piece].edge, side);
            if let Some((switch, port)) = self.ports.get(&end) {
                return Stop::Port(*switch, *port);
            }
            let Some(next) = self.at_end.get(&end) else {
                return Stop::Border(format!("end of {}", network.edges[end.0].name));
            };
            match self.piece_at(*next) {
                Some(number) if done.insert(number) => {
                    *length += self.pieces[number].to - self.pieces[number].from;
                    piece = number;
                    side = if next.1 == Side::Begin { Side::End } else { Side::Begin };
                }
                // A ring without a border: it is cut open here.
                _ => return Stop::Border(format!("ring of {}", network.edges[end.0].name)),
            }
        }
    }
}

/// Where a chain of pieces ends.
#[derive(Clone, Debug)]
enum Stop {
    Border(String),
    Port(usize, usize),
}

fn border(piece: &Piece, side: Side, network: &Network, ends: &BTreeMap<EdgeEnd, (String, EndKind)>) -> Option<String> {
    match piece.cuts[usize::from(side == Side::End)] {
        Some(cut) => Some(network.cuts[cut].name.clone()),
        None => ends.get(&(piece.edge, side)).map(|(name, _)| name.clone()),
    }
}

/// The shortest way from border to border, in whole metres, at least 1. Over switches it is taken from toe to leg only.
fn shortest(chains: &[(Stop, Stop, f64)]) -> u16 {
    let mut best = f64::INFINITY;
    for (number, (left, right, length)) in chains.iter().enumerate() {
        for (from, to) in [(left, right), (right, left)] {
            if matches!(from, Stop::Border(_)) {
                go(chains, to, *length, &mut vec![number], &mut best);
            }
        }
    }
    // Rounded down: a distance to a stop must not be longer than the track. A centimetre is lost in the digits of coordinates.
    let metres = if best.is_finite() { (best + 0.01).floor().clamp(1.0, LONGEST) } else { 1.0 };
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped to the range of the type")]
    let metres = metres as u16;
    metres
}

fn go(chains: &[(Stop, Stop, f64)], at: &Stop, length: f64, used: &mut Vec<usize>, best: &mut f64) {
    if length >= *best || used.len() > 16 {
        return;
    }
    let Stop::Port(switch, port) = at else {
        *best = length;
        return;
    };
    for (number, (left, right, more)) in chains.iter().enumerate() {
        for (from, to) in [(left, right), (right, left)] {
            let Stop::Port(same, out) = from else { continue };
            if same == switch && (*port == 0) != (*out == 0) && !used.contains(&number) {
                used.push(number);
                go(chains, to, length + more, used, best);
                used.pop();
            }
        }
    }
}

/// The piece that stands for all that are united with `piece`.
fn find(root: &mut [usize], mut piece: usize) -> usize {
    while root[piece] != piece {
        root[piece] = root[root[piece]];
        piece = root[piece];
    }
    piece
}
