//! Steps a machine of the kernel as often as it is told, with busy input, and prints what it put out last: for counting
//! instructions. `kernel-steps MACHINE COUNT`

use std::process::ExitCode;

use atc_tests::{busy_station, reception, traffic, workload};

fn main() -> ExitCode {
    let arguments: Vec<_> = std::env::args().skip(1).collect();
    let count = arguments.get(1).and_then(|count| count.parse().ok());
    match (arguments.first().map(String::as_str), count) {
        (Some("aspect"), Some(count)) => println!("{count} steps, at last {:?}", workload::run(count)),
        (Some("block"), Some(count)) => println!("{count} steps, at last {:?}", traffic::run_block(count)),
        (Some("permitted"), Some(count)) => println!("{count} steps, at last {:?}", reception::run_permitted(count)),
        (Some("position"), Some(count)) => println!("{count} steps, at last {:?}", reception::run_position(count)),
        (Some("deframer"), Some(count)) => println!("{count} steps, {} telegrams", reception::run_deframer(count)),
        (Some("interlocking"), Some(count)) => {
            let (station, inputs) = (busy_station::station(), busy_station::traffic(busy_station::SMALL));
            println!("{count} cycles, at last {:?}", busy_station::run(&station, &inputs, count));
        }
        (Some("interlocking-full"), Some(count)) => {
            let (station, inputs) = (busy_station::station(), busy_station::full(busy_station::SMALL));
            println!("{count} cycles, at last {:?}", busy_station::run(&station, &inputs, count));
        }
        (Some("large"), Some(count)) => {
            let (station, inputs) = (busy_station::large(), busy_station::traffic(busy_station::LARGE));
            println!("{count} cycles, at last {:?}", busy_station::run(&station, &inputs, count));
        }
        (Some("large-full"), Some(count)) => {
            let (station, inputs) = (busy_station::large(), busy_station::full(busy_station::LARGE));
            println!("{count} cycles, at last {:?}", busy_station::run(&station, &inputs, count));
        }
        _ => {
            eprintln!(
                "kernel-steps: expected `aspect`, `block`, `permitted`, `position`, `deframer`, `interlocking`, `interlocking-full`, `large` or `large-full`, and a number of steps"
            );
            return ExitCode::FAILURE;
        }
    }
    ExitCode::SUCCESS
}
