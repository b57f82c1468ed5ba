//! The checkout that the case is made of, and the plan that is read from it.

use crate::error::Fault;
use crate::judge::plan::{Plan, plan};
use crate::sources::line;
use crate::sources::mutants;
use crate::station;
use std::path::{Path, PathBuf};

/// The checkout: the given folder, or the nearest one above the current folder that has the kernel and the
/// specification.
pub(super) fn checkout(given: Option<&Path>) -> Result<PathBuf, Fault> {
    let is_root =
        |path: &Path| path.join("kernel").is_dir() && path.join("spec").is_dir() && path.join("Cargo.lock").is_file();
    let start = match given {
        Some(path) => path.to_path_buf(),
        None => std::env::current_dir().map_err(|error| Fault::new(&"current folder", error))?,
    };
    let start = start.canonicalize().map_err(|error| Fault::new(&start.display(), error))?;
    let found = if given.is_some() {
        Some(start.as_path()).filter(|path| is_root(path))
    } else {
        start.ancestors().find(|path| is_root(path))
    };
    found.map(Path::to_path_buf).ok_or_else(|| {
        Fault::new(
            &start.display(),
            "this is not the checkout (a folder with kernel/, spec/ and Cargo.lock): give --root",
        )
    })
}

/// The plan for this line and station.
pub(super) fn planned(root: &Path, config: Option<&Path>, layout: Option<&Path>) -> Result<Plan, Vec<Fault>> {
    let one = |fault: Fault| vec![fault];
    let line = config.map_or_else(line::example, line::read)?;
    // Of the trains that run there only a line of one's own says anything; the example does not.
    let trains = config.and_then(|_| line.lives());
    let station = layout.map(station::read).transpose()?.map(|station| match trains {
        Some(trains) => station.with_trains(line.name(), trains),
        None => station,
    });
    plan(root, (line, station), mutants::catalogue(root).map_err(one)?)
}
