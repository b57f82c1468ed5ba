//! What changes from frame to frame, stored as changes.

use serde::{Deserialize, Serialize};

use crate::form::Film;

/// Words over time: those of one thing, and what of it they say.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Channel {
    /// The kind of thing: "circuit", "route", …
    pub kind: String,
    /// Its name.
    pub name: String,
    /// What of it.
    pub what: String,
    /// The frames of the changes, the first one 0: each as the distance from the one before.
    pub at: Vec<u32>,
    /// The word from there on, by its number.
    pub is: Vec<u32>,
}

/// Whole numbers over time, one for each frame.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Curve {
    /// The kind of thing.
    pub kind: String,
    /// Its name.
    pub name: String,
    /// What of it.
    pub what: String,
    /// The unit, for people.
    pub unit: String,
    /// By what a number is divided for people: 1 or more.
    pub per: u32,
    /// Each number as the distance from the last one that was there; null where there is none.
    pub by: Vec<Option<i64>>,
}

impl Film {
    /// The number of a word.
    pub fn word(&mut self, word: &str) -> u32 {
        if let Some(number) = self.numbers.get(word) {
            return *number;
        }
        let number = u32::try_from(self.words.len()).unwrap_or(u32::MAX);
        self.words.push(word.to_owned());
        self.numbers.insert(word.to_owned(), number);
        number
    }

    /// Adds words over time: one for each frame. A channel that would be empty throughout is left out.
    pub fn channel<W: AsRef<str>>(
        &mut self,
        (kind, name, what): (&str, &str, &str),
        words: impl IntoIterator<Item = W>,
    ) {
        let mut channel = Channel {
            kind: kind.to_owned(),
            name: name.to_owned(),
            what: what.to_owned(),
            at: Vec::new(),
            is: Vec::new(),
        };
        let (mut last, mut changed) = (None, 0);
        for (frame, word) in (0_u32..).zip(words) {
            let word = self.word(word.as_ref());
            if last != Some(word) {
                channel.at.push(frame - changed);
                channel.is.push(word);
                (last, changed) = (Some(word), frame);
            }
        }
        if channel.is.iter().any(|word| *word != 0) {
            self.channels.push(channel);
        }
    }

    /// Adds numbers over time: one for each frame. `unit` and `per`: how a number is told.
    pub fn curve(
        &mut self,
        (kind, name, what): (&str, &str, &str),
        (unit, per): (&str, u32),
        numbers: impl IntoIterator<Item = Option<i64>>,
    ) {
        let mut last = 0;
        let by = numbers.into_iter().map(|number| {
            let number = number?;
            let by = number - last;
            last = number;
            Some(by)
        });
        self.curves.push(Curve {
            kind: kind.to_owned(),
            name: name.to_owned(),
            what: what.to_owned(),
            unit: unit.to_owned(),
            per,
            by: by.collect(),
        });
    }

    /// The word of a thing in a frame; empty if nothing is said of it.
    pub fn word_at(&self, (kind, name, what): (&str, &str, &str), frame: u32) -> &str {
        let channel = self.channels.iter().find(|one| one.kind == kind && one.name == name && one.what == what);
        channel.map_or("", |channel| self.said(channel, frame))
    }

    /// The word of a channel in a frame.
    pub fn said(&self, channel: &Channel, frame: u32) -> &str {
        let mut at = 0;
        let mut number = 0;
        for (after, word) in channel.at.iter().zip(&channel.is) {
            at += after;
            if at > frame {
                break;
            }
            number = *word;
        }
        self.words.get(usize::try_from(number).unwrap_or(usize::MAX)).map_or("", String::as_str)
    }

    /// The number of a thing in a frame.
    pub fn number_at(&self, (kind, name, what): (&str, &str, &str), frame: u32) -> Option<i64> {
        let curve = self.curves.iter().find(|one| one.kind == kind && one.name == name && one.what == what)?;
        let frame = usize::try_from(frame).ok()?;
        (*curve.by.get(frame)?)?;
        Some(curve.by[..=frame].iter().flatten().sum())
    }
}
