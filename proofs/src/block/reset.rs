//! Resets (T-BLK-2) and the exactness of the count (T-BLK-5).

use super::{any_cycle, ones};
use atc_kernel::block::Status;

harness! {
    /// A reset is accepted exactly under its conditions, and then agrees with the detectors; a refused one leaves the block
    /// unverified.
    t_blk_2_reset(e)
    theorem "T-BLK-2";
    requirements ["BLK-4"];
    assumptions [];
    bound "";
    cases 1;
    unwind 18 = 1 + crate::block::LONGEST;
    claims {
        Accepted: "after a reset the count is in force if and only if it was verified as the detectors have it, at most the maximum, with both checks off and nothing pending",
        Agrees: "after an accepted reset the count is the verified number and the report that of the detectors",
        Refused: "after a refused reset the block is unverified, with nothing counted",
    }
    covers {
        FromStart: "a reset of an unverified block is accepted",
        FromFault: "a reset after a fault is accepted",
        CheckOn: "a reset is refused because a check is on",
        Pending: "a reset is refused because a check-out is pending",
        Wrong: "a reset is refused because the detectors do not agree",
        AtMaximum: "a reset with one train more than the maximum is refused",
    }
    {
        let Some(cycle) = any_cycle(e) else { return };
        let (before, after, input) = (cycle.before, cycle.after, cycle.input);
        let Some(verified) = input.reset.map(|number| u32::from(number.0)) else { return e.assume(false) };
        let (detected, max) = (ones(cycle.detected()), u32::from(cycle.block.max_trains().0));
        let checks_off = !input.check_in && !input.check_out;
        let legal = verified == detected && verified <= max && checks_off && before.pending == 0;
        e.claim(Claim::Accepted as u32, cycle.counts() == legal);
        e.claim(
            Claim::Agrees as u32,
            !legal || u32::from(after.count) == verified && after.pending == 0 && cycle.output.agree,
        );
        e.claim(
            Claim::Refused as u32,
            legal || after.status == Status::Unverified && after.count == 0 && after.pending == 0 && !cycle.output.agree,
        );
        e.cover(Cover::FromStart as u32, legal && before.status == Status::Unverified);
        e.cover(Cover::FromFault as u32, legal && matches!(before.status, Status::Fault(_)));
        e.cover(Cover::CheckOn as u32, !checks_off && verified == detected && verified <= max && before.pending == 0);
        e.cover(Cover::Pending as u32, checks_off && verified == detected && verified <= max && before.pending > 0);
        e.cover(Cover::Wrong as u32, checks_off && verified != detected && before.pending == 0);
        e.cover(Cover::AtMaximum as u32, checks_off && verified == detected && verified == max + 1 && before.pending == 0);
    }
}

harness! {
    /// Exactness: while the count is in force it moves by exactly the counted edges; a check-out counts only once the block
    /// ahead has the train; after a fault only what was pending goes on; the levels are followed always.
    t_blk_5(e)
    theorem "T-BLK-5";
    requirements ["BLK-6", "BLK-7"];
    assumptions [];
    bound "";
    cases 1;
    unwind 18 = 1 + crate::block::LONGEST;
    claims {
        Count: "the count rises by one for a counted check-in and falls by one for a check-out that takes effect, and the report tells both",
        CountedIn: "a check-in is counted if and only if it rises and the count is in force",
        CountedOut: "a check-out takes effect if and only if one is pending or rises, and the block ahead has the train",
        Pending: "what is pending rises by one for a check-out that rises while the count is in force, and falls by one for one that takes effect",
        Levels: "the levels of both checks are followed, whatever the status",
    }
    covers {
        AtOnce: "a check-out takes effect in the cycle in which it rises",
        Later: "a check-out takes effect later",
        Waits: "a check-out waits",
        AfterFault: "a check-out takes effect after a fault",
        Both: "a check-in and a check-out in one cycle",
    }
    {
        let Some(cycle) = any_cycle(e) else { return };
        let (before, after, input, output) = (cycle.before, cycle.after, cycle.input, cycle.output);
        let rises_in = input.check_in && before.check_in_for == 0;
        let rises_out = input.check_out && !before.check_out;
        let counts = cycle.counts() && input.reset.is_none();
        let reset = input.reset.is_some();
        let asked = u32::from(before.pending) + u32::from(counts && rises_out);
        let moved = u32::from(before.count) + u32::from(output.counted_in) == u32::from(after.count) + u32::from(output.counted_out);
        e.claim(Claim::Count as u32, (reset || moved) && output.count.0 == after.count);
        e.claim(Claim::CountedIn as u32, reset || output.counted_in == (counts && rises_in));
        e.claim(Claim::CountedOut as u32, reset || output.counted_out == (asked > 0 && input.ahead_entered));
        e.claim(Claim::Pending as u32, reset || u32::from(after.pending) + u32::from(output.counted_out) == asked);
        let limit = u32::from(cycle.block.pass().0) + 1;
        let on_for = if input.check_in { (u32::from(before.check_in_for) + 1).min(limit) } else { 0 };
        e.claim(Claim::Levels as u32, u32::from(after.check_in_for) == on_for && after.check_out == input.check_out);
        e.cover(Cover::AtOnce as u32, output.counted_out && before.pending == 0);
        e.cover(Cover::Later as u32, output.counted_out && !rises_out);
        e.cover(Cover::Waits as u32, counts && after.pending > before.pending);
        e.cover(Cover::AfterFault as u32, output.counted_out && matches!(before.status, Status::Fault(_)));
        e.cover(Cover::Both as u32, output.counted_in && output.counted_out && rises_out);
    }
}
