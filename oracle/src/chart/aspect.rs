//! The timing chart of aspect acceptance, in the manner of the patent's Figures 3, 6 and 7: for each aspect its
//! detection, what became of its loss (T2, T3), and its operate time (T1 or T5); at the foot the display.

use atc_kernel::aspect::{AspectId, AspectSet, MAX_ASPECTS, Parts, Times};

use super::scene::{Lane, Mark, Scene, Sign, Signal, Tone, Unit, Values};
use super::series::{changes, spans};
use crate::drawn::machine::Drawn;
use crate::trace::run::Cycle;
use atc_protocol::kmh::Kmh;
use atc_protocol::machine::Machine;
use atc_protocol::machine::aspect::{Aspect, Config};

/// One rank after one cycle.
#[expect(clippy::struct_excessive_bools, reason = "the kernel's own bits, taken apart")]
#[derive(Clone, Copy, PartialEq, Eq)]
struct Moment {
    heard: bool,
    run: u16,
    age: u16,
    accepted: bool,
    dropped: bool,
    credit: bool,
}

/// What an aspect is doing, as a waveform viewer names it.
fn name(moment: Moment, times: Times) -> &'static str {
    match moment {
        Moment { dropped: true, .. } => "dropped",
        Moment { accepted: true, age: 0, .. } => "accepted",
        Moment { accepted: true, age, .. } if age < times.recovery().0 => "recovery",
        Moment { accepted: true, .. } => "masked",
        Moment { run: 0, .. } => "none",
        Moment { credit: true, .. } => "operating_T5",
        _ => "operating_T1",
    }
}

impl Drawn for Aspect {
    fn chart(config: &Config, cycles: &[Cycle<Self>]) -> Scene {
        scene(config, cycles)
    }
}

/// Lays out a case.
fn scene(config: &Config, cycles: &[Cycle<Aspect>]) -> Scene {
    let unit = Unit { axis: "time", name: "ms", per_cycle: config.cycle_ms };
    let end = cycles.len() as u64;
    let mut scene = Scene::of(Aspect::NAME, unit, end);
    // A trace is laid out only after the kernel has taken its configuration and every step.
    let Ok(mut machine) = Aspect::open(config) else { return scene };
    let times = machine.times();
    let mut history: Vec<(AspectSet, Parts<MAX_ASPECTS>)> = Vec::with_capacity(cycles.len());
    for cycle in cycles {
        let detected = machine.detected(&cycle.step).unwrap_or_default();
        if machine.step(&cycle.step).is_ok() {
            history.push((detected, machine.state().parts()));
        }
    }
    scene.notes = notes(config, times);
    let displays: Vec<_> = cycles.iter().map(|cycle| cycle.output.display_km_h).collect();
    let recorded: Vec<_> =
        cycles.iter().map(|cycle| cycle.recorded.map_or(cycle.output.display_km_h, |said| said.display_km_h)).collect();

    for (rank, speed) in config.aspects_km_h.iter().enumerate().rev() {
        let moments: Vec<_> = history.iter().map(|entry| moment(entry, rank, times)).collect();
        if moments.iter().any(|moment| moment.heard) {
            scene.lanes.extend(lanes(*speed, &moments, times, unit));
        }
        scene.signals.extend(signals(*speed, &moments, times));
    }
    scene.lanes.push(display_lane("display", &displays, &displays, unit));
    scene.signals.extend(display_signals("display", &displays));
    scene.guides = changes(&displays).into_iter().skip(1).map(|(at, _)| at + 1).collect();
    if displays.first().is_some_and(Option::is_some) {
        scene.guides.insert(0, 1);
    }
    scene.legend = vec![
        (Tone::Signal, "heard / displayed"),
        (Tone::Operate, "operate T1"),
        (Tone::Shortened, "shortened operate T5"),
        (Tone::Recovery, "recovery T2"),
        (Tone::Mask, "no-signal mask T3"),
        (Tone::Dropped, "dropped"),
    ];
    let differ = spans(displays.iter().zip(&recorded).map(|(kernel, said)| kernel != said));
    // An output stands from the end of its cycle on.
    scene.differences = differ.into_iter().filter(|span| span.2).map(|(from, to, _)| (from + 1, to + 1)).collect();
    if !scene.differences.is_empty() {
        scene.lanes.push(display_lane("display as recorded", &recorded, &displays, unit));
        scene.signals.extend(display_signals("display_as_recorded", &recorded));
        scene.legend.push((Tone::Difference, "differs from the kernel"));
        let (from, _) = scene.differences[0];
        scene.notes.push(format!("THE RECORD DIFFERS FROM THE KERNEL, first at {}.", unit.text(from)));
    }
    scene
}

fn notes(config: &Config, times: Times) -> Vec<String> {
    let limit = if config.interruption_ms / config.cycle_ms.max(1) > times.interruption().0.into() {
        format!(
            "{} ms (acts as {} ms)",
            config.interruption_ms,
            u64::from(times.interruption().0) * u64::from(config.cycle_ms)
        )
    } else {
        format!("{} ms", u64::from(times.interruption().0) * u64::from(config.cycle_ms))
    };
    let ms = |cycles: u16| u64::from(cycles) * u64::from(config.cycle_ms);
    let mask = times.expiry().0 - times.recovery().0;
    vec![
        format!(
            "Operate T1 {} ms, recovery T2 {} ms, no-signal mask T3 {} ms, interruption limit T4 {limit}, shortened operate T5 {} ms; cycle {} ms.",
            ms(times.operate().0),
            ms(times.recovery().0),
            ms(mask),
            ms(times.shortened_operate().0),
            config.cycle_ms,
        ),
        format!(
            "A signal is drawn over the cycles in which it was heard; the display stands from the end of the cycle on. Longest interruption tolerated: {} ms.",
            ms(times.tolerated_interruption().0)
        ),
    ]
}

fn moment((detected, parts): &(AspectSet, Parts<MAX_ASPECTS>), rank: usize, times: Times) -> Moment {
    let bit = |bits: u16| bits >> rank & 1 == 1;
    let heard = u8::try_from(rank).ok().and_then(AspectId::new).is_some_and(|aspect| detected.contains(aspect));
    let (run, age, accepted) = (parts.run[rank], parts.age[rank], bit(parts.accepted));
    let lost = accepted && age > 0;
    // While lost the credit is in age and run, afterwards in a bit of its own.
    let credit = if lost { run > 0 && age - run <= times.interruption().0 } else { bit(parts.credited) };
    Moment { heard, run, age, accepted, dropped: bit(parts.dropped), credit }
}

fn lanes(speed: Kmh, moments: &[Moment], times: Times, unit: Unit) -> [Lane; 3] {
    let heard: Vec<_> = spans(moments.iter().map(|moment| moment.heard));
    let mut detection = vec![Mark::Wave(heard.iter().filter(|span| span.2).map(|span| (span.0, span.1)).collect())];
    // The silence between two detections is what the times are measured against.
    for (place, (from, to, heard_here)) in heard.iter().enumerate() {
        if !heard_here && place > 0 && place + 1 < heard.len() {
            detection.push(Mark::Dimension { from: *from, to: *to, text: unit.text(to - from) });
        }
    }
    [
        Lane { label: format!("{speed} km/h heard"), first: true, height: 34, marks: detection },
        Lane { label: "lost for".to_owned(), first: false, height: 24, marks: loss(moments, times, unit) },
        Lane { label: "operate time".to_owned(), first: false, height: 24, marks: operation(moments, times, unit) },
    ]
}

/// The bars of T2 and T3, and what ended them.
fn loss(moments: &[Moment], times: Times, unit: Unit) -> Vec<Mark> {
    let mut marks = Vec::new();
    let phase = |moment: &Moment| match moment {
        Moment { accepted: true, dropped: true, .. } => Some(Tone::Dropped),
        Moment { accepted: true, age, .. } if *age > 0 && *age < times.recovery().0 => Some(Tone::Recovery),
        Moment { accepted: true, age, .. } if *age > 0 => Some(Tone::Mask),
        _ => None,
    };
    let recovery = u64::from(times.recovery().0);
    let mask = u64::from(times.expiry().0) - recovery;
    for (from, to, tone) in spans(moments.iter().map(phase)) {
        let Some(tone) = tone else { continue };
        // The state after cycle k holds at its end, k+1: a loss that begins in cycle k has age 1 there. So the bar
        // of T2 begins with the cycle itself, and what follows it begins where the state does.
        let start = if tone == Tone::Recovery { from } else { from + 1 };
        if tone != Tone::Recovery && recovery == 1 && usize::try_from(from).is_ok_and(|at| moments[at].age == 1) {
            marks.push(Mark::Bar {
                from,
                to: start,
                tone: Tone::Recovery,
                texts: vec![format!("T2 {}", unit.text(1))],
            });
        }
        let last = to == moments.len() as u64;
        let stop = if last { to } else { to + 1 };
        if start >= stop {
            continue;
        }
        let length = stop - start;
        let of = |name: &str, full: u64| {
            if length >= full {
                vec![format!("{name} {}", unit.text(full)), name.to_owned()]
            } else {
                let measured = unit.text(length);
                vec![
                    format!("{name}: {measured} of {}", unit.value(full)),
                    format!("{name}: {measured}"),
                    name.to_owned(),
                ]
            }
        };
        let texts = match tone {
            Tone::Recovery => of("T2", recovery),
            Tone::Mask => of("T3", mask),
            _ => vec![format!("dropped {}", unit.text(length)), "dropped".to_owned()],
        };
        marks.push(Mark::Bar { from: start, to: stop, tone, texts });
        let after = usize::try_from(to).ok().and_then(|next| moments.get(next));
        if after.is_some_and(|next| !next.accepted) {
            marks.push(Mark::Sign { at: stop, sign: Sign::Gone });
        }
    }
    marks
}

/// The bars of T1 or T5, and the acceptances.
fn operation(moments: &[Moment], times: Times, unit: Unit) -> Vec<Mark> {
    let mut marks = Vec::new();
    let firm = |moment: &Moment| moment.accepted && moment.age == 0;
    for (from, to, heard) in spans(moments.iter().map(|moment| moment.heard)) {
        if !heard {
            continue;
        }
        let (Ok(first), Ok(last)) = (usize::try_from(from), usize::try_from(to)) else { continue };
        let accepted = moments[first..last].iter().zip(from..).find(|(moment, _)| firm(moment)).map(|(_, at)| at);
        let stop = accepted.map_or(to, |at| at + 1);
        let credit = match accepted {
            Some(_) => stop - from < u64::from(times.operate().0),
            None => moments[last - 1].credit,
        };
        let (name, tone, full) = if credit {
            ("T5", Tone::Shortened, times.shortened_operate().0)
        } else {
            ("T1", Tone::Operate, times.operate().0)
        };
        let mut texts = if accepted.is_some() {
            vec![format!("{name} {}", unit.text(stop - from)), name.to_owned()]
        } else {
            let measured = unit.text(stop - from);
            vec![
                format!("{name}: {measured} of {}", unit.value(full.into())),
                format!("{name}: {measured}"),
                name.to_owned(),
            ]
        };
        // Why it is this time and not the other: the interruption against T4.
        if let Moment { accepted: true, age, run, .. } = moments[first]
            && age > 0
        {
            let limit = if credit { "≤ T4" } else { "> T4" };
            texts.insert(0, format!("{}, after {} {limit}", texts[0], unit.text(u64::from(age - run))));
        }
        marks.push(Mark::Bar { from, to: stop, tone, texts });
        if accepted.is_some() {
            marks.push(Mark::Sign { at: stop, sign: Sign::Accepted });
        }
    }
    marks
}

/// What is displayed; where it is not what the kernel displays, that shows.
fn display_lane(label: &str, displays: &[Option<Kmh>], kernel: &[Option<Kmh>], unit: Unit) -> Lane {
    let end = displays.len() as u64;
    // Before the first output nothing is displayed; the last output is at the end of the chart.
    let said = displays.iter().zip(kernel).map(|(said, kernel)| (*said, said != kernel));
    let shown = std::iter::once((None, false)).chain(said).take(displays.len());
    let mut marks = Vec::new();
    for (from, to, (speed, differs)) in spans(shown) {
        let (tone, text) = match speed {
            Some(speed) => (Tone::Signal, format!("{speed} km/h")),
            None => (Tone::Blank, "no display".to_owned()),
        };
        let tone = if differs { Tone::Difference } else { tone };
        let short = speed.map(|speed| speed.to_string());
        marks.push(Mark::Bar { from, to, tone, texts: std::iter::once(text).chain(short).collect() });
        // What is still so at the end of the chart has not been measured.
        if from > 0 && to < end {
            marks.push(Mark::Dimension { from, to, text: unit.text(to - from) });
        }
    }
    Lane { label: label.to_owned(), first: true, height: 56, marks }
}

fn signals(speed: Kmh, moments: &[Moment], times: Times) -> [Signal; 3] {
    // A viewer takes a dot in a name for a step in the hierarchy.
    let id = speed.to_string().replace('.', "_");
    let after = |value: fn(Moment) -> f64| {
        let mut all = vec![(0, Some(0.0))];
        all.extend(
            changes(moments.iter().map(|moment| Some(value(*moment)))).into_iter().map(|(at, age)| (at + 1, age)),
        );
        all
    };
    let states = std::iter::once("none").chain(moments.iter().map(|moment| name(*moment, times)));
    [
        Signal {
            name: format!("heard_{id}_km_h"),
            values: Values::Wire(changes(moments.iter().map(|moment| moment.heard))),
        },
        Signal {
            name: format!("state_{id}_km_h"),
            values: Values::State(changes(states).into_iter().map(|(at, name)| (at, name.to_owned())).collect()),
        },
        Signal { name: format!("lost_cycles_{id}_km_h"), values: Values::Real(after(|moment| moment.age.into())) },
    ]
}

fn display_signals(label: &str, displays: &[Option<Kmh>]) -> [Signal; 2] {
    let shown = || std::iter::once(None).chain(displays.iter().copied());
    let text = |speed: Option<Kmh>| speed.map_or("none".to_owned(), |speed| format!("{speed}_km/h"));
    let number = |speed: Option<Kmh>| speed.map(|speed| f64::from(speed.0) / 10.0);
    [
        Signal {
            name: label.to_owned(),
            values: Values::State(changes(shown()).into_iter().map(|(at, speed)| (at, text(speed))).collect()),
        },
        Signal {
            name: format!("{label}_km_h"),
            values: Values::Real(changes(shown()).into_iter().map(|(at, speed)| (at, number(speed))).collect()),
        },
    ]
}
