//! The shared table and the two channels: whatever bit is wrong, no train is told anything but stop.

use std::collections::BTreeSet;

use atc_kernel::Machine as _;
use atc_kernel::duplex::{Duplex, output};
use atc_kernel::interlocking::{
    CircuitId, CircuitSet, Combined, Contents, Epoch, Grant, Input, Layout, MAX_CIRCUITS, MAX_CODES, Memory, Movement,
    Orders, PerCircuit, PointId, Positions, Request, RouteId, SegmentId, SegmentSet, Small, SpeedCode, SpeedLimits,
    State, Table, Travel,
};
use atc_kernel::time::Ticks;
use atc_tests::sketch::{self, Line, Need, Sketch, Way};

/// `2 1 │ 0 3 │ 4 5`: from the line over circuits 0 and 3 to the line, without points but one.
fn station() -> Layout<2, 2, 1, 2> {
    let needs: Vec<Need> = vec![(0, atc_kernel::interlocking::Position::Normal)];
    let times = Way { drive: 4, release: 4, stay: 4, speed: 3, ..Way::default() };
    let sketch = Sketch {
        lengths: vec![200; 6],
        points: vec![vec![0]],
        routes: vec![Way {
            entry: 1,
            approach: vec![1],
            path: vec![(0, needs), (3, vec![])],
            beyond: vec![4],
            from: Some(0),
            to: Some(1),
            ..times
        }],
        segments: vec![
            Line { circuits: vec![1, 2], throat: None, leftward: true },
            Line { circuits: vec![4, 5], throat: Some(3), leftward: false },
        ],
        braking: vec![0, 100, 300, 700],
        clear: 1,
        turn: 1,
        ..Sketch::default()
    };
    Layout::new(sketch.plan()).expect("a station")
}

fn quiet(occupied: &[usize]) -> Input {
    Input {
        occupied: sketch::circuits(occupied),
        detected: sketch::positions(&[(0, atc_kernel::interlocking::Position::Normal)]),
        request: None,
        orders: Orders::default(),
        consent: SegmentSet::ALL,
    }
}

/// A train in circuit 1 before a route with proceed, and one on the line behind it.
fn inputs() -> Vec<Input> {
    let all = CircuitSet::ALL;
    let orders = Orders { unblock: all, lift: all, ..Orders::default() };
    let turn = |segment: u8, travel| Some(Request::Turn(SegmentId::new(segment).expect("a segment"), travel));
    vec![
        Input { orders, ..quiet(&[]) },
        Input { request: turn(0, Travel::Toward), ..quiet(&[]) },
        Input { request: turn(1, Travel::Away), ..quiet(&[]) },
        Input { request: Some(Request::Set(RouteId::ZERO)), ..quiet(&[1]) },
        quiet(&[1]),
    ]
}

fn in_service(layout: &Layout<2, 2, 1, 2>) -> (State<2, 2>, Table<2>) {
    let mut now = (State::INITIAL, Table::UNREADABLE);
    for input in inputs() {
        let (state, output) = layout.cycle(now.0, input);
        now = (state, output.table);
    }
    now
}

fn open(telegrams: &PerCircuit<Option<Movement>>) -> BTreeSet<u8> {
    telegrams
        .iter()
        .zip(0..)
        .filter(|(movement, _)| movement.is_some_and(|movement| movement.is_open()))
        .map(|(_, circuit)| circuit)
        .collect()
}

fn all_stop(telegrams: &PerCircuit<Option<Movement>>) -> bool {
    let mut stop = true;
    for (number, movement) in telegrams.iter().enumerate() {
        stop &= *movement == Some(Movement::stop_in(CircuitSet::<Small>::nth(number).first().expect("a circuit")));
    }
    stop
}

/// The limits with one bit changed.
fn limits(limits: SpeedLimits, code: usize, bit: u32) -> SpeedLimits {
    let mut parts = limits.parts();
    parts[code] = CircuitSet::from_bits(parts[code].bits() ^ 1 << bit);
    SpeedLimits::from_parts(parts)
}

/// Every bit of the contents, as a list of changes.
fn damaged(contents: Contents<2>) -> Vec<Contents<2>> {
    let mut all = Vec::new();
    let mut with = |change: &dyn Fn(&mut Contents<2>)| {
        let mut other = contents;
        change(&mut other);
        all.push(other);
    };
    let circuits = |set: CircuitSet, bit: u32| CircuitSet::from_bits(set.bits() ^ 1 << bit);
    let segments = |set: SegmentSet, bit: u32| SegmentSet::from_bits(set.bits() ^ 1 << bit);
    for bit in 0..64 {
        with(&|it| it.occupied = circuits(it.occupied, bit));
        with(&|it| it.blocked = circuits(it.blocked, bit));
        with(&|it| it.standing.loose = circuits(it.standing.loose, bit));
        for code in 0..MAX_CODES {
            with(&|it| it.standing.limits = limits(it.standing.limits, code, bit));
        }
        for route in 0..2 {
            with(&|it| it.standing.bodies[route] = circuits(it.standing.bodies[route], bit));
            with(&|it| it.grants[route].train = circuits(it.grants[route].train, bit));
            with(&|it| it.grants[route].circuits = circuits(it.grants[route].circuits, bit));
            with(&|it| it.grants[route].last = circuits(it.grants[route].last, bit));
        }
    }
    for bit in 0..8 {
        with(&|it| it.toward = segments(it.toward, bit));
        with(&|it| it.away = segments(it.away, bit));
        for route in 0..2 {
            with(&|it| it.grants[route].speed.0 ^= 1 << bit);
        }
    }
    for route in 0..2 {
        with(&|it| it.grants[route].complete ^= true);
    }
    all
}

#[test]
fn a_sound_table_of_this_cycle_opens() {
    let layout = station();
    let (state, table) = in_service(&layout);
    let telegrams = layout.telegrams(&table, state.epoch);
    assert_eq!(open(&telegrams), BTreeSet::from([1]));
    let movement = telegrams[1].expect("a telegram");
    assert_eq!((movement.stop.number(), movement.speed), (5, SpeedCode(3)));
    assert_eq!(movement.hold, sketch::circuits(&[0, 3, 4, 5]));
}

/// A table of any other cycle, the one before above all.
#[test]
fn a_stale_table_stops_every_train() {
    let layout = station();
    let (state, table) = in_service(&layout);
    for other in
        (0..=0x2_0000).chain((0..32).map(|bit| state.epoch.0 ^ 1 << bit)).filter(|epoch| *epoch != state.epoch.0)
    {
        assert_eq!(table.read(Epoch(other)), None);
    }
    assert!(all_stop(&layout.telegrams(&table, state.epoch.next())));
}

/// One wrong bit anywhere: contents, epoch or check.
#[test]
fn a_damaged_table_stops_every_train() {
    let layout = station();
    let (state, table) = in_service(&layout);
    let (epoch, check, contents) = table.parts();
    assert_eq!(Table::from_parts(epoch, check, contents), table);
    let mut tables: Vec<_> =
        damaged(contents).into_iter().map(|contents| Table::from_parts(epoch, check, contents)).collect();
    assert_eq!(tables.len(), 64 * (3 + MAX_CODES + 2 * 4) + 8 * (2 + 2) + 2, "every bit once");
    tables.extend((0..64).map(|bit| Table::from_parts(epoch, check ^ 1 << bit, contents)));
    for table in &tables {
        assert_eq!(table.read(state.epoch), None, "{table:?}");
    }
    assert!(all_stop(&layout.telegrams(&tables[0], state.epoch)));
    for bit in 0..32 {
        let wrong = Epoch(epoch.0 ^ 1 << bit);
        let table = Table::from_parts(wrong, check, contents);
        assert!(table.read(epoch).is_none() && table.read(wrong).is_none(), "bit {bit} of the epoch");
    }
}

#[test]
fn the_unreadable_table_is_unreadable_at_every_epoch() {
    for epoch in (0..=0x2_0000).chain((0..32).map(|bit| u32::MAX ^ 1 << bit)) {
        assert_eq!(Table::<2>::UNREADABLE.read(Epoch(epoch)), None);
        assert_eq!(Table::<64>::UNREADABLE.read(Epoch(epoch)), None);
    }
}

#[test]
fn nobody_knows_anything_at_power_on() {
    let layout = station();
    assert!(State::<2, 2>::INITIAL.is_valid(&layout));
    let (state, output) = layout.cycle(State::INITIAL, quiet(&[]));
    assert!(all_stop(&layout.telegrams(&output.table, state.epoch)));
    let (_, _, contents) = output.table.parts();
    assert_eq!((contents.blocked, contents.grants), (CircuitSet::ALL, [Grant::NONE; 2]));
}

/// Every single bit of one channel's memory.
fn flips(memory: Memory<2, 2>) -> Vec<Memory<2, 2>> {
    let state = memory.interlocking;
    let mut all: Vec<_> = (0..32).map(|bit| Memory { cycle: Epoch(memory.cycle.0 ^ 1 << bit), ..memory }).collect();
    let mut with = |change: &dyn Fn(&mut State<2, 2>)| {
        let mut other = state;
        change(&mut other);
        all.push(Memory { interlocking: other, ..memory });
    };
    for bit in 0..32 {
        with(&|it| it.epoch.0 ^= 1 << bit);
    }
    for bit in 0..64 {
        with(&|it| it.works.blocked = CircuitSet::from_bits(it.works.blocked.bits() ^ 1 << bit));
        with(&|it| it.works.confirmed = CircuitSet::from_bits(it.works.confirmed.bits() ^ 1 << bit));
        for code in 0..MAX_CODES {
            with(&|it| it.works.restrictions = limits(it.works.restrictions, code, bit));
        }
    }
    for bit in 0..8 {
        with(&|it| it.directions.toward = SegmentSet::from_bits(it.directions.toward.bits() ^ 1 << bit));
        with(&|it| it.directions.away = SegmentSet::from_bits(it.directions.away.bits() ^ 1 << bit));
        for circuit in 0..MAX_CIRCUITS {
            with(&|it| {
                let mut clear_for = it.track.clear_for();
                clear_for[circuit] ^= 1 << bit;
                it.track = atc_kernel::interlocking::Track::from_parts(clear_for);
            });
        }
        for route in 0..2 {
            with(&|it| it.routes[route].tail ^= 1 << bit);
            with(&|it| it.routes[route].head ^= 1 << bit);
        }
    }
    let flip = |ticks: Ticks, bit: u32| Ticks(ticks.0 ^ 1 << bit);
    for bit in 0..16 {
        for place in 0..2 {
            with(&|it| it.directions.withdrawn[place] = flip(it.directions.withdrawn[place], bit));
            with(&|it| it.routes[place].time = flip(it.routes[place].time, bit));
            with(&|it| it.routes[place].stood = flip(it.routes[place].stood, bit));
        }
    }
    for route in 0..2 {
        with(&|it| it.routes[route].overlap ^= true);
        with(&|it| it.routes[route].proved ^= true);
        for phase in [
            atc_kernel::interlocking::Phase::Idle,
            atc_kernel::interlocking::Phase::Provisional,
            atc_kernel::interlocking::Phase::Failed,
            atc_kernel::interlocking::Phase::Set,
            atc_kernel::interlocking::Phase::InUse,
            atc_kernel::interlocking::Phase::Releasing,
        ] {
            if state.routes[route].phase != phase {
                with(&|it| it.routes[route].phase = phase);
            }
        }
    }
    all
}

/// One wrong bit in one channel: everything at stop in the same cycle, and until a reset.
#[test]
fn a_wrong_bit_in_one_channel_stops_every_train() {
    let layout = station();
    let device = Combined(&layout);
    let mut sound = Duplex::initial(&device);
    for input in inputs() {
        sound = sound.step(&device, input).0;
    }
    let (_, agreed) = sound.step(&device, quiet(&[1]));
    let said = output::<Combined<2, 2, 1, 2>>(agreed);
    assert!(said.interlocking.proceed.has(RouteId::ZERO), "two sound channels open the route");
    assert_eq!(open(&said.telegrams), BTreeSet::from([1]), "and tell the train");
    let flips = flips(sound.a.state);
    println!("{} wrong states", flips.len());
    for state in flips {
        assert_ne!(state, sound.a.state);
        for wrong_is_a in [true, false] {
            let mut channels = sound;
            if wrong_is_a {
                channels.a.state = state;
            } else {
                channels.b.state = state;
            }
            for _ in 0..2 {
                let (next, agreed) = channels.step(&device, quiet(&[1]));
                let said = output::<Combined<2, 2, 1, 2>>(agreed);
                assert_eq!(said, Combined::<2, 2, 1, 2>::SAFE, "{state:?}");
                assert_eq!(said.telegrams, PerCircuit::NONE);
                channels = next;
            }
            assert!(channels.is_tripped());
        }
    }
    assert_eq!(Positions::NONE, Layout::<2, 2, 1, 2>::SAFE.drives);
}

#[test]
fn each_of_64_numbers_has_a_set_of_its_own() {
    for number in 0..64_u8 {
        let circuit = CircuitId::new(number).unwrap();
        assert_eq!(circuit.number(), number);
        let alone: CircuitSet = circuit.alone();
        assert_eq!(alone.bits(), 1 << number);
        assert_eq!(CircuitSet::nth(usize::from(number)), alone);
        assert_eq!(alone.first(), Some(circuit));
        assert!(alone.is_one());
        for other in 0..64_u8 {
            let other = CircuitId::new(other).unwrap();
            assert_eq!(alone.has(other), circuit == other);
        }
    }
    assert_eq!(PointId::new(128), None);
    assert!(CircuitId::new(64).unwrap().alone::<Small>().is_empty(), "a small station has no such circuit");
}
