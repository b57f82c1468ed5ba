//! The models that take a minute each, while other tests check all others.

/// They are checked in the evidence only, where every model is, against the same expectations.
pub const LARGE: [&str; 8] = [
    "interlocking-loop-late-points",
    "interlocking-loop-any-platform",
    "interlocking-loop-points",
    "interlocking-loop-flicker",
    "interlocking-loop-following-flicker",
    "interlocking-loop-blocks",
    "interlocking-loop-line-blocked",
    "interlocking-loop-restricted",
];
