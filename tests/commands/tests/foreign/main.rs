//! The implementations of `tests/foreign`, which were written from spec/ alone, in lock step with the kernel; and each of
//! their seeded faults is found. Seeds are fixed.

mod draw;
mod fmu;
mod javascript;
mod side;
mod small;
mod station;
mod sumo;
mod wheel;

use std::process::Command;

fn in_c(name: &str, faults: u32, requests: &[String], replies: &[String]) {
    let folder = tempfile::tempdir().expect("a folder");
    let program = side::compiled(name, &folder);
    side::holds(name, faults, requests, replies, || Command::new(&program));
}

fn in_python(name: &str, faults: u32, requests: &[String]) {
    match side::python(name) {
        Ok(_) => side::holds(name, faults, requests, &side::expected(requests), || {
            side::python(name).expect("it ran before")
        }),
        Err(why) => println!("{name}: did not run: {why}"),
    }
}

#[test]
fn aspect_acceptance() {
    let requests = small::aspect(1, 100_000);
    in_c("aspect", 12, &requests, &side::expected(&requests));
}

#[test]
fn block_counting() {
    let requests = small::block(1, 100_000);
    in_c("block", 14, &requests, &side::expected(&requests));
}

#[test]
fn telegram_codec() {
    in_python("telegram", 12, &small::telegram(1, 50_000));
}

#[test]
fn permitted_speed() {
    in_python("permitted", 19, &small::permitted(1, 50_000));
}

#[test]
fn interlocking() {
    let (requests, replies) = station::interlocking(1, 90_000, side::oracle());
    in_c("interlocking", 42, &requests, &replies);
}
