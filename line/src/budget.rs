//! The levels of a line's train control signal. Table `[budget]`: every value has a default, and says whether it is
//! one.

use crate::form;
use crate::refusal::Refusal;
use crate::rule::Rule;

/// One value.
#[derive(Clone, Debug, PartialEq)]
pub struct Value {
    /// Its name in the file.
    pub name: &'static str,
    /// The value.
    pub value: f64,
    /// Its unit.
    pub unit: &'static str,
    /// What it is.
    pub what: &'static str,
    /// Whether the file gives it; else it is a default, which nobody has chosen for this line.
    pub given: bool,
}

/// What a link budget starts from. Levels are in dB over any one reference, such as 1 mA in the rail.
#[derive(Clone, Debug, PartialEq)]
pub struct Budget {
    /// All of them, in the order of the table in `line/README.md`.
    pub values: Vec<Value>,
}

/// Name, default, least and most, unit, and what it is.
type Row = (&'static str, f64, (f64, f64), &'static str, &'static str);

const ROWS: [Row; 12] = [
    ("main_db", 60.0, (-200.0, 200.0), "dB", "level of the main carrier at the transmitter, without its code"),
    ("sub_db", 60.0, (-200.0, 200.0), "dB", "level of the sub carrier at the transmitter, without its code"),
    ("main_carrier_hz", 750.0, (100.0, 96_000.0), "Hz", "centre of the main carrier"),
    ("sub_carrier_hz", 1200.0, (100.0, 96_000.0), "Hz", "centre of the sub carrier"),
    ("depth", 2.0 / 3.0, (0.0, 1.0), "", "depth of the modulation by the codes"),
    ("wet_ohm_km", 2.0, (0.1, 10_000.0), "Ω·km", "the least insulation of the ballast"),
    ("other_losses_db", 0.0, (0.0, 200.0), "dB", "what joints, antennas and worn rails take besides"),
    ("noise_db", 30.0, (-200.0, 200.0), "dB", "noise in noise_band_hz at the receiver, traction current running"),
    ("noise_band_hz", 4000.0, (1.0, 1e6), "Hz", "the band of that noise, which is taken to be even in it"),
    ("lost_part", 0.01, (1e-6, 0.5), "", "the part of telegrams, and of reports of codes, that may be lost"),
    ("carrier_offset_hz", 1.0, (0.0, 100.0), "Hz", "by how much a transmitter's carrier may be off the receiver's"),
    ("least_margin_db", 6.0, (-100.0, 100.0), "dB", "the margin that must be left"),
];

/// Checks the table; without one all values are defaults.
///
/// # Errors
/// The first value outside its range, with its field in `[budget]`.
pub(crate) fn checked(given: Option<&form::Budget>) -> Result<Budget, Refusal> {
    let value = |(name, default, (least, most), unit, what): Row| {
        let found = given.and_then(|given| given.values.get(name).copied());
        let value = found.unwrap_or(default);
        if !(least..=most).contains(&value) {
            let told = format!("{name} is {value}; it must be {least} to {most}");
            return Err(Refusal::new(Rule::Range, format!("budget.{name}"), told));
        }
        Ok(Value { name, value, unit, what, given: found.is_some() })
    };
    if let Some(unknown) = given.and_then(|given| given.values.keys().find(|key| ROWS.iter().all(|row| row.0 != *key)))
    {
        let names: Vec<_> = ROWS.iter().map(|row| row.0).collect();
        let what = format!("unknown field `{unknown}`, expected one of {}", names.join(", "));
        return Err(Refusal::new(Rule::Form, format!("budget.{unknown}"), what));
    }
    Ok(Budget { values: ROWS.into_iter().map(value).collect::<Result<_, _>>()? })
}

impl Budget {
    /// A value by its name; not a number if there is none of that name.
    pub fn get(&self, name: &str) -> f64 {
        self.values.iter().find(|value| value.name == name).map_or(f64::NAN, |value| value.value)
    }
}
