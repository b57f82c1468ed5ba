//! What devices may read and be commanded in a cycle, what they make of it, and what of it has failed.

use super::ends::{Device, End, Read, THROAT, circuits, route, start_orders, the_line, turn};
use super::known::{Common, Key, Taken};
use super::trains::Passing;
use super::{Around, CountedBetween, Cycle, Faults, Number, Often, Outcome, RECEIVER, SENDER, State, TRAINS, Train};
use super::{Wiring, Withdraws};
use crate::block::fault::{self, Kind};
use atc_kernel::block::{Detection, SectionSet, TrainCount};
use atc_kernel::interlocking::{Phase, Request, Travel};
use std::sync::Arc;

impl<const B: usize> CountedBetween<B> {
    /// What checks and detectors may say of it, with the faults of the run.
    pub(super) fn commons(&self, state: &State, Passing { enters, heard, inside }: Passing<B>) -> Vec<Common<B>> {
        let counting = state.faults.counting;
        let mut ways: Vec<Common<B>> = counting
            .present(SectionSet::from_bits(heard.into()))
            .into_iter()
            .map(|present| Common {
                low: [false; B],
                high: [false; B],
                present: present.bits(),
                inside,
                reset: [None; B],
            })
            .collect();
        for block in 0..B {
            let lows: Vec<_> = counting.check_in(enters >> block & 1 == 1, block).collect();
            let highs: Vec<_> = counting.check_out(enters >> (block + 1) & 1 == 1, block).collect();
            ways = ways
                .iter()
                .flat_map(|way| lows.iter().map(move |low| (*way, *low)))
                .flat_map(|(way, low)| highs.iter().map(move |high| (way, low, *high)))
                .map(|(mut way, low, high)| {
                    (way.low[block], way.high[block]) = (low, high);
                    way
                })
                .collect();
        }
        if self.resets_together {
            for (block, right) in inside.into_iter().enumerate() {
                let resets = |way: &Common<B>| {
                    let agree = [SENDER, RECEIVER]
                        .into_iter()
                        .all(|station| self.agrees(station, state.devices[station], way)[block]);
                    let wrong = counting.has(Kind::WrongReset, block);
                    let numbers =
                        (0..=self.ends[SENDER].most()).filter(move |number| !agree && (*number == right || wrong));
                    std::iter::once(None).chain(numbers.map(Some)).collect::<Vec<_>>()
                };
                ways = ways
                    .iter()
                    .flat_map(|way| {
                        resets(way).into_iter().map(move |reset| {
                            let mut way = *way;
                            way.reset[block] = reset;
                            way
                        })
                    })
                    .collect();
            }
        }
        ways
    }

    /// Which blocks agree at a device that reads this, before staff do anything.
    fn agrees(&self, station: usize, device: Number, common: &Common<B>) -> [bool; B] {
        let mut known = self.known();
        let read = Common { reset: [None; B], ..*common };
        if let Some(found) = known.agreeing.get(&(station, device, read)) {
            return *found;
        }
        let before = known.device(device).line;
        let (_, report, _) = self.ends[station].counted.count(before, self.detections(&read), circuits(0));
        let agree = report.blocks.map(|block| block.agree);
        known.agreeing.insert((station, device, read), agree);
        agree
    }

    /// What is commanded: requests that would change nothing are left out.
    fn commands(&self, station: usize, device: &Device<B>) -> Vec<Option<Request>> {
        let (held, travel) = (device.interlocking.routes[0], self.ends[station].travel);
        let directions = device.interlocking.directions;
        let mut commands = vec![None];
        if !held.is_held() || held.may_resume() {
            commands.push(Some(Request::Set(route())));
        }
        if held.is_held() && (self.withdraws == Withdraws::AtWill || held.phase == Phase::InUse) {
            commands.push(Some(Request::Withdraw(route())));
        }
        let set = if travel == Travel::Away { directions.away } else { directions.toward };
        if !set.meets(the_line()) {
            commands.push(Some(turn(travel)));
        }
        commands
    }

    /// The blocks' detections, without resets.
    fn detections(&self, common: &Common<B>) -> [Detection; B] {
        std::array::from_fn(|block| {
            let shift = usize::from(self.sections) * block;
            let present = SectionSet::from_bits(common.present >> shift).and(SectionSet::first(self.sections));
            Detection {
                low_check: common.low[block],
                high_check: common.high[block],
                present,
                reset: common.reset[block].map(TrainCount),
            }
        })
    }

    /// All that a device can make of a cycle.
    pub(super) fn outcomes(&self, key: Key<B>) -> Arc<[Outcome]> {
        let mut known = self.known();
        if let Some(found) = known.outcomes.get(&key) {
            return Arc::clone(found);
        }
        let end = &self.ends[key.station];
        let device = known.device(key.device);
        let mut all: Vec<Outcome> = Vec::new();
        let signal = 1 << self.before_signal(key.station);
        let mut add = |before: Device<B>, read: Read<B>, started: bool| {
            let failed = self.failed(&key, &read, started);
            let made = end.step(before, read, self.wiring);
            let clear = end.layout.plan().clear;
            let counts = made.device.interlocking.track.clear_for();
            let occupied = (0..8).filter(|place| counts[*place] < clear).fold(0, |all, place| all | 1 << place);
            let granted = made.granted & !signal | if made.proceed { signal } else { 0 };
            let outcome = Outcome {
                device: known.number(made.device),
                permits: made.permits,
                granted,
                occupied,
                unverified: made.permits && !made.device.verified,
                started,
                failed,
                read: 0,
            };
            let less = |one: &Outcome| {
                Outcome { read: 0, failed: Faults::NONE, ..*one } == Outcome { failed: Faults::NONE, ..outcome }
            };
            let known_already = |one: &Outcome| one.failed == failed || self.often == Often::AtWill;
            if !all.iter().any(|one| less(one) && known_already(one)) {
                let read = known.take(Taken { read, told: made.told, agree: made.agree });
                all.push(Outcome { read, ..outcome });
            }
        };
        let begins = [(device, false), (end.initial(), true)].into_iter().take(1 + usize::from(key.may_start));
        for (before, started) in begins {
            for (blocks, reported) in self.readings(end, &before, &key) {
                let orders = if started { start_orders() } else { Read::<B>::quiet().orders };
                let read = Read { blocks, reported: circuits(reported), request: None, orders, consent: false };
                let requests = if started { vec![None] } else { self.commands(key.station, &before) };
                for request in requests {
                    for consent in [true, false].into_iter().filter(|consent| key.consents[usize::from(*consent)]) {
                        add(before, Read { request, consent, ..read }, started);
                    }
                }
            }
        }
        let all: Arc<[Outcome]> = all.into();
        known.outcomes.insert(key, Arc::clone(&all));
        all
    }

    /// What the blocks and the circuits of a device may read: resets where a block disagrees, and circuits falsely occupied.
    fn readings(&self, end: &End<B>, before: &Device<B>, key: &Key<B>) -> Vec<([Detection; B], u8)> {
        let falsely = (0..=key.falsely).filter(|set| set & !key.falsely == 0 && set & key.reported == 0);
        let mut ways = Vec::new();
        for reported in falsely.map(|set| set | key.reported) {
            let plain = self.detections(&key.common);
            let (_, report, _) = end.counted.count(before.line, plain, circuits(reported));
            let mut resets = vec![plain];
            for block in 0..B {
                if key.together || report.blocks[block].agree {
                    continue;
                }
                let right = key.common.inside[block];
                let numbers: Vec<_> =
                    (0..=end.most()).filter(|number| *number == right || key.wrong_reset[block]).collect();
                resets = resets
                    .iter()
                    .flat_map(|way| {
                        let reset = numbers.iter().map(move |number| {
                            let mut way = *way;
                            way[block].reset = Some(TrainCount(*number));
                            way
                        });
                        std::iter::once(*way).chain(reset)
                    })
                    .collect();
            }
            ways.extend(resets.into_iter().map(|blocks| (blocks, reported)));
        }
        ways
    }

    /// What of a device's own has failed if it reads this.
    fn failed(&self, key: &Key<B>, read: &Read<B>, started: bool) -> Faults {
        if self.often == Often::AtWill {
            return Faults::NONE;
        }
        let sends = key.station == SENDER;
        let falsely = read.reported.bits().to_le_bytes()[0] & !key.reported;
        let starts = if sends { Around::SenderStarts } else { Around::ReceiverStarts };
        let mut failed = Faults::around(starts, started)
            .and(Faults::around(Around::SenderThroat, falsely >> THROAT & 1 == 1))
            .and(Faults::around(Around::Consent, sends && !started && read.consent != key.newest));
        for block in 0..B {
            if read.blocks[block].reset.is_some_and(|number| number.0 != key.common.inside[block]) {
                failed = failed.and(Faults::counting(fault::Faults::of_block(Kind::WrongReset, block)));
            }
        }
        failed
    }

    /// What has failed in a cycle of what both devices read alike, and what could have failed without being told from what is right.
    pub(super) fn failing(
        &self,
        trains: &[Train; TRAINS],
        passing: Passing<B>,
        common: &Common<B>,
    ) -> (Faults, Faults) {
        if self.often == Often::AtWill {
            return (Faults::NONE, Faults::NONE);
        }
        let Passing { enters, heard, .. } = passing;
        let present = common.present.to_le_bytes()[0];
        let mut failed = fault::Faults::of_detectors(heard & !present, present & !heard);
        let mut hidden = fault::Faults::of_detectors(!heard, heard);
        for block in 0..B {
            let (low, high) = (enters >> block & 1 == 1, enters >> (block + 1) & 1 == 1);
            let of = |kind, there: bool| if there { fault::Faults::of_block(kind, block) } else { fault::Faults::NONE };
            failed = failed
                .and(of(Kind::CheckInLost, low && !common.low[block]))
                .and(of(Kind::CheckInStuckOn, !low && common.low[block]))
                .and(of(Kind::CheckOutLost, high && !common.high[block]))
                .and(of(Kind::SpuriousCheckOut, !high && common.high[block]));
            hidden = hidden.and(of(Kind::CheckInStuckOn, low));
        }
        let reported = Self::reported(trains);
        let lost = trains.iter().any(|train| train.lost != 0);
        let hidden = Faults::counting(hidden)
            .and(Faults::around(Around::SenderThroat, reported >> THROAT & 1 == 1))
            .and(Faults::around(Around::ReceiverThroat, reported >> self.beyond() & 1 == 1));
        (Faults::counting(failed).and(Faults::around(Around::Lost, lost)), hidden)
    }

    /// What may fail after this cycle, and what of it has begun to.
    pub(super) fn left(&self, state: &State, cycle: &Cycle) -> (Faults, Faults) {
        if self.often == Often::AtWill {
            return (state.faults, Faults::NONE);
        }
        let [sender, receiver] = cycle.outcomes;
        let failed = cycle.failed.and(sender.failed).and(receiver.failed);
        let over = failed.without(self.levels).and(state.begun.without(failed).without(cycle.hidden));
        let begun = state.begun.and(failed.among(self.levels)).without(over);
        (state.faults.without(over), begun)
    }

    /// The circuits that may be reported without a train.
    pub(super) fn falsely(&self, station: usize, faults: Faults) -> u8 {
        let throat = faults.has(Around::SenderThroat) && station == SENDER;
        let beyond = faults.has(Around::ReceiverThroat) && self.often == Often::AtWill;
        u8::from(throat) << THROAT | u8::from(beyond) << self.beyond()
    }

    /// Whether a permission may be read, and may be missing: of this cycle's permissions, and of those that live.
    pub(super) fn consents(&self, state: &State) -> [bool; 2] {
        let (newest, lives) = (state.sent & 1 == 1, state.sent != 0);
        if self.wiring == Wiring::BelievesForEver {
            return [false, true];
        }
        if state.faults.has(Around::Consent) { [true, lives] } else { [!newest, newest] }
    }
}
