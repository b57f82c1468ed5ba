//! One harness, asked of mutants that are compiled into one kernel: which of them it rejects, and on what values.

use crate::campaign::known;
use crate::cbmc::{self, Ask, Question, Silence, ask_in_turn};
use crate::compile::{Compiled, write};
use crate::judged::{Judged, rejects};
use crate::options::Options;
use crate::report::Kill;
use crate::tools::Tools;
use crate::twin::{self, Tape};
use atc_proofs::Harness;
use std::collections::{BTreeMap, BTreeSet};
use std::path::PathBuf;
use std::time::Duration;

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

/// The harnesses on whose mutants MiniSat is known to have no answer in the time that it is given; found by running them, and a matter of
/// time only.
pub const SLOW: [&str; 5] = ["t_per_4", "t_per_4_fix", "t_per_7", "per_machine", "t_pos_1"];

/// The harnesses whose mutants have no answer together, and each at once: sums of many bits, which are another sum with each mutant.
const SINGLY: [&str; 1] = ["t_tel_3_linear"];

/// What is wrong is found more easily than that nothing is: MiniSat gets some time, and Kissat what that leaves.
const FIRST: Duration = Duration::from_secs(40);

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
    pub fn control(&self) -> Result<(), String> {
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
