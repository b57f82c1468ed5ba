//! The frame: a telegram as bits, and back.

use super::{Counter, Gradient, Length, Main, Route, SectionId, Sub, Telegram};
use crate::aspect::AspectId;
use crate::distance::Metres;

/// The bits of a frame: 16 of synchronisation, then 10 bytes, each followed by a guard bit.
pub const FRAME_BITS: u32 = 106;

/// The synchronisation word: 14 ones between two zeros. Bytes with guard bits have at most 8 ones in a row.
const SYNC: u16 = 0b0111_1111_1111_1110;

/// Information bytes: kind, counter, section (2), and four that depend on the kind.
const INFORMATION: usize = 8;

/// Information and check.
const BYTES: usize = INFORMATION + 2;

/// The first byte of a main and of a sub telegram; they differ in four bits.
const KIND_MAIN: u8 = 0x4D;
const KIND_SUB: u8 = 0x53;

/// The route byte of a main telegram.
const ROUTE_CLOSED: u8 = 0x0F;
const ROUTE_OPEN: u8 = 0xF0;

/// The generator polynomial of the check, without its highest term: x¹⁶ + x¹² + x⁵ + 1.
const GENERATOR: u16 = 0x1021;

/// [`FRAME_BITS`] bits in the order in which they are sent, the first one the highest.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Frame(u128);

/// Why bits are no frame of a telegram; the first that applies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FrameError {
    /// The synchronisation word is not there.
    Synchronisation,
    /// A guard bit is 1.
    Guard,
    /// The check does not fit the information.
    Check,
    /// The check fits, and the information is of no telegram: unknown kind, route or rank, an open route written as closed
    /// or the reverse, or a section without length.
    Content,
}

impl Frame {
    /// The lowest [`FRAME_BITS`] bits of `bits`.
    pub const fn from_bits(bits: u128) -> Self {
        Self(bits & ((1 << FRAME_BITS) - 1))
    }

    /// The bits; the first one sent is bit `FRAME_BITS − 1`, and what is above it is 0.
    pub const fn bits(self) -> u128 {
        self.0
    }
}

/// The frame of a telegram.
pub fn encode(telegram: Telegram) -> Frame {
    let information = information(telegram);
    let [high, low] = check(information).to_be_bytes();
    let mut bytes = [0; BYTES];
    bytes[..INFORMATION].copy_from_slice(&information);
    bytes[INFORMATION] = high;
    bytes[INFORMATION + 1] = low;
    //= spec/telegram.md#tel-1-the-frame
    //# A frame MUST be the synchronisation word, a zero, fourteen ones and a zero, followed by ten bytes, the highest bit first and each with a guard bit of 0 behind it.
    let mut bits = u128::from(SYNC);
    for byte in bytes {
        bits = bits << 9 | u128::from(byte) << 1;
    }
    Frame(bits)
}

/// The telegram of a frame.
///
/// # Errors
/// Why it is none, in the order of [`FrameError`].
pub fn decode(frame: Frame) -> Result<Telegram, FrameError> {
    //= spec/telegram.md#tel-2-nothing-but-a-telegram
    //# Bits that are not the frame of a telegram MUST NOT be taken for one.
    if frame.0 >> (9 * BYTES) != u128::from(SYNC) {
        return Err(FrameError::Synchronisation);
    }
    let mut bytes = [0; BYTES];
    let mut guards = 0;
    for (place, byte) in bytes.iter_mut().enumerate() {
        let low = (frame.0 >> (9 * (BYTES - 1 - place))).to_le_bytes();
        *byte = low[1] << 7 | low[0] >> 1;
        guards |= low[0] & 1;
    }
    if guards != 0 {
        return Err(FrameError::Guard);
    }
    let [b0, b1, b2, b3, b4, b5, b6, b7, high, low] = bytes;
    let information = [b0, b1, b2, b3, b4, b5, b6, b7];
    if check(information) != u16::from_be_bytes([high, low]) {
        return Err(FrameError::Check);
    }
    telegram(information).ok_or(FrameError::Content)
}

/// The check of the information bytes: the remainder of division by x¹⁶ + x¹² + x⁵ + 1, from a start of all ones.
pub const fn check(information: [u8; INFORMATION]) -> u16 {
    //= spec/telegram.md#tel-3-the-check
    //# The last two bytes MUST be the remainder of the first eight by the generator x¹⁶ + x¹² + x⁵ + 1, from a start of sixteen ones.
    let mut remainder = u16::MAX;
    let mut place = 0;
    while place < INFORMATION {
        remainder = check_byte(remainder, information[place]);
        place += 1;
    }
    remainder
}

/// The remainder after one more byte, the highest bit first.
pub const fn check_byte(remainder: u16, byte: u8) -> u16 {
    let mut remainder = remainder ^ ((byte as u16) << 8);
    let mut bit = 0;
    while bit < 8 {
        let carry = remainder >> 15;
        remainder = (remainder << 1) ^ (GENERATOR * carry);
        bit += 1;
    }
    remainder
}

/// The information bytes of a telegram.
fn information(telegram: Telegram) -> [u8; INFORMATION] {
    match telegram {
        Telegram::Main(Main { section, counter, route, speed }) => {
            let [section_high, section_low] = section.0.to_be_bytes();
            let [beyond_high, beyond_low] = route.beyond_exit().0.to_be_bytes();
            let route = match route {
                Route::Closed => ROUTE_CLOSED,
                Route::OpenFor(_) => ROUTE_OPEN,
            };
            [KIND_MAIN, counter.0, section_high, section_low, beyond_high, beyond_low, route, speed.rank()]
        }
        Telegram::Sub(Sub { section, counter, length, gradient, curve, restriction }) => {
            let [section_high, section_low] = section.0.to_be_bytes();
            let [length_high, length_low] = length.metres().0.to_be_bytes();
            let [gradient] = gradient.0.to_be_bytes();
            let limits = curve.rank() << 4 | restriction.rank();
            [KIND_SUB, counter.0, section_high, section_low, length_high, length_low, gradient, limits]
        }
    }
}

/// The telegram of the information bytes, if they are of one.
fn telegram(information: [u8; INFORMATION]) -> Option<Telegram> {
    let [kind, counter, section_high, section_low, high, low, seventh, eighth] = information;
    let section = SectionId(u16::from_be_bytes([section_high, section_low]));
    let counter = Counter(counter);
    let distance = Metres(u16::from_be_bytes([high, low]));
    //= spec/telegram.md#tel-4-the-content
    //# A kind, route or rank that is not defined, a closed route with a distance beyond the exit, and a section of no length MUST make the bits no telegram.
    match (kind, seventh) {
        (KIND_MAIN, ROUTE_CLOSED) if distance.0 == 0 => {
            Some(Telegram::Main(Main { section, counter, route: Route::Closed, speed: AspectId::new(eighth)? }))
        }
        (KIND_MAIN, ROUTE_OPEN) => {
            let route = Route::OpenFor(distance);
            Some(Telegram::Main(Main { section, counter, route, speed: AspectId::new(eighth)? }))
        }
        (KIND_SUB, gradient) => Some(Telegram::Sub(Sub {
            section,
            counter,
            length: Length::new(distance)?,
            gradient: Gradient(i8::from_be_bytes([gradient])),
            curve: AspectId::new(eighth >> 4)?,
            restriction: AspectId::new(eighth & 0x0F)?,
        })),
        _ => None,
    }
}
