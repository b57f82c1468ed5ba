//! The algebra of motion: Z3 proves it as it stands, and refutes it as soon as a part is left out.

use atc_prover::report::Verdict;
use atc_prover::{Options, Tools, reals, root, select};

const NAME: &str = "t_atc_8";

fn text() -> String {
    text_of(NAME)
}

fn text_of(name: &str) -> String {
    std::fs::read_to_string(root().join("proofs/reals").join(format!("{name}.smt2"))).expect("the file")
}

/// What is said of a text, and why; nothing without Z3.
fn say(text: &str) -> Option<(Verdict, String)> {
    say_of(NAME, text)
}

fn say_of(name: &str, text: &str) -> Option<(Verdict, String)> {
    let tools = Tools::find(&root()).ok().filter(|tools| tools.versions.contains_key("z3"));
    let Some(tools) = tools else {
        println!("NOT RUN: Z3 is not here");
        return None;
    };
    let thread = std::thread::current().name().unwrap_or_default().to_owned();
    let folder = root().join("target/proofs/reals-tested").join(thread);
    let limit = std::time::Duration::from_secs(3);
    let options = Options { folder, limit, ..Options::default() };
    let harness = select(&[name.to_owned()]).expect("the harness")[0];
    let result = reals::prove(&tools, &options, harness, text);
    Some((result.verdict, result.reason.unwrap_or_default()))
}

#[test]
fn each_file_is_of_a_harness_and_is_proved() {
    for file in std::fs::read_dir(root().join("proofs/reals")).expect("the folder") {
        let name = file.expect("a file").path().file_stem().expect("a name").to_string_lossy().into_owned();
        assert_eq!(select(std::slice::from_ref(&name)).expect("a harness of that name").len(), 1);
        let Some(said) = say_of(&name, &text_of(&name)) else { return };
        assert_eq!(said, (Verdict::Proved, String::new()), "{name}");
    }
}

/// Without the one brake or the other, and with the age once.
#[test]
fn a_brake_that_is_not_held_is_refuted() {
    let right = text_of("t_atc_8_brakes");
    for (find, replace) in [
        ("(and numbers (holds weaker) (holds stronger))", "(and numbers (holds stronger))"),
        ("(and numbers (holds weaker) (holds stronger))", "(and numbers (holds weaker))"),
        ("(<= between stronger)", "true"),
    ] {
        assert!(right.contains(find), "{find}");
        let Some((said, reason)) = say_of("t_atc_8_brakes", &right.replace(find, replace)) else { return };
        assert_eq!(said, Verdict::Failed, "{replace}: {reason}");
    }
}

/// Each with what is wrong, and who says so.
const WRONG: [(&str, &str, &str, Verdict); 8] = [
    ("the age once", "(square (+ code age))", "(+ (square code) (* 2.0 code age))", Verdict::Failed),
    ("no age", "(square (+ code age))", "(square code)", Verdict::Failed),
    ("faster than the code", "(<= next code)))", "(<= next (+ code 1.0))))", Verdict::Failed),
    ("older than the age", "(<= (+ since time) age)))", "true))", Verdict::Failed),
    ("a weaker brake", "(<= (+ next time) speed)", "(<= (+ next (* 0.9 time)) speed)", Verdict::Failed),
    ("a run that is half", "(= run (* (+ speed next) time))", "(= run (* 0.5 (+ speed next) time))", Verdict::Proved),
    (
        "no number is one",
        "Bool (and numbers (stops speed room)",
        "Bool (and false numbers (stops speed room)",
        Verdict::Vacuous,
    ),
    ("a part that is not there", "; claim Stops", "; claim Stop", Verdict::Error),
];

#[test]
fn what_is_wrong_is_refuted() {
    for (what, find, replace, verdict) in WRONG {
        let right = text();
        assert!(right.contains(find), "{what}");
        let Some((said, reason)) = say(&right.replace(find, replace)) else { return };
        // A train that runs less keeps what it keeps: not all that differs is wrong.
        assert_eq!(said, verdict, "{what}: {reason}");
    }
}

#[test]
fn a_file_that_supposes_something_is_refused() {
    let more = [
        "(assert false)",
        "( assert false)",
        "(define-fun not ((x Bool)) Bool false)",
        "(define-fun-rec f () Bool (not f))",
        "(define-fun + ((x Real) (y Real)) Real x)",
        "(declare-const more Int)",
        "(define-fun more () Real (+ 1.0 |;| 2.0))",
        "(check-sat)",
        "(define-fun open () Bool",
        "sat",
    ];
    for more in more {
        let Some((said, reason)) = say(&format!("{}\n{more}\n", text())) else { return };
        assert_eq!(said, Verdict::Error, "{more}");
        assert!(reason.contains("definition"), "{more}: {reason}");
    }
}
