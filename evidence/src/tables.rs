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
    Ok(vec![
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
