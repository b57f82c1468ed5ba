//! The pictures in `docs/` are what the oracle draws today.

use atc_oracle::chart::{View, svg};
use atc_oracle::trace::{Replies, Trace};

fn text(path: &str) -> String {
    let path = format!("{}/../{path}", env!("CARGO_MANIFEST_DIR"));
    std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{path}: {error}"))
}

/// The picture of an example, under its title.
fn check(example: &str, title: &str, picture: &str) {
    let trace = Trace::parse(&text(example)).unwrap();
    let view = View { title: Some(title.to_owned()), ..View::default() };
    let drawn = svg(&trace, Replies::MustAgree, &view).unwrap();
    assert!(drawn == text(picture), "draw it again: oracle chart {example} --title {title:?} -o {picture}");
}

#[test]
fn the_picture_of_the_readme_is_current() {
    check("oracle/examples/figure-3.jsonl", "Figure 3: an interruption of 650 ms", "docs/figure-3.svg");
}

#[test]
fn the_picture_of_block_counting_is_current() {
    let title = "Figure 8: three trains through a block of three sections";
    check("oracle/examples/figure-8.jsonl", title, "docs/figure-8.svg");
}
