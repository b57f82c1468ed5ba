//! The pictures in `docs/` are what the oracle draws today.

use atc_oracle::chart::{Part, View, svg};
use atc_oracle::trace::{Replies, Trace};

fn text(path: &str) -> String {
    let path = format!("{}/../../{path}", env!("CARGO_MANIFEST_DIR"));
    std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{path}: {error}"))
}

/// The picture of an example, under its title.
fn check(example: &str, title: &str, only: Option<Part>, picture: &str) {
    let trace = Trace::parse(&text(example)).unwrap();
    let view = View { title: Some(title.to_owned()), only, ..View::default() };
    let drawn = svg(&trace, Replies::MustAgree, &view).unwrap();
    let only = if only == Some(Part::Figure) { " --only figure" } else { "" };
    assert!(drawn == text(picture), "draw it again: oracle chart {example} --title {title:?}{only} -o {picture}");
}

#[test]
fn the_picture_of_the_readme_is_current() {
    check("oracle/examples/figure-3.jsonl", "Figure 3: an interruption of 650 ms", None, "docs/figure-3.svg");
}

#[test]
fn the_picture_of_block_counting_is_current() {
    let title = "Figure 8: three trains through a block of three sections";
    check("oracle/examples/figure-8.jsonl", title, None, "docs/figure-8.svg");
}

#[test]
fn the_picture_of_the_speed_pattern_is_current() {
    let title = "A new and a conventional train on the same ground";
    check("oracle/examples/speed-pattern.jsonl", title, Some(Part::Figure), "docs/speed-pattern.svg");
}

#[test]
fn the_picture_of_the_position_is_current() {
    let title = "A train approaches a transmitter: where it is, and where it can be";
    check("oracle/examples/train-position.jsonl", title, None, "docs/train-position.svg");
}

#[test]
fn the_picture_of_the_frames_is_current() {
    let title = "Frames of a main and a sub telegram, and a stream with both";
    check("oracle/examples/telegram-codec.jsonl", title, None, "docs/telegram-frames.svg");
}

#[test]
fn the_picture_of_the_ground_is_current() {
    let title = "A train over a counted line, through a station and out; a missed detection; a restart";
    check("oracle/examples/wayside.jsonl", title, None, "docs/wayside.svg");
}

#[test]
fn the_picture_of_the_interlocking_is_current() {
    let title = "A train through a passing loop";
    check("oracle/examples/interlocking.jsonl", title, None, "docs/interlocking.svg");
}
