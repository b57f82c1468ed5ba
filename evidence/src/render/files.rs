//! The names of the files of a case.

/// The file that is there from the beginning of a run until every entry of the manifest has a result.
pub const MARKER: &str = "incomplete";
/// The hashes of the files of a case, in the form of `sha256sum`.
pub const SUMS: &str = "SHA256SUMS";
/// The page.
pub const PAGE: &str = "index.html";
/// The short case of the station.
pub const STATION: &str = "station.html";
