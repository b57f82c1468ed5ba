//! What it all amounts to: the plan of what is to be shown, the verdicts, the argument, the case and what is open in it.

pub mod again;
pub mod alike;
pub mod argument;
pub mod build;
pub mod hazard;
pub mod merge;
pub mod open;
pub mod plan;
pub mod results;
pub mod scope;
pub mod srac;
pub mod stale;
pub mod trace;
pub mod verdict;
