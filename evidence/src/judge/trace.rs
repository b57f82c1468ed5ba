//! Traceability: requirement → code → theorem → wrong kernel → model → test.

use crate::case::{Evidence, Kind, Requirement};
use crate::error::{Fault, read};
use crate::judge::verdict::Verdict;
use crate::sources::mutants;
use crate::sources::requirements::{self, Citation};
use std::path::Path;

/// Every requirement with what it is connected with. `mentions`: where tests name a requirement.
pub fn table(
    requirements: &[requirements::Requirement],
    citations: &[Citation],
    mentions: &[(String, String)],
    evidence: &[Evidence],
) -> Vec<Requirement> {
    requirements
        .iter()
        .map(|one| {
            let of = |kind: Kind| -> Vec<&Evidence> {
                evidence.iter().filter(|e| e.kind == kind && e.requirements.contains(&one.id)).collect()
            };
            let ids = |kind: Kind| of(kind).iter().map(|evidence| evidence.id.clone()).collect::<Vec<_>>();
            let cited = |tests: bool| {
                let mine = citations.iter().filter(move |cite| cite.anchor == one.anchor && cite.is_test == tests);
                mine.map(|cite| cite.at.clone())
            };
            let named = mentions.iter().filter(|(id, _)| *id == one.id).map(|(_, at)| at.clone());
            let mut tests: Vec<_> = cited(true).chain(named).collect();
            tests.sort();
            tests.dedup();
            Requirement {
                id: one.id.clone(),
                title: one.title.clone(),
                sentence: one.sentence.clone(),
                at: one.at.clone(),
                code: cited(false).collect(),
                harnesses: ids(Kind::Harness),
                models: ids(Kind::Model),
                mutants: ids(Kind::Mutant),
                tests,
                verdict: Verdict::worst(of(Kind::Harness).iter().map(|one| one.verdict)).unwrap_or(Verdict::NotRun),
            }
        })
        .collect()
}

/// The mutants of a requirement that one of its **own** harnesses rejects.
pub fn own_kills<'a>(requirement: &Requirement, evidence: &'a [Evidence]) -> Vec<&'a Evidence> {
    let own = |killer: &str| requirement.harnesses.contains(&format!("harness:{killer}"));
    evidence
        .iter()
        .filter(|one| one.kind == Kind::Mutant && one.verdict == Verdict::Tested)
        .filter(|one| one.requirements.contains(&requirement.id) && mutants::killers(one).any(own))
        .collect()
}

/// Where the tests name a requirement: its id and `file:line`.
///
/// # Errors
/// A file cannot be read.
pub fn mentions(root: &Path, ids: &[String]) -> Result<Vec<(String, String)>, Fault> {
    let mut found = Vec::new();
    for folder in ["tests", "kernel/tests", "oracle/tests", "models/tests"] {
        for path in requirements::tree(&root.join(folder), "rs")? {
            let name = path.strip_prefix(root).unwrap_or(&path).to_string_lossy().replace('\\', "/");
            for (line, text) in read(&path)?.lines().enumerate().filter(|(_, text)| may_name(text)) {
                for id in ids.iter().filter(|id| names(text, id)) {
                    found.push((id.clone(), format!("{name}:{}", line + 1)));
                }
            }
        }
    }
    Ok(found)
}

/// Whether a line may name any id: each has a hyphen before a digit.
fn may_name(text: &str) -> bool {
    text.as_bytes().windows(2).any(|pair| pair[0] == b'-' && pair[1].is_ascii_digit())
}

/// Whether a line names this id and not a longer one (ACC-1 in "ACC-1," but not in "T-ACC-1" or "ACC-12").
fn names(text: &str, id: &str) -> bool {
    text.match_indices(id).any(|(place, _)| {
        let before = text[..place].chars().next_back();
        let after = text[place + id.len()..].chars().next();
        !before.is_some_and(|c| c.is_alphanumeric() || c == '-') && !after.is_some_and(|c| c.is_ascii_digit())
    })
}

#[cfg(test)]
mod tests {
    use super::{may_name, names};

    #[test]
    fn an_id_is_a_whole_word() {
        assert!(names("// ACC-1, operate", "ACC-1") && names("ACC-1", "ACC-1"));
        assert!(!names("T-ACC-1", "ACC-1") && !names("ACC-12", "ACC-1"));
        assert!(may_name("// ACC-1") && !may_name("a -> b - 1"));
    }
}
