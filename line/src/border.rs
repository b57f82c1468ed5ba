//! The borders that a line's file gives: between two stations, and between a station and the counted blocks.

use crate::form::{Border, End};
use crate::refusal::Refusal;
use crate::rule::Rule;

/// The borders of a line.
#[derive(Clone, Debug, Default)]
pub struct Borders {
    /// Those between two stations.
    pub between: Vec<Between>,
    /// Those between a station and the counted blocks.
    pub counted: Vec<Counted>,
}

/// Two stations that see one line.
#[derive(Clone, Debug)]
pub struct Between {
    /// Its number among the borders of the file.
    pub(crate) number: usize,
    /// The stations.
    pub stations: [String; 2],
    /// The line, as both layouts call it.
    pub line: String,
}

/// A station whose segment ends where the counted blocks begin.
#[derive(Clone, Debug)]
pub struct Counted {
    /// Its number among the borders of the file.
    pub(crate) number: usize,
    /// The station.
    pub station: String,
    /// Its segment.
    pub segment: String,
    /// The joint at which the segment ends.
    pub joint: String,
    /// The end of the blocks.
    pub blocks: End,
}

impl Borders {
    /// The borders of a file.
    ///
    /// # Errors
    /// The first that is neither of the two forms.
    pub(crate) fn of(given: &[Border]) -> Result<Self, Refusal> {
        let mut all = Self::default();
        for (number, one) in given.iter().enumerate() {
            match one {
                Border {
                    between: Some(stations),
                    line: Some(line),
                    station: None,
                    segment: None,
                    joint: None,
                    blocks: None,
                } => {
                    let (stations, line) = (stations.clone(), line.clone());
                    all.between.push(Between { number, stations, line });
                }
                Border {
                    between: None,
                    line: None,
                    station: Some(station),
                    segment: Some(segment),
                    joint: Some(joint),
                    blocks: Some(blocks),
                } => {
                    let (station, segment, joint) = (station.clone(), segment.clone(), joint.clone());
                    all.counted.push(Counted { number, station, segment, joint, blocks: *blocks });
                }
                _ => {
                    let what = "a border has between and line; or station, segment, joint and blocks";
                    return Err(Refusal::new(Rule::Form, format!("border[{number}]"), what));
                }
            }
        }
        Ok(all)
    }
}
