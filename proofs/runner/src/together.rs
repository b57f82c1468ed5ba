//! Mutants that are compiled and judged together: one copy of the kernel with all of them in it, one symbolic execution of each harness, and
//! one property of each mutant.

use crate::asked::Asked;
use crate::campaign::HARD;
use crate::compile::{Compiled, Kernel, compile, copy};
use crate::control::is_smaller;
use crate::copies::put_in;
use crate::judged::Judged;
use crate::mutant::Mutant;
use crate::options::{Asking, Options};
use crate::pool::in_parallel;
use crate::report::Control;
use crate::tools::Tools;
use atc_proofs::Harness;
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write;
use std::path::Path;
use std::time::Instant;

/// Harnesses that are compiled at once, and the mutants that they are to reject: by number from 1, each with its place among all.
struct Group<'a> {
    harnesses: Vec<&'static Harness>,
    mutants: BTreeMap<usize, (usize, &'a Mutant)>,
}

/// Harnesses in a group. What concerns none of a harness's own mutants is constant to the prover, so that a large group costs it little;
/// and each group is a kernel to compile.
const SIZE: usize = 24;

/// The harnesses that are to reject some of the mutants, in groups of neighbours.
fn groups<'a>(mutants: &[&'a Mutant]) -> Vec<Group<'a>> {
    let names: BTreeSet<&str> = mutants.iter().flat_map(|mutant| &mutant.killed_by).map(String::as_str).collect();
    let wanted: Vec<_> = crate::harnesses().into_iter().filter(|harness| names.contains(harness.name)).collect();
    let group = |harnesses: &[&'static Harness]| {
        let concerned =
            |mutant: &Mutant| harnesses.iter().any(|one| mutant.killed_by.iter().any(|name| name == one.name));
        let mutants = mutants.iter().copied().enumerate().filter(|(_, mutant)| concerned(mutant));
        Group { harnesses: harnesses.to_vec(), mutants: (1..).zip(mutants).collect() }
    };
    wanted.chunks(SIZE).map(group).collect()
}

/// Judges the mutants by all their harnesses; `told` hears of each mutant (by place) and harness. Returns the controls: how the kernel
/// fares with none of the mutants selected, before those harnesses that are smaller than in their proof.
pub fn judge(
    tools: &Tools,
    root: &Path,
    options: &Options,
    mutants: &[&Mutant],
    told: &(dyn Fn(usize, &str, Judged) + Sync),
) -> Vec<Control> {
    let groups = groups(mutants);
    let folder = options.folder.join("mutants");
    let compiled = in_parallel(options.jobs, groups.len(), |place| {
        build(tools, root, &folder.join(format!("together-{place}")), options, &groups[place])
    });
    let mut jobs: Vec<(usize, &'static Harness)> = Vec::new();
    for (place, group) in groups.iter().enumerate() {
        jobs.extend(group.harnesses.iter().map(|harness| (place, *harness)));
    }
    // Those that take longest first.
    jobs.sort_by_key(|(_, harness)| HARD.iter().position(|(name, _)| *name == harness.name).unwrap_or(HARD.len()));
    let controls = in_parallel(options.jobs, jobs.len(), |job| {
        let (place, harness) = jobs[job];
        let started = Instant::now();
        let mine: BTreeMap<usize, usize> = groups[place]
            .mutants
            .iter()
            .filter(|(_, (_, mutant))| mutant.killed_by.iter().any(|name| name == harness.name))
            .map(|(number, (place, _))| (*number, *place))
            .collect();
        let asked = match &compiled[place] {
            Ok(compiled) => Asked::new(tools, compiled, harness, options).map(|asked| {
                let control =
                    if is_smaller(harness) && options.asking != Asking::Record { Some(asked.control()) } else { None };
                (asked, control)
            }),
            Err(reason) => Err(reason.clone()),
        };
        let (asked, control) = match asked {
            Ok((asked, control)) => (Ok(asked), control),
            Err(reason) => (Err(reason), None),
        };
        // A harness that rejects the kernel with no mutant selected shows nothing by rejecting it with one.
        let judged = match (&asked, &control) {
            (Ok(_), Some(Err(reason))) => Err(Judged::Error(format!("the control failed: {reason}"))),
            (Ok(asked), _) => Ok(asked.judge(&mine.keys().copied().collect())),
            (Err(reason), _) => Err(Judged::Error(reason.clone())),
        };
        for (number, place) in &mine {
            let verdict = match &judged {
                Ok(all) => all.get(number).cloned().unwrap_or(Judged::Passes),
                Err(verdict) => verdict.clone(),
            };
            told(*place, harness.name, verdict);
        }
        let seconds = started.elapsed().as_secs_f64();
        control.map(|control| Control { harness: harness.name.to_owned(), reason: control.err(), seconds })
    });
    controls.into_iter().flatten().collect()
}

/// A copy of the sources with the mutants of the group in it, compiled.
fn build(tools: &Tools, root: &Path, folder: &Path, options: &Options, group: &Group) -> Result<Compiled, String> {
    let sources = folder.join("sources");
    copy(root, &sources)?;
    let mutants = group.mutants.iter().map(|(number, (_, mutant))| (*number, *mutant));
    put_in(&sources, mutants, &selector(group.mutants.keys().copied()))?;
    let names: Vec<_> = group.harnesses.iter().map(|harness| harness.name.to_owned()).collect();
    let kernel = Kernel::WithMutants { whole: options.asking == Asking::Record };
    compile(tools, &sources, &folder.join("build"), options.aspects, &names, kernel)
}

/// What a harness calls before it begins: the prover fills the cell of each mutant.
fn selector(numbers: impl Iterator<Item = usize>) -> String {
    let mut written = String::from(
        "#[link(wasm_import_module = \"prover\")]
         unsafe extern \"C\" { #[link_name = \"selected\"] safe fn is_selected(number: u32) -> u32; }
         /// Asks which mutants this kernel is to be.
         #[inline(always)]
         pub fn select() { unsafe {\n",
    );
    for number in numbers {
        let _ = writeln!(written, "SELECTED[{number}] = is_selected({number});");
    }
    written.push_str("} }\n");
    written
}
