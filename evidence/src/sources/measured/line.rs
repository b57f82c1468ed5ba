//! What the shortened operate time buys on a simulated line: measured here, read, and what would make it worthless.

use super::figures::{aimed, figure};
use super::target::Target;
use crate::case::Figure;
use atc_simulation::charts;
use atc_simulation::headline::{Extent, Headline, Row, measure as measured};
use std::fs;
use std::path::Path;

/// The file with the figures, in the folder of a run.
pub const FILE: &str = "headline.json";
/// The target that nothing unsafe happens.
pub const SAFE: &str = "line-safe";
/// The target that the new device never brakes alone.
pub const ALONE: &str = "line-needless";

const GROUP: &str = "A line with trains in motion";
/// So many interruptions of each length must have hit a train in motion, or nothing was seen.
const FEWEST: u32 = 20;
/// From this share of interruptions on a device is said to brake.
const MOST_OF_THEM: f64 = 0.9;

/// Whether a target is about the line.
pub fn is_of(target: &Target) -> bool {
    [SAFE, ALONE].contains(&target.name)
}

/// Measures it, and writes figures and picture into `folder`.
pub fn measure(folder: &Path) -> Result<(), String> {
    let headline = measured(&Extent::default())?;
    let text = serde_json::to_string_pretty(&headline).map_err(|error| error.to_string())?;
    let svg = charts::headline(&headline).map_err(|error| error.to_string())?;
    for (name, text) in [(FILE, text), ("shortened-operate.svg", svg)] {
        let path = folder.join(name);
        fs::write(&path, text).map_err(|error| format!("{}: {error}", path.display()))?;
    }
    Ok(())
}

/// Why the figures contradict each other.
pub fn contradiction(headline: &Headline) -> Option<String> {
    let more = |row: &&Row| [&row.shortened, &row.conventional].iter().any(|one| one.needless > one.interruptions);
    let row = headline.rows.iter().find(more)?;
    Some(format!("more brake applications than interruptions at {} ms", row.length_ms))
}

/// Why nothing was looked at: too few interruptions, or none that brakes even the conventional device.
pub fn vacuous(headline: &Headline) -> Option<String> {
    let few =
        |row: &&Row| row.length_ms > 0 && row.shortened.interruptions.min(row.conventional.interruptions) < FEWEST;
    if let Some(row) = headline.rows.iter().find(few) {
        return Some(format!("fewer than {FEWEST} interruptions of {} ms hit a train in motion", row.length_ms));
    }
    let [_, conventional] = headline.edges_ms(MOST_OF_THEM);
    conventional.is_none().then(|| "no interruption brakes even the conventional device".to_owned())
}

/// The figures.
pub fn figures(headline: &Headline) -> Vec<Figure> {
    let interruptions: u32 = headline.rows.iter().map(|row| row.shortened.interruptions).sum();
    let lengths = headline.rows.len();
    let longest = headline.rows.last().map_or(0, |row| row.length_ms);
    let of = format!("{} runs of {} s, interruptions of 0 to {longest} ms", 2 * lengths, headline.extent.seconds);
    let heard = format!("{interruptions} interruptions of {lengths} lengths");
    let count =
        |name: &str, value: u32, of: &str| figure(GROUP, name.to_owned(), Some(f64::from(value)), "", of.to_owned());
    let mut all = vec![
        aimed(count("Unsafe events", headline.unsafe_events(), &of), 0.0, SAFE),
        aimed(count("Brake commands of the shortened operate time alone", headline.alone(), &heard), 0.0, ALONE),
    ];
    for (name, edge) in ["shortened", "conventional"].into_iter().zip(headline.edges_ms(MOST_OF_THEM)) {
        let name = format!("Shortest interruption that brakes nine of ten trains: {name} operate time");
        let of = format!("steps of {} ms; shown only", headline.extent.step_ms);
        all.push(figure(GROUP, name, edge.map(f64::from), "ms", of));
    }
    let least = |of: fn(&Row) -> f64| headline.rows.iter().map(of).reduce(f64::min);
    for (name, value) in [
        ("Least distance to the stop point beyond the braking distance", least(|row| row.shortened.pattern_m)),
        ("Least distance from a front to its stop point", least(|row| row.shortened.stop_m)),
        ("Least distance from a front to the next train", least(|row| row.shortened.train_m)),
    ] {
        let of = format!("shortened operate time, {lengths} runs; shown only");
        all.push(figure(GROUP, name.to_owned(), value, "m", of));
    }
    all
}
