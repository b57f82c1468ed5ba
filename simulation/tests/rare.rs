//! Splitting: what it estimates is what is known in closed form, and what many runs find where they can.

use atc_simulation::fault::Kind;
use atc_simulation::generate::Shape;
use atc_simulation::line::Line;
use atc_simulation::rare::{Chance, LEVELS, Run};
use atc_simulation::splitting::{Estimate, Process, estimate};
use atc_simulation::world::Setting;
use rand::{Rng, SeedableRng};
use rand_pcg::Pcg64Mcg;

fn holds(estimate: &Estimate, known: f64) {
    let Estimate { probability, error, .. } = *estimate;
    assert!((probability - known).abs() < 4.0 * error, "{probability} ± {error}, known {known}");
    assert!(error < 0.15 * known, "{probability} ± {error} says little of {known}");
}

/// A walk to and fro from 1, up with the chance `up`, which ends at 0 and is to come to `to`.
#[derive(Clone)]
struct Walk {
    at: u32,
    to: u32,
    up: f64,
    random: Pcg64Mcg,
}

impl Process for Walk {
    fn step(&mut self) -> bool {
        if self.random.random_bool(self.up) {
            self.at += 1;
        } else {
            self.at -= 1;
        }
        self.at > 0
    }

    fn level(&self) -> f64 {
        f64::from(self.at) / f64::from(self.to)
    }

    fn reseed(&mut self, seed: u64) {
        self.random = Pcg64Mcg::seed_from_u64(seed);
    }
}

/// The ruin of a gambler: (1 − r) / (1 − rⁿ) with r = (1 − up) / up.
#[test]
fn a_gambler_wins_as_often_as_the_formula_says() {
    for (up, to) in [(0.3, 15), (0.4, 20), (0.49, 50)] {
        let ratio: f64 = (1.0 - up) / up;
        let known = (1.0 - ratio) / (1.0 - ratio.powi(to));
        let to = u32::try_from(to).expect("a small number");
        let start = Walk { at: 1, to, up, random: Pcg64Mcg::seed_from_u64(0) };
        let levels: Vec<f64> = (2..=to).map(|at| f64::from(at) / f64::from(to)).collect();
        holds(&estimate(&start, &levels, (400, 40), 1), known);
    }
}

/// Losses of shunt of one train, each of the same length, so many in that time on the average: for how long it is not reported.
#[derive(Clone)]
struct Losses {
    rate: f64,
    lost_until: f64,
    now: f64,
    whole: f64,
    random: Pcg64Mcg,
}

impl Process for Losses {
    fn step(&mut self) -> bool {
        let share: f64 = self.random.random();
        self.now -= (1.0 - share).ln() / self.rate;
        let joins = self.now <= self.lost_until;
        if joins {
            self.lost_until = self.now + 1.0;
        }
        joins
    }

    fn level(&self) -> f64 {
        self.lost_until / self.whole
    }

    fn reseed(&mut self, seed: u64) {
        self.random = Pcg64Mcg::seed_from_u64(seed);
    }
}

/// Two losses, or more, that join to one of `whole` times the length of each: 1 − e^(−rate) · (1 + rate · (whole − 1)), up to twice the
/// length. (The busy period of a queue with no waiting.)
#[test]
fn losses_join_as_often_as_the_formula_says() {
    for (rate, whole) in [(0.01, 1.9), (0.02, 1.99), (0.2, 1.5)] {
        let rate: f64 = rate;
        let known = 1.0 - (-rate).exp() * (1.0 + rate * (whole - 1.0));
        let start = Losses { rate, lost_until: 1.0, now: 0.0, whole, random: Pcg64Mcg::seed_from_u64(0) };
        let levels: Vec<f64> = (1..=10).map(|step| (1.0 + (whole - 1.0) * f64::from(step) / 10.0) / whole).collect();
        holds(&estimate(&start, &levels, (2_000, 40), 1), known);
    }
}

/// On a line where losses come so often that runs alone can count it: how often a train is not reported for as long as it takes to be
/// forgotten.
#[test]
fn a_line_loses_a_train_as_often_as_runs_of_it_do() {
    let line = Line::generate("Two", &Shape::loops(2, 3)).expect("a line");
    let chance = Chance { kinds: vec![Kind::ShuntLoss], per_hour: 3_000.0, from_ms: 60_000, end_ms: 120_000 };
    let start = Run::new(&line, Setting { trains: 2, ..Setting::default() }, &chance).expect("a run");
    let forgotten = |levels: &[f64], effort| estimate(&start, levels, effort, 1);
    let (split, plain) = (forgotten(&LEVELS[..6], (40, 10)), forgotten(&LEVELS[5..6], (40, 10)));
    let apart = (split.probability - plain.probability).abs();
    let error = split.error.hypot(plain.error);
    assert!(plain.probability > 0.02 && apart < 4.0 * error, "{split:?}\n{plain:?}");
}
