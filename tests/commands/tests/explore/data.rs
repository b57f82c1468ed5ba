//! What a film says, frame by frame.

use std::collections::BTreeMap;

use atc_film::{Class, Film, TOO_LONG};
use serde_json::Value;
use snapbox::{assert_data_eq, file};

use super::{answered, filmed, random_session, text};

/// A list of names as a set of texts.
fn list(value: &Value) -> Vec<&str> {
    value.as_array().expect("a list").iter().map(|name| name.as_str().expect("a name")).collect()
}

/// Whether each frame of an interlocking says what was read and answered in it: nothing less, nothing more.
fn check(session: &str) {
    let (steps, outputs) = answered(session);
    let film = filmed(session);
    assert_eq!(film.frames as usize, outputs.len());
    let names = |kind: &str| -> Vec<&str> {
        let mut names: Vec<&str> =
            film.channels.iter().filter(|one| one.kind == kind).map(|one| one.name.as_str()).collect();
        names.dedup();
        names
    };
    for (frame, (step, output)) in (0_u32..).zip(steps.iter().zip(&outputs)) {
        let said = |kind: &str, name: &str, what: &str| film.word_at((kind, name, what), frame);
        let at = |what: &str| format!("{what} in frame {frame}: {output}");
        let phases: BTreeMap<&str, &str> = names("route")
            .into_iter()
            .map(|name| (name, said("route", name, "phase")))
            .filter(|(_, is)| !is.is_empty())
            .collect();
        let routes = output["routes"].as_object().expect("routes");
        let routes: BTreeMap<&str, &str> =
            routes.iter().map(|(name, phase)| (name.as_str(), phase.as_str().expect("a phase"))).collect();
        assert_eq!(phases, routes, "{}", at("phases"));
        let shown = names("route").into_iter().filter(|name| !said("route", name, "signal").is_empty());
        let mut shown: Vec<&str> = shown.collect();
        shown.sort_unstable();
        assert_eq!(shown, list(&output["proceed"]), "{}", at("proceed"));
        for name in names("circuit") {
            let occupied = list(&step["occupied"]).contains(&name);
            assert_eq!(said("circuit", name, "reported"), if occupied { "occupied" } else { "" });
            // What is reported occupied counts at once.
            assert!(!occupied || said("circuit", name, "counted") == "occupied", "{}", at(name));
            let telegram = &output["telegrams"][name];
            let told = said("circuit", name, "told");
            assert_eq!(told.is_empty(), telegram.is_null(), "{}", at(name));
            let stop = telegram["stop"].as_str().unwrap_or_default();
            let end = format!("to {stop} at {}", telegram["speed_km_h"]);
            assert!(told.is_empty() || told.ends_with(&end), "{told}: {}", at(name));
            let confirmed = list(&output["confirmed"]).contains(&name);
            assert_eq!(said("circuit", name, "block") == "confirmed", confirmed, "{}", at(name));
        }
        for name in names("point") {
            let driven = output["drives"][name].as_str().unwrap_or_default();
            assert_eq!(said("point", name, "driven"), driven, "{}", at(name));
            assert_eq!(said("point", name, "detected"), step["detected"][name].as_str().unwrap_or("none"));
        }
        for name in names("segment") {
            assert_eq!(
                said("segment", name, "permit") == "yes",
                list(&output["permits"]).contains(&name),
                "{}",
                at(name)
            );
        }
        let answer = said("request", "request", "answer");
        match &output["answer"] {
            Value::Null => assert_eq!(answer, ""),
            Value::String(word) => assert_eq!(answer, word),
            refused => {
                let reason = refused["refused"].as_str().expect("a reason");
                assert!(answer.starts_with(&format!("refused: {reason}")), "{answer}: {refused}");
            }
        }
    }
}

#[test]
fn each_frame_of_the_example_says_what_was_answered() {
    check(&text("oracle/examples/interlocking.jsonl"));
}

#[test]
fn each_frame_of_random_sessions_says_what_was_answered() {
    let mut seen = BTreeMap::new();
    for seed in 1..25 {
        let session = random_session(seed, 150);
        check(&session);
        for output in answered(&session).1 {
            let mut add = |what: &str| *seen.entry(what.to_owned()).or_insert(0) += 1;
            output["routes"]
                .as_object()
                .expect("routes")
                .values()
                .for_each(|phase| add(phase.as_str().expect("a phase")));
            for (field, words) in
                [("proceed", "proceed"), ("telegrams", "told"), ("drives", "driven"), ("confirmed", "confirmed")]
            {
                let empty = output[field].as_array().is_some_and(Vec::is_empty)
                    || output[field].as_object().is_some_and(serde_json::Map::is_empty);
                if !empty {
                    add(words);
                }
            }
        }
    }
    println!("in random sessions: {seen:?}");
    for what in ["provisional", "set", "in-use", "releasing", "proceed", "told", "driven", "confirmed"] {
        assert!(seen.get(what).is_some_and(|times| *times >= 20), "{what}: {seen:?}");
    }
}

/// Every other machine: the values as they stand on the wire.
#[test]
fn each_frame_of_every_machine_says_what_was_answered() {
    let mut machines = 0;
    for entry in std::fs::read_dir(super::file("oracle/examples")).expect("examples") {
        let path = entry.expect("an entry").path();
        if path.extension().is_none_or(|ending| ending != "jsonl") || path.ends_with("interlocking.jsonl") {
            continue;
        }
        let session = std::fs::read_to_string(&path).expect("a session");
        let (film, (_, outputs)) = (filmed(&session), answered(&session));
        assert_eq!(film.frames as usize, outputs.len(), "{}", path.display());
        for (frame, output) in (0_u32..).zip(&outputs) {
            for (name, value) in output.as_object().expect("an output") {
                let said = film.word_at(("output", name, "value"), frame);
                match value {
                    Value::Null => assert_eq!(said, "none"),
                    Value::String(word) => assert!(said == word || said.ends_with('…'), "{said}, {word}"),
                    Value::Number(_) | Value::Bool(_) => assert_eq!(said, value.to_string()),
                    // Lists and objects are told in words.
                    Value::Array(list) => assert_eq!(said.is_empty(), list.is_empty(), "{name}: {value}"),
                    Value::Object(map) => assert_eq!(said.is_empty(), map.is_empty(), "{name}: {value}"),
                }
            }
        }
        machines += 1;
    }
    assert!(machines >= 10, "{machines}");
}

#[test]
fn events_are_the_steps_in_which_an_answer_changes() {
    let session = random_session(7, 300);
    let film = filmed(&session);
    let (_, outputs) = answered(&session);
    let stops: Vec<u32> =
        film.events.iter().filter(|event| event.class != Class::Input).map(|event| event.at).collect();
    assert!(stops.is_sorted());
    for (frame, pair) in (1_u32..).zip(outputs.windows(2)) {
        for field in ["routes", "proceed", "drives", "telegrams", "permits"] {
            let changed = pair[0][field] != pair[1][field];
            assert!(!changed || stops.contains(&frame), "{field} changes in frame {frame}, which is no event");
        }
    }
}

/// The form of the data, as the page reads it.
#[test]
fn the_form_of_the_data() {
    let session = concat!(
        r#"{"start":{"protocol":1,"machine":"speed-supervision"}}"#,
        "\n",
        r#"{"step":{"speed_km_h":40,"permitted_km_h":45}}"#,
        "\n",
        r#"{"step":{"speed_km_h":50,"permitted_km_h":45}}"#,
        "\n",
        r#"{"step":{"speed_km_h":50,"permitted_km_h":45}}"#,
        "\n"
    );
    let film = serde_json::to_string_pretty(&filmed(session)).expect("JSON") + "\n";
    assert_data_eq!(film, file!["form.json"].raw());
}

/// 10,000 steps, of which most change something, stay within what a browser and a mail take.
#[test]
fn ten_thousand_steps_are_a_small_page() {
    let film = filmed(&random_session(3, 10_000));
    let page = film.page();
    assert!(page.len() < TOO_LONG, "{} bytes", page.len());
    println!("a page of 10,000 random steps has {} bytes", page.len());
}

/// What is read back is what was put in.
#[test]
fn channels_and_curves_are_read_back() {
    let clock = atc_film::Clock { unit: "ms".to_owned(), per_frame: 10, last: Some(35) };
    let mut film = Film::new("A film", clock, 5);
    let words = ["", "a", "a", "b", ""];
    film.channel(("thing", "one", "is"), words);
    film.channel(("thing", "two", "is"), [""; 5]);
    let numbers = [None, Some(5), Some(-3), None, Some(7)];
    film.curve(("thing", "one", "much"), ("m", 10), numbers);
    for (frame, (word, number)) in (0..).zip(words.iter().zip(numbers)) {
        assert_eq!(film.word_at(("thing", "one", "is"), frame), *word);
        assert_eq!(film.number_at(("thing", "one", "much"), frame), number);
    }
    assert_eq!(film.word_at(("thing", "one", "is"), 99), "");
    assert_eq!(film.number_at(("thing", "one", "much"), 99), None);
    // Nothing is said of the other one, and no room is taken by it.
    assert_eq!((film.channels.len(), film.word_at(("thing", "two", "is"), 2)), (1, ""));
    assert_eq!([0, 3, 4].map(|frame| film.time(frame)), [0, 30, 35]);
}

/// The page has the film in it, and nothing of it can end the script or load anything from elsewhere.
#[test]
fn the_page_needs_nothing_but_itself() {
    let clock = atc_film::Clock { unit: "ms".to_owned(), per_frame: 10, last: None };
    let mut film = Film::new("A </script><b>&amp; <!--put film-->", clock, 1);
    film.channel(("x", "</script>", "<!--"), ["<!--put logic-->"]);
    let page = film.page();
    let begin = page.find(r#"id="film">"#).expect("the film") + r#"id="film">"#.len();
    let length = page[begin..].find("</script>").expect("an end");
    let read: Film = serde_json::from_str(&page[begin..begin + length]).expect("the film");
    assert_eq!(serde_json::to_value(&read).expect("JSON"), serde_json::to_value(&film).expect("JSON"));
    assert!(
        page.contains("<title>A &lt;/script&gt;&lt;b&gt;&amp;amp; &lt;!--put film--&gt;</title>"),
        "{}",
        &page[..400]
    );
    assert!(!page.contains("<!--put "), "a place that was not filled");
    for outside in ["src=", "href=", "@import", "url(", "fetch(", "https:"] {
        assert!(!page.contains(outside), "the page has {outside}");
    }
    let links: Vec<&str> = page.match_indices("http:").map(|(at, _)| &page[at..at + 26]).collect();
    assert!(links.iter().all(|link| *link == "http://www.w3.org/2000/svg"), "{links:?}");
}
