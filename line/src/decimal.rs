//! Decimal numbers on the wire, read exactly as whole parts of their unit: a speed as tenths of km/h, a length as
//! millimetres, a level as hundredths of a decibel. Never through floating point.

use std::borrow::Cow;
use std::fmt;
use std::marker::PhantomData;

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::Error as _;
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use serde_json::value::RawValue;

use crate::refusal::Refusal;
use crate::rule::Rule;

/// The largest number of parts that is told apart from infinity; a double holds every whole number up to it.
const FAR: i64 = 1 << 52;

/// Why a text is not a whole number of parts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum NotWhole {
    /// It is not a JSON number.
    NoNumber,
    /// It has a part smaller than the smallest.
    TooFine,
}

/// Reads a JSON number as a whole number of parts, of which 10 to the power of `decimals` make one: sign, digits, fraction and
/// exponent in any combination that JSON allows. A number beyond ±2⁵² parts becomes the end of that range.
pub(crate) fn parts(number: &str, decimals: u8) -> Result<i64, NotWhole> {
    let (negative, unsigned) = match number.strip_prefix('-') {
        Some(rest) => (true, rest),
        None => (false, number),
    };
    let (mantissa, exponent) = match unsigned.split_once(['e', 'E']) {
        Some((mantissa, exponent)) => (mantissa, parse_exponent(exponent)),
        None => (unsigned, Some(0)),
    };
    let (whole, fraction) = mantissa.split_once('.').unwrap_or((mantissa, ""));
    let digits = || whole.bytes().chain(fraction.bytes());
    let (Some(exponent), true) = (exponent, !whole.is_empty() && digits().all(|digit| digit.is_ascii_digit())) else {
        return Err(NotWhole::NoNumber);
    };
    // How many of the digits stand before the point once the unit is the part.
    let point = i64::try_from(whole.len()).unwrap_or(i64::MAX).saturating_add(exponent).saturating_add(decimals.into());
    let mut parts: i64 = 0;
    let mut place: i64 = 0;
    for digit in digits() {
        let digit = i64::from(digit - b'0');
        if place < point {
            parts = parts.saturating_mul(10).saturating_add(digit);
        } else if digit != 0 {
            return Err(NotWhole::TooFine);
        }
        place += 1;
    }
    while place < point && parts != 0 && parts <= FAR {
        parts = parts.saturating_mul(10);
        place += 1;
    }
    let parts = parts.min(FAR);
    Ok(if negative { -parts } else { parts })
}

/// A number that TOML has read in binary, as a whole number of parts; none if it is not within a millionth of one. A number beyond ±2⁵²
/// parts becomes the end of that range.
#[expect(clippy::cast_possible_truncation, reason = "clamped to ±2⁵²")]
#[expect(clippy::cast_precision_loss, reason = "2⁵² is a double")]
pub(crate) fn whole(value: f64, decimals: u8) -> Option<i64> {
    let scaled = value * 10_f64.powi(decimals.into());
    let nearest = scaled.round();
    ((scaled - nearest).abs() < 1e-6 || scaled.is_infinite()).then_some(nearest.clamp(-(FAR as f64), FAR as f64) as i64)
}

/// A quantity in whole parts of its unit.
pub(crate) trait Quantity: Sized {
    /// How many decimals its unit has.
    const DECIMALS: u8;
    /// Its unit.
    const UNIT: &'static str;
    /// What it is a whole number of.
    const PARTS: &'static str;

    /// So many parts.
    fn of(parts: i64) -> Self;
}

/// A number that TOML gives; `field` is its path in the file.
///
/// # Errors
/// If it is no whole number of parts.
pub(crate) fn given<Q: Quantity>(field: &str, value: f64) -> Result<Q, Refusal> {
    whole(value, Q::DECIMALS).map(Q::of).ok_or_else(|| {
        let what = format!("{field} is {value} {}; it must be a whole number of {}", Q::UNIT, Q::PARTS);
        Refusal::new(Rule::Range, field, what)
    })
}

/// The same for a list.
///
/// # Errors
/// The first that is no whole number of parts.
pub(crate) fn list<Q: Quantity>(field: &str, values: &[f64]) -> Result<Vec<Q>, Refusal> {
    values.iter().enumerate().map(|(place, value)| given(&format!("{field}[{place}]"), *value)).collect()
}

/// A JSON exponent; one beyond `i64` is the end of that range, halved so that sums stay in it.
fn parse_exponent(text: &str) -> Option<i64> {
    const FAR: i64 = i64::MAX / 2;
    let digits = text.strip_prefix(['+', '-']).unwrap_or(text);
    if digits.is_empty() || !digits.bytes().all(|digit| digit.is_ascii_digit()) {
        return None;
    }
    let size = digits.parse::<i64>().unwrap_or(FAR).min(FAR);
    Some(if text.starts_with('-') { -size } else { size })
}

/// Writes parts as a decimal number without needless digits.
fn show(f: &mut fmt::Formatter<'_>, parts: i64, decimals: u8) -> fmt::Result {
    let one = 10_u64.pow(decimals.into());
    let (whole, rest) = (parts.unsigned_abs() / one, parts.unsigned_abs() % one);
    let sign = if parts < 0 { "-" } else { "" };
    if rest == 0 {
        return write!(f, "{sign}{whole}");
    }
    let digits = format!("{rest:0width$}", width = usize::from(decimals));
    write!(f, "{sign}{whole}.{}", digits.trim_end_matches('0'))
}

#[expect(clippy::cast_precision_loss, reason = "every number of parts that is written is below 2⁵³")]
fn write<S: Serializer>(serializer: S, parts: i64, decimals: u8) -> Result<S::Ok, S::Error> {
    let one = 10_i64.pow(decimals.into());
    if parts % one == 0 {
        serializer.serialize_i64(parts / one)
    } else {
        // The nearest double of so few digits is written back with those digits.
        serializer.serialize_f64(parts as f64 / one as f64)
    }
}

macro_rules! quantity {
    ($(#[$doc:meta])* $name:ident, $decimals:literal, $of:literal, $part:literal, $description:literal) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub struct $name(pub i64);

        impl fmt::Display for $name {
            fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                show(f, self.0, $decimals)
            }
        }

        impl Serialize for $name {
            fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
                write(serializer, self.0, $decimals)
            }
        }

        impl<'de> Deserialize<'de> for $name {
            fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
                let number = <&RawValue>::deserialize(deserializer)?.get();
                parts(number, $decimals).map(Self).map_err(|error| {
                    let number = shorten(number);
                    D::Error::custom(match error {
                        NotWhole::NoNumber => format!(concat!("expected a number of ", $of, ", found {}"), number),
                        NotWhole::TooFine => format!(concat!("{} is not a whole number of ", $part), number),
                    })
                })
            }
        }

        impl Quantity for $name {
            const DECIMALS: u8 = $decimals;
            const UNIT: &'static str = $of;
            const PARTS: &'static str = $part;

            fn of(parts: i64) -> Self {
                Self(parts)
            }
        }

        impl JsonSchema for $name {
            fn schema_name() -> Cow<'static, str> {
                stringify!($name).into()
            }

            fn json_schema(_: &mut SchemaGenerator) -> Schema {
                json_schema!({ "type": "number", "description": $description })
            }
        }
    };
}

quantity!(
    /// A length in millimetres. On the wire a JSON number of metres, such as `250` or `12.345`.
    Metres,
    3,
    "metres",
    "millimetres",
    "A length in m, in whole millimetres: 250 or 12.345, not 0.0005."
);

quantity!(
    /// A level, or a difference of levels, in hundredths of a decibel. On the wire a JSON number of decibels, such as `-12.5`.
    Decibels,
    2,
    "dB",
    "hundredths of a decibel",
    "A level in dB, in whole hundredths: -12.5 or 3.25, not 3.255."
);

quantity!(
    /// A frequency in millihertz. On the wire a JSON number of hertz, such as `16.5`.
    Hertz,
    3,
    "Hz",
    "millihertz",
    "A frequency in Hz, in whole millihertz: 22 or 16.5, not 0.0005."
);

/// The schema of a value that may be null but not missing. (An `Option` may be missing.)
pub struct OrNull<T>(PhantomData<T>);

impl<T: JsonSchema> JsonSchema for OrNull<T> {
    fn schema_name() -> Cow<'static, str> {
        format!("{}OrNull", T::schema_name()).into()
    }

    fn inline_schema() -> bool {
        true
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        json_schema!({ "anyOf": [generator.subschema_for::<T>(), { "type": "null" }] })
    }
}

/// The text, cut to a length that is fit for a message.
pub fn shorten(text: &str) -> Cow<'_, str> {
    const LONGEST: usize = 40;
    match text.char_indices().nth(LONGEST) {
        Some((end, _)) => Cow::Owned(format!("{}…", &text[..end])),
        None => Cow::Borrowed(text),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lengths_and_levels_are_read_from_their_digits() {
        let read = |text: &str| serde_json::from_str::<Metres>(text).map(|length| length.0).ok();
        for (text, millimetres) in [
            ("0", 0),
            ("12.345", 12_345),
            ("-0.001", -1),
            ("1e3", 1_000_000),
            ("1.5e-2", 15),
            ("4294967.295", 4_294_967_295),
            ("1e300", FAR),
            ("-1e300", -FAR),
        ] {
            assert_eq!(read(text), Some(millimetres), "{text}");
        }
        for text in ["0.0001", "1e-4", "null", "\"1\"", "[1]"] {
            assert_eq!(read(text), None, "{text}");
        }
        let error = serde_json::from_str::<Decibels>("3.255").expect_err("too fine").to_string();
        assert!(error.contains("3.255 is not a whole number of hundredths of a decibel"), "{error}");
    }

    #[test]
    fn what_is_written_is_read_again() {
        for parts in (-70_000..70_000).chain((0..40).map(|k| (1_i64 << k) + k)) {
            for text in [Metres(parts).to_string(), serde_json::to_string(&Metres(parts)).expect("a number")] {
                assert_eq!(super::parts(&text, 3), Ok(parts), "{text}");
            }
            let text = serde_json::to_string(&Decibels(parts)).expect("a number");
            assert_eq!((super::parts(&text, 2), &text), (Ok(parts), &Decibels(parts).to_string()));
        }
    }
}
