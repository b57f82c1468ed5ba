//! The link budget of a line's train control signal: what is left of it at the far end of each section, against what
//! telegrams and codes need. What the receiver needs is measured here and now, with the receiver of `atc-waveform`; the
//! rest is its line theory.

mod bench;
mod picture;
mod report;
mod words;

use atc_line::Line;
use atc_waveform::config::Carrier;
use atc_waveform::measure::{BitErrorRun, FramePoint, FrameRun, bit_errors, frames, latency};
use atc_waveform::units::{Decibels, Hertz};

use bench::{Bench, SEED, exact};

pub use report::{BudgetReport, Link, Parameter, SectionMargin};

/// Offsets of a carrier that are tried, Hz.
const OFFSETS: [f64; 8] = [0.0, 0.5, 1.0, 1.5, 1.75, 2.0, 2.5, 3.0];
/// A carrier that is off may cost so many of the telegrams, and still counts as heard.
const LOST_BY_OFFSET: f64 = 0.05;
/// Frames on each carrier for an offset, and for a ratio.
const FRAMES: [u32; 2] = [15, 60];
/// The ratio at which the loss of the receiver is measured: there are errors enough.
const LOSS_AT: Decibels = Decibels(8.0);

/// Makes the budget of a line.
///
/// # Errors
/// Why the line has none, in a sentence.
pub fn budget(line: &Line) -> Result<BudgetReport, String> {
    let bench = Bench::new(line)?;
    let mut sections = sections(line);
    sections.sort_by(|a, b| b.1.total_cmp(&a.1));
    let Some((longest, longest_m)) = sections.first().cloned() else {
        return Err(
            "the line has neither a [[section]] nor a [[block]]: nothing says how far the signal must reach".into()
        );
    };
    let get = |name| line.budget().get(name);
    let (lost, offset) = (get("lost_part"), get("carrier_offset_hz"));
    let slow = bench.codes(false)?;
    let run = BitErrorRun {
        codes: slow,
        offset: Hertz(offset),
        errors: 200,
        least_bits: 8000,
        most_bits: 16_000,
        seed: SEED,
    };
    let loss = bit_errors(&bench.config, &run, LOSS_AT).loss_db.unwrap_or(30.0).max(0.0);
    let codes_needed = bench.codes_needed(lost)?;
    let links = [Carrier::Main, Carrier::Sub].map(|carrier| bench.link(carrier, longest_m, lost, loss, codes_needed));
    let needed = links.iter().map(|link| link.needed_db).fold(f64::MIN, f64::max);
    let measure = |count, offset: f64, ratio: f64| {
        let run = FrameRun { codes: slow, offset: Hertz(offset), frames: count, seed: SEED };
        frames(&bench.config, &bench.table, &run, Decibels(ratio))
    };
    let offsets: Vec<FramePoint> =
        OFFSETS.iter().map(|&offset| measure(FRAMES[0], offset, (needed + 10.0).min(60.0))).collect();
    let heard = offsets.iter().take_while(|point| point.lost() <= LOST_BY_OFFSET).last();
    let offset_heard = heard.map_or(0.0, |point| point.offset_hz);
    let around = [-9.0, -6.0, -3.0].map(|less| measure(FRAMES[1], offset, needed + less)).to_vec();
    let latency_ms = latency(&bench.config, &bench.table).map_or(f64::INFINITY, |late| late.0 * 1000.0);
    let mut report = BudgetReport {
        line: line.name().to_owned(),
        parameters: line.budget().values.iter().map(Parameter::from).collect(),
        longest,
        longest_m,
        bit_rate_hz: bench.config.bit_rate().0,
        links,
        codes_needed_db: codes_needed,
        at_needed: measure(FRAMES[1], offset, needed),
        around,
        offsets,
        offset_heard_hz: offset_heard,
        latency_ms,
        delay_ms: line.signal().map_or(0, atc_line::signal::Signal::delay_ms),
        sections: Vec::new(),
        broken: Vec::new(),
    };
    let least = get("least_margin_db");
    report.sections = sections.into_iter().map(|one| bench.margin(one, longest_m, &report.links, least)).collect();
    report.broken = broken(&report, least, offset);
    Ok(report)
}

/// Every section with its length.
fn sections(line: &Line) -> Vec<(String, f64)> {
    let described = line.sections().into_iter().map(|one| (format!("section {}", one.number), f64::from(one.length_m)));
    let counted = line.blocks().into_iter().enumerate().flat_map(|(block, one)| {
        let name = move |place| format!("section {} of block {}", place + 1, block + 1);
        one.sections_m.into_iter().enumerate().map(move |(place, length)| (name(place), f64::from(length)))
    });
    described.chain(counted).collect()
}

fn broken(report: &BudgetReport, least: f64, offset: f64) -> Vec<String> {
    let mut all = Vec::new();
    for one in report.sections.iter().filter(|one| !one.enough) {
        all.push(format!(
            "{} ({} m): at its far end the margin is {:.1} dB for telegrams and {:.1} dB for codes; each must be {least} dB or more",
            one.section, one.length_m, one.telegram_margin_db, one.code_margin_db
        ));
    }
    if report.offset_heard_hz < offset {
        all.push(format!(
            "budget.carrier_offset_hz is {offset} Hz, and telegrams are heard up to {} Hz: carriers must be nearer",
            report.offset_heard_hz
        ));
    }
    if report.delay_ms > 0 && report.latency_ms > exact(report.delay_ms) {
        all.push(format!(
            "signal.delay_ms is {}, and the receiver alone takes {:.1} ms; it must be that or more, and the way to the logic",
            report.delay_ms, report.latency_ms
        ));
    }
    all
}
