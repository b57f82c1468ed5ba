//! The kernel's device, whose type has the number of its blocks, behind one face.

use atc_kernel::Machine as _;
use atc_kernel::block::{Detection, Hold, Output as Block, SectionSet};
use atc_kernel::interlocking::{self, CircuitSet, Memory, Orders, PerCircuit, Positions, Refusal, Request, RouteSet};
use atc_kernel::time::Ticks;
use atc_kernel::wayside::{Equipment, Framed, Input, Message, Session, State, Transmission, Wayside, WaysideError};

type Station = interlocking::Station;

/// What is read in one cycle, whatever the number of blocks.
#[derive(Clone, Debug)]
pub(super) struct Read {
    pub(super) blocks: Vec<Detection>,
    pub(super) occupied: CircuitSet,
    pub(super) detected: Positions,
    pub(super) request: Option<Request>,
    pub(super) orders: Orders,
    pub(super) messages: [Option<Message>; 8],
    pub(super) framed: Framed,
}

/// What came of it.
pub(super) struct Done {
    pub(super) proceed: RouteSet,
    pub(super) drives: Positions,
    pub(super) confirmed: CircuitSet,
    pub(super) answer: Option<Result<(), Refusal>>,
    pub(super) messages: [Option<Message>; 8],
    pub(super) line: Option<(Vec<Block>, Hold)>,
    pub(super) transmissions: Box<PerCircuit<Option<Transmission>>>,
    /// What the interlocking was told.
    pub(super) told: interlocking::Input,
    pub(super) memory: Memory<64, 8>,
}

/// A device with its state.
pub(super) trait Device: Send + Sync {
    /// One logic cycle. `station` is the layout with which it was made.
    fn step(&mut self, station: &Station, read: &Read) -> Result<Done, WaysideError>;

    /// Starts anew.
    fn restart(&mut self, station: &Station, session: Session) -> Result<(), WaysideError>;

    /// The age of the oldest permission that counts.
    fn oldest(&self) -> Ticks;
}

struct Of<const B: usize> {
    equipment: Equipment<B>,
    state: Box<State<B, 64, 8>>,
}

/// A device with this equipment.
///
/// # Errors
/// The rule that it breaks.
pub(super) fn device<const B: usize>(
    station: &Station,
    equipment: Equipment<B>,
) -> Result<Box<dyn Device>, WaysideError> {
    let state = Box::new(Wayside::new(station, &equipment)?.initial());
    Ok(Box::new(Of { equipment, state }))
}

impl<const B: usize> Device for Of<B> {
    // The kernel's device borrows its layout: it is made again for each cycle, of what was accepted at the start.
    fn step(&mut self, station: &Station, read: &Read) -> Result<Done, WaysideError> {
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

    fn restart(&mut self, station: &Station, session: Session) -> Result<(), WaysideError> {
        self.equipment.session = session;
        *self.state = Wayside::new(station, &self.equipment)?.initial();
        Ok(())
    }

    fn oldest(&self) -> Ticks {
        self.equipment.life
    }
}
