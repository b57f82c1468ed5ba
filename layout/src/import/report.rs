//! What an import did.

use std::fmt;

use crate::description::Description;

/// What an import did.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Report {
    /// What was taken, with counts.
    pub taken: Vec<String>,
    /// What the file does not say, and the value that stands for it: each is to be confirmed.
    pub defaulted: Vec<String>,
    /// What the file lacks and nothing stands for.
    pub lacking: Vec<String>,
    /// What the file has and the import does not use.
    pub skipped: Vec<String>,
}

impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let parts = [
            ("taken", &self.taken),
            ("defaulted, to be confirmed", &self.defaulted),
            ("lacking", &self.lacking),
            ("not used", &self.skipped),
        ];
        for (title, lines) in parts {
            writeln!(f, "{title}:{}", if lines.is_empty() { " nothing" } else { "" })?;
            for line in lines {
                writeln!(f, "  {line}")?;
            }
        }
        Ok(())
    }
}

/// A layout in another form, and what the import did.
#[derive(Clone, Debug, Default)]
pub struct Imported {
    /// The layout. It may break rules: [`Description::compile`] tells.
    pub description: Description,
    /// What was taken, defaulted, lacking and skipped.
    pub report: Report,
}
