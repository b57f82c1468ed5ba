//! Machine `train` of protocol 1: telegrams of the other direction of travel, and a train that changes ends.

use atc_tests::session::{converse, start, step};
use serde_json::{Value, json};

/// In cycles of 100 ms a telegram every second one, for `section`; the train stands. With it, how the train faces.
fn session(cycles: &[(u16, Option<&str>)]) -> Vec<Value> {
    let begin = start("train", &json!({"permitted": {"cycle_ms": 100}}).to_string());
    let steps = cycles.iter().enumerate().map(|(cycle, (section, facing))| {
        let mut body = json!({"moved_m": [0, 0], "speed_km_h": 0});
        let counter = cycle / 2 % 256;
        if cycle % 2 == 0 {
            let main = json!({"section": section, "counter": counter, "beyond_exit_m": 400, "speed_rank": 7});
            body["main"] = json!({"telegram": {"main": main}});
        } else {
            let sub = json!({
                "section": section, "counter": counter, "length_m": 200, "gradient_permille": 0,
                "curve_rank": 7, "restriction_rank": 7,
            });
            body["sub"] = json!({"telegram": {"sub": sub}});
        }
        if let Some(facing) = facing {
            body["facing"] = (*facing).into();
        }
        step(&body.to_string())
    });
    let lines: Vec<String> = std::iter::once(begin).chain(steps).collect();
    let said = converse(&lines.iter().map(String::as_str).collect::<Vec<_>>());
    assert!(said[0].starts_with("{\"started\""), "{}", said[0]);
    said[1..].iter().map(|line| serde_json::from_str::<Value>(line).expect("JSON")["output"].clone()).collect()
}

/// Whether the train may move.
fn permitted(output: &Value) -> bool {
    output["permitted_km_h"].as_f64().is_some_and(|speed| speed > 0.0)
}

#[test]
fn a_train_takes_no_telegram_of_the_other_direction_of_travel() {
    let all = |section: u16, facing| session(&[(section, facing); 20]);
    // Section 7 is for trains to the left, 8 for those to the right.
    for (section, facing) in [(7, "left"), (8, "right")] {
        assert!(permitted(&all(section, Some(facing))[19]), "{section} {facing}");
    }
    for (section, facing) in [(8, Some("left")), (7, Some("right")), (7, None), (8, None)] {
        for output in all(section, facing) {
            assert_eq!((&output["permitted_km_h"], &output["brake"]), (&Value::Null, &"emergency".into()));
        }
    }
}

#[test]
fn a_train_that_changes_ends_begins_anew() {
    let left = [(7, Some("left")); 20];
    let after = |more: (u16, Option<&'static str>)| session(&[&left[..], &[more; 20]].concat());
    // What is still sent to the left is for others now; the same if the direction is lost.
    for facing in [Some("right"), None] {
        let outputs = after((7, facing));
        assert!(permitted(&outputs[19]));
        for output in &outputs[20..] {
            assert_eq!((&output["permitted_km_h"], &output["brake"]), (&Value::Null, &"emergency".into()));
        }
    }
    // The ground has set a route for the other direction: it is used when it is said, and not before.
    let outputs = after((8, Some("right")));
    assert_eq!(outputs[20..].iter().position(permitted), outputs.iter().position(permitted));
    // A train that faces left again knows nothing of before.
    let back = [(7, Some("left")); 10];
    let outputs = session(&[&left[..], &[(8, None)], &back].concat());
    assert!(outputs[20..22].iter().all(|output| !permitted(output)));
}

/// A session of a device in two channels, each cycle with the channels that have lost their memory; the brake in each.
fn brakes(channels: u32, lost: &[&[&str]]) -> Vec<String> {
    let begin = start("train", &json!({"channels": channels}).to_string());
    let code = json!({"main": {"code_hz": 22}, "sub": {"code_hz": 21}, "speed_km_h": 30});
    let steps = lost.iter().map(|lost| {
        let mut body = code.clone();
        body["line"] = "analog".into();
        if !lost.is_empty() {
            body["lost"] = json!(lost);
        }
        step(&body.to_string())
    });
    let lines: Vec<String> = std::iter::once(begin).chain(steps).collect();
    let said = converse(&lines.iter().map(String::as_str).collect::<Vec<_>>());
    let of = |line: &String| {
        let reply: Value = serde_json::from_str(line).expect("JSON");
        reply["output"]["brake"].as_str().map_or_else(|| line.clone(), ToOwned::to_owned)
    };
    said[1..].iter().map(of).collect()
}

#[test]
fn a_device_in_two_channels_stops_for_good_once_they_differ() {
    const NONE: &[&str] = &[];
    let running = vec![NONE; 60];
    assert_eq!(brakes(2, &running), brakes(1, &running));
    assert_eq!(brakes(2, &running)[59], "release");
    for channel in ["a", "b"] {
        // Once a channel has lost its memory the other one alone permits nothing, however long the two are alike again.
        let mut lost = running.clone();
        lost.push(&[]);
        let one: [&str; 1] = [channel];
        lost[50] = &one;
        lost.extend(vec![NONE; 100]);
        assert!(brakes(2, &lost)[50..].iter().all(|brake| brake == "emergency"), "{channel}");
        // Both: they begin anew.
        lost[70] = &["a", "b"];
        let after = brakes(2, &lost);
        assert!(after[50..71].iter().all(|brake| brake == "emergency"));
        assert_eq!(after[70..130], brakes(1, &running)[..]);
    }
    // A channel that is not there, one that is there twice, and other numbers of channels.
    let said = brakes(1, &[&["a"]]);
    assert!(said[0].contains("lost names a channel; this device has one channel"), "{}", said[0]);
    let said = brakes(2, &[&["b", "b"]]);
    assert!(said[0].contains("lost names a channel a second time"), "{}", said[0]);
    for (channels, right) in
        [("0", "rejected"), ("3", "rejected"), ("2.0", "started"), ("1e0", "started"), ("\"2\"", "malformed")]
    {
        let said = converse(&[&start("train", &format!("{{\"channels\":{channels}}}"))]);
        assert!(said[0].starts_with(&format!("{{\"{right}\"")), "{channels}: {}", said[0]);
    }
    let said = converse(&[r#"{"start":{"protocol":1.0,"machine":"speed-supervision"}}"#]);
    assert!(said[0].starts_with("{\"started\""), "{}", said[0]);
}
