//! Stations made by rule, and the same as railML and PlanPro.
#![allow(dead_code, reason = "each test uses a part of it")]

pub mod central;
pub mod planpro;
pub mod railml;
pub mod random;

use atc_layout::form::{Circuit, Element, End, EndKind, Platform, Point, Route, Segment, Station};
use atc_layout::model::Model;
use atc_layout::{At, Description};

/// The model of a station.
pub fn model(station: &Station) -> Model {
    let description = Description { station: station.clone(), ..Description::default() };
    description.model().unwrap_or_else(|errors| panic!("{errors}"))
}

fn at(name: impl Into<String>) -> At<String> {
    At::derived(name.into())
}

fn circuit(name: String, length: u16, joints: Option<(String, String)>) -> Circuit {
    let (left, right) = joints.map_or((None, None), |(left, right)| (Some(at(left)), Some(at(right))));
    Circuit { name: at(name), length_m: At::derived(length), left, right, ..Circuit::default() }
}

fn element(circuit: String) -> At<Element> {
    At::derived(Element { circuit, ..Element::default() })
}

/// How the tracks of a station end in the east.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum East {
    /// All lead to the line.
    AllThrough,
    /// The last one ends at a buffer stop.
    OneBay,
}

/// A station on a single line with a ladder of points at each end of its `tracks`: from each line to each track and back.
pub fn station(tracks: usize, east: East) -> Station {
    let through = if east == East::OneBay { tracks - 1 } else { tracks };
    let mut made =
        Station { name: format!("{tracks} tracks"), longest_train_m: Some(At::derived(200)), ..Station::default() };
    made.speed.line_kmh = Some(At::derived(75));
    made.speed.reverse_kmh = Some(At::derived(45));
    line(&mut made, "W", &["a", "b", "c"], "West");
    ladder(&mut made, ("W", "c"), tracks);
    for track in 1..=tracks {
        made.circuits.push(circuit(format!("{track}T"), 220, Some((format!("W{track}"), format!("E{track}")))));
        made.platforms.push(Platform { name: format!("Platform {track}"), circuits: vec![at(format!("{track}T"))] });
    }
    ladder(&mut made, ("E", "f"), through);
    line(&mut made, "E", &["d", "e", "f"], "East");
    made.circuits.last_mut().unwrap().name = at("E1");
    if east == East::OneBay {
        made.ends.push(End { joint: at(format!("E{tracks}")), kind: EndKind::Buffer });
    }
    for (side, other, count, beyond) in [("W", "E", tracks, through), ("E", "W", through, tracks)] {
        for track in 1..=count {
            let ladder = (1..=track.min(count - 1)).map(|number| format!("L{side}{number}"));
            let inward: Vec<String> = ladder.chain([format!("{track}T")]).collect();
            let outward: Vec<String> = inward.iter().rev().skip(1).cloned().collect();
            let overlap = (track <= beyond).then(|| element(format!("L{other}{}", track.min(beyond - 1))));
            made.routes.push(Route {
                name: at(format!("{side}-{track}")),
                signal: Some(side.to_owned()),
                entry: at(format!("{side}1")),
                path: inward.into_iter().map(element).collect(),
                overlap: overlap.into_iter().collect(),
                ..Route::default()
            });
            made.routes.push(Route {
                name: at(format!("{track}-{side}")),
                signal: Some(format!("{track}{side}")),
                entry: at(format!("{track}T")),
                path: outward.into_iter().map(element).collect(),
                ..Route::default()
            });
        }
    }
    made
}

/// Two circuits of plain line; the one named 1 is next to the station.
fn line(made: &mut Station, side: &str, joints: &[&str; 3], name: &str) {
    let [end, middle, near] = joints.map(str::to_owned);
    let (outer, inner) = ((end.clone(), middle.clone()), (middle, near));
    let turned = |(left, right): (String, String)| if side == "W" { (left, right) } else { (right, left) };
    made.circuits.push(circuit(format!("{side}2"), 300, Some(turned(outer))));
    made.circuits.push(circuit(format!("{side}1"), 300, Some(turned(inner))));
    made.ends.push(End { joint: at(end), kind: EndKind::Line });
    made.segments.push(Segment {
        name: at(name),
        circuits: vec![at(format!("{side}1")), at(format!("{side}2"))],
        throat: None,
        speed_kmh: None,
        ..Segment::default()
    });
}

/// Points from the joint `toe` to each of the tracks 1 to `count`, a circuit for each.
fn ladder(made: &mut Station, (side, toe): (&str, &str), count: usize) {
    for number in 1..count {
        made.circuits.push(circuit(format!("L{side}{number}"), 60, None));
        let next = if number + 1 < count { format!("l{side}{number}") } else { format!("{side}{count}") };
        let reason = "trains beyond it obey their signal and are braked by ATC; no vehicle is parked there";
        made.points.push(Point {
            name: at(format!("P{side}{number}")),
            circuit: at(format!("L{side}{number}")),
            toe: at(if number == 1 { toe.to_owned() } else { format!("l{side}{}", number - 1) }),
            normal: at(next),
            reverse: at(format!("{side}{number}")),
            normal_unprotected: Some(at(reason)),
            reverse_unprotected: Some(at(reason)),
            ..Point::default()
        });
    }
}

/// A station with 77 routes: more than the kernel has room for.
pub fn seventy_seven() -> Station {
    let mut made = station(20, East::OneBay);
    made.routes.pop();
    "77 routes".clone_into(&mut made.name);
    made
}
