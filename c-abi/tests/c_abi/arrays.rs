//! The arrays of a plan in the kernel's form, as a C program has them.

use std::ptr;

use atc_c::interlocking::{
    ATC_HEADING_LEFT, ATC_HEADING_RIGHT, atc_element, atc_interlocking_config, atc_route, atc_segment,
};
use atc_kernel::interlocking::{CircuitId, CircuitSet, Element, Heading, Plan, Positions};
use atc_layout::Names;

/// The arrays of a plan, as a C program has them.
#[derive(Clone)]
pub struct Arrays {
    pub lengths_m: Vec<u16>,
    pub line_codes: Vec<u8>,
    pub detectors: Vec<u64>,
    pub segments: Vec<atc_segment>,
    pub segment_circuits: Vec<u8>,
    pub routes: Vec<atc_route>,
    pub elements: Vec<atc_element>,
    pub braking_m: Vec<u16>,
    pub scalars: atc_interlocking_config,
}

/// A direction of travel.
pub fn heading(heading: Heading) -> u8 {
    if heading == Heading::Left { ATC_HEADING_LEFT } else { ATC_HEADING_RIGHT }
}

fn element(element: &Element) -> atc_element {
    let Positions { normal, reverse } = element.positions;
    let (circuits, beside) = (element.circuits.bits(), element.beside.bits());
    atc_element { circuits, normal: normal.bits(), reverse: reverse.bits(), beside }
}

impl Arrays {
    /// The arrays of a plan with as many circuits and so on as have names.
    pub fn of(plan: &Plan<64, 16, 32, 8>, names: &Names) -> Self {
        let (mut elements, mut segment_circuits) = (Vec::new(), Vec::new());
        let mut routes = Vec::new();
        for route in plan.routes.iter().take(names.routes.len()) {
            let path_first = u16::try_from(elements.len()).expect("at most 1024");
            elements.extend(route.path.iter().take(route.length.into()).map(element));
            routes.push(atc_route {
                entry: route.entry.bits(),
                approach: route.approach.bits(),
                beyond: route.beyond.bits(),
                continuing: route.continuing.bits(),
                conflicts: route.conflicts.bits(),
                overlap: element(&route.overlap),
                path_first,
                path_length: route.length.into(),
                drive_cycles: route.drive.0,
                release_cycles: route.release.0,
                stay_cycles: route.stay.0,
                heading: heading(route.heading),
                from: route.from.bits(),
                to: route.to.bits(),
                speed_code: route.speed.0,
                overlap_speed_code: route.overlap_speed.0,
                cab_signalled: route.cab_signalled.into(),
                calling_on: route.calling_on.into(),
            });
        }
        let mut segments = Vec::new();
        for segment in plan.segments.iter().take(names.segments.len()) {
            let circuits_first = u16::try_from(segment_circuits.len()).expect("at most 128");
            let numbers = segment.circuits.iter().take(segment.length.into());
            segment_circuits.extend(numbers.map(|circuit| circuit.first().map_or(u8::MAX, CircuitId::number)));
            segments.push(atc_segment {
                throat: segment.throat.bits(),
                circuits_first,
                circuits_length: segment.length.into(),
                outward: heading(segment.outward),
                shared: segment.shared,
            });
        }
        let circuits = names.circuits.len();
        let code = |number| plan.line.over(CircuitSet::nth(number)).0;
        Self {
            lengths_m: plan.lengths.iter().take(circuits).map(|metres| metres.0).collect(),
            line_codes: (0..circuits).map(code).collect(),
            detectors: plan.points.iter().take(names.points.len()).map(|point| point.detectors.bits()).collect(),
            segments,
            segment_circuits,
            routes,
            elements,
            braking_m: plan.braking.iter().map(|metres| metres.0).collect(),
            scalars: atc_interlocking_config {
                turn_cycles: plan.turn.0,
                start_cycles: plan.start.0,
                residual_cycles: plan.residual.0,
                standstill_cycles: plan.standstill.0,
                clear_cycles: plan.clear,
                settle_cycles: plan.settle,
                loss_cycles: plan.loss,
                ..NOTHING
            },
        }
    }

    /// The configuration that leads to these arrays. It is good for as long as they are.
    pub fn config(&self) -> atc_interlocking_config {
        atc_interlocking_config {
            lengths_m: self.lengths_m.as_ptr(),
            line_codes: self.line_codes.as_ptr(),
            detectors: self.detectors.as_ptr(),
            segments: self.segments.as_ptr(),
            segment_circuits: self.segment_circuits.as_ptr(),
            routes: self.routes.as_ptr(),
            elements: self.elements.as_ptr(),
            braking_m: self.braking_m.as_ptr(),
            circuit_count: self.lengths_m.len(),
            point_count: self.detectors.len(),
            segment_count: self.segments.len(),
            segment_circuit_count: self.segment_circuits.len(),
            route_count: self.routes.len(),
            element_count: self.elements.len(),
            code_count: self.braking_m.len(),
            ..self.scalars
        }
    }
}

const NOTHING: atc_interlocking_config = atc_interlocking_config {
    lengths_m: ptr::null(),
    line_codes: ptr::null(),
    detectors: ptr::null(),
    segments: ptr::null(),
    segment_circuits: ptr::null(),
    routes: ptr::null(),
    elements: ptr::null(),
    braking_m: ptr::null(),
    circuit_count: 0,
    point_count: 0,
    segment_count: 0,
    segment_circuit_count: 0,
    route_count: 0,
    element_count: 0,
    code_count: 0,
    turn_cycles: 0,
    start_cycles: 0,
    residual_cycles: 0,
    standstill_cycles: 0,
    clear_cycles: 0,
    settle_cycles: 0,
    loss_cycles: 0,
};
