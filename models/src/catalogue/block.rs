//! The models of block counting.

use crate::block::device::{Real, WithoutComparison};
use crate::block::fault::{Faults, Kind};
use crate::block::single::{Beyond, Purpose, Single};
use crate::check::Entry;

mod border;
mod shared;

use shared::{
    COUNT, CUTS, FAULTS, NO_FAULT, NOT_APART, NOT_COVERED, NOT_HEARD_BY_ONE, NOT_LIVE, NOT_WHOLE, ONE_FAULT, REVERSING,
    SINGLE_FAULTS, USUAL, about,
};

/// One block and two: without faults, with one, with two, and with what the assumptions exclude.
pub(super) fn entries() -> Vec<Entry> {
    let mut entries = safe();
    entries.extend(hazards());
    entries.extend(events());
    entries.extend(border::entries());
    entries
}

fn safe() -> Vec<Entry> {
    let undisturbed = |name, sections, trains| {
        let about = about(
            name,
            "Whatever trains enter, run and leave, each longer than a section: the count is their number, no fault is \
             latched, and no section with a head or a tail is reported free.",
            "no fault; resets with the right number at any time",
            COUNT,
            NO_FAULT,
            &[],
        );
        Entry::new(about, Single::usual(Real, sections, trains, 0))
    };
    let single_fault = |name, sections, trains| {
        let about = about(
            name,
            "With any one faulty component, which fails whenever it likes, no section with a head or a tail is reported free.",
            "one component at most is faulty, and free to fail in every cycle; resets with the right number at any time",
            COUNT,
            ONE_FAULT,
            FAULTS,
        );
        Entry::new(about, Single::usual(Real, sections, trains, 1))
    };
    vec![
        undisturbed("block-3x2", 3, 2),
        undisturbed("block-4x2", 4, 2),
        undisturbed("block-3x3", 3, 3),
        single_fault("block-fault-3x2", 3, 2),
        single_fault("block-fault-4x2", 4, 2),
        single_fault("block-fault-3x3", 3, 3),
        single_fault("block-fault-5x3", 5, 3),
        Entry::new(
            about(
                "block-fault-long-trains",
                "The same with trains that reach two sections behind their heads.",
                "one component at most is faulty, and free to fail in every cycle; resets with the right number at any time",
                COUNT,
                ONE_FAULT,
                FAULTS,
            ),
            Single { tail: 2, hold: 2, ..Single::usual(Real, 4, 2, 1) },
        ),
    ]
}

fn hazards() -> Vec<Entry> {
    let cut_sets = |name, sections, trains| {
        let about = about(
            name,
            "Two faults can reach a section with a train that is reported free: the minimal cut sets of one and two faults, \
             and what each single fault does.",
            "two components at most are faulty, and free to fail in every cycle; resets with the right number at any time",
            CUTS,
            USUAL,
            SINGLE_FAULTS,
        );
        let purpose = Purpose::CutSets(SINGLE_FAULTS);
        Entry::new(about, Single { purpose, ..Single::usual(Real, sections, trains, 2) })
    };
    let no_hold =
        Single { hold: 0, purpose: Purpose::Hazard(&["hold-covers-train", "BLK-5"]), ..Single::usual(Real, 3, 2, 0) };
    let believing = Single { purpose: Purpose::Hazard(&["BLK-2"]), ..Single::usual(WithoutComparison, 3, 2, 1) };
    let stuck = Faults::single(Kind::CheckInStuckOn, 3, 1);
    let missed = Faults::single(Kind::Missed, 3, 1);
    let close = |faults| Single { apart: 1, faults, ..Single::usual(Real, 3, 2, 0) };
    let both: Vec<_> = stuck.iter().flat_map(|one| missed.iter().map(|other| one.and(*other))).collect();
    let purpose = Purpose::Hazard(&["entries-apart"]);
    vec![
        cut_sets("block-two-faults", 3, 2),
        cut_sets("block-two-faults-4x2", 4, 2),
        cut_sets("block-two-faults-3x3", 3, 3),
        Entry::new(
            about(
                "block-no-hold",
                "Without a tail hold a tail is reported free, with no fault at all.",
                "no fault; the machine holds nothing behind a head",
                &["BLK-5", "T-BLK-4"],
                NOT_COVERED,
                &["hold-covers-train"],
            ),
            no_hold,
        ),
        Entry::new(
            about(
                "block-no-comparison",
                "A machine that does not compare the count with its detectors reports a train free on a single fault.",
                "one component at most is faulty; another machine than the kernel's",
                &["BLK-2", "T-BLK-1"],
                ONE_FAULT,
                FAULTS,
            ),
            believing,
        ),
        Entry::new(
            about(
                "block-close-entries",
                "Trains that enter closer together than the pass time, over a check-in that is stuck on, are not all counted; \
                 with a missed detection one is reported free.",
                "a check-in stuck on and a missed detection; entries in any two cycles",
                &["BLK-3", "T-BLK-3"],
                NOT_APART,
                &["entries-apart"],
            ),
            Single { purpose, ..close(both) },
        ),
        Entry::new(
            about(
                "block-close-entries-one-fault",
                "Trains that enter closer together than the pass time, over a check-in that is stuck on: without a second fault \
                 none is reported free.",
                "a check-in stuck on; entries in any two cycles",
                &["BLK-3", "T-BLK-3"],
                NOT_APART,
                &["entries-apart"],
            ),
            close(stuck),
        ),
    ]
}

fn events() -> Vec<Entry> {
    let with = |beyond, budget, purpose| Single { beyond, purpose, ..Single::usual(Real, 3, 2, budget) };
    let events = [
        (
            "block-dead-transmitter",
            "A train that enters with a dead transmitter is neither counted nor detected: one cause, and it is reported free.",
            "no fault but one dead transmitter, from any time on",
            (NOT_LIVE, &["live-transmitter"] as &[_]),
            with(Beyond::DeadTransmitter, 0, Purpose::Hazard(&["live-transmitter"])),
        ),
        (
            "block-split-train",
            "A rear part that a train leaves behind is neither counted nor detected, and reported free once the train is gone.",
            "no fault but one train that splits anywhere",
            (NOT_WHOLE, &["train-whole"]),
            with(Beyond::SplitTrain, 0, Purpose::Hazard(&["train-whole"])),
        ),
        (
            "block-reversing-over-entry",
            "A train that reverses out over the entry is counted in twice: all occupied until a reset, also with one more fault.",
            "one component at most is faulty; trains reverse out over the entry",
            (ONE_FAULT, FAULTS),
            with(Beyond::ReversingOverEntry, 1, Purpose::Safe),
        ),
        (
            "block-reversing-over-exit",
            "A train that reverses in over the exit is counted out twice; with one missed detection it is reported free.",
            "a missed detection; trains reverse in over the exit",
            (REVERSING, &["no-reversing-over-exit", "independent-detectors"]),
            Single {
                faults: Faults::single(Kind::Missed, 3, 1),
                ..with(Beyond::ReversingOverExit, 0, Purpose::Hazard(&["no-reversing-over-exit"]))
            },
        ),
        (
            "block-power-loss",
            "A machine that loses its memory in the middle of trains reports everything occupied until a reset.",
            "one component at most is faulty; the machine starts afresh in any cycle",
            (ONE_FAULT, FAULTS),
            with(Beyond::PowerLoss, 1, Purpose::Safe),
        ),
        (
            "block-standing-silent",
            "A head that stands on a border and is heard by no detector: no section with a train is reported free.",
            "no fault; heads stop on borders for any time, unheard",
            (NOT_HEARD_BY_ONE, &["heard-by-one"]),
            with(Beyond::SilentBorders, 0, Purpose::Safe),
        ),
        (
            "block-standing-loud",
            "A head that stands on a border and is heard by both detectors: no section with a train is reported free.",
            "no fault; heads stop on borders for any time, heard twice",
            (NOT_HEARD_BY_ONE, &["heard-by-one"]),
            with(Beyond::LoudBorders, 0, Purpose::Safe),
        ),
        (
            "block-standing-silent-phantom",
            "A head that no detector hears on a border, and one phantom elsewhere: a single fault, and it is reported free.",
            "one phantom detector; heads stop on borders for any time, unheard",
            (NOT_HEARD_BY_ONE, &["heard-by-one", "independent-detectors"]),
            Single {
                faults: Faults::single(Kind::Phantom, 3, 1),
                ..with(Beyond::SilentBorders, 0, Purpose::Hazard(&["heard-by-one"]))
            },
        ),
        (
            "block-standing-loud-missed",
            "A head that two detectors hear on a border makes up for another one that is missed: a single fault, and a train is \
             reported free.",
            "one deaf detector; heads stop on borders for any time, heard twice",
            (NOT_HEARD_BY_ONE, &["heard-by-one", "independent-detectors"]),
            Single {
                faults: Faults::single(Kind::Missed, 3, 1),
                ..with(Beyond::LoudBorders, 0, Purpose::Hazard(&["heard-by-one"]))
            },
        ),
    ];
    let entry = |(name, statement, environment, (in_force, lifted), model)| {
        Entry::new(about(name, statement, environment, COUNT, in_force, lifted), model)
    };
    events.into_iter().map(entry).collect()
}
