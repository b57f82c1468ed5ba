//! A figure over distance: curves of several cases on the same ground, with sections and places named.

/// What is drawn over distance.
#[derive(Clone, Debug, Default)]
pub struct Figure {
    /// What the figure shows, in a few short sentences.
    pub notes: Vec<String>,
    /// The curves.
    pub curves: Vec<Curve>,
    /// Spans below the axis: from, to, name.
    pub spans: Vec<(f64, f64, String)>,
    /// Upright lines: where, and what is there.
    pub places: Vec<(f64, String)>,
    /// Arrivals, as signs on the axis: where, of what, and of which case.
    pub arrivals: Vec<(f64, String, usize)>,
}

/// A curve of speed, in km/h, over distance, in m.
#[derive(Clone, Debug)]
pub struct Curve {
    /// What it is.
    pub label: String,
    /// The case whose colour it has.
    pub case: usize,
    /// How it is drawn.
    pub stroke: Stroke,
    /// Its points; None: a gap.
    pub points: Vec<Option<(f64, f64)>>,
}

/// How a curve is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stroke {
    /// Full, strong: what a train does.
    Full,
    /// Broken: what it may.
    Broken,
    /// Thin: for comparison.
    Thin,
    /// Separate dots.
    Dots,
}

impl Figure {
    /// The distances and the highest speed that are shown.
    pub(super) fn range(&self) -> (f64, f64, f64) {
        let points = || self.curves.iter().flat_map(|curve| curve.points.iter().flatten());
        let xs = points().map(|point| point.0).chain(self.places.iter().map(|place| place.0));
        let (from, to) = xs.fold((f64::MAX, f64::MIN), |(from, to), x| (from.min(x), to.max(x)));
        let (from, to) = if from < to { (from, to) } else { (0.0, from.clamp(1.0, 1e6)) };
        let top = points().map(|point| point.1).fold(0.0, f64::max);
        (from, to + (to - from) * 0.03, (top * 1.08).max(10.0))
    }
}
