//! Parts that are wrong for a whole run: of the ground, or on board. What one of them leads to is harm only where nothing else
//! stands in its way; so they are tried alone, in pairs, and with every fault of the line.

use atc_kernel::aspect::TimesMs;
use atc_kernel::distance::Metres;
use atc_kernel::interlocking::{Plan, Size};
use atc_kernel::pattern::Deceleration;
use atc_kernel::permitted::Settings;
use atc_kernel::time::{MAX_TICKS, Millis, Ticks};
use serde::{Deserialize, Serialize};

/// What is wrong.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Defect {
    /// Ground: a circuit counts as clear as soon as it is reported clear.
    ClearsAtOnce,
    /// Ground: after a start the device waits for no train that still runs on what was said before.
    StartsAtOnce,
    /// Ground: the distances of the codes are those of trains that stop within metres.
    CodesTooHigh,
    /// On board: the pattern counts on five times the brake.
    PatternTooHigh,
    /// On board: a telegram is used for a minute.
    TelegramsLiveOn,
    /// On board: a code is accepted in the second cycle in which it is heard.
    CodesAtOnce,
    /// On board: a code stands for as long after its end as the device can count.
    CodesLiveOn,
}

impl Defect {
    /// All of them.
    pub const ALL: [Self; 7] = [
        Self::ClearsAtOnce,
        Self::StartsAtOnce,
        Self::CodesTooHigh,
        Self::PatternTooHigh,
        Self::TelegramsLiveOn,
        Self::CodesAtOnce,
        Self::CodesLiveOn,
    ];

    /// Its name on the command line and in files.
    pub const fn name(self) -> &'static str {
        match self {
            Self::ClearsAtOnce => "clears-at-once",
            Self::StartsAtOnce => "starts-at-once",
            Self::CodesTooHigh => "codes-too-high",
            Self::PatternTooHigh => "pattern-too-high",
            Self::TelegramsLiveOn => "telegrams-live-on",
            Self::CodesAtOnce => "codes-at-once",
            Self::CodesLiveOn => "codes-live-on",
        }
    }

    /// The defect of this name.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|defect| defect.name() == name)
    }

    /// Makes the plan of a station's device wrong; says whether it did.
    pub(crate) fn spoil<const R: usize, const P: usize, const N: usize, const S: usize, Z: Size>(
        self,
        plan: &mut Plan<R, P, N, S, Z>,
    ) -> bool {
        match self {
            Self::ClearsAtOnce => (plan.clear, plan.loss) = (1, 0),
            Self::StartsAtOnce => plan.start = Ticks(1),
            Self::CodesTooHigh => {
                let known = plan.braking.iter_mut().skip(1).filter(|distance| distance.0 < u16::MAX);
                known.zip(1..).for_each(|(distance, metres)| *distance = Metres(metres));
            }
            Self::PatternTooHigh | Self::TelegramsLiveOn | Self::CodesAtOnce | Self::CodesLiveOn => return false,
        }
        true
    }

    /// Makes the settings of an on-board device wrong.
    pub(crate) fn spoil_on_board(self, times: &mut TimesMs, settings: &mut Settings, cycle_ms: u32) {
        match self {
            Self::PatternTooHigh => settings.brake = Deceleration::brake(5 * 800).unwrap_or(settings.brake),
            Self::TelegramsLiveOn => {
                let minute = u16::try_from(60_000 / cycle_ms).unwrap_or(MAX_TICKS).min(MAX_TICKS);
                (settings.life, settings.fresh) = (Ticks(minute), Ticks(minute));
            }
            Self::CodesAtOnce => (times.operate, times.shortened_operate) = (Millis(2 * cycle_ms), Millis(cycle_ms)),
            Self::CodesLiveOn => times.mask = Millis(60_000),
            Self::ClearsAtOnce | Self::StartsAtOnce | Self::CodesTooHigh => {}
        }
    }
}
