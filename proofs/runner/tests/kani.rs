//! Kani's names, bounds and results, on small files in the form that Kani writes.

use atc_proofs::Harness;
use atc_prover::kani::{compare, contracts, import, names};
use atc_prover::report::{HarnessResult, Verdict};
use atc_prover::{harnesses, root, select};
use serde_json::{Value, json};

#[test]
fn loops_are_unwound_as_often_as_the_sizes_ask_for() {
    for harness in harnesses() {
        assert_eq!(harness.unwind, harness.derived, "{}: the number is not what is derived", harness.name);
        assert!(harness.apart.len() <= harness.cases, "{}: more cases apart than there are", harness.name);
    }
}

/// The numbers in a bound that stand before a word for what there are many of.
fn numbers(bound: &str) -> Vec<usize> {
    let words: Vec<_> = bound.split([' ', ',']).filter(|word| !word.is_empty()).collect();
    let counted = ["circuit", "point", "section", "segment", "route", "aspect", "block", "length", "code", "speed"];
    let many = |word: &str| counted.iter().any(|start| word.starts_with(start));
    words.windows(2).filter(|pair| many(pair[1])).filter_map(|pair| pair[0].parse().ok()).collect()
}

#[test]
fn no_bound_names_more_things_than_loops_are_unwound_for() {
    assert_eq!(numbers("2 routes of up to 4 circuits, 32 circuits, tables of 4 speeds"), [2, 4, 32, 4]);
    let mut with_32 = 0;
    for harness in harnesses() {
        for number in numbers(harness.bound) {
            assert!(harness.unwind > number, "{}: {} and {}", harness.name, harness.unwind, harness.bound);
        }
        with_32 += usize::from(harness.bound.contains("32 circuits"));
        if harness.module.starts_with("atc_proofs::interlocking") {
            // The layout and the state have an entry for each of 64 circuits, whatever is drawn.
            assert!(harness.unwind > 64, "{}", harness.name);
        }
    }
    assert!(with_32 >= 20, "only {with_32}");
}

#[test]
fn a_harness_that_is_smaller_for_kani_says_so() {
    let mut smaller = 0;
    for harness in harnesses() {
        smaller += usize::from(harness.bound_kani != harness.bound);
        assert!(
            harness.bound.is_empty() || !harness.bound_kani.is_empty(),
            "{}: unbounded for Kani only",
            harness.name
        );
    }
    let mut files = Vec::new();
    for folder in ["", "aspect", "block", "interlocking", "permitted", "position", "telegram"] {
        files.extend(
            std::fs::read_dir(root().join("proofs/src").join(folder)).unwrap().map(|file| file.unwrap().path()),
        );
    }
    let mut said = 0;
    for path in files.iter().filter(|path| path.is_file()) {
        let text = std::fs::read_to_string(path).unwrap();
        let said_here = text.matches("\n    under_kani ").count();
        // Its own size, or that of the file whose layouts it draws.
        let sized = |line: &str| line.contains("const ") && line.contains("if cfg!(") && line.contains("kani");
        let mut used = text.split("\nuse ").skip(1).filter_map(|rest| rest.split(';').next());
        let has_size = text.lines().any(sized) || used.any(|names| names.contains("UNDER_KANI"));
        // A file of layouts without a harness has nothing to say.
        let has_harness = text.contains("\nharness! {");
        assert_eq!(has_size && has_harness, said_here > 0, "{}", path.display());
        said += said_here;
    }
    assert_eq!(smaller, said);
    assert!(said >= 10, "only {said}");
}

#[test]
fn every_proof_has_a_name_of_its_own() {
    let mut all: Vec<_> = harnesses().into_iter().flat_map(names).chain(contracts()).collect();
    assert!(all.contains(&"supervision::sup_3::body::kani".to_owned()), "{all:?}");
    assert!(all.contains(&"interlocking::pair::t_ilk_1::body::case_1".to_owned()), "{all:?}");
    assert!(all.contains(&"contracts::block_step".to_owned()), "{all:?}");
    let count = all.len();
    all.sort();
    all.dedup();
    assert_eq!(all.len(), count);
    let source = std::fs::read_to_string(root().join("proofs/src/contracts.rs")).unwrap();
    assert_eq!(contracts().len(), source.matches("proof_for_contract(").count());
}

/// Kani's list, in the form of file version 0.1, with these names of harnesses.
fn list(names: &[String]) -> Value {
    json!({
        "kani-version": "0.68.0",
        "file-version": "0.1",
        "standard-harnesses": { "proofs/src/supervision.rs": names[..1], "proofs/src/all.rs": names[1..] },
        "contract-harnesses": { "proofs/src/contracts.rs": contracts() },
        "contracts": [{ "function": "block::step", "file": "kernel/src/block/count.rs", "harnesses": [contracts()[0]] }],
        "totals": {
            "standard-harnesses": names.len(), "contract-harnesses": contracts().len(), "functions-under-contract": 1
        }
    })
}

#[test]
fn the_lists_are_compared_name_by_name() {
    let all: Vec<_> = harnesses().into_iter().flat_map(names).collect();
    compare(&list(&all).to_string()).unwrap();
    let with_crate: Vec<_> = all.iter().map(|name| format!("atc_proofs::{name}")).collect();
    compare(&list(&with_crate).to_string()).unwrap();
    let missing = compare(&list(&all[1..]).to_string()).unwrap_err();
    assert_eq!(missing, format!("standard-harnesses: Kani does not list {}", all[0]));
    let more: Vec<_> = all.iter().cloned().chain(["time::new::body::kani".to_owned()]).collect();
    let more = compare(&list(&more).to_string()).unwrap_err();
    assert_eq!(more, "standard-harnesses: only Kani lists time::new::body::kani");
    let mut without = list(&all);
    without["contract-harnesses"] = json!({});
    assert_eq!(compare(&without.to_string()).unwrap_err().lines().count(), contracts().len());
    let mut by_crate = list(&all);
    by_crate["standard-harnesses"] = json!({ "atc_proofs": by_crate["standard-harnesses"] });
    compare(&by_crate.to_string()).unwrap();
    assert!(compare("{").is_err() && compare("{}").is_err());
}

fn check(status: &str, description: &str, category: &str) -> Value {
    let location = json!({ "file": "proofs/src/engine.rs", "line": "115", "column": "17" });
    json!({
        "id": 1, "function": "f", "status": status, "description": description, "location": location, "category": category
    })
}

/// A proof in the form of the export, of which everything holds.
fn good(harness: &Harness, name: &str) -> Value {
    let mut checks = vec![check("Success", "attempt to add with overflow", "assertion")];
    for number in 0..8 {
        let status = if number < harness.claims.len() { "Success" } else { "Unreachable" };
        checks.push(check(status, &format!("claim {number}"), "assertion"));
        let status = if number < harness.covers.len() { "Satisfied" } else { "Unreachable" };
        checks.push(check(status, &format!("cover {number}"), "cover"));
    }
    json!({ "harness_id": name, "status": "Success", "duration_ms": 1500, "checks": checks })
}

fn export(results: &[Value]) -> Value {
    json!({
        "metadata": {
            "version": "1.0", "timestamp": "2026-11-22T07:00:00Z", "kani_version": "0.68.0",
            "target": "x86_64-unknown-linux-gnu", "build_mode": "release"
        },
        "verification_results": {
            "summary": {
                "total_harnesses": results.len(), "executed": results.len(), "status": "completed",
                "successful": results.len(), "failed": 0, "duration_ms": 1
            },
            "results": results
        }
    })
}

fn one(name: &str) -> &'static Harness {
    select(&[name.to_owned()]).unwrap()[0]
}

/// The result of a harness whose proofs are changed so.
fn with(name: &str, change: impl Fn(usize, &mut Value)) -> HarnessResult {
    let harness = one(name);
    let mut proofs: Vec<_> = names(harness).iter().map(|name| good(harness, name)).collect();
    proofs.iter_mut().enumerate().for_each(|(number, proof)| change(number, proof));
    let all = import(&export(&proofs).to_string()).unwrap().harnesses;
    all.into_iter().find(|result| result.name == name).unwrap()
}

fn set(proof: &mut Value, description: &str, status: &str) {
    let checks = proof["checks"].as_array_mut().unwrap();
    let check = checks.iter_mut().find(|check| check["description"] == description).unwrap();
    check["status"] = json!(status);
    proof["status"] = json!(if status == "Failure" { "Failure" } else { "Success" });
}

#[test]
fn a_result_is_what_every_check_says() {
    let result = with("sup_3", |_, _| {});
    assert_eq!((result.verdict, result.reason, result.engine.as_str()), (Verdict::Proved, None, "kani"));
    assert!(result.claims.iter().all(|claim| claim.verdict == Verdict::Proved));
    assert!(result.covers.iter().all(|cover| cover.hit) && result.seconds > 1.0);
    let verdict = |change: fn(&mut Value)| with("sup_3", |_, proof| change(proof)).verdict;
    assert_eq!(verdict(|proof| set(proof, "claim 0", "Failure")), Verdict::Failed);
    assert_eq!(verdict(|proof| set(proof, "claim 0", "Unreachable")), Verdict::Vacuous);
    assert_eq!(verdict(|proof| set(proof, "claim 0", "Undetermined")), Verdict::Error);
    assert_eq!(verdict(|proof| set(proof, "cover 0", "Unsatisfiable")), Verdict::Vacuous);
    assert_eq!(verdict(|proof| set(proof, "attempt to add with overflow", "Failure")), Verdict::Failed);
    assert_eq!(verdict(|proof| proof["status"] = json!("Failure")), Verdict::Error);
    assert_eq!(verdict(|proof| proof["checks"] = json!([])), Verdict::Error);
    assert_eq!(verdict(|proof| drop(proof["checks"].as_array_mut().unwrap().remove(1))), Verdict::Error);
    assert_eq!(verdict(|proof| proof["harness_id"] = json!("another")), Verdict::NotRun);
    // The claim fails, and Kani says success.
    assert_eq!(verdict(|proof| proof["checks"][1]["status"] = json!("Failure")), Verdict::Failed);
}

#[test]
fn a_bound_that_is_too_small_is_no_counterexample() {
    for (text, category) in [
        ("unwinding assertion loop 0", "unwind"),
        ("Sub-array binding is not currently supported by Kani", "unsupported_construct"),
    ] {
        let result = with("sup_3", |_, proof| {
            proof["checks"].as_array_mut().unwrap().push(check("Failure", text, category));
            proof["status"] = json!("Failure");
        });
        assert_eq!(result.verdict, Verdict::Error);
        assert!(result.reason.unwrap().contains(text));
    }
}

#[test]
fn a_harness_in_cases_needs_all_of_them() {
    let result = with("t_ilk_1", |_, _| {});
    assert_eq!(result.verdict, Verdict::Proved);
    assert_eq!(result.bound, "2 routes of up to 2 circuits, 32 circuits, 16 points");
    // A cover point need be reached in one case only; a claim must hold in each.
    assert_eq!(
        with("t_ilk_1", |case, proof| if case == 0 {
            set(proof, "cover 1", "Unsatisfiable");
        })
        .verdict,
        Verdict::Proved
    );
    assert_eq!(
        with("t_ilk_1", |case, proof| if case == 1 {
            set(proof, "claim 2", "Failure");
        })
        .verdict,
        Verdict::Failed
    );
    let missing = with("t_ilk_1", |case, proof| {
        if case == 1 {
            proof["harness_id"] = json!("another");
        }
    });
    assert_eq!(missing.verdict, Verdict::NotRun);
    assert!(missing.claims.iter().all(|claim| claim.verdict == Verdict::NotRun));
}

#[test]
fn an_export_that_was_cut_short_or_of_another_form_is_an_error() {
    let harness = one("sup_3");
    let proof = good(harness, &names(harness)[0]);
    let whole = export(std::slice::from_ref(&proof));
    assert_eq!(import(&whole.to_string()).unwrap().engine, "kani");
    let text = whole.to_string();
    assert!((0..text.len()).step_by(7).all(|length| import(&text[..length]).is_err()));
    let mut other = whole.clone();
    other["metadata"]["version"] = json!("2.0");
    assert!(import(&other.to_string()).unwrap_err().contains("2.0"));
    let mut fewer = whole.clone();
    fewer["verification_results"]["summary"]["executed"] = json!(2);
    assert!(import(&fewer.to_string()).is_err());
    let twice = import(&export(&[proof.clone(), proof]).to_string()).unwrap().harnesses;
    assert_eq!(twice.iter().find(|result| result.name == "sup_3").unwrap().verdict, Verdict::Error);
    // No harness was selected: nothing is proved.
    let none = import(&export(&[]).to_string()).unwrap().harnesses;
    assert!(none.iter().all(|result| result.verdict == Verdict::NotRun));
}
