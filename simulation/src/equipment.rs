//! The devices of the stations: the kernel's machines for each layout, with what else a whole device has.

use std::sync::Arc;

use atc_kernel::aspect::AspectId;
use atc_kernel::block::{Block, Direction, Hold, MAX_SECTIONS, hold_for};
use atc_kernel::distance::Metres;
use atc_kernel::interlocking::{CircuitId, Large, Layout, MAX_CODES, PerCircuit, SegmentId, Small, Travel};
use atc_kernel::telegram::{Gradient, SectionId};
use atc_kernel::time::{Cycle, Millis, Ticks};
use atc_kernel::wayside::{Equipment, Facing, Fixed, Join, Session, SignalPlan};
use atc_layout::{Compiled, Description, Extent, with_room};

use crate::bound::Bound;
use crate::counted::Counted;
use crate::defect::Defect;
use crate::ground::{Device, Held, Speaking};
use crate::line::Line;
use crate::onboard::words;
use crate::sizes::Wide;

/// The longest that a passing train keeps a check-in on. A train that stands there is a fault.
const PASS_MS: u32 = 10_000;
impl Line {
    /// The device of a station, of the smallest size that holds its layout, with what is wrong in it.
    ///
    /// # Errors
    /// What the kernel says of the layout; it was checked when it was compiled.
    pub fn device(&self, station: usize, telegrams: bool, defects: &[Defect]) -> Result<Box<dyn Device>, String> {
        let counted = self.counted_at(station);
        // Devices with messages understand each other only.
        let equipment = if telegrams || !self.counted.is_empty() { Some(self.equipment(station)?) } else { None };
        let made = (&self.stations[station].description, defects, equipment.as_ref());
        let large = Extent::of(&made.0.station).is_large();
        if let Some(counted) = counted {
            return match counted.blocks.len() {
                // Each of these devices is compiled for itself.
                _ if large => {
                    Err("a counted line ends at a small station here: this one has more than 64 circuits or routes"
                        .to_owned())
                }
                1 => sized::<24, 12, 12, 4, 1, Small>(made, Some(counted.join(self, station)?)),
                _ => sized::<24, 12, 12, 4, 2, Small>(made, Some(counted.join(self, station)?)),
            };
        }
        if large {
            return with_room(|| sized::<256, 32, 128, 32, 0, Large>(made, None))?;
        }
        let few = sized::<8, 4, 2, 2, 0, Small>(made, None).or_else(|_| sized::<24, 4, 10, 2, 0, Small>(made, None));
        few.or_else(|_| sized::<64, 16, 32, 8, 0, Small>(made, None))
    }

    /// What a station's device has besides its layout, where trains run on telegrams. A circuit has one number in all stations.
    fn equipment(&self, station: usize) -> Result<Equipment<0, Large>, String> {
        let words = words(&self.speeds_kmh)?;
        let highest = u8::try_from(words.aspects.speeds().len() - 1).ok().and_then(AspectId::new);
        let curve = highest.ok_or("more speeds than ranks")?;
        let facing = |section: usize| {
            let section = u16::try_from(section).map_err(|_| "more circuits than section numbers".to_owned())?;
            Ok::<_, String>(Facing { section: SectionId(section), gradient: Gradient(0), curve })
        };
        let mut circuits = PerCircuit::NONE;
        for (place, circuit) in circuits.iter_mut().zip(&self.track.sites[station].circuits) {
            *place = Some(Fixed { left: facing(2 * circuit + 1)?, right: facing(2 * circuit)? });
        }
        let mut speeds = [None; MAX_CODES];
        for (place, speed) in speeds.iter_mut().zip(words.aspects.speeds()) {
            *place = Some(*speed);
        }
        let signals = SignalPlan { circuits, speeds, aspects: words.aspects, codes: words.codes };
        let life = u16::try_from(self.consent_life_ms() / self.cycle_ms).map_or(Ticks(1), Ticks);
        Ok(Equipment { counted: None, signals, life, session: Session(0) })
    }
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
}

/// A layout, what is wrong in it, and what a whole device has besides.
type Made<'a> = (&'a Description, &'a [Defect], Option<&'a Equipment<0, Large>>);

fn sized<const R: usize, const P: usize, const N: usize, const S: usize, const B: usize, Z: Wide>(
    (description, defects, equipment): Made<'_>,
    counted: Option<Join<B>>,
) -> Result<Box<dyn Device>, String> {
    let compiled: Compiled<R, P, N, S, Z> = description.compile_to().map_err(|errors| errors.to_string())?;
    let mut plan = compiled.plan;
    let layout = if defects.iter().filter(|defect| defect.spoil(&mut plan)).count() > 0 {
        Layout::with_what_proofs_need(*plan)
    } else {
        Layout::new(*plan)
    };
    let layout = layout.map_err(|broken| compiled.names.broken(broken, &plan))?;
    let (layout, circuits) = (Arc::new(layout), compiled.names.circuits.len());
    let Some(equipment) = equipment else { return Ok(Box::new(Held::new(layout, circuits))) };
    let Equipment { signals, life, session, .. } = *equipment;
    let SignalPlan { circuits: fixed, speeds, aspects, codes } = signals;
    let signals = SignalPlan { circuits: PerCircuit::from_fn(|number| fixed[number]), speeds, aspects, codes };
    let speaking = Speaking::new(layout, circuits, Equipment { counted, signals, life, session });
    Ok(Box::new(speaking.map_err(|broken| format!("{}: {broken:?}", compiled.names.station))?))
}
