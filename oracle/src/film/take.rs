//! What a film is made of, and how.

use atc_layout::Description;
use atc_protocol::machine::Machine;
use serde_json::Value;

use crate::trace::error::Replies;
use crate::trace::run::Cycle;

/// What more is said of each step by what made the trace: by name.
pub type Words = serde_json::Map<String, Value>;

/// How a film is made.
#[derive(Clone, Debug)]
pub struct Setting {
    /// Its title; without one what it is of.
    pub title: Option<String>,
    /// What recorded replies that differ from the kernel's mean.
    pub replies: Replies,
    /// The layout whose drawing is the plan.
    pub layout: Option<Description>,
    /// What a model knows of each step.
    pub words: Vec<Words>,
    /// The kernel's interlocking as a WebAssembly module, for the page: `atc-film-kernel`.
    pub kernel: Option<Vec<u8>>,
}

impl Default for Setting {
    fn default() -> Self {
        Self { title: None, replies: Replies::MustAgree, layout: None, words: Vec::new(), kernel: None }
    }
}

/// A case that was run through the kernel, as a film is made of it.
pub struct Take<'a, M: Machine> {
    /// Its configuration.
    pub config: &'a M::Config,
    /// Its cycles.
    pub cycles: &'a [Cycle<M>],
    /// The body of each step as it was recorded.
    pub steps: &'a [Value],
    /// How the film is made.
    pub setting: &'a Setting,
}
