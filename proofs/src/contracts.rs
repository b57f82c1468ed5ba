//! The contracts of kernel functions, for Kani: each is checked against its function for all inputs.
//! (`cargo kani -p atc-proofs -Z function-contracts`)

use atc_kernel::aspect::AspectSet;
use atc_kernel::time::{divide_down, divide_up};

#[kani::proof_for_contract(AspectSet::lowest)]
fn lowest() {
    let _ = AspectSet::from_bits(kani::any()).lowest();
}

// A constant divisor: no prover divides by an arbitrary number.
#[kani::proof_for_contract(divide_up)]
fn rounding_up() {
    let _ = divide_up(kani::any(), crate::time::CYCLE_MS);
}

#[kani::proof_for_contract(divide_down)]
fn rounding_down() {
    let _ = divide_down(kani::any(), crate::time::CYCLE_MS);
}
