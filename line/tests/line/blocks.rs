//! The example's blocks, and every rule on blocks and lines broken on purpose.

use crate::support::{EXAMPLE, parse, value};

const COMMON: &str = "[detection]\nlongest_train_m = 100\npass_ms = 10000\n";

/// The example with other blocks: `common` and (highest number of trains, lengths) for each.
fn with(common: &str, blocks: &[(u8, &str)]) -> String {
    let start = EXAMPLE.find("[detection]").expect("the example has blocks");
    let mut text = format!("{}{common}", &EXAMPLE[..start]);
    for (trains, lengths) in blocks {
        text = format!("{text}[[block]]\nmax_trains = {trains}\nsections_m = [{lengths}]\n");
    }
    text
}

fn refused(common: &str, blocks: &[(u8, &str)]) -> (String, String) {
    let text = with(common, blocks);
    let message = parse("l.toml", &text).expect_err("refused").to_string();
    let (place, rule) = message.split_once(": ").expect("a place");
    let mut numbers = place.trim_start_matches("l.toml:").split(':').map(|number| number.parse::<usize>().unwrap_or(0));
    let line = text.lines().nth(numbers.next().unwrap_or(0).saturating_sub(1)).unwrap_or_default();
    let from = line.get(numbers.next().unwrap_or(1).saturating_sub(1)..).unwrap_or_default().to_owned();
    (from, rule.to_owned())
}

#[test]
fn the_hold_is_the_least_that_covers_the_longest_train_across_borders() {
    let hold = |blocks: &[(u8, &str)]| value(&with(COMMON, blocks), "Sections held");
    assert_eq!(hold(&[(2, "100, 100, 100")]), "1 (for 100 m)");
    assert_eq!(hold(&[(2, "100, 99, 100")]), "2 (for 100 m)");
    // Two short ones side by side, one in each block.
    assert_eq!(hold(&[(2, "100, 40"), (2, "40, 100")]), "3 (for 100 m)");
    assert_eq!(value(&with(COMMON, &[(2, "100, 40"), (2, "40, 100")]), "Shortest"), "180 m, 80 m more than the train");
    assert_eq!(
        value(&with(COMMON, &[(1, "50")]), "Shortest"),
        "longer than the line: what lies before its entry must hold the rest"
    );
    let zero = with(&COMMON.replace("100\n", "0\n"), &[(1, "50")]);
    assert_eq!(value(&zero, "Sections held"), "0 (for 0 m)");
    let usual = with("[detection]\nlongest_train_m = 100\n", &[(1, "100")]);
    assert_eq!(value(&usual, "Check-in may"), "10000 ms (1000 cycles)");
}

#[test]
fn a_line_without_blocks_has_no_block_counting_and_says_nothing_of_it() {
    let blk = |line: &atc_line::Line| line.checks().iter().filter(|check| check.rule.starts_with("BLK")).count();
    let line = parse("l.toml", &with("", &[])).expect("good");
    assert!(line.blocks().is_empty() && blk(&line) == 0);
    let line = parse("l.toml", EXAMPLE).expect("good");
    assert!(!line.blocks().is_empty() && blk(&line) == 3);
}

#[test]
fn a_broken_rule_is_named_with_its_place() {
    let seventeen = vec!["100"; 17].join(", ");
    let sixteen = vec!["100"; 16].join(", ");
    let short = vec!["1"; 16].join(", ");
    let many = [(2, sixteen.as_str()); 5];
    let single = [(1, "100"); 65];
    let common = |from: &str, to: &str| COMMON.replace(from, to);
    let hold = |sections: u8| format!("{COMMON}hold_sections = {sections}\n");
    for (common, blocks, place, rule) in [
        (COMMON, &[(1, "")][..], "[]", "BLK-8 is broken: block 1: sections is 0; a block has 1 to 16 sections"),
        (
            COMMON,
            &[(1, "100"), (1, &seventeen)],
            "[100",
            "BLK-8 is broken: block 2: sections is 17; a block has 1 to 16",
        ),
        (
            COMMON,
            &[(0, "100")],
            "0",
            "BLK-8 is broken: block 1: max_trains is 0; it must be 1 to the number of sections, 1",
        ),
        (COMMON, &[(3, "100, 100")], "3", "max_trains is 3; it must be 1 to the number of sections, 2"),
        (
            &common("pass_ms = 10000", "pass_ms = 9"),
            &[(1, "100")],
            "9",
            "pass_ms is 9 ms, less than one cycle of 10 ms",
        ),
        (
            &common("pass_ms = 10000", "pass_ms = 600010"),
            &[(1, "100")],
            "600010",
            "pass_ms is 600010 ms; it must be at most 60000 cycles",
        ),
        (COMMON, &[(1, "100, 0, 100")], "0, 100]", "BLK-9 is broken: a section must have a length"),
        (COMMON, &many, "[100", "BLK-9 is broken: at most 64 sections; there are 80"),
        (COMMON, &single, "[100", "BLK-9 is broken: at most 64 sections; there are 65"),
        (
            COMMON,
            &[(1, &short), (1, "1, 1")],
            "100",
            "longest_train_m is 100; a train of this length needs more than 16 sections held",
        ),
        (
            &hold(1),
            &[(1, "100, 200"), (1, "99, 100")],
            "99, 100]",
            "what is held from here on (1 of the sections) is 99 m, and the longest train 100 m; at least 2 must be held",
        ),
        (&hold(17), &[(1, "100")], "17", "hold_sections is 17; it must be 0 to 16 sections"),
        ("", &[(1, "100")], "1", "no [detection]"),
        (COMMON, &[], "", "there is [detection] and no [[block]]"),
        (&common("longest", "largest"), &[(1, "100")], "largest", "unknown field"),
        (COMMON, &[(1, "100, 70000")], "70000", "invalid value"),
        (COMMON, &[(1, "-1")], "-1", "invalid value"),
    ] {
        let (from, text) = refused(common, blocks);
        assert!(text.contains(rule), "{text}");
        assert!(from.starts_with(place) || place.is_empty(), "{from}: {text}");
    }
}

#[test]
fn more_than_is_needed_may_be_held_and_is_said() {
    let text = with(&format!("{COMMON}hold_sections = 3\n"), &[(2, "100, 100, 100, 100"), (1, "100")]);
    let line = parse("l.toml", &text).expect("good");
    assert!(line.notes().iter().any(|note| note.contains("3 sections are held behind every head, and 1 would")));
    assert!(line.notes().iter().any(|note| note.contains("Block 2 has one section")));
    assert!(line.notes().iter().any(|note| note.contains("before the line's entry")));
}
