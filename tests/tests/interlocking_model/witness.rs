//! Section 4 of the digest of the patents once more, written from its text and from `spec/interlocking.md`, and not from the kernel:
//! sets are lists, a path is a list of places each with a state of its own, and a refusal is the list of every reason that applies.

use std::collections::BTreeSet;

use atc_kernel::interlocking::{Position, Refusal, Travel};
use atc_tests::sketch::{Need, Sketch, Way};

mod authority;
mod held;
mod refusal;
mod unswept;

pub use held::{Behind, Held, Place, Stage};
use unswept::Unswept;

pub type Set = BTreeSet<usize>;

/// A segment.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Stretch {
    pub travel: Option<Travel>,
    /// For how many cycles the neighbour has not been permitted to send; more than the turn time is the turn time.
    pub withdrawn: u16,
    /// Whether its last direction was towards the station.
    pub came: bool,
}

/// What is asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ask {
    Set(usize),
    Withdraw(usize),
    Drive(usize, Position),
    Turn(usize, Travel),
}

/// What staff command.
#[derive(Clone, Debug, Default)]
pub struct Commands {
    pub block: Set,
    pub unblock: Set,
    pub restrict: Set,
    pub speed: u8,
    pub lift: Set,
}

/// What is read in one cycle.
#[derive(Clone, Debug, Default)]
pub struct Read {
    pub occupied: Set,
    /// The detections: a point that is detected in both positions is here twice.
    pub detected: Vec<Need>,
    pub ask: Option<Ask>,
    pub commands: Commands,
    pub consent: Set,
}

/// What may be run over by the train in, or to come to, `train`: the circuits in order, and whether nothing is missing of them.
#[derive(Clone, Debug)]
struct Leave {
    train: usize,
    circuits: Vec<usize>,
    whole: bool,
    speed: u8,
    leftward: bool,
    /// The line to which the route leads, of which it is.
    out: Option<usize>,
    /// The line of whose throat it is: for a train that came by a route to that line.
    behind: Option<usize>,
}

/// A telegram.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Telegram {
    pub stop: usize,
    /// Whether it is for a train that faces left; none if it is for none.
    pub leftward: Option<bool>,
    pub speed: u8,
    pub hold: Set,
}

/// What is commanded.
#[derive(Debug)]
pub struct Said {
    pub proceed: Set,
    pub drives: BTreeSet<(usize, bool)>,
    pub permits: Set,
    pub confirmed: Set,
    /// Every reason to refuse; none if it is accepted.
    pub answer: Option<Vec<Refusal>>,
    pub telegrams: Vec<Telegram>,
}

/// The device.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Witness {
    /// The last reports of the circuits, the latest last, as many as are needed.
    reports: Vec<Set>,
    /// In this cycle, where the neighbour permits to send.
    sends: Set,
    /// For how many cycles it has run, up to the time after a start.
    age: u16,
    /// The detections of the last cycle, and for how many cycles each point has been where it is.
    seen: Vec<Need>,
    still: Vec<u8>,
    pub routes: Vec<Held>,
    pub stretches: Vec<Stretch>,
    blocked: Set,
    confirmed: Set,
    limits: Vec<u8>,
    /// What trains from before the start may still run over.
    pub unswept: Unswept,
}

fn meets(one: &[usize], other: &Set) -> bool {
    one.iter().any(|item| other.contains(item))
}

/// Whether somebody may be on the approach who is not at the signal yet.
fn waits(way: &Way, occupied: &Set) -> bool {
    way.approach.iter().any(|circuit| *circuit != way.entry && occupied.contains(circuit))
}

fn common(one: &[usize], other: &[usize]) -> bool {
    one.iter().any(|item| other.contains(item))
}

fn oppose(one: &[Need], other: &[Need]) -> bool {
    one.iter().any(|(point, position)| other.iter().any(|(same, wanted)| point == same && position != wanted))
}

impl Witness {
    pub fn new(sketch: &Sketch) -> Self {
        let all: Set = (0..sketch.lengths.len()).collect();
        Self {
            reports: Vec::new(),
            sends: Set::new(),
            age: 0,
            seen: Vec::new(),
            still: vec![0; sketch.points.len()],
            routes: sketch.routes.iter().map(Held::idle).collect(),
            stretches: sketch.segments.iter().map(|_| Stretch { travel: None, withdrawn: 0, came: false }).collect(),
            blocked: all,
            confirmed: Set::new(),
            limits: vec![0; sketch.lengths.len()],
            unswept: Unswept::new(sketch),
        }
    }

    /// Occupied at once; clear once every one of the last reports says so, as many as the plan asks for.
    fn track(&mut self, sketch: &Sketch, reported: &Set) -> Set {
        self.reports.push(reported.clone());
        let needed = usize::from(sketch.clear);
        if self.reports.len() < needed {
            return (0..sketch.lengths.len()).collect();
        }
        self.reports.drain(..self.reports.len() - needed);
        self.reports.iter().flatten().copied().collect()
    }

    fn obey(&mut self, commands: &Commands) {
        let unblocked = commands.unblock.difference(&commands.block);
        for circuit in unblocked {
            self.blocked.remove(circuit);
            self.confirmed.remove(circuit);
        }
        self.blocked.extend(&commands.block);
        for (circuit, limit) in self.limits.iter_mut().enumerate() {
            if commands.lift.contains(&circuit) {
                *limit = 7;
            }
            if commands.restrict.contains(&circuit) {
                *limit = commands.speed.min(*limit);
            }
        }
    }

    pub fn cycle(&mut self, sketch: &Sketch, read: &Read) -> Said {
        let occupied = self.track(sketch, &read.occupied);
        self.obey(&read.commands);
        self.sends.clone_from(&read.consent);
        for (held, way) in self.routes.iter_mut().zip(&sketch.routes) {
            held.follow(way, &occupied);
        }
        if self.age >= sketch.start {
            self.unswept.sweep(sketch, &occupied);
        }
        let seen: Vec<Need> = read
            .detected
            .iter()
            .filter(|(point, _)| read.detected.iter().filter(|other| other.0 == *point).count() == 1)
            .copied()
            .collect();
        let mut alone = None;
        let answer = read.ask.map(|ask| {
            let mut reasons = self.refuse(sketch, ask, &occupied, &seen, &read.consent);
            if let Ask::Turn(segment, Travel::Away) = ask {
                // The command withdraws the permission even if it has to wait.
                if reasons.iter().all(|reason| *reason == Refusal::Waiting) {
                    let stretch = &mut self.stretches[segment];
                    if stretch.travel == Some(Travel::Toward) {
                        stretch.travel = None;
                    }
                }
            }
            if reasons.is_empty() {
                match ask {
                    Ask::Set(route) => {
                        let held = &mut self.routes[route];
                        if let Stage::Releasing(time) = held.stage {
                            held.stage = Stage::InUse(time);
                        } else {
                            let idle = Held::idle(&sketch.routes[route]);
                            *held = Held { stage: Stage::Provisional(0), overlap: true, ..idle };
                        }
                    }
                    Ask::Withdraw(route) => self.routes[route].withdraw(&sketch.routes[route], &occupied),
                    Ask::Drive(point, position) => alone = Some((point, position)),
                    Ask::Turn(segment, travel) => {
                        self.stretches[segment].travel = Some(travel);
                        self.stretches[segment].came = travel == Travel::Toward;
                    }
                }
            }
            reasons.dedup();
            reasons
        });
        let drives = self.drives(sketch, alone, &occupied, &seen);
        let firm = self.settled(sketch, seen, &drives);
        self.reserve(sketch, &occupied, &firm);
        if self.age >= sketch.start {
            self.confirm(sketch, &occupied, &firm);
        }
        // Only now: who looked at these times in this cycle has looked at the cycles before.
        for stretch in &mut self.stretches {
            let permitted = stretch.travel == Some(Travel::Toward);
            stretch.withdrawn = if permitted { 0 } else { (stretch.withdrawn + 1).min(sketch.turn) };
        }
        self.age = (self.age + 1).min(sketch.start);
        let proceed: Set = (0..self.routes.len())
            .filter(|route| self.routes[*route].stage == Stage::Set && self.sound(sketch, *route, &occupied, &firm))
            .collect();
        let telegrams = self.telegrams(sketch, &occupied, &proceed, &firm);
        self.sends.clear();
        self.unswept.forget();
        let permitted = |stretch: &Stretch| stretch.travel == Some(Travel::Toward);
        Said {
            permits: (0..self.stretches.len())
                .filter(|segment| permitted(&self.stretches[*segment]) && !self.closed(sketch, *segment))
                .collect(),
            confirmed: self.confirmed.clone(),
            telegrams,
            drives: drives.into_iter().map(|(point, position)| (point, position == Position::Normal)).collect(),
            proceed,
            answer,
        }
    }

    /// The points that have been where they are, undriven, for as many cycles as the plan asks for.
    fn settled(&mut self, sketch: &Sketch, seen: Vec<Need>, drives: &[Need]) -> Vec<Need> {
        let undriven = |need: &&Need| !drives.iter().any(|(driven, _)| *driven == need.0);
        for (point, still) in self.still.iter_mut().enumerate() {
            let stays = seen.iter().filter(undriven).any(|need| need.0 == point && self.seen.contains(need));
            *still = if stays { (*still + 1).min(sketch.settle) } else { 0 };
        }
        let firm = seen.iter().filter(undriven).filter(|need| self.still[need.0] >= sketch.settle).copied().collect();
        self.seen = if sketch.settle > 0 { seen } else { Vec::new() };
        firm
    }

    /// Points that provisional routes and an individual command want elsewhere than they are; not under a train, not
    /// locked, not in a block.
    fn drives(&self, sketch: &Sketch, alone: Option<Need>, occupied: &Set, seen: &[Need]) -> Vec<Need> {
        let routes = || self.routes.iter().zip(&sketch.routes);
        let wanted = routes()
            .filter(|(held, _)| matches!(held.stage, Stage::Provisional(_)))
            .flat_map(|(held, way)| held.needs(way));
        let mut locked = routes()
            .filter(|(held, _)| !matches!(held.stage, Stage::Idle | Stage::Provisional(_)))
            .flat_map(|(held, way)| held.needs(way));
        let locked: Set = locked.by_ref().map(|need| need.0).collect();
        let mut drives: Vec<Need> = wanted.chain(alone).collect();
        drives.retain(|need| {
            let ahead = self.unswept.needs(need.0) || meets(&sketch.points[need.0], &self.blocked);
            !ahead && !seen.contains(need) && !locked.contains(&need.0) && !meets(&sketch.points[need.0], occupied)
        });
        drives
    }

    /// All that the route holds is detected, clear and unblocked.
    fn sound(&self, sketch: &Sketch, route: usize, occupied: &Set, firm: &[Need]) -> bool {
        let (held, way) = (&self.routes[route], &sketch.routes[route]);
        let (path, circuits) = (held.path(way), held.circuits(way));
        held.needs(way).iter().all(|need| firm.contains(need))
            && !meets(if way.calling_on { &path } else { &circuits }, occupied)
            && !meets(&circuits, &self.blocked)
            && !self.is_cut_off(way, occupied)
            && way.to.is_none_or(|segment| !self.closed(sketch, segment) && self.sends.contains(&segment))
    }

    /// Whether somebody would have to run over a block to come to the signal.
    fn is_cut_off(&self, way: &Way, occupied: &Set) -> bool {
        waits(way, occupied) && meets(&way.approach, &self.blocked)
    }

    /// Whether a circuit of a segment is blocked.
    fn closed(&self, sketch: &Sketch, segment: usize) -> bool {
        meets(&sketch.segments[segment].circuits, &self.blocked)
    }

    /// Whether a train may be on its way to a circuit, or a point in it may move: what is held may be run over, what a route needs may be
    /// driven, and on plain line what is sent comes.
    fn may_be_coming(&self, sketch: &Sketch, circuit: usize, occupied: &Set) -> bool {
        let routes = || self.routes.iter().zip(&sketch.routes).filter(|(held, _)| held.is_held());
        let on_line = |number: usize| {
            meets(&sketch.segments[number].circuits, occupied)
                || sketch.segments[number].throat.is_some_and(|throat| occupied.contains(&throat))
                || routes().any(|(_, way)| way.to == Some(number))
                || self.unswept.goes_out_to(sketch, number)
                || self.stretches[number].withdrawn < sketch.turn
                || self.stretches[number].travel == Some(Travel::Toward)
        };
        let line = sketch.segments.iter().position(|line| line.circuits.contains(&circuit));
        let needed = |need: &Need| sketch.points[need.0].contains(&circuit);
        let to_signal = |held: &Held, way: &Way| {
            held.once_set && held.behind == Behind::Approach && waits(way, occupied) && way.approach.contains(&circuit)
        };
        let of_route = routes().any(|(held, way)| to_signal(held, way))
            || routes().any(|(held, way)| held.circuits(way).contains(&circuit) || held.needs(way).iter().any(needed));
        of_route || line.is_some_and(on_line)
    }

    fn confirm(&mut self, sketch: &Sketch, occupied: &Set, firm: &[Need]) {
        let stands = |point: usize| firm.iter().any(|need| need.0 == point);
        let safe = |circuit: &usize| {
            let mut points = sketch.points.iter().enumerate();
            points.all(|(point, detectors)| !detectors.contains(circuit) || stands(point))
                && !self.unswept.circuits.contains(circuit)
                && !occupied.contains(circuit)
                && !self.may_be_coming(sketch, *circuit, occupied)
        };
        let safe: Vec<usize> = self.blocked.iter().copied().filter(safe).collect();
        self.confirmed.extend(safe);
    }

    fn reserve(&mut self, sketch: &Sketch, occupied: &Set, firm: &[Need]) {
        for (route, way) in sketch.routes.iter().enumerate() {
            if let Stage::Provisional(time) = self.routes[route].stage {
                let sound = self.sound(sketch, route, occupied, firm);
                self.routes[route].once_set = sound;
                if sound {
                    self.routes[route].stage = Stage::Set;
                    self.routes[route].look_back(way, occupied);
                }
                self.routes[route].stage = if sound {
                    Stage::Set
                } else if time + 1 >= way.drive {
                    Stage::Failed
                } else {
                    Stage::Provisional(time + 1)
                };
            }
        }
    }
}
