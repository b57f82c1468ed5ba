//! Makes a trace shorter while its difference stays of the same kind: by cases, by steps (delta debugging after Zeller and Hildebrandt,
//! 2002), then by the fields of each step and of the configuration. Every candidate is played on the other side again.

use std::time::{Duration, Instant};

use serde_json::Value;

use super::case::{Case, Expected};
use super::play::{At, Found, Judge, Kind, play};
use super::side::Answers;

/// A trace that shows a finding, in its last case.
#[derive(Clone, Debug)]
pub struct Trace {
    /// The cases, in their order; one, unless the finding needs what went before it.
    pub cases: Vec<Expected>,
    /// The finding in the last case.
    pub found: Found,
    /// Whether it shows again in a new process.
    pub again: bool,
    /// Whether no step can be left out: false if time ran out first.
    pub minimal: bool,
    /// How many candidates were played.
    pub tries: u64,
}

impl Trace {
    /// How many steps it has, over all cases.
    pub fn steps(&self) -> usize {
        self.cases.iter().map(|expected| expected.case.steps.len()).sum()
    }

    /// The request lines.
    pub fn lines(&self) -> Vec<String> {
        self.cases.iter().flat_map(|expected| expected.case.lines(expected.is_rejected())).collect()
    }
}

/// A configuration with more in it than this is left as it is: every candidate would be a station to compile.
const MAX_CONFIG: u64 = 1500;

/// Plays candidates.
struct Shrinker<'a> {
    side: &'a mut dyn Answers,
    judge: Judge<'a>,
    kind: Kind,
    until: Instant,
    /// Each candidate in a process of its own: where the other side keeps something from case to case.
    fresh: bool,
    tries: u64,
}

/// Shrinks the trace that ends in `found`. `before` are the cases that the same process has played before.
pub fn shrink(
    before: &[Case],
    case: Case,
    found: Found,
    side: &mut dyn Answers,
    judge: Judge<'_>,
    time: Duration,
) -> Option<Trace> {
    let kind = found.kind();
    let mut shrinker = Shrinker { side, judge, kind, until: Instant::now() + time, fresh: true, tries: 0 };
    let mut trace = shrinker.again(before, &case);
    let again = trace.is_some();
    if trace.is_none() {
        // Not seen again: told as it was.
        let mut whole = case;
        whole.steps.truncate(found.replies.len().max(1));
        trace = whole.expected().ok().map(|expected| (vec![expected], found));
    }
    let (mut cases, mut found) = trace?;
    let mut minimal = false;
    if again {
        let (whole, first) = (cases.clone(), found.clone());
        (cases, found) = shrinker.smallest(cases, found);
        if !shrinker.fresh && shrinker.is_left() {
            // Candidates shared a process: what came out must also show in a new one.
            shrinker.fresh = true;
            let alone: Vec<_> = cases.iter().map(|expected| expected.case.clone()).collect();
            // If it does not, something was kept from candidate to candidate: once more, each in a process of its own.
            let shown = shrinker.play(&alone);
            (cases, found) = shown.unwrap_or_else(|| shrinker.smallest(whole, first));
        }
        minimal = shrinker.is_left();
    }
    Some(Trace { cases, found, again, minimal, tries: shrinker.tries })
}

type Shown = (Vec<Expected>, Found);

impl Shrinker<'_> {
    fn is_left(&self) -> bool {
        Instant::now() < self.until
    }

    /// Plays cases one after the other; the trace up to the finding, if one of the same kind is there first.
    fn play(&mut self, cases: &[Case]) -> Option<Shown> {
        self.tries += 1;
        let mut played = Vec::with_capacity(cases.len());
        for case in cases {
            played.push(case.clone().expected().ok()?);
        }
        if self.fresh {
            self.side.end();
        }
        for number in 0..played.len() {
            if let Err(found) = play(&played[number], self.side, self.judge) {
                if found.kind() != self.kind {
                    return None;
                }
                played.truncate(number + 1);
                if let (At::Step(step), Some(last)) = (found.at, played.last_mut()) {
                    last.case.steps.truncate(step + 1);
                    last.outputs.truncate(step + 1);
                } else if let (At::Start, Some(last)) = (found.at, played.last_mut()) {
                    last.case.steps.clear();
                    last.outputs.clear();
                }
                return Some((played, *found));
            }
        }
        None
    }

    /// The finding once more, in a new process: by the case alone, or after the cases that went before it.
    fn again(&mut self, before: &[Case], case: &Case) -> Option<Shown> {
        self.fresh = true;
        if let Some(shown) = self.play(std::slice::from_ref(case)) {
            self.fresh = false;
            return Some(shown);
        }
        // The last case before is the likeliest.
        for count in [1, 4, before.len()] {
            let from = before.len().saturating_sub(count);
            let mut cases = before[from..].to_vec();
            if cases.is_empty() {
                break;
            }
            cases.push(case.clone());
            if let Some(shown) = self.play(&cases) {
                return Some(shown);
            }
        }
        None
    }

    fn smallest(&mut self, mut cases: Vec<Expected>, mut found: Found) -> Shown {
        loop {
            let before = size(&cases);
            (cases, found) = self.fewer_cases(cases, found);
            for number in (0..cases.len()).rev() {
                (cases, found) = self.fewer_steps(cases, found, number);
            }
            for number in (0..cases.len()).rev() {
                (cases, found) = self.simpler(cases, found, number);
            }
            if size(&cases) == before || !self.is_left() {
                return (cases, found);
            }
        }
    }

    fn fewer_cases(&mut self, mut cases: Vec<Expected>, mut found: Found) -> Shown {
        let mut number = 0;
        while cases.len() > 1 && number + 1 < cases.len() && self.is_left() {
            let mut fewer = plain(&cases);
            fewer.remove(number);
            match self.play(&fewer) {
                Some(shown) => (cases, found) = shown,
                None => number += 1,
            }
        }
        (cases, found)
    }

    /// Leaves out steps of one case: halves, quarters and so on, down to single ones, until none can be left out.
    fn fewer_steps(&mut self, mut cases: Vec<Expected>, mut found: Found, number: usize) -> Shown {
        let length = |cases: &[Expected]| cases.get(number).map_or(0, |expected| expected.case.steps.len());
        let mut piece = length(&cases).div_ceil(2);
        while piece > 0 {
            let (mut from, mut less) = (0, false);
            while from < length(&cases) {
                if !self.is_left() {
                    return (cases, found);
                }
                let mut fewer = plain(&cases);
                let to = (from + piece).min(fewer[number].steps.len());
                fewer[number].steps.drain(from..to);
                match self.play(&fewer) {
                    Some(shown) if size(&shown.0) < size(&cases) => {
                        (cases, found) = shown;
                        less = true;
                    }
                    _ => from += piece,
                }
            }
            if piece == 1 && less {
                continue;
            }
            piece /= 2;
        }
        (cases, found)
    }

    /// Makes the fields of the steps and of the configuration of one case simpler.
    fn simpler(&mut self, mut cases: Vec<Expected>, mut found: Found, number: usize) -> Shown {
        let mut place = 0;
        while number < cases.len() && place <= cases[number].case.steps.len() {
            // The last place is the configuration.
            let value = |case: &Case| case.steps.get(place).cloned().unwrap_or_else(|| case.config.clone());
            if place == cases[number].case.steps.len() && weigh(&cases[number].case.config) > MAX_CONFIG {
                break;
            }
            let (mut at, mut candidates) = (0, simpler(&value(&cases[number].case)));
            while at < candidates.len() {
                if !self.is_left() {
                    return (cases, found);
                }
                let mut changed = plain(&cases);
                let case = &mut changed[number];
                let candidate = candidates[at].clone();
                match case.steps.get_mut(place) {
                    Some(step) => *step = candidate,
                    None => case.config = candidate,
                }
                at += 1;
                let Some(shown) = self.play(&changed).filter(|shown| size(&shown.0) < size(&cases)) else { continue };
                let fewer = shown.0.len() <= number || shown.0[number].case.steps.len() < place;
                (cases, found) = shown;
                if fewer {
                    break;
                }
                // What was before it was tried: the next round tries it once more.
                at = at.saturating_sub(1);
                candidates = simpler(&value(&cases[number].case));
            }
            place += 1;
        }
        (cases, found)
    }
}

fn plain(cases: &[Expected]) -> Vec<Case> {
    cases.iter().map(|expected| expected.case.clone()).collect()
}

/// What must become smaller with every change: cases, steps, then what stands in them.
fn size(cases: &[Expected]) -> (usize, usize, u64) {
    let steps = cases.iter().map(|expected| expected.case.steps.len()).sum();
    let weight = |case: &Case| case.steps.iter().map(weigh).sum::<u64>() + weigh(&case.config);
    (cases.len(), steps, cases.iter().map(|expected| weight(&expected.case)).sum())
}

/// How much stands in a value: names and entries, texts by their length, numbers by their size.
fn weigh(value: &Value) -> u64 {
    match value {
        Value::Null => 1,
        Value::Bool(set) => 1 + u64::from(*set),
        Value::Number(number) => {
            let size = number.as_f64().unwrap_or(0.0).abs();
            #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a weight, cut off below")]
            let digits = (size * 1000.0).min(1e9) as u64;
            // A whole number is simpler than one with a fraction.
            2 + digits.ilog2_or_zero() + u64::from(number.is_f64())
        }
        Value::String(text) => 2 + text.len() as u64,
        Value::Array(items) => 4 + items.iter().map(weigh).sum::<u64>() + 4 * items.len() as u64,
        Value::Object(entries) => 4 + entries.values().map(weigh).sum::<u64>() + 8 * entries.len() as u64,
    }
}

trait Log2 {
    fn ilog2_or_zero(self) -> u64;
}

impl Log2 for u64 {
    fn ilog2_or_zero(self) -> u64 {
        self.checked_ilog2().map_or(0, u64::from)
    }
}

/// Values that are simpler than this one, the boldest first: nothing, less, a smaller number; in one place at a time.
fn simpler(value: &Value) -> Vec<Value> {
    match value {
        Value::Bool(true) => vec![Value::Bool(false)],
        Value::Number(number) => smaller(number).into_iter().map(Value::from).collect(),
        // A stream of bits is cut; a name is not changed.
        Value::String(text) if text.bytes().all(|byte| matches!(byte, b'0' | b'1' | b'.')) => {
            let half = text.len() / 2;
            let mut cuts = vec![text[half..].to_owned(), text[..half].to_owned()];
            if !text.is_empty() {
                cuts.extend([text[1..].to_owned(), text[..text.len() - 1].to_owned()]);
            }
            cuts.retain(|cut| cut.len() < text.len());
            cuts.into_iter().map(Value::from).collect()
        }
        Value::Null | Value::Bool(false) | Value::String(_) => Vec::new(),
        Value::Array(items) => {
            let mut all = Vec::new();
            if items.len() > 1 {
                all.push(Value::Array(Vec::new()));
            }
            for place in 0..items.len() {
                let mut fewer = items.clone();
                fewer.remove(place);
                all.push(Value::Array(fewer));
            }
            for (place, item) in items.iter().enumerate() {
                for candidate in simpler(item) {
                    let mut changed = items.clone();
                    changed[place] = candidate;
                    all.push(Value::Array(changed));
                }
            }
            all
        }
        Value::Object(entries) => {
            let mut all = Vec::new();
            for (name, entry) in entries {
                let mut fewer = entries.clone();
                fewer.remove(name);
                all.push(Value::Object(fewer));
                for candidate in simpler(entry).into_iter().chain((!entry.is_null()).then_some(Value::Null)) {
                    let mut changed = entries.clone();
                    changed.insert(name.clone(), candidate);
                    all.push(Value::Object(changed));
                }
            }
            all
        }
    }
}

/// Smaller numbers: 0, one, a half, one less, without its fraction.
fn smaller(number: &serde_json::Number) -> Vec<serde_json::Number> {
    if let Some(whole) = number.as_i64() {
        let mut all = vec![0, whole.signum(), 10 * whole.signum(), whole / 10, whole / 2, whole - whole.signum()];
        all.retain(|other| other.unsigned_abs() < whole.unsigned_abs());
        all.dedup();
        return all.into_iter().map(Into::into).collect();
    }
    let Some(number) = number.as_f64() else { return Vec::new() };
    #[expect(clippy::cast_possible_truncation, reason = "a simpler number, whichever it is")]
    let whole = number.trunc() as i64;
    vec![0.into(), whole.into(), (whole / 2).into()]
}
