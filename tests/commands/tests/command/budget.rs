//! `oracle signal budget`: the figures, the picture, and the section whose margin is too small.

use std::fs;
use std::path::Path;
use std::process::{Command, Output, Stdio};

use atc_tests::device;
use serde_json::{Value, json};

const LINE: &str = include_str!("../../../../evidence/examples/my-line.toml");

/// A file with this `[budget]`, and what the command says of it.
fn budget(table: &str, arguments: &[&str]) -> (tempfile::TempDir, Output) {
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join("line.toml"), format!("{LINE}\n{table}")).expect("written");
    let output = run(folder.path(), &[&["signal", "budget", "line.toml"], arguments].concat());
    (folder, output)
}

fn run(folder: &Path, arguments: &[&str]) -> Output {
    let mut command = Command::new(device::oracle());
    command.args(arguments).current_dir(folder).stdin(Stdio::null()).output().expect("the oracle runs")
}

fn text(bytes: &[u8]) -> &str {
    std::str::from_utf8(bytes).expect("UTF-8")
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value} is no number"))
}

/// Every figure of the example: 300 m of wet rail, theory beside measurement, what the modulation costs, and the
/// decoder's latency, for which `delay_ms` has room.
#[test]
fn the_example_has_margins() {
    let (folder, output) = budget("", &["--svg", "budget.svg", "--json"]);
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    let report: Value = serde_json::from_str(text(&output.stdout)).expect("JSON");
    assert_eq!((&report["longest"], &report["longest_m"]), (&json!("section 2"), &json!(300.0)));
    assert!((number(&report["bit_rate_hz"]) - 200.0).abs() < 1e-9);
    for (link, hertz) in report["links"].as_array().expect("two").iter().zip([750.0, 1200.0]) {
        assert!((number(&link["carrier_hz"]) - hertz).abs() < 1e-9);
        let sum = number(&link["transmitted_db"]) - number(&link["rail_db"]) + number(&link["code_power_db"])
            - number(&link["noise_density_db"])
            - 10.0 * 200.0_f64.log10();
        assert!((sum - number(&link["eb_n0_db"])).abs() < 1e-9, "{link}");
        // 14 dB in a wet kilometre at 1200 Hz.
        assert!((0.5..5.0).contains(&number(&link["rail_db"])), "{link}");
        // About 8 dB, as an outsider measured.
        assert!((6.5..9.5).contains(&number(&link["code_costs_db"])), "{link}");
        assert!((0.0..1.0).contains(&number(&link["receiver_loss_db"])), "{link}");
        let margin = number(&link["eb_n0_db"]) - number(&link["needed_db"]);
        assert!((margin - number(&link["telegram_margin_db"])).abs() < 1e-9, "{link}");
    }
    // What is needed is enough: one in a hundred may be lost, and 120 are measured.
    let at = &report["at_needed"];
    assert!(number(&at["heard"]) >= 114.0 && at["wrong"] == json!(0), "{at}");
    let offset = number(&report["offset_heard_hz"]);
    assert!((1.5..2.0).contains(&offset), "{}", report["offsets"]);
    assert!(number(&report["codes_needed_db"]) < number(&report["links"][0]["needed_db"]));
    // The receiver's latency, against what the line's file says.
    let late = number(&report["latency_ms"]);
    assert!((108.0..113.0).contains(&late) && late <= number(&report["delay_ms"]), "{late} ms, {}", report["delay_ms"]);
    let parameters = report["parameters"].as_array().expect("a list");
    assert!(parameters.len() == 12 && parameters.iter().all(|one| one["given"] == json!(false)));
    let svg = fs::read_to_string(folder.path().join("budget.svg")).expect("a picture");
    for label in ["main carrier, 750 Hz", "sub carrier, 1200 Hz", "telegrams need", "codes need", "Telegrams lost"] {
        assert!(svg.contains(label), "{label}");
    }
}

/// A louder noise, a longer section, a carrier that is too far off and a delay that is too short are told, each with
/// its place.
#[test]
fn what_is_not_enough_is_named() {
    let (folder, output) = budget("[budget]\nnoise_db = 51.5\nwet_ohm_km = 1.0\ncarrier_offset_hz = 2.5\n", &[]);
    let (said, wrong) = (text(&output.stdout), text(&output.stderr));
    assert_eq!(output.status.code(), Some(1), "{said}{wrong}");
    assert!(said.contains("link budget at the far end of section 2 (300 m), the longest of 7"), "{said}");
    assert!(said.contains("noise_db               51.5 dB    file") && said.contains("DEFAULT"), "{said}");
    assert!(wrong.contains("line.toml: section 2 (300 m): at its far end the margin is "), "{wrong}");
    assert!(wrong.contains("each must be 6 dB or more"), "{wrong}");
    assert!(wrong.contains("budget.carrier_offset_hz is 2.5 Hz, and telegrams are heard up to 1."), "{wrong}");
    assert!(!wrong.contains("delay_ms"), "{wrong}");
    let short = fs::read_to_string(folder.path().join("line.toml")).expect("there");
    fs::write(folder.path().join("line.toml"), short.replace("delay_ms = 120", "delay_ms = 100")).expect("written");
    let output = run(folder.path(), &["signal", "budget", "line.toml"]);
    let wrong = text(&output.stderr);
    assert!(wrong.contains("signal.delay_ms is 100, and the receiver alone takes 11"), "{wrong}");
}

#[test]
fn what_is_no_budget_is_refused() {
    for (table, code, message) in [
        ("[budget]\ndepth = 1.5", 1, "line.toml:", "depth is 1.5; it must be 0 to 1"),
        ("[budget]\nnoise_db = nan", 1, "line.toml:", "noise_db is NaN; it must be -200 to 200"),
        ("[budget]\nnoise = 3", 2, "line.toml:", "unknown field `noise`, expected one of main_db, sub_db"),
        ("[budget]\nnoise_db = \"loud\"", 2, "line.toml:", "invalid type"),
        ("[budget]\nmain_carrier_hz = 1100", 1, "oracle: line.toml:", "the carriers are 100 Hz apart"),
        ("[budget]\ndepth = 0.1", 1, "oracle: line.toml:", "codes are not heard at all at 30 dB"),
    ]
    .map(|(table, code, start, message)| (table, code, [start, message]))
    {
        let (folder, output) = budget(table, &["--svg", "budget.svg"]);
        let said = text(&output.stderr);
        assert_eq!(output.status.code(), Some(code), "{table}: {said}");
        assert!(said.starts_with(message[0]) && said.contains(message[1]), "{table} was answered by {said}");
        assert!(output.stdout.is_empty() && !folder.path().join("budget.svg").exists());
    }
}
