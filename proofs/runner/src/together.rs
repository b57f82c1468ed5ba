//! Mutants that are compiled and judged together: one copy of the kernel with all of them in it, one symbolic execution of each harness, and
//! one property of each mutant.

use crate::campaign::{Asking, HARD, Options, in_parallel, known};
use crate::cbmc::{self, Ask, Question, Silence, ask_in_turn};
use crate::compile::{Compiled, Kernel, compile, copy, write};
use crate::control::is_smaller;
use crate::mutants::{FIRST, Mutant, SINGLY, SLOW};
use crate::recorded::rejects;
use crate::report::{Control, Kill};
use crate::schemata::{Change, instrument, with_cells};
use crate::tools::Tools;
use crate::twin::{self, Tape};
use atc_proofs::Harness;
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// What a harness says of a mutant.
#[derive(Clone, Debug)]
pub enum Judged {
    /// It rejects it.
    Rejects(Kill),
    /// It does not.
    Passes,
    /// No answer in time: it may have one if the mutant is alone.
    Unanswered,
    /// No answer, and why.
    Error(String),
    /// Nothing was run, and why.
    NotRun(String),
}

impl Judged {
    /// Whether nothing else will be tried.
    pub const fn is_final(&self) -> bool {
        !matches!(self, Self::Unanswered)
    }

    /// It, where nothing else can be tried.
    pub fn or_error(self, harness: &str) -> Self {
        if self.is_final() { self } else { Self::Error(format!("{harness}: no answer in time")) }
    }
}

/// Harnesses that are compiled at once, and the mutants that they are to reject: by number from 1, each with its place among all.
struct Group<'a> {
    harnesses: Vec<&'static Harness>,
    mutants: BTreeMap<usize, (usize, &'a Mutant)>,
}

/// Harnesses in a group. What concerns none of a harness's own mutants is constant to the prover, so that a large group costs it little;
/// and each group is a kernel to compile.
const SIZE: usize = 24;

/// How mutants are asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Way {
    /// All of them in one question.
    Together,
    /// Each alone, and for no longer than this.
    Brief(Duration),
    /// Each alone, until there is an answer.
    Whole,
}

/// A mutant may not fail at all in some case, and that takes long to find out: so every case is asked before any is asked for longer.
const WAYS: [Way; 4] =
    [Way::Together, Way::Brief(Duration::from_secs(12)), Way::Brief(Duration::from_secs(50)), Way::Whole];

/// CPU time for mutants that are asked for together. It is there for many answers at once, not for hard ones.
const TOGETHER: Duration = Duration::from_secs(30);

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

/// Puts the mutants, by number from 1, into the copy `sources`, with `rest`, which selects them.
///
/// # Errors
/// A mutant that cannot be selected, or a file that cannot be read or written.
pub(crate) fn put_in<'a>(
    sources: &Path,
    mutants: impl Iterator<Item = (usize, &'a Mutant)>,
    rest: &str,
) -> Result<(), String> {
    let (mut files, mut most): (BTreeMap<String, Vec<Change>>, usize) = (BTreeMap::new(), 0);
    for (number, mutant) in mutants {
        most = most.max(number);
        let change = Change { number, find: &mutant.find, replace: &mutant.replace };
        files.entry(mutant.path()).or_default().push(change);
    }
    for (file, changes) in files {
        rewrite(&sources.join(file), |text| instrument(text, &changes))?;
    }
    // The selector is in the kernel's arithmetic, and the kernel has it from there: both ask `crate::selected`.
    rewrite(&sources.join("arithmetic/src/lib.rs"), |text| with_cells(text, most + 1, rest))?;
    rewrite(&sources.join("kernel/src/lib.rs"), |text| Ok(format!("{text}\n{FROM_ARITHMETIC}")))
}

/// What the kernel has from its arithmetic where it has mutants.
const FROM_ARITHMETIC: &str =
    "pub use atc_arithmetic::select;\n#[allow(unused_imports)]\npub(crate) use atc_arithmetic::selected;\n";

fn rewrite(path: &Path, change: impl FnOnce(&str) -> Result<String, String>) -> Result<(), String> {
    let text = std::fs::read_to_string(path).map_err(|error| format!("{}: {error}", path.display()))?;
    write(path, &change(&text)?)
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

/// One harness with mutants in it. Mutant 0 is the kernel with none of them selected; or, if it was compiled alone, the mutant.
pub(crate) struct Asked<'a> {
    tools: &'a Tools,
    folder: PathBuf,
    harness: &'static Harness,
    options: &'a Options,
}

impl<'a> Asked<'a> {
    pub fn new(
        tools: &'a Tools,
        compiled: &Compiled,
        harness: &'static Harness,
        options: &'a Options,
    ) -> Result<Self, String> {
        Ok(Self { tools, folder: compiled.to_c(tools, harness.name, None)?, harness, options })
    }

    fn question(&self, case: usize, ask: Ask) -> Question<'static> {
        let question = Question::proof(self.harness.name, self.options.solver, self.options.limit);
        Question { case: (case, self.harness.cases), ask, ..question }
    }

    fn list(&self, numbers: impl IntoIterator<Item = usize>) -> Result<(), String> {
        let list: Vec<_> = numbers.into_iter().map(|number| format!("M({number})")).collect();
        write(&self.folder.join("mutants.h"), &format!("#define MUTANTS(M) {}\n", list.join(" ")))
    }

    /// With none of the mutants selected every claim holds, and nothing else fails.
    fn control(&self) -> Result<(), String> {
        self.list([0])?;
        let first = known(self.harness.name).is_none().then_some(crate::cbmc::FIRST);
        for case in 0..self.harness.cases {
            let answer = ask_in_turn(self.tools, &self.folder, &self.question(case, Ask::Control), first);
            let (answer, _) = answer.map_err(|silence| silence.of(self.harness.name))?;
            match (answer.mutant(0), answer.other_failure()) {
                (Some(true), None) => {}
                (_, Some(failure)) => {
                    return Err(format!("{failure} in {} with no mutant selected", self.harness.name));
                }
                _ => return Err(format!("a claim of {} does not hold with no mutant selected", self.harness.name)),
            }
        }
        Ok(())
    }

    /// What the harness says of these mutants. One that is not in the answer passes.
    pub fn judge(&self, numbers: &BTreeSet<usize>) -> BTreeMap<usize, Judged> {
        let mut left = numbers.clone();
        let mut found = BTreeMap::new();
        let mut judged = BTreeMap::new();
        // A panic is what the theorem of totality is about; claims come first, since there are far fewer places to look at.
        // What fails is found more easily than that nothing does, and each mutant fails in some case: first all of them at once, then each
        // alone for a short time in every case, and only then for as long as it takes. Claims come before panics.
        'asking: for ask in [Ask::Mutants, Ask::Panics] {
            let ways = &WAYS[usize::from(SINGLY.contains(&self.harness.name))..];
            for (way, case) in ways.iter().flat_map(|way| self.in_order().map(move |case| (way, case))) {
                left.retain(|number| !found.contains_key(number) && !judged.contains_key(number));
                let groups: Vec<BTreeSet<usize>> = match way {
                    Way::Together => vec![left.clone()],
                    Way::Brief(_) | Way::Whole => left.iter().map(|number| BTreeSet::from([*number])).collect(),
                };
                if left.is_empty() {
                    break 'asking;
                }
                for group in groups {
                    match self.ask(case, ask, &group, *way) {
                        Ok(rejected) => found.extend(rejected),
                        Err(Silence::Late) if *way != Way::Whole => {}
                        Err(silence) => judged.extend(group.iter().map(|number| (*number, self.silent(&silence)))),
                    }
                }
            }
        }
        match self.confirm(&found) {
            Ok(kills) => judged.extend(kills),
            Err(reason) => judged.extend(found.keys().map(|number| (*number, Judged::Error(reason.clone())))),
        }
        judged
    }

    /// The cases, the first and the last in front: they differ most, and what passes in the one is often rejected in the other at once.
    fn in_order(&self) -> impl Iterator<Item = usize> + use<> {
        let last = self.harness.cases.saturating_sub(1);
        std::iter::once(0).chain((last > 0).then_some(last)).chain(1..last)
    }

    fn silent(&self, silence: &Silence) -> Judged {
        if *silence == Silence::Late {
            Judged::Unanswered
        } else {
            Judged::Error(silence.clone().of(self.harness.name))
        }
    }

    /// The mutants that fail in this case, with what makes them.
    fn ask(
        &self,
        case: usize,
        ask: Ask,
        numbers: &BTreeSet<usize>,
        way: Way,
    ) -> Result<BTreeMap<usize, Tape>, Silence> {
        self.list(numbers.iter().copied()).map_err(Silence::Broken)?;
        let slow = SLOW.contains(&self.harness.name);
        let mut question = self.question(case, ask);
        question.only = numbers.first().copied().filter(|_| numbers.len() == 1);
        let answer = match way {
            Way::Whole => ask_in_turn(self.tools, &self.folder, &question, (!slow).then_some(FIRST)),
            Way::Together | Way::Brief(_) => {
                let solver = if slow { question.solver.at_once(self.tools) } else { question.solver };
                let most = if let Way::Brief(most) = way { most } else { TOGETHER };
                let limit = question.limit.min(if slow { most * 4 } else { most });
                cbmc::ask(self.tools, &self.folder, &Question { solver, limit, ..question })
            }
        };
        let (answer, _) = answer?;
        let rejected = numbers.iter().filter(|number| answer.mutant(**number) == Some(false));
        let tape = |number: &usize| {
            let values = answer.values.get(&format!("mutant {number}")).cloned().unwrap_or_default();
            (*number, Tape { mutant: *number, case, values })
        };
        Ok(rejected.map(tape).collect())
    }

    /// Runs every counterexample on this machine: the mutant must fail on it, and the kernel with none selected must not.
    fn confirm(&self, found: &BTreeMap<usize, Tape>) -> Result<BTreeMap<usize, Judged>, String> {
        if found.is_empty() {
            return Ok(BTreeMap::new());
        }
        self.list(found.keys().copied())?;
        let program =
            twin::build(self.tools, &self.folder, &self.question(0, Ask::Mutants), "harness.c", &["-DMUTANTS"])?;
        let both = found.values().flat_map(|tape| [tape.clone(), Tape { mutant: 0, ..tape.clone() }]);
        let runs = twin::happens(&program, &both.collect::<Vec<_>>())?;
        let judge = |((number, tape), run): ((&usize, &Tape), &[Vec<String>])| {
            // One that is alone is its own control.
            let control = if *number == 0 { &[][..] } else { &run[1][..] };
            let kill = rejects(self.harness, tape, &run[0], control);
            (*number, kill.map_or_else(Judged::Error, |kill| Judged::Rejects(Kill { asked: true, ..kill })))
        };
        Ok(found.iter().zip(runs.chunks(2)).map(judge).collect())
    }
}
