//! The parameters of the permitted speed, checked.

use crate::aspect::{AspectId, AspectTable};
use crate::distance::Metres;
use crate::pattern::Deceleration;
use crate::telegram::{Gradient, Sequence};
use crate::time::{MAX_TICKS, Ticks};

/// The parameters as a configuration gives them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Settings {
    /// The line's speeds: what the ranks in telegrams mean.
    pub speeds: AspectTable,
    /// The lowest limit that a sub telegram of this line carries.
    pub lowest: AspectId,
    /// The train's braking on the level.
    pub brake: Deceleration,
    /// The worst gradient that a sub telegram of this line carries.
    pub worst: Gradient,
    /// What is taken off every distance to a stopping point.
    pub margin: Metres,
    /// For how many cycles a main telegram is fresh: 1 or more.
    pub fresh: Ticks,
    /// For how many cycles the pattern of a main telegram runs down, and a code alone is enough: `fresh` or more.
    pub life: Ticks,
    /// For how many cycles a sub telegram is used: 1 or more.
    pub fixed_life: Ticks,
    /// How counters advance; its memory is no longer than either life.
    pub sequence: Sequence,
}

/// Which rule the parameters break. Source: `spec/permitted.md`, PER-9.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PermittedError {
    /// The lowest limit is not in the table of speeds.
    UnknownLimit,
    /// A main telegram would never be fresh.
    NoFreshness,
    /// The pattern would end before its telegram is stale.
    LifeShorterThanFreshness,
    /// A time is over [`MAX_TICKS`] cycles.
    TooLong,
    /// A sub telegram would never be used.
    NoFixedLife,
    /// A stream is remembered for longer than a main or a sub telegram lives: one that continues it could be past its life.
    MemoryLongerThanLife,
}

/// The parameters of the machine.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Permitted(Settings);

impl Permitted {
    /// Checks and keeps the parameters.
    ///
    /// # Errors
    /// The first rule that is broken, in the order of [`PermittedError`].
    pub fn new(settings: Settings) -> Result<Self, PermittedError> {
        //= spec/permitted.md#per-9-the-constructor
        //# The constructor MUST reject a lowest limit that is not in the table, a freshness of 0 or over the life, a life of a sub telegram of 0, a memory over either life, and any time over 60 000 cycles.
        if settings.speeds.speed(settings.lowest).is_none() {
            Err(PermittedError::UnknownLimit)
        } else if settings.fresh.0 == 0 {
            Err(PermittedError::NoFreshness)
        } else if settings.life.0 < settings.fresh.0 {
            Err(PermittedError::LifeShorterThanFreshness)
        } else if settings.life.0 > MAX_TICKS || settings.fixed_life.0 > MAX_TICKS {
            Err(PermittedError::TooLong)
        } else if settings.fixed_life.0 == 0 {
            Err(PermittedError::NoFixedLife)
        } else if settings.sequence.memory().0 > settings.life.0 || settings.sequence.memory().0 > settings.fixed_life.0
        {
            Err(PermittedError::MemoryLongerThanLife)
        } else {
            Ok(Self(settings))
        }
    }

    /// The parameters as they were given.
    pub const fn settings(&self) -> &Settings {
        &self.0
    }

    pub(super) const fn speeds(&self) -> &AspectTable {
        &self.0.speeds
    }

    pub(super) const fn lowest(&self) -> AspectId {
        self.0.lowest
    }

    pub(super) const fn brake(&self) -> Deceleration {
        self.0.brake
    }

    pub(super) const fn worst(&self) -> Gradient {
        self.0.worst
    }

    pub(super) const fn margin(&self) -> Metres {
        self.0.margin
    }

    pub(super) const fn fresh(&self) -> Ticks {
        self.0.fresh
    }

    pub(super) const fn life(&self) -> Ticks {
        self.0.life
    }

    pub(super) const fn fixed_life(&self) -> Ticks {
        self.0.fixed_life
    }

    pub(super) const fn sequence(&self) -> &Sequence {
        &self.0.sequence
    }
}
