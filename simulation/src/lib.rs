//! A line with trains in continuous motion, under the kernel's own machines; floating point, outside the verified kernel.
//!
//! The ground is [`Combined`](atc_kernel::interlocking::Combined) for every station, the trains are
//! [`Train`](atc_kernel::train::Train). What is true of trains and points is kept apart from all devices, and is what a run is judged
//! by: trains that share ground, a train over a point that does not stand for it, a point that moves under a train, a train
//! past the point where it had to stop.
//!
//! | module | part |
//! |---|---|
//! | [`mod@file`], [`generate`], [`mod@line`], [`track`] | a line from its file: stations, the lines between them, the ground as it lies |
//! | [`motion`], [`driver`] | trains as bodies, and who drives them |
//! | [`onboard`], [`ground`], `equipment`, [`counted`] | the kernel's devices, and what each has |
//! | [`dispatcher`] | who asks for routes and turns lines |
//! | [`fault`], [`defect`] | what fails, when, for how long; what is wrong all the time |
//! | [`world`], [`train`], `run`, `rolling`, `counting`, `judge` | a line at work; a cycle of everything, of a train, of counting; the truth |
//! | [`campaign`], [`headline`] | many runs: whether a fault leads to harm; what the shortened operate time buys |
//! | [`cut_sets`] | what a case is shown of faults: single ones, and two that together lead to harm |
//! | [`splitting`], [`rare`] | how likely something rare is; faults that come by chance |
//! | [`record`], [`diagram`], [`charts`], [`film`] | pictures; a run as a film |
//!
//! A run is the same every time for one seed.
//!
//! # In the house
//!
//! Uses `atc-film`, `atc-kernel`, `atc-layout`, `atc-waveform`. Used by `atc-evidence`, `atc-oracle`. Begin with
//! [`world`].

#![forbid(unsafe_code)]

pub mod bound;
pub mod campaign;
pub mod charts;
pub mod counted;
mod counting;
pub mod cut_sets;
pub mod defect;
pub mod diagram;
pub mod dispatcher;
pub mod driver;
mod equipment;
pub mod event;
pub mod fault;
pub mod file;
pub mod film;
pub mod generate;
pub mod ground;
pub mod headline;
mod judge;
pub mod line;
pub mod motion;
pub mod onboard;
pub mod rare;
pub mod record;
mod rolling;
mod run;
pub mod sizes;
pub mod splitting;
pub mod track;
pub mod train;
pub mod world;
