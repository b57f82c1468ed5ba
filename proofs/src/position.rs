//! The train's position: theorems T-POS-1 to T-POS-5.

mod bounds;
mod inclusion;
mod interval;
mod odometer;
mod unknown;

use crate::{Engine, Harness};
use atc_kernel::position::{Correction, KNOTS, Millibels, Position, Spacing, Table};

pub use bounds::{pos_part, pos_part_rounds};
pub use inclusion::t_pos_2;
pub use interval::{t_pos_1, t_pos_1_exact, t_pos_1_levels, t_pos_1_span, t_pos_1_step};
pub use odometer::t_pos_3;
pub use unknown::{pos_machine, t_pos_4, t_pos_5};

/// The harnesses of this module.
#[cfg(not(chosen))]
pub const ALL: &[Harness] = &[
    t_pos_1::HARNESS,
    t_pos_1_exact::HARNESS,
    t_pos_1_levels::HARNESS,
    t_pos_1_span::HARNESS,
    t_pos_1_step::HARNESS,
    pos_part::HARNESS,
    pos_part_rounds::HARNESS,
    t_pos_2::HARNESS,
    t_pos_3::HARNESS,
    t_pos_4::HARNESS,
    t_pos_5::HARNESS,
    pos_machine::HARNESS,
];

/// A word as a signed number.
pub(crate) fn signed(word: u16) -> i16 {
    i16::from_le_bytes(word.to_le_bytes())
}

/// The curves of a table.
#[derive(Clone, Copy)]
struct Curves {
    lowest: [i16; KNOTS],
    highest: [i16; KNOTS],
}

/// Arbitrary curves, of these bits.
fn any_curves<E: Engine + ?Sized>(e: &mut E, bits: u16) -> Curves {
    // A curve that is likely to rise all the way.
    let (steps, slack) = if bits < 0x100 { (1, 0) } else { (10, 6) };
    let mut curves = Curves { lowest: [0; KNOTS], highest: [0; KNOTS] };
    for knot in 0..KNOTS {
        let likely = steps * u16::try_from(knot).unwrap_or(0);
        curves.lowest[knot] = signed(e.word("lowest difference (mB)", likely..=likely + slack) & bits);
        curves.highest[knot] = signed(e.word("highest difference (mB)", likely + slack..=likely + 2 * slack) & bits);
    }
    curves
}

/// The table of these curves, if the constructor accepts them.
fn table<E: Engine + ?Sized>(e: &mut E, curves: Curves, spacing: Spacing) -> Option<Table> {
    let table = Table::new(spacing, curves.lowest.map(Millibels), curves.highest.map(Millibels)).ok();
    e.assume(table.is_some());
    table
}

/// A device with one table: straight lines, 1 mB for a decimetre, so that levels give any interval of whole decimetres.
pub(crate) fn straight<E: Engine + ?Sized>(e: &mut E) -> Option<Position> {
    let tolerance = signed(e.word("tolerance (mB)", 0..=8));
    let position = straight_within(Millibels(tolerance));
    e.assume(position.is_some());
    position
}

/// The same with this tolerance.
pub(crate) fn straight_within(tolerance: Millibels) -> Option<Position> {
    let lowest = [0, 16, 32, 48, 64, 80, 96, 112, 128, 144, 160, 176, 192, 208, 224, 240, 256];
    let highest = lowest.map(|level| Millibels(level + 8));
    let table = Table::new(Spacing::new(4)?, lowest.map(Millibels), highest).ok()?;
    Position::new(table, tolerance, Millibels(i16::MIN), Correction::NONE)
}
