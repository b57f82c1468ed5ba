//! The link budget of a line's train control signal: what is left of it at the far end of each section, against what
//! telegrams and codes need. What the receiver needs is measured here and now, with the receiver of `atc-waveform`; the
//! rest is its line theory.

use std::fmt::Write as _;

use atc_kernel::code::CodeTable;
use atc_kernel::telegram::FRAME_BITS;
use atc_line::Line;
use atc_line::budget::Value;
use atc_waveform::config::{Carrier, Codes, TransmitterConfig, TransmitterParams};
use atc_waveform::measure::{
    BitErrorRun, FramePoint, FrameRun, bit_errors, codes_heard, frames, frames_lost, latency, ratio_for,
};
use atc_waveform::plot::{Axis, Chart, Legend, PlotError, Scale, Series, Style, draw};
use atc_waveform::rail::{self, Metres, OhmKilometres, Rails};
use atc_waveform::receiver::example_code_table;
use atc_waveform::units::{Decibels, Hertz, Seconds, Seed};
use serde::Serialize;

use super::config::LineParams;

/// Offsets of a carrier that are tried, Hz.
const OFFSETS: [f64; 8] = [0.0, 0.5, 1.0, 1.5, 1.75, 2.0, 2.5, 3.0];
/// A carrier that is off may cost so many of the telegrams, and still counts as heard.
const LOST_BY_OFFSET: f64 = 0.05;
/// Frames on each carrier for an offset, and for a ratio.
const FRAMES: [u32; 2] = [15, 60];
/// Seconds of signal for a ratio of codes.
const CODE_SECONDS: f64 = 20.0;
/// The ratio at which the loss of the receiver is measured: there are errors enough.
const LOSS_AT: Decibels = Decibels(8.0);
const SEED: Seed = Seed(1);

/// The budget of one carrier at the far end of the longest section.
#[derive(Clone, Debug, Serialize)]
pub struct Link {
    /// `main` or `sub`.
    pub carrier: &'static str,
    /// Its centre.
    pub carrier_hz: f64,
    /// The slowest code on it, which costs telegrams most.
    pub slowest_code_hz: f64,
    /// Level at the transmitter.
    pub transmitted_db: f64,
    /// What the rails take.
    pub rail_db: f64,
    /// What else takes something.
    pub other_losses_db: f64,
    /// What is left.
    pub received_db: f64,
    /// Noise in one hertz.
    pub noise_density_db: f64,
    /// What the code adds to the mean power.
    pub code_power_db: f64,
    /// Energy of a bit, the code included, over noise density.
    pub eb_n0_db: f64,
    /// What telegrams need by theory if there is no code.
    pub needed_without_code_db: f64,
    /// What the code costs them.
    pub code_costs_db: f64,
    /// What this receiver needs more than theory.
    pub receiver_loss_db: f64,
    /// What telegrams need.
    pub needed_db: f64,
    /// What is left for telegrams.
    pub telegram_margin_db: f64,
    /// What is left for codes.
    pub code_margin_db: f64,
}

/// A section and the least margins in it.
#[derive(Clone, Debug, Serialize)]
pub struct SectionMargin {
    /// Its name.
    pub section: String,
    /// Its length.
    pub length_m: f64,
    /// The lower margin of telegrams on the two carriers.
    pub telegram_margin_db: f64,
    /// The margin of codes.
    pub code_margin_db: f64,
    /// Whether both are enough.
    pub enough: bool,
}

/// Everything.
#[derive(Clone, Debug, Serialize)]
pub struct BudgetReport {
    /// The line's name.
    pub line: String,
    /// What the file gives and what is a default.
    pub parameters: Vec<Parameter>,
    /// The longest section.
    pub longest: String,
    /// Its length.
    pub longest_m: f64,
    /// Bits in a second, of the duration of a frame.
    pub bit_rate_hz: f64,
    /// Main and sub carrier.
    pub links: [Link; 2],
    /// What codes need, measured.
    pub codes_needed_db: f64,
    /// Telegrams at the ratio that they need: measured.
    pub at_needed: FramePoint,
    /// The same at other ratios, for the picture.
    pub around: Vec<FramePoint>,
    /// Telegrams where the carrier is off.
    pub offsets: Vec<FramePoint>,
    /// The greatest offset up to which telegrams are heard.
    pub offset_heard_hz: f64,
    /// From the last bit at the antenna to the report of a telegram: measured.
    pub latency_ms: f64,
    /// What the file says of it and of the way to the logic.
    pub delay_ms: u64,
    /// Every section, the longest first.
    pub sections: Vec<SectionMargin>,
    /// What is not as it must be, in sentences; none if all is.
    pub broken: Vec<String>,
}

/// A value that the budget starts from.
#[derive(Clone, Debug, Serialize)]
pub struct Parameter {
    /// Its name in `[budget]`.
    pub name: &'static str,
    /// The value.
    pub value: f64,
    /// Its unit.
    pub unit: &'static str,
    /// What it is.
    pub what: &'static str,
    /// Whether the file gives it.
    pub given: bool,
}

/// What is computed with.
struct Bench<'a> {
    line: &'a Line,
    config: TransmitterConfig,
    table: CodeTable,
    pairs: Vec<(f64, f64)>,
}

/// Makes the budget of a line.
///
/// # Errors
/// Why the line has none, in a sentence.
pub fn budget(line: &Line) -> Result<BudgetReport, String> {
    let bench = Bench::new(line)?;
    let mut sections = sections(line);
    sections.sort_by(|a, b| b.1.total_cmp(&a.1));
    let Some((longest, longest_m)) = sections.first().cloned() else {
        return Err(
            "the line has neither a [[section]] nor a [[block]]: nothing says how far the signal must reach".into()
        );
    };
    let get = |name| line.budget().get(name);
    let (lost, offset) = (get("lost_part"), get("carrier_offset_hz"));
    let slow = bench.codes(false)?;
    let run = BitErrorRun {
        codes: slow,
        offset: Hertz(offset),
        errors: 200,
        least_bits: 8000,
        most_bits: 16_000,
        seed: SEED,
    };
    let loss = bit_errors(&bench.config, &run, LOSS_AT).loss_db.unwrap_or(30.0).max(0.0);
    let codes_needed = bench.codes_needed(lost)?;
    let links = [Carrier::Main, Carrier::Sub].map(|carrier| bench.link(carrier, longest_m, lost, loss, codes_needed));
    let needed = links.iter().map(|link| link.needed_db).fold(f64::MIN, f64::max);
    let measure = |count, offset: f64, ratio: f64| {
        let run = FrameRun { codes: slow, offset: Hertz(offset), frames: count, seed: SEED };
        frames(&bench.config, &bench.table, &run, Decibels(ratio))
    };
    let offsets: Vec<FramePoint> =
        OFFSETS.iter().map(|&offset| measure(FRAMES[0], offset, (needed + 10.0).min(60.0))).collect();
    let heard = offsets.iter().take_while(|point| point.lost() <= LOST_BY_OFFSET).last();
    let offset_heard = heard.map_or(0.0, |point| point.offset_hz);
    let around = [-9.0, -6.0, -3.0].map(|less| measure(FRAMES[1], offset, needed + less)).to_vec();
    let latency_ms = latency(&bench.config, &bench.table).map_or(f64::INFINITY, |late| late.0 * 1000.0);
    let mut report = BudgetReport {
        line: line.name().to_owned(),
        parameters: line.budget().values.iter().map(Parameter::from).collect(),
        longest,
        longest_m,
        bit_rate_hz: bench.config.bit_rate().0,
        links,
        codes_needed_db: codes_needed,
        at_needed: measure(FRAMES[1], offset, needed),
        around,
        offsets,
        offset_heard_hz: offset_heard,
        latency_ms,
        delay_ms: line.signal().map_or(0, atc_line::signal::Signal::delay_ms),
        sections: Vec::new(),
        broken: Vec::new(),
    };
    let least = get("least_margin_db");
    report.sections = sections.into_iter().map(|one| bench.margin(one, longest_m, &report.links, least)).collect();
    report.broken = broken(&report, least, offset);
    Ok(report)
}

impl From<&Value> for Parameter {
    fn from(value: &Value) -> Self {
        Self { name: value.name, value: value.value, unit: value.unit, what: value.what, given: value.given }
    }
}

/// Every section with its length.
fn sections(line: &Line) -> Vec<(String, f64)> {
    let described = line.sections().into_iter().map(|one| (format!("section {}", one.number), f64::from(one.length_m)));
    let counted = line.blocks().into_iter().enumerate().flat_map(|(block, one)| {
        let name = move |place| format!("section {} of block {}", place + 1, block + 1);
        one.sections_m.into_iter().enumerate().map(move |(place, length)| (name(place), f64::from(length)))
    });
    described.chain(counted).collect()
}

fn broken(report: &BudgetReport, least: f64, offset: f64) -> Vec<String> {
    let mut all = Vec::new();
    for one in report.sections.iter().filter(|one| !one.enough) {
        all.push(format!(
            "{} ({} m): at its far end the margin is {:.1} dB for telegrams and {:.1} dB for codes; each must be {least} dB or more",
            one.section, one.length_m, one.telegram_margin_db, one.code_margin_db
        ));
    }
    if report.offset_heard_hz < offset {
        all.push(format!(
            "budget.carrier_offset_hz is {offset} Hz, and telegrams are heard up to {} Hz: carriers must be nearer",
            report.offset_heard_hz
        ));
    }
    if report.delay_ms > 0 && report.latency_ms > exact(report.delay_ms) {
        all.push(format!(
            "signal.delay_ms is {}, and the receiver alone takes {:.1} ms; it must be that or more, and the way to the logic",
            report.delay_ms, report.latency_ms
        ));
    }
    all
}

#[expect(clippy::cast_precision_loss, reason = "milliseconds of 32 bits")]
fn exact(milliseconds: u64) -> f64 {
    milliseconds as f64
}

impl<'a> Bench<'a> {
    fn new(line: &'a Line) -> Result<Self, String> {
        let get = |name| line.budget().get(name);
        let signal = line.signal().ok_or("the line has no [signal]: it sends no telegrams")?;
        let bit_rate = f64::from(FRAME_BITS) * 1000.0 / exact(signal.frame_ms().max(1));
        let mut params = TransmitterParams {
            main_carrier: Hertz(get("main_carrier_hz")),
            sub_carrier: Hertz(get("sub_carrier_hz")),
            bit_rate: Hertz(bit_rate),
            depth: get("depth"),
            ..TransmitterParams::default()
        };
        let highest = params.main_carrier.0.max(params.sub_carrier.0) + bit_rate + 50.0;
        while params.sample_rate.0 < 2.5 * highest && params.sample_rate.0 < 96_000.0 {
            params.sample_rate.0 *= 2.0;
        }
        let config = TransmitterConfig::new(params)
            .map_err(|error| format!("[budget] and signal.frame_ms give no signal: {error}"))?;
        let table = match line.codes() {
            Some(table) => *table,
            None => example_code_table().map_err(|error| format!("the standard code table: {error:?}"))?,
        };
        let given = line.code_pairs().iter().map(|pair| (pair.main_hz, pair.sub_hz));
        let standard = LineParams::default().codes;
        let pairs: Vec<(f64, f64)> = if line.code_pairs().is_empty() {
            standard.iter().map(|pair| (pair.main_hz, pair.sub_hz)).collect()
        } else {
            given.collect()
        };
        Ok(Self { line, config, table, pairs })
    }

    /// The pair with the slowest or the fastest main code.
    fn codes(&self, fast: bool) -> Result<Codes, String> {
        let sign = if fast { -1.0 } else { 1.0 };
        let pair = self.pairs.iter().min_by(|a, b| (sign * a.0).total_cmp(&(sign * b.0)));
        let (main, sub) = pair.copied().ok_or("the line has no pair of codes")?;
        Codes::new(Some(Hertz(main)), Some(Hertz(sub))).map_err(|error| format!("codes.pairs: {error}"))
    }

    /// The slowest code of a carrier.
    fn slowest(&self, carrier: Carrier) -> f64 {
        let of = |pair: &(f64, f64)| if carrier == Carrier::Main { pair.0 } else { pair.1 };
        self.pairs.iter().map(of).fold(f64::INFINITY, f64::min)
    }

    /// What the rails take over a length.
    fn rail(&self, carrier: Carrier, metres: f64) -> f64 {
        let ballast = OhmKilometres(self.line.budget().get("wet_ohm_km"));
        let track = rail::Line::new(Rails::default(), ballast);
        track.map_or(f64::INFINITY, |track| track.attenuation(self.config.carrier(carrier), Metres(metres)).0)
    }

    fn link(&self, carrier: Carrier, metres: f64, lost: f64, loss: f64, codes_needed: f64) -> Link {
        let get = |name| self.line.budget().get(name);
        let (depth, bit_rate, code) = (get("depth"), self.config.bit_rate(), Hertz(self.slowest(carrier)));
        let needs = |depth: f64| ratio_for(|ratio| frames_lost(ratio, depth, code, bit_rate, FRAME_BITS), lost).0;
        let without = needs(0.0);
        let costs = needs(depth) - without;
        let (name, sent) = if carrier == Carrier::Main { ("main", "main_db") } else { ("sub", "sub_db") };
        let received = get(sent) - self.rail(carrier, metres) - get("other_losses_db");
        let density = get("noise_db") - 10.0 * get("noise_band_hz").log10();
        let code_power = 10.0 * (1.0 + depth * depth / 2.0).log10();
        let ratio = received + code_power - density - 10.0 * bit_rate.0.log10();
        let needed = without + costs + loss;
        Link {
            carrier: name,
            carrier_hz: self.config.carrier(carrier).0,
            slowest_code_hz: code.0,
            transmitted_db: get(sent),
            rail_db: self.rail(carrier, metres),
            other_losses_db: get("other_losses_db"),
            received_db: received,
            noise_density_db: density,
            code_power_db: code_power,
            eb_n0_db: ratio,
            needed_without_code_db: without,
            code_costs_db: costs,
            receiver_loss_db: loss,
            needed_db: needed,
            telegram_margin_db: ratio - needed,
            code_margin_db: ratio - codes_needed,
        }
    }

    /// The ratio from which on both the slowest and the fastest pair of codes are heard, to half a decibel.
    fn codes_needed(&self, lost: f64) -> Result<f64, String> {
        let all = [self.codes(false)?, self.codes(true)?];
        let heard = |ratio: f64| {
            all.iter().all(|&codes| {
                let part = codes_heard(&self.config, &self.table, codes, Decibels(ratio), Seconds(CODE_SECONDS), SEED);
                part.is_some_and(|part| part >= 1.0 - lost)
            })
        };
        let (mut low, mut high) = (-10.0, 30.0);
        if !heard(high) {
            return Err(
                "codes are not heard at all at 30 dB: is the modulation deep enough for the receiver (0.4)?".into()
            );
        }
        while high - low > 0.5 {
            let middle = f64::midpoint(low, high);
            if heard(middle) { high = middle } else { low = middle }
        }
        Ok(high)
    }

    fn margin(&self, (section, length): (String, f64), longest: f64, links: &[Link; 2], least: f64) -> SectionMargin {
        let gain = |carrier| self.rail(carrier, longest) - self.rail(carrier, length);
        let gains = [gain(Carrier::Main), gain(Carrier::Sub)];
        let lower = |of: fn(&Link) -> f64| of(&links[0]).min(of(&links[1]) + gains[1] - gains[0]) + gains[0];
        let (telegrams, codes) = (lower(|link| link.telegram_margin_db), lower(|link| link.code_margin_db));
        SectionMargin {
            section,
            length_m: length,
            telegram_margin_db: telegrams,
            code_margin_db: codes,
            enough: telegrams >= least && codes >= least,
        }
    }
}

/// A figure of a link.
type Figure = fn(&Link) -> f64;

impl BudgetReport {
    /// The report in words.
    pub fn words(&self) -> String {
        let mut text = format!(
            "{}: link budget at the far end of {} ({} m), the longest of {}\n\n",
            self.line,
            self.longest,
            self.longest_m,
            self.sections.len()
        );
        for one in &self.parameters {
            let from = if one.given { "file" } else { "DEFAULT" };
            let value = (one.value * 1000.0).round() / 1000.0;
            let _ = writeln!(text, "{:18} {value:>8} {:5} {from:8} {}", one.name, one.unit, one.what);
        }
        let _ = writeln!(text, "\n{:58} {:>8} {:>8}", "dB", self.links[0].carrier, self.links[1].carrier);
        let lost = self.parameters.iter().find(|one| one.name == "lost_part").map_or(0.0, |one| one.value * 100.0);
        let slow = format!(
            "amplitude modulation costs them ({} and {} Hz)",
            self.links[0].slowest_code_hz, self.links[1].slowest_code_hz
        );
        let least = format!("telegrams, {lost} % lost: needed without a code (theory)");
        let rows: [(&str, Figure); 13] = [
            ("level at the transmitter", |link| link.transmitted_db),
            ("rails, wet (line theory)", |link| 0.0 - link.rail_db),
            ("other losses", |link| 0.0 - link.other_losses_db),
            ("level at the receiver", |link| link.received_db),
            ("noise in 1 Hz", |link| link.noise_density_db),
            ("the code's share of the power", |link| link.code_power_db),
            ("Eb/N0", |link| link.eb_n0_db),
            (&least, |link| link.needed_without_code_db),
            (&slow, |link| link.code_costs_db),
            ("the receiver more than theory (measured at 8 dB)", |link| link.receiver_loss_db),
            ("telegrams: needed", |link| link.needed_db),
            ("telegrams: MARGIN", |link| link.telegram_margin_db),
            ("codes: MARGIN", |link| link.code_margin_db),
        ];
        for (name, of) in rows {
            let _ = writeln!(text, "{name:58} {:8.1} {:8.1}", of(&self.links[0]), of(&self.links[1]));
        }
        let _ = writeln!(
            text,
            "\ncodes are heard from {:.1} dB on (measured, the slowest and the fastest pair)\n\
             telegrams at {:.1} dB: {} of {} lost (measured)\n\
             telegrams where the carrier is off: {} (measured): heard up to {} Hz\n\
             the receiver tells a telegram {:.1} ms after its last bit (measured); signal.delay_ms = {}",
            self.codes_needed_db,
            self.at_needed.eb_n0_db,
            self.at_needed.sent.saturating_sub(self.at_needed.heard),
            self.at_needed.sent,
            self.offsets
                .iter()
                .map(|one| format!("{} Hz {:.0} %", one.offset_hz, 100.0 * (1.0 - one.lost().max(0.0))))
                .collect::<Vec<_>>()
                .join(", "),
            self.offset_heard_hz,
            self.latency_ms,
            self.delay_ms
        );
        let _ = writeln!(
            text,
            "NOT CHECKED: that the noise is even, and no louder where the traction current is strongest; harmonics on a carrier and \
             the neighbouring section's signal are not in it [levels-within-tolerance]"
        );
        text
    }

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
