//! The argument drawn: goals and strategies in layers, results in a stack under the goal that they support.

use crate::case::{Case, Node, NodeKind};
use crate::judge::verdict::Verdict;
use std::collections::BTreeMap;
use std::fmt::Write;

const WIDTH: f64 = 150.0;
const GAP: f64 = 14.0;
const LINE: f64 = 14.5;
const PILL: f64 = 21.0;
const LAYER_GAP: f64 = 46.0;
/// Characters that fit into a box.
const COLUMNS: usize = 23;
/// And into the box of a context.
const CONTEXT_COLUMNS: usize = 42;

struct Box {
    x: f64,
    y: f64,
    height: f64,
    lines: Vec<String>,
}

/// The drawing of everything under a root, as an `svg` element.
pub fn svg(case: &Case, root: &Node) -> String {
    let find = |id: &str| case.argument.iter().find(|node| node.id == id);
    let layers = layers(case, root);
    let widest = layers.iter().map(|layer| step() * count(layer.len())).fold(0.0, f64::max);
    let side = layers.iter().flatten().any(|node| !contexts(case, node).is_empty());
    // The contexts stand beside a root or a strategy, which are alone in their layers.
    let width = widest.max(if side { step() * 5.0 } else { step() });
    let mut boxes: BTreeMap<&str, Box> = BTreeMap::new();
    let mut y = 4.0;
    let mut body = String::new();
    for layer in &layers {
        let between = width / count(layer.len());
        // A context that is taller than its node reaches above it.
        y += layer.iter().map(|node| above(case, node, layer.len() == 1)).fold(0.0, f64::max);
        let mut bottom: f64 = y;
        for (place, node) in layer.iter().enumerate() {
            let middle = between * (count(place) + 0.5);
            let wide = if layer.len() == 1 { 2.0 } else { 1.0 };
            let lines = wrap(&node.text, columns(layer.len() == 1));
            let height = tall(lines.len());
            let half = WIDTH * wide / 2.0;
            shape(&mut body, node, (middle - half, y, WIDTH * wide, height), &lines);
            for (number, context) in contexts(case, node).iter().enumerate() {
                let left = number % 2 == 0;
                let text = wrap(&context.text, CONTEXT_COLUMNS);
                let high = context_height(&text);
                let broad = WIDTH * 1.75;
                let x = if left { middle - half - 36.0 - broad } else { middle + half + 36.0 };
                let at = if left { (middle - half, x + broad) } else { (middle + half, x) };
                let centre = y + height / 2.0;
                shape(&mut body, context, (x, centre - high / 2.0, broad, high), &text);
                let _ = write!(body, r#"<path d="M{:.1} {centre:.1} L{:.1} {centre:.1}" class="ctx"/>"#, at.0, at.1);
            }
            let stack: Vec<_> = node
                .supported_by
                .iter()
                .filter_map(|id| find(id))
                .filter(|one| one.kind == NodeKind::Solution)
                .collect();
            let mut under = y + height + 10.0;
            for solution in &stack {
                pill(&mut body, solution, middle - half, under);
                under += PILL + 5.0;
            }
            bottom = bottom.max(if stack.is_empty() { y + height } else { under });
            boxes.insert(&node.id, Box { x: middle, y, height, lines });
        }
        y = bottom + LAYER_GAP;
    }
    let mut edges = String::new();
    for node in layers.iter().flatten() {
        for child in &node.supported_by {
            if let (Some(from), Some(to)) = (boxes.get(node.id.as_str()), boxes.get(child.as_str())) {
                let (start, end) = (from.y + from.height, to.y);
                let bend = (end - start) / 2.0;
                let _ = write!(
                    edges,
                    r#"<path d="M{:.1} {start:.1} C{:.1} {:.1} {:.1} {:.1} {:.1} {:.1}" class="edge" marker-end="url(#tip)"/>"#,
                    from.x,
                    from.x,
                    start + bend,
                    to.x,
                    end - bend,
                    to.x,
                    end - 6.0
                );
            }
        }
    }
    debug_assert!(boxes.values().all(|one| !one.lines.is_empty()), "every node says something");
    let height = y - LAYER_GAP + 8.0;
    format!(
        r##"<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width:.0} {height:.0}" width="{width:.0}" height="{height:.0}" role="img" aria-label="Argument for {}"><style>{STYLE}</style><defs><marker id="tip" viewBox="0 0 8 8" refX="3" refY="4" markerWidth="9" markerHeight="9" orient="auto"><path d="M0 0 L8 4 L0 8 z" fill="#57606a"/></marker></defs>{edges}{body}</svg>"##,
        escape(&root.id)
    )
}

/// A node that is alone in its layer is twice as wide.
fn columns(alone: bool) -> usize {
    if alone { COLUMNS * 2 } else { COLUMNS }
}

/// The height of a goal with so many lines, its id and its verdict.
fn tall(lines: usize) -> f64 {
    LINE * (count(lines) + 2.0) + 10.0
}

fn context_height(text: &[String]) -> f64 {
    LINE * (count(text.len()) + 1.0) + 10.0
}

/// How far the contexts of a node reach above it.
fn above(case: &Case, node: &Node, alone: bool) -> f64 {
    let height = tall(wrap(&node.text, columns(alone)).len());
    let contexts = contexts(case, node);
    let highest = contexts.iter().map(|context| context_height(&wrap(&context.text, CONTEXT_COLUMNS)));
    (highest.fold(0.0, f64::max) - height).max(0.0) / 2.0
}

const STYLE: &str = "text{font:11.5px system-ui,-apple-system,'Segoe UI',Roboto,'Liberation Sans',sans-serif;fill:#1b1f24}\
.id{font-weight:650}.w{font-size:10.5px;font-weight:600}.c{font-size:10px;fill:#57606a}.edge{fill:none;stroke:#57606a;stroke-width:1.1}\
.ctx{stroke:#57606a;stroke-width:1;stroke-dasharray:3 2;fill:none}.box{fill:#fff;stroke:#57606a}";

/// Goals and strategies by their longest way from the root, each layer in the order of its parents.
fn layers<'a>(case: &'a Case, root: &'a Node) -> Vec<Vec<&'a Node>> {
    let mut depth: BTreeMap<&str, usize> = BTreeMap::from([(root.id.as_str(), 0)]);
    let mut order: Vec<&Node> = vec![root];
    let mut next = 0;
    while let Some(node) = order.get(next).copied() {
        next += 1;
        for child in node.supported_by.iter().filter_map(|id| case.argument.iter().find(|node| node.id == *id)) {
            if child.kind == NodeKind::Solution {
                continue;
            }
            if !order.iter().any(|one| one.id == child.id) {
                order.push(child);
            }
        }
    }
    // The argument has no circles, so as many passes as nodes are enough.
    for _ in 0..order.len() {
        for node in &order {
            let here = depth.get(node.id.as_str()).copied().unwrap_or(0);
            for child in &node.supported_by {
                let below = depth.entry(child.as_str()).or_insert(0);
                *below = (*below).max(here + 1);
            }
        }
    }
    let mut layers: Vec<Vec<&Node>> = Vec::new();
    for node in order {
        let place = depth.get(node.id.as_str()).copied().unwrap_or(0);
        if layers.len() <= place {
            layers.resize_with(place + 1, Vec::new);
        }
        layers[place].push(node);
    }
    layers
}

fn contexts<'a>(case: &'a Case, node: &Node) -> Vec<&'a Node> {
    let all = node.in_context_of.iter().filter_map(|id| case.argument.iter().find(|one| one.id == *id));
    all.filter(|one| matches!(one.kind, NodeKind::Context | NodeKind::Justification)).collect()
}

fn shape(body: &mut String, node: &Node, (x, y, width, height): (f64, f64, f64, f64), lines: &[String]) {
    let middle = x + width / 2.0;
    let _ = match node.kind {
        NodeKind::Strategy => write!(
            body,
            r#"<path class="box" d="M{:.1} {y:.1} L{:.1} {y:.1} L{:.1} {:.1} L{:.1} {:.1} z"/>"#,
            x + 10.0,
            x + width + 10.0,
            x + width - 10.0,
            y + height,
            x - 10.0,
            y + height
        ),
        NodeKind::Context | NodeKind::Justification | NodeKind::Assumption => {
            write!(body, r#"<rect class="box" x="{x:.1}" y="{y:.1}" width="{width:.1}" height="{height:.1}" rx="14"/>"#)
        }
        _ => write!(body, r#"<rect class="box" x="{x:.1}" y="{y:.1}" width="{width:.1}" height="{height:.1}"/>"#),
    };
    let mut at = y + LINE + 1.0;
    let letter = if node.kind == NodeKind::Justification { " (J)" } else { "" };
    let _ = write!(
        body,
        r#"<text class="id" x="{middle:.1}" y="{at:.1}" text-anchor="middle">{}{letter}</text>"#,
        escape(&node.id)
    );
    for line in lines {
        at += LINE;
        let _ = write!(body, r#"<text x="{middle:.1}" y="{at:.1}" text-anchor="middle">{}</text>"#, escape(line));
    }
    if let Some(verdict) = node.verdict {
        let (ink, _) = colours(verdict);
        at += LINE + 1.0;
        let _ = write!(
            body,
            r#"<text class="w" x="{middle:.1}" y="{at:.1}" text-anchor="middle" style="fill:{ink}">{verdict}</text><rect x="{x:.1}" y="{:.1}" width="{width:.1}" height="4" fill="{ink}" opacity="{}"/>"#,
            y + height - 4.0,
            u8::from(node.kind != NodeKind::Strategy)
        );
    }
}

fn pill(body: &mut String, node: &Node, x: f64, y: f64) {
    let verdict = node.verdict.unwrap_or(Verdict::NotRun);
    let (ink, fill) = colours(verdict);
    let name = node.evidence.as_deref().unwrap_or(&node.text);
    let kind = name.split(':').next().unwrap_or_default();
    let name = name.split_once(':').map_or(name, |(_, name)| name);
    let mark = match kind {
        "harness" => "T",
        "model" => "M",
        "mutant" => "W",
        _ => "t",
    };
    let dash = if verdict == Verdict::NotRun { r#" stroke-dasharray="3 2""# } else { "" };
    let label = if name == "*" { "all" } else { name };
    let _ = write!(
        body,
        r#"<rect x="{x:.1}" y="{y:.1}" width="{WIDTH}" height="{PILL}" rx="10.5" fill="{fill}" stroke="{ink}"{dash}/><text class="w" x="{:.1}" y="{:.1}" style="fill:{ink}">{mark}</text><text style="font-size:10.5px" x="{:.1}" y="{:.1}">{}</text><title>{}: {verdict}</title>"#,
        x + 9.0,
        y + 14.5,
        x + 22.0,
        y + 14.5,
        escape(label),
        escape(&node.text)
    );
}

fn colours(verdict: Verdict) -> (&'static str, &'static str) {
    match verdict {
        Verdict::Proved => ("#0b5a33", "#e2f4ea"),
        Verdict::ProvedBounded => ("#17566b", "#e2f1f6"),
        Verdict::ModelChecked => ("#35448f", "#e9ecfa"),
        Verdict::Tested => ("#5b4a86", "#efebf8"),
        Verdict::Measured => ("#6b5410", "#faf3dc"),
        Verdict::NotRun => ("#c83a3a", "#ffffff"),
        Verdict::Stale => ("#8a4b00", "#fff4e0"),
        Verdict::Undecided | Verdict::Vacuous | Verdict::Failed => ("#b3261e", "#fbe0de"),
    }
}

fn step() -> f64 {
    WIDTH + GAP
}

/// A count of a few boxes or lines.
fn count(number: usize) -> f64 {
    f64::from(u32::try_from(number).unwrap_or(u32::MAX))
}

fn wrap(text: &str, columns: usize) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in text.split_whitespace() {
        match lines.last_mut() {
            Some(line) if line.chars().count() + 1 + word.chars().count() <= columns => {
                line.push(' ');
                line.push_str(word);
            }
            _ => lines.push(word.to_owned()),
        }
    }
    lines
}

fn escape(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}
