//! The example with one thing wrong, in the line's file or in a layout: found by exactly its rule, with both places.

use atc_line::{Finding, Outcome, read};
use std::collections::BTreeSet;
use std::fs;

const FILES: [(&str, &str); 3] = [
    ("line.toml", include_str!("../../examples/line.toml")),
    ("westham.toml", include_str!("../../examples/westham.toml")),
    ("eastham.toml", include_str!("../../examples/eastham.toml")),
];

/// What telegrams name.
const TELEGRAMS: &str = "speeds_km_h = [0, 15, 25, 45, 55, 65, 75, 90]";

/// The pair of codes of a stop.
const STOP_PAIR: &str = "    { main_hz = 47, sub_hz = 44, speed_km_h = 0 },\n";

/// A train is lost for one cycle at most, and Eastham counts to two.
const SHORT_LOSS: [(&str, &str, &str); 3] = [
    ("line.toml", "shunt_loss_ms = 1000", "shunt_loss_ms = 100"),
    ("westham.toml", "shunt_loss_ms = 1000", "shunt_loss_ms = 100"),
    ("eastham.toml", "shunt_loss_ms = 1000\nclear_ms = 2000", "shunt_loss_ms = 100\nclear_ms = 200"),
];

/// One change: the file, what stands there, and what is put in its place.
type Change<'a> = (&'a str, &'a str, &'a str);

/// What stands in a text from here on, to the end of that.
fn text_between(text: &str, from: &str, to: &str) -> String {
    let start = text.find(from).expect(from);
    let end = start + text[start..].find(to).expect(to) + to.len();
    text[start..end].to_owned()
}

/// The example with these changes, in a folder of its own.
fn changed(changes: &[Change<'_>]) -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    for (name, text) in FILES {
        let mut text = text.to_owned();
        for (_, from, to) in changes.iter().filter(|(file, ..)| *file == name) {
            assert!(text.contains(from), "{from:?} is not in {name}");
            text = text.replacen(from, to, 1);
        }
        fs::write(folder.path().join(name), text).expect("written");
    }
    folder
}

/// The rules that the example breaks with these changes, and where.
fn broken(changes: &[Change<'_>]) -> (BTreeSet<String>, Vec<Finding>) {
    let folder = changed(changes);
    match read(&folder.path().join("line.toml")) {
        Ok(line) => {
            let checks = line.checks();
            let refused = checks.iter().filter(|check| !check.findings().is_empty());
            let findings = refused.clone().flat_map(|check| check.findings().to_vec()).collect();
            (refused.map(|check| check.rule.clone()).collect(), findings)
        }
        Err(problems) => {
            let finding = |one: &atc_line::Problem| Finding {
                at: one.at.clone(),
                against: None,
                what: one.what.clone(),
                right: String::new(),
            };
            let rules = problems.0.iter().map(|one| one.rule.id().to_owned()).collect();
            (rules, problems.0.iter().map(finding).collect())
        }
    }
}

/// Whether a place is in this file, with line and column.
fn is_in(place: &str, file: &str) -> bool {
    let numbers = place.rsplit(':').take(2).all(|number| number.parse::<usize>().is_ok());
    place.contains(&format!("{file}:")) && numbers
}

/// Broken alone, and the file of `at` and the file of `against`.
#[track_caller]
fn found(rule: &str, changes: &[Change<'_>], at: &str, against: &str) {
    let (rules, findings) = broken(changes);
    assert_eq!(rules, BTreeSet::from([rule.to_owned()]), "{changes:?}: {findings:?}");
    for one in &findings {
        assert!(is_in(&one.at, at), "{one:?}");
        let other = one.against.as_deref().unwrap_or_default();
        assert!(if against.is_empty() { other.is_empty() } else { is_in(other, against) }, "{one:?}");
    }
}

#[test]
fn the_example_as_it_is() {
    assert_eq!(broken(&[]).0, BTreeSet::new());
}

#[test]
fn what_a_part_of_the_line_breaks_alone() {
    for (rule, from, to) in [
        ("form", "cycle_ms = 10", "cycle = 10"),
        ("range", "worst_gradient_permille = -35", "worst_gradient_permille = -129"),
        ("TIME-2", "shortened_operate_ms = 100", "shortened_operate_ms = 300"),
        ("TIME-4", "aspects_km_h = [0, 15, 25", "aspects_km_h = [0, 25, 25"),
        ("SUP-3", "release_margin_km_h = 0", "release_margin_km_h = 401"),
        ("BLK-8", "max_trains = 2", "max_trains = 3"),
        ("BLK-9", "sections_m = [300, 250]", "sections_m = [300, 0]"),
        ("TEL-4", "number = 1, length_m = 300", "number = 1, length_m = 0"),
        ("TEL-7", "window = 3", "window = 128"),
        ("PAT-3", "brake_mm_s2 = 800", "brake_mm_s2 = 4096"),
        ("PER-4", "margin_m = 30", "margin_m = 12"),
        (
            "PER-5",
            "number = 1, length_m = 300, gradient_permille = -12",
            "number = 1, length_m = 300, gradient_permille = -36",
        ),
        ("PER-7", "limit_km_h = 75", "limit_km_h = 70"),
        ("PER-8", "restriction_lead_ms = 60000", "restriction_lead_ms = 12039"),
        ("PER-9", "fresh_ms = 3200", "fresh_ms = 3310"),
        ("section-twice", "{ number = 2,", "{ number = 1,"),
        ("CODE-3", "tolerance_hz = 1.0", "tolerance_hz = 3.0"),
        ("CODE-4", "{ main_hz = 15, sub_hz = 16.5,", "{ main_hz = 10, sub_hz = 12,"),
    ] {
        found(rule, &[("line.toml", from, to)], "line.toml", "");
    }
}

#[test]
fn what_two_parts_of_the_line_break_together() {
    let line = "line.toml";
    for (rule, from, to) in [
        ("train-brake", "brake_mm_s2 = 850", "brake_mm_s2 = 799"),
        ("telegram-section", "circuit = \"W2\", left = 1,", "circuit = \"W2\", left = 99,"),
        ("telegram-twice", "circuit = \"W2\", left = 1,", "circuit = \"W2\", left = 3,"),
        (
            "telegram-differs",
            "\"Eastham\", circuit = \"E2\", left = 15,",
            "\"Eastham\", circuit = \"E2\", left = 1001,",
        ),
    ] {
        // A number that no section has is told by its own rule, too, so it is given one.
        let more = "    { number = 1001, length_m = 300, gradient_permille = -12, limit_km_h = 75 },\n]\n\n[times]";
        found(rule, &[(line, from, to), (line, "]\n\n[times]", more)], line, line);
    }
    // Of no station's codes, and of no section.
    let both = [(line, "aspects_km_h = [0, 15,", "aspects_km_h = [0, 5, 15,")];
    found("code-speed", &both, line, line);
    let other = ("circuit = \"W2\", left = 1, right = 2", "circuit = \"W2\", left = 2, right = 1");
    found("telegram-direction", &[(line, other.0, other.1)], line, "westham.toml");
    found("one-wrong-code", &[(line, "{ main_hz = 15, sub_hz = 16.5,", "{ main_hz = 15, sub_hz = 12,")], line, "");
    let third = "file = \"eastham.toml\"\n\n[[station]]\nfile = \"eastham.toml\"";
    found("station-twice", &[(line, "file = \"eastham.toml\"", third)], line, line);
    let w1 = "{ station = \"Westham\", circuit = \"W1\", left = 3, right = 4 }";
    found(
        "telegram-circuit",
        &[(line, w1, &format!("{w1}, {{ station = \"Westham\", circuit = \"W9\" }}"))],
        line,
        line,
    );
    found(
        "telegram-circuit",
        &[(line, w1, &format!("{w1}, {{ station = \"Northam\", circuit = \"W1\" }}"))],
        line,
        line,
    );
    // Two stations at one end of the blocks; and a segment with two borders.
    let between = "[[border]]\nbetween = [\"Westham\", \"Eastham\"]";
    for (station, segment, end) in [("Westham", "West", "low"), ("Eastham", "West", "high")] {
        let also = format!(
            "[[border]]\nstation = \"{station}\"\nsegment = \"{segment}\"\njoint = \"a\"\nblocks = \"{end}\"\n\n{between}"
        );
        found("border-names", &[(line, between, &also)], line, line);
    }
    found("range", &[(line, "longest_m = 200 ", "longest_m = 0 ")], line, "");
    let names = "line = \"middle\"             # as both";
    let more = "[[border]]\nstation = \"Westham\"\nsegment = \"North\"\njoint = \"a\"\nblocks = \"high\"\n\n[[border]]\nbetween = [\"Westham\", \"Eastham\"]";
    found("border-names", &[(line, "[[border]]\nbetween = [\"Westham\", \"Eastham\"]", more)], line, line);
    assert_eq!(
        broken(&[(line, names, "line = \"centre\" #")]).0,
        ["border-missing", "border-names"].map(String::from).into()
    );
}

#[test]
fn a_border_that_the_two_sides_see_otherwise() {
    let (line, west, east) = ("line.toml", "westham.toml", "eastham.toml");
    // Its section number has one length, and so is wrong for one of them.
    let shorter = broken(&[(east, "name = \"E2\"\nlength_m = 300", "name = \"E2\"\nlength_m = 299")]).0;
    assert_eq!(shorter, ["border-views", "section-length"].map(String::from).into());
    // What one station shares and the other does not are two circuits, which send the same numbers.
    let unshared = broken(&[(east, "shared = [\"E2\"]\n", "")]).0;
    assert_eq!(unshared, ["border-views", "telegram-twice"].map(String::from).into());
    found(
        "border-views",
        &[
            (east, "longest_train_m = 200", "longest_train_m = 320"),
            (east, "reverse_kmh = 45", "reverse_kmh = 45\nroute_kmh = 45"),
        ],
        west,
        east,
    );
    let border =
        "[[border]]\nbetween = [\"Westham\", \"Eastham\"]\nline = \"middle\"             # as both layouts call it\n";
    found("border-missing", &[(line, border, "")], west, east);
    let counted = text_between(FILES[0].1, "[[border]]\nstation", "blocks = \"low\"");
    found("border-missing", &[(line, &counted, "#")], line, line);
    let joint = text_between(&counted, "joint", "\n");
    found("form", &[(line, &joint, "")], line, "");
    found("border-joint", &[(line, "joint = \"z\"", "joint = \"y\"")], line, east);
    let short = [
        (east, "name = \"E9\"\nlength_m = 300", "name = \"E9\"\nlength_m = 199"),
        (line, "number = 29, length_m = 300", "number = 29, length_m = 199"),
        (line, "number = 30, length_m = 300", "number = 30, length_m = 199"),
    ];
    found("border-tail", &short, east, line);
}

#[test]
fn what_telegrams_say_of_a_circuit_and_it_is_not() {
    let (line, west) = ("line.toml", "westham.toml");
    found(
        "telegram-missing",
        &[(line, "circuit = \"W2\", left = 1, right = 2", "circuit = \"W2\", left = 1")],
        line,
        west,
    );
    for length in ["299", "301", "30"] {
        let wrong = format!("number = 1, length_m = {length}");
        found("section-length", &[(line, "number = 1, length_m = 300", &wrong)], line, west);
    }
    found(
        "section-gradient",
        &[(
            line,
            "number = 1, length_m = 300, gradient_permille = -12",
            "number = 1, length_m = 300, gradient_permille = -9",
        )],
        line,
        west,
    );
    // A train in W1 that goes out may be granted W2, which falls.
    let [flat, fall] = [-12, -9].map(|permille| format!("number = 3, length_m = 300, gradient_permille = {permille}"));
    found("section-gradient", &[(line, &flat, &fall)], line, west);
    // A train by codes hears nothing of a section's limit: 1T is run through at 75 km/h.
    let [fast, slow] =
        [75, 55].map(|kmh| format!("number = 8, length_m = 400, gradient_permille = -12, limit_km_h = {kmh}"));
    found("section-limit", &[(line, &fast, &slow)], line, west);
    // A circuit of which nobody says how steep it is is level, and not a rise.
    let steeper = (west, "name = \"W1\"\nlength_m = 300", "name = \"W1\"\nlength_m = 300\ngradient = -10");
    let level = (west, "name = \"W2\"\nlength_m = 300\ngradient = -10", "name = \"W2\"\nlength_m = 300");
    let [steep, rise] = [-12, 1].map(|permille| format!("number = 1, length_m = 300, gradient_permille = {permille}"));
    found("section-gradient", &[level, steeper, (line, &steep, &rise)], line, west);
}

#[test]
fn what_a_station_counts_on_and_its_trains_do_not_do() {
    let (line, west, east) = ("line.toml", "westham.toml", "eastham.toml");
    let text = FILES[0].1;
    // Without telegrams and sections nothing else says how steep a circuit is.
    let said =
        text.get(text.find("telegram = [").expect("there")..text.find("[times]").expect("there")).expect("in order");
    for (rule, changes, at, against) in [
        ("telegram-lives", &[(line, "life_ms = 3300", "life_ms = 3320")][..], west, line),
        // A telegram that is slow on its way; a code that is displayed for long after it was last heard, or named for long after it was changed.
        ("telegram-lives", &[(line, "delay_ms = 120", "delay_ms = 131")], west, line),
        ("telegram-lives", &[(line, "mask_ms = 400", "mask_ms = 3810")], west, line),
        ("telegram-lives", &[(line, "code_way_ms = 300", "code_way_ms = 3701")], west, line),
        (
            "release-promised",
            &[
                (west, "name = \"W-1\"", "name = \"W-1\"\nrelease_ms = 46900"),
                (line, "release_ms = 30000", "release_ms = 46950"),
            ],
            west,
            line,
        ),
        ("turn-promised", &[(line, "release_ms = 30000", "release_ms = 49001")], west, line),
        ("brake", &[(line, "brake_mm_s2 = 800", "brake_mm_s2 = 799")], west, line),
        (
            "from-telegrams",
            &[(line, "brake_mm_s2 = 800", "brake_mm_s2 = 1600"), (line, "brake_mm_s2 = 850", "brake_mm_s2 = 1700")],
            west,
            line,
        ),
        (
            "train-length",
            &[(line, "longest_m = 200", "longest_m = 201"), (line, "longest_train_m = 200", "longest_train_m = 201")],
            west,
            line,
        ),
        (
            "shunt-loss",
            &[
                (line, "shunt_loss_ms = 1000", "shunt_loss_ms = 1001"),
                (west, "clear_ms = 2000", "clear_ms = 2100"),
                (east, "clear_ms = 2000", "clear_ms = 2100"),
            ],
            west,
            line,
        ),
        (
            "heard-beyond",
            &[(west, "heard_beyond_m = 10", "heard_beyond_m = 9"), (east, "heard_beyond_m = 10", "heard_beyond_m = 9")],
            west,
            line,
        ),
        // Twice a loss of one cycle is two cycles; the line asks for one more.
        ("loss-within-clear", &SHORT_LOSS, east, line),
        (
            "gradient",
            &[(line, said, ""), (line, "worst_gradient_permille = -35", "worst_gradient_permille = -9")],
            line,
            west,
        ),
        ("rank-missing", &[(line, TELEGRAMS, "speeds_km_h = [0, 15, 25, 45, 55, 75, 90]")], west, line),
        (
            "rank-rises",
            &[(
                line,
                "file = \"westham.toml\"",
                "file = \"westham.toml\"\ncode_speeds_km_h = [15, 25, 15, 55, 65, 75, 90]",
            )],
            line,
            west,
        ),
        ("code-missing", &[(line, STOP_PAIR, ""), (line, "aspects_km_h = [0, 15,", "aspects_km_h = [15,")], line, west),
        (
            "rank-faster",
            &[(
                line,
                "file = \"westham.toml\"",
                "file = \"westham.toml\"\ncode_speeds_km_h = [15, 45, 45, 55, 65, 75, 90]",
            )],
            line,
            west,
        ),
        ("rank-stop", &[(line, TELEGRAMS, "speeds_km_h = [15, 25, 45, 55, 65, 75, 90]")], line, west),
        ("speed-plausible", &[(line, "maximum_km_h = 400", "maximum_km_h = 89.9")], line, west),
        ("station", &[(west, "turn_ms = 49000", "turn_ms = 48500")], west, line),
    ] {
        let (rules, findings) = broken(changes);
        assert_eq!(rules, BTreeSet::from([rule.to_owned()]), "{findings:?}");
        let two = |one: &&Finding| is_in(&one.at, at) && is_in(one.against.as_deref().unwrap_or(""), against);
        assert!(findings.iter().any(|one| two(&one)), "{rule}: {findings:?}");
        assert!(findings.iter().all(|one| one.against.is_some()), "{rule}: {findings:?}");
    }
    // Shorter frames than the ground has something new for.
    assert_eq!(broken(&[(line, "frame_ms = 530", "frame_ms = 40")]).0, ["telegram-lives"].map(String::from).into());
    // Its neighbour's trains are longer, too.
    let shorter = broken(&[(east, "longest_train_m = 200", "longest_train_m = 199")]).0;
    assert_eq!(shorter, ["border-views", "train-length"].map(String::from).into());
}

/// A mapping of codes that is never faster is as good as the same table.
#[test]
fn a_mapping_of_codes_that_is_never_faster() {
    let slower = "file = \"westham.toml\"\ncode_speeds_km_h = [15, 25, 25, 45, 55, 75, 90]";
    assert_eq!(broken(&[("line.toml", "file = \"westham.toml\"", slower)]).0, BTreeSet::new());
    let few = "file = \"westham.toml\"\ncode_speeds_km_h = [15, 25]";
    found("rank-missing", &[("line.toml", "file = \"westham.toml\"", few)], "line.toml", "westham.toml");
}

#[test]
fn a_station_that_is_refused_hides_nothing_and_passes_nothing() {
    let mut changes = vec![("westham.toml", "turn_ms = 49000", "turn_ms = 47000")];
    changes.extend(SHORT_LOSS);
    let (rules, _) = broken(&changes);
    assert_eq!(rules, ["station", "loss-within-clear"].map(String::from).into());
    // What was not looked at in the refused station is not called met.
    let folder = changed(&[("westham.toml", "turn_ms = 49000", "turn_ms = 48500")]);
    let checks = read(&folder.path().join("line.toml")).expect("a line").checks();
    let outcome = |rule: &str| checks.iter().find(|check| check.rule == rule).map(|check| check.outcome.clone());
    assert_eq!(outcome("brake"), Some(Outcome::NotChecked));
    assert_eq!(outcome("TIME-2"), Some(Outcome::Met));
}

#[test]
fn a_layout_that_cannot_be_read_is_told_at_the_line_that_names_it() {
    found("form", &[("line.toml", "file = \"westham.toml\"", "file = \"nowhere.toml\"")], "line.toml", "");
    let (_, findings) = broken(&[("line.toml", "file = \"westham.toml\"", "file = \"nowhere.toml\"")]);
    assert!(findings[0].what.contains("nowhere.toml: cannot be read"), "{findings:?}");
    found("form", &[("westham.toml", "name = \"Westham\"", "nam = \"Westham\"")], "line.toml", "");
    found("form", &[("line.toml", "between = [\"Westham\", \"Eastham\"]\n", "")], "line.toml", "");
}

/// Three codes without a speed are three findings, though all stand at one place.
#[test]
fn nothing_is_folded_away() {
    let (rules, findings) = broken(&[("line.toml", TELEGRAMS, "speeds_km_h = [0, 15, 25, 75, 90]")]);
    assert_eq!(rules, ["rank-missing".to_owned()].into());
    assert_eq!(findings.len(), 6, "three codes in each of two stations: {findings:?}");
}
