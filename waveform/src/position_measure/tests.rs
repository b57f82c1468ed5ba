//! What the measurements must show, whatever the figures.

use super::samples::meter;
use super::*;
use std::sync::LazyLock;

static BENCH: LazyLock<PositionBench> = LazyLock::new(|| bench(Extent::Quick));

#[test]
fn within_the_limits_no_interval_is_without_the_train() {
    for run in BENCH.runs.iter().chain(&BENCH.from_samples) {
        assert!(run.wrong == 0.0 && run.answered > 0.9, "{} {} {:?}", run.arrangement, run.ohm_km, run.odometer);
    }
    for row in &BENCH.outside {
        let inside = (5.0..=20.0).contains(&row.ohm_km);
        assert!(!inside || row.wrong == 0.0, "{row:?}");
    }
    assert!(BENCH.outside.iter().any(|row| row.wrong > 0.5), "outside its limits a table must be seen to be wrong");
}

#[test]
fn the_odometer_makes_no_interval_wider_and_narrow_limits_make_them_narrower() {
    let mut compared = 0;
    for pair in BENCH.runs.chunks(2) {
        assert_eq!([pair[0].odometer, pair[1].odometer], [Odometry::Without, Odometry::With]);
        for (without, with) in pair[0].points.iter().zip(&pair[1].points) {
            let (Some(wide), Some(narrow)) = (without.interval, with.interval) else { continue };
            let place = format!("{} {} {}", pair[0].arrangement, pair[0].ohm_km, with.truth);
            assert!(wide[0] <= narrow[0] && narrow[1] <= wide[1], "{place}: {narrow:?} is not in {wide:?}");
            compared += 1;
        }
    }
    assert!(compared > 1600, "{compared} of 1800 cycles");
    for rows in BENCH.limits.chunks(3) {
        assert!(rows[2].mean_width < rows[1].mean_width && rows[1].mean_width < rows[0].mean_width, "{rows:?}");
    }
}

#[test]
fn the_meter_is_as_good_as_theory_and_keeps_the_tolerance_from_thirty_decibels() {
    for ratio in [20.0, 30.0, 40.0] {
        let point = meter(ratio, 2000);
        assert!((0.9..1.15).contains(&(point.deviation_db / point.expected_db)), "{point:?}");
        assert!(ratio < 30.0 || point.greatest_db * 100.0 < f64::from(TOLERANCE.0), "{point:?}");
    }
    assert!(meter(10.0, 2000).greatest_db * 100.0 > f64::from(TOLERANCE.0), "in such noise the tolerance is not kept");
}

#[test]
fn the_results_are_the_same_every_time() {
    assert_eq!(bench(Extent::Quick), *BENCH);
}
