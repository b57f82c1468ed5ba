//! The commands of `oracle`: arguments, exit codes, and what is written where.

mod budget;
mod conform;
mod layout;
mod line;
mod oracle;
mod position;
mod replay;
mod simulate;
