//! `oracle layout`: a station's layout is checked, imported, tabulated and drawn.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use atc_layout::import::{Imported, Report, only, read_any};
use atc_layout::{Description, Errors, Problem, Rule, Source, draw, table};
use clap::{Args, Subcommand, ValueEnum};
use serde::Serialize;

/// What is to be done with a layout.
#[derive(Subcommand)]
pub enum LayoutCommand {
    /// Checks every rule; prints what is broken, with its place in the file and what would be right
    Check {
        #[command(flatten)]
        layout: LayoutFile,
        /// Prints also what was derived, with its value
        #[arg(long)]
        derived: bool,
        /// Prints what was found as JSON, also where rules are broken
        #[arg(long, conflicts_with = "derived")]
        json: bool,
    },
    /// Holds two descriptions of one station against each other, cell by cell; exit code 1 if they differ
    Compare {
        /// A layout in any form; `-` for standard input
        one: PathBuf,
        /// Another one, or a table in the columns of `table --form rendo` (.csv). A railML or PlanPro file is also read a second time,
        /// by other code, and its routes held against the first
        other: PathBuf,
    },
    /// Writes a railML 3 or PlanPro file or an OSRD infrastructure as a layout in TOML; the report goes to standard error
    Import {
        #[command(flatten)]
        layout: LayoutFile,
        /// Where the layout goes [default: standard output]
        #[arg(short, long, value_name = "FILE.toml")]
        output: Option<PathBuf>,
    },
    /// Writes the control table
    Table {
        #[command(flatten)]
        layout: LayoutFile,
        /// In which form
        #[arg(long, value_enum, default_value_t = Form::Html)]
        form: Form,
        /// Where the table goes [default: standard output]
        #[arg(short, long, value_name = "FILE")]
        output: Option<PathBuf>,
    },
    /// Draws the track plan (SVG)
    Draw {
        #[command(flatten)]
        layout: LayoutFile,
        /// Where the drawing goes [default: standard output]
        #[arg(short, long, value_name = "FILE.svg")]
        output: Option<PathBuf>,
    },
    /// Holds the views that two stations have of the line between them against each other
    Border {
        /// The layout of one station
        one: PathBuf,
        /// The layout of its neighbour
        other: PathBuf,
    },
    /// Prints the JSON Schema of the layout form
    Schema,
}

/// A layout in any form.
#[derive(Args)]
pub struct LayoutFile {
    /// The layout: .toml, railML 3 (.xml, .railml), PlanPro (.ppxml, .xml) or an OSRD infrastructure (.json); `-` for any of them from
    /// standard input
    file: PathBuf,
    /// Takes these routes alone, and what they need
    #[arg(long, value_name = "ROUTE", value_delimiter = ',')]
    only: Vec<String>,
}

/// A form of the control table.
#[derive(Clone, Copy, ValueEnum)]
pub enum Form {
    /// To be printed and signed
    Html,
    /// Comma-separated values, for a spreadsheet
    Csv,
    /// The same in the columns of a Japanese interlocking table (連動図表)
    Rendo,
}

/// What a command has to say: text for a file or standard output, and remarks for standard error.
pub struct Done {
    /// The text.
    pub text: String,
    /// Where it goes; none for standard output.
    pub output: Option<PathBuf>,
    /// Remarks.
    pub remarks: String,
    /// That what was asked about is not as it should be; the text says it.
    pub differs: bool,
}

/// Does what the command says. Nothing is written here.
pub fn run(command: LayoutCommand) -> Result<Done, Errors> {
    let (text, output, remarks) = match command {
        LayoutCommand::Check { layout, json: true, .. } => {
            let Imported { description, report } = open(&layout)?;
            let found = Checked::of(&layout, &description, report);
            let differs = !found.problems.is_empty();
            return Ok(Done { text: found.json(), output: None, remarks: String::new(), differs });
        }
        LayoutCommand::Compare { one, other } => {
            let differing = compare(&one, &other)?;
            let differs = !differing.is_empty();
            let text = if differs { differing.join("\n") + "\n" } else { "no difference\n".to_owned() };
            return Ok(Done { text, output: None, remarks: String::new(), differs });
        }
        LayoutCommand::Check { layout, derived, .. } => (check(&layout, derived)?, None, String::new()),
        LayoutCommand::Import { layout, output } => {
            let Imported { description, report } = open(&layout)?;
            if description.station.routes.is_empty() {
                return Err(nothing(&layout, &report));
            }
            let remarks = format!("{report}{}", broken_rules(&description));
            (description.to_toml(), output, remarks)
        }
        LayoutCommand::Table { layout, form, output } => {
            let Imported { description, .. } = open(&layout)?;
            let model = description.model()?;
            let text = match form {
                Form::Html => table::html(&description.station.name, &model, &draw::svg(&description.station, &model)),
                Form::Csv => table::csv(&model),
                Form::Rendo => table::rendo::csv(&model),
            };
            (text, output, String::new())
        }
        LayoutCommand::Draw { layout, output } => {
            let Imported { description, .. } = open(&layout)?;
            (draw::svg(&description.station, &description.tracks()?), output, String::new())
        }
        LayoutCommand::Border { one, other } => (border(&one, &other)?, None, String::new()),
        LayoutCommand::Schema => (atc_layout::schema(), None, String::new()),
    };
    Ok(Done { text, output, remarks, differs: false })
}

fn open(layout: &LayoutFile) -> Result<Imported, Errors> {
    let mut imported = read_any(Path::new(&layout.file))?;
    if !layout.only.is_empty() {
        imported.description = only(&imported.description, &layout.only)?;
    }
    Ok(imported)
}

/// What `check --json` says.
#[derive(Serialize)]
struct Checked {
    file: String,
    station: String,
    routes: usize,
    points: usize,
    circuits: usize,
    segments: usize,
    /// The broken rules.
    problems: Vec<Told>,
    /// What an import took, assumed, lacked and left aside.
    taken: Vec<String>,
    defaulted: Vec<String>,
    lacking: Vec<String>,
    skipped: Vec<String>,
}

/// A broken rule.
#[derive(Serialize)]
struct Told {
    rule: String,
    line: Option<usize>,
    column: Option<usize>,
    what: String,
    right: String,
}

impl Checked {
    fn of(layout: &LayoutFile, description: &Description, report: Report) -> Self {
        let problems = description.check().err().map(|errors| errors.problems).unwrap_or_default();
        let told = |problem: Problem| Told {
            rule: problem.rule.name(),
            line: problem.place.map(|place| place.line),
            column: problem.place.map(|place| place.column),
            what: problem.what,
            right: problem.right,
        };
        let station = &description.station;
        Self {
            file: layout.file.display().to_string(),
            station: station.name.clone(),
            routes: station.routes.len(),
            points: station.points.len(),
            circuits: station.circuits.len(),
            segments: station.segments.len(),
            problems: problems.into_iter().map(told).collect(),
            taken: report.taken,
            defaulted: report.defaulted,
            lacking: report.lacking,
            skipped: report.skipped,
        }
    }

    fn json(&self) -> String {
        serde_json::to_string_pretty(self).map_or_else(|error| error.to_string(), |text| text + "\n")
    }
}

/// Every cell of the control table and every value in which two layouts differ; and where one of the files is railML or PlanPro, what a second
/// reading of it finds in the other layout.
fn compare(one: &Path, other: &Path) -> Result<Vec<String>, Errors> {
    if other.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("csv")) {
        return against_table(one, other);
    }
    let (read, other_read) = (read_any(one)?.description, read_any(other)?.description);
    let (model, other_model) = (read.model()?, other_read.model()?);
    let mut told: Vec<String> =
        atc_layout::compare::compare(&model, &other_model).iter().map(ToString::to_string).collect();
    for (text, model, file) in [(&other_read.source.text, &model, other), (&read.source.text, &other_model, one)] {
        // Whose text is no XML has been read as another form.
        let found =
            if text.trim_start().starts_with('<') { atc_layout::second::differences(text, model) } else { continue };
        let found = found.unwrap_or_default();
        told.extend(found.iter().map(|difference| format!("against {}: {difference}", file.display())));
    }
    Ok(told)
}

/// Every cell in which a Japanese interlocking table differs from a layout.
fn against_table(layout: &Path, table: &Path) -> Result<Vec<String>, Errors> {
    let model = read_any(layout)?.description.model()?;
    let source = Source { name: table.display().to_string(), ..Source::default() };
    let wrong = |what: String| Errors::one(&source, Problem::new(Rule::Form, &(0..0), what, "save it as CSV in UTF-8"));
    let text = atc_layout::text::read(table).map_err(wrong)?;
    let found = table::rendo::compare(&model, &text).map_err(wrong)?;
    Ok(found.iter().map(ToString::to_string).collect())
}

/// No route was imported: the reasons stand in the report, which is all that there is.
fn nothing(layout: &LayoutFile, report: &Report) -> Errors {
    let what = format!("no route was imported, and nothing is written\n{report}");
    let right = "mend in the file what is told of each route, or describe the station in TOML";
    Errors::one(
        &Source { name: layout.file.display().to_string(), ..Source::default() },
        Problem::new(Rule::NoRoute, &(0..0), what, right),
    )
}

fn check(layout: &LayoutFile, derived: bool) -> Result<String, Errors> {
    let Imported { description, report } = open(layout)?;
    let sound = description.check()?;
    let names = &sound.names;
    let mut text = format!(
        "{}: no broken rule; {} routes, {} points, {} circuits, {} segments\n",
        layout.file.display(),
        names.routes.len(),
        names.points.len(),
        names.circuits.len(),
        names.segments.len()
    );
    let assumed = report.defaulted.len();
    if assumed > 0 {
        let _ = writeln!(text, "{assumed} values were assumed on import and are to be confirmed:");
        for line in &report.defaulted {
            let _ = writeln!(text, "  {line}");
        }
    }
    if derived {
        for note in &sound.model.notes {
            let _ = writeln!(text, "{}: {}", note.about, note.text);
        }
    }
    Ok(text)
}

/// The lines between two stations, each with what they see of it.
fn border(one: &Path, other: &Path) -> Result<String, Errors> {
    let (one, other) = (read_any(one)?.description, read_any(other)?.description);
    let (model, other_model) = (one.model()?, other.model()?);
    let borders = atc_layout::border::compare((&one, &model), (&other, &other_model))?;
    let mut told: Vec<String> = borders.iter().map(ToString::to_string).collect();
    told.extend(atc_layout::border::not_compared((&one, &model), (&other, &other_model)));
    Ok(told.join("\n") + "\n")
}

/// The rules that an imported layout still breaks: a remark, for the import itself was done.
fn broken_rules(description: &Description) -> String {
    match description.check() {
        Ok(_) => "the layout breaks no rule\n".to_owned(),
        Err(errors) => format!("the layout breaks {} rules:\n{errors}\n", errors.problems.len()),
    }
}
