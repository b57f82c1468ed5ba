//! Plain line, and what detects a point.

use std::collections::BTreeSet;

use atc_kernel::interlocking::{Heading, Size};

use super::sides::{Sides, difference, members};
use super::tracks::Vehicle;
use crate::problem::Problem;

impl<const R: usize, const P: usize, const N: usize, const S: usize, Z: Size> Sides<'_, R, P, N, S, Z> {
    pub(super) fn lines(&self, found: &mut Vec<Problem>) {
        for (given, segment) in self.station.segments.iter().zip(&self.plan.segments) {
            let circuits: Vec<usize> =
                segment.circuits.iter().take(segment.length.into()).flat_map(|circuit| members(*circuit)).collect();
            let named: Vec<&str> = circuits.iter().map(|circuit| self.circuit(*circuit)).collect();
            let mut differs = |what: String| {
                found.push(difference(&given.name.span, format!("segment {}: {what}", given.name)));
            };
            if !named.iter().copied().eq(given.circuits.iter().map(|name| name.value.as_str())) {
                differs(format!("the file has other circuits than {}", named.join(", ")));
            }
            if usize::from(segment.shared) != given.shared.len() {
                differs(format!("{} circuits are shared, and the file has {}", segment.shared, given.shared.len()));
            }
            let toward = usize::from(segment.outward == Heading::Right);
            let leads_out = (0..self.tracks.pieces.len()).any(|piece| {
                let vehicle = Vehicle { piece, toward };
                let begins = members(segment.throat).all(|throat| {
                    self.tracks.before(vehicle).any(|before| self.tracks.piece(before).circuit == throat)
                });
                begins && self.leads_out(vehicle, &circuits)
            });
            if !leads_out {
                differs(format!(
                    "no train runs out of it over {} to the {:?} to where the line goes on",
                    named.join(", "),
                    segment.outward
                ));
            }
        }
        self.detectors(found);
    }

    /// Whether a vehicle runs through these circuits in order, over plain track, to where the line goes on.
    fn leads_out(&self, vehicle: Vehicle, circuits: &[usize]) -> bool {
        let piece = self.tracks.piece(vehicle);
        let Some((first, others)) = circuits.split_first() else { return false };
        if piece.circuit != *first || piece.over.is_some() {
            return false;
        }
        if others.is_empty() {
            return self.tracks.is_line(self.tracks.ahead(vehicle));
        }
        self.tracks.onward(vehicle).any(|next| self.leads_out(next, others))
    }

    /// A point is detected by the circuit it lies in and by those in which it is fouled; and whoever holds one of them holds the point.
    fn detectors(&self, found: &mut Vec<Problem>) {
        for (given, point) in self.station.points.iter().zip(&self.plan.points) {
            let detectors: BTreeSet<usize> = members(point.detectors).collect();
            let named = std::iter::once(&given.circuit).chain(&given.fouled_in);
            for name in named.filter(|name| self.place_of(name).is_none_or(|circuit| !detectors.contains(&circuit))) {
                let what = format!(
                    "point {}: a train in {name} stands on it or fouls it, and is not detected there",
                    given.name
                );
                found.push(difference(&given.name.span, what));
            }
        }
        for number in 0..self.station.routes.len().min(R) {
            let held = self.held(number);
            let Some(path) = self.path(number) else { continue };
            for (point, it) in self.plan.points.iter().enumerate() {
                if members(it.detectors).any(|circuit| path.contains(&circuit)) && !held.contains_key(&point) {
                    let what =
                        format!("point {} may move under its train: nothing holds it", self.station.points[point].name);
                    found.push(self.differs(number, &what));
                }
            }
        }
    }
}
