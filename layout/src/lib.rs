//! Layouts of stations: read, checked and compiled for the kernel's interlocking.
//!
//! * [`read`] and [`Description`]: a layout in the words of its file ([`form`]).
//! * [`Description::compile`]: names become numbers, what the file leaves out is derived, every rule is checked ([`Rule`]), and the
//!   kernel's plan comes out ([`Compiled`]).
//! * [`compare`]: two layouts of one station, cell by cell.
//! * [`border`]: what two stations see of the line between them, held against each other.
//! * [`witness`]: the plan held against the tracks of its file a second time, by other code.
//! * [`second`]: a layout held against a railML file, by other code than the import's.
//! * [`lives`]: what the ground counts on telegrams to live, held against what trains do.
//! * [`Errors`]: every broken rule with its place in the file and what would be right.
//!
//! # In the house
//!
//! Uses `atc-kernel`. Used by `atc-adversary`, `atc-evidence`, `atc-line`, `atc-models`, `atc-oracle`,
//! `atc-protocol`, `atc-simulation`, `atc-tests`. Begin with [`read`] and [`Description`].

#![forbid(unsafe_code)]

mod at;
pub mod border;
mod check;
pub mod compare;
mod compile;
pub mod conflict;
pub mod derive;
mod description;
pub mod draw;
mod extent;
pub mod form;
pub mod graph;
pub mod import;
pub mod lives;
pub mod model;
mod names;
mod problem;
mod rule;
pub mod second;
pub mod table;
pub mod text;
mod values;
pub mod witness;

pub use at::At;
pub use compile::{Compiled, Names, Sound};
pub use description::{Description, read};
pub use extent::{Extent, with_room};
pub use problem::{Errors, LineColumn, Problem, Source};
pub use rule::Rule;
pub use values::{Braking, Overlaps, Speeds, Times};

/// The JSON Schema of the layout form, as the file `layout.schema.json` has it.
///
/// # Panics
/// Never: a schema is JSON.
pub fn schema() -> String {
    let schema = schemars::schema_for!(form::Station);
    let text = serde_json::to_string_pretty(&schema).expect("a schema is JSON");
    format!("{text}\n")
}
