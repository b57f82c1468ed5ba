//! What is not good, in the SARIF 2.1.0 form that editors and code review read.
//!
//! Each piece of evidence that does not hold is one result, where its harness stands or the text that a wrong kernel
//! changes; so is each open item, unless it only groups such evidence. What holds has none: an incomplete case without
//! results does not look clean, as its invocation says that it did not succeed.

use crate::case::{Case, Evidence, Matter, OpenItem, Severity};
use crate::judge::verdict::Verdict;
use crate::sources::provenance::sha256;
use serde::Serialize;
use std::collections::BTreeMap;

/// The name of the file.
pub const FILE: &str = "case.sarif";
/// What the paths are relative to.
const ROOT: &str = "SRCROOT";
/// The schema that the document names.
const SCHEMA: &str = "https://json.schemastore.org/sarif-2.1.0.json";

#[derive(Serialize)]
struct Log {
    #[serde(rename = "$schema")]
    schema: &'static str,
    version: &'static str,
    runs: [Run; 1],
}

#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
struct Run {
    tool: Tool,
    invocations: [Invocation; 1],
    original_uri_base_ids: BTreeMap<&'static str, Base>,
    results: Vec<Finding>,
}

#[derive(Serialize)]
struct Tool {
    driver: Driver,
}

#[derive(Serialize)]
struct Driver {
    name: &'static str,
    version: &'static str,
    rules: Vec<Rule>,
}

#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
struct Rule {
    id: &'static str,
    short_description: Text,
    default_configuration: Configuration,
}

#[derive(Serialize)]
struct Configuration {
    level: Level,
}

#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
struct Invocation {
    execution_successful: bool,
    exit_code: u8,
    #[serde(skip_serializing_if = "String::is_empty")]
    exit_code_description: String,
}

#[derive(Serialize)]
struct Base {
    description: Text,
}

#[derive(Serialize)]
struct Text {
    text: String,
}

#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
struct Finding {
    rule_id: &'static str,
    level: Level,
    message: Text,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    locations: Vec<Location>,
    partial_fingerprints: BTreeMap<&'static str, String>,
}

#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
struct Location {
    physical_location: Physical,
}

#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
struct Physical {
    artifact_location: Artifact,
    #[serde(skip_serializing_if = "Option::is_none")]
    region: Option<Region>,
}

#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
struct Artifact {
    uri: String,
    uri_base_id: &'static str,
}

#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
struct Region {
    start_line: u32,
}

#[derive(Clone, Copy, Serialize)]
#[serde(rename_all = "lowercase")]
enum Level {
    Error,
    Warning,
    Note,
}

/// The document.
///
/// # Errors
/// The text cannot be written as JSON.
pub fn json(case: &Case) -> Result<String, String> {
    let mut results: Vec<_> = case.evidence.iter().filter(|one| !one.verdict.holds()).map(evidence).collect();
    results.extend(case.open_items.iter().filter(|one| one.matter != Matter::Result).map(|one| item(case, one)));
    let what = "The checkout: the folder that holds kernel/, proofs/ and spec/.".to_owned();
    let log = Log {
        schema: SCHEMA,
        version: "2.1.0",
        runs: [Run {
            tool: Tool { driver: Driver { name: "safety-case", version: env!("CARGO_PKG_VERSION"), rules: rules() } },
            invocations: [Invocation {
                execution_successful: case.status.complete,
                exit_code: case.status.exit_code,
                exit_code_description: case.status.reasons.join("\n"),
            }],
            original_uri_base_ids: BTreeMap::from([(ROOT, Base { description: Text { text: what } })]),
            results,
        }],
    };
    serde_json::to_string_pretty(&log).map(|text| format!("{text}\n")).map_err(|error| error.to_string())
}

/// One for each verdict that is no good result, the worst first, then one for each severity of an open item.
fn rules() -> Vec<Rule> {
    let rule = |id, text: &str, level| Rule {
        id,
        short_description: Text { text: format!("{text}.") },
        default_configuration: Configuration { level },
    };
    let bad = Verdict::ALL.into_iter().rev().filter(|verdict| !verdict.holds());
    bad.map(|verdict| rule(verdict.word(), verdict.meaning(), of_verdict(verdict)))
        .chain([Severity::Stop, Severity::Open, Severity::Note].map(|severity| {
            let (id, text, level) = of_severity(severity);
            rule(id, text, level)
        }))
        .collect()
}

fn of_verdict(verdict: Verdict) -> Level {
    if verdict >= Verdict::Vacuous { Level::Error } else { Level::Warning }
}

/// Rule, meaning and level.
fn of_severity(severity: Severity) -> (&'static str, &'static str, Level) {
    match severity {
        Severity::Stop => ("stop", "an open item with which no run ends well", Level::Error),
        Severity::Open => ("open", "an open item: something is not shown", Level::Warning),
        Severity::Note => ("note", "something to know", Level::Note),
    }
}

fn evidence(one: &Evidence) -> Finding {
    let mut text = format!("{} is {}: {}.", one.title, one.verdict, one.why().trim_end_matches('.'));
    if !one.statement.is_empty() {
        text = format!("{text} It is about: {}", one.statement);
    }
    let fingerprint = ("evidenceId/v1", one.id.clone());
    finding(one.verdict.word(), of_verdict(one.verdict), text, one.at.iter(), fingerprint)
}

fn item(case: &Case, one: &OpenItem) -> Finding {
    let (rule, _, level) = of_severity(one.severity);
    let about: Vec<_> = one.about.split(", ").collect();
    let requirements = case.requirements.iter().filter(|one| about.contains(&one.id.as_str())).map(|one| &one.at);
    let fingerprint = ("openItem/v1", sha256(format!("{rule}\n{}\n{}", one.about, one.text).as_bytes()));
    finding(rule, level, format!("{}: {}", one.about, one.text), requirements, fingerprint)
}

fn finding<'a>(
    rule_id: &'static str,
    level: Level,
    text: String,
    places: impl Iterator<Item = &'a String>,
    fingerprint: (&'static str, String),
) -> Finding {
    Finding {
        rule_id,
        level,
        message: Text { text },
        locations: places.map(|place| location(place)).collect(),
        partial_fingerprints: BTreeMap::from([fingerprint]),
    }
}

/// `file:line`, or a file.
fn location(place: &str) -> Location {
    let (file, line) = match place.rsplit_once(':').map(|(file, line)| (file, line.parse())) {
        Some((file, Ok(line))) => (file, Some(line)),
        _ => (place, None),
    };
    Location {
        physical_location: Physical {
            artifact_location: Artifact { uri: file.to_owned(), uri_base_id: ROOT },
            region: line.map(|start_line| Region { start_line }),
        },
    }
}

#[cfg(test)]
#[path = "sarif_tests.rs"]
mod tests;
