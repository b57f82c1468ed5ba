//! What the kernel reads becomes a step on the wire, and the step is read as the same input again.
//! So do parameters and plans.

use atc_kernel::aspect::{AspectId, AspectSet, AspectTable};
use atc_kernel::block::{Block, Hold, Input as Counting, SectionSet, TrainCount};
use atc_kernel::distance::{Metres, Millimetres};
use atc_kernel::interlocking::{
    CircuitSet, Input, Orders, PointId, Position, Positions, Request, RouteId, SegmentId, SegmentSet, Size, SpeedCode,
    Travel,
};
use atc_kernel::pattern::Deceleration;
use atc_kernel::permitted::{Heard, LineKind, Permitted, Settings};
use atc_kernel::speed::KmhTenths;
use atc_kernel::telegram::{Counter, Gradient, Length, Main, Route, SectionId, Sequence, Sub};
use atc_kernel::time::{Millis, Ticks};
use atc_protocol::Kmh;
use atc_protocol::machine::aspect::{self, Aspect};
use atc_protocol::machine::block::{self, Counted};
use atc_protocol::machine::interlocking::{Config, Heading, Interlocked, Phase, Reason, Side, Travel as Direction};
use atc_protocol::machine::permitted::{self, Permitting};
use atc_protocol::machine::{Machine, config_of, step_of};
use atc_protocol::names::Named;
use proptest::collection::vec;
use proptest::option;
use proptest::prelude::*;
use serde::Serialize;
use serde_json::value::RawValue;
use std::path::Path;

const CYCLE: Millis = Millis(40);

fn line(message: &impl Serialize) -> Box<RawValue> {
    serde_json::value::to_raw_value(message).expect("a message is plain data")
}

/// The step as it arrives at the other end of the wire.
fn sent<M: Machine>(step: &M::Step) -> M::Step {
    let line = line(step);
    step_of::<M>(line.get(), &line).expect("a step")
}

/// The machine that is opened at the other end of the wire.
fn opened<M: Machine>(config: &M::Config) -> M {
    let line = line(config);
    M::open(&config_of::<M>(line.get(), &line).expect("a configuration")).expect("it keeps every rule")
}

/// Speeds of a line, strictly rising.
fn speeds() -> impl Strategy<Value = AspectTable> {
    proptest::collection::btree_set(any::<u16>(), 1..=16).prop_map(|speeds| {
        let speeds: Vec<_> = speeds.into_iter().map(KmhTenths).collect();
        AspectTable::new(&speeds).expect("a table")
    })
}

fn rank() -> impl Strategy<Value = AspectId> {
    (0..16_u8).prop_map(|rank| AspectId::new(rank).expect("a rank"))
}

fn main_telegram() -> impl Strategy<Value = Main> {
    (any::<u16>(), any::<u8>(), any::<Option<u16>>(), rank()).prop_map(|(section, counter, beyond, speed)| {
        let route = beyond.map_or(Route::Closed, |metres| Route::OpenFor(Metres(metres)));
        Main { section: SectionId(section), counter: Counter(counter), route, speed }
    })
}

fn sub_telegram() -> impl Strategy<Value = Sub> {
    let numbers = (any::<u16>(), any::<u8>(), 1..=u16::MAX, any::<i8>());
    (numbers, rank(), rank()).prop_map(|((section, counter, length, gradient), curve, restriction)| Sub {
        section: SectionId(section),
        counter: Counter(counter),
        length: Length::new(Metres(length)).expect("a length"),
        gradient: Gradient(gradient),
        curve,
        restriction,
    })
}

fn heard() -> impl Strategy<Value = Heard> {
    let lengths = (any::<Option<u32>>(), any::<u32>());
    let telegrams = (option::of(main_telegram()), option::of(sub_telegram()));
    (any::<Option<bool>>(), any::<Option<u16>>(), telegrams, lengths).prop_map(
        |(digital, analog, (main, sub), (to_exit, moved))| Heard {
            line: digital.map(|digital| if digital { LineKind::Digital } else { LineKind::Analog }),
            analog: analog.map(KmhTenths),
            main,
            sub,
            to_exit: to_exit.map(Millimetres),
            moved: Millimetres(moved),
        },
    )
}

fn device() -> impl Strategy<Value = Permitted> {
    let lives = (1..1000_u16, 0..1000_u16, 1..1000_u16, 1..1000_u16);
    let counters = (1..=127_u8, 1..=15_u8);
    (speeds(), any::<prop::sample::Index>(), 1..4096_u16, any::<i8>(), any::<u16>(), lives, counters).prop_map(
        |(speeds, lowest, brake, worst, margin, (fresh, more, fixed_life, memory), (window, run))| {
            let lowest = u8::try_from(lowest.index(speeds.speeds().len())).expect("a rank");
            let life = fresh + more;
            let memory = Ticks(memory.min(life).min(fixed_life));
            let settings = Settings {
                speeds,
                lowest: AspectId::new(lowest).expect("a rank"),
                brake: Deceleration::brake(brake).expect("a brake"),
                worst: Gradient(worst),
                margin: Metres(margin),
                fresh: Ticks(fresh),
                life: Ticks(life),
                fixed_life: Ticks(fixed_life),
                sequence: Sequence::new(window, run, memory).expect("a sequence"),
            };
            Permitted::new(settings).expect("parameters that keep every rule")
        },
    )
}

fn block() -> impl Strategy<Value = Block> {
    (1..=16_u8, 1..=16_u8, 0..=16_u8, 1..=1000_u16).prop_map(|(sections, trains, hold, pass)| {
        let hold = Hold::new(hold).expect("a hold");
        Block::new(sections, trains.min(sections), hold, Ticks(pass)).expect("a block")
    })
}

fn counting() -> impl Strategy<Value = Counting> {
    let levels = (any::<bool>(), any::<bool>(), any::<bool>());
    (levels, any::<u16>(), any::<Option<u8>>(), 0..=16_u8).prop_map(
        |((check_in, check_out, ahead_entered), present, reset, hold)| Counting {
            check_in,
            check_out,
            present: SectionSet::from_bits(present),
            reset: reset.map(TrainCount),
            ahead_hold: Hold::new(hold).expect("a hold"),
            ahead_entered,
        },
    )
}

/// The numbers of what is in a set, of so many.
fn some(all: usize) -> impl Strategy<Value = Vec<usize>> {
    vec(any::<bool>(), all).prop_map(|there| (0..).zip(there).filter_map(|(number, is)| is.then_some(number)).collect())
}

fn circuits<Z: Size>(all: usize) -> impl Strategy<Value = CircuitSet<Z>> {
    let or = |set: CircuitSet<Z>, number| set.or(CircuitSet::nth(number));
    some(all).prop_map(move |numbers| numbers.into_iter().fold(CircuitSet::EMPTY, or))
}

fn positions<Z: Size>(all: usize) -> impl Strategy<Value = Positions<Z>> {
    vec(any::<Option<bool>>(), all).prop_map(|lies| {
        (0..).zip(lies).fold(Positions::NONE, |all, (point, lies)| match lies {
            None => all,
            Some(normal) => all.or(Positions::of(PointId::new(point).expect("a point"), position(normal))),
        })
    })
}

const fn position(normal: bool) -> Position {
    if normal { Position::Normal } else { Position::Reverse }
}

/// Requests of what there is: as many routes, points and segments; there are some of each.
fn request([routes, points, segments]: [u8; 3]) -> impl Strategy<Value = Request> {
    prop_oneof![
        (0..routes).prop_map(|route| Request::Set(RouteId::new(route).expect("a route"))),
        (0..routes).prop_map(|route| Request::Withdraw(RouteId::new(route).expect("a route"))),
        (0..points, any::<bool>())
            .prop_map(|(point, normal)| Request::Drive(PointId::new(point).expect("a point"), position(normal))),
        (0..segments, any::<bool>()).prop_map(|(segment, away)| {
            let to = if away { Travel::Away } else { Travel::Toward };
            Request::Turn(SegmentId::new(segment).expect("a segment"), to)
        }),
    ]
}

/// Inputs of a station, which restrict to one of so many speeds.
fn input<Z: Size>(all: usize, there: [u8; 3], speeds: u8) -> impl Strategy<Value = Input<Z>> {
    let orders = (circuits(all), circuits(all), circuits(all), circuits(all), 0..speeds);
    let orders = orders.prop_map(|(block, unblock, restrict, lift, speed): (CircuitSet<Z>, _, CircuitSet<Z>, _, _)| {
        // A speed that restricts nothing says nothing.
        let speed = SpeedCode(if restrict.is_empty() { 0 } else { speed });
        Orders { block, unblock, restrict, speed, lift }
    });
    let consent = some(there[2].into()).prop_map(|numbers| {
        numbers.into_iter().fold(SegmentSet::EMPTY, |all: SegmentSet<Z>, number| all.or(SegmentSet::nth(number)))
    });
    (circuits(all), positions(there[1].into()), option::of(request(there)), orders, consent).prop_map(
        |(occupied, detected, request, orders, consent)| Input { occupied, detected, request, orders, consent },
    )
}

/// The layout of a file, the plan of it, and the machine on that plan.
fn station<const R: usize, const P: usize, const N: usize, const S: usize, Z: Size>(
    file: &str,
) -> Interlocked<R, P, N, S, Z> {
    let path = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../layouts")).join(file);
    let of_file: Interlocked<R, P, N, S, Z> =
        Interlocked::open(&Config::from(atc_layout::read(path).expect("a layout"))).expect("it keeps every rule");
    let of_plan: Interlocked<R, P, N, S, Z> = opened(&of_file.plan_config());
    assert_eq!(of_plan.layout(), of_file.layout(), "{file}");
    assert_eq!(of_plan.names().routes, of_file.names().routes, "{file}");
    assert_eq!(of_plan.cycle_ms(), of_file.cycle_ms(), "{file}");
    for code in (0..8).map(SpeedCode) {
        assert_eq!(of_plan.speed(code), of_file.speed(code), "{file}, {code:?}");
    }
    of_plan
}

/// A plan is read as it was written, and so is every input.
fn the_same<const R: usize, const P: usize, const N: usize, const S: usize, Z: Size>(file: &str) {
    let machine: Interlocked<R, P, N, S, Z> = station(file);
    let names = machine.names();
    let there = [&names.routes, &names.points, &names.segments].map(|names| u8::try_from(names.len()).expect("few"));
    let speeds =
        (0..8).filter(|code| *code == 0 || machine.speed(SpeedCode(*code)) > machine.speed(SpeedCode(code - 1)));
    let inputs = input(names.circuits.len(), there, u8::try_from(speeds.count()).expect("few"));
    proptest!(ProptestConfig::with_cases(64), |(input in inputs)| {
        let step = sent::<Interlocked<R, P, N, S, Z>>(&machine.step_of(&input));
        prop_assert_eq!(machine.input(&step), Ok(input));
    });
}

#[test]
fn plans_and_inputs_of_small_stations() {
    for file in ["junction.toml", "passing-loop.toml", "terminus.toml", "station-30.toml"] {
        the_same::<64, 16, 32, 8, atc_kernel::interlocking::Small>(file);
    }
}

#[test]
fn plans_and_inputs_of_large_stations() {
    let large = || {
        for file in ["station-100.toml", "central.toml"] {
            the_same::<256, 32, 128, 32, atc_kernel::interlocking::Large>(file);
        }
    };
    // Its layout has half a megabyte, and is moved some times.
    let thread = std::thread::Builder::new().stack_size(64 << 20).spawn(large).expect("a thread");
    thread.join().expect("the same");
}

proptest! {
    #[test]
    fn aspects(table in speeds(), heard in any::<u16>()) {
        let config = aspect::Config::with_defaults(table.speeds().iter().copied().map(Kmh::from).collect());
        let machine: Aspect = opened(&config);
        prop_assert_eq!(machine.table(), &table);
        let known = u16::try_from((1_u32 << table.speeds().len()) - 1).expect("16 aspects");
        let step = sent::<Aspect>(&aspect::Step::of(&table, AspectSet::from_bits(heard)));
        prop_assert_eq!(machine.detected(&step), Ok(AspectSet::from_bits(heard & known)));
    }

    #[test]
    fn blocks(block in block(), input in counting()) {
        let machine: Counted = opened(&block::Config::of(block, CYCLE));
        prop_assert_eq!(machine.block(), block);
        let there = Counting { present: input.present.and(block.all()), ..input };
        prop_assert_eq!(machine.input(&sent::<Counted>(&block::Step::of(block, input))), Ok(there));
    }

    #[test]
    fn permissions(device in device(), heard in heard()) {
        let machine: Permitting = opened(&permitted::Config::of(&device, CYCLE));
        prop_assert_eq!(machine.permitted(), &device);
        prop_assert_eq!(sent::<Permitting>(&heard.into()).heard(), Ok(heard));
    }
}

/// The kernel's own name of a value, as the wire writes names.
fn kebab(value: &impl std::fmt::Debug) -> String {
    let name = format!("{value:?}");
    let letters = name.char_indices().flat_map(|(place, letter)| {
        let dash = (place > 0 && letter.is_uppercase()).then_some('-');
        dash.into_iter().chain(letter.to_lowercase())
    });
    letters.collect()
}

/// The models write their traces by the same words as the oracle: so nothing else would see that two are mixed up.
#[test]
fn every_word_of_the_interlocking_is_the_kernels_name() {
    fn same<W: Named, K: std::fmt::Debug>(kernel: impl Fn(W) -> K, words: usize) {
        assert_eq!(W::EVERY.len(), words, "{}", W::WHAT);
        for word in W::EVERY {
            assert_eq!(word.name(), kebab(&kernel(*word)), "{}", W::WHAT);
        }
    }
    same(|word: Phase| word.0, 6);
    same(|word: Reason| word.0, 15);
    same(|word: Heading| word.0, 2);
    same(|word: Direction| word.0, 2);
    same(|word: Side| word.0, 2);
}
