//! Each contract, said once more in plain arithmetic of 128 bits: where a function breaks its contract, or the contract is not what the
//! sources say, this is noticed without a prover.

use atc_arithmetic::{ENERGY_END, Quotient, divide_down, divide_up, energy, lowest_member, part, root};
use proptest::prelude::*;

/// The numbers at which something changes: 0, 1, the powers of two and what is beside them, and the constants of the functions.
fn limits() -> Vec<u32> {
    let powers = (0..32).flat_map(|bit| [(1_u32 << bit) - 1, 1 << bit, (1 << bit) + 1]);
    let constants =
        [10, 324, 60_000, 6_472_691, 6_472_692, ENERGY_END - 2, ENERGY_END - 1, ENERGY_END, u32::MAX - 1, u32::MAX];
    let mut all: Vec<u32> = powers.chain(constants).collect();
    all.sort_unstable();
    all.dedup();
    all
}

/// The sources, and each contract in them. What is tried below is this list in plain arithmetic: a contract that is changed in the
/// sources alone makes `the_contracts_are_those_that_are_tried_here` fail.
const CONTRACTS: &[(&str, &[&str])] = &[
    (
        include_str!("../src/rounding.rs"),
        &[
            "requires(divisor@ > 0)",
            "ensures(result@ * divisor@ >= dividend@)",
            "ensures((result@ - 1) * divisor@ < dividend@)",
            "requires(divisor@ > 0)",
            "ensures(result@ * divisor@ <= dividend@)",
            "ensures((result@ + 1) * divisor@ > dividend@)",
        ],
    ),
    (
        include_str!("../src/energy.rs"),
        &[
            "ensures(result@ < 2_097_152_000 && result@ <= 324 * deceleration@ * distance@)",
            "ensures(result@ == 2_097_151_999 || result@ == 324 * deceleration@ * distance@)",
            "requires(energy@ < 2_097_152_000)",
            "ensures(125 * result@ * result@ <= energy@)",
            "ensures(energy@ < 125 * (result@ + 1) * (result@ + 1))",
        ],
    ),
    (
        include_str!("../src/quotient.rs"),
        &[
            "requires(over@ <= rise@ && 1 <= rise@ && rise@ < 131_072 && whole@ <= 2048)",
            "ensures(result@ * rise@ <= over@ * whole@)",
            "ensures(over@ * whole@ < (result@ + 1) * rise@)",
            "requires(self.quotient@ + half@ <= 4096 && half@ <= 2048 && rise@ < 131_072)",
            "requires(self.product@ == self.quotient@ * rise@)",
            "ensures(if self.product@ + half@ * rise@ <= dividend@ { \
             result.quotient@ == self.quotient@ + half@ && result.product@ == self.product@ + half@ * rise@ \
             } else { result == self })",
        ],
    ),
    (
        include_str!("../src/members.rs"),
        &["ensures(match result { \
             Some(rank) => rank@ < members@.len() && members@[rank@] \
             && (forall<i> 0 <= i && i < rank@ ==> !members@[i]), \
             None => forall<i> 0 <= i && i < members@.len() ==> !members@[i], })"],
    ),
];

/// What stands between `cfg_attr(creusot, ` and its end, on one line; invariants left out, which no caller sees.
fn contracts(source: &str) -> Vec<String> {
    let spaced = source.split_whitespace().collect::<Vec<_>>().join(" ");
    let all =
        spaced.split("cfg_attr(creusot, ").skip(1).map(|rest| rest.split(")]").next().unwrap_or_default().to_owned());
    all.filter(|contract| !contract.starts_with("invariant(")).collect()
}

#[test]
fn the_contracts_are_those_that_are_tried_here() {
    for (source, expected) in CONTRACTS {
        assert_eq!(contracts(source), *expected);
    }
}

fn wide(number: impl Into<i128>) -> i128 {
    number.into()
}

fn rounding(dividend: u32, divisor: u32) {
    let (n, d) = (wide(dividend), wide(divisor));
    let (up, down) = (wide(divide_up(dividend, divisor)), wide(divide_down(dividend, divisor)));
    assert!(up * d >= n && (up - 1) * d < n, "{n} / {d} up: {up}");
    assert!(down * d <= n && (down + 1) * d > n, "{n} / {d} down: {down}");
}

fn energies(deceleration: u16, distance: u16) {
    let (found, exact) = (wide(energy(deceleration, distance)), 324 * wide(deceleration) * wide(distance));
    assert!(found < 2_097_152_000 && found <= exact, "324 · {deceleration} · {distance}: {found}");
    assert!(found == 2_097_151_999 || found == exact, "324 · {deceleration} · {distance}: {found}");
}

fn roots(energy: u32) {
    assert!(energy < 2_097_152_000);
    let (n, r) = (wide(energy), wide(root(energy)));
    assert!(125 * r * r <= n && n < 125 * (r + 1) * (r + 1), "root of {n}: {r}");
}

fn parts(over: u32, rise: u32, whole: u32) {
    assert!(over <= rise && (1..131_072).contains(&rise) && whole <= 2048);
    let (found, rise, product) = (wide(part(over, rise, whole)), wide(rise), wide(over) * wide(whole));
    assert!(found * rise <= product && product < (found + 1) * rise, "{over} of {rise} of {whole}: {found}");
}

fn digits(quotient: u32, half: u32, rise: u32, dividend: u32) {
    assert!(quotient + half <= 4096 && half <= 2048 && rise < 131_072);
    let before = Quotient { quotient, product: quotient * rise };
    let after = before.digit(half, rise, dividend);
    let (worth, product) = (wide(half) * wide(rise), wide(quotient) * wide(rise));
    if product + worth <= wide(dividend) {
        assert!(
            wide(after.quotient) == wide(quotient) + wide(half) && wide(after.product) == product + worth,
            "{after:?}"
        );
    } else {
        assert_eq!(after, before);
    }
}

fn members(flags: &[bool]) {
    match lowest_member(flags) {
        Some(rank) => assert!(rank < flags.len() && flags[rank] && flags[..rank].iter().all(|member| !member)),
        None => assert!(flags.iter().all(|member| !member)),
    }
}

#[test]
fn rounding_at_the_limits() {
    for dividend in limits() {
        for divisor in limits().into_iter().filter(|divisor| *divisor > 0) {
            rounding(dividend, divisor);
        }
    }
}

#[test]
fn energy_at_the_limits() {
    let limits: Vec<u16> = limits().into_iter().filter_map(|number| u16::try_from(number).ok()).collect();
    for deceleration in &limits {
        for distance in &limits {
            energies(*deceleration, *distance);
            // The last distance whose energy is exact, and the next one.
            for over in [2_097_151_999, 2_097_152_000, 2_097_152_000 + 324] {
                let last = over / 324 / u32::from(*deceleration).max(1);
                let Ok(last) = u16::try_from(last) else { continue };
                (last.saturating_sub(1)..=last.saturating_add(1))
                    .for_each(|distance| energies(*deceleration, distance));
            }
        }
    }
}

#[test]
fn every_root_at_its_squares() {
    for r in 0..4096_u32 {
        let square = 125 * r * r;
        [square.saturating_sub(1), square, square + 1].into_iter().filter(|n| *n < ENERGY_END).for_each(roots);
    }
    roots(ENERGY_END - 1);
    assert_eq!((ENERGY_END, root(ENERGY_END - 1)), (125 * 4096 * 4096, 4095));
}

#[test]
fn parts_at_the_limits() {
    let rises: Vec<u32> = limits().into_iter().filter(|rise| (1..131_072).contains(rise)).collect();
    for rise in &rises {
        let near = rises.iter().flat_map(|over| [*over, rise.saturating_sub(*over)]);
        for over in near.chain([0]).filter(|over| over <= rise) {
            for whole in limits().into_iter().filter(|whole| *whole <= 2048) {
                parts(over, *rise, whole);
            }
        }
    }
}

#[test]
fn digits_at_the_limits() {
    let small: Vec<u32> = limits().into_iter().filter(|number| *number <= 4096).collect();
    for quotient in &small {
        for half in small.iter().filter(|half| **half <= 2048 && quotient + **half <= 4096) {
            for rise in [0, 1, 2, 3, 1000, 65_535, 131_071] {
                let product = (quotient + half) * rise;
                for dividend in [0, product.saturating_sub(1), product, product + 1, u32::MAX] {
                    digits(*quotient, *half, rise, dividend);
                }
            }
        }
    }
}

#[test]
fn every_set_of_up_to_ten() {
    for length in 0..=10 {
        for bits in 0..1_u32 << length {
            members(&(0..length).map(|rank| bits >> rank & 1 == 1).collect::<Vec<_>>());
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 4096, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn rounding_of_drawn_numbers(dividend: u32, divisor in 1_u32.., small in 1_u32..100_000) {
        rounding(dividend, divisor);
        rounding(dividend, small);
    }

    #[test]
    fn energy_of_drawn_numbers(deceleration: u16, distance: u16, brake in 1_u16..4096) {
        energies(deceleration, distance);
        energies(brake, distance);
    }

    #[test]
    fn root_of_drawn_numbers(energy in 0..ENERGY_END) {
        roots(energy);
    }

    #[test]
    fn part_of_drawn_numbers((rise, over) in (1_u32..131_072).prop_flat_map(|rise| (Just(rise), 0..=rise)), whole in 0_u32..=2048) {
        parts(over, rise, whole);
    }

    #[test]
    fn digit_of_drawn_numbers(quotient in 0_u32..=2048, half in 0_u32..=2048, rise in 0_u32..131_072, near in -1_i64..=1, dividend: u32) {
        digits(quotient, half, rise, dividend);
        let limit = i64::from((quotient + half) * rise) + near;
        digits(quotient, half, rise, u32::try_from(limit).unwrap_or_default());
    }

    #[test]
    fn lowest_of_drawn_sets(flags in prop::collection::vec(prop::bool::weighted(0.1), 0..100)) {
        members(&flags);
    }
}
