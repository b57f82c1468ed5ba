//! From the model to the kernel's plan.

use std::collections::BTreeMap;

use atc_kernel::interlocking::{
    Broken, CircuitSet, Element, Large, Layout, Place, Plan, PointSet, Positions, Route, RouteSet, Segment, SegmentSet,
    Size, Small,
};

use crate::check;
use crate::extent::Extent;
use crate::form::{self, Position};
use crate::model::{self, Model, Note};
use crate::problem::{Errors, Problem, Source};
use crate::rule::Rule;
use crate::witness;

/// A layout for the kernel, with the names of its numbers.
#[derive(Clone, Debug)]
pub struct Compiled<const R: usize = 64, const P: usize = 16, const N: usize = 32, const S: usize = 8, Z: Size = Small>
{
    /// The plan. It breaks no rule.
    pub plan: Box<Plan<R, P, N, S, Z>>,
    /// What the numbers stand for.
    pub names: Names,
    /// What the file left out and how it was filled in.
    pub derived: Vec<Note>,
    /// The same layout with everything that the plan has no place for.
    pub model: Model,
}

/// What the numbers of a plan stand for: circuit 0 is the first name, and so on.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Names {
    /// The station.
    pub station: String,
    /// The circuits.
    pub circuits: Vec<String>,
    /// The points.
    pub points: Vec<String>,
    /// The routes.
    pub routes: Vec<String>,
    /// The signals of the routes.
    pub signals: Vec<String>,
    /// The segments.
    pub segments: Vec<String>,
}

impl Names {
    fn of(station: &form::Station, model: &Model) -> Self {
        Self {
            station: station.name.clone(),
            circuits: model.circuits.iter().map(|circuit| circuit.name.clone()).collect(),
            points: model.points.iter().map(|point| point.name.clone()).collect(),
            routes: model.routes.iter().map(|route| route.name.clone()).collect(),
            signals: model.routes.iter().map(|route| route.signal.clone()).collect(),
            segments: model.segments.iter().map(|segment| segment.name.clone()).collect(),
        }
    }
}

impl Names {
    /// What a plan with these names breaks, and where, in a sentence.
    pub fn broken<const R: usize, const P: usize, const N: usize, const S: usize, Z: Size>(
        &self,
        broken: Broken,
        plan: &Plan<R, P, N, S, Z>,
    ) -> String {
        let of =
            |list: &[String], number: u8| list.get(usize::from(number)).cloned().unwrap_or_else(|| number.to_string());
        let route = |number: u8| of(&self.routes, number);
        let segment = |number: u8| of(&self.segments, number);
        let about = match broken.place {
            Place::Plan => "the layout".to_owned(),
            Place::Route(number) => format!("route {}", route(number)),
            Place::Overlap(number) => format!("the overlap of route {}", route(number)),
            Place::Path(number, place) => {
                let circuits = plan.routes.get(usize::from(number)).map(|route| route.circuit_at(place));
                let there = |(at, _): &(usize, &String)| circuits.is_some_and(|set| set.meets(CircuitSet::nth(*at)));
                let named: Vec<&str> =
                    self.circuits.iter().enumerate().filter(there).map(|(_, name)| name.as_str()).collect();
                let circuit =
                    if named.is_empty() { format!("place {}", u16::from(place) + 1) } else { named.join("+") };
                format!("{circuit} of route {}", route(number))
            }
            Place::Routes(one, other) => format!("routes {} and {}", route(one), route(other)),
            Place::Point(number) => format!("point {}", of(&self.points, number)),
            Place::Segment(number) => format!("segment {}", segment(number)),
            Place::Segments(one, other) => format!("segments {} and {}", segment(one), segment(other)),
            Place::Circuit(number) => format!("circuit {}", of(&self.circuits, number)),
        };
        format!("{about} breaks a rule: {}", Rule::Plan(broken.rule).text())
    }
}

impl<const R: usize, const P: usize, const N: usize, const S: usize, Z: Size> Compiled<R, P, N, S, Z> {
    /// The layout for the kernel.
    ///
    /// # Panics
    /// Never: the plan was checked when this was made.
    pub fn layout(&self) -> Box<Layout<R, P, N, S, Z>> {
        Box::new(Layout::new(*self.plan).expect("the plan was checked when it was compiled"))
    }
}

/// A layout that breaks no rule, of whichever size.
#[derive(Clone, Debug)]
pub struct Sound {
    /// What the numbers of its plan stand for.
    pub names: Names,
    /// The layout with everything that a plan has no place for.
    pub model: Model,
}

/// Holds a model against every rule, as a station of the size that it needs.
///
/// # Errors
/// As [`compile`].
pub fn sound(source: &Source, station: &form::Station, model: Model) -> Result<Sound, Errors> {
    if Extent::of(station).is_large() {
        let Compiled { names, model, .. } = compile::<256, 32, 128, 32, Large>(source, station, model)?;
        return Ok(Sound { names, model });
    }
    let Compiled { names, model, .. } = compile::<64, 16, 32, 8, Small>(source, station, model)?;
    Ok(Sound { names, model })
}

/// Numbers a model that breaks no rule of its own, and checks the plan.
///
/// # Errors
/// What does not fit, and every rule that the plan breaks.
pub fn compile<const R: usize, const P: usize, const N: usize, const S: usize, Z: Size>(
    source: &Source,
    station: &form::Station,
    model: Model,
) -> Result<Compiled<R, P, N, S, Z>, Errors> {
    let mut problems = Vec::new();
    room::<R, P, N, S, Z>(&model, &mut problems);
    if !problems.is_empty() {
        return Err(Errors::new(source, problems));
    }
    // On the heap from the beginning: that of a large station has half a megabyte.
    let mut plan = Box::new(Plan::EMPTY);
    fill(&mut plan, &model);
    let names = Names::of(station, &model);
    plan.check(&mut |broken| problems.push(of_plan(broken, &plan, &names, &model)));
    check::lines(station, &model, &mut problems);
    if problems.is_empty() {
        problems = witness::differences(station, &plan);
    }
    if !problems.is_empty() {
        return Err(Errors::new(source, problems));
    }
    Ok(Compiled { plan, names, derived: model.notes.clone(), model })
}

fn room<const R: usize, const P: usize, const N: usize, const S: usize, Z: Size>(
    model: &Model,
    problems: &mut Vec<Problem>,
) {
    if model.routes.is_empty() {
        let what = "the layout has no route: nothing can be set";
        let right =
            "describe at least one; why those of an imported file were left out, its import says route by route";
        problems.push(Problem::new(Rule::NoRoute, &(0..0), what, right));
    }
    let counts = [
        ("track circuits", model.circuits.len(), CircuitSet::<Z>::MOST),
        ("points", model.points.len(), N.min(PointSet::<Z>::MOST)),
        ("routes", model.routes.len(), R.min(RouteSet::<Z>::MOST)),
        ("segments", model.segments.len(), S.min(SegmentSet::<Z>::MOST)),
    ];
    for (kind, count, room) in counts {
        if count > room {
            let what = format!("the layout has {count} {kind}, and there is room for {room}");
            let right = "choose routes with --only, or divide the station";
            problems.push(Problem::new(Rule::TooMany, &(0..0), what, right));
        }
    }
    let paths = model.routes.iter().map(|route| ("route", &route.name, route.path.len(), &route.span));
    let segments =
        model.segments.iter().map(|segment| ("segment", &segment.name, segment.circuits.len(), &segment.span));
    for (kind, name, length, span) in paths.chain(segments) {
        if length > P {
            let what = format!("{kind} {name} has {length} circuits, and there is room for {P}");
            problems.push(Problem::new(Rule::TooMany, span, what, "divide it"));
        }
    }
}

fn circuits<Z: Size>(numbers: impl IntoIterator<Item = usize>) -> CircuitSet<Z> {
    numbers.into_iter().fold(CircuitSet::EMPTY, |all, number| all.or(CircuitSet::nth(number)))
}

fn routes<Z: Size>(numbers: impl IntoIterator<Item = usize>) -> RouteSet<Z> {
    numbers.into_iter().fold(RouteSet::EMPTY, |all, number| all.or(RouteSet::nth(number)))
}

fn positions<Z: Size>(given: &BTreeMap<usize, Position>) -> Positions<Z> {
    let of = |wanted: Position| {
        let numbers = given.iter().filter(|(_, position)| **position == wanted).map(|(point, _)| *point);
        numbers.fold(PointSet::EMPTY, |all, number| all.or(PointSet::nth(number)))
    };
    Positions { normal: of(Position::Normal), reverse: of(Position::Reverse) }
}

fn segment_set<Z: Size>(segment: Option<usize>) -> SegmentSet<Z> {
    segment.map_or(SegmentSet::EMPTY, SegmentSet::nth)
}

fn fill<const R: usize, const P: usize, const N: usize, const S: usize, Z: Size>(
    plan: &mut Plan<R, P, N, S, Z>,
    model: &Model,
) {
    for (place, route) in plan.routes.iter_mut().zip(&model.routes) {
        *place = Route { cab_signalled: model.values.cab_signalled, ..route_of(route) };
    }
    for (place, point) in plan.points.iter_mut().zip(&model.points) {
        place.detectors = circuits(point.detectors.iter().copied());
    }
    for (place, segment) in plan.segments.iter_mut().zip(&model.segments) {
        *place = Segment {
            length: u8::try_from(segment.circuits.len()).unwrap_or(u8::MAX),
            throat: circuits(segment.throat),
            outward: segment.outward,
            shared: u8::try_from(segment.shared).unwrap_or(u8::MAX),
            ..Segment::NONE
        };
        for (circuit, number) in place.circuits.iter_mut().zip(&segment.circuits) {
            *circuit = CircuitSet::nth(*number);
        }
        plan.line = plan.line.and_at_most(segment.speed, place.all());
    }
    for (place, circuit) in plan.lengths.iter_mut().zip(&model.circuits) {
        *place = circuit.length;
    }
    plan.braking = model.values.braking;
    plan.clear = model.values.clear;
    plan.turn = model.values.turn;
    plan.start = model.values.start;
    plan.settle = model.values.settle;
    plan.loss = model.values.loss;
    plan.residual = model.values.residual;
    plan.standstill = model.values.standstill;
}

fn route_of<const P: usize, Z: Size>(route: &model::Route) -> Route<P, Z> {
    let mut made = Route {
        heading: route.heading,
        entry: CircuitSet::nth(route.entry),
        approach: circuits(route.approach.iter().copied()),
        length: u8::try_from(route.path.len()).unwrap_or(u8::MAX),
        overlap: Element {
            circuits: circuits(route.overlap.iter().copied()),
            positions: positions(&route.overlap_positions),
            beside: circuits(route.overlap_beside.iter().copied()),
        },
        beyond: circuits(route.beyond.iter().copied()),
        continuing: routes(route.continuing.iter().copied()),
        conflicts: routes(route.conflicts.iter().copied()),
        from: segment_set(route.from),
        to: segment_set(route.to),
        drive: route.drive,
        release: route.release,
        stay: route.stay,
        speed: route.speed,
        overlap_speed: route.overlap_speed,
        calling_on: route.calling_on,
        ..Route::NONE
    };
    for (element, place) in made.path.iter_mut().zip(&route.path) {
        *element = Element {
            circuits: CircuitSet::nth(place.circuit),
            positions: positions(&place.positions),
            beside: circuits(place.beside.iter().copied()),
        };
    }
    made
}

/// A broken rule of the plan in the words of the file.
fn of_plan<const R: usize, const P: usize, const N: usize, const S: usize, Z: Size>(
    broken: Broken,
    plan: &Plan<R, P, N, S, Z>,
    names: &Names,
    model: &Model,
) -> Problem {
    let of = |number: u8| usize::from(number);
    let span = match broken.place {
        Place::Plan => 0..0,
        Place::Route(number) | Place::Overlap(number) | Place::Routes(number, _) => {
            model.routes[of(number)].span.clone()
        }
        Place::Path(number, place) => model.routes[of(number)].path[of(place)].span.clone(),
        Place::Point(number) => model.points[of(number)].span.clone(),
        Place::Segment(number) | Place::Segments(number, _) => model.segments[of(number)].span.clone(),
        Place::Circuit(number) => model.circuits[of(number)].span.clone(),
    };
    let rule = Rule::Plan(broken.rule);
    Problem::new(rule, &span, names.broken(broken, plan), crate::rule::remedy(broken.rule))
}
