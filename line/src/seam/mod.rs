//! The seam of a line: what stations and blocks count on, held against what trains do and against each other.
//!
//! Each finding names two places: `at` is the one to change, `against` the one that it disagrees with. Approach distances, residual running
//! and the time after a start are not looked at again: the layout's own rules derive them from its telegram age, its brake and its release
//! and turn times, and those are held against the trains here.

mod borders;
mod judged;
mod ranks;
mod sound;
mod stations;
mod telegrams;
mod trains;

use crate::check::{DataCheck, Outcome};
use crate::line::Line;

pub use crate::border::{Between, Borders, Counted};
pub use crate::station::Station;
pub use crate::telegram::Telegram;

/// Every rule of the seam.
pub fn checks(line: &Line) -> Vec<DataCheck> {
    let mut checks = vec![stations::layouts(line), stations::names(line)];
    checks.extend(trains::checks(line));
    checks.extend(ranks::checks(line));
    checks.extend(telegrams::checks(line));
    checks.extend(borders::checks(line));
    // Of a station that is refused nothing was looked at.
    let refused = line.stations().len() > line.sound().len();
    for check in checks.iter_mut().skip(2).filter(|check| refused && check.outcome == Outcome::Met) {
        check.outcome = Outcome::NotChecked;
    }
    checks
}
