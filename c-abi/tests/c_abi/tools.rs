//! Compilers, and the library that they link.

use std::ffi::OsString;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// A folder of its own for what a test writes.
pub struct Scratch(tempfile::TempDir);

impl Scratch {
    pub fn new() -> Self {
        Self(tempfile::tempdir().expect("a temporary folder can be made"))
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    pub fn file(&self, name: &str, text: &str) -> OsString {
        let path = self.path(name);
        fs::write(&path, text).expect("a file can be written");
        path.into()
    }
}

/// The option that finds the header.
pub fn include() -> OsString {
    format!("-I{}/include", env!("CARGO_MANIFEST_DIR")).into()
}

/// The static library that cargo has made beside this test.
pub fn library() -> PathBuf {
    let test = std::env::current_exe().expect("a test knows where it is");
    let deps = test.parent().unwrap_or(Path::new("."));
    let made = |folder: &Path| folder.join("libatc_c.a");
    [made(deps), made(deps.parent().unwrap_or(deps))]
        .into_iter()
        .find(|path| path.exists())
        .expect("cargo made libatc_c.a")
}

/// Runs a tool; `None` if it is not here.
pub fn run(tool: &str, options: impl IntoIterator<Item = OsString>) -> Option<Output> {
    match Command::new(tool).args(options).output() {
        Ok(output) => Some(output),
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => None,
        Err(error) => panic!("{tool}: {error}"),
    }
}
