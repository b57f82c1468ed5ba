//! The whole line: states that differ by nothing but when they are reached, runs with many faults, and a ground that sees harm.

mod drawn;

use atc_kernel::interlocking::CircuitSet;
use atc_kernel::supervision::Brake;
use atc_kernel::wayside::Counters;
use atc_models::whole::devices::Times;
use atc_models::whole::faults::{Event, Kind, request};
use atc_models::whole::ground::Harm;
use atc_models::whole::{Purpose, Room, State, Whole, shift};
use drawn::Drawn;

/// Two faults at once, and staff who ask for anything, again and again.
const ALL: Room = Room { kinds: &Kind::ALL, faults: u8::MAX, together: 2, requests: &request::ALL, asks: u8::MAX };

fn line<const T: usize>() -> Whole<T> {
    Whole::new(Times::SOUND, ALL, Purpose::Safe)
}

/// One of what there is, and more often than not the first: nothing.
fn one<U: Copy>(drawn: &mut Drawn, all: &[U], often: usize) -> U {
    all[if drawn.below(often) == 0 { drawn.below(all.len()) } else { 0 }]
}

/// What happens in a cycle that is drawn. What lasts goes on in half of all cycles.
fn event<const T: usize>(model: &Whole<T>, state: &State<T>, drawn: &mut Drawn, often: usize) -> Event {
    let faults = [0, 1].map(|slot| {
        let begins = if state.faults[slot].is_some() { 1 } else { often };
        one(drawn, &model.faults(state, slot), begins)
    });
    // Nothing is at two places at once.
    let twice = faults[0].zip(faults[1]).is_some_and(|(one, other)| (one.kind, one.at) == (other.kind, other.at));
    Event { faults: [faults[0], faults[1].filter(|_| !twice)], asked: one(drawn, &model.asks(state), 4 * often) }
}

/// A state without the numbers with which a station would begin to send in the middle, which it does not.
fn told<const T: usize>(mut state: State<T>) -> State<T> {
    const MIDDLE: usize = 4;
    for station in &mut state.stations {
        if !station.sent.meets(CircuitSet::nth(MIDDLE)) {
            station.counters[MIDDLE] = Counters::START;
        }
    }
    state
}

/// What the model searches is what the devices do: a state with all its counts goes on as the same with counts at 0.
#[test]
fn counts_at_zero_change_nothing() {
    let model = line::<2>();
    let mut again = 0_usize;
    for seed in 0..6 {
        let mut drawn = Drawn(seed);
        let (mut counted, mut normal) = (model.begin(), model.begin());
        for cycle in 0..1500 {
            let event = event(&model, &normal, &mut drawn, 12);
            let before = counted;
            counted = model.counted_on(&before, event).after;
            normal = model.cycle(&normal, event).after;
            let mut same = counted;
            shift::normal(&mut same);
            assert_eq!(told(same), told(normal), "seed {seed}, cycle {cycle}: {event:?}");
            let first = |state: &State<2>| state.stations[0].counters[0].main.0;
            again += usize::from(first(&counted) < first(&before));
        }
    }
    assert!(again > 20, "a counter begins again: {again}");
}

/// Runs with up to two faults at once and staff who ask for anything: the trains that arrived, and the harm.
fn swarm<const T: usize>(seeds: std::ops::Range<u64>, cycles: usize) -> (usize, Vec<(u64, Harm)>) {
    let model = line::<T>();
    let (mut arrived, mut harm) = (0, Vec::new());
    for seed in seeds {
        let mut drawn = Drawn(seed);
        let mut state = model.begin();
        for _ in 0..cycles {
            let event = event(&model, &state, &mut drawn, 40);
            let after = model.cycle(&state, event).after;
            let turned = |number: &usize| after.trains[*number].body.heading != state.trains[*number].body.heading;
            arrived += (0..T).filter(turned).count();
            state = after;
            if state.harm != Harm::None {
                harm.push((seed, state.harm));
                break;
            }
        }
    }
    (arrived, harm)
}

#[test]
fn two_faults_at_once_and_staff_do_no_harm_to_two_trains() {
    let (arrived, harm) = swarm::<2>(0..150, 1500);
    assert!(harm.is_empty(), "{harm:?}");
    assert!(arrived > 300, "{arrived}");
}

#[test]
fn two_faults_at_once_and_staff_do_no_harm_to_three_trains() {
    let (arrived, harm) = swarm::<3>(1000..1150, 1500);
    assert!(harm.is_empty(), "{harm:?}");
    assert!(arrived > 300, "{arrived}");
}

/// The ground sees harm: trains whose brakes do not act pass their signals.
#[test]
fn trains_without_brakes_come_to_harm() {
    let model = line::<2>();
    let mut state = model.begin();
    for _ in 0..200 {
        for train in &mut state.trains {
            train.device.brake = Brake::Release;
        }
        state = model.cycle(&state, Event::default()).after;
    }
    assert_ne!(state.harm, Harm::None);
}
