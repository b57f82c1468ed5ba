//! Aspect acceptance behind the border: [`atc_kernel::aspect`].

use atc_kernel::aspect::{
    self, AspectSet, AspectTable, Display, MAX_ASPECTS, Parts, State, TableError, Times, TimesError, TimesMs,
};
use atc_kernel::speed::KmhTenths;
use atc_kernel::time::{Millis, Ticks};

use crate::atc_status;
use crate::memory::{Machine, Reader, Writer};

/// The size of an aspect acceptance in bytes.
pub const ATC_ASPECT_SIZE: usize = 144;
/// The alignment of an aspect acceptance in bytes.
pub const ATC_ASPECT_ALIGN: usize = 8;

/// An aspect acceptance with its state. Its bytes are the library's; it may be moved and copied as a whole.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct atc_aspect {
    /// Not to be read or written.
    pub opaque: [u64; 18],
}

/// The line's aspects and times.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct atc_aspect_config {
    /// The length of a logic cycle in ms, 1 or more.
    pub cycle_ms: u32,
    /// T1: an aspect heard for so long is accepted. Rounded up to cycles.
    pub operate_ms: u32,
    /// T2: a lost aspect stands so long as if it were heard. Rounded down to cycles.
    pub recovery_ms: u32,
    /// T3: and after that so long, if nothing contradicts it. Rounded down to cycles.
    pub mask_ms: u32,
    /// T4: the longest interruption after which T5 takes the place of T1. Rounded down to cycles.
    pub interruption_ms: u32,
    /// T5: the operate time after a short interruption, below T1. Rounded up to cycles.
    pub shortened_operate_ms: u32,
    /// How many aspects the line has: 1 to 16.
    pub aspect_count: u32,
    /// The permitted speeds that the aspects name, in tenths of km/h, strictly rising. From `aspect_count` on not
    /// looked at.
    pub speeds: [u16; 16],
}

/// One logic cycle's input.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct atc_aspect_input {
    /// The aspects whose signal was heard throughout the cycle: bit `i` for the aspect of rank `i`, 0 the lowest.
    pub detected: u16,
}

/// One logic cycle's output. The safe one is all zeros: no display.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct atc_aspect_output {
    /// 1: an aspect is displayed from the end of the cycle on. 0: none is, and that means stop.
    pub displayed: u8,
    /// Its rank, 0 to 15; 0 if none is displayed.
    pub rank: u8,
    /// The speed that it permits in tenths of km/h; 0 if none is displayed.
    pub speed: u16,
}

pub(crate) struct Aspect;

/// A table of up to 16 speeds as a configuration gives it.
pub(crate) fn table(speeds: [u16; MAX_ASPECTS], count: u32) -> Result<AspectTable, atc_status> {
    let count = usize::try_from(count).unwrap_or(usize::MAX);
    let speeds = speeds.map(KmhTenths);
    let used = speeds.get(..count).ok_or(atc_status::TooManySpeeds)?;
    AspectTable::new(used).map_err(|error| match error {
        TableError::Empty => atc_status::NoSpeeds,
        TableError::TooMany => atc_status::TooManySpeeds,
        TableError::NotRising(_) => atc_status::SpeedsNotRising,
    })
}

pub(crate) fn put_table(table: &AspectTable, to: &mut Writer<'_>) {
    let speeds = table.speeds();
    // At most 16.
    to.u8(u8::try_from(speeds.len()).unwrap_or(0));
    for rank in 0..MAX_ASPECTS {
        to.u16(speeds.get(rank).map_or(0, |speed| speed.0));
    }
}

pub(crate) fn take_table(from: &mut Reader<'_>) -> Option<AspectTable> {
    let count = from.u8()?;
    let mut speeds = [0; MAX_ASPECTS];
    for speed in &mut speeds {
        *speed = from.u16()?;
    }
    table(speeds, count.into()).ok()
}

/// The kernel's parameters of a configuration.
pub(crate) fn parameters(config: &atc_aspect_config) -> Result<(AspectTable, Times), atc_status> {
    let table = table(config.speeds, config.aspect_count)?;
    let given = TimesMs {
        operate: Millis(config.operate_ms),
        recovery: Millis(config.recovery_ms),
        mask: Millis(config.mask_ms),
        interruption: Millis(config.interruption_ms),
        shortened_operate: Millis(config.shortened_operate_ms),
    };
    Ok((table, times(config.cycle_ms, given)?))
}

/// The times in cycles of `cycle_ms`.
pub(crate) fn times(cycle_ms: u32, given: TimesMs) -> Result<Times, atc_status> {
    Times::from_millis(Millis(cycle_ms), given).map_err(|error| match error {
        TimesError::NoCycle => atc_status::NoCycle,
        TimesError::NoOperateTime => atc_status::NoOperateTime,
        TimesError::NoRecoveryTime => atc_status::NoRecoveryTime,
        TimesError::NoShortenedOperateTime => atc_status::NoShortenedOperateTime,
        TimesError::ShortenedNotShorter => atc_status::ShortenedNotShorter,
        TimesError::OperateTooLong | TimesError::RecoveryAndMaskTooLong | TimesError::InterruptionTooLong => {
            atc_status::TimeTooLong
        }
    })
}

pub(crate) fn put_times(times: Times, to: &mut Writer<'_>) {
    to.u16(times.operate().0);
    to.u16(times.recovery().0);
    to.u16(times.expiry().0);
    to.u16(times.interruption().0);
    to.u16(times.shortened_operate().0);
}

pub(crate) fn take_times(from: &mut Reader<'_>) -> Option<Times> {
    let [operate, recovery, expiry] = [from.u16()?, from.u16()?, from.u16()?];
    let [interruption, shortened] = [Ticks(from.u16()?), Ticks(from.u16()?)];
    let mask = Ticks(expiry.checked_sub(recovery)?);
    Times::from_ticks(Ticks(operate), Ticks(recovery), mask, interruption, shortened).ok()
}

/// Whether only aspects of the table are in `bits`.
fn known(table: &AspectTable, bits: u16) -> bool {
    u32::from(bits) >> table.speeds().len() == 0
}

impl Machine for Aspect {
    const TAG: [u8; 4] = *b"ASPT";
    const PARAMETERS: usize = 48;
    type Parameters = (AspectTable, Times);
    type State = State<MAX_ASPECTS>;
    type Input = atc_aspect_input;
    type Output = atc_aspect_output;
    const SAFE: Self::Output = atc_aspect_output { displayed: 0, rank: 0, speed: 0 };

    fn initial(_: &Self::Parameters) -> Self::State {
        State::INITIAL
    }

    fn put_parameters((table, times): &Self::Parameters, to: &mut Writer<'_>) {
        put_times(*times, to);
        put_table(table, to);
    }

    fn take_parameters(from: &mut Reader<'_>) -> Option<Self::Parameters> {
        let times = take_times(from)?;
        Some((take_table(from)?, times))
    }

    fn put_state(state: &Self::State, to: &mut Writer<'_>) {
        let parts = state.parts();
        for ticks in parts.run.into_iter().chain(parts.age) {
            to.u16(ticks);
        }
        for bits in [parts.accepted, parts.dropped, parts.credited, parts.last] {
            to.u16(bits);
        }
    }

    fn take_state((table, times): &Self::Parameters, from: &mut Reader<'_>) -> Option<Self::State> {
        let mut ticks = [[0; MAX_ASPECTS]; 2];
        for tick in ticks.as_flattened_mut() {
            *tick = from.u16()?;
        }
        let [run, age] = ticks;
        let [accepted, dropped, credited, last] = [from.u16()?, from.u16()?, from.u16()?, from.u16()?];
        let state = State::from_parts(Parts { run, age, accepted, dropped, credited, last });
        (known(table, accepted | last) && state.is_valid(*times)).then_some(state)
    }

    fn step(
        (table, times): &Self::Parameters,
        state: Self::State,
        input: &atc_aspect_input,
    ) -> Result<(Self::State, atc_aspect_output), atc_status> {
        if !known(table, input.detected) {
            return Err(atc_status::UnknownAspect);
        }
        let (state, display) = aspect::step(*times, state, AspectSet::from_bits(input.detected));
        Ok((state, output(table, display)))
    }
}

fn output(table: &AspectTable, display: Display) -> atc_aspect_output {
    let shown = display.aspect().and_then(|aspect| Some((aspect, table.speed(aspect)?)));
    shown.map_or(Aspect::SAFE, |(aspect, speed)| atc_aspect_output {
        displayed: 1,
        rank: aspect.rank(),
        speed: speed.0,
    })
}
