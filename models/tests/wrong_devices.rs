//! Wrong devices in the place of the kernel's: each must turn the property red that is there to find it.

mod common;

use atc_kernel::Machine;
use atc_kernel::aspect::{Acceptance, AspectSet, Display, Parts, State, Times, step};
use atc_kernel::time::Ticks;
use atc_models::claimed::Claimed;
use atc_models::comparison::{Comparison, Extra};
use atc_models::interruption::Interruption;
use atc_models::line::{COARSE, EARLY, LATE, Line};
use atc_models::reception::claims::{Bound, Purpose};
use atc_models::reception::{Environment, Ground, Longest, Reception};
use atc_models::train::Device;
use atc_models::{Outcome, Verdict};
use common::outcome;

/// The kernel's machine with a defect.
#[derive(Clone, Debug)]
struct Wrong<const DEFECT: u8, const N: usize> {
    times: Times,
}

const NO_GUARD: u8 = 0;
const AGE_RESTARTS: u8 = 1;
const LATE_EXPIRY: u8 = 2;
const EARLY_EXPIRY: u8 = 3;
const NO_LIMIT: u8 = 4;
const SHORT_OPERATE: u8 = 5;
const LONG_SHORTENED_OPERATE: u8 = 6;
const NO_MASK_LAPSE: u8 = 7;
const HIGHEST_SHOWN: u8 = 8;
const DROP_REVOKED: u8 = 9;

impl<const DEFECT: u8, const N: usize> Wrong<DEFECT, N> {
    /// The times that it keeps instead of its own.
    fn kept(&self) -> Times {
        let t = self.times;
        let (mut operate, mut mask) = (t.operate().0, t.expiry().0 - t.recovery().0);
        let (mut interruption, mut shortened) = (t.interruption().0, t.shortened_operate().0);
        match DEFECT {
            LATE_EXPIRY => mask += 1,
            EARLY_EXPIRY => mask -= 1,
            NO_LIMIT => interruption = t.expiry().0,
            SHORT_OPERATE => operate -= 1,
            LONG_SHORTENED_OPERATE => shortened += 1,
            _ => {}
        }
        let [operate, mask, interruption, shortened] = [operate, mask, interruption, shortened].map(Ticks);
        Times::from_ticks(operate, t.recovery(), mask, interruption, shortened).expect("times that are wrong but valid")
    }
}

impl<const DEFECT: u8, const N: usize> Machine for Wrong<DEFECT, N> {
    type State = State<N>;
    type Input = AspectSet;
    type Output = Display;

    const SAFE: Display = Display::NOTHING;

    fn initial(&self) -> State<N> {
        State::INITIAL
    }

    fn step(&self, state: State<N>, detected: AspectSet) -> (State<N>, Display) {
        let mut before: Parts<N> = state.parts();
        if DEFECT == NO_GUARD {
            before.last = 1 << (N - 1);
        }
        if DEFECT == DROP_REVOKED {
            before.dropped = 0;
        }
        let (next, display) = step(self.kept(), State::from_parts(before), detected);
        let mut after = next.parts();
        match DEFECT {
            AGE_RESTARTS => {
                for (age, run) in after.age.iter_mut().zip(after.run) {
                    *age = if *age > 0 && run > 0 { run + 1 } else { *age };
                }
            }
            NO_MASK_LAPSE => after.dropped = 0,
            _ => {}
        }
        let satisfied = next.satisfied().bits();
        let highest = if satisfied == 0 { 0 } else { 1 << satisfied.ilog2() };
        let display = if DEFECT == HIGHEST_SHOWN { Display::from_bits(highest) } else { display };
        (State::from_parts(after), display)
    }
}

impl<const DEFECT: u8, const N: usize> Device for Wrong<DEFECT, N> {
    fn with(times: Times) -> Self {
        Self { times }
    }
    fn times(&self) -> Times {
        self.times
    }
    fn is_valid(&self, _: &State<N>) -> bool {
        true
    }
    fn satisfied(&self, state: &State<N>) -> AspectSet {
        state.satisfied()
    }
    fn dropped(&self, state: &State<N>) -> AspectSet {
        AspectSet::from_bits(state.parts().dropped)
    }
    fn credited(&self, state: &State<N>) -> AspectSet {
        AspectSet::from_bits(state.parts().credited)
    }
}

/// The outcome is complete, not ok, and `property` has `verdict`; a failure comes with a trace.
fn red(outcome: &Outcome, property: &str, verdict: Verdict) {
    assert!(outcome.complete && !outcome.ok());
    let found = outcome.properties.iter().find(|p| p.name == property).expect("a property of the model");
    assert_eq!(found.verdict, verdict, "{property}");
    assert_eq!(found.trace.is_some(), verdict == Verdict::Failed, "{property}");
}

fn comparison<D: Device>(line: Line) -> Outcome {
    outcome(Comparison::<D, 2>::new(line, &[Extra::Credit, Extra::Mask, Extra::Rise]))
}

fn interruption<D: Device>(line: Line) -> Outcome {
    outcome(Interruption::<D>::new(line))
}

fn exposure<D: Device>(line: Line, burst: u8) -> Outcome {
    let environment = Environment {
        ground: Ground::Any { dwell: 1, silence: true },
        interruption: Longest::Unlimited,
        between: 0,
        burst,
        spacing: 1,
    };
    outcome(Reception::<D, 2>::new(line, environment, Purpose::Exposure(Bound::ShortBursts)))
}

fn restrictive<D: Device>(line: Line, interruption: Longest, burst: u8) -> Outcome {
    let environment = Environment { ground: Ground::Lowest, interruption, between: 1, burst, spacing: 1 };
    outcome(Reception::<D, 2>::new(line, environment, Purpose::Restrictive))
}

#[test]
fn the_kernel_itself_is_green() {
    assert!(comparison::<Acceptance<2>>(COARSE).ok());
    assert!(interruption::<Acceptance<1>>(COARSE).ok());
    assert!(exposure::<Acceptance<2>>(LATE, 1).ok());
    assert!(restrictive::<Acceptance<2>>(COARSE, Longest::Cycles(3), 3).ok());
}

#[test]
fn the_machine_as_claimed() {
    red(&comparison::<Claimed<2>>(COARSE), "rise-has-evidence", Verdict::Failed);
}

#[test]
fn no_guard_on_a_rise() {
    red(&comparison::<Wrong<NO_GUARD, 2>>(COARSE), "rise-has-evidence", Verdict::Failed);
}

#[test]
fn age_restarts_on_redetection() {
    red(&exposure::<Wrong<AGE_RESTARTS, 2>>(LATE, 1), "exposure-bounded", Verdict::Failed);
    red(&interruption::<Wrong<AGE_RESTARTS, 1>>(LATE), "gone-at-expiry", Verdict::Failed);
}

#[test]
fn expiry_one_cycle_late() {
    red(&exposure::<Wrong<LATE_EXPIRY, 2>>(COARSE, 0), "exposure-bounded", Verdict::Failed);
    red(&interruption::<Wrong<LATE_EXPIRY, 1>>(COARSE), "gone-at-expiry", Verdict::Failed);
}

#[test]
fn expiry_one_cycle_early() {
    red(&exposure::<Wrong<EARLY_EXPIRY, 2>>(COARSE, 0), "exposure-tight", Verdict::NotFound);
    red(&interruption::<Wrong<EARLY_EXPIRY, 1>>(COARSE), "holds-until-expiry", Verdict::Failed);
}

#[test]
fn credit_without_its_limit() {
    red(&interruption::<Wrong<NO_LIMIT, 1>>(EARLY), "drop", Verdict::Failed);
}

#[test]
fn operate_time_one_cycle_short() {
    red(&comparison::<Wrong<SHORT_OPERATE, 2>>(COARSE), "rise-has-evidence", Verdict::Failed);
    let misread = restrictive::<Wrong<SHORT_OPERATE, 2>>(COARSE, Longest::Unlimited, 2);
    red(&misread, "stays-restrictive", Verdict::Failed);
}

#[test]
fn shortened_operate_time_one_cycle_long() {
    red(&interruption::<Wrong<LONG_SHORTENED_OPERATE, 1>>(COARSE), "no-drop", Verdict::Failed);
}

#[test]
fn a_mask_that_does_not_lapse() {
    red(&comparison::<Wrong<NO_MASK_LAPSE, 2>>(COARSE), "mask-lapses-above", Verdict::NotFound);
}

#[test]
fn a_drop_is_revoked() {
    red(&comparison::<Wrong<DROP_REVOKED, 2>>(COARSE), "fall-has-evidence", Verdict::Failed);
}

#[test]
fn the_highest_is_shown() {
    red(&comparison::<Wrong<HIGHEST_SHOWN, 2>>(COARSE), "heard-aspect-binds", Verdict::Failed);
    let misread = restrictive::<Wrong<HIGHEST_SHOWN, 2>>(COARSE, Longest::Cycles(3), 3);
    red(&misread, "stays-restrictive", Verdict::Failed);
}
