//! What was measured, as data: figures beside theory and targets, and plots.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The figures and plots of one run of the waveform package.
#[derive(Clone, Debug, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Measurements {
    /// Where they come from: `run here`, or a folder; empty if there are none.
    pub source: String,
    /// What was measured, and how much of it: receiver, extent, seed, track.
    pub conditions: Vec<(String, String)>,
    /// The figures, group by group.
    pub figures: Vec<Figure>,
    /// The plots.
    pub plots: Vec<Plot>,
    /// Pages that play accidents.
    #[serde(default)]
    pub films: Vec<Film>,
    /// How long the run took, in seconds; 0 if it is not known.
    pub seconds: f64,
}

/// One figure.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Figure {
    /// What it belongs to: `Bits`, `Codes and telegrams`, …
    pub group: String,
    /// What it is.
    pub name: String,
    /// The value; nothing if the run could not tell.
    pub value: Option<f64>,
    /// Its unit; empty for a plain number.
    pub unit: String,
    /// Of how many, or under which circumstances.
    pub of: String,
    /// What theory gives, in the same unit, where there is one.
    pub theory: Option<f64>,
    /// The target, in the same unit: the value must not be above it. Nothing: the figure is shown only.
    pub at_most: Option<f64>,
    /// The evidence (`measured:…`) that the target belongs to.
    pub evidence: Option<String>,
}

/// A page that plays an accident of the simulated line: a whole HTML document, which needs nothing beside it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Film {
    /// Its file in `films/`, without the end.
    pub name: String,
    /// What happens in it.
    pub caption: String,
    /// The page.
    pub page: String,
}

/// A drawing of what was measured.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Plot {
    /// Its file in `plots/`, without the end.
    pub name: String,
    /// What it shows.
    pub caption: String,
    /// The drawing, an `svg` element.
    pub svg: String,
}
