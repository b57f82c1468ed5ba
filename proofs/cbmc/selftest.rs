//! The cbmc engine's test of itself: small harnesses whose verdicts are known, one for each trap that the way from
//! Rust to CBMC has. `proofs/runner/src/selftest.rs` says what is expected.
#![no_std]
#![allow(missing_docs)]

#[link(wasm_import_module = "prover")]
unsafe extern "C" {
    safe fn word() -> u32;
    safe fn assume(holds: u32);
    safe fn claim(number: u32, holds: u32);
    safe fn cover(number: u32, reached: u32);
}

#[link(wasm_import_module = "prover")]
unsafe extern "C" {
    safe fn nobody() -> u32;
}

#[panic_handler]
fn panic(_: &core::panic::PanicInfo) -> ! {
    core::arch::wasm32::unreachable()
}

/// Through linear memory: what is stored is what is loaded.
#[unsafe(no_mangle)]
extern "C" fn cells() {
    let mut cells = [0_u16; 8];
    let (place, value) = (word() as usize % 8, word() as u16);
    cells[place] = value;
    core::hint::black_box(&mut cells);
    claim(0, u32::from(cells[place] == value));
    claim(1, u32::from(cells[(place + 1) % 8] == value)); // false
    cover(0, u32::from(place == 7));
}

/// Wider than a byte, at addresses that are no multiple of the width: the bytes that are there.
#[unsafe(no_mangle)]
extern "C" fn unaligned() {
    let mut bytes = [0_u64; 2].map(u64::to_le_bytes);
    for byte in bytes.as_flattened_mut() {
        *byte = word() as u8;
    }
    let before = bytes;
    let at = |place: usize| before.as_flattened()[place];
    let start = core::hint::black_box(bytes.as_mut_ptr().cast::<u8>());
    // SAFETY: 16 bytes start there, and the accesses are within them.
    let (wide, long) = unsafe { (start.add(1).cast::<u32>().read_unaligned(), start.add(3).cast::<u64>().read_unaligned()) };
    claim(0, u32::from(wide == u32::from_le_bytes([at(1), at(2), at(3), at(4)])));
    claim(1, u32::from(long.to_le_bytes()[0] != at(3))); // false
    claim(2, u32::from((long >> 32) as u32 == u32::from_le_bytes([at(7), at(8), at(9), at(10)])));
    // SAFETY: as above.
    unsafe { start.add(6).cast::<u32>().write_unaligned(wide) };
    // SAFETY: as above.
    claim(3, u32::from(unsafe { start.add(9).read() } == at(4)));
    cover(0, u32::from(wide == 0x0102_0304));
}

static SQUARES: [u32; 12] = [0, 1, 4, 9, 16, 25, 36, 49, 64, 81, 100, 121];

/// Constant tables are there.
#[unsafe(no_mangle)]
extern "C" fn constants() {
    let index = word();
    assume(u32::from(index < 12));
    let square = core::hint::black_box(&SQUARES)[index as usize];
    claim(0, u32::from(square == index * index));
    claim(1, u32::from(square != 121)); // false
    cover(0, u32::from(square == 121));
}

/// More stack than there is.
#[unsafe(no_mangle)]
extern "C" fn stack() {
    let mut cells = [0_u32; 900];
    core::hint::black_box(&mut cells);
    claim(0, u32::from(cells[899] == 0));
    cover(0, 1);
}

/// Each claim has its own verdict; one that is never reached, and one after a false assumption, prove nothing.
#[unsafe(no_mangle)]
extern "C" fn verdicts() {
    let value = word();
    claim(0, u32::from(value < 65_536));
    claim(1, u32::from(value != 4711)); // false
    if value > 65_535 {
        claim(2, 1); // unreachable
    }
    cover(0, u32::from(value == 4711));
    cover(1, u32::from(value == 65_536)); // unreachable
    assume(u32::from(value > 65_535));
    claim(3, u32::from(value == 0)); // vacuous
}

/// A function that nobody wrote.
#[unsafe(no_mangle)]
extern "C" fn missing() {
    claim(0, u32::from(nobody() < 3));
}

/// A loop longer than the bound.
#[unsafe(no_mangle)]
extern "C" fn unwinding() {
    let mut left = word();
    while left > 0 {
        left = core::hint::black_box(left) - 1;
    }
    claim(0, u32::from(left == 0));
    cover(0, 1);
}

/// A panic that can be reached: an overflow.
#[unsafe(no_mangle)]
extern "C" fn overflow() {
    let value = word() as u16;
    claim(0, u32::from(value + 1 > 0));
    cover(0, 1);
}

/// A panic that can be reached: an index out of bounds.
#[unsafe(no_mangle)]
extern "C" fn bounds() {
    let value = word() as usize;
    claim(0, u32::from(core::hint::black_box(&SQUARES)[value] < 122));
    cover(0, 1);
}
