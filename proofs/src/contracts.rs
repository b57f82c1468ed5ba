//! The contracts of kernel functions, for Kani: each is checked against its function for all inputs.
//! (`cargo kani -p atc-proofs -Z function-contracts`)

use atc_arithmetic::{divide_down, divide_up};
use atc_kernel::aspect::AspectSet;
use atc_kernel::block::{self, SectionSet};

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

#[kani::proof_for_contract(SectionSet::first)]
fn first_sections() {
    let _ = SectionSet::first(kani::any());
}

#[kani::proof_for_contract(SectionSet::with_sections_behind)]
#[kani::unwind(5)]
fn sections_behind() {
    let Some(hold) = block::Hold::new(kani::any()) else { return };
    let _ = SectionSet::from_bits(kani::any()).with_sections_behind(hold);
}

#[kani::proof_for_contract(SectionSet::reversed)]
fn reversed_sections() {
    let _ = SectionSet::from_bits(kani::any()).reversed(kani::any());
}

#[kani::proof_for_contract(block::step)]
#[kani::unwind(5)]
fn block_step() {
    let mut engine = crate::engine::model::Kani::ANY;
    let _ = crate::block::any_step(&mut engine);
}
