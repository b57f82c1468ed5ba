//! Every rule of a line, with what it came to.

use crate::blocks::Detection;
use crate::check::{DataCheck, Finding, Outcome};
use crate::line::Line;
use crate::position::Calibration;
use crate::rule::Rule;
use crate::signal::Signal;
use crate::{code, seam};

impl Line {
    /// Every rule, with what it came to.
    pub fn checks(&self) -> Vec<DataCheck> {
        let met = |rule, scope: String| DataCheck::new(rule, scope, Outcome::Met);
        let mut checks = vec![
            met(Rule::Time2, "5 times".to_owned()),
            self.rounding(),
            met(Rule::Time4, format!("{} aspects", self.table.speeds().len())),
            met(Rule::Sup3, "2 speeds".to_owned()),
        ];
        checks.extend(self.detection.iter().flat_map(Detection::checks));
        checks.extend(self.signal.iter().flat_map(Signal::checks));
        checks.extend(self.position.iter().flat_map(Calibration::checks));
        let codes = self.codes.iter();
        checks.extend(codes.flat_map(|(table, pairs)| code::checks(&self.places, table, pairs, &self.table)));
        checks.extend(seam::checks(self));
        checks
    }

    /// TIME-1, computed again from what was kept.
    fn rounding(&self) -> DataCheck {
        let times = self.times;
        let mask = times.expiry().0 - times.recovery().0;
        let asked = &self.aspect;
        let cycle = u64::from(asked.cycle_ms);
        let up = |asked: u64, kept: u64| kept >= asked && kept < asked + cycle;
        let down = |asked: u64, kept: u64| kept <= asked && kept + cycle > asked;
        // T4 may also be limited by TIME-3.
        let limited = |asked: u64, kept: u64| kept <= asked;
        let broken = [
            ("operate_ms", asked.operate_ms, times.operate().0, &up as &dyn Fn(u64, u64) -> bool),
            ("shortened_operate_ms", asked.shortened_operate_ms, times.shortened_operate().0, &up),
            ("recovery_ms", asked.recovery_ms, times.recovery().0, &down),
            ("mask_ms", asked.mask_ms, mask, &down),
            ("interruption_ms", asked.interruption_ms, times.interruption().0, &limited),
        ]
        .into_iter()
        .filter(|(_, asked, ticks, right)| !right(u64::from(*asked), self.ms(*ticks)))
        .map(|(field, asked, ticks, _)| {
            let at = self.places.at(&format!("times.{field}"));
            let what = format!("{field} is {asked} ms, and {} ms are kept", self.ms(ticks));
            Finding { at, against: None, what, right: String::new() }
        })
        .collect();
        DataCheck::new(Rule::Time1, "5 times", Outcome::of(broken))
    }

    /// Whether nothing speaks against the line: every rule is met, or there is nothing that it is about.
    pub fn is_sound(&self) -> bool {
        self.checks().iter().all(|check| check.outcome.holds())
    }
}
