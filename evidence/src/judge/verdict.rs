//! Verdicts and their order.
//!
//! The order is from the strongest to the weakest, so that the verdict of a parent is the `max` of its children:
//! it takes its **worst** child, never a mean.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// What a piece of evidence, or a part of the argument that rests on it, shows. The best comes first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Verdict {
    /// Shown by a prover for all inputs, states and parameters, without a bound.
    Proved,
    /// Shown by a prover for everything within a bound; the bound is printed wherever the verdict is.
    ProvedBounded,
    /// Every reachable state of a finite model was visited; states and parameters are printed.
    ModelChecked,
    /// It held for chosen inputs.
    Tested,
    /// Figures of a simulation met their targets.
    Measured,
    /// Nothing was run here.
    NotRun,
    /// There is a result, but it belongs to other sources than these.
    Stale,
    /// An engine was started and gave no result: time limit, killed, no memory, an error of its own.
    Undecided,
    /// A claim or a cover point cannot be reached, so the result says nothing.
    Vacuous,
    /// There is a counterexample, a failed test, an unmet expectation or a missed target.
    Failed,
}

impl Verdict {
    /// All verdicts, the best first.
    pub const ALL: [Self; 10] = [
        Self::Proved,
        Self::ProvedBounded,
        Self::ModelChecked,
        Self::Tested,
        Self::Measured,
        Self::NotRun,
        Self::Stale,
        Self::Undecided,
        Self::Vacuous,
        Self::Failed,
    ];

    /// The worst of these; `None` of nothing. Nothing is not a success: the caller must say what an empty set means.
    pub fn worst(verdicts: impl IntoIterator<Item = Self>) -> Option<Self> {
        verdicts.into_iter().max()
    }

    /// Whether it says that the claim holds, however strongly.
    pub fn holds(self) -> bool {
        self <= Self::Measured
    }

    /// Whether a run with this verdict can never end well, whatever was required of it: something was tried, and it
    /// went wrong or showed nothing.
    pub fn is_defect(self) -> bool {
        self >= Self::Undecided
    }

    /// Whether there is a result for these sources. [`Verdict::Undecided`] is one: the attempt is on record.
    pub fn is_result(self) -> bool {
        !matches!(self, Self::NotRun | Self::Stale)
    }

    /// The word for it, also its CSS class.
    pub fn word(self) -> &'static str {
        match self {
            Self::Proved => "proved",
            Self::ProvedBounded => "proved-bounded",
            Self::ModelChecked => "model-checked",
            Self::Tested => "tested",
            Self::Measured => "measured",
            Self::NotRun => "not-run",
            Self::Stale => "stale",
            Self::Undecided => "undecided",
            Self::Vacuous => "vacuous",
            Self::Failed => "failed",
        }
    }

    /// What the word means, for the reader of the case.
    pub fn meaning(self) -> &'static str {
        match self {
            Self::Proved => "a prover showed it for all inputs, states and valid parameters",
            Self::ProvedBounded => "a prover showed it for everything within the bound that is printed with it",
            Self::ModelChecked => {
                "every reachable state of a finite model was visited; states and parameters are printed"
            }
            Self::Tested => "it held for chosen inputs; says nothing about the others",
            Self::Measured => "figures of a simulation met their targets; says nothing about other circumstances",
            Self::NotRun => "nothing was run here",
            Self::Stale => "the result belongs to other sources than these",
            Self::Undecided => "an engine was started and ended without a result",
            Self::Vacuous => "a claim or a cover point cannot be reached, so the result says nothing",
            Self::Failed => "a counterexample, a failed test, an unmet expectation or a missed target",
        }
    }

    /// The sentence about a goal whose worst evidence has this verdict. Never stronger than that evidence.
    ///
    /// `worst` names the evidence with this verdict, `bounds` the bounds that were met on the way.
    pub fn conclusion(self, goal: &str, worst: &[String], bounds: &[String]) -> String {
        let named = list(worst, 2);
        let within = match bounds {
            [] => String::new(),
            [one] => format!(" The bound is: {one}."),
            [..] if bounds.len() <= 3 => format!(" The bounds are: {}.", bounds.join("; ")),
            [..] => {
                format!(
                    " The proofs that hold within bounds have {} different ones, listed after page one.",
                    bounds.len()
                )
            }
        };
        match self {
            Self::Proved => format!("{goal} is proved for all inputs, all valid states and all valid parameters."),
            Self::ProvedBounded => format!("{goal} is proved within bounds.{within} Beyond them it is not proved."),
            Self::ModelChecked => format!(
                "{goal} rests at its weakest point on an exhaustive search of finite models ({named}). Beyond their \
                 parameters it is not shown.{within}"
            ),
            Self::Tested => format!(
                "{goal} rests at its weakest point on tests ({named}). They show it for chosen inputs only.{within}"
            ),
            Self::Measured => format!(
                "{goal} rests at its weakest point on measurements of a simulation ({named}). They show it for what was \
                 simulated only.{within}"
            ),
            Self::NotRun => format!("{goal} is not shown: {named} has not been run."),
            Self::Stale => format!("{goal} is not shown: the result of {named} belongs to other sources."),
            Self::Undecided => format!("{goal} is not shown: {named} ended without a result."),
            Self::Vacuous => format!("{goal} is not shown: the result of {named} is vacuous."),
            Self::Failed => format!("{goal} does not hold as stated: {named} failed."),
        }
    }
}

impl std::fmt::Display for Verdict {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.pad(self.word())
    }
}

/// The first `most` of these, and how many more there are.
pub fn list(names: &[String], most: usize) -> String {
    let shown = names.iter().take(most).cloned().collect::<Vec<_>>().join(", ");
    if names.len() > most { format!("{shown} and {} more", names.len() - most) } else { shown }
}

#[cfg(test)]
mod tests {
    use super::Verdict;

    #[test]
    fn a_parent_takes_its_worst_child() {
        let children = [Verdict::Proved, Verdict::NotRun, Verdict::ModelChecked];
        assert_eq!(Verdict::worst(children), Some(Verdict::NotRun));
        assert_eq!(Verdict::worst([Verdict::Failed, Verdict::Vacuous]), Some(Verdict::Failed));
        assert_eq!(Verdict::worst([]), None);
    }

    #[test]
    fn the_order_is_the_documented_one() {
        assert!(Verdict::ALL.is_sorted());
        assert!(Verdict::Tested.holds() && Verdict::Measured.holds() && Verdict::Tested < Verdict::Measured);
        assert!(!Verdict::NotRun.holds() && !Verdict::Stale.holds());
        assert!(!Verdict::NotRun.is_defect() && Verdict::Undecided.is_defect() && Verdict::Vacuous.is_defect());
    }

    #[test]
    fn no_sentence_is_stronger_than_its_verdict() {
        let names = ["harness:t".to_owned()];
        for verdict in Verdict::ALL {
            let sentence = verdict.conclusion("G", &names, &[]);
            assert_eq!(sentence.contains("is proved for all"), verdict == Verdict::Proved, "{sentence}");
            assert_eq!(sentence.contains("not shown:") || sentence.contains("does not hold"), !verdict.holds());
        }
    }
}
