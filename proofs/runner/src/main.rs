//! `atc-prover`.
fn main() {}
