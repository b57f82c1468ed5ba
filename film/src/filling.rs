//! How a film is filled: words, numbers and events over time.

use crate::event::{Class, Event};
use crate::form::Film;
use crate::series::{Channel, Curve};

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

impl Film {
    /// Adds an event.
    pub fn event(&mut self, at: u32, class: Class, text: &str) {
        let text = self.word(text);
        self.events.push(Event { at, class, text });
    }

    /// Adds an event for each change, after the first frame, of the channels of a kind. `told` has the name and the new
    /// word.
    pub fn happenings(
        &mut self,
        (kind, what): (&str, &str),
        class: Class,
        told: impl Fn(&str, &str) -> Option<String>,
    ) {
        let mut found = Vec::new();
        for channel in self.channels.iter().filter(|one| one.kind == kind && one.what == what) {
            let mut at = 0;
            for (place, (after, word)) in channel.at.iter().zip(&channel.is).enumerate() {
                at += after;
                let word = usize::try_from(*word).ok().and_then(|word| self.words.get(word)).map_or("", String::as_str);
                // What stands there at first has not happened.
                if place > 0
                    && let Some(text) = told(&channel.name, word)
                {
                    found.push((at, text));
                }
            }
        }
        for (at, text) in found {
            self.event(at, class, &text);
        }
    }

    /// Puts the events in the order of their frames; of one frame, harm first.
    pub fn sort_events(&mut self) {
        self.events.sort_by_key(|event| (event.at, event.class));
    }
}
