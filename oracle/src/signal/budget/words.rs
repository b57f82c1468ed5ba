//! A link budget in words.

use std::fmt::Write as _;

use super::report::{BudgetReport, Link};

/// A figure of a link.
type Figure = fn(&Link) -> f64;

impl BudgetReport {
    /// The report in words.
    pub fn words(&self) -> String {
        let mut text = format!(
            "{}: link budget at the far end of {} ({} m), the longest of {}\n\n",
            self.line,
            self.longest,
            self.longest_m,
            self.sections.len()
        );
        for one in &self.parameters {
            let from = if one.given { "file" } else { "DEFAULT" };
            let value = (one.value * 1000.0).round() / 1000.0;
            let _ = writeln!(text, "{:18} {value:>8} {:5} {from:8} {}", one.name, one.unit, one.what);
        }
        let _ = writeln!(text, "\n{:58} {:>8} {:>8}", "dB", self.links[0].carrier, self.links[1].carrier);
        let lost = self.parameters.iter().find(|one| one.name == "lost_part").map_or(0.0, |one| one.value * 100.0);
        let slow = format!(
            "amplitude modulation costs them ({} and {} Hz)",
            self.links[0].slowest_code_hz, self.links[1].slowest_code_hz
        );
        let least = format!("telegrams, {lost} % lost: needed without a code (theory)");
        let rows: [(&str, Figure); 13] = [
            ("level at the transmitter", |link| link.transmitted_db),
            ("rails, wet (line theory)", |link| 0.0 - link.rail_db),
            ("other losses", |link| 0.0 - link.other_losses_db),
            ("level at the receiver", |link| link.received_db),
            ("noise in 1 Hz", |link| link.noise_density_db),
            ("the code's share of the power", |link| link.code_power_db),
            ("Eb/N0", |link| link.eb_n0_db),
            (&least, |link| link.needed_without_code_db),
            (&slow, |link| link.code_costs_db),
            ("the receiver more than theory (measured at 8 dB)", |link| link.receiver_loss_db),
            ("telegrams: needed", |link| link.needed_db),
            ("telegrams: MARGIN", |link| link.telegram_margin_db),
            ("codes: MARGIN", |link| link.code_margin_db),
        ];
        for (name, of) in rows {
            let _ = writeln!(text, "{name:58} {:8.1} {:8.1}", of(&self.links[0]), of(&self.links[1]));
        }
        let _ = writeln!(
            text,
            "\ncodes are heard from {:.1} dB on (measured, the slowest and the fastest pair)\n\
             telegrams at {:.1} dB: {} of {} lost (measured)\n\
             telegrams where the carrier is off: {} (measured): heard up to {} Hz\n\
             the receiver tells a telegram {:.1} ms after its last bit (measured); signal.delay_ms = {}",
            self.codes_needed_db,
            self.at_needed.eb_n0_db,
            self.at_needed.sent.saturating_sub(self.at_needed.heard),
            self.at_needed.sent,
            self.offsets
                .iter()
                .map(|one| format!("{} Hz {:.0} %", one.offset_hz, 100.0 * (1.0 - one.lost().max(0.0))))
                .collect::<Vec<_>>()
                .join(", "),
            self.offset_heard_hz,
            self.latency_ms,
            self.delay_ms
        );
        let _ = writeln!(
            text,
            "NOT CHECKED: that the noise is even, and no louder where the traction current is strongest; harmonics on a carrier and \
             the neighbouring section's signal are not in it [levels-within-tolerance]"
        );
        text
    }
}
