//! Layouts as far as the ATC looks at them, and what follows what on plain line.

use super::any::{any_circuits, any_heading};
use crate::engine::any_byte;
use atc_kernel::interlocking::{CircuitSet, Contents, Element, Layout, Plan, Route, Segment, SegmentSet, Standing};
use atc_kernel::time::Ticks;

pub(super) const ROUTES: usize = 2;
/// 2 for Kani, which has no answer for 4 in its time.
pub(super) const PATH: usize = if cfg!(kani) { 2 } else { 4 };
pub(super) const SEGMENTS: usize = 2;

pub const BOUND: &str = "2 routes of up to 4 circuits, 32 circuits, 2 segments of up to 4 circuits";

pub(super) const UNDER_KANI: &str = "2 routes of up to 2 circuits, 32 circuits, 2 segments of up to 2 circuits";

pub(super) type Line = Layout<ROUTES, PATH, 0, SEGMENTS>;

/// Any route, as far as grants and segments look at it.
fn any_path<E: crate::Engine + ?Sized>(e: &mut E, first: u16) -> Route<PATH> {
    let mut place = first;
    let path = core::array::from_fn(|_| {
        let circuits = any_circuits(e, "circuit of a place (bits)", place..=place);
        place = place.wrapping_shl(1);
        Element { circuits, ..Element::NONE }
    });
    let timed = Ticks(1);
    Route {
        heading: any_heading(e, "heading (odd: right)"),
        path,
        length: any_byte(e, "length (places)", 1..=3),
        to: SegmentSet::from_bits(any_byte(e, "segments that it leads to (bits)", 0..=2) & 3),
        drive: timed,
        release: timed,
        stay: timed,
        ..Route::NONE
    }
}

/// Any layout, as far as the ATC looks at it.
pub(super) fn any_line<E: crate::Engine + ?Sized>(e: &mut E) -> Option<Line> {
    let mut first = 1 << 1;
    let routes = core::array::from_fn(|_| {
        let route = any_path(e, first);
        first <<= 3;
        route
    });
    let mut place = 1 << 12;
    let segments = core::array::from_fn(|_| Segment {
        circuits: core::array::from_fn(|_| {
            place <<= 1;
            any_circuits(e, "circuit of a segment (bits)", place..=place)
        }),
        length: any_byte(e, "length of a segment (circuits)", 0..=3),
        throat: any_circuits(e, "throat (bits)", 8..=8),
        outward: any_heading(e, "direction out to a segment (odd: right)"),
        shared: any_byte(e, "circuits that the neighbour sees too", 0..=1),
    });
    let plan = Plan { routes, segments, clear: 1, turn: Ticks(1), ..Plan::EMPTY };
    let layout = Layout::with_what_proofs_need(plan).ok();
    e.assume(layout.is_some());
    layout
}

/// How many circuits a segment has.
fn length_of(segment: &Segment<PATH>) -> usize {
    let length = usize::from(segment.length);
    if length < PATH { length } else { PATH }
}

/// The place of `circuit` in a segment, the one next to the station first; none if it is not there.
fn place_of(segment: &Segment<PATH>, circuit: CircuitSet) -> Option<usize> {
    let mut found = None;
    for place in 0..PATH {
        if place < length_of(segment) && segment.circuits[place].bits() == circuit.bits() {
            found = Some(place);
        }
    }
    found
}

/// How many circuits of a segment a train in `here` has passed in the direction of the segment, the own one included; none if it is not on its way
/// there, from the throat by a route to one of `to`.
pub(super) fn passed(
    line: &Line,
    contents: &Contents<ROUTES>,
    number: usize,
    here: CircuitSet,
    to: SegmentSet,
) -> Option<usize> {
    let segment = &line.plan().segments[number];
    let length = length_of(segment);
    let away = contents.away.bits() >> number & 1 == 1;
    match place_of(segment, here) {
        Some(place) if away => Some(place + 1),
        Some(place) if contents.toward.bits() >> number & 1 == 1 => Some(length - place),
        None if away && segment.throat.bits() == here.bits() && to.bits() >> number & 1 == 1 => Some(0),
        _ => None,
    }
}

/// The circuit number `step` of a segment, counted in its direction; none if there is none.
pub(super) fn in_direction(line: &Line, contents: &Contents<ROUTES>, number: usize, step: usize) -> u64 {
    let segment = &line.plan().segments[number];
    let length = length_of(segment);
    let away = contents.away.bits() >> number & 1 == 1;
    let mut bits = 0;
    for place in 0..PATH {
        let its = if away { place } else { length.wrapping_sub(place + 1) };
        bits |= if place < length && its == step { segment.circuits[place].bits() } else { 0 };
    }
    bits
}

/// Whether a train on `one` may stand on `other` too, by what the table says: they are of one body, next to each other on plain line with its throat,
/// or nobody knows which train is on `one`.
pub(super) fn is_joint(line: &Line, standing: &Standing<ROUTES>, one: u64, other: u64) -> bool {
    let mut joint = standing.loose.bits() & one != 0;
    for body in standing.bodies {
        joint |= body.bits() & one != 0 && body.bits() & other != 0;
    }
    for segment in &line.plan().segments {
        let mut before = segment.throat.bits();
        for place in 0..PATH {
            let circuit = if place < length_of(segment) { segment.circuits[place].bits() } else { 0 };
            joint |= before == one && circuit == other || before == other && circuit == one;
            before = circuit;
        }
    }
    joint
}
