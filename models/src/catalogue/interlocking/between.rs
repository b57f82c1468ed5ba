//! Two stations, the line between them, and a train from either end.

use super::shared::{ALL, without};
use crate::catalogue::about::{Conditions, about};
use crate::check::Entry;
use crate::interlocking::between::{Between, Faults, Lives, Purpose, Times};
use crate::interlocking::neighbours::View;
use atc_kernel::time::Ticks;

/// What all of them assume that do not lift it: what the models of a station do, and the time after a start.
const HERE: [&str; ALL.len() + 1] = {
    let mut all = ["start-outlasts-running"; ALL.len() + 1];
    let mut place = 0;
    while place < ALL.len() {
        all[place] = ALL[place];
        place += 1;
    }
    all
};
const SOUND: Conditions = (&HERE, &[]);
const NEVER_LOST: Conditions = (&without(0), &["loss-of-shunt-within-clear"]);
const TURNS: Conditions = (&without(11), &["turn-outlasts-telegrams"]);
const APART: Conditions = (&without(12), &["views-of-a-line-meet"]);
const STARTS: Conditions = (&ALL, &["start-outlasts-running"]);

/// Permissions that are old, and trains that soon see a signal fall.
const OLD: Lives = Lives { permission: 3, residual: 1 };
/// The shortest lives in which anything is late.
const SHORT: Lives = Lives { permission: 1, residual: 1 };
/// Signals that are passed long after they fell.
const LATE: Lives = Lives { permission: 2, residual: 2 };

/// Nothing fails.
const NONE: Faults = Faults { unheard: 0, falsely: 0, restarts: false };
/// The line may be falsely occupied.
const LINE: u8 = 0b1;
/// The line and the throat may be.
const BOTH: u8 = 0b11;

pub(super) fn entries() -> Vec<Entry> {
    let words = "both stations are commanded to turn the line either way, and to set and withdraw their route in and out, in any cycle; permissions are \
                 read in any cycle of their life, or never; trains go by signals, and each begins again when it has ended";
    let entry = |name, statement: &str, conditions, (view, lives): (View, Lives), faults: Faults, times, purpose| {
        let failing = format!("{words}{}", faults.words());
        Entry::new(
            about(name, statement, &failing, &["ILK-19", "ILK-24", "ILK-25"], conditions),
            Between::new(times, view, lives, faults, purpose),
        )
    };
    let sound = |name, statement, (view, lives), faults: Faults| {
        entry(name, statement, SOUND, (view, lives), faults, Times::right(lives, faults.unheard), Purpose::Safe)
    };
    let hazard = |name, statement, conditions: Conditions, (view, lives), faults: Faults, change: fn(&mut Times)| {
        let mut times = Times::right(lives, faults.unheard);
        change(&mut times);
        entry(name, statement, conditions, (view, lives), faults, times, Purpose::Hazard(conditions.1))
    };
    vec![
        sound(
            "interlocking-between",
            "Two trains go to and fro over a line between two stations; line and throats are falsely occupied at will: the trains never meet.",
            (View::Adjoining, OLD),
            Faults { falsely: BOTH, ..NONE },
        ),
        sound(
            "interlocking-between-lost",
            "The line is falsely occupied, and each train is lost for a cycle, at will: the trains never meet.",
            (View::Adjoining, SHORT),
            Faults { unheard: 1, falsely: LINE, ..NONE },
        ),
        sound(
            "interlocking-between-start",
            "The line is falsely occupied, and either device starts again, at will and any number of times: the trains never meet.",
            (View::Adjoining, OLD),
            Faults { falsely: LINE, restarts: true, ..NONE },
        ),
        sound(
            "interlocking-between-overlapping",
            "The same where each station sees its end of the line and both the middle.",
            (View::Overlapping, OLD),
            Faults { falsely: LINE, restarts: true, ..NONE },
        ),
        sound(
            "interlocking-between-everything",
            "The line falsely occupied, trains lost, and both devices started again, all of it at will: the trains never meet.",
            (View::Adjoining, SHORT),
            Faults { unheard: 1, falsely: LINE, restarts: true },
        ),
        hazard(
            "interlocking-between-short-turn",
            "A turn time of two cycles where permissions live for three: each station sends on the other's old permission.",
            TURNS,
            (View::Adjoining, OLD),
            NONE,
            |times| times.turn = Ticks(2),
        ),
        hazard(
            "interlocking-between-short-start",
            "A device that acts a cycle after its start: a train has passed the signal that it had shown before.",
            STARTS,
            (View::Adjoining, LATE),
            Faults { restarts: true, ..NONE },
            |times| times.start = Ticks(1),
        ),
        hazard(
            "interlocking-between-no-filter",
            "A circuit counts as clear at once: a train is lost for a cycle, and the line is turned against it.",
            NEVER_LOST,
            (View::Adjoining, SHORT),
            Faults { unheard: 1, ..NONE },
            |times| times.clear = 1,
        ),
        hazard(
            "interlocking-between-apart",
            "A stretch of the line that neither station sees: a train stands there, and the other one is let out against it.",
            APART,
            (View::Apart, SHORT),
            NONE,
            |_| {},
        ),
    ]
}
