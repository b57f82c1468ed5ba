//! One scene's part of a drawing: which cycles of it are in view, and where they stand.

use super::ink::{LEFT, RIGHT};
use super::scene::Scene;
use super::view::View;
use crate::trace::error::TraceError;
use atc_protocol::form::Fault;

/// One scene's part of the drawing: its window of cycles and where it stands on the page.
pub(super) struct Plot<'a> {
    pub(super) scene: &'a Scene,
    pub(super) from: f64,
    pub(super) to: f64,
}

impl<'a> Plot<'a> {
    pub(super) fn new(scene: &'a Scene, view: &View, place: usize) -> Result<Self, TraceError> {
        let end = scene.unit.value(scene.cycles);
        let (from, to) = (view.from.unwrap_or(0), view.to.unwrap_or(end).min(end));
        if from >= to {
            let unit = scene.unit.name;
            let fault = Fault::whole(format!(
                "case {} is {end} {unit} long; the view from {from} to {} {unit} shows nothing of it",
                place + 1,
                view.to.unwrap_or(end)
            ));
            return Err(TraceError { line: 0, fault });
        }
        let per_cycle = f64::from(scene.unit.per_cycle);
        Ok(Self { scene, from: float(from) / per_cycle, to: float(to) / per_cycle })
    }

    pub(super) fn x(&self, cycle: f64) -> f64 {
        LEFT + (cycle - self.from) / (self.to - self.from) * (RIGHT - LEFT)
    }

    /// The part of a span that is in view, in pixels.
    pub(super) fn clip(&self, from: u64, to: u64) -> Option<(f64, f64)> {
        let (from, to) = (float(from).max(self.from), float(to).min(self.to));
        (from < to).then(|| (self.x(from), self.x(to)))
    }
}

#[expect(clippy::cast_precision_loss, reason = "a chart of 2^53 cycles is not drawn")]
pub(super) fn float(cycles: u64) -> f64 {
    cycles as f64
}
