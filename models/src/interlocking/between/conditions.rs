//! How long things count, the times that are right for that, and what may fail.

use atc_kernel::time::Ticks;

/// For how long something counts after it has ended, in cycles.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Lives {
    /// For how long after it was sent a permission may still be read; 0: only in the cycle after.
    pub permission: u8,
    /// For how long after a signal fell a train may still pass it.
    pub residual: u8,
}

/// The times of both stations.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Times {
    /// The turn time.
    pub turn: Ticks,
    /// The time after a start.
    pub start: Ticks,
    /// For how many cycles a circuit must be reported clear to count as clear.
    pub clear: u8,
}

impl Times {
    /// What the rules of a layout ask for, where a train may be lost for so many cycles: the turn time covers a permission's life, the
    /// residual running and the loss; the time after a start covers the turn time and every release; a train that is lost where it leaves a
    /// circuit, and again where it enters the next one, still counts.
    pub fn right(lives: Lives, unheard: u8) -> Self {
        let release = u16::from(lives.residual) + u16::from(unheard);
        let turn = Ticks(u16::from(lives.permission) + release);
        Self { turn, start: turn, clear: (2 * unheard).max(1) }
    }
}

/// What may happen besides.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Faults {
    /// For how many cycles in a row a train may not be reported.
    pub unheard: u8,
    /// The circuits of each station that may be reported occupied without a train: a mask.
    pub falsely: u8,
    /// Whether a device may start again.
    pub restarts: bool,
}

impl Faults {
    /// They in words, behind others.
    pub fn words(self) -> String {
        let falsely = match self.falsely {
            0 => "",
            1 => "; the line may be reported occupied without a train, to either station",
            _ => "; the line and the throats may be reported occupied without a train",
        };
        let unheard =
            if self.unheard > 0 { format!("; a train may be lost for {} cycle", self.unheard) } else { String::new() };
        let restarts = if self.restarts { "; either device may start again" } else { "" };
        format!("{falsely}{unheard}{restarts}")
    }
}
