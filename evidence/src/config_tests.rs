//! The patent's example, and every rule broken on purpose.

use super::{EXAMPLE, parse};

fn refused(from: &str, to: &str) -> String {
    assert!(EXAMPLE.contains(from), "{from}");
    parse("my-line.toml", &EXAMPLE.replacen(from, to, 1)).expect_err("refused").to_string()
}

/// A figure that follows from a line's parameters, by the beginning of its name.
pub fn value(text: &str, name: &str) -> String {
    let line = parse("l.toml", text).expect("good").case(&[]);
    line.derived.iter().find(|one| one.name.starts_with(name)).map(|one| one.value.clone()).unwrap_or_default()
}

#[test]
fn the_example_has_the_known_figures() {
    let line = parse("my-line.toml", EXAMPLE).expect("good").case(&[]);
    let value = |name: &str| value(EXAMPLE, name);
    assert_eq!(value("Longest interruption"), "700 ms (70 cycles)");
    assert_eq!(value("The same, conventional"), "500 ms (50 cycles)");
    assert_eq!(value("Total silence"), "800 ms (80 cycles)");
    assert!(line.derived.iter().any(|one| one.value == "100 ms in every 800 ms (12.5 %)"));
    assert!(line.derived.iter().any(|one| one.value == "300 ms in every 800 ms (37.5 %)"));
    assert_eq!(line.times.iter().map(|one| one.ticks).collect::<Vec<_>>(), [30, 40, 40, 79, 10]);
    assert!(line.times[3].rounding.contains("TIME-3"));
}

#[test]
fn a_broken_rule_is_named_with_its_line() {
    for (from, to, words) in [
        ("cycle_ms = 10", "cycle_ms = 0", "TIME-2 is broken: the logic cycle"),
        ("operate_ms = 300", "operate_ms = 0", "TIME-2 is broken: T1"),
        ("recovery_ms = 400", "recovery_ms = 9", "TIME-2 is broken: T2"),
        ("shortened_operate_ms = 100", "shortened_operate_ms = 300", "T5 must be shorter than T1"),
        ("recovery_ms = 400", "recovery_ms = 999999", "T2 + T3 must not exceed"),
        ("[25, 45, 65, 90]", "[]", "TIME-4 is broken: there must be"),
        ("[25, 45, 65, 90]", "[25, 45, 45, 90]", "number 3 does not exceed"),
        ("[25, 45, 65, 90]", "[25, 45.55]", "in steps of 0.1; it is 45.55"),
        ("[25, 45, 65, 90]", "[-1]", "it is -1"),
        ("release_margin_km_h = 0", "release_margin_km_h = 500", "SUP-3 is broken: the release margin"),
        ("maximum_km_h = 400", "maximum_km_h = 0", "SUP-3 is broken: the highest"),
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
        parse("my-line.toml", &text).expect("good").case(&[]).notes.join("\n")
    };
    assert!(notes("cycle_ms = 10", "cycle_ms = 7").contains("proved for a cycle of 10 ms"));
    assert!(notes("interruption_ms = 800", "interruption_ms = 200").contains("gains nothing"));
    assert!(notes("[25, 45, 65, 90]", "[5, 25, 45, 65, 90]").contains("has 5 aspects"));
    assert!(notes("interruption_ms = 800", "interruption_ms = 800").contains("display lapses"));
    for cycle in 1..=150 {
        let text = EXAMPLE.replacen("cycle_ms = 10", &format!("cycle_ms = {cycle}"), 1);
        if let Ok(line) = parse("my-line.toml", &text) {
            assert!(line.is_sound(), "cycle {cycle}");
        }
    }
}
