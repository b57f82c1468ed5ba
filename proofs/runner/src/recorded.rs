//! Counterexamples that are kept, one for each mutant and each harness that must reject it: `proofs/counterexamples.tsv`.
//!
//! CBMC found each of them once (`mutants --record`), with the harness as large as it proves. A run compiles kernel and harnesses for this
//! machine, with all mutants in them, and runs each counterexample twice. With the mutant a claim must fail, or a panic come; without it
//! nothing may. What then rejects the mutant is a run of this very commit, and no prover has to be believed for it. One that no longer
//! does so shows nothing: then CBMC is asked again.

use crate::compile::{copy, write};
use crate::copies::put_in;
use crate::judged::{Judged, rejects};
use crate::mutant::{Mutant, changed, is_together};
use crate::options::Options;
use crate::pool::in_parallel;
use crate::program;
use crate::report::{Kill, MutantResult};
use crate::twin::{self, Tape};
use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

/// The file, from the checkout.
pub const FILE: &str = "proofs/counterexamples.tsv";

const HEAD: &str = "# A counterexample for each mutant and each harness that must reject it: mutant, harness, case, and the arbitrary values in \
                    order.\n# Every run of the mutants runs them; a mutant or a harness that changes needs new ones: `cargo run -p atc-prover -- \
                    mutants NAME --record`.\n";

/// The case and the arbitrary values of each counterexample, by mutant and harness.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Recorded(BTreeMap<(String, String), (usize, Vec<u16>)>);

impl Recorded {
    /// What is kept in this checkout.
    ///
    /// # Errors
    /// The file cannot be read, or the line that is none of it.
    pub fn read(root: &Path) -> Result<Self, String> {
        let path = root.join(FILE);
        let text = std::fs::read_to_string(&path).map_err(|error| format!("{}: {error}", path.display()))?;
        Self::parse(&text)
    }

    fn parse(text: &str) -> Result<Self, String> {
        let mut all = BTreeMap::new();
        for (place, line) in text.lines().enumerate().filter(|(_, line)| !line.starts_with('#')) {
            let entry = || {
                let [mutant, harness, case, values] = line.split('\t').collect::<Vec<_>>()[..] else { return None };
                let values =
                    values.split(' ').filter(|value| !value.is_empty()).map(str::parse).collect::<Result<_, _>>();
                Some(((mutant.to_owned(), harness.to_owned()), (case.parse().ok()?, values.ok()?)))
            };
            let (pair, values) = entry().ok_or_else(|| {
                format!("{FILE}, line {}: not a mutant, a harness, a case and values with tabs between them", place + 1)
            })?;
            if all.insert(pair, values).is_some() {
                return Err(format!("{FILE}, line {}: the second of this mutant and harness", place + 1));
            }
        }
        Ok(Self(all))
    }

    /// Mutant and harness of each.
    pub fn pairs(&self) -> impl Iterator<Item = (&str, &str)> {
        self.0.keys().map(|(mutant, harness)| (mutant.as_str(), harness.as_str()))
    }

    fn tape(&self, mutant: &str, harness: &str, number: usize) -> Option<Tape> {
        let (case, values) = self.0.get(&(mutant.to_owned(), harness.to_owned()))?;
        Some(Tape { mutant: number, case: *case, values: values.clone() })
    }

    /// Takes what these have been rejected by, and drops what is no mutant and harness any more. How many are new.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn record(mut self, root: &Path, mutants: &[Mutant], results: &[MutantResult]) -> Result<usize, String> {
        let before = self.0.clone();
        let wanted = |(mutant, harness): &(String, String)| {
            mutants.iter().any(|one| one.name == *mutant && one.killed_by.contains(harness))
        };
        self.0.retain(|pair, _| wanted(pair));
        for result in results {
            for kill in &result.killed_by {
                let Some(values) = &kill.counterexample else { continue };
                self.0.insert((result.name.clone(), kill.harness.clone()), (kill.case, values.clone()));
            }
        }
        let mut text = HEAD.to_owned();
        for ((mutant, harness), (case, values)) in &self.0 {
            // What runs out is 0.
            let length = values.iter().rposition(|value| *value > 0).map_or(0, |last| last + 1);
            let values: Vec<_> = values[..length].iter().map(ToString::to_string).collect();
            let _ = writeln!(text, "{mutant}\t{harness}\t{case}\t{}", values.join(" "));
        }
        write(&root.join(FILE), &text)?;
        Ok(self.0.iter().filter(|(pair, values)| before.get(*pair) != Some(*values)).count())
    }
}

/// A program with mutants in it: by place, the number that it knows each by. 0 is the only one, or none of them.
struct Program {
    path: PathBuf,
    numbers: BTreeMap<usize, usize>,
}

/// Runs what is kept of these mutants. What rejects a mutant is here, by its place and the harness; and nothing else is.
///
/// # Errors
/// The kernel with the mutants does not compile, or there is no compiler.
pub fn replay(
    root: &Path,
    options: &Options,
    mutants: &[&Mutant],
    recorded: &Recorded,
) -> Result<BTreeMap<(usize, String), Judged>, String> {
    let folder = options.folder.join("mutants").join("recorded");
    let (together, alone): (Vec<_>, Vec<_>) = (0..mutants.len()).partition(|place| is_together(root, mutants[*place]));
    let compiled = in_parallel(options.jobs, 1 + alone.len(), |job| match job.checked_sub(1) {
        None => all_in_one(root, &folder.join("together"), mutants, &together),
        Some(job) => by_itself(root, &folder.join(&mutants[alone[job]].name), mutants, alone[job]),
    });
    let mut programs = compiled.into_iter();
    let first = programs.next().unwrap_or_else(|| Err("nothing was compiled".to_owned()))?;
    let right = first.path.clone();
    // One that does not compile by itself shows nothing: the prover will say why.
    let programs: Vec<Program> = std::iter::once(first).chain(programs.filter_map(Result::ok)).collect();
    let mut jobs: BTreeMap<(usize, &str), Vec<(usize, Tape)>> = BTreeMap::new();
    for (at, program) in programs.iter().enumerate() {
        for (place, number) in &program.numbers {
            for harness in &mutants[*place].killed_by {
                let tape = recorded.tape(&mutants[*place].name, harness, *number);
                jobs.entry((at, harness)).or_default().extend(tape.map(|tape| (*place, tape)));
            }
        }
    }
    let jobs: Vec<_> = jobs.into_iter().collect();
    let judged = in_parallel(options.jobs, jobs.len(), |job| {
        let ((at, name), tapes) = &jobs[job];
        let files = folder.join(format!("{at}-{name}"));
        // A program that does not end as it should shows nothing.
        let kills = kills(&programs[*at].path, &right, name, tapes, &files).unwrap_or_default();
        kills.into_iter().map(|(place, kill)| ((place, (*name).to_owned()), Judged::Rejects(kill))).collect::<Vec<_>>()
    });
    Ok(judged.into_iter().flatten().collect())
}

/// One program with all mutants that can be selected at run time.
fn all_in_one(root: &Path, folder: &Path, mutants: &[&Mutant], places: &[usize]) -> Result<Program, String> {
    let sources = folder.join("sources");
    copy(root, &sources)?;
    put_in(&sources, (1..).zip(places.iter().map(|place| mutants[*place])), &selector(places.len()))?;
    let path = program::build(&sources, folder, &[], &["--cfg=mutants".to_owned()])?;
    Ok(Program { path, numbers: places.iter().copied().zip(1..).collect() })
}

/// A program that is one mutant.
fn by_itself(root: &Path, folder: &Path, mutants: &[&Mutant], place: usize) -> Result<Program, String> {
    let (mutant, sources) = (mutants[place], folder.join("sources"));
    copy(root, &sources)?;
    write(&sources.join(mutant.path()), &changed(root, mutant)?)?;
    let path = program::build(&sources, folder, &crate::select(&mutant.killed_by)?, &[])?;
    Ok(Program { path, numbers: BTreeMap::from([(place, 0)]) })
}

/// Which of the tapes, each with the place of its mutant, show that the harness rejects it.
fn kills(
    wrong: &Path,
    right: &Path,
    harness: &str,
    tapes: &[(usize, Tape)],
    files: &Path,
) -> Result<Vec<(usize, Kill)>, String> {
    let name = [harness.to_owned()];
    let with: Vec<_> = tapes.iter().map(|(_, tape)| tape.clone()).collect();
    let without: Vec<_> = with.iter().map(|tape| Tape { mutant: 0, ..tape.clone() }).collect();
    let with = twin::happens_with(wrong, &name, &files.with_extension("with"), &with)?;
    let without = twin::happens_with(right, &name, &files.with_extension("without"), &without)?;
    let harness = crate::select(&name)?[0];
    let kill = |number: usize| {
        let (place, tape) = &tapes[number];
        Some((*place, rejects(harness, tape, &with[number], &without[number]).ok()?))
    };
    Ok((0..tapes.len()).filter_map(kill).collect())
}

/// What the program calls before each run: it says which of the mutants, numbered from 1, this kernel is to be; 0: none of them.
fn selector(mutants: usize) -> String {
    let cells = mutants + 1;
    format!(
        "/// Makes this kernel the mutant of this number, if there is one.
         pub fn select(number: usize) -> bool {{ unsafe {{
             SELECTED = [0; {cells}];
             let known = number < {cells};
             if known {{ SELECTED[number] = (number > 0) as u32; }}
             known
         }} }}\n"
    )
}

#[cfg(test)]
mod tests {
    use super::{Recorded, replay};
    use crate::mutant::{Mutant, list};
    use crate::options::Options;
    use crate::root;

    /// Three of them: as it is; harmless, since it changes nothing; and with values that it does not fail on.
    #[test]
    fn only_what_rejects_today_is_taken() {
        let (root, mut recorded) = (root(), Recorded::read(&root()).unwrap());
        let all = list(&root).unwrap();
        let named = |name: &str| all.iter().find(|mutant| mutant.name == name).unwrap().clone();
        let right = named("expiry-late");
        let other = named("age-restarts");
        let harmless = Mutant { replace: other.find.clone() + "0 + ", ..other };
        let other = named("credit-forgotten");
        for harness in &other.killed_by {
            recorded.0.insert((other.name.clone(), harness.clone()), (0, vec![1]));
        }
        let folder = root.join("target/proofs/recorded-tested");
        let options = Options { folder, ..Options::default() };
        let found = replay(&root, &options, &[&right, &harmless, &other], &recorded).unwrap();
        let found: Vec<_> = found.keys().map(|(place, name)| (*place, name.as_str())).collect();
        assert_eq!(found, right.killed_by.iter().map(|name| (0, name.as_str())).collect::<Vec<_>>());
        assert!(right.killed_by.len() > 1);
    }

    #[test]
    fn a_line_that_is_none_is_told() {
        let line = "a\tt_acc_1\t0\t1 2 3\n";
        let read = Recorded::parse(&format!("# head\n{line}b\tt_acc_2\t3\t\n")).unwrap();
        assert_eq!(read.pairs().collect::<Vec<_>>(), [("a", "t_acc_1"), ("b", "t_acc_2")]);
        assert_eq!(read.tape("a", "t_acc_1", 7).unwrap().values, [1, 2, 3]);
        assert!(Recorded::parse(&format!("{line}{line}")).unwrap_err().contains("line 2: the second"));
        for wrong in ["a\tt_acc_1\t0", "a\tt_acc_1\t0\t65536", "a\tt_acc_1\t-1\t1", "a\tt_acc_1\t0\t1\t2"] {
            assert!(Recorded::parse(wrong).unwrap_err().contains("line 1"), "{wrong}");
        }
    }
}
