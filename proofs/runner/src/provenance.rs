//! What exactly is checked: hashes, versions, commit.

use crate::report::Provenance;
use sha2::{Digest, Sha256};
use std::collections::BTreeMap;
use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::{SystemTime, UNIX_EPOCH};

/// The provenance of a run on the checkout at `root` that starts now; `seconds` is filled in at its end.
///
/// # Errors
/// A source file cannot be read.
pub fn of(root: &Path, tools: BTreeMap<String, String>, flags: Vec<String>) -> Result<Provenance, String> {
    let git = |arguments: &[&str]| {
        let output = Command::new("git").arg("-C").arg(root).args(arguments).output().ok()?;
        output.status.success().then(|| String::from_utf8_lossy(&output.stdout).trim().to_owned())
    };
    let lock = root.join("Cargo.lock");
    Ok(Provenance {
        commit: git(&["rev-parse", "HEAD"]),
        dirty: git(&["status", "--porcelain"]).map(|changes| !changes.is_empty()),
        cargo_lock_sha256: hex(Sha256::new().chain_update(read(&lock)?)),
        sources_sha256: sources_sha256(root)?,
        tools,
        flags,
        aspects: atc_proofs::ASPECTS,
        started_unix: SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |since| since.as_secs()),
        seconds: 0.0,
    })
}

/// SHA-256 over the paths and texts of everything that a proof depends on: kernel, arithmetic, harnesses, driver, mutants with
/// their counterexamples, runner.
///
/// # Errors
/// A source file cannot be read.
pub fn sources_sha256(root: &Path) -> Result<String, String> {
    let mut files = Vec::new();
    let proofs = ["proofs/src", "proofs/cbmc", "proofs/reals", "proofs/traps", "proofs/runner/src"];
    for folder in ["arithmetic/src", "kernel/src"].iter().chain(&proofs) {
        collect(&root.join(folder), &mut files)?;
    }
    files.extend(["mutants.toml", "counterexamples.tsv"].map(|name| root.join("proofs").join(name)));
    files.sort();
    let mut hash = Sha256::new();
    for file in files {
        let name = file.strip_prefix(root).unwrap_or(&file).to_string_lossy().replace('\\', "/");
        let text = read(&file)?;
        hash.update(format!("{name}\0{}\0", text.len()));
        hash.update(text);
    }
    Ok(hex(hash))
}

fn collect(folder: &Path, files: &mut Vec<PathBuf>) -> Result<(), String> {
    let failed = |error| format!("{}: {error}", folder.display());
    for entry in std::fs::read_dir(folder).map_err(failed)? {
        let path = entry.map_err(failed)?.path();
        if path.is_dir() { collect(&path, files)? } else { files.push(path) }
    }
    Ok(())
}

fn read(file: &Path) -> Result<Vec<u8>, String> {
    std::fs::read(file).map_err(|error| format!("{}: {error}", file.display()))
}

fn hex(hash: Sha256) -> String {
    hash.finalize().iter().fold(String::new(), |mut text, byte| {
        // Writing to a string does not fail.
        let _ = write!(text, "{byte:02x}");
        text
    })
}
