//! The line between two stations.

use super::shared::{SOUND, without};
use crate::catalogue::about::{Conditions, about};
use crate::check::Entry;
use crate::interlocking::neighbours::{Neighbour, Pair, Purpose, View};

const ANOTHER: Conditions = (&without(10), &["neighbour-turns-alike"]);
const APART: Conditions = (&without(12), &["views-of-a-line-meet"]);
const SHORT: Conditions = (&without(11), &["turn-outlasts-telegrams"]);

/// The life of a telegram in these models, in cycles.
const LIFE: u8 = 2;

pub(super) fn entries() -> Vec<Entry> {
    let words = "both stations are commanded to turn the line either way in any cycle; permissions are read in any cycle of their \
                 life, or never";
    let model = |name, statement: &str, conditions, turn, (neighbour, view), purpose| {
        Entry::new(
            about(name, statement, words, &["ILK-19"], conditions),
            Pair { turn, life: LIFE, neighbour, view, found: false, purpose },
        )
    };
    let turn = u16::from(LIFE) + 1;
    let started = Pair {
        turn,
        life: LIFE,
        neighbour: Neighbour::Alike,
        view: View::Adjoining,
        found: true,
        purpose: Purpose::Safe,
    };
    vec![
        model(
            "interlocking-line",
            "Two stations turn the line between them, with telegrams that are late or lost: never do both send into it.",
            SOUND,
            u16::from(LIFE) + 1,
            (Neighbour::Alike, View::Whole),
            Purpose::Safe,
        ),
        model(
            "interlocking-line-overlapping",
            "The same where each station sees its end of the line and both the middle.",
            SOUND,
            u16::from(LIFE) + 1,
            (Neighbour::Alike, View::Overlapping),
            Purpose::Safe,
        ),
        model(
            "interlocking-line-adjoining",
            "The same where each station sees its half of the line, up to one joint.",
            SOUND,
            u16::from(LIFE) + 1,
            (Neighbour::Alike, View::Adjoining),
            Purpose::Safe,
        ),
        Entry::new(
            about(
                "interlocking-line-start",
                "The first station starts, or both do, with a train on the line, which may stand in the half that the other does not see: the line is given \
                 to nobody against it.",
                words,
                &["ILK-25"],
                SOUND,
            ),
            started,
        ),
        model(
            "interlocking-line-apart",
            "A stretch of the line that neither station sees: a train stands there, and the other station sends against it.",
            APART,
            u16::from(LIFE) + 1,
            (Neighbour::Alike, View::Apart),
            Purpose::Hazard(&["views-of-a-line-meet"]),
        ),
        model(
            "interlocking-line-short-turn",
            "A turn time no longer than the telegrams live: an old permission is read after it was withdrawn, and both stations send.",
            SHORT,
            u16::from(LIFE),
            (Neighbour::Alike, View::Whole),
            Purpose::Hazard(&["turn-outlasts-telegrams", "ILK-19"]),
        ),
        model(
            "interlocking-line-other-protocol",
            "A neighbour that permits although it sends itself: both stations send.",
            ANOTHER,
            u16::from(LIFE) + 1,
            (Neighbour::PermitsAlways, View::Whole),
            Purpose::Hazard(&["neighbour-turns-alike"]),
        ),
    ]
}
