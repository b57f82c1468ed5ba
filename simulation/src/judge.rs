//! Ground truth: whether trains share ground, and how near they came to what they must not reach. It looks at bodies and
//! tracks, and at what the ground told the trains; never into a device.

use crate::driver::Drivers;
use crate::event::What;
use crate::train::Margins;
use crate::world::World;

/// By how much a train may be faster than the track allows, in m/s: a speed is measured in tenths of km/h, and a brake takes its time. What a train
/// of heedless drivers gains in that time is on top.
const OVER: f64 = 1.0 / 3.6;

/// How far a train looks for another one, in m.
pub const SIGHT_M: f64 = 3_000.0;

impl World<'_> {
    /// Looks for trains that are faster than the track under any part of them allows.
    pub(crate) fn judge_speeds(&mut self) {
        let line = self.line;
        let gained =
            line.dynamics.acceleration * f64::from(line.dynamics.brake_delay_ms + line.train_cycle_ms) / 1000.0;
        let over = if self.setting.drivers == Drivers::Careful { OVER } else { OVER + gained };
        for number in 0..self.trains.len() {
            let body = &self.trains[number].body;
            let broken = body.legs.iter().find(|leg| body.speed > line.limit(leg) + over);
            let (before, circuit) =
                (self.trains[number].too_fast, broken.map(|leg| line.track.pieces[leg.piece].circuit));
            self.trains[number].too_fast = circuit.is_some();
            if let (Some(circuit), false) = (circuit, before) {
                let (circuit, kmh) = (line.track.circuits[circuit].name.clone(), self.trains[number].body.speed * 3.6);
                self.tell(What::Overspeed { train: number, circuit, kmh });
            }
        }
    }

    /// Looks for trains that share ground.
    pub(crate) fn judge(&mut self) {
        let track = &self.line.track;
        for (number, train) in self.trains.iter().enumerate() {
            let piece = train.body.front().piece;
            let it = &track.pieces[piece];
            let crowded = if it.plain { self.on_piece[piece] > 1 } else { self.on_circuit[it.circuit] > 1 };
            if !crowded {
                continue;
            }
            let touches = |other: &crate::train::Train| {
                if it.plain {
                    let (mine, its) = (train.body.on(track, piece), other.body.on(track, piece));
                    mine.zip(its).is_some_and(|(mine, its)| mine.0 < its.1 && its.0 < mine.1)
                } else {
                    // In the circuit of a point there is no room for two.
                    other.body.legs.iter().any(|leg| track.pieces[leg.piece].circuit == it.circuit)
                }
            };
            let mut others = self.trains.iter().enumerate().filter(|(at, _)| *at != number);
            if let Some((with, _)) = others.find(|(_, other)| touches(other)) {
                let circuit = track.circuits[it.circuit].name.clone();
                return self.tell(What::Collision { train: number, with, circuit });
            }
        }
    }

    /// Measures how near a moving train is to its stop point and to the next train.
    pub(crate) fn measure(&mut self, number: usize) {
        let track = &self.line.track;
        let train = &self.trains[number];
        let speed = train.body.speed;
        if speed <= 0.0 {
            return;
        }
        let now = self.now_ms;
        let age = u64::from(self.line.telegram_age_ms);
        let granted = |circuit: usize| train.told_ms[circuit] > 0 && now <= train.told_ms[circuit] + age;
        let leg = train.body.front();
        let (mut piece, mut exit) = (leg.piece, leg.exit);
        let mut ahead_m = train.body.to_joint_m(track);
        let (mut stop_m, mut train_m) = (None, f64::INFINITY);
        // The one ahead in the same piece.
        for (at, other) in self.trains.iter().enumerate() {
            if at == number || self.on_piece[piece] < 2 {
                continue;
            }
            if let Some((mine, its)) = train.body.on(track, piece).zip(other.body.on(track, piece)) {
                train_m = train_m.min(if its.0 >= mine.1 { its.0 - mine.1 } else { mine.0 - its.1 }.max(0.0));
            }
        }
        while ahead_m < SIGHT_M {
            let Some(next) = track.across(exit, piece) else { break };
            let lie = track.pieces[next].point.map_or(Some(false), |point| self.points[point].lie());
            let (out, needs) = track.leave(next, exit, lie.unwrap_or(false));
            let right = needs.is_none_or(|(_, reverse)| lie == Some(reverse));
            if stop_m.is_none() && !granted(track.pieces[next].circuit) {
                stop_m = Some(ahead_m);
            }
            if self.on_piece[next] > 0 && train_m.is_infinite() {
                let gap = |other: &crate::train::Train| {
                    let (from, to) = other.body.on(track, next)?;
                    let length = track.pieces[next].length_m;
                    Some(if track.pieces[next].joints[0] == exit { from } else { length - to })
                };
                let others = self.trains.iter().enumerate().filter(|(at, _)| *at != number);
                let nearest = others.filter_map(|(_, other)| gap(other)).fold(f64::INFINITY, f64::min);
                train_m = ahead_m + nearest;
            }
            if stop_m.is_some() && (train_m.is_finite() || !right) {
                break;
            }
            if !right {
                stop_m = stop_m.or(Some(ahead_m));
                break;
            }
            ahead_m += track.pieces[next].length_m;
            (piece, exit) = (next, out);
        }
        let stop_m = stop_m.unwrap_or(ahead_m);
        let pattern_m = stop_m - speed * speed / (2.0 * self.line.counted_brake());
        let train = &mut self.trains[number];
        train.margins = train.margins.or_less(Margins { stop_m, pattern_m, train_m });
    }
}
