//! The neighbouring station of each line, as the conditions `neighbour-turns-alike` and `turn-outlasts-telegrams` allow it to behave,
//! and no better.

use super::ground::{Ground, Mask, bit};

/// The neighbour of one line.
#[derive(Clone, Copy, Debug)]
pub struct Neighbour {
    /// Whether it consents that this station sends.
    pub consents: bool,
    /// The cycles since it took its consent back.
    pub withdrawn: i64,
    /// The cycles since the last cycle in which this station permitted it to send.
    pub permitted: i64,
    /// Whether it has the line: it sends.
    pub sends: bool,
    /// Whether its worker is on the line.
    pub works: bool,
    /// The circuits that it sees, for how many cycles they have been reported clear.
    pub clear_for: i64,
    /// For how many cycles the stretch beyond the border has been clear.
    pub outside_clear: i64,
    /// For how many cycles the outermost circuit has been.
    pub outermost_clear: i64,
}

/// How the neighbours of an episode are.
#[derive(Clone, Copy, Debug)]
pub struct Manner {
    /// They see the whole line, not only what lies beyond the border.
    pub overlaps: bool,
    /// How late their consent reaches the station: less than a telegram's life.
    pub late: i64,
    /// They look at what lies beyond the border alone when they take the line: the other station's old rule (`neighbour-turns-alike` asks for more).
    pub blind: bool,
}

impl Neighbour {
    /// Nothing is agreed.
    pub const START: Self = Self {
        consents: false,
        withdrawn: 0,
        permitted: i64::MAX / 2,
        sends: false,
        works: false,
        clear_for: 0,
        outside_clear: 0,
        outermost_clear: 0,
    };

    /// What it sees.
    pub fn sees(ground: &Ground, line: usize, manner: Manner) -> Mask {
        let line = &ground.lines[line];
        if manner.overlaps { line.mask | bit(line.outside) } else { bit(line.outside) }
    }

    /// The circuit on which its worker steps.
    pub fn workplace(ground: &Ground, line: usize, manner: Manner) -> usize {
        let line = &ground.lines[line];
        if manner.overlaps { line.outermost } else { line.outside }
    }

    /// A cycle passes: `permits` is what the station said last, `occupied` what is reported.
    pub fn pass(&mut self, ground: &Ground, number: usize, manner: Manner, permits: bool, occupied: Mask) {
        self.permitted = if permits { 0 } else { self.permitted + 1 };
        self.withdrawn = if self.consents { 0 } else { self.withdrawn + 1 };
        let clear = occupied & Self::sees(ground, number, manner) == 0;
        self.clear_for = if clear { self.clear_for + 1 } else { 0 };
        let outside = occupied & bit(ground.lines[number].outside) == 0;
        self.outside_clear = if outside { self.outside_clear + 1 } else { 0 };
        let outermost = occupied & bit(ground.lines[number].outermost) == 0;
        self.outermost_clear = if outermost { self.outermost_clear + 1 } else { 0 };
    }

    /// Whether the permission that it has is no older than a telegram's life.
    pub const fn is_permitted(&self, ground: &Ground) -> bool {
        self.permitted <= ground.life
    }

    /// What the station reads of its consent.
    pub const fn heard(&self, manner: Manner) -> bool {
        self.consents || self.withdrawn < manner.late
    }

    /// It consents: never while it sends, nor while a train that it sent may be on the line, nor over its own worker.
    pub const fn consent(&mut self, ground: &Ground) -> bool {
        let may = !self.works && (!self.sends || self.clear_for > ground.clear);
        if may {
            self.consents = true;
            self.sends = false;
        }
        may
    }

    /// It takes the line to send a train, or sends another one.
    pub const fn take(&mut self, ground: &Ground, manner: Manner) -> bool {
        let unseen = manner.blind && !self.sends && !manner.overlaps;
        let outside = self.outside_clear > ground.clear && (unseen || self.outermost_clear > ground.clear);
        let turns = self.sends || self.clear_for > ground.clear;
        let may = !self.works && !self.consents && self.withdrawn >= ground.turn && self.is_permitted(ground);
        if may && turns && outside {
            self.sends = true;
            // One train at a time comes up to the border.
            self.outside_clear = 0;
        }
        may && turns && outside
    }

    /// It puts a worker on the line, once every train that could count on its consent must have stopped.
    pub const fn work(&mut self, ground: &Ground) -> bool {
        let stops = ground.fastest * 1000 / (ground.brake * ground.cycle_ms) + ground.life + ground.loss + 2;
        let alone = !self.consents && self.withdrawn >= ground.turn + stops && !self.sends;
        let may = alone && self.clear_for > ground.clear;
        if may {
            self.works = true;
        }
        may
    }
}
