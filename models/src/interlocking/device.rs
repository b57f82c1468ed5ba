//! The machine in a model: the kernel's, or a wrong one to compare with.

use super::sizes::{ROUTES, SEGMENTS, Small};
use atc_kernel::interlocking::{Input, Output, State};
use std::fmt::Debug;

/// A machine that may stand in the place of the kernel's.
pub trait Device: Clone + Debug + Send + Sync + 'static {
    /// One logic cycle.
    fn step(
        &self,
        layout: &Small,
        state: State<ROUTES, SEGMENTS>,
        input: Input,
    ) -> (State<ROUTES, SEGMENTS>, Output<ROUTES>);
}

/// The kernel's own.
#[derive(Clone, Copy, Debug)]
pub struct Real;

impl Device for Real {
    fn step(
        &self,
        layout: &Small,
        state: State<ROUTES, SEGMENTS>,
        input: Input,
    ) -> (State<ROUTES, SEGMENTS>, Output<ROUTES>) {
        layout.cycle(state, input)
    }
}
