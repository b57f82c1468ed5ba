//! The ground's devices: the kernel's [`Combined`] of every station, or its whole [`Wayside`]; the points that they drive, and the
//! telegrams between them.

use std::collections::VecDeque;
use std::sync::Arc;

use atc_kernel::Machine as _;
use atc_kernel::interlocking::{
    CircuitSet, Combined, Heading, Input, Layout, Memory, Movement, Orders, PerCircuit, Phase, PointSet, Positions,
    Refusal, Request, RouteSet, SegmentSet,
};
use atc_kernel::wayside::{Equipment, Framed, Message as Said, Session, Transmission, Wayside, WaysideError};
use atc_kernel::wayside::{Input as WaysideInput, State as WaysideState};

use crate::counted::{Detections, Disagreeing, MAX_BLOCKS, SILENT};
use crate::motion::Lie;
use crate::track::Track;

/// What a station's device puts out in one cycle.
#[derive(Clone, Copy, Debug)]
pub struct Reply {
    /// The signals at proceed, by route.
    pub proceed: RouteSet,
    /// The points that are driven.
    pub drives: Positions,
    /// The segments where the neighbour may send.
    pub permits: SegmentSet,
    /// What became of the request.
    pub answer: Option<Result<(), Refusal>>,
    /// The telegram of each circuit.
    pub telegrams: PerCircuit<Option<Movement>>,
    /// The frames and codes of each circuit; none without a whole device.
    pub transmissions: PerCircuit<Option<Transmission>>,
    /// What is told to the neighbour at each segment; none without a whole device.
    pub messages: [Option<Said>; MAX_SEGMENTS],
    /// The circuits that count as occupied because of the counted line alone.
    pub counted: CircuitSet,
    /// Whether each block of the counted line agrees with its detectors.
    pub agree: [bool; MAX_BLOCKS],
}

impl Reply {
    /// Stop, and silence.
    const SAFE: Self = Self {
        proceed: RouteSet::EMPTY,
        drives: Positions::NONE,
        permits: SegmentSet::EMPTY,
        answer: None,
        telegrams: PerCircuit::NONE,
        transmissions: PerCircuit::NONE,
        messages: [None; MAX_SEGMENTS],
        counted: CircuitSet::EMPTY,
        agree: [false; MAX_BLOCKS],
    };
}

/// The most segments of a station here.
const MAX_SEGMENTS: usize = 8;

/// What a whole device hears besides what is detected.
#[derive(Clone, Copy, Debug)]
pub struct Heard {
    /// The message of the neighbour at each segment, if one came.
    pub messages: [Option<Said>; MAX_SEGMENTS],
    /// The transmitters that have taken the frames of the last cycle.
    pub framed: Framed,
    /// The checks and detectors of the counted line.
    pub blocks: Detections,
}

/// What a station's device remembers, for pictures.
#[derive(Clone, Debug, Default)]
pub struct View {
    /// The circuits that count as occupied.
    pub occupied: CircuitSet,
    /// The blocked circuits.
    pub blocked: CircuitSet,
    /// The phase of each route, and what it still holds of its path and of its overlap.
    pub routes: Vec<(Phase, CircuitSet, CircuitSet)>,
    /// The segments where the neighbour may send.
    pub toward: SegmentSet,
    /// The segments where this station sends.
    pub away: SegmentSet,
}

/// A device of any size.
pub trait Device: Send + Sync {
    /// One cycle.
    fn step(&mut self, input: Input, heard: Heard) -> Reply;
    /// Starts it anew.
    fn restart(&mut self);
    /// What it remembers.
    fn view(&self) -> View;
    /// Another one that remembers the same.
    fn copied(&self) -> Box<dyn Device>;
}

impl Clone for Box<dyn Device> {
    fn clone(&self) -> Self {
        self.as_ref().copied()
    }
}

/// The kernel's device for one layout.
#[derive(Clone)]
pub struct Held<const R: usize, const P: usize, const N: usize, const S: usize> {
    layout: Arc<Layout<R, P, N, S>>,
    memory: Memory<R, S>,
}

impl<const R: usize, const P: usize, const N: usize, const S: usize> Held<R, P, N, S> {
    /// The device, just started.
    pub const fn new(layout: Arc<Layout<R, P, N, S>>) -> Self {
        Self { layout, memory: Memory::INITIAL }
    }
}

impl<const R: usize, const P: usize, const N: usize, const S: usize> Device for Held<R, P, N, S> {
    fn step(&mut self, input: Input, _: Heard) -> Reply {
        let (memory, commands) = Combined(&self.layout).step(self.memory, input);
        self.memory = memory;
        let output = commands.interlocking;
        Reply {
            proceed: output.proceed,
            drives: output.drives,
            permits: output.permits,
            answer: output.answer,
            telegrams: commands.telegrams,
            ..Reply::SAFE
        }
    }

    fn restart(&mut self) {
        self.memory = Memory::INITIAL;
    }

    fn view(&self) -> View {
        viewed(&self.layout, &self.memory)
    }

    fn copied(&self) -> Box<dyn Device> {
        Box::new(self.clone())
    }
}

/// The kernel's whole device for one layout, with its transmitters, and a counted line of `B` blocks, or none.
#[derive(Clone)]
pub struct Speaking<const R: usize, const P: usize, const N: usize, const S: usize, const B: usize> {
    layout: Arc<Layout<R, P, N, S>>,
    equipment: Equipment<B>,
    state: Option<WaysideState<B, R, S>>,
}

impl<const R: usize, const P: usize, const N: usize, const S: usize, const B: usize> Speaking<R, P, N, S, B> {
    /// The device, just started.
    ///
    /// # Errors
    /// The rule that the equipment breaks.
    pub fn new(layout: Arc<Layout<R, P, N, S>>, equipment: Equipment<B>) -> Result<Self, WaysideError> {
        Wayside::new(&layout, &equipment)?;
        Ok(Self { layout, equipment, state: None })
    }
}

impl<const R: usize, const P: usize, const N: usize, const S: usize, const B: usize> Device
    for Speaking<R, P, N, S, B>
{
    fn step(&mut self, input: Input, heard: Heard) -> Reply {
        // It was checked when the device was made.
        let Ok(wayside) = Wayside::new(&self.layout, &self.equipment) else { return Reply::SAFE };
        let state = self.state.unwrap_or_else(|| wayside.initial());
        let mut messages = [None; S];
        for (message, told) in messages.iter_mut().zip(heard.messages) {
            *message = told;
        }
        let Input { occupied, detected, request, orders, .. } = input;
        let [nothing, ..] = SILENT;
        let mut blocks = [nothing; B];
        for (block, read) in blocks.iter_mut().zip(heard.blocks) {
            *block = read;
        }
        let input = WaysideInput { blocks, occupied, detected, request, orders, messages, framed: heard.framed };
        // The three parts of its step, so that a run can be judged by what the train of each circuit is told.
        let (mut state, reading) = wayside.read(state, input);
        let counted = reading.input.occupied.without(occupied);
        let (memory, commands) = Combined(&self.layout).step(state.device, reading.input);
        state.device = memory;
        let (state, output) = wayside.send(state, &reading, &commands);
        self.state = Some(state);
        let mut messages = [None; MAX_SEGMENTS];
        for (message, told) in messages.iter_mut().zip(output.messages) {
            *message = told;
        }
        let mut agree = [false; MAX_BLOCKS];
        for (agree, block) in agree.iter_mut().zip(output.line.iter().flat_map(|line| &line.blocks)) {
            *agree = block.agree;
        }
        Reply {
            proceed: output.proceed,
            drives: output.drives,
            permits: commands.interlocking.permits,
            answer: output.answer,
            telegrams: commands.telegrams,
            transmissions: output.transmissions,
            messages,
            counted,
            agree,
        }
    }

    fn restart(&mut self) {
        self.state = None;
        self.equipment.session = Session(self.equipment.session.0.wrapping_add(1));
    }

    fn view(&self) -> View {
        self.state.as_ref().map_or_else(View::default, |state| viewed(&self.layout, &state.device))
    }

    fn copied(&self) -> Box<dyn Device> {
        Box::new(self.clone())
    }
}

/// What a device with this memory shows.
fn viewed<const R: usize, const P: usize, const N: usize, const S: usize>(
    layout: &Layout<R, P, N, S>,
    memory: &Memory<R, S>,
) -> View {
    let (plan, state) = (layout.plan(), &memory.interlocking);
    let mut occupied = CircuitSet::EMPTY;
    for (number, cycles) in state.track.clear_for().iter().enumerate() {
        occupied = occupied.or(CircuitSet::nth(number).only_if(*cycles < plan.clear));
    }
    let routes = plan
        .routes
        .iter()
        .zip(&state.routes)
        .map(|(route, state)| (state.phase, state.path(route).circuits, state.overlap(route).circuits));
    let (toward, away) = (state.directions.toward, state.directions.away);
    View { occupied, blocked: state.works.blocked, routes: routes.collect(), toward, away }
}

/// A point as it lies.
#[derive(Clone, Copy, Debug)]
pub struct PointState {
    /// Whether it stands, or last stood, in reverse.
    pub reverse: bool,
    /// How long it still moves, in ms.
    pub moves_ms: Option<u32>,
    /// The time of its stroke, in ms.
    pub stroke_ms: u32,
}

impl PointState {
    /// How a train finds it.
    pub fn lie(&self) -> Lie {
        if self.moves_ms.is_some() { None } else { Some(self.reverse) }
    }
}

/// The last telegram from a neighbour about one segment.
#[derive(Clone, Copy, Debug, Default)]
struct Consent {
    sent_ms: u64,
    received_ms: u64,
    given: bool,
}

/// A telegram on its way to a station.
#[derive(Clone, Copy, Debug)]
struct Message {
    arrives_ms: u64,
    sent_ms: u64,
    segment: usize,
    given: bool,
    said: Option<Said>,
}

/// A station at work.
#[derive(Clone)]
pub struct Station {
    device: Box<dyn Device>,
    /// What is sent in the circuits now.
    pub telegrams: PerCircuit<Option<Movement>>,
    /// What the transmitters send now.
    pub air: PerCircuit<Option<Transmission>>,
    /// The transmitters that have taken the frames of the last cycle.
    taken: CircuitSet,
    /// What the device said last.
    pub reply: Reply,
    consents: Vec<Consent>,
    inbox: VecDeque<Message>,
    unblocked: bool,
    /// Since when blocks of the counted line disagree.
    pub disagreeing: Disagreeing,
}

impl Station {
    /// A station whose device has just started, with so many segments.
    pub fn new(device: Box<dyn Device>, segments: usize) -> Self {
        Self {
            device,
            telegrams: PerCircuit::NONE,
            air: PerCircuit::NONE,
            taken: CircuitSet::EMPTY,
            reply: Reply::SAFE,
            consents: vec![Consent::default(); segments],
            inbox: VecDeque::new(),
            unblocked: false,
            disagreeing: [None; MAX_BLOCKS],
        }
    }

    /// The transmitters, but for those in `stuck`, take the frames for both directions of travel, and send them in turn.
    pub fn take(&mut self, stuck: CircuitSet) {
        for (number, air) in self.air.iter_mut().enumerate() {
            let it = CircuitSet::nth(number);
            if !stuck.meets(it) {
                *air = self.reply.transmissions[number];
                self.taken = self.taken.or(it);
            }
        }
    }

    /// Starts the device anew: it forgets what it knew, and staff unblock the circuits again.
    pub fn restart(&mut self) {
        self.device.restart();
        self.unblocked = false;
        self.consents.fill(Consent::default());
    }

    /// What the device remembers.
    pub fn view(&self) -> View {
        self.device.view()
    }

    /// Puts a telegram of the neighbour on its way: whether trains may be sent into `segment`.
    pub fn post(&mut self, now_ms: u64, delay_ms: u64, segment: usize, (given, said): (bool, Option<Said>)) {
        self.inbox.push_back(Message { arrives_ms: now_ms + delay_ms, sent_ms: now_ms + 1, segment, given, said });
    }

    /// One cycle at `now_ms`: what was said in the cycle before goes into the rails, but for the circuits in `stuck`.
    pub fn cycle(
        &mut self,
        (now_ms, life_ms): (u64, u64),
        (occupied, detected, blocks): (CircuitSet, Positions, Detections),
        request: Option<Request>,
        stuck: CircuitSet,
    ) {
        for (number, telegram) in self.reply.telegrams.iter().enumerate() {
            if !stuck.meets(CircuitSet::nth(number)) {
                self.telegrams[number] = *telegram;
            }
        }
        let framed = Framed { main: self.taken, sub: self.taken };
        let mut heard = Heard { messages: [None; MAX_SEGMENTS], framed, blocks };
        self.taken = CircuitSet::EMPTY;
        while self.inbox.front().is_some_and(|message| message.arrives_ms <= now_ms) {
            let Some(message) = self.inbox.pop_front() else { break };
            if let Some(told) = heard.messages.get_mut(message.segment) {
                *told = message.said;
            }
            let consent = &mut self.consents[message.segment];
            // A telegram that was sent before the last one is no news.
            if message.sent_ms > consent.sent_ms {
                *consent = Consent { sent_ms: message.sent_ms, received_ms: now_ms, given: message.given };
            }
        }
        let mut consent = SegmentSet::EMPTY;
        for (number, last) in self.consents.iter().enumerate() {
            consent = consent.or(SegmentSet::nth(number).only_if(last.given && now_ms - last.received_ms <= life_ms));
        }
        let mut orders = Orders::default();
        if !self.unblocked {
            orders.unblock = CircuitSet::ALL;
            orders.lift = CircuitSet::ALL;
            self.unblocked = true;
        }
        self.reply = self.device.step(Input { occupied, detected, request, orders, consent }, heard);
    }

    /// The code that a train hears whose front is in the circuit of this number and faces so; and what it is told.
    pub fn code(&self, number: usize, faces: Option<Heading>) -> (Option<u8>, Option<Movement>) {
        match self.telegrams[number] {
            Some(movement) if movement.heading.is_none() => (Some(0), Some(movement)),
            // The code of a telegram comes from the end towards which it is for: the train's own axles keep it from the other end.
            Some(movement) if movement.heading == faces => (Some(movement.speed.0), Some(movement)),
            _ => (None, None),
        }
    }
}

/// Drives the points of a station for one cycle; `began` hears of each that begins to move. `late_ms` is added to strokes.
pub fn drive(
    track: &Track,
    site: usize,
    points: &mut [PointState],
    drives: Positions,
    (cycle_ms, late_ms): (u32, &dyn Fn(usize) -> u32),
    began: &mut dyn FnMut(usize),
) -> Positions {
    let mut detected = Positions::NONE;
    for (number, global) in track.sites[site].points.iter().enumerate() {
        let it = PointSet::nth(number);
        let state = &mut points[*global];
        if let Some(left) = state.moves_ms {
            state.moves_ms = left.checked_sub(cycle_ms).filter(|left| *left > 0);
        }
        let wanted = (drives.reverse.meets(it), drives.normal.meets(it));
        if state.moves_ms.is_none()
            && (wanted == (true, false) && !state.reverse || wanted == (false, true) && state.reverse)
        {
            state.reverse = !state.reverse;
            state.moves_ms = Some(state.stroke_ms + late_ms(*global));
            began(*global);
        }
        match state.lie() {
            Some(true) => detected.reverse = detected.reverse.or(it),
            Some(false) => detected.normal = detected.normal.or(it),
            None => {}
        }
    }
    detected
}
