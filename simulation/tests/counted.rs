//! A double track on which trains are counted: no single fault of the counting leads to harm, no train is reported free, and pairs that do are seen.

use std::path::Path;

use atc_kernel::interlocking::CircuitSet;
use atc_simulation::campaign::{Campaign, Cause, run, setting};
use atc_simulation::driver::Drivers;
use atc_simulation::event::What;
use atc_simulation::fault::{Extent, Kind};
use atc_simulation::line::Line;
use atc_simulation::onboard::Signal;
use atc_simulation::world::{Setting, World};

fn example() -> Line {
    Line::read(&Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/double-track.toml")).expect("a line")
}

fn campaign(runs: u64, kinds: &[Kind], signal: Signal) -> Campaign {
    Campaign {
        runs,
        causes: kinds.iter().copied().map(Cause::from).collect(),
        extent: Extent::Tolerated,
        faults: 1,
        trains: 8,
        seconds: 400,
        seed: 1,
        signal,
        drivers: Drivers::Heedless,
    }
}

fn arrivals(world: &World<'_>) -> usize {
    world.events.iter().filter(|event| matches!(event.what, What::Arrived { .. })).count()
}

/// The counted sections with a head in them, for each station that counts them.
fn heads(world: &World<'_>) -> Vec<(usize, usize)> {
    let mut all = Vec::new();
    for station in 0..world.stations.len() {
        let Some(counted) = world.line.counted_at(station) else { continue };
        let heads = world.trains.iter().map(|train| world.line.track.pieces[train.body.front().piece].circuit);
        let on = heads.filter(|circuit| counted.blocks.iter().flatten().any(|section| section == circuit));
        all.extend(on.map(|circuit| (station, circuit)));
    }
    all
}

/// Whether the counting of a station says that a section is free.
fn is_free(world: &World<'_>, station: usize, circuit: usize) -> bool {
    let number = world.line.track.sites[station].circuits.iter().position(|own| *own == circuit);
    !world.stations[station].reply.counted.meets(CircuitSet::nth(number.expect("both stations see it")))
}

#[test]
fn the_example_is_the_line_of_the_case() {
    let (read, made) = (example(), Line::double_track().expect("a line"));
    assert_eq!(read.ways, [[true, false], [false, true], [true, false], [false, true]]);
    let blocks = |line: &Line| line.counted.iter().map(|counted| counted.blocks.clone()).collect::<Vec<_>>();
    assert_eq!((blocks(&read), read.counted.len()), (blocks(&made), 1));
    let events = |line: &Line| {
        let mut world = World::new(line, Setting { trains: 6, ..Setting::default() }).expect("a world");
        world.run(300_000);
        world.events
    };
    assert_eq!(events(&read), events(&made));
}

/// No head is ever in a section that is reported free, in any cycle, and the trains get on.
#[test]
fn trains_are_counted_on_codes_and_on_telegrams() {
    let line = example();
    for signal in [Signal::Codes, Signal::Telegrams] {
        let mut world = World::new(&line, Setting { trains: 8, signal, ..Setting::default() }).expect("a world");
        let mut looked = 0;
        while world.now_ms < 1_800_000 && !world.is_unsafe {
            // Heads as they are when the ground reads, and what it says then.
            let (reads, before) = (world.now_ms.is_multiple_of(100), heads(&world));
            world.tick();
            let free = before.iter().filter(|(station, circuit)| is_free(&world, *station, *circuit)).count();
            assert!(
                !reads || free == 0,
                "{signal:?}: a head is in a section that counts as free at {} ms",
                world.now_ms
            );
            looked += if reads { before.len() } else { 0 };
        }
        assert!(!world.is_unsafe, "{:?}", world.events.last());
        assert!(looked > 5_000 && arrivals(&world) > 20, "{signal:?}: {looked}, {} arrivals", arrivals(&world));
    }
}

#[test]
fn no_single_fault_of_the_counting_leads_to_harm() {
    let line = example();
    for signal in [Signal::Codes, Signal::Telegrams, Signal::Both] {
        for (kind, outcome) in run(&line, &campaign(14, &Kind::COUNTING, signal), &|_| ()).expect("a campaign") {
            assert_eq!((outcome.runs, outcome.unsafe_runs), (2, 0), "{signal:?}, {kind}: {:?}", outcome.first);
            assert!(outcome.arrivals >= 6, "{signal:?}, {kind}: {} arrivals", outcome.arrivals);
        }
    }
}

/// Each of these faults alone is noticed: in a run with many of them a block disagrees, and staff bring it back into agreement.
#[test]
fn faults_of_the_counting_are_noticed_and_mended() {
    let line = example();
    for kind in Kind::COUNTING.into_iter().filter(|kind| *kind != Kind::WrongReset) {
        let campaign = Campaign { faults: 10, ..campaign(1, &[kind], Signal::Both) };
        let mut world = World::new(&line, setting(&line, &campaign, 0).1).expect("a world");
        let (mut lost, mut found, mut agreed) = (0, 0, false);
        while world.now_ms < 600_000 && !world.is_unsafe {
            world.tick();
            let agrees = world.stations[0].reply.agree == [true; 2];
            if world.now_ms > 60_000 && agrees != agreed {
                (lost, found) = (lost + u32::from(agreed), found + u32::from(agrees));
            }
            agreed = agrees;
        }
        assert!(!world.is_unsafe, "{kind:?}: {:?}", world.events.last());
        assert!(lost >= 1 && found >= 1, "{kind:?}: lost {lost} times, found {found} times");
    }
}

#[test]
fn what_is_wrong_with_a_counted_line_is_said() {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("counted");
    std::fs::create_dir_all(&folder).expect("a folder");
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/double-track.toml");
    let good = std::fs::read_to_string(path).expect("the example");
    let blocks = "blocks = [[\"L1E-2\", \"L1E-3\"], [\"L1E-4\", \"L1E-5\"]]";
    let counted = |blocks: &str| good.replace("blocks = [[\"L1E-2\", \"L1E-3\"], [\"L1E-4\", \"L1E-5\"]]", blocks);
    assert!(good.contains(blocks));
    let more = |line: &str, block: &str| format!("{good}\n[[counted]]\nline = \"{line}\"\nblocks = [[\"{block}\"]]\n");
    for (text, says) in [
        (good.replace("Line 1 E", "Line 9"), "[[counted]] Line 9: no line has this name"),
        (good.replace("double = true", "double = false").replace("Line 1 E", "Line 1"), "in both directions"),
        (counted("blocks = []"), "0 blocks: 1 or 2 are possible"),
        (counted("blocks = [[]]"), "a block of 0 sections: 1 to 16 are possible"),
        (counted("blocks = [[\"L1W-2\"]]"), "L1W-2 is none of its circuits"),
        (counted("blocks = [[\"L1E-3\", \"L1E-2\"]]"), "SectionsOutOfOrder"),
        (counted("blocks = [[\"L1E-1\", \"L1E-2\"]]"), "Station 1: HoldTooShortAtTheEntry"),
        (counted("blocks = [[\"L1E-6\", \"L1E-7\"]]"), "L1E-7 is counted, and Station 1 does not see it"),
        (more("Line 2 E", "L2E-2"), "Station 2: two [[counted]] lines; a device counts one"),
        (good.replace("[[counted]]", "[[count]]"), "unknown field `count`"),
    ] {
        let path = folder.join("line.toml");
        std::fs::write(&path, text).expect("a file");
        let told = Line::read(&path).expect_err(says);
        assert!(told.contains(says), "{told}\ninstead of\n{says}");
    }
}
