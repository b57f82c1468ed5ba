//! `safety-case merge` and `safety-case compare`.

use super::checkout::{checkout, planned};
use super::options::{Merge, required};
use super::render::load;
use crate::error::Fault;
use crate::judge::alike::without_times;
use crate::judge::build::build;
use crate::judge::merge::join;
use crate::judge::{results, stale};
use crate::render::files::PAGE;
use crate::render::output::Folder;
use crate::render::terminal;
use crate::sources::{faults, provenance, second};
use serde_json::Value;
use std::path::Path;

/// Makes one case of the shards of a run.
///
/// # Errors
/// A folder has no results, the shards do not belong together, or the case's sources are bad.
pub fn merge(options: &Merge) -> Result<u8, Vec<Fault>> {
    let one = |fault: Fault| vec![fault];
    let root = checkout(options.root.as_deref()).map_err(one)?;
    let named = |path: &Path| Ok::<_, Fault>((path.display().to_string(), results::load(path)?));
    let shards = options.shards.iter().map(|path| named(path)).collect::<Result<Vec<_>, _>>().map_err(one)?;
    let mut joined = join(shards)?;
    let plan = planned(&root, options.config.as_deref(), options.layout.as_deref())?;
    let requirements: Vec<_> = plan.requirements.iter().map(|one| one.id.clone()).collect();
    faults::check(&joined.outcomes, &plan.data.assumptions, &requirements)?;
    let names: Vec<_> = plan.models.iter().map(|model| model.name.clone()).collect();
    second::check(&joined.opinions, &names)?;
    joined.provenance.generated_unix = provenance::now();
    let here = provenance::collect(&root, joined.provenance.sources_sha256.clone()).map_err(one)?;
    let changed = provenance::differences(&joined.provenance, &here);

    let folder = Folder::begin(&options.out).map_err(one)?;
    let said = results::json(&joined).map_err(one)?;
    let mut case = build(&plan, joined, required(options.require)).map_err(one)?;
    if !changed.is_empty() {
        stale::mark(&mut case, &changed);
    }
    folder.finish(&case, Some(said)).map_err(one)?;
    println!("{}", terminal::summary(&case));
    println!("open {}", options.out.join(PAGE).display());
    Ok(case.status.exit_code)
}

/// Whether two cases are the same but for their times. 1 if not.
///
/// # Errors
/// There is no case.
pub fn compare(one: &Path, other: &Path) -> Result<u8, Vec<Fault>> {
    let value = |path: &Path| -> Result<Value, Fault> {
        serde_json::to_value(without_times(load(path)?)).map_err(|error| Fault::new(&path.display(), error))
    };
    let pair = value(one).and_then(|first| Ok((first, value(other)?)));
    let (first, second) = pair.map_err(|fault| vec![fault])?;
    let mut places = Vec::new();
    differences("", &first, &second, &mut places);
    for place in &places {
        println!("differs: {place}");
    }
    println!("{}", if places.is_empty() { "the same, but for times" } else { "NOT the same" });
    Ok(u8::from(!places.is_empty()))
}

/// The places in which two values differ.
fn differences(at: &str, one: &Value, other: &Value, places: &mut Vec<String>) {
    match (one, other) {
        (Value::Object(a), Value::Object(b)) if a.keys().eq(b.keys()) => {
            a.iter().zip(b.values()).for_each(|((key, a), b)| differences(&format!("{at}/{key}"), a, b, places));
        }
        (Value::Array(a), Value::Array(b)) if a.len() == b.len() => {
            (0..).zip(a.iter().zip(b)).for_each(|(place, (a, b))| {
                let name = a["id"].as_str().map_or_else(|| place.to_string(), ToOwned::to_owned);
                differences(&format!("{at}/{name}"), a, b, places);
            });
        }
        _ if one == other => {}
        _ => {
            let short = |value: &Value| value.to_string().chars().take(120).collect::<String>();
            places.push(format!("{at}: {} and {}", short(one), short(other)));
        }
    }
}
