//! The configuration of the ground's device: a layout, the counted line, and what the transmitters say.

use std::collections::BTreeMap;

use atc_kernel::aspect::{AspectId, AspectTable};
use atc_kernel::block::{self as kernel, Block, LineError};
use atc_kernel::interlocking::{CircuitId, MAX_CODES, PerCircuit, Size, SpeedCode};
use atc_kernel::speed::KmhTenths;
use atc_kernel::telegram::SectionId;
use atc_kernel::time::{Cycle as Clock, Millis, Ticks};
use atc_kernel::wayside::{Equipment, Fixed, Join, Session, SignalPlan, Spot, WaysideError};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use atc_line::kmh::tenths;
use atc_line::refusal::{Refusal, fit, gradient, metres};

use crate::kmh::Kmh;
use crate::machine::block;
use crate::machine::interlocking::{self, Found, Interlocked, Travel};
use crate::machine::sizes::Stationed;
use crate::machine::train::Codes;
use crate::names::{self, Named};

/// The configuration.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "WaysideConfig")]
pub struct Config {
    /// The layout, with the cycle and the speeds of its codes: a configuration of `interlocking`.
    pub layout: interlocking::Config,
    /// The counted line; null or absent: there is none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub counted: Option<CountedLine>,
    /// What the transmitters say.
    pub signals: Signals,
    /// For how long the neighbour's permission counts, from the own cycle that its message answers. Rounded down to cycles; less than
    /// the layout's turn time, and no more than its `telegram_age_ms`, if it has one.
    pub life_ms: u32,
    /// The number of this start of the device, 0 to 65535, never the same twice. It has no default: the neighbour tells starts apart by it.
    #[schemars(range(max = 65535))]
    pub session: u32,
}

/// Along the blocks: from their low end or towards it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
#[schemars(rename = "LineDirection")]
pub enum Direction {
    /// From the low end to the high end.
    Up,
    /// From the high end to the low end.
    Down,
}

impl Named for Direction {
    const WHAT: &'static str = "direction along the line";
    const EVERY: &'static [Self] = &[Self::Up, Self::Down];

    fn name(self) -> &'static str {
        match self {
            Self::Up => "up",
            Self::Down => "down",
        }
    }
}

impl<'de> Deserialize<'de> for Direction {
    fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        names::read(deserializer)
    }
}

/// A counted line on the circuits of a segment.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CountedLine {
    /// The segment that is counted.
    pub segment: String,
    /// The direction of travel that it has, for ever.
    pub travel: Travel,
    /// The same along the blocks, whose low end is where the list begins.
    pub direction: Direction,
    /// The length of the longest train, in whole metres.
    pub train_m: u32,
    /// The blocks, from the low end: 1 to 8.
    pub blocks: Vec<CountedBlock>,
}

/// One block of a counted line. Its fields are those of `block-count`.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CountedBlock {
    /// The circuit on each of its sections, from the low end: 1 to 16.
    pub circuits: Vec<String>,
    /// The most trains that may be in it: 1 to the number of its sections.
    pub max_trains: u32,
    /// How many sections are held occupied behind every head: 0 to 16, the same for all blocks.
    pub tail_hold_sections: u32,
    /// The longest that a passing train keeps the check-in on. Rounded down to cycles.
    #[serde(default = "default_pass")]
    pub pass_ms: u32,
}

const fn default_pass() -> u32 {
    10_000
}

/// What the transmitters say. Each speed of a code needs a rank and a pair, also 0.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "WaysideSignals")]
pub struct Signals {
    /// The line's speeds as trains have them, the lowest first: their places are the ranks in telegrams.
    pub speeds_km_h: Vec<Kmh>,
    /// What trains are told for the layout's codes 1, 2, …: as many speeds as it has codes, never falling, none above its code's; null or absent:
    /// the codes' own.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub code_speeds_km_h: Option<Vec<Kmh>>,
    /// The pairs of code frequencies as trains have them.
    pub codes: Codes,
    /// What is said of each circuit; nothing is sent in one that is not here.
    pub circuits: BTreeMap<String, CircuitSignals>,
}

/// What trains are told of a circuit. Its length is the layout's.
#[derive(Clone, Copy, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CircuitSignals {
    /// Those that travel towards the left.
    pub left: FacingSignals,
    /// Those that travel towards the right.
    pub right: FacingSignals,
}

/// What trains of one direction of travel are told of a circuit.
#[derive(Clone, Copy, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FacingSignals {
    /// The number by which they know it, 0 to 65535. Trains of the other direction know it by another one.
    #[schemars(range(max = 65535))]
    pub section: u32,
    /// The least favourable gradient in thousandths, positive where the train climbs: -128 to 127.
    #[schemars(range(min = -128, max = 127))]
    pub gradient_permille: i32,
    /// The limit by curves and points: one of the line's speeds.
    pub curve_km_h: Kmh,
}

/// What a device is made of, checked part by part.
pub(super) struct Parts<Z: Size> {
    pub(super) blocks: Vec<Block>,
    /// The blocks' circuits, from the low end.
    circuits: Vec<[Option<CircuitId>; 16]>,
    pub(super) signals: SignalPlan<Z>,
    pub(super) life: Ticks,
    pub(super) session: Session,
}

/// A number of a start.
pub(super) fn session(field: &str, number: u32) -> Result<Session, Refusal> {
    fit(field, number, "0 to 65535").map(Session)
}

impl Stationed for Config {
    fn is_large(&self) -> bool {
        self.layout.is_large()
    }
}

impl Config {
    /// The parts.
    ///
    /// # Errors
    /// The first that breaks a rule of its own, in a sentence.
    pub(super) fn parts<const R: usize, const P: usize, const N: usize, const S: usize, Z: Size>(
        &self,
        station: &Interlocked<R, P, N, S, Z>,
    ) -> Result<Parts<Z>, String> {
        let cycle = Millis(station.cycle_ms());
        let (mut blocks, mut circuits) = (Vec::new(), Vec::new());
        for (number, block) in self.counted.iter().flat_map(|counted| &counted.blocks).enumerate() {
            let field = format!("counted.blocks[{number}]");
            let sections = u32::try_from(block.circuits.len()).unwrap_or(u32::MAX);
            let &CountedBlock { max_trains, tail_hold_sections, pass_ms, .. } = block;
            let its = block::Config { sections, max_trains, tail_hold_sections, cycle_ms: cycle.0, pass_ms };
            blocks.push(its.block().map_err(|refusal| format!("{field}.{}", refusal.what))?);
            let mut row = [None; 16];
            for (place, (name, circuit)) in block.circuits.iter().zip(&mut row).enumerate() {
                *circuit = Some(station.circuit(name, &format!("{field}.circuits[{place}]"))?);
            }
            circuits.push(row);
        }
        let life = Clock::new(cycle).and_then(|cycle| cycle.at_most(Millis(self.life_ms)));
        let life = life.ok_or_else(|| format!("life_ms is {} ms; it must be at most 60000 cycles", self.life_ms))?;
        // `oracle layout border` holds that age against the neighbour's turn time, and sees no life.
        let said = station.said();
        if let Some(age) = said.map(|said| said.telegram_age_ms).filter(|age| self.life_ms > *age) {
            return Err(format!(
                "life_ms is {} ms; it must be at most the layout's telegram_age_ms, {age} ms, for which the neighbour's turn time is checked",
                self.life_ms
            ));
        }
        // Blocks that hold less report the end of the longest train free.
        let longest = said.and_then(|said| said.longest_train_m);
        let counted = self.counted.as_ref().zip(longest);
        if let Some((line, longest)) = counted.filter(|(line, longest)| line.train_m < u32::from(*longest)) {
            return Err(format!(
                "counted.train_m is {} m; it must be at least the layout's longest_train_m, {longest} m",
                line.train_m
            ));
        }
        let signals = self.signals.plan(station)?;
        Ok(Parts { blocks, circuits, signals, life, session: session("session", self.session)? })
    }

    /// The equipment of a device with `B` blocks.
    ///
    /// # Errors
    /// What the layout does not have, in a sentence.
    pub(super) fn equipment<const B: usize, const R: usize, const P: usize, const N: usize, const S: usize, Z: Size>(
        &self,
        station: &Interlocked<R, P, N, S, Z>,
        parts: &Parts<Z>,
    ) -> Result<Equipment<B, Z>, String> {
        let mut counted = None;
        if let Some(line) = &self.counted {
            let few = || format!("counted.blocks has {} blocks; a line has 1 to 8", parts.blocks.len());
            counted = Some(Join {
                blocks: parts.blocks.clone().try_into().map_err(|_| few())?,
                direction: match line.direction {
                    Direction::Up => kernel::Direction::Up,
                    Direction::Down => kernel::Direction::Down,
                },
                train: metres("counted.train_m", line.train_m)?,
                segment: station.segment(&line.segment, "counted.segment")?,
                travel: line.travel.0,
                circuits: parts.circuits.clone().try_into().map_err(|_| few())?,
            });
        }
        Ok(Equipment { counted, signals: parts.signals, life: parts.life, session: parts.session })
    }

    /// Which rule the parts break together.
    pub(super) fn explain<const R: usize, const P: usize, const N: usize, const S: usize, Z: Size>(
        &self,
        station: &Interlocked<R, P, N, S, Z>,
        error: WaysideError,
    ) -> String {
        let circuit =
            |id: CircuitId| station.names().circuits.get(usize::from(id.number())).cloned().unwrap_or_default();
        let speed = |code: SpeedCode| {
            let told = self.signals.speeds(station.speeds_kmh()).unwrap_or_default();
            Kmh::from(told.get(usize::from(code.0)).copied().flatten().unwrap_or_default())
        };
        let segment = self.counted.as_ref().map_or("", |counted| &counted.segment);
        let at = |spot: Spot| format!("counted.blocks[{}].circuits[{}]", spot.block, spot.section);
        let on = |spot: Spot| {
            let block = self.counted.as_ref().and_then(|counted| counted.blocks.get(usize::from(spot.block)));
            block.and_then(|block| block.circuits.get(usize::from(spot.section))).cloned().unwrap_or_default()
        };
        match error {
            WaysideError::NoSuchSegment => format!("counted.segment is {segment}; the layout has no such segment"),
            WaysideError::RouteAgainstTheLine(route) => format!(
                "route {} needs segment {segment} against counted.travel; a counted line has one direction of travel",
                station.names().routes.get(usize::from(route)).map_or("", String::as_str)
            ),
            WaysideError::RouteOfAnotherLine(route) => format!(
                "route {} leads over a circuit of counted.blocks, or has one in its overlap, and does not need segment {segment}; \
                 its trains would be heard and never checked in: count no circuit that they use",
                station.names().routes.get(usize::from(route)).map_or("", String::as_str)
            ),
            WaysideError::SectionWithoutCircuit(spot) | WaysideError::CircuitWithoutSection(spot) => {
                format!("{} has not one circuit; every section has one", at(spot))
            }
            WaysideError::SectionElsewhere(spot) => {
                format!("{} is {}; it must be a circuit of segment {segment} or its throat", at(spot), on(spot))
            }
            WaysideError::SectionsOutOfOrder(spot) => format!(
                "{} is {}; it must be the circuit that follows the one before it, in counted.direction and counted.travel",
                at(spot),
                on(spot)
            ),
            WaysideError::Line(error) => explain_line(error),
            WaysideError::NothingBeyondTheExit => {
                "counted.blocks reach to the end of the layout; a circuit must be beyond the line's exit".to_owned()
            }
            WaysideError::HoldTooShortAtTheEntry => format!(
                "tail_hold_sections is too small at the line's entry; the places that are held must be as long as counted.train_m, {} m",
                self.counted.as_ref().map_or(0, |counted| counted.train_m)
            ),
            WaysideError::StopMoves => "code 0 of the layout is of another speed than 0 km/h".to_owned(),
            WaysideError::SpeedsFall(code) => {
                format!("code {} of the layout is told as a lower speed than a code below it; it must not be", code.0)
            }
            WaysideError::NoRank(code) => {
                format!(
                    "signals.speeds_km_h has not {} km/h, as which code {} of the layout is told",
                    speed(code),
                    code.0
                )
            }
            WaysideError::NoPair(code) => {
                format!(
                    "signals.codes.pairs has no pair for {} km/h, as which code {} of the layout is told",
                    speed(code),
                    code.0
                )
            }
            WaysideError::CodeWithoutSpeed(code) => {
                format!("code {} of the layout has a braking distance and no speed", code.0)
            }
            WaysideError::CircuitWithoutSignals(id) => {
                format!(
                    "signals.circuits has not {}; it must have every circuit of a path, an entry or a segment",
                    circuit(id)
                )
            }
            WaysideError::NoLength(id) => format!("signals.circuits.{} has no length in the layout", circuit(id)),
            WaysideError::UnknownCurve(id) => {
                format!("signals.circuits.{}.curve_km_h is not in signals.speeds_km_h", circuit(id))
            }
            WaysideError::SectionNumberOfOther(id) => format!(
                "signals.circuits.{} has a section number of the other direction of travel; left.section must be odd and right.section even",
                circuit(id)
            ),
            WaysideError::SectionNumberTwice(id) => {
                format!("signals.circuits.{} has a section number that stands for another circuit", circuit(id))
            }
            WaysideError::NoLife => format!("life_ms is {} ms; it must be one cycle at least", self.life_ms),
            WaysideError::LifeOutlastsTurn => {
                format!(
                    "life_ms is {} ms; it must be less than the layout's turn time, and no more with the residual running and the loss of shunt, and at most \
                     60000 cycles",
                    self.life_ms
                )
            }
        }
    }
}

fn explain_line(error: LineError) -> String {
    match error {
        LineError::NoBlocks => "counted.blocks is empty; a line has 1 to 8 blocks".to_owned(),
        LineError::TooManySections => "counted.blocks have more than 64 sections together".to_owned(),
        LineError::LengthsDoNotMatch => "counted.blocks have not as many circuits as sections".to_owned(),
        LineError::NoLength(section) => format!("the circuit of section {section} of the counted line has no length"),
        LineError::HoldsDiffer(block) => {
            format!(
                "counted.blocks[{block}].tail_hold_sections is not that of counted.blocks[0]; they must be the same"
            )
        }
        LineError::HoldTooShort(section) => format!(
            "tail_hold_sections is too small: what is held from section {section} on is shorter than counted.train_m"
        ),
        LineError::TrainTooLong => "counted.train_m needs more than 16 sections held".to_owned(),
    }
}

impl Signals {
    fn plan<const R: usize, const P: usize, const N: usize, const S: usize, Z: Size>(
        &self,
        station: &Interlocked<R, P, N, S, Z>,
    ) -> Result<SignalPlan<Z>, String> {
        let mut ranks = Vec::new();
        for (place, speed) in self.speeds_km_h.iter().enumerate() {
            ranks.push(tenths(&format!("signals.speeds_km_h[{place}]"), *speed)?);
        }
        let aspects = AspectTable::new(&ranks).map_err(|_| {
            "signals.speeds_km_h must have 1 to 16 speeds, each higher than the one before it".to_owned()
        })?;
        let mut circuits = PerCircuit::NONE;
        for (name, its) in &self.circuits {
            let field = format!("signals.circuits.{name}");
            let number = usize::from(station.circuit(name, "signals.circuits")?.number());
            let found = |side: usize| station.said().and_then(|said| said.facing[side].get(number).copied());
            for (facing, side, found) in [(its.left, "left", found(0)), (its.right, "right", found(1))] {
                if let Some(wrong) = found.and_then(|found| facing.wrong(found)) {
                    return Err(format!("{field}.{side}.{wrong}"));
                }
            }
            let left = its.left.kernel(&format!("{field}.left"), &aspects)?;
            let right = its.right.kernel(&format!("{field}.right"), &aspects)?;
            if let Some(place) = circuits.get_mut(number) {
                *place = Some(Fixed { left, right });
            }
        }
        let speeds = self.speeds(station.speeds_kmh())?;
        let codes = self.codes.table().map_err(|what| format!("signals.{what}"))?;
        Ok(SignalPlan { circuits, speeds, aspects, codes })
    }
}

impl Signals {
    /// What each code is told as, of a layout with these speeds in km/h. There 0 stands for a code that it has not, and for code 0.
    fn speeds(&self, layout: impl IntoIterator<Item = u16>) -> Result<[Option<KmhTenths>; MAX_CODES], String> {
        let mut speeds = [None; MAX_CODES];
        for (code, (speed, kmh)) in speeds.iter_mut().zip(layout).enumerate() {
            *speed = (code == 0 || kmh > 0).then(|| KmhTenths(kmh.saturating_mul(10)));
        }
        let Some(named) = &self.code_speeds_km_h else { return Ok(speeds) };
        let codes = speeds.iter().skip(1).flatten().count();
        if named.len() != codes {
            return Err(format!(
                "signals.code_speeds_km_h has {} speeds; the layout has {codes} codes above 0",
                named.len()
            ));
        }
        for (place, (speed, named)) in speeds.iter_mut().skip(1).flatten().zip(named).enumerate() {
            let field = format!("signals.code_speeds_km_h[{place}]");
            let told = tenths(&field, *named)?;
            if told > *speed {
                return Err(format!(
                    "{field} is {named}; it must be at most {} km/h, its code's speed",
                    Kmh::from(*speed)
                ));
            }
            *speed = told;
        }
        Ok(speeds)
    }
}

impl FacingSignals {
    /// What trains would be told wrongly, against the layout's file.
    fn wrong(&self, found: Found) -> Option<String> {
        let (fall, fastest) = (i32::from(found.fall_permille), found.fastest_kmh);
        if self.gradient_permille > -fall {
            // The layout does not say which way it falls.
            return Some(format!(
                "gradient_permille is {}; it must be at most {}: the layout has {fall} ‰ in the circuit or ahead of it, whichever way that falls",
                self.gradient_permille, -fall
            ));
        }
        // A train by codes hears nothing of this limit.
        (self.curve_km_h < Kmh::from(KmhTenths(fastest.saturating_mul(10)))).then(|| {
            format!(
                "curve_km_h is {}; it must be at least {fastest} km/h, at which the layout lets trains run there, by codes too",
                self.curve_km_h
            )
        })
    }

    fn kernel(&self, field: &str, aspects: &AspectTable) -> Result<atc_kernel::wayside::Facing, String> {
        let speed = tenths(&format!("{field}.curve_km_h"), self.curve_km_h)?;
        let curve: Option<AspectId> = aspects.aspect(speed);
        let unknown = || format!("{field}.curve_km_h is {}; it must be one of signals.speeds_km_h", self.curve_km_h);
        Ok(atc_kernel::wayside::Facing {
            section: SectionId(fit(&format!("{field}.section"), self.section, "0 to 65535")?),
            gradient: gradient(&format!("{field}.gradient_permille"), self.gradient_permille)?,
            curve: curve.ok_or_else(unknown)?,
        })
    }
}
