//! A schematic for a plan in the kernel's own terms, which says what follows what and nothing of places: circuits as
//! bars, in columns from left to right after the paths of the routes.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;

use atc_film::Plan;
use atc_kernel::interlocking::{CircuitSet, Heading, Size};

use atc_protocol::machine::interlocking::Interlocked;

/// The width of a bar, and from one to the next, in pixels.
const BAR: usize = 110;
const STEP: usize = 160;
/// The height of a row.
const ROW: usize = 84;
const MARGIN: usize = 40;

const STYLE: &str = "svg.plan .track{fill:none;stroke:#222;stroke-width:4}svg.plan .link{stroke:#999;stroke-width:1.5}\
svg.plan text{font:12px system-ui,sans-serif;fill:#222;text-anchor:middle}svg.plan .circuit{fill:#0b4a8f}\
svg.plan .point{fill:#a03000;font-weight:600}svg.plan .lamp{stroke:#222}\
svg.plan .mast{stroke:#222;stroke-width:1.5;fill:none}svg.plan .title{font-size:16px;font-weight:600;text-anchor:start}\
svg.plan .name{fill:#555}";

/// What follows what, from left to right.
struct Order {
    after: Vec<(usize, usize)>,
    count: usize,
}

impl Order {
    fn follow(&mut self, left: usize, right: usize) {
        if left != right && !self.after.contains(&(left, right)) {
            self.after.push((left, right));
        }
    }

    fn chain(&mut self, circuits: &[usize], heading: Heading) {
        for pair in circuits.windows(2) {
            match heading {
                Heading::Right => self.follow(pair[0], pair[1]),
                Heading::Left => self.follow(pair[1], pair[0]),
            }
        }
    }

    /// The column of each circuit: one more than those on its left. What goes round in a circle ends somewhere.
    fn columns(&self) -> Vec<usize> {
        let mut columns = vec![0; self.count];
        for _ in 0..self.count {
            for (left, right) in &self.after {
                let least = columns[*left] + 1;
                if columns[*right] < least && least < self.count {
                    columns[*right] = least;
                }
            }
        }
        columns
    }

    /// The row of each circuit: that of one on its left, if it is free in its column.
    fn rows(&self, columns: &[usize]) -> Vec<usize> {
        let mut rows = vec![0; self.count];
        let mut taken: BTreeSet<(usize, usize)> = BTreeSet::new();
        let mut order: Vec<usize> = (0..self.count).collect();
        order.sort_by_key(|circuit| (columns[*circuit], *circuit));
        for circuit in order {
            let left = self.after.iter().filter(|(_, right)| *right == circuit).map(|(left, _)| rows[*left]).min();
            let wanted = left.unwrap_or(0);
            let free =
                (wanted..=wanted + self.count).find(|row| !taken.contains(&(columns[circuit], *row))).unwrap_or(wanted);
            taken.insert((columns[circuit], free));
            rows[circuit] = free;
        }
        rows
    }
}

fn members<Z: Size>(set: CircuitSet<Z>, count: usize) -> Vec<usize> {
    (0..count).filter(|number| set.meets(CircuitSet::nth(*number))).collect()
}

fn order<const R: usize, const P: usize, const N: usize, const S: usize, Z: Size>(
    machine: &Interlocked<R, P, N, S, Z>,
) -> Order {
    let plan = machine.layout().plan();
    let count = machine.names().circuits.len();
    let mut order = Order { after: Vec::new(), count };
    for route in plan.routes.iter().filter(|route| route.exists()) {
        let mut way = members(route.entry, count);
        way.truncate(1);
        for element in &route.path[..usize::from(route.length)] {
            way.extend(members(element.circuits, count).into_iter().take(1));
        }
        order.chain(&way, route.heading);
        if let (Some(last), beyond) = (way.last().copied(), members(route.beyond, count)) {
            for next in beyond {
                order.chain(&[last, next], route.heading);
            }
        }
    }
    for segment in plan.segments.iter().filter(|segment| segment.length > 0) {
        let mut way: Vec<usize> = members(segment.throat, count).into_iter().take(1).collect();
        for circuit in &segment.circuits[..usize::from(segment.length)] {
            way.extend(members(*circuit, count).into_iter().take(1));
        }
        order.chain(&way, segment.outward);
    }
    order
}

/// The schematic of a plan.
pub(super) fn plan<const R: usize, const P: usize, const N: usize, const S: usize, Z: Size>(
    machine: &Interlocked<R, P, N, S, Z>,
) -> Plan {
    let names = machine.names();
    let order = order(machine);
    let columns = order.columns();
    let rows = order.rows(&columns);
    let left = |circuit: usize| MARGIN + columns[circuit] * STEP;
    let high = |circuit: usize| 2 * MARGIN + 10 + rows[circuit] * ROW;
    let width = MARGIN + (columns.iter().max().copied().unwrap_or(0) + 1) * STEP;
    let height = 3 * MARGIN + (rows.iter().max().copied().unwrap_or(0) + 1) * ROW;
    let title = escape(&names.station);
    let mut svg = String::new();
    let _ = writeln!(
        svg,
        "<svg class=\"plan\" xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {height}\" width=\"{width}\" height=\"{height}\" role=\"img\">\n<title>Schematic: {title}</title>\n<style>{STYLE}</style>\n<rect width=\"{width}\" height=\"{height}\" fill=\"#fff\"/>\n<text class=\"title\" x=\"20\" y=\"28\">{title}: what follows what; not to scale</text>"
    );
    for (one, next) in &order.after {
        let (x, y, to, down) = (left(*one) + BAR, high(*one), left(*next), high(*next));
        let _ = writeln!(svg, "<path class=\"link\" d=\"M{x} {y}L{to} {down}\"/>");
    }
    for (number, name) in names.circuits.iter().enumerate() {
        let (x, y, name) = (left(number), high(number), escape(name));
        let _ = writeln!(
            svg,
            "<polyline class=\"track\" data-circuit=\"{name}\" points=\"{x},{y} {},{y}\"><title>{name}</title></polyline>\n<text class=\"circuit\" data-circuit=\"{name}\" x=\"{}\" y=\"{}\">{name}</text>",
            x + BAR,
            x + BAR / 2,
            y - 12
        );
    }
    points(&mut svg, machine, (&left, &high));
    signals(&mut svg, machine, (&left, &high));
    svg.push_str("</svg>\n");
    Plan { name: names.station.clone(), svg, pieces: Vec::new(), names: BTreeMap::new() }
}

/// Where a circuit is drawn.
type Place<'a> = (&'a dyn Fn(usize) -> usize, &'a dyn Fn(usize) -> usize);

/// The name of each point below its first detector.
fn points<const R: usize, const P: usize, const N: usize, const S: usize, Z: Size>(
    svg: &mut String,
    machine: &Interlocked<R, P, N, S, Z>,
    (left, high): Place<'_>,
) {
    let names = machine.names();
    let mut below: BTreeMap<usize, usize> = BTreeMap::new();
    for (name, point) in names.points.iter().zip(&machine.layout().plan().points) {
        let Some(circuit) = members(point.detectors, names.circuits.len()).first().copied() else { continue };
        let place = below.entry(circuit).or_insert(0);
        let (x, y, name) = (left(circuit) + BAR / 2, high(circuit) + 20 + *place * 15, escape(name));
        *place += 1;
        let _ = writeln!(svg, "<text class=\"point\" data-point=\"{name}\" x=\"{x}\" y=\"{y}\">{name}</text>");
    }
}

/// A signal at the end of the entry circuit of each route; those of one circuit and direction beside each other.
fn signals<const R: usize, const P: usize, const N: usize, const S: usize, Z: Size>(
    svg: &mut String,
    machine: &Interlocked<R, P, N, S, Z>,
    (left, high): Place<'_>,
) {
    let names = machine.names();
    let mut there: BTreeMap<(usize, bool), usize> = BTreeMap::new();
    for (signal, route) in names.signals.iter().zip(&machine.layout().plan().routes) {
        let Some(entry) = members(route.entry, names.circuits.len()).first().copied() else { continue };
        let right = route.heading == Heading::Right;
        let place = there.entry((entry, right)).or_insert(0);
        let back = *place * 30 + 14;
        *place += 1;
        let x = if right { left(entry) + BAR - back } else { left(entry) + back };
        let (y, far, name) = if right {
            (high(entry) - 30, high(entry) - 42, escape(signal))
        } else {
            (high(entry) + 30, high(entry) + 50, escape(signal))
        };
        let arrow = if right { format!("{name}▸") } else { format!("◂{name}") };
        let _ = writeln!(
            svg,
            "<g data-signal=\"{name}\"><circle class=\"lamp\" cx=\"{x}\" cy=\"{y}\" r=\"5\"/><text class=\"signal\" x=\"{x}\" y=\"{far}\">{arrow}</text></g>"
        );
    }
}

fn escape(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}
