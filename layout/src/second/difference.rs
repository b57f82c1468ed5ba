//! Something in which a layout is not what its file says.

use std::fmt;

use crate::problem::LineColumn;

/// Something in which the layout is not what the file says.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Difference {
    /// The route of the layout, if it is of one.
    pub route: Option<String>,
    /// What the layout has, and what the file says.
    pub what: String,
    /// Where the file says it.
    pub place: Option<LineColumn>,
}

impl fmt::Display for Difference {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(route) = &self.route {
            write!(f, "route {route}: ")?;
        }
        f.write_str(&self.what)?;
        self.place.map_or(Ok(()), |place| write!(f, " (line {})", place.line))
    }
}
