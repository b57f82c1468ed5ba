//! What a model of a station remembers, and one cycle of it.

use super::environment::TRAINS;
use super::ground::Blade;
use super::sizes::{CIRCUITS, POINTS, ROUTES, SEGMENTS, SIGNALS, Small, circuits};
use super::train::{Fate, Train};
use atc_kernel::interlocking::{
    self as kernel, CircuitSet, Directions, Input, Positions, RouteState, Settling, SpeedCode, SpeedLimits, Track,
    Unswept, Works,
};
use atc_kernel::time::Ticks;
use serde::Serialize;

/// The machine's state, without what never changes in a model and without the number of the cycle.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Kept {
    /// Cycles for which each circuit has been reported clear.
    pub clear_for: [u8; CIRCUITS],
    /// For how many cycles the device has run, as far as that matters.
    pub started: Ticks,
    /// What the start has left unswept.
    pub unswept: Unswept,
    /// Cycles for which each point has been detected and not driven.
    pub stood: [u8; POINTS],
    /// Where the points were detected last, if that matters.
    pub last: Positions,
    /// The routes.
    pub routes: [RouteState; ROUTES],
    /// The segments.
    pub directions: Directions<SEGMENTS>,
    /// The blocked circuits: a mask.
    pub blocked: u8,
    /// The blocks that staff may rely on: a mask.
    pub confirmed: u8,
    /// The circuits that are restricted to [`RESTRICTED`]: a mask.
    pub restricted: u8,
}

/// The speed code of a restriction.
pub const RESTRICTED: SpeedCode = SpeedCode(1);

/// A mask of the first circuits of a set.
pub(super) const fn mask(set: CircuitSet) -> u8 {
    set.bits().to_le_bytes()[0]
}

impl Kept {
    /// Takes down what may change.
    pub fn of(state: &kernel::State<ROUTES, SEGMENTS>) -> Self {
        let all = state.track.clear_for();
        let code = |circuit: usize| state.works.restrictions.over(CircuitSet::nth(circuit)) <= RESTRICTED;
        Self {
            clear_for: std::array::from_fn(|circuit| all[circuit]),
            started: state.started,
            unswept: state.unswept,
            stood: std::array::from_fn(|point| state.points.parts().0[point]),
            last: state.points.parts().1,
            routes: state.routes,
            directions: state.directions,
            blocked: mask(state.works.blocked),
            confirmed: mask(state.works.confirmed),
            restricted: (0..CIRCUITS).filter(|circuit| code(*circuit)).fold(0, |set, circuit| set | 1 << circuit),
        }
    }

    /// The machine's state, in a cycle that is not its first.
    pub fn kernel(&self, layout: &Small) -> kernel::State<ROUTES, SEGMENTS> {
        let mut clear_for = kernel::PerCircuit::all(layout.plan().clear);
        clear_for[..CIRCUITS].copy_from_slice(&self.clear_for);
        let mut stood = kernel::PerPoint::all(0);
        stood[..POINTS].copy_from_slice(&self.stood);
        let restrictions = SpeedLimits::NONE.and_at_most(RESTRICTED, circuits(self.restricted));
        kernel::State {
            track: Track::from_parts(clear_for),
            started: self.started,
            unswept: self.unswept,
            points: Settling::from_parts(stood, self.last),
            routes: self.routes,
            directions: self.directions,
            works: Works { blocked: circuits(self.blocked), confirmed: circuits(self.confirmed), restrictions },
            epoch: kernel::Epoch(1),
        }
    }
}

/// What the machine put out, as far as the environment acts on it in the next cycle.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Shown {
    /// The routes that show proceed: a mask.
    pub proceed: u8,
    /// The drives.
    pub drives: Positions,
    /// Those of the cycle before, if points may leave after the drive.
    pub drives_before: Positions,
    /// The segments that are permitted to the neighbours: a mask.
    pub permits: u8,
    /// For each segment the cycles since it was, as far as permissions live.
    pub since_permit: [u8; SEGMENTS],
    /// For each signal the cycles since it showed proceed, where trains keep to telegrams: one more than the residual running at most.
    pub fallen: [u8; SIGNALS],
    /// The routes that were requested, and neither withdrawn nor released since: a mask. In a machine that is right that follows from its state.
    pub asked: u8,
    /// For each segment the cycles since the neighbour's consent ended; one more than its staff wait once they are on the line.
    pub since_consent: [u8; SEGMENTS],
}

/// What has gone wrong.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Harm {
    /// Nothing.
    None,
    /// Two trains are in one circuit, or touch.
    Collision,
    /// A train ran over a point that did not lead there, or a point moves under it.
    Derailment,
    /// A train that keeps to its telegrams passed a signal at stop.
    Overrun,
    /// A signal shows proceed over a circuit with a train, or over a point that does not lie right.
    Proceed,
    /// A telegram lets a train run over a circuit with another train, or that is granted to another one, or over a point that does not lie right.
    Authority,
    /// A train is in a circuit whose block was confirmed to staff, of this station or of the neighbour; or a point moves there.
    Staff,
    /// A telegram has a higher speed code than a restriction.
    Speed,
    /// A telegram has a higher speed code than a route under its train.
    Limit,
    /// A telegram lets a train run where no route leads that was requested and not withdrawn since.
    Unasked,
}

/// Trains, points, the machine, and what was seen.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct State {
    /// The trains.
    pub trains: [Train; TRAINS],
    /// The points.
    pub blades: [Blade; POINTS],
    /// The machine.
    pub kept: Kept,
    /// What it put out.
    pub shown: Shown,
    /// What has gone wrong.
    pub harm: Harm,
}

/// One logic cycle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cycle {
    /// The trains after their moves.
    pub trains: [Train; TRAINS],
    /// What became of the worst of them.
    pub fate: Fate,
    /// The points after their moves.
    pub blades: [Blade; POINTS],
    /// What the machine reads.
    pub input: Input,
}
