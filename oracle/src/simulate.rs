//! `oracle simulate`: a line with trains, one run or a campaign of them, and the headline; the film of a run for
//! `oracle explore`.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::time::Instant;

use atc_film::Film;
use atc_simulation::campaign::{self, Campaign, Cause};
use atc_simulation::defect::Defect;
use atc_simulation::driver::Drivers;
use atc_simulation::fault::{Extent, Fault, Kind};
use atc_simulation::headline;
use atc_simulation::line::Line;
use atc_simulation::onboard::{Operate, Signal};
use atc_simulation::rare::{self, Chance};
use atc_simulation::record::Record;
use atc_simulation::splitting;
use atc_simulation::world::{Setting, World};
use atc_simulation::{charts, diagram};
use clap::{Args, ValueEnum};

#[derive(Args)]
#[command(after_help = "A line file names its stations from west to east, or has them made:\n\n  \
    name = \"My line\"\n  [[station]]\n  layout = \"west.toml\"        # a layout file, beside this one\n  [[station]]\n  layout = \"east.toml\"\n\n  \
    [generated]                 # in place of [[station]]\n  tracks = [2, 2, 2]\n  blocks = [4, 4]\n\n\
    Faults: interruption, misread-code, false-occupancy, shunt-loss, missed-detection, late-point, lost-telegram, \
    delayed-telegram, repeated-code, restart-station, restart-train.\n\n\
    Wrong parts: clears-at-once, starts-at-once, codes-too-high (ground); pattern-too-high, telegrams-live-on, \
    codes-at-once, codes-live-on (on board).")]
pub struct SimulateArgs {
    /// The line: stations and trains (TOML)
    #[arg(required_unless_present = "headline", value_name = "LINE.toml")]
    file: Option<PathBuf>,
    #[command(flatten)]
    run: RunArgs,
    /// The train of the speed profile
    #[arg(long, default_value_t = 0, value_name = "TRAIN")]
    profile: usize,
    /// Runs so many times with one fault each, and tells in how many runs something unsafe happened
    #[arg(long, value_name = "RUNS")]
    campaign: Option<u64>,
    /// In a campaign, two things are wrong in each run: two faults at about the same time and place, a wrong part and a
    /// fault, or two wrong parts (and each wrong part alone)
    #[arg(long, requires = "campaign", conflicts_with_all = ["faults", "defects"])]
    pairs: bool,
    /// How many faults each run of a campaign has, all of one kind; with --pairs so many pairs [default: 1]. Without
    /// --campaign: draws so many of each kind of --faults as the run of a campaign with this seed has them
    #[arg(long, value_name = "FAULTS")]
    each: Option<usize>,
    /// Measures needless brake applications, delay and margins against the length of interruptions, on a line of its own
    #[arg(long, conflicts_with = "campaign")]
    headline: bool,
    /// Faults come by chance, so many of each kind of --faults in an hour: tells how likely harm is in a run, by importance
    /// splitting over how long a train is not reported
    #[arg(long, conflicts_with_all = ["campaign", "headline", "each"], requires = "faults", value_name = "PER_HOUR")]
    rare: Option<f64>,
    /// How many runs begin at each level of a splitting
    #[arg(long, default_value_t = 40, requires = "rare", value_parser = clap::value_parser!(u32).range(2..=10_000))]
    effort: u32,
    /// Where events (JSON lines), pictures (SVG) and figures go [default: the events to standard output]
    #[arg(short, long, value_name = "FOLDER")]
    pub output: Option<PathBuf>,
}

/// What a run is like.
#[derive(Args)]
pub struct RunArgs {
    /// What chance depends on; a run is the same every time for one seed
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// How long a run is, in seconds of the line [default: 1800; in a campaign 600; with --rare 180]
    #[arg(long)]
    time: Option<u32>,
    /// How many trains there are [default: as the file says]
    #[arg(long)]
    trains: Option<usize>,
    /// What fails, each once at a random time; in a campaign each run has one of them [default there: everything]
    #[arg(long, value_delimiter = ',', value_parser = kind, value_name = "FAULT,…")]
    faults: Vec<Kind>,
    /// Faults last far longer than the conditions allow
    #[arg(long)]
    beyond: bool,
    /// The trains' device
    #[arg(long, value_enum, default_value = "shortened")]
    device: Device,
    /// What trains run on
    #[arg(long, value_enum, default_value = "codes")]
    signal: On,
    /// What drivers do with the cab signal
    #[arg(long, value_enum, default_value = "careful")]
    drivers: Who,
    /// Parts that are wrong all the time
    #[arg(long, value_delimiter = ',', value_parser = defect, value_name = "PART,…")]
    defects: Vec<Defect>,
}

impl RunArgs {
    /// An option that was given, for what is no run.
    pub fn given(&self) -> Option<&'static str> {
        let options = [
            ("--seed", self.seed != 1),
            ("--time", self.time.is_some()),
            ("--trains", self.trains.is_some()),
            ("--faults", !self.faults.is_empty()),
            ("--beyond", self.beyond),
            ("--device", self.device != Device::Shortened),
            ("--signal", self.signal != On::Codes),
            ("--drivers", self.drivers != Who::Careful),
            ("--defects", !self.defects.is_empty()),
        ];
        options.iter().find(|(_, there)| *there).map(|(option, _)| *option)
    }
}

#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Device {
    /// With the shortened operate time
    Shortened,
    /// Without it
    Conventional,
}

#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
enum On {
    /// Codes alone
    Codes,
    /// Telegrams alone: the ground's transmitters send frames for both directions of travel in turn
    Telegrams,
    /// Telegrams with codes beside them
    Both,
}

#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Who {
    /// They obey it
    Careful,
    /// They motor whatever it says, and stop at stations alone: the device on board holds the train
    Heedless,
}

const fn drivers(args: &RunArgs) -> Drivers {
    match args.drivers {
        Who::Careful => Drivers::Careful,
        Who::Heedless => Drivers::Heedless,
    }
}

const fn signal(args: &RunArgs) -> Signal {
    match args.signal {
        On::Codes => Signal::Codes,
        On::Telegrams => Signal::Telegrams,
        On::Both => Signal::Both,
    }
}

fn kind(name: &str) -> Result<Kind, String> {
    let known = |kinds: &[Kind]| kinds.iter().map(|kind| kind.name()).collect::<Vec<_>>().join(", ");
    let none = || {
        let (every, counting) = (known(&Kind::ALL), known(&Kind::COUNTING));
        format!("there is no such fault; there are {every}; and on a counted line {counting}")
    };
    Kind::named(name).ok_or_else(none)
}

fn defect(name: &str) -> Result<Defect, String> {
    let known = || Defect::ALL.map(Defect::name).join(", ");
    Defect::named(name).ok_or_else(|| format!("there is no such wrong part; there are {}", known()))
}

/// What came of the command.
#[derive(Default)]
pub struct Done {
    /// Files for the folder.
    pub files: Vec<(&'static str, String)>,
    /// What goes to standard output.
    pub text: String,
    /// What is said beside it.
    pub remarks: String,
    /// Whether something unsafe happened.
    pub is_unsafe: bool,
}

/// The line of a file; it must be one that can have the faults that are asked for.
fn read(file: &Path, args: &RunArgs) -> Result<Line, String> {
    let line = Line::read(file)?;
    match args.faults.iter().find(|kind| !Kind::of(&line).contains(kind)) {
        None => Ok(line),
        Some(kind) => Err(format!("{}: {} needs a line with [[counted]] blocks", file.display(), kind.name())),
    }
}

/// Runs what is asked for.
pub fn run(args: &SimulateArgs) -> Result<Done, String> {
    if args.headline {
        return measure(args);
    }
    let file = args.file.as_ref().ok_or("a line file is needed")?;
    let line = read(file, &args.run)?;
    let trains = trains(&args.run, &line);
    if let Some(per_hour) = args.rare {
        return rarely(args, &line, (trains, per_hour));
    }
    match args.campaign {
        Some(runs) => many(args, &line, (trains, runs)),
        None => one(args, &line, trains),
    }
}

fn trains(args: &RunArgs, line: &Line) -> usize {
    args.trains.or(line.number_of_trains).unwrap_or_else(|| line.room().saturating_sub(1))
}

const fn extent(args: &RunArgs) -> Extent {
    if args.beyond { Extent::Beyond } else { Extent::Tolerated }
}

/// For how many seconds a run goes on if nothing else is said.
const SECONDS: u32 = 1_800;

/// `each`: draws so many faults of each kind that is named, as the run of a campaign with this seed has them.
fn setting(args: &RunArgs, line: &Line, trains: usize, each: Option<usize>) -> Result<Setting, String> {
    let seconds = args.time.unwrap_or(SECONDS);
    let mut faults = Vec::new();
    if seconds == 0 && !args.faults.is_empty() {
        return Err("--time 0: a fault needs a time to begin; give 1 or more".to_owned());
    }
    if let Some(each) = each {
        several(each, seconds)?;
        if args.faults.is_empty() {
            return Err(format!("--each {each}: name the kinds of faults with --faults"));
        }
        let causes = vec![Cause { kinds: args.faults.clone(), ..Cause::default() }];
        faults = campaign::faults(line, &campaign_of(args, (1, causes, each), (trains, seconds)), 0).1;
    }
    let single = if each.is_none() { args.faults.as_slice() } else { &[] };
    for (number, kind) in single.iter().enumerate() {
        let window = (60_000.0_f64.min(f64::from(seconds) * 500.0), f64::from(seconds) * 1000.0);
        faults.push(Fault::drawn(*kind, extent(args), line, window, args.seed + number as u64));
    }
    Ok(Setting { faults, ..bare(args, trains) })
}

/// Whether so many faults may be drawn in a run of so many seconds.
fn several(each: usize, seconds: u32) -> Result<(), String> {
    if each == 0 {
        return Err("--each 0: give 1 or more".to_owned());
    }
    if seconds <= 60 {
        return Err(format!("--time {seconds}: faults begin after the first minute; a run needs more than 60 s"));
    }
    Ok(())
}

/// A run without faults.
fn bare(args: &RunArgs, trains: usize) -> Setting {
    let operate = match args.device {
        Device::Shortened => Operate::Shortened,
        Device::Conventional => Operate::Conventional,
    };
    let (seed, signal, drivers, defects) = (args.seed, signal(args), drivers(args), args.defects.clone());
    Setting { operate, trains, seed, faults: Vec::new(), compared: false, signal, drivers, defects }
}

/// A campaign of so many runs, causes and faults in each; with so many trains, for so many seconds.
fn campaign_of(
    args: &RunArgs,
    (runs, causes, faults): (u64, Vec<Cause>, usize),
    (trains, seconds): (usize, u32),
) -> Campaign {
    let (extent, seed, signal, drivers) = (extent(args), args.seed, signal(args), drivers(args));
    Campaign { runs, causes, extent, faults, trains, seconds, seed, signal, drivers }
}

/// The film of a run.
pub struct Made {
    /// The film.
    pub film: Film,
    /// What is said beside it.
    pub remarks: String,
    /// Whether something unsafe happened.
    pub is_unsafe: bool,
}

/// Runs a line and films it, second by second.
pub fn film(file: &Path, args: &RunArgs, each: Option<usize>, title: Option<&str>) -> Result<Made, String> {
    let line = read(file, args)?;
    let mut world = World::new(&line, setting(args, &line, trains(args, &line), each)?)?;
    let end_ms = u64::from(args.time.unwrap_or(SECONDS)) * 1000;
    let mut film = atc_simulation::film::of(&mut world, end_ms, 1_000)?;
    if let Some(title) = title {
        title.clone_into(&mut film.title);
    }
    let remarks = unsafe_event(&world)?;
    Ok(Made { film, remarks, is_unsafe: world.is_unsafe })
}

/// What was unsafe, as a remark; nothing if nothing was.
fn unsafe_event(world: &World<'_>) -> Result<String, String> {
    let Some(event) = world.events.iter().find(|event| event.what.is_unsafe()) else { return Ok(String::new()) };
    let event = serde_json::to_string(event).map_err(|error| error.to_string())?;
    Ok(format!("UNSAFE: {event}\n"))
}

fn one(args: &SimulateArgs, line: &Line, trains: usize) -> Result<Done, String> {
    let seconds = args.run.time.unwrap_or(SECONDS);
    if trains > 0 && args.profile >= trains {
        return Err(format!("--profile {}: the trains are 0 to {}", args.profile, trains.saturating_sub(1)));
    }
    let mut world = World::new(line, setting(&args.run, line, trains, args.each)?)?;
    let start = Instant::now();
    let record = Record::of(&mut world, u64::from(seconds) * 1000, 1_000);
    let took = start.elapsed().as_secs_f64();
    let mut events = String::new();
    for event in &world.events {
        events += &serde_json::to_string(event).map_err(|error| error.to_string())?;
        events.push('\n');
    }
    let mut done = Done { is_unsafe: world.is_unsafe, ..Done::default() };
    let ran = f64::from(u32::try_from(world.now_ms).unwrap_or(u32::MAX)) / 1000.0;
    let circuits = line.track.circuits.len();
    let _ = writeln!(
        done.remarks,
        "{}: {} stations, {circuits} circuits, {trains} trains; {ran:.0} s in {took:.1} s, {:.0} times real time",
        line.name,
        line.stations.len(),
        ran / took.max(1e-9)
    );
    done.remarks += &unsafe_event(&world)?;
    if args.output.is_none() {
        done.text = events;
        return Ok(done);
    }
    let profile = charts::profile(&record, args.profile, &format!("Train {}", args.profile))
        .map_err(|error| error.to_string())?;
    done.files = vec![
        ("events.jsonl", events),
        ("diagram.svg", diagram::draw(line, &record, &line.name)),
        ("profile.svg", profile),
    ];
    Ok(done)
}

fn many(args: &SimulateArgs, line: &Line, (trains, runs): (usize, u64)) -> Result<Done, String> {
    let (kinds, defects) = (&args.run.faults, &args.run.defects);
    let causes = match (args.pairs, kinds.is_empty()) {
        (true, _) => Cause::pairs(line),
        (false, true) => Kind::of(line).into_iter().map(Cause::from).collect(),
        (false, false) => kinds.iter().copied().map(Cause::from).collect(),
    };
    let causes = causes.into_iter().map(|cause| Cause { defects: [defects.clone(), cause.defects].concat(), ..cause });
    let seconds = args.run.time.unwrap_or(600);
    if runs == 0 {
        return Err("--campaign 0: give 1 run or more".to_owned());
    }
    several(args.each.unwrap_or(1), seconds)?;
    let campaign = campaign_of(&args.run, (runs, causes.collect(), args.each.unwrap_or(1)), (trains, seconds));
    let outcomes = campaign::run(line, &campaign, &|_| ())?;
    let mut done = Done::default();
    let names: Vec<String> = outcomes.keys().map(Cause::to_string).collect();
    let wide = names.iter().map(String::len).max().unwrap_or(0).max(18);
    let _ = writeln!(done.text, "{:<wide$} {:>7} {:>7} {:>9}  first unsafe run", "fault", "runs", "unsafe", "arrivals");
    for (name, outcome) in names.iter().zip(outcomes.values()) {
        let first = match &outcome.first {
            Some((seed, event)) => {
                format!("seed {seed}: {}", serde_json::to_string(event).map_err(|error| error.to_string())?)
            }
            None => String::new(),
        };
        let row =
            format!("{name:<wide$} {:>7} {:>7} {:>9}  {first}", outcome.runs, outcome.unsafe_runs, outcome.arrivals);
        let _ = writeln!(done.text, "{}", row.trim_end());
        done.is_unsafe |= outcome.unsafe_runs > 0;
    }
    let json = serde_json::to_string_pretty(&outcomes).map_err(|error| error.to_string())?;
    done.files = vec![("campaign.json", json + "\n")];
    Ok(done)
}

/// How likely harm is in a run, with the scatter of so many splittings.
fn rarely(args: &SimulateArgs, line: &Line, (trains, per_hour): (usize, f64)) -> Result<Done, String> {
    const SPLITTINGS: u32 = 10;
    if !(per_hour.is_finite() && per_hour > 0.0) {
        return Err(format!("--rare {per_hour}: a number of faults in an hour, above 0"));
    }
    let seconds = args.run.time.unwrap_or(180);
    if seconds <= 60 {
        return Err(format!("--time {seconds}: nothing moves for about a minute after the start; give more than 60"));
    }
    let kinds = args.run.faults.clone();
    let chance = Chance { kinds, per_hour, from_ms: 60_000, end_ms: u64::from(seconds) * 1000 };
    let start = rare::Run::new(line, bare(&args.run, trains), &chance)?;
    let estimate = splitting::estimate(&start, &rare::LEVELS, (args.effort, SPLITTINGS), args.run.seed);
    let mut done = Done::default();
    let _ = writeln!(done.text, "{:>6} {:>8} {:>8}", "level", "runs", "reached");
    for (number, level) in rare::LEVELS.iter().enumerate() {
        let stages = estimate.found.iter().filter_map(|found| found.stages.get(number));
        let (runs, reached) = stages.fold((0, 0), |sum, stage| (sum.0 + stage.runs, sum.1 + stage.reached));
        let _ = writeln!(done.text, "{level:>6} {runs:>8} {reached:>8}");
    }
    let _ = writeln!(
        done.text,
        "harm in a run of {seconds} s: {:.2e}, standard error {:.1e}, of {SPLITTINGS} splittings",
        estimate.probability, estimate.error
    );
    if estimate.probability == 0.0 {
        done.text += "no run came to harm: it is rarer than this can see; give a greater --effort\n";
    }
    let json = serde_json::to_string_pretty(&estimate).map_err(|error| error.to_string())?;
    done.files = vec![("splitting.json", json + "\n")];
    Ok(done)
}

fn measure(args: &SimulateArgs) -> Result<Done, String> {
    let mut extent = headline::Extent { seed: args.run.seed, ..headline::Extent::default() };
    extent.seconds = args.run.time.unwrap_or(extent.seconds);
    extent.trains = args.run.trains.unwrap_or(extent.trains);
    let measured = headline::measure(&extent)?;
    let svg = charts::headline(&measured).map_err(|error| error.to_string())?;
    let is_unsafe = measured.unsafe_events() > 0;
    let files = vec![("shortened-operate.csv", measured.csv()), ("shortened-operate.svg", svg)];
    Ok(Done { files, text: measured.csv(), is_unsafe, ..Done::default() })
}
