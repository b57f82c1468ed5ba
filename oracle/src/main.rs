//! `oracle`: the kernel as a reference, on the command line.

mod conformance;
mod explore;
mod layout;
mod line;
mod position;
mod replaying;
mod simulate;

use std::fmt;
use std::fs;
use std::io::{self, Read as _, Write as _};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use atc_oracle::chart::{self, Part, View};
use atc_oracle::signal::{self, Config, SignalError};
use atc_oracle::trace::{Replies, Trace, TraceError};
use clap::{Args, CommandFactory as _, Parser, Subcommand, ValueEnum};

/// The verified kernel as a reference oracle
#[derive(Parser)]
#[command(version = concat!(env!("CARGO_PKG_VERSION"), " (protocol 1)"))]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    /// Answers JSON lines (protocol 1) from standard input on standard output
    #[command(after_help = "A session, to be typed line by line:\n  \
        {\"start\":{\"protocol\":1,\"machine\":\"block-count\",\"config\":{\"sections\":3,\"max_trains\":3,\"tail_hold_sections\":1}}}\n  \
        {\"step\":{\"check_in\":false,\"check_out\":false,\"present\":[],\"reset\":0}}\n  \
        {\"stop\":{}}\n\
        Every line gets one reply. Read replies while you send: after some 36,000 unread ones both sides wait.")]
    Serve,
    /// Draws the timing chart of a recorded session (SVG) and writes its signals (VCD)
    Chart(ChartArgs),
    /// Holds another implementation against the kernel, down to the first difference
    Conform(Box<conformance::ConformArgs>),
    /// Writes test vectors: cases with the kernel's replies and the requirements that they are about
    Vectors(conformance::VectorsArgs),
    /// Holds the logs of recorders against the kernel, in bulk
    Replay(Box<replaying::ReplayArgs>),
    /// Makes the train control signal as a WAV file, or reads one; the link budget of a line
    #[command(subcommand)]
    Signal(SignalCommand),
    /// Checks, imports, tabulates or draws the layout of a station
    #[command(subcommand)]
    Layout(layout::LayoutCommand),
    /// Checks the data of a whole line, and what its stations and trains count on of each other
    #[command(subcommand)]
    Line(line::LineCommand),
    /// Makes the attenuation table of train positions from measured levels
    #[command(subcommand)]
    Position(position::PositionCommand),
    /// Prints a JSON Schema: of protocol 1, or of what `conform`, `replay` and `vectors` write
    Schema {
        /// Of which form
        #[arg(value_enum, default_value = "protocol")]
        of: SchemaOf,
    },
    /// Runs a line with trains under the kernel's devices, judged by the truth and not by the devices; exit code 1 if it is unsafe
    Simulate(simulate::SimulateArgs),
    /// Makes a page that plays a session, a trace of a model or a simulated line: track plan, trains, signals, rows over time
    Explore(explore::ExploreArgs),
    /// Prints what a shell needs to complete the commands
    Completions {
        /// The shell
        shell: clap_complete::Shell,
    },
}

/// What there is a schema of.
#[derive(Clone, Copy, ValueEnum)]
enum SchemaOf {
    /// A line of protocol 1
    Protocol,
    /// The JSON report of `oracle conform`
    Report,
    /// The JSON report of `oracle replay`
    Replay,
    /// A line of a file of vectors
    Vector,
}

#[derive(Subcommand)]
enum SignalCommand {
    /// Writes the signal of a configuration as a WAV file
    Generate {
        /// The configuration; every part of it has defaults
        config: PathBuf,
        /// Where the signal goes
        output: PathBuf,
    },
    /// Prints the telegrams and speeds of a WAV file as JSON lines
    Decode {
        /// A recording of one channel, 16-bit integer or 32-bit float
        input: PathBuf,
        /// The configuration of the signal and the line [default: the standard ones]
        #[arg(long)]
        config: Option<PathBuf>,
    },
    /// Says what is left of a line's signal at the far end of its longest section, and what telegrams and codes need
    #[command(after_help = "Example:\n  \
        oracle signal budget my-line.toml --svg budget.svg\n\
        Levels, noise, ballast and the least margin are the line's [budget] (line/README.md); what is not given there is a default, and \
        the output says so. What the receiver needs is measured in the run.\n\
        Exit code: 0 every margin is enough, 1 one is not (the section is named), 2 the file cannot be read as a line.")]
    Budget {
        /// The line (TOML)
        line: PathBuf,
        /// Where the picture goes
        #[arg(long, value_name = "FILE.svg")]
        svg: Option<PathBuf>,
        /// Prints the report as JSON
        #[arg(long)]
        json: bool,
    },
}

#[derive(Args)]
struct ChartArgs {
    /// Request lines, with their replies if these were kept; "-" for standard input
    trace: PathBuf,
    /// Where the chart goes; standard output if neither file is named
    #[arg(short, long, value_name = "FILE.svg")]
    output: Option<PathBuf>,
    /// Where the signals go, for a waveform viewer
    #[arg(long, value_name = "FILE.vcd")]
    vcd: Option<PathBuf>,
    /// The chart's title [default: the machine's name]
    #[arg(long)]
    title: Option<String>,
    /// The first instant drawn, in the unit of the chart's axis
    #[arg(long)]
    from: Option<u64>,
    /// The last instant drawn
    #[arg(long)]
    to: Option<u64>,
    /// Draws only the figure over distance, or only the rows
    #[arg(long, value_enum)]
    only: Option<Only>,
    /// Draws replies that differ from the kernel's in red, with exit code 1 if there are any; else the first one is an error
    #[arg(long)]
    as_recorded: bool,
}

/// A part of a chart.
#[derive(Clone, Copy, ValueEnum)]
enum Only {
    Figure,
    Rows,
}

/// What stops a command, with the file that it is about.
enum Failure {
    Read(PathBuf, io::Error),
    Write(PathBuf, io::Error),
    Trace(PathBuf, TraceError),
    Serve(io::Error),
    Config(PathBuf, String),
    Signal(String),
    Layout(atc_layout::Errors),
    /// What was asked for cannot be done: exit code 2.
    Asked(String),
    /// What was compared is not the same; it has been told.
    Differs,
    /// Something is not as it should be; it has been told. The exit code.
    Told(u8),
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Read(path, error) => write!(f, "{} cannot be read: {error}", path.display()),
            Self::Write(path, error) => write!(f, "{} cannot be written: {error}", path.display()),
            Self::Trace(path, error) => write!(f, "{}: {error}", path.display()),
            Self::Serve(error) => write!(f, "the session broke off: {error}"),
            Self::Config(path, reason) => write!(f, "{}: {reason}", path.display()),
            Self::Signal(reason) | Self::Asked(reason) => f.write_str(reason),
            Self::Layout(errors) => write!(f, "{errors}"),
            Self::Differs | Self::Told(_) => Ok(()),
        }
    }
}

fn main() -> ExitCode {
    let result = match Cli::parse().command {
        Command::Serve => atc_oracle::serve(io::stdin().lock(), io::stdout().lock()).map_err(Failure::Serve),
        Command::Chart(args) => draw(&args),
        Command::Signal(command) => signal(&command),
        Command::Layout(command) => layout(command),
        Command::Line(command) => line(&command),
        Command::Position(position::PositionCommand::Calibrate(args)) => calibrate(&args),
        Command::Conform(args) => conformance::conform(&args),
        Command::Replay(args) => replaying::replay(&args),
        Command::Vectors(args) => conformance::vectors(&args),
        Command::Schema { of } => print(&match of {
            SchemaOf::Protocol => atc_protocol::schema::text(),
            SchemaOf::Replay => atc_oracle::replay::report::schema(),
            SchemaOf::Report => atc_oracle::conform::report::schema(),
            SchemaOf::Vector => atc_oracle::conform::vectors::schema(),
        }),
        Command::Simulate(args) => simulate(&args),
        Command::Explore(args) => explore(&args),
        Command::Completions { shell } => completions(shell),
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(Failure::Differs) => ExitCode::FAILURE,
        Err(Failure::Told(code)) => ExitCode::from(code),
        // Each line of these begins with its file and place, as an editor wants it.
        Err(Failure::Layout(errors)) => {
            remark(&format!("{errors}\n"));
            ExitCode::FAILURE
        }
        Err(failure @ Failure::Asked(_)) => {
            remark(&format!("oracle: {failure}\n"));
            ExitCode::from(2)
        }
        Err(failure) => {
            remark(&format!("oracle: {failure}\n"));
            ExitCode::FAILURE
        }
    }
}

fn completions(shell: clap_complete::Shell) -> Result<(), Failure> {
    let mut text = Vec::new();
    clap_complete::generate(shell, &mut Cli::command(), "oracle", &mut text);
    print(&String::from_utf8_lossy(&text))
}

fn draw(args: &ChartArgs) -> Result<(), Failure> {
    let text = read(&args.trace)?;
    let broken = |error| Failure::Trace(args.trace.clone(), error);
    let trace = Trace::parse(&text).map_err(broken)?;
    let replies = if args.as_recorded { Replies::AsRecorded } else { Replies::MustAgree };
    let only = args.only.map(|only| match only {
        Only::Figure => Part::Figure,
        Only::Rows => Part::Rows,
    });
    let view = View { title: args.title.clone(), from: args.from, to: args.to, only };
    // Both are made before either is written.
    let svg = chart::svg(&trace, replies, &view).map_err(broken)?;
    let vcd =
        args.vcd.as_ref().map(|path| chart::vcd(&trace, replies).map(|vcd| (path, vcd))).transpose().map_err(broken)?;
    match &args.output {
        Some(path) => write(path, &svg)?,
        None if args.vcd.is_none() => print(&svg)?,
        None => {}
    }
    vcd.map_or(Ok(()), |(path, vcd)| write(path, &vcd))?;
    // The chart shows what differs; the exit code says that something does.
    let differs = args.as_recorded && trace.scenes(Replies::MustAgree).is_err();
    if differs { Err(Failure::Differs) } else { Ok(()) }
}

fn signal(command: &SignalCommand) -> Result<(), Failure> {
    let config = |path: &Path| {
        let broken = |reason| Failure::Config(path.to_owned(), reason);
        Config::parse(&read(path)?).map_err(broken)
    };
    let (done, path) = match command {
        SignalCommand::Generate { config: path, output } => {
            (signal::generate(&config(path)?, output), Some(path.as_path()))
        }
        SignalCommand::Decode { input, config: path } => {
            let path = path.as_deref();
            let config = path.map(config).transpose()?.unwrap_or_default();
            (signal::decode(&config, input, io::stdout().lock()), path)
        }
        SignalCommand::Budget { line, svg, json } => return budget(line, svg.as_deref(), *json),
    };
    done.or_else(|error| match error {
        SignalError::Output(error) if error.kind() == io::ErrorKind::BrokenPipe => Ok(()),
        SignalError::Output(error) => Err(Failure::Write("standard output".into(), error)),
        SignalError::Recording(reason) => Err(Failure::Signal(reason)),
        // Only a configuration that was named can be wrong.
        SignalError::Config(reason) => Err(Failure::Config(path.unwrap_or(Path::new("-")).to_owned(), reason)),
    })
}

fn budget(path: &Path, svg: Option<&Path>, json: bool) -> Result<(), Failure> {
    let line = atc_line::read(path).map_err(|problems| {
        remark(&format!("{problems}\n"));
        Failure::Told(if problems.is_unreadable() { 2 } else { 1 })
    })?;
    let report = signal::budget(&line).map_err(|reason| Failure::Config(path.to_owned(), reason))?;
    let picture = svg.map(|svg| report.picture().map(|text| (svg, text))).transpose();
    let picture = picture.map_err(|error| Failure::Signal(error.to_string()))?;
    if let Some((svg, text)) = picture {
        write(svg, &text)?;
    }
    if json {
        let text = serde_json::to_string_pretty(&report).map_err(|error| Failure::Signal(error.to_string()))?;
        print(&(text + "\n"))?;
    } else {
        print(&report.words())?;
    }
    for broken in &report.broken {
        remark(&format!("{}: {broken}\n", path.display()));
    }
    if report.broken.is_empty() { Ok(()) } else { Err(Failure::Told(1)) }
}

fn simulate(args: &simulate::SimulateArgs) -> Result<(), Failure> {
    let done = simulate::run(args).map_err(Failure::Signal)?;
    if let Some(folder) = &args.output {
        fs::create_dir_all(folder).map_err(|error| Failure::Write(folder.clone(), error))?;
        for (name, text) in &done.files {
            write(&folder.join(name), text)?;
        }
    }
    print(&done.text)?;
    remark(&done.remarks);
    if done.is_unsafe { Err(Failure::Differs) } else { Ok(()) }
}

fn explore(args: &explore::ExploreArgs) -> Result<(), Failure> {
    let done = if explore::is_line(&args.file) {
        explore::line(args).map_err(Failure::Signal)?
    } else {
        explore::session(args, &read(&args.file)?).map_err(|wrong| match wrong {
            explore::Wrong::Trace(error) => Failure::Trace(args.file.clone(), error),
            explore::Wrong::Layout(errors) => Failure::Layout(errors),
            explore::Wrong::Reason(reason) => Failure::Config(args.file.clone(), reason),
        })?
    };
    match &args.output {
        Some(path) => write(path, &done.page)?,
        None => print(&done.page)?,
    }
    remark(&done.remarks);
    if done.differs { Err(Failure::Differs) } else { Ok(()) }
}

fn layout(command: layout::LayoutCommand) -> Result<(), Failure> {
    let done = layout::run(command).map_err(Failure::Layout)?;
    match &done.output {
        Some(path) => write(path, &done.text)?,
        None => print(&done.text)?,
    }
    remark(&done.remarks);
    if done.differs { Err(Failure::Differs) } else { Ok(()) }
}

fn line(command: &line::LineCommand) -> Result<(), Failure> {
    let done = line::run(command);
    if let Some(line::Folder { path, files }) = &done.folder {
        atc_files::write_folder(path, files).map_err(|error| Failure::Write(path.clone(), error))?;
    }
    print(&done.text)?;
    remark(&done.remarks);
    if done.code == 0 { Ok(()) } else { Err(Failure::Told(done.code)) }
}

fn calibrate(args: &position::CalibrateArgs) -> Result<(), Failure> {
    let done = position::calibrate(args, &read(&args.levels)?).map_err(|wrong| match wrong {
        position::Wrong::Levels(reason) => Failure::Signal(reason),
        position::Wrong::Asked(reason) => Failure::Asked(reason),
    })?;
    // All of it is made before anything is written.
    for (path, text) in [(&args.output, &done.table), (&args.svg, &done.svg)] {
        path.as_ref().zip(text.as_ref()).map_or(Ok(()), |(path, text)| write(path, text))?;
    }
    print(&done.text)
}

fn read(path: &Path) -> Result<String, Failure> {
    let text = if path == Path::new("-") {
        let mut text = String::new();
        io::stdin().lock().read_to_string(&mut text).map(|_| text)
    } else {
        fs::read_to_string(path)
    };
    text.map_err(|error| Failure::Read(path.to_owned(), error))
}

/// Writes a file, never half of it.
fn write(path: &Path, text: &str) -> Result<(), Failure> {
    atc_files::write(path, text.as_bytes()).map_err(|error| Failure::Write(path.to_owned(), error))
}

/// Says something on standard error. Nobody may be listening.
fn remark(text: &str) {
    drop(io::stderr().write_all(text.as_bytes()));
}

fn print(text: &str) -> Result<(), Failure> {
    match io::stdout().lock().write_all(text.as_bytes()) {
        Err(error) if error.kind() != io::ErrorKind::BrokenPipe => Err(Failure::Write("standard output".into(), error)),
        _ => Ok(()),
    }
}
