//! The receiver at the other end of a track circuit: free only while it hears its own signal (SIG-3).

use std::fmt;

use atc_kernel::telegram::SectionId;

use super::branch::{Branch, OnCarrier};
use super::carrier::{Keying, Squelch};
use super::code::CodeConfidence;
use crate::config::{Carrier, TransmitterConfig};
use crate::units::{Level, SampleIndex, Seconds};

/// What makes a circuit free.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TrackCircuitParams {
    /// The section's own number, which its telegrams must carry; nothing on an analog-only line.
    pub own: Option<SectionId>,
    /// An occupied circuit needs at least this amplitude on both carriers to become free.
    pub pick_up: Level,
    /// A free circuit with less than this on either carrier becomes occupied; at most `pick_up`.
    pub drop_away: Level,
    /// On a digital line: how long after the last telegram of its own, on either carrier, the circuit stays free. What
    /// came before or while the signal was too faint does not count.
    pub telegram_lifetime: Seconds,
}

/// Which rule the parameters break.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum TrackCircuitError {
    /// The levels must be above 0 and finite, and `drop_away` at most `pick_up`.
    Levels {
        /// The level to become free.
        pick_up: f64,
        /// The level to become occupied.
        drop_away: f64,
    },
    /// The lifetime must be at least one telegram, 106 bits, and at most a minute.
    Lifetime {
        /// What it is, in seconds.
        seconds: f64,
        /// What it must be at least, in seconds.
        least: f64,
    },
}

impl fmt::Display for TrackCircuitError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Levels { pick_up, drop_away } => write!(
                f,
                "pick_up is {pick_up} and drop_away {drop_away}; both must be above 0 and finite, and drop_away at most pick_up"
            ),
            Self::Lifetime { seconds, least } => {
                write!(f, "telegram_lifetime is {seconds} s; it must be from {least} s, one telegram, to 60 s")
            }
        }
    }
}

impl std::error::Error for TrackCircuitError {}

/// What a track circuit says; the safer state is the greater.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum TrackState {
    /// Its own signal arrives.
    Free,
    /// It does not, or not surely.
    Occupied,
}

/// The receiver. It starts occupied.
///
/// On every line both carriers must carry a code: a harmonic of the traction current can stand exactly on a carrier,
/// but it is not modulated.
pub struct TrackCircuit {
    params: TrackCircuitParams,
    main: Branch,
    sub: Branch,
    coded: [Coded; 2],
    at: u64,
    own_until: u64,
    lifetime: u64,
    state: TrackState,
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Coded {
    Yes,
    No,
}

impl TrackCircuit {
    /// A receiver of this signal.
    ///
    /// # Errors
    /// [`TrackCircuitError`] says which parameter cannot be.
    pub fn new(config: &TransmitterConfig, params: TrackCircuitParams) -> Result<Self, TrackCircuitError> {
        let (pick_up, drop_away) = (params.pick_up.0, params.drop_away.0);
        if !(drop_away > 0.0 && drop_away <= pick_up && pick_up.is_finite()) {
            return Err(TrackCircuitError::Levels { pick_up, drop_away });
        }
        let least = f64::from(atc_kernel::telegram::FRAME_BITS) / config.bit_rate().0;
        let seconds = params.telegram_lifetime.0;
        if params.own.is_some() && !(least..=60.0).contains(&seconds) {
            return Err(TrackCircuitError::Lifetime { seconds, least });
        }
        let keying = if params.own.is_some() { Keying::Heard } else { Keying::Ignored };
        // Here it counts that there is a code, and not which one: a step of the level is no reason to say occupied.
        let confidence = CodeConfidence { least_steadiness: 0.0, ..CodeConfidence::default() };
        let receiver = |carrier| Branch::new(config, carrier, keying, confidence, Squelch::default());
        Ok(Self {
            params,
            main: receiver(Carrier::Main),
            sub: receiver(Carrier::Sub),
            coded: [Coded::No; 2],
            at: 0,
            own_until: 0,
            lifetime: params.telegram_lifetime.samples(config.sample_rate()),
            state: TrackState::Occupied,
        })
    }

    /// What the circuit says now.
    pub fn state(&self) -> TrackState {
        self.state
    }

    /// Takes the next samples; says when and what the circuit changes to. Allocates nothing.
    pub fn process(&mut self, block: &[f32], mut changes: impl FnMut(SampleIndex, TrackState)) {
        for &sample in block {
            self.at += 1;
            // On an analog-only line the lifetime may be anything.
            let until = self.at.saturating_add(self.lifetime);
            for (place, receiver) in [&mut self.main, &mut self.sub].into_iter().enumerate() {
                let coded = &mut self.coded[place];
                let (own, own_until) = (self.params.own, &mut self.own_until);
                let mut from = |section: SectionId| {
                    // Somebody else's signal is heard so well that ours cannot be there.
                    *own_until = if Some(section) == own { until } else { 0 };
                };
                receiver.push(sample, |on| match on {
                    OnCarrier::Bit(_) => (),
                    OnCarrier::Main(main) => from(main.section),
                    OnCarrier::Sub(sub) => from(sub.section),
                    OnCarrier::Code(reading) => {
                        *coded = if reading.millihertz.is_some() { Coded::Yes } else { Coded::No };
                    }
                });
            }
            let state = self.judge();
            if state != self.state {
                self.state = state;
                changes(SampleIndex(self.at), state);
            }
        }
    }

    fn judge(&mut self) -> TrackState {
        let threshold = match self.state {
            TrackState::Occupied => self.params.pick_up,
            TrackState::Free => self.params.drop_away,
        };
        let loud = self.main.level() >= threshold.0 && self.sub.level() >= threshold.0;
        if !loud {
            // What leaks past the axles may still carry readable telegrams: only those of a loud signal count.
            self.own_until = 0;
        }
        let coded = self.coded == [Coded::Yes; 2];
        let own = self.params.own.is_none() || self.at <= self.own_until;
        if loud && coded && own { TrackState::Free } else { TrackState::Occupied }
    }
}
