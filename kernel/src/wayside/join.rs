//! The joint between a counted line and the circuits of the station.
//!
//! On each section of the line is one circuit of a segment, or of its throat. What counting reports occupied is told to the interlocking
//! as occupied circuits, also where it is occupied by disagreement alone: that is false occupancy, under which the interlocking
//! is proven.

use super::WaysideError;
use super::chain::{Chain, Place, SECTIONS};
use crate::Machine;
use crate::block::{
    Beyond, Block, Detection, Direction, Hold, Line, LineInput, LineOutput, LineState, MAX_LINE_SECTIONS,
};
use crate::distance::Metres;
use crate::interlocking::short;
use crate::interlocking::{
    CircuitId, CircuitSet, Layout, Refusal, Request, SegmentId, SegmentSet, Size, Small, Travel,
};

/// A counted line as a plan gives it: its blocks from the low end, and which circuits are on them. Not checked. `K` is the most sections of a
/// block, and the most places of a hold: smaller only in proofs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Join<const B: usize, const K: usize = SECTIONS> {
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
    pub circuits: [[Option<CircuitId>; K]; B],
}

/// A section of a counted line: block and section are numbered from 0 at the low end.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Spot {
    /// The block.
    pub block: u8,
    /// The section of the block.
    pub section: u8,
}

/// A counted line, checked against the layout. `K` as in [`Join`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Counted<const B: usize, const K: usize = SECTIONS, Z: Size = Small> {
    line: Line<B>,
    segment: SegmentId,
    travel: Travel,
    /// The circuit on each section; none beyond the sections of a block.
    sections: [[CircuitSet<Z>; K]; B],
    /// The circuits before the entry, the nearest first; where tracks join, there are several in one place.
    before: [CircuitSet<Z>; K],
    /// The circuits that adjoin the exit.
    beyond: CircuitSet<Z>,
}

impl<const B: usize, const K: usize, Z: Size> Counted<B, K, Z> {
    /// Checks `join` against `layout`.
    ///
    /// # Errors
    /// The first rule of WAY-11 to WAY-15 and WAY-25 that is broken.
    #[inline]
    pub fn new<const R: usize, const P: usize, const N: usize, const S: usize>(
        layout: &Layout<R, P, N, S, Z>,
        join: &Join<B, K>,
    ) -> Result<Self, WaysideError> {
        let Some(chain) = Chain::of(layout, join.segment) else { return Err(WaysideError::NoSuchSegment) };
        //= spec/wayside.md#way-15-no-route-against-the-line
        //# The constructor MUST reject a layout with a route that needs the counted segment in the other direction of travel.
        for (number, route) in layout.plan().routes.iter().enumerate() {
            let number = short(number);
            let against = match join.travel {
                Travel::Toward => route.to,
                Travel::Away => route.from,
            };
            if route.exists() && against.has(join.segment) {
                return Err(WaysideError::RouteAgainstTheLine(number));
            }
        }
        let counted = Self::on(&chain, join)?;
        let mut sections = CircuitSet::EMPTY;
        for circuit in counted.sections.iter().flatten() {
            sections = sections.or(*circuit);
        }
        //= spec/wayside.md#way-25-no-train-of-another-line
        //# The constructor MUST reject a layout with a route over a circuit of the counted line, or with one in its overlap, that does not need the counted segment.
        for (number, route) in layout.plan().routes.iter().enumerate() {
            let number = short(number);
            let along = match join.travel {
                Travel::Toward => route.from,
                Travel::Away => route.to,
            };
            let over = route.held_from(0).circuits.or(route.overlap.circuits);
            if route.exists() && !along.has(join.segment) && over.meets(sections) {
                return Err(WaysideError::RouteOfAnotherLine(number));
            }
        }
        Ok(counted)
    }

    /// The same on the track of the segment, without WAY-15 and WAY-25.
    ///
    /// # Errors
    /// The first rule of WAY-11 to WAY-14 that is broken.
    #[inline]
    pub fn on<const R: usize, const P: usize>(
        chain: &Chain<R, P, K, Z>,
        join: &Join<B, K>,
    ) -> Result<Self, WaysideError> {
        let walk = walk(chain, join)?;
        let lengths = walk.lengths.get(..walk.count).unwrap_or(&walk.lengths);
        let line = Line::new(join.blocks, lengths, join.train, join.direction).map_err(WaysideError::Line)?;
        let (entry, exit) = match join.direction {
            Direction::Up => (walk.first, walk.last),
            Direction::Down => (walk.last, walk.first),
        };
        //= spec/wayside.md#way-13-the-exit
        //# The constructor MUST reject a counted line beyond whose exit the layout has no circuit.
        let beyond = chain.beyond(join.travel, exit);
        if beyond.is_empty() {
            return Err(WaysideError::NothingBeyondTheExit);
        }
        let before = chain.before(join.travel, entry);
        if is_short(&before, &walk, join) {
            return Err(WaysideError::HoldTooShortAtTheEntry);
        }
        let Join { segment, travel, .. } = *join;
        Ok(Self { line, segment, travel, sections: walk.sections, before: before.map(|place| place.circuits), beyond })
    }

    /// A joint as it is given, for proofs: nothing of it is checked.
    pub const fn from_parts(
        line: Line<B>,
        (segment, travel): (SegmentId, Travel),
        sections: [[CircuitSet<Z>; K]; B],
        (before, beyond): ([CircuitSet<Z>; K], CircuitSet<Z>),
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
    pub const fn sections(&self) -> &[[CircuitSet<Z>; K]; B] {
        &self.sections
    }

    /// The circuits before the entry that are held for trains whose heads are on the line, the nearest first.
    pub const fn before(&self) -> &[CircuitSet<Z>; K] {
        &self.before
    }

    /// The circuits that adjoin the exit: while one is reported, the last sections are held.
    pub const fn beyond(&self) -> CircuitSet<Z> {
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
        reported: CircuitSet<Z>,
    ) -> (LineState<B>, LineOutput<B>, CircuitSet<Z>) {
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

    /// The request that is told to the interlocking, in a cycle in which the line reports this.
    ///
    /// # Errors
    /// [`Refusal::Direction`] if it would turn the line against its direction, or give it its own towards the station while a block disagrees.
    #[inline]
    pub fn admit(&self, request: Option<Request>, report: &LineOutput<B>) -> Result<Option<Request>, Refusal> {
        let mut agree = true;
        for block in &report.blocks {
            agree &= block.agree;
        }
        //= spec/wayside.md#way-10-a-counted-line-is-not-turned
        //# A request to turn the segment of a counted line against its direction of travel MUST be refused.
        match request {
            Some(Request::Turn(segment, travel)) if segment == self.segment && travel != self.travel => {
                Err(Refusal::Direction)
            }
            //= spec/wayside.md#way-26-a-block-that-disagrees
            //# A request to turn the segment of a counted line towards the station MUST be refused while one of its blocks disagrees.
            Some(Request::Turn(segment, Travel::Toward)) if segment == self.segment && !agree => {
                Err(Refusal::Direction)
            }
            other => Ok(other),
        }
    }

    /// Whether the segment has no direction but that of the line.
    #[inline]
    #[must_use]
    pub fn is_kept(&self, toward: SegmentSet<Z>, away: SegmentSet<Z>) -> bool {
        match self.travel {
            Travel::Toward => !away.has(self.segment),
            Travel::Away => !toward.has(self.segment),
        }
    }
}

/// What is found on the way along the sections, from the low end.
struct Walk<const B: usize, const K: usize, Z: Size> {
    sections: [[CircuitSet<Z>; K]; B],
    lengths: [Metres; MAX_LINE_SECTIONS],
    count: usize,
    /// The places of the first and the last section in the chain.
    first: usize,
    last: usize,
}

/// Finds the circuit of every section.
#[inline]
fn walk<const B: usize, const R: usize, const P: usize, const K: usize, Z: Size>(
    chain: &Chain<R, P, K, Z>,
    join: &Join<B, K>,
) -> Result<Walk<B, K, Z>, WaysideError> {
    let mut walk = Walk {
        sections: [[CircuitSet::EMPTY; K]; B],
        lengths: [Metres(0); MAX_LINE_SECTIONS],
        count: 0,
        first: 0,
        last: 0,
    };
    // The first error is kept, and the loop goes on: one way through it is what a prover unrolls.
    let mut wrong = None;
    for block in 0..B {
        for section in 0..K {
            let spot = Spot { block: block.to_le_bytes()[0], section: section.to_le_bytes()[0] };
            wrong = wrong.or(walk.go_on(chain, join, spot, join.circuits[block][section]).err());
            let there = spot.section < join.blocks[block].sections();
            walk.sections[block][section] = join.circuits[block][section].map_or(CircuitSet::EMPTY, CircuitId::alone);
            walk.count = walk.count.saturating_add(usize::from(there));
        }
    }
    wrong.map_or(Ok(walk), Err)
}

impl<const B: usize, const K: usize, Z: Size> Walk<B, K, Z> {
    /// To the next section.
    #[inline]
    fn go_on<const R: usize, const P: usize>(
        &mut self,
        chain: &Chain<R, P, K, Z>,
        join: &Join<B, K>,
        spot: Spot,
        circuit: Option<CircuitId>,
    ) -> Result<(), WaysideError> {
        let sections = join.blocks.get(usize::from(spot.block)).map_or(0, |block| block.sections());
        //= spec/wayside.md#way-11-a-circuit-on-every-section
        //# The constructor MUST reject a counted line with a section without a circuit, or with a circuit for a section that it does not have.
        let circuit = match (circuit, spot.section < sections) {
            (Some(circuit), true) => circuit.alone(),
            (None, false) => return Ok(()),
            (Some(_), false) => return Err(WaysideError::CircuitWithoutSection(spot)),
            (None, true) => return Err(WaysideError::SectionWithoutCircuit(spot)),
        };
        // Up is outwards if trains run away.
        let rising = (join.direction == Direction::Up) == (join.travel == Travel::Away);
        //= spec/wayside.md#way-12-the-order-of-the-circuits
        //# The constructor MUST reject a counted line whose sections are not on circuits of its segment, or of the segment and its throat, that follow each other in the layout as the sections do along the line.
        let Some(place) = chain.place(circuit) else { return Err(WaysideError::SectionElsewhere(spot)) };
        let follows = if rising { place == self.last.wrapping_add(1) } else { place.wrapping_add(1) == self.last };
        if self.count > 0 && !follows {
            return Err(WaysideError::SectionsOutOfOrder(spot));
        }
        if self.count == 0 {
            self.first = place;
        }
        self.last = place;
        if let Some(length) = self.lengths.get_mut(self.count) {
            *length = chain.at(place).length;
        }
        Ok(())
    }
}

/// Whether somewhere at the entry the places that are held behind a head are together shorter than the longest train.
#[inline]
fn is_short<const B: usize, const K: usize, Z: Size>(
    before: &[Place<Z>; K],
    walk: &Walk<B, K, Z>,
    join: &Join<B, K>,
) -> bool {
    //= spec/wayside.md#way-14-the-hold-at-the-entry
    //# The constructor MUST reject a counted line where k consecutive places, of sections and of the k circuits before the entry, are together shorter than the longest train.
    let hold = join.blocks.first().map_or(Hold::NONE, |block| block.hold());
    let k = usize::from(hold.sections());
    let mut short = false;
    // Behind a front that has just passed `passed` sections.
    for passed in 0..=K {
        let (mut metres, mut known) = (0_u32, passed <= walk.count && passed <= k);
        for (place, behind) in before.iter().enumerate() {
            if place < passed {
                let from_low = match join.direction {
                    Direction::Up => place,
                    Direction::Down => walk.count.wrapping_sub(place + 1),
                };
                let length = walk.lengths.get(from_low).map_or(0, |length| length.0);
                metres = metres.saturating_add(u32::from(length));
            }
            if passed.saturating_add(place) < k {
                known &= !behind.circuits.is_empty();
                metres = metres.saturating_add(u32::from(behind.length.0));
            }
        }
        short |= known && metres < u32::from(join.train.0);
    }
    short
}
