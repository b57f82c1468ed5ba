//! The models of transmitters that repeat themselves, and of the counter's range.

use super::shared::{AGE, LOOPS, NO_POINT_LIFE, SOUND, ride};
use crate::catalogue::about::{Conditions, about};
use crate::check::Entry;
use crate::permitted::layout::Layout;
use crate::permitted::ride::{Changes, Delivery, Environment, Motion, Small, Transmitter};
use crate::permitted::{Purpose, Sight};

/// Frozen and looping transmitters, and a loss as long as the counter's range.
pub(super) fn entries() -> Vec<Entry> {
    let mut entries = frozen();
    entries.push(frozen_and_late());
    entries.extend(in_turn());
    entries.extend(wrapped());
    entries
}

/// The transmitter repeats so many of its last telegrams from any cycle on, and a withdrawn stretch is kept for so long.
fn looping(telegrams: u8, keeps: u16) -> Environment {
    Environment {
        transmitter: Transmitter::Loops(telegrams),
        route: Changes::Withdrawn,
        keeps,
        code: Delivery::Always,
        ..Environment::USUAL
    }
}

/// Sub telegrams grow old at the same time: without a lower limit to fall back on they hide nothing.
const RUN_1: Small = Small { lowest: 1, ..Small::USUAL };

fn moving() -> Layout {
    Layout::digital(&[3, 4, 3], &[7, 9])
}

fn model(
    (name, statement, words): (&'static str, &str, &str),
    layout: &Layout,
    small: Small,
    environment: Environment,
    conditions: Conditions,
    purpose: Purpose,
) -> Entry {
    ride(about(name, statement, words, AGE, conditions), layout, small, environment, purpose)
}

fn frozen() -> Vec<Entry> {
    let life = Small::USUAL.life;
    vec![
        model(
            (
                "permitted-frozen",
                "A transmitter repeats its last telegram for ever, and the train may hear it late: it is used once at most, and never \
                 after its life, which is counted from the telegram before it; this age is reached.",
                "main telegrams are lost in any cycle; the transmitter freezes in any; a withdrawn stretch is kept for the life",
            ),
            &moving(),
            RUN_1,
            looping(1, life),
            SOUND,
            Purpose::Safe(&[Sight::Pattern, Sight::OldPoint, Sight::Repeated]),
        ),
        model(
            (
                "permitted-frozen-at-once",
                "A transmitter repeats its last telegram for ever, and a withdrawn stretch is kept for a cycle less than the life of a \
                 telegram: more is permitted than the ground allows.",
                "the same; a withdrawn stretch is kept for the life less 1 cycle",
            ),
            &moving(),
            RUN_1,
            looping(1, life - 1),
            NO_POINT_LIFE,
            Purpose::Hazard(&["stop-point-life"]),
        ),
    ]
}

fn frozen_and_late() -> Entry {
    model(
        (
            "permitted-frozen-and-late",
            "A transmitter repeats its last telegram for ever, and the one before that arrives late, as often as one likes but not twice in \
             a row: the frozen one is used once at most, and never after its life.",
            "main telegrams are lost in any cycle; the transmitter freezes in any; run 1; life and memory 5 cycles; a withdrawn stretch is kept \
             for the life",
        ),
        &moving(),
        Small { life: 5, fixed_life: 6, memory: 5, ..RUN_1 },
        Environment { transmitter: Transmitter::FreezesAndLate, ..looping(1, 5) },
        SOUND,
        Purpose::Safe(&[Sight::Pattern, Sight::OldPoint, Sight::Repeated]),
    )
}

fn in_turn() -> Vec<Entry> {
    let layout = moving();
    // Long enough for every telegram of a loop of two to be missed once.
    let slow = |run| Small { run, fresh: 4, life: 4, memory: 4, ..RUN_1 };
    let loops = Purpose::Hazard(&["transmitter-does-not-loop"]);
    vec![
        model(
            (
                "permitted-alternating",
                "A transmitter repeats its last two telegrams in turn, and two advances are needed: a telegram may follow another that is \
                 itself old, and is used until its life and the memory less 2 cycles at most; this age is reached.",
                "main telegrams are lost in any cycle; the transmitter loops from any; run 2; a withdrawn stretch is kept for life + \
                 memory - 2",
            ),
            &layout,
            slow(2),
            looping(2, 4 + 4 - 2),
            LOOPS,
            Purpose::Safe(&[Sight::Pattern, Sight::OldPoint, Sight::Repeated]),
        ),
        model(
            (
                "permitted-alternating-life-alone",
                "A transmitter repeats its last two telegrams in turn, two advances are needed, and a withdrawn stretch is kept for the life \
                 of a telegram only: more is permitted than the ground allows.",
                "the same; a withdrawn stretch is kept for the life",
            ),
            &layout,
            slow(2),
            looping(2, 4),
            LOOPS,
            loops,
        ),
        model(
            (
                "permitted-alternating-run-1",
                "A transmitter repeats its last two telegrams in turn, and one advance is enough: old telegrams are used for ever.",
                "main telegrams are lost in any cycle; the transmitter loops from any; run 1",
            ),
            &layout,
            slow(1),
            looping(2, 4 + 4 - 2),
            LOOPS,
            loops,
        ),
        model(
            (
                "permitted-looping-run-2",
                "A transmitter repeats its last three telegrams in turn, and two advances are enough: old telegrams are used for ever.",
                "main telegrams are lost in any cycle; the transmitter loops from any; run 2",
            ),
            &layout,
            Small { run: 2, ..RUN_1 },
            looping(3, 2 * Small::USUAL.life),
            LOOPS,
            loops,
        ),
    ]
}

fn wrapped() -> Vec<Entry> {
    // 16 telegrams a cycle: the counter goes round in 16 cycles.
    let remembered = Small { window: 32, life: 20, fixed_life: 20, memory: 20, ..RUN_1 };
    let unheard = |keeps| Environment {
        motion: Motion::Standing,
        transmitter: Transmitter::FreezesUnheard,
        in_a_cycle: 16,
        ..looping(1, keeps)
    };
    let standing = Layout::digital(&[1, 3], &[1, 3]);
    vec![
        model(
            (
                "permitted-wrap",
                "A transmitter freezes when more than a window of its telegrams was lost, after a loss as long as the counter's range or any \
                 other: a number 256 further on is taken for the next one, and never used after its life.",
                "the train stands; 16 telegrams a cycle, the last of which is heard or lost; memory and life 20 cycles, a wrap 16",
            ),
            &standing,
            remembered,
            unheard(20),
            SOUND,
            Purpose::Safe(&[Sight::OldPoint, Sight::Wrapped]),
        ),
        model(
            (
                "permitted-wrap-at-once",
                "The same, and a withdrawn stretch is kept for a cycle less than the life of a telegram: more is permitted than the ground \
                 allows.",
                "the same; a withdrawn stretch is kept for the life less 1 cycle",
            ),
            &standing,
            remembered,
            unheard(19),
            NO_POINT_LIFE,
            Purpose::Hazard(&["stop-point-life"]),
        ),
    ]
}
