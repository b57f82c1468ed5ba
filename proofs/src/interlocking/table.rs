//! The shared table (T-ATC-3): read only fresh and whole.

use super::any::any_circuits;
use crate::Engine;
use crate::engine::{any_byte, any_flag, any_u32};
use atc_kernel::Machine;
use atc_kernel::interlocking::{
    CircuitId, CircuitSet, Combined, Contents, Epoch, Grant, Layout, MAX_CODES, Movement, PerCircuit, Plan, SegmentSet,
    SpeedCode, SpeedLimits, Standing, Table,
};
use atc_kernel::time::Ticks;

/// The routes of the table.
const GRANTS: usize = 2;

/// Any set of all 64 circuits.
fn any_set<E: Engine + ?Sized>(e: &mut E, what: &'static str) -> CircuitSet {
    let high = any_circuits(e, what, 0..=1).bits();
    CircuitSet::from_bits(high << 32 | any_circuits(e, what, 0..=1).bits())
}

/// Any grant, whether a route may make it or not.
fn any_grant<E: Engine + ?Sized>(e: &mut E) -> Grant {
    Grant {
        train: any_set(e, "granted to (bits)"),
        circuits: any_set(e, "granted (bits)"),
        last: any_set(e, "last (bits)"),
        complete: any_flag(e, "complete (odd: yes)"),
        heading: super::any::any_heading(e, "heading (odd: right)"),
        speed: SpeedCode(e.word("speed code", 0..=7).to_le_bytes()[0]),
    }
}

/// Any contents, whether the interlocking may write them or not.
fn any_contents<E: Engine + ?Sized, const R: usize>(e: &mut E) -> Contents<R> {
    Contents {
        occupied: any_set(e, "occupied (bits)"),
        blocked: any_set(e, "blocked (bits)"),
        grants: core::array::from_fn(|_| any_grant(e)),
        toward: SegmentSet::from_bits(e.word("toward (bits)", 0..=1).to_le_bytes()[0]),
        away: SegmentSet::from_bits(e.word("away (bits)", 0..=1).to_le_bytes()[0]),
        standing: Standing {
            bodies: core::array::from_fn(|_| any_set(e, "one train (bits)")),
            loose: any_set(e, "any train (bits)"),
            limits: SpeedLimits::from_parts(core::array::from_fn(|_| any_set(e, "limited to a code (bits)"))),
        },
    }
}

fn flipped(set: CircuitSet, bit: u16) -> CircuitSet {
    CircuitSet::from_bits(set.bits() ^ 1 << (bit & 63))
}

fn flipped_segment(set: SegmentSet, bit: u16) -> SegmentSet {
    SegmentSet::from_bits(set.bits() ^ 1 << (bit & 7))
}

fn flipped_code(code: SpeedCode, bit: u16) -> SpeedCode {
    SpeedCode(code.0 ^ 1 << (bit & 7))
}

/// The fields of a grant.
const OF_A_GRANT: usize = 6;

/// The first case that is where trains stand: the bodies and the loose circuits.
const STANDING: usize = 6 + GRANTS * OF_A_GRANT;

/// The first case that is the limits of a code.
const LIMITS: usize = STANDING + GRANTS + 1;

/// The fields of a table: epoch, check, occupied, blocked, toward, away, those of each grant, where trains stand, the limits of each code.
const FIELDS: usize = LIMITS + MAX_CODES;

harness! {
    /// A table is read as it was written in the cycle in which it was written; an older one is refused, and so is one with a wrong bit,
    /// wherever the bit is and in whatever cycle it is read.
    t_atc_3(e)
    theorem "T-ATC-3";
    requirements ["ATC-5"];
    assumptions [];
    bound "2 routes";
    cases FIELDS;
    unwind 65 = 1 + crate::interlocking::LONGEST;
    claims {
        Fresh: "a table that was written in this cycle is read as written",
        Stale: "a table that was written in a cycle of another number is refused",
        Damaged: "a table with one wrong bit is refused in every cycle",
        Unreadable: "the table of the safe output is refused in every cycle",
    }
    covers {
        Looks: "the wrong bit makes the epoch that of the cycle",
        High: "the highest bit of its field is wrong",
    }
    {
        let epoch = Epoch(any_u32(e, "epoch", 0..=3));
        let other = Epoch(any_u32(e, "epoch of another cycle", 0..=3));
        let field = e.choose("field with the wrong bit", FIELDS);
        let bit = e.word("wrong bit of the field (number)", 0..=63);
        let contents: Contents<GRANTS> = any_contents(e);
        let table = Table::write(epoch, contents);
        e.claim(Claim::Fresh as u32, table.read(epoch) == Some(contents));
        e.claim(Claim::Stale as u32, epoch == other || table.read(other).is_none());
        let (_, check, _) = table.parts();
        let (mut wrong_epoch, mut wrong_check, mut wrong) = (epoch, check, contents);
        match field {
            0 => wrong_epoch.0 ^= 1 << (bit & 31),
            1 => wrong_check ^= 1 << (bit & 63),
            2 => wrong.occupied = flipped(wrong.occupied, bit),
            3 => wrong.blocked = flipped(wrong.blocked, bit),
            4 => wrong.toward = flipped_segment(wrong.toward, bit),
            5 => wrong.away = flipped_segment(wrong.away, bit),
            LIMITS.. => {
                let mut limits = wrong.standing.limits.parts();
                for (code, limited) in limits.iter_mut().enumerate() {
                    *limited = if code == field - LIMITS { flipped(*limited, bit) } else { *limited };
                }
                wrong.standing.limits = SpeedLimits::from_parts(limits);
            }
            STANDING.. => {
                let standing = &mut wrong.standing;
                for (number, set) in standing.bodies.iter_mut().chain([&mut standing.loose]).enumerate() {
                    *set = if number == field - STANDING { flipped(*set, bit) } else { *set };
                }
            }
            _ => {
                for (number, grant) in wrong.grants.iter_mut().enumerate() {
                    if number == (field - 6) / OF_A_GRANT {
                        match (field - 6) % OF_A_GRANT {
                            0 => grant.train = flipped(grant.train, bit),
                            1 => grant.circuits = flipped(grant.circuits, bit),
                            2 => grant.last = flipped(grant.last, bit),
                            3 => grant.complete = !grant.complete,
                            4 => grant.heading = grant.heading.opposite(),
                            _ => grant.speed = flipped_code(grant.speed, bit),
                        }
                    }
                }
            }
        }
        let damaged = Table::from_parts(wrong_epoch, wrong_check, wrong);
        e.claim(Claim::Damaged as u32, damaged.read(other).is_none());
        e.claim(Claim::Unreadable as u32, Table::<GRANTS>::UNREADABLE.read(other).is_none());
        e.cover(Cover::Looks as u32, field != 0 || wrong_epoch == other);
        e.cover(Cover::High as u32, bit & 63 == 63);
    }
}

/// A layout, contents of a table, a cycle, and a circuit that stands for all.
struct Scene {
    layout: Layout<1, 1, 0, 1>,
    contents: Contents<1>,
    now: Epoch,
    circuit: CircuitId,
}

fn any_scene<E: Engine + ?Sized>(e: &mut E) -> Option<Scene> {
    let circuit = CircuitId::new(any_byte(e, "a circuit that stands for all (number)", 0..=7) & 63);
    let layout = Layout::with_what_proofs_need(Plan { clear: 1, turn: Ticks(1), ..Plan::EMPTY });
    let contents = any_contents(e);
    let now = Epoch(any_u32(e, "this cycle (epoch)", 0..=1));
    e.assume(circuit.is_some() && layout.is_ok());
    Some(Scene { layout: layout.ok()?, contents, now, circuit: circuit? })
}

impl Scene {
    /// Whether the circuit's telegram tells a train to stay where it is.
    #[inline]
    fn stops(&self, table: &Table<1>) -> bool {
        self.told(&self.layout.telegrams(table, self.now)).0
    }

    /// Whether the circuit's telegram tells a train to stay where it is, and whether it lets one go.
    #[inline]
    fn told(&self, telegrams: &PerCircuit<Option<Movement>>) -> (bool, bool) {
        let (mut stop, mut open) = (true, false);
        for (place, it) in (0_u8..).zip(telegrams) {
            let (stays, goes) = match it {
                Some(it) => {
                    let own = it.stop == self.circuit && it.speed == SpeedCode(0);
                    (own && !it.is_open() && it.hold.bits() == 0, it.is_open())
                }
                None => (false, false),
            };
            stop &= place != self.circuit.number() || stays;
            open |= place == self.circuit.number() && goes;
        }
        (stop, open)
    }

    /// Whether the contents say that a train in the circuit is granted something.
    #[inline]
    fn grants(&self) -> bool {
        let (number, grant) = (self.circuit.number(), self.contents.grants[0]);
        let train = self.contents.occupied.bits() >> number & 1 == 1;
        train && grant.train.bits() == 1_u64 << number && grant.circuits.bits() != 0
    }
}

harness! {
    /// Where the table is of another cycle, every circuit gets a telegram that tells a train to stay where it is.
    t_atc_3_stale(e)
    theorem "T-ATC-3";
    requirements ["ATC-6"];
    assumptions [];
    bound "1 route, no segment";
    cases 1;
    unwind 65 = 1 + crate::interlocking::LONGEST;
    claims {
        Stop: "the telegram's stop circuit is its own, its speed is stop, it is not open and holds nothing",
    }
    covers {
        Train: "the table says that a train in the circuit is granted something",
    }
    {
        let Some(scene) = any_scene(e) else { return };
        let written = Epoch(any_u32(e, "epoch", 0..=1));
        if written == scene.now {
            return e.assume(false);
        }
        let table = Table::write(written, scene.contents);
        e.claim(Claim::Stop as u32, scene.stops(&table));
        e.cover(Cover::Train as u32, scene.grants());
    }
}

harness! {
    /// Where the check of the table is wrong, every circuit gets a telegram that tells a train to stay where it is.
    t_atc_3_damaged(e)
    theorem "T-ATC-3";
    requirements ["ATC-6"];
    assumptions [];
    bound "1 route, no segment";
    cases 1;
    unwind 65 = 1 + crate::interlocking::LONGEST;
    claims {
        Stop: "the telegram's stop circuit is its own, its speed is stop, it is not open and holds nothing",
    }
    covers {
        Train: "the table says that a train in the circuit is granted something",
    }
    {
        let Some(scene) = any_scene(e) else { return };
        let damage = any_set(e, "difference of the check (bits)").bits();
        if damage == 0 {
            return e.assume(false);
        }
        let (_, right, _) = Table::write(scene.now, scene.contents).parts();
        let table = Table::from_parts(scene.now, right ^ damage, scene.contents);
        e.claim(Claim::Stop as u32, scene.stops(&table));
        e.cover(Cover::Train as u32, scene.grants());
    }
}

harness! {
    /// In the device as a whole the ATC reads the table by a count of its own. Where the table has another number, no train is told to go.
    t_atc_3_device(e)
    theorem "T-ATC-3";
    requirements ["ATC-14", "ATC-15"];
    assumptions [];
    bound "1 route, no segment";
    cases 1;
    unwind 65 = 1 + crate::interlocking::LONGEST;
    claims {
        Stop: "where the table's number is not the next one, the telegram stops its train where it is, and holds nothing",
        Count: "the count goes on by one in each cycle, whatever the table",
        Safe: "the safe output sends no telegram, and is that of the interlocking besides",
    }
    covers {
        Open: "the table has the next number, and its telegram lets a train go",
        Differ: "the table has another number, and says that a train in the circuit is granted something",
    }
    {
        let Some(scene) = any_scene(e) else { return };
        let written = Epoch(any_u32(e, "epoch", 0..=1));
        let table = Table::write(written, scene.contents);
        let (cycle, telegrams) = Combined(&scene.layout).speak(scene.now, &table);
        let same = written.0 == scene.now.0.wrapping_add(1);
        let (stops, opens) = scene.told(&telegrams);
        e.claim(Claim::Stop as u32, same || stops);
        e.claim(Claim::Count as u32, cycle.0 == scene.now.0.wrapping_add(1));
        let safe = <Combined<'_, 1, 1, 0, 1> as Machine>::SAFE;
        let mut none = safe.interlocking == Layout::<1, 1, 0, 1>::SAFE;
        for telegram in &safe.telegrams {
            none &= telegram.is_none();
        }
        e.claim(Claim::Safe as u32, none);
        e.cover(Cover::Open as u32, same && opens);
        e.cover(Cover::Differ as u32, !same && scene.grants());
    }
}
