//! What Kani says, for the case: its list of harnesses compared with ours, and its results.
//!
//! Read are `cargo kani list --format json` (file version 0.1) and `--export-json` (version 1.0, behind `-Z unstable-options`). The
//! export is known to look clean after a run that was cut short (model-checking/kani, issue 4731), so nothing is taken from what it does
//! not say: every proof must be in it, with every claim and every cover point.

use crate::harnesses;
use crate::native::blank;
use crate::report::{Campaign, HarnessResult, SCHEMA, Verdict};
use crate::{provenance, root};
use atc_proofs::Harness;
use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet};

const CRATE: &str = "atc_proofs::";

/// The names that Kani gives to the proofs of a harness: one, or one for each case that is apart.
pub fn names(harness: &Harness) -> Vec<String> {
    let module = harness.module.strip_prefix(CRATE).unwrap_or(harness.module);
    match harness.apart {
        [] => vec![format!("{module}::kani")],
        cases => cases.iter().map(|case| format!("{module}::case_{case}")).collect(),
    }
}

/// The names of the proofs of contracts.
pub fn contracts() -> Vec<String> {
    let mut found = Vec::new();
    let mut inside = false;
    for line in include_str!("../../src/contracts.rs").lines() {
        inside |= line.starts_with("#[kani::proof_for_contract(");
        if let Some(name) = line.strip_prefix("fn ").and_then(|rest| rest.split('(').next()).filter(|_| inside) {
            found.push(format!("contracts::{name}"));
            inside = false;
        }
    }
    found
}

/// Compares Kani's own list with ours.
///
/// # Errors
/// The list is no list, or a proof is in one of the two only: a line for each.
pub fn compare(list: &str) -> Result<String, String> {
    let list: Value = serde_json::from_str(list).map_err(|error| format!("Kani's list: {error}"))?;
    let ours: BTreeSet<String> = harnesses().into_iter().flat_map(names).collect();
    let mut wrong = Vec::new();
    for (kind, ours) in [("standard-harnesses", ours), ("contract-harnesses", contracts().into_iter().collect())] {
        let files = list.get(kind).ok_or_else(|| format!("Kani's list has no {kind}"))?;
        let mut theirs = BTreeSet::new();
        named(files, &mut theirs);
        wrong.extend(ours.difference(&theirs).map(|name| format!("{kind}: Kani does not list {name}")));
        wrong.extend(theirs.difference(&ours).map(|name| format!("{kind}: only Kani lists {name}")));
    }
    if wrong.is_empty() {
        let proofs = harnesses().into_iter().flat_map(names).count();
        Ok(format!(
            "{proofs} proofs of {} harnesses and {} of contracts, in both lists",
            harnesses().len(),
            contracts().len()
        ))
    } else {
        Err(wrong.join("\n"))
    }
}

/// The names below, whether by file or by crate and file.
fn named(below: &Value, names: &mut BTreeSet<String>) {
    match below {
        Value::String(name) => drop(names.insert(plain(name))),
        Value::Array(all) => all.iter().for_each(|one| named(one, names)),
        Value::Object(all) => all.values().for_each(|one| named(one, names)),
        _ => {}
    }
}

/// With or without the name of the crate.
fn plain(name: &str) -> String {
    name.strip_prefix(CRATE).unwrap_or(name).to_owned()
}

/// The results of an export that was made of this checkout, one for each harness.
///
/// # Errors
/// The export is of another form, or the sources cannot be read. (A harness that is not proved is a result.)
pub fn import(export: &str) -> Result<Campaign, String> {
    let export: Value = serde_json::from_str(export).map_err(|error| format!("Kani's export: {error}"))?;
    let metadata = &export["metadata"];
    if metadata["version"] != "1.0" {
        return Err(format!("Kani's export: version {}, and only \"1.0\" is known", metadata["version"]));
    }
    let results = export["verification_results"]["results"].as_array().ok_or("Kani's export has no results")?;
    let executed = export["verification_results"]["summary"]["executed"].as_u64();
    if executed != u64::try_from(results.len()).ok() {
        return Err(format!("Kani's export: {executed:?} proofs ran, and there are results of {}", results.len()));
    }
    let mut proofs: BTreeMap<String, Vec<&Value>> = BTreeMap::new();
    for result in results {
        let name = result["harness_id"].as_str().ok_or("Kani's export has a result without a name")?;
        proofs.entry(plain(name)).or_default().push(result);
    }
    let version = metadata["kani_version"].as_str().unwrap_or("unknown").to_owned();
    let mut provenance = provenance::of(&root(), BTreeMap::from([("kani".to_owned(), version)]), Vec::new())?;
    let results: Vec<_> = harnesses().into_iter().map(|harness| result(harness, &proofs)).collect();
    provenance.seconds = results.iter().map(|result| result.seconds).sum();
    Ok(Campaign { schema: SCHEMA, engine: "kani".to_owned(), provenance, harnesses: results })
}

/// One harness, from its proofs.
fn result(harness: &Harness, proofs: &BTreeMap<String, Vec<&Value>>) -> HarnessResult {
    let mut result = blank(harness, "kani");
    harness.bound_kani.clone_into(&mut result.bound);
    let mut verdict = Verdict::Proved;
    let mut reasons = Vec::new();
    let (mut claims, mut hit) = (vec![Verdict::Proved; result.claims.len()], vec![false; result.covers.len()]);
    for name in names(harness) {
        let (one, reason) = match proofs.get(&name).map(Vec::as_slice) {
            None => (Verdict::NotRun, Some("no result".to_owned())),
            Some([proof]) => {
                let milliseconds = proof["duration_ms"].as_u64().and_then(|time| u32::try_from(time).ok());
                result.seconds += f64::from(milliseconds.unwrap_or_default()) / 1000.0;
                judge(proof, &mut claims, &mut hit)
            }
            Some(_) => (Verdict::Error, Some("more than one result".to_owned())),
        };
        if matches!(one, Verdict::NotRun | Verdict::Error) {
            for claim in &mut claims {
                *claim = (*claim).max(one);
            }
        }
        verdict = verdict.max(one);
        reasons.extend(reason.map(|reason| format!("{name}: {reason}")));
    }
    let missed = result.covers.iter().zip(&hit).find(|(_, hit)| !**hit).map(|(cover, _)| cover.name.clone());
    if let Some(missed) = missed.filter(|_| verdict == Verdict::Proved) {
        verdict = Verdict::Vacuous;
        reasons.push(format!("the cover point {missed} is not reached"));
    }
    result.claims.iter_mut().zip(claims).for_each(|(claim, verdict)| claim.verdict = verdict);
    result.covers.iter_mut().zip(hit).for_each(|(cover, hit)| cover.hit = hit);
    result.verdict = result.claims.iter().map(|claim| claim.verdict).fold(verdict, Verdict::max);
    result.reason = (!reasons.is_empty()).then(|| reasons.join("; "));
    result
}

/// One proof: its own verdict, and what it says of claims and cover points.
fn judge(proof: &Value, claims: &mut [Verdict], hit: &mut [bool]) -> (Verdict, Option<String>) {
    let checks = proof["checks"].as_array().map(Vec::as_slice).unwrap_or_default();
    let described = |what: &str, number: usize| {
        let text = format!("{what} {number}");
        checks
            .iter()
            .filter(move |check| check["description"] == text.as_str())
            .filter_map(|check| check["status"].as_str())
    };
    let mut reason = None;
    for (number, claim) in claims.iter_mut().enumerate() {
        let said = described("claim", number).map(|status| match status {
            "Success" => Verdict::Proved,
            "Failure" => Verdict::Failed,
            "Unreachable" => Verdict::Vacuous,
            _ => Verdict::Error,
        });
        *claim = (*claim).max(said.max().unwrap_or(Verdict::Error));
    }
    for (number, hit) in hit.iter_mut().enumerate() {
        *hit |= described("cover", number).any(|status| status == "Satisfied");
    }
    let is_claim = |check: &&Value| check["description"].as_str().is_some_and(|text| text.starts_with("claim "));
    let failed: Vec<_> = checks.iter().filter(|check| check["status"] == "Failure").collect();
    let other = failed.iter().copied().find(|check| !is_claim(check));
    let verdict = match (proof["status"].as_str(), other) {
        _ if checks.is_empty() => {
            reason = Some("no checks: no answer in time, out of memory, or a crash".to_owned());
            Verdict::Error
        }
        (_, Some(check)) => {
            let text = check["description"].as_str().unwrap_or_default();
            reason = Some(text.to_owned());
            // A bound that is too small and what Kani cannot take say nothing of the theorem.
            let kind = check["category"].as_str().unwrap_or_default();
            if matches!(kind, "unwind" | "unsupported_construct") { Verdict::Error } else { Verdict::Failed }
        }
        (Some("Success"), None) if failed.is_empty() => Verdict::Proved,
        (Some("Failure"), None) if !failed.is_empty() => Verdict::Failed,
        (status, None) => {
            reason = Some(format!("the status {status:?} does not go with the checks"));
            Verdict::Error
        }
    };
    (verdict, reason)
}
