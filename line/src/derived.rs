//! What follows from the parameters of a line: the times as they are kept, and what the user should know and look at.

use std::cmp::Ordering;

use crate::blocks::Detection;
use crate::figures::{Derived, LineTime};
use crate::kmh::fixed;
use crate::line::Line;
use crate::position::Calibration;
use crate::signal::Signal;

impl Line {
    /// The five times, as they are kept.
    pub fn times_kept(&self) -> Vec<LineTime> {
        let (times, asked) = (self.times, &self.aspect);
        [
            ("T1", "operate time", asked.operate_ms, times.operate().0),
            ("T2", "recovery time", asked.recovery_ms, times.recovery().0),
            ("T3", "no-signal mask time", asked.mask_ms, times.expiry().0 - times.recovery().0),
            ("T4", "interruption limit", asked.interruption_ms, times.interruption().0),
            ("T5", "shortened operate time", asked.shortened_operate_ms, times.shortened_operate().0),
        ]
        .map(|(symbol, name, asked_ms, ticks)| self.time(symbol, name, asked_ms, ticks))
        .into()
    }

    fn time(&self, symbol: &str, name: &str, asked_ms: u32, ticks: u16) -> LineTime {
        let (kept_ms, cycle) = (self.ms(ticks), u64::from(self.aspect.cycle_ms));
        let lost = u64::from(asked_ms).saturating_sub(kept_ms);
        let rounding = match kept_ms.cmp(&u64::from(asked_ms)) {
            Ordering::Equal => "exact",
            Ordering::Greater => "up",
            Ordering::Less if symbol == "T4" && (lost >= cycle || ticks + 1 == self.times.expiry().0) => {
                "limited to T2 + T3 less one cycle (TIME-3)"
            }
            Ordering::Less => "down",
        };
        LineTime {
            symbol: symbol.to_owned(),
            name: name.to_owned(),
            asked_ms,
            ticks,
            kept_ms,
            rounding: rounding.to_owned(),
        }
    }

    /// What follows from the parameters.
    pub fn derived(&self) -> Vec<Derived> {
        let (new, old) = (self.times, self.times.conventional());
        let span = |ticks: u16| format!("{} ms ({ticks} cycles)", self.ms(ticks));
        let row = Derived::row;
        let gain = new.tolerated_interruption().0 - old.tolerated_interruption().0;
        let mut rows = vec![
            row(
                "Longest interruption without a needless stop",
                span(new.tolerated_interruption().0),
                "largest g ≤ T4 with g + T5 ≤ T2 + T3, or g with g + T1 ≤ T2 + T3",
                "T-ACC-4",
            ),
            row(
                "The same, conventional device",
                span(old.tolerated_interruption().0),
                "largest g with g + T1 ≤ T2 + T3",
                "T-ACC-4",
            ),
            row("Gained by the shortened operate time", span(gain), "the difference", "T-ACC-4"),
            row(
                "An aspect that is no longer heard is displayed for less than",
                span(new.expiry().0),
                "T2 + T3",
                "T-ACC-3",
            ),
            row("Total silence ends in stop within", span(new.expiry().0), "T2 + T3", "T-ACC-3"),
        ];
        for (name, times) in [("new", new), ("conventional", old)] {
            let rest = times.expiry().0.saturating_sub(times.shortened_operate().0);
            let gap = if name == "new" { rest.min(times.interruption().0) } else { rest };
            let on = times.shortened_operate().0;
            rows.push(row(
                &format!("Bursts that could keep a stale aspect displayed for ever, {name} device"),
                if gap == 0 {
                    "only without a gap".to_owned()
                } else {
                    let share = f64::from(on) * 100.0 / (f64::from(on) + f64::from(gap));
                    format!("{} ms in every {} ms ({share:.1} %)", self.ms(on), self.ms(on) + self.ms(gap))
                },
                if name == "new" { "T5 in T5 + min(T4, T2 + T3 − T5)" } else { "T1 in T2 + T3" },
                "model burst-loops",
            ));
        }
        rows.push(row(
            "Speed supervision",
            format!(
                "brake above the permitted speed; release margin {} km/h; implausible above {} km/h",
                fixed(self.supervision.margin()),
                fixed(self.supervision.maximum())
            ),
            "",
            "SUP-1, SUP-2",
        ));
        rows.extend(self.detection.iter().flat_map(Detection::derived));
        rows.extend(self.signal.iter().flat_map(Signal::derived));
        rows.extend(self.position.iter().flat_map(Calibration::derived));
        rows
    }

    /// What the user should look at.
    pub fn notes(&self) -> Vec<String> {
        let times = self.times;
        let mut notes = Vec::new();
        let survives = times.interruption().0 + times.shortened_operate().0 <= times.expiry().0;
        if !survives {
            notes.push(format!(
                "An interruption of exactly T4 ({} ms) still earns the shortened operate time, but the display lapses for \
                 {} ms before the aspect returns, as T4 + T5 exceeds T2 + T3.",
                self.ms(times.interruption().0),
                self.ms(times.interruption().0 + times.shortened_operate().0 - times.expiry().0)
            ));
        }
        if times.tolerated_interruption() == times.conventional().tolerated_interruption() {
            notes.push("The shortened operate time gains nothing with these times: T4 is too short.".to_owned());
        }
        if self.aspect.interruption_ms > 1000 {
            notes.push("T4 is above 1000 ms, the most that the patent names.".to_owned());
        }
        if self.table.speeds().last().is_some_and(|top| *top > self.supervision.maximum()) {
            notes.push(
                "The highest aspect permits more than the highest plausible speed: at that speed the emergency brake acts."
                    .to_owned(),
            );
        }
        notes.extend(self.detection.iter().flat_map(Detection::notes));
        notes.extend(self.signal.iter().flat_map(Signal::notes));
        notes.extend(self.position.iter().flat_map(Calibration::notes));
        notes
    }
}
