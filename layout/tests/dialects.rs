//! Random stations, written as railML in the ways of different tools: what is imported is what was written. With one falsification in the
//! file, the route is left out, or it is what it was before.
//!
//! `STATIONS=10000 cargo test -p atc-layout --test dialects --release` takes more of them.

#[path = "support/shapes.rs"]
mod shapes;
mod support;

use std::collections::BTreeMap;

use atc_layout::form::Position;
use atc_layout::import::{Imported, railml};
use atc_layout::model::{Model, Route};
use proptest::prelude::*;
use proptest::sample::Index;
use proptest::test_runner::TestCaseError;
use shapes::{runner, shapes};
use support::model;
use support::railml::{Dialect, Version, written};
use support::random::station;

fn dialects() -> impl Strategy<Value = Dialect> {
    let flags = prop::array::uniform6(any::<bool>());
    let offset = prop_oneof![Just(0.0), -60.0..-1.0_f64, -0.9..0.9_f64, 2.0..19.0_f64];
    (0_usize..4, offset, flags).prop_map(
        |(turned, offset, [metres, wrapped, to_signals, rear, backwards, nameless])| {
            // Where a signal stands ahead of its joint, a listed section in rear of it would be the one in front.
            let rear = rear && offset < 1.0;
            Dialect { turned, offset, metres, wrapped, to_signals, rear, backwards, nameless }
        },
    )
}

/// What a train on a route runs over: entry and circuits by name, and points with positions.
type Course = (Vec<String>, BTreeMap<String, Position>);

fn course(model: &Model, route: &Route, circuit: &dyn Fn(usize) -> String, point: &dyn Fn(usize) -> String) -> Course {
    let passed = route.path.iter().flat_map(|place| &place.passed);
    let _ = model;
    (
        [route.entry].into_iter().chain(route.circuits()).map(circuit).collect(),
        passed.map(|passed| (point(passed.point), passed.position)).collect(),
    )
}

/// The courses of the routes of a layout, by the names that they have in the file.
fn expected(model: &Model, dialect: &Dialect) -> BTreeMap<String, Course> {
    let name = |id: String, name: &str| if dialect.nameless { id } else { name.to_owned() };
    let circuit = |number: usize| name(format!("tvd{number}"), &model.circuits[number].name);
    let point = |number: usize| name(format!("sw{number}"), &model.points[number].name);
    let routes = model.routes.iter().enumerate();
    routes
        .map(|(number, route)| (name(format!("rt{number}"), &route.name), course(model, route, &circuit, &point)))
        .collect()
}

fn found(imported: &Imported) -> Result<BTreeMap<String, Course>, TestCaseError> {
    let model = imported
        .description
        .tracks()
        .map_err(|errors| TestCaseError::fail(format!("{errors}\n{}", imported.report)))?;
    let circuit = |number: usize| model.circuits[number].name.clone();
    let point = |number: usize| model.points[number].name.clone();
    Ok(model.routes.iter().map(|route| (route.name.clone(), course(&model, route, &circuit, &point))).collect())
}

fn import(text: &str) -> Result<Imported, TestCaseError> {
    railml("station.railml", text).map_err(|errors| TestCaseError::fail(errors.to_string()))
}

#[test]
fn every_dialect_of_a_station_is_imported_as_it_was_written() {
    let mut runner = runner(48);
    let cases = (shapes(16), dialects(), any::<bool>());
    let result = runner.run(&cases, |(shape, dialect, newer)| {
        let station = station(&shape);
        let version = if newer { Version::V32 } else { Version::V31 };
        let imported = import(&written(&station, version, &dialect))?;
        let (wanted, found) = (expected(&model(&station), &dialect), found(&imported)?);
        prop_assert_eq!(wanted, found, "{}", imported.report);
        let second = imported.report.lacking.iter().find(|line| line.contains("second reading"));
        prop_assert_eq!(second, None);
        Ok(())
    });
    result.unwrap_or_else(|error| panic!("{error}"));
}

/// One wrong thing in the file.
#[derive(Clone, Copy, Debug)]
enum Falsified {
    /// A position of a switch.
    Position,
    /// A section is left out.
    Missing,
    /// A section that it does not run over is listed.
    Section,
    /// The side of its signal.
    Side,
    /// The exit of another route.
    Exit,
    /// The entry of another route.
    Entry,
    /// A switch of a position is another one.
    Switch,
}

/// The text with one element of a route falsified; nothing if the route has none.
fn falsify(text: &str, route: usize, what: Falsified, index: Index, other: Index) -> Option<String> {
    let start = text.find(&format!("<route id=\"rt{route}\""))?;
    let end = start + text[start..].find("</route>")?;
    let element = &text[start..end];
    let lines = |word: &str| -> Vec<&str> { element.lines().filter(|line| line.contains(word)).collect() };
    let all = |word: &str| -> Vec<&str> { text.lines().filter(|line| line.contains(word)).collect() };
    let pick = |lines: &[&str], index: Index| -> Option<String> {
        (!lines.is_empty()).then(|| lines[index.index(lines.len())].to_owned())
    };
    let reference = |line: &str| -> Option<String> { Some(line.split("ref=\"").nth(1)?.split('"').next()?.to_owned()) };
    let within =
        |old: &str, new: &str| Some(format!("{}{}{}", &text[..start], element.replacen(old, new, 1), &text[end..]));
    match what {
        Falsified::Position => {
            let line = pick(&lines("facingSwitchInPosition"), index)?;
            let turned = if line.contains("\"left\"") {
                line.replace("\"left\"", "\"right\"")
            } else {
                line.replace("\"right\"", "\"left\"")
            };
            within(&line, &turned)
        }
        Falsified::Missing => within(&pick(&lines("hasTvdSection"), index)?, ""),
        Falsified::Section => {
            let line = pick(&lines("hasTvdSection"), index)?;
            let section = pick(&all("<tvdSection "), other)?.split('"').nth(1)?.to_owned();
            within(&line, &format!("{line}<hasTvdSection ref=\"{section}\"/>"))
        }
        Falsified::Side => {
            let signal = reference(&pick(&lines("<routeEntry"), index)?)?;
            let line = all("<signalIS ").into_iter().find(|line| line.contains(&format!("id=\"{}\"", &signal[2..])))?;
            let turned = if line.contains("\"normal\"") {
                line.replace("\"normal\"", "\"reverse\"")
            } else {
                line.replace("\"reverse\"", "\"normal\"")
            };
            Some(text.replacen(line, &turned, 1))
        }
        Falsified::Exit | Falsified::Entry => {
            let word = if matches!(what, Falsified::Exit) { "<routeExit" } else { "<routeEntry" };
            let (own, new) = (reference(&pick(&lines(word), index)?)?, reference(&pick(&all(word), other)?)?);
            let line = pick(&lines(word), index)?;
            within(&line, &line.replace(&format!("ref=\"{own}\""), &format!("ref=\"{new}\"")))
        }
        Falsified::Switch => {
            let line = pick(&lines("facingSwitchInPosition"), index)?;
            let (own, new) = (reference(&line)?, pick(&all("<switchIL "), other)?.split('"').nth(1)?.to_owned());
            within(&line, &line.replace(&format!("ref=\"{own}\""), &format!("ref=\"{new}\"")))
        }
    }
}

#[test]
fn a_falsified_route_is_left_out_or_what_it_was() {
    let kinds = prop_oneof![
        Just(Falsified::Position),
        Just(Falsified::Missing),
        Just(Falsified::Section),
        Just(Falsified::Side),
        Just(Falsified::Exit),
        Just(Falsified::Entry),
        Just(Falsified::Switch),
    ];
    let mut runner = runner(48);
    let cases = (shapes(16), dialects(), kinds, any::<Index>(), any::<Index>(), any::<Index>());
    let counts = std::cell::Cell::new((0_usize, 0_usize));
    let result = runner.run(&cases, |(shape, dialect, what, route, index, other)| {
        let station = station(&shape);
        let text = written(&station, Version::V31, &dialect);
        let route = route.index(station.routes.len());
        let Some(false_text) = falsify(&text, route, what, index, other) else { return Ok(()) };
        let imported = import(&false_text)?;
        let wanted = expected(&model(&station), &dialect);
        let found = found(&imported)?;
        let (left_out, kept) = counts.get();
        counts.set(if found.len() < wanted.len() { (left_out + 1, kept) } else { (left_out, kept + 1) });
        for (name, course) in found {
            prop_assert_eq!(wanted.get(&name), Some(&course), "{:?} of route {}: {}", what, route, imported.report);
        }
        Ok(())
    });
    result.unwrap_or_else(|error| panic!("{error}"));
    let (left_out, kept) = counts.get();
    println!("{left_out} falsified routes were left out; in {kept} cases the layout is what it was");
    assert!(left_out > kept, "falsifications are seen");
}
