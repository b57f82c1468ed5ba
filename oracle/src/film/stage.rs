//! Track plans from layouts.

use std::collections::BTreeMap;

use atc_film::Plan;
use atc_layout::{Description, Names, draw};

/// The plan of a layout.
///
/// # Errors
/// What is wrong with its tracks.
pub(super) fn drawn(description: &Description) -> Result<Plan, String> {
    let model = description.tracks().map_err(|errors| errors.to_string())?;
    Ok(Plan {
        name: description.station.name.clone(),
        svg: draw::svg_as_laid(&description.station, &model),
        pieces: Vec::new(),
        names: BTreeMap::new(),
    })
}

/// The plan of a layout that was given for a session: it must have every circuit and point that the session has.
///
/// # Errors
/// What it does not have; what is wrong with its tracks.
pub(super) fn fitting(description: &Description, names: &Names) -> Result<Plan, String> {
    let model = description.tracks().map_err(|errors| errors.to_string())?;
    let circuits: Vec<&str> = model.circuits.iter().map(|one| one.name.as_str()).collect();
    let points: Vec<&str> = model.points.iter().map(|one| one.name.as_str()).collect();
    for (kind, its, there) in [("circuit", &names.circuits, &circuits), ("point", &names.points, &points)] {
        let missing: Vec<&str> = its.iter().map(String::as_str).filter(|name| !there.contains(name)).collect();
        if !missing.is_empty() {
            return Err(format!(
                "the layout {:?} is not that of the session: it has no {kind} {}; it has {}",
                description.station.name,
                missing.join(", "),
                there.join(", ")
            ));
        }
    }
    drawn(description)
}
