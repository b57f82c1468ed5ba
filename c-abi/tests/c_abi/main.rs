//! The border from outside: the header, C programs, the kernel beside it, and calls that no program should make.
#![allow(unsafe_code, reason = "what is tested is called as C calls it")]

mod arrays;
mod call;
mod header;
mod lockstep;
mod malformed;
mod programs;
mod station;
mod tools;
mod walks;
mod wire;
