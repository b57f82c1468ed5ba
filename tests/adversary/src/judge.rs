//! What is an accident: judged on the ground, never on what the device remembers.

use super::ground::{Ground, Mask, Piece, bit, members};
use super::point::Points;
use super::train::{Driver, Train};

/// The kinds of accident.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Family {
    /// Two trains on one place of track, or fouling each other.
    Collision,
    /// A train on a point that moves, or is not in position for it.
    Derailment,
    /// A train over the limit of a route or of a reverse point that is under a part of it.
    Speed,
    /// A train over a restriction that is under a part of it.
    Restriction,
    /// Who works in a block that was confirmed is struck by a train, or by a point that moves.
    Worker,
    /// Two trains that both have authority over one circuit, or still run on it.
    Authority,
    /// A train with authority over a route that nobody has requested, or that was withdrawn since.
    Unasked,
    /// A train at the end of the tracks: at a buffer, or where a line goes on that nobody has given to it.
    End,
}

impl Family {
    /// All of them.
    pub const ALL: [Self; 8] = [
        Self::Collision,
        Self::Derailment,
        Self::Speed,
        Self::Restriction,
        Self::Worker,
        Self::Authority,
        Self::Unasked,
        Self::End,
    ];

    /// Its name on the command line.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Collision => "collision",
            Self::Derailment => "derailment",
            Self::Speed => "speed",
            Self::Restriction => "restriction",
            Self::Worker => "worker",
            Self::Authority => "authority",
            Self::Unasked => "unasked",
            Self::End => "end",
        }
    }
}

/// An accident.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Accident {
    /// Its kind.
    pub family: Family,
    /// The cycle.
    pub cycle: i64,
    /// What happened.
    pub text: String,
}

/// What else is true on the ground, besides trains and points.
#[derive(Clone, Debug, Default)]
pub struct Truth {
    /// The cycle.
    pub now: i64,
    /// The restriction of each circuit, and the cycle since when.
    pub restricted: Vec<(i64, i64)>,
    /// The circuits with a worker.
    pub workers: Mask,
    /// For each route, whether it is asked for, and the cycle of its last withdrawal.
    pub asked: Vec<(bool, i64)>,
}

const KMH: i64 = 10_000;

/// What a train may run over a limit without an accident: 1 km/h.
const TOLERANCE_MM_S: i64 = 300;

/// The first accident of the families `sought`.
pub fn judge(ground: &Ground, trains: &[Train], points: &Points, truth: &Truth, sought: &[Family]) -> Option<Accident> {
    let seek = |family: Family| sought.contains(&family);
    let found = |family: Family, text: String| Some(Accident { family, cycle: truth.now, text });
    if seek(Family::Worker) && truth.workers != 0 {
        let moving = |piece: &Piece| piece.point.filter(|point| points.moves(*point));
        let mut among = ground.pieces.iter().filter(|piece| bit(piece.circuit) & truth.workers != 0);
        if let Some((point, circuit)) = among.find_map(|piece| Some((moving(piece)?, piece.circuit))) {
            let (point, place) = (&ground.points[point], &ground.circuits[circuit]);
            return found(Family::Worker, format!("point {point} moves among those who work on {place}"));
        }
    }
    for (number, train) in trains.iter().enumerate() {
        if seek(Family::Worker) && train.under & truth.workers != 0 {
            let place = ground.named(train.under & truth.workers);
            return found(Family::Worker, format!("train {} strikes a worker on {place}", train.number));
        }
        if seek(Family::Derailment)
            && let Some(text) = derailed(ground, train, points)
        {
            return found(Family::Derailment, text);
        }
        for family in [Family::Speed, Family::Restriction] {
            if seek(family)
                && let Some(text) = too_fast(ground, train, truth, family)
            {
                return found(family, text);
            }
        }
        if seek(Family::Unasked)
            && let Some(text) = unasked(ground, train, truth)
        {
            return found(Family::Unasked, text);
        }
        let front = train.front();
        if seek(Family::End) && train.at >= front.length && ground.across(front.exit, front.piece).is_none() {
            let place = &ground.circuits[train.front_circuit(ground)];
            return found(Family::End, format!("train {} is at the end of the tracks, on {place}", train.number));
        }
        for other in &trains[number + 1..] {
            let both = train.under & other.under;
            if seek(Family::Collision) && both != 0 && collide(ground, train, other) {
                let text = format!("trains {} and {} meet on {}", train.number, other.number, ground.named(both));
                return found(Family::Collision, text);
            }
            if seek(Family::Collision) && ground.strike(train.under, other.under) {
                let places = [train, other].map(|it| ground.named(it.under));
                let text = format!(
                    "trains {} and {} strike each other, on {} and {}",
                    train.number, other.number, places[0], places[1]
                );
                return found(Family::Collision, text);
            }
            if seek(Family::Authority) && ground.strike(train.claim, other.claim) {
                let text =
                    format!("trains {} and {} may both run where they strike each other", train.number, other.number);
                return found(Family::Authority, text);
            }
            let both = train.claim & other.claim;
            if seek(Family::Authority) && both != 0 {
                let place = ground.named(both);
                let text = format!("trains {} and {} may both run over {place}", train.number, other.number);
                return found(Family::Authority, text);
            }
        }
    }
    None
}

fn derailed(ground: &Ground, train: &Train, points: &Points) -> Option<String> {
    if train.legs.iter().all(|leg| leg.over.is_none()) {
        return None;
    }
    for (leg, begin, end) in train.parts() {
        let Some((point, reverse)) = leg.over else { continue };
        if begin < end && !points.rests(point, reverse) {
            let name = &ground.points[point];
            let how = if points.rests(point, !reverse) { "lies the other way" } else { "moves" };
            let kmh = train.speed * 36 / KMH;
            return Some(format!("train {} is on point {name}, which {how}, at {kmh} km/h", train.number));
        }
    }
    None
}

fn too_fast(ground: &Ground, train: &Train, truth: &Truth, family: Family) -> Option<String> {
    if train.driver == Driver::Signals || train.heard.neighbour || train.speed == 0 {
        return None;
    }
    for (leg, begin, end) in train.parts() {
        let circuit = ground.pieces[leg.piece].circuit;
        let (limit, what) = if family == Family::Speed {
            (leg.limit, "limit of its route")
        } else {
            (restriction(ground, truth, circuit), "restriction")
        };
        if begin < end && train.speed > limit.saturating_add(TOLERANCE_MM_S) {
            let (speed, limit) = (train.speed * 36 / KMH, (limit * 36 + KMH - 1) / KMH);
            let (number, place) = (train.number, &ground.circuits[circuit]);
            return Some(format!("train {number} runs at {speed} km/h, and the {what} under it on {place} is {limit}"));
        }
    }
    None
}

/// The restriction of a circuit that binds now: once every telegram that did not know it is dead, and a train has had the time to brake.
fn restriction(ground: &Ground, truth: &Truth, circuit: usize) -> i64 {
    let Some((speed, since)) = truth.restricted.get(circuit) else { return i64::MAX };
    let braking = (ground.fastest - speed).max(0) * 1000 / (ground.brake * ground.cycle_ms);
    if truth.now - since > ground.life + 2 + braking { *speed } else { i64::MAX }
}

/// The circuits of the station's own tracks: neither plain line nor beyond it.
fn inside(ground: &Ground) -> Mask {
    ground.lines.iter().fold(bit(ground.seen) - 1, |all, line| all & !line.mask)
}

fn unasked(ground: &Ground, train: &Train, truth: &Truth) -> Option<String> {
    if train.driver == Driver::Signals || train.authority == 0 {
        return None;
    }
    let counts = |route: usize| truth.asked[route].0 || truth.now - truth.asked[route].1 <= ground.life + 2;
    let told = train.heard.hold | train.first_ahead;
    let mut left = told & inside(ground);
    if left != 0 {
        let asked = (0..ground.routes.len()).filter(|route| counts(*route));
        left = asked.fold(left, |left, route| left & !ground.routes[route].mask);
    } else if !train.about && !train.heard.neighbour && bit(train.front_circuit(ground)) & inside(ground) != 0 {
        // From the throat it is led onto plain line by the route whose signal it has passed. Who changed ends there has passed none.
        let out = train.route.filter(|route| counts(*route)).and_then(|route| ground.routes[route].lines[1]);
        left = told & !out.map_or(0, |line| ground.lines[line].mask);
    }
    let circuit = members(left).next()?;
    let speed = train.heard.speed * 36 / KMH;
    let place = &ground.circuits[circuit];
    Some(format!("train {} is told {speed} km/h over {place}, and no route there is requested", train.number))
}

fn collide(ground: &Ground, one: &Train, other: &Train) -> bool {
    for (leg, begin, end) in one.parts() {
        for (its, from, to) in other.parts() {
            if begin >= end || from >= to {
                continue;
            }
            let (piece, circuit) = (&ground.pieces[leg.piece], ground.pieces[its.piece].circuit);
            if leg.piece != its.piece {
                if piece.circuit == circuit {
                    return true;
                }
                continue;
            }
            let ways = |leg: &super::train::Leg| (leg.enter.min(leg.exit), leg.enter.max(leg.exit));
            if ways(leg) != ways(its) {
                return true;
            }
            let (from, to) = if leg.enter == its.enter { (from, to) } else { (its.length - to, its.length - from) };
            if begin < to && from < end {
                return true;
            }
        }
    }
    false
}
