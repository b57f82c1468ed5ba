//! A layout with its memory, and what a page shows of it.

use atc_kernel::Machine as _;
use atc_kernel::interlocking::{
    CircuitSet, Combined, Heading, Layout, MAX_CIRCUITS, Memory, Movement, Phase, Refusal, SegmentSet, Station,
};

use crate::words::{input_of, plan_of, positions_word};

/// The routes of a plan of the greatest size.
const ROUTES: usize = 64;

/// How many words a cycle puts out.
pub const OUTPUT: usize = place::TELEGRAMS + MAX_CIRCUITS;

/// Where in the words of a cycle what stands.
pub mod place {
    /// The circuits that count as occupied.
    pub const OCCUPIED: usize = 0;
    /// The routes whose signals show proceed.
    pub const PROCEED: usize = 1;
    /// The points that are driven: to normal in the low half, to reverse in the high one.
    pub const DRIVES: usize = 2;
    /// The circuits that staff may rely on.
    pub const CONFIRMED: usize = 3;
    /// The blocked circuits.
    pub const BLOCKED: usize = 4;
    /// Segments, a byte each: where the neighbour may send; with the direction toward the station; away from it.
    pub const SEGMENTS: usize = 5;
    /// The answer: 0 none, 1 accepted, 2 and more refused, in the order of `Refusal`.
    pub const ANSWER: usize = 6;
    /// For each route its phase, in the order of `Phase`.
    pub const PHASES: usize = 7;
    /// For each route the circuits that it holds of its path.
    pub const PATHS: usize = PHASES + super::ROUTES;
    /// For each route the circuits that it holds of its overlap.
    pub const OVERLAPS: usize = PATHS + super::ROUTES;
    /// For each route the positions in which it locks points.
    pub const LOCKS: usize = OVERLAPS + super::ROUTES;
    /// For each circuit its telegram: bit 0 it leaves the circuit, 1 to the right, then bytes: stop circuit, code.
    pub const TELEGRAMS: usize = LOCKS + super::ROUTES;
}

/// A device: a layout with its memory.
#[derive(Clone, Debug)]
pub struct Device {
    layout: Box<Station>,
    memory: Memory<64, 8>,
}

impl Device {
    /// The device of a plan in words, just started; none if the plan breaks a rule that the theorems need.
    pub fn new(words: &[u64]) -> Option<Self> {
        let layout = Layout::with_what_proofs_need(plan_of(words)).ok()?;
        Some(Self { layout: Box::new(layout), memory: Memory::INITIAL })
    }

    /// Starts it anew.
    pub fn restart(&mut self) {
        self.memory = Memory::INITIAL;
    }

    /// One cycle: the words of the input in, what a page shows out.
    pub fn step(&mut self, input: &[u64]) -> [u64; OUTPUT] {
        let (memory, commands) = Combined(&self.layout).step(self.memory, input_of(input));
        self.memory = memory;
        let (plan, state, output) = (self.layout.plan(), &self.memory.interlocking, &commands.interlocking);
        let mut words = [0; OUTPUT];
        let mut occupied = CircuitSet::EMPTY;
        for (number, cycles) in state.track.clear_for().iter().enumerate() {
            occupied = occupied.or(CircuitSet::nth(number).only_if(*cycles < plan.clear));
        }
        words[place::OCCUPIED] = occupied.bits();
        words[place::PROCEED] = output.proceed.bits();
        words[place::DRIVES] = positions_word(output.drives);
        words[place::CONFIRMED] = output.confirmed.bits();
        words[place::BLOCKED] = state.works.blocked.bits();
        let byte = |set: SegmentSet, at: u32| u64::from(set.bits()) << (8 * at);
        let directions = &state.directions;
        words[place::SEGMENTS] = byte(output.permits, 0) | byte(directions.toward, 1) | byte(directions.away, 2);
        words[place::ANSWER] = match output.answer {
            None => 0,
            Some(Ok(())) => 1,
            Some(Err(refusal)) => 2 + refused(refusal),
        };
        for (number, (route, of)) in plan.routes.iter().zip(&state.routes).enumerate() {
            words[place::PHASES + number] = phase(of.phase);
            words[place::PATHS + number] = of.path(route).circuits.bits();
            words[place::OVERLAPS + number] = of.overlap(route).circuits.bits();
            words[place::LOCKS + number] = positions_word(of.positions(route));
        }
        for (number, told) in commands.telegrams.iter().enumerate() {
            words[place::TELEGRAMS + number] = telegram(*told);
        }
        words
    }
}

fn telegram(told: Option<Movement>) -> u64 {
    let Some(movement) = told.filter(Movement::is_open) else { return 0 };
    let right = u64::from(movement.heading == Some(Heading::Right));
    1 | right << 1 | u64::from(movement.stop.number()) << 8 | u64::from(movement.speed.0) << 16
}

const fn phase(phase: Phase) -> u64 {
    match phase {
        Phase::Idle => 0,
        Phase::Provisional => 1,
        Phase::Failed => 2,
        Phase::Set => 3,
        Phase::InUse => 4,
        Phase::Releasing => 5,
    }
}

const fn refused(refusal: Refusal) -> u64 {
    match refusal {
        Refusal::Unknown => 0,
        Refusal::Starting => 1,
        Refusal::AlreadyHeld => 2,
        Refusal::NotHeld => 3,
        Refusal::Conflict => 4,
        Refusal::PathHeld => 5,
        Refusal::OverlapHeld => 6,
        Refusal::PointLocked => 7,
        Refusal::Occupied => 8,
        Refusal::Unswept => 9,
        Refusal::Blocked => 10,
        Refusal::PointUnderTrain => 11,
        Refusal::Direction => 12,
        Refusal::Waiting => 13,
        Refusal::NotCalledFor => 14,
    }
}
