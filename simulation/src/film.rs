//! A run as a film: the plan of every station with the trains on it, trains over time and distance, cabs, signals,
//! events.
//!
//! Trains and points are shown as they truly are; what is reported, counted, held and told is what the devices say.

use std::collections::BTreeMap;

use atc_film::{Class, Clock, Distance, Film, Place, Plan, Stretch};
use atc_kernel::interlocking::{Heading, Large, Movement, Phase, Positions};
use atc_kernel::supervision::Brake;
use atc_layout::draw;

use crate::bound::Bound;
use crate::event::What;
use crate::ground::{PointState, View};
use crate::line::Line;
use crate::sizes::{Circuits, Points, Routes, Segments};
use crate::track::Track;
use crate::train::Train;
use crate::world::World;

/// A station at one time.
struct Office {
    view: View,
    proceed: Routes,
    drives: Positions<Large>,
    permits: Segments,
    telegrams: Vec<Option<Movement<Large>>>,
}

/// A train at one time.
struct Glimpse {
    on: String,
    circuit: usize,
    /// Shares of the first and the last piece, in thousandths.
    front: i64,
    tail: i64,
    /// Along the line, in dm.
    along: [i64; 2],
    /// In tenths of km/h.
    speed: i64,
    permitted: Option<i64>,
    display: String,
    brake: &'static str,
}

/// Everything at one time.
struct Frame {
    reported: Vec<bool>,
    points: Vec<PointState>,
    offices: Vec<Office>,
    trains: Vec<Glimpse>,
}

/// Runs a world until `end_ms`, or until something unsafe happens, and films it every `every_ms`.
///
/// # Errors
/// More frames than there can be; what is wrong with the tracks of a station.
pub fn of(world: &mut World<'_>, end_ms: u64, every_ms: u32) -> Result<Film, String> {
    let every = u64::from(every_ms.max(1));
    let mut frames = vec![look(world)];
    while world.now_ms < end_ms && !world.is_unsafe {
        world.run((world.now_ms / every * every + every).min(end_ms));
        frames.push(look(world));
    }
    let count = u32::try_from(frames.len()).map_err(|_| "the run has 2^32 frames or more".to_owned())?;
    let regular = u64::from(count - 1) * every;
    let last = Some(world.now_ms).filter(|now| *now != regular);
    let clock = Clock { unit: "ms".to_owned(), per_frame: every_ms.max(1), last };
    let line = world.line;
    let mut film = Film::new(&line.name, clock, count);
    film.notes.push(format!(
        "A simulation, a frame every {every} ms. Trains and points are shown as they are; the rest is what the devices say."
    ));
    plans(&mut film, line)?;
    circuits(&mut film, line, &frames);
    stations(&mut film, line, &frames);
    trains(&mut film, line, &frames);
    distance(&mut film, line);
    tables(&mut film);
    events(&mut film, world, every);
    Ok(film)
}

fn look(world: &World<'_>) -> Frame {
    let offices = world.stations.iter().map(|station| Office {
        view: station.view(),
        proceed: station.reply.proceed,
        drives: station.reply.drives,
        permits: station.reply.permits,
        telegrams: station.telegrams.clone(),
    });
    Frame {
        reported: world.reported.clone(),
        points: world.points.clone(),
        offices: offices.collect(),
        trains: world.trains.iter().map(|train| glimpse(&world.line.track, train)).collect(),
    }
}

#[allow(clippy::cast_possible_truncation, reason = "a cast from float saturates")]
fn rounded(value: f64) -> i64 {
    value.round() as i64
}

fn glimpse(track: &Track, train: &Train) -> Glimpse {
    let body = &train.body;
    let on = body.legs.iter().map(|leg| {
        let joints = &track.pieces[leg.piece].joints;
        let reverse = joints.get(2).is_some_and(|joint| leg.enter == *joint || leg.exit == *joint);
        let way = if leg.enter == joints[0] { '+' } else { '-' };
        format!("{}{}{way}", leg.piece, if reverse { "r" } else { "" })
    });
    let share = |metres: f64, piece: usize| rounded((metres / track.pieces[piece].length_m).clamp(0.0, 1.0) * 1000.0);
    let cab = &train.cab;
    Glimpse {
        on: on.collect::<Vec<_>>().join(" "),
        circuit: track.pieces[body.front().piece].circuit,
        front: share(body.front_m, body.front().piece),
        tail: share(body.tail_m, body.legs[0].piece),
        along: [rounded(body.along_m(track) * 10.0), rounded(body.tail_along_m(track) * 10.0)],
        speed: rounded(body.speed * 36.0),
        permitted: cab.permission.speed.map(|speed| i64::from(speed.0)),
        display: cab.display.map_or_else(String::new, |speed| format!("{} km/h", speed.0 / 10)),
        brake: match cab.brake {
            Brake::Release => "released",
            Brake::Service => "service",
            Brake::Emergency => "emergency",
        },
    }
}

fn plans(film: &mut Film, line: &Line) -> Result<(), String> {
    for (station, site) in line.stations.iter().zip(&line.track.sites) {
        let description = &station.description;
        let model = description.tracks().map_err(|errors| errors.to_string())?;
        let mut names = BTreeMap::new();
        for (own, global) in model.circuits.iter().zip(&site.circuits) {
            names.insert(format!("circuit {}", own.name), line.track.circuits[*global].name.clone());
        }
        for (own, global) in model.points.iter().zip(&site.points) {
            names.insert(format!("point {}", own.name), line.track.points[*global].name.clone());
        }
        for signal in &station.sound.names.signals {
            names.insert(format!("signal {signal}"), format!("{} {signal}", station.name));
        }
        for segment in &station.sound.names.segments {
            names.insert(format!("segment {segment}"), format!("{} {segment}", station.name));
        }
        let pieces = site.pieces.iter().map(|piece| u32::try_from(*piece).unwrap_or(u32::MAX)).collect();
        let svg = draw::svg_as_laid(&description.station, &model);
        film.plans.push(Plan { name: station.name.clone(), svg, pieces, names });
    }
    Ok(())
}

const fn phase(phase: Phase) -> &'static str {
    match phase {
        Phase::Idle => "",
        Phase::Provisional => "provisional",
        Phase::Failed => "failed",
        Phase::Set => "set",
        Phase::InUse => "in-use",
        Phase::Releasing => "releasing",
    }
}

const fn yes(is: bool) -> &'static str {
    if is { "yes" } else { "" }
}

/// The circuits of the whole line; one that two stations see has what either says.
fn circuits(film: &mut Film, line: &Line, frames: &[Frame]) {
    for (number, circuit) in line.track.circuits.iter().enumerate() {
        let name = circuit.name.as_str();
        let of = |station: usize| line.track.sites[station].circuits.iter().position(|global| *global == number);
        let seen: Vec<(usize, usize)> = (0..line.stations.len()).filter_map(|at| Some((at, of(at)?))).collect();
        let word = |is: bool, word: &'static str| if is { word } else { "" };
        film.channel(("circuit", name, "reported"), frames.iter().map(|now| word(now.reported[number], "occupied")));
        let any = |now: &Frame, set: fn(&View) -> Circuits| {
            seen.iter().any(|(station, own)| set(&now.offices[*station].view).meets(Circuits::nth(*own)))
        };
        film.channel(
            ("circuit", name, "counted"),
            frames.iter().map(|now| word(any(now, |view| view.occupied), "occupied")),
        );
        film.channel(
            ("circuit", name, "block"),
            frames.iter().map(|now| word(any(now, |view| view.blocked), "blocked")),
        );
        let held = |now: &Frame| -> (String, &'static str) {
            let mut found = (String::new(), "");
            for (station, own) in &seen {
                let it = Circuits::nth(*own);
                let names = &line.stations[*station].sound.names;
                for (route, (at, path, overlap)) in names.routes.iter().zip(&now.offices[*station].view.routes) {
                    if path.meets(it) {
                        return (format!("{} {route}", names.station), phase(*at));
                    }
                    if overlap.meets(it) {
                        found = (format!("overlap of {} {route}", names.station), "overlap");
                    }
                }
            }
            found
        };
        film.channel(("circuit", name, "held"), frames.iter().map(|now| held(now).0));
        film.channel(("circuit", name, "phase"), frames.iter().map(|now| held(now).1));
        let told = |now: &Frame| {
            let open = seen.iter().find_map(|(station, own)| {
                Some((station, now.offices[*station].telegrams[*own].filter(Movement::is_open)?))
            });
            let Some((station, telegram)) = open else { return String::new() };
            let stop = &line.stations[*station].sound.names.circuits[usize::from(telegram.stop.number())];
            let way = match telegram.heading {
                None => "",
                Some(Heading::Left) => "◀ ",
                Some(Heading::Right) => "▶ ",
            };
            let speed = line.speeds_kmh.get(usize::from(telegram.speed.0)).copied().unwrap_or(0);
            format!("{way}to {stop} at {speed}")
        };
        film.channel(("circuit", name, "told"), frames.iter().map(told));
    }
}

fn stations(film: &mut Film, line: &Line, frames: &[Frame]) {
    for (at, station) in line.stations.iter().enumerate() {
        let names = &station.sound.names;
        let full = |name: &String| format!("{} {name}", station.name);
        let shows = |now: &Frame, route: usize| now.offices[at].proceed.meets(Routes::nth(route));
        for (number, route) in names.routes.iter().enumerate() {
            let signal = &names.signals[number];
            let its = |now: &Frame| now.offices[at].view.routes.get(number).map_or("", |route| phase(route.0));
            film.channel(("route", &full(route), "phase"), frames.iter().map(its));
            let proceed = |now: &Frame| if shows(now, number) { format!("proceed at {signal}") } else { String::new() };
            film.channel(("route", &full(route), "signal"), frames.iter().map(proceed));
            if names.signals[..number].contains(signal) {
                continue;
            }
            let routes = || names.signals.iter().enumerate().filter(|(_, other)| *other == signal);
            let any = |now: &Frame| if routes().any(|(route, _)| shows(now, route)) { "proceed" } else { "stop" };
            film.channel(("signal", &full(signal), "shows"), frames.iter().map(any));
        }
        for (number, global) in line.track.sites[at].points.iter().enumerate() {
            let name = &line.track.points[*global].name;
            let lies = |now: &Frame| match now.points[*global].lie() {
                None => "none",
                Some(true) => "reverse",
                Some(false) => "normal",
            };
            film.channel(("point", name, "detected"), frames.iter().map(lies));
            let it = Points::nth(number);
            let driven =
                |now: &Frame| match (now.offices[at].drives.normal.meets(it), now.offices[at].drives.reverse.meets(it))
                {
                    (true, _) => "normal",
                    (false, true) => "reverse",
                    (false, false) => "",
                };
            film.channel(("point", name, "driven"), frames.iter().map(driven));
        }
        for (number, segment) in names.segments.iter().enumerate() {
            let it = Segments::nth(number);
            let direction =
                |now: &Frame| match (now.offices[at].view.toward.meets(it), now.offices[at].view.away.meets(it)) {
                    (true, _) => "toward",
                    (false, true) => "away",
                    (false, false) => "none",
                };
            film.channel(("segment", &full(segment), "direction"), frames.iter().map(direction));
            let permit = |now: &Frame| yes(now.offices[at].permits.meets(it));
            film.channel(("segment", &full(segment), "permit"), frames.iter().map(permit));
        }
    }
}

fn trains(film: &mut Film, line: &Line, frames: &[Frame]) {
    let count = frames.first().map_or(0, |frame| frame.trains.len());
    for number in 0..count {
        let name = number.to_string();
        let of = |now: &Frame, what: fn(&Glimpse) -> i64| Some(what(&now.trains[number]));
        let mut curve = |what: &str, told: (&str, u32), value: fn(&Glimpse) -> i64| {
            film.curve(("train", &name, what), told, frames.iter().map(|now| of(now, value)));
        };
        curve("front_share", ("", 1000), |train| train.front);
        curve("rear_share", ("", 1000), |train| train.tail);
        curve("front_m", ("m", 10), |train| train.along[0]);
        curve("tail_m", ("m", 10), |train| train.along[1]);
        curve("speed", ("km/h", 10), |train| train.speed);
        let permitted = frames.iter().map(|now| now.trains[number].permitted);
        film.curve(("train", &name, "permitted"), ("km/h", 10), permitted);
        film.channel(("train", &name, "on"), frames.iter().map(|now| &now.trains[number].on));
        film.channel(("train", &name, "display"), frames.iter().map(|now| &now.trains[number].display));
        film.channel(("train", &name, "brake"), frames.iter().map(|now| now.trains[number].brake));
        let place = frames.iter().map(|now| &line.track.circuits[now.trains[number].circuit].name);
        film.channel(("train", &name, "in"), place);
        film.trains.push(name);
    }
}

#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a cast from float saturates")]
fn distance(film: &mut Film, line: &Line) {
    let track = &line.track;
    let metres = |value: f64| value.round().max(0.0) as u32;
    let length_m = metres(track.along_m.iter().copied().fold(0.0, f64::max));
    let middle = |station: &crate::line::Place| {
        let joints = station.platforms.iter().flat_map(|one| &one.legs).flat_map(|leg| [leg.enter, leg.exit]);
        let along: Vec<f64> = joints.map(|joint| track.along_m[joint]).collect();
        let (from, to) = along.iter().fold((f64::INFINITY, 0.0_f64), |(from, to), at| (from.min(*at), to.max(*at)));
        f64::midpoint(from.min(to), to)
    };
    let places =
        line.stations.iter().map(|station| Place { name: station.name.clone(), at_m: metres(middle(station)) });
    let plain = track.pieces.iter().filter(|piece| piece.plain);
    let circuits = plain.map(|piece| {
        let (one, other) = (track.along_m[piece.joints[0]], track.along_m[piece.joints[1]]);
        let circuit = track.circuits[piece.circuit].name.clone();
        Stretch { circuit, from_m: metres(one.min(other)), to_m: metres(one.max(other)) }
    });
    film.distance = Some(Distance { length_m, places: places.collect(), circuits: circuits.collect() });
}

fn tables(film: &mut Film) {
    let train = [
        ("in", "front in"),
        ("speed", "speed"),
        ("permitted", "permitted"),
        ("display", "cab shows"),
        ("brake", "brake"),
        ("front_m", "front at"),
    ];
    film.table("Trains", "train", &train, false);
    film.table("Routes that are held", "route", &[("phase", "phase"), ("signal", "signal")], true);
    film.table("Points, as they lie", "point", &[("detected", "lies"), ("driven", "driven to")], false);
    let segment = [("direction", "direction"), ("permit", "neighbour may send")];
    film.table("Lines, as each station has them", "segment", &segment, false);
    let circuit = [
        ("reported", "reported"),
        ("counted", "counted"),
        ("held", "held by"),
        ("told", "its train is told"),
        ("block", "block"),
    ];
    film.table("Circuits", "circuit", &circuit, true);
}

/// What happened, in the frame that shows it first.
fn events(film: &mut Film, world: &World<'_>, every: u64) {
    let last = film.frames - 1;
    for event in &world.events {
        let frame = u32::try_from(event.at_ms.div_ceil(every)).unwrap_or(u32::MAX).min(last);
        let class = match &event.what {
            what if what.is_unsafe() => Class::Harm,
            What::Fault { .. } | What::NeedlesslyBraked { .. } => Class::Fault,
            _ => Class::Output,
        };
        film.event(frame, class, &told(&event.what));
    }
    film.sort_events();
}

fn told(what: &What) -> String {
    let way = |bound: &Bound| if *bound == Bound::West { "west" } else { "east" };
    match what {
        What::Arrived { train, station, track } => format!("train {train} stands in {station}, track {track}"),
        What::Left { train, station, bound } => format!("train {train} leaves {station} to the {}", way(bound)),
        What::Set { station, route } => format!("{station}: route {route} accepted"),
        What::Proceed { station, signal, route } => format!("{station}: signal {signal} at proceed for {route}"),
        What::Stop { station, signal, route } => format!("{station}: signal {signal} at stop ({route})"),
        What::Turned { line, bound } => format!("line {line} has direction {}", way(bound)),
        What::Braked { train, emergency, along_m } => {
            let kind = if *emergency { "emergency" } else { "service" };
            format!("train {train}: {kind} brake at {along_m:.0} m")
        }
        What::NeedlesslyBraked { train, along_m } => format!("train {train} brakes needlessly at {along_m:.0} m"),
        What::Fault { kind, at, lasts_ms } => format!("fault: {}, {at}, for {:.1} s", kind.name(), lasts_ms / 1000.0),
        What::Collision { train, with, circuit } => format!("COLLISION of trains {train} and {with} in {circuit}"),
        What::Derailment { train, point } => format!("DERAILMENT of train {train} at {point}"),
        What::MovedUnder { train, point } => format!("{point} MOVES UNDER train {train}"),
        What::Overrun { train, circuit } => format!("train {train} OVERRUNS into {circuit}"),
        What::Overspeed { train, circuit, kmh } => format!("train {train} IS TOO FAST in {circuit}: {kmh:.1} km/h"),
        What::EndOfTrack { train } => format!("train {train} OVER THE END OF THE TRACK"),
    }
}
