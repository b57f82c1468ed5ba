//! The timing chart of the ground's device: requests and restarts, what the interlocking is told to be occupied, the counted blocks,
//! the signals, the neighbours' permissions, and how far trains are told to go.

use std::collections::BTreeSet;

use super::record;
use super::scene::{Lane, Mark, Scene, Signal, Tone, Unit, Values};
use super::series::{changes, spans, standing};
use crate::drawn::machine::Drawn;
use crate::trace::run::Cycle;
use atc_kernel::interlocking::{Large, Size, Small};
use atc_protocol::machine::Machine;
use atc_protocol::machine::interlocking::{Answer, Request};
use atc_protocol::machine::sizes::{self, Stationed as _};
use atc_protocol::machine::wayside::{Config, Ground, Output, Permission, Sizes, Step, Transmission};
use atc_protocol::names::Named;

/// The device after one cycle.
struct Moment {
    output: Output,
    told: BTreeSet<String>,
    consent: BTreeSet<String>,
}

impl Drawn for Sizes {
    fn chart(config: &Config, cycles: &[Cycle<Self>]) -> Scene {
        if config.is_large() {
            let draws = || {
                scene::<{ sizes::ROUTES }, { sizes::PLACES }, { sizes::POINTS }, { sizes::SEGMENTS }, Large>(
                    config, cycles,
                )
            };
            return sizes::with_room(draws).unwrap_or_else(|_| empty(cycles.len()));
        }
        scene::<64, 16, 32, 8, Small>(config, cycles)
    }
}

/// A chart of so many cycles without a row.
fn empty(cycles: usize) -> Scene {
    Scene {
        legend: vec![
            (Tone::Detected, "occupied"),
            (Tone::Held, "told to be occupied, not reported"),
            (Tone::Signal, "counting, permitted, requested"),
            (Tone::Emergency, "refused, fault, restart"),
            (Tone::Code, "what trains are told"),
        ],
        ..Scene::of(Sizes::NAME, Unit { axis: "time", name: "ms", per_cycle: 1 }, cycles as u64)
    }
}

/// Lays out a case.
fn scene<const R: usize, const P: usize, const N: usize, const S: usize, Z: Size>(
    config: &Config,
    cycles: &[Cycle<Sizes>],
) -> Scene
where
    Ground<R, P, N, S, Z>: Machine<Config = Config, Step = Step, Output = Output>,
{
    let mut scene = empty(cycles.len());
    // A trace is laid out only after the kernel has taken its configuration and every step.
    let Ok(mut machine) = Ground::<R, P, N, S, Z>::open(config) else { return scene };
    scene.unit.per_cycle = machine.station().cycle_ms();
    let mut moments = Vec::with_capacity(cycles.len());
    for cycle in cycles {
        if let Ok((output, told, consent)) = machine.told(&cycle.step) {
            moments.push(Moment { output, told, consent });
        }
    }
    let names = machine.station().names();
    scene.notes = vec![
        format!("{}: cycle {} ms.", names.station, machine.station().cycle_ms()),
        "What is read is drawn over the cycle in which it was read; all else stands from the end of the cycle on."
            .to_owned(),
    ];
    let row = |label: String, marks: Vec<Mark>| Lane { label, first: false, height: 24, marks };
    scene.lanes.push(row("requests".to_owned(), requests(cycles)));
    for name in &names.circuits {
        let seen = cycles
            .iter()
            .zip(&moments)
            .map(|(cycle, now)| (cycle.step.occupied.contains(name), now.told.contains(name)));
        let marks = bars(seen, |(reported, told)| match (reported, told) {
            (true, _) => Some((Tone::Detected, "occupied".to_owned())),
            (false, true) => Some((Tone::Held, "counted".to_owned())),
            (false, false) => None,
        });
        scene.lanes.push(row(name.clone(), marks));
    }
    let blocks = config.counted.as_ref().map_or(0, |counted| counted.blocks.len());
    for number in 0..blocks {
        let counts = |now: &Moment| {
            let block = *now.output.line.as_ref()?.blocks.get(number)?;
            let count = block.count;
            Some(match (block.fault, block.counting == Some(true), block.agree) {
                (Some(fault), _, _) => (Tone::Emergency, fault.name().to_owned()),
                (None, true, true) => (Tone::Signal, count.to_string()),
                (None, true, false) => (Tone::Held, format!("{count}, disagrees")),
                (None, false, _) => (Tone::Blank, "unverified".to_owned()),
            })
        };
        let marks = bars(standing(None, moments.iter().map(counts)), |value| value);
        scene.lanes.push(row(format!("block {number}"), marks));
    }
    for name in &names.routes {
        if moments.iter().any(|now| now.output.routes.contains_key(name)) {
            let proceed = standing(false, moments.iter().map(|now| now.output.proceed.contains(name)));
            let wave = spans(proceed).into_iter().filter(|span| span.2).map(|span| (span.0, span.1)).collect();
            scene.lanes.push(row(format!("proceed, {name}"), vec![Mark::Wave(wave)]));
        }
    }
    for name in &names.segments {
        let marks = bars(moments.iter().map(|now| now.consent.contains(name)), |consent| {
            consent.then(|| (Tone::Signal, "permitted".to_owned()))
        });
        scene.lanes.push(row(format!("consent of {name}"), marks));
        let permits = |now: &Moment| {
            now.output.messages.get(name).is_some_and(|message| message.permission == Permission::Granted)
        };
        let marks = bars(standing(false, moments.iter().map(permits)), |permits| {
            permits.then(|| (Tone::Blank, "permits".to_owned()))
        });
        scene.lanes.push(row(format!("permits, {name}"), marks));
    }
    for name in &names.circuits {
        let sent = |now: &Moment| now.output.transmissions.get(name).and_then(open);
        if moments.iter().any(|now| sent(now).is_some()) {
            let marks = bars(standing(None, moments.iter().map(sent)), |sent| Some((Tone::Code, sent?)));
            scene.lanes.push(row(format!("train in {name}"), marks));
        }
    }
    scene.signals = signals(&machine, &moments);
    let said = cycles.iter().map(|cycle| difference(cycle.recorded.as_ref()?, &cycle.output));
    record::differences(&mut scene, 1, said);
    scene
}

/// How far the train may go, and which way.
fn open(sent: &Transmission) -> Option<String> {
    let (left, right) = (sent.left.main.beyond_exit_m, sent.right.main.beyond_exit_m);
    match (left, right) {
        (Some(metres), None) => Some(format!("◀ {metres} m")),
        (None, Some(metres)) => Some(format!("▶ {metres} m")),
        _ => None,
    }
}

fn bars<T: Clone + PartialEq>(
    values: impl IntoIterator<Item = T>,
    bar: impl Fn(T) -> Option<(Tone, String)>,
) -> Vec<Mark> {
    let spans = spans(values).into_iter();
    let marks = spans
        .filter_map(|(from, to, value)| bar(value).map(|(tone, text)| Mark::Bar { from, to, tone, texts: vec![text] }));
    marks.collect()
}

fn requests(cycles: &[Cycle<Sizes>]) -> Vec<Mark> {
    let asked = |step: &Step| {
        Some(match step.request.as_ref()? {
            Request::Set { set } => format!("set {set}"),
            Request::Withdraw { withdraw } => format!("withdraw {withdraw}"),
            Request::Drive { drive, to } => format!("{drive} {}", to.name()),
            Request::Turn { turn, to } => format!("{turn} {}", to.name()),
        })
    };
    let mut marks = Vec::new();
    for (cycle, at) in cycles.iter().zip(0..) {
        let (from, to) = (at, at + 1);
        if let Some(session) = cycle.step.restart {
            marks.push(Mark::Bar { from, to, tone: Tone::Emergency, texts: vec![format!("start {session}")] });
        }
        if let Some(text) = asked(&cycle.step) {
            let refused = matches!(cycle.output.answer, Some(Answer::Refused(_)));
            let tone = if refused { Tone::Emergency } else { Tone::Signal };
            marks.push(Mark::Bar { from, to, tone, texts: vec![text] });
        }
    }
    marks
}

fn signals<const R: usize, const P: usize, const N: usize, const S: usize, Z: Size>(
    machine: &Ground<R, P, N, S, Z>,
    moments: &[Moment],
) -> Vec<Signal> {
    let word = |name: &str| name.replace(|letter: char| letter.is_whitespace(), "_");
    let names = machine.station().names();
    let mut all = Vec::new();
    for name in &names.circuits {
        let told = standing(true, moments.iter().map(|now| now.told.contains(name)));
        all.push(Signal { name: format!("occupied_{}", word(name)), values: Values::Wire(changes(told)) });
        let sent = |now: &Moment| {
            let sent = now.output.transmissions.get(name).and_then(open);
            sent.map_or_else(|| "stop".to_owned(), |text| text.replace(' ', "_"))
        };
        let sent = standing("stop".to_owned(), moments.iter().map(sent));
        all.push(Signal { name: format!("telegram_{}", word(name)), values: Values::State(changes(sent)) });
    }
    for name in &names.routes {
        let proceed = standing(false, moments.iter().map(|now| now.output.proceed.contains(name)));
        all.push(Signal { name: format!("proceed_{}", word(name)), values: Values::Wire(changes(proceed)) });
    }
    for name in &names.segments {
        let consent = standing(false, moments.iter().map(|now| now.consent.contains(name)));
        all.push(Signal { name: format!("consent_{}", word(name)), values: Values::Wire(changes(consent)) });
    }
    all
}

/// What the record says otherwise.
fn difference(said: &Output, kernel: &Output) -> Option<String> {
    if said == kernel {
        return None;
    }
    let values = serde_json::to_value(said).ok().zip(serde_json::to_value(kernel).ok());
    let (said, kernel) = values?;
    let fields = said.as_object()?.iter().filter(|(name, value)| kernel.get(*name) != Some(*value));
    Some(fields.map(|(name, value)| format!("{name} {value}")).collect::<Vec<_>>().join(", "))
}
