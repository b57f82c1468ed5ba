//! Where the time went, by the clock and in processor time, phase by phase.

use crate::case::Phase;
use comfy_table::{CellAlignment, Table, presets::NOTHING};
use nix::sys::resource::{UsageWho, getrusage};
use nix::sys::time::TimeVal;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, Instant};

/// How many of the slowest items are named.
const SLOWEST: usize = 5;

/// A phase that has begun.
#[derive(Debug)]
pub struct Watch {
    name: String,
    started: Instant,
    cpu: f64,
}

impl Watch {
    /// Begins now.
    pub fn start(name: &str) -> Self {
        Self { name: name.to_owned(), started: Instant::now(), cpu: cpu() }
    }

    /// Ends now, with these items and the seconds of each.
    pub fn end(self, items: Vec<(String, f64)>) -> Phase {
        let (wall_seconds, cpu_seconds) = (self.started.elapsed().as_secs_f64(), (cpu() - self.cpu).max(0.0));
        Phase { name: self.name, items: items.len(), wall_seconds, cpu_seconds, slowest: slowest(items) }
    }
}

/// The items that took longest, the slowest first.
pub fn slowest(mut items: Vec<(String, f64)>) -> Vec<(String, f64)> {
    items.retain(|(_, seconds)| *seconds > 0.0);
    items.sort_by(|(one, a), (other, b)| b.total_cmp(a).then_with(|| one.cmp(other)));
    items.truncate(SLOWEST);
    items
}

/// Milliseconds of processors of what ran beside the phases: none of theirs.
static BESIDE: AtomicU64 = AtomicU64::new(0);

/// Asks whether a program that runs beside the phases has ended. If so, also its seconds of processors, which no phase is charged with.
pub fn beside<T>(ended: impl FnOnce() -> Option<T>) -> Option<(T, f64)> {
    let before = used();
    let ended = ended()?;
    let seconds = (used() - before).max(0.0);
    let milliseconds = Duration::try_from_secs_f64(seconds).unwrap_or_default().as_millis();
    BESIDE.fetch_add(u64::try_from(milliseconds).unwrap_or(0), Ordering::Relaxed);
    Some((ended, seconds))
}

/// Seconds of processors of this program and of all that it started, that has ended, and that did not run beside the phases.
fn cpu() -> f64 {
    used() - Duration::from_millis(BESIDE.load(Ordering::Relaxed)).as_secs_f64()
}

/// Seconds of processors of this program and of all that it started and that has ended; 0 if the system does not tell.
fn used() -> f64 {
    let seconds = |time: TimeVal| {
        let micros = u32::try_from(time.tv_usec()).unwrap_or(0);
        let whole = u32::try_from(time.tv_sec()).unwrap_or(u32::MAX);
        f64::from(whole) + f64::from(micros) / 1e6
    };
    let of = |who| getrusage(who).map_or(0.0, |usage| seconds(usage.user_time()) + seconds(usage.system_time()));
    of(UsageWho::RUSAGE_SELF) + of(UsageWho::RUSAGE_CHILDREN)
}

/// The table that stands at the end of a run.
pub fn table(phases: &[Phase]) -> String {
    let mut table = Table::new();
    table.load_preset(NOTHING).set_header(["where the time went", "items", "clock s", "processor s", "slowest (s)"]);
    let mut row = |name: &str, items: String, wall: f64, cpu: f64, slowest: String| {
        table.add_row([name.to_owned(), items, format!("{wall:.1}"), format!("{cpu:.1}"), slowest]);
    };
    for phase in phases {
        let (wall, cpu) = (phase.wall_seconds, phase.cpu_seconds);
        row(&phase.name, phase.items.to_string(), wall, cpu, named(phase));
    }
    let sum = |of: fn(&Phase) -> f64| phases.iter().map(of).sum::<f64>();
    row("together", String::new(), sum(|one| one.wall_seconds), sum(|one| one.cpu_seconds), String::new());
    for column in 1..4 {
        if let Some(column) = table.column_mut(column) {
            column.set_cell_alignment(CellAlignment::Right);
        }
    }
    table.to_string()
}

/// `t_ilk_4 31.2, t_per_7 20.0`
pub fn named(phase: &Phase) -> String {
    phase.slowest.iter().map(|(name, seconds)| format!("{name} {seconds:.1}")).collect::<Vec<_>>().join(", ")
}

#[cfg(test)]
mod tests {
    use super::{Watch, slowest, table};

    #[test]
    fn the_slowest_are_named_and_the_rest_is_counted() {
        let items: Vec<_> = (0..9_u8).map(|number| (format!("t{number}"), f64::from(number))).collect();
        let names: Vec<_> = slowest(items.clone()).into_iter().map(|(name, _)| name).collect();
        assert_eq!(names, ["t8", "t7", "t6", "t5", "t4"]);
        let phase = Watch::start("theorems").end(items);
        assert!(phase.items == 9 && phase.wall_seconds >= 0.0);
        let text = table(&[phase]);
        assert!(text.contains("theorems") && text.contains("t8 8.0") && text.contains("together"), "{text}");
    }

    #[test]
    fn processor_time_counts_what_was_started() {
        let watch = Watch::start("work");
        let mut number = 1_u64;
        let start = std::time::Instant::now();
        while super::cpu() - watch.cpu < 0.05 && start.elapsed().as_secs() < 60 {
            number = std::hint::black_box(number.wrapping_mul(3));
        }
        assert!(watch.end(vec![]).cpu_seconds >= 0.05);
    }
}
