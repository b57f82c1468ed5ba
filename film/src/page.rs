//! The page: one file with everything in it.

use crate::form::Film;

const HTML: &str = include_str!("../page/page.html");
const STYLE: &str = include_str!("../page/page.css");
const LOGIC: &str = include_str!("../page/logic.js");
const ROWS: &str = include_str!("../page/rows.js");
const STAGE: &str = include_str!("../page/stage.js");
const KERNEL: &str = include_str!("../page/kernel.js");
const PLAYER: &str = include_str!("../page/player.js");

/// How many bytes a page may have and still be handled well by browsers and mail.
pub const TOO_LONG: usize = 5_000_000;

impl Film {
    /// The page that plays the film, as one HTML file.
    ///
    /// # Panics
    /// Never: a film is plain data, which JSON can hold.
    pub fn page(&self) -> String {
        // In JSON a "<" is inside a string, so this ends no script and changes nothing.
        let data = serde_json::to_string(self).expect("plain data").replace('<', "\\u003c");
        let title = escape(&self.title);
        // A place is looked for in the page alone, never in what was put into another.
        let mut page = String::with_capacity(data.len() + 100_000);
        let mut rest = HTML;
        while let Some((before, after)) = rest.split_once("<!--put ") {
            page.push_str(before);
            let Some((what, behind)) = after.split_once("-->") else { break };
            page.push_str(match what {
                "title" => &title,
                "style" => STYLE,
                "film" => &data,
                "logic" => LOGIC,
                "rows" => ROWS,
                "stage" => STAGE,
                "kernel" => KERNEL,
                "player" => PLAYER,
                _ => "",
            });
            rest = behind;
        }
        page.push_str(rest);
        page
    }
}

fn escape(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}
