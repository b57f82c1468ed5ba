//! Series of values over the cycles of a case.

use atc_protocol::decimal::Metres;

/// Spans of equal values, as `(from, to, value)`.
pub(super) fn spans<T: PartialEq>(values: impl IntoIterator<Item = T>) -> Vec<(u64, u64, T)> {
    let mut spans: Vec<(u64, u64, T)> = Vec::new();
    for (value, at) in values.into_iter().zip(0..) {
        match spans.last_mut() {
            Some((_, to, last)) if *last == value => *to = at + 1,
            _ => spans.push((at, at + 1, value)),
        }
    }
    spans
}

/// The changes of a series of values, as `(at, value)`.
pub(super) fn changes<T: PartialEq>(values: impl IntoIterator<Item = T>) -> Vec<(u64, T)> {
    spans(values).into_iter().map(|(from, _, value)| (from, value)).collect()
}

/// What stands while the cycles run: `first` before the first output, then each from the end of its cycle on.
pub(super) fn standing<T>(first: T, outputs: impl ExactSizeIterator<Item = T>) -> impl Iterator<Item = T> {
    let length = outputs.len();
    std::iter::once(first).chain(outputs).take(length)
}

/// A length as it is drawn.
#[expect(clippy::cast_precision_loss, reason = "a length of 2^53 mm is not drawn")]
pub(super) fn metres(length: Metres) -> f64 {
    length.0 as f64 / 1000.0
}
