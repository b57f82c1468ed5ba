//! The acceptance machine itself.

use super::{AspectId, AspectSet, Display, Times};
use crate::Machine;
use crate::time::Ticks;

/// The most aspects that a line may have.
pub const MAX_ASPECTS: usize = 16;

/// Aspect acceptance for the `N` lowest ranks, `N` at most [`MAX_ASPECTS`] (checked when it is compiled). A line
/// uses 16; the proofs also use fewer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Acceptance<const N: usize> {
    /// The times of the line.
    pub times: Times,
}

/// What the machine remembers.
///
/// The fields are private so that only [`step`] moves them; [`Parts`] gives them to proofs, fault injection and
/// storage. Every bit pattern is a Rust value, and `step` is total on all of them (DUP-1 injects every bit).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct State<const N: usize> {
    /// Per rank: consecutive cycles in which it was heard, up to now; stops at T1.
    run: [Ticks; N],
    /// Per rank: cycles since it was lost, 1 in the first cycle without it; 0 while not lost.
    age: [Ticks; N],
    /// Accepted and not gone.
    accepted: AspectSet,
    /// Accepted, but masked and contradicted: unsatisfied until accepted again.
    dropped: AspectSet,
    /// Gone while a re-detection was under way that may use T5. (Before it is gone, age and run tell.)
    credited: AspectSet,
    /// What was displayed last, kept while nothing is.
    last: Display,
}

/// The fields of a [`State`], for proofs, fault injection and storage. Units as there: cycles, and a bit a rank.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Parts<const N: usize> {
    /// Cycles heard up to now, by rank.
    pub run: [u16; N],
    /// Cycles since the loss, by rank.
    pub age: [u16; N],
    /// Accepted and not gone.
    pub accepted: u16,
    /// Dropped.
    pub dropped: u16,
    /// Re-detected with a credit that outlives expiry.
    pub credited: u16,
    /// Displayed last, a bit or none.
    pub last: u16,
}

impl<const N: usize> State<N> {
    /// Nothing heard, nothing accepted, nothing displayed: the most restrictive state.
    pub const INITIAL: Self = Self {
        run: [Ticks(0); N],
        age: [Ticks(0); N],
        accepted: AspectSet::EMPTY,
        dropped: AspectSet::EMPTY,
        credited: AspectSet::EMPTY,
        last: Display::NOTHING,
    };

    /// The invariant. Kept by [`step`] (T-ACC-8); every proof assumes it before a step and nothing more.
    pub fn is_valid(&self, times: Times) -> bool {
        //= spec/general.md#gen-1-one-invariant
        //# Every state type MUST have one validity predicate that the initial state, the most restrictive one, satisfies and every step preserves.
        let ranks = AspectSet::from_bits(rank_bits::<N>());
        let mut valid = self.last.is_valid()
            && self.last.bits() & !ranks.bits() == 0
            && self.accepted.without(ranks).is_empty()
            && self.dropped.without(self.accepted).is_empty()
            && self.credited.without(ranks).is_empty()
            && self.credited.and(self.accepted).is_empty();
        for rank in 0..N {
            let (run, age) = (self.run[rank], self.age[rank]);
            let accepted = self.accepted.bits() >> rank & 1 == 1;
            let dropped = self.dropped.bits() >> rank & 1 == 1;
            let credited = self.credited.bits() >> rank & 1 == 1;
            valid &= run <= times.operate;
            valid &= if accepted && age.0 == 0 {
                // Firm and heard: it took T5 cycles at least to get here.
                run >= times.shortened_operate && !dropped
            } else if accepted {
                // Lost: the run began after the loss, and would have been accepted if it were long enough.
                age < times.expiry
                    && run < age
                    && run < awaited(times, has_credit(times, run, age))
                    && (!dropped || age >= times.recovery)
            } else {
                age.0 == 0 && run < awaited(times, credited) && (!credited || run.0 > 0)
            };
        }
        // ACC-9: the lowest satisfied aspect is the last one displayed, or it may not be displayed for want of evidence.
        let lowest = Display::lowest_of(self.satisfied());
        let forbidden = lowest > self.last && self.evident(times).bits() < lowest.bits();
        valid && (lowest == Display::NOTHING || lowest == self.last || forbidden)
    }

    /// What is displayed in this state (T-ACC-8): the lowest satisfied aspect, if it is no rise above the last one.
    pub fn display(&self) -> Display {
        let lowest = Display::lowest_of(self.satisfied());
        if lowest <= self.last { lowest } else { Display::NOTHING }
    }

    /// The aspects that are satisfied: accepted (heard, in recovery or masked) and not dropped.
    pub fn satisfied(&self) -> AspectSet {
        self.accepted.without(self.dropped)
    }

    /// Cycles since `aspect` was lost, 0 if it is not lost; `None` for a rank from `N` on.
    pub fn age(&self, aspect: AspectId) -> Option<Ticks> {
        self.age.get(usize::from(aspect.rank())).copied()
    }

    /// Consecutive cycles in which `aspect` was heard, at most T1; `None` for a rank from `N` on.
    pub fn run(&self, aspect: AspectId) -> Option<Ticks> {
        self.run.get(usize::from(aspect.rank())).copied()
    }

    /// The state with these fields, valid or not.
    pub fn from_parts(parts: Parts<N>) -> Self {
        Self {
            run: parts.run.map(Ticks),
            age: parts.age.map(Ticks),
            accepted: AspectSet::from_bits(parts.accepted),
            dropped: AspectSet::from_bits(parts.dropped),
            credited: AspectSet::from_bits(parts.credited),
            last: Display::from_bits(parts.last),
        }
    }

    /// The fields of the state.
    pub fn parts(&self) -> Parts<N> {
        Parts {
            run: self.run.map(|ticks| ticks.0),
            age: self.age.map(|ticks| ticks.0),
            accepted: self.accepted.bits(),
            dropped: self.dropped.bits(),
            credited: self.credited.bits(),
            last: self.last.bits(),
        }
    }

    /// The aspects heard on T1 consecutive cycles up to now.
    fn evident(&self, times: Times) -> AspectSet {
        let mut set = 0;
        for rank in 0..N {
            set |= u16::from(self.run[rank] >= times.operate) << rank;
        }
        AspectSet::from_bits(set)
    }

    /// The accepted aspects that are heard or in recovery.
    fn firm(&self, times: Times) -> AspectSet {
        let mut set = 0;
        for rank in 0..N {
            set |= u16::from(self.age[rank] < times.recovery) << rank;
        }
        self.accepted.and(AspectSet::from_bits(set))
    }
}

/// One logic cycle: the aspects `detected` throughout it, and what is displayed from now on.
///
/// Within a cycle: runs and ages, then acceptances, then expiry, then drops, then the display.
pub fn step<const N: usize>(times: Times, state: State<N>, detected: AspectSet) -> (State<N>, Display) {
    //= spec/general.md#gen-2-total
    //# Every step MUST end without a panic, an overflow or an index out of bounds, from any state bits and on any input.
    let mut next = state;
    let mut accepted = 0;
    let mut dropped = 0;
    let mut credited = 0;
    for rank in 0..N {
        let bit = |bits: u16| bits >> rank & 1 == 1;
        let lane = advance(
            times,
            Lane {
                run: state.run[rank],
                age: state.age[rank],
                accepted: bit(state.accepted.bits()),
                dropped: bit(state.dropped.bits()),
                credited: bit(state.credited.bits()),
            },
            bit(detected.bits()),
        );
        next.run[rank] = lane.run;
        next.age[rank] = lane.age;
        accepted |= u16::from(lane.accepted) << rank;
        dropped |= u16::from(lane.dropped) << rank;
        credited |= u16::from(lane.credited) << rank;
    }
    next.accepted = AspectSet::from_bits(accepted);
    next.dropped = AspectSet::from_bits(dropped);
    next.credited = AspectSet::from_bits(credited);

    //= spec/aspect.md#acc-5-mask
    //# A masked aspect MUST be dropped when a lower aspect is firm.
    let contradicted = next.firm(times).above_lowest();
    //= spec/aspect.md#acc-7-mask-and-a-higher-aspect
    //# A masked aspect MUST be dropped when a higher aspect has been detected on T1 consecutive cycles up to now.
    let outdated = next.evident(times).below_highest();
    //= spec/aspect.md#acc-4-recovery
    //# A lost aspect MUST be satisfied while its age is below T2.
    let masked = next.accepted.without(next.firm(times));
    next.dropped = next.dropped.or(masked.and(contradicted.or(outdated)));

    //= spec/aspect.md#acc-2-lowest-wins
    //# Of the satisfied aspects the lowest MUST be the one to display.
    let lowest = Display::lowest_of(next.satisfied());
    //= spec/aspect.md#acc-9-no-rise-without-evidence
    //# The lowest satisfied aspect MUST be displayed only if it is not above the last displayed one or an aspect at or above it has been detected on T1 consecutive cycles up to now.
    let evidence = next.evident(times).bits() >= lowest.bits();
    //= spec/aspect.md#acc-3-nothing-satisfied
    //# When no aspect is satisfied, nothing MUST be displayed, and that means stop.
    let display = if lowest <= next.last || evidence { lowest } else { Display::NOTHING };
    if display != Display::NOTHING {
        next.last = display;
    }
    (next, display)
}

/// One rank of a state.
#[derive(Clone, Copy)]
struct Lane {
    run: Ticks,
    age: Ticks,
    accepted: bool,
    dropped: bool,
    credited: bool,
}

/// One rank, one cycle: its run and its age, then acceptance, then expiry. Nothing here looks at another rank.
/// Without a branch that depends on the signals: all ranks take the same path, and the compiler takes several at once.
#[inline]
#[expect(clippy::needless_bitwise_bool, reason = "a lazy operator is a branch")]
fn advance(times: Times, lane: Lane, heard: bool) -> Lane {
    let run = if !heard {
        Ticks(0)
    } else if lane.run < times.operate {
        Ticks(lane.run.0.saturating_add(1))
    } else {
        times.operate
    };
    let lost = lane.accepted & ((lane.age.0 > 0) | !heard);
    let age = if lost { Ticks(lane.age.0.saturating_add(1)) } else { Ticks(0) };
    let credited = heard & if lost { has_credit(times, run, age) } else { lane.credited };
    //= spec/aspect.md#acc-1-operate
    //# An aspect MUST be accepted when it has been detected on T1 consecutive cycles.
    //= spec/aspect.md#acc-8-shortened-operate
    //# A lost aspect that is detected again after g cycles, with g at most T4 and below T2+T3, MUST be accepted after T5 cycles of that detection.
    let accept = heard & (run >= awaited(times, credited));
    //= spec/aspect.md#acc-6-expiry
    //# A lost aspect MUST be gone at age T2+T3.
    let gone = lost & !accept & (age >= times.expiry);
    Lane {
        run,
        age: if lost & !gone & !accept { age } else { Ticks(0) },
        accepted: accept | (lane.accepted & !gone),
        dropped: lane.dropped & !gone & !accept,
        credited: credited & !accept & (!lost | gone),
    }
}

/// The run that is needed for acceptance: T5 with a credit, else T1.
fn awaited(times: Times, credited: bool) -> Ticks {
    if credited { times.shortened_operate } else { times.operate }
}

/// Whether a lost aspect of this run and age was re-detected within T4 of its loss.
fn has_credit(times: Times, run: Ticks, age: Ticks) -> bool {
    (run.0 > 0) & (age.0.saturating_sub(run.0) <= times.interruption.0)
}

/// A bit for each rank below `N`.
const fn rank_bits<const N: usize>() -> u16 {
    const { assert!(0 < N && N <= MAX_ASPECTS, "1 to 16 aspects") }
    u16::MAX >> (MAX_ASPECTS - N)
}

impl<const N: usize> Machine for Acceptance<N> {
    type State = State<N>;
    type Input = AspectSet;
    type Output = Display;

    const SAFE: Display = Display::NOTHING;

    fn initial(&self) -> State<N> {
        State::INITIAL
    }

    fn step(&self, state: State<N>, detected: AspectSet) -> (State<N>, Display) {
        step(self.times, state, detected)
    }
}
