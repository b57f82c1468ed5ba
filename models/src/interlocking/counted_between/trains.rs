//! What trains may do in a cycle, and what passes then.

use super::{Around, COMING, CountedBetween, FIRST, PLATFORM, RECEIVER, SENDER, State, TRAINS, Train};

/// What passes in a cycle.
#[derive(Clone, Copy, Debug)]
pub(super) struct Passing<const B: usize> {
    /// A head passes the entry of each block, and last the exit of the line: a mask.
    pub(super) enters: u8,
    /// The sections with a head: a mask.
    pub(super) heard: u8,
    /// How many heads are in each block.
    pub(super) inside: [u8; B],
}

impl<const B: usize> CountedBetween<B> {
    /// Where a train may be a cycle later. `None`: it has ended.
    fn moves(&self, train: Train, may_come: bool) -> Vec<Option<Train>> {
        let mut ways = vec![Some(train)];
        if train.front == COMING {
            if may_come {
                ways.push(Some(Train { front: PLATFORM, rear: PLATFORM, since: self.none(), lost: 0 }));
            }
        } else if train.front != train.rear {
            let lost = if train.lost & 1 == 1 { 3 } else { 0 };
            ways.push(Some(Train { rear: train.front, lost, ..train }));
        } else if train.front == self.end() {
            ways.push(None);
        } else if train.front == self.beyond() || train.since <= self.lives.residual || self.heedless {
            // Its rear stays where the whole train was.
            let lost = train.lost & 2;
            ways.push(Some(Train { front: train.front + 1, since: self.none(), lost, ..train }));
        }
        ways
    }

    /// Which ends of a train its circuits may lose in this cycle. `after` has what they lost in the cycle before.
    fn losses(&self, before: Train, after: Train, may: bool) -> Vec<u8> {
        let own = self.own(SENDER) | self.own(RECEIVER);
        if !may || after.front == COMING || before.front == COMING {
            return vec![0];
        }
        let mut ways = Vec::new();
        for lost in 0..4_u8 {
            let again = lost & after.lost != 0;
            let of_a_circuit = [(1, after.front), (2, after.rear)]
                .into_iter()
                .all(|(end, place)| lost & end == 0 || own >> place & 1 == 1);
            let alike = after.front != after.rear || lost == 0 || lost == 3;
            if !again && of_a_circuit && alike {
                ways.push(lost);
            }
        }
        ways
    }

    /// All ways in which the trains may move, what passes, and what their circuits lose.
    pub(super) fn ways(&self, state: &State) -> Vec<[Train; TRAINS]> {
        let platform_free = state.trains.iter().all(|train| train.on() & 1 << PLATFORM == 0);
        let first_coming = state.trains.iter().position(|train| train.front == COMING);
        let may_lose = state.faults.has(Around::Lost);
        let mut ways = vec![state.trains];
        for (number, train) in state.trains.iter().enumerate().take(self.trains.into()) {
            let mut next = Vec::new();
            for after in self.moves(*train, platform_free && first_coming == Some(number)) {
                match after {
                    None => next.push(Train::coming(self.none())),
                    Some(after) => {
                        let losses = self.losses(*train, after, may_lose);
                        next.extend(losses.into_iter().map(|lost| Train { lost, ..after }));
                    }
                }
            }
            ways = ways
                .iter()
                .flat_map(|way| {
                    next.iter().map(move |train| {
                        let mut way = *way;
                        way[number] = *train;
                        way
                    })
                })
                .collect();
        }
        ways
    }

    /// What passes when the trains have moved.
    pub(super) fn passing(&self, state: &State, trains: &[Train; TRAINS]) -> Passing<B> {
        let mut passing = Passing { enters: 0, heard: 0, inside: [0; B] };
        for (before, after) in state.trains.iter().zip(trains) {
            if after.front == COMING || after.front < FIRST || after.front > self.beyond() {
                continue;
            }
            let section = after.front - FIRST;
            if before.front + 1 == after.front && section.is_multiple_of(self.sections) {
                passing.enters |= 1 << (section / self.sections);
            }
            if section < self.all_sections() {
                passing.heard |= 1 << section;
                passing.inside[usize::from(section / self.sections)] += 1;
            }
        }
        passing
    }

    /// The circuits that report a train of these.
    pub(super) fn reported(trains: &[Train; TRAINS]) -> u8 {
        let ends =
            |train: &Train| [(1, train.front), (2, train.rear)].map(|(end, place)| (train.lost & end == 0, place));
        let heard = trains.iter().filter(|train| train.front != COMING).flat_map(ends);
        heard.fold(0, |all, (heard, place)| all | u8::from(heard) << place)
    }
}
