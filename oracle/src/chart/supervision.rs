//! The timing chart of speed supervision: the two speeds as curves, the brake below. It counts no time, so the axis
//! is in logic cycles.

use super::scene::{Lane, Mark, Scale, Scene, Signal, Tone, Unit, Values};
use super::series::{changes, spans};
use crate::drawn::machine::Drawn;
use crate::trace::run::Cycle;
use atc_protocol::kmh::Kmh;
use atc_protocol::machine::Machine;
use atc_protocol::machine::supervision::{Brake, Config, Supervised};

impl Drawn for Supervised {
    fn chart(config: &Config, cycles: &[Cycle<Self>]) -> Scene {
        scene(config, cycles)
    }
}

/// Lays out a case.
fn scene(config: &Config, cycles: &[Cycle<Supervised>]) -> Scene {
    let end = cycles.len() as u64;
    let measured: Vec<_> = cycles.iter().map(|cycle| cycle.step.speed_km_h).collect();
    let permitted: Vec<_> = cycles.iter().map(|cycle| cycle.step.permitted_km_h).collect();
    let brakes: Vec<_> = cycles.iter().map(|cycle| cycle.output.brake).collect();
    let recorded: Vec<_> =
        cycles.iter().map(|cycle| cycle.recorded.map_or(cycle.output.brake, |said| said.brake)).collect();
    let mut scene = Scene {
        notes: vec![format!(
            "Highest plausible speed {} km/h, release margin {} km/h. A speed is drawn over the cycle in which it was read; the brake stands from the end of the cycle on.",
            config.maximum_km_h, config.release_margin_km_h
        )],
        lanes: vec![speed_lane(&measured, &permitted), brake_lane("brake", &brakes, &brakes)],
        guides: changes(&brakes).into_iter().skip(1).map(|(at, _)| at + 1).collect(),
        legend: vec![
            (Tone::Signal, "measured speed"),
            (Tone::Limit, "permitted speed"),
            (Tone::Service, "service brake"),
            (Tone::Emergency, "emergency brake"),
        ],
        signals: vec![
            Signal { name: "speed_km_h".to_owned(), values: Values::Real(numbers(&measured)) },
            Signal { name: "permitted_km_h".to_owned(), values: Values::Real(numbers(&permitted)) },
            brake_signal("brake", &brakes),
        ],
        ..Scene::of(Supervised::NAME, Unit { axis: "time", name: "cycles", per_cycle: 1 }, end)
    };
    let differ = spans(brakes.iter().zip(&recorded).map(|(kernel, said)| kernel != said));
    scene.differences = differ.into_iter().filter(|span| span.2).map(|(from, to, _)| (from + 1, to + 1)).collect();
    if let Some((from, _)) = scene.differences.first() {
        scene.notes.push(format!("THE RECORD DIFFERS FROM THE KERNEL, first after cycle {}.", from - 1));
        scene.lanes.push(brake_lane("brake as recorded", &recorded, &brakes));
        scene.signals.push(brake_signal("brake_as_recorded", &recorded));
        scene.legend.push((Tone::Difference, "differs from the kernel"));
    }
    scene
}

pub(super) fn numbers(speeds: &[Option<Kmh>]) -> Vec<(u64, Option<f64>)> {
    changes(speeds).into_iter().map(|(at, speed)| (at, speed.map(|speed| f64::from(speed.0) / 10.0))).collect()
}

pub(super) fn speed_lane(measured: &[Option<Kmh>], permitted: &[Option<Kmh>]) -> Lane {
    // A speed far beyond anything plausible would flatten the rest: it is drawn at the top.
    let plausible =
        measured.iter().chain(permitted).flatten().map(|speed| speed.0).filter(|tenths| (0..=6000).contains(tenths));
    let top = (f64::from(plausible.max().unwrap_or(0)) / 10.0 * 1.1).max(10.0);
    let scale = Scale { bottom: 0.0, top };
    let curve = |speeds: &[Option<Kmh>], tone| Mark::Curve { points: numbers(speeds), tone, scale };
    Lane {
        label: "speed, km/h".to_owned(),
        first: true,
        height: 170,
        marks: vec![curve(permitted, Tone::Limit), curve(measured, Tone::Signal)],
    }
}

/// What is commanded; where it is not what the kernel commands, that shows.
pub(super) fn brake_lane(label: &str, brakes: &[Brake], kernel: &[Brake]) -> Lane {
    let said = brakes.iter().zip(kernel).map(|(said, kernel)| (*said, said != kernel));
    let shown = std::iter::once((Brake::Emergency, false)).chain(said).take(brakes.len());
    let marks = spans(shown).into_iter().map(|(from, to, (brake, differs))| {
        let tone = match brake {
            _ if differs => Tone::Difference,
            Brake::Release => Tone::Blank,
            Brake::Service => Tone::Service,
            Brake::Emergency => Tone::Emergency,
        };
        let short = match brake {
            Brake::Release => "R",
            Brake::Service => "S",
            Brake::Emergency => "E",
        };
        Mark::Bar { from, to, tone, texts: vec![brake.name().to_owned(), short.to_owned()] }
    });
    Lane { label: label.to_owned(), first: true, height: 40, marks: marks.collect() }
}

pub(super) fn brake_signal(name: &str, brakes: &[Brake]) -> Signal {
    let shown = std::iter::once(Brake::Emergency).chain(brakes.iter().copied());
    let values = changes(shown).into_iter().map(|(at, brake)| (at, brake.name().to_owned())).collect();
    Signal { name: name.to_owned(), values: Values::State(values) }
}
