//! Busy traffic on a line of four blocks of sixteen sections, for the benchmarks: a train every 64 cycles, 32 cycles in each
//! section, up to 32 trains at once, and a detection that is missed now and then.

use atc_kernel::block::{
    Beyond, Block, Detection, Direction, Hold, Input, Line, LineInput, Metres, SectionSet, TrainCount,
};
use atc_kernel::time::{Millis, Ticks};
use atc_protocol::machine::block::Config;

/// How many cycles the input has before it begins again. At its end the line is empty; it begins with a reset.
pub const PERIOD: usize = 8192;

const BLOCKS: usize = 4;
const SECTIONS: usize = 16;
const HEADWAY: usize = 64;
const STAY: usize = 32;

/// A block of 16 sections, 2 of them held behind every head.
pub fn config() -> Config {
    Config { sections: 16, max_trains: 16, tail_hold_sections: 2, cycle_ms: 10, pass_ms: 10_000 }
}

/// [`config`] in the kernel's form.
///
/// # Panics
/// Never: it is valid.
pub fn block() -> Block {
    let hold = Hold::new(2).expect("at most 16");
    Block::from_millis(16, 16, hold, Millis(10), Millis(10_000)).expect("a valid block")
}

/// A line of four such blocks.
///
/// # Panics
/// Never: it is valid.
pub fn line() -> Line<BLOCKS> {
    let blocks = [block(); BLOCKS];
    debug_assert_eq!(block().pass(), Ticks(1000));
    Line::new(blocks, &[Metres(120); BLOCKS * SECTIONS], Metres(200), Direction::Up).expect("a valid line")
}

/// Where the head of each train is in this cycle: the section, and for how long.
fn heads(now: usize) -> impl Iterator<Item = (usize, usize)> {
    let crossing = STAY * BLOCKS * SECTIONS;
    let departures = (8..PERIOD - crossing - HEADWAY).step_by(HEADWAY);
    departures.filter(move |start| *start <= now).map(move |start| ((now - start) / STAY, (now - start) % STAY))
}

/// What the line reads over a period.
pub fn line_inputs() -> Vec<LineInput<BLOCKS>> {
    let cycles = (0..PERIOD).map(|now| {
        let mut blocks =
            [Detection { low_check: false, high_check: false, present: SectionSet::EMPTY, reset: None }; BLOCKS];
        for (number, block) in blocks.iter_mut().enumerate() {
            let mut present = 0;
            for (section, stood) in heads(now) {
                let (first, end) = (number * SECTIONS, (number + 1) * SECTIONS);
                block.low_check |= section == first && stood < 4;
                block.high_check |= section == end && stood < 4;
                // A detector misses a train for a cycle now and then.
                if (first..end).contains(&section) && !(now * 7 + section).is_multiple_of(97) {
                    present |= 1 << (section - first);
                }
            }
            block.present = SectionSet::from_bits(present);
            block.reset = (now == 0).then_some(TrainCount(0));
        }
        LineInput { blocks, beyond: Beyond { hold: Hold::NONE, entered: true } }
    });
    cycles.collect()
}

/// What the first block of the line reads over a period, if the block ahead takes over at once.
pub fn block_inputs() -> Vec<Input> {
    let inputs = line_inputs().into_iter().map(|input| {
        let Detection { low_check, high_check, present, reset } = input.blocks[0];
        let ahead_hold = input.beyond.hold;
        Input { check_in: low_check, check_out: high_check, present, reset, ahead_hold, ahead_entered: true }
    });
    inputs.collect()
}

/// Runs `count` cycles of a block of 16 sections.
pub fn run_block(count: u64) -> atc_kernel::block::Output {
    let (parameters, inputs) = (block(), block_inputs());
    let mut state = atc_kernel::block::State::INITIAL;
    let mut output = <Block as atc_kernel::Machine>::SAFE;
    for input in inputs.iter().cycle().take(usize::try_from(count).unwrap_or(usize::MAX)) {
        (state, output) = atc_kernel::block::step(parameters, state, *input);
    }
    output
}

/// The same as lines of the protocol: the start, and one period of steps.
pub fn lines() -> (String, String) {
    let mut lines = crate::block_chart::lines(&config(), &block_inputs());
    let steps = lines.split_off(1).concat();
    (lines.concat(), steps)
}

#[cfg(test)]
mod tests {
    use atc_kernel::Machine as _;
    use atc_kernel::block::LineState;

    /// The traffic is what it says: over a period most reports are in agreement, trains pass, and nothing faults.
    #[test]
    fn the_traffic_is_busy_and_clean() {
        let line = super::line();
        let (mut state, mut agreed, mut missed, mut most, mut left) = (LineState::INITIAL, 0, 0, 0, 0);
        for input in super::line_inputs() {
            let (next, output) = line.step(state, input);
            state = next;
            for block in output.blocks {
                assert_eq!(block.status, atc_kernel::block::Status::Counting);
                agreed += u32::from(block.agree);
                missed += u32::from(!block.agree);
                most = most.max(block.count.0);
            }
            left += u32::from(output.blocks[3].counted_out);
        }
        assert!(missed > 500 && agreed > 8 * missed, "{agreed} in agreement, {missed} not");
        assert_eq!((most, left), (8, 95));
        assert!(state.blocks.iter().all(|block| block.parts().count == 0), "the line is empty at the end");
    }
}
