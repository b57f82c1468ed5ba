//! Sets of sections on the wire: a list of their numbers.

use std::borrow::Cow;
use std::fmt;

use atc_kernel::block::{MAX_SECTIONS, SectionSet};
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::{Error as _, SeqAccess, Visitor};
use serde::{Deserialize, Deserializer, Serialize, Serializer};

/// A set of the sections of a block. On the wire a JSON array of their numbers, counted from 0 at the entry end; read in any
/// order, each at most once, and written in rising order.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Sections(pub SectionSet);

impl Sections {
    /// The numbers, in rising order.
    pub fn numbers(self) -> impl Iterator<Item = u8> {
        (0..MAX_SECTIONS).filter(move |section| self.0.contains(*section))
    }
}

impl Serialize for Sections {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_seq(self.numbers())
    }
}

struct Reader;

impl<'de> Visitor<'de> for Reader {
    type Value = Sections;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a list of section numbers")
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<Sections, A::Error> {
        let mut set: u16 = 0;
        while let Some(number) = list.next_element::<i64>()? {
            let bit = u32::try_from(number).ok().and_then(|number| 1_u16.checked_shl(number));
            let Some(bit) = bit else {
                return Err(A::Error::custom(format_args!(
                    "there is no section {number}; sections are numbered 0 to 15"
                )));
            };
            if set & bit != 0 {
                return Err(A::Error::custom(format_args!(
                    "section {number} a second time; each section is named once"
                )));
            }
            set |= bit;
        }
        Ok(Sections(SectionSet::from_bits(set)))
    }
}

impl<'de> Deserialize<'de> for Sections {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_seq(Reader)
    }
}

impl JsonSchema for Sections {
    fn schema_name() -> Cow<'static, str> {
        "Sections".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({
            "type": "array",
            "items": { "type": "integer", "minimum": 0, "maximum": MAX_SECTIONS - 1 },
            "uniqueItems": true,
            "description": "Sections of a block, numbered from 0 at the entry end.",
        })
    }
}
