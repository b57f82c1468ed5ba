//! Faults on a simulated line: that no single one leads to harm, and that known pairs do, which a page plays.

use super::figures::{aimed, figure};
use super::target::Target;
use crate::case::{Figure, Film};
use atc_simulation::cut_sets::{Page, Row, Seen, Single, see};
use serde::{Deserialize, Serialize};
use std::fs;
use std::path::Path;

/// The file with what was seen, in the folder of a run.
pub const FILE: &str = "harm.json";
/// The target that no single fault leads to harm.
pub const SINGLE: &str = "line-single-faults";
/// The target that every cut set does, and nothing less.
pub const CUT_SETS: &str = "line-cut-sets";

const GROUP: &str = "Faults on a line with trains in motion";
/// How many runs there are with each kind of fault, on each kind of signal.
const EACH: u64 = 4;
/// So many arrivals a run there must be, or the trains did not run.
const FEWEST: u64 = 3;

/// What was seen, and the pages that play it.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Shown {
    /// Figures.
    pub seen: Seen,
    /// Pages.
    pub pages: Vec<Page>,
}

/// Whether a target is about faults on the line.
pub fn is_of(target: &Target) -> bool {
    [SINGLE, CUT_SETS].contains(&target.name)
}

/// Looks, and writes what was seen into `folder`.
pub fn measure(folder: &Path) -> Result<(), String> {
    let (seen, pages) = see(EACH)?;
    let text = serde_json::to_string_pretty(&Shown { seen, pages }).map_err(|error| error.to_string())?;
    let path = folder.join(FILE);
    fs::write(&path, text).map_err(|error| format!("{}: {error}", path.display()))
}

/// Why the figures contradict each other.
pub fn contradiction(shown: &Shown) -> Option<String> {
    let more =
        |single: &&Single| single.unsafe_runs > single.runs || single.first.is_some() != (single.unsafe_runs > 0);
    let single = shown.seen.singles.iter().find(more)?;
    Some(format!("{} unsafe runs of {} on {}", single.unsafe_runs, single.runs, single.signal))
}

/// Why nothing was looked at: no runs, trains that do not run, no cut sets.
pub fn vacuous(shown: &Shown) -> Option<String> {
    let Seen { singles, cut_sets } = &shown.seen;
    if singles.is_empty() || cut_sets.is_empty() {
        return Some("there are no runs, or no cut sets".to_owned());
    }
    let stands = |single: &&Single| single.runs == 0 || single.arrivals < FEWEST * single.runs;
    let single = singles.iter().find(stands)?;
    Some(format!("{} runs on {} with {} arrivals: the trains do not run", single.runs, single.signal, single.arrivals))
}

/// The figures.
pub fn figures(shown: &Shown) -> Vec<Figure> {
    let count = |name: String, value: usize, of: String| {
        let value = u32::try_from(value).unwrap_or(u32::MAX);
        figure(GROUP, name, Some(f64::from(value)), "", of)
    };
    let Seen { singles, cut_sets } = &shown.seen;
    let mut all: Vec<Figure> = singles
        .iter()
        .map(|single| {
            let first = single.first.as_ref().map_or_else(String::new, |first| format!("; {first}"));
            let of = format!(
                "{} runs of 10 minutes, {} arrivals, drivers who obey nothing{first}",
                single.runs, single.arrivals
            );
            let unsafe_runs = usize::try_from(single.unsafe_runs).unwrap_or(usize::MAX);
            aimed(count(format!("Unsafe runs with one fault, on {}", single.signal), unsafe_runs, of), 0.0, SINGLE)
        })
        .collect();
    let named = |rows: &[&Row]| rows.iter().map(|row| row.both.join(" + ")).collect::<Vec<_>>().join("; ");
    let unseen: Vec<&Row> = cut_sets.iter().filter(|row| row.harm.is_none()).collect();
    let less: Vec<&Row> = cut_sets.iter().filter(|row| row.alone.iter().any(Option::is_some)).collect();
    let of = |rows: &[&Row]| if rows.is_empty() { named(&cut_sets.iter().collect::<Vec<_>>()) } else { named(rows) };
    all.push(aimed(count("Cut sets of which no harm was seen".to_owned(), unseen.len(), of(&unseen)), 0.0, CUT_SETS));
    all.push(aimed(
        count("Cut sets of which one thing alone leads to harm".to_owned(), less.len(), of(&less)),
        0.0,
        CUT_SETS,
    ));
    all
}

/// The pages that play the accidents.
pub fn films(shown: &Shown) -> Vec<Film> {
    let film = |page: &Page| Film { name: page.name.clone(), caption: page.caption.clone(), page: page.html.clone() };
    shown.pages.iter().map(film).collect()
}
