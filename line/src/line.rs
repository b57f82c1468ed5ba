//! A line: the parameters that its file gives, in the kernel's form.

use atc_kernel::aspect::{AspectTable, Times};
use atc_kernel::code::CodeTable;
use atc_kernel::distance::Metres;
use atc_kernel::pattern::Deceleration;
use atc_kernel::supervision::Supervision;
use atc_layout::lives::TrainLives;

use crate::aspect;
use crate::blocks::Detection;
use crate::border::Borders;
use crate::budget::Budget;
use crate::code::Pair;
use crate::figures::{LineBlock, LineSection};
use crate::places::Places;
use crate::position::Calibration;
use crate::signal::Signal;
use crate::station::Station;
use crate::telegram::Telegram;

/// What is true of every train of a line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Train {
    /// The length of the longest one.
    pub longest: Metres,
    /// The brake that every one has at least on the level.
    pub brake: Deceleration,
    /// The longest for which one may not be detected where it stands, in ms.
    pub shunt_loss_ms: u32,
}

/// A line whose own parameters the kernel accepts. What its parts count on of each other is held against each other by [`Line::checks`].
#[derive(Clone, Debug)]
pub struct Line {
    pub(crate) name: String,
    pub(crate) aspect: aspect::Config,
    pub(crate) times: Times,
    pub(crate) table: AspectTable,
    pub(crate) supervision: Supervision,
    pub(crate) detection: Option<Detection>,
    pub(crate) signal: Option<Signal>,
    pub(crate) position: Option<Calibration>,
    pub(crate) codes: Option<(CodeTable, Vec<Pair>)>,
    pub(crate) train: Option<Train>,
    pub(crate) budget: Budget,
    pub(crate) stations: Vec<Station>,
    pub(crate) borders: Borders,
    pub(crate) telegrams: Vec<Telegram>,
    pub(crate) places: Places,
}

/// What the line is, for who uses it.
impl Line {
    /// Its name.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// One logic cycle, the aspects and the times as the file gives them.
    pub const fn aspect(&self) -> &aspect::Config {
        &self.aspect
    }

    /// The times of aspect acceptance.
    pub const fn times(&self) -> Times {
        self.times
    }

    /// The aspects.
    pub const fn table(&self) -> &AspectTable {
        &self.table
    }

    /// The parameters of speed supervision.
    pub const fn supervision(&self) -> Supervision {
        self.supervision
    }

    /// The counted blocks, if there are any.
    pub const fn detection(&self) -> Option<&Detection> {
        self.detection.as_ref()
    }

    /// The telegrams, if it sends any.
    pub const fn signal(&self) -> Option<&Signal> {
        self.signal.as_ref()
    }

    /// The attenuation table, if there is one.
    pub const fn position(&self) -> Option<&Calibration> {
        self.position.as_ref()
    }

    /// The code table, if the file gives one.
    pub fn codes(&self) -> Option<&CodeTable> {
        self.codes.as_ref().map(|(table, _)| table)
    }

    /// The pairs of code frequencies, if the file gives them.
    pub fn code_pairs(&self) -> &[Pair] {
        self.codes.as_ref().map_or(&[], |(_, pairs)| pairs)
    }

    /// The levels of the train control signal.
    pub const fn budget(&self) -> &Budget {
        &self.budget
    }

    /// What is true of every train, if the file says it.
    pub const fn train(&self) -> Option<Train> {
        self.train
    }

    /// The stations, in the order of the file.
    pub fn stations(&self) -> &[Station] {
        &self.stations
    }

    /// The borders.
    pub const fn borders(&self) -> &Borders {
        &self.borders
    }

    /// The section numbers that are sent in circuits of stations.
    pub fn telegrams(&self) -> &[Telegram] {
        &self.telegrams
    }

    /// So many cycles in ms.
    pub(crate) fn ms(&self, ticks: u16) -> u64 {
        u64::from(ticks) * u64::from(self.aspect.cycle_ms)
    }

    /// What its trains do with telegrams and codes, if it sends telegrams.
    pub fn lives(&self) -> Option<TrainLives> {
        let code_ms = self.ms(self.times.expiry().0);
        self.signal.as_ref().map(|signal| TrainLives { code_way_ms: signal.code_way_ms(), code_ms, ..signal.lives() })
    }

    /// Its file, as the user named it.
    pub fn source(&self) -> &str {
        self.places.name()
    }

    /// Where the values stand in its file.
    pub const fn places(&self) -> &Places {
        &self.places
    }

    /// Its blocks, for a case.
    pub fn blocks(&self) -> Vec<LineBlock> {
        self.detection.as_ref().map_or_else(Vec::new, Detection::blocks)
    }

    /// Its sections, for a case.
    pub fn sections(&self) -> Vec<LineSection> {
        self.signal.as_ref().map_or_else(Vec::new, Signal::sections)
    }
}
