//! Lines of blocks: what passes over their borders, the constructor, and the direction.

use atc_kernel::Machine as _;
use atc_kernel::block::{
    Beyond, Block, Detection, Direction, Hold, Input, Line, LineError, LineInput, LineOutput, LineState, Metres,
    Output, SectionSet, State, Status, TrainCount, hold_for, step,
};
use atc_kernel::time::Ticks;
use proptest::prelude::*;

fn hold(sections: u8) -> Hold {
    Hold::new(sections).unwrap()
}

fn block(sections: u8, k: u8) -> Block {
    Block::new(sections, sections, hold(k), Ticks(100)).unwrap()
}

fn line<const B: usize>(sections: [u8; B], k: u8) -> Line<B> {
    let total: usize = sections.iter().map(|sections| usize::from(*sections)).sum();
    Line::new(
        sections.map(|sections| block(sections, k)),
        &vec![Metres(100); total],
        Metres(u16::from(k) * 100),
        Direction::Up,
    )
    .unwrap()
}

/// One cycle of one block: the low check, the high check, the sections that detect, a reset.
fn reads(low_check: bool, high_check: bool, present: u16, reset: Option<u8>) -> Detection {
    Detection { low_check, high_check, present: SectionSet::from_bits(present), reset: reset.map(TrainCount) }
}

const QUIET: Detection = Detection { low_check: false, high_check: false, present: SectionSet::EMPTY, reset: None };
const OPEN: Beyond = Beyond { hold: Hold::NONE, entered: true };

/// A line and its state.
struct Running<const B: usize> {
    line: Line<B>,
    state: LineState<B>,
}

impl<const B: usize> Running<B> {
    /// Every block reset with these numbers of trains, heard in these sections.
    fn reset(line: Line<B>, present: [u16; B]) -> Self {
        let mut running = Self { line, state: LineState::INITIAL };
        let counts = present.map(|present| u8::try_from(present.count_ones()).unwrap());
        let mut number = 0;
        let blocks = present.map(|present| {
            number += 1;
            reads(false, false, present, Some(counts[number - 1]))
        });
        let output = running.step(blocks);
        assert!(output.blocks.iter().all(|block| block.agree), "{output:?}");
        running
    }

    fn step(&mut self, blocks: [Detection; B]) -> LineOutput<B> {
        self.step_beyond(blocks, OPEN)
    }

    fn step_beyond(&mut self, blocks: [Detection; B], beyond: Beyond) -> LineOutput<B> {
        let (state, output) = self.line.step(self.state, LineInput { blocks, beyond });
        assert!(state.is_valid(&self.line), "{state:?}");
        self.state = state;
        output
    }
}

fn occupied<const B: usize>(output: &LineOutput<B>) -> [u16; B] {
    output.blocks.map(|block| block.occupied.bits())
}

fn counts<const B: usize>(output: &LineOutput<B>) -> [u8; B] {
    output.blocks.map(|block| block.count.0)
}

// ---- The ledger at a border ----------------------------------------------------------------------------------------------------

#[test]
fn a_check_out_that_comes_first_waits_for_the_check_in() {
    let mut line = Running::reset(line([2, 2], 0), [0b10, 0]);
    let output = line.step([reads(false, true, 0, None), QUIET]);
    assert_eq!((counts(&output), occupied(&output)), ([1, 0], [0b11, 0]), "pending: all behind");
    let output = line.step([QUIET, QUIET]);
    assert_eq!((counts(&output), occupied(&output)), ([1, 0], [0b11, 0]), "for as long as it takes");
    let output = line.step([QUIET, reads(true, false, 0b01, None)]);
    assert_eq!((counts(&output), occupied(&output)), ([0, 1], [0, 0b01]), "taken over in the cycle of the check-in");
}

#[test]
fn a_check_in_that_comes_first_is_remembered() {
    let mut line = Running::reset(line([2, 2], 0), [0b10, 0]);
    let output = line.step([reads(false, false, 0b10, None), reads(true, false, 0, None)]);
    assert_eq!((counts(&output), occupied(&output)), ([1, 1], [0b10, 0b11]));
    for _ in 0..5 {
        let output = line.step([QUIET, reads(false, false, 0b01, None)]);
        assert_eq!((counts(&output), occupied(&output)), ([1, 1], [0b11, 0b01]), "counted on both sides");
    }
    let output = line.step([reads(false, true, 0, None), reads(false, false, 0b01, None)]);
    assert_eq!((counts(&output), occupied(&output)), ([0, 1], [0, 0b01]), "in effect at once");
    // And the account is even: the next check-out waits again.
    line.step([reads(true, false, 0b01, None), reads(false, false, 0b01, None)]);
    let output = line.step([reads(false, true, 0, None), reads(false, false, 0b01, None)]);
    assert_eq!(counts(&output), [1, 1]);
}

/// A reset on either side ends the account, and so does a block ahead that stops counting: no credit is left for a later train.
#[test]
fn a_credit_does_not_outlive_a_reset_or_a_fault() {
    for ended in [
        [QUIET, reads(false, false, 0b01, Some(1))],
        [reads(false, false, 0b10, Some(1)), reads(false, false, 0b01, None)],
        // Refused: the block ahead no longer counts.
        [QUIET, reads(false, false, 0b01, Some(9))],
    ] {
        let mut line = Running::reset(line([2, 2], 0), [0b10, 0]);
        line.step([reads(false, false, 0b10, None), reads(true, false, 0b01, None)]);
        assert_eq!(line.state.borders[1].0, 1);
        line.step(ended);
        assert_eq!(line.state.borders[1].0, 0);
    }
}

/// A block ahead that does not count takes a train over by its check-in as well: counted or not, the edge shows that it has it.
#[test]
fn a_block_that_does_not_count_takes_over_by_its_check_in() {
    for check_in_first in [false, true] {
        let mut line = Running::reset(line([2, 2], 1), [0b10, 0]);
        // A refused reset: unverified, and so all occupied with the hold asked behind.
        line.step([reads(false, false, 0b10, None), reads(false, false, 0, Some(1))]);
        let (leaves, enters) = (reads(false, true, 0, None), reads(true, false, 0b01, None));
        let output = if check_in_first {
            let output = line.step([QUIET, enters]);
            assert_eq!((counts(&output), occupied(&output)), ([1, 0], [0b11, 0b11]));
            line.step([leaves, reads(false, false, 0b01, None)])
        } else {
            let output = line.step([leaves, QUIET]);
            assert_eq!((counts(&output), occupied(&output)), ([1, 0], [0b11, 0b11]), "pending: all behind");
            line.step([QUIET, enters])
        };
        assert_eq!((counts(&output), occupied(&output)), ([0, 0], [0b10, 0b11]), "all ahead, the tail held behind");
        assert!(!output.blocks[1].counted_in);
    }
}

/// A train that enters a block with a dead transmitter: the block behind keeps it in its count, all occupied. The block ahead knows
/// nothing of it and reports itself free (condition `live-transmitter`).
#[test]
fn a_transmitter_that_dies_at_a_border() {
    let mut line = Running::reset(line([2, 2], 0), [0b10, 0]);
    line.step([reads(false, true, 0, None), QUIET]);
    for _ in 0..20 {
        assert_eq!(occupied(&line.step([QUIET, QUIET])), [0b11, 0]);
    }
}

/// Power loss of the block behind in the middle of a train: unverified; the block ahead goes on asking for the hold.
#[test]
fn a_block_that_kept_its_state_goes_on_asking() {
    let mut line = Running::reset(line([2, 2], 2), [0b10, 0]);
    line.step([reads(false, true, 0, None), reads(true, false, 0b01, None)]);
    line.state.blocks[0] = State::INITIAL;
    line.state.borders[1].0 = 0;
    let ahead = reads(true, false, 0b01, None);
    assert_eq!(occupied(&line.step([reads(false, true, 0, Some(0)), ahead])), [0b11, 0b01], "refused: the check is on");
    let output = line.step([reads(false, false, 0, Some(0)), ahead]);
    assert!(output.blocks[0].agree);
    assert_eq!(occupied(&output), [0b11, 0b01], "accepted, and the tail is held");
}

// ---- Tail hold across borders --------------------------------------------------------------------------------------------------

/// k = 3 over a middle block of one section: a head in the first section of the block ahead holds the middle block and two sections
/// of the block behind it; the further it goes the less.
#[test]
fn a_hold_reaches_through_a_short_middle_block() {
    let heads = [(0b00001, [0b1100, 0b1, 0b0001]), (0b00010, [0b1000, 0b1, 0b0011]), (0b00100, [0, 0b1, 0b0111])];
    for (head, expected) in heads {
        let mut line = Running::reset(line([4, 1, 5], 3), [0, 0, head]);
        assert_eq!(occupied(&line.step([QUIET, QUIET, reads(false, false, head, None)])), expected);
    }
    let mut line = Running::reset(line([4, 1, 5], 3), [0, 0, 0b01000]);
    let output = line.step([QUIET, QUIET, reads(false, false, 0b01000, None)]);
    assert_eq!((occupied(&output), output.before_hold), ([0, 0, 0b01111], Hold::NONE));
}

/// All occupied ahead holds as a head in its first section would.
#[test]
fn all_occupied_holds_across_borders_too() {
    let mut line = Running::reset(line([4, 1, 5], 3), [0, 0, 0b10000]);
    assert_eq!(occupied(&line.step([QUIET, QUIET, QUIET])), [0b1100, 0b1, 0b11111]);
}

#[test]
fn a_hold_reaches_beyond_the_entry_of_the_line_and_in_from_its_exit() {
    let mut line = Running::reset(line([2, 1], 4), [0, 0]);
    let output = line.step_beyond([QUIET, QUIET], Beyond { hold: hold(4), entered: true });
    assert_eq!((occupied(&output), output.before_hold), ([0b11, 0b1], hold(1)));
    let output = line.step([reads(true, false, 0b01, None), QUIET]);
    assert_eq!((occupied(&output), output.before_hold), ([0b01, 0], hold(4)));
}

// ---- The take-over of domain.md, and why it is not the kernel's ----------------------------------------------------------------

/// Two blocks with another rule of take-over: a block ahead that reports everything occupied takes over, also while it counts.
fn permissive(blocks: [Block; 2], states: [State; 2], border: u8, reads: [Input; 2]) -> ([State; 2], u8, [Output; 2]) {
    let (after_ahead, ahead) = step(blocks[1], states[1], reads[1]);
    let border = border + u8::from(ahead.counted_in);
    let entered = border > 0 || ahead.occupied.contains_all(blocks[1].all());
    let input = Input { ahead_entered: entered, ahead_hold: ahead.behind_hold, ..reads[0] };
    let (after_behind, behind) = step(blocks[0], states[0], input);
    ([after_behind, after_ahead], border.saturating_sub(u8::from(behind.counted_out)), [behind, ahead])
}

/// One detection is missed ahead for one cycle, the cycle in which a train passes the check-out loop behind. From the next cycle on
/// neither count has the train, until the check-in loop ahead: with the permissive rule its head and tail are reported free.
#[test]
fn a_single_fault_loses_a_train_if_any_block_that_is_all_occupied_takes_over() {
    let line = line([2, 2], 1);
    // Another train stands in the last section ahead; ours is in the last one behind.
    let script = [
        [reads(false, false, 0b10, Some(1)), reads(false, false, 0b10, Some(1))],
        [reads(false, true, 0, None), reads(false, false, 0, None)],
        [QUIET, reads(false, false, 0b10, None)],
    ];
    let input = |detection: Detection| Input {
        check_in: detection.low_check,
        check_out: detection.high_check,
        present: detection.present,
        reset: detection.reset,
        ahead_hold: Hold::NONE,
        ahead_entered: true,
    };
    let (mut states, mut border, mut reports) = ([State::INITIAL; 2], 0, None);
    let mut running = Running { line, state: LineState::INITIAL };
    let mut kernel = None;
    for blocks in script {
        let (next, account, outputs) = permissive(*line.blocks(), states, border, blocks.map(input));
        (states, border, reports) = (next, account, Some(outputs));
        kernel = Some(running.step(blocks));
    }
    // The train is between the two loops: its head is heard by nobody, its tail is in the last section behind.
    let permissive = reports.unwrap().map(|report| (report.agree, report.occupied.bits()));
    assert_eq!(permissive, [(true, 0b00), (true, 0b11)], "the last section behind is reported free");
    let kernel = kernel.unwrap().blocks.map(|report| (report.agree, report.occupied.bits()));
    assert_eq!(kernel, [(false, 0b11), (true, 0b11)], "the kernel keeps the train in the count behind");
}

// ---- The constructor -----------------------------------------------------------------------------------------------------------

#[test]
fn every_error_of_the_line() {
    let blocks = [block(2, 1), block(3, 1)];
    let lengths = [100, 200, 100, 300, 100].map(Metres);
    let new = |blocks: [Block; 2], lengths: &[Metres], train: u16| {
        Line::new(blocks, lengths, Metres(train), Direction::Up).err()
    };
    assert_eq!(new(blocks, &lengths, 100), None);
    assert_eq!(new(blocks, &lengths, 101), Some(LineError::HoldTooShort(0)));
    assert_eq!(new([block(2, 2), block(3, 2)], &lengths, 300), None);
    assert_eq!(new([block(2, 2), block(3, 2)], &lengths, 301), Some(LineError::HoldTooShort(0)));
    // Over the border alone: the second and the third section.
    let short = [500, 100, 100, 500, 500].map(Metres);
    assert_eq!(new([block(2, 2), block(3, 2)], &short, 201), Some(LineError::HoldTooShort(1)));
    assert_eq!(new([block(2, 1), block(3, 2)], &lengths, 1), Some(LineError::HoldsDiffer(1)));
    assert_eq!(new(blocks, &lengths[1..], 1), Some(LineError::LengthsDoNotMatch));
    assert_eq!(new(blocks, &[&lengths[..], &lengths[..1]].concat(), 1), Some(LineError::LengthsDoNotMatch));
    assert_eq!(new(blocks, &[100, 100, 0, 100, 100].map(Metres), 1), Some(LineError::NoLength(2)));
    assert_eq!(new([block(2, 0), block(3, 0)], &lengths, 0), None);
    assert_eq!(new([block(2, 0), block(3, 0)], &lengths, 1), Some(LineError::HoldTooShort(0)));
    assert_eq!(Line::<0>::new([], &[], Metres(1), Direction::Up).err(), Some(LineError::NoBlocks));
    let long = Line::new([block(16, 0); 4], &[Metres(1); 64], Metres(0), Direction::Down);
    assert_eq!(long.map(|line| line.direction()), Ok(Direction::Down));
    let mut five = [block(16, 0); 5];
    five[4] = block(1, 0);
    assert_eq!(Line::new(five, &[Metres(1); 65], Metres(0), Direction::Up).err(), Some(LineError::TooManySections));
}

#[test]
fn the_shortest_hold() {
    let lengths = |all: &[u16]| all.iter().map(|length| Metres(*length)).collect::<Vec<_>>();
    assert_eq!(hold_for(&lengths(&[100, 100, 100]), Metres(0)), Ok(hold(0)));
    assert_eq!(hold_for(&lengths(&[100, 100, 100]), Metres(100)), Ok(hold(1)));
    assert_eq!(hold_for(&lengths(&[100, 100, 100]), Metres(101)), Ok(hold(2)));
    assert_eq!(hold_for(&lengths(&[300, 20, 30, 300]), Metres(200)), Ok(hold(3)));
    // On a line that is shorter than the train no window can be short.
    assert_eq!(hold_for(&lengths(&[100, 100]), Metres(1000)), Ok(hold(3)));
    assert_eq!(hold_for(&lengths(&[u16::MAX; 64]), Metres(u16::MAX)), Ok(hold(1)));
    assert_eq!(hold_for(&lengths(&[10; 64]), Metres(160)), Ok(hold(16)));
    assert_eq!(hold_for(&lengths(&[10; 64]), Metres(161)), Err(LineError::TrainTooLong));
    assert_eq!(hold_for(&[], Metres(5)), Ok(hold(0)));
}

// ---- Properties ----------------------------------------------------------------------------------------------------------------

fn detection(sections: u8) -> impl Strategy<Value = Detection> {
    let present = prop_oneof![4 => Just(0), 3 => (0..u32::from(sections)).prop_map(|section| 1_u16 << section), 1 => any::<u16>()];
    let reset = prop::option::weighted(0.15, prop_oneof![4 => 0..3_u8, 1 => any::<u8>()]);
    (prop::bool::weighted(0.2), prop::bool::weighted(0.2), present, reset).prop_map(
        move |(low, high, present, reset)| {
            // A right number more often than by chance.
            let present = present & SectionSet::first(sections).bits();
            let verified =
                reset.map(|number| if number == 2 { u8::try_from(present.count_ones()).unwrap() } else { number });
            reads(low, high, present, verified)
        },
    )
}

prop_compose! {
    fn history()(
        sections in prop::array::uniform3(1..7_u8),
        k in 0..4_u8,
    )(
        cycles in prop::collection::vec((
            [detection(sections[0]), detection(sections[1]), detection(sections[2])], 0..=4_u8, any::<bool>(),
        ), 1..60),
        sections in Just(sections),
        k in Just(k),
    ) -> ([u8; 3], u8, Vec<([Detection; 3], Beyond)>) {
        let cycles = cycles.into_iter();
        (sections, k, cycles.map(|(blocks, asked, entered)| (blocks, Beyond { hold: hold(asked), entered })).collect())
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(1500))]

    /// The spec's word for a least hold: every window of k sections is as long as the train, and of k − 1 some is not.
    #[test]
    fn a_hold_is_the_least_that_is_long_enough(lengths in prop::collection::vec(1..50_u16, 1..40), train in 0..400_u16) {
        let metres: Vec<_> = lengths.iter().map(|length| Metres(*length)).collect();
        let enough = |k: usize| k <= 16 && (0..lengths.len()).filter(|first| first + k <= lengths.len())
            .all(|first| lengths[first..first + k].iter().sum::<u16>() >= train);
        let least = (0..=16).find(|k| enough(*k));
        let expected = least.map(|k| hold(u8::try_from(k).unwrap())).ok_or(LineError::TrainTooLong);
        prop_assert_eq!(hold_for(&metres, Metres(train)), expected);
    }

    /// A line travelled downwards is the mirrored line travelled upwards.
    #[test]
    fn down_is_up_in_a_mirror((sections, k, cycles) in history()) {
        let mirrored: [u8; 3] = [sections[2], sections[1], sections[0]];
        let total: u8 = sections.iter().sum();
        let lengths: Vec<_> = (1..=u16::from(total)).map(|number| Metres(number * 10)).collect();
        let backwards: Vec<_> = lengths.iter().rev().copied().collect();
        let make = |sections: [u8; 3], lengths: &[Metres], direction| {
            Line::new(sections.map(|sections| block(sections, k)), lengths, Metres(u16::from(k.min(1)) * 10), direction).unwrap()
        };
        let mut up = Running { line: make(sections, &lengths, Direction::Up), state: LineState::INITIAL };
        let mut down = Running { line: make(mirrored, &backwards, Direction::Down), state: LineState::INITIAL };
        // Bit by bit, not with the kernel's own helper.
        let flip = |set: SectionSet, sections: u8| {
            let members = (0..sections).filter(|section| set.contains(*section));
            SectionSet::from_bits(members.fold(0, |bits, section| bits | 1 << (sections - 1 - section)))
        };
        for (blocks, beyond) in cycles {
            let seen = |place: usize| Detection {
                low_check: blocks[place].high_check,
                high_check: blocks[place].low_check,
                present: flip(blocks[place].present, sections[place]),
                reset: blocks[place].reset,
            };
            let one = up.step_beyond(blocks, beyond);
            let other = down.step_beyond([seen(2), seen(1), seen(0)], beyond);
            prop_assert_eq!(one.before_hold, other.before_hold);
            for (place, report) in one.blocks.into_iter().enumerate() {
                let occupied = flip(report.occupied, sections[place]);
                prop_assert_eq!(Output { occupied, ..report }, other.blocks[2 - place]);
            }
            prop_assert_eq!(up.state, down.state);
        }
    }

    /// BLK-10: while the block behind counts, and neither block is reset, no more trains are let go behind than check-ins rose ahead.
    #[test]
    fn no_train_is_let_go_that_did_not_check_in((sections, k, cycles) in history()) {
        let mut running = Running::reset(line(sections, k), [0; 3]);
        let (mut account, mut was_on) = ([0_i32; 3], [false; 3]);
        for (blocks, beyond) in cycles {
            let output = running.step_beyond(blocks, beyond);
            for (ahead, account) in account.iter_mut().enumerate().skip(1) {
                let (behind, now) = (output.blocks[ahead - 1], blocks[ahead]);
                *account += i32::from(now.low_check && !was_on[ahead]) - i32::from(behind.counted_out);
                prop_assert!(*account >= 0, "border {}", ahead);
                if behind.status != Status::Counting || now.reset.is_some() || blocks[ahead - 1].reset.is_some() {
                    *account = 0;
                }
            }
            was_on = blocks.map(|block| block.low_check);
        }
    }
}
