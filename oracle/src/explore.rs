//! `oracle explore`: a session, a trace of a model or a simulated line as a page that plays it.

use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};

use atc_film::{Film, TOO_LONG};
use atc_layout::read;
use atc_oracle::film::{self, Setting, TracedError};
use atc_oracle::trace::{Record, Replies, TraceError};
use clap::Args;

use crate::simulate::{self, RunArgs};

#[derive(Args)]
#[command(after_help = "What can be shown:\n  \
    session.jsonl   what `oracle serve` read, with its replies if these were kept\n  \
    models.json     what `models check --json models.json` found; --trace names one of its traces\n  \
    line.toml       a line, which is simulated: what is below \"A simulated line\" is for it\n\n\
    The page is one file. It opens in a browser from where it lies: no network, no server.\n\
    Keys in it: space plays and pauses, left and right step, up and down go to events, Home and End.\n\n\
    Exit code: 0; 1 if a record differs from the kernel (--as-recorded) or a simulation ends in harm, the page is written then;\n\
    or if nothing could be made, with the reason.")]
pub struct ExploreArgs {
    /// A session (JSON lines), a trace of a model (JSON) or a line (.toml); "-" for a session from standard input
    pub file: PathBuf,
    /// Where the page goes [default: standard output]
    #[arg(short, long, value_name = "FILE.html")]
    pub output: Option<PathBuf>,
    /// The page's title [default: what it is of]
    #[arg(long)]
    title: Option<String>,
    /// The layout whose drawing is the track plan, for a session that has a plan in the kernel's own terms
    #[arg(long, value_name = "LAYOUT")]
    layout: Option<PathBuf>,
    /// Which case of a session with several, from 1
    #[arg(long, default_value_t = 1, value_name = "NUMBER")]
    case: usize,
    /// Which trace of a file with several: the model and the property, or the property alone
    #[arg(long, value_name = "MODEL/PROPERTY")]
    trace: Option<String>,
    /// Shows replies that differ from the kernel's as they were recorded; else the first one is an error
    #[arg(long)]
    as_recorded: bool,
    /// The kernel as a WebAssembly module, made by ci/page-kernel: a reader can change the inputs of an interlocking and go on
    #[arg(long, value_name = "FILE.wasm")]
    kernel: Option<PathBuf>,
    #[command(flatten, next_help_heading = "A simulated line")]
    run: RunArgs,
    /// Draws so many of each kind of --faults, as the run of a campaign with this seed has them
    #[arg(long, value_name = "FAULTS")]
    each: Option<usize>,
}

/// The page, and what is said beside it.
pub struct Done {
    /// The page.
    pub page: String,
    /// For standard error.
    pub remarks: String,
    /// Whether a record differs, or harm was done.
    pub differs: bool,
}

/// Why there is no page.
pub enum Wrong {
    /// The session is not right.
    Trace(TraceError),
    /// The layout is not right.
    Layout(atc_layout::Errors),
    /// Another reason.
    Reason(String),
}

/// Whether a file is a line to simulate.
pub fn is_line(file: &Path) -> bool {
    file.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("toml"))
}

/// Makes the page of a line.
pub fn line(args: &ExploreArgs) -> Result<Done, String> {
    let asked = [
        ("--layout", args.layout.is_some()),
        ("--trace", args.trace.is_some()),
        ("--as-recorded", args.as_recorded),
        ("--kernel", args.kernel.is_some()),
    ];
    if let Some((option, _)) = asked.iter().find(|(_, there)| *there) {
        return Err(format!("{option} is for a session; {} is a line, which is simulated", args.file.display()));
    }
    let made = simulate::film(&args.file, &args.run, args.each, args.title.as_deref())?;
    Ok(done(&made.film, made.remarks, made.is_unsafe))
}

/// Makes the page of a text: a session or a trace of a model.
pub fn session(args: &ExploreArgs, text: &str) -> Result<Done, Wrong> {
    if let Some(option) = args.run.given().or(args.each.map(|_| "--each")) {
        let file = args.file.display();
        return Err(Wrong::Reason(format!(
            "{option} is for a line that is simulated (.toml); {file} is read as a session"
        )));
    }
    let traced = film::read(text, args.trace.as_deref()).map_err(|error| match error {
        TracedError::Trace(error) => Wrong::Trace(error),
        TracedError::Model(reason) => Wrong::Reason(reason),
    })?;
    let cases = &traced.trace.cases;
    let record = args.case.checked_sub(1).and_then(|case| cases.get(case)).ok_or_else(|| {
        let there = cases.len();
        Wrong::Reason(format!(
            "--case {}: the session has {there} {}, from 1",
            args.case,
            if there == 1 { "case" } else { "cases" }
        ))
    })?;
    let replies = if args.as_recorded { Replies::AsRecorded } else { Replies::MustAgree };
    let layout = args.layout.as_ref().map(read).transpose().map_err(Wrong::Layout)?;
    let title = args.title.clone().or(traced.title.clone());
    let kernel = args.kernel.as_deref().map(module).transpose().map_err(Wrong::Reason)?;
    let setting = Setting { title, replies, layout, words: traced.words.clone(), kernel };
    let made = film::film(record, &setting).map_err(Wrong::Trace)?;
    let mut remarks = String::new();
    if cases.len() > 1 {
        remarks = format!("case {} of {}; --case NUMBER shows another\n", args.case, cases.len());
    }
    Ok(done(&made, remarks, args.as_recorded && differs(record)))
}

/// The module of a file.
fn module(file: &Path) -> Result<Vec<u8>, String> {
    let bytes = fs::read(file).map_err(|error| format!("--kernel {}: it cannot be read: {error}", file.display()))?;
    if !bytes.starts_with(b"\0asm") {
        return Err(format!("--kernel {}: this is no WebAssembly module; ci/page-kernel makes one", file.display()));
    }
    Ok(bytes)
}

fn differs(record: &Record) -> bool {
    film::film(record, &Setting::default()).is_err()
}

fn done(film: &Film, mut remarks: String, differs: bool) -> Done {
    let page = film.page();
    if page.len() > TOO_LONG {
        let megabytes = page.len() / 1_000_000;
        let _ = writeln!(
            remarks,
            "the page has {megabytes} MB: browsers are slow with it; record less, or a shorter --time"
        );
    }
    Done { page, remarks, differs }
}
