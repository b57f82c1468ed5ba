//! Steps the kernel as often as it is told, with 16 aspects and busy input, and prints what it displayed last: for
//! counting instructions. `kernel-steps COUNT`

use std::process::ExitCode;

use atc_tests::workload;

fn main() -> ExitCode {
    let count = std::env::args().nth(1).and_then(|count| count.parse().ok());
    let Some(count) = count else {
        eprintln!("kernel-steps: expected a number of steps");
        return ExitCode::FAILURE;
    };
    let display = workload::run(count);
    println!("{count} steps, at last {display:?}");
    ExitCode::SUCCESS
}
