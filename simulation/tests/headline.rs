//! What the shortened operate time buys: the edges that T-ACC-4 proves, met on a line with trains in motion; and the
//! picture of it in `docs/`.

use std::fs;
use std::path::Path;

use atc_simulation::charts;
use atc_simulation::headline::{Extent, measure};

/// Trains run over the conventional device's limit: with T2 + T3 = 800 ms it stands interruptions up to 800 − 300 = 500 ms, the
/// new one up to 800 − 100 = 700 ms. One of just that length is in one cycle more, as it begins between two.
#[test]
fn the_edges_are_those_that_are_proved() {
    let headline = measure(&Extent::default()).expect("an extent");
    assert_eq!(headline.edges_ms(0.9), [Some(700), Some(500)]);
    assert_eq!((headline.unsafe_events(), headline.alone()), (0, 0));
    for row in &headline.rows {
        let (new, old) = (&row.shortened, &row.conventional);
        assert!(row.length_ms == 0 || new.interruptions >= 50, "{row:?}");
        assert!(new.needless <= old.needless + 1 && new.delay_s <= old.delay_s + 0.2, "{row:?}");
        assert!(new.pattern_m > 0.0 && new.stop_m > 0.0 && new.train_m > 0.0, "{row:?}");
    }
    // Between the two edges: trains that nobody brakes, against trains that are braked every time.
    let between = headline.rows.iter().filter(|row| (500..700).contains(&row.length_ms));
    for row in between {
        assert!(row.shortened.share() < 0.1 && row.conventional.share() > 0.9, "{row:?}");
        assert!(row.conventional.alone >= 50, "who brakes alone is not counted: {row:?}");
    }
    // The picture and its data are what is measured today.
    let docs = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs");
    let again = "make it again: oracle simulate --headline -o docs";
    let read = |name: &str| fs::read_to_string(docs.join(name)).unwrap_or_default();
    assert!(read("shortened-operate.svg") == charts::headline(&headline).expect("a picture"), "{again}");
    assert!(read("shortened-operate.csv") == headline.csv(), "{again}");
}

#[test]
fn what_cannot_be_measured_is_said() {
    for extent in [
        Extent { step_ms: 0, ..Extent::default() },
        Extent { seconds: 60, ..Extent::default() },
        Extent { every_s: 4, ..Extent::default() },
        Extent { trains: 0, longest_ms: 50, ..Extent::default() },
        Extent { trains: 6, longest_ms: 50, ..Extent::default() },
    ] {
        assert!(measure(&extent).is_err(), "{extent:?}");
    }
}
