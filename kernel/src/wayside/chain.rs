//! The track of a counted line as the layout has it: a segment with its throat, and what adjoins the two.
//!
//! Plain data, read off the layout once, so that the checks of the joint ([`super::Counted`]) look at nothing else.

use crate::block::MAX_SECTIONS;
use crate::distance::Metres;
use crate::interlocking::{CircuitSet, Layout, PerCircuit, SegmentId, Size, Small, Travel};

/// The most sections of a block.
pub(super) const SECTIONS: usize = MAX_SECTIONS as usize;

/// A place along the track.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Place<Z: Size = Small> {
    /// Its circuit; several where tracks join, none where the layout ends.
    pub circuits: CircuitSet<Z>,
    /// The length of the shortest of them; 0 if there is none.
    pub length: Metres,
}

impl<Z: Size> Place<Z> {
    /// No circuit.
    pub const NONE: Self = Self { circuits: CircuitSet::EMPTY, length: Metres(0) };

    /// The place of these circuits.
    #[inline]
    fn of(circuits: CircuitSet<Z>, lengths: &PerCircuit<Metres, Z>) -> Self {
        let mut shortest = None;
        for (number, length) in lengths.iter().enumerate() {
            if circuits.meets(CircuitSet::nth(number)) && shortest.is_none_or(|shortest| *length < shortest) {
                shortest = Some(*length);
            }
        }
        Self { circuits, length: shortest.unwrap_or(Metres(0)) }
    }
}

/// Where a route begins.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Way<Z: Size = Small> {
    /// The circuit where its train waits; none if there is no such route.
    pub entry: CircuitSet<Z>,
    /// The first circuit of its path.
    pub first: CircuitSet<Z>,
}

impl<Z: Size> Way<Z> {
    /// No route.
    pub const NONE: Self = Self { entry: CircuitSet::EMPTY, first: CircuitSet::EMPTY };
}

/// A segment with its throat (place 0) and its circuits (from place 1 on), and what adjoins them. `K` is how many places behind the throat are
/// looked at: fewer only in proofs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Chain<const R: usize, const P: usize, const K: usize = SECTIONS, Z: Size = Small> {
    /// The throat; none if no route goes out.
    pub throat: Place<Z>,
    /// The circuits, the one next to the station first; none beyond the segment's length.
    pub circuits: [Place<Z>; P],
    /// The places behind the throat on the routes that go out, the nearest first, their entries included.
    pub behind: [Place<Z>; K],
    /// Where each route begins.
    pub ways: [Way<Z>; R],
}

impl<const R: usize, const P: usize, const K: usize, Z: Size> Chain<R, P, K, Z> {
    /// The track of this segment; none if there is no such segment.
    #[inline]
    pub fn of<const N: usize, const S: usize>(layout: &Layout<R, P, N, S, Z>, segment: SegmentId) -> Option<Self> {
        //= spec/wayside.md#way-24-the-track
        //# The joint MUST be checked on the circuits and lengths that the layout has: of the segment and its throat, of as many places
        //# behind the throat on every route out to it, and of the beginning of every route; where tracks join, the shortest counts.
        let plan = layout.plan();
        let mut chain =
            Self { throat: Place::NONE, circuits: [Place::NONE; P], behind: [Place::NONE; K], ways: [Way::NONE; R] };
        let mut exists = false;
        for (number, its) in plan.segments.iter().enumerate() {
            if number == usize::from(segment.number()) && its.length > 0 {
                exists = true;
                chain.throat = Place::of(its.throat, &plan.lengths);
                for (back, (circuit, place)) in (0_u8..).zip(its.circuits.iter().zip(&mut chain.circuits)) {
                    *place = Place::of(circuit.only_if(back < its.length), &plan.lengths);
                }
            }
        }
        for (back, place) in (1_usize..).zip(&mut chain.behind) {
            *place = Place::of(behind_the_throat(layout, segment, back), &plan.lengths);
        }
        for (route, way) in plan.routes.iter().zip(&mut chain.ways) {
            if route.exists() {
                *way = Way { entry: route.entry, first: route.circuit_at(0) };
            }
        }
        exists.then_some(chain)
    }

    /// What is at a place, numbered from the throat.
    #[inline]
    pub(super) fn at(&self, place: usize) -> Place<Z> {
        let mut found = if place == 0 { self.throat } else { Place::NONE };
        for (number, its) in (1_usize..).zip(&self.circuits) {
            if number == place {
                found = *its;
            }
        }
        found
    }

    /// The place of a circuit.
    #[inline]
    pub(super) fn place(&self, circuit: CircuitSet<Z>) -> Option<usize> {
        let mut found = if self.throat.circuits == circuit { Some(0) } else { None };
        for (number, its) in (1_usize..).zip(&self.circuits) {
            if its.circuits == circuit {
                found = Some(number);
            }
        }
        found
    }

    /// The circuits that adjoin the exit, which is the end of the circuit at `exit`.
    #[inline]
    pub(super) fn beyond(&self, travel: Travel, exit: usize) -> CircuitSet<Z> {
        match travel {
            Travel::Away => self.at(exit.wrapping_add(1)).circuits,
            Travel::Toward => {
                let mut beyond = if exit == 0 { CircuitSet::EMPTY } else { self.at(exit - 1).circuits };
                // Also where the ways into the station do not begin in the throat.
                let last = self.at(exit).circuits;
                for way in &self.ways {
                    beyond = beyond.or(way.first.only_if(way.entry == last));
                }
                beyond
            }
        }
    }

    /// The places before the entry, which is the beginning of the circuit at `entry`, the nearest first: of the segment, and behind its
    /// throat of the routes that lead out to it.
    #[inline]
    pub(super) fn before(&self, travel: Travel, entry: usize) -> [Place<Z>; K] {
        // In order of travel, each place that is passed on the way to the entry comes in front of those before it.
        let mut before = match travel {
            Travel::Away => self.behind,
            Travel::Toward => [Place::NONE; K],
        };
        for step in 0..=P {
            let (place, passed) = match travel {
                Travel::Away => (step, step < entry),
                Travel::Toward => (P - step, P - step > entry),
            };
            if passed {
                let mut next = self.at(place);
                for back in &mut before {
                    next = core::mem::replace(back, next);
                }
            }
        }
        // Behind a place without a circuit nothing is known.
        let mut known = true;
        for place in &mut before {
            known &= !place.circuits.is_empty();
            if !known {
                *place = Place::NONE;
            }
        }
        before
    }
}

/// The circuits that are so many places behind the throat on the routes out to the segment, their entries included.
#[inline]
fn behind_the_throat<const R: usize, const P: usize, const N: usize, const S: usize, Z: Size>(
    layout: &Layout<R, P, N, S, Z>,
    segment: SegmentId,
    back: usize,
) -> CircuitSet<Z> {
    let mut circuits = CircuitSet::EMPTY;
    for route in &layout.plan().routes {
        let length = usize::from(route.length);
        if route.exists() && route.to.has(segment) {
            circuits = circuits.or(route.entry.only_if(length == back));
            for (place, element) in route.path.iter().enumerate() {
                let there = place < length && place.wrapping_add(back).wrapping_add(1) == length;
                circuits = circuits.or(element.circuits.only_if(there));
            }
        }
    }
    circuits
}
