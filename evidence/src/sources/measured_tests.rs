//! A run with good figures, and everything that can be wrong with one.

use super::{Bench, Ran, Run, TARGETS, engine, evidence, read};
use crate::case::Kind;
use crate::judge::verdict::Verdict;
use serde_json::{Value, json};

/// A run in which every target is met.
fn good() -> Value {
    let point = |db: f64, errors: u64, theory: f64, loss: Option<f64>| {
        json!({ "eb_n0_db": db, "bits": 100_000, "errors": errors,
        "rate": f64::from(u32::try_from(errors).expect("few")) / 1e5, "theory": theory, "loss_db": loss, "coherent": theory })
    };
    let points = [
        point(0.0, 14_000, 0.14, Some(0.1)),
        point(1.0, 10_000, 0.1, Some(0.1)),
        point(2.0, 7_000, 0.07, Some(0.2)),
        point(3.0, 4_500, 0.045, Some(0.1)),
        point(4.0, 2_500, 0.025, Some(0.1)),
        point(5.0, 10, 0.0001, None),
    ];
    let curve = |name: &str, codes: Value, offset: f64| json!({ "name": name, "codes_hz": codes, "offset_hz": offset, "points": points, "worst_loss_db": 0.2 });
    let times = json!({ "heard": 1.0, "median": 0.3, "percentile_95": 0.4, "longest": 0.5 });
    let detection = json!({ "snr_db": 10.0, "eb_n0_db": 20.0, "trials": 24, "code": times, "main_telegram": times, "wrong_speeds": 0,
        "wrong_telegrams": 0 });
    let run = json!({ "arrangement": "a", "ohm_km": 10.0, "odometer": "with", "answered": 1.0, "wrong": 0.0, "mean_width": 50.0,
        "points": [{ "seconds": 0.0, "truth": 5.0, "interval": [4.0, 6.0] }, { "seconds": 1.0, "truth": 3.0, "interval": null }] });
    json!({
        "signal": {
            "extent": "quick", "seed": 1, "receiver": "coherent",
            "bit_errors": [curve("no code", Value::Null, 0.0), curve("off", Value::Null, 1.0), curve("code", json!([10.0, 12.0]), 0.0)],
            "detection": [detection],
            "false_codes": { "windows": 1000, "disjoint_windows": 100, "codes": 0, "speeds": 0, "code_rate": 0.03, "window_s": 0.4 },
            "throughput": { "signal_s": 30.0, "transmitter": 1.0, "conventional": 2.0, "on_board": 3.0, "track_circuit": 4.0 }
        },
        "position": {
            "conditions": "a section", "runs": [run], "from_samples": [run],
            "outside": [{ "arrangement": "a", "ohm_km": 1.0, "wrong": 0.9 }],
            "reflections": [{ "line": "half and half", "greatest_db": 0.5 }],
            "meter": [{ "signal_to_noise_db": 30.0, "windows": 400, "deviation_db": 0.01, "expected_db": 0.01, "greatest_db": 0.03 }]
        }
    })
}

/// What was measured of the line, with every target met.
fn line() -> Value {
    let one = |needless: u32| {
        json!({ "interruptions": 70, "needless": needless, "alone": 0, "delay_s": 1.0, "stop_m": 74.0,
        "pattern_m": 59.0, "train_m": 80.0, "unsafe_events": 0 })
    };
    json!({
        "extent": { "trains": 3, "seconds": 900, "every_s": 12, "longest_ms": 700, "step_ms": 200, "seed": 1 },
        "rows": [
            { "length_ms": 500, "shortened": one(1), "conventional": one(70) },
            { "length_ms": 700, "shortened": one(70), "conventional": one(69) },
        ]
    })
}

/// What faults led to on the line, with every target met.
fn harm() -> Value {
    let single =
        |signal: &str| json!({ "signal": signal, "runs": 55, "unsafe_runs": 0, "arrivals": 250, "first": null });
    json!({
        "seen": {
            "singles": [single("codes"), single("telegrams")],
            "cut_sets": [{ "name": "both", "happens": "It is hurt.", "both": ["a", "b"], "harm": "harm", "alone": [null, null] }],
        },
        "pages": [{ "name": "both", "caption": "It is hurt.", "html": "<!doctype html>" }]
    })
}

/// A good run but for the line; `Value::Null` if that was not measured.
fn with_line(line: &Value) -> Run {
    let Run::Ran(mut ran) = ran(&good()) else { panic!("a run") };
    ran.headline = serde_json::from_value(line.clone()).expect("a headline");
    Run::Ran(ran)
}

fn ran(bench: &Value) -> Run {
    let bench: Bench = serde_json::from_value(bench.clone()).expect("a run");
    let headline = serde_json::from_value(line()).expect("a headline");
    let plots = vec![("bit-errors".to_owned(), "<?xml version=\"1.0\"?>\n<svg>curve</svg>\n".to_owned())];
    let harm = serde_json::from_value(harm()).expect("what was seen");
    Run::Ran(Box::new(Ran { bench, headline, harm, plots, source: "run here".to_owned(), seconds: 1.0 }))
}

/// The verdict of a target after a change at a JSON pointer.
fn verdict(target: &str, at: &str, to: Value) -> (Verdict, String) {
    let mut bench = good();
    *bench.pointer_mut(at).unwrap_or_else(|| panic!("{at} is not there")) = to;
    let (all, _) = evidence(&ran(&bench));
    let one = all.iter().find(|one| one.title == target).expect("a target");
    let others = all.iter().filter(|other| other.title != target && other.verdict != Verdict::Measured).count();
    assert_eq!(others, 0, "{at} touches other targets");
    (one.verdict, one.reason.clone().unwrap_or_default())
}

#[test]
fn a_good_run_meets_every_target_and_is_called_measured() {
    let (all, measured) = evidence(&ran(&good()));
    assert_eq!(all.len(), TARGETS.len());
    assert!(
        all.iter().all(|one| one.kind == Kind::Measured && one.verdict == Verdict::Measured && one.reason.is_none())
    );
    assert!(all.iter().all(|one| !one.detail.is_empty()));
    // Every target has figures, every figure with a limit a target, and no figure in seconds has one.
    for figure in &measured.figures {
        assert_eq!(figure.at_most.is_some(), figure.evidence.is_some(), "{}", figure.name);
        assert!(figure.at_most.is_none() || figure.unit != "s", "{}", figure.name);
    }
    assert_eq!(measured.plots[0].svg, "<svg>curve</svg>");
    assert_eq!(measured.films[0].page, "<!doctype html>");
    let engine = engine(&all, &measured);
    assert_eq!((engine.name.as_str(), engine.verdict), ("waveform", Verdict::Measured));
    assert!(engine.summary.contains("13 of 13 targets met"), "{}", engine.summary);
}

#[test]
fn every_target_can_be_missed() {
    for (target, at, to) in [
        ("ber-coherent", "/signal/bit_errors/0/points/2/loss_db", json!(1.01)),
        ("ber-offset", "/signal/bit_errors/1/points/2/loss_db", json!(1.01)),
        ("ber-under-code", "/signal/bit_errors/2/points/2/loss_db", json!(1.01)),
        ("wrong-telegrams", "/signal/detection/0/wrong_telegrams", json!(1)),
        ("wrong-speeds", "/signal/detection/0/wrong_speeds", json!(1)),
        ("false-codes", "/signal/false_codes/speeds", json!(1)),
        ("level-tolerance", "/position/meter/0/greatest_db", json!(0.11)),
    ] {
        let (verdict, reason) = verdict(target, at, to);
        assert_eq!(verdict, Verdict::Failed, "{target}: {reason}");
        assert!(reason.contains("and at most"), "{reason}");
    }
    for (target, runs) in [("position-inside", "runs"), ("position-samples", "from_samples")] {
        let mut bench = good();
        bench["position"][runs][0]["points"][0]["truth"] = json!(6.1);
        bench["position"][runs][0]["wrong"] = json!(0.5);
        let (all, _) = evidence(&ran(&bench));
        let one = all.iter().find(|one| one.title == target).expect("a target");
        assert_eq!(one.verdict, Verdict::Failed, "{target}");
    }
}

#[test]
fn what_is_measured_of_the_line_can_be_missed_vacuous_or_not_run() {
    let verdicts = |line: &Value| {
        let (all, _) = evidence(&with_line(line));
        ["line-safe", "line-needless"].map(|name| all.iter().find(|one| one.title == name).expect("a target").verdict)
    };
    let changed = |at: &str, to: Value| {
        let mut line = line();
        *line.pointer_mut(at).unwrap_or_else(|| panic!("{at} is not there")) = to;
        verdicts(&line)
    };
    assert_eq!(verdicts(&line()), [Verdict::Measured; 2]);
    assert_eq!(changed("/rows/0/shortened/unsafe_events", json!(1)), [Verdict::Failed, Verdict::Measured]);
    assert_eq!(changed("/rows/1/conventional/unsafe_events", json!(1)), [Verdict::Failed, Verdict::Measured]);
    assert_eq!(changed("/rows/1/shortened/alone", json!(1)), [Verdict::Measured, Verdict::Failed]);
    assert_eq!(changed("/rows/1/shortened/interruptions", json!(69)), [Verdict::Undecided; 2]);
    assert_eq!(changed("/rows/0/shortened/interruptions", json!(19)), [Verdict::Vacuous; 2]);
    assert_eq!(changed("/rows", json!([])), [Verdict::Vacuous; 2]);
    assert_eq!(verdicts(&Value::Null), [Verdict::NotRun; 2]);
}

#[test]
fn what_faults_lead_to_can_be_harm_vacuous_or_not_run() {
    let verdicts = |harm: &Value| {
        let Run::Ran(mut ran) = ran(&good()) else { panic!("a run") };
        ran.harm = serde_json::from_value(harm.clone()).expect("what was seen");
        let (all, _) = evidence(&Run::Ran(ran));
        ["line-single-faults", "line-cut-sets"]
            .map(|name| all.iter().find(|one| one.title == name).expect("a target").verdict)
    };
    let changed = |changes: &[(&str, Value)]| {
        let mut harm = harm();
        for (at, to) in changes {
            *harm.pointer_mut(at).unwrap_or_else(|| panic!("{at} is not there")) = to.clone();
        }
        verdicts(&harm)
    };
    assert_eq!(changed(&[]), [Verdict::Measured; 2]);
    let unsafe_run = ("/seen/singles/1/unsafe_runs", json!(1));
    assert_eq!(changed(std::slice::from_ref(&unsafe_run)), [Verdict::Undecided; 2], "nothing says what happened");
    let first = ("/seen/singles/1/first", json!("a train"));
    assert_eq!(changed(&[unsafe_run, first]), [Verdict::Failed, Verdict::Measured]);
    assert_eq!(changed(&[("/seen/cut_sets/0/harm", Value::Null)]), [Verdict::Measured, Verdict::Failed]);
    assert_eq!(changed(&[("/seen/cut_sets/0/alone/1", json!("harm"))]), [Verdict::Measured, Verdict::Failed]);
    assert_eq!(changed(&[("/seen/singles/0/arrivals", json!(100))]), [Verdict::Vacuous; 2]);
    assert_eq!(changed(&[("/seen/singles", json!([]))]), [Verdict::Vacuous; 2]);
    assert_eq!(changed(&[("/seen/cut_sets", json!([]))]), [Verdict::Vacuous; 2]);
    assert_eq!(verdicts(&Value::Null), [Verdict::NotRun; 2]);
}

#[test]
fn a_run_that_looked_at_nothing_shows_nothing() {
    for (target, at, to) in [
        ("ber-coherent", "/signal/bit_errors/0/points", json!([])),
        ("ber-offset", "/signal/bit_errors/1/points/0/loss_db", Value::Null),
        ("wrong-telegrams", "/signal/detection/0/main_telegram/heard", json!(0.5)),
        ("wrong-speeds", "/signal/detection/0/code/heard", json!(0.5)),
        ("false-codes", "/signal/false_codes/windows", json!(0)),
        ("level-tolerance", "/position/meter/0/windows", json!(0)),
        ("position-inside", "/position/runs/0/answered", json!(0.4)),
        ("position-samples", "/position/from_samples", json!([])),
    ] {
        let (verdict, reason) = verdict(target, at, to);
        assert_eq!(verdict, Verdict::Vacuous, "{target}: {reason}");
    }
    let mut bench = good();
    bench["signal"]["bit_errors"].as_array_mut().expect("a list").remove(1);
    let (all, _) = evidence(&ran(&bench));
    let one = all.iter().find(|one| one.title == "ber-offset").expect("a target");
    assert_eq!(one.verdict, Verdict::Vacuous);
}

#[test]
fn figures_that_contradict_each_other_show_nothing() {
    for (target, at, to, words) in [
        ("ber-coherent", "/signal/bit_errors/0/points/2/rate", json!(0.01), "its rate is not that of its errors"),
        ("position-inside", "/position/runs/0/points/0/truth", json!(6.1), "its cycles say otherwise"),
        ("position-samples", "/position/from_samples/0/wrong", json!(0.5), "its cycles say otherwise"),
    ] {
        let (verdict, reason) = verdict(target, at, to);
        assert_eq!(verdict, Verdict::Undecided, "{target}: {reason}");
        assert!(reason.contains(words), "{reason}");
    }
    // More errors than theory has at 1 dB less, and a loss of 0.2 dB.
    let mut bench = good();
    let point = bench.pointer_mut("/signal/bit_errors/0/points/2").expect("there");
    (point["errors"], point["rate"]) = (json!(10_500), json!(0.105));
    let (all, _) = evidence(&ran(&bench));
    let one = all.iter().find(|one| one.title == "ber-coherent").expect("a target");
    assert_eq!(one.verdict, Verdict::Undecided);
    assert!(one.reason.as_deref().is_some_and(|reason| reason.contains("its loss is not that of its rate")));
}

#[test]
fn no_run_is_not_run_and_a_broken_one_is_undecided() {
    let (all, measured) = evidence(&Run::NotRun("left out".to_owned()));
    assert!(all.len() == TARGETS.len() && all.iter().all(|one| one.verdict == Verdict::NotRun));
    assert_eq!(engine(&all, &measured).verdict, Verdict::NotRun);
    let folder = tempfile::tempdir().expect("a folder");
    let Run::Failed(why) = read(folder.path(), "here") else { panic!("there is nothing") };
    assert!(why.contains("bench.json"), "{why}");
    std::fs::write(folder.path().join("bench.json"), "{\"signal\": {}}").expect("written");
    let Run::Failed(why) = read(folder.path(), "here") else { panic!("there is nothing in it") };
    assert!(why.contains("not what `waveform bench` writes: missing field"), "{why}");
    let (all, _) = evidence(&Run::Failed(why));
    assert!(all.iter().all(|one| one.verdict == Verdict::Undecided));
    std::fs::write(folder.path().join("bench.json"), good().to_string()).expect("written");
    std::fs::write(folder.path().join("detection.svg"), "<svg/>").expect("written");
    let Run::Ran(ran) = read(folder.path(), "here") else { panic!("it is all there") };
    assert_eq!(ran.plots, [("detection".to_owned(), "<svg/>".to_owned())]);
    super::tidy(folder.path());
    assert!(folder.path().join("bench.json").exists() && !folder.path().join("detection.svg").exists());
}

#[test]
fn values_are_shown_with_their_unit() {
    for (value, unit, text) in [
        (0.0, "%", "0 %"),
        (0.315_6, "dB", "0.32 dB"),
        (12.34, "m", "12.3 m"),
        (959.5, "m", "960 m"),
        (0.000_24, "", "2.4 · 10⁻⁴"),
        (3.0, "", "3"),
        (0.001_81, "", "1.8 · 10⁻³"),
        (0.033_5, "dB", "0.034 dB"),
        (5e-15, "dB", "0 dB"),
    ] {
        assert_eq!(super::shown(Some(value), unit), text);
    }
    assert_eq!(super::shown(None, "s"), "not known");
}
