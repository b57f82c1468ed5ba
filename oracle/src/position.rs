//! `oracle position`: from measured levels of a line to the attenuation table of its trains.

use std::path::{Path, PathBuf};

use atc_kernel::position::{Millibels, Spacing};
use atc_line::position::{Config, TableConfig};
use atc_protocol::{Decibels, Metres};
use atc_waveform::calibration::measured::{Fit, FitError, Measurement, Wanted, picture, sides};
use clap::{Args, Subcommand};

use levels::Levels;
use report::report;
use words::{json, toml, words};

mod levels;
mod report;
mod words;

/// What is to be done with levels.
#[derive(Subcommand)]
pub enum PositionCommand {
    /// Fits the attenuation table to measured levels; says what it covers and which side of an error is dangerous
    #[command(after_help = "Example:\n  \
        oracle position calibrate levels.csv --section-m 400 -o table.toml --svg table.svg\n\
        with a file that begins\n  \
        weather,distance_m,first_db,second_db\n  \
        wet,0,-20.03,-20.11\n  \
        wet,10,-20.14,-20.32\n\
        The head names columns and units: distance_m or distance_km; first_db and second_db, or difference_db (first less second, \
        the second being the signal that the rail attenuates more). Lines that have the same pass, date, weather and \
        ballast_ohm_km are one pass. \"#\" begins a remark.\n\
        Exit code: 0 a table, 1 the measurements make none, 2 what was asked for cannot be done.")]
    Calibrate(CalibrateArgs),
}

#[derive(Args)]
pub struct CalibrateArgs {
    /// The measured levels (CSV); "-" for standard input
    pub levels: PathBuf,
    /// Where the table goes: .toml for the position of a line's file, .json for the configuration of `train-position`
    #[arg(short, long, value_name = "FILE")]
    pub output: Option<PathBuf>,
    /// Where the picture goes: measurements, table and residuals
    #[arg(long, value_name = "FILE.svg")]
    pub svg: Option<PathBuf>,
    /// Prints the report as JSON
    #[arg(long)]
    json: bool,
    /// The distance between knots: 1.6, 3.2, … 204.8 m [default: the least with which the table reaches the end]
    #[arg(long, value_name = "METRES")]
    spacing_m: Option<f64>,
    /// The section's length, if no train beyond it hears this transmitter: intervals end there [default: the position
    /// is unknown where it may be beyond the last knot]
    #[arg(long, value_name = "METRES")]
    section_m: Option<f64>,
    /// The level under which a signal is noise [default: the lowest level of the file, less the tolerance]
    #[arg(long, value_name = "DB", allow_negative_numbers = true)]
    floor_db: Option<f64>,
}

/// What there is to print and to write.
pub struct Done {
    /// For standard output.
    pub text: String,
    /// The table, in the form that its name asks for.
    pub table: Option<String>,
    /// The picture.
    pub svg: Option<String>,
}

/// Why there is no table.
pub enum Wrong {
    /// The measurements make none.
    Levels(String),
    /// What was asked for cannot be done.
    Asked(String),
}

/// Fits, and makes all texts. Nothing is written here.
pub fn calibrate(args: &CalibrateArgs, text: &str) -> Result<Done, Wrong> {
    let form = args.output.as_deref().map(form).transpose().map_err(Wrong::Asked)?;
    let wanted = wanted(args).map_err(Wrong::Asked)?;
    let name = args.levels.display().to_string();
    let levels = levels::read(&name, text).map_err(Wrong::Levels)?;
    let passes: Vec<Vec<Measurement>> = levels.passes.iter().map(|pass| pass.measurements.clone()).collect();
    let fit = Fit::new(&passes, wanted).map_err(|error| Wrong::Levels(told(&name, &levels, &error)))?;
    let floor = floor(args, &levels, &fit).map_err(Wrong::Asked)?;
    let config = config(&fit, floor);
    // What is written is what the oracle and the line's file read.
    let position = config.position().map_err(|refusal| Wrong::Levels(format!("{name}: {}", refusal.what)))?;
    let sides = sides(&fit, position.floor());
    let report = report(&name, &levels, &fit, config, &sides);
    let names: Vec<String> = levels.passes.iter().map(|pass| pass.name.clone()).collect();
    let svg = args.svg.is_some().then(|| picture(&fit, &passes, &names)).transpose();
    let table = form.map(|form| match form {
        Form::Toml => toml(&report),
        Form::Json => json(&report.position),
    });
    Ok(Done {
        text: if args.json { json(&report) } else { words(&report) },
        table,
        svg: svg.map_err(|error| Wrong::Levels(error.to_string()))?,
    })
}

/// The form of a table.
#[derive(Clone, Copy)]
enum Form {
    Toml,
    Json,
}

fn form(path: &Path) -> Result<Form, String> {
    match path.extension().and_then(|ending| ending.to_str()) {
        Some("toml") => Ok(Form::Toml),
        Some("json") => Ok(Form::Json),
        _ => Err(format!("{}: its name must end in .toml or .json, which says the table's form", path.display())),
    }
}

fn wanted(args: &CalibrateArgs) -> Result<Wanted, String> {
    let spacing = args.spacing_m.map(|metres| {
        let mut all = (4..=11).filter_map(Spacing::new);
        all.find(|spacing| (f64::from(spacing.decimetres()) / 10.0 - metres).abs() < 1e-6).ok_or_else(|| {
            format!("--spacing-m is {metres}; it must be 1.6, 3.2, 6.4, 12.8, 25.6, 51.2, 102.4 or 204.8")
        })
    });
    let section = args.section_m.map(|metres| {
        let fits = (1.0..=3072.0).contains(&metres);
        let wrong = || format!("--section-m is {metres}; it must be 1 to 3072");
        fits.then_some(atc_waveform::rail::Metres(metres)).ok_or_else(wrong)
    });
    Ok(Wanted { spacing: spacing.transpose()?, section: section.transpose()? })
}

/// The noise floor.
fn floor(args: &CalibrateArgs, levels: &Levels, fit: &Fit) -> Result<Millibels, String> {
    let level = match (args.floor_db, levels.lowest) {
        (Some(floor), _) => (floor * 100.0).round(),
        (None, Some(lowest)) => (lowest * 100.0).floor() - f64::from(fit.tolerance.0),
        (None, None) => {
            return Err("the file has differences and no levels: --floor-db must say which level is noise".to_owned());
        }
    };
    #[expect(clippy::cast_possible_truncation, reason = "checked on the same line")]
    let millibels = (level.abs() <= 32_000.0).then_some(Millibels(level as i16));
    millibels.ok_or_else(|| format!("the floor is {} dB; --floor-db must be -320 to 320", level / 100.0))
}

fn config(fit: &Fit, floor: Millibels) -> Config {
    let decibels = |level: &Millibels| Decibels(level.0.into());
    Config {
        table: TableConfig {
            spacing_m: Metres(i64::from(fit.table.spacing().decimetres()) * 100),
            lowest_db: fit.table.lowest().iter().map(decibels).collect(),
            highest_db: fit.table.highest().iter().map(decibels).collect(),
        },
        tolerance_db: decibels(&fit.tolerance),
        floor_db: decibels(&floor),
        correction_db: [Decibels(0); 2],
    }
}

/// Why measurements make no table, with file, line and column.
fn told(name: &str, levels: &Levels, error: &FitError) -> String {
    let line = |pass: usize, place: usize| levels.passes.get(pass).and_then(|pass| pass.lines.get(place)).copied();
    let of = |pass: usize| levels.passes.get(pass).map_or("", |pass| &pass.name);
    let (column, head) = &levels.column;
    let at = |pass: usize, place: usize| format!("{name}:{}: ", line(pass, place).unwrap_or(0));
    match error {
        FitError::Falls { pass, measurement, .. } => {
            format!("{}column {column} ({head}): pass {}: {error}", at(*pass, *measurement), of(*pass))
        }
        FitError::Section { pass, measurement, .. } => {
            format!("{}pass {}: {error}", at(*pass, *measurement), of(*pass))
        }
        FitError::Gap { pass, before, after, .. } => {
            let between =
                match (before.and_then(|place| line(*pass, place)), after.and_then(|place| line(*pass, place))) {
                    (Some(before), Some(after)) => format!(" (between lines {before} and {after})"),
                    _ => String::new(),
                };
            let place = before.or(*after).unwrap_or(0);
            format!("{}pass {}: {error}{between}", at(*pass, place), of(*pass))
        }
        FitError::Few { pass, .. } | FitError::Flat { pass, .. } => {
            format!("{}pass {}: {error}", at(*pass, 0), of(*pass))
        }
        _ => format!("{name}: {error}"),
    }
}
