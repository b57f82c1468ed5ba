//! ATC: from the shared table to the stop circuit, the speed code and the telegram of each circuit.

use super::layout::{Layout, SpeedCode};
use super::set::{CircuitId, CircuitSet, SegmentSet};
use super::signal::Grant;
use super::table::Contents;
use crate::distance::Metres;

/// How many grants in a row one telegram looks over: a train learns at most so many routes or segments ahead.
pub const MAX_LINKS: usize = 4;

/// What the telegram of one circuit tells the train there.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Movement {
    /// The last circuit that the train may enter; its own if it must stay there.
    pub stop: CircuitId,
    /// Whether it may leave its circuit at all.
    pub open: bool,
    /// The highest speed code.
    pub speed: SpeedCode,
    /// The circuits that the train may enter. Their transmitters are held on for it.
    pub hold: CircuitSet,
}

impl Movement {
    /// The telegram that stops a train in `circuit`.
    pub const fn stop_in(circuit: CircuitId) -> Self {
        Self { stop: circuit, open: false, speed: SpeedCode::STOP, hold: CircuitSet::EMPTY }
    }
}

/// What a train whose front is, or will be, in `here` may run over next: by one route, or on plain line. `Grant::NONE` if that is nothing,
/// or if two trains could think that it is meant for them.
#[inline]
pub fn connect<const R: usize, const P: usize, const N: usize, const S: usize>(
    layout: &Layout<R, P, N, S>,
    contents: &Contents<R>,
    here: CircuitSet,
) -> Grant {
    //= spec/interlocking.md#atc-2-one-train
    //# Where more than one grant begins at a circuit, none of them MUST be used.
    let mut found = 0_u8;
    let mut link = Grant::NONE;
    let mut take = |grant: Grant| {
        if grant.train == here && !here.is_empty() {
            found = found.saturating_add(1);
            link = grant;
        }
    };
    for grant in &contents.grants {
        take(*grant);
    }
    for number in 0..S {
        take(on_line(layout, contents, number, here));
    }
    if found == 1 { link } else { Grant::NONE }
}

/// The circuits where a grant may begin. A train anywhere else is told to stop, without a look at every grant.
#[inline]
pub fn begins<const R: usize, const P: usize, const N: usize, const S: usize>(
    layout: &Layout<R, P, N, S>,
    contents: &Contents<R>,
) -> CircuitSet {
    let mut begins = CircuitSet::EMPTY;
    for grant in &contents.grants {
        begins = begins.or(grant.train);
    }
    for segment in &layout.plan().segments {
        begins = begins.or(segment.all()).or(segment.throat);
    }
    begins.and(contents.occupied)
}

/// What a train in `here` may run over in segment `number`: the free circuits ahead of it, in the segment's direction.
#[inline]
fn on_line<const R: usize, const P: usize, const N: usize, const S: usize>(
    layout: &Layout<R, P, N, S>,
    contents: &Contents<R>,
    number: usize,
    here: CircuitSet,
) -> Grant {
    //= spec/interlocking.md#atc-3-plain-line
    //# On plain line a train MUST be granted only the free and unblocked circuits ahead of it in the direction that the segment has, up to the next that is not.
    let segment = &layout.plan().segments[number];
    let (toward, away) = (contents.toward.meets(SegmentSet::nth(number)), contents.away.meets(SegmentSet::nth(number)));
    let begins = segment.all().or(segment.throat.only_if(away)).contains(here) && !here.is_empty();
    if !begins || !(toward || away) {
        return Grant::NONE;
    }
    let closed = contents.occupied.or(contents.blocked);
    let mut ahead = Grant { speed: SpeedCode::MOST, ..Grant::NONE };
    // Outwards, a train comes from the throat or from a circuit of the segment.
    let mut open = away && segment.throat == here && !here.is_empty();
    ahead.complete = open;
    for (place, circuit) in (0_u8..).zip(&segment.circuits) {
        if away && place < segment.length {
            if *circuit == here {
                open = true;
                ahead.complete = true;
            } else {
                ahead = extend(ahead, *circuit, closed, &mut open);
            }
        }
    }
    // Inwards, in the other order.
    for back in 0..P {
        let place = P - 1 - back;
        let circuit = segment.circuits[place];
        if toward && !away && place < usize::from(segment.length) {
            if circuit == here {
                open = true;
                ahead.complete = true;
            } else {
                ahead = extend(ahead, circuit, closed, &mut open);
            }
        }
    }
    if ahead.circuits.is_empty() { Grant::NONE } else { Grant { train: here, ..ahead } }
}

/// The grant with one circuit more, if it is open as far as that.
#[inline]
fn extend(grant: Grant, circuit: CircuitSet, closed: CircuitSet, open: &mut bool) -> Grant {
    if *open && !circuit.meets(closed) {
        return Grant { circuits: grant.circuits.or(circuit), last: circuit, ..grant };
    }
    let complete = grant.complete && !*open;
    *open = false;
    Grant { complete, ..grant }
}

/// The telegram of one circuit.
#[inline]
pub fn movement<const R: usize, const P: usize, const N: usize, const S: usize>(
    layout: &Layout<R, P, N, S>,
    contents: &Contents<R>,
    circuit: CircuitId,
) -> Movement {
    //= spec/interlocking.md#atc-7-stop-telegram
    //# The telegram of a circuit MUST be a stop telegram unless a train occupies it and a circuit ahead is granted to that train.
    let mut here = circuit.alone();
    let mut hold = CircuitSet::EMPTY;
    let mut speed = SpeedCode::MOST;
    let mut more = contents.occupied.has(circuit);
    for _ in 0..MAX_LINKS {
        if more {
            let link = connect(layout, contents, here);
            more = link.complete;
            if !link.circuits.is_empty() {
                hold = hold.or(link.circuits);
                speed = speed.or_lower(link.speed);
                here = link.last;
            }
        }
    }
    let Some(stop) = here.first() else { return Movement::stop_in(circuit) };
    if hold.is_empty() {
        return Movement::stop_in(circuit);
    }
    //= spec/interlocking.md#atc-4-speed-code
    //# The speed code MUST NOT be above any limit of a circuit that is granted or that may be under the train, or above the highest code from which a train stops within the circuits that are granted.
    let train = contents.standing.train(layout, contents.occupied, circuit.alone());
    let limit = contents.standing.limits.over(train.or(hold));
    let speed = speed.or_lower(limit).or_lower(stopping_within(layout, hold));
    Movement { stop, open: true, speed, hold }
}

/// The telegram of one circuit from what was read of the table, if it could be read; `begins` is what [`begins()`] says of it.
#[inline]
pub fn telegram<const R: usize, const P: usize, const N: usize, const S: usize>(
    layout: &Layout<R, P, N, S>,
    contents: Option<&Contents<R>>,
    begins: CircuitSet,
    circuit: CircuitId,
) -> Movement {
    //= spec/interlocking.md#atc-6-unreadable-table
    //# A table that cannot be read MUST make every telegram a stop telegram.
    match contents {
        Some(contents) if begins.has(circuit) => movement(layout, contents, circuit),
        _ => Movement::stop_in(circuit),
    }
}

/// The highest code from which a train stops within the lengths of `circuits`.
#[inline]
fn stopping_within<const R: usize, const P: usize, const N: usize, const S: usize>(
    layout: &Layout<R, P, N, S>,
    circuits: CircuitSet,
) -> SpeedCode {
    let plan = layout.plan();
    let mut distance = 0_u32;
    for (number, length) in plan.lengths.iter().enumerate() {
        if circuits.meets(CircuitSet::nth(number)) {
            distance = distance.saturating_add(u32::from(length.0));
        }
    }
    let mut code = SpeedCode::STOP;
    for (number, braking) in (0_u8..).zip(&plan.braking) {
        if *braking < Metres(u16::MAX) && u32::from(braking.0) <= distance {
            code = SpeedCode(number);
        }
    }
    code
}
