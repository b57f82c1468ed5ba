//! The models of what happens at the border of two sections.

use super::shared::{DISTANCE, NO_FIX, NO_LIMITS, NO_MARGIN, SOUND, WORST, other, ride};
use crate::catalogue::about::about;
use crate::check::Entry;
use crate::permitted::device::FixOfAnyCycle;
use crate::permitted::layout::Layout;
use crate::permitted::ride::{Border, Environment, Fix, Small};
use crate::permitted::{Purpose, Sight};

/// Late telegrams of the section behind, distances to the exit ahead, and a lower limit ahead.
pub(super) fn entries() -> Vec<Entry> {
    let mut entries = distances();
    entries.extend(limits());
    entries
}

const DELAYED: &str = "main telegrams are lost in any cycle; that of the section behind may be completed in the cycle in which the nose passes \
                 the border, and be used a cycle later; distances in any cycle but that one";

const WORDS: &str = "main telegrams are lost in any cycle; that of the section behind may be completed in the cycle in which the nose passes \
                 the border; distances in any cycle";

fn with(border: Border) -> Environment {
    Environment { border, fix: Fix::Any, ..Environment::USUAL }
}

fn distances() -> Vec<Entry> {
    let layout = Layout::digital(&[4, 4, 2], &[8]);
    let margin = |margin| Small { margin, ..Small::USUAL };
    let mixed = |fix_ahead| with(Border::Mixed { cells: 2, fix_ahead });
    let sights = Purpose::Safe(&[Sight::Pattern]);
    vec![
        ride(
            about(
                "permitted-border-no-margin",
                "A main telegram of the section behind is used in the cycle in which the nose passes its exit: the movement of the cycle \
                 is taken off, and without any margin never more is permitted than the ground allows.",
                WORDS,
                DISTANCE,
                SOUND,
            ),
            &layout,
            margin(0),
            with(Border::Crossing),
            sights,
        ),
        other(
            about(
                "permitted-border-fix-of-any-cycle",
                "A device that uses the distance of whatever cycle adds that to the next exit to what the telegram of the last section \
                 allows: more is permitted than the ground allows.",
                "the same; another device than the kernel's",
                DISTANCE,
                SOUND,
            ),
            FixOfAnyCycle,
            &layout,
            margin(2),
            with(Border::Crossing),
            Purpose::Hazard(&["PER-4"]),
        ),
        ride(
            about(
                "permitted-border",
                "A main telegram of the section behind is completed when the nose has just passed its exit, and used a cycle later: with a \
                 margin of how far the nose can have passed the exit by then never above what the ground allows.",
                DELAYED,
                DISTANCE,
                SOUND,
            ),
            &layout,
            margin(1),
            with(Border::Delayed),
            sights,
        ),
        ride(
            about(
                "permitted-border-delayed-no-margin",
                "A main telegram of the section behind is used a cycle after the nose has passed its exit: without a margin more is \
                 permitted than the ground allows, as only the movement of the last cycle is taken off.",
                DELAYED,
                DISTANCE,
                NO_MARGIN,
            ),
            &layout,
            margin(0),
            with(Border::Delayed),
            Purpose::Hazard(&["margin-covers-the-crossing"]),
        ),
        ride(
            about(
                "permitted-border-mixed",
                "In the first cells of a section telegrams of it and of the one behind come in any order, and no distance is measured \
                 there: never above what the ground allows.",
                "main telegrams of both sections in any order, or none, in the first 2 cells; distances elsewhere in any cycle",
                DISTANCE,
                SOUND,
            ),
            &layout,
            margin(2),
            mixed(false),
            sights,
        ),
        ride(
            about(
                "permitted-border-mixed-fix-ahead",
                "In the first cells of a section telegrams of the one behind are still heard, and between two of them the distance to the \
                 exit ahead is measured: more is permitted than the ground allows.",
                "main telegrams of both sections in any order, or none, in the first 2 cells; distances there too, to the exit ahead",
                DISTANCE,
                NO_FIX,
            ),
            &layout,
            margin(2),
            mixed(true),
            Purpose::Hazard(&["fix-of-the-section-heard"]),
        ),
    ]
}

fn limits() -> Vec<Entry> {
    let mut slow = Layout::digital(&[4, 6, 2], &[12]);
    slow.sections[1].limit = 0;
    let limited = |limit_from| {
        let mut layout = slow.clone();
        layout.sections[1].limit_from = limit_from;
        layout
    };
    let brief = Small { fresh: 2, life: 2, memory: 2, ..Small::USUAL };
    let sights = Purpose::Safe(&[Sight::Pattern]);
    vec![
        ride(
            about(
                "permitted-border-limit",
                "A section has a lower limit than the one behind, from as far on as the telegrams of the one behind are used: never above \
                 it.",
                WORDS,
                WORST,
                SOUND,
            ),
            &limited(4),
            brief,
            with(Border::Crossing),
            sights,
        ),
        ride(
            about(
                "permitted-border-limit-at-once",
                "A section has a lower limit than the one behind from the border on: with the last telegram of the one behind more is \
                 permitted.",
                WORDS,
                WORST,
                NO_LIMITS,
            ),
            &limited(3),
            brief,
            with(Border::Crossing),
            Purpose::Hazard(&["limits-reach-over-the-border"]),
        ),
    ]
}
