//! `oracle replay` on the command line.

use std::fs;
use std::io::{self, IsTerminal as _, Write};
use std::path::PathBuf;
use std::time::Duration;

use atc_oracle::conform::case::STOP;
use atc_oracle::conform::profile::Profile;
use atc_oracle::conform::walk::{self, Sizes};
use atc_oracle::replay::logs::{Log, Logs};
use atc_oracle::replay::report::{self, Report};
use atc_oracle::replay::run::{self, Options, Progress, UNIT};
use clap::{Args, Subcommand};

use super::conformance::{LevelArg, config, duration, machines, read_asked};
use super::{Failure, print, remark, write};

#[derive(Args)]
#[command(
    args_conflicts_with_subcommands = true,
    subcommand_negates_reqs = true,
    after_help = "A log is what was sent to the device and what it replied, a line each (protocol 1):\n  \
        {\"start\":{\"protocol\":1,\"machine\":\"speed-supervision\"}}\n  \
        {\"started\":{\"protocol\":1,\"machine\":\"speed-supervision\"}}\n  \
        {\"step\":{\"permitted_km_h\":45,\"measured_km_h\":50}}\n  \
        {\"output\":{\"brake\":\"service\"}}\n  \
        {\"stop\":{}}\n  \
        {\"stopped\":{}}\n\
        Example:  oracle replay logs/ --profile my.toml --json replay.json --junit replay.xml --html replay.html\n\
        Exit code: 0 if every session agrees; 1 if one differs, a known difference is gone, or nothing was compared; 2 for wrong \
        arguments, or if something could not be read: the rest is compared all the same.\n\
        oracle/REPLAY.md has the rest."
)]
pub(crate) struct ReplayArgs {
    #[command(subcommand)]
    command: Option<ReplayCommand>,
    /// Logs, and folders with logs (*.jsonl and *.parquet, also in the folders below); "-" for standard input
    #[arg(required = true, value_name = "LOGS")]
    logs: Vec<PathBuf>,
    /// How much of a reply is compared [default: reason, or what the profile says]
    #[arg(long, value_enum)]
    level: Option<LevelArg>,
    /// What is compared and what is known to differ (TOML), as for `oracle conform`
    #[arg(long, value_name = "FILE.toml")]
    profile: Option<PathBuf>,
    /// How many sessions that differ are told, each with its first difference; all are counted
    #[arg(long, value_name = "NUMBER", default_value_t = 10)]
    differences: usize,
    /// Only so many sessions of so many, drawn by the names of the files and the places of the sessions
    #[arg(long, value_name = "1/100", default_value = "1/1", value_parser = part, hide_default_value = true)]
    sample: (u64, u64),
    /// Another seed draws another sample
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Only this part of the logs, for many machines; `oracle replay merge` joins the reports
    #[arg(long, value_name = "1/4", value_parser = part)]
    shard: Option<(u64, u64)>,
    /// How many threads [default: one for each processor]
    #[arg(long, value_name = "NUMBER")]
    jobs: Option<usize>,
    /// How often to tell on standard error how far it is [default: 10s, on a terminal 1s]
    #[arg(long, value_name = "TIME", value_parser = duration)]
    progress: Option<Duration>,
    /// How many bytes a thread takes at once
    #[arg(long, value_name = "BYTES", default_value_t = UNIT, hide = true)]
    unit: u64,
    #[command(flatten)]
    output: Output,
}

/// Where the report goes besides standard output.
#[derive(Args)]
struct Output {
    /// The report as JSON (`oracle schema replay`)
    #[arg(long, value_name = "FILE.json")]
    json: Option<PathBuf>,
    /// The report as JUnit
    #[arg(long, value_name = "FILE.xml")]
    junit: Option<PathBuf>,
    /// The report as a page
    #[arg(long, value_name = "FILE.html")]
    html: Option<PathBuf>,
}

#[derive(Subcommand)]
enum ReplayCommand {
    /// Joins the JSON reports of shards into the report of one run
    Merge {
        /// The reports, one of each shard; one that is missing is named
        #[arg(required = true, value_name = "REPORT.json")]
        reports: Vec<PathBuf>,
        #[command(flatten)]
        output: Output,
    },
    /// Writes a log to try it with: walks of `oracle conform`, with the kernel's replies
    Generate {
        /// The machine
        #[arg(long, value_name = "MACHINE")]
        machine: String,
        /// At least how many steps
        #[arg(long, default_value_t = 1000)]
        steps: u64,
        /// The seed of the walks
        #[arg(long, default_value_t = 1)]
        seed: u64,
        /// One configuration for every session: the body of a start's config as JSON or TOML
        #[arg(long, value_name = "FILE")]
        config: Option<PathBuf>,
    },
}

/// Reads a part such as `1/100`.
fn part(text: &str) -> Result<(u64, u64), String> {
    let numbers =
        text.split_once('/').and_then(|(some, of)| Some((some.parse::<u64>().ok()?, of.parse::<u64>().ok()?)));
    let numbers = numbers.filter(|(some, of)| (1..=*of).contains(some));
    numbers.ok_or_else(|| "a part is two whole numbers from 1, the first at most the second, such as 1/100".to_owned())
}

pub(crate) fn replay(args: &ReplayArgs) -> Result<(), Failure> {
    match &args.command {
        None => all(args),
        Some(ReplayCommand::Merge { reports, output }) => merge(reports, output),
        Some(ReplayCommand::Generate { machine, steps, seed, config: path }) => {
            machines(std::slice::from_ref(machine))?;
            let config = path.as_ref().map(|path| config(path, std::slice::from_ref(machine))).transpose()?;
            let mut out = io::BufWriter::with_capacity(1 << 16, io::stdout().lock());
            match generate(machine, *steps, *seed, config.as_ref(), &mut out).and_then(|()| out.flush()) {
                Err(error) if error.kind() != io::ErrorKind::BrokenPipe => {
                    Err(Failure::Write("standard output".into(), error))
                }
                _ => Ok(()),
            }
        }
    }
}

fn all(args: &ReplayArgs) -> Result<(), Failure> {
    let profile = match &args.profile {
        Some(path) => {
            let profile = Profile::parse(&read_asked(path)?);
            profile.map_err(|reason| Failure::Asked(format!("{}: {reason}", path.display())))?
        }
        None => Profile::default(),
    };
    args.output.can_be_written()?;
    let logs = Logs::find(&args.logs);
    let shard = args.shard.filter(|(_, of)| *of > 1);
    let stream = logs.files.iter().find(|log| log.length.is_none());
    if let (Some(_), Some(Log { name, .. })) = (shard, stream) {
        let what = "is no plain file, and a shard has to know its length; give it without --shard";
        return Err(Failure::Asked(format!("{name} {what}")));
    }
    let terminal = io::stderr().is_terminal();
    let options = Options {
        level: args.level.map(LevelArg::level).or(profile.level).unwrap_or_default(),
        profile,
        sample: args.sample,
        seed: args.seed,
        shard: args.shard,
        differences: args.differences,
        jobs: args.jobs.unwrap_or_else(|| std::thread::available_parallelism().map_or(1, std::num::NonZero::get)),
        unit: args.unit.max(512),
        every: args.progress.unwrap_or(Duration::from_secs(if terminal { 1 } else { 10 })),
    };
    let report = run::run(&logs, &options, |progress| {
        // On a terminal the line is written over.
        let (begin, end) = if terminal { ("\r\x1b[K", "") } else { ("", "\n") };
        remark(&format!("{begin}{}{end}", line(progress)));
    });
    if terminal {
        remark("\r\x1b[K");
    }
    args.output.write(&report)
}

/// How far a run is, in a line.
fn line(progress: &Progress) -> String {
    let Progress { files: (files, of), bytes: (bytes, due), steps, took } = progress;
    let seconds = took.as_secs_f64();
    #[expect(clippy::cast_precision_loss, reason = "a rate")]
    let (read, due) = (*bytes as f64, due.map(|due| due as f64));
    let left = due.filter(|_| read > 0.0).map(|due| (due - read).max(0.0) * seconds / read);
    let left = left.map_or_else(|| "time left unknown".to_owned(), |left| format!("{left:.0} s left"));
    let share = due.filter(|due| *due > 0.0).map(|due| format!(" ({:.0} %)", 100.0 * read / due)).unwrap_or_default();
    format!(
        "replay: file {files} of {of}, {steps} steps, {:.1} MB{share}, {:.1} MB/s, {seconds:.0} s, {left}",
        read / 1e6,
        read / 1e6 / seconds.max(1e-9)
    )
}

impl Output {
    /// What cannot be written is told before the work, not after it.
    fn can_be_written(&self) -> Result<(), Failure> {
        for path in [&self.json, &self.junit, &self.html].into_iter().flatten() {
            let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty());
            if path.is_dir() || folder.is_some_and(|folder| !folder.is_dir()) {
                let what = "cannot be written: it is a folder, or its folder is not there";
                return Err(Failure::Asked(format!("{} {what}", path.display())));
            }
        }
        Ok(())
    }

    fn write(&self, report: &Report) -> Result<(), Failure> {
        let junit = self.junit.as_ref().map(|path| report::junit(report).map(|text| (path, text)));
        let junit = junit.transpose().map_err(Failure::Asked)?;
        if let Some(path) = &self.json {
            write(path, &format!("{:#}\n", serde_json::to_value(report).unwrap_or_default()))?;
        }
        junit.map_or(Ok(()), |(path, text)| write(path, &text))?;
        self.html.as_ref().map_or(Ok(()), |path| write(path, &report::page(report)))?;
        print(&report::text(report))?;
        match report.code() {
            0 => Ok(()),
            1 => Err(Failure::Differs),
            code => Err(Failure::Told(code)),
        }
    }
}

fn merge(paths: &[PathBuf], output: &Output) -> Result<(), Failure> {
    output.can_be_written()?;
    let mut reports = Vec::new();
    for path in paths {
        let wrong = |what: String| Failure::Asked(format!("{}: {what}", path.display()));
        let text = fs::read_to_string(path).map_err(|error| wrong(format!("it cannot be read: {error}")))?;
        let report: Report = serde_json::from_str(&text)
            .map_err(|error| wrong(format!("this is no JSON report of `oracle replay` of this version: {error}")))?;
        reports.push((path.display().to_string(), report));
    }
    let report = report::merge(reports).map_err(Failure::Asked)?;
    output.write(&report)
}

/// Writes walk after walk as a log, until it has so many steps.
fn generate(
    machine: &str,
    steps: u64,
    seed: u64,
    config: Option<&serde_json::Value>,
    out: &mut impl Write,
) -> io::Result<()> {
    let (mut written, mut number) = (0, 0);
    while written < steps {
        // A machine whose walks have no step would go on for ever.
        let Some(expected) = walk::case(machine, seed, number, Sizes::Mixed, config) else { break };
        number += 1;
        let lines = expected.session();
        written += expected.outputs.len() as u64;
        if number > 1000 && written == 0 {
            break;
        }
        if expected.is_rejected() {
            // It has no stop: nothing is open.
            writeln!(out, "{}\n{}", lines[0], lines[1])?;
            continue;
        }
        for line in &lines {
            writeln!(out, "{line}")?;
        }
        debug_assert_eq!(lines.last().map(String::as_str), Some(STOP), "a session ends with its stop");
        writeln!(out, r#"{{"stopped":{{"steps":{}}}}}"#, expected.outputs.len())?;
    }
    Ok(())
}
