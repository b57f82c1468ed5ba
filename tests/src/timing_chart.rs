//! Timing charts in ASCII, in the manner of the patent's figures.
//!
//! ```text
//! ms       0       400     800     1200
//! B        .............................##############
//! A        ############...########....................
//! display  ......AAAAAAAAAAAAAAAAAAAAAAAAAAAAAABBBBBBBB
//! ```
//!
//! A letter names an aspect, A the lowest. A column is a fixed number of milliseconds. In the row of an aspect `#` is
//! a signal that is heard throughout the column and `.` silence. The display row names the aspect that is displayed,
//! `.` for none. An output stands from the end of its logic cycle on, so a display that begins with the column of
//! 300 ms was put out by the cycle that ended at 300 ms. Every logic cycle is checked, not one for each column.

use std::fmt;

use atc_kernel::aspect::{AspectId, AspectSet, Display};

/// A parsed chart.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TimingChart {
    /// Logic cycles in one column.
    per_column: usize,
    /// By column: what is heard.
    heard: Vec<AspectSet>,
    /// By column: what is displayed.
    display: Vec<Display>,
}

/// What is wrong with a chart's text.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ChartError(pub String);

impl fmt::Display for ChartError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

impl TimingChart {
    /// Reads a chart whose columns are `column_ms` long, for logic cycles of `cycle_ms`.
    ///
    /// # Errors
    /// A column that is not a whole number of cycles; a row that is not a ruler, an aspect or the display; an aspect
    /// twice; a sign that is not one of the row; rows of different lengths; a ruler whose numbers stand in the wrong
    /// columns; no display row.
    pub fn parse(text: &str, column_ms: u32, cycle_ms: u32) -> Result<Self, ChartError> {
        if cycle_ms == 0 || column_ms == 0 || !column_ms.is_multiple_of(cycle_ms) {
            return Err(ChartError(format!(
                "a column of {column_ms} ms is not a whole number of cycles of {cycle_ms} ms"
            )));
        }
        let mut rows: Vec<(AspectId, &str)> = Vec::new();
        let mut display = None;
        for line in text.lines().filter(|line| !line.trim().is_empty()) {
            let (name, row) = line.trim().split_once(' ').unwrap_or((line.trim(), ""));
            match name {
                "ms" => check_ruler(line, text, column_ms)?,
                "display" if display.is_none() => display = Some(row.trim()),
                _ => {
                    let aspect = aspect(name).ok_or_else(|| ChartError(format!("a row cannot be called {name:?}")))?;
                    if rows.iter().any(|(known, _)| *known == aspect) {
                        return Err(ChartError(format!("two rows for aspect {name}")));
                    }
                    rows.push((aspect, row.trim()));
                }
            }
        }
        let display = display.ok_or_else(|| ChartError("there is no display row".to_owned()))?;
        let mut heard = vec![AspectSet::EMPTY; display.len()];
        for (aspect, row) in rows {
            if row.len() != display.len() {
                return Err(ChartError(format!("a row of {} columns, a display of {}", row.len(), display.len())));
            }
            for (column, sign) in heard.iter_mut().zip(row.chars()) {
                match sign {
                    '#' => *column = column.with(aspect),
                    '.' => {}
                    _ => return Err(ChartError(format!("{sign:?} is neither heard (#) nor silent (.)"))),
                }
            }
        }
        let shown = |sign: char| match sign {
            '.' => Ok(Display::NOTHING),
            _ => aspect(&sign.to_string())
                .map(Display::of)
                .ok_or_else(|| ChartError(format!("{sign:?} is neither an aspect (A to P) nor nothing (.)"))),
        };
        let display = display.chars().map(shown).collect::<Result<_, _>>()?;
        Ok(Self { per_column: (column_ms / cycle_ms) as usize, heard, display })
    }

    /// What is heard, by logic cycle: all but the last, whose output would stand beyond the chart.
    pub fn detections(&self) -> Vec<AspectSet> {
        let cycles = self.heard.iter().flat_map(|set| std::iter::repeat_n(*set, self.per_column));
        cycles.take((self.heard.len() * self.per_column).saturating_sub(1)).collect()
    }

    /// What must be displayed, by logic cycle, and at the start nothing.
    pub fn displays(&self) -> Vec<Display> {
        let instants = self.display.iter().flat_map(|display| std::iter::repeat_n(*display, self.per_column));
        instants.skip(1).collect()
    }

    /// Compares with what a device displayed, by logic cycle.
    ///
    /// # Errors
    /// Where they part, and both rows; or a chart that begins with a display, as no device does.
    pub fn compare(&self, shown: &[Display]) -> Result<(), ChartError> {
        let expected = self.displays();
        if self.display.first().is_some_and(|first| *first != Display::NOTHING) {
            return Err(ChartError("nothing is displayed at the start".to_owned()));
        }
        if shown.len() != expected.len() {
            return Err(ChartError(format!("{} outputs for {} cycles", shown.len(), expected.len())));
        }
        let Some(cycle) = expected.iter().zip(shown).position(|(expected, shown)| expected != shown) else {
            return Ok(());
        };
        let row = |displays: &[Display]| -> String {
            // Each column by its last cycle.
            let ends = (1..=self.display.len()).map(|column| column * self.per_column - 1);
            ends.map(|end| end.checked_sub(1).and_then(|end| displays.get(end)).map_or('.', |display| letter(*display)))
                .collect()
        };
        Err(ChartError(format!(
            "after cycle {cycle} (column {} of the chart) the display is {}, not {}\n  expected  {}\n  displayed {}",
            (cycle + 1) / self.per_column,
            letter(shown[cycle]),
            letter(expected[cycle]),
            row(&expected),
            row(shown),
        )))
    }
}

/// A to P.
fn aspect(name: &str) -> Option<AspectId> {
    match name.as_bytes() {
        [letter @ b'A'..=b'P'] => AspectId::new(letter - b'A'),
        _ => None,
    }
}

fn letter(display: Display) -> char {
    display.aspect().map_or('.', |aspect| char::from(b'A' + aspect.rank()))
}

/// Every number of a ruler stands over the column that begins at that instant.
fn check_ruler(ruler: &str, text: &str, column_ms: u32) -> Result<(), ChartError> {
    let row = text.lines().find(|line| line.trim_start().starts_with("display "));
    let Some(row) = row else { return Ok(()) };
    let origin = row.trim_end().rfind(' ').map_or(0, |space| space + 1);
    let mut place = ruler.find("ms").map_or(0, |at| at + 2);
    while let Some(gap) = ruler[place..].find(|sign: char| !sign.is_whitespace()) {
        let start = place + gap;
        let end = ruler[start..].find(char::is_whitespace).map_or(ruler.len(), |length| start + length);
        let instant = ruler[start..end].parse::<usize>();
        if instant != Ok(start.wrapping_sub(origin).wrapping_mul(column_ms as usize)) {
            return Err(ChartError(format!("{} on the ruler is in the wrong place", &ruler[start..end])));
        }
        place = end;
    }
    Ok(())
}
