//! The example's attenuation table, and every rule on it broken on purpose.

use crate::support::{EXAMPLE, parse, value};

fn changed(from: &str, to: &str) -> String {
    let start = EXAMPLE.find("[position]").expect("the example has a table");
    let (before, after) = EXAMPLE.split_at(start);
    assert!(after.contains(from), "{from}");
    format!("{before}{}", after.replacen(from, to, 1))
}

fn refused(from: &str, to: &str) -> (String, String) {
    let text = changed(from, to);
    let message = parse("l.toml", &text).expect_err("refused").to_string();
    let mut numbers = message.trim_start_matches("l.toml:").split(':').map(|number| number.parse().unwrap_or(0));
    let line = text.lines().nth(numbers.next().unwrap_or(0_usize).saturating_sub(1)).unwrap_or_default();
    let from = line.get(numbers.next().unwrap_or(1).saturating_sub(1)..).unwrap_or_default().to_owned();
    (from, message)
}

#[test]
fn the_example_has_the_known_figures() {
    let line = parse("l.toml", EXAMPLE).expect("good");
    let value = |name: &str| value(EXAMPLE, name);
    assert_eq!(value("The attenuation table reaches"), "3276.8 m");
    assert_eq!(value("Spans in which both"), "16 of 16");
    // What two levels that are 0.1 dB off say at the wet limit, and at the dry one.
    assert!(value("The interval by the levels alone").starts_with("at 819 m 2"), "{}", value("The interval by"));
    assert!(line.checks().iter().any(|check| check.rule == "POS-5"));
}

#[test]
fn a_broken_rule_is_named_with_its_place() {
    for (from, to, place, words) in [
        (
            "spacing_m = 204.8",
            "spacing_m = 200",
            "200",
            "spacing_m is 200 m; it must be 1.6, 3.2, 6.4, 12.8, 25.6, 51.2, 102.4 or 204.8 m",
        ),
        ("[-0.01, ", "[", "[0.36", "lowest_db has 16 values; it must have 17"),
        (
            "[-0.01, 0.36",
            "[-0.01, 1.86",
            "1.86",
            "POS-5 is broken: lowest_db[1] is 1.86 dB and highest_db[1] 1.85 dB; the lowest must not be above the highest",
        ),
        (
            "[-0.01, 0.36",
            "[-0.01, 0.365",
            "0.365",
            "lowest_db[1] is 0.365 dB; it must be a whole number of hundredths of a decibel",
        ),
        ("[-0.01, 0.36", "[-0.01, 400.0", "400.0", "lowest_db[1] is 400 dB; it must be -327.68 to 327.67 dB"),
        ("tolerance_db = 0.1", "tolerance_db = -0.1", "-0.1", "tolerance_db is -0.1 dB; it must be 0 or more"),
        (
            "# correction_db = [0.0, 0.0]",
            "correction_db = [0.2, 0.1]",
            "[0.2",
            "correction_db is [0.2, 0.1]; the least must stand before the most",
        ),
        ("floor_db", "floor", "floor", "unknown field"),
    ] {
        let (from, message) = refused(from, to);
        assert!(message.contains(words), "{message}");
        assert!(from.starts_with(place), "{from}: {message}");
    }
    let flat = ["0.0"; 17].join(", ");
    let start = EXAMPLE.find("lowest_db").expect("there");
    let end = EXAMPLE.find("tolerance_db").expect("there");
    let text = format!("{}lowest_db = [{flat}]\nhighest_db = [{flat}]\n{}", &EXAMPLE[..start], &EXAMPLE[end..]);
    let message = parse("l.toml", &text).expect_err("refused").to_string();
    assert!(message.contains("POS-5 is broken: in the table no two neighbours rise both"), "{message}");
}

#[test]
fn what_the_user_should_look_at_is_said() {
    let notes = |from: &str, to: &str| parse("l.toml", &changed(from, to)).expect("good").notes().join("\n");
    assert!(
        notes("spacing_m = 204.8", "spacing_m = 12.8").contains("reaches 204.8 m, and the longest section is 300 m")
    );
    assert!(notes("[-0.01, 0.36", "[0.0, 0.0").contains("Spans 1 do not rise"));
    assert!(notes("tolerance_db = 0.1", "tolerance_db = 0.0").contains("no receiver measures so"));
}
