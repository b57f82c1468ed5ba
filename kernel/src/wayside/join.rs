//! The joint between a counted line and the circuits of the station.
//!
//! On each section of the line is one circuit of a segment, or of its throat. What counting reports occupied is told to the interlocking
//! as occupied circuits, also where it is occupied by disagreement alone: that is false occupancy, under which the interlocking
//! is proven.

use super::WaysideError;
use crate::Machine;
use crate::block::{
    Beyond, Block, Detection, Direction, Hold, Line, LineInput, LineOutput, LineState, MAX_LINE_SECTIONS, MAX_SECTIONS,
};
use crate::distance::Metres;
use crate::interlocking::{CircuitId, CircuitSet, Layout, Refusal, Request, SegmentId, SegmentSet, Travel};

/// The most sections of a block.
const SECTIONS: usize = MAX_SECTIONS as usize;

/// A counted line as a plan gives it: its blocks from the low end, and which circuits are on them. Not checked.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Join<const B: usize> {
    /// The blocks, from the low end. The lengths of their sections are those of the circuits.
    pub blocks: [Block; B],
    /// The direction of travel along the blocks.
    pub direction: Direction,
    /// The length of the longest train: its nose to the last point that must be protected.
    pub train: Metres,
    /// The segment that is counted.
    pub segment: SegmentId,
    /// The direction of travel that the segment has, for ever.
    pub travel: Travel,
    /// The circuit on each section of each block, from the low end.
    pub circuits: [[Option<CircuitId>; SECTIONS]; B],
}

/// A section of a counted line: block and section are numbered from 0 at the low end.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Spot {
    /// The block.
    pub block: u8,
    /// The section of the block.
    pub section: u8,
}

/// A counted line, checked against the layout.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Counted<const B: usize> {
    line: Line<B>,
    segment: SegmentId,
    travel: Travel,
    /// The circuit on each section; none beyond the sections of a block.
    sections: [[CircuitSet; SECTIONS]; B],
    /// The circuits before the entry, the nearest first; where tracks join, there are several in one place.
    before: [CircuitSet; SECTIONS],
    /// The circuits that adjoin the exit.
    beyond: CircuitSet,
}

impl<const B: usize> Counted<B> {
    /// Checks `join` against `layout`.
    ///
    /// # Errors
    /// The first rule of WAY-11 to WAY-15 that is broken.
    #[inline]
    pub fn new<const R: usize, const P: usize, const N: usize, const S: usize>(
        layout: &Layout<R, P, N, S>,
        join: &Join<B>,
    ) -> Result<Self, WaysideError> {
        let chain = Chain { layout, segment: join.segment, travel: join.travel };
        if !chain.exists() {
            return Err(WaysideError::NoSuchSegment);
        }
        //= spec/wayside.md#way-15-no-route-against-the-line
        //# The constructor MUST reject a layout with a route that needs the counted segment in the other direction of travel.
        for (number, route) in (0_u8..).zip(&layout.plan().routes) {
            let against = match join.travel {
                Travel::Toward => route.to,
                Travel::Away => route.from,
            };
            if route.exists() && against.has(join.segment) {
                return Err(WaysideError::RouteAgainstTheLine(number));
            }
        }
        let walk = walk(&chain, join)?;
        let lengths = walk.lengths.get(..walk.count).unwrap_or(&walk.lengths);
        let line = Line::new(join.blocks, lengths, join.train, join.direction).map_err(WaysideError::Line)?;
        let (entry, exit) = match join.direction {
            Direction::Up => (walk.first, walk.last),
            Direction::Down => (walk.last, walk.first),
        };
        //= spec/wayside.md#way-13-the-exit
        //# The constructor MUST reject a counted line beyond whose exit the layout has no circuit.
        let beyond = chain.beyond(exit);
        if beyond.is_empty() {
            return Err(WaysideError::NothingBeyondTheExit);
        }
        let before = chain.before(entry);
        if chain.is_short(&before, &walk, join) {
            return Err(WaysideError::HoldTooShortAtTheEntry);
        }
        let Join { segment, travel, .. } = *join;
        Ok(Self { line, segment, travel, sections: walk.sections, before, beyond })
    }

    /// A joint as it is given, for proofs: nothing of it is checked.
    pub const fn from_parts(
        line: Line<B>,
        (segment, travel): (SegmentId, Travel),
        sections: [[CircuitSet; SECTIONS]; B],
        (before, beyond): ([CircuitSet; SECTIONS], CircuitSet),
    ) -> Self {
        Self { line, segment, travel, sections, before, beyond }
    }

    /// The line.
    pub const fn line(&self) -> &Line<B> {
        &self.line
    }

    /// The segment that is counted, and the direction of travel that it has.
    pub const fn segment(&self) -> (SegmentId, Travel) {
        (self.segment, self.travel)
    }

    /// The circuit on each section of each block, from the low end; none beyond the sections of a block.
    pub const fn sections(&self) -> &[[CircuitSet; SECTIONS]; B] {
        &self.sections
    }

    /// The circuits before the entry that are held for trains whose heads are on the line, the nearest first.
    pub const fn before(&self) -> &[CircuitSet; SECTIONS] {
        &self.before
    }

    /// The circuits that adjoin the exit: while one is reported, the last sections are held.
    pub const fn beyond(&self) -> CircuitSet {
        self.beyond
    }

    /// How many sections are held behind every head.
    fn hold(&self) -> Hold {
        self.line.blocks().first().map_or(Hold::MOST, |block| block.hold())
    }

    /// One cycle: what is counted, and what is told to the interlocking as occupied. `reported` are the circuits that are reported.
    #[inline]
    #[must_use]
    pub fn count(
        &self,
        state: LineState<B>,
        blocks: [Detection; B],
        reported: CircuitSet,
    ) -> (LineState<B>, LineOutput<B>, CircuitSet) {
        //= spec/wayside.md#way-2-the-exit
        //# While a circuit beyond the exit of the counted line is reported occupied, the line's hold MUST be asked of its last sections.
        let hold = if reported.meets(self.beyond) { self.hold() } else { Hold::NONE };
        // Beyond the exit the circuits report the train, so that it is let go at once.
        let (state, output) = self.line.step(state, LineInput { blocks, beyond: Beyond { hold, entered: true } });
        //= spec/wayside.md#way-1-occupancy
        //# The interlocking MUST be told as occupied every circuit that is reported so, the circuit of every section that the counted line reports, and before the line's entry the circuits of as many places as it asks to hold.
        let mut occupied = reported;
        for (report, circuits) in output.blocks.iter().zip(&self.sections) {
            for (section, circuit) in (0_u8..).zip(circuits) {
                occupied = occupied.or(circuit.only_if(report.occupied.contains(section)));
            }
        }
        for (place, circuits) in (0_u8..).zip(&self.before) {
            occupied = occupied.or(circuits.only_if(place < output.before_hold.sections()));
        }
        (state, output, occupied)
    }

    /// The request that is told to the interlocking.
    ///
    /// # Errors
    /// [`Refusal::Direction`] if it would turn the line.
    #[inline]
    pub fn admit(&self, request: Option<Request>) -> Result<Option<Request>, Refusal> {
        //= spec/wayside.md#way-10-a-counted-line-is-not-turned
        //# A request to turn the segment of a counted line against its direction of travel MUST be refused.
        match request {
            Some(Request::Turn(segment, travel)) if segment == self.segment && travel != self.travel => {
                Err(Refusal::Direction)
            }
            other => Ok(other),
        }
    }

    /// Whether the segment has no direction but that of the line.
    #[inline]
    #[must_use]
    pub fn is_kept(&self, toward: SegmentSet, away: SegmentSet) -> bool {
        match self.travel {
            Travel::Toward => !away.has(self.segment),
            Travel::Away => !toward.has(self.segment),
        }
    }
}

/// What is found on the way along the sections, from the low end.
struct Walk<const B: usize> {
    sections: [[CircuitSet; SECTIONS]; B],
    lengths: [Metres; MAX_LINE_SECTIONS],
    count: usize,
    /// The places of the first and the last section in the chain.
    first: usize,
    last: usize,
}

/// Finds the circuit of every section.
#[inline]
fn walk<const B: usize, const R: usize, const P: usize, const N: usize, const S: usize>(
    chain: &Chain<'_, R, P, N, S>,
    join: &Join<B>,
) -> Result<Walk<B>, WaysideError> {
    // Up is outwards if trains run away.
    let rising = (join.direction == Direction::Up) == (join.travel == Travel::Away);
    let mut walk = Walk {
        sections: [[CircuitSet::EMPTY; SECTIONS]; B],
        lengths: [Metres(0); MAX_LINE_SECTIONS],
        count: 0,
        first: 0,
        last: 0,
    };
    for (number, ((block, circuits), kept)) in
        (0_u8..).zip(join.blocks.iter().zip(&join.circuits).zip(&mut walk.sections))
    {
        for (section, (circuit, kept)) in (0_u8..).zip(circuits.iter().zip(kept)) {
            let spot = Spot { block: number, section };
            //= spec/wayside.md#way-11-a-circuit-on-every-section
            //# The constructor MUST reject a counted line with a section without a circuit, or with a circuit for a section that it does not have.
            let circuit = match (circuit, section < block.sections()) {
                (Some(circuit), true) => circuit.alone(),
                (None, false) => continue,
                (Some(_), false) => return Err(WaysideError::CircuitWithoutSection(spot)),
                (None, true) => return Err(WaysideError::SectionWithoutCircuit(spot)),
            };
            //= spec/wayside.md#way-12-the-order-of-the-circuits
            //# The constructor MUST reject a counted line whose sections are not on circuits of its segment, or of the segment and its throat, that follow each other in the layout as the sections do along the line.
            let Some(place) = chain.place(circuit) else { return Err(WaysideError::SectionElsewhere(spot)) };
            let follows = if rising { place == walk.last.wrapping_add(1) } else { place.wrapping_add(1) == walk.last };
            if walk.count > 0 && !follows {
                return Err(WaysideError::SectionsOutOfOrder(spot));
            }
            if walk.count == 0 {
                walk.first = place;
            }
            walk.last = place;
            *kept = circuit;
            if let Some(length) = walk.lengths.get_mut(walk.count) {
                *length = chain.shortest(circuit);
            }
            walk.count = walk.count.saturating_add(1);
        }
    }
    Ok(walk)
}

/// The throat of a segment (place 0) and its circuits (from place 1 on), as the layout has them.
struct Chain<'a, const R: usize, const P: usize, const N: usize, const S: usize> {
    layout: &'a Layout<R, P, N, S>,
    segment: SegmentId,
    travel: Travel,
}

impl<const R: usize, const P: usize, const N: usize, const S: usize> Chain<'_, R, P, N, S> {
    fn exists(&self) -> bool {
        let segment = self.layout.plan().segments.get(usize::from(self.segment.number()));
        segment.is_some_and(|segment| segment.length > 0)
    }

    /// The circuit at a place; none where there is none.
    #[inline]
    fn at(&self, place: usize) -> CircuitSet {
        let mut circuit = CircuitSet::EMPTY;
        for (number, segment) in self.layout.plan().segments.iter().enumerate() {
            if number == usize::from(self.segment.number()) {
                circuit = circuit.or(segment.throat.only_if(place == 0));
                for (back, it) in (1_usize..).zip(&segment.circuits) {
                    circuit = circuit.or(it.only_if(back == place && back <= usize::from(segment.length)));
                }
            }
        }
        circuit
    }

    /// The place of a circuit.
    #[inline]
    fn place(&self, circuit: CircuitSet) -> Option<usize> {
        let mut found = None;
        for place in 0..=P {
            if self.at(place) == circuit {
                found = Some(place);
            }
        }
        found
    }

    /// The length of a circuit; of several, the shortest.
    #[inline]
    fn shortest(&self, circuits: CircuitSet) -> Metres {
        let mut shortest = Metres(u16::MAX);
        for (number, length) in self.layout.plan().lengths.iter().enumerate() {
            if circuits.meets(CircuitSet::nth(number)) {
                shortest = shortest.min(*length);
            }
        }
        shortest
    }

    /// The circuits that adjoin the exit, which is the end of the circuit at `exit`.
    #[inline]
    fn beyond(&self, exit: usize) -> CircuitSet {
        match self.travel {
            Travel::Away => self.at(exit.wrapping_add(1)),
            Travel::Toward => {
                let mut beyond = if exit == 0 { CircuitSet::EMPTY } else { self.at(exit - 1) };
                // Also where the ways into the station do not begin in the throat.
                for route in &self.layout.plan().routes {
                    let begins = route.exists() && route.entry == self.at(exit);
                    beyond = beyond.or(route.circuit_at(0).only_if(begins));
                }
                beyond
            }
        }
    }

    /// The circuits before the entry, which is the beginning of the circuit at `entry`: of the segment, and behind its throat of the routes
    /// that lead out to it.
    #[inline]
    fn before(&self, entry: usize) -> [CircuitSet; SECTIONS] {
        let mut before = [CircuitSet::EMPTY; SECTIONS];
        for (back, circuits) in (1_usize..).zip(&mut before) {
            *circuits = match self.travel {
                Travel::Toward => self.at(entry.wrapping_add(back)),
                Travel::Away if back <= entry => self.at(entry - back),
                Travel::Away => self.behind_the_throat(back - entry),
            };
        }
        // Behind a place without a circuit nothing is known.
        let mut known = true;
        for circuits in &mut before {
            known &= !circuits.is_empty();
            *circuits = circuits.only_if(known);
        }
        before
    }

    /// The circuits that are so many places behind the throat on the routes out to the segment, their entries included.
    #[inline]
    fn behind_the_throat(&self, back: usize) -> CircuitSet {
        let mut circuits = CircuitSet::EMPTY;
        for route in &self.layout.plan().routes {
            let length = usize::from(route.length);
            if route.exists() && route.to.has(self.segment) {
                circuits = circuits.or(route.entry.only_if(length == back));
                for (place, element) in route.path.iter().enumerate() {
                    let there = place < length && place.wrapping_add(back).wrapping_add(1) == length;
                    circuits = circuits.or(element.circuits.only_if(there));
                }
            }
        }
        circuits
    }

    /// Whether somewhere at the entry the places that are held behind a head are together shorter than the longest train.
    #[inline]
    fn is_short<const B: usize>(&self, before: &[CircuitSet; SECTIONS], walk: &Walk<B>, join: &Join<B>) -> bool {
        //= spec/wayside.md#way-14-the-hold-at-the-entry
        //# The constructor MUST reject a counted line where k consecutive places, of sections and of the k circuits before the entry, are together shorter than the longest train.
        let hold = join.blocks.first().map_or(Hold::NONE, |block| block.hold());
        let k = usize::from(hold.sections());
        // The metres of the places before the entry, and of the sections from there on, added up.
        let (mut metres_before, mut metres_on) = ([0_u32; SECTIONS + 1], [0_u32; SECTIONS + 1]);
        let mut known = 0;
        for place in 0..SECTIONS {
            let circuits = before[place];
            let its = if circuits.is_empty() { 0 } else { u32::from(self.shortest(circuits).0) };
            metres_before[place + 1] = metres_before[place].saturating_add(its);
            known += usize::from(!circuits.is_empty());
            let from_low = match join.direction {
                Direction::Up => place,
                Direction::Down => walk.count.wrapping_sub(place + 1),
            };
            let on = if place < walk.count { walk.lengths.get(from_low).map_or(0, |length| length.0) } else { 0 };
            metres_on[place + 1] = metres_on[place].saturating_add(u32::from(on));
        }
        // A front that has just passed `passed` sections.
        let mut short = false;
        for (passed, on) in metres_on.iter().enumerate() {
            for (back, before) in metres_before.iter().enumerate() {
                let held = passed + back == k && passed <= walk.count && back <= known;
                short |= held && on.saturating_add(*before) < u32::from(join.train.0);
            }
        }
        short
    }
}
