//! The argument as text in the form of gsn2x: one YAML document for each root.

use crate::case::{Case, Node, NodeKind};
use std::collections::BTreeSet;
use std::fmt::Write;

/// File names and contents: `gsn.yaml` for the first root, `gsn-….yaml` for the others.
pub fn files(case: &Case) -> Vec<(String, String)> {
    let roots = case.argument.iter().filter(|node| node.root);
    roots
        .enumerate()
        .map(|(place, root)| {
            let name = if place == 0 { "gsn.yaml".to_owned() } else { format!("gsn-{}.yaml", root.id.to_lowercase()) };
            (name, document(case, root))
        })
        .collect()
}

fn document(case: &Case, root: &Node) -> String {
    let mut order: Vec<&Node> = vec![root];
    let mut seen = BTreeSet::from([root.id.as_str()]);
    let mut next = 0;
    while let Some(node) = order.get(next).copied() {
        next += 1;
        for id in node.supported_by.iter().chain(&node.in_context_of) {
            if let (Some(child), true) = (case.argument.iter().find(|one| one.id == *id), seen.insert(id)) {
                order.push(child);
            }
        }
    }
    let mut text = format!("module:\n  name: {}\n  brief: {}\n", quoted(&root.id), quoted(&case.title));
    for node in order {
        let _ = write!(text, "\n{}:\n  text: {}\n", node.id, quoted(&node.text));
        for (key, ids) in [("supportedBy", &node.supported_by), ("inContextOf", &node.in_context_of)] {
            if !ids.is_empty() {
                let _ = writeln!(text, "  {key}: [{}]", ids.join(", "));
            }
        }
        if let Some(verdict) = node.verdict {
            let _ = writeln!(text, "  classes: [{verdict}]\n  verdict: {}", quoted(verdict.word()));
        }
        if let (NodeKind::Solution, Some(evidence)) = (node.kind, &node.evidence) {
            let _ = writeln!(text, "  evidence: {}", quoted(evidence));
        }
        for (number, doubt) in node.defeaters.iter().enumerate() {
            // A counter-goal challenges what it doubts, in the dialectic extension of GSN.
            let state = if doubt.open { "open" } else { "answered" };
            let id = format!("CG-{}-{}", node.id.trim_start_matches("G-"), number + 1);
            let _ =
                write!(text, "\n{id}:\n  text: {}\n  challenges: {}\n  state: {state}\n", quoted(&doubt.text), node.id);
            if let Some(answer) = &doubt.answer {
                let _ = writeln!(text, "  answer: {}", quoted(answer));
            }
        }
    }
    text
}

/// A double-quoted YAML scalar: JSON strings are.
fn quoted(text: &str) -> String {
    serde_json::Value::from(text).to_string()
}
