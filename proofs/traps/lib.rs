//! The traps that are written in Rust: small programs whose verdicts are known. `traps.toml` declares each of them.
//!
//! They go the way of the harnesses: optimised WebAssembly, C, the driver.
#![no_std]
#![allow(missing_docs)]

mod assumed;
mod bounds;
mod bytes;
mod calls;
mod casts;
mod cells;
mod constants;
mod division;
mod exits;
mod lowest;
mod missing;
mod overflow;
mod products;
mod proof;
mod rounds;
mod search;
mod shifts;
mod stack;
mod switch;
mod turns;
mod unaligned;
mod unwinding;
mod vacuity;
mod verdicts;

// What the driver offers, as to a harness.
#[link(wasm_import_module = "prover")]
unsafe extern "C" {
    safe fn word() -> u32;
    safe fn assume(holds: u32);
    safe fn claim(number: u32, holds: u32);
    safe fn cover(number: u32, reached: u32);
}

#[panic_handler]
fn panic(_: &core::panic::PanicInfo) -> ! {
    core::arch::wasm32::unreachable()
}
