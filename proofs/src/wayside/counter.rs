//! The numbers of telegrams (T-WAY-6).

use crate::engine::any_u32;
use crate::{Engine, any_byte};
use atc_kernel::interlocking::CircuitSet;
use atc_kernel::telegram::Counter;
use atc_kernel::wayside::{Counters, Framed};

/// Any set of all 64 circuits.
fn any_set<E: Engine + ?Sized>(e: &mut E, what: &'static str) -> CircuitSet {
    let high = u64::from(any_u32(e, what, 0..=u16::MAX));
    CircuitSet::from_bits(high << 32 | u64::from(any_u32(e, what, 0..=u16::MAX)))
}

harness! {
    /// A transmitter's telegrams are numbered as they are taken: with a ghost that remembers the number of one of them. No other telegram of the 255 that
    /// follow on its carrier has it, and none is passed over.
    t_way_6(e)
    theorem "T-WAY-6";
    requirements ["WAY-7"];
    assumptions [];
    bound "";
    cases 1;
    unwind 2 = 2;
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
        let number = usize::from(e.word("circuit (number)", 0..=63) & 63);
        let mut others = |what| Counter(any_byte(e, what, 0..=255));
        let (main, sub) = (others("number of the next main telegram"), others("number of the next sub telegram"));
        let sent = any_set(e, "sent (bits)");
        let framed = Framed {
            main: any_set(e, "main frames taken (bits)"),
            sub: any_set(e, "sub frames taken (bits)"),
        };
        // Ghost: the number of a main telegram that was taken, and how many since, itself included.
        let (ghost, since) = (any_byte(e, "number of a telegram that was taken", 0..=255), e.word("telegrams taken since", 1..=255));
        e.assume((1..=255).contains(&since) && ghost.wrapping_add(since.to_le_bytes()[0]) == main.0);
        let next = Counters { main, sub }.step(CircuitSet::nth(number), sent, framed);
        let there = sent.bits() >> number & 1 == 1;
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
