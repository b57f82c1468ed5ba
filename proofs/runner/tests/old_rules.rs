//! Each accident that was once found is found again by the adversary when the old rule is put back, and not in the kernel as it is. And each
//! directed vector of the conformance kit catches the mutants that it names.
//!
//! What the models say of each is slower to compile, and not looked at here: `cargo run -p atc-prover -- old-rules --table`.

use atc_prover::old_rules::{Program, Programs, build};
use atc_prover::{in_parallel, root};
use std::collections::BTreeSet;
use std::sync::LazyLock;
use std::time::Instant;

static PROGRAMS: LazyLock<Programs> = LazyLock::new(|| {
    let programs = [Program::Adversary, Program::Importers, Program::Vectors];
    build(&root(), &programs).expect("the kernel with old rules compiles")
});

#[test]
fn each_known_fault_is_found_when_the_old_rule_is_put_back_and_not_without() {
    let programs = &*PROGRAMS;
    let known = programs.known().expect("the adversary knows faults");
    assert!(known.len() >= 11, "only {} faults", known.len());
    in_parallel(2, known.len(), |number| {
        let fault = &known[number];
        let started = Instant::now();
        let found = programs.hunt(fault, &fault.mutants).expect("the adversary runs").found;
        let (after, accident) = found.unwrap_or_else(|| panic!("{}: not found with {:?}", fault.name, fault.mutants));
        let seconds = started.elapsed().as_secs_f64();
        println!("{}: {:?}: after {after} cycles, {seconds:.1} s: {accident}", fault.name, fault.mutants);
        let control = programs.hunt(fault, &[]).expect("the adversary runs").found;
        assert_eq!(control, None, "{}: found in the kernel as it is, too", fault.name);
    });
}

#[test]
fn each_directed_vector_catches_the_mutants_that_it_names() {
    let mut vectors = PROGRAMS.with(Program::Vectors, &[]).expect("it is compiled");
    let output = vectors.args(["--directed", "yes"]).output().expect("it runs");
    let said = String::from_utf8_lossy(&output.stdout);
    println!("{said}");
    assert!(output.status.success(), "{said}");
    assert!(
        said.lines().last().is_some_and(|last| last.contains(" of ") && last.contains(" mutants are caught")),
        "{said}"
    );
}

/// Of the mutants that a session can show, how many in a hundred the minimal vectors catch at least.
const CAUGHT_PERCENT: usize = 98;

/// `oracle/vectors/caught.tsv` has a vector beside each mutant that the minimal set catches, `unseen.toml` those that no session shows.
#[test]
fn the_minimal_vectors_catch_the_mutants_that_a_session_can_show() {
    let folder = root().join("oracle/vectors");
    let mut vectors = PROGRAMS.with(Program::Vectors, &[]).expect("it is compiled");
    let output = vectors.arg("--caught").arg(folder.join("caught.tsv")).output().expect("it runs");
    let said = String::from_utf8_lossy(&output.stdout);
    assert!(output.status.success(), "{said}{}", String::from_utf8_lossy(&output.stderr));
    let read = |name: &str| std::fs::read_to_string(folder.join(name)).expect("a file of the project");
    let (caught, unseen) = (read("caught.tsv"), read("unseen.toml"));
    let caught: BTreeSet<&str> = caught.lines().filter_map(|line| line.split('\t').next()).collect();
    let unseen: toml::Table = toml::from_str(&unseen).expect("TOML");
    let groups = unseen["unseen"].as_array().expect("groups");
    let names = |group: &toml::Value| group["mutants"].as_array().cloned().unwrap_or_default();
    let unseen: Vec<String> =
        groups.iter().flat_map(names).filter_map(|name| name.as_str().map(ToOwned::to_owned)).collect();
    // Those of the importers are no mutants of the kernel.
    let kernel = atc_prover::mutants::list(&root()).expect("the mutants");
    let all: BTreeSet<&str> = kernel.iter().map(|mutant| mutant.name.as_str()).collect();
    let all: BTreeSet<&str> = all.into_iter().filter(|name| PROGRAMS.mutants().contains(*name)).collect();
    for name in &unseen {
        assert!(all.contains(name.as_str()), "unseen.toml names {name}, which cannot be selected");
        assert!(!caught.contains(name.as_str()), "{name} is said to be unseen, and is caught");
    }
    assert_eq!(caught.difference(&all).next(), None, "caught.tsv names what is no mutant");
    let seen = all.len() - unseen.len();
    let missed: Vec<_> = all.difference(&caught).filter(|name| !unseen.iter().any(|unseen| unseen == *name)).collect();
    println!("{said}{} of {seen} mutants that a session can show are caught; not {missed:?}", caught.len());
    assert!(caught.len() * 100 >= seen * CAUGHT_PERCENT, "{} of {seen}; not {missed:?}", caught.len());
}
