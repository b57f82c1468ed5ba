//! State-space models: what was searched, what was found, and the charts of the hazards.

use super::{owned, truth};
use crate::case::{Chart, Claim, Evidence, Kind, Model, Property};
use crate::judge::verdict::Verdict;
use atc_models::{Expectation, Outcome, PropertyOutcome, Step, Trace, Verdict as Search};
use atc_oracle::chart::{self, View};
use atc_oracle::trace::{Replies, Trace as Record};
use serde_json::Value;

/// What a model is, apart from any result.
#[derive(Clone, Debug)]
pub struct ModelInfo {
    /// Its name.
    pub name: String,
    /// What it shows, in plain English.
    pub statement: String,
    /// Requirements and theorems that it checks.
    pub requirements: Vec<String>,
    /// The assumptions in force.
    pub assumptions: Vec<String>,
}

/// The models of `atc-models`, in its order.
pub fn catalogue() -> Vec<ModelInfo> {
    let entries = atc_models::catalogue();
    entries
        .iter()
        .map(|entry| ModelInfo {
            name: entry.name.to_owned(),
            statement: entry.statement.clone(),
            requirements: owned(entry.requirements),
            assumptions: owned(entry.in_force),
        })
        .collect()
}

/// The evidence id of a model.
pub fn id(name: &str) -> String {
    format!("model:{name}")
}

/// The evidence of every model, and what belongs with it. A model without an outcome is not run.
pub fn evidence(catalogue: &[ModelInfo], outcomes: &[Outcome], why_not: &str) -> (Vec<Evidence>, Vec<Model>) {
    catalogue
        .iter()
        .map(|model| {
            let mine: Vec<_> = outcomes.iter().filter(|outcome| outcome.model == model.name).collect();
            match mine[..] {
                [] => (bare(model, Verdict::NotRun, why_not), nothing(model)),
                [outcome] => judged(model, outcome),
                _ => (bare(model, Verdict::Undecided, "more than one outcome"), nothing(model)),
            }
        })
        .unzip()
}

fn judged(model: &ModelInfo, outcome: &Outcome) -> (Evidence, Model) {
    let properties: Vec<_> = outcome.properties.iter().map(|one| property(one, outcome.complete)).collect();
    let worst = Verdict::worst(properties.iter().map(|one| one.verdict));
    let (verdict, reason) = match worst {
        None => (Verdict::Vacuous, Some("the model claims nothing".to_owned())),
        Some(worst) if !worst.holds() => {
            let red: Vec<_> =
                properties.iter().filter(|one| one.verdict == worst).map(|one| one.name.clone()).collect();
            (worst, Some(red.join(", ")))
        }
        Some(_) if !outcome.complete => (Verdict::Undecided, Some("not every state was visited".to_owned())),
        Some(worst) => (worst, None),
    };
    let evidence = Evidence {
        verdict,
        reason,
        detail: format!("{} states", thousands(outcome.unique_states)),
        claims: properties
            .iter()
            .map(|one| Claim { name: one.name.clone(), text: one.text.clone(), verdict: one.verdict })
            .collect(),
        seconds: outcome.seconds,
        ..bare(model, verdict, "")
    };
    let charts = outcome.properties.iter().filter_map(draw).collect();
    let more = Model {
        parameters: vec![
            ("parameters".to_owned(), outcome.parameters.clone()),
            ("assumptions in force".to_owned(), words(&outcome.assumptions_in_force)),
            ("assumptions lifted on purpose".to_owned(), words(&outcome.assumptions_lifted)),
        ],
        unique_states: u64::try_from(outcome.unique_states).ok(),
        properties,
        charts,
        ..nothing(model)
    };
    (evidence, more)
}

fn property(one: &PropertyOutcome, complete: bool) -> Property {
    let verdict = match (one.expectation, one.verdict) {
        (Expectation::AlwaysHolds, Search::ModelChecked) if complete => Verdict::ModelChecked,
        (Expectation::SometimesReached, Search::Found) => Verdict::ModelChecked,
        (Expectation::HazardFound, Search::Found) if one.trace.is_some() => Verdict::ModelChecked,
        (Expectation::AlwaysHolds, Search::Failed | Search::Found)
        | (Expectation::HazardFound, Search::NotFound | Search::Failed) => Verdict::Failed,
        // The behaviour that the model is about does not occur in it.
        (Expectation::SometimesReached, Search::NotFound | Search::Failed) => Verdict::Vacuous,
        _ => Verdict::Undecided,
    };
    let expected = match one.expectation {
        Expectation::AlwaysHolds => "holds in every reachable state".to_owned(),
        Expectation::SometimesReached => "is reached".to_owned(),
        Expectation::HazardFound if one.excluded_by.is_empty() => "the hazard is found".to_owned(),
        Expectation::HazardFound => format!("the hazard is found; excluded by {}", one.excluded_by.join(" or ")),
    };
    let found = match one.verdict {
        Search::ModelChecked => "holds",
        Search::Failed => "contradicted",
        Search::Found => "found",
        Search::NotFound => "not found",
        Search::Incomplete => "not decided",
    };
    Property {
        name: one.name.clone(),
        text: one.text.clone(),
        expected,
        found: found.to_owned(),
        excluded_by: one.excluded_by.clone(),
        verdict,
    }
}

/// The timing chart of a property's trace.
fn draw(one: &PropertyOutcome) -> Option<Chart> {
    // A way to a cover point is of no interest to the reader of a case.
    let wanted = one.expectation == Expectation::HazardFound || one.verdict == Search::Failed;
    one.trace.as_ref().filter(|_| wanted).map(|trace| chart(&one.name, &one.text, trace))
}

/// The timing chart of a trace, drawn by the oracle, which runs it through the kernel again.
pub fn chart(name: &str, text: &str, trace: &Trace) -> Chart {
    // A hazard of the machine as claimed: its display is drawn beside the kernel's.
    let differs = |step: &Step| claimed_display(step).is_some_and(|shown| *shown != step.output["display_km_h"]);
    let claimed = text.contains("as claimed") && trace.steps.iter().any(differs);
    let (shown, replies) =
        if claimed { (as_claimed(trace), Replies::AsRecorded) } else { (truth::one_more(trace), Replies::MustAgree) };
    let view = View { title: Some(name.to_owned()), ..View::default() };
    let drawn = Record::parse(&shown).and_then(|record| chart::svg(&record, replies, &view));
    let record = if claimed { shown } else { trace.trace_jsonl() };
    let mut caption = format!("{}.{}", text.trim_end_matches('.'), truth::words(trace));
    if claimed {
        caption.push_str(" Recorded: the display of the machine as claimed.");
    }
    if let Some(from) = trace.loop_start {
        caption = format!("{caption} From cycle {from} on it may repeat for ever.");
    }
    let svg = drawn.unwrap_or_else(|error| {
        caption = format!("{caption} (It could not be drawn: {error})");
        String::new()
    });
    Chart { name: name.to_owned(), caption, svg, trace: record }
}

fn as_claimed(trace: &Trace) -> String {
    let mut other = trace.clone();
    for step in &mut other.steps {
        if let Some(shown) = claimed_display(step).cloned() {
            step.output["display_km_h"] = shown;
        }
    }
    other.trace_jsonl()
}

/// What the machine as claimed displays, in a model that has it.
fn claimed_display(step: &Step) -> Option<&Value> {
    step.words.get("as_claimed_km_h")
}

fn bare(model: &ModelInfo, verdict: Verdict, reason: &str) -> Evidence {
    Evidence {
        statement: model.statement.clone(),
        reason: Some(reason.to_owned()).filter(|reason| !reason.is_empty()),
        requirements: model.requirements.clone(),
        assumptions: model.assumptions.clone(),
        ..Evidence::bare(Kind::Model, &model.name, verdict)
    }
}

fn nothing(model: &ModelInfo) -> Model {
    Model {
        id: id(&model.name),
        parameters: Vec::new(),
        unique_states: None,
        properties: Vec::new(),
        charts: Vec::new(),
    }
}

fn words(ids: &[String]) -> String {
    if ids.is_empty() { "none".to_owned() } else { ids.join(", ") }
}

/// 1234567 as 1 234 567.
pub fn thousands(number: usize) -> String {
    let digits = number.to_string();
    let mut text = String::new();
    for (place, digit) in digits.chars().enumerate() {
        if place > 0 && (digits.len() - place).is_multiple_of(3) {
            text.push('\u{202f}');
        }
        text.push(digit);
    }
    text
}

#[cfg(test)]
mod tests {
    use super::{ModelInfo, evidence};
    use crate::judge::verdict::Verdict;
    use atc_models::{Expectation, Outcome, PropertyOutcome, Trace, Verdict as Search};
    use serde_json::Value;

    fn verdict(expectation: Expectation, search: Search, trace: bool, complete: bool) -> Verdict {
        let property = PropertyOutcome {
            name: "p".to_owned(),
            text: "t".to_owned(),
            expectation,
            verdict: search,
            excluded_by: vec![],
            trace: trace.then(empty),
        };
        outcome(vec![property], complete)
    }

    fn empty() -> Trace {
        Trace { machine: String::new(), config: Value::Null, steps: vec![], loop_start: None }
    }

    fn outcome(properties: Vec<PropertyOutcome>, complete: bool) -> Verdict {
        let catalogue =
            ModelInfo { name: "m".to_owned(), statement: "s".to_owned(), requirements: vec![], assumptions: vec![] };
        let outcome = Outcome {
            model: "m".to_owned(),
            statement: "s".to_owned(),
            requirements: vec![],
            parameters: "p".to_owned(),
            assumptions_in_force: vec![],
            assumptions_lifted: vec![],
            complete,
            unique_states: 1,
            generated_states: 1,
            max_depth: 1,
            seconds: 0.0,
            properties,
            cut_sets: vec![],
            failure_modes: vec![],
        };
        evidence(&[catalogue], &[outcome], "").0[0].verdict
    }

    #[test]
    fn an_expectation_is_met_only_by_what_it_expects() {
        use Expectation::{AlwaysHolds, HazardFound, SometimesReached};
        assert_eq!(verdict(AlwaysHolds, Search::ModelChecked, false, true), Verdict::ModelChecked);
        assert_eq!(verdict(AlwaysHolds, Search::ModelChecked, false, false), Verdict::Undecided);
        assert_eq!(verdict(AlwaysHolds, Search::Failed, true, true), Verdict::Failed);
        assert_eq!(verdict(SometimesReached, Search::NotFound, false, true), Verdict::Vacuous);
        assert_eq!(verdict(HazardFound, Search::Found, true, true), Verdict::ModelChecked);
        assert_eq!(verdict(HazardFound, Search::Found, false, true), Verdict::Undecided);
        assert_eq!(verdict(HazardFound, Search::NotFound, false, true), Verdict::Failed);
        assert_eq!(verdict(HazardFound, Search::Incomplete, false, false), Verdict::Undecided);
        assert_eq!(outcome(vec![], true), Verdict::Vacuous);
    }

    /// Stations whose plan breaks a rule of engineering, and two neighbours: the oracle runs the trace again, word by word.
    #[test]
    fn accidents_at_stations_are_replayed_and_drawn() {
        let named = [
            "interlocking-no-flank",
            "interlocking-undeclared",
            "interlocking-line-other-protocol",
            "interlocking-counted-between-not-asked",
            "whole-line-no-filter",
        ];
        let catalogue = atc_models::catalogue();
        let entries = catalogue.iter().filter(|entry| named.contains(&entry.name));
        let outcomes: Vec<_> = entries.map(|entry| atc_models::check(entry, 1)).collect();
        assert_eq!(outcomes.len(), named.len());
        for outcome in outcomes {
            let charts: Vec<_> = outcome.properties.iter().filter_map(super::draw).collect();
            assert!(!charts.is_empty(), "{}", outcome.model);
            for chart in charts {
                assert!(chart.svg.starts_with("<svg"), "{}: {}", outcome.model, chart.caption);
            }
        }
    }

    #[test]
    fn numbers_are_grouped() {
        assert_eq!(super::thousands(1_234_567), "1\u{202f}234\u{202f}567");
        assert_eq!(super::thousands(12), "12");
    }
}
