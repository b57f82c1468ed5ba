//! Which circuit of which station sends telegrams of which section, for which direction of travel.

use std::collections::BTreeSet;

use atc_kernel::heading::Heading;
use atc_kernel::telegram::SectionId;
use atc_layout::form::Circuit;

use super::judged::{Judged, NO_SIGNAL, NO_STATION, count, finding, judged};
use super::sound::Sound;
use crate::check::{DataCheck, Finding};
use crate::figures::LineSection;
use crate::line::Line;
use crate::rule::Rule;
use crate::station::Station;

const BOTH: [Heading; 2] = [Heading::Left, Heading::Right];

const fn side(heading: Heading) -> &'static str {
    match heading {
        Heading::Left => "left",
        Heading::Right => "right",
    }
}

/// One section number, with the circuit and the direction of travel that it belongs to.
struct Sent<'a> {
    /// Its place in the file of the line.
    at: String,
    number: u16,
    heading: Heading,
    station: &'a Station,
    circuit: &'a Circuit,
    /// The circuit's own place: the same for two stations that see one circuit.
    own: (usize, &'a str),
}

pub(super) fn checks(line: &Line) -> Vec<DataCheck> {
    let sent = sent(line);
    let scope = || count(sent.len(), "section number");
    let with = |findings: &dyn Fn() -> Vec<Finding>| -> Judged {
        line.signal().ok_or(NO_SIGNAL)?;
        match (line.stations(), line.telegrams()) {
            ([], _) => Err(NO_STATION),
            (_, []) => Err("the file has no [[telegram]]"),
            _ => Ok(findings()),
        }
    };
    let sections = line.sections();
    let described = |findings: &dyn Fn() -> Vec<Finding>| -> Judged {
        if sections.is_empty() { Err("the file has no [[section]]") } else { with(findings) }
    };
    vec![
        judged(Rule::TelegramCircuit, count(line.telegrams().len(), "circuit"), named(line)),
        judged(Rule::TelegramTwice, scope(), with(&|| twice(&sent))),
        judged(Rule::TelegramDirection, scope(), with(&|| against(&sent))),
        judged(Rule::TelegramDiffers, scope(), with(&|| differs(&sent))),
        judged(
            Rule::TelegramMissing,
            scope(),
            with(&|| line.sound().iter().flat_map(|one| missing(line, *one)).collect()),
        ),
        judged(Rule::TelegramSection, scope(), described(&|| unknown(line, &sent, &sections))),
        judged(Rule::SectionLength, scope(), described(&|| lengths(line, &sent, &sections))),
        judged(Rule::SectionGradient, scope(), described(&|| steeper(line, &sent, &sections))),
        judged(Rule::SectionLimit, scope(), described(&|| faster(line, &sent, &sections))),
    ]
}

/// Every section number whose circuit there is.
fn sent(line: &Line) -> Vec<Sent<'_>> {
    let mut all = Vec::new();
    for (place, telegram) in line.telegrams().iter().enumerate() {
        let Some((number, station)) = line.station(&telegram.station) else { continue };
        let circuits = &station.description().station.circuits;
        let Some(circuit) = circuits.iter().find(|one| one.name.value == telegram.circuit) else { continue };
        for heading in BOTH {
            let Some(section) = telegram.section(heading) else { continue };
            let at = line.places().at(&format!("telegram[{place}].{}", side(heading)));
            let own = (owner(line, number, &circuit.name.value), circuit.name.value.as_str());
            all.push(Sent { at, number: section, heading, station, circuit, own });
        }
    }
    all
}

/// The first station that sees a circuit which two of them see under one name.
fn owner(line: &Line, number: usize, circuit: &str) -> usize {
    let lines = |station: &Station| -> BTreeSet<String> {
        let shared = |segment: &&atc_layout::form::Segment| segment.shared.iter().any(|name| name.value == circuit);
        let segments = station.description().station.segments.iter().filter(shared);
        segments.filter_map(|segment| segment.line.as_ref().map(|line| line.value.clone())).collect()
    };
    let Some(station) = line.stations().get(number) else { return number };
    let own = lines(station);
    let first = line.stations().iter().position(|other| !lines(other).is_disjoint(&own));
    first.map_or(number, |first| first.min(number))
}

fn named(line: &Line) -> Judged {
    if line.telegrams().is_empty() {
        return Err("the file has no [[telegram]]");
    }
    let mut findings = Vec::new();
    for (place, telegram) in line.telegrams().iter().enumerate() {
        let at = |field: &str| line.places().at(&format!("telegram[{place}].{field}"));
        let Some((number, station)) = line.station(&telegram.station) else {
            let known: Vec<_> = line.stations().iter().map(Station::name).collect();
            let what = format!("there is no station {}", telegram.station);
            findings.push(finding(
                at("station"),
                line.places().at("station"),
                what,
                format!("stations are {}", known.join(", ")),
            ));
            continue;
        };
        if !station.description().station.circuits.iter().any(|one| one.name.value == telegram.circuit) {
            let what = format!("{} has no circuit {}", telegram.station, telegram.circuit);
            let file = line.places().at(&format!("station[{number}].file"));
            findings.push(finding(at("circuit"), file, what, "name a circuit of its layout"));
        }
    }
    Ok(findings)
}

fn against(sent: &[Sent<'_>]) -> Vec<Finding> {
    let wrong = sent.iter().filter(|one| SectionId(one.number).heading() != one.heading);
    wrong
        .map(|one| {
            let towards = side(one.heading);
            let (is, right) = if towards == "left" { ("even", "odd") } else { ("odd", "even") };
            let (circuit, station) = (&one.circuit.name, one.station.name());
            let what = format!(
                "section {} is {is}, and is sent to trains to the {towards} in circuit {circuit} of {station}",
                one.number
            );
            let place = one.station.at(&circuit.span);
            finding(one.at.clone(), place, what, format!("give {towards} an {right} number"))
        })
        .collect()
}

fn twice(sent: &[Sent<'_>]) -> Vec<Finding> {
    let mut findings = Vec::new();
    for (place, one) in sent.iter().enumerate() {
        let same = |other: &&Sent<'_>| {
            other.number == one.number && (other.own, side(other.heading)) != (one.own, side(one.heading))
        };
        if let Some(first) = sent[..place].iter().find(same) {
            let what = format!(
                "section {} is sent in circuit {} of {} and in circuit {} of {}",
                one.number,
                first.circuit.name,
                first.station.name(),
                one.circuit.name,
                one.station.name()
            );
            findings.push(finding(
                one.at.clone(),
                first.at.clone(),
                what,
                "give each circuit and direction a number of its own",
            ));
        }
    }
    findings
}

fn differs(sent: &[Sent<'_>]) -> Vec<Finding> {
    let mut findings = Vec::new();
    for (place, one) in sent.iter().enumerate() {
        let same =
            |other: &&Sent<'_>| other.own == one.own && other.heading == one.heading && other.number != one.number;
        if let Some(first) = sent[..place].iter().find(same) {
            let (circuit, old, new) = (&one.circuit.name, first.number, one.number);
            let (what, right) = if one.station.name() == first.station.name() {
                let what =
                    format!("circuit {circuit} of {} is there twice, as section {old} and {new}", one.station.name());
                (what, "leave one of them out")
            } else {
                let (there, here) = (first.station.name(), one.station.name());
                let what = format!("circuit {circuit} is section {old} in {there} and section {new} in {here}");
                (what, "give it the same number in both")
            };
            findings.push(finding(one.at.clone(), first.at.clone(), what, right));
        }
    }
    findings
}

/// Circuits in which trains run, each with the directions of travel.
fn missing(line: &Line, one: Sound<'_>) -> Vec<Finding> {
    let mut runs: BTreeSet<(usize, &str)> = BTreeSet::new();
    for route in one.model.routes.iter().filter(|route| route.is_sound()) {
        runs.extend(route.circuits().chain([route.entry]).map(|circuit| (circuit, side(route.heading))));
    }
    for segment in &one.model.segments {
        runs.extend(segment.circuits.iter().flat_map(|circuit| BOTH.map(|heading| (*circuit, side(heading)))));
    }
    let given = |circuit: &str, towards: &str| {
        line.telegrams().iter().any(|telegram| {
            let section = if towards == "left" { telegram.left } else { telegram.right };
            telegram.station == one.name() && telegram.circuit == circuit && section.is_some()
        })
    };
    runs.into_iter()
        .filter_map(|(circuit, towards)| Some((one.station.description().station.circuits.get(circuit)?, towards)))
        .filter(|(circuit, towards)| !given(&circuit.name.value, towards))
        .map(|(circuit, towards)| {
            let what = format!(
                "trains run to the {towards} in circuit {} of {}, and no section number is sent to them",
                circuit.name,
                one.name()
            );
            let right = format!("give {towards} in a [[telegram]] of the circuit");
            finding(line.places().at("telegram"), one.station.at(&circuit.name.span), what, right)
        })
        .collect()
}

fn unknown(line: &Line, sent: &[Sent<'_>], sections: &[LineSection]) -> Vec<Finding> {
    let known = |one: &&Sent<'_>| !sections.iter().any(|section| section.number == one.number);
    sent.iter()
        .filter(known)
        .map(|one| {
            let what = format!("no [[section]] has the number {} of circuit {}", one.number, one.circuit.name);
            finding(one.at.clone(), line.places().at("section"), what, "describe the section")
        })
        .collect()
}

/// The description of a section that is sent, with its place among the sections.
fn described<'a>(
    sent: &'a [Sent<'a>],
    sections: &'a [LineSection],
) -> impl Iterator<Item = (&'a Sent<'a>, usize, &'a LineSection)> {
    sent.iter().filter_map(|one| {
        let place = sections.iter().position(|section| section.number == one.number)?;
        Some((one, place, sections.get(place)?))
    })
}

fn lengths(line: &Line, sent: &[Sent<'_>], sections: &[LineSection]) -> Vec<Finding> {
    described(sent, sections)
        .filter(|(one, _, section)| section.length_m != one.circuit.length_m.value)
        .map(|(one, place, section)| {
            let (length, circuit) = (&one.circuit.length_m, &one.circuit.name);
            let what = format!(
                "section {} is said to be {} m long, and circuit {circuit} is {length} m",
                section.number, section.length_m
            );
            let at = line.places().at(&format!("section[{place}].length_m"));
            finding(at, one.station.at(&length.span), what, format!("length_m is {length}, or the layout is wrong"))
        })
        .collect()
}

/// The worst of the circuit and of those ahead: the pattern has the gradient of the train's own section down to the point at which it stops.
fn steeper(line: &Line, sent: &[Sent<'_>], sections: &[LineSection]) -> Vec<Finding> {
    described(sent, sections)
        .filter_map(|(one, place, section)| {
            let circuits = &one.station.description().station.circuits;
            let ahead = one.station.ahead(one.circuit, one.heading);
            let fall = |circuit: &&Circuit| circuit.gradient.as_ref().map_or(0, |given| i16::from(given.value).abs());
            let steepest = ahead.iter().filter_map(|circuit| circuits.get(*circuit)).max_by_key(fall)?;
            let least = -fall(&steepest);
            (i16::from(section.gradient_permille) > least).then(|| {
                let where_to =
                    if steepest == one.circuit { String::new() } else { format!(", ahead of {}", one.circuit.name) };
                let what = format!(
                    "section {} is said to have {} ‰, and circuit {} may fall by {} ‰{where_to}",
                    section.number, section.gradient_permille, steepest.name, -least
                );
                let at = line.places().at(&format!("section[{place}].gradient_permille"));
                let against = steepest.gradient.as_ref().map_or(&steepest.name.span, |gradient| &gradient.span);
                finding(at, one.station.at(against), what, format!("gradient_permille must be at most {least}"))
            })
        })
        .collect()
}

/// A train by codes hears no limit of a section: what the layout lets it run must be enough.
fn faster(line: &Line, sent: &[Sent<'_>], sections: &[LineSection]) -> Vec<Finding> {
    described(sent, sections)
        .filter_map(|(one, place, section)| {
            let kmh = one.station.fastest_kmh(one.circuit, one.heading);
            (f64::from(kmh) > section.limit_km_h).then(|| {
                let what = format!(
                    "section {} is for {} km/h, and the layout lets trains run through {} at {kmh} km/h: a train by codes hears nothing of the limit",
                    section.number, section.limit_km_h, one.circuit.name
                );
                let right = format!("give the routes or the line over it a speed_kmh of at most {}", section.limit_km_h);
                let at = line.places().at(&format!("section[{place}].limit_km_h"));
                finding(at, one.station.at(&one.circuit.name.span), what, right)
            })
        })
        .collect()
}
