//! Each accident that was once found is found again by the adversary when the old rule is put back, and not in the kernel as it is. And each
//! directed vector of the conformance kit catches the mutants that it names.
//!
//! What the models say of each is slower to compile, and not looked at here: `cargo run -p atc-prover -- old-rules --table`.

use atc_prover::old_rules::{Program, Programs, build};
use atc_prover::{in_parallel, root};
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
