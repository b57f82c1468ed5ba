//! Section 3 of the digest of the patents once more, against the kernel: written from its text and not from the kernel. Nothing is
//! remembered from cycle to cycle but what happened; the count, what is pending and whether the count is in force are worked out
//! of that history anew in each cycle, with numbers that never saturate.

use atc_kernel::block::{Block, Fault, Hold, Input, SectionSet, State, Status, TrainCount, step};
use atc_kernel::time::Ticks;
use proptest::prelude::*;

/// Something that happened to a block. A cycle may have several, in this order.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Event {
    Contradicted(Fault),
    CheckedIn,
    CheckOutSeen,
    LetGo,
    Verified(usize),
    Refused,
}

/// A block that remembers everything.
struct Witness {
    sections: usize,
    max: usize,
    hold: usize,
    pass: usize,
    read: Vec<Input>,
    events: Vec<Event>,
}

/// What it reports.
#[derive(Debug, PartialEq)]
struct Report {
    occupied: Vec<usize>,
    behind: usize,
    agree: bool,
    count: usize,
    status: Status,
    moved: (bool, bool),
}

impl Witness {
    /// Since the last reset, whatever became of it; everything before is void.
    fn since_reset(&self) -> &[Event] {
        let last = self.events.iter().rposition(|event| matches!(event, Event::Verified(_) | Event::Refused));
        last.map_or(&[], |last| &self.events[last..])
    }

    fn times(&self, event: Event) -> usize {
        self.since_reset().iter().filter(|other| **other == event).count()
    }

    fn status(&self) -> Status {
        let events = self.since_reset();
        let contradiction = events.iter().find_map(|event| match event {
            Event::Contradicted(fault) => Some(Status::Fault(*fault)),
            _ => None,
        });
        match events.first() {
            Some(Event::Verified(_)) => contradiction.unwrap_or(Status::Counting),
            _ => Status::Unverified,
        }
    }

    fn count(&self) -> usize {
        let verified = match self.since_reset().first() {
            Some(Event::Verified(trains)) => *trains,
            _ => 0,
        };
        verified + self.times(Event::CheckedIn) - self.times(Event::LetGo)
    }

    fn pending(&self) -> usize {
        self.times(Event::CheckOutSeen) - self.times(Event::LetGo)
    }

    /// How many cycles the check-in has been on, up to the last one.
    fn check_in_for(&self) -> usize {
        self.read.iter().rev().take_while(|input| input.check_in).count()
    }

    fn contradiction(&self, entering: bool, leaving: bool) -> Option<Fault> {
        if self.check_in_for() > self.pass {
            return Some(Fault::CheckInStaysOn);
        }
        if entering && self.count() >= self.max {
            return Some(Fault::CheckInAtMaximum);
        }
        (leaving && self.count() - self.pending() == 0).then_some(Fault::CheckOutAtZero)
    }

    fn cycle(&mut self, input: Input) -> Report {
        let before = self.read.last().copied();
        let was_pending = self.pending() > 0;
        self.read.push(input);
        let first = self.events.len();
        let entering = input.check_in && !before.is_some_and(|before| before.check_in);
        let leaving = input.check_out && before.is_some_and(|before| !before.check_out);
        if self.status() == Status::Counting {
            if let Some(fault) = self.contradiction(entering, leaving) {
                self.events.push(Event::Contradicted(fault));
            } else {
                self.events.extend(entering.then_some(Event::CheckedIn));
                self.events.extend(leaving.then_some(Event::CheckOutSeen));
            }
        }
        if self.pending() > 0 && input.ahead_entered {
            self.events.push(Event::LetGo);
        }
        let now = &self.events[first..];
        let moved = (now.contains(&Event::CheckedIn), now.contains(&Event::LetGo));
        let heard: Vec<usize> = (0..self.sections).filter(|section| input.present.bits() >> section & 1 == 1).collect();
        if let Some(TrainCount(verified)) = input.reset {
            let verified = usize::from(verified);
            let sound = !input.check_in && !input.check_out && !was_pending;
            let right = verified == heard.len() && verified <= self.max;
            self.events.push(if sound && right { Event::Verified(verified) } else { Event::Refused });
        }
        let agree = self.status() == Status::Counting && self.count() == heard.len();
        let heads = if agree { heard } else { (0..self.sections).collect() };
        // A line of sections: behind the block the negative ones, beyond it what the block ahead holds for.
        let asked = usize::from(input.ahead_hold.sections());
        let is_held = |place: isize| {
            let behind = |head: usize| {
                let distance = isize::try_from(head).unwrap() - place;
                0 <= distance && distance <= isize::try_from(self.hold).unwrap()
            };
            let from_exit = isize::try_from(self.sections).unwrap() - place;
            heads.iter().any(|head| behind(*head)) || from_exit <= isize::try_from(asked).unwrap()
        };
        let farthest = (-40..0).find(|place| is_held(*place));
        Report {
            occupied: (0..self.sections).filter(|section| is_held(isize::try_from(*section).unwrap())).collect(),
            behind: farthest.map_or(0, isize::unsigned_abs),
            agree,
            count: self.count(),
            status: self.status(),
            moved,
        }
    }
}

/// Inputs that look like traffic, with errors: trains come and go, detections mostly agree with the count.
fn inputs() -> impl Strategy<Value = Vec<(u8, u16, u8, u8, u8)>> {
    prop::collection::vec((any::<u8>(), any::<u16>(), any::<u8>(), 0..=16_u8, any::<u8>()), 1..120)
}

/// The kernel and the witness side by side; `lively` of 256 cycles have a change of a check.
fn compare(block: Block, raw: &[(u8, u16, u8, u8, u8)], lively: u8) -> Result<(u32, u32), TestCaseError> {
    let mut witness = Witness {
        sections: block.sections().into(),
        max: block.max_trains().0.into(),
        hold: block.hold().sections().into(),
        pass: block.pass().0.into(),
        read: Vec::new(),
        events: Vec::new(),
    };
    let (mut state, mut levels) = (State::INITIAL, (false, false));
    let (mut agreed, mut faults) = (0, 0);
    for (change, noise, chance, asked, ahead) in raw {
        levels.0 ^= *change < lively;
        levels.1 ^= change.rotate_left(3) < lively;
        // As many detections as the count has trains, in most cycles.
        let mut present = *noise & block.all().bits();
        let trains = witness.count().to_le_bytes()[0];
        while chance % 8 != 0 && SectionSet::from_bits(present).len() > trains {
            present &= present - 1;
        }
        while chance % 8 != 0 && SectionSet::from_bits(present).len() < trains {
            present |= present + 1;
        }
        let right = SectionSet::from_bits(present).len();
        let reset = match chance {
            0..12 => Some(right),
            12..15 => Some(*ahead),
            _ => None,
        };
        if reset.is_some() && chance % 3 > 0 {
            levels = (false, false);
        }
        let input = Input {
            check_in: levels.0,
            check_out: levels.1,
            // Bits of sections that the block does not have are nothing.
            present: SectionSet::from_bits(present | *noise & !block.all().bits()),
            reset: reset.map(TrainCount),
            ahead_hold: Hold::new(if ahead % 4 == 0 { *asked } else { 0 }).unwrap(),
            ahead_entered: ahead % 3 > 0,
        };
        let expected = witness.cycle(input);
        let (next, output) = step(block, state, input);
        prop_assert!(next.is_valid(block), "{:?}", next);
        let kernel = Report {
            occupied: (0..16).filter(|section| output.occupied.bits() >> section & 1 == 1).collect(),
            behind: output.behind_hold.sections().into(),
            agree: output.agree,
            count: output.count.0.into(),
            status: output.status,
            moved: (output.counted_in, output.counted_out),
        };
        prop_assert_eq!(&kernel, &expected, "{:?}\n{:?}", input, witness.events);
        prop_assert_eq!(usize::from(next.parts().pending), witness.pending());
        state = next;
        agreed += u32::from(output.agree);
        faults += u32::from(matches!(output.status, Status::Fault(_)));
    }
    Ok((agreed, faults))
}

prop_compose! {
    fn block()(sections in 1..=16_u8)(
        sections in Just(sections), max in 1..=sections, hold in 0..=16_u8, pass in 1..12_u16,
    ) -> Block {
        Block::new(sections, max, Hold::new(hold).unwrap(), Ticks(pass)).unwrap()
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(4000))]

    #[test]
    fn the_kernel_reports_what_its_history_says(block in block(), raw in inputs(), lively in 8..100_u8) {
        compare(block, &raw, lively)?;
    }
}

/// The random inputs reach agreement, and each fault: the comparison is not of one state only.
#[test]
fn the_inputs_are_lively() {
    let mut random = 0x9E37_79B9_7F4A_7C15_u64;
    let mut next = || {
        random ^= random << 13;
        random ^= random >> 7;
        random ^= random << 17;
        random.to_le_bytes()
    };
    let (mut agreed, mut faults, mut cycles) = (0, 0, 0);
    for _ in 0..200 {
        let raw: Vec<_> = (0..200)
            .map(|_| {
                let bytes = next();
                (bytes[2], u16::from_le_bytes([bytes[3], bytes[4]]), bytes[5], bytes[6] % 17, bytes[7])
            })
            .collect();
        let block = Block::new(4, 3, Hold::new(1).unwrap(), Ticks(9)).unwrap();
        let (one, other) = compare(block, &raw, 30).unwrap();
        (agreed, faults, cycles) = (agreed + one, faults + other, cycles + 200);
    }
    assert!(
        agreed > cycles / 20 && faults > cycles / 20,
        "{agreed} of agreement and {faults} of faults in {cycles} cycles"
    );
    println!("{cycles} cycles: {agreed} of agreement, {faults} in a fault");
}
