//! The rules of `spec/aspect.md` and `spec/supervision.md` once more, written from the text and not from the kernel, against
//! the kernel. Nothing is remembered from cycle to cycle here but what happened: every detection, every acceptance, every drop,
//! every display. Run, age, g and credit are worked out of that history anew in each cycle, with numbers that never saturate.

use atc_kernel::aspect::{AspectSet, State, Times, TimesMs, step};
use atc_kernel::speed::{KmhTenths, RawKmhTenths};
use atc_kernel::supervision::{self, Brake, Speeds, Supervision};
use atc_kernel::time::{Millis, Ticks};

/// The times in cycles, as asked for: T1, T2, T3, T4 (not capped), T5. T5 = T1 is the conventional device.
#[derive(Clone, Copy, Debug)]
struct Asked {
    t1: usize,
    t2: usize,
    t3: usize,
    t4: usize,
    t5: usize,
}

impl Asked {
    fn kernel(self) -> Times {
        let shorter = self.t5.min(self.t1 - 1);
        let [t1, t2, t3, t4, t5] =
            [self.t1, self.t2, self.t3, self.t4, shorter].map(|ticks| Ticks(u16::try_from(ticks).unwrap()));
        let times = Times::from_ticks(t1, t2, t3, t4, t5).unwrap();
        if self.t5 == self.t1 { times.conventional() } else { times }
    }
}

/// What happened to one aspect. Cycles are numbered from 0; `heard` has one entry for each.
#[derive(Clone, Default)]
struct Past {
    heard: Vec<bool>,
    accepted: Vec<usize>,
    dropped: Vec<usize>,
}

impl Past {
    /// Consecutive cycles in which it was heard, up to the last one.
    fn run(&self) -> usize {
        self.heard.iter().rev().take_while(|heard| **heard).count()
    }

    /// Cycles since the loss, the first one without it being 1; 0 if not lost; `None` if it was never accepted. Runs on for ever.
    fn age(&self) -> Option<usize> {
        let accepted = *self.accepted.last()?;
        let loss = (accepted..self.heard.len()).find(|&cycle| !self.heard[cycle]);
        Some(loss.map_or(0, |loss| self.heard.len() - loss))
    }

    /// ACC-1 and ACC-8: is the last cycle one in which it is accepted (anew)?
    fn is_due(&self, asked: Asked) -> bool {
        let (run, age) = (self.run(), self.age());
        let credit = age.is_some_and(|age| age > 0 && age - run <= asked.t4 && age - run < asked.t2 + asked.t3);
        age != Some(0) && (run >= asked.t1 || credit && run >= asked.t5)
    }

    /// Accepted and not gone (ACC-6).
    fn stands(&self, asked: Asked) -> bool {
        self.age().is_some_and(|age| age < asked.t2 + asked.t3)
    }

    fn is_firm(&self, asked: Asked) -> bool {
        self.stands(asked) && self.age().is_some_and(|age| age < asked.t2)
    }

    /// Dropped since its last acceptance.
    fn is_dropped(&self) -> bool {
        self.dropped.last().is_some_and(|drop| self.accepted.last() <= Some(drop))
    }
}

/// A device that remembers everything.
#[derive(Clone)]
struct Witness {
    asked: Asked,
    past: Vec<Past>,
    displays: Vec<Option<usize>>,
}

impl Witness {
    fn new(asked: Asked, aspects: usize) -> Self {
        Self { asked, past: vec![Past::default(); aspects], displays: Vec::new() }
    }

    fn evidence(&self, mut ranks: impl Iterator<Item = usize>) -> bool {
        ranks.any(|rank| self.past[rank].run() >= self.asked.t1)
    }

    /// One cycle: runs and ages, acceptances, expiry, drops, display.
    fn cycle(&mut self, detected: u16) -> Option<usize> {
        let (asked, now, aspects) = (self.asked, self.displays.len(), self.past.len());
        for (rank, past) in self.past.iter_mut().enumerate() {
            past.heard.push(detected >> rank & 1 == 1);
            if past.is_due(asked) {
                past.accepted.push(now);
            }
        }
        for rank in 0..aspects {
            let masked = self.past[rank].stands(asked) && !self.past[rank].is_firm(asked);
            // Firm and evident aspects are never masked, so that a drop changes nothing that later ranks ask for.
            let lower = (0..rank).any(|other| self.past[other].is_firm(asked));
            if masked && (lower || self.evidence(rank + 1..aspects)) && !self.past[rank].is_dropped() {
                self.past[rank].dropped.push(now);
            }
        }
        let last = self.displays.iter().rev().find_map(|shown| *shown);
        let lowest = self.past.iter().position(|past| past.stands(asked) && !past.is_dropped());
        let display = lowest.filter(|&rank| last.is_some_and(|last| rank <= last) || self.evidence(rank..aspects));
        self.displays.push(display);
        display
    }

    fn undo(&mut self) {
        self.displays.pop();
        let now = self.displays.len();
        for past in &mut self.past {
            past.heard.pop();
            past.accepted.retain(|cycle| *cycle < now);
            past.dropped.retain(|cycle| *cycle < now);
        }
    }

    /// Says the same cycle to the kernel and compares the display and every field of the state.
    fn compare<const N: usize>(&mut self, state: State<N>, detected: u16) -> State<N> {
        let times = self.asked.kernel();
        let display = self.cycle(detected);
        let (next, shown) = step(times, state, AspectSet::from_bits(detected));
        let parts = next.parts();
        let shown_rank = shown.aspect().map(|aspect| usize::from(aspect.rank()));
        let mut same = shown_rank == display && next.display() == shown && next.is_valid(times);
        let last = self.displays.iter().rev().find_map(|shown| *shown);
        same &= parts.last == last.map_or(0, |rank| 1 << rank);
        for (rank, past) in self.past.iter().enumerate() {
            let stands = past.stands(self.asked);
            same &= (parts.accepted >> rank & 1 == 1) == stands;
            same &= (parts.dropped >> rank & 1 == 1) == (stands && past.is_dropped());
            same &= usize::from(parts.run[rank]) == past.run().min(self.asked.t1);
            same &= usize::from(parts.age[rank]) == if stands { past.age().unwrap() } else { 0 };
        }
        let heard: Vec<_> = self.past.iter().map(|past| &past.heard).collect();
        assert!(same, "{:?}\nheard {heard:?}\nexpected {display:?}, kernel {shown:?} {parts:?}", self.asked);
        next
    }

    /// All inputs for `depth` more cycles; how many cycles were compared.
    fn explore<const N: usize>(&mut self, state: State<N>, depth: usize) -> u64 {
        if depth == 0 {
            return 0;
        }
        let mut cycles = 0;
        for detected in 0..1_u16 << N {
            let next = self.compare(state, detected);
            cycles += 1 + self.explore(next, depth - 1);
            self.undo();
        }
        cycles
    }
}

/// Every set of times with T1, T2 and T3 up to these, T4 from 0 to past the cap.
fn all_times(t1: usize, t2: usize, t3: usize) -> Vec<Asked> {
    let mut all = Vec::new();
    for (t1, t2, t3) in (2..=t1).flat_map(|a| (1..=t2).flat_map(move |b| (0..=t3).map(move |c| (a, b, c)))) {
        for t4 in 0..=t2 + t3 + 1 {
            all.extend((1..=t1).map(|t5| Asked { t1, t2, t3, t4, t5 }));
        }
    }
    all
}

fn explore_all<const N: usize>(times: &[Asked], depth: usize) {
    let cycles: u64 = times.iter().map(|asked| Witness::new(*asked, N).explore(State::<N>::INITIAL, depth)).sum();
    println!("{N} aspects, {} sets of times, every input for {depth} cycles: {cycles} cycles compared", times.len());
}

/// Marsaglia's xorshift, 64 bits.
struct Random(u64);

impl Random {
    fn below(&mut self, bound: usize) -> usize {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        usize::try_from(self.0 >> 33).unwrap() % bound
    }
}

/// Runs that look like reception: each aspect changes between heard and not heard about every `hold` cycles.
fn random<const N: usize>(random: &mut Random, most: usize, runs: usize, length: usize) {
    for _ in 0..runs {
        let t1 = 2 + random.below(most);
        let [t2, t3, t4] = [1 + random.below(most), random.below(most), random.below(3 * most)];
        let asked = Asked { t1, t2, t3, t4, t5: 1 + random.below(t1) };
        let (mut witness, mut state, mut detected) = (Witness::new(asked, N), State::<N>::INITIAL, 0);
        let hold: Vec<usize> = (0..N).map(|_| 1 + random.below(2 * most)).collect();
        for _ in 0..length {
            for (rank, hold) in hold.iter().enumerate() {
                detected ^= u16::from(random.below(*hold) == 0) << rank;
            }
            state = witness.compare(state, detected);
        }
    }
}

#[test]
fn every_input_of_small_machines() {
    explore_all::<1>(&all_times(4, 3, 3), 12);
    explore_all::<2>(&all_times(3, 2, 2), 7);
    explore_all::<3>(&[Asked { t1: 2, t2: 1, t3: 2, t4: 2, t5: 1 }], 6);
}

#[test]
fn random_inputs_of_large_machines() {
    let mut seed = Random(0x9E37_79B9_7F4A_7C15);
    random::<2>(&mut seed, 4, 4000, 60);
    random::<4>(&mut seed, 6, 3000, 80);
    random::<16>(&mut seed, 8, 400, 120);
    random::<4>(&mut seed, 40, 60, 600);
}

/// The example of the patent in a cycle of 7 ms, which divides none of the times: 43, 57, 57, 114 and 15 cycles.
#[test]
fn rounding_to_cycles() {
    let times = Times::from_millis(Millis(7), TimesMs::default()).unwrap();
    let rounded = [times.operate(), times.recovery(), times.expiry(), times.interruption(), times.shortened_operate()];
    assert_eq!(rounded.map(|ticks| ticks.0), [43, 57, 114, 113, 15]);
    assert!(Times::from_millis(Millis(0), TimesMs::default()).is_err());
}

/// SUP-1 and SUP-2 as three questions, for every small combination.
#[test]
fn supervision_by_cases() {
    for (margin, previous) in
        (0..4_u16).flat_map(|m| [Brake::Release, Brake::Service, Brake::Emergency].map(|p| (m, p)))
    {
        let device = Supervision::new(KmhTenths(6), KmhTenths(margin)).unwrap();
        for (v, p) in (-2..9).flat_map(|v| (-2..9).map(move |p| (v, p))) {
            let [measured, permitted] = [v, p].map(|speed| (speed != -2).then_some(RawKmhTenths(speed)));
            let brake = supervision::step(device, previous, Speeds { measured, permitted });
            let held = previous != Brake::Release && v > 0 && v > p - i32::from(margin);
            let expected = match () {
                () if !(0..=6).contains(&v) || p < 0 => Brake::Emergency,
                () if v > p || held => Brake::Service,
                () => Brake::Release,
            };
            assert_eq!(brake, expected, "margin {margin}, {previous:?}, {v} km/h against {p}");
        }
    }
}
