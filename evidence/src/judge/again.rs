//! What an earlier run in the same folder has found of the very same commit with the very same tools: it is not run again.

use crate::case::Provenance;
use crate::judge::build::Results;
use crate::judge::results;
use crate::judge::scope::Scope;
use crate::render::files::SUMS;
use crate::sources::measured::{self, HERE};
use crate::sources::proofs::Campaigned;
use crate::sources::provenance::{differences, sha256};
use crate::sources::tests;
use atc_models::Outcome;
use atc_prover::reals;
use atc_prover::report::{HarnessResult, MutantVerdict, Verdict};
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

/// The results that stand, and what they are of.
#[derive(Debug, Default)]
pub struct Kept {
    /// The results; all that did not come to an end has been left out.
    pub results: Option<Results>,
    /// The entries of the manifest that they conclude, and `native:NAME` for the native engine.
    ids: BTreeSet<String>,
}

impl Kept {
    /// Whether this is concluded.
    pub fn has(&self, id: &str) -> bool {
        self.ids.contains(id)
    }

    /// The outcomes of these models stand as well.
    pub fn take(&mut self, outcomes: &[Outcome]) {
        self.ids.extend(outcomes.iter().map(|outcome| format!("model:{}", outcome.model)));
    }

    /// How many entries are.
    pub fn count(&self) -> usize {
        self.ids.len()
    }
}

/// What stands of the results in `folder`; nothing if they are of another commit, of changed files, of other tools or of
/// another scope, or if the file is not the one that the run has written.
pub fn kept(folder: &Path, now: &Provenance, scope: &Scope, provers: &BTreeMap<String, String>) -> Kept {
    let Some(old) = written(folder) else { return Kept::default() };
    let clean = |one: &Provenance| one.commit.is_some() && one.dirty == Some(false);
    let said = |name: &String, version: &String| old.provenance.tools.get(name) == Some(version);
    // The provers bring a compiler of their own, which stands under the same name in what a run has written.
    let mut tools = now.tools.clone();
    tools.extend(provers.clone());
    let same = clean(now)
        && clean(&old.provenance)
        && now.commit == old.provenance.commit
        && differences(now, &old.provenance).is_empty()
        && differences(&old.provenance, now).is_empty()
        && now.sources_sha256 == old.provenance.sources_sha256
        && now.aspects == old.provenance.aspects
        && tools.iter().all(|(name, version)| said(name, version))
        && *scope == old.scope
        && old.joined.is_empty();
    if same { concluded(old) } else { Kept::default() }
}

/// The results in the folder, if they are what a run has written there.
fn written(folder: &Path) -> Option<Results> {
    let sums = std::fs::read_to_string(folder.join(SUMS)).ok()?;
    let line = sums.lines().find_map(|line| line.strip_suffix(results::FILE))?;
    let bytes = std::fs::read(folder.join(results::FILE)).ok()?;
    (line.trim_end() == sha256(&bytes)).then_some(())?;
    results::load(folder).ok()
}

/// Only what has come to an end, whatever the end.
fn concluded(mut old: Results) -> Kept {
    let mut ids = BTreeSet::new();
    old.campaigns.retain(|one: &Campaigned| one.source == HERE && !one.stale);
    for one in &mut old.campaigns {
        let kind = match one.campaign.engine.as_str() {
            "cbmc" => "harness",
            other => other,
        };
        let ended = |verdict| matches!(verdict, Verdict::Proved | Verdict::Tested | Verdict::Vacuous | Verdict::Failed);
        // What is proved over all real numbers has no size.
        let sized = one.campaign.engine != reals::ENGINE;
        let as_today = |harness: &HarnessResult| !sized || as_large(&harness.name, &harness.bound);
        one.campaign.harnesses.retain(|harness| ended(harness.verdict) && as_today(harness));
        ids.extend(one.campaign.harnesses.iter().map(|harness| format!("{kind}:{}", harness.name)));
    }
    old.mutants = old.mutants.filter(|(_, stale)| !stale);
    if let Some((all, _)) = &mut old.mutants {
        all.mutants.retain(|one| matches!(one.verdict, MutantVerdict::Killed | MutantVerdict::Survived));
        ids.extend(all.mutants.iter().map(|one| format!("mutant:{}", one.name)));
    }
    old.outcomes.retain(|one| one.complete);
    ids.extend(old.outcomes.iter().map(|one| format!("model:{}", one.model)));
    ids.extend(old.opinions.iter().map(|one| format!("opinion:{}", one.model)));
    old.measured = old.measured.filter(|one| matches!(one, measured::Run::Ran(_)));
    ids.extend(old.measured.iter().map(|_| MEASURED.to_owned()));
    old.tests = old.tests.filter(|one| matches!(one, tests::Run::Ran { success: true, .. }));
    ids.extend(old.tests.iter().map(|_| TESTS.to_owned()));
    Kept { results: Some(old), ids }
}

/// Whether a harness is of this size today: some sizes are variables of the environment when the harnesses are compiled.
fn as_large(name: &str, bound: &str) -> bool {
    let known = atc_proofs::HARNESSES.iter().copied().flatten().find(|harness| harness.name == name);
    known.is_none_or(|harness| harness.bound == bound)
}

/// The measurements, among what is concluded.
pub const MEASURED: &str = "measurements";
/// The tests, among what is concluded.
pub const TESTS: &str = "tests";

#[cfg(test)]
mod checks {
    use super::{Kept, Results, Scope, kept, results, sha256};
    use crate::judge::merge::checks::shard;
    use crate::sources::provenance::HOST;
    use atc_prover::report::{MutantVerdict, Verdict};
    use std::collections::BTreeMap;
    use std::path::Path;

    fn found() -> Results {
        let harnesses = [("holds", Verdict::Proved), ("late", Verdict::Timeout)];
        let (_, results) = shard(1, 1, &harnesses, &[("m", MutantVerdict::Killed), ("n", MutantVerdict::Error)]);
        Results { scope: Scope::Whole, ..results }
    }

    fn write(folder: &Path, found: &Results) {
        let text = results::json(found).expect("JSON");
        std::fs::write(folder.join(results::FILE), &text).expect("written");
        let sums = format!("{}  {}\n", sha256(text.as_bytes()), results::FILE);
        std::fs::write(folder.join(super::SUMS), sums).expect("written");
    }

    fn again(folder: &Path, now: &Results) -> Kept {
        kept(folder, &now.provenance, &now.scope, &BTreeMap::from([("cbmc".to_owned(), "6".to_owned())]))
    }

    #[test]
    fn what_has_an_end_stands_for_the_same_commit() {
        let folder = tempfile::tempdir().expect("a folder");
        let old = found();
        write(folder.path(), &old);
        let kept = again(folder.path(), &old);
        assert!(["harness:holds", "mutant:m", super::TESTS].iter().all(|id| kept.has(id)) && kept.count() == 3);
        let left = kept.results.expect("kept");
        assert_eq!(left.campaigns[0].campaign.harnesses.len(), 1, "what had no answer is asked again");
    }

    /// The provers' compiler is seldom that of the machine.
    #[test]
    fn the_compiler_of_the_provers_is_theirs() {
        let folder = tempfile::tempdir().expect("a folder");
        let (mut old, mut now) = (found(), found());
        old.provenance.tools.insert("rustc".to_owned(), "1.85".to_owned());
        for all in [&mut old, &mut now] {
            all.provenance.tools.insert(HOST.to_owned(), "1.95".to_owned());
        }
        now.provenance.tools.insert("rustc".to_owned(), "1.95".to_owned());
        write(folder.path(), &old);
        let ask = |now: &Results, theirs: &str| {
            let provers =
                [("cbmc", "6"), ("rustc", theirs)].map(|(name, version)| (name.to_owned(), version.to_owned()));
            kept(folder.path(), &now.provenance, &now.scope, &BTreeMap::from(provers)).count()
        };
        assert_eq!(ask(&now, "1.85"), 3);
        assert_eq!(ask(&now, "1.86"), 0, "the provers have another one");
        now.provenance.tools.insert(HOST.to_owned(), "1.96".to_owned());
        assert_eq!(ask(&now, "1.85"), 0, "the machine has another one");
    }

    #[test]
    fn what_was_of_another_size_does_not_stand() {
        let harness = atc_proofs::HARNESSES.iter().copied().flatten().next().expect("a harness");
        for (bound, stands) in [(harness.bound, true), ("another", false)] {
            let folder = tempfile::tempdir().expect("a folder");
            let mut old = found();
            let one = &mut old.campaigns[0].campaign.harnesses[0];
            (one.name, one.bound) = (harness.name.to_owned(), bound.to_owned());
            write(folder.path(), &old);
            assert_eq!(again(folder.path(), &old).has(&format!("harness:{}", harness.name)), stands, "{bound}");
        }
    }

    #[test]
    fn what_is_proved_of_all_real_numbers_stands() {
        let folder = tempfile::tempdir().expect("a folder");
        let mut old = found();
        old.campaigns[0].campaign.engine = atc_prover::reals::ENGINE.to_owned();
        let one = &mut old.campaigns[0].campaign.harnesses[0];
        (one.name, one.bound) = ("t_atc_8".to_owned(), String::new());
        write(folder.path(), &old);
        assert!(again(folder.path(), &old).has("reals:t_atc_8"));
    }

    #[test]
    fn nothing_stands_for_anything_else() {
        let folder = tempfile::tempdir().expect("a folder");
        let old = found();
        assert_eq!(again(folder.path(), &old).count(), 0, "there is no earlier run");
        write(folder.path(), &old);
        let changes: [fn(&mut Results); 8] = [
            |now| now.provenance.commit = Some("another".to_owned()),
            |now| now.provenance.commit = None,
            |now| now.provenance.dirty = Some(true),
            |now| drop(now.provenance.folders.insert("kernel".to_owned(), "other".to_owned())),
            |now| drop(now.provenance.folders.insert("new".to_owned(), "n".to_owned())),
            |now| drop(now.provenance.tools.insert("rustc".to_owned(), "another".to_owned())),
            |now| now.provenance.aspects += 1,
            |now| now.scope = Scope::Part("aspect".to_owned()),
        ];
        for (number, change) in changes.into_iter().enumerate() {
            let mut now = old.clone();
            change(&mut now);
            assert_eq!(again(folder.path(), &now).count(), 0, "change {number}");
        }
        let text = std::fs::read_to_string(folder.path().join(results::FILE)).expect("read");
        std::fs::write(folder.path().join(results::FILE), text.replace("failed", "proved") + " ").expect("written");
        assert_eq!(again(folder.path(), &old).count(), 0, "not what the run has written");
    }
}
