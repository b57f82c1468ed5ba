//! What the case is made of, read and judged piece by piece.

pub mod cargo;
pub mod data;
pub mod faults;
pub mod line;
pub mod measured;
pub mod models;
pub mod mutants;
pub mod proofs;
pub mod provenance;
pub mod requirements;
pub mod second;
pub mod tests;
mod truth;

/// The ids of assumptions with a bound in words; see `bounds` in `spec/assumptions.toml`.
pub(crate) fn owned(words: &[&str]) -> Vec<String> {
    words.iter().map(|word| (*word).to_owned()).collect()
}
