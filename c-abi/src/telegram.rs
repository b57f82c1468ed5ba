//! Telegrams behind the border: [`atc_kernel::telegram`]. Frames from telegrams, telegrams from frames, and
//! telegrams found in a
//! stream of bits.

use atc_kernel::aspect::AspectId;
use atc_kernel::distance::Metres;
use atc_kernel::telegram::{
    self, Counter, Deframer, FRAME_BITS, Frame, FrameError, Gradient, Length, Main, Reception, Route, SectionId, Sub,
    Telegram, Window,
};

use crate::memory::{Machine, Reader, Writer};
use crate::{atc_status, flag};

/// The size of a deframer in bytes.
pub const ATC_DEFRAMER_SIZE: usize = 40;
/// The alignment of a deframer in bytes.
pub const ATC_DEFRAMER_ALIGN: usize = 8;

/// No telegram.
pub const ATC_TELEGRAM_NONE: u32 = 0;
/// A main telegram: what changes.
pub const ATC_TELEGRAM_MAIN: u32 = 1;
/// A sub telegram: what does not change.
pub const ATC_TELEGRAM_SUB: u32 = 2;

/// The receiver decided for a 0.
pub const ATC_RECEPTION_ZERO: u32 = 0;
/// The receiver decided for a 1.
pub const ATC_RECEPTION_ONE: u32 = 1;
/// The receiver hears nothing that it could decide on.
pub const ATC_RECEPTION_NOTHING: u32 = 2;

/// A deframer with the bits that it has heard. Its bytes are the library's; it may be moved and copied as a whole.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct atc_deframer {
    /// Not to be read or written.
    pub opaque: [u64; 5],
}

/// The variable data of a section: how far the line is free, and how fast.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct atc_main_telegram {
    /// The section that the telegram is for.
    pub section: u16,
    /// How far beyond the exit of the section the train must stop, in metres; 0 if the route is closed.
    pub beyond_exit_m: u16,
    /// The telegram's number in its stream.
    pub counter: u8,
    /// 1: the route beyond the exit is open. 0: the train must stop before the exit.
    pub route_open: u8,
    /// The speed that the ground permits, as a rank in the table of the line's speeds: 0 to 15.
    pub speed_rank: u8,
}

/// The fixed data of a section.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct atc_sub_telegram {
    /// The section that the telegram is for.
    pub section: u16,
    /// The length of the section in metres, 1 or more.
    pub length_m: u16,
    /// The telegram's number in its stream.
    pub counter: u8,
    /// The least favourable gradient in thousandths, positive where the train climbs.
    pub gradient_permille: i8,
    /// The limit by curves and points, as a rank: 0 to 15.
    pub curve_rank: u8,
    /// The limit by a temporary restriction, as a rank: 0 to 15; the highest rank if there is none.
    pub restriction_rank: u8,
}

/// A telegram of either kind, or none. All zeros is none.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct atc_telegram {
    /// Which of the two it is: `ATC_TELEGRAM_NONE`, `ATC_TELEGRAM_MAIN` or `ATC_TELEGRAM_SUB`.
    pub kind: u32,
    /// The main telegram; zeros if it is none, and then not looked at.
    pub main_data: atc_main_telegram,
    /// The sub telegram; zeros if it is none, and then not looked at.
    pub sub_data: atc_sub_telegram,
}

/// A frame: 106 bits in the order in which they are sent.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct atc_frame {
    /// The bits, each 0 or 1.
    pub bits: [u8; 106],
}

/// What the receiver says of one bit time.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct atc_deframer_input {
    /// `ATC_RECEPTION_ZERO`, `ATC_RECEPTION_ONE` or `ATC_RECEPTION_NOTHING`.
    pub reception: u32,
}

pub(crate) struct Deframing;

/// No telegram.
pub(crate) const NONE: atc_telegram = atc_telegram {
    kind: ATC_TELEGRAM_NONE,
    main_data: atc_main_telegram { section: 0, beyond_exit_m: 0, counter: 0, route_open: 0, speed_rank: 0 },
    sub_data: atc_sub_telegram {
        section: 0,
        length_m: 0,
        counter: 0,
        gradient_permille: 0,
        curve_rank: 0,
        restriction_rank: 0,
    },
};

/// Bits that are no frame: what a call that fails puts out.
pub(crate) const NO_FRAME: atc_frame = atc_frame { bits: [0; 106] };

fn rank(rank: u8) -> Result<AspectId, atc_status> {
    AspectId::new(rank).ok_or(atc_status::UnknownRank)
}

pub(crate) fn main(main: &atc_main_telegram) -> Result<Main, atc_status> {
    let route = match (flag(main.route_open)?, main.beyond_exit_m) {
        (true, beyond) => Route::OpenFor(Metres(beyond)),
        (false, 0) => Route::Closed,
        (false, _) => return Err(atc_status::ClosedRouteWithDistance),
    };
    let (section, counter) = (SectionId(main.section), Counter(main.counter));
    Ok(Main { section, counter, route, speed: rank(main.speed_rank)? })
}

pub(crate) fn sub(sub: &atc_sub_telegram) -> Result<Sub, atc_status> {
    Ok(Sub {
        section: SectionId(sub.section),
        counter: Counter(sub.counter),
        length: Length::new(Metres(sub.length_m)).ok_or(atc_status::NoSectionLength)?,
        gradient: Gradient(sub.gradient_permille),
        curve: rank(sub.curve_rank)?,
        restriction: rank(sub.restriction_rank)?,
    })
}

pub(crate) fn telegram(telegram: &Telegram) -> atc_telegram {
    match telegram {
        Telegram::Main(Main { section, counter, route, speed }) => {
            let main_data = atc_main_telegram {
                section: section.0,
                beyond_exit_m: route.beyond_exit().0,
                counter: counter.0,
                route_open: u8::from(*route != Route::Closed),
                speed_rank: speed.rank(),
            };
            atc_telegram { kind: ATC_TELEGRAM_MAIN, main_data, ..NONE }
        }
        Telegram::Sub(Sub { section, counter, length, gradient, curve, restriction }) => {
            let sub_data = atc_sub_telegram {
                section: section.0,
                length_m: length.metres().0,
                counter: counter.0,
                gradient_permille: gradient.0,
                curve_rank: curve.rank(),
                restriction_rank: restriction.rank(),
            };
            atc_telegram { kind: ATC_TELEGRAM_SUB, sub_data, ..NONE }
        }
    }
}

pub(crate) fn encode(asked: &atc_telegram) -> Result<atc_frame, atc_status> {
    let telegram = match asked.kind {
        ATC_TELEGRAM_MAIN => Telegram::Main(main(&asked.main_data)?),
        ATC_TELEGRAM_SUB => Telegram::Sub(sub(&asked.sub_data)?),
        _ => return Err(atc_status::UnknownChoice),
    };
    let frame = telegram::encode(telegram).bits();
    let mut bits = NO_FRAME.bits;
    // The first bit that is sent is the highest.
    for (place, bit) in (0..FRAME_BITS).rev().zip(&mut bits) {
        *bit = u8::from(frame >> place & 1 == 1);
    }
    Ok(atc_frame { bits })
}

/// The bits of a frame, the first one that is sent as the highest.
pub(crate) fn bits(frame: &atc_frame) -> Result<u128, atc_status> {
    let mut bits = 0;
    for bit in frame.bits {
        if bit > 1 {
            return Err(atc_status::BadBit);
        }
        bits = bits << 1 | u128::from(bit);
    }
    Ok(bits)
}

pub(crate) fn decode(frame: &atc_frame) -> Result<atc_telegram, atc_status> {
    telegram::decode(Frame::from_bits(bits(frame)?)).map(|found| telegram(&found)).map_err(|error| match error {
        FrameError::Synchronisation => atc_status::FrameSynchronisation,
        FrameError::Guard => atc_status::FrameGuard,
        FrameError::Check => atc_status::FrameCheck,
        FrameError::Content => atc_status::FrameContent,
    })
}

impl Machine for Deframing {
    const TAG: [u8; 4] = *b"DEFR";
    const PARAMETERS: usize = 0;
    type Parameters = ();
    type State = Window;
    type Input = atc_deframer_input;
    type Output = atc_telegram;
    const SAFE: Self::Output = NONE;

    fn initial((): &()) -> Window {
        Window::EMPTY
    }

    fn put_parameters((): &(), _: &mut Writer<'_>) {}

    fn take_parameters(_: &mut Reader<'_>) -> Option<()> {
        Some(())
    }

    fn put_state(window: &Window, to: &mut Writer<'_>) {
        to.u128(window.bits());
    }

    fn take_state((): &(), from: &mut Reader<'_>) -> Option<Window> {
        let window = Window::from_memory(from.u128()?);
        window.is_valid().then_some(window)
    }

    fn step((): &(), window: Window, input: &atc_deframer_input) -> Result<(Window, atc_telegram), atc_status> {
        let reception = match input.reception {
            ATC_RECEPTION_ZERO => Reception::Zero,
            ATC_RECEPTION_ONE => Reception::One,
            ATC_RECEPTION_NOTHING => Reception::Nothing,
            _ => return Err(atc_status::UnknownChoice),
        };
        let (window, found) = atc_kernel::Machine::step(&Deframer, window, reception);
        Ok((window, found.as_ref().map_or(NONE, telegram)))
    }
}
