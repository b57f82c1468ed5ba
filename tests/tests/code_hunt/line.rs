//! A line out of a station, and a train on it.

use atc_kernel::distance::Metres;
use atc_kernel::interlocking::{
    CircuitSet, Element, Heading, Input, Layout, MAX_CODES, Movement, Orders, Phase, Plan, Positions, Request, Route,
    RouteId, Segment, SegmentId, SegmentSet, SpeedCode, State, Travel,
};
use atc_kernel::time::Ticks;
use atc_layout::At;
use atc_layout::Description;

const LOOP: &str = include_str!("../../../layouts/passing-loop.toml");
/// km/h of the codes from 1 on: those of the passing loop.
pub const SPEEDS: [u32; 7] = [15, 25, 45, 55, 65, 75, 90];
const CYCLE_MS: u32 = 100;
const PLACES: usize = 16;
const TRAIN_MM: i64 = 50_000;
/// When the line is turned and the route set: nothing is known of trains before.
const READY: u32 = 1_010;

/// What the train must not pass.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// The rear of a train that stands in the circuit next to the station.
    Train,
    /// The signal at the station, whose route is withdrawn, once the route is idle.
    Signal,
}

/// The distances of the codes in metres, as a layout with this age (ms) and brake (mm/s²) has them, where codes are heard so many metres beyond their
/// circuits.
pub fn derived(age_ms: u32, brake: u16, heard_beyond: u16) -> [Option<u16>; MAX_CODES] {
    derived_up_to(age_ms, brake, heard_beyond, None)
}

/// The same, where trains come from telegrams by a pattern with `strongest` at most.
pub fn derived_up_to(age_ms: u32, brake: u16, heard_beyond: u16, strongest: Option<u16>) -> [Option<u16>; MAX_CODES] {
    let mut station = Description::from_toml("loop", LOOP).expect("a layout");
    station.station.times.telegram_age_ms.value = age_ms;
    station.station.braking.deceleration_mm_s2.value = brake;
    station.station.braking.heard_beyond_m.value = heard_beyond;
    station.station.braking.strongest_mm_s2 = strongest.map(At::derived);
    // Approaches are long enough for any of them.
    station.station.circuits.iter_mut().for_each(|circuit| circuit.length_m.value *= 4);
    let values = station.model().expect("a model").values;
    assert_eq!(values.speeds_kmh[1..].iter().map(|kmh| u32::from(*kmh)).collect::<Vec<_>>(), SPEEDS);
    assert_eq!(values.brake_mm_s2, brake);
    values.braking.map(|distance| (distance.0 < u16::MAX).then_some(distance.0))
}

/// What the distances hold for trains that brake in steps: brake × age² / 2, in metres, rounded up.
pub fn steps((age_ms, brake): (u32, u16)) -> u16 {
    let metres = (u64::from(brake) * u64::from(age_ms) * u64::from(age_ms)).div_ceil(2_000_000_000);
    u16::try_from(metres).expect("some metres")
}

/// A line, and how trains run on it.
#[derive(Clone, Copy, Debug)]
pub struct Line<'a> {
    /// The circuits in metres, the one next to the station first.
    pub lengths: &'a [u16],
    /// The distances of the codes.
    pub braking: &'a [Option<u16>; MAX_CODES],
    /// For how long a train goes on at a code that it has heard.
    pub age_ms: u32,
    /// The brake of every train, and the one that this train has for all but the last code, in mm/s².
    pub brakes: [u16; 2],
    /// For how long the brake builds up, within the age (ms), and what the train gains meanwhile, on a fall (mm/s²).
    pub builds_up: (u32, u16),
    /// How far beyond its circuit the nose is when a code is still heard, in metres.
    pub heard_beyond: u16,
    /// For how many cycles the circuit that a front comes into is not reported.
    pub lost: u8,
}

impl Line<'_> {
    /// The circuit of the signal and the one beyond it have the numbers after the line's.
    fn plan(&self) -> Plan<1, PLACES, 1, 1> {
        let count = self.lengths.len();
        let mut plan =
            Plan { clear: 2 * self.loss(), loss: self.loss(), turn: Ticks(1_000), start: Ticks(1_000), ..Plan::EMPTY };
        for (length, metres) in plan.lengths.iter_mut().zip(self.lengths.iter().chain(&[300, 300])) {
            *length = Metres(*metres);
        }
        for (code, distance) in plan.braking.iter_mut().zip(self.braking) {
            *code = Metres(distance.unwrap_or(u16::MAX));
        }
        let fastest = SPEEDS[SPEEDS.len() - 1];
        let stopping_ms = (fastest * 1_000_000).div_ceil(3_600) * 1_000 / u32::from(self.brakes[0]);
        let cycles = (self.age_ms + stopping_ms).div_ceil(CYCLE_MS);
        plan.residual = Ticks(u16::try_from(cycles).expect("some cycles"));
        plan.standstill = Ticks(10);
        // What `layout` derives: the distance of the code, and what is run while the train is not reported.
        let unreported = (fastest * CYCLE_MS * u32::from(self.loss())).div_ceil(3_600);
        let needed = u32::from(self.braking[SPEEDS.len()].expect("a distance")) + unreported;
        let (mut approach, mut metres) = (CircuitSet::EMPTY, 0);
        for (number, length) in self.lengths.iter().enumerate() {
            if metres < needed {
                approach = approach.or(CircuitSet::nth(number));
                metres += u32::from(*length);
            }
        }
        let mut path = [Element::NONE; PLACES];
        path[0].circuits = CircuitSet::nth(count);
        plan.routes[0] = Route {
            heading: Heading::Right,
            entry: CircuitSet::nth(0),
            approach,
            path,
            length: 1,
            beyond: CircuitSet::nth(count + 1),
            from: SegmentSet::nth(0),
            drive: Ticks(10),
            release: Ticks(plan.residual.0 + u16::from(self.loss())),
            stay: Ticks(100),
            speed: SpeedCode(7),
            ..Route::NONE
        };
        let mut circuits = [CircuitSet::EMPTY; PLACES];
        for (number, circuit) in circuits.iter_mut().enumerate().take(count) {
            *circuit = CircuitSet::nth(number);
        }
        let length = u8::try_from(count).expect("some circuits");
        plan.segments[0] = Segment { circuits, length, outward: Heading::Left, ..Segment::NONE };
        plan
    }

    /// The circuit at `mm` from the signal, towards it; the outermost one also beyond its end.
    fn circuit(&self, mm: i64) -> usize {
        let mut end = 0;
        for (number, length) in self.lengths.iter().enumerate() {
            end -= i64::from(*length) * 1_000;
            if mm > end && mm <= end + i64::from(*length) * 1_000 {
                return number;
            }
        }
        if mm > 0 { self.lengths.len() } else { self.lengths.len() - 1 }
    }

    /// The longest loss of shunt, in cycles.
    fn loss(&self) -> u8 {
        self.lost.max(1)
    }

    /// Without the foremost circuit if the front is lost, and the tail is not in it.
    fn occupied(&self, front: i64, lost: bool) -> CircuitSet {
        let mut occupied = CircuitSet::EMPTY;
        let (first, last) = (self.circuit(front.min(0)), self.circuit((front - TRAIN_MM).min(0)));
        for number in first + usize::from(lost && first < last)..=last {
            occupied = occupied.or(CircuitSet::nth(number));
        }
        if front > 0 { occupied.or(CircuitSet::nth(self.lengths.len())) } else { occupied }
    }

    /// How far the front comes beyond the place, in mm. The route is withdrawn when the front is at `moment`, in mm from the signal. None if the route is
    /// still held when the front passes its signal: then it is the train's own.
    pub fn run(&self, place: Place, moment: i64) -> Option<i64> {
        let layout = Layout::new(self.plan()).expect("a layout");
        let first = i64::from(self.lengths[0]) * 1_000;
        let end = if place == Place::Train { -first } else { 0 };
        let outermost = -self.lengths.iter().map(|length| i64::from(*length) * 1_000).sum::<i64>();
        // Twentieths of a millimetre: a cycle's way is the sum of two speeds of them.
        let mut way = (outermost + TRAIN_MM + 5_000) * 20;
        let (mut speed, mut obeyed, mut heard) = (0_i64, 0, 0);
        let (build_up_ms, gain) = (self.builds_up.0, i64::from(self.builds_up.1) * i64::from(CYCLE_MS) / 1_000);
        let mut too_fast_ms = 0;
        let mut state = State::INITIAL;
        let mut withdrawn = false;
        let mut entered = (self.lengths.len() - 1, 0);
        for cycle in 1..20_000_u32 {
            let front = way / 20;
            let ready = cycle > READY + 2;
            if self.circuit(front) != entered.0 {
                entered = (self.circuit(front), cycle);
            }
            let request = match (cycle, place) {
                (READY, _) => Some(Request::Turn(SegmentId::ZERO, Travel::Toward)),
                (_, Place::Signal) if cycle == READY + 2 => Some(Request::Set(RouteId::ZERO)),
                (_, Place::Signal) if ready && !withdrawn && front >= moment => {
                    withdrawn = true;
                    Some(Request::Withdraw(RouteId::ZERO))
                }
                _ => None,
            };
            let standing = if place == Place::Train { CircuitSet::nth(0) } else { CircuitSet::EMPTY };
            // The line is turned before there is anybody.
            let occupied = if ready {
                self.occupied(front, cycle - entered.1 < self.lost.into()).or(standing)
            } else {
                CircuitSet::EMPTY
            };
            let orders = Orders { unblock: CircuitSet::ALL, lift: CircuitSet::ALL, ..Orders::default() };
            let input = Input { occupied, detected: Positions::NONE, request, orders, consent: SegmentSet::EMPTY };
            let (after, output) = layout.cycle(state, input);
            state = after;
            if !ready {
                assert!(output.answer.is_none_or(|answer| answer.is_ok()), "{:?}", output.answer);
                continue;
            }
            if front > end {
                let idle = state.routes[0].phase == Phase::Idle;
                return (place == Place::Train || idle).then(|| self.stop(front - end, speed));
            }
            let telegrams = layout.telegrams(&output.table, state.epoch);
            // Where two codes are heard the train takes the higher one.
            let heard_at = [front, front - i64::from(self.heard_beyond) * 1_000].map(|mm| telegrams[self.circuit(mm)]);
            let told =
                heard_at.map(|told| told.filter(Movement::is_open).map_or(0, |movement| usize::from(movement.speed.0)));
            let told = told[0].max(told[1]);
            if told >= obeyed || (cycle - heard) * CYCLE_MS + build_up_ms >= self.age_ms {
                (obeyed, heard) = (told, cycle);
            }
            let target = if obeyed == 0 { 0 } else { i64::from(SPEEDS[obeyed - 1]) * 1_000_000 / 3_600 };
            let before = speed;
            let brake = i64::from(self.brakes[usize::from(obeyed > 0)]) * i64::from(CYCLE_MS) / 1_000;
            too_fast_ms = if speed > target { too_fast_ms + CYCLE_MS } else { 0 };
            speed = match speed > target {
                true if too_fast_ms <= build_up_ms => speed + gain,
                true => (speed - brake).max(target),
                false => (speed + 100).min(target),
            };
            way += (before + speed) * i64::from(CYCLE_MS) / 100;
            if speed == 0 && obeyed == 0 && told == 0 && (withdrawn || place == Place::Train) {
                break;
            }
        }
        Some(way / 20 - end)
    }

    /// Where it stands in the end if it brakes from now on.
    fn stop(&self, beyond: i64, speed: i64) -> i64 {
        beyond + speed * speed / (2 * i64::from(self.brakes[0]))
    }
}
