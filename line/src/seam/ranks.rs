//! The speed codes of stations and the ranks in telegrams: one table, or a mapping that is never faster; and the pairs of codes.

use atc_kernel::aspect::AspectTable;
use atc_kernel::code::CodeTable;
use atc_kernel::interlocking::SpeedCode;
use atc_kernel::wayside::{WaysideError, spell};

use super::judged::{Judged, NO_CODES, NO_SIGNAL, NO_STATION, count, finding, judged};
use super::sound::Sound;
use crate::check::{DataCheck, Finding};
use crate::kmh::{Kmh, tenths};
use crate::line::Line;
use crate::permitted::{list, rank};
use crate::rule::Rule;

pub(super) fn checks(line: &Line) -> Vec<DataCheck> {
    let stations = line.sound();
    let each = |one: &dyn Fn(&AspectTable, Sound<'_>) -> Vec<Finding>| -> Judged {
        let speeds = line.signal().ok_or(NO_SIGNAL)?.permitted().settings().speeds;
        if line.stations().is_empty() {
            return Err(NO_STATION);
        }
        Ok(stations.iter().flat_map(|station| one(&speeds, *station)).collect())
    };
    let codes: usize = stations.iter().map(|one| one.station.codes().len()).sum();
    let with_codes = || {
        let table = line.codes().ok_or(NO_CODES)?;
        each(&|speeds, one| without_pair(line, speeds, table, one))
    };
    vec![
        judged(Rule::RankMissing, count(codes, "speed code"), each(&|speeds, one| missing(line, speeds, one))),
        judged(Rule::RankFaster, count(codes, "speed code"), each(&|_, one| faster(line, one))),
        judged(Rule::RankStop, count(stations.len(), "station"), each(&|speeds, one| stop(line, speeds, one))),
        judged(Rule::RankRises, count(codes, "speed code"), each(&|_, one| falling(line, one))),
        judged(Rule::CodeMissing, count(codes, "speed code"), with_codes()),
    ]
}

/// Where the speeds of a layout's codes stand.
fn codes_at(one: Sound<'_>) -> String {
    one.station.at(&one.station.description().station.braking.speeds_kmh.span)
}

/// Where a speed stands that telegrams name for a code: in the line's file, or in the layout.
fn at(line: &Line, one: Sound<'_>, place: usize) -> String {
    match &one.station.code_speeds {
        Some(_) => line.places().at(&format!("station[{}].code_speeds_km_h[{place}]", one.number)),
        None => codes_at(one),
    }
}

/// Where the speeds of ranks stand.
fn table(line: &Line) -> String {
    line.places().at(if line.places().has("signal.speeds_km_h") { "signal.speeds_km_h" } else { "aspects_km_h" })
}

fn missing(line: &Line, speeds: &AspectTable, one: Sound<'_>) -> Vec<Finding> {
    let (named, codes) = (one.station.named(), one.station.codes().len());
    let mut findings = Vec::new();
    if named.len() != codes {
        let what = format!("{} has {codes} speed codes, and code_speeds_km_h names {}", one.name(), named.len());
        let at = line.places().at(&format!("station[{}].code_speeds_km_h", one.number));
        findings.push(finding(at, codes_at(one), what, "name one speed for each code, from code 1 on"));
    }
    for (place, speed) in named.iter().enumerate().filter(|(_, speed)| rank(speeds, **speed).is_none()) {
        let what = format!(
            "{}: telegrams cannot name the {speed} km/h of code {}; the line's speeds are {} km/h",
            one.name(),
            place + 1,
            list(speeds)
        );
        let right = "give code_speeds_km_h with speeds of the line, none faster than its code";
        findings.push(finding(at(line, one, place), table(line), what, right));
    }
    findings
}

fn faster(line: &Line, one: Sound<'_>) -> Vec<Finding> {
    let codes = one.station.codes();
    let named = one.station.named();
    let pairs = named.iter().zip(codes).enumerate();
    pairs
        .filter(|(_, (named, code))| named.0 > i32::from(**code) * 10)
        .map(|(place, (named, code))| {
            let what =
                format!("{}: telegrams name {named} km/h for code {}, which is for {code}", one.name(), place + 1);
            finding(at(line, one, place), codes_at(one), what, format!("name {code} km/h or less"))
        })
        .collect()
}

fn stop(line: &Line, speeds: &AspectTable, one: Sound<'_>) -> Vec<Finding> {
    let lowest = speeds.speeds().first().copied().unwrap_or_default();
    if lowest.0 == 0 {
        return Vec::new();
    }
    let what = format!("code 0 of {} is a stop, and the lowest rank means {} km/h", one.name(), Kmh::from(lowest));
    vec![finding(table(line), codes_at(one), what, "let speeds_km_h of [signal] begin with 0")]
}

/// What the kernel does not take: the lower code would not be the lower speed.
fn falling(line: &Line, one: Sound<'_>) -> Vec<Finding> {
    let named = one.station.named();
    let pairs = named.iter().zip(named.iter().skip(1)).enumerate().filter(|(_, (lower, higher))| higher < lower);
    pairs
        .map(|(place, (lower, higher))| {
            let code = place + 2;
            let what = format!(
                "{}: telegrams name {higher} km/h for code {code}, and {lower} km/h for code {}",
                one.name(),
                code - 1
            );
            finding(at(line, one, place + 1), codes_at(one), what, "name no lower speed for a higher code")
        })
        .collect()
}

/// Speeds that a device of the ground cannot send, 0 km/h among them: it tells a stop, too, by telegram and by codes.
fn without_pair(line: &Line, speeds: &AspectTable, table: &CodeTable, one: Sound<'_>) -> Vec<Finding> {
    let named = [Kmh(0)].into_iter().chain(one.station.named());
    let unpaired = named.zip(0_u8..).filter(|(speed, code)| {
        let speed = tenths("", *speed).unwrap_or_default();
        matches!(spell(speeds, table, SpeedCode(*code), speed), Err(WaysideError::NoPair(_)))
    });
    unpaired
        .map(|(speed, code)| {
            let what = format!("{}: no pair of codes names {speed} km/h, the speed of code {code}", one.name());
            let place = usize::from(code).checked_sub(1);
            let named_at = place.map_or_else(|| codes_at(one), |place| at(line, one, place));
            finding(line.places().at("codes.pairs"), named_at, what, "add a pair for it, and its aspect")
        })
        .collect()
}
