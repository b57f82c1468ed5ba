//! The whole on-board device behind the border: [`atc_kernel::train`]. Codes, telegrams, position, permitted speed and brake in
//! one step, so that nobody puts them together by hand.

use atc_kernel::aspect::{Acceptance, MAX_ASPECTS, TimesMs};
use atc_kernel::code::{Code, CodeError, CodeFrequencies, CodeTable, MAX_CODES, Millihertz};
use atc_kernel::distance::Millimetres;
use atc_kernel::interlocking::Heading;
use atc_kernel::position::{Correction, Interval, KNOTS, Millibels, Moved, Position, Spacing, Table, TableError};
use atc_kernel::speed::{KmhTenths, RawKmhTenths};
use atc_kernel::telegram::Frame;
use atc_kernel::time::Millis;
use atc_kernel::train::{self, Antennas, Cab, Carrier, Parts, State, Train, TrainError};

use crate::aspect::{Aspect, put_times, take_times, times};
use crate::interlocking::{ATC_HEADING_LEFT, ATC_HEADING_NONE, ATC_HEADING_RIGHT};
use crate::memory::{Machine, Reader, Writer};
use crate::permitted::{self, Permitting, atc_permitted_config, line};
use crate::supervision::{self, Supervised, atc_supervision_config};
use crate::telegram::{atc_frame, bits};
use crate::{atc_status, flag};

/// The size of an on-board device in bytes.
pub const ATC_TRAIN_SIZE: usize = 584;
/// The alignment of an on-board device in bytes.
pub const ATC_TRAIN_ALIGN: usize = 8;

/// The most pairs of codes: 8 codes of the main carrier, each with 8 of the sub carrier.
pub const ATC_MAX_CODE_PAIRS: usize = 64;
/// At how many distances an attenuation table has values.
pub const ATC_TABLE_KNOTS: usize = 17;

/// An on-board device with its state. Its bytes are the library's; it may be moved and copied as a whole.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct atc_train {
    /// Not to be read or written.
    pub opaque: [u64; 73],
}

/// A pair of codes, and the speed that it names.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct atc_code_pair {
    /// The code frequency of the main carrier in thousandths of a hertz.
    pub main_millihertz: u32,
    /// The code frequency of the sub carrier in thousandths of a hertz.
    pub sub_millihertz: u32,
    /// The speed in tenths of km/h: one of the line's.
    pub speed: u16,
}

/// How the train finds its position by two signals that the rail attenuates differently. Levels are in hundredths of a decibel.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct atc_position_config {
    /// The lowest difference, first level less second, at each of the 17 distances, 0 first.
    pub lowest: [i16; 17],
    /// The highest difference there: not below the lowest.
    pub highest: [i16; 17],
    /// By how much each level may be off, 0 or more.
    pub tolerance: i16,
    /// The lowest level that is no noise.
    pub floor: i16,
    /// The least that is added to the difference.
    pub correction_least: i16,
    /// The most that is added to it: not below the least.
    pub correction_most: i16,
    /// From one distance to the next it is 2 to this power decimetres: 4 to 11 (1.6 m to 204.8 m).
    pub spacing_exponent: u8,
}

/// The parameters of the on-board device: those of its parts. There is one table of speeds, that of `permitted`.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct atc_train_config {
    /// The cycle, the line's speeds, the brake, the lives of telegrams and the counters.
    pub permitted: atc_permitted_config,
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
    /// By how much a measured code frequency may be off, in thousandths of a hertz.
    pub code_tolerance_millihertz: u32,
    /// How many pairs of codes there are: 1 to `ATC_MAX_CODE_PAIRS`.
    pub code_count: u32,
    /// The pairs of codes; of each carrier up to 8 different ones. From `code_count` on not looked at.
    pub codes: [atc_code_pair; 64],
    /// The highest plausible speed, and the margin of the release.
    pub supervision: atc_supervision_config,
    /// The position. Not looked at if `has_position` is 0.
    pub position: atc_position_config,
    /// 1: the train measures its position. 0: it does not; every distance begins at the exit of its section.
    pub has_position: u8,
}

/// What antennas, odometer, speed generator and balises give in one cycle. All zeros: nothing is heard or known.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct atc_train_input {
    /// The code frequency of the main carrier in thousandths of a hertz. Not looked at if `has_main_code` is 0.
    pub main_code_millihertz: u32,
    /// The code frequency of the sub carrier in thousandths of a hertz. Not looked at if `has_sub_code` is 0.
    pub sub_code_millihertz: u32,
    /// The kind of line that begins here: `ATC_LINE_UNCHANGED`, `ATC_LINE_ANALOG` or `ATC_LINE_DIGITAL`.
    pub line: u32,
    /// The measured speed in tenths of km/h; any number is an input. Not looked at if `has_speed` is 0.
    pub speed: i32,
    /// The frame of the main carrier whose last bit came in this cycle. Not looked at if `has_main_frame` is 0.
    pub main_frame: atc_frame,
    /// The frame of the sub carrier whose last bit came in this cycle. Not looked at if `has_sub_frame` is 0.
    pub sub_frame: atc_frame,
    /// The level of the signal that the rail attenuates less, in hundredths of a decibel. Not looked at if `has_first` is 0.
    pub first: i16,
    /// The level of the signal that the rail attenuates more, in hundredths of a decibel. Not looked at if `has_second` is 0.
    pub second: i16,
    /// The least that the train moved towards the exit since the last cycle, in mm. Not looked at if `has_moved` is 0.
    pub moved_least_mm: i16,
    /// The most that it moved: not below the least. Not looked at if `has_moved` is 0.
    pub moved_most_mm: i16,
    /// The direction of travel in which the train faces: `ATC_HEADING_LEFT`, `ATC_HEADING_RIGHT`, or `ATC_HEADING_NONE` if that
    /// is not known; then no telegram is used.
    pub facing: u8,
    /// 1: there is a code on the main carrier. 0: there is none.
    pub has_main_code: u8,
    /// 1: there is a code on the sub carrier. 0: there is none.
    pub has_sub_code: u8,
    /// 1: a frame of the main carrier was completed. 0: none was.
    pub has_main_frame: u8,
    /// 1: a frame of the sub carrier was completed. 0: none was.
    pub has_sub_frame: u8,
    /// 1: the first signal is heard. 0: it is not.
    pub has_first: u8,
    /// 1: the second signal is heard. 0: it is not.
    pub has_second: u8,
    /// 1: the odometer says something. 0: the train may have moved as far as can be said.
    pub has_moved: u8,
    /// 1: there is a measured speed. 0: there is none, and that is the emergency brake.
    pub has_speed: u8,
}

/// One logic cycle's output. The safe one displays and permits nothing, knows no position, and commands the emergency brake.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct atc_train_output {
    /// The brake command from the end of the cycle on: one of the `ATC_BRAKE_` constants.
    pub brake: u32,
    /// What the permission rests on: one of the `ATC_BASIS_` constants.
    pub basis: u32,
    /// The least distance of the front to the exit of the section whose signal is heard, in mm; 0 if it is not known.
    pub nearest_mm: u32,
    /// The greatest distance; 0 if it is not known.
    pub farthest_mm: u32,
    /// The speed of the displayed aspect in tenths of km/h; 0 if none is displayed.
    pub display: u16,
    /// The permitted speed in tenths of km/h; 0 is a stop by the service brake, or nothing is permitted.
    pub permitted: u16,
    /// 1: an aspect is displayed. 0: none is.
    pub has_display: u8,
    /// 1: there is a permitted speed. 0: there is none, and that is the emergency brake.
    pub has_permitted: u8,
    /// 1: the position is known. 0: it is not.
    pub has_position: u8,
}

pub(crate) struct OnBoard;

/// The pairs of codes as the kernel has them.
fn codes(tolerance: u32, pairs: &[atc_code_pair]) -> Result<CodeTable, atc_status> {
    let frequencies = |of: fn(&atc_code_pair) -> u32| {
        // In order, each once.
        let (mut kept, mut count) = ([Millihertz(0); MAX_CODES], 0);
        let mut before = None;
        while let Some(next) = pairs.iter().map(of).filter(|code| before < Some(*code)).min() {
            *kept.get_mut(count).ok_or(atc_status::TooManyCodes)? = Millihertz(next);
            (before, count) = (Some(next), count + 1);
        }
        let nominal = kept.get(..count).ok_or(atc_status::TooManyCodes)?;
        CodeFrequencies::new(nominal, Millihertz(tolerance)).map_err(code_status)
    };
    let (main, sub) = (frequencies(|pair| pair.main_millihertz)?, frequencies(|pair| pair.sub_millihertz)?);
    let mut speeds = [[None; MAX_CODES]; MAX_CODES];
    for pair in pairs {
        let place = |codes: &CodeFrequencies, code| codes.nominal().iter().position(|known| known.0 == code);
        let (row, column) = (place(&main, pair.main_millihertz), place(&sub, pair.sub_millihertz));
        let named = row.zip(column).and_then(|(row, column)| speeds.get_mut(row)?.get_mut(column));
        if named.ok_or(atc_status::TooManyCodes)?.replace(KmhTenths(pair.speed)).is_some() {
            return Err(atc_status::CodePairTwice);
        }
    }
    CodeTable::new(main, sub, speeds).map_err(code_status)
}

const fn code_status(error: CodeError) -> atc_status {
    match error {
        CodeError::NoFrequency | CodeError::NoSpeed | CodeError::UnusedCode(..) => atc_status::NoCodes,
        CodeError::TooManyFrequencies => atc_status::TooManyCodes,
        CodeError::OutOfRange => atc_status::CodeOutOfRange,
        CodeError::BandsTouch(_) => atc_status::CodeBandsTouch,
    }
}

fn position(config: &atc_position_config) -> Result<Position, atc_status> {
    let spacing = Spacing::new(config.spacing_exponent).ok_or(atc_status::BadSpacing)?;
    let table = Table::new(spacing, config.lowest.map(Millibels), config.highest.map(Millibels));
    let table = table.map_err(|error| match error {
        TableError::Crossed(_) => atc_status::TableCrossed,
        TableError::NowhereRising => atc_status::TableNowhereRising,
    })?;
    let correction = Correction::new(Millibels(config.correction_least), Millibels(config.correction_most));
    let correction = correction.ok_or(atc_status::BadCorrection)?;
    let (tolerance, floor) = (Millibels(config.tolerance), Millibels(config.floor));
    Position::new(table, tolerance, floor, correction).ok_or(atc_status::BadTolerance)
}

const fn together(error: TrainError) -> atc_status {
    match error {
        TrainError::TooManyRanks => atc_status::TooManySpeeds,
        TrainError::ImplausibleSpeed(_) => atc_status::ImplausibleSpeed,
        TrainError::UnknownSpeed(..) => atc_status::UnknownCodeSpeed,
    }
}

/// The kernel's parameters of a configuration.
pub(crate) fn parameters(config: &atc_train_config) -> Result<Train<MAX_ASPECTS>, atc_status> {
    let permitted = permitted::parameters(&config.permitted)?;
    let times = times(
        config.permitted.cycle_ms,
        TimesMs {
            operate: Millis(config.operate_ms),
            recovery: Millis(config.recovery_ms),
            mask: Millis(config.mask_ms),
            interruption: Millis(config.interruption_ms),
            shortened_operate: Millis(config.shortened_operate_ms),
        },
    )?;
    let count = usize::try_from(config.code_count).unwrap_or(usize::MAX);
    let pairs = config.codes.get(..count).ok_or(atc_status::TooManyCodes)?;
    let position = if flag(config.has_position)? { Some(position(&config.position)?) } else { None };
    let parts = Parts {
        codes: codes(config.code_tolerance_millihertz, pairs)?,
        acceptance: Acceptance { times },
        permitted,
        supervision: supervision::parameters(&config.supervision)?,
        position,
    };
    Train::new(parts).map_err(together)
}

const fn output(cab: &Cab) -> atc_train_output {
    let permission = permitted::output(cab.permission);
    let (display, has_display) = match cab.display {
        Some(speed) => (speed.0, 1),
        None => (0, 0),
    };
    let (nearest_mm, farthest_mm, has_position) = match cab.position {
        Some(interval) => (interval.nearest().0, interval.farthest().0, 1),
        None => (0, 0, 0),
    };
    atc_train_output {
        brake: supervision::number(cab.brake),
        basis: permission.basis,
        nearest_mm,
        farthest_mm,
        display,
        permitted: permission.speed,
        has_display,
        has_permitted: permission.has_speed,
        has_position,
    }
}

fn put_frequencies(codes: &CodeFrequencies, to: &mut Writer<'_>) {
    // At most 8.
    to.u8(u8::try_from(codes.nominal().len()).unwrap_or(0));
    for place in 0..MAX_CODES {
        to.u32(codes.nominal().get(place).map_or(0, |code| code.0));
    }
}

fn take_frequencies(from: &mut Reader<'_>, tolerance: Millihertz) -> Option<CodeFrequencies> {
    let count = usize::from(from.u8()?);
    let mut nominal = [Millihertz(0); MAX_CODES];
    for code in &mut nominal {
        *code = Millihertz(from.u32()?);
    }
    CodeFrequencies::new(nominal.get(..count)?, tolerance).ok()
}

fn put_codes(codes: &CodeTable, to: &mut Writer<'_>) {
    to.u32(codes.main().tolerance().0);
    put_frequencies(codes.main(), to);
    put_frequencies(codes.sub(), to);
    for place in 0..MAX_CODES * MAX_CODES {
        let code = |place: usize| Code::new(u8::try_from(place).unwrap_or(u8::MAX));
        let speed = codes.speed(code(place / MAX_CODES), code(place % MAX_CODES));
        to.flag(speed.is_some());
        to.u16(speed.unwrap_or(KmhTenths(0)).0);
    }
}

fn take_codes(from: &mut Reader<'_>) -> Option<CodeTable> {
    let tolerance = Millihertz(from.u32()?);
    let (main, sub) = (take_frequencies(from, tolerance)?, take_frequencies(from, tolerance)?);
    let mut speeds = [[None; MAX_CODES]; MAX_CODES];
    for speed in speeds.as_flattened_mut() {
        let (there, named) = (from.flag()?, from.u16()?);
        *speed = there.then_some(KmhTenths(named));
    }
    CodeTable::new(main, sub, speeds).ok()
}

fn put_position(position: &Position, to: &mut Writer<'_>) {
    let (table, correction) = (position.table(), position.correction());
    to.u8(table.spacing().exponent());
    let levels = [position.tolerance(), position.floor(), correction.least(), correction.most()];
    for level in table.lowest().iter().chain(table.highest()).chain(&levels) {
        to.i16(level.0);
    }
}

fn take_position(from: &mut Reader<'_>) -> Option<Position> {
    let spacing = Spacing::new(from.u8()?)?;
    let mut curves = [[Millibels(0); KNOTS]; 2];
    for level in curves.as_flattened_mut() {
        *level = Millibels(from.i16()?);
    }
    let [lowest, highest] = curves;
    let (tolerance, floor) = (Millibels(from.i16()?), Millibels(from.i16()?));
    let correction = Correction::new(Millibels(from.i16()?), Millibels(from.i16()?))?;
    Position::new(Table::new(spacing, lowest, highest).ok()?, tolerance, floor, correction)
}

const fn put_facing(facing: Option<Heading>) -> u8 {
    match facing {
        None => ATC_HEADING_NONE,
        Some(Heading::Left) => ATC_HEADING_LEFT,
        Some(Heading::Right) => ATC_HEADING_RIGHT,
    }
}

const fn facing(facing: u8) -> Result<Option<Heading>, atc_status> {
    match facing {
        ATC_HEADING_NONE => Ok(None),
        ATC_HEADING_LEFT => Ok(Some(Heading::Left)),
        ATC_HEADING_RIGHT => Ok(Some(Heading::Right)),
        _ => Err(atc_status::UnknownChoice),
    }
}

fn carrier((has_code, code): (u8, u32), (has_frame, frame): (u8, &atc_frame)) -> Result<Carrier, atc_status> {
    let code = flag(has_code)?.then_some(Millihertz(code));
    let frame = if flag(has_frame)? { Some(Frame::from_bits(bits(frame)?)) } else { None };
    Ok(Carrier { code, frame })
}

fn antennas(input: &atc_train_input) -> Result<Antennas, atc_status> {
    let moved = Moved::new(input.moved_least_mm, input.moved_most_mm);
    Ok(Antennas {
        main: carrier((input.has_main_code, input.main_code_millihertz), (input.has_main_frame, &input.main_frame))?,
        sub: carrier((input.has_sub_code, input.sub_code_millihertz), (input.has_sub_frame, &input.sub_frame))?,
        first: flag(input.has_first)?.then_some(Millibels(input.first)),
        second: flag(input.has_second)?.then_some(Millibels(input.second)),
        moved: if flag(input.has_moved)? { Some(moved.ok_or(atc_status::BadMovement)?) } else { None },
        speed: flag(input.has_speed)?.then_some(RawKmhTenths(input.speed)),
        line: line(input.line)?,
        facing: facing(input.facing)?,
    })
}

impl Machine for OnBoard {
    const TAG: [u8; 4] = *b"TRAN";
    const PARAMETERS: usize = 408;
    type Parameters = Train<MAX_ASPECTS>;
    type State = State<MAX_ASPECTS>;
    type Input = atc_train_input;
    type Output = atc_train_output;
    const SAFE: Self::Output = output(&Cab::STOP);

    fn initial(_: &Self::Parameters) -> Self::State {
        State::INITIAL
    }

    fn put_parameters(train: &Self::Parameters, to: &mut Writer<'_>) {
        let parts = train.parts();
        Permitting::put_parameters(&parts.permitted, to);
        put_times(parts.acceptance.times, to);
        Supervised::put_parameters(&parts.supervision, to);
        put_codes(&parts.codes, to);
        to.flag(parts.position.is_some());
        if let Some(position) = &parts.position {
            put_position(position, to);
        }
    }

    fn take_parameters(from: &mut Reader<'_>) -> Option<Self::Parameters> {
        let permitted = Permitting::take_parameters(from)?;
        let acceptance = Acceptance { times: take_times(from)? };
        let supervision = Supervised::take_parameters(from)?;
        let codes = take_codes(from)?;
        let position = if from.flag()? { Some(take_position(from)?) } else { None };
        Train::new(Parts { codes, acceptance, permitted, supervision, position }).ok()
    }

    fn put_state(state: &Self::State, to: &mut Writer<'_>) {
        Aspect::put_state(&state.acceptance, to);
        Permitting::put_state(&state.permitted, to);
        Supervised::put_state(&state.brake, to);
        to.u8(put_facing(state.facing));
        to.flag(state.position.is_some());
        let ends = state.position.map_or((0, 0), |interval| (interval.nearest().0, interval.farthest().0));
        to.u32(ends.0);
        to.u32(ends.1);
    }

    fn take_state(train: &Self::Parameters, from: &mut Reader<'_>) -> Option<Self::State> {
        let parts = train.parts();
        let acceptance = Aspect::take_state(&(*train.speeds(), parts.acceptance.times), from)?;
        let permitted = Permitting::take_state(&parts.permitted, from)?;
        let brake = Supervised::take_state(&parts.supervision, from)?;
        let facing = facing(from.u8()?).ok()?;
        let (there, nearest, farthest) = (from.flag()?, Millimetres(from.u32()?), Millimetres(from.u32()?));
        let position = if there { Some(Interval::new(nearest, farthest)?) } else { None };
        let state = State { acceptance, permitted, position, brake, facing };
        state.is_valid(train).then_some(state)
    }

    fn step(
        train: &Self::Parameters,
        state: Self::State,
        input: &atc_train_input,
    ) -> Result<(Self::State, atc_train_output), atc_status> {
        let (state, cab) = train::step(train, state, antennas(input)?);
        Ok((state, output(&cab)))
    }
}
