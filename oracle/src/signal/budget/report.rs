//! What a link budget says.

use atc_line::budget::Value;
use atc_waveform::measure::FramePoint;
use serde::Serialize;

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

impl From<&Value> for Parameter {
    fn from(value: &Value) -> Self {
        Self { name: value.name, value: value.value, unit: value.unit, what: value.what, given: value.given }
    }
}
