//! The second opinion: SPIN agrees on every twin, and a wrong twin is found out.
//!
//! Without SPIN (`ci/install-provers` fetches it) only this is checked: that nothing is said to agree.

use atc_models::spin::{Spin, Twin, opinion, opinions_on};
use atc_models::{Agreement, Entry, Outcome, SecondOpinion, catalogue, check, in_parallel};
use std::fs;
use std::process::{Command, Output};

const TWINS: &[&str] = &[
    "block-3x2",
    "block-4x2",
    "block-3x3",
    "block-fault-3x2",
    "block-fault-4x2",
    "block-fault-3x3",
    "block-fault-5x3",
    "block-fault-long-trains",
    "block-two-faults",
    "block-two-faults-4x2",
    "block-two-faults-3x3",
    "block-no-hold",
];

/// The smallest of each kind; `ci/evidence` asks SPIN about all.
const ASKED: &[&str] = &["block-3x2", "block-fault-3x2", "block-two-faults"];

#[test]
fn every_twin_is_asked_about() {
    let all = catalogue();
    let models: Vec<_> = all.iter().filter(|entry| entry.twin.is_some()).map(|entry| entry.name).collect();
    assert_eq!(models, TWINS);
}

#[test]
fn spin_agrees_on_the_twins() {
    let here = Spin::find().is_ok();
    let asked: Vec<_> = ASKED.iter().map(|name| entry(name)).collect();
    for second in opinions_on(&asked, &[], 2, |_| {}) {
        let expected = if here { Agreement::Agrees } else { Agreement::NotRun };
        assert_eq!(second.verdict, expected, "{}: {:?}", second.model, second.reason);
        assert_eq!(second.states.is_some(), here, "{}", second.model);
        assert_eq!(second.reason.is_none(), here, "{}", second.model);
        assert_eq!(second.version.is_empty(), !here, "{}", second.model);
        assert!(!second.is_wrong(), "{}", second.model);
    }
}

fn entry(name: &str) -> Entry {
    catalogue().into_iter().find(|entry| entry.name == name).expect("in the catalogue")
}

/// SPIN's opinion on the twin of a model with `from` in its text replaced by `to`.
fn opinion_on_changed(entry: &Entry, outcome: &Outcome, (from, to): (&str, &str)) -> SecondOpinion {
    let twin = entry.twin.clone().expect("a twin");
    assert_eq!(twin.promela.matches(from).count(), 1, "{from}");
    let changed = Twin { promela: twin.promela.replace(from, to).into(), ..twin };
    opinion(&Spin::find(), &changed, outcome)
}

/// What is changed in the Promela, and what the difference must name.
const CHANGES: &[(&str, &str, &str)] = &[
    // Wrong machines.
    ("if :: agreed -> reported = heard :: else -> reported = EVERY fi", "reported = heard", "train-reported"),
    ("agreed = status == COUNTING && count == c1", "agreed = status == COUNTING && count <= c1", "states"),
    (":: asked <= HOLD ->", ":: asked < HOLD ->", "train-reported"),
    ("number == c1 && number <= TRAINS &&", "", "states"),
    ("rising_in = check_in && check_in_for == 0", "rising_in = check_in", "states"),
    ("status == COUNTING && check_in_for > PASS ->", "status == COUNTING && check_in_for > PASS + 1 ->", "states"),
    ("rising_out && count == 0 ->", "false ->", "valid"),
    // Another environment.
    (":: check_out_lost && leaving ::", "::", "states"),
    ("since < APART || entering", "since < APART - 1 || entering", "states"),
    ("MAY_FAIL(wrong_staff = true);", "", "steps"),
    // Another question.
    (
        "ltl never_agreement { [] !(agree ",
        "ltl never_agreement { [] !(false ",
        "agreement is not reached, reached here",
    ),
];

#[test]
fn a_wrong_twin_differs() {
    let entry = entry("block-fault-3x2");
    let outcome = check(&entry, 1);
    let opinions = in_parallel(
        CHANGES,
        4,
        |(from, to, named)| (opinion_on_changed(&entry, &outcome, (from, to)), *from, *named),
        |_| {},
    );
    for (second, from, named) in opinions {
        if Spin::find().is_err() {
            assert_eq!(second.verdict, Agreement::NotRun);
            continue;
        }
        let reason = second.reason.clone().unwrap_or_default();
        assert_eq!(second.verdict, Agreement::Differs, "{from}: {reason}");
        assert!(second.is_wrong() && reason.contains(named), "{from}: {reason}");
    }
}

#[test]
fn a_wrong_machine_differs_from_the_twin() {
    let entry = entry("block-fault-3x2");
    // The same environment around a machine that does not compare.
    let wrong = check(&self::entry("block-no-comparison"), 1);
    let second = opinion(&Spin::find(), entry.twin.as_ref().expect("a twin"), &wrong);
    let expected = if Spin::find().is_ok() { Agreement::Differs } else { Agreement::NotRun };
    assert_eq!(second.verdict, expected);
    let reason = second.reason.unwrap_or_default();
    assert!(Spin::find().is_err() || reason.contains("train-unreported is not reached, reached here"), "{reason}");
}

#[test]
fn a_twin_that_cannot_be_run_has_no_result() {
    let entry = entry("block-3x2");
    let outcome = check(&entry, 1);
    for change in [("active proctype", "active proktype"), ("ltl valid {", "ltl other {"), ("byte count;", "byte cnt;")]
    {
        let second = opinion_on_changed(&entry, &outcome, change);
        assert_eq!(second.verdict, Agreement::NotRun, "{change:?}");
        assert_eq!(second.states, None);
        assert!(second.reason.as_ref().is_some_and(|reason| !reason.is_empty()));
        assert_eq!(second.is_wrong(), Spin::find().is_ok(), "{change:?}");
    }
}

fn models(provers: Option<&str>, arguments: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_models"));
    match provers {
        Some(word) => command.env("PROVERS", word),
        None => command.env_remove("PROVERS"),
    };
    command.args(arguments).output().expect("the command runs")
}

#[test]
fn without_spin_nothing_is_run_and_nothing_agrees() {
    let output = models(Some("none"), &["spin", "block-3x2", "block-no-hold"]);
    assert_eq!(output.status.code(), Some(0));
    let text = String::from_utf8(output.stdout).expect("text");
    assert_eq!(text.matches("not run: PROVERS=none").count(), 2, "{text}");
    assert!(text.ends_with("spin agrees on 0 of 2 models\n"), "{text}");
    let required = models(Some("none"), &["spin", "--require", "block-3x2"]);
    assert_eq!(required.status.code(), Some(1));
    let text = String::from_utf8(models(Some("none"), &["bench", "--runs", "1"]).stdout).expect("text");
    assert_eq!(text.matches("PROVERS=none").count(), 2, "{text}");
}

#[test]
fn the_command_writes_the_opinions() {
    let file = std::env::temp_dir().join(format!("atc-models-spin-{}.json", std::process::id()));
    let name = file.to_str().expect("a path in UTF-8");
    let output = models(None, &["spin", "--json", name, "block-3x2"]);
    let text = fs::read_to_string(&file).expect("the file");
    fs::remove_file(&file).expect("removed");
    assert!(output.status.success());
    let opinions: Vec<SecondOpinion> = serde_json::from_str(&text).expect("opinions");
    assert_eq!(opinions.len(), 1);
    assert_eq!((opinions[0].model.as_str(), opinions[0].tool.as_str()), ("block-3x2", "spin"));
    assert_eq!(opinions[0].states, Spin::find().is_ok().then_some(101));
}

#[test]
fn a_model_without_a_twin_is_an_error() {
    for (name, message) in
        [("border", "border is not written in Promela; there are block-3x2, "), ("bordre", "there is no model bordre")]
    {
        let output = models(None, &["spin", name]);
        assert_eq!(output.status.code(), Some(2));
        let text = String::from_utf8(output.stderr).expect("text");
        assert!(text.contains(message), "{text}");
    }
}
