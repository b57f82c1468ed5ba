//! The control table as a page that needs nothing but itself.

use std::fmt::Write as _;

use super::row::{COLUMNS, Row};
use crate::conflict::{Reason, reasons};
use crate::derive::positions::opposite;
use crate::form::Position;
use crate::model::Model;

const STYLE: &str = "
body{font:14px/1.4 system-ui,sans-serif;margin:1.5rem;color:#111;background:#fff}
h1{font-size:1.5rem;margin:0 0 .3rem}h2{font-size:1.1rem;margin:1.6rem 0 .4rem}
p{max-width:60rem;margin:.3rem 0}
.wide{overflow-x:auto}
table{border-collapse:collapse;font-size:12px}
th,td{border:1px solid #999;padding:2px 5px;vertical-align:top;text-align:left}
thead th{background:#e8eef4;position:sticky;top:0}
tbody th{background:#f4f6f8;white-space:nowrap;position:sticky;left:0}
#routes .conflicts,#routes .releases{min-width:15rem}#routes .path,#routes .overlap,#routes .approach,#routes .times{min-width:7rem}
.plan{max-width:100%;height:auto}
.matrix td{text-align:center;min-width:1.3rem;padding:1px 3px}
.matrix thead th{writing-mode:vertical-rl;transform:rotate(180deg);white-space:nowrap;padding:4px 1px}
.matrix thead th:first-child{writing-mode:horizontal-tb;transform:none}
.matrix .self{background:#ccc}.matrix .on{background:#dce9f7}.matrix .reverse{background:#fbe3c4}.matrix .flank{color:#555;font-style:italic}
@media print{body{margin:0;font-size:9pt}table{font-size:7pt}.wide{overflow:visible}thead th,tbody th{position:static}
tr{break-inside:avoid}h2{break-after:avoid}@page{size:A3 landscape;margin:10mm}}
";

/// The control table as HTML: a row for each route, then routes against points, circuits and routes. `drawing` is an SVG that stands
/// above the tables; empty for none.
pub fn html(station: &str, model: &Model, drawing: &str) -> String {
    let mut page = String::new();
    let title = escape(station);
    let _ = write!(
        page,
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<title>Control table: {title}</title>\n<style>{STYLE}</style>\n</head>\n<body>\n<h1>Control table: {title}</h1>\n"
    );
    let _ = writeln!(
        page,
        "<p>{} routes, {} points, {} track circuits, {} segments of plain line. A circuit counts as clear after {} cycles of {} ms.</p>",
        model.routes.len(),
        model.points.len(),
        model.circuits.len(),
        model.segments.len(),
        model.values.clear,
        model.values.cycle_ms
    );
    page.push_str(drawing);
    routes(&mut page, model);
    points(&mut page, model);
    circuits(&mut page, model);
    conflicts(&mut page, model);
    notes(&mut page, model);
    page.push_str("</body>\n</html>\n");
    page
}

fn routes(page: &mut String, model: &Model) {
    page.push_str("<h2>Routes</h2>\n<div class=\"wide\"><table id=\"routes\">\n<thead><tr>");
    for column in COLUMNS {
        let _ = write!(page, "<th scope=\"col\">{column}</th>");
    }
    page.push_str("</tr></thead>\n<tbody>\n");
    for number in 0..model.routes.len() {
        page.push_str("<tr>");
        for (column, cell) in COLUMNS.iter().zip(Row::of(model, number).cells()) {
            let cell = escape(&cell).replace("; ", ";<br>");
            if *column == "route" {
                let _ = write!(page, "<th scope=\"row\">{cell}</th>");
            } else {
                let _ = write!(page, "<td class=\"{}\">{cell}</td>", column.replace([' ', '/'], "-"));
            }
        }
        page.push_str("</tr>\n");
    }
    page.push_str("</tbody>\n</table></div>\n");
}

/// Writes a table of routes against `heads`.
fn matrix(
    page: &mut String,
    model: &Model,
    (id, title, key): (&str, &str, &str),
    heads: &[&str],
    cell: &dyn Fn(usize, usize) -> (String, &'static str),
) {
    let _ = write!(
        page,
        "<h2>{title}</h2>\n<p>{key}</p>\n<div class=\"wide\"><table class=\"matrix\" id=\"{id}\">\n<thead><tr><th>route</th>"
    );
    for head in heads {
        let _ = write!(page, "<th scope=\"col\">{}</th>", escape(head));
    }
    page.push_str("</tr></thead>\n<tbody>\n");
    for (number, route) in model.routes.iter().enumerate() {
        let _ = write!(page, "<tr><th scope=\"row\">{}</th>", escape(&route.name));
        for column in 0..heads.len() {
            let (text, class) = cell(number, column);
            let _ = if class.is_empty() {
                write!(page, "<td>{text}</td>")
            } else {
                write!(page, "<td class=\"{class}\">{text}</td>")
            };
        }
        page.push_str("</tr>\n");
    }
    page.push_str("</tbody>\n</table></div>\n");
}

fn points(page: &mut String, model: &Model) {
    let heads: Vec<&str> = model.points.iter().map(|point| point.name.as_str()).collect();
    let key = "N and R: run over in the normal or reverse position. n and r: held so for flank protection or detection. oN and oR: in the overlap.";
    matrix(page, model, ("points", "Routes and points", key), &heads, &|route, point| {
        let route = &model.routes[route];
        let run_over = route.path.iter().flat_map(|place| &place.passed).find(|passed| passed.point == point);
        if let Some(passed) = run_over {
            return if passed.position == Position::Normal { ("N".into(), "on") } else { ("R".into(), "reverse") };
        }
        let held = |position| route.path.iter().any(|place| place.positions.get(&point) == Some(&position));
        for (position, letter) in [(Position::Normal, "n"), (Position::Reverse, "r")] {
            if held(position) {
                return (letter.into(), "flank");
            }
        }
        match route.overlap_positions.get(&point) {
            Some(position) if opposite(*position) == Position::Reverse => ("oN".into(), "flank"),
            Some(_) => ("oR".into(), "flank"),
            None => (String::new(), ""),
        }
    });
}

fn circuits(page: &mut String, model: &Model) {
    let heads: Vec<&str> = model.circuits.iter().map(|circuit| circuit.name.as_str()).collect();
    let key = "A number: the place in the path. E: entry. a: approach. o: overlap. f: beside, proved clear. b: beyond the end.";
    matrix(page, model, ("circuits", "Routes and track circuits", key), &heads, &|route, circuit| {
        let route = &model.routes[route];
        if let Some(place) = route.circuits().position(|held| held == circuit) {
            return ((place + 1).to_string(), "on");
        }
        let letters = [
            (circuit == route.entry, "E"),
            (route.overlap.contains(&circuit), "o"),
            (route.approach.contains(&circuit) && circuit != route.entry, "a"),
            (route.beside().contains(&circuit), "f"),
            (route.beyond.contains(&circuit), "b"),
        ];
        let text: String = letters.into_iter().filter_map(|(holds, letter)| holds.then_some(letter)).collect();
        (text, if route.overlap.contains(&circuit) { "reverse" } else { "" })
    });
}

fn conflicts(page: &mut String, model: &Model) {
    let heads: Vec<&str> = model.routes.iter().map(|route| route.name.as_str()).collect();
    let all = [
        Reason::Circuit,
        Reason::Point,
        Reason::Overlap,
        Reason::Beside,
        Reason::Berth,
        Reason::Start,
        Reason::Declared,
        Reason::Direction,
    ];
    let key = all.map(|reason| format!("{}: {}", reason.letter(), reason.word())).join(", ");
    matrix(page, model, ("conflicts", "Routes and routes", &key), &heads, &|one, other| {
        let letters: String = reasons(model, one, other).into_iter().map(Reason::letter).collect();
        let class = if one == other {
            "self"
        } else if letters.is_empty() {
            ""
        } else {
            "on"
        };
        (letters, class)
    });
}

fn notes(page: &mut String, model: &Model) {
    page.push_str("<h2>Derived</h2>\n<p>What the file leaves out, and what was taken for it.</p>\n<div class=\"wide\"><table id=\"derived\">\n<tbody>\n");
    for note in &model.notes {
        let _ =
            writeln!(page, "<tr><th scope=\"row\">{}</th><td>{}</td></tr>", escape(&note.about), escape(&note.text));
    }
    page.push_str("</tbody>\n</table></div>\n");
}

/// Text as HTML.
pub fn escape(text: &str) -> String {
    let mut safe = String::with_capacity(text.len());
    for letter in text.chars() {
        match letter {
            '&' => safe.push_str("&amp;"),
            '<' => safe.push_str("&lt;"),
            '>' => safe.push_str("&gt;"),
            '"' => safe.push_str("&quot;"),
            _ => safe.push(letter),
        }
    }
    safe
}
