//! Recorder logs against the kernel, in bulk: every session is stepped through the kernel again, and each reply that the device gave is held
//! against the kernel's.
//!
//! * [`logs`]: which files are read, and how their bytes are shared out over machines and threads.
//! * [`run`]: what `oracle replay` does. A log is read as a stream; nothing grows with its length.
//! * [`report`]: text, JSON, JUnit and HTML, and how the reports of shards are joined.
//!
//! What is compared, the levels and the profile are those of [`crate::conform`].

mod explain;
mod lines;
pub mod logs;
pub mod report;
mod rows;
pub mod run;
mod session;
mod unit;
