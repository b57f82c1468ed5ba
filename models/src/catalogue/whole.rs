//! The whole line, and what happens where a condition is not kept.

use super::about::{Conditions, about, all_but};
use crate::check::Entry;
use crate::whole::devices::Times;
use crate::whole::faults::{Kind, request};
use crate::whole::{Purpose, Room, Whole};

/// What all of them assume that do not lift it. That trains obey signals is not among it: their devices brake them.
const ALL: [&str; 14] = [
    "loss-of-shunt-within-clear",
    "release-covers-residual-running",
    "start-outlasts-running",
    "approach-covers-braking",
    "path-complete",
    "points-detect-truly",
    "points-leave-while-driven",
    "neighbour-turns-alike",
    "turn-outlasts-telegrams",
    "views-of-a-line-meet",
    "no-permissive-misread",
    "odometer-bound",
    "stop-point-life",
    "transmitter-does-not-loop",
];

const fn without(place: usize) -> [&'static str; ALL.len() - 1] {
    all_but(ALL, place)
}

const SOUND: Conditions = (&ALL, &[]);
const NO_FILTER: Conditions = (&without(0), &["loss-of-shunt-within-clear"]);
const SHORT_RELEASE: Conditions = (&without(1), &["release-covers-residual-running"]);
const SHORT_START: Conditions = (&without(2), &["start-outlasts-running"]);

const REQUIREMENTS: &[&str] = &[
    "ILK-4", "ILK-6", "ILK-9", "ILK-10", "ILK-25", "ATC-1", "WAY-3", "WAY-4", "WAY-5", "WAY-7", "TRN-1", "TRN-3",
    "TRN-5", "TRN-7", "TRN-11", "TRN-12", "TRN-13", "PER-6", "PER-8", "TEL-6",
];

/// One fault of any kind, anywhere, in any cycle.
const ONE: Room = Room { kinds: &Kind::ALL, faults: 1, together: 1, requests: &[], asked: &EAST, asks: 0 };
/// Staff ask twice for anything.
const STAFF: Room = Room { kinds: &[], faults: 0, together: 0, requests: &request::ALL, asked: &EAST, asks: 2 };
/// Trains come to the eastern station and leave it; the western one is alike.
const EAST: [u8; 1] = [1];
/// To drive the point.
const POINTS: &[u8] = &[request::DRIVE, request::DRIVE + 1];
/// To set a route, and to drive the point.
const SETS: &[u8] =
    &[request::SET, request::SET + 1, request::SET + 2, request::SET + 3, request::DRIVE, request::DRIVE + 1];
/// To withdraw a route in, and to drive the point.
const WITHDRAWALS: &[u8] = &[request::WITHDRAW, request::WITHDRAW + 1, request::DRIVE, request::DRIVE + 1];

/// One fault of this kind, and staff ask once.
const fn one(kinds: &'static [Kind], requests: &'static [u8]) -> Room {
    Room { kinds, requests, asks: 1, ..ONE }
}

fn entry<const T: usize>(
    (name, statement): (&'static str, &str),
    conditions: Conditions,
    times: Times,
    room: Room,
    purpose: Purpose,
) -> Entry {
    let begun = match room.faults {
        0 => "nothing fails".to_owned(),
        faults => format!("{faults} fault begins in any cycle, and lasts for up to 16 ({})", room.words()),
    };
    let asked = match room.asks {
        0 => "staff ask for nothing".to_owned(),
        asks => {
            format!(
                "staff ask the eastern station {asks} times, in any cycle, for any of {} things",
                room.requests.len()
            )
        }
    };
    let environment = format!("a dispatcher sends trains to and fro for ever; {begun}; {asked}");
    Entry::new(about(name, statement, &environment, REQUIREMENTS, conditions), Whole::<T>::new(times, room, purpose))
}

pub(super) fn entries() -> Vec<Entry> {
    let sound = |named, room| entry::<2>(named, SOUND, Times::SOUND, room, Purpose::Safe);
    let hazard = |named, conditions: Conditions, times, room| {
        entry::<2>(named, conditions, times, room, Purpose::Hazard(conditions.1))
    };
    vec![
        sound(
            (
                "whole-line",
                "Two trains and two stations, each with its whole device, from rail to brake: with any one fault of 11 kinds no trains meet, none \
                 derails, and none passes its signal.",
            ),
            ONE,
        ),
        entry::<3>(
            (
                "whole-line-three",
                "Three trains and two stations, each with its whole device: with any one fault of 11 kinds no trains \
                 meet, none derails, and none passes its signal.",
            ),
            SOUND,
            Times::SOUND,
            ONE,
            Purpose::Safe,
        ),
        sound(
            (
                "whole-line-staff",
                "Two trains and two stations with their whole devices: whatever two things of 13 staff ask for, no \
                 trains meet, none derails, and none passes its signal.",
            ),
            STAFF,
        ),
        sound(
            (
                "whole-line-lost",
                "Two trains and two stations with their whole devices: a train is lost for a cycle, staff ask for \
                 one thing of 13, and there is no harm.",
            ),
            one(&[Kind::LostShunt], &request::ALL),
        ),
        sound(
            (
                "whole-line-start",
                "Two trains and two stations with their whole devices: a station starts again, staff set a route or \
                 drive a point, and there is no harm.",
            ),
            one(&[Kind::StationStarts], SETS),
        ),
        hazard(
            (
                "whole-line-no-filter",
                "A circuit counts as clear at once: a train is lost for a cycle, and a point is driven under it.",
            ),
            NO_FILTER,
            Times { clear: 1, ..Times::SOUND },
            one(&[Kind::LostShunt], POINTS),
        ),
        hazard(
            (
                "whole-line-short-release",
                "A route is released a cycle after it was withdrawn: a point is driven before a train that cannot \
                 stop.",
            ),
            SHORT_RELEASE,
            Times { release: 1, residual: 0, loss: 0, ..Times::SOUND },
            Room { requests: WITHDRAWALS, ..STAFF },
        ),
        hazard(
            (
                "whole-line-short-start",
                "A device acts a cycle after its start: a point is driven before a train that cannot stop.",
            ),
            SHORT_START,
            Times { start: 1, ..Times::SOUND },
            one(&[Kind::StationStarts], POINTS),
        ),
    ]
}
