//! The ground's device as one machine: T-WAY of `spec/theorems.md`, a harness for each hand-off between its parts.
//!
//! What the parts guarantee is proven elsewhere (T-BLK, T-ILK, T-ATC, T-TEL) and supposed here where it is needed. A sentence about a
//! train has a train in its harness: on metres, with a front and a tail.

mod consent;
mod counter;
mod direction;
mod occupancy;
mod speech;

use crate::{Engine, Harness};
use atc_kernel::aspect::{AspectId, AspectTable};
use atc_kernel::block::{Detection, SectionSet};
use atc_kernel::code::{CodeFrequencies, CodeTable, MAX_CODES, Millihertz};
use atc_kernel::distance::Metres;
use atc_kernel::interlocking::{CircuitSet, Layout, MAX_CIRCUITS, Orders, Plan, Positions};
use atc_kernel::speed::KmhTenths;
use atc_kernel::telegram::{Gradient, SectionId};
use atc_kernel::time::Ticks;
use atc_kernel::wayside::{Equipment, Facing, Fixed, Framed, Input, Join, Session, SignalPlan, Wayside};

/// The harnesses of this module.
#[cfg(not(chosen))]
pub const ALL: &[Harness] = &[
    occupancy::t_way_1::HARNESS,
    occupancy::t_way_2::HARNESS,
    speech::t_way_3::HARNESS,
    speech::t_way_3_train::HARNESS,
    speech::t_way_3_sub::HARNESS,
    speech::t_way_4::HARNESS,
    consent::t_way_5::HARNESS,
    consent::t_way_5_told::HARNESS,
    counter::t_way_6::HARNESS,
    direction::t_way_7::HARNESS,
    speech::t_way_8_sent::HARNESS,
    occupancy::way_join::HARNESS,
    speech::way_signals::HARNESS,
];

/// The longest loop: over what there is for each circuit.
pub(crate) const LONGEST: usize = MAX_CIRCUITS;

/// The circuits of the layouts here: numbers 0 to 15.
const CIRCUITS: usize = 16;

/// What the transmitters say where it plays no part: the two numbers of each circuit, one speed, one pair of codes.
fn plain_signals(circuits: usize) -> Option<SignalPlan> {
    let stop = AspectId::new(0)?;
    let numbered = |number: u16, heading: u16| Facing {
        section: SectionId(2 * number + heading),
        gradient: Gradient(0),
        curve: stop,
    };
    let mut plan = SignalPlan {
        circuits: [None; MAX_CIRCUITS],
        speeds: [None; atc_kernel::interlocking::MAX_CODES],
        aspects: AspectTable::new(&[KmhTenths(0)]).ok()?,
        codes: plain_codes()?,
    };
    plan.speeds[0] = Some(KmhTenths(0));
    for (number, circuit) in (0_u16..).zip(plan.circuits.iter_mut().take(circuits)) {
        *circuit = Some(Fixed { left: numbered(number, 0), right: numbered(number, 1) });
    }
    Some(plan)
}

/// One code on each carrier, and the pair of them for speed 0.
fn plain_codes() -> Option<CodeTable> {
    let one = CodeFrequencies::new(&[Millihertz(10_000)], Millihertz(1_000)).ok()?;
    let mut speeds = [[None; MAX_CODES]; MAX_CODES];
    speeds[0][0] = Some(KmhTenths(0));
    CodeTable::new(one, one, speeds).ok()
}

/// A plan whose circuits are 100 m long.
fn plan<const R: usize, const P: usize, const S: usize>() -> Plan<R, P, 0, S> {
    with_lengths(Plan { clear: 1, turn: Ticks(1), ..Plan::EMPTY })
}

/// The plan with circuits that are 100 m long.
fn with_lengths<const R: usize, const P: usize, const S: usize>(mut plan: Plan<R, P, 0, S>) -> Plan<R, P, 0, S> {
    for length in plan.lengths.iter_mut().take(CIRCUITS) {
        *length = Metres(100);
    }
    plan
}

/// A device with what plays no part, in the first `circuits` circuits.
fn device<'a, E: Engine + ?Sized, const B: usize, const R: usize, const P: usize, const S: usize>(
    e: &mut E,
    layout: &'a Layout<R, P, 0, S>,
    counted: Option<Join<B>>,
    (life, circuits): (Ticks, usize),
) -> Option<Wayside<'a, B, R, P, 0, S>> {
    let signals = plain_signals(circuits)?;
    let session = Session(e.word("number of the start", 0..=1));
    let made = Wayside::new(layout, &Equipment { counted, signals, life, session }).ok();
    e.assume(made.is_some());
    made
}

/// Nothing happens.
fn quiet<const B: usize, const S: usize>() -> Input<B, S> {
    let still = Detection { low_check: false, high_check: false, present: SectionSet::EMPTY, reset: None };
    Input {
        blocks: [still; B],
        occupied: CircuitSet::EMPTY,
        detected: Positions::NONE,
        request: None,
        orders: Orders::default(),
        messages: [None; S],
        framed: Framed::default(),
    }
}
