//! The permitted speed behind the border: [`atc_kernel::permitted`].

use atc_kernel::aspect::AspectId;
use atc_kernel::distance::{Metres, Millimetres};
use atc_kernel::pattern::Deceleration;
use atc_kernel::permitted::{
    self, Basis, Fixed, Heard, LineKind, Permission, Permitted, PermittedError, Settings, State, Target,
};
use atc_kernel::speed::KmhTenths;
use atc_kernel::telegram::{Counter, Gradient, Header, SectionId, Sequence, SequenceError, Stream};
use atc_kernel::time::{Cycle, Millis, Ticks};

use crate::aspect::{put_table, table, take_table};
use crate::memory::{Machine, Reader, Writer};
use crate::telegram::{atc_main_telegram, atc_sub_telegram, main, sub};
use crate::{atc_status, flag};

/// The size of a permitted speed in bytes.
pub const ATC_PERMITTED_SIZE: usize = 144;
/// The alignment of a permitted speed in bytes.
pub const ATC_PERMITTED_ALIGN: usize = 8;

/// The train is told nothing of the line in this cycle.
pub const ATC_LINE_UNCHANGED: u32 = 0;
/// A line with analog codes only begins here.
pub const ATC_LINE_ANALOG: u32 = 1;
/// A line with analog codes and telegrams begins here.
pub const ATC_LINE_DIGITAL: u32 = 2;

/// Nothing that permits: no code, or telegrams missing for too long.
pub const ATC_BASIS_NOTHING: u32 = 0;
/// The analog code alone.
pub const ATC_BASIS_ANALOG: u32 = 1;
/// The pattern alone.
pub const ATC_BASIS_PATTERN: u32 = 2;
/// The lower of analog code and pattern.
pub const ATC_BASIS_BOTH: u32 = 3;
/// Telegrams are missing: the lower of analog code and the last pattern, which is running down.
pub const ATC_BASIS_RUNNING_DOWN: u32 = 4;

/// A permitted speed with its state. Its bytes are the library's; it may be moved and copied as a whole.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct atc_permitted {
    /// Not to be read or written.
    pub opaque: [u64; 18],
}

/// The parameters of line and train. Every time is rounded down to cycles.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct atc_permitted_config {
    /// The length of a logic cycle in ms, 1 or more.
    pub cycle_ms: u32,
    /// For how long a main telegram is fresh: one cycle or more.
    pub fresh_ms: u32,
    /// For how long the pattern of the last main telegram runs down: `fresh_ms` or more.
    pub life_ms: u32,
    /// For how long a sub telegram is used: one cycle or more.
    pub fixed_life_ms: u32,
    /// After how long without a telegram its predecessors are forgotten: no longer than either life.
    pub memory_ms: u32,
    /// How many speeds the line has: 1 to 16.
    pub speed_count: u32,
    /// The line's speeds in tenths of km/h, strictly rising. From `speed_count` on not looked at.
    pub speeds: [u16; 16],
    /// The train's deceleration by its service brake on the level, in mm/s²: 1 to 4095.
    pub brake_mm_s2: u16,
    /// What is taken off every distance to a stopping point, in metres.
    pub margin_m: u16,
    /// The lowest limit that a sub telegram of this line carries, as a rank in `speeds`.
    pub lowest_rank: u8,
    /// The worst gradient that a sub telegram of this line carries, in thousandths, negative where the train descends.
    pub worst_gradient_permille: i8,
    /// By how much the counter may advance from one telegram to the next: 1 to 127.
    pub window: u8,
    /// How many telegrams in a row must have advanced their counter before one is used: 1 to 15.
    pub run: u8,
}

/// What is heard and measured in one cycle.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct atc_permitted_input {
    /// The kind of line that begins here: `ATC_LINE_UNCHANGED`, `ATC_LINE_ANALOG` or `ATC_LINE_DIGITAL`.
    pub line: u32,
    /// A distance from which the exit of the section is no nearer, in mm. Not looked at if `has_to_exit` is 0.
    pub to_exit_mm: u32,
    /// The most that the train can have moved forward since the last cycle, in mm.
    pub moved_mm: u32,
    /// The main telegram that was completed in this cycle. Not looked at if `has_main` is 0.
    pub main_data: atc_main_telegram,
    /// The sub telegram that was completed in this cycle. Not looked at if `has_sub` is 0.
    pub sub_data: atc_sub_telegram,
    /// The speed of the accepted analog code in tenths of km/h. Not looked at if `has_analog` is 0.
    pub analog: u16,
    /// 1: an analog code is accepted. 0: none is.
    pub has_analog: u8,
    /// 1: a main telegram was completed in this cycle. 0: none was.
    pub has_main: u8,
    /// 1: a sub telegram was completed in this cycle. 0: none was.
    pub has_sub: u8,
    /// 1: the distance to the exit is measured. 0: it is not.
    pub has_to_exit: u8,
}

/// One cycle's output. The safe one is all zeros: no permission, and that is the emergency brake.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct atc_permitted_output {
    /// What the permission rests on: one of the `ATC_BASIS_` constants.
    pub basis: u32,
    /// The permitted speed in tenths of km/h; 0 is a stop by the service brake, or nothing is permitted.
    pub speed: u16,
    /// 1: there is a permitted speed. 0: nothing is heard, and that is the emergency brake.
    pub has_speed: u8,
}

pub(crate) struct Permitting;

/// The kernel's parameters of a configuration.
pub(crate) fn parameters(config: &atc_permitted_config) -> Result<Permitted, atc_status> {
    let cycle = Cycle::new(Millis(config.cycle_ms)).ok_or(atc_status::NoCycle)?;
    let time = |ms| cycle.at_most(Millis(ms)).ok_or(atc_status::TimeTooLong);
    let sequence = Sequence::new(config.window, config.run, time(config.memory_ms)?).map_err(|error| match error {
        SequenceError::NoWindow | SequenceError::WindowTooWide => atc_status::BadWindow,
        SequenceError::NoRun | SequenceError::RunTooLong => atc_status::BadRun,
        SequenceError::NoMemory => atc_status::NoMemory,
        SequenceError::MemoryTooLong => atc_status::TimeTooLong,
    })?;
    let settings = Settings {
        speeds: table(config.speeds, config.speed_count)?,
        lowest: AspectId::new(config.lowest_rank).ok_or(atc_status::UnknownRank)?,
        brake: Deceleration::brake(config.brake_mm_s2).ok_or(atc_status::BadBrake)?,
        worst: Gradient(config.worst_gradient_permille),
        margin: Metres(config.margin_m),
        fresh: time(config.fresh_ms)?,
        life: time(config.life_ms)?,
        fixed_life: time(config.fixed_life_ms)?,
        sequence,
    };
    Permitted::new(settings).map_err(|error| match error {
        PermittedError::UnknownLimit => atc_status::UnknownLimit,
        PermittedError::NoFreshness => atc_status::NoFreshness,
        PermittedError::LifeShorterThanFreshness => atc_status::LifeShorterThanFreshness,
        PermittedError::TooLong => atc_status::TimeTooLong,
        PermittedError::NoFixedLife => atc_status::NoFixedLife,
        PermittedError::MemoryLongerThanLife => atc_status::MemoryLongerThanLife,
    })
}

pub(crate) const fn output(permission: Permission) -> atc_permitted_output {
    let basis = match permission.basis {
        Basis::Nothing => ATC_BASIS_NOTHING,
        Basis::Analog => ATC_BASIS_ANALOG,
        Basis::Pattern => ATC_BASIS_PATTERN,
        Basis::Both => ATC_BASIS_BOTH,
        Basis::RunningDown => ATC_BASIS_RUNNING_DOWN,
    };
    match permission.speed {
        Some(speed) => atc_permitted_output { basis, speed: speed.0, has_speed: 1 },
        None => atc_permitted_output { basis, speed: 0, has_speed: 0 },
    }
}

/// The kind of line that begins here, if the train is told of one.
pub(crate) const fn line(line: u32) -> Result<Option<LineKind>, atc_status> {
    match line {
        ATC_LINE_UNCHANGED => Ok(None),
        ATC_LINE_ANALOG => Ok(Some(LineKind::Analog)),
        ATC_LINE_DIGITAL => Ok(Some(LineKind::Digital)),
        _ => Err(atc_status::UnknownChoice),
    }
}

fn put_target(target: Option<Target>, to: &mut Writer<'_>) {
    to.flag(target.is_some());
    let none = Target {
        section: SectionId(0),
        beyond: Metres(0),
        limit: KmhTenths(0),
        to_stop: Millimetres(0),
        age: Ticks(0),
    };
    let target = target.unwrap_or(none);
    for number in [target.section.0, target.beyond.0, target.limit.0, target.age.0] {
        to.u16(number);
    }
    to.u32(target.to_stop.0);
}

/// Reads into `target`; `None` if there is none to be read.
fn take_target(from: &mut Reader<'_>, target: &mut Option<Target>) -> Option<()> {
    let there = from.flag()?;
    let read = Target {
        section: SectionId(from.u16()?),
        beyond: Metres(from.u16()?),
        limit: KmhTenths(from.u16()?),
        age: Ticks(from.u16()?),
        to_stop: Millimetres(from.u32()?),
    };
    *target = there.then_some(read);
    Some(())
}

fn put_fixed(fixed: Option<Fixed>, to: &mut Writer<'_>) {
    to.flag(fixed.is_some());
    let none = Fixed { section: SectionId(0), gradient: Gradient(0), limit: KmhTenths(0), age: Ticks(0) };
    let fixed = fixed.unwrap_or(none);
    for number in [fixed.section.0, fixed.limit.0, fixed.age.0] {
        to.u16(number);
    }
    to.i8(fixed.gradient.0);
}

fn take_fixed(from: &mut Reader<'_>, fixed: &mut Option<Fixed>) -> Option<()> {
    let there = from.flag()?;
    let read = Fixed {
        section: SectionId(from.u16()?),
        limit: KmhTenths(from.u16()?),
        age: Ticks(from.u16()?),
        gradient: Gradient(from.i8()?),
    };
    *fixed = there.then_some(read);
    Some(())
}

fn put_stream(stream: Stream, to: &mut Writer<'_>) {
    to.flag(stream.last.is_some());
    let last = stream.last.unwrap_or(Header { section: SectionId(0), counter: Counter(0) });
    to.u16(last.section.0);
    to.u8(last.counter.0);
    to.u8(stream.in_order);
    to.u16(stream.age.0);
}

fn take_stream(from: &mut Reader<'_>) -> Option<Stream> {
    let there = from.flag()?;
    let last = Header { section: SectionId(from.u16()?), counter: Counter(from.u8()?) };
    Some(Stream { last: there.then_some(last), in_order: from.u8()?, age: Ticks(from.u16()?) })
}

impl Machine for Permitting {
    const TAG: [u8; 4] = *b"PERM";
    const PARAMETERS: usize = 56;
    type Parameters = Permitted;
    type State = State;
    type Input = atc_permitted_input;
    type Output = atc_permitted_output;
    const SAFE: Self::Output = output(<Permitted as atc_kernel::Machine>::SAFE);

    fn initial(_: &Permitted) -> State {
        State::INITIAL
    }

    fn put_parameters(permitted: &Permitted, to: &mut Writer<'_>) {
        let settings = permitted.settings();
        put_table(&settings.speeds, to);
        to.u8(settings.lowest.rank());
        to.i8(settings.worst.0);
        to.u8(settings.sequence.window());
        to.u8(settings.sequence.run());
        to.u16(settings.sequence.memory().0);
        to.u16(settings.brake.mm_s2());
        to.u16(settings.margin.0);
        for ticks in [settings.fresh, settings.life, settings.fixed_life] {
            to.u16(ticks.0);
        }
    }

    fn take_parameters(from: &mut Reader<'_>) -> Option<Permitted> {
        let speeds = take_table(from)?;
        let lowest = AspectId::new(from.u8()?)?;
        let worst = Gradient(from.i8()?);
        let sequence = Sequence::new(from.u8()?, from.u8()?, Ticks(from.u16()?)).ok()?;
        let brake = Deceleration::brake(from.u16()?)?;
        let margin = Metres(from.u16()?);
        let [fresh, life, fixed_life] = [Ticks(from.u16()?), Ticks(from.u16()?), Ticks(from.u16()?)];
        Permitted::new(Settings { speeds, lowest, brake, worst, margin, fresh, life, fixed_life, sequence }).ok()
    }

    fn put_state(state: &State, to: &mut Writer<'_>) {
        to.flag(state.line == LineKind::Digital);
        to.flag(state.fix.is_some());
        to.u32(state.fix.unwrap_or_default().0);
        put_target(state.target, to);
        put_target(state.behind, to);
        for fixed in state.fixed {
            put_fixed(fixed, to);
        }
        put_stream(state.main_stream, to);
        put_stream(state.sub_stream, to);
    }

    fn take_state(permitted: &Permitted, from: &mut Reader<'_>) -> Option<State> {
        let line = if from.flag()? { LineKind::Digital } else { LineKind::Analog };
        let (there, fix) = (from.flag()?, Millimetres(from.u32()?));
        let mut state = State { line, fix: there.then_some(fix), ..State::INITIAL };
        take_target(from, &mut state.target)?;
        take_target(from, &mut state.behind)?;
        for fixed in &mut state.fixed {
            take_fixed(from, fixed)?;
        }
        state.main_stream = take_stream(from)?;
        state.sub_stream = take_stream(from)?;
        state.is_valid(permitted).then_some(state)
    }

    fn step(
        permitted: &Permitted,
        state: State,
        input: &atc_permitted_input,
    ) -> Result<(State, atc_permitted_output), atc_status> {
        let heard = Heard {
            line: line(input.line)?,
            analog: flag(input.has_analog)?.then_some(KmhTenths(input.analog)),
            main: if flag(input.has_main)? { Some(main(&input.main_data)?) } else { None },
            sub: if flag(input.has_sub)? { Some(sub(&input.sub_data)?) } else { None },
            to_exit: flag(input.has_to_exit)?.then_some(Millimetres(input.to_exit_mm)),
            moved: Millimetres(input.moved_mm),
        };
        let (state, permission) = permitted::step(permitted, state, heard);
        Ok((state, output(permission)))
    }
}
