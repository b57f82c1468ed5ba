//! The figures that the case shows, from what was measured.

use super::bench::{Bench, Detection, METER_FROM_DB, Run};
use super::target::id;
use crate::case::Figure;
use crate::sources::models::thousands;

const BITS: &str = "Bits";
const CODES: &str = "Codes and telegrams";
const NOISE: &str = "Noise alone";
/// The group of the figures that say how fast this machine is.
pub const SPEED: &str = "Throughput";
const LEVELS: &str = "Levels";
const POSITION: &str = "Position inside the limits of its table";
const OUTSIDE: &str = "Position outside the limits of its table";

/// The largest loss against theory, in decibels.
const MOST_LOSS_DB: f64 = 1.0;
/// The tolerance of a level in the measured positions, in decibels.
const TOLERANCE_DB: f64 = 0.1;
#[allow(clippy::cast_precision_loss)]
fn count(number: u64) -> f64 {
    number as f64
}

fn many(number: u64) -> String {
    usize::try_from(number).map_or_else(|_| number.to_string(), thousands)
}

/// A value with its unit, to two or three digits; what is less than a millionth of a millionth is 0.
pub fn shown(value: Option<f64>, unit: &str) -> String {
    let Some(value) = value else { return "not known".to_owned() };
    let size = value.abs();
    let number = if size < 1e-12 {
        "0".to_owned()
    } else if size < 0.009_95 {
        let exponent = size.log10().floor();
        format!("{:.1} · 10{}", value / 10_f64.powf(exponent), raised(exponent))
    } else if size >= 99.95 || value.fract() == 0.0 {
        format!("{value:.0}")
    } else if size >= 9.995 {
        format!("{value:.1}")
    } else if size >= 0.0995 {
        format!("{value:.2}")
    } else {
        format!("{value:.3}")
    };
    if unit.is_empty() { number } else { format!("{number} {unit}") }
}

/// A negative exponent as it is written above the line.
fn raised(exponent: f64) -> String {
    let digit = |digit| match digit {
        '-' => '⁻',
        '0' => '⁰',
        '1' => '¹',
        '2' => '²',
        '3' => '³',
        '4' => '⁴',
        '5' => '⁵',
        '6' => '⁶',
        '7' => '⁷',
        '8' => '⁸',
        '9' => '⁹',
        other => other,
    };
    format!("{exponent:.0}").chars().map(digit).collect()
}

pub(super) fn figure(group: &str, name: String, value: Option<f64>, unit: &str, of: String) -> Figure {
    Figure { group: group.to_owned(), name, value, unit: unit.to_owned(), of, ..Figure::default() }
}

pub(super) fn aimed(figure: Figure, at_most: f64, target: &str) -> Figure {
    Figure { at_most: Some(at_most), evidence: Some(id(target)), ..figure }
}

/// All figures, group by group.
pub fn all(bench: &Bench) -> Vec<Figure> {
    let mut all = bits(bench);
    all.extend(heard(bench));
    all.extend(noise(bench));
    all.extend(levels(bench));
    all.extend(inside(bench));
    all.extend(outside(bench));
    all.extend(speed(bench));
    all
}

fn bits(bench: &Bench) -> Vec<Figure> {
    let mut all = Vec::new();
    for curve in &bench.signal.bit_errors {
        let points: Vec<_> = curve.judged().collect();
        let worst = points.iter().filter_map(|point| point.loss_db).reduce(f64::max);
        let of = format!("{} ratios, {} bits", points.len(), many(points.iter().map(|point| point.bits).sum()));
        let loss = figure(BITS, format!("Greatest loss against theory: {}", curve.name), worst, "dB", of);
        all.push(aimed(loss, MOST_LOSS_DB, curve.target()));
        // The lowest rate that was seen often enough.
        if let Some(point) = points.last() {
            let name = format!("Bit error rate at {} dB: {}", point.eb_n0_db, curve.name);
            let of = format!("{} errors in {} bits", many(point.errors), many(point.bits));
            all.push(Figure { theory: Some(point.theory), ..figure(BITS, name, Some(point.rate), "", of) });
        }
    }
    all
}

fn heard(bench: &Bench) -> Vec<Figure> {
    let all = &bench.signal.detection;
    let trials: u64 = all.iter().map(|one| one.trials).sum();
    let ratio = |one: &Detection| shown(Some(one.snr_db), "").replace('-', "−");
    let ratios = match (all.first(), all.last()) {
        (Some(first), Some(last)) => format!("{} to {} dB", ratio(first), ratio(last)),
        _ => "no ratio".to_owned(),
    };
    let of = format!("{} beginnings of a signal, {ratios} of signal over noise", many(trials));
    let sum = |number: fn(&Detection) -> u64| Some(count(all.iter().map(number).sum()));
    let wrong = |name: &str, value, target| aimed(figure(CODES, name.to_owned(), value, "", of.clone()), 0.0, target);
    let mut figures = vec![
        wrong("Telegrams that were never sent", sum(|one| one.wrong_telegrams), "wrong-telegrams"),
        wrong("Speeds that were never sent", sum(|one| one.wrong_speeds), "wrong-speeds"),
    ];
    if let Some(one) = all.iter().find(|one| one.snr_db >= 10.0) {
        let of = format!("{} trials at {} dB; shown only", one.trials, one.snr_db);
        for (name, times) in [("right speed", &one.code), ("right main telegram", &one.main_telegram)] {
            figures.push(figure(CODES, format!("Time to the first {name}, median"), times.median, "s", of.clone()));
        }
    }
    let first = all.iter().find(|one| one.main_telegram.heard > 0.99).map(|one| one.snr_db);
    let name = "Least signal over noise at which every main telegram was heard within 4 s".to_owned();
    figures.push(figure(CODES, name, first, "dB", "steps of 2 dB; shown only".to_owned()));
    figures
}

fn noise(bench: &Bench) -> Vec<Figure> {
    let noise = &bench.signal.false_codes;
    let of =
        format!("{} windows, as long as {} that do not overlap", many(noise.windows), many(noise.disjoint_windows));
    let speeds = figure(NOISE, "Speeds heard".to_owned(), Some(count(noise.speeds)), "", of.clone());
    let name = if noise.codes == 0 { "Rate of codes a window: below (95 %)" } else { "Rate of codes a window" };
    vec![aimed(speeds, 0.0, "false-codes"), figure(NOISE, name.to_owned(), Some(noise.code_rate), "", of)]
}

fn levels(bench: &Bench) -> Vec<Figure> {
    let points: Vec<_> = bench.metered().collect();
    let greatest = points.iter().map(|point| point.greatest_db).reduce(f64::max);
    let windows = points.iter().map(|point| point.windows).sum();
    let of = format!("{} windows of samples, {METER_FROM_DB} dB of signal over noise and more", many(windows));
    let name = "Greatest error of a level".to_owned();
    let mut figures = vec![aimed(figure(LEVELS, name, greatest, "dB", of), TOLERANCE_DB, "level-tolerance")];
    for point in &bench.position.meter {
        let name = format!("Standard deviation of a level at {} dB", point.signal_to_noise_db);
        let of = format!("{} windows; greatest error {}", many(point.windows), shown(Some(point.greatest_db), "dB"));
        let deviation = figure(LEVELS, name, Some(point.deviation_db), "dB", of);
        figures.push(Figure { theory: Some(point.expected_db), ..deviation });
    }
    for one in &bench.position.reflections {
        let name = format!("Change of the level difference by reflections: {}", one.line);
        figures.push(figure(LEVELS, name, Some(one.greatest_db), "dB", "0 to 400 m; shown only".to_owned()));
    }
    figures
}

/// The greatest part of cycles with an interval without the train.
fn wrong(name: String, runs: &[&Run], target: &str) -> Figure {
    let cycles: usize = runs.iter().map(|run| run.points.len()).sum();
    let worst = runs.iter().map(|run| 100.0 * run.wrong).reduce(f64::max);
    let of = format!("{} runs, {} cycles", runs.len(), thousands(cycles));
    aimed(figure(POSITION, name, worst, "%", of), 0.0, target)
}

fn inside(bench: &Bench) -> Vec<Figure> {
    let mut figures = Vec::new();
    let name = |what: &str| format!("Cycles with an interval without the train: {what}");
    for arrangement in arrangements(&bench.position.runs) {
        let runs: Vec<_> = bench.position.runs.iter().filter(|run| run.arrangement == arrangement).collect();
        figures.push(wrong(name(&format!("arrangement {arrangement}")), &runs, "position-inside"));
        for run in runs.iter().filter(|run| run.odometer == "with") {
            let name = format!("Mean width of the interval: arrangement {arrangement}, {} Ω·km", run.ohm_km);
            let of = format!("with the odometer; an interval in {:.0} % of the cycles", 100.0 * run.answered);
            figures.push(figure(POSITION, name, Some(run.mean_width), "m", of));
        }
    }
    let runs: Vec<_> = bench.position.from_samples.iter().collect();
    figures.push(wrong(name("levels measured from samples"), &runs, "position-samples"));
    figures
}

fn arrangements(runs: &[Run]) -> Vec<char> {
    let mut found: Vec<char> = runs.iter().map(|run| run.arrangement).collect();
    found.sort_unstable();
    found.dedup();
    found
}

fn outside(bench: &Bench) -> Vec<Figure> {
    let mut figures = Vec::new();
    for arrangement in arrangements(&bench.position.runs) {
        let runs: Vec<_> = bench.position.outside.iter().filter(|run| run.arrangement == arrangement).collect();
        let off: Vec<_> = runs.iter().filter(|run| run.wrong > 0.0).collect();
        let least = off.iter().map(|run| 100.0 * run.wrong).reduce(f64::min);
        let most = off.iter().map(|run| 100.0 * run.wrong).reduce(f64::max);
        let places: Vec<_> = off.iter().map(|run| run.ohm_km.to_string()).collect();
        let ends = match (places.first(), places.last()) {
            (Some(first), Some(last)) => {
                format!("{} of {} kinds of ballast, {first} to {last} Ω·km", off.len(), runs.len())
            }
            _ => format!("none of {} kinds of ballast", runs.len()),
        };
        let of = format!("a table that is too narrow; {ends}; shown only");
        for (word, value) in [("least", least), ("most", most)] {
            let name = format!(
                "Cycles with an interval without the train, where there are any, at {word}: arrangement {arrangement}"
            );
            figures.push(figure(OUTSIDE, name, value.or(Some(0.0)), "%", of.clone()));
        }
    }
    figures
}

fn speed(bench: &Bench) -> Vec<Figure> {
    let speed = &bench.signal.throughput;
    [
        ("conventional receiver", speed.conventional),
        ("receiver of codes and telegrams", speed.on_board),
        ("track circuit receiver", speed.track_circuit),
    ]
    .map(|(name, value)| {
        let of = "on one core of this machine; shown only".to_owned();
        figure(SPEED, format!("Signal that the {name} handles in a second"), Some(value), "s", of)
    })
    .into()
}

/// Name and value of what the run was of.
pub fn conditions(bench: &Bench) -> Vec<(String, String)> {
    let pair = |name: &str, value: String| (name.to_owned(), value);
    vec![
        pair("receiver of bits", bench.signal.receiver.clone()),
        pair("extent and seed", format!("{}, seed {}", bench.signal.extent, bench.signal.seed)),
        pair("position", bench.position.conditions.clone()),
    ]
}

/// What a plot shows.
pub fn caption(name: &str) -> String {
    let known = match name {
        "bit-errors" => "Bit error rate over Eb/N0 without codes, beside theory for this kind of receiver.",
        "bit-errors-under-code" => "The same under the codes' amplitude modulation; theory averaged over the envelope.",
        "detection" => "Time from the start of a signal to the first right speed and to the first right main telegram.",
        "spectrum" => "Spectrum of the standard signal: two carriers, each with its telegrams and its code.",
        "envelope" => "Envelope of the carriers: what a conventional train hears.",
        "position-attenuation" => "Attenuation at both frequencies and their difference over distance, wet to dry.",
        "position-width" => "Width of the interval over distance, by weather.",
        "position-error" => "Distance of the train from the middle of its interval.",
        "position-outside" => {
            "A table for 5 to 20 Ω·km on other ballast: outside its limits nearly every interval is without the train."
        }
        "position-meter" => "Error of the level meter over the ratio of signal to noise.",
        "position-run-a" => "A train through a section, one transmitter and two frequencies: interval and truth.",
        "position-run-b" => "The same with two transmitters ahead.",
        "position-run-c" => "The same with one transmitter ahead and one behind.",
        "shortened-operate" => {
            "A line with trains in motion: interruptions that brake a train needlessly, delay and margin against their length, \
             with the shortened operate time and without."
        }
        "position-run-from-samples" => "The same with levels measured from samples with noise.",
        other => other,
    };
    known.to_owned()
}
