//! A case whose sources have changed since: what is stale, and everything that follows from it.

use crate::case::{Case, Kind, Matter, OpenItem, Severity};
use crate::judge::argument::{conclusions, resolve, roll_up};
use crate::judge::build::{Required, status};
use crate::judge::verdict::Verdict;
use crate::sources::{measured, second};

/// Whether a change in this folder makes this kind of evidence stale.
fn touches(folder: &str, kind: Kind) -> bool {
    match folder {
        "kernel" | "arithmetic" | "Cargo.lock" => true,
        "proofs" => matches!(kind, Kind::Harness | Kind::Mutant | Kind::Test),
        "models" => matches!(kind, Kind::Model | Kind::Test),
        "waveform" => matches!(kind, Kind::Measured | Kind::Test),
        // A trace of a model is in the protocol's messages, which know layouts and lines.
        "protocol" | "layout" | "line" => matches!(kind, Kind::Model | Kind::Test),
        "oracle" | "tests" | "evidence" => kind == Kind::Test,
        _ => false,
    }
}

/// Marks what belongs to other sources, and works out again whatever rests on it.
pub fn mark(case: &mut Case, changed: &[String]) {
    for one in &mut case.evidence {
        let touched: Vec<_> = changed.iter().filter(|folder| touches(folder, one.kind)).cloned().collect();
        if !touched.is_empty() && one.verdict < Verdict::Stale && one.verdict != Verdict::NotRun {
            one.verdict = Verdict::Stale;
            one.reason = Some(format!("changed since: {}", touched.join(", ")));
            for claim in &mut one.claims {
                claim.verdict = claim.verdict.max(Verdict::Stale);
            }
        }
    }
    for folder in changed {
        let text = format!("{folder} has changed since the engines ran: run again.");
        case.open_items.push(OpenItem {
            severity: Severity::Open,
            matter: Matter::Stale,
            about: "stale".to_owned(),
            text,
        });
    }
    let known: Vec<_> = case.evidence.iter().map(|one| one.id.clone()).collect();
    let verdict = |id: &str| case.evidence.iter().find(|one| one.id == id).map(|one| one.verdict);
    let worst = |references: &[String]| {
        let ids = references.iter().flat_map(|reference| resolve(reference, &known).unwrap_or_default());
        Verdict::worst(ids.filter_map(|id| verdict(&id)))
    };
    for node in &mut case.argument {
        if let Some(reference) = &node.evidence {
            node.verdict = worst(std::slice::from_ref(reference)).or(Some(Verdict::NotRun));
        }
        for doubt in node.defeaters.iter_mut().filter(|doubt| !doubt.open) {
            let evidence: Vec<_> = doubt.evidence.iter().filter(|id| !id.starts_with("engine:")).cloned().collect();
            if worst(&evidence).is_some_and(|worst| !worst.holds()) || !changed.is_empty() {
                doubt.open = true;
                doubt.reason = Some("the answer rests on what is stale".to_owned());
            }
        }
    }
    roll_up(&mut case.argument);
    for hazard in &mut case.hazards {
        hazard.verdict = worst(&hazard.mitigated_by).unwrap_or(Verdict::NotRun);
    }
    for accident in &mut case.accidents {
        accident.verdict = worst(&accident.excluded_by).unwrap_or(Verdict::NotRun);
    }
    for requirement in &mut case.requirements {
        requirement.verdict = worst(&requirement.harnesses).unwrap_or(Verdict::NotRun);
    }
    for opinion in case.second_opinions.iter_mut().filter(|opinion| opinion.verdict.holds()) {
        if changed.iter().any(|folder| touches(folder, Kind::Model)) {
            opinion.verdict = Verdict::Stale;
        }
    }
    for engine in case.engines.iter_mut().filter(|engine| engine.verdict.holds()) {
        let kind = match engine.name.as_str() {
            second::ENGINE => Kind::Model,
            measured::ENGINE => Kind::Measured,
            _ => Kind::Harness,
        };
        if changed.iter().any(|folder| touches(folder, kind)) {
            engine.verdict = Verdict::Stale;
        }
    }
    for technique in &mut case.techniques {
        let engines = technique.evidence.iter().filter_map(|id| id.strip_prefix("engine:"));
        let by: Vec<_> = engines.filter_map(|name| case.engines.iter().find(|engine| engine.name == name)).collect();
        technique.verdict =
            Verdict::worst(worst(&technique.evidence).into_iter().chain(by.iter().map(|one| one.verdict)));
    }
    for (id, theorem) in &mut case.line.theorems {
        *theorem = verdict(id).unwrap_or(Verdict::NotRun);
        // What held the line's data against the rules was another checker.
        if changed.iter().any(|folder| ["line", "layout"].contains(&folder.as_str())) {
            *theorem = (*theorem).max(Verdict::Stale);
        }
    }
    for (id, theorem) in case.station.iter_mut().flat_map(|station| &mut station.theorems) {
        *theorem = verdict(id).unwrap_or(Verdict::NotRun);
        // What held the layout against the rules was another checker.
        if changed.iter().any(|folder| folder == "layout") {
            *theorem = (*theorem).max(Verdict::Stale);
        }
    }
    for rule in &mut case.needed_rules {
        rule.verdict = worst(&rule.mutants);
    }
    case.conclusions = conclusions(&case.argument, &case.evidence, &case.conditions);
    case.conclusions.extend(case.station.as_ref().map(crate::station::conclusion));
    case.open_items = crate::judge::open::grouped(std::mem::take(&mut case.open_items));
    let required = if case.status.required.is_some() { Required::Proved } else { Required::NoDefect };
    case.status = status(case, required);
}
