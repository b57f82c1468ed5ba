//! Telegrams: theorems T-TEL-1 to T-TEL-6.

mod counter;
mod framing;

use crate::{Engine, Harness, any_byte, any_flag, any_u32};
use atc_kernel::aspect::AspectId;
use atc_kernel::distance::Metres;
use atc_kernel::telegram::{Counter, Frame, Gradient, Length, Main, Route, SectionId, Sub, Telegram};

pub(crate) use counter::{any_bits_of_stream, any_sequence};
pub use counter::{t_tel_6, t_tel_6_repeated, t_tel_8, tel_7, tel_sequence, tel_total};
pub use framing::{
    t_tel_1, t_tel_2, t_tel_3, t_tel_3_few, t_tel_3_linear, t_tel_3_shift, t_tel_4, t_tel_5, t_tel_5_apart,
};

/// The harnesses of this module.
#[cfg(not(chosen))]
pub const ALL: &[Harness] = &[
    t_tel_1::HARNESS,
    t_tel_2::HARNESS,
    t_tel_3::HARNESS,
    t_tel_3_linear::HARNESS,
    t_tel_3_shift::HARNESS,
    t_tel_3_few::HARNESS,
    t_tel_4::HARNESS,
    t_tel_5::HARNESS,
    t_tel_5_apart::HARNESS,
    t_tel_6::HARNESS,
    t_tel_6_repeated::HARNESS,
    t_tel_8::HARNESS,
    tel_7::HARNESS,
    tel_sequence::HARNESS,
    tel_total::HARNESS,
];

/// An arbitrary section and counter.
pub(crate) fn any_header<E: Engine + ?Sized>(e: &mut E) -> (SectionId, Counter) {
    (
        SectionId(e.word("section", 1..=2)),
        Counter(any_byte(e, "counter less 254 (modulo 256)", 0..=3).wrapping_add(254)),
    )
}

/// An arbitrary rank.
pub(crate) fn any_rank<E: Engine + ?Sized>(e: &mut E, what: &'static str) -> Option<AspectId> {
    let rank = AspectId::new(any_byte(e, what, 0..=7));
    e.assume(rank.is_some());
    rank
}

/// An arbitrary main telegram.
pub(crate) fn any_main<E: Engine + ?Sized>(e: &mut E) -> Option<Main> {
    let (section, counter) = any_header(e);
    let distance = Metres(e.word("stopping point beyond the exit (m)", 0..=900));
    let route = if any_flag(e, "route open (odd: yes)") { Route::OpenFor(distance) } else { Route::Closed };
    Some(Main { section, counter, route, speed: any_rank(e, "speed (rank)")? })
}

/// An arbitrary sub telegram.
pub(crate) fn any_sub<E: Engine + ?Sized>(e: &mut E) -> Option<Sub> {
    let (section, counter) = any_header(e);
    let length = Length::new(Metres(e.word("length (m)", 1..=300)));
    e.assume(length.is_some());
    let gradient = Gradient(i8::from_le_bytes([any_byte(e, "gradient (‰, two's complement)", 0..=255)]));
    let (curve, restriction) = (any_rank(e, "curve (rank)")?, any_rank(e, "restriction (rank)")?);
    Some(Sub { section, counter, length: length?, gradient, curve, restriction })
}

/// An arbitrary telegram.
pub(crate) fn any_telegram<E: Engine + ?Sized>(e: &mut E) -> Option<Telegram> {
    if any_flag(e, "main telegram (odd: yes)") {
        Some(Telegram::Main(any_main(e)?))
    } else {
        Some(Telegram::Sub(any_sub(e)?))
    }
}

/// Arbitrary bits of a frame's length.
fn any_bits<E: Engine + ?Sized>(e: &mut E, what: &'static str) -> u128 {
    let mut bits = u128::from(e.word(what, 0..=1023) & 0x03FF);
    for _ in 0..3 {
        bits = bits << 32 | u128::from(any_u32(e, what, 0..=65535));
    }
    bits
}

/// The frame that ten bytes make: the layout of TEL-1, bit by bit.
fn framed(bytes: [u8; 10]) -> Frame {
    let mut bits = 0b0111_1111_1111_1110_u128;
    for byte in bytes {
        for place in (0..8).rev() {
            bits = bits << 1 | u128::from(byte >> place & 1);
        }
        bits <<= 1;
    }
    Frame::from_bits(bits)
}
