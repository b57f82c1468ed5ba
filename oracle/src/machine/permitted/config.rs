//! The configuration of the permitted speed.

use atc_kernel::aspect::{AspectTable, TableError};
use atc_kernel::permitted::{Permitted, PermittedError, Settings};
use atc_kernel::speed::KmhTenths;
use atc_kernel::telegram::{Sequence, SequenceError};
use atc_kernel::time::{Cycle, MAX_TICKS, Millis};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::kmh::Kmh;
use crate::machine::pattern::brake;
use crate::telegrams::{gradient, metres};

/// The configuration. The defaults are of an urban line with frames of 530 ms (106 bits at 200 bit/s). Every time is one for which
/// something is still believed, so every time is rounded down to cycles.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
#[schemars(rename = "PermittedConfig")]
pub struct Config {
    /// The length of a logic cycle.
    pub cycle_ms: u32,
    /// The line's speeds, to which the ranks in telegrams refer: 1 to 16, strictly rising, 0 to 6553.5 km/h.
    pub speeds_km_h: Vec<Kmh>,
    /// The lowest limit that a sub telegram of this line carries; one of the speeds. It is assumed until the sub telegram is heard.
    pub lowest_limit_km_h: Kmh,
    /// The train's deceleration by its service brake on the level, in mm/s²: 1 to 4095.
    #[schemars(range(min = 1, max = 4095))]
    pub brake_mm_s2: u32,
    /// The worst gradient that a sub telegram of this line carries, in thousandths, negative where the train descends: -128 to 127.
    /// It is assumed until the sub telegram is heard.
    #[schemars(range(min = -128, max = 127))]
    pub worst_gradient_permille: i32,
    /// What is taken off every distance to a stopping point, in whole metres: 0 to 65535.
    #[schemars(range(max = 65535))]
    pub margin_m: u32,
    /// For how long a main telegram is fresh: one cycle or more.
    pub fresh_ms: u32,
    /// For how long the pattern of the last main telegram runs down, and a code alone is enough on a digital line: `fresh_ms` or
    /// more.
    pub life_ms: u32,
    /// For how long a sub telegram is used: one cycle or more.
    pub fixed_life_ms: u32,
    /// By how much the counter may advance from one telegram to the next: 1 to 127.
    #[schemars(range(min = 1, max = 127))]
    pub window: u32,
    /// How many telegrams in a row must have advanced their counter before one is used: 1 to 15.
    #[schemars(range(min = 1, max = 15))]
    pub run: u32,
    /// After how long without a telegram its predecessors are forgotten: one cycle or more, and no longer than `life_ms` and
    /// `fixed_life_ms`.
    pub memory_ms: u32,
}

impl Default for Config {
    fn default() -> Self {
        Self {
            cycle_ms: 10,
            speeds_km_h: [0, 150, 250, 450, 550, 650, 750, 900].map(Kmh).to_vec(),
            lowest_limit_km_h: Kmh(250),
            brake_mm_s2: 800,
            worst_gradient_permille: -35,
            margin_m: 10,
            // Two telegrams in a row may be lost: the age counts from the telegram before the last one.
            fresh_ms: 2200,
            life_ms: 5000,
            fixed_life_ms: 10_000,
            window: 3,
            run: 1,
            memory_ms: 2000,
        }
    }
}

impl Config {
    /// The parameters in the kernel's form.
    ///
    /// # Errors
    /// The rule that they break, in a sentence.
    pub fn permitted(&self) -> Result<Permitted, String> {
        let cycle = Cycle::new(Millis(self.cycle_ms)).ok_or("cycle_ms is 0; a logic cycle is 1 ms or more")?;
        let longest = u64::from(self.cycle_ms) * u64::from(MAX_TICKS);
        let time = |field: &str, ms: u32| {
            cycle
                .at_most(Millis(ms))
                .ok_or_else(|| format!("{field} is {ms} ms; it must be at most {MAX_TICKS} cycles, {longest} ms"))
        };
        let speeds = self.table()?;
        let lowest = u16::try_from(self.lowest_limit_km_h.0).ok().and_then(|limit| speeds.aspect(KmhTenths(limit)));
        let lowest = lowest.ok_or_else(|| {
            let speeds: Vec<_> = self.speeds_km_h.iter().map(Kmh::to_string).collect();
            let (limit, speeds) = (self.lowest_limit_km_h, speeds.join(", "));
            format!("lowest_limit_km_h is {limit} km/h; it must be one of speeds_km_h: {speeds} km/h")
        })?;
        // What does not fit is over every limit.
        let narrow = |number: u32| u8::try_from(number).unwrap_or(u8::MAX);
        let (brake, worst) =
            (brake(self.brake_mm_s2)?, gradient("worst_gradient_permille", self.worst_gradient_permille)?);
        let margin = metres("margin_m", self.margin_m)?;
        let fresh = time("fresh_ms", self.fresh_ms)?;
        let life = time("life_ms", self.life_ms)?;
        let fixed_life = time("fixed_life_ms", self.fixed_life_ms)?;
        let memory = time("memory_ms", self.memory_ms)?;
        let sequence = Sequence::new(narrow(self.window), narrow(self.run), memory).map_err(|error| match error {
            SequenceError::NoWindow | SequenceError::WindowTooWide => {
                format!("window is {}; the counter may advance by at least 1 and at most 127", self.window)
            }
            SequenceError::NoRun | SequenceError::RunTooLong => {
                format!("run is {}; 1 to 15 telegrams in a row must have advanced", self.run)
            }
            SequenceError::NoMemory | SequenceError::MemoryTooLong => self.short("memory_ms", self.memory_ms),
        })?;
        let settings = Settings { speeds, lowest, brake, worst, margin, fresh, life, fixed_life, sequence };
        Permitted::new(settings).map_err(|error| match error {
            PermittedError::NoFreshness => self.short("fresh_ms", self.fresh_ms),
            PermittedError::NoFixedLife => self.short("fixed_life_ms", self.fixed_life_ms),
            PermittedError::LifeShorterThanFreshness => format!(
                "life_ms is {} ms and fresh_ms {} ms, {} and {} cycles of {} ms; life_ms must not be shorter",
                self.life_ms, self.fresh_ms, life.0, fresh.0, self.cycle_ms
            ),
            PermittedError::UnknownLimit => "lowest_limit_km_h is not one of speeds_km_h".to_owned(),
            PermittedError::MemoryLongerThanLife => format!(
                "memory_ms is {} ms, longer than life_ms, {} ms, or fixed_life_ms, {} ms; it must not be longer than either",
                self.memory_ms, self.life_ms, self.fixed_life_ms
            ),
            PermittedError::TooLong => format!("a time is over {MAX_TICKS} cycles, {longest} ms"),
        })
    }

    fn short(&self, field: &str, ms: u32) -> String {
        let cycle = self.cycle_ms;
        format!("{field} is {ms} ms, less than one cycle of {cycle} ms; it must be {cycle} ms or more")
    }

    fn table(&self) -> Result<AspectTable, String> {
        let given = &self.speeds_km_h;
        let mut speeds = Vec::with_capacity(given.len());
        for (place, speed) in given.iter().enumerate() {
            speeds.push(tenths(&format!("speeds_km_h[{place}]"), *speed)?);
        }
        AspectTable::new(&speeds).map_err(|error| match error {
            TableError::Empty => "speeds_km_h is empty; it must name 1 to 16 speeds".to_owned(),
            TableError::TooMany => format!("speeds_km_h has {} entries; it must name 1 to 16 speeds", given.len()),
            TableError::NotRising(place) => format!(
                "speeds_km_h[{place}] is {} km/h after {} km/h; the speeds must rise strictly",
                given[place],
                given[place - 1],
            ),
        })
    }
}

/// A speed that must fit, or a sentence that says so.
pub(in crate::machine) fn tenths(field: &str, speed: Kmh) -> Result<KmhTenths, String> {
    u16::try_from(speed.0).map(KmhTenths).map_err(|_| format!("{field} is {speed} km/h; it must be 0 to 6553.5 km/h"))
}
