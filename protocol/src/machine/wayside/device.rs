//! The kernel's device, whose type has the number of its blocks, behind one face.

use atc_kernel::Machine as _;
use atc_kernel::block::{Detection, Hold, Output as Block, SectionSet};
use atc_kernel::interlocking::{
    self, CircuitSet, Layout, Memory, Orders, PerCircuit, Positions, Refusal, Request, RouteSet, Size,
};
use atc_kernel::time::Ticks;
use atc_kernel::wayside::{Equipment, Framed, Input, Message, Session, State, Transmission, Wayside, WaysideError};

/// What is read in one cycle, whatever the number of blocks.
#[derive(Clone, Debug)]
pub(super) struct Read<const S: usize, Z: Size> {
    pub(super) blocks: Vec<Detection>,
    pub(super) occupied: CircuitSet<Z>,
    pub(super) detected: Positions<Z>,
    pub(super) request: Option<Request>,
    pub(super) orders: Orders<Z>,
    pub(super) messages: [Option<Message>; S],
    pub(super) framed: Framed<Z>,
}

/// What came of it.
pub(super) struct Done<const R: usize, const S: usize, Z: Size> {
    pub(super) proceed: RouteSet<Z>,
    pub(super) drives: Positions<Z>,
    pub(super) confirmed: CircuitSet<Z>,
    pub(super) answer: Option<Result<(), Refusal>>,
    pub(super) messages: [Option<Message>; S],
    pub(super) line: Option<(Vec<Block>, Hold)>,
    pub(super) transmissions: Box<PerCircuit<Option<Transmission>, Z>>,
    /// What the interlocking was told.
    pub(super) told: interlocking::Input<Z>,
    pub(super) memory: Memory<R, S, Z>,
}

/// A device with its state.
pub(super) trait Device<const R: usize, const P: usize, const N: usize, const S: usize, Z: Size>:
    Send + Sync
{
    /// One logic cycle. `station` is the layout with which it was made.
    fn step(&mut self, station: &Layout<R, P, N, S, Z>, read: &Read<S, Z>) -> Result<Done<R, S, Z>, WaysideError>;

    /// Starts anew.
    fn restart(&mut self, station: &Layout<R, P, N, S, Z>, session: Session) -> Result<(), WaysideError>;

    /// The age of the oldest permission that counts.
    fn oldest(&self) -> Ticks;
}

struct Of<const B: usize, const R: usize, const S: usize, Z: Size> {
    equipment: Equipment<B, Z>,
    state: Box<State<B, R, S, Z>>,
}

/// A device with this equipment.
///
/// # Errors
/// The rule that it breaks.
pub(super) fn device<const B: usize, const R: usize, const P: usize, const N: usize, const S: usize, Z: Size>(
    station: &Layout<R, P, N, S, Z>,
    equipment: Equipment<B, Z>,
) -> Result<Box<dyn Device<R, P, N, S, Z>>, WaysideError> {
    let state = Box::new(Wayside::new(station, &equipment)?.initial());
    Ok(Box::new(Of { equipment, state }))
}

impl<const B: usize, const R: usize, const P: usize, const N: usize, const S: usize, Z: Size> Device<R, P, N, S, Z>
    for Of<B, R, S, Z>
{
    // The kernel's device borrows its layout: it is made again for each cycle, of what was accepted at the start.
    fn step(&mut self, station: &Layout<R, P, N, S, Z>, read: &Read<S, Z>) -> Result<Done<R, S, Z>, WaysideError> {
        let wayside = Wayside::new(station, &self.equipment)?;
        let mut blocks = read.blocks.iter().copied();
        let none = Detection { low_check: false, high_check: false, present: SectionSet::EMPTY, reset: None };
        let Read { occupied, detected, request, orders, messages, framed, .. } = read.clone();
        let blocks = core::array::from_fn(|_| blocks.next().unwrap_or(none));
        let input = Input { blocks, occupied, detected, request, orders, messages, framed };
        let (_, reading) = wayside.read(*self.state, input);
        let (state, output) = wayside.step(*self.state, input);
        *self.state = state;
        Ok(Done {
            proceed: output.proceed,
            drives: output.drives,
            confirmed: output.confirmed,
            answer: output.answer,
            messages: output.messages,
            line: output.line.map(|line| (line.blocks.to_vec(), line.before_hold)),
            transmissions: Box::new(output.transmissions),
            told: interlocking::Input { request, ..reading.input },
            memory: self.state.device,
        })
    }

    fn restart(&mut self, station: &Layout<R, P, N, S, Z>, session: Session) -> Result<(), WaysideError> {
        self.equipment.session = session;
        *self.state = Wayside::new(station, &self.equipment)?.initial();
        Ok(())
    }

    fn oldest(&self) -> Ticks {
        self.equipment.life
    }
}
