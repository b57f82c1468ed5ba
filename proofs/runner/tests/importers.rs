//! Every wrong importer of `layout/mutants.toml` is found out: no wrong route is left, and some are left out.

use atc_prover::importers::{all_tried, list, right};
use atc_prover::old_rules::{Program, build};
use atc_prover::root;

#[test]
fn no_wrong_importer_leaves_a_wrong_route() {
    let all = list(&root()).expect("layout/mutants.toml");
    assert!(all.len() >= 25, "only {} wrong importers", all.len());
    let programs = build(&root(), &[Program::Adversary, Program::Importers]).expect("the copy compiles");
    let right = right(&programs).expect("the right importer runs");
    for (form, lines) in &right {
        assert!(lines.len() > 150, "only {} lines of {form}", lines.len());
    }
    let mut missed = Vec::new();
    let tried = all_tried(&programs, &all, &right).expect("the wrong importers run");
    for (one, tried) in all.iter().zip(&tried) {
        println!(
            "{}: {} routes are left out, the second reading differs in {} stations, {} routes are wrong",
            one.name,
            tried.left_out,
            tried.found_out,
            tried.wrong.len()
        );
        tried.wrong.iter().skip(1).for_each(|wrong| println!("    {wrong}"));
        match tried.wrong.first() {
            Some(first) => missed.push(format!("{} ({}): {first}", one.name, one.what)),
            None if tried.left_out + tried.found_out == 0 => {
                missed.push(format!("{} ({}): nothing is different", one.name, one.what));
            }
            None => {}
        }
    }
    assert!(missed.is_empty(), "not found out:\n{}", missed.join("\n"));
}
