//! The charts of the permitted speed: over distance, what the train may and does, with sections and stopping points; over time,
//! the speeds, what they rest on, and the telegrams.

use atc_kernel::telegram::Route;

use super::figure::{Curve, Figure, Stroke};
use super::record;
use super::scene::{Lane, Mark, Scale, Scene, Signal, Tone, Unit, Values};
use super::series::{changes, metres, spans, standing};
use crate::drawn::machine::Drawn;
use crate::trace::run::Cycle;
use atc_protocol::decimal::Metres;
use atc_protocol::kmh::Kmh;
use atc_protocol::machine::Machine;
use atc_protocol::machine::permitted::{Basis, Config, LineKind, Output, Permitting, RememberedSub};
use atc_protocol::names::Named as _;

fn km_h(speed: Kmh) -> f64 {
    f64::from(speed.0) / 10.0
}

/// Whether the main and the sub telegram of each cycle were used: then what is remembered is younger after it, or of another
/// section.
fn uses(cycles: &[Cycle<Permitting>]) -> Vec<(bool, bool)> {
    let (mut main_age, mut newest) = (None, None);
    let used = cycles.iter().map(|cycle| {
        let Some(state) = &cycle.output.state else { return (false, false) };
        let sub = state.sub.first().copied();
        let younger = state.main_age_ms.is_some_and(|age| main_age.is_none_or(|before| age <= before));
        let learned = sub.is_some_and(|sub| {
            newest.is_none_or(|before: RememberedSub| sub.section != before.section || sub.age_ms <= before.age_ms)
        });
        (main_age, newest) = (state.main_age_ms, sub);
        (cycle.step.main.is_some() && younger, cycle.step.sub.is_some() && learned)
    });
    used.collect()
}

impl Drawn for Permitting {
    fn chart(config: &Config, cycles: &[Cycle<Self>]) -> Scene {
        scene(config, cycles)
    }
}

/// Lays out a case.
fn scene(config: &Config, cycles: &[Cycle<Permitting>]) -> Scene {
    let mut scene = Scene {
        notes: vec![
            format!(
                "Brake {} mm/s², margin {} m; a main telegram is fresh for {} ms and its pattern runs down for {} ms; cycle {} ms. Until the sub telegram: gradient {} ‰, limit {} km/h.",
                config.brake_mm_s2, config.margin_m, config.fresh_ms, config.life_ms, config.cycle_ms, config.worst_gradient_permille, config.lowest_limit_km_h
            ),
            "What is heard is drawn over the cycle in which it was heard; what is permitted stands from the end of the cycle on.".to_owned(),
        ],
        lanes: lanes(cycles),
        legend: vec![
            (Tone::Limit, "permitted; to stop"),
            (Tone::Signal, "train; telegram used"),
            (Tone::Code, "analog code"),
            (Tone::Dropped, "telegram not used"),
            (Tone::Operate, "code and pattern"),
            (Tone::Recovery, "pattern alone"),
            (Tone::Mask, "running down"),
            (Tone::Emergency, "nothing"),
        ],
        signals: signals(cycles),
        figure: Some(figure(config, cycles)),
        ..Scene::of(Permitting::NAME, Unit { axis: "time", name: "ms", per_cycle: config.cycle_ms }, cycles.len() as u64)
    };
    let texts = cycles.iter().map(|cycle| {
        let said = cycle.recorded.as_ref().filter(|said| **said != cycle.output);
        said.map(|said| {
            let speed = said.speed_km_h.map_or_else(|| "none".to_owned(), |speed| format!("{speed} km/h"));
            let state = said.state.as_ref().filter(|state| Some(*state) != cycle.output.state.as_ref());
            let state = state.and_then(|state| serde_json::to_string(state).ok());
            format!(
                "{speed}, {}{}",
                said.basis.name(),
                state.map(|state| format!(", state {state}")).unwrap_or_default()
            )
        })
    });
    record::differences(&mut scene, 1, texts);
    scene
}

fn lanes(cycles: &[Cycle<Permitting>]) -> Vec<Lane> {
    let outputs = || cycles.iter().map(|cycle| &cycle.output);
    let speeds =
        cycles.iter().flat_map(|cycle| [cycle.output.speed_km_h, cycle.step.speed_km_h, cycle.step.analog_km_h]);
    let scale = Scale { bottom: 0.0, top: speeds.flatten().map(km_h).fold(10.0, f64::max) * 1.1 };
    let curve = |points: Vec<(u64, Option<f64>)>, tone, scale| Mark::Curve { points, tone, scale };
    let read =
        |speed: fn(&Cycle<Permitting>) -> Option<Kmh>| changes(cycles.iter().map(|cycle| speed(cycle).map(km_h)));
    let permitted = changes(standing(None, outputs().map(|output| output.speed_km_h.map(km_h))));
    let mut speeds =
        vec![curve(permitted, Tone::Limit, scale), curve(read(|cycle| cycle.step.analog_km_h), Tone::Code, scale)];
    if cycles.iter().any(|cycle| cycle.step.speed_km_h.is_some()) {
        speeds.push(curve(read(|cycle| cycle.step.speed_km_h), Tone::Signal, scale));
    }
    let bases = spans(standing(Basis::Nothing, outputs().map(|output| output.basis))).into_iter();
    let bases = bases.map(|(from, to, basis)| {
        let (tone, text, short) = match basis {
            Basis::Nothing => (Tone::Emergency, "nothing", "–"),
            Basis::Analog => (Tone::Blank, "analog code", "code"),
            Basis::Pattern => (Tone::Recovery, "pattern", "p"),
            Basis::Both => (Tone::Operate, "code and pattern", "both"),
            Basis::RunningDown => (Tone::Mask, "running down", "rd"),
        };
        Mark::Bar { from, to, tone, texts: vec![text.to_owned(), short.to_owned()] }
    });
    let lane = |label: &str, first, height, marks| Lane { label: label.to_owned(), first, height, marks };
    let mut lanes = vec![lane("speed, km/h", true, 150, speeds), lane("rests on", false, 26, bases.collect())];
    let line = spans(standing(LineKind::Digital, outputs().map(|output| line(output).unwrap_or(LineKind::Digital))));
    if line.iter().any(|span| span.2 == LineKind::Analog) {
        let bars = line.into_iter().map(|(from, to, line)| {
            let tone = if line == LineKind::Digital { Tone::Signal } else { Tone::Blank };
            Mark::Bar { from, to, tone, texts: vec![line.name().to_owned()] }
        });
        lanes.push(lane("line", false, 26, bars.collect()));
    }
    let tick = |at: u64, used: bool, hint: String| {
        let (tone, done) = if used { (Tone::Signal, "used") } else { (Tone::Dropped, "not used") };
        Mark::Tick { from: at, to: at + 1, tone, hint: format!("{hint}, {done}") }
    };
    let (mut mains, mut subs) = (Vec::new(), Vec::new());
    for ((cycle, (main_used, sub_used)), at) in cycles.iter().zip(uses(cycles)).zip(0..) {
        if let Some(main) = cycle.step.main {
            mains.push(tick(at, main_used, format!("main {} of section {}", main.counter, main.section)));
        }
        if let Some(sub) = cycle.step.sub {
            subs.push(tick(at, sub_used, format!("sub {} of section {}", sub.counter, sub.section)));
        }
    }
    for (label, ticks) in [("main telegrams", mains), ("sub telegrams", subs)] {
        if !ticks.is_empty() {
            lanes.push(lane(label, false, 24, ticks));
        }
    }
    let to_stop = |output: &Output| output.state.as_ref().and_then(|state| state.to_stop_m).map(metres);
    let farthest = outputs().filter_map(to_stop).fold(0.0, f64::max);
    if farthest > 0.0 {
        let scale = Scale { bottom: 0.0, top: farthest * 1.1 };
        lanes.push(lane(
            "to stop, m",
            true,
            90,
            vec![curve(changes(standing(None, outputs().map(to_stop))), Tone::Limit, scale)],
        ));
    }
    lanes
}

fn line(output: &Output) -> Option<LineKind> {
    output.state.as_ref().map(|state| state.line)
}

/// Speeds over distance: the distance is what `moved_m` adds up to.
fn figure(config: &Config, cycles: &[Cycle<Permitting>]) -> Figure {
    let digital = cycles.iter().any(|cycle| cycle.step.main.is_some());
    let train = if digital { "new train" } else { "conventional train" };
    let mut figure = Figure::default();
    let (mut permitted, mut actual, mut subs) = (Vec::new(), Vec::new(), Vec::new());
    let mut at = Metres(0);
    for (cycle, (main_used, sub_used)) in cycles.iter().zip(uses(cycles)) {
        at = Metres(at.0.saturating_add(cycle.step.moved_m.0));
        let here = metres(at);
        // The last output stands until here, and this one from here on.
        let before = permitted.last().copied().flatten().map(|(_, speed)| (here, speed));
        permitted.push(before);
        permitted.push(cycle.output.speed_km_h.map(|speed| (here, km_h(speed))));
        actual.push(cycle.step.speed_km_h.map(|speed| (here, km_h(speed))));
        if let (Some(main), Some(to_exit)) = (cycle.step.main.and_then(|main| main.kernel().ok()), cycle.step.to_exit_m)
        {
            let exit = here + metres(to_exit);
            let stop = (exit + f64::from(main.route.beyond_exit().0)).round();
            if main_used && figure.places.iter().all(|place| (place.0 - stop).abs() >= 2.0) {
                let what = if main.route == Route::Closed { "route closed" } else { "stopping point" };
                figure.places.push((stop, what.to_owned()));
            }
            let name = format!("section {}", main.section.0);
            let length = cycles.iter().find_map(|cycle| {
                cycle.step.sub.filter(|sub| sub.section == u32::from(main.section.0)).map(|sub| f64::from(sub.length_m))
            });
            if let (Some(length), None) = (length, figure.spans.iter().find(|span| span.2 == name)) {
                figure.spans.push((exit - length, exit, name));
            }
        }
        if let (Some(sub), true) = (cycle.step.sub, sub_used) {
            let name = format!("sub telegram of section {}", sub.section);
            if !subs.iter().any(|(_, known, _)| *known == name) {
                subs.push((here, name, 0));
            }
        }
    }
    let speed = |label: &str, stroke, points| Curve { label: format!("{train}, {label}"), case: 0, stroke, points };
    if actual.iter().any(Option::is_some) {
        figure.curves.push(speed("speed", Stroke::Full, actual));
    }
    figure.curves.push(speed("permitted", Stroke::Broken, permitted));
    figure.arrivals = subs;
    if digital {
        figure.notes = vec![
            format!(
                "Brake {} mm/s² on the level, margin {} m before a stopping point. The new train follows codes and telegrams, the conventional one codes alone.",
                config.brake_mm_s2, config.margin_m
            ),
            format!(
                "Until the sub telegram of a section is used the worst is assumed: gradient {} ‰, limit {} km/h.",
                config.worst_gradient_permille, config.lowest_limit_km_h
            ),
        ];
    }
    figure
}

fn signals(cycles: &[Cycle<Permitting>]) -> Vec<Signal> {
    let outputs = || cycles.iter().map(|cycle| &cycle.output);
    let real = |name: &str, values| Signal { name: name.to_owned(), values: Values::Real(values) };
    let read = |name, value: fn(&Cycle<Permitting>) -> Option<f64>| real(name, changes(cycles.iter().map(value)));
    let wire = |name: &str, value: fn(&Cycle<Permitting>) -> bool| Signal {
        name: name.to_owned(),
        values: Values::Wire(changes(cycles.iter().map(value))),
    };
    let used = uses(cycles);
    let mut all = vec![
        read("analog_km_h", |cycle| cycle.step.analog_km_h.map(km_h)),
        read("to_exit_m", |cycle| cycle.step.to_exit_m.map(metres)),
        wire("main", |cycle| cycle.step.main.is_some()),
        Signal { name: "main_used".to_owned(), values: Values::Wire(changes(used.iter().map(|used| used.0))) },
        wire("sub", |cycle| cycle.step.sub.is_some()),
        Signal { name: "sub_used".to_owned(), values: Values::Wire(changes(used.iter().map(|used| used.1))) },
        real("permitted_km_h", changes(standing(None, outputs().map(|output| output.speed_km_h.map(km_h))))),
        real(
            "to_stop_m",
            changes(standing(None, outputs().map(|output| output.state.as_ref()?.to_stop_m.map(metres)))),
        ),
        Signal {
            name: "basis".to_owned(),
            values: Values::State(changes(standing(
                "nothing".to_owned(),
                outputs().map(|output| output.basis.name().to_owned()),
            ))),
        },
    ];
    if cycles.iter().any(|cycle| cycle.step.speed_km_h.is_some()) {
        all.push(read("speed_km_h", |cycle| cycle.step.speed_km_h.map(km_h)));
    }
    all
}
