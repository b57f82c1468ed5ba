//! The control table: what each route needs, excludes and releases, for an engineer to check by eye.

mod csv;
mod html;
pub mod rendo;
mod row;

pub use html::{escape, html};
pub use row::COLUMNS;

use crate::model::Model;
use csv::line;
use row::Row;

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
