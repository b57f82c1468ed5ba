//! Consent: what two stations tell each other of the segments between them, and how old that can be.
//!
//! Each message echoes the last stamp that its sender has heard from the receiver. What answers a stamp was sent after it, so the
//! receiver knows how old a message is at most, however long it was on its way and however often it is repeated.

use super::WaysideError;
use crate::interlocking::Epoch;
use crate::time::{MAX_TICKS, Ticks};

/// The number of a device's start, never the same twice for one device.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Session(pub u16);

/// A cycle of a device: of which start, and its number since.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Stamp {
    /// The start.
    pub session: Session,
    /// The number of the cycle.
    pub cycle: Epoch,
}

/// Whether a station permits its neighbour to send trains into a segment. The greater one permits more.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Permission {
    /// It does not.
    Withheld,
    /// It does.
    Granted,
}

/// What one station tells the other of one segment.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Message {
    /// Whether the sender permits the receiver to send trains.
    pub permission: Permission,
    /// The sender's cycle.
    pub sent: Stamp,
    /// The receiver's cycle that the sender has heard of last; none if it has heard nothing since its start.
    pub echo: Option<Stamp>,
}

/// What is remembered of the neighbour at one segment.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Consent {
    /// What the newest message says, less what was withdrawn since.
    pub permission: Permission,
    /// Cycles since the own cycle that the newest message echoes: the message is no older. Stops one above the life.
    pub age: Ticks,
    /// The neighbour's cycle that was heard of last.
    pub heard: Option<Stamp>,
}

impl Consent {
    /// Nothing heard: older than every life there may be.
    pub const fn none(life: Ticks) -> Self {
        Self { permission: Permission::Withheld, age: Ticks(life.0.saturating_add(1)), heard: None }
    }

    /// Whether the age is one that is counted.
    pub const fn is_valid(&self, life: Ticks) -> bool {
        self.age.0 <= life.0.saturating_add(1)
    }

    /// One cycle, the one stamped `now`, with the message that came in it.
    #[inline]
    #[must_use]
    pub const fn hear(mut self, life: Ticks, now: Stamp, message: Option<Message>) -> Self {
        if self.age.0 <= life.0 {
            self.age = Ticks(self.age.0.saturating_add(1));
        }
        let Some(message) = message else { return self };
        self.heard = Some(message.sent);
        let age = age(life, now, message.echo);
        //= spec/wayside.md#way-9-messages-out-of-order
        //# A message that echoes no later cycle than one before it MUST grant nothing; it may withdraw.
        if age.0 < self.age.0 {
            self.permission = message.permission;
            self.age = age;
        } else if matches!(message.permission, Permission::Withheld) {
            self.permission = Permission::Withheld;
        }
        self
    }

    /// What is told to the neighbour in the cycle stamped `sent`.
    #[must_use]
    pub const fn tell(&self, sent: Stamp, permission: Permission) -> Message {
        //= spec/wayside.md#way-22-what-the-neighbour-is-told
        //# A device MUST tell its neighbour at each segment in every cycle whether it permits it to send trains, the number of the cycle, and the cycle of the neighbour that it has heard of last.
        Message { permission, sent, echo: self.heard }
    }

    /// Whether the neighbour's permission counts.
    pub const fn counts(&self, life: Ticks) -> bool {
        //= spec/wayside.md#way-8-the-age-of-consent
        //# The neighbour's permission MUST count only while no more cycles than its life have passed since the own cycle that its message echoes.
        matches!(self.permission, Permission::Granted) && self.age.0 <= life.0
    }
}

/// Whether a permission may count for `life`, on a line with this turn time, where a train runs on for `residual` and may be lost for `loss` cycles.
///
/// # Errors
/// [`WaysideError::NoLife`] or [`WaysideError::LifeOutlastsTurn`].
pub const fn check_life(life: Ticks, turn: Ticks, residual: Ticks, loss: u8) -> Result<(), WaysideError> {
    //= spec/wayside.md#way-20-the-life-of-consent
    //# The constructor MUST reject a life of the neighbour's permission that is 0, over 60 000 cycles, not under the layout's turn time, or, with the residual running and the longest loss of shunt, over it.
    // A train that was sent on the last cycle of a permission.
    let seen = life.0 as u32 + residual.0 as u32 + loss as u32;
    if life.0 == 0 {
        Err(WaysideError::NoLife)
    } else if life.0 > MAX_TICKS || life.0 >= turn.0 || seen > turn.0 as u32 {
        Err(WaysideError::LifeOutlastsTurn)
    } else {
        Ok(())
    }
}

/// Cycles since the own cycle `echo`, up to one above the life; so many for an echo of no cycle of this start.
const fn age(life: Ticks, now: Stamp, echo: Option<Stamp>) -> Ticks {
    let too_old = Ticks(life.0.saturating_add(1));
    match echo {
        Some(echo) if echo.session.0 == now.session.0 => {
            let since = now.cycle.0.wrapping_sub(echo.cycle.0);
            let bytes = since.to_le_bytes();
            if since <= life.0 as u32 { Ticks(u16::from_le_bytes([bytes[0], bytes[1]])) } else { too_old }
        }
        _ => too_old,
    }
}
