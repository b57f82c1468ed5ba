//! The line in a model of a border: the kernel's, and two with other rules of who takes over, to compare with.

use atc_kernel::Machine;
use atc_kernel::block::{Border, Detection, Input, Line, LineInput, LineOutput, LineState, Output, Status, step};

/// A line of two blocks: the kernel's, or another one.
pub trait Lining: Clone + std::fmt::Debug + Send + Sync + 'static {
    /// One logic cycle.
    fn step(&self, line: &Line<2>, state: LineState<2>, input: LineInput<2>) -> (LineState<2>, LineOutput<2>);
    /// Whether the block ahead takes over a train in a cycle from `before` that reads `input`, with this report: for traces.
    fn takes_over(&self, before: &LineState<2>, input: &LineInput<2>, ahead: &Output) -> bool;
    /// Whether the state keeps the machine's invariant.
    fn is_valid(&self, line: &Line<2>, state: &LineState<2>) -> bool;
}

/// The kernel's own: a block takes over one train for each rising edge of its check-in.
#[derive(Clone, Copy, Debug)]
pub struct RealLine;

impl Lining for RealLine {
    fn step(&self, line: &Line<2>, state: LineState<2>, input: LineInput<2>) -> (LineState<2>, LineOutput<2>) {
        line.step(state, input)
    }

    fn takes_over(&self, before: &LineState<2>, input: &LineInput<2>, _: &Output) -> bool {
        before.borders[1].0 > 0 || input.blocks[1].low_check && before.blocks[1].parts().check_in_for == 0
    }

    fn is_valid(&self, line: &Line<2>, state: &LineState<2>) -> bool {
        state.is_valid(line)
    }
}

/// As domain.md states the rule: a block takes over what it has counted in, and every train while it reports everything occupied,
/// also because it counts and disagrees with its detectors. The border remembers check-ins counted ahead less check-outs that took
/// effect as a signed number.
#[derive(Clone, Copy, Debug)]
pub struct OnDisagreement;

impl Lining for OnDisagreement {
    fn step(&self, line: &Line<2>, state: LineState<2>, input: LineInput<2>) -> (LineState<2>, LineOutput<2>) {
        by_rule(self, line, state, input)
    }

    fn takes_over(&self, before: &LineState<2>, _: &LineInput<2>, ahead: &Output) -> bool {
        before.borders[1].0.cast_signed() + i8::from(ahead.counted_in) > 0 || !ahead.agree
    }

    fn is_valid(&self, line: &Line<2>, state: &LineState<2>) -> bool {
        blocks_valid(line, state)
    }
}

/// A block takes over what it has counted in, and every train while it does not count.
#[derive(Clone, Copy, Debug)]
pub struct OnNotCounting;

impl Lining for OnNotCounting {
    fn step(&self, line: &Line<2>, state: LineState<2>, input: LineInput<2>) -> (LineState<2>, LineOutput<2>) {
        by_rule(self, line, state, input)
    }

    fn takes_over(&self, before: &LineState<2>, _: &LineInput<2>, ahead: &Output) -> bool {
        before.borders[1].0.cast_signed() + i8::from(ahead.counted_in) > 0 || ahead.status != Status::Counting
    }

    fn is_valid(&self, line: &Line<2>, state: &LineState<2>) -> bool {
        blocks_valid(line, state)
    }
}

/// One cycle of the kernel's blocks with another rule of who takes over. An account of the border is kept only while both count,
/// and ends with a reset on either side.
fn by_rule<L: Lining>(
    rule: &L,
    line: &Line<2>,
    state: LineState<2>,
    input: LineInput<2>,
) -> (LineState<2>, LineOutput<2>) {
    let read = |block: usize, ahead_hold, ahead_entered| {
        let Detection { low_check, high_check, present, reset } = input.blocks[block];
        Input { check_in: low_check, check_out: high_check, present, reset, ahead_hold, ahead_entered }
    };
    let (ahead, report) = step(line.blocks()[1], state.blocks[1], read(1, input.beyond.hold, input.beyond.entered));
    let account = state.borders[1].0.cast_signed() + i8::from(report.counted_in);
    let entered = rule.takes_over(&state, &input, &report);
    let (behind, report_behind) = step(line.blocks()[0], state.blocks[0], read(0, report.behind_hold, entered));
    let reset = input.blocks.iter().any(|block| block.reset.is_some());
    let both = [report, report_behind].iter().all(|report| report.status == Status::Counting);
    let account = if both && !reset { account - i8::from(report_behind.counted_out) } else { 0 };
    let next = LineState { blocks: [behind, ahead], borders: [Border(0), Border(account.cast_unsigned())] };
    (next, LineOutput { blocks: [report_behind, report], before_hold: report_behind.behind_hold })
}

fn blocks_valid(line: &Line<2>, state: &LineState<2>) -> bool {
    state.blocks.iter().zip(line.blocks()).all(|(state, block)| state.is_valid(*block))
}
