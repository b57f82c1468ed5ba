//! `safety-case render` and `safety-case verify`.

use super::checkout::checkout;
use crate::case::{Case, Kind, SCHEMA};
use crate::error::{Fault, read};
use crate::judge::build::at_station;
use crate::judge::stale;
use crate::render::files::{MARKER, SUMS};
use crate::render::output::Folder;
use crate::render::terminal;
use crate::sources::models;
use crate::sources::provenance::{self, now, sha256};
use crate::station;
use std::path::Path;

/// The case in a folder.
pub(super) fn load(from: &Path) -> Result<Case, Fault> {
    let path = from.join("case.json");
    let case: Case = serde_json::from_str(&read(&path)?)
        .map_err(|error| Fault::new(&path.display(), format!("no case: {error}")))?;
    if case.schema != SCHEMA {
        return Err(Fault::new(&path.display(), format!("schema {} is not known; {SCHEMA} is", case.schema)));
    }
    Ok(case)
}

/// The folders, and the lock file, that are not what the case was made from.
fn changed(case: &Case, root: &Path) -> Result<Vec<String>, Fault> {
    let now = provenance::collect(root, case.provenance.sources_sha256.clone())?;
    Ok(provenance::differences(&case.provenance, &now))
}

/// Writes a case again, as that of a station if a layout is given. What belongs to other sources becomes stale.
///
/// # Errors
/// There is no case, the layout cannot be read, or the case cannot be written.
pub fn render(from: &Path, layout: Option<&Path>, out: Option<&Path>, root: Option<&Path>) -> Result<u8, Vec<Fault>> {
    let one = |fault: Fault| vec![fault];
    let mut case = load(from).map_err(one)?;
    let station = layout.map(station::read).transpose()?;
    let place = |path: &Path| path.canonicalize().ok();
    let first = station.is_some() && case.station.is_none();
    if let Some(out) = out.filter(|out| first && place(out).is_some_and(|out| Some(out) == place(from))) {
        let text = "the case of a station would take the place of the one that it is made from; name another folder";
        return Err(vec![Fault::new(&out.display(), text)]);
    }
    let root = checkout(root).map_err(one)?;
    let changed = changed(&case, &root).map_err(one)?;
    stale::mark(&mut case, &changed);
    if let Some(station) = &station {
        at_station(&mut case, station);
    }
    // What the engines said stays with it.
    let results = std::fs::read_to_string(from.join(crate::judge::results::FILE)).ok();
    let folder = Folder::begin(out.unwrap_or(from)).map_err(one)?;
    folder.finish(&case, results).map_err(one)?;
    println!("{}", terminal::summary(&case));
    Ok(case.status.exit_code)
}

/// Hashes files and sources again, and searches random models once more. 1 if anything differs.
///
/// # Errors
/// There is no case.
pub fn verify(from: &Path, sample: usize, root: Option<&Path>) -> Result<u8, Vec<Fault>> {
    let one = |fault: Fault| vec![fault];
    let case = load(from).map_err(one)?;
    let root = checkout(root).map_err(one)?;
    let mut bad = Vec::new();
    let sums = read(&from.join(SUMS)).map_err(one)?;
    let mut files = 0;
    for line in sums.lines() {
        let Some((hash, name)) = line.split_once("  ") else {
            bad.push(format!("{SUMS}: a line that is no hash and name"));
            continue;
        };
        files += 1;
        match std::fs::read(from.join(name)) {
            Ok(bytes) if sha256(&bytes) == hash => {}
            Ok(_) => bad.push(format!("{name}: its contents have changed")),
            Err(error) => bad.push(format!("{name}: {error}")),
        }
    }
    if !sums.lines().any(|line| line.ends_with("  case.json")) {
        bad.push(format!("{SUMS} does not cover case.json"));
    }
    if from.join(MARKER).exists() {
        bad.push("the case is incomplete".to_owned());
    }
    let changed = changed(&case, &root).map_err(one)?;
    bad.extend(changed.iter().map(|name| format!("{name} is not what the case was made from")));
    println!("{files} files and {} folders hashed", case.provenance.folders.len());

    let entries = atc_models::catalogue();
    let ran: Vec<_> = entries
        .iter()
        .filter(|entry| {
            let id = format!("model:{}", entry.name);
            case.evidence.iter().any(|one| one.kind == Kind::Model && one.id == id && one.verdict.is_result())
        })
        .collect();
    // The clock is random enough to choose what to look at again.
    let from_clock = usize::try_from(now()).unwrap_or(0);
    for number in 0..sample.min(ran.len()) {
        let entry = ran[(from_clock + number) % ran.len()];
        let outcome = atc_models::check(entry, std::thread::available_parallelism().map_or(1, usize::from));
        let id = format!("model:{}", entry.name);
        let recorded = case.models.iter().find(|model| model.id == id).and_then(|model| model.unique_states);
        let states = models::thousands(outcome.unique_states);
        if recorded == u64::try_from(outcome.unique_states).ok() && outcome.ok() {
            println!("{id}: searched again, {states} states, as recorded");
        } else {
            bad.push(format!("{id}: searched again, {states} states; recorded were {}", recorded.unwrap_or(0)));
        }
    }
    for text in &bad {
        println!("differs: {text}");
    }
    println!("{}", if bad.is_empty() { "verified" } else { "NOT verified" });
    Ok(u8::from(!bad.is_empty()))
}
