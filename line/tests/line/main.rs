//! A line's file: the known figures of the examples, and every rule broken on purpose.

mod aspect;
mod blocks;
mod example;
mod position;
mod seam;
mod signal;
mod support;
