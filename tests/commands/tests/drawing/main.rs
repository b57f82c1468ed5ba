//! Timing charts: what is drawn, and that the pictures in the documentation are those that are drawn.

mod aspect;
mod block;
mod docs;
mod signal;
