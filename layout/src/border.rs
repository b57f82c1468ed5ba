//! The border of two stations: what each sees of the line between them, held against each other.
//!
//! A stretch that neither sees may have a train on it that both think is not there: both send. A stretch that both see is a circuit of the
//! same name in both files.

use std::collections::BTreeMap;
use std::fmt::{Display, Formatter, Result as Written};

use atc_kernel::distance::Metres;
use atc_kernel::interlocking::SpeedCode;
use atc_kernel::time::Ticks;

use crate::derive::values::run_ms;
use crate::description::Description;
use crate::form::EndKind;
use crate::model::{Model, Route, Segment};
use crate::problem::{Errors, Problem};
use crate::rule::Rule;

/// A line between two stations whose views of it meet or overlap.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Border {
    /// The name that both stations give the line.
    pub line: String,
    /// The circuits that the first station sees, outward from it.
    pub first: Vec<String>,
    /// The circuits that the second station sees, outward from it.
    pub second: Vec<String>,
    /// The circuits that both see, outward from the first.
    pub shared: Vec<String>,
}

impl Display for Border {
    fn fmt(&self, f: &mut Formatter<'_>) -> Written {
        let shared = if self.shared.is_empty() { "none".to_owned() } else { self.shared.join(", ") };
        write!(f, "line {}: one sees {}, the other {}; ", self.line, self.first.join(", "), self.second.join(", "))?;
        write!(f, "both see: {shared}; no stretch is seen by neither")
    }
}

/// A station as it is compared: its file and its model.
type Station<'a> = (&'a Description, &'a Model);

/// Holds the views that two stations have of the lines that both name against each other.
///
/// # Errors
/// That they have no line in common, and for each line in common what does not agree: with its place in the file of the first station, and
/// what would be right.
pub fn compare(first: Station<'_>, second: Station<'_>) -> Result<Vec<Border>, Errors> {
    let mut problems = Vec::new();
    let mut borders = Vec::new();
    for (number, segment) in first.1.segments.iter().enumerate() {
        let there = |other: &Segment| other.line.is_some() && other.line == segment.line;
        let Some(other) = second.1.segments.iter().position(there) else { continue };
        let before = problems.len();
        line((first, number), (second, other), &mut problems);
        if problems.len() == before {
            borders.push(border(first.1, segment, second.1, &second.1.segments[other]));
        }
    }
    unmatched(first, second, &mut problems);
    if borders.is_empty() && problems.is_empty() {
        let lines = |(description, model): Station<'_>| {
            let named: Vec<&str> = model.segments.iter().filter_map(|segment| segment.line.as_deref()).collect();
            let named = if named.is_empty() { "none".to_owned() } else { named.join(", ") };
            format!("{}: {named}", description.station.name)
        };
        let what = format!("the stations name no line in common ({}; {})", lines(first), lines(second));
        let right = "give the two segments of a line the same line = \"…\"";
        problems.push(Problem::new(Rule::ViewsApart, &(0..0), what, right));
    }
    if problems.is_empty() { Ok(borders) } else { Err(Errors::new(&first.0.source, problems)) }
}

/// The lines that one of two stations names and the other does not: of these nothing is compared. In words.
pub fn not_compared((one, model): Station<'_>, (two, other_model): Station<'_>) -> Vec<String> {
    let told = |(description, model): Station<'_>, (other, others): Station<'_>| -> Vec<String> {
        let lines = model.segments.iter().filter_map(|segment| alone(segment, others));
        let (here, there) = (&description.station.name, &other.station.name);
        lines.map(|line| format!("line {line} of {here}: {there} names no such line, and it is not compared")).collect()
    };
    [told((one, model), (two, other_model)), told((two, other_model), (one, model))].concat()
}

/// The line of a segment, if no segment there is of it.
fn alone<'a>(segment: &'a Segment, there: &Model) -> Option<&'a str> {
    let line = segment.line.as_deref()?;
    there.segments.iter().all(|other| other.line.as_deref() != Some(line)).then_some(line)
}

/// A line that each names in its own way: nothing would be compared. That both share a circuit of one name, or that both views end at one joint, says
/// that one line is meant.
fn unmatched((description, model): Station<'_>, (its, its_model): Station<'_>, problems: &mut Vec<Problem>) {
    for (number, segment) in model.segments.iter().enumerate() {
        for other in &its_model.segments {
            let (Some(line), Some(its_line)) = (alone(segment, its_model), alone(other, model)) else { continue };
            let (mine, theirs) = (shared(model, segment), shared(its_model, other));
            let meet = outer_end(model, segment).is_some_and(|end| outer_end(its_model, other) == Some(end));
            let why = if let Some(both) = mine.iter().find(|name| theirs.contains(name)) {
                format!("both see {both}")
            } else if meet {
                "both views end at one joint".to_owned()
            } else {
                continue;
            };
            let (here, there) = (&description.station.name, &its.station.name);
            let what = format!(
                "{here} has a line {line}, and {there} a line {its_line}: {why}, and lines are compared by their names"
            );
            let given = &description.station.segments[number];
            let span = given.line.as_ref().map_or(&segment.span, |line| &line.span);
            let right = "give the two segments of a line the same line = \"…\"; if they are two lines, give circuits and joints names of their own";
            problems.push(Problem::new(Rule::ViewsApart, span, what, right));
        }
    }
}

fn names<'a>(model: &'a Model, circuits: &[usize]) -> Vec<&'a str> {
    circuits.iter().map(|circuit| model.circuits[*circuit].name.as_str()).collect()
}

fn shared<'a>(model: &'a Model, segment: &Segment) -> Vec<&'a str> {
    names(model, &segment.circuits[segment.circuits.len().saturating_sub(segment.shared)..])
}

fn border(model: &Model, segment: &Segment, other_model: &Model, other: &Segment) -> Border {
    let owned = |names: Vec<&str>| names.into_iter().map(str::to_owned).collect();
    Border {
        line: segment.line.clone().unwrap_or_default(),
        first: owned(names(model, &segment.circuits)),
        second: owned(names(other_model, &other.circuits)),
        shared: owned(shared(model, segment)),
    }
}

/// The joint at which the view of a segment ends; none if no track goes on there.
pub fn outer_end<'a>(model: &'a Model, segment: &Segment) -> Option<&'a str> {
    let outermost = *segment.circuits.last()?;
    let ends = |joint: &usize| model.graph.joints[*joint].end == Some(EndKind::Line);
    let joint = model.graph.borders(outermost).into_iter().find(ends)?;
    Some(&model.graph.joints[joint].name)
}

fn line((one, number): (Station<'_>, usize), (two, number_there): (Station<'_>, usize), problems: &mut Vec<Problem>) {
    let ((description, model), (other_description, other_model)) = (one, two);
    let (segment, given) = (&model.segments[number], &description.station.segments[number]);
    let other = &other_model.segments[number_there];
    let (here, there) = (&description.station.name, &other_description.station.name);
    let span = given.line.as_ref().map_or(&segment.span, |line| &line.span);
    let mut wrong = |what: String, right: String| problems.push(Problem::new(Rule::ViewsApart, span, what, right));
    let (mine, its) = (shared(model, segment), shared(other_model, other));
    let listed = |names: &[&str]| if names.is_empty() { "none".to_owned() } else { names.join(", ") };
    if !mine.iter().eq(its.iter().rev()) {
        let what = format!("{here} shares {} with its neighbour, and {there} shares {}", listed(&mine), listed(&its));
        wrong(what, "list the circuits that both see in both files: each from its own station outward".to_owned());
    } else if mine.is_empty() {
        let (end, its_end) = (outer_end(model, segment), outer_end(other_model, other));
        if end.is_none() || end != its_end {
            let name = |end: Option<&str>| end.map_or_else(|| "no joint".to_owned(), |end| format!("joint {end}"));
            let what = format!(
                "the view of {here} ends at {}, that of {there} at {}: a train between them is seen by neither",
                name(end),
                name(its_end)
            );
            wrong(what, "list circuits that both see as shared, or end both views at one joint".to_owned());
        }
    }
    for name in &mine {
        let length = |model: &Model| {
            let named = model.circuits.iter().find(|circuit| circuit.name == *name);
            named.map_or(0, |circuit| circuit.length.0)
        };
        if length(model) != length(other_model) {
            let what = format!("{name} is {} m long here and {} m in {there}", length(model), length(other_model));
            wrong(what, "give the same circuit the same length".to_owned());
        }
    }
    let speed = |model: &Model, segment: &Segment| model.values.speeds_kmh[usize::from(segment.speed.0)];
    let (speed, its_speed) = (speed(model, segment), speed(other_model, other));
    if speed != its_speed {
        let what = format!(
            "trains run at {speed} km/h here and at {its_speed} in {there}, and a tail may lie across the border"
        );
        wrong(what, format!("give both segments a speed_kmh of {}", speed.min(its_speed)));
    }
    let (table, its_table) = (model.values.speeds_kmh, other_model.values.speeds_kmh);
    if table != its_table {
        let what =
            format!("the codes mean {table:?} km/h in {here} and {its_table:?} in {there}, and a train has one table");
        wrong(what, "give both files the same speeds_kmh".to_owned());
    }
    if segment.outward == other.outward {
        let what = format!("the line leads out to the same side in {here} and in {there}");
        wrong(what, "change left and right over in one of the files: a telegram says left or right".to_owned());
    }
    times(one, two, &mut wrong);
    times(two, one, &mut wrong);
    heard((one, number), (two, number_there), &mut wrong);
    heard((two, number_there), (one, number), &mut wrong);
    let longest = longest_train(model, other_model);
    tails(one, number, longest, &mut wrong);
    tails(two, number_there, longest, &mut wrong);
}

/// What the device of one station counts on, held against the trains that its neighbour sends: what a station's own layout says of its own trains.
fn times((description, model): Station<'_>, (its, its_model): Station<'_>, wrong: &mut impl FnMut(String, String)) {
    let (station, neighbour) = (&description.station.name, &its.station.name);
    let (values, its_values) = (&model.values, &its_model.values);
    let turn = values.ms(values.turn);
    let (lives, runs, loss) =
        (&its.station.times.telegram_age_ms, &its_values.residual_ms, &its.station.times.shunt_loss_ms);
    // It is lost in the circuits of either; and what the neighbour's device says stands until its next cycle.
    let (lost, cycle) = (
        loss.value.max(description.station.times.shunt_loss_ms.value),
        its_values.cycle_ms.saturating_sub(values.cycle_ms),
    );
    let least = run_ms(lives.value, runs.value, lost).saturating_add(cycle);
    let late = if cycle == 0 { String::new() } else { format!(", a cycle there is {cycle} ms longer") };
    if turn <= lives.value {
        let what =
            format!("{station} turns the line after {turn} ms, and telegrams in {neighbour} live for {lives} ms");
        wrong(what, format!("turn_ms of {station} must be more than {lives}"));
    } else if turn < least {
        let what = format!(
            "{station} turns the line and confirms blocks on it after {turn} ms, and a train of {neighbour} may run in for {least} ms: telegrams \
             live for {lives} ms, it runs on for {runs} ms, and may be lost for {lost} ms{late}"
        );
        wrong(what, format!("turn_ms of {station} must be at least {least}"));
    }
    // Approaches, release times, stays and the distances of the codes follow from these two.
    let (brake, its_brake) = (&description.station.braking.deceleration_mm_s2, &its.station.braking.deceleration_mm_s2);
    if its_brake.value < brake.value {
        let what = format!(
            "trains of {neighbour} brake with {its_brake} mm/s², and {station} counts on {brake} for distances"
        );
        wrong(what, format!("deceleration_mm_s2 of {station} must be at most {its_brake}"));
    }
    let own = values.residual_ms.value;
    if own < runs.value {
        let what =
            format!("trains of {neighbour} run on for {runs} ms, and {station} counts on {own} ms for its routes");
        wrong(what, format!("residual_ms of {station} must be at least {runs}"));
    }
    let (start, least) = (values.ms(values.start), run_ms(lives.value, runs.value, 0).saturating_add(cycle));
    if start < least && description.station.times.start_protected.is_none() {
        let what = format!(
            "after a start of {station} nothing moves for {start} ms, and a train of {neighbour} may run on for {least} ms: telegrams live for \
             {lives} ms, and it runs on for {runs} ms{late}"
        );
        let right =
            format!("start_ms of {station} must be at least {least}, or start_protected say why every train stands");
        wrong(what, right);
    }
    let clear = values.ms(Ticks(values.clear.into()));
    let least = loss.value.saturating_mul(2);
    if clear < least {
        let what = format!(
            "in {station} a circuit counts as clear after {clear} ms, and a train of {neighbour} may be lost for {loss} ms"
        );
        wrong(what, format!("clear_ms of {station} must be at least {least}: twice that"));
    }
}

/// How long trains act on what they heard, and how far beyond its circuit they hear a code. The distances of the codes and the approaches follow from
/// these: a train of which more is true than they hold comes too far. It is asked of a station to which the neighbour sends trains over this line.
fn heard(
    ((description, model), number): (Station<'_>, usize),
    ((its, its_model), number_there): (Station<'_>, usize),
    wrong: &mut impl FnMut(String, String),
) {
    let comes = model.routes.iter().any(|route| route.from == Some(number))
        || its_model.routes.iter().any(|route| route.to == Some(number_there));
    let (station, neighbour) = (&description.station.name, &its.station.name);
    // The room to stop is proved for trains whose codes all count with one brake (T-ATC-8): a weaker one makes the distance of a low code shorter.
    let (brake, its_brake) = (model.values.brake_mm_s2, its_model.values.brake_mm_s2);
    if comes && brake != its_brake {
        let what = format!(
            "on its steepest fall {station} counts on {brake} mm/s² of a train's brake, and {neighbour}, whose trains come in, on {its_brake}"
        );
        let right = "deceleration_mm_s2 and the steepest gradient of the two must leave the same brake: give the steeper fall, or the weaker brake, in both";
        wrong(what, right.to_owned());
    }
    // The rear of its routes begins at the entry: whoever waits on the approach for the signal is not looked for there.
    if comes && description.station.cab_signalled && !its.station.cab_signalled {
        let what = format!(
            "{station} counts on trains that act on telegrams alone, and trains of {neighbour}, which come in, may go by signals"
        );
        let right =
            format!("leave cab_signalled out in {station}, or say it in {neighbour} if it is so of all its trains");
        wrong(what, right);
    }
    let (age, lives) = (&description.station.times.telegram_age_ms, &its.station.times.telegram_age_ms);
    if comes && age.value < lives.value {
        let what = format!(
            "trains of {neighbour} act on telegrams and codes for {lives} ms, and {station} counts on {age} ms for distances"
        );
        wrong(what, format!("telegram_age_ms of {station} must be at least {lives}"));
    }
    let (ours, stronger) = (model.values.strongest_mm_s2, its_model.values.strongest_mm_s2);
    if comes && ours < stronger {
        let what = format!(
            "trains of {neighbour} may come from telegrams with a pattern of {stronger} mm/s², and {station} counts on at most {ours} for the distances \
             of codes"
        );
        wrong(what, format!("strongest_mm_s2 of {station} must be at least {stronger}"));
    }
    // What is from antenna to nose comes with the train.
    let (beyond, theirs) = (&description.station.braking.heard_beyond_m, &its.station.braking.heard_beyond_m);
    if comes && beyond.value < theirs.value {
        let what = format!(
            "{neighbour} counts on trains that hear codes {theirs} m beyond their circuits, and {station} counts on {beyond} m for distances"
        );
        wrong(what, format!("heard_beyond_m of {station} must be at least {theirs}"));
    }
    if comes {
        trains((description, neighbour), its, wrong);
    }
}

/// How long the neighbour's trains are, and for how long they may be lost: approaches, releases, overlaps and the least length of a circuit follow from it.
fn trains((description, neighbour): (&Description, &str), its: &Description, wrong: &mut impl FnMut(String, String)) {
    let station = &description.station.name;
    let (loss, theirs) = (description.station.times.shunt_loss_ms.value, its.station.times.shunt_loss_ms.value);
    if loss < theirs {
        let what = format!("trains of {neighbour} may be lost for {theirs} ms, and {station} counts on {loss} ms");
        wrong(what, format!("shunt_loss_ms of {station} must be at least {theirs}"));
    }
    let lengths = |given: &Description| {
        let length = |length: &Option<crate::At<u16>>| length.as_ref().map(|length| length.value);
        (length(&given.station.longest_train_m), length(&given.station.shortest_train_m))
    };
    let ((longest, shortest), (its_longest, its_shortest)) = (lengths(description), lengths(its));
    if let Some((longest, theirs)) = longest.zip(its_longest).filter(|(longest, theirs)| longest < theirs) {
        let what = format!("trains of {neighbour} are up to {theirs} m long, and {station} counts on {longest} m");
        wrong(what, format!("longest_train_m of {station} must be at least {theirs}"));
    }
    if let Some(shortest) = shortest.filter(|shortest| its_shortest.unwrap_or(0) < *shortest) {
        let theirs = its_shortest.map_or_else(
            || "does not say how short its trains are".to_owned(),
            |theirs| format!("has trains of {theirs} m"),
        );
        let what = format!("{station} counts on trains of at least {shortest} m, and {neighbour} {theirs}");
        wrong(what, format!("give {neighbour} shortest_train_m = {shortest} if it is so, or {station} less"));
    }
}

/// The length of the longest train of two stations; none if a file does not say.
fn longest_train(one: &Model, other: &Model) -> Option<Metres> {
    Some(one.values.longest_train?.max(other.values.longest_train?))
}

/// A train that the neighbour's device speaks to has its tail in circuits of plain line, or nothing there is slower than the line: the neighbour
/// knows neither a station's points nor its routes.
fn tails(
    (description, model): Station<'_>,
    number: usize,
    longest: Option<Metres>,
    wrong: &mut impl FnMut(String, String),
) {
    let station = &description.station.name;
    let segment = &model.segments[number];
    let own = segment.circuits.len().saturating_sub(segment.shared);
    let unshared: u32 =
        segment.circuits[..own].iter().map(|circuit| u32::from(model.circuits[*circuit].length.0)).sum();
    if longest.is_some_and(|longest| u32::from(longest.0) <= unshared) {
        return;
    }
    let kmh = |code: SpeedCode| model.values.speeds_kmh[usize::from(code.0)];
    let line = kmh(segment.speed);
    let uses = |route: &&Route| route.is_sound() && (route.from == Some(number) || route.to == Some(number));
    // How far behind a nose that has just come into what both see each route ends: those that go out to the line, and what leads up to them.
    let mut behind: BTreeMap<usize, u32> = BTreeMap::new();
    let mut open: Vec<(usize, u32)> =
        model.routes.iter().enumerate().filter(|(_, route)| uses(route)).map(|(route, _)| (route, unshared)).collect();
    while let Some((route, metres)) = open.pop() {
        let covered = longest.is_some_and(|longest| u32::from(longest.0) <= metres);
        if covered || behind.get(&route).is_some_and(|known| *known <= metres) {
            continue;
        }
        behind.insert(route, metres);
        let ahead = &model.routes[route];
        let length: u32 = ahead.circuits().map(|circuit| u32::from(model.circuits[circuit].length.0)).sum();
        let leads = |other: &Route| other.is_sound() && other.exit == ahead.start && other.last() == Some(ahead.entry);
        let before = model.routes.iter().enumerate().filter(|(_, other)| leads(other));
        open.extend(before.map(|(other, _)| (other, metres.saturating_add(length))));
    }
    // A station may be shorter than a train: behind it is another line.
    let mut slow: Vec<(u16, String)> = Vec::new();
    for (route, metres) in &behind {
        let route = &model.routes[*route];
        slow.push((kmh(route.speed), format!("route {}", route.name)));
        let length: u32 = route.circuits().map(|circuit| u32::from(model.circuits[circuit].length.0)).sum();
        let reached = longest.is_none_or(|longest| u32::from(longest.0) > metres.saturating_add(length));
        // What the train has left is held by nobody: there the limit is that of every route over it, whichever way.
        let over = |other: &&Route| other.is_sound() && other.circuits().any(|circuit| circuit == route.entry);
        let here = model.routes.iter().filter(over).filter(|_| reached);
        slow.extend(
            here.map(|other| (kmh(other.speed), format!("route {}, over the circuit that it has left", other.name))),
        );
        if let Some(other) = route.from.filter(|other| *other != number && reached) {
            let other = &model.segments[other];
            slow.push((kmh(other.speed), format!("segment {}", other.name)));
        }
    }
    let Some((slow, place)) = slow.into_iter().min_by_key(|(slow, _)| *slow).filter(|(slow, _)| *slow < line) else {
        return;
    };
    let (train, right) = match longest {
        Some(Metres(longest)) => (
            format!("trains are up to {longest} m long"),
            format!("let {station} see {longest} m or more of the line alone"),
        ),
        None => ("not both files say how long trains are".to_owned(), "give longest_train_m in both files".to_owned()),
    };
    let what = format!(
        "{station} alone sees {unshared} m of the line, and {train}: the neighbour lets one run at {line} km/h whose tail is still in {place}, \
         which is for {slow}"
    );
    wrong(what, format!("{right}, or give the line a speed_kmh of {slow} in both files"));
}
