//! Random stations that trains can run through: columns of circuits between two stretches of plain line, joined by points.

use atc_kernel::interlocking::Position;
use atc_tests::sketch::{Line, Need, Sketch, Way};

/// Random numbers, the same for the same seed.
pub struct Dice(pub u64);

impl Dice {
    fn next(&mut self) -> u64 {
        // xorshift64
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        self.0
    }

    /// A number below `limit`, which is not 0.
    pub fn below(&mut self, limit: usize) -> usize {
        usize::try_from(self.next() >> 33).expect("31 bits") % limit
    }

    /// Whether one of `many` comes up.
    pub fn one_in(&mut self, many: usize) -> bool {
        self.below(many) == 0
    }

    pub fn pick<'a, T>(&mut self, list: &'a [T]) -> &'a T {
        &list[self.below(list.len())]
    }

    pub fn side(&mut self) -> Position {
        if self.one_in(2) { Position::Normal } else { Position::Reverse }
    }

    /// From `least` to `most`.
    fn between(&mut self, least: u16, most: u16) -> u16 {
        least + u16::try_from(self.below(usize::from(most - least) + 1)).expect("small")
    }
}

/// A point that chooses among the neighbours on one side of a circuit.
#[derive(Clone, Copy, Debug)]
pub struct Fork {
    pub circuit: usize,
    pub rightward: bool,
}

/// A station and how its tracks hang together.
pub struct Station {
    pub sketch: Sketch,
    /// The circuits that adjoin each circuit on the left and on the right.
    pub left: Vec<Vec<usize>>,
    pub right: Vec<Vec<usize>>,
    /// The outer ends of the two segments.
    pub ends: [usize; 2],
    /// For each point, where it lies.
    pub forks: Vec<Fork>,
}

impl Station {
    pub fn ahead(&self, circuit: usize, rightward: bool) -> &[usize] {
        if rightward { &self.right[circuit] } else { &self.left[circuit] }
    }

    fn link(&mut self, left: usize, right: usize) {
        if !self.right[left].contains(&right) {
            self.right[left].push(right);
            self.left[right].push(left);
        }
    }

    /// The position of the fork that leads from `circuit` to its neighbour `to`.
    pub fn position(&self, circuit: usize, rightward: bool, to: usize) -> Position {
        if self.ahead(circuit, rightward).first() == Some(&to) { Position::Normal } else { Position::Reverse }
    }

    pub fn random(dice: &mut Dice) -> Self {
        let middle: Vec<usize> = (0..=dice.below(3)).map(|_| 1 + dice.below(3)).collect();
        let widths: Vec<usize> = [vec![1], middle, vec![1]].concat();
        let mut columns: Vec<Vec<usize>> = Vec::new();
        let mut count = 0;
        for width in widths {
            columns.push((count..count + width).collect());
            count += width;
        }
        let mut lines: Vec<Vec<usize>> = Vec::new();
        for _ in 0..2 {
            let length = 1 + dice.below(3);
            lines.push((count..count + length).collect());
            count += length;
        }
        let mut station = Self {
            sketch: Sketch::default(),
            left: vec![Vec::new(); count],
            right: vec![Vec::new(); count],
            ends: [*lines[0].last().expect("a circuit"), *lines[1].last().expect("a circuit")],
            forks: Vec::new(),
        };
        station.join(dice, &columns, &lines);
        station.sketch.lengths = (0..count).map(|_| dice.between(50, 400)).collect();
        station.sketch.start = u16::try_from(dice.below(4)).expect("small");
        station.sketch.settle = u8::try_from(dice.below(3)).expect("small");
        station.sketch.clear = u8::try_from(dice.between(1, 3)).expect("small");
        station.sketch.turn = dice.between(1, 5);
        station.sketch.braking = vec![0, 60, 130, 300, 500, 800, 1200, 2000];
        station.sketch.braking.truncate(4 + dice.below(5));
        let throats = [columns[0][0], columns[columns.len() - 1][0]];
        let lines = lines.into_iter().zip(throats).enumerate();
        let line = |(side, (circuits, throat))| Line { circuits, throat: Some(throat), leftward: side == 0 };
        station.sketch.segments = lines.map(line).collect();
        for _ in 0..3 + dice.below(6) {
            let way = station.way(dice, throats);
            station.sketch.routes.push(way);
        }
        station.relate(dice);
        station.sketch = station.sketch.apart();
        station
    }

    fn join(&mut self, dice: &mut Dice, columns: &[Vec<usize>], lines: &[Vec<usize>]) {
        for pair in columns.windows(2) {
            let (one, two) = (&pair[0], &pair[1]);
            for place in 0..one.len().max(two.len()) {
                self.link(
                    one[place * one.len() / one.len().max(two.len())],
                    two[place * two.len() / one.len().max(two.len())],
                );
            }
            if dice.one_in(2) {
                self.link(*dice.pick(one), *dice.pick(two));
            }
        }
        let (first, last) = (columns[0][0], columns[columns.len() - 1][0]);
        self.link(lines[0][0], first);
        self.link(last, lines[1][0]);
        for pair in lines[0].windows(2) {
            self.link(pair[1], pair[0]);
        }
        for pair in lines[1].windows(2) {
            self.link(pair[0], pair[1]);
        }
        for circuit in columns.iter().flatten().copied() {
            for rightward in [false, true] {
                if self.ahead(circuit, rightward).len() > 1 {
                    self.forks.push(Fork { circuit, rightward });
                    let mut detectors = vec![circuit];
                    if dice.one_in(4) {
                        let beside = *dice.pick(self.ahead(circuit, rightward));
                        // Plain line is no part of a station's paths.
                        if !lines.iter().flatten().any(|other| *other == beside) {
                            detectors.push(beside);
                        }
                    }
                    self.sketch.points.push(detectors);
                }
            }
        }
    }

    /// A random route.
    fn way(&self, dice: &mut Dice, throats: [usize; 2]) -> Way {
        let rightward = dice.one_in(2);
        let (near, far) = if rightward { (0, 1) } else { (1, 0) };
        let inner = &self.sketch.segments[near].circuits[0];
        let inside: Vec<usize> = (0..self.left.len())
            .filter(|circuit| !self.sketch.segments.iter().any(|line| line.circuits.contains(circuit)))
            .filter(|circuit| *circuit != throats[far])
            .collect();
        let entry = if dice.one_in(2) { *inner } else { *dice.pick(&inside) };
        let mut walk = vec![entry];
        let length = 1 + dice.below(4);
        while walk.len() <= length && walk[walk.len() - 1] != throats[far] {
            walk.push(*dice.pick(self.ahead(walk[walk.len() - 1], rightward)));
        }
        let path = walk[1..].to_vec();
        let last = path[path.len() - 1];
        let goes_out = last == throats[far];
        let mut overlap = Vec::new();
        if !goes_out && !dice.one_in(4) {
            overlap.push(*dice.pick(self.ahead(last, rightward)));
        }
        let mut sides: Vec<Option<Position>> = vec![None; self.forks.len()];
        let whole = [walk, overlap.clone()].concat();
        for (point, fork) in self.forks.iter().enumerate() {
            let place = whole.iter().position(|circuit| *circuit == fork.circuit);
            let next = place.and_then(|place| {
                if fork.rightward == rightward { whole.get(place + 1) } else { whole.get(place.checked_sub(1)?) }
            });
            sides[point] = next.map(|next| self.position(fork.circuit, fork.rightward, *next));
        }
        let mut needs = |circuit: usize, dice: &mut Dice| -> Vec<Need> {
            let touched = self.sketch.points.iter().enumerate().filter(|(_, detectors)| detectors.contains(&circuit));
            touched.map(|(point, _)| (point, *sides[point].get_or_insert(dice.side()))).collect()
        };
        let mut places: Vec<(usize, Vec<Need>)> =
            path.iter().map(|circuit| (*circuit, needs(*circuit, dice))).collect();
        let overlap = (overlap.clone(), overlap.iter().flat_map(|circuit| needs(*circuit, dice)).collect::<Vec<_>>());
        if !self.forks.is_empty() && dice.one_in(4) {
            // A flank point.
            let point = dice.below(self.forks.len());
            let side = *sides[point].get_or_insert(dice.side());
            let place = dice.below(places.len());
            if !places[place].1.contains(&(point, side)) {
                places[place].1.push((point, side));
            }
        }
        let behind = self.ahead(entry, !rightward).iter().take(2).copied();
        let cab = dice.below(2) == 0;
        let calling_on = !overlap.0.is_empty() && !cab && dice.one_in(3);
        Way {
            leftward: !rightward,
            entry,
            approach: [entry].into_iter().chain(behind).collect(),
            path: places,
            beyond: if calling_on { overlap.0.clone() } else { self.ahead(last, rightward).to_vec() },
            overlap,
            from: (entry == *inner).then_some(near),
            to: goes_out.then_some(far),
            drive: dice.between(1, 6),
            release: dice.between(1, 8),
            stay: dice.between(1, 5),
            speed: u8::try_from(1 + dice.below(self.sketch.braking.len() - 1)).expect("small"),
            overlap_speed: u8::try_from(1 + dice.below(self.sketch.braking.len() - 1)).expect("small"),
            cab,
            calling_on,
            ..Way::default()
        }
    }

    /// Routes that continue, and declared conflicts.
    fn relate(&mut self, dice: &mut Dice) {
        for one in 0..self.sketch.routes.len() {
            for other in 0..self.sketch.routes.len() {
                let (way, next) = (&self.sketch.routes[one], &self.sketch.routes[other]);
                let follows = next.entry == way.last() && next.leftward == way.leftward;
                if follows && !way.calling_on && !dice.one_in(4) {
                    self.sketch.routes[one].continuing.push(other);
                }
                if other < one && dice.one_in(10) {
                    self.sketch.routes[one].conflicts.push(other);
                    self.sketch.routes[other].conflicts.push(one);
                }
            }
        }
    }
}
