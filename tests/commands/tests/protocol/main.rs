//! The oracle's protocol: what every machine answers to good and to bad lines.

mod battered;
mod block;
mod general;
mod interlocking;
mod properties;
mod refusals;
mod signal;
mod spec_words;
mod train;
mod wayside;
