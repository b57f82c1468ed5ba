//! What the waveform package measures, and the headline of the simulation: run, read, and judged against the targets that the argument names.
//!
//! Figures are measured and never proved. Those without a target are shown only; no target is a time.

mod bench;
mod figures;
mod harm;
mod line;
mod target;

pub use bench::Bench;
pub use figures::{SPEED, shown};
use target::target;
pub use target::{Target, id};

use super::cargo;
use crate::case::{Engine, Evidence, Figure, Kind, Measurements, Plot};
use crate::judge::verdict::Verdict;
use atc_simulation::headline::Headline;
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use std::fs::{self, File};
use std::path::Path;
use std::process::Command;
use std::time::{Duration, Instant};

/// The waveform package, as an engine.
pub const ENGINE: &str = "waveform";
const WHAT: &str = "generator, channel, receivers, the track as a line, and a line with trains in motion, in floating point, outside the kernel";
const COMMAND: &str = "cargo run -p atc-waveform --bin waveform -- bench --quick --out FOLDER";

/// The source of a run that was started here, on these sources.
pub const HERE: &str = "run here";

/// Every target there is: part of the manifest before anything runs.
pub const TARGETS: &[Target] = &[
    target("ber-coherent", "telegram", "Without codes, bits are received within 1 dB of theory at every ratio."),
    target(
        "ber-offset",
        "telegram",
        "With carriers that are 1 Hz off, bits are received within 1 dB of theory at every ratio.",
    ),
    target(
        "ber-under-code",
        "telegram",
        "Under the codes' modulation, bits are received within 1 dB of theory at every ratio.",
    ),
    target("wrong-telegrams", "telegram", "No telegram is heard that was not sent, at any ratio of signal to noise."),
    target("wrong-speeds", "code", "No speed is heard that was not sent, at any ratio of signal to noise."),
    target("false-codes", "code", "No pair of codes names a speed in noise alone."),
    target(
        "level-tolerance",
        "position",
        "A level that is measured from samples is within 0.1 dB, from 30 dB of signal over noise.",
    ),
    target("position-inside", "position", "Inside the limits of its table no interval is without the train."),
    target("position-samples", "position", "Nor is one whose levels were measured from samples, with noise."),
    target(
        line::SAFE,
        "code",
        "Nothing unsafe happens on the simulated line, however long the cab signal is interrupted.",
    ),
    target(
        line::ALONE,
        "code",
        "A device with the shortened operate time never brakes where the conventional one, that hears the same, does not.",
    ),
    target(
        harm::SINGLE,
        "interlocking",
        "On the simulated line no single fault leads to harm, on codes, on telegrams and on both, under drivers who obey nothing.",
    ),
    target(
        harm::CUT_SETS,
        "interlocking",
        "The known pairs of wrong parts and faults do lead to harm there, so that it can be seen; and neither of the two alone does.",
    ),
];

/// What became of the run.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub enum Run {
    /// Nobody asked for it, or it cannot be built here.
    NotRun(String),
    /// It was started and gave no result.
    Failed(String),
    /// It ran.
    Ran(Box<Ran>),
}

/// A run that ended.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Ran {
    /// Its figures.
    pub bench: Bench,
    /// What the shortened operate time buys on a simulated line; nothing if that was not measured.
    #[serde(default)]
    pub headline: Option<Headline>,
    /// What faults lead to there; nothing if nobody looked.
    #[serde(default)]
    pub harm: Option<harm::Shown>,
    /// Its plots: name and drawing.
    pub plots: Vec<(String, String)>,
    /// [`HERE`], or the folder.
    pub source: String,
    /// Seconds; 0 if it is not known.
    pub seconds: f64,
}

/// Builds the package at `root`, runs it with its results in `folder`, for at most `limit`, and reads them. `watch` hears of
/// each log that is being written.
pub fn run(root: &Path, folder: &Path, limit: Duration, watch: &dyn Fn(&Path)) -> Run {
    if let Err(error) = fs::create_dir_all(folder) {
        return Run::Failed(format!("{}: {error}", folder.display()));
    }
    let logged = |log: &Path, mut command: Command| -> std::io::Result<Command> {
        let file = File::create(log)?;
        command.stdout(file.try_clone()?).stderr(file);
        watch(log);
        Ok(command)
    };
    let package = ["--color=never", "--bin", "waveform"];
    let built = logged(&folder.join("build.log"), cargo::command(root))
        .and_then(|mut command| cargo::status(command.arg("build").args(package).args(cargo::AS_IN_TESTS), None));
    match built {
        Err(error) => return Run::NotRun(format!("cargo cannot be started: {error}")),
        Ok(status) if !status.is_some_and(|status| status.success()) => {
            return Run::NotRun("atc-waveform cannot be built here: see `cargo build -p atc-waveform`".to_owned());
        }
        Ok(_) => {}
    }
    let log = folder.join("bench.log");
    let start = Instant::now();
    let program = root.join("target/debug/waveform");
    let ended = logged(&log, cargo::guarded(root, &program)).and_then(|mut command| {
        command.args(["bench", "--quick", "--out"]).arg(folder);
        cargo::status(&mut command, Some(limit))
    });
    match ended {
        Err(error) => Run::Failed(format!("the measurement cannot be started: {error}")),
        Ok(None) => Run::Failed(format!("no result within {} s", limit.as_secs())),
        Ok(Some(status)) if !status.success() => {
            let text = fs::read_to_string(&log).unwrap_or_default();
            let last = text.lines().rev().find(|line| !line.trim().is_empty()).unwrap_or("nothing was printed");
            Run::Failed(format!("the measurement ended with an error: {last}"))
        }
        Ok(Some(_)) => match line::measure(folder)
            .and_then(|()| harm::measure(folder))
            .map_or_else(Run::Failed, |()| read(folder, HERE))
        {
            Run::Ran(ran) => Run::Ran(Box::new(Ran { seconds: start.elapsed().as_secs_f64(), ..*ran })),
            other => other,
        },
    }
}

/// What the simulation wrote into a file of the folder; nothing if it was not measured.
fn recorded<T: DeserializeOwned>(folder: &Path, file: &str) -> Result<Option<T>, String> {
    let path = folder.join(file);
    if !path.exists() {
        return Ok(None);
    }
    let text = fs::read_to_string(&path).map_err(|error| format!("{}: {error}", path.display()))?;
    serde_json::from_str(&text).map(Some).map_err(|error| format!("{file} is not what the simulation writes: {error}"))
}

/// Reads the folder of a run.
pub fn read(folder: &Path, source: &str) -> Run {
    let path = folder.join("bench.json");
    let text = match fs::read_to_string(&path) {
        Ok(text) => text,
        Err(error) => return Run::Failed(format!("{}: {error}", path.display())),
    };
    let bench = match serde_json::from_str(&text) {
        Ok(bench) => bench,
        Err(error) => return Run::Failed(format!("bench.json is not what `waveform bench` writes: {error}")),
    };
    let headline = match recorded(folder, line::FILE) {
        Ok(headline) => headline,
        Err(error) => return Run::Failed(error),
    };
    let harm = match recorded(folder, harm::FILE) {
        Ok(harm) => harm,
        Err(error) => return Run::Failed(error),
    };
    let mut plots = Vec::new();
    for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
        let path = entry.path();
        if path.extension().is_some_and(|end| end == "svg") {
            let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
            match fs::read_to_string(&path) {
                Ok(svg) => plots.push((name, svg)),
                Err(error) => return Run::Failed(format!("{}: {error}", path.display())),
            }
        }
    }
    plots.sort();
    Run::Ran(Box::new(Ran { bench, headline, harm, plots, source: source.to_owned(), seconds: 0.0 }))
}

/// Leaves nothing of the raw results but the figures and the log: the plots are in the case.
pub fn tidy(folder: &Path) {
    for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
        let path = entry.path();
        let keep = ["bench.json", "bench.log", line::FILE, harm::FILE].iter().any(|name| path.ends_with(name));
        if !keep {
            // What stays is in the way of nobody.
            let _ = fs::remove_file(&path);
        }
    }
}

/// The evidence of every target, and what was measured.
pub fn evidence(run: &Run) -> (Vec<Evidence>, Measurements) {
    let bare = |verdict: Verdict, reason: &str| {
        let all = TARGETS.iter().map(|target| one(target, verdict, String::new(), Some(reason.to_owned())));
        (all.collect(), Measurements::default())
    };
    match run {
        Run::NotRun(why) => bare(Verdict::NotRun, why),
        Run::Failed(why) => bare(Verdict::Undecided, why),
        Run::Ran(ran) => {
            let mut figures = figures::all(&ran.bench);
            figures.extend(ran.headline.as_ref().map(line::figures).unwrap_or_default());
            figures.extend(ran.harm.as_ref().map(harm::figures).unwrap_or_default());
            let judged = TARGETS.iter().map(|target| {
                let absent = || (Verdict::NotRun, String::new(), Some("the line was not measured".to_owned()));
                let (verdict, detail, reason) = if line::is_of(target) {
                    ran.headline.as_ref().map_or_else(absent, |headline| {
                        judge(target, &figures, &|_| line::contradiction(headline), &|_| line::vacuous(headline))
                    })
                } else if harm::is_of(target) {
                    ran.harm.as_ref().map_or_else(absent, |shown| {
                        judge(target, &figures, &|_| harm::contradiction(shown), &|_| harm::vacuous(shown))
                    })
                } else {
                    let bench = &ran.bench;
                    judge(target, &figures, &|name| bench.contradiction(name), &|name| bench.vacuous(name))
                };
                one(target, verdict, detail, reason)
            });
            let evidence = judged.collect();
            let plots = ran.plots.iter().map(|(name, svg)| Plot {
                name: name.clone(),
                caption: figures::caption(name),
                svg: svg.get(svg.find("<svg").unwrap_or(0)..).unwrap_or_default().trim().to_owned(),
            });
            let measurements = Measurements {
                source: ran.source.clone(),
                conditions: figures::conditions(&ran.bench),
                figures: figures.clone(),
                plots: plots.collect(),
                films: ran.harm.as_ref().map(harm::films).unwrap_or_default(),
                seconds: ran.seconds,
            };
            (evidence, measurements)
        }
    }
}

/// A target is met if each of its figures is there and not above it, and the run looked at something.
fn judge(
    target: &Target,
    figures: &[Figure],
    contradiction: &dyn Fn(&str) -> Option<String>,
    vacuous: &dyn Fn(&str) -> Option<String>,
) -> (Verdict, String, Option<String>) {
    let id = id(target.name);
    let mine: Vec<_> = figures.iter().filter(|figure| figure.evidence.as_deref() == Some(&id)).collect();
    let detail: Vec<_> =
        mine.iter().map(|figure| format!("{} ({})", figures::shown(figure.value, &figure.unit), figure.of)).collect();
    let detail = detail.join("; ");
    if mine.is_empty() {
        return (Verdict::Vacuous, detail, Some("no figure belongs to this target".to_owned()));
    }
    if let Some(why) = contradiction(target.name) {
        return (Verdict::Undecided, detail, Some(why));
    }
    if let Some(why) = vacuous(target.name) {
        return (Verdict::Vacuous, detail, Some(why));
    }
    for figure in mine {
        let Some((value, limit)) = figure.value.zip(figure.at_most) else {
            return (Verdict::Undecided, detail, Some(format!("{}: the run could not tell", figure.name)));
        };
        if value > limit {
            let (value, limit) = (figures::shown(Some(value), &figure.unit), figures::shown(Some(limit), &figure.unit));
            return (
                Verdict::Failed,
                detail,
                Some(format!("{}: {value}, and at most {limit} is allowed", figure.name)),
            );
        }
    }
    (Verdict::Measured, detail, None)
}

fn one(target: &Target, verdict: Verdict, detail: String, reason: Option<String>) -> Evidence {
    Evidence {
        statement: target.statement.to_owned(),
        detail,
        reason,
        ..Evidence::bare(Kind::Measured, target.name, verdict)
    }
}

/// The package among the engines.
pub fn engine(evidence: &[Evidence], measurements: &Measurements) -> Engine {
    let mine: Vec<_> = evidence.iter().filter(|one| one.kind == Kind::Measured).collect();
    let met = mine.iter().filter(|one| one.verdict == Verdict::Measured).count();
    Engine {
        name: ENGINE.to_owned(),
        what: WHAT.to_owned(),
        verdict: Verdict::worst(mine.iter().map(|one| one.verdict)).unwrap_or(Verdict::NotRun),
        summary: if measurements.figures.is_empty() {
            "no result".to_owned()
        } else {
            let (figures, plots) = (measurements.figures.len(), measurements.plots.len());
            format!("{}: {met} of {} targets met; {figures} figures, {plots} plots", measurements.source, mine.len())
        },
        command: COMMAND.to_owned(),
    }
}

#[cfg(test)]
#[path = "measured_tests.rs"]
mod tests;
