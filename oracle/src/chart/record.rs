//! What a record says otherwise than the kernel, as one row of a chart.

use super::scene::{Lane, Mark, Scene, Signal, Tone, Values};
use super::series::spans;

/// The sentence of the first difference: every field that differs there.
pub(super) fn note(first: &str, says: &str) -> String {
    const MOST: usize = 240;
    let more = if says.chars().count() > MOST { "…" } else { "" };
    let says: String = says.chars().take(MOST).collect();
    format!("THE RECORD DIFFERS FROM THE KERNEL, first at {first}. There it says: {says}{more}.")
}

/// Adds what the record says in each cycle in which it differs, to be drawn from `later` cycles after it on.
pub(super) fn differences(scene: &mut Scene, later: u64, said: impl Iterator<Item = Option<String>>) {
    let said: Vec<_> = said.collect();
    let row = spans(said).into_iter().filter_map(|(from, to, text)| Some((from + later, to + later, text?)));
    let row: Vec<_> = row.collect();
    let Some((first, _, text)) = row.first() else { return };
    scene.notes.push(note(&scene.unit.text(*first), text));
    scene.differences = row.iter().map(|span| (span.0, span.1)).collect();
    scene.legend.push((Tone::Difference, "differs from the kernel"));
    let mut values = vec![(0, "none".to_owned())];
    for (from, to, text) in &row {
        // Where one difference follows another, what the record says next stands.
        values.retain(|value| value.0 < *from);
        values.push((*from, text.replace(' ', "_")));
        values.push((*to, "none".to_owned()));
    }
    scene.signals.push(Signal { name: "record_says".to_owned(), values: Values::State(values) });
    let marks = row.into_iter().map(|(from, to, text)| Mark::Bar {
        from,
        to,
        tone: Tone::Difference,
        texts: vec![text, "differs".to_owned(), "!".to_owned()],
    });
    scene.lanes.push(Lane { label: "record says".to_owned(), first: true, height: 30, marks: marks.collect() });
}
