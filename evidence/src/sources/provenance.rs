//! What the case is bound to: commit, lock file, sources, tools.

use crate::case::Provenance;
use crate::error::Fault;
use sha2::{Digest, Sha256};
use std::collections::BTreeMap;
use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::process::Command;

/// The folders whose contents are evidence or produce it, each with its own hash.
pub const FOLDERS: &[&str] = &[
    "arithmetic",
    "c-abi",
    "kernel",
    "layout",
    "line",
    "proofs",
    "models",
    "protocol",
    "oracle",
    "waveform",
    "simulation",
    "film",
    "tests",
    "spec",
    "evidence",
];

/// The SHA-256 of the contents of a folder, file names and sizes included; build output and hidden files excluded.
///
/// # Errors
/// A file cannot be read.
pub fn folder(root: &Path, name: &str) -> Result<String, Fault> {
    let mut hash = Sha256::new();
    for path in walk(&root.join(name))? {
        let bytes = std::fs::read(&path).map_err(|error| Fault::new(&path.display(), error))?;
        let name = path.strip_prefix(root).unwrap_or(&path).to_string_lossy().replace('\\', "/");
        hash.update(format!("{} {} {}\n", name.len(), name, bytes.len()));
        hash.update(&bytes);
    }
    Ok(hex(&hash.finalize()))
}

/// The SHA-256 of bytes, in hexadecimal.
pub fn sha256(bytes: &[u8]) -> String {
    hex(&Sha256::digest(bytes))
}

/// What the case is bound to, before any engine has run. `sources` is the provers' own hash of what they see.
///
/// # Errors
/// A file of the checkout cannot be read.
pub fn collect(root: &Path, sources: String) -> Result<Provenance, Fault> {
    let lock = root.join("Cargo.lock");
    let lock_bytes = std::fs::read(&lock).map_err(|error| Fault::new(&lock.display(), error))?;
    let mut folders = BTreeMap::new();
    for name in FOLDERS {
        folders.insert((*name).to_owned(), folder(root, name)?);
    }
    let mut tools = BTreeMap::new();
    for tool in ["rustc", "cargo"] {
        if let Some(version) = answer(root, tool, &["--version"]) {
            tools.insert(tool.to_owned(), version);
        }
    }
    if let Some(version) = tools.get("rustc").cloned() {
        tools.insert(HOST.to_owned(), version);
    }
    Ok(Provenance {
        commit: answer(root, "git", &["rev-parse", "HEAD"]),
        dirty: answer(root, "git", &["status", "--porcelain"]).map(|changes| !changes.is_empty()),
        cargo_lock_sha256: sha256(&lock_bytes),
        sources_sha256: sources,
        folders,
        tools,
        generated_unix: now(),
        ..Provenance::default()
    })
}

/// The compiler of the machine, which makes tests and models. The provers' own takes its place under `rustc`.
pub const HOST: &str = "rustc of this machine";

/// The folders, and the lock file, in which two provenances differ.
pub fn differences(one: &Provenance, other: &Provenance) -> Vec<String> {
    let folders = one.folders.iter().filter(|(name, hash)| other.folders.get(*name) != Some(*hash));
    let lock = (one.cargo_lock_sha256 != other.cargo_lock_sha256).then(|| "Cargo.lock".to_owned());
    folders.map(|(name, _)| name.clone()).chain(lock).collect()
}

/// Seconds since 1970-01-01 UTC.
pub fn now() -> u64 {
    std::time::SystemTime::now().duration_since(std::time::UNIX_EPOCH).map_or(0, |time| time.as_secs())
}

/// What a tool says, without the last line end; nothing if it is not there or complains.
fn answer(root: &Path, tool: &str, arguments: &[&str]) -> Option<String> {
    let output = Command::new(tool).args(arguments).current_dir(root).output().ok()?;
    output.status.success().then(|| String::from_utf8_lossy(&output.stdout).trim_end().to_owned())
}

fn walk(folder: &Path) -> Result<Vec<PathBuf>, Fault> {
    let entries = std::fs::read_dir(folder).map_err(|error| Fault::new(&folder.display(), error))?;
    let mut paths: Vec<_> = entries.filter_map(|entry| Some(entry.ok()?.path())).collect();
    paths.sort();
    let mut files = Vec::new();
    for path in paths {
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        let made = ["target", "corpus", "artifacts", "coverage"].contains(&name.as_ref());
        if name.starts_with('.') || made && path.is_dir() {
            continue;
        }
        if path.is_dir() {
            files.extend(walk(&path)?);
        } else {
            files.push(path);
        }
    }
    Ok(files)
}

fn hex(bytes: &[u8]) -> String {
    bytes.iter().fold(String::new(), |mut text, byte| {
        // Writing to a string does not fail.
        let _ = write!(text, "{byte:02x}");
        text
    })
}

#[cfg(test)]
mod tests {
    use super::folder;

    #[test]
    fn a_changed_a_moved_and_an_added_file_change_the_hash() {
        let root = tempfile::tempdir().expect("a folder");
        std::fs::create_dir(root.path().join("kernel")).expect("a folder");
        let write =
            |name: &str, text: &str| std::fs::write(root.path().join("kernel").join(name), text).expect("written");
        write("a", "1");
        let first = folder(root.path(), "kernel").expect("hashed");
        assert_eq!(folder(root.path(), "kernel"), Ok(first.clone()));
        write("a", "2");
        let second = folder(root.path(), "kernel").expect("hashed");
        write("b", "");
        let third = folder(root.path(), "kernel").expect("hashed");
        assert!(first != second && second != third && first != third);
    }
}
