//! Trains that do not stop in time: they come to a stand in the overlap, as late as `overlap-covers-sliding` lets them.

use super::dice::Dice;
use super::ground::{Ground, Mask, bit};
use super::train::{Driver, Train};

/// A train that slides.
#[derive(Clone, Copy, Debug)]
struct Slide {
    train: usize,
    /// Where it comes to a stand, on its odometer.
    end: i64,
    /// The overlap over which it does.
    over: Mask,
    /// Its deceleration.
    brake: i64,
}

/// All of them.
#[derive(Clone, Debug, Default)]
pub struct Sliding {
    slides: Vec<Slide>,
    /// For how many cycles each train has been wholly in the last circuit of its route; it has stood there if this is negative.
    within: Vec<i64>,
    /// How many trains have slid.
    pub count: u64,
}

impl Sliding {
    /// The overlaps over which trains slide now.
    pub fn over(&self) -> Mask {
        self.slides.iter().fold(0, |all, slide| all | slide.over)
    }

    /// One cycle, after the drivers have decided: some trains run on for farther than they want.
    pub fn pass(
        &mut self,
        (ground, dice): (&Ground, &mut Dice),
        trains: &mut [Train],
        (overlaps, stands): (&[Vec<usize>], &[i64]),
    ) {
        for train in trains.iter_mut() {
            self.within.resize(self.within.len().max(train.number + 1), 0);
            let here = train.front_circuit(ground);
            if self.slides.iter().all(|slide| slide.train != train.number) {
                let Some(route) = train.route.filter(|route| ground.routes[*route].path.last() == Some(&here)) else {
                    self.within[train.number] = 0;
                    continue;
                };
                let within = &mut self.within[train.number];
                if train.under == bit(here) && *within >= 0 {
                    *within += 1;
                }
                if train.speed == 0 {
                    *within = -1;
                }
                let room: i64 = overlaps[route].iter().map(|circuit| ground.lengths[*circuit]).sum();
                let brakes = train.next < train.speed && train.authority == 0 && *within >= 0;
                let fits = train.driver == Driver::Telegrams && room > 0 && !train.slid && train.to_joint() < 250_000;
                if !(brakes && fits && dice.once_in(3)) {
                    continue;
                }
                let far = train.to_joint() + dice.within(1_000, room - 1_000);
                let lasts = 2 * far / train.speed * 1000 / ground.cycle_ms + 2;
                if *within + lasts > stands[route] {
                    continue;
                }
                let brake = (train.speed * train.speed / (2 * far)).max(1);
                let over = overlaps[route].iter().fold(0, |all, circuit| all | bit(*circuit));
                self.slides.push(Slide { train: train.number, end: train.run + far, over, brake });
                self.count += 1;
            }
            let Some(slide) = self.slides.iter().find(|slide| slide.train == train.number) else { continue };
            let left = slide.end - train.run - train.speed * ground.cycle_ms / 1000;
            let next = (2 * slide.brake * left.max(0)).isqrt().min(train.speed);
            let next = if next < 100 { 0 } else { next };
            train.next = next.max(if left > 0 { train.next.min(train.speed) } else { 0 });
            train.slid = true;
        }
        let stands = |slide: &Slide| {
            trains.iter().any(|train| train.number == slide.train && train.speed == 0 && train.next == 0)
        };
        self.slides.retain(|slide| !stands(slide));
    }
}
