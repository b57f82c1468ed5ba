//! Ground, channel and train: how long an aspect that the ground no longer sends stays displayed.
//!
//! The ground sends one aspect or nothing, and changes at any time. The channel interrupts it, and in noise bursts
//! makes any aspects heard that are not sent. What is assumed of ground and channel is an [`Environment`]; with a bound
//! lifted, the search finds the hazard that the bound excludes.
//!
//! Exposure is counted for every aspect: the cycles since the ground last sent it or a higher one. A display with
//! exposure 0 is no more permissive than what is sent now.

use crate::line::Line;
use crate::outcome::Trace;
use crate::replay::{self, Receiving};
use crate::subject::{Claim, Subject};
use crate::train::{Device, Train};
use atc_kernel::aspect::AspectSet;

pub mod claims;
mod purpose;

use purpose::Purpose;

/// What the ground and the channel may do. Times in cycles.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Environment {
    /// What the ground sends.
    pub ground: Ground,
    /// The longest interruption; 0 for none.
    pub interruption: Longest,
    /// The fewest cycles without interruption between two.
    pub between: u8,
    /// The longest noise burst, in which an aspect is heard that the ground does not send; 0 for none.
    pub burst: u8,
    /// The fewest cycles between two bursts of the same aspect, 1 or more.
    pub spacing: u8,
}

/// The longest interruption.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Longest {
    /// This many cycles.
    Cycles(u8),
    /// There is no longest one.
    Unlimited,
}

/// What the ground sends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ground {
    /// Any aspect, or nothing if `silence`, each for `dwell` cycles or more.
    Any {
        /// The fewest cycles between two changes, 1 or more.
        dwell: u8,
        /// Whether it may send nothing.
        silence: bool,
    },
    /// The lowest aspect, always.
    Lowest,
}

/// The model: `N` aspects, 1 to 4, and the device `D` under test.
#[derive(Clone, Debug)]
pub struct Reception<D, const N: usize> {
    pub(crate) line: Line,
    pub(crate) device: D,
    pub(crate) environment: Environment,
    pub(crate) purpose: Purpose,
}

/// Ground, channel, train and the ghosts.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct State<S, const N: usize> {
    /// The rank that is sent; `N` for nothing.
    pub(crate) ground: u8,
    /// Cycles since the last change, at most the dwell.
    held: u8,
    /// Cycles of the present interruption, counted up to the longest.
    out: u8,
    /// Cycles since the last interruption, at most `between`.
    back: u8,
    /// Per rank: cycles of the present burst, 0 for none.
    pub(crate) burst: [u8; N],
    /// Per rank: cycles since its last burst, at most the spacing.
    quiet: [u8; N],
    /// Per rank: cycles since the ground last sent it or a higher one; stops one beyond the bound. A ghost.
    pub(crate) exposure: [u16; N],
    /// The ground's aspect has been displayed: a ghost, counted for [`Ground::Lowest`] only.
    pub(crate) met: bool,
    /// The receiver and what it shows.
    pub(crate) train: Train<S, N>,
}

/// One logic cycle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Cycle {
    /// The rank that the ground sends; `N` for nothing.
    ground: u8,
    /// Whether the channel carries it.
    carried: bool,
    /// What noise makes heard.
    noise: AspectSet,
}

impl<D: Device, const N: usize> Reception<D, N> {
    /// The model on `line` in `environment`, with the claims of `purpose`.
    pub fn new(line: Line, environment: Environment, purpose: Purpose) -> Self {
        Self { line, device: D::with(line.ticks()), environment, purpose }
    }

    /// The rank of silence: none.
    fn nothing() -> u8 {
        u8::try_from(N).unwrap_or(u8::MAX)
    }

    fn may_change(&self, state: &State<D::State, N>) -> bool {
        match self.environment.ground {
            Ground::Any { dwell, .. } => state.held >= dwell,
            Ground::Lowest => false,
        }
    }

    fn may_interrupt(&self, state: &State<D::State, N>) -> bool {
        let goes_on = state.out > 0;
        match self.environment.interruption {
            Longest::Unlimited => goes_on || state.back >= self.environment.between,
            Longest::Cycles(longest) if goes_on => state.out < longest,
            Longest::Cycles(longest) => longest > 0 && state.back >= self.environment.between,
        }
    }

    /// The ranks that noise may make heard while `ground` is sent.
    fn may_burst(&self, state: &State<D::State, N>, ground: u8) -> AspectSet {
        let may = |rank: usize| match state.burst[rank] {
            0 => self.environment.burst > 0 && state.quiet[rank] >= self.environment.spacing,
            cycles => cycles < self.environment.burst,
        };
        let ranks = (0..N).filter(|rank| *rank != usize::from(ground) && may(*rank));
        AspectSet::from_bits(ranks.fold(0, |set, rank| set | 1 << rank))
    }
}

impl<D: Device, const N: usize> Subject for Reception<D, N> {
    type State = State<D::State, N>;
    type Action = Cycle;

    fn initial(&self) -> Vec<Self::State> {
        let (ground, held) = match self.environment.ground {
            Ground::Any { silence: true, dwell } => (vec![Self::nothing()], dwell),
            Ground::Any { silence: false, dwell } => ((0..Self::nothing()).collect(), dwell),
            Ground::Lowest => (vec![0], 0),
        };
        let never = self.never();
        ground
            .into_iter()
            .map(|ground| State {
                ground,
                held,
                out: 0,
                back: self.environment.between,
                burst: [0; N],
                quiet: [self.environment.spacing; N],
                exposure: [never; N],
                met: false,
                train: Train::initial(&self.device),
            })
            .collect()
    }

    fn actions(&self, state: &Self::State, actions: &mut Vec<Cycle>) {
        let silence = matches!(self.environment.ground, Ground::Any { silence: true, .. });
        let last = if silence { Self::nothing() } else { Self::nothing() - 1 };
        let grounds = (0..=last).filter(|ground| *ground == state.ground || self.may_change(state));
        for ground in grounds {
            for carried in [true, false] {
                if !carried && !self.may_interrupt(state) {
                    continue;
                }
                let noisy = self.may_burst(state, ground).bits();
                let sets = (0..1_u16 << N).filter(|set| set & !noisy == 0).map(AspectSet::from_bits);
                actions.extend(sets.map(|noise| Cycle { ground, carried, noise }));
            }
        }
    }

    fn next(&self, state: &Self::State, cycle: &Cycle) -> Option<Self::State> {
        let environment = &self.environment;
        let dwell = if let Ground::Any { dwell, .. } = environment.ground { dwell } else { 0 };
        let longest = if let Longest::Cycles(longest) = environment.interruption { longest } else { 1 };
        let never = self.never();
        let mut exposure = state.exposure;
        for (rank, cycles) in exposure.iter_mut().enumerate() {
            let sent = cycle.ground < Self::nothing() && usize::from(cycle.ground) >= rank;
            *cycles = if sent { 0 } else { (*cycles + 1).min(never) };
        }
        let (mut burst, mut quiet) = (state.burst, state.quiet);
        for (rank, (burst, quiet)) in burst.iter_mut().zip(&mut quiet).enumerate() {
            if cycle.noise.bits() >> rank & 1 == 1 {
                (*burst, *quiet) = (*burst + 1, 0);
            } else {
                (*burst, *quiet) = (0, (*quiet + 1).min(environment.spacing));
            }
        }
        let train = state.train.step(&self.device, self.detected(state, cycle));
        let lowest = environment.ground == Ground::Lowest;
        Some(State {
            ground: cycle.ground,
            held: if cycle.ground == state.ground { (state.held + 1).min(dwell) } else { 1.min(dwell) },
            out: if cycle.carried { 0 } else { (state.out + 1).min(longest) },
            back: if cycle.carried { (state.back + 1).min(environment.between) } else { 0 },
            burst,
            quiet,
            exposure,
            met: lowest && (state.met || train.shown.normative.bits() == 1),
            train,
        })
    }

    fn claims(&self) -> Vec<Claim<Self>> {
        self.purpose_claims()
    }

    fn parameters(&self) -> String {
        self.line().describe(self.aspects())
    }

    fn trace(&self, path: &[(Self::State, Option<Self::Action>)]) -> Trace {
        replay::trace(self, path)
    }
}

impl<D: Device, const N: usize> Receiving for Reception<D, N> {
    fn line(&self) -> Line {
        self.line
    }

    fn aspects(&self) -> usize {
        N
    }

    fn detected(&self, _: &Self::State, cycle: &Cycle) -> AspectSet {
        let genuine = Self::sent_by(*cycle).bits() & if cycle.carried { u16::MAX } else { 0 };
        AspectSet::from_bits(genuine | cycle.noise.bits())
    }

    fn sent(&self, _: &Self::State, cycle: &Cycle) -> Option<AspectSet> {
        Some(Self::sent_by(*cycle))
    }
}

impl<D: Device, const N: usize> Reception<D, N> {
    fn sent_by(cycle: Cycle) -> AspectSet {
        AspectSet::from_bits(if cycle.ground < Self::nothing() { 1 << cycle.ground } else { 0 })
    }
}
