//! A calibration in words, and its table in the forms that a line's file and a session take.

use std::fmt::Write as _;
use std::path::Path;

use atc_line::position::Config;
use atc_protocol::Decibels;
use serde::Serialize;

use super::report::{Report, ResidualReport};

/// The report in words.
pub(super) fn words(report: &Report) -> String {
    let mut text = String::new();
    let Report { file, measurements, residuals, range_m: [from, to], .. } = report;
    let count = report.passes.len();
    let _ = writeln!(text, "{file}: {measurements} measurements in {count} {}\n", plural(count, "pass", "passes"));
    let _ = writeln!(text, "   used   from m     to m   RMS dB  largest dB    at m   line  pass");
    let row = |text: &mut String, one: &ResidualReport, range: Option<[f64; 2]>, name: &str| {
        let [from, to] = range.map_or([String::new(), String::new()], |ends| ends.map(|end| format!("{end:.1}")));
        let _ = writeln!(
            text,
            "{:7} {from:>8} {to:>8} {:8.3} {:+11.2} {:7.1} {:6}  {name}",
            one.used, one.rms_db, one.largest_db, one.at_m, one.line
        );
    };
    for pass in &report.passes {
        row(&mut text, &pass.residuals, Some(pass.range_m), &pass.name);
    }
    row(&mut text, residuals, None, "all");
    let [first, last] = report.knots_covered;
    let _ = writeln!(
        text,
        "\ntable: knots {first} to {last} of 0 to 16, {} m apart, are measured: it covers {from} to {to} m\n\
         tolerance of a level: {} dB; floor: {} dB",
        report.spacing_m, report.position.tolerance_db, report.position.floor_db
    );
    let end = if report.ends_with_section {
        format!("beyond {to} m is no train: an interval ends at the first knot there")
    } else {
        format!("a train that may be beyond {to} m is unknown; --section-m ends the table there if no train can be")
    };
    let start = if first > 0 { format!("a train nearer than {from} m is unknown; ") } else { String::new() };
    let _ = writeln!(text, "ends: {start}{end}");
    let _ = writeln!(
        text,
        "\nThe kernel on this table where the difference rises otherwise than measured, errors as these residuals:\n   \
         rise   answered  near end beyond the train   far end before it   mean width"
    );
    for side in &report.rails_otherwise {
        let _ = writeln!(
            text,
            "{:+6} % {:4} of {:4} {:6} {:>14} {:10} {:>14} {:10.1} m",
            side.rise_percent,
            side.answered,
            side.asked,
            side.beyond,
            reach(side.beyond, side.beyond_most_m),
            side.before,
            reach(side.before, side.before_most_m),
            side.mean_width_m
        );
    }
    let _ = writeln!(text, "\n{}\n", report.dangerous);
    for note in &report.to_look_at {
        let _ = writeln!(text, "to look at: {note}");
    }
    for condition in &report.not_checked {
        let _ = writeln!(text, "NOT CHECKED: {} [{}]", condition.what, condition.id);
    }
    text
}

fn reach(count: u32, most: f64) -> String {
    if count == 0 { String::new() } else { format!("up to {most:.1} m") }
}

fn plural<'a>(count: usize, one: &'a str, more: &'a str) -> &'a str {
    if count == 1 { one } else { more }
}

/// The table of a line's file.
pub(super) fn toml(report: &Report) -> String {
    let Config { table, tolerance_db, floor_db, .. } = &report.position;
    let list = |levels: &[Decibels]| levels.iter().map(Decibels::to_string).collect::<Vec<_>>().join(", ");
    let mut text = format!(
        "# From {} measurements in {}: oracle position calibrate.\n",
        report.measurements,
        Path::new(&report.file).file_name().map_or_else(|| "-".into(), |name| name.to_string_lossy())
    );
    for condition in &report.not_checked {
        let _ = writeln!(text, "# Not checked: {} [{}]", condition.what.replace('\n', " "), condition.id);
    }
    let _ = writeln!(
        text,
        "[position]\nspacing_m = {}\nlowest_db = [{}]\nhighest_db = [{}]\ntolerance_db = {tolerance_db}\nfloor_db = {floor_db}",
        table.spacing_m,
        list(&table.lowest_db),
        list(&table.highest_db)
    );
    text
}

pub(super) fn json(value: &impl Serialize) -> String {
    serde_json::to_string_pretty(value).map_or_else(|error| error.to_string(), |text| text + "\n")
}
