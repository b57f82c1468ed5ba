//! The example with one thing wrong, in the line's file or in a layout: found by exactly its rule, with both places.

use atc_line::{Finding, read};
use std::collections::BTreeSet;
use std::fs;

const FILES: [(&str, &str); 3] = [
    ("line.toml", include_str!("../../examples/line.toml")),
    ("westham.toml", include_str!("../../examples/westham.toml")),
    ("eastham.toml", include_str!("../../examples/eastham.toml")),
];

/// One change: the file, what stands there, and what is put in its place.
type Change<'a> = (&'a str, &'a str, &'a str);

/// The rules that the example breaks with these changes, and where.
fn broken(changes: &[Change<'_>]) -> (BTreeSet<String>, Vec<Finding>) {
    let folder = tempfile::tempdir().expect("a folder");
    for (name, text) in FILES {
        let mut text = text.to_owned();
        for (_, from, to) in changes.iter().filter(|(file, ..)| *file == name) {
            assert!(text.contains(from), "{from:?} is not in {name}");
            text = text.replacen(from, to, 1);
        }
        fs::write(folder.path().join(name), text).expect("written");
    }
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
        ("TIME-4", "aspects_km_h = [15, 25", "aspects_km_h = [25, 25"),
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
        ("PER-9", "fresh_ms = 1600", "fresh_ms = 2510"),
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
        ("code-speed", "sub_hz = 32, speed_km_h = 75", "sub_hz = 32, speed_km_h = 65"),
        ("train-brake", "brake_mm_s2 = 850", "brake_mm_s2 = 799"),
        ("telegram-section", "circuit = \"W2\", left = 1,", "circuit = \"W2\", left = 99,"),
        ("telegram-twice", "circuit = \"W2\", left = 1,", "circuit = \"W2\", left = 3,"),
        (
            "telegram-differs",
            "\"Eastham\", circuit = \"E2\", left = 15,",
            "\"Eastham\", circuit = \"E2\", left = 1000,",
        ),
    ] {
        // A number that no section has is told by its own rule, too, so it is given one.
        let more = "    { number = 1000, length_m = 300, gradient_permille = -12, limit_km_h = 75 },\n]\n\n[times]";
        found(rule, &[(line, from, to), (line, "]\n\n[times]", more)], line, line);
    }
    found("one-wrong-code", &[(line, "{ main_hz = 15, sub_hz = 16.5,", "{ main_hz = 15, sub_hz = 12,")], line, "");
    found(
        "station-twice",
        &[
            (
                line,
                "file = \"eastham.toml\"",
                "file = \"westham.toml\"\nname = \"Other\"\n\n[[station]]\nfile = \"eastham.toml\"\nname = \"Other\"",
            ),
            (
                line,
                "between = [\"Westham\", \"Eastham\"]\nline = \"middle\"",
                "between = [\"Westham\", \"Other\"]\nline = \"middle\"",
            ),
        ]
        .map(|one| one)[..0],
        line,
        line,
    );
}

#[test]
fn what_a_station_counts_on_and_its_trains_do_not_do() {
    let (line, west, east) = ("line.toml", "westham.toml", "eastham.toml");
    for (rule, changes, at, against) in [
        ("telegram-lives", &[(line, "life_ms = 2500", "life_ms = 2970")][..], west, line),
        (
            "release-promised",
            &[
                (west, "release_ms = 60000", "release_ms = 48000"),
                (line, "release_ms = 30000", "release_ms = 46999"),
                (east, "turn_ms = 47000", "turn_ms = 50000"),
                (west, "name = \"W-1\"", "name = \"W-1\"\nrelease_ms = 46900"),
            ],
            west,
            line,
        ),
        ("turn-promised", &[(line, "release_ms = 30000", "release_ms = 47001")], west, line),
        ("brake", &[(line, "brake_mm_s2 = 800", "brake_mm_s2 = 799")], west, line),
        (
            "train-length",
            &[(line, "longest_m = 200", "longest_m = 201"), (line, "longest_train_m = 200", "longest_train_m = 201")],
            west,
            line,
        ),
        ("shunt-loss", &[(line, "shunt_loss_ms = 1000", "shunt_loss_ms = 1001")], west, line),
        ("loss-within-clear", &[(east, "clear_ms = 2000", "clear_ms = 1100")], east, line),
        (
            "gradient",
            &[
                (line, "worst_gradient_permille = -35", "worst_gradient_permille = -12"),
                (west, "gradient = -10", "gradient = -13"),
                (east, "gradient = -10", "gradient = -13"),
                (line, "number = 1, length_m = 300", "number = 77, length_m = 300"),
                (line, "circuit = \"W2\", left = 1, right = 2", "circuit = \"W2\", left = 77, right = 2"),
            ],
            line,
            west,
        ),
        ("rank-missing", &[(line, "[0, 15, 25, 45, 55, 65, 75, 90]", "[0, 15, 25, 45, 55, 75, 90]")], west, line),
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
        ("rank-stop", &[(line, "[0, 15, 25, 45, 55, 65, 75, 90]", "[15, 25, 45, 55, 65, 75, 90]")], line, west),
        ("speed-plausible", &[(line, "maximum_km_h = 400", "maximum_km_h = 89.9")], line, west),
        ("station", &[(west, "turn_ms = 47000", "turn_ms = 46663")], west, line),
    ] {
        let _ = east;
        let (rules, findings) = broken(changes);
        assert_eq!(rules, BTreeSet::from([rule.to_owned()]), "{findings:?}");
        assert!(
            findings.iter().any(|one| is_in(&one.at, at) && is_in(one.against.as_deref().unwrap_or(""), against)),
            "{rule}: {findings:?}"
        );
        assert!(findings.iter().all(|one| one.against.is_some()), "{rule}: {findings:?}");
    }
}
