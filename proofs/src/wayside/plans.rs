//! Plans of the harnesses here, whose circuits are 100 m long.

use atc_kernel::distance::Metres;
use atc_kernel::interlocking::{MAX_CIRCUITS, Plan};
use atc_kernel::time::Ticks;

/// The longest loop: over what there is for each circuit.
pub(super) const LONGEST: usize = MAX_CIRCUITS;

/// The circuits of the layouts here: numbers 0 to 15.
const CIRCUITS: usize = 16;

/// A plan whose circuits are 100 m long.
pub(super) fn plan<const R: usize, const P: usize, const S: usize>() -> Plan<R, P, 0, S> {
    with_lengths(Plan { clear: 1, turn: Ticks(1), ..Plan::EMPTY })
}

/// The plan with circuits that are 100 m long.
pub(super) fn with_lengths<const R: usize, const P: usize, const S: usize>(
    mut plan: Plan<R, P, 0, S>,
) -> Plan<R, P, 0, S> {
    for length in plan.lengths.iter_mut().take(CIRCUITS) {
        *length = Metres(100);
    }
    plan
}
