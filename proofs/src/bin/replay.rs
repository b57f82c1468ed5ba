//! Runs one harness on given values, natively, and prints what happens: `replay HARNESS < TAPES`.
//!
//! Input and output are those of the C of a harness (`cbmc/driver.c`). A line of input is a run: the number of a mutant (0: none), the case,
//! and the arbitrary values in order. The runner of the proofs compiles this program with all mutants in the kernel (`--cfg mutants`), and
//! runs the counterexamples that are kept in `counterexamples.tsv`. Compiled by cargo it has none, and only 0 can be selected.

use atc_proofs::{Engine, HARNESSES};
use std::io::BufRead;
use std::ops::RangeInclusive;
use std::panic::{AssertUnwindSafe, catch_unwind, panic_any, set_hook};
use std::process::ExitCode;

/// Ends a run whose assumptions do not hold: nothing is said of it.
struct AssumedAway;

/// The values of a run: 0 when they run out.
struct Tape<'a> {
    case: usize,
    values: std::str::SplitWhitespace<'a>,
}

impl Engine for Tape<'_> {
    fn word(&mut self, _: &'static str, _: RangeInclusive<u16>) -> u16 {
        self.values.next().and_then(|value| value.parse().ok()).unwrap_or(0)
    }

    fn choose(&mut self, _: &'static str, _: usize) -> usize {
        self.case
    }

    fn assume(&mut self, holds: bool) {
        if !holds {
            panic_any(AssumedAway)
        }
    }

    fn claim(&mut self, number: u32, holds: bool) {
        println!("claim {number} {}", u8::from(holds));
    }

    fn cover(&mut self, number: u32, reached: bool) {
        println!("cover {number} {}", u8::from(reached));
    }
}

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let named = |name: &String| HARNESSES.iter().copied().flatten().find(|harness| harness.name == *name);
    let harness = match &arguments[..] {
        [name] => named(name).ok_or_else(|| format!("there is no harness `{name}`")),
        _ => Err("usage: replay HARNESS < TAPES".to_owned()),
    };
    let ran = harness.and_then(|harness| {
        // A panic is an answer here, and no accident.
        set_hook(Box::new(|_| ()));
        for line in std::io::stdin().lock().lines() {
            let line = line.map_err(|error| format!("the standard input cannot be read: {error}"))?;
            let mut values = line.split_whitespace();
            let mut number = |what: &str| {
                let number = values.next().and_then(|number| number.parse::<usize>().ok());
                number.ok_or_else(|| {
                    format!("`{line}` does not begin with the numbers of a mutant and a case: no {what}")
                })
            };
            let (mutant, case) = (number("mutant")?, number("case")?);
            select(mutant)?;
            println!("run {mutant}");
            let mut tape = Tape { case, values };
            match catch_unwind(AssertUnwindSafe(|| (harness.run)(&mut tape))) {
                Ok(()) => println!("end"),
                Err(payload) if payload.is::<AssumedAway>() => println!("assumed away"),
                Err(_) => println!("trap: panic 0"),
            }
        }
        Ok(())
    });
    match ran {
        Ok(()) => ExitCode::SUCCESS,
        Err(reason) => {
            eprintln!("error: {reason}");
            ExitCode::from(2)
        }
    }
}

#[cfg(mutants)]
fn select(mutant: usize) -> Result<(), String> {
    if atc_kernel::select(mutant) { Ok(()) } else { Err(format!("no mutant has the number {mutant}")) }
}

#[cfg(not(mutants))]
fn select(mutant: usize) -> Result<(), String> {
    if mutant == 0 {
        Ok(())
    } else {
        Err(format!("mutant {mutant} is not in this kernel: it was compiled without any"))
    }
}
