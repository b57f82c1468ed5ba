//! The chart of the telegram codec: the bits of each frame, with its fields named. The axis is the place of the bit.

use atc_kernel::telegram::{FRAME_BITS, Frame, Route, Telegram, decode};

use super::scene::{Lane, Mark, Scene, Signal, Tone, Unit, Values};
use super::series::{changes, spans};
use crate::drawn::machine::Drawn;
use crate::trace::run::Cycle;
use atc_protocol::machine::Machine;
use atc_protocol::machine::telegram::{Codec, Config, Found, Output, Step};
use atc_protocol::names::Named as _;

/// The most steps that are drawn.
const MOST: usize = 24;

/// A frame's length, for places.
const LENGTH: u64 = FRAME_BITS as u64;

/// The bits of a step, as characters, and what is written above them.
struct Shown {
    heading: String,
    bits: String,
    fields: Vec<Mark>,
    error: bool,
}

/// A named span of bits.
fn field(from: u64, bits: u64, tone: Tone, texts: &[String]) -> Mark {
    Mark::Bar { from, to: from + bits, tone, texts: texts.to_vec() }
}

/// The fields of a frame that begins at place `from`; one of no telegram shows its bytes.
fn fields(frame: Frame, from: u64) -> Vec<Mark> {
    let byte = |place: u32| (frame.bits() >> (9 * (9 - place) + 1)).to_le_bytes()[0];
    let pair = |place: u32| u16::from_be_bytes([byte(place), byte(place + 1)]);
    let at = |place: u64| from + 16 + 9 * place;
    let name = |from, bits, tone, name: &str, value: String| {
        field(from, bits, tone, &[format!("{name} {value}"), value, String::new()])
    };
    let mut marks = vec![field(from, 16, Tone::Dropped, &["synchronisation".to_owned(), "sync".to_owned()])];
    let telegram = decode(frame);
    let kind = match telegram {
        Ok(Telegram::Main(_)) => "main",
        Ok(Telegram::Sub(_)) => "sub",
        Err(_) => {
            let bytes = (0..10_u32)
                .zip(0..10_u64)
                .map(|(place, at_byte)| name(at(at_byte), 9, Tone::Signal, "byte", format!("{:02X}", byte(place))));
            marks.extend(bytes);
            return marks;
        }
    };
    marks.push(name(at(0), 9, Tone::Operate, "kind", kind.to_owned()));
    marks.push(name(at(1), 9, Tone::Recovery, "counter", byte(1).to_string()));
    marks.push(name(at(2), 18, Tone::Signal, "section", pair(2).to_string()));
    match telegram {
        Ok(Telegram::Main(main)) => {
            marks.push(name(at(4), 18, Tone::Mask, "beyond exit", format!("{} m", pair(4))));
            let route = if main.route == Route::Closed { "closed" } else { "open" };
            marks.push(name(at(6), 9, Tone::Service, "route", route.to_owned()));
            marks.push(name(at(7), 9, Tone::Signal, "speed", format!("rank {}", byte(7))));
        }
        Ok(Telegram::Sub(sub)) => {
            marks.push(name(at(4), 18, Tone::Mask, "length", format!("{} m", pair(4))));
            marks.push(name(at(6), 9, Tone::Service, "gradient", format!("{} ‰", sub.gradient.0)));
            let (curve, restriction) = (sub.curve.rank(), sub.restriction.rank());
            marks.push(field(
                at(7),
                9,
                Tone::Signal,
                &[
                    format!("curve {curve}, restriction {restriction}"),
                    format!("limits {curve}, {restriction}"),
                    format!("{curve}, {restriction}"),
                ],
            ));
        }
        Err(_) => {}
    }
    marks.push(name(at(8), 18, Tone::Operate, "check", format!("{:04X}", pair(8))));
    marks
}

/// Reads characters that a step or an output has been checked to consist of.
fn frame(text: &str) -> Frame {
    Frame::from_bits(text.chars().fold(0, |bits, letter| bits << 1 | u128::from(letter == '1')))
}

/// The telegrams found in a stream whose first bit in this step is number `first`.
fn found(stream: &str, first: u64, telegrams: &[Found]) -> Vec<Mark> {
    let mut marks = Vec::new();
    for telegram in telegrams {
        let end = telegram.last_bit + 1 - first;
        let name = match telegram.telegram {
            atc_protocol::telegrams::Telegram::Main(main) => {
                format!("main {} of section {}", main.counter, main.section)
            }
            atc_protocol::telegrams::Telegram::Sub(sub) => format!("sub {} of section {}", sub.counter, sub.section),
        };
        if end >= LENGTH {
            let whole: String =
                stream.chars().skip(usize::try_from(end - LENGTH).unwrap_or(0)).take(FRAME_BITS as usize).collect();
            marks.extend(fields(frame(&whole), end - LENGTH));
        } else {
            let whole = format!("{name}, begun in an earlier step");
            marks.push(field(0, end, Tone::Recovery, &[whole, name, "end".to_owned()]));
        }
    }
    marks
}

/// What is shown of a step. `heard` is how many bit times the deframer heard before it.
fn shown(place: usize, step: &Step, output: &Output, heard: &mut u64) -> Shown {
    let (heading, bits, fields, error) = match (step, output) {
        (Step::Encode(_), Output::Frame { frame: text }) => {
            ("encode".to_owned(), text.clone(), fields(frame(text), 0), false)
        }
        (Step::Decode(text), Output::Error { error }) => {
            (format!("decode: {}", error.name()), text.clone(), fields(frame(text), 0), true)
        }
        (Step::Decode(text), _) => ("decode".to_owned(), text.clone(), fields(frame(text), 0), false),
        (Step::Bits(text), Output::Telegrams { telegrams }) => {
            let marks = found(text, *heard, telegrams);
            *heard += text.chars().count() as u64;
            (format!("bits: {} found", telegrams.len()), text.clone(), marks, false)
        }
        (Step::Encode(_) | Step::Bits(_), _) => (String::new(), String::new(), Vec::new(), false),
    };
    Shown { heading: format!("{place}  {heading}"), bits, fields, error }
}

impl Drawn for Codec {
    fn chart(config: &Config, cycles: &[Cycle<Self>]) -> Scene {
        scene(*config, cycles)
    }
}

/// Lays out a case.
fn scene(_: Config, cycles: &[Cycle<Codec>]) -> Scene {
    let mut heard = 0;
    let shown: Vec<_> =
        cycles.iter().enumerate().map(|(place, cycle)| shown(place, &cycle.step, &cycle.output, &mut heard)).collect();
    let longest = shown.iter().take(MOST).map(|shown| shown.bits.chars().count()).max().unwrap_or(0).max(1);
    let mut lanes = Vec::new();
    for shown in shown.iter().take(MOST) {
        let ones = spans(shown.bits.chars().map(|letter| letter == '1')).into_iter().filter(|span| span.2);
        let gaps = spans(shown.bits.chars().map(|letter| letter == '.')).into_iter().filter(|span| span.2);
        let mut bits = vec![Mark::Wave(ones.map(|(from, to, _)| (from, to)).collect())];
        let hint = "nothing is heard".to_owned();
        bits.extend(gaps.map(|(from, to, _)| Mark::Tick { from, to, tone: Tone::Emergency, hint: hint.clone() }));
        lanes.push(Lane { label: shown.heading.clone(), first: true, height: 28, marks: bits });
        lanes.push(Lane {
            label: String::new(),
            first: false,
            height: 16,
            marks: vec![Mark::Letters { from: 0, text: shown.bits.clone() }],
        });
        if !shown.fields.is_empty() {
            let label = if shown.error { "no telegram" } else { "fields" };
            lanes.push(Lane { label: label.to_owned(), first: false, height: 26, marks: shown.fields.clone() });
        }
    }
    let mut notes = vec![
        "The bits of each step in the order in which they are sent, the first at the left. Behind each byte stands a guard bit, 0.".to_owned(),
    ];
    if cycles.len() > MOST {
        notes.push(format!("The first {MOST} of {} steps are drawn.", cycles.len()));
    }
    let mut scene = Scene {
        notes,
        lanes,
        signals: signals(&shown),
        ..Scene::of(Codec::NAME, Unit { axis: "place", name: "bits", per_cycle: 1 }, longest as u64)
    };
    let said = cycles.iter().map(|cycle| cycle.recorded.as_ref().filter(|said| **said != cycle.output));
    let said: Vec<_> = said.map(|said| said.map(|said| serde_json::to_string(said).unwrap_or_default())).collect();
    if let Some(first) = said.iter().position(Option::is_some) {
        scene.notes.push(format!("THE RECORD DIFFERS FROM THE KERNEL, first in step {first}."));
        scene.legend.push((Tone::Difference, "differs from the kernel"));
        for (place, said) in said.iter().enumerate() {
            if let Some(said) = said {
                let bar = field(0, longest as u64, Tone::Difference, &[said.clone(), "differs".to_owned()]);
                scene.lanes.push(Lane {
                    label: format!("{place}  record says"),
                    first: true,
                    height: 30,
                    marks: vec![bar],
                });
            }
        }
        scene.differences = vec![(0, longest as u64)];
    }
    scene
}

/// The bits of all steps one after the other, and which step they are of.
fn signals(shown: &[Shown]) -> Vec<Signal> {
    let (mut level, mut steps, mut silent) = (Vec::new(), Vec::new(), Vec::new());
    for shown in shown {
        for letter in shown.bits.chars() {
            level.push(letter == '1');
            silent.push(letter == '.');
            steps.push(shown.heading.replace([' ', ':'], "_"));
        }
    }
    vec![
        Signal { name: "bit".to_owned(), values: Values::Wire(changes(level)) },
        Signal { name: "nothing".to_owned(), values: Values::Wire(changes(silent)) },
        Signal { name: "step".to_owned(), values: Values::State(changes(steps)) },
    ]
}
