//! The ground's device as one machine: from the detection of trains to the frames and codes of every circuit.
//!
//! In one cycle: the counted line, if there is one, is counted ([`crate::block`]); what it reports is told to the interlocking as
//! occupied circuits; the interlocking and its ATC run ([`crate::interlocking`]); and what the ATC tells the train of each circuit
//! becomes frames and codes ([`crate::telegram`], [`crate::code`]), for each direction of travel apart. What two stations
//! tell each other carries its age.
//!
//! Requirements: `spec/wayside.md`, WAY-1 to WAY-26. Read in this order: [`Equipment`] and [`Wayside`] (parameters), [`Input`] and
//! [`Output`], [`State`] with its `is_valid`, [`Wayside::read`] and [`Wayside::send`], of which a step is made.

mod chain;
mod consent;
mod counters;
mod join;
mod signals;
mod speech;

pub use chain::{Chain, Place, Way};
pub use consent::{Consent, Message, Permission, Session, Stamp, check_life};
pub use counters::{Counters, Framed};
pub use join::{Counted, Join, Spot};
pub use signals::{Codes, Facing, Fixed, SignalPlan, Signals, Word, check_codes, check_speeds, circuits, spell, words};
pub use speech::{Feed, Saying, Speech, Transmission};

use crate::Machine;
use crate::block::{Detection, LineError, LineOutput, LineState};
use crate::interlocking::{
    self, CircuitId, CircuitSet, Combined, Commands, Layout, Memory, Orders, PerCircuit, Positions, Refusal, Request,
    RouteSet, SegmentSet, Size, Small, SpeedCode,
};
use crate::time::Ticks;
use chain::SECTIONS;

/// What a device has besides its layout. Not checked.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Equipment<const B: usize, Z: Size = Small> {
    /// The counted line: `B` blocks, or none.
    pub counted: Option<Join<B>>,
    /// What the transmitters say of the line.
    pub signals: SignalPlan<Z>,
    /// For how many cycles the neighbour's permission counts, from the own cycle that its message answers: 1 or more, less than
    /// the layout's turn time, and with its residual running and loss no more than that.
    pub life: Ticks,
    /// The number of this start of the device, never the same twice.
    pub session: Session,
}

/// A device: a layout and its equipment, checked.
#[derive(Clone, Copy, Debug)]
pub struct Wayside<'a, const B: usize, const R: usize, const P: usize, const N: usize, const S: usize, Z: Size = Small>
{
    layout: &'a Layout<R, P, N, S, Z>,
    counted: Option<Counted<B, SECTIONS, Z>>,
    signals: Signals<Z>,
    life: Ticks,
    session: Session,
}

/// Which rule the equipment breaks. Source: `spec/wayside.md`, WAY-11 to WAY-20 and WAY-25.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum WaysideError {
    /// The segment that is counted does not exist.
    NoSuchSegment,
    /// This route needs the counted segment in the other direction of travel.
    RouteAgainstTheLine(u8),
    /// This route leads over a circuit of the counted line, or has one in its overlap, and does not need the counted segment.
    RouteOfAnotherLine(u8),
    /// A section has no circuit.
    SectionWithoutCircuit(Spot),
    /// A circuit is given for a section that the block does not have.
    CircuitWithoutSection(Spot),
    /// The circuit of this section is neither of the segment nor its throat.
    SectionElsewhere(Spot),
    /// The circuit of this section does not follow that of the one before it, from the low end.
    SectionsOutOfOrder(Spot),
    /// The line is none.
    Line(LineError),
    /// Beyond the exit is no circuit that would report a train there.
    NothingBeyondTheExit,
    /// At the entry, what is held behind a head is shorter than the longest train.
    HoldTooShortAtTheEntry,
    /// Code 0 does not stand for speed 0.
    StopMoves,
    /// This code stands for no higher speed than the one below it.
    SpeedsFall(SpeedCode),
    /// The speed of this code is not in the trains' table.
    NoRank(SpeedCode),
    /// The speed of this code has no pair of codes.
    NoPair(SpeedCode),
    /// The layout has a braking distance for this code, and the signals have no speed.
    CodeWithoutSpeed(SpeedCode),
    /// Nothing is said of this circuit, and trains may be there.
    CircuitWithoutSignals(CircuitId),
    /// Something is said of this circuit, and the layout has no length for it.
    NoLength(CircuitId),
    /// The curve limit of this circuit is not in the trains' table.
    UnknownCurve(CircuitId),
    /// A section number of this circuit is even for trains towards the left, or odd for those towards the right.
    SectionNumberOfOther(CircuitId),
    /// A section number of this circuit stands for another circuit.
    SectionNumberTwice(CircuitId),
    /// The neighbour's permission would never count.
    NoLife,
    /// The neighbour's permission counts for as long as the turn time, or a train that is sent at its end runs on for longer.
    LifeOutlastsTurn,
}

impl<'a, const B: usize, const R: usize, const P: usize, const N: usize, const S: usize, Z: Size>
    Wayside<'a, B, R, P, N, S, Z>
{
    /// A device with this equipment.
    ///
    /// # Errors
    /// The first rule that is broken.
    pub fn new(layout: &'a Layout<R, P, N, S, Z>, equipment: &Equipment<B, Z>) -> Result<Self, WaysideError> {
        let plan = layout.plan();
        consent::check_life(equipment.life, plan.turn, plan.residual, plan.loss)?;
        let counted = match &equipment.counted {
            Some(join) => Some(Counted::new(layout, join)?),
            None => None,
        };
        let signals = Signals::new(layout, &equipment.signals)?;
        Ok(Self { layout, counted, signals, life: equipment.life, session: equipment.session })
    }

    /// The layout.
    pub const fn layout(&self) -> &'a Layout<R, P, N, S, Z> {
        self.layout
    }

    /// The counted line, if there is one.
    pub const fn counted(&self) -> Option<&Counted<B, SECTIONS, Z>> {
        self.counted.as_ref()
    }

    /// What the transmitters say of the line.
    pub const fn signals(&self) -> &Signals<Z> {
        &self.signals
    }

    /// The age of the oldest thing on which a telegram can rest that is put out in a cycle: the neighbour's permission. All that
    /// is detected is of the cycle itself.
    pub const fn oldest(&self) -> Ticks {
        self.life
    }
}

/// What the device reads in one logic cycle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Input<const B: usize, const S: usize, Z: Size = Small> {
    /// The blocks of the counted line, from its low end.
    pub blocks: [Detection; B],
    /// The circuits that are reported occupied by what they have of their own.
    pub occupied: CircuitSet<Z>,
    /// The positions in which points are detected.
    pub detected: Positions<Z>,
    /// One request, or none.
    pub request: Option<Request>,
    /// What staff command.
    pub orders: Orders<Z>,
    /// The message of the neighbour at each segment, if one came.
    pub messages: [Option<Message>; S],
    /// The transmitters that have taken the frames of the last cycle.
    pub framed: Framed<Z>,
}

/// Everything that leaves the device in one logic cycle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Output<const B: usize, const S: usize, Z: Size = Small> {
    /// The routes whose signals show proceed; all others show stop.
    pub proceed: RouteSet<Z>,
    /// The points that are driven, and whereto.
    pub drives: Positions<Z>,
    /// The blocked circuits that staff may rely on.
    pub confirmed: CircuitSet<Z>,
    /// What became of the request.
    pub answer: Option<Result<(), Refusal>>,
    /// What is told to the neighbour at each segment; none where there is no segment.
    pub messages: [Option<Message>; S],
    /// What the counted line reports to staff; none without one.
    pub line: Option<LineOutput<B>>,
    /// What is sent in each circuit; none is silence.
    pub transmissions: PerCircuit<Option<Transmission>, Z>,
}

/// What the device remembers from one logic cycle to the next.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct State<const B: usize, const R: usize, const S: usize, Z: Size = Small> {
    /// The counted line.
    pub line: LineState<B>,
    /// Interlocking and ATC.
    pub device: Memory<R, S, Z>,
    /// The neighbour at each segment.
    pub consents: [Consent; S],
    /// The numbers of each circuit's next telegrams.
    pub counters: PerCircuit<Counters, Z>,
    /// The circuits for which there were frames in the last cycle.
    pub sent: CircuitSet<Z>,
}

impl<const B: usize, const R: usize, const S: usize, Z: Size> State<B, R, S, Z> {
    /// Whether the device can be in this state: that of each part, and the counted line has no direction but its own.
    pub fn is_valid<const P: usize, const N: usize>(&self, wayside: &Wayside<'_, B, R, P, N, S, Z>) -> bool {
        let mut valid = self.device.is_valid(wayside.layout);
        for consent in &self.consents {
            valid &= consent.is_valid(wayside.life);
        }
        let directions = self.device.interlocking.directions;
        match &wayside.counted {
            Some(counted) => {
                valid && self.line.is_valid(counted.line()) && counted.is_kept(directions.toward, directions.away)
            }
            None => valid,
        }
    }
}

/// What [`Wayside::read`] makes of the input.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Reading<const B: usize, Z: Size = Small> {
    /// What the interlocking is told.
    pub input: interlocking::Input<Z>,
    /// What the counted line reports.
    pub line: Option<LineOutput<B>>,
    /// Why the request is not told to the interlocking; none if it is.
    pub refused: Option<Refusal>,
}

impl<const B: usize, const R: usize, const P: usize, const N: usize, const S: usize, Z: Size>
    Wayside<'_, B, R, P, N, S, Z>
{
    /// The cycle that begins: the stamp of its messages.
    #[inline]
    fn now(&self, state: &State<B, R, S, Z>) -> Stamp {
        Stamp { session: self.session, cycle: state.device.cycle.next() }
    }

    /// The first part of a cycle: everything before interlocking and ATC.
    #[inline]
    #[must_use]
    pub fn read(&self, mut state: State<B, R, S, Z>, input: Input<B, S, Z>) -> (State<B, R, S, Z>, Reading<B, Z>) {
        let now = self.now(&state);
        let mut consent = SegmentSet::EMPTY;
        for (number, (known, message)) in state.consents.iter_mut().zip(input.messages).enumerate() {
            *known = known.hear(self.life, now, message);
            consent = consent.or(SegmentSet::nth(number).only_if(known.counts(self.life)));
        }
        for (number, counters) in state.counters.iter_mut().enumerate() {
            *counters = counters.step(CircuitSet::nth(number), state.sent, input.framed);
        }
        let mut occupied = input.occupied;
        let mut line = None;
        let mut request = Ok(input.request);
        if let Some(counted) = &self.counted {
            let (next, report, told) = counted.count(state.line, input.blocks, input.occupied);
            state.line = next;
            occupied = told;
            request = counted.admit(input.request, &report);
            line = Some(report);
        }
        let input = interlocking::Input {
            occupied,
            detected: input.detected,
            request: request.unwrap_or(None),
            orders: input.orders,
            consent,
        };
        (state, Reading { input, line, refused: request.err() })
    }

    /// The last part of a cycle: what leaves the device. `state` has the memory that interlocking and ATC have after `commands`.
    #[inline]
    #[must_use]
    pub fn send(
        &self,
        mut state: State<B, R, S, Z>,
        reading: &Reading<B, Z>,
        commands: &Commands<R, Z>,
    ) -> (State<B, R, S, Z>, Output<B, S, Z>) {
        let Commands { interlocking, telegrams } = commands;
        let mut transmissions = PerCircuit::all(None);
        state.sent = CircuitSet::EMPTY;
        let lengths = &self.layout.plan().lengths;
        let restrictions = state.device.interlocking.works.restrictions;
        let known = telegrams.iter().zip(&state.counters);
        for (number, (transmission, (movement, counters))) in transmissions.iter_mut().zip(known).enumerate() {
            let it = CircuitSet::<Z>::nth(number);
            let Some(circuit) = it.first() else { continue };
            *transmission = self.signals.sent(lengths, circuit, *movement, restrictions, *counters);
            state.sent = state.sent.or(it.only_if(transmission.is_some()));
        }
        let answer = reading.refused.map(Err).or(interlocking.answer);
        let output = Output {
            proceed: interlocking.proceed,
            drives: interlocking.drives,
            confirmed: interlocking.confirmed,
            answer,
            messages: self.messages(&state, interlocking.permits),
            line: reading.line,
            transmissions,
        };
        (state, output)
    }

    /// What is told to the neighbours in the cycle that has run.
    #[inline]
    #[must_use]
    pub fn messages(&self, state: &State<B, R, S, Z>, permits: SegmentSet<Z>) -> [Option<Message>; S] {
        let sent = Stamp { session: self.session, cycle: state.device.cycle };
        let mut messages = [None; S];
        let known = self.layout.plan().segments.iter().zip(&state.consents);
        for (number, (message, (segment, consent))) in messages.iter_mut().zip(known).enumerate() {
            let granted = permits.meets(SegmentSet::nth(number));
            let permission = if granted { Permission::Granted } else { Permission::Withheld };
            *message = (segment.length > 0).then_some(consent.tell(sent, permission));
        }
        messages
    }
}

impl<const B: usize, const R: usize, const P: usize, const N: usize, const S: usize, Z: Size> Machine
    for Wayside<'_, B, R, P, N, S, Z>
{
    type State = State<B, R, S, Z>;
    type Input = Input<B, S, Z>;
    type Output = Output<B, S, Z>;

    //= spec/wayside.md#way-23-what-is-safe
    //# The safe output MUST be stop at every signal, no drive, no permission, no confirmed block and silence in every circuit.
    const SAFE: Self::Output = Output {
        proceed: RouteSet::EMPTY,
        drives: Positions::NONE,
        confirmed: CircuitSet::EMPTY,
        answer: None,
        messages: [None; S],
        line: None,
        transmissions: PerCircuit::NONE,
    };

    fn initial(&self) -> Self::State {
        State {
            line: LineState::INITIAL,
            device: Memory::INITIAL,
            consents: [Consent::none(self.life); S],
            counters: PerCircuit::NONE,
            sent: CircuitSet::EMPTY,
        }
    }

    fn step(&self, state: Self::State, input: Self::Input) -> (Self::State, Self::Output) {
        let (mut state, reading) = self.read(state, input);
        let (device, commands) = Combined(self.layout).step(state.device, reading.input);
        state.device = device;
        self.send(state, &reading, &commands)
    }
}
