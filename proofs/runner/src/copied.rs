//! A copy of the sources as texts, in which mutants are selected by name, and the folder that holds it.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

/// The names of the mutants to select, with commas.
pub(crate) const VARIABLE: &str = "ATC_OLD_RULES";

/// Files by their path from the checkout.
pub(crate) type Files = BTreeMap<PathBuf, Vec<u8>>;

pub(crate) fn text(path: &Path) -> Result<String, String> {
    std::fs::read_to_string(path).map_err(|error| format!("{}: {error}", path.display()))
}

/// All files below a folder.
pub(crate) fn read(root: &Path, folder: &Path, files: &mut Files) -> Result<(), String> {
    let from = root.join(folder);
    let failed = |error: std::io::Error| format!("{}: {error}", from.display());
    for entry in std::fs::read_dir(&from).map_err(failed)? {
        let entry = entry.map_err(failed)?;
        let path = folder.join(entry.file_name());
        if !entry.path().is_dir() {
            files.insert(path, std::fs::read(entry.path()).map_err(failed)?);
        } else if entry.file_name() != "target" {
            read(root, &path, files)?;
        }
    }
    Ok(())
}

/// What a program calls before anything else, and what selects one mutant alone while it runs. `rest`: what is done with another name.
pub(crate) fn selector(names: &[&str], rest: &str) -> String {
    let mut written = format!(
        "extern crate std;
         /// Selects the mutants that the environment names.
         pub fn select() {{
             let names = std::env::var({VARIABLE:?}).unwrap_or_default();
             for name in names.split(',').filter(|name| !name.is_empty()) {{
                 assert!(add(name).is_ok(), \"there is no mutant {{name}}\");
             }}
         }}
         /// Selects this mutant alone; none, if the name is empty.
         pub fn choose(name: &str) -> Result<(), ()> {{
             unsafe {{ SELECTED = [0; {count}]; }}
             add(name)
         }}
         fn add(name: &str) -> Result<(), ()> {{
             let number = match name {{\n",
        count = names.len()
    );
    for (number, name) in names.iter().enumerate() {
        let _ = writeln!(written, "{name:?} => {number},");
    }
    let _ = write!(written, "_ => {rest},\n}};\nunsafe {{ SELECTED[number] = 1; }}\nOk(()) }}\n");
    written
}

pub(crate) fn rewrite(
    files: &mut Files,
    path: &str,
    change: impl FnOnce(&str) -> Result<String, String>,
) -> Result<(), String> {
    let file = files.get_mut(Path::new(path)).ok_or_else(|| format!("{path} is not there"))?;
    let text = std::str::from_utf8(file).map_err(|error| format!("{path}: {error}"))?;
    *file = change(text).map_err(|error| format!("{path}: {error}"))?.into_bytes();
    Ok(())
}

pub(crate) fn once(text: &str, find: &str, replace: &str) -> Result<String, String> {
    match text.matches(find).count() {
        1 => Ok(text.replacen(find, replace, 1)),
        count => Err(format!("`{find}` stands there {count} times, not once")),
    }
}

/// Makes the folder hold these files and no other. One that is right already stays as it is, so that it is not compiled again.
pub(crate) fn settle(folder: &Path, files: &Files) -> Result<(), String> {
    let failed = |path: &Path, error: std::io::Error| format!("{}: {error}", path.display());
    let mut there = Files::new();
    if folder.exists() {
        read(folder, Path::new(""), &mut there)?;
    }
    for path in there.keys().filter(|path| !files.contains_key(*path)) {
        let path = folder.join(path);
        std::fs::remove_file(&path).map_err(|error| failed(&path, error))?;
    }
    for (path, bytes) in files.iter().filter(|(path, bytes)| there.get(*path) != Some(bytes)) {
        let path = folder.join(path);
        if let Some(parent) = path.parent() {
            std::fs::create_dir_all(parent).map_err(|error| failed(&path, error))?;
        }
        std::fs::write(&path, bytes).map_err(|error| failed(&path, error))?;
    }
    Ok(())
}
