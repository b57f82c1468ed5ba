//! Kernel and harnesses, compiled for this machine by the compiler that compiles the project.

use crate::compile::write;
use crate::process::{End, Job, Limits, errors_of, run};
use atc_proofs::Harness;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::time::Duration;

/// Of every compilation. It runs for milliseconds: optimised, it would be compiled for longer. An overflow is a panic, as in the proofs.
const RUSTC: [&str; 5] =
    ["--edition=2024", "-Copt-level=0", "-Coverflow-checks=on", "-Cdebuginfo=0", "--cap-lints=allow"];

const LIMITS: Limits = Limits { cpu: Duration::from_mins(4), memory_kib: 8 << 20 };

/// Compiles `proofs/src/bin/replay.rs` of the copy `sources` into `folder`, with these harnesses (all of them if none is named).
///
/// # Errors
/// What the compiler said, or that there is none.
pub fn build(sources: &Path, folder: &Path, only: &[&Harness], options: &[String]) -> Result<PathBuf, String> {
    let chosen = if only.is_empty() { Vec::new() } else { choose(sources, only)? };
    let program = folder.join("replay");
    let linked = |name: &str| format!("--extern=atc_{name}={}", folder.join(format!("libatc_{name}.rlib")).display());
    let mut known = vec![format!("-Ldependency={}", folder.display())];
    for name in ["arithmetic", "kernel", "proofs"] {
        let crate_name = format!("--crate-name=atc_{name}");
        let kind = [vec![crate_name, "--crate-type=rlib".to_owned()], known.clone(), chosen.clone()].concat();
        let output = folder.join(format!("libatc_{name}.rlib"));
        rustc(&sources.join(name).join("src/lib.rs"), &output, &[&kind[..], options].concat())?;
        known.push(linked(name));
    }
    rustc(&sources.join("proofs/src/bin/replay.rs"), &program, &[&known[..], options].concat())?;
    Ok(program)
}

/// Makes the copy one with these harnesses alone. The options that say so.
fn choose(sources: &Path, only: &[&Harness]) -> Result<Vec<String>, String> {
    let read = |path: &Path| std::fs::read_to_string(path).map_err(|error| format!("{}: {error}", path.display()));
    let mut list = String::new();
    for harness in only {
        // The module that the harness is has another one for its body.
        let path = harness.module.trim_end_matches("::body").trim_start_matches("atc_proofs::");
        let _ = write!(list, "crate::{path}::HARNESS, ");
        let module = sources.join("proofs/src").join(path.split("::").next().unwrap_or_default());
        for file in [module.join("mod.rs"), module.with_extension("rs")].iter().filter(|file| file.exists()) {
            write(file, &read(file)?.replace("\nmod ", "\npub mod "))?;
        }
    }
    let root = sources.join("proofs/src/lib.rs");
    write(&root, &format!("{}\npub static HARNESSES: &[&[Harness]] = &[&[{list}]];\n", read(&root)?))?;
    let names = only.iter().map(|harness| format!("--cfg={}", harness.name));
    Ok(std::iter::once("--cfg=chosen".to_owned()).chain(names).collect())
}

fn rustc(source: &Path, output: &Path, options: &[String]) -> Result<(), String> {
    let folder = output.parent().unwrap_or(output);
    let compiler = std::env::var_os("RUSTC").unwrap_or_else(|| "rustc".into());
    let mut arguments: Vec<String> = RUSTC.iter().map(ToString::to_string).collect();
    arguments.extend_from_slice(options);
    arguments.extend(["-o".to_owned(), output.display().to_string(), source.display().to_string()]);
    let said = folder.join("native-rustc.out");
    let program = Path::new(&compiler);
    let job = Job { program, arguments: &arguments, variables: &[], folder, output: &said, limits: LIMITS };
    match run(&job)?.0 {
        End::Code(0) => Ok(()),
        end => {
            let errors = std::fs::read_to_string(errors_of(&said)).unwrap_or_default();
            let first: Vec<_> = errors.lines().skip_while(|line| !line.starts_with("error")).take(6).collect();
            Err(format!("{} {}: {end:?}: {}", program.display(), source.display(), first.join(" / ")))
        }
    }
}
