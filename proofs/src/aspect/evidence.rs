//! T-ACC-1: nothing is accepted, and nothing rises, without evidence.

use super::{Asked, BOUND, HEARD, Lane, any_cycle, any_rank, at_or_above, evident, has, lane, lowest, satisfied};
use crate::ASPECTS;

/// What an observer writes down who sees one aspect's detections and acceptances, and nothing else.
#[derive(Clone, Copy)]
struct History {
    /// Consecutive cycles in which it was heard, up to now (counted to T1).
    run: u16,
    /// Whether it was ever accepted.
    ever: bool,
    /// Cycles since it was accepted and heard (counted to T2+T3).
    since: u16,
    /// `since` when the present run began: g, glitches included.
    gap: u16,
}

impl History {
    const NONE: Self = Self { run: 0, ever: false, since: 0, gap: 0 };

    fn heard(self, asked: &Asked, heard: bool) -> Self {
        Self {
            run: if heard { self.run.saturating_add(1).min(asked.operate) } else { 0 },
            since: if self.ever { self.since.saturating_add(1).min(asked.expiry) } else { 0 },
            gap: if heard && self.run == 0 { self.since } else { self.gap },
            ..self
        }
    }

    fn accepted(self) -> Self {
        Self { ever: true, since: 0, ..self }
    }

    /// ACC-8: lost, and heard again after g cycles, g ≤ T4 and g < T2+T3.
    fn has_credit(self, asked: &Asked) -> bool {
        self.ever && self.run > 0 && self.gap <= asked.interruption && self.gap < asked.expiry
    }

    /// How the history goes with the state: what the machine remembers is what happened.
    fn matches(self, asked: &Asked, lane: Lane) -> bool {
        let firm = lane.accepted && lane.age == 0;
        lane.run == self.run
            && if firm {
                self.ever && self.since == 0
            } else if lane.accepted {
                self.ever
                    && self.since == lane.age
                    && (self.run == 0 || u32::from(self.gap) + u32::from(self.run) == u32::from(self.since))
            } else {
                lane.credited == self.has_credit(asked) && (!self.ever || self.since == asked.expiry)
            }
    }
}

harness! {
    /// An aspect is accepted when and only when it has been heard on T1 consecutive cycles, or on T5 with a credit
    /// as ACC-8 defines it, whatever the other aspects do.
    t_acc_1(e)
    theorem "T-ACC-1";
    requirements ["ACC-1", "ACC-8"];
    assumptions ["detected-throughout"];
    built_in HEARD;
    bound BOUND;
    cases 1;
    unwind 33 = 1 + crate::aspect::LONGEST;
    claims {
        OnlyOnEvidence: "an acceptance has T1 consecutive cycles, or T5 with a credit",
        OnEvidence: "T1 consecutive cycles, or T5 with a credit, are an acceptance",
        History: "what the machine remembers of an aspect is what happened to it",
        Start: "the initial state has no history",
    }
    covers {
        Full: "an acceptance on T1 cycles, never accepted before",
        Shortened: "an acceptance on T5 cycles",
        PastExpiry: "an acceptance on T5 cycles after the aspect was gone",
        Limit: "an interruption of exactly T4 with a credit",
        NoCredit: "T5 cycles without a credit",
    }
    {
        let Some(cycle) = any_cycle::<ASPECTS, E>(e) else { return };
        let asked = &cycle.asked;
        let rank = any_rank::<ASPECTS, E>(e);
        let (was, is) = (lane(&cycle.before, rank), lane(&cycle.after, rank));
        let before = History {
            run: e.word("history: run", was.run..=was.run),
            ever: e.word("history: ever accepted (odd: yes)", 0..=1) & 1 == 1,
            since: e.word("history: cycles since accepted and heard", if was.accepted { was.age..=was.age } else { asked.expiry..=asked.expiry }),
            gap: e.word("history: g of the present run", was.age.saturating_sub(was.run)..=was.age.saturating_sub(was.run)),
        };
        e.assume(before.matches(asked, was));

        let heard = before.heard(asked, has(cycle.detected, rank));
        let firm = |lane: Lane| lane.accepted && lane.age == 0;
        let accepted = firm(is) && !firm(was);
        let full = heard.run >= asked.operate;
        let shortened = heard.run >= asked.shortened && heard.has_credit(asked);
        let after = if firm(is) { heard.accepted() } else { heard };

        e.claim(Claim::OnlyOnEvidence as u32, !accepted || full || shortened);
        // A firm aspect that is heard stays firm; any other one needs the evidence.
        let due = full || shortened && !firm(was) || firm(was) && heard.run > 0;
        e.claim(Claim::OnEvidence as u32, firm(is) == due);
        e.claim(Claim::History as u32, after.matches(asked, is));
        let initial = lane(&atc_kernel::aspect::State::<ASPECTS>::INITIAL.parts(), rank);
        e.claim(Claim::Start as u32, History::NONE.matches(asked, initial));
        e.cover(Cover::Full as u32, accepted && full && !before.ever);
        e.cover(Cover::Shortened as u32, accepted && !full && was.accepted);
        e.cover(Cover::PastExpiry as u32, accepted && !full && !was.accepted);
        e.cover(Cover::Limit as u32, heard.gap == asked.interruption && accepted && !full);
        e.cover(Cover::NoCredit as u32, before.ever && !firm(is) && heard.run >= asked.shortened);
    }
}

harness! {
    /// The display rises above the last displayed aspect only if that aspect or a higher one has been heard on T1
    /// consecutive cycles up to now; any other rise shows an aspect that is accepted and heard now.
    t_acc_1_rise(e)
    theorem "T-ACC-1";
    requirements ["ACC-9"];
    assumptions ["detected-throughout"];
    built_in HEARD;
    bound BOUND;
    cases 1;
    unwind 33 = 1 + crate::aspect::LONGEST;
    claims {
        Rise: "a rise above the last display has T1 cycles of evidence now, of that aspect or a higher one",
        OtherRise: "any other rise shows an aspect that is accepted and heard now",
        Last: "the last display is remembered while nothing is displayed",
    }
    covers {
        Above: "a rise above the last display",
        FromNothing: "a rise from nothing, not above the last display",
        OfAnother: "a rise on the evidence of a higher aspect that is not displayed itself",
    }
    {
        let Some(cycle) = any_cycle::<ASPECTS, E>(e) else { return };
        let display = cycle.display.bits();
        let shown = lowest(satisfied(&cycle.before));
        let displayed_before = if shown <= cycle.before.last { shown } else { 0 };
        let evident = evident(&cycle);
        let above = display > cycle.before.last;
        let mut accepted_now = 0;
        for rank in 0..ASPECTS {
            let firm = has(cycle.after.accepted & cycle.detected, rank) && cycle.after.age[rank] == 0;
            accepted_now |= u16::from(firm) << rank;
        }

        e.claim(Claim::Rise as u32, !above || at_or_above(evident, display));
        let other = display > displayed_before && !above;
        e.claim(Claim::OtherRise as u32, !other || display & accepted_now == display);
        e.claim(Claim::Last as u32, cycle.after.last == if display == 0 { cycle.before.last } else { display });
        e.cover(Cover::Above as u32, above && cycle.before.last != 0);
        e.cover(Cover::FromNothing as u32, other);
        e.cover(Cover::OfAnother as u32, above && evident & display == 0);
    }
}
