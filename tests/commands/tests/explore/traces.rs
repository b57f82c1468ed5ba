//! The traces of models: what a model knows of each step is in the film, and its accidents are events.

use atc_film::Class;
use atc_models::{catalogue, check};
use atc_oracle::film::{self, Setting, TracedError};

use super::file;

/// The outcomes of models as `models check --json` writes them.
fn outcomes(names: &[&str]) -> String {
    let entries = catalogue().into_iter().filter(|entry| names.contains(&entry.name));
    let outcomes: Vec<_> = entries.map(|entry| check(&entry, 1)).collect();
    assert_eq!(outcomes.len(), names.len());
    serde_json::to_string(&outcomes).expect("JSON")
}

#[test]
fn an_accident_of_a_model_is_a_film() {
    let text = outcomes(&["interlocking-no-approach", "misread"]);
    let Err(TracedError::Model(what)) = film::read(&text, None) else { panic!("one of several") };
    let expected = "misread/misread-is-displayed, misread/shows-what-is-sent, interlocking-no-approach/derailment";
    assert_eq!(what, format!("name one trace with --trace; there are {expected}"));
    let Err(TracedError::Model(_)) = film::read(&text, Some("no-such")) else { panic!("there is none") };

    let traced = film::read(&text, Some("derailment")).expect("a trace");
    assert_eq!(
        traced.title.as_deref().map(|title| title.starts_with("interlocking-no-approach/derailment: ")),
        Some(true)
    );
    let setting = Setting { words: traced.words.clone(), ..Setting::default() };
    let made = film::film(&traced.trace.cases[0], &setting).expect("a film");
    assert_eq!((made.frames as usize, made.trains.len()), (traced.words.len(), 3));
    for (frame, words) in (0..).zip(&traced.words) {
        for (number, train) in made.trains.iter().enumerate() {
            let truth = &words["trains"][number];
            for what in ["front", "rear", "heading"] {
                assert_eq!(
                    made.word_at(("train", train, what), frame),
                    truth[what].as_str().unwrap_or_default(),
                    "{truth}"
                );
            }
        }
    }
    let harm: Vec<_> = made.events.iter().filter(|event| event.class == Class::Harm).collect();
    assert_eq!((harm.len(), harm[0].at), (1, made.frames - 1));
    assert_eq!(made.words[harm[0].text as usize], "harm: derailment");
    // A schematic: every circuit, point and signal of the plan.
    let svg = &made.plans[0].svg;
    for mark in ["data-circuit=\"W\"", "data-circuit=\"two\"", "data-point=\"P1\"", "data-signal=\"R7\""] {
        assert!(svg.contains(mark), "{mark}");
    }
    // A layout of another station does not fit.
    let layout = atc_layout::read(file("layouts/passing-loop.toml")).expect("a layout");
    let other = Setting { layout: Some(layout), ..setting };
    let error = film::film(&traced.trace.cases[0], &other).expect_err("another station").to_string();
    assert!(error.contains("it has no circuit W, west, one, two, east, E; it has "), "{error}");

    let traced = film::read(&text, Some("misread/misread-is-displayed")).expect("a trace");
    let setting = Setting { words: traced.words.clone(), ..Setting::default() };
    let made = film::film(&traced.trace.cases[0], &setting).expect("a film");
    let last = made.frames - 1;
    assert_eq!(made.word_at(("truth", "sent km h", "value"), last), "25");
    assert_eq!(made.word_at(("output", "display_km_h", "value"), last), "45");
}
