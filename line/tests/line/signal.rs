//! The example's telegrams and sections, and every rule on them broken on purpose.

use crate::support::{EXAMPLE, parse, value};

/// The example with one place of its part on telegrams changed; place in the file and message.
fn refused(from: &str, to: &str) -> (usize, String) {
    let start = EXAMPLE.find("[signal]").expect("the example sends telegrams");
    let (before, after) = EXAMPLE.split_at(start);
    assert!(after.contains(from), "{from}");
    let text = format!("{before}{}", after.replacen(from, to, 1));
    let message = parse("l.toml", &text).expect_err("refused").to_string();
    let line = message.trim_start_matches("l.toml:").split(':').next().and_then(|line| line.parse().ok());
    (line.unwrap_or(0), message)
}

fn line_of(text: &str) -> usize {
    let start = EXAMPLE.find("[signal]").expect("there");
    let place = start + EXAMPLE[start..].find(text).expect("there");
    EXAMPLE[..place].lines().count() + usize::from(EXAMPLE[..place].ends_with('\n'))
}

fn notes(from: &str, to: &str) -> String {
    assert!(EXAMPLE.contains(from), "{from}");
    parse("l.toml", &EXAMPLE.replacen(from, to, 1)).expect("good").notes().join("\n")
}

#[test]
fn the_example_has_the_known_figures() {
    let line = parse("l.toml", EXAMPLE).expect("good");
    let value = |name: &str| value(EXAMPLE, name);
    assert_eq!(value("Telegrams that may be lost"), "1");
    assert_eq!(value("A digital line without telegrams"), "5010 ms");
    // 1060 + 120 + 5010 + 1500 ms; at 90 km/h that is 193 m.
    assert_eq!(value("A withdrawn stopping point"), "7690 ms, 193 m at the highest speed");
    assert_eq!(value("A restriction is not known"), "12690 ms");
    // 800 − 35 · 9.84375 mm/s²: 455 over 100 m is 34.3 km/h, and the lowest limit 25.
    assert_eq!(value("Permitted 100 m before"), "25.0 km/h");
    assert_eq!(line.sections().len(), 2);
    assert_eq!(
        line.checks().iter().filter(|check| check.rule.starts_with("PER") || check.rule.starts_with("TEL-")).count(),
        6
    );
}

#[test]
fn a_broken_rule_is_named_with_its_place() {
    for (from, to, words) in [
        ("frame_ms = 530", "frame_ms = 0", "TEL-7 is broken: frame_ms is 0; a telegram takes time"),
        ("window = 3", "window = 0", "TEL-7 is broken: window is 0; the counter may advance by at least 1"),
        ("window = 3", "window = 128", "window is 128; the counter may advance by at least 1 and at most 127"),
        ("run = 1", "run = 0", "TEL-7 is broken: run is 0; 1 to 15 telegrams"),
        ("run = 1", "run = 16", "run is 16; 1 to 15 telegrams in a row"),
        ("memory_ms = 2200", "memory_ms = 9", "TEL-7 is broken: memory_ms is 9 ms, less than one cycle"),
        (
            "memory_ms = 2200",
            "memory_ms = 1060",
            "one telegram of a direction to the next (1060 ms: both directions are sent in turn), or none is ever used; it is 1060 ms",
        ),
        ("memory_ms = 2200", "memory_ms = 5010", "PER-9 is broken: memory_ms is 5010 ms, longer than life_ms, 5000 ms"),
        (
            "memory_ms = 2200",
            "memory_ms = 600010",
            "TEL-7 is broken: memory_ms is 600010 ms; it must be at most 60000 cycles",
        ),
        ("fresh_ms = 3200", "fresh_ms = 9", "PER-9 is broken: fresh_ms is 9 ms, less than one cycle"),
        ("life_ms = 5000", "life_ms = 1500", "PER-9 is broken: life_ms is 1500 ms and fresh_ms 3200 ms"),
        ("fixed_life_ms = 10000", "fixed_life_ms = 0", "PER-9 is broken: fixed_life_ms is 0 ms, less than one cycle"),
        (
            "fixed_life_ms = 10000",
            "fixed_life_ms = 600010",
            "PER-9 is broken: fixed_life_ms is 600010 ms; it must be at most 60000 cycles",
        ),
        ("release_ms = 30000", "release_ms = 7689", "PER-8 is broken: a withdrawn stretch must stay free for 7690 ms"),
        (
            "restriction_lead_ms = 60000",
            "restriction_lead_ms = 12689",
            "PER-8 is broken: a restriction must be sent 12690 ms",
        ),
        ("margin_m = 30", "margin_m = 12", "PER-4 is broken: the margin must be at least 13 m"),
        ("brake_mm_s2 = 800", "brake_mm_s2 = 0", "PAT-3 is broken: brake_mm_s2 is 0; it must be 1 to 4095 mm/s²"),
        ("brake_mm_s2 = 800", "brake_mm_s2 = 4096", "brake_mm_s2 is 4096; it must be 1 to 4095 mm/s²"),
        (
            "lowest_limit_km_h = 25",
            "lowest_limit_km_h = 30",
            "PER-9 is broken: lowest_limit_km_h is 30 km/h; it must be one of speeds_km_h: 0, 15, 25",
        ),
        ("[0, 15, 25", "[0, 25, 25", "speeds_km_h[2] is 25 km/h after 25 km/h; the speeds must rise strictly"),
        (
            "gradient_permille = -12",
            "gradient_permille = -36",
            "PER-5 is broken: section 1: it falls more than the worst gradient that is assumed (-35 ‰); it is -36 ‰",
        ),
        (
            "limit_km_h = 75",
            "limit_km_h = 15",
            "PER-5 is broken: section 1: its limit is under the lowest one that is assumed (25 km/h); it is 15 km/h",
        ),
        (
            "limit_km_h = 75",
            "limit_km_h = 76",
            "PER-7 is broken: section 1: limit_km_h is 76 km/h; it must be a speed of the table: 0, 15",
        ),
        ("length_m = 250", "length_m = 0", "TEL-4 is broken: section 1: it has no length"),
        ("number = 2", "number = 1", "section-twice is broken: section 1: it is there twice"),
        ("release_ms", "release", "unknown field"),
        ("gradient_permille = -12", "gradient_permille = -129", "it must be -128 to 127 thousandths"),
    ] {
        let (line, message) = refused(from, to);
        assert!(message.contains(words), "{message}");
        assert_eq!(line, line_of(from), "{message}");
    }
}

#[test]
fn sections_need_the_table_and_the_table_no_sections() {
    let start = EXAMPLE.find("[signal]").expect("there");
    let sections = start + EXAMPLE[start..].find("[[section]]").expect("there");
    let position = EXAMPLE.find("[position]").expect("there");
    let alone = format!("{}{}", &EXAMPLE[..start], &EXAMPLE[sections..]);
    let message = parse("l.toml", &alone).expect_err("refused").to_string();
    assert!(message.contains("there is a [[section]] and no [signal]"), "{message}");
    let line = parse("l.toml", &EXAMPLE[..start]).expect("good");
    assert!(line.sections().is_empty() && !line.checks().iter().any(|check| check.rule.starts_with("PER")));
    let none = format!("{}{}", &EXAMPLE[..sections], &EXAMPLE[position..]);
    let line = parse("l.toml", &none).expect("good");
    assert!(line.notes().iter().any(|note| note.contains("nobody has compared what is assumed")));
}

#[test]
fn what_the_user_should_look_at_is_said() {
    assert!(notes("limit_km_h = 90", "limit_km_h = 45").contains("Section 2 has a lower limit than section 1"));
    assert!(notes("fresh_ms = 3200", "fresh_ms = 3160").contains("A single main telegram that is lost is missed"));
    assert!(!notes("fresh_ms = 3200", "fresh_ms = 3170").contains("is missed"));
    assert!(notes("fresh_ms = 3200", "fresh_ms = 2100").contains("Without any loss a telegram is stale"));
    let long = EXAMPLE.replace("_ms = 5000", "_ms = 300000").replace("fixed_life_ms = 10000", "fixed_life_ms = 300000");
    let long = long
        .replace("release_ms = 30000", "release_ms = 400000")
        .replace("restriction_lead_ms = 60000", "restriction_lead_ms = 400000");
    for (memory, said) in [(268_170, false), (268_180, true)] {
        let text = long.replace("memory_ms = 2200", &format!("memory_ms = {memory}"));
        let notes = parse("l.toml", &text).expect("good").notes().join("\n");
        assert_eq!(notes.contains("as long as a counter takes to go round (268180 ms)"), said, "{memory}");
    }
    assert!(notes("brake_mm_s2 = 800", "brake_mm_s2 = 300").contains("does not slow down"));
    assert!(notes("brake_mm_s2 = 800", "brake_mm_s2 = 800").contains("8 speeds; the theorems are proved with 4"));
}

#[test]
fn the_limits_are_exact() {
    for (from, to) in [
        ("memory_ms = 2200", "memory_ms = 1070"),
        ("memory_ms = 2200", "memory_ms = 5000"),
        ("release_ms = 30000", "release_ms = 7690"),
        ("restriction_lead_ms = 60000", "restriction_lead_ms = 12690"),
        ("margin_m = 30", "margin_m = 13"),
        ("gradient_permille = -12", "gradient_permille = -35"),
    ] {
        let line = parse("l.toml", &EXAMPLE.replacen(from, to, 1));
        assert!(line.is_ok_and(|line| line.is_sound()), "{to}");
    }
}
