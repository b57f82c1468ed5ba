//! The section numbers that a line's file gives to circuits of stations.

use atc_kernel::heading::Heading;

use crate::form;

/// The section numbers that are sent in a circuit of a station.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Telegram {
    /// The station.
    pub station: String,
    /// The circuit, as its layout calls it.
    pub circuit: String,
    /// The number that is sent to trains that travel to the left of the layout: odd.
    pub left: Option<u16>,
    /// The number that is sent to those that travel to the right: even.
    pub right: Option<u16>,
}

impl Telegram {
    pub(crate) fn of(given: &form::Telegram) -> Self {
        let form::Telegram { station, circuit, left, right } = given;
        Self { station: station.clone(), circuit: circuit.clone(), left: *left, right: *right }
    }

    /// The number for a direction of travel.
    pub const fn section(&self, heading: Heading) -> Option<u16> {
        match heading {
            Heading::Left => self.left,
            Heading::Right => self.right,
        }
    }
}
