//! `speed-supervision`: [`atc_kernel::supervision`] behind the protocol.

use atc_kernel::Machine as _;
use atc_kernel::speed::RawKmhTenths;
use atc_kernel::supervision::{self, Speeds, Supervision};
pub use atc_line::supervision::Config;
use schemars::JsonSchema;
use serde::de::{Deserializer, Error as _};
use serde::{Deserialize, Serialize};

use super::contract::Machine;
use crate::kmh::{Kmh, KmhOrNull};

/// The brake command.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Brake {
    /// No braking by this device.
    Release,
    /// Service brake.
    Service,
    /// Emergency brake.
    Emergency,
}

impl Brake {
    /// Every command, in the order of braking.
    pub const ALL: [Self; 3] = [Self::Release, Self::Service, Self::Emergency];

    /// Its name on the wire.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Release => "release",
            Self::Service => "service",
            Self::Emergency => "emergency",
        }
    }
}

// Not derived: serde would take `{"service":null}` for "service" as well.
impl<'de> Deserialize<'de> for Brake {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let name = String::deserialize(deserializer)?;
        Self::ALL.into_iter().find(|brake| brake.name() == name).ok_or_else(|| {
            D::Error::custom(format_args!("unknown brake {name:?}, expected \"release\", \"service\" or \"emergency\""))
        })
    }
}

impl From<supervision::Brake> for Brake {
    fn from(brake: supervision::Brake) -> Self {
        match brake {
            supervision::Brake::Release => Self::Release,
            supervision::Brake::Service => Self::Service,
            supervision::Brake::Emergency => Self::Emergency,
        }
    }
}

impl From<Brake> for supervision::Brake {
    fn from(brake: Brake) -> Self {
        match brake {
            Brake::Release => Self::Release,
            Brake::Service => Self::Service,
            Brake::Emergency => Self::Emergency,
        }
    }
}

/// One logic cycle's input. Any speed is an input, plausible or not.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "SupervisionStep")]
pub struct Step {
    /// The measured speed; null: there is none, which means emergency.
    #[serde(deserialize_with = "Option::deserialize")]
    #[schemars(with = "KmhOrNull")]
    pub speed_km_h: Option<Kmh>,
    /// The permitted speed; null: nothing is displayed, which means emergency.
    #[serde(deserialize_with = "Option::deserialize")]
    #[schemars(with = "KmhOrNull")]
    pub permitted_km_h: Option<Kmh>,
    /// The previous command, in place of the last output (initially emergency).
    #[serde(default, deserialize_with = "present", skip_serializing_if = "Option::is_none")]
    #[schemars(with = "Brake")]
    pub previous: Option<Brake>,
}

/// A field that may be absent, but not null.
fn present<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<Brake>, D::Error> {
    Brake::deserialize(deserializer).map(Some)
}

/// One logic cycle's output.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[schemars(rename = "SupervisionOutput")]
pub struct Output {
    /// The brake command from the end of the cycle on.
    pub brake: Brake,
}

/// The machine with its state.
#[derive(Clone, Debug)]
pub struct Supervised {
    parameters: Supervision,
    previous: supervision::Brake,
}

impl Machine for Supervised {
    const NAME: &'static str = "speed-supervision";
    const STEP: &'static str = r#"{"speed_km_h":44.9,"permitted_km_h":45}"#;
    const CONFIG: &'static str = r#"{"maximum_km_h":400,"release_margin_km_h":0}"#;

    type Config = Config;
    type Step = Step;
    type Output = Output;

    fn open(config: &Config) -> Result<Self, String> {
        let parameters = config.supervision()?;
        Ok(Self { parameters, previous: parameters.initial() })
    }

    fn step(&mut self, step: &Step) -> Result<Output, String> {
        let raw = |speed: Option<Kmh>| speed.map(|speed| RawKmhTenths(speed.0));
        let previous = step.previous.map_or(self.previous, supervision::Brake::from);
        let speeds = Speeds { measured: raw(step.speed_km_h), permitted: raw(step.permitted_km_h) };
        let (state, brake) = self.parameters.step(previous, speeds);
        self.previous = state;
        Ok(Output { brake: brake.into() })
    }
}
