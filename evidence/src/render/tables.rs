//! The registers as comma-separated values.

use crate::case::Case;

/// File names and contents.
///
/// # Errors
/// A row cannot be written.
pub fn files(case: &Case) -> Result<Vec<(String, String)>, String> {
    let hazards = case.hazards.iter().map(|one| {
        [
            one.id.clone(),
            one.title.clone(),
            one.severity.clone(),
            one.causes.join("; "),
            one.mitigated_by.join(" "),
            one.requirements.join(" "),
            one.verdict.to_string(),
            one.residual.join(" "),
            one.cut_sets.join(" "),
            one.remains.clone(),
        ]
    });
    let conditions = case.conditions.iter().map(|one| {
        [
            one.number.clone(),
            one.id.clone(),
            one.statement.clone(),
            one.why.clone(),
            one.hazards.join(" "),
            one.addressee.clone(),
            one.check.clone(),
            one.owner.clone(),
            one.used_by.join(" "),
        ]
    });
    let requirements = case.requirements.iter().map(|one| {
        [
            one.id.clone(),
            one.sentence.clone(),
            one.at.clone(),
            one.code.join(" "),
            one.harnesses.join(" "),
            one.mutants.join(" "),
            one.models.join(" "),
            one.tests.join(" "),
            one.verdict.to_string(),
        ]
    });
    let measurements = case.measurements.figures.iter().map(|one| {
        let number = |value: Option<f64>| value.map_or_else(String::new, |value| value.to_string());
        [
            one.group.clone(),
            one.name.clone(),
            number(one.value),
            one.unit.clone(),
            number(one.theory),
            number(one.at_most),
            one.of.clone(),
            one.evidence.clone().unwrap_or_default(),
        ]
    });
    let mut files = faults(case)?;
    files.push(accidents(case)?);
    files.push((
        "measurements.csv".to_owned(),
        table(["group", "figure", "value", "unit", "theory", "at most", "of", "evidence"], measurements)?,
    ));
    files.extend([
        (
            "hazards.csv".to_owned(),
            table(
                [
                    "id",
                    "hazard",
                    "severity",
                    "causes",
                    "mitigated by",
                    "requirements",
                    "verdict",
                    "conditions",
                    "cut sets",
                    "remains",
                ],
                hazards,
            )?,
        ),
        (
            "srac.csv".to_owned(),
            table(
                ["number", "id", "condition", "why", "hazards", "addressee", "check", "owner", "used by"],
                conditions,
            )?,
        ),
        (
            "traceability.csv".to_owned(),
            table(
                ["requirement", "sentence", "at", "code", "theorems", "wrong kernels", "models", "tests", "verdict"],
                requirements,
            )?,
        ),
    ]);
    Ok(files)
}

/// The accidents that were found with legal input.
fn accidents(case: &Case) -> Result<(String, String), String> {
    let rows = case.accidents.iter().map(|one| {
        [
            one.name.clone(),
            one.hazards.join(" "),
            one.happened.clone(),
            one.rules.join(" "),
            one.excluded_by.join(" "),
            one.verdict.to_string(),
            one.conditions.join(" "),
        ]
    });
    let head = ["session", "hazards", "what happened", "rules", "excluded by", "verdict", "conditions"];
    Ok(("accidents.csv".to_owned(), table(head, rows)?))
}

/// Cut sets and failure modes.
fn faults(case: &Case) -> Result<Vec<(String, String)>, String> {
    let cut_sets = case.cut_sets.iter().map(|one| {
        let owners: Vec<_> = one.excluded_by.iter().map(|by| format!("{}: {}", by.condition, by.owner)).collect();
        [
            one.number.clone(),
            one.faults.join("; "),
            one.text.clone(),
            one.hazards.join(" "),
            owners.join("; "),
            one.found_by.join(" "),
        ]
    });
    let failure_modes = case.failure_modes.iter().map(|one| {
        let safe = if one.safe { "yes" } else { "no" };
        [
            one.fault.clone(),
            one.text.clone(),
            safe.to_owned(),
            one.effect.clone(),
            one.states.to_string(),
            one.model.clone(),
        ]
    });
    Ok(vec![
        (
            "cut-sets.csv".to_owned(),
            table(["number", "faults", "what happens", "hazards", "excluded by", "found by"], cut_sets)?,
        ),
        (
            "failure-modes.csv".to_owned(),
            table(["fault", "what it is", "safe", "what is reported", "states", "model"], failure_modes)?,
        ),
    ])
}

fn table<const N: usize>(head: [&str; N], rows: impl Iterator<Item = [String; N]>) -> Result<String, String> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    writer.write_record(head).map_err(|error| error.to_string())?;
    for row in rows {
        writer.write_record(row).map_err(|error| error.to_string())?;
    }
    let bytes = writer.into_inner().map_err(|error| error.to_string())?;
    String::from_utf8(bytes).map_err(|error| error.to_string())
}
