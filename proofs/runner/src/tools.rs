//! The provers' tools, as `ci/install-provers` left them.

use crate::process::SOLVER;
use std::collections::BTreeMap;
use std::os::unix::fs::PermissionsExt;
use std::path::{Path, PathBuf};

/// The tools of the cbmc engine.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Tools {
    bin: PathBuf,
    /// The folder of `wasm-rt.h`.
    pub include: PathBuf,
    /// Tool → version and origin.
    pub versions: BTreeMap<String, String>,
}

const NEEDED: [&str; 4] = ["rustc", "wasm-ld", "wasm2c", "cbmc"];

impl Tools {
    /// The tools below `target/provers` of this checkout.
    ///
    /// # Errors
    /// What is missing and how it can be had.
    pub fn find(root: &Path) -> Result<Self, String> {
        let provers = root.join("target").join("provers");
        let list = provers.join("tools.json");
        let hint = "run ci/install-provers";
        let text = std::fs::read_to_string(&list)
            .map_err(|error| format!("the provers are not installed ({}: {error}); {hint}", list.display()))?;
        let known: BTreeMap<String, Option<Entry>> = serde_json::from_str(&text)
            .map_err(|error| format!("{} cannot be read: {error}; {hint}", list.display()))?;
        let missing: Vec<_> =
            NEEDED.iter().filter(|tool| known.get(**tool).is_none_or(Option::is_none)).copied().collect();
        if !missing.is_empty() {
            return Err(format!("not to be had on this machine: {}; {hint} says what would help", missing.join(", ")));
        }
        let versions = known
            .into_iter()
            .filter_map(|(tool, entry)| entry.map(|entry| (tool, format!("{} ({})", entry.version, entry.origin))))
            .collect();
        Ok(Self { bin: provers.join("bin"), include: provers.join("include"), versions })
    }

    /// A wrapper of the solver `tool`, of the same name, with an option of it, that ends with the runner. Written when it is first asked for.
    pub fn guarded(&self, tool: &str, option: &str) -> PathBuf {
        let folder = self.bin.join(format!("guarded{option}"));
        let script = folder.join(tool);
        let head = format!("\nsolver='{}'\nset -- {option} \"$@\"\n", self.path(tool).display());
        let text = SOLVER.replacen('\n', &head, 1);
        if std::fs::read_to_string(&script).is_ok_and(|known| known == text) {
            return script;
        }
        let part = folder.join(format!("{tool}.{:?}", std::thread::current().id()));
        let written = std::fs::create_dir_all(&folder)
            .and_then(|()| std::fs::write(&part, text))
            .and_then(|()| std::fs::set_permissions(&part, std::fs::Permissions::from_mode(0o755)))
            .and_then(|()| std::fs::rename(&part, &script));
        // Without it the solver itself, which may outlive a runner that is killed.
        written.map_or_else(|_| self.path(tool), |()| script)
    }

    /// The wrapper of `tool`.
    pub fn path(&self, tool: &str) -> PathBuf {
        self.bin.join(tool)
    }
}

#[derive(serde::Deserialize)]
struct Entry {
    version: String,
    origin: String,
}
