//! `oracle conform` and `oracle vectors` on the command line.

use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};
use std::time::Duration;

use atc_oracle::conform::fields::Level;
use atc_oracle::conform::profile::Profile;
use atc_oracle::conform::report::{self, Past, Report};
use atc_oracle::conform::run::{self, Options, Run, Verdict};
use atc_oracle::conform::vectors::{self, Set, Vector};
use atc_oracle::conform::walk;
use atc_protocol::form::Line;
use atc_protocol::machine::{self, KINDS};
use clap::{Args, ValueEnum};
use serde_json::{Value, json};

use super::{Failure, print, remark, write};

#[derive(Args)]
#[command(
    after_help = "Exit code: 0 if all that was compared is the same; 1 if something differs, the other side broke, a known \
    difference is gone, or nothing was compared; 2 for wrong arguments or files.\n\
    oracle/CONFORM.md goes through an example."
)]
pub(crate) struct ConformArgs {
    /// The command of the other side, as a shell takes it: it reads requests on standard input and replies on standard output
    #[arg(long = "impl", value_name = "CMD")]
    implementation: String,
    /// Only this machine; may be given several times [default: every machine]
    #[arg(long, value_name = "MACHINE")]
    machine: Vec<String>,
    /// The seed of the walks
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// How long to compare, over all machines: 60s, 2m, 500ms; shrinking comes on top
    #[arg(long, default_value = "60s", value_parser = duration)]
    time: Duration,
    /// At most this many cases for each machine, however long it takes
    #[arg(long, value_name = "NUMBER", value_parser = clap::value_parser!(u64).range(1..))]
    cases: Option<u64>,
    /// One configuration for every case: the body of a start's config as JSON or TOML, such as a layout; needs one --machine
    #[arg(long, value_name = "FILE")]
    config: Option<PathBuf>,
    /// How much of a reply is compared [default: reason, or what the profile says]
    #[arg(long, value_enum)]
    level: Option<LevelArg>,
    /// What is compared and what is known to differ (TOML)
    #[arg(long, value_name = "FILE.toml")]
    profile: Option<PathBuf>,
    /// The vectors in this folder in place of walks
    #[arg(long, value_name = "DIR")]
    vectors: Option<PathBuf>,
    /// How long the other side has for each reply
    #[arg(long, default_value = "2s", value_parser = duration)]
    timeout: Duration,
    /// How long the shrinking of one difference may take
    #[arg(long, default_value = "20s", value_parser = duration)]
    shrink_time: Duration,
    /// Everything in a folder: page, JSON, JUnit, badge, and the traces with their vectors and sessions
    #[arg(long, value_name = "DIR")]
    report: Option<PathBuf>,
    /// The report as JUnit
    #[arg(long, value_name = "FILE.xml")]
    junit: Option<PathBuf>,
    /// The report as JSON (`oracle schema report`)
    #[arg(long, value_name = "FILE.json")]
    json: Option<PathBuf>,
}

#[derive(Clone, Copy, ValueEnum)]
pub(crate) enum LevelArg {
    /// What leaves the device
    Output,
    /// And the reasons of refusals and the names of faults
    Reason,
    /// And what is remembered, where the other side reports it
    State,
}

impl LevelArg {
    pub(crate) const fn level(self) -> Level {
        match self {
            Self::Output => Level::Output,
            Self::Reason => Level::Reason,
            Self::State => Level::State,
        }
    }
}

#[derive(Args)]
pub(crate) struct VectorsArgs {
    /// Where the files go: a folder that is not there, is empty, or holds vectors
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
    /// Only this machine; may be given several times [default: every machine]
    #[arg(long, value_name = "MACHINE")]
    machine: Vec<String>,
    /// How many
    #[arg(long, value_enum, default_value = "thorough")]
    set: SetArg,
}

#[derive(Clone, Copy, ValueEnum)]
enum SetArg {
    /// More than 1000: run in a minute
    Minimal,
    /// More than 10,000
    Thorough,
}

/// Reads a time such as `60s`, `2m` or `500ms`; a number alone is seconds.
pub(crate) fn duration(text: &str) -> Result<Duration, String> {
    let split = text.find(|letter: char| !letter.is_ascii_digit()).unwrap_or(text.len());
    let (number, unit) = text.split_at(split);
    let milliseconds = match unit {
        "ms" => 1,
        "" | "s" => 1000,
        "m" => 60_000,
        "h" => 3_600_000,
        _ => 0,
    };
    let number = number.parse::<u64>().ok().filter(|number| *number > 0 && milliseconds > 0);
    let time = number.and_then(|number| number.checked_mul(milliseconds)).map(Duration::from_millis);
    // Longer than anybody waits, and short enough for every clock.
    let time = time.filter(|time| *time <= Duration::from_secs(1_000_000));
    time.ok_or_else(|| "a time is a whole number above 0 with ms, s, m or h, such as 60s, at most 1000000s".to_owned())
}

pub(crate) fn machines(names: &[String]) -> Result<(), Failure> {
    let all: Vec<_> = KINDS.iter().map(|kind| kind.name).collect();
    match names.iter().find(|name| machine::find(name).is_none()) {
        Some(name) => Err(Failure::Asked(format!("there is no machine {name:?}; there are {}", all.join(", ")))),
        None => Ok(()),
    }
}

pub(crate) fn read_asked(path: &Path) -> Result<String, Failure> {
    super::read(path).map_err(|failure| Failure::Asked(failure.to_string()))
}

pub(crate) fn conform(args: &ConformArgs) -> Result<(), Failure> {
    let options = options(args)?;
    // What cannot be written is told before the work, not after it.
    let past = match &args.report {
        Some(folder) => {
            fs::create_dir_all(folder).map_err(|error| Failure::Asked(format!("{}: {error}", folder.display())))?;
            past(&folder.join(HISTORY))
        }
        None => Vec::new(),
    };
    let run = run::run(options, |machine| {
        let word = match machine.verdict {
            Verdict::Agrees => "agrees",
            Verdict::Differs(..) => "DIFFERS",
            Verdict::NotCompared(_) => "not compared",
            Verdict::Gone(_) => "a known difference is gone",
        };
        remark(&format!("{}: {word}, {} steps the same\n", machine.name, machine.steps));
    });
    let report = report::report(&run);
    let json = format!("{:#}\n", serde_json::to_value(&report).unwrap_or_default());
    let junit = report::junit(&report).map_err(Failure::Asked)?;
    if let Some(folder) = &args.report {
        folder_of(folder, &run, &report, &past, (&json, &junit))?;
    }
    args.json.iter().try_for_each(|path| write(path, &json))?;
    args.junit.iter().try_for_each(|path| write(path, &junit))?;
    print(&report::text(&report))?;
    if report.agrees { Ok(()) } else { Err(Failure::Differs) }
}

fn options(args: &ConformArgs) -> Result<Options, Failure> {
    machines(&args.machine)?;
    let profile = match &args.profile {
        Some(path) => {
            let profile = Profile::parse(&read_asked(path)?);
            profile.map_err(|reason| Failure::Asked(format!("{}: {reason}", path.display())))?
        }
        None => Profile::default(),
    };
    let level = args.level.map(LevelArg::level);
    let config = args.config.as_ref().map(|path| config(path, &args.machine)).transpose()?;
    let vectors = args.vectors.as_ref().map(|folder| vectors_in(folder, &args.machine)).transpose()?;
    Ok(Options {
        command: args.implementation.clone(),
        machines: args.machine.clone(),
        seed: args.seed,
        time: args.time,
        cases: args.cases,
        config,
        patience: args.timeout,
        shrink: args.shrink_time,
        level: level.or(profile.level).unwrap_or_default(),
        profile,
        vectors: vectors.unwrap_or_default(),
    })
}

/// A configuration that the kernel takes.
pub(crate) fn config(path: &Path, machines: &[String]) -> Result<Value, Failure> {
    let [machine] = machines else {
        return Err(Failure::Asked("--config is the configuration of one machine: name it with --machine".to_owned()));
    };
    let wrong = |reason: String| Failure::Asked(format!("{}: {reason}", path.display()));
    let text = read_asked(path)?;
    let is_toml = path.extension().is_some_and(|extension| extension == "toml");
    let config: Value = if is_toml {
        toml::from_str(&text).map_err(|error| wrong(error.to_string().trim_end().to_owned()))?
    } else {
        serde_json::from_str(&text).map_err(|error| wrong(error.to_string()))?
    };
    let line = Line::start(machine, &config).text();
    let mut reply = Vec::new();
    atc_protocol::Session::new().answer(line.as_bytes(), &mut reply);
    let reply: Value = serde_json::from_slice(&reply).unwrap_or_default();
    if reply.get("started").is_some() {
        return Ok(config);
    }
    let reason = ["rejected", "malformed"].iter().find_map(|kind| reply[kind]["reason"].as_str());
    Err(wrong(format!("{machine} does not take it: {}", reason.unwrap_or_default())))
}

fn vectors_in(folder: &Path, machines: &[String]) -> Result<Vec<Vector>, Failure> {
    let file = |name: &str| {
        let path = folder.join(name);
        fs::read_to_string(&path)
            .map_err(|error| format!("it cannot be read: {error}"))
            .map_err(|reason| format!("{name}: {reason}"))
    };
    let wrong = |reason: String| Failure::Asked(format!("{}: {reason}", folder.display()));
    let mut vectors = vectors::read(file).map_err(wrong)?;
    vectors.retain(|vector| machines.is_empty() || machines.contains(&vector.machine));
    if vectors.is_empty() {
        return Err(wrong("there is no vector of these machines".to_owned()));
    }
    Ok(vectors)
}

const HISTORY: &str = "history.jsonl";

/// The runs that the folder knows of, the oldest first. A line that is not of this form is passed over.
fn past(path: &Path) -> Vec<Past> {
    let text = fs::read_to_string(path).unwrap_or_default();
    let runs = text.lines().filter_map(|line| {
        let run: Value = serde_json::from_str(line).ok()?;
        let number = |name: &str| run[name].as_u64();
        let agree = (number("agree")?, number("of")?);
        let (began, seed, steps) = (number("began")?, number("seed")?, number("steps")?);
        Some(Past { began, seed, agree, steps, agrees: run["agrees"].as_bool()? })
    });
    runs.collect()
}

/// Whether a file of this name holds JSON lines.
fn is_lines(name: &str) -> bool {
    Path::new(name).extension().is_some_and(|extension| extension == "jsonl")
}

fn folder_of(folder: &Path, run: &Run, report: &Report, past: &[Past], texts: (&str, &str)) -> Result<(), Failure> {
    // Traces of an earlier run would be taken for those of this one.
    for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
        let name = entry.file_name().to_string_lossy().into_owned();
        let ours = ["trace-", "vector-", "kernel-", "other-"].iter().any(|kind| name.starts_with(kind));
        if ours && is_lines(&name) {
            drop(fs::remove_file(entry.path()));
        }
    }
    let agree = run.machines.iter().filter(|machine| matches!(machine.verdict, Verdict::Agrees)).count();
    let steps: u64 = run.machines.iter().map(|machine| machine.steps).sum();
    let line = json!({
        "began": report.began, "seed": report.seed, "agree": agree, "of": run.machines.len(), "steps": steps,
        "agrees": report.agrees,
    });
    let mut history = fs::read_to_string(folder.join(HISTORY)).unwrap_or_default();
    history.push_str(&line.to_string());
    history.push('\n');
    for machine in &run.machines {
        let Verdict::Differs(trace, _) = &machine.verdict else { continue };
        let file = |kind: &str| folder.join(format!("{kind}-{}.jsonl", machine.name));
        write(&file("trace"), &(trace.lines().join("\n") + "\n"))?;
        if let Some(last) = trace.cases.last() {
            let note = format!("the first difference of a run with seed {}", report.seed);
            write(&file("vector"), &format!("{}\n", json!(Vector::of(last, note))))?;
        }
        if let Some((ours, theirs)) = report::sessions(trace) {
            write(&file("kernel"), &ours)?;
            write(&file("other"), &theirs)?;
        }
    }
    write(&folder.join(HISTORY), &history)?;
    write(&folder.join("report.json"), texts.0)?;
    write(&folder.join("junit.xml"), texts.1)?;
    write(&folder.join("badge.svg"), &report::badge(report))?;
    write(&folder.join("index.html"), &report::page(run, report, past))
}

pub(crate) fn vectors(args: &VectorsArgs) -> Result<(), Failure> {
    machines(&args.machine)?;
    let out = &args.out;
    let there = out.join("vectors.json").exists() || fs::read_dir(out).is_ok_and(|mut folder| folder.next().is_none());
    if out.exists() && !there {
        let what = "is there and holds something else than vectors; name a new folder";
        return Err(Failure::Asked(format!("{} {what}", out.display())));
    }
    let chosen = |name: &&str| args.machine.is_empty() || args.machine.iter().any(|machine| machine == name);
    let names: Vec<_> = KINDS.iter().map(|kind| kind.name).filter(chosen).collect();
    let (with, without): (Vec<_>, Vec<_>) =
        names.into_iter().partition(|name| walk::source(name).is_some() || !walk::examples(name).is_empty());
    for name in without {
        remark(&format!("{name}: there is no walk and no example for it\n"));
    }
    let set = match args.set {
        SetArg::Minimal => Set::Minimal,
        SetArg::Thorough => Set::Thorough,
    };
    let failed = |error| Failure::Asked(format!("{} cannot be written: {error}", out.display()));
    fs::create_dir_all(out).map_err(failed)?;
    // The list of an earlier set would not fit the new files: it goes first and comes last.
    if out.join("vectors.json").exists() {
        fs::remove_file(out.join("vectors.json")).map_err(failed)?;
    }
    let files = vectors::files(&with, set);
    for (name, text) in &files {
        write(&out.join(name), text)?;
    }
    let count: usize = files.iter().filter(|file| is_lines(&file.0)).map(|file| file.1.lines().count()).sum();
    let list = files.last().and_then(|(_, list)| serde_json::from_str::<Value>(list).ok()).unwrap_or_default();
    let listed = list["files"].as_array().map_or(&[][..], Vec::as_slice);
    let covered: std::collections::BTreeSet<&str> = listed
        .iter()
        .flat_map(|file| file["requirements"].as_array().into_iter().flatten())
        .filter_map(Value::as_str)
        .collect();
    let mut said = String::new();
    for file in listed {
        let limits = file["coverage"]["limits"].as_array().map_or(&[][..], Vec::as_slice);
        let open: Vec<&str> = limits
            .iter()
            .filter(|limit| limit["vector"].is_null())
            .filter_map(|limit| limit["change"].as_str())
            .collect();
        let transitions = file["coverage"]["transitions"].as_object().into_iter().flatten();
        let count: usize = transitions.filter_map(|(_, seen)| seen.as_array()).map(Vec::len).sum();
        let name = file["machine"].as_str().unwrap_or_default();
        let (number, decided) = (limits.len(), limits.len() - open.len());
        let _ =
            write!(said, "{name}: {decided} of {number} sides of limits are decided, {count} transitions of outputs");
        if !open.is_empty() {
            let _ = write!(said, "; not {}", open.join(", "));
        }
        said.push('\n');
    }
    print(&format!(
        "{said}{count} vectors of {} machines in {}, about {} requirements\n",
        with.len(),
        out.display(),
        covered.len()
    ))
}
