//! Open items: everything that is not as it should be. They stand above every summary.

use crate::case::{Case, DataCheck, Evidence, Finding, Kind, Matter, OpenItem, Severity, Station};
use crate::judge::plan::Plan;
use crate::judge::trace::own_kills;
use crate::judge::verdict::{Verdict, list};
use crate::sources::measured;
use crate::sources::requirements::mismatch;
use crate::station::needed;
use std::collections::BTreeMap;

/// The open items of a case, the worst first. `cited`: what the citation check has to say beyond the plan.
pub fn items(plan: &Plan, case: &Case) -> Vec<OpenItem> {
    let mut items = Vec::new();
    results(&case.evidence, &mut items);
    requirements(case, &mut items);
    for node in &case.argument {
        for doubt in node.defeaters.iter().filter(|doubt| doubt.open) {
            let reason = doubt.reason.clone().unwrap_or_default();
            items.push(item(
                Severity::Open,
                Matter::Defeater,
                &node.id,
                format!("Defeater “{}”: {reason}", doubt.text),
            ));
        }
    }
    for engine in &case.engines {
        let mut notes: Vec<String> = Vec::new();
        for one in case.evidence.iter().flat_map(|evidence| evidence.engines.iter().map(move |one| (evidence, one))) {
            let (evidence, result) = one;
            if result.engine == engine.name && result.verdict.is_defect() && evidence.verdict.holds() {
                notes.push(format!("{}: {}", evidence.id, result.note));
            }
        }
        let missed: Vec<_> = case
            .evidence
            .iter()
            .flat_map(|evidence| evidence.engines.iter().map(move |one| (evidence, one)))
            .filter(|(_, one)| one.engine == engine.name && one.verdict.holds() && !one.note.is_empty())
            .map(|(evidence, one)| format!("{}: {}", evidence.id, one.note))
            .collect();
        if !missed.is_empty() {
            items.push(item(Severity::Note, Matter::Engine, &engine.name, format!("{}.", list(&missed, 3))));
        }
        if !notes.is_empty() {
            let text = format!("No result, though another engine has one. {}.", list(&notes, 3));
            items.push(item(Severity::Open, Matter::Engine, &engine.name, text));
        } else if engine.verdict == Verdict::NotRun {
            let text = format!("This engine has no result. To run it: `{}`.", engine.command);
            items.push(item(Severity::Open, Matter::Engine, &engine.name, text));
        }
    }
    for citation in &plan.citations {
        if let Some(text) = mismatch(citation, &plan.requirements) {
            items.push(item(Severity::Open, Matter::Citation, &citation.anchor, text));
        }
    }
    items.extend(of_data(case));
    items.extend(needed::open(&case.needed_rules));
    for condition in case.conditions.iter().filter(|condition| condition.used_by.is_empty()) {
        let text = format!("The assumption \"{}\" is listed and used nowhere.", condition.id);
        items.push(item(Severity::Note, Matter::Assumption, &condition.number, text));
    }
    if !plan.raise.is_empty() {
        let text =
            format!("More than it pins ({}): raise it, so that nothing can be lost again.", plan.raise.join("; "));
        items.push(item(Severity::Note, Matter::Ratchet, "evidence/ratchet.toml", text));
    }
    match (&case.provenance.commit, case.provenance.dirty) {
        (None, _) => items.push(item(
            Severity::Note,
            Matter::Provenance,
            "provenance",
            "Not a git checkout: the case is bound to the hashes of its sources only.".to_owned(),
        )),
        (Some(_), Some(true)) => items.push(item(
            Severity::Note,
            Matter::Provenance,
            "provenance",
            "The checkout differs from its commit: only the hashes say what was checked.".to_owned(),
        )),
        _ => {}
    }
    let searched = case.evidence.iter().any(|one| one.kind == Kind::Model && one.verdict.is_result());
    if searched && case.cut_sets.is_empty() {
        let text =
            "No model enumerates minimal cut sets: nobody knows which faults together reach a hazard.".to_owned();
        items.push(item(Severity::Open, Matter::Faults, "cut sets", text));
    }
    // Only a run of all tests has those of the documentation.
    let tested = |id: &str| case.evidence.iter().any(|one| one.id.starts_with(id) && one.verdict.is_result());
    if tested("test:all") && !tested("test:doc:") {
        let text = "The tests that this case names ran, with the unit tests of all libraries. `ci/test` runs the others as well: \
                    those of commands, imports, pages and C. (In this run: `--all-tests`.)";
        items.push(item(Severity::Note, Matter::Tests, "tests", text.to_owned()));
    }
    for mode in case.failure_modes.iter().filter(|mode| !mode.safe) {
        let text = format!("The single fault \"{}\" is not safe: only a condition excludes it.", mode.fault);
        items.push(item(Severity::Note, Matter::Faults, &mode.model, text));
    }
    for model in case.models.iter().filter(|model| model.charts.iter().any(|chart| chart.svg.is_empty())) {
        let text = "The oracle cannot replay and draw its trace: see the caption.".to_owned();
        items.push(item(Severity::Open, Matter::Chart, &model.id, text));
    }
    let source = &case.measurements.source;
    if !source.is_empty() && source != measured::HERE {
        let text = format!("The figures were {source}: nothing says that they are of these sources.");
        items.push(item(Severity::Open, Matter::Figures, measured::ENGINE, text));
    }
    grouped(items)
}

/// The rules that a station's layout breaks.
pub fn of_station(station: &Station) -> Vec<OpenItem> {
    of_checks(Matter::StationData, &station.checks)
}

/// The rules that the data of line and station break.
pub fn of_data(case: &Case) -> Vec<OpenItem> {
    let line = of_checks(Matter::LineData, &case.line.checks);
    line.into_iter().chain(case.station.iter().flat_map(of_station)).collect()
}

/// Where data break rules.
pub fn of_checks(matter: Matter, checks: &[DataCheck]) -> Vec<OpenItem> {
    let told = |rule: &DataCheck, found: &Finding| {
        let right = if found.right.is_empty() { String::new() } else { format!("; {}", found.right) };
        let against = found.against.as_ref().map_or_else(String::new, |against| format!(" (against {against})"));
        item(Severity::Stop, matter, &found.at, format!("{}{right}{against} [{}]", found.what, rule.rule))
    };
    checks.iter().flat_map(|rule| rule.findings().iter().map(move |found| told(rule, found))).collect()
}

/// The worst first; the same text about many things is one item.
pub fn grouped(mut items: Vec<OpenItem>) -> Vec<OpenItem> {
    items.sort_by(|a, b| (a.severity, a.matter, &a.text, &a.about).cmp(&(b.severity, b.matter, &b.text, &b.about)));
    items.dedup();
    let mut groups: Vec<OpenItem> = Vec::new();
    for item in items {
        match groups.last_mut() {
            Some(last) if (last.severity, last.matter, &last.text) == (item.severity, item.matter, &item.text) => {
                last.about = format!("{}, {}", last.about, item.about);
            }
            _ => groups.push(item),
        }
    }
    groups.sort();
    groups
}

fn item(severity: Severity, matter: Matter, about: &str, text: String) -> OpenItem {
    OpenItem { severity, matter, about: about.to_owned(), text }
}

/// What is wrong with single results. The same reason for many is one item.
fn results(evidence: &[Evidence], items: &mut Vec<OpenItem>) {
    let mut groups: BTreeMap<(Verdict, Kind, String), Vec<String>> = BTreeMap::new();
    for one in evidence.iter().filter(|one| !one.verdict.holds()) {
        let reason = one.why().to_owned();
        groups.entry((one.verdict, one.kind, reason)).or_default().push(one.title.clone());
    }
    for ((verdict, kind, reason), names) in groups {
        let severity = if verdict.is_defect() { Severity::Stop } else { Severity::Open };
        let about = if names.len() == 1 { names[0].clone() } else { format!("{} {}", names.len(), plural(kind)) };
        let which = if names.len() == 1 { String::new() } else { format!(" ({})", list(&names, 4)) };
        items.push(item(severity, Matter::Result, &about, format!("{verdict}: {reason}{which}")));
    }
}

/// The plural of a kind of evidence.
pub fn plural(kind: Kind) -> &'static str {
    match kind {
        Kind::Harness => "theorem harnesses",
        Kind::Model => "models",
        Kind::Mutant => "wrong kernels",
        Kind::Measured => "measured targets",
        Kind::Test => "test suites",
    }
}

/// What is wrong with requirements: no theorem, no code, no wrong kernel that its own theorem rejects.
fn requirements(case: &Case, items: &mut Vec<OpenItem>) {
    for requirement in &case.requirements {
        let mut open =
            |text: &str| items.push(item(Severity::Open, Matter::Requirement, &requirement.id, text.to_owned()));
        if requirement.harnesses.is_empty() {
            open(if requirement.tests.is_empty() {
                "No theorem and no test names it."
            } else {
                "No theorem: it is only tested."
            });
        }
        if requirement.code.is_empty() {
            open("No line of the code quotes it.");
        }
        if requirement.mutants.is_empty() {
            open("No named wrong kernel: nobody has shown that its proof would notice one.");
        } else {
            let run = |one: &&Evidence| requirement.mutants.contains(&one.id) && one.verdict.is_result();
            let some_ran = case.evidence.iter().any(|one| run(&one));
            if some_ran && !requirement.harnesses.is_empty() && own_kills(requirement, &case.evidence).is_empty() {
                open("None of its wrong kernels is rejected by its own theorem.");
            }
        }
        let survivors: Vec<_> = case
            .evidence
            .iter()
            .filter(|one| one.verdict == Verdict::Failed && requirement.mutants.contains(&one.id))
            .map(|one| one.title.clone())
            .collect();
        if !survivors.is_empty() {
            let text = format!(
                "The wrong kernel {} survives: the theorems on it ({}) are too weak.",
                survivors.join(", "),
                list(&requirement.harnesses, 4)
            );
            items.push(item(Severity::Stop, Matter::Requirement, &requirement.id, text));
        }
    }
}
