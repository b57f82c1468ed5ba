//! What is wrong after a cycle, and what a run has come to.

use super::{COMING, CountedBetween, FIRST, Outcome, PLATFORM, RECEIVER, SENDER, State, THROAT, TRAINS, Train, wrong};

impl<const B: usize> CountedBetween<B> {
    /// The place in front of the signal of a station.
    pub(super) fn before_signal(&self, station: usize) -> u8 {
        if station == SENDER { PLATFORM } else { self.beyond() - 1 }
    }

    /// Whether the signal of a station shows proceed.
    pub(super) fn proceeds(&self, station: usize, outcome: &Outcome) -> bool {
        outcome.granted >> self.before_signal(station) & 1 == 1
    }

    /// Whether the next place is granted to a train whose front is there: by the sender as far as its throat, beyond that by the receiver.
    pub(super) fn grants(&self, place: u8, [sender, receiver]: &[Outcome; 2]) -> bool {
        let speaks = if place < FIRST { sender } else { receiver };
        place < self.beyond() && speaks.granted >> place & 1 == 1
    }

    /// What is wrong after this cycle.
    pub(super) fn wrong(&self, state: &State, trains: &[Train; TRAINS], outcomes: &[Outcome; 2]) -> u8 {
        let [sender, receiver] = outcomes;
        let there = || trains.iter().filter(|train| train.front != COMING);
        let mut all = 0;
        let mut met = false;
        for train in there() {
            met |= all & train.on() != 0;
            all |= train.on();
        }
        let under = all & self.line();
        let unreported = under & !(sender.occupied & receiver.occupied) != 0;
        // A train that is still passing the signal is the one for which it showed proceed.
        let past = |place: u8| there().any(|train| train.rear >= place && train.rear <= self.end());
        let within = |place: u8| there().any(|train| train.rear == place);
        let mut proceed =
            self.proceeds(SENDER, sender) && within(THROAT) || self.proceeds(RECEIVER, receiver) && past(self.beyond());
        for train in there() {
            let next = train.front + 1;
            let granted = train.front < self.beyond() && self.grants(train.front, outcomes);
            proceed |= granted && there().any(|other| other != train && other.on() >> next & 1 == 1);
        }
        let lets = self.proceeds(SENDER, sender)
            || there().any(|train| train.front == THROAT) && sender.granted >> THROAT & 1 == 1;
        let flags = [
            (met, wrong::MET),
            (unreported, wrong::UNREPORTED),
            (proceed, wrong::PROCEED),
            (lets && state.sent == 0, wrong::NO_CONSENT),
            (receiver.unverified, wrong::UNVERIFIED),
        ];
        flags.into_iter().filter(|(there, _)| *there).fold(0, |all, (_, flag)| all | flag)
    }

    /// The state in which a train is sent anew after a start: the route is held, which no device remembers.
    pub(super) fn sent_again(&self, state: &State) -> bool {
        let held = || self.device(state.devices[SENDER]).interlocking.routes[0].is_held();
        let on_its_way = |train: &Train| train.front == FIRST && train.rear == THROAT;
        state.restarted && state.trains.iter().any(on_its_way) && held()
    }

    /// A train is wholly in the receiver's platform, no other on the line, and all of it counts as occupied.
    pub(super) fn arrived_in_disagreement(&self, state: &State) -> bool {
        let on = state.trains.iter().fold(0, |all, train| all | train.on());
        if on & (self.line() | 1 << self.beyond()) != 0 || on >> self.end() & 1 == 0 {
            return false;
        }
        let counts = self.device(state.devices[RECEIVER]).interlocking.track.clear_for();
        (FIRST..self.beyond()).all(|place| counts[usize::from(place)] == 0)
    }
}
