//! Layouts (T-LAY-2): what the constructor lets through keeps the rules of engineering, here said once more and in another way.

use super::any::{any_circuits, any_plan, bit};
use crate::engine::any_byte;
use atc_kernel::distance::Metres;
use atc_kernel::interlocking::{CircuitSet, Layout, MAX_CODES, PerCircuit, Plan, Point, RouteSet, SpeedCode};

const ROUTES: usize = 2;
const PATH: usize = 2;
const POINTS: usize = 2;
const SEGMENTS: usize = 2;

/// Any plan. Lengths are of two kinds.
fn any_whole_plan<E: crate::Engine + ?Sized>(e: &mut E) -> Plan<ROUTES, PATH, POINTS, SEGMENTS> {
    let mut plan = any_plan(e);
    let (mut entry, mut other) = (0x8000_u16, 2);
    for route in &mut plan.routes {
        route.entry = any_circuits(e, "entry (bits)", entry..=entry);
        route.approach = any_circuits(e, "approach (bits)", entry..=entry);
        route.speed = SpeedCode(any_byte(e, "speed code", 0..=3));
        route.conflicts = RouteSet::from_bits(u64::from(e.word("conflicting routes (bits)", 0..=other)));
        (entry, other) = (8, 1);
    }
    for segment in &mut plan.segments {
        segment.throat = any_circuits(e, "throat (bits)", 2..=2);
    }
    plan.points =
        core::array::from_fn(|_| Point { detectors: any_circuits(e, "detectors of a point (bits)", 0x4000..=0x4000) });
    let long = e.word("length of circuits with an even number (m)", 0..=400);
    let short = e.word("length of circuits with an odd number (m)", 1..=400);
    plan.lengths = PerCircuit::from_fn(|place| Metres(if place % 2 == 0 { long } else { short }));
    let mut distance = 0;
    for braking in &mut plan.braking[1..] {
        distance += 50;
        *braking = Metres(e.word("braking distance of a code (m)", distance..=distance + 20));
    }
    plan
}

harness! {
    /// A layout that the constructor makes keeps every rule of engineering that its data can show.
    t_lay_2(e)
    theorem "T-LAY-2";
    requirements ["LAY-2"];
    assumptions [];
    bound "2 routes of up to 2 circuits, 32 circuits, 2 points, 2 segments of up to 2 circuits";
    cases 2;
    unwind 65 = 1 + crate::interlocking::LONGEST;
    apart [0 1];
    claims {
        Entry: "a route begins at one circuit, which is part of its approach",
        Apart: "its approach has no circuit of its path or overlap, and its overlap none of its path",
        Beyond: "there is a circuit beyond it, other than its last",
        Names: "it names only routes and segments that there are, and is no conflict of itself",
        Line: "it comes from one segment at most and leads to one at most, ends in the throat of that, and leads the way that its segments and the routes that continue it do",
        Points: "every point that it positions is there and has a detector, and no point has one on a segment",
        Speed: "its speed code has a braking distance and is not stop",
        Lengths: "every circuit of its path, and of a segment, has a length",
    }
    covers {
        Plain: "a route with an overlap",
        Line: "a route that leads to a segment",
        Points: "a route that positions a point",
        Conflict: "a route with a conflict",
    }
    {
        let plan = any_whole_plan(e);
        let it = e.choose("the route that is looked at", ROUTES);
        let circuit = bit(e.word("a circuit that stands for all (number)", 0..=8) & 31);
        let made = Layout::new(plan);
        e.assume(made.is_ok());
        let Ok(layout) = made else { return };
        let plan = layout.plan();
        let route = &plan.routes[it];
        if route.length == 0 {
            return;
        }
        let bits = |set: CircuitSet| set.bits();
        let (mut path, mut last) = (0, 0);
        let mut positions = route.overlap.positions.normal.bits() | route.overlap.positions.reverse.bits();
        for place in 0..PATH {
            let element = &route.path[place];
            if place < usize::from(route.length) {
                path |= bits(element.circuits);
                last = bits(element.circuits);
                positions |= element.positions.normal.bits() | element.positions.reverse.bits();
            }
        }
        let (entry, approach, overlap) = (bits(route.entry), bits(route.approach), bits(route.overlap.circuits));
        e.claim(Claim::Entry as u32, entry != 0 && entry & entry.wrapping_sub(1) == 0 && approach & entry == entry);
        e.claim(Claim::Apart as u32, approach & (path | overlap) == 0 && overlap & path == 0);
        e.claim(Claim::Beyond as u32, bits(route.beyond) != 0 && bits(route.beyond) & last == 0);
        let (mut routes, mut segments) = (0, 0);
        for number in 0..ROUTES {
            routes |= u64::from(plan.routes[number].length != 0) << number;
        }
        let (mut throats, mut line) = (true, 0);
        let mut leads = true;
        for number in 0..ROUTES {
            leads &= route.continuing.bits() >> number & 1 == 0 || plan.routes[number].heading == route.heading;
        }
        for number in 0..SEGMENTS {
            let segment = &plan.segments[number];
            segments |= u8::from(segment.length != 0) << number;
            throats &= route.to.bits() >> number & 1 == 0 || bits(segment.throat) == last;
            leads &= route.to.bits() >> number & 1 == 0 || segment.outward == route.heading;
            leads &= route.from.bits() >> number & 1 == 0 || segment.outward != route.heading;
            for place in 0..PATH {
                line |= if place < usize::from(segment.length) { bits(segment.circuits[place]) } else { 0 };
            }
        }
        let (conflicts, continuing) = (route.conflicts.bits(), route.continuing.bits());
        let (from, to) = (route.from.bits(), route.to.bits());
        let there = (conflicts | continuing) & !routes == 0 && (from | to) & !segments == 0;
        e.claim(Claim::Names as u32, there && conflicts >> it & 1 == 0);
        let single = from & from.wrapping_sub(1) == 0 && to & to.wrapping_sub(1) == 0;
        e.claim(Claim::Line as u32, single && throats && leads);
        let (mut detected, mut apart) = (0, true);
        for number in 0..POINTS {
            detected |= u32::from(bits(plan.points[number].detectors) != 0) << number;
            apart &= bits(plan.points[number].detectors) & line == 0;
        }
        e.claim(Claim::Points as u32, positions & !detected == 0 && apart);
        let mut distance = Metres(u16::MAX);
        for code in 1..MAX_CODES {
            distance = if usize::from(route.speed.0) == code { plan.braking[code] } else { distance };
        }
        e.claim(Claim::Speed as u32, distance.0 < u16::MAX);
        let mut length = 0;
        for place in 0..32 {
            length = if circuit >> place & 1 == 1 { plan.lengths[place].0 } else { length };
        }
        e.claim(Claim::Lengths as u32, (path | line) & circuit == 0 || length > 0);
        e.cover(Cover::Plain as u32, overlap != 0);
        e.cover(Cover::Line as u32, to != 0);
        e.cover(Cover::Points as u32, positions != 0);
        e.cover(Cover::Conflict as u32, conflicts != 0);
    }
}
