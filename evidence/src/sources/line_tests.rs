//! What the case adds to a line: the sizes for which theorems are proved. And what decides that a line is refused.

use super::{EXAMPLE, case, example};
use crate::case::{Asked, DataCheck, Matter, Outcome};
use crate::judge::open::of_checks;
use std::path::Path;

fn notes(from: &str, to: &str) -> String {
    assert!(EXAMPLE.contains(from), "{from}");
    let line = atc_line::parse("l.toml", &EXAMPLE.replacen(from, to, 1), Path::new(".")).expect("good");
    case(&line, &[]).notes.join("\n")
}

#[test]
fn a_line_beyond_what_is_proved_is_told_so() {
    assert!(notes("cycle_ms = 10", "cycle_ms = 7").contains("proved for a cycle of 10 ms"));
    assert!(notes("[25, 45, 65, 90]", "[5, 25, 45, 65, 90]").contains("has 5 aspects"));
}

#[test]
fn nothing_is_open_on_the_example() {
    let line = case(&example().expect("good"), &[]);
    assert!(
        of_checks(Matter::LineData, &line.checks).is_empty() && line.checks.iter().all(|check| check.outcome.holds())
    );
}

/// Before, a check was a sentence, and one with the letters "NO" was refused. So a line called "NORTH" had an open item that stops the
/// run, and a broken rule whose sentence did not shout had none.
#[test]
fn an_outcome_decides_and_no_word_of_a_text() {
    let check = |scope: &str, outcome| DataCheck {
        rule: "train-length".to_owned(),
        text: "No train is longer than what the ground counts on.".to_owned(),
        asked: Asked::Engineering,
        scope: scope.to_owned(),
        outcome,
    };
    let finding = |what: &str| atc_line::Finding {
        at: "l.toml:1:1".to_owned(),
        against: Some("s.toml:2:3".to_owned()),
        what: what.to_owned(),
        right: String::new(),
    };
    let met = check("the trains of “NORTH LINE”, rounded in the safe direction: NO exceptions", Outcome::Met);
    let broken = check("1 station", Outcome::Broken { why: vec![finding("one is too long")] });
    // The old rule, on what the two would have said.
    let old = |check: &DataCheck, what: &str| format!("{}: {} {what}", check.rule, check.scope).contains("NO");
    assert!(old(&met, "") && !old(&broken, "one is too long"), "the old way was wrong about both");
    assert!(of_checks(Matter::LineData, &[met]).is_empty());
    let items = of_checks(Matter::LineData, &[broken]);
    assert_eq!(items.len(), 1);
    assert_eq!(items[0].about, "l.toml:1:1");
    assert_eq!(items[0].text, "one is too long (against s.toml:2:3) [train-length]");
}
