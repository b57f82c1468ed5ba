//! What the adversary may do: legal input, and what people do on the ground. A scenario is a list of these.

use super::device::{Ask, Commands};
use super::ground::{Ground, Mask};
use super::train::Driver;

/// One thing that happens in a cycle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Move {
    /// A request of the signaller.
    Ask(Ask),
    /// Staff block, unblock, restrict or lift.
    Command(Commands),
    /// Circuits are falsely reported occupied for so many cycles.
    Occupy(Mask, i64),
    /// An occupied circuit is reported clear for so many cycles.
    Lose(usize, i64),
    /// A train receives nothing for so many cycles.
    Deaf(usize, i64),
    /// The detection of a point is lost for so many cycles.
    Blind(usize, i64),
    /// The driver of a standing train changes ends.
    Face(usize),
    /// A driver chooses to run no faster than this.
    Pace(usize, i64),
    /// A worker steps on a circuit whose block is confirmed, or leaves it.
    Work(usize, bool),
    /// The neighbour gives its consent for a line, or takes it back.
    Consent(usize, bool),
    /// The neighbour sends a train past its own signal.
    Send(usize, Arrival),
    /// The neighbour blocks the line and puts a worker on it, or takes the worker off.
    NeighbourWork(usize, bool),
    /// The device restarts.
    Restart,
    /// At the beginning a train stands on a circuit.
    Place(usize, Arrival),
}

/// A train that appears.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Arrival {
    /// Its length.
    pub length: i64,
    /// What its driver acts on.
    pub driver: Driver,
    /// Its speed.
    pub speed: i64,
    /// How far it stops before a limit.
    pub gap: i64,
    /// Which way it faces, where that is open.
    pub about: bool,
}

impl Arrival {
    fn words(&self) -> String {
        let driver = match self.driver {
            Driver::Telegrams => "telegrams",
            Driver::Signals => "signals",
        };
        format!("{} m long, its driver acts on {driver}", self.length / 1000)
    }
}

const fn position(reverse: bool) -> &'static str {
    if reverse { "reverse" } else { "normal" }
}

impl Move {
    /// The move in the words of the railway.
    pub fn words(&self, ground: &Ground) -> String {
        match self {
            Self::Ask(Ask::Set(route)) => format!("route {} is requested", ground.routes[*route].name),
            Self::Ask(Ask::Withdraw(route)) => format!("route {} is withdrawn", ground.routes[*route].name),
            Self::Ask(Ask::Drive(point, reverse)) => {
                format!("point {} is commanded {}, for one cycle", ground.points[*point], position(*reverse))
            }
            Self::Ask(Ask::Turn(line, away)) => {
                let to = if *away { "away" } else { "toward" };
                format!("line {} is commanded {to}", ground.lines[*line].name)
            }
            Self::Command(it) => commanded(it, ground),
            Self::Occupy(mask, cycles) => {
                format!("falsely occupied for {cycles} cycles: {}", ground.named(*mask))
            }
            Self::Lose(circuit, cycles) => {
                format!("{} does not show its train for {cycles} cycles", ground.circuits[*circuit])
            }
            Self::Deaf(train, cycles) => format!("train {train} receives nothing for {cycles} cycles"),
            Self::Blind(point, cycles) => {
                format!("point {} is not detected for {cycles} cycles", ground.points[*point])
            }
            Self::Face(train) => format!("the driver of train {train} changes ends"),
            Self::Pace(train, speed) => {
                format!("the driver of train {train} runs at {} km/h at most", speed * 36 / 10_000)
            }
            Self::Work(circuit, true) => {
                format!("a worker steps on {}, whose block is confirmed", ground.circuits[*circuit])
            }
            Self::Work(circuit, false) => format!("the worker leaves {}", ground.circuits[*circuit]),
            Self::Consent(line, true) => format!("the neighbour consents on line {}", ground.lines[*line].name),
            Self::Consent(line, false) => {
                format!("the neighbour takes back its consent on line {}", ground.lines[*line].name)
            }
            Self::Send(line, train) => {
                format!("the neighbour sends a train on line {}: {}", ground.lines[*line].name, train.words())
            }
            Self::NeighbourWork(line, true) => {
                format!(
                    "the neighbour has confirmed a block on line {} and puts a worker there",
                    ground.lines[*line].name
                )
            }
            Self::NeighbourWork(line, false) => {
                format!("the neighbour's worker leaves line {}", ground.lines[*line].name)
            }
            Self::Restart => "the device restarts".to_owned(),
            Self::Place(circuit, train) => {
                format!("a train stands on {}: {}", ground.circuits[*circuit], train.words())
            }
        }
    }
}

fn commanded(it: &Commands, ground: &Ground) -> String {
    let mut words = Vec::new();
    for (what, mask) in [("block", it.block), ("unblock", it.unblock), ("lift the restriction of", it.lift)] {
        if mask != 0 {
            words.push(format!("{what} {}", ground.named(mask)));
        }
    }
    if it.restrict.0 != 0 {
        let kmh = (ground.codes[usize::from(it.restrict.1)] * 36 + 9_999) / 10_000;
        words.push(format!("restrict {} to {kmh} km/h", ground.named(it.restrict.0)));
    }
    format!("staff {}", words.join(" and "))
}
