//! The line between two stations.

use super::{Conditions, SOUND, about, without};
use crate::check::Entry;
use crate::interlocking::neighbours::{Neighbour, Pair, Purpose};

const ANOTHER: Conditions = (&without(10), &["neighbour-turns-alike"]);
const SHORT: Conditions = (&without(11), &["turn-outlasts-telegrams"]);

/// The life of a telegram in these models, in cycles.
const LIFE: u8 = 2;

pub(super) fn entries() -> Vec<Entry> {
    let words = "both stations are commanded to turn the line either way in any cycle; permissions are read in any cycle of their \
                 life, or never";
    let model = |name, statement: &str, conditions, turn, neighbour, purpose| {
        Entry::new(
            about(name, statement, words, &["ILK-19"], conditions),
            Pair { turn, life: LIFE, neighbour, purpose },
        )
    };
    vec![
        model(
            "interlocking-line",
            "Two stations turn the line between them, with telegrams that are late or lost: never do both send into it.",
            SOUND,
            u16::from(LIFE) + 1,
            Neighbour::Alike,
            Purpose::Safe,
        ),
        model(
            "interlocking-line-short-turn",
            "A turn time no longer than the telegrams live: an old permission is read after it was withdrawn, and both stations send.",
            SHORT,
            u16::from(LIFE),
            Neighbour::Alike,
            Purpose::Hazard(&["turn-outlasts-telegrams", "ILK-19"]),
        ),
        model(
            "interlocking-line-other-protocol",
            "A neighbour that permits although it sends itself: both stations send.",
            ANOTHER,
            u16::from(LIFE) + 1,
            Neighbour::PermitsAlways,
            Purpose::Hazard(&["neighbour-turns-alike"]),
        ),
    ]
}
