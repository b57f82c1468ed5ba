//! The words of the messages: positions, directions, phases and reasons by name.

use std::borrow::Cow;

use atc_kernel::interlocking::{self, Refusal};
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use crate::names::{self, Named};

/// A kernel value that is written as one of a few names.
macro_rules! word {
    ($(#[$doc:meta])* $word:ident($kernel:ty), $schema:literal, $what:literal, $($value:ident => $name:literal, $says:literal;)+) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub struct $word(pub $kernel);

        impl Named for $word {
            const WHAT: &'static str = $what;
            const EVERY: &'static [Self] = &[$(Self(<$kernel>::$value)),+];

            fn name(self) -> &'static str {
                match self.0 {
                    $(<$kernel>::$value => $name,)+
                }
            }
        }

        impl Serialize for $word {
            fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
                serializer.serialize_str(self.name())
            }
        }

        impl<'de> Deserialize<'de> for $word {
            fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
                names::read(deserializer)
            }
        }

        impl JsonSchema for $word {
            fn schema_name() -> Cow<'static, str> {
                $schema.into()
            }

            fn json_schema(_: &mut SchemaGenerator) -> Schema {
                let values = [$(serde_json::json!({ "const": $name, "description": $says })),+];
                json_schema!({ "description": concat!("One of a few names: a ", $what, "."), "oneOf": values.as_slice() })
            }
        }
    };
}

word! {
    /// A position of a point.
    Side(interlocking::Position), "PointPosition", "position",
    Normal => "normal", "The position that the layout calls normal.";
    Reverse => "reverse", "The other one.";
}

word! {
    /// A direction of travel.
    Heading(interlocking::Heading), "Heading", "direction of travel",
    Left => "left", "Towards the ends of circuits that the layout calls left.";
    Right => "right", "Towards the ends of circuits that the layout calls right.";
}

word! {
    /// A direction of plain line.
    Travel(interlocking::Travel), "Travel", "direction",
    Toward => "toward", "Towards this station: the neighbour sends trains.";
    Away => "away", "Away from this station: this station sends trains.";
}

word! {
    /// The phase of a route.
    Phase(interlocking::Phase), "RoutePhase", "phase",
    Idle => "idle", "Nothing is held.";
    Provisional => "provisional", "Reserved provisionally: its points are being driven.";
    Failed => "failed", "A point did not arrive in time; everything stays locked until the route is withdrawn.";
    Set => "set", "Reserved and locked; its signal may show proceed.";
    InUse => "in-use", "A train has entered the path, or something has occupied it.";
    Releasing => "releasing", "Withdrawn: nobody may enter, and everything stays locked until the release time has passed.";
}

word! {
    /// Why a request is refused.
    Reason(Refusal), "RefusalReason", "reason",
    Unknown => "unknown", "There is no such route, point or segment.";
    Starting => "starting", "The device has just started: a train may still count on what was before.";
    AlreadyHeld => "already-held", "The route to be set is held already.";
    NotHeld => "not-held", "The route to be withdrawn is not held.";
    Conflict => "conflict", "A route that is declared to conflict is held.";
    PathHeld => "path-held", "A circuit of the path, or the point's detector, is held by another route.";
    OverlapHeld => "overlap-held", "A circuit of the overlap is held by another route.";
    PointLocked => "point-locked", "A point is needed or locked in another position by a route.";
    Occupied => "occupied", "A circuit of path or overlap is occupied; a berth may be.";
    NotCalledFor => "not-called-for", "A calling-on route without a train that waits at its signal, or without one in its berth.";
    Unswept => "unswept", "A train from before the start may still run over a circuit of path or overlap, or over the point.";
    Blocked => "blocked", "A circuit of path or overlap, or the point's detector, is blocked.";
    PointUnderTrain => "point-under-train", "A point must move, and a train stands on it.";
    Direction => "direction", "A segment has not the direction that the route needs, or cannot turn because of a route or a train.";
    Waiting => "waiting", "The segment's permission is withdrawn; the neighbour's is missing, or this station's own may still be in the air.";
}
