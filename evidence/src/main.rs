//! `safety-case`.
fn main() {}
