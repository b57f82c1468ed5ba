//! The verified kernel behind a C ABI: its machines in a C program's own memory.
//!
//! `include/atc.h` is the header, [`border`] the functions of it, and the README the rules of the border. Each
//! machine is one
//! module: its forms in C, and how they become the kernel's types and back. A state is kept as bytes and read back
//! through the
//! kernel's constructors and its `is_valid` in every step, so that no byte that C has written is ever trusted.
//!
//! No allocation, no global state, no panic that is known of. The names are C's.
//!
//! # In the house
//!
//! Uses `atc-kernel`. Used by no other crate of the house. Begin with `include/atc.h` and [`border`].
#![no_std]
#![deny(unsafe_code)]
#![allow(non_camel_case_types, reason = "these are C's names")]
#![allow(clippy::trivially_copy_pass_by_ref, reason = "C's structures come through pointers, small ones too")]

// Not used by name. The static library needs a panic handler, and the unwinder's part of `core` a personality; that
// is all that
// `std` is here for. Should there be a panic after all, it does not cross the border: `extern "C"` ends the process.
extern crate std;

pub mod aspect;
pub mod block;
pub mod border;
pub mod interlocking;
mod memory;
pub mod pattern;
pub mod permitted;
mod pointer;
pub mod status;
pub mod supervision;
pub mod telegram;
pub mod train;

pub use memory::ATC_VERSION;
pub use status::atc_status;

/// A flag of C: 0 or 1.
fn flag(flag: u8) -> Result<bool, atc_status> {
    match flag {
        0 => Ok(false),
        1 => Ok(true),
        _ => Err(atc_status::BadFlag),
    }
}
