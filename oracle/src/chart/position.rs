//! The timing chart of the train's position: the interval as a band, the truth if it is given, its width, and the levels.

use super::record;
use super::scene::{Lane, Mark, Scale, Scene, Signal, Tone, Unit, Values};
use super::series::{changes, metres, spans, standing};
use crate::drawn::machine::Drawn;
use crate::trace::run::Cycle;
use atc_protocol::decimal::{Decibels, Metres};
use atc_protocol::machine::Machine;
use atc_protocol::machine::position::{Config, Output, Positioned};

/// An interval in metres.
type Ends = Option<(f64, f64)>;

#[expect(clippy::cast_precision_loss, reason = "levels have 16 bits")]
fn decibels(level: Decibels) -> f64 {
    level.0 as f64 / 100.0
}

fn ends(output: Output) -> Ends {
    output.interval_m.map(|[nearest, farthest]| (metres(nearest), metres(farthest)))
}

impl Drawn for Positioned {
    fn chart(config: &Config, cycles: &[Cycle<Self>]) -> Scene {
        scene(config, cycles)
    }
}

/// Lays out a case.
fn scene(config: &Config, cycles: &[Cycle<Positioned>]) -> Scene {
    let intervals: Vec<_> = cycles.iter().map(|cycle| ends(cycle.output)).collect();
    let truths: Vec<_> = cycles.iter().map(|cycle| cycle.step.truth_m.map(metres)).collect();
    let widths: Vec<_> =
        intervals.iter().map(|interval| interval.map(|(nearest, farthest)| farthest - nearest)).collect();
    let outside = intervals.iter().zip(&truths).filter(|(interval, truth)| match (interval, truth) {
        (Some((nearest, farthest)), Some(truth)) => truth < nearest || farthest < truth,
        _ => false,
    });
    let outside = outside.count();
    let mut notes = vec![format!(
        "Levels measured to ±{} dB, noise floor {} dB, {} dB to {} dB added; table over {} m. Levels are drawn over the cycle in which they were measured; all else stands from the end of the cycle on.",
        config.tolerance_db,
        config.floor_db,
        config.correction_db[0],
        config.correction_db[1],
        Metres(config.table.spacing_m.0 * 16),
    )];
    if truths.iter().any(Option::is_some) {
        notes.push(match outside {
            0 => "The truth is in the interval whenever there is one.".to_owned(),
            count => format!("THE TRUTH IS OUTSIDE THE INTERVAL IN {count} CYCLES: a level was off by more than the tolerance, or the table or a movement was wrong."),
        });
    }
    let mut scene = Scene {
        notes,
        lanes: lanes(cycles, &intervals, &truths, &widths),
        legend: vec![
            (Tone::Detected, "interval"),
            (Tone::Signal, "truth; second level"),
            (Tone::Limit, "width; first level"),
            (Tone::Dropped, "unknown"),
        ],
        signals: signals(cycles, &intervals, &truths),
        ..Scene::of(Positioned::NAME, Unit { axis: "time", name: "cycles", per_cycle: 1 }, cycles.len() as u64)
    };
    let said = cycles.iter().map(|cycle| cycle.recorded.filter(|said| *said != cycle.output));
    let texts = said.map(|said| {
        said.map(|said| match said.interval_m {
            None => "unknown".to_owned(),
            Some([nearest, farthest]) => format!("{nearest} to {farthest} m"),
        })
    });
    record::differences(&mut scene, 1, texts);
    scene
}

fn lanes(
    cycles: &[Cycle<Positioned>],
    intervals: &[Ends],
    truths: &[Option<f64>],
    widths: &[Option<f64>],
) -> Vec<Lane> {
    let farthest = intervals.iter().flatten().map(|ends| ends.1).chain(truths.iter().flatten().copied());
    let scale = Scale { bottom: 0.0, top: farthest.fold(10.0, f64::max) * 1.05 };
    let mut place =
        vec![Mark::Band { points: changes(standing(None, intervals.iter().copied())), tone: Tone::Detected, scale }];
    if truths.iter().any(Option::is_some) {
        place.push(Mark::Curve { points: changes(standing(None, truths.iter().copied())), tone: Tone::Signal, scale });
    }
    let width = Scale { bottom: 0.0, top: widths.iter().flatten().copied().fold(5.0, f64::max) * 1.1 };
    let width =
        Mark::Curve { points: changes(standing(None, widths.iter().copied())), tone: Tone::Limit, scale: width };
    let levels = [|cycle: &Cycle<Positioned>| cycle.step.first_db, |cycle: &Cycle<Positioned>| cycle.step.second_db];
    let heard = levels.iter().flat_map(|level| cycles.iter().filter_map(level)).map(decibels);
    let (least, most) = heard.fold((f64::MAX, f64::MIN), |(least, most), level| (least.min(level), most.max(level)));
    let scale =
        if least <= most { Scale { bottom: least - 2.0, top: most + 2.0 } } else { Scale { bottom: -1.0, top: 0.0 } };
    let levels = levels.into_iter().zip([Tone::Limit, Tone::Signal]).map(|(level, tone)| {
        let points = changes(cycles.iter().map(level)).into_iter().map(|(at, level)| (at, level.map(decibels)));
        Mark::Curve { points: points.collect(), tone, scale }
    });
    let unknown = spans(standing(true, intervals.iter().map(Option::is_none)));
    let unknown = unknown.into_iter().filter(|span| span.2).map(|(from, to, _)| Mark::Bar {
        from,
        to,
        tone: Tone::Dropped,
        texts: vec!["unknown".to_owned(), "?".to_owned()],
    });
    let lane = |label: &str, height, marks| Lane { label: label.to_owned(), first: true, height, marks };
    vec![
        lane("distance, m", 260, place),
        lane("position", 26, unknown.collect()),
        lane("width, m", 100, vec![width]),
        lane("levels, dB", 120, levels.collect()),
    ]
}

fn signals(cycles: &[Cycle<Positioned>], intervals: &[Ends], truths: &[Option<f64>]) -> Vec<Signal> {
    let real = |name: &str, values| Signal { name: name.to_owned(), values: Values::Real(values) };
    let level = |name, level: fn(&Cycle<Positioned>) -> Option<Decibels>| {
        let levels = changes(cycles.iter().map(level)).into_iter();
        real(name, levels.map(|(at, level)| (at, level.map(decibels))).collect())
    };
    let mut all = vec![
        level("first_db", |cycle| cycle.step.first_db),
        level("second_db", |cycle| cycle.step.second_db),
        real("nearest_m", changes(standing(None, intervals.iter().map(|ends| ends.map(|ends| ends.0))))),
        real("farthest_m", changes(standing(None, intervals.iter().map(|ends| ends.map(|ends| ends.1))))),
    ];
    if truths.iter().any(Option::is_some) {
        all.push(real("truth_m", changes(standing(None, truths.iter().copied()))));
    }
    all
}
