//! T-ACC-5 and T-ACC-6: two runs of the machine side by side, and the relation between them.

use super::{Asked, BOUND, HEARD, any_parts, any_set, any_times, has, satisfied};
use crate::{ASPECTS, Engine};
use atc_kernel::aspect::{AspectSet, Parts, State, step};

/// Whether every aspect that is satisfied in `one` and not in `other` has a witness in `other`: a satisfied aspect
/// of smaller age, lower than it (or at most `up_to`).
fn witnessed<const N: usize>(one: &Parts<N>, other: &Parts<N>, up_to: Option<usize>) -> bool {
    let mut all = true;
    for rank in 0..N {
        if has(satisfied(one) & !satisfied(other), rank) {
            let mut some = false;
            for witness in 0..N {
                let low = witness < rank || up_to.is_some_and(|bound| witness <= bound);
                some |= low && has(satisfied(other), witness) && other.age[witness] < one.age[rank];
            }
            all &= some;
        }
    }
    all
}

/// How a device and its conventional counterpart go together.
fn not_less_safe<const N: usize>(new: &Parts<N>, conventional: &Parts<N>) -> bool {
    let mut related = witnessed(conventional, new, None);
    for rank in 0..N {
        related &= new.run[rank] == conventional.run[rank];
        related &=
            !has(conventional.accepted, rank) || has(new.accepted, rank) && new.age[rank] <= conventional.age[rank];
    }
    related
}

harness! {
    /// Never less safe than the conventional device: where that shows something, the new one never shows higher.
    t_acc_5(e)
    theorem "T-ACC-5";
    requirements ["ACC-8", "ACC-9"];
    assumptions ["detected-throughout"];
    built_in HEARD;
    bound BOUND;
    cases 1;
    unwind 33 = 1 + crate::aspect::LONGEST;
    claims {
        NotHigher: "where the conventional device shows an aspect, the new one does not show a higher one",
        Related: "the relation between the two devices is kept",
        Start: "the relation holds in the initial state",
    }
    covers {
        Same: "both show the same aspect",
        Lower: "the new device shows a lower aspect",
        Longer: "the new device shows an aspect and the conventional one nothing",
    }
    {
        let Some(asked) = any_times(e) else { return };
        let ordinary = asked.times.conventional();
        let new = any_parts::<ASPECTS, E>(e, &asked);
        let old = any_counterpart(e, &new, &asked);
        let (new_state, old_state) = (State::from_parts(new), State::from_parts(old));
        e.assume(new_state.is_valid(asked.times) && old_state.is_valid(ordinary));
        e.assume(not_less_safe(&new, &old));
        let detected = any_set::<ASPECTS, E>(e);

        let (new, new_display) = step(asked.times, new_state, detected);
        let (old, old_display) = step(ordinary, old_state, detected);
        let (new_shows, old_shows) = (new_display.bits(), old_display.bits());
        e.claim(Claim::NotHigher as u32, old_shows == 0 || new_shows <= old_shows);
        e.claim(Claim::Related as u32, not_less_safe(&new.parts(), &old.parts()));
        let initial = State::<ASPECTS>::INITIAL.parts();
        e.claim(Claim::Start as u32, not_less_safe(&initial, &initial));
        e.cover(Cover::Same as u32, old_shows != 0 && new_shows == old_shows);
        e.cover(Cover::Lower as u32, new_shows != 0 && new_shows < old_shows);
        e.cover(Cover::Longer as u32, old_shows == 0 && new_shows != 0);
    }
}

/// How a run with more detections of the aspect `extra` goes with the run without them.
fn more_heard<const N: usize>(asked: &Asked, plain: &Parts<N>, more: &Parts<N>, extra: usize) -> bool {
    let mut related = witnessed(plain, more, Some(extra));
    for rank in 0..N {
        let accepted = (has(plain.accepted, rank), has(more.accepted, rank));
        let run = (plain.run[rank], more.run[rank]);
        let age = (plain.age[rank], more.age[rank]);
        if rank == extra {
            let credit = |accepted: bool, credited: u16, run: u16, age: u16| {
                if accepted {
                    age > 0 && run > 0 && u32::from(age) <= u32::from(asked.interruption) + u32::from(run)
                } else {
                    has(credited, extra)
                }
            };
            let firm = accepted.1 && age.1 == 0;
            related &= run.0 <= run.1 && (!accepted.0 || accepted.1 && age.1 <= age.0);
            related &= !credit(accepted.0, plain.credited, run.0, age.0)
                || firm
                || credit(accepted.1, more.credited, run.1, age.1);
        } else {
            related &= run.0 == run.1 && age.0 == age.1 && accepted.0 == accepted.1;
            related &= has(plain.credited, rank) == has(more.credited, rank);
            related &= !has(plain.dropped, rank) || has(more.dropped, rank);
        }
    }
    related && more.last <= plain.last.max(1 << extra)
}

harness! {
    /// Adding detections of one aspect, at any cycles, never makes the display exceed the higher of that aspect and
    /// the display without them.
    t_acc_6(e)
    theorem "T-ACC-6";
    requirements ["ACC-2", "ACC-7", "ACC-8", "ACC-9"];
    assumptions ["detected-throughout"];
    built_in HEARD;
    bound BOUND;
    cases ASPECTS;
    unwind 33 = 1 + crate::aspect::LONGEST;
    claims {
        Bounded: "the display with the added detections is at most the higher of the added aspect and the display without them",
        Related: "the relation between the two runs is kept",
        Start: "the relation holds in the initial state",
    }
    covers {
        Added: "the added aspect is displayed, and nothing without it",
        Raised: "the added detections drop a masked aspect, and the display rises",
        Silenced: "the added detections put the display out",
    }
    {
        let Some(asked) = any_times(e) else { return };
        let extra = e.choose("rank of the added aspect", ASPECTS);
        let plain = any_parts::<ASPECTS, E>(e, &asked);
        let more = any_counterpart(e, &plain, &asked);
        let (plain_state, more_state) = (State::from_parts(plain), State::from_parts(more));
        e.assume(plain_state.is_valid(asked.times) && more_state.is_valid(asked.times));
        e.assume(more_heard(&asked, &plain, &more, extra));
        let detected = any_set::<ASPECTS, E>(e);
        let added = if e.word("the extra aspect is heard (odd: yes)", 0..=1) & 1 == 1 { 1 << extra } else { 0 };

        let (plain, display) = step(asked.times, plain_state, detected);
        let (more, display_more) = step(asked.times, more_state, AspectSet::from_bits(detected.bits() | added));
        let (shows, shows_more) = (display.bits(), display_more.bits());
        e.claim(Claim::Bounded as u32, shows_more <= shows.max(1 << extra));
        e.claim(Claim::Related as u32, more_heard(&asked, &plain.parts(), &more.parts(), extra));
        let initial = State::<ASPECTS>::INITIAL.parts();
        e.claim(Claim::Start as u32, more_heard(&asked, &initial, &initial, extra));
        e.cover(Cover::Added as u32, shows == 0 && shows_more == 1 << extra);
        e.cover(Cover::Raised as u32, shows != 0 && shows_more > shows);
        e.cover(Cover::Silenced as u32, shows != 0 && shows_more == 0);
    }
}

/// An arbitrary second state; for testers, likely close to `parts`.
fn any_counterpart<const N: usize, E: Engine + ?Sized>(e: &mut E, parts: &Parts<N>, asked: &Asked) -> Parts<N> {
    let near = |value: u16| value..=value;
    let accepted = e.word("second device: accepted (bits)", near(parts.accepted));
    let dropped = e.word("second device: dropped (bits)", near(parts.dropped));
    let credited = e.word("second device: credited (bits)", near(parts.credited));
    let last = e.word("second device: displayed last (bit)", near(parts.last));
    let mut other = Parts { run: [0; N], age: [0; N], accepted, dropped, credited, last };
    for rank in 0..N {
        let top = if has(accepted, rank) { asked.expiry } else { 0 };
        other.age[rank] =
            e.word("second device: age, rank by rank", parts.age[rank].min(top)..=parts.age[rank].min(top));
        other.run[rank] = e.word("second device: run, rank by rank", near(parts.run[rank]));
    }
    other
}
