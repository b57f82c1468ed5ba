//! The timing chart of the on-board device: what is displayed, permitted and measured as curves, the brake below.

use super::scene::{Lane, Mark, Scene, Signal, Tone, Unit, Values};
use super::series::{changes, spans};
use super::supervision::{brake_lane, brake_signal, numbers, speed_lane};
use crate::drawn::machine::Drawn;
use crate::trace::run::Cycle;
use atc_protocol::kmh::Kmh;
use atc_protocol::machine::Machine;
use atc_protocol::machine::train::{Config, OnBoard, Step};
use atc_protocol::names::Named;

impl Drawn for OnBoard {
    fn chart(config: &Config, cycles: &[Cycle<Self>]) -> Scene {
        scene(config, cycles)
    }
}

/// Lays out a case.
fn scene(config: &Config, cycles: &[Cycle<OnBoard>]) -> Scene {
    let end = cycles.len() as u64;
    let measured: Vec<_> = cycles.iter().map(|cycle| cycle.step.speed_km_h).collect();
    // What stands from the end of a cycle on is drawn over the next one.
    let shown = |speed: fn(&Cycle<OnBoard>) -> Option<Kmh>| -> Vec<_> {
        std::iter::once(None).chain(cycles.iter().map(speed)).take(cycles.len()).collect()
    };
    let permitted = shown(|cycle| cycle.output.permitted_km_h);
    let display = shown(|cycle| cycle.output.display_km_h);
    let brakes: Vec<_> = cycles.iter().map(|cycle| cycle.output.brake).collect();
    let mut scene = Scene {
        notes: vec![
            "Codes and telegrams are drawn over the cycle in which they were received; what is displayed, permitted and commanded stands from the end of the cycle on.".to_owned(),
        ],
        lanes: vec![
            received("codes", Tone::Signal, cycles, |step| step.main.code_hz.is_some() && step.sub.code_hz.is_some()),
            received("main telegrams", Tone::Limit, cycles, |step| step.main.telegram.is_some() || step.main.frame.is_some()),
            received("sub telegrams", Tone::Limit, cycles, |step| step.sub.telegram.is_some() || step.sub.frame.is_some()),
            facing_lane(cycles),
            speed_lane(&measured, &permitted),
            display_lane(&display),
            brake_lane("brake", &brakes, &brakes),
        ],
        guides: changes(&brakes).into_iter().skip(1).map(|(at, _)| at + 1).collect(),
        legend: vec![
            (Tone::Signal, "measured speed, codes"),
            (Tone::Limit, "permitted, telegrams"),
            (Tone::Service, "service brake"),
            (Tone::Emergency, "emergency brake"),
        ],
        signals: vec![
            Signal { name: "speed_km_h".to_owned(), values: Values::Real(numbers(&measured)) },
            Signal { name: "permitted_km_h".to_owned(), values: Values::Real(numbers(&permitted)) },
            Signal { name: "display_km_h".to_owned(), values: Values::Real(numbers(&display)) },
            brake_signal("brake", &brakes),
        ],
        ..Scene::of(OnBoard::NAME, Unit { axis: "time", name: "ms", per_cycle: config.permitted.cycle_ms }, end)
    };
    let differ = spans(cycles.iter().map(|cycle| cycle.recorded.is_some_and(|said| said != cycle.output)));
    scene.differences = differ.into_iter().filter(|span| span.2).map(|(from, to, _)| (from + 1, to + 1)).collect();
    if let Some((from, _)) = scene.differences.first() {
        scene.notes.push(format!("THE RECORD DIFFERS FROM THE KERNEL, first after cycle {}.", from - 1));
        scene.legend.push((Tone::Difference, "differs from the kernel"));
    }
    scene
}

/// The cycles in which something is received.
fn received(label: &str, tone: Tone, cycles: &[Cycle<OnBoard>], there: fn(&Step) -> bool) -> Lane {
    let marks = spans(cycles.iter().map(|cycle| there(&cycle.step))).into_iter().filter(|span| span.2);
    let marks = marks.map(|(from, to, _)| Mark::Bar { from, to, tone, texts: Vec::new() });
    Lane { label: label.to_owned(), first: false, height: 26, marks: marks.collect() }
}

/// Which way the train faces.
fn facing_lane(cycles: &[Cycle<OnBoard>]) -> Lane {
    let marks = spans(cycles.iter().map(|cycle| cycle.step.facing)).into_iter().map(|(from, to, facing)| {
        let text = facing.map_or("not known", Named::name);
        let tone = if facing.is_some() { Tone::Limit } else { Tone::Blank };
        Mark::Bar { from, to, tone, texts: vec![text.to_owned()] }
    });
    Lane { label: "faces".to_owned(), first: false, height: 26, marks: marks.collect() }
}

/// What is displayed.
fn display_lane(display: &[Option<Kmh>]) -> Lane {
    let marks = spans(display.iter().copied()).into_iter().map(|(from, to, speed)| {
        let text = speed.map_or_else(|| "nothing".to_owned(), |speed| speed.to_string());
        let tone = if speed.is_some() { Tone::Signal } else { Tone::Blank };
        Mark::Bar { from, to, tone, texts: vec![text] }
    });
    Lane { label: "display, km/h".to_owned(), first: true, height: 34, marks: marks.collect() }
}
