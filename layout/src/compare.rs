//! Two layouts of one station, held against each other: cell by cell of the control table, and what stands beside it.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt;

use atc_kernel::distance::Metres;

use crate::graph::{Kind, Track};
use crate::model::{Model, Values};
use crate::table;

/// Something in which two layouts differ.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Differing {
    /// What it is of: `route W-1`, `point 2`.
    pub about: String,
    /// The column of the table, or the value.
    pub column: String,
    /// What the one has; nothing if it has no such thing.
    pub one: Option<String>,
    /// What the other has.
    pub other: Option<String>,
}

impl fmt::Display for Differing {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let word = |cell: &Option<String>| match cell.as_deref() {
            None => "not there".to_owned(),
            Some("") => "nothing".to_owned(),
            Some(cell) => cell.to_owned(),
        };
        write!(f, "{}: {}: {} | {}", self.about, self.column, word(&self.one), word(&self.other))
    }
}

/// Things of a layout by name, each with its values by column.
type Cells = BTreeMap<String, BTreeMap<String, String>>;

/// Everything in which `one` differs from `other`, in the order of names.
pub fn compare(one: &Model, other: &Model) -> Vec<Differing> {
    let (one, other) = (cells(one), cells(other));
    let mut found = Vec::new();
    let nothing = BTreeMap::new();
    for about in one.keys().chain(other.keys()).collect::<BTreeSet<_>>() {
        let (mine, theirs) = (one.get(about), other.get(about));
        if mine.is_none() || theirs.is_none() {
            let there = |cells: Option<&BTreeMap<String, String>>| cells.map(|_| "there".to_owned());
            let (one, other) = (there(mine), there(theirs));
            found.push(Differing { about: about.clone(), column: "the whole of it".to_owned(), one, other });
            continue;
        }
        let (mine, theirs) = (mine.unwrap_or(&nothing), theirs.unwrap_or(&nothing));
        for column in mine.keys().chain(theirs.keys()).collect::<BTreeSet<_>>() {
            let (one, other) = (mine.get(column).cloned(), theirs.get(column).cloned());
            if one != other {
                found.push(Differing { about: about.clone(), column: column.clone(), one, other });
            }
        }
    }
    found
}

fn cells(model: &Model) -> Cells {
    let mut all = Cells::new();
    for (number, route) in model.routes.iter().enumerate() {
        let columns = table::COLUMNS.iter().map(|column| (*column).to_owned());
        all.insert(format!("route {}", route.name), columns.zip(table::cells(model, number)).collect());
    }
    let name = |circuit: &usize| model.circuits.get(*circuit).map_or("", |circuit| circuit.name.as_str());
    let named = |circuits: &BTreeSet<usize>| circuits.iter().map(name).collect::<BTreeSet<_>>();
    for (number, circuit) in model.circuits.iter().enumerate() {
        let neighbours = model.graph.borders(number).into_iter().filter_map(|joint| model.graph.across(joint, number));
        let crossed = model.graph.tracks.iter().filter(|track| track.circuit == number && track.kind == Kind::Plain);
        let values = [
            ("length m", circuit.length.0.to_string()),
            ("adjoins", listed(named(&neighbours.collect()))),
            ("needs no protection", reasons(crossed)),
        ];
        all.insert(format!("circuit {}", circuit.name), owned(values));
    }
    for (number, point) in model.points.iter().enumerate() {
        let track = model.graph.of_point(number).map(|track| &model.graph.tracks[track]);
        let leg = |leg: usize| {
            let joint = track.and_then(|track| track.joints.get(leg)).and_then(|joint| model.graph.joints.get(*joint));
            let beyond = joint.into_iter().flat_map(|joint| &joint.tracks).filter_map(|at| model.graph.tracks.get(*at));
            listed(beyond.filter(|at| at.kind != Kind::Point(number)).map(|at| name(&at.circuit)).collect())
        };
        let reason =
            |end: usize| track.and_then(|track| track.unprotected.get(end)).cloned().flatten().unwrap_or_default();
        let values = [
            ("circuit", point.circuit.as_ref().map(name).unwrap_or_default().to_owned()),
            ("detectors", listed(named(&point.detectors))),
            ("throw ms", point.throw_ms.to_string()),
            ("toe leads to", leg(0)),
            ("normal leads to", leg(1)),
            ("reverse leads to", leg(2)),
            ("toe needs no protection", reason(0)),
            ("normal needs no protection", reason(1)),
            ("reverse needs no protection", reason(2)),
        ];
        all.insert(format!("point {}", point.name), owned(values));
    }
    for segment in &model.segments {
        let outward: Vec<&str> = segment.circuits.iter().map(name).collect();
        let values = [
            ("circuits", outward.join(" ")),
            ("line", segment.line.clone().unwrap_or_default()),
            ("shared", segment.shared.to_string()),
            ("throat", segment.throat.as_ref().map(name).unwrap_or_default().to_owned()),
            ("speed code", segment.speed.0.to_string()),
        ];
        all.insert(format!("segment {}", segment.name), owned(values));
    }
    all.insert("station".to_owned(), owned(station(&model.values)));
    all
}

/// The reasons at the ends of tracks: names of joints are no facts of the station, and do not count.
fn reasons<'a>(tracks: impl Iterator<Item = &'a Track>) -> String {
    let given: BTreeSet<&str> =
        tracks.flat_map(|track| track.unprotected.iter().flatten()).map(String::as_str).collect();
    given.into_iter().collect::<Vec<_>>().join("; ")
}

fn station(values: &Values) -> [(&'static str, String); 17] {
    let metres = |length: Option<Metres>| length.map_or_else(String::new, |length| length.0.to_string());
    [
        ("cycle ms", values.cycle_ms.to_string()),
        ("clear ms", (u32::from(values.clear) * values.cycle_ms).to_string()),
        ("shunt loss ms", (u32::from(values.loss) * values.cycle_ms).to_string()),
        ("residual ms", values.ms(values.residual).to_string()),
        ("standstill ms", values.ms(values.standstill).to_string()),
        ("settle ms", (u32::from(values.settle) * values.cycle_ms).to_string()),
        ("start ms", values.ms(values.start).to_string()),
        ("turn ms", values.ms(values.turn).to_string()),
        ("telegram age ms", values.telegram_age_ms.to_string()),
        ("cab signalled", values.cab_signalled.to_string()),
        ("speeds km/h", format!("{:?}", values.speeds_kmh)),
        ("longest train m", metres(values.longest_train)),
        ("shortest train m", metres(values.shortest_train)),
        ("least overlap m", values.least_overlap.0.to_string()),
        ("heard beyond m", values.heard_beyond.0.to_string()),
        ("strongest brake mm/s²", values.strongest_mm_s2.to_string()),
        ("braking distances m", format!("{:?}", values.braking.map(|distance| distance.0))),
    ]
}

fn owned<const N: usize>(values: [(&str, String); N]) -> BTreeMap<String, String> {
    values.into_iter().map(|(column, value)| (column.to_owned(), value)).collect()
}

fn listed(names: BTreeSet<&str>) -> String {
    names.into_iter().collect::<Vec<_>>().join(" ")
}
