//! Lengths, distances, speeds and times, counted anew in floating point.

use std::collections::{BTreeMap, BTreeSet};

use atc_kernel::interlocking::{CircuitSet, Size, SpeedCode};
use atc_kernel::time::Ticks;

use super::routes::Way;
use super::sides::{Sides, difference, members};
use super::tracks::Vehicle;
use crate::form::Position;
use crate::problem::Problem;

/// What a fall of a thousandth takes off a brake, in m/s².
const FALL: f64 = 9.80665e-3;

impl<const R: usize, const P: usize, const N: usize, const S: usize, Z: Size> Sides<'_, R, P, N, S, Z> {
    /// The speed of a code, in km/h.
    fn kmh(&self, code: SpeedCode) -> u16 {
        let place = usize::from(code.0).checked_sub(1);
        place.and_then(|place| self.station.braking.speeds_kmh.value.get(place)).copied().unwrap_or(0)
    }

    /// How far a train runs from a speed in km/h while what it was told ages, and braking with the least brake on the steepest fall, in m.
    fn runs_m(&self, kmh: u16) -> f64 {
        let steepest = self.station.circuits.iter().filter_map(|circuit| circuit.gradient.as_ref());
        let fall = steepest.map(|gradient| f64::from(gradient.value).abs()).fold(0.0, f64::max);
        let brake = f64::from(self.station.braking.deceleration_mm_s2.value) / 1000.0 - fall * FALL;
        let speed = f64::from(kmh) / 3.6;
        speed * speed / (2.0 * brake) + speed * f64::from(self.station.times.telegram_age_ms.value) / 1000.0
    }

    pub(super) fn numbers(&self, found: &mut Vec<Problem>) {
        let (station, plan) = (self.station, self.plan);
        let mut differs = |what: String| found.push(difference(&(0..0), what));
        for (given, length) in station.circuits.iter().zip(&plan.lengths) {
            if given.length_m.value != length.0 {
                differs(format!(
                    "circuit {} is {} m long, and the plan has {} m",
                    given.name, given.length_m, length.0
                ));
            }
        }
        for code in 1..=station.braking.speeds_kmh.value.len() {
            let kmh = station.braking.speeds_kmh.value[code - 1];
            let needed = self.runs_m(kmh) + f64::from(station.braking.heard_beyond_m.value);
            if f64::from(plan.braking[code].0) < needed.floor() {
                differs(format!(
                    "from {kmh} km/h a train runs {needed:.0} m, and the plan has {} m",
                    plan.braking[code].0
                ));
            }
        }
        for (given, segment) in station.segments.iter().zip(&plan.segments) {
            let most =
                given.speed_kmh.as_ref().or(station.speed.line_kmh.as_ref()).map_or(u16::MAX, |speed| speed.value);
            for circuit in members(segment.all()) {
                let kmh = self.kmh(plan.line.over(CircuitSet::nth(circuit)));
                if kmh > most {
                    differs(format!("segment {}: {kmh} km/h is its limit, and the file has {most}", given.name));
                }
            }
        }
        let times = &station.times;
        let ms = |ticks: Ticks| u64::from(ticks.0) * u64::from(times.cycle_ms.value);
        for (what, cycles, least) in [
            ("clear_ms", Ticks(plan.clear.into()), Some(&times.clear_ms)),
            ("shunt_loss_ms", Ticks(plan.loss.into()), Some(&times.shunt_loss_ms)),
            ("settle_ms", Ticks(plan.settle.into()), Some(&times.settle_ms)),
            ("turn_ms", plan.turn, times.turn_ms.as_ref()),
            ("start_ms", plan.start, times.start_ms.as_ref()),
            ("residual_ms", plan.residual, times.residual_ms.as_ref()),
            ("standstill_ms", plan.standstill, times.standstill_ms.as_ref()),
        ] {
            if least.is_some_and(|least| ms(cycles) < u64::from(least.value)) {
                differs(format!("{what} of the plan is {} ms, less than the file's", ms(cycles)));
            }
        }
        for number in 0..station.routes.len().min(R) {
            self.times(number, found);
        }
    }

    fn times(&self, number: usize, found: &mut Vec<Problem>) {
        let (given, route, times) = (&self.station.routes[number], &self.plan.routes[number], &self.station.times);
        let ms = |ticks: Ticks| u64::from(ticks.0) * u64::from(times.cycle_ms.value);
        let least = |own: &Option<crate::At<u32>>, all: u32| u64::from(own.as_ref().map_or(all, |own| own.value));
        let stay = times.stay_ms.as_ref().map_or(0, |stay| stay.value);
        for (what, wrong) in [
            ("release_ms", ms(route.release) < least(&given.release_ms, times.release_ms.value)),
            ("stay_ms", ms(route.stay) < least(&given.stay_ms, stay)),
            ("drive_ms", ms(route.drive) > least(&given.drive_ms, times.drive_ms.value)),
            ("cab_signalled", route.cab_signalled && !self.station.cab_signalled),
            ("berth", route.calling_on == given.berth.is_empty()),
        ] {
            if wrong {
                found.push(self.differs(number, &format!("{what} of the plan lets more happen than the file")));
            }
        }
    }

    /// What is asked of a route besides its way: its speed, and that a braking train that has seen its signal is in its approach.
    pub(super) fn approaches(&self, ways: &[Option<Way>], found: &mut Vec<Problem>) {
        let station = self.station;
        for (number, way) in ways.iter().enumerate() {
            let (Some(way), given, route) = (way, &station.routes[number], &self.plan.routes[number]) else { continue };
            let reverse =
                way.run.iter().any(|train| matches!(self.tracks.piece(*train).over, Some((_, Position::Reverse))));
            let speed = &station.speed;
            let slowest = station.braking.speeds_kmh.value.first().copied().unwrap_or(0);
            let straight = speed.route_kmh.as_ref().or(speed.line_kmh.as_ref()).map_or(u16::MAX, |speed| speed.value);
            let over_points = speed.reverse_kmh.as_ref().map_or(slowest, |speed| speed.value);
            let most = given.speed_kmh.as_ref().map_or(if reverse { over_points } else { straight }, |own| own.value);
            let on_sight = speed.calling_on_kmh.as_ref().map_or(slowest, |speed| speed.value);
            let most = if given.berth.is_empty() { most } else { most.min(on_sight) };
            if self.kmh(route.speed) > most {
                let what = format!("its trains run at {} km/h, and the file allows {most}", self.kmh(route.speed));
                found.push(self.differs(number, &what));
            }
            let beyond = if route.overlap.positions.reverse.is_empty() { straight } else { over_points };
            if self.kmh(route.overlap_speed) > beyond {
                let what = format!(
                    "trains that have slid into its overlap leave it at {} km/h, and the file allows {beyond}",
                    self.kmh(route.overlap_speed)
                );
                found.push(self.differs(number, &what));
            }
            self.approach(number, way, ways, found);
        }
    }

    fn approach(&self, number: usize, way: &Way, ways: &[Option<Way>], found: &mut Vec<Problem>) {
        let (given, route) = (&self.station.routes[number], &self.plan.routes[number]);
        let Some(entry) = members(route.entry).next() else { return };
        let highest = self.station.braking.speeds_kmh.value.last().copied().unwrap_or(0);
        let line = self.station.speed.line_kmh.as_ref().map_or(highest, |line| line.value);
        let leads = |(other, its): (usize, &Option<Way>)| {
            let there = its.as_ref()?.exit == way.start && self.path(other)?.last() == Some(&entry);
            there.then(|| self.kmh(self.plan.routes[other].speed))
        };
        let own = given.approach_kmh.as_ref().map_or(line, |own| own.value);
        let kmh = ways.iter().enumerate().filter_map(leads).fold(own, u16::max);
        let lost_m = f64::from(kmh) / 3.6 * f64::from(self.station.times.shunt_loss_ms.value) / 1000.0;
        let needed = self.runs_m(kmh) + f64::from(self.station.braking.heard_beyond_m.value) + lost_m;
        let ahead = route.held_from(0).circuits.or(route.overlap.circuits);
        // Back from the signal: how near to it a train may be that has just come off a circuit.
        let mut nearest: BTreeMap<Vehicle, u32> = BTreeMap::new();
        let mut open: Vec<(Vehicle, u32)> =
            self.tracks.at_joint(entry, way.start, true).map(|train| (train, 0)).collect();
        while let Some((train, metres)) = open.pop() {
            let circuit = self.tracks.piece(train).circuit;
            let known = nearest.get(&train).is_some_and(|known| *known <= metres);
            if known || f64::from(metres) >= needed.floor() || ahead.meets(CircuitSet::nth(circuit)) {
                continue;
            }
            nearest.insert(train, metres);
            for before in self.tracks.before(train) {
                let leaves = self.tracks.piece(before).circuit != circuit;
                let length = if leaves { self.station.circuits[circuit].length_m.value } else { 0 };
                open.push((before, metres + u32::from(length)));
            }
        }
        for (train, metres) in nearest {
            let circuit = self.tracks.piece(train).circuit;
            if !route.approach.meets(CircuitSet::nth(circuit)) {
                let what = format!(
                    "a train at {kmh} km/h needs {needed:.0} m; in {} it is {metres} m from the signal, and not in its approach",
                    self.circuit(circuit)
                );
                found.push(self.differs(number, &what));
            }
        }
        for circuit in self.where_ends_are_changed(number, way, ways) {
            if !route.approach.meets(CircuitSet::nth(circuit)) {
                let what = format!(
                    "a driver who changes ends in {} goes by its signal, and it is not in its approach",
                    self.circuit(circuit)
                );
                found.push(self.differs(number, &what));
            }
        }
    }

    /// The circuits from which a train runs to the signal of a route, wherever it begins there: over no point and no other track, and past no other signal.
    /// None on plain line, and none where telegrams alone count.
    fn where_ends_are_changed(&self, number: usize, way: &Way, ways: &[Option<Way>]) -> BTreeSet<usize> {
        let route = &self.plan.routes[number];
        let held = route.held_from(0).circuits.or(route.overlap.circuits);
        let lines = self.plan.segments.iter().fold(CircuitSet::EMPTY, |all, segment| all.or(segment.all()));
        let mut seen = BTreeSet::new();
        let mut found = BTreeSet::new();
        let entry = members(route.entry).next();
        let mut open: Vec<Vehicle> = entry.map_or_else(Vec::new, |entry| {
            self.tracks.at_joint(entry, way.start, true).filter(|_| !self.station.cab_signalled).collect()
        });
        while let Some(train) = open.pop() {
            let piece = self.tracks.piece(train);
            let alone =
                self.tracks.pieces.iter().all(|other| other.circuit != piece.circuit || other.track == piece.track);
            let elsewhere = lines.or(held).meets(CircuitSet::nth(piece.circuit));
            if !alone || piece.over.is_some() || elsewhere || !seen.insert(train) {
                continue;
            }
            found.insert(piece.circuit);
            let passed = |joint: usize, circuit: usize| {
                ways.iter().zip(&self.plan.routes).any(|(way, other)| {
                    let here = other.entry == CircuitSet::nth(circuit) && other.heading == route.heading;
                    here && way.as_ref().is_some_and(|way| way.start == joint)
                })
            };
            let behind = self.tracks.behind(train);
            open.extend(self.tracks.before(train).filter(|before| !passed(behind, self.tracks.piece(*before).circuit)));
        }
        found
    }
}
