//! The adversary against the kernel: that it finds nothing, with every weapon and in ordinary running, and that it can be trusted.
//!
//! The kernel of November 22 had every fault of `known::KNOWN`. That each is found with the old rule put back, and not without, is a test of
//! the prover (`proofs/runner/tests/old_rules.rs`), which knows how to put it back. More cycles: the program `adversary` of this crate.

use std::process::Command;

use atc_adversary::arsenal::Arsenal;
use atc_adversary::conditions::broken;
use atc_adversary::hunt::{Hunt, hunt, minimise, replay};
use atc_adversary::judge::Family;
use atc_adversary::{altered, device, known, stations, words};
use atc_kernel::interlocking::{CircuitSet, Layout, Small};

/// With the weapons that were once enough for each known fault nothing is found in the kernel as it is.
#[test]
fn the_adversary_finds_no_known_fault() {
    for fault in known::KNOWN {
        let (mut kernel, ground) = device::kernel(&stations::of(fault.layout)).expect("a sound layout");
        let (find, tally) = hunt(&mut *kernel, &ground, &fault.hunt());
        assert_eq!(
            tally.discarded, 0,
            "{}: an accident under a broken condition is the adversary's own fault",
            fault.name
        );
        let told = find.as_ref().map(|find| words::tell(&mut *kernel, &ground, find));
        assert!(find.is_none(), "{}: {}\n{told:?}", fault.name, fault.must);
    }
}

/// With everything at once nothing happens on any station.
#[test]
fn all_weapons_on_every_station() {
    let descriptions = stations::NAMES.iter().map(|name| stations::of(name)).chain((1..=3).map(stations::random));
    for description in descriptions {
        let (mut kernel, ground) = device::kernel(&description).expect("a sound layout");
        let sought = Family::ALL.to_vec();
        let wanted = Hunt { seed: 1, cycles: 300_000, episode: known::EPISODE, arsenal: Arsenal::ALL, sought };
        let (find, tally) = hunt(&mut *kernel, &ground, &wanted);
        assert_eq!(tally.discarded, 0, "{}", ground.name);
        let told = find.as_ref().map(|find| {
            let small = minimise(&mut *kernel, &ground, find);
            words::tell(&mut *kernel, &ground, &small)
        });
        assert!(find.is_none(), "{}\n{told:?}", ground.name);
        assert!(tally.routes_set > 10 && tally.trains > 20, "{}: no traffic: {tally:?}", ground.name);
    }
}

/// A long track before a signal, where trains change ends. The drivers of the search go by the first signal ahead of them; with an approach that
/// is as long as a train brakes, as it was once, staff are struck (the twenty-first attack). So are they where a point lies between the end of a
/// route and the signal, and drivers do not keep to the reason that the file gives.
#[test]
fn trains_that_change_ends_far_behind_their_signal() {
    const FILE: &str = include_str!("../../../layout/tests/files/long-track.toml");
    let read = |text: &str| atc_layout::Description::from_toml("long-track.toml", text).expect("a layout");
    let wanted = |cycles: u64, seed: u64, sought: &[Family]| Hunt {
        seed,
        cycles,
        episode: known::EPISODE,
        arsenal: Arsenal::ALL,
        sought: sought.to_vec(),
    };
    let beyond = "[[route]]\nname = \"W-C\"\nentry = \"W1\"\npath = [\"P1T\", \"1A\", \"1B\", \"P2T\", \"1C\"]\n";
    let said = format!("{FILE}\n{beyond}no_reversal = \"engines are taken off there\"\n");
    for text in [FILE, &said] {
        let (mut kernel, ground) = device::kernel(&read(text)).expect("a sound layout");
        let (find, tally) = hunt(&mut *kernel, &ground, &wanted(600_000, 1, &Family::ALL));
        assert_eq!(find.map(|find| words::tell(&mut *kernel, &ground, &find)), None);
        assert!(tally.routes_set > 100 && tally.discarded == 0, "{tally:?}");
    }
    let staff = [Family::Worker];
    let compiled = read(FILE).compile_to::<8, 4, 4, 2, Small>().expect("a sound layout");
    let mut plan = *compiled.plan;
    for route in &mut plan.routes {
        route.approach = route.entry;
    }
    let mut kernel = device::of(Layout::new(plan).expect("the kernel knows no tracks"));
    let ground = device::kernel(&read(FILE)).expect("a sound layout").1;
    let (find, _) = hunt(&mut *kernel, &ground, &wanted(300_000, 1, &staff));
    assert!(find.is_some(), "an approach that is as long as a train brakes");
    let (mut kernel, mut ground) = device::kernel(&read(&said)).expect("a sound layout");
    for route in &mut ground.routes {
        route.reverses = true;
    }
    let (find, _) = hunt(&mut *kernel, &ground, &wanted(300_000, 1, &staff));
    assert!(find.is_some(), "a point between the end of a route and the signal");
}

/// A joint too near to a point: a train that stands clear of the point is in the way of one on its other leg. Trains strike each other where the plan
/// does not say so.
#[test]
fn trains_beside_each_other() {
    const FILE: &str = include_str!("../../../layout/tests/files/short-joint.toml");
    let description = atc_layout::Description::from_toml("short-joint.toml", FILE).expect("a layout");
    let wanted = |sought: &[Family]| Hunt {
        seed: 1,
        cycles: 700_000,
        episode: known::EPISODE,
        arsenal: Arsenal::ALL,
        sought: sought.to_vec(),
    };
    let (mut kernel, ground) = device::kernel(&description).expect("a sound layout");
    let (find, tally) = hunt(&mut *kernel, &ground, &wanted(&Family::ALL));
    assert_eq!(find.map(|find| words::tell(&mut *kernel, &ground, &find)), None);
    assert!(tally.routes_set > 100 && tally.discarded == 0, "{tally:?}");
    let mut plan = *description.compile_to::<8, 3, 2, 2, Small>().expect("a sound layout").plan;
    for route in &mut plan.routes {
        route.path.iter_mut().chain([&mut route.overlap]).for_each(|place| place.beside = CircuitSet::EMPTY);
    }
    let mut kernel = device::of(Layout::new(plan).expect("the kernel knows no tracks"));
    let (find, _) = hunt(&mut *kernel, &ground, &wanted(&[Family::Collision]));
    let told =
        find.map(|find| words::tell(&mut *kernel, &ground, &find)).expect("nothing is proved clear beside a path");
    assert!(told.contains("strike each other"), "{told}");
}

/// A file that was altered at random and breaks no rule is a station like any other. This attacks the rules of layouts. It is
/// no strong attack: `docs/attacked.md` has what it finds with rules left out, and what it does not.
#[test]
fn altered_files_that_break_no_rule() {
    for name in stations::NAMES {
        let attack = altered::attack(&stations::of(name), 12, 250, 4_000);
        let first = attack.finds.first().map(|(said, _, told)| format!("{said}\n{told}"));
        assert_eq!(first, None, "{name}");
        assert!(attack.accepted > 20 && attack.rejected > 100, "{name}: {} accepted", attack.accepted);
        assert!(attack.tally.routes_set > 50 && attack.tally.trains > 20, "{name}: no traffic: {:?}", attack.tally);
    }
}

/// A train that runs off the tracks is seen: here the line ends where it goes on.
#[test]
fn a_train_at_the_end_of_the_tracks_is_found() {
    let (mut kernel, mut ground) = device::kernel(&stations::of("passing-loop")).expect("a sound layout");
    for line in ground.lines.clone() {
        ground.joints[line.border].retain(|piece| *piece != line.piece);
    }
    let sought = vec![Family::End];
    let wanted = Hunt { seed: 7, cycles: 300_000, episode: known::EPISODE, arsenal: Arsenal::ALL, sought };
    let find = hunt(&mut *kernel, &ground, &wanted).0.expect("trains go out to the line");
    assert!(find.accident.text.contains("at the end of the tracks"), "{}", find.accident.text);
}

/// An imported station has faster trains and shorter circuits at its borders than one that was made for its line. There a train once came over
/// the border faster than it could stop in the one circuit that the neighbour had found clear (`neighbour-turns-alike`), on the terminus
/// after 203 481 cycles of this seed.
#[test]
fn imported_stations_with_all_weapons() {
    for (name, cycles) in
        [("terminus", 300_000), ("passing-loop", 100_000), ("junction", 100_000), ("station-30", 50_000)]
    {
        let (mut kernel, ground) = device::kernel(&stations::imported(name)).expect("a sound layout");
        let sought = Family::ALL.to_vec();
        let wanted = Hunt { seed: 41, cycles, episode: known::EPISODE, arsenal: Arsenal::ALL, sought };
        let (find, tally) = hunt(&mut *kernel, &ground, &wanted);
        assert_eq!(tally.discarded, 0, "{name}");
        let told = find.as_ref().map(|find| words::tell(&mut *kernel, &ground, find));
        assert_eq!(told, None, "{name}");
        assert!(tally.trains > 10, "{name}: no traffic: {tally:?}");
    }
}

/// The same on stations of a hundred routes, whose sets have more than one word: a plain ladder of 48 points and 77 circuits, and a junction
/// with scissors, double slips and calling-on routes.
#[test]
fn large_stations_with_all_weapons() {
    for (name, cycles) in stations::LARGE {
        let (mut kernel, ground) = device::kernel(&stations::of(name)).expect("a sound layout");
        let sought = Family::ALL.to_vec();
        let wanted = Hunt { seed: 7, cycles, episode: known::EPISODE, arsenal: Arsenal::ALL, sought };
        let (find, tally) = hunt(&mut *kernel, &ground, &wanted);
        let told = find.as_ref().map(|find| words::tell(&mut *kernel, &ground, find));
        assert_eq!(told, None, "{name}");
        assert!(tally.routes_set > 10 && tally.trains > 10, "{name}: no traffic: {tally:?}");
    }
}

/// In ordinary running, without any weapon, trains run and nothing happens to them: the ground itself makes no accident.
#[test]
fn ordinary_running_is_safe() {
    let sought = vec![Family::Collision, Family::Derailment, Family::Worker, Family::Authority, Family::Unasked];
    for name in stations::NAMES {
        let (mut kernel, ground) = device::kernel(&stations::of(name)).expect("a sound layout");
        let wanted = Hunt {
            seed: 7,
            cycles: 60_000,
            episode: known::EPISODE,
            arsenal: Arsenal::RUNNING,
            sought: sought.clone(),
        };
        let (find, tally) = hunt(&mut *kernel, &ground, &wanted);
        let told = find.map(|find| words::tell(&mut *kernel, &ground, &find));
        assert_eq!(told, None, "{name}");
        assert!(tally.routes_set > 10 && tally.trains > 20 && tally.metres > 3_000, "{name}: no traffic: {tally:?}");
    }
}

/// A find is a scenario: it happens again when it is played again, also made small; and one move less of that, it does not.
#[test]
fn a_small_scenario_is_needed_as_a_whole() {
    // The rule that trains look at the direction of travel is taken away: the adversary finds what it is there for.
    let fault = known::KNOWN.iter().find(|fault| fault.name == "telegram against the direction").expect("it is known");
    let (mut kernel, ground) = device::kernel(&stations::of(fault.layout)).expect("a sound layout");
    let sought = fault.ends_in.to_vec();
    let wanted = Hunt {
        seed: fault.seed,
        cycles: known::CYCLES,
        episode: known::EPISODE,
        arsenal: known::UNFACED,
        sought: sought.clone(),
    };
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

/// Two stations with a line between them: nothing is found in the kernel's two devices, and what is put in is.
#[test]
fn two_stations_and_what_is_put_in() {
    let hunt = |cycles: &str, wrong: &str| {
        let mut program = Command::new(env!("CARGO_BIN_EXE_two_stations"));
        let line = ["--passing", "yes", "--pairs", "1", "--seed", "1", "--cycles", cycles, "--wrong", wrong];
        let output = program.args(line).output().expect("it runs");
        (output.status.code(), String::from_utf8(output.stdout).expect("text"))
    };
    let (code, said) = hunt("300000", "none");
    assert!(code == Some(0) && said.contains("broken: 0") && !said.contains("crossings: 0"), "{said}");
    for (wrong, accident) in [("facing", "authority"), ("slides-late", "derailment"), ("loss", "worker")] {
        let (code, said) = hunt("300000", wrong);
        assert!(code == Some(1) && said.contains(accident), "{wrong}: {said}");
    }
}
