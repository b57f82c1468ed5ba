//! The weapons of the adversary: how often it does what.

/// How often each kind of move is drawn, against the others; 0 is never.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Arsenal {
    /// Routes are requested.
    pub set: usize,
    /// Routes are withdrawn.
    pub withdraw: usize,
    /// Points are commanded one by one.
    pub point: usize,
    /// Lines are turned, and neighbours consent and send.
    pub line: usize,
    /// The neighbours block and put workers on the line.
    pub neighbour_work: usize,
    /// Restrictions are set and lifted.
    pub restrict: usize,
    /// Circuits are blocked, workers step on them.
    pub block: usize,
    /// One circuit is falsely occupied.
    pub one: usize,
    /// Several are, all of the station among them.
    pub many: usize,
    /// A train is not shown.
    pub lose: usize,
    /// A train hears nothing.
    pub deaf: usize,
    /// A point is not detected.
    pub blind: usize,
    /// Drivers change ends.
    pub face: usize,
    /// Drivers choose a speed.
    pub pace: usize,
    /// The device restarts.
    pub restart: usize,
    /// Points may take a command a cycle late.
    pub slow_points: bool,
    /// Trains take a telegram for the other direction of travel as one to stop.
    pub faces: bool,
    /// Neighbours take a line without a look at its outermost circuit.
    pub blind_neighbours: bool,
    /// The drivers: those of telegrams, those of signals.
    pub drivers: [bool; 2],
}

impl Arsenal {
    /// Ordinary running: requests, lines, drivers of both kinds.
    pub const RUNNING: Self = Self {
        set: 40,
        withdraw: 0,
        point: 0,
        line: 12,
        neighbour_work: 0,
        restrict: 0,
        block: 0,
        one: 0,
        many: 0,
        lose: 0,
        deaf: 0,
        blind: 0,
        face: 0,
        pace: 1,
        restart: 0,
        slow_points: false,
        faces: true,
        blind_neighbours: false,
        drivers: [true, true],
    };

    /// Everything.
    pub const ALL: Self = Self {
        withdraw: 6,
        point: 10,
        neighbour_work: 2,
        restrict: 3,
        block: 4,
        one: 6,
        many: 6,
        lose: 5,
        deaf: 5,
        blind: 2,
        face: 2,
        pace: 2,
        restart: 1,
        slow_points: true,
        ..Self::RUNNING
    };

    /// All weights, in the order in which [`super::attacker`] numbers the kinds.
    pub(super) const fn weights(&self) -> [usize; 15] {
        [
            self.set,
            self.withdraw,
            self.point,
            self.line,
            self.neighbour_work,
            self.restrict,
            self.block,
            self.one,
            self.many,
            self.lose,
            self.deaf,
            self.blind,
            self.face,
            self.pace,
            self.restart,
        ]
    }
}
