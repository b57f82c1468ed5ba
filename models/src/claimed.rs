//! Aspect acceptance *as claimed* by JP3886280B2, claims 1 and 2: what the normative machine is compared with.
//!
//! The kernel's machine is stricter in two places, and this one shows why:
//!
//! * Here a masked aspect stands only while no other aspect at all is satisfied, so that an aspect which nobody
//!   hears can push out a lower one (kernel: ACC-5, ACC-7).
//! * Here the lowest satisfied aspect is always displayed, whether or not that is a rise (kernel: ACC-9).
//!
//! Where the claim is open the kinder reading is taken, so that no difference is an artefact: a re-detection does
//! not restart the age, T4 at or beyond T2+T3 acts as T2+T3 less one cycle, a dropped aspect stays unsatisfied until
//! it is accepted again \[0026\], and of aspects that are masked in the same cycle the lower one stays.

use atc_kernel::Machine;
use atc_kernel::aspect::{AspectSet, Display, Times};

/// The machine as claimed, for the `N` lowest ranks (1 to 16).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Claimed<const N: usize> {
    /// The times of the line.
    pub times: Times,
}

/// One aspect. Times in cycles.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Reception {
    /// Not satisfied; heard on `run` cycles up to now, and accepted after T5 of them if `credit`, else after T1.
    Waiting {
        /// Consecutive cycles heard, below T1.
        run: u16,
        /// Re-detected soon enough after a loss that has expired since.
        credit: bool,
    },
    /// Satisfied and heard.
    Heard,
    /// Satisfied once and not heard since `age` cycles, apart from a re-detection of `run` cycles up to now.
    Lost {
        /// 1 in the first cycle without it, below T2+T3.
        age: u16,
        /// Consecutive cycles heard, below T1.
        run: u16,
        /// Pushed out of its mask by another aspect.
        dropped: bool,
    },
}

/// What the machine remembers: each aspect, the lowest first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct State<const N: usize>([Reception; N]);

impl<const N: usize> State<N> {
    /// Nothing heard, nothing satisfied.
    pub const INITIAL: Self = Self([Reception::Waiting { run: 0, credit: false }; N]);

    /// The aspects that are satisfied.
    pub fn satisfied(&self) -> AspectSet {
        self.set(|aspect| matches!(aspect, Reception::Heard | Reception::Lost { dropped: false, .. }))
    }

    /// The aspects that lost their mask to another.
    pub fn dropped(&self) -> AspectSet {
        self.set(|aspect| matches!(aspect, Reception::Lost { dropped: true, .. }))
    }

    /// The aspects that are gone and will be accepted after T5 cycles of the present detection.
    pub fn credited(&self) -> AspectSet {
        self.set(|aspect| matches!(aspect, Reception::Waiting { credit: true, .. }))
    }

    fn set(&self, choose: impl Fn(&Reception) -> bool) -> AspectSet {
        AspectSet::from_bits(self.0.iter().enumerate().fold(0, |set, (rank, a)| set | u16::from(choose(a)) << rank))
    }
}

/// One logic cycle: the aspects `detected` throughout it, and what is displayed from now on.
pub fn step<const N: usize>(times: Times, state: State<N>, detected: AspectSet) -> (State<N>, Display) {
    let mut next = state;
    for (rank, aspect) in next.0.iter_mut().enumerate() {
        *aspect = advance(times, *aspect, detected.bits() >> rank & 1 == 1);
    }
    for rank in (0..N).rev() {
        let others = next.satisfied().bits() & !(1 << rank);
        if let Reception::Lost { age, dropped, .. } = &mut next.0[rank] {
            *dropped |= *age >= times.recovery().0 && others != 0;
        }
    }
    let lowest = next.satisfied().lowest();
    (next, Display::from_bits(lowest.bits()))
}

fn advance(times: Times, aspect: Reception, heard: bool) -> Reception {
    let count = |run: u16| if heard { run.saturating_add(1) } else { 0 };
    let enough =
        |run: u16, credit: bool| heard && run >= if credit { times.shortened_operate().0 } else { times.operate().0 };
    let (age, run, dropped) = match aspect {
        Reception::Heard if heard => return Reception::Heard,
        Reception::Heard => (1, 0, false),
        Reception::Lost { age, run, dropped } => (age.saturating_add(1), count(run), dropped),
        Reception::Waiting { run, credit } => {
            let (run, credit) = (count(run), credit && heard);
            return if enough(run, credit) { Reception::Heard } else { Reception::Waiting { run, credit } };
        }
    };
    let credit = run > 0 && age.saturating_sub(run) <= times.interruption().0;
    if enough(run, credit) {
        Reception::Heard
    } else if age >= times.expiry().0 {
        Reception::Waiting { run, credit }
    } else {
        Reception::Lost { age, run, dropped }
    }
}

impl<const N: usize> Machine for Claimed<N> {
    type State = State<N>;
    type Input = AspectSet;
    type Output = Display;

    const SAFE: Display = Display::NOTHING;

    fn initial(&self) -> State<N> {
        State::INITIAL
    }

    fn step(&self, state: State<N>, detected: AspectSet) -> (State<N>, Display) {
        step(self.times, state, detected)
    }
}
