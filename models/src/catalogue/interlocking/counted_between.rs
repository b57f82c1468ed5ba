//! A counted line between two stations, and trains that follow each other over it.

use super::shared::ALL;
use crate::block::fault::Kind;
use crate::catalogue::about::{Conditions, about, all_but, joined};
use crate::check::Entry;
use crate::interlocking::between::Lives;
use crate::interlocking::counted_between::{Around, CountedBetween, Failure, Faults, Purpose, Wiring, cut_sets};

/// What all of them assume besides, and last what one of them is about.
const COUNTING: [&str; 10] = [
    "start-outlasts-running",
    "live-transmitter",
    "train-whole",
    "no-reversing-over-exit",
    "hold-covers-train",
    "heard-by-one",
    "entries-apart",
    "loops-overlap",
    "independent-detectors",
    "line-end-asks",
];

const BOTH: [&str; ALL.len() + COUNTING.len()] = joined(ALL, COUNTING);

/// All but the one at `place`.
const fn without(place: usize) -> [&'static str; BOTH.len() - 1] {
    all_but(BOTH, place)
}

/// What one faulty component breaches.
const FAULTS: &[&str] = &["check-in-fail-safe", "check-out-not-spurious", "verified-reset"];
const SOUND: Conditions = (&BOTH, &[]);
const ONE_FAULT: Conditions = (&BOTH, FAULTS);
const TWO_FAULTS: Conditions = (
    &without(BOTH.len() - 2),
    &["independent-detectors", "check-in-fail-safe", "check-out-not-spurious", "verified-reset"],
);
const NOT_ASKED: Conditions = (&without(BOTH.len() - 1), &["line-end-asks"]);

/// The shortest lives in which anything is late.
const SHORT: Lives = Lives { permission: 1, residual: 1 };
/// Trains that stop at once.
const PROMPT: Lives = Lives { permission: 1, residual: 0 };

const REQUIREMENTS: &[&str] =
    &["ILK-9", "ILK-19", "ILK-24", "ILK-25", "ILK-26", "BLK-1", "BLK-2", "BLK-5", "WAY-1", "WAY-2"];

/// No fault, and each kind of fault alone, in every place in turn.
fn singles(sections: u8, blocks: u8) -> Vec<Faults> {
    let faults = Failure::all().into_iter().flat_map(|kind| kind.single(sections, blocks));
    std::iter::once(Faults::NONE).chain(faults).collect()
}

fn entry<const B: usize>(
    (name, statement, words): (&'static str, &str, &str),
    conditions: Conditions,
    model: CountedBetween<B>,
) -> Entry {
    let all = "routes are set at both stations in any cycle; trains move and stand in any cycle, and each begins again when it has ended";
    Entry::new(about(name, statement, &format!("{all}; {words}"), REQUIREMENTS, conditions), model)
}

pub(super) fn entries() -> Vec<Entry> {
    let new = |trains, faults, purpose| CountedBetween::<1>::new(2, trains, SHORT, faults, purpose);
    let starts = [Around::Consent, Around::SenderStarts, Around::ReceiverStarts];
    let starts = std::iter::once(Faults::NONE).chain(starts.map(|around| Faults::around(around, true)));
    let blocks = CountedBetween::<2>::new(1, 2, PROMPT, singles(1, 2), Purpose::Safe);
    let pair = [Kind::Missed, Kind::WrongReset].map(Failure::Counting);
    let pairs = Purpose::Pairs(&["verified-reset"]);
    let pairs = CountedBetween::<1>::new(3, 2, PROMPT, cut_sets::places(&pair, 3, 1), pairs);
    vec![
        entry(
            (
                "interlocking-counted-between",
                "Trains follow each other over a counted line from one station to the other, both devices count it, and any one thing fails, as often \
                 as it likes: no collision, and every section with any part of a train counts as occupied at both.",
                "a route in use is withdrawn in any cycle; one component may fail in every cycle, or a throat be falsely occupied, a circuit lose a train \
                 for one cycle, either device start again, permissions be lost or old; staff reset what does not agree, at both devices together",
            ),
            ONE_FAULT,
            new(2, singles(2, 1), Purpose::Safe).orderly(),
        ),
        entry(
            (
                "interlocking-counted-between-start",
                "Three trains, either device starts again, any number of times, or permissions are lost and old; staff reset each device when they like: \
                 the same, and trains are sent again.",
                "routes are withdrawn in any cycle; one device may start again in any cycle, or permissions be lost or old",
            ),
            SOUND,
            new(3, starts.collect(), Purpose::Safe),
        ),
        entry(
            (
                "interlocking-counted-between-blocks",
                "The same as the first over two blocks of one section, where each thing fails once.",
                "a route in use is withdrawn in any cycle; one thing fails once, a level for as long as it likes; staff reset what does not agree, at both \
                 devices together",
            ),
            ONE_FAULT,
            blocks.once().orderly(),
        ),
        entry(
            (
                "interlocking-counted-between-pairs",
                "Which two faults, each of which comes once at any time, let two trains meet on a counted line between two stations: a missed detection \
                 with one of four others, and no other pair. The states are those of a missed detection and a wrong reset.",
                "a route in use is withdrawn in any cycle; each fault comes once, a level for as long as it likes; staff reset what does not agree, at both \
                 devices together",
            ),
            TWO_FAULTS,
            pairs.once().orderly(),
        ),
        entry(
            (
                "interlocking-counted-between-not-asked",
                "The counting is not told of a train beyond the exit, at either device: a train stands with its front in the receiver's throat and its \
                 tail on the line, and the next one runs into it.",
                "routes are withdrawn in any cycle; nothing fails",
            ),
            NOT_ASKED,
            new(2, vec![Faults::NONE], Purpose::Hazard(NOT_ASKED.1)).wired(Wiring::HoldsNothing),
        ),
    ]
}
