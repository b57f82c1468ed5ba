//! What the budget is computed with: the line's signal, the theory of its rails, and the receiver that is measured.

use atc_kernel::code::CodeTable;
use atc_kernel::telegram::FRAME_BITS;
use atc_line::Line;
use atc_waveform::config::{Carrier, Codes, TransmitterConfig, TransmitterParams};
use atc_waveform::measure::{codes_heard, frames_lost, ratio_for};
use atc_waveform::rail::{self, Metres, OhmKilometres, Rails};
use atc_waveform::receiver::example_code_table;
use atc_waveform::units::{Decibels, Hertz, Seconds, Seed};

use super::report::{Link, SectionMargin};
use crate::signal::config::LineParams;

/// Seconds of signal for a ratio of codes.
const CODE_SECONDS: f64 = 20.0;
/// The seed of what is measured.
pub(super) const SEED: Seed = Seed(1);

/// What is computed with.
pub(super) struct Bench<'a> {
    line: &'a Line,
    pub(super) config: TransmitterConfig,
    pub(super) table: CodeTable,
    pairs: Vec<(f64, f64)>,
}

impl<'a> Bench<'a> {
    pub(super) fn new(line: &'a Line) -> Result<Self, String> {
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
    pub(super) fn codes(&self, fast: bool) -> Result<Codes, String> {
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

    pub(super) fn link(&self, carrier: Carrier, metres: f64, lost: f64, loss: f64, codes_needed: f64) -> Link {
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
    pub(super) fn codes_needed(&self, lost: f64) -> Result<f64, String> {
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

    pub(super) fn margin(
        &self,
        (section, length): (String, f64),
        longest: f64,
        links: &[Link; 2],
        least: f64,
    ) -> SectionMargin {
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

#[expect(clippy::cast_precision_loss, reason = "milliseconds of 32 bits")]
pub(super) fn exact(milliseconds: u64) -> f64 {
    milliseconds as f64
}
