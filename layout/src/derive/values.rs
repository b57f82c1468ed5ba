//! Times in cycles, speeds as codes, braking distances.

use atc_kernel::distance::Metres;
use atc_kernel::interlocking::{MAX_CODES, SpeedCode, code_stops_within};
use atc_kernel::pattern::{Deceleration, pattern};
use atc_kernel::speed::KmhTenths;
use atc_kernel::telegram::Gradient;
use atc_kernel::time::{Cycle, Millis, Ticks};

use crate::at::At;
use crate::form::Station;
use crate::model::Values;
use crate::problem::Problem;
use crate::rule::Rule;

/// Which way a time is rounded to whole cycles.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Rounding {
    /// Its lapse permits something: up.
    Permits,
    /// Its lapse restricts: down.
    Restricts,
}

/// A time in cycles.
pub fn ticks(what: &str, time: &At<u32>, rounding: Rounding, cycle: Cycle, problems: &mut Vec<Problem>) -> Ticks {
    let ticks = match rounding {
        Rounding::Permits => cycle.at_least(Millis(time.value)),
        Rounding::Restricts => cycle.at_most(Millis(time.value)),
    };
    match ticks {
        Some(Ticks(0)) | None => {
            let cycle_ms = cycle.length().0;
            let what =
                format!("{what} is {time} ms, {} cycles of {cycle_ms} ms", f64::from(time.value) / f64::from(cycle_ms));
            problems.push(Problem::new(Rule::Range, &time.span, what, "1 to 60 000 cycles are possible"));
            Ticks(1)
        }
        Some(ticks) => ticks,
    }
}

/// A time in cycles, rounded up, that may be none.
fn at_most(what: &str, time: &At<u32>, cycle: Cycle, problems: &mut Vec<Problem>) -> Ticks {
    if time.value == 0 { Ticks(0) } else { ticks(what, time, Rounding::Permits, cycle, problems) }
}

/// The longest cycle: a minute. A longer one is a slip, and the longest time, of 60 000 of them, would be no number of ms any more.
const LONGEST_CYCLE_MS: u32 = 60_000;

/// The farthest that a code may be heard beyond its circuit. More than that is a slip: a circuit is seldom longer.
const MOST_BEYOND_M: u16 = 1_000;

/// The least that is derived of the times to a stand and of the stay.
pub const STANDSTILL_MS: u32 = 15_000;
/// The same of the stay.
pub const STAY_MS: u32 = 30_000;

/// The values for the whole station.
pub fn values(station: &Station, problems: &mut Vec<Problem>) -> (Values, Cycle) {
    let times = &station.times;
    let given = (1..=LONGEST_CYCLE_MS).contains(&times.cycle_ms.value).then_some(Millis(times.cycle_ms.value));
    let cycle = given.and_then(Cycle::new).unwrap_or_else(|| {
        let what = format!("a cycle has {} ms", times.cycle_ms);
        let right = format!("cycle_ms is 1 to {LONGEST_CYCLE_MS}");
        problems.push(Problem::new(Rule::Range, &times.cycle_ms.span, what, right));
        // Any other length will do to find what else is wrong.
        const { Cycle::new(Millis(100)).expect("100 ms is a cycle") }
    });
    let clear = ticks("clear_ms", &times.clear_ms, Rounding::Permits, cycle, problems);
    let clear = u8::try_from(clear.0).unwrap_or_else(|_| {
        let what = format!("clear_ms is {} cycles", clear.0);
        problems.push(Problem::new(Rule::Range, &times.clear_ms.span, what, "1 to 255 cycles are possible"));
        u8::MAX
    });
    let loss = at_most("shunt_loss_ms", &times.shunt_loss_ms, cycle, problems);
    // Where the file says nothing it is derived from the routes.
    let start_ms = times.start_ms.clone().unwrap_or_else(|| At::derived(0));
    let start = at_most("start_ms", &start_ms, cycle, problems);
    let settle = at_most("settle_ms", &times.settle_ms, cycle, problems).0;
    // A command goes out after the cycle's detections came in: the first detection that may show its stroke is a cycle later.
    let settle = if settle > 0 { settle.saturating_add(1) } else { 0 };
    let settle = u8::try_from(settle).unwrap_or_else(|_| {
        let what = format!("settle_ms is {settle} cycles with the one of the command");
        problems.push(Problem::new(Rule::Range, &times.settle_ms.span, what, "0 to 255 cycles are possible"));
        u8::MAX
    });
    // These two are derived from the routes too.
    let standstill_ms = times.standstill_ms.clone().unwrap_or_else(|| At::derived(0));
    let standstill = at_most("standstill_ms", &standstill_ms, cycle, problems);
    let stay_ms = times.stay_ms.clone().unwrap_or_else(|| At::derived(STAY_MS));
    let (speeds_kmh, braking) = codes(station, problems);
    lengths(station, problems);
    let least_residual_ms = times.telegram_age_ms.value.saturating_add(stopping_ms(station, speeds_kmh));
    let residual_ms = times.residual_ms.clone().unwrap_or_else(|| At::derived(least_residual_ms));
    let residual = at_most("residual_ms", &residual_ms, cycle, problems);
    let run_ms = run_ms(times.telegram_age_ms.value, residual_ms.value, times.shunt_loss_ms.value);
    let least_turn_ms = if station.segments.is_empty() { 0 } else { run_ms };
    let turn_ms = times.turn_ms.clone().unwrap_or_else(|| At::derived(run_ms));
    let turn = ticks("turn_ms", &turn_ms, Rounding::Permits, cycle, problems);
    let values = Values {
        cycle_ms: cycle.length().0,
        clear,
        // More than that is more than any T_clear.
        loss: u8::try_from(loss.0).unwrap_or(u8::MAX),
        start,
        start_ms,
        settle,
        residual_ms,
        residual,
        least_residual_ms,
        standstill,
        standstill_ms,
        stay_ms,
        brake_mm_s2: brake(station).map_or(0, Deceleration::mm_s2),
        cab_signalled: station.cab_signalled,
        turn,
        turn_ms,
        least_turn_ms,
        telegram_age_ms: times.telegram_age_ms.value,
        speeds_kmh,
        heard_beyond: Metres(station.braking.heard_beyond_m.value),
        braking,
        least_overlap: Metres(station.overlaps.least_m.value),
        longest_train: station.longest_train_m.as_ref().map(|length| Metres(length.value)),
        shortest_train: station.shortest_train_m.as_ref().map(|length| Metres(length.value)),
        strongest_mm_s2: {
            let braking = &station.braking;
            braking.strongest_mm_s2.as_ref().unwrap_or(&braking.deceleration_mm_s2).value
        },
    };
    (values, cycle)
}

/// A train has a length, and none is shorter than the shortest.
fn lengths(station: &Station, problems: &mut Vec<Problem>) {
    let Some(longest) = &station.longest_train_m else { return };
    let least = station.shortest_train_m.as_ref().map_or(1, |length| length.value.max(1));
    if longest.value < least {
        let what = format!("the longest train is {longest} m long");
        let right = format!("longest_train_m is {least} to {}", u16::MAX);
        problems.push(Problem::new(Rule::Range, &longest.span, what, right));
    }
}

/// For how long after a permission was withdrawn a train may still come that was sent on it, unseen at the last: the withdrawal is heard when the
/// telegram before it is too old, the train runs on, and its shunt may be lost.
pub fn run_ms(telegram_ms: u32, residual_ms: u32, loss_ms: u32) -> u32 {
    telegram_ms.saturating_add(residual_ms).saturating_add(loss_ms)
}

/// The steepest fall, in ‰: a train may come either way.
fn worst(station: &Station) -> i8 {
    let gradients = station.circuits.iter().filter_map(|circuit| circuit.gradient.as_ref());
    gradients.map(|gradient| gradient.value.saturating_abs().saturating_neg()).min().unwrap_or(0)
}

/// What every train has of its brake there.
fn brake(station: &Station) -> Option<Deceleration> {
    Deceleration::brake(station.braking.deceleration_mm_s2.value).map(|brake| brake.on(Gradient(worst(station))))
}

/// How long a train takes to a stand from the highest speed, in ms, rounded up.
fn stopping_ms(station: &Station, speeds_kmh: [u16; MAX_CODES]) -> u32 {
    let fastest = speeds_kmh.into_iter().max().map_or(0, u64::from);
    // km/h in mm/s is 1e6 / 3600.
    let of = |brake: Deceleration| (fastest * 1_000_000_000).div_ceil(3600 * u64::from(brake.mm_s2().max(1)));
    brake(station).and_then(|brake| u32::try_from(of(brake)).ok()).unwrap_or(0)
}

/// What a train that comes from telegrams has of its brake there at most, with `level` on the level: on the steepest rise.
pub(crate) fn from_telegrams(station: &Station, level: u16) -> Option<Deceleration> {
    let rise = Gradient(worst(station).saturating_neg());
    Deceleration::brake(level).map(|brake| brake.on(rise))
}

/// The strongest brake by which trains come from telegrams, if the file has one. One that is weaker than what all have, or that cannot be, is a problem.
fn strongest(station: &Station, problems: &mut Vec<Problem>) -> Option<Deceleration> {
    let given = station.braking.strongest_mm_s2.as_ref()?;
    let least = station.braking.deceleration_mm_s2.value;
    let brake = from_telegrams(station, given.value).filter(|_| given.value >= least);
    if brake.is_none() {
        let what = format!("no train that brakes with {least} mm/s² or more has a pattern of at most {given}");
        let right = format!("strongest_mm_s2 is {least} to 4095 mm/s²");
        problems.push(Problem::new(Rule::Range, &given.span, what, right));
    }
    brake
}

fn codes(station: &Station, problems: &mut Vec<Problem>) -> ([u16; MAX_CODES], [Metres; MAX_CODES]) {
    let given = &station.braking;
    let age_ms = station.times.telegram_age_ms.value;
    let worst = worst(station);
    let brake = brake(station);
    let speeds = &given.speeds_kmh;
    let mut right = !speeds.is_empty() && speeds.len() < MAX_CODES;
    right &= speeds.windows(2).all(|pair| pair[0] < pair[1]) && speeds.iter().all(|speed| (1..=409).contains(speed));
    if !right {
        let what = format!("the speeds {:?} km/h cannot be those of the codes", speeds.value);
        problems.push(Problem::new(
            Rule::Range,
            &speeds.span,
            what,
            "give 1 to 7 speeds that rise from 1 to at most 409",
        ));
    }
    let heard = &given.heard_beyond_m;
    let beyond = if heard.value > MOST_BEYOND_M { 0 } else { heard.value };
    if beyond != heard.value {
        let what = format!("codes are heard {heard} m beyond their circuits");
        let right = format!("heard_beyond_m is 0 to {MOST_BEYOND_M}");
        problems.push(Problem::new(Rule::Range, &heard.span, what, right));
    }
    let strongest = strongest(station, problems);
    let mut table = ([0; MAX_CODES], [Metres(u16::MAX); MAX_CODES]);
    let Some(brake) = brake else {
        let what = format!("no train brakes with {} mm/s²", given.deceleration_mm_s2);
        problems.push(Problem::new(Rule::Range, &given.deceleration_mm_s2.span, what, "1 to 4095 mm/s² are possible"));
        return table;
    };
    if !right {
        return table;
    }
    table.1[0] = Metres(0);
    for (code, speed) in (1..MAX_CODES).zip(&speeds.value) {
        table.0[code] = *speed;
        match stopping(brake, KmhTenths(speed * 10)) {
            Some(distance) => {
                let late = aged(*speed, age_ms).saturating_add(stepped(brake, age_ms));
                // Each part is rounded up, so that the kernel finds the first one long enough. What is enough for two brakes is for all between.
                let holds = |brake, metres: u16| code_stops_within(brake, *speed, age_ms, Metres(metres));
                let enough =
                    |metres: &u16| holds(brake, *metres) && strongest.is_none_or(|strongest| holds(strongest, *metres));
                let metres = (distance.0.saturating_add(late)..u16::MAX).find(enough).unwrap_or(u16::MAX);
                // The distance counts from the end of the circuit, and the train may be beyond it.
                table.1[code] = Metres(metres.saturating_add(beyond));
            }
            None => problems.push(Problem::new(
                Rule::Range,
                &given.deceleration_mm_s2.span,
                format!(
                    "with {} mm/s² on a fall of {} ‰ a train does not stop from {speed} km/h within 65 534 m",
                    given.deceleration_mm_s2,
                    -i16::from(worst)
                ),
                "give a stronger brake, a lower speed or less gradient",
            )),
        }
    }
    table
}

/// The least distance, in whole metres, within which the kernel's braking pattern allows `speed`.
pub fn stopping(brake: Deceleration, speed: KmhTenths) -> Option<Metres> {
    let (mut least, mut most) = (0_u16, u16::MAX - 1);
    if pattern(brake, Metres(most)) < speed {
        return None;
    }
    while least < most {
        let middle = least + (most - least) / 2;
        if pattern(brake, Metres(middle)) < speed { least = middle + 1 } else { most = middle }
    }
    Some(Metres(least))
}

/// The highest speed of a train that comes up to a signal.
pub fn line_kmh(station: &Station, values: &Values) -> At<u16> {
    let highest = || At::derived(values.speeds_kmh.into_iter().max().unwrap_or(0));
    station.speed.line_kmh.clone().unwrap_or_else(highest)
}

/// A speed over the highest code is a slip: no train is told to run so fast.
pub fn within_codes(what: &str, speed: Option<&At<u16>>, values: &Values, problems: &mut Vec<Problem>) {
    let highest = values.speeds_kmh.into_iter().max().unwrap_or(0);
    // Codes without a speed are told by themselves.
    if let Some(faster) = speed.filter(|speed| highest > 0 && speed.value > highest) {
        let what = format!("{what} is {faster} km/h, faster than any code");
        let right = format!("give at most {highest} km/h, or add a speed to [braking]");
        problems.push(Problem::new(Rule::Range, &faster.span, what, right));
    }
}

/// The highest code whose speed is not over `speed`.
pub fn code(values: &Values, speed: &At<u16>, problems: &mut Vec<Problem>) -> SpeedCode {
    let fits = (1_u8..).zip(&values.speeds_kmh[1..]).filter(|(_, of_code)| (1..=speed.value).contains(*of_code));
    if let Some((code, _)) = fits.last() {
        return SpeedCode(code);
    }
    if values.speeds_kmh[1] > 0 {
        let what = format!("no code is as slow as {speed} km/h");
        let right = format!("give {} km/h or more, or add a lower speed to [braking]", values.speeds_kmh[1]);
        problems.push(Problem::new(Rule::Range, &speed.span, what, right));
    }
    SpeedCode(1)
}

/// What a train runs while its telegram ages, in whole metres, rounded up.
fn aged(speed_kmh: u16, age_ms: u32) -> u16 {
    let metres = (u64::from(speed_kmh) * u64::from(age_ms)).div_ceil(3600);
    u16::try_from(metres).unwrap_or(u16::MAX)
}

/// What a train that brakes from code to code runs besides, in whole metres, rounded up. It still brakes towards one code when the next lower one is told, and obeys
/// the first until it is too old: from the second on it has the room for that once more, at most what it brakes away in that time.
fn stepped(brake: Deceleration, age_ms: u32) -> u16 {
    // mm/s² times ms²: 1e9 of them are a metre, and a half of it counts.
    let metres = (u128::from(brake.mm_s2()) * u128::from(age_ms).pow(2)).div_ceil(2_000_000_000);
    u16::try_from(metres).unwrap_or(u16::MAX)
}

/// How far back an approach must reach for trains of `speed_kmh`: braking distance, and what is run where a code is still heard, while a telegram ages
/// and while the train is not reported.
pub fn approach_m(values: &Values, speed_kmh: u16) -> u32 {
    // The first code that is at least as fast: its distance is not shorter.
    let code = (1..MAX_CODES).find(|code| values.speeds_kmh[*code] >= speed_kmh);
    let longest = || values.braking.iter().map(|distance| distance.0).filter(|metres| *metres < u16::MAX).max();
    let reported = match code {
        Some(code) => u32::from(values.braking[code].0),
        None => u32::from(longest().unwrap_or(0)).saturating_add(u32::from(aged(speed_kmh, values.telegram_age_ms))),
    };
    let unreported_ms = u32::from(values.loss).saturating_mul(values.cycle_ms);
    reported.saturating_add(u32::from(aged(speed_kmh, unreported_ms)))
}
