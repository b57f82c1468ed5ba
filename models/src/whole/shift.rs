//! One state for all that differ by nothing but when they are reached.
//!
//! The devices count cycles, starts and telegrams, and look at differences of such counts alone: at how old a message is, whether a stamp
//! is of this start, by how much a counter advanced. A state in which each count and all that is compared with it are less by the same
//! number goes on in the same way. A test runs both beside each other (`models/tests/whole.rs`).
//!
//! One thing is left out: in the middle, which two stations see, a train could compare the number of one station's telegram with that of the
//! other's. It does not come to that: the line does not turn under a train, and after a start nobody sends there for longer than a stream
//! is remembered. The test would tell.

use super::devices::{CIRCUITS, circuit_of};
use super::{Held, State, Train};
use atc_kernel::interlocking::Epoch;
use atc_kernel::permitted::State as Permitted;
use atc_kernel::telegram::{Counter, Frame, Header, Main, Stream, Sub, Telegram, decode, encode};
use atc_kernel::wayside::{Counters, Message, Session, Stamp, Transmission};

/// A start that is over: which one does not matter, as none is compared with another.
const OVER: Stamp = Stamp { session: Session(1), cycle: Epoch(0) };

/// The circuit that both stations see.
const MIDDLE: usize = CIRCUITS.len() - 1;

/// The device of a station starts again: what has been stamped by it is of a start that is over.
pub fn forget<const T: usize>(state: &mut State<T>, station: usize) {
    stamps(state, station, |_| OVER);
}

/// The same with all counts that may be 0 at 0.
pub fn normal<const T: usize>(state: &mut State<T>) {
    for station in 0..2 {
        let now = state.stations[station].device.cycle;
        stamps(state, station, |stamp| match stamp.session {
            Session(0) => Stamp { cycle: Epoch(stamp.cycle.0.wrapping_sub(now.0)), ..stamp },
            _ => OVER,
        });
        let device = &mut state.stations[station].device;
        (device.cycle, device.interlocking.epoch) = (Epoch(0), Epoch(0));
        for circuit in 0..MIDDLE {
            counters(state, &[station], circuit);
        }
    }
    counters(state, &[0, 1], MIDDLE);
}

/// Changes all stamps of a station, wherever they are.
fn stamps<const T: usize>(state: &mut State<T>, station: usize, change: impl Fn(Stamp) -> Stamp) {
    let other = 1 - station;
    let heard = &mut state.stations[other].consents[0].heard;
    *heard = heard.map(&change);
    let own = |message: &mut Message| message.sent = change(message.sent);
    let echoed = |message: &mut Message| message.echo = message.echo.map(&change);
    state.said[station].as_mut().map(own);
    state.said[other].as_mut().map(echoed);
    for (held, fault) in state.held.iter_mut().zip(state.faults) {
        if let (Held::Said(Some(message)), Some(fault)) = (held, fault) {
            if usize::from(fault.at) == station { own(message) } else { echoed(message) }
        }
    }
}

/// The numbers of a circuit's telegrams, of both carriers: of those that come next, of those that trains have heard, and of those that a
/// transmitter repeats.
fn counters<const T: usize>(state: &mut State<T>, stations: &[usize], circuit: usize) {
    let its = |stream: &Stream| {
        let of = stream.last.and_then(|last| circuit_of(last.section));
        let here =
            |(station, number)| usize::from(number) == circuit && (circuit == MIDDLE || stations.contains(&station));
        of.is_some_and(here)
    };
    let faults = state.faults;
    let repeats = |slot: usize, station: usize| {
        faults[slot].is_some_and(|fault| usize::from(fault.at) == station * CIRCUITS.len() + circuit)
    };
    for carrier in [Carrier::Main, Carrier::Sub] {
        let last =
            |train: &Train| Some(carrier.stream(&mut { train.device.permitted })).filter(|stream| its(stream))?.last;
        let heard = state.trains.iter().find_map(last).map(|last| last.counter.0);
        let count = |station: usize| carrier.next(&mut { state.stations[station].counters[circuit] }).0;
        // What has been heard, or is repeated, is compared with what comes next. Where nothing is, each may begin at 0.
        let held = |station: &&usize| {
            (0..2).any(|slot| repeats(slot, **station) && matches!(state.held[slot], Held::Air(Some(_))))
        };
        let repeated = stations.iter().find(held).map(|station| count(*station));
        let compared = heard.or(repeated);
        let bases: Vec<u8> = stations.iter().map(|station| compared.unwrap_or_else(|| count(*station))).collect();
        for (station, base) in stations.iter().zip(&bases) {
            let next = carrier.next(&mut state.stations[*station].counters[circuit]);
            *next = less(*next, *base);
            for (slot, held) in state.held.iter_mut().enumerate() {
                if let (Held::Air(Some(air)), true) = (held, repeats(slot, *station)) {
                    for frame in carrier.frames(air) {
                        *frame = renumbered(*frame, *base);
                    }
                }
            }
        }
        for train in &mut state.trains {
            let stream = carrier.stream(&mut train.device.permitted);
            if its(stream) {
                stream.last =
                    stream.last.map(|last| Header { counter: less(last.counter, compared.unwrap_or(0)), ..last });
            }
        }
    }
}

/// One of the two carriers.
#[derive(Clone, Copy)]
enum Carrier {
    /// That of main telegrams.
    Main,
    /// That of sub telegrams.
    Sub,
}

impl Carrier {
    fn next(self, counters: &mut Counters) -> &mut Counter {
        match self {
            Self::Main => &mut counters.main,
            Self::Sub => &mut counters.sub,
        }
    }

    fn stream(self, heard: &mut Permitted) -> &mut Stream {
        match self {
            Self::Main => &mut heard.main_stream,
            Self::Sub => &mut heard.sub_stream,
        }
    }

    fn frames(self, air: &mut Transmission) -> [&mut Frame; 2] {
        match self {
            Self::Main => [&mut air.left.main, &mut air.right.main],
            Self::Sub => [&mut air.left.sub, &mut air.right.sub],
        }
    }
}

fn less(counter: Counter, base: u8) -> Counter {
    Counter(counter.0.wrapping_sub(base))
}

/// The frame of the same telegram with another number.
fn renumbered(frame: Frame, base: u8) -> Frame {
    match decode(frame) {
        Ok(Telegram::Main(main)) => encode(Telegram::Main(Main { counter: less(main.counter, base), ..main })),
        Ok(Telegram::Sub(sub)) => encode(Telegram::Sub(Sub { counter: less(sub.counter, base), ..sub })),
        Err(_) => frame,
    }
}
