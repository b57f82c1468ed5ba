//! Lines on which trains are counted: what their checks and detectors say of the trains as they are, and what staff do when a block disagrees.
//!
//! A head is heard in a section; at a border in both blocks from the check-in ahead to the check-out behind, so that it is never in neither (condition
//! `loops-overlap`). Both stations read the same checks and detectors, and each counts by itself.

use atc_kernel::block::{Block, Detection, Direction, Hold, MAX_SECTIONS, SectionSet, TrainCount, hold_for};
use atc_kernel::distance::Metres;
use atc_kernel::interlocking::{CircuitId, SegmentId, Travel};
use atc_kernel::time::{Cycle, Millis, Ticks};
use atc_kernel::wayside::Join;
use serde::{Deserialize, Serialize};

use crate::fault::{Fault, Kind};
use crate::line::{Bound, Line};
use crate::world::World;

/// The most blocks of a counted line here.
pub const MAX_BLOCKS: usize = 2;
/// A check-in is on from this far before the border, and a check-out until this far behind it, in m.
const CHECK_IN_M: (f64, f64) = (-3.0, 7.0);
const CHECK_OUT_M: (f64, f64) = (4.0, 14.0);
/// The longest that a passing train keeps a check-in on. A train that stands there is a fault.
const PASS_MS: u32 = 10_000;
/// After how long staff look at a block that disagrees. They reset it when no head is on its borders (condition `verified-reset`).
const STAFF_MS: u64 = 20_000;

/// A counted line as a line file has it.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CountedFile {
    /// The name that both stations give the line.
    pub line: String,
    /// The circuits of each block, one a section, in the direction of travel: one or two blocks.
    pub blocks: Vec<Vec<String>>,
}

/// A counted line.
#[derive(Clone, Debug)]
pub struct Counted {
    /// Which of the lines.
    pub link: usize,
    /// The direction of its trains.
    pub bound: Bound,
    /// The circuits of each block, in the direction of travel.
    pub blocks: Vec<Vec<usize>>,
}

/// What one station's device reads of its counted line in a cycle.
pub type Detections = [Detection; MAX_BLOCKS];

/// Nothing is heard.
pub const SILENT: Detections =
    [Detection { low_check: false, high_check: false, present: SectionSet::EMPTY, reset: None }; MAX_BLOCKS];

/// The counted lines that end at a station.
fn ending(line: &Line, station: usize) -> impl Iterator<Item = &Counted> {
    line.counted.iter().filter(move |counted| [0, 1].contains(&station.wrapping_sub(line.links[counted.link].west)))
}

/// The counted line of a station's device: it can have one.
pub fn at(line: &Line, station: usize) -> Option<&Counted> {
    ending(line, station).next()
}

/// The counted line that a file names.
///
/// # Errors
/// What is wrong with it.
pub fn of(line: &Line, file: &CountedFile) -> Result<Counted, String> {
    let wrong = |what: String| format!("[[counted]] {}: {what}", file.line);
    let called = |link: usize| {
        let joined = &line.links[link];
        line.stations[joined.west].compiled.model.segments[joined.segments[0]].line.as_deref() == Some(&file.line)
    };
    let link =
        (0..line.links.len()).find(|link| called(*link)).ok_or_else(|| wrong("no line has this name".to_owned()))?;
    let bound = match line.ways[link] {
        [true, false] => Bound::West,
        [false, true] => Bound::East,
        _ => return Err(wrong("trains run on it in both directions; a counted line has one".to_owned())),
    };
    if !(1..=MAX_BLOCKS).contains(&file.blocks.len()) {
        return Err(wrong(format!("{} blocks: 1 or {MAX_BLOCKS} are possible", file.blocks.len())));
    }
    let circuit = |name: &String| {
        let named = |circuit: &&usize| line.track.circuits[**circuit].name == *name;
        let found = line.links[link].circuits.iter().find(named).copied();
        found.ok_or_else(|| wrong(format!("{name} is none of its circuits")))
    };
    let block = |names: &Vec<String>| {
        if !(1..=usize::from(MAX_SECTIONS)).contains(&names.len()) {
            return Err(wrong(format!("a block of {} sections: 1 to {MAX_SECTIONS} are possible", names.len())));
        }
        names.iter().map(circuit).collect::<Result<Vec<_>, _>>()
    };
    let blocks = file.blocks.iter().map(block).collect::<Result<Vec<_>, _>>()?;
    Ok(Counted { link, bound, blocks })
}

/// Checks that no station has two counted lines, and that the kernel takes each.
///
/// # Errors
/// What is wrong.
pub fn check(line: &Line) -> Result<(), String> {
    for station in 0..line.stations.len() {
        if ending(line, station).count() > 1 {
            return Err(format!("{}: two [[counted]] lines; a device counts one", line.stations[station].name));
        }
        if at(line, station).is_some() {
            line.device(station, true, &[])?;
        }
    }
    Ok(())
}

impl Counted {
    /// The line as the device of a station has it.
    ///
    /// # Errors
    /// What the kernel says of a block.
    pub fn join<const B: usize>(&self, line: &Line, station: usize) -> Result<Join<B>, String> {
        let link = &line.links[self.link];
        let here = station - link.west;
        let length = |circuit: &usize| line.track.circuits[*circuit].length_m;
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "metres of a layout fit in 16 bits")]
        let metres = |length: f64| Metres(length as u16);
        let lengths: Vec<Metres> = self.blocks.iter().flatten().map(|circuit| metres(length(circuit))).collect();
        let train = metres(line.dynamics.length_m.ceil());
        let hold = hold_for(&lengths, train).map_err(|error| format!("counted sections: {error:?}"))?;
        let hold = if hold == Hold::NONE { Hold::new(1).unwrap_or(Hold::MOST) } else { hold };
        let cycle = Cycle::new(Millis(line.cycle_ms)).ok_or("a cycle of 0 ms")?;
        let pass = cycle.at_most(Millis(PASS_MS)).unwrap_or(Ticks(1));
        let mut blocks = Vec::new();
        let mut circuits = [[None; MAX_SECTIONS as usize]; B];
        for (block, places) in self.blocks.iter().zip(&mut circuits) {
            let sections = u8::try_from(block.len()).unwrap_or(u8::MAX);
            blocks
                .push(Block::new(sections, sections, hold, pass).map_err(|error| format!("counted block: {error:?}"))?);
            for (circuit, place) in block.iter().zip(places) {
                let local = line.track.sites[station].circuits.iter().position(|own| own == circuit);
                let local = local.ok_or_else(|| {
                    let (name, at) = (&line.track.circuits[*circuit].name, &line.stations[station].name);
                    format!("{name} is counted, and {at} does not see it: both stations see every counted circuit")
                })?;
                *place = u8::try_from(local).ok().and_then(CircuitId::new);
            }
        }
        let blocks = <[Block; B]>::try_from(blocks).map_err(|blocks| format!("{} blocks", blocks.len()))?;
        let segment = u8::try_from(link.segments[here]).ok().and_then(SegmentId::new).ok_or("too many segments")?;
        // Trains to the east run away from the western station.
        let travel = if (here == 0) == (self.bound == Bound::East) { Travel::Away } else { Travel::Toward };
        Ok(Join { blocks, direction: Direction::Up, train, segment, travel, circuits })
    }

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

/// Since when a block disagrees at a station, in ms.
pub type Disagreeing = [Option<u64>; MAX_BLOCKS];

/// What the device of a station reads of its counted line, with the faults of this cycle; and what staff command. `agree` is what it said last.
pub fn read(world: &World<'_>, station: usize, agree: [bool; MAX_BLOCKS], since: &mut Disagreeing) -> Detections {
    let mut read = SILENT;
    let Some(counted) = at(world.line, station) else { return read };
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
