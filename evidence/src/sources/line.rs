//! The specific application: one line's data, read and checked by `atc-line`, as a part of the case.

use crate::case::{Evidence, Kind, Line};
use crate::error::Fault;
use atc_line::Problems;
use atc_line::line::Line as Data;
use std::path::Path;

/// The patent's example, for a case without a line of one's own.
pub const EXAMPLE: &str = include_str!("../../examples/my-line.toml");

/// The example, read.
///
/// # Errors
/// Never while its test passes: it is a line.
pub fn example() -> Result<Data, Vec<Fault>> {
    atc_line::parse("evidence/examples/my-line.toml", EXAMPLE, Path::new("evidence/examples"))
        .map_err(|problems| faults(&problems))
}

/// A line of one's own, with the layouts that it names.
///
/// # Errors
/// What keeps the file from being a line; a rule between its parts that is broken is no error here: the case says so.
pub fn read(path: &Path) -> Result<Data, Vec<Fault>> {
    atc_line::read(path).map_err(|problems| faults(&problems))
}

fn faults(problems: &Problems) -> Vec<Fault> {
    let fault = |problem: &atc_line::Problem| {
        // The message begins with the place, which a fault has apart.
        let text = problem.to_string();
        let text = text.strip_prefix(&format!("{}: ", problem.at)).unwrap_or(&text).to_owned();
        Fault::new(&problem.at, text)
    };
    problems.0.iter().map(fault).collect()
}

/// The line as part of a case, with the verdicts of the theorems that it instantiates.
pub fn case(line: &Data, evidence: &[Evidence]) -> Line {
    let harnesses = evidence.iter().filter(|one| one.kind == Kind::Harness);
    let mut notes = line.notes();
    notes.extend(proved_sizes(line));
    Line {
        name: line.name().to_owned(),
        source: line.source().to_owned(),
        cycle_ms: line.aspect().cycle_ms,
        aspects_km_h: line.table().speeds().iter().map(|speed| f64::from(speed.0) / 10.0).collect(),
        times: line.times_kept(),
        blocks: line.blocks(),
        sections: line.sections(),
        derived: line.derived(),
        notes,
        theorems: harnesses.map(|one| (one.id.clone(), one.verdict)).collect(),
        checks: atc_protocol::devices::checks(line),
    }
}

/// Where the line is larger than what a theorem is proved for.
fn proved_sizes(line: &Data) -> Vec<String> {
    let (aspects, proved) = (line.table().speeds().len(), atc_proofs::ASPECTS);
    let (cycle, proved_cycle) = (line.aspect().cycle_ms, atc_proofs::time::CYCLE_MS);
    let mut notes = Vec::new();
    if aspects > proved {
        notes.push(format!(
            "This line has {aspects} aspects. A theorem that is proved for {proved} aspects is not proved for it: see the \
             condition that carries it further."
        ));
    }
    if u64::from(cycle) != u64::from(proved_cycle) {
        notes.push(format!(
            "The rounding theorem is proved for a cycle of {proved_cycle} ms. For this line's cycle of {cycle} ms the rounding of \
             each time was computed and compared: see the data checks."
        ));
    }
    notes
}

#[cfg(test)]
#[path = "line_tests.rs"]
mod tests;
