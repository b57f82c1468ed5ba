//! The project's default code frequencies, and a table of speeds to go with them.

use atc_kernel::code::{CodeError, CodeFrequencies, CodeTable, MAX_CODES, Millihertz};
use atc_kernel::speed::KmhTenths;

/// The code frequencies of the main carrier.
pub const MAIN_CODES: [Millihertz; 6] = [
    Millihertz(10_000),
    Millihertz(15_000),
    Millihertz(22_000),
    Millihertz(29_000),
    Millihertz(36_000),
    Millihertz(41_500),
];

/// The code frequencies of the sub carrier.
pub const SUB_CODES: [Millihertz; 6] = [
    Millihertz(12_000),
    Millihertz(16_500),
    Millihertz(21_000),
    Millihertz(27_000),
    Millihertz(32_000),
    Millihertz(38_500),
];

/// By how much a measured code may be off: under a quarter of the smallest distance between two codes.
pub const CODE_TOLERANCE: Millihertz = Millihertz(1_000);

/// An example: the n-th main code and the n-th sub code together name the n-th of 15, 25, 45, 55, 75 and 90 km/h, every
/// other pair nothing, so that one code taken for another never names a speed.
///
/// # Errors
/// None with these values; the constructor's error type is passed on so that nothing needs to be assumed.
pub fn example_code_table() -> Result<CodeTable, CodeError> {
    let mut speeds = [[None; MAX_CODES]; MAX_CODES];
    for (place, speed) in [150, 250, 450, 550, 750, 900].into_iter().enumerate() {
        speeds[place][place] = Some(KmhTenths(speed));
    }
    let main = CodeFrequencies::new(&MAIN_CODES, CODE_TOLERANCE)?;
    let sub = CodeFrequencies::new(&SUB_CODES, CODE_TOLERANCE)?;
    CodeTable::new(main, sub, speeds)
}
