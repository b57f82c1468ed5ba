//! The form of a line's file in TOML: what may stand in it. `line/README.md` describes every table.
//!
//! The values here are as the file gives them. Each group becomes the one configuration that a session of the oracle gives too, and is
//! checked there; [`crate::places::Places`] knows where each value stands.

use std::collections::BTreeMap;

use serde::Deserialize;

/// A line. Milliseconds, metres and km/h; a speed has at most one decimal.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct File {
    pub name: String,
    pub cycle_ms: u32,
    pub aspects_km_h: Vec<f64>,
    pub times: Times,
    #[serde(default)]
    pub supervision: Supervision,
    pub detection: Option<Detection>,
    #[serde(default, rename = "block")]
    pub blocks: Vec<Block>,
    pub signal: Option<Signal>,
    #[serde(default, rename = "section")]
    pub sections: Vec<Section>,
    pub position: Option<Position>,
    pub codes: Option<Codes>,
    pub train: Option<Train>,
    pub budget: Option<Budget>,
    #[serde(default, rename = "station")]
    pub stations: Vec<Station>,
    #[serde(default, rename = "border")]
    pub borders: Vec<Border>,
    #[serde(default, rename = "telegram")]
    pub telegrams: Vec<Telegram>,
}

/// `[times]`: all of them, so that no default is taken for a decision.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
#[allow(clippy::struct_field_names, reason = "the unit belongs to the name in the file")]
pub struct Times {
    pub operate_ms: u32,
    pub recovery_ms: u32,
    pub mask_ms: u32,
    pub interruption_ms: u32,
    pub shortened_operate_ms: u32,
}

/// `[supervision]`.
#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Supervision {
    pub maximum_km_h: Option<f64>,
    pub release_margin_km_h: Option<f64>,
}

/// `[detection]`: what all blocks have in common.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Detection {
    /// From the antenna to the last point that must be protected.
    pub longest_train_m: u16,
    /// The longest that a passing train keeps the check-in on.
    pub pass_ms: Option<u32>,
    /// The hold, if it is not to be the least one.
    pub hold_sections: Option<u32>,
}

/// `[[block]]`: one block, from the low end of the line.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Block {
    /// The most trains that may be in it.
    pub max_trains: u32,
    /// The lengths of its sections, from the low end.
    pub sections_m: Vec<u16>,
}

/// `[signal]`.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Signal {
    /// The speeds that ranks in telegrams mean; without it the aspects.
    pub speeds_km_h: Option<Vec<f64>>,
    pub frame_ms: u32,
    pub window: u32,
    pub run: u32,
    pub memory_ms: u32,
    pub fresh_ms: u32,
    pub life_ms: u32,
    pub fixed_life_ms: u32,
    pub brake_mm_s2: u32,
    pub margin_m: u32,
    pub heard_beyond_exit_m: u16,
    pub delay_ms: u32,
    pub code_way_ms: u32,
    pub worst_gradient_permille: i32,
    pub lowest_limit_km_h: f64,
    pub reaction_ms: u32,
    pub release_ms: u32,
    pub restriction_lead_ms: u32,
}

/// `[[section]]`: what its sub telegrams say.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Section {
    pub number: u16,
    pub length_m: u16,
    pub gradient_permille: i32,
    pub limit_km_h: f64,
}

/// `[position]`. Levels and differences in dB, in steps of 0.01.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Position {
    pub spacing_m: f64,
    pub lowest_db: Vec<f64>,
    pub highest_db: Vec<f64>,
    pub tolerance_db: f64,
    pub floor_db: f64,
    pub correction_db: Option<[f64; 2]>,
}

/// `[codes]`: the code frequencies of the two carriers.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Codes {
    /// By how much a measured frequency may be off.
    pub tolerance_hz: f64,
    /// The pairs that name a speed.
    pub pairs: Vec<Pair>,
}

/// A pair of code frequencies and the speed that it names.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Pair {
    pub main_hz: f64,
    pub sub_hz: f64,
    pub speed_km_h: f64,
}

/// `[train]`: what is true of every train that runs there.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Train {
    /// The length of the longest one.
    pub longest_m: u16,
    /// The service brake that every one has at least on the level, worn, on wet rail.
    pub brake_mm_s2: u32,
    /// The longest for which one may not be detected where it stands.
    pub shunt_loss_ms: u32,
}

/// `[budget]`: numbers by name; [`crate::budget`] knows the names.
#[derive(Debug, Deserialize)]
#[serde(transparent)]
pub struct Budget {
    pub values: BTreeMap<String, f64>,
}

/// `[[station]]`.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Station {
    /// Its layout, in any form that layouts have; relative to the line's file.
    pub file: String,
    /// What it is called in this file; without it, as its layout calls it.
    pub name: Option<String>,
    /// The speeds that telegrams name for the layout's codes 1, 2, …; without it, the codes' own.
    pub code_speeds_km_h: Option<Vec<f64>>,
}

/// `[[border]]`: between two stations, or between a station and the counted blocks.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Border {
    /// Two stations that see the line `line`.
    pub between: Option<[String; 2]>,
    /// The line, as both layouts call it.
    pub line: Option<String>,
    /// The station whose segment `segment` ends at `joint`, where the counted blocks begin.
    pub station: Option<String>,
    pub segment: Option<String>,
    pub joint: Option<String>,
    /// At which end of the blocks.
    pub blocks: Option<End>,
}

/// An end of the counted blocks.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum End {
    /// Before the first block.
    Low,
    /// Beyond the last block.
    High,
}

/// `[[telegram]]`: the section numbers that are sent in a circuit of a station.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Telegram {
    pub station: String,
    pub circuit: String,
    /// To trains that travel to the left of the layout: an odd number.
    pub left: Option<u16>,
    /// To those that travel to the right: an even number.
    pub right: Option<u16>,
}
