//! What the measurements must show, whatever the figures.

use super::samples::meter;
use super::*;

#[test]
fn within_the_limits_no_interval_is_without_the_train() {
    let bench = bench(Extent::Quick);
    for run in bench.runs.iter().chain(&bench.from_samples) {
        assert!(run.wrong == 0.0 && run.answered > 0.9, "{} {} {:?}", run.arrangement, run.ohm_km, run.odometer);
    }
    for row in &bench.outside {
        let inside = (5.0..=20.0).contains(&row.ohm_km);
        assert!(!inside || row.wrong == 0.0, "{row:?}");
    }
    assert!(bench.outside.iter().any(|row| row.wrong > 0.5), "outside its limits a table must be seen to be wrong");
}

#[test]
fn the_odometer_makes_no_interval_wider_and_narrow_limits_make_them_narrower() {
    let bench = bench(Extent::Quick);
    for pair in bench.runs.chunks(2) {
        assert!(pair[1].mean_width <= pair[0].mean_width + 0.2, "{} {}", pair[0].arrangement, pair[0].ohm_km);
    }
    for rows in bench.limits.chunks(3) {
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
    assert_eq!(bench(Extent::Quick), bench(Extent::Quick));
}
