//! The conformance kit: another implementation of a machine against the kernel, in lock step, until the first difference, which is made
//! as short as it gets.
//!
//! * [`run`]: what `oracle conform` does. Cases come from [`walk`], the other side is a process ([`side`]), a case is played by
//!   [`play`], and what is found is made shorter by [`shrink`].
//! * [`fields`]: what is compared, and which requirements speak of it. [`profile`]: what is known to differ.
//! * [`alike`]: which small change of the kernel gives the same replies. [`reached`]: which of a user's limits the walks decide.
//! * [`report`]: text, JSON, JUnit, HTML, badge. [`vectors`]: cases in files; [`directed`]: those that a search found; [`coverage`]: what they cover.
//!
//! It goes through [`atc_protocol::Session`] and [`crate::chart`] as any client does; neither knows of it.

pub mod alike;
pub mod case;
pub mod coverage;
pub mod directed;
pub mod fields;
pub mod play;
pub mod profile;
pub mod random;
pub mod reached;
pub mod report;
pub mod run;
pub mod shrink;
pub mod side;
pub(crate) mod vector;
pub mod vectors;
pub mod walk;
