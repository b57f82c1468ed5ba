//! A station's parameters, and everything that somebody must confirm.

use crate::case::{Confirm, Derived, Origin};
use atc_layout::form::Station;
use atc_layout::import::Imported;
use atc_layout::model::{Model, Route};
use atc_layout::{At, Description};
use std::ops::Range;

/// Name, value, how it was made of what the file says, and where that stands.
pub fn parameters(description: &Description, model: &Model) -> Vec<Derived> {
    let Station { times, braking, overlaps, longest_train_m, shortest_train_m, .. } = &description.station;
    let at = |span: &Range<usize>| at(description, span);
    let row =
        |name: &str, value: String, formula: &str, span: &Range<usize>| Derived::row(name, value, formula, &at(span));
    let cycle = model.values.cycle_ms;
    let kept = |name: &str, time: &At<u32>, ticks: u32, way: &str| {
        let value = format!("{} ms ({ticks} cycles)", ticks * cycle);
        row(name, value, &format!("{} ms, rounded {way}", time.value), &time.span)
    };
    let of_routes = |name: &str, time: &At<u32>, ticks: fn(&Route) -> u16, way: &str| {
        let all = model.routes.iter().map(|route| u32::from(ticks(route)) * cycle);
        let value = match (all.clone().min(), all.max()) {
            (Some(least), Some(most)) if least == most => format!("{least} ms"),
            (Some(least), Some(most)) => format!("{least} to {most} ms, by route"),
            _ => "no route".to_owned(),
        };
        row(name, value, &format!("{} ms where a route names none; rounded {way}", time.value), &time.span)
    };
    let mut rows = vec![
        row("Logic cycle", format!("{cycle} ms"), "", &times.cycle_ms.span),
        kept("A circuit counts as clear after", &times.clear_ms, model.values.clear.into(), "up"),
        row("Longest loss of shunt", format!("{} ms", times.shunt_loss_ms), "", &times.shunt_loss_ms.span),
        of_routes("Drive time", &times.drive_ms, |route| route.drive.0, "down"),
        row("Longest stroke of a point", format!("{} ms", longest_stroke(model)), "", &times.throw_ms.span),
        kept("Nothing moves after a start for", &model.values.start_ms, model.values.start.0.into(), "up"),
        kept("Settling time of points", &times.settle_ms, model.values.settle.into(), "up"),
        of_routes("Release time", &times.release_ms, |route| route.release.0, "up"),
        kept("Residual running", &model.values.residual_ms, model.values.residual.0.into(), "up"),
        of_routes("Stay time", &model.values.stay_ms, |route| route.stay.0, "up"),
        kept("Time to a stand", &model.values.standstill_ms, model.values.standstill.0.into(), "up"),
        kept("Turn time of plain line", &model.values.turn_ms, model.values.turn.0.into(), "up"),
        row("Oldest telegram", format!("{} ms", times.telegram_age_ms), "", &times.telegram_age_ms.span),
        row(
            "Brake on the level",
            format!("{} mm/s²", braking.deceleration_mm_s2),
            "every train has at least this",
            &braking.deceleration_mm_s2.span,
        ),
        row(
            "Pattern from telegrams to codes, at most",
            format!("{} mm/s²", braking.strongest_mm_s2.as_ref().unwrap_or(&braking.deceleration_mm_s2)),
            "on the level; the distance of each code holds for it",
            &braking.strongest_mm_s2.as_ref().unwrap_or(&braking.deceleration_mm_s2).span,
        ),
        row(
            "A code is heard beyond its circuit for",
            format!("{} m", braking.heard_beyond_m),
            "with the metres from antenna to nose; in the distance of each code",
            &braking.heard_beyond_m.span,
        ),
        row("Least overlap", format!("{} m", overlaps.least_m), "", &overlaps.least_m.span),
    ];
    for (name, length) in [("Longest train", longest_train_m), ("Shortest train", shortest_train_m)] {
        if let Some(length) = length {
            rows.push(row(name, format!("{length} m"), "", &length.span));
        }
    }
    let codes = model.values.speeds_kmh.iter().zip(&model.values.braking).enumerate().skip(1);
    for (code, (speed, distance)) in codes.filter(|(_, (speed, _))| **speed > 0) {
        let value = format!("{speed} km/h, stops within {} m", distance.0);
        rows.push(row(
            &format!("Speed code {code}"),
            value,
            "braking pattern, worst gradient; what is run where the code is still heard and while a telegram ages",
            &braking.speeds_kmh.span,
        ));
    }
    rows
}

fn longest_stroke(model: &Model) -> u32 {
    model.points.iter().map(|point| point.throw_ms).max().unwrap_or(0)
}

/// Where a value stands: file, line and column, or `default`.
fn at(description: &Description, span: &Range<usize>) -> String {
    match description.source.place(span) {
        Some(at) => place(&description.source.name, Some(at)),
        None => "default, or assumed on import".to_owned(),
    }
}

/// What the file gives a reason for, what stands by default or was assumed on import, and what follows from the tracks.
pub fn confirm(imported: &Imported, model: Option<&Model>) -> Vec<Confirm> {
    let Imported { description, report } = imported;
    let station = &description.station;
    let one = |origin, about: &str, text: String, at: String| Confirm { origin, about: about.to_owned(), text, at };
    let mut all = Vec::new();
    for circuit in &station.circuits {
        for track in circuit.tracks() {
            for (end, reason) in ["left", "right"].into_iter().zip(track.unprotected) {
                let Some(reason) = reason else { continue };
                let [left, right] = track.joints;
                let about = format!("circuit {}, track from {left} to {right}, {end} end", circuit.name);
                let text = format!("no flank protection: {reason}");
                all.push(one(Origin::Reason, &about, text, at(description, &reason.span)));
            }
        }
    }
    for point in &station.points {
        let ends = [
            ("toe", &point.toe_unprotected),
            ("normal leg", &point.normal_unprotected),
            ("reverse leg", &point.reverse_unprotected),
        ];
        for (end, reason) in ends {
            if let Some(reason) = reason {
                let about = format!("point {}, {end}", point.name);
                let text = format!("no flank protection: {reason}");
                all.push(one(Origin::Reason, &about, text, at(description, &reason.span)));
            }
        }
    }
    for route in &station.routes {
        if let Some(reason) = &route.short_overlap {
            let about = format!("route {}", route.name);
            all.push(one(Origin::Reason, &about, format!("short overlap: {reason}"), at(description, &reason.span)));
        }
        if let Some(reason) = &route.no_reversal {
            let text = format!("no train changes ends where it ends: {reason}");
            all.push(one(Origin::Reason, &format!("route {}", route.name), text, at(description, &reason.span)));
        }
    }
    // Of an imported file the report says what was assumed.
    if !description.source.text.is_empty() && report.taken.is_empty() {
        for (name, value) in defaults(station, model) {
            all.push(one(Origin::Default, name, value, String::new()));
        }
    }
    let reported =
        [(Origin::Import, &report.defaulted), (Origin::Lacking, &report.lacking), (Origin::NotUsed, &report.skipped)];
    for (origin, lines) in reported {
        all.extend(lines.iter().map(|line| one(origin, "import", line.clone(), String::new())));
    }
    let notes = model.iter().flat_map(|model| &model.notes);
    all.extend(notes.map(|note| one(Origin::Derived, &note.about, note.text.clone(), String::new())));
    all
}

/// The values for the whole station that the file does not give.
fn defaults(station: &Station, model: Option<&Model>) -> Vec<(&'static str, String)> {
    let times = &station.times;
    let mut all: Vec<(&'static str, &Range<usize>, String)> = [
        ("times.cycle_ms", &times.cycle_ms),
        ("times.clear_ms", &times.clear_ms),
        ("times.shunt_loss_ms", &times.shunt_loss_ms),
        ("times.drive_ms", &times.drive_ms),
        ("times.throw_ms", &times.throw_ms),
        ("times.settle_ms", &times.settle_ms),
        ("times.release_ms", &times.release_ms),
        ("times.telegram_age_ms", &times.telegram_age_ms),
    ]
    .map(|(name, time)| (name, &time.span, format!("{time} ms")))
    .into();
    if let Some(values) = model.map(|model| &model.values) {
        all.push(("times.start_ms", &values.start_ms.span, format!("{} ms", values.start_ms)));
        all.push(("times.standstill_ms", &values.standstill_ms.span, format!("{} ms", values.standstill_ms)));
        all.push(("times.stay_ms", &values.stay_ms.span, format!("{} ms", values.stay_ms)));
        all.push(("times.turn_ms", &values.turn_ms.span, format!("{} ms", values.turn_ms)));
        all.push(("times.residual_ms", &values.residual_ms.span, format!("{} ms", values.residual_ms)));
    }
    let braking = &station.braking;
    let brake = &braking.deceleration_mm_s2;
    all.push(("braking.deceleration_mm_s2", &brake.span, format!("{brake} mm/s²")));
    let speeds = &braking.speeds_kmh;
    all.push(("braking.speeds_kmh", &speeds.span, format!("{:?} km/h", speeds.value)));
    let beyond = &braking.heard_beyond_m;
    all.push(("braking.heard_beyond_m", &beyond.span, format!("{beyond} m")));
    let least = &station.overlaps.least_m;
    all.push(("overlaps.least_m", &least.span, format!("{least} m")));
    let missing = all.into_iter().filter(|(_, span, _)| span.is_empty());
    missing.map(|(name, _, value)| (name, format!("the file does not say; {value} is taken"))).collect()
}

/// File, line and column; the file alone where the line is not known.
pub(super) fn place(source: &str, place: Option<atc_layout::LineColumn>) -> String {
    place.map_or_else(|| source.to_owned(), |at| format!("{source}:{}:{}", at.line, at.column))
}
