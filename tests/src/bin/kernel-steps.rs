//! Steps a machine of the kernel as often as it is told, with busy input, and prints what it put out last: for counting
//! instructions. `kernel-steps MACHINE COUNT`

use std::process::ExitCode;

use atc_kernel::interlocking::{Input, Layout, Size};
use atc_tests::busy_station::{LARGE, SMALL, large, station};
use atc_tests::{busy_station, reception, traffic, workload};

/// Steps a station, and tells of it.
fn cycles<const R: usize, const P: usize, const N: usize, const S: usize, Z: Size>(
    station: &Layout<R, P, N, S, Z>,
    inputs: &[Input<Z>],
    count: u64,
) {
    println!("{count} cycles, at last {:?}", busy_station::run(station, inputs, count));
}

fn main() -> ExitCode {
    let arguments: Vec<_> = std::env::args().skip(1).collect();
    let count = arguments.get(1).and_then(|count| count.parse().ok());
    match (arguments.first().map(String::as_str), count) {
        (Some("aspect"), Some(count)) => println!("{count} steps, at last {:?}", workload::run(count)),
        (Some("block"), Some(count)) => println!("{count} steps, at last {:?}", traffic::run_block(count)),
        (Some("permitted"), Some(count)) => println!("{count} steps, at last {:?}", reception::run_permitted(count)),
        (Some("position"), Some(count)) => println!("{count} steps, at last {:?}", reception::run_position(count)),
        (Some("deframer"), Some(count)) => println!("{count} steps, {} telegrams", reception::run_deframer(count)),
        (Some("interlocking"), Some(count)) => cycles(&station(), &busy_station::traffic(SMALL), count),
        (Some("interlocking-full"), Some(count)) => cycles(&station(), &busy_station::full(SMALL), count),
        (Some("large"), Some(count)) => cycles(&large(), &busy_station::traffic(LARGE), count),
        (Some("large-full"), Some(count)) => cycles(&large(), &busy_station::full(LARGE), count),
        _ => {
            eprintln!(
                "kernel-steps: expected `aspect`, `block`, `permitted`, `position`, `deframer`, `interlocking`, `interlocking-full`, `large` or `large-full`, and a number of steps"
            );
            return ExitCode::FAILURE;
        }
    }
    ExitCode::SUCCESS
}
