//! Steps a machine of the kernel as often as it is told, with busy input, and prints what it put out last: for counting
//! instructions. `kernel-steps aspect|block COUNT`

use std::process::ExitCode;

use atc_tests::{traffic, workload};

fn main() -> ExitCode {
    let arguments: Vec<_> = std::env::args().skip(1).collect();
    let count = arguments.get(1).and_then(|count| count.parse().ok());
    match (arguments.first().map(String::as_str), count) {
        (Some("aspect"), Some(count)) => println!("{count} steps, at last {:?}", workload::run(count)),
        (Some("block"), Some(count)) => println!("{count} steps, at last {:?}", traffic::run_block(count)),
        _ => {
            eprintln!("kernel-steps: expected `aspect` or `block`, and a number of steps");
            return ExitCode::FAILURE;
        }
    }
    ExitCode::SUCCESS
}
