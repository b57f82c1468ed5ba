//! The other configuration: a plan in the kernel's own terms, with names. It is what the traces of the models are on.

use atc_kernel::distance::Metres;
use atc_kernel::interlocking::{
    self as kernel, CircuitSet, Element, Layout, PointSet, Positions, RouteSet, Segment, SegmentSet, Size, SpeedCode,
};
use atc_kernel::time::Ticks;
use atc_layout::{Extent, Names, Rule};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::opened::Opened;
use super::{ByName, Heading, Interlocked, Side, place, set};

/// A plan in the kernel's own terms: nothing is derived, and only the rules that the theorems rest on are checked. The rules of
/// engineering are checked if `rules` is true, and else not, so that a trace on a bad layout, which ends in an accident, can be replayed.
/// Not for a real station.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "InterlockingPlan")]
pub struct PlanConfig {
    /// The name of the station.
    pub station: String,
    /// The length of a logic cycle in ms.
    #[schemars(range(min = 1))]
    pub cycle_ms: u32,
    /// How many cycles in a row a circuit must be reported clear before it counts as clear.
    pub clear_cycles: u8,
    /// For how many cycles the neighbour's permission must have been withdrawn before a segment turns.
    pub turn_cycles: u16,
    /// For how many cycles after a start nothing moves, is confirmed or turned.
    #[serde(default)]
    pub start_cycles: u16,
    /// For how many cycles in a row a point must be detected, undriven, before it counts as detected.
    #[serde(default)]
    pub settle_cycles: u8,
    /// For how many cycles in a row an occupied circuit may at most not be reported: less than `clear_cycles`.
    #[serde(default)]
    pub loss_cycles: u8,
    /// For how many cycles a train may run on after its authority was taken away.
    #[serde(default)]
    pub residual_cycles: u16,
    /// For how many cycles a train may still slide once it is wholly on the last circuit of a route.
    #[serde(default)]
    pub standstill_cycles: u16,
    /// Whether the rules of engineering that are about a plan alone are checked as well (spec/protocol.md).
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub rules: bool,
    /// The speed of each code from 0 (stop), in km/h; at most 8.
    pub speeds_km_h: Vec<u16>,
    /// The braking distance from each of these speeds, in metres.
    pub braking_m: Vec<u16>,
    /// The circuits.
    pub circuits: Vec<CircuitForm>,
    /// The points.
    pub points: Vec<PointForm>,
    /// The segments of plain line.
    pub segments: Vec<SegmentForm>,
    /// The routes.
    pub routes: Vec<RouteForm>,
}

/// A track circuit.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "InterlockingPlanCircuit")]
pub struct CircuitForm {
    /// Its name.
    pub name: String,
    /// Its length in metres.
    pub length_m: u16,
    /// The highest speed code in it, as the line has it; absent: the line has none there.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(max = 7))]
    pub speed_code: Option<u8>,
}

/// A point.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "InterlockingPlanPoint")]
pub struct PointForm {
    /// Its name.
    pub name: String,
    /// The circuits whose occupation says that a train may be on it.
    pub detectors: Vec<String>,
}

/// A segment of plain line.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "InterlockingPlanSegment")]
pub struct SegmentForm {
    /// Its name.
    pub name: String,
    /// Its circuits, the one next to the station first.
    pub circuits: Vec<String>,
    /// The last circuit of the routes that go out to it.
    pub throat: Vec<String>,
    /// The direction of travel away from the station.
    pub outward: Heading,
    /// How many of its circuits, the outermost ones, the neighbour's device sees too.
    #[serde(default)]
    pub shared: u8,
}

/// Circuits, and points with the positions in which they must stand.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "InterlockingPlanElement")]
pub struct ElementForm {
    /// The circuits: one in a path.
    pub circuits: Vec<String>,
    /// The points.
    pub points: ByName<Side>,
    /// The circuits beside it that are proved clear and not run over.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub beside: Vec<String>,
}

/// A route.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "InterlockingPlanRoute")]
pub struct RouteForm {
    /// Its name.
    pub name: String,
    /// The direction of travel.
    pub heading: Heading,
    /// The circuit in rear of its signal.
    pub entry: Vec<String>,
    /// The circuits on which a train may be that counts on the signal.
    pub approach: Vec<String>,
    /// The path in order of travel.
    pub path: Vec<ElementForm>,
    /// The overlap.
    pub overlap: ElementForm,
    /// The circuits that adjoin its end.
    pub beyond: Vec<String>,
    /// The routes that go on where this one ends.
    pub continuing: Vec<String>,
    /// The routes that are declared to conflict.
    pub conflicts: Vec<String>,
    /// The segment that its train comes from: one or none.
    pub from: Vec<String>,
    /// The segment that its train goes out to: one or none.
    pub to: Vec<String>,
    /// How long the points may take to arrive.
    pub drive_cycles: u16,
    /// How long it stays locked when it is withdrawn.
    pub release_cycles: u16,
    /// How long a train must have stood on the last circuit before the overlap is given up.
    pub stay_cycles: u16,
    /// The highest speed code.
    #[schemars(range(max = 7))]
    pub speed_code: u8,
    /// The highest speed code on its overlap; absent: that of the route.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(max = 7))]
    pub overlap_speed_code: Option<u8>,
    /// Whether every train that uses it acts on telegrams alone, not on what a driver sees of the signal.
    #[serde(default)]
    pub cab_signalled: bool,
    /// Whether it is a calling-on route: its train goes on sight into the overlap, the berth, where another one stands.
    #[serde(default)]
    pub calling_on: bool,
}

impl PlanConfig {
    /// The plan of a machine's layout, as far as it has names: [`PlanConfig::opened`] reads it again.
    pub(super) fn of<const R: usize, const P: usize, const N: usize, const S: usize, Z: Size>(
        machine: &Interlocked<R, P, N, S, Z>,
    ) -> Self {
        let Interlocked { layout, names, speeds_kmh, cycle_ms, .. } = machine;
        let plan = layout.plan();
        let limits = plan.line.parts();
        let circuits = names.circuits.iter().zip(&plan.lengths).enumerate().map(|(number, (name, length))| {
            let limit = (0..).zip(&limits).find(|(_, limited)| limited.meets(CircuitSet::nth(number)));
            CircuitForm { name: name.clone(), length_m: length.0, speed_code: limit.map(|(code, _)| code) }
        });
        let listed = |each: &[CircuitSet<Z>]| each.iter().flat_map(|one| machine.circuits_of::<Vec<_>>(*one)).collect();
        let points = names.points.iter().zip(&plan.points);
        let points = points
            .map(|(name, point)| PointForm { name: name.clone(), detectors: machine.circuits_of(point.detectors) });
        let segments = names.segments.iter().zip(&plan.segments).map(|(name, segment)| SegmentForm {
            name: name.clone(),
            circuits: listed(&segment.circuits[..usize::from(segment.length)]),
            throat: machine.circuits_of(segment.throat),
            outward: Heading(segment.outward),
            shared: segment.shared,
        });
        let element = |element: &Element<Z>| ElementForm {
            circuits: machine.circuits_of(element.circuits),
            points: ByName(machine.sides(element.positions)),
            beside: machine.circuits_of(element.beside),
        };
        let routes = names.routes.iter().zip(&plan.routes).map(|(name, route)| RouteForm {
            name: name.clone(),
            heading: Heading(route.heading),
            entry: machine.circuits_of(route.entry),
            approach: machine.circuits_of(route.approach),
            path: route.path[..usize::from(route.length)].iter().map(element).collect(),
            overlap: element(&route.overlap),
            beyond: machine.circuits_of(route.beyond),
            continuing: machine.routes_of(route.continuing),
            conflicts: machine.routes_of(route.conflicts),
            from: machine.segments_of(route.from),
            to: machine.segments_of(route.to),
            drive_cycles: route.drive.0,
            release_cycles: route.release.0,
            stay_cycles: route.stay.0,
            speed_code: route.speed.0,
            overlap_speed_code: Some(route.overlap_speed.0),
            cab_signalled: route.cab_signalled,
            calling_on: route.calling_on,
        });
        let codes = 1 + speeds_kmh.iter().skip(1).take_while(|speed| **speed > 0).count();
        Self {
            station: names.station.clone(),
            cycle_ms: *cycle_ms,
            clear_cycles: plan.clear,
            turn_cycles: plan.turn.0,
            start_cycles: plan.start.0,
            settle_cycles: plan.settle,
            loss_cycles: plan.loss,
            residual_cycles: plan.residual.0,
            standstill_cycles: plan.standstill.0,
            rules: false,
            speeds_km_h: speeds_kmh[..codes].to_vec(),
            braking_m: plan.braking.map(|braking| braking.0).to_vec(),
            circuits: circuits.collect(),
            points: points.collect(),
            segments: segments.collect(),
            routes: routes.collect(),
        }
    }

    /// How much there is in it.
    pub(super) fn extent(&self) -> Extent {
        let paths = self.routes.iter().map(|route| route.path.len());
        let segments = self.segments.iter().map(|segment| segment.circuits.len());
        Extent::new(self.circuits.len(), self.points.len(), paths, segments)
    }

    /// The layout, and the names of its numbers.
    ///
    /// # Errors
    /// What there is no room for, a name that stands twice or for nothing, and the first rule that the plan breaks.
    pub(super) fn opened<const R: usize, const P: usize, const N: usize, const S: usize, Z: Size>(
        &self,
    ) -> Result<Opened<R, P, N, S, Z>, String> {
        if self.cycle_ms == 0 {
            return Err("cycle_ms is 0; a cycle lasts 1 ms or more".to_owned());
        }
        if self.speeds_km_h.first() != Some(&0) || !self.speeds_km_h.is_sorted() {
            return Err("speeds_km_h must begin with 0, the speed of code 0, and not fall".to_owned());
        }
        // Before names are looked up: one that is listed beyond the room there is would be unknown.
        for (field, count, most) in [
            ("circuits", self.circuits.len(), CircuitSet::<Z>::MOST),
            ("points", self.points.len(), N),
            ("segments", self.segments.len(), S),
            ("routes", self.routes.len(), R),
        ] {
            if count > most {
                return Err(too_many(field, most));
            }
        }
        let names = self.names()?;
        let mut speeds = [0; kernel::MAX_CODES];
        let mut plan = Box::new(kernel::Plan::<R, P, N, S, Z>::EMPTY);
        fill(&mut speeds, self.speeds_km_h.iter().copied(), "speeds_km_h")?;
        fill(&mut plan.braking, self.braking_m.iter().map(|metres| Metres(*metres)), "braking_m")?;
        fill(&mut plan.lengths[..], self.circuits.iter().map(|circuit| Metres(circuit.length_m)), "circuits")?;
        for (number, circuit) in self.circuits.iter().enumerate() {
            if let Some(code) = circuit.speed_code {
                let code = speed_code(&format!("circuit {}: speed_code", circuit.name), code)?;
                plan.line = plan.line.and(kernel::SpeedLimits::NONE.and_at_most(code, CircuitSet::nth(number)));
            }
        }
        plan.clear = self.clear_cycles;
        plan.turn = Ticks(self.turn_cycles);
        plan.start = Ticks(self.start_cycles);
        plan.settle = self.settle_cycles;
        plan.loss = self.loss_cycles;
        plan.residual = Ticks(self.residual_cycles);
        plan.standstill = Ticks(self.standstill_cycles);
        for (place, point) in plan.points.iter_mut().zip(&self.points) {
            let detectors = circuits(&names, &point.detectors, "detectors");
            place.detectors = detectors.map_err(|why| format!("point {}: {why}", point.name))?;
        }
        for (place, segment) in plan.segments.iter_mut().zip(&self.segments) {
            *place = segment_of(&names, segment).map_err(|why| format!("segment {}: {why}", segment.name))?;
        }
        for (place, route) in plan.routes.iter_mut().zip(&self.routes) {
            *place = route_of(&names, route).map_err(|why| format!("route {}: {why}", route.name))?;
        }
        let checked = if self.rules { Layout::new(*plan) } else { Layout::with_what_proofs_need(*plan) };
        let layout = checked
            .map_err(|broken| format!("{} [{}]", names.broken(broken, &plan), Rule::Plan(broken.rule).name()))?;
        Ok(Opened { layout: Box::new(layout), names, speeds_kmh: speeds, cycle_ms: self.cycle_ms, said: None })
    }

    fn names(&self) -> Result<Names, String> {
        let routes = distinct(self.routes.iter().map(|route| &route.name), "route")?;
        Ok(Names {
            station: self.station.clone(),
            circuits: distinct(self.circuits.iter().map(|circuit| &circuit.name), "circuit")?,
            points: distinct(self.points.iter().map(|point| &point.name), "point")?,
            signals: routes.clone(),
            routes,
            segments: distinct(self.segments.iter().map(|segment| &segment.name), "segment")?,
        })
    }
}

fn distinct<'a>(given: impl Iterator<Item = &'a String>, kind: &str) -> Result<Vec<String>, String> {
    let mut names = Vec::new();
    for name in given {
        if names.contains(name) {
            return Err(format!("two {kind}s have the name {name:?}; each {kind} has its own"));
        }
        names.push(name.clone());
    }
    Ok(names)
}

fn fill<T>(places: &mut [T], values: impl IntoIterator<Item = T>, field: &str) -> Result<(), String> {
    let most = places.len();
    let mut places = places.iter_mut();
    for value in values {
        *places.next().ok_or_else(|| too_many(field, most))? = value;
    }
    Ok(())
}

fn too_many(field: &str, most: usize) -> String {
    format!("{field} has more than {most} entries; there is room for {most}")
}

fn circuits<Z: Size>(names: &Names, list: &[String], field: &str) -> Result<CircuitSet<Z>, String> {
    set(&names.circuits, list, field, "circuit", CircuitSet::EMPTY, |all, number| all.or(CircuitSet::nth(number)))
}

fn routes<Z: Size>(names: &Names, list: &[String], field: &str) -> Result<RouteSet<Z>, String> {
    set(&names.routes, list, field, "route", RouteSet::EMPTY, |all, number| all.or(RouteSet::nth(number)))
}

fn segments<Z: Size>(names: &Names, list: &[String], field: &str) -> Result<SegmentSet<Z>, String> {
    set(&names.segments, list, field, "segment", SegmentSet::EMPTY, |all, number| all.or(SegmentSet::nth(number)))
}

fn element<Z: Size>(names: &Names, form: &ElementForm, field: &str) -> Result<Element<Z>, String> {
    let mut positions = Positions::NONE;
    for (name, Side(position)) in &form.points.0 {
        let point = PointSet::nth(place(&names.points, name, field, "point")?.into());
        match position {
            kernel::Position::Normal => positions.normal = positions.normal.or(point),
            kernel::Position::Reverse => positions.reverse = positions.reverse.or(point),
        }
    }
    let beside = circuits(names, &form.beside, field)?;
    Ok(Element { circuits: circuits(names, &form.circuits, field)?, positions, beside })
}

fn speed_code(field: &str, code: u8) -> Result<SpeedCode, String> {
    if code > SpeedCode::MOST.0 {
        return Err(format!("{field} is {code}; it is 0 to {}", SpeedCode::MOST.0));
    }
    Ok(SpeedCode(code))
}

fn segment_of<const P: usize, Z: Size>(names: &Names, form: &SegmentForm) -> Result<Segment<P, Z>, String> {
    let throat = circuits(names, &form.throat, "throat")?;
    let mut made = Segment { throat, outward: form.outward.0, shared: form.shared, ..Segment::NONE };
    let listed = form.circuits.iter().map(|name| circuits(names, std::slice::from_ref(name), "circuits"));
    fill(&mut made.circuits, listed.collect::<Result<Vec<_>, _>>()?, "circuits")?;
    made.length = length_of::<P>(form.circuits.len(), "circuits")?;
    Ok(made)
}

fn route_of<const P: usize, Z: Size>(names: &Names, form: &RouteForm) -> Result<kernel::Route<P, Z>, String> {
    let overlap_speed = form.overlap_speed_code.unwrap_or(form.speed_code);
    let mut made = kernel::Route {
        heading: form.heading.0,
        entry: circuits(names, &form.entry, "entry")?,
        approach: circuits(names, &form.approach, "approach")?,
        length: length_of::<P>(form.path.len(), "path")?,
        overlap: element(names, &form.overlap, "overlap")?,
        beyond: circuits(names, &form.beyond, "beyond")?,
        continuing: routes(names, &form.continuing, "continuing")?,
        conflicts: routes(names, &form.conflicts, "conflicts")?,
        from: segments(names, &form.from, "from")?,
        to: segments(names, &form.to, "to")?,
        drive: Ticks(form.drive_cycles),
        release: Ticks(form.release_cycles),
        stay: Ticks(form.stay_cycles),
        speed: speed_code("speed_code", form.speed_code)?,
        overlap_speed: speed_code("overlap_speed_code", overlap_speed)?,
        cab_signalled: form.cab_signalled,
        calling_on: form.calling_on,
        ..kernel::Route::NONE
    };
    let path = form.path.iter().map(|at| element(names, at, "path")).collect::<Result<Vec<_>, _>>()?;
    fill(&mut made.path, path, "path")?;
    Ok(made)
}

/// In a plan of the kernel a length of 0 means that there is no such thing; what is listed is there.
fn length_of<const P: usize>(circuits: usize, field: &str) -> Result<u8, String> {
    let length = u8::try_from(circuits).ok().filter(|length| *length > 0);
    length.ok_or_else(|| format!("{field} has {circuits} circuits; it has 1 to {P}"))
}
