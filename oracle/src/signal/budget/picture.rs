//! A link budget as a picture.

use atc_kernel::telegram::FRAME_BITS;
use atc_waveform::measure::frames_lost;
use atc_waveform::plot::{Axis, Chart, Legend, PlotError, Scale, Series, Style, draw};
use atc_waveform::units::{Decibels, Hertz};

use super::report::{BudgetReport, Link};

impl BudgetReport {
    /// The report as a picture: the ratio over the distance, and the telegrams lost over the ratio.
    ///
    /// # Errors
    /// If it cannot be drawn.
    pub fn picture(&self) -> Result<String, PlotError> {
        draw(&[self.over_distance(), self.over_ratio()], 900, 1000)
    }

    fn over_distance(&self) -> Chart {
        let end = self.longest_m * 1.25;
        let flat = |name: String, colour, value: f64| Series {
            name,
            colour,
            style: Style::Dashed,
            points: vec![(0.0, value), (end, value)],
        };
        let link = |link: &Link, colour| {
            let at = |x: f64| link.eb_n0_db + link.rail_db * (1.0 - x / self.longest_m);
            Series {
                name: format!("{} carrier, {} Hz", link.carrier, link.carrier_hz),
                colour,
                style: Style::Line,
                points: vec![(0.0, at(0.0)), (end, at(end))],
            }
        };
        let needed = self.links[0].needed_db.max(self.links[1].needed_db);
        let without = needed - self.links[0].code_costs_db.max(self.links[1].code_costs_db);
        let mut series = vec![
            link(&self.links[0], 0),
            link(&self.links[1], 1),
            flat("telegrams need".into(), 2, needed),
            flat("telegrams without a code would need".into(), 3, without),
            flat("codes need".into(), 4, self.codes_needed_db),
        ];
        let values = || series.iter().flat_map(|one| one.points.iter().map(|point| point.1));
        let (least, most) = (values().fold(f64::INFINITY, f64::min) - 3.0, values().fold(f64::MIN, f64::max) + 16.0);
        let far_end = Series {
            name: format!("far end of {}", self.longest),
            colour: 6,
            style: Style::Thin,
            points: vec![(self.longest_m, least), (self.longest_m, most)],
        };
        series.push(far_end);
        Chart {
            title: format!("{}: energy of a bit over noise density", self.line),
            x: Axis::new("distance from the transmitter (m)", 0.0, end),
            y: Axis::new("Eb/N0 (dB)", least, most),
            scale: Scale::Linear,
            legend: Legend::UpperRight,
            series,
        }
    }

    fn over_ratio(&self) -> Chart {
        let depth = self.parameters.iter().find(|one| one.name == "depth").map_or(0.0, |one| one.value);
        let (from, to) = (0.0, (self.at_needed.eb_n0_db + 5.0).max(12.0));
        let code = Hertz(self.links[0].slowest_code_hz);
        let curve = |depth: f64| {
            let lost = |ratio: f64| frames_lost(Decibels(ratio), depth, code, Hertz(self.bit_rate_hz), FRAME_BITS);
            (0..=100).map(|step| from + (to - from) * f64::from(step) / 100.0).map(|x| (x, lost(x))).collect()
        };
        let measured = self.around.iter().chain([&self.at_needed]);
        let series = vec![
            Series { name: "theory, no code".into(), colour: 3, style: Style::Line, points: curve(0.0) },
            Series {
                name: format!("theory, code of {} Hz", code.0),
                colour: 2,
                style: Style::Line,
                points: curve(depth),
            },
            Series {
                name: "measured, slowest pair of codes, carriers off as stated".into(),
                colour: 0,
                style: Style::Points,
                points: measured.map(|one| (one.eb_n0_db, one.lost())).collect(),
            },
        ];
        Chart {
            title: "Telegrams lost".into(),
            x: Axis::new("Eb/N0 (dB)", from, to),
            y: Axis::new("part of the telegrams that is lost", 1e-3, 1.0),
            scale: Scale::Logarithmic,
            legend: Legend::UpperRight,
            series,
        }
    }
}
