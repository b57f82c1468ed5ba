//! Lines on which trains are counted: what their checks and detectors say of the trains as they are, and what staff do when a block disagrees.
//!
//! A head is heard in a section; at a border in both blocks from the check-in ahead to the check-out behind, so that it is never in neither (condition
//! `loops-overlap`). Both stations read the same checks and detectors, and each counts by itself.

use atc_kernel::block::{SectionSet, TrainCount};

use crate::bound::Bound;
use crate::counted::{Counted, Detections, Disagreeing, MAX_BLOCKS, SILENT};
use crate::fault::{Fault, Kind};
use crate::line::Line;
use crate::world::World;

/// A check-in is on from this far before the border, and a check-out until this far behind it, in m.
const CHECK_IN_M: (f64, f64) = (-3.0, 7.0);
const CHECK_OUT_M: (f64, f64) = (4.0, 14.0);
/// After how long staff look at a block that disagrees. They reset it when no head is on its borders (condition `verified-reset`).
const STAFF_MS: u64 = 20_000;

impl Counted {
    /// How far heads are along the line, in m from the entry of its first section; negative before it.
    fn heads(&self, world: &World<'_>) -> Vec<(usize, f64)> {
        let line = world.line;
        let mut all = line.links[self.link].circuits.clone();
        if self.bound == Bound::West {
            all.reverse();
        }
        let length = |circuit: &usize| line.track.circuits[*circuit].length_m;
        let first = self.blocks[0][0];
        let before: f64 = all.iter().take_while(|circuit| **circuit != first).map(length).sum();
        let mut heads = Vec::new();
        for (number, train) in world.trains.iter().enumerate() {
            let here = line.track.pieces[train.body.front().piece].circuit;
            if let Some(place) = all.iter().position(|circuit| *circuit == here) {
                let behind: f64 = all[..place].iter().map(length).sum();
                heads.push((number, behind + train.body.front_m - before));
            }
        }
        heads
    }

    /// From where to where each block reaches, in m from the entry of the first.
    fn borders(&self, line: &Line) -> Vec<(f64, f64)> {
        let mut from = 0.0;
        let length =
            |block: &Vec<usize>| block.iter().map(|circuit| line.track.circuits[*circuit].length_m).sum::<f64>();
        let ends = self.blocks.iter().map(|block| {
            let to = from + length(block);
            (std::mem::replace(&mut from, to), to)
        });
        ends.collect()
    }
}

/// What the device of a station reads of its counted line, with the faults of this cycle; and what staff command. `agree` is what it said last.
pub fn read(world: &World<'_>, station: usize, agree: [bool; MAX_BLOCKS], since: &mut Disagreeing) -> Detections {
    let mut read = SILENT;
    let Some(counted) = world.line.counted_at(station) else { return read };
    let heads = counted.heads(world);
    let length = f64::from(world.line.cycle_ms);
    let missed = |train| world.faults(Kind::MissedHead, length).any(|fault| fault.which % world.trains.len() == train);
    let phantom = |circuit| {
        world.faults(Kind::PhantomHead, length).any(|fault| section_at(world.line, fault.which) == Some(circuit))
    };
    for (block, (from, to)) in counted.borders(world.line).into_iter().enumerate() {
        let within =
            |at: f64, (low, high): (f64, f64)| heads.iter().any(|(_, head)| (low..high).contains(&(head - at)));
        let of = |fault: &&Fault| block_at(world.line, fault.which).is_some_and(|it| it == &counted.blocks[block]);
        let failing = |kind| world.faults(kind, length).find(of);
        let here = &mut read[block];
        here.low_check =
            within(from, CHECK_IN_M) && failing(Kind::CheckInLost).is_none() || failing(Kind::CheckInStuckOn).is_some();
        here.high_check = within(to, CHECK_OUT_M) && failing(Kind::CheckOutLost).is_none()
            || failing(Kind::SpuriousCheckOut).is_some();
        let mut begins = from;
        for (section, circuit) in (0_u8..).zip(&counted.blocks[block]) {
            let ends = begins + world.line.track.circuits[*circuit].length_m;
            // The outermost reach over the borders.
            let low = if section == 0 { begins + CHECK_IN_M.0 } else { begins };
            let high =
                if usize::from(section) + 1 == counted.blocks[block].len() { ends + CHECK_OUT_M.0 } else { ends };
            let heard = heads.iter().any(|(train, head)| (low..high).contains(head) && !missed(*train));
            if heard || phantom(*circuit) {
                here.present = here.present.or(SectionSet::from_bits(1 << section));
            }
            begins = ends;
        }
        since[block] = if agree[block] { None } else { since[block].or(Some(world.now_ms)) };
        let on_a_border = [from, to].into_iter().any(|border| within(border, (CHECK_IN_M.0, CHECK_OUT_M.1)));
        if since[block].is_some_and(|since| world.now_ms - since >= STAFF_MS) && !on_a_border {
            let inside = heads.iter().filter(|(_, head)| (from..to).contains(head)).count();
            let told = failing(Kind::WrongReset).map_or(inside, |fault| usize::try_from(fault.much).unwrap_or(inside));
            here.reset = Some(TrainCount(u8::try_from(told).unwrap_or(u8::MAX)));
            since[block] = Some(world.now_ms);
        }
    }
    read
}

/// Whether a circuit is the section of a counted line: it has nothing of its own that reports a train.
pub fn is_counted(line: &Line, circuit: usize) -> bool {
    line.counted.iter().any(|counted| counted.blocks.iter().any(|block| block.contains(&circuit)))
}

/// The circuit of a counted section, counted on over all of them.
fn section_at(line: &Line, which: usize) -> Option<usize> {
    let all = || line.counted.iter().flat_map(|counted| counted.blocks.iter().flatten().copied());
    all().nth(which % all().count().max(1))
}

/// A block, counted on over all of them.
fn block_at(line: &Line, which: usize) -> Option<&Vec<usize>> {
    let all = || line.counted.iter().flat_map(|counted| &counted.blocks);
    all().nth(which % all().count().max(1))
}

/// What that section is called.
pub fn section(line: &Line, which: usize) -> String {
    section_at(line, which).map_or_else(String::new, |circuit| line.track.circuits[circuit].name.clone())
}

/// What that block is called: by its first and last section.
pub fn block(line: &Line, which: usize) -> String {
    let name = |circuit: Option<&usize>| circuit.map_or("", |circuit| line.track.circuits[*circuit].name.as_str());
    block_at(line, which).map_or_else(String::new, |block| format!("{} to {}", name(block.first()), name(block.last())))
}
