//! The stations of a line by name, and those whose layout can be held against anything.

use atc_layout::model::Model;

use crate::line::Line;
use crate::station::Station;

/// A station whose layout keeps every rule, with its number in the file of the line.
#[derive(Clone, Copy)]
pub(super) struct Sound<'a> {
    pub(super) number: usize,
    pub(super) station: &'a Station,
    pub(super) model: &'a Model,
}

impl Sound<'_> {
    pub(super) fn name(&self) -> &str {
        self.station.name()
    }
}

impl Line {
    /// The stations whose layout keeps every rule.
    pub(super) fn sound(&self) -> Vec<Sound<'_>> {
        let all = self.stations().iter().enumerate();
        all.filter_map(|(number, station)| Some(Sound { number, station, model: station.model.as_ref()? })).collect()
    }

    pub(super) fn station(&self, name: &str) -> Option<(usize, &Station)> {
        self.stations().iter().enumerate().find(|(_, station)| station.name() == name)
    }
}
