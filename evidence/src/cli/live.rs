//! The results while they come in, and the page of them: it is written early, again and again, and always says that the run
//! has not ended.

use crate::cli::progress::Progress;
use crate::error::Fault;
use crate::judge::build::{Required, Results, build};
use crate::judge::plan::Plan;
use crate::render::html;
use crate::render::output::Folder;
use crate::sources::provenance::now;
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

/// The page is written at most this often.
const PAGE: Duration = Duration::from_secs(10);
/// And so that writing it takes at most one part of so many of the time.
const SHARE: u32 = 50;

/// The results of a run that goes on.
#[derive(Debug)]
pub struct Live<'a> {
    plan: &'a Plan,
    required: Required,
    folder: &'a Folder,
    /// What runs.
    pub progress: Progress,
    state: Mutex<State>,
}

#[derive(Debug)]
struct State {
    results: Results,
    changed: bool,
    due: Instant,
}

impl<'a> Live<'a> {
    /// Shows the page of a run that begins, in place of whatever an earlier run has left.
    ///
    /// # Errors
    /// The page cannot be written.
    pub fn begin(
        plan: &'a Plan,
        required: Required,
        folder: &'a Folder,
        progress: Progress,
        results: Results,
    ) -> Result<Self, Fault> {
        let results = Results { running: true, ..results };
        let state = Mutex::new(State { results, changed: false, due: Instant::now() + PAGE });
        let live = Self { plan, required, folder, progress, state };
        folder.clear(&live.page()?)?;
        Ok(live)
    }

    fn lock(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Enters something.
    pub fn with<T>(&self, enter: impl FnOnce(&mut Results) -> T) -> T {
        let mut state = self.lock();
        state.changed = true;
        enter(&mut state.results)
    }

    fn page(&self) -> Result<String, Fault> {
        let mut results = self.lock().results.clone();
        results.provenance.generated_unix = now();
        Ok(html::document(&build(self.plan, results, self.required)?))
    }

    /// Shows the line of progress, and the page, if they are due.
    pub fn tick(&self) {
        self.progress.tick();
        let due = {
            let mut state = self.lock();
            let due = state.changed && Instant::now() >= state.due;
            state.changed &= !due;
            due
        };
        if due {
            let start = Instant::now();
            if let Err(fault) = self.page().and_then(|page| self.folder.show(&page)) {
                // The end of the run needs the same folder, and fails if it cannot be written.
                eprintln!("the page could not be written: {fault}");
            }
            self.lock().due = Instant::now() + PAGE.max(start.elapsed() * SHARE);
        }
    }

    /// The results, when the run is over.
    pub fn end(self) -> Results {
        self.progress.finish();
        let state = self.state.into_inner().unwrap_or_else(PoisonError::into_inner);
        Results { running: false, ..state.results }
    }
}
