//! Aspect acceptance: theorems T-ACC-1 to T-ACC-8.
//!
//! Every harness is one inductive step. The state is any valid one, the times are any valid ones (conventional ones
//! included), the input is any set of aspects. Where a theorem speaks of the past, the harness carries a ghost and
//! proves that the ghost and the state go together from the initial state on.

mod bound;
mod carry;
mod compare;
mod display;
mod evidence;
mod gap;
mod table;

use crate::{ASPECTS, Engine, Harness};
use atc_kernel::aspect::{Acceptance, AspectSet, Display, MAX_ASPECTS, Parts, State, Times, step};
use atc_kernel::time::Ticks;

pub use bound::{t_acc_2, t_acc_3, t_acc_7};
pub use carry::{carry_away, carry_idle};
pub use compare::{t_acc_5, t_acc_6};
pub use display::{set_1, t_acc_8, total};
pub use evidence::{t_acc_1, t_acc_1_rise};
pub use gap::{t_acc_4, t_acc_4_alone, t_acc_4_tolerated};
pub use table::{table_names, time_table};

/// The harnesses of this module.
#[cfg(not(chosen))]
pub const ALL: &[Harness] = &[
    t_acc_1::HARNESS,
    t_acc_1_rise::HARNESS,
    t_acc_2::HARNESS,
    t_acc_3::HARNESS,
    t_acc_4::HARNESS,
    t_acc_4_alone::HARNESS,
    t_acc_4_tolerated::HARNESS,
    t_acc_5::HARNESS,
    t_acc_6::HARNESS,
    t_acc_7::HARNESS,
    t_acc_8::HARNESS,
    carry_away::HARNESS,
    carry_idle::HARNESS,
    time_table::HARNESS,
    table_names::HARNESS,
    set_1::HARNESS,
    total::HARNESS,
];

/// The longest loop: two arrays of a 16-bit number for each aspect are compared byte by byte.
pub(crate) const LONGEST: usize = 2 * MAX_ASPECTS;

/// What is heard of an aspect in a cycle.
pub(crate) const HEARD: &[(&str, &str)] =
    &[("detected-throughout", "an aspect is heard in a cycle or it is not: none is heard for a part of one")];

/// What the harnesses of size [`ASPECTS`] say of their bound.
pub(crate) const BOUND: &str = crate::bound(ASPECTS);

/// Arbitrary valid times, and T4 as it was asked for (the machine may cap it).
#[derive(Clone, Copy)]
struct Asked {
    times: Times,
    operate: u16,
    recovery: u16,
    /// T2 + T3.
    expiry: u16,
    /// T4, not capped.
    interruption: u16,
    shortened: u16,
}

fn any_times<E: Engine + ?Sized>(e: &mut E) -> Option<Asked> {
    let operate = e.word("T1 (cycles)", 2..=5);
    let recovery = e.word("T2 (cycles)", 1..=5);
    let mask = e.word("T3 (cycles)", 0..=5);
    let interruption = e.word("T4 (cycles)", 0..=11);
    let shortened = e.word("T5 (cycles)", 1..=operate.saturating_sub(1).max(1));
    let conventional = e.word("conventional device (odd: yes)", 0..=1) & 1 == 1;
    let Ok(times) =
        Times::from_ticks(Ticks(operate), Ticks(recovery), Ticks(mask), Ticks(interruption), Ticks(shortened))
    else {
        e.assume(false);
        return None;
    };
    // The constructor has checked that the sum does not overflow.
    let expiry = recovery.wrapping_add(mask);
    Some(if conventional {
        Asked { times: times.conventional(), operate, recovery, expiry, interruption, shortened: operate }
    } else {
        Asked { times, operate, recovery, expiry, interruption, shortened }
    })
}

/// An arbitrary set of aspects below rank `N`.
fn any_set<const N: usize, E: Engine + ?Sized>(e: &mut E) -> AspectSet {
    AspectSet::from_bits(e.word("detected (bits)", 0..=ranks::<N>()))
}

/// An arbitrary state, valid or not.
fn any_parts<const N: usize, E: Engine + ?Sized>(e: &mut E, asked: &Asked) -> Parts<N> {
    let accepted = e.word("accepted (bits)", 0..=ranks::<N>());
    let dropped = e.word("dropped (bits)", 0..=accepted);
    let credited = e.word("credited (bits)", 0..=ranks::<N>() & !accepted);
    let last = e.word("displayed last (bit)", 0..=ranks::<N>());
    let mut parts = Parts { run: [0; N], age: [0; N], accepted, dropped, credited, last };
    for rank in 0..N {
        let is_accepted = has(accepted, rank);
        parts.age[rank] = e.word("age, rank by rank", 0..=if is_accepted { asked.expiry } else { 0 });
        parts.run[rank] = e.word(
            "run, rank by rank",
            if is_accepted && parts.age[rank] == 0 {
                asked.shortened..=asked.operate
            } else if is_accepted {
                0..=parts.age[rank].saturating_sub(1).min(asked.operate)
            } else {
                0..=asked.operate.saturating_sub(1)
            },
        );
    }
    parts
}

/// One cycle of the machine from an arbitrary valid state: the fields before and after, and the display.
#[derive(Clone, Copy)]
struct Cycle<const N: usize> {
    asked: Asked,
    before: Parts<N>,
    detected: u16,
    after: Parts<N>,
    next: State<N>,
    display: Display,
}

fn any_cycle<const N: usize, E: Engine + ?Sized>(e: &mut E) -> Option<Cycle<N>> {
    let asked = any_times(e)?;
    let before = any_parts(e, &asked);
    let state = State::from_parts(before);
    e.assume(state.is_valid(asked.times));
    let detected = any_set::<N, E>(e);
    let (next, display) = step(asked.times, state, detected);
    Some(Cycle { asked, before, detected: detected.bits() & ranks::<N>(), after: next.parts(), next, display })
}

/// A machine with arbitrary times in an arbitrary valid state, for the two channels.
pub(crate) fn any_machine_state<const N: usize, E: Engine + ?Sized>(e: &mut E) -> Option<(Acceptance<N>, State<N>)> {
    let asked = any_times(e)?;
    let state = State::from_parts(any_parts(e, &asked));
    e.assume(state.is_valid(asked.times));
    Some((Acceptance { times: asked.times }, state))
}

/// One rank of a state.
#[derive(Clone, Copy, PartialEq, Eq)]
struct Lane {
    run: u16,
    age: u16,
    accepted: bool,
    dropped: bool,
    credited: bool,
}

/// An arbitrary rank below `N`.
fn any_rank<const N: usize, E: Engine + ?Sized>(e: &mut E) -> usize {
    let rank = e.word("rank looked at", 0..=u16::try_from(N).unwrap_or(1) - 1);
    let below = usize::from(rank) < N;
    e.assume(below);
    // A tester goes on after a broken assumption.
    if below { usize::from(rank) } else { 0 }
}

/// The lane of `rank`. A loop and a comparison in place of an index: see the proof guide in `proofs/README.md`.
fn lane<const N: usize>(parts: &Parts<N>, rank: usize) -> Lane {
    let mut found = Lane { run: 0, age: 0, accepted: false, dropped: false, credited: false };
    for place in 0..N {
        if place == rank {
            found = Lane {
                run: parts.run[place],
                age: parts.age[place],
                accepted: has(parts.accepted, place),
                dropped: has(parts.dropped, place),
                credited: has(parts.credited, place),
            };
        }
    }
    found
}

/// `function::<RANK>(arguments)` for the `RANK` that is `rank`, each one a constant, so that the rest of the state is easy.
macro_rules! at_each_rank {
    ($rank:expr, $otherwise:expr, $function:ident($($argument:expr),*)) => {
        at_each_rank!(@ $rank, $otherwise, $function, ($($argument),*), 0 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15)
    };
    (@ $rank:expr, $otherwise:expr, $function:ident, $arguments:tt, $($constant:literal)*) => {
        match $rank {
            $($constant => at_each_rank!(= $function::<$constant>, $arguments),)*
            _ => $otherwise,
        }
    };
    (= $function:ident::<$constant:literal>, ($($argument:expr),*)) => { $function::<$constant>($($argument),*) };
}
use at_each_rank;

/// Whether two states are the same, field by field. (`==` on arrays compiles to a loop over bytes, which no prover likes.)
pub(crate) fn same<const N: usize>(one: &Parts<N>, other: &Parts<N>) -> bool {
    let mut same = one.accepted == other.accepted
        && one.dropped == other.dropped
        && one.credited == other.credited
        && one.last == other.last;
    for rank in 0..N {
        same &= one.run[rank] == other.run[rank] && one.age[rank] == other.age[rank];
    }
    same
}

/// Whether a set of bits has `rank`.
fn has(set: u16, rank: usize) -> bool {
    set >> rank & 1 == 1
}

/// All ranks below `N`.
fn ranks<const N: usize>() -> u16 {
    u16::MAX >> (16 - N)
}

/// The satisfied aspects, from the fields.
fn satisfied<const N: usize>(parts: &Parts<N>) -> u16 {
    parts.accepted & !parts.dropped
}

/// The lowest of a set as a set of one, found the slow way.
fn lowest(set: u16) -> u16 {
    let mut found = 0;
    for rank in (0..16).rev() {
        if has(set, rank) {
            found = 1 << rank;
        }
    }
    found
}

/// Whether some aspect of the set is at or above the aspect `one` (a set of one).
fn at_or_above(set: u16, one: u16) -> bool {
    let mut found = false;
    let mut passed = false;
    for rank in 0..16 {
        passed |= has(one, rank);
        found |= passed && has(set, rank);
    }
    found
}

/// The aspects heard on T1 consecutive cycles up to now, from the runs before and what is detected now.
fn evident<const N: usize>(cycle: &Cycle<N>) -> u16 {
    evident_after(&cycle.asked, &cycle.before, cycle.detected)
}

fn evident_after<const N: usize>(asked: &Asked, before: &Parts<N>, detected: u16) -> u16 {
    let mut set = 0;
    for rank in 0..N {
        let run = if has(detected, rank) { u32::from(before.run[rank]) + 1 } else { 0 };
        set |= u16::from(run >= u32::from(asked.operate)) << rank;
    }
    set
}
