//! The control table in the columns of a Japanese interlocking table (連動図表), and a table of that form held against a layout.
//!
//! A position in brackets is reverse (反位), one without is normal (定位). A route in 鎖錠 is one that the positions of points do not exclude.

use std::collections::{BTreeMap, BTreeSet};

use super::csv::line;
use crate::compare::Differing;
use crate::conflict::{Reason, reasons};
use crate::form::Position;
use crate::model::Model;

/// The heads of the columns: route, signal, locking, signal control, points, sectional route locking, approach locking.
pub const COLUMNS: [&str; 7] = ["進路", "信号機", "鎖錠", "信号制御", "転てつ器", "進路区分鎖錠", "接近鎖錠"];

/// The table as comma-separated values (RFC 4180), a row for each route.
pub fn csv(model: &Model) -> String {
    let mut text = String::new();
    line(&mut text, &COLUMNS.map(str::to_owned));
    for number in 0..model.routes.len() {
        line(&mut text, &cells(model, number));
    }
    text
}

fn cells(model: &Model, number: usize) -> [String; 7] {
    let Some(route) = model.routes.get(number) else { return Default::default() };
    let circuit = |number: &usize| model.circuits.get(*number).map_or("", |circuit| circuit.name.as_str());
    let names = |numbers: &mut dyn Iterator<Item = usize>| {
        numbers.map(|number| circuit(&number).to_owned()).collect::<Vec<_>>().join(" ")
    };
    let point = |(point, position): (usize, Position)| {
        let name = model.points.get(point).map_or("", |point| point.name.as_str());
        if position == Position::Reverse { format!("({name})") } else { name.to_owned() }
    };
    let positions: BTreeSet<(usize, Position)> = route.positions().collect();
    let over: BTreeSet<(usize, Position)> = route
        .path
        .iter()
        .flat_map(|place| &place.passed)
        .chain(&route.overlap_passed)
        .map(|passed| (passed.point, passed.position))
        .collect();
    let excluded = model.routes.iter().enumerate().filter(|(other, _)| {
        let why = reasons(model, number, *other);
        !why.is_empty() && !why.contains(&Reason::Point)
    });
    let locking: Vec<String> =
        positions.iter().copied().map(point).chain(excluded.map(|(_, other)| other.name.clone())).collect();
    // A berth is not proved clear.
    let clear = route.overlap.iter().copied().filter(|_| !route.calling_on);
    let seconds = f64::from(model.values.ms(route.release)) / 1000.0;
    let approach = names(&mut route.approach.iter().copied());
    [
        route.name.clone(),
        route.signal.clone(),
        locking.join(" "),
        names(&mut route.circuits().chain(clear).chain(route.beside())),
        over.into_iter().map(point).collect::<Vec<_>>().join(" "),
        names(&mut route.circuits()),
        format!("{approach} {seconds}秒"),
    ]
}

/// Every cell in which a table in these columns differs from the layout: `one` is the layout, `other` the table. In a cell with several
/// entries their order is of no matter, but in those of circuits along a path.
///
/// # Errors
/// The text is no table with these columns: the line, and what would be right.
pub fn compare(model: &Model, text: &str) -> Result<Vec<Differing>, String> {
    let mut reader =
        csv::ReaderBuilder::new().flexible(true).from_reader(text.trim_start_matches('\u{feff}').as_bytes());
    let heads = reader.headers().map_err(|error| error.to_string())?.clone();
    let unknown = heads.iter().find(|head| !COLUMNS.contains(&head.trim()));
    if let Some(head) = unknown {
        return Err(format!("line 1: the column {head:?} is not known; known are {}", COLUMNS.join(", ")));
    }
    if heads.iter().next().map(str::trim) != Some(COLUMNS[0]) {
        return Err(format!("line 1: the first column is {}", COLUMNS[0]));
    }
    let mine: BTreeMap<String, [String; 7]> =
        model.routes.iter().enumerate().map(|(number, route)| (route.name.clone(), cells(model, number))).collect();
    let mut found = Vec::new();
    let mut seen = BTreeSet::new();
    for row in reader.records() {
        let row = row.map_err(|error| error.to_string())?;
        let name = row.get(0).unwrap_or_default().trim().to_owned();
        let about = format!("route {name}");
        let there = |one: bool| one.then(|| "there".to_owned());
        let whole = "the whole of it".to_owned();
        if !seen.insert(name.clone()) {
            return Err(format!("the route {name} has two rows"));
        }
        let Some(own) = mine.get(&name) else {
            found.push(Differing { about, column: whole, one: None, other: there(true) });
            continue;
        };
        if row.len() > heads.len() {
            return Err(format!("the route {name} has {} cells, and the table has {} columns", row.len(), heads.len()));
        }
        for (at, head) in heads.iter().enumerate() {
            // A cell that is not there is an empty one.
            let cell = row.get(at).unwrap_or_default();
            let place = COLUMNS.iter().position(|column| *column == head.trim()).unwrap_or_default();
            let in_order = [3, 5].contains(&place);
            if !same(&own[place], cell, in_order) {
                let (one, other) = (Some(own[place].clone()), Some(cell.trim().to_owned()));
                found.push(Differing { about: about.clone(), column: head.trim().to_owned(), one, other });
            }
        }
    }
    for column in COLUMNS.iter().filter(|column| !heads.iter().any(|head| head.trim() == **column)) {
        let (about, column) = ("the table".to_owned(), format!("column {column}"));
        found.push(Differing { about, column, one: Some("there".to_owned()), other: None });
    }
    for name in mine.keys().filter(|name| !seen.contains(*name)) {
        let (about, column) = (format!("route {name}"), "the whole of it".to_owned());
        found.push(Differing { about, column, one: Some("there".to_owned()), other: None });
    }
    Ok(found)
}

/// Whether two cells have the same entries. Full-width brackets and spaces are those of half the width.
fn same(one: &str, other: &str, in_order: bool) -> bool {
    let entries = |cell: &str| -> Vec<String> {
        let plain = cell.replace('（', "(").replace('）', ")").replace(['　', '、', ','], " ");
        let mut entries: Vec<String> = plain.split_whitespace().map(str::to_owned).collect();
        if !in_order {
            entries.sort();
        }
        entries
    };
    entries(one) == entries(other)
}
