//! Speeds on the wire: a decimal number of km/h, read exactly as whole tenths.

use std::borrow::Cow;
use std::fmt;

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::Error as _;
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use serde_json::value::RawValue;

/// A speed, in tenths of km/h. On the wire a JSON number of km/h, such as `45` or `44.9`.
///
/// It is read from the number's digits, never through floating point. A value beyond the range of `i32` tenths
/// becomes the end of that range: far beyond any speed that is plausible.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Kmh(pub i32);

/// A number that is not a speed: it has a part smaller than a tenth of km/h, or it is not a number.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct KmhError(String);

impl fmt::Display for KmhError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

impl std::error::Error for KmhError {}

impl Kmh {
    /// Reads a JSON number of km/h: sign, digits, fraction and exponent in any combination that JSON allows.
    ///
    /// # Errors
    /// If `number` is not a JSON number, or not a whole number of tenths.
    pub fn parse(number: &str) -> Result<Self, KmhError> {
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
        let (Some(exponent), true) = (exponent, !whole.is_empty() && digits().all(|digit| digit.is_ascii_digit()))
        else {
            return Err(KmhError(format!("expected a number of km/h, found {}", shorten(number))));
        };
        // How many of the digits stand before the point once the unit is the tenth.
        let point = i64::try_from(whole.len()).unwrap_or(i64::MAX).saturating_add(exponent).saturating_add(1);
        let mut tenths: i64 = 0;
        let mut place: i64 = 0;
        for digit in digits() {
            let digit = i64::from(digit - b'0');
            if place < point {
                tenths = tenths.saturating_mul(10).saturating_add(digit);
            } else if digit != 0 {
                return Err(KmhError(format!("{} km/h is not a whole number of tenths", shorten(number))));
            }
            place += 1;
        }
        while place < point && tenths != 0 && tenths <= i64::from(i32::MAX) {
            tenths = tenths.saturating_mul(10);
            place += 1;
        }
        let tenths = if negative { -tenths } else { tenths };
        Ok(Self(i32::try_from(tenths).unwrap_or(if negative { i32::MIN } else { i32::MAX })))
    }
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

/// The text, cut to a length that is fit for a message.
pub(crate) fn shorten(text: &str) -> Cow<'_, str> {
    const LONGEST: usize = 40;
    match text.char_indices().nth(LONGEST) {
        Some((end, _)) => Cow::Owned(format!("{}…", &text[..end])),
        None => Cow::Borrowed(text),
    }
}

impl fmt::Display for Kmh {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let size = self.0.unsigned_abs();
        let sign = if self.0 < 0 { "-" } else { "" };
        match size % 10 {
            0 => write!(f, "{sign}{}", size / 10),
            tenth => write!(f, "{sign}{}.{tenth}", size / 10),
        }
    }
}

impl Serialize for Kmh {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        if self.0 % 10 == 0 {
            serializer.serialize_i32(self.0 / 10)
        } else {
            // The nearest double of a number of tenths is written back with that one decimal.
            serializer.serialize_f64(f64::from(self.0) / 10.0)
        }
    }
}

impl<'de> Deserialize<'de> for Kmh {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let number = <&RawValue>::deserialize(deserializer)?;
        Self::parse(number.get()).map_err(D::Error::custom)
    }
}

impl JsonSchema for Kmh {
    fn schema_name() -> Cow<'static, str> {
        "Kmh".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({
            "type": "number",
            "description": "A speed in km/h, in whole tenths: 45 or 44.9, not 44.95."
        })
    }
}

/// The schema of a speed that may be null but not missing. (An `Option` may be missing.)
pub(crate) enum KmhOrNull {}

impl JsonSchema for KmhOrNull {
    fn schema_name() -> Cow<'static, str> {
        "KmhOrNull".into()
    }

    fn inline_schema() -> bool {
        true
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        json_schema!({ "anyOf": [generator.subschema_for::<Kmh>(), { "type": "null" }] })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tenths(number: &str) -> Option<i32> {
        Kmh::parse(number).ok().map(|speed| speed.0)
    }

    #[test]
    fn every_way_to_write_a_number() {
        for (number, expected) in [
            ("45", 450),
            ("44.9", 449),
            ("44.900", 449),
            ("0", 0),
            ("-0.0", 0),
            ("-1", -10),
            ("-0.1", -1),
            ("4.49e1", 449),
            ("449E-1", 449),
            ("4490e-2", 449),
            ("0.00449e+4", 449),
            ("0e99999999999999999999", 0),
            ("0e-99999999999999999999", 0),
        ] {
            assert_eq!(tenths(number), Some(expected), "{number}");
        }
    }

    #[test]
    fn huge_numbers_end_at_the_range() {
        for number in ["1e400", "1e99999999999999999999", "214748364.8", "99999999999999999999999999", "5e9"] {
            assert_eq!(tenths(number), Some(i32::MAX), "{number}");
            assert_eq!(tenths(&format!("-{number}")), Some(i32::MIN), "-{number}");
        }
        assert_eq!(tenths("214748364.7"), Some(i32::MAX));
        assert_eq!(tenths("-214748364.8"), Some(i32::MIN));
    }

    #[test]
    fn parts_of_a_tenth_and_other_values_are_refused() {
        for number in
            ["44.95", "1e-2", "1e-99999999999999999999", "44.9000000000000000000001", "\"45\"", "null", "", "-"]
        {
            assert!(Kmh::parse(number).is_err(), "{number}");
        }
    }

    #[test]
    fn every_speed_of_a_table_is_written_exactly() {
        for tenths in 0..=i32::from(u16::MAX) {
            let text = serde_json::to_string(&Kmh(tenths)).expect("a number");
            assert_eq!(text, Kmh(tenths).to_string());
            assert_eq!(Kmh::parse(&text), Ok(Kmh(tenths)));
        }
    }
}
