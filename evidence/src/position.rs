//! The position of a line's trains: the attenuation table and what is known of the levels. Table `[position]`.

use crate::case::Derived;
use crate::error::Fault;
use crate::permitted::At;
use atc_kernel::position::{Correction, KNOTS, Millibels, Position, SPANS, Spacing, Table, TableError};
use serde::Deserialize;
use toml::Spanned;

/// `[position]`. Levels and differences in dB, in steps of 0.01.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FilePosition {
    spacing_m: Spanned<f64>,
    lowest_db: Spanned<Vec<Spanned<f64>>>,
    highest_db: Spanned<Vec<Spanned<f64>>>,
    tolerance_db: Spanned<f64>,
    floor_db: Spanned<f64>,
    #[serde(default)]
    correction_db: Option<Spanned<[Spanned<f64>; 2]>>,
}

/// The checked table.
#[derive(Clone, Debug)]
pub struct Calibration {
    position: Position,
    longest: Option<u16>,
}

/// Reads and checks; none if the line has no such table. `longest`: its longest section, if that is known.
///
/// # Errors
/// The first rule that is broken, with its place.
pub(crate) fn parse(
    at: At<'_>,
    file: Option<&FilePosition>,
    longest: Option<u16>,
) -> Result<Option<Calibration>, Fault> {
    let Some(file) = file else { return Ok(None) };
    let spacing = spacing(at, &file.spacing_m)?;
    let (lowest, highest) = (curve(at, &file.lowest_db, "lowest")?, curve(at, &file.highest_db, "highest")?);
    let table = Table::new(spacing, lowest, highest).map_err(|error| {
        let (span, rule) = match error {
            TableError::Crossed(knot) => {
                let place = file.lowest_db.get_ref().get(knot).map_or_else(|| file.lowest_db.span(), Spanned::span);
                let (low, high) = (decibels(lowest[knot]), decibels(highest[knot]));
                let number = knot + 1;
                (place, format!("at knot {number} the lowest difference ({low} dB) is above the highest ({high} dB)"))
            }
            TableError::NowhereRising => {
                (file.lowest_db.span(), "in no span do both curves rise: no distance could be told".to_owned())
            }
        };
        Fault::new(&at(span), format!("rule POS-5 is broken: {rule}"))
    })?;
    let tolerance = millibels(at, &file.tolerance_db)?;
    let floor = millibels(at, &file.floor_db)?;
    let correction = match &file.correction_db {
        None => Correction::NONE,
        Some(given) => {
            let [least, most] = given.get_ref();
            let (least, most) = (millibels(at, least)?, millibels(at, most)?);
            Correction::new(least, most).ok_or_else(|| {
                let text =
                    format!("the least correction ({} dB) is above the most ({} dB)", decibels(least), decibels(most));
                Fault::new(&at(given.span()), text)
            })?
        }
    };
    let position = Position::new(table, tolerance, floor, correction).ok_or_else(|| {
        let text = format!("a tolerance is 0 dB or more; it is {} dB", decibels(tolerance));
        Fault::new(&at(file.tolerance_db.span()), text)
    })?;
    Ok(Some(Calibration { position, longest }))
}

fn spacing(at: At<'_>, given: &Spanned<f64>) -> Result<Spacing, Fault> {
    let found = (4..=11).filter_map(Spacing::new).find(|one| (metres(one.decimetres()) - given.get_ref()).abs() < 1e-9);
    found.ok_or_else(|| {
        let text =
            format!("knots are 1.6, 3.2, 6.4, 12.8, 25.6, 51.2, 102.4 or 204.8 m apart; it is {} m", given.get_ref());
        Fault::new(&at(given.span()), text)
    })
}

fn curve(at: At<'_>, given: &Spanned<Vec<Spanned<f64>>>, name: &str) -> Result<[Millibels; KNOTS], Fault> {
    let values = given.get_ref().iter().map(|one| millibels(at, one)).collect::<Result<Vec<_>, _>>()?;
    let number = values.len();
    values.try_into().map_err(|_| {
        let text = format!("the {name} differences are {KNOTS}, from the transmitter on; there are {number}");
        Fault::new(&at(given.span()), text)
    })
}

/// Decibels as hundredths; no rounding: what cannot be kept exactly is refused.
fn millibels(at: At<'_>, given: &Spanned<f64>) -> Result<Millibels, Fault> {
    let value = *given.get_ref();
    let found = (i16::MIN..=i16::MAX).find(|one| (f64::from(*one) / 100.0 - value).abs() < 1e-9);
    found.map(Millibels).ok_or_else(|| {
        let text = format!("a level is −327.68 to 327.67 dB in steps of 0.01; it is {value}");
        Fault::new(&at(given.span()), text)
    })
}

fn metres(decimetres: u32) -> f64 {
    f64::from(decimetres) / 10.0
}

fn decibels(one: Millibels) -> f64 {
    f64::from(one.0) / 100.0
}

impl Calibration {
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
        let middle = i16::midpoint(table.lowest()[knot].0, table.highest()[knot].0);
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
    pub fn checks(&self) -> Vec<String> {
        vec!["POS-5: the attenuation table is accepted by the kernel's constructor".to_owned()]
    }
}

#[cfg(test)]
#[path = "position_tests.rs"]
mod tests;
