//! `aspect-acceptance`: [`atc_kernel::aspect`] behind the protocol.

use atc_kernel::aspect::{AspectSet, AspectTable, Display, MAX_ASPECTS, State, TableError, Times, TimesError, TimesMs};
use atc_kernel::speed::KmhTenths;
use atc_kernel::time::{MAX_TICKS, Millis};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{Cycle, Machine};
use crate::chart::{self, Scene};
use crate::kmh::{Kmh, KmhOrNull};

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

fn default_cycle() -> u32 {
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

/// One logic cycle's input.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "AspectStep")]
pub struct Step {
    /// The aspects whose signal was heard throughout the cycle, in any order, each at most once.
    pub detected_km_h: Vec<Kmh>,
}

/// One logic cycle's output.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[schemars(rename = "AspectOutput")]
pub struct Output {
    /// The permitted speed on display from the end of the cycle on; null: no display, which means stop.
    // It may be null, but it may not be missing.
    #[serde(deserialize_with = "Option::deserialize")]
    #[schemars(with = "KmhOrNull")]
    pub display_km_h: Option<Kmh>,
}

/// The machine with its state.
#[derive(Clone, Debug)]
pub struct Aspect {
    table: AspectTable,
    times: Times,
    state: State<MAX_ASPECTS>,
}

impl Config {
    /// The patent's times and a cycle of 10 ms.
    pub fn with_defaults(aspects_km_h: Vec<Kmh>) -> Self {
        let times = TimesMs::default();
        Self {
            cycle_ms: default_cycle(),
            aspects_km_h,
            operate_ms: times.operate.0,
            recovery_ms: times.recovery.0,
            mask_ms: times.mask.0,
            interruption_ms: times.interruption.0,
            shortened_operate_ms: times.shortened_operate.0,
        }
    }

    /// The times in the kernel's form.
    ///
    /// # Errors
    /// The rule of TIME-2 that they break.
    pub fn times(&self) -> Result<Times, TimesError> {
        Times::from_millis(
            Millis(self.cycle_ms),
            TimesMs {
                operate: Millis(self.operate_ms),
                recovery: Millis(self.recovery_ms),
                mask: Millis(self.mask_ms),
                interruption: Millis(self.interruption_ms),
                shortened_operate: Millis(self.shortened_operate_ms),
            },
        )
    }

    /// The aspect table in the kernel's form.
    ///
    /// # Errors
    /// The rule of TIME-4 that it breaks, in a sentence.
    pub fn table(&self) -> Result<AspectTable, String> {
        let mut speeds = Vec::with_capacity(self.aspects_km_h.len());
        for (place, speed) in self.aspects_km_h.iter().enumerate() {
            let Ok(tenths) = u16::try_from(speed.0) else {
                return Err(format!("aspects_km_h[{place}] is {speed} km/h; a permitted speed is 0 to 6553.5 km/h"));
            };
            speeds.push(KmhTenths(tenths));
        }
        AspectTable::new(&speeds).map_err(|error| self.explain_table(error))
    }

    /// Which rule of TIME-2 the times break, with the numbers.
    pub fn explain_times(&self, error: TimesError) -> String {
        let cycle = self.cycle_ms;
        let (t1, t2, t3, t4, t5) =
            (self.operate_ms, self.recovery_ms, self.mask_ms, self.interruption_ms, self.shortened_operate_ms);
        let longest = u64::from(cycle) * u64::from(MAX_TICKS);
        match error {
            TimesError::NoCycle => "cycle_ms is 0; a logic cycle is 1 ms or more".to_owned(),
            TimesError::NoOperateTime => "operate_ms (T1) is 0; it must be 1 ms or more".to_owned(),
            TimesError::NoRecoveryTime => {
                format!("recovery_ms (T2) is {t2} ms, less than one cycle of {cycle} ms; it must be {cycle} ms or more")
            }
            TimesError::NoShortenedOperateTime => "shortened_operate_ms (T5) is 0; it must be 1 ms or more".to_owned(),
            TimesError::ShortenedNotShorter => format!(
                "shortened_operate_ms (T5) is {t5} ms, {} cycles of {cycle} ms, and operate_ms (T1) is {t1} ms, {} cycles; T5 must be fewer cycles than T1",
                t5.div_ceil(cycle.max(1)),
                t1.div_ceil(cycle.max(1)),
            ),
            TimesError::OperateTooLong => {
                format!("operate_ms (T1) is {t1} ms; it must be at most 60000 cycles, {longest} ms")
            }
            TimesError::RecoveryAndMaskTooLong => format!(
                "recovery_ms + mask_ms (T2 + T3) is {} ms; it must be at most 60000 cycles, {longest} ms",
                u64::from(t2) + u64::from(t3)
            ),
            TimesError::InterruptionTooLong => {
                format!("interruption_ms (T4) is {t4} ms; it must be at most 60000 cycles, {longest} ms")
            }
        }
    }

    fn explain_table(&self, error: TableError) -> String {
        let speed = |place: usize| self.aspects_km_h.get(place).copied().unwrap_or_default();
        match error {
            TableError::Empty => "aspects_km_h is empty; it must name 1 to 16 permitted speeds".to_owned(),
            TableError::TooMany => {
                format!("aspects_km_h has {} entries; it must name 1 to 16 permitted speeds", self.aspects_km_h.len())
            }
            TableError::NotRising(place) => format!(
                "aspects_km_h[{place}] is {} km/h after {} km/h; the permitted speeds must rise strictly",
                speed(place),
                speed(place.saturating_sub(1)),
            ),
        }
    }
}

impl Aspect {
    /// The times of the line, in cycles.
    pub fn times(&self) -> Times {
        self.times
    }

    /// The aspects of the line.
    pub fn table(&self) -> &AspectTable {
        &self.table
    }

    /// The kernel's state.
    pub fn state(&self) -> &State<MAX_ASPECTS> {
        &self.state
    }

    /// The set that a step names.
    ///
    /// # Errors
    /// If it names a speed that the line does not have, or one twice. A receiver treats an unknown code as no
    /// signal; an oracle that did so would hide that two implementations read different tables.
    pub fn detected(&self, step: &Step) -> Result<AspectSet, String> {
        let mut set = AspectSet::EMPTY;
        for (place, speed) in step.detected_km_h.iter().enumerate() {
            let known = u16::try_from(speed.0).ok().and_then(|tenths| self.table.aspect(KmhTenths(tenths)));
            let Some(aspect) = known else {
                return Err(format!(
                    "detected_km_h[{place}] is {speed} km/h, which is not one of this line's aspects: {}",
                    list(&self.table)
                ));
            };
            if set.contains(aspect) {
                return Err(format!("detected_km_h[{place}] is {speed} km/h a second time; each aspect is named once"));
            }
            set = set.with(aspect);
        }
        Ok(set)
    }

    /// The output that says what is on display.
    pub fn output(&self, display: Display) -> Output {
        let speed = display.aspect().and_then(|aspect| self.table.speed(aspect));
        Output { display_km_h: speed.map(|speed| Kmh(speed.0.into())) }
    }
}

fn list(table: &AspectTable) -> String {
    let speeds: Vec<_> = table.speeds().iter().map(|speed| Kmh(speed.0.into()).to_string()).collect();
    format!("{} km/h", speeds.join(", "))
}

impl Machine for Aspect {
    const NAME: &'static str = "aspect-acceptance";
    const STEP: &'static str = r#"{"detected_km_h":[45,90]}"#;
    const CONFIG: &'static str = r#"{"cycle_ms":10,"aspects_km_h":[25,45,65,90],"operate_ms":300,"recovery_ms":400,"mask_ms":400,"interruption_ms":800,"shortened_operate_ms":100}"#;

    type Config = Config;
    type Step = Step;
    type Output = Output;

    fn open(config: &Config) -> Result<Self, String> {
        let table = config.table()?;
        let times = config.times().map_err(|error| config.explain_times(error))?;
        Ok(Self { table, times, state: State::INITIAL })
    }

    fn step(&mut self, step: &Step) -> Result<Output, String> {
        let detected = self.detected(step)?;
        let (state, display) = atc_kernel::aspect::step(self.times, self.state, detected);
        self.state = state;
        Ok(self.output(display))
    }

    fn cycles(&self) -> Vec<(&'static str, u16)> {
        vec![
            ("operate", self.times.operate().0),
            ("recovery", self.times.recovery().0),
            ("recovery_and_mask", self.times.expiry().0),
            ("interruption", self.times.interruption().0),
            ("shortened_operate", self.times.shortened_operate().0),
            ("tolerated_interruption", self.times.tolerated_interruption().0),
        ]
    }

    fn chart(config: &Config, cycles: &[Cycle<Self>]) -> Scene {
        chart::aspect::scene(config, cycles)
    }
}
