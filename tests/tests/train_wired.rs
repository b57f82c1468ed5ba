//! The on-board device against a glue of its own: the parts' own steps put together once more, straight from `spec/train.md`, on a ride over
//! sections with lost, damaged and misplaced signals. Each wrong glue that a user has made, or could make, is found out on the same ride.
//! And the device in two channels, with every bit of one channel's state wrong in turn.

use atc_kernel::Machine;
use atc_kernel::aspect::{self, Acceptance, AspectId, AspectSet, AspectTable, Times};
use atc_kernel::code::{CodeFrequencies, CodeTable, MAX_CODES, Millihertz};
use atc_kernel::distance::{Metres, Millimetres};
use atc_kernel::duplex::{Duplex, output};
use atc_kernel::heading::Heading;
use atc_kernel::pattern::Deceleration;
use atc_kernel::permitted::{self, Basis, Fixed, Heard, LineKind, Permitted, Settings, Target};
use atc_kernel::position::{self, Correction, Interval, Measured, Millibels, Moved, Position, Spacing, Table};
use atc_kernel::speed::{KmhTenths, RawKmhTenths};
use atc_kernel::supervision::{self, Brake, Speeds, Supervision};
use atc_kernel::telegram::{
    Counter, Frame, Gradient, Header, Length, Main, Route, SectionId, Sequence, Stream, Sub, Telegram, decode, encode,
};
use atc_kernel::time::Ticks;
use atc_kernel::train::{Antennas, Cab, Carrier, Parts, State, Train, TrainError};
use std::collections::BTreeMap;

/// The line's speeds.
const SPEEDS: [u16; 5] = [0, 150, 450, 650, 900];

/// The length of a section.
const SECTION_MM: i64 = 120_000;

type Device = Train<5>;

fn speeds() -> AspectTable {
    AspectTable::new(&SPEEDS.map(KmhTenths)).unwrap()
}

fn codes(speeds: [u16; 5]) -> CodeTable {
    let carrier = |first: u32| {
        let nominal: Vec<_> = (0..5).map(|place| Millihertz(first + 6000 * place)).collect();
        CodeFrequencies::new(&nominal, Millihertz(1000)).unwrap()
    };
    let mut named = [[None; MAX_CODES]; MAX_CODES];
    for (place, speed) in speeds.into_iter().enumerate() {
        named[place][place] = Some(KmhTenths(speed));
    }
    CodeTable::new(carrier(10_000), carrier(12_000), named).unwrap()
}

fn permitted(fresh: u16, life: u16) -> Permitted {
    let settings = Settings {
        speeds: speeds(),
        lowest: AspectId::new(1).unwrap(),
        brake: Deceleration::brake(1000).unwrap(),
        worst: Gradient(-20),
        margin: Metres(10),
        fresh: Ticks(fresh),
        life: Ticks(life),
        fixed_life: Ticks(200),
        sequence: Sequence::new(3, 1, Ticks(20)).unwrap(),
    };
    Permitted::new(settings).unwrap()
}

fn parts() -> Parts<5> {
    let lowest = core::array::from_fn(|knot| Millibels(i16::try_from(knot).unwrap() * 128));
    let highest = lowest.map(|level: Millibels| Millibels(level.0 + 20));
    let table = Table::new(Spacing::new(7).unwrap(), lowest, highest).unwrap();
    Parts {
        codes: codes(SPEEDS),
        acceptance: Acceptance { times: Times::from_ticks(Ticks(3), Ticks(4), Ticks(4), Ticks(7), Ticks(1)).unwrap() },
        permitted: permitted(12, 30),
        supervision: Supervision::new(KmhTenths(1500), KmhTenths(5)).unwrap(),
        position: Position::new(table, Millibels(5), Millibels(-3000), Correction::NONE),
    }
}

/// A wrong glue.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Wrong {
    /// The code counts as soon as it is measured.
    Unaccepted,
    /// The rank of a code is its place among the codes.
    OtherTable,
    /// A telegram counts on either carrier.
    Carrier,
    /// The far end of the interval is the distance to the exit.
    Farthest,
    /// The interval is carried over a change of section.
    Carried,
    /// The least movement is taken off distances.
    Least,
    /// A movement backwards is a movement forwards.
    Cast,
    /// A train without an odometer stands.
    Standing,
    /// No permission is a permission of 0.
    Zero,
    /// The permission of the cycle before is supervised.
    Late,
    /// Telegrams for the other direction of travel count.
    Against,
    /// Telegrams count before the direction of travel is known.
    Unknown,
    /// What was known is kept when the train changes ends.
    Kept,
    /// A train that may not run is released at a stand.
    Creeps,
}

const WRONG: [Wrong; 14] = [
    Wrong::Unaccepted,
    Wrong::OtherTable,
    Wrong::Carrier,
    Wrong::Farthest,
    Wrong::Carried,
    Wrong::Least,
    Wrong::Cast,
    Wrong::Standing,
    Wrong::Zero,
    Wrong::Late,
    Wrong::Against,
    Wrong::Unknown,
    Wrong::Kept,
    Wrong::Creeps,
];

/// One cycle of the parts, in the order of the picture in `spec/train.md`; `last` is what was permitted before.
fn glue(
    parts: &Parts<5>,
    state: State<5>,
    seen: Antennas,
    wrong: Option<Wrong>,
    last: Option<KmhTenths>,
) -> (State<5>, Cab) {
    let table = parts.permitted.settings().speeds;
    let is = |kind| wrong == Some(kind);
    // TRN-12.
    let kept = state.facing == seen.facing || is(Wrong::Kept);
    let state = if kept { state } else { State::INITIAL };
    // TRN-1, TRN-2: a pair names a speed, the speed has a rank, the rank is detected; what is displayed has a speed again.
    let pair = match (seen.main.code, seen.sub.code) {
        (Some(main), Some(sub)) => (parts.codes.main().identify(main), parts.codes.sub().identify(sub)),
        _ => (None, None),
    };
    let named = parts.codes.speed(pair.0, pair.1);
    let rank = if is(Wrong::OtherTable) {
        pair.0.and_then(|code| AspectId::new(code.place() + 1)).filter(|_| named.is_some())
    } else {
        named.and_then(|speed| (0..5).filter_map(AspectId::new).find(|rank| table.speed(*rank) == Some(speed)))
    };
    let detected = AspectSet::from_bits(rank.map_or(0, |rank| 1 << rank.rank()));
    let (acceptance, shown) = aspect::step(parts.acceptance.times, state.acceptance, detected);
    let display = shown.aspect().map(|aspect| SPEEDS[usize::from(aspect.rank())]).map(KmhTenths);
    let analog = if is(Wrong::Unaccepted) { named } else { display };

    // TRN-3.
    let read = |frame: Option<Frame>| frame.and_then(|frame| decode(frame).ok());
    let (on_main, on_sub) = (read(seen.main.frame), read(seen.sub.frame));
    let either = [on_main, on_sub].into_iter().flatten();
    let mut main = None;
    let mut sub = None;
    for telegram in either.clone() {
        match telegram {
            Telegram::Main(told) if on_main == Some(telegram) || is(Wrong::Carrier) => main = Some(told),
            Telegram::Sub(told) if on_sub == Some(telegram) || is(Wrong::Carrier) => sub = Some(told),
            _ => {}
        }
    }
    // TRN-11: odd is left.
    let ahead = |section: SectionId| match seen.facing {
        Some(Heading::Left) => section.0 & 1 == 1 || is(Wrong::Against),
        Some(Heading::Right) => section.0 & 1 == 0 || is(Wrong::Against),
        None => is(Wrong::Unknown),
    };
    let main = main.filter(|main| main.speed.rank() < 5 && ahead(main.section));
    let sub = sub.filter(|sub| sub.curve.rank() < 5 && sub.restriction.rank() < 5 && ahead(sub.section));

    // TRN-5, TRN-6, TRN-4, TRN-9.
    let anything = if is(Wrong::Standing) { Moved::STANDING } else { Moved::new(i16::MIN, i16::MAX).unwrap() };
    let moved = seen.moved.unwrap_or(anything);
    let last_section = state.permitted.main_stream.last.map(|last| last.section);
    let same = main.is_none_or(|main| Some(main.section) == last_section) || is(Wrong::Carried);
    let measured = Measured { first: seen.first, second: seen.second, moved };
    let before = if same { state.position } else { None };
    let place = position::step(parts.position.as_ref().unwrap(), before, measured);
    let end = |interval: Interval| if is(Wrong::Farthest) { interval.farthest() } else { interval.nearest() };
    let forward = if is(Wrong::Least) {
        u32::try_from(moved.least()).unwrap_or(0)
    } else if is(Wrong::Cast) {
        u32::from(moved.most().unsigned_abs())
    } else {
        u32::try_from(moved.most()).unwrap_or(0)
    };
    let heard = Heard { line: seen.line, analog, main, sub, to_exit: place.map(end), moved: Millimetres(forward) };
    let (permitted, permission) = permitted::step(&parts.permitted, state.permitted, heard);

    // TRN-7.
    let supervised = if is(Wrong::Late) { last } else { permission.speed };
    let permitted_speed = match supervised {
        None if is(Wrong::Zero) => Some(0),
        speed => speed.map(|speed| i32::from(speed.0)),
    };
    let given = Speeds { measured: seen.speed, permitted: permitted_speed.map(RawKmhTenths) };
    // TRN-13.
    let stands = permission.speed == Some(KmhTenths(0)) && !is(Wrong::Creeps);
    let brake = supervision::step(parts.supervision, state.brake, given).max(if stands {
        Brake::Service
    } else {
        Brake::Release
    });
    let facing = seen.facing;
    (
        State { acceptance, permitted, position: place, brake, facing },
        Cab { display, permission, position: place, brake },
    )
}

/// Numbers that look random, always the same ones.
struct Dice(u64);

impl Dice {
    fn below(&mut self, end: u64) -> u64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) % end
    }

    fn one_in(&mut self, number: u64) -> bool {
        self.below(number) == 0
    }
}

/// A ride: where the train is, and what it hears there.
struct Ride {
    dice: Dice,
    place: i64,
    speed: i64,
    cycle: u64,
    counters: [u8; 2],
    /// Until this cycle nothing is heard.
    silent: u64,
    /// Until this cycle no code is heard.
    uncoded: u64,
    code: usize,
    /// How the train faces, as far as it is known.
    facing: Option<Heading>,
}

impl Ride {
    fn new(seed: u64) -> Self {
        let (dice, facing) = (Dice(seed), Some(Heading::Left));
        Self { dice, place: 0, speed: 12_000, cycle: 0, counters: [0; 2], silent: 0, uncoded: 0, code: 4, facing }
    }

    /// One cycle of 100 ms.
    fn next(&mut self) -> Antennas {
        let dice = &mut self.dice;
        self.cycle += 1;
        self.speed = (self.speed + i64::try_from(dice.below(801)).unwrap() - 400).clamp(-2000, 25_000);
        let by = self.speed / 10;
        self.place += by;
        if dice.one_in(if self.facing.is_some() { 400 } else { 40 }) {
            self.facing = [Some(Heading::Left), Some(Heading::Right), None][usize::try_from(dice.below(3)).unwrap()];
        }
        // The ground speaks to trains of both directions; now and then this one hears what is for the other.
        let left = (self.facing != Some(Heading::Right)) != dice.one_in(12);
        let number = u16::try_from(self.place.div_euclid(SECTION_MM).rem_euclid(50)).unwrap();
        let section = SectionId(2 * number + u16::from(left));
        let to_exit = SECTION_MM - self.place.rem_euclid(SECTION_MM);
        if dice.one_in(300) {
            self.silent = self.cycle + dice.below(60);
        }
        if dice.one_in(120) {
            self.uncoded = self.cycle + dice.below(25);
        }
        if dice.one_in(50) {
            self.code = usize::try_from(dice.below(5)).unwrap();
        }
        let heard = self.cycle >= self.silent;

        // A code of both carriers, now and then another one, off its band, or on one carrier alone.
        let place = if dice.one_in(25) { dice.below(5) } else { self.code as u64 };
        let mut frequency = |first: u32, there: bool| {
            let off = if dice.one_in(40) { 2500 } else { 0 };
            let there = there && !dice.one_in(30);
            there.then(|| Millihertz(first + 6000 * u32::try_from(place).unwrap() + off))
        };
        let coded = heard && self.cycle >= self.uncoded;
        let codes = [frequency(10_000, coded), frequency(12_000, coded)];

        // Telegrams of both streams in turn; damaged, on the wrong carrier, or with an unknown rank now and then.
        let ranks = if dice.one_in(25) { 7 } else { 5 };
        let mut rank = || AspectId::new(u8::try_from(dice.below(ranks)).unwrap()).unwrap();
        let (speed, curve, restriction) = (rank(), rank(), rank());
        let mut telegram = None;
        match self.cycle % 6 {
            0 => {
                self.counters[0] = self.counters[0].wrapping_add(1);
                let route = match dice.below(3) {
                    0 => Route::Closed,
                    1 => Route::OpenFor(Metres(400)),
                    _ => Route::OpenFor(Metres(50)),
                };
                telegram = Some(Telegram::Main(Main { section, counter: Counter(self.counters[0]), route, speed }));
            }
            3 => {
                self.counters[1] = self.counters[1].wrapping_add(1);
                let (length, gradient) = (Length::new(Metres(120)).unwrap(), Gradient(-5));
                let counter = Counter(self.counters[1]);
                telegram = Some(Telegram::Sub(Sub { section, counter, length, gradient, curve, restriction }));
            }
            _ => {}
        }
        let mut frames = [None; 2];
        if let (Some(telegram), true) = (telegram, heard) {
            let mut bits = encode(telegram).bits();
            if dice.one_in(15) {
                bits ^= 1 << dice.below(106);
            }
            let own = usize::from(matches!(telegram, Telegram::Sub(_)));
            frames[if dice.one_in(12) { 1 - own } else { own }] = Some(Frame::from_bits(bits));
        }

        // 1 mB a decimetre, and up to 20 mB more.
        let level = to_exit / 100 + i64::try_from(dice.below(21)).unwrap();
        let slack = i64::try_from(dice.below(60)).unwrap();
        let [least, most] = [by - slack, by + slack].map(|by| i16::try_from(by).unwrap());
        let levels = heard && !dice.one_in(20);
        let told = if dice.one_in(2) { LineKind::Digital } else { LineKind::Analog };
        Antennas {
            main: Carrier { code: codes[0], frame: frames[0] },
            sub: Carrier { code: codes[1], frame: frames[1] },
            first: levels.then(|| Millibels(i16::try_from(level).unwrap())),
            second: levels.then_some(Millibels(0)),
            moved: if dice.one_in(40) { None } else { Moved::new(least, most) },
            speed: if dice.one_in(200) {
                None
            } else {
                Some(RawKmhTenths(i32::try_from(self.speed * 36 / 1000).unwrap()))
            },
            line: dice.one_in(90).then_some(told),
            facing: self.facing,
        }
    }
}

const CYCLES: u64 = 40_000;

#[test]
fn the_device_is_what_its_parts_make_of_the_spec() {
    let parts = parts();
    let train = Device::new(parts).unwrap();
    let mut seen: BTreeMap<String, u64> = BTreeMap::new();
    for seed in [3, 17, 99] {
        let mut ride = Ride::new(seed);
        let (mut device, mut glued) = (train.initial(), State::INITIAL);
        for cycle in 0..CYCLES {
            let antennas = ride.next();
            let (next, cab) = train.step(device, antennas);
            let (other, by_hand) = glue(&parts, glued, antennas, None, None);
            assert_eq!(cab, by_hand, "ride {seed}, cycle {cycle}: {antennas:?}");
            assert_eq!(next, other, "ride {seed}, cycle {cycle}: {antennas:?}");
            assert!(next.is_valid(&train), "ride {seed}, cycle {cycle}: {next:?}");
            assert!(cab.brake != Brake::Release || cab.permission.speed.is_some());
            *seen.entry(format!("{:?}", cab.permission.basis)).or_default() += 1;
            *seen.entry(format!("{:?}", cab.brake)).or_default() += 1;
            *seen.entry(format!("position {}", cab.position.is_some())).or_default() += 1;
            (device, glued) = (next, other);
        }
    }
    // The ride is no idle one: each basis and each command occurs.
    for basis in [Basis::Nothing, Basis::Analog, Basis::Pattern, Basis::Both, Basis::RunningDown] {
        assert!(seen.get(&format!("{basis:?}")).is_some_and(|often| *often > 500), "{basis:?}: {seen:?}");
    }
    for brake in [Brake::Release, Brake::Service, Brake::Emergency] {
        assert!(seen.get(&format!("{brake:?}")).is_some_and(|often| *often > 500), "{brake:?}: {seen:?}");
    }
    assert!(seen.get("position true").is_some_and(|often| *often > 10_000), "{seen:?}");
}

#[test]
fn each_wrong_glue_is_found_out_by_what_it_shows_or_brakes() {
    let parts = parts();
    let train = Device::new(parts).unwrap();
    for wrong in WRONG {
        let found = [3, 17, 99].into_iter().any(|seed| {
            let mut ride = Ride::new(seed);
            let (mut device, mut glued) = (train.initial(), State::INITIAL);
            let mut last = None;
            (0..CYCLES).any(|_| {
                let antennas = ride.next();
                let (next, cab) = train.step(device, antennas);
                let (other, by_hand) = glue(&parts, glued, antennas, Some(wrong), last);
                (device, glued, last) = (next, other, by_hand.permission.speed);
                cab != by_hand
            })
        });
        assert!(found, "{wrong:?} does the same as the device");
    }
}

#[test]
fn silence_ends_in_an_emergency_and_no_telegram_counts_beyond_the_oldest_evidence() {
    let parts = parts();
    let train = Device::new(parts).unwrap();
    // The life of a main telegram, 30 cycles, is more than T2 + T3, 8.
    assert_eq!(train.oldest(), Ticks(30));
    let mut ends = [0; 2];
    for seed in [5, 6] {
        let mut ride = Ride::new(seed);
        let mut state = train.initial();
        let mut silent = u16::MAX;
        for _ in 0..CYCLES {
            let antennas = ride.next();
            let (next, cab) = train.step(state, antennas);
            let detected = train.receive(antennas).detected != AspectSet::EMPTY;
            // A telegram that is used makes the target younger than one cycle more.
            let older = state.permitted.target.map(|target| target.age.0 + 1);
            let used = next.permitted.target.is_some_and(|target| Some(target.age.0) != older);
            silent = if detected || used { 0 } else { silent.saturating_add(1) };
            // Without a code only a fresh telegram permits: 12 cycles, which is more than T2 + T3.
            if silent >= 12 {
                assert_eq!(cab.brake, Brake::Emergency);
                assert_eq!((cab.display, cab.permission.speed), (None, None));
                ends[0] += 1;
            }
            // With a code, a telegram counts until the oldest evidence.
            if cab.permission.basis == Basis::RunningDown {
                let age = next.permitted.target.map(|target| target.age);
                assert!(age.is_some_and(|age| age > Ticks(12) && age <= train.oldest()), "{age:?}");
                ends[1] += 1;
            }
            state = next;
        }
    }
    assert!(ends[0] > 100 && ends[1] > 100, "{ends:?}");
}

#[test]
fn parts_that_do_not_belong_together_are_refused() {
    let right = parts();
    let unknown = Parts { codes: codes([0, 150, 460, 650, 900]), ..right };
    assert!(
        matches!(Device::new(unknown), Err(TrainError::UnknownSpeed(main, sub)) if main.place() == 2 && sub.place() == 2)
    );
    let slow = Supervision::new(KmhTenths(899), KmhTenths(0)).unwrap();
    let refused = Device::new(Parts { supervision: slow, ..right });
    assert_eq!(refused, Err(TrainError::ImplausibleSpeed(KmhTenths(900))));
    let Parts { codes, permitted, supervision, position, .. } = right;
    let acceptance = Acceptance::<4> { times: right.acceptance.times };
    let few = Train::<4>::new(Parts { codes, acceptance, permitted, supervision, position });
    assert_eq!(few, Err(TrainError::TooManyRanks));
    assert_eq!(Device::new(right).map(|train| *train.parts()), Ok(right));
}

fn words(word: u16) -> impl Iterator<Item = u16> {
    (0..16).map(move |bit| word ^ 1 << bit)
}

fn longs(long: u32) -> impl Iterator<Item = u32> {
    (0..32).map(move |bit| long ^ 1 << bit)
}

/// Every set of fields of acceptance that differs in one bit.
fn wrong_acceptances(right: aspect::Parts<5>) -> Vec<aspect::Parts<5>> {
    let mut all = Vec::new();
    for rank in 0..5 {
        for run in words(right.run[rank]) {
            let mut wrong = right;
            wrong.run[rank] = run;
            all.push(wrong);
        }
        for age in words(right.age[rank]) {
            let mut wrong = right;
            wrong.age[rank] = age;
            all.push(wrong);
        }
    }
    all.extend(words(right.accepted).map(|accepted| aspect::Parts { accepted, ..right }));
    all.extend(words(right.dropped).map(|dropped| aspect::Parts { dropped, ..right }));
    all.extend(words(right.credited).map(|credited| aspect::Parts { credited, ..right }));
    all.extend(words(right.last).map(|last| aspect::Parts { last, ..right }));
    all
}

/// Every target that differs in one bit, or in whether it is there.
fn wrong_targets(right: Option<Target>) -> Vec<Option<Target>> {
    let section = SectionId(0);
    let Some(right) = right else {
        let (beyond, limit, to_stop, age) = (Metres(0), KmhTenths(0), Millimetres(0), Ticks(0));
        return vec![Some(Target { section, beyond, limit, to_stop, age })];
    };
    let mut all = vec![None];
    all.extend(words(right.section.0).map(|section| Some(Target { section: SectionId(section), ..right })));
    all.extend(words(right.beyond.0).map(|beyond| Some(Target { beyond: Metres(beyond), ..right })));
    all.extend(words(right.limit.0).map(|limit| Some(Target { limit: KmhTenths(limit), ..right })));
    all.extend(words(right.age.0).map(|age| Some(Target { age: Ticks(age), ..right })));
    all.extend(longs(right.to_stop.0).map(|to| Some(Target { to_stop: Millimetres(to), ..right })));
    all
}

/// All fixed data that differ in one bit, or in whether they are there.
fn wrong_data(right: Option<Fixed>) -> Vec<Option<Fixed>> {
    let Some(right) = right else {
        let (section, gradient, limit, age) = (SectionId(0), Gradient(0), KmhTenths(0), Ticks(0));
        return vec![Some(Fixed { section, gradient, limit, age })];
    };
    let mut all = vec![None];
    all.extend(words(right.section.0).map(|section| Some(Fixed { section: SectionId(section), ..right })));
    all.extend(words(right.limit.0).map(|limit| Some(Fixed { limit: KmhTenths(limit), ..right })));
    all.extend(words(right.age.0).map(|age| Some(Fixed { age: Ticks(age), ..right })));
    let [byte] = right.gradient.0.to_le_bytes();
    all.extend((0..8).map(|bit| {
        let gradient = Gradient(i8::from_le_bytes([byte ^ 1 << bit]));
        Some(Fixed { gradient, ..right })
    }));
    all
}

/// Every stream that differs in one bit, or in whether there is a last telegram.
fn wrong_streams(right: Stream) -> Vec<Stream> {
    let empty = Header { section: SectionId(0), counter: Counter(0) };
    let mut all = vec![Stream { last: if right.last.is_some() { None } else { Some(empty) }, ..right }];
    all.extend((0..8).map(|bit| Stream { in_order: right.in_order ^ 1 << bit, ..right }));
    all.extend(words(right.age.0).map(|age| Stream { age: Ticks(age), ..right }));
    if let Some(last) = right.last {
        let header = |last| Stream { last: Some(last), ..right };
        all.extend(words(last.section.0).map(|section| header(Header { section: SectionId(section), ..last })));
        all.extend((0..8).map(|bit| header(Header { counter: Counter(last.counter.0 ^ 1 << bit), ..last })));
    }
    all
}

/// Every state of the permitted speed that differs in one bit of one field, or in whether something is there.
fn wrong_permitted(right: permitted::State) -> Vec<permitted::State> {
    let line = match right.line {
        LineKind::Analog => LineKind::Digital,
        LineKind::Digital => LineKind::Analog,
    };
    let mut all = vec![permitted::State { line, ..right }];
    let fix = if right.fix.is_some() { None } else { Some(Millimetres(0)) };
    all.push(permitted::State { fix, ..right });
    let fixes = right.fix.into_iter().flat_map(|fix| longs(fix.0));
    all.extend(fixes.map(|fix| permitted::State { fix: Some(Millimetres(fix)), ..right }));
    all.extend(wrong_targets(right.target).into_iter().map(|target| permitted::State { target, ..right }));
    all.extend(wrong_targets(right.behind).into_iter().map(|behind| permitted::State { behind, ..right }));
    let [newest, other] = right.fixed;
    all.extend(wrong_data(newest).into_iter().map(|wrong| permitted::State { fixed: [wrong, other], ..right }));
    all.extend(wrong_data(other).into_iter().map(|wrong| permitted::State { fixed: [newest, wrong], ..right }));
    let streams = wrong_streams(right.main_stream).into_iter();
    all.extend(streams.map(|main_stream| permitted::State { main_stream, ..right }));
    let streams = wrong_streams(right.sub_stream).into_iter();
    all.extend(streams.map(|sub_stream| permitted::State { sub_stream, ..right }));
    all
}

/// Every state that differs from `state` in one bit of one field, or in whether something is there.
fn flips(state: State<5>) -> Vec<State<5>> {
    let acceptances = wrong_acceptances(state.acceptance.parts()).into_iter();
    let mut all: Vec<_> =
        acceptances.map(|parts| State { acceptance: aspect::State::from_parts(parts), ..state }).collect();
    all.extend(wrong_permitted(state.permitted).into_iter().map(|permitted| State { permitted, ..state }));
    all.push(State {
        position: if state.position.is_some() { None } else { Interval::new(Millimetres(0), Millimetres(0)) },
        ..state
    });
    if let Some(place) = state.position {
        let (near, far) = (place.nearest(), place.farthest());
        // The ends that are the wrong way round cannot be written: there is no such interval.
        let ends = longs(near.0).map(|near| Interval::new(Millimetres(near), far));
        let ends = ends.chain(longs(far.0).map(|far| Interval::new(near, Millimetres(far))));
        all.extend(ends.flatten().map(|position| State { position: Some(position), ..state }));
    }
    let brakes = [Brake::Release, Brake::Service, Brake::Emergency].into_iter().filter(|brake| *brake != state.brake);
    all.extend(brakes.map(|brake| State { brake, ..state }));
    let ways = [None, Some(Heading::Left), Some(Heading::Right)].into_iter().filter(|facing| *facing != state.facing);
    all.extend(ways.map(|facing| State { facing, ..state }));
    all
}

#[test]
fn every_wrong_bit_of_one_channel_is_the_safe_output_at_once() {
    let train = Device::new(parts()).unwrap();
    let mut ride = Ride::new(7);
    let mut pair = Duplex::initial(&train);
    let (mut tried, mut full) = (0, 0);
    for cycle in 0..3000 {
        let antennas = ride.next();
        let state = pair.a.state;
        let running =
            state.permitted.target.is_some() && state.position.is_some() && state.permitted.fixed[1].is_some();
        if running && cycle % 40 == 0 {
            full += 1;
            for wrong in flips(state) {
                assert_ne!(wrong, state);
                for in_a in [true, false] {
                    let mut faulty = pair;
                    if in_a {
                        faulty.a.state = wrong;
                    } else {
                        faulty.b.state = wrong;
                    }
                    let (after, agreed) = faulty.step(&train, antennas);
                    assert_eq!(output::<Device>(agreed), Cab::STOP, "{wrong:?}");
                    assert!(after.is_tripped(), "{wrong:?}");
                    tried += 1;
                }
            }
        }
        let (next, agreed) = pair.step(&train, antennas);
        assert!(agreed.is_some(), "cycle {cycle}: the channels agree without a fault");
        pair = next;
    }
    assert!(full >= 10 && tried >= 10_000, "{full} states, {tried} faults");
}
