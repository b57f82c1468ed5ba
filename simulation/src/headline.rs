//! What the shortened operate time buys: needless brake applications, delay and margins against the length of
//! interruptions, with the shortened operate time and without, on the same disturbances.

use rand::{Rng, SeedableRng};
use rand_pcg::Pcg64Mcg;
use serde::{Deserialize, Serialize};

use crate::event::What;
use crate::fault::{Fault, Kind};
use crate::generate::Shape;
use crate::line::Line;
use crate::onboard::Operate;
use crate::world::{Setting, World};

/// How much is measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Extent {
    /// How many trains run.
    pub trains: usize,
    /// How long a run is, in s.
    pub seconds: u32,
    /// The mean time from one interruption of a train to the next, in s.
    pub every_s: u32,
    /// The longest interruption, in ms.
    pub longest_ms: u32,
    /// The step from one length to the next, in ms.
    pub step_ms: u32,
    /// What the interruptions and the strokes of points depend on.
    pub seed: u64,
}

impl Default for Extent {
    fn default() -> Self {
        Self { trains: 3, seconds: 900, every_s: 12, longest_ms: 1_500, step_ms: 50, seed: 1 }
    }
}

/// What was measured for one length with one device.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Measured {
    /// The interruptions of a train in motion that did not brake.
    pub interruptions: u32,
    /// How many of them made it brake.
    pub needless: u32,
    /// How often the device braked in a cycle in which the other kind, that heard the same, did not.
    pub alone: u32,
    /// How much later a train was at its last station than without interruptions, on the average, in s.
    pub delay_s: f64,
    /// The least distance from a front to its stop point, in m.
    pub stop_m: f64,
    /// The least of the same less the braking distance.
    pub pattern_m: f64,
    /// The least distance from a front to the next train; 3 km if there was none in sight.
    pub train_m: f64,
    /// How many unsafe events there were.
    pub unsafe_events: u32,
}

impl Measured {
    /// The share of interruptions that made a train brake, 0 to 1.
    pub fn share(&self) -> f64 {
        if self.interruptions == 0 { 0.0 } else { f64::from(self.needless) / f64::from(self.interruptions) }
    }
}

/// What was measured for one length.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Row {
    /// The length of the interruptions, in ms.
    pub length_ms: u32,
    /// With the shortened operate time.
    pub shortened: Measured,
    /// Without.
    pub conventional: Measured,
}

/// Everything that was measured.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Headline {
    /// How much.
    pub extent: Extent,
    /// A row for each length.
    pub rows: Vec<Row>,
}

/// The line that it is measured on: three passing loops, with four blocks between two.
///
/// # Errors
/// What is wrong with the layouts; they are tested.
pub fn line() -> Result<Line, String> {
    Line::generate("Three stations", &Shape::loops(3, 4))
}

/// The interruptions of a run, each of `length_ms`: the same times and trains for every length.
fn interruptions(extent: &Extent, length_ms: u32) -> Vec<Fault> {
    let mut random = Pcg64Mcg::seed_from_u64(extent.seed ^ 0x5EED);
    let mut faults = Vec::new();
    for which in 0..extent.trains {
        let every = f64::from(extent.every_s) * 1000.0;
        let mut from_ms = 60_000.0;
        while from_ms < f64::from(extent.seconds) * 1000.0 {
            from_ms += random.random_range(every / 2.0..every * 1.5);
            if length_ms > 0 {
                faults.push(Fault {
                    kind: Kind::Interruption,
                    from_ms,
                    lasts_ms: f64::from(length_ms),
                    which,
                    much: 0,
                });
            }
        }
    }
    faults
}

/// When each train came to its stations, and what was measured but the delay.
type Ended = (Vec<Vec<u64>>, Measured);

fn measure_one(line: &Line, extent: &Extent, (length_ms, operate): (u32, Operate)) -> Result<Ended, String> {
    let faults = interruptions(extent, length_ms);
    let (trains, seed) = (extent.trains, extent.seed);
    let setting = Setting { operate, trains, seed, faults, compared: true, ..Setting::default() };
    let mut world = World::new(line, setting)?;
    world.run(u64::from(extent.seconds) * 1000);
    let mut arrivals = vec![Vec::new(); extent.trains];
    for event in &world.events {
        if let What::Arrived { train, .. } = event.what {
            arrivals[train].push(event.at_ms);
        }
    }
    let sum = |of: fn(&crate::train::Train) -> u32| world.trains.iter().map(of).sum();
    let margins = world.trains.iter().fold(crate::train::Margins::FAR, |all, train| all.or_less(train.margins));
    let measured = Measured {
        interruptions: sum(|train| train.interrupted),
        needless: sum(|train| train.needless),
        alone: sum(|train| train.alone),
        delay_s: 0.0,
        stop_m: margins.stop_m.min(crate::judge::SIGHT_M),
        pattern_m: margins.pattern_m.min(crate::judge::SIGHT_M),
        train_m: margins.train_m.min(crate::judge::SIGHT_M),
        unsafe_events: u32::from(world.is_unsafe),
    };
    Ok((arrivals, measured))
}

/// How much later the trains were at the last station that they reached in both runs, on the average, in s.
#[allow(clippy::cast_precision_loss, reason = "a run is shorter than 2^53 ms")]
fn delay_s(disturbed: &[Vec<u64>], undisturbed: &[Vec<u64>]) -> f64 {
    let late = disturbed.iter().zip(undisturbed).filter_map(|(one, other)| {
        let last = one.len().min(other.len()).checked_sub(1)?;
        Some((one[last] as f64 - other[last] as f64) / 1000.0)
    });
    let late: Vec<f64> = late.collect();
    if late.is_empty() { 0.0 } else { late.iter().sum::<f64>() / late.len() as f64 }
}

/// Measures everything, on two cores.
///
/// # Errors
/// An extent that cannot be run, in a sentence.
pub fn measure(extent: &Extent) -> Result<Headline, String> {
    if extent.step_ms == 0 || extent.seconds <= 60 || extent.every_s < 5 {
        return Err("the step must be above 0, a run longer than 60 s, and interruptions at least 5 s apart".to_owned());
    }
    let line = line()?;
    let lengths: Vec<u32> = (0..=extent.longest_ms).step_by(extent.step_ms as usize).collect();
    let one = |operate: Operate| -> Result<Vec<Ended>, String> {
        lengths.iter().map(|length| measure_one(&line, extent, (*length, operate))).collect()
    };
    let (shortened, conventional) = std::thread::scope(|scope| {
        let other = scope.spawn(|| one(Operate::Conventional));
        (one(Operate::Shortened), other.join().unwrap_or_else(|_| Err("a run broke off".to_owned())))
    });
    let late = |ended: Vec<Ended>| -> Vec<Measured> {
        let first = ended[0].0.clone();
        ended.into_iter().map(|(arrivals, one)| Measured { delay_s: delay_s(&arrivals, &first), ..one }).collect()
    };
    let (shortened, conventional) = (late(shortened?), late(conventional?));
    let rows = lengths.iter().zip(shortened.into_iter().zip(conventional));
    let rows =
        rows.map(|(length_ms, (shortened, conventional))| Row { length_ms: *length_ms, shortened, conventional });
    Ok(Headline { extent: *extent, rows: rows.collect() })
}

impl Headline {
    /// The data as CSV, with a line of names.
    pub fn csv(&self) -> String {
        let columns = ["interruptions", "needless", "alone", "delay_s", "stop_m", "pattern_m", "train_m", "unsafe"];
        let mut names = vec!["length_ms".to_owned()];
        for device in ["shortened", "conventional"] {
            names.extend(columns.iter().map(|column| format!("{device}_{column}")));
        }
        let mut text = names.join(",") + "\n";
        for row in &self.rows {
            let mut cells = vec![row.length_ms.to_string()];
            for one in [&row.shortened, &row.conventional] {
                cells.extend([one.interruptions, one.needless, one.alone].map(|count| count.to_string()));
                cells.extend([one.delay_s, one.stop_m, one.pattern_m, one.train_m].map(|value| format!("{value:.3}")));
                cells.push(one.unsafe_events.to_string());
            }
            text += &(cells.join(",") + "\n");
        }
        text
    }

    /// How many unsafe events there were in all runs.
    pub fn unsafe_events(&self) -> u32 {
        self.rows.iter().map(|row| row.shortened.unsafe_events + row.conventional.unsafe_events).sum()
    }

    /// How often the device with the shortened operate time braked where the conventional one, that heard the same, did not.
    pub fn alone(&self) -> u32 {
        self.rows.iter().map(|row| row.shortened.alone).sum()
    }

    /// The shortest interruption that makes at least `share` of the trains brake: with the shortened time, and without.
    pub fn edges_ms(&self, share: f64) -> [Option<u32>; 2] {
        let first = |of: fn(&Row) -> &Measured| {
            self.rows.iter().find(|row| row.length_ms > 0 && of(row).share() >= share).map(|row| row.length_ms)
        };
        [first(|row| &row.shortened), first(|row| &row.conventional)]
    }
}
