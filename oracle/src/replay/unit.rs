//! A unit of work: the sessions that begin in a piece of a log.

use std::fs::File;
use std::io::{self, Read, Seek as _, SeekFrom};
use std::sync::atomic::{AtomicU64, Ordering};

use crate::conform::play::Judge;
use crate::conform::random::Random;
use atc_protocol::machine::{KINDS, Kind};

use super::lines::{Line, Lines, is_start};
use super::logs::{Form, Log, Unit};
use super::rows::Rows;
use super::session::{Begun, FirstFound, Play, Why, before};

/// How a log is read.
#[derive(Clone, Copy)]
pub(super) struct Setting<'a> {
    pub(super) judge: Judge<'a>,
    /// So many sessions of so many.
    pub(super) sample: (u64, u64),
    pub(super) seed: u64,
    /// The most first differences that are kept.
    pub(super) most: usize,
    /// What is done, for those who watch.
    pub(super) watched: &'a Watched,
}

/// What is done so far.
#[derive(Debug, Default)]
pub(super) struct Watched {
    pub(super) bytes: AtomicU64,
    pub(super) steps: AtomicU64,
    pub(super) files: AtomicU64,
}

/// How many lines are read before those who watch hear of them.
const OFTEN: u64 = 4096;

/// What became of the sessions of one machine.
#[derive(Clone, Debug, Default)]
pub(super) struct Tally {
    pub(super) sessions: u64,
    pub(super) agree: u64,
    pub(super) differ: u64,
    pub(super) unfinished: u64,
    pub(super) skipped: u64,
    pub(super) same: u64,
    pub(super) differing: u64,
    pub(super) known: std::collections::BTreeSet<usize>,
}

/// A session that differs.
#[derive(Clone, Debug)]
pub(super) struct Differs {
    /// The first byte of its start, and the number of that line.
    pub(super) offset: u64,
    pub(super) line: u64,
    pub(super) machine: &'static str,
    pub(super) differing: u64,
    pub(super) first: FirstFound,
}

/// A place from which on a log was not read, up to the next start.
#[derive(Clone, Debug)]
pub(super) struct Stuck {
    pub(super) offset: u64,
    pub(super) line: u64,
    pub(super) why: Why,
    /// How many lines were passed over behind it.
    pub(super) passed: u64,
}

/// What a unit comes to.
#[derive(Clone, Debug, Default)]
pub(super) struct Done {
    /// By the place of the machine in [`KINDS`].
    pub(super) machines: Vec<Tally>,
    pub(super) differs: Vec<Differs>,
    pub(super) stuck: Vec<Stuck>,
    /// How many there are, kept or not.
    pub(super) all_stuck: u64,
    /// Sessions that the sample leaves out.
    pub(super) left_out: u64,
    /// Sessions that end with their file, without a stop.
    pub(super) open: u64,
    /// The number of bytes of these sessions.
    pub(super) bytes: u64,
}

/// The most places that are kept of what was not read; all are counted.
pub(super) const MOST_STUCK: usize = 1000;

/// What is done with the lines at hand.
enum Now {
    /// Nothing has begun in this unit yet.
    Before,
    Playing(Box<Play>),
    /// They are passed over: they are of no session that is compared.
    Passing,
    /// They are passed over and counted.
    Stuck(Stuck),
}

pub(super) struct Reader<'a> {
    setting: Setting<'a>,
    /// What is read. Its name draws the sample.
    log: &'a Log,
    now: Now,
    /// Where the session at hand began.
    session: (u64, u64),
    done: Done,
    /// Where the first of these lines begins that are of this unit.
    from: Option<u64>,
    /// What those who watch have heard of: bytes and steps.
    told: (u64, u64),
}

/// Reads a unit.
///
/// # Errors
/// If the log cannot be read.
pub(super) fn read(log: &Log, unit: Unit, setting: Setting<'_>) -> io::Result<Done> {
    let Some(path) = &log.path else { return lines(Lines::new(io::stdin().lock(), 0), log, unit, setting) };
    let mut file = File::open(path)?;
    if log.form == Form::Parquet {
        return match Rows::open(file) {
            Ok(rows) => {
                let of_one = rows.lines_of_a_row();
                lines(Lines::of_rows(rows, 0, of_one), log, unit, setting)
            }
            Err(error) => {
                let mut reader = Reader::new(log, setting);
                reader.breaks_off(Line { offset: 0, end: 0, number: 0, text: None, ended: false }, &error);
                Ok(reader.done(0))
            }
        };
    }
    if unit.begin == 0 {
        return lines(Lines::new(file, 0), log, unit, setting);
    }
    // The line that the byte before is in belongs to the unit before.
    file.seek(SeekFrom::Start(unit.begin - 1))?;
    let mut all = Lines::new(file, unit.begin - 1);
    all.next()?;
    lines(all, log, unit, setting)
}

fn lines<R: Read>(mut all: Lines<R>, log: &Log, unit: Unit, setting: Setting<'_>) -> io::Result<Done> {
    let mut reader = Reader::new(log, setting);
    let (mut count, mut at, mut number) = (0_u64, 0, 0);
    loop {
        let line = match all.next() {
            Ok(Some(line)) => line,
            Ok(None) => break,
            // A page is damaged. What stands before it is read; there is no other unit of this log.
            Err(error) if log.form == Form::Parquet => {
                let line = Line { offset: at, end: at, number: number + 1, text: None, ended: false };
                reader.breaks_off(line, &error);
                return Ok(reader.done(at));
            }
            Err(error) => return Err(error),
        };
        count += 1;
        number = line.number;
        // What goes on beyond the unit is read up to the next start.
        let beyond = line.offset >= unit.end;
        if line.text.is_some_and(is_start) {
            reader.close(false, line);
            if beyond {
                return Ok(reader.done(line.offset));
            }
            reader.begin(line);
        } else if !matches!(reader.now, Now::Before) {
            reader.line(line);
        } else if unit.begin == 0 {
            reader.stray(line);
        } else if beyond {
            // Of sessions that began before.
            return Ok(reader.done(line.offset));
        }
        at = line.end;
        if count.is_multiple_of(OFTEN) {
            reader.tell(at);
        }
    }
    let last = Line { offset: at, end: at, number, text: Some(b""), ended: false };
    if unit.begin == 0 && matches!(reader.now, Now::Before) {
        let what = if at == 0 { "the file is empty" } else { "there is no session in the file" };
        reader.stick(Line { number: 0, ..last }, format!(r#"{what}; a session begins with {{"start":{{…}}}}"#).into());
    }
    reader.close(true, last);
    Ok(reader.done(at))
}

impl<'a> Reader<'a> {
    pub(super) fn new(log: &'a Log, setting: Setting<'a>) -> Self {
        let done = Done { machines: vec![Tally::default(); KINDS.len()], ..Done::default() };
        Self { setting, log, now: Now::Before, session: (0, 0), done, from: None, told: (0, 0) }
    }

    fn of(&mut self, kind: &Kind) -> &mut Tally {
        let place = KINDS.iter().position(|other| other.name == kind.name).unwrap_or(0);
        &mut self.done.machines[place]
    }

    /// Whether the sample has the session that begins here.
    fn is_drawn(&self, offset: u64) -> bool {
        let (some, of) = self.setting.sample;
        some >= of || Random::of(self.setting.seed, &self.log.below, offset).number() % of < some
    }

    pub(super) fn begin(&mut self, line: Line<'_>) {
        self.session = (line.offset, line.number);
        self.from.get_or_insert(line.offset);
        if !self.is_drawn(line.offset) {
            self.done.left_out += 1;
            self.now = Now::Passing;
            return;
        }
        match Play::begin(&line, self.setting.judge) {
            Ok(Begun::Session(play)) => {
                self.of(play.kind()).sessions += 1;
                self.now = Now::Playing(play);
            }
            Ok(Begun::Skipped(kind)) => {
                self.of(kind).skipped += 1;
                self.now = Now::Passing;
            }
            Err(why) => self.stick(line, why),
        }
    }

    /// A line before the first start of a file.
    fn stray(&mut self, line: Line<'_>) {
        if let Some(why) = before(&line) {
            self.stick(line, why);
        }
    }

    fn stick(&mut self, line: Line<'_>, why: Why) {
        self.from.get_or_insert(line.offset);
        self.now = Now::Stuck(Stuck { offset: line.offset, line: line.number, why, passed: 0 });
    }

    pub(super) fn line(&mut self, line: Line<'_>) {
        match &mut self.now {
            Now::Before | Now::Passing => {}
            Now::Stuck(stuck) => stuck.passed += 1,
            Now::Playing(play) => {
                if let Err(why) = play.line(&line, self.setting.judge) {
                    let Now::Playing(play) = std::mem::replace(&mut self.now, Now::Passing) else { return };
                    self.count(*play, false);
                    self.stick(line, why);
                }
            }
        }
    }

    /// Nothing more can be read, from this row on.
    fn breaks_off(&mut self, line: Line<'_>, error: &io::Error) {
        match std::mem::replace(&mut self.now, Now::Before) {
            Now::Before | Now::Passing => {}
            Now::Stuck(stuck) => self.stuck(stuck),
            Now::Playing(play) => self.count(*play, false),
        }
        let what = if line.number == 0 { error.to_string() } else { format!("reading breaks off: {error}") };
        self.stick(line, what.into());
        self.close(true, line);
    }

    /// The session at hand is over: the next one begins with this line, or the file ends here.
    pub(super) fn close(&mut self, ends: bool, line: Line<'_>) {
        match std::mem::replace(&mut self.now, Now::Before) {
            Now::Before | Now::Passing => {}
            Now::Stuck(stuck) => self.stuck(stuck),
            Now::Playing(play) => match play.end(ends) {
                Ok(()) => {
                    self.done.open += u64::from(!play.is_ended());
                    self.count(*play, true);
                }
                Err(why) => {
                    self.count(*play, false);
                    // With the place of its session: two of them at one line would not be told apart.
                    self.stuck(Stuck { offset: self.session.0, line: line.number, why, passed: 0 });
                }
            },
        }
    }

    fn stuck(&mut self, stuck: Stuck) {
        self.done.all_stuck += 1;
        if self.done.stuck.len() < MOST_STUCK {
            self.done.stuck.push(stuck);
        }
    }

    /// Counts a session; `whole`, if it could be read to its end.
    fn count(&mut self, play: Play, whole: bool) {
        let (offset, line) = self.session;
        let kind = play.kind();
        let tally = self.of(kind);
        let differs = play.first.is_some();
        tally.differ += u64::from(differs);
        tally.agree += u64::from(whole && !differs);
        tally.unfinished += u64::from(!whole && !differs);
        tally.same += play.same;
        tally.differing += play.differing;
        tally.known.extend(&play.agreed.known);
        if let Some(first) = play.first
            && self.done.differs.len() < self.setting.most
        {
            let (machine, differing) = (kind.name, play.differing);
            self.done.differs.push(Differs { offset, line, machine, differing, first });
        }
    }
    /// Tells those who watch what is new, up to this place in the log.
    fn tell(&mut self, at: u64) {
        let counted: u64 = self.done.machines.iter().map(|tally| tally.same + tally.differing).sum();
        let playing = match &self.now {
            Now::Playing(play) => play.same + play.differing,
            _ => 0,
        };
        let read = match self.log.form {
            Form::Lines => at - self.from.unwrap_or(at),
            // Its bytes are not those of its lines: they are counted at its end.
            Form::Parquet => self.told.0,
        };
        let now = (read, counted + playing);
        self.setting.watched.bytes.fetch_add(now.0 - self.told.0, Ordering::Relaxed);
        self.setting.watched.steps.fetch_add(now.1 - self.told.1, Ordering::Relaxed);
        self.told = now;
    }

    pub(super) fn done(mut self, at: u64) -> Done {
        self.tell(at);
        if self.log.form == Form::Parquet {
            self.told.0 = self.log.length.unwrap_or(0);
            self.setting.watched.bytes.fetch_add(self.told.0, Ordering::Relaxed);
        }
        self.done.bytes = self.told.0;
        self.done
    }
}
