//! T-ACC-5 and T-ACC-6 on the machine of 16 aspects, along random histories: they are proven for four.

use atc_kernel::aspect::{AspectSet, Display, State, Times, step};
use atc_kernel::time::Ticks;
use proptest::prelude::*;

fn times() -> impl Strategy<Value = Times> {
    (2..7_u16, 1..7_u16, 0..7_u16, 0..14_u16, 1..6_u16).prop_filter_map("valid times", |(t1, t2, t3, t4, t5)| {
        Times::from_ticks(Ticks(t1), Ticks(t2), Ticks(t3), Ticks(t4), Ticks(t5)).ok()
    })
}

/// Detections that last: each aspect goes on or off now and then, so that acceptances, losses and masks happen.
fn history() -> impl Strategy<Value = Vec<AspectSet>> {
    let flips = prop::collection::vec((any::<u16>(), any::<u16>(), any::<u16>()), 1..400);
    flips.prop_map(|flips| {
        let mut heard = 0_u16;
        flips
            .into_iter()
            .map(|(a, b, c)| {
                // One aspect in eight changes.
                heard ^= a & b & c;
                AspectSet::from_bits(heard)
            })
            .collect()
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(600))]

    #[test]
    fn never_above_the_conventional_device_of_16_aspects(times in times(), history in history()) {
        let (mut new, mut old) = (State::<16>::INITIAL, State::<16>::INITIAL);
        for detected in history {
            let (next, display) = step(times, new, detected);
            let (ordinary, conventional) = step(times.conventional(), old, detected);
            prop_assert!(next.is_valid(times));
            prop_assert!(conventional == Display::NOTHING || display <= conventional);
            (new, old) = (next, ordinary);
        }
    }

    #[test]
    fn one_more_aspect_heard_raises_16_aspects_to_it_at_most(
        times in times(),
        history in history(),
        extra in 0..16_u16,
        when in prop::collection::vec(prop::bool::weighted(0.6), 400),
    ) {
        let (mut plain, mut more) = (State::<16>::INITIAL, State::<16>::INITIAL);
        for (detected, added) in history.into_iter().zip(when) {
            let heard = AspectSet::from_bits(detected.bits() | u16::from(added) << extra);
            let (next, display) = step(times, plain, detected);
            let (next_more, display_more) = step(times, more, heard);
            prop_assert!(display_more.bits() <= display.bits().max(1 << extra));
            (plain, more) = (next, next_more);
        }
    }
}
