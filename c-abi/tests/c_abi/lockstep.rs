//! The border beside the kernel itself, without the oracle: configurations and inputs drawn from the limits of their
//! numbers,
//! one below and one above. What the kernel's constructors refuse is refused; what they take says the same in every
//! step.

use std::mem::MaybeUninit;
use std::ptr;

use atc_c::aspect::{atc_aspect, atc_aspect_config, atc_aspect_input, atc_aspect_output};
use atc_c::block::{
    ATC_BLOCK_CHECK_IN_AT_MAXIMUM, ATC_BLOCK_CHECK_IN_STAYS_ON, ATC_BLOCK_CHECK_OUT_AT_ZERO, ATC_BLOCK_COUNTING,
    ATC_BLOCK_UNVERIFIED, atc_block, atc_block_config, atc_block_input, atc_block_output,
};
use atc_c::interlocking::ATC_HEADING_NONE;
use atc_c::pattern::{atc_pattern_input, atc_pattern_output};
use atc_c::permitted::{atc_permitted, atc_permitted_config, atc_permitted_input, atc_permitted_output};
use atc_c::supervision::{atc_supervision, atc_supervision_config, atc_supervision_input, atc_supervision_output};
use atc_c::telegram::{ATC_TELEGRAM_NONE, atc_main_telegram, atc_sub_telegram};
use atc_c::train::{atc_code_pair, atc_train, atc_train_config, atc_train_input, atc_train_output};
use atc_c::{atc_status, border};
use atc_kernel::Machine;
use atc_kernel::aspect::{Acceptance, AspectId, AspectSet, AspectTable, Display, Times, TimesMs};
use atc_kernel::block::{self, Block, Fault, Hold, SectionSet, Status, TrainCount};
use atc_kernel::code::{CodeFrequencies, Millihertz};
use atc_kernel::distance::{Metres, Millimetres};
use atc_kernel::interlocking::{
    CircuitSet, Combined, Commands, Heading, Input, Large, Layout, Memory, Orders, PointId, Position, Positions,
    Request, RouteId, SegmentId, SegmentSet, Size, Small, SpeedCode, Travel,
};
use atc_kernel::pattern::{Deceleration, pattern};
use atc_kernel::permitted::{Heard, LineKind, Permission, Permitted, Settings};
use atc_kernel::position::{Millibels, Moved};
use atc_kernel::speed::{KmhTenths, RawKmhTenths};
use atc_kernel::supervision::{Brake, Speeds, Supervision};
use atc_kernel::telegram::{
    Counter, Deframer, Gradient, Length, Main, Route, SectionId, Sequence, Sub, Telegram, encode,
};
use atc_kernel::time::{Cycle, Millis};
use atc_kernel::train::{Antennas, Carrier, Train};
use atc_oracle::conform::random::Random;
use atc_protocol::machine::{position, train};
use atc_protocol::{Decibels, Metres as Metre};

use crate::arrays::{Arrays, InC};
use crate::call;
use crate::station;
use crate::wire;

/// Configurations of each machine, and steps with each.
const CONFIGS: u64 = 400;
const STEPS: usize = 60;

/// Draws numbers near the limits of what they mean.
struct Draw(Random);

impl Draw {
    fn number(&mut self, limits: &[i64]) -> i64 {
        let near = self.0.one_of(limits);
        if self.0.one_in(2) { near } else { near + self.0.between(-1, 1) }
    }

    /// One that fits into its type; 0 if it does not.
    fn fit<T: TryFrom<i64> + Default>(&mut self, limits: &[i64]) -> T {
        T::try_from(self.number(limits)).unwrap_or_default()
    }

    fn flag(&mut self) -> bool {
        self.0.one_in(2)
    }
}

/// So many random cases; how many configurations were taken.
fn cases(name: &str, mut case: impl FnMut(&mut Draw) -> bool) {
    let mut draw = Draw(Random::of(20_261_125, name, 0));
    let taken = (0..CONFIGS).filter(|_| case(&mut draw)).count();
    println!("{name}: {CONFIGS} configurations, {taken} of them taken, {STEPS} steps each");
    assert!(taken >= 40, "too few say little: {taken}");
}

fn number(brake: Brake) -> u32 {
    match brake {
        Brake::Release => 0,
        Brake::Service => 1,
        Brake::Emergency => 2,
    }
}

#[test]
fn supervision() {
    cases("supervision", |draw| {
        let (maximum, margin) = (draw.fit(&[0, 1, 4000, 65535]), draw.fit(&[0, 5, 4000]));
        let config = atc_supervision_config { maximum, margin };
        let kernel = Supervision::new(KmhTenths(maximum), KmhTenths(margin));
        let started = call::start::<atc_supervision, _>(border::atc_supervision_start, &config);
        assert_eq!(started.is_ok(), kernel.is_ok(), "{config:?}");
        let (Ok(mut state), Ok(machine)) = (started, kernel) else { return false };
        let mut before = machine.initial();
        let (top, margin) = (i64::from(maximum), i64::from(margin));
        let limits = [0, margin, top, top - margin, i32::MIN.into(), i32::MAX.into(), i64::from(i32::MAX) - margin];
        for _ in 0..STEPS {
            let (measured, permitted) = (draw.fit(&limits), draw.fit(&limits));
            let there = (!draw.0.one_in(8), !draw.0.one_in(8));
            let input = atc_supervision_input {
                measured,
                permitted,
                has_measured: there.0.into(),
                has_permitted: there.1.into(),
            };
            let speeds = Speeds {
                measured: there.0.then_some(RawKmhTenths(measured)),
                permitted: there.1.then_some(RawKmhTenths(permitted)),
            };
            let (next, brake) = machine.step(before, speeds);
            before = next;
            let said = call::step(border::atc_supervision_step, &mut *state, &input);
            let expected = atc_supervision_output { brake: number(brake) };
            assert_eq!(said, (atc_status::Ok, expected), "{config:?} {input:?}");
        }
        true
    });
}

fn shown(table: &AspectTable, display: Display) -> atc_aspect_output {
    let aspect = display.aspect();
    aspect.map_or(atc_aspect_output::default(), |aspect| atc_aspect_output {
        displayed: 1,
        rank: aspect.rank(),
        speed: table.speed(aspect).expect("only aspects of the line are heard").0,
    })
}

#[test]
fn aspect() {
    cases("aspect", |draw| {
        let mut speeds = [0_u16; 16];
        let wrong = draw.0.one_in(16);
        for rank in 1..16 {
            speeds[rank] = speeds[rank - 1] + u16::from(!wrong || !draw.0.one_in(8)) * draw.fit::<u16>(&[1, 50]).max(1);
        }
        let config = atc_aspect_config {
            cycle_ms: draw.fit(&[1, 10, 10, 10]),
            operate_ms: draw.fit(&[10, 30, 300, 600_000]),
            recovery_ms: draw.fit(&[10, 40, 400]),
            mask_ms: draw.fit(&[0, 40, 400, 599_990]),
            interruption_ms: draw.fit(&[0, 80, 800]),
            shortened_operate_ms: draw.fit(&[1, 10, 20]),
            aspect_count: draw.fit(&[1, 4, 16, 16]),
            speeds,
        };
        let count = usize::try_from(config.aspect_count).expect("it is small");
        let table = AspectTable::new(&[&speeds.map(KmhTenths)[..], &[KmhTenths(65535)]].concat()[..count]);
        let times = TimesMs {
            operate: Millis(config.operate_ms),
            recovery: Millis(config.recovery_ms),
            mask: Millis(config.mask_ms),
            interruption: Millis(config.interruption_ms),
            shortened_operate: Millis(config.shortened_operate_ms),
        };
        let times = Times::from_millis(Millis(config.cycle_ms), times);
        let started = call::start::<atc_aspect, _>(border::atc_aspect_start, &config);
        assert_eq!(started.is_ok(), table.is_ok() && times.is_ok(), "{config:?}");
        let (Ok(mut state), Ok(table), Ok(times)) = (started, table, times) else { return false };
        let machine = Acceptance::<16> { times };
        let mut before = machine.initial();
        let all = u16::MAX >> (16 - count);
        let mut detected = 0;
        for _ in 0..STEPS {
            if draw.0.one_in(5) {
                detected = draw.fit::<u16>(&[0, 1, 3, 9, 0xFFFF]) & all;
            }
            let (next, display) = machine.step(before, AspectSet::from_bits(detected));
            before = next;
            let said = call::step(border::atc_aspect_step, &mut *state, &atc_aspect_input { detected });
            assert_eq!(said, (atc_status::Ok, shown(&table, display)), "{config:?}");
            if count < 16 {
                let unknown = atc_aspect_input { detected: detected | 1 << count };
                let said = call::step(border::atc_aspect_step, &mut *state, &unknown);
                assert_eq!(said, (atc_status::UnknownAspect, atc_aspect_output::default()));
            }
        }
        true
    });
}

fn counted(output: block::Output) -> atc_block_output {
    atc_block_output {
        status: match output.status {
            Status::Unverified => ATC_BLOCK_UNVERIFIED,
            Status::Counting => ATC_BLOCK_COUNTING,
            Status::Fault(Fault::CheckOutAtZero) => ATC_BLOCK_CHECK_OUT_AT_ZERO,
            Status::Fault(Fault::CheckInAtMaximum) => ATC_BLOCK_CHECK_IN_AT_MAXIMUM,
            Status::Fault(Fault::CheckInStaysOn) => ATC_BLOCK_CHECK_IN_STAYS_ON,
        },
        occupied: output.occupied.bits(),
        behind_hold_sections: output.behind_hold.sections(),
        agree: output.agree.into(),
        count: output.count.0,
        counted_in: output.counted_in.into(),
        counted_out: output.counted_out.into(),
    }
}

#[test]
fn block() {
    cases("block", |draw| {
        let config = atc_block_config {
            cycle_ms: draw.fit(&[1, 10]),
            pass_ms: draw.fit(&[10, 30, 60_000, 600_000]),
            sections: draw.fit(&[1, 3, 16]),
            max_trains: draw.fit(&[1, 2, 3]),
            tail_hold_sections: draw.fit(&[0, 1, 16]),
        };
        let hold = Hold::new(config.tail_hold_sections);
        let (cycle, pass) = (Millis(config.cycle_ms), Millis(config.pass_ms));
        let kernel =
            hold.and_then(|hold| Block::from_millis(config.sections, config.max_trains, hold, cycle, pass).ok());
        let started = call::start::<atc_block, _>(border::atc_block_start, &config);
        assert_eq!(started.is_ok(), kernel.is_some(), "{config:?}");
        let (Ok(mut state), Some(machine)) = (started, kernel) else { return false };
        let mut before = machine.initial();
        for _ in 0..STEPS {
            let input = atc_block_input {
                present: draw.fit::<u16>(&[0, 0, 1, 3, 0xFFFF]) & machine.all().bits(),
                check_in: draw.flag().into(),
                check_out: draw.0.one_in(3).into(),
                has_reset: draw.0.one_in(3).into(),
                reset: draw.fit(&[0, 1, 2, 255]),
                ahead_hold_sections: draw.fit(&[0, 1, 16]),
                ahead_entered: draw.flag().into(),
            };
            let said = call::step(border::atc_block_step, &mut *state, &input);
            let Some(ahead_hold) = Hold::new(input.ahead_hold_sections) else {
                assert_eq!(said, (atc_status::HoldTooLong, counted(Block::SAFE)));
                continue;
            };
            let read = block::Input {
                check_in: input.check_in == 1,
                check_out: input.check_out == 1,
                present: SectionSet::from_bits(input.present),
                reset: (input.has_reset == 1).then_some(TrainCount(input.reset)),
                ahead_hold,
                ahead_entered: input.ahead_entered == 1,
            };
            let (next, output) = machine.step(before, read);
            before = next;
            assert_eq!(said, (atc_status::Ok, counted(output)), "{config:?} {input:?}");
        }
        true
    });
}

#[test]
fn braking_pattern() {
    let mut draw = Draw(Random::of(20_261_125, "pattern", 0));
    for _ in 0..CONFIGS * 50 {
        let input = atc_pattern_input {
            brake_mm_s2: draw.fit(&[0, 1, 800, 4095, 4096, 65535]),
            distance_m: draw.fit(&[0, 1, 250, 2500, 65535]),
            gradient_permille: draw.fit(&[-128, -81, -35, 0, 127]),
        };
        let said = call::ask(border::atc_pattern, &input);
        let expected = Deceleration::brake(input.brake_mm_s2).map_or(
            (atc_status::BadBrake, atc_pattern_output { speed: 0 }),
            |brake| {
                let speed = pattern(brake.on(Gradient(input.gradient_permille)), Metres(input.distance_m));
                (atc_status::Ok, atc_pattern_output { speed: speed.0 })
            },
        );
        assert_eq!(said, expected, "{input:?}");
    }
}

fn may(permission: Permission) -> atc_permitted_output {
    // In the kernel's order.
    let basis = permission.basis as u32;
    let speed = permission.speed.map_or(0, |speed| speed.0);
    atc_permitted_output { basis, speed, has_speed: permission.speed.is_some().into() }
}

fn permitted_config(draw: &mut Draw) -> atc_permitted_config {
    let mut speeds = [0; 16];
    for (rank, speed) in (0_u16..).zip(&mut speeds) {
        *speed = rank * 70;
    }
    atc_permitted_config {
        cycle_ms: draw.fit(&[10, 10, 10, 1]),
        fresh_ms: draw.fit(&[40, 50]),
        life_ms: draw.fit(&[60, 100, 600_000]),
        fixed_life_ms: draw.fit(&[60, 200, 600_000]),
        memory_ms: draw.fit(&[20, 30, 60]),
        speed_count: draw.fit(&[4, 15]),
        speeds,
        brake_mm_s2: draw.fit(&[1, 800, 4095]),
        margin_m: draw.fit(&[0, 10]),
        lowest_rank: draw.fit(&[0, 3]),
        worst_gradient_permille: draw.fit(&[-128, -35, 0]),
        window: draw.fit(&[1, 3, 127]),
        run: draw.fit(&[1, 1, 2, 15]),
    }
}

fn settings(config: &atc_permitted_config) -> Option<Permitted> {
    let cycle = Cycle::new(Millis(config.cycle_ms))?;
    let time = |ms| cycle.at_most(Millis(ms));
    let count = usize::try_from(config.speed_count).ok()?;
    Permitted::new(Settings {
        speeds: AspectTable::new(config.speeds.map(KmhTenths).get(..count)?).ok()?,
        lowest: AspectId::new(config.lowest_rank)?,
        brake: Deceleration::brake(config.brake_mm_s2)?,
        worst: Gradient(config.worst_gradient_permille),
        margin: Metres(config.margin_m),
        fresh: time(config.fresh_ms)?,
        life: time(config.life_ms)?,
        fixed_life: time(config.fixed_life_ms)?,
        sequence: Sequence::new(config.window, config.run, time(config.memory_ms)?).ok()?,
    })
    .ok()
}

fn main(main: atc_main_telegram) -> Option<Main> {
    let beyond = Metres(main.beyond_exit_m);
    let route = match main.route_open {
        1 => Route::OpenFor(beyond),
        _ if beyond.0 == 0 => Route::Closed,
        _ => return None,
    };
    let (section, counter) = (SectionId(main.section), Counter(main.counter));
    Some(Main { section, counter, route, speed: AspectId::new(main.speed_rank)? })
}

fn sub(sub: atc_sub_telegram) -> Option<Sub> {
    Some(Sub {
        section: SectionId(sub.section),
        counter: Counter(sub.counter),
        length: Length::new(Metres(sub.length_m))?,
        gradient: Gradient(sub.gradient_permille),
        curve: AspectId::new(sub.curve_rank)?,
        restriction: AspectId::new(sub.restriction_rank)?,
    })
}

fn permitted_input(draw: &mut Draw, section: u16, counter: u8) -> atc_permitted_input {
    atc_permitted_input {
        line: draw.fit(&[0, 0, 0, 0, 1, 2]),
        to_exit_mm: draw.fit(&[0, 1000, 100_000, u32::MAX.into()]),
        moved_mm: if draw.0.one_in(32) { u32::MAX } else { draw.fit(&[0, 500]) },
        main_data: atc_main_telegram {
            section,
            beyond_exit_m: draw.fit(&[0, 400, 65535]),
            counter,
            route_open: (!draw.0.one_in(16)).into(),
            speed_rank: draw.fit(&[3, 3, 14]),
        },
        sub_data: atc_sub_telegram {
            section,
            length_m: draw.fit(&[1, 250, 250]),
            counter,
            gradient_permille: draw.fit(&[-128, 0, 127]),
            curve_rank: draw.fit(&[2, 3]),
            restriction_rank: draw.fit(&[3, 14]),
        },
        analog: draw.fit(&[0, 450, 65535]),
        has_analog: draw.flag().into(),
        has_main: (!draw.0.one_in(4)).into(),
        // Rarely: at a border the target of the section behind counts until one comes.
        has_sub: draw.0.one_in(8).into(),
        has_to_exit: draw.flag().into(),
    }
}

#[test]
fn permitted_speed() {
    cases("permitted", |draw| {
        let config = permitted_config(draw);
        let kernel = settings(&config);
        let started = call::start::<atc_permitted, _>(border::atc_permitted_start, &config);
        assert_eq!(started.is_ok(), kernel.is_some(), "{config:?}");
        let (Ok(mut state), Some(machine)) = (started, kernel) else { return false };
        let mut before = machine.initial();
        let (mut section, mut counter) = (7, 0_u8);
        for _ in 0..STEPS {
            counter = counter.wrapping_add(draw.fit(&[1, 1, 3]));
            if draw.0.one_in(10) {
                section = draw.fit(&[7, 8]);
            }
            let input = permitted_input(draw, section, counter);
            let said = call::step(border::atc_permitted_step, &mut *state, &input);
            let line = match input.line {
                0 => Some(None),
                1 => Some(Some(LineKind::Analog)),
                2 => Some(Some(LineKind::Digital)),
                _ => None,
            };
            let main = if input.has_main == 1 { main(input.main_data).map(Some) } else { Some(None) };
            let sub = if input.has_sub == 1 { sub(input.sub_data).map(Some) } else { Some(None) };
            let (Some(line), Some(main), Some(sub)) = (line, main, sub) else {
                assert!(said.0 != atc_status::Ok && said.1 == may(Permitted::SAFE), "{input:?}: {said:?}");
                continue;
            };
            let heard = Heard {
                line,
                analog: (input.has_analog == 1).then_some(KmhTenths(input.analog)),
                main,
                sub,
                to_exit: (input.has_to_exit == 1).then_some(Millimetres(input.to_exit_mm)),
                moved: Millimetres(input.moved_mm),
            };
            let (next, permission) = machine.step(before, heard);
            before = next;
            assert_eq!(said, (atc_status::Ok, may(permission)), "{config:?} {input:?}");
        }
        true
    });
}

/// Whatever the antennas give: what C says is what the kernel says.
#[test]
fn on_board() {
    let given = train::Config { position: Some(table()), ..train::Config::default() };
    let device = given.train().expect("it is right");
    let config = wire::train_config(&given).expect("it has room");
    let mut state = call::start::<atc_train, _>(border::atc_train_start, &config).expect("it is right");
    let mut draw = Draw(Random::of(20_261_129, "on board", 0));
    let (mut memory, mut counter) = (device.initial(), 0_u8);
    let codes = device.parts().codes;
    let (mut permitted, mut located) = (0, 0);
    for cycle in 0..6000_u32 {
        let one_of = |draw: &mut Draw, codes: &CodeFrequencies, place: usize| {
            let nominal = codes.nominal()[place % codes.nominal().len()].0;
            let off: i64 = draw.number(&[0, 0, codes.tolerance().0.into(), -i64::from(codes.tolerance().0)]);
            let code = u32::try_from(i64::from(nominal) + off).unwrap_or(0);
            (!draw.0.one_in(40)).then_some(Millihertz(code))
        };
        let place = usize::try_from(cycle / 400).unwrap_or(0);
        let section = SectionId(if draw.0.one_in(20) { 9 } else { 8 });
        counter = counter.wrapping_add(1);
        let main = Main {
            section,
            counter: Counter(counter),
            route: Route::OpenFor(Metres(draw.fit(&[0, 400, 65_535]))),
            speed: AspectId::new(draw.fit(&[1, 3, 5])).expect("at most 15"),
        };
        let frame = draw.0.one_in(8).then(|| encode(Telegram::Main(main)));
        let level = |draw: &mut Draw, limit: i64| (!draw.0.one_in(10)).then(|| Millibels(draw.fit(&[limit, limit])));
        let antennas = Antennas {
            main: Carrier { code: one_of(&mut draw, codes.main(), place), frame },
            sub: Carrier { code: one_of(&mut draw, codes.sub(), place), frame: None },
            first: level(&mut draw, -2000),
            second: level(&mut draw, -2300),
            moved: (!draw.0.one_in(10)).then(|| Moved::new(0, draw.fit(&[0, 150, 200]))).flatten(),
            speed: (!draw.0.one_in(200)).then(|| RawKmhTenths(draw.fit(&[0, 200, 450]))),
            line: if cycle == 50 { Some(LineKind::Digital) } else { None },
            facing: (!draw.0.one_in(1000)).then_some(Heading::Right),
        };
        let (next, cab) = device.step(memory, antennas);
        memory = next;
        let (status, said) = call::step(border::atc_train_step, &mut *state, &wire::antennas(&antennas));
        assert_eq!(status, atc_status::Ok);
        let (nearest, farthest) = cab.position.map_or((0, 0), |at| (at.nearest().0, at.farthest().0));
        let expected = atc_train_output {
            brake: number(cab.brake),
            basis: cab.permission.basis as u32,
            nearest_mm: nearest,
            farthest_mm: farthest,
            display: cab.display.map_or(0, |speed| speed.0),
            permitted: cab.permission.speed.map_or(0, |speed| speed.0),
            has_display: cab.display.is_some().into(),
            has_permitted: cab.permission.speed.is_some().into(),
            has_position: cab.position.is_some().into(),
        };
        assert_eq!(said, expected, "cycle {cycle}");
        permitted += u32::from(said.has_permitted == 1);
        located += u32::from(said.has_position == 1);
    }
    println!("on board: 6000 steps, {permitted} with a permission, {located} with a position");
    assert!(permitted > 500 && located > 500, "{permitted} {located}");
}

/// A table that rises by a decibel and a half from one distance to the next.
fn table() -> position::Config {
    let curve = |first: i64| (0..17).map(|knot| Decibels(first + 150 * knot)).collect();
    position::Config {
        table: position::TableConfig { spacing_m: Metre(25_600), lowest_db: curve(0), highest_db: curve(100) },
        tolerance_db: Decibels(10),
        floor_db: Decibels(-6000),
        correction_db: [Decibels(0), Decibels(0)],
    }
}

/// Every rule that the parts of an on-board device break, alone or together, has its status.
#[test]
fn what_is_wrong_on_board() {
    type Break = (fn(&mut atc_train_config), atc_status);
    let given = train::Config { position: Some(table()), ..train::Config::default() };
    let right = wire::train_config(&given).expect("it has room");
    let start = |config: &atc_train_config| call::start::<atc_train, _>(border::atc_train_start, config).err();
    assert_eq!(start(&right), None);
    let cases: [Break; 19] = [
        (|config| config.permitted.cycle_ms = 0, atc_status::NoCycle),
        (|config| config.permitted.speed_count = 17, atc_status::TooManySpeeds),
        (|config| config.operate_ms = 0, atc_status::NoOperateTime),
        (|config| config.code_count = 0, atc_status::NoCodes),
        (|config| config.code_count = 65, atc_status::TooManyCodes),
        (|config| config.code_tolerance_millihertz = 1_000_000, atc_status::CodeOutOfRange),
        (|config| config.codes[0].main_millihertz = u32::MAX, atc_status::CodeOutOfRange),
        (|config| config.codes[1].main_millihertz = config.codes[0].main_millihertz + 1, atc_status::CodeBandsTouch),
        (|config| config.codes[1] = config.codes[0], atc_status::CodePairTwice),
        (|config| config.codes[0].speed = 1, atc_status::UnknownCodeSpeed),
        (|config| config.supervision.maximum = 0, atc_status::NoMaximum),
        (|config| config.supervision.maximum = 100, atc_status::ImplausibleSpeed),
        (|config| config.has_position = 2, atc_status::BadFlag),
        (|config| config.position.spacing_exponent = 12, atc_status::BadSpacing),
        (|config| config.position.lowest[3] = i16::MAX, atc_status::TableCrossed),
        (
            |config| (config.position.lowest, config.position.highest) = ([0; 17], [0; 17]),
            atc_status::TableNowhereRising,
        ),
        (|config| config.position.tolerance = -1, atc_status::BadTolerance),
        (|config| config.position.correction_least = 1, atc_status::BadCorrection),
        (
            |config| {
                config.code_count = 9;
                for (pair, code) in config.codes.iter_mut().zip(1..=9) {
                    *pair = atc_code_pair { main_millihertz: 10_000 * code, sub_millihertz: 10_000, speed: 450 };
                }
            },
            atc_status::TooManyCodes,
        ),
    ];
    for (number, (break_it, status)) in cases.into_iter().enumerate() {
        let mut config = right;
        break_it(&mut config);
        assert_eq!(start(&config), Some(status), "case {number}");
    }
}

/// What is wrong in one step is refused, and the device stands.
#[test]
fn what_is_wrong_in_a_step_on_board() {
    type Break = (fn(&mut atc_train_input), atc_status);
    let cases: [Break; 5] = [
        (|input| (input.has_moved, input.moved_least_mm, input.moved_most_mm) = (1, 1, 0), atc_status::BadMovement),
        (|input| (input.has_main_frame, input.main_frame.bits[7]) = (1, 2), atc_status::BadBit),
        (|input| input.facing = 3, atc_status::UnknownChoice),
        (|input| input.line = 3, atc_status::UnknownChoice),
        (|input| input.has_speed = 2, atc_status::BadFlag),
    ];
    let config = wire::train_config(&train::Config::default()).expect("it has room");
    let mut state = call::start::<atc_train, _>(border::atc_train_start, &config).expect("it is right");
    for (number, (break_it, status)) in cases.into_iter().enumerate() {
        let (mut input, before) = (wire::antennas(&wire::NOTHING_HEARD), state.opaque);
        break_it(&mut input);
        let (found, said) = call::step(border::atc_train_step, &mut *state, &input);
        let safe = atc_train_output { brake: 2, ..atc_train_output::default() };
        assert_eq!((found, said, state.opaque), (status, safe, before), "case {number}");
    }
}

/// How many cycles a train waits at one signal.
const PATIENCE: usize = 40;

/// How many circuits, points, routes and segments there are.
type Counts = (usize, usize, usize, usize);

/// Random requests, orders, occupation and consent; the points stand as `detected` says.
fn drawn<Z: Size>(random: &mut Random, cycle: usize, counts: Counts, detected: Positions<Z>) -> Input<Z> {
    let (circuits, points, routes, segments) = counts;
    let mut number = |most: usize| u8::try_from(random.below(most)).unwrap_or(0);
    let request = match number(8) {
        0..=2 => RouteId::new(number(routes)).map(Request::Set),
        3 => RouteId::new(number(routes)).map(Request::Withdraw),
        4 => PointId::new(number(points)).map(|point| Request::Drive(point, Position::Reverse)),
        5 => SegmentId::new(number(segments)).map(|segment| Request::Turn(segment, Travel::Toward)),
        6 => SegmentId::new(number(segments)).map(|segment| Request::Turn(segment, Travel::Away)),
        _ => None,
    };
    let mut one_in = |cycles: u64| {
        let (wanted, number) = (random.one_in(cycles), random.below(circuits));
        CircuitSet::nth(number).only_if(wanted)
    };
    let all = (0..circuits).fold(CircuitSet::EMPTY, |all, number| all.or(CircuitSet::nth(number)));
    let all = all.only_if(cycle % 16 == 0);
    let occupied = one_in(24).or(one_in(48));
    let orders = Orders {
        block: one_in(48),
        unblock: all,
        restrict: one_in(8),
        speed: SpeedCode(u8::try_from(cycle % 8).unwrap_or(0)),
        lift: all,
    };
    let permitted = (0..segments).filter(|_| random.one_in(2));
    let consent = permitted.fold(SegmentSet::EMPTY, |all, number| all.or(SegmentSet::nth(number)));
    Input { occupied, detected, request, orders, consent }
}

/// The border of one size beside the kernel: `step` steps the state that was started with `arrays`.
fn beside<const R: usize, const P: usize, const N: usize, const S: usize, Z: InC>(
    (arrays, layout): (&Arrays<Z>, &Layout<R, P, N, S, Z>),
    cycles: usize,
    mut step: impl FnMut(&station::InputOf<Z>) -> (atc_status, station::OutputOf<R, Z>),
) {
    let mut random = Random::of(20_261_125, "interlocking", 0);
    let mut memory = Box::new(Memory::INITIAL);
    let there = (arrays.lengths_m.len(), arrays.detectors.len(), arrays.routes.len(), arrays.segments.len());
    let (mut held, mut granted, mut detected) = (0, 0, Positions::NONE);
    let mut way = 0;
    for cycle in 0..cycles {
        let mut read = drawn(&mut random, cycle, there, detected);
        // A train waits at a signal until its route is set.
        if cycle % PATIENCE == 0 {
            way = random.below(there.2);
            read.request = RouteId::new(u8::try_from(way).unwrap_or(0)).map(Request::Set);
        }
        read.occupied = read.occupied.or(layout.plan().routes[way].entry);
        let (next, commands) = Combined(layout).step(*memory, read);
        *memory = next;
        // Most points arrive at once.
        let driven = commands.interlocking.drives;
        detected = detected.without(driven.points()).or(driven.only_if(!random.one_in(4)));
        held += memory.interlocking.routes.iter().filter(|route| route.is_held()).count();
        let (status, said) = step(&station::input(&read));
        assert_eq!(status, atc_status::Ok);
        granted += said.telegrams.iter().filter(|telegram| telegram.heading != ATC_HEADING_NONE).count();
        station::compare(there.0, &said, &memory, &commands);
    }
    println!(
        "interlocking, {} routes: {cycles} steps, {held} routes held and {granted} trains let go in them",
        there.2
    );
    assert!(held > cycles / 4 && granted > 20, "a device that does nothing says little: {held}, {granted}");
}

/// On the passing loop.
#[test]
fn interlocking() {
    let (arrays, layout) = station::passing_loop();
    let mut state = station::start(&arrays).expect("it keeps every rule");
    beside((&arrays, &layout), 1500, |input| call::step(border::atc_interlocking_step, &mut *state, input));
}

/// On the station of 100 routes.
#[test]
fn large_interlocking() {
    station::on_a_large_stack(|| {
        let (arrays, layout) = station::hundred_routes();
        let mut state = station::start_large(&arrays).expect("it keeps every rule");
        let step = border::atc_large_interlocking_step;
        beside((&arrays, &layout), 120, |input| call::step(step, &mut *state, input));
    });
}

/// A start that fails leaves no state, also where it is told of too little memory for one.
#[test]
fn a_failed_start_leaves_no_state() {
    let config = wire::train_config(&train::Config::default()).expect("it has room");
    for size in [1, 7, 8, 23, 24, size_of::<atc_train>() - 1] {
        let mut state = call::start::<atc_train, _>(border::atc_train_start, &config).expect("it is right");
        // SAFETY: `size` bytes of this function's, and a configuration.
        let status = unsafe { border::atc_train_start((&raw mut *state).cast(), size, &raw const config) };
        assert_eq!(status, atc_status::TooSmall);
        let heard = wire::antennas(&wire::NOTHING_HEARD);
        assert_eq!(call::step(border::atc_train_step, &mut *state, &heard).0, atc_status::NotStarted, "{size} bytes");
    }
}

/// What a call that fails puts out is the kernel's own safe output.
#[test]
fn the_safe_outputs_are_the_kernels() {
    fn safe<S, I, O>(step: call::Step<S, I, O>) -> O {
        let mut output = MaybeUninit::<O>::zeroed();
        // SAFETY: room for an output, and nothing else.
        let status = unsafe { step(ptr::null_mut(), ptr::null(), output.as_mut_ptr()) };
        assert_eq!(status, atc_status::Null);
        // SAFETY: all bytes were written; outputs are structures of numbers.
        unsafe { output.assume_init() }
    }
    assert_eq!(safe(border::atc_supervision_step).brake, number(Supervision::SAFE));
    let cab = <Train<16> as Machine>::SAFE;
    let expected = atc_train_output { brake: number(cab.brake), ..atc_train_output::default() };
    assert_eq!(safe(border::atc_train_step), expected);
    assert!(cab.display.is_none() && cab.permission.speed.is_none() && cab.position.is_none());
    assert_eq!(safe(border::atc_aspect_step).displayed == 1, Acceptance::<16>::SAFE.aspect().is_some());
    assert_eq!(safe(border::atc_block_step), counted(Block::SAFE));
    assert_eq!(safe(border::atc_permitted_step), may(Permitted::SAFE));
    assert_eq!(safe(border::atc_deframer_step).kind == ATC_TELEGRAM_NONE, Deframer::SAFE.is_none());
    let commands = <Combined<'_, 64, 16, 32, 8> as Machine>::SAFE;
    all_is_safe::<64, Small>(&safe(border::atc_interlocking_step), &commands);
    station::on_a_large_stack(|| {
        let commands = <Combined<'_, 256, 32, 128, 32, Large> as Machine>::SAFE;
        all_is_safe::<256, Large>(&safe(border::atc_large_interlocking_step), &commands);
    });
}

fn all_is_safe<const R: usize, Z: InC>(said: &station::OutputOf<R, Z>, commands: &Commands<R, Z>) {
    let output = &commands.interlocking;
    assert_eq!((said.proceed, said.confirmed), (Z::routes(output.proceed), Z::circuits(output.confirmed)));
    assert_eq!(said.drive_normal, Z::points(output.drives.normal));
    assert_eq!(said.drive_reverse, Z::points(output.drives.reverse));
    assert_eq!((said.permits, said.answer == 0), (Z::segments(output.permits), output.answer.is_none()));
    // The table of the safe output cannot be read: then every circuit counts as occupied.
    assert_eq!(said.occupied, Z::circuits(output.table.parts().2.occupied));
    assert_eq!(said.occupied, Z::circuits(CircuitSet::ALL));
    assert!(said.phases == [0; R] && said.telegrams.iter().all(|telegram| telegram.sent == 0));
    assert!(commands.telegrams.iter().all(Option::is_none));
}
