//! A cycle of a train: what it hears, what its device makes of it, and how it moves.

use atc_kernel::heading::Heading;
use atc_kernel::speed::RawKmhTenths;
use atc_kernel::supervision::Brake;
use atc_kernel::wayside::Transmission;

use crate::bound::Bound;
use crate::driver::{Sight, drive};
use crate::event::What;
use crate::fault::{Fault, Kind};
use crate::motion::Crossed;
use crate::onboard::{FRAME_MS, Met, Signal};
use crate::sizes::Circuits;
use crate::world::World;

/// The speed as it is measured: tenths of km/h, to nearest.
#[allow(clippy::cast_possible_truncation, reason = "a cast from float saturates")]
fn measured(speed: f64) -> RawKmhTenths {
    RawKmhTenths((speed * 36.0).round() as i32)
}

impl World<'_> {
    /// What the rail says at the front of a train.
    pub(crate) fn listen(&mut self, number: usize) {
        let track = &self.line.track;
        let train = &self.trains[number];
        let leg = train.body.front();
        let circuit = track.pieces[leg.piece].circuit;
        let (mut sent, mut told) = (None::<u8>, None);
        for (station, local) in self.local.iter().enumerate() {
            let Some(here) = local[circuit] else { continue };
            let faces = track.heading(station, leg.piece, leg.exit);
            let (code, movement) = self.stations[station].code(usize::from(here), faces);
            // Two that speak at once would be heard as the lower one.
            sent = match (sent, code) {
                (Some(one), Some(other)) => Some(one.min(other)),
                (one, other) => one.or(other),
            };
            told = told.or(movement.map(|movement| (station, movement)));
        }
        let now = self.now_ms + 1;
        let train = &mut self.trains[number];
        train.told_ms[circuit] = now;
        if let Some((station, movement)) = told {
            for (local, circuit) in track.sites[station].circuits.iter().enumerate() {
                if movement.hold.meets(Circuits::nth(local)) {
                    train.told_ms[*circuit] = now;
                }
            }
        }
        train.changed |= train.sent != sent;
        train.sent = sent;
        self.measure(number);
    }

    /// One cycle of a train.
    pub(crate) fn roll(&mut self, number: usize) {
        let length = f64::from(self.line.train_cycle_ms);
        let (interruption, misread) = (self.interruption(number, length), self.misread(number, length));
        let met = self.met(number, interruption.is_some());
        let (device, line, now_ms) = (&self.device, self.line, self.now_ms);
        let train = &mut self.trains[number];
        let coded = self.setting.signal != Signal::Telegrams;
        let heard = train.sent.filter(|_| coded && !train.changed);
        train.changed = false;
        let disturbed = match (interruption, misread) {
            (Some(_), _) => None,
            (None, Some(rank)) => Some(rank.min(device.highest())),
            (None, None) => heard,
        };
        let speed = measured(train.body.speed);
        let before = train.cab.brake;
        train.cab = device.step(&mut train.onboard, disturbed, speed, met);
        let moves = speed.0 > 0;
        if moves && before == Brake::Release && train.cab.brake != Brake::Release {
            train.applications += 1;
        }
        let mut needless = false;
        if self.setting.compared {
            let other = device.step(&mut train.beside, heard, speed, met).brake;
            if interruption.is_some() && train.interruption != interruption {
                // Whether it tells anything: a train that stands, or brakes anyway, is not braked needlessly.
                train.counted = !(moves && other == Brake::Release && train.cab.brake == Brake::Release);
                train.interrupted += u32::from(!train.counted);
                train.interruption = interruption;
            }
            if moves && other == Brake::Release && train.cab.brake != Brake::Release && !train.counted {
                train.counted = true;
                train.needless += 1;
                needless = true;
            }
            let rival = self.rival.step(&mut train.rival, disturbed, speed, met).brake;
            train.alone += u32::from(
                moves && rival == Brake::Release && before == Brake::Release && train.cab.brake != Brake::Release,
            );
        }
        let (emergency, braked) = (train.cab.brake == Brake::Emergency, train.cab.brake != Brake::Release);
        let began = moves && before == Brake::Release && braked;
        let along_m = if began || needless { train.body.along_m(&line.track) } else { 0.0 };
        self.move_on(number, now_ms);
        if began {
            self.tell(What::Braked { train: number, emergency, along_m });
        }
        if needless {
            self.tell(What::NeedlesslyBraked { train: number, along_m });
        }
    }

    /// What a train on telegrams meets in a cycle: the frames that are complete at its end, its way, and how it faces.
    fn met(&mut self, number: usize, broken_off: bool) -> Met {
        if self.setting.signal == Signal::Codes {
            return Met::default();
        }
        let end_ms = self.now_ms + u64::from(self.line.train_cycle_ms);
        let train = &mut self.trains[number];
        if broken_off {
            train.hears_ms = end_ms;
        }
        let (leg, moved_m, hears_ms) = (train.body.front(), train.moved_m, train.hears_ms);
        let track = &self.line.track;
        let piece = &track.pieces[leg.piece];
        let to_exit_m = piece.plain.then(|| self.trains[number].body.to_joint_m(track));
        let (mut facing, mut sent) = (None, None);
        for (station, local) in self.local.iter().enumerate() {
            let Some(here) = local[piece.circuit] else { continue };
            facing = facing.or(track.heading(station, leg.piece, leg.exit));
            let air = self.stations[station].air[usize::from(here)];
            // Two at once are heard as neither.
            sent = if sent.is_some() && air.is_some() { None } else { sent.or(air) };
        }
        let slot = u64::from(FRAME_MS);
        let mut frames = [None; 2];
        if end_ms.is_multiple_of(slot) && hears_ms + slot <= end_ms {
            // Those for trains to the left come first.
            let heading = if (end_ms / slot).is_multiple_of(2) { Heading::Right } else { Heading::Left };
            let feed = sent.map(|sent: Transmission| sent.facing(heading));
            frames = [feed.map(|feed| feed.main), feed.map(|feed| feed.sub)];
        }
        Met { frames, moved_m, to_exit_m, facing }
    }

    fn interruption(&self, number: usize, length: f64) -> Option<usize> {
        if !self.kinds.contains(&Kind::Interruption) {
            return None;
        }
        let now = self.now();
        // Sorted by their begin.
        let from = self.setting.faults.partition_point(|fault| fault.from_ms < now - self.longest_ms);
        let mine = |fault: &Fault| fault.kind == Kind::Interruption && fault.which % self.trains.len() == number;
        let begun = self.setting.faults[from..].iter().take_while(|fault| fault.from_ms < now + length);
        begun.enumerate().filter(|(_, fault)| mine(fault) && fault.meets(now, length)).map(|(at, _)| from + at).last()
    }

    fn misread(&self, number: usize, length: f64) -> Option<u8> {
        let mut mine = self.faults(Kind::MisreadCode, length).filter(|fault| fault.which % self.trains.len() == number);
        mine.next().map(|fault| u8::try_from(fault.much).unwrap_or(u8::MAX))
    }

    fn move_on(&mut self, number: usize, now_ms: u64) {
        let line = self.line;
        let (track, dynamics) = (&line.track, &line.dynamics);
        let step = f64::from(line.train_cycle_ms) / 1000.0;
        let to_stop_m = self.to_stop(number);
        let may_leave = self.dispatcher.agents[number].may_leave();
        let train = &mut self.trains[number];
        let brake = train.cab.brake;
        train.braking_ms = if brake == Brake::Release { None } else { train.braking_ms.or(Some(now_ms)) };
        let acts = train.braking_ms.is_some_and(|since| now_ms - since >= u64::from(dynamics.brake_delay_ms));
        let permitted = train.cab.permission.speed.map_or(0.0, |speed| f64::from(speed.0) / 36.0);
        let driven =
            drive(self.setting.drivers, dynamics, Sight { speed: train.body.speed, permitted, to_stop_m, may_leave });
        let acceleration = match brake {
            Brake::Release => driven,
            _ if !acts => driven.min(0.0),
            Brake::Service => driven.min(-dynamics.service),
            Brake::Emergency => -dynamics.emergency,
        };
        train.body.speed = (train.body.speed + acceleration * step).max(0.0);
        let metres = train.body.speed * step;
        train.moved_m = metres;
        if metres <= 0.0 {
            return;
        }
        train.ran_m += metres;
        let (mut crossed, mut left) = (Vec::new(), Vec::new());
        let points = &self.points;
        train.body.advance(
            track,
            metres,
            &|point| points[point].lie(),
            &mut |event| crossed.push(event),
            &mut |piece| left.push(piece),
        );
        for piece in left {
            self.on_piece[piece] -= 1;
            self.on_circuit[track.pieces[piece].circuit] -= 1;
        }
        for event in crossed {
            self.crossed(number, event);
        }
    }

    fn crossed(&mut self, number: usize, event: Crossed) {
        let track = &self.line.track;
        match event {
            Crossed::EndOfTrack => self.tell(What::EndOfTrack { train: number }),
            Crossed::Derailed(point) => {
                let piece = self.trains[number].body.front().piece;
                self.on_piece[piece] += 1;
                self.on_circuit[track.pieces[piece].circuit] += 1;
                self.tell(What::Derailment { train: number, point: track.points[point].name.clone() });
            }
            Crossed::Onto(piece) => {
                self.on_piece[piece] += 1;
                let circuit = track.pieces[piece].circuit;
                self.on_circuit[circuit] += 1;
                let told = self.trains[number].told_ms[circuit];
                if told == 0 || told + u64::from(self.line.residual_ms) < self.now_ms {
                    self.tell(What::Overrun { train: number, circuit: track.circuits[circuit].name.clone() });
                }
                self.trains[number].changed = true;
                self.trains[number].hears_ms = self.now_ms + u64::from(self.line.train_cycle_ms);
                self.listen(number);
            }
        }
    }

    /// From the front to where the train is to stop at its station, if it is there.
    fn to_stop(&self, number: usize) -> Option<f64> {
        const BEFORE_THE_END_M: f64 = 10.0;
        let (agent, body) = (&self.dispatcher.agents[number], &self.trains[number].body);
        let (station, track) = agent.target?;
        let platform = &self.line.stations[station].platforms[track];
        let front = body.front().piece;
        let place = platform.legs.iter().position(|leg| leg.piece == front)?;
        let ahead = match agent.bound {
            Bound::East => &platform.legs[place + 1..],
            Bound::West => &platform.legs[..place],
        };
        let more: f64 = ahead.iter().map(|leg| self.line.track.pieces[leg.piece].length_m).sum();
        Some(body.to_joint_m(&self.line.track) + more - BEFORE_THE_END_M)
    }
}
