//! The parameters of the permitted speed.

use atc_kernel::aspect::{AspectId, AspectTable};
use atc_kernel::permitted::{Permitted, PermittedError, Settings};
use atc_kernel::speed::KmhTenths;
use atc_kernel::telegram::{Sequence, SequenceError};
use atc_kernel::time::{Cycle, MAX_TICKS, Millis, Ticks};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::aspect;
use crate::kmh::{Kmh, tenths};
use crate::refusal::{Refusal, brake, gradient, metres, no_cycle, short};
use crate::rule::Rule;

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
    /// The parameters of a device in cycles of this length.
    pub fn of(permitted: &Permitted, cycle: Millis) -> Self {
        let Settings { speeds, lowest, brake, worst, margin, fresh, life, fixed_life, sequence } = permitted.settings();
        let ms = |time: Ticks| cycle.0.saturating_mul(time.0.into());
        Self {
            cycle_ms: cycle.0,
            speeds_km_h: speeds.speeds().iter().copied().map(Kmh::from).collect(),
            lowest_limit_km_h: speeds.speed(*lowest).map(Kmh::from).unwrap_or_default(),
            brake_mm_s2: brake.mm_s2().into(),
            worst_gradient_permille: worst.0.into(),
            margin_m: margin.0.into(),
            fresh_ms: ms(*fresh),
            life_ms: ms(*life),
            fixed_life_ms: ms(*fixed_life),
            window: sequence.window().into(),
            run: sequence.run().into(),
            memory_ms: ms(sequence.memory()),
        }
    }

    /// The parameters in the kernel's form.
    ///
    /// # Errors
    /// The rule that they break.
    pub fn permitted(&self) -> Result<Permitted, Refusal> {
        let cycle = Cycle::new(Millis(self.cycle_ms)).ok_or_else(|| no_cycle(Rule::Per9))?;
        let longest = u64::from(self.cycle_ms) * u64::from(MAX_TICKS);
        let time = |rule: Rule, field: &str, ms: u32| -> Result<Ticks, Refusal> {
            let what = || format!("{field} is {ms} ms; it must be at most {MAX_TICKS} cycles, {longest} ms");
            cycle.at_most(Millis(ms)).ok_or_else(|| Refusal::new(rule, field, what()))
        };
        let speeds = self.table()?;
        let lowest = self.rank(&speeds)?;
        let (brake, worst) = (
            brake("brake_mm_s2", self.brake_mm_s2)?,
            gradient("worst_gradient_permille", self.worst_gradient_permille)?,
        );
        let margin = metres("margin_m", self.margin_m)?;
        let fresh = time(Rule::Per9, "fresh_ms", self.fresh_ms)?;
        let life = time(Rule::Per9, "life_ms", self.life_ms)?;
        let fixed_life = time(Rule::Per9, "fixed_life_ms", self.fixed_life_ms)?;
        let memory = time(Rule::Tel7, "memory_ms", self.memory_ms)?;
        let sequence = self.sequence(memory)?;
        let settings = Settings { speeds, lowest, brake, worst, margin, fresh, life, fixed_life, sequence };
        let cycle = self.cycle_ms;
        let broken = |field: &str, what: String| Refusal::new(Rule::Per9, field, what);
        Permitted::new(settings).map_err(|error| match error {
            PermittedError::NoFreshness => short(Rule::Per9, "fresh_ms", self.fresh_ms, cycle),
            PermittedError::NoFixedLife => short(Rule::Per9, "fixed_life_ms", self.fixed_life_ms, cycle),
            PermittedError::LifeShorterThanFreshness => broken(
                "life_ms",
                format!(
                    "life_ms is {} ms and fresh_ms {} ms, {} and {} cycles of {cycle} ms; life_ms must not be shorter",
                    self.life_ms, self.fresh_ms, life.0, fresh.0
                ),
            ),
            PermittedError::UnknownLimit => {
                broken("lowest_limit_km_h", "lowest_limit_km_h is not one of speeds_km_h".to_owned())
            }
            PermittedError::MemoryLongerThanLife => broken(
                "memory_ms",
                format!(
                    "memory_ms is {} ms, longer than life_ms, {} ms, or fixed_life_ms, {} ms; it must not be longer than either",
                    self.memory_ms, self.life_ms, self.fixed_life_ms
                ),
            ),
            PermittedError::TooLong => broken("life_ms", format!("a time is over {MAX_TICKS} cycles, {longest} ms")),
        })
    }

    fn sequence(&self, memory: Ticks) -> Result<Sequence, Refusal> {
        // What does not fit is over every limit.
        let narrow = |number: u32| u8::try_from(number).unwrap_or(u8::MAX);
        Sequence::new(narrow(self.window), narrow(self.run), memory).map_err(|error| {
            let (field, what) = match error {
                SequenceError::NoWindow | SequenceError::WindowTooWide => (
                    "window",
                    format!("window is {}; the counter may advance by at least 1 and at most 127", self.window),
                ),
                SequenceError::NoRun | SequenceError::RunTooLong => {
                    ("run", format!("run is {}; 1 to 15 telegrams in a row must have advanced", self.run))
                }
                SequenceError::NoMemory | SequenceError::MemoryTooLong => {
                    return short(Rule::Tel7, "memory_ms", self.memory_ms, self.cycle_ms);
                }
            };
            Refusal::new(Rule::Tel7, field, what)
        })
    }

    fn table(&self) -> Result<AspectTable, Refusal> {
        let speed = |(place, speed): (usize, &Kmh)| tenths(&format!("speeds_km_h[{place}]"), *speed);
        let speeds = self.speeds_km_h.iter().enumerate().map(speed).collect::<Result<Vec<_>, _>>()?;
        aspect::table("speeds_km_h", "speeds", &speeds)
    }

    fn rank(&self, speeds: &AspectTable) -> Result<AspectId, Refusal> {
        let field = "lowest_limit_km_h";
        rank(speeds, self.lowest_limit_km_h).ok_or_else(|| {
            let (limit, speeds) = (self.lowest_limit_km_h, list(speeds));
            let what = format!("{field} is {limit} km/h; it must be one of speeds_km_h: {speeds} km/h");
            Refusal::new(Rule::Per9, field, what)
        })
    }
}

/// The rank of a speed in a table; none if it is not there.
pub(crate) fn rank(speeds: &AspectTable, speed: Kmh) -> Option<AspectId> {
    u16::try_from(speed.0).ok().and_then(|tenths| speeds.aspect(KmhTenths(tenths)))
}

/// The speeds of a table, for a sentence.
pub(crate) fn list(speeds: &AspectTable) -> String {
    speeds.speeds().iter().map(|speed| Kmh::from(*speed).to_string()).collect::<Vec<_>>().join(", ")
}
