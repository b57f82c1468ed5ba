//! Values on the wire that are one of a few names.

use serde::Deserialize;
use serde::de::{Deserializer, Error as _};

/// A value that is written as its name.
pub trait Named: Copy + 'static {
    /// What the names are of, for messages.
    const WHAT: &'static str;
    /// Every value.
    const EVERY: &'static [Self];

    /// The name on the wire.
    fn name(self) -> &'static str;
}

/// Reads a name. (Derived, serde would take `{"name":null}` for the name as well.)
///
/// # Errors
/// A name that no value has.
pub fn read<'de, N: Named, D: Deserializer<'de>>(deserializer: D) -> Result<N, D::Error> {
    let found = String::deserialize(deserializer)?;
    N::EVERY.iter().copied().find(|value| value.name() == found).ok_or_else(|| {
        let names: Vec<_> = N::EVERY.iter().map(|value| format!("{:?}", value.name())).collect();
        let found = crate::decimal::shorten(&found);
        D::Error::custom(format_args!("unknown {} {found:?}, expected one of {}", N::WHAT, names.join(", ")))
    })
}
