//! A run: units of work over threads, and what they come to put together in the order of the logs.

use std::collections::{BTreeMap, BTreeSet};
use std::fs::File;
use std::io::{self, BufRead as _, BufReader, Read as _};
use std::sync::atomic::Ordering;
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::sync::{Mutex, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

use memchr::memchr_iter;

use super::explain::explain;
use super::logs::{Log, Logs, Unit, Units};
use super::report::{Differing, FORM, Input, OfMachine, Report, Shard, Unread};
use super::unit::{self, Differs, Done, MOST_STUCK, Setting, Stuck, Tally, Watched};
use crate::conform::fields::Level;
use crate::conform::play::Judge;
use crate::conform::profile::Profile;
use atc_protocol::machine::KINDS;

/// What is asked for.
#[derive(Clone, Debug)]
pub struct Options {
    /// How much of a reply is compared.
    pub level: Level,
    /// What is known and what is left out.
    pub profile: Profile,
    /// So many sessions of so many are compared.
    pub sample: (u64, u64),
    /// The seed of the sample.
    pub seed: u64,
    /// Which part of the logs, from 1, of how many.
    pub shard: Option<(u64, u64)>,
    /// The most first differences that are told.
    pub differences: usize,
    /// How many threads.
    pub jobs: usize,
    /// The most bytes that a thread takes at once.
    pub unit: u64,
    /// How often progress is told.
    pub every: Duration,
}

/// How far a run is.
#[derive(Clone, Copy, Debug)]
pub struct Progress {
    /// How many files are begun, of how many.
    pub files: (u64, u64),
    /// How many bytes are read; of how many, if that is known.
    pub bytes: (u64, Option<u64>),
    /// How many steps were compared.
    pub steps: u64,
    /// How long it has taken.
    pub took: Duration,
}

/// How many bytes a thread takes at once, where nothing else is said.
pub const UNIT: u64 = 32 << 20;

/// A place: the log and the byte in it.
type Place = (usize, u64);

/// What the units have come to.
#[derive(Default)]
struct All {
    machines: Vec<Tally>,
    differs: BTreeMap<Place, (u64, Differs)>,
    stuck: BTreeMap<(Place, u64), (u64, Stuck)>,
    places: u64,
    left_out: u64,
    open: u64,
    bytes: u64,
    failed: BTreeMap<Place, String>,
}

/// Compares. `progress` hears of it now and then.
pub fn run(logs: &Logs, options: &Options, mut progress: impl FnMut(&Progress)) -> Report {
    let began = std::time::SystemTime::now().duration_since(std::time::UNIX_EPOCH);
    let since = Instant::now();
    let (index, of) = options.shard.unwrap_or((1, 1));
    let share = logs.share(index, of);
    let units = Mutex::new(Units::new(&logs.files, share, options.unit));
    let all = Mutex::new(All { machines: vec![Tally::default(); KINDS.len()], ..All::default() });
    let watched = Watched::default();
    let judge = Judge { level: options.level, profile: &options.profile };
    let (sample, seed, most) = (options.sample, options.seed, options.differences);
    let setting = Setting { judge, sample, seed, most, watched: &watched };
    let streams = logs.files.iter().any(|log| log.length.is_none());
    let due = (!streams).then(|| share.1.min(logs.bytes()).saturating_sub(share.0));
    thread::scope(|scope| {
        let (working, ended) = channel::<()>();
        for _ in 0..options.jobs.max(1) {
            let working = working.clone();
            let (units, all) = (&units, &all);
            scope.spawn(move || {
                loop {
                    let unit = units.lock().unwrap_or_else(PoisonError::into_inner).next();
                    let Some(unit) = unit else { break };
                    setting.watched.files.fetch_max(unit.log as u64 + 1, Ordering::Relaxed);
                    let done = unit::read(&logs.files[unit.log], unit, setting);
                    all.lock().unwrap_or_else(PoisonError::into_inner).add(unit, done, most);
                }
                drop(working);
            });
        }
        drop(working);
        while let Err(RecvTimeoutError::Timeout) = ended.recv_timeout(options.every) {
            progress(&Progress {
                files: (watched.files.load(Ordering::Relaxed), logs.files.len() as u64),
                bytes: (watched.bytes.load(Ordering::Relaxed), due),
                steps: watched.steps.load(Ordering::Relaxed),
                took: since.elapsed(),
            });
        }
    });
    let all = all.into_inner().unwrap_or_else(PoisonError::into_inner);
    let mut report = all.report(logs, options, index);
    report.began = began.map_or(0, |since| since.as_secs());
    report.seconds = since.elapsed().as_secs_f64();
    report.judge();
    report
}

impl All {
    fn add(&mut self, unit: Unit, done: io::Result<Done>, most: usize) {
        let done = match done {
            Ok(done) => done,
            Err(error) => {
                self.failed.insert((unit.log, unit.begin), error.to_string());
                return;
            }
        };
        for (all, one) in self.machines.iter_mut().zip(&done.machines) {
            all.add(one);
        }
        let place = |offset| (unit.log, offset);
        self.differs.extend(done.differs.into_iter().map(|one| (place(one.offset), (unit.begin, one))));
        while self.differs.len() > most {
            self.differs.pop_last();
        }
        // A session that goes wrong at its end, and lines behind it: two places.
        self.stuck.extend(done.stuck.into_iter().map(|one| ((place(one.offset), one.line), (unit.begin, one))));
        while self.stuck.len() > MOST_STUCK {
            self.stuck.pop_last();
        }
        self.places += done.all_stuck;
        self.left_out += done.left_out;
        self.open += done.open;
        self.bytes += done.bytes;
    }

    fn report(self, logs: &Logs, options: &Options, index: u64) -> Report {
        // Units that begin in the middle of a log count their lines from there.
        let begins = self.differs.iter().map(|(place, (begin, _))| (place.0, *begin));
        let begins: BTreeSet<Place> =
            begins.chain(self.stuck.iter().map(|((place, _), (begin, _))| (place.0, *begin))).collect();
        let before = lines_before(&logs.files, &begins);
        let line = |log: usize, begin: u64, line: u64| match before.get(&(log, begin)) {
            Some(before) if line > 0 => before + line,
            _ => line,
        };
        let mut unread = Vec::new();
        let mut unread_in_all = self.places + self.failed.len() as u64;
        // What is wrong with the names is wrong in each shard: it is told once.
        if index == 1 {
            unread_in_all += logs.unread.len() as u64;
            unread.extend(logs.unread.iter().cloned());
        }
        for ((log, begin), error) in &self.failed {
            let why = format!("reading breaks off (the sessions from byte {begin} on): {error}");
            unread.push(Unread::whole(logs.files[*log].name.clone(), why));
        }
        for (((log, _), _), (begin, stuck)) in self.stuck {
            unread.push(Unread {
                file: logs.files[log].name.clone(),
                line: line(log, begin, stuck.line),
                reason: stuck.why.what,
                about_line: stuck.why.about.map(|about| line(log, begin, about)),
                lines_passed_over: stuck.passed,
            });
        }
        let differences = self.differs.into_iter().map(|((log, offset), (begin, differs))| {
            let first = differs.first;
            let here = |number| line(log, begin, number);
            Differing {
                file: logs.files[log].name.clone(),
                offset,
                session_line: here(differs.line),
                request_line: here(first.lines.0),
                line: here(first.lines.1),
                machine: differs.machine.to_owned(),
                at: first.at.to_owned(),
                step: first.step,
                steps_that_differ: differs.differing,
                requirements: first
                    .fields
                    .first()
                    .map(|field| field.requirements.iter().map(|&id| id.to_owned()).collect())
                    .unwrap_or_default(),
                fields: first.fields,
                broken: first.broken,
                late_from_line: first.late.map(here),
                as_if: Vec::new(),
                session: Vec::new(),
            }
        });
        let mut differences: Vec<_> = differences.collect();
        explain(&mut differences, &logs.files, options.level);
        Report {
            form: FORM,
            oracle: env!("CARGO_PKG_VERSION").to_owned(),
            level: options.level,
            profile: options.profile.clone(),
            input: Input { files: logs.files.len() as u64, bytes: logs.bytes(), identity: logs.identity() },
            sample: format!("{}/{}", options.sample.0, options.sample.1),
            seed: options.seed,
            shard: options.shard.map(|(index, of)| Shard { index, of }),
            most_differences: options.differences as u64,
            began: 0,
            seconds: 0.0,
            agrees: false,
            bytes: self.bytes,
            left_out: self.left_out,
            without_stop: self.open,
            machines: KINDS
                .iter()
                .zip(&self.machines)
                .filter_map(|(kind, tally)| of_machine(kind.name, tally))
                .collect(),
            differences,
            unread_in_all,
            unread,
        }
    }
}

impl Tally {
    fn add(&mut self, other: &Self) {
        self.sessions += other.sessions;
        self.agree += other.agree;
        self.differ += other.differ;
        self.unfinished += other.unfinished;
        self.skipped += other.skipped;
        self.same += other.same;
        self.differing += other.differing;
        self.known.extend(&other.known);
    }
}

fn of_machine(name: &str, tally: &Tally) -> Option<OfMachine> {
    let there = tally.sessions + tally.skipped > 0;
    there.then(|| OfMachine {
        machine: name.to_owned(),
        // Set by the report: it hangs on all of it.
        verdict: crate::conform::report::Word::NotCompared,
        note: None,
        sessions: tally.sessions,
        agree: tally.agree,
        differ: tally.differ,
        unfinished: tally.unfinished,
        skipped: tally.skipped,
        steps: tally.same,
        steps_that_differ: tally.differing,
        known: tally.known.iter().map(|place| *place as u64).collect(),
    })
}

/// How many lines of their logs end before the place where each of these units begins to read; 0 for the first unit of a log.
fn lines_before(logs: &[Log], begins: &BTreeSet<Place>) -> BTreeMap<Place, u64> {
    let mut before = BTreeMap::new();
    // The file at hand, and how far it is counted.
    let mut at: Option<(usize, BufReader<File>, u64, u64)> = None;
    for &(log, begin) in begins.iter().filter(|(_, begin)| *begin > 0) {
        if at.as_ref().is_none_or(|(other, ..)| *other != log) {
            let file = logs[log].path.as_ref().and_then(|path| File::open(path).ok());
            at = file.map(|file| (log, BufReader::with_capacity(1 << 20, file), 0, 0));
        }
        // What cannot be read any more has no numbers.
        let Some((_, file, place, lines)) = &mut at else { continue };
        // A unit reads from the byte before its first one on.
        let mut piece = file.take(begin - 1 - *place);
        while let Ok(bytes) = piece.fill_buf()
            && !bytes.is_empty()
        {
            *lines += memchr_iter(b'\n', bytes).count() as u64;
            let read = bytes.len();
            piece.consume(read);
        }
        *place = begin - 1;
        before.insert((log, begin), *lines);
    }
    before
}
