//! The positions in which the file wants switches.

use roxmltree::Node;

use super::file::{Branch, File, refers};
use super::walk::Asked;

/// Which branches the file's positions for a route leave, by switch.
pub(super) fn asked<'a>(file: &File<'a>, node: Node<'a, 'a>) -> Result<Asked<'a>, String> {
    let mut asked = Asked::new();
    for (switch, relations) in positions(file, node, &["facingSwitchInPosition", "trailingSwitchInPosition"])? {
        match asked.get_mut(switch) {
            None => drop(asked.insert(switch, relations)),
            Some(before) => before.retain(|relation| relations.contains(relation)),
        }
    }
    Ok(asked)
}

/// The switches of these elements, each with the relations that its position leaves.
pub(super) fn positions<'a>(
    file: &File<'a>,
    node: Node<'a, 'a>,
    names: &[&str],
) -> Result<Vec<(&'a str, Vec<&'a str>)>, String> {
    let mut found = Vec::new();
    let given = node.children().filter(|child| names.contains(&child.tag_name().name()));
    let given: Vec<Node<'a, 'a>> = given.flat_map(|given| given.descendants()).collect();
    // What is not left need not be right.
    let says_not = |at: &Node<'a, 'a>| !matches!(at.attribute("isNegated").map(str::trim), None | Some("false" | "0"));
    if given.iter().any(says_not) {
        return Err("a position of it is negated".to_owned());
    }
    for given in given.into_iter().filter(|at| at.attribute("inPosition").is_some()) {
        let machine = refers(given, "refersToSwitch").or(refers(given, "refersTo"));
        let machine =
            machine.and_then(|id| file.by_id(id)).ok_or("a position of it is of a switch that is not there")?;
        let switch = machine.attribute("id").and_then(|id| file.meant(id)).and_then(|switch| switch.attribute("id"));
        let switch = switch.ok_or("a position of it is of a switch that is not there")?;
        let (side, leg) = match given.attribute("inPosition") {
            Some("left") => ("leftBranch", "branchLeft"),
            Some("right") => ("rightBranch", "branchRight"),
            other => return Err(format!("a position {:?} of it is neither left nor right", other.unwrap_or_default())),
        };
        let own: Vec<&Branch<'a>> = file.branches.values().filter(|branch| branch.switch == switch).collect();
        let plain: Vec<&str> = own.iter().filter(|branch| branch.side == side).map(|branch| branch.relation).collect();
        let relations = if plain.is_empty() {
            // A slip: the machine says to which net element its blades lead.
            let leg = refers(machine, leg).ok_or("a position of it is of a slip whose machine names no branches")?;
            let leads = |relation: &str| {
                let ends = file.by_id(relation).map(|node| [refers(node, "elementA"), refers(node, "elementB")]);
                ends.is_some_and(|ends| ends.contains(&Some(leg)))
            };
            own.iter().map(|branch| branch.relation).filter(|relation| leads(relation)).collect()
        } else {
            plain
        };
        if relations.is_empty() {
            return Err(format!("a position of it is of {switch}, which has no such branch"));
        }
        found.push((switch, relations));
    }
    Ok(found)
}

/// Whether the left branch of a switch is its normal leg.
pub fn left_is_normal(file: &File<'_>, switch: &str) -> bool {
    let machine = file.every("switchIL").find(|machine| refers(*machine, "refersTo") == Some(switch));
    let preferred = machine.and_then(|machine| machine.attribute("preferredPosition"));
    let course = file.by_id(switch).and_then(|node| node.attribute("continueCourse"));
    preferred.or(course).filter(|side| ["left", "right"].contains(side)) != Some("right")
}

impl File<'_> {
    /// What an element is called, as text of its own.
    pub fn call_of(&self, id: &str) -> String {
        self.by_id(id)
            .and_then(|node| node.attribute("id"))
            .map_or_else(|| id.to_owned(), |id| self.call(id).to_owned())
    }
}
