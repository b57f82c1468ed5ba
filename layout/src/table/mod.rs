//! The control table: what each route needs, excludes and releases, for an engineer to check by eye.

mod html;
pub mod rendo;
mod row;

pub use html::{escape, html};

use crate::model::Model;
use row::Row;

/// The heads of the columns of [`csv()`].
pub const COLUMNS: [&str; 20] = [
    "route",
    "signal",
    "heading",
    "entry",
    "path",
    "normal",
    "reverse",
    "flank normal",
    "flank reverse",
    "overlap",
    "overlap normal",
    "overlap reverse",
    "beyond",
    "approach",
    "conflicts",
    "continued by",
    "direction",
    "speed km/h",
    "times",
    "releases",
];

/// The cells of a route's row under [`COLUMNS`].
pub fn cells(model: &Model, route: usize) -> Vec<String> {
    Row::of(model, route).cells()
}

/// The control table as comma-separated values (RFC 4180), a row for each route.
pub fn csv(model: &Model) -> String {
    let mut text = String::new();
    line(&mut text, &COLUMNS.map(str::to_owned));
    for number in 0..model.routes.len() {
        line(&mut text, &Row::of(model, number).cells());
    }
    text
}

fn line(text: &mut String, cells: &[String]) {
    let quoted: Vec<String> = cells
        .iter()
        .map(|cell| {
            // A spreadsheet would take these for a formula.
            let guard = if cell.starts_with(['=', '+', '-', '@']) { "'" } else { "" };
            if cell.contains([',', '"', '\n', '\r']) {
                format!("\"{guard}{}\"", cell.replace('"', "\"\""))
            } else {
                format!("{guard}{cell}")
            }
        })
        .collect();
    text.push_str(&quoted.join(","));
    text.push_str("\r\n");
}
