//! A badge: the verdict in a small picture.

use super::{Report, Word};

/// The badge as an SVG document: green only if everything agrees and nothing was left out.
pub fn badge(report: &Report) -> String {
    let count = |word: Word| report.machines.iter().filter(|machine| machine.verdict == word).count();
    let (agree, all) = (count(Word::Agrees), report.machines.len());
    let (words, colour) = match (report.agrees, count(Word::NotCompared)) {
        (true, 0) => (format!("{agree}/{all} agree"), "#2a7d3f"),
        (true, _) => (format!("{agree}/{all} agree"), "#8a6d00"),
        (false, left) if left == all => ("not compared".to_owned(), "#666666"),
        (false, _) => ("differs".to_owned(), "#b3261e"),
    };
    format!(
        r##"<svg xmlns="http://www.w3.org/2000/svg" width="190" height="20" role="img" aria-label="conformance: {words}"><title>conformance: {words}</title><rect width="100" height="20" fill="#444444"/><rect x="100" width="90" height="20" fill="{colour}"/><g fill="#ffffff" text-anchor="middle" font-family="Verdana, Arial, sans-serif" font-size="11"><text x="50" y="14">conformance</text><text x="145" y="14">{words}</text></g></svg>
"##
    )
}
