//! `train`: [`atc_kernel::train`], the on-board device as one machine, behind the protocol.

mod config;

pub use config::{AcceptanceTimes, Codes, Config, Pair};

use atc_kernel::Machine as _;
use atc_kernel::aspect::MAX_ASPECTS;
use atc_kernel::duplex::{self, Duplex};
use atc_kernel::speed::RawKmhTenths;
use atc_kernel::telegram::{Frame, encode};
use atc_kernel::train::{self, Antennas, Train};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::contract::Machine;
use super::interlocking::Heading;
use super::permitted::{Basis, LineKind};
use super::supervision::Brake;
use super::{position, telegram};
use crate::decimal::{Decibels, Hertz, Metres, OrNull};
use crate::kmh::{Kmh, KmhOrNull};
use crate::telegrams::Telegram;

/// What is received on one carrier in one cycle.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Carrier {
    /// The code frequency, measured throughout the cycle; null or absent: there is none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub code_hz: Option<Hertz>,
    /// The telegram whose frame was completed in this cycle; null or absent: none. A telegram of the other kind is no telegram here.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub telegram: Option<Telegram>,
    /// In its place, the bits of the frame as they were received: 106 characters 0 or 1.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(regex(pattern = "^[01]{106}$"))]
    pub frame: Option<String>,
}

/// One cycle's input. What is null or absent is not there.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
#[schemars(rename = "TrainStep")]
pub struct Step {
    /// The main carrier.
    pub main: Carrier,
    /// The sub carrier.
    pub sub: Carrier,
    /// The level of the signal that the rail attenuates less.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub first_db: Option<Decibels>,
    /// The level of the signal that the rail attenuates more.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub second_db: Option<Decibels>,
    /// The least and the most that the train moved towards the exit since the last cycle: -32.768 to 32.767 m, negative if it moved
    /// away; null or absent: the odometer says nothing, and the train may have moved as far as can be said.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub moved_m: Option<[Metres; 2]>,
    /// The measured speed; null or absent: there is none, which means emergency.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub speed_km_h: Option<Kmh>,
    /// The kind of line that begins here, if the train is told of one in this cycle.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub line: Option<LineKind>,
    /// The direction of travel in which the train faces; null or absent: it is not known, and no telegram is used.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub facing: Option<Heading>,
    /// With two channels: those that have lost their memory before this cycle, and begin as at a start. Both: a maintenance reset.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub lost: Vec<Channel>,
}

/// One of two channels.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Channel {
    /// Channel A.
    A,
    /// Channel B.
    B,
}

/// One cycle's output.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[schemars(rename = "TrainOutput")]
pub struct Output {
    /// The speed of the displayed aspect; null: nothing is displayed.
    // These may be null, but they may not be missing.
    #[serde(deserialize_with = "Option::deserialize")]
    #[schemars(with = "KmhOrNull")]
    pub display_km_h: Option<Kmh>,
    /// The permitted speed; null: there is none, and that is the emergency brake.
    #[serde(deserialize_with = "Option::deserialize")]
    #[schemars(with = "KmhOrNull")]
    pub permitted_km_h: Option<Kmh>,
    /// What it rests on.
    pub basis: Basis,
    /// The least and the greatest distance of the front to the exit of the section whose signal is heard; null: unknown.
    #[serde(deserialize_with = "Option::deserialize")]
    #[schemars(with = "OrNull<[Metres; 2]>")]
    pub position_m: Option<[Metres; 2]>,
    /// The brake command.
    pub brake: Brake,
}

impl Carrier {
    /// The carrier in the kernel's form; `name` is that of its field.
    fn kernel(&self, name: &str) -> Result<train::Carrier, String> {
        let code = self.code_hz.map(|code| config::millihertz(&format!("{name}.code_hz"), code)).transpose()?;
        let frame: Option<Frame> = match (&self.telegram, &self.frame) {
            (Some(_), Some(_)) => return Err(format!("{name} has a telegram and a frame; it may have one of them")),
            (Some(telegram), None) => Some(encode(telegram.kernel()?)),
            (None, Some(bits)) => Some(telegram::frame(&format!("{name}.frame"), bits)?),
            (None, None) => None,
        };
        Ok(train::Carrier { code, frame })
    }
}

impl Step {
    /// The step in the kernel's form.
    ///
    /// # Errors
    /// The first field that does not fit, in a sentence.
    pub fn antennas(&self) -> Result<Antennas, String> {
        // Read as the position machine reads it, which has the sentences.
        let moved_m = self.moved_m.unwrap_or_default();
        let levels = position::Step { first_db: self.first_db, second_db: self.second_db, moved_m, truth_m: None };
        let measured = levels.measured()?;
        Ok(Antennas {
            main: self.main.kernel("main")?,
            sub: self.sub.kernel("sub")?,
            first: measured.first,
            second: measured.second,
            moved: self.moved_m.map(|_| measured.moved),
            speed: self.speed_km_h.map(|speed| RawKmhTenths(speed.0)),
            line: self.line.map(Into::into),
            facing: self.facing.map(|facing| facing.0),
        })
    }
}

/// The machine with its state.
#[derive(Clone, Debug)]
pub struct OnBoard {
    train: Train<MAX_ASPECTS>,
    /// The device in one channel.
    state: train::State<MAX_ASPECTS>,
    /// The device in two channels, if it has two.
    duplex: Option<Duplex<train::State<MAX_ASPECTS>>>,
}

impl OnBoard {
    /// The parameters.
    pub fn train(&self) -> &Train<MAX_ASPECTS> {
        &self.train
    }

    /// The kernel's state; of two channels, that of channel A.
    pub fn state(&self) -> &train::State<MAX_ASPECTS> {
        self.duplex.as_ref().map_or(&self.state, |duplex| &duplex.a.state)
    }

    /// What the device commands in one cycle.
    fn cab(&mut self, antennas: Antennas, lost: &[Channel]) -> Result<train::Cab, String> {
        let Some(mut device) = self.duplex else {
            if !lost.is_empty() {
                return Err("lost names a channel; this device has one channel (config.channels)".to_owned());
            }
            let (state, cab) = self.train.step(self.state, antennas);
            self.state = state;
            return Ok(cab);
        };
        let started = Duplex::initial(&self.train);
        for (place, channel) in lost.iter().enumerate() {
            if lost[..place].contains(channel) {
                return Err("lost names a channel a second time; each is named once".to_owned());
            }
            match channel {
                Channel::A => device.a = started.a,
                Channel::B => device.b = started.b,
            }
        }
        let (device, agreed) = device.step(&self.train, antennas);
        self.duplex = Some(device);
        Ok(duplex::output::<Train<MAX_ASPECTS>>(agreed))
    }
}

impl Machine for OnBoard {
    const NAME: &'static str = "train";
    const STEP: &'static str = r#"{"main":{"code_hz":22,"telegram":{"main":{"section":7,"counter":1,"beyond_exit_m":400,"speed_rank":4}}},"sub":{"code_hz":21},"first_db":-21.5,"second_db":-24.25,"moved_m":[1.4,1.6],"speed_km_h":44.9,"facing":"left"}"#;
    const CONFIG: &'static str =
        r#"{"permitted":{"cycle_ms":10},"acceptance":{"operate_ms":300},"supervision":{"maximum_km_h":400}}"#;

    type Config = Config;
    type Step = Step;
    type Output = Output;

    fn open(config: &Config) -> Result<Self, String> {
        let train = config.train()?;
        let duplex = match config.channels {
            None | Some(1) => None,
            Some(2) => Some(Duplex::initial(&train)),
            Some(channels) => return Err(format!("channels is {channels}; it must be 1 or 2")),
        };
        Ok(Self { train, state: train.initial(), duplex })
    }

    fn step(&mut self, step: &Step) -> Result<Output, String> {
        let cab = self.cab(step.antennas()?, &step.lost)?;
        Ok(Output {
            display_km_h: cab.display.map(|speed| Kmh(speed.0.into())),
            permitted_km_h: cab.permission.speed.map(|speed| Kmh(speed.0.into())),
            basis: cab.permission.basis.into(),
            position_m: cab.position.map(position::ends),
            brake: cab.brake.into(),
        })
    }

    fn cycles(&self) -> Vec<(&'static str, u16)> {
        let (times, settings) = (self.train.parts().acceptance.times, self.train.parts().permitted.settings());
        vec![
            ("operate", times.operate().0),
            ("recovery", times.recovery().0),
            ("expiry", times.expiry().0),
            ("interruption", times.interruption().0),
            ("shortened_operate", times.shortened_operate().0),
            ("fresh", settings.fresh.0),
            ("life", settings.life.0),
            ("fixed_life", settings.fixed_life.0),
            ("memory", settings.sequence.memory().0),
            // The age of the oldest evidence by which anything can be permitted.
            ("oldest", self.train.oldest().0),
        ]
    }
}
