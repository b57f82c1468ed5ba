//! The argument: goals bound to evidence, and the verdict of every node.

use crate::case::{Conclusion, Condition, Defeater, Engine, Evidence, Kind, Node, NodeKind};
use crate::error::Fault;
use crate::judge::verdict::Verdict;
use crate::sources::data;
use std::collections::{BTreeMap, BTreeSet};

const AT: &str = "spec/argument.toml";

/// The evidence ids that a reference stands for: itself, or all that begin with what is before `*`.
///
/// # Errors
/// It stands for nothing.
pub fn resolve(reference: &str, known: &[String]) -> Result<Vec<String>, String> {
    let found: Vec<_> = match reference.strip_suffix('*') {
        Some(beginning) => known.iter().filter(|id| id.starts_with(beginning)).cloned().collect(),
        None => known.iter().filter(|id| *id == reference).cloned().collect(),
    };
    if found.is_empty() { Err(format!("there is no evidence {reference}")) } else { Ok(found) }
}

/// Checks that every node is there once, reachable, supported and free of circles, that every reference means
/// something, and that every harness and model (`required`) is evidence of some goal.
///
/// # Errors
/// All faults that were found.
pub fn check(argument: &data::Argument, known: &[String], required: &[String]) -> Result<(), Vec<Fault>> {
    let mut faults = Vec::new();
    let mut fault = |text: String| faults.push(Fault::new(&AT, text));
    let support = support(argument);
    let context: BTreeSet<_> =
        argument.contexts.iter().chain(&argument.justifications).map(|text| text.id.as_str()).collect();
    let mut ids = BTreeSet::new();
    for id in support.keys().copied().chain(context.iter().copied()) {
        ids.insert(id);
    }
    let count =
        argument.goals.len() + argument.strategies.len() + argument.contexts.len() + argument.justifications.len();
    if ids.len() != count {
        fault(format!("{} ids for {count} nodes: an id is there twice", ids.len()));
    }
    let mut used = BTreeSet::new();
    for goal in &argument.goals {
        if goal.supported_by.is_empty() && goal.evidence.is_empty() {
            fault(format!("{} has neither sub-goals nor evidence", goal.id));
        }
        for reference in &goal.evidence {
            match resolve(reference, known) {
                Ok(found) => used.extend(found),
                Err(text) => fault(format!("{}: {text}", goal.id)),
            }
        }
        for reference in goal.defeaters.iter().flat_map(|defeater| &defeater.evidence) {
            if let Err(text) = resolve(reference, known) {
                fault(format!("{}, defeater: {text}", goal.id));
            }
        }
        if goal.root && goal.defeaters.is_empty() {
            fault(format!("{} is a top claim and has no defeater", goal.id));
        }
    }
    let contexts = argument.goals.iter().map(|goal| (&goal.id, &goal.context));
    for (id, wanted) in contexts.chain(argument.strategies.iter().map(|strategy| (&strategy.id, &strategy.context))) {
        for one in wanted.iter().filter(|one| !context.contains(one.as_str())) {
            fault(format!("{id} is in the context of {one}, which is not there"));
        }
    }
    let mut reached = BTreeSet::new();
    let roots: Vec<_> = argument.goals.iter().filter(|goal| goal.root).map(|goal| goal.id.as_str()).collect();
    if roots.is_empty() {
        fault("no goal is a root".to_owned());
    }
    for root in roots {
        if let Err(text) = descend(root, &support, &mut Vec::new(), &mut reached) {
            fault(text);
        }
    }
    for id in support.keys().filter(|id| !reached.contains(**id)) {
        fault(format!("{id} supports nothing"));
    }
    for id in required.iter().filter(|id| !used.contains(*id)) {
        fault(format!("{id} is evidence of no goal: the argument must use it"));
    }
    if faults.is_empty() { Ok(()) } else { Err(faults) }
}

fn support(argument: &data::Argument) -> BTreeMap<&str, &[String]> {
    let goals = argument.goals.iter().map(|goal| (goal.id.as_str(), goal.supported_by.as_slice()));
    let strategies = argument.strategies.iter().map(|one| (one.id.as_str(), one.supported_by.as_slice()));
    goals.chain(strategies).collect()
}

fn descend<'a>(
    id: &'a str,
    support: &BTreeMap<&'a str, &'a [String]>,
    path: &mut Vec<&'a str>,
    reached: &mut BTreeSet<&'a str>,
) -> Result<(), String> {
    if path.contains(&id) {
        return Err(format!("{id} supports itself: {} → {id}", path.join(" → ")));
    }
    let Some(children) = support.get(id) else {
        return Err(format!("{} is supported by {id}, which is not there", path.last().unwrap_or(&"")));
    };
    if !reached.insert(id) {
        return Ok(());
    }
    path.push(id);
    for child in *children {
        descend(child, support, path, reached)?;
    }
    path.pop();
    Ok(())
}

/// The argument with solutions, assumptions and verdicts. The argument has been checked.
pub fn build(
    argument: &data::Argument,
    evidence: &[Evidence],
    conditions: &[Condition],
    engines: &[Engine],
) -> Vec<Node> {
    let known: Vec<_> = evidence.iter().map(|one| one.id.clone()).collect();
    let verdicts: BTreeMap<_, _> = evidence.iter().map(|one| (one.id.as_str(), one)).collect();
    let mut nodes = Vec::new();
    let mut solutions: BTreeMap<String, String> = BTreeMap::new();
    let mut assumptions = BTreeSet::new();
    for goal in &argument.goals {
        let mut node = node(&goal.id, NodeKind::Goal, &goal.text, &goal.supported_by, &goal.context);
        node.root = goal.root;
        let mut assumed: BTreeSet<&str> = goal.assumes.iter().map(String::as_str).collect();
        for reference in &goal.evidence {
            let number = solutions.len() + 1;
            let id = solutions.entry(reference.clone()).or_insert_with(|| format!("Sn{number}")).clone();
            node.supported_by.push(id);
            for one in resolve(reference, &known).unwrap_or_default() {
                assumed.extend(verdicts.get(one.as_str()).iter().flat_map(|one| &one.assumptions).map(String::as_str));
            }
        }
        for condition in conditions.iter().filter(|condition| assumed.contains(condition.id.as_str())) {
            let id = condition.number.replace("SRAC-", "A");
            node.in_context_of.push(id.clone());
            assumptions.insert((id, condition.number.clone()));
        }
        node.defeaters = goal.defeaters.iter().map(|one| defeater(one, &known, &verdicts, engines)).collect();
        nodes.push(node);
    }
    for one in &argument.strategies {
        nodes.push(node(&one.id, NodeKind::Strategy, &one.text, &one.supported_by, &one.context));
    }
    for one in &argument.contexts {
        nodes.push(node(&one.id, NodeKind::Context, &one.text, &[], &[]));
    }
    for one in &argument.justifications {
        nodes.push(node(&one.id, NodeKind::Justification, &one.text, &[], &[]));
    }
    for condition in conditions {
        let id = condition.number.replace("SRAC-", "A");
        if assumptions.contains(&(id.clone(), condition.number.clone())) {
            nodes.push(node(
                &id,
                NodeKind::Assumption,
                &format!("{}: {}", condition.number, condition.statement),
                &[],
                &[],
            ));
        }
    }
    let mut bound: Vec<_> = solutions.into_iter().collect();
    bound.sort_by_key(|(_, id)| id.trim_start_matches("Sn").parse::<usize>().unwrap_or(0));
    for (reference, id) in bound {
        let found = resolve(&reference, &known).unwrap_or_default();
        let text = match found.as_slice() {
            [one] => {
                verdicts.get(one.as_str()).map(|one| format!("{}: {}", one.kind.word(), one.title)).unwrap_or_default()
            }
            many => format!("{} results: {reference}", many.len()),
        };
        let mut solution = node(&id, NodeKind::Solution, &text, &[], &[]);
        solution.verdict = Verdict::worst(found.iter().filter_map(|id| Some(verdicts.get(id.as_str())?.verdict)))
            .or(Some(Verdict::NotRun));
        solution.evidence = Some(reference);
        nodes.push(solution);
    }
    roll_up(&mut nodes);
    nodes
}

fn node(id: &str, kind: NodeKind, text: &str, supported_by: &[String], in_context_of: &[String]) -> Node {
    Node {
        id: id.to_owned(),
        kind,
        text: text.split_whitespace().collect::<Vec<_>>().join(" "),
        supported_by: supported_by.to_vec(),
        in_context_of: in_context_of.to_vec(),
        evidence: None,
        verdict: None,
        defeaters: Vec::new(),
        root: false,
    }
}

fn defeater(
    one: &data::Defeater,
    known: &[String],
    verdicts: &BTreeMap<&str, &Evidence>,
    engines: &[Engine],
) -> Defeater {
    let ids: Vec<_> = one.evidence.iter().flat_map(|reference| resolve(reference, known).unwrap_or_default()).collect();
    let weak: Vec<_> = ids
        .iter()
        .filter(|id| verdicts.get(id.as_str()).is_none_or(|evidence| !evidence.verdict.holds()))
        .cloned()
        .chain(one.engines.iter().filter_map(|name| {
            let holds = engines.iter().any(|engine| engine.name == *name && engine.verdict.holds());
            (!holds).then(|| format!("the engine {name}"))
        }))
        .collect();
    let reason = match (&one.answer, weak.is_empty()) {
        (None, _) => Some("no answer yet".to_owned()),
        (Some(_), true) => None,
        (Some(_), false) => {
            Some(format!("the answer rests on what has no good result: {}", crate::judge::verdict::list(&weak, 3)))
        }
    };
    let evidence =
        one.evidence.iter().cloned().chain(one.engines.iter().map(|name| format!("engine:{name}"))).collect();
    Defeater { text: one.text.clone(), answer: one.answer.clone(), evidence, open: reason.is_some(), reason }
}

/// Gives every goal and strategy its worst child's verdict.
pub fn roll_up(nodes: &mut [Node]) {
    let place: BTreeMap<_, _> = nodes.iter().enumerate().map(|(place, node)| (node.id.clone(), place)).collect();
    // Without circles a pass for each node is enough; the order of the file does not matter.
    for _ in 0..nodes.len() {
        for this in 0..nodes.len() {
            if matches!(nodes[this].kind, NodeKind::Goal | NodeKind::Strategy) {
                let children = nodes[this].supported_by.iter();
                let verdicts: Option<Vec<_>> =
                    children.map(|id| place.get(id).and_then(|child| nodes[*child].verdict)).collect();
                nodes[this].verdict = verdicts.map(|all| Verdict::worst(all).unwrap_or(Verdict::NotRun));
            }
        }
    }
}

/// The evidence ids under a node, each once, in the order of the argument.
pub fn leaves(nodes: &[Node], from: &str, known: &[String]) -> Vec<String> {
    let mut found: Vec<String> = Vec::new();
    let mut open = vec![from.to_owned()];
    let mut seen = BTreeSet::new();
    while let Some(id) = open.pop() {
        if !seen.insert(id.clone()) {
            continue;
        }
        if let Some(node) = nodes.iter().find(|node| node.id == id) {
            open.extend(node.supported_by.iter().rev().cloned());
            for one in node.evidence.iter().flat_map(|reference| resolve(reference, known).unwrap_or_default()) {
                if !found.contains(&one) {
                    found.push(one);
                }
            }
        }
    }
    found
}

/// The sentence for every root.
pub fn conclusions(nodes: &[Node], evidence: &[Evidence], conditions: &[Condition]) -> Vec<Conclusion> {
    let known: Vec<_> = evidence.iter().map(|one| one.id.clone()).collect();
    let roots = nodes.iter().filter(|node| node.root);
    roots
        .map(|root| {
            let under = leaves(nodes, &root.id, &known);
            let under: Vec<_> = evidence.iter().filter(|one| under.contains(&one.id)).collect();
            let verdict = root.verdict.unwrap_or(Verdict::NotRun);
            let worst: Vec<_> = under.iter().filter(|one| one.verdict == verdict).map(|one| one.id.clone()).collect();
            let bounds: BTreeSet<_> = under
                .iter()
                .filter(|one| one.verdict == Verdict::ProvedBounded)
                .map(|one| one.detail.clone())
                .collect();
            let goal = format!("{} (“{}”)", root.id, root.text.trim_end_matches('.'));
            let mut sentence = verdict.conclusion(&goal, &worst, &bounds.into_iter().collect::<Vec<_>>());
            // What was measured was measured without them, and discharges none.
            let measured = !under.is_empty() && under.iter().all(|one| one.kind == Kind::Measured);
            if verdict.holds() && !conditions.is_empty() && !measured {
                sentence = format!("{sentence} It holds under the conditions SRAC-1 to SRAC-{}.", conditions.len());
            }
            Conclusion { node: root.id.clone(), verdict, sentence }
        })
        .collect()
}

#[cfg(test)]
#[path = "argument_tests.rs"]
pub(crate) mod tests;
