//! Models of block counting: trains, tails, borders and faults over the kernel's machine `atc_kernel::block`.
//!
//! | module | what is in it |
//! |---|---|
//! | [`fault`] | the kinds of fault |
//! | [`single`] | one block at the end of the line |
//! | [`border`] | two blocks and the border between them |
//! | [`lines`] | the line in it, and two with other rules of who takes over |
//! | [`device`] | the machine in a model, and one that does not compare |
//! | [`cut_sets`] | every minimal cut set of one block; the same by direct evaluation |
//! | `modes` | what each single fault does |

pub mod border;
pub mod cut_sets;
pub mod device;
pub mod fault;
pub(crate) mod graph;
pub mod lines;
mod modes;
pub mod single;
