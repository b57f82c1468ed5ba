//! What happens in a film.

use serde::{Deserialize, Serialize};

use crate::form::Film;

/// What an event is about.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Class {
    /// An accident, or a difference between a record and the kernel.
    Harm,
    /// A fault begins.
    Fault,
    /// What a device answers has changed.
    Output,
    /// What is read has changed.
    Input,
}

/// Something that happens.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Event {
    /// The frame.
    pub at: u32,
    /// What it is about.
    pub class: Class,
    /// What, by the number of its text.
    pub text: u32,
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
