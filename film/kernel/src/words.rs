//! Plans and inputs as words of 64 bits.

use atc_kernel::distance::Metres;
use atc_kernel::interlocking::{
    CircuitSet, Element, Heading, Input, Orders, Plan, PointId, PointSet, Position, Positions, Request, Route, RouteId,
    RouteSet, Segment, SegmentId, SegmentSet, SpeedCode, SpeedLimits, Travel,
};
use atc_kernel::time::Ticks;

/// A plan of the greatest size.
type Whole = Plan<64, 16, 32, 8>;

/// How many words an input has.
pub const INPUT: usize = 8;

/// Words, read one after the other; 0 where there are no more.
pub struct Reader<'a> {
    words: core::slice::Iter<'a, u64>,
}

impl<'a> Reader<'a> {
    /// From the first word on.
    pub fn new(words: &'a [u64]) -> Self {
        Self { words: words.iter() }
    }

    fn word(&mut self) -> u64 {
        self.words.next().copied().unwrap_or(0)
    }

    #[expect(clippy::cast_possible_truncation, reason = "what was written is no longer")]
    fn short(&mut self) -> u16 {
        self.word() as u16
    }

    #[expect(clippy::cast_possible_truncation, reason = "what was written is no longer")]
    fn byte(&mut self) -> u8 {
        self.word() as u8
    }

    fn circuits(&mut self) -> CircuitSet {
        CircuitSet::from_bits(self.word())
    }

    fn routes(&mut self) -> RouteSet {
        RouteSet::from_bits(self.word())
    }

    fn segments(&mut self) -> SegmentSet {
        SegmentSet::from_bits(self.byte())
    }

    fn positions(&mut self) -> Positions {
        positions_of(self.word())
    }

    fn heading(&mut self) -> Heading {
        if self.word() == 0 { Heading::Left } else { Heading::Right }
    }

    fn element(&mut self) -> Element {
        Element { circuits: self.circuits(), positions: self.positions(), beside: self.circuits() }
    }
}

/// Positions in one word: normal in the low half, reverse in the high one.
pub(crate) fn positions_word(positions: Positions) -> u64 {
    u64::from(positions.normal.bits()) | u64::from(positions.reverse.bits()) << 32
}

#[expect(clippy::cast_possible_truncation, reason = "the halves of a word")]
fn positions_of(word: u64) -> Positions {
    Positions { normal: PointSet::from_bits(word as u32), reverse: PointSet::from_bits((word >> 32) as u32) }
}

fn heading_word(heading: Heading) -> u64 {
    u64::from(heading == Heading::Right)
}

/// A plan as words.
pub fn plan_words(plan: &Whole) -> Vec<u64> {
    let mut words: Vec<u64> = [plan.clear, plan.settle, plan.loss].map(u64::from).to_vec();
    words.extend([plan.turn, plan.start, plan.residual, plan.standstill].map(|ticks| u64::from(ticks.0)));
    words.extend(plan.braking.iter().map(|metres| u64::from(metres.0)));
    words.extend(plan.lengths.iter().map(|metres| u64::from(metres.0)));
    words.extend(plan.line.parts().map(CircuitSet::bits));
    words.extend(plan.points.iter().map(|point| point.detectors.bits()));
    for segment in &plan.segments {
        words.extend(segment.circuits.iter().map(|circuit| circuit.bits()));
        words.extend([u64::from(segment.length), segment.throat.bits()]);
        words.extend([heading_word(segment.outward), u64::from(segment.shared)]);
    }
    for route in &plan.routes {
        words.push(u64::from(route.length));
        // A plan has few of the routes that it could have.
        if route.exists() {
            route_words(&mut words, route);
        }
    }
    words
}

fn route_words(words: &mut Vec<u64>, route: &Route<16>) {
    let element =
        |element: &Element| [element.circuits.bits(), positions_word(element.positions), element.beside.bits()];
    words.extend([heading_word(route.heading), route.entry.bits(), route.approach.bits()]);
    words.extend(route.path.iter().flat_map(element));
    words.extend(element(&route.overlap));
    words.extend([route.beyond.bits(), route.continuing.bits(), route.conflicts.bits()]);
    words.extend([u64::from(route.from.bits()), u64::from(route.to.bits())]);
    words.extend([route.drive, route.release, route.stay].map(|ticks| u64::from(ticks.0)));
    words.extend([route.speed, route.overlap_speed].map(|code| u64::from(code.0)));
    words.extend([route.cab_signalled, route.calling_on].map(u64::from));
}

/// The plan of these words.
pub fn plan_of(words: &[u64]) -> Whole {
    let mut reader = Reader::new(words);
    let mut plan = Whole::EMPTY;
    plan.clear = reader.byte();
    plan.settle = reader.byte();
    plan.loss = reader.byte();
    plan.turn = Ticks(reader.short());
    plan.start = Ticks(reader.short());
    plan.residual = Ticks(reader.short());
    plan.standstill = Ticks(reader.short());
    for metres in &mut plan.braking {
        *metres = Metres(reader.short());
    }
    for metres in &mut plan.lengths {
        *metres = Metres(reader.short());
    }
    let mut line = SpeedLimits::NONE.parts();
    for circuits in &mut line {
        *circuits = reader.circuits();
    }
    plan.line = SpeedLimits::from_parts(line);
    for point in &mut plan.points {
        point.detectors = reader.circuits();
    }
    for segment in &mut plan.segments {
        *segment = Segment::NONE;
        for circuit in &mut segment.circuits {
            *circuit = reader.circuits();
        }
        segment.length = reader.byte();
        segment.throat = reader.circuits();
        segment.outward = reader.heading();
        segment.shared = reader.byte();
    }
    for route in &mut plan.routes {
        let length = reader.byte();
        if length > 0 {
            *route = route_of(&mut reader, length);
        }
    }
    plan
}

fn route_of(reader: &mut Reader<'_>, length: u8) -> Route<16> {
    let mut route = Route { length, heading: reader.heading(), ..Route::NONE };
    route.entry = reader.circuits();
    route.approach = reader.circuits();
    for element in &mut route.path {
        *element = reader.element();
    }
    route.overlap = reader.element();
    route.beyond = reader.circuits();
    route.continuing = reader.routes();
    route.conflicts = reader.routes();
    route.from = reader.segments();
    route.to = reader.segments();
    route.drive = Ticks(reader.short());
    route.release = Ticks(reader.short());
    route.stay = Ticks(reader.short());
    route.speed = SpeedCode(reader.byte());
    route.overlap_speed = SpeedCode(reader.byte());
    route.cab_signalled = reader.word() == 1;
    route.calling_on = reader.word() == 1;
    route
}

/// The input of a cycle as words: occupied, detected, request, block, unblock, restrict and its code, lift, consent.
pub fn input_words(input: &Input) -> [u64; INPUT] {
    let request = match input.request {
        None => 0,
        Some(Request::Set(route)) => 1 | u64::from(route.number()) << 8,
        Some(Request::Withdraw(route)) => 2 | u64::from(route.number()) << 8,
        Some(Request::Drive(point, to)) => {
            3 | u64::from(point.number()) << 8 | u64::from(to == Position::Reverse) << 16
        }
        Some(Request::Turn(segment, to)) => 4 | u64::from(segment.number()) << 8 | u64::from(to == Travel::Away) << 16,
    };
    let orders = &input.orders;
    let consent = u64::from(input.consent.bits()) | u64::from(orders.speed.0) << 8;
    let (occupied, detected) = (input.occupied.bits(), positions_word(input.detected));
    let works = [orders.block, orders.unblock, orders.restrict, orders.lift].map(CircuitSet::bits);
    let [block, unblock, restrict, lift] = works;
    [occupied, detected, request, block, unblock, restrict, lift, consent]
}

/// The input of these words.
pub fn input_of(words: &[u64]) -> Input {
    let mut reader = Reader::new(words);
    let (occupied, detected) = (reader.circuits(), reader.positions());
    let request = reader.word();
    let [kind, number, which, ..] = request.to_le_bytes();
    let request = match kind {
        1 => RouteId::new(number).map(Request::Set),
        2 => RouteId::new(number).map(Request::Withdraw),
        3 => PointId::new(number)
            .map(|point| Request::Drive(point, if which == 1 { Position::Reverse } else { Position::Normal })),
        4 => SegmentId::new(number)
            .map(|segment| Request::Turn(segment, if which == 1 { Travel::Away } else { Travel::Toward })),
        _ => None,
    };
    let [block, unblock, restrict, lift] = [reader.circuits(), reader.circuits(), reader.circuits(), reader.circuits()];
    let [consent, speed, ..] = reader.word().to_le_bytes();
    let orders = Orders { block, unblock, restrict, speed: SpeedCode(speed), lift };
    Input { occupied, detected, request, orders, consent: SegmentSet::from_bits(consent) }
}
