//! The protocol of `oracle serve`, spoken by the C border: so that what the oracle says of a step can be held
//! against it.

use atc_c::aspect::{atc_aspect, atc_aspect_config, atc_aspect_input};
use atc_c::atc_status;
use atc_c::block::{
    ATC_BLOCK_CHECK_IN_AT_MAXIMUM, ATC_BLOCK_CHECK_IN_STAYS_ON, ATC_BLOCK_CHECK_OUT_AT_ZERO, ATC_BLOCK_COUNTING,
    ATC_BLOCK_UNVERIFIED, atc_block, atc_block_config, atc_block_input,
};
use atc_c::border;
use atc_c::interlocking::ATC_HEADING_NONE;
use atc_c::pattern::atc_pattern_input;
use atc_c::permitted::{
    ATC_BASIS_ANALOG, ATC_BASIS_BOTH, ATC_BASIS_NOTHING, ATC_BASIS_PATTERN, ATC_BASIS_RUNNING_DOWN, ATC_LINE_ANALOG,
    ATC_LINE_DIGITAL, ATC_LINE_UNCHANGED, atc_permitted, atc_permitted_config, atc_permitted_input,
};
use atc_c::supervision::{
    ATC_BRAKE_EMERGENCY, ATC_BRAKE_RELEASE, ATC_BRAKE_SERVICE, atc_supervision, atc_supervision_config,
    atc_supervision_input,
};
use atc_c::telegram::{
    ATC_RECEPTION_NOTHING, ATC_TELEGRAM_MAIN, ATC_TELEGRAM_NONE, ATC_TELEGRAM_SUB, atc_deframer, atc_deframer_input,
    atc_frame, atc_main_telegram, atc_sub_telegram, atc_telegram,
};
use atc_c::train::{
    ATC_MAX_CODE_PAIRS, atc_code_pair, atc_position_config, atc_train, atc_train_config, atc_train_input,
};
use atc_kernel::block::SectionSet;
use atc_kernel::position::Moved;
use atc_kernel::telegram::Frame;
use atc_kernel::train::{Antennas, Carrier};
use atc_protocol::machine::permitted::{Basis, LineKind};
use atc_protocol::machine::supervision::Brake;
use atc_protocol::machine::{Machine, aspect, block, pattern, permitted, position, supervision, telegram, train};
use atc_protocol::telegrams::{MainTelegram, SubTelegram, Telegram};
use atc_protocol::{Decibels, Kmh, Metres, Sections};

use crate::arrays::heading;
use crate::call;

/// A machine of the oracle, and the same behind the border.
pub trait Spoken: Machine {
    /// The state of C.
    type State;

    /// Starts it; `None` if C's structures have no room for what is configured, which is then out of its range.
    fn start(config: &Self::Config) -> Option<Result<Self::State, atc_status>>;

    /// A step of a walk without what C has no words for.
    fn in_words(step: Self::Step) -> Self::Step {
        step
    }

    /// Steps it. A walk of the oracle has no step that a machine does not take.
    fn say(state: &mut Self::State, step: &Self::Step) -> Self::Output;
}

/// What does not fit is over every limit.
fn narrow(number: u32) -> u8 {
    u8::try_from(number).unwrap_or(u8::MAX)
}

/// As many speeds as fit into the array, and how many there are.
fn table(speeds: &[Kmh]) -> Option<([u16; 16], u32)> {
    let mut table = [0; 16];
    for (place, speed) in speeds.iter().enumerate() {
        let tenths = u16::try_from(speed.0).ok()?;
        if let Some(kept) = table.get_mut(place) {
            *kept = tenths;
        }
    }
    Some((table, u32::try_from(speeds.len()).ok()?))
}

fn ok<O>((status, output): (atc_status, O)) -> O {
    assert_eq!(status, atc_status::Ok);
    output
}

impl Spoken for aspect::Aspect {
    type State = (Box<atc_aspect>, Vec<Kmh>);

    fn start(config: &aspect::Config) -> Option<Result<Self::State, atc_status>> {
        let (speeds, aspect_count) = table(&config.aspects_km_h)?;
        let given = atc_aspect_config {
            cycle_ms: config.cycle_ms,
            operate_ms: config.operate_ms,
            recovery_ms: config.recovery_ms,
            mask_ms: config.mask_ms,
            interruption_ms: config.interruption_ms,
            shortened_operate_ms: config.shortened_operate_ms,
            aspect_count,
            speeds,
        };
        let started = call::start(border::atc_aspect_start, &given);
        Some(started.map(|state| (state, config.aspects_km_h.clone())))
    }

    fn say((state, speeds): &mut Self::State, step: &aspect::Step) -> aspect::Output {
        let heard = step.detected_km_h.iter().map(|heard| speeds.iter().position(|speed| speed == heard));
        let detected = heard.fold(0, |bits, rank| bits | 1 << rank.expect("the line has it"));
        let said = ok(call::step(border::atc_aspect_step, &mut **state, &atc_aspect_input { detected }));
        let speed = Kmh(said.speed.into());
        assert_eq!(speed, if said.displayed == 1 { speeds[usize::from(said.rank)] } else { Kmh(0) });
        aspect::Output { display_km_h: (said.displayed == 1).then_some(speed) }
    }
}

impl Spoken for supervision::Supervised {
    type State = Box<atc_supervision>;

    fn start(config: &supervision::Config) -> Option<Result<Self::State, atc_status>> {
        Some(call::start(border::atc_supervision_start, &supervision_config(config)?))
    }

    /// The previous command is the machine's own.
    fn in_words(step: supervision::Step) -> supervision::Step {
        supervision::Step { previous: None, ..step }
    }

    fn say(state: &mut Self::State, step: &supervision::Step) -> supervision::Output {
        let input = atc_supervision_input {
            // Not looked at where there is none.
            measured: step.speed_km_h.map_or(77, |speed| speed.0),
            permitted: step.permitted_km_h.map_or(-5, |speed| speed.0),
            has_measured: step.speed_km_h.is_some().into(),
            has_permitted: step.permitted_km_h.is_some().into(),
        };
        let said = ok(call::step(border::atc_supervision_step, &mut **state, &input));
        supervision::Output { brake: brake_of(said.brake) }
    }
}

impl Spoken for block::Counted {
    type State = Box<atc_block>;

    fn start(config: &block::Config) -> Option<Result<Self::State, atc_status>> {
        let given = atc_block_config {
            cycle_ms: config.cycle_ms,
            pass_ms: config.pass_ms,
            sections: narrow(config.sections),
            max_trains: narrow(config.max_trains),
            tail_hold_sections: narrow(config.tail_hold_sections),
        };
        Some(call::start(border::atc_block_start, &given))
    }

    fn say(state: &mut Self::State, step: &block::Step) -> block::Output {
        let input = atc_block_input {
            present: step.present.0.bits(),
            check_in: step.check_in.into(),
            check_out: step.check_out.into(),
            has_reset: step.reset.is_some().into(),
            reset: narrow(step.reset.unwrap_or(200)),
            ahead_hold_sections: narrow(step.ahead_hold_sections),
            ahead_entered: step.ahead_entered.into(),
        };
        let said = ok(call::step(border::atc_block_step, &mut **state, &input));
        block::Output {
            occupied: Sections(SectionSet::from_bits(said.occupied)),
            behind_hold_sections: said.behind_hold_sections,
            agree: said.agree == 1,
            count: said.count,
            fault: match said.status {
                ATC_BLOCK_UNVERIFIED | ATC_BLOCK_COUNTING => None,
                ATC_BLOCK_CHECK_OUT_AT_ZERO => Some(block::Fault::CheckOutAtZero),
                ATC_BLOCK_CHECK_IN_AT_MAXIMUM => Some(block::Fault::CheckInAtMaximum),
                ATC_BLOCK_CHECK_IN_STAYS_ON => Some(block::Fault::CheckInStaysOn),
                other => panic!("no status of a block: {other}"),
            },
            counting: Some(said.status == ATC_BLOCK_COUNTING),
        }
    }
}

impl Spoken for pattern::Braking {
    type State = u16;

    fn start(config: &pattern::Config) -> Option<Result<Self::State, atc_status>> {
        let brake_mm_s2 = u16::try_from(config.brake_mm_s2).ok()?;
        let input = atc_pattern_input { brake_mm_s2, distance_m: 0, gradient_permille: 0 };
        match call::ask(border::atc_pattern, &input) {
            (atc_status::Ok, _) => Some(Ok(brake_mm_s2)),
            (status, _) => Some(Err(status)),
        }
    }

    fn say(brake_mm_s2: &mut u16, step: &pattern::Step) -> pattern::Output {
        let input = atc_pattern_input {
            brake_mm_s2: *brake_mm_s2,
            distance_m: u16::try_from(step.distance_m).expect("within the range"),
            gradient_permille: i8::try_from(step.gradient_permille).expect("within the range"),
        };
        pattern::Output { speed_km_h: Kmh(ok(call::ask(border::atc_pattern, &input)).speed.into()) }
    }
}

fn main_of(main: &MainTelegram) -> atc_main_telegram {
    atc_main_telegram {
        section: u16::try_from(main.section).expect("within the range"),
        beyond_exit_m: main.beyond_exit_m.map_or(0, |beyond| u16::try_from(beyond).expect("within the range")),
        counter: narrow(main.counter),
        route_open: main.beyond_exit_m.is_some().into(),
        speed_rank: narrow(main.speed_rank),
    }
}

fn sub_of(sub: &SubTelegram) -> atc_sub_telegram {
    atc_sub_telegram {
        section: u16::try_from(sub.section).expect("within the range"),
        length_m: u16::try_from(sub.length_m).expect("within the range"),
        counter: narrow(sub.counter),
        gradient_permille: i8::try_from(sub.gradient_permille).expect("within the range"),
        curve_rank: narrow(sub.curve_rank),
        restriction_rank: narrow(sub.restriction_rank),
    }
}

/// The telegram of C in the words of the protocol; none if it is none.
fn words(telegram: &atc_telegram) -> Option<Telegram> {
    let atc_telegram { kind, main_data: main, sub_data: sub } = telegram;
    let expected = (*main == atc_main_telegram::default(), *sub == atc_sub_telegram::default());
    match *kind {
        ATC_TELEGRAM_NONE => {
            assert_eq!(expected, (true, true), "nothing is said where nothing is found");
            None
        }
        ATC_TELEGRAM_MAIN => {
            assert!(expected.1);
            Some(Telegram::Main(MainTelegram {
                section: main.section.into(),
                counter: main.counter.into(),
                beyond_exit_m: (main.route_open == 1).then_some(main.beyond_exit_m.into()),
                speed_rank: main.speed_rank.into(),
            }))
        }
        ATC_TELEGRAM_SUB => {
            assert!(expected.0);
            Some(Telegram::Sub(SubTelegram {
                section: sub.section.into(),
                counter: sub.counter.into(),
                length_m: sub.length_m.into(),
                gradient_permille: sub.gradient_permille.into(),
                curve_rank: sub.curve_rank.into(),
                restriction_rank: sub.restriction_rank.into(),
            }))
        }
        other => panic!("no kind of telegram: {other}"),
    }
}

impl Spoken for telegram::Codec {
    type State = (Box<atc_deframer>, u64);

    fn start(_: &telegram::Config) -> Option<Result<Self::State, atc_status>> {
        /// Without a configuration.
        unsafe extern "C" fn start(state: *mut core::ffi::c_void, size: usize, _: *const ()) -> atc_status {
            // SAFETY: that of this function.
            unsafe { border::atc_deframer_start(state, size) }
        }
        Some(call::start(start, &()).map(|state| (state, 0)))
    }

    fn say((state, heard): &mut Self::State, step: &telegram::Step) -> telegram::Output {
        match step {
            telegram::Step::Encode(asked) => {
                let given = match asked {
                    Telegram::Main(main) => {
                        atc_telegram { kind: ATC_TELEGRAM_MAIN, main_data: main_of(main), ..atc_telegram::default() }
                    }
                    Telegram::Sub(sub) => {
                        atc_telegram { kind: ATC_TELEGRAM_SUB, sub_data: sub_of(sub), ..atc_telegram::default() }
                    }
                };
                let frame = ok(call::ask(border::atc_telegram_encode, &given));
                telegram::Output::Frame { frame: frame.bits.map(|bit| char::from(b'0' + bit)).iter().collect() }
            }
            telegram::Step::Decode(text) => {
                let bits = text.bytes().map(|letter| letter - b'0').collect::<Vec<_>>();
                let frame = atc_frame { bits: bits.try_into().expect("a frame has 106 bits") };
                let (status, found) = call::ask(border::atc_telegram_decode, &frame);
                let error = match status {
                    atc_status::Ok => {
                        return telegram::Output::Telegram { telegram: words(&found).expect("a telegram is found") };
                    }
                    atc_status::FrameSynchronisation => telegram::FrameError::Synchronisation,
                    atc_status::FrameGuard => telegram::FrameError::Guard,
                    atc_status::FrameCheck => telegram::FrameError::Check,
                    atc_status::FrameContent => telegram::FrameError::Content,
                    other => panic!("no error of a frame: {other:?}"),
                };
                assert_eq!(words(&found), None);
                telegram::Output::Error { error }
            }
            telegram::Step::Bits(bits) => {
                let mut telegrams = Vec::new();
                for letter in bits.bytes() {
                    let reception = if letter == b'.' { ATC_RECEPTION_NOTHING } else { u32::from(letter - b'0') };
                    let input = atc_deframer_input { reception };
                    let found = words(&ok(call::step(border::atc_deframer_step, &mut **state, &input)));
                    telegrams.extend(found.map(|telegram| telegram::Found { last_bit: *heard, telegram }));
                    *heard += 1;
                }
                telegram::Output::Telegrams { telegrams }
            }
        }
    }
}

/// The parameters of the permitted speed as C has them; none if they have no room in it.
fn permitted_config(config: &permitted::Config) -> Option<atc_permitted_config> {
    let (speeds, speed_count) = table(&config.speeds_km_h)?;
    let lowest = config.speeds_km_h.iter().position(|speed| *speed == config.lowest_limit_km_h);
    Some(atc_permitted_config {
        cycle_ms: config.cycle_ms,
        fresh_ms: config.fresh_ms,
        life_ms: config.life_ms,
        fixed_life_ms: config.fixed_life_ms,
        memory_ms: config.memory_ms,
        speed_count,
        speeds,
        brake_mm_s2: u16::try_from(config.brake_mm_s2).ok()?,
        margin_m: u16::try_from(config.margin_m).ok()?,
        lowest_rank: lowest.and_then(|rank| u8::try_from(rank).ok()).unwrap_or(16),
        worst_gradient_permille: i8::try_from(config.worst_gradient_permille).ok()?,
        window: narrow(config.window),
        run: narrow(config.run),
    })
}

impl Spoken for permitted::Permitting {
    type State = Box<atc_permitted>;

    fn start(config: &permitted::Config) -> Option<Result<Self::State, atc_status>> {
        let given = permitted_config(config)?;
        Some(call::start(border::atc_permitted_start, &given))
    }

    fn say(state: &mut Self::State, step: &permitted::Step) -> permitted::Output {
        let heard = step.heard().expect("a walk has no other");
        let input = atc_permitted_input {
            line: line_of(step.line),
            // Not looked at where there is none.
            to_exit_mm: heard.to_exit.map_or(123_456, |length| length.0),
            moved_mm: heard.moved.0,
            main_data: step.main.as_ref().map(main_of).unwrap_or_default(),
            sub_data: step.sub.as_ref().map(sub_of).unwrap_or_default(),
            analog: heard.analog.map_or(4000, |speed| speed.0),
            has_analog: heard.analog.is_some().into(),
            has_main: step.main.is_some().into(),
            has_sub: step.sub.is_some().into(),
            has_to_exit: heard.to_exit.is_some().into(),
        };
        let said = ok(call::step(border::atc_permitted_step, &mut **state, &input));
        assert!(said.has_speed == 1 || said.speed == 0);
        permitted::Output {
            speed_km_h: (said.has_speed == 1).then_some(Kmh(said.speed.into())),
            basis: basis_of(said.basis),
            state: None,
        }
    }
}

fn line_of(line: Option<LineKind>) -> u32 {
    match line {
        None => ATC_LINE_UNCHANGED,
        Some(LineKind::Analog) => ATC_LINE_ANALOG,
        Some(LineKind::Digital) => ATC_LINE_DIGITAL,
    }
}

fn basis_of(basis: u32) -> Basis {
    match basis {
        ATC_BASIS_NOTHING => Basis::Nothing,
        ATC_BASIS_ANALOG => Basis::Analog,
        ATC_BASIS_PATTERN => Basis::Pattern,
        ATC_BASIS_BOTH => Basis::Both,
        ATC_BASIS_RUNNING_DOWN => Basis::RunningDown,
        other => panic!("no basis: {other}"),
    }
}

fn brake_of(brake: u32) -> Brake {
    match brake {
        ATC_BRAKE_RELEASE => Brake::Release,
        ATC_BRAKE_SERVICE => Brake::Service,
        ATC_BRAKE_EMERGENCY => Brake::Emergency,
        other => panic!("no brake command: {other}"),
    }
}

fn supervision_config(config: &supervision::Config) -> Option<atc_supervision_config> {
    let maximum = u16::try_from(config.maximum_km_h.0).ok()?;
    let margin = u16::try_from(config.release_margin_km_h.0).ok()?;
    Some(atc_supervision_config { maximum, margin })
}

fn position_config(config: &position::Config) -> Option<atc_position_config> {
    let level = |level: &Decibels| i16::try_from(level.0).ok();
    let curve = |levels: &[Decibels]| levels.iter().map(level).collect::<Option<Vec<_>>>()?.try_into().ok();
    let spacing = (0..32).find(|exponent| 100 << exponent == config.table.spacing_m.0);
    let [least, most] = &config.correction_db;
    Some(atc_position_config {
        lowest: curve(&config.table.lowest_db)?,
        highest: curve(&config.table.highest_db)?,
        tolerance: level(&config.tolerance_db)?,
        floor: level(&config.floor_db)?,
        correction_least: level(least)?,
        correction_most: level(most)?,
        spacing_exponent: spacing?,
    })
}

/// The parameters of the on-board device as C has them; none if they have no room in it.
pub fn train_config(config: &train::Config) -> Option<atc_train_config> {
    let mut codes = [atc_code_pair::default(); ATC_MAX_CODE_PAIRS];
    for (place, pair) in config.codes.pairs.iter().enumerate() {
        let given = atc_code_pair {
            main_millihertz: u32::try_from(pair.main_hz.0).ok()?,
            sub_millihertz: u32::try_from(pair.sub_hz.0).ok()?,
            speed: u16::try_from(pair.speed_km_h.0).ok()?,
        };
        if let Some(kept) = codes.get_mut(place) {
            *kept = given;
        }
    }
    Some(atc_train_config {
        permitted: permitted_config(&config.permitted)?,
        operate_ms: config.acceptance.operate_ms,
        recovery_ms: config.acceptance.recovery_ms,
        mask_ms: config.acceptance.mask_ms,
        interruption_ms: config.acceptance.interruption_ms,
        shortened_operate_ms: config.acceptance.shortened_operate_ms,
        code_tolerance_millihertz: u32::try_from(config.codes.tolerance_hz.0).ok()?,
        code_count: u32::try_from(config.codes.pairs.len()).ok()?,
        codes,
        supervision: supervision_config(&config.supervision)?,
        position: match &config.position {
            Some(position) => position_config(position)?,
            None => atc_position_config::default(),
        },
        has_position: config.position.is_some().into(),
    })
}

/// A train to which nothing is said.
pub const NOTHING_HEARD: Antennas = Antennas {
    main: Carrier { code: None, frame: None },
    sub: Carrier { code: None, frame: None },
    first: None,
    second: None,
    moved: None,
    speed: None,
    line: None,
    facing: None,
};

/// What the antennas give, as C has it.
pub fn antennas(antennas: &Antennas) -> atc_train_input {
    // Not looked at where there is none.
    let frame = |frame: Option<Frame>| {
        let bits = frame.map(Frame::bits);
        atc_frame { bits: std::array::from_fn(|place| bits.map_or(7, |bits| u8::from(bits >> (105 - place) & 1 == 1))) }
    };
    let Antennas { main, sub, first, second, moved, speed, line, facing } = *antennas;
    atc_train_input {
        main_code_millihertz: main.code.map_or(17_000, |code| code.0),
        sub_code_millihertz: sub.code.map_or(u32::MAX, |code| code.0),
        line: line_of(line.map(|line| match line {
            atc_kernel::permitted::LineKind::Analog => LineKind::Analog,
            atc_kernel::permitted::LineKind::Digital => LineKind::Digital,
        })),
        speed: speed.map_or(-7, |speed| speed.0),
        main_frame: frame(main.frame),
        sub_frame: frame(sub.frame),
        first: first.map_or(1, |level| level.0),
        second: second.map_or(-1, |level| level.0),
        moved_least_mm: moved.map_or(5, Moved::least),
        moved_most_mm: moved.map_or(-5, Moved::most),
        facing: facing.map_or(ATC_HEADING_NONE, heading),
        has_main_code: main.code.is_some().into(),
        has_sub_code: sub.code.is_some().into(),
        has_main_frame: main.frame.is_some().into(),
        has_sub_frame: sub.frame.is_some().into(),
        has_first: first.is_some().into(),
        has_second: second.is_some().into(),
        has_moved: moved.is_some().into(),
        has_speed: speed.is_some().into(),
    }
}

impl Spoken for train::OnBoard {
    type State = Box<atc_train>;

    fn start(config: &train::Config) -> Option<Result<Self::State, atc_status>> {
        // C has one channel; two that are compared say the same where neither loses its memory.
        if config.channels.is_some_and(|channels| !(1..=2).contains(&channels)) {
            return None;
        }
        Some(call::start(border::atc_train_start, &train_config(config)?))
    }

    fn in_words(step: train::Step) -> train::Step {
        train::Step { lost: Vec::new(), ..step }
    }

    fn say(state: &mut Self::State, step: &train::Step) -> train::Output {
        let given = antennas(&step.antennas().expect("a walk has no other"));
        let said = ok(call::step(border::atc_train_step, &mut **state, &given));
        assert!(said.has_display == 1 || said.display == 0);
        assert!(said.has_permitted == 1 || said.permitted == 0);
        assert!(said.has_position == 1 || (said.nearest_mm, said.farthest_mm) == (0, 0));
        let metres = |mm: u32| Metres(mm.into());
        train::Output {
            display_km_h: (said.has_display == 1).then_some(Kmh(said.display.into())),
            permitted_km_h: (said.has_permitted == 1).then_some(Kmh(said.permitted.into())),
            basis: basis_of(said.basis),
            position_m: (said.has_position == 1).then_some([metres(said.nearest_mm), metres(said.farthest_mm)]),
            brake: brake_of(said.brake),
        }
    }
}
