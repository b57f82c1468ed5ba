//! The case from the plan and the results.

use crate::case::{
    Case, Condition, Engine, EngineResult, Evidence, Kind, Matter, OpenItem, Phase, Provenance, Run as About, SCHEMA,
    Severity, Status, Technique, Tool,
};
use crate::error::Fault;
use crate::judge::argument;
use crate::judge::hazard;
use crate::judge::open;
use crate::judge::plan::Plan;
use crate::judge::scope::{Chosen, Scope};
use crate::judge::srac;
use crate::judge::trace;
use crate::judge::verdict::{Verdict, list};
use crate::sources::proofs::Campaigned;
use crate::sources::second::Opinion;
use crate::sources::tests::{self, Run};
use crate::sources::{faults, measured, models, mutants, proofs, second};
use crate::station;
use atc_models::Outcome;
use atc_prover::report::Mutants;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// What the engines have said.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Results {
    /// What was to be looked at.
    pub scope: Scope,
    /// More is to come.
    pub running: bool,
    /// The shards that these results were joined from.
    pub joined: Vec<String>,
    /// When the results that an earlier run of this commit has found were found (its end, seconds since 1970); nothing if there are none.
    pub kept_since: Option<u64>,
    /// The campaigns, run or imported.
    pub campaigns: Vec<Campaigned>,
    /// The mutants, and whether they belong to other sources.
    pub mutants: Option<(Mutants, bool)>,
    /// The models.
    pub outcomes: Vec<Outcome>,
    /// Why a model has no outcome.
    pub no_outcome: String,
    /// What another checker says of the models.
    pub opinions: Vec<Opinion>,
    /// What was measured of signal and position; nothing if it is another shard's.
    pub measured: Option<measured::Run>,
    /// The tests; nothing if they are another shard's.
    pub tests: Option<Run>,
    /// What is open beyond the results: shards that contradict each other.
    pub open: Vec<OpenItem>,
    /// Where the time went.
    pub phases: Vec<Phase>,
    /// What all of it belongs to.
    pub provenance: Provenance,
}

/// What must be so for the exit code 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Required {
    /// Nothing may have gone wrong.
    NoDefect,
    /// Every claim of the kernel proved by the cbmc engine, every model as expected, every wrong kernel rejected.
    Proved,
}

/// Builds the case.
///
/// # Errors
/// The part that the results are about does not exist.
pub fn build(plan: &Plan, results: Results, required: Required) -> Result<Case, Fault> {
    let chosen = Chosen::of(plan, &results.scope)?;
    let (mut evidence, mut engines) = proofs::evidence(&plan.harnesses, &results.campaigns);
    let (modelled, models) = models::evidence(&plan.models, &results.outcomes, &results.no_outcome);
    evidence.extend(modelled);
    let second_opinions = second::opinions(&results.opinions, &models);
    second::enter(&second_opinions, &mut evidence);
    engines.push(second::engine(&second_opinions));
    let (killed, stale) = results.mutants.as_ref().map_or((None, false), |(all, stale)| (Some(all), *stale));
    let mut rejected = mutants::evidence(&plan.mutants, killed, stale);
    let pending = |harness: &str| results.running || !chosen.has(&format!("harness:{harness}"));
    mutants::only_by_what_holds(&mut rejected, &evidence, &pending);
    evidence.extend(rejected);
    let absent = || results.scope.why();
    let none = measured::Run::NotRun(absent());
    let (targets, measurements) = measured::evidence(results.measured.as_ref().unwrap_or(&none));
    engines.push(measured::engine(&targets, &measurements));
    evidence.extend(targets);
    let none = Run::NotRun(absent());
    evidence.extend(suites(plan, results.tests.as_ref().unwrap_or(&none), &results.scope));
    left_out(&mut evidence, &chosen, &results.scope);

    let mut conditions = srac::conditions(&plan.data.assumptions, &plan.uses);
    // A bound that only this run has (another number of aspects) is carried by the same conditions.
    for condition in &mut conditions {
        condition.used_by.sort();
        condition.used_by.dedup();
    }
    let cut_sets = faults::cut_sets(&results.outcomes, &conditions);
    for set in &cut_sets {
        used(&mut conditions, &set.number, |id| set.excluded_by.iter().any(|one| one.assumption == id));
    }
    let nodes = argument::build(&plan.data.argument, &evidence, &conditions, &engines);
    let hazards = hazard::log(&plan.data.hazards, &nodes, &evidence, &conditions, &cut_sets);
    let accidents = hazard::accidents(&plan.data.accidents, &evidence, &conditions);
    let mut case = Case {
        schema: SCHEMA,
        title: "Train control kernel: aspect acceptance, speed supervision, two channels, block counting, telegrams and codes, \
                permitted speed, train position, interlocking and its ATC"
            .to_owned(),
        conclusions: argument::conclusions(&nodes, &evidence, &conditions),
        run: About {
            part: results.scope.part(),
            shard: results.scope.shard().map(|shard| shard.to_string()),
            running: results.running,
            joined: results.joined,
            kept_since: results.kept_since,
            phases: results.phases,
        },
        status: Status::default(),
        open_items: Vec::new(),
        requirements: trace::table(&plan.requirements, &plan.citations, &plan.mentions, &evidence),
        line: crate::sources::line::case(&plan.line, &evidence),
        needed_rules: station::needed::table(&plan.mutants, &evidence),
        station: plan.station.as_ref().map(|station| station.case(&evidence, &conditions)),
        techniques: techniques(plan, &evidence, &engines),
        tools: tools(plan, &results.provenance),
        provenance: results.provenance,
        argument: nodes,
        evidence,
        engines,
        conditions,
        hazards,
        accidents,
        models,
        cut_sets,
        failure_modes: faults::failure_modes(&results.outcomes),
        second_opinions,
        measurements,
    };
    case.conclusions.extend(case.station.as_ref().map(station::conclusion));
    case.open_items = open::items(plan, &case);
    if !results.open.is_empty() {
        case.open_items.extend(results.open);
        case.open_items = open::grouped(std::mem::take(&mut case.open_items));
    }
    case.status = status(&case, required);
    Ok(case)
}

/// Makes a case the one of this station: what it says of the machine is what it said before.
pub fn at_station(case: &mut Case, station: &station::Checked) {
    case.open_items.retain(|item| item.matter != Matter::StationData);
    let station = station.case(&case.evidence, &case.conditions);
    case.open_items.extend(open::of_station(&station));
    case.open_items = open::grouped(std::mem::take(&mut case.open_items));
    let concluded = station::conclusion(&station);
    case.conclusions.retain(|one| one.node != concluded.node);
    case.conclusions.push(concluded);
    case.station = Some(station);
    let required = if case.status.required.is_some() { Required::Proved } else { Required::NoDefect };
    case.status = status(case, required);
}

/// Enters a user with the conditions that it uses.
fn used(conditions: &mut [Condition], user: &str, uses: impl Fn(&str) -> bool) {
    for condition in conditions.iter_mut().filter(|condition| uses(&condition.id)) {
        condition.used_by.push(user.to_owned());
    }
}

/// Marks what has no result and was not to have one.
fn left_out(evidence: &mut [Evidence], chosen: &Chosen, scope: &Scope) {
    let why = scope.why();
    for one in evidence.iter_mut() {
        // The measurements are one run: it measures also what belongs to another part.
        if one.kind != Kind::Test && !chosen.has(&one.id) && matches!(one.verdict, Verdict::NotRun | Verdict::Measured)
        {
            one.verdict = Verdict::NotRun;
            one.left_out = true;
            one.reason = Some(why.clone());
        }
        if one.kind == Kind::Test && one.verdict == Verdict::NotRun && one.reason.as_ref() == Some(&why) {
            one.left_out = *scope != Scope::Whole;
        }
    }
}

/// The suites of the run, and those that are named somewhere and are not there.
fn suites(plan: &Plan, run: &Run, scope: &Scope) -> Vec<Evidence> {
    let mut found = tests::evidence(run);
    if matches!(scope, Scope::Part(_)) {
        // Some tests are not all.
        found.retain(|one| one.id != "test:all");
    }
    for id in plan.tests_named() {
        if !found.iter().any(|one| one.id == id) {
            let name = id.trim_start_matches("test:");
            found.push(match run {
                Run::NotRun(why) => tests::one(name, Verdict::NotRun, String::new(), Some(why.clone())),
                Run::Ran { .. } if matches!(scope, Scope::Part(_)) => {
                    tests::one(name, Verdict::NotRun, String::new(), Some(scope.why()))
                }
                Run::Ran { .. } => {
                    let reason = "the argument names this suite, and it is not in the run".to_owned();
                    tests::one(name, Verdict::Undecided, String::new(), Some(reason))
                }
            });
        }
    }
    found
}

fn techniques(plan: &Plan, evidence: &[Evidence], engines: &[Engine]) -> Vec<Technique> {
    let known: Vec<_> = evidence.iter().map(|one| one.id.clone()).collect();
    let text = |text: &str| text.split_whitespace().collect::<Vec<_>>().join(" ");
    plan.data
        .techniques
        .techniques
        .iter()
        .map(|one| {
            let ids: Vec<_> =
                one.evidence.iter().flat_map(|id| argument::resolve(id, &known).unwrap_or_default()).collect();
            let verdicts = evidence.iter().filter(|one| ids.contains(&one.id)).map(|one| one.verdict);
            let engine = |name: &String| engines.iter().find(|engine| engine.name == *name);
            let by = one.engines.iter().map(|name| engine(name).map_or(Verdict::NotRun, |engine| engine.verdict));
            Technique {
                name: one.name.clone(),
                claimed: text(&one.claimed),
                verdict: Verdict::worst(verdicts.chain(by)),
                evidence: one
                    .evidence
                    .iter()
                    .cloned()
                    .chain(one.engines.iter().map(|name| format!("engine:{name}")))
                    .collect(),
            }
        })
        .collect()
}

fn tools(plan: &Plan, provenance: &Provenance) -> Vec<Tool> {
    let tools = plan.data.techniques.tools.iter();
    tools
        .map(|tool| Tool {
            name: tool.name.clone(),
            class: tool.class.clone(),
            version: provenance.tools.get(&tool.name).cloned(),
            justification: tool.justification.split_whitespace().collect::<Vec<_>>().join(" "),
        })
        .collect()
}

/// The end of the run: complete or not, and the exit code with its reasons.
pub fn status(case: &Case, required: Required) -> Status {
    let mut counts: BTreeMap<String, BTreeMap<Verdict, usize>> = BTreeMap::new();
    for one in &case.evidence {
        *counts.entry(one.kind.word().to_owned()).or_default().entry(one.verdict).or_default() += 1;
    }
    // A theorem that was only tested has no result of a prover.
    let proves = |one: &EngineResult| one.engine != "native" && one.verdict.is_result();
    let has_result = |one: &Evidence| match one.kind {
        Kind::Harness => one.verdict.is_result() && one.engines.iter().any(proves),
        _ => one.verdict.is_result(),
    };
    let missing: Vec<_> = case.evidence.iter().filter(|one| !has_result(one)).map(|one| one.id.clone()).collect();
    let data = open::of_data(case);
    let mut reasons: Vec<String> = Vec::new();
    for one in case.evidence.iter().filter(|one| one.verdict.is_defect()) {
        reasons.push(format!("{} is {}: {}", one.id, one.verdict, one.why()));
    }
    for one in case.open_items.iter().filter(|one| one.severity == Severity::Stop) {
        // Each result stands above, and those of line and station follow below, each once.
        if !matches!(one.matter, Matter::Result | Matter::LineData | Matter::StationData) {
            reasons.push(format!("{}: {}", one.about, one.text));
        }
    }
    reasons.extend(data.iter().map(|item| format!("{}: {}", item.about, item.text)));
    if required == Required::Proved {
        let mut weak: BTreeMap<(Verdict, &str), Vec<String>> = BTreeMap::new();
        for one in case.evidence.iter().filter(|one| !one.verdict.is_defect() && !one.left_out) {
            let enough = match one.kind {
                Kind::Harness => {
                    one.engines.iter().any(|engine| engine.engine == "cbmc" && engine.verdict <= Verdict::ProvedBounded)
                }
                Kind::Model => one.verdict == Verdict::ModelChecked,
                Kind::Mutant => one.verdict == Verdict::Tested,
                Kind::Measured => one.verdict == Verdict::Measured,
                Kind::Test => true,
            };
            if !enough {
                let wanted = match one.kind {
                    Kind::Harness => "not proved by the cbmc engine",
                    Kind::Model => "not checked",
                    Kind::Measured => "not measured",
                    Kind::Mutant | Kind::Test => "not rejected by a theorem",
                };
                weak.entry((one.verdict, wanted)).or_default().push(one.id.clone());
            }
        }
        for ((verdict, wanted), ids) in weak {
            reasons.push(format!("{verdict}, {wanted}: {}", list(&ids, 3)));
        }
    }
    Status {
        // A part, a shard and a run that goes on are never whole, whatever they have.
        complete: missing.is_empty() && case.run.partial().is_none(),
        missing,
        required: (required == Required::Proved).then(|| "proved".to_owned()),
        exit_code: u8::from(!reasons.is_empty()),
        reasons,
        counts,
    }
}
