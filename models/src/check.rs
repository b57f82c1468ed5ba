//! The entries of the catalogue, checked or shown.

use crate::explorer::{self, Explored, Shown};
use crate::outcome::Outcome;
use crate::search::{Search, search};
use crate::subject::{Checked, Limits, Subject};
use crate::twin::Twin;
use std::io;
use std::net::{SocketAddr, TcpListener};
use std::sync::Arc;

/// What a model is about: everything of an [`Entry`] but the model.
#[derive(Clone, Debug)]
pub struct About {
    /// Its name, unique in the catalogue, in kebab-case.
    pub name: &'static str,
    /// What it shows, in plain English.
    pub statement: String,
    /// The requirements and theorems that it checks, as in the specification.
    pub requirements: &'static [&'static str],
    /// The environment in words.
    pub environment: String,
    /// The assumptions in force, by id.
    pub in_force: &'static [&'static str],
    /// The assumptions that are deliberately lifted, by id.
    pub lifted: &'static [&'static str],
}

/// One model of the catalogue.
pub struct Entry {
    /// Its name, unique in the catalogue, in kebab-case.
    pub name: &'static str,
    /// What it shows, in plain English.
    pub statement: String,
    /// The requirements and theorems that it checks, as in the specification.
    pub requirements: &'static [&'static str],
    /// Parameters and environment in words.
    pub parameters: String,
    /// The assumptions in force, by id.
    pub in_force: &'static [&'static str],
    /// The assumptions that are deliberately lifted, by id.
    pub lifted: &'static [&'static str],
    /// The same model in Promela, if it is written there too.
    pub twin: Option<Twin>,
    search: Box<dyn Fn(usize, Limits) -> Search + Send + Sync>,
    explored: Arc<dyn Explored>,
}

impl Entry {
    /// The model `subject`, and what it is about.
    pub fn new<S: Subject>(about: About, subject: S) -> Self {
        let explored = Arc::new(Checked::new(subject.clone(), None, Limits::default()));
        let parameters = format!("{}; {}", subject.parameters(), about.environment);
        Self {
            name: about.name,
            statement: about.statement,
            requirements: about.requirements,
            parameters,
            in_force: about.in_force,
            lifted: about.lifted,
            twin: subject.twin(),
            search: Box::new(move |threads, limits| search(&subject, threads, limits)),
            explored,
        }
    }
}

/// Checks one model with `threads` threads (at least one). The number of threads changes nothing but the time and,
/// by a little, the depth that is reported.
pub fn check(entry: &Entry, threads: usize) -> Outcome {
    check_within(entry, threads, Limits::default())
}

/// Checks one model within `limits`.
pub fn check_within(entry: &Entry, threads: usize, limits: Limits) -> Outcome {
    let found = (entry.search)(threads, limits);
    let owned = |ids: &[&str]| ids.iter().map(ToString::to_string).collect();
    Outcome {
        model: entry.name.to_owned(),
        statement: entry.statement.clone(),
        requirements: owned(entry.requirements),
        parameters: entry.parameters.clone(),
        assumptions_in_force: owned(entry.in_force),
        assumptions_lifted: owned(entry.lifted),
        complete: found.complete,
        unique_states: found.unique,
        generated_states: found.generated,
        max_depth: found.depth,
        seconds: found.seconds,
        properties: found.properties,
        cut_sets: found.cut_sets,
        failure_modes: found.failure_modes,
    }
}

/// A model of the catalogue, as the Explorer has it.
pub fn shown(entry: &Entry) -> Shown {
    Shown(Arc::clone(&entry.explored))
}

/// Serves Stateright's Explorer for one model on `address`, until the process ends.
///
/// # Errors
/// If the address cannot be bound.
pub fn explore(entry: &Entry, address: SocketAddr) -> io::Result<()> {
    // The server itself panics on an address that is taken.
    drop(TcpListener::bind(address)?);
    explorer::serve(&entry.explored, address);
    Ok(())
}
