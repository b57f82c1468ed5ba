//! The case for its readers: a page, an argument, tables, and what other programs take.

pub mod files;
pub mod gsn;
pub mod html;
pub mod junit;
pub mod output;
pub mod sarif;
pub mod tables;
pub mod terminal;
