//! For each rule that theorems rest on: the wrong kernel that leaves it out, and the theorem that fails then.

use super::rules;
use crate::case::{Evidence, Kind, Matter, NeededRule, OpenItem, Severity};
use crate::judge::verdict::Verdict;
use crate::sources::mutants::{MutantInfo, killers};

/// The file with the rules.
const FILE: &str = "kernel/src/interlocking/check.rs";

/// The table.
pub fn table(mutants: &[MutantInfo], evidence: &[Evidence]) -> Vec<NeededRule> {
    rules::needed()
        .map(|(kernel, rule)| {
            let name = rule.name();
            let mine: Vec<_> = mutants.iter().filter(|one| leaves_out(one, &kernel, &name)).collect();
            let results: Vec<&Evidence> = evidence
                .iter()
                .filter(|one| one.kind == Kind::Mutant && mine.iter().any(|mutant| mutant.name == one.title))
                .collect();
            let mut theorems: Vec<_> =
                results.iter().flat_map(|one| killers(one)).map(|killer| format!("harness:{killer}")).collect();
            theorems.sort();
            theorems.dedup();
            NeededRule {
                rule: name,
                text: rule.text().to_owned(),
                mutants: mine.iter().map(|one| format!("mutant:{}", one.name)).collect(),
                theorems,
                verdict: Verdict::worst(results.iter().map(|one| one.verdict)),
            }
        })
        .collect()
}

/// Whether a wrong kernel changes the check of this rule: it names the rule in the text that it changes, or, where that is a
/// helper, in its own name.
fn leaves_out(mutant: &MutantInfo, kernel: &str, name: &str) -> bool {
    let there = mutant.at.as_deref().is_some_and(|at| at.starts_with(FILE));
    let named = mutant.find.match_indices("Rule::").any(|(place, word)| {
        let rest = &mutant.find[place + word.len()..];
        rest.strip_prefix(kernel).is_some_and(|rest| !rest.starts_with(|letter: char| letter.is_alphanumeric()))
    });
    there && (named || !mutant.find.contains("Rule::") && mutant.name.contains(name.trim_start_matches("plan-")))
}

/// The rules that nothing has shown to be needed.
pub fn open(table: &[NeededRule]) -> impl Iterator<Item = OpenItem> {
    table.iter().filter(|one| one.mutants.is_empty()).map(|one| OpenItem {
        severity: Severity::Open,
        matter: Matter::NeededRule,
        about: one.rule.clone(),
        text: "No wrong kernel leaves this rule of layouts out: nothing shows that a theorem needs it.".to_owned(),
    })
}

#[cfg(test)]
mod tests {
    use super::{leaves_out, open, table};
    use crate::case::{Evidence, Kind};
    use crate::judge::verdict::Verdict;
    use crate::sources::mutants::MutantInfo;

    fn mutant(name: &str, file: &str, find: &str) -> MutantInfo {
        MutantInfo {
            name: name.to_owned(),
            what: String::new(),
            requirements: vec![],
            at: Some(format!("{file}:1")),
            find: find.to_owned(),
            killers: vec![],
        }
    }

    #[test]
    fn a_rule_belongs_to_the_mutant_that_names_it() {
        let check = "kernel/src/interlocking/check.rs";
        let one_way = mutant("m", check, "require(report, both, Rule::ConflictOneWay, pair);");
        assert!(leaves_out(&one_way, "ConflictOneWay", "plan-conflict-one-way"));
        assert!(!leaves_out(&one_way, "Conflict", "plan-conflict"));
        assert!(!leaves_out(&mutant("m", "kernel/src/x.rs", "Rule::NoTime"), "NoTime", "plan-no-time"));
        let helper = mutant("layout-point-not-positioned", check, "all &= !meets");
        assert!(leaves_out(&helper, "PointNotPositioned", "plan-point-not-positioned"));
        let rejected = Evidence {
            killed_by: vec!["t_lay (Holds)".to_owned()],
            ..Evidence::bare(Kind::Mutant, "m", Verdict::Tested)
        };
        let table = table(&[one_way], &[rejected]);
        let row = table.iter().find(|one| one.rule == "plan-conflict-one-way").expect("a row");
        assert_eq!((row.theorems.as_slice(), row.verdict), (&["harness:t_lay".to_owned()][..], Some(Verdict::Tested)));
        assert_eq!(open(&table).count(), table.len() - 1);
    }
}
