//! What the engines said, as a file beside the case: another run of `safety-case` makes the case from it again.

use crate::error::{Fault, read};
use crate::judge::build::Results;
use serde::{Deserialize, Serialize};
use std::path::Path;

/// The file in the folder of a case.
pub const FILE: &str = "results.json";
/// The version of its shape.
const SCHEMA: u32 = 2;

#[derive(Serialize)]
struct Written<'a> {
    schema: u32,
    results: &'a Results,
}

#[derive(Deserialize)]
struct Read {
    schema: u32,
    results: Results,
}

/// The text of the file.
///
/// # Errors
/// The results cannot be written as JSON.
pub fn json(results: &Results) -> Result<String, Fault> {
    serde_json::to_string(&Written { schema: SCHEMA, results })
        .map(|text| format!("{text}\n"))
        .map_err(|error| Fault::new(&FILE, error))
}

/// The results in the folder of a run.
///
/// # Errors
/// The file is not there, is none, or has another shape.
pub fn load(folder: &Path) -> Result<Results, Fault> {
    let path = folder.join(FILE);
    let text = read(&path).map_err(|fault| {
        let text = format!(
            "{}; give the folders that `safety-case run --shard i/n --out FOLDER` wrote to its end",
            fault.text
        );
        Fault::new(&fault.at, text)
    })?;
    let none = |error: serde_json::Error| Fault::new(&path.display(), format!("no results of a run: {error}"));
    // The version first: another shape may not be readable at all.
    let value: serde_json::Value = serde_json::from_str(&text).map_err(none)?;
    if value["schema"] != SCHEMA {
        let text = format!("schema {} is not known; {SCHEMA} is", value["schema"]);
        return Err(Fault::new(&path.display(), text));
    }
    let read: Read = serde_json::from_str(&text).map_err(none)?;
    debug_assert_eq!(read.schema, SCHEMA);
    Ok(read.results)
}
