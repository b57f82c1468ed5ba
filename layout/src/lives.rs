//! The lives of telegrams, in one place: what the ground counts on (`telegram_age_ms`, release times), and what trains do.
//!
//! A train acts on a telegram from the moment in which its content was taken until the train slows down after the telegram has died; and on
//! a code for as long as transmitter and receiver name it after the ground has changed it, and it is displayed after it was last heard.
//! The approach of a route, the turn time and the release times are held against `telegram_age_ms`; so it must not be shorter.

use crate::description::Description;
use crate::model::Model;
use crate::problem::{Errors, Problem};
use crate::rule::Rule;

/// What a train does with main telegrams and codes, in ms.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TrainLives {
    /// By how much content is taken before its telegram is complete: the time of one telegram.
    pub ahead_ms: u64,
    /// From the last bit of a telegram in the rail to its arrival in the logic. The age that a train counts begins there.
    pub way_ms: u64,
    /// For how long a telegram is used: the life, up to the cycle in which it is gone.
    pub life_ms: u64,
    /// From the ground's change of a code until no train's receiver names the old one any more: of transmitter and receiver. The age of a code
    /// begins when it is last named.
    pub code_way_ms: u64,
    /// For how long a code is displayed after it was last heard: T2 + T3; 0 if nothing says.
    pub code_ms: u64,
    /// From a lower permission to a train that slows down.
    pub reaction_ms: u64,
}

impl TrainLives {
    /// For how long a train may act on what the ground has withdrawn: by telegram or by code, whichever is longer.
    pub const fn acts_ms(self) -> u64 {
        (if self.is_of_codes() { self.shown_ms() } else { self.telegram_ms() }) + self.reaction_ms
    }

    /// Whether a code is displayed for longer than a telegram lives, each with its way.
    pub const fn is_of_codes(self) -> bool {
        self.shown_ms() > self.telegram_ms()
    }

    const fn shown_ms(self) -> u64 {
        self.code_way_ms + self.code_ms
    }

    const fn telegram_ms(self) -> u64 {
        self.ahead_ms + self.way_ms + self.life_ms
    }
}

/// What is wrong with the age that the ground counts on, if trains act on telegrams for longer.
pub fn age(description: &Description, train: TrainLives) -> Option<Problem> {
    let acts = train.acts_ms();
    let TrainLives { ahead_ms, way_ms, life_ms, code_way_ms, code_ms, reaction_ms } = train;
    let age = &description.station.times.telegram_age_ms;
    if u64::from(age.value) >= acts {
        return None;
    }
    if train.is_of_codes() {
        let what = format!(
            "the ground counts on telegrams that live for {age} ms, and trains act on a code for {acts} ms (way {code_way_ms} ms, displayed \
             for {code_ms} ms after it was last heard, reaction {reaction_ms} ms)"
        );
        let right = format!("telegram_age_ms must be {acts} or more, or the way or T2 + T3 less");
        return Some(Problem::new(Rule::TelegramLives, &age.span, what, right));
    }
    let what = format!(
        "the ground counts on telegrams that live for {age} ms, and trains act on them for {acts} ms (content taken ahead \
         {ahead_ms} ms, way {way_ms} ms, life {life_ms} ms, reaction {reaction_ms} ms)"
    );
    let right = match u64::from(age.value).checked_sub(ahead_ms + way_ms + reaction_ms).filter(|life| *life > 0) {
        Some(life) => format!("telegram_age_ms must be {acts} or more, or the train's life end within {life} ms"),
        None => format!("telegram_age_ms must be {acts} or more"),
    };
    Some(Problem::new(Rule::TelegramLives, &age.span, what, right))
}

/// Holds what the ground counts on against what trains do.
///
/// # Errors
/// Each time of the layout that is too short, with its place and what would be right.
pub fn compare(description: &Description, model: &Model, train: TrainLives) -> Result<(), Errors> {
    let acts = train.acts_ms();
    let times = &description.station.times;
    let mut problems: Vec<_> = age(description, train).into_iter().collect();
    for (route, given) in model.routes.iter().zip(&description.station.routes) {
        let release = u64::from(route.release.0) * u64::from(model.values.cycle_ms);
        if release < acts {
            let what = format!(
                "route {} is released after {release} ms, and trains act on telegrams for {acts} ms",
                route.name
            );
            let span = given.release_ms.as_ref().map_or(&times.release_ms.span, |time| &time.span);
            problems.push(Problem::new(Rule::TelegramLives, span, what, format!("release_ms must be {acts} or more")));
        }
    }
    if problems.is_empty() { Ok(()) } else { Err(Errors::new(&description.source, problems)) }
}
