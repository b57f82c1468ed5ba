//! The chart of the braking pattern: the answers over the distance, with the real curves beside them.

use super::figure::{Curve, Figure, Stroke};
use super::record;
use super::scene::{Lane, Mark, Scale, Scene, Signal, Tone, Unit, Values};
use super::series::changes;
use crate::drawn::machine::Drawn;
use crate::trace::run::Cycle;
use atc_line::refusal::{brake, gradient};
use atc_protocol::kmh::Kmh;
use atc_protocol::machine::Machine;
use atc_protocol::machine::pattern::{Braking, Config, Output};

impl Drawn for Braking {
    fn chart(config: &Config, cycles: &[Cycle<Self>]) -> Scene {
        scene(*config, cycles)
    }
}

/// Lays out a case.
fn scene(config: Config, cycles: &[Cycle<Braking>]) -> Scene {
    let km_h = |output: Output| f64::from(output.speed_km_h.0) / 10.0;
    let kernel: Vec<_> = cycles.iter().map(|cycle| cycle.output.speed_km_h).collect();
    let speeds = |speeds: &[Kmh]| -> Vec<(u64, Option<f64>)> {
        changes(speeds).into_iter().map(|(at, speed)| (at, Some(f64::from(speed.0) / 10.0))).collect()
    };
    let top = cycles.iter().map(|cycle| km_h(cycle.output)).fold(10.0, f64::max) * 1.1;
    let lane = |label: &str, values: &[Kmh], tone| Lane {
        label: label.to_owned(),
        first: true,
        height: 90,
        marks: vec![Mark::Curve { points: speeds(values), tone, scale: Scale { bottom: 0.0, top } }],
    };
    let distances = changes(cycles.iter().map(|cycle| cycle.step.distance_m));
    let gradients = changes(cycles.iter().map(|cycle| cycle.step.gradient_permille));
    let signal =
        |name: &str, values: Vec<(u64, Option<f64>)>| Signal { name: name.to_owned(), values: Values::Real(values) };
    let mut scene = Scene {
        notes: vec!["The answers in the order of the questions.".to_owned()],
        lanes: vec![lane("speed, km/h", &kernel, Tone::Limit)],
        legend: vec![(Tone::Limit, "speed from which the train stops in the distance")],
        signals: vec![
            signal("distance_m", distances.into_iter().map(|(at, metres)| (at, Some(f64::from(metres)))).collect()),
            signal(
                "gradient_permille",
                gradients.into_iter().map(|(at, slope)| (at, Some(f64::from(slope)))).collect(),
            ),
            signal("speed_km_h", speeds(&kernel)),
        ],
        figure: Some(figure(config, cycles)),
        ..Scene::of(Braking::NAME, Unit { axis: "time", name: "cycles", per_cycle: 1 }, cycles.len() as u64)
    };
    let said = cycles.iter().map(|cycle| cycle.recorded.filter(|said| *said != cycle.output));
    record::differences(&mut scene, 0, said.map(|said| said.map(|said| format!("{} km/h", said.speed_km_h))));
    scene
}

/// For each gradient the answers as dots and the real curve through them.
fn figure(config: Config, cycles: &[Cycle<Braking>]) -> Figure {
    let mut gradients: Vec<_> = cycles.iter().map(|cycle| cycle.step.gradient_permille).collect();
    gradients.sort_unstable();
    gradients.dedup();
    let mut figure = Figure {
        notes: vec![format!(
            "Brake {} mm/s² on the level. Dots are answers, in steps of 0.1 km/h; lines are the real curves, v² = 2·b·d, up to 409.5 km/h.",
            config.brake_mm_s2
        )],
        ..Figure::default()
    };
    let farthest = cycles.iter().map(|cycle| cycle.step.distance_m).max().unwrap_or(0);
    for (case, permille) in gradients.into_iter().enumerate() {
        let answers = cycles.iter().filter(|cycle| cycle.step.gradient_permille == permille);
        let dots =
            answers.map(|cycle| Some((f64::from(cycle.step.distance_m), f64::from(cycle.output.speed_km_h.0) / 10.0)));
        figure.curves.push(Curve {
            label: format!("answers at {permille} ‰"),
            case,
            stroke: Stroke::Dots,
            points: dots.collect(),
        });
        // A trace is laid out only after the kernel has taken its configuration and every step.
        let (Ok(brake), Ok(slope)) =
            (brake("brake_mm_s2", config.brake_mm_s2), gradient("gradient_permille", permille))
        else {
            continue;
        };
        let real = |place: u32| {
            // Closer together near the stop, where the curve is steep.
            let distance = f64::from(farthest) * (f64::from(place) / 200.0).powi(2);
            let speed = 3.6 * (2.0 * f64::from(brake.on(slope).mm_s2()) / 1000.0 * distance).sqrt();
            (speed <= 409.5).then_some((distance, speed))
        };
        let label = format!("real curve with {} mm/s²", brake.on(slope).mm_s2());
        figure.curves.push(Curve { label, case, stroke: Stroke::Thin, points: (0..=200).map(real).collect() });
    }
    figure
}
