//! What a harness says of a mutant, and what shows that it rejects it.

use crate::report::Kill;
use crate::twin::{self, Tape};
use atc_proofs::Harness;

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

/// What shows that the harness rejects the mutant: what happens on these values with the mutant, and what without it.
///
/// # Errors
/// Why it does not show that.
pub fn rejects(harness: &Harness, tape: &Tape, with: &[String], without: &[String]) -> Result<Kill, String> {
    let (name, values) = (harness.name, &tape.values);
    let name_of = |number: &usize| harness.claims.get(*number).map(|claim| claim.name.to_owned());
    let mut claims: Vec<String> = twin::failed(with).iter().filter_map(name_of).collect();
    claims.dedup();
    claims.extend(twin::panics(with).then(|| "trap: panic".to_owned()));
    if claims.is_empty() {
        Err(format!("{name}: the prover's counterexample does not fail when it is run: {values:?}"))
    } else if !twin::failed(without).is_empty() || twin::panics(without) {
        Err(format!("{name}: the counterexample fails with no mutant selected, too: {values:?}"))
    } else {
        let counterexample = Some(values.clone());
        Ok(Kill { harness: name.to_owned(), claims, case: tape.case, counterexample, asked: false })
    }
}

#[cfg(test)]
mod tests {
    use super::rejects;
    use crate::twin::Tape;

    #[test]
    fn only_what_fails_with_the_mutant_and_not_without_it_rejects_it() {
        let harness = crate::select(&["t_acc_1".to_owned()]).unwrap()[0];
        let tape = Tape { mutant: 1, case: 2, values: vec![5] };
        let said = |lines: &[&str]| lines.iter().map(ToString::to_string).collect::<Vec<_>>();
        let (fails, holds) = (said(&["run 1", "claim 0 0", "end"]), said(&["run 0", "claim 0 1", "end"]));
        let panics = said(&["run 1", "trap: panic 0"]);
        let kill = rejects(harness, &tape, &fails, &holds).unwrap();
        assert_eq!((kill.claims.len(), kill.case, kill.counterexample), (1, 2, Some(vec![5])));
        assert_eq!(rejects(harness, &tape, &panics, &holds).unwrap().claims, ["trap: panic"]);
        // What is assumed away says nothing.
        for (with, without) in
            [(&holds, &holds), (&fails, &fails), (&fails, &panics), (&said(&["run 1", "assumed away"]), &holds)]
        {
            assert!(rejects(harness, &tape, with, without).is_err(), "{with:?} {without:?}");
        }
    }
}
