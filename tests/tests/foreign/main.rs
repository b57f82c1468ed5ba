//! The implementations of `tests/foreign`, which were written from spec/ alone, in lock step with the kernel; and each of
//! their seeded faults is found. Seeds are fixed.

mod draw;
mod side;
mod small;
mod station;

use std::process::Command;

fn in_c(name: &str, faults: u32, requests: &[String]) {
    let folder = tempfile::tempdir().expect("a folder");
    let program = side::compiled(name, &folder);
    side::holds(name, faults, requests, || Command::new(&program));
}

fn in_python(name: &str, faults: u32, requests: &[String]) {
    match side::python(name) {
        Ok(_) => side::holds(name, faults, requests, || side::python(name).expect("it ran before")),
        Err(why) => println!("{name}: did not run: {why}"),
    }
}

#[test]
fn aspect_acceptance() {
    in_c("aspect", 12, &small::aspect(1, 100_000));
}

#[test]
fn block_counting() {
    in_c("block", 14, &small::block(1, 100_000));
}

#[test]
fn telegram_codec() {
    in_python("telegram", 12, &small::telegram(1, 100_000));
}

#[test]
fn permitted_speed() {
    in_python("permitted", 18, &small::permitted(1, 100_000));
}

#[test]
fn interlocking() {
    in_c("interlocking", 36, &station::interlocking(1, 100_000, side::oracle()));
}
