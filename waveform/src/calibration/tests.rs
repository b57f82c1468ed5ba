//! The bounds against the line itself, at leakages and distances that the search does not use.

use super::*;

fn plan(arrangement: Arrangement, ground: Ground) -> Plan {
    Plan {
        first_hz: Hertz(1000.0),
        second_hz: Hertz(3000.0),
        transmitted_db: Decibels(1.5),
        spacing_dm: 256,
        arrangement,
        weather: Weather { wet_ohm_km: OhmKilometres(2.0), dry_ohm_km: OhmKilometres(50.0), ground },
        rails: Rails::default(),
    }
}

const ARRANGEMENTS: [Arrangement; 3] = [
    Arrangement::OneTransmitter,
    Arrangement::TwoAhead { apart_m: Metres(60.0) },
    Arrangement::AheadAndBehind { apart_m: Metres(400.0), train_m: Metres(80.0) },
];

/// The curve of a table between its knots, 0.01 dB.
fn curve(values: &[Millibels; KNOTS], spacing_dm: u16, distance: f64) -> f64 {
    let place = distance * 10.0 / f64::from(spacing_dm);
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "within the table")]
    let knot = (place as usize).min(KNOTS - 2);
    #[allow(clippy::cast_precision_loss, reason = "within the table")]
    let part = place - knot as f64;
    f64::from(values[knot].0) * (1.0 - part) + f64::from(values[knot + 1].0) * part
}

/// The difference on uniform ballast, written down once more from the picture of the track.
fn difference(plan: &Plan, leakage: f64, distance: f64) -> f64 {
    let line = Line::new(plan.rails, OhmKilometres(leakage)).expect("between the limits");
    let (first, second) = match plan.arrangement {
        Arrangement::OneTransmitter => (distance, distance),
        Arrangement::TwoAhead { apart_m } => (distance, distance + apart_m.0),
        Arrangement::AheadAndBehind { apart_m, train_m } => (apart_m.0 - train_m.0 - distance, distance),
    };
    let lost = |frequency, metres| line.attenuation(frequency, Metres(metres)).0;
    plan.transmitted_db.0 - lost(plan.first_hz, first) + lost(plan.second_hz, second)
}

fn assert_bounds_hold(plan: Plan) {
    let calibration = Calibration::new(plan).expect("a usual plan");
    let (wet, dry) = (plan.weather.wet_ohm_km.0, plan.weather.dry_ohm_km.0);
    for step in 0..=997 {
        let leakage = wet * (dry / wet).powf(f64::from(step) / 997.0);
        for place in 0..=613 {
            let distance = calibration.range().0 * f64::from(place) / 613.0;
            let true_one = difference(&plan, leakage, distance) * 100.0;
            let low = curve(calibration.table().lowest(), plan.spacing_dm, distance);
            let high = curve(calibration.table().highest(), plan.spacing_dm, distance);
            assert!(
                low <= true_one && true_one <= high,
                "{leakage} Ω·km, {distance} m: {true_one} not in {low} to {high}"
            );
        }
    }
}

#[test]
fn the_bounds_hold_for_every_leakage_and_between_knots() {
    for arrangement in ARRANGEMENTS {
        for ground in [Ground::Uniform, Ground::Varying] {
            assert_bounds_hold(plan(arrangement, ground));
        }
    }
}

/// A short line of high capacitance with a high frequency behind: the difference falls and rises again with the leakage.
fn folded() -> Plan {
    Plan {
        first_hz: Hertz(9000.0),
        second_hz: Hertz(300.0),
        weather: Weather { wet_ohm_km: OhmKilometres(0.5), dry_ohm_km: OhmKilometres(500.0), ground: Ground::Uniform },
        rails: Rails { nanofarad_per_km: 20_000.0, ..Rails::default() },
        ..plan(ARRANGEMENTS[2], Ground::Uniform)
    }
}

#[test]
fn the_bounds_hold_where_the_extreme_is_neither_wet_nor_dry() {
    let plan = folded();
    let inside = (1..=310).map(f64::from).any(|distance| {
        let at = |leakage| difference(&plan, leakage, distance);
        let (wet, dry) = (at(0.5), at(500.0));
        let between = (1..100).map(|step| at(0.5 * 1000.0_f64.powf(f64::from(step) / 100.0)));
        between.into_iter().any(|other| other < wet.min(dry) - 0.02 || other > wet.max(dry) + 0.02)
    });
    assert!(inside, "this plan is to have an extreme between the limits");
    assert_bounds_hold(plan);
}

#[test]
fn the_bounds_are_tight() {
    // Neither curve is farther from a difference that occurs than rounding and margin explain.
    for arrangement in ARRANGEMENTS {
        let plan = plan(arrangement, Ground::Uniform);
        let calibration = Calibration::new(plan).expect("a usual plan");
        for knot in 0..KNOTS {
            let distance = knot_distance(&plan, knot).0;
            let all: Vec<f64> = (0..=500)
                .map(|n| difference(&plan, 2.0 * 25.0_f64.powf(f64::from(n) / 500.0), distance) * 100.0)
                .collect();
            let (least, most) =
                (all.iter().copied().fold(f64::MAX, f64::min), all.iter().copied().fold(f64::MIN, f64::max));
            assert!(least - f64::from(calibration.table().lowest()[knot].0) < 1.3, "{arrangement:?} {knot}");
            assert!(f64::from(calibration.table().highest()[knot].0) - most < 1.3, "{arrangement:?} {knot}");
        }
    }
}

#[test]
fn the_correction_bounds_what_another_length_changes() {
    let calibration = Calibration::new(plan(ARRANGEMENTS[2], Ground::Uniform)).expect("a usual plan");
    let correction = calibration.correction(Metres(60.0), Metres(110.0)).expect("usual lengths");
    for length in [60.0, 70.0, 80.0, 95.0, 110.0] {
        let other = Plan {
            arrangement: Arrangement::AheadAndBehind { apart_m: Metres(400.0), train_m: Metres(length) },
            ..*calibration.plan()
        };
        for leakage in [2.0, 3.0, 11.0, 50.0] {
            let added = 100.0 * (difference(calibration.plan(), leakage, 150.0) - difference(&other, leakage, 150.0));
            assert!(
                f64::from(correction.least().0) <= added && added <= f64::from(correction.most().0),
                "{length} {leakage}"
            );
        }
    }
    let none = Calibration::new(plan(ARRANGEMENTS[0], Ground::Uniform)).expect("a usual plan");
    assert_eq!(none.correction(Metres(60.0), Metres(110.0)), Ok(Correction::NONE));
    let refused = |calibration: &Calibration, shortest, longest| {
        calibration.correction(Metres(shortest), Metres(longest)).expect_err("refused").to_string()
    };
    assert_eq!(refused(&calibration, 110.0, 60.0), "the shortest train is 110 m; it must be 0 to 60 m, the longest");
    assert_eq!(
        refused(&calibration, 0.0, 400.0),
        "a train of 400 m; it must be at least 0 and less than 400 m, apart_m"
    );
    // Ten kilometres at 100 kHz lose too much for a table to say it.
    let far = Plan {
        first_hz: Hertz(100_000.0),
        second_hz: Hertz(100_000.0),
        spacing_dm: 16,
        arrangement: Arrangement::AheadAndBehind { apart_m: Metres(10_000.0), train_m: Metres(9990.0) },
        ..*calibration.plan()
    };
    assert_eq!(
        refused(&Calibration::new(far).expect("a short stretch"), 0.0, 9990.0),
        "trains of 0 to 9990 m change the level difference by more than 300 dB: choose lengths nearer to train_m"
    );
}

#[test]
fn a_text_is_read_as_it_was_written() {
    for arrangement in ARRANGEMENTS {
        let calibration = Calibration::new(plan(arrangement, Ground::Varying)).expect("a usual plan");
        assert_eq!(Calibration::from_toml(&calibration.to_toml()), Ok(calibration));
    }
}

#[test]
fn a_text_that_is_wrong_is_refused_with_place_and_remedy() {
    let text = Calibration::new(plan(ARRANGEMENTS[1], Ground::Uniform)).expect("a usual plan").to_toml();
    let refused = |from: &str, to: &str| {
        assert!(text.contains(from), "{from} is not in\n{text}");
        Calibration::from_toml(&text.replacen(from, to, 1)).expect_err(to).to_string()
    };
    assert_eq!(refused("format = 1", "format = 2"), "format is 2; this version reads 1");
    assert_eq!(
        refused("spacing_dm = 256", "spacing_dm = 100"),
        "plan: spacing_dm is 100; it must be a power of two, 16 to 2048"
    );
    assert_eq!(
        refused("spacing_dm = 256", "spacing_dm = 8"),
        "plan: spacing_dm is 8; it must be a power of two, 16 to 2048"
    );
    assert!(refused("wet_ohm_km = 2.0", "wet_ohm_km = 60.0").contains("wet must be less than dry"));
    assert!(refused("second_hz = 3000.0", "second_hz = 900.0").contains("the first must be lower"));
    assert!(refused("apart_m = 60.0", "apart_m = nan").contains("apart_m is NaN"));
    assert!(refused("transmitted_db = 1.5", "transmitted_db = inf").contains("-100 to 100"));
    let unknown = refused("wet_ohm_km", "damp_ohm_km");
    assert!(unknown.contains("line") && unknown.contains("damp_ohm_km"), "{unknown}");
    // Wetter weather in the plan than the table was made for.
    let narrow = refused("wet_ohm_km = 2.0", "wet_ohm_km = 1.5");
    assert!(narrow.starts_with("table.highest[0] is ") && narrow.contains("must be at least"), "{narrow}");
    // And drier weather.
    let narrow = refused("dry_ohm_km = 50.0", "dry_ohm_km = 90.0");
    assert!(narrow.starts_with("table.lowest[") && narrow.contains("must be at most"), "{narrow}");
    assert!(Calibration::from_toml("format = ").is_err());
}

#[test]
fn a_wider_table_is_accepted() {
    let calibration = Calibration::new(plan(ARRANGEMENTS[0], Ground::Uniform)).expect("a usual plan");
    let text = calibration.to_toml().replacen("highest = [151,", "highest = [170,", 1);
    let read = Calibration::from_toml(&text).expect("wider");
    assert_eq!((read.table().highest()[0].0, calibration.table().highest()[0].0), (170, 151), "{text}");
}
