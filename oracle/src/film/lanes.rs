//! The rows of a chart as rows of a film.

use atc_film::{Film, Lane, Legend, Line, Mark};

use crate::chart::scene::{self, Scale, Scene, Sign, Tone};

/// Puts the rows of a chart into a film.
pub(super) fn put(film: &mut Film, scene: &Scene) {
    film.lanes = scene.lanes.iter().map(lane).collect();
    film.legend =
        scene.legend.iter().map(|(of, text)| Legend { tone: tone(*of).to_owned(), text: (*text).to_owned() }).collect();
}

fn lane(of: &scene::Lane) -> Lane {
    let mut lane = Lane { label: of.label.clone(), first: of.first, height: of.height, ..Lane::default() };
    let mut bars = Vec::new();
    let mut signs = Vec::new();
    for mark in &of.marks {
        match mark {
            scene::Mark::Wave(spans) => lane.marks.push(Mark::Wave(spans.clone())),
            scene::Mark::Bar { from, to, tone: of, texts } => {
                bars.push((*from, *to, tone(*of).to_owned(), texts.first().cloned().unwrap_or_default()));
            }
            scene::Mark::Dimension { from, to, text } => {
                bars.push((*from, *to, tone(Tone::Blank).to_owned(), text.clone()));
            }
            scene::Mark::Tick { from, to, tone: of, hint } => {
                bars.push((*from, *to, tone(*of).to_owned(), hint.clone()));
            }
            scene::Mark::Sign { at, sign } => {
                let letter = match sign {
                    Sign::Accepted => "▲",
                    Sign::Gone => "✕",
                };
                signs.push((*at, letter.to_owned()));
            }
            scene::Mark::Curve { points, tone: of, scale } => {
                lane.scale = Some(range(*scale));
                lane.marks.push(Mark::Line(Line { tone: tone(*of).to_owned(), points: points.clone() }));
            }
            scene::Mark::Band { points, tone: of, scale } => {
                lane.scale = Some(range(*scale));
                lane.marks.push(Mark::Band(tone(*of).to_owned(), points.clone()));
            }
            scene::Mark::Letters { from, text } => lane.marks.push(Mark::Letters(*from, text.clone())),
            scene::Mark::Steps { points, top } => {
                lane.scale = Some((0.0, f64::from((*top).max(1))));
                let points = points.iter().map(|(at, number)| (*at, number.map(f64::from))).collect();
                lane.marks.push(Mark::Line(Line { tone: tone(Tone::Code).to_owned(), points }));
            }
        }
    }
    if !bars.is_empty() {
        lane.marks.insert(0, Mark::Bars(bars));
    }
    if !signs.is_empty() {
        lane.marks.push(Mark::Signs(signs));
    }
    lane
}

const fn range(scale: Scale) -> (f64, f64) {
    (scale.bottom, scale.top)
}

const fn tone(tone: Tone) -> &'static str {
    match tone {
        Tone::Signal => "signal",
        Tone::Operate => "operate",
        Tone::Shortened => "shortened",
        Tone::Recovery => "recovery",
        Tone::Mask => "mask",
        Tone::Dropped => "dropped",
        Tone::Service => "service",
        Tone::Emergency => "emergency",
        Tone::Limit => "limit",
        Tone::Code => "code",
        Tone::Detected => "detected",
        Tone::Held => "held",
        Tone::All => "all",
        Tone::Pending => "pending",
        Tone::Blank => "blank",
        Tone::Difference => "difference",
    }
}
