//! A busy receiver with 16 aspects, for the benchmarks: signals come and go in runs, several at a time, so that
//! every branch of the machine is taken.

use atc_kernel::aspect::{AspectSet, Display, MAX_ASPECTS, State, Times, TimesMs, step};
use atc_kernel::time::Millis;
use atc_protocol::Kmh;
use atc_protocol::machine::aspect::Config;

/// How many cycles the input has before it begins again.
pub const PERIOD: usize = 4096;

/// The patent's times, and 16 aspects of 5 to 80 km/h.
pub fn config() -> Config {
    Config::with_defaults((1..=16).map(|place| Kmh(50 * place)).collect())
}

/// The times of [`config`] in the kernel's form.
///
/// # Panics
/// Never: they are the defaults.
pub fn times() -> Times {
    Times::from_millis(Millis(10), TimesMs::default()).expect("the defaults are valid")
}

/// Detections of a period, the same in every run.
pub fn detections() -> Vec<AspectSet> {
    let mut random = 0x9E37_79B9_7F4A_7C15_u64;
    let mut next = || {
        // xorshift64
        random ^= random << 13;
        random ^= random >> 7;
        random ^= random << 17;
        random
    };
    let mut heard = 0_u16;
    let sets = (0..PERIOD).map(|_| {
        // One aspect in 16 cycles comes or goes: a signal lasts about 256 cycles, and T1 is 30.
        let draw = next();
        if draw.is_multiple_of(16) {
            heard ^= 1 << (draw >> 8 & 15);
        }
        // And one cycle in 32 has an interruption of everything.
        AspectSet::from_bits(if (draw >> 16).is_multiple_of(32) { 0 } else { heard })
    });
    sets.collect()
}

/// Runs `count` cycles of the kernel.
pub fn run(count: u64) -> Display {
    let (times, detections) = (times(), detections());
    let (mut state, mut display) = (State::<MAX_ASPECTS>::INITIAL, Display::NOTHING);
    for detected in detections.iter().cycle().take(usize::try_from(count).unwrap_or(usize::MAX)) {
        (state, display) = step(times, state, *detected);
    }
    display
}

/// The same input as lines of the protocol: the start, and one period of steps.
pub fn lines() -> (String, String) {
    let config = config();
    let json = serde_json::json!({"start": {"protocol": 1, "machine": "aspect-acceptance", "config": config}});
    let steps = detections().into_iter().map(|detected| {
        let speeds = crate::device::speeds(&config, detected);
        format!("{}\n", serde_json::json!({"step": {"detected_km_h": speeds}}))
    });
    (format!("{json}\n"), steps.collect())
}
