//! The numbers of telegrams (T-WAY-6).

use super::{CIRCUITS, LONGEST, device, plan, quiet};
use crate::any_byte;
use crate::engine::any_u32;
use atc_kernel::Machine;
use atc_kernel::interlocking::{CircuitSet, Layout};
use atc_kernel::telegram::Counter;
use atc_kernel::time::Ticks;
use atc_kernel::wayside::{Counters, Framed};

harness! {
    /// A transmitter's telegrams are numbered as they are taken: with a ghost that remembers the number of one of them. No other telegram of the 255 that
    /// follow on its carrier has it, and none is passed over.
    t_way_6(e)
    theorem "T-WAY-6";
    requirements ["WAY-7"];
    assumptions [];
    bound "1 route, 16 circuits";
    cases 1;
    unwind 65 = 1 + LONGEST;
    claims {
        Follows: "the number is that of the ghost's telegram and as many more as were taken since",
        Unused: "the next telegram has another number than the ghost's, for 255 telegrams",
        Unsent: "while nothing is taken the number stays, also where a transmitter says so that was silent",
        Own: "a carrier's number depends on what is taken of it in its own circuit alone",
    }
    covers {
        Taken: "a telegram is taken",
        Round: "the numbers begin anew",
        Silent: "frames are said to be taken where there were none",
        Other: "only the other carrier's are taken",
    }
    {
        let mut made = plan::<1, 1, 1>();
        made.turn = Ticks(2);
        let Ok(layout) = Layout::with_what_proofs_need(made) else { return e.assume(false) };
        let Some(device) = device::<_, 0, 1, 1, 1>(e, &layout, None, (Ticks(1), 0)) else { return };
        let number = usize::from(e.word("circuit (number)", 0..=15));
        e.assume(number < CIRCUITS);
        let mut state = device.initial();
        let mut others = |what| Counter(any_byte(e, what, 0..=255));
        let (main, sub) = (others("number of the next main telegram"), others("number of the next sub telegram"));
        for (place, counters) in state.counters.iter_mut().enumerate() {
            if place == number {
                *counters = Counters { main, sub };
            }
        }
        state.sent = CircuitSet::from_bits(u64::from(any_u32(e, "sent (bits)", 0..=u16::MAX)));
        let framed = Framed {
            main: CircuitSet::from_bits(u64::from(any_u32(e, "main frames taken (bits)", 0..=u16::MAX))),
            sub: CircuitSet::from_bits(u64::from(any_u32(e, "sub frames taken (bits)", 0..=u16::MAX))),
        };
        // Ghost: the number of a main telegram that was taken, and how many since, itself included.
        let (ghost, since) = (any_byte(e, "number of a telegram that was taken", 0..=255), e.word("telegrams taken since", 1..=255));
        e.assume((1..=255).contains(&since) && ghost.wrapping_add(since.to_le_bytes()[0]) == main.0);
        let mut input = quiet();
        input.framed = framed;
        let (after, _) = device.read(state, input);
        let mut next = Counters::START;
        for (place, counters) in after.counters.into_iter().enumerate() {
            if place == number {
                next = counters;
            }
        }
        let there = state.sent.bits() >> number & 1 == 1;
        let taken = there && framed.main.bits() >> number & 1 == 1;
        let taken_sub = there && framed.sub.bits() >> number & 1 == 1;
        let now = since + u16::from(taken);
        e.claim(Claim::Follows as u32, next.main.0 == ghost.wrapping_add(now.to_le_bytes()[0]));
        e.claim(Claim::Unused as u32, now > 255 || next.main.0 != ghost);
        e.claim(Claim::Unsent as u32, taken || next.main == main);
        e.claim(Claim::Own as u32, next.sub.0 == sub.0.wrapping_add(u8::from(taken_sub)));
        e.cover(Cover::Taken as u32, taken);
        e.cover(Cover::Round as u32, taken && next.main.0 == 0);
        e.cover(Cover::Silent as u32, !there && framed.main.bits() >> number & 1 == 1);
        e.cover(Cover::Other as u32, taken_sub && !taken);
    }
}
