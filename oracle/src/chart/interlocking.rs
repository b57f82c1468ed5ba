//! The timing chart of the interlocking: what is asked, what every circuit is held for, the phases and signals of the routes, the
//! points, the direction of plain line, and what trains are told.

use std::collections::BTreeSet;

use atc_kernel::interlocking::{self as kernel, CircuitSet, Position, SegmentSet, Size};

use super::record;
use super::scene::{Lane, Mark, Scene, Signal, Tone, Unit, Values};
use super::series::{changes, spans, standing};
use crate::drawn::machine::Drawn;
use crate::film::interlocking;
use crate::film::take::Take;
use crate::trace::run::Cycle;
use atc_film::Film;
use atc_protocol::machine::Machine;
use atc_protocol::machine::interlocking::{
    Answer, Config, Interlocked, Output, Phase, Refused, Request, Side, Sizes, Step, Travel,
};
use atc_protocol::machine::sizes::{self, Stationed as _};
use atc_protocol::names::Named;

/// The device after one cycle.
struct Moment<const R: usize, const S: usize, Z: Size> {
    state: kernel::State<R, S, Z>,
    occupied: CircuitSet<Z>,
    output: Output,
}

/// What a circuit is, the strongest first.
#[derive(Clone, PartialEq, Eq)]
enum Use {
    Occupied,
    Held(String),
    Blocked,
    Free,
}

impl Drawn for Sizes {
    fn chart(config: &Config, cycles: &[Cycle<Self>]) -> Scene {
        if config.is_large() {
            let draws = || {
                scene::<{ sizes::ROUTES }, { sizes::PLACES }, { sizes::POINTS }, { sizes::SEGMENTS }, kernel::Large>(
                    config, cycles,
                )
            };
            return sizes::with_room(draws).unwrap_or_else(|_| empty(cycles.len()));
        }
        scene::<64, 16, 32, 8, kernel::Small>(config, cycles)
    }

    fn film(take: &Take<'_, Self>, film: &mut Film) -> Result<bool, String> {
        interlocking::put(take, film).map(|()| true)
    }
}

/// A chart of so many cycles without a row.
fn empty(cycles: usize) -> Scene {
    Scene {
        legend: vec![
            (Tone::Detected, "occupied; route in use"),
            (Tone::Held, "held; route set"),
            (Tone::Pending, "provisional; point driven"),
            (Tone::Shortened, "releasing"),
            (Tone::Dropped, "blocked; not detected"),
            (Tone::Emergency, "failed, refused"),
            (Tone::Code, "what trains are told"),
        ],
        ..Scene::of(Sizes::NAME, Unit { axis: "time", name: "ms", per_cycle: 1 }, cycles as u64)
    }
}

/// Lays out a case.
fn scene<const R: usize, const P: usize, const N: usize, const S: usize, Z: Size>(
    config: &Config,
    cycles: &[Cycle<Sizes>],
) -> Scene {
    let mut scene = empty(cycles.len());
    // A trace is laid out only after the kernel has taken its configuration and every step.
    let Ok(mut machine) = Interlocked::<R, P, N, S, Z>::open(config) else { return scene };
    scene.unit.per_cycle = machine.cycle_ms();
    let mut moments = Vec::with_capacity(cycles.len());
    for cycle in cycles {
        if let Some(moment) = moment(&mut machine, &cycle.step) {
            moments.push(moment);
        }
    }
    let plan = machine.layout().plan();
    scene.notes = vec![
        format!(
            "{}: a circuit is clear after {}; cycle {} ms.",
            machine.names().station,
            scene.unit.text(plan.clear.into()),
            machine.cycle_ms()
        ),
        "Requests and detections are drawn over the cycles in which they were read; all else stands from the end of the cycle on.".to_owned(),
    ];
    if matches!(config, Config::Plan(_)) {
        scene.notes.push("A plan in the kernel's own terms: the rules of engineering were not checked.".to_owned());
    }
    scene.lanes = requests(cycles);
    scene.lanes.extend(circuits(&machine, &moments));
    scene.lanes.extend(routes(&machine, &moments));
    scene.lanes.extend(points(&machine, cycles, &moments));
    scene.lanes.extend(segments(&machine, &moments));
    scene.lanes.extend(telegrams(&machine, &moments));
    scene.signals = signals(&machine, &moments);
    let said = cycles.iter().map(|cycle| difference(cycle.recorded.as_ref()?, &cycle.output));
    record::differences(&mut scene, 1, said);
    scene
}

fn moment<const R: usize, const P: usize, const N: usize, const S: usize, Z: Size>(
    machine: &mut Interlocked<R, P, N, S, Z>,
    step: &Step,
) -> Option<Moment<R, S, Z>> {
    let input = machine.input(step).ok()?;
    let before = *machine.state();
    let output = Machine::step(machine, step).ok()?;
    let (_, occupied) = before.track.step(machine.layout().plan().clear, input.occupied);
    Some(Moment { state: *machine.state(), occupied, output })
}

/// Bars for the spans of a row of values; none where `bar` gives none.
fn bars<T: Clone + PartialEq>(
    values: impl IntoIterator<Item = T>,
    bar: impl Fn(T) -> Option<(Tone, Vec<String>)>,
) -> Vec<Mark> {
    let spans = spans(values).into_iter();
    spans.filter_map(|(from, to, value)| bar(value).map(|(tone, texts)| Mark::Bar { from, to, tone, texts })).collect()
}

/// A group of rows, the first of them with a line above it.
fn group(rows: impl Iterator<Item = (String, u32, Vec<Mark>)>) -> Vec<Lane> {
    let rows = rows.enumerate();
    rows.map(|(place, (label, height, marks))| Lane { label, first: place == 0, height, marks }).collect()
}

fn requests(cycles: &[Cycle<Sizes>]) -> Vec<Lane> {
    let marks = cycles.iter().zip(0..).filter_map(|(cycle, at)| {
        let asked = match cycle.step.request.as_ref()? {
            Request::Set { set } => format!("set {set}"),
            Request::Withdraw { withdraw } => format!("withdraw {withdraw}"),
            Request::Drive { drive, to } => format!("{drive} {}", to.name()),
            Request::Turn { turn, to } => format!("{turn} {}", to.name()),
        };
        let (tone, said) = match &cycle.output.answer {
            Some(Answer::Refused(Refused { refused, because })) => {
                let names: Vec<_> = because.iter().map(String::as_str).collect();
                (
                    Tone::Emergency,
                    [format!(", refused: {} {}", refused.name(), names.join(", ")), ", refused".to_owned()],
                )
            }
            _ => (Tone::Signal, [String::new(), String::new()]),
        };
        Some(Mark::Bar {
            from: at,
            to: at + 1,
            tone,
            texts: said.iter().map(|said| format!("{asked}{said}")).collect(),
        })
    });
    let marks: Vec<_> = marks.collect();
    if marks.is_empty() {
        return Vec::new();
    }
    // In turn in several rows, so that a long text has room beside its mark.
    let mut rows = vec![Vec::new(); marks.len().min(3)];
    for (row, mark) in (0..rows.len()).cycle().zip(marks) {
        rows[row].push(mark);
    }
    let rows = rows.into_iter().zip(["requests", "", ""]);
    group(rows.map(|(marks, label)| (label.to_owned(), 24, marks)))
}

fn circuits<const R: usize, const P: usize, const N: usize, const S: usize, Z: Size>(
    machine: &Interlocked<R, P, N, S, Z>,
    moments: &[Moment<R, S, Z>],
) -> Vec<Lane> {
    let used = |moment: &Moment<R, S, Z>, circuit: CircuitSet<Z>| {
        if moment.occupied.meets(circuit) {
            return Use::Occupied;
        }
        let plan = machine.layout().plan();
        let mut names = Vec::new();
        let routes = machine.names().routes.iter().zip(&plan.routes).zip(&moment.state.routes);
        for ((name, route), state) in routes.filter(|(_, state)| state.is_held()) {
            if state.path(route).circuits.meets(circuit) {
                names.push(name.clone());
            } else if state.overlap(route).circuits.meets(circuit) {
                names.push(format!("overlap of {name}"));
            }
        }
        match () {
            () if !names.is_empty() => Use::Held(names.join(", ")),
            () if moment.state.works.blocked.meets(circuit) => Use::Blocked,
            () => Use::Free,
        }
    };
    let rows = machine.names().circuits.iter().enumerate().map(|(number, name)| {
        let circuit = CircuitSet::nth(number);
        let marks = bars(standing(Use::Occupied, moments.iter().map(|now| used(now, circuit))), |used| match used {
            Use::Occupied => Some((Tone::Detected, vec!["occupied".to_owned()])),
            Use::Held(names) => Some((Tone::Held, vec![names])),
            Use::Blocked => Some((Tone::Dropped, vec!["blocked".to_owned()])),
            Use::Free => None,
        });
        (name.clone(), 24, marks)
    });
    group(rows)
}

fn routes<const R: usize, const P: usize, const N: usize, const S: usize, Z: Size>(
    machine: &Interlocked<R, P, N, S, Z>,
    moments: &[Moment<R, S, Z>],
) -> Vec<Lane> {
    let ever = |number: &usize| moments.iter().any(|now| now.state.routes[*number].is_held());
    let rows = (0..machine.names().routes.len()).filter(ever).flat_map(|number| {
        let name = &machine.names().routes[number];
        let phases = standing(kernel::Phase::Idle, moments.iter().map(|now| now.state.routes[number].phase));
        let marks = bars(phases, |phase| {
            let tone = match phase {
                kernel::Phase::Idle => return None,
                kernel::Phase::Provisional => Tone::Pending,
                kernel::Phase::Failed => Tone::Emergency,
                kernel::Phase::Set => Tone::Held,
                kernel::Phase::InUse => Tone::Detected,
                kernel::Phase::Releasing => Tone::Shortened,
            };
            Some((tone, vec![Phase(phase).name().to_owned()]))
        });
        let proceed = standing(false, moments.iter().map(|now| now.output.proceed.contains(name)));
        let wave = spans(proceed).into_iter().filter(|span| span.2).map(|span| (span.0, span.1)).collect();
        let signal = &machine.names().signals[number];
        [(format!("route {name}"), 24, marks), (format!("proceed at {signal}"), 28, vec![Mark::Wave(wave)])]
    });
    group(rows)
}

fn points<const R: usize, const P: usize, const N: usize, const S: usize, Z: Size>(
    machine: &Interlocked<R, P, N, S, Z>,
    cycles: &[Cycle<Sizes>],
    moments: &[Moment<R, S, Z>],
) -> Vec<Lane> {
    let rows = machine.names().points.iter().map(|name| {
        let detected = cycles.iter().map(|cycle| cycle.step.detected.0.get(name).copied().flatten());
        let driven = moments.iter().map(|now| now.output.drives.get(name).copied());
        let shown =
            detected.zip(driven).map(|(detected, driven): (Option<Side>, Option<Side>)| match (detected, driven) {
                (_, Some(side)) => (Tone::Pending, format!("to {}", side.name())),
                (Some(side), None) if side == Side(Position::Normal) => (Tone::Blank, side.name().to_owned()),
                (Some(side), None) => (Tone::Signal, side.name().to_owned()),
                (None, None) => (Tone::Dropped, "not detected".to_owned()),
            });
        let marks = bars(shown, |(tone, text)| Some((tone, vec![text])));
        (format!("point {name}"), 24, marks)
    });
    group(rows)
}

fn segments<const R: usize, const P: usize, const N: usize, const S: usize, Z: Size>(
    machine: &Interlocked<R, P, N, S, Z>,
    moments: &[Moment<R, S, Z>],
) -> Vec<Lane> {
    let rows = machine.names().segments.iter().enumerate().map(|(number, name)| {
        let segment = SegmentSet::nth(number);
        let travel = |now: &Moment<R, S, Z>| {
            let directions = now.state.directions;
            match (directions.toward.meets(segment), directions.away.meets(segment)) {
                (true, _) => Some(kernel::Travel::Toward),
                (false, away) => away.then_some(kernel::Travel::Away),
            }
        };
        let marks = bars(standing(None, moments.iter().map(travel)), |travel| {
            let tone = match travel? {
                kernel::Travel::Toward => Tone::Blank,
                kernel::Travel::Away => Tone::Signal,
            };
            Some((tone, travel.iter().map(|travel| Travel(*travel).name().to_owned()).collect()))
        });
        (format!("line {name}"), 24, marks)
    });
    group(rows)
}

/// What the train in each circuit is told, for the circuits in which one is told to go.
fn telegrams<const R: usize, const P: usize, const N: usize, const S: usize, Z: Size>(
    machine: &Interlocked<R, P, N, S, Z>,
    moments: &[Moment<R, S, Z>],
) -> Vec<Lane> {
    let open: BTreeSet<&String> = moments
        .iter()
        .flat_map(|now| now.output.telegrams.iter().filter(|(_, telegram)| telegram.open).map(|(name, _)| name))
        .collect();
    let rows = machine.names().circuits.iter().filter(|name| open.contains(name)).map(|name| {
        let told = moments.iter().map(|now| now.output.telegrams.get(name).filter(|telegram| telegram.open).cloned());
        let marks = bars(standing(None, told), |told| {
            let told = told?;
            let way = told.heading.map_or("", |heading| if heading.0 == kernel::Heading::Left { "◀ " } else { "▶ " });
            let full = format!("{way}to {} at {} km/h", told.stop, told.speed_km_h);
            Some((Tone::Code, vec![full, format!("{way}to {}", told.stop)]))
        });
        (format!("train in {name}"), 24, marks)
    });
    group(rows)
}

/// What the record says otherwise.
fn difference(said: &Output, kernel: &Output) -> Option<String> {
    if said == kernel {
        return None;
    }
    let mut parts = Vec::new();
    let mut part = |name: &str, differs: bool, value: serde_json::Result<String>| {
        if differs {
            parts.push(format!("{name} {}", value.unwrap_or_default()));
        }
    };
    part("routes", said.routes != kernel.routes, serde_json::to_string(&said.routes));
    part("proceed", said.proceed != kernel.proceed, serde_json::to_string(&said.proceed));
    part("drives", said.drives != kernel.drives, serde_json::to_string(&said.drives));
    part("telegrams", said.telegrams != kernel.telegrams, serde_json::to_string(&said.telegrams));
    part("silent", said.silent != kernel.silent, serde_json::to_string(&said.silent));
    part("permits", said.permits != kernel.permits, serde_json::to_string(&said.permits));
    part("confirmed", said.confirmed != kernel.confirmed, serde_json::to_string(&said.confirmed));
    part("answer", said.answer != kernel.answer, serde_json::to_string(&said.answer));
    Some(parts.join(", "))
}

fn signals<const R: usize, const P: usize, const N: usize, const S: usize, Z: Size>(
    machine: &Interlocked<R, P, N, S, Z>,
    moments: &[Moment<R, S, Z>],
) -> Vec<Signal> {
    let word = |name: &str| name.replace(|letter: char| letter.is_whitespace(), "_");
    let names = machine.names();
    let mut all = Vec::new();
    for (number, name) in names.circuits.iter().enumerate() {
        let occupied = standing(true, moments.iter().map(|now| now.occupied.meets(CircuitSet::nth(number))));
        all.push(Signal { name: format!("occupied_{}", word(name)), values: Values::Wire(changes(occupied)) });
        let told = |now: &Moment<R, S, Z>| match now.output.telegrams.get(name) {
            Some(telegram) if telegram.open => format!("{}_{}", word(&telegram.stop), telegram.speed_km_h),
            _ => "stop".to_owned(),
        };
        let told = standing("stop".to_owned(), moments.iter().map(told));
        all.push(Signal { name: format!("telegram_{}", word(name)), values: Values::State(changes(told)) });
    }
    for (number, name) in names.routes.iter().enumerate() {
        let phase = |now: &Moment<R, S, Z>| Phase(now.state.routes[number].phase).name().to_owned();
        let phases = standing("idle".to_owned(), moments.iter().map(phase));
        all.push(Signal { name: format!("route_{}", word(name)), values: Values::State(changes(phases)) });
        let proceed = standing(false, moments.iter().map(|now| now.output.proceed.contains(name)));
        all.push(Signal { name: format!("proceed_{}", word(name)), values: Values::Wire(changes(proceed)) });
    }
    for name in &names.points {
        let drive = |now: &Moment<R, S, Z>| now.output.drives.get(name).map_or("none", |side| side.name()).to_owned();
        let drives = standing("none".to_owned(), moments.iter().map(drive));
        all.push(Signal { name: format!("drive_{}", word(name)), values: Values::State(changes(drives)) });
    }
    all
}
