//! Small parts of the document: badges, links, times.

use crate::judge::verdict::Verdict;
use maud::{Markup, html};

/// A verdict as a badge: a word and a colour.
pub(super) fn badge(verdict: Verdict) -> Markup {
    html! { span class={ "badge " (verdict.word()) } title=(verdict.meaning()) { (verdict.word()) } }
}

/// Seconds, short.
pub(super) fn seconds(seconds: f64) -> String {
    if seconds <= 0.0 {
        "–".to_owned()
    } else if seconds < 9.95 {
        format!("{seconds:.1} s")
    } else {
        format!("{seconds:.0} s")
    }
}

/// A date and time, UTC.
pub(super) fn date(unix: u64) -> String {
    i64::try_from(unix)
        .ok()
        .and_then(|unix| chrono::DateTime::from_timestamp(unix, 0))
        .map_or_else(|| "unknown".to_owned(), |time| time.format("%Y-%m-%d %H:%M UTC").to_string())
}

/// An evidence id as a link to its row.
pub(super) fn link(id: &str) -> Markup {
    let target = id.replace([':', '*'], "-");
    html! { a href={ "#" (target) } { code { (id) } } }
}

/// Links, with commas.
pub(super) fn links(ids: &[String]) -> Markup {
    html! {
        @for (place, id) in ids.iter().enumerate() {
            @if place > 0 { ", " }
            (link(id))
        }
    }
}

/// The anchor of an evidence id.
pub(super) fn anchor(id: &str) -> String {
    id.replace([':', '*'], "-")
}
