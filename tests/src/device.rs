//! What a timing chart is checked against: the kernel itself, and a process that speaks the oracle's protocol.

use std::fmt;
use std::io::{BufRead as _, BufReader, Write as _};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::sync::OnceLock;

use atc_kernel::aspect::{AspectSet, Display, MAX_ASPECTS, State, Times, step};
use atc_protocol::Kmh;
use atc_protocol::machine::aspect::Config;
use serde_json::{Value, json};

/// The kernel's displays for these detections, a logic cycle each, from the initial state.
///
/// # Panics
/// If the kernel reaches a state that is not valid.
pub fn kernel(times: Times, detections: &[AspectSet]) -> Vec<Display> {
    let mut state = State::<MAX_ASPECTS>::INITIAL;
    let displays = detections.iter().map(|detected| {
        let (next, display) = step(times, state, *detected);
        assert!(next.is_valid(times), "the kernel reached an invalid state: {next:?}");
        state = next;
        display
    });
    displays.collect()
}

/// What a process said that it should not have.
#[derive(Debug)]
pub struct Refused(pub String);

impl fmt::Display for Refused {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

/// The displays of a process that speaks protocol 1, as permitted speeds.
///
/// # Errors
/// If the process cannot be run, or answers a request other than with its started or output reply.
pub fn process(program: &Path, config: &Config, detections: &[AspectSet]) -> Result<Vec<Option<Kmh>>, Refused> {
    let mut requests = vec![json!({"start": {"protocol": 1, "machine": "aspect-acceptance", "config": config}})];
    requests.extend(detections.iter().map(|detected| json!({"step": {"detected_km_h": speeds(config, *detected)}})));
    let lines: Vec<String> = requests.iter().map(|request| format!("{request}\n")).collect();
    let replies = converse(program, lines.concat().into_bytes()).map_err(|error| Refused(error.to_string()))?;
    let mut replies = replies.iter().zip(&lines).map(|(reply, request)| (reply.as_str(), request.trim_end()));
    match replies.next() {
        Some((reply, _)) if reply.starts_with("{\"started\"") => {}
        other => return Err(Refused(format!("the start was answered by {other:?}"))),
    }
    let displays: Vec<_> = replies
        .map(|(reply, request)| {
            let display = serde_json::from_str::<Value>(reply).ok().and_then(|reply| {
                let display = reply.get("output")?.get("display_km_h")?.clone();
                if display.is_null() { Some(None) } else { Kmh::parse(&display.to_string()).ok().map(Some) }
            });
            display.ok_or_else(|| Refused(format!("{request} was answered by {reply}")))
        })
        .collect::<Result<_, _>>()?;
    if displays.len() == detections.len() {
        Ok(displays)
    } else {
        Err(Refused(format!("{} steps were answered by {} outputs", detections.len(), displays.len())))
    }
}

/// The speeds of a set, the lowest first.
pub fn speeds(config: &Config, detected: AspectSet) -> Vec<Kmh> {
    let named = config.aspects_km_h.iter().enumerate().filter(|(rank, _)| detected.bits() >> rank & 1 == 1);
    named.map(|(_, speed)| *speed).collect()
}

/// Writes `input` to a new process, closes its input, and returns the lines of its output.
///
/// # Errors
/// If the process cannot be started or read, or ends with another exit code than 0.
pub fn converse(program: &Path, input: Vec<u8>) -> std::io::Result<Vec<String>> {
    let mut child = serving(program)?;
    let mut stdin = child.stdin.take().ok_or_else(|| std::io::Error::other("no standard input"))?;
    // In a thread of its own: both pipes may be full.
    let writer = std::thread::spawn(move || stdin.write_all(&input));
    let stdout = child.stdout.take().ok_or_else(|| std::io::Error::other("no standard output"))?;
    let lines = BufReader::new(stdout).lines().collect::<Result<Vec<_>, _>>()?;
    writer.join().map_err(|_| std::io::Error::other("the writer panicked"))??;
    let status = child.wait()?;
    if status.success() { Ok(lines) } else { Err(std::io::Error::other(format!("the process ended with {status}"))) }
}

/// `program serve` with pipes on its standard input and output.
///
/// # Errors
/// If the process cannot be started.
pub fn serving(program: &Path) -> std::io::Result<Child> {
    Command::new(program).arg("serve").stdin(Stdio::piped()).stdout(Stdio::piped()).spawn()
}

/// The device under test: the oracle, built if need be; or, if the environment variable `ATC_DEVICE` names a
/// program, that: `ATC_DEVICE=my-device cargo test -p atc-tests --test figures` runs the charts against it.
///
/// # Panics
/// If the oracle does not build.
pub fn device() -> PathBuf {
    std::env::var_os("ATC_DEVICE").map_or_else(|| oracle().to_owned(), PathBuf::from)
}

/// The binary of the oracle, built once, with the profile of this build.
///
/// # Panics
/// If it does not build.
pub fn oracle() -> &'static Path {
    static ORACLE: OnceLock<PathBuf> = OnceLock::new();
    ORACLE.get_or_init(|| built().unwrap_or_else(|error| panic!("the oracle does not build: {error}")))
}

/// The oracle as `cargo test --workspace` builds it: with a test among what is asked for the features are the same, and nothing is
/// compiled a second time.
fn built() -> Result<PathBuf, Box<dyn std::error::Error>> {
    let manifest = concat!(env!("CARGO_MANIFEST_DIR"), "/../Cargo.toml");
    let build = escargot::CargoBuild::new().manifest_path(manifest);
    let build = build.args(["--workspace", "--bin", "oracle", "--test", "contracts"]);
    let build = if cfg!(debug_assertions) { build } else { build.release() };
    for message in build.exec()? {
        let message = message?;
        if let escargot::format::Message::CompilerArtifact(artifact) = message.decode()?
            && artifact.target.name == "oracle"
            && let Some(program) = artifact.executable
        {
            return Ok(program.into_owned());
        }
    }
    Err("cargo names no program".into())
}
