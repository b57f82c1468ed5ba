//! What can be said of a difference that comes early in its session: the session up to there, and a change of the kernel with which it would
//! say the same.

use std::fs::File;
use std::io::{Read, Seek as _, SeekFrom};

use serde_json::Value;

use super::lines::{Lines, key};
use super::logs::{Form, Log};
use super::report::Differing;
use super::rows::Rows;
use crate::conform::alike::alike;
use crate::conform::case::Case;
use crate::conform::fields::Level;

/// How many differences are explained: the first ones.
pub(super) const EXPLAINED: usize = 10;

/// The most steps of a session up to its difference, and the most bytes.
const STEPS: u64 = 400;
const BYTES: usize = 1 << 18;

/// Adds to the first differences the lines of their sessions, and the guesses.
pub(super) fn explain(differences: &mut [Differing], logs: &[Log], level: Level) {
    for differing in differences.iter_mut().take(EXPLAINED) {
        if differing.step.is_none_or(|step| step > STEPS) {
            continue;
        }
        let log = logs.iter().find(|log| log.name == differing.file && log.length.is_some());
        let Some(session) = log.and_then(|log| session(log, differing)) else { continue };
        if let Some((case, replies)) = case(differing, &session)
            && let Ok(expected) = case.expected()
        {
            let guesses = alike(&expected, &replies, level);
            differing.as_if = guesses.iter().map(|guess| format!("{} ({})", guess.says, guess.requirement)).collect();
            // The likeliest requirement first, as `oracle conform` has it.
            for guess in guesses.iter().rev() {
                differing.requirements.retain(|id| id != guess.requirement);
                differing.requirements.insert(0, guess.requirement.to_owned());
            }
        }
        differing.session = session;
    }
}

/// The lines from the start to the reply that differs, if they are few.
fn session(log: &Log, differing: &Differing) -> Option<Vec<String>> {
    let mut file = File::open(log.path.as_ref()?).ok()?;
    if log.form == Form::Parquet {
        // It cannot be read from the middle.
        let rows = Rows::open(file).ok()?;
        let of_one = rows.lines_of_a_row();
        return collect(Lines::of_rows(rows, 0, of_one), differing, 0);
    }
    file.seek(SeekFrom::Start(differing.offset)).ok()?;
    collect(Lines::new(file, differing.offset), differing, differing.session_line.saturating_sub(1))
}

/// These lines, of which so many are not counted.
fn collect<R: Read>(mut lines: Lines<R>, differing: &Differing, before: u64) -> Option<Vec<String>> {
    let (mut all, mut bytes) = (Vec::new(), 0);
    while let Some(line) = lines.next().ok()? {
        if line.offset < differing.offset {
            continue;
        }
        if before + line.number > differing.line {
            break;
        }
        let line = std::str::from_utf8(line.text?).ok()?.trim();
        bytes += line.len();
        if bytes > BYTES {
            return None;
        }
        if !line.is_empty() {
            all.push(line.to_owned());
        }
    }
    Some(all)
}

/// The case, and what the record says to its steps, if every step up to the difference has its output.
fn case(differing: &Differing, session: &[String]) -> Option<(Case, Vec<String>)> {
    let mut case = Case { machine: differing.machine.clone(), config: Value::Null, steps: Vec::new() };
    let mut replies = Vec::new();
    for line in session {
        let body = || serde_json::from_str::<Value>(line).ok();
        match key(line.as_bytes())? {
            b"start" => case.config = body()?["start"].get("config").cloned().unwrap_or_else(|| serde_json::json!({})),
            b"step" => case.steps.push(body()?["step"].take()),
            b"output" => replies.push(line.clone()),
            b"started" => {}
            _ => return None,
        }
    }
    // Requests that were sent ahead have no reply here yet.
    case.steps.truncate(replies.len());
    Some((case, replies))
}
