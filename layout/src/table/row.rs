//! One row of the control table.

use std::collections::BTreeMap;

use atc_kernel::interlocking::Heading;

use crate::conflict::reasons;
use crate::form::Position;
use crate::model::{Model, Positions, Route};

/// The heads of the columns of [`csv`](super::csv()).
pub const COLUMNS: [&str; 21] = [
    "route",
    "signal",
    "heading",
    "entry",
    "path",
    "normal",
    "reverse",
    "flank normal",
    "flank reverse",
    "overlap",
    "overlap normal",
    "overlap reverse",
    "proved clear beside",
    "beyond",
    "approach",
    "conflicts",
    "continued by",
    "direction",
    "speed km/h",
    "times",
    "releases",
];

/// The row of a route.
pub struct Row<'a> {
    model: &'a Model,
    number: usize,
    route: &'a Route,
}

impl<'a> Row<'a> {
    /// The row of the route `number`.
    pub fn of(model: &'a Model, number: usize) -> Self {
        Self { model, number, route: &model.routes[number] }
    }

    /// The cells under [`COLUMNS`].
    pub fn cells(&self) -> Vec<String> {
        let (model, route) = (self.model, self.route);
        let run_over: Positions =
            route.path.iter().flat_map(|place| &place.passed).map(|passed| (passed.point, passed.position)).collect();
        let all: Positions = route.path.iter().flat_map(|place| place.positions.clone()).collect();
        let flank: Positions = all.into_iter().filter(|(point, _)| !run_over.contains_key(point)).collect();
        let points = |of: &Positions, wanted| {
            let named = of
                .iter()
                .filter(|(_, position)| **position == wanted)
                .map(|(point, _)| model.points[*point].name.as_str());
            named.collect::<Vec<_>>().join(" ")
        };
        let overlap = match &route.short_overlap {
            Some(reason) if route.overlap.is_empty() => format!("none: {reason}"),
            Some(reason) => format!("{} (short: {reason})", self.circuits(route.overlap.iter().copied())),
            None if route.calling_on => format!("berth: {}", self.circuits(route.overlap.iter().copied())),
            None => self.circuits(route.overlap.iter().copied()),
        };
        vec![
            route.name.clone(),
            route.signal.clone(),
            heading(route.heading).to_owned(),
            model.circuits[route.entry].name.clone(),
            self.circuits(route.circuits()),
            points(&run_over, Position::Normal),
            points(&run_over, Position::Reverse),
            points(&flank, Position::Normal),
            points(&flank, Position::Reverse),
            overlap,
            points(&route.overlap_positions, Position::Normal),
            points(&route.overlap_positions, Position::Reverse),
            self.circuits(route.beside().into_iter()),
            self.circuits(route.beyond.iter().copied()),
            self.circuits(route.approach.iter().copied()),
            self.conflicts(),
            route.continuing.iter().map(|other| model.routes[*other].name.as_str()).collect::<Vec<_>>().join(" "),
            self.direction(),
            model.values.speeds_kmh[usize::from(route.speed.0)].to_string(),
            self.times(),
            self.releases(),
        ]
    }

    fn circuits(&self, circuits: impl Iterator<Item = usize>) -> String {
        circuits.map(|circuit| self.model.circuits[circuit].name.as_str()).collect::<Vec<_>>().join(" ")
    }

    /// The routes that it excludes, gathered by the reasons.
    fn conflicts(&self) -> String {
        let mut by_reason: BTreeMap<String, Vec<&str>> = BTreeMap::new();
        for other in 0..self.model.routes.len() {
            let found = reasons(self.model, self.number, other);
            if !found.is_empty() {
                let words: Vec<&str> = found.iter().map(|reason| reason.word()).collect();
                by_reason.entry(words.join("+")).or_default().push(&self.model.routes[other].name);
            }
        }
        by_reason
            .iter()
            .map(|(reason, routes)| format!("{reason}: {}", routes.join(" ")))
            .collect::<Vec<_>>()
            .join("; ")
    }

    fn direction(&self) -> String {
        let segment = |number: Option<usize>| number.map(|number| self.model.segments[number].name.as_str());
        match (segment(self.route.from), segment(self.route.to)) {
            (Some(from), Some(to)) => format!("in from {from}, out to {to}"),
            (Some(from), None) => format!("in from {from}"),
            (None, Some(to)) => format!("out to {to}"),
            (None, None) => String::new(),
        }
    }

    fn times(&self) -> String {
        let seconds = |ticks: u16| f64::from(u32::from(ticks) * self.model.values.cycle_ms) / 1000.0;
        let route = self.route;
        let times = format!("drive {} s, release {} s", seconds(route.drive.0), seconds(route.release.0));
        // A berth is not given up by time.
        if route.calling_on { times } else { format!("{times}, stay {} s", seconds(route.stay.0)) }
    }

    /// What releases each circuit of the path, and the overlap.
    fn releases(&self) -> String {
        let names: Vec<&str> =
            self.route.circuits().map(|circuit| self.model.circuits[circuit].name.as_str()).collect();
        let mut parts: Vec<String> =
            names.windows(2).map(|pair| format!("{}: clear after {} entered", pair[0], pair[1])).collect();
        if let Some(last) = names.last() {
            let beyond: Vec<&str> =
                self.route.beyond.iter().map(|circuit| self.model.circuits[*circuit].name.as_str()).collect();
            parts.push(format!("{last}: clear with {} occupied", beyond.join(" or ")));
            if self.route.calling_on {
                parts.push("berth: clear".to_owned());
            } else if !self.route.overlap.is_empty() {
                parts.push(format!("overlap: {last} occupied for the stay time"));
            }
        }
        parts.join("; ")
    }
}

/// The word for a direction of travel.
const fn heading(heading: Heading) -> &'static str {
    match heading {
        Heading::Left => "left",
        Heading::Right => "right",
    }
}
