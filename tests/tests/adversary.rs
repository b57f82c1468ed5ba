//! The adversary against the kernel: what it finds today, that it finds nothing in ordinary running, and that it can be trusted.
//!
//! **Inverted once the rules are mended**: `known::MENDED` is the one line to change. Until then the kernel of November 22 has every fault
//! of `known::KNOWN`, and an adversary that misses one of them is broken. More cycles: the program `adversary` of this crate.

use atc_tests::adversary::arsenal::Arsenal;
use atc_tests::adversary::conditions::broken;
use atc_tests::adversary::hunt::{Hunt, hunt, minimise, replay};
use atc_tests::adversary::judge::Family;
use atc_tests::adversary::{device, known, stations, words};

/// The faults whose sessions are of trains that move: the on-board part and availability have tests of their own.
#[test]
fn the_adversary_finds_what_it_should() {
    for fault in known::KNOWN {
        let (mut kernel, ground) = device::kernel(&stations::of(fault.layout)).expect("a sound layout");
        let wanted = Hunt {
            seed: fault.seed,
            cycles: 150_000,
            episode: 3000,
            arsenal: fault.arsenal,
            sought: fault.ends_in.to_vec(),
        };
        let (find, tally) = hunt(&mut *kernel, &ground, &wanted);
        assert_eq!(
            tally.discarded, 0,
            "{}: an accident under a broken condition is the adversary's own fault",
            fault.name
        );
        let told = find.as_ref().map(|find| words::tell(&mut *kernel, &ground, find));
        assert_eq!(find.is_some(), !known::MENDED, "{}: {}\n{told:?}", fault.name, fault.must);
    }
}

/// With everything at once; while there are faults, it finds some on every station of `layouts/`.
#[test]
fn all_weapons_on_every_station() {
    let descriptions = stations::NAMES.iter().map(|name| stations::of(name)).chain((1..=3).map(stations::random));
    for description in descriptions {
        let (mut kernel, ground) = device::kernel(&description).expect("a sound layout");
        let wanted =
            Hunt { seed: 1, cycles: 300_000, episode: 3000, arsenal: Arsenal::ALL, sought: Family::ALL.to_vec() };
        let (find, tally) = hunt(&mut *kernel, &ground, &wanted);
        assert_eq!(tally.discarded, 0, "{}", ground.name);
        let told = find.as_ref().map(|find| words::tell(&mut *kernel, &ground, find));
        // So few cycles need not find a fault on a random station; once mended, none is found anywhere.
        let must_find = !known::MENDED && !ground.name.starts_with("Random");
        assert!(find.is_some() || !must_find, "{}: nothing found", ground.name);
        assert!(find.is_none() || !known::MENDED, "{}\n{told:?}", ground.name);
    }
}

/// In ordinary running, without any weapon, trains run and nothing happens to them: the ground itself makes no accident.
#[test]
fn ordinary_running_is_safe() {
    let sought = vec![Family::Collision, Family::Derailment, Family::Worker, Family::Authority, Family::Unasked];
    for name in stations::NAMES {
        let (mut kernel, ground) = device::kernel(&stations::of(name)).expect("a sound layout");
        let wanted = Hunt { seed: 7, cycles: 60_000, episode: 3000, arsenal: Arsenal::RUNNING, sought: sought.clone() };
        let (find, tally) = hunt(&mut *kernel, &ground, &wanted);
        let told = find.map(|find| words::tell(&mut *kernel, &ground, &find));
        assert_eq!(told, None, "{name}");
        assert!(tally.routes_set > 10 && tally.trains > 20 && tally.metres > 3_000, "{name}: no traffic: {tally:?}");
    }
}

/// A find is a scenario: it happens again when it is played again, also made small; and one move less of that, it does not.
#[test]
fn a_small_scenario_is_needed_as_a_whole() {
    if known::MENDED {
        return;
    }
    let fault = known::KNOWN.iter().find(|fault| fault.name == "withdrawn route grants again").expect("it is listed");
    let (mut kernel, ground) = device::kernel(&stations::of(fault.layout)).expect("a sound layout");
    let sought = fault.ends_in.to_vec();
    let wanted =
        Hunt { seed: fault.seed, cycles: 150_000, episode: 3000, arsenal: fault.arsenal, sought: sought.clone() };
    let find = hunt(&mut *kernel, &ground, &wanted).0.expect("the fault is there");
    let again = replay(&mut *kernel, &ground, &find.scenario, (&sought, find.accident.cycle)).0;
    assert_eq!(again.as_ref(), Some(&find.accident), "the same scenario, the same accident");
    let small = minimise(&mut *kernel, &ground, &find);
    assert!(small.scenario.moves.len() < find.scenario.moves.len());
    assert!(broken(&ground, &small.measured).is_empty());
    for left_out in 0..small.scenario.moves.len() {
        let mut less = small.scenario.clone();
        less.moves.remove(left_out);
        let (accident, _) = replay(&mut *kernel, &ground, &less, (&sought, small.accident.cycle));
        assert_eq!(accident, None, "move {left_out} is not needed");
    }
}
