//! The run of a model, as it is drawn.

use super::{COMING, CountedBetween, Cycle, Outcome, RECEIVER, SENDER, State, Train, wrong};
use crate::block::device::Counts;
use crate::interlocking::trace::Run;
use crate::outcome::Trace;
use serde_json::json;

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
                run.step(&made.told, json!({"hazard": false}));
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
            let words = json!({
                "trains": trains,
                "faults": before.faults.words(),
                "counted_by_the_sender": self.counted(&cycle.outcomes[SENDER]),
                "counted_by_the_receiver": self.counted(&cycle.outcomes[RECEIVER]),
                "receiver_proceed": self.proceeds(RECEIVER, &cycle.outcomes[RECEIVER]),
                "receiver_permits": cycle.outcomes[RECEIVER].permits,
                "receiver_starts": cycle.outcomes[RECEIVER].started,
                "hazard": after.wrong & wrong::MET != 0,
            });
            run.step(&taken.told, words);
        }
        run.trace()
    }

    /// What a device read of the line, and how it counts after that.
    fn counted(&self, outcome: &Outcome) -> Vec<Counts> {
        let known = self.known();
        let taken = known.taken[outcome.read as usize];
        let after = known.device(outcome.device);
        let counts = |block: usize| Counts::of(taken.read.blocks[block], after.line.blocks[block], taken.agree[block]);
        (0..B).map(counts).collect()
    }
}
