//! The kernel's interlocking beside a second one, written from the text: random sessions on random stations, and every session on a
//! small one.

mod every;
mod stations;
mod traffic;
mod witness;

use std::collections::BTreeMap;

use atc_kernel::interlocking::{
    Heading, Input, Layout, Orders, Output, Phase, PointId, Rear, Refusal, Request, RouteId, RouteState, SegmentId,
    SpeedCode, State, Travel,
};
use atc_kernel::time::Ticks;
use atc_tests::sketch::{Sketch, circuits, positions, segments};
use proptest::prelude::*;

use stations::{Dice, Station};
use traffic::World;
use witness::{Ask, Behind, Held, Place, Read, Said, Set, Stage, Telegram, Witness};

/// Room for the random stations.
type Small = Layout<9, 6, 24, 2>;

fn list(set: &Set) -> Vec<usize> {
    set.iter().copied().collect()
}

fn numbers(bits: u64, below: usize) -> Set {
    (0..below.min(64)).filter(|number| bits >> number & 1 == 1).collect()
}

/// What is read, in the kernel's form.
fn input(read: &Read) -> Input {
    let small = |number: usize| u8::try_from(number).expect("small");
    let request = read.ask.map(|ask| match ask {
        Ask::Set(route) => Request::Set(RouteId::new(small(route)).expect("a route")),
        Ask::Withdraw(route) => Request::Withdraw(RouteId::new(small(route)).expect("a route")),
        Ask::Drive(point, position) => Request::Drive(PointId::new(small(point)).expect("a point"), position),
        Ask::Turn(segment, travel) => Request::Turn(SegmentId::new(small(segment)).expect("a segment"), travel),
    });
    let orders = Orders {
        block: circuits(&list(&read.commands.block)),
        unblock: circuits(&list(&read.commands.unblock)),
        restrict: circuits(&list(&read.commands.restrict)),
        speed: SpeedCode(read.commands.speed),
        lift: circuits(&list(&read.commands.lift)),
    };
    let (occupied, consent) = (circuits(&list(&read.occupied)), segments(&list(&read.consent)));
    Input { occupied, detected: positions(&read.detected), request, orders, consent }
}

/// A route of the witness as the kernel has it.
fn in_kernel_form(held: &Held) -> RouteState {
    let count = |done: &dyn Fn(&Place) -> bool| {
        u8::try_from(held.places.iter().filter(|place| done(place)).count()).expect("a short path")
    };
    let (phase, time) = match held.stage {
        Stage::Idle => (Phase::Idle, 0),
        Stage::Provisional(time) => (Phase::Provisional, time),
        Stage::Failed => (Phase::Failed, 0),
        Stage::Set => (Phase::Set, 0),
        Stage::InUse(time) => (Phase::InUse, time),
        Stage::Releasing(time) => (Phase::Releasing, time),
    };
    RouteState {
        phase,
        tail: count(&|place| *place == Place::Released),
        head: count(&|place| *place != Place::Ahead),
        overlap: held.overlap,
        proved: held.once_set,
        time: Ticks(time),
        rear: match held.behind {
            Behind::Approach => Rear::Approach,
            Behind::Entry => Rear::Entry,
            Behind::Nothing => Rear::Swept,
        },
        stood: Ticks(held.stood),
    }
}

/// Both have the same, or where they differ.
fn same<T: PartialEq + std::fmt::Debug>(what: &str, number: usize, kernel: &T, text: &T) -> Result<(), String> {
    if kernel == text { Ok(()) } else { Err(format!("{what} {number}: the kernel has {kernel:?}, the text {text:?}")) }
}

/// Compares a cycle of both, and says where they differ.
fn compare<const R: usize, const P: usize, const N: usize, const S: usize>(
    layout: &Layout<R, P, N, S>,
    sketch: &Sketch,
    (witness, said): (&Witness, &Said),
    (state, output): (&State<R, S>, &Output<R>),
) -> Result<(), String> {
    let count = sketch.lengths.len();
    for (number, (kernel, held)) in state.routes.iter().zip(&witness.routes).enumerate() {
        same("route", number, kernel, &in_kernel_form(held))?;
    }
    for (number, stretch) in witness.stretches.iter().enumerate() {
        let (toward, away) = (numbers(state.directions.toward.bits().into(), 8), state.directions.away.bits());
        let travel = match (toward.contains(&number), away >> number & 1 == 1) {
            (true, _) => Some(Travel::Toward),
            (false, away) => away.then_some(Travel::Away),
        };
        let time = state.directions.withdrawn[number].0;
        let came = state.directions.came.bits() >> number & 1 == 1;
        same("segment", number, &(travel, time, came), &(stretch.travel, stretch.withdrawn, stretch.came))?;
    }
    same("unswept", 0, &numbers(state.unswept.circuits.bits(), count), &witness.unswept.circuits)?;
    same("proceed", 0, &numbers(output.proceed.bits(), 64), &said.proceed)?;
    same("permits", 0, &numbers(output.permits.bits().into(), 8), &said.permits)?;
    same("confirmed", 0, &numbers(output.confirmed.bits(), count), &said.confirmed)?;
    let (normal, reverse) = (output.drives.normal.bits().into(), output.drives.reverse.bits().into());
    let side = |bits, normal| numbers(bits, 32).into_iter().map(move |point| (point, normal));
    let drives: std::collections::BTreeSet<_> = side(normal, true).chain(side(reverse, false)).collect();
    same("drives", 0, &drives, &said.drives)?;
    let agree = match (&output.answer, &said.answer) {
        (None, None) => true,
        (Some(Ok(())), Some(reasons)) => reasons.is_empty(),
        (Some(Err(refusal)), Some(reasons)) => reasons.contains(refusal),
        _ => false,
    };
    if !agree {
        return Err(format!(
            "the kernel answers {:?}, by the text there is {:?} against it",
            output.answer, said.answer
        ));
    }
    let telegrams = layout.telegrams(&output.table, state.epoch);
    for (circuit, movement) in telegrams.iter().enumerate() {
        let movement = movement.ok_or_else(|| format!("no telegram in circuit {circuit}"))?;
        let telegram = Telegram {
            stop: movement.stop.number().into(),
            leftward: movement.heading.map(|heading| heading == Heading::Left),
            speed: movement.speed.0,
            hold: numbers(movement.hold.bits(), 64),
        };
        same("telegram of circuit", circuit, &telegram, &said.telegrams[circuit])?;
    }
    if state.is_valid(layout) { Ok(()) } else { Err("the kernel's state is not valid".to_owned()) }
}

/// What sessions reached, for the test that they reach everything.
#[derive(Default)]
struct Reached(BTreeMap<String, u32>);

impl Reached {
    fn note(&mut self, what: impl Into<String>) {
        *self.0.entry(what.into()).or_default() += 1;
    }

    fn take_in(&mut self, before: &[Held], device: &Witness, said: &Said, output: &Output<9>) {
        for (old, new) in before.iter().zip(&device.routes) {
            let name = |held: &Held| format!("{:?}", held.stage).replace(|c: char| !c.is_alphabetic(), "");
            if name(old) != name(new) {
                self.note(format!("{} to {}", name(old), name(new)));
            }
            if old.behind != new.behind && old.once_set && new.is_held() {
                self.note(format!("rear {:?} to {:?}", old.behind, new.behind));
            }
            if old.overlap && !new.overlap && new.is_held() {
                self.note("overlap given up");
            }
            let released = |held: &Held| held.places.iter().filter(|place| **place == Place::Released).count();
            if new.is_held() && released(new) > released(old) {
                self.note("released behind a train");
            }
        }
        match output.answer {
            Some(Err(refusal)) => self.note(format!("{refusal:?}")),
            Some(Ok(())) => self.note("accepted"),
            None => {}
        }
        for telegram in &said.telegrams {
            match telegram.hold.len() {
                0 => {}
                1..4 => self.note("open over 1 to 3 circuits"),
                _ => self.note("open over 4 circuits or more"),
            }
        }
        if device.locked() > 1 {
            self.note("two routes at once");
        }
    }
}

/// A session of so many cycles on a station; both numbers make it what it is.
fn session(station: u64, running: u64, cycles: usize, reached: &mut Reached) -> Result<(), String> {
    let station = Station::random(&mut Dice(station | 1));
    let sketch = &station.sketch;
    let layout = Small::new(sketch.plan()).map_err(|broken| format!("{broken:?} in {sketch:#?}"))?;
    let mut dice = Dice(running | 1);
    let mut world = World::new(&station, &mut dice);
    let mut witness = Witness::new(sketch);
    let (mut state, mut last) = (State::INITIAL, None);
    for cycle in 0..cycles {
        let read = world.read(&station, &witness, last.as_ref(), &mut dice);
        let before = witness.routes.clone();
        let said = witness.cycle(sketch, &read);
        let (next, output) = layout.cycle(state, input(&read));
        compare(&layout, sketch, (&witness, &said), (&next, &output))
            .map_err(|what| format!("cycle {cycle}: {what}\n{read:?}\n{before:?}\n{sketch:?}"))?;
        reached.take_in(&before, &witness, &said, &output);
        state = next;
        last = Some(said);
    }
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(600))]

    #[test]
    fn the_kernel_does_what_the_text_says(station: u64, running: u64, cycles in 1..800_usize) {
        if let Err(what) = session(station, running, cycles, &mut Reached::default()) {
            return Err(TestCaseError::fail(what));
        }
    }
}

/// The sessions reach every phase, every reason to refuse, and trains that run through.
#[test]
fn the_sessions_are_lively() {
    let mut reached = Reached::default();
    let mut dice = Dice(0x9E37_79B9_7F4A_7C15);
    for _ in 0..300 {
        let seeds = (dice.below(1 << 30) as u64, dice.below(1 << 30) as u64);
        session(seeds.0, seeds.1, 500, &mut reached).unwrap_or_else(|what| panic!("{what}"));
    }
    let refusals = [
        Refusal::Unknown,
        Refusal::Starting,
        Refusal::AlreadyHeld,
        Refusal::NotHeld,
        Refusal::Conflict,
        Refusal::PathHeld,
        Refusal::OverlapHeld,
        Refusal::PointLocked,
        Refusal::Occupied,
        Refusal::NotCalledFor,
        Refusal::Unswept,
        Refusal::Blocked,
        Refusal::PointUnderTrain,
        Refusal::Direction,
        Refusal::Waiting,
    ];
    let expected = [
        "accepted",
        "Idle to Provisional",
        "Idle to Set",
        "Provisional to Set",
        "Provisional to Failed",
        "Provisional to Idle",
        "Provisional to Releasing",
        "Failed to Idle",
        "Failed to Releasing",
        "Set to Idle",
        "Set to InUse",
        "Set to Releasing",
        "InUse to Idle",
        "InUse to Releasing",
        "Releasing to Idle",
        "rear Approach to Entry",
        "rear Entry to Nothing",
        "overlap given up",
        "released behind a train",
        "open over 1 to 3 circuits",
        "open over 4 circuits or more",
        "two routes at once",
    ];
    let expected = expected.map(str::to_owned).into_iter().chain(refusals.map(|refusal| format!("{refusal:?}")));
    println!("150,000 cycles: {:#?}", reached.0);
    for what in expected {
        let times = reached.0.get(&what).copied().unwrap_or(0);
        assert!(times >= 1, "{what}: {times} times; reached were {:#?}", reached.0);
    }
}
