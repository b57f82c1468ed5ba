//! The marks of a track plan.

use std::fmt::Write as _;

use crate::table::escape;

const STYLE: &str = "\
svg.plan .track{fill:none;stroke:#222;stroke-width:3}\
svg.plan .reverse{stroke:#222}\
svg.plan .joint{stroke:#222;stroke-width:2}\
svg.plan .end{stroke:#222;stroke-width:3;fill:none}\
svg.plan text{font:12px system-ui,sans-serif;fill:#222;text-anchor:middle}\
svg.plan .circuit{fill:#0b4a8f}\
svg.plan .small{font-size:10px}\
svg.plan .point{fill:#a03000;font-size:11px;font-weight:600}\
svg.plan .signal{font-size:10px}\
svg.plan .lamp{fill:#c22;stroke:#222}\
svg.plan .mast{stroke:#222;stroke-width:1.5;fill:none}\
svg.plan .leader{stroke:#999;stroke-width:.7}\
svg.plan .segment{fill:#e6f1e4}\
svg.plan .platform{fill:#d8d8d8}\
svg.plan .name{fill:#555;font-size:10px}\
svg.plan .title{font-size:16px;font-weight:600;text-anchor:start}";

/// What a drawn piece of track is.
pub struct Drawn<'a> {
    /// Its circuit.
    pub circuit: &'a str,
    /// Its number in the graph.
    pub number: usize,
    /// The point whose leg it is, and whether the reverse one.
    pub leg: Option<(&'a str, bool)>,
}

/// How far a label is moved at a time that would stand on another one.
const STEP: i32 = 12;

/// How often it may be moved before it reaches the next row of tracks.
fn steps(class: &str) -> i32 {
    if class == "signal" || class == "name" { 2 } else { 3 }
}

/// Where a label stands: left, top, right, bottom.
type Covered = (i32, i32, i32, i32);

/// A drawing under way. Places are relative to the tracks' own origin.
pub struct Ink {
    text: String,
    origin: (i32, i32),
    /// Where labels stand.
    covered: Vec<Covered>,
}

/// What a label covers that is centred at `x` over the line `y`.
fn covers(class: &str, (x, y): (i32, i32), text: &str) -> Covered {
    let size = match class {
        "circuit" => 12,
        "point" => 11,
        _ => 10,
    };
    // A letter is about as wide as 0.6 of its height, a bold one as 0.7, one of Chinese or Japanese as its height.
    let wide = if class == "point" { 7 } else { 6 };
    let tenths = text.chars().map(|letter| if letter < '\u{2e80}' { wide } else { 10 }).sum::<i32>();
    let half = tenths * size / 20;
    (x - half, y - size + 2, x + half, y + 2)
}

/// Whether two labels stand on each other.
fn overlap(one: Covered, other: Covered) -> bool {
    one.0 < other.2 && other.0 < one.2 && one.1 < other.3 && other.1 < one.3
}

impl Ink {
    /// An empty sheet of `size` with a title.
    pub fn new(title: &str, size: (i32, i32), origin: (i32, i32)) -> Self {
        let (width, height) = size;
        let letters = i32::try_from(title.chars().count()).unwrap_or(i32::MAX / 20);
        let title = escape(title);
        let mut text = String::new();
        let _ = write!(
            text,
            "<svg class=\"plan\" xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {height}\" width=\"{width}\" height=\"{height}\" role=\"img\">\n<title>Track plan: {title}</title>\n<style>{STYLE}</style>\n<rect width=\"{width}\" height=\"{height}\" fill=\"#fff\"/>\n<text class=\"title\" x=\"20\" y=\"28\">{title}</text>\n"
        );
        Self { text, origin, covered: vec![(20, 12, 20 + 10 * letters, 32)] }
    }

    fn at(&self, (x, y): (i32, i32)) -> (i32, i32) {
        (x + self.origin.0, y + self.origin.1)
    }

    /// A label at a place, or, if another one stands there, farther off: upward (−1) or downward (1). A line leads to it then.
    fn label(&mut self, class: &str, kind: &str, (at, away): ((i32, i32), i32), text: &str) {
        let (x, y) = self.at(at);
        let is_free = |y: &i32| {
            let its = covers(class, (x, *y), text);
            !self.covered.iter().any(|other| overlap(its, *other))
        };
        let place = (0..=steps(class)).map(|step| y + away * step * STEP).find(is_free).unwrap_or(y);
        self.covered.push(covers(class, (x, place), text));
        if place != y {
            let (from, to) = if away > 0 { (y - 6, place - 9) } else { (y, place + 2) };
            let _ = writeln!(self.text, "<path class=\"leader\" d=\"M{x} {from}V{to}\"/>");
        }
        let text = escape(text);
        let of = if kind.is_empty() { String::new() } else { format!(" data-{kind}=\"{text}\"") };
        let _ = writeln!(self.text, "<text class=\"{class}\"{of} x=\"{x}\" y=\"{place}\">{text}</text>");
    }

    /// A piece of track. What it is stands in attributes, for pages that show more on it.
    pub fn track(&mut self, piece: &Drawn<'_>, corners: &[(i32, i32)]) {
        let places: Vec<String> =
            corners.iter().map(|corner| self.at(*corner)).map(|(x, y)| format!("{x},{y}")).collect();
        let (circuit, number) = (escape(piece.circuit), piece.number);
        let (class, point) = match piece.leg {
            None => ("track", String::new()),
            Some((point, reverse)) => {
                let (class, leg) = if reverse { ("track reverse", "reverse") } else { ("track", "normal") };
                (class, format!(" data-point=\"{}\" data-leg=\"{leg}\"", escape(point)))
            }
        };
        let _ = writeln!(
            self.text,
            "<polyline class=\"{class}\" data-circuit=\"{circuit}\" data-piece=\"{number}\"{point} points=\"{}\"><title>{circuit}</title></polyline>",
            places.join(" ")
        );
    }

    /// A joint between two circuits.
    pub fn joint(&mut self, at: (i32, i32), title: &str) {
        let (x, y) = self.at(at);
        let _ = writeln!(
            self.text,
            "<path class=\"joint\" d=\"M{x} {}v10\"><title>{}</title></path>",
            y - 5,
            escape(title)
        );
    }

    /// A buffer stop.
    pub fn buffer(&mut self, at: (i32, i32)) {
        let (x, y) = self.at(at);
        let _ = writeln!(self.text, "<path class=\"end\" d=\"M{x} {}v16\"/>", y - 8);
    }

    /// The line goes on to the left (−1) or the right (1).
    pub fn goes_on(&mut self, at: (i32, i32), toward: i32) {
        let (x, y) = self.at(at);
        let _ = writeln!(
            self.text,
            "<path class=\"end\" stroke-dasharray=\"3 3\" d=\"M{x} {y}h{}\"/>\n<path class=\"mast\" d=\"M{} {}l{} 5l{} 5\"/>",
            toward * 18,
            x + toward * 18,
            y - 5,
            toward * 6,
            -toward * 6
        );
    }

    /// The name of a circuit.
    pub fn circuit(&mut self, at: (i32, i32), name: &str) {
        self.label("circuit", "circuit", (at, -1), name);
    }

    /// The name of a circuit that is hardly longer than its point, above (−1) or below (1) it.
    pub fn small_circuit(&mut self, at: (i32, i32), away: i32, name: &str) {
        self.label("circuit small", "circuit", (at, away), name);
    }

    /// The name of a point, above (−1) or below (1) it.
    pub fn point(&mut self, at: (i32, i32), away: i32, name: &str) {
        self.label("point", "point", (at, away), name);
    }

    /// A signal at the left of the track for trains to the right (1) or to the left (−1).
    pub fn signal(&mut self, (x, y): (i32, i32), toward: i32, name: &str) {
        let (base_x, base_y) = self.at((x - toward * 4, y - toward * 4));
        let up = base_y - toward * 9;
        let _ = writeln!(
            self.text,
            "<g data-signal=\"{}\"><path class=\"mast\" d=\"M{base_x} {base_y}V{up}h{}\"/><circle class=\"lamp\" cx=\"{}\" cy=\"{up}\" r=\"3.5\"/>",
            escape(name),
            -toward * 6,
            base_x - toward * 9
        );
        let below = if toward > 0 { -7 } else { 14 };
        self.label("signal", "", ((x - toward * 14, y - toward * 13 + below), -toward), name);
        self.text.push_str("</g>\n");
    }

    /// A stretch of plain line.
    pub fn segment(&mut self, (left, right): (i32, i32), height: i32, name: &str) {
        let (x, y) = self.at((left, height));
        let _ = writeln!(
            self.text,
            "<rect class=\"segment\" x=\"{x}\" y=\"{}\" width=\"{}\" height=\"34\"/>",
            y - 20,
            right - left
        );
        self.label("name", "segment", (((left + right) / 2, height + 25), 1), name);
    }

    /// A platform below its track.
    pub fn platform(&mut self, (left, right): (i32, i32), height: i32, name: &str) {
        let (x, y) = self.at((left, height));
        let width = (right - left - 20).max(10);
        let _ = writeln!(
            self.text,
            "<rect class=\"platform\" x=\"{}\" y=\"{}\" width=\"{width}\" height=\"13\" rx=\"2\"/>",
            x + 10,
            y + 8
        );
        self.label("name", "", (((left + right) / 2, height + 18), 1), name);
    }

    /// The drawing.
    pub fn finish(mut self) -> String {
        self.text.push_str("</svg>\n");
        self.text
    }
}
