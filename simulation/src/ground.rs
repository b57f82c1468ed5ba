//! The ground's devices: the kernel's [`Combined`] of every station, or its whole [`Wayside`]; the points that they drive, and the
//! telegrams between them.

use std::collections::VecDeque;
use std::sync::Arc;

use atc_kernel::Machine as _;
use atc_kernel::interlocking::{
    CircuitSet, Combined, Heading, Input, Large, Layout, Memory, Movement, Orders, PerCircuit, Phase, Positions,
    Refusal, Request, Small,
};
use atc_kernel::wayside::{Equipment, Framed, Message as Said, Session, Transmission, Wayside, WaysideError};
use atc_kernel::wayside::{Input as WaysideInput, State as WaysideState};

use crate::counted::{Detections, Disagreeing, MAX_BLOCKS, SILENT};
use crate::motion::Lie;
use crate::sizes::{Circuits, Points, Routes, Segments, Wide, narrow, wide_movement, wide_positions};
use crate::track::Track;

/// What a station's device puts out in one cycle.
#[derive(Clone, Debug)]
pub struct Reply {
    /// The signals at proceed, by route.
    pub proceed: Routes,
    /// The points that are driven.
    pub drives: Positions<Large>,
    /// The segments where the neighbour may send.
    pub permits: Segments,
    /// What became of the request.
    pub answer: Option<Result<(), Refusal>>,
    /// The telegram of each circuit; of one beyond the list nothing is sent.
    pub telegrams: Vec<Option<Movement<Large>>>,
    /// The frames and codes of each circuit; none without a whole device.
    pub transmissions: Vec<Option<Transmission>>,
    /// What is told to the neighbour at each segment; none without a whole device.
    pub messages: Vec<Option<Said>>,
    /// The circuits that count as occupied because of the counted line alone.
    pub counted: Circuits,
    /// Whether each block of the counted line agrees with its detectors.
    pub agree: [bool; MAX_BLOCKS],
}

impl Reply {
    /// Stop, and silence.
    const SAFE: Self = Self {
        proceed: Routes::EMPTY,
        drives: Positions::NONE,
        permits: Segments::EMPTY,
        answer: None,
        telegrams: Vec::new(),
        transmissions: Vec::new(),
        messages: Vec::new(),
        counted: Circuits::EMPTY,
        agree: [false; MAX_BLOCKS],
    };
}

/// What a whole device hears besides what is detected.
#[derive(Clone, Debug)]
pub struct Heard {
    /// The message of the neighbour at each segment, if one came.
    pub messages: Vec<Option<Said>>,
    /// The transmitters that have taken the frames of the last cycle.
    pub taken: Circuits,
    /// The checks and detectors of the counted line.
    pub blocks: Detections,
}

/// What a station's device remembers, for pictures.
#[derive(Clone, Debug, Default)]
pub struct View {
    /// The circuits that count as occupied.
    pub occupied: Circuits,
    /// The blocked circuits.
    pub blocked: Circuits,
    /// The phase of each route, and what it still holds of its path and of its overlap.
    pub routes: Vec<(Phase, Circuits, Circuits)>,
    /// The segments where the neighbour may send.
    pub toward: Segments,
    /// The segments where this station sends.
    pub away: Segments,
}

/// A device of any size.
pub trait Device: Send + Sync {
    /// One cycle.
    fn step(&mut self, input: Input<Large>, heard: Heard) -> Reply;
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
pub struct Held<const R: usize, const P: usize, const N: usize, const S: usize, Z: Wide = Small> {
    layout: Arc<Layout<R, P, N, S, Z>>,
    circuits: usize,
    memory: Memory<R, S, Z>,
}

impl<const R: usize, const P: usize, const N: usize, const S: usize, Z: Wide> Held<R, P, N, S, Z> {
    /// The device of a station with so many circuits, just started.
    pub const fn new(layout: Arc<Layout<R, P, N, S, Z>>, circuits: usize) -> Self {
        Self { layout, circuits, memory: Memory::INITIAL }
    }
}

impl<const R: usize, const P: usize, const N: usize, const S: usize, Z: Wide> Device for Held<R, P, N, S, Z> {
    fn step(&mut self, input: Input<Large>, _: Heard) -> Reply {
        let (memory, commands) = Combined(&self.layout).step(self.memory, narrow(input));
        self.memory = memory;
        let output = commands.interlocking;
        Reply {
            proceed: Z::wide_routes(output.proceed),
            drives: wide_positions(output.drives),
            permits: Z::wide_segments(output.permits),
            answer: output.answer,
            telegrams: told(self.circuits, &commands.telegrams),
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
pub struct Speaking<const R: usize, const P: usize, const N: usize, const S: usize, const B: usize, Z: Wide = Small> {
    layout: Arc<Layout<R, P, N, S, Z>>,
    circuits: usize,
    equipment: Equipment<B, Z>,
    state: Option<WaysideState<B, R, S, Z>>,
}

impl<const R: usize, const P: usize, const N: usize, const S: usize, const B: usize, Z: Wide>
    Speaking<R, P, N, S, B, Z>
{
    /// The device of a station with so many circuits, just started.
    ///
    /// # Errors
    /// The rule that the equipment breaks.
    pub fn new(
        layout: Arc<Layout<R, P, N, S, Z>>,
        circuits: usize,
        equipment: Equipment<B, Z>,
    ) -> Result<Self, WaysideError> {
        Wayside::new(&layout, &equipment)?;
        Ok(Self { layout, circuits, equipment, state: None })
    }
}

impl<const R: usize, const P: usize, const N: usize, const S: usize, const B: usize, Z: Wide> Device
    for Speaking<R, P, N, S, B, Z>
{
    fn step(&mut self, input: Input<Large>, heard: Heard) -> Reply {
        // It was checked when the device was made.
        let Ok(wayside) = Wayside::new(&self.layout, &self.equipment) else { return Reply::SAFE };
        let state = self.state.unwrap_or_else(|| wayside.initial());
        let mut messages = [None; S];
        for (message, told) in messages.iter_mut().zip(heard.messages) {
            *message = told;
        }
        let Input { occupied, detected, request, orders, .. } = narrow::<Z>(input);
        let [nothing, ..] = SILENT;
        let mut blocks = [nothing; B];
        for (block, read) in blocks.iter_mut().zip(heard.blocks) {
            *block = read;
        }
        let taken = Z::narrow_circuits(heard.taken);
        let framed = Framed { main: taken, sub: taken };
        let input = WaysideInput { blocks, occupied, detected, request, orders, messages, framed };
        // The three parts of its step, so that a run can be judged by what the train of each circuit is told.
        let (mut state, reading) = wayside.read(state, input);
        let counted = reading.input.occupied.without(occupied);
        let (memory, commands) = Combined(&self.layout).step(state.device, reading.input);
        state.device = memory;
        let (state, output) = wayside.send(state, &reading, &commands);
        self.state = Some(state);
        let mut agree = [false; MAX_BLOCKS];
        for (agree, block) in agree.iter_mut().zip(output.line.iter().flat_map(|line| &line.blocks)) {
            *agree = block.agree;
        }
        Reply {
            proceed: Z::wide_routes(output.proceed),
            drives: wide_positions(output.drives),
            permits: Z::wide_segments(commands.interlocking.permits),
            answer: output.answer,
            telegrams: told(self.circuits, &commands.telegrams),
            transmissions: output.transmissions.iter().copied().take(self.circuits).collect(),
            messages: output.messages.to_vec(),
            counted: Z::wide_circuits(counted),
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

/// The telegrams of the circuits that there are.
fn told<Z: Wide>(circuits: usize, telegrams: &PerCircuit<Option<Movement<Z>>, Z>) -> Vec<Option<Movement<Large>>> {
    telegrams.iter().take(circuits).map(|telegram| telegram.map(wide_movement)).collect()
}

/// What a device with this memory shows.
fn viewed<const R: usize, const P: usize, const N: usize, const S: usize, Z: Wide>(
    layout: &Layout<R, P, N, S, Z>,
    memory: &Memory<R, S, Z>,
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
        .map(|(route, state)| (state.phase, state.path(route).circuits, state.overlap(route).circuits))
        .map(|(phase, path, overlap)| (phase, Z::wide_circuits(path), Z::wide_circuits(overlap)));
    let (toward, away) = (state.directions.toward, state.directions.away);
    View {
        occupied: Z::wide_circuits(occupied),
        blocked: Z::wide_circuits(state.works.blocked),
        routes: routes.collect(),
        toward: Z::wide_segments(toward),
        away: Z::wide_segments(away),
    }
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
    pub telegrams: Vec<Option<Movement<Large>>>,
    /// What the transmitters send now.
    pub air: Vec<Option<Transmission>>,
    /// The transmitters that have taken the frames of the last cycle.
    taken: Circuits,
    /// What the device said last.
    pub reply: Reply,
    consents: Vec<Consent>,
    inbox: VecDeque<Message>,
    unblocked: bool,
    /// Since when blocks of the counted line disagree.
    pub disagreeing: Disagreeing,
}

impl Station {
    /// A station whose device has just started, with so many circuits and segments.
    pub fn new(device: Box<dyn Device>, circuits: usize, segments: usize) -> Self {
        Self {
            device,
            telegrams: vec![None; circuits],
            air: vec![None; circuits],
            taken: Circuits::EMPTY,
            reply: Reply::SAFE,
            consents: vec![Consent::default(); segments],
            inbox: VecDeque::new(),
            unblocked: false,
            disagreeing: [None; MAX_BLOCKS],
        }
    }

    /// The transmitters, but for those in `stuck`, take the frames for both directions of travel, and send them in turn.
    pub fn take(&mut self, stuck: Circuits) {
        for (number, air) in self.air.iter_mut().enumerate() {
            let it = Circuits::nth(number);
            if !stuck.meets(it) {
                *air = self.reply.transmissions.get(number).copied().flatten();
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
        (occupied, detected, blocks): (Circuits, Positions<Large>, Detections),
        request: Option<Request>,
        stuck: Circuits,
    ) {
        for (number, told) in self.telegrams.iter_mut().enumerate() {
            if !stuck.meets(Circuits::nth(number)) {
                *told = self.reply.telegrams.get(number).copied().flatten();
            }
        }
        let mut heard = Heard { messages: vec![None; self.consents.len()], taken: self.taken, blocks };
        self.taken = Circuits::EMPTY;
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
        let mut consent = Segments::EMPTY;
        for (number, last) in self.consents.iter().enumerate() {
            consent = consent.or(Segments::nth(number).only_if(last.given && now_ms - last.received_ms <= life_ms));
        }
        let mut orders = Orders::default();
        if !self.unblocked {
            orders.unblock = Circuits::ALL;
            orders.lift = Circuits::ALL;
            self.unblocked = true;
        }
        self.reply = self.device.step(Input { occupied, detected, request, orders, consent }, heard);
    }

    /// The code that a train hears whose front is in the circuit of this number and faces so; and what it is told.
    pub fn code(&self, number: usize, faces: Option<Heading>) -> (Option<u8>, Option<Movement<Large>>) {
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
    drives: Positions<Large>,
    (cycle_ms, late_ms): (u32, &dyn Fn(usize) -> u32),
    began: &mut dyn FnMut(usize),
) -> Positions<Large> {
    let mut detected = Positions::NONE;
    for (number, global) in track.sites[site].points.iter().enumerate() {
        let it = Points::nth(number);
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
