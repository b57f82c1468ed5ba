//! A line's data: one form, one reader, one check.
//!
//! * [`read`] and [`parse`]: a line's file in TOML. The layouts of stations that it names are read by `atc-layout`.
//! * [`aspect`], [`supervision`], [`block`], [`permitted`], [`position`], [`code`]: each group of parameters, as a session of the oracle
//!   gives it in JSON. One conversion to the kernel's parameters, and one explanation of what the kernel refuses ([`Refusal`]).
//! * [`budget`]: the levels of the train control signal, for `oracle signal budget`.
//! * [`Line`]: the parameters in the kernel's form, what follows from them, and [`Line::checks`].
//! * [`DataCheck`]: a rule and what it came to, for lines and for stations. [`Rule`] lists the rules of lines.
//! * [`seam`]: what the stations count on, held against what the trains do; both places are named.
//!
//! # In the house
//!
//! Uses `atc-kernel`, `atc-layout`. Used by `atc-evidence`, `atc-oracle`, `atc-protocol`, `atc-python`. Begin with
//! [`Line`].

#![forbid(unsafe_code)]

pub mod aspect;
pub mod block;
pub mod blocks;
mod border;
pub mod budget;
pub mod check;
mod checked;
pub mod code;
pub mod decimal;
mod derived;
pub mod figures;
mod form;
pub mod kmh;
pub mod line;
pub mod permitted;
pub mod places;
pub mod position;
mod problem;
mod reader;
pub mod refusal;
mod rule;
pub mod seam;
pub mod signal;
mod station;
pub mod supervision;
mod telegram;

pub use check::{DataCheck, Finding, Outcome};
pub use form::End;
pub use line::{Line, Train};
pub use problem::{Problem, Problems};
pub use reader::{parse, read};
pub use refusal::Refusal;
pub use rule::{Asked, Rule};
