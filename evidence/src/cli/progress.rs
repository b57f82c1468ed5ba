//! What runs, what is left, and about how long it will take: a line on a terminal, or one every quarter of a minute where
//! there is none.

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::collections::{BTreeMap, BTreeSet};
use std::io::{IsTerminal, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

/// How often a line is printed where there is no terminal.
const PLAIN: Duration = Duration::from_secs(15);
/// And how often the line changes on a terminal.
const TERMINAL: Duration = Duration::from_secs(1);
/// For so many seconds the forecast rests on the costs rather than on what has been seen: while a kernel with many mutants is compiled, or the
/// tests run beside the proofs, what has been done is not seen yet.
const TRUST: f64 = 120.0;
/// How many items are named.
const NAMED: usize = 3;
/// The programs that are named where no item is.
const TOOLS: [&str; 7] = ["rustc", "wasm2c", "goto-cc", "cbmc", "kissat", "z3", "spin"];

/// A phase that is to come: its name, and its items with about how many seconds of a processor each takes.
#[derive(Clone, Debug, Default)]
pub struct Work {
    /// Its name.
    pub name: String,
    /// Its items.
    pub items: Vec<(String, f64)>,
}

/// The progress of a run.
#[derive(Debug)]
pub struct Progress {
    start: Instant,
    jobs: f64,
    bar: Option<ProgressBar>,
    state: Mutex<State>,
}

#[derive(Debug, Default)]
struct State {
    phases: Vec<Work>,
    current: Option<usize>,
    done: BTreeSet<String>,
    done_cost: f64,
    running: Option<String>,
    log: Option<PathBuf>,
    printed: Option<Instant>,
}

impl Progress {
    /// Of a run with these phases, so many items at a time. To the terminal, if the errors go to one.
    pub fn new(phases: Vec<Work>, jobs: usize) -> Self {
        let bar = std::io::stderr().is_terminal().then(|| {
            let bar = ProgressBar::with_draw_target(None, ProgressDrawTarget::stderr());
            let style = ProgressStyle::with_template("{spinner} {wide_msg}");
            bar.with_style(style.unwrap_or_else(|_| ProgressStyle::default_spinner()))
        });
        let state = Mutex::new(State { phases, ..State::default() });
        let jobs = f64::from(u32::try_from(jobs).unwrap_or(1).max(1));
        Self { start: Instant::now(), jobs, bar, state }
    }

    fn lock(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// The phase of this name begins.
    pub fn begin(&self, name: &str) {
        let mut state = self.lock();
        let place = state.phases.iter().position(|phase| phase.name == name);
        let place = place.unwrap_or_else(|| {
            state.phases.push(Work { name: name.to_owned(), items: Vec::new() });
            state.phases.len() - 1
        });
        state.current = Some(place);
        state.done.clear();
        (state.running, state.log, state.printed) = (None, None, None);
        drop(state);
        self.tick();
    }

    /// The item that runs now, where it is known.
    pub fn running(&self, item: &str) {
        self.lock().running = Some(item.to_owned());
    }

    /// The log that a program writes now: it says what runs.
    pub fn watch(&self, log: &Path) {
        self.lock().log = Some(log.to_path_buf());
    }

    /// An item has a result.
    pub fn done(&self, item: &str) {
        let mut state = self.lock();
        let found = state.current.and_then(|place| state.phases.get(place));
        let cost = found.and_then(|phase| phase.items.iter().find(|(name, _)| name == item)).map_or(0.0, |one| one.1);
        if state.done.insert(item.to_owned()) {
            state.done_cost += cost;
        }
    }

    /// The phase is over, whatever was done of it.
    pub fn end(&self) {
        let mut state = self.lock();
        if let Some(phase) = state.current.take().and_then(|place| state.phases.get(place).cloned()) {
            let rest = phase.items.iter().filter(|(name, _)| !state.done.contains(name)).map(|(_, cost)| cost);
            state.done_cost += rest.sum::<f64>();
            state.phases.retain(|one| one.name != phase.name);
        }
        state.done.clear();
    }

    /// Shows the line if it is due.
    pub fn tick(&self) {
        let every = if self.bar.is_some() { TERMINAL } else { PLAIN };
        let due = {
            let mut state = self.lock();
            let due = state.current.is_some() && state.printed.is_none_or(|printed| printed.elapsed() >= every);
            if due {
                state.printed = Some(Instant::now());
            }
            due
        };
        match &self.bar {
            Some(bar) => {
                if due {
                    bar.set_message(self.line(self.start.elapsed()));
                }
                bar.tick();
            }
            // Nobody may be listening.
            None if due => drop(writeln!(std::io::stderr(), "{}", self.line(self.start.elapsed()))),
            None => {}
        }
    }

    /// Takes the line from the terminal.
    pub fn finish(&self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
    }

    /// `proofs 41/128 · 3 m 10 s so far · about 6 m left · now t_ilk_4, t_per_7`
    pub fn line(&self, elapsed: Duration) -> String {
        let state = self.lock();
        let mut text = match state.current.and_then(|place| state.phases.get(place)) {
            Some(phase) if phase.items.len() > 1 => {
                let done = phase.items.iter().filter(|(name, _)| state.done.contains(name)).count();
                format!("{} {done}/{}", phase.name, phase.items.len())
            }
            Some(phase) => phase.name.clone(),
            None => "between two phases".to_owned(),
        };
        text = format!("{text} · {} so far · {}", span(elapsed), left(&state, elapsed, self.jobs));
        let now = now(&state);
        if now.is_empty() { text } else { format!("{text} · now {}", now.join(", ")) }
    }
}

/// About how long the rest takes, at the speed that was seen so far.
fn left(state: &State, elapsed: Duration, jobs: f64) -> String {
    let rest: f64 = state.phases.iter().flat_map(|phase| &phase.items).map(|(_, cost)| cost).sum();
    let here = state.current.and_then(|place| state.phases.get(place));
    let done = here.map_or(0.0, |phase| {
        phase.items.iter().filter(|(name, _)| state.done.contains(name)).map(|(_, cost)| cost).sum()
    });
    let speed = (state.done_cost + TRUST * jobs) / (elapsed.as_secs_f64() + TRUST);
    let seconds = (rest - done).max(0.0) / speed.max(0.001);
    let rounded = if seconds < 90.0 { (seconds / 10.0).ceil() * 10.0 } else { (seconds / 60.0).round() * 60.0 };
    format!("about {} left", span(Duration::try_from_secs_f64(rounded).unwrap_or_default()))
}

/// `3 m 10 s`
pub fn span(time: Duration) -> String {
    match (time.as_secs() / 60, time.as_secs() % 60) {
        (0, seconds) => format!("{seconds} s"),
        (minutes, 0) => format!("{minutes} m"),
        (minutes, seconds) => format!("{minutes} m {seconds} s"),
    }
}

/// What runs now: what was said, what the log says, or what the programs that run are about.
fn now(state: &State) -> Vec<String> {
    if let Some(log) = &state.log {
        return last_of(log).into_iter().collect();
    }
    if let Some(running) = &state.running {
        return vec![running.clone()];
    }
    let items = state.current.and_then(|place| state.phases.get(place)).map(|phase| phase.items.as_slice());
    let items = items.unwrap_or_default().iter().map(|(name, _)| name.as_str());
    let pending: BTreeSet<_> = items.filter(|name| !state.done.contains(*name)).collect();
    let mut found: Vec<_> = pending.iter().filter(|_| pending.len() <= NAMED).map(ToString::to_string).collect();
    if found.is_empty() {
        found = in_programs(&pending).into_iter().take(NAMED).collect();
    }
    if found.is_empty() {
        // What is common to many items, such as the compilation of the kernel.
        found = in_programs(&TOOLS.into()).into_iter().collect();
    }
    found
}

/// What Cargo or a test harness names last in its log.
fn last_of(log: &Path) -> Option<String> {
    let text = String::from_utf8_lossy(&std::fs::read(log).ok()?).into_owned();
    let word = |line: &str| -> Option<String> {
        let line = line.trim();
        let (what, rest) = line.split_once(' ')?;
        let name = rest.split(" (").next().unwrap_or(rest);
        match what {
            "Compiling" | "Checking" => Some(format!("compiling {}", name.split(" v").next().unwrap_or(name))),
            "Running" | "Doc-tests" => Some(format!("running {name}")),
            "Blocking" => Some("waiting for another Cargo".to_owned()),
            _ => None,
        }
    };
    text.lines().rev().find_map(word)
}

/// Those of these names that stand in the command lines of programs below this one. Linux only: elsewhere none is known.
fn in_programs(names: &BTreeSet<&str>) -> BTreeSet<String> {
    let mut parents: BTreeMap<u32, u32> = BTreeMap::new();
    for entry in std::fs::read_dir("/proc").into_iter().flatten().flatten() {
        let Some(id) = entry.file_name().to_str().and_then(|name| name.parse::<u32>().ok()) else { continue };
        let stat = std::fs::read_to_string(entry.path().join("stat")).unwrap_or_default();
        // The name is in brackets and may have spaces.
        let parent = stat.rsplit_once(") ").and_then(|(_, rest)| rest.split(' ').nth(1)?.parse().ok());
        parents.extend(parent.map(|parent| (id, parent)));
    }
    let me = std::process::id();
    let is_mine = |mut id: u32| {
        for _ in 0..32 {
            match parents.get(&id) {
                Some(parent) if *parent == me => return true,
                Some(parent) => id = *parent,
                None => return false,
            }
        }
        false
    };
    let mut found = BTreeSet::new();
    for id in parents.keys().filter(|id| is_mine(**id)) {
        let line = std::fs::read(format!("/proc/{id}/cmdline")).unwrap_or_default();
        let line = String::from_utf8_lossy(&line).into_owned();
        let words = line.split(['\0', '/', ' ', '=', ',', '.', ':']);
        found.extend(words.filter(|word| names.contains(word)).map(ToOwned::to_owned));
    }
    found
}

#[cfg(test)]
#[path = "progress_tests.rs"]
mod tests;
