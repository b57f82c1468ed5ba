//! `oracle`.
fn main() {}
