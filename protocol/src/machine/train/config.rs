//! The configuration of the on-board device: its parts, and one table of the line's speeds.

use atc_kernel::aspect::{Acceptance, MAX_ASPECTS};
use atc_kernel::code::{Code, CodeError, CodeFrequencies, CodeTable, MAX_CODES, Millihertz};
use atc_kernel::supervision::Supervision;
use atc_kernel::train::{Parts, Train, TrainError};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use atc_line::kmh::tenths;
use atc_line::refusal::Refusal;

use crate::decimal::Hertz;
use crate::kmh::Kmh;
use crate::machine::{aspect, permitted, position, supervision};

/// The configuration. All but the position has defaults, those of the parts.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
#[schemars(rename = "TrainConfig")]
pub struct Config {
    /// The cycle, the line's speeds, the train's brake, the lives of telegrams and the counters. Its `speeds_km_h` is the one table of
    /// speeds: it ranks codes, telegrams and the display.
    pub permitted: permitted::Config,
    /// The times of aspect acceptance.
    pub acceptance: AcceptanceTimes,
    /// The speeds that pairs of codes name.
    pub codes: Codes,
    /// The brake.
    pub supervision: supervision::Config,
    /// In how many channels the device runs: 1, or 2 that are compared in every cycle (spec/duplex.md); null or absent: 1.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 1, max = 2))]
    pub channels: Option<u32>,
    /// The position; null or absent: the train does not measure it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub position: Option<position::Config>,
}

/// The times of aspect acceptance: those of `aspect-acceptance`.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct AcceptanceTimes {
    /// T1: an aspect heard for so long is accepted. Rounded up to cycles.
    pub operate_ms: u32,
    /// T2: a lost aspect stands so long as if it were heard. Rounded down to cycles.
    pub recovery_ms: u32,
    /// T3: and after that so long, if nothing contradicts it. Rounded down to cycles.
    pub mask_ms: u32,
    /// T4: the longest interruption after which T5 takes the place of T1. Rounded down to cycles.
    pub interruption_ms: u32,
    /// T5: the operate time after a short interruption. Rounded up to cycles.
    pub shortened_operate_ms: u32,
}

impl Default for AcceptanceTimes {
    fn default() -> Self {
        let times = aspect::Config::with_defaults(Vec::new());
        Self {
            operate_ms: times.operate_ms,
            recovery_ms: times.recovery_ms,
            mask_ms: times.mask_ms,
            interruption_ms: times.interruption_ms,
            shortened_operate_ms: times.shortened_operate_ms,
        }
    }
}

/// The speeds that pairs of codes name.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Codes {
    /// By how much a measured code frequency may be off.
    pub tolerance_hz: Hertz,
    /// The pairs, in any order. Each carrier has 1 to 8 different codes.
    pub pairs: Vec<Pair>,
}

/// A pair of code frequencies, and the speed that it names: one of the line's.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "CodePair")]
pub struct Pair {
    /// The code of the main carrier.
    pub main_hz: Hertz,
    /// The code of the sub carrier.
    pub sub_hz: Hertz,
    /// The speed.
    pub speed_km_h: Kmh,
}

impl Default for Codes {
    fn default() -> Self {
        let pairs = [
            (10_000, 12_000, 150),
            (15_000, 16_500, 250),
            (22_000, 21_000, 450),
            (29_000, 27_000, 550),
            (36_000, 32_000, 750),
            (41_500, 38_500, 900),
        ];
        let pair = |(main, sub, speed)| Pair { main_hz: Hertz(main), sub_hz: Hertz(sub), speed_km_h: Kmh(speed) };
        Self { tolerance_hz: Hertz(1000), pairs: pairs.map(pair).to_vec() }
    }
}

/// A frequency that must fit, or a sentence that says so.
pub(super) fn millihertz(field: &str, frequency: Hertz) -> Result<Millihertz, String> {
    u32::try_from(frequency.0)
        .map(Millihertz)
        .map_err(|_| format!("{field} is {frequency} Hz; it must be 0 to 4294967.295 Hz"))
}

impl Codes {
    /// The table in the kernel's form.
    ///
    /// # Errors
    /// The rule that it breaks, in a sentence.
    pub(in crate::machine) fn table(&self) -> Result<CodeTable, String> {
        let tolerance = millihertz("codes.tolerance_hz", self.tolerance_hz)?;
        let (mut of_main, mut of_sub) = (Vec::new(), Vec::new());
        let mut pairs = Vec::with_capacity(self.pairs.len());
        for (place, pair) in self.pairs.iter().enumerate() {
            let field = |name: &str| format!("codes.pairs[{place}].{name}");
            let main = millihertz(&field("main_hz"), pair.main_hz)?;
            let sub = millihertz(&field("sub_hz"), pair.sub_hz)?;
            of_main.push(main);
            of_sub.push(sub);
            pairs.push((main, sub, tenths(&field("speed_km_h"), pair.speed_km_h)?));
        }
        let frequencies = |name: &str, mut list: Vec<Millihertz>| {
            list.sort_unstable();
            list.dedup();
            CodeFrequencies::new(&list, tolerance).map_err(|error| self.explain(error, name, &list))
        };
        let (main, sub) = (frequencies("main_hz", of_main)?, frequencies("sub_hz", of_sub)?);
        let mut speeds = [[None; MAX_CODES]; MAX_CODES];
        for (place, (of_main, of_sub, speed)) in pairs.into_iter().enumerate() {
            let at = |codes: &CodeFrequencies, code| codes.nominal().iter().position(|known| *known == code);
            let (Some(row), Some(column)) = (at(&main, of_main), at(&sub, of_sub)) else { continue };
            if speeds[row][column].replace(speed).is_some() {
                return Err(format!("codes.pairs[{place}] is a pair of codes that has a speed already"));
            }
        }
        CodeTable::new(main, sub, speeds).map_err(|error| self.explain(error, "main_hz", &[]))
    }

    fn explain(&self, error: CodeError, name: &str, list: &[Millihertz]) -> String {
        let hz = |place: usize| Hertz(list.get(place).map_or(0, |code| code.0.into()));
        let tolerance = self.tolerance_hz;
        match error {
            CodeError::NoFrequency | CodeError::NoSpeed | CodeError::UnusedCode(..) => {
                "codes.pairs is empty; it must name 1 to 8 codes for each carrier".to_owned()
            }
            CodeError::TooManyFrequencies => {
                format!("codes.pairs has {} different values of {name}; it may have 8", list.len())
            }
            CodeError::OutOfRange => format!(
                "codes.pairs has {name} from {} to {} Hz; with codes.tolerance_hz, {tolerance} Hz, either way they must be above 0 and at most 4294967.295 Hz",
                hz(0),
                hz(list.len().saturating_sub(1)),
            ),
            CodeError::BandsTouch(place) => format!(
                "codes.pairs has {name} {} and {} Hz; they must be more than twice codes.tolerance_hz, {tolerance} Hz, apart",
                hz(place.saturating_sub(1)),
                hz(place),
            ),
        }
    }
}

impl Config {
    /// The device.
    ///
    /// # Errors
    /// The rule that its parts break, alone or together, in a sentence.
    pub fn train(&self) -> Result<Train<MAX_ASPECTS>, String> {
        let within = |part: &'static str| move |refusal: Refusal| format!("{part}.{}", refusal.what);
        let permitted = self.permitted.permitted().map_err(within("permitted"))?;
        let AcceptanceTimes { operate_ms, recovery_ms, mask_ms, interruption_ms, shortened_operate_ms } =
            self.acceptance;
        let times = aspect::Config {
            cycle_ms: self.permitted.cycle_ms,
            aspects_km_h: Vec::new(),
            operate_ms,
            recovery_ms,
            mask_ms,
            interruption_ms,
            shortened_operate_ms,
        };
        let times = times.times().map_err(within("acceptance"))?;
        let position = self.position.as_ref().map(position::Config::position).transpose();
        let supervision: Supervision = self.supervision.supervision().map_err(within("supervision"))?;
        let parts = Parts {
            codes: self.codes.table()?,
            acceptance: Acceptance { times },
            permitted,
            supervision,
            position: position.map_err(within("position"))?,
        };
        Train::new(parts).map_err(|error| self.explain(&parts, error))
    }

    fn explain(&self, parts: &Parts<MAX_ASPECTS>, error: TrainError) -> String {
        match error {
            TrainError::TooManyRanks => format!("permitted.speeds_km_h has more than {MAX_ASPECTS} speeds"),
            TrainError::ImplausibleSpeed(speed) => format!(
                "permitted.speeds_km_h has {} km/h, above supervision.maximum_km_h, {} km/h; a train at that speed would be stopped",
                Kmh(speed.0.into()),
                self.supervision.maximum_km_h
            ),
            TrainError::UnknownSpeed(main, sub) => {
                let hz = |codes: &CodeFrequencies, code: Code| {
                    Hertz(codes.nominal().get(usize::from(code.place())).map_or(0, |code| code.0.into()))
                };
                let speed = parts.codes.speed(Some(main), Some(sub)).map_or(0, |speed| speed.0);
                let known: Vec<_> = self.permitted.speeds_km_h.iter().map(Kmh::to_string).collect();
                format!(
                    "codes.pairs names {} km/h for {} and {} Hz; it must be one of permitted.speeds_km_h: {} km/h",
                    Kmh(speed.into()),
                    hz(parts.codes.main(), main),
                    hz(parts.codes.sub(), sub),
                    known.join(", ")
                )
            }
        }
    }
}
