//! The folder of a case: written aside, then put in place at once; and the mark of a run that did not end.

use super::{gsn, html, junit, sarif, tables};
use crate::case::Case;
use crate::error::Fault;
use crate::render::files::{MARKER, PAGE, STATION, SUMS};
use crate::sources::provenance::sha256;
use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::{fs, io};

/// A case's folder while its run goes on.
#[derive(Debug)]
pub struct Folder {
    out: PathBuf,
    stage: PathBuf,
}

impl Folder {
    /// Marks the folder as incomplete, also one of an earlier run, and makes room beside it for the new files.
    ///
    /// # Errors
    /// The folder has files that are no safety case, or cannot be written.
    pub fn begin(out: &Path) -> Result<Self, Fault> {
        let fault = |error: io::Error| Fault::new(&out.display(), error);
        let ours = |name: &str| out.join(name).exists();
        if out.is_dir() && !ours("case.json") && !ours(MARKER) && fs::read_dir(out).map_err(fault)?.next().is_some() {
            let text = "the folder has files that are no safety case; they would be lost: give an empty or new folder";
            return Err(Fault::new(&out.display(), text));
        }
        fs::create_dir_all(out).map_err(fault)?;
        fs::write(out.join(MARKER), "A run has started here and has not ended.\n").map_err(fault)?;
        let stage = beside(out, ".part");
        if stage.exists() {
            fs::remove_dir_all(&stage).map_err(fault)?;
        }
        fs::create_dir_all(&stage).map_err(fault)?;
        fs::write(stage.join(MARKER), "A run has started here and has not ended.\n").map_err(fault)?;
        Ok(Self { out: out.to_path_buf(), stage })
    }

    /// Takes away what an earlier run has left, so that nothing of it can be taken for this one, and shows this page.
    ///
    /// # Errors
    /// A file cannot be written or taken away.
    pub fn clear(&self, page: &str) -> Result<(), Fault> {
        let fault = |error: io::Error| Fault::new(&self.out.display(), error);
        self.show(page)?;
        for entry in fs::read_dir(&self.out).map_err(fault)? {
            let path = entry.map_err(fault)?.path();
            if path.ends_with(MARKER) || path.ends_with(PAGE) {
                continue;
            }
            if path.is_dir() { fs::remove_dir_all(&path) } else { fs::remove_file(&path) }.map_err(fault)?;
        }
        Ok(())
    }

    /// Puts a page in place at once, while the run goes on.
    ///
    /// # Errors
    /// It cannot be written.
    pub fn show(&self, page: &str) -> Result<(), Fault> {
        let new = self.out.join("index.html.new");
        let put = fs::write(&new, page).and_then(|()| fs::rename(&new, self.out.join(PAGE)));
        put.map_err(|error| Fault::new(&new.display(), error))
    }

    /// Where files of the run may be put while it goes on.
    pub fn stage(&self) -> &Path {
        &self.stage
    }

    /// Writes the case, and what the engines said if it is known; takes the mark away if nothing is missing, and puts the folder in place.
    ///
    /// # Errors
    /// A file cannot be written.
    pub fn finish(self, case: &Case, results: Option<String>) -> Result<(), Fault> {
        let fault = |error: io::Error| Fault::new(&self.out.display(), error);
        let mut files = files(case)?;
        files.extend(results.map(|results| (crate::judge::results::FILE.to_owned(), results)));
        let mut sums = String::new();
        for (name, contents) in &files {
            let path = self.stage.join(name);
            if let Some(parent) = path.parent() {
                fs::create_dir_all(parent).map_err(fault)?;
            }
            fs::write(&path, contents).map_err(fault)?;
            let _ = writeln!(sums, "{}  {name}", sha256(contents.as_bytes()));
        }
        fs::write(self.stage.join(SUMS), sums).map_err(fault)?;
        let marker = self.stage.join(MARKER);
        if case.status.complete {
            fs::remove_file(&marker).map_err(fault)?;
        } else {
            fs::write(&marker, format!("No result for:\n{}\n", case.status.missing.join("\n"))).map_err(fault)?;
        }
        let old = beside(&self.out, ".old");
        if old.exists() {
            fs::remove_dir_all(&old).map_err(fault)?;
        }
        fs::rename(&self.out, &old).map_err(fault)?;
        fs::rename(&self.stage, &self.out).map_err(fault)?;
        fs::remove_dir_all(&old).map_err(fault)
    }
}

fn beside(out: &Path, end: &str) -> PathBuf {
    let mut name = out.file_name().unwrap_or_default().to_os_string();
    name.push(end);
    out.with_file_name(name)
}

/// Every file of the case: name and contents.
///
/// # Errors
/// The case cannot be written in one of the forms.
pub fn files(case: &Case) -> Result<Vec<(String, String)>, Fault> {
    let fault = |name: &str, error: String| Fault::new(&name, error);
    let json = serde_json::to_string_pretty(case).map_err(|error| fault("case.json", error.to_string()))?;
    let mut files = vec![
        (PAGE.to_owned(), html::document(case)),
        ("case.json".to_owned(), format!("{json}\n")),
        ("case.schema.json".to_owned(), schema()),
        ("junit.xml".to_owned(), junit::xml(case).map_err(|error| fault("junit.xml", error))?),
        (sarif::FILE.to_owned(), sarif::json(case).map_err(|error| fault(sarif::FILE, error))?),
    ];
    files.extend(gsn::files(case));
    files.extend(tables::files(case).map_err(|error| fault("tables", error))?);
    for one in &case.evidence {
        if let Some(words) = &one.counterexample {
            let name = one.id.trim_start_matches("harness:");
            files.push((format!("counterexamples/{name}.json"), format!("{}\n", serde_json::json!(words))));
            files.push((format!("counterexamples/{name}.rs"), regression(name, words)));
        }
    }
    for model in &case.models {
        for (chart, number) in model.charts.iter().zip(1..) {
            let name = model.id.trim_start_matches("model:");
            files.push((format!("traces/{name}-{number}.jsonl"), chart.trace.clone()));
            files.push((format!("traces/{name}-{number}.svg"), chart.svg.clone()));
        }
    }
    for plot in &case.measurements.plots {
        files.push((format!("plots/{}.svg", plot.name), format!("{}\n", plot.svg)));
    }
    for film in &case.measurements.films {
        files.push((format!("films/{}.html", film.name), film.page.clone()));
    }
    if let Some(station) = &case.station {
        files.push((STATION.to_owned(), html::station_page(case, station)));
        files.push(("station/layout.toml".to_owned(), station.layout.clone()));
        if !station.drawing.is_empty() {
            files.push(("station/track-plan.svg".to_owned(), station.drawing.clone()));
        }
        if !station.table_page.is_empty() {
            files.push(("station/control-table.html".to_owned(), station.table_page.clone()));
        }
    }
    for set in &case.cut_sets {
        files.push((format!("traces/{}.jsonl", set.number), set.chart.trace.clone()));
        files.push((format!("traces/{}.svg", set.number), set.chart.svg.clone()));
    }
    Ok(files)
}

/// A counterexample as a test: it passes when the harness holds for these values.
fn regression(harness: &str, words: &[u16]) -> String {
    format!(
        "//! Counterexample of `{harness}`. It fails until the kernel or the theorem is mended.\n\n\
         #[test]\nfn {harness}_counterexample() {{\n    \
         let words = {words:?};\n    \
         let harness = atc_proofs::HARNESSES.iter().copied().flatten().find(|one| one.name == \"{harness}\");\n    \
         let run = atc_prover::native::replay(harness.expect(\"a harness of this name\"), &words);\n    \
         assert_eq!(run.failed(), Vec::<u32>::new());\n}}\n"
    )
}

/// The JSON Schema of `case.json`.
pub fn schema() -> String {
    let schema = schemars::schema_for!(Case);
    format!("{}\n", serde_json::to_string_pretty(&schema).unwrap_or_default())
}
