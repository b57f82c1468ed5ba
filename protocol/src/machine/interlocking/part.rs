//! The interlocking as a part of the ground's device: its names, and what is remembered there.

use std::collections::BTreeMap;

use atc_kernel::interlocking::{
    self as kernel, CircuitId, CircuitSet, Input, Memory, PointSet, Position, Positions, Refusal, RouteSet, SegmentId,
    Size,
};

use super::forms::{Accepted, Answer, Refused};
use super::words::{Phase, Reason, Side};
use super::{Interlocked, named, place};

impl<const R: usize, const P: usize, const N: usize, const S: usize, Z: Size> Interlocked<R, P, N, S, Z> {
    /// The speeds of the codes in km/h; 0 where there is no such code.
    pub(in crate::machine) fn speeds_kmh(&self) -> [u16; kernel::MAX_CODES] {
        self.speeds_kmh
    }

    /// Goes on from this memory: that of a device which is stepped elsewhere.
    pub fn remember(&mut self, memory: &Memory<R, S, Z>) {
        *self.memory = *memory;
    }

    /// The segment of that name.
    pub(in crate::machine) fn segment(&self, name: &str, field: &str) -> Result<SegmentId, String> {
        let number = place(&self.names.segments, name, field, "segment")?;
        SegmentId::new(number).ok_or_else(|| format!("segment {number} has no place"))
    }

    /// The circuit of that name.
    pub(in crate::machine) fn circuit(&self, name: &str, field: &str) -> Result<CircuitId, String> {
        let number = place(&self.names.circuits, name, field, "circuit")?;
        CircuitId::new(number).ok_or_else(|| format!("circuit {number} has no place"))
    }

    /// The circuits of those names, each once.
    pub(in crate::machine) fn circuits_named(&self, list: &[String], field: &str) -> Result<CircuitSet<Z>, String> {
        self.circuits(list, field)
    }

    /// The phase of every route that is not idle.
    pub(in crate::machine) fn phases(&self) -> BTreeMap<String, Phase> {
        let held = self.names.routes.iter().zip(&self.memory.interlocking.routes).filter(|(_, route)| route.is_held());
        held.map(|(name, route)| (name.clone(), Phase(route.phase))).collect()
    }

    /// The names of routes.
    pub fn routes_of<C: FromIterator<String>>(&self, set: RouteSet<Z>) -> C {
        named(&self.names.routes, |number| set.meets(RouteSet::nth(number)))
    }

    /// The points that are driven, and whereto.
    pub(in crate::machine) fn sides(&self, drives: Positions<Z>) -> BTreeMap<String, Side> {
        let drives = self.names.points.iter().enumerate().filter_map(|(number, name)| {
            let point = PointSet::nth(number);
            let side = |position| Some((name.clone(), Side(position)));
            match (drives.normal.meets(point), drives.reverse.meets(point)) {
                (true, _) => side(Position::Normal),
                (false, true) => side(Position::Reverse),
                (false, false) => None,
            }
        });
        drives.collect()
    }

    /// The circuits that count as occupied after the cycle whose state is remembered.
    pub(in crate::machine) fn counted(&self) -> CircuitSet<Z> {
        let clear = self.layout.plan().clear;
        let ages = self.state().track.clear_for();
        let young = ages.iter().enumerate().filter(|(_, age)| **age < clear);
        young.fold(CircuitSet::EMPTY, |set, (number, _)| set.or(CircuitSet::nth(number)))
    }

    /// What became of the request, with what is in the way. `occupied` are the circuits that count as occupied.
    pub(in crate::machine) fn answer(
        &self,
        input: Input<Z>,
        occupied: CircuitSet<Z>,
        answer: Option<Result<(), Refusal>>,
    ) -> Option<Answer> {
        answer.map(|answer| match answer {
            Ok(()) => Answer::Accepted(Accepted::Accepted),
            Err(refusal) => {
                Answer::Refused(Refused { refused: Reason(refusal), because: self.because(input, occupied, refusal) })
            }
        })
    }
}
