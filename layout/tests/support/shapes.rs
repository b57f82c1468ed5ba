//! Random shapes of stations, and how many are taken.

use proptest::prelude::*;
use proptest::test_runner::TestRunner;

use super::support::random::Shape;

/// A runner of so many cases, or of as many as `STATIONS` says.
pub fn runner(cases: u32) -> TestRunner {
    let asked = std::env::var("STATIONS").ok().and_then(|number| number.parse().ok());
    TestRunner::new(ProptestConfig {
        cases: asked.unwrap_or(cases),
        failure_persistence: None,
        ..ProptestConfig::default()
    })
}

/// Shapes of less than so many tracks.
pub fn shapes(tracks: usize) -> impl Strategy<Value = Shape> {
    let lengths = prop::collection::vec(60_u16..600, 1..12);
    let splits = prop::collection::vec(1_usize..4, 1..8);
    (2..tracks, any::<bool>(), lengths, splits).prop_map(|(tracks, bay, lengths, splits)| Shape {
        tracks,
        bay,
        lengths,
        splits,
    })
}
