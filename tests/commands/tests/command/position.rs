//! `oracle position calibrate`: levels of the rail model are measured, fitted, and the oracle's position machine finds
//! trains with the table; and every file that makes no table is named with its line.

use std::fmt::Write as _;
use std::fs;
use std::io::Write as _;
use std::path::Path;
use std::process::{Command, Output, Stdio};

use atc_tests::device;
use atc_waveform::rail::{Hertz, Line, Metres, OhmKilometres, Rails};
use serde_json::{Value, json};

fn oracle(folder: &Path, arguments: &[&str]) -> Output {
    let output = Command::new(device::oracle()).args(arguments).current_dir(folder).stdin(Stdio::null()).output();
    output.expect("the oracle runs")
}

fn text(bytes: &[u8]) -> &str {
    std::str::from_utf8(bytes).expect("UTF-8")
}

/// Errors, evenly within ±1: the numbers of a linear congruential generator (D. E. Knuth's MMIX).
struct Draws(u64);

impl Draws {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        #[expect(clippy::cast_precision_loss, reason = "53 bits")]
        let part = (self.0 >> 11) as f64 / (1_u64 << 53) as f64;
        2.0 * part - 1.0
    }
}

/// Both levels at a place, off by up to `off` dB each, as they are displayed: in hundredths.
fn levels(ohm_km: f64, metres: f64, off: f64, draws: &mut Draws) -> [f64; 2] {
    let line = Line::new(Rails::default(), OhmKilometres(ohm_km)).expect("a usual track");
    [1000.0, 3000.0].map(|frequency| {
        let level = 60.0 - line.attenuation(Hertz(frequency), Metres(metres)).0 + off * draws.next();
        (level * 100.0).round() / 100.0
    })
}

/// Three passes over 400 m, every 5 m.
fn measured(off: f64) -> String {
    let mut draws = Draws(11);
    let mut file = "weather,ballast_ohm_km,distance_m,first_db,second_db\n".to_owned();
    for (weather, ohm_km) in [("wet", 2.0), ("usual", 9.0), ("dry", 50.0)] {
        for place in 0..=80 {
            let metres = f64::from(place) * 5.0;
            let [first, second] = levels(ohm_km, metres, off, &mut draws);
            let _ = writeln!(file, "{weather},{ohm_km},{metres},{first},{second}");
        }
    }
    file
}

fn folder(file: &str) -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join("levels.csv"), file).expect("a file");
    folder
}

/// What the position machine says of each pair of levels, by `oracle serve`.
fn positions(config: &Value, steps: &[[f64; 2]]) -> Vec<Option<[f64; 2]>> {
    // A session for each: what an odometer knows of the one before plays no part.
    let start = json!({"start": {"protocol": 1, "machine": "train-position", "config": config}});
    let mut input = String::new();
    for [first, second] in steps {
        let step = json!({"first_db": first, "second_db": second, "moved_m": [0, 0]});
        let _ = writeln!(input, "{start}\n{}\n{}", json!({ "step": step }), json!({"stop": {}}));
    }
    let mut command = Command::new(device::oracle());
    let mut child = command.arg("serve").stdin(Stdio::piped()).stdout(Stdio::piped()).spawn().expect("the oracle runs");
    let mut stdin = child.stdin.take().expect("a pipe");
    let writer = std::thread::spawn(move || stdin.write_all(input.as_bytes()));
    let output = child.wait_with_output().expect("it ends");
    writer.join().expect("no panic").expect("written");
    let replies: Vec<Value> =
        text(&output.stdout).lines().map(|line| serde_json::from_str(line).expect("JSON")).collect();
    assert!(replies[0].get("started").is_some(), "{}", replies[0]);
    let interval = |reply: &Value| {
        let ends = reply["output"].get("interval_m").unwrap_or_else(|| panic!("{reply}"));
        ends.as_array().map(|ends| [0, 1].map(|end| ends[end].as_f64().expect("a number")))
    };
    replies.iter().skip(1).step_by(3).map(interval).collect()
}

/// From the rail model over the CSV and the table to the machine: with other draws, at other places and in other
/// weather between the measured one, every interval has the train in it; in weather wetter than measured its near end
/// is beyond the train.
#[test]
fn from_levels_to_positions() {
    let folder = folder(&measured(0.03));
    for arguments in [&["--section-m", "400"][..], &[]] {
        let all = [&["position", "calibrate", "levels.csv", "-o", "table.json"], arguments].concat();
        let output = oracle(folder.path(), &all);
        assert!(output.status.success() && output.stderr.is_empty(), "{}", text(&output.stderr));
        let config: Value =
            serde_json::from_str(&fs::read_to_string(folder.path().join("table.json")).expect("there")).expect("JSON");
        let mut draws = Draws(99);
        let (mut truths, mut steps) = (Vec::new(), Vec::new());
        for ohm_km in [2.0, 2.7, 4.0, 9.0, 20.0, 50.0] {
            for place in 0..200 {
                let metres = 0.7 + f64::from(place) * 1.99;
                truths.push((ohm_km, metres));
                steps.push(levels(ohm_km, metres, 0.03, &mut draws));
            }
        }
        let found = positions(&config, &steps);
        let mut answered = 0;
        for ((ohm_km, metres), interval) in truths.iter().zip(&found) {
            let Some([near, far]) = interval else { continue };
            answered += 1;
            assert!((*near..=*far).contains(metres), "{ohm_km} Ω·km, {metres} m is not in {near} to {far} m");
            // With --section-m no interval is longer than the section and its last span.
            assert!(arguments.is_empty() || *far <= 461.0, "{far}");
        }
        assert!(answered > if arguments.is_empty() { 200 } else { 1190 }, "{answered} of {}", found.len());
        if arguments.is_empty() {
            continue;
        }
        // Wetter than it was measured.
        let wetter: Vec<_> = (1..200).map(|place| levels(1.0, f64::from(place), 0.0, &mut draws)).collect();
        let found = positions(&config, &wetter);
        let beyond = (1..200)
            .zip(&found)
            .filter(|(metres, interval)| interval.is_some_and(|[near, _]| near > f64::from(*metres)));
        let answered = found.iter().flatten().count();
        assert!(beyond.count() * 2 > answered, "of {answered}");
    }
}

/// The table is a part of a line's file, and the report says what it covers, which side is dangerous, and what nobody
/// checked.
#[test]
fn the_report_and_the_files() {
    let folder = folder(&measured(0.03));
    let arguments =
        ["position", "calibrate", "levels.csv", "--section-m", "400", "-o", "table.toml", "--svg", "table.svg"];
    let output = oracle(folder.path(), &arguments);
    let said = text(&output.stdout);
    for part in [
        "levels.csv: 243 measurements in 3 passes",
        "wet, 2 Ω·km",
        "it covers 0 to 400 m",
        "beyond 400 m is no train",
        "Dangerous: rails that lose more than the table says",
        "the near end is beyond the train",
        "NOT CHECKED: that no weather is wetter or drier than the measured one",
        "[calibration-covers-the-weather]",
        "[levels-of-one-section]",
    ] {
        assert!(said.contains(part), "{part} is not in\n{said}");
    }
    let svg = fs::read_to_string(folder.path().join("table.svg")).expect("a picture");
    assert!(svg.starts_with("<svg") && svg.matches("<circle").count() > 2 * 243, "measurements and residuals");
    let table = fs::read_to_string(folder.path().join("table.toml")).expect("a table");
    assert!(table.contains("[calibration-covers-the-weather]"));
    // In the place of the example's own.
    let line = include_str!("../../../../evidence/examples/my-line.toml");
    let (before, after) = line.split_once("[position]").expect("it has one");
    let rest = after.split_once("# A line with stations").expect("and something behind it").1;
    fs::write(folder.path().join("line.toml"), format!("{before}{table}# {rest}")).expect("written");
    let output = oracle(folder.path(), &["line", "check", "line.toml", "--derived"]);
    assert!(output.status.success(), "{}", text(&output.stderr));
    assert!(text(&output.stdout).contains("The attenuation table reaches: 819.2 m"), "{}", text(&output.stdout));
    // As JSON, the same.
    let output = oracle(folder.path(), &["position", "calibrate", "levels.csv", "--section-m", "400", "--json"]);
    let report: Value = serde_json::from_str(text(&output.stdout)).expect("JSON");
    assert_eq!(report["measurements"], json!(243));
    assert_eq!(report["range_m"], json!([0.0, 400.0]));
    assert_eq!(report["passes"][2]["name"], json!("dry, 50 Ω·km"));
    assert_eq!(report["not_checked"][0]["id"], json!("calibration-covers-the-weather"));
    let at = |percent: f64| {
        let all = report["rails_otherwise"].as_array().expect("a list");
        all.iter().find(|one| one["rise_percent"] == json!(percent)).expect("there").clone()
    };
    assert!(at(50.0)["beyond"].as_u64() > Some(100) && at(50.0)["before"] == json!(0), "{}", at(50.0));
    assert_eq!((&at(0.0)["beyond"], &at(0.0)["before"]), (&json!(0), &json!(0)));
}

/// Kilometres, other separators, a byte order mark, remarks, empty lines, differences in the place of levels.
#[test]
fn forms_of_a_file() {
    let plain = folder(&measured(0.03));
    let arguments = ["position", "calibrate", "levels.csv", "--section-m", "400", "-o", "table.json"];
    assert!(oracle(plain.path(), &arguments).status.success());
    let expected = fs::read_to_string(plain.path().join("table.json")).expect("a table");
    let mut file = "\u{feff}# own line\nWeather;Ballast (Ω·km);Distance [km];First (dB);Second (dB)\n\n".to_owned();
    for row in measured(0.03).lines().skip(1) {
        let cells: Vec<&str> = row.split(',').collect();
        let km = cells[2].parse::<f64>().expect("a number") / 1000.0;
        let _ = writeln!(file, "{}; {} ;{km};{};{}", cells[0], cells[1], cells[3], cells[4]);
    }
    let other = folder(&file);
    let output = oracle(other.path(), &arguments);
    assert!(output.status.success(), "{}", text(&output.stderr));
    assert_eq!(fs::read_to_string(other.path().join("table.json")).expect("a table"), expected);
    let mut file = "date,distance_m,difference_db\n".to_owned();
    for metres in 0..100 {
        let _ = writeln!(file, "2026-03-01,{},{:.2}", metres * 4, f64::from(metres) * 0.04);
    }
    let differences = folder(&file);
    let output = oracle(differences.path(), &["position", "calibrate", "levels.csv"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(text(&output.stderr).contains("--floor-db must say which level is noise"), "{}", text(&output.stderr));
    let output = oracle(differences.path(), &["position", "calibrate", "levels.csv", "--floor-db", "-60"]);
    assert!(text(&output.stdout).contains("there is one pass: the table holds for its weather alone"));
}

#[test]
fn what_makes_no_table_is_named_with_its_place() {
    let good = measured(0.03);
    let row = |from: usize, to: &str| {
        let mut lines: Vec<&str> = good.lines().collect();
        lines[from - 1] = to;
        lines.join("\n")
    };
    let without = |from: f64, to: f64| {
        let far = |line: &&str| {
            line.split(',').nth(2).and_then(|cell| cell.parse::<f64>().ok()).is_none_or(|x| x < from || x > to)
        };
        good.lines().filter(far).collect::<Vec<_>>().join("\n")
    };
    let every = |step: f64| {
        let on = |line: &&str| {
            line.split(',').nth(2).and_then(|cell| cell.parse::<f64>().ok()).is_none_or(|x| (x % step).abs() < 1e-9)
        };
        good.lines().filter(on).collect::<Vec<_>>().join("\n")
    };
    let swapped = good.replacen("first_db,second_db", "second_db,first_db", 1);
    let cases = [
        (String::new(), "levels.csv: is empty; the first line must name the columns: distance_m or distance_km"),
        (
            good.replacen("distance_m", "distance", 1),
            "levels.csv:1: column 3 (distance): the unit is missing; the head must be distance_m or distance_km",
        ),
        (
            good.replacen("second_db", "second", 1),
            "levels.csv:1: column 5 (second): the unit is missing; the head must be second_db",
        ),
        (
            good.replacen("second_db", "first_db", 1),
            "levels.csv:1: column 5 (first_db): column 4 is the same; each must be there once",
        ),
        (good.replacen("weather", "Distance (km)", 1), "levels.csv:1: column 3 (distance_m): column 1 is the same"),
        (
            good.replacen("weather", "whether", 1),
            "levels.csv:1: column 1 (whether): is no column of this form; there are distance_m",
        ),
        (
            good.replacen("second_db", "difference_db", 1),
            "levels.csv:1: the columns must be first_db and second_db, or difference_db alone",
        ),
        (
            good.replacen("distance_m", "date", 1),
            "levels.csv:1: there is no distance; a column distance_m or distance_km is needed",
        ),
        (
            row(7, "wet,2,25,NaN,59.0"),
            "levels.csv:7: column 4 (first_db): is NaN; it must be a number from -300 to 300",
        ),
        (row(7, "wet,2,25,59.5,"), "levels.csv:7: column 5 (second_db): is empty; it must be a number"),
        (
            row(7, "wet,2,25,\"59,5\",59"),
            "levels.csv:7: column 4 (first_db): is \"59,5\"; it must be a number from -300",
        ),
        (row(7, "wet,2,25,59,5,59"), "levels.csv:7: has 6 columns; it must have 5, as the head; a decimal point"),
        (
            row(7, "wet,2,-25,59.5,59"),
            "levels.csv:7: column 3 (distance_m): is -25; it must be a number from 0 to 10000: distances are counted",
        ),
        (row(7, "wet,0,25,59.5,59"), "levels.csv:7: column 2 (ballast_ohm_km): is 0; it must be a number from 0.1"),
        (row(7, "wet,2,25,59.5,inf"), "levels.csv:7: column 5 (second_db): is inf; it must be"),
        (swapped, "column 5 (first_db): pass wet, 2 Ω·km: from "),
        (without(150.0, 240.0), "pass wet, 2 Ω·km: a gap: from 153.6 to 204.8 m there is nothing measured"),
        (without(0.0, 60.0), "what every pass covers, 65 to 400 m"),
        (without(60.0, 390.0), "a gap: from 51.2 to 102.4 m there is one distance measured"),
        (without(390.0, 401.0), "the measurements end at 385 m, and the section at 400 m; they must reach its far end"),
        (
            every(25.0),
            "pass wet, 2 Ω·km: 17 measurements within the table; with 51.2 m between its knots 18 are needed",
        ),
    ];
    for (place, (file, message)) in cases.into_iter().enumerate() {
        let folder = folder(&file);
        let arguments =
            ["position", "calibrate", "levels.csv", "--section-m", "400", "-o", "table.toml", "--svg", "t.svg"];
        let output = oracle(folder.path(), &arguments);
        let said = text(&output.stderr);
        // The first of these has enough for a table that begins later.
        if message.starts_with("what every pass covers") {
            assert!(output.status.success() && text(&output.stdout).contains("knots 2 to 8"), "{said}");
            continue;
        }
        assert_eq!(output.status.code(), Some(1), "{place}: {message}\n{said}");
        assert!(said.starts_with("oracle: levels.csv:") && said.contains(message), "{message}\nwas answered by {said}");
        assert_eq!(fs::read_dir(folder.path()).expect("a folder").count(), 1, "{message} left a file behind");
    }
}

#[test]
fn what_is_asked_for_wrongly() {
    let folder = folder(&measured(0.03));
    let cases: [(&[&str], &str); 5] = [
        (&["-o", "table.txt"], "table.txt: its name must end in .toml or .json"),
        (&["--spacing-m", "20"], "--spacing-m is 20; it must be 1.6, 3.2, 6.4"),
        (&["--section-m", "nan"], "--section-m is NaN; it must be 1 to 3072"),
        (&["--section-m", "5000"], "--section-m is 5000; it must be 1 to 3072"),
        (&["--floor-db", "400"], "the floor is 400 dB; --floor-db must be -320 to 320"),
    ];
    for (arguments, message) in cases {
        let output = oracle(folder.path(), &[&["position", "calibrate", "levels.csv"], arguments].concat());
        assert_eq!(output.status.code(), Some(2), "{message}");
        assert!(text(&output.stderr).starts_with(&format!("oracle: {message}")), "{}", text(&output.stderr));
        assert_eq!(fs::read_dir(folder.path()).expect("a folder").count(), 1, "{message} left a file behind");
    }
    let output = oracle(folder.path(), &["position", "calibrate", "nowhere.csv"]);
    assert!(text(&output.stderr).starts_with("oracle: nowhere.csv cannot be read"));
}
