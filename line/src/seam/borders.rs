//! Borders: between two stations, and between a station and the counted blocks.

use atc_layout::form;
use atc_layout::model::Segment;

use super::judged::{Judged, NO_STATION, count, finding, judged};
use super::sound::Sound;
use crate::blocks::Detection;
use crate::border::{Between, Borders, Counted};
use crate::check::{DataCheck, Finding};
use crate::form::End;
use crate::line::Line;
use crate::rule::Rule;
use crate::station::Station;

pub(super) fn checks(line: &Line) -> Vec<DataCheck> {
    let Borders { between, counted } = line.borders();
    let stations = |findings: &dyn Fn() -> Vec<Finding>| -> Judged {
        if line.stations().is_empty() { Err(NO_STATION) } else { Ok(findings()) }
    };
    let some = |any: bool, why: &'static str, findings: Vec<Finding>| if any { Ok(findings) } else { Err(why) };
    let no_between = "the file has no [[border]] between stations";
    let no_counted = "the file has no [[border]] of counted blocks";
    vec![
        judged(
            Rule::BorderNames,
            count(between.len() + counted.len(), "border"),
            some(between.len() + counted.len() > 0, "the file has no [[border]]", names(line)),
        ),
        judged(Rule::BorderMissing, count(line.stations().len(), "station"), stations(&|| missing(line))),
        judged(
            Rule::BorderViews,
            count(between.len(), "border"),
            some(!between.is_empty(), no_between, between.iter().flat_map(|one| views(line, one)).collect()),
        ),
        judged(
            Rule::BorderJoint,
            count(counted.len(), "border"),
            some(!counted.is_empty(), no_counted, counted.iter().filter_map(|one| joint(line, one)).collect()),
        ),
        judged(
            Rule::BorderTail,
            count(counted.len(), "border"),
            some(!counted.is_empty(), no_counted, counted.iter().filter_map(|one| tail(line, one)).collect()),
        ),
    ]
}

/// The segment of a station that it gives the name of a line.
fn of_line<'a>(station: &'a Station, line: &str) -> Option<(usize, &'a form::Segment)> {
    let named = |segment: &form::Segment| segment.line.as_ref().is_some_and(|name| name.value == line);
    station.description().station.segments.iter().enumerate().find(|(_, segment)| named(segment))
}

/// Where a segment names its line.
fn line_at(station: &Station, segment: &form::Segment) -> String {
    station.at(&segment.line.as_ref().map_or_else(|| segment.name.span.clone(), |line| line.span.clone()))
}

fn names(line: &Line) -> Vec<Finding> {
    let mut findings = Vec::new();
    let at = |number: usize, field: &str| line.places().at(&format!("border[{number}].{field}"));
    let no_station = |number: usize, field: &str, name: &str| {
        let known: Vec<_> = line.stations().iter().map(Station::name).collect();
        let right = if known.is_empty() {
            "add a [[station]]".to_owned()
        } else {
            format!("stations are {}", known.join(", "))
        };
        finding(at(number, field), line.places().at("station"), format!("there is no station {name}"), right)
    };
    for one in &line.borders().between {
        for (place, name) in one.stations.iter().enumerate() {
            let Some((number, station)) = line.station(name) else {
                findings.push(no_station(one.number, &format!("between[{place}]"), name));
                continue;
            };
            if of_line(station, &one.line).is_none() {
                let what = format!("{name} has no segment with line = \"{}\"", one.line);
                let file = line.places().at(&format!("station[{number}].file"));
                findings.push(finding(at(one.number, "line"), file, what, "name the line as both layouts do"));
            }
        }
        if one.stations[0] == one.stations[1] {
            let what = format!("{} is no neighbour of its own", one.stations[0]);
            findings.push(finding(
                at(one.number, "between[1]"),
                at(one.number, "between[0]"),
                what,
                "name two stations",
            ));
        }
    }
    for one in &line.borders().counted {
        let Some((number, station)) = line.station(&one.station) else {
            findings.push(no_station(one.number, "station", &one.station));
            continue;
        };
        if !station.description().station.segments.iter().any(|segment| segment.name.value == one.segment) {
            let what = format!("{} has no segment {}", one.station, one.segment);
            let file = line.places().at(&format!("station[{number}].file"));
            findings.push(finding(at(one.number, "segment"), file, what, "name a segment of its layout"));
        }
        let mut before = line.borders().counted.iter().take_while(|other| other.number < one.number);
        if let Some(other) = before.find(|other| other.blocks == one.blocks) {
            let side = if one.blocks == End::Low { "low" } else { "high" };
            let what = format!("{} and {} both begin at the {side} end of the blocks", other.station, one.station);
            let right = "the blocks have one station at each end";
            findings.push(finding(at(one.number, "blocks"), at(other.number, "blocks"), what, right));
        }
        findings.extend(two_borders(line, one, station));
        if line.detection().is_none() {
            let what = "the line has no counted blocks".to_owned();
            findings.push(finding(
                at(one.number, "blocks"),
                line.places().at("block"),
                what,
                "add [detection] and a [[block]]",
            ));
        }
    }
    findings
}

/// A segment ends at one thing: at another station's view, or at counted blocks.
fn two_borders(line: &Line, one: &Counted, station: &Station) -> Option<Finding> {
    let also = line.borders().between.iter().find(|between| {
        let segment = of_line(station, &between.line).map(|(_, segment)| segment.name.value.as_str());
        between.stations.contains(&one.station) && segment == Some(one.segment.as_str())
    })?;
    let what = format!(
        "segment {} of {} ends at counted blocks, and as line {} between two stations",
        one.segment, one.station, also.line
    );
    let at = |number: usize, field: &str| line.places().at(&format!("border[{number}].{field}"));
    Some(finding(at(one.number, "segment"), at(also.number, "line"), what, "a segment has one border: leave one out"))
}

/// Lines that two stations name, and that are no border; and counted blocks that no station borders.
fn missing(line: &Line) -> Vec<Finding> {
    let mut findings = Vec::new();
    if line.detection().is_some() && line.borders().counted.is_empty() && !line.stations().is_empty() {
        let what = "the line has counted blocks and stations, and no border between them".to_owned();
        let right = "add a [[border]] with station, segment, joint and blocks for each end at which a station is";
        findings.push(finding(line.places().at("detection"), line.places().at("station"), what, right));
    }
    let all = line.stations();
    for (number, second) in all.iter().enumerate() {
        for first in &all[..number] {
            for segment in &first.description().station.segments {
                let Some(name) = &segment.line else { continue };
                let Some((_, other)) = of_line(second, name) else { continue };
                let named = |stations: &[String; 2]| {
                    stations.iter().any(|one| one == first.name()) && stations.iter().any(|one| one == second.name())
                };
                if line.borders().between.iter().any(|one| one.line == name.value && named(&one.stations)) {
                    continue;
                }
                let what =
                    format!("{} and {} both name the line {name}, and it is no border", first.name(), second.name());
                let right = format!(
                    "add a [[border]] with between = [\"{}\", \"{}\"] and line = \"{name}\"",
                    first.name(),
                    second.name()
                );
                findings.push(finding(line_at(first, segment), line_at(second, other), what, right));
            }
        }
    }
    findings
}

/// A station of a border whose layout keeps every rule.
fn sound<'a>(line: &'a Line, name: &str) -> Option<Sound<'a>> {
    line.sound().into_iter().find(|one| one.name() == name)
}

fn views(line: &Line, one: &Between) -> Vec<Finding> {
    let [first, second] = &one.stations;
    let (Some(first), Some(second)) = (sound(line, first), sound(line, second)) else { return Vec::new() };
    let segments = (of_line(first.station, &one.line), of_line(second.station, &one.line));
    let (Some((_, segment)), Some((_, other))) = segments else { return Vec::new() };
    let compared = atc_layout::border::compare(
        (first.station.description(), first.model),
        (second.station.description(), second.model),
    );
    let problems = compared.err().map(|errors| errors.problems).unwrap_or_default();
    let span = segment.line.as_ref().map(|line| line.span.clone()).unwrap_or_default();
    let mine = problems.into_iter().filter(|problem| problem.span == span);
    let at = || (line_at(first.station, segment), line_at(second.station, other));
    let told = |problem: atc_layout::Problem| finding(at().0, at().1, problem.what, problem.right);
    mine.map(told).collect()
}

fn segment<'a>(line: &'a Line, one: &Counted) -> Option<(Sound<'a>, &'a Segment, &'a form::Segment)> {
    let station = sound(line, &one.station)?;
    let place = station.model.segments.iter().position(|segment| segment.name == one.segment)?;
    Some((station, station.model.segments.get(place)?, station.station.description().station.segments.get(place)?))
}

fn joint(line: &Line, one: &Counted) -> Option<Finding> {
    let asked = &one.joint;
    let (station, segment, given) = segment(line, one)?;
    let end = atc_layout::border::outer_end(station.model, segment);
    if end == Some(asked) {
        return None;
    }
    let ends = end.map_or_else(|| "at no joint".to_owned(), |end| format!("at joint {end}"));
    let what = format!("segment {} of {} ends {ends}, and the blocks begin at joint {asked}", one.segment, one.station);
    let at = line.places().at(&format!("border[{}].joint", one.number));
    Some(finding(
        at,
        station.station.at(&given.name.span),
        what,
        "name the joint at which the view of the station ends",
    ))
}

/// The blocks ask for a number of sections beyond their end; the station's circuits there must be as long as the longest train.
fn tail(line: &Line, one: &Counted) -> Option<Finding> {
    let (station, segment, given) = segment(line, one)?;
    let detection: &Detection = line.detection()?;
    let (hold, longest) = (usize::from(detection.hold().sections()), detection.longest_train());
    let length =
        |circuit: &usize| station.model.circuits.get(*circuit).map_or(0, |circuit| u32::from(circuit.length.0));
    let held: u32 = segment.circuits.iter().rev().take(hold).map(length).sum();
    if segment.circuits.len() >= hold && held >= u32::from(longest.0) {
        return None;
    }
    let what = format!(
        "the blocks ask for {hold} sections beyond their end, and the outermost {} of segment {} of {} are {held} m long; a train is {} m",
        count(segment.circuits.len().min(hold), "circuit"),
        one.segment,
        one.station,
        longest.0
    );
    let right = "let the station see more of the line, or hold more sections (hold_sections of [detection])";
    Some(finding(station.station.at(&given.name.span), line.places().at("detection.longest_train_m"), what, right))
}
