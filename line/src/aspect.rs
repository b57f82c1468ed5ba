//! Aspects and their times: the parameters of aspect acceptance.

use atc_kernel::aspect::{AspectTable, TableError, Times, TimesError, TimesMs};
use atc_kernel::speed::KmhTenths;
use atc_kernel::time::{MAX_TICKS, Millis};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::kmh::Kmh;
use crate::refusal::{Refusal, no_cycle, short};
use crate::rule::Rule;

/// The configuration: the line's aspects and times. All but the aspects have the defaults of the patent's example.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "AspectConfig")]
pub struct Config {
    /// The length of a logic cycle.
    #[serde(default = "default_cycle")]
    pub cycle_ms: u32,
    /// The permitted speeds that the aspects name: 1 to 16, strictly rising, 0 to 6553.5 km/h.
    pub aspects_km_h: Vec<Kmh>,
    /// T1: an aspect heard for so long is accepted. Rounded up to cycles.
    #[serde(default = "default_operate")]
    pub operate_ms: u32,
    /// T2: a lost aspect stands so long as if it were heard. Rounded down to cycles.
    #[serde(default = "default_recovery")]
    pub recovery_ms: u32,
    /// T3: and after that so long, if nothing contradicts it. Rounded down to cycles.
    #[serde(default = "default_mask")]
    pub mask_ms: u32,
    /// T4: the longest interruption after which T5 takes the place of T1. Rounded down to cycles.
    #[serde(default = "default_interruption")]
    pub interruption_ms: u32,
    /// T5: the operate time after a short interruption. Rounded up to cycles.
    #[serde(default = "default_shortened_operate")]
    pub shortened_operate_ms: u32,
}

const fn default_cycle() -> u32 {
    10
}
fn default_operate() -> u32 {
    TimesMs::default().operate.0
}
fn default_recovery() -> u32 {
    TimesMs::default().recovery.0
}
fn default_mask() -> u32 {
    TimesMs::default().mask.0
}
fn default_interruption() -> u32 {
    TimesMs::default().interruption.0
}
fn default_shortened_operate() -> u32 {
    TimesMs::default().shortened_operate.0
}

impl Config {
    /// A cycle, the aspects and their times.
    pub fn new(cycle: Millis, aspects_km_h: Vec<Kmh>, times: TimesMs) -> Self {
        Self {
            cycle_ms: cycle.0,
            aspects_km_h,
            operate_ms: times.operate.0,
            recovery_ms: times.recovery.0,
            mask_ms: times.mask.0,
            interruption_ms: times.interruption.0,
            shortened_operate_ms: times.shortened_operate.0,
        }
    }

    /// The patent's times and a cycle of 10 ms.
    pub fn with_defaults(aspects_km_h: Vec<Kmh>) -> Self {
        Self::new(Millis(default_cycle()), aspects_km_h, TimesMs::default())
    }

    /// The times in the kernel's form.
    ///
    /// # Errors
    /// The rule of TIME-2 that they break.
    pub fn times(&self) -> Result<Times, Refusal> {
        let asked = TimesMs {
            operate: Millis(self.operate_ms),
            recovery: Millis(self.recovery_ms),
            mask: Millis(self.mask_ms),
            interruption: Millis(self.interruption_ms),
            shortened_operate: Millis(self.shortened_operate_ms),
        };
        Times::from_millis(Millis(self.cycle_ms), asked).map_err(|error| self.explain(error))
    }

    /// The aspect table in the kernel's form.
    ///
    /// # Errors
    /// The rule of TIME-4 that it breaks.
    pub fn table(&self) -> Result<AspectTable, Refusal> {
        let tenths = |(place, speed): (usize, &Kmh)| {
            u16::try_from(speed.0).map(KmhTenths).map_err(|_| {
                let field = format!("aspects_km_h[{place}]");
                let what = format!("{field} is {speed} km/h; a permitted speed is 0 to 6553.5 km/h");
                Refusal::new(Rule::Range, field, what)
            })
        };
        let speeds = self.aspects_km_h.iter().enumerate().map(tenths).collect::<Result<Vec<_>, _>>()?;
        table("aspects_km_h", "permitted speeds", &speeds)
    }

    /// Which rule of TIME-2 the times break, with the numbers.
    fn explain(&self, error: TimesError) -> Refusal {
        let cycle = self.cycle_ms;
        let (t1, t2, t3, t4, t5) =
            (self.operate_ms, self.recovery_ms, self.mask_ms, self.interruption_ms, self.shortened_operate_ms);
        let longest = u64::from(cycle) * u64::from(MAX_TICKS);
        let most = format!("it must be at most {MAX_TICKS} cycles, {longest} ms");
        let (field, what) = match error {
            TimesError::NoCycle => return no_cycle(Rule::Time2),
            TimesError::NoOperateTime => ("operate_ms", "operate_ms (T1) is 0; it must be 1 ms or more".to_owned()),
            TimesError::NoRecoveryTime => {
                let Refusal { what, .. } = short(Rule::Time2, "recovery_ms (T2)", t2, cycle);
                ("recovery_ms", what)
            }
            TimesError::NoShortenedOperateTime => {
                ("shortened_operate_ms", "shortened_operate_ms (T5) is 0; it must be 1 ms or more".to_owned())
            }
            TimesError::ShortenedNotShorter => (
                "shortened_operate_ms",
                format!(
                    "shortened_operate_ms (T5) is {t5} ms, {} cycles of {cycle} ms, and operate_ms (T1) is {t1} ms, {} cycles; T5 must \
                     be fewer cycles than T1",
                    t5.div_ceil(cycle.max(1)),
                    t1.div_ceil(cycle.max(1)),
                ),
            ),
            TimesError::OperateTooLong => ("operate_ms", format!("operate_ms (T1) is {t1} ms; {most}")),
            TimesError::RecoveryAndMaskTooLong => (
                "recovery_ms",
                format!("recovery_ms + mask_ms (T2 + T3) is {} ms; {most}", u64::from(t2) + u64::from(t3)),
            ),
            TimesError::InterruptionTooLong => ("interruption_ms", format!("interruption_ms (T4) is {t4} ms; {most}")),
        };
        Refusal::new(Rule::Time2, field, what)
    }
}

/// A table of speeds in the kernel's form; `field` gives it, and its entries are `noun`.
///
/// # Errors
/// The rule of TIME-4 that it breaks.
pub fn table(field: &str, noun: &str, speeds: &[KmhTenths]) -> Result<AspectTable, Refusal> {
    let speed = |place: usize| Kmh::from(speeds.get(place).copied().unwrap_or_default());
    AspectTable::new(speeds).map_err(|error| match error {
        TableError::Empty => Refusal::new(Rule::Time4, field, format!("{field} is empty; it must name 1 to 16 {noun}")),
        TableError::TooMany => Refusal::new(
            Rule::Time4,
            field,
            format!("{field} has {} entries; it must name 1 to 16 {noun}", speeds.len()),
        ),
        TableError::NotRising(place) => Refusal::new(
            Rule::Time4,
            format!("{field}[{place}]"),
            format!(
                "{field}[{place}] is {} km/h after {} km/h; the {noun} must rise strictly",
                speed(place),
                speed(place.saturating_sub(1)),
            ),
        ),
    })
}
