//! The hunt: episode after episode until an accident, and the scenario made as small as it gets.

use super::arsenal::Arsenal;
use super::attacker::Attacker;
use super::conditions::{Measured, broken};
use super::device::Device;
use super::dispatcher::is_at_rest;
use super::ground::Ground;
use super::judge::{Accident, Family};
use super::moves::Move;
use super::world::{Setting, World};

/// How to hunt.
#[derive(Clone, Debug)]
pub struct Hunt {
    /// The seed.
    pub seed: u64,
    /// The cycles to spend.
    pub cycles: u64,
    /// The cycles of an episode.
    pub episode: i64,
    /// What to draw from.
    pub arsenal: Arsenal,
    /// What to look for.
    pub sought: Vec<Family>,
}

/// A scenario: what is fixed, and what happens when.
#[derive(Clone, Debug)]
pub struct Scenario {
    /// What is fixed.
    pub setting: Setting,
    /// The moves, each with its cycle.
    pub moves: Vec<(i64, Move)>,
}

/// How long nothing moves in an episode, besides the turn time, and once the time after a start is over.
const REST: i64 = 1000;

/// An accident and how it came about.
#[derive(Clone, Debug)]
pub struct Find {
    /// The accident.
    pub accident: Accident,
    /// The cycles that the hunt had run until then.
    pub after: u64,
    /// The seed of the episode.
    pub seed: u64,
    /// The scenario.
    pub scenario: Scenario,
    /// What was measured in it.
    pub measured: Measured,
}

/// What a hunt has done.
#[derive(Clone, Copy, Debug, Default)]
pub struct Tally {
    /// The cycles that were run.
    pub cycles: u64,
    /// The episodes.
    pub episodes: u64,
    /// Routes that were set, and trains that there were: a hunt without traffic finds nothing.
    pub routes_set: u64,
    /// The trains.
    pub trains: u64,
    /// The metres that they ran.
    pub metres: i64,
    /// The accidents that did not count because a condition was broken.
    pub discarded: u64,
}

/// Hunts. The first accident under all conditions, not yet made small.
pub fn hunt(device: &mut dyn Device, ground: &Ground, hunt: &Hunt) -> (Option<Find>, Tally) {
    let mut tally = Tally::default();
    let mut seed = hunt.seed;
    while tally.cycles < hunt.cycles {
        seed = seed.wrapping_mul(0x5851_F42D_4C95_7F2D).wrapping_add(0x1405_7B7E_F767_814F);
        let mut attacker = Attacker::new(seed, hunt.arsenal);
        let setting = attacker.setting(ground);
        let mut world = World::new(ground, setting);
        device.restart();
        let (mut moves, mut now) = (Vec::new(), Vec::new());
        let mut accident = None;
        let mut rest = 0;
        // An episode in which nothing has moved for longer than anything takes is over.
        while accident.is_none() && world.truth.now < hunt.episode && rest < REST + ground.turn {
            now.clear();
            attacker.draw(&world, &mut now);
            moves.extend(now.iter().map(|it| (world.truth.now, *it)));
            accident = world.cycle(device, &now, &hunt.sought);
            tally.cycles += 1;
            tally.routes_set += u64::from(world.has_set());
            rest = if is_at_rest(&world) && world.truth.now > ground.start { rest + 1 } else { 0 };
        }
        tally.episodes += 1;
        tally.trains += u64::try_from(world.arrived()).unwrap_or(0);
        tally.metres += world.trains.iter().map(|train| train.run / 1000).sum::<i64>();
        let Some(accident) = accident else { continue };
        if broken(ground, &world.measured).is_empty() {
            let scenario = Scenario { setting, moves };
            let measured = world.measured;
            return (Some(Find { accident, after: tally.cycles, seed, scenario, measured }), tally);
        }
        tally.discarded += 1;
    }
    (None, tally)
}

/// Runs a scenario: the first accident, and what was measured.
pub fn replay(
    device: &mut dyn Device,
    ground: &Ground,
    scenario: &Scenario,
    (sought, last): (&[Family], i64),
) -> (Option<Accident>, Measured) {
    let mut world = World::new(ground, scenario.setting);
    device.restart();
    let mut at = 0;
    while world.truth.now <= last {
        let from = at;
        while scenario.moves.get(at).is_some_and(|(cycle, _)| *cycle == world.truth.now) {
            at += 1;
        }
        let moves: Vec<Move> = scenario.moves[from..at].iter().map(|(_, it)| *it).collect();
        let accident = world.cycle(device, &moves, sought);
        if accident.is_some() {
            return (accident, world.measured);
        }
    }
    (None, world.measured)
}

/// Takes moves out of the scenario, and makes what lasts shorter, while an accident of the same family remains.
pub fn minimise(device: &mut dyn Device, ground: &Ground, find: &Find) -> Find {
    let mut best = find.clone();
    let sought = [find.accident.family];
    let mut attempt = |best: &mut Find, moves: Vec<(i64, Move)>| {
        let scenario = Scenario { setting: best.scenario.setting, moves };
        let (accident, measured) = replay(device, ground, &scenario, (&sought, best.accident.cycle + 50));
        let Some(accident) = accident.filter(|_| broken(ground, &measured).is_empty()) else { return false };
        *best = Find { accident, scenario, measured, ..best.clone() };
        true
    };
    let mut part = best.scenario.moves.len().div_ceil(2).max(1);
    loop {
        let mut at = 0;
        let mut shorter = false;
        while at < best.scenario.moves.len() {
            let mut moves = best.scenario.moves.clone();
            moves.drain(at..(at + part).min(moves.len()));
            if attempt(&mut best, moves) {
                shorter = true;
            } else {
                at += part;
            }
        }
        if part == 1 && !shorter {
            break;
        }
        part = (part / 2).max(1);
    }
    simplify(&mut best, &mut attempt);
    best
}

/// What lasts is made to last a cycle, sets are made smaller.
fn simplify(best: &mut Find, attempt: &mut impl FnMut(&mut Find, Vec<(i64, Move)>) -> bool) {
    for at in 0..best.scenario.moves.len() {
        let (cycle, it) = best.scenario.moves[at];
        if let Move::Occupy(mask, lasts) = it {
            let mut mask = mask;
            for circuit in super::ground::members(mask) {
                let less = mask & !super::ground::bit(circuit);
                let mut moves = best.scenario.moves.clone();
                moves[at] = (cycle, Move::Occupy(less, lasts));
                if less != 0 && attempt(best, moves) {
                    mask = less;
                }
            }
            for shorter in [1, 2, 3, lasts / 8, lasts / 2] {
                let mut moves = best.scenario.moves.clone();
                moves[at] = (cycle, Move::Occupy(mask, shorter.max(1)));
                if shorter < lasts && attempt(best, moves) {
                    break;
                }
            }
        }
    }
}
