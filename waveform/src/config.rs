//! What a transmitter sends, as checked configuration (SIG-1; JP4845985B2 \[0004\] and the first claim).

use std::fmt;

use serde::{Deserialize, Serialize};

use crate::units::{Hertz, Level};

/// One of the two carriers of the signal.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Carrier {
    /// The main signal: what changes.
    Main,
    /// The sub signal: what is fixed.
    Sub,
}

/// The lowest code frequency that this crate sends and measures.
pub const LOWEST_CODE: Hertz = Hertz(8.0);
/// The highest code frequency that this crate sends and measures.
pub const HIGHEST_CODE: Hertz = Hertz(50.0);

/// What is wished of a transmitter; [`TransmitterConfig::new`] checks it. The default is the project's standard signal.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct TransmitterParams {
    /// Samples in a second.
    pub sample_rate: Hertz,
    /// Centre frequency of the main carrier.
    pub main_carrier: Hertz,
    /// Centre frequency of the sub carrier.
    pub sub_carrier: Hertz,
    /// Bits in a second on each carrier; a bit moves the carrier by a quarter of it (MSK).
    pub bit_rate: Hertz,
    /// Depth m of the amplitude modulation by the code frequency, 0 to 1: the envelope is 1 + m cos.
    pub depth: f64,
    /// Amplitude of the main carrier without its code.
    pub main_level: Level,
    /// Amplitude of the sub carrier without its code.
    pub sub_level: Level,
}

impl Default for TransmitterParams {
    fn default() -> Self {
        Self {
            sample_rate: Hertz(8000.0),
            main_carrier: Hertz(750.0),
            sub_carrier: Hertz(1200.0),
            bit_rate: Hertz(200.0),
            depth: 2.0 / 3.0,
            main_level: Level(0.25),
            sub_level: Level(0.25),
        }
    }
}

/// Why a configuration is refused: which value, and what would be right.
#[derive(Clone, Debug, PartialEq)]
pub enum ConfigError {
    /// A value is outside its range.
    OutOfRange {
        /// The field.
        field: &'static str,
        /// What it is.
        value: f64,
        /// The smallest value that would be accepted.
        least: f64,
        /// The largest value that would be accepted.
        most: f64,
    },
    /// A carrier with its sidebands reaches over half the sample rate.
    OverNyquist {
        /// Which carrier.
        carrier: Carrier,
        /// Its upper edge in hertz.
        edge: f64,
        /// Half the sample rate in hertz.
        limit: f64,
    },
    /// A carrier with its sidebands reaches below zero.
    BelowZero {
        /// Which carrier.
        carrier: Carrier,
        /// Its lower edge in hertz.
        edge: f64,
    },
    /// The bands of the two carriers overlap.
    BandsOverlap {
        /// How far apart the carriers are, in hertz.
        distance: f64,
        /// How far apart they must be at least, in hertz.
        needed: f64,
    },
    /// The two carriers at the top of their modulation exceed full scale.
    Overload {
        /// The largest value that the sum can reach.
        peak: f64,
    },
}

impl fmt::Display for ConfigError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::OutOfRange { field, value, least, most } => {
                write!(f, "{field} is {value}; it must be from {least} to {most}")
            }
            Self::OverNyquist { carrier, edge, limit } => write!(
                f,
                "the {carrier:?} carrier with its sidebands reaches {edge} Hz; half the sample rate is only {limit} Hz: \
                 choose a higher sample rate or a lower carrier"
            ),
            Self::BelowZero { carrier, edge } => {
                write!(
                    f,
                    "the {carrier:?} carrier with its sidebands reaches down to {edge} Hz; choose a higher carrier"
                )
            }
            Self::BandsOverlap { distance, needed } => write!(
                f,
                "the carriers are {distance} Hz apart; with this bit rate they must be at least {needed} Hz apart"
            ),
            Self::Overload { peak } => write!(
                f,
                "the sum of both carriers reaches {peak:.3} of full scale; lower the levels or the depth until it is at most 1"
            ),
        }
    }
}

impl std::error::Error for ConfigError {}

/// A signal that has been checked: the carriers fit below half the sample rate and beside each other, and the sum fits
/// into full scale.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TransmitterConfig {
    params: TransmitterParams,
}

fn within(field: &'static str, value: f64, least: f64, most: f64) -> Result<(), ConfigError> {
    // NaN is in no range.
    if (least..=most).contains(&value) { Ok(()) } else { Err(ConfigError::OutOfRange { field, value, least, most }) }
}

impl TransmitterConfig {
    /// Checks what is wished.
    ///
    /// # Errors
    /// [`ConfigError`] says which value cannot be and what would be right.
    pub fn new(params: TransmitterParams) -> Result<Self, ConfigError> {
        within("sample_rate", params.sample_rate.0, 4000.0, 192_000.0)?;
        within("bit_rate", params.bit_rate.0, 50.0, 1200.0)?;
        within("depth", params.depth, 0.0, 1.0)?;
        within("main_level", params.main_level.0, 0.001, 1.0)?;
        within("sub_level", params.sub_level.0, 0.001, 1.0)?;
        within("main_carrier", params.main_carrier.0, 100.0, 96_000.0)?;
        within("sub_carrier", params.sub_carrier.0, 100.0, 96_000.0)?;
        let config = Self { params };
        let half_band = config.half_band().0;
        for carrier in [Carrier::Main, Carrier::Sub] {
            let centre = config.carrier(carrier).0;
            let limit = config.params.sample_rate.0 / 2.0;
            if centre + half_band >= limit {
                return Err(ConfigError::OverNyquist { carrier, edge: centre + half_band, limit });
            }
            if centre - half_band <= 0.0 {
                return Err(ConfigError::BelowZero { carrier, edge: centre - half_band });
            }
        }
        let distance = (config.params.main_carrier.0 - config.params.sub_carrier.0).abs();
        if distance < 2.0 * half_band {
            return Err(ConfigError::BandsOverlap { distance, needed: 2.0 * half_band });
        }
        let peak = (config.params.main_level.0 + config.params.sub_level.0) * (1.0 + config.params.depth);
        if peak > 1.0 {
            return Err(ConfigError::Overload { peak });
        }
        Ok(config)
    }

    /// Everything that was asked for.
    pub fn params(&self) -> &TransmitterParams {
        &self.params
    }

    /// Samples in a second.
    pub fn sample_rate(&self) -> Hertz {
        self.params.sample_rate
    }

    /// Bits in a second on each carrier.
    pub fn bit_rate(&self) -> Hertz {
        self.params.bit_rate
    }

    /// The centre frequency of a carrier.
    pub fn carrier(&self, carrier: Carrier) -> Hertz {
        match carrier {
            Carrier::Main => self.params.main_carrier,
            Carrier::Sub => self.params.sub_carrier,
        }
    }

    /// The amplitude of a carrier without its code.
    pub fn level(&self, carrier: Carrier) -> Level {
        match carrier {
            Carrier::Main => self.params.main_level,
            Carrier::Sub => self.params.sub_level,
        }
    }

    /// How far a carrier with its sidebands reaches to either side: the main lobe of MSK, which ends at 3/4 of the bit
    /// rate, moved by the highest code.
    pub fn half_band(&self) -> Hertz {
        Hertz(0.75 * self.params.bit_rate.0 + HIGHEST_CODE.0)
    }
}

/// The code frequencies that modulate the two carriers; `None`: that carrier is not modulated.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Codes {
    main: Option<Hertz>,
    sub: Option<Hertz>,
}

impl Codes {
    /// Neither carrier is modulated.
    pub const NONE: Self = Self { main: None, sub: None };

    /// Checks the two frequencies.
    ///
    /// # Errors
    /// [`ConfigError::OutOfRange`] if one is below [`LOWEST_CODE`] or above [`HIGHEST_CODE`].
    pub fn new(main: Option<Hertz>, sub: Option<Hertz>) -> Result<Self, ConfigError> {
        for (field, frequency) in [("main code", main), ("sub code", sub)] {
            if let Some(frequency) = frequency {
                within(field, frequency.0, LOWEST_CODE.0, HIGHEST_CODE.0)?;
            }
        }
        Ok(Self { main, sub })
    }

    /// The code of one carrier.
    pub fn of(self, carrier: Carrier) -> Option<Hertz> {
        match carrier {
            Carrier::Main => self.main,
            Carrier::Sub => self.sub,
        }
    }
}
