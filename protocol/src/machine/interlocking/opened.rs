//! What a configuration becomes: a layout with its names, and what its file says besides.

use atc_kernel::interlocking::{Heading, Layout, MAX_CODES, Size};
use atc_layout::model::Model;
use atc_layout::{Names, form};

/// What the machine needs of a configuration.
pub(super) struct Opened<const R: usize, const P: usize, const N: usize, const S: usize, Z: Size> {
    pub(super) layout: Box<Layout<R, P, N, S, Z>>,
    pub(super) names: Names,
    pub(super) speeds_kmh: [u16; MAX_CODES],
    pub(super) cycle_ms: u32,
    /// What the file says besides; a plan has no file.
    pub(super) said: Option<Said>,
}

/// What a layout file says of trains and tracks, and a plan in the kernel's own terms does not.
#[derive(Clone, Debug)]
pub struct Said {
    /// The age of telegrams that the layout counts on, in ms.
    pub telegram_age_ms: u32,
    /// The length of the longest train, in metres, if the file has one.
    pub longest_train_m: Option<u16>,
    /// What trains find in each circuit, and ahead of it: of those that travel to the left, and of those that travel to the right.
    pub facing: [Vec<Found>; 2],
}

/// What a train finds that stands in a circuit and travels one way.
#[derive(Clone, Copy, Debug)]
pub struct Found {
    /// The steepest gradient of the circuit and of all that the train may be granted, in thousandths, whichever way it falls: 0 to 128. A circuit
    /// of which the file has none counts as level.
    pub fall_permille: u8,
    /// The highest speed at which it may run there, in km/h; 0 where no train runs.
    pub fastest_kmh: u16,
}

impl Said {
    pub(super) fn of(station: &form::Station, model: &Model) -> Self {
        let fall = |circuit: usize| {
            let gradient = station.circuits.get(circuit).and_then(|given| given.gradient.as_ref());
            gradient.map_or(0, |given| given.value.unsigned_abs())
        };
        let found = |circuit: usize, heading: Heading| Found {
            fall_permille: model.ahead(circuit, heading).into_iter().map(fall).max().unwrap_or(0),
            fastest_kmh: model.fastest_kmh(circuit, heading),
        };
        let facing = [Heading::Left, Heading::Right]
            .map(|heading| (0..station.circuits.len()).map(|circuit| found(circuit, heading)).collect());
        Self {
            telegram_age_ms: model.values.telegram_age_ms,
            longest_train_m: station.longest_train_m.as_ref().map(|length| length.value),
            facing,
        }
    }
}
