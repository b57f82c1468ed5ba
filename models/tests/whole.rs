//! The whole line: states that differ by nothing but when they are reached, runs with many faults, and a ground that sees harm.

mod drawn;

use atc_kernel::heading::Heading;
use atc_kernel::interlocking::CircuitSet;
use atc_kernel::supervision::Brake;
use atc_kernel::wayside::Counters;
use atc_models::whole::devices::Times;
use atc_models::whole::faults::{Event, Kind, request};
use atc_models::whole::ground::{Blade, Body, Harm};
use atc_models::whole::{Purpose, Room, State, Whole, shift};
use drawn::Drawn;

/// Two faults at once, and staff who ask for anything, again and again.
const ALL: Room =
    Room { kinds: &Kind::ALL, faults: u8::MAX, together: 2, requests: &request::ALL, asked: &[0, 1], asks: u8::MAX };

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

/// What was seen in drawn runs.
#[derive(Default)]
struct Seen {
    /// How often a train changed ends at a station.
    arrived: usize,
    /// In how many cycles a train moved.
    moving: usize,
    /// The harm, with the seed of its run.
    harm: Vec<(u64, Harm)>,
}

/// Runs with up to two faults at once and staff who ask for anything.
fn swarm<const T: usize>(seeds: std::ops::Range<u64>, cycles: usize) -> Seen {
    let model = line::<T>();
    let mut seen = Seen::default();
    for seed in seeds {
        let mut drawn = Drawn(seed);
        let mut state = model.begin();
        for _ in 0..cycles {
            let event = event(&model, &state, &mut drawn, 40);
            let after = model.cycle(&state, event).after;
            let turned = |number: &usize| after.trains[*number].body.heading != state.trains[*number].body.heading;
            seen.arrived += (0..T).filter(turned).count();
            seen.moving += usize::from(after.trains.iter().any(|train| train.body.speed > 0));
            state = after;
            if state.harm != Harm::None {
                seen.harm.push((seed, state.harm));
                break;
            }
        }
    }
    seen
}

#[test]
fn two_faults_at_once_and_staff_do_no_harm_to_two_trains() {
    let seen = swarm::<2>(0..1000, 300);
    assert!(seen.harm.is_empty(), "{:?}", seen.harm);
    assert!(seen.arrived > 1000 && seen.moving > 100_000, "{} {}", seen.arrived, seen.moving);
}

#[test]
fn two_faults_at_once_and_staff_do_no_harm_to_three_trains() {
    let seen = swarm::<3>(1000..2000, 300);
    assert!(seen.harm.is_empty(), "{:?}", seen.harm);
    assert!(seen.arrived > 1000 && seen.moving > 100_000, "{} {}", seen.arrived, seen.moving);
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

/// Each kind of harm by itself, on the ground alone.
#[test]
fn the_ground_judges_trains_and_points_as_they_are() {
    let east = |front, tracks| Body { heading: Heading::Right, front, speed: 10, tracks };
    let west = |front, tracks| Body { heading: Heading::Left, ..east(front, tracks) };
    // Side by side in two platforms, nose to nose on the line, one into the other.
    assert!(!east(60, [0, 0]).meets(&west(40, [1, 0])));
    assert!(east(60, [0, 0]).meets(&west(40, [0, 0])));
    assert!(east(320, [0, 0]).meets(&east(335, [1, 1])) && !east(320, [0, 0]).meets(&west(320, [1, 1])));
    assert!(east(110, [0, 0]).meets(&west(105, [1, 1])), "in the throat");
    let lies = |to| Blade { to, moves: 0 };
    // Out of the platform to which the point does not lead; into the one to which it does.
    assert!(lies(1).met(0, &east(96, [0, 0]), east(104, [0, 0])).1);
    assert!(!lies(0).met(0, &east(96, [0, 0]), east(104, [0, 0])).1);
    assert_eq!(lies(1).met(0, &west(204, [0, 0]), west(196, [0, 0])).0.tracks[0], 1);
    // A point that moves under the tail, in the cycle in which it leaves.
    let moves = Blade { to: 0, moves: 2 };
    assert!(moves.met(0, &east(215, [0, 0]), east(225, [0, 0])).1);
    assert!(!moves.met(0, &east(225, [0, 0]), east(235, [0, 0])).1);
}
