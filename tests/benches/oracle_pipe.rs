//! The throughput of the real process: 2,000,000 steps of three machines through its pipes. The target is 500,000 steps/s on one core.
//!
//! Run it with `taskset -c 0` (as `ci/bench` does) to have the client, the oracle and the pipes on one core.

use std::io::{self, BufRead as _, BufReader, Write as _};
use std::time::Instant;

use atc_tests::{device, reception, traffic, workload};

const STEPS: usize = 2_000_000;
const TARGET: f64 = 500_000.0;

fn main() -> io::Result<()> {
    // Cargo asks every benchmark of a package; a filter that is not for this one is not an error.
    if std::env::args().skip(1).any(|argument| argument == "--test" || argument == "--list") {
        return Ok(());
    }
    let mut slow = Vec::new();
    let machines = [
        ("aspect-acceptance", workload::lines()),
        ("block-count", traffic::lines()),
        ("permitted-speed", reception::lines()),
    ];
    for (machine, (start, steps)) in machines {
        let mut best = 0_f64;
        for _ in 0..3 {
            best = best.max(measure(&start, &steps)?);
        }
        println!(
            "oracle serve, {machine}, through a pipe: {best:.0} steps/s, the best of 3 times {STEPS} steps (target {TARGET:.0})"
        );
        if best < TARGET {
            slow.push(machine);
        }
    }
    if slow.is_empty() { Ok(()) } else { Err(io::Error::other(format!("below the target: {}", slow.join(", ")))) }
}

/// Steps a second, every output checked to be one.
#[expect(clippy::cast_precision_loss, reason = "two million steps")]
fn measure(start: &str, steps: &str) -> io::Result<f64> {
    let period = steps.lines().count();
    let (start, steps) = (start.to_owned(), steps.to_owned());
    let mut child = device::serving(device::oracle())?;
    let mut stdin = child.stdin.take().ok_or_else(|| io::Error::other("no standard input"))?;
    let stdout = child.stdout.take().ok_or_else(|| io::Error::other("no standard output"))?;
    let begin = Instant::now();
    let writer = std::thread::spawn(move || -> io::Result<()> {
        stdin.write_all(start.as_bytes())?;
        for _ in 0..STEPS / period {
            stdin.write_all(steps.as_bytes())?;
        }
        let rest: String = steps.lines().take(STEPS % period).flat_map(|line| [line, "\n"]).collect();
        stdin.write_all(rest.as_bytes())
    });
    let mut stdout = BufReader::with_capacity(1 << 16, stdout);
    let (mut outputs, mut line) = (0, Vec::new());
    while stdout.read_until(b'\n', &mut line)? > 0 {
        outputs += usize::from(line.starts_with(b"{\"output\""));
        line.clear();
    }
    let seconds = begin.elapsed().as_secs_f64();
    writer.join().map_err(|_| io::Error::other("the writer panicked"))??;
    child.wait()?;
    if outputs == STEPS {
        Ok(STEPS as f64 / seconds)
    } else {
        Err(io::Error::other(format!("{outputs} outputs for {STEPS} steps")))
    }
}
