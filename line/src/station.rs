//! A station of a line: its layout, and what telegrams name for its speed codes.

use std::collections::BTreeSet;
use std::ops::Range;
use std::path::Path;

use atc_kernel::aspect::{AspectId, AspectTable};
use atc_kernel::interlocking::{Heading, SpeedCode};
use atc_layout::form::Circuit;
use atc_layout::import::read_any;
use atc_layout::model::Model;
use atc_layout::{Description, Errors};

use crate::form;
use crate::kmh::Kmh;
use crate::permitted::rank;
use crate::places::place;

/// A station of a line.
#[derive(Clone, Debug)]
pub struct Station {
    pub(crate) description: Description,
    /// With everything derived; nothing if the layout breaks a rule that it needs.
    pub(crate) model: Option<Model>,
    /// What is wrong with the layout.
    pub(crate) problems: Vec<atc_layout::Problem>,
    pub(crate) code_speeds: Option<Vec<Kmh>>,
}

impl Station {
    /// Reads the layout of a station, in any form that layouts have.
    ///
    /// # Errors
    /// The file cannot be read, or is not of the form that its name says.
    pub(crate) fn read(given: &form::Station, code_speeds: Option<Vec<Kmh>>, folder: &Path) -> Result<Self, Errors> {
        let path = folder.join(&given.file);
        // A file of that name, and not standard input.
        let path = if path == Path::new("-") { Path::new(".").join(path) } else { path };
        let mut description = read_any(path)?.description;
        if let Some(name) = &given.name {
            description.station.name.clone_from(name);
        }
        let problems = description.check().err().map(|errors| errors.problems).unwrap_or_default();
        let model = if problems.is_empty() { description.model().ok() } else { None };
        Ok(Self { description, model, problems, code_speeds })
    }

    /// The circuits that a train in `circuit` may be granted, its own among them; the own one alone of a layout that breaks a rule.
    pub(crate) fn ahead(&self, circuit: &Circuit, heading: Heading) -> BTreeSet<usize> {
        let number = self.description.station.circuits.iter().position(|other| other.name == circuit.name);
        let Some(number) = number else { return BTreeSet::new() };
        self.model.as_ref().map_or_else(|| [number].into(), |model| model.ahead(number, heading))
    }

    /// The highest speed of a train in `circuit`, in km/h; 0 of a layout that breaks a rule.
    pub(crate) fn fastest_kmh(&self, circuit: &Circuit, heading: Heading) -> u16 {
        let number = self.description.station.circuits.iter().position(|other| other.name == circuit.name);
        self.model.as_ref().zip(number).map_or(0, |(model, number)| model.fastest_kmh(number, heading))
    }

    /// What it is called.
    pub fn name(&self) -> &str {
        &self.description.station.name
    }

    /// Its layout, as its file has it.
    pub const fn description(&self) -> &Description {
        &self.description
    }

    /// Its layout with everything derived; none if it breaks a rule.
    pub const fn model(&self) -> Option<&Model> {
        self.model.as_ref()
    }

    /// Where something stands in its file; that it is not given, where it is a default or derived.
    pub(crate) fn at(&self, span: &Range<usize>) -> String {
        let source = &self.description.source;
        let at = place(source, span);
        if at == source.name { format!("{at} (not given)") } else { at }
    }

    /// The speeds of its codes 1, 2, …, in km/h.
    pub(crate) fn codes(&self) -> &[u16] {
        &self.description.station.braking.speeds_kmh.value
    }

    /// What the file says that telegrams name for each of its codes; none if it says nothing.
    pub fn code_speeds(&self) -> Option<&[Kmh]> {
        self.code_speeds.as_deref()
    }

    /// What telegrams name for each of its codes.
    pub(crate) fn named(&self) -> Vec<Kmh> {
        let own = || self.codes().iter().map(|speed| Kmh(i32::from(*speed) * 10)).collect();
        self.code_speeds.clone().unwrap_or_else(own)
    }

    /// The rank in telegrams of a speed code; none if the station has no such code, or the line no such speed.
    ///
    /// Where the rules `rank-missing` and `rank-faster` are met, every code of the station has a rank, and it means no higher speed.
    pub fn rank(&self, speeds: &AspectTable, code: SpeedCode) -> Option<AspectId> {
        let Some(place) = usize::from(code.0).checked_sub(1) else { return AspectId::new(0) };
        rank(speeds, *self.named().get(place)?)
    }
}
