//! The control table and the drawing say what the layout says.

use atc_layout::conflict::{Reason, reasons};
use atc_layout::model::Model;
use atc_layout::{Description, draw, read, table};
use std::path::Path;

fn description(text: &str) -> Description {
    Description::from_toml("station.toml", text).unwrap()
}

const LOOP: &str = include_str!("../../layouts/passing-loop.toml");
const TERMINUS: &str = include_str!("../../layouts/terminus.toml");

fn between(model: &Model, one: &str, other: &str) -> Vec<Reason> {
    let number = |name: &str| model.routes.iter().position(|route| route.name == name).unwrap();
    let found = reasons(model, number(one), number(other));
    assert_eq!(found, reasons(model, number(other), number(one)), "{one} and {other}");
    found
}

#[test]
fn conflicts_have_their_reasons() {
    let model = description(LOOP).model().unwrap();
    assert_eq!(between(&model, "W-1", "W-2"), [Reason::Circuit, Reason::Point, Reason::Overlap]);
    assert_eq!(between(&model, "W-1", "1-W"), [Reason::Circuit, Reason::Direction]);
    // The route out of track 1 goes on where W-1 ends: its path may run under that overlap.
    assert_eq!(between(&model, "W-1", "1-E"), []);
    assert_eq!(between(&model, "W-1", "2-E"), [Reason::Point, Reason::Overlap]);
    assert_eq!(between(&model, "1-W", "2-E"), []);
    let declared = LOOP.replace("name = \"1-W\"", "name = \"1-W\"\nconflicts = [\"2-E\"]");
    let declared = declared.replace("name = \"2-E\"", "name = \"2-E\"\nconflicts = [\"1-W\"]");
    assert_eq!(between(&description(&declared).model().unwrap(), "1-W", "2-E"), [Reason::Declared]);
    assert_eq!(reasons(&model, 0, 0), []);
}

#[test]
fn the_row_of_a_route() {
    let csv = table::csv(&description(TERMINUS).model().unwrap());
    let rows: Vec<&str> = csv.split("\r\n").collect();
    assert_eq!(rows.len(), 8, "a head, six routes and the end");
    assert!(rows.iter().take(7).all(|row| row.split(',').count() >= table::COLUMNS.len()), "{csv}");
    let row = rows.iter().find(|row| row.starts_with("1-D,")).unwrap();
    let says = [
        "1-D,1,left,1T,P5T P4T P3T P2T,P2 P5,P3 P4,P1,,",
        "out to Departures",
        "P5T: clear after P4T entered; P4T: clear after P3T entered; P3T: clear after P2T entered; P2T: clear with D1 occupied",
        "drive 10 s, release 60 s, stay 30 s",
    ];
    for says in says {
        assert!(row.contains(says), "{says:?} is not in {row}");
    }
}

#[test]
fn a_cell_is_no_formula_and_no_markup() {
    let text = LOOP.replace("\"W-1\"", "\"=W,<b>\"");
    let description = description(&text);
    let model = description.model().unwrap();
    assert!(table::csv(&model).contains("\"'=W,<b>\""));
    let page = table::html("A & B", &model, &draw::svg(&description.station, &model));
    assert!(page.contains("=W,&lt;b&gt;") && !page.contains("<b>") && page.contains("A &amp; B"));
    assert!(!page.contains("<script") && !page.contains("http://") | page.contains("http://www.w3.org/2000/svg"));
}

#[test]
fn the_page_has_a_row_and_a_column_for_everything() {
    let model = description(LOOP).model().unwrap();
    let page = table::html("Loop", &model, "");
    for id in ["routes", "points", "circuits", "conflicts", "derived"] {
        assert!(page.contains(&format!("id=\"{id}\"")), "{id}");
    }
    for (number, route) in model.routes.iter().enumerate() {
        assert_eq!(page.matches(&format!("<th scope=\"row\">{}</th>", route.name)).count(), 4, "route {number}");
    }
}

/// Every circuit, point, signal, segment and platform is named in the drawing, and nothing leaves the sheet.
#[test]
fn the_drawing_names_everything() {
    for text in
        [LOOP, TERMINUS, include_str!("../../layouts/junction.toml"), include_str!("../../layouts/station-30.toml")]
    {
        let description = description(text);
        let model = description.model().unwrap();
        let svg = draw::svg(&description.station, &model);
        let document = roxmltree::Document::parse(&svg).unwrap();
        let texts: Vec<&str> = document
            .descendants()
            .filter(|node| node.has_tag_name(("http://www.w3.org/2000/svg", "text")))
            .filter_map(|node| node.text())
            .collect();
        let circuits = model.circuits.iter().map(|circuit| &circuit.name);
        let points = model.points.iter().map(|point| &point.name);
        let signals = model.routes.iter().map(|route| &route.signal);
        let segments = model.segments.iter().map(|segment| &segment.name);
        let platforms = description.station.platforms.iter().map(|platform| &platform.name);
        for name in circuits.chain(points).chain(signals).chain(segments).chain(platforms) {
            assert!(texts.contains(&name.as_str()), "{name} is not in the drawing of {}", description.station.name);
        }
        let width: i32 = document.root_element().attribute("width").unwrap().parse().unwrap();
        for line in document.descendants().filter_map(|node| node.attribute("points")) {
            for corner in line.split(' ') {
                let x: i32 = corner.split(',').next().unwrap().parse().unwrap();
                assert!((0..width).contains(&x), "{corner}");
            }
        }
    }
}

#[test]
fn the_table_in_japanese_columns_compares_with_itself_and_shows_what_is_changed() {
    let model = description(LOOP).model().unwrap();
    let table = table::rendo::csv(&model);
    let row = table.split("\r\n").find(|row| row.starts_with("W-1,")).unwrap();
    assert_eq!(row, "W-1,W,P1 P2 E-1 1-W,P1T 1T P2T,P1 P2,P1T 1T,W2 W1 60秒");
    assert_eq!(table::rendo::compare(&model, &table), Ok(vec![]));
    // Full-width brackets, another order of entries that have none.
    let other = table.replace("(P1)", "（P1）").replace("P1 P2 E-1 1-W", "E-1、1-W　P2 P1");
    assert_eq!(table::rendo::compare(&model, &other), Ok(vec![]));
    let wrong = table.replacen("P1T 1T,W2 W1", "1T P1T,W2 W1", 1).replacen("60秒", "90秒", 1);
    let found = table::rendo::compare(&model, &wrong).unwrap();
    let told: Vec<String> = found.iter().map(ToString::to_string).collect();
    assert_eq!(told, ["route W-1: 進路区分鎖錠: P1T 1T | 1T P1T", "route W-1: 接近鎖錠: W2 W1 60秒 | W2 W1 90秒"]);
    let missing = table.split_inclusive("\r\n").filter(|row| !row.starts_with("W-1,")).collect::<String>();
    assert_eq!(table::rendo::compare(&model, &missing).unwrap().len(), 1);
    // What the table does not have it does not confirm.
    let names: Vec<&str> = table.split_terminator("\r\n").map(|row| row.split(',').next().unwrap()).collect();
    let names = names.join("\r\n");
    let found = table::rendo::compare(&model, &names).unwrap();
    assert_eq!(found.len(), 6, "{found:?}");
    assert_eq!(found[0].to_string(), "the table: column 信号機: there | not there");
    let short = table.replace(row, "W-1,W");
    let found = table::rendo::compare(&model, &short).unwrap();
    assert_eq!(found.len(), 5, "{found:?}");
    assert_eq!(found[1].to_string(), "route W-1: 信号制御: P1T 1T P2T | nothing");
    assert!(table::rendo::compare(&model, &table.replace(row, &format!("{row},x"))).unwrap_err().contains("8 cells"));
    assert!(table::rendo::compare(&model, "進路,色\r\n").unwrap_err().contains("the column \"色\" is not known"));
}

/// The labels of a drawing, each with what it covers: its text, left, top, right and bottom.
fn labels(svg: &str) -> Vec<(String, [f64; 4])> {
    let page = roxmltree::Document::parse(svg).expect("an SVG");
    let number =
        |node: &roxmltree::Node<'_, '_>, name| node.attribute(name).expect("a place").parse::<f64>().expect(name);
    let label = |node: roxmltree::Node<'_, '_>| {
        let class = node.attribute("class").filter(|class| *class != "title")?;
        let text = node.text().unwrap_or_default().to_owned();
        // Half a letter narrower than drawn, so that it is not the drawing's own measure.
        let size = if class == "circuit" { 12.0 } else { 10.0 };
        let width = size * (0.55 * f64::from(u32::try_from(text.chars().count()).expect("short")) - 0.5);
        let (x, y) = (number(&node, "x"), number(&node, "y"));
        Some((text, [x - width / 2.0, y - size * 0.75, x + width / 2.0, y]))
    };
    page.descendants().filter(|node| node.has_tag_name("text")).filter_map(label).collect()
}

#[test]
fn no_label_stands_on_another() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR"));
    let files = ["../layouts/passing-loop.toml", "../layouts/junction.toml", "../layouts/terminus.toml"];
    let files = files.iter().chain(&["../layouts/station-30.toml", "../layouts/station-100.toml"]);
    let mut stations: Vec<_> = files
        .chain(&["tests/files/scissors.toml", "tests/files/crossover.toml", "tests/files/diamond.toml"])
        .map(|file| read(folder.join(file)).unwrap_or_else(|errors| panic!("{file}: {errors}")))
        .collect();
    // Names as an import makes them of borders: longer than their tracks.
    let mut long = stations[1].clone();
    let text = long.to_toml();
    let names: Vec<String> = long.station.circuits.iter().map(|circuit| circuit.name.value.clone()).collect();
    let text = names
        .iter()
        .fold(text, |text, name| text.replace(&format!("\"{name}\""), &format!("\"Buf04+Joint06+{name}\"")));
    long = Description::from_toml("long.toml", &text).expect("only names differ");
    stations.push(long);
    for description in stations {
        let svg = draw::svg(&description.station, &description.tracks().expect("tracks"));
        let labels = labels(&svg);
        assert!(labels.len() > 3, "{}: {}", description.station.name, labels.len());
        for (number, (text, at)) in labels.iter().enumerate() {
            for (other, its) in &labels[..number] {
                let apart = at[0] >= its[2] || its[0] >= at[2] || at[1] >= its[3] || its[1] >= at[3];
                assert!(apart, "{}: {text} stands on {other}: {at:?} and {its:?}", description.station.name);
            }
        }
    }
}
