//! The film of an interlocking: a track plan with circuits, routes, signals and points, and what is asked, ordered and
//! told.

use atc_film::{Class, Film, Plan};
use atc_kernel::interlocking::{self as kernel, CircuitSet, PointSet, Position, SegmentSet, Size};

use super::take::Take;
use super::{inside, schematic, stage};
use atc_protocol::machine::Machine as _;
use atc_protocol::machine::interlocking::{Answer, Config, Interlocked, Output, Phase, Request, Sizes, Step, Travel};
use atc_protocol::machine::sizes::{self, Stationed as _};
use atc_protocol::names::Named as _;

/// A step: what was read, the state after it, and what was answered (as recorded, if it was).
struct Moment<'a, const R: usize, const S: usize, Z: Size> {
    step: &'a Step,
    state: kernel::State<R, S, Z>,
    said: &'a Output,
}

/// Lays out the film of an interlocking.
pub(crate) fn put(take: &Take<'_, Sizes>, film: &mut Film) -> Result<(), String> {
    if !take.config.is_large() {
        let machine = laid_out::<64, 16, 32, 8, kernel::Small>(take, film)?;
        return inside::put(take, &machine, film);
    }
    if take.setting.kernel.is_some() {
        return Err(
            "the kernel in a page takes small stations, of up to 64 circuits and routes: leave out --kernel".to_owned()
        );
    }
    let puts = || {
        laid_out::<{ sizes::ROUTES }, { sizes::PLACES }, { sizes::POINTS }, { sizes::SEGMENTS }, kernel::Large>(
            take, film,
        )
        .map(|_| ())
    };
    sizes::with_room(puts)?
}

/// Lays out what the page shows; the machine after the last step.
fn laid_out<const R: usize, const P: usize, const N: usize, const S: usize, Z: Size>(
    take: &Take<'_, Sizes>,
    film: &mut Film,
) -> Result<Interlocked<R, P, N, S, Z>, String> {
    let mut machine = Interlocked::open(take.config)?;
    let mut moments = Vec::with_capacity(take.cycles.len());
    for cycle in take.cycles {
        machine.step(&cycle.step)?;
        let said = cycle.recorded.as_ref().unwrap_or(&cycle.output);
        moments.push(Moment { step: &cycle.step, state: *machine.state(), said });
    }
    if take.setting.title.is_none() {
        film.title = format!("{}: interlocking", machine.names().station);
    }
    film.plans.push(plan(take, &machine)?);
    requests(film, &moments);
    circuits(film, &machine, &moments);
    routes(film, &machine, &moments);
    points(film, &machine, &moments);
    segments(film, &machine, &moments);
    tables(film);
    events(film);
    Ok(machine)
}

fn plan<const R: usize, const P: usize, const N: usize, const S: usize, Z: Size>(
    take: &Take<'_, Sizes>,
    machine: &Interlocked<R, P, N, S, Z>,
) -> Result<Plan, String> {
    if let Some(layout) = &take.setting.layout {
        return stage::fitting(layout, machine.names());
    }
    match take.config {
        Config::Layout(description) => stage::drawn(description),
        Config::Plan(_) => Ok(schematic::plan(machine)),
    }
}

fn requests<const R: usize, const S: usize, Z: Size>(film: &mut Film, moments: &[Moment<'_, R, S, Z>]) {
    let asked = |now: &Moment<'_, R, S, Z>| match now.step.request.as_ref() {
        None => String::new(),
        Some(Request::Set { set }) => format!("set {set}"),
        Some(Request::Withdraw { withdraw }) => format!("withdraw {withdraw}"),
        Some(Request::Drive { drive, to }) => format!("drive {drive} {}", to.name()),
        Some(Request::Turn { turn, to }) => format!("turn {turn} {}", to.name()),
    };
    let answered = |now: &Moment<'_, R, S, Z>| match &now.said.answer {
        None => String::new(),
        Some(Answer::Accepted(_)) => "accepted".to_owned(),
        Some(Answer::Refused(refused)) => {
            let because: Vec<_> = refused.because.iter().map(String::as_str).collect();
            format!("refused: {} {}", refused.refused.name(), because.join(", ")).trim_end().to_owned()
        }
    };
    let ordered = |now: &Moment<'_, R, S, Z>| {
        let orders = &now.step.orders;
        let mut parts = Vec::new();
        for (word, list) in [("block", &orders.block), ("unblock", &orders.unblock), ("lift", &orders.lift)] {
            if !list.is_empty() {
                parts.push(format!("{word} {}", list.join(", ")));
            }
        }
        for (circuit, speed) in &orders.restrict.0 {
            parts.push(format!("restrict {circuit} to {speed} km/h"));
        }
        parts.join("; ")
    };
    film.channel(("request", "request", "asked"), moments.iter().map(asked));
    film.channel(("request", "request", "answer"), moments.iter().map(answered));
    film.channel(("request", "orders", "asked"), moments.iter().map(ordered));
    for (frame, now) in (0..).zip(moments) {
        let (asked, answer) = (asked(now), answered(now));
        if !asked.is_empty() {
            film.event(frame, Class::Output, &format!("{asked}: {answer}"));
        }
    }
}

fn circuits<const R: usize, const P: usize, const N: usize, const S: usize, Z: Size>(
    film: &mut Film,
    machine: &Interlocked<R, P, N, S, Z>,
    moments: &[Moment<'_, R, S, Z>],
) {
    let plan = machine.layout().plan();
    let names = machine.names();
    // Who holds a circuit, and how: by its path before its overlap.
    let holder = |now: &Moment<'_, R, S, Z>, circuit: CircuitSet<Z>| {
        let mut found = (String::new(), "");
        let routes = names.routes.iter().zip(&plan.routes).zip(&now.state.routes);
        for ((name, route), state) in routes.filter(|(_, state)| state.is_held()) {
            if state.path(route).circuits.meets(circuit) {
                return (format!("{name}, {}", Phase(state.phase).name()), Phase(state.phase).name());
            }
            if state.overlap(route).circuits.meets(circuit) {
                found = (format!("overlap of {name}"), "overlap");
            }
        }
        found
    };
    for (number, name) in names.circuits.iter().enumerate() {
        let it = CircuitSet::nth(number);
        let word = |is: bool, word: &'static str| if is { word } else { "" };
        let reported = |now: &Moment<'_, R, S, Z>| word(now.step.occupied.contains(name), "occupied");
        let counted = |now: &Moment<'_, R, S, Z>| {
            let clear_for = now.state.track.clear_for().get(number).copied().unwrap_or(0);
            word(clear_for < plan.clear, "occupied")
        };
        film.channel(("circuit", name, "reported"), moments.iter().map(reported));
        film.channel(("circuit", name, "counted"), moments.iter().map(counted));
        film.channel(("circuit", name, "held"), moments.iter().map(|now| holder(now, it).0));
        film.channel(("circuit", name, "phase"), moments.iter().map(|now| holder(now, it).1));
        let blocked =
            |now: &Moment<'_, R, S, Z>| match (now.said.confirmed.contains(name), now.state.works.blocked.meets(it)) {
                (true, _) => "confirmed",
                (false, true) => "blocked",
                (false, false) => "",
            };
        film.channel(("circuit", name, "block"), moments.iter().map(blocked));
        let told = |now: &Moment<'_, R, S, Z>| {
            let Some(telegram) = now.said.telegrams.get(name).filter(|telegram| telegram.open) else {
                return String::new();
            };
            let way = telegram.heading.map_or("", |heading| match heading.0 {
                kernel::Heading::Left => "◀ ",
                kernel::Heading::Right => "▶ ",
            });
            format!("{way}to {} at {}", telegram.stop, telegram.speed_km_h)
        };
        film.channel(("circuit", name, "told"), moments.iter().map(told));
    }
}

fn routes<const R: usize, const P: usize, const N: usize, const S: usize, Z: Size>(
    film: &mut Film,
    machine: &Interlocked<R, P, N, S, Z>,
    moments: &[Moment<'_, R, S, Z>],
) {
    let names = machine.names();
    let shows = |now: &Moment<'_, R, S, Z>, route: &String| now.said.proceed.contains(route);
    for (name, signal) in names.routes.iter().zip(&names.signals) {
        let phase = |now: &Moment<'_, R, S, Z>| now.said.routes.get(name).map_or("", |phase| phase.name());
        film.channel(("route", name, "phase"), moments.iter().map(phase));
        let proceed =
            |now: &Moment<'_, R, S, Z>| if shows(now, name) { format!("proceed at {signal}") } else { String::new() };
        film.channel(("route", name, "signal"), moments.iter().map(proceed));
    }
    let mut seen = Vec::new();
    for signal in &names.signals {
        if seen.contains(&signal) {
            continue;
        }
        seen.push(signal);
        let any = |now: &Moment<'_, R, S, Z>| {
            let of = names.routes.iter().zip(&names.signals).filter(|(_, other)| *other == signal);
            if of.map(|(route, _)| route).any(|route| shows(now, route)) { "proceed" } else { "stop" }
        };
        film.channel(("signal", signal, "shows"), moments.iter().map(any));
    }
}

fn points<const R: usize, const P: usize, const N: usize, const S: usize, Z: Size>(
    film: &mut Film,
    machine: &Interlocked<R, P, N, S, Z>,
    moments: &[Moment<'_, R, S, Z>],
) {
    let plan = machine.layout().plan();
    for (number, name) in machine.names().points.iter().enumerate() {
        let detected =
            |now: &Moment<'_, R, S, Z>| now.step.detected.0.get(name).copied().flatten().map_or("none", |at| at.name());
        film.channel(("point", name, "detected"), moments.iter().map(detected));
        let driven = |now: &Moment<'_, R, S, Z>| now.said.drives.get(name).map_or("", |side| side.name());
        film.channel(("point", name, "driven"), moments.iter().map(driven));
        let it = PointSet::nth(number);
        let locked = |now: &Moment<'_, R, S, Z>| {
            let mut by = Vec::new();
            let routes = machine.names().routes.iter().zip(&plan.routes).zip(&now.state.routes);
            for ((route, of), state) in routes.filter(|(_, state)| state.is_held()) {
                let positions = state.positions(of);
                for (set, position) in [(positions.normal, Position::Normal), (positions.reverse, Position::Reverse)] {
                    if set.meets(it) {
                        let side = if position == Position::Normal { "normal" } else { "reverse" };
                        by.push(format!("{side} for {route}"));
                    }
                }
            }
            by.join(", ")
        };
        film.channel(("point", name, "locked"), moments.iter().map(locked));
    }
}

fn segments<const R: usize, const P: usize, const N: usize, const S: usize, Z: Size>(
    film: &mut Film,
    machine: &Interlocked<R, P, N, S, Z>,
    moments: &[Moment<'_, R, S, Z>],
) {
    for (number, name) in machine.names().segments.iter().enumerate() {
        let it = SegmentSet::nth(number);
        let direction = |now: &Moment<'_, R, S, Z>| {
            let directions = now.state.directions;
            match (directions.toward.meets(it), directions.away.meets(it)) {
                (true, _) => Travel(kernel::Travel::Toward).name(),
                (false, true) => Travel(kernel::Travel::Away).name(),
                (false, false) => "none",
            }
        };
        let yes = |is: bool| if is { "yes" } else { "" };
        film.channel(("segment", name, "direction"), moments.iter().map(direction));
        film.channel(("segment", name, "permit"), moments.iter().map(|now| yes(now.said.permits.contains(name))));
        film.channel(("segment", name, "consent"), moments.iter().map(|now| yes(now.step.consent.contains(name))));
    }
}

fn tables(film: &mut Film) {
    film.table("This step", "request", &[("asked", "asked"), ("answer", "answer")], true);
    film.table("Routes that are held", "route", &[("phase", "phase"), ("signal", "signal")], true);
    film.table("Points", "point", &[("detected", "detected"), ("driven", "driven to"), ("locked", "locked")], false);
    let circuit = [
        ("reported", "reported"),
        ("counted", "counted"),
        ("held", "held by"),
        ("told", "its train is told"),
        ("block", "block"),
    ];
    film.table("Circuits", "circuit", &circuit, true);
    let segment = [("direction", "direction"), ("permit", "neighbour may send"), ("consent", "neighbour permits")];
    film.table("Lines", "segment", &segment, false);
}

fn events(film: &mut Film) {
    let or = |word: &str, none: &str| if word.is_empty() { none.to_owned() } else { word.to_owned() };
    film.happenings(("route", "phase"), Class::Output, |name, word| {
        Some(format!("route {name}: {}", or(word, "idle")))
    });
    film.happenings(("signal", "shows"), Class::Output, |name, word| Some(format!("signal {name}: {word}")));
    film.happenings(("point", "driven"), Class::Output, |name, word| {
        Some(if word.is_empty() {
            format!("{name} is not driven any more")
        } else {
            format!("{name} driven to {word}")
        })
    });
    film.happenings(("segment", "permit"), Class::Output, |name, word| {
        Some(format!("the neighbour may {} into {name}", if word.is_empty() { "not send any more" } else { "send" }))
    });
    film.happenings(("segment", "direction"), Class::Output, |name, word| Some(format!("direction of {name}: {word}")));
    film.happenings(("circuit", "told"), Class::Output, |name, word| {
        Some(format!("a train in {name} is told: {}", or(word, "stop")))
    });
    film.happenings(("circuit", "block"), Class::Output, |name, word| {
        Some(format!("{name} {}", or(word, "not blocked")))
    });
    film.happenings(("circuit", "reported"), Class::Input, |name, word| {
        Some(format!("{name} reported {}", or(word, "clear")))
    });
    film.happenings(("point", "detected"), Class::Input, |name, word| Some(format!("{name} detected in {word}")));
    film.happenings(("segment", "consent"), Class::Input, |name, word| {
        Some(format!("consent of the neighbour for {name}{}", if word.is_empty() { " ends" } else { "" }))
    });
    film.happenings(("request", "asked"), Class::Input, |name, word| {
        (name == "orders" && !word.is_empty()).then(|| format!("orders: {word}"))
    });
}
