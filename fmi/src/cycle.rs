//! One logic cycle: the values of the inputs as a step of the protocol, and its output as values.

use atc_protocol::decimal::{Decibels, Hertz, Metres};
use atc_protocol::kmh::Kmh;
use atc_protocol::machine::permitted::Basis;
use atc_protocol::machine::supervision::Brake;
use atc_protocol::machine::train::{Carrier, Channel, Output, Step};
use atc_protocol::names::Named;
use atc_protocol::telegrams::{MainTelegram, SubTelegram, Telegram};

use crate::rounding::{down, nearest, up, value};
use crate::variables::{BASIS, BRAKE, FACING, FRAME_BYTES, Kind, LINE, Place, VARIABLES, Value, Values, Words};

/// The bits of a frame.
const FRAME_BITS: usize = 106;
/// How many parts of what is read make one unit.
const TENTHS: f64 = 10.0;
const HUNDREDTHS: f64 = 100.0;
const THOUSANDTHS: f64 = 1000.0;

/// The step that the inputs say. What a Boolean says is not there is not looked at.
///
/// # Errors
/// The first input that is refused: its name, its value and what would be right.
pub fn step(values: &Values) -> Result<Step, String> {
    let measured = |there: Place, number: Place| values.flag(there).then(|| within(values, number)).transpose();
    let level = |number| Decibels(nearest(number, HUNDREDTHS));
    let moved_m = if values.flag(Place::MovedMeasured) {
        let (least, most) = (within(values, Place::MovedLeast)?, within(values, Place::MovedMost)?);
        // The machine would name the rounded ones.
        if least > most {
            return Err(format!(
                "moved_least_m is {least} m and moved_most_m is {most} m; the least must not be greater"
            ));
        }
        Some([Metres(down(least, THOUSANDTHS)), Metres(up(most, THOUSANDTHS))])
    } else {
        None
    };
    Ok(Step {
        main: Carrier {
            code_hz: code(values, Place::MainCode)?,
            telegram: values.flag(Place::MainReceived).then(|| Telegram::Main(main(values))),
            frame: frame(values, Place::MainFrame)?,
        },
        sub: Carrier {
            code_hz: code(values, Place::SubCode)?,
            telegram: values.flag(Place::SubReceived).then(|| Telegram::Sub(sub(values))),
            frame: frame(values, Place::SubFrame)?,
        },
        first_db: measured(Place::FirstMeasured, Place::First)?.map(level),
        second_db: measured(Place::SecondMeasured, Place::Second)?.map(level),
        moved_m,
        speed_km_h: measured(Place::SpeedMeasured, Place::Speed)?.map(speed).transpose()?,
        line: named(values, Place::LineBegins, LINE)?,
        facing: named(values, Place::Facing, FACING)?,
        lost: [(Place::LostA, Channel::A), (Place::LostB, Channel::B)]
            .into_iter()
            .filter_map(|(place, channel)| values.flag(place).then_some(channel))
            .collect(),
    })
}

/// The measured speed, never lower than it is.
fn speed(km_h: f64) -> Result<Kmh, String> {
    let tenths = i32::try_from(up(km_h, TENTHS));
    tenths.map(Kmh).map_err(|_| format!("speed_km_h is {km_h} km/h, which is beyond its range"))
}

/// The code frequency; 0 is none, and nothing is below it.
fn code(values: &Values, place: Place) -> Result<Option<Hertz>, String> {
    let hertz = within(values, place)?;
    Ok((hertz > 0.0).then(|| Hertz(nearest(hertz, THOUSANDTHS))))
}

/// A number within its range.
fn within(values: &Values, place: Place) -> Result<f64, String> {
    let (number, variable) = (values.number(place), VARIABLES[place as usize]);
    let Kind::Float64(unit, range) = variable.kind else { return Ok(number) };
    let [least, most] = range.unwrap_or([f64::MIN, f64::MAX]);
    if (least..=most).contains(&number) {
        return Ok(number);
    }
    Err(format!("{} is {number} {unit}; it must be {least} to {most} {unit}", variable.name))
}

/// The value with this name, or none.
fn named<T: Named>(values: &Values, place: Place, words: Words) -> Result<Option<T>, String> {
    let number = values.word(place);
    let word = usize::try_from(number).ok().and_then(|number| words.words.get(number));
    let word = word.ok_or_else(|| {
        let (name, last) = (VARIABLES[place as usize].name, words.words.len().saturating_sub(1));
        format!("{name} is {number}; it must be 0 to {last}: {}", words.words.join(", "))
    })?;
    Ok(T::EVERY.iter().copied().find(|value| value.name() == *word))
}

fn main(values: &Values) -> MainTelegram {
    let open = !values.flag(Place::MainClosed);
    MainTelegram {
        section: values.whole(Place::MainSection),
        counter: values.whole(Place::MainCounter),
        beyond_exit_m: open.then(|| values.whole(Place::MainBeyondExit)),
        speed_rank: values.whole(Place::MainSpeedRank),
    }
}

fn sub(values: &Values) -> SubTelegram {
    SubTelegram {
        section: values.whole(Place::SubSection),
        counter: values.whole(Place::SubCounter),
        length_m: values.whole(Place::SubLength),
        gradient_permille: values.signed(Place::SubGradient),
        curve_rank: values.whole(Place::SubCurveRank),
        restriction_rank: values.whole(Place::SubRestrictionRank),
    }
}

/// The bits of a frame as the protocol has them; none if there are no bytes.
fn frame(values: &Values, place: Place) -> Result<Option<String>, String> {
    let (bytes, name) = (values.bytes(place), VARIABLES[place as usize].name);
    if bytes.is_empty() {
        return Ok(None);
    }
    if bytes.len() != FRAME_BYTES {
        return Err(format!("{name} has {} bytes; it must have {FRAME_BYTES}, or 0 if there is none", bytes.len()));
    }
    let bits = bytes.iter().flat_map(|byte| (0..8).rev().map(move |place| byte >> place & 1 == 1));
    let mut bits: String = bits.map(|bit| if bit { '1' } else { '0' }).collect();
    if bits.split_off(FRAME_BITS).contains('1') {
        let spare = FRAME_BYTES * 8 - FRAME_BITS;
        return Err(format!("{name} has a 1 behind its {FRAME_BITS} bits; the last {spare} bits must be 0"));
    }
    Ok(Some(bits))
}

/// The outputs before the first step and after one that was refused: nothing displayed, nothing permitted, emergency brake.
pub const SAFE: Output = Output {
    display_km_h: None,
    permitted_km_h: None,
    basis: Basis::Nothing,
    position_m: None,
    brake: Brake::Emergency,
};

/// Writes the outputs among the values.
pub fn show(values: &mut Values, output: &Output) {
    let km_h = |speed: Option<Kmh>| value(speed.map_or(0, |speed| speed.0.into()), TENTHS);
    let [least, most] = output.position_m.unwrap_or_default().map(|end| value(end.0, THOUSANDTHS));
    let word = |words: Words, name: &str| {
        let place = words.words.iter().position(|word| *word == name).unwrap_or(0);
        Value::Enumeration(i64::try_from(place).unwrap_or(0))
    };
    for (place, value) in [
        (Place::DisplayShown, Value::Boolean(output.display_km_h.is_some())),
        (Place::Display, Value::Float64(km_h(output.display_km_h))),
        (Place::IsPermitted, Value::Boolean(output.permitted_km_h.is_some())),
        (Place::Permitted, Value::Float64(km_h(output.permitted_km_h))),
        (Place::Basis, word(BASIS, output.basis.name())),
        (Place::PositionKnown, Value::Boolean(output.position_m.is_some())),
        (Place::PositionLeast, Value::Float64(least)),
        (Place::PositionMost, Value::Float64(most)),
        (Place::Brake, word(BRAKE, output.brake.name())),
    ] {
        values.set(place, value);
    }
}
