//! `oracle line`: a line's file is checked, with the layouts that it names, and its devices' configurations are written.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use atc_line::{DataCheck, Line, Outcome, Problems};
use atc_protocol::devices::{self, Devices};
use clap::Subcommand;
use serde::Serialize;

/// What is to be done with a line.
#[derive(Subcommand)]
pub enum LineCommand {
    /// Checks every rule; prints what is broken, with both places and what would be right
    #[command(
        after_help = "Exit code: 0 no rule is broken, 1 a rule is broken, 2 a file cannot be read as what it should be."
    )]
    Check {
        /// The line (TOML); layouts of stations are named in it
        file: PathBuf,
        /// Prints also what follows from the parameters, and what to look at
        #[arg(long)]
        derived: bool,
        /// Prints every rule and what it came to as JSON, also where rules are broken
        #[arg(long, conflicts_with = "derived")]
        json: bool,
    },
    /// Writes the configuration of each device: what `serve` takes in a start, and `conform` as --config. Nothing is written where a rule is broken
    #[command(
        after_help = "Exit code: 0 written, 1 a rule is broken or a file cannot be written, 2 a file cannot be read as what it should be."
    )]
    Configs {
        /// The line (TOML); layouts of stations are named in it
        file: PathBuf,
        /// The folder, new or empty
        #[arg(short, long, value_name = "FOLDER")]
        output: PathBuf,
    },
}

/// A folder with files.
pub struct Folder {
    /// Its path.
    pub path: PathBuf,
    /// The names and the contents of its files.
    pub files: Vec<(String, Vec<u8>)>,
}

/// What the command has to say.
pub struct Done {
    /// For standard output.
    pub text: String,
    /// For standard error: the broken rules.
    pub remarks: String,
    /// 0, 1 or 2.
    pub code: u8,
    /// A folder to be written, before anything is said.
    pub folder: Option<Folder>,
}

/// What `check --json` says.
#[derive(Serialize)]
struct Told<'a> {
    file: String,
    /// Its name; null if its own parameters are refused, or it cannot be read.
    line: Option<&'a str>,
    sound: bool,
    /// Why it is no line: the place and the rule of each.
    problems: Vec<Problem<'a>>,
    /// Every rule, if it is one.
    checks: Vec<DataCheck>,
}

/// Why a file is no line.
#[derive(Serialize)]
struct Problem<'a> {
    rule: &'static str,
    at: &'a str,
    what: &'a str,
}

/// Does what the command says. Nothing is written here.
pub fn run(command: &LineCommand) -> Done {
    let (LineCommand::Check { file, .. } | LineCommand::Configs { file, .. }) = command;
    match (atc_line::read(file), command) {
        (Ok(line), LineCommand::Check { derived, json, .. }) => check(file, &line, *derived, *json),
        (Ok(line), LineCommand::Configs { output, .. }) => configs(file, &line, output),
        (Err(problems), LineCommand::Check { json, .. }) => refused(file, &problems, *json),
        (Err(problems), LineCommand::Configs { .. }) => refused(file, &problems, false),
    }
}

/// The configuration of each device, if no rule of the line is broken.
fn configs(file: &Path, line: &Line, folder: &Path) -> Done {
    let checked = check(file, line, false, false);
    if checked.code != 0 {
        return checked;
    }
    let Devices { all, without } = Devices::of(line);
    let (mut text, mut files) = (String::new(), Vec::new());
    for device in &all {
        // What cannot be made is a broken rule.
        let Ok(config) = &device.config else { continue };
        let name = format!("{}.json", plain(&device.name()));
        let _ = writeln!(text, "{}", folder.join(&name).display());
        let config = serde_json::to_string_pretty(config).map_or_else(|error| error.to_string(), |text| text + "\n");
        files.push((name, config.into_bytes()));
    }
    let mut lacking: BTreeMap<&str, Vec<&str>> = BTreeMap::new();
    for one in without {
        lacking.entry(one.why).or_default().push(one.machine);
    }
    for (why, machines) in lacking {
        let _ = writeln!(text, "not made, as {why}: {}", machines.join(", "));
    }
    Done { text, remarks: checked.remarks, code: 0, folder: Some(Folder { path: folder.to_owned(), files }) }
}

/// The longest name of a file, in characters.
const LONGEST_NAME: usize = 60;

/// A name that every file system takes.
fn plain(name: &str) -> String {
    name.chars()
        .take(LONGEST_NAME)
        .map(|one| if one.is_alphanumeric() || "-_.".contains(one) { one } else { '-' })
        .collect()
}

fn refused(file: &Path, problems: &Problems, json: bool) -> Done {
    let code = if problems.is_unreadable() { 2 } else { 1 };
    let all = problems.0.iter().map(|one| Problem { rule: one.rule.id(), at: &one.at, what: &one.what }).collect();
    let told = Told { file: file.display().to_string(), line: None, sound: false, problems: all, checks: Vec::new() };
    let text = if json { written(&told) } else { String::new() };
    Done { text, remarks: format!("{problems}\n"), code, folder: None }
}

fn check(file: &Path, line: &Line, derived: bool, json: bool) -> Done {
    let checks = devices::checks(line);
    let mut remarks = String::new();
    for (check, finding) in checks.iter().flat_map(|check| check.findings().iter().map(move |finding| (check, finding)))
    {
        let _ = writeln!(remarks, "{finding} [{}]", check.rule);
    }
    let sound = checks.iter().all(|check| check.outcome.holds());
    let code = u8::from(!sound);
    if json {
        let (file, name) = (file.display().to_string(), Some(line.name()));
        let told = Told { file, line: name, sound, problems: Vec::new(), checks };
        return Done { text: written(&told), remarks, code, folder: None };
    }
    let count = |one: fn(&Outcome) -> bool| checks.iter().filter(|check| one(&check.outcome)).count();
    let met = count(|outcome| *outcome == Outcome::Met);
    let broken = count(|outcome| matches!(outcome, Outcome::Broken { .. }));
    let unchecked = count(|outcome| *outcome == Outcome::NotChecked);
    let told = if broken == 0 {
        "no broken rule".to_owned()
    } else {
        format!("{broken} broken {}", if broken == 1 { "rule" } else { "rules" })
    };
    let mut text = format!("{}: {told}; {met} checks met", file.display());
    if unchecked > 0 {
        let _ = write!(text, ", {unchecked} not made, as a rule is broken");
    }
    text.push('\n');
    let mut without: BTreeMap<&str, Vec<&str>> = BTreeMap::new();
    for check in &checks {
        if let Outcome::NotApplicable { why } = &check.outcome {
            without.entry(why).or_default().push(&check.rule);
        }
    }
    for (why, rules) in without {
        let _ = writeln!(text, "not applicable, as {why}: {}", rules.join(", "));
    }
    if derived {
        for one in line.derived() {
            let _ = writeln!(text, "{}: {}", one.name, one.value);
        }
        for note in line.notes() {
            let _ = writeln!(text, "to look at: {note}");
        }
    }
    Done { text, remarks, code, folder: None }
}

fn written(told: &Told<'_>) -> String {
    serde_json::to_string_pretty(told).map_or_else(|error| error.to_string(), |text| text + "\n")
}
