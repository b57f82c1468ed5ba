//! Two channels: DUP-1 and DUP-2.

use crate::aspect::{BOUND, any_machine_state, same};
use crate::{ASPECTS, Harness};
use atc_kernel::Machine;
use atc_kernel::aspect::{AspectSet, Parts, State};
use atc_kernel::duplex::{Channel, Duplex, TRIPPED, output};
use core::cell::Cell;

/// The harnesses of this module.
#[cfg(not(chosen))]
pub const ALL: &[Harness] = &[dup_1::HARNESS, dup_1_any::HARNESS, dup_2::HARNESS];

/// Flips bit `bit` of the state in `channel`: its words in order, then the trip word.
fn flip<const N: usize>(channel: Channel<State<N>>, word: usize, bit: u16) -> Channel<State<N>> {
    let mask = 1 << (bit & 15);
    let mut parts: Parts<N> = channel.state.parts();
    for rank in 0..N {
        parts.run[rank] ^= if word == rank { mask } else { 0 };
        parts.age[rank] ^= if word == N + rank { mask } else { 0 };
    }
    parts.accepted ^= if word == 2 * N { mask } else { 0 };
    parts.dropped ^= if word == 2 * N + 1 { mask } else { 0 };
    parts.credited ^= if word == 2 * N + 2 { mask } else { 0 };
    parts.last ^= if word == 2 * N + 3 { mask } else { 0 };
    let trip = channel.trip ^ if word == 2 * N + 4 { mask.to_le_bytes()[0] } else { 0 };
    Channel { state: State::from_parts(parts), trip }
}

harness! {
    /// Any single corrupted bit of one channel's state leads to the safe output in the same cycle or leaves the
    /// output as it is, and no difference between the channels outlives the cycle unseen.
    dup_1(e)
    theorem "DUP-1";
    requirements ["DUP-1"];
    assumptions ["single-fault", "same-input"];
    built_in &[
        ("single-fault", "one bit of one channel is flipped, before the cycle"),
        ("same-input", "both channels step with one input"),
    ];
    bound BOUND;
    cases 1;
    unwind 33 = 1 + crate::aspect::LONGEST;
    claims {
        SafeOrSame: "with one bit flipped the output is the safe one or the one without the fault",
        NoneLatent: "after the cycle the two channels are equal, or the safe output is latched",
        Caught: "a flipped bit of the state or the trip word, whichever, is found in this cycle",
    }
    covers {
        Trips: "a flipped bit trips the comparison",
        Displaying: "an aspect is displayed without the fault",
        TripWord: "the flipped bit is in the trip word",
    }
    {
        let Some((machine, state)) = any_machine_state::<ASPECTS, E>(e) else { return };
        let input = AspectSet::from_bits(e.word("detected (bits)", 0..=u16::MAX));
        let words = 2 * ASPECTS + 5;
        let word = usize::from(e.word("word with the fault", 0..=u16::try_from(words).unwrap_or(1) - 1));
        let bit = e.word("bit with the fault", 0..=15);
        // Every bit there is: 16 in each word of the state, 8 in the trip word.
        e.assume(word < words && bit < if word == words - 1 { 8 } else { 16 });
        let in_a = e.word("channel with the fault (even: A)", 0..=1) & 1 == 0;

        let sound = Channel { state, trip: 0 };
        let faulty = flip(sound, word, bit);
        let pair = if in_a { Duplex { a: faulty, b: sound } } else { Duplex { a: sound, b: faulty } };
        let (_, expected) = machine.step(state, input);
        let (pair, agreed) = pair.step(&machine, input);
        e.claim(Claim::SafeOrSame as u32, agreed.is_none_or(|output| output.get() == expected));
        // Field by field, and not with the kernel's own comparison.
        let equal = same(&pair.a.state.parts(), &pair.b.state.parts()) && pair.a.trip == 0 && pair.b.trip == 0;
        let latched = pair.a.trip == TRIPPED && pair.b.trip == TRIPPED;
        e.claim(Claim::NoneLatent as u32, if agreed.is_some() { equal } else { latched });
        e.claim(Claim::Caught as u32, agreed.is_none());
        e.cover(Cover::Trips as u32, pair.is_tripped());
        e.cover(Cover::Displaying as u32, expected.bits() != 0);
        e.cover(Cover::TripWord as u32, word == words - 1);
    }
}

/// A machine that may do anything, not even the same thing twice: the first call gets the first result.
struct Anything {
    results: [(u16, u16); 2],
    calls: Cell<usize>,
    /// The states from which it was called.
    states: [Cell<u16>; 2],
}

impl Machine for Anything {
    type State = u16;
    type Input = ();
    type Output = u16;

    const SAFE: u16 = 0;

    fn initial(&self) -> u16 {
        0
    }

    fn step(&self, state: u16, (): ()) -> (u16, u16) {
        let call = self.calls.get();
        self.calls.set(call + 1);
        self.states[usize::from(call > 0)].set(state);
        if call == 0 { self.results[0] } else { self.results[1] }
    }
}

harness! {
    /// Whatever the two channels compute, an output comes out only if they agree in the state before, in the state
    /// after and in the output, and it is the one that they agree on; otherwise the safe output is latched.
    dup_2(e)
    theorem "DUP-2";
    requirements ["DUP-1", "DUP-2"];
    assumptions [];
    bound "";
    cases 1;
    unwind 33 = 1 + crate::aspect::LONGEST;
    claims {
        Agreement: "there is an output if and only if both channels agree in all three and neither has tripped",
        Value: "it is the output of both",
        Latch: "without an output both channels are tripped",
        Once: "each channel computes exactly once",
        Own: "each channel computes from its own state and keeps its own result",
    }
    covers {
        Agree: "the channels agree",
        OutputsOnly: "the channels agree in their outputs and not in their states",
    }
    {
        let mut any = || e.word("of any machine", 0..=1);
        let machine = Anything { results: [(any(), any()), (any(), any())], calls: Cell::new(0), states: Default::default() };
        let [trip_a, trip_b] = [any(), any()].map(|word| word.to_le_bytes()[0]);
        let before = Duplex { a: Channel { state: any(), trip: trip_a }, b: Channel { state: any(), trip: trip_b } };
        let (after, agreed) = before.step(&machine, ());
        let [(state_a, output_a), (state_b, output_b)] = machine.results;
        let agree = before.a.state == before.b.state && state_a == state_b && output_a == output_b;
        let sound = trip_a == 0 && trip_b == 0;
        e.claim(Claim::Agreement as u32, agreed.is_some() == (agree && sound));
        e.claim(Claim::Value as u32, agreed.is_none_or(|value| value.get() == output_a && value.get() == output_b));
        e.claim(Claim::Latch as u32, agreed.is_some() || after.a.trip == TRIPPED && after.b.trip == TRIPPED);
        e.claim(Claim::Once as u32, machine.calls.get() == 2);
        let from_own = machine.states[0].get() == before.a.state && machine.states[1].get() == before.b.state;
        e.claim(Claim::Own as u32, from_own && after.a.state == state_a && after.b.state == state_b);
        e.cover(Cover::Agree as u32, agreed.is_some());
        e.cover(Cover::OutputsOnly as u32, output_a == output_b && !agree && sound);
    }
}

harness! {
    /// For any machine: without a fault the two channels do what one would do and nothing trips; once tripped, with
    /// or without one more flipped bit, the output stays the safe one.
    dup_1_any(e)
    theorem "DUP-1";
    requirements ["DUP-1"];
    assumptions ["single-fault", "same-input"];
    built_in &[
        ("single-fault", "no bit is flipped, or one of one channel once it is tripped"),
        ("same-input", "both channels step as one machine does"),
    ];
    bound "";
    cases 1;
    unwind 33 = 1 + crate::aspect::LONGEST;
    claims {
        Transparent: "without a fault the output and the state are those of one machine",
        Latched: "once tripped, also with one bit flipped, the output stays the safe one and the channels stay tripped",
        Reset: "a maintenance reset, and the start, are two equal channels in the initial state, not tripped",
    }
    covers {
        NotSafe: "the output without a fault is not the safe one",
    }
    {
        let mut any = || e.word("of any machine", 0..=3);
        let result = (any(), any());
        let machine = Anything { results: [result; 2], calls: Cell::new(0), states: Default::default() };
        let state = any();
        let sound = Channel { state, trip: 0 };
        let (pair, agreed) = Duplex { a: sound, b: sound }.step(&machine, ());
        let after = Channel { state: result.0, trip: 0 };
        let unchanged = pair == Duplex { a: after, b: after } && !pair.is_tripped();
        let (bit, in_a) = (any() & 7, any() & 1 == 0);
        let tripped = |flips: bool| Channel { state, trip: TRIPPED ^ if flips { 1 << bit } else { 0 } };
        let (still, none) = Duplex { a: tripped(in_a), b: tripped(!in_a) }.step(&machine, ());
        let is_safe = none.is_none() && output::<Anything>(none) == Anything::SAFE;
        let start = Duplex::initial(&machine);
        e.claim(Claim::Transparent as u32, unchanged && output::<Anything>(agreed) == result.1 && agreed.is_some());
        e.claim(Claim::Latched as u32, is_safe && still.a.trip == TRIPPED && still.b.trip == TRIPPED);
        e.claim(Claim::Reset as u32, start.a == start.b && start.a.state == machine.initial() && !start.is_tripped());
        e.cover(Cover::NotSafe as u32, output::<Anything>(agreed) != Anything::SAFE);
    }
}
