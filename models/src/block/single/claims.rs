//! What is claimed of one block, and its parameters in words.

use super::{Beyond, Purpose, Single};
use crate::block::device::Counting;
use crate::block::fault::Faults;
use crate::subject::Claim;
use atc_kernel::block::Status;

impl<D: Counting> Single<D> {
    pub(super) fn purpose_claims(&self) -> Vec<Claim<Self>> {
        let mut claims = vec![Claim::<Self>::always("valid", "the machine's state keeps its invariant", |m, s| {
            s.kernel.is_valid(m.block())
        })];
        let (text, lost) = ("a section that a train holds is reported free", "agreement is lost and reached again");
        match self.purpose {
            Purpose::Safe => claims.push(Claim::<Self>::always(
                "train-reported",
                "every section with a head or a tail is reported occupied, or asked of the block behind",
                |_, s| !s.hazard,
            )),
            Purpose::Hazard(excluded_by) | Purpose::CutSets(excluded_by) => {
                claims.push(Claim::<Self>::hazard("train-unreported", text, excluded_by, |_, s| s.hazard));
            }
        }
        let undisturbed = self.faults == [Faults::NONE];
        if undisturbed && matches!(self.beyond, Beyond::Nothing | Beyond::SilentBorders | Beyond::LoudBorders) {
            claims.push(Claim::<Self>::always(
                "exact",
                "while it is in force the count is the number of trains",
                |m, s| {
                    let parts = s.kernel.parts();
                    parts.status != Status::Counting || parts.count == m.inside(&s.trains)
                },
            ));
        }
        if undisturbed && self.beyond == Beyond::Nothing {
            claims.push(Claim::<Self>::always("no-fault", "no fault is latched", |_, s| {
                !matches!(s.kernel.parts().status, Status::Fault(_))
            }));
        }
        if let Purpose::Hazard(_) = self.purpose {
            return claims;
        }
        claims.push(Claim::<Self>::sometimes(
            "agreement",
            "count and detectors agree while every train is inside",
            |m, s| m.available(s) && m.inside(&s.trains) == m.trains,
        ));
        claims.push(Claim::<Self>::sometimes("available-again", lost, |m, s| s.lost && m.available(s)));
        claims
    }

    pub(super) fn describe(&self) -> String {
        let Self { sections, trains, tail, hold, pass, apart, .. } = self;
        format!(
            "{sections} sections, up to {trains} trains, tails up to {tail} and a hold of {hold} sections behind the head, \
             pass time {pass} cycles, entries {apart} cycles apart or more"
        )
    }
}
