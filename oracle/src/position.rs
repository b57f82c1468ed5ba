//! `oracle position`: from measured levels of a line to the attenuation table of its trains.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use atc_kernel::position::{Millibels, Spacing};
use atc_line::position::{Config, TableConfig};
use atc_protocol::{Decibels, Metres};
use atc_waveform::calibration::measured::{
    DEVIATIONS, Fit, FitError, Measurement, Side, Wanted, Without, picture, sides,
};
use clap::{Args, Subcommand};
use serde::Serialize;

use levels::Levels;

mod levels;

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

/// The report.
#[derive(Serialize)]
struct Report {
    file: String,
    measurements: usize,
    passes: Vec<PassReport>,
    residuals: ResidualReport,
    /// Whose ends are the first and the last distance that the table covers.
    range_m: [f64; 2],
    spacing_m: Metres,
    knots_covered: [usize; 2],
    /// Intervals end with the section.
    ends_with_section: bool,
    position: Config,
    rails_otherwise: Vec<SideReport>,
    dangerous: String,
    to_look_at: Vec<String>,
    not_checked: Vec<Condition>,
}

#[derive(Serialize)]
struct PassReport {
    name: String,
    ballast_ohm_km: Option<f64>,
    range_m: [f64; 2],
    residuals: ResidualReport,
}

#[derive(Serialize)]
struct ResidualReport {
    used: usize,
    rms_db: f64,
    largest_db: f64,
    at_m: f64,
    line: u64,
}

#[derive(Serialize)]
struct SideReport {
    rise_percent: f64,
    asked: u32,
    answered: u32,
    beyond: u32,
    beyond_most_m: f64,
    before: u32,
    before_most_m: f64,
    mean_width_m: f64,
}

/// A condition that no measurement shows to hold.
#[derive(Serialize)]
struct Condition {
    id: &'static str,
    what: String,
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

fn report(name: &str, levels: &Levels, fit: &Fit, position: Config, sides: &[Side]) -> Report {
    let residuals = |one: atc_waveform::calibration::measured::Residuals| {
        let pass = levels.passes.get(one.at.0);
        ResidualReport {
            used: one.count,
            rms_db: rounded(one.rms.0, 4),
            largest_db: rounded(one.largest.0, 4),
            at_m: pass.and_then(|pass| pass.measurements.get(one.at.1)).map_or(0.0, |measured| measured.distance.0),
            line: pass.and_then(|pass| pass.lines.get(one.at.1)).copied().unwrap_or(0),
        }
    };
    let passes = levels.passes.iter().enumerate().filter_map(|(number, pass)| {
        let distances = || pass.measurements.iter().map(|measured| measured.distance.0);
        Some(PassReport {
            name: pass.name.clone(),
            ballast_ohm_km: pass.ballast_ohm_km,
            range_m: [distances().fold(f64::INFINITY, f64::min), distances().fold(0.0, f64::max)],
            residuals: residuals(fit.residuals_of(number)?),
        })
    });
    let passes: Vec<_> = passes.collect();
    Report {
        file: name.to_owned(),
        measurements: levels.passes.iter().map(|pass| pass.measurements.len()).sum(),
        residuals: residuals(fit.residuals()),
        range_m: [fit.nearest().0, fit.to.0],
        spacing_m: position.table.spacing_m,
        knots_covered: [fit.first, fit.last],
        ends_with_section: fit.bounded,
        rails_otherwise: sides.iter().map(side).collect(),
        dangerous: dangerous(sides),
        to_look_at: notes(levels, fit, sides),
        not_checked: conditions(&passes, fit),
        position,
        passes,
    }
}

fn side(side: &Side) -> SideReport {
    SideReport {
        rise_percent: side.change_percent,
        asked: side.asked,
        answered: side.answered,
        beyond: side.beyond.count,
        beyond_most_m: rounded(side.beyond.most_m, 1),
        before: side.before.count,
        before_most_m: rounded(side.before.most_m, 1),
        mean_width_m: rounded(side.mean_width_m, 1),
    }
}

/// Which side of an error is dangerous, as it was measured.
fn dangerous(sides: &[Side]) -> String {
    let first = |of: fn(&Side) -> Without, more: bool| {
        let mut all: Vec<&Side> = sides.iter().filter(|side| (side.change_percent > 0.0) == more).collect();
        all.sort_by(|a, b| a.change_percent.abs().total_cmp(&b.change_percent.abs()));
        all.into_iter().find(|side| of(side).count > 0)
    };
    let beyond = |side: &Side| side.beyond;
    let before = |side: &Side| side.before;
    let mut text = match first(beyond, true) {
        Some(side) => format!(
            "Dangerous: rails that lose more than the table says (wetter, or a steeper rail). From {:+} % on the near end is \
             beyond the train: at that change in {} of {} intervals, by up to {:.1} m. The train is nearer to its \
             stopping point than it thinks, and overruns it by as much.",
            side.change_percent, side.beyond.count, side.answered, side.beyond.most_m
        ),
        None => format!(
            "Dangerous would be rails that lose more than the table says (wetter): up to +50 % no near end was beyond the train, \
             in {} intervals.",
            sides.iter().filter(|side| side.change_percent > 0.0).map(|side| side.answered).sum::<u32>()
        ),
    };
    let _ = match first(before, false) {
        Some(side) => write!(
            text,
            " Rails that lose less (drier) put the far end before the train, from {:+} % on: by up to {:.1} m there. Such a \
             train brakes too early; what counts on the far end, as its tail does, is wrong too.",
            side.change_percent, side.before.most_m
        ),
        None => write!(text, " Rails that lose less (drier) did not put the far end before the train, down to -50 %."),
    };
    if let Some(side) = first(beyond, false) {
        let _ = write!(
            text,
            " Also at {:+} % a near end is beyond the train, in {} of {} intervals by up to {:.1} m.",
            side.change_percent, side.beyond.count, side.answered, side.beyond.most_m
        );
    }
    text
}

/// What somebody should look at.
fn notes(levels: &Levels, fit: &Fit, sides: &[Side]) -> Vec<String> {
    let mut notes = Vec::new();
    for (pass, place, residual) in fit.remarkable() {
        if let Some(pass) = levels.passes.get(pass) {
            notes.push(format!(
                "line {}: {:+.2} dB from the line of its pass at {} m, far more than its neighbours; it widens the tolerance",
                pass.lines[place], residual.0, pass.measurements[place].distance.0
            ));
        }
    }
    for (number, pass) in fit.passes.iter().enumerate() {
        if pass.levelled {
            let name = levels.passes.get(number).map_or("", |pass| &pass.name);
            notes.push(format!(
                "pass {name}: the difference falls in places, within the spread; the fit is level there"
            ));
        }
    }
    let silent: u32 =
        sides.iter().filter(|side| side.change_percent.abs() < 0.1).map(|side| side.asked - side.answered).sum();
    if silent > 0 {
        notes.push(format!(
            "in the steepest pass itself {silent} of {} positions are unknown: there a flatter one may be beyond the table{}",
            sides.first().map_or(0, |side| side.asked),
            if fit.bounded { "" } else { "; --section-m helps if no train is there" }
        ));
    }
    if fit.passes.len() == 1 {
        notes.push("there is one pass: the table holds for its weather alone".to_owned());
    }
    if fit.from.0 > 0.0 && fit.first == 0 {
        notes.push(format!(
            "from 0 to {} m nothing was measured in every pass: there the line of the first span goes on",
            fit.from.0
        ));
    }
    notes
}

/// What no measurement of one day can show.
fn conditions(passes: &[PassReport], fit: &Fit) -> Vec<Condition> {
    let named: Vec<&str> = passes.iter().map(|pass| pass.name.as_str()).collect();
    let ballast: Vec<f64> = passes.iter().filter_map(|pass| pass.ballast_ohm_km).collect();
    let known = if ballast.len() == passes.len() && !ballast.is_empty() {
        let (least, most) =
            ballast.iter().fold((f64::INFINITY, 0.0_f64), |(least, most), &one| (least.min(one), most.max(one)));
        format!(" ({least} to {most} Ω·km)")
    } else {
        String::new()
    };
    let mut all = vec![
        Condition {
            id: "calibration-covers-the-weather",
            what: format!(
                "that no weather is wetter or drier than the measured one: {}{known}; nor other sections, transmitters and trains",
                named.join("; ")
            ),
        },
        Condition {
            id: "levels-within-tolerance",
            what: format!(
                "that a train's levels are off by no more than these were: {} dB each ({DEVIATIONS} standard deviations, or the \
                 largest residual)",
                Decibels(fit.tolerance.0.into())
            ),
        },
        Condition { id: "transmitter-at-exit", what: "that distances were counted from the section's exit".to_owned() },
    ];
    if fit.bounded {
        let what = format!("that no train beyond {} m hears this transmitter (--section-m)", fit.to.0);
        all.push(Condition { id: "levels-of-one-section", what });
    }
    all
}

/// The report in words.
fn words(report: &Report) -> String {
    let mut text = String::new();
    let Report { file, measurements, residuals, range_m: [from, to], .. } = report;
    let count = report.passes.len();
    let _ = writeln!(text, "{file}: {measurements} measurements in {count} {}\n", plural(count, "pass", "passes"));
    let _ = writeln!(text, "   used   from m     to m   RMS dB  largest dB    at m   line  pass");
    let row = |text: &mut String, one: &ResidualReport, range: Option<[f64; 2]>, name: &str| {
        let [from, to] = range.map_or([String::new(), String::new()], |ends| ends.map(|end| format!("{end:.1}")));
        let _ = writeln!(
            text,
            "{:7} {from:>8} {to:>8} {:8.3} {:+11.2} {:7.1} {:6}  {name}",
            one.used, one.rms_db, one.largest_db, one.at_m, one.line
        );
    };
    for pass in &report.passes {
        row(&mut text, &pass.residuals, Some(pass.range_m), &pass.name);
    }
    row(&mut text, residuals, None, "all");
    let [first, last] = report.knots_covered;
    let _ = writeln!(
        text,
        "\ntable: knots {first} to {last} of 0 to 16, {} m apart, are measured: it covers {from} to {to} m\n\
         tolerance of a level: {} dB; floor: {} dB",
        report.spacing_m, report.position.tolerance_db, report.position.floor_db
    );
    let end = if report.ends_with_section {
        format!("beyond {to} m is no train: an interval ends at the first knot there")
    } else {
        format!("a train that may be beyond {to} m is unknown; --section-m ends the table there if no train can be")
    };
    let start = if first > 0 { format!("a train nearer than {from} m is unknown; ") } else { String::new() };
    let _ = writeln!(text, "ends: {start}{end}");
    let _ = writeln!(
        text,
        "\nThe kernel on this table where the difference rises otherwise than measured, errors as these residuals:\n   \
         rise   answered  near end beyond the train   far end before it   mean width"
    );
    for side in &report.rails_otherwise {
        let _ = writeln!(
            text,
            "{:+6} % {:4} of {:4} {:6} {:>14} {:10} {:>14} {:10.1} m",
            side.rise_percent,
            side.answered,
            side.asked,
            side.beyond,
            reach(side.beyond, side.beyond_most_m),
            side.before,
            reach(side.before, side.before_most_m),
            side.mean_width_m
        );
    }
    let _ = writeln!(text, "\n{}\n", report.dangerous);
    for note in &report.to_look_at {
        let _ = writeln!(text, "to look at: {note}");
    }
    for condition in &report.not_checked {
        let _ = writeln!(text, "NOT CHECKED: {} [{}]", condition.what, condition.id);
    }
    text
}

fn reach(count: u32, most: f64) -> String {
    if count == 0 { String::new() } else { format!("up to {most:.1} m") }
}

fn plural<'a>(count: usize, one: &'a str, more: &'a str) -> &'a str {
    if count == 1 { one } else { more }
}

/// The table of a line's file.
fn toml(report: &Report) -> String {
    let Config { table, tolerance_db, floor_db, .. } = &report.position;
    let list = |levels: &[Decibels]| levels.iter().map(Decibels::to_string).collect::<Vec<_>>().join(", ");
    let mut text = format!(
        "# From {} measurements in {}: oracle position calibrate.\n",
        report.measurements,
        Path::new(&report.file).file_name().map_or_else(|| "-".into(), |name| name.to_string_lossy())
    );
    for condition in &report.not_checked {
        let _ = writeln!(text, "# Not checked: {} [{}]", condition.what.replace('\n', " "), condition.id);
    }
    let _ = writeln!(
        text,
        "[position]\nspacing_m = {}\nlowest_db = [{}]\nhighest_db = [{}]\ntolerance_db = {tolerance_db}\nfloor_db = {floor_db}",
        table.spacing_m,
        list(&table.lowest_db),
        list(&table.highest_db)
    );
    text
}

fn json(value: &impl Serialize) -> String {
    serde_json::to_string_pretty(value).map_or_else(|error| error.to_string(), |text| text + "\n")
}

fn rounded(value: f64, decimals: i32) -> f64 {
    let scale = 10_f64.powi(decimals);
    (value * scale).round() / scale
}
