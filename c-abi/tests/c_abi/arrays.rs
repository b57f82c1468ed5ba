//! The arrays of a plan in the kernel's form, as a C program has them.

use std::ops::{BitOrAssign, Shl};
use std::ptr;

use atc_c::interlocking::{
    ATC_HEADING_LEFT, ATC_HEADING_RIGHT, atc_set32, atc_set128, atc_set256, element_of, interlocking_config_of,
    route_of, segment_of,
};
use atc_kernel::interlocking::{
    CircuitId, CircuitSet, Element, Heading, Large, Plan, PointSet, Positions, RouteSet, SegmentSet, Size, Small,
};
use atc_layout::Names;

/// A size of station, and the sets that C has for it.
pub trait InC: Size {
    type Circuits: Copy + std::fmt::Debug + Default + PartialEq;
    type Points: Copy + std::fmt::Debug + Default + PartialEq;
    type Segments: Copy + std::fmt::Debug + Default + PartialEq;

    fn circuits(circuits: CircuitSet<Self>) -> Self::Circuits;
    fn routes(routes: RouteSet<Self>) -> Self::Circuits;
    fn points(points: PointSet<Self>) -> Self::Points;
    fn segments(segments: SegmentSet<Self>) -> Self::Segments;
}

impl InC for Small {
    type Circuits = u64;
    type Points = u32;
    type Segments = u8;

    fn circuits(circuits: CircuitSet) -> u64 {
        circuits.bits()
    }

    fn routes(routes: RouteSet) -> u64 {
        routes.bits()
    }

    fn points(points: PointSet) -> u32 {
        points.bits()
    }

    fn segments(segments: SegmentSet) -> u8 {
        segments.bits()
    }
}

/// The words of a set, number by number, as a C program makes it: not by the kernel's own words.
fn words<W>(width: usize, has: impl Fn(usize) -> bool) -> [W; 4]
where
    W: Copy + Default + From<u8> + BitOrAssign + Shl<usize, Output = W>,
{
    let mut words = [W::default(); 4];
    for number in (0..4 * width).filter(|number| has(*number)) {
        words[number / width] |= W::from(1) << (number % width);
    }
    words
}

impl InC for Large {
    type Circuits = atc_set256;
    type Points = atc_set128;
    type Segments = atc_set32;

    fn circuits(circuits: CircuitSet<Large>) -> atc_set256 {
        atc_set256 { words: words(64, |number| circuits.has_number(number)) }
    }

    fn routes(routes: RouteSet<Large>) -> atc_set256 {
        atc_set256 { words: words(64, |number| routes.has_number(number)) }
    }

    fn points(points: PointSet<Large>) -> atc_set128 {
        atc_set128 { words: words(32, |number| points.has_number(number)) }
    }

    fn segments(segments: SegmentSet<Large>) -> atc_set32 {
        atc_set32 { words: words(8, |number| segments.has_number(number)) }
    }
}

type ElementOf<Z> = element_of<<Z as InC>::Circuits, <Z as InC>::Points>;
type RouteOf<Z> = route_of<<Z as InC>::Circuits, <Z as InC>::Points, <Z as InC>::Segments>;
type ConfigOf<Z> = interlocking_config_of<<Z as InC>::Circuits, <Z as InC>::Points, <Z as InC>::Segments>;

/// The arrays of a plan, as a C program has them.
#[derive(Clone)]
pub struct Arrays<Z: InC = Small> {
    pub lengths_m: Vec<u16>,
    pub line_codes: Vec<u8>,
    pub detectors: Vec<Z::Circuits>,
    pub segments: Vec<segment_of<Z::Circuits>>,
    pub segment_circuits: Vec<u8>,
    pub routes: Vec<RouteOf<Z>>,
    pub elements: Vec<ElementOf<Z>>,
    pub braking_m: Vec<u16>,
    pub scalars: ConfigOf<Z>,
}

/// A direction of travel.
pub fn heading(heading: Heading) -> u8 {
    if heading == Heading::Left { ATC_HEADING_LEFT } else { ATC_HEADING_RIGHT }
}

fn element<Z: InC>(element: &Element<Z>) -> ElementOf<Z> {
    let Positions { normal, reverse } = element.positions;
    let (circuits, beside) = (Z::circuits(element.circuits), Z::circuits(element.beside));
    element_of { circuits, normal: Z::points(normal), reverse: Z::points(reverse), beside }
}

impl<Z: InC> Arrays<Z> {
    /// The arrays of a plan with as many circuits and so on as have names.
    pub fn of<const R: usize, const P: usize, const N: usize, const S: usize>(
        plan: &Plan<R, P, N, S, Z>,
        names: &Names,
    ) -> Self {
        let (mut elements, mut segment_circuits) = (Vec::new(), Vec::new());
        let mut routes = Vec::new();
        for route in plan.routes.iter().take(names.routes.len()) {
            let path_first = u16::try_from(elements.len()).expect("at most 8192");
            elements.extend(route.path.iter().take(route.length.into()).map(element));
            routes.push(route_of {
                entry: Z::circuits(route.entry),
                approach: Z::circuits(route.approach),
                beyond: Z::circuits(route.beyond),
                continuing: Z::routes(route.continuing),
                conflicts: Z::routes(route.conflicts),
                overlap: element(&route.overlap),
                path_first,
                path_length: route.length.into(),
                drive_cycles: route.drive.0,
                release_cycles: route.release.0,
                stay_cycles: route.stay.0,
                heading: heading(route.heading),
                from: Z::segments(route.from),
                to: Z::segments(route.to),
                speed_code: route.speed.0,
                overlap_speed_code: route.overlap_speed.0,
                cab_signalled: route.cab_signalled.into(),
                calling_on: route.calling_on.into(),
            });
        }
        let mut segments = Vec::new();
        for segment in plan.segments.iter().take(names.segments.len()) {
            let circuits_first = u16::try_from(segment_circuits.len()).expect("at most 1024");
            let numbers = segment.circuits.iter().take(segment.length.into());
            segment_circuits.extend(numbers.map(|circuit| circuit.first().map_or(u8::MAX, CircuitId::number)));
            segments.push(segment_of {
                throat: Z::circuits(segment.throat),
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
            detectors: plan.points.iter().take(names.points.len()).map(|point| Z::circuits(point.detectors)).collect(),
            segments,
            segment_circuits,
            routes,
            elements,
            braking_m: plan.braking.iter().map(|metres| metres.0).collect(),
            scalars: interlocking_config_of {
                turn_cycles: plan.turn.0,
                start_cycles: plan.start.0,
                residual_cycles: plan.residual.0,
                standstill_cycles: plan.standstill.0,
                clear_cycles: plan.clear,
                settle_cycles: plan.settle,
                loss_cycles: plan.loss,
                ..nothing::<Z>()
            },
        }
    }

    /// The configuration that leads to these arrays. It is good for as long as they are.
    pub fn config(&self) -> ConfigOf<Z> {
        interlocking_config_of {
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

fn nothing<Z: InC>() -> ConfigOf<Z> {
    interlocking_config_of {
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
    }
}
