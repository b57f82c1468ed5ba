//! Hunts for accidents of two stations with a line between them: two devices, one ground, trains that run from one to the other and back.
//!
//! `two_stations [--seed N] [--cycles N] [--pairs N] [--passing yes] [--meets yes] [--wrong NAME]`

use std::process::ExitCode;
use std::time::Instant;

use atc_adversary::arsenal::Arsenal;
use atc_adversary::attacker::Attacker;
use atc_adversary::between::Between;
use atc_adversary::conditions::broken;
use atc_adversary::device::Ask;
use atc_adversary::dice::Dice;
use atc_adversary::dispatcher::is_at_rest;
use atc_adversary::ground::{Ground, Mask, bit};
use atc_adversary::joined::{Joined, Place, join};
use atc_adversary::judge::{Accident, Family};
use atc_adversary::moves::Move;
use atc_adversary::pair::{Pair, Wrong};
use atc_adversary::sliding::Sliding;
use atc_adversary::world::World;

/// The cycles of an episode.
const EPISODE: i64 = 9_000;

/// Undoes the step from one episode's seed to the next.
const INVERSE: u64 = 0xC097_EF87_329E_28A5;

/// For how long nothing moves until an episode is over, besides turn and start.
const REST: i64 = 1_000;

/// The faults that can be put in, by name.
const WRONGS: [&str; 10] = [
    "none",
    "consent-always",
    "consent-old",
    "told-once",
    "unconfirmed",
    "without-record",
    "loss",
    "deaf",
    "facing",
    "slides-late",
];

struct Wanted {
    seed: u64,
    cycles: u64,
    pairs: u64,
    passing: bool,
    meets: bool,
    wrong: String,
    verbose: bool,
    episode: Option<u64>,
}

#[derive(Clone, Copy, Debug, Default)]
struct Tally {
    cycles: u64,
    episodes: u64,
    routes: u64,
    trains: u64,
    crossings: u64,
    restarts: u64,
    slides: u64,
    workers: u64,
    restrictions: u64,
    broken: u64,
}

/// The weapons of an episode: few of them let trains run, many stop them.
fn arsenal(dice: &mut Dice) -> Arsenal {
    let running = Arsenal { set: 8, line: 2, faces: true, slow_points: dice.once_in(2), ..Arsenal::RUNNING };
    match dice.below(5) {
        0 => {
            Arsenal { restart: 0, neighbour_work: 1, withdraw: 3, one: 2, many: 1, block: 2, point: 5, ..Arsenal::ALL }
        }
        1 => Arsenal { lose: 8, one: 2, withdraw: 2, pace: 3, ..running },
        2 => Arsenal { deaf: 8, withdraw: 4, point: 4, face: 2, ..running },
        3 => Arsenal { lose: 4, deaf: 4, many: 1, one: 1, blind: 1, ..running },
        _ => running,
    }
}

/// What is fixed for a pair of stations.
struct Scene<'a> {
    ground: &'a Ground,
    places: &'a [Place; 2],
    overlaps: Vec<Vec<usize>>,
    stands: Vec<i64>,
    line: Mask,
    wrong: &'a str,
    verbose: bool,
}

fn episode(
    scene: &Scene,
    pair: &mut Pair,
    seed: u64,
    sought: &[Family],
    tally: &mut Tally,
) -> Option<(Accident, Vec<(i64, Move)>)> {
    let ground = scene.ground;
    let mut between = Between::new(seed);
    let mut attacker = Attacker::new(seed, arsenal(&mut between.dice));
    let mut setting = attacker.setting(ground);
    setting.faces = scene.wrong != "facing";
    let mut world = World::new(ground, setting);
    pair.begin(seed);
    pair.lag = (between.dice.below(2), [0, 0, 20, 200][between.dice.below(4)]);
    pair.late = [0, 3, 12, 60][between.dice.below(4)];
    let mut sliding = Sliding::default();
    let (mut moves, mut story) = (Vec::new(), Vec::new());
    let mut rest = 0;
    let only = [0, 1].map(|at| pair.sees(at) & !pair.sees(1 - at));
    let mut found = None;
    while found.is_none() && world.truth.now < EPISODE && rest < REST + ground.turn {
        moves.clear();
        let now = world.truth.now;
        attacker.draw(&world, &mut moves);
        moves.retain(|it| !matches!(it, Move::Place(circuit, _) if scene.line & bit(*circuit) != 0));
        if now > 0 {
            let over = sliding.over();
            between.beside(&world, over, &mut moves);
            tally.restrictions += u64::from(between.staff(&world, scene.line, &mut moves));
            between.turns(scene.places, now, pair);
            tally.restarts += u64::from(between.restart(&mut world, scene.places, pair));
            between.disturb(pair, ground, scene.line);
        }
        // Quiet and disturbed times take turns, so that trains get into the places where it hurts.
        if now > 0 && now / between.period % 3 != 0 {
            let hurts = |it: &Move| {
                matches!(it, Move::Occupy(..) | Move::Blind(..) | Move::Command(_) | Move::NeighbourWork(..))
                    || matches!(it, Move::Ask(Ask::Withdraw(_) | Ask::Drive(..)))
                    || matches!(it, Move::Pace(_, pace) if *pace < 8_000)
            };
            moves.retain(|it| !hurts(it) || between.dice.once_in(40));
        }
        // The direction between the two is for `turns` alone; now and then somebody else meddles.
        let inner = scene.places.each_ref().map(|place| place.lines + place.inner);
        if !between.dice.once_in(40) {
            moves.retain(|it| !matches!(it, Move::Ask(Ask::Turn(line, _)) if inner.contains(line)));
        }
        if now > 0 {
            between.traffic((&world, scene.places), pair, &mut moves);
        }
        let mut sent = false;
        moves.retain(|it| !matches!(it, Move::Send(..)) || !std::mem::replace(&mut sent, true));
        // One command in a cycle.
        let mut commanded = false;
        moves.retain(|it| !matches!(it, Move::Command(_)) || !std::mem::replace(&mut commanded, true));
        // Nobody steps on what is unblocked in this cycle.
        if moves.iter().any(|it| matches!(it, Move::Command(given) if given.unblock != 0)) {
            moves.retain(|it| !matches!(it, Move::Work(_, true)));
        }
        // While a station reads its record nothing else is commanded.
        if now > 0 && !(pair.is_up(0) && pair.is_up(1)) {
            moves.retain(|it| !matches!(it, Move::Command(_)));
        }
        if scene.verbose {
            story.extend(moves.iter().map(|it| (now, *it)));
        }
        let workers = world.truth.workers;
        // A train that slides keeps no limit of what it slides over.
        let keeps = sliding.over() == 0;
        let limits = |family: &Family| matches!(family, Family::Speed | Family::Restriction);
        let judged: Vec<Family> = sought.iter().copied().filter(|it| keeps || !limits(it)).collect();
        found = world.cycle(pair, &moves, &judged);
        tally.workers += u64::from((world.truth.workers & !workers).count_ones());
        if between.slides || scene.wrong == "slides-late" {
            let before = sliding.count;
            sliding.pass((ground, &mut between.dice), &mut world.trains, (&scene.overlaps, &scene.stands));
            tally.slides += sliding.count - before;
        }
        tally.crossings += between.crossings(&world, only);
        tally.routes += u64::from(world.has_set());
        tally.cycles += 1;
        rest = if is_at_rest(&world) && now > ground.start { rest + 1 } else { 0 };
    }
    tally.episodes += 1;
    tally.trains += u64::try_from(world.arrived()).unwrap_or(0);
    let found = found?;
    let conditions = broken(ground, &world.measured);
    if scene.wrong == "none" && !conditions.is_empty() {
        tally.broken += 1;
        return None;
    }
    for train in &world.trains {
        println!(
            "    train {}: {:?} {} m, at {}, {} mm/s, route {:?}, heard {:?}",
            train.number,
            train.driver,
            train.length / 1000,
            ground.named(train.under),
            train.speed,
            train.route.map(|route| &ground.routes[route].name),
            train.heard
        );
    }
    Some((found, story))
}

fn wrong_of(name: &str) -> Wrong {
    match name {
        "consent-always" => Wrong::ConsentAlways,
        "consent-old" => Wrong::ConsentOld(15),
        "told-once" => Wrong::ToldOnce,
        "unconfirmed" => Wrong::Unconfirmed,
        "without-record" => Wrong::WithoutRecord,
        _ => Wrong::Nothing,
    }
}

fn hunt(wanted: &Wanted, number: u64, tally: &mut Tally) -> Result<bool, String> {
    let random = |add: u64| (!wanted.passing).then(|| (wanted.seed * 1_000 + number * 2 + add) % 100_000);
    let mut joined: Joined = join([random(0), random(1)], wanted.meets, true)?;
    match wanted.wrong.as_str() {
        "loss" => joined.ground.loss = joined.ground.clear + 2,
        "deaf" => joined.ground.life *= 20,
        _ => {}
    }
    let (ground, places) = (joined.ground.clone(), joined.places.clone());
    let overlaps: Vec<Vec<usize>> = places.iter().flat_map(|place| place.overlaps.clone()).collect();
    let late = if wanted.wrong == "slides-late" { 2_000 } else { 0 };
    let stands = places.iter().flat_map(|place| vec![place.standstill + late; place.route_count]).collect();
    let line = places.iter().fold(0, |all, place| all | ground.lines[place.lines + place.inner].mask);
    let scene = Scene {
        ground: &ground,
        places: &places,
        overlaps,
        stands,
        line,
        wrong: &wanted.wrong,
        verbose: wanted.verbose,
    };
    let mut pair = Pair::new(joined, number ^ wanted.seed, wrong_of(&wanted.wrong));
    let sought: Vec<Family> = Family::ALL.to_vec();
    let before = tally.cycles;
    let mut seed = wanted.seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) ^ number;
    if let Some(only) = wanted.episode {
        // The seed before this one.
        seed = only.wrapping_sub(0x1405_7B7E_F767_814F).wrapping_mul(INVERSE);
    }
    while tally.cycles - before < wanted.cycles {
        seed = seed.wrapping_mul(0x5851_F42D_4C95_7F2D).wrapping_add(0x1405_7B7E_F767_814F);
        if let Some((accident, story)) = episode(&scene, &mut pair, seed, &sought, tally) {
            println!(
                "  {}: pair {number}, episode seed {seed:#x}, cycle {} of it, {} in all: {}",
                accident.family.name(),
                accident.cycle,
                tally.cycles,
                accident.text
            );
            let commanded = |it: &Move| matches!(it, Move::Command(_) | Move::Restart);
            for (cycle, it) in story.iter().filter(|(cycle, it)| *cycle > accident.cycle - 400 || commanded(it)) {
                println!("    {cycle}: {}", it.words(&ground));
            }
            return Ok(true);
        }
    }
    if pair.twice.get() > 0 {
        println!("  pair {number}: two devices spoke for one direction in {} telegrams", pair.twice.get());
    }
    Ok(false)
}

fn wanted() -> Result<Wanted, String> {
    let mut wanted = Wanted {
        seed: 1,
        cycles: 200_000,
        pairs: 10,
        passing: false,
        meets: false,
        wrong: "none".to_owned(),
        verbose: false,
        episode: None,
    };
    let mut words = std::env::args().skip(1);
    while let Some(option) = words.next() {
        let value = words.next().ok_or_else(|| format!("{option} needs a value"))?;
        let number = || value.parse::<u64>().map_err(|_| format!("{option}: {value} is no number"));
        match option.as_str() {
            "--seed" => wanted.seed = number()?,
            "--cycles" => wanted.cycles = number()?,
            "--pairs" => wanted.pairs = number()?,
            "--passing" => wanted.passing = value == "yes",
            "--meets" => wanted.meets = value == "yes",
            "--episode" => {
                let digits = value.trim_start_matches("0x");
                wanted.episode =
                    Some(u64::from_str_radix(digits, 16).map_err(|_| format!("{option}: {value} is no seed"))?);
            }
            "--verbose" => wanted.verbose = value == "yes",
            "--wrong" if WRONGS.contains(&value.as_str()) => wanted.wrong = value,
            "--wrong" => return Err(format!("--wrong: {value} is none of {}", WRONGS.join(", "))),
            _ => return Err(format!("there is no option {option}")),
        }
    }
    Ok(wanted)
}

fn main() -> ExitCode {
    let wanted = match wanted() {
        Ok(wanted) => wanted,
        Err(error) => {
            eprintln!("two_stations: {error}");
            return ExitCode::from(2);
        }
    };
    let (start, mut tally, mut accidents) = (Instant::now(), Tally::default(), 0);
    for number in 0..wanted.pairs {
        match hunt(&wanted, number, &mut tally) {
            Ok(found) => accidents += u64::from(found),
            Err(error) => println!("  pair {number} is left out: {}", error.lines().next().unwrap_or("")),
        }
    }
    println!("{tally:?}, {:.0} s; {accidents} accidents", start.elapsed().as_secs_f64());
    if accidents > 0 { ExitCode::FAILURE } else { ExitCode::SUCCESS }
}
