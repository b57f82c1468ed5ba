//! A layout file that was read, and what is made of it.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use crate::compile::{Compiled, Sound, compile, sound};
use crate::form::Station;
use crate::graph::POINTS_IN_A_CIRCUIT;
use crate::model::{Model, Values};
use crate::problem::{Errors, Problem, Source};
use crate::rule::Rule;
use crate::{check, derive};

use atc_kernel::distance::Metres;
use atc_kernel::interlocking::{Size, code_stops_within};

/// The rules that names and tracks must keep before anything can be said of routes.
const TRACKS: [Rule; 4] = [Rule::NameTwice, Rule::NoSuchName, Rule::Joint, Rule::OpenJoint];

/// A layout in the words of its file.
#[derive(Clone, Debug, Default)]
pub struct Description {
    /// What the file says.
    pub station: Station,
    /// The text it was read from.
    pub source: Source,
}

impl Description {
    /// The layout that a text in TOML describes; `name` stands in front of what is wrong with it.
    ///
    /// # Errors
    /// The first place where the text is no TOML, or not of the form of a layout.
    pub fn from_toml(name: &str, text: &str) -> Result<Self, Errors> {
        let source = Source { name: name.to_owned(), text: text.to_owned() };
        match toml::from_str(text) {
            Ok(station) => Ok(Self { station, source }),
            Err(error) => {
                let span = error.span().unwrap_or(0..0);
                // An empty range has no place; at the end of the text there is a last character.
                let span =
                    if span.is_empty() { span.start.min(text.len().saturating_sub(1))..text.len() } else { span };
                let what = crate::text::in_words(error.message());
                let problem = Problem::new(Rule::Form, &span, what, "layout.schema.json describes the form");
                Err(Errors::one(&source, problem))
            }
        }
    }

    /// The text of the layout in TOML.
    ///
    /// # Panics
    /// Never: every layout has a form in TOML.
    pub fn to_toml(&self) -> String {
        toml::to_string(&self.station).expect("a layout has a form in TOML")
    }

    /// The speed in km/h of the first code whose distance is too short for a train that comes from telegrams by a pattern of `pattern` mm/s² on the level;
    /// none if all are long enough. `values` are those of its model.
    pub fn short_code(&self, values: &Values, pattern: u16) -> Option<u16> {
        let brake = derive::values::from_telegrams(&self.station, pattern)?;
        let codes = values.speeds_kmh.iter().zip(&values.braking).filter(|(speed, _)| **speed > 0);
        let mut short = codes.filter(|(speed, distance)| {
            let metres = Metres(distance.0.saturating_sub(values.heard_beyond.0));
            !code_stops_within(brake, **speed, values.telegram_age_ms, metres)
        });
        short.next().map(|(speed, _)| *speed)
    }

    /// The layout with everything derived that the file leaves out, of any size, after every rule that needs names, geometry and times
    /// has been checked. The rules of the kernel's plan are checked by [`Description::compile`].
    ///
    /// # Errors
    /// Every broken rule.
    pub fn model(&self) -> Result<Model, Errors> {
        let mut problems = Vec::new();
        sizes(&self.station, &mut problems);
        if !problems.is_empty() {
            return Err(Errors::new(&self.source, problems));
        }
        let model = derive::model(&self.station, &mut problems);
        // What follows from tracks that are wrong would only hide what is wrong with them.
        if problems.iter().any(|problem| TRACKS.contains(&problem.rule)) {
            problems.retain(|problem| TRACKS.contains(&problem.rule));
        } else {
            check::check(&self.station, &model, &mut problems);
        }
        if problems.is_empty() { Ok(model) } else { Err(Errors::new(&self.source, problems)) }
    }

    /// The tracks, and the routes as far as they are sound: what a drawing needs. Only the form of the tracks is checked.
    ///
    /// # Errors
    /// What is wrong with names, joints and values.
    pub fn tracks(&self) -> Result<Model, Errors> {
        let mut problems = Vec::new();
        sizes(&self.station, &mut problems);
        if !problems.is_empty() {
            return Err(Errors::new(&self.source, problems));
        }
        let model = derive::model(&self.station, &mut problems);
        problems.retain(|problem| TRACKS.contains(&problem.rule));
        if problems.is_empty() { Ok(model) } else { Err(Errors::new(&self.source, problems)) }
    }

    /// The layout, held against every rule as a station of the size that it needs.
    ///
    /// # Errors
    /// Every broken rule, or what there is no room for in a large station.
    pub fn check(&self) -> Result<Sound, Errors> {
        sound(&self.source, &self.station, self.model()?)
    }

    /// The layout for the kernel, as a small station.
    ///
    /// # Errors
    /// Every broken rule, or what there is no room for.
    pub fn compile(&self) -> Result<Compiled, Errors> {
        self.compile_to()
    }

    /// The layout for a kernel with room for `R` routes of up to `P` circuits, `N` points and `S` segments, of size `Z`.
    ///
    /// # Errors
    /// As [`Description::compile`].
    pub fn compile_to<const R: usize, const P: usize, const N: usize, const S: usize, Z: Size>(
        &self,
    ) -> Result<Compiled<R, P, N, S, Z>, Errors> {
        compile(&self.source, &self.station, self.model()?)
    }
}

/// That nothing is looked into that is larger than any station: the time for it would have no bound.
fn sizes(station: &Station, problems: &mut Vec<Problem>) {
    let mut in_circuit: BTreeMap<&str, usize> = BTreeMap::new();
    for point in &station.points {
        let number = in_circuit.entry(&point.circuit.value).or_default();
        *number += 1;
        if *number == POINTS_IN_A_CIRCUIT + 1 {
            let what = format!("circuit {} has more than {POINTS_IN_A_CIRCUIT} points", point.circuit);
            problems.push(Problem::new(Rule::TooMany, &point.circuit.span, what, "divide it"));
        }
    }
    let counts = [
        ("track circuits", station.circuits.len(), 1024),
        ("points", station.points.len(), 1024),
        ("routes", station.routes.len(), 1024),
        ("segments", station.segments.len(), 1024),
        ("pairs of circuits that foul each other", station.fouling.len(), 1024),
    ];
    for (kind, count, most) in counts {
        if count > most {
            let what = format!("the layout has {count} {kind}, and no station has more than {most}");
            problems.push(Problem::new(Rule::TooMany, &(0..0), what, "divide the station"));
        }
    }
}

/// The layout of a file.
///
/// # Errors
/// That the file cannot be read, or the first place where it is not of the form of a layout.
pub fn read(path: impl AsRef<Path>) -> Result<Description, Errors> {
    let path = path.as_ref();
    let name = path.display().to_string();
    match fs::read_to_string(path) {
        Ok(text) => Description::from_toml(&name, &text),
        Err(error) => {
            let source = Source { name, text: String::new() };
            Err(Errors::one(&source, Problem::new(Rule::Form, &(0..0), format!("cannot be read: {error}"), "")))
        }
    }
}
