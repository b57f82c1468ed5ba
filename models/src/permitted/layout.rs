//! The line of a model: its sections and stopping points, and what the ground allows on it.
//!
//! Places are counted in cells of 4 m from the line's start, a cycle lasts 1 s, and the train brakes at 4 m/s²: from 1 cell a
//! cycle it needs half a cell, from 2 cells a cycle 2 cells. What is allowed is computed here from the true distance and the
//! true gradients, metre by metre, with nothing of the kernel's.

use atc_kernel::permitted::LineKind;

/// The length of a cell in metres.
pub const CELL_M: u16 = 4;

/// The speeds of the line in tenths of km/h: 1 and 2 cells a cycle.
pub const SPEEDS: [u16; 2] = [144, 288];

/// The train's brake on the level, in mm/s².
pub const BRAKE_MM_S2: u16 = 4000;

/// The most stopping points of a model.
pub const POINTS: usize = 3;

/// A track section.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Section {
    /// How it is equipped.
    pub kind: LineKind,
    /// Its length in cells.
    pub cells: u8,
    /// Its gradient in thousandths, negative where the train runs downhill.
    pub gradient: i8,
    /// The rank of its limit.
    pub limit: u8,
    /// The cells from its start in which the limit of the section before is still enough.
    pub limit_from: u8,
    /// Whether a restriction to the lowest speed may be imposed on it.
    pub restrictable: bool,
    /// The rank that its analog code names.
    pub code: u8,
}

impl Section {
    /// A level section of `cells` without any restriction, with the code of the highest speed.
    pub const fn plain(kind: LineKind, cells: u8) -> Self {
        Self { kind, cells, gradient: 0, limit: 1, limit_from: 0, restrictable: false, code: 1 }
    }
}

/// Sections one after the other, and the points at which the ground may let the train's way end.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Layout {
    /// The sections, in the direction of travel.
    pub sections: Vec<Section>,
    /// The stopping points in cells from the start, the nearest first: 1 to [`POINTS`]. Each is the exit of a section or beyond it.
    pub points: Vec<u8>,
}

impl Layout {
    /// Digital sections of these lengths in cells, level and without limits, with these stopping points.
    pub fn digital(cells: &[u8], points: &[u8]) -> Self {
        let sections = cells.iter().map(|cells| Section::plain(LineKind::Digital, *cells)).collect();
        Self { sections, points: points.into() }
    }

    /// Where a section ends.
    pub fn exit(&self, section: usize) -> u8 {
        self.sections.iter().take(section + 1).map(|section| section.cells).sum()
    }

    /// Where a section begins.
    pub fn start(&self, section: usize) -> u8 {
        self.exit(section) - self.sections[section].cells
    }

    /// Where the last section ends.
    pub fn end(&self) -> u8 {
        self.exit(self.sections.len() - 1)
    }

    /// The section in which a nose at `place` is; a nose at an exit is in the section that begins there.
    pub fn section_at(&self, place: u8) -> usize {
        (0..self.sections.len()).find(|section| place < self.exit(*section)).unwrap_or(self.sections.len() - 1)
    }

    /// The cells from the exit of a section to a stopping point; `None` if it is no farther than the exit.
    pub fn beyond_exit(&self, section: usize, point: u8) -> Option<u8> {
        self.points[usize::from(point)].checked_sub(self.exit(section)).filter(|beyond| *beyond > 0)
    }

    /// The least favourable gradient from a section's start to the farthest stopping point.
    pub fn worst_gradient_from(&self, section: usize) -> i8 {
        let farthest = self.points.iter().max().copied().unwrap_or(0);
        let on_the_way = |other: &usize| *other == section || self.start(*other) < farthest;
        let gradients = (section..self.sections.len()).filter(on_the_way).map(|other| self.sections[other].gradient);
        gradients.min().unwrap_or(0)
    }

    /// The rank of the speed that comes with a stopping point: the lowest with the nearest of three.
    pub fn rank_with(&self, point: u8) -> u8 {
        u8::from(point > 0 || self.points.len() < POINTS)
    }

    /// The limit for a nose at `place`, in tenths of km/h.
    pub fn limit_at(&self, place: u8) -> u16 {
        let here = self.section_at(place);
        let own = here == 0 || place - self.start(here) >= self.sections[here].limit_from;
        let section = if own { here } else { here - 1 };
        SPEEDS[usize::from(self.sections[section].limit)]
    }

    /// Whether a train at `place` with `speed` (tenths of km/h) keeps what comes with a stopping point: it stops before the point,
    /// or before the exit of its section if the point lies behind that, and is no faster than the speed that comes with it.
    pub fn keeps(&self, speed: u16, place: u8, point: u8) -> bool {
        let stop = self.points[usize::from(point)].max(self.exit(self.section_at(place)));
        // v² ≤ 2·Σ b·s. A speed of one tenth of km/h is 1/36 m/s; decelerations in µm/s², where one thousandth counts 9806.65.
        let cell = |cell| {
            let thousandths = i64::from(self.sections[self.section_at(cell)].gradient);
            let on_level = i64::from(BRAKE_MM_S2) * 1000;
            let deceleration = on_level + (thousandths * 980_665).div_euclid(100);
            u64::try_from(deceleration).unwrap_or(0) * u64::from(CELL_M)
        };
        let work: u64 = (place..stop.max(place)).map(cell).sum();
        let square = u64::from(speed) * u64::from(speed);
        square * 1_000_000 <= 2 * 36 * 36 * work && speed <= SPEEDS[usize::from(self.rank_with(point))]
    }
}
