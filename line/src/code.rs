//! The analog codes of a line: pairs of code frequencies, and the speeds that they name.

use atc_kernel::aspect::AspectTable;
use atc_kernel::code::{CodeError, CodeFrequencies, CodeTable, MAX_CODES, Millihertz};
use atc_kernel::speed::KmhTenths;

use crate::check::{DataCheck, Finding, Outcome};
use crate::decimal;
use crate::kmh::Kmh;
use crate::places::Places;
use crate::refusal::Refusal;
use crate::rule::Rule;

/// A pair of code frequencies in hertz and the speed in km/h that it names.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pair {
    /// The code of the main carrier: 0 to 1000 Hz in whole millihertz.
    pub main_hz: f64,
    /// The code of the sub carrier, in the same range.
    pub sub_hz: f64,
    /// The speed: 0 to 6553.5 km/h in whole tenths.
    pub speed_km_h: f64,
}

/// What the fields are called: `codes` the list of pairs, `tolerance_hz` the tolerance.
#[derive(Clone, Copy, Debug)]
pub struct Names<'a> {
    /// The list of pairs.
    pub codes: &'a str,
    /// By how much a measured frequency may be off.
    pub tolerance_hz: &'a str,
}

/// A number of so many parts in 0 to `most`.
///
/// # Errors
/// If it is no whole number of them, or out of range, with the name of its field.
pub fn whole(field: &str, value: f64, decimals: u8, most: u32) -> Result<u32, Refusal> {
    let parts = decimal::whole(value, decimals).and_then(|parts| u32::try_from(parts).ok());
    parts.filter(|parts| *parts <= most).ok_or_else(|| {
        let one = 10_f64.powi(decimals.into());
        let what =
            format!("{field} is {value}; it must be 0 to {}, in whole steps of {}", f64::from(most) / one, 1.0 / one);
        Refusal::new(Rule::Range, field, what)
    })
}

/// A speed in tenths of km/h.
///
/// # Errors
/// If it does not fit, with the name of its field.
pub fn speed(field: &str, km_h: f64) -> Result<KmhTenths, Refusal> {
    let tenths = whole(field, km_h, 1, u16::MAX.into())?;
    Ok(KmhTenths(u16::try_from(tenths).unwrap_or(u16::MAX)))
}

/// A code frequency, or a tolerance: at most 1000 Hz.
fn frequency(field: &str, hz: f64) -> Result<Millihertz, Refusal> {
    whole(field, hz, 3, 1_000_000).map(Millihertz)
}

/// The table in the kernel's form.
///
/// # Errors
/// The rule of CODE-3 or CODE-4 that is broken.
pub fn table(names: Names<'_>, tolerance_hz: f64, given: &[Pair]) -> Result<CodeTable, Refusal> {
    let tolerance = frequency(names.tolerance_hz, tolerance_hz)?;
    let mut lists: [Vec<Millihertz>; 2] = [Vec::new(), Vec::new()];
    let mut pairs = Vec::new();
    for (place, pair) in given.iter().enumerate() {
        let field = |name: &str| format!("{}[{place}].{name}", names.codes);
        let (main, sub) = (frequency(&field("main_hz"), pair.main_hz)?, frequency(&field("sub_hz"), pair.sub_hz)?);
        lists[0].push(main);
        lists[1].push(sub);
        pairs.push((main, sub, speed(&field("speed_km_h"), pair.speed_km_h)?));
    }
    let mut frequencies = Vec::new();
    for (list, name) in lists.iter_mut().zip(["main_hz", "sub_hz"]) {
        list.sort_unstable();
        list.dedup();
        let checked = CodeFrequencies::new(list, tolerance);
        frequencies.push(checked.map_err(|error| explain(error, names, name, list, tolerance_hz))?);
    }
    let mut speeds = [[None; MAX_CODES]; MAX_CODES];
    for (place, (main, sub, speed)) in pairs.into_iter().enumerate() {
        let [row, column] = [(&lists[0], main), (&lists[1], sub)]
            .map(|(list, code)| list.iter().position(|known| *known == code).unwrap_or_default());
        if speeds[row][column].replace(speed).is_some() {
            let field = format!("{}[{place}]", names.codes);
            let what = format!("{field} is a pair of codes that has a speed already");
            return Err(Refusal::new(Rule::Code4, field, what));
        }
    }
    let (Some(sub), Some(main)) = (frequencies.pop(), frequencies.pop()) else {
        return Err(explain(CodeError::NoSpeed, names, "main_hz", &[], tolerance_hz));
    };
    CodeTable::new(main, sub, speeds).map_err(|error| explain(error, names, "main_hz", &[], tolerance_hz))
}

fn explain(error: CodeError, names: Names<'_>, name: &str, list: &[Millihertz], tolerance: f64) -> Refusal {
    let hz = |place: usize| list.get(place).map_or(0.0, |code| f64::from(code.0) / 1000.0);
    let Names { codes, tolerance_hz } = names;
    let (rule, what) = match error {
        CodeError::NoFrequency => {
            (Rule::Code3, format!("{codes} is empty; it must name 1 to 8 codes for each carrier"))
        }
        CodeError::NoSpeed => (Rule::Code4, format!("{codes} is empty; it must name 1 to 8 codes for each carrier")),
        CodeError::TooManyFrequencies => {
            (Rule::Code3, format!("{codes} has {} different values of {name}; it may have 8", list.len()))
        }
        CodeError::OutOfRange => {
            (Rule::Code3, format!("{codes} has {name} = {}, not above {tolerance_hz} = {tolerance}", hz(0)))
        }
        CodeError::BandsTouch(place) => (
            Rule::Code3,
            format!(
                "{codes} has {name} = {} and {}; they must be more than twice {tolerance_hz} = {tolerance} apart",
                hz(place.saturating_sub(1)),
                hz(place)
            ),
        ),
        CodeError::UnusedCode(..) => (Rule::Code4, format!("{codes} has a {name} that is not in use")),
    };
    Refusal::new(rule, codes, what)
}

/// The data checks of a table that the kernel accepts, held against the line's aspects.
pub(crate) fn checks(places: &Places, table: &CodeTable, given: &[Pair], aspects: &AspectTable) -> Vec<DataCheck> {
    let known = |speed: KmhTenths| aspects.aspect(speed).is_some();
    let named: Vec<_> = given.iter().filter_map(|pair| speed("", pair.speed_km_h).ok()).collect();
    let mut unlike: Vec<_> = named
        .iter()
        .enumerate()
        .filter(|(_, speed)| !known(**speed))
        .map(|(place, speed)| Finding {
            at: places.at(&format!("codes.pairs[{place}].speed_km_h")),
            against: Some(places.at("aspects_km_h")),
            what: format!("a pair of codes names {} km/h, and no aspect does", Kmh::from(*speed)),
            right: "name one of aspects_km_h".to_owned(),
        })
        .collect();
    unlike.extend(aspects.speeds().iter().enumerate().filter(|(_, aspect)| !named.contains(aspect)).map(
        |(place, aspect)| Finding {
            at: places.at(&format!("aspects_km_h[{place}]")),
            against: Some(places.at("codes.pairs")),
            what: format!("the aspect of {} km/h has no pair of codes", Kmh::from(*aspect)),
            right: "add a pair, or leave out the aspect".to_owned(),
        },
    ));
    let shared = Finding {
        at: places.at("codes.pairs"),
        against: None,
        what: "two pairs have a code in common: where the other code is taken wrongly, another speed is named"
            .to_owned(),
        right: "give each speed two codes of its own".to_owned(),
    };
    let single = if table.detects_one_wrong_code() { Vec::new() } else { vec![shared] };
    let scope = || format!("{} pairs", given.len());
    vec![
        DataCheck::new(
            Rule::Code3,
            format!("{} and {} code frequencies", table.main().nominal().len(), table.sub().nominal().len()),
            Outcome::Met,
        ),
        DataCheck::new(Rule::Code4, scope(), Outcome::Met),
        DataCheck::new(Rule::CodeSpeed, format!("{} aspects", aspects.speeds().len()), Outcome::of(unlike)),
        DataCheck::new(Rule::OneWrongCode, scope(), Outcome::of(single)),
    ]
}
