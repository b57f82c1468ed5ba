//! `aspect-acceptance`: [`atc_kernel::aspect`] behind the protocol.

use atc_kernel::Machine as _;
use atc_kernel::aspect::{Acceptance, AspectId, AspectSet, AspectTable, Display, MAX_ASPECTS, State, Times};
use atc_kernel::speed::KmhTenths;
pub use atc_line::aspect::Config;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::contract::Machine;
use crate::kmh::{Kmh, KmhOrNull};

/// One logic cycle's input.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "AspectStep")]
pub struct Step {
    /// The aspects whose signal was heard throughout the cycle, in any order, each at most once.
    pub detected_km_h: Vec<Kmh>,
}

/// One logic cycle's output.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[schemars(rename = "AspectOutput")]
pub struct Output {
    /// The permitted speed on display from the end of the cycle on; null: no display, which means stop.
    // It may be null, but it may not be missing.
    #[serde(deserialize_with = "Option::deserialize")]
    #[schemars(with = "KmhOrNull")]
    pub display_km_h: Option<Kmh>,
}

/// The machine with its state.
#[derive(Clone, Debug)]
pub struct Aspect {
    table: AspectTable,
    acceptance: Acceptance<MAX_ASPECTS>,
    state: State<MAX_ASPECTS>,
}

impl Aspect {
    /// The times of the line, in cycles.
    pub fn times(&self) -> Times {
        self.acceptance.times
    }

    /// The aspects of the line.
    pub fn table(&self) -> &AspectTable {
        &self.table
    }

    /// The kernel's state.
    pub fn state(&self) -> &State<MAX_ASPECTS> {
        &self.state
    }

    /// The set that a step names.
    ///
    /// # Errors
    /// If it names a speed that the line does not have, or one twice. A receiver treats an unknown code as no
    /// signal; an oracle that did so would hide that two implementations read different tables.
    pub fn detected(&self, step: &Step) -> Result<AspectSet, String> {
        let mut set = AspectSet::EMPTY;
        for (place, speed) in step.detected_km_h.iter().enumerate() {
            let known = u16::try_from(speed.0).ok().and_then(|tenths| self.table.aspect(KmhTenths(tenths)));
            let Some(aspect) = known else {
                return Err(format!(
                    "detected_km_h[{place}] is {speed} km/h, which is not one of this line's aspects: {}",
                    list(&self.table)
                ));
            };
            if set.contains(aspect) {
                return Err(format!("detected_km_h[{place}] is {speed} km/h a second time; each aspect is named once"));
            }
            set = set.with(aspect);
        }
        Ok(set)
    }
}

impl Step {
    /// The step in which these aspects of a line are heard; [`Aspect::detected`] reads it again. Others are left out.
    pub fn of(table: &AspectTable, detected: AspectSet) -> Self {
        let heard = |rank| AspectId::new(rank).is_some_and(|aspect| detected.contains(aspect));
        let heard = (0..).zip(table.speeds()).filter(|(rank, _)| heard(*rank));
        Self { detected_km_h: heard.map(|(_, speed)| Kmh::from(*speed)).collect() }
    }
}

impl Output {
    /// The output that says what is on display, on a line with these aspects.
    pub fn of(table: &AspectTable, display: Display) -> Self {
        let speed = display.aspect().and_then(|aspect| table.speed(aspect));
        Self { display_km_h: speed.map(Kmh::from) }
    }
}

fn list(table: &AspectTable) -> String {
    let speeds: Vec<_> = table.speeds().iter().map(|speed| Kmh::from(*speed).to_string()).collect();
    format!("{} km/h", speeds.join(", "))
}

impl Machine for Aspect {
    const NAME: &'static str = "aspect-acceptance";
    const STEP: &'static str = r#"{"detected_km_h":[45,90]}"#;
    const CONFIG: &'static str = r#"{"cycle_ms":10,"aspects_km_h":[25,45,65,90],"operate_ms":300,"recovery_ms":400,"mask_ms":400,"interruption_ms":800,"shortened_operate_ms":100}"#;

    type Config = Config;
    type Step = Step;
    type Output = Output;

    fn open(config: &Config) -> Result<Self, String> {
        let table = config.table()?;
        let acceptance = Acceptance { times: config.times()? };
        Ok(Self { table, acceptance, state: acceptance.initial() })
    }

    fn step(&mut self, step: &Step) -> Result<Output, String> {
        let detected = self.detected(step)?;
        let (state, display) = self.acceptance.step(self.state, detected);
        self.state = state;
        Ok(Output::of(&self.table, display))
    }

    fn cycles(&self) -> Vec<(&'static str, u16)> {
        let times = self.acceptance.times;
        vec![
            ("operate", times.operate().0),
            ("recovery", times.recovery().0),
            ("recovery_and_mask", times.expiry().0),
            ("interruption", times.interruption().0),
            ("shortened_operate", times.shortened_operate().0),
            ("tolerated_interruption", times.tolerated_interruption().0),
        ]
    }
}
