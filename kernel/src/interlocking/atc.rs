//! ATC: from the shared table to the stop circuit, the speed code and the telegram of each circuit.

use super::code::SpeedCode;
use super::layout::Layout;
use super::set::{CircuitId, CircuitSet, SegmentSet};
use super::signal::Grant;
use super::size::{Size, Small};
use super::table::Contents;
use crate::distance::Metres;
use crate::heading::Heading;

/// How many grants in a row one telegram looks over: a train learns at most so many routes or segments ahead.
pub const MAX_LINKS: usize = 4;

/// What the telegram of one circuit tells the train there.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Movement<Z: Size = Small> {
    /// The last circuit that the train may enter; its own if it must stay there.
    pub stop: CircuitId,
    /// The direction of travel in which it may leave its circuit; none if it must stay there. A train that faces the other way must stop.
    pub heading: Option<Heading>,
    /// The highest speed code.
    pub speed: SpeedCode,
    /// The circuits that the train may enter. Their transmitters are held on for it.
    pub hold: CircuitSet<Z>,
}

impl<Z: Size> Movement<Z> {
    /// The telegram that stops a train in `circuit`.
    pub const fn stop_in(circuit: CircuitId) -> Self {
        Self { stop: circuit, heading: None, speed: SpeedCode::STOP, hold: CircuitSet::EMPTY }
    }

    /// Whether a train may leave the circuit at all.
    pub const fn is_open(&self) -> bool {
        self.heading.is_some()
    }

    /// What a train in `circuit` may make of this telegram if it faces `faces`; `None` is a train that does not know.
    #[must_use]
    pub fn facing(self, circuit: CircuitId, faces: Option<Heading>) -> Self {
        //= spec/interlocking.md#atc-11-facing
        //# A train MUST take a telegram for another direction of travel than the one it faces, and any telegram while it does not know which way it faces, as a stop telegram.
        if self.heading.is_some() && self.heading == faces { self } else { Self::stop_in(circuit) }
    }
}

/// What a train whose front is, or will be, in `here` may run over next, by one route or on plain line, and the segments to which that leads;
/// `to` are those to which the route leads that ends in `here`. `Grant::NONE` if that is nothing, or if two trains could think that it is
/// meant for them.
#[inline]
pub fn connect<const R: usize, const P: usize, const N: usize, const S: usize, Z: Size>(
    layout: &Layout<R, P, N, S, Z>,
    contents: &Contents<R, Z>,
    (here, to): (CircuitSet<Z>, SegmentSet<Z>),
) -> (Grant<Z>, SegmentSet<Z>) {
    //= spec/interlocking.md#atc-2-one-train
    //# Where more than one grant begins at a circuit, none of them MUST be used.
    let mut found = 0_u8;
    let mut link = (Grant::NONE, SegmentSet::EMPTY);
    let nowhere = here.is_empty();
    for (route, grant) in layout.plan().routes.iter().zip(&contents.grants) {
        // Behind a route out there is the line, and no other route.
        if to.is_empty() && grant.train == here && !nowhere {
            found = found.saturating_add(1);
            link = (*grant, route.to.only_if(grant.complete));
        }
    }
    for number in 0..S {
        let ahead = on_line(layout, contents, number, (here, to));
        if ahead.train == here && !nowhere {
            found = found.saturating_add(1);
            link = (ahead, SegmentSet::EMPTY);
        }
    }
    if found == 1 { link } else { (Grant::NONE, SegmentSet::EMPTY) }
}

/// The circuits where a grant may begin. A train anywhere else is told to stop, without a look at every grant.
#[inline]
pub fn begins<const R: usize, const P: usize, const N: usize, const S: usize, Z: Size>(
    layout: &Layout<R, P, N, S, Z>,
    contents: &Contents<R, Z>,
) -> CircuitSet<Z> {
    let mut begins = CircuitSet::EMPTY;
    for grant in &contents.grants {
        begins = begins.or(grant.train);
    }
    for segment in &layout.plan().segments {
        begins = begins.or(segment.all());
    }
    begins.and(contents.occupied)
}

/// What a train in `here` may run over in segment `number`: the free circuits ahead of it, in the segment's direction. From the throat that
/// is a train which a route to the segment has brought there.
#[inline]
fn on_line<const R: usize, const P: usize, const N: usize, const S: usize, Z: Size>(
    layout: &Layout<R, P, N, S, Z>,
    contents: &Contents<R, Z>,
    number: usize,
    (here, to): (CircuitSet<Z>, SegmentSet<Z>),
) -> Grant<Z> {
    //= spec/interlocking.md#atc-3-plain-line
    //# On plain line a train MUST be granted only the free and unblocked circuits ahead of it in the direction that the segment has, up to the next that is not.
    let segment = &layout.plan().segments[number];
    let (toward, away) = (contents.toward.has_number(number), contents.away.has_number(number));
    //= spec/interlocking.md#atc-13-out-to-the-line
    //# From the throat, plain line MUST be granted only behind a route to that line: one whose grant reaches the throat, or one that the train in the throat has entered in order and whose points there are sound.
    let throat = segment.throat.only_if(away && to.has_number(number));
    if !(toward || away) || here.is_empty() || !segment.all().or(throat).contains(here) {
        return Grant::NONE;
    }
    let closed = contents.occupied.or(contents.blocked);
    let heading = if away { segment.outward } else { segment.outward.opposite() };
    let mut ahead = Grant { heading, speed: SpeedCode::MOST, ..Grant::NONE };
    // Outwards, a train comes from the throat or from a circuit of the segment.
    let mut open = !throat.is_empty() && throat == here;
    ahead.complete = open;
    for (place, circuit) in (0_u8..).zip(Z::used(&segment.circuits, segment.length)) {
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
    let reach = Z::used(&segment.circuits, segment.length).len();
    for back in 0..reach {
        let place = reach - 1 - back;
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
fn extend<Z: Size>(grant: Grant<Z>, circuit: CircuitSet<Z>, closed: CircuitSet<Z>, open: &mut bool) -> Grant<Z> {
    if *open && !circuit.meets(closed) {
        return Grant { circuits: grant.circuits.or(circuit), last: circuit, ..grant };
    }
    let complete = grant.complete && !*open;
    *open = false;
    Grant { complete, ..grant }
}

/// The telegram of one circuit.
#[inline]
pub fn movement<const R: usize, const P: usize, const N: usize, const S: usize, Z: Size>(
    layout: &Layout<R, P, N, S, Z>,
    contents: &Contents<R, Z>,
    circuit: CircuitId,
) -> Movement<Z> {
    //= spec/interlocking.md#atc-7-stop-telegram
    //# The telegram of a circuit MUST be a stop telegram unless a train occupies it and a circuit ahead is granted to that train.
    let mut here = circuit.alone();
    let mut hold = CircuitSet::EMPTY;
    let mut speed = SpeedCode::MOST;
    let mut more = contents.occupied.has(circuit);
    let mut heading = None;
    let mut to = SegmentSet::EMPTY;
    for _ in 0..MAX_LINKS {
        if more {
            //= spec/interlocking.md#atc-10-direction-of-travel
            //# A telegram MUST say for which direction of travel it is, and tell a train of no grant for the other one.
            let (link, leads) = connect(layout, contents, (here, to));
            let same = heading.is_none() || heading == Some(link.heading);
            more = link.complete && same;
            to = leads;
            if !link.train.is_empty() && same {
                heading = Some(link.heading);
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
    Movement { stop, heading, speed, hold }
}

/// The telegram of one circuit from what was read of the table, if it could be read; `begins` is what [`begins()`] says of it.
#[inline]
pub fn telegram<const R: usize, const P: usize, const N: usize, const S: usize, Z: Size>(
    layout: &Layout<R, P, N, S, Z>,
    contents: Option<&Contents<R, Z>>,
    begins: CircuitSet<Z>,
    circuit: CircuitId,
) -> Movement<Z> {
    //= spec/interlocking.md#atc-6-unreadable-table
    //# A table that cannot be read MUST make every telegram a stop telegram.
    match contents {
        Some(contents) if begins.has(circuit) => movement(layout, contents, circuit),
        _ => Movement::stop_in(circuit),
    }
}

/// The circuits in which this device sends nothing, because the neighbour's device speaks there; `contents` is what was read of the table.
#[inline]
pub fn silent<const R: usize, const P: usize, const N: usize, const S: usize, Z: Size>(
    layout: &Layout<R, P, N, S, Z>,
    contents: Option<&Contents<R, Z>>,
) -> CircuitSet<Z> {
    //= spec/interlocking.md#atc-12-border
    //# In a circuit of plain line that the neighbour's device sees too, a device MUST send telegrams only while the direction is towards its own station.
    let toward = match contents {
        Some(contents) => contents.toward,
        None => SegmentSet::EMPTY,
    };
    let mut silent = CircuitSet::EMPTY;
    for (number, segment) in layout.plan().segments.iter().enumerate() {
        let sent = toward.has_number(number);
        silent = silent.or(segment.shared_circuits().only_if(!sent));
    }
    silent
}

/// The highest code from which a train stops within the lengths of `circuits`.
#[inline]
fn stopping_within<const R: usize, const P: usize, const N: usize, const S: usize, Z: Size>(
    layout: &Layout<R, P, N, S, Z>,
    circuits: CircuitSet<Z>,
) -> SpeedCode {
    let plan = layout.plan();
    let mut distance = 0_u32;
    for (number, length) in plan.lengths.iter().enumerate() {
        if circuits.has_number(number) {
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
