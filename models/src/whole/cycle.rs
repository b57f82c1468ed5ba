//! One cycle of the line: trains roll, stations read and put out, trains hear and brake.

use super::devices::{CIRCUITS, HIGHEST, circuit, frequencies, leads_to, levels};
use super::faults::{Event, Fault, Kind, request};
use super::ground::{self, Blade, Body, Harm, PLACES, PLATFORM};
use super::station::{Put, Read};
use super::{Held, Made, State, TOO_LONG, Train, Whole, shift};
use atc_kernel::Machine as _;
use atc_kernel::interlocking::{Positions, RouteSet};
use atc_kernel::position::Moved;
use atc_kernel::speed::RawKmhTenths;
use atc_kernel::supervision::Brake;
use atc_kernel::telegram::Counter;
use atc_kernel::train::{Antennas, Carrier, State as Device};
use atc_kernel::wayside::{Counters, Transmission};
use std::sync::Arc;

/// For how many cycles a point moves.
const STROKE: u8 = 2;

impl<const T: usize> Whole<T> {
    /// One cycle in which this happens, with all counts that may be 0 at 0 after it.
    pub fn cycle(&self, state: &State<T>, event: Event) -> Made<T> {
        let mut made = self.counted_on(state, event);
        shift::normal(&mut made.after);
        made
    }

    /// The same with all counts as the devices count them.
    pub fn counted_on(&self, state: &State<T>, event: Event) -> Made<T> {
        let mut after = *state;
        after.faults = event.faults;
        for fault in event.faults.iter().flatten() {
            after.left -= u8::from(fault.age == 0);
        }
        after.asks -= u8::from(event.asked.is_some());
        let ran = Self::roll(state, &mut after);
        for (station, blade) in after.blades.iter_mut().enumerate() {
            blade.moves = blade.moves.saturating_sub(u8::from(!event.has(Kind::LatePoint, station)));
        }
        after.dispatch(state);
        if event.asked.is_some_and(|(_, request)| request == request::MIND) {
            after.bound = after.bound.opposite();
        }

        let mut read = [0, 1].map(|station| Self::read(&after, station, event));
        for sender in 0..2 {
            let old = |slot: usize| match (event.faults[slot], after.held[slot]) {
                (Some(Fault { kind: Kind::OldMessage, at, age: 1.. }), Held::Said(old)) => {
                    (usize::from(at) == sender).then_some(old)
                }
                _ => None,
            };
            let message = old(0).or(old(1)).unwrap_or(state.said[sender]);
            read[1 - sender].message = message.filter(|_| !event.has(Kind::LostMessage, sender));
        }
        for station in 0..2 {
            if let Some(from) = event.starts(station) {
                let counters = after.stations[station].counters;
                after.stations[station] = self.ground(station).initial();
                for (begun, before) in after.stations[station].counters.iter_mut().zip(&counters).take(CIRCUITS.len()) {
                    let moved = |counter: Counter| Counter(counter.0.wrapping_add(from));
                    *begun = Counters { main: moved(before.main), sub: moved(before.sub) };
                }
                shift::forget(&mut after, station);
                // What is on its way is of the start before.
                (read[0].message, read[1].message) = (after.said[1], after.said[0]);
                (read[station].asked, read[station].starts) = (None, true);
            }
        }
        let begun = after.stations;
        let put = [0, 1].map(|station: usize| self.stations[station].cycle(&begun[station], &read[station]));
        for (station, put) in put.iter().enumerate() {
            after.stations[station] = put.after;
            after.said[station] = put.message;
            drive(&mut after.blades[station], put.drives);
        }
        for slot in 0..2 {
            after.held[slot] = Self::hold(&after, slot, &put);
        }
        for (number, (ran, before)) in ran.into_iter().zip(&state.trains).enumerate() {
            self.hear(&mut after, (number, ran, before.body.place()), event, &put);
        }
        after.turn = after.turn.opposite();
        Made { after, begun, read }
    }

    /// Rolls the trains, and judges what they meet. How far each ran.
    fn roll(state: &State<T>, after: &mut State<T>) -> [i16; T] {
        let mut ran = [0; T];
        for (number, train) in after.trains.iter_mut().enumerate() {
            let before = state.trains[number];
            let (mut body, metres) = before.body.rolled(before.device.brake != Brake::Release);
            ran[number] = metres;
            let mut harm = Harm::None;
            for station in 0..2 {
                let (met, derailed) = state.blades[station].met(station, &before.body, body);
                body = met;
                let signal = body.crossed(&before.body, signal_of(station, body));
                if derailed {
                    harm = Harm::Derailment;
                } else if signal && before.since >= TOO_LONG {
                    harm = Harm::Signal;
                }
            }
            let (low, high) = body.ends();
            if low < 0 || high > i16::from(PLACES) * ground::PLACE_M {
                harm = Harm::EndOfTrack;
            }
            train.body = body;
            if after.harm == Harm::None {
                after.harm = harm;
            }
        }
        for (number, train) in after.trains.iter().enumerate() {
            if after.trains[..number].iter().any(|other| other.body.meets(&train.body)) {
                after.harm = Harm::Collision;
            }
        }
        ran
    }

    /// What a station reads; its neighbour's message is left out.
    fn read(after: &State<T>, station: usize, event: Event) -> Read {
        let mut occupied = 0;
        let mut report = |place, track| {
            occupied |= circuit(station, place, track).map_or(0, |circuit| 1 << circuit);
        };
        for (number, train) in after.trains.iter().enumerate() {
            let on = train.body.on();
            let lost = event.has(Kind::LostShunt, number);
            for place in (0..PLACES).filter(|place| !lost && on >> place & 1 == 1) {
                report(place, train.body.tracks[station]);
            }
        }
        for place in 0..PLACES {
            if event.has(Kind::FalseOccupancy, usize::from(place)) {
                report(place, 0);
            }
        }
        for (which, place) in PLATFORM.into_iter().enumerate() {
            if event.has(Kind::FalseOccupancy, usize::from(PLACES) + which) {
                report(place, 1);
            }
        }
        let blade = after.blades[station];
        let seen = blade.moves == 0 && !event.has(Kind::UndetectedPoint, station);
        let stuck = |circuit: &usize| event.repeats(Kind::StuckTransmitter, station * CIRCUITS.len() + circuit);
        let asked = match event.asked {
            Some((at, request)) if usize::from(at) == station && request != request::MIND => Some(request),
            _ => after.wanted(station),
        };
        Read {
            occupied,
            detected: if seen { leads_to(blade.to) } else { Positions::NONE },
            asked,
            starts: after.stations[station].device.interlocking.started.0 == 0,
            message: None,
            stuck: (0..CIRCUITS.len()).filter(stuck).fold(0, |all, circuit| all | 1 << circuit),
        }
    }

    /// What a fault repeats in the cycles after its first.
    fn hold(after: &State<T>, slot: usize, put: &[Arc<Put>; 2]) -> Held {
        match after.faults[slot] {
            Some(Fault { kind: Kind::StuckTransmitter, at, age: 0 }) => {
                Held::Air(put[usize::from(at) / CIRCUITS.len()].air[usize::from(at) % CIRCUITS.len()])
            }
            Some(Fault { kind: Kind::OldMessage, at, age: 0 }) => Held::Said(after.said[usize::from(at)]),
            Some(Fault { kind: Kind::StuckTransmitter | Kind::OldMessage, .. }) => after.held[slot],
            _ => Held::Nothing,
        }
    }

    /// What a circuit's transmitter sends.
    fn sent(after: &State<T>, (station, circuit): (usize, u8), put: &Put) -> Option<Transmission> {
        let number = station * CIRCUITS.len() + usize::from(circuit);
        let stuck = |(fault, held): (&Option<Fault>, &Held)| match (fault, held) {
            (Some(Fault { kind: Kind::StuckTransmitter, at, .. }), Held::Air(old)) if usize::from(*at) == number => {
                Some(*old)
            }
            _ => None,
        };
        let repeated = after.faults.iter().zip(&after.held).find_map(stuck);
        repeated.unwrap_or(put.air[usize::from(circuit)])
    }

    /// A train hears what is sent at its front, and its device brakes.
    fn hear(&self, after: &mut State<T>, (number, ran, before): (usize, i16, u8), event: Event, put: &[Arc<Put>; 2]) {
        let train = after.trains[number];
        let (body, place) = (train.body, train.body.place());
        let mut sent = Vec::new();
        let mut shows = false;
        for (station, put) in put.iter().enumerate() {
            let Some(circuit) = circuit(station, place, body.tracks[station]) else { continue };
            sent.extend(Self::sent(after, (station, circuit), put));
            shows |= put.proceed.meets(routes_from(station, body));
        }
        // Two at once are heard as neither.
        let quiet = event.has(Kind::Interruption, number);
        let sent = if let [one] = sent[..] { Some(one).filter(|_| !quiet) } else { None };
        // Frames are heard for whatever direction of travel they are, and codes at the end for which they are.
        let feed = sent.map(|sent| sent.facing(after.turn));
        let codes = sent.map(|sent| sent.facing(body.heading).codes).filter(|_| place == before);
        // A code counts that was heard throughout the cycle.
        let [main, sub] = match codes {
            _ if event.has(Kind::MisreadCode, number) => HIGHEST,
            Some(codes) => frequencies(codes),
            None => [None; 2],
        };
        let [first, second] = if quiet { [None; 2] } else { levels(body.to_exit()) };
        let antennas = Antennas {
            main: Carrier { code: main, frame: feed.map(|feed| feed.main) },
            sub: Carrier { code: sub, frame: feed.map(|feed| feed.sub) },
            first,
            second,
            moved: Moved::new(ran * 990, ran * 1010),
            speed: Some(RawKmhTenths(i32::from(body.speed) * 36)),
            line: None,
            facing: Some(body.heading),
        };
        let device = if event.has(Kind::TrainStarts, number) { Device::INITIAL } else { train.device };
        let (device, _) = self.on_board.step(device, antennas);
        let since = if shows { 0 } else { (train.since + 1).min(TOO_LONG) };
        after.trains[number] = Train { body, device, since };
    }
}

/// The joint at which the next signal for a train stands that a station has: that of its way in, or of its way out.
fn signal_of(station: usize, body: Body) -> i16 {
    let (legs, toe) = ground::point(station);
    if body.stations().0 == station { legs } else { toe }
}

/// The routes of the signal at the exit of the place where a train's front is, if the station has one there.
fn routes_from(station: usize, body: Body) -> RouteSet {
    let (from, to) = body.stations();
    let at = body.place();
    if station == from && at == PLATFORM[station] {
        RouteSet::nth(2 + usize::from(body.tracks[station]))
    } else if station == to && circuit(station, at, 0) == Some(0) {
        RouteSet::nth(0).or(RouteSet::nth(1))
    } else {
        RouteSet::EMPTY
    }
}

/// The point is driven.
fn drive(blade: &mut Blade, drives: Positions) {
    for to in 0..2 {
        if leads_to(to).missing_in(drives).is_empty() && blade.to != to {
            *blade = Blade { to, moves: STROKE };
        }
    }
}
