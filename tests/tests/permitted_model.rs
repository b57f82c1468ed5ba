//! Section 5 of the digest of the patents once more, against the kernel. Nothing is remembered from cycle to cycle but what was
//! heard; which telegrams are used, how far it is to the stopping point and what is known of a section are worked out of that
//! history anew in each cycle, with numbers that never saturate.

use atc_kernel::aspect::{AspectId, AspectTable};
use atc_kernel::distance::{Metres, Millimetres};
use atc_kernel::pattern::Deceleration;
use atc_kernel::permitted::{Basis, Heard, LineKind, Permission, Permitted, PermittedError, Settings, State, step};
use atc_kernel::speed::KmhTenths;
use atc_kernel::telegram::{Counter, Gradient, Length, Main, Route, SectionId, Sequence, SequenceError, Sub};
use atc_kernel::time::Ticks;
use proptest::prelude::*;

/// A train that remembers everything it heard.
struct Witness {
    settings: Settings,
    heard: Vec<Heard>,
}

impl Witness {
    fn now(&self) -> usize {
        self.heard.len() - 1
    }

    fn speed(&self, rank: AspectId) -> Option<u16> {
        self.settings.speeds.speeds().get(usize::from(rank.rank())).map(|speed| speed.0)
    }

    /// The telegrams of a stream that count as heard, with their cycles.
    fn stream<'a, T: 'a>(&'a self, of: impl Fn(&Heard) -> Option<T> + 'a) -> Vec<(usize, T)> {
        self.heard.iter().enumerate().filter_map(|(cycle, heard)| Some((cycle, of(heard)?))).collect()
    }

    fn mains(&self) -> Vec<(usize, Main)> {
        self.stream(|heard| heard.main.filter(|main| self.speed(main.speed).is_some()))
    }

    fn subs(&self) -> Vec<(usize, Sub)> {
        let known = |sub: &Sub| self.speed(sub.curve).is_some() && self.speed(sub.restriction).is_some();
        self.stream(move |heard| heard.sub.filter(known))
    }

    /// Which telegrams of a stream, given as (cycle, section, counter), end a chain that is long enough.
    fn used(&self, stream: &[(usize, u16, u8)]) -> Vec<bool> {
        let sequence = self.settings.sequence;
        let follows = |at: usize| {
            let ((before, section, counter), (cycle, next_section, next)) = (stream[at - 1], stream[at]);
            let ahead = (i32::from(next) - i32::from(counter)).rem_euclid(256);
            section == next_section
                && (1..=i32::from(sequence.window())).contains(&ahead)
                && cycle - before < usize::from(sequence.memory().0)
        };
        // What a chain may begin with: the first telegram of a section or behind a silence, or one of an older chain.
        let begins = |at: usize| {
            let news = |at: usize| {
                let ((before, section, _), (cycle, next_section, _)) = (stream[at - 1], stream[at]);
                section != next_section || cycle - before >= usize::from(sequence.memory().0)
            };
            at == 0 || news(at) || follows(at)
        };
        let run = usize::from(sequence.run());
        (0..stream.len()).map(|at| at >= run && (at - run + 1..=at).all(follows) && begins(at - run)).collect()
    }

    fn used_mains(&self) -> Vec<(usize, Main)> {
        let mains = self.mains();
        let headers: Vec<_> = mains.iter().map(|(at, main)| (*at, main.section.0, main.counter.0)).collect();
        mains.into_iter().zip(self.used(&headers)).filter(|(_, used)| *used).map(|(main, _)| main).collect()
    }

    fn used_subs(&self) -> Vec<(usize, Sub)> {
        let subs = self.subs();
        let headers: Vec<_> = subs.iter().map(|(at, sub)| (*at, sub.section.0, sub.counter.0)).collect();
        subs.into_iter().zip(self.used(&headers)).filter(|(_, used)| *used).map(|(sub, _)| sub).collect()
    }

    /// The most that the train can have moved after cycle `from`, up to and with cycle `to`.
    fn moved(&self, from: usize, to: usize) -> i128 {
        self.heard[from + 1..=to].iter().map(|heard| i128::from(heard.moved.0)).sum()
    }

    /// The distance to the stopping point as one used main telegram tells it, in the cycle in which it is heard.
    fn measured(&self, cycle: usize, main: Main) -> i128 {
        let before =
            self.mains().iter().rev().map(|(at, _)| *at).find(|at| *at < cycle).expect("a used one has one before it");
        let fix = (before + 1..cycle).find_map(|at| Some((at, self.heard[at].to_exit?)));
        // In the cycle of the telegram the train may have gone over the exit: its movement is taken off the whole.
        let to_exit = fix.map_or(0, |(at, to_exit)| (i128::from(to_exit.0) - self.moved(at, cycle - 1)).max(0));
        let beyond = match main.route {
            Route::Closed => 0,
            Route::OpenFor(distance) => i128::from(distance.0) * 1000,
        };
        ((to_exit + beyond).min(i128::from(u32::MAX)) - i128::from(self.heard[cycle].moved.0)).max(0)
    }

    /// When a telegram of a stream that is heard in this cycle may have been sent: at the one before it, or later.
    fn sent(stream: &[usize], cycle: usize) -> usize {
        stream.iter().rev().copied().find(|at| *at < cycle).expect("a used one has one before it")
    }

    /// The last main telegram that is used, if it is not too old, with its age and the distance to the stopping point.
    fn target(&self) -> Option<(Main, usize, i128)> {
        self.last_of(&self.used_mains())
    }

    /// The same of the section before the one of `main`.
    fn behind(&self, main: Main) -> Option<(Main, usize, i128)> {
        let used = self.used_mains();
        let last = used.iter().rposition(|(_, other)| other.section.0 != main.section.0)?;
        self.last_of(&used[..=last])
    }

    fn last_of(&self, used: &[(usize, Main)]) -> Option<(Main, usize, i128)> {
        let (last, main) = *used.last()?;
        let life = usize::from(self.settings.life.0);
        let stream: Vec<_> = self.mains().iter().map(|(cycle, _)| *cycle).collect();
        let age = self.now() - Self::sent(&stream, last);
        if age > life {
            return None;
        }
        // Back through telegrams to the same point, as long as one was still remembered when the next came.
        let point = |main: &Main| (main.section.0, main.route.beyond_exit().0);
        let (mut farthest, mut next) = (0, last);
        for (cycle, earlier) in used.iter().rev() {
            if point(earlier) != point(&main) || next - Self::sent(&stream, *cycle) > life && *cycle != last {
                break;
            }
            farthest = farthest.max(self.measured(*cycle, *earlier) - self.moved(*cycle, self.now()));
            next = *cycle;
        }
        Some((main, age, farthest))
    }

    /// What is known of a section: gradient and limit. Two sections are remembered.
    fn known(&self, section: u16) -> Option<(Gradient, u16)> {
        let used = self.used_subs();
        let (_, newest) = used.last()?;
        let other = used.iter().rev().find(|(_, sub)| sub.section.0 != newest.section.0);
        let remembered = [Some(newest.section.0), other.map(|(_, sub)| sub.section.0)].contains(&Some(section));
        let (cycle, sub) = used.iter().rev().find(|(_, sub)| sub.section.0 == section).filter(|_| remembered)?;
        let limit = self.speed(sub.curve)?.min(self.speed(sub.restriction)?);
        let stream: Vec<_> = self.subs().iter().map(|(cycle, _)| *cycle).collect();
        let age = self.now() - Self::sent(&stream, *cycle);
        (age <= usize::from(self.settings.fixed_life.0)).then_some((sub.gradient, limit))
    }

    /// The speed by a telegram to a point; without a sub telegram no limit is under that by the section behind.
    fn digital(&self, main: Main, to_stop: i128) -> u16 {
        let lowest = self.speed(self.settings.lowest).expect("checked");
        self.known(main.section.0).map_or_else(
            || {
                let by_it = self.behind(main).map_or(0, |(behind, _, to_stop)| {
                    let (gradient, limit) = self.known(behind.section.0).unwrap_or((self.settings.worst, lowest));
                    self.curve(behind, to_stop, gradient, limit)
                });
                self.curve(main, to_stop, self.settings.worst, lowest.max(by_it))
            },
            |(gradient, limit)| self.curve(main, to_stop, gradient, limit),
        )
    }

    fn curve(&self, main: Main, to_stop: i128, Gradient(permille): Gradient, limit: u16) -> u16 {
        let permille = i128::from(permille);
        let brake = i128::from(self.settings.brake.mm_s2());
        // 9.84375 mm/s² for each thousandth of fall, rounded up; 9.6875 for each of climb, rounded down.
        let change =
            if permille < 0 { -((-permille * 984_375 + 99_999) / 100_000) } else { permille * 96_875 / 10_000 };
        let brake = (brake + change).max(0);
        let metres = ((to_stop - i128::from(self.settings.margin.0) * 1000).max(0) / 1000).min(65_535);
        let below = |speed: i128| 125 * speed * speed <= 324 * brake * metres;
        let curve = (0..=4095_u16).rev().find(|speed| below((*speed).into())).expect("0 is");
        curve.min(limit).min(self.speed(main.speed).expect("a known rank"))
    }

    fn line(&self, cycle: usize) -> LineKind {
        self.heard[..=cycle].iter().rev().find_map(|heard| heard.line).unwrap_or(LineKind::Digital)
    }

    fn hear(&mut self, heard: Heard) -> (Permission, Option<i128>) {
        self.heard.push(heard);
        let target = self.target();
        let fresh = target.filter(|(_, age, _)| *age <= usize::from(self.settings.fresh.0));
        let pattern = |target: (Main, usize, i128)| self.digital(target.0, target.2);
        let code = heard.analog.map(|code| code.0);
        let (speed, basis) = match (self.line(self.now()), code, fresh) {
            (_, Some(code), Some(fresh)) => (Some(code.min(pattern(fresh))), Basis::Both),
            (LineKind::Digital, None, Some(fresh)) => (Some(pattern(fresh)), Basis::Pattern),
            (LineKind::Analog, Some(code), None) => (Some(code), Basis::Analog),
            (LineKind::Digital, Some(code), None) => {
                target.map_or((Some(0), Basis::Nothing), |target| (Some(code.min(pattern(target))), Basis::RunningDown))
            }
            (_, None, _) => (None, Basis::Nothing),
        };
        (Permission { speed: speed.map(KmhTenths), basis }, target.map(|target| target.2))
    }
}

/// Telegrams that look like a line's, with losses, repetitions and strangers.
struct Ground {
    random: u64,
    section: u16,
    counters: [u8; 2],
    beyond: u16,
    to_exit: u32,
    digital: bool,
}

impl Ground {
    fn draw(&mut self, end: u32) -> u32 {
        self.random ^= self.random << 13;
        self.random ^= self.random >> 7;
        self.random ^= self.random << 17;
        u32::try_from(self.random >> 16 & 0xFFFF_FFFF).expect("32 bits") % end
    }

    fn rank(&mut self) -> AspectId {
        // The line has 5 speeds: some ranks are of none.
        let rank = if self.draw(40) == 0 { 5 + self.draw(11) } else { self.draw(5) };
        AspectId::new(rank.to_le_bytes()[0]).expect("a rank")
    }

    /// The next number of a stream, mostly the right one.
    fn count(&mut self, stream: usize) -> Counter {
        let by = match self.draw(20) {
            0 => 0,
            1 => 255,
            2 => 2,
            3 => 3,
            4 => 4,
            _ => 1,
        };
        self.counters[stream] = self.counters[stream].wrapping_add(by);
        Counter(self.counters[stream])
    }

    fn cycle(&mut self) -> Heard {
        if self.draw(60) == 0 {
            self.section = self.section.wrapping_add([1, 1, 1, 2, u16::MAX][self.draw(5) as usize]) % 4;
            self.to_exit = 20_000 + self.draw(200_000);
        }
        if self.draw(40) == 0 {
            self.beyond = [0, 1, 50, 300, 65_535][self.draw(5) as usize];
        }
        if self.draw(150) == 0 {
            self.digital = !self.digital;
        }
        let moved = match self.draw(30) {
            0 => 100_000,
            1..=8 => 0,
            _ => self.draw(6000),
        };
        self.to_exit = self.to_exit.saturating_sub(moved);
        let often = if self.digital { 2 } else { 40 };
        let section = SectionId(if self.draw(60) == 0 { 9 } else { self.section });
        let main = (self.draw(often) == 0).then(|| Main {
            section,
            counter: self.count(0),
            route: if self.beyond == 0 { Route::Closed } else { Route::OpenFor(Metres(self.beyond)) },
            speed: self.rank(),
        });
        let sub = (self.draw(often + 1) == 0).then(|| Sub {
            section,
            counter: self.count(1),
            length: Length::new(Metres(200)).expect("not 0"),
            gradient: Gradient([0, -20, 15, -128, 127][self.draw(5) as usize]),
            curve: self.rank(),
            restriction: self.rank(),
        });
        let to_exit = match self.draw(12) {
            0 => Some(u32::MAX),
            1..=6 => Some(self.to_exit),
            _ => None,
        };
        Heard {
            line: (self.draw(50) == 0).then_some(if self.digital { LineKind::Digital } else { LineKind::Analog }),
            analog: (self.draw(8) > 0).then(|| KmhTenths([150, 450, 900, 6000][self.draw(4) as usize])),
            main,
            sub,
            to_exit: to_exit.map(Millimetres),
            moved: Millimetres(moved),
        }
    }
}

fn speeds() -> AspectTable {
    AspectTable::new(&[0, 150, 450, 650, 900].map(KmhTenths)).unwrap()
}

prop_compose! {
    fn settings()(
        lowest in 0..5_u8, brake in 1..=4095_u16, worst in any::<i8>(), margin in prop_oneof![0..100_u16, any::<u16>()],
        fresh in 1..12_u16, more in 0..20_u16, fixed_life in 1..40_u16,
        (window, run, memory) in (1..=5_u8, 1..=3_u8, 1..12_u16),
    ) -> Settings {
        Settings {
            speeds: speeds(),
            lowest: AspectId::new(lowest).unwrap(),
            brake: Deceleration::brake(brake).unwrap(),
            worst: Gradient(worst),
            margin: Metres(margin),
            fresh: Ticks(fresh),
            life: Ticks((fresh + more).max(memory)),
            fixed_life: Ticks(fixed_life.max(memory)),
            sequence: Sequence::new(window, run, Ticks(memory)).unwrap(),
        }
    }
}

/// The kernel and the witness side by side; how often each basis was met.
fn compare(settings: Settings, seed: u64, cycles: usize) -> Result<[u32; 5], TestCaseError> {
    let permitted = Permitted::new(settings).expect("valid");
    let mut witness = Witness { settings, heard: Vec::new() };
    let mut ground = Ground {
        random: seed | 1,
        section: 0,
        counters: [250, 3],
        beyond: 300,
        to_exit: 150_000,
        digital: !seed.is_multiple_of(3),
    };
    let (mut state, mut met) = (State::INITIAL, [0; 5]);
    for _ in 0..cycles {
        let heard = ground.cycle();
        let (expected, to_stop) = witness.hear(heard);
        let (next, permission) = step(&permitted, state, heard);
        prop_assert!(next.is_valid(&permitted), "{:?}", next);
        prop_assert_eq!(permission, expected, "cycle {}: {:?}\n{:?}", witness.now(), heard, next);
        prop_assert_eq!(next.target.map(|target| i128::from(target.to_stop.0)), to_stop.map(|to_stop| to_stop.max(0)));
        state = next;
        met[permission.basis as usize] += 1;
    }
    Ok(met)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(3000))]

    #[test]
    fn the_kernel_permits_what_its_history_says(settings in settings(), seed in any::<u64>(), cycles in 1..160_usize) {
        compare(settings, seed, cycles)?;
    }
}

/// The random inputs reach every basis often: the comparison is not of one state only.
#[test]
fn the_inputs_are_lively() {
    let settings = Settings {
        speeds: speeds(),
        lowest: AspectId::new(1).unwrap(),
        brake: Deceleration::brake(800).unwrap(),
        worst: Gradient(-35),
        margin: Metres(10),
        fresh: Ticks(4),
        life: Ticks(12),
        fixed_life: Ticks(30),
        sequence: Sequence::new(3, 1, Ticks(8)).unwrap(),
    };
    let mut met = [0; 5];
    for seed in 1..60 {
        let one = compare(settings, (seed << 40) | (seed * 0x9E37_79B9), 200).unwrap();
        met = std::array::from_fn(|basis| met[basis] + one[basis]);
    }
    assert!(met.iter().all(|count| *count > 200), "nothing, analog, pattern, both, running down: {met:?}");
}

#[test]
fn every_rule_of_the_constructors() {
    let sequence = |window, run, memory| Sequence::new(window, run, Ticks(memory)).map(|_| ());
    assert_eq!(sequence(0, 1, 1), Err(SequenceError::NoWindow));
    assert_eq!(sequence(128, 1, 1), Err(SequenceError::WindowTooWide));
    assert_eq!(sequence(127, 0, 1), Err(SequenceError::NoRun));
    assert_eq!(sequence(127, 16, 1), Err(SequenceError::RunTooLong));
    assert_eq!(sequence(127, 15, 0), Err(SequenceError::NoMemory));
    assert_eq!(sequence(127, 15, 60_001), Err(SequenceError::MemoryTooLong));
    assert_eq!((sequence(127, 15, 60_000), sequence(1, 1, 1)), (Ok(()), Ok(())));
    let sound = Settings {
        speeds: speeds(),
        lowest: AspectId::new(4).unwrap(),
        brake: Deceleration::brake(1).unwrap(),
        worst: Gradient(0),
        margin: Metres(0),
        fresh: Ticks(1),
        life: Ticks(1),
        fixed_life: Ticks(1),
        sequence: Sequence::new(1, 1, Ticks(1)).unwrap(),
    };
    let check = |settings| Permitted::new(settings).map(|_| ());
    assert_eq!(check(sound), Ok(()));
    let lowest = AspectId::new(5).unwrap();
    assert_eq!(check(Settings { lowest, ..sound }), Err(PermittedError::UnknownLimit));
    assert_eq!(check(Settings { fresh: Ticks(0), ..sound }), Err(PermittedError::NoFreshness));
    assert_eq!(check(Settings { fresh: Ticks(2), ..sound }), Err(PermittedError::LifeShorterThanFreshness));
    assert_eq!(check(Settings { life: Ticks(60_001), ..sound }), Err(PermittedError::TooLong));
    assert_eq!(check(Settings { fixed_life: Ticks(60_001), ..sound }), Err(PermittedError::TooLong));
    assert_eq!(check(Settings { fixed_life: Ticks(0), ..sound }), Err(PermittedError::NoFixedLife));
    let longer = Sequence::new(1, 1, Ticks(2)).unwrap();
    for (life, fixed_life) in [(1, 2), (2, 1)] {
        let lives = Settings { life: Ticks(life), fixed_life: Ticks(fixed_life), sequence: longer, ..sound };
        assert_eq!(check(lives), Err(PermittedError::MemoryLongerThanLife));
    }
    assert_eq!(check(Settings { life: Ticks(2), fixed_life: Ticks(2), sequence: longer, ..sound }), Ok(()));
    assert_eq!(check(Settings { life: Ticks(60_000), fixed_life: Ticks(60_000), ..sound }), Ok(()));
}
