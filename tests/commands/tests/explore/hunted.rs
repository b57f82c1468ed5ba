//! What the adversary finds is a film: what it says that the device read and answered is what the kernel reads and
//! answers, and its trains are where they are.

use atc_adversary::arsenal::Arsenal;
use atc_adversary::attacker::Attacker;
use atc_adversary::conditions::Measured;
use atc_adversary::hunt::{Find, Scenario};
use atc_adversary::judge::{Accident, Family};
use atc_adversary::world::World;
use atc_adversary::{device, stations, trace};
use atc_film::Class;
use atc_oracle::chart::{self, View};
use atc_oracle::film::{self, Setting};
use atc_oracle::trace::Replies;

/// An episode with every weapon, said to end in an accident. (There is none: it is the kernel as it is.)
fn episode(station: &str, seed: u64, cycles: i64) -> String {
    let description = stations::of(station);
    let (mut kernel, ground) = device::kernel(&description).expect("a sound layout");
    let mut attacker = Attacker::new(seed, Arsenal::ALL);
    let setting = attacker.setting(&ground);
    let mut world = World::new(&ground, setting);
    kernel.restart();
    let (mut moves, mut now) = (Vec::new(), Vec::new());
    while world.truth.now < cycles {
        now.clear();
        attacker.draw(&world, &mut now);
        moves.extend(now.iter().map(|it| (world.truth.now, *it)));
        world.cycle(&mut *kernel, &now, &[]);
    }
    // A restart would begin another case.
    moves.retain(|(_, it)| !matches!(it, atc_adversary::moves::Move::Restart));
    let accident = Accident { family: Family::Collision, cycle: cycles - 1, text: "said to be one".to_owned() };
    let scenario = Scenario { setting, moves };
    let find = Find { accident, after: 0, seed, scenario, measured: Measured::default() };
    trace::of(&mut *kernel, &ground, &description, &find).expect("a trace").to_string()
}

/// A station of 102 routes: its chart has a row for each circuit, and its film the drawing of its layout. The kernel in a page has no room for it.
#[test]
fn a_large_station_is_drawn() {
    let traced = film::read(&episode("central", 1, 300), None).expect("a trace");
    let recorded = &traced.trace.cases[0];
    let setting = Setting { words: traced.words.clone(), ..Setting::default() };
    let film = film::film(recorded, &setting).expect("the kernel answers as it did");
    assert_eq!((film.frames, film.plans[0].name.as_str()), (300, "Central"));
    assert!(film.plans[0].svg.contains("WSD") && film.events.iter().any(|event| event.class == Class::Output));
    let kernel = Setting { kernel: Some(vec![0]), ..setting };
    let refused = film::film(recorded, &kernel).expect_err("too large").to_string();
    assert!(refused.contains("small stations"), "{refused}");
    let chart = chart::svg(&traced.trace, Replies::MustAgree, &View::default()).expect("a chart");
    assert!(["WSD", "9W", "EL8"].iter().all(|circuit| chart.contains(circuit)) && !chart.contains("differs"));
}

#[test]
fn a_find_of_the_adversary_is_a_film() {
    let mut trains = 0;
    for (station, seed) in [("passing-loop", 1), ("passing-loop", 2), ("junction", 3)] {
        let traced = film::read(&episode(station, seed, 4_000), None).expect("a trace");
        let setting = Setting { title: traced.title.clone(), words: traced.words.clone(), ..Setting::default() };
        // Each answer is held against the kernel's.
        let film = film::film(&traced.trace.cases[0], &setting).unwrap_or_else(|error| panic!("{station}: {error}"));
        assert_eq!(film.frames, 4_000);
        let harm: Vec<_> = film.events.iter().filter(|event| event.class == Class::Harm).collect();
        assert_eq!((harm.len(), harm[0].at), (1, 3_999));
        assert_eq!(film.words[harm[0].text as usize], "harm: said to be one");
        assert!(film.trains.first().is_none_or(|name| name == "1"), "{:?}", film.trains);
        for name in &film.trains {
            for frame in (0..film.frames).step_by(7) {
                let word = |what: &str| film.word_at(("train", name, what), frame);
                let share = |what: &str| film.number_at(("train", name, what), frame);
                assert_eq!(word("on").is_empty(), word("place") != "here", "{name} in frame {frame}");
                if !word("on").is_empty() {
                    trains += 1;
                    assert!(
                        [share("front_share"), share("rear_share")]
                            .iter()
                            .all(|share| share.is_some_and(|at| (0..=1000).contains(&at)))
                    );
                }
            }
        }
    }
    assert!(trains > 300, "only {trains} frames with a train");
}
