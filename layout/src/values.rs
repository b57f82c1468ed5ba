//! The numbers of a layout file that hold for the whole station, and their defaults.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::at::At;

/// Times for the whole station, in ms.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Times {
    /// The length of a logic cycle.
    pub cycle_ms: At<u32>,
    /// How long a circuit must be reported clear before it counts as clear: at least twice `shunt_loss_ms`, at most 255 cycles.
    pub clear_ms: At<u32>,
    /// The longest time for which the shunt of a train may be lost.
    pub shunt_loss_ms: At<u32>,
    /// How long points may take to arrive before the route has failed.
    pub drive_ms: At<u32>,
    /// The longest time of a point's stroke.
    pub throw_ms: At<u32>,
    /// How long after a start nothing moves, is confirmed or turned [default: the least that can be: the longest release time, or the turn time].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub start_ms: Option<At<u32>>,
    /// Why a shorter time after a start is enough: every train is known to stand.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub start_protected: Option<At<String>>,
    /// How long a point must stand detected after it was driven before it counts as detected: as long as a stroke may take to show. 0: a command takes
    /// effect in its cycle or never.
    pub settle_ms: At<u32>,
    /// How long a route stays locked after it was withdrawn with a train coming: at least `residual_ms` and `shunt_loss_ms`.
    pub release_ms: At<u32>,
    /// The longest time for which a train still passes a signal after its authority was taken away [default: the least that can be:
    /// `telegram_age_ms` and the time to a stand from the highest speed].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub residual_ms: Option<At<u32>>,
    /// How long a train must have stood on the last circuit before the overlap is given up: longer than `standstill_ms` and `shunt_loss_ms` [default:
    /// 30 s, or the least that can be if that is longer].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub stay_ms: Option<At<u32>>,
    /// The longest time in which a train comes to a stand once it is wholly on the last circuit of its route [default: 15 s, or if that is longer
    /// the time for the longest last circuit of a route with an overlap, at the route's speed and then braking].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub standstill_ms: Option<At<u32>>,
    /// For how long the neighbour's permission must have been withdrawn before plain line turns, or a block on it is confirmed [default: the
    /// least that can be: `telegram_age_ms`, `residual_ms` and `shunt_loss_ms`].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub turn_ms: Option<At<u32>>,
    /// The age up to which a train acts on a telegram.
    pub telegram_age_ms: At<u32>,
}

impl Default for Times {
    fn default() -> Self {
        Self {
            cycle_ms: At::derived(100),
            clear_ms: At::derived(2_000),
            shunt_loss_ms: At::derived(1_000),
            drive_ms: At::derived(10_000),
            throw_ms: At::derived(7_000),
            start_ms: None,
            start_protected: None,
            settle_ms: At::derived(1_000),
            release_ms: At::derived(60_000),
            residual_ms: None,
            stay_ms: None,
            standstill_ms: None,
            turn_ms: None,
            telegram_age_ms: At::derived(1_000),
        }
    }
}

/// The brake, and the speeds of the codes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Braking {
    /// The deceleration on the level that every train has at least, 1 to 4095 mm/s².
    pub deceleration_mm_s2: At<u16>,
    /// The deceleration on the level of the pattern by which a train comes from telegrams to codes, at most: `deceleration_mm_s2` to 4095. Without it
    /// the distances of the codes hold for `deceleration_mm_s2` alone.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub strongest_mm_s2: Option<At<u16>>,
    /// The speeds of the codes 1, 2, … in km/h: 1 to 7 of them, rising, at most 409.
    pub speeds_kmh: At<Vec<u16>>,
    /// How far beyond the end of its circuit a train may hear a code, with the metres from its antenna to its nose: 0 to 1000 [default: 0].
    #[serde(skip_serializing_if = "is_none")]
    pub heard_beyond_m: At<u16>,
}

const fn is_none(metres: &At<u16>) -> bool {
    metres.value == 0
}

impl Default for Braking {
    fn default() -> Self {
        Self {
            deceleration_mm_s2: At::derived(800),
            strongest_mm_s2: None,
            speeds_kmh: At::derived(vec![15, 25, 45, 55, 65, 75, 90]),
            heard_beyond_m: At::derived(0),
        }
    }
}

/// Speeds where a route names none.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Speeds {
    /// The highest speed of a train that comes up to a signal, in km/h [default: that of the highest code].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub line_kmh: Option<At<u16>>,
    /// The highest speed on a route over a reverse point, in km/h [default: that of the lowest code].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub reverse_kmh: Option<At<u16>>,
    /// The highest speed on a route, in km/h [default: `line_kmh`].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub route_kmh: Option<At<u16>>,
    /// The highest speed on a calling-on route and in its berth, in km/h: one at which a driver stops short of what he sees [default: that of the
    /// lowest code].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub calling_on_kmh: Option<At<u16>>,
}

/// What is asked of overlaps.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Overlaps {
    /// The least length of an overlap, in metres.
    pub least_m: At<u16>,
}

impl Default for Overlaps {
    fn default() -> Self {
        Self { least_m: At::derived(50) }
    }
}
