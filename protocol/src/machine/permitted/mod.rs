//! `permitted-speed`: [`atc_kernel::permitted`] behind the protocol.

use atc_line::kmh::tenths;
pub use atc_line::permitted::Config;

use atc_kernel::distance::Millimetres;
use atc_kernel::permitted::{self, Heard, Permission, Permitted, State};
use atc_kernel::time::Ticks;
use schemars::JsonSchema;
use serde::de::Deserializer;
use serde::{Deserialize, Serialize};

use super::contract::Machine;
use crate::decimal::{Metres, OrNull};
use crate::kmh::{Kmh, KmhOrNull};
use crate::names::{self, Named};
use crate::telegrams::{MainTelegram, SubTelegram};

/// How a line is equipped.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum LineKind {
    /// Codes only.
    Analog,
    /// Codes and telegrams.
    Digital,
}

impl Named for LineKind {
    const WHAT: &'static str = "kind of line";
    const EVERY: &'static [Self] = &[Self::Analog, Self::Digital];

    fn name(self) -> &'static str {
        match self {
            Self::Analog => "analog",
            Self::Digital => "digital",
        }
    }
}

impl<'de> Deserialize<'de> for LineKind {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        names::read(deserializer)
    }
}

/// What a permission rests on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Basis {
    /// Nothing that permits: no code, or telegrams missing for too long.
    Nothing,
    /// The analog code alone.
    Analog,
    /// The pattern alone.
    Pattern,
    /// The lower of analog code and pattern.
    Both,
    /// Telegrams are missing: the lower of analog code and the last pattern, if one is still running down.
    RunningDown,
}

impl Named for Basis {
    const WHAT: &'static str = "basis";
    const EVERY: &'static [Self] = &[Self::Nothing, Self::Analog, Self::Pattern, Self::Both, Self::RunningDown];

    fn name(self) -> &'static str {
        match self {
            Self::Nothing => "nothing",
            Self::Analog => "analog",
            Self::Pattern => "pattern",
            Self::Both => "both",
            Self::RunningDown => "running-down",
        }
    }
}

impl<'de> Deserialize<'de> for Basis {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        names::read(deserializer)
    }
}

impl From<LineKind> for permitted::LineKind {
    fn from(line: LineKind) -> Self {
        match line {
            LineKind::Analog => Self::Analog,
            LineKind::Digital => Self::Digital,
        }
    }
}

impl From<permitted::LineKind> for LineKind {
    fn from(line: permitted::LineKind) -> Self {
        match line {
            permitted::LineKind::Analog => Self::Analog,
            permitted::LineKind::Digital => Self::Digital,
        }
    }
}

impl From<permitted::Basis> for Basis {
    fn from(basis: permitted::Basis) -> Self {
        match basis {
            permitted::Basis::Nothing => Self::Nothing,
            permitted::Basis::Analog => Self::Analog,
            permitted::Basis::Pattern => Self::Pattern,
            permitted::Basis::Both => Self::Both,
            permitted::Basis::RunningDown => Self::RunningDown,
        }
    }
}

/// What is heard and measured in one cycle.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "PermittedStep")]
pub struct Step {
    /// The kind of line that begins here; null or absent: the train is told nothing in this cycle.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub line: Option<LineKind>,
    /// The speed of the accepted analog code; null: there is no code.
    #[serde(deserialize_with = "Option::deserialize")]
    #[schemars(with = "KmhOrNull")]
    pub analog_km_h: Option<Kmh>,
    /// The main telegram that was completed in this cycle; null or absent: none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub main: Option<MainTelegram>,
    /// The sub telegram that was completed in this cycle; null or absent: none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub sub: Option<SubTelegram>,
    /// A distance from which the exit of the section is no nearer, of the section whose signal is heard in this cycle, 0 to
    /// 4294967.295 m; null or absent: it is not measured.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub to_exit_m: Option<Metres>,
    /// The most that the train can have moved forward since the last cycle, 0 to 4294967.295 m.
    pub moved_m: Metres,
    /// The train's speed. Only the chart reads it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub speed_km_h: Option<Kmh>,
}

/// One cycle's output.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
#[schemars(rename = "PermittedOutput")]
pub struct Output {
    /// The permitted speed; 0 is a stop by the service brake; null: nothing is heard, and that is the emergency brake.
    // It may be null, but it may not be missing.
    #[serde(deserialize_with = "Option::deserialize")]
    #[schemars(with = "KmhOrNull")]
    pub speed_km_h: Option<Kmh>,
    /// What it rests on.
    pub basis: Basis,
    /// What is remembered from here on. An implementation may leave it out.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(with = "Remembered")]
    pub state: Option<Remembered>,
}

/// What is left out is not compared.
impl PartialEq for Output {
    fn eq(&self, other: &Self) -> bool {
        (self.speed_km_h, self.basis) == (other.speed_km_h, other.basis)
            && (self.state.is_none() || other.state.is_none() || self.state == other.state)
    }
}

/// What is remembered, as far as it can be told from outside.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[schemars(rename = "PermittedState")]
pub struct Remembered {
    /// The kind of line.
    pub line: LineKind,
    /// The section of the last main telegram that was used; null: none is remembered, and the next two are null as well.
    #[serde(deserialize_with = "Option::deserialize")]
    #[schemars(with = "OrNull<u16>")]
    pub section: Option<u16>,
    /// The point before which the train must stop is no nearer than this.
    #[serde(deserialize_with = "Option::deserialize")]
    #[schemars(with = "OrNull<Metres>")]
    pub to_stop_m: Option<Metres>,
    /// That main telegram was sent so long ago, or later: the time since the telegram before it in its stream.
    #[serde(deserialize_with = "Option::deserialize")]
    #[schemars(with = "OrNull<u32>")]
    pub main_age_ms: Option<u64>,
    /// The sections whose sub telegrams are remembered, the newest first, at most two.
    pub sub: Vec<RememberedSub>,
}

/// A sub telegram that is remembered.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[schemars(rename = "PermittedStateSub")]
pub struct RememberedSub {
    /// Its section.
    pub section: u16,
    /// It was sent so long ago, or later: the time since the telegram before it in its stream.
    pub age_ms: u64,
}

/// A length that must fit, or a sentence that says so.
fn millimetres(field: &str, length: Metres) -> Result<Millimetres, String> {
    u32::try_from(length.0)
        .map(Millimetres)
        .map_err(|_| format!("{field} is {length} m; it must be 0 to 4294967.295 m"))
}

impl Step {
    /// The step in the kernel's form.
    ///
    /// # Errors
    /// The first field that does not fit, in a sentence.
    pub fn heard(&self) -> Result<Heard, String> {
        Ok(Heard {
            line: self.line.map(Into::into),
            analog: self.analog_km_h.map(|speed| tenths("analog_km_h", speed)).transpose()?,
            main: self.main.as_ref().map(MainTelegram::kernel).transpose()?,
            sub: self.sub.as_ref().map(SubTelegram::kernel).transpose()?,
            to_exit: self.to_exit_m.map(|length| millimetres("to_exit_m", length)).transpose()?,
            moved: millimetres("moved_m", self.moved_m)?,
        })
    }
}

impl From<Heard> for Step {
    /// What is heard as a step; [`Step::heard`] reads it again. It has no true speed of the train.
    fn from(heard: Heard) -> Self {
        Self {
            line: heard.line.map(Into::into),
            analog_km_h: heard.analog.map(Into::into),
            main: heard.main.map(Into::into),
            sub: heard.sub.map(Into::into),
            to_exit_m: heard.to_exit.map(|length| Metres(length.0.into())),
            moved_m: Metres(heard.moved.0.into()),
            speed_km_h: None,
        }
    }
}

impl From<Permission> for Output {
    /// The permission without what is remembered.
    fn from(permission: Permission) -> Self {
        Self { speed_km_h: permission.speed.map(Into::into), basis: permission.basis.into(), state: None }
    }
}

/// The machine with its state.
#[derive(Clone, Debug)]
pub struct Permitting {
    permitted: Permitted,
    cycle_ms: u32,
    state: State,
}

impl Permitting {
    /// The parameters.
    pub fn permitted(&self) -> &Permitted {
        &self.permitted
    }

    /// The kernel's state.
    pub fn state(&self) -> &State {
        &self.state
    }

    fn remembered(&self) -> Remembered {
        let age = |ticks: Ticks| u64::from(ticks.0) * u64::from(self.cycle_ms);
        let target = self.state.target;
        let fixed = self.state.fixed.iter().flatten();
        Remembered {
            line: self.state.line.into(),
            section: target.map(|target| target.section.0),
            to_stop_m: target.map(|target| Metres(target.to_stop.0.into())),
            main_age_ms: target.map(|target| age(target.age)),
            sub: fixed.map(|sub| RememberedSub { section: sub.section.0, age_ms: age(sub.age) }).collect(),
        }
    }
}

impl Machine for Permitting {
    const NAME: &'static str = "permitted-speed";
    const STEP: &'static str = r#"{"line":null,"analog_km_h":45,"main":{"section":7,"counter":1,"beyond_exit_m":400,"speed_rank":4},"sub":null,"to_exit_m":120.5,"moved_m":0.125}"#;
    const CONFIG: &'static str = r#"{"cycle_ms":10,"speeds_km_h":[0,15,25,45,55,65,75,90],"lowest_limit_km_h":25,"brake_mm_s2":800,"worst_gradient_permille":-35,"margin_m":10,"fresh_ms":2200,"life_ms":5000,"fixed_life_ms":10000,"window":3,"run":1,"memory_ms":2000}"#;

    type Config = Config;
    type Step = Step;
    type Output = Output;

    fn open(config: &Config) -> Result<Self, String> {
        Ok(Self { permitted: config.permitted()?, cycle_ms: config.cycle_ms, state: State::INITIAL })
    }

    fn step(&mut self, step: &Step) -> Result<Output, String> {
        let (state, permission) = permitted::step(&self.permitted, self.state, step.heard()?);
        self.state = state;
        Ok(Output { state: Some(self.remembered()), ..permission.into() })
    }

    fn cycles(&self) -> Vec<(&'static str, u16)> {
        let settings = self.permitted.settings();
        vec![
            ("fresh", settings.fresh.0),
            ("life", settings.life.0),
            ("fixed_life", settings.fixed_life.0),
            ("memory", settings.sequence.memory().0),
        ]
    }
}
