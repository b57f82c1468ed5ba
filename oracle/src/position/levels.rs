//! Measured levels, as CSV: a head that names columns and units, and one line for each place.

use std::fmt::Write as _;

use atc_waveform::calibration::measured::Measurement;
use atc_waveform::rail::{Decibels, LEAKAGE_RANGE, Metres};

/// How many wrong cells are told.
const TOLD: usize = 20;
/// The farthest distance that is no slip of the unit, metres.
const FARTHEST: f64 = 10_000.0;
/// The largest level either way, dB.
const LARGEST: f64 = 300.0;
/// The columns that there are.
const COLUMNS: &str = "distance_m or distance_km; first_db and second_db, or difference_db; and, if wanted, pass, date, weather and \
                       ballast_ohm_km";

/// What a column holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Column {
    /// The distance, in so many metres.
    Distance(u16),
    First,
    Second,
    Difference,
    Ballast,
    /// What tells passes apart, in words.
    Pass,
    Date,
    Weather,
}

/// Some measurements with the same pass, date, weather and ballast.
pub struct Pass {
    /// What they have in common, in words.
    pub name: String,
    /// Its ballast, if the file tells it.
    pub ballast_ohm_km: Option<f64>,
    /// The measurements, and the line of each in the file.
    pub measurements: Vec<Measurement>,
    /// As many.
    pub lines: Vec<u64>,
}

/// A file of levels.
pub struct Levels {
    /// In the order in which they begin.
    pub passes: Vec<Pass>,
    /// The lowest level, dB; none where the file has differences.
    pub lowest: Option<f64>,
    /// The column of a difference, counted from 1, and its name.
    pub column: (usize, String),
}

/// Reads a file; `name` is its name for messages.
///
/// # Errors
/// Every wrong cell, with line and column and what would be right; at most 20.
pub fn read(name: &str, text: &str) -> Result<Levels, String> {
    let text = text.trim_start_matches('\u{feff}');
    let head = text.lines().find(|line| !line.trim().is_empty() && !line.starts_with('#')).unwrap_or("");
    let separator = if head.contains(';') {
        b';'
    } else if head.contains('\t') {
        b'\t'
    } else {
        b','
    };
    let mut reader = csv::ReaderBuilder::new()
        .has_headers(false)
        .flexible(true)
        .trim(csv::Trim::All)
        .comment(Some(b'#'))
        .delimiter(separator)
        .from_reader(text.as_bytes());
    let mut records = reader.records();
    let first = match records.next() {
        None => return Err(format!("{name}: is empty; the first line must name the columns: {COLUMNS}")),
        Some(record) => record.map_err(|error| format!("{name}: {error}"))?,
    };
    let heads: Vec<String> = first.iter().map(str::to_owned).collect();
    let columns = columns(&heads).map_err(|reason| {
        let line = first.position().map_or(1, csv::Position::line);
        reason.lines().map(|reason| format!("{name}:{line}: {reason}")).collect::<Vec<_>>().join("\n")
    })?;
    let mut rows = Rows { name, heads: &heads, columns: &columns, passes: Vec::new(), lowest: None, wrong: Vec::new() };
    for record in records {
        match record {
            Ok(record) => rows.take(&record),
            Err(error) => rows.wrong.push(format!("{name}: {error}")),
        }
    }
    if !rows.wrong.is_empty() {
        let more = rows.wrong.len().saturating_sub(TOLD);
        rows.wrong.truncate(TOLD);
        let mut all = rows.wrong.join("\n");
        if more > 0 {
            let _ = write!(all, "\n{name}: and {more} more");
        }
        return Err(all);
    }
    let place = columns.iter().position(|column| matches!(column, Column::First | Column::Difference)).unwrap_or(0);
    let passes = rows.passes.into_iter().map(|(_, pass)| pass).collect();
    Ok(Levels { passes, lowest: rows.lowest, column: (place + 1, heads[place].clone()) })
}

/// A head in the one form: `Distance (m)` is `distance_m`.
fn plain(head: &str) -> String {
    let mut plain = String::new();
    for letter in head.trim().to_lowercase().replace('ω', "ohm").chars() {
        match letter {
            ')' | ']' => {}
            'a'..='z' | '0'..='9' => plain.push(letter),
            _ if plain.ends_with('_') || plain.is_empty() => {}
            _ => plain.push('_'),
        }
    }
    plain.trim_end_matches('_').to_owned()
}

/// What the columns are.
fn columns(heads: &[String]) -> Result<Vec<Column>, String> {
    let mut columns = Vec::new();
    let mut wrong = Vec::new();
    for (place, head) in heads.iter().enumerate() {
        let number = place + 1;
        let column = match plain(head).as_str() {
            "distance_m" => Column::Distance(1),
            "distance_km" => Column::Distance(1000),
            "first_db" => Column::First,
            "second_db" => Column::Second,
            "difference_db" => Column::Difference,
            "ballast_ohm_km" => Column::Ballast,
            "pass" => Column::Pass,
            "date" => Column::Date,
            "weather" => Column::Weather,
            unit @ ("distance" | "first" | "second" | "difference" | "ballast") => {
                let right = match unit {
                    "distance" => "distance_m or distance_km",
                    "first" => "first_db",
                    "second" => "second_db",
                    "difference" => "difference_db",
                    _ => "ballast_ohm_km",
                };
                wrong.push(format!("column {number} ({head}): the unit is missing; the head must be {right}"));
                continue;
            }
            _ => {
                wrong.push(format!("column {number} ({head}): is no column of this form; there are {COLUMNS}"));
                continue;
            }
        };
        let same = |other: &Column| std::mem::discriminant(other) == std::mem::discriminant(&column);
        if let Some(before) = columns.iter().position(same) {
            wrong.push(format!("column {number} ({head}): column {} is the same; each must be there once", before + 1));
        }
        columns.push(column);
    }
    if wrong.is_empty() {
        let has = |column: Column| columns.contains(&column);
        if !columns.iter().any(|column| matches!(column, Column::Distance(_))) {
            wrong.push("there is no distance; a column distance_m or distance_km is needed".to_owned());
        }
        let levels = has(Column::First) && has(Column::Second);
        let some = has(Column::First) || has(Column::Second);
        if levels == has(Column::Difference) || (some && !levels) {
            wrong.push("the columns must be first_db and second_db, or difference_db alone".to_owned());
        }
    }
    if wrong.is_empty() { Ok(columns) } else { Err(wrong.join("\n")) }
}

/// What is read of the rows.
struct Rows<'a> {
    name: &'a str,
    heads: &'a [String],
    columns: &'a [Column],
    passes: Vec<(Vec<String>, Pass)>,
    lowest: Option<f64>,
    wrong: Vec<String>,
}

impl Rows<'_> {
    fn take(&mut self, record: &csv::StringRecord) {
        let line = record.position().map_or(0, csv::Position::line);
        if record.iter().all(str::is_empty) {
            return;
        }
        if record.len() != self.columns.len() {
            let (name, found, needed) = (self.name, record.len(), self.columns.len());
            let hint = if found > needed { "; a decimal point is written as a point" } else { "" };
            self.wrong.push(format!("{name}:{line}: has {found} columns; it must have {needed}, as the head{hint}"));
            return;
        }
        let (mut distance, mut first, mut second, mut difference, mut ballast) = (None, None, None, None, None);
        let mut key = Vec::new();
        let before = self.wrong.len();
        for (place, (column, cell)) in self.columns.iter().zip(record.iter()).enumerate() {
            match column {
                Column::Distance(metres) => {
                    let most = FARTHEST / f64::from(*metres);
                    distance = self.number(line, place, cell, (0.0, most)).map(|value| value * f64::from(*metres));
                }
                Column::First => first = self.number(line, place, cell, (-LARGEST, LARGEST)),
                Column::Second => second = self.number(line, place, cell, (-LARGEST, LARGEST)),
                Column::Difference => difference = self.number(line, place, cell, (-LARGEST, LARGEST)),
                Column::Ballast => {
                    if !cell.is_empty() {
                        ballast = self.number(line, place, cell, LEAKAGE_RANGE);
                        key.push(format!("{cell} Ω·km"));
                    }
                }
                Column::Pass | Column::Date | Column::Weather => {
                    if !cell.is_empty() {
                        key.push(if *column == Column::Pass { format!("pass {cell}") } else { cell.to_owned() });
                    }
                }
            }
        }
        if self.wrong.len() > before {
            return;
        }
        let level = first.zip(second).map(|(first, second)| first - second).or(difference);
        let Some((distance, level)) = distance.zip(level) else { return };
        if level.abs() > LARGEST {
            let place = self.columns.iter().position(|column| *column == Column::First).unwrap_or(0);
            let what = format!("first less second is {level} dB; it must be -{LARGEST} to {LARGEST}");
            self.wrong.push(self.at(line, place, &what));
            return;
        }
        for level in [first, second].into_iter().flatten() {
            self.lowest = Some(self.lowest.map_or(level, |lowest| lowest.min(level)));
        }
        let measurement = Measurement { distance: Metres(distance), difference: Decibels(level) };
        let place = self.passes.iter().position(|(other, _)| *other == key).unwrap_or_else(|| {
            let name = if key.is_empty() { "all".to_owned() } else { key.join(", ") };
            let pass = Pass { name, ballast_ohm_km: ballast, measurements: Vec::new(), lines: Vec::new() };
            self.passes.push((key, pass));
            self.passes.len() - 1
        });
        let pass = &mut self.passes[place].1;
        pass.measurements.push(measurement);
        pass.lines.push(line);
    }

    /// A number within its range, or the reason why it is none.
    fn number(&mut self, line: u64, place: usize, cell: &str, (least, most): (f64, f64)) -> Option<f64> {
        let right = format!("it must be a number from {least} to {most}");
        let what = match cell.parse::<f64>() {
            _ if cell.is_empty() => format!("is empty; {right}"),
            Ok(value) if (least..=most).contains(&value) => return Some(value),
            Ok(value) if value < 0.0 && matches!(self.columns[place], Column::Distance(_)) => {
                format!("is {cell}; {right}: distances are counted from the transmitter ahead")
            }
            Ok(_) => format!("is {cell}; {right}"),
            Err(_) if cell.contains(',') => format!("is \"{cell}\"; {right}, with a decimal point"),
            Err(_) => format!("is \"{cell}\"; {right}"),
        };
        let what = self.at(line, place, &what);
        self.wrong.push(what);
        None
    }

    fn at(&self, line: u64, place: usize, what: &str) -> String {
        format!("{}:{line}: column {} ({}): {what}", self.name, place + 1, self.heads[place])
    }
}
