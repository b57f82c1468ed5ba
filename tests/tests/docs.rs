//! The README's picture is what the oracle draws today.

use atc_oracle::chart::{View, svg};
use atc_oracle::trace::{Replies, Trace};

fn text(path: &str) -> String {
    let path = format!("{}/../{path}", env!("CARGO_MANIFEST_DIR"));
    std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{path}: {error}"))
}

#[test]
fn the_picture_of_the_readme_is_current() {
    let trace = Trace::parse(&text("oracle/examples/figure-3.jsonl")).unwrap();
    let view = View { title: Some("Figure 3: an interruption of 650 ms".to_owned()), ..View::default() };
    let drawn = svg(&trace, Replies::MustAgree, &view).unwrap();
    let hint = "draw it again: oracle chart oracle/examples/figure-3.jsonl \
                --title \"Figure 3: an interruption of 650 ms\" -o docs/figure-3.svg";
    assert!(drawn == text("docs/figure-3.svg"), "{hint}");
}
