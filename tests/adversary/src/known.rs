//! The faults that were found in the kernel of November 22 (the sessions of the same names), each with the weapons that are enough to
//! find it and the accident that it ends in. All are mended. The adversary must find each with the old rule put back
//! (`proofs/runner/tests/old_rules.rs`), and none in the kernel as it is (`tests/tests/adversary.rs`); and so must a model of `models/`.

use super::arsenal::Arsenal;
use super::hunt::Hunt;
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
    /// The old rule, as mutants of `proofs/mutants.toml` that together put it back.
    pub old_rule: &'static [&'static str],
    /// A seed with which it is found soon while the old rule is there.
    pub seed: u64,
    /// The model of `models/` that is red with the old rule, and green without.
    pub model: &'static str,
}

impl Fault {
    /// The hunt for it.
    pub fn hunt(&self) -> Hunt {
        let sought = self.ends_in.to_vec();
        Hunt { seed: self.seed, cycles: CYCLES, episode: EPISODE, arsenal: self.arsenal, sought }
    }
}

/// The cycles in which each of them is found.
pub const CYCLES: u64 = 150_000;

/// The cycles of an episode.
pub const EPISODE: i64 = 12_000;

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
        arsenal: Arsenal { many: 3, point: 12, ..TELEGRAMS },
        ends_in: &[Family::Derailment, Family::Collision, Family::Authority],
        layout: LOOP,
        old_rule: &["ilk-release-without-rear"],
        seed: 18,
        model: "interlocking-loop-falsely-occupied",
    },
    Fault {
        name: "bobbing circuit",
        session: "bobbing-circuit",
        must: "one circuit that is falsely occupied costs availability and never safety",
        arsenal: Arsenal { one: 6, point: 12, pace: 6, ..TELEGRAMS },
        ends_in: &[Family::Derailment, Family::Collision, Family::Authority],
        layout: LOOP,
        old_rule: &["ilk-release-without-rear"],
        seed: 68,
        model: "interlocking-loop-falsely-occupied",
    },
    Fault {
        name: "withdrawn route grants again",
        session: "withdrawn-route-grants-again",
        must: "authority that was taken away comes back by a new request only",
        arsenal: Arsenal { withdraw: 10, ..TELEGRAMS },
        ends_in: &[Family::Unasked],
        layout: LOOP,
        old_rule: &["ilk-withdrawn-in-use-again"],
        seed: 11,
        model: "interlocking-terminus-telegrams",
    },
    Fault {
        name: "point leaves after an individual command",
        session: "point-leaves-after-individual-command",
        must: "a point that was driven is undetected until it has stood detected for as long as a stroke can take to show",
        arsenal: Arsenal { point: 30, deaf: 10, slow_points: true, ..TELEGRAMS },
        ends_in: &[Family::Derailment],
        layout: LOOP,
        old_rule: &["point-settles-at-once"],
        seed: 4,
        model: "interlocking-loop-settling",
    },
    Fault {
        name: "speed of the tail",
        session: "speed-of-the-tail",
        must: "no telegram is above the limit of a route under any part of its own train",
        arsenal: TELEGRAMS,
        ends_in: &[Family::Speed],
        layout: LOOP,
        old_rule: &["speed-of-the-front"],
        seed: 40,
        model: "interlocking-terminus-telegrams",
    },
    Fault {
        name: "restriction under the tail",
        session: "restriction-under-the-tail",
        must: "no telegram is above a restriction under any part of its own train",
        arsenal: Arsenal { restrict: 6, ..TELEGRAMS },
        ends_in: &[Family::Restriction],
        layout: LOOP,
        old_rule: &["speed-of-the-front"],
        seed: 4,
        model: "interlocking-loop-restricted",
    },
    Fault {
        name: "consent ended",
        session: "consent-ended-sender",
        must: "nothing is set, and nothing granted, out onto a line whose consent is older than a telegram's life",
        arsenal: Arsenal { neighbour_work: 10, line: 40, ..TELEGRAMS },
        ends_in: &[Family::Worker, Family::Collision, Family::Authority],
        layout: LOOP,
        old_rule: &["line-set-without-consent", "line-proceed-without-consent", "line-granted-without-consent"],
        seed: 9,
        model: "interlocking-loop-line-blocked-own",
    },
    Fault {
        name: "turned while occupied after a restart",
        session: "turned-while-occupied-after-restart",
        must: "the direction of an occupied line is given to nobody",
        arsenal: Arsenal { line: 60, restart: 8, blind_neighbours: true, ..TELEGRAMS },
        ends_in: &[Family::Collision, Family::Authority],
        layout: LOOP,
        old_rule: &["line-occupied-given", "heading-of-the-line"],
        seed: 74,
        model: "interlocking-line-start",
    },
    Fault {
        name: "restart forgets the approach",
        session: "restart-forgets-approach",
        must: "after a start nothing moves that a train may still count on, until that train must have stopped",
        arsenal: Arsenal { restart: 20, point: 20, ..TELEGRAMS },
        ends_in: &[Family::Derailment],
        layout: LOOP,
        old_rule: &["start-moves"],
        seed: 6,
        model: "interlocking-loop-start",
    },
    Fault {
        name: "restart forgets the driver",
        session: "none: a third reader found it",
        must: "after a start nothing is done ahead of a driver who goes by the signal that he has passed, whatever time he takes",
        arsenal: Arsenal { restart: 2, block: 4, drivers: [false, true], ..Arsenal::RUNNING },
        ends_in: &[Family::Worker, Family::Derailment, Family::Collision],
        layout: LOOP,
        old_rule: &["unswept-forgotten"],
        seed: 3,
        model: "interlocking-loop-restart",
    },
    Fault {
        name: "point leaves among staff",
        session: "none: a fourteenth reader found it",
        must: "no block is confirmed while a point in it may yet leave its position",
        arsenal: Arsenal { point: 30, block: 30, slow_points: true, ..TELEGRAMS },
        ends_in: &[Family::Worker],
        layout: LOOP,
        old_rule: &["blocked-point-unsettled"],
        seed: 1,
        model: "interlocking-loop-settling-blocked",
    },
    Fault {
        name: "telegram against the direction",
        session: "telegram-against-the-direction",
        must: "a telegram says for which direction of travel it is, and a train that faces the other way has none",
        arsenal: Arsenal { face: 10, ..TELEGRAMS },
        ends_in: &[Family::Unasked, Family::Derailment],
        layout: LOOP,
        old_rule: &["heading-of-a-route"],
        seed: 1,
        model: "interlocking-terminus-telegrams",
    },
    Fault {
        name: "granted from the throat",
        session: "none: a second reader found it",
        must: "a train in the throat is granted the line only if a route out has led it there",
        arsenal: Arsenal { withdraw: 20, pace: 10, ..TELEGRAMS },
        ends_in: &[Family::Unasked],
        layout: LOOP,
        // The second takes away a short cut that would hide the first: nobody looks for what begins in the throat.
        old_rule: &["out-whoever", "telegram-to-nobody"],
        seed: 3,
        model: "interlocking-loop-following",
    },
];
