//! The on-board device (machine `train` of protocol 1) as an FMI 3.0 co-simulation unit.
//!
//! * [`variables`]: the one table of variables. A value reference is a place in it, and the XML is generated from it.
//! * [`cycle`]: one step's values as the protocol's step, and its output as values. [`rounding`] is how.
//! * [`instance`]: an instance with its mode, its time and its kept states, without a pointer.
//! * [`border`]: the functions of FMI's header, and the only place where a pointer of C is followed.
//! * [`description`], [`package`]: the XML and the file around all of it.
//!
//! Nothing here decides anything. It calls the protocol's machine.
//!
//! # In the house
//!
//! Uses `atc-files`, `atc-protocol`. Used by no other crate of the house. Begin with [`cycle`].
#![deny(unsafe_code)]

pub mod border;
pub mod config;
pub mod cycle;
pub mod description;
pub mod instance;
pub mod package;
pub mod rounding;
pub mod variables;
