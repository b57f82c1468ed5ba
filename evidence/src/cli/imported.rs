//! What other programs have found, read and checked before it counts: campaigns of other engines, and models that the
//! tests have searched.

use crate::case::{Matter, OpenItem, Provenance, Severity};
use crate::error::{Fault, read};
use crate::judge::plan::Plan;
use crate::judge::scope::Chosen;
use crate::sources::proofs::{Campaigned, ENGINES};
use atc_models::{Outcome, Searched};
use atc_prover::report::{Campaign, SCHEMA};
use std::collections::BTreeSet;
use std::path::Path;

/// What the tests have found of the models of this run, each to the end. Of another commit, or of changed files, nothing
/// is taken. A model that is not in the catalogue, or is there twice, is an error.
pub(super) fn outcomes(path: &Path, plan: &Plan, chosen: &Chosen, now: &Provenance) -> Result<Vec<Outcome>, Fault> {
    let fault = |text: String| Fault::new(&path.display(), text);
    let Searched { commit, outcomes: found } =
        serde_json::from_str(&read(path)?).map_err(|error| fault(format!("no outcomes of models: {error}")))?;
    let mut names = BTreeSet::new();
    for outcome in &found {
        if !plan.models.iter().any(|model| model.name == outcome.model) {
            return Err(fault(format!("the model \"{}\" is not known; `models list` lists them", outcome.model)));
        }
        if !names.insert(&outcome.model) {
            return Err(fault(format!("the model \"{}\" is there twice; it may be there once", outcome.model)));
        }
    }
    if !is_of(&commit, now) {
        eprintln!("{}: of another commit, or files have changed since: not used", path.display());
        return Ok(Vec::new());
    }
    let mine = |outcome: &Outcome| outcome.complete && chosen.has(&format!("model:{}", outcome.model));
    Ok(found.into_iter().filter(mine).collect())
}

/// Whether what was found of this commit, unchanged, is of these sources.
fn is_of(commit: &str, now: &Provenance) -> bool {
    now.commit.as_deref() == Some(commit) && now.dirty == Some(false)
}

/// A campaign of another engine or machine.
pub(super) fn import(path: &Path, sources: &str) -> Result<Campaigned, Fault> {
    let campaign: Campaign = serde_json::from_str(&read(path)?)
        .map_err(|error| Fault::new(&path.display(), format!("no campaign: {error}")))?;
    if campaign.schema != SCHEMA {
        return Err(Fault::new(&path.display(), format!("schema {} is not known; {SCHEMA} is", campaign.schema)));
    }
    if !ENGINES.iter().any(|(name, ..)| *name == campaign.engine) {
        let known = ENGINES.iter().map(|(name, ..)| *name).collect::<Vec<_>>().join(", ");
        return Err(Fault::new(
            &path.display(),
            format!("the engine \"{}\" is not known; known are {known}", campaign.engine),
        ));
    }
    let stale = campaign.provenance.sources_sha256 != sources;
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    Ok(Campaigned { campaign, source: format!("imported from {name}"), stale })
}

/// What the page says of so many models that the tests have searched.
pub(super) fn searched_by_tests(models: usize) -> Option<OpenItem> {
    let text = format!("{models} of them were searched by the tests of this commit, and not once more in this run.");
    (models > 0).then(|| OpenItem {
        severity: Severity::Note,
        matter: Matter::Searched,
        about: "models".to_owned(),
        text,
    })
}

#[cfg(test)]
mod tests {
    use super::{Provenance, is_of};
    use crate::judge::merge::checks::shard;

    #[test]
    fn outcomes_are_of_one_commit_without_a_change() {
        let now = |commit: Option<&str>, dirty| Provenance {
            commit: commit.map(ToOwned::to_owned),
            dirty,
            ..shard(1, 1, &[], &[]).1.provenance
        };
        assert!(is_of("a", &now(Some("a"), Some(false))));
        for other in [now(Some("b"), Some(false)), now(Some("a"), Some(true)), now(Some("a"), None), now(None, None)] {
            assert!(!is_of("a", &other));
        }
    }
}
