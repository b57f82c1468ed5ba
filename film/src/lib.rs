//! A film: what a recorded session or a simulation looked like, frame by frame, and the page that plays it.
//!
//! * [`Film`] is the data: everything that changes is a [`Channel`] of words or a [`Curve`] of numbers, stored as
//!   changes. Any frame is found without those before it.
//! * [`Film::page`] is one HTML file with everything in it. It opens from a file, without a network or a server.
//! * [`Film::channel`], [`Film::curve`] and [`Film::happenings`] fill it; [`Film::word_at`] and [`Film::number_at`]
//!   read it back.
//!
//! The crate knows nothing of the kernel: who makes a film says what is in it.
//!
//! # In the house
//!
//! Uses no other crate of the house. Used by `atc-oracle`, `atc-simulation`. Begin with [`Film`].

#![forbid(unsafe_code)]

mod event;
mod filling;
mod form;
mod lane;
mod page;
mod series;

pub use event::{Class, Event};
pub use form::{Clock, Distance, FORM, Film, Kernel, Place, Plan, Stretch, Table};
pub use lane::{Bar, Lane, Legend, Line, Mark};
pub use page::TOO_LONG;
pub use series::{Channel, Curve};
