//! Which part of a chart is drawn, and how it is headed.

/// How a chart is headed, and which part of it is drawn.
#[derive(Clone, Debug, Default)]
pub struct View {
    /// The title; without one the machine's name.
    pub title: Option<String>,
    /// The first instant, in the chart's unit.
    pub from: Option<u64>,
    /// The last instant, in the chart's unit.
    pub to: Option<u64>,
    /// The part that is drawn; without it all.
    pub only: Option<Part>,
}

/// A part of a chart.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Part {
    /// The figure over distance.
    Figure,
    /// The rows over time.
    Rows,
}
