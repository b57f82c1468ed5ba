//! Every state that a small station can reach, and every input in each of them.

use std::collections::{BTreeSet, HashSet};

use atc_kernel::interlocking::{Epoch, Layout, Position, State, Travel};
use atc_tests::sketch::{Line, Sketch, Way};

use crate::witness::{Ask, Commands, Read, Set, Witness};
use crate::{compare, input};

/// ```text
///             point 0
///   ==3==|──0──<──1──        route 0 from the line to 1, overlap 2; route 1 from 1 to the line
///               \─2──        route 2 from 2 to the line
/// ```
fn station() -> Sketch {
    let (normal, reverse) = (vec![(0, Position::Normal)], vec![(0, Position::Reverse)]);
    let short = Way { drive: 2, release: 2, stay: 2, speed: 1, overlap_speed: 1, ..Way::default() };
    Sketch {
        lengths: vec![100; 4],
        points: vec![vec![0]],
        routes: vec![
            Way {
                entry: 3,
                approach: vec![3],
                path: vec![(0, normal.clone()), (1, Vec::new())],
                overlap: (vec![2], Vec::new()),
                beyond: vec![2],
                from: Some(0),
                ..short.clone()
            },
            Way {
                entry: 1,
                approach: vec![1],
                path: vec![(0, normal)],
                beyond: vec![3],
                to: Some(0),
                leftward: true,
                ..short.clone()
            },
            Way {
                entry: 2,
                approach: vec![2],
                path: vec![(0, reverse)],
                beyond: vec![3],
                to: Some(0),
                leftward: true,
                ..short
            },
        ],
        segments: vec![Line { circuits: vec![3], throat: Some(0), leftward: true }],
        braking: vec![0, 100],
        clear: 1,
        turn: 1,
        ..Sketch::default()
    }
}

fn inputs() -> Vec<Read> {
    let asks = [
        None,
        Some(Ask::Set(0)),
        Some(Ask::Set(1)),
        Some(Ask::Set(2)),
        Some(Ask::Withdraw(0)),
        Some(Ask::Withdraw(1)),
        Some(Ask::Withdraw(2)),
        Some(Ask::Drive(0, Position::Reverse)),
        Some(Ask::Turn(0, Travel::Toward)),
        Some(Ask::Turn(0, Travel::Away)),
    ];
    let (lifted, consent): (Set, Set) = ((0..4).collect(), Set::from([0]));
    let mut inputs = Vec::new();
    for occupied in 0..16_usize {
        for detected in [vec![], vec![(0, Position::Normal)], vec![(0, Position::Reverse)]] {
            for ask in asks {
                let commands = Commands { lift: lifted.clone(), unblock: lifted.clone(), ..Commands::default() };
                let occupied = (0..4).filter(|circuit| occupied >> circuit & 1 == 1).collect::<BTreeSet<_>>();
                let detected = detected.clone();
                inputs.push(Read { occupied, detected, ask, commands, consent: consent.clone() });
            }
        }
    }
    // One circuit is blocked and unblocked, and nothing else happens in these cycles.
    let block = Commands { block: Set::from([0]), ..Commands::default() };
    inputs.push(Read { commands: block, detected: vec![(0, Position::Normal)], ..Read::default() });
    inputs
}

#[test]
fn every_state_of_a_small_station() {
    let sketch = station();
    let layout = Layout::<3, 2, 1, 1>::new(sketch.plan()).expect("a station");
    let inputs = inputs();
    let kernel_inputs: Vec<_> = inputs.iter().map(input).collect();
    let first = (State::<3, 1>::INITIAL, Witness::new(&sketch));
    // What one state leads to that is not in `seen`, each once.
    let follow = |states: &[(State<3, 1>, Witness)], seen: &HashSet<(State<3, 1>, Witness)>| {
        let mut found = HashSet::new();
        for (state, witness) in states {
            for (read, kernel_input) in inputs.iter().zip(&kernel_inputs) {
                let mut next_witness = witness.clone();
                let said = next_witness.cycle(&sketch, read);
                let (mut next, output) = layout.cycle(*state, *kernel_input);
                compare(&layout, &sketch, (&next_witness, &said), (&next, &output))
                    .unwrap_or_else(|what| panic!("{what}\n{read:?}\n{state:?}"));
                // The number of the cycle is the one thing that never comes back soon.
                next.epoch = Epoch(0);
                let pair = (next, next_witness);
                if !seen.contains(&pair) {
                    found.insert(pair);
                }
            }
        }
        found
    };
    let (mut seen, mut level, mut steps) = (HashSet::from([first.clone()]), vec![first], 0);
    while !level.is_empty() {
        steps += level.len() * inputs.len();
        let (one, other) = level.split_at(level.len() / 2);
        let found = std::thread::scope(|scope| {
            let other = scope.spawn(|| follow(other, &seen));
            [follow(one, &seen), other.join().expect("no difference")]
        });
        level = found.into_iter().flatten().filter(|pair| seen.insert(pair.clone())).collect();
    }
    println!("{} states, {steps} steps", seen.len());
    // Each state of the one goes with one of the other: neither forgets or remembers more.
    let kernel_states: HashSet<_> = seen.iter().map(|pair| pair.0).collect();
    assert_eq!(kernel_states.len(), seen.len());
    assert!(seen.len() > 500, "{} states", seen.len());
}
