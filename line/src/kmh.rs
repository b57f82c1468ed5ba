//! Speeds on the wire: a decimal number of km/h, read exactly as whole tenths.

use std::borrow::Cow;
use std::fmt;

use atc_kernel::speed::KmhTenths;
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::Error as _;
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use serde_json::value::RawValue;

use crate::decimal::{self, NotWhole, Quantity, shorten};
use crate::refusal::Refusal;
use crate::rule::Rule;

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
        let tenths = decimal::parts(number, 1).map_err(|error| {
            let number = shorten(number);
            KmhError(match error {
                NotWhole::NoNumber => format!("expected a number of km/h, found {number}"),
                NotWhole::TooFine => format!("{number} km/h is not a whole number of tenths"),
            })
        })?;
        Ok(Self::of(tenths))
    }
}

/// A speed in tenths of km/h.
///
/// # Errors
/// If it does not fit, with the name of its field.
pub fn tenths(field: &str, speed: Kmh) -> Result<KmhTenths, Refusal> {
    let what = || Refusal::new(Rule::Range, field, format!("{field} is {speed} km/h; it must be 0 to 6553.5 km/h"));
    u16::try_from(speed.0).map(KmhTenths).map_err(|_| what())
}

impl From<KmhTenths> for Kmh {
    fn from(speed: KmhTenths) -> Self {
        Self(speed.0.into())
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

impl Quantity for Kmh {
    const DECIMALS: u8 = 1;
    const UNIT: &'static str = "km/h";
    const PARTS: &'static str = "tenths";

    fn of(parts: i64) -> Self {
        Self(i32::try_from(parts).unwrap_or(if parts < 0 { i32::MIN } else { i32::MAX }))
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

/// A speed with its tenth, for tables: `45.0`.
pub(crate) fn fixed(speed: KmhTenths) -> String {
    format!("{}.{}", speed.0 / 10, speed.0 % 10)
}

/// The schema of a speed that may be null but not missing. (An `Option` may be missing.)
pub enum KmhOrNull {}

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
