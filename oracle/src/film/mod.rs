//! Films of recorded sessions and of the traces of models: [`film`] runs a case through the kernel and lays out its
//! frames.
//!
//! Every machine gets the rows of its chart and the values of each step. The interlocking gets a track plan: from the
//! layout of its configuration, from one that is given, or a schematic after the paths of its routes.

mod inside;
pub(crate) mod interlocking;
mod lanes;
mod plain;
mod schematic;
mod stage;
mod traced;

use atc_film::{Clock, Film};
use atc_layout::Description;
use serde_json::Value;

use crate::chart::Scene;
use crate::drawn::{Cycle, Drawn};
use crate::trace::{Record, Replies, TraceError};
use atc_protocol::machine::Machine;

pub use traced::{Traced, TracedError, read};

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

/// The film of a recorded case.
///
/// # Errors
/// As [`crate::trace::Trace::scenes`]; and a layout that does not fit.
pub fn film(record: &Record, setting: &Setting) -> Result<Film, TraceError> {
    (record.drawing().film)(record, setting)
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

/// Lays out a film: what all machines have in common, then what `M` adds.
///
/// # Errors
/// A sentence: why the layout does not fit.
pub(crate) fn made<M: Drawn>(take: &Take<'_, M>) -> Result<Film, String> {
    let scene: Scene = M::chart(take.config, take.cycles);
    let frames = u32::try_from(take.cycles.len()).map_err(|_| "the case has 2^32 steps or more".to_owned())?;
    let clock = Clock { unit: scene.unit.name.to_owned(), per_frame: scene.unit.per_cycle.max(1), last: None };
    let title = take.setting.title.clone().unwrap_or_else(|| scene.machine.to_owned());
    let mut film = Film::new(&title, clock, frames);
    film.notes.clone_from(&scene.notes);
    lanes::put(&mut film, &scene);
    let shown = M::film(take, &mut film)?;
    if !shown {
        if take.setting.kernel.is_some() {
            return Err(format!(
                "the kernel can be put into films of an interlocking; this session is of {}",
                scene.machine
            ));
        }
        plain::values(&mut film, take);
    }
    traced::words(&mut film, &take.setting.words);
    plain::differences(&mut film, take);
    film.sort_events();
    Ok(film)
}
