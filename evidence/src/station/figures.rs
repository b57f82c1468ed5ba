//! What the conditions on the ground mean at one station, in figures.

use atc_layout::form;
use atc_layout::model::{Guard, Model, Route, Segment};
use std::collections::BTreeSet;

/// Each assumption that has figures of the station, with them. The list of conditions itself is not here.
pub fn figures(station: &form::Station, model: &Model) -> Vec<(&'static str, String)> {
    let times = &station.times;
    let cycle = model.values.cycle_ms;
    let clear = u32::from(model.values.clear) * cycle;
    let turn = model.values.ms(model.values.turn);
    vec![
        (
            "loss-of-shunt-within-clear",
            format!(
                "No loss may last {clear} ms; to lose no train, none over {} ms. The file says: up to {} ms.",
                clear.saturating_sub(2 * cycle),
                times.shunt_loss_ms
            ),
        ),
        ("approach-covers-braking", approach(station, model)),
        (
            "codes-heard-beyond",
            format!("The distance of each code holds {} m beyond its circuit.", station.braking.heard_beyond_m),
        ),
        ("release-covers-residual-running", release(model, cycle)),
        ("overlap-covers-sliding", overlaps(model, cycle)),
        ("flank-complete", flanks(model)),
        (
            "fouling-declared",
            format!(
                "The file names {} beyond those at points; {} of routes are declared to conflict.",
                number(
                    station.fouling.len(),
                    "pair of circuits that foul each other",
                    "pairs of circuits that foul each other"
                ),
                number(model.routes.iter().map(|route| route.conflicts.len()).sum::<usize>() / 2, "pair", "pairs"),
            ),
        ),
        (
            "path-complete",
            format!(
                "{} over {} circuits: each to be run, with the circuits recorded.",
                number(model.routes.len(), "route", "routes"),
                model.routes.iter().flat_map(Route::circuits).collect::<BTreeSet<_>>().len()
            ),
        ),
        ("points-detect-truly", points(model)),
        ("points-leave-while-driven", format!("Commands live for one cycle: {cycle} ms.")),
        ("neighbour-turns-alike", segments(model)),
        ("trains-know-facing", format!("Left and right are those of the file of {}.", station.name)),
        ("views-of-a-line-meet", views(model)),
        (
            "turn-outlasts-telegrams",
            format!(
                "Plain line turns after {turn} ms; telegrams between the stations must not arrive later than that."
            ),
        ),
    ]
}

fn number(count: usize, one: &str, many: &str) -> String {
    format!("{count} {}", if count == 1 { one } else { many })
}

fn approach(station: &form::Station, model: &Model) -> String {
    let needed = model.routes.iter().map(|route| route.approach_m);
    let (Some(least), Some(most)) = (needed.clone().min(), needed.max()) else { return String::new() };
    let highest = model.values.speeds_kmh.iter().max().copied().unwrap_or(0);
    let fastest = station.speed.line_kmh.as_ref().map_or(highest, |speed| speed.value);
    let lost = (u64::from(fastest) * u64::from(station.times.shunt_loss_ms.value)).div_ceil(3600);
    let covers = if least == most { format!("{least} m") } else { format!("{least} to {most} m, by route") };
    format!(
        "The data check holds every approach against braking and telegram age: {covers}. It counts on telegrams on which no train acts for \
         longer than {} ms: with `--config` the trains of a line are held against that, without it compare them by hand. What a train runs while its shunt is \
         lost is not in it: {lost} m at {fastest} km/h, to be added by hand.",
        station.times.telegram_age_ms
    )
}

fn release(model: &Model, cycle: u32) -> String {
    let times = model.routes.iter().map(|route| u32::from(route.release.0) * cycle);
    match (times.clone().min(), times.max()) {
        (Some(least), Some(most)) if least == most => {
            format!(
                "{least} ms on every route, held against the stroke of the points only: compare it with the slowest train."
            )
        }
        (Some(least), Some(most)) => format!(
            "{least} to {most} ms, by route, held against the stroke of the points only: compare it with the slowest train."
        ),
        _ => String::new(),
    }
}

fn overlaps(model: &Model, cycle: u32) -> String {
    let length = |overlap: &[usize]| overlap.iter().map(|one| u32::from(model.circuits[*one].length.0)).sum::<u32>();
    let with: Vec<_> = model.routes.iter().filter(|route| !route.overlap.is_empty()).collect();
    let least = with.iter().map(|route| length(&route.overlap)).min();
    let stay = model.routes.iter().map(|route| u32::from(route.stay.0) * cycle).min().unwrap_or(0);
    let without: Vec<_> =
        model.routes.iter().filter(|route| route.overlap.is_empty()).map(|route| route.name.clone()).collect();
    let shortest = match least {
        Some(least) => format!("The shortest overlap is {least} m"),
        None => "No route has an overlap".to_owned(),
    };
    let missing = if without.is_empty() {
        String::new()
    } else {
        let names = crate::judge::verdict::list(&without, 40);
        format!(" Without an overlap (buffer stop, plain line, or a reason in the file): {names}.")
    };
    format!("{shortest}; the shortest stay time is {stay} ms.{missing}")
}

fn flanks(model: &Model) -> String {
    let routes = model.routes.iter().flat_map(|route| &route.flanks);
    let ends: BTreeSet<_> = routes
        .chain(model.segments.iter().flat_map(|segment| &segment.flanks))
        .filter(|flank| flank.guards.iter().any(|guard| matches!(guard, Guard::Declared(_))))
        .map(|flank| (flank.track, flank.end))
        .collect();
    match ends.len() {
        0 => "Every leg that a route does not use, and every track that one crosses, is protected by a point, a \
              buffer stop or the route itself."
            .to_owned(),
        count => format!(
            "{} not protected; the file gives a reason for each: see what is to be confirmed.",
            number(count, "end of a track beside a route is", "ends of tracks beside routes are")
        ),
    }
}

fn points(model: &Model) -> String {
    let names: Vec<_> = model.points.iter().map(|point| point.name.clone()).collect();
    if names.is_empty() {
        return "There are no points.".to_owned();
    }
    format!("{}: {}.", number(names.len(), "point to be tested", "points to be tested"), names.join(", "))
}

/// What each neighbour sees of the line, as the file says.
fn views(model: &Model) -> String {
    let view = |segment: &Segment| {
        let own = segment.circuits.len().saturating_sub(segment.shared);
        let shared: Vec<&str> =
            segment.circuits[own..].iter().map(|circuit| model.circuits[*circuit].name.as_str()).collect();
        let line = segment.line.as_deref().map_or("a line without a name".to_owned(), |line| format!("line {line}"));
        let shared = if shared.is_empty() { "no circuit".to_owned() } else { shared.join(", ") };
        format!("{}: {line}, the neighbour sees {shared} too", segment.name)
    };
    let views: Vec<String> = model.segments.iter().map(view).collect();
    if views.is_empty() { "There is no plain line.".to_owned() } else { format!("{}.", views.join("; ")) }
}

fn segments(model: &Model) -> String {
    let names: Vec<_> = model.segments.iter().map(|segment| segment.name.clone()).collect();
    if names.is_empty() {
        return "There is no plain line.".to_owned();
    }
    format!("{}: {}.", number(names.len(), "neighbour", "neighbours"), names.join(", "))
}
