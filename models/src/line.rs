//! The lines that are modelled: a cycle, five times and up to four aspects.
//!
//! The small lines keep every inequality between the times that the machine can tell apart, at a cycle that makes
//! an exhaustive search short.

use atc_kernel::aspect::{Times, TimesMs};
use atc_kernel::time::Millis;

/// The permitted speeds of the modelled aspects in km/h, the lowest first. A model of `N` aspects has the first `N`.
pub const ASPECTS_KM_H: [u16; 4] = [25, 45, 65, 90];

/// The times of a line, as its configuration gives them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Line {
    /// What is particular about it, in words.
    pub about: &'static str,
    /// The length of a logic cycle.
    pub cycle: Millis,
    /// T1 to T5.
    pub times: TimesMs,
}

/// The example of the patent at its own cycle.
pub const DEFAULT: Line =
    Line { about: "the default times at a cycle of 10 ms", cycle: Millis(10), times: ms(300, 400, 400, 800, 100) };

/// The example of the patent in steps of its shortest time.
pub const COARSE: Line =
    Line { about: "the default times at a cycle of 100 ms", cycle: Millis(100), times: ms(300, 400, 400, 800, 100) };

/// The example of the patent in steps of half its shortest time: T5 is more than one cycle.
pub const FINE: Line =
    Line { about: "the default times at a cycle of 50 ms", cycle: Millis(50), times: ms(300, 400, 400, 800, 100) };

/// T2+T3−T5 < T4: a credit can outlive expiry, and the longest tolerated interruption is T2+T3−T5.
pub const LATE: Line =
    Line { about: "a credit can outlive expiry", cycle: Millis(100), times: ms(300, 200, 300, 400, 200) };

/// T4 < T2+T3−T5: the longest tolerated interruption is T4.
pub const EARLY: Line =
    Line { about: "T4 is the limit of an interruption", cycle: Millis(100), times: ms(300, 200, 300, 200, 100) };

/// The shortest times that the constructor takes: no mask, no credit.
pub const SHORTEST: Line =
    Line { about: "the shortest times that are accepted", cycle: Millis(100), times: ms(200, 100, 0, 0, 100) };

impl Line {
    /// The times in cycles.
    ///
    /// # Panics
    /// If the constructor rejects the times; the lines of this module are all accepted, as a test shows.
    pub fn ticks(&self) -> Times {
        Times::from_millis(self.cycle, self.times).expect("a line of this module")
    }

    /// The line in one sentence: what is particular, the times in cycles, the aspects.
    pub fn describe(&self, aspects: usize) -> String {
        let t = self.ticks();
        format!(
            "{}: T1 = {}, T2 = {}, T2+T3 = {}, T4 = {}, T5 = {} cycles of {} ms; {aspects} aspect{}",
            self.about,
            t.operate().0,
            t.recovery().0,
            t.expiry().0,
            t.interruption().0,
            t.shortened_operate().0,
            self.cycle.0,
            if aspects == 1 { "" } else { "s" },
        )
    }

    /// `ticks` in milliseconds on this line.
    pub fn millis(&self, ticks: u16) -> u32 {
        self.cycle.0 * u32::from(ticks)
    }
}

/// The longest interruption after which a device never drops an aspect heard alone, of those that T5 and T4 allow:
/// min(T4, T2+T3−T5).
pub fn credited_gap(times: Times) -> u16 {
    times.interruption().0.min(times.expiry().0.saturating_sub(times.shortened_operate().0))
}

const fn ms(operate: u32, recovery: u32, mask: u32, interruption: u32, shortened_operate: u32) -> TimesMs {
    TimesMs {
        operate: Millis(operate),
        recovery: Millis(recovery),
        mask: Millis(mask),
        interruption: Millis(interruption),
        shortened_operate: Millis(shortened_operate),
    }
}
