//! The two stations at the ends of a counted line: their layouts, and how the line is joined to each.
//!
//! ```text
//! platform ──▷ throat ═══ section ═══ … ═══ section ──▷ throat ─── platform
//!        0          1           2                        beyond     the end
//! ```
//!
//! Circuits have the numbers of their places, in both layouts. The sender has its platform, its throat, the sections and the circuit beyond the
//! exit; the receiver the sections, its throat and its platform. Of the line the neighbour sees what a layout calls shared.

use crate::interlocking::between::{Lives, Times};
use atc_kernel::Machine;
use atc_kernel::block::{Block, Detection, Direction, Hold, Line, LineState, SectionSet, TrainCount};
use atc_kernel::distance::Metres;
use atc_kernel::interlocking::{
    self as kernel, CircuitId, CircuitSet, Element, Heading, Input, Layout, Orders, Plan, Positions, Request, Route,
    RouteId, Segment, SegmentId, SegmentSet, SpeedCode, Travel,
};
use atc_kernel::time::Ticks;
use atc_kernel::wayside::{Counted, Join};

/// The most circuits of a segment.
pub const PLACES: usize = 5;
/// A layout of this size: one route, no point, one segment.
pub type Small = Layout<1, PLACES, 0, 1>;
/// What an interlocking of this size remembers.
pub type Kernel = kernel::State<1, 1>;

/// The sender's platform.
pub const PLATFORM: u8 = 0;
/// The sender's throat.
pub const THROAT: u8 = 1;
/// The first section.
pub const FIRST: u8 = 2;

/// The segment, to each station.
pub fn the_line() -> SegmentSet {
    SegmentSet::nth(0)
}

/// The set of circuits of a mask.
pub const fn circuits(mask: u8) -> CircuitSet {
    CircuitSet::from_bits(mask as u64)
}

/// One station.
#[derive(Clone, Debug)]
pub struct End<const B: usize> {
    /// Its layout.
    pub layout: Small,
    /// The joint with the line.
    pub counted: Counted<B>,
    /// The direction of travel that the line has.
    pub travel: Travel,
}

/// What a device remembers. The number of its cycle is left out.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Device<const B: usize> {
    /// The counted line.
    pub line: LineState<B>,
    /// The interlocking.
    pub interlocking: Kernel,
    /// Every block has agreed with its detectors since the start, all at once.
    pub verified: bool,
}

/// What a device reads in one cycle.
#[derive(Clone, Copy, Debug)]
pub struct Read<const B: usize> {
    /// The blocks.
    pub blocks: [Detection; B],
    /// The circuits that are reported by themselves.
    pub reported: CircuitSet,
    /// One request.
    pub request: Option<Request>,
    /// What staff command.
    pub orders: Orders,
    /// Whether the neighbour's permission is read.
    pub consent: bool,
}

impl<const B: usize> Read<B> {
    /// Nothing is there, and nothing is commanded.
    pub fn quiet() -> Self {
        let nothing = Detection { low_check: false, high_check: false, present: SectionSet::EMPTY, reset: None };
        Self {
            blocks: [nothing; B],
            reported: CircuitSet::EMPTY,
            request: None,
            orders: Orders::default(),
            consent: false,
        }
    }
}

/// The route of either station.
pub fn route() -> RouteId {
    RouteId::ZERO
}

/// Turns the line to the direction that it has at this end.
pub fn turn(travel: Travel) -> Request {
    Request::Turn(SegmentId::ZERO, travel)
}

/// What staff command after a start.
pub fn start_orders() -> Orders {
    Orders { unblock: CircuitSet::ALL, lift: CircuitSet::ALL, ..Orders::default() }
}

fn plan(lives: Lives, unheard: u8) -> Plan<1, PLACES, 0, 1> {
    let times = Times::right(lives, unheard);
    let mut plan = Plan::EMPTY;
    plan.lengths[..8].fill(Metres(100));
    plan.braking[0] = Metres(0);
    plan.braking[1] = Metres(50);
    plan.braking[2] = Metres(150);
    (plan.clear, plan.turn, plan.start) = (times.clear, times.turn, times.start);
    (plan.residual, plan.loss) = (Ticks(u16::from(lives.residual)), unheard);
    plan
}

fn route_over(entry: u8, path: &[u8], beyond: u8, plan: &Plan<1, PLACES, 0, 1>) -> Route<PLACES> {
    let mut route = Route {
        entry: circuits(1 << entry),
        approach: circuits(1 << entry),
        length: u8::try_from(path.len()).expect("a short path"),
        beyond: circuits(1 << beyond),
        drive: Ticks(3),
        release: Ticks(plan.residual.0 + u16::from(plan.loss)),
        stay: Ticks(u16::from(plan.loss) + 1),
        speed: SpeedCode(2),
        overlap_speed: SpeedCode(2),
        heading: Heading::Right,
        ..Route::NONE
    };
    for (place, circuit) in route.path.iter_mut().zip(path) {
        *place = Element { circuits: circuits(1 << circuit), ..Element::NONE };
    }
    route
}

/// Both stations, with `B` blocks of `sections` sections each between them.
///
/// # Panics
/// If the kernel rejects them; a test builds every model.
pub fn ends<const B: usize>(sections: u8, trains: u8, lives: Lives, unheard: u8) -> [End<B>; 2] {
    let all = sections * u8::try_from(B).expect("few blocks");
    let (last, beyond) = (FIRST + all - 1, FIRST + all);
    let hold = Hold::new(1).expect("a hold");
    let block = Block::new(sections, trains.min(sections), hold, Ticks(1)).expect("a block");
    let mut on = [[None; 16]; B];
    let places = on.iter_mut().flat_map(|block| block.iter_mut().take(sections.into()));
    for (circuit, number) in places.zip(FIRST..) {
        *circuit = CircuitId::new(number);
    }
    let join = |travel| Join {
        blocks: [block; B],
        direction: Direction::Up,
        train: Metres(100),
        segment: SegmentId::ZERO,
        travel,
        circuits: on,
    };
    let segment = |from_the_station: Vec<u8>, throat: u8, outward| {
        let length = u8::try_from(from_the_station.len()).expect("a short segment");
        // The neighbour sees all of it.
        let mut segment = Segment { length, throat: circuits(1 << throat), outward, shared: length, ..Segment::NONE };
        for (place, circuit) in segment.circuits.iter_mut().zip(from_the_station) {
            *place = circuits(1 << circuit);
        }
        segment
    };
    let end = |plan, travel| {
        let layout = Small::new(plan).expect("a layout that keeps every rule");
        let counted = Counted::new(&layout, &join(travel)).expect("a line that can be joined");
        End { layout, counted, travel }
    };
    let mut sender = plan(lives, unheard);
    sender.routes[0] = Route { to: the_line(), ..route_over(PLATFORM, &[THROAT], FIRST, &sender) };
    sender.segments[0] = segment((FIRST..=beyond).collect(), THROAT, Heading::Right);
    let mut receiver = plan(lives, unheard);
    receiver.routes[0] = Route { from: the_line(), ..route_over(last, &[beyond, beyond + 1], beyond, &receiver) };
    receiver.segments[0] = segment((FIRST..=last).rev().collect(), beyond, Heading::Left);
    [end(sender, Travel::Away), end(receiver, Travel::Toward)]
}

/// What an interlocking read, and what became of it.
#[derive(Clone, Copy, Debug)]
pub struct Made<const B: usize> {
    /// The device.
    pub device: Device<B>,
    /// What the interlocking was told.
    pub told: Input,
    /// The route shows proceed.
    pub proceed: bool,
    /// The neighbour may send.
    pub permits: bool,
    /// The places whose telegram grants the next place: a mask.
    pub granted: u8,
    /// Which blocks agree with their detectors.
    pub agree: [bool; B],
}

/// How a device is put together: right, or in a way that is wrong.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Wiring {
    /// As the kernel does it.
    Right,
    /// What is reported beyond the exit is not told to the counting: the joint holds nothing.
    HoldsNothing,
    /// The circuits of the line are not told to the interlocking while the count is not in force.
    OnlyWhileCounting,
    /// A device that has started permits at once, whatever is counted.
    PermitsUnverified,
    /// A permission that was read once counts for ever.
    BelievesForEver,
}

impl<const B: usize> End<B> {
    /// A device that has just got power.
    pub fn initial(&self) -> Device<B> {
        Device { line: LineState::INITIAL, interlocking: self.layout.initial(), verified: false }
    }

    /// Whether the device can be in this state.
    pub fn is_valid(&self, device: &Device<B>) -> bool {
        let directions = device.interlocking.directions;
        device.line.is_valid(self.counted.line())
            && device.interlocking.is_valid(&self.layout)
            && self.counted.is_kept(directions.toward, directions.away)
    }

    /// One cycle.
    pub fn step(&self, before: Device<B>, read: Read<B>, wiring: Wiring) -> Made<B> {
        let heard =
            if wiring == Wiring::HoldsNothing { read.reported.without(self.counted.beyond()) } else { read.reported };
        let (line, report, mut occupied) = self.counted.count(before.line, read.blocks, heard);
        occupied = occupied.or(read.reported);
        let agree = report.blocks.map(|block| block.agree);
        if wiring == Wiring::OnlyWhileCounting && agree != [true; B] {
            occupied = read.reported;
        }
        let request = self.counted.admit(read.request, &report).unwrap_or(None);
        let consent = if read.consent { the_line() } else { SegmentSet::EMPTY };
        let told = Input { occupied, detected: Positions::NONE, request, orders: read.orders, consent };
        let (mut state, output) = self.layout.cycle(before.interlocking, told);
        let telegrams = self.layout.telegrams(&output.table, state.epoch);
        state.epoch = kernel::Epoch(1);
        let mut granted = 0;
        for (place, telegram) in (0_u8..8).zip(&telegrams) {
            let next = circuits(1_u8.checked_shl(u32::from(place) + 1).unwrap_or(0));
            let goes_on = telegram.is_some_and(|it| it.heading == Some(Heading::Right) && it.hold.meets(next));
            granted |= u8::from(goes_on) << place;
        }
        let verified = before.verified || agree == [true; B];
        let permits = match (wiring, self.travel) {
            (Wiring::PermitsUnverified, Travel::Toward) => true,
            _ => output.permits.meets(the_line()),
        };
        Made {
            device: Device { line, interlocking: state, verified },
            told,
            proceed: !output.proceed.is_empty(),
            permits,
            granted,
            agree,
        }
    }

    /// What the device reads before the model begins: staff verify that the line is empty, and it is turned.
    pub fn prelude(&self) -> Vec<Read<B>> {
        let plan = self.layout.plan();
        let mut first = Read::quiet();
        first.orders = start_orders();
        first.blocks.iter_mut().for_each(|block| block.reset = Some(TrainCount(0)));
        let waits = usize::from(plan.start.0.max(plan.turn.0)) + usize::from(plan.clear);
        let turned = Read { request: Some(turn(self.travel)), consent: true, ..Read::quiet() };
        std::iter::once(first).chain(std::iter::repeat_n(Read::quiet(), waits)).chain([turned]).collect()
    }

    /// The most trains of a block.
    pub fn most(&self) -> u8 {
        self.line().blocks()[0].max_trains().0
    }

    /// The line.
    pub const fn line(&self) -> &Line<B> {
        self.counted.line()
    }
}
