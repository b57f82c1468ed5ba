//! The argument as an outline that can be folded, and as a drawing.

use super::drawing;
use super::parts::{badge, link};
use crate::case::{Case, Defeater, Node, NodeKind};
use maud::{Markup, PreEscaped, html};
use std::collections::BTreeSet;

/// Section 4.1.
pub fn render(case: &Case) -> Markup {
    html! {
        h3 #argument { "4.1 Argument" }
        p { "In the manner of the Goal Structuring Notation. A goal takes the worst verdict of what supports it. Confidence in \
             the evidence is argued apart from safety. The same argument is in " code { "gsn.yaml" } "." }
        @for root in case.argument.iter().filter(|node| node.root) {
            (outline(case, root))
        }
        @for root in case.argument.iter().filter(|node| node.root) {
            figure.drawing {
                figcaption { "The argument for " (root.id) ". Rectangles are goals, parallelograms strategies, rounded \
                    boxes contexts and justifications; results hang under the goals that they support." }
                (PreEscaped(drawing::svg(case, root)))
            }
        }
    }
}

fn outline(case: &Case, root: &Node) -> Markup {
    let mut seen = BTreeSet::new();
    html! { ul.tree { (item(case, root, &mut seen)) } }
}

fn item<'a>(case: &'a Case, node: &'a Node, seen: &mut BTreeSet<&'a str>) -> Markup {
    if node.kind == NodeKind::Solution {
        return html! { li { (head(node)) @if let Some(id) = &node.evidence { " " (link(id)) } } };
    }
    if !seen.insert(&node.id) {
        return html! { li { (head(node)) span.soft { " (developed above)" } } };
    }
    let of = |ids: &'a [String]| ids.iter().filter_map(|id| case.argument.iter().find(|node| node.id == *id));
    let (conditions, contexts): (Vec<_>, Vec<_>) =
        of(&node.in_context_of).partition(|one| one.kind == NodeKind::Assumption);
    let children: Vec<_> = of(&node.supported_by).map(|child| item(case, child, seen)).collect();
    html! {
        li {
            details open {
                summary { (head(node)) }
                @for context in contexts {
                    p.small.soft { (kind(context.kind)) " " (context.id) ": " (context.text) }
                }
                @if !conditions.is_empty() {
                    p.small.soft { "Under "
                        @for (place, one) in conditions.iter().enumerate() {
                            @if place > 0 { ", " }
                            @let number = one.id.replacen('A', "SRAC-", 1);
                            a href={ "#" (number) } { (number) }
                        }
                    }
                }
                @for doubt in &node.defeaters { (defeater(doubt)) }
                ul { @for child in children { (child) } }
            }
        }
    }
}

fn head(node: &Node) -> Markup {
    html! {
        @if let Some(verdict) = node.verdict { (badge(verdict)) " " }
        strong { (node.id) } " " (node.text)
    }
}

fn kind(kind: NodeKind) -> &'static str {
    match kind {
        NodeKind::Goal => "Goal",
        NodeKind::Strategy => "Strategy",
        NodeKind::Solution => "Solution",
        NodeKind::Context => "Context",
        NodeKind::Justification => "Justification",
        NodeKind::Assumption => "Assumption",
    }
}

fn defeater(doubt: &Defeater) -> Markup {
    html! {
        div.doubt.open[doubt.open] {
            strong { "What would make it wrong: " } (doubt.text) " "
            @match (&doubt.answer, &doubt.reason) {
                (Some(answer), None) => { em { "Answer: " } (answer) }
                (Some(answer), Some(reason)) => { span.badge.not-run { "open" } " " em { "Answer: " } (answer) " But: " (reason) "." }
                (None, _) => { span.badge.not-run { "open" } " No answer yet." }
            }
        }
    }
}
