//! What the transmitters say of the line: the sections' numbers and fixed data, the speeds of the codes, their ranks and pairs.

use super::WaysideError;
use crate::aspect::{AspectId, AspectTable};
use crate::code::{Code, CodeTable};
use crate::distance::Metres;
use crate::interlocking::{CircuitId, CircuitSet, Heading, Layout, MAX_CODES, PerCircuit, Size, Small, SpeedCode};
use crate::speed::KmhTenths;
use crate::telegram::{Gradient, Length, SectionId};

/// What trains of one direction of travel are told of a circuit.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Facing {
    /// The number by which they know it: odd for those towards the left, even for those towards the right.
    pub section: SectionId,
    /// The least favourable gradient from any place of the circuit to the points where its telegrams may stop a train.
    pub gradient: Gradient,
    /// The limit by curves and points.
    pub curve: AspectId,
}

/// What trains are told of a circuit. Its length is the layout's.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Fixed {
    /// Those that travel towards the left.
    pub left: Facing,
    /// Those that travel towards the right.
    pub right: Facing,
}

impl Fixed {
    /// What trains of this direction of travel are told.
    pub const fn facing(&self, heading: Heading) -> Facing {
        match heading {
            Heading::Left => self.left,
            Heading::Right => self.right,
        }
    }
}

/// The two code frequencies that name a speed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Codes {
    /// The code of the main carrier.
    pub main: Code,
    /// The code of the sub carrier.
    pub sub: Code,
}

/// What is said of the line. Not checked.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SignalPlan<Z: Size = Small> {
    /// The circuits to which something is sent.
    pub circuits: PerCircuit<Option<Fixed>, Z>,
    /// The speed that each speed code of the layout stands for; none where there is no such code.
    pub speeds: [Option<KmhTenths>; MAX_CODES],
    /// The line's speeds, as trains have them: what the ranks in telegrams mean.
    pub aspects: AspectTable,
    /// The pairs of code frequencies, as trains have them.
    pub codes: CodeTable,
}

/// A speed code as trains hear it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Word {
    /// The rank in telegrams.
    pub rank: AspectId,
    /// The pair of code frequencies.
    pub codes: Codes,
}

/// What is said of the line, checked against the layout.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Signals<Z: Size = Small> {
    circuits: PerCircuit<Option<(Fixed, Length)>, Z>,
    words: [Option<Word>; MAX_CODES],
    /// Speed 0.
    stop: Word,
}

impl<Z: Size> Signals<Z> {
    /// Checks `plan` against `layout`.
    ///
    /// # Errors
    /// The first rule of WAY-16 to WAY-19 that is broken.
    #[inline(never)]
    pub fn new<const R: usize, const P: usize, const N: usize, const S: usize>(
        layout: &Layout<R, P, N, S, Z>,
        plan: &SignalPlan<Z>,
    ) -> Result<Self, WaysideError> {
        let words = words(&plan.speeds, &plan.aspects, &plan.codes)?;
        check_codes(&words, &layout.plan().braking)?;
        let Some(stop) = words.first().copied().flatten() else { return Err(WaysideError::StopMoves) };
        Ok(Self {
            circuits: circuits(used(layout), &layout.plan().lengths, &plan.circuits, &plan.aspects)?,
            words,
            stop,
        })
    }

    /// Signals as they are given, for proofs: nothing of them is checked.
    pub const fn from_parts(
        circuits: PerCircuit<Option<(Fixed, Length)>, Z>,
        words: [Option<Word>; MAX_CODES],
        stop: Word,
    ) -> Self {
        Self { circuits, words, stop }
    }

    /// What is said of a circuit, and its length; none if nothing is sent there.
    #[inline]
    pub fn circuit(&self, circuit: CircuitId) -> Option<(Fixed, Length)> {
        self.circuits.get(usize::from(circuit.number())).copied().flatten()
    }

    /// How trains hear a speed code: the highest that is known and not above it.
    #[inline]
    pub const fn word(&self, code: SpeedCode) -> Word {
        //= spec/wayside.md#way-4-the-speed
        //# The rank and the pair of codes MUST be those of the movement's speed code, or of a lower one where the line has no such code.
        let mut said = self.stop;
        let mut number = 0;
        while number < MAX_CODES {
            if let Some(word) = self.words[number] {
                if number <= code.0 as usize {
                    said = word;
                }
            }
            number += 1;
        }
        said
    }

    /// How trains hear that they must stop.
    pub const fn stop(&self) -> Word {
        self.stop
    }
}

/// The speed codes as trains hear them, each with the rank and the pair of its speed.
///
/// # Errors
/// The first rule of WAY-16 that is broken.
#[inline(never)]
pub fn words(
    speeds: &[Option<KmhTenths>; MAX_CODES],
    aspects: &AspectTable,
    codes: &CodeTable,
) -> Result<[Option<Word>; MAX_CODES], WaysideError> {
    check_speeds(speeds)?;
    // The first error is kept, and the loop goes on: one way through it is what a prover unrolls.
    let mut wrong = None;
    let mut words = [None; MAX_CODES];
    for (number, (word, speed)) in (0_u8..).zip(words.iter_mut().zip(speeds)) {
        if let Some(speed) = *speed {
            let spelt = spell(aspects, codes, SpeedCode(number), speed);
            wrong = wrong.or(spelt.err());
            *word = spelt.ok();
        }
    }
    wrong.map_or(Ok(words), Err)
}

/// Whether code 0 is of speed 0, and no speed is under that of a lower code.
///
/// # Errors
/// [`WaysideError::StopMoves`] or [`WaysideError::SpeedsFall`].
#[inline]
pub fn check_speeds(speeds: &[Option<KmhTenths>; MAX_CODES]) -> Result<(), WaysideError> {
    //= spec/wayside.md#way-16-the-codes
    //# The constructor MUST reject signals whose code 0 is not of speed 0, with a code whose speed is under that of a lower code, or with a speed that is not in the trains' table of speeds or has no pair of codes.
    let stops = speeds[0] == Some(KmhTenths(0));
    let mut wrong = if stops { None } else { Some(WaysideError::StopMoves) };
    let mut before = None;
    for (number, speed) in (0_u8..).zip(speeds) {
        if let Some(speed) = *speed {
            if before.is_some_and(|before| speed < before) {
                wrong = wrong.or(Some(WaysideError::SpeedsFall(SpeedCode(number))));
            }
            before = Some(speed);
        }
    }
    wrong.map_or(Ok(()), Err)
}

/// How trains hear `speed`, that of `code`.
///
/// # Errors
/// [`WaysideError::NoRank`] or [`WaysideError::NoPair`], of `code`.
#[inline]
pub fn spell(
    aspects: &AspectTable,
    codes: &CodeTable,
    code: SpeedCode,
    speed: KmhTenths,
) -> Result<Word, WaysideError> {
    let rank = aspects.aspect(speed).ok_or(WaysideError::NoRank(code))?;
    let codes = pair(codes, speed).ok_or(WaysideError::NoPair(code))?;
    Ok(Word { rank, codes })
}

/// The first pair of codes that names exactly this speed.
#[inline(never)]
fn pair(codes: &CodeTable, speed: KmhTenths) -> Option<Codes> {
    let mut found = None;
    for row in 0..8_u8 {
        for column in 0..8_u8 {
            let (Some(main), Some(sub)) = (Code::new(row), Code::new(column)) else { continue };
            if found.is_none() && codes.speed(Some(main), Some(sub)) == Some(speed) {
                found = Some(Codes { main, sub });
            }
        }
    }
    found
}

/// Checks that there is a word for each code that can be told.
///
/// # Errors
/// [`WaysideError::CodeWithoutSpeed`] for the first code without one.
#[inline]
pub fn check_codes(words: &[Option<Word>; MAX_CODES], braking: &[Metres; MAX_CODES]) -> Result<(), WaysideError> {
    for (word, (code, braking)) in words.iter().zip((0_u8..).zip(braking)) {
        //= spec/wayside.md#way-17-every-code
        //# The constructor MUST reject signals without a speed for a code for which the layout has a braking distance.
        if word.is_none() && *braking < Metres(u16::MAX) {
            return Err(WaysideError::CodeWithoutSpeed(SpeedCode(code)));
        }
    }
    Ok(())
}

/// The circuits that are `described`, with their `lengths`; `used` are those in which a train may wait for a telegram, or run by one.
///
/// # Errors
/// The first rule of WAY-18 and WAY-19 that is broken.
#[inline(never)]
pub fn circuits<Z: Size>(
    used: CircuitSet<Z>,
    lengths: &PerCircuit<Metres, Z>,
    described: &PerCircuit<Option<Fixed>, Z>,
    aspects: &AspectTable,
) -> Result<PerCircuit<Option<(Fixed, Length)>, Z>, WaysideError> {
    let mut kept = PerCircuit::all(None);
    for (index, place) in kept.iter_mut().enumerate() {
        let circuit = CircuitSet::<Z>::nth(index).first().unwrap_or(CircuitId::ZERO);
        let Some(fixed) = described[index] else {
            //= spec/wayside.md#way-18-every-circuit
            //# The constructor MUST reject signals that say nothing of a circuit of a path, an entry or a segment, or that are for a circuit without a length, or with a curve limit that is not in the trains' table of speeds.
            if used.has(circuit) {
                return Err(WaysideError::CircuitWithoutSignals(circuit));
            }
            continue;
        };
        let Some(length) = Length::new(lengths[index]) else {
            return Err(WaysideError::NoLength(circuit));
        };
        let known = |rank| aspects.speed(rank).is_some();
        if !known(fixed.left.curve) || !known(fixed.right.curve) {
            return Err(WaysideError::UnknownCurve(circuit));
        }
        //= spec/wayside.md#way-19-two-numbers-a-circuit
        //# The constructor MUST reject signals in which one section number stands for two circuits, or in which a section number is even for trains towards the left or odd for those towards the right.
        let wrong = |heading| fixed.facing(heading).section.heading() != heading;
        if wrong(Heading::Left) || wrong(Heading::Right) {
            return Err(WaysideError::SectionNumberOfOther(circuit));
        }
        if clashes(described, index, fixed) {
            return Err(WaysideError::SectionNumberTwice(circuit));
        }
        *place = Some((fixed, length));
    }
    Ok(kept)
}

/// Whether a number of the circuit at `index` stands for a circuit before it, for the same direction of travel.
#[inline(never)]
fn clashes<Z: Size>(circuits: &PerCircuit<Option<Fixed>, Z>, index: usize, fixed: Fixed) -> bool {
    let (left, right) = (fixed.left.section, fixed.right.section);
    let mut clash = false;
    for its in circuits.iter().take(index).flatten() {
        clash |= its.left.section == left;
        clash |= its.right.section == right;
    }
    clash
}

/// The circuits in which a train may wait for a telegram, or run by one.
#[inline(never)]
fn used<const R: usize, const P: usize, const N: usize, const S: usize, Z: Size>(
    layout: &Layout<R, P, N, S, Z>,
) -> CircuitSet<Z> {
    let mut used = CircuitSet::EMPTY;
    for route in &layout.plan().routes {
        used = used.or(route.held_from(0).circuits).or(route.entry.only_if(route.exists()));
    }
    for segment in &layout.plan().segments {
        used = used.or(segment.all());
    }
    used
}
