//! The faults that were found in the kernel of November 22 (the sessions of the same names), each with the weapons that are enough to
//! find it and the accident that it ends in. While a fault is there the adversary must find it; once it is mended it must not.

use super::arsenal::Arsenal;
use super::judge::Family;

/// A fault.
#[derive(Clone, Copy, Debug)]
pub struct Fault {
    /// Its name.
    pub name: &'static str,
    /// The session that showed it first.
    pub session: &'static str,
    /// What must hold instead.
    pub must: &'static str,
    /// The weapons that are enough.
    pub arsenal: Arsenal,
    /// The accidents in which it ends.
    pub ends_in: &'static [Family],
    /// The station on which it is looked for.
    pub layout: &'static str,
    /// A seed with which it was found soon.
    pub seed: u64,
    /// Whether the rules are mended: then it is found no more.
    pub mended: bool,
}

const TELEGRAMS: Arsenal = Arsenal { drivers: [true, false], ..Arsenal::RUNNING };
const LOOP: &str = "passing-loop";

/// The last of them with the old rule put back: trains do not look at a telegram's direction of travel.
pub const UNFACED: Arsenal = Arsenal { face: 10, faces: false, ..TELEGRAMS };

/// The faults.
pub const KNOWN: &[Fault] = &[
    Fault {
        name: "release by false occupancy",
        session: "release-by-false-occupancy",
        must: "circuits that are falsely occupied, any number at once, cost availability and never safety",
        arsenal: Arsenal { many: 12, point: 12, ..TELEGRAMS },
        ends_in: &[Family::Derailment, Family::Collision, Family::Authority],
        layout: LOOP,
        seed: 18,
        mended: true,
    },
    Fault {
        name: "bobbing circuit",
        session: "bobbing-circuit",
        must: "one circuit that is falsely occupied costs availability and never safety",
        arsenal: Arsenal { one: 16, point: 12, ..TELEGRAMS },
        ends_in: &[Family::Derailment, Family::Collision, Family::Authority],
        layout: LOOP,
        seed: 38,
        mended: true,
    },
    Fault {
        name: "withdrawn route grants again",
        session: "withdrawn-route-grants-again",
        must: "authority that was taken away comes back by a new request only",
        arsenal: Arsenal { withdraw: 10, ..TELEGRAMS },
        ends_in: &[Family::Unasked],
        layout: LOOP,
        seed: 11,
        mended: true,
    },
    Fault {
        name: "point leaves after an individual command",
        session: "point-leaves-after-individual-command",
        must: "a point that was driven is undetected until it has stood detected for as long as a stroke can take to show",
        arsenal: Arsenal { point: 30, deaf: 10, slow_points: true, ..TELEGRAMS },
        ends_in: &[Family::Derailment],
        layout: LOOP,
        seed: 6,
        mended: true,
    },
    Fault {
        name: "speed of the tail",
        session: "speed-of-the-tail",
        must: "no telegram is above the limit of a route under any part of its own train",
        arsenal: TELEGRAMS,
        ends_in: &[Family::Speed],
        layout: LOOP,
        seed: 40,
        mended: true,
    },
    Fault {
        name: "restriction under the tail",
        session: "restriction-under-the-tail",
        must: "no telegram is above a restriction under any part of its own train",
        arsenal: Arsenal { restrict: 6, ..TELEGRAMS },
        ends_in: &[Family::Restriction],
        layout: LOOP,
        seed: 4,
        mended: true,
    },
    Fault {
        name: "consent ended",
        session: "consent-ended-sender",
        must: "nothing is set, and nothing granted, out onto a line whose consent is older than a telegram's life",
        arsenal: Arsenal { neighbour_work: 10, line: 40, ..TELEGRAMS },
        ends_in: &[Family::Worker, Family::Collision, Family::Authority],
        layout: LOOP,
        seed: 20,
        mended: true,
    },
    Fault {
        name: "turned while occupied after a restart",
        session: "turned-while-occupied-after-restart",
        must: "the direction of an occupied line is given to nobody",
        arsenal: Arsenal { line: 60, restart: 8, ..TELEGRAMS },
        ends_in: &[Family::Collision, Family::Authority],
        layout: LOOP,
        seed: 27,
        mended: true,
    },
    Fault {
        name: "restart forgets the approach",
        session: "restart-forgets-approach",
        must: "after a start nothing moves that a train may still count on, until that train must have stopped",
        arsenal: Arsenal { restart: 20, point: 20, ..TELEGRAMS },
        ends_in: &[Family::Derailment],
        layout: LOOP,
        seed: 1,
        mended: true,
    },
    Fault {
        name: "telegram against the direction",
        session: "telegram-against-the-direction",
        must: "a telegram says for which direction of travel it is, and a train that faces the other way has none",
        arsenal: Arsenal { face: 10, ..TELEGRAMS },
        ends_in: &[Family::Unasked, Family::Derailment],
        layout: LOOP,
        seed: 1,
        mended: true,
    },
];
