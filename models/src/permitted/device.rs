//! The device in a model of the permitted speed: the kernel's, and others to compare with.

use atc_kernel::permitted::{Basis, Heard, Permission, Permitted, State, step};
use std::fmt::Debug;

/// A device that may stand in the place of the kernel's.
pub trait Device: Clone + Debug + Send + Sync + 'static {
    /// Whether it reads telegrams.
    const DIGITAL: bool = true;

    /// One logic cycle.
    fn step(&self, permitted: &Permitted, state: State, heard: Heard) -> (State, Permission);
}

/// The kernel's own.
#[derive(Clone, Copy, Debug)]
pub struct Real;

impl Device for Real {
    fn step(&self, permitted: &Permitted, state: State, heard: Heard) -> (State, Permission) {
        step(permitted, state, heard)
    }
}

/// The conventional train: it hears codes only.
#[derive(Clone, Copy, Debug)]
pub struct Conventional;

impl Device for Conventional {
    const DIGITAL: bool = false;

    fn step(&self, _: &Permitted, state: State, heard: Heard) -> (State, Permission) {
        let basis = if heard.analog.is_some() { Basis::Analog } else { Basis::Nothing };
        (state, Permission { speed: heard.analog, basis })
    }
}

/// Adds the distance of whatever cycle it was measured in to what a main telegram allows: PER-4 is left out.
#[derive(Clone, Copy, Debug)]
pub struct FixOfAnyCycle;

impl Device for FixOfAnyCycle {
    fn step(&self, permitted: &Permitted, state: State, heard: Heard) -> (State, Permission) {
        let now = if heard.main.is_some() { heard.to_exit.map(|fix| fix.and(heard.moved)) } else { None };
        let (mut next, permission) = step(permitted, State { fix: now.or(state.fix), ..state }, heard);
        if heard.main.is_some() {
            next.fix = heard.to_exit.or(state.fix.map(|fix| fix.less(heard.moved)));
        }
        (next, permission)
    }
}
