//! The timing chart of block counting, in the manner of the patent's Figure 8: the checks and the detections, the two counts
//! as steps, whether they agree, and what is reported of each section and why.

use atc_kernel::block::{Parts, Status};

use super::record;
use super::scene::{Lane, Mark, Scene, Signal, Tone, Unit, Values};
use super::series::{changes, spans};
use crate::drawn::machine::Drawn;
use crate::trace::run::Cycle;
use atc_protocol::machine::Machine;
use atc_protocol::machine::block::{Config, Counted, Fault, Output};

/// Why a section is reported as it is.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Report {
    Free,
    Detected,
    Held,
    All,
}

impl Report {
    const fn name(self) -> &'static str {
        match self {
            Self::Free => "free",
            Self::Detected => "detected",
            Self::Held => "held",
            Self::All => "all",
        }
    }
}

/// The block after one cycle: what it put out, from what.
#[derive(Clone, Copy)]
struct Moment {
    parts: Parts,
    heard: u16,
    asked: u8,
    output: Output,
}

impl Moment {
    fn report(&self, section: u8) -> Report {
        match () {
            () if !self.output.occupied.0.contains(section) => Report::Free,
            () if !self.output.agree => Report::All,
            () if self.heard >> section & 1 == 1 => Report::Detected,
            () => Report::Held,
        }
    }

    fn heard_sections(&self) -> u8 {
        self.heard.count_ones().to_le_bytes()[0]
    }

    /// C2; none before it has been verified.
    fn count(&self) -> Option<u8> {
        (self.parts.status != Status::Unverified).then_some(self.parts.count)
    }

    fn status(&self) -> &'static str {
        match self.parts.status {
            Status::Unverified => "unverified",
            Status::Counting => "in force",
            Status::Fault(fault) => Fault::from(fault).name(),
        }
    }
}

impl Drawn for Counted {
    fn chart(config: &Config, cycles: &[Cycle<Self>]) -> Scene {
        scene(config, cycles)
    }
}

/// Lays out a case.
fn scene(config: &Config, cycles: &[Cycle<Counted>]) -> Scene {
    let unit = Unit { axis: "time", name: "ms", per_cycle: config.cycle_ms };
    let mut scene = Scene {
        legend: vec![
            (Tone::Detected, "occupied: detected"),
            (Tone::Held, "occupied: held for a tail"),
            (Tone::All, "occupied: all sections are"),
            (Tone::Pending, "pending check-outs"),
            (Tone::Dropped, "unverified"),
            (Tone::Emergency, "fault, reset refused"),
        ],
        ..Scene::of(Counted::NAME, unit, cycles.len() as u64)
    };
    // A trace is laid out only after the kernel has taken its configuration and every step.
    let Ok(mut machine) = Counted::open(config) else { return scene };
    let mut moments = Vec::with_capacity(cycles.len());
    for Cycle { step, output, .. } in cycles {
        if machine.step(step).is_ok() {
            let asked = u8::try_from(step.ahead_hold_sections).unwrap_or(u8::MAX);
            moments.push(Moment {
                parts: machine.state().parts(),
                heard: step.present.0.bits(),
                asked,
                output: *output,
            });
        }
    }
    let block = machine.block();
    scene.notes = vec![
        format!(
            "{} sections, at most {} trains, {} held behind every head; a check-in may stay on for {}; cycle {} ms.",
            block.sections(),
            block.max_trains().0,
            block.hold().sections(),
            unit.text(block.pass().0.into()),
            config.cycle_ms
        ),
        "Checks and detections are drawn over the cycles in which they were read; all else stands from the end of the cycle on. Section 0 is at the entry end.".to_owned(),
    ];
    scene.lanes = inputs(cycles, unit, block.sections());
    scene.lanes.extend(counts(&moments, unit, block.sections()));
    for section in 0..block.sections() {
        scene.lanes.push(report_lane(section, &moments, unit));
    }
    scene.lanes.extend(holds(&moments, config.tail_hold_sections));
    scene.signals = signals(cycles, &moments, block.sections());
    differences(&mut scene, cycles, &moments);
    scene.guides =
        changes(moments.iter().map(|moment| moment.output.agree)).iter().skip(1).map(|(at, _)| at + 1).collect();
    scene
}

/// What stands while the cycles run: `first` before the first output, then each output from the end of its cycle on.
fn standing<T: Clone>(first: T, outputs: impl Iterator<Item = T>) -> impl Iterator<Item = T> {
    std::iter::once(first).chain(outputs)
}

/// The checks, the resets and the detections.
fn inputs(cycles: &[Cycle<Counted>], unit: Unit, sections: u8) -> Vec<Lane> {
    let mut lanes = Vec::new();
    if cycles.iter().any(|cycle| cycle.step.reset.is_some()) {
        let mut marks = Vec::new();
        for (cycle, at) in cycles.iter().zip(0..) {
            if let Some(verified) = cycle.step.reset {
                let accepted = cycle.output.counting == Some(true);
                let (tone, said) = if accepted { (Tone::Signal, "accepted") } else { (Tone::Emergency, "refused") };
                let texts =
                    vec![format!("{verified} verified: {said}"), format!("{verified} {said}"), verified.to_string()];
                marks.push(Mark::Bar { from: at, to: at + 1, tone, texts });
            }
        }
        lanes.push(Lane { label: "reset".to_owned(), first: true, height: 26, marks });
    }
    lanes.extend(check("check-in", cycles, unit, |cycle| cycle.step.check_in));
    lanes.extend(check("check-out", cycles, unit, |cycle| cycle.step.check_out));
    let wave = |values: &mut dyn Iterator<Item = bool>| {
        vec![Mark::Wave(spans(values).into_iter().filter(|span| span.2).map(|span| (span.0, span.1)).collect())]
    };
    if cycles.iter().any(|cycle| !cycle.step.ahead_entered) {
        let marks = wave(&mut cycles.iter().map(|cycle| cycle.step.ahead_entered));
        lanes.push(Lane { label: "taken over ahead".to_owned(), first: false, height: 28, marks });
    }
    for section in 0..sections {
        let marks = wave(&mut cycles.iter().map(|cycle| cycle.step.present.0.contains(section)));
        lanes.push(Lane { label: format!("section {section} hears"), first: section == 0, height: 28, marks });
    }
    lanes
}

/// A check, and below it, if there are several trains, the time from each to the next.
fn check(label: &str, cycles: &[Cycle<Counted>], unit: Unit, level: fn(&Cycle<Counted>) -> bool) -> Vec<Lane> {
    let on: Vec<_> = spans(cycles.iter().map(level)).into_iter().filter(|span| span.2).collect();
    let marks = vec![Mark::Wave(on.iter().map(|span| (span.0, span.1)).collect())];
    let mut lanes = vec![Lane { label: label.to_owned(), first: true, height: 30, marks }];
    let headways = on.windows(2).map(|pair| {
        let (from, to) = (pair[0].0, pair[1].0);
        Mark::Dimension { from, to, text: unit.text(to - from) }
    });
    let marks: Vec<_> = headways.collect();
    if !marks.is_empty() {
        lanes.push(Lane { label: "headway".to_owned(), first: false, height: 24, marks });
    }
    lanes
}

/// The two counts and what came of comparing them.
fn counts(moments: &[Moment], unit: Unit, sections: u8) -> Vec<Lane> {
    let end = moments.len();
    let steps = |label: &str, first: bool, height: u32, top: u8, numbers: Vec<Option<u8>>| Lane {
        label: label.to_owned(),
        first,
        height,
        marks: vec![Mark::Steps { points: changes(numbers), top }],
    };
    let heard: Vec<_> = standing(None, moments.iter().map(|now| Some(now.heard_sections()))).take(end).collect();
    let counted: Vec<_> = standing(None, moments.iter().map(Moment::count)).take(end).collect();
    let top = heard.iter().chain(&counted).flatten().copied().max().unwrap_or(1).clamp(1, sections.max(1));
    let height = 34 + 8 * u32::from(top.min(6));
    let mut lanes =
        vec![steps("C1, detections", true, height, top, heard), steps("C2, checks", false, height, top, counted)];
    if moments.iter().any(|now| now.parts.pending > 0) {
        let bars = spans(standing(0, moments.iter().map(|now| now.parts.pending)).take(end)).into_iter();
        let bars = bars.filter(|span| span.2 > 0).map(|(from, to, pending)| {
            let texts = vec![format!("{pending} pending"), pending.to_string()];
            Mark::Bar { from, to, tone: Tone::Pending, texts }
        });
        lanes.push(Lane { label: "check-outs".to_owned(), first: false, height: 24, marks: bars.collect() });
    }
    let status = spans(standing("unverified", moments.iter().map(Moment::status)).take(end)).into_iter();
    let status = status.map(|(from, to, name)| {
        let (tone, short) = match name {
            "unverified" => (Tone::Dropped, "?"),
            "in force" => (Tone::Blank, "ok"),
            // The end of a fault's name tells which it is.
            fault => (Tone::Emergency, fault.rsplit_once("-at-").map_or("stays on", |(_, at)| at)),
        };
        Mark::Bar { from, to, tone, texts: vec![name.to_owned(), short.to_owned()] }
    });
    lanes.push(Lane { label: "C2 is".to_owned(), first: false, height: 24, marks: status.collect() });
    let agree = spans(standing(false, moments.iter().map(|now| now.output.agree)).take(end)).into_iter();
    let marks = agree.map(|(from, to, agrees)| {
        let tone = if agrees { Tone::Signal } else { Tone::Blank };
        let (name, short) = if agrees { ("agree", "=") } else { ("differ", "no") };
        // What is still so at the end of the chart has not been measured.
        let measured = (to < end as u64).then(|| unit.text(to - from));
        let texts = measured.iter().flat_map(|time| [format!("{name} {time}"), time.clone()]);
        Mark::Bar { from, to, tone, texts: texts.chain([name.to_owned(), short.to_owned()]).collect() }
    });
    lanes.push(Lane { label: "C1 and C2".to_owned(), first: false, height: 26, marks: marks.collect() });
    lanes
}

/// What is reported of a section, and why.
fn report_lane(section: u8, moments: &[Moment], unit: Unit) -> Lane {
    let reports = standing(Report::All, moments.iter().map(|now| now.report(section))).take(moments.len());
    let bars = spans(reports).into_iter().filter_map(|(from, to, report)| {
        let tone = match report {
            Report::Free => return None,
            Report::Detected => Tone::Detected,
            Report::Held => Tone::Held,
            Report::All => Tone::All,
        };
        let name = report.name();
        // What is still so at the end of the chart has not been measured.
        let measured = (to < moments.len() as u64).then(|| format!("{name} {}", unit.text(to - from)));
        let texts = measured.into_iter().chain([name.to_owned()]).collect();
        Some(Mark::Bar { from, to, tone, texts })
    });
    Lane { label: format!("section {section} occupied"), first: section == 0, height: 26, marks: bars.collect() }
}

/// What is asked at the two borders, if anything ever is.
fn holds(moments: &[Moment], hold: u32) -> Vec<Lane> {
    let first = u8::try_from(hold).unwrap_or(u8::MAX);
    let rows: [(&str, Vec<u8>); 2] = [
        ("asked by ahead", moments.iter().map(|now| now.asked).collect()),
        (
            "asked of behind",
            standing(first, moments.iter().map(|now| now.output.behind_hold_sections)).take(moments.len()).collect(),
        ),
    ];
    let rows = rows.into_iter().filter(|(_, asked)| asked.iter().any(|sections| *sections > 0));
    let lanes = rows.enumerate().map(|(place, (label, asked))| {
        let top = asked.iter().copied().max().unwrap_or(1).max(1);
        let points = changes(asked.into_iter().map(Some));
        Lane { label: label.to_owned(), first: place == 0, height: 36, marks: vec![Mark::Steps { points, top }] }
    });
    lanes.collect()
}

/// What the record says otherwise than the kernel, as one row.
fn differences(scene: &mut Scene, cycles: &[Cycle<Counted>], moments: &[Moment]) {
    let said = cycles.iter().zip(moments).map(|(cycle, now)| {
        let (Some(said), kernel) = (cycle.recorded, now.output) else { return String::new() };
        if said == kernel {
            return String::new();
        }
        let mut parts = Vec::new();
        if said.occupied != kernel.occupied {
            parts.push(format!("occupied {:?}", said.occupied.numbers().collect::<Vec<_>>()));
        }
        if said.count != kernel.count {
            parts.push(format!("count {}", said.count));
        }
        if said.agree != kernel.agree {
            parts.push(format!("agree {}", said.agree));
        }
        if said.fault != kernel.fault {
            parts.push(format!("fault {}", said.fault.map_or("null", Fault::name)));
        }
        if said.behind_hold_sections != kernel.behind_hold_sections {
            parts.push(format!("behind_hold_sections {}", said.behind_hold_sections));
        }
        if parts.is_empty() {
            parts.push(format!("counting {}", said.counting.unwrap_or_default()));
        }
        parts.join(", ")
    });
    let said: Vec<_> = spans(standing(String::new(), said)).into_iter().filter(|span| !span.2.is_empty()).collect();
    let Some((first, _, text)) = said.first() else { return };
    scene.notes.push(record::note(&scene.unit.text(*first), text));
    scene.differences = said.iter().map(|span| (span.0, span.1)).collect();
    scene.legend.push((Tone::Difference, "differs from the kernel"));
    let values = std::iter::once((0, "none".to_owned()))
        .chain(said.iter().flat_map(|(from, to, text)| [(*from, text.replace(' ', "_")), (*to, "none".to_owned())]));
    let mut values: Vec<_> = values.collect();
    // Where one difference follows another, what the record says next stands.
    values.reverse();
    values.dedup_by_key(|value| value.0);
    values.reverse();
    scene.signals.push(Signal { name: "record_says".to_owned(), values: Values::State(values) });
    let marks = said.into_iter().map(|(from, to, text)| Mark::Bar {
        from,
        to,
        tone: Tone::Difference,
        texts: vec![text, "differs".to_owned()],
    });
    scene.lanes.push(Lane { label: "record says".to_owned(), first: true, height: 30, marks: marks.collect() });
}

fn signals(cycles: &[Cycle<Counted>], moments: &[Moment], sections: u8) -> Vec<Signal> {
    let wire = |name: &str, values: &mut dyn Iterator<Item = bool>| Signal {
        name: name.to_owned(),
        values: Values::Wire(changes(values)),
    };
    let real = |name: &str, first: Option<u8>, values: &mut dyn Iterator<Item = Option<u8>>| Signal {
        name: name.to_owned(),
        values: Values::Real(changes(standing(first, values).map(|number| number.map(f64::from)))),
    };
    let state = |name: String, first: &'static str, values: &mut dyn Iterator<Item = &'static str>| Signal {
        name,
        values: Values::State(
            changes(standing(first, values)).into_iter().map(|(at, name)| (at, name.replace(' ', "_"))).collect(),
        ),
    };
    let mut all = vec![
        wire("check_in", &mut cycles.iter().map(|cycle| cycle.step.check_in)),
        wire("check_out", &mut cycles.iter().map(|cycle| cycle.step.check_out)),
        wire("ahead_entered", &mut cycles.iter().map(|cycle| cycle.step.ahead_entered)),
        real("c1_detections", None, &mut moments.iter().map(|now| Some(now.heard_sections()))),
        real("c2_checks", None, &mut moments.iter().map(Moment::count)),
        real("pending_check_outs", Some(0), &mut moments.iter().map(|now| Some(now.parts.pending))),
        state("count_is".to_owned(), "unverified", &mut moments.iter().map(Moment::status)),
        wire("agree", &mut standing(false, moments.iter().map(|now| now.output.agree))),
        real("behind_hold_sections", None, &mut moments.iter().map(|now| Some(now.output.behind_hold_sections))),
    ];
    for section in 0..sections {
        let heard = &mut cycles.iter().map(|cycle| cycle.step.present.0.contains(section));
        all.push(wire(&format!("heard_{section}"), heard));
        let reports = &mut moments.iter().map(|now| now.report(section).name());
        all.push(state(format!("occupied_{section}"), "all", reports));
    }
    all
}
