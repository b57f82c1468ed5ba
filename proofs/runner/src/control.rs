//! Which harnesses are smaller when they are to reject mutants than when they prove.

use atc_proofs::Harness;

/// Whether the harness is smaller when it is compiled for mutants. The kernel with none of them must pass it at that size.
pub fn is_smaller(harness: &Harness) -> bool {
    atc_proofs::interlocking::SMALLER.contains(&harness.bound)
}
