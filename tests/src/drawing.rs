//! Drawn charts, and what is read back from them.

use atc_oracle::chart::{self, Part, View};
use atc_oracle::trace::{Replies, Trace};

/// The chart of a trace, or a part of it.
///
/// # Panics
/// If it is no trace, or cannot be drawn.
pub fn draw(trace: &str, replies: Replies, only: Option<Part>) -> String {
    let view = View { only, ..View::default() };
    chart::svg(&Trace::parse(trace).expect("a trace"), replies, &view).expect("a chart")
}

/// The titles of what is drawn: text, and where it is. The first is the document's own, and left out.
pub fn titles(svg: &str) -> Vec<String> {
    let titles = svg.split("<title>").skip(2).filter_map(|rest| rest.split("</title>").next());
    titles.map(|title| title.replace('\n', "").replace("&lt;", "<").replace("&gt;", ">")).collect()
}
