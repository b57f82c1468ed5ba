//! The run of a model, as it is drawn.

use super::{COMING, CountedBetween, Cycle, Outcome, RECEIVER, SENDER, State, Train, wrong};
use crate::interlocking::trace::Run;
use crate::outcome::Trace;
use atc_kernel::block::Detection;
use serde_json::{Value, json};
use std::collections::BTreeMap;

impl<const B: usize> CountedBetween<B> {
    /// The run of the sender's interlocking since its last start. The further words of a step: where the trains are, what both devices count, and
    /// what the receiver does.
    pub(super) fn run(&self, path: &[(State, Option<Cycle>)]) -> Trace {
        let names = ["platform", "throat", "s1", "s2", "s3", "s4", "s5", "s6"];
        let mut names: Vec<_> = names[..usize::from(self.beyond())].to_vec();
        names.push("beyond");
        let end = &self.ends[SENDER];
        let mut run = Run::begin("sender", &names, &end.layout);
        let started = path.iter().rposition(|(_, cycle)| cycle.is_some_and(|cycle| cycle.outcomes[SENDER].started));
        if started.is_none() {
            let mut device = end.initial();
            for read in end.prelude() {
                let made = end.step(device, read, self.wiring);
                device = made.device;
                run.step(&made.told, BTreeMap::from([("hazard".to_owned(), json!(false))]));
            }
        }
        for (place, (before, cycle)) in path.iter().enumerate().skip(started.unwrap_or(0)) {
            let (Some(cycle), Some((after, _))) = (cycle, path.get(place + 1)) else { break };
            let taken = self.known().taken[cycle.outcomes[SENDER].read as usize];
            let train = |train: &Train| match train.front {
                COMING => json!("coming"),
                _ => json!({"front": train.front, "rear": train.rear, "lost": train.lost}),
            };
            let trains: Vec<_> = cycle.trains[..usize::from(self.trains)].iter().map(train).collect();
            let words = BTreeMap::from([
                ("trains".to_owned(), json!(trains)),
                ("faults".to_owned(), json!(before.faults.words())),
                ("counted_by_the_sender".to_owned(), self.counted(&cycle.outcomes[SENDER])),
                ("counted_by_the_receiver".to_owned(), self.counted(&cycle.outcomes[RECEIVER])),
                ("receiver_proceed".to_owned(), json!(self.proceeds(RECEIVER, &cycle.outcomes[RECEIVER]))),
                ("receiver_permits".to_owned(), json!(cycle.outcomes[RECEIVER].permits)),
                ("receiver_starts".to_owned(), json!(cycle.outcomes[RECEIVER].started)),
                ("hazard".to_owned(), json!(after.wrong & wrong::MET != 0)),
            ]);
            run.step(&taken.told, words);
        }
        run.trace()
    }

    /// What a device read of the line, and how it counts after that.
    fn counted(&self, outcome: &Outcome) -> Value {
        let known = self.known();
        let taken = known.taken[outcome.read as usize];
        let after = known.device(outcome.device);
        let block = |block: usize| {
            let Detection { low_check, high_check, present, reset } = taken.read.blocks[block];
            let sections: Vec<_> = (0..self.sections).filter(|section| present.contains(*section)).collect();
            json!({
                "check_in": low_check,
                "check_out": high_check,
                "present": sections,
                "reset": reset.map(|number| number.0),
                "count": after.line.blocks[block].parts().count,
                "agree": taken.agree[block],
            })
        };
        (0..B).map(block).collect()
    }
}
