//! The configuration of a signal, in TOML. The same file serves for making a signal and for reading one.

use atc_kernel::aspect::AspectTable;
use atc_kernel::code::CodeTable;
use atc_line::code::{self, Names, speed};
use atc_waveform::config::{TransmitterConfig, TransmitterParams};
use atc_waveform::units::{Hertz, Level};
use serde::Deserialize;

/// Everything. Each part has defaults: the project's standard signal on an urban line.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Config {
    /// How long the signal is, and how it is written.
    pub recording: Recording,
    /// Carriers, bits and levels.
    pub signal: Signal,
    /// The line's speeds and codes.
    pub line: LineParams,
    /// What the telegrams say.
    pub section: Section,
    /// The analog code.
    pub code: Code,
    /// What happens to the signal on its way.
    pub channel: ChannelParams,
}

/// The file.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Recording {
    /// Its length in seconds, 0.001 to 3600.
    pub duration_s: f64,
    /// How samples are written.
    pub samples: Samples,
}

/// How samples are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Samples {
    /// 16-bit integers.
    Pcm16,
    /// 32-bit floating point.
    Float32,
}

/// Carriers, bits and levels.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Signal {
    /// Samples in a second.
    pub sample_rate_hz: f64,
    /// The centre of the main carrier.
    pub main_carrier_hz: f64,
    /// The centre of the sub carrier.
    pub sub_carrier_hz: f64,
    /// Bits in a second on each carrier.
    pub bit_rate_hz: f64,
    /// How deep the codes modulate the carriers, 0 to 1.
    pub depth: f64,
    /// The amplitude of the main carrier as a part of full scale.
    pub main_level: f64,
    /// The amplitude of the sub carrier as a part of full scale.
    pub sub_level: f64,
}

/// The line's speeds and codes.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct LineParams {
    /// The speeds to which the ranks in telegrams refer, strictly rising, in km/h and whole tenths.
    pub speeds_km_h: Vec<f64>,
    /// By how much a measured code frequency may be off, in whole millihertz.
    pub tolerance_hz: f64,
    /// The pairs of code frequencies that name a speed.
    pub codes: Vec<Pair>,
}

/// A pair of code frequencies and the speed that it names.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Pair {
    /// The code of the main carrier.
    pub main_hz: f64,
    /// The code of the sub carrier.
    pub sub_hz: f64,
    /// The speed in km/h and whole tenths.
    pub speed_km_h: f64,
}

/// What the telegrams say. Counters run on from 0.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Section {
    /// The section's number.
    pub number: u16,
    /// Whether telegrams are sent, or this is an analog line.
    pub telegrams: bool,
    /// How far beyond the section's exit the train may go, in m; absent: the route is closed.
    pub beyond_exit_m: Option<u16>,
    /// The speed of the main telegram: one of the line's.
    pub speed_km_h: f64,
    /// The section's length in m.
    pub length_m: u16,
    /// Its gradient in thousandths, positive where the train climbs.
    pub gradient_permille: i8,
    /// Its limit by curves and points: one of the line's speeds.
    pub curve_km_h: f64,
    /// Its limit by a temporary restriction: one of the line's speeds.
    pub restriction_km_h: f64,
}

/// The analog code: a speed of the table, or two frequencies. A carrier without a code is not modulated.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Code {
    /// The speed that the pair of codes names.
    pub speed_km_h: Option<f64>,
    /// In its place, the code of the main carrier.
    pub main_hz: Option<f64>,
    /// In its place, the code of the sub carrier.
    pub sub_hz: Option<f64>,
}

/// What happens to the signal on its way.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct ChannelParams {
    /// By how much everything is weaker at the receiver, 0 to 200 dB.
    pub attenuation_db: f64,
    /// White noise: the energy of a bit of the main carrier over the noise's density, -20 to 100 dB; absent: no
    /// noise.
    pub eb_n0_db: Option<f64>,
    /// The seed of the noise: the same seed, the same noise.
    pub seed: u64,
    /// Times in which the signal is missing; the noise goes on.
    pub interruptions: Vec<Gap>,
}

/// A time in which the signal is missing.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Gap {
    /// When it begins, 0 to 3600 s.
    pub start_s: f64,
    /// How long it lasts, 0 to 3600 s.
    pub length_s: f64,
}

impl Default for Config {
    fn default() -> Self {
        Self {
            recording: Recording::default(),
            signal: Signal::default(),
            line: LineParams::default(),
            section: Section::default(),
            code: Code { speed_km_h: Some(75.0), ..Code::default() },
            channel: ChannelParams::default(),
        }
    }
}

impl Default for Recording {
    fn default() -> Self {
        Self { duration_s: 5.0, samples: Samples::Pcm16 }
    }
}

impl Default for Signal {
    fn default() -> Self {
        let standard = TransmitterParams::default();
        Self {
            sample_rate_hz: standard.sample_rate.0,
            main_carrier_hz: standard.main_carrier.0,
            sub_carrier_hz: standard.sub_carrier.0,
            bit_rate_hz: standard.bit_rate.0,
            depth: standard.depth,
            main_level: standard.main_level.0,
            sub_level: standard.sub_level.0,
        }
    }
}

impl Default for LineParams {
    fn default() -> Self {
        let pair = |(main_hz, sub_hz, speed_km_h)| Pair { main_hz, sub_hz, speed_km_h };
        let codes = [
            (10.0, 12.0, 15.0),
            (15.0, 16.5, 25.0),
            (22.0, 21.0, 45.0),
            (29.0, 27.0, 55.0),
            (36.0, 32.0, 75.0),
            (41.5, 38.5, 90.0),
        ];
        Self {
            speeds_km_h: vec![0.0, 15.0, 25.0, 45.0, 55.0, 65.0, 75.0, 90.0],
            tolerance_hz: 1.0,
            codes: codes.map(pair).to_vec(),
        }
    }
}

impl Default for Section {
    fn default() -> Self {
        Self {
            number: 1,
            telegrams: true,
            beyond_exit_m: Some(400),
            speed_km_h: 75.0,
            length_m: 250,
            gradient_permille: 0,
            curve_km_h: 90.0,
            restriction_km_h: 90.0,
        }
    }
}

/// The parts of a configuration that a receiver needs, checked.
pub struct Line {
    /// Carriers, bits and levels.
    pub signal: TransmitterConfig,
    /// The line's speeds.
    pub speeds: AspectTable,
    /// What pairs of codes name.
    pub codes: CodeTable,
}

impl Config {
    /// Reads a configuration.
    ///
    /// # Errors
    /// Where it is not TOML or not of this form.
    pub fn parse(text: &str) -> Result<Self, String> {
        toml::from_str(text).map_err(|error| error.to_string().trim_end().to_owned())
    }

    /// The parts that a receiver needs.
    ///
    /// # Errors
    /// The rule that is broken, in a sentence.
    pub fn line(&self) -> Result<Line, String> {
        let signal = &self.signal;
        let params = TransmitterParams {
            sample_rate: Hertz(signal.sample_rate_hz),
            main_carrier: Hertz(signal.main_carrier_hz),
            sub_carrier: Hertz(signal.sub_carrier_hz),
            bit_rate: Hertz(signal.bit_rate_hz),
            depth: signal.depth,
            main_level: Level(signal.main_level),
            sub_level: Level(signal.sub_level),
        };
        let signal = TransmitterConfig::new(params).map_err(|error| format!("[signal]: {error}"))?;
        let mut speeds = Vec::new();
        for (place, km_h) in self.line.speeds_km_h.iter().enumerate() {
            speeds.push(speed(&format!("line.speeds_km_h[{place}]"), *km_h)?);
        }
        let speeds = AspectTable::new(&speeds)
            .map_err(|_| "line.speeds_km_h must have 1 to 16 speeds, strictly rising".to_owned())?;
        Ok(Line { signal, speeds, codes: self.line.table()? })
    }
}

impl LineParams {
    fn table(&self) -> Result<CodeTable, String> {
        let pair = |one: &Pair| code::Pair { main_hz: one.main_hz, sub_hz: one.sub_hz, speed_km_h: one.speed_km_h };
        let pairs: Vec<_> = self.codes.iter().map(pair).collect();
        let names = Names { codes: "line.codes", tolerance_hz: "line.tolerance_hz" };
        Ok(code::table(names, self.tolerance_hz, &pairs)?)
    }
}
