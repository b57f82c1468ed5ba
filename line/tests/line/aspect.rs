//! The patent's example, and every rule broken on purpose.

use crate::support::{EXAMPLE, parse, value};

fn refused(from: &str, to: &str) -> String {
    assert!(EXAMPLE.contains(from), "{from}");
    parse("my-line.toml", &EXAMPLE.replacen(from, to, 1)).expect_err("refused").to_string()
}

#[test]
fn the_example_has_the_known_figures() {
    let line = parse("my-line.toml", EXAMPLE).expect("good");
    let value = |name: &str| value(EXAMPLE, name);
    assert_eq!(value("Longest interruption"), "700 ms (70 cycles)");
    assert_eq!(value("The same, conventional"), "500 ms (50 cycles)");
    assert_eq!(value("Total silence"), "800 ms (80 cycles)");
    assert!(line.derived().iter().any(|one| one.value == "100 ms in every 800 ms (12.5 %)"));
    assert!(line.derived().iter().any(|one| one.value == "300 ms in every 800 ms (37.5 %)"));
    assert_eq!(line.times_kept().iter().map(|one| one.ticks).collect::<Vec<_>>(), [30, 40, 40, 79, 10]);
    assert!(line.times_kept()[3].rounding.contains("TIME-3"));
}

#[test]
fn a_broken_rule_is_named_with_its_line() {
    for (from, to, words) in [
        ("cycle_ms = 10", "cycle_ms = 0", "TIME-2 is broken: cycle_ms is 0; a logic cycle"),
        ("operate_ms = 300", "operate_ms = 0", "TIME-2 is broken: operate_ms (T1) is 0"),
        ("recovery_ms = 400", "recovery_ms = 9", "TIME-2 is broken: recovery_ms (T2) is 9 ms, less than one cycle"),
        ("shortened_operate_ms = 100", "shortened_operate_ms = 300", "T5 must be fewer cycles than T1"),
        (
            "recovery_ms = 400",
            "recovery_ms = 999999",
            "recovery_ms + mask_ms (T2 + T3) is 1000399 ms; it must be at most 60000 cycles",
        ),
        ("[25, 45, 65, 90]", "[]", "TIME-4 is broken: aspects_km_h is empty"),
        (
            "[25, 45, 65, 90]",
            "[25, 45, 45, 90]",
            "aspects_km_h[2] is 45 km/h after 45 km/h; the permitted speeds must rise strictly",
        ),
        ("[25, 45, 65, 90]", "[25, 45.55]", "aspects_km_h[1] is 45.55 km/h; it must be a whole number of tenths"),
        ("[25, 45, 65, 90]", "[-1]", "aspects_km_h[0] is -1 km/h; a permitted speed is 0 to 6553.5 km/h"),
        (
            "release_margin_km_h = 0",
            "release_margin_km_h = 500",
            "SUP-3 is broken: release_margin_km_h is 500 km/h, above maximum_km_h",
        ),
        ("maximum_km_h = 400", "maximum_km_h = 0", "SUP-3 is broken: maximum_km_h is 0; it must be above 0"),
        ("cycle_ms = 10", "cycle = 10", "unknown field"),
        ("cycle_ms = 10", "cycle_ms = -10", "invalid value"),
    ] {
        let message = refused(from, to);
        assert!(message.contains(words), "{message}");
        let line = EXAMPLE.lines().position(|line| line.contains(from)).map_or(0, |line| line + 1);
        assert!(message.starts_with(&format!("my-line.toml:{line}:")), "{message}");
    }
}

#[test]
fn what_the_user_should_look_at_is_said() {
    let notes = |from: &str, to: &str| {
        let text = EXAMPLE.replacen(from, to, 1);
        parse("my-line.toml", &text).expect("good").notes().join("\n")
    };
    assert!(notes("interruption_ms = 800", "interruption_ms = 200").contains("gains nothing"));
    assert!(notes("interruption_ms = 800", "interruption_ms = 800").contains("display lapses"));
    for cycle in 1..=150 {
        let text = EXAMPLE.replacen("cycle_ms = 10", &format!("cycle_ms = {cycle}"), 1);
        if let Ok(line) = parse("my-line.toml", &text) {
            assert!(line.is_sound(), "cycle {cycle}");
        }
    }
}
