//! The position of a line's trains: the attenuation table and what is known of the levels.

use atc_kernel::position::{Correction, KNOTS, Millibels, Position, SPANS, Spacing, Table, TableError};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::check::{DataCheck, Outcome};
use crate::decimal::{Decibels, Metres};
use crate::figures::Derived;
use crate::refusal::Refusal;
use crate::rule::Rule;

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

/// A level that must fit.
///
/// # Errors
/// If it does not, with the name of its field.
pub fn level(field: &str, level: Decibels) -> Result<Millibels, Refusal> {
    let what = || format!("{field} is {level} dB; it must be -327.68 to 327.67 dB");
    i16::try_from(level.0).map(Millibels).map_err(|_| Refusal::new(Rule::Range, field, what()))
}

/// The values of a curve.
fn curve(field: &str, levels: &[Decibels]) -> Result<[Millibels; KNOTS], Refusal> {
    let mut curve = [Millibels(0); KNOTS];
    if levels.len() != KNOTS {
        return Err(Refusal::new(
            Rule::Range,
            field,
            format!("{field} has {} values; it must have {KNOTS}", levels.len()),
        ));
    }
    for (place, (value, given)) in curve.iter_mut().zip(levels).enumerate() {
        *value = level(&format!("{field}[{place}]"), *given)?;
    }
    Ok(curve)
}

impl TableConfig {
    /// The table in the kernel's form; `in_table` stands before the names of its fields: `table.`, or nothing.
    fn table(&self, in_table: &str) -> Result<Table, Refusal> {
        let Self { spacing_m, lowest_db, highest_db } = self;
        let name = |field: &str| format!("{in_table}{field}");
        let mut spacings = (4..=11).filter_map(Spacing::new);
        let spacing = spacings.find(|spacing| i64::from(spacing.decimetres()) * 100 == spacing_m.0);
        let spacing = spacing.ok_or_else(|| {
            let field = name("spacing_m");
            let right = "it must be 1.6, 3.2, 6.4, 12.8, 25.6, 51.2, 102.4 or 204.8 m";
            Refusal::new(Rule::Range, &field, format!("{field} is {spacing_m} m; {right}"))
        })?;
        let (low, high) = (name("lowest_db"), name("highest_db"));
        Table::new(spacing, curve(&low, lowest_db)?, curve(&high, highest_db)?).map_err(|error| match error {
            TableError::Crossed(knot) => Refusal::new(
                Rule::Pos5,
                format!("{low}[{knot}]"),
                format!(
                    "{low}[{knot}] is {} dB and {high}[{knot}] {} dB; the lowest must not be above the highest",
                    lowest_db[knot], highest_db[knot]
                ),
            ),
            TableError::NowhereRising => Refusal::new(
                Rule::Pos5,
                &low,
                format!(
                    "in {} no two neighbours rise both in lowest_db and in highest_db; no distance could be found",
                    if in_table.is_empty() { "the table" } else { "table" }
                ),
            ),
        })
    }
}

impl Config {
    /// These parameters of the kernel.
    pub fn of(position: &Position) -> Self {
        let decibels = |level: Millibels| Decibels(level.0.into());
        let curve = |levels: &[Millibels; KNOTS]| levels.iter().copied().map(decibels).collect();
        let (table, correction) = (position.table(), position.correction());
        Self {
            table: TableConfig {
                spacing_m: Metres(i64::from(table.spacing().decimetres()) * 100),
                lowest_db: curve(table.lowest()),
                highest_db: curve(table.highest()),
            },
            tolerance_db: decibels(position.tolerance()),
            floor_db: decibels(position.floor()),
            correction_db: [decibels(correction.least()), decibels(correction.most())],
        }
    }

    /// The parameters in the kernel's form.
    ///
    /// # Errors
    /// The rule that they break.
    pub fn position(&self) -> Result<Position, Refusal> {
        self.position_named("table.")
    }

    /// The same where `in_table` stands before the names of the table's fields: `table.`, or nothing.
    pub(crate) fn position_named(&self, in_table: &str) -> Result<Position, Refusal> {
        let table = self.table.table(in_table)?;
        let [least, most] = self.correction_db;
        let [kernel_least, kernel_most] = [level("correction_db[0]", least)?, level("correction_db[1]", most)?];
        let correction = Correction::new(kernel_least, kernel_most).ok_or_else(|| {
            let what = format!("correction_db is [{least}, {most}]; the least must stand before the most");
            Refusal::new(Rule::Range, "correction_db", what)
        })?;
        let tolerance = level("tolerance_db", self.tolerance_db)?;
        let floor = level("floor_db", self.floor_db)?;
        Position::new(table, tolerance, floor, correction).ok_or_else(|| {
            let what = format!("tolerance_db is {} dB; it must be 0 or more", self.tolerance_db);
            Refusal::new(Rule::Range, "tolerance_db", what)
        })
    }
}

/// The checked table of a line.
#[derive(Clone, Debug)]
pub struct Calibration {
    position: Position,
    longest: Option<u16>,
}

fn metres(decimetres: u32) -> f64 {
    f64::from(decimetres) / 10.0
}

impl Calibration {
    /// A checked table. `longest`: the line's longest section, if that is known.
    pub(crate) const fn new(position: Position, longest: Option<u16>) -> Self {
        Self { position, longest }
    }

    /// The parameters in the kernel's form.
    pub const fn position(&self) -> &Position {
        &self.position
    }

    fn rises(&self, span: usize) -> bool {
        let table = self.position.table();
        let rises = |curve: &[Millibels; KNOTS]| curve[span] < curve[span + 1];
        rises(table.lowest()) && rises(table.highest())
    }

    fn span(&self) -> f64 {
        metres(self.position.table().spacing().decimetres())
    }

    fn reach(&self) -> f64 {
        f64::from(u16::try_from(SPANS).unwrap_or(0)) * self.span()
    }

    /// The interval at a knot for a difference in the middle of the curves there, without an odometer: its width.
    fn width(&self, knot: usize) -> Option<f64> {
        use atc_kernel::position::{Measured, Moved, step};
        let table = self.position.table();
        let middle = (i32::from(table.lowest()[knot].0) + i32::from(table.highest()[knot].0)) / 2;
        let middle = i16::try_from(middle).ok()?;
        let floor = self.position.floor().0;
        let second = if middle < 0 { floor.saturating_sub(middle) } else { floor };
        let first = second.saturating_add(middle);
        let measured =
            Measured { first: Some(Millibels(first)), second: Some(Millibels(second)), moved: Moved::STANDING };
        let found = step(&self.position, None, measured)?;
        Some(f64::from(found.farthest().0 - found.nearest().0) / 1000.0)
    }

    /// What follows.
    pub fn derived(&self) -> Vec<Derived> {
        let row = Derived::row;
        let rising = (0..SPANS).filter(|span| self.rises(*span)).count();
        let knots = [SPANS / 4, SPANS / 2, 3 * SPANS / 4];
        let widths = knots.map(|knot| {
            let at = f64::from(u16::try_from(knot).unwrap_or(0)) * self.span();
            let width = self.width(knot).map_or_else(|| "unknown".to_owned(), |width| format!("{width:.1} m wide"));
            format!("at {at:.0} m {width}")
        });
        vec![
            row("The attenuation table reaches", format!("{:.1} m", self.reach()), "16 spans", "POS-7"),
            row(
                "Spans in which both curves rise",
                format!("{rising} of {SPANS}"),
                "elsewhere the position is unknown",
                "T-POS-4",
            ),
            row(
                "The interval by the levels alone",
                widths.join("; "),
                "computed by the kernel for a difference in the middle of the curves",
                "T-POS-1",
            ),
        ]
    }

    /// What the user should look at.
    pub fn notes(&self) -> Vec<String> {
        let mut notes = Vec::new();
        match self.longest {
            Some(longest) if f64::from(longest) >= self.reach() => notes.push(format!(
                "The attenuation table reaches {:.1} m, and the longest section is {longest} m: at its beginning the position is unknown.",
                self.reach()
            )),
            None => notes.push("No [[section]] is given: nobody has compared the table's reach with a section.".to_owned()),
            _ => {}
        }
        let flat: Vec<_> = (0..SPANS).filter(|span| !self.rises(*span)).map(|span| (span + 1).to_string()).collect();
        if !flat.is_empty() {
            notes.push(format!("Spans {} do not rise: there the position is unknown.", flat.join(", ")));
        }
        if self.position.tolerance().0 == 0 {
            notes.push("The tolerance of a level is 0 dB: no receiver measures so.".to_owned());
        }
        notes
    }

    /// The data checks that were made.
    pub fn checks(&self) -> Vec<DataCheck> {
        vec![DataCheck::new(Rule::Pos5, format!("{KNOTS} knots"), Outcome::Met)]
    }
}
