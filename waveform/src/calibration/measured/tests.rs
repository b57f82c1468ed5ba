//! Lines through measurements that were made up: what is fitted, what is refused, and that the curves are around the
//! truth.

use super::{Fit, FitError, Measurement, Wanted, sides};
use crate::rail::{Decibels, Metres};
use atc_kernel::position::{Millibels, Spacing};
use rand::{Rng, SeedableRng};
use rand_pcg::Pcg64Mcg;

/// A pass with measurements every `step` metres; each is off by up to `off`, evenly.
fn pass(range: (f64, f64), step: f64, off: f64, seed: u64, truth: impl Fn(f64) -> f64) -> Vec<Measurement> {
    let mut random = Pcg64Mcg::seed_from_u64(seed);
    let mut all = Vec::new();
    let mut x = range.0;
    while x <= range.1 {
        let error = random.random_range(-1.0..=1.0) * off;
        all.push(Measurement { distance: Metres(x), difference: Decibels(truth(x) + error) });
        x += step;
    }
    all
}

fn wet(x: f64) -> f64 {
    0.5 + 0.009 * x
}

fn dry(x: f64) -> f64 {
    0.5 + 0.0018 * x
}

const SECTION: Wanted = Wanted { spacing: None, section: Some(Metres(400.0)) };

#[test]
fn the_curves_are_around_the_truth() {
    for seed in 0..40 {
        let passes = [pass((0.0, 400.0), 5.0, 0.05, seed, wet), pass((0.0, 400.0), 5.0, 0.05, seed + 100, dry)];
        for wanted in [Wanted::default(), SECTION] {
            let fit = Fit::new(&passes, wanted).expect("a table");
            for k in fit.first..=fit.last {
                let x = fit.distance(k).0;
                let [low, high] = [fit.table.lowest(), fit.table.highest()].map(|curve| f64::from(curve[k].0) / 100.0);
                assert!(low <= dry(x) && wet(x) <= high, "seed {seed}, {x} m: {low} {high}");
                // And no wider than the spread of the lines makes them.
                assert!(low > dry(x) - 0.25 && high < wet(x) + 0.25, "seed {seed}, {x} m: {low} {high}");
            }
            // Errors of up to 0.05 dB in the difference: half of it, or of four standard deviations, for a level.
            assert!((3..=8).contains(&fit.tolerance.0), "{:?}", fit.tolerance);
        }
    }
}

#[test]
fn the_ends_are_flat_or_out_of_the_way() {
    let passes = [pass((30.0, 400.0), 5.0, 0.02, 1, wet), pass((20.0, 420.0), 5.0, 0.02, 2, dry)];
    let fit = Fit::new(&passes, Wanted::default()).expect("a table");
    // 25.6 m reach 409.6 m; the passes have 30 to 400 m in common.
    assert_eq!((fit.first, fit.last, fit.nearest(), fit.to), (2, 15, Metres(51.2), Metres(384.0)));
    let (low, high) = (fit.table.lowest(), fit.table.highest());
    assert!(low[0] == low[2] && high[1] == high[2] && low[16] == low[15] && high[16] == high[15]);
    assert!((2..15).all(|k| low[k] < low[k + 1] && high[k] < high[k + 1]));
    let fit = Fit::new(&passes, SECTION).expect("a table");
    assert_eq!((fit.last, fit.to, fit.bounded), (8, Metres(400.0), true));
    let (low, high) = (fit.table.lowest(), fit.table.highest());
    assert!(low[9].0 > high[8].0 + 4 * fit.tolerance.0 && low[9] == high[9] && low[15] < low[16]);
}

#[test]
fn residuals_are_found_where_they_are() {
    let mut one = pass((0.0, 400.0), 5.0, 0.02, 3, wet);
    one[40].difference.0 -= 0.6;
    let fit = Fit::new(&[pass((0.0, 400.0), 5.0, 0.02, 4, dry), one], SECTION).expect("a table");
    let all = fit.residuals();
    assert_eq!(all.at, (1, 40));
    assert!((-0.6..-0.4).contains(&all.largest.0) && all.count == 162, "{all:?}");
    assert_eq!(fit.residuals_of(0).expect("a pass").at.0, 0);
    assert_eq!(fit.remarkable().iter().map(|one| (one.0, one.1)).collect::<Vec<_>>(), [(1, 40)]);
    assert!(f64::from(fit.tolerance.0) >= all.largest.0.abs() * 50.0);
}

/// A fall within the spread is levelled; one beyond it is refused and named.
#[test]
fn what_falls() {
    let flat_in_the_middle = |x: f64| if x < 150.0 { wet(x) } else { wet(150.0) + 0.009 * (x - 250.0).max(0.0) };
    let fit = Fit::new(&[pass((0.0, 400.0), 4.0, 0.05, 5, flat_in_the_middle)], Wanted::default()).expect("a table");
    assert!(fit.passes[0].levelled && fit.passes[0].knots.windows(2).all(|pair| pair[0] <= pair[1]));
    let dip = |x: f64| if (200.0..240.0).contains(&x) { wet(x) - 1.5 } else { wet(x) };
    let error = Fit::new(&[pass((0.0, 400.0), 4.0, 0.05, 5, dip)], Wanted::default()).expect_err("it falls");
    let FitError::Falls { pass: 0, measurement, fall, explained, .. } = error else { panic!("{error}") };
    assert!((46..=63).contains(&measurement) && fall.0 > explained.0, "{measurement}");
    // The signals the wrong way round.
    let error = Fit::new(&[pass((0.0, 400.0), 4.0, 0.05, 5, |x| -wet(x))], Wanted::default()).expect_err("it falls");
    assert!(matches!(error, FitError::Falls { .. }), "{error}");
    let error = Fit::new(&[pass((0.0, 400.0), 4.0, 0.05, 5, |_| 1.0)], Wanted::default()).expect_err("no rise");
    assert!(matches!(error, FitError::Flat { .. } | FitError::Falls { .. }), "{error}");
}

#[test]
fn what_is_too_little() {
    let whole = || pass((0.0, 400.0), 5.0, 0.05, 6, wet);
    let refused = |passes: &[Vec<Measurement>], wanted| Fit::new(passes, wanted).expect_err("refused");
    assert_eq!(refused(&[], Wanted::default()), FitError::Nothing);
    assert_eq!(refused(&[whole(), Vec::new()], Wanted::default()), FitError::Nothing);
    let sparse = pass((0.0, 400.0), 12.8, 0.05, 6, wet);
    let error = refused(&[whole(), sparse], Wanted::default());
    assert!(matches!(error, FitError::Few { pass: 1, needed: 32, .. }), "{error:?}");
    let mut gap = whole();
    gap.retain(|measurement| !(126.0..180.0).contains(&measurement.distance.0));
    let error = refused(&[gap], Wanted::default());
    assert!(matches!(error, FitError::Gap { pass: 0, before: Some(25), after: Some(26), found: 0, .. }), "{error:?}");
    let short = Wanted { section: Some(Metres(401.0)), spacing: None };
    let error = refused(&[whole()], short);
    assert!(matches!(error, FitError::Section { pass: 0, measurement: 80, .. }), "{error:?}");
    let coarse = Wanted { spacing: Spacing::new(11), section: None };
    assert!(matches!(refused(&[whole()], coarse), FitError::Short { .. }));
    let fine = Wanted { spacing: Spacing::new(4), ..SECTION };
    assert!(matches!(refused(&[whole()], fine), FitError::Reach { .. }));
}

/// The kernel, asked about rails that are otherwise: where they lose more, the near end is beyond the train.
#[test]
fn the_dangerous_side() {
    let passes = [pass((0.0, 400.0), 5.0, 0.05, 7, wet), pass((0.0, 400.0), 5.0, 0.05, 8, dry)];
    let fit = Fit::new(&passes, SECTION).expect("a table");
    let sides = sides(&fit, Millibels(1000));
    for side in &sides {
        let wrong = (side.beyond.count, side.before.count);
        match side.change_percent {
            change if change.abs() < 1.5 => {
                assert!(side.answered == side.asked && wrong == (0, 0), "{side:?}");
            }
            change if change >= 20.0 => assert!(side.beyond.count > 100 && side.before.count == 0, "{side:?}"),
            change if change <= -50.0 => assert!(side.before.count > 100 && side.beyond.count == 0, "{side:?}"),
            _ => {}
        }
    }
}
