//! `train-position`: [`atc_kernel::position`] behind the protocol.

use atc_kernel::position::{
    self, Correction, Interval, KNOTS, Measured, Millibels, Moved, Position, Spacing, Table, TableError,
};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{Cycle, Machine};
use crate::chart::{self, Scene};
use crate::decimal::{Decibels, Metres, OrNull};

/// The configuration: a calibrated table, and what is known of the measurement.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "PositionConfig")]
pub struct Config {
    /// The level difference over the distance.
    pub table: TableConfig,
    /// By how much each measured level may be off, 0 or more.
    pub tolerance_db: Decibels,
    /// A level under this one is noise.
    pub floor_db: Decibels,
    /// The least and the most that is added to the measured difference: the attenuation over the train's length where one receiver
    /// is at its rear. Both are 0 where both receivers are at the front.
    #[serde(default)]
    pub correction_db: [Decibels; 2],
}

/// The least and the greatest level difference, first less second, at 17 equally spaced distances from the transmitter, from 0 on.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "PositionTable")]
pub struct TableConfig {
    /// The distance from one to the next: 1.6, 3.2, 6.4, 12.8, 25.6, 51.2, 102.4 or 204.8 m.
    pub spacing_m: Metres,
    /// The least difference at each distance.
    #[schemars(length(equal = 17))]
    pub lowest_db: Vec<Decibels>,
    /// The greatest difference at each distance.
    #[schemars(length(equal = 17))]
    pub highest_db: Vec<Decibels>,
}

/// One cycle's measurement.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "PositionStep")]
pub struct Step {
    /// The level of the signal that the rail attenuates less; null: it is not heard.
    #[serde(deserialize_with = "Option::deserialize")]
    #[schemars(with = "OrNull<Decibels>")]
    pub first_db: Option<Decibels>,
    /// The level of the signal that the rail attenuates more; null: it is not heard.
    #[serde(deserialize_with = "Option::deserialize")]
    #[schemars(with = "OrNull<Decibels>")]
    pub second_db: Option<Decibels>,
    /// The least and the most that the train moved towards the transmitter since the last cycle: -32.768 to 32.767 m, negative if it
    /// moved away.
    pub moved_m: [Metres; 2],
    /// The true distance to the transmitter at the end of the cycle, if it is known. Only the chart reads it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub truth_m: Option<Metres>,
}

/// One cycle's output.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[schemars(rename = "PositionOutput")]
pub struct Output {
    /// The least and the greatest distance of the train's front to the transmitter ahead; null: it is not known.
    // It may be null, but it may not be missing.
    #[serde(deserialize_with = "Option::deserialize")]
    #[schemars(with = "OrNull<[Metres; 2]>")]
    pub interval_m: Option<[Metres; 2]>,
}

/// A level that must fit, or a sentence that says so.
fn level(field: &str, level: Decibels) -> Result<Millibels, String> {
    i16::try_from(level.0).map(Millibels).map_err(|_| format!("{field} is {level} dB; it must be -327.68 to 327.67 dB"))
}

/// The values of a curve.
fn curve(field: &str, levels: &[Decibels]) -> Result<[Millibels; KNOTS], String> {
    let mut curve = [Millibels(0); KNOTS];
    if levels.len() != KNOTS {
        return Err(format!("{field} has {} values; it must have {KNOTS}", levels.len()));
    }
    for (place, (value, given)) in curve.iter_mut().zip(levels).enumerate() {
        *value = level(&format!("{field}[{place}]"), *given)?;
    }
    Ok(curve)
}

impl Config {
    /// The parameters in the kernel's form.
    ///
    /// # Errors
    /// The rule that they break, in a sentence.
    pub fn position(&self) -> Result<Position, String> {
        let TableConfig { spacing_m, lowest_db, highest_db } = &self.table;
        let spacings = (4..=11).filter_map(Spacing::new);
        let spacing = spacings.into_iter().find(|spacing| i64::from(spacing.decimetres()) * 100 == spacing_m.0);
        let spacing = spacing.ok_or_else(|| {
            format!("table.spacing_m is {spacing_m} m; it must be 1.6, 3.2, 6.4, 12.8, 25.6, 51.2, 102.4 or 204.8 m")
        })?;
        let (lowest, highest) = (curve("table.lowest_db", lowest_db)?, curve("table.highest_db", highest_db)?);
        let table = Table::new(spacing, lowest, highest).map_err(|error| match error {
            TableError::Crossed(knot) => format!(
                "table.lowest_db[{knot}] is {} dB and table.highest_db[{knot}] {} dB; the lowest must not be above the highest",
                lowest_db[knot], highest_db[knot]
            ),
            TableError::NowhereRising => {
                "in table no two neighbours rise both in lowest_db and in highest_db; no distance could be found".to_owned()
            }
        })?;
        let [least, most] = self.correction_db;
        let [kernel_least, kernel_most] = [level("correction_db[0]", least)?, level("correction_db[1]", most)?];
        let correction = Correction::new(kernel_least, kernel_most)
            .ok_or_else(|| format!("correction_db is [{least}, {most}]; the least must stand before the most"))?;
        let tolerance = level("tolerance_db", self.tolerance_db)?;
        Position::new(table, tolerance, level("floor_db", self.floor_db)?, correction)
            .ok_or_else(|| format!("tolerance_db is {} dB; it must be 0 or more", self.tolerance_db))
    }
}

/// The machine with its state.
#[derive(Clone, Debug)]
pub struct Positioned {
    position: Position,
    interval: Option<Interval>,
}

/// The ends of an interval.
pub(super) fn ends(interval: Interval) -> [Metres; 2] {
    [interval.nearest(), interval.farthest()].map(|end| Metres(end.0.into()))
}

impl Step {
    /// The step in the kernel's form.
    ///
    /// # Errors
    /// The first field that does not fit, in a sentence.
    pub fn measured(&self) -> Result<Measured, String> {
        let one = |field: &str, level_db: Option<Decibels>| level_db.map(|level_db| level(field, level_db)).transpose();
        let [least, most] = self.moved_m;
        let fit = |moved: Metres| {
            i16::try_from(moved.0)
                .map_err(|_| format!("moved_m has {moved} m; in one cycle a train moves by -32.768 to 32.767 m"))
        };
        let moved = Moved::new(fit(least)?, fit(most)?)
            .ok_or_else(|| format!("moved_m is [{least}, {most}]; the least must stand before the most"))?;
        Ok(Measured { first: one("first_db", self.first_db)?, second: one("second_db", self.second_db)?, moved })
    }
}

impl Machine for Positioned {
    const NAME: &'static str = "train-position";
    const STEP: &'static str = r#"{"first_db":-21.5,"second_db":-24.25,"moved_m":[1.4,1.6]}"#;
    const CONFIG: &'static str = r#"{"table":{"spacing_m":25.6,"lowest_db":[0,0.5,1,1.5,2,2.5,3,3.5,4,4.5,5,5.5,6,6.5,7,7.5,8],"highest_db":[0,1,2,3,4,5,6,7,8,9,10,11,12,13,14,15,16]},"tolerance_db":0.1,"floor_db":-60,"correction_db":[0,0]}"#;

    type Config = Config;
    type Step = Step;
    type Output = Output;

    fn open(config: &Config) -> Result<Self, String> {
        Ok(Self { position: config.position()?, interval: None })
    }

    fn step(&mut self, step: &Step) -> Result<Output, String> {
        self.interval = position::step(&self.position, self.interval, step.measured()?);
        Ok(Output { interval_m: self.interval.map(ends) })
    }

    fn chart(config: &Config, cycles: &[Cycle<Self>]) -> Scene {
        chart::position::scene(config, cycles)
    }
}
