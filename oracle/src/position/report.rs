//! What a calibration found: the fit, which side of an error is dangerous, and what no measurement shows.

use std::fmt::Write as _;

use atc_line::position::Config;
use atc_protocol::{Decibels, Metres};
use atc_waveform::calibration::measured::{DEVIATIONS, Fit, Residuals, Side, Without};
use serde::Serialize;

use super::levels::Levels;

/// The report.
#[derive(Serialize)]
pub(super) struct Report {
    pub(super) file: String,
    pub(super) measurements: usize,
    pub(super) passes: Vec<PassReport>,
    pub(super) residuals: ResidualReport,
    /// Whose ends are the first and the last distance that the table covers.
    pub(super) range_m: [f64; 2],
    pub(super) spacing_m: Metres,
    pub(super) knots_covered: [usize; 2],
    /// Intervals end with the section.
    pub(super) ends_with_section: bool,
    pub(super) position: Config,
    pub(super) rails_otherwise: Vec<SideReport>,
    pub(super) dangerous: String,
    pub(super) to_look_at: Vec<String>,
    pub(super) not_checked: Vec<Condition>,
}

#[derive(Serialize)]
pub(super) struct PassReport {
    pub(super) name: String,
    pub(super) ballast_ohm_km: Option<f64>,
    pub(super) range_m: [f64; 2],
    pub(super) residuals: ResidualReport,
}

#[derive(Serialize)]
pub(super) struct ResidualReport {
    pub(super) used: usize,
    pub(super) rms_db: f64,
    pub(super) largest_db: f64,
    pub(super) at_m: f64,
    pub(super) line: u64,
}

#[derive(Serialize)]
pub(super) struct SideReport {
    pub(super) rise_percent: f64,
    pub(super) asked: u32,
    pub(super) answered: u32,
    pub(super) beyond: u32,
    pub(super) beyond_most_m: f64,
    pub(super) before: u32,
    pub(super) before_most_m: f64,
    pub(super) mean_width_m: f64,
}

/// A condition that no measurement shows to hold.
#[derive(Serialize)]
pub(super) struct Condition {
    pub(super) id: &'static str,
    pub(super) what: String,
}

pub(super) fn report(name: &str, levels: &Levels, fit: &Fit, position: Config, sides: &[Side]) -> Report {
    let residuals = |one: Residuals| {
        let pass = levels.passes.get(one.at.0);
        ResidualReport {
            used: one.count,
            rms_db: rounded(one.rms.0, 4),
            largest_db: rounded(one.largest.0, 4),
            at_m: pass.and_then(|pass| pass.measurements.get(one.at.1)).map_or(0.0, |measured| measured.distance.0),
            line: pass.and_then(|pass| pass.lines.get(one.at.1)).copied().unwrap_or(0),
        }
    };
    let passes = levels.passes.iter().enumerate().filter_map(|(number, pass)| {
        let distances = || pass.measurements.iter().map(|measured| measured.distance.0);
        Some(PassReport {
            name: pass.name.clone(),
            ballast_ohm_km: pass.ballast_ohm_km,
            range_m: [distances().fold(f64::INFINITY, f64::min), distances().fold(0.0, f64::max)],
            residuals: residuals(fit.residuals_of(number)?),
        })
    });
    let passes: Vec<_> = passes.collect();
    Report {
        file: name.to_owned(),
        measurements: levels.passes.iter().map(|pass| pass.measurements.len()).sum(),
        residuals: residuals(fit.residuals()),
        range_m: [fit.nearest().0, fit.to.0],
        spacing_m: position.table.spacing_m,
        knots_covered: [fit.first, fit.last],
        ends_with_section: fit.bounded,
        rails_otherwise: sides.iter().map(side).collect(),
        dangerous: dangerous(sides),
        to_look_at: notes(levels, fit, sides),
        not_checked: conditions(&passes, fit),
        position,
        passes,
    }
}

fn side(side: &Side) -> SideReport {
    SideReport {
        rise_percent: side.change_percent,
        asked: side.asked,
        answered: side.answered,
        beyond: side.beyond.count,
        beyond_most_m: rounded(side.beyond.most_m, 1),
        before: side.before.count,
        before_most_m: rounded(side.before.most_m, 1),
        mean_width_m: rounded(side.mean_width_m, 1),
    }
}

/// Which side of an error is dangerous, as it was measured.
fn dangerous(sides: &[Side]) -> String {
    let first = |of: fn(&Side) -> Without, more: bool| {
        let mut all: Vec<&Side> = sides.iter().filter(|side| (side.change_percent > 0.0) == more).collect();
        all.sort_by(|a, b| a.change_percent.abs().total_cmp(&b.change_percent.abs()));
        all.into_iter().find(|side| of(side).count > 0)
    };
    let beyond = |side: &Side| side.beyond;
    let before = |side: &Side| side.before;
    let mut text = match first(beyond, true) {
        Some(side) => format!(
            "Dangerous: rails that lose more than the table says (wetter, or a steeper rail). From {:+} % on the near end is \
             beyond the train: at that change in {} of {} intervals, by up to {:.1} m. The train is nearer to its \
             stopping point than it thinks, and overruns it by as much.",
            side.change_percent, side.beyond.count, side.answered, side.beyond.most_m
        ),
        None => format!(
            "Dangerous would be rails that lose more than the table says (wetter): up to +50 % no near end was beyond the train, \
             in {} intervals.",
            sides.iter().filter(|side| side.change_percent > 0.0).map(|side| side.answered).sum::<u32>()
        ),
    };
    let _ = match first(before, false) {
        Some(side) => write!(
            text,
            " Rails that lose less (drier) put the far end before the train, from {:+} % on: by up to {:.1} m there. Such a \
             train brakes too early; what counts on the far end, as its tail does, is wrong too.",
            side.change_percent, side.before.most_m
        ),
        None => write!(text, " Rails that lose less (drier) did not put the far end before the train, down to -50 %."),
    };
    if let Some(side) = first(beyond, false) {
        let _ = write!(
            text,
            " Also at {:+} % a near end is beyond the train, in {} of {} intervals by up to {:.1} m.",
            side.change_percent, side.beyond.count, side.answered, side.beyond.most_m
        );
    }
    text
}

/// What somebody should look at.
fn notes(levels: &Levels, fit: &Fit, sides: &[Side]) -> Vec<String> {
    let mut notes = Vec::new();
    for (pass, place, residual) in fit.remarkable() {
        if let Some(pass) = levels.passes.get(pass) {
            notes.push(format!(
                "line {}: {:+.2} dB from the line of its pass at {} m, far more than its neighbours; it widens the tolerance",
                pass.lines[place], residual.0, pass.measurements[place].distance.0
            ));
        }
    }
    for (number, pass) in fit.passes.iter().enumerate() {
        if pass.levelled {
            let name = levels.passes.get(number).map_or("", |pass| &pass.name);
            notes.push(format!(
                "pass {name}: the difference falls in places, within the spread; the fit is level there"
            ));
        }
    }
    let silent: u32 =
        sides.iter().filter(|side| side.change_percent.abs() < 0.1).map(|side| side.asked - side.answered).sum();
    if silent > 0 {
        notes.push(format!(
            "in the steepest pass itself {silent} of {} positions are unknown: there a flatter one may be beyond the table{}",
            sides.first().map_or(0, |side| side.asked),
            if fit.bounded { "" } else { "; --section-m helps if no train is there" }
        ));
    }
    if fit.passes.len() == 1 {
        notes.push("there is one pass: the table holds for its weather alone".to_owned());
    }
    if fit.from.0 > 0.0 && fit.first == 0 {
        notes.push(format!(
            "from 0 to {} m nothing was measured in every pass: there the line of the first span goes on",
            fit.from.0
        ));
    }
    notes
}

/// What no measurement of one day can show.
fn conditions(passes: &[PassReport], fit: &Fit) -> Vec<Condition> {
    let named: Vec<&str> = passes.iter().map(|pass| pass.name.as_str()).collect();
    let ballast: Vec<f64> = passes.iter().filter_map(|pass| pass.ballast_ohm_km).collect();
    let known = if ballast.len() == passes.len() && !ballast.is_empty() {
        let (least, most) =
            ballast.iter().fold((f64::INFINITY, 0.0_f64), |(least, most), &one| (least.min(one), most.max(one)));
        format!(" ({least} to {most} Ω·km)")
    } else {
        String::new()
    };
    let mut all = vec![
        Condition {
            id: "calibration-covers-the-weather",
            what: format!(
                "that no weather is wetter or drier than the measured one: {}{known}; nor other sections, transmitters and trains",
                named.join("; ")
            ),
        },
        Condition {
            id: "levels-within-tolerance",
            what: format!(
                "that a train's levels are off by no more than these were: {} dB each ({DEVIATIONS} standard deviations, or the \
                 largest residual)",
                Decibels(fit.tolerance.0.into())
            ),
        },
        Condition { id: "transmitter-at-exit", what: "that distances were counted from the section's exit".to_owned() },
    ];
    if fit.bounded {
        let what = format!("that no train beyond {} m hears this transmitter (--section-m)", fit.to.0);
        all.push(Condition { id: "levels-of-one-section", what });
    }
    all
}

fn rounded(value: f64, decimals: i32) -> f64 {
    let scale = 10_f64.powi(decimals);
    (value * scale).round() / scale
}
