//! Line charts as SVG text: labelled axes with units, a grid, a legend; no fonts of the system are needed.

use std::fmt;

use plotters::coord::Shift;
use plotters::coord::ranged1d::{AsRangedCoord, Ranged, ValueFormatter};
use plotters::prelude::*;

/// Colours that people with any kind of colour vision can tell apart (M. Okabe, K. Ito), dark ones first.
pub const COLOURS: [RGBColor; 7] = [
    RGBColor(0, 114, 178),
    RGBColor(213, 94, 0),
    RGBColor(0, 158, 115),
    RGBColor(204, 121, 167),
    RGBColor(230, 159, 0),
    RGBColor(86, 180, 233),
    RGBColor(90, 90, 90),
];

/// How a series is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Style {
    /// A solid line.
    Line,
    /// A dashed line.
    Dashed,
    /// A thin line in the background.
    Thin,
    /// Round marks.
    Points,
    /// An area in the background; its points go around it.
    Area,
}

/// One curve.
#[derive(Clone, Debug)]
pub struct Series {
    /// Its name in the legend; a series without a name is not in the legend.
    pub name: String,
    /// Its place in [`COLOURS`].
    pub colour: usize,
    /// How it is drawn.
    pub style: Style,
    /// Its points, by rising x. A point that is not a number or outside the axes is a gap.
    pub points: Vec<(f64, f64)>,
}

/// One axis.
#[derive(Clone, Debug)]
pub struct Axis {
    /// What it shows, with the unit.
    pub label: String,
    /// The lowest value.
    pub from: f64,
    /// The highest value.
    pub to: f64,
}

impl Axis {
    /// An axis with this label, from the lowest value to the highest.
    pub fn new(label: &str, from: f64, to: f64) -> Self {
        Self { label: label.into(), from, to }
    }
}

/// Whether the vertical axis is divided evenly or by powers of ten.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scale {
    /// Evenly.
    Linear,
    /// By powers of ten.
    Logarithmic,
}

/// Where the legend stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Legend {
    /// In the upper right corner.
    UpperRight,
    /// In the upper left corner.
    UpperLeft,
    /// In the lower left corner.
    LowerLeft,
    /// There is none.
    None,
}

/// A chart.
#[derive(Clone, Debug)]
pub struct Chart {
    /// The line on top.
    pub title: String,
    /// The horizontal axis.
    pub x: Axis,
    /// The vertical axis.
    pub y: Axis,
    /// How the vertical axis is divided.
    pub scale: Scale,
    /// Where the legend stands.
    pub legend: Legend,
    /// The curves, the first one at the back.
    pub series: Vec<Series>,
}

/// A chart that cannot be drawn: an axis without extent, or a fault of the drawing library.
#[derive(Debug)]
pub struct PlotError(pub String);

impl fmt::Display for PlotError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "the chart cannot be drawn: {}", self.0)
    }
}

impl std::error::Error for PlotError {}

/// What the drawing library says, in words.
pub(crate) fn fault(error: impl fmt::Display) -> PlotError {
    PlotError(error.to_string())
}

/// Charts under each other in one picture.
///
/// # Errors
/// [`PlotError`] if an axis has no extent or reaches zero on a logarithmic scale.
pub fn draw(charts: &[Chart], width: u32, height: u32) -> Result<String, PlotError> {
    let mut text = String::new();
    {
        let root = SVGBackend::with_string(&mut text, (width, height)).into_drawing_area();
        root.fill(&WHITE).map_err(fault)?;
        for (chart, area) in charts.iter().zip(root.split_evenly((charts.len().max(1), 1))) {
            let fits = chart.x.from < chart.x.to && chart.y.from < chart.y.to;
            if !fits || (chart.scale == Scale::Logarithmic && chart.y.from <= 0.0) {
                return Err(PlotError(format!("{}: an axis has no extent", chart.title)));
            }
            match chart.scale {
                Scale::Linear => chart.on(&area, chart.y.from..chart.y.to, &|y| number(*y)),
                Scale::Logarithmic => chart.on(&area, (chart.y.from..chart.y.to).log_scale(), &|y| power_of_ten(*y)),
            }?;
        }
        root.present().map_err(fault)?;
    }
    Ok(text)
}

/// A label without rounding errors of the axis, with a real minus sign.
pub(crate) fn number(value: f64) -> String {
    let rounded = (value * 1e6).round() / 1e6;
    format!("{}", if rounded == 0.0 { 0.0 } else { rounded }).replace('-', "−")
}

fn power_of_ten(value: f64) -> String {
    let exponent = value.log10();
    if (exponent - exponent.round()).abs() > 1e-6 {
        return String::new();
    }
    let raised = |digit: char| match digit {
        '-' => '⁻',
        '1' => '¹',
        '2' => '²',
        '3' => '³',
        '0' => '⁰',
        other => char::from_u32(other as u32 - '4' as u32 + '⁴' as u32).unwrap_or(other),
    };
    format!("10{}", format!("{exponent:.0}").chars().map(raised).collect::<String>())
}

impl Chart {
    fn on<Y>(
        &self,
        area: &DrawingArea<SVGBackend<'_>, Shift>,
        y: Y,
        y_label: &dyn Fn(&f64) -> String,
    ) -> Result<(), PlotError>
    where
        Y: AsRangedCoord<Value = f64>,
        Y::CoordDescType: Ranged<ValueType = f64> + ValueFormatter<f64>,
    {
        let mut context = frame(area, &self.title).build_cartesian_2d(self.x.from..self.x.to, y).map_err(fault)?;
        let light_lines = if self.scale == Scale::Linear { 5 } else { 10 };
        mesh(&mut context, [&self.x.label, &self.y.label], light_lines, y_label)?;
        for series in &self.series {
            let colour = COLOURS[series.colour % COLOURS.len()];
            let visible =
                |&(x, y): &(f64, f64)| (self.x.from..=self.x.to).contains(&x) && (self.y.from..=self.y.to).contains(&y);
            // A line is drawn in pieces, so that a gap stays a gap; only the first piece is in the legend.
            let pieces = series.points.split(|point| !visible(point)).filter(|piece| !piece.is_empty());
            for (place, piece) in pieces.enumerate() {
                let points = piece.iter().copied();
                let drawn = match series.style {
                    Style::Area => {
                        context.draw_series([Polygon::new(points.collect::<Vec<_>>(), colour.mix(0.18).filled())])
                    }
                    Style::Points => {
                        let marks = points.map(|point| Circle::new(point, 4, colour.filled()));
                        context.draw_series(marks)
                    }
                    Style::Dashed => context.draw_series(DashedLineSeries::new(points, 7, 5, colour.stroke_width(2))),
                    Style::Thin => context.draw_series(LineSeries::new(points, colour.mix(0.45).stroke_width(1))),
                    Style::Line => context.draw_series(LineSeries::new(points, colour.stroke_width(2))),
                }
                .map_err(fault)?;
                if place > 0 || series.name.is_empty() {
                    continue;
                }
                // The sign in the legend: a mark, a line, or a line with a gap; what is not wanted is drawn with no colour.
                let (mark, line, gap) = match series.style {
                    Style::Points => (colour.to_rgba(), TRANSPARENT, TRANSPARENT),
                    Style::Dashed => (TRANSPARENT, colour.to_rgba(), TRANSPARENT),
                    Style::Thin => (TRANSPARENT, colour.mix(0.45), colour.mix(0.45)),
                    Style::Line => (TRANSPARENT, colour.to_rgba(), colour.to_rgba()),
                    Style::Area => (TRANSPARENT, colour.mix(0.18), colour.mix(0.18)),
                };
                let width = if series.style == Style::Area { 10 } else { 2 };
                drawn.label(&series.name).legend(move |at| {
                    let part = |from, to, colour: RGBAColor| {
                        PathElement::new(vec![(from, 0), (to, 0)], colour.stroke_width(width))
                    };
                    EmptyElement::at(at)
                        + Circle::new((10, 0), 4, mark.filled())
                        + part(0, 8, line)
                        + part(8, 12, gap)
                        + part(12, 20, line)
                });
            }
        }
        let position = match self.legend {
            Legend::UpperRight => SeriesLabelPosition::UpperRight,
            Legend::UpperLeft => SeriesLabelPosition::UpperLeft,
            Legend::LowerLeft => SeriesLabelPosition::LowerLeft,
            Legend::None => return Ok(()),
        };
        legend(&mut context, position)
    }
}

/// A chart that is being drawn.
pub(crate) type Context<'a, 'b, X, Y> = ChartContext<'a, SVGBackend<'b>, Cartesian2d<X, Y>>;

/// The title, the margins, and room for the axes.
pub(crate) fn frame<'a, 'b>(
    area: &'a DrawingArea<SVGBackend<'b>, Shift>,
    title: &str,
) -> ChartBuilder<'a, 'b, SVGBackend<'b>> {
    let mut builder = ChartBuilder::on(area);
    builder
        .caption(title, ("sans-serif", 19).into_font())
        .margin(12)
        .margin_right(24)
        .x_label_area_size(46)
        .y_label_area_size(66);
    builder
}

/// The grid, and the axes with their labels: the horizontal one first.
pub(crate) fn mesh<X, Y>(
    context: &mut Context<'_, '_, X, Y>,
    [x, y]: [&str; 2],
    light_lines: usize,
    y_label: &dyn Fn(&f64) -> String,
) -> Result<(), PlotError>
where
    X: Ranged<ValueType = f64> + ValueFormatter<f64>,
    Y: Ranged<ValueType = f64> + ValueFormatter<f64>,
{
    context
        .configure_mesh()
        .bold_line_style(RGBColor(215, 215, 215))
        .light_line_style(RGBColor(240, 240, 240))
        .x_labels(11)
        .y_labels(9)
        .max_light_lines(light_lines)
        .x_desc(x)
        .y_desc(y)
        .x_label_formatter(&|x| number(*x))
        .y_label_formatter(y_label)
        .axis_desc_style(("sans-serif", 15))
        .label_style(("sans-serif", 13))
        .draw()
        .map_err(fault)
}

/// The legend of all series that have a label.
pub(crate) fn legend<'a, 'b: 'a, X, Y>(
    context: &mut Context<'a, 'b, X, Y>,
    position: SeriesLabelPosition,
) -> Result<(), PlotError>
where
    X: Ranged<ValueType = f64>,
    Y: Ranged<ValueType = f64>,
{
    context
        .configure_series_labels()
        .position(position)
        .margin(14)
        .background_style(WHITE.mix(0.9))
        .border_style(RGBColor(190, 190, 190))
        .label_font(("sans-serif", 14))
        .draw()
        .map_err(fault)
}
