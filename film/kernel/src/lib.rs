//! The kernel's interlocking behind plain numbers: a plan and the inputs of a cycle as words of 64 bits, and everything
//! that a page shows as words again. Compiled for `wasm32-unknown-unknown` it is the module of a film in which a reader
//! goes on.
//!
//! * [`plan_words`] and [`plan_of`]: a plan, there and back. [`input_words`] and [`input_of`]: the input of a cycle.
//! * [`Device`]: a layout with its memory; [`Device::step`] is one cycle. [`place`] says where in its words what
//!   stands.
//! * On `wasm32` the functions of `exports` are what the page calls.
//!
//! The one who writes the words and the module that reads them are this one file's two sides, so there is one form of
//! them.
//!
//! # In the house
//!
//! Uses `atc-kernel`. Used by `atc-oracle`. Begin with [`Device`].

mod device;
#[cfg(target_arch = "wasm32")]
mod exports;
mod words;

pub use device::{Device, OUTPUT, place};
pub use words::{INPUT, Reader, input_of, input_words, plan_of, plan_words};
