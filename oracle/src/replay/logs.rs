//! Which files are read, and how their bytes are shared out.
//!
//! All files stand in one row, in their order, and a place in that row is a number of bytes. A shard, and within it a unit of work, is a
//! piece of the row. A session belongs to the piece that its first byte is in, whole, however far it goes on.

use std::collections::HashSet;
use std::fs::{self, File};
use std::io;
use std::path::{Path, PathBuf};

use sha2::{Digest as _, Sha256};

use super::report::Unread;
use crate::conform::vector::hex;

/// The name that stands for standard input.
pub const STANDARD_INPUT: &str = "-";

/// A log.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Log {
    /// How it is called in reports: the path as it was given, and what is below it.
    pub name: String,
    /// Its path below the folder that was given; of a file that was given, its name. The same on every machine.
    pub below: String,
    /// Where it is; none for standard input.
    pub path: Option<PathBuf>,
    /// Its length in bytes; none if it is no plain file and cannot be read from the middle.
    pub length: Option<u64>,
    /// How it is written.
    pub form: Form,
}

/// How a log is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Form {
    /// JSON lines.
    Lines,
    /// Parquet: its rows are lines. It is read as a whole.
    Parquet,
}

/// The logs of a run, in their order.
#[derive(Clone, Debug, Default)]
pub struct Logs {
    /// The logs.
    pub files: Vec<Log>,
    /// What was named or found and cannot be read.
    pub unread: Vec<Unread>,
}

/// A piece of a log: the sessions that begin in it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Unit {
    /// The place of the log among the logs.
    pub(super) log: usize,
    /// Its first byte.
    pub(super) begin: u64,
    /// The byte behind its last one.
    pub(super) end: u64,
}

impl Logs {
    /// Finds the logs: files as they are named, and in folders and the folders below them whatever ends in `.jsonl` or `.parquet`, in
    /// the order of their names. What is packed is named as not read. A file that is found twice is read once.
    pub fn find(named: &[PathBuf]) -> Self {
        let (mut logs, mut seen) = (Self::default(), HashSet::new());
        for path in named {
            let name = path.to_string_lossy().into_owned();
            if name == STANDARD_INPUT {
                if seen.insert(path.clone()) {
                    logs.files.push(Log { below: name.clone(), name, path: None, length: None, form: Form::Lines });
                }
            } else if path.is_dir() {
                let before = (logs.files.len(), logs.unread.len());
                logs.folder(path, path, &mut seen);
                if before == (logs.files.len(), logs.unread.len()) {
                    logs.unread.push(Unread::whole(
                        name,
                        "there is no log (*.jsonl, *.parquet) in this folder that is not read already",
                    ));
                }
            } else {
                let below = path.file_name().unwrap_or(path.as_os_str()).to_string_lossy().into_owned();
                logs.file(path, name, below, &mut seen);
            }
        }
        logs
    }

    fn folder(&mut self, root: &Path, folder: &Path, seen: &mut HashSet<PathBuf>) {
        // A link may lead back to a folder above it.
        if !fs::canonicalize(folder).is_ok_and(|real| seen.insert(real)) {
            return;
        }
        let entries = fs::read_dir(folder).and_then(Iterator::collect::<io::Result<Vec<_>>>);
        let entries = match entries {
            Ok(entries) => entries,
            Err(error) => {
                let why = format!("the folder cannot be read: {error}");
                self.unread.push(Unread::whole(folder.to_string_lossy().into_owned(), why));
                return;
            }
        };
        let mut paths: Vec<_> = entries.iter().map(fs::DirEntry::path).collect();
        paths.sort();
        for path in paths {
            let name = path.to_string_lossy().into_owned();
            if path.is_dir() {
                self.folder(root, &path, seen);
            } else if ends(&name, ".jsonl") || ends(&name, PARQUET) || is_packed(&name) {
                let below = path.strip_prefix(root).unwrap_or(&path).to_string_lossy().into_owned();
                self.file(&path, name, below, seen);
            }
        }
    }

    fn file(&mut self, path: &Path, name: String, below: String, seen: &mut HashSet<PathBuf>) {
        if is_packed(&name) {
            self.unread.push(Unread::whole(
                name,
                "packed files are not read; unpack it, or give it by `zcat FILE | oracle replay -`",
            ));
            return;
        }
        let form = if ends(&name, PARQUET) { Form::Parquet } else { Form::Lines };
        let there = fs::metadata(path).and_then(|there| {
            // What may not be read is told now, and once.
            if there.is_file() {
                File::open(path)?;
            }
            Ok(there)
        });
        match there {
            Err(error) => self.unread.push(Unread::whole(name, format!("it cannot be read: {error}"))),
            Ok(there) => {
                if fs::canonicalize(path).is_ok_and(|real| seen.insert(real)) {
                    let length = there.is_file().then_some(there.len());
                    self.files.push(Log { name, below, path: Some(path.to_owned()), length, form });
                }
            }
        }
    }

    /// How many bytes the logs have, as far as that is known.
    pub fn bytes(&self) -> u64 {
        self.files.iter().filter_map(|log| log.length).sum()
    }

    /// The SHA-256 of the names and lengths of the logs, below what was given: two machines with the same logs have the same.
    pub fn identity(&self) -> String {
        let mut hash = Sha256::new();
        for log in &self.files {
            hash.update(log.below.as_bytes());
            hash.update([0]);
            hash.update(log.length.unwrap_or(u64::MAX).to_le_bytes());
        }
        hex(&hash.finalize())
    }

    /// The piece of the row that a shard has: shard `index`, from 1, of so many.
    pub(super) fn share(&self, index: u64, of: u64) -> (u64, u64) {
        let place = |number: u64| {
            let place = u128::from(self.bytes()) * u128::from(number) / u128::from(of.max(1));
            u64::try_from(place).unwrap_or(u64::MAX)
        };
        // The last one has what stands at the very end: logs without a byte.
        (place(index - 1), if index == of { u64::MAX } else { place(index) })
    }
}

/// The units of a share, in their order.
pub(super) struct Units<'a> {
    files: &'a [Log],
    share: (u64, u64),
    /// The most bytes of a unit.
    most: u64,
    log: usize,
    /// Where the log begins in the row, and how far it is shared out.
    at: u64,
    begin: u64,
}

impl<'a> Units<'a> {
    pub(super) fn new(files: &'a [Log], share: (u64, u64), most: u64) -> Self {
        Self { files, share, most: most.max(1), log: 0, at: 0, begin: 0 }
    }
}

impl Iterator for Units<'_> {
    type Item = Unit;

    fn next(&mut self) -> Option<Unit> {
        let (from, to) = self.share;
        loop {
            let log = self.files.get(self.log)?;
            let length = log.length.unwrap_or(0);
            // What is no plain file cannot be read from the middle, nor can Parquet: it is one unit.
            let whole = length == 0 || log.form == Form::Parquet;
            let unit = if whole {
                let here = self.begin == 0 && (from..to).contains(&self.at);
                here.then_some(Unit { log: self.log, begin: 0, end: u64::MAX })
            } else {
                let begin = self.begin.max(from.saturating_sub(self.at));
                let end = length.min(to.saturating_sub(self.at)).min(begin.saturating_add(self.most));
                (begin < end).then_some(Unit { log: self.log, begin, end })
            };
            match unit {
                Some(unit) if unit.end < length => {
                    self.begin = unit.end;
                    return Some(unit);
                }
                _ => {
                    self.log += 1;
                    self.at += length;
                    self.begin = 0;
                    if unit.is_some() {
                        return unit;
                    }
                }
            }
        }
    }
}

fn ends(name: &str, with: &str) -> bool {
    name.len() >= with.len()
        && name.is_char_boundary(name.len() - with.len())
        && name[name.len() - with.len()..].eq_ignore_ascii_case(with)
}

/// What is Parquet by its name.
const PARQUET: &str = ".parquet";

/// Whether a log was packed by a program for that.
fn is_packed(name: &str) -> bool {
    [".jsonl.gz", ".jsonl.zst", ".jsonl.xz", ".jsonl.bz2"].iter().any(|packed| ends(name, packed))
}

#[cfg(test)]
mod tests {
    use super::{Form, Log, Logs, Unit, Units};

    fn logs(lengths: &[u64], form: Form) -> Logs {
        let name = String::new;
        let log = |length: &u64| Log { name: name(), below: name(), path: None, length: Some(*length), form };
        Logs { files: lengths.iter().map(log).collect(), unread: Vec::new() }
    }

    /// Parquet is read by one shard, as a whole.
    #[test]
    fn what_cannot_be_shared_out_is_in_exactly_one_unit() {
        for lengths in [&[10_u64, 0, 7, 1, 0][..], &[0], &[1], &[0, 0, 100], &[33, 33, 34]] {
            let logs = logs(lengths, Form::Parquet);
            for of in 1..=9 {
                let shards = (1..=of).map(|index| logs.share(index, of));
                let units: Vec<Unit> = shards.flat_map(|share| Units::new(&logs.files, share, 3)).collect();
                let whole = |log| Unit { log, begin: 0, end: u64::MAX };
                assert_eq!(units, (0..lengths.len()).map(whole).collect::<Vec<_>>(), "{lengths:?}, {of} shards");
            }
        }
    }

    /// However many shards, and however large the units: every byte, and every log without a byte, is in exactly one.
    #[test]
    fn every_byte_is_in_exactly_one_unit() {
        for lengths in [&[10_u64, 0, 7, 1, 0][..], &[0], &[1], &[0, 0, 100], &[33, 33, 34]] {
            let logs = logs(lengths, Form::Lines);
            for of in 1..=9 {
                for most in [1, 3, 8, 1000] {
                    let shards = (1..=of).map(|index| logs.share(index, of));
                    let units: Vec<Unit> = shards.flat_map(|share| Units::new(&logs.files, share, most)).collect();
                    for (log, length) in lengths.iter().enumerate() {
                        let of_log: Vec<_> = units.iter().filter(|unit| unit.log == log).collect();
                        let mut at = 0;
                        for unit in &of_log {
                            assert_eq!(unit.begin, at, "{lengths:?}, {of} shards, at most {most}: {units:?}");
                            at = unit.end;
                        }
                        assert_eq!(at, if *length == 0 { u64::MAX } else { *length }, "{units:?}");
                        assert!(*length > 0 || of_log.len() == 1, "{units:?}");
                    }
                }
            }
        }
    }
}
