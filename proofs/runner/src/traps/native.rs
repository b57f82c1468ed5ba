//! The traps as programs: the same C, compiled by the machine's own compiler and run on drawn values.
//!
//! It tests what `traps.toml` declares: a claim that holds never fails, and one that fails does with the values that
//! are named.

use super::Trap;
use crate::cbmc::{Answer, Silence};
use crate::process::{End, Job, Limits, errors_of, run as run_job};
use std::path::Path;
use std::time::Duration;

/// What `folder` (with the trap's `driver.c`) says when it is run: what held, and what was reached.
pub fn run(trap: &Trap, folder: &Path, limit: Duration) -> Result<(Answer, Answer), Silence> {
    let source = crate::root().join("proofs/traps/native.c");
    let answer = |reach: bool| {
        let name = if reach { "native-reach" } else { "native" };
        let program = folder.join(name);
        let mut arguments: Vec<String> = ["-O1", "-w", "-fwrapv", "-o"].map(ToOwned::to_owned).to_vec();
        arguments.extend([program.display().to_string(), source.display().to_string()]);
        arguments.extend(["-I".to_owned(), folder.display().to_string()]);
        arguments.extend(["-I".to_owned(), crate::root().join("target/provers/include").display().to_string()]);
        if !trap.direct {
            arguments.extend([format!("-DHARNESS={}", trap.name), "-DCASE=0".to_owned(), "-DCASES=1".to_owned()]);
            arguments.push("-DWASM_RT_USE_MMAP=0".to_owned());
            arguments.push("-DWASM_RT_NONCONFORMING_UNCHECKED_STACK_EXHAUSTION=1".to_owned());
        }
        arguments.extend(reach.then(|| "-DREACH".to_owned()));
        ended(Path::new("cc"), &arguments, folder, &folder.join(format!("{name}.cc")), limit)?;
        let given = |values: &Vec<u16>| values.iter().map(ToString::to_string).collect::<Vec<_>>().join(",");
        let runs: Vec<String> = trap.fail.values().chain(&trap.values).map(given).collect();
        let output = folder.join(format!("{name}.out"));
        ended(&program, &runs, folder, &output, limit)?;
        let text = std::fs::read_to_string(&output).map_err(|error| Silence::Broken(error.to_string()))?;
        Ok(read(&text))
    };
    Ok((answer(false)?, answer(true)?))
}

fn ended(program: &Path, arguments: &[String], folder: &Path, output: &Path, time: Duration) -> Result<(), Silence> {
    let limits = Limits { cpu: time, memory_kib: 4 << 20 };
    match run_job(&Job { program, arguments, variables: &[], folder, output, limits }).map_err(Silence::Broken)?.0 {
        End::Code(0) => Ok(()),
        End::Late => Err(Silence::Late),
        end => {
            let said = std::fs::read_to_string(errors_of(output)).unwrap_or_default();
            Err(Silence::Broken(format!("{}: {end:?}: {said}", program.display())))
        }
    }
}

fn read(text: &str) -> Answer {
    let line = |line: &str| line.split_once(' ').map(|(failed, what)| (what.to_owned(), failed == "0"));
    Answer { holds: text.lines().filter_map(line).collect(), ..Answer::default() }
}
