//! Runs the proofs.
